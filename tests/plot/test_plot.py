"""The figures: what is drawn, on which axes, and that files are the same on every run."""

import re
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

import numpy as np
import pytest
from libraries import FORWARD
from matplotlib import pyplot as plt
from matplotlib.transforms import Bbox
from places import ROOT

import closedform
from closedform import plot
from closedform.cli.commands import main
from closedform.cli.plot import catalogue, write
from closedform.plot.catalogue import fits
from closedform.plot.postures import OK, spoken
from closedform.plot.robot import Robot
from closedform.plot.style import colour
from closedform.plot.symbols import symbol

SMALL = 40


@pytest.fixture(autouse=True)
def closed() -> Any:
    yield
    plt.close("all")


def module(name: str) -> Any:
    return import_module(f"closedform.generated.numpy.{name}")


def lines(ax: Any) -> list[np.ndarray]:
    """The drawn lines as points."""
    data = [l.get_data_3d() if hasattr(l, "get_data_3d") else l.get_data() for l in ax.lines]
    return [np.array(d).T for d in data]


SPHERICAL = {"agile_wrist", "spherical_five_bar"}
"""Their links are arcs."""


@pytest.mark.parametrize("name", [n for n in FORWARD if n not in SPHERICAL])
def test_every_link_is_drawn_through_its_points(name: str) -> None:
    robot = module(name)
    q = plot.posture(robot)
    ax = plot.mechanism(robot, q)
    points = robot.skeleton(q)
    points = (points[0] if robot.ASSEMBLY_MODES else points)[:, : 3 if ax.name == "3d" else 2]
    place = dict(zip(robot.SKELETON.points, points, strict=True))
    drawn = lines(ax)
    for link in robot.SKELETON.links.values():
        wanted = np.array([place[p] for p in link])
        assert any(d.shape == wanted.shape and np.allclose(d, wanted) for d in drawn), link


@pytest.mark.parametrize("name", ["planar_2r", "spherical_wrist", "irb260", "scara", "ur_arm"])
def test_branches_meet_at_the_target_and_are_named(name: str) -> None:
    robot = module(name)
    figure = plot.branches(robot).figure
    shown = [t.get_text() for legend in figure.legends for t in legend.get_texts()]
    shown += [ax.get_title() for ax in figure.axes if ax.get_title()]
    known = [spoken(branch) for branch in robot.BRANCHES]
    assert shown == [n for n in known if n in shown] and shown
    hands = [l for ax in figure.axes for l in ax.lines if l.get_marker() == "D"]
    at = np.array(
        [np.ravel(l.get_data_3d() if hasattr(l, "get_data_3d") else l.get_data()) for l in hands]
    )
    assert len(at) == len(shown)
    assert np.ptp(at, axis=0).max() < 1e-9 * (1 + np.abs(at).max())


def test_planar_mechanisms_are_drawn_in_the_plane() -> None:
    assert plot.mechanism(module("planar_2r")).name == "rectilinear"
    assert plot.mechanism(module("puma560")).name == "3d"


def test_workspace_of_the_planar_arm_is_its_annulus() -> None:
    ax = plot.workspace(closedform.planar_2r, resolution=201)
    mesh = ax.collections[0]
    x, y = (mesh.get_coordinates()[:-1, :-1] + mesh.get_coordinates()[1:, 1:]).T / 2
    reached = ~np.ma.getmaskarray(mesh.get_array()).reshape(x.T.shape).T
    r = np.hypot(x, y)
    step = np.abs(np.diff(x[:2, 0]))[0]
    assert reached[(r > 2 + step) & (r < 18 - step)].all()
    assert not reached[(r < 2 - step) | (r > 18 + step)].any()


