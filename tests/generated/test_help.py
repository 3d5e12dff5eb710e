"""What a user meets first: importing, completion, and the help of a module."""

import ast
import importlib
import inspect
import re
import subprocess
import sys

import numpy as np
import pytest

import closedform
from closedform.pipeline import folders, scripts

ROBOTS = [source.name for source in scripts.sources()]


def module(backend: str, robot: str):
    return importlib.import_module(f"closedform.generated.{backend}.{robot}")


def functions(m) -> list[str]:
    return [name for name in m.__all__ if name.islower()]


def fresh(code: str) -> str:
    """The output of code in a separate interpreter."""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


# Importing


def test_attributes_are_imported_when_they_are_asked_for() -> None:
    output = fresh(
        "import sys, closedform\n"
        "assert 'numpy' not in sys.modules and 'closedform.generated' not in sys.modules\n"
        "assert 'puma560' in dir(closedform) and 'generated' in dir(closedform)\n"
        "assert 'numpy' not in sys.modules\n"
        "print(closedform.puma560.__name__, closedform.generated.c.puma560.__name__)\n"
        "assert closedform.generated.numpy.puma560 is closedform.puma560\n"
        "assert not {'sympy', 'jinja2', 'flint'} & set(sys.modules)\n"
    )
    assert output == "closedform.generated.numpy.puma560 closedform.generated.c.puma560\n"


def test_a_module_is_imported_from_the_package() -> None:
    output = fresh(
        "from closedform import puma560, pipeline\nprint(puma560.__name__, pipeline.__name__)"
    )
    assert output == "closedform.generated.numpy.puma560 closedform.pipeline\n"


def test_unknown_attributes() -> None:
    for package in (closedform, closedform.generated, closedform.generated.numpy):
        with pytest.raises(AttributeError, match=rf"'{package.__name__}' has no attribute 'nope'"):
            _ = package.nope
    with pytest.raises(ImportError, match="cannot import name 'nope' from 'closedform'"):
        from closedform import nope  # noqa: F401
    assert set(ROBOTS) <= set(dir(closedform)) & set(dir(closedform.generated.c))


# Completion and help


@pytest.mark.parametrize("robot", ROBOTS)
def test_completion_shows_what_is_public(robot: str) -> None:
    for backend in ("numpy", "c"):
        m = module(backend, robot)
        shown = {name for name in dir(m) if not name.startswith("_")}
        assert shown == set(m.__all__)


@pytest.mark.parametrize("robot", ROBOTS)
def test_every_parameter_is_documented(robot: str) -> None:
    parameters = module("numpy", robot).Parameters
    assert module("c", robot).Parameters is parameters
    header = (folders.generated() / "c" / f"{robot}.h").read_text("utf-8")
    comments = dict(re.findall(r"real_t (\w+); /\* (.*) \*/", header))
    assert tuple(comments) == parameters._fields
    for name, value in parameters()._asdict().items():
        text = getattr(parameters, name).__doc__
        assert f"; default {value!r} (" in text
        assert text.replace(f"; default {value!r}", "") == comments[name]
    assert "ForwardRef" not in str(inspect.signature(parameters))


HEAD = re.compile(r"^(\w+) : ([^,]+)(?:, shape \(\.\.\.(.*)\))?$", re.M)


def sections(text: str) -> dict[str, str]:
    """The sections of a docstring by title; the text before the first has an empty title."""
    parts = re.split(r"\n\n(\w+)\n(-+)\n", "\n\n" + text)
    assert all(len(a) == len(b) for a, b in zip(parts[1::3], parts[2::3], strict=True))
    return {"": parts[0]} | dict(zip(parts[1::3], parts[3::3], strict=True))


def arrays(section: str) -> dict[str, tuple[str, tuple[int, ...]]]:
    """The type and the core shape of each argument that has one."""
    return {
        m[1]: (m[2], tuple(ast.literal_eval(f"({m[3].strip(', ')},)") if m[3].strip(", ") else ()))
        for m in HEAD.finditer(section)
        if m[3] is not None
    }


