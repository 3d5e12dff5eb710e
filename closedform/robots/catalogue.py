"""Ready robots by name, from the tables of this folder, with the public source of every number."""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from closedform.robots.robot import Robot

FOLDER = Path(__file__).parent


@cache
def entries() -> Mapping[str, Mapping[str, Any]]:
    """What the tables say of each robot, by name.

    ``family`` is the generated module, ``source`` says where the ``parameters`` are from;
    ``limits``, ``zero``, ``base`` and ``tool`` have a source of their own.  Angles of the tables
    are in degrees.
    """
    found: dict[str, Mapping[str, Any]] = {}
    for path in sorted(FOLDER.glob("*.toml")):
        found.update(tomllib.loads(path.read_text("utf-8")))
    return found


def names() -> list[str]:
    """The names of all ready robots."""
    return list(entries())


def load(name: str, *, compiled: bool | None = None, **options: Any) -> Robot:
    """A ready robot; ``options`` are those of `Robot`, such as another tool or other limits.

    It computes with the C module of its family where that was built, otherwise with the NumPy
    module; ``compiled`` chooses one of them.
    """
    if name not in entries():
        near = difflib.get_close_matches(name.lower(), names(), n=3)
        advice = f"; did you mean {' or '.join(near)}?" if near else ""
        raise ValueError(f"there is no robot {name!r}{advice}")
    entry = entries()[name]
    module = _module(entry["family"], compiled)
    known: dict[str, Any] = {"label": name, "parameters": entry["parameters"]}
    for part in ("base", "tool"):
        if part in entry:
            known[part] = entry[part]["position"]
    if "limits" in entry:
        limits = entry["limits"]
        known["limits"] = [in_radians(module, limits[side]) for side in ("lower", "upper")]
    zero = dict(entry.get("zero", {}))
    zero.pop("source", None)
    if "offsets" in zero:
        zero["offsets"] = in_radians(module, zero["offsets"])
    return Robot(module, **{**known, **zero, **options})


def _module(family: str, compiled: bool | None) -> ModuleType:
    if compiled is not False:
        try:
            return import_module(f"closedform.generated.c.{family}")
        except ImportError:
            if compiled:
                raise
    return import_module(f"closedform.generated.numpy.{family}")


def in_radians(module: ModuleType, values: Any) -> Any:
    """Joint values of a table: angles are in degrees there, slides in their own unit."""
    kinds = module.SKELETON.joints
    turns = np.array([kinds[name].kind == "revolute" for name in module.JOINTS])
    given = np.array(values, dtype=float)
    return np.where(turns, np.radians(given), given)
