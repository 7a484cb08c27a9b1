"""Puts the compiled kernel into the wheel, which is for one platform then.

Without more said, the wheel is for this machine where it has a C compiler, and for any, without a
kernel, where it has none.  ``make wheels`` says more, by the environment variable ``SERENDIPITY_WHEEL``:
a platform tag of :data:`TARGETS`, for which zig compiles, or ``any``.
"""

import os
import sys
import tempfile
from pathlib import Path
from typing import Any, Final

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from packaging.tags import platform_tags

TARGETS: Final = {
    "manylinux_2_17_x86_64": ("x86_64-linux-gnu.2.17", ".so"),
    "manylinux_2_17_aarch64": ("aarch64-linux-gnu.2.17", ".so"),
    "musllinux_1_2_x86_64": ("x86_64-linux-musl", ".so"),
    "musllinux_1_2_aarch64": ("aarch64-linux-musl", ".so"),
    "macosx_11_0_x86_64": ("x86_64-macos.11.0", ".dylib"),
    "macosx_11_0_arm64": ("aarch64-macos.11.0", ".dylib"),
    "win_amd64": ("x86_64-windows-gnu", ".dll"),
    "win_arm64": ("aarch64-windows-gnu", ".dll"),
}
"""By platform tag what zig calls the platform, and how libraries end there."""


class KernelHook(BuildHookInterface[Any]):
    """Compiles the kernel for a wheel; an editable installation has that beside its source."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add the kernel to what the wheel is made of."""
        platform = os.environ.get("SERENDIPITY_WHEEL", "")
        if version == "editable" or platform == "any":
            return
        sys.path.insert(0, self.root)
        from search.kernel.build import CompilerError, compile_kernel, compiler, zig
        from search.kernel.library import BINARY

        command, suffix = compiler(), BINARY.suffix
        if platform:
            target, suffix = TARGETS[platform]
            command = zig(target)
        if command is None:
            return
        self._scratch = tempfile.TemporaryDirectory()
        binary = Path(self._scratch.name) / f"{BINARY.stem}{suffix}"
        try:
            compile_kernel(command, binary)
        except CompilerError as error:
            if platform:
                raise
            self.app.display_warning(f"{error}\nThe wheel is without a kernel: it can't be compiled.")
            return
        build_data["force_include"][str(binary)] = f"search/kernel/{binary.name}"
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{platform or _this_platform()}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Remove what was compiled."""
        if hasattr(self, "_scratch"):
            self._scratch.cleanup()


def _this_platform() -> str:
    """The platform tag for this machine; those for many Linuxes promise more than its compiler can know."""
    return next(tag for tag in platform_tags() if not tag.startswith(("manylinux", "musllinux")))
