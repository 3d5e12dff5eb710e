# make help lists the targets. make -j N proves N robots at a time, make alone one for each core.

ifndef PYTHON
PYTHON := $(shell for p in python3 python3.14 python3.13 python3.12 python3.11; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)
endif
BIN := .venv/bin
export PIP_DISABLE_PIP_VERSION_CHECK := 1

# If the environment forbids bytecode beside the sources, it is kept in build/.  Without any, each
# process that starts compiles SymPy again, which takes longer than most tests.
ifdef PYTHONDONTWRITEBYTECODE
unexport PYTHONDONTWRITEBYTECODE
export PYTHONPYCACHEPREFIX := $(CURDIR)/build/bytecode
endif

DERIVING := $(shell find closedform derivations templates -name '*.py' -o -name '*.jinja' \
	-o -path 'closedform/runtime/*' -type f ! -name '*.pyc')
PRINTED := $(shell find generated -type f ! -name '*.so' ! -path '*/__pycache__/*')
PORTABLE := $(filter-out generated/c/extension.c,$(wildcard generated/c/*.c))
ARTICLES := $(filter-out generated/latex/closedform.tex,$(wildcard generated/latex/*.tex))
PDFS := $(patsubst generated/latex/%.tex,build/pdf/%.pdf,$(ARTICLES))
TEX_NEEDED := texlive-latex-recommended texlive-fonts-recommended lmodern
COMPILERS := $(foreach cc,gcc clang,$(foreach type,double float,warnings-$(cc)-$(type)))
WARNINGS := -std=c99 -pedantic -Wall -Wextra -Wconversion -Wdouble-promotion -Wshadow -Werror

# Two makes at once take turns wherever one writes: the second finds everything done.
define LOCK
import fcntl, os, sys
lock = os.open(sys.argv[1], os.O_RDWR | os.O_CREAT)
try:
    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
except OSError:
    print("waiting for another make", file=sys.stderr, flush=True)
    fcntl.flock(lock, fcntl.LOCK_EX)
os.set_inheritable(lock, True)
os.execvp(sys.argv[2], sys.argv[2:])
endef
# If venv or pip was killed, the environment is made anew; if pip fails, it is kept.
define INSTALL
set -e
for file in pyproject.toml setup.py; do
    [ .venv/$$EXTRA.stamp -nt $$file ] || stale=1
done
[ "$$stale" ] || exit 0
[ ! -e .venv/unfinished ] || rm -rf .venv
mkdir -p .venv
touch .venv/unfinished
echo "installing what $$EXTRA needs into .venv"
[ -x $(BIN)/python ] || $(PYTHON) -m venv .venv
status=0
$(BIN)/python -m pip install --quiet --no-compile --editable ".[$$EXTRA]" || status=$$?
[ $$status -gt 128 ] || rm .venv/unfinished
[ $$status = 0 ] || exit $$status
touch .venv/$$EXTRA.stamp
endef
export LOCK INSTALL
LOCKED = mkdir -p build && $(PYTHON) -c "$$LOCK" build/make.lock

.PHONY: all native test check verify lint types regenerated warnings analysed \
	portability $(COMPILERS) format figures pdf book notebooks site bench fuzz accuracy clean distclean help
.DELETE_ON_ERROR:

all: native  ## derive, prove, generate and build; prints a line for each robot (the default)
	@cat build/derived.txt

# make.stamp: what the build needs; dev.stamp: that and what tests, lint, figures and the site need.
.venv/%.stamp: pyproject.toml setup.py
	@test -n "$(PYTHON)" || { echo "closedform needs Python 3.11 or later: make PYTHON=..."; exit 1; }
	@$(LOCKED) env EXTRA=$* sh -c "$$INSTALL"

.venv/dev.stamp: | .venv/make.stamp

# The list of what was proved. Only files in generated/ that change are written. The C that is there
# is compiled meanwhile, because most of it stays; what fails is compiled, and told of, by native.
define DERIVE
$(BIN)/python setup.py --quiet build_ext --inplace >build/early.txt 2>&1 & compiling=$$!
trap 'kill $$compiling 2>/dev/null' INT TERM
$(BIN)/closedform derive >build/derived.new || { status=$$?; kill $$compiling 2>/dev/null; exit $$status; }
wait $$compiling
mv build/derived.new build/derived.txt
endef
export DERIVE
build/derived.txt: .venv/make.stamp $(DERIVING) $(PRINTED)
	@$(LOCKED) sh -c "$$DERIVE"

# setup.py compares contents, so nothing is compiled twice; the check takes less than a second.
native: build/derived.txt
	@$(LOCKED) $(BIN)/python setup.py --quiet build_ext --inplace

# One process more than there are cores: tests of the site, of Dask and of several builds wait.
test: all .venv/dev.stamp  ## run the tests on all cores; ARGS="-k NAME" selects some
	$(BIN)/python -m pytest -n $$(($$(getconf _NPROCESSORS_ONLN) + 1)) --dist worksteal $(ARGS)

verify: all  ## check the certificates of all proofs, without the prover
	@$(BIN)/closedform verify

# Nothing here may depend on all: it would overwrite the differences that check has to find.
check: lint types regenerated warnings  ## lint, types, C warnings; whether generated/ is up to date

lint: .venv/dev.stamp  ## check style and layers of the Python
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports --no-logo

types: .venv/dev.stamp  ## check the types of the toolkit
	$(BIN)/mypy

regenerated: .venv/dev.stamp
	$(BIN)/closedform check

warnings: $(COMPILERS)

# Optimised, because a compiler without optimisation misses some uses of unset variables.
$(filter %-float,$(COMPILERS)): FLOAT := -DCLOSEDFORM_FLOAT
$(COMPILERS): warnings-%:
	@compiler=$(firstword $(subst -, ,$*)); \
	command -v $$compiler >/dev/null || { echo "$@: skipped, $$compiler is not installed"; exit 0; }; \
	for source in $(PORTABLE); do \
		$$compiler $(WARNINGS) $(FLOAT) -O1 -c -o /dev/null $$source || exit 1; done; \
	echo "$@: clean"

# Not checked: neighbouring parameters of one type, because kernels take them; products of small
# constants as sizes; the leading underscore of NumPy's macros; memcpy, because C99 has no substitute.
TIDY := -*,bugprone-*,clang-analyzer-*,portability-*,-bugprone-easily-swappable-parameters,$\
-bugprone-implicit-widening-of-multiplication-result,-bugprone-reserved-identifier,$\
-clang-analyzer-security.insecureAPI.DeprecatedOrUnsafeBufferHandling

ANALYSED := $(PORTABLE)

analysed:  ## run cppcheck and clang-tidy on the C, if installed; ANALYSED="FILE..." selects some
	@if command -v cppcheck >/dev/null; then \
		cppcheck --quiet -j "$$(getconf _NPROCESSORS_ONLN)" --std=c99 --enable=warning,performance,portability --error-exitcode=1 \
			--suppress=missingIncludeSystem --suppressions-list=tests/cppcheck-suppressions.txt \
			-Igenerated/c -Iclosedform/runtime/extension $(ANALYSED) closedform/runtime/extension/closedform_rows.c \
			closedform/runtime/extension/closedform_sweep.c && echo "$@: cppcheck clean"; \
	else echo "$@: skipped, cppcheck is not installed"; fi
	@if command -v clang-tidy >/dev/null; then \
		clang-tidy --quiet --checks='$(TIDY)' --warnings-as-errors='*' $(ANALYSED) \
			closedform/runtime/extension/closedform_rows.c closedform/runtime/extension/closedform_sweep.c \
			-- -std=c99 -Igenerated/c -Iclosedform/runtime/extension && echo "$@: clang-tidy clean"; \
	else echo "$@: skipped, clang-tidy is not installed"; fi

portability: all  ## try installed compilers, processor emulators and Pythons; ARGS=--all
	$(BIN)/python tests/portability/run.py $(ARGS)

format: .venv/dev.stamp  ## format the Python that is written by hand
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

figures: native .venv/dev.stamp  ## draw every figure: PDF in build/figures, what the pages show in docs
	$(BIN)/closedform figures -o build/figures --docs docs

pdf: figures  ## compile the derivations to PDF, one for each mechanism, in build/pdf
	@$(MAKE) --no-print-directory $(PDFS)

define TEX
	@command -v pdflatex >/dev/null || { \
		echo "make $(or $(MAKECMDGOALS),pdf) needs pdflatex; on Debian: apt install $(TEX_NEEDED)"; exit 1; }
	@mkdir -p build/pdf/unfinished
endef
define PDFLATEX
TEXINPUTS=generated/latex:build/figures: pdflatex -interaction=nonstopmode -halt-on-error \
	-output-directory=build/pdf/unfinished $(1) > build/pdf/$(2).txt \
	|| { tail -n 30 build/pdf/$(2).txt; exit 1; }
endef

build/pdf/%.pdf: generated/latex/%.tex build/derived.txt
	$(TEX)
	@for pass in 1 2 3; do $(call PDFLATEX,$<,$*); done
	@mv build/pdf/unfinished/$*.pdf $@
	@echo $@

# The index is made between two passes, and its pages need one more for the contents.
book: figures build/derived.txt  ## compile the book of all mechanisms, build/book/closedform.pdf
	$(TEX)
	@for pass in 1 2; do $(call PDFLATEX,generated/latex/closedform.tex,closedform); done
	@cd build/pdf/unfinished && makeindex -q closedform.idx
	@for pass in 1 2; do $(call PDFLATEX,generated/latex/closedform.tex,closedform); done
	@mkdir -p build/book && mv build/pdf/unfinished/closedform.pdf build/book/closedform.pdf
	@echo build/book/closedform.pdf

notebooks: native .venv/dev.stamp  ## write the guides in Python as notebooks, with their output, to build/notebooks
	@$(BIN)/python -m closedform.site.notebooks $(ARGS)

site: native .venv/dev.stamp  ## build the site, build/site/index.html: derivations, explorers, guides; needs Node
	@$(BIN)/closedform site -o build/site $(ARGS)

bench: all  ## time the generated code and the installed peers; writes benchmarks/RESULTS.md
	$(BIN)/python -m benchmarks $(ARGS)

fuzz: all .venv/dev.stamp  ## attack with random input; make test repeats failures; ARGS="--seconds 600 --seed 2"
	PYTHONPATH=tests $(BIN)/python -m fuzz $(ARGS)

accuracy: all  ## compare a billion sines, cosines and arctangents with libm; ARGS="--samples N"
	$(BIN)/python -m benchmarks.accuracy $(ARGS)

clean:  ## remove what was built, except .venv and the generated sources
	rm -rf build dist *.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis
	rm -f generated/c/_native*.so generated/.*.[0-9]* generated/*/.*.[0-9]*
	find closedform derivations generated templates tests -name __pycache__ -exec rm -rf {} +

distclean: clean  ## clean, and remove .venv
	rm -rf .venv

help:  ## show this list
	@sed -n 's/^\([a-z]*\):.*  ## \(.*\)/\1|\2/p' Makefile | while IFS='|' read -r name what; do \
		printf '%-12s %s\n' "$$name" "$$what"; done
