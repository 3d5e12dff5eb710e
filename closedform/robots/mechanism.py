"""A generated module with dimensions, the maker's joint zero, a base and a tool."""

from __future__ import annotations

import copy
import inspect
from dataclasses import replace
from functools import cached_property
from types import ModuleType
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from closedform.robots.mounting import Mounting, inverse_transform, or_identity, rigid, rotated

Array = NDArray[np.float64]
TURN = 2 * np.pi
MOST_TURNS = 4
"""A joint angle beyond so many turns is taken for degrees."""
NAMES_OF_ANGLES = ("yaw", "pitch", "roll", "psi", "phi", "theta")
"""Task coordinates that count modulo a turn."""


class Zero(NamedTuple):
    """How joints of a model follow from those of the maker: ``matrix @ q + offsets``."""

    matrix: Array
    offsets: Array

    @classmethod
    def of(cls, n: int, signs: Any, offsets: Any, coupling: Any) -> Zero | None:
        """None if the joints of the maker are those of the model."""
        if signs is None and offsets is None and coupling is None:
            return None
        matrix = np.eye(n) if coupling is None else np.array(coupling, dtype=float)
        if matrix.shape != (n, n):
            raise ValueError(f"coupling has shape {matrix.shape}, expected ({n}, {n})")
        if signs is not None:
            chosen = np.array(signs, dtype=float)
            if chosen.shape != (n,) or not np.isin(chosen, (-1.0, 1.0)).all():
                raise ValueError(f"signs must be {n} numbers, each 1 or -1, not {signs!r}")
            matrix = matrix * chosen
        shift = np.zeros(n) if offsets is None else np.array(offsets, dtype=float)
        if shift.shape != (n,):
            raise ValueError(f"offsets has shape {shift.shape}, expected ({n},)")
        whole = np.array_equal(matrix, np.rint(matrix))
        if not whole or round(abs(np.linalg.det(matrix))) != 1:
            raise ValueError("coupling must hold integers and have the determinant 1 or -1")
        return cls(matrix, shift)


