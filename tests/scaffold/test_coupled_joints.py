"""Arms of which one motor moves several joints, and motors with gears, against plain numbers."""

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp
from arms import OK, SINGULAR, check_jacobians, differences, link, misses, wrapped
from chains import printed

from closedform.mechanics.arm import RowError, from_dh
from closedform.model.derivation import Derivation, Paper
from closedform.pipeline import scripts
from closedform.proof.prove import prove
from closedform.scaffold.inputs.followers import follow
from closedform.scaffold.inputs.tables import TableError, read_dh, read_screws
from closedform.scaffold.inputs.urdf import read_urdf
from closedform.scaffold.new import new

HEADER = "a, alpha, d, theta, motors\n"
VALUES = {"l1": 0.3, "l2": 0.25, "h": 0.2, "e": 0.1}


def table(*rows: str) -> str:
    """A table of joints, with the values of the lengths that it names."""
    used = set(re.findall(r"\w+", " ".join(rows)))
    lengths = [f"# {name} = {value} m: length\n" for name, value in VALUES.items() if name in used]
    return "".join([*lengths, HEADER, *(f"{row}\n" for row in rows)])


def urdf(third: str, fourth: str, *, side: float = 0.0) -> str:
    """A robot for wafers whose elbow and hand mimic its shoulder."""

    def joint(name: str, number: int, place: str, axis: str, more: str = "") -> str:
        kind = "prismatic" if name == "lift" else "revolute"
        return (
            f'<joint name="{name}" type="{kind}"><parent link="link{number}"/>'
            f'<child link="link{number + 1}"/><origin xyz="{place}"/><axis xyz="{axis}"/>{more}'
            f"</joint>"
        )

    mimic = '<mimic joint="shoulder" multiplier="{}" offset="0.0"/>'
    return (
        "<robot>"
        + joint("lift", 0, "0 0 0.3", "0 0 1")
        + joint("pan", 1, "0 0 0.1", "0 0 1")
        + joint("shoulder", 2, "0 0 0.05", "0 0 1", '<limit lower="-1.5" upper="1.5"/>')
        + joint("elbow", 3, "0.3 0 0.02", "0 0 -1", mimic.format(third))
        + joint("hand", 4, "0.25 0 0.02", "0 0 1", mimic.format(fourth))
        + f'<joint name="end" type="fixed"><parent link="link5"/><child link="tool"/>'
        f'<origin xyz="0.2 {side} 0"/></joint></robot>'
    )


SCREWS = """\
[parameters]
l1 = {value = "0.3", unit = "m", meaning = "each link"}

[[axes]]
joint = "t1"
direction = [0, 0, 1]
[[axes]]
joint = "t2"
direction = [0, 0, 1]
motors = "m2"
[[axes]]
joint = "t3"
direction = [0, 0, 1]
point = ["l1", 0, 0]
motors = "-2*m2"
[[axes]]
joint = "t4"
direction = [0, 0, 1]
point = ["2*l1", 0, 0]
[home]
position = ["2*l1 + 0.2", 0, 0]
"""


def fan(*links: tuple[float, int], lift: bool = False) -> Callable[[np.ndarray], np.ndarray]:
    """The place of a tool whose links turn with the first joint and by multiples of the second."""

    def place(q: np.ndarray) -> np.ndarray:
        turn, motor = q[..., -2], q[..., -1]
        end = sum(v * np.exp(1j * (turn + n * motor)) for v, n in links)
        return np.stack([end.real, end.imag, *([q[..., 0]] if lift else [])], -1)

    return place


def with_yaw(q: np.ndarray) -> np.ndarray:
    t1, t2, t4 = np.moveaxis(q, -1, 0)
    yaw = t1 - t2 + t4
    end = 0.3 * np.exp(1j * (t1 + t2)) + 0.3 * np.exp(1j * (t1 - t2)) + 0.2 * np.exp(1j * yaw)
    return np.stack([end.real, end.imag, wrapped(yaw)], -1)


