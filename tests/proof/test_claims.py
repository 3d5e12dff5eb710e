"""What is printed is what is judged: verdicts, readings, corrections and errata."""

from typing import Any

import pytest
import sympy as sp

from closedform.model.claims import (
    FAULTS,
    HOLDS,
    NOT_DECIDABLE,
    PROVED,
    PROVED_UNDER,
    REFUTED,
    VERDICTS,
    Check,
    Claim,
    Erratum,
    Gravity,
    Reading,
    plain,
)
from closedform.model.derivation import Derivation, Paper
from closedform.model.functions import real
from closedform.model.notation import Notation, NotationError
from closedform.proof.checks.equations import Identity, Under
from closedform.proof.checks.statements import Enumeration, Undecidable
from closedform.proof.claims import as_printed, erratum_result, judge, judged, require_shown
from closedform.proof.prove import Proof, prove
from closedform.proof.require import ProofError

x, y = real("x"), real("y")
NAMES = Notation({"x": x, "y": y})
SIGN = Erratum("sign", "A sign is wrong", Gravity.MOTION, "Why.", "Use.")


def claim(printed: str, check: Any = None, **more: Any) -> Claim:
    return Claim("eq. (1)", printed, check, notation=NAMES, **more)


def edges(n: int) -> Check:
    return Enumeration(n, lambda: 4, "edges")


class TestVerdict:
    def test_it_follows_from_the_printed_text_alone(self) -> None:
        wrong, right = r"$(x - y)^2 = x^2 + y^2$", r"$(x - y)^2 = x^2 - 2xy + y^2$"
        assert judged(claim(wrong), wrong).kind == REFUTED
        assert judged(claim(wrong), right).kind == PROVED

    def test_all_formulas_of_a_text_are_judged(self) -> None:
        assert judge(claim("$x = x$, and $y = y$"), []).kind == PROVED
        assert judge(claim("$x = x$, and $x = y$", erratum="sign"), [SIGN]).kind == REFUTED

    def test_a_check_takes_formulas_and_phrases_in_their_order(self) -> None:
        taken: list[Any] = []

        def check(*pieces: Any) -> Check:
            taken.extend(pieces)
            return Undecidable("it only looks")

        judge(claim("{Four} edges, $x = y$ and {no} face; $x = 1, y = 2$", check), [])
        number, one, none, two = taken
        assert (number, none) == (4, 0)
        assert one.sides == (x, y)
        assert [r.sides for r in two] == [(x, 1), (y, 2)]

    def test_a_formula_that_cannot_be_read_is_refused(self) -> None:
        with pytest.raises(NotationError, match="no such name"):
            judge(claim("$z = x$"), [])

    def test_the_evidence_is_in_the_notation_of_the_paper(self) -> None:
        names = Notation({r"\hat x": x, r"\hat y": y})
        wrong = Claim("a", r"$\hat x = \hat y$", notation=names, erratum="sign")
        assert judge(wrong, [SIGN]).evidence == (
            r"at $\hat x = 1$, $\hat y = 0$: $\hat x$ is $1$, but $\hat y$ is $0$"
        )

    def test_a_check_is_made_from_the_text(self) -> None:
        with pytest.raises(TypeError, match=r"claim eq. \(1\): the check must be a function"):
            claim("{four} edges", edges(4))

    def test_faults_and_what_holds_are_verdicts(self) -> None:
        assert {*FAULTS, *HOLDS, NOT_DECIDABLE} == set(VERDICTS)
        assert not set(FAULTS) & set(HOLDS)