class Mechanism:
    """What a robot computes: the functions of a module, for its own base, tool and joint zero.

    Parameters
    ----------
    module, parameters, base, tool, signs, offsets, coupling
        as of :class:`~closedform.robots.robot.Robot`
    """

    def __init__(
        self,
        module: ModuleType,
        parameters: Any = None,
        *,
        base: ArrayLike | None = None,
        tool: ArrayLike | None = None,
        signs: ArrayLike | None = None,
        offsets: ArrayLike | None = None,
        coupling: ArrayLike | None = None,
    ):
        if not hasattr(module, "JOINTS") or not hasattr(module, "Parameters"):
            raise TypeError(f"{module!r} is not a generated module, such as closedform.planar_2r")
        self.module = module
        self.parameters = _parameters(module, parameters)
        self.joints: tuple[str, ...] = tuple(module.JOINTS)
        self.branches: tuple[str, ...] = tuple(module.BRANCHES)
        kinds = module.SKELETON.joints
        self.revolute = np.array([kinds[name].kind == "revolute" for name in self.joints])
        self.base, self.tool = rigid(base, "base"), rigid(tool, "tool")
        self._zero = Zero.of(len(self.joints), signs, offsets, coupling)
        self.given = given_of(module)
        self._mounting = Mounting.of(module, self.parameters, self.base, self.tool)

    @cached_property
    def dimensions_vary(self) -> bool:
        """Whether a dimension is an array, so that postures differ in it."""
        return any(map(np.ndim, self.parameters))

    def part(self, lead: tuple[int, ...], rows: Any) -> Self:
        """The same mechanism for some of many postures, if dimensions differ among them.

        ``rows`` counts the postures of the leading axes ``lead`` in one row.
        """
        if not self.dimensions_vary:
            return self
        chosen = copy.copy(self)
        values = (np.broadcast_to(np.asarray(p, float), lead).ravel() for p in self.parameters)
        chosen.parameters = self.module.Parameters(*(value[rows] for value in values))
        chosen._mounting = replace(self._mounting, parameters=chosen.parameters)
        return chosen

    def of_branches(self, lead: tuple[int, ...]) -> Self:
        """The same mechanism for joints of shape (postures, branches, joints)."""
        if not self.dimensions_vary:
            return self
        chosen = self.part(lead, slice(None))
        chosen.parameters = self.module.Parameters(*(p[:, None] for p in chosen.parameters))
        return chosen

    # Joints of the maker and of the model

    def to_model(self, q: ArrayLike) -> Any:
        """The joints that the generated module takes."""
        if self._zero is None:
            return q
        return self.as_joints(q) @ self._zero.matrix.T + self._zero.offsets

    def from_model(self, q: ArrayLike) -> Array:
        """The joints of the maker; angles are in (-pi, pi]."""
        found = np.asarray(q, dtype=float)
        if self._zero is None:
            return found
        found = (found - self._zero.offsets) @ np.linalg.inv(self._zero.matrix).T
        turned = found - TURN * np.rint(found / TURN)
        return np.where(self.revolute, np.where(turned <= -np.pi, np.pi, turned), found)

    def as_joints(self, q: ArrayLike, name: str = "q") -> Array:
        """Joint values as an array; raises if their number is wrong or they look like degrees."""
        found = np.asarray(q, dtype=float)
        n = len(self.joints)
        if found.shape[-1:] != (n,):
            raise ValueError(f"{name} has shape {found.shape}, expected (..., {n})")
        self.refuse_degrees(found, name)
        return found

    def refuse_degrees(self, q: Array, name: str) -> None:
        """Raise if an angle is larger than any that a joint takes in radians."""
        if (np.abs(q) <= MOST_TURNS * TURN).all():
            return
        sizes = np.where(self.revolute & np.isfinite(q), np.abs(q), 0.0)
        if sizes.max() > MOST_TURNS * TURN:
            worst = sizes.reshape(-1, len(self.joints)).max(0)
            k = int(worst.argmax())
            raise ValueError(
                f"{name}: {self.joints[k]} = {worst[k]:g} is more than {MOST_TURNS} turns; angles "
                "are in radians, and np.radians converts degrees"
            )

    @property
    def counts_as_model(self) -> bool:
        """Whether the joints are those that the generated module takes."""
        return self._zero is None

    @cached_property
    def one_by_one(self) -> tuple[Array, Array] | None:
        """Joints of the model as ``signs * q + offsets``; None if a motor moves several of them."""
        if self._zero is None:
            return np.ones(len(self.joints)), np.zeros(len(self.joints))
        signs = np.diag(self._zero.matrix)
        return None if np.any(self._zero.matrix != np.diag(signs)) else (signs, self._zero.offsets)

    # The functions of the module

    @property
    def name(self) -> str:
        return self.module.__name__.rpartition(".")[2]

    def has(self, function: str) -> bool:
        """Whether the mechanism has a function, such as ``"pose"``."""
        return function in self.module.__all__

    def call(self, function: str, *arguments: Any) -> Any:
        """A function of the module, with the dimensions of this robot."""
        if not self.has(function):
            raise ValueError(f"{self.name} has no function {function}")
        return getattr(self.module, function)(*arguments, params=self.parameters)

    def fk(self, q: ArrayLike) -> Any:
        """The task coordinates of joints, as in the module, of the mounted tool."""
        found = self.call("fk", self.to_model(self.as_joints(q)))
        if hasattr(found, "p"):
            return found._replace(p=self._mounting.outside(found.p))
        return self._mounting.outside(found)

    def inside(self, x: ArrayLike) -> Any:
        """The target of the module, of one for the mounted tool."""
        return self._mounting.inside(x)

    def ik(self, x: ArrayLike, given: ArrayLike | None = None) -> Any:
        """All branches: ``Solutions(q, status)`` as in the module; the joints are the maker's.

        ``given`` is the input that an arm of seven joints needs besides the target, see ``given``.
        """
        found = self.call("ik", self.inside(x), *self.to_give(given))
        return found if self._zero is None else found._replace(q=self.from_model(found.q))

    def given_at(self, q: ArrayLike) -> Array:
        """What ``ik`` needs besides the target, at joints: the arm angle, or the joint itself."""
        values = self.as_joints(q)
        if self.given is None:
            raise ValueError(f"{self.name}: the inverse takes the target only")
        if self.given in self.joints:
            return np.asarray(values[..., self.joints.index(self.given)])
        return np.asarray(self.call(self.given, self.to_model(values)))

    def to_give(self, given: ArrayLike | None) -> tuple[ArrayLike, ...]:
        """The inputs of the module's inverse besides the target."""
        if self.given is None:
            if given is not None:
                raise ValueError(f"{self.name}: the inverse takes the target only; leave out given")
            return ()
        if given is None:
            raise ValueError(f"{self.name}: the inverse also needs given={self.given}")
        if self.given not in self.joints or self._zero is None:
            return (given,)
        if self.one_by_one is None:
            raise ValueError(f"{self.name}: motors are coupled, so {self.given} cannot be given")
        k = self.joints.index(self.given)
        signs, offsets = self.one_by_one
        return (np.asarray(given, dtype=float) * signs[k] + offsets[k],)

    def pose(self, q: ArrayLike) -> Array:
        """The pose of the tool in the world, of shape (..., 4, 4)."""
        found = self.call("pose", self.to_model(self.as_joints(q)))
        return np.asarray(or_identity(self.base) @ found @ or_identity(self.tool))

    def skeleton(self, q: ArrayLike) -> Array:
        """The points of the mechanism in the world."""
        found = np.asarray(self.call("skeleton", self.to_model(self.as_joints(q))))
        if self.base is None:
            return found
        return np.asarray(found @ self.base[:3, :3].T + self.base[:3, 3])

    def jacobian(self, q: ArrayLike) -> Array:
        """The Jacobian of the module, of the mounted tool and the maker's joints."""
        model = self.to_model(self.as_joints(q))
        found = np.asarray(self.call("jacobian", model))
        if self.base is not None or self.tool is not None:
            found = self._mounting.geometric(found, model)
        return self._columns(found)

    def jacobian_space(self, q: ArrayLike) -> Array:
        """Twists (v; omega) about the origin of the world, in its axes."""
        found = np.asarray(self.call("jacobian_space", self.to_model(self.as_joints(q))))
        return self._columns(rotated(self.base, found))

    def jacobian_body(self, q: ArrayLike) -> Array:
        """Twists (v; omega) in the frame of the tool."""
        found = np.asarray(self.call("jacobian_body", self.to_model(self.as_joints(q))))
        back = None if self.tool is None else inverse_transform(self.tool)
        return self._columns(rotated(back, found))

    def determinant(self, q: ArrayLike) -> Any:
        """The determinant of the Jacobian."""
        found = self.call("determinant", self.to_model(self.as_joints(q)))
        return found if self._zero is None else found * np.linalg.det(self._zero.matrix)

    def singularities(self, q: ArrayLike) -> Array:
        """The factors whose vanishing is the singular set."""
        return np.asarray(self.call("singularities", self.to_model(self.as_joints(q))))

    def _columns(self, J: Array) -> Array:
        """A Jacobian for the joints of the maker."""
        return J if self._zero is None else np.asarray(J @ self._zero.matrix)

    @property
    def task_axes(self) -> int:
        """The number of axes of a target: 2 for a matrix, 1 for coordinates."""
        return len(self.task_shape)

    @cached_property
    def task_shape(self) -> tuple[int, ...]:
        """The shape of a target."""
        entries = len(self.module.TASK)
        return {16: (4, 4), 9: (3, 3)}.get(entries, (entries,))


def given_of(module: ModuleType) -> str | None:
    """The input of the inverse besides the target, such as ``"arm_angle"``."""
    if "ik" not in module.__all__:
        return None
    inputs = list(inspect.signature(module.ik).parameters)
    inputs = inputs[1 : inputs.index("params")]
    return inputs[0] if inputs else None


def _parameters(module: ModuleType, given: Any) -> Any:
    if given is None:
        return module.Parameters()
    if isinstance(given, dict):
        fields = module.Parameters._fields
        if unknown := [name for name in given if name not in fields]:
            raise TypeError(
                f"{module.__name__.rpartition('.')[2]} has no dimension "
                f"{' or '.join(map(str, unknown))}; there are {', '.join(fields)}"
            )
        return module.Parameters(**given)
    return module.Parameters(*given)
