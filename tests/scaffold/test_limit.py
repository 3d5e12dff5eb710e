"""What `closedform new` does when the time is up, and with coupled joints."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from chains import printed

from closedform.pipeline.run import print_robot
from closedform.pipeline.scripts import find, load
from closedform.pipeline.store import Store
from closedform.proof import prove as prove_module
from closedform.scaffold import limit
from closedform.scaffold import new as scaffold
from closedform.scaffold.inputs.motors import motors_of
from closedform.scaffold.inputs.tables import TableError, read_dh
from closedform.scaffold.limit import LimitError, bounded, limited
from closedform.scaffold.new import InverseSearch, new

PLANAR = "a, alpha, d, theta\n1, 0, 0, theta1\n1, 0, 0, theta2\n"
COUPLED = """\
a, alpha, d, theta, motors
0, pi/2, 1, theta1,
2, 0, 0, theta2, m2
1, 0, 0, theta3, m3 - m2
"""


def written(folder: Path, text: str, **options: object) -> scaffold.Script:
    (folder / "table.csv").write_text(text, "utf-8")
    return new("two", "dh", folder / "table.csv", **options)


def endless(*_: object, **__: object) -> None:
    while True:
        pass


def test_a_computation_without_end_is_stopped() -> None:
    with pytest.raises(LimitError), limited(0.05):
        endless()


def test_what_hears_no_signal_is_stopped_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """A product of long integers, which is one instruction."""
    monkeypatch.setattr(limit, "GRACE", 0)
    said: list[str] = []

    def long_product(say: Callable[[str], None]) -> int:
        say("multiplying")
        return 3 ** (10**9)

    with pytest.raises(LimitError):
        bounded(0.2, long_product, said.append)
    assert said == ["multiplying"]


def test_a_process_of_its_own_hands_back_results_and_errors() -> None:
    def fails(_: Callable[[str], None]) -> None:
        raise ValueError("why")

    assert bounded(30, lambda say: 42, print) == 42
    with pytest.raises(ValueError, match="why"):
        bounded(30, fails, print)


def test_derive_gives_up_the_inverse_and_prints_the_rest(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script = tmp_path / "two.py"
    script.write_text(written(tmp_path, PLANAR).text, "utf-8")
    monkeypatch.setattr(prove_module, "prove_inverse", endless)
    (source,) = find([str(script)])
    printed = print_robot(
        source, ("numpy",), store=Store(None), report=lambda *_: None, fresh=True, timeout=4
    )
    assert printed.given_up and "proving" in printed.proof.without_inverse
    (text,) = (t for path, t in printed.files.items() if path.name == "two.py")
    assert "def pose(" in text and "def ik(" not in text


def test_the_forward_map_is_written_when_the_time_is_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scaffold, "propose", endless)
    said: list[str] = []
    search = InverseSearch(timeout=2, say=said.append)
    script = written(tmp_path, PLANAR, search=search)
    assert "forward = arm.export(d)" in script.text
    assert 'd.no_inverse("the limit of 2 s was reached while ' in script.text
    assert said[0] == "reading the table"


def test_it_explains(tmp_path: Path) -> None:
    script = written(tmp_path, PLANAR, search=InverseSearch(explain=True))
    assert script.explained == ("axes 1 and 2 are parallel", "taken: planar arm of two links")


def test_coupled_joints_get_functions_between_motors_and_joints(tmp_path: Path) -> None:
    text = written(tmp_path, COUPLED).text
    assert 'parallelogram_drive(d, {theta3: (theta2, 2)}, ["m_theta1", "m2", "m3"])' in text
    text = written(tmp_path, COUPLED.replace("m3 - m2", "m2 + m3")).text
    assert 'motors = Matrix([real("m_theta1"), real("m2"), real("m3")])' in text
    assert "coupling = Matrix([[1, 0, 0], [0, 1, 0], [0, 1, 1]])" in text
    assert '"joints_from_motors"' in text and '"motors_from_joints"' in text


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        (
            "m3 - m2",
            "sqrt(2)*m3 - m2",
            "line 4, column motors: .* is not a sum of motors with integer",
        ),
        ("theta2, m2", "theta2,", "the column motors names 4 motors for 3 joints"),
        ("m3 - m2", "theta1 - m2", "the motor theta1 has the name of something else"),
        ("m3 - m2", "2*m2", "do not determine each other"),
        ("m3 - m2", "m3*m2", "is not a sum of motors with integer"),
        ("m3 - m2", "m3 - m2 + 1", "is not a sum of multiples of motors, such as"),
    ],
)
def test_a_coupling_that_cannot_be_is_refused(tmp_path: Path, old: str, new: str, why: str) -> None:
    path = tmp_path / "table.csv"
    path.write_text(COUPLED.replace(old, new), "utf-8")
    with pytest.raises(TableError, match=why):
        motors_of(read_dh(path), path.name)


def test_the_matrix_takes_motors_to_joints(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text(COUPLED, "utf-8")
    names, matrix = motors_of(read_dh(path), path.name)
    turned = matrix * sp.Matrix([1, 10, 100])
    assert names == ["m_theta1", "m2", "m3"] and list(turned) == [1, 10, 90]


SCREW = """\
# pitch = 0.02 m: rise of the screw in a turn
a, alpha, d, theta, joint, motors
0.25, 0, 0.3, q1, q1,
0.25, pi, 0, q2, q2,
0, 0, d3, 0, d3, pitch/(2*pi)*(m3 - m4)
0, 0, 0.05, q4, q4, m4
"""


def test_a_slide_may_be_driven_by_a_screw(tmp_path: Path) -> None:
    """A SCARA whose nut lifts the tool unless it turns with the spline."""
    path = tmp_path / "screwed.py"
    path.write_text(written(tmp_path, SCREW).text.replace('"two"', '"screwed"'), "utf-8")
    (source,) = find([str(path)])
    robot = printed(load(source), tmp_path / "printed")
    lifted = robot.joints_from_motors([0, 0, 2 * np.pi, 0])
    np.testing.assert_allclose(lifted, [0, 0, 0.02, 0], atol=1e-16)
    level = robot.joints_from_motors([0, 0, 1.5, 1.5])
    np.testing.assert_allclose(level, [0, 0, 0, 1.5], atol=1e-16)
    q = np.array([0.3, -0.4, 0.1, 0.7])
    np.testing.assert_allclose(robot.joints_from_motors(robot.motors_from_joints(q)), q, atol=1e-15)


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("(m3 - m4)", "(m4 - m4)", "not a sum of multiples of motors"),
        ("(m3 - m4)", "m3*m4", "not a sum of multiples of motors"),
        ("(m3 - m4)", "m4", "names 3 motors for 4 joints"),
        ("q4, m4", "q4, m3 - m4", "do not determine each other"),
    ],
)
def test_a_screw_that_cannot_be_is_refused(tmp_path: Path, old: str, new: str, why: str) -> None:
    path = tmp_path / "table.csv"
    path.write_text(SCREW.replace(old, new), "utf-8")
    with pytest.raises(TableError, match=why):
        motors_of(read_dh(path), path.name)
