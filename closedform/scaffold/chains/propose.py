"""Proposes the chain of lemmas for arms of known structure, as the lines that you would write.

Known structures come first (``known.py``), then chains of subproblems for axes of any direction:
wrists and shoulders (``subproblems.py``), six joints without one (``six.py``), joints that
slide (``slides.py``).  You accept or edit the lines, and the proof decides.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cache, partial
from typing import Any, NamedTuple

from closedform.mechanics.arm import Serial
from closedform.model.names import listed
from closedform.scaffold.chains.among_turns import AmongTurnsMaker
from closedform.scaffold.chains.arm_angle import NAME as ARM_ANGLE
from closedform.scaffold.chains.arm_angle import ArmAngleMaker
from closedform.scaffold.chains.chainlinks import Single, Singles, parallel, singles
from closedform.scaffold.chains.coupled_turns import CoupledMaker
from closedform.scaffold.chains.decoupled import DecoupledMaker
from closedform.scaffold.chains.degree import (
    Solutions,
    free_joints,
    free_ways,
    is_regular,
    solutions,
    solutions_of_few,
    stays_regular,
)
from closedform.scaffold.chains.in_the_middle import MiddleMaker
from closedform.scaffold.chains.known import KnownMaker
from closedform.scaffold.chains.maker import Maker
from closedform.scaffold.chains.on_a_rail import RailMaker
from closedform.scaffold.chains.one_direction import OneDirectionMaker
from closedform.scaffold.chains.proposal import NoChainError, Proposal, Tried
from closedform.scaffold.chains.six import SixMaker
from closedform.scaffold.chains.subproblems import SubproblemMaker
from closedform.scaffold.chains.two_slides import TwoSlidesMaker
from closedform.scaffold.source import GIVEN


def propose(
    arm: Serial,
    given: str = "",
    progress: Callable[[str], None] = lambda _: None,
    refused: Sequence[Tried] = (),
    *,
    count: bool = True,
) -> Proposal:
    """The first chain for an arm that is not ``refused``; :class:`NoChainError` if none is known.

    Of an arm of seven joints one is ``given``, by default one that makes the chain short, or
    ``arm_angle``.  With ``count`` the error says how many solutions a pose has.
    """
    _require_few(arm)
    tried: list[Tried] = [*refused]
    never = {t.name for t in refused}
    names = {ARM_ANGLE, *(j.name for j in arm.joints)}
    if given and (len(arm.joints) != 7 or given not in names):
        raise NoChainError(
            f"{given} cannot be given",
            "Of an arm of seven joints one can be given, by its name in the table, or arm_angle.",
        )
    for degree in (2, 4):
        left = {t.name for t in tried if t.error.degree == degree}
        if degree > 2 and not left:
            break
        for name, maker, write in _candidates(arm, given):
            if name in never or (degree > 2 and name not in left):
                continue
            progress(f"trying {name}")
            maker.degree = degree
            try:
                found = write()
            except NoChainError as error:
                tried = [*(t for t in tried if t.name != name), Tried(name, error)]
                continue
            tried = [t for t in tried if t.name != name]
            lemmas = tuple(dict.fromkeys(maker.used))
            return Proposal(
                name=name,
                structure=found,
                lines=tuple(maker.lines),
                lemmas=lemmas,
                branches=maker.branches,
                tried=tuple(tried),
                doubt=_doubt_of_given(arm, found),
            )
    if refused or arm.coupling or not count:
        raise tried[0].error.after(tried)
    raise _refusal(arm, given, tried, progress)


def _require_few(arm: Serial) -> None:
    """Refuse an arm whose pose leaves more than one joint free."""
    names = [joint.name for joint in arm.joints]
    if (more := len(names) - 6) <= 1:
        return
    whole = singles(arm)
    if len(stages := _stages(whole)) >= more:
        raise _telescope(len(names), stages)
    raise NoChainError(
        f"it has {len(names)} joints, and a pose determines six; up to seven are solved, with "
        f"one of them given",
        f"Give values to {more - 1} of them, or to {more}: {_held(whole.joints[0])}  "
        f"Of such a file you may take the part between two links, with --base and --tool.  "
        f"Otherwise use a numeric inverse, such as that of Pinocchio.",
    )


def _stages(whole: Singles) -> list[Single]:
    """The most neighbouring slides with one direction, as the stages of a telescope."""
    most: list[Single] = []
    run: list[Single] = []
    for joint in whole.joints:
        if not joint.slides:
            run = []
            continue
        run = [*run, joint] if run and parallel(run[-1]) else [joint]
        most = max(most, run, key=len)
    return most


def _telescope(count: int, stages: Sequence[Single]) -> NoChainError:
    """Why an arm whose slides share a direction has no inverse, and what to do."""
    first, *others = (joint.joint.name for joint in stages)
    names = f"{', '.join((first, *others[:-1]))} and {others[-1]}"
    return NoChainError(
        f"of its {count} joints {names} slide in one direction, and a pose determines only how far "
        f"they move together",
        f"In a URDF or MJCF file, let the others mimic {first} if they move as the stages of a "
        f"telescope.  Or give values to all of them but one, with "
        f"{' '.join(f'--hold {name}' for name in others)} for such a file.",
    )


def _refusal(
    arm: Serial, given: str, tried: Sequence[Tried], progress: Callable[[str], None]
) -> NoChainError:
    """Why no chain is known, with the degree of what is left if that is known or can be counted."""
    n, whole = len(arm.joints), singles(arm)
    if n <= 6 and (free := free_joints(whole)):
        return _redundant(free).after(tried)
    if n == 7 and (ways := free_ways(whole))[0] > 1:
        return _redundant_of_seven(*ways).after(tried)
    error = next((t.error for t in tried if t.error.degree), tried[0].error)
    if n == 7 and given != ARM_ANGLE:
        single, *others = _to_give(whole, given)
        if others:
            single, error = _nearest(whole, (single, *others), tried)
        progress(f"counting the solutions with {single.joint} given")
        with_it = f"with {single.joint} given "
        error = _counted(error, solutions(whole.with_given(single.number, GIVEN)), with_it)
    elif n == 6 and not error.degree:
        progress("counting the solutions")
        error = _counted(_beside_slides(whole) or _without_three(error, whole), solutions(whole))
    elif n == 6 and not any(joint.slides for joint in whole.joints):
        error = NoChainError(error.found, _numeric(error.needed), error.degree)
    elif n < 6 and arm.coordinates() is None and not error.degree:
        progress("counting the solutions")
        error = _counted_few(error, solutions_of_few(whole))
    return error.after(tried)


def _nearest(
    whole: Singles, joints: Sequence[Single], tried: Sequence[Tried]
) -> tuple[Single, NoChainError]:
    """Which of seven joints to give to come nearest to a chain, and why it does not fit."""
    can = [j for j in joints if is_regular(whole.with_given(j.number, GIVEN))]
    other = "Choose another joint with --given to count its solutions."
    if 0 < len(can) < 3:
        names = " or ".join(str(j.joint) for j in can)
        other = f"Only {names} can be given: otherwise the rest does not move the tool in six ways."
    for single in can:
        given = GIVEN_JOINT.format(single.joint)
        error = next((t.error for t in tried if t.error.degree and t.name.endswith(given)), None)
        if error:
            found = f"with {single.joint} given, {error.found}"
            return single, NoChainError(found, _numeric(f"{error.needed}  {other}"), error.degree)
    return [*can, *joints][0], NoChainError(NEITHER, _numeric(other))


def _redundant(free: Sequence[Single]) -> NoChainError:
    """Why an arm has no inverse whose ``free`` joints can move while the tool stands still."""
    *others, last = (joint.joint.name for joint in free)
    names = f"joints {', '.join(others)} and {last}" if others else f"joint {last}"
    return NoChainError(
        f"at every posture its {names} can move while the tool stands still",
        f"Give a value to one of them: {_held(free[0])}",
    )


def _redundant_of_seven(count: int, free: Sequence[Single]) -> NoChainError:
    """The same of seven joints, of which no one that is given leaves the others determined."""
    *others, last = (joint.joint.name for joint in free)
    ways = {2: "two", 3: "three"}.get(count, str(count))
    return NoChainError(
        f"at every posture its joints {', '.join(others)} and {last} can move in {ways} ways while "
        f"the tool stands still",
        f"Give values to {ways} of them: {_held(free[0])}",
    )


def _held(single: Single) -> str:
    """How to give a value to a joint."""
    return (
        f"in a DH table, a line such as '# {single.joint} = 0.1 {'m' if single.slides else 'rad'}: "
        f"held' makes a joint a parameter, an input of all printed functions; for a URDF or MJCF "
        f"file --hold {single.joint} does so."
    )


ONE_WAY = " that turn about one direction"
GIVEN_JOINT = ", with {} given"
NUMERIC = "Use ssik for a numeric inverse."
NEITHER = (
    "none of its seven joints, if it is given, leaves a spherical wrist or shoulder, and two "
    "neighbours among the rest that are parallel or meet"
)


NO_THREE = NoChainError(
    "no three neighbouring axes meet in a point or are parallel",
    "Nearly all closed forms of six joints need three that meet in a point or are parallel.",
)


def _beside_slides(whole: Singles) -> NoChainError | None:
    """What to do with a slide beside three parallel axes; None if there is no such arm."""
    slides = [joint for joint in whole.joints if joint.slides]
    three = _three_parallel(whole)
    if len(slides) != 1 or not three:
        return None
    (slide,) = slides
    numbers = [f"{joint.number}" for joint in three]
    return NoChainError(
        f"axes {listed(numbers)} are parallel, and joint {slide.number} beside them slides",
        f"The known chains of three parallel axes have no slide beside them.  If {slide.joint} may "
        f"be an input, hold it, and the other five joints may have an inverse: {_held(slide)}",
    )


def _three_parallel(whole: Singles) -> tuple[Single, ...]:
    """The first three neighbours that turn about parallel axes; none if there are no such."""
    for k in range(len(whole.joints) - 2):
        three = whole.joints[k : k + 3]
        if not any(j.slides for j in three) and all(map(parallel, three[:2])):
            return three
    return ()


def _without_three(error: NoChainError, whole: Singles) -> NoChainError:
    """The error, or another one if no three neighbouring axes meet in a point or are parallel."""
    views, starts = [whole], list(range(len(whole.joints) - 2))
    if any(joint.slides for joint in whole.joints):  # which may change places
        views, starts = [v for o in whole.orders() for v in (o, o.reversed())], [3]
    three = _three_parallel(whole) or any(v.met(k, 3) is not None for v in views for k in starts)
    return error if three else NO_THREE


def _counted(error: NoChainError, counted: Solutions | None, given: str = "") -> NoChainError:
    """The error with the degree of the equations for a pose, if their solutions were counted."""
    needed = _numeric(error.needed)
    if counted is None:
        return NoChainError(error.found, needed)
    *few, last = (str(n) for n in reversed(counted.steps))
    degrees = f"equations of degree {', '.join(few)} and {last}" if few else "one equation"
    told = (
        f"Two numerical counts agree that {given}a pose has {counted.number} solutions in complex "
        f"numbers, at least, which {degrees} {'give' if few else 'gives'}"
    )
    if counted.solvable:
        return NoChainError(
            error.found, f"{told}; so a chain of your own may solve them.  {needed}"
        )
    found = f"{error.found}, and {given}there is no closed form: degree {counted.degree}"
    return NoChainError(found, f"{told}; roots do not solve them.  {needed}", counted.degree)


def _numeric(needed: str) -> str:
    """What to do, with the advice to use a numeric inverse, once."""
    return needed if NUMERIC in needed else f"{needed}  {NUMERIC}"


def _counted_few(error: NoChainError, number: int | None) -> NoChainError:
    """The same for fewer than six joints, whose poses have a few solutions."""
    needed = f"{error.needed}  Otherwise use a numeric inverse, such as that of Pinocchio."
    if number is None or number > 4:
        return NoChainError(error.found, needed)
    some, degree = "1 solution", "1 give it"
    if number > 1:
        some, degree = f"{number} solutions", f"{number} or less give them"
    told = (
        f"Two numerical counts agree that a pose of the arm has {some} in complex numbers, at "
        f"least.  Equations of degree {degree}, so a chain of your own may do so."
    )
    return NoChainError(error.found, f"{told}  {needed}", number)


_Solve = Callable[[Any, Singles], str]
"""A method of a maker that solves an arm, and says what was recognised."""


class _Candidate(NamedTuple):
    """A chain to try: ``write`` lets the maker write its lines, and says what was recognised."""

    name: str
    maker: Maker
    write: Callable[[], str]


def _candidates(arm: Serial, given: str) -> Iterator[_Candidate]:
    """The chains to try, the cheapest first."""
    n, task = len(arm.joints), arm.coordinates()
    if arm.coupling:
        coupled = CoupledMaker(arm)
        yield _Candidate("joints that follow others", coupled, coupled.coupled)
        return
    if task is not None or n == 6:
        known = KnownMaker(arm)
        yield _Candidate("a known structure", known, known.whole)
    whole = singles(arm)
    if n == 7:
        yield from _seven(arm, whole, given)
    elif n == 6:
        yield from _six(arm, whole)
    elif task is not None:
        yield from _with_coordinates(arm, whole, task.names)
    else:
        yield from _fewer_than_six(arm, whole)
    if task is None and n <= 6 and any(joint.slides for joint in whole.joints):
        for seen, view in (("", whole), (", from the tool", whole.reversed())):
            decoupled = DecoupledMaker(arm)
            write = partial(decoupled.decoupled, view)
            yield _Candidate(f"slides apart from turns{seen}", decoupled, write)
        if n < 6:
            yield from _slides_among_turns(arm, whole)


def _slides_among_turns(arm: Serial, whole: Singles) -> Iterator[_Candidate]:
    for order in whole.orders():
        moved = _moved(order, whole)
        among = AmongTurnsMaker(arm)
        yield _Candidate(f"slides among turns{moved}", among, partial(among.among_turns, order))
        for view, seen in ((order, ""), (order.reversed(), ", from the tool")):
            plane = AmongTurnsMaker(arm)
            name = f"a turn between slides{seen}{moved}"
            yield _Candidate(name, plane, partial(plane.in_a_plane, view))


def _seven(arm: Serial, whole: Singles, given: str) -> Iterator[_Candidate]:
    """An arm of seven joints, with the arm angle or one of them given."""
    if given == ARM_ANGLE:
        maker = ArmAngleMaker(arm)
        yield _Candidate("the arm angle", maker, partial(maker.solved_by_arm_angle, whole))
        return
    for single in _to_give(whole, given):
        yield from _six(arm, whole, single)


def _to_give(whole: Singles, given: str = "") -> Iterator[Single]:
    """The joints of seven that may be ``given``: slides, then those that most arms repeat.

    Those that leave a singular arm at some of their values, as a straight elbow may, are last.
    """
    joints = sorted((whole.joints[k] for k in (2, 6, 4, 0, 3, 1, 5)), key=lambda j: not j.slides)
    last = []
    for single in (j for j in joints if given in ("", j.joint.name)):
        if given or single.slides or stays_regular(whole, single):
            yield single
        else:
            last.append(single)
    yield from last


def _doubt_of_given(arm: Serial, structure: str) -> str:
    """What to know of the joint that is given, if it leaves a singular arm at some values."""
    whole = singles(arm)
    given = next((j for j in whole.joints if structure.endswith(GIVEN_JOINT.format(j.joint))), None)
    if given is None or given.slides or stays_regular(whole, given):
        return ""
    return (
        f"At some values of {given.joint} the other joints move the tool in less than six ways at "
        f"every posture; near these values solutions may be lost.  Choose another joint "
        f"with --given, if there is one."
    )


def _moved(order: Singles, whole: Singles) -> str:
    """The order of the joints, in words, if it is not the one in which they follow each other."""
    return "" if order is whole else f", in the order {', '.join(map(str, order.numbers))}"


def _with_coordinates(arm: Serial, whole: Singles, names: tuple[str, ...]) -> Iterator[_Candidate]:
    """Three joints for a point, and another one for its yaw."""
    ways = {
        ("x", "y", "z"): ("three joints for a point", SubproblemMaker.solved_point),
        ("x", "y", "z", "yaw"): ("three joints and a level tool", SubproblemMaker.solved_level),
    }
    if names not in ways:
        return
    name, solve = ways[names]
    for order in whole.orders():
        met = _met(order, ((0, 2), (1, 2)))
        maker = SubproblemMaker(arm)
        yield _Candidate(f"{name}{_moved(order, whole)}", maker, partial(solve, maker, met))


def _fewer_than_six(arm: Serial, whole: Singles) -> Iterator[_Candidate]:
    """Up to three joints before or after others whose axes meet."""
    n = len(arm.joints)
    for order in whole.orders():
        moved = _moved(order, whole)
        ends = (("last", order, (3, 2, 1)), ("first", order.reversed(), (3, 2)))
        for which, view, counts in ends:
            for wrist in (w for w in counts if 0 <= n - w <= 3):
                maker = SubproblemMaker(arm)
                name = f"the {which} {wrist} of {n} joints{moved}"
                yield _Candidate(name, maker, partial(_fewer, maker, view, wrist))
    if n == 5 and not any(joint.slides for joint in whole.joints):
        maker = SubproblemMaker(arm)
        write = partial(maker.solved_in_plane, _met(whole, ((3, 2),)))
        yield _Candidate("three parallel joints", maker, write)
    if n == 5:
        yield from _five_in_one_direction(arm, whole)


def _five_in_one_direction(arm: Serial, whole: Singles) -> Iterator[_Candidate]:
    for order in whole.orders():
        moved = _moved(order, whole)
        for view, seen in ((order, ""), (order.reversed(), ", from the tool")):
            for which, solve in OF_FIVE:
                maker = OneDirectionMaker(arm)
                yield _Candidate(
                    f"{which}{ONE_WAY}{seen}{moved}", maker, partial(solve, maker, view)
                )
            slides = TwoSlidesMaker(arm)
            write = partial(slides.two_slides, view)
            yield _Candidate(f"a turret and two slides{seen}{moved}", slides, write)


def _met(whole: Singles, pairs: Sequence[tuple[int, int]]) -> Singles:
    """The arm with the origins of those neighbours that meet moved to where they do."""
    for first, count in pairs:
        whole = whole.met(first, count) or whole
    return whole


def _fewer(maker: SubproblemMaker, whole: Singles, wrist: int) -> str:
    start = len(whole.joints) - wrist
    found = whole.met(start, wrist)
    if found is None:
        which = "first" if whole.inverted else "last"
        raise NoChainError(
            f"its {which} {wrist} axes do not meet in a point",
            "The known chains have up to three joints before those whose axes meet in a point.",
        )
    structure = maker.solved(_met(found, [(k, 2) for k in range(start - 1)]), wrist)
    joints = f"{wrist} joints that turn" if wrist > 1 else "1 joint that turns"
    return f"{structure}, and {joints} the tool"


def _six(arm: Serial, whole: Singles, given: Single | None = None) -> Iterator[_Candidate]:
    """An arm of six joints that are not given, from its base and from its tool."""
    left = whole if given is None else whole.with_given(given.number, GIVEN)
    more = "" if given is None else GIVEN_JOINT.format(given.joint)
    regular = cache(partial(is_regular, left))

    def candidate(name: str, maker: SubproblemMaker, solve: _Solve, view: Singles) -> _Candidate:
        def write() -> str:
            if given is not None:
                maker.require(
                    regular(),
                    f"with {given.joint} given, the other joints do not move the tool in six ways",
                    "Give another joint.",
                )
                maker.give(given)
            return solve(maker, view) + more

        return _Candidate(f"{name}{more}", maker, write)

    for order in left.orders():
        moved = _moved(order, left)
        for view, wrist in ((order, "spherical wrist"), (order.reversed(), "spherical shoulder")):
            yield candidate(f"{wrist}{moved}", SubproblemMaker(arm), _with_wrist, view)
    for name, solve in WITH_SLIDES if any(joint.slides for joint in left.joints) else TURNING:
        for order in left.orders():
            for view, seen in ((order, ""), (order.reversed(), ", from the tool")):
                shown = f"{name}{seen}{_moved(order, left)}"
                yield candidate(shown, RailMaker(arm), solve, view)


TURNING: tuple[tuple[str, _Solve], ...] = (
    ("three parallel axes in the middle", SixMaker.parallel_middle),
    ("three parallel axes at the end", SixMaker.parallel_first),
    ("three axes in the middle that meet", SixMaker.meeting_middle),
)
OF_FIVE: tuple[tuple[str, _Solve], ...] = (
    ("three joints", partial(OneDirectionMaker.in_one_direction, count=3)),
    ("four joints", partial(OneDirectionMaker.in_one_direction, count=4)),
    ("three joints in the middle", OneDirectionMaker.in_one_direction_of_five),
)
WITH_SLIDES: tuple[tuple[str, _Solve], ...] = (
    (f"four joints{ONE_WAY}", partial(OneDirectionMaker.in_one_direction, count=4)),
    (f"three joints in the middle{ONE_WAY}", OneDirectionMaker.in_one_direction_between),
    (f"four joints in the middle{ONE_WAY}", MiddleMaker.in_the_middle),
    ("an arm of five joints on a rail", RailMaker.on_a_rail),
    (
        "slides and turns of one plane in the middle",
        partial(OneDirectionMaker.with_slides, start=1),
    ),
    (
        "slides and turns of one plane at the end",
        partial(OneDirectionMaker.with_slides, start=0),
    ),
)
"""Chains of six joints that have no wrist and no shoulder, from the base and from the tool."""


def _with_wrist(maker: SubproblemMaker, whole: Singles) -> str:
    ends = [s.number for s in whole.joints[3:]]
    found = whole.met(3, 3)
    if found is None:
        raise NoChainError(
            f"axes {ends[0]}, {ends[1]} and {ends[2]} do not meet in a point",
            "A spherical wrist or shoulder needs three axes that meet.",
        )
    structure = maker.solved(_met(found, ((0, 2), (1, 2))), 3)
    return f"spherical {'shoulder' if whole.inverted else 'wrist'}, {structure}"


__all__ = ["NoChainError", "Proposal", "propose"]
