"""The agile wrist: its loop by matrix exponentials, its modes by Newton's method."""

from dataclasses import replace

import numpy as np
import pytest
from closedform.derivations.agile_wrist import d
from closedform.generated.numpy import agile_wrist as wrist

from closedform.proof.claims import judged
from closedform.proof.inverse import prove_inverse
from closedform.proof.require import ProofError

OK, UNREACHABLE, SINGULAR, INVALID = range(4)
BASE = np.eye(3)
HOME = np.roll(BASE, -1, axis=0), np.roll(BASE, -2, axis=0)
"""The middle axes and the last axes, as rows, where all joints are zero."""
STARTS = 60


def hat(v: np.ndarray) -> np.ndarray:
    return np.cross(np.eye(3), v[..., None, :])


def turn(axis: np.ndarray, angle: np.ndarray | float) -> np.ndarray:
    """The exponential of hat(axis) * angle, as a series."""
    result, term = np.eye(3), np.eye(3)
    turned = hat(axis) * np.asarray(angle)[..., None, None]
    for k in range(1, 40):
        term = term @ turned / k
        result = result + term
    return result


def middle(q: np.ndarray) -> np.ndarray:
    """The middle axes, as rows."""
    return np.array([turn(u, a) @ w for u, a, w in zip(BASE, q, HOME[0], strict=True)])


def last(R: np.ndarray) -> np.ndarray:
    """The last axes, as rows, if the hand is turned by R."""
    return HOME[1] @ R.swapaxes(-1, -2)


def missed(q: np.ndarray, R: np.ndarray) -> np.ndarray:
    return np.einsum("ij,...ij->...i", middle(q), last(R))


def random_rotations(rng: np.random.Generator, rows: int) -> np.ndarray:
    q, _ = np.linalg.qr(rng.normal(size=(rows, 3, 3)))
    return q * np.linalg.det(q)[:, None, None]


def gap(q: np.ndarray) -> np.ndarray:
    return np.cos(q).prod(axis=-1) - np.sin(q).prod(axis=-1)


def test_newtons_method_finds_these_modes_and_four_that_no_joint_moves() -> None:
    rng = np.random.default_rng(1)
    for q in rng.uniform(-np.pi, np.pi, (6, 3)):
        if abs(gap(q)) < 0.05:
            continue
        w = middle(q)
        ends = random_rotations(rng, STARTS)
        for _ in range(30):
            A = np.cross(w, last(ends))
            step = (np.linalg.pinv(A) @ missed(q, ends)[..., None])[..., 0]
            size = np.linalg.norm(step, axis=-1)
            ends = turn(step / np.where(size, size, 1)[:, None], np.minimum(size, 1)) @ ends
        solutions: list[np.ndarray] = []
        for R in ends[abs(missed(q, ends)).max(axis=1) < 1e-12]:
            if all(abs(R - s).max() > 1e-6 for s in solutions):
                solutions.append(R)
        assert len(solutions) == 8
        moved = [R for R in solutions if abs(np.diag(last(R))).min() < 1 - 1e-9]
        found = wrist.fk(q)
        assert len(moved) == 4
        assert (found.status == OK).all()
        for R in found.p:
            assert min(abs(R - s).max() for s in moved) < 1e-10


def test_legs_as_products_of_exponentials() -> None:
    rng = np.random.default_rng(2)
    for q in rng.uniform(-np.pi, np.pi, (50, 3)):
        passive = wrist.passive_angles(q)
        for R, phi in zip(wrist.fk(q).p, passive, strict=True):
            np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-13)
            assert np.linalg.det(R) > 0
            for u, w, v, a, b in zip(BASE, HOME[0], last(R), q, phi, strict=True):
                np.testing.assert_allclose(turn(u, a) @ turn(w, b) @ u, v, atol=1e-12)


def test_jacobian_against_differences() -> None:
    rng = np.random.default_rng(3)
    q = rng.uniform(-np.pi, np.pi, (300, 3))
    q = q[np.abs(wrist.jacobian_space(q)).max(axis=(1, 2, 3)) < 20]
    R, J, step = wrist.fk(q).p, wrist.jacobian_space(q), 1e-6
    assert len(q) > 250
    for k in range(3):
        ahead, behind = (wrist.fk(q + s * step * np.eye(3)[k]).p for s in (1, -1))
        spin = (ahead - behind) / (2 * step) @ R.swapaxes(-1, -2)
        omega = np.stack([spin[..., 2, 1], spin[..., 0, 2], spin[..., 1, 0]], axis=-1)
        np.testing.assert_allclose(J[..., k], omega, atol=1e-5)
    np.testing.assert_allclose(wrist.determinant(q), np.linalg.det(J), rtol=1e-9, atol=1e-12)
    A, B = wrist.jacobian_parallel(q), wrist.jacobian_serial(q)
    np.testing.assert_allclose(A @ J, B[..., None] * np.eye(3), atol=1e-11)
    kappa = np.linalg.norm(A, axis=(2, 3)) * np.linalg.norm(np.linalg.inv(A), axis=(2, 3)) / 3
    np.testing.assert_allclose(wrist.condition_number(q), kappa, rtol=1e-8)


def test_it_is_isotropic_at_home() -> None:
    np.testing.assert_array_equal(wrist.fk(np.zeros(3)).p[0], np.eye(3))
    np.testing.assert_array_equal(wrist.condition_number(np.zeros(3)), np.ones(4))
    np.testing.assert_array_equal(wrist.jacobian_space(np.zeros(3))[0], np.eye(3))


def hostile(rng: np.random.Generator, rows: int) -> np.ndarray:
    """Joints near the singular sets: two middle axes that are nearly parallel, or C close to S."""
    q = rng.uniform(-np.pi, np.pi, (rows, 3))
    off = rng.choice([-1, 1], (rows, 3)) * 10 ** rng.uniform(-17, -1, (rows, 3))
    off *= rng.random((rows, 3)) < 0.8
    k = rng.integers(0, 3, rows)
    each = np.arange(rows)
    parallel = rng.random(rows) < 0.5
    i, j = (k + 1) % 3, (k + 2) % 3
    crossed, along = rng.choice([-1, 1], rows) * np.pi / 2, rng.choice([0, np.pi, -np.pi], rows)
    near = q.copy()
    near[each, i], near[each, j] = crossed + off[:, 0], along + off[:, 1]
    meet = q.copy()
    meet[each, k] = np.arctan2(
        np.cos(q[each, i]) * np.cos(q[each, j]), np.sin(q[each, i]) * np.sin(q[each, j])
    )
    meet[each, k] += off[:, 2]
    return np.where(parallel[:, None], near, meet)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_no_posture_is_lost(backend: str) -> None:
    module = pytest.importorskip(f"closedform.generated.{backend}.agile_wrist")
    rng = np.random.default_rng(4)
    q = np.concatenate([rng.uniform(-np.pi, np.pi, (100_000, 3)), hostile(rng, 30_000)])
    regular = abs(gap(q)) > 2e-3
    assert 100_000 < regular.sum() < len(q) - 10_000
    forward = module.fk(q)
    assert (forward.status[regular] == OK).all()
    np.testing.assert_allclose(
        forward.p @ forward.p.swapaxes(-1, -2),
        np.broadcast_to(np.eye(3), (len(q), 4, 3, 3)),
        atol=1e-14,
    )
    for mode in range(4):
        R = forward.p[:, mode]
        x, status = module.ik(R)
        assert np.isin(status, (OK, SINGULAR)).all()
        assert (status[regular] == OK).all()
        apart = np.abs(np.angle(np.exp(1j * (x - q[:, None])))).max(axis=-1).min(axis=-1)
        assert (apart * abs(gap(q)))[regular].max() < 1e-14
        back = module.fk(x.reshape(-1, 3)).p.reshape(-1, 8, 4, 3, 3)
        error = abs(back - R[:, None, None]).max(axis=(-1, -2)).min(axis=-1)
        assert error[status == OK].max() < 1e-12
        loop = [
            np.cos(x[..., k]) * R[:, None, i, j] + np.sin(x[..., k]) * R[:, None, j, j]
            for k, i, j in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        ]
        assert np.abs(loop).max() < 1e-14


