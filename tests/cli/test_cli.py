"""The command line, from listing to an edited derivation, and the examples of the README."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from derivations_for_tests import SLIDER
from places import ROOT

from closedform.check.finding import Finding
from closedform.cli import console
from closedform.cli.commands import main
from closedform.pipeline import folders, scripts
from closedform.pipeline import run as pipeline
from closedform.pipeline.imports import package, sources_of
from closedform.pipeline.store import Store, default_store

README = ROOT / "README.md"
GUIDE = README.parent / "docs" / "using.md"
pytestmark = pytest.mark.usefixtures("compiled_quickly")

CLAIM = """
from closedform.proof.checks.statements import Enumeration
d.claim("table", "{four} edges", lambda n: Enumeration(n, lambda: {}[3], "edges"))
"""
WRONG_SIGN = """
from closedform import Gravity, Notation
names = Notation({"a": a, "q_1": q1, "x": a + q1})
d.claim("eq. (1)", "$x = a - q_1$", notation=names{erratum})
"""
ERRATUM = """
d.erratum("sign", "A sign is wrong", Gravity.MOTION, why="A sum.", use="It is off by $2 q_1$.")
"""


@pytest.fixture(autouse=True)
def no_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep stderr independent of the time that a command takes."""
    monkeypatch.setattr("closedform.cli.console.PATIENCE", float("inf"))


@pytest.fixture
def slider(tmp_path: Path) -> Path:
    path = tmp_path / "slider.py"
    path.write_text(SLIDER, "utf-8")
    return path


