"""The claims about the five-bar linkage: the distinct errors, and the corrections by other routes.

The corrections are read from their texts and compared with numbers of the generated module.
"""

import importlib
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from functools import partial

import claimed
import numpy as np
import pytest
import sympy as sp
from closedform.derivations.claims import five_bar_postures

from closedform.model.claims import FAULTS, Claim, Reading
from closedform.model.notation import Relation
from closedform.proof.claims import judged

ERRATA = {
    "sign-of-B": {"eq. (4)"},
    "half-turns": {"k(π/2), after eq. (6)"},
    "on-the-axis": {"serial singularities at the boundary"},
    "radius": {"hollow spheres"},
    "C-meets-D": {"C and D apart", "no parallel singularity"},
    "never-smaller": {"not avoidable", "always smaller"},
    "kappa-of-B": {"condition numbers differ"},
    "old-index": {
        "eigenvalue α1",
        "eigenvalue α3",
        "eq. (8)",
        "minimum of 1",
        "infinity",
        "most accurate",
        "singular postures",
    },
    "obtuse": {"eq. (8), obtuse angles"},
    "eigenvalue-scale": {"eigenvalue α2"},
    "boundary": {
        "singularities at the boundary",
        "singularities define the boundary",
        "the singularity locus",
    },
    "isotropy": {"isotropy for all dimensions"},
}
DIMENSIONS = (7, 8, 5)
arm = importlib.import_module("closedform.generated.numpy.hybrid_five_bar")


results = partial(claimed.results, "hybrid_five_bar")


def claim(label: str) -> Claim:
    return claimed.claims("hybrid_five_bar")[label]


def test_the_distinct_errors_and_their_places() -> None:
    places = defaultdict(set)
    for label, result in results().items():
        if result.erratum:
            places[result.erratum].add(label)
    assert places == ERRATA
    assert {e.key for e in claimed.derivation("hybrid_five_bar").errata} == set(ERRATA)


def test_how_many_claims_have_which_verdict() -> None:
    assert Counter(r.kind for r in results().values()) == {
        "proved": 49,
        "refuted": 20,
        "incomplete": 1,
        "proved under assumption": 2,
        "not decidable here": 9,
    }


def test_every_fault_has_a_correction() -> None:
    faults = [r for r in results().values() if r.kind in FAULTS]
    assert all(r.corrected for r in faults)
    assert {r.label for r in faults} == set().union(*ERRATA.values()) - {"hollow spheres"}


def test_figures_without_lengths_refute_nothing() -> None:
    """Only readings that the captions contradict make the sections equal or disjoint."""
    twice = results()["twice as large"]
    assert [r.kind for r in twice.readings] == ["not decidable here", "refuted", "refuted"]
    assert twice.kind == "not decidable here"


def test_singularities_at_the_border_are_those_of_the_plane_linkage() -> None:
    """Of the three joints the axis AB is another place of singularities, inside the workspace."""
    found = results()["all singularities at the border"]
    assert [r.kind for r in found.readings] == ["proved", "refuted"]


def points(evidence: Sequence[object]) -> Iterator[dict[str, complex]]:
    for piece in evidence:
        if isinstance(piece, Mapping):
            yield {str(s): complex(value) for s, value in piece.items()}


@pytest.mark.parametrize(
    "label", sorted({*ERRATA["old-index"], *ERRATA["sign-of-B"], *ERRATA["half-turns"]})
)
def test_a_posture_that_refutes_can_be_taken(label: str) -> None:
    """Its loop is closed: both legs lead to the same point, by complex numbers."""
    found = list(points(judged(claim(label), claim(label).printed).evidence))
    assert found
    for at in found:
        end = {f"theta{i}": np.exp(1j * at[f"theta{i}"]) for i in (2, 3, 4, 5)}
        over_c = at["L1"] * end["theta2"] + at["L2"] * end["theta4"]
        over_d = at["L0"] + at["L1"] * end["theta3"] + at["L2"] * end["theta5"]
        assert abs(over_c - over_d) < 1e-12


def test_a_posture_whose_loop_is_open_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(five_bar_postures, "CLOSED", ((1, 1, 1, 0, 0, 0, sp.pi),))
    with pytest.raises(ValueError, match="the loop is not closed"):
        judged(claim("eq. (4)"), claim("eq. (4)").printed)


