"""Arms whose lengths are plain numbers: derived as with symbols, and checked as strictly."""

from pathlib import Path

import numpy as np
import pytest
from arms import link, misses
from chains import printed

import closedform.check.inverses
from closedform.check.finding import Backend, module_backend
from closedform.check.inverses import check_inverse
from closedform.check.runners.python import module
from closedform.check.samples import Sample
from closedform.check.values import check_forward
from closedform.model.derivation import Derivation
from closedform.pipeline import scripts
from closedform.proof.prove import prove
from closedform.scaffold.new import new

UNREACHABLE = 1
HEADER = "a, alpha, d, theta\n"
ELBOW = "0.05, pi/2, 0.4, theta1\n-0.5, 0, -0.1, theta2\n-0.5, 0, 0.03, theta3\n"
PUMA = (
    "0, -pi/2, 0.6718, theta1\n0.4318, 0, 0, theta2\n0.0203, -pi/2, 0.15005, theta3\n"
    "0, pi/2, 0.4318, theta4\n0, -pi/2, 0, theta5\n0, 0, 0.05625, theta6\n"
)
SUMS = "# e = 0.03 m: offset\n" + HEADER + ELBOW.replace("-0.1", "e + 0.1").replace("0.05", "e/2")
STANFORD = (
    "0, -pi/2, 0.412, theta1\n0, pi/2, 0.154, theta2\n0.0203, 0, d3, -pi/2\n"
    "0, -pi/2, 0, theta4\n0, pi/2, 0, theta5\n0, 0, 0.263, theta6\n"
)
LONG = "0.1015, pi/2, 0.615, theta1\n0.70523, 0, 0, theta2\n0.13571, 0, 0.0312, theta3\n"
AXIS = '[[axes]]\njoint = "theta{}"\ndirection = {}\npoint = {}\n'


def derivation(folder: Path, text: str, name: str = "arm", kind: str = "dh") -> Derivation:
    table = folder / f"{name}.{'csv' if kind == 'dh' else 'toml'}"
    table.write_text(text, "utf-8")
    script = folder / f"{name}.py"
    script.write_text(new(name, kind, table).text, "utf-8")
    return scripts.load(scripts.find([str(script)])[0])


@pytest.mark.parametrize(
    ("table", "branches"),
    [
        (HEADER + "0.4, 0, 0, theta1\n0.4, 0, 0, theta2\n", 2),
        (HEADER + "0, -pi/2, 0.4, theta1\n0, pi/2, 0.15, theta2\n0, 0, d3, 0\n", 4),
        (HEADER + ELBOW, 4),
        (HEADER + PUMA, 8),
        (SUMS, 4),
    ],
    ids=["equal links", "polar", "negative offsets", "Puma", "sums"],
)
def test_an_arm_in_numbers_is_proved(table: str, branches: int, tmp_path: Path) -> None:
    (inverse,) = prove(derivation(tmp_path, table)).inverses
    assert inverse.branches == branches == inverse.solutions


def test_nearer_to_the_axis_than_an_offset_there_is_no_answer(tmp_path: Path) -> None:
    """If the coefficients of a sine and a cosine vanish, the number beside them does not."""
    arm = printed(derivation(tmp_path, HEADER + ELBOW), tmp_path)
    q, status = arm.ik([[0.0, 0.0, 0.6], [1e-13, 0.0, 0.6], [0.05, 0.0, 0.6]])
    assert (status == UNREACHABLE).all() and np.isnan(q).all()


def test_the_point_of_an_axis_may_be_any_on_it(tmp_path: Path) -> None:
    """The UR5 as in a textbook: the points of axes 5 and 6 are not where they intersect."""
    axes = [
        ([0, 0, 1], [0, 0, 0]),
        ([0, 1, 0], [0, 0, 0.089]),
        ([0, 1, 0], [0.425, 0, 0.089]),
        ([0, 1, 0], [0.817, 0, 0.089]),
        ([0, 0, -1], [0.817, 0.109, 0]),
        ([0, 1, 0], [0.817, 0, -0.006]),
    ]
    text = "".join(AXIS.format(i, w, p) for i, (w, p) in enumerate(axes, 1))
    text += "[home]\nposition = [0.817, 0.191, -0.006]\n"
    text += "rotation = [[-1, 0, 0], [0, 0, 1], [0, 1, 0]]\n"
    arm = printed(derivation(tmp_path, text, kind="screws"), tmp_path)
    q = np.random.default_rng(5).uniform(-3, 3, (40, 6))
    found = arm.ik(arm.pose(q))
    gaps = np.abs(np.angle(np.exp(1j * (found.q - q[:, None])))).max(-1)
    assert np.nanmin(gaps, axis=-1).max() < 1e-9


SURGICAL = (
    "0, 5*pi/12, 0, theta1\n0, -13*pi/45, 0, theta2\n0, 0, d3, 0\n"
    "0, pi/2, 0.3, theta4\n0.013, pi/2, 0, theta5\n0, 0, 0, theta6\n"
)


