"""Arms with fewer than six joints where the lemmas lose digits that the whole target still has.

Beside a straight elbow, or with a slide that is nearly drawn in, the position of the wrist says
little of the joints that carry it.  The direction of the tool says more.
"""

from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import sympy as sp
from arms import OK, SINGULAR, UNREACHABLE, link
from chains import printed

from closedform.check.runners.python import module as runner
from closedform.emit.backend import Mechanism
from closedform.emit.backends import array
from closedform.lemmas import corrected, leeway
from closedform.model.derivation import Derivation
from closedform.pipeline import scripts
from closedform.pipeline.run import write
from closedform.proof.prove import Proof
from closedform.scaffold.new import new

QUARTER = np.pi / 2
# rows of a, alpha, d, theta; the slide is the joint d3
ROLLING = [(0, QUARTER, 0.1), (0.306, 0, 0), (0, QUARTER, 0), (0, -QUARTER, 0.3), (0, 0, 0.1)]
TELESCOPE = [(0, -QUARTER, 1.8), (0.1, QUARTER, 0), (0, 0, 0.4), (0, 0, None)]
POLAR = [(0, -QUARTER, 0.4), (0, QUARTER, 0.15), (0, 0, None), (0, 0, 0.1)]
NEAR = 10.0 ** np.arange(-9, -2.5, 0.5)


def arm(rows: list, folder: Path, code: Callable[[Derivation, Path], Any] = printed) -> ModuleType:
    said = {QUARTER: "pi/2", -QUARTER: "-pi/2"}
    lines = ["a, alpha, d, theta"]
    for k, (a, alpha, d) in enumerate(rows, 1):
        joint = (f"d{k}", "0") if d is None else (str(d), f"t{k}")
        lines.append(", ".join([str(a), said.get(alpha, "0"), *joint]))
    table = folder / "arm.csv"
    table.write_text("\n".join(lines), "utf-8")
    script = folder / "arm.py"
    script.write_text(new("arm", "dh", table).text, "utf-8")
    return code(scripts.load(scripts.find([str(script)])[0]), folder)


def printed_array(d: Derivation, folder: Path) -> Any:
    """The module that computes in the precision of its input."""
    pages = array.BACKEND.pages(Mechanism(d, Proof(d.name, "own", (), 0, ()))).files
    write(folder, {**pages, **array.BACKEND.shared([])})
    return runner(folder / "array", d.name)


def pose(rows: list, q: np.ndarray) -> np.ndarray:
    T = np.eye(4)
    for (a, alpha, d), value in zip(rows, np.moveaxis(q, -1, 0), strict=True):
        if d is None:
            shift = np.zeros((*np.shape(value), 4, 4))
            shift[..., 2, 3] = value
            T = T @ (np.eye(4) + shift)
        else:
            T = T @ link(a, alpha, d, value)
    return T


def postures(rows: list) -> np.ndarray:
    """At random, but the third joint is as near to where it says nothing as NEAR."""
    rng = np.random.default_rng(8)
    q = rng.uniform(-3, 3, (60, len(NEAR), len(rows)))
    slides = rows[2][2] is None
    near = NEAR[NEAR > 2e-5] if slides else NEAR
    q = q[:, : len(near)]
    q[..., 2] = (0 if slides else QUARTER) + near * rng.choice([-1, 1], q.shape[:2])
    return q


def lost_and_missed(module: ModuleType, rows: list, q: np.ndarray) -> tuple[int, float]:
    T = pose(rows, q)
    answers, status = module.ik(T)
    found = np.isin(status, (OK, SINGULAR))
    missed = np.abs(pose(rows, np.nan_to_num(answers)) - T[..., None, :, :])
    missed[..., :3, 3] /= sum(abs(a) + abs(d or 0) for a, _, d in rows)
    return int((~found.any(axis=-1)).sum()), float(missed[status == OK].max(initial=0))


@pytest.mark.parametrize("rows", [ROLLING, POLAR], ids=["straight elbow", "slide drawn in"])
def test_what_the_lemmas_lose_is_found_again(
    rows: list, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    q = postures(rows)
    lost, missed = lost_and_missed(arm(rows, tmp_path), rows, q)
    assert lost == 0 and missed <= 1e-12
    monkeypatch.setattr(corrected, "FAR", sp.S.Zero)
    monkeypatch.setattr(leeway, "SHORT", -sp.S.One)  # nor do the joints before the wrist follow it
    (tmp_path / "without").mkdir()
    lost, _ = lost_and_missed(arm(rows, tmp_path / "without"), rows, q)
    assert lost > q.size // 100


def test_an_arm_that_is_straight_along_its_first_axis_in_single_precision(tmp_path: Path) -> None:
    """Its first and its fourth joint are one there, and rounding was taken for a difference.

    The rest is lost because a straight elbow bends by the root of the rounding of its target.
    """
    module = arm(ROLLING, tmp_path, printed_array)
    q = np.random.default_rng(3).uniform(-3, 3, (400, 5))
    q[:, 1:3] = QUARTER
    q[:200, 3] = np.round(q[:200, 3])
    status = module.ik(pose(ROLLING, q).astype(np.float32)).status
    assert (~np.isin(status, (OK, SINGULAR)).any(axis=-1)).sum() < 20  # it was 111


def test_a_slide_that_is_long_beside_the_links_in_single_precision(tmp_path: Path) -> None:
    """The target was compared in units of the links, and rounded in units of the slide."""
    module = arm(POLAR, tmp_path, printed_array)
    q = np.random.default_rng(4).uniform(-3, 3, (400, 4))
    q[:, 2] = np.random.default_rng(5).uniform(5, 50, 400)
    status = module.ik(pose(POLAR, q).astype(np.float32)).status
    assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()


def test_a_short_link_in_single_precision(tmp_path: Path) -> None:
    """What it lost was more than a target may miss, but not enough to be corrected."""
    module = arm(TELESCOPE, tmp_path, printed_array)
    q = np.random.default_rng(4).uniform(-3, 3, (400, 4))
    status = module.ik(pose(TELESCOPE, q).astype(np.float32)).status
    assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()


def test_what_the_arm_does_not_reach_stays_unreachable(tmp_path: Path) -> None:
    """Least squares find the nearest pose, which is not the target."""
    module = arm(ROLLING, tmp_path)
    T = pose(ROLLING, np.random.default_rng(3).uniform(-3, 3, (200, 5)))
    for size in (1e-8, 1e-4):
        aside = link(0, 0, 0, size) @ link(0, size, 0, np.array(0.0))
        _, status = module.ik(T @ aside)
        assert (status == UNREACHABLE).all(axis=-1).mean() > 0.99


@pytest.mark.parametrize("rows", [ROLLING, POLAR], ids=["straight elbow", "slide drawn in"])
def test_a_branch_that_is_far_out_of_reach_is_not_corrected(rows: list, tmp_path: Path) -> None:
    """Nearly all targets lost time with a step for branches that it cannot bring to them."""
    module = arm(rows, tmp_path)
    T = pose(rows, np.random.default_rng(9).uniform(0.3, 2.8, (2000, len(rows))))
    assert (module.ik(T).status == UNREACHABLE).any(axis=-1).mean() > 0.1
    with np.errstate(all="ignore"):
        *_, rare = module._IK.common(*T.reshape(-1, 16).T)
    assert rare.mean() < 0.02