def test_singular_curves_of_the_five_bar_are_those_of_its_plane() -> None:
    """In its plane: circles about A and B, the line AB, and where C, D and P are in line."""
    ax = plot.workspace(closedform.hybrid_five_bar, ("y", "x"), at=[0, 0, 0], resolution=241)
    curves = [np.column_stack(l.get_data()) for l in ax.lines]
    L0, L1, L2 = closedform.hybrid_five_bar.Parameters()
    for curve in curves:
        about = [np.linalg.norm(curve - np.array([y, 0.0]), axis=1) for y in (0.0, L0)]
        border = np.min([np.abs(r - s) for r in about for s in (L1 + L2, L1 - L2)], axis=0)
        x = np.column_stack([curve[:, 1], curve[:, 0], 0 * curve[:, 0]])
        q, _ = closedform.hybrid_five_bar.ik(x)
        parallel = closedform.hybrid_five_bar.singularities(q)[..., 3]
        near = np.nanmin(np.where(np.isnan(parallel), np.inf, np.abs(parallel)), axis=(1, 2))
        on_base_line = np.abs(curve[:, 1]) < 0.2
        assert ((border < 0.25) | (near < 2.5) | on_base_line).mean() > 0.95
    assert len(curves) > 3


def test_field_has_the_values_of_the_function() -> None:
    ax = plot.field(closedform.planar_2r, "determinant", ("theta1", "theta2"), resolution=SMALL)
    values = np.asarray(ax.collections[0].get_array()).reshape(SMALL, SMALL)
    theta2 = np.linspace(-np.pi, np.pi, SMALL)
    np.testing.assert_allclose(values, np.tile(80 * np.sin(theta2)[:, None], SMALL), atol=1e-12)


@pytest.mark.parametrize("name", ["delta", "five_bar", "hybrid_five_bar", "orthoglide"])
def test_conditioning_over_the_task_is_that_of_the_mode_that_reaches_it(name: str) -> None:
    robot = import_module(f"closedform.generated.numpy.{name}")
    r = plot.robot.Robot.of(robot)
    grid = plot.sections.grid_over(r, None, plot.sections.Window(resolution=12))
    drawn = np.asarray(plot.field(robot, "condition", resolution=12).collections[0].get_array())
    h, size = 1e-6, r.size
    compared = 0
    for x, value in zip(grid.targets.reshape(-1, grid.targets.shape[-1]), drawn.flat, strict=True):
        steps = [r.branches(x + s * h * size * e) for e in np.eye(len(x)) for s in (1, -1)]
        if any(status[0] != OK for _, status in steps) or not value > 0.01:
            continue
        ends = np.array([q[0] for q, _ in steps])
        change = np.angle(np.exp(1j * (ends[::2] - ends[1::2])))
        sizes = np.linalg.svd(change, compute_uv=False)
        assert value == pytest.approx(sizes[-1] / sizes[0], rel=1e-3)
        compared += 1
    assert compared > 5


def test_singularities_of_the_elbow_are_lines_over_the_joints() -> None:
    ax = plot.singularities(closedform.irb260, ("theta2", "theta3"), resolution=SMALL)
    curves = [p.vertices for c in ax.collections for p in c.get_paths() if len(p.vertices)]
    flat = [v[np.abs(np.abs(v[:, 1]) - np.pi / 2) < 0.05] for v in curves]
    elbow = [v for v in flat if len(v) and np.ptp(v[:, 0]) > 6]
    heights = {round(float(h), 1) for v in elbow for h in v[:, 1]}
    assert heights == {-1.6, 1.6}


def test_path_follows_one_branch_without_jumps() -> None:
    t = np.linspace(0, 2 * np.pi, 400)
    xs = np.column_stack([10 * np.cos(t), 10 * np.sin(t)])
    ax = plot.path(closedform.planar_2r, xs, branch="elbow_up")
    curves = np.array([line.get_ydata() for line in ax.lines])
    assert np.abs(np.diff(curves)).max() < 0.05
    q = closedform.planar_2r.ik(xs).q[:, 1]
    np.testing.assert_allclose(np.angle(np.exp(1j * (curves.T - q))), 0, atol=1e-12)


