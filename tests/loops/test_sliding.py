"""Planar linkages in which bodies slide on each other, from files.

The other route knows no groups: bodies have poses, joints hold points and lines of two bodies
together, and Newton's method solves for all poses at once.
"""

import tomllib
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import sympy as sp
from loop_files import derived, read_script, script_of
from places import TESTS

from closedform.scaffold.inputs.tables import TableError

FOLDER = TESTS / "held_out_loops"
MODES = {
    "shaper": 4,
    "scissor_lift": 4,
    "swivelling_rod": 2,
    "macpherson": 2,
    "oldham": 1,
    "braced_carriage": 4,
}
OK, UNREACHABLE, SINGULAR = 0, 1, 2
LINES = 40


class Poses:
    """The bodies of a file: where their points are is a function of the poses of all bodies."""

    def __init__(self, text: str):
        data = tomllib.loads(text)
        sizes = {k: float(v["value"]) for k, v in data["parameters"].items()}
        self.hand, self.joints = data["hand"], data["joints"]
        self.bodies: dict[str, dict[str, np.ndarray]] = {}
        for body, points in data["bodies"].items():
            if "length" in points:
                ends = dict.fromkeys(j["at"] for j in self.joints.values() if body in j["between"])
                points = dict(zip(ends, ([0, 0], [points["length"], 0]), strict=True))
            self.bodies[body] = {
                p: np.array([float(sp.sympify(e).subs(sizes)) for e in at])
                for p, at in points.items()
            }
        self.moving = [body for body in self.bodies if body != "ground"]
        self.driven = [n for n, j in self.joints.items() if j.get("driven")]

    def place(self, body: str, joint: dict) -> np.ndarray:
        """The point of a body on the line of a slide, or at a pin; a block is a point."""
        points = self.bodies[body]
        alone = next(iter(points.values())) if len(points) == 1 else np.zeros(2)
        return points.get(joint["at"], alone)

    def frame(self, poses: np.ndarray, body: str) -> tuple[np.ndarray, ...]:
        if body == "ground":
            return tuple(np.zeros(poses.shape[:-1]) for _ in range(3))
        k = 3 * self.moving.index(body)
        return poses[..., k], poses[..., k + 1], poses[..., k + 2]

    def at(self, poses: np.ndarray, body: str, local: np.ndarray) -> np.ndarray:
        x, y, phi = self.frame(poses, body)
        c, s = np.cos(phi), np.sin(phi)
        return np.stack([x + c * local[0] - s * local[1], y + s * local[0] + c * local[1]], -1)

    def slid(self, poses: np.ndarray, joint: dict) -> np.ndarray:
        """How far the second body slid along the line and away from it."""
        first, second = joint["between"]
        axis = np.array(joint["axis"], dtype=float) / np.hypot(*joint["axis"])
        gap = self.at(poses, second, self.place(second, joint))
        gap = gap - self.at(poses, first, self.place(first, joint))
        phi = self.frame(poses, first)[2]
        along = np.stack([np.cos(phi), np.sin(phi)], -1) * axis[0]
        along = along + np.stack([-np.sin(phi), np.cos(phi)], -1) * axis[1]
        across = along[..., 0] * gap[..., 1] - along[..., 1] * gap[..., 0]
        return np.stack([(along * gap).sum(axis=-1), across], -1)

    def missed(self, poses: np.ndarray, q: np.ndarray) -> np.ndarray:
        gaps = []
        for joint in self.joints.values():
            first, second = joint["between"]
            if joint.get("kind") == "prismatic":
                turned = self.frame(poses, first)[2] - self.frame(poses, second)[2]
                gaps += [self.slid(poses, joint)[..., 1], turned]
                continue
            ends = [self.at(poses, b, self.place(b, joint)) for b in (first, second)]
            gaps += [*np.moveaxis(ends[1] - ends[0], -1, 0)]
        for name, value in zip(self.driven, q, strict=True):
            gaps.append(self.value(poses, name) - value)
        return np.stack(gaps, axis=-1)

    def value(self, poses: np.ndarray, name: str) -> np.ndarray:
        """A joint on the ground."""
        joint = self.joints[name]
        if joint.get("kind") == "prismatic":
            return self.slid(poses, joint)[..., 0]
        (body,) = (b for b in joint["between"] if b != "ground")
        return self.frame(poses, body)[2]

    def found(self, q: np.ndarray, starts: np.ndarray) -> np.ndarray:
        """The task in the postures that Newton's method finds from some starts."""
        x, h = starts.copy(), 1e-6
        steps = h * np.eye(x.shape[-1])
        with np.errstate(all="ignore"):
            for _ in range(25):
                here = self.missed(x, q)
                apart = self.missed(x[:, None] + steps, q) - self.missed(x[:, None] - steps, q)
                rates = np.swapaxes(apart, -1, -2) / (2 * h)
                step = np.linalg.solve(rates + 1e-9 * np.eye(len(steps)), here[..., None])[..., 0]
                x = x - step / np.maximum(1, np.abs(step).max(axis=-1, keepdims=True))
        x = x[np.abs(self.missed(x, q)).max(axis=-1) < 1e-12]
        if self.hand in self.joints:
            return self.value(x, self.hand)[:, None]
        body = next(b for b in self.moving if self.hand in self.bodies[b])
        return self.at(x, body, self.bodies[body][self.hand])

    def gaps(self, answers: np.ndarray, given: np.ndarray) -> np.ndarray:
        """The largest difference of coordinates; angles up to whole turns."""
        difference = answers - given
        turns = self.joints.get(self.hand, {}).get("kind", "revolute") == "revolute"
        if self.hand in self.joints and turns:
            difference = np.angle(np.exp(1j * difference))
        return np.abs(difference).max(axis=-1)


