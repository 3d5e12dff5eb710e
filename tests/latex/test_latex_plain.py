"""Functions as a reader computes them: the same results, in fewer lines."""

import sympy as sp

from closedform.emit.backends.latex.plain import angles_of_readers, is_rounding, plain
from closedform.lemmas.two_link import two_link_arm
from closedform.lemmas.two_sines import two_sines
from closedform.model.functions import Array, Bound, Function, Let, Program, Vanishes, choose, real

a, b, x, y = (real(name) for name in "abxy")
sigma = real("sigma")
GIVEN = {a: sp.Rational(3, 10), b: sp.Rational(4, 5), x: sp.Rational(1, 2), y: sp.Rational(7, 5)}


def function(program: Program, *outputs: sp.Expr) -> Function:
    array = Array("q", (len(outputs),), outputs)
    inputs = (Array("x", (4,), (a, b, x, y)),)
    return Function("f", "F.", inputs, (array,), body=tuple(program.body))


def names(f: Function) -> list[str]:
    return [str(s.symbol) for s in f.body if isinstance(s, Let)]


def same(f: Function, g: Function, signs: dict) -> None:
    for one, other in zip(f.values(signs), g.values(signs), strict=True):
        difference = sp.N((one - other).xreplace(GIVEN | signs), 30)
        assert abs(sp.sin(difference / 2)) < 1e-25


def test_an_arm_is_told_in_its_angles() -> None:
    program, unknowns = Program(), (real("theta"), real("theta_fore"))
    lengths = (sp.Integer(1), sp.Rational(3, 5), sp.Rational(1, 5))
    lemma = two_link_arm(program, lengths, (a, b), unknowns, sigma)
    f = function(program, *lemma.solution.values())
    g = plain(f, [lemma]).function
    values = {s.symbol: s.value for s in g.body if isinstance(s, Let)}
    theta, theta_fore = unknowns
    assert not {"ctheta", "stheta", "c_relative", "s_relative"} & {*names(g)}
    assert g.outputs[0].entries == unknowns and values[theta_fore].has(theta)
    assert not {"c_lag", "s_lag"} & {str(s) for s in values[theta_fore].free_symbols}
    for sign in (1, -1):
        same(f, g, {sigma: sp.Integer(sign)})


def test_what_differs_within_rounding_is_one() -> None:
    program = Program()
    near = program.let("near", a * b)
    limit = program.vanishes("limit", sp.Max(near, -near / 2**40), a, "no margin left")
    kept = program.let("kept", choose(limit, 0, near))
    f = function(program, kept + x)
    read = plain(f, [])
    assert is_rounding(next(s for s in f.body if isinstance(s, Vanishes)))
    assert names(read.function) == ["kept"] and read.names == {near: kept}
    same(f, read.function, {})


def test_a_special_case_is_kept() -> None:
    program = Program()
    radius = program.let("radius", sp.sqrt(a**2 + b**2))
    centre = program.vanishes("centre", radius, 1, "at the centre", free=(x,))
    f = function(program, choose(centre, 0, radius))
    assert plain(f, []).function == f


def test_cases_of_a_sign_are_absolute_values_and_quotients_tangents() -> None:
    program = Program()
    size = program.let("size", sp.Piecewise((a, a >= 0), (-a, True)))
    sign = sp.Piecewise((1, b >= 0), (-1, True))
    slope = program.let("slope", sp.sin(x) / sp.cos(x))
    f = function(program, size, program.let("far", b * sign), slope * y)
    g = plain(f, []).function
    assert [s.value for s in g.body if isinstance(s, Let)] == [sp.Abs(a), sp.Abs(b)]
    assert g.outputs[0].entries[2] == y * sp.tan(x)
    same(f, g, {})


def test_halves_of_sums_of_angles_have_letters() -> None:
    program = Program()
    half = (x + y) / 2
    f = function(program, program.let("r", a * sp.cos(half) + b), sp.sin(half))
    g = plain(f, [], ["alpha"]).function
    assert g.body[0] == Let(real("alpha"), half)
    assert g.outputs[0].entries[1] == sp.sin(real("alpha"))
    same(f, g, {})


def test_a_result_has_its_own_name() -> None:
    program = Program()
    length = program.let("length", sp.sqrt(a**2 + b**2))
    f = function(program, length, length + x)
    rho, z = real("rho"), real("z")
    g = plain(f, [], results=(rho, z)).function
    assert g.outputs[0].entries == (rho, rho + x)
    assert [s.symbol for s in g.body if isinstance(s, Let)] == [rho]


def test_two_sines_are_told_by_arcsines() -> None:
    program, unknowns = Program(), (real("delta_2"), real("delta_3"))
    earlier = program.bound("earlier", 1 - a**2, 1, "a sine is at most 1")
    vectors = ((sp.S.Zero, sp.Integer(2)), (sp.Rational(3, 2), b))
    lemma = two_sines(program, unknowns, vectors, (a, y / 8), scale=sp.S.One).implying([earlier])
    f = function(program, *lemma.solution.values())
    g = plain(f, [lemma]).function
    values = {s.symbol: s.value for s in g.body if isinstance(s, Let)}
    assert isinstance(values[unknowns[1]], sp.asin) and g.outputs[0].entries == unknowns
    same(f, g, {})
    bounds = {s.symbol: s.value for s in g.body if isinstance(s, Bound)}
    assert bounds[earlier] == 1 and sum(not e.is_number for e in bounds.values()) == 2
    too_far = next(e for e in bounds.values() if e.has(sp.Abs(a))).xreplace({a: sp.Integer(2)})
    assert sp.fraction(sp.together(too_far))[0] < 0  # the sine would be 4/3


def test_the_triangle_of_an_arm_is_told_by_its_angle() -> None:
    program, unknowns = Program(), (real("theta"), real("theta_fore"))
    lemma = two_link_arm(program, (sp.Integer(1), a, b), (x, y), unknowns, sigma)
    f = function(program, *lemma.solution.values())
    g = plain(f, [lemma]).function
    (bend,) = angles_of_readers(lemma)
    values = {s.symbol: s.value for s in g.body if isinstance(s, Let)}
    assert values[bend].has(sigma)
    for angle in unknowns:
        assert bend in values[angle].free_symbols and sigma not in values[angle].free_symbols


def test_a_joint_is_told_in_the_angles_of_the_lemmas() -> None:
    program, unknowns = Program(), (real("theta"), real("theta_fore"))
    lengths = (sp.Integer(1), sp.Rational(3, 5), sp.Rational(1, 5))
    lemma = two_link_arm(program, lengths, (a, b), unknowns, sigma)
    first, absolute = lemma.solution.values()
    f = function(program, first, absolute - first)
    results = (real("q_1"), real("q_2"))
    joints = {results[0]: unknowns[0], results[1]: unknowns[1] - unknowns[0]}
    g = plain(f, [lemma], results=results, joints=joints).function
    assert g.outputs[0].entries == (results[0], unknowns[1] - results[0])
    for sign in (1, -1):
        same(f, g, {sigma: sp.Integer(sign)})
