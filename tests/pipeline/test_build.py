"""Builds that are killed, run twice at once, or find the remains of an earlier build."""

import errno
import os
import shutil
import signal
import subprocess
import sys
import sysconfig
import time
from pathlib import Path

import libraries
import pytest
from places import ROOT

from closedform.cli.commands import main
from closedform.pipeline import disk, folders, scripts
from closedform.pipeline import run as pipeline

SUFFIX = sysconfig.get_config_var("EXT_SUFFIX")

MODULE = """
#include <Python.h>
int answer(void);
static PyObject *ask(PyObject *self, PyObject *none)
{
    (void)self;
    (void)none;
    return PyLong_FromLong(answer());
}
static PyMethodDef methods[] = {{"ask", ask, METH_NOARGS, ""}, {0}};
static struct PyModuleDef module = {PyModuleDef_HEAD_INIT, "_native", "", -1, methods};
PyMODINIT_FUNC PyInit__native(void) { return PyModule_Create(&module); }
"""

COMPILER = """#!/bin/sh
# A compiler that writes half of its output and kills the build with itself, where it is told so.
for argument; do
    [ "$before" = -o ] && target=$argument
    before=$argument
done
echo "$target" >> LOG
echo "$*" >> FLAGS
case "$*" in *-shared*) kind=link ;; *) kind=compile ;; esac
if [ -e "kill-$kind" ]; then
    printf half > "$target"
    kill -9 $PPID $$
fi
exec cc "$@"
"""

needs_cc = pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")


