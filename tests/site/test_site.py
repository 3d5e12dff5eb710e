"""The site as it is built: its links, its formulas, and that it needs nothing from elsewhere."""

import re
import shutil
import subprocess
import sys
from collections import Counter
from html.parser import HTMLParser
from pathlib import Path

import pytest
from libraries import FORWARD
from places import ROOT

from closedform import five_bar
from closedform.emit.markup import Markdown, MarkupError, Place
from closedform.pipeline import scripts
from closedform.site.labels import label

SEPARATE = re.compile(r"\\[A-Za-z]+")
LATEX = ROOT / "generated" / "latex"

md = Markdown({"step:arm:2": Place("#step-arm-2", "The elbow")})


# The home page


def test_the_examples_of_the_home_page_run(tmp_path: Path) -> None:
    """In all three languages, with the same joints for the same target."""
    home = (ROOT / "templates" / "site" / "home.md.jinja").read_text("utf-8")
    code = {
        n: re.search(rf"```{n}\n(.*?)```", home, re.DOTALL).group(1) for n in ("python", "c", "js")
    }

    def output(*command: str | Path) -> str:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout

    joints = [f"{a:.6f} {b:.6f}" for a, b in five_bar.ik([3.0, 10.0]).q]
    assert five_bar.BRANCHES[0] in output(sys.executable, "-c", code["python"])
    if shutil.which("cc"):
        c = ROOT / "generated" / "c"
        (tmp_path / "main.c").write_text(code["c"], "utf-8")
        program = tmp_path / "main"
        output("cc", tmp_path / "main.c", c / "five_bar.c", f"-I{c}", "-o", program, "-lm")
        assert output(program).splitlines() == joints
    if shutil.which("node"):
        shutil.copytree(ROOT / "generated" / "js", tmp_path / "node_modules" / "closedform")
        (tmp_path / "main.mjs").write_text(code["js"], "utf-8")
        lines = output("node", tmp_path / "main.mjs").splitlines()
        numbers = [re.findall(r"-?\d+\.\d+", line) for line in lines]
        assert [" ".join(f"{float(v):.6f}" for v in found) for found in numbers] == joints


# Sentences


@pytest.mark.parametrize(
    ("latex", "markdown"),
    [
        (r"the angle $\theta_{1}$ of", r"the angle {math}`\theta_{1}` of"),
        (r"by \texttt{ik\_pose}", "by `ik_pose`"),
        (r"\emph{only} \textbf{one}", "*only* **one**"),
        (r"``so''---it is", "“so”—it is"),
        (r"see \eqref{eq:arm:7}", 'see <a class="reference internal" href="#eq-arm-7">(7)</a>'),
        (
            r"Section~\ref{step:arm:2}",
            '<a class="reference internal" href="#step-arm-2">The elbow</a>',
        ),
        (
            r"see Sections~\ref{step:arm:2} and \ref{step:arm:2}",
            'see <a class="reference internal" href="#step-arm-2">The elbow</a> and '
            '<a class="reference internal" href="#step-arm-2">The elbow</a>',
        ),
        (r"a \textsc{singular} one", 'a <span class="status">SINGULAR</span> one'),
        (r"50\,\% of \{1, 2\}", "50\N{THIN SPACE}% of {1, 2}"),
        (r"2 * 3 < 4 [a](b)", r"2 \* 3 \< 4 \[a\](b)"),
        (r"we get \newline $x$", r"we get <br> {math}`x`"),
        (
            r"$x = \begin{cases} 1 & \text{if $a > 0$} \end{cases}$ holds",
            r"{math}`x = \begin{cases} 1 & \text{if $a > 0$} \end{cases}` holds",
        ),
    ],
)
def test_a_sentence_of_an_article_becomes_markdown(latex, markdown):
    assert md(latex) == markdown


def test_a_command_that_the_site_does_not_know_is_an_error():
    with pytest.raises(MarkupError, match="unheard"):
        md(r"an \unheard{command}")
    with pytest.raises(MarkupError, match="nothing has the label"):
        md(r"\ref{step:arm:3}")


def test_markup_in_a_text_stays_text():
    assert "<script>" not in md("<script>alert(1)</script>")


def test_names_have_their_signs():
    assert [label(n) for n in ("theta2R", "l1", "d3", "L0", "rho1")] == [
        "θ₂ᴿ",
        "l₁",
        "d₃",
        "L₀",
        "ρ₁",
    ]


