"""Arms from tables, and the chains that are proposed for them, as the tests build them."""

from pathlib import Path
from typing import Any

import pytest
import sympy as sp

import closedform
from closedform.check.clibrary import CLibrary, compiler
from closedform.check.failures import UnavailableError
from closedform.check.runners.python import module
from closedform.emit.backend import Mechanism
from closedform.emit.backends import c, numpy
from closedform.lemmas.chain import Chain
from closedform.mechanics.arm import Serial, from_dh
from closedform.model.derivation import Derivation, Paper
from closedform.pipeline.run import write
from closedform.proof.prove import Proof
from closedform.scaffold.inputs.names import CHAIN, IMPORTED, LINKED


def arm(rows: list, joints: str = "t1 t2 t3 t4 t5 t6 t7", **angles: str) -> tuple:
    """An arm from rows of a, alpha and d, or of a, alpha, None and theta for a slide in d."""
    d = Derivation("arm", "Arm", Paper("toy", "Toys", ("A.",)), "An arm.")
    for name, value in angles.items():
        d.parameter(name, value=sp.Rational(value), unit="rad", meaning=name, nonnegative=False)
    table = []
    for name, row in zip(joints.split(), rows, strict=False):
        q = d.joint(name, "prismatic" if len(row) == 4 else "revolute")
        table.append((*row[:2], q, row[3]) if len(row) == 4 else (*row, q))
    return d, from_dh(d, table)


def solved(d: Derivation, arm: Serial, lines: str) -> Chain:
    """The chain that the lines build in a derivation, as a script that contains them does."""
    task = arm.coordinates()
    if task is not None:
        d.task = list(task.names)
    angles = ["yaw"] if task is not None and "yaw" in task.names else []
    ik = Chain(d, arm.pose if task is None else task.values, angles=angles)
    run(lines, ik)
    ik.finish("All solutions of the inverse kinematics.")
    return ik


def run(lines: str, ik: Chain) -> None:
    """Run the lines of a chain with the names that a script imports, joints and parameters."""
    known = {name: getattr(sp, name) for name in IMPORTED}
    known |= {name: getattr(closedform, name) for name in (*CHAIN, *LINKED)}
    known |= {symbol.name: symbol for symbol in (*ik.joints, *(p.symbol for p in ik.d.parameters))}
    exec(lines, known | {"ik": ik})


def printed(d: Derivation, folder: Path) -> Any:
    """The NumPy module of a derivation."""
    pages = numpy.BACKEND.pages(Mechanism(d, Proof(d.name, "own", (), 0, ()))).files
    write(folder, {**pages, **numpy.BACKEND.shared([])})
    return module(folder / "numpy", d.name)


def compiled(d: Derivation, folder: Path) -> CLibrary:
    """The C of a derivation, or a skipped test if there is no compiler."""
    pages = c.BACKEND.pages(Mechanism(d, Proof(d.name, "own", (), 0, ()))).files
    write(folder, {**pages, **c.BACKEND.shared([])})
    try:
        compiler()
    except UnavailableError as error:
        pytest.skip(str(error))
    return CLibrary(d, folder / "c", folder)


__all__ = ["arm", "compiled", "printed", "run", "solved"]
