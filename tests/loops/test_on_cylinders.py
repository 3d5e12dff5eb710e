"""A hand on rods in cylindrical joints, which does not turn (3-PRC, 3-RRC), against its drawing."""

from pathlib import Path

import numpy as np
import pytest
from loop_files import apart, derived, newton, script_of
from places import TESTS

from closedform import Derivation, FreeAlong, OnCylinders, Paper, Slide, guided
from closedform.algebra.shapes import ShapeError
from closedform.scaffold.inputs.tables import TableError

SLIDERS = (TESTS / "held_out_loops" / "three_prc.toml").read_text("utf-8")
LEGS = ("[0, 1, 0]", "[0, 0, 1]", "[1, 0, 0]")
WAYS = ("[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]")


def cranks() -> str:
    """The same on cranks, which turn about the axes of their rods."""
    text = SLIDERS.replace("[bodies]", 'a = {value = "0.2", meaning = "cranks"}\n[bodies]')
    for k, (axis, way) in enumerate(zip(LEGS, WAYS, strict=True), 1):
        text = text.replace(f'kind = "prismatic", axis = {way}, driven', f"axis = {axis}, driven")
        text = text.replace(f"s{k} = {{B{k} = [0, 0, 0]}}", f"s{k} = {{B{k} = {way}}}")
        text = text.replace(f"B{k} = {way}", f"B{k} = {way}".replace("1]", '"a"]'))
        text = text.replace("[1, 0, 0]}", '["a", 0, 0]}') if k == 1 else text
        text = text.replace(f"B{k} = [0, 1, 0]", f'B{k} = [0, "a", 0]')
    return text


TEXTS = {"sliders": SLIDERS, "cranks": cranks()}
OK, UNREACHABLE, SINGULAR = range(3)
ALONG, AXES = np.eye(3), np.roll(np.eye(3), 1, axis=1)
ENDS = np.roll(np.eye(3), 2, axis=1)


@pytest.fixture(scope="module", params=TEXTS)
def mechanism(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory):
    kind, folder = request.param, tmp_path_factory.mktemp("m")
    assert len(TEXTS[kind].splitlines()) < 45
    return kind, derived(
        f"cylinder_{kind}",
        script_of(f"cylinder_{kind}", TEXTS[kind], folder),
        folder,
        crosscheck=True,
    )


def missed(kind: str, v, p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """By how much rods miss their lengths, seen along their axes."""
    near = q[:, None] * ALONG
    if kind == "cranks":
        turned = np.cross(AXES, ALONG)
        near = v.a * (np.cos(q)[:, None] * ALONG + np.sin(q)[:, None] * turned)
    spans = p + v.e * ENDS - near
    across = spans - (spans * AXES).sum(axis=1)[:, None] * AXES
    return np.linalg.norm(across, axis=1) - v.l


def targets(kind: str, count: int) -> np.ndarray:
    near = {"sliders": 0.0, "cranks": 0.15}[kind]
    return np.random.default_rng(2).uniform(near + 0.1, near + 0.2, (count, 3))


def test_newton_finds_no_joints_that_the_closed_form_lacks(mechanism) -> None:
    kind, m = mechanism
    rng, v, met = np.random.default_rng(1), m.Parameters(), 0
    for x in targets(kind, 20):
        q, status = m.ik(x)
        assert q.shape == (8, 3) and (status == OK).all()
        for row in q:
            assert np.abs(missed(kind, v, x, row)).max() < 1e-12
        for start in rng.uniform(-1, 1, (8, 3)):
            found = newton(lambda q: missed(kind, v, x, q), start)  # noqa: B023
            if found is not None:
                met += 1
                assert apart(q, found, np.array([kind == "cranks"])).min() < 1e-9
    assert met > 80


def test_at_most_eight_positions_have_the_same_joints(mechanism) -> None:
    kind, m = mechanism
    rng, v, x = np.random.default_rng(3), m.Parameters(), targets(kind, 1)[0]
    q, seen = m.ik(x).q[0], []
    for start in rng.uniform(-1, 1, (200, 3)):
        found = newton(lambda x: missed(kind, v, x, q), start)
        if found is not None and not any(np.allclose(found, e, atol=1e-7) for e in seen):
            seen.append(found)
    assert any(np.allclose(x, e, atol=1e-7) for e in seen) and 2 <= len(seen) <= 8


def test_rates_are_those_of_the_drawing(mechanism) -> None:
    kind, m = mechanism
    step = np.array([1e-7, 2e-7, -1e-7])
    for x in targets(kind, 10):
        for k, q in enumerate(m.ik(x).q):
            K, J = m.jacobian_inverse(x, q), m.jacobian(x, q)
            assert np.allclose(m.ik(x + step).q[k] - q, K @ step, atol=1e-10)
            assert np.allclose(J @ K, np.eye(3), atol=1e-9)
            assert np.isclose(m.determinant(x, q), np.linalg.det(J))
            A, B = m.jacobian_parallel(x, q), m.jacobian_serial(x, q)
            assert np.allclose(A, np.diag(B) @ K)
            assert np.isclose(m.singularities(x, q)[-1], np.linalg.det(A))


def test_rods_in_one_plane_do_not_hold_the_hand(mechanism) -> None:
    kind, m = mechanism
    if kind == "sliders":
        v = m.Parameters()
        x = [v.l - v.e, 0, -v.e]  # the first two rods are along the x axis
        q, status = m.ik(x)
        flat = [k for k in range(8) if abs(m.singularities(x, q[k])[-1]) < 1e-12]
        assert flat and (status[flat] == SINGULAR).all()
    assert (m.ik([9, 9, 9]).status == UNREACHABLE).all()


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('"A1", kind = "prismatic", axis = [1, 0, 0]', '"A1", kind = "prismatic", axis = [1, 1, 0]',
         "its axis has to be at right angles to that of b1"),
        ('"A1", kind = "prismatic", axis = [1, 0, 0]', '"A1", axis = [1, 0, 0]',
         "its axis has to be parallel to that of b1"),
    ],
)  # fmt: skip
def test_a_motor_that_moves_the_rod_along_its_axis(
    old: str, new: str, told: str, tmp_path: Path
) -> None:
    assert old in SLIDERS
    with pytest.raises(TableError, match=told):
        script_of("t", SLIDERS.replace(old, new), tmp_path)


def test_legs_that_are_not_free_are_refused() -> None:
    d = Derivation("t", "T", Paper("t", "T", ("A",)), "T")
    q = [d.joint(f"q{k}", "prismatic") for k in (1, 2, 3)]
    s = d.joint("s", "prismatic", passive=True)
    slides = [
        Slide(e, 1, (0, 0, 0), tuple(way))
        for e, way in zip(q, np.eye(3, dtype=int).tolist(), strict=True)
    ]
    with pytest.raises(ShapeError, match="is FreeAlong its axis"):
        guided(d, OnCylinders(), slides)
    with pytest.raises(ShapeError, match="the leg of q1 needs its passive slide"):
        guided(d, OnCylinders(), [FreeAlong(e, e.direction[1:] + e.direction[:1]) for e in slides])
    same = [Slide(e, 1, (k, 0, 0), (1, 0, 0)) for k, e in enumerate(q)]
    with pytest.raises(ShapeError, match="all axes have the same direction"):
        guided(d, OnCylinders(), [FreeAlong(e, (0, 0, 1), slide=s) for e in same])
