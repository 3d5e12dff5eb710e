"""How articles spell names in which joints occur that a file calls by words.

The table of the joints says which is which.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from closedform.model.derivation import Derivation
from closedform.spelling import GREEK, by_number


def as_it_is(name: str) -> str:
    """The name itself."""
    return name


def called(derivation: Derivation) -> Callable[[str], str]:
    """How names are spelled in which joints occur; as they are if the name of a joint is short.

    In the names of signs and of what a lemma finds on the way the number of a joint stands alone.
    """
    taken = {p.name for p in derivation.parameters} | {*derivation.written} | {*derivation.task}
    taken |= {s.name for f in derivation.functions for s in f.symbols}
    joints = by_number({j.name: j.kind for j in derivation.joints}, taken)
    if not joints:
        return as_it_is
    numbers = {j.name: str(k) for k, j in enumerate(derivation.joints, 1)}
    longest_first = sorted(numbers, key=len, reverse=True)
    part = re.compile(rf"(?:{'|'.join(longest_first)})(?!\d)")

    def spelled(name: str) -> str:
        before, joint = (name[:2], name[2:]) if name[:2] in ("c_", "s_") else ("", name)
        if joint in joints:  # itself, or the cosine or the sine of a joint that is given
            return f"{before}{joints[joint]}"
        return part.sub(lambda found: numbers[found[0]], name)

    return spelled


__all__ = ["GREEK", "as_it_is", "called"]
