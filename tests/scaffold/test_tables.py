"""Tables of joints with a mistake: one line says where it is and what to write instead."""

from pathlib import Path

import numpy as np
import pytest

from closedform.check.runners.python import module
from closedform.cli.commands import main
from closedform.pipeline.scripts import find, load
from closedform.scaffold.inputs.tables import read_dh

HEADER = "a, alpha, d, theta\n"
AXIS = '[[axes]]\njoint = "t1"\ndirection = [0, 0, 1]\n'
HOME = '[home]\nposition = ["L", 0, 0]\n'


def complaint(folder: Path, kind: str, text: str, capsys: pytest.CaptureFixture[str]) -> str:
    """The command's complaint about a table: one line, and no script."""
    table = folder / "table"
    table.write_text(text, "utf-8")
    assert main(["new", "arm", "--from", kind, str(table), "-o", str(folder)]) == 1
    said = capsys.readouterr().err
    assert said.startswith("closedform: ") and said.count("\n") == 1
    assert not (folder / "arm.py").exists()
    return said


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a, alpha, d\n0, 0, 1\n", "table, line 1: the column theta is missing"),
        ("a, alpha, d, theta\n0, 0, q1\n", "table, line 2: 3 entries in 4 columns"),
        ("a, alpha, d, theta\n0, 0, 0, 0\n", "line 2: there is no joint"),
        ("a, alpha, d, theta\n1, 10, 0, t\n", "write pi/18 instead of 10"),
        ("a, alpha, d, theta\n1, 0, 0, t + 22.5\n", "write t + pi/8 instead of t + 22.5"),
        ("a, alpha, d, theta\n0, 0, 0, t1 + t2\n", "line 2: theta has the symbols t1, t2"),
        ("a, alpha, d, theta\n0, 0, 0, t\n0, 0, 0, t\n", "line 3: two joints have the name t"),
        (
            "a, alpha, d, theta\n1, 0, 0, u\n1, 0, 0, v - u + pi/2\n",
            "u is the joint of an earlier row; if motors drive both, through a belt or a "
            "parallelogram, give this joint a new name and write -u + v in a column motors; if the "
            "row keeps a hand level, leave it out and add the lengths after it to the first row",
        ),
        ("a, alpha, d, theta\n0, 90 deg, 0, t\n", "in radians, as multiples of pi; write pi/2"),
        ("a, alpha, d, theta\n0, 90°, 0, t\n", "in radians, as multiples of pi; write pi/2"),
        ("a, alpha, d, theta\n0, radians(90), 0, t\n", "angles are in radians"),
        ("a, alpha, d, theta\n0, π/2, 0, t\n", "write pi for the number"),
        ("a, alpha, d, theta\n0, np.pi/2, 0, t\n", "write pi for the number"),
        ("a, alpha, d, theta\n0, PI/2, 0, t\n", "alpha: write pi for the number, instead of PI"),
        ("a, alpha, d, theta\n0, \u2212pi/2, 0, t\n", "write - for a minus"),
        ("a, alpha, d, theta\nL^2, 0, 0, t\n", "write ** for a power"),
        ("a, alpha, d, theta\n400 mm, 0, 0, t\n", "write all lengths in the same one"),
        ("a, alpha, d, theta\n0, 0, 0, 2t\n", "write * for a product"),
        ("a, alpha, d, theta\n0, 0, 0, θ1\n", "names have Latin letters"),
        ("a, alpha, d, theta\n0, 0, , t\n", "column d: cannot read ''; the cell is empty; write 0"),
        ("a, alpha, d, theta\n(, 0, 0, t\n", "line 2, column a: cannot read '('"),
        ("# L = 1 m: x\na, alpha, d, theta\n0, 0, 0, t\n", "the parameter L is not used"),
        ("", "the table is empty"),
        ("a, alpha, d, theta\n", "the table has only column names"),
        ("a; alpha; d; theta\n", "separated by commas"),
        ("a, alpha, d, theta, m\n0, 0, 0, t, 1\n", "line 1: the column m is unknown"),
        ("a, alpha, d, theta\n1, 90, 0, t\n", "column alpha: angles must be in radians and"),
        ("a, alpha, d, theta\n1, 1.5708, 0, t\n", "write pi/2 instead of 1.5708"),
        ("a, alpha, d, theta\n1, 0, 0, t + 90\n", "write t + pi/2 instead of t + 90"),
        ("a, alpha, d, theta\n1, 0, 0, 2*t\n", "as it is or with a constant added"),
        ("a, alpha, d, theta\n1/0, 0, 0, t\n", "column a: cannot read '1/0'; it divides by zero"),
        ("a, alpha, d, theta\n1, 0, 0, foo(t)\n", "column theta: cannot read 'foo(t)'"),
        ("a, alpha, d, theta\nlambda, 0, 0, t\n", "lambda is a word of Python;"),
        ("a, alpha, d, theta\nx, 0, 0, t\n", "the written script uses the name x"),
        ("# L = 1/0 m: x\na, alpha, d, theta\nL, 0, 0, t\n", "the value of L is '1/0'"),
        ("a, alpha, d, theta, a\n0, 0, 0, t, 0\n", "line 1: there are two columns a"),
        ("a, alpha, d, theta\nnan, 0, 0, t\n", "line 2, column a: nan is not a finite number"),
        ("a, alpha, d, theta\n-inf, 0, 0, t\n", "inf is not a finite number"),
        ("a, alpha, d, theta\nsqrt(-1), 0, 0, t\n", "'sqrt(-1)' is not a real number or formula"),
        (
            "a, alpha, d, theta\n9**9**9, 0, 0, t\n",
            "an exponent is a whole number from -9 to 9, or a half",
        ),
        ("a, alpha, d, theta\n1e99999, 0, 0, t\n", "with at most three digits after e"),
        ("a, alpha, d, theta\n((L, 0, 0, t\n", "column a: cannot read '((L'"),
        ("a, alpha, d, theta\nt, 0, 0, t\n", "row 1 of the Denavit-Hartenberg table: the joint t"),
        ("a, alpha, d, theta\ndouble, 0, 0, t\n", "choose another name, such as double_0"),
        ("a, alpha, d, theta\n_L, 0, 0, t\n", "'_L' is not a name"),
        ("# L = 1 m: x\n# L = 2 m: x\na, alpha, d, theta\nL, 0, 0, t\n", "line 2: the parameter L"),
        ("# L = nan m: x\na, alpha, d, theta\nL, 0, 0, t\n", "line 1: the value of L is 'nan'"),
        ("# L = pi/2 rad: x\na, alpha, d, theta\nL, 0, 0, t\n", "the value of L is 'pi/2'"),
        (
            "# L = 400 mm: x\n# K = 0.3 m: x\na, alpha, d, theta\nL, 0, K, t\n",
            "L is in mm and K in m; write all lengths in the same unit",
        ),
        (
            "# b = 90 deg: x\na, alpha, d, theta\n0, b, 1, t\n",
            "write b = 1.570796326794897 rad, or a multiple of pi in its place in the table",
        ),
        ("# L = 1e400 m: x\na, alpha, d, theta\nL, 0, 0, t\n", "the value of L is '1e400'"),
    ],
)
def test_rows(tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, message: str) -> None:
    assert message in complaint(tmp_path, "dh", text, capsys)


