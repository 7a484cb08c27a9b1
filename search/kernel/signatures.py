"""Arguments and results of the kernel's functions, as in ``api.h``.

They are told to :mod:`ctypes` once, before anybody has the library: other threads may call it at any time.
"""

from ctypes import CDLL, c_char_p, c_double, c_int, c_int32, c_int64, c_size_t, c_void_p
from typing import Final

SIGNATURES: Final = {
    "leave_out": (None, [c_int]),
    "planner_new": (c_void_p, [c_void_p]),
    "planner_free": (None, [c_void_p]),
    "planner_begin": (c_int, [c_void_p, c_char_p, c_int64, c_size_t]),
    "planner_alike": (c_int, [c_void_p, c_void_p, c_int32, c_size_t]),
    "planner_run": (c_int, [c_void_p, c_double, c_size_t]),
    "planner_begin_greedy": (c_int, [c_void_p, c_char_p, c_size_t]),
    "planner_run_greedy": (c_int, [c_void_p, c_double, c_size_t]),
    "planner_bound": (c_int64, [c_void_p, c_char_p, c_size_t]),
    "planner_least": (c_int64, [c_void_p]),
    "planner_wanted": (c_size_t, [c_void_p]),
    "planner_counts": (None, [c_void_p, c_void_p]),
    "planner_greedy_way": (c_int32, [c_void_p, c_void_p, c_int32]),
    "planner_best_way": (c_int32, [c_void_p, c_void_p, c_int32]),
    "planner_known_way": (c_int32, [c_void_p, c_char_p, c_void_p, c_int32]),
    "planner_allowed": (c_int32, [c_void_p, c_char_p, c_void_p]),
    "epochs_new": (c_void_p, [c_void_p, c_void_p, c_char_p, c_void_p, c_char_p, c_char_p, c_int64]),
    "epochs_delete": (None, [c_void_p]),
    "epochs_start": (c_int, [c_void_p, c_char_p, c_size_t]),
    "epochs_turn": (c_int, [c_void_p, c_int32, c_void_p, c_int32]),
    "epochs_slice": (c_int, [c_void_p, c_int64, c_double, c_size_t]),
    "epochs_wanted": (c_size_t, [c_void_p]),
    "epochs_states": (c_int64, [c_void_p]),
    "epochs_leavings": (c_int32, [c_void_p, c_void_p, c_void_p]),
    "epochs_left": (None, [c_void_p, c_int32, c_void_p]),
    "epochs_back": (c_int, [c_void_p, c_void_p, c_int64, c_double]),
    "epochs_rest": (c_int64, [c_void_p, c_int32, c_char_p, c_int]),
    "epochs_sets": (c_int32, [c_void_p, c_int32, c_void_p, c_void_p]),
}
"""By name the type of the result, and those of the arguments."""


def declare(library: CDLL) -> None:
    """Say of each function what it takes and returns; ``AttributeError`` where the library lacks one."""
    for name, (result, arguments) in SIGNATURES.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