def of_finger(q: np.ndarray) -> np.ndarray:
    t1, t2, t3 = np.moveaxis(q, -1, 0)
    end = 0.1 + 1j * 0.2 + 0.3 * np.exp(1j * t2)
    end = end + 0.25 * np.exp(1j * (t2 + t3)) + 0.2 * np.exp(1j * (t2 + 2 * t3))
    return np.stack([np.cos(t1) * end.real, np.sin(t1) * end.real, end.imag], -1)


def lifted(q: np.ndarray) -> np.ndarray:
    place = fan((0.3, 1), (0.25, -1), (0.2, 0), lift=True)(q)
    return place + np.array([0, 0, 0.49])


WAFER = "0, 0, d1, 0,", "0, 0, 0, t1,", "l1, 0, 0, t2, m2"
ARMS: dict[str, tuple[str, str, Callable[[np.ndarray], np.ndarray], int]] = {
    "equal": (
        "dh",
        table(*WAFER, "l1, 0, 0, t3, -2*m2", "h, 0, 0, t4, m2"),
        fan((0.3, 1), (0.3, -1), (0.2, 0), lift=True),
        4,
    ),
    "unequal": (
        "dh",
        table(*WAFER, "l2, 0, 0, t3, -2*m2", "h, 0, 0, t4, m2"),
        fan((0.3, 1), (0.25, -1), (0.2, 0), lift=True),
        4,
    ),
    "no_hand": (
        "dh",
        table("0, 0, 0, t1,", "l1, 0, 0, t2, 2*m2", "l2, 0, 0, t3, -4*m2"),
        fan((0.3, 1), (0.25, -1)),
        4,
    ),
    "aside": (
        "dh",
        table("0, 0, 0, t1,", "l1, 0, 0, t2, m2", "l2, 0, 0, t3, -2*m2", "h, 0, 0, t4 + pi/2, m2"),
        fan((0.3, 1), (0.25, -1), (0.2j, 0)),
        4,
    ),
    "equal_aside": (
        "dh",
        table(*WAFER[1:], "l1, 0, 0, t3, -2*m2", "h, 0, 0, t4, m2", "e, 0, 0, pi/2,"),
        fan((0.3, 1), (0.3, -1), (0.2 + 0.1j, 0)),
        4,
    ),
    "phalanges": (
        "dh",
        table("l1, 0, 0, t1,", "l2, 0, 0, t2, m2", "h, 0, 0, t3, m2"),
        fan((0.3, 0), (0.25, 1), (0.2, 2)),
        4,
    ),
    "level": (
        "dh",
        table("l1, 0, 0, t1,", "l2, 0, 0, t2, m2", "h, 0, 0, t3, -m2"),
        fan((0.3, 0), (0.25, 1), (0.2, 0)),
        2,
    ),
    "finger": (
        "dh",
        table("e, pi/2, h, t1,", "l1, 0, 0, t2,", "l2, 0, 0, t3, m3", "h, 0, 0, t4, m3"),
        of_finger,
        8,
    ),
    "screws": ("screws", SCREWS, with_yaw, 4),
    "urdf": ("urdf", urdf("2", "1"), lifted, 4),
}
"""The format, the text, the place of the tool in plain numbers, and the number of branches."""


WRIST = "0, -pi/2, 0.3, t5,", "0, pi/2, 0, t6,", "0, 0, e, t7,"
ELBOWS: dict[str, tuple[Any, ...]] = {
    "rolling": ("l1, 0, 0, t2,", "e, 0, 0, t3, m", "0, pi/2, 0, t4 + pi/2, m", 16),
    "rolling_equal": ("0.3, 0, 0, t2,", "e, 0, 0, t3, m", "0, pi/2, 0, t4 + pi/2, m", 16),
    "level_arm": ("l1, 0, 0, t2,", "l2, 0, 0, t3, m", "e, pi/2, 0, t4 + pi/2, -m", 8),
}
"""Of arms with six motors: an elbow of two axes that roll on each other, or a level upper arm."""
FILES = {name: (kind, text, branches) for name, (kind, text, _, branches) in ARMS.items()} | {
    name: ("dh", table("e, pi/2, h, t1,", *rows, *WRIST), branches)
    for name, (*rows, branches) in ELBOWS.items()
}


