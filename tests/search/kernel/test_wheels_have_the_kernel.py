"""A wheel has a kernel, and is for one platform then, where there is a compiler; else it is for any."""

import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from hatch_build import TARGETS
from search.kernel.build import compile_kernel, compiler, zig
from search.kernel.library import BINARY, SOURCE, load, units

ROOT = Path(__file__).resolve().parents[3]
UNITS = {f"search/kernel/{unit.name}" for unit in units(SOURCE)}


def build(folder: Path, monkeypatch: pytest.MonkeyPatch, **environment: str) -> Path:
    """The wheel that is built under environment variables."""
    for name in ("CC", "SERENDIPITY_WHEEL"):
        monkeypatch.delenv(name, raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    (wheel,) = folder.glob("*.whl")
    return wheel


def kernels(wheel: Path) -> set[str]:
    """What the wheel has of the kernel, but for modules."""
    names = zipfile.ZipFile(wheel).namelist()
    return {name for name in names if name.startswith("search/kernel/") and not name.endswith(".py")}


@pytest.mark.long
@pytest.mark.skipif(compiler() is None, reason="there is no C compiler here")
def test_a_wheel_for_this_platform(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    wheel = build(tmp_path, monkeypatch)
    assert "-py3-none-" in wheel.name
    assert not wheel.name.endswith("-any.whl")
    assert kernels(wheel) == UNITS | {f"search/kernel/{BINARY.name}"}
    with zipfile.ZipFile(wheel) as archive:
        folder = Path(archive.extract(f"search/kernel/{BINARY.name}", tmp_path)).parent
        archive.extractall(tmp_path, UNITS)
        assert not isinstance(load(folder / BINARY.name, folder / SOURCE.name), str)
        metadata = next(name for name in archive.namelist() if name.endswith("/WHEEL"))
        assert b"Root-Is-Purelib: false" in archive.read(metadata)


@pytest.mark.parametrize("environment", [{"SERENDIPITY_WHEEL": "any"}, {"CC": "no-such-compiler"}])
def test_a_wheel_for_any_platform(
    environment: dict[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    wheel = build(tmp_path, monkeypatch, **environment)
    assert wheel.name.endswith("-py3-none-any.whl")
    assert kernels(wheel) == UNITS
    names = zipfile.ZipFile(wheel).namelist()
    assert [name for name in names if name.endswith(".md")] == [], "that is for developers"


def test_each_target_has_its_wheel() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8").replace("\\\n", " ")
    platforms = re.search(r"^PLATFORMS := (.*)$", makefile, re.MULTILINE)
    assert platforms[1].split() == ["any", *TARGETS]


@pytest.mark.slow
@pytest.mark.parametrize("platform", [name for name in TARGETS if "linux" in name])
def test_a_kernel_asks_for_the_c_library_of_its_platform(platform: str, tmp_path: Path) -> None:
    pytest.importorskip("ziglang", reason="`make wheels` installs it")
    binary = tmp_path / BINARY.name
    compile_kernel(zig(TARGETS[platform][0]), binary)
    found = binary.read_bytes()
    assert found[18] == (62 if platform.endswith("x86_64") else 183)  # e_machine
    assert (b"GLIBC_" in found, b"libc.so.6\0" in found) == (("many" in platform),) * 2
    assert b"libc.so" in found
