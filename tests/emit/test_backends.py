"""Back ends and their runners: what the registry finds, what is refused, and the documented one."""

import re
import shutil
import subprocess
from pathlib import Path

import jinja2
import pytest
import sympy as sp
from places import ROOT
from toys import TOYS

from closedform.check import runners
from closedform.check.crosscheck import crosscheck
from closedform.check.failures import UnavailableError
from closedform.check.report import report
from closedform.check.runners import node
from closedform.check.runners.python import module
from closedform.emit import backends, pages, render, sines
from closedform.emit.backend import runtime
from closedform.emit.backends.js.printer import JavaScriptPrinter
from closedform.emit.code import COMPARE, SUM, Printer, Text
from closedform.lower.graph import Graph
from closedform.lower.operators import PRINTED
from closedform.model.derivation import Derivation, Paper
from closedform.pipeline import run as pipeline
from closedform.proof.prove import Proof

GUIDE = ROOT / "docs" / "adding-a-backend.md"


def written(d: Derivation, folder: Path, name: str) -> None:
    own = pages.pages(d, Proof(d.name, d.paper.key, (), 0, ()), [name])
    pipeline.write(folder, {**own.files, **pages.shared_files([own.share], [name])})


def test_a_printer_without_an_operator_is_refused() -> None:
    methods = {o.method: getattr(JavaScriptPrinter, o.method) for o in PRINTED}
    type("Whole", (Printer,), methods)
    del methods["atan2"], methods["not_"]
    with pytest.raises(TypeError, match="Lame prints no atan2, not_: write these methods"):
        type("Lame", (Printer,), methods)


def test_a_graph_refuses_what_is_not_an_operator() -> None:
    graph = Graph()
    x = graph.input("x")
    with pytest.raises(KeyError, match="tangent"):
        graph.node("tangent", x)
    with pytest.raises(TypeError, match="atan2 takes 2 operands, not 1"):
        graph.node("atan2", x)


@pytest.mark.parametrize("name", ["c", "js", "numpy"])
def test_the_numbers_of_a_runtime_are_those_of_the_toolkit(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A number that is changed in one place only is noticed when the runtime is printed."""
    backend = backends.load(name)
    backend.shared([])
    changes = {
        "LIMIT": 1.0,
        "RIGHT_ANGLES": 1.0,
        "ROUND": 1.0,
        **{k: tuple(x * 2 for x in getattr(sines, k)) for k in ("RIGHT_ANGLE", "SINE", "COSINE")},
    }
    for constant, value in changes.items():
        with monkeypatch.context() as patch:
            patch.setattr(sines, constant, value)
            with pytest.raises(ValueError, match="must hold"):
                backend.shared([])
    with pytest.raises(ValueError, match=re.escape("closedform/runtime/js/_runtime.js must hold")):
        runtime("js/_runtime.js", ["VANISHING = 1;"])


def test_what_cannot_be_run_is_named_on_the_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(node.shutil, "which", lambda name: None)
    page, failures, _ = report(TOYS["levelled_arm"](), tmp_path, ["data", "js"])
    assert not failures
    assert "What is in js/ was not checked: Node is not installed." in page


@pytest.mark.skipif(not shutil.which("gcc"), reason="no gcc")
def test_a_mechanism_without_parameters_is_iso_c(tmp_path: Path) -> None:
    """A structure without members is not, and an arm may be given in numbers alone."""
    d = Derivation("bar", "Bar", Paper("toy", "Toys", ("A.",)), "A bar.", task=["x"])
    q = d.joint("theta1")
    d.function("fk", "Place of the end.", {"q": [q]}, {"x": [2 * sp.cos(q)]})
    written(d, tmp_path, "c")
    strict = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"]
    subprocess.run(["gcc", *strict, str(tmp_path / "c" / "bar.c")], check=True)


NONE = "none"
WRONG = {
    NONE: ("five_bar", None),
    "mul": ("levelled_arm", lambda _, node, a, b: Text(f"{a.code} + {b.code}", SUM)),
    "le": ("five_bar", lambda _, node, a, b: Text(f"{a.at(SUM)} > {b.at(SUM)}", COMPARE)),
    "max": ("five_bar", lambda _, node, a, b: Text(f"Math.min({a.code}, {b.code})")),
    "status": ("five_bar", lambda _, node, *flags: Text("0")),
}
"""An operator, where it occurs, and a wrong way to print it."""


@pytest.mark.parametrize("operator", WRONG)
def test_an_operator_that_is_printed_wrongly_is_found(
    operator: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    try:
        node.executable()
    except UnavailableError as error:
        pytest.skip(f"{error}: the JavaScript is not run")
    toy, wrong = WRONG[operator]
    d = TOYS[toy]()
    del d.functions[1:]
    if operator != NONE:
        monkeypatch.setattr(JavaScriptPrinter, operator, wrong)
    written(d, tmp_path, "js")
    for backend in runners.load("node")("js", d, tmp_path / "js", tmp_path):
        failures = [x for finding in crosscheck(d, backend) for x in finding.failures]
        assert bool(failures) == (operator != NONE)


def test_the_back_end_of_the_guide(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its three files are all it takes: it is found, prints, is run and passes the cross-check."""
    found = re.findall(r"^`(\S+)`:\n\n```\w+\n(.*?)^```$", GUIDE.read_text("utf-8"), re.M | re.S)
    assert len(found) == 3
    for path, code in found:
        target = tmp_path / path
        target.parent.mkdir(parents=True)
        target.write_text(code, "utf-8")
    package = tmp_path / "closedform"
    for home, folder in ((backends, "emit/backends"), (runners, "check/runners")):
        monkeypatch.setattr(home, "__path__", [*home.__path__, str(package / folder)])
    loader = render.environment().loader
    assert isinstance(loader, jinja2.FileSystemLoader)
    monkeypatch.setattr(loader, "searchpath", [*loader.searchpath, str(tmp_path / "templates")])
    assert "scalar" in backends.names()
    for toy in ("polar_arm", "five_bar"):
        d = TOYS[toy]()
        written(d, tmp_path / "out", "scalar")
        assert module(tmp_path / "out" / "scalar", d.name).fk(0.0, 1.0, **example(d))
        page, failures, _ = report(d, tmp_path / "out", ["scalar"])
        assert not failures, page
        assert "| fk |" in page


def example(d: Derivation) -> dict[str, float]:
    return {p.name: float(p.value) for p in d.parameters}
