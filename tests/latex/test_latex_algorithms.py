"""Algorithms as the articles print them, computed with the numbers of a posture."""

import importlib
from collections.abc import Mapping, Sequence

import mpmath
import numpy as np
import pytest
import sympy as sp

from closedform.emit.backends.latex.plain import plain
from closedform.emit.backends.latex.subject import Subject
from closedform.model.expressions import substitute
from closedform.model.functions import Bound, Function, Let, Vanishes
from closedform.pipeline import scripts

DIGITS = 40
LETTERS = ("chi", "omega", "nu", "mu")
MECHANISMS = (
    "franka_arm",
    "h6ar",
    "h6ar_loop_closed",
    "hybrid_five_bar",
    "irb260",
    "spherical_wrist",
    "ur_arm",
)


def computed(
    function: Function, given: Mapping[sp.Basic, sp.Basic], results: Sequence[sp.Symbol] = ()
) -> list[sp.Expr] | None:
    """The outputs in a usual posture, statement by statement; None if a bound is negative.

    An output may be in terms of ``results`` before it.
    """
    usual = {s.symbol: sp.false for s in function.body if isinstance(s, Vanishes)}
    made = [s for s in function.body if isinstance(s, Let | Bound)]
    values = {s.symbol: substitute(s.value, usual) for s in made}
    outputs = [substitute(e, usual) for a in function.outputs for e in a.entries]
    needed = {s for e in outputs for s in e.free_symbols}
    for symbol, value in reversed(values.items()):
        if symbol in needed:
            needed |= value.free_symbols
    env = dict(given)
    for s in made:
        if s.symbol in needed:
            env[s.symbol] = values[s.symbol].xreplace(env).evalf(DIGITS)
            if isinstance(s, Bound) and env[s.symbol] < 0:
                return None
    found = []
    for k, e in enumerate(outputs):
        found.append(e.xreplace(env).evalf(DIGITS))
        env |= {result: found[-1] for result in results[k : k + 1] if result not in env}
    return found


@pytest.mark.parametrize("name", MECHANISMS)
def test_an_algorithm_gives_what_the_function_gives(name: str) -> None:
    (source,) = scripts.find([name])
    d = scripts.load(source)
    module = importlib.import_module(f"closedform.generated.numpy.{name}")
    drawn = np.random.default_rng(3).uniform(-1, 1, (2000, len(module.JOINTS)))
    image = module.fk(drawn)
    targets = image.p[:, 0] if hasattr(image, "p") else image.reshape(len(drawn), -1)
    some = np.isfinite(targets).all(-1).argmax()
    q, target = drawn[some], targets[some]
    lengths = dict(zip([p.symbol for p in d.parameters], module.Parameters(), strict=True))
    compared = 0
    for function in d.functions:
        subject = Subject.of(d, function)
        lemmas = subject.lemmas
        first, *more = [a.entries for a in function.inputs] or [()]
        values = target if function.name == "ik" else q
        if not lemmas or len(first) != len(values):
            continue
        inputs = dict(zip(first, values, strict=True)) | {e: q[-1] for m in more for e in m}
        given = {s: sp.Float(float(v), DIGITS) for s, v in (lengths | inputs).items()}
        results = subject.inverse.unknowns if subject.inverse else ()
        read = plain(function, lemmas, LETTERS, results=results).function
        for _, signs in function.cases():
            here = given | {s: sp.Integer(k) for s, k in signs.items()}
            exact, read_off = computed(function, here), computed(read, here, results)
            assert (exact is None) == (read_off is None)
            for one, other in zip(exact or (), read_off or (), strict=True):
                with mpmath.workdps(DIGITS):
                    half = mpmath.mpf(str(sp.N(one - other, DIGITS))) / 2  # angles: up to a turn
                    assert abs(mpmath.sin(half)) < 1e-30, (function.name, signs)
                compared += 1
    assert compared > 5