def test_path_starts_in_the_branch_nearest_to_given_joints() -> None:
    xs = np.array([[12.0, 8.0], [12.1, 8.0]])
    for k, name in enumerate(closedform.planar_2r.BRANCHES):
        q = closedform.planar_2r.ik(xs[0]).q[k]
        ax = plot.path(closedform.planar_2r, xs, start=q + 0.1)
        assert ax.get_title() == f"branch {spoken(name)}"


@pytest.mark.parametrize("kind", ["mechanism", "branches", "workspace", "singularities", "field"])
@pytest.mark.parametrize("suffix", ["svg", "pdf"])
def test_files_are_the_same_on_every_run(kind: str, suffix: str, tmp_path: Path) -> None:
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        target = tmp_path / folder / f"figure.{suffix}"
        assert main(["plot", "irb260", kind, "-o", str(target)]) == 0
    first, second = ((tmp_path / f / f"figure.{suffix}").read_bytes() for f in "ab")
    assert first == second


def test_rounding_errors_do_not_show_in_a_drawing(tmp_path: Path) -> None:
    for name, error in (("a", 0.0), ("b", 2.0**-48)):
        points = np.array([[0.0, 0.0], [0.3, 0.4], [0.7, 0.0], [1.0, 1.0]]) * [1, 1 + error]
        ax = plot.new_axes(False)
        diagram = plot.Diagram(ax, 1.0)
        diagram.link(points)
        diagram.revolute(points[1])
        diagram.clean([points])
        plot.save(ax, tmp_path / f"{name}.svg")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nothing", "mechanism", "-o", "a.svg"], "no mechanism 'nothing'"),
        (["planar_2r", "mechanism", "-o", "a.txt"], "the suffix must be one of"),
        (["planar_2r", "workspace", "-o", "a.svg", "--plane", "x", "w"], "must be two of"),
        (["planar_2r", "field", "-o", "a.svg", "--branch", "up"], "no branch 'up'"),
        (["planar_2r", "field", "-o", "a.svg", "--function", "f"], "has no function f"),
        (["spherical_wrist", "path", "-o", "a.svg"], "has no position"),
        (["planar2r", "mechanism", "-o", "a.svg"], "did you mean planar_2r?"),
        (["planar_2r", "workspace", "-o", "a.svg", "--plane", "x", "x"], "not x, x"),
        (["planar_2r", "field", "-o", "a.svg", "--plane", "theta1", "theta1"], "must be two of"),
        (["four_bar", "field", "-o", "a.svg"], "a map needs two"),
        (["four_bar", "workspace", "-o", "a.svg"], "there is no section"),
        (["slider_crank", "workspace", "-o", "a.svg"], "moves on a line"),
        (["spherical_five_bar", "path", "-o", "a.svg"], "no straight path of the hand"),
        (["my_arm.py", "mechanism", "-o", "a.svg"], "there is no file my_arm.py"),
        ([str(ROOT / "derivations/scara.py"), "mechanism", "-o", "a.svg"], "derive it first"),
    ],
)
def test_wrong_arguments_are_explained(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["plot", *arguments]) == 1
    assert message in capsys.readouterr().err


def test_wrong_postures_are_explained() -> None:
    with pytest.raises(ValueError, match=r"q must have the shape \(2,\)"):
        plot.mechanism(closedform.planar_2r, [1.0])
    with pytest.raises(ValueError, match="reaches the target"):
        plot.branches(closedform.planar_2r, [100.0, 0.0])
    with pytest.raises(TypeError, match="is not a generated module"):
        plot.mechanism(np)


def test_links_may_have_colours_of_their_own() -> None:
    robot = module("agile_wrist")
    axes = plot.mechanism(robot, hues={"rod1": 3}, labels=False, axes=False)
    shades = [line.get_color() for line in axes.lines]
    assert shades.count(colour(3)) == 1 and colour(0) in shades