@pytest.mark.parametrize("robot", ROBOTS)
def test_docstrings_say_what_is_true(robot: str) -> None:
    """Names, shapes and dtypes of the docstring are those of a call, in both back ends."""
    m, c = module("numpy", robot), module("c", robot)
    for name in functions(m):
        f = getattr(m, name)
        text = inspect.getdoc(f)
        assert text == inspect.getdoc(getattr(c, name)).rstrip("\n")
        parts = sections(text)
        assert list(parts)[1:4] == ["Parameters", "Returns", "Raises"]
        assert max(map(len, text.splitlines())) <= 96
        taken, given = arrays(parts["Parameters"]), arrays(parts["Returns"])
        signature = [*inspect.signature(f).parameters]
        assert [*taken, "params", "out"] == signature
        result = f(*(np.zeros((3, *shape)) for _, shape in taken.values()))
        results = result if isinstance(result, tuple) else (result,)
        lead = (3,) if taken else ()
        assert [(*lead, *shape) for _, shape in given.values()] == [r.shape for r in results]
        kinds = [kind for kind, _ in given.values()]
        assert kinds == [f"ndarray of {np.asarray(r).dtype}" for r in results]
        if isinstance(result, tuple):
            assert tuple(given) == result._fields


@pytest.mark.parametrize("robot", ROBOTS)
def test_inverses_tell_units_statuses_and_branches(robot: str) -> None:
    m = module("numpy", robot)
    text = inspect.getdoc(m.ik)
    for word in ("OK (0)", "UNREACHABLE (1)", "SINGULAR (2)", "INVALID (3)", "NaN", "TypeError"):
        assert word in text
    found = re.sub(r"\s+", " ", text)
    if len(m.BRANCHES) > 1:
        assert f"`BRANCHES`: {', '.join(m.BRANCHES)}." in found
    angles = [name for name in m.JOINTS if name.startswith("theta")]
    returned = sections(text)["Returns"].partition("status :")[0]
    assert ("in rad, in (-pi, pi]" in returned) == bool(angles)
    assert ("in the unit of the parameters" in returned) == (len(angles) < len(m.JOINTS))
    assert "T11" not in text and "R11" not in text


@pytest.mark.parametrize("robot", ROBOTS)
def test_what_is_said_of_a_matrix_holds(robot: str) -> None:
    """What is called a rotation is one, and the columns of a Jacobian have the right names."""
    m = module("numpy", robot)
    q = np.random.default_rng(5).uniform(0.2, 0.9, (50, len(m.JOINTS)))
    for name in functions(m):
        f = getattr(m, name)
        said = " ".join(sections(inspect.getdoc(f))["Returns"].split())
        if "proper rotation" in said:
            assert name in ("fk", "pose")
            result = f(q)
            R = (result.p if isinstance(result, m.Positions) else result)[..., :3, :3]
            R = R[np.isfinite(R).all((-1, -2))]
            assert len(R) and np.allclose(np.swapaxes(R, -1, -2) @ R, np.eye(3))
            assert np.allclose(np.linalg.det(R), 1)
        if columns := re.search(r"One column for (?:each of )?([^.]*)\.", said):
            names = m.TASK if name in ("jacobian_parallel", "jacobian_inverse") else m.JOINTS
            assert name.startswith("jacobian")
            assert columns[1] in (", ".join(names), f"{names[0]} to {names[-1]}")
        if name == "skeleton":
            assert said.endswith(f"`SKELETON.points`: {', '.join(m.SKELETON.points)}.")


def test_a_docstring_as_it_is_read() -> None:
    """A complete docstring, for a person to judge."""
    assert inspect.getdoc(module("numpy", "scara").fk) == DOCSTRING


DOCSTRING = """\
Task coordinates (x, y, z, yaw).

Parameters
----------
q : array_like, shape (..., 4)
    theta1, theta2 in rad; d3 in the unit of the parameters; theta4 in rad.
params : Parameters, optional
    The dimensions. Each may be an array that broadcasts with the leading axes.
out : ndarray, optional
    An array to write the result to; it is returned.

Returns
-------
x : ndarray of float64, shape (..., 4)
    x, y, z in the unit of the parameters; yaw in rad, in (-pi, pi].

Raises
------
TypeError
    If an argument does not hold real numbers.
ValueError
    If an argument has the wrong shape, or leading axes do not broadcast.

Notes
-----
- The yaw is reduced to (-pi, pi]."""


@pytest.mark.parametrize("robot", ROBOTS)
def test_comments_of_the_header(robot: str) -> None:
    """Each function has its inputs and outputs, with the sizes of its prototype."""
    header = (folders.generated() / "c" / f"{robot}.h").read_text("utf-8")
    found = re.findall(r"/\*((?:(?!\*/).)*)\*/\nvoid (\w+)\(([^)]*)\);", header, re.S)
    assert [name for _, name, _ in found] == [f"{robot}_{f}" for f in functions(module("c", robot))]
    for comment, _, prototype in found:
        said = re.findall(r"^ \* (\w+) : ([\w ]+)\[(\d+)\]", comment, re.M)
        written = re.findall(r"((?:const )?\w+) (\w+)\[(\d+)\]", prototype)
        assert said == [(name, ctype, size) for ctype, name, size in written]
