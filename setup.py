"""The compiled part of the build: one extension module with all generated C."""

import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy
from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext
from setuptools.modified import newer_group

FOLDERS = (Path("closedform/extension"), Path("generated/c"))
SOURCES = sorted(str(path) for folder in FOLDERS for path in folder.glob("*.c"))
HEADERS = sorted(str(path) for folder in FOLDERS for path in folder.glob("*.h"))
# For AVX-512, AVX2 and the baseline; with CLOSEDFORM_DISPATCH=0 for the baseline alone.
DISPATCH = [("CLOSEDFORM_DISPATCH", None)] * (os.environ.get("CLOSEDFORM_DISPATCH") != "0")


def read_by(source):
    """The files that decide whether a source has to be compiled again."""
    path = Path(source)
    headers = [path.with_suffix(".h"), path.with_name("closedform.h")]
    robot = all(header.exists() for header in headers) and path.stem != "closedform"
    return [source, "setup.py", *(map(str, headers) if robot else HEADERS)]


class BuildExtension(build_ext):
    """Compiles what changed of the sources, side by side."""

    def finalize_options(self):
        super().finalize_options()
        if self.editable_mode:
            # make derives first and then builds in place: a checkout whose generated C is broken
            # must still install, to be able to mend it.
            self.extensions = []

    def build_extensions(self):
        compile_in_turn = self.compiler.compile

        def compile_one(source, output_dir, **options):
            made = self.compiler.object_filenames([source], output_dir=output_dir)
            if newer_group(read_by(source), made[0]):
                compile_in_turn([source], output_dir=output_dir, **options)
            return made

        def compile_side_by_side(sources, output_dir=None, **options):
            with ThreadPoolExecutor(os.cpu_count()) as pool:
                compiled = pool.map(lambda s: compile_one(s, output_dir, **options), sources)
                return [name for names in compiled for name in names]

        self.compiler.compile = compile_side_by_side
        super().build_extensions()


setup(
    cmdclass={"build_ext": BuildExtension},
    ext_modules=[
        Extension(
            "closedform.generated.c._native",
            sources=SOURCES,
            depends=[*HEADERS, "setup.py"],
            include_dirs=[*map(str, FOLDERS), numpy.get_include()],
            define_macros=[("NPY_NO_DEPRECATED_API", "NPY_2_0_API_VERSION"), *DISPATCH],
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
    ],
)