@pytest.mark.parametrize(
    ("label", "old", "new"),
    [
        ("eq. (1a)", r"\dot{\theta}_4", r"\dot{\theta}_5"),
        ("eqs. (2) and (5)", r"\mathbf{A}\dot", r"\mathbf{B}\dot"),
        ("eq. (3)", r"(\mathbf{p} - \mathbf{c})", r"(\mathbf{c} - \mathbf{p})"),
        ("eq. (6)", "L_2^2", "L_2^3"),
        ("eight working modes", "eight", "four"),
        ("mirror images", "{AB}", "{of symmetry between A and B}"),
        ("hollow spheres", "L_1 - L_2", "L_1 - L_0"),
        ("two operative working modes", "{only} {two}", "{only} {three}"),
        ("lengths", "$L_4$", "$L_3$"),
        ("two degrees of freedom", "{two}", "{three}"),
        ("Figure 12", "{convex}", "{non-convex}"),
        ("surfaces of revolution", "{first}", "{second}"),
    ],
)
def test_a_changed_text_is_judged_as_another_claim(label: str, old: str, new: str) -> None:
    text = claim(label).printed
    assert old in text
    assert judged(claim(label), text).kind in ("proved", "proved under assumption")
    assert judged(claim(label), text.replace(old, new, 1)).kind == "refuted"


# The corrections, by numbers


@pytest.fixture(scope="module")
def postures() -> dict[str, np.ndarray]:
    """Random joints at which the loop closes, in the first assembly mode."""
    q = np.random.default_rng(17).uniform(-np.pi, np.pi, (4000, 3))
    q = q[arm.fk(q, DIMENSIONS).status[:, 0] == 0]
    passive = arm.passive_angles(q, DIMENSIONS)[:, 0]
    clear = np.abs(np.sin(passive[:, 0] - passive[:, 1])) > 1e-3
    values = np.concatenate([q, passive], axis=1)[clear].T
    return {f"theta{i}": v for i, v in enumerate(values, 1)} | {"q": q[clear]}


def right_side(label: str, text: str, at: dict[str, np.ndarray]) -> np.ndarray:
    """The values of the right side of the first formula of a text of a claim."""
    c = claim(label)
    reading = next(iter(c.readings), Reading("as printed"))
    relation = c.pieces(text, c.notation.extended(reading.means))[0]
    assert isinstance(relation, Relation)
    lengths = dict(zip(("L0", "L1", "L2"), DIMENSIONS, strict=True))
    right = relation.right.subs({s: lengths[s.name] for s in relation.right.free_symbols
                                 if s.name in lengths})  # fmt: skip
    right = right.subs({s: sp.Rational(5, 8) for s in right.free_symbols if s.name == "lambda_1"})
    symbols = sorted(right.free_symbols, key=str)
    entries = right if isinstance(right, sp.MatrixBase) else sp.Matrix([right])
    found = [sp.lambdify(symbols, e, "numpy")(*(at[s.name] for s in symbols)) for e in entries]
    ones = np.ones(len(at["q"]))
    return np.stack([f * ones for f in found], axis=-1).reshape(-1, *entries.shape)


def by_differences(q: np.ndarray, h: float = 1e-6) -> np.ndarray:
    """The derivatives of P by the joints, from positions alone."""
    steps = np.eye(3) * h
    ends = [(arm.fk(q + s, DIMENSIONS).p[:, 0], arm.fk(q - s, DIMENSIONS).p[:, 0]) for s in steps]
    return np.stack([(a - b) / (2 * h) for a, b in ends], axis=-1)


def test_the_sign_of_B_by_differences(postures) -> None:
    """A dp = B dq, with the rows p - c and p - d of A from the positions of the points."""
    c = claim("eq. (4)")
    A = arm.jacobian_parallel(postures["q"], DIMENSIONS)[:, 0]
    moved = A @ by_differences(postures["q"])
    wrong, right = (right_side("eq. (4)", text, postures) for text in (c.printed, c.corrected))
    good = np.abs(moved).max(axis=(1, 2)) < 1e3
    np.testing.assert_allclose(moved[good], right[good], atol=1e-3)
    np.testing.assert_allclose(-moved[good][:, 1:], wrong[good][:, 1:], atol=1e-3)


