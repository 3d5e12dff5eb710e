"""Operations that repeat, as the lanes of vectors: what is packed, and in which order."""

import importlib

import numpy as np
import pytest
from closedform.generated.c import delta as compiled

from closedform.emit.backends.c.guards import given_up_where
from closedform.emit.backends.c.lanes import LanesPrinter, packed
from closedform.emit.backends.c.packs import Packing
from closedform.lower import Lowered, lower
from closedform.lower.operators import LEAVES


def program(robot: str, function: str) -> Lowered:
    d = importlib.import_module(f"closedform.derivations.{robot}").d
    return lower(d[function], d)


@pytest.fixture(scope="module")
def delta() -> Packing:
    found = packed(program("delta", "ik"))
    assert found is not None
    return found


def test_every_operation_is_evaluated_once_after_its_operands(delta: Packing) -> None:
    done = {n.id for n in delta.nodes if n.op in LEAVES}
    for block in delta.blocks:
        for pack in block.packs:
            for node in pack.nodes:
                assert node.id not in done
                assert all(a.id in done for a in node.args)
            done |= {n.id for n in pack.nodes}
    assert done == {n.id for n in delta.nodes}


def test_a_quotient_comes_after_the_conditions_under_which_nothing_uses_it() -> None:
    """Its divisor may be zero there, so one call divides by 1 instead."""
    common = program("delta", "fk").common
    assert common is not None
    packing = Packing(common)
    order = [n.id for b in packing.blocks for p in b.packs for n in p.nodes]
    guarded = dict(given_up_where(packing.program))
    assert guarded
    for quotient, conditions in guarded.items():
        assert all(order.index(c.id) < order.index(quotient) for c in conditions)


def test_what_a_pack_takes_from_its_own_loop_is_in_its_own_lanes(delta: Packing) -> None:
    """Another lane may not be known yet."""
    for block in delta.blocks:
        if block.width == 1:
            continue
        here = {n.id for p in block.packs for n in p.nodes}
        made = {p.nodes for p in block.packs}
        columns = [c for p in block.packs for c in p.columns]
        assert all(c in made for c in columns if any(n.id in here for n in c))


def test_a_lane_has_the_operands_of_its_node(delta: Packing) -> None:
    for pack in delta.packs:
        rows = list(zip(*pack.columns, strict=True))
        for node, row in zip(pack.nodes, rows, strict=True):
            assert sorted(a.id for a in node.args) == sorted(a.id for a in row)
            commutes = node.op in ("add", "mul", "and", "or", "eq")
            assert commutes or node.args == row


def test_the_legs_of_a_delta_share_their_roots_and_quotients(delta: Packing) -> None:
    alone = [p.nodes[0] for b in delta.blocks if b.width == 1 for p in b.packs]
    slow = [n for n in alone if n.op in ("sqrt", "div", "atan2")]
    assert all(n.op == "div" and n.args[1].op == "const" for n in slow)
    assert sum(p.nodes[0].op == "sqrt" for p in delta.packs) == 3


def test_a_program_without_legs_stays_as_it_is() -> None:
    assert packed(program("planar_2r", "ik")) is None


def test_one_posture_has_the_statuses_of_a_batch() -> None:
    """Also at the boundary of the workspace, near parallel singularities and for NaN."""
    random = np.random.default_rng(3)
    x = random.uniform(-0.5, 0.5, (3000, 3))
    x[:500] = compiled.fk(random.uniform(-3, 3, (500, 3))).p[:, 0]
    x[500:700] = x[:200] * (1 + 10.0 ** random.uniform(-16, -10, (200, 1)))
    x[700] = np.nan
    q, status = compiled.ik(x)
    alone = [compiled.ik(p) for p in x]
    assert (np.array([s.status for s in alone]) == status).all()
    assert set(np.unique(status)) == {0, 1, 2, 3}
    np.testing.assert_allclose(np.array([s.q for s in alone]), q, rtol=0, atol=1e-12)


@pytest.mark.parametrize("function", ["ik", "skeleton"])
def test_an_answer_that_does_not_exist_is_selected_without_a_jump(function: str) -> None:
    """A jump between two loops over lanes would keep their vectors apart."""
    printer = LanesPrinter(Packing(program("delta", function)))
    printer.run()
    poisons = [line for line in printer.code if "cf_poison" in line]
    assert poisons
    assert all("cf_poison(0, " in line for line in poisons)