def axis(**given: str) -> str:
    """A file whose only axis has these entries instead of valid ones."""
    entries = {"joint": '"t1"', "direction": "[0, 0, 1]"} | given
    return "[[axes]]\n" + "".join(f"{k} = {v}\n" for k, v in entries.items() if v) + HOME


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "there are no [[axes]]"),
        ("axes = 3 4", "table is not valid TOML: "),
        ("axes = [1, 2]\n", "axis 1 must be a table of keys and values"),
        ("[parameters]\n", "there are no [[axes]]"),
        ("[[axis]]\n", "the key axis is unknown; the keys are parameters, axes, home"),
        ("parameters = [1]\n" + axis(), "[parameters] must be a table of keys and values"),
        ("[parameters]\nL = nan\n" + axis(), "the value of L is 'nan'; it must be a number"),
        ("[parameters]\nL = [1]\n" + axis(), "the value of L is a list; it must be a number"),
        ("[parameters]\nL = 1e-400\n" + axis(), "the value of L is '1e-400'"),
        ("[parameters]\nL = { units = 1 }\n" + axis(), "the keys are value, unit, meaning"),
        ("[parameters]\nL = { unit = 1 }\n" + axis(), "the unit of L must be a string, not 1"),
        (
            '[parameters]\nL = { meaning = "a\\nb" }\n' + axis(),
            "must be one line of printable text",
        ),
        ("[parameters]\nL = 1\nK = 1\n" + axis(), "the parameter K is not used"),
        (axis(direction=""), "axis 1: direction is missing"),
        (axis(joint=""), "axis 1: joint is missing"),
        (axis(joint="3"), 'axis 1: joint must be a name, such as "theta1", not 3'),
        ("[parameters]\nL = 1\n" + axis(joint='"L"'), "L is a joint and a parameter"),
        (axis(joint='"my joint"'), "'my joint' is not a name"),
        (axis(joint='"while"'), "while is a word of Python and C and JavaScript"),
        (AXIS + axis(), "axis 2: two joints have the name t1"),
        (axis(kind='"helical"'), "kind must be revolute or prismatic, not helical"),
        (axis(pitch="3"), "axis 1: the key pitch is unknown"),
        (axis(direction="[0, 1, 1]"), "the length 1.41421, not 1; write (0, sqrt(2)/2, sqrt(2)/2)"),
        (axis(direction="[0, 0.7, 0.7]"), "write sqrt(2)/2, not 0.7071"),
        (axis(direction='["u", 0, 0]'), "write numbers, or the cosine and the sine of an angle"),
        (axis(direction="[0, 0, 0]"), "the direction (0, 0, 0) is zero"),
        (axis(direction='["cos(t1)", "sin(t1)", 0]'), "axis 1: it contains the joint t1"),
        (axis(direction="[0, 0, nan]"), "axis 1, direction: nan is not a finite number"),
        (axis(direction="[0, 0, true]"), "axis 1, direction: True is not a number or formula"),
        (axis(direction='"z"'), "direction needs 3 coordinates, such as [0, 0, 1], not 'z'"),
        (axis(point="[0, 0]"), "axis 1, point needs 3 coordinates"),
        (axis(point='["0,3", 0, 0]'), "cannot read '0,3'; a formula has symbols"),
        (AXIS, "[home]: position is missing"),
        (AXIS + "[home]\nposition = [0, 0]\n", "[home], position needs 3 coordinates"),
        (AXIS + '[home]\nposition = ["t1", 0, 0]\n', "at home all joints are zero"),
        (axis() + "rotation = 3\n", "rotation must have 3 rows of 3 entries, not 3"),
        (axis() + "rotation = [[1, 0], [0, 1, 0], [0, 0, 1]]\n", "rotation, row 1 needs 3"),
        (
            axis() + "rotation = [[2, 0, 0], [0, 1, 0], [0, 0, 1]]\n",
            "is not a rotation: row 1 has the length 2;",
        ),
        (
            axis() + "rotation = [[1, 0, 0], [0.6, 0.8, 0], [0, 0, 1]]\n",
            "the scalar product of the rows 1 and 2 is 0.6;",
        ),
        (axis() + "rotation = [[1, 0, 0], [0, 1, 0], [0, 0, -1]]\n", "is mirrored"),
    ],
)
def test_axes(tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, message: str) -> None:
    assert message in complaint(tmp_path, "screws", text, capsys)


