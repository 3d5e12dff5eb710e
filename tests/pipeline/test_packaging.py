"""The sdist is complete, and the wheel needs only NumPy."""

import os
import shutil
import subprocess
import sys
import sysconfig
import tarfile
from pathlib import Path

import numpy
import pytest
from sharing import quick_compiler, shared

from closedform.pipeline.folders import checkout

ROOT = checkout()
pytest.importorskip("build", reason="the package build is not installed: pip install build")
pytestmark = pytest.mark.skipif(ROOT is None, reason="only a checkout can be packaged")

OUTSIDE = shutil.ignore_patterns(".*", "build", "dist", "*.egg-info", "__pycache__", "*.so")


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the sdist of this checkout, and the wheel that was built from the sdist."""
    return shared(tmp_path_factory, "packaging", build)


def build(folder: Path) -> None:
    assert ROOT is not None
    shutil.copytree(ROOT, folder / "checkout", ignore=OUTSIDE)
    (folder / "quick").mkdir()
    compiler = {"CC": quick_compiler(folder / "quick")} if os.name == "posix" else {}
    run("-m", "build", "--no-isolation", "--outdir", folder, folder / "checkout", **compiler)
    (wheel,) = folder.glob("*.whl")
    pip = ("-m", "pip", "install", "--quiet", "--no-deps", "--no-index")
    run(*pip, "--target", folder / "target", wheel)


@pytest.fixture(scope="module")
def installed(built: Path) -> Path:
    """The wheel alone, unpacked into a folder."""
    return built / "target"


def run(*arguments: str | Path, **variables: str) -> str:
    # a third of the time to compile
    baseline = {**os.environ, "CLOSEDFORM_DISPATCH": "0", **variables}
    command = [sys.executable, *arguments]
    done = subprocess.run(command, env=baseline, capture_output=True, text=True, check=False)
    assert done.returncode == 0, (done.stdout + done.stderr)[-4000:]
    return done.stdout


def alone(target: Path, code: str) -> str:
    """Run code that sees the standard library, NumPy and the wheel, but not the checkout."""
    paths = [str(target), str(Path(numpy.__file__).parents[1])]
    return run("-I", "-S", "-c", f"import sys\nsys.path[:0] = {paths}\n{code}")


def below(folder: Path, *suffixes: str) -> set[str]:
    return {
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*")
        if path.suffix in suffixes and "__pycache__" not in path.parts
    }


def test_the_wheel_works_with_numpy_alone(installed: Path) -> None:
    alone(
        installed,
        f"""
import closedform
assert closedform.__file__.startswith({str(installed)!r}), closedform.__file__
from closedform.generated.c import planar_2r as fast
from closedform.generated.numpy import planar_2r
x = planar_2r.fk([0.3, -1.1])
for module in (planar_2r, fast):
    solutions = module.ik(x)
    assert (solutions.status == module.Status.OK).all()
    assert abs(module.fk(solutions.q) - x).max() < 1e-12
heavy = {{"sympy", "mpmath", "flint", "jinja2"}} & set(sys.modules)
assert not heavy, heavy
""",
    )


def test_without_a_compiler_the_numpy_modules_are_installed(built: Path, tmp_path: Path) -> None:
    setup = built / "checkout/setup.py"
    code = f"import os, runpy, sys; os.chdir({str(setup.parent)!r}); sys.argv[1:] = "
    code += (
        f"['--quiet', 'build', '--build-base', {str(tmp_path)!r}]; runpy.run_path({str(setup)!r})"
    )
    run("-c", code, CLOSEDFORM_COMPILE="0", CC="/nowhere/cc")
    assert list(tmp_path.rglob("generated/numpy/planar_2r.py"))
    assert not [*tmp_path.rglob("*.so"), *tmp_path.rglob("*.o")]
    (package,) = tmp_path.rglob("lib*/closedform")
    alone(
        package.parent,
        """
try:
    from closedform.generated.c import planar_2r
except ImportError as error:
    assert "take closedform.generated.numpy" in str(error), error
else:
    raise AssertionError
""",
    )


def test_the_wheel_holds_everything(installed: Path) -> None:
    assert ROOT is not None
    package = installed / "closedform"
    for folder in ("derivations", "generated", "templates"):
        suffixes = (".py", ".c", ".h", ".in", ".txt", ".tex", ".csv", ".md", ".jinja", ".js")
        assert below(package / folder, *suffixes) == below(ROOT / folder, *suffixes)
    assert (package / "generated" / "js" / "package.json").is_file()
    kinds = (".py", ".typed", ".h", ".js", ".mjs")
    assert below(ROOT / "closedform", *kinds) <= below(package, *kinds)


def test_the_sdist_holds_everything(built: Path) -> None:
    assert ROOT is not None
    (archive,) = built.glob("*.tar.gz")
    with tarfile.open(archive) as tar:
        names = {name.partition("/")[2] for name in tar.getnames()}
    expected = {
        path.relative_to(ROOT).as_posix()
        for folder in ("closedform", "derivations", "docs", "generated", "templates", "tests")
        for path in (built / "checkout" / folder).rglob("*")
        for path in [ROOT / path.relative_to(built / "checkout")]
        if path.is_file()
    }
    assert expected <= names, sorted(expected - names)
    assert {"Makefile", "README.md", "LICENSE", "CHANGELOG.md", "CITATION.cff"} <= names


def test_the_command_line_says_what_is_missing(installed: Path) -> None:
    output = alone(
        installed,
        """
import contextlib, io
sys.modules.update(dict.fromkeys(["sympy", "flint", "jinja2"]))
from closedform.cli.commands import main
assert main(["list"]) == 0
assert main(["errata"]) == 0
for command in (["derive", "-o", "nowhere"], ["check"], ["show", "planar_2r"]):
    with contextlib.redirect_stderr(io.StringIO()) as stderr:
        assert main(command) == 1
    print(stderr.getvalue())
""",
    )
    assert output.count("pip install 'closedform[derive]'") == 3
    assert "planar_2r" in output


def test_the_wheel_derives_with_the_extra(installed: Path, tmp_path: Path) -> None:
    """With SymPy but outside of a checkout, the printed files are the shipped ones."""
    site = str(Path(sysconfig.get_path("purelib")))
    alone(
        installed,
        f"""
sys.path.append({site!r})
from closedform.cli.commands import main
assert main(["derive"]) == 2
assert main(["derive", "planar_2r", "-o", {str(tmp_path)!r}, "--backend", "numpy"]) == 0
""",
    )
    printed = (tmp_path / "numpy" / "planar_2r.py").read_bytes()
    assert printed == (installed / "closedform/generated/numpy/planar_2r.py").read_bytes()
