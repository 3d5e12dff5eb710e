"""The figures of the papers: what they show, the page that lists them, and the files on it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import matplotlib as mpl
from places import ROOT

mpl.use("Agg")

import numpy as np
import pytest
from closedform.derivations.figures import (
    PAPERS,
    chablat_wenger_angeles,
    rao_raju,
    shi_zhu_li,
    view,
)
from closedform.derivations.figures import figures as figures_of
from libraries import FORWARD
from matplotlib import pyplot as plt

from closedform import (
    delta,
    hybrid_five_bar,
    irb260,
    plot,
    puma560,
    spherical_five_bar,
    ur_arm,
)
from closedform.cli import figures
from closedform.cli.commands import main
from closedform.plot import labels
from closedform.plot.catalogue import INVERSE
from closedform.plot.contours import thinned
from closedform.plot.diagram import ANGLE
from closedform.plot.postures import regular_target
from closedform.plot.robot import Robot
from closedform.plot.symbols import equation, lengths, symbol

FOLDER = ROOT / "docs" / "figures"
TITLES = {f.stem for f in (ROOT / "generated" / "numpy").glob("[a-z]*.py")}
LARGEST, LARGEST_THUMBNAIL = 60_000, 10_000


@pytest.fixture(autouse=True)
def closed() -> Iterator[None]:
    yield
    plt.close("all")


def module(name: str) -> Any:
    return import_module(f"closedform.generated.numpy.{name}")


def turned(vector: np.ndarray, axis: np.ndarray, angle: float) -> np.ndarray:
    """A vector after a turn about an axis."""
    across = np.cross(axis, vector)
    return vector + np.sin(angle) * across + (1 - np.cos(angle)) * np.cross(axis, across)


@pytest.mark.parametrize("name", FORWARD)
def test_the_axis_of_a_joint_is_what_its_link_turns_about(name: str) -> None:
    robot, step = module(name), 0.3
    r = Robot.of(robot)
    q = plot.posture(robot)
    here = r.points(q)[0]
    checked = 0
    for joint, (at, axis) in plot.joint_axes(robot, q).items():
        assert np.linalg.norm(axis) == pytest.approx(1)
        if joint not in robot.JOINTS or robot.SKELETON.joints[joint].kind != "revolute":
            continue
        moved = q + step * np.eye(len(q))[robot.JOINTS.index(joint)]
        there = r.points(moved)[0]
        links = robot.SKELETON.links.values()
        points = robot.SKELETON.joints[joint].points
        foot = next((p for p in points if any(p in link for link in links)), points[0])
        for link in links:
            for k in [robot.SKELETON.points.index(p) for p in link if foot in link]:
                if np.linalg.norm(there[k] - here[k]) > 1e-6 * r.size:
                    np.testing.assert_allclose(
                        there[k], at + turned(here[k] - at, axis, step), atol=1e-8 * r.size
                    )
                    checked += 1
    assert checked or not any(
        robot.SKELETON.joints[joint].kind == "revolute" for joint in robot.JOINTS
    )


def test_the_axes_of_a_wrist_are_those_of_the_space_jacobian() -> None:
    for robot in (puma560, ur_arm):
        q = plot.posture(robot)
        J = robot.jacobian_space(q)
        for k, joint in enumerate(robot.JOINTS):
            at, axis = plot.joint_axes(robot, q)[joint]
            np.testing.assert_allclose(axis, J[3:, k], atol=1e-6)
            np.testing.assert_allclose(np.cross(at, axis), J[:3, k], atol=1e-6)


def test_every_length_of_a_linkage_finds_its_segment() -> None:
    found = lengths(Robot.of(irb260), np.array([0.2, 0.3, 0.1, 0.0]), 0)
    assert {name: pairs[0] for name, pairs in found.items()} == {
        "l1": ("column", "shoulder"), "l2": ("base", "column"), "l3": ("shoulder", "elbow"),
        "l4": ("elbow", "wrist"), "l5": ("flange", "hand"), "l6": ("wrist", "flange"),
    }  # fmt: skip
    found = lengths(Robot.of(hybrid_five_bar), np.array([0.0, 1.2, 1.8]), 0)
    assert {name: {*pairs} for name, pairs in found.items()} == {
        "L0": {("A", "B")}, "L1": {("A", "C"), ("B", "D")}, "L2": {("C", "P"), ("D", "P")},
    }  # fmt: skip


def test_a_length_is_named_at_the_clearest_of_its_segments() -> None:
    figure, ax = plt.subplots()
    plane = plot.Diagram(ax, 1.0)
    for at in (-0.09, 0, 0.09):  # the first segment is between others
        plane.link([(0, at, 0), (1, at, 0)])
    plane.link([(0, 0.6, 0), (1, 0.6, 0)])
    plane.dimension([(0, 0, 0), (0, 0.6, 0)], [(1, 0, 0), (1, 0.6, 0)], "L")
    ax.set(xlim=(0, 1), ylim=(-0.2, 1))
    labels.place(figure)
    (label,) = ax._closedform_labels
    height = ax.transData.inverted().transform(label.box)[:, 1].mean()
    plt.close(figure)
    assert height > 0.4


def test_branches_are_shown_at_a_target_that_tells_them_apart() -> None:
    robot = import_module("closedform.generated.numpy.orthoglide")
    joints, status = robot.ik(regular_target(Robot.of(robot)))
    assert (status == 0).all() and np.ptp(joints, axis=0).min() > 0.4
    general = np.radians([20, 35, 50])
    robot = import_module("closedform.generated.numpy.delta")
    target = regular_target(Robot.of(robot), general)
    assert np.allclose(target, robot.fk(general).p[0])


@pytest.mark.parametrize(
    ("name", "written"),
    [
        ("theta2R", r"$\theta_{2}^{R}$"), ("l1", "$l_{1}$"), ("loff", r"$l_{\mathrm{off}}$"),
        ("rho1", r"$\rho_{1}$"), ("tilt_x", r"$\tau_{x}$"), ("word_x", r"$\mathrm{word}_{x}$"),
        ("x", "$x$"), ("al", "$a_{l}$"), ("c1", r"$\ell_{1}$"),
    ],
)  # fmt: skip
def test_names_are_written_as_formulas(name: str, written: str) -> None:
    assert symbol(name) == written


def test_figures_write_the_names_and_units_of_the_texts() -> None:
    """A length of the OPW arm was c_1 in its figure and l_1 in its chapter."""
    for path in sorted((ROOT / "generated" / "latex").glob("*.tex")):
        units = set()
        row = re.compile(r"\$([^$&]+)\$ & \\texttt\{([\w\\]+)\} & ([\w ]+) &")
        for written, name, unit in row.findall(path.read_text("utf-8")):
            plain = symbol(name.replace("\\", "")).strip("$")
            assert re.sub(r"[{} ]", "", plain) == re.sub(r"[{} ]", "", written), path.name
            units |= {unit} & {"m", "cm", "mm"}
        if path.stem in TITLES:
            assert view(path.stem).unit == "".join(units), path.name


@pytest.mark.parametrize(
    ("name", "written"),
    [
        ("sin(theta2) = 0", r"$\sin\, \theta_{2} = 0$"),
        ("elbow", "elbow"),
        ("a3*sin(theta3) + d4*cos(theta3) = 0",
         r"$a_{3} \sin\, \theta_{3} + d_{4} \cos\, \theta_{3} = 0$"),
    ],
)  # fmt: skip
def test_the_equation_of_a_singular_set_is_a_formula(name: str, written: str) -> None:
    assert equation(name) == written


@pytest.mark.parametrize("name", ["orthoglide", "opw_arm", "linear_delta"])
def test_a_section_shows_the_whole_workspace(name: str) -> None:
    v = view(name)
    ax = plot.workspace(module(name), v.plane, at=v.at, unit="m", resolution=60, singular=False)
    counts = np.ma.filled(ax.collections[0].get_array(), np.nan).reshape(60, 60)
    border = [counts[0], counts[-1], counts[:, 0], counts[:, -1]]
    assert np.isfinite(counts).any() and np.isnan(border).all()
    assert ax.get_xlabel() == "$x$ (m)"


def test_a_passive_joint_is_drawn() -> None:
    ax = plot.mechanism(module("five_bar"), view("five_bar").general, labels=False, axes=False)
    circles = [len(line.get_xdata()) for line in ax.lines if line.get_marker() == "o"]
    assert sorted(circles) == [1, 1, 2]  # two driven joints, and both elbows


@pytest.mark.parametrize(("name", "arcs"), [("five_bar", 4), ("rpr_planar", 2)])
def test_passive_angles_have_arcs(name: str, arcs: int) -> None:
    ax = plot.mechanism(module(name), view(name).general)
    drawn = [line for line in ax.lines if line.get_color() == ANGLE and len(line.get_xdata()) > 4]
    passive = [n for n in module(name).SKELETON.joints if n not in module(name).JOINTS]
    assert len(drawn) == arcs and len(passive) == 2


@pytest.mark.parametrize("name", ["planar_2r", "irb260"])
def test_labels_do_not_cover_each_other(name: str, tmp_path: Path) -> None:
    ax = plot.mechanism(module(name), view(name).general)
    plot.save(ax, tmp_path / "figure.svg")
    boxes = [label.box for label in ax._closedform_labels]
    assert len(boxes) > 4
    for k, (low, high) in enumerate(boxes):
        for other_low, other_high in boxes[:k]:
            assert (np.minimum(high, other_high) - np.maximum(low, other_low)).min() < 1


def test_each_figure_of_a_paper_is_drawn_or_has_a_reason() -> None:
    for paper in PAPERS:
        numbers = sorted([*paper.drawn, *paper.missing])
        assert numbers == list(range(1, paper.count + 1)), paper.paper
        assert set(paper.contradicted) <= set(paper.drawn)
        for number, (name, figure) in paper.drawn.items():
            assert figure.name == f"fig{number}"
            assert figure in figures_of(name)
            assert re.search(rf"\b{number}b?\b", figure.caption), figure.caption


@pytest.mark.parametrize("name", sorted(TITLES - {"_runtime"}))
def test_figures_belong_to_steps_of_their_derivation(name: str) -> None:
    d = import_module(f"closedform.derivations.{name}").d
    places = {f.step for f in figures_of(name)} - {"", INVERSE}
    assert places <= {step.title for step in d.steps}


def test_joints_with_one_axis_are_told_apart() -> None:
    ax = plot.mechanism(module("spherical_wrist"), np.zeros(3))
    named = {label.text.get_text(): label.at for label in ax._closedform_labels}
    assert np.linalg.norm(named[r"$\theta_{4}$"] - named[r"$\theta_{6}$"]) > 0.1


def test_headings_are_those_of_the_papers() -> None:
    for paper in PAPERS:
        records = import_module(f"closedform.derivations.papers.{paper.paper.replace('-', '_')}")
        (record,) = [r for r in vars(records).values() if getattr(r, "key", "") == paper.paper]
        assert paper.heading.endswith(f": {record.title}")


@pytest.mark.parametrize("name", FORWARD)
def test_a_mechanism_has_each_figure_once(name: str) -> None:
    found = [f.name for f in figures_of(name)]
    assert len(found) == len(set(found))
    assert {"mechanism", "branches", "workspace", "conditioning"} <= set(found)


def test_the_page_about_figures_is_up_to_date() -> None:
    assert (ROOT / "docs" / figures.PAGE).read_text("utf-8") == figures.page()


def test_the_pages_show_what_is_drawn_for_them() -> None:
    drawn = {f"{name}-{what}.svg" for name, what in figures.shown()}
    drawn |= {f"{name}.svg" for name in figures.names()}
    assert {path.name for path in FOLDER.iterdir()} == drawn
    pages = [ROOT / "README.md", ROOT / "docs" / figures.PAGE]
    linked = {
        Path(p).name
        for page in pages
        for p in re.findall(r"\]\(([^)]+[.]svg)\)", page.read_text("utf-8"))
    }
    assert linked == drawn


def test_pictures_of_the_pages_are_small() -> None:
    for path in FOLDER.iterdir():
        largest = LARGEST if "-" in path.name else LARGEST_THUMBNAIL
        assert path.stat().st_size < largest, path.name


def test_figures_are_drawn_with_their_captions(tmp_path: Path) -> None:
    assert main(["figures", "rpr_planar", "-o", str(tmp_path)]) == 0
    captions = json.loads((tmp_path / figures.CAPTIONS).read_text("utf-8"))
    assert {p.stem for p in tmp_path.glob("*.pdf")} == set(captions)
    drawn = {c.partition("-")[2] for c in captions}
    left_out = {f.name for f in figures_of("rpr_planar")} - drawn
    assert left_out == {"branches", "motion"}  # it has one branch, and two joints


def test_each_figure_is_drawn_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Any] = []
    monkeypatch.setattr(figures, "write", lambda figure, *targets: made.append([*targets]))
    assert main(["figures", "planar_2r", "-o", str(tmp_path), "--docs", str(tmp_path)]) == 0
    stems = [{t.stem for t in targets} for targets in made]
    assert all(len(s) == 1 for s in stems)
    assert len(set().union(*stems)) == len(made)
    assert {t.name for targets in made for t in targets if t.suffix == ".svg"} == {
        f"{name}.svg" for name in ("planar_2r", *(f"planar_2r-fig{k}" for k in range(1, 5)))
    }


def test_one_drawing_is_saved_in_each_format(tmp_path: Path) -> None:
    for targets in (("a.svg", "a.pdf"), ("b.svg",), ("b.pdf",)):
        plot.save(plot.mechanism(puma560), *(tmp_path / t for t in targets))
    for suffix in (".svg", ".pdf"):
        assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()


def test_a_figure_of_a_paper_is_the_same_on_every_run(tmp_path: Path) -> None:
    for name in ("a.svg", "b.svg"):
        assert main(["plot", "hybrid_five_bar", "fig5", "-o", str(tmp_path / name)]) == 0
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


def test_unknown_figures_are_explained(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", "planar_2r", "fig9", "-o", str(tmp_path / "a.svg")]) == 1
    assert "planar_2r has no figure 'fig9'; there are mechanism" in capsys.readouterr().err


def test_a_curve_keeps_what_its_tolerance_needs() -> None:
    t = np.linspace(0, 2 * np.pi, 2001)
    circle = np.column_stack([np.cos(t), np.sin(t)])
    side = np.array([-1.0, 1.0])
    found = thinned(circle, side, side, 1e-3)
    assert len(found) < 100
    middles = (found[1:] + found[:-1]) / 2
    assert np.abs(np.linalg.norm(middles, axis=1) - 1).max() < 2.1e-3
    straight = np.column_stack([t, 2 * t])
    assert len(thinned(straight, t, 2 * t, 1e-3)) == 3


def drawn_joints(ax: Any) -> list[np.ndarray]:
    """The centres of the joints of a drawing in the plane, in their order."""
    return [np.ravel(l.get_data()) for l in ax.lines if l.get_marker() == "o"]


def condition(ax: Any) -> float:
    """The condition number of A at the linkage that is drawn: A, B, C, D, and P as a diamond."""
    _A, B, C, D = drawn_joints(ax)[:4]
    theta2, theta3 = np.arctan2(C[1], C[0]), np.arctan2(D[1], D[0] - B[0])
    q = np.array([0.0, theta2, theta3])
    (hand,) = [np.ravel(l.get_data()) for l in ax.lines if l.get_marker() == "D"]
    p = hybrid_five_bar.fk(q).p
    mode = np.nanargmin(np.abs(chablat_wenger_angeles.plane(p) - hand).max(-1))
    return float(hybrid_five_bar.condition_number(q)[mode])


def test_the_postures_of_the_five_bar_are_what_their_captions_say() -> None:
    assert condition(chablat_wenger_angeles.isotropic(hybrid_five_bar)) == pytest.approx(1)
    assert condition(chablat_wenger_angeles.in_line(hybrid_five_bar)) > 1e6
    ax = chablat_wenger_angeles.mode_and_singularity(hybrid_five_bar)
    first, second = ax.figure.axes
    assert condition(first) > 1e6 and condition(second) < 10
    ax = chablat_wenger_angeles.coincident(hybrid_five_bar)
    _A, _B, C, D = drawn_joints(ax)[-4:]
    np.testing.assert_allclose(C, D)


def test_the_loop_of_the_wrist_is_closed_where_the_paper_draws_it() -> None:
    robot = module("h6ar_loop_closed")
    q = rao_raju.apart(robot, np.array([0.0, 0.055]))
    at = rao_raju.places(robot, q)
    arms = robot.arm_tips(q, robot.Parameters(**rao_raju.DRAWN))
    np.testing.assert_allclose([at["foot_right"], at["foot_left"]], arms, atol=1e-12)
    published = rao_raju.places(module("h6ar"), q)
    assert np.linalg.norm(published["foot_right"] - published["tip_right"]) > 0.1


def test_the_velocities_are_derivatives_of_the_position() -> None:
    ax = shi_zhu_li.velocities(irb260)
    for k, panel in enumerate(ax.figure.axes):
        t, v = panel.lines[0].get_data()
        x = irb260.fk(t[:, None] * shi_zhu_li.RATES)[:, k]
        np.testing.assert_allclose(v[1:-1], np.gradient(x, t)[1:-1], atol=2e-3)


def test_the_page_says_which_mechanisms_have_no_map() -> None:
    told = [line for line in figures.page().splitlines() if line.startswith("- `")]
    lines = {line.split("`")[1]: line for line in told}
    for name in figures.names():
        drawn = {f.name for f in figures.catalogue(name)}
        for figure in ("mechanism", "branches", "workspace", "conditioning"):
            assert (f"`{name}`" in lines[figure]) == (figure not in drawn), (name, figure)
    assert "four_bar" in lines["workspace"] and "`hybrid_five_bar` only: " in lines["volume"]


def test_the_size_of_a_mechanism_counts_no_angles() -> None:
    default = delta.Parameters()
    lengths = [value for name, value in default._asdict().items() if "alpha" not in name]
    assert Robot(delta, default).size == pytest.approx(sum(lengths))
    assert Robot(spherical_five_bar, spherical_five_bar.Parameters()).size == 1
