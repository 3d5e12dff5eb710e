"""The errors that the claims of Reddy and Babu show, and how grave they are."""

import claimed
import pytest

from closedform.model.claims import Gravity
from closedform.proof.claims import ClaimResult

ERRATA = {
    "planar_2r": {
        "folded": (Gravity.OMISSION, {"one solution": "incomplete"}),
        "tan-alpha": (Gravity.MISPRINT, {"tan α, before eq. (4)": "refuted"}),
        "sum-of-cosines": (Gravity.MISPRINT, {"c_12, after eq. (8)": "refuted"}),
        "last-row": (
            Gravity.MISPRINT, {"eq. (9), second factor": "refuted", "eq. (9)": "refuted"},
        ),
        "rows-lost": (Gravity.OMISSION, {"list of eq. (10)": "incomplete"}),
        "rounding": (
            Gravity.STATEMENT,
            {"Results B, x": "refuted", "Results B, y": "refuted"},
        ),
        "quadrant": (Gravity.OMISSION, {"use of eqs. (3) and (4)": "incomplete"}),
        "elbow-up": (
            Gravity.RESULT, {"Results A, elbow up": "refuted", "Results A, orientation": "refuted"},
        ),
    },
    "spherical_wrist": {
        "aligned-axes": (Gravity.OMISSION, {"eq. (13)": "incomplete", "eq. (16)": "incomplete"}),
        "entry-12": (
            Gravity.MOTION,
            {"eq. (14)": "refuted", "eq. (15)": "refuted", "same matrix": "refuted"},
        ),
        "second-solution": (
            Gravity.OMISSION,
            {"Results C, Euler angles": "incomplete", "Results C, D-H angles": "incomplete"},
        ),
    },
}  # fmt: skip


def results(name: str) -> dict[str, ClaimResult]:
    """The claims that show an erratum; the others are proved when the robot is derived."""
    return {label: r for label, r in claimed.results(name).items() if r.erratum}


def described(name: str) -> dict[str, Gravity]:
    return {e.key: e.gravity for e in claimed.derivation(name).errata}


@pytest.mark.parametrize("name", ERRATA)
def test_distinct_errors(name: str) -> None:
    found: dict[str, dict[str, str]] = {}
    for label, result in results(name).items():
        found.setdefault(result.erratum, {})[label] = result.kind
    assert found == {key: places for key, (_, places) in ERRATA[name].items()}
    assert described(name) == {key: gravity for key, (gravity, _) in ERRATA[name].items()}


@pytest.mark.parametrize("name", ERRATA)
def test_every_error_has_a_correction_with_digits_as_printed(name: str) -> None:
    assert all(result.corrected for result in results(name).values())


@pytest.mark.parametrize(
    ("label", "holds"),
    [
        ("Results A, elbow up", r"\theta_1 = 56.5894^\circ"),
        ("Results A, orientation", r"26.5894^\circ"),
        ("Results B, x", r"$x = 12.6603 \text{ cm}$"),
        ("Results B, y", r"$y = 11.9282 \text{ cm}$"),
    ],
)
def test_exact_values(label: str, holds: str) -> None:
    assert holds in results("planar_2r")[label].corrected


@pytest.mark.parametrize(
    ("name", "label", "kinds"),
    [
        ("planar_2r", "one solution", ["incomplete", "proved"]),
        ("planar_2r", "Results A, x", ["proved", "refuted"]),  # cut, rounded
        ("planar_2r", "Results A, y", ["proved", "proved"]),
        ("planar_2r", "Results B, x", ["refuted", "refuted"]),  # rounded, cut
        ("planar_2r", "use of eqs. (3) and (4)", ["incomplete", "refuted"]),
        ("spherical_wrist", "eq. (13)", ["incomplete", "refuted"]),
        ("spherical_wrist", "same matrix", ["refuted", "proved"]),
    ],
)
def test_readings(name: str, label: str, kinds: list[str]) -> None:
    assert [reading.kind for reading in claimed.result(name, label).readings] == kinds
