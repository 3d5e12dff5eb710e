"""Reads a serial arm from a URDF file: the axes of its joints at home, and the pose of a link.

A URDF file is data: entities and other declarations are refused, and every number is read exactly.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from xml.parsers.expat import ExpatError, ParserCreate

import sympy as sp

from closedform.algebra.formulas import FormulaError, number, shown
from closedform.scaffold.inputs.joints import MOVING, Joint
from closedform.scaffold.inputs.tables import Table, TableError, content_of, shown_name
from closedform.scaffold.inputs.tree import (
    DEFAULT,
    LARGEST,
    Choice,
    meant_angle,
    meant_axis,
    meant_length,
    meant_number,
    placed,
    table_of,
)

COMMENT = re.compile(rb"<!--.*?-->", re.DOTALL)
"""A file that was expanded may mention macros in its comments."""


def read_urdf(path: Path, choice: Choice = DEFAULT) -> Table:
    """The chain of the ``choice``; by default from root to end."""
    elements = _root(path).findall("joint")
    chain = _links_above(elements, choice.tool)
    joints = [
        _joint(element, path.name, aside=bool(chain) and _link(element, "child") not in chain)
        for element in elements
    ]
    return table_of(joints, path.name, choice)


def _link(element: ElementTree.Element, end: str) -> str:
    """The link at one end of a joint; nothing if it has none."""
    found = element.find(end)
    return "" if found is None else found.get("link", "")


def _links_above(elements: Sequence[ElementTree.Element], link: str) -> set[str]:
    """A link with those that carry it; none if it is not chosen."""
    above = {_link(element, "child"): _link(element, "parent") for element in elements}
    found: set[str] = set()
    while link in above and link not in found:
        found.add(link)
        link = above[link]
    return found


def _root(path: Path) -> ElementTree.Element:
    content = content_of(path, LARGEST, "a URDF file")
    if b"<!DOCTYPE" in content or b"<!ENTITY" in content:
        raise TableError(f"{path.name}: declarations such as <!ENTITY> are not read")
    try:
        root = _parsed(content)
    except (ExpatError, ValueError, LookupError) as error:
        raise TableError(f"{path.name} is not valid XML: {error}") from error
    if root.tag != "robot":
        raise TableError(f"{path.name}: the file is not URDF, which begins with <robot>")
    if b"xmlns:xacro" in content and b"<xacro:" in COMMENT.sub(b"", content):
        raise TableError(f"{path.name}: expand it first: xacro {path.name} > robot.urdf")
    return root


def _parsed(content: bytes) -> ElementTree.Element:
    """The root element; prefixes that are not declared, as in parts for Gazebo, are left alone."""
    tree, parser = ElementTree.TreeBuilder(), ParserCreate()
    parser.StartElementHandler, parser.EndElementHandler = tree.start, tree.end
    parser.Parse(content, True)
    return tree.close()


def _joint(element: ElementTree.Element, file: str, *, aside: bool) -> Joint:
    """A joint; the place and the axis of one that is ``aside`` of the chain are not read."""
    notes: list[str] = []
    name, kind = element.get("name", ""), element.get("type", "")
    where = f"{file}, joint {shown_name(name)}"
    if not name:
        raise TableError(f"{file}: a joint has no name")
    if kind not in (*MOVING, "fixed", "floating", "planar"):
        raise TableError(
            f"{where}: its type is {shown(kind)}, which URDF does not know; a joint is revolute, "
            f"continuous, prismatic or fixed"
        )
    links = [_link(element, end) for end in ("parent", "child")]
    for end, link in zip(("parent", "child"), links, strict=True):
        if not link:
            raise TableError(f'{where}: it has no {end} link; write <{end} link="..."/>')
    origin, axis = (None if aside else element.find(part) for part in ("origin", "axis"))
    xyz, rpy, direction = (
        _numbers(element, key, default, where)
        for element, key, default in (
            (origin, "xyz", (0, 0, 0)),
            (origin, "rpy", (0, 0, 0)),
            (axis, "xyz", (1, 0, 0)),
        )
    )
    for angle in rpy:
        if _is_in_degrees(angle):
            raise TableError(
                f"{where}: rpy has {angle}, and angles of URDF are in radians; write "
                f"{math.radians(float(angle)):.12g} for {angle} degrees"
            )
    written = (placed(xyz, rpy), sp.Matrix(direction))
    xyz = [meant_length(e, f"{where}: xyz", notes) for e in xyz]
    rpy = [meant_number(e, f"{where}: rpy", notes) for e in rpy]
    direction = sp.Matrix([meant_number(e, f"{where}: xyz", notes) for e in direction])
    rpy = [meant_angle(e, where, notes) for e in rpy]
    if kind in MOVING and direction.is_zero_matrix:
        raise TableError(
            f'{where}: its axis is zero; write its direction, such as <axis xyz="0 0 1"/>'
        )
    if kind in MOVING:
        direction = meant_axis(direction, where, notes)
    mimic = element.find("mimic")
    meant = placed(xyz, rpy)
    limits = None if kind == "continuous" else _limits(element.find("limit"), where, notes)
    if limits and MOVING.get(kind) == "revolute" and any(map(_is_in_degrees, map(number, limits))):
        notes.append(
            f"{where}: its limits {' and '.join(limits)} are in radians; if degrees are meant, "
            f"multiply them by pi/180"
        )
    return Joint(
        name=name,
        kind=kind,
        parent=links[0],
        child=links[1],
        origin=meant,
        axis=direction,
        limits=limits,
        mimics="" if mimic is None else mimic.get("joint", "another joint"),
        factor=_number(mimic, "multiplier", 1, where),
        offset=_number(mimic, "offset", 0, where),
        written=None if written == (meant, direction) else written,
        notes=tuple(notes),
    )


def _is_in_degrees(angle: Any) -> bool:
    """Whether an angle is a round number, and more than two turns in radians."""
    return bool(4 * math.pi < abs(angle) <= 720 and angle % 5 == 0)


def _number(element: ElementTree.Element | None, key: str, default: int, where: str) -> sp.Rational:
    text = None if element is None else element.get(key)
    if text is None:
        return sp.Integer(default)
    return _exact(text.strip(), f"{where}: {key}")


def _exact(text: str, where: str) -> sp.Rational:
    """A number of the file."""
    try:
        fraction = number(text)
    except FormulaError as error:
        hint = "; numbers are separated by spaces alone" if "," in text else ""
        if "${" in text:
            hint = "; the file has formulas of xacro, which expands them: xacro FILE > robot.urdf"
        raise TableError(f"{where}: {error}{hint}") from error
    return sp.Rational(fraction.numerator, fraction.denominator)


def _limits(
    limit: ElementTree.Element | None, where: str, notes: list[str]
) -> tuple[str, str] | None:
    """The least and the largest value, as they are written; None if the file has none."""
    if limit is None or not ("lower" in limit.attrib or "upper" in limit.attrib):
        return None
    least, most = (limit.get(side, "0").strip() for side in ("lower", "upper"))
    try:
        if number(least) <= number(most):
            return least, most
        fault = f"{least} is larger than {most}"
    except FormulaError as error:
        fault = str(error)
    notes.append(f"{where}: its limits are left out: {fault}")
    return None


def _numbers(
    element: ElementTree.Element | None, key: str, default: Sequence[int], where: str
) -> list[sp.Rational]:
    """Three exact numbers."""
    text = None if element is None else element.get(key)
    if text is None:
        return [sp.Integer(e) for e in default]
    words = text.split()
    if len(words) != 3 and "${" not in text:
        raise TableError(f"{where}: {key} needs three numbers, not {shown(text)}")
    return [_exact(word, f"{where}: {key}") for word in words]
