"""The process: a problem comes in by standard input, bounds and at last a plan go out, a line each."""

import os
import pickle
import sys

from search.classical.symbolic.bidirectional import Bidirectional


def _main() -> None:
    problem, state, limit = pickle.load(sys.stdin.buffer)
    caller = os.getppid()
    search = Bidirectional(problem, state, limit)
    for bound in search.bounds():
        if os.getppid() != caller:  # nobody waits for it any more
            return
        _say(bound)
    _say(search.best, *(search.plan() if search.best < limit else ()))


def _say(*numbers: int) -> None:
    sys.stdout.write(" ".join(map(str, numbers)) + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    _main()