class TestPhrases:
    def test_number_words_are_known(self) -> None:
        assert judge(claim("it has {Four} edges", edges), []).kind == PROVED
        assert judge(claim("it has {five} edges", edges, erratum="sign"), [SIGN]).kind == REFUTED

    def test_other_phrases_are_given(self) -> None:
        where = [{"at the base": x, "at the hand": y}]
        printed = "the axis is {at the base}"
        given = claim(printed, lambda at: Identity(at, x), phrases=where)
        assert judge(given, []).kind == PROVED
        assert judged(given, "the axis is {at the hand}").kind == REFUTED

    def test_an_unknown_phrase_is_refused(self) -> None:
        with pytest.raises(ValueError, match=r"claim eq. \(1\): the phrase 'many' has no meaning"):
            judge(claim("it has {many} edges", edges), [])

    def test_a_word_turns_a_statement_into_its_opposite(self) -> None:
        words = {"always": "not always", "every": "not every"}
        given = claim("$x = y$ {always} holds for {every} x", opposites=words)
        right = given.printed.replace("= y", "= x")
        assert judged(given, given.printed).kind == REFUTED
        assert judged(given, given.printed.replace("{alw", "{not alw")).kind == PROVED
        assert judged(given, right).kind == PROVED
        assert judged(given, right.replace("{every", "{not every")).kind == REFUTED
        both = right.replace("{every", "{not every").replace("{alw", "{not alw")
        assert judged(given, both).kind == PROVED

    def test_the_opposite_of_what_cannot_be_decided_cannot_either(self) -> None:
        given = claim("{not} here", lambda: Undecidable("a figure"), opposites={"not": "also"})
        assert judged(given, "{also} here").kind == NOT_DECIDABLE

    def test_the_text_has_no_braces(self) -> None:
        assert plain("{two} of $x_{1}$") == "two of $x_{1}$"
        assert judge(claim("it has {four} edges", edges), []).printed == "it has four edges"


class TestCorrection:
    def test_it_is_proved_by_the_check_that_refuted(self) -> None:
        found = judge(
            claim("it has {five} edges", edges, corrected="it has {four} edges", erratum="sign"),
            [SIGN],
        )
        assert (found.kind, found.corrected) == (REFUTED, "it has four edges")

    def test_one_that_does_not_hold_is_refused(self) -> None:
        wrong = claim("$x = y$", corrected="$x = 2x$", erratum="sign")
        with pytest.raises(ProofError, match=r"the correction is refuted: \$x = 2x\$"):
            judge(wrong, [SIGN])

    def test_what_holds_needs_none(self) -> None:
        with pytest.raises(ProofError, match="needs no correction"):
            judge(claim("$x = x$", corrected="$y = y$"), [])


class TestErratum:
    def test_a_fault_without_one_is_refused_with_its_evidence(self) -> None:
        with pytest.raises(ProofError, match=r"is refuted \(at \$x = 1\$.* name the erratum"):
            judge(claim("$x = y$"), [])

    def test_an_unknown_key_is_refused(self) -> None:
        with pytest.raises(ProofError, match=r"no erratum 'other'; there are \['sign'\]"):
            judge(claim("$x = y$", erratum="other"), [SIGN])

    @pytest.mark.parametrize(
        "check",
        [lambda f: as_printed(f), lambda _: Undecidable("a figure")],
        ids=["proved", "not decidable"],
    )
    def test_one_on_a_claim_without_a_fault_is_refused(self, check: Any) -> None:
        with pytest.raises(ProofError, match="but the claim names the erratum sign"):
            judge(claim("$x = x$", check, erratum="sign"), [SIGN])

    def test_an_assumption_may_be_one(self) -> None:
        assumed = claim("$x = x$", lambda f: Under(as_printed(f), "it moves"), erratum="sign")
        assert judge(assumed, [SIGN]).kind == PROVED_UNDER

    def test_one_that_no_claim_shows_is_refused(self) -> None:
        results = [judge(claim("$x = y$", erratum="sign"), [SIGN])]
        require_shown([SIGN], results)
        with pytest.raises(ProofError, match="no claim shows the erratum sign: A sign is wrong"):
            require_shown([SIGN], [])

    def test_a_number_in_its_texts_is_computed(self) -> None:
        numbers = {"miss": (sp.sqrt(2) / 10, 3), "turn": (-sp.pi, 0)}
        told = Erratum(
            key="a",
            title="A sign",
            gravity=Gravity.MOTION,
            why="By [turn].",
            use="$[miss]$ m.",
            numbers=numbers,
        )
        found = erratum_result(told)
        assert (found.why, found.use) == ("By -3.", "$0.141$ m.")

    def test_a_number_without_a_place_is_refused(self) -> None:
        with pytest.raises(ValueError, match=r"no text contains the number \[miss\]"):
            Erratum(
                key="a",
                title="A sign",
                gravity=Gravity.MOTION,
                why="Why.",
                use="Use.",
                numbers={"miss": (sp.S.One, 1)},
            )

    def test_a_number_has_to_be_a_constant(self) -> None:
        told = Erratum(
            key="a",
            title="A sign",
            gravity=Gravity.MOTION,
            why="[miss]",
            use="Use.",
            numbers={"miss": (x, 1)},
        )
        with pytest.raises(ValueError, match="x is not a constant"):
            erratum_result(told)

    def test_a_key_is_described_once(self) -> None:
        d = Derivation("arm", "Arm", Paper("p", "P", ("A",)), "It moves.")
        d.erratum("sign", "A sign", Gravity.MOTION, why="Why.", use="Use.")
        with pytest.raises(ValueError, match="arm: the erratum sign is described twice"):
            d.erratum("sign", "A sign", Gravity.MOTION, why="Why.", use="Use.")