# The built site


class Links(HTMLParser):
    """The marks of a page, and where it leads."""

    def __init__(self, page):
        super().__init__()
        self.marks, self.links, self.loaded = set(), [], []
        self.text, self.skipped = [], 0
        self.feed(page.read_text("utf-8"))

    def handle_starttag(self, tag, attrs):
        found = dict(attrs)
        self.marks.add(found.get("id"))
        if tag == "a" and found.get("href"):
            self.links.append(found["href"])
        loads = {"script": "src", "img": "src", "link": "href", "iframe": "src", "source": "src"}
        if tag in loads and found.get(loads[tag]):
            self.loaded.append(found[loads[tag]])
        if tag in ("script", "style", "code", "pre", "svg"):
            self.skipped += 1

    def handle_endtag(self, tag):
        if tag in ("script", "style", "code", "pre", "svg"):
            self.skipped -= 1

    def handle_data(self, data):
        if not self.skipped:
            self.text.append(data)


@pytest.fixture(scope="session")
def pages(site):
    return {page: Links(page) for page in sorted(site.rglob("*.html"))}


def test_there_is_a_page_for_each_mechanism(site):
    for source in scripts.sources():
        page = (site / "mechanisms" / f"{source.name}.html").read_text("utf-8")
        assert (f'data-robot="{source.name}"' in page) == (source.name in FORWARD), source.name
        assert ("no explorer" in page) == (source.name not in FORWARD)
        assert (site / "reference" / f"{source.name}.html").is_file()


def test_every_link_leads_somewhere(site, pages):
    lost = []
    for page, found in pages.items():
        for link in found.links:
            path, _, mark = link.partition("#")
            if re.match(r"[a-z]+:", path):
                continue
            target = (page.parent / path).resolve() if path else page
            if not (target.exists() and (not mark or mark in pages[target].marks)):
                lost.append((page.relative_to(site), link))
    assert not lost


def test_nothing_is_loaded_from_elsewhere(site, pages):
    for page, found in pages.items():
        for address in found.loaded:
            assert not re.match(r"(https?:)?//", address), (page, address)
            path = (page.parent / re.split(r"[?#]", address)[0]).resolve()
            assert path.exists(), (page.relative_to(site), address)
    for sheet in site.rglob("*.css"):
        assert not re.search(r"url\(['\"]?(https?:)?//", sheet.read_text("utf-8")), sheet
        assert "@import" not in sheet.read_text("utf-8"), sheet


def test_no_command_of_latex_is_left_in_the_text(site, pages):
    for page, found in pages.items():
        if page.parent.name == "mechanisms" or page.name == "lemmas.html":
            assert not SEPARATE.search("".join(found.text)), page


@pytest.mark.parametrize("name", [s.name for s in scripts.sources()])
def test_a_page_has_the_equations_of_the_article(site, name):
    article = (LATEX / f"{name}.tex").read_text("utf-8")
    page = (site / "mechanisms" / f"{name}.html").read_text("utf-8")
    labels = re.findall(rf"\\(?:label|longequation|matrixequation)\{{(eq:{name}:\d+)\}}", article)
    marks = [label.replace(":", "-") for label in labels]
    assert re.findall(rf'id="(eq-{name}-\d+)"', page) == marks
    for number in range(1, len(marks) + 1):
        assert f">({number})<" in page


@pytest.mark.parametrize("name", [s.name for s in scripts.sources()])
def test_a_page_has_the_verdicts_of_the_article(site, name):
    article = (LATEX / f"{name}.tex").read_text("utf-8")
    page = (site / "mechanisms" / f"{name}.html").read_text("utf-8")
    told = re.search(r"judged by computation: (.*?)\.\n", article)
    expected = Counter()
    for part in told[1].split(", ") if told else []:
        number, _, kind = part.partition(" ")
        expected[kind] = int(number)
    claims = page[page.find('id="claims-of-the-paper"') :] if told else ""
    shown = Counter(re.findall(r'<span class="verdict [a-z -]+">([a-z ]+)</span>', claims))
    assert shown == +expected


def test_works_are_cited_in_the_order_of_their_list() -> None:
    cited = Markdown({}, ["clavel", "merlet"]).cited("merlet,clavel")
    assert re.findall(r">(\d)<", cited) == ["1", "2"]