@pytest.mark.parametrize("label", ["eq. (8)", "eq. (8), obtuse angles"])
def test_the_condition_number_by_singular_values(postures, label: str) -> None:
    kappa = np.linalg.cond(arm.jacobian_parallel(postures["q"], DIMENSIONS)[:, 0])
    c = claim(label)
    found = right_side(label, c.corrected, postures)[:, 0, 0]
    np.testing.assert_allclose(found, kappa, rtol=1e-9)
    printed = right_side(label, c.printed, postures)[:, 0, 0]
    acute = np.cos(postures["theta4"] - postures["theta5"]) > 0
    if "obtuse" in label:
        np.testing.assert_allclose(printed, np.where(acute, kappa, 1 / kappa), rtol=1e-9)
    else:
        assert np.median(np.abs(printed / kappa - 1)) > 0.1


@pytest.mark.parametrize("i", [1, 2, 3])
def test_the_eigenvalues(postures, i: int) -> None:
    label = f"eigenvalue α{i}"
    A = arm.jacobian_parallel(postures["q"], DIMENSIONS)[:, 0]
    found = np.linalg.eigvalsh(A @ np.swapaxes(A, 1, 2))[:, i - 1]
    corrected = right_side(label, claim(label).corrected, postures)[:, 0, 0]
    np.testing.assert_allclose(corrected, found, rtol=1e-9, atol=1e-9)


def grid(n: int = 240) -> tuple[np.ndarray, np.ndarray]:
    angles = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return np.meshgrid(angles, angles)


def chords(lengths: tuple[int, int, int]) -> np.ndarray:
    """CD over all driven angles, by complex numbers."""
    theta2, theta3 = grid()
    L0, L1, _ = lengths
    return np.abs(L0 + L1 * np.exp(1j * theta3) - L1 * np.exp(1j * theta2))


def test_designs_without_parallel_singularities() -> None:
    """The printed conditions allow C = D; with the corrected ones CD stays between 0 and 2 L2."""
    by_paper, corrected = chords((1, 1, 2)), chords((3, 1, 3))
    assert by_paper.min() < 1e-9
    assert corrected.min() > 0.99
    assert corrected.max() < 6


def test_some_dimensions_have_no_isotropic_posture() -> None:
    theta = np.stack([0 * grid()[0], *grid()], axis=-1).reshape(-1, 3)
    least = {
        lengths: np.nanmin(arm.condition_number(theta, lengths))
        for lengths in ((1, 1, 3), (3.5, 1, 1), DIMENSIONS)
    }
    assert least[1, 1, 3] > 1.5
    assert 1.1 < least[3.5, 1, 1] < np.inf  # the loop closes
    assert least[DIMENSIONS] < 1.01


def test_working_modes_share_the_condition_number_of_B() -> None:
    p = np.random.default_rng(3).uniform(-8, 8, (2000, 3))
    q, status = arm.ik(p, DIMENSIONS)
    reached = (status == 0).all(axis=-1)
    p, q = p[reached], q[reached]
    assert len(q) > 100
    gaps = np.linalg.norm(arm.fk(q, DIMENSIONS).p - p[:, None, None], axis=-1)
    mode = np.nanargmin(gaps, axis=-1)[..., None, None]
    entries = np.take_along_axis(arm.jacobian_serial(q, DIMENSIONS), mode, axis=-2)[..., 0, :]
    kappa = np.abs(entries).max(axis=-1) / np.abs(entries).min(axis=-1)
    np.testing.assert_allclose(kappa / kappa[:, :1], 1, rtol=1e-6)
    kappa_A = np.take_along_axis(arm.condition_number(q, DIMENSIONS), mode[..., 0], axis=-1)[..., 0]
    assert (kappa_A.max(axis=-1) > 1.01 * kappa_A.min(axis=-1)).any()


def test_the_axis_is_singular_inside_the_workspace() -> None:
    p = np.array([0.0, 3.5, 0.0])
    near = p + np.random.default_rng(5).uniform(-0.1, 0.1, (200, 3))
    assert arm.workspace_contains(near, DIMENSIONS).all()
    q, _ = arm.ik(p, DIMENSIONS)
    q[:, 0] = 0.4  # free on the axis
    B = arm.jacobian_serial(q, DIMENSIONS)
    assert np.nanmin(np.abs(B[..., 0]), axis=-1).max() < 1e-12