@pytest.fixture
def only_planar(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A repository with one robot and a copy of the generated files; stored proofs are used."""
    (planar,) = scripts.find(["planar_2r"])
    store = default_store()
    monkeypatch.setattr(scripts, "sources", lambda: [planar])
    for module in ("pipeline.run", "cli.commands"):
        monkeypatch.setattr(f"closedform.{module}.default_store", lambda: store)
    folder = tmp_path / "generated"
    printed = pipeline.run([planar]).files
    pipeline.write(folder, printed)
    monkeypatch.setattr(folders, "generated", lambda: folder)
    monkeypatch.setattr(folders, "checkout", lambda: tmp_path)
    return folder


def times(folder: Path) -> dict[Path, int]:
    return {path: path.stat().st_mtime_ns for path in folder.rglob("*") if path.is_file()}


def test_list_names_every_derivation(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list"]) == 0
    names = [line.split()[0] for line in capsys.readouterr().out.splitlines()]
    assert names == sorted(names)
    assert {"planar_2r", "spherical_wrist"} <= set(names)
    assert "papers" not in names


@pytest.mark.parametrize("command", ["show", "derive"])
def test_an_unknown_name_gets_a_suggestion(
    command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([command, "planar2r"]) == 2
    assert "did you mean planar_2r" in capsys.readouterr().err
    assert main([command, "xyz"]) == 2
    assert "known: " in capsys.readouterr().err


def test_a_wrong_call_has_exit_code_2() -> None:
    for arguments in ([], ["derive", "--backend", "fortran"], ["derive", "-j", "0"]):
        with pytest.raises(SystemExit) as stop:
            main(arguments)
        assert stop.value.code == 2


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["check", "-j", "0"], "it must be a whole number of 1 or more, not '0'"),
        (["check", "-j", "two"], "it must be a whole number of 1 or more, not 'two'"),
        (["derive", "--timeout", "-3"], "it must be a number of 0 or more, not '-3'"),
        (["derive", "--timeout", "soon"], "it must be a number of 0 or more, not 'soon'"),
    ],
)
def test_a_wrong_number_is_told_in_words(
    arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        main(arguments)
    assert said in capsys.readouterr().err


def test_options_without_an_effect_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list", "--sources"]) == 2
    assert "--sources is for --robots" in capsys.readouterr().err


def test_a_missing_script_is_told_without_a_list(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["show", "missing/arm.py"]) == 2
    assert capsys.readouterr().err.strip() == "closedform: there is no file missing/arm.py"


def test_no_claims_are_told(slider: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["claims", str(slider)]) == 0
    assert "slider has no claims" in capsys.readouterr().out


def test_show_prints_text_and_latex(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["show", "planar_2r"]) == 0
    assert "Planar 2R arm" in capsys.readouterr().out
    assert main(["show", "planar_2r", "--format", "latex"]) == 0
    assert r"\begin{document}" in capsys.readouterr().out


def test_a_script_outside_the_repository_is_derived(
    slider: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "deep" / "out"
    assert main(["derive", str(slider)]) == 2
    assert "-o DIR" in capsys.readouterr().err
    assert main(["derive", str(slider), "-o", str(output)]) == 0
    assert capsys.readouterr().out.startswith("slider  1 steps (1 identities)")
    assert not (output / "c" / "extension.c").exists()
    done = subprocess.run(
        [sys.executable, "-c", "from out.numpy import slider; print(slider.fk([0.5]))"],
        cwd=output.parent,
        env={**os.environ, "PYTHONPATH": str(output.parent)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == "[2.5]\n"
    before = times(output)
    assert main(["derive", str(slider), "-o", str(output)]) == 0
    assert times(output) == before


def test_backends_are_chosen(slider: Path, tmp_path: Path) -> None:
    output = tmp_path / "out"
    assert main(["derive", str(slider), "-o", str(output), "--backend", "c"]) == 0
    assert sorted(path.name for path in output.iterdir()) == ["c", "slider-crosscheck.md"]
    c = sorted(path.name for path in (output / "c").iterdir())
    own = {f"slider{end}" for end in (".c", ".h", ".hpp", "_nearest.h")}
    shared = {
        "CMakeLists.txt",
        "closedform-config.cmake.in",
        "closedform.h",
        "closedform_nearest.h",
    }
    assert {"slider.c", "slider.h"} | shared - {"closedform_nearest.h"} <= set(c) <= own | shared


def test_what_is_printed_elsewhere_is_cross_checked(slider: Path, tmp_path: Path) -> None:
    """Writes a page with the findings and leaves the installation as it is."""
    root = Path(pipeline.__file__).parents[1]
    watched = [root / name for name in ("closedform", "derivations", "generated", "templates")]
    before = [{p: t for p, t in times(f).items() if p.suffix != ".pyc"} for f in watched]
    output = tmp_path / "out"
    assert main(["derive", str(slider), "-o", str(output)]) == 0
    page = (output / "slider-crosscheck.md").read_text("utf-8")
    assert "| fk | ulp |" in page and "Nothing exceeds its tolerance." in page
    after = [{p: t for p, t in times(f).items() if p.suffix != ".pyc"} for f in watched]
    assert before == after
    assert main(["derive", str(slider), "-o", str(output / "2"), "--no-crosscheck"]) == 0
    assert not (output / "2" / "slider-crosscheck.md").exists()


def test_a_difference_found_by_the_cross_check_fails(
    slider: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch
) -> None:
    """The page says what differs, and so does the command."""
    from closedform.cli import commands as cli

    write = cli._write

    def spoiled(root: Path, printed: pipeline.Files) -> list[Path]:
        path = Path("numpy/slider.py")
        if path in printed:
            assert "q1 + a," in printed[path]
            printed[path] = printed[path].replace("q1 + a,", "q1 - a,")
        return write(root, printed)

    monkeypatch.setattr(cli, "_write", spoiled)
    output = tmp_path / "out"
    assert main(["derive", str(slider), "-o", str(output), "--backend", "numpy"]) == 1
    assert "slider: the generated code differs from its symbolic source" in capsys.readouterr().err
    assert "ulp" in (output / "slider-crosscheck.md").read_text("utf-8")


def test_what_single_precision_cannot_do_is_told(
    slider: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch
) -> None:
    """The code is printed, and the command succeeds."""
    from closedform.check import report

    lost = Finding("slider", "ik", "c float", limits=["x is lost"])
    monkeypatch.setattr(report, "crosscheck", lambda *_: [lost])
    output = tmp_path / "out"
    assert main(["derive", str(slider), "-o", str(output), "--backend", "numpy"]) == 0
    page = (output / "slider-crosscheck.md").read_text("utf-8")
    assert "digits of single" in page and "x is lost" in page
    told = f"suffice for some targets; see {output}"
    assert told in capsys.readouterr().err


def test_a_broken_neighbour_does_not_hold_up_a_robot(
    only_planar: Path,
    slider: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    (planar,) = scripts.sources()
    slider.write_text(SLIDER.replace("(q1 + a, a + q1)", "(q1 - a, a + q1)"), "utf-8")
    broken = scripts.Source("slider", slider)
    monkeypatch.setattr(scripts, "sources", lambda: [planar, broken])
    target = only_planar / "numpy" / "planar_2r.py"
    whole = target.read_text("utf-8")
    target.write_text("stale", "utf-8")
    shared = only_planar / "c" / "extension.c"
    shared.write_text("as it was", "utf-8")
    assert main(["derive", "planar_2r"]) == 0
    printed = capsys.readouterr()
    assert printed.out.startswith("planar_2r")
    assert "warning: slider: not proved: step 'Position'" in printed.err
    assert "the files that all robots share were not changed" in printed.err
    assert target.read_text("utf-8") == whole
    assert shared.read_text("utf-8") == "as it was"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("(q1 + a, a + q1)", "(q1 - a, a + q1)", "slider: not proved: step 'Position'"),
        ("value=2", "value=2.5", "slider: slider.py, line 8: TypeError: "),
        ("[a + q1]})", "[a + 0.5*q1]})", "slider: "),
        ('"slider",', '"sledge",', "slider: the derivation calls itself sledge"),
        ("[a + q1]})", "[a + q1]})\nd = 3", "slider: slider.py must assign a Derivation to d"),
        ("import sympy", "import simpy", "slider: slider.py, line 3: ModuleNotFoundError"),
        ("[a + q1]", "[a + q1", "slider: SyntaxError"),
        ("[a + q1]})", f"[a + q1]}}){CLAIM}", "slider: not proved: claim table: KeyError: 3"),
    ],
)
def test_a_broken_derivation_gets_one_clear_line(
    slider: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, message: str
) -> None:
    assert old in SLIDER
    slider.write_text(SLIDER.replace(old, new), "utf-8")
    assert main(["derive", str(slider), "-o", str(slider.parent / "out")]) == 1
    error = capsys.readouterr().err
    assert error.startswith(f"closedform: {message}")
    assert "Traceback" not in error
    assert not (slider.parent / "out").exists()


def test_a_wrong_sign_in_a_transcription_is_one_clear_line(
    slider: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    slider.write_text(SLIDER + WRONG_SIGN.replace("{erratum}", ""), "utf-8")
    assert main(["derive", str(slider), "-o", str(slider.parent / "out")]) == 1
    error = capsys.readouterr().err
    assert "slider: not proved: claim eq. (1): the verdict is refuted (at $a = 1$" in error
    assert "name the erratum" in error and "Traceback" not in error


def test_an_error_of_the_paper_is_listed_and_counted(
    slider: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = WRONG_SIGN.replace("{erratum}", ', erratum="sign"')
    slider.write_text(SLIDER + text + ERRATUM, "utf-8")
    out = slider.parent / "out"
    assert main(["derive", str(slider), "-o", str(out), "--backend", "latex"]) == 0
    assert "claims: 1 refuted" in capsys.readouterr().out
    errata = (out / "errata.md").read_text("utf-8")
    assert "#### 1. A sign is wrong" in errata and "It is off by $`2 q_1`$." in errata
    assert "refuted: at $`a = 1`$, $`q_1 = 1`$: $`x`$ is $`2`$, but $`a - q_1`$ is $`0`$" in errata
    article = (out / "latex" / "slider.tex").read_text("utf-8")
    assert r"\section{Errata}" in article


CHANGED = """
d.claim("two", "$x = a + q_1$", notation=names, readings=[Reading("one"), Reading("other")])
d.claim("weak", "{four} edges", lambda n: Enumeration(1, lambda: 1, "one"))
d.claim("strict", "{four} edges", lambda n: 1 // (5 - n), fixed="it has a reason")
from closedform import Enumeration, Reading
"""


def test_claims_are_judged_and_changed(slider: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = WRONG_SIGN.replace("{erratum}", ', erratum="sign", corrected="$x = a + q_1$"')
    head, _, imported = CHANGED.strip().rpartition("\n")
    slider.write_text(SLIDER + text + ERRATUM + f"{imported}\n{head}\n", "utf-8")
    assert main(["claims", str(slider)]) == 0
    told = capsys.readouterr().out
    assert "eq. (1): refuted: at a = 1" in told
    assert "    holds instead: x = a + q_1" in told
    assert "    reading: other: proved\n" in told
    assert "strict: AttributeError" in told
    assert main(["claims", str(slider), "--only", "nowhere"]) == 0
    assert "no claim of slider has 'nowhere' in its label" in capsys.readouterr().out
    assert main(["claims", str(slider), "--only", "weak", "--mutate"]) == 0
    told = capsys.readouterr().out
    assert "eq. (1)" not in told
    assert "    survives: phrase four -> five: proved" in told
    assert "    cannot be changed: NO REASON IS GIVEN" in told


def test_claims_beside_the_text_of_the_paper(
    slider: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (planar,) = scripts.find(["planar_2r"])  # of all derivations, one of another paper
    monkeypatch.setattr(scripts, "sources", lambda: [planar])
    text = WRONG_SIGN.replace("{erratum}", ', erratum="sign"')
    slider.write_text(SLIDER + text + ERRATUM, "utf-8")
    paper = slider.parent / "paper.txt"
    paper.write_text("$x = a - q_1$\n\nThe slider moves along the axis of x.\n", "utf-8")
    assert main(["claims", str(slider), "--paper", str(paper)]) == 0
    told = capsys.readouterr().out
    assert "line 3: The slider moves along the axis of x." in told
    assert "passages not covered: 1, quotations not found: 0" in told


def test_an_output_folder_that_cannot_be_made(
    slider: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["derive", str(slider), "-o", str(slider / "out"), "--backend", "numpy"]) == 1
    assert "cannot write to" in capsys.readouterr().err


def test_a_proof_is_kept_until_something_it_depends_on_changes(
    slider: Path, tmp_path: Path
) -> None:
    (tmp_path / "lengths.py").write_text("OFFSET = 2\n", "utf-8")
    slider.write_text(SLIDER.replace("import sympy", "import lengths\nimport sympy"), "utf-8")
    store = Store(tmp_path / "proofs")
    chosen = scripts.find([str(slider)])

    def kept(**options: bool) -> bool:
        (robot,) = pipeline.run(chosen, ("numpy",), store=store, **options).robots
        return robot.stored

    assert not kept()
    assert kept()
    assert not kept(fresh=True)
    (tmp_path / "lengths.py").write_text("OFFSET = 3\n", "utf-8")
    assert not kept()
    (tmp_path / "proofs" / "slider.json").write_text("{", "utf-8")
    assert not kept()


def test_the_digest_of_a_proof_holds_what_is_run() -> None:
    """The digest covers every module of ours that a derivation and its proof load."""
    code = (
        "import sys, closedform.derivations.ur_arm, closedform.proof.prove;"
        "print(*(m.__file__ for n, m in sys.modules.items() if n.startswith('closedform')))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    (source,) = scripts.find(["ur_arm"])
    read = sources_of([source.path, package() / "proof" / "prove.py"])
    assert {Path(name) for name in done.stdout.split()} <= set(read)
    rooms = {path.relative_to(package()).parts[0] for path in read if package() in path.parents}
    assert not rooms & {"emit", "lower", "check", "scaffold", "pipeline", "cli"}


def test_processes_print_the_same(slider: Path, tmp_path: Path) -> None:
    other = tmp_path / "sledge.py"
    other.write_text(SLIDER.replace('"slider"', '"sledge"'), "utf-8")
    chosen = scripts.find([str(slider), str(other)])
    reports: list[str] = []
    results = [
        pipeline.run(
            chosen,
            store=Store(None),
            jobs=jobs,
            report=lambda name, what: reports.append(name),
        )
        for jobs in (1, 2)
    ]
    assert results[0].files == results[1].files
    assert {"slider", "sledge"} <= set(reports)


def test_check_finds_every_kind_of_difference(
    only_planar: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check"]) == 0
    (only_planar / "numpy" / "planar_2r.py").write_text("edited\n", "utf-8")
    (only_planar / "c" / "planar_2r.h").unlink()
    (only_planar / "latex" / "old_robot.tex").write_text("", "utf-8")
    (only_planar / "c" / "_native.so").write_text("", "utf-8")
    capsys.readouterr()
    assert main(["check"]) == 1
    output = capsys.readouterr()
    found = [line.split(":")[0] for line in output.out.splitlines() if str(only_planar) in line]
    assert found == ["missing", "differs", "extra"]
    assert "-edited" in output.out
    assert "run make" in output.err


def test_derive_mends_the_generated_folder(
    only_planar: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = times(only_planar)
    stale = only_planar / "numpy" / "old_robot.py"
    stale.write_text("", "utf-8")
    (only_planar / "c" / "planar_2r.c").write_text("edited\n", "utf-8")
    assert main(["derive"]) == 0
    told = capsys.readouterr().err
    assert f"changed in {only_planar}: c/planar_2r.c, numpy/old_robot.py\n" in told
    assert not stale.exists()
    after = times(only_planar)
    assert {path for path in before if after[path] != before[path]} == {
        only_planar / "c" / "planar_2r.c"
    }
    assert main(["check"]) == 0


def test_errata_of_all_papers_and_of_one(
    only_planar: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Markdown goes to files, and text to terminals."""
    assert main(["errata"]) == 0
    everything = capsys.readouterr().out
    assert everything == (only_planar / "errata.md").read_text("utf-8")
    assert main(["errata", "reddy-babu"]) == 0
    assert capsys.readouterr().out == everything
    assert main(["errata", "--format", "text"]) == 0
    text = capsys.readouterr().out
    assert text == (only_planar / "errata.txt").read_text("utf-8")
    assert main(["errata", "reddy-babu", "--format", "text"]) == 0
    assert capsys.readouterr().out == text
    monkeypatch.setattr(console, "is_terminal", lambda: True)
    assert main(["errata"]) == 0
    assert capsys.readouterr().out == text
    assert main(["errata", "--format", "markdown"]) == 0
    assert capsys.readouterr().out == everything
    assert main(["errata", "reddy"]) == 2
    assert "did you mean reddy-babu?" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("flags", "jobs"),
    [
        *((flags, os.cpu_count()) for flags in ("", "-j", "-n", "k --jobserver-auth=3,4")),
        *((" -j1", 1), (" -j2 --jobserver-auth=3,4", 2), ("k -j83", 83)),
    ],
)
def test_make_decides_how_many_processes(
    monkeypatch: pytest.MonkeyPatch, flags: str, jobs: int
) -> None:
    monkeypatch.setenv("MAKELEVEL", "1")
    monkeypatch.setenv("MAKEFLAGS", flags)
    assert pipeline.default_jobs() == jobs
    monkeypatch.delenv("MAKELEVEL")
    assert pipeline.default_jobs() == os.cpu_count()


def blocks(language: str, page: Path = README) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", page.read_text("utf-8"), re.M | re.S)


def test_the_python_examples_run() -> None:
    (short,), (long, *_) = blocks("python"), blocks("python", GUIDE)
    for code in (short, long):
        done = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True
        )
        assert "'elbow_up': [0.3, -1.1]" in done.stdout


