"""The guides as notebooks: every cell runs, and records show themselves."""

from importlib.util import find_spec
from typing import Any

import pytest

from closedform.site.notebooks import GUIDES, notebook

for needed in ("jupytext", "nbclient", "ipykernel"):
    if find_spec(needed) is None:  # each worker of the tests would import it to collect this file
        pytest.skip(f"{needed} is not installed", allow_module_level=True)


def shown(cell: Any, form: str) -> list[str]:
    """What the outputs of a cell show in a form, such as ``text/latex``."""
    return [o.data[form] for o in cell.get("outputs", ()) if form in o.get("data", {})]


@pytest.mark.parametrize("guide", GUIDES)
def test_every_cell_runs(guide: str) -> None:
    cells = notebook(guide).cells
    assert [c for c in cells if c.cell_type == "code" and c.outputs]
    assert cells[0].cell_type == "markdown" and cells[0].source.startswith("# ")
    if guide == "reading-a-derivation":
        text = "\n".join(t for c in cells for t in shown(c, "text/markdown"))
        assert "**Jacobian and its determinant.**" in text
        assert r"\det J_{xy} &= l_{1} l_{2} \mathrm{s}_{2}" in text
        assert "**Lemma (two-link triangle).**" in text and "atan_{2}" not in text
        assert "base has a cosine instead of a sine.**" in text


def test_a_derivation_shows_what_a_reader_computes() -> None:
    """The algorithms of the article, and not the statements of the program."""
    from closedform.derivations.planar_2r import d

    import closedform.emit.notebook  # noqa: F401

    text = d._repr_markdown_() or ""
    assert d._repr_latex_() is None and text.startswith("**Planar 2R arm.** Two links")
    assert r"x &= l_{1} \mathrm{c}_{1} + l_{2} \mathrm{c}_{12}" in text
    assert text.count("**`ik(x)`**") == 1 and "*unreachable*" in text
    assert r"\theta_{1} = \operatorname{atan2}(p_{y},\ p_{x}) - \alpha$" in text
    assert not any(word in text for word in ("beyond", "no link", r"\text", "eqref"))
    assert r"$\mathrm{c}_{12} = \cos (\theta_{1} + \theta_{2})$" in text


def test_the_table_of_a_step_is_shown() -> None:
    from closedform.derivations.planar_2r import d

    import closedform.emit.notebook  # noqa: F401

    step = next(s for s in d.steps if s.title == "Skeleton")
    rows = [line for line in (step._repr_markdown_() or "").splitlines() if line.startswith("|")]
    assert rows[1] == "|---|---|---|" and rows[2] == "| first | base to elbow | $l_{1}$ |"