def test_a_table_that_is_no_text(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "table.csv"
    table.write_bytes(b"\xff\xfe\x00a")
    assert main(["new", "arm", "--from", "dh", str(table), "-o", str(tmp_path)]) == 1
    assert "is not UTF-8 text" in capsys.readouterr().err
    table.write_bytes(b"\xef\xbb\xbf" + (HEADER + "L, 0, 0, t\n").encode())
    assert main(["new", "arm", "--from", "dh", str(table), "-o", str(tmp_path)]) == 0


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("my arm", "'my arm' is not a name of a module"),
        ("../arm", "is not a name of a module"),
        ("_arm", "is not a name of a module"),
        ("Ärm", "is not a name of a module"),
        ("class", "the name class is taken"),
        ("closedform", "the name closedform is taken"),
        ("sympy", "sympy is a Python module"),
        ("math", "math.h is a header of the system"),
        ("json", "json is a Python module"),
    ],
)
def test_names_of_robots(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, message: str
) -> None:
    table = tmp_path / "table.csv"
    table.write_text(HEADER + "L, 0, 0, t\n", "utf-8")
    assert main(["new", name, "--from", "dh", str(table), "-o", str(tmp_path)]) == 1
    assert message in capsys.readouterr().err
    assert not list(tmp_path.glob("**/*.py"))