def test_the_robots_of_the_guide_move() -> None:
    _, code, _ = blocks("python", GUIDE)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "branch changes: [] jumps: []" in done.stdout and "True [" in done.stdout


def test_the_plots_of_the_guide_are_drawn(tmp_path: Path) -> None:
    *_, code = blocks("python", GUIDE)
    env = os.environ | {"MPLBACKEND": "Agg"}
    subprocess.run([sys.executable, "-c", code], cwd=tmp_path, env=env, check=True)
    assert (tmp_path / "singularities.svg").read_text("utf-8").startswith("<?xml")


def test_the_c_example_of_the_readme_runs(tmp_path: Path) -> None:
    compiler = shutil.which("cc") or pytest.skip("there is no C compiler")
    (code,) = blocks("c")
    (tmp_path / "main.c").write_text(code, "utf-8")
    for name in ("closedform.h", "planar_2r.h", "planar_2r.c"):
        shutil.copy(folders.generated() / "c" / name, tmp_path)
    (line,) = blocks("bash")
    command = shlex.split(line)
    assert command[0] == "cc" and "-lm" in command
    subprocess.run([compiler, *command[1:]], cwd=tmp_path, check=True)
    done = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True)
    assert len(done.stdout.splitlines()) == 2


def test_the_javascript_example_of_the_guide_runs(tmp_path: Path) -> None:
    node = shutil.which("node") or pytest.skip("Node is not installed")
    (code,) = blocks("js", GUIDE)
    (tmp_path / "main.mjs").write_text(code, "utf-8")
    package = tmp_path / "node_modules" / "closedform"
    shutil.copytree(folders.generated() / "js", package)
    run = [node, str(tmp_path / "main.mjs")]
    done = subprocess.run(run, capture_output=True, text=True, check=True)
    assert "elbow_up [ 0." in done.stdout and "Uint8Array(6) [ 0, 0" in done.stdout