class TestReadings:
    complex_numbers = Reading("complex solutions count", lambda n: Enumeration(n, lambda: 2, "all"))
    real_numbers = Reading("real solutions count", lambda n: Enumeration(n, lambda: 0, "real"))

    def test_the_first_gives_the_verdict(self) -> None:
        charitable = claim("{two} roots", readings=(self.complex_numbers, self.real_numbers))
        found = judge(charitable, [])
        assert found.kind == PROVED
        assert [(r.text, r.kind) for r in found.readings] == [
            ("complex solutions count", PROVED),
            ("real solutions count", REFUTED),
        ]
        strict = claim(
            "{two} roots", readings=(self.real_numbers, self.complex_numbers), erratum="sign"
        )
        assert judge(strict, [SIGN]).kind == REFUTED

    def test_the_correction_is_read_in_the_same_way(self) -> None:
        strict = claim(
            "{two} roots", corrected="{no} roots", erratum="sign",
            readings=(self.real_numbers, self.complex_numbers),
        )  # fmt: skip
        assert judge(strict, [SIGN]).corrected == "no roots"

    def test_a_reading_may_give_names_another_meaning(self) -> None:
        both = (Reading("x is y", means={"x": y}), Reading("x is free"))
        assert [r.kind for r in judge(claim("$x = y$", readings=both), []).readings] == [
            PROVED,
            REFUTED,
        ]


def wrong_arm() -> Derivation:
    d = Derivation("arm", "Arm", Paper("p", "P", ("A",)), "It moves.")
    d.erratum("sign", "A sign", Gravity.MISPRINT, why="Why.", use="Use.")
    d.claim("eq. (1)", "$x = -x$", notation=NAMES, corrected="$x = x$", erratum="sign")
    return d


def test_a_proof_is_stored_and_read_again() -> None:
    d = wrong_arm()
    d.claim("a", "{two}", notation=NAMES, readings=[TestReadings.complex_numbers], paraphrase=True)
    proof = prove(d)
    assert proof.verdicts() == {PROVED: 1, REFUTED: 1}
    assert proof.errata == (erratum_result(d.errata[0]),)
    assert Proof.from_dict(proof.as_dict()) == proof


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.errata.clear(), r"arm, claim eq. \(1\): there is no erratum 'sign'"),
        (lambda d: d.claims.clear(), "no claim shows the erratum sign"),
        (
            lambda d: d.claim("b", "$x = x$", lambda _: 1 / 0, notation=NAMES),
            "arm, claim b: ZeroDivisionError",
        ),
    ],
)
def test_a_fault_in_the_claims_is_one_clear_error(change: Any, message: str) -> None:
    d = wrong_arm()
    change(d)
    with pytest.raises(ProofError, match=message):
        prove(d)


def test_labels_are_unique_within_a_robot_and_texts_balanced() -> None:
    from closedform.derivations import planar_2r

    labels = [c.label for c in planar_2r.d.claims]
    assert len(set(labels)) == len(labels)
    assert all(c.where and c.printed.count("$") % 2 == 0 for c in planar_2r.d.claims)
