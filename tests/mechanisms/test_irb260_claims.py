"""The claims about the palletiser: what is printed is judged, and the text decides the verdict."""

from collections.abc import Mapping

import claimed
import pytest
from claimed import result

from closedform.model.claims import (
    HOLDS,
    INCONSISTENT,
    NOT_DECIDABLE,
    PROVED,
    PROVED_UNDER,
    REFUTED,
    Claim,
)
from closedform.proof.claims import judged

FAULTY = {
    "Fig. 5": (INCONSISTENT, "figure-5"),
    "eq. (14)": (REFUTED, "dot-of-eq-14"),
    "eq. (19)": (REFUTED, "moved-twice"),
    "eq. (20)": (REFUTED, "moved-twice"),
    "hat in eq. (20)": (INCONSISTENT, "hat-under-ad"),
    "q_5, before eq. (23)": (INCONSISTENT, "two-points-q5"),
}
ASSUMED = {
    "equivalent, abstract": "assembly",
    "virtual constraint": "assembly",
    "checking the Jacobian": "initial-configuration",
}


@pytest.fixture(scope="module")
def claims() -> Mapping[str, Claim]:
    return claimed.claims("irb260")


@pytest.mark.parametrize(("label", "verdict"), FAULTY.items())
def test_faults_of_the_paper(label: str, verdict: tuple[str, str]) -> None:
    found = result("irb260", label)
    assert (found.kind, found.erratum) == verdict


@pytest.mark.parametrize("label", FAULTY)
def test_the_right_text_in_place_of_the_printed_one_is_proved(
    claims: Mapping[str, Claim], label: str
) -> None:
    assert judged(claims[label], claims[label].corrected).kind == PROVED


@pytest.mark.parametrize(("label", "erratum"), ASSUMED.items())
def test_omissions_are_assumptions(label: str, erratum: str) -> None:
    found = result("irb260", label)
    assert (found.kind, found.erratum) == (PROVED_UNDER, erratum)
    assert [r.kind for r in found.readings][1:] == [REFUTED]


@pytest.mark.parametrize("label", ["v, after eq. (7)", "eq. (10)"])
def test_what_the_paper_has_introduced_is_not_missing(label: str) -> None:
    """Section IV A speaks of revolute joints and unit axes before these equations."""
    found = result("irb260", label)
    assert [r.kind for r in found.readings] == [PROVED, REFUTED]
    assert not found.erratum


def test_all_errata_are_shown_and_only_these_claims_show_them(
    claims: Mapping[str, Claim],
) -> None:
    shown = {label: claim.erratum for label, claim in claims.items() if claim.erratum}
    assert {e.key for e in claimed.derivation("irb260").errata} == set(shown.values())
    others = set(shown) - set(FAULTY) - set(ASSUMED)
    assert {shown[label] for label in others} == {"assembly"}


@pytest.mark.parametrize(
    ("label", "printed", "wrong"),
    [
        ("eq. (5)", "l_2 + l_3 - l_5", "l_2 + l_3 + l_5"),
        ("eq. (2)", r"\\ l_1 \\ l_2", r"\\ l_2 \\ l_1"),
        ("eq. (9)", r"-\omega \times q", r"\omega \times q"),
        ("eq. (10)", r"(\omega \times v)", r"(v \times \omega)"),
        ("eq. (12)", r"e^{\hat{\xi}_4 \theta_4} e", r"e^{\hat{\xi}_1 \theta_1} e"),
        ("eq. (13)", r"-(l_1 + l_3 s", r"-(l_1 + l_3 c"),
        ("eq. (13)", r"\theta_4 = -(\theta_2", r"\theta_4 = (\theta_2"),
        ("eq. (15)", r"\sum_{i=1}^5", r"\sum_{i=1}^4"),
        ("eq. (16)", r"= \xi_i'", r"= \xi_i"),
        ("eq. (17)", r"- \hat{\xi}_4') \dot{\theta}_3", r"+ \hat{\xi}_4') \dot{\theta}_3"),
        ("eq. (18)", r"\xi_3' - \xi_4'", r"\xi_3' - \xi_2'"),
        ("eq. (21)", r"\hat{p}R \\ 0", r"R\hat{p} \\ 0"),
        ("virtual constraint", r"\theta_2 + \theta_3)", r"\theta_2 - \theta_3)"),
        ("four motors", "{four}", "{five}"),
        ("actuated joints", "{1, 2, 3, and 5}", "{1, 2, 3, and 4}"),
        ("zero-pitch screw", "{zero}", "{one}"),
        ("five revolute joints", "{revolute}", "{prismatic}"),
        ("ω_5", r"$\omega_5 = 0", r"$\omega_2 = 0"),
        ("parallel translation", "{only obtain the parallel translation}",
         "{also obtain a rotation}"),
    ],
)  # fmt: skip
def test_a_wrong_text_is_not_proved(
    claims: Mapping[str, Claim], label: str, printed: str, wrong: str
) -> None:
    claim = claims[label]
    assert printed in claim.printed
    assert result("irb260", label).kind in HOLDS
    assert judged(claim, claim.printed.replace(printed, wrong, 1)).kind not in HOLDS


@pytest.mark.parametrize(
    ("label", "kinds"),
    [
        ("the group se(3)", [PROVED, REFUTED]),
        ("eq. (6)", [PROVED, REFUTED]),
        ("eq. (23)", [PROVED, REFUTED]),
        ("not an open chain", [PROVED, REFUTED]),
        ("planar translation", [PROVED, REFUTED]),
        ("parallel translation", [PROVED, REFUTED]),
        ("valid technique", [PROVED_UNDER, NOT_DECIDABLE]),
    ],
)
def test_each_reading_is_judged_and_the_first_leads(label: str, kinds: list[str]) -> None:
    found = result("irb260", label)
    assert [r.kind for r in found.readings] == kinds
    assert found.kind == kinds[0]