def test_working_modes_and_assembly_modes_are_those_of_the_signs() -> None:
    rng = np.random.default_rng(5)
    q = rng.uniform(-np.pi, np.pi, (1000, 3))
    R = wrist.fk(q).p[:, 2]
    sign = np.array([[1 if s == "plus" else -1 for s in b.split("_")] for b in wrist.BRANCHES])
    for branch, signs in enumerate(sign):
        x = wrist.ik(R).q[:, branch]
        mode = abs(wrist.fk(x).p - R[:, None]).max(axis=(-1, -2)).argmin(axis=1)
        B = np.take_along_axis(wrist.jacobian_serial(x), mode[:, None, None], 1)[:, 0]
        np.testing.assert_array_equal(np.sign(B), np.broadcast_to(signs, B.shape))
        names = np.array(["plus_plus", "plus_minus", "minus_plus", "minus_minus"])
        assert tuple(names) == wrist.ASSEMBLY_MODES
        seen = np.where(signs[:2] * signs.prod() > 0, "plus", "minus")
        assert set(names[mode]) == {"_".join(seen)}


def test_where_the_last_axes_are_along_the_first_all_joints_are_free() -> None:
    rng = np.random.default_rng(6)
    for signs in ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)):
        R = (np.diag(signs) @ BASE).T @ HOME[1]
        np.testing.assert_array_equal(last(R), np.diag(signs))
        x, status = wrist.ik(R)
        assert (status == SINGULAR).all()
        np.testing.assert_array_equal(x, np.zeros((8, 3)))
        for q in rng.uniform(-np.pi, np.pi, (20, 3)):
            assert abs(missed(q, R)).max() < 1e-15
            assert abs(wrist.fk(q).p - R).max(axis=(1, 2)).min() > abs(gap(q)) / 10
        q = rng.uniform(0.2, 1.3, 2)
        third = np.arctan2(np.cos(q).prod(), np.sin(q).prod())
        assert abs(wrist.fk(np.array([*q, third])).p - R).max(axis=(1, 2)).min() < 1e-14


def test_where_two_middle_axes_are_parallel_the_hand_is_free() -> None:
    for k in range(3):
        q = np.full(3, 0.7)
        q[(k + 1) % 3], q[(k + 2) % 3] = -np.pi / 2, np.pi
        R, status = wrist.fk(q)
        assert (status == SINGULAR).all()
        for angle in (0, 0.4, 2.0):
            about = turn(BASE[k], angle)
            for hand in R:
                assert abs(missed(q, about @ hand)).max() < 1e-15
                assert (wrist.ik(about @ hand).status == SINGULAR).all()


def test_a_matrix_that_is_not_a_rotation_is_invalid() -> None:
    for R in (-np.eye(3), 1.001 * np.eye(3), np.diag([1.0, 1.0, np.nan])):
        assert (wrist.ik(R).status == INVALID).all()
        assert np.isnan(wrist.ik(R).q).all()


def test_the_proof_of_the_forward_map_can_fail() -> None:
    (inverse,) = (i for i in d.inverses if i.function == "fk")
    (link,) = inverse.links
    assert prove_inverse(d, inverse).solutions == 4
    first, *_ = link.lemma.solution
    wrong = {**link.lemma.solution, first: -link.lemma.solution[first]}
    for lemma, message in (
        (replace(link.lemma, solution=wrong), "does not satisfy its equations"),
        (replace(link.lemma, excluded=0), "8 solutions, but 4 branches"),
    ):
        broken = replace(inverse, links=(replace(link, lemma=lemma),))
        with pytest.raises(ProofError, match=message):
            prove_inverse(d, broken)


@pytest.mark.parametrize(
    ("label", "number", "right"),
    [("assembly", 4, True), ("assembly", 8, False), ("working", 8, True), ("working", 4, False)],
)
def test_the_counts_of_the_abstract_are_computed(label: str, number: int, right: bool) -> None:
    """With the four orientations that are left out there would be eight assembly modes."""
    claim = next(c for c in d.claims if c.label.startswith(label))
    words = {4: "four", 8: "eight"}
    printed = claim.printed.replace("four", words[number]).replace("eight", words[number])
    assert judged(claim, printed).kind == ("proved" if right else "refuted")
