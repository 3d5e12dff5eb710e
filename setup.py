"""The compiled part of the build: one extension module with all generated C.

A build may be killed at any time, and two may run at once.  So every file is made in a folder of
its own and then renamed, and a file that is there is used only if it was made from the same inputs
and is still as it was then.
"""

import hashlib
import os
import re
import shutil
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy
from setuptools import Extension, find_packages, setup
from setuptools.command.build_ext import build_ext

MAPPED = ("derivations", "generated", "templates")
"""Folders of the checkout that are packages below closedform."""
PACKAGES = [
    *find_packages(include=["closedform", "closedform.*"]),
    *(f"closedform.{folder}" for folder in MAPPED),
    *(f"closedform.{folder}.{name}" for folder in MAPPED for name in find_packages(folder)),
]
FOLDERS = (Path("closedform/runtime/extension"), Path("generated/c"))
SOURCES = sorted(str(path) for folder in FOLDERS for path in folder.glob("*.c"))
HEADERS = sorted(str(path) for folder in FOLDERS for path in folder.glob("*.h"))
# A wheel is for AVX-512, AVX2 and the baseline. What is built in place is for the processor at
# hand, in a third of the time. CLOSEDFORM_DISPATCH=1 builds for all, 0 for the baseline alone.
DISPATCH = os.environ.get("CLOSEDFORM_DISPATCH", "")
# CLOSEDFORM_COMPILE=0 installs the NumPy modules alone, where there is no compiler or no patience.
COMPILED = os.environ.get("CLOSEDFORM_COMPILE", "") != "0"
LEVELS = {
    "x86-64-v4": "AVX512F AVX512BW AVX512CD AVX512DQ AVX512VL AVX2 BMI2 FMA MOVBE",
    "x86-64-v3": "AVX AVX2 BMI BMI2 F16C FMA LZCNT MOVBE",
}
"""The processors for which gcc builds clones, and what they have."""


def headers_of(source):
    """The headers of a robot; none if the source is not that of a robot."""
    path = Path(source)
    headers = [path.with_suffix(".h"), path.with_name("closedform.h")]
    return headers if all(header.exists() for header in headers) else []


def read_by(source):
    """The files that decide whether a source has to be compiled again."""
    return [source, "setup.py", *map(str, headers_of(source) or HEADERS)]


