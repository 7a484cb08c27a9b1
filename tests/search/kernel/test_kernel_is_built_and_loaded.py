"""A kernel is loaded if it was compiled from the source beside it, and done without otherwise."""

import ctypes
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from search.kernel import library
from search.kernel.build import CompilerError, compile_kernel, compiler, main
from search.kernel.signatures import SIGNATURES

HASH = """
const char *kernel_source_hash(void);
const char *kernel_source_hash(void) { return KERNEL_SOURCE_HASH; }
"""
SOURCE = HASH + "".join(f"void {name}(void);\nvoid {name}(void) {{}}\n" for name in SIGNATURES)

OTHER = "int other(void); int other(void) { return 1; }"
needs_compiler = pytest.mark.skipif(compiler() is None, reason="there is no C compiler here")


@pytest.fixture
def source(tmp_path: Path) -> Path:
    path = tmp_path / "kernel.c"
    path.write_text(SOURCE, encoding="utf-8")
    return path


@pytest.fixture
def binary(tmp_path: Path) -> Path:
    return tmp_path / library.BINARY.name


@pytest.fixture
def beside(source: Path, binary: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The library is looked for where the test has put one."""
    monkeypatch.setattr(library, "SOURCE", source)
    monkeypatch.setattr(library, "BINARY", binary)
    monkeypatch.delenv("SERENDIPITY_KERNEL", raising=False)
    library._loaded.cache_clear()
    library._warn.cache_clear()
    yield
    library._loaded.cache_clear()
    library._warn.cache_clear()


def refusal(binary: Path, source: Path) -> str:
    """Why there is no kernel in a file."""
    found = library.load(binary, source)
    assert isinstance(found, str)
    return found


@needs_compiler
@pytest.mark.usefixtures("beside")
def test_what_is_built_is_loaded_once(
    source: Path, binary: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(binary, source) == 0
    assert capsys.readouterr() == (f"Kernel compiled: {binary}\n", "")
    found = library.library()
    assert isinstance(found, ctypes.CDLL)
    assert library.library() is found
    assert library.state() == "compiled"
    monkeypatch.setenv("SERENDIPITY_KERNEL", "off")
    assert library.library() is None
    assert library.state() == "none (SERENDIPITY_KERNEL=off)"
    assert set(source.parent.iterdir()) == {source, binary}


@pytest.mark.usefixtures("beside")
def test_that_it_is_absent_is_said_once(binary: Path, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level("WARNING", logger="search.kernel")  # a command may have been told to be quiet
    assert library.library() is None
    assert library.library() is None
    (record,) = caplog.records
    assert record.levelname == "WARNING"
    assert f"no compiled kernel (there is no {binary.name}" in record.getMessage()
    assert library.state().startswith(f"none (there is no {binary.name}")


@needs_compiler
def test_none_where_the_source_has_changed(source: Path, binary: Path) -> None:
    assert main(binary, source) == 0
    source.write_text(f"{SOURCE}/* changed */", encoding="utf-8")
    assert "is of another source" in refusal(binary, source)
    source.unlink()
    assert isinstance(library.load(binary, source), ctypes.CDLL), "nothing says that it is stale"


@needs_compiler
@pytest.mark.parametrize("text", [HASH, OTHER], ids=["functions are missing", "something else"])
def test_what_cannot_be_loaded_is_removed(text: str, source: Path, binary: Path, capsys) -> None:
    source.write_text(text, encoding="utf-8")
    assert main(binary, source) == 1
    assert "can't be loaded here" in capsys.readouterr().err
    assert not binary.exists()


@needs_compiler
@pytest.mark.parametrize("change", ["changed", "added", "removed", "renamed"])
def test_none_where_a_unit_has_changed(change: str, source: Path, binary: Path) -> None:
    unit, other = source.with_name("unit.h"), source.with_name("other.h")
    unit.write_text("enum { ONE = 1 };", encoding="utf-8")
    source.write_text(f'#include "unit.h"\n{SOURCE}', encoding="utf-8")
    assert main(binary, source) == 0
    assert isinstance(library.load(binary, source), ctypes.CDLL)
    if change == "changed":
        unit.write_text("enum { ONE = 2 };", encoding="utf-8")
    elif change == "added":
        other.touch()
    elif change == "removed":
        unit.unlink()
    else:
        unit.rename(other)
    assert "is of another source" in refusal(binary, source)


@needs_compiler
def test_none_where_the_library_is_something_else(source: Path, binary: Path) -> None:
    other = source.with_name("other.c")
    other.write_text(OTHER, encoding="utf-8")
    compile_kernel(compiler() or [], binary, other)
    assert "is no kernel for this machine" in refusal(binary, source)


@pytest.mark.parametrize("content", [b"", b"no library", b"\x7fELF"])
def test_none_where_the_file_is_no_library(content: bytes, source: Path, binary: Path) -> None:
    binary.write_bytes(content)
    assert "is no kernel for this machine" in refusal(binary, source)


@needs_compiler
def test_an_error_leaves_what_was_there(
    source: Path, binary: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    binary.write_bytes(b"before")
    source.write_text("int broken(", encoding="utf-8")
    assert main(binary, source) == 1
    said = capsys.readouterr().err
    assert "error" in said
    assert said.endswith(f"No kernel: {source} can't be compiled.\n")
    assert binary.read_bytes() == b"before"
    assert set(source.parent.iterdir()) == {source, binary}


def test_no_compiler_is_no_failure(
    source: Path, binary: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", str(source.parent))
    monkeypatch.setitem(sys.modules, "ziglang", None)
    assert compiler() is None
    assert main(binary, source) == 0
    assert capsys.readouterr().out.startswith("No kernel: ")
    assert not binary.exists()


def test_a_named_compiler_that_is_absent_is_one_line(
    source: Path, binary: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("CC", "no-such-compiler -m64")
    with pytest.raises(CompilerError, match=r"no-such-compiler: No such file or directory"):
        compile_kernel(compiler() or [], binary, source)
    assert main(binary, source) == 1
    assert "Traceback" not in capsys.readouterr().err


def test_the_first_compiler_that_there_is(source: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(source.parent))
    monkeypatch.setenv("CC", "gcc -m64")
    assert compiler() == ["gcc", "-m64"]
    monkeypatch.delenv("CC")
    monkeypatch.setattr(shutil, "which", {"cc": "/usr/bin/cc"}.get)
    assert compiler() == ["cc"]
    monkeypatch.setattr(shutil, "which", {}.get)
    monkeypatch.setattr("search.kernel.build.find_spec", {"ziglang": object()}.get)
    assert shlex.join(compiler() or []).endswith("-m ziglang cc -target native -mcpu=baseline -s")


@needs_compiler
@pytest.mark.parametrize("unit", library.units(library.SOURCE), ids=lambda unit: unit.name)
def test_a_unit_includes_what_it_stands_on(unit: Path) -> None:
    command = [*(compiler() or []), "-std=c11", "-fsyntax-only", "-Werror=implicit-function-declaration"]
    main_file = f'#include "{unit}"\n'
    done = subprocess.run([*command, "-x", "c", "-"], input=main_file, text=True, capture_output=True)
    assert not done.returncode, done.stderr


@pytest.mark.long
@needs_compiler
def test_the_source_compiles_without_a_warning(binary: Path) -> None:
    compile_kernel([*(compiler() or []), "-Werror"], binary)
    assert isinstance(library.load(binary, library.SOURCE), ctypes.CDLL)
