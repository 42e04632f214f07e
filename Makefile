# A fresh clone needs nothing else: `make laundry` and `make test` set up .venv and run.
# The first of these that runs and is recent enough makes the virtual environment.
PYTHONS := python3.13 python3.12 python3
PY := .venv/bin/python
ARGS ?=

.PHONY: setup laundry relocation test lint docs acceptance fuzz clean

setup: .venv/.installed

.venv/.installed: pyproject.toml constraints.txt
	@test -x $(PY) || for p in $(PYTHONS); do \
	  if $$p -c 'import sys; sys.exit(sys.version_info < (3, 12))' 2>/dev/null; then \
	    echo "making .venv with $$p"; $$p -m venv .venv && break; fi; done; \
	  test -x $(PY) || { echo "needs Python 3.12 or newer: tried $(PYTHONS)" >&2; exit 1; }
	$(PY) -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[test]"
	@touch $@

laundry: setup
	$(PY) -m geosacs_drake.run_laundry $(ARGS)

relocation: setup
	$(PY) -m geosacs_drake.run_relocation $(ARGS)

# On both cores; `make test ARGS="-n 0 -k name"` for one test in this process.
test: setup
	$(PY) -m pytest -n 2 $(ARGS)

lint: setup
	$(PY) -m ruff check .
	$(PY) -m ruff format --check .
	$(PY) -m mypy
	$(PY) -m mypy --strict canal

# The documentation, into build/site; its gallery is drawn by the scripts of examples/. A warning fails it.
docs: setup
	$(PY) -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[docs]"
	NO_MKDOCS_2_WARNING=1 $(PY) -m mkdocs build --strict
	@echo "open build/site/index.html"

# What the tests are too short for, in under half an hour on two cores; `make acceptance ARGS="--list"`.
acceptance: setup
	$(PY) -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[bench]"
	$(PY) -m benchmarks.acceptance $(ARGS)

# Random sticks, scenarios and canals; `make fuzz ARGS="--seconds 7200"`.
fuzz: setup
	$(PY) -m benchmarks.fuzz $(ARGS)

# `make bench-NAME` runs benchmarks/bench_NAME.py, with the rivals in an extra of their own.
bench-%: setup
	$(PY) -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[bench]"
	$(PY) -m benchmarks.bench_$* $(ARGS)

clean:
	rm -rf .venv build dist *.egg-info
