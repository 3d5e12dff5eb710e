"""From a table of joints to an import: the unedited skeleton is proved and runs."""

import importlib
import re
import sys
from pathlib import Path

import numpy as np
import pytest

from closedform.cli.commands import main
from closedform.pipeline import trial
from closedform.scaffold.chains.known import KnownMaker
from closedform.scaffold.new import new

pytestmark = pytest.mark.usefixtures("compiled_quickly")

ELBOW = """\
# h = 0.4 m: height of the shoulder
# L1 = 0.5 m: upper arm
a, alpha, d, theta
0, pi/2, h, theta1
L1, 0, 0, theta2
0.45, 0, 0, theta3 - pi/2
"""
SKEW = """\
a, alpha, d, theta
a1, pi/3, 0, theta1
a1, pi/3, 0, theta2
a1, 0, 0, theta3
"""
SLIDES = """\
joint, a, alpha, d, theta
theta1, 0, 0, d0, theta1
d2, 0, -pi/2, d2 + d0, 0
d3, 0, 0, d3, 0
"""
SCREWS = """\
[parameters]
L = { value = 0.3, unit = "m", meaning = "link" }
k = { value = -0.1, unit = "m", meaning = "below" }
[[axes]]
joint = "theta1"
direction = [0, 0, 1]
[[axes]]
joint = "theta2"
direction = [0, 0, 1]
point = ["L", 0, 0]
[home]
position = ["L + 1/5", 0, "k"]
"""


def derived(folder: Path, name: str, kind: str, text: str, monkeypatch: pytest.MonkeyPatch):
    """The NumPy module that follows from a table."""
    table = folder / f"table.{'csv' if kind == 'dh' else 'toml'}"
    table.write_text(text, "utf-8")
    assert main(["new", name, "--from", kind, str(table), "-o", str(folder)]) == 0
    assert main(["derive", str(folder / f"{name}.py"), "-o", str(folder / f"out_{name}")]) == 0
    monkeypatch.syspath_prepend(str(folder))
    importlib.invalidate_caches()
    return importlib.import_module(f"out_{name}.numpy.{name}")


def dh(a: float, alpha: float, d: float, theta: float) -> np.ndarray:
    c, s, k, t = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array(
        [[c, -s * k, s * t, a * c], [s, c * k, -c * t, a * s], [0, t, k, d], [0, 0, 0, 1]]
    )