@pytest.fixture
def toy(tmp_path: Path) -> Path:
    """The build of this project with two tiny sources."""
    for name in ("setup.py", "pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, tmp_path)
    for name, text in (
        ("closedform/runtime/extension/module.c", MODULE),
        ("generated/c/answer.c", "int answer(void);\nint answer(void) { return 42; }\n"),
    ):
        (tmp_path / name).parent.mkdir(parents=True)
        (tmp_path / name).write_text(text, "utf-8")
    compiler = tmp_path / "compiler"
    compiler.write_text(COMPILER, "utf-8")
    compiler.chmod(0o755)
    return tmp_path


def start(toy: Path) -> subprocess.Popen[str]:
    command = [sys.executable, "setup.py", "--quiet", "build_ext", "--inplace"]
    environment = {**os.environ, "CC": str(toy / "compiler"), "CFLAGS": "-O0"}
    return subprocess.Popen(
        command,
        cwd=toy,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def build(toy: Path) -> list[str]:
    """Build, and return the names of the files that the compiler made."""
    log = toy / "LOG"
    log.unlink(missing_ok=True)
    process = start(toy)
    output, _ = process.communicate(timeout=60)
    assert process.returncode == 0, output
    return sorted(Path(line).name for line in log.read_text().split()) if log.exists() else []


def answer(toy: Path) -> str:
    return subprocess.run(
        [sys.executable, "-c", "import _native; print(_native.ask())"],
        cwd=toy / "generated" / "c",
        capture_output=True,
        text=True,
        check=True,
    ).stdout


ALL = sorted(["module.o", "answer.o", f"_native{SUFFIX}"])


@needs_cc
@pytest.mark.parametrize("kind", ["compile", "link"])
def test_a_killed_build_leaves_nothing_that_counts(toy: Path, kind: str) -> None:
    (toy / f"kill-{kind}").touch()
    process = start(toy)
    process.communicate(timeout=60)
    assert process.returncode == -signal.SIGKILL
    assert not list(toy.glob("generated/c/*.so"))
    (toy / f"kill-{kind}").unlink()
    build(toy)
    assert answer(toy) == "42\n"


@needs_cc
def test_what_is_not_whole_is_built_again(toy: Path) -> None:
    assert build(toy) == ALL
    assert build(toy) == []
    for pattern in ("build/temp*/**/answer.o", f"build/lib*/**/_native{SUFFIX}"):
        (path,) = toy.glob(pattern)
        path.write_bytes(path.read_bytes()[:100])
    (toy / "generated" / "c" / f"_native{SUFFIX}").write_bytes(b"half")
    assert build(toy) == sorted(["answer.o", f"_native{SUFFIX}"])
    assert answer(toy) == "42\n"
    (toy / "generated" / "c" / f"_native{SUFFIX}").unlink()
    assert build(toy) == []
    assert answer(toy) == "42\n"


@needs_cc
def test_only_what_changed_is_compiled(toy: Path) -> None:
    build(toy)
    source = toy / "generated" / "c" / "answer.c"
    source.touch()
    assert build(toy) == []
    source.write_text(source.read_text("utf-8").replace("42", "43"), "utf-8")
    assert build(toy) == sorted(["answer.o", f"_native{SUFFIX}"])
    assert answer(toy) == "43\n"


@needs_cc
@pytest.mark.parametrize(
    ("dispatch", "marched", "cloned"), [("", True, False), ("1", False, True), ("0", False, False)]
)
def test_what_is_built_in_place_is_for_this_processor(
    toy: Path, monkeypatch: pytest.MonkeyPatch, dispatch: str, marched: bool, cloned: bool
) -> None:
    """The rest of the module, which says whether it can be loaded, is for any processor."""
    if not (libraries.compiles() and libraries.runs()):
        pytest.skip("gcc does not build clones for this processor")
    for name in ("answer", "closedform"):
        (toy / "generated" / "c" / f"{name}.h").write_text("")
    monkeypatch.setenv("CLOSEDFORM_DISPATCH", dispatch)
    build(toy)
    assert answer(toy) == "42\n"
    lines = (toy / "FLAGS").read_text().splitlines()
    (robot,), (module,) = (
        [line for line in lines if f"/{name}.c" in line] for name in ("answer", "module")
    )
    assert ("-march=x86-64-v" in robot) == marched
    assert ("-DCLOSEDFORM_DISPATCH" in robot) == cloned
    assert "-march" not in module
    assert ("-DCLOSEDFORM_PROCESSOR=" in module) == marched


@needs_cc
def test_two_builds_at_once(toy: Path) -> None:
    for process in [start(toy), start(toy)]:
        output, _ = process.communicate(timeout=60)
        assert process.returncode == 0, output
    assert answer(toy) == "42\n"


# A whole tree, with make

PYTHON = r"""#!/bin/sh
# Makes an environment whose pip kills itself where it is told so.
case "$*" in
    "-m venv .venv") mkdir -p .venv/bin; cp "$0" .venv/bin/python; echo venv >> LOG ;;
    "-m pip"*.\[make\]) echo pip >> LOG; [ ! -e kill-pip ] || kill -9 $$; [ ! -e fail-pip ] ;;
    *) exec REAL "$@" ;;
esac
"""


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    for name in ("Makefile", "pyproject.toml", "setup.py"):
        shutil.copy(ROOT / name, tmp_path)
    for name in ("closedform", "derivations", "templates", "generated"):
        (tmp_path / name).mkdir()
    python = tmp_path / "python"
    python.write_text(PYTHON.replace("REAL", sys.executable), "utf-8")
    python.chmod(0o755)
    return tmp_path


def make(tree: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    outside = {k: v for k, v in os.environ.items() if not k.startswith(("MAKE", "MFLAGS"))}
    command = ["make", f"PYTHON={tree / 'python'}", *arguments]
    return subprocess.run(
        command, cwd=tree, env=outside, capture_output=True, text=True, timeout=120, check=False
    )


needs_make = pytest.mark.skipif(shutil.which("make") is None, reason="there is no make")


@needs_make
def test_an_environment_in_which_pip_was_killed_is_made_anew(tree: Path) -> None:
    stamp, log = ".venv/make.stamp", tree / "LOG"
    (tree / "kill-pip").touch()
    assert make(tree, stamp).returncode != 0
    assert not (tree / stamp).exists()
    (tree / "kill-pip").unlink()
    (tree / ".venv" / "half").touch()
    assert make(tree, stamp).returncode == 0
    assert not (tree / ".venv" / "half").exists()
    assert log.read_text().split() == ["venv", "pip", "venv", "pip"]
    assert make(tree, stamp).returncode == 0
    assert log.read_text().split() == ["venv", "pip", "venv", "pip"]


@needs_make
def test_an_environment_in_which_pip_failed_is_kept(tree: Path) -> None:
    (tree / "fail-pip").touch()
    assert make(tree, ".venv/make.stamp").returncode != 0
    (tree / "fail-pip").unlink()
    (tree / ".venv" / "kept").touch()
    assert make(tree, ".venv/make.stamp").returncode == 0
    assert (tree / ".venv" / "kept").exists()


@needs_make
def test_make_alone_does_not_install_what_only_tests_need(tree: Path) -> None:
    assert ".venv/dev.stamp" not in make(tree, "--dry-run", "--debug=basic", "all").stdout
    assert ".venv/dev.stamp" in make(tree, "--dry-run", "--debug=basic", "test").stdout


@needs_make
def test_two_makes_take_turns(tree: Path) -> None:
    assert make(tree, ".venv/make.stamp").returncode == 0
    closedform = tree / ".venv" / "bin" / "closedform"
    closedform.write_text("#!/bin/sh\necho begin >> LOG\nsleep 0.5\necho end >> LOG\necho robot\n")
    closedform.chmod(0o755)
    (tree / "LOG").unlink()
    outside = {k: v for k, v in os.environ.items() if not k.startswith(("MAKE", "MFLAGS"))}
    command = ["make", f"PYTHON={tree / 'python'}", "build/derived.txt"]
    makes = [subprocess.Popen(command, cwd=tree, env=outside) for _ in range(2)]
    assert [process.wait(60) for process in makes] == [0, 0]
    assert (tree / "build" / "derived.txt").read_text() == "robot\n"
    log = (tree / "LOG").read_text().split()
    assert log in (["begin", "end"], ["begin", "end", "begin", "end"])


@needs_make
def test_the_c_that_is_there_is_compiled_while_robots_are_proved(tree: Path) -> None:
    """Whether that succeeds does not matter: what was printed meanwhile is compiled afterwards."""
    assert make(tree, ".venv/make.stamp").returncode == 0
    waiting = "for k in $(seq 50); do [ -e {} ] && touch {} && break; sleep 0.1; done"
    compiling = f"touch compiling; {waiting.format('deriving', 'together')}; exit 1"
    programs = {
        "python": f'case "$*" in *build_ext*) {compiling} ;; esac',
        "closedform": f"{waiting.format('compiling', 'deriving')}; echo robot",
    }
    for name, text in programs.items():
        program = tree / ".venv" / "bin" / name
        program.write_text(f"#!/bin/sh\n{text}\n")
        program.chmod(0o755)
    assert make(tree, "build/derived.txt").returncode == 0
    assert (tree / "together").exists()
    assert (tree / "build" / "derived.txt").read_text() == "robot\n"


@needs_make
@pytest.mark.parametrize("forbidden", [True, False])
def test_bytecode_is_kept_in_the_build_where_it_may_not_stand_beside_the_sources(
    tree: Path, monkeypatch: pytest.MonkeyPatch, forbidden: bool
) -> None:
    monkeypatch.delenv("PYTHONPYCACHEPREFIX", raising=False)
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1" if forbidden else "")
    shown = 'show: ; @python="$$PYTHONDONTWRITEBYTECODE $$PYTHONPYCACHEPREFIX"; echo "$$python"'
    done = make(tree, "--eval", shown, "show")
    assert done.stdout.strip() == (f"{tree / 'build' / 'bytecode'}" if forbidden else "")


@needs_make
def test_check_does_not_first_mend_what_it_should_find(tree: Path) -> None:
    (tree / ".venv").mkdir()
    for name in ("make", "dev"):
        (tree / ".venv" / f"{name}.stamp").touch()
    planned = make(tree, "--dry-run", "check").stdout
    assert "closedform check" in planned
    assert "derive" not in planned and "build_ext" not in planned


CLOSEDFORM = """#!PYTHON
import sys
finder = next(m for n, m in sys.modules.items() if n.startswith("__editable___closedform"))
for mapping in (finder.MAPPING, finder.NAMESPACES):
    for name, place in mapping.items():
        moved = [p.replace(OLD, NEW) for p in ([place] if isinstance(place, str) else place)]
        mapping[name] = moved[0] if isinstance(place, str) else moved
if __name__ == "__main__":
    from closedform.cli.commands import main
    sys.exit(main())
"""


def contents(folder: Path) -> dict[Path, bytes]:
    """What the files of a folder hold, without bytecode."""
    found = (p for p in folder.rglob("*") if p.is_file() and p.suffix != ".pyc")
    return {p: p.read_bytes() for p in found}


@needs_make
@pytest.mark.skipif(
    not any(name.startswith("__editable___closedform") for name in sys.modules),
    reason="closedform is not installed in place",
)
def test_a_committed_edit_of_what_is_generated_fails_the_check(tmp_path: Path) -> None:
    for folder in ("closedform", "templates"):
        ignored = shutil.ignore_patterns("__pycache__", "*.so")
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=ignored)
    parts = ("papers/*.py", "claims/__init__.py", "claims/planar_2r*.py", "planar_2r.py")
    derivation = [p.relative_to(ROOT) for part in parts for p in ROOT.glob(f"derivations/{part}")]
    for name in ("Makefile", "pyproject.toml", "setup.py", "derivations/__init__.py", *derivation,
                 "build/proofs/planar_2r.json"):  # fmt: skip
        if (ROOT / name).exists():
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, tmp_path / name)
    for package in (ROOT / "generated").rglob("__init__.py"):
        (tmp_path / package.relative_to(ROOT)).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(package, tmp_path / package.relative_to(ROOT))
    program = tmp_path / ".venv" / "bin" / "closedform"
    program.parent.mkdir(parents=True)
    text = CLOSEDFORM.replace("PYTHON", sys.executable)
    program.write_text(text.replace("OLD", repr(str(ROOT))).replace("NEW", repr(str(tmp_path))))
    program.chmod(0o755)
    for name in ("make", "dev"):
        (tmp_path / ".venv" / f"{name}.stamp").touch()
    shutil.copy(shutil.which("true") or "", tmp_path / "python")
    subprocess.run([program, "derive"], cwd=tmp_path, check=True, capture_output=True, timeout=120)
    for name in ("numpy/planar_2r.py", "errata.md"):
        path = tmp_path / "generated" / name
        path.write_text(path.read_text("utf-8") + "an edit by hand\n", "utf-8")
    git = ["git", "-c", "user.name=a", "-c", "user.email=a@b"]
    if shutil.which("git"):
        for command in (["init", "--quiet"], ["add", "."], ["commit", "--quiet", "-m", "edited"]):
            subprocess.run([*git, *command], cwd=tmp_path, check=True, timeout=60)
    edited = contents(tmp_path / "generated")
    done = make(tmp_path, "--keep-going", "-j2", "regenerated", "warnings-gcc-double")
    assert done.returncode != 0
    for name in ("numpy/planar_2r.py", "errata.md"):
        assert f"differs: {tmp_path / 'generated' / name}" in done.stdout
    assert "run make" in done.stderr
    assert done.stdout.count("differs: ") == 2 and "extra: " not in done.stdout
    assert contents(tmp_path / "generated") == edited


# What closedform writes


def test_a_full_disk_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path, content: bytes) -> int:
        with path.open("wb") as file:
            file.write(content[:3])
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))

    pipeline.write(tmp_path, {Path("a.py"): "old\n"})
    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OSError, match="No space"):
        pipeline.write(tmp_path, {Path("a.py"): "newer\n", Path("b.py"): "never\n"})
    assert [path.name for path in tmp_path.iterdir()] == ["a.py"]
    assert (tmp_path / "a.py").read_text() == "old\n"


