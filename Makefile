# The commands of a checkout; `make help` lists them. Everything runs in .venv.
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
PARALLEL := -n auto --dist worksteal
NODE   := hostkit/emulation/avr8js hostkit/emulation/rp2040js hostkit/web/page

.DEFAULT_GOAL := help
.PHONY: help setup demo test check goldens bench clean

help:              ## this list
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 16

setup:             ## make .venv, install hostkit and the toolchains; safe to repeat
	@./.ci/setup "$(PYTHON)" "$(VENV)" $(NODE)

demo: setup        ## the whole loop without hardware, ending in a report
	$(BIN)/hostkit demo --out demo

test: setup        ## all tests, on every core
	$(BIN)/python -m pytest $(PARALLEL)

check: setup       ## format, lint, types, tests
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/python -m pytest $(PARALLEL)

goldens: setup     ## rewrite generated/; read the diff before committing
	$(BIN)/python -m pytest tests/golden --update-golden
	git diff --stat generated

bench: setup       ## speed and memory as ratios to a peer
	$(BIN)/python -m pip install -q --disable-pip-version-check -e '.[bench]' || \
		$(BIN)/python -m benchmarks.install
	$(BIN)/python benchmarks/run.py

clean:             ## remove what setup, tests and builds made
	rm -rf $(VENV) $(NODE:%=%/node_modules) demo build dist .pytest_cache .mypy_cache .ruff_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
