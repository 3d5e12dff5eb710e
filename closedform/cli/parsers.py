"""The options of the commands that have no module of their own."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from closedform.pipeline import run as pipeline

FILES = ("dh TABLE.csv", "screws FILE.toml", "urdf FILE.urdf", "mjcf FILE.xml", "loop FILE.toml")
"""The kinds of files that ``new`` reads."""
READ = f"{', '.join(FILES[:-1])} or {FILES[-1]}"


def list_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--robots", action="store_true", help="list the ready robots and their families"
    )
    parser.add_argument(
        "--sources", action="store_true", help="with --robots, also list where the numbers are from"
    )


def show_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", metavar="NAME", help="a derivation or the path of a script")
    parser.add_argument("--format", choices=("text", "latex"), default="text", help="default: text")


def derive_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("names", metavar="NAME", nargs="*", help="default: all derivations")
    parser.add_argument(
        "-o", "--output", metavar="DIR", type=Path, help="folder to write to; default: generated/"
    )
    parser.add_argument(
        "--backend",
        action="append",
        choices=pipeline.BACKENDS,
        help="can be repeated; default: all",
    )
    parser.add_argument(
        "--no-crosscheck",
        action="store_true",
        help="with -o, do not compare the printed code with the symbolic source",
    )
    parser.add_argument(
        "--timeout",
        metavar="SECONDS",
        type=_amount,
        default=0.0,
        help="computing time for each derivation, after which it is printed without an inverse; "
        "default: 0, no limit",
    )
    check_options(parser)


def check_options(parser: argparse.ArgumentParser) -> None:
    jobs_option(parser)
    parser.add_argument("--fresh", action="store_true", help="ignore stored proofs and pages")


def verify_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("names", metavar="NAME", nargs="*", help="default: all derivations")
    jobs_option(parser)


def jobs_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("-j", "--jobs", type=_positive, metavar="N", help="number of processes")


def new_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", metavar="NAME", help="name of the mechanism and of the script")
    parser.add_argument(
        "--from",
        dest="table",
        nargs=2,
        required=True,
        metavar=("KIND", "FILE"),
        help=READ,
    )
    parser.add_argument(
        "--base",
        metavar="LINK",
        default="",
        help="first link of a URDF or MJCF file; default: root",
    )
    parser.add_argument(
        "--tool", metavar="LINK", default="", help="last link of such a file; default: the only end"
    )
    parser.add_argument(
        "--ignore",
        metavar="LENGTH",
        type=_amount,
        default=0.0,
        help="in such a file, lengths up to this one count as 0",
    )
    parser.add_argument(
        "--hold",
        metavar="JOINT[=VALUE]",
        action="append",
        default=[],
        help="in such a file, a joint that becomes a parameter, 0 by default; can be repeated",
    )
    parser.add_argument(
        "--modified", action="store_true", help="the dh table is in Craig's (proximal) convention"
    )
    parser.add_argument(
        "--given",
        metavar="JOINT",
        default="",
        help="for 7 joints: the joint that is an input of the inverse, or arm_angle",
    )
    parser.add_argument(
        "--explain", action="store_true", help="say what was recognised and which chains were tried"
    )
    parser.add_argument(
        "--timeout",
        metavar="SECONDS",
        type=_amount,
        default=60.0,
        help="computing time, after which the script is written with what was found; 0: no limit; "
        "default: 60",
    )
    parser.add_argument(
        "-o", "--output", metavar="DIR", type=Path, default=Path(), help="default: current folder"
    )


def figures_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "names",
        metavar="NAME",
        nargs="*",
        help="mechanisms that closedform list names, or NumPy modules that derive printed, such as "
        "out/numpy/my_arm.py; default: all mechanisms",
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="DIR",
        type=Path,
        help="for pdf files and their captions; default: build/figures, or the folder of the "
        "article of a mechanism of yours, such as out/latex",
    )
    parser.add_argument(
        "--docs",
        metavar="DIR",
        type=Path,
        help="also write the page figures.md and its drawings here",
    )


def errata_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "paper",
        metavar="PAPER",
        nargs="?",
        help="the key of a paper, such as reddy-babu; default: all papers",
    )
    parser.add_argument(
        "--format",
        choices=("text", "markdown"),
        help="text for the terminal, or Markdown; default: text on a terminal, else Markdown",
    )


def _positive(text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        value = 0
    if value < 1:
        raise argparse.ArgumentTypeError(f"it must be a whole number of 1 or more, not {text!r}")
    return value


def _amount(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 <= value < math.inf:
        raise argparse.ArgumentTypeError(f"it must be a number of 0 or more, not {text!r}")
    return value
