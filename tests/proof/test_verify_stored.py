"""The certificates of stored proofs: verified, and noticed where changed or missing."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from derivations_for_tests import SLIDER

from closedform.cli.commands import main
from closedform.pipeline import run as pipeline
from closedform.pipeline import scripts
from closedform.pipeline.store import Store


@pytest.fixture
def kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A script that is proved, with its proof and its certificates in a store of its own."""
    script = tmp_path / "slider.py"
    script.write_text(SLIDER, "utf-8")
    store = Store(tmp_path / "proofs")
    for module in ("pipeline.run", "cli.commands"):
        monkeypatch.setattr(f"closedform.{module}.default_store", lambda: store)
    assert not pipeline.run(scripts.find([str(script)]), ("numpy",), store=store).failures
    return script


def edited(kept: Path, old: str, new: str, *, digest: bool) -> None:
    """Change the certificates of the script; ``digest``: and what the proof says about them."""
    path = kept.parent / "certificates" / "slider.json"
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new), "utf-8")
    if digest:
        proof = kept.parent / "proofs" / "slider.json"
        before, after = (hashlib.sha256(t.encode()).hexdigest() for t in (text, path.read_text()))
        assert before in proof.read_text()
        proof.write_text(proof.read_text().replace(before, after), "utf-8")


def test_stored_certificates_are_verified(kept: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert main(["verify", str(kept)]) == 0
    line = capsys.readouterr().out.split()
    assert line[:3] == ["slider", "1", "identities,"]


@pytest.mark.parametrize(
    ("old", "new", "digest"),
    [
        ('"zero": [0]', '"zero": [ 0]', False),
        ('"zero": [0]', '"zero": []', True),
        ('"slider"', '"other"', True),
        ('"identity"', '"proof"', True),
        ('"certificates": [', '"certificates": 3, "x": [', True),
        ('"digest": "', '"digest": "0', True),
        ("{", "", True),
    ],
)
def test_changed_certificates_fail(
    old: str, new: str, digest: bool, kept: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    edited(kept, old, new, digest=digest)
    assert main(["verify", str(kept)]) == 1
    assert "FAILED" in capsys.readouterr().out


def test_stale_and_missing_certificates_fail_and_are_written_again(
    kept: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = kept.parent / "certificates" / "slider.json"
    written = path.read_bytes()
    chosen, store = scripts.find([str(kept)]), Store(kept.parent / "proofs")
    for spoil in (path.unlink, lambda: path.write_bytes(written + b"\n")):
        spoil()
        assert main(["verify", str(kept)]) == 1
        (robot,) = pipeline.run(chosen, ("numpy",), store=store).robots
        assert not robot.stored and path.read_bytes() == written
        assert main(["verify", str(kept)]) == 0
    kept.write_text(SLIDER + "\n# edited\n", "utf-8")
    assert main(["verify", str(kept)]) == 1
    (kept.parent / "proofs" / "slider.json").unlink()
    assert main(["verify", str(kept)]) == 1


def test_an_inverse_of_a_proof_needs_a_certificate(kept: Path) -> None:
    path = kept.parent / "proofs" / "slider.json"
    proof = json.loads(path.read_text("utf-8"))
    proof["proof"]["inverses"] = [{"function": "ik", "branches": 2}]
    path.write_text(json.dumps(proof), "utf-8")
    assert main(["verify", str(kept)]) == 1
    edited(kept, '"inverses not exported": []', '"inverses not exported": ["ik"]', digest=True)
    assert main(["verify", str(kept)]) == 0


def test_the_same_proof_writes_the_same_bytes_whatever_the_hash_seed() -> None:
    """Also if it was proved before in the same process."""
    code = (
        "import sys\n"
        "from closedform.algebra.certificates import recording\n"
        "from closedform.pipeline import scripts\n"
        "from closedform.proof.prove import prove\n"
        "(source,) = scripts.find(['scara'])\n"
        "for _ in range(int(sys.argv[1])):\n"
        "    with recording() as record:\n"
        "        prove(scripts.load(source))\n"
        "print(record.text('name', 'digest'))\n"
    )
    runs = (("1", 1), ("2", 2))
    first, second = (
        subprocess.run(
            [sys.executable, "-c", code, str(times)],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            check=True,
        ).stdout
        for seed, times in runs
    )
    assert len(first) > 1000 and first == second
