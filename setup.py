"""The compiled part of the build: one extension module with all generated C."""

from pathlib import Path

import numpy
from setuptools import Extension, setup

SOURCES = sorted([*Path("closedform/extension").glob("*.c"), *Path("generated/c").glob("*.c")])
HEADERS = sorted([*Path("closedform/extension").glob("*.h"), *Path("generated/c").glob("*.h")])

setup(
    ext_modules=[
        Extension(
            "closedform.generated.c._native",
            sources=[str(p) for p in SOURCES],
            depends=[str(p) for p in HEADERS],
            include_dirs=["closedform/extension", "generated/c", numpy.get_include()],
            define_macros=[
                ("NPY_NO_DEPRECATED_API", "NPY_2_0_API_VERSION"),
                ("CLOSEDFORM_DISPATCH", None),
            ],
            # errno of sqrt and floating-point traps are not used; without these two flags no loop
            # with a square root or a comparison becomes vector code.
            extra_compile_args=["-std=c99", "-O3", "-fno-math-errno", "-fno-trapping-math"],
        )
    ]
)