def test_angles_of_a_wrist_may_be_a_parameter_and_a_root(tmp_path: Path) -> None:
    """A surgical arm: one angle has a cosine with square roots, the other one has none.

    Its roots beside a parameter could not be counted, so the script that was proposed was refused.
    """
    d = derivation(tmp_path, HEADER + SURGICAL)
    assert [p.name for p in d.parameters] == ["angle1"]
    (inverse,) = prove(d).inverses
    assert inverse.branches == inverse.solutions == 8
    robot, angle = printed(d, tmp_path), -13 * np.pi / 45
    q = np.random.default_rng(6).uniform(-3, 3, (500, 6))
    links = [(0, 5 * np.pi / 12, 0), (0, angle, 0), (0, 0, q[:, 2]), (0, np.pi / 2, 0.3),
             (0.013, np.pi / 2, 0), (0, 0, 0)]  # fmt: skip
    T = np.eye(4)
    for k, (a, alpha, length) in enumerate(links):
        step = link(a, alpha, 0, q[:, k] * (k != 2))
        step[:, 2, 3] = length
        T = T @ step
    np.testing.assert_allclose(robot.pose(q), T, atol=1e-14)
    answers, status = robot.ik(T)
    assert max(misses(robot.pose(answers), T, status)) < 1e-12
    assert (np.nanmin(np.abs(answers - q[:, None]).max(-1), axis=-1) < 1e-7).all()


def findings(
    folder: Path, table: str, functions: tuple[str, ...], printed_from: str = ""
) -> list[str]:
    """The cross-check of functions of an arm, which may be printed from a different table."""
    d = derivation(folder, table)
    other = folder / "other"
    other.mkdir()
    module = printed(derivation(other, printed_from) if printed_from else d, other)
    backend = module_backend("numpy", module)
    return [x for f in functions for x in check_forward(d, d[f], backend).failures]


def test_a_determinant_in_numbers_is_right_at_denormal_angles(tmp_path: Path) -> None:
    """A number before whole coefficients would lose a denormal sine's last bits."""
    assert findings(tmp_path, HEADER + LONG, ("determinant", "singularities")) == []


def test_a_number_that_is_off_by_a_little_is_found(tmp_path: Path) -> None:
    functions = ("fk", "jacobian", "determinant", "singularities")
    original, changed = (HEADER + ELBOW.replace("0.05", n) for n in ("0.05", "0.050000000005"))
    failures = findings(tmp_path, original, functions, changed)
    assert len(failures) == len(functions)


def test_a_posture_at_two_limits_at_once_is_not_lost(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At the limit of the shoulder an ulp turns it by 1e-8, and with it a nearly singular wrist.

    The check allows for an ulp of the target, but still finds a missing answer elsewhere.
    """
    d = derivation(tmp_path, HEADER + STANFORD)
    quarter, e = np.pi / 2, 1e-9
    posture = np.array([[1e-6 - np.pi, -np.pi - e, -quarter, np.pi, e - np.pi, 0.1 - quarter]])
    sample = Sample("two limits", posture, ())
    monkeypatch.setattr(closedform.check.inverses, "inverse_postures", lambda *_: [sample])
    backend = module_backend("numpy", printed(d, tmp_path))
    (inverse,) = d.inverses
    assert check_inverse(d, d["ik"], inverse, backend).failures == []
    quarters = Sample("elsewhere", np.array([[0.3, 1.0, 0.7, 0.4, 0.9, 0.2]]), ())
    monkeypatch.setattr(closedform.check.inverses, "inverse_postures", lambda *_: [quarters])

    def without_half(name: str):
        def changed(*arguments):
            found = getattr(printed_module, name)(*arguments)
            found.q[:, :4] = found.q[:, 4:]
            return found

        return changed

    printed_module = module(tmp_path / "numpy", d.name)
    broken = Backend("broken", without_half, np.float64, backend.tolerances)
    assert "is lost" in check_inverse(d, d["ik"], inverse, broken).failures[0]


@pytest.mark.parametrize(
    ("rows", "joints"),
    [
        ("0, 0, 0.5, theta1\n0, pi/2, 0, theta2\n0.4, 0, 0, theta3\n", "theta1 and theta2"),
        (
            "0, pi/2, 0.5, theta1\n0.4, 0, 0, theta2\n0, pi/2, 0, theta3\n"
            "0, -pi/2, 0, theta4\n0, pi/2, 0, theta5\n0, 0, 0.1, theta6\n",
            "theta3, theta4, theta5 and theta6",
        ),
    ],
    ids=["an axis twice", "four axes through a point"],
)
def test_an_arm_that_is_singular_everywhere(rows: str, joints: str, tmp_path: Path) -> None:
    n = rows.count("\n")
    needed = f"singular everywhere: its Jacobian has rank {n - 1}, not {n}, at every.* {joints} do "
    held = f"'# {joints.split()[0].rstrip(',')} = 0.1 m: held'"
    with pytest.raises(ValueError, match=f"^arm.csv: the arm is {needed}.*--modified.*{held}"):
        derivation(tmp_path, HEADER + rows)
