"""What a file means does not depend on the order of its bodies and joints.

The driven joints alone are in the order in which the functions take them.
"""

import re
import tomllib
from pathlib import Path

import pytest
from loop_files import script_of
from places import TESTS

FILES = sorted((TESTS / "held_out_loops").glob("*.toml"))


def written(value: object) -> str:
    """A value as TOML."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k} = {written(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return f"[{', '.join(map(written, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else str(value)


def turned_round(text: str) -> str:
    """The same file with bodies, passive joints and both bodies of each joint in reverse."""
    data = tomllib.loads(text)
    joints = {k: {**j, "between": j["between"][::-1]} for k, j in data["joints"].items()}
    driven = {k: j for k, j in joints.items() if j.get("driven")}
    passive = {k: j for k, j in reversed(joints.items()) if k not in driven}
    data |= {"bodies": dict(reversed(data["bodies"].items())), "joints": passive | driven}
    return "\n".join(f"{k} = {written(v)}" for k, v in data.items())


def called(script: str) -> str:
    """The function that a script calls last."""
    return re.findall(r"^(\w+)\($", script, re.MULTILINE)[-1]


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_the_order_does_not_count(path: Path, tmp_path: Path) -> None:
    """The shaft of a Delta robot, and the cylinder of a loader, were not recognised otherwise."""
    text = path.read_text("utf-8")
    own, other = (script_of(path.stem, t, tmp_path) for t in (text, turned_round(text)))
    assert called(own) == called(other)