def inputs(poses: Poses, rng: np.random.Generator, count: int) -> np.ndarray:
    """Values of the driven joints: angles, and lengths from 0.1 to 0.9."""
    slides = [poses.joints[n].get("kind") == "prismatic" for n in poses.driven]
    shape = (count, len(slides))
    return np.where(slides, rng.uniform(0.1, 0.9, shape), rng.uniform(-3, 3, shape))


def check_against_newton(loop: ModuleType, text: str) -> int:
    poses, rng = Poses(text), np.random.default_rng(1)
    count, hit = 0, np.zeros(len(loop.ASSEMBLY_MODES), bool)
    for q in inputs(poses, rng, 3):
        starts = rng.uniform(-1.5, 1.5, (60, 3 * len(poses.moving)))
        p = loop.fk(q).p
        for hand in poses.found(q, starts):
            gaps = poses.gaps(p, hand)
            assert np.nanmin(gaps) < 1e-6, (q, hand, p)
            hit |= gaps < 1e-6
            count += 1
    there = (loop.fk(inputs(poses, rng, 1000)).status == OK).any(axis=0)
    assert (hit == there).all()
    return count


def check_inverse(loop: ModuleType, text: str) -> None:
    poses, rng = Poses(text), np.random.default_rng(3)
    q = inputs(poses, rng, 5000)
    p, status = loop.fk(q)
    rows, modes = np.nonzero(status == OK)
    assert len(rows) > 100
    answers, told = loop.ik(p[rows, modes])
    with np.errstate(all="ignore"):
        off = np.nanmin(np.abs(np.angle(np.exp(1j * (answers - q[rows, None])))).max(-1), axis=-1)
    assert np.median(off) < 1e-12
    assert (off < 1e-5).all(), off.max()
    row, branch = np.nonzero(told == OK)
    again = loop.fk(answers[row, branch]).p
    missed = np.nanmin(poses.gaps(again, p[rows, modes][row][:, None]), axis=-1)
    assert (missed < 1e-11).all()


def check_jacobian(loop: ModuleType, text: str) -> None:
    poses, rng, h = Poses(text), np.random.default_rng(4), 1e-6
    q = inputs(poses, rng, 200)
    J, status = loop.jacobian(q), loop.fk(q).status
    for k in range(q.shape[1]):
        step = h * np.eye(q.shape[1])[k]
        ends = [loop.fk(q + step).p, loop.fk(q - step).p]
        rate = (ends[0] - ends[1]) / (2 * h)
        there = (status == OK) & (np.abs(J[..., k]).max(-1) < 10)
        assert there.any()
        assert np.nanmax(np.abs(rate - J[..., k])[there]) < 1e-4


