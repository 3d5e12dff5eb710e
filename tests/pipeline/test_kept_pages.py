"""What was printed is printed again only if something that it depends on has changed."""

import os
import pickle
from pathlib import Path

import pytest
from derivations_for_tests import SLIDER

from closedform.emit.pages import Printed as Pages
from closedform.pipeline import folders, scripts
from closedform.pipeline import run as pipeline
from closedform.pipeline import store as stored
from closedform.pipeline.run import Printed
from closedform.pipeline.scripts import Source
from closedform.pipeline.store import Store


@pytest.fixture
def slider(tmp_path: Path) -> Source:
    path = tmp_path / "slider.py"
    path.write_text(SLIDER, "utf-8")
    return Source("slider", path)


@pytest.fixture
def store(tmp_path: Path) -> Store:
    return Store(tmp_path / "build" / "proofs")


@pytest.fixture
def loaded(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The names of the derivations that were loaded."""
    names: list[str] = []
    load = scripts.load

    def noted(source: Source) -> object:
        names.append(source.name)
        return load(source)

    monkeypatch.setattr(pipeline, "load", noted)
    return names


def printed(source: Source, store: Store, backends: tuple[str, ...] = ("numpy",)) -> Printed:
    [robot] = pipeline.run([source], backends, store=store).robots
    return robot


def test_nothing_is_loaded_if_nothing_has_changed(slider, store, loaded) -> None:
    first = printed(slider, store)
    again = printed(slider, store)
    assert loaded == ["slider"]
    assert again.stored and not first.stored
    assert (again.files, again.share, again.proof) == (first.files, first.share, first.proof)


def test_another_back_end_is_printed_without_a_new_proof(slider, store, loaded) -> None:
    printed(slider, store)
    other = printed(slider, store, ("c",))
    assert loaded == ["slider", "slider"]
    assert other.stored and all(path.parts[0] == "c" for path in other.files)


def test_a_changed_script_is_printed_again(slider, store) -> None:
    before = printed(slider, store).files
    slider.path.write_text(SLIDER.replace("[a + q1]", "[q1 + 2 * a - a + 1]"), "utf-8")
    after = printed(slider, store)
    assert after.files != before and not after.stored


def test_a_changed_toolkit_prints_again(slider, store, loaded, monkeypatch) -> None:
    printed(slider, store)
    monkeypatch.setattr(pipeline, "printing_digest", lambda derived: f"{derived} changed")
    assert printed(slider, store).stored
    assert loaded == ["slider", "slider"]


@pytest.mark.parametrize(
    "path", ["closedform/emit/text.py", "closedform/runtime/numpy/_runtime.py", "a_template"]
)
def test_the_digest_covers_the_toolkit(path: str, monkeypatch: pytest.MonkeyPatch) -> None:
    root = folders.checkout() or pytest.skip("the toolkit is installed from a wheel")
    file = root / (path if path != "a_template" else "templates/numpy/module.py.jinja")
    before = stored.printing_digest("derived")
    read = Path.read_bytes
    changed = os.path.realpath(file)

    def with_a_change(self: Path) -> bytes:
        return read(self) + (b"#" if os.path.realpath(self) == changed else b"")

    monkeypatch.setattr(Path, "read_bytes", with_a_change)
    assert stored.printing_digest("derived") != before


def test_the_digest_covers_the_derivation_and_the_tools(monkeypatch: pytest.MonkeyPatch) -> None:
    before = stored.printing_digest("derived")
    assert stored.printing_digest("derived otherwise") != before
    monkeypatch.setattr(stored, "version", lambda _: "0")
    assert stored.printing_digest("derived") != before


def test_a_file_that_is_cut_short_is_written_anew(slider, store, loaded) -> None:
    first = printed(slider, store)
    [file] = (store.folder.parent / "pages").iterdir()
    whole = file.read_bytes()
    file.write_bytes(whole[: len(whole) // 2])
    assert printed(slider, store).files == first.files
    assert loaded == ["slider", "slider"]
    assert file.read_bytes() == whole


def test_a_kept_file_of_another_form_is_ignored(slider, store, tmp_path: Path) -> None:
    pages = tmp_path / "build" / "pages"
    pages.mkdir(parents=True)
    (pages / "slider.numpy.pickle").write_bytes(pickle.dumps(("digest", "files", "share")))
    assert store.pages(slider, "digest", ("numpy",)) is None


def test_a_kept_file_cannot_run_code(slider, store, tmp_path: Path) -> None:
    class Hostile:
        def __reduce__(self) -> object:
            return os.mkdir, (str(tmp_path / "ran"),)

    pages = tmp_path / "build" / "pages"
    pages.mkdir(parents=True)
    (pages / "slider.numpy.pickle").write_bytes(pickle.dumps(("digest", Hostile())))
    assert store.pages(slider, "digest", ("numpy",)) is None
    assert not (tmp_path / "ran").exists()


def test_a_foreign_back_end_is_not_kept(slider, store) -> None:
    own = printed(slider, store)
    pages = Pages(own.files, own.share)
    for backends in (("numpy", "closedform.site.backend"), ("numpy", "theirs.backend")):
        store.put_pages(slider, "digest", backends, pages)
    assert store.pages(slider, "digest", ("numpy", "closedform.site.backend")) == pages
    assert store.pages(slider, "digest", ("numpy", "theirs.backend")) is None


def test_fresh_prints_again(slider, store, loaded) -> None:
    printed(slider, store)
    pipeline.run([slider], ("numpy",), store=store, fresh=True)
    assert loaded == ["slider", "slider"]
