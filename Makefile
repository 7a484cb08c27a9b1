# Every target works alone on a fresh clone; `make help` lists them.
PYTHON ?= python3
BIN := .venv/bin
BASE := .venv/.base
RUNS := .venv/.runs
INSTALLED := .venv/.installed
READY := .venv/.ready
PROBLEMS := $(or $(SERENDIPITY_PROBLEMS),../shared)

.DEFAULT_GOAL := help
.PHONY: help .venv demo test test-slow test-sanitized test-browser test-robot robot pictures browser check docs bench bench-domains bench-limits bench-extra fuzz wheels release-check requirements clean

help:  ## list the targets
	@awk -F ':.*## ' '/^[a-z.-]+:.*## / {printf "  make %-14s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

.venv: $(READY)  ## make the virtual environment (with uv where it is installed, else with pip)

$(READY): $(INSTALLED) $(RUNS)
	@touch $@

$(INSTALLED): $(BASE) requirements-dev.txt
	@echo "Adding to .venv what tests and developers need (requirements-dev.txt) ..."
	@if command -v uv >/dev/null 2>&1; then \
	  uv pip install --quiet --compile-bytecode --python $(BIN)/python --require-hashes -r requirements-dev.txt; \
	else \
	  $(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements-dev.txt; \
	fi
	@touch $@

$(RUNS): $(BASE) $(wildcard search/kernel/*.[ch]) search/kernel/build.py
	@$(BIN)/python -m search.kernel.build || true  # all works without it, more slowly
	@touch $@

$(BASE): requirements.txt pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
	  || { echo "Python 3.11 or later is needed; set PYTHON=..., for example: make PYTHON=python3.12" >&2; exit 1; }
	@echo "Making .venv, with what Serendipity needs to run (requirements.txt): half a minute, or as long as the network takes ..."
	@if command -v uv >/dev/null 2>&1; then \
	  set -e; \
	  uv venv --quiet --clear --python "$$(command -v $(PYTHON))" .venv; \
	  uv pip install --quiet --python $(BIN)/python --require-hashes -r requirements.txt; \
	  uv pip install --quiet --python $(BIN)/python --no-deps --no-build-isolation -e .; \
	else \
	  set -e; \
	  $(PYTHON) -m venv --clear .venv; \
	  $(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.txt; \
	  $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .; \
	fi
	@$(BIN)/python -m compileall -q serendipity search verify serendipity_*/ \
	  $$($(BIN)/python -c 'import typer, rich; print(*typer.__path__, *rich.__path__)')  # the first start counts
	@touch $@

demo: $(RUNS)  ## the paper's example III-C: plan, proof, what the person will really do, picture
	@mkdir -p build/demo
	@$(BIN)/serendipity plan --example room2 --discount 0.6
	@$(BIN)/serendipity plan --example room2 --discount 0.6 --quiet -o build/demo/room2.json
	@echo && $(BIN)/serendipity verify --example room2 build/demo/room2.json
	@echo && echo "The same, with the integer program left to HiGHS, and to the CBC of PuLP:"
	@$(BIN)/serendipity verify --example room2 build/demo/room2.json --proof build/demo/proof.json.gz
	@$(BIN)/serendipity verify --example room2 build/demo/room2.json --method program --solver cbc
	@echo && echo "And checked with integers only, without a solver:"
	@$(BIN)/serendipity check-proof build/demo/proof.json.gz --example room2 build/demo/room2.json
	@echo && $(BIN)/serendipity simulate --example room2 build/demo/room2.json --human-model observant
	@$(BIN)/serendipity show --example room2 build/demo/room2.json -o build/demo/room2.html
	@echo && echo "Open build/demo/room2.html in a browser to see it."

test: $(READY)  ## run the tests
	@$(BIN)/python -m pytest -n auto --dist worksteal --durations 20

test-slow: $(READY)  ## run the tests that take long, too
	@$(BIN)/python -m pytest -m "long or slow" -n auto --dist worksteal --durations 20

SANITIZED := CC="cc -fsanitize=address,undefined -fno-sanitize-recover=undefined -g" ASAN_OPTIONS=detect_leaks=0 \
  LD_PRELOAD="$$(cc -print-file-name=libasan.so) $$(cc -print-file-name=libubsan.so)"

test-sanitized: $(READY)  ## run the search's tests on a kernel that looks for undefined behaviour and stray addresses
	@$(SANITIZED) $(BIN)/python -m search.kernel.build
	@$(SANITIZED) $(BIN)/python -m pytest -q -n auto --dist worksteal tests/search; status=$$?; \
	  $(BIN)/python -m search.kernel.build; exit $$status

test-browser: browser  ## play the pages of `show` and `play` in a headless Chromium, which it installs where it may
	@$(BIN)/python -m pytest -m "browser and not slow" -rs tests/show serendipity_live/tests tests/docs

test-robot: robot  ## let figures walk in physics; it installs pybullet where there is a wheel of it
	@$(BIN)/python -m pytest -rs tests/robot

pictures: browser robot  ## photograph that page, and film figures, again for the documentation
	@$(BIN)/python -m docs.pictures
	@$(BIN)/python -m docs.robots

robot: $(READY)
	@$(BIN)/python -c 'import pybullet' 2>/dev/null \
	  || { if command -v uv >/dev/null 2>&1; then \
	         uv pip install --quiet --only-binary pybullet --python $(BIN)/python --require-hashes -r requirements-robot.txt; \
	       else $(BIN)/python -m pip install --quiet --disable-pip-version-check --only-binary pybullet --require-hashes \
	         -r requirements-robot.txt; fi; } \
	  || echo "No pybullet, and it can't be installed here without compiling it."

browser: $(READY)
	@command -v chromium >/dev/null 2>&1 \
	  || { [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null 2>&1 && DEBIAN_FRONTEND=noninteractive \
	       apt-get install -y --no-install-recommends chromium >/dev/null 2>&1; } \
	  || echo "No chromium, and it can't be installed here."
	@$(BIN)/python -c 'import playwright' 2>/dev/null \
	  || { if command -v uv >/dev/null 2>&1; then \
	         uv pip install --quiet --python $(BIN)/python --require-hashes -r requirements-browser.txt; \
	       else $(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes \
	         -r requirements-browser.txt; fi; } \
	  || echo "No playwright, and it can't be installed here."

check: $(READY)  ## what has to hold before a commit: tests, ruff, mypy, import contracts
	@.ci/run

docs: $(READY)  ## build the documentation into build/docs; a broken link or any warning is an error
	@$(BIN)/python -c 'import material, mkdocs_jupyter, mkdocstrings_handlers.python' 2>/dev/null \
	  || { if command -v uv >/dev/null 2>&1; then \
	         uv pip install --quiet --python $(BIN)/python --require-hashes -r requirements-docs.txt; \
	       else $(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes \
	         -r requirements-docs.txt; fi; }
	@NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --quiet --strict --site-dir build/docs
	@echo "build/docs/index.html"

bench: bench-extra  ## measure on the 200 problems of the paper: parts, contenders side by side; then scaling series
	@mkdir -p build/bench
	@$(BIN)/python -m benchmarks.usar $(PROBLEMS)/usar200
	@echo && $(BIN)/serendipity bench $(PROBLEMS)/usar200 --stride 4 --discounts 0,0.1,0.3,0.5,0.7,0.9 \
	  --contenders search,in-turn,automata,fast-downward -o build/bench/side-by-side.csv --plot build/bench/side-by-side.png
	@echo && $(BIN)/serendipity bench $(PROBLEMS)/usar200 --stride 20 --discounts 0.9 --modes serendipity,communication \
	  --contenders search,again,paper -o build/bench/paper.csv --plot build/bench/paper.png
	@echo && $(BIN)/serendipity bench --scaling all --seeds 3 -o build/bench/scaling.csv --plot build/bench/scaling.png

bench-domains: bench-extra  ## measure on the competition's domains beside Fast Downward: an hour or two
	@mkdir -p build/bench
	@$(BIN)/serendipity bench $(PROBLEMS)/codmap15 -o build/bench/domains.csv --plot build/bench/domains.svg

bench-limits: $(READY)  ## measure how well limits of time and memory are kept: an hour or more, two processes at a time
	@mkdir -p build/bench
	@missed=0; LIMITS="$(BIN)/python -m benchmarks.limits --suite $(PROBLEMS)/codmap15 --jobs 2 --record build/bench/limits"; \
	$$LIMITS-plan.jsonl plan || missed=1; \
	$$LIMITS-plan-10.jsonl plan --limits 10 --rotate 3 || missed=1; \
	$$LIMITS-verify.jsonl verify --rotate 5 || missed=1; \
	$$LIMITS-memory.jsonl memory || missed=1; exit $$missed

bench-extra: $(READY)
	@$(BIN)/python -c 'import ortools, sys; from serendipity.classical.fast_downward import absent; sys.exit(bool(absent()))' \
	  || { if command -v uv >/dev/null 2>&1; then \
	         uv pip install --quiet --python $(BIN)/python --require-hashes -r requirements-bench.txt; \
	       else $(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes \
	         -r requirements-bench.txt; fi; } \
	  || echo "No Fast Downward, or no OR-Tools, and they can't be installed here: they are left out."

fuzz: $(READY)  ## thousands of random tasks: all methods have to agree; the slow tests
	@$(BIN)/serendipity crosscheck --count 10000 --judges search,automata -o build/disagreement
	@$(BIN)/serendipity crosscheck --count 1000 --judges search,automata,paper,cbc -o build/disagreement
	@for n in 2 3; do $(BIN)/serendipity crosscheck --people $$n --count 5000 -o build/disagreement || exit; done
	@HYPOTHESIS_PROFILE=fuzz $(BIN)/python -m pytest -m "slow or not slow"

PLATFORMS := any manylinux_2_17_x86_64 manylinux_2_17_aarch64 musllinux_1_2_x86_64 musllinux_1_2_aarch64 \
  macosx_11_0_x86_64 macosx_11_0_arm64 win_amd64 win_arm64

wheels: $(READY)  ## what is released, into dist/: a wheel for each platform, one for any other, and the sources
	@$(BIN)/python -c 'import ziglang' 2>/dev/null \
	  || { if command -v uv >/dev/null 2>&1; then \
	         uv pip install --quiet --python $(BIN)/python --require-hashes -r requirements-wheels.txt; \
	       else $(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes \
	         -r requirements-wheels.txt; fi; }
	@set -e; for platform in $(PLATFORMS); do \
	  SERENDIPITY_WHEEL=$$platform $(BIN)/python -m hatchling build -t wheel; done
	@$(BIN)/python -m hatchling build -t sdist

release-check:  ## install wheels and sources in fresh environments, and try them, on every Python from 3.11 on that is here
	@$(PYTHON) .ci/release.py

requirements: pyproject.toml  ## pin the dependencies again (needs uv)
	@uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-annotate --no-header \
	  --no-emit-index-url --upgrade --group build pyproject.toml -o requirements.txt
	@uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-annotate --no-header \
	  --no-emit-index-url --extra dev -c requirements.txt pyproject.toml -o requirements-dev.txt
	@uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-annotate --no-header \
	  --no-emit-index-url --extra browser -c requirements-dev.txt pyproject.toml -o requirements-browser.txt
	@uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-annotate --no-header \
	  --no-emit-index-url --extra robot -c requirements-dev.txt pyproject.toml -o requirements-robot.txt
	@uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-annotate --no-header \
	  --no-emit-index-url --extra docs -c requirements-dev.txt pyproject.toml -o requirements-docs.txt
	@uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-annotate --no-header \
	  --no-emit-index-url --extra bench -c requirements-dev.txt pyproject.toml -o requirements-bench.txt
	@uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-annotate --no-header \
	  --no-emit-index-url --extra wheels -c requirements-dev.txt pyproject.toml -o requirements-wheels.txt

clean:  ## remove the environment and all caches
	@rm -rf .venv .cache .hypothesis .mypy_cache .pytest_cache .ruff_cache .import_linter_cache build dist *.egg-info search/kernel/_kernel*
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +
