"""How the figures of mechanisms and papers are drawn, a file for each paper."""

from closedform.derivations.figures import (
    chablat_wenger_angeles,
    rao_raju,
    reddy_babu,
    shi_zhu_li,
)
from closedform.derivations.figures.mechanisms import VIEWS

from closedform.plot.catalogue import Figure, PaperFigures, View, standard

PAPERS: tuple[PaperFigures, ...] = (
    reddy_babu.PAPER,
    shi_zhu_li.PAPER,
    chablat_wenger_angeles.PAPER,
    rao_raju.PAPER,
)
OF_PAPERS = (*reddy_babu.ALL, *shi_zhu_li.ALL, *chablat_wenger_angeles.ALL, *rao_raju.ALL)


def view(name: str) -> View:
    """How a mechanism is shown."""
    return VIEWS.get(name, View())


def figures(name: str) -> list[Figure]:
    """The figures of a mechanism: those that every mechanism has, then those of its paper."""
    return [*standard(view(name)), *(figure for owner, figure in OF_PAPERS if owner == name)]