def test_links_of_a_spherical_mechanism_are_arcs_about_its_centre() -> None:
    robot = import_module("closedform.generated.numpy.spherical_five_bar")
    axes = plot.mechanism(robot, [1.9, 1.2], labels=False, axes=False)
    rods = [np.array(line.get_data_3d()) for line in axes.lines if line.get_linewidth() == 2.6]
    assert len(rods) == 5  # two cranks, two rods and the strut, which is straight
    curved = [rod for rod in rods if rod.shape[1] > 2]
    assert len(curved) == 4
    for rod in curved:
        assert np.allclose(np.linalg.norm(rod, axis=0), 1, atol=1e-12)
        plane = np.cross(rod[:, 0], rod[:, -1])
        assert np.allclose(plane @ rod, 0, atol=1e-12)


def test_the_workspace_of_a_hand_on_a_sphere_is_over_its_directions() -> None:
    robot = import_module("closedform.generated.numpy.spherical_five_bar")
    assert fits(robot, "workspace")
    mesh = plot.workspace(robot, resolution=SMALL, singular=False).collections[0]
    counts = np.ma.filled(mesh.get_array(), 0).astype(float)
    hands = robot.fk([[1.9, 1.2], [0.3, -0.7], [2.8, 0.4]])
    seen = 0
    for x, status in zip(hands.p.reshape(-1, 3), hands.status.reshape(-1), strict=True):
        if status == 0:
            place = np.arctan2(x[1], x[0]), np.arcsin(x[2] / np.linalg.norm(x))
            column, row = (
                round((v / end + 1) * (SMALL - 1) / 2)
                for v, end in zip(place, (np.pi, np.pi / 2), strict=True)
            )
            near = counts[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2]
            assert (robot.ik(x).status == 0).sum() in near
            seen += 1
    assert seen > 2 and 0 in counts


@pytest.mark.parametrize(
    ("name", "unit", "label"),
    [("planar_2r", "", "$x$"), ("planar_2r", "cm", "$x$ (cm)"), ("delta", "", "$x$"),
     ("spherical_five_bar", "m", "longitude (rad)")],
)  # fmt: skip
def test_axes_of_lengths_have_the_unit_that_is_told(name: str, unit: str, label: str) -> None:
    robot = import_module(f"closedform.generated.numpy.{name}")
    ax = plot.workspace(robot, unit=unit, resolution=SMALL, singular=False)
    assert ax.get_xlabel() == label


def test_a_mechanism_without_a_forward_map_has_maps_over_its_task() -> None:
    robot = import_module("closedform.generated.numpy.three_prs")
    assert fits(robot, "workspace") and fits(robot, "conditioning")
    at, tilts = (0.45, 0, 0), ("tilt_x", "tilt_y")
    mesh = plot.field(robot, "condition", tilts, at=at, resolution=SMALL).collections[0]
    x, k = np.array([0.45, -np.pi / 2, np.pi / 2]), 0
    sides = np.linspace(-np.pi / 2, np.pi / 2, SMALL)
    row, column = SMALL // 3, SMALL // 2
    x[1:] = sides[column], sides[row]
    J = robot.jacobian(x, robot.ik(x).q[k])
    drawn = float(mesh.get_array().reshape(SMALL, SMALL)[row, column])
    assert drawn == pytest.approx(1 / np.linalg.cond(J), rel=1e-9)
    ax = plot.workspace(robot, tilts, at=at, resolution=SMALL)
    assert "all legs" in [text.get_text() for text in ax.get_legend().get_texts()]
    with pytest.raises(ValueError, match="must be two of z, tilt_x, tilt_y, not rho1, rho2"):
        plot.field(robot, "condition", ("rho1", "rho2"), resolution=SMALL)