def processor(compiler):
    """The first of the levels that this processor has, if the compiler is a gcc that knows them."""
    if not compiler:
        return ""
    ask = [*compiler, "-march=native", "-dM", "-E", "-x", "c", os.devnull]
    try:
        told = subprocess.run(ask, capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return ""
    macros = dict(re.findall(r"#define (\w+) (.*)", told))
    if "__clang__" in macros or int(macros.get("__GNUC__", 0)) < 12 or "__x86_64__" not in macros:
        return ""
    has = {name.strip("_") for name in macros}
    return next((level for level, needed in LEVELS.items() if has.issuperset(needed.split())), "")


def adapted(options, source, level, folder):
    """The options of the compiler, for a level of processors, for all of them or the baseline.

    Of a single level, gcc writes to ``folder`` which loops it vectorised, for the tests. It tells
    of each function only if equal ones are not merged.
    """
    if level and headers_of(source):
        report = f"-fopt-info-loop-vec-optimized={folder}/{Path(source).stem}.loops"
        flags = [f"-march={level}", "-fno-ipa-icf", report]
        return {**options, "extra_postargs": [*options["extra_postargs"], *flags]}
    macros = [("CLOSEDFORM_DISPATCH", None)] * (DISPATCH != "0")
    if level:
        macros.append(("CLOSEDFORM_PROCESSOR", f'"{level}"'))
    return {**options, "macros": [*options["macros"], *macros]}


def digest(files, *settings):
    """A digest of the content of files and of settings."""
    total = hashlib.sha256(repr(settings).encode())
    for path in files:
        total.update(hashlib.sha256(Path(path).read_bytes()).digest())
    return total.hexdigest()


def replace(target, content):
    """Write a small file under another name and rename it."""
    unfinished = Path(f"{target}.{os.getpid()}")
    unfinished.write_text(content, "utf-8")
    os.replace(unfinished, target)


class BuildExtension(build_ext):
    """Compiles what changed of the sources, side by side."""

    def finalize_options(self):
        super().finalize_options()
        self.only_here = bool(self.inplace) and not DISPATCH  # setuptools clears inplace to build
        if self.editable_mode:
            # make derives first and then builds in place: a checkout whose generated C is broken
            # must still install, to be able to mend it.
            self.extensions = []

    def build_extensions(self):
        # What has to be made is decided by content, below, and not by the times of files.
        self.everything, self.force = self.force, True
        compiler = self.compiler
        compile_in_turn, link_in_turn = compiler.compile, compiler.link_shared_object
        command = getattr(compiler, "compiler_so", ()) if self.only_here else ()
        level = processor(command)

        def compile_one(source, output_dir, options):
            options = adapted(options, source, level, self.build_temp)
            (target,) = compiler.object_filenames([source], output_dir=output_dir)
            settings = (numpy.__version__, getattr(compiler, "compiler_so", ""), options)
            self.make(
                target,
                digest(read_by(source), *settings),
                lambda folder: compile_in_turn([source], output_dir=folder, **options)[0],
            )
            return target

        def compile_side_by_side(sources, output_dir=None, **options):
            longest_first = sorted(sources, key=os.path.getsize, reverse=True)
            with ThreadPoolExecutor(os.cpu_count()) as pool:
                made = pool.map(lambda s: compile_one(s, output_dir, options), longest_first)
                objects = dict(zip(longest_first, made, strict=True))
            return [objects[source] for source in sources]

        def link(objects, target, **options):
            def linked(folder):
                finished = os.path.join(folder, os.path.basename(target))
                link_in_turn(objects, finished, **options)
                return finished

            settings = (getattr(compiler, "linker_so", ""), options)
            self.make(target, digest(objects, *settings), linked)

        compiler.compile, compiler.link_shared_object = compile_side_by_side, link
        super().build_extensions()

    def make(self, target, inputs, build):
        """Build a file, unless it was made from these inputs and is still whole."""
        record = Path(self.build_temp, f"{os.path.basename(target)}.made")
        try:
            whole = record.read_text("utf-8") == f"{inputs} {digest([target])}"
        except OSError:
            whole = False
        if whole and not self.everything:
            return
        os.makedirs(os.path.dirname(target), exist_ok=True)
        os.makedirs(self.build_temp, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix="unfinished-", dir=self.build_temp) as folder:
            finished = build(folder)
            made = digest([finished])
            shutil.move(finished, f"{target}.{os.getpid()}")
        os.replace(f"{target}.{os.getpid()}", target)
        replace(record, f"{inputs} {made}")

    def copy_file(self, infile, outfile, *arguments, **options):
        """Into the checkout, where a process may be using the file that is replaced."""
        if os.path.exists(outfile) and digest([outfile]) == digest([infile]):
            return outfile, False
        unfinished = f"{outfile}.{os.getpid()}.so"
        shutil.copy2(infile, unfinished)
        os.replace(unfinished, outfile)
        return outfile, True


setup(
    packages=PACKAGES,
    package_dir={f"closedform.{folder}": folder for folder in MAPPED},
    cmdclass={"build_ext": BuildExtension},
    ext_modules=[
        Extension(
            "closedform.generated.c._native",
            sources=SOURCES,
            depends=[*HEADERS, "setup.py"],
            include_dirs=[*map(str, FOLDERS), numpy.get_include()],
            define_macros=[("NPY_NO_DEPRECATED_API", "NPY_2_0_API_VERSION")],
            # errno of sqrt and floating-point traps are not used; without these two flags no loop
            # with a square root or a comparison becomes vector code. Fused multiply-adds, which
            # -std=c99 switches off, take a tenth to a third off a batch. Python's own flags bring
            # debug information, which nobody reads and which trebles the size.
            extra_compile_args=[
                "-std=c99",
                "-O3",
                "-g0",
                "-fno-math-errno",
                "-fno-trapping-math",
                "-ffp-contract=fast",
            ],
        )
    ]
    if COMPILED
    else [],
)