def test_the_commands_of_the_guide_run(
    only_planar: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    (commands,) = blocks("sh", GUIDE)
    monkeypatch.chdir(tmp_path)
    for line in commands.splitlines():
        program, *arguments = shlex.split(line)
        assert program == "closedform"
        assert main(arguments) == 0, capsys.readouterr().err
    assert (tmp_path / "my_robots" / "c" / "planar_2r.c").is_file()


def test_the_readme_lists_every_mechanism_with_its_picture() -> None:
    text = README.read_text("utf-8")
    for source in scripts.sources():
        name = source.name
        row = f"| ![{name}](docs/figures/{name}.svg) | [`{name}`](derivations/{name}.py) |"
        assert row in text


def test_the_commands_for_figures_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (commands,) = blocks("sh", README.parent / "docs" / "figures.md")
    monkeypatch.chdir(tmp_path)
    for line in commands.splitlines():
        program, *arguments = shlex.split(line)
        assert program == "closedform" and main(arguments) == 0
        assert (tmp_path / arguments[-1]).stat().st_size


@pytest.mark.parametrize("command", ["derive", "show", "claims"])
def test_a_table_is_not_a_script(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = tmp_path / "crane.csv"
    table.write_text("a, alpha, d, theta\n", "utf-8")
    assert main([command, str(table)]) == 2
    assert "crane.csv is not a script; write one from it: closedform new NAME" in (
        capsys.readouterr().err
    )