@pytest.mark.parametrize(("name", "dots"), [("four_bar", 4), ("slider_crank", 6)])
def test_the_motion_of_a_mechanism_with_one_joint(name: str, dots: int) -> None:
    robot = import_module(f"closedform.generated.numpy.{name}")
    assert fits(robot, "motion") and not fits(robot, "workspace")
    above, below = plot.motion(robot).figure.axes
    curves = [line.get_data() for line in above.lines if len(line.get_xdata()) > 1]
    slopes = [line.get_ydata() for line in below.lines]
    for (q, x), slope in zip(curves, slopes, strict=True):
        assert np.allclose(np.gradient(x, q)[2:-2], slope[2:-2], atol=1e-3)
    marked = [line.get_xdata()[0] for line in above.lines if len(line.get_xdata()) == 1]
    assert len(marked) == dots
    turns = np.abs(robot.jacobian(np.reshape(marked, (-1, 1)))).min(axis=1)
    assert turns.max() < 1e-3


def test_a_map_of_a_hand_that_turns_is_over_two_joints() -> None:
    robot = import_module("closedform.generated.numpy.agile_wrist")
    axes = plot.field(robot, resolution=20)
    assert (axes.get_xlabel(), axes.get_ylabel()) == (symbol("theta1"), symbol("theta2"))


def test_a_pole_does_not_hide_the_rest_of_a_map() -> None:
    bar = import_module("closedform.generated.numpy.five_bar")
    (mesh,) = plot.field(bar, resolution=100).collections
    values = np.ma.filled(mesh.get_array(), np.nan)
    assert mesh.get_clim()[1] < np.nanquantile(values, 0.99) < np.nanmax(values)


@pytest.mark.parametrize("name", ["delta", "linear_delta", "three_prs", "planar_2r"])
def test_a_branch_reaches_the_whole_line(name: str) -> None:
    robot = import_module(f"closedform.generated.numpy.{name}")
    status = robot.ik(plot.line(robot, 50)).status
    assert (status == 0).all(axis=0).any()


def test_the_command_draws_a_mechanism_as_the_documents_do(tmp_path: Path) -> None:
    assert main(["plot", "agile_wrist", "mechanism", "-o", str(tmp_path / "a.svg")]) == 0
    (figure,) = (f for f in catalogue("agile_wrist") if f.name == "mechanism")
    write(lambda: figure.draw(module("agile_wrist")), tmp_path / "b.svg")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


def test_the_command_draws_a_printed_module(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "generated/numpy", tmp_path / "numpy")
    (tmp_path / "numpy/scara.py").rename(tmp_path / "numpy/my_arm.py")
    for what in ("mechanism", "field"):
        target = tmp_path / f"{what}.svg"
        assert main(["plot", str(tmp_path / "numpy/my_arm.py"), what, "-o", str(target)]) == 0
        assert target.is_file()


def test_figures_of_a_printed_module_go_to_its_article(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "generated/numpy", tmp_path / "numpy")
    (tmp_path / "numpy/planar_2r.py").rename(tmp_path / "numpy/my_arm.py")
    (tmp_path / "latex").mkdir()
    assert main(["figures", str(tmp_path / "numpy/my_arm.py")]) == 0
    shown = (tmp_path / "latex/my_arm-figures.tex").read_text("utf-8")
    drawn = {p.stem for p in tmp_path.glob("latex/*.pdf")}
    assert drawn == set(re.findall(r"\\drawing{(.*?)}", shown))
    assert "my_arm-branches" in drawn


def test_without_matplotlib_a_message_says_what_to_install() -> None:
    code = "import sys; sys.modules['matplotlib'] = None; import closedform.plot"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stderr.rstrip().endswith("run: pip install 'closedform[plot]'")


