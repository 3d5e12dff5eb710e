"""Checks that the installed algebra is the one that the project was proved and printed with."""

from __future__ import annotations

import re
from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, requires, version

REQUIREMENT = re.compile(r"([\w.-]+)\s*(==|>=)\s*([\d.]+)[^;]*;.*extra == ['\"]derive['\"]")


def warnings() -> list[str]:
    """A sentence for each package whose version the extra ``derive`` does not allow."""
    try:
        return list(_warnings(requires("closedform") or []))
    except PackageNotFoundError:
        return []


def _warnings(requirements: Iterable[str]) -> Iterable[str]:
    for match in filter(None, map(REQUIREMENT.match, requirements)):
        name, relation, wanted = match.groups()
        try:
            installed = version(name)
        except PackageNotFoundError:
            continue
        if relation == "==" and installed != wanted:
            yield (
                f"{name} {installed} is installed, not {wanted}; a proof may fail, and the printed "
                "files may differ from those in generated/"
            )
        elif relation == ">=" and _release(installed) < _release(wanted):
            yield (
                f"{name} {installed} is installed, but {wanted} or later is needed; "
                "a proof may fail"
            )


def _release(text: str) -> tuple[int, ...]:
    return tuple(int(n) for n in re.findall(r"\d+", text.partition("+")[0])[:3])