def test_an_elbow_arm_with_its_inverse(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    arm = derived(tmp_path, "elbow", "dh", ELBOW, monkeypatch)
    first, _, last = capsys.readouterr().out.splitlines()
    assert "an inverse with 4 branches is proposed (turret and two parallel joints)" in first
    assert last.startswith("4 branches proved; next: use ") and "elbow.py" in last
    assert arm.Parameters._fields == ("h", "L1") and arm.Parameters() == (0.4, 0.5)
    q = np.random.default_rng(0).uniform(-3, 3, (30, 3))
    for row in q:
        T = dh(0, np.pi / 2, 0.4, row[0]) @ dh(0.5, 0, 0, row[1])
        T = T @ dh(0.45, 0, 0, row[2] - np.pi / 2)
        np.testing.assert_allclose(arm.pose(row), T, atol=1e-14)
        np.testing.assert_allclose(arm.fk(row), T[:3, 3], atol=1e-14)
    solutions = arm.ik(arm.fk(q))
    assert (solutions.status == 0).all()
    np.testing.assert_allclose(arm.fk(solutions.q), np.repeat(arm.fk(q)[:, None], 4, 1), atol=1e-13)
    gaps = np.abs(np.angle(np.exp(1j * (solutions.q - q[:, None])))).max(-1).min(-1)
    assert gaps.max() < 1e-10
    np.testing.assert_allclose(arm.determinant(q), np.linalg.det(arm.jacobian(q)), atol=1e-14)
    assert arm.singularities(q).shape == (30, 2)
    assert "Nothing exceeds" in (tmp_path / "out_elbow" / "elbow-crosscheck.md").read_text("utf-8")


def test_an_arm_of_unknown_structure_has_a_place_for_the_inverse(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    arm = derived(tmp_path, "skew", "dh", SKEW, monkeypatch)
    because = "no inverse, because its wrist can come to axis 2, where three solutions meet"
    first, summary, last = capsys.readouterr().out.splitlines()
    assert because in first and first.endswith(f"next: closedform derive {tmp_path}/skew.py -o out")
    assert because in summary
    assert last.startswith(because) and "next: write the inverse in skew.py" in last
    q = np.array([0.3, -0.4, 0.9])
    T = dh(1, np.pi / 3, 0, 0.3) @ dh(1, np.pi / 3, 0, -0.4) @ dh(1, 0, 0, 0.9)
    np.testing.assert_allclose(arm.pose(q), T, atol=1e-14)
    assert not hasattr(arm, "ik")
    np.testing.assert_allclose(arm.determinant(q), np.linalg.det(arm.jacobian(q)), atol=1e-14)
    text = (tmp_path / "skew.py").read_text("utf-8")
    assert "# No inverse is proposed, because its wrist can come to axis 2, where three" in text
    assert 'd.no_inverse("its wrist can come to axis 2, where three solutions meet' in text
    assert "# Write it here, lemma by lemma" in text


def test_the_joint_of_a_row_may_be_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    arm = derived(tmp_path, "lift", "dh", SLIDES, monkeypatch)
    assert arm.JOINTS == ("theta1", "d2", "d3") and arm.Parameters._fields == ("d0",)
    np.testing.assert_allclose(arm.fk([0.0, 2.0, 5.0]), [0, 5, 4], atol=1e-15)
    assert len(arm.BRANCHES) == 2


def test_lengths_may_be_numbers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They count in the size of the arm, which decides what is out of reach."""
    table = "a, alpha, d, theta\n0, pi/2, 0.4, theta1\n0.5, 0, 0, theta2\n0.45, 0, 0, theta3\n"
    arm = derived(tmp_path, "plain", "dh", table, monkeypatch)
    q = np.random.default_rng(0).uniform(-3, 3, (1000, 3))
    q[:, 2] = 0  # at full stretch, where rounding puts half of the targets out of reach
    solutions = arm.ik(arm.fk(q))
    assert (solutions.status != arm.Status.UNREACHABLE).any(axis=-1).all()
    np.testing.assert_array_equal(arm.ik(arm.fk(q[0]) * 1.01).status, arm.Status.UNREACHABLE)


def test_screws(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    arm = derived(tmp_path, "screwed", "screws", SCREWS, monkeypatch)
    assert arm.Parameters() == (0.3, -0.1)
    q = np.array([0.4, 0.7])
    x = 0.3 * np.exp(0.4j) + 0.2 * np.exp(1.1j)
    np.testing.assert_allclose(arm.fk(q), [x.real, x.imag], atol=1e-15)
    np.testing.assert_allclose(arm.pose(q)[2, 3], -0.1)
    np.testing.assert_allclose(arm.ik(arm.fk(q)).q[0], q, atol=1e-14)


def test_a_forearm_without_extent_and_a_negative_link(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The angle between a3 and d4 has a convention if both vanish; lengths may be negative."""
    table = tmp_path / "t.csv"
    table.write_text(
        "# a2 = -0.4 m: upper arm\n# a3 = 0.03 m: offset\n# d4 = 0.42 m: forearm\n"
        "a, alpha, d, theta\n0.1, -pi/2, 0.3, theta1\na2, 0, 0, theta2\na3, -pi/2, 0, theta3\n"
        "0, pi/2, d4, theta4\n0, -pi/2, 0, theta5\n0, 0, 0.08, theta6\n",
        "utf-8",
    )
    assert main(["new", "fore", "--from", "dh", str(table), "-o", str(tmp_path)]) == 0
    script, out = str(tmp_path / "fore.py"), str(tmp_path / "out_fore")
    assert main(["derive", script, "-o", out, "--backend", "numpy", "--no-crosscheck"]) == 0
    monkeypatch.syspath_prepend(str(tmp_path))
    importlib.invalidate_caches()
    arm = importlib.import_module("out_fore.numpy.fore")
    q = np.random.default_rng(3).uniform(-3, 3, (40, 6))
    turn, quarter = dh, np.pi / 2
    for a3, d4 in ((0.03, 0.42), (0.0, 0.42), (0.03, 0.0), (0.0, 0.0)):
        params = arm.Parameters(a3=a3, d4=d4)
        for row in q:
            T = turn(0.1, -quarter, 0.3, row[0]) @ turn(-0.4, 0, 0, row[1])
            T = T @ turn(a3, -quarter, 0, row[2]) @ turn(0, quarter, d4, row[3])
            T = T @ turn(0, -quarter, 0, row[4]) @ turn(0, 0, 0.08, row[5])
            solutions, status = arm.ik(T, params)
            found = np.isin(status, (0, 2))
            assert found.any()
            reached = arm.pose(solutions[found], params)
            np.testing.assert_allclose(reached, np.broadcast_to(T, reached.shape), atol=1e-12)


@pytest.mark.parametrize(
    ("kind", "text", "told"),
    [
        (
            "dh",
            ELBOW,
            "An arm of 3 joints.  Its table of Denavit and Hartenberg is in the standard",
        ),
        ("dh", SLIDES, "An arm of 3 joints, of which 2 slide.  Its table"),
        (
            "screws",
            SCREWS,
            "An arm of 2 joints.  All are zero in the posture of the file, and move",
        ),
    ],
)
def test_the_script_says_what_the_file_says_of_the_arm(
    tmp_path: Path, kind: str, text: str, told: str
) -> None:
    """An article began with a request to say how the mechanism is built."""
    table = tmp_path / "table.txt"
    table.write_text(text, "utf-8")
    script = new("arm", kind, table).text
    assert told in "".join(re.findall(r'^    "(.*)",?$', script, re.MULTILINE))


def test_new_overwrites_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "t.csv"
    table.write_text(ELBOW, "utf-8")
    (tmp_path / "arm.py").write_text("mine", "utf-8")
    assert main(["new", "arm", "--from", "dh", str(table), "-o", str(tmp_path)]) == 1
    assert "already exists" in capsys.readouterr().err
    assert main(["new", "arm2", "--from", "usd", str(table)]) == 2
    assert main(["new", "arm2", "--from", "dh", "nowhere.csv"]) == 2
    assert (tmp_path / "arm.py").read_text("utf-8") == "mine"
    assert "arm" not in sys.modules


def turned(axis: int, angle: float) -> np.ndarray:
    """The 4x4 rotation about a coordinate axis."""
    c, s = np.cos(angle), np.sin(angle)
    T = np.eye(4)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    T[i, i], T[i, j], T[j, i], T[j, j] = c, -s, s, c
    return T


def drawn(arm, count: int = 30) -> np.ndarray:
    """Postures whose own answer must be among those of the inverse."""
    q = np.random.default_rng(1).uniform(-3, 3, (count, len(arm.JOINTS)))
    found, status = arm.ik(arm.fk(q))
    assert (status == 0).any(axis=1).all()
    gaps = np.abs(np.angle(np.exp(1j * (found - q[:, None])))).max(-1)
    assert np.where(status == 0, gaps, np.inf).min(-1).max() < 1e-8
    return q


FIXED = """\
# L1 = 0.5 m: upper arm
# L2 = 0.25 m: forearm
a, alpha, d, theta
0.1, 0, 0.3, pi/2
L1, pi, 0, -t1
L2, 0, 0, t2
0.1, 0, d3, 0
0, pi, 0, t4
0, 0, -0.1, 0
"""


def quick(folder: Path, name: str, kind: str, text: str, monkeypatch: pytest.MonkeyPatch):
    """Like ``derived``, but with NumPy only and without the cross-check."""
    table = folder / f"{name}.table"
    table.write_text(text, "utf-8")
    assert main(["new", name, "--from", kind, str(table), "-o", str(folder)]) == 0
    script, out = str(folder / f"{name}.py"), str(folder / f"out_{name}")
    assert main(["derive", script, "-o", out, "--backend", "numpy", "--no-crosscheck"]) == 0
    monkeypatch.syspath_prepend(str(folder))
    importlib.invalidate_caches()
    return importlib.import_module(f"out_{name}.numpy.{name}")


def test_fixed_rows_and_a_joint_with_a_minus_sign(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A base beside the first axis, and a tool, around a SCARA arm that turns backwards."""
    arm = quick(tmp_path, "fixed", "dh", FIXED, monkeypatch)
    said = capsys.readouterr().err
    for line in (4, 9):
        assert f"line {line}: the row has no joint, so it is a fixed transform" in said
    assert arm.JOINTS == ("t1", "t2", "d3", "t4")
    for t1, t2, d3, t4 in (q := drawn(arm)):
        T = dh(0.1, 0, 0.3, np.pi / 2) @ dh(0.5, np.pi, 0, -t1) @ dh(0.25, 0, 0, t2)
        T = T @ dh(0.1, 0, d3, 0) @ dh(0, np.pi, 0, t4) @ dh(0, 0, -0.1, 0)
        np.testing.assert_allclose(arm.pose([t1, t2, d3, t4]), T, atol=1e-14)
    T = arm.pose(q)
    np.testing.assert_allclose(arm.jacobian(q)[:, 2], [[0, 0, -1, 0]] * len(q), atol=1e-15)
    assert T.shape == (30, 4, 4)


NAMED = """\
# L1 = 0.5 m: upper arm
# angle1 = 0.4 m: a name that is in use
a, alpha, d, theta
0, pi/2, angle1, theta1 + pi/18
L1, 0, 0, theta2 - pi/18
0.45, 0, 0, 0.3 - theta3
"""


def test_angles_without_square_roots_become_parameters(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    arm = quick(tmp_path, "named", "dh", NAMED, monkeypatch)
    said = capsys.readouterr().err
    assert "line 4, column theta: the cosine of pi/18 has no short form with square roots" in said
    assert "the parameter angle2 = 0.17453292519943295769 rad" in said
    assert "# named.table, line 4, column theta: the cosine of pi/18" in (
        tmp_path / "named.py"
    ).read_text("utf-8")
    assert arm.Parameters() == (0.5, 0.4, np.pi / 18, 0.3)
    assert arm.Parameters._fields == ("L1", "angle1", "angle2", "angle3")
    for t1, t2, t3 in drawn(arm):
        T = dh(0, np.pi / 2, 0.4, t1 + np.pi / 18) @ dh(0.5, 0, 0, t2 - np.pi / 18)
        np.testing.assert_allclose(arm.pose([t1, t2, t3]), T @ dh(0.45, 0, 0, 0.3 - t3), atol=1e-14)


ROUNDED = """\
[[axes]]
joint = "theta1"
direction = [0, 0.7071, 0.7071]
[[axes]]
joint = "theta2"
direction = [1, 0, 0]
[[axes]]
joint = "theta3"
direction = [1.0, 0, 0]
point = [0, 0.3, 0]
[home]
position = [0, 0.3, 0.3]
rotation = [[1, 0, 0], [0, 0.9962, -0.0872], [0, 0.0872, 0.9962]]
"""


def test_directions_in_decimals_are_made_exact(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    arm = quick(tmp_path, "rounded", "screws", ROUNDED, monkeypatch)
    said = capsys.readouterr().err
    assert "axis 1: the direction (0, 0.7071, 0.7071) is rounded; the unit vector " in said
    assert "(0, sqrt(2)/2, sqrt(2)/2) is used instead" in said
    assert "[home]: the rotation is rounded; the rows (1, 0, 0), " in said
    tilt = turned(0, -np.pi / 4)
    elbow = np.eye(4)
    elbow[1, 3] = 0.3
    home = turned(0, np.arcsin(0.0872))
    home[1:3, 3] = 0.3
    for t1, t2, t3 in drawn(arm):
        T = tilt @ turned(2, t1) @ np.linalg.inv(tilt) @ turned(0, t2)
        T = T @ elbow @ turned(0, t3) @ np.linalg.inv(elbow) @ home
        pose = arm.pose([t1, t2, t3])
        np.testing.assert_allclose(pose[:, 3], T[:, 3], atol=1e-14)
        np.testing.assert_allclose(pose, T, atol=1e-4)
        np.testing.assert_allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3), atol=1e-14)


PUMA = """\
a, alpha, d, theta
0, pi/2, 0, t1
2, 0, 1/2, t2
1/5, -pi/2, 0, t3
0, pi/2, 2, t4
0, -pi/2, 0, t5
0, 0, 0, t6
"""


def test_if_the_proof_of_a_chain_fails_the_next_one_is_tried(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The offset of the shoulder gets the wrong sign in the first chain that fits."""
    whole = KnownMaker.whole

    def wrong(maker: KnownMaker) -> str:
        found = whole(maker)
        maker.lines[:] = [
            line.replace(", Rational(1, 2)), ", ", -Rational(1, 2)), ") for line in maker.lines
        ]
        return found

    monkeypatch.setattr(KnownMaker, "whole", wrong)
    (tmp_path / "table.csv").write_text(PUMA, "utf-8")
    command = ["new", "bent", "--from", "dh", str(tmp_path / "table.csv"), "-o", str(tmp_path)]
    assert main([*command, "--explain"]) == 0
    said = capsys.readouterr().out
    assert (
        "tried: a known structure: no, because its proof fails: the equation solved for t1" in said
    )
    assert "taken: spherical wrist, axes 2 and 3 parallel" in said
    assert "axes 2 and 3 parallel" in (tmp_path / "bent.py").read_text("utf-8")


def test_no_chain_is_written_whose_proof_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(trial, "fault", lambda *_: "it is made to fail")
    (tmp_path / "table.csv").write_text(PUMA, "utf-8")
    command = ["new", "bent", "--from", "dh", str(tmp_path / "table.csv"), "-o", str(tmp_path)]
    assert main(command) == 0
    said = capsys.readouterr()
    assert "no inverse, because its proof fails: it is made to fail" in said.out
    assert "report the table" in said.err