@pytest.fixture(scope="module", params=tuple(MODES))
def loop(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    name, folder = request.param, tmp_path_factory.mktemp("sliding")
    content = text(name)
    assert len(content.splitlines()) < LINES
    return derived(f"{name}_groups", script_of(f"{name}_groups", content, folder), folder)


def text(name: str) -> str:
    return Path(FOLDER / f"{name}.toml").read_text("utf-8")


def name_of(loop: ModuleType) -> str:
    return loop.__name__.split(".")[-1].removesuffix("_groups")


def test_newton_finds_no_posture_that_the_closed_form_lacks(loop: ModuleType) -> None:
    assert len(loop.ASSEMBLY_MODES) == MODES[name_of(loop)]
    assert check_against_newton(loop, text(name_of(loop))) > 20


def test_it_is_drawn_in_modes_that_exist(loop: ModuleType) -> None:
    """In the first mode, the table of a scissor lift is there, and the ram of a shaper is not."""
    pytest.importorskip("matplotlib")
    from closedform.plot.catalogue import View, standard

    drawn = [figure.draw(loop) for figure in standard(View())[: 2 if hasattr(loop, "ik") else 1]]
    assert all(len(ax.lines) > 4 for ax in drawn)


def test_the_inverse_finds_every_posture(loop: ModuleType) -> None:
    check_inverse(loop, text(name_of(loop)))


def test_the_jacobian_is_the_derivative(loop: ModuleType) -> None:
    check_jacobian(loop, text(name_of(loop)))


def test_the_condition_number_is_that_of_the_jacobian(loop: ModuleType) -> None:
    if hasattr(loop, "condition_number"):
        q = inputs(Poses(text(name_of(loop))), np.random.default_rng(5), 300)
        there = loop.fk(q).status == OK
        kappa, J = loop.condition_number(q)[there], loop.jacobian(q)[there]
        assert np.abs(kappa / np.linalg.cond(J) - 1).max() < 1e-9 * kappa.max()


@pytest.mark.parametrize(
    ("name", "old", "new", "message"),
    [
        ("shaper", "lever = {C = [0, 0], B", "lever = {C = [0, 0], D", "lever has no point B"),
        ("shaper", 'block = {P = [0, 0]}', 'block = {length = "l"}', "rod block slides by s; give"),
        ("shaper", 'c = {between = ["ground", "lever"], at = "C"}\n', "", "3 degrees of freedom"),
        ("scissor_lift", "roller = {U = [0, 0]}", "roller = {U = [0, 1], K = [1, 1]}",
         "s slides along the line through V of table, on which roller has no point"),
        ("scissor_lift", ', axis = [1, 0]}\n', "}\n", "with axis"),
    ],
)  # fmt: skip
def test_a_file_that_does_not_fit_says_why(
    name: str, old: str, new: str, message: str, tmp_path: Path
) -> None:
    content = text(name)
    assert old in content
    with pytest.raises(TableError, match=message):
        script_of(name, content.replace(old, new), tmp_path)


BARS = 'bar2 = {Q = [0, 0], M = ["l/2", 0], V = ["l", 0]}'


@pytest.mark.parametrize(
    ("old", "new", "parallel"),
    [
        ("", "", True),
        (BARS, 'bar2 = {Q = [0, 0], M = ["0.4*l", 0], V = ["0.8*l", 0]}', True),
        (BARS, 'bar2 = {Q = [0, 0], M = ["0.4*l", 0], V = ["l", 0]}', False),
        (BARS, 'bar2 = {Q = [0, 0], M = ["l/2", "0.1"], V = ["l", 0]}', False),
        ("foot = {Q = [0, 0]}", "foot = {Q = [0, -0.1]}", False),  # the line does not pass O
        ('at = "V", kind', 'at = "H", kind', False),  # that of the table does not pass V
    ],
)  # fmt: skip
def test_crossed_bars_keep_a_table_parallel_if_their_pin_divides_both_alike(
    old: str, new: str, parallel: bool, tmp_path: Path
) -> None:
    """The table is found from the hand alone; else the linkage has a group of a higher class."""
    content = text("scissor_lift")
    assert old in content
    d = read_script(script_of("lift", content.replace(old, new), tmp_path))
    assert ("table stays parallel" in [step.title for step in d.steps]) == parallel
    assert ("ik" in [function.name for function in d.functions]) == parallel
    assert parallel or "a class above II" in d.without_inverse


WEDGE = """
hand = "h"
[parameters]
r = {value = "0.05"}
l = {value = "0.2"}
[bodies]
ground = {O = [0, 0], G = ["0.3", 0]}
crank = {A = ["r", 0]}
rod = {length = "l"}
wedge = {B = [0, 0]}
ram = {}
[joints]
theta = {between = ["ground", "crank"], at = "O", driven = true}
a = {between = ["crank", "rod"], at = "A"}
b = {between = ["rod", "wedge"], at = "B"}
s = {between = ["ground", "wedge"], at = "O", kind = "prismatic", axis = [1, 0]}
i = {between = ["wedge", "ram"], at = "B", kind = "prismatic", axis = [4, 1]}
h = {between = ["ground", "ram"], at = "G", kind = "prismatic", axis = [0, 1]}
"""


def test_a_loop_of_slides_keeps_directions_once(tmp_path: Path) -> None:
    """A wedge lifts a ram; the three slides among them count one direction too many."""
    loop = derived("wedge", script_of("wedge", WEDGE, tmp_path), tmp_path)
    h = loop.fk([[0.5], [2.0]]).p[..., 0]
    rod = np.sqrt(0.2**2 - (0.05 * np.sin([0.5, 2.0])) ** 2)
    for side in (1, -1):
        push = 0.05 * np.cos([0.5, 2.0]) + side * rod
        assert np.abs(h - ((0.3 - push) / 4)[:, None]).min(axis=1).max() < 1e-15


def test_the_disc_of_an_oldham_coupling_is_not_left_out(tmp_path: Path) -> None:
    """Its slides turn the follower, though it is placed last; it was left out as idle."""
    text = (FOLDER / "oldham.toml").read_text("utf-8")
    mechanism = derived("oldham_disc", script_of("oldham_disc", text, tmp_path), tmp_path)
    angles = np.linspace(-3, 3, 7)[:, None]
    psi, status = mechanism.fk(angles)
    assert (status == OK).all() and np.allclose(psi[:, 0], angles)
    assert np.allclose(mechanism.jacobian(angles), 1)
    *_, disc = mechanism.skeleton([0.3])[0]
    e, (c, s) = mechanism.Parameters().e, (np.cos(0.3), np.sin(0.3))
    assert np.allclose(disc, [e * c * c, e * c * s, 0])  # on the circle over both shafts


PUSHED = """
hand = "D"
[bodies]
ground = {O = [0, 0]}
sx = {A = [0, 0]}
sy = {B = [0, 0]}
upper = {A = [0, 0], C = [0.2, 0], D = [0.4, 0]}
front = {length = 0.1}
[joints]
qx = {between = ["ground", "sx"], at = "O", kind = "prismatic", axis = [1, 0], driven = true}
qy = {between = ["ground", "sy"], at = "O", kind = "prismatic", axis = [0, 1], driven = true}
a = {between = ["sx", "upper"], at = "A"}
b = {between = ["sy", "front"], at = "B"}
c = {between = ["upper", "front"], at = "C"}
"""


def test_both_bars_may_be_at_right_angles_to_their_sliders(tmp_path: Path) -> None:
    """There rounding of the hand moves the first slider far, and the second bar just reaches."""
    pushed = derived("pushed", script_of("pushed", PUSHED, tmp_path), tmp_path, crosscheck=True)
    rng = np.random.default_rng(3)
    near = rng.choice([0, *10.0 ** np.arange(-12, -2)], (20_000, 2)) * rng.choice(
        [-1, 1], (20_000, 2)
    )
    p, status = pushed.fk(rng.choice([-0.2, -0.1, 0.1, 0.2], (20_000, 2)) + near)
    x = p[status == OK]
    q, status = pushed.ik(x)
    assert len(x) > 10_000 and ((status == OK) | (status == SINGULAR)).any(axis=-1).all()
    again, ok = pushed.fk(q), status == OK
    size = 0.5 + np.abs(x).sum(axis=-1)  # bars, and how far the sliders are
    gaps = np.linalg.norm(again.p - x[:, None, None], axis=-1) / size[:, None, None]
    assert np.nanmin(gaps[ok], axis=-1).max() < 1e-12
    assert (status == OK).any(axis=-1).mean() > 0.9
