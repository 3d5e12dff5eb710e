"""What the tests compile is compiled again if, and only if, something that decides it changes."""

import shutil
import subprocess
from pathlib import Path

import pytest
from compiling import CompilerError, compiled
from sharing import remembering

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")


@pytest.fixture
def compiler(tmp_path: Path) -> Path:
    """A compiler that counts what it compiles."""
    program = tmp_path / "counting-cc"
    program.write_text(
        f'#!/bin/sh\ncase " $* " in *" -E "*|*" -v "*) ;; *) echo >> {tmp_path}/count ;; esac\n'
        'exec cc "$@"\n'
    )
    program.chmod(0o755)
    (tmp_path / "count").touch()
    (tmp_path / "size.h").write_text("#define SIZE 3\n#ifndef UNUSED\n#define UNUSED 0\n#endif\n")
    (tmp_path / "array.c").write_text('#include "size.h"\nint array[SIZE];\n')
    return program


def compilations(compiler: Path, *flags: str) -> int:
    """How many there have been after one more request for the array."""
    folder = compiler.parent
    command = [compiler, *flags, "-Wall", "-c", folder / "array.c"]
    compiled(command, folder / "array.o", folder / "kept")
    return len((folder / "count").read_text())


def test_the_same_is_compiled_once(compiler: Path) -> None:
    assert compilations(compiler) == 1
    first = (compiler.parent / "array.o").read_bytes()
    (compiler.parent / "array.o").unlink()
    assert compilations(compiler) == 1
    assert (compiler.parent / "array.o").read_bytes() == first


def test_a_flag_a_header_a_macro_and_a_line_count(compiler: Path) -> None:
    header, source = (compiler.parent / name for name in ("size.h", "array.c"))
    assert compilations(compiler) == 1
    assert compilations(compiler, "-g") == 2
    assert compilations(compiler, "-DUNUSED=1") == 3  # the text of the program stays the same
    source.write_text("\n" + source.read_text())
    assert compilations(compiler) == 4
    header.write_text(header.read_text().replace("3", "4"))
    assert compilations(compiler) == 5
    header.write_text(header.read_text().replace("UNUSED 0", "UNUSED 1"))
    assert compilations(compiler) == 6


def test_what_the_compiler_says_is_kept(compiler: Path) -> None:
    source = compiler.parent / "warned.c"
    source.write_text("static int unused;\n")
    command = [compiler, "-Wall", "-c", source]
    said = [compiled(command, compiler.parent / "o", compiler.parent / "kept") for _ in range(2)]
    assert "warned.c:1" in said[0] and said[1] == said[0]
    assert len((compiler.parent / "count").read_text()) == 1


@pytest.mark.parametrize("text", ["int x = ;\n", "#error no\n"])
def test_a_refusal_is_not_kept(compiler: Path, text: str) -> None:
    source = compiler.parent / "wrong.c"
    source.write_text(text)
    for _ in range(2):
        with pytest.raises(CompilerError, match="error"):
            compiled([compiler, "-c", source], compiler.parent / "o", compiler.parent / "kept")
    assert not (compiler.parent / "o").exists()


def test_a_program_compiles_links_and_fails_as_the_compiler_does(
    compiler: Path,
) -> None:
    folder = compiler.parent
    program = [remembering(folder / "program"), str(compiler)]
    (folder / "main.c").write_text("int answer(void); int main(void) { return answer(); }\n")
    (folder / "answer.c").write_text("int answer(void) { return 42; }\n")

    def run(*words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([*program, *words], cwd=folder, capture_output=True, text=True)

    for stem in ("main", "answer"):
        assert run("-MD", "-MF", "used", "-o", f"{stem}.o", "-c", f"{stem}.c").returncode == 0
    assert "answer.c" in (folder / "used").read_text()
    assert run("main.o", "answer.o", "-o", "linked").returncode == 0
    assert subprocess.run([folder / "linked"]).returncode == 42
    (folder / "main.c").write_text("int main(void) { return nothing; }\n")
    refused = run("-c", "main.c", "-o", "main.o")
    assert refused.returncode == 1 and "nothing" in refused.stderr