@cache
def made(name: str, folder: Path) -> Any:
    """The printed module of an arm whose proposed inverse is proved."""
    kind, text, branches = FILES[name]
    path = folder / f"{name}.{kind}"
    path.write_text(text, "utf-8")
    script = new(name, kind, path)
    assert f"{branches} branches" in script.inverse, script.advice
    (folder / f"{name}.py").write_text(script.text, "utf-8")
    (source,) = scripts.find([str(folder / f"{name}.py")])
    d = scripts.load(source)
    assert prove(d).inverses[0].solutions == branches
    return printed(d, folder / name)


def postures(robot: Any, place: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Random ones, and others beside right angles and where the arm is singular."""
    rng = np.random.default_rng(1)
    q = rng.uniform(-3, 3, (20_000, len(robot.JOINTS)))
    near = rng.choice([0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3], q.shape) * rng.choice([-1, 1], q.shape)
    special = rng.integers(-6, 7, q.shape) * np.pi / rng.choice([2, 6], q.shape) + near
    q[10_000:] = np.where(rng.random((10_000, q.shape[1])) < 0.5, special[10_000:], q[10_000:])
    motor = np.linspace(-3.2, 3.2, 100_001)
    grid = np.zeros((motor.size, q.shape[1])) + q[0]
    grid[:, -1 if robot.JOINTS[-1] != "t4" else -2] = motor
    away = np.linalg.norm(place(grid)[:, :2], axis=-1)
    turning = 1 + np.flatnonzero(np.diff(away[1:]) * np.diff(away[:-1]) <= 0)
    at = rng.choice(grid[turning], 2000) + near[:2000] * rng.choice([0, 1], (2000, 1))
    return np.concatenate([q, at])


@pytest.mark.parametrize("name", ARMS)
def test_every_posture_is_among_the_branches(name: str, folder: Path) -> None:
    robot, place = made(name, folder), ARMS[name][2]
    q = postures(robot, place)
    x = place(q)
    np.testing.assert_allclose(robot.fk(q)[:, :2], x[:, :2], atol=1e-14)
    answers, status = robot.ik(x)
    found = np.isin(status, (OK, SINGULAR))
    away = place(answers) - x[:, None]
    if name == "screws":
        away[..., 2] = wrapped(away[..., 2])
    assert np.abs(away)[found].max() < 1e-12 * sum(VALUES.values())
    assert found.any(axis=1).all()
    gaps = answers - q[:, None]
    turns = [k for k, joint in enumerate(robot.JOINTS) if joint not in ("d1", "lift")]
    gaps[..., turns] = wrapped(gaps[..., turns])
    assert np.nanmin(np.abs(gaps[:10_000]).max(axis=-1), axis=1).max() < 1e-7


@pytest.mark.parametrize("name", ARMS)
def test_the_jacobian_is_that_of_the_motors(name: str, folder: Path) -> None:
    robot, place = made(name, folder), ARMS[name][2]
    q = np.random.default_rng(2).uniform(-1, 1, (50, len(robot.JOINTS)))
    rates = np.stack(differences(place, q), -1)
    np.testing.assert_allclose(robot.jacobian(q), rates, atol=1e-8)
    np.testing.assert_allclose(robot.determinant(q), np.linalg.det(rates), atol=1e-7)


@pytest.mark.parametrize("name", ELBOWS)
def test_a_spherical_wrist_after_coupled_joints(name: str, folder: Path) -> None:
    robot = made(name, folder)
    a3, a4, sign = (0.25, 0.1, -1) if name == "level_arm" else (0.1, 0.0, 1)

    def pose(q: np.ndarray) -> np.ndarray:
        t = np.moveaxis(q, -1, 0)
        T = link(0.1, np.pi / 2, 0.2, t[0]) @ link(0.3, 0, 0, t[1]) @ link(a3, 0, 0, t[2])
        T = T @ link(a4, np.pi / 2, 0, sign * t[2] + np.pi / 2)
        T = T @ link(0, -np.pi / 2, 0.3, t[3]) @ link(0, np.pi / 2, 0, t[4])
        return T @ link(0, 0, 0.1, t[5])

    rng = np.random.default_rng(1)
    q = rng.uniform(-3, 3, (10_000, 6))
    near = rng.choice([0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3], q.shape)
    q[5000:] = (rng.integers(-6, 7, q.shape) * np.pi / 6 + near)[5000:]
    T = pose(q)
    np.testing.assert_allclose(robot.fk(q), T, atol=1e-14)
    check_jacobians(robot, pose, q[:50])
    answers, status = robot.ik(T)
    found = np.isin(status, (OK, SINGULAR))
    assert found.any(axis=1).all() and max(misses(pose(answers), T, status)) < 1e-12
    gaps = np.abs(wrapped(answers - q[:, None]))[:5000].max(axis=-1)
    assert np.nanmin(gaps, axis=1).max() < 1e-7


def test_what_follows_is_not_an_input(folder: Path) -> None:
    robot = made("unequal", folder)
    assert robot.JOINTS == ("d1", "t1", "t2")
    assert set(robot.SKELETON.joints) == {"d1", "t1", "t2", "t3", "t4"}
    assert not hasattr(robot, "joints_from_motors")
    robot = made("urdf", folder)
    assert robot.JOINTS == ("lift", "pan", "shoulder")
    assert robot.LIMITS[0][2] == -1.5


def test_the_joint_that_turns_least_leads(folder: Path) -> None:
    """The motor turns the first joint twice as fast as itself."""
    robot = made("no_hand", folder)
    np.testing.assert_allclose(robot.joints_from_motors([0.3, 0.2]), [0.3, 0.4])


STAGES = (
    "0, pi/2, h, t1,",
    "0, pi/2, 0, t2 + pi/2,",
    "0, {}, l1 + d3, 0, m3",
    "0, 0, l2 {} d4, pi/3, m3/2",
)


@pytest.mark.parametrize(
    ("alpha", "sign", "total"), [("0", "+", 1.5), ("pi", "+", 0.5), ("pi", "-", 1.5)]
)
def test_the_stages_of_a_telescope_are_one_joint(
    alpha: str, sign: str, total: float, tmp_path: Path
) -> None:
    path = tmp_path / "stages.csv"
    path.write_text(table(*STAGES).format(alpha, sign), "utf-8")
    read = read_dh(path)
    follow(read, path.name)
    assert list(read.joints) == ["t1", "t2", "d3"]
    assert read.couplings == {"d3": sp.nsimplify(total) * sp.Symbol("m3", real=True)}
    assert "an inverse with 4 branches" in new("stages", "dh", path).inverse


def test_stages_of_screws_may_have_a_joint_between(tmp_path: Path) -> None:
    axis = '[[axes]]\njoint = "{}"\nkind = "{}"\ndirection = [0, 0, {}]\n{}'
    path = tmp_path / "stages.toml"
    path.write_text(
        axis.format("d1", "prismatic", 1, 'motors = "m"\n')
        + axis.format("t2", "revolute", 1, "")
        + axis.format("d3", "prismatic", -1, 'motors = "-m/3"\n')
        + "[home]\nposition = [1, 0, 0]\n",
        "utf-8",
    )
    read = read_screws(path)
    follow(read, path.name)
    assert [str(joint) for joint, *_ in read.axes] == ["d1", "t2"]
    assert read.couplings == {"d1": sp.Rational(4, 3) * sp.Symbol("m", real=True)}


def test_motors_may_have_gears(tmp_path: Path) -> None:
    """A whole turn of the second joint is not one of the third motor, which both move."""
    rows = "0, pi/2, h, t1, m1/50", "l1, 0, 0, t2, -m2/100", "l2, 0, 0, t3, m3/81 - m2/100"
    path = tmp_path / "geared.csv"
    path.write_text(table(*rows), "utf-8")
    (tmp_path / "geared.py").write_text(new("geared", "dh", path).text, "utf-8")
    (source,) = scripts.find([str(tmp_path / "geared.py")])
    robot = printed(scripts.load(source), tmp_path / "printed")
    m = np.random.default_rng(1).uniform(-300, 300, (20, 3))
    q = robot.joints_from_motors(m)
    np.testing.assert_allclose(q[:, 2], m[:, 2] / 81 - m[:, 1] / 100, atol=1e-15)
    np.testing.assert_allclose(robot.motors_from_joints(q), m, rtol=1e-14, atol=1e-12)
    assert "not reduced" in robot.motors_from_joints.__doc__


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (
            ("l1, 0, 0, t1,", "l2, 0, 0, t2, m", "h, 0, 0, t3, 2*m"),
            "its links turn by 0, 1 and 3 times the angle of t2, .* equation of degree 3",
        ),
        (
            ("e, pi/2, 0, t1,", "l1, 0, h, t2,", "l2, 0, 0, t3, m", "h, 0, 0, t4, m"),
            "beside the plane through axis 1",
        ),
        (
            ("0, pi/2, 0, t1,", "l1, pi/2, 0, t2, m", "l2, 0, 0, t3, m"),
            r"t3 follows other joints, and the axes are R \| R \| R",
        ),
        (
            ("l1, 0, 0, t1, m1", "l2, 0, 0, t2, m1", "h, 0, 0, t3,"),
            "none of these turns all of them",
        ),
    ],
)
def test_what_is_not_solved_is_named(rows: tuple, message: str, tmp_path: Path) -> None:
    path = tmp_path / "arm.csv"
    path.write_text(table(*rows), "utf-8")
    script = new("arm", "dh", path)
    assert script.inverse.startswith("no inverse, because")
    assert re.search(message, script.inverse), script.inverse


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (("l1, 0, 0, t1,", "l2, 0, 0, t2, 2*m", "h, 0, 0, t3, 3*m"), "t2 by 2\\*m and t3 by 3\\*m"),
        (("0, pi/2, d1, 0, m", "0, 0, d2, 0, m"), "they slide along two lines"),
        (("0, 0, d1, 0, m", "0, 0, d2, 0, -m"), "together they do not move anything"),
    ],
)
def test_motors_that_make_no_sense_are_refused(rows: tuple, message: str, tmp_path: Path) -> None:
    path = tmp_path / "arm.csv"
    path.write_text(table(*rows), "utf-8")
    read = read_dh(path)
    with pytest.raises(TableError, match=message):
        follow(read, path.name)


def test_mimic_joints_that_do_not_turn_by_whole_multiples_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(urdf("2", "0.5"), "utf-8")
    with pytest.raises(TableError, match="shoulder; it turns by 1/2 times the angle, which is not"):
        read_urdf(path)


def test_a_coupling_that_is_not_algebraic_is_refused() -> None:
    d = Derivation("arm", "Arm", Paper("toy", "Toys", ("A.",)), "An arm.")
    t1, d2 = d.joint("t1"), d.joint("d2", "prismatic")
    for factor, kind, message in (
        (sp.Rational(1, 2), "revolute", "t3 turns by 1/2 times t1, which is not a whole multiple"),
        (sp.S.One, "prismatic", "if one turns and the other slides"),
    ):
        d.joints = d.joints[:2]
        t3 = d.joint("t3", kind, coupling=factor * t1)
        row = (1, 0, 0, t3) if kind == "revolute" else (0, 0, t3, 0)
        with pytest.raises(RowError, match=message):
            from_dh(d, [(1, 0, 0, t1), (0, 0, d2, 0), row])


def test_the_article_says_that_twists_of_followers_are_added() -> None:
    d = Derivation("arm", "Arm", Paper("toy", "Toys", ("A.",)), "An arm.")
    t1, t2 = d.joint("t1"), d.joint("t2")
    t3 = d.joint("t3", coupling=-2 * t2)
    from_dh(d, [(1, 0, 0, t1), (2, 0, 0, t2), (1, 0, 0, t3)]).export(d)
    (step,) = (step for step in d.steps if step.title == "Jacobians")
    assert "Where others follow a joint" in step.reason