def test_a_link_to_a_file_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "real").write_text("old")
    (tmp_path / "link").symlink_to("real")
    disk.replace(tmp_path / "link", b"new")
    assert (tmp_path / "link").is_symlink() and (tmp_path / "real").read_text() == "new"


SLOW = '''"""Takes long."""
import os, pathlib, time
pathlib.Path(__file__).with_suffix(".part").write_text(str(os.getpid()))
pathlib.Path(__file__).with_suffix(".part").rename(pathlib.Path(__file__).with_suffix(".pid"))
time.sleep(300)
d = 1
'''


@pytest.mark.skipif(os.name != "posix", reason="signals are those of POSIX")
@pytest.mark.parametrize("kind", [signal.SIGINT, signal.SIGKILL])
def test_a_derivation_that_is_stopped_stops_its_processes(tmp_path: Path, kind: int) -> None:
    scripts = [tmp_path / "one.py", tmp_path / "two.py"]
    for script in scripts:
        script.write_text(SLOW, "utf-8")
    command = [sys.executable, "-m", "closedform", "derive", *map(str, scripts)]
    process = subprocess.Popen(
        [*command, "-o", str(tmp_path / "out"), "-j", "2"],
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        pids = [int(waited(script.with_suffix(".pid")).read_text()) for script in scripts]
        if kind == signal.SIGINT:
            os.killpg(process.pid, kind)
        else:
            process.send_signal(kind)
        _, errors = process.communicate(timeout=60)
        assert process.returncode == (130 if kind == signal.SIGINT else -kind)
        assert "Traceback" not in errors
        assert ("closedform: interrupted" in errors) == (kind == signal.SIGINT)
        for pid in pids:
            gone(pid)
    finally:
        if process.poll() is None:
            process.kill()


def waited(path: Path) -> Path:
    for _ in range(1200):
        if path.exists():
            return path
        time.sleep(0.05)
    raise AssertionError(f"{path} does not come")


def gone(pid: int) -> None:
    for _ in range(600):
        try:
            os.kill(pid, 0)
        except ProcessLookupError:
            return
        if state(pid) == "Z":
            return
        time.sleep(0.05)
    os.kill(pid, signal.SIGKILL)
    raise AssertionError(f"process {pid} goes on")


def state(pid: int) -> str:
    """Whether a process has ended, though no one has waited for it."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return ""


@pytest.mark.parametrize("name", [source.name for source in scripts.sources()])
def test_every_derivation_is_verified(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    """What ``make`` proved before the tests."""
    root = folders.checkout()
    if root is None or not (root / "build" / "certificates" / f"{name}.json").exists():
        pytest.skip("nothing was proved here; run make")
    assert main(["verify", name]) == 0, capsys.readouterr().out
