"""The compiled part of the build: one extension module with all generated C."""

import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy
from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

FOLDERS = (Path("closedform/extension"), Path("generated/c"))
SOURCES = sorted(str(path) for folder in FOLDERS for path in folder.glob("*.c"))
HEADERS = sorted(str(path) for folder in FOLDERS for path in folder.glob("*.h"))


class BuildExtension(build_ext):
    """Compiles the sources of the extension side by side."""

    def finalize_options(self):
        super().finalize_options()
        for extension in self.extensions:
            # A checkout whose generated C is broken must still install, to be able to mend it.
            extension.optional = self.editable_mode

    def build_extensions(self):
        compile_in_turn = self.compiler.compile

        def compile_side_by_side(sources, **options):
            with ThreadPoolExecutor(os.cpu_count()) as pool:
                compiled = pool.map(lambda source: compile_in_turn([source], **options), sources)
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
            define_macros=[
                ("NPY_NO_DEPRECATED_API", "NPY_2_0_API_VERSION"),
                ("CLOSEDFORM_DISPATCH", None),
            ],
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