def test_articles_are_printed_without_matplotlib() -> None:
    """``make`` derives everything before it installs what draws figures."""
    code = "import sys; sys.modules['matplotlib'] = None; import closedform.emit.backends.latex"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_figures_are_drawn_without_sympy(tmp_path: Path) -> None:
    code = (
        "import sys; sys.modules['sympy'] = None; from closedform.cli.commands import main; "
        f"sys.exit(main(['figures', 'four_bar', '-o', {str(tmp_path)!r}]))"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
    assert (tmp_path / "four_bar-mechanism.pdf").is_file()


def test_a_low_section_has_a_low_figure() -> None:
    low = plot.singularities(module("scara"), ("x", "z"), resolution=SMALL)
    square = plot.singularities(module("scara"), ("x", "y"), resolution=SMALL)
    assert low.figure.get_figheight() < 0.6 * square.figure.get_figheight()


@pytest.mark.parametrize(
    ("name", "centre"),
    [
        ("agile_wrist", "O"),
        ("spherical_five_bar", "A0"),
        ("spherical_wrist", ""),  # its one link is a radius
        ("four_bar", ""),
        ("delta", ""),
        ("puma560", ""),
    ],
)
def test_a_spherical_mechanism_is_recognised_by_its_points(name: str, centre: str) -> None:
    assert Robot.of(module(name)).centre == centre


@pytest.mark.parametrize(
    ("robot", "mixed"),
    [
        ("planar_2r", False),
        ("spherical_wrist", False),
        ("linear_delta", False),
        ("scara", True),
        ("stanford_arm", True),
        ("three_prs", True),
    ],
)
def test_jacobians_that_mix_lengths_and_angles_are_known(robot: str, mixed: bool) -> None:
    assert Robot.of(module(robot)).mixes_units is mixed


def test_the_scale_of_a_mixed_jacobian_names_its_units() -> None:
    ax = plot.field(module("scara"), "condition", unit="m", resolution=12)
    assert ax.collections[0].colorbar.ax.get_ylabel().endswith("(m, rad)")
    ax = plot.field(module("planar_2r"), "condition", unit="cm", resolution=12)
    assert "rad" not in ax.collections[0].colorbar.ax.get_ylabel()


@pytest.mark.parametrize("name", ["orthoglide", "irb260", "agile_wrist"])
def test_a_branch_fills_its_panel_below_the_title(name: str) -> None:
    """The drawings of the orthoglide took a third of their panels."""
    ax = plot.branches(import_module(f"closedform.generated.numpy.{name}"))
    ax.figure.draw_without_rendering()
    for panel in ax.figure.axes:
        boxes = [line.get_window_extent() for line in panel.lines + panel.collections]
        seen = Bbox.union([b for b in boxes if np.isfinite(b.get_points()).all() and b.height > 0])
        size = max(seen.width / panel.bbox.width, seen.height / panel.bbox.height)
        assert 0.6 <= size <= 1.02
        assert seen.y1 <= panel.title.get_window_extent().y0 + 1


@pytest.mark.parametrize("at", [-0.6, 0.6])
def test_the_axis_of_a_slide_points_to_where_it_grows(at: float) -> None:
    """The arrows of the 3-PRS mechanism pointed down, because its sliders were below zero."""
    robot = import_module("closedform.generated.numpy.orthoglide")
    for k, (_, along) in enumerate(plot.joint_axes(robot, [at] * 3).values()):
        assert along == pytest.approx(np.eye(3)[k])


@pytest.mark.parametrize(
    ("name", "rails"),
    [
        ("slider_crank", ["x"]),
        ("linear_delta", ["rho1", "rho2", "rho3"]),
        ("three_prs", ["rho1", "rho2", "rho3"]),
        ("rpr_planar", []),  # its legs turn
        ("scara", []),  # an arm carries its slide
    ],
)
def test_a_slide_along_a_fixed_line_is_a_block_on_a_rail(name: str, rails: list[str]) -> None:
    assert Robot.of(module(name)).rails == rails


def test_a_block_is_around_the_point_that_slides() -> None:
    """It was a sleeve about the middle of the line, which no body of a slider has."""
    r = Robot.of(module("linear_delta"))
    ax = plot.mechanism(r.module, labels=False)
    place = dict(zip(r.module.SKELETON.points, r.points(r.posture())[0], strict=True))
    blocks = [line for line in ax.lines if line.get_linewidth() > 4 * 2.6]
    middles = [np.mean(line.get_data_3d(), axis=1) for line in blocks]
    for point in ("B1", "B2", "B3"):
        assert any(np.allclose(place[point], m) for m in middles)