def test_files_and_options(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "table.toml"
    table.write_text(axis(), "utf-8")
    for arguments, message in (
        (["screws", "nowhere.toml"], "there is no file nowhere.toml"),
        (["screws", str(tmp_path)], "is not a file"),
        (["usd", str(table)], "urdf FILE.urdf, mjcf FILE.xml or loop FILE.toml, not usd"),
        (["screws", str(table), "--modified"], "--modified is for --from dh"),
    ):
        assert main(["new", "arm", "-o", str(tmp_path), "--from", *arguments]) == 2
        assert message in capsys.readouterr().err


def test_any_text_may_say_what_a_parameter_is(tmp_path: Path) -> None:
    table = tmp_path / "table.toml"
    entry = """L = { value = 1, unit = 'k"', meaning = 'the "long" one, 5 % of it' }"""
    table.write_text(f"[parameters]\n{entry}\n{axis()}", "utf-8")
    assert main(["new", "quoted", "--from", "screws", str(table), "-o", str(tmp_path)]) == 0
    (parameter,) = load(find([str(tmp_path / "quoted.py")])[0]).parameters
    assert (parameter.unit, parameter.meaning) == ('k"', 'the "long" one, 5 % of it')


def test_a_parameter_without_a_value_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its example value is 1, which nobody gave."""
    path = tmp_path / "arm.csv"
    rows = "# r = 0.4 m: reach\na, alpha, d, theta\nr, 0, 0, t1\nb, 0, 0, t2\n"
    path.write_text(rows, "utf-8")
    assert main(["new", "two", "--from", "dh", str(path), "-o", str(tmp_path)]) == 0
    said = capsys.readouterr().err
    assert "no value is given for b, so 1 is taken; write one in a line '# b = 0.1 m" in said
    path.write_text(f"# b = 0.3 m: second\n{rows}", "utf-8")
    assert main(["new", "both", "--from", "dh", str(path), "-o", str(tmp_path)]) == 0
    assert "no value" not in capsys.readouterr().err


def test_column_names_may_have_capitals(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("Joint, A, Alpha, D, Theta\nt, 0.5, 0, 0, t\n", "utf-8")
    assert list(read_dh(path).joints) == ["t"]


RENAMED = HEADER + "0, pi/2, 0.3, yaw\n0.4, 0, 0, M\n0, pi/2, 0, double\n0, 0, 0.2 + p, 0\n"
SCREWS = "\n".join(
    f'[[axes]]\njoint = "{name}"\nkind = "{kind}"\ndirection = {w}\npoint = {p}'
    for name, kind, w, p in (
        ("yaw", "revolute", [0, 0, 1], [0, 0, 0]),
        ("M", "revolute", [0, -1, 0], [0, 0, "3/10"]),
        ("double", "revolute", [0, -1, 0], ["2/5", 0, "3/10"]),
        ("p", "prismatic", [0, 0, -1], [0, 0, 0]),
    )
)
AT_HOME = (
    '\n[home]\nposition = ["2/5", 0, "1/10"]\nrotation = [[1, 0, 0], [0, -1, 0], [0, 0, -1]]\n'
)
JOINTS = ["yaw_0", "M_0", "double_0", "p_0"]


def pose(q: np.ndarray) -> np.ndarray:
    """The pose of both tables, as a product of exponentials."""
    T, up, across = np.eye(4), (0, 0, 1), (0, -1, 0)
    points = ((0, 0, 0), (0, 0, 0.3), (0.4, 0, 0.3))
    for angle, w, p in zip(q[:3], (up, across, across), points, strict=True):
        K = np.cross(np.eye(3), w)
        step = np.eye(4)
        step[:3, :3] += np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
        step[:3, 3] = p - step[:3, :3] @ p
        T = T @ step
    home = np.diag([1.0, -1, -1, 1])
    home[:3, 3] = 0.4, 0, 0.1 - q[3]
    found: np.ndarray = T @ home
    return found


@pytest.mark.parametrize(("kind", "text"), [("dh", RENAMED), ("screws", SCREWS + AT_HOME)])
def test_a_joint_with_a_name_of_the_script_gets_another(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], kind: str, text: str
) -> None:
    """As a joint of a URDF file does; tables were refused."""
    table = tmp_path / "table"
    table.write_text(text, "utf-8")
    assert main(["new", "arm", "--from", kind, str(table), "-o", str(tmp_path)]) == 0
    said = capsys.readouterr().err
    assert all(f"{name[:-2]}: it is called {name}\n" in said for name in JOINTS)
    out = ["-o", str(tmp_path / "out"), "--backend", "numpy", "--no-crosscheck"]
    assert main(["derive", str(tmp_path / "arm.py"), *out]) == 0
    arm = module(tmp_path / "out" / "numpy", "arm")
    q = np.random.default_rng(0).uniform(0.1, 1, (100, 4))
    x = arm.fk(q)
    assert np.abs(x - [pose(joints) for joints in q]).max() < 1e-14
    found, status = arm.ik(x)
    apart = np.abs(np.exp(1j * (found - q[:, None])) - 1).max(axis=-1)
    assert (np.where(status == 0, apart, 1).min(axis=-1) < 1e-12).all()


def test_a_held_joint_has_the_name_that_the_script_gives_it(tmp_path: Path) -> None:
    """The advice to hold a joint names it as the script does."""
    table = tmp_path / "table.csv"
    table.write_text("# M_0 = 0.1 rad: held\n" + RENAMED, "utf-8")
    read = read_dh(table)
    assert list(read.joints) == ["yaw_0", "double_0", "p_0"] and "M_0" in read.parameters
