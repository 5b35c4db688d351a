# Everything happens in .venv, made by the first target that needs it. Only python3 (3.11 or newer), pip and make
# have to be there; uv is used where it is found, because it installs the same lock in less time.

PYTHON ?= python3
STUDY ?= theorem1
STUDY_FLAGS ?=
MUTANTS_FLAGS ?=

SHELL := /bin/sh
BIN := .venv/bin
# The stamp is named by what was installed, so that it vanishes when the lock or the metadata change, and a second run
# has nothing to do and asks nobody.
STAMP := .venv/installed-$(shell cat requirements.lock pyproject.toml | cksum | tr ' ' '-')
ROBOTS_STAMP := .venv/robots-$(shell cat requirements.lock robots.lock | cksum | tr ' ' '-')
MUTANTS_STAMP := .venv/mutants-$(shell cat requirements.lock mutants.lock | cksum | tr ' ' '-')
NOTEBOOKS := $(patsubst notebooks/%.py,build/notebooks/%.ipynb,$(wildcard notebooks/*.py))

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help install study test test-slow test-robots mutants lint types contracts lock clean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-10s %s\n", $$1, $$2 }' Makefile

install: $(STAMP) ## install the locked versions and the package itself into .venv

study: install ## install, then run the study of Theorem 1 (STUDY=name for another, STUDY_FLAGS=--quick for a reduced run)
	$(BIN)/painleve study $(STUDY) $(STUDY_FLAGS)

test: lint types contracts $(NOTEBOOKS) ## install, then check the code, run the tests but the slow ones, execute the notebooks
	$(BIN)/python -m pytest -n 2 --dist loadfile -m "not slow" tests $(if $(NOTEBOOKS),--nbmake --nbmake-timeout=300 $(NOTEBOOKS))

test-slow: install ## install, then run the tests that take more than ten seconds each
	$(BIN)/python -m pytest -n 2 --dist loadfile -m slow tests

test-robots: $(ROBOTS_STAMP) ## install MuJoCo beside the rest, then run the tests of robots' files against it
	$(BIN)/python -m pytest tests/test_robot_file.py

mutants: $(MUTANTS_STAMP) ## install mutmut, then try changes of proofs that no test may miss (MUTANTS_FLAGS="--sample 0" for all)
	$(BIN)/python tests/mutants.py $(MUTANTS_FLAGS)

lint: install ## check the code with ruff
	$(BIN)/ruff check .
	$(BIN)/ruff format --check --quiet .

types: install ## check the types with mypy
	$(BIN)/mypy

contracts: install ## check that every room imports only from the floors below it
	$(BIN)/lint-imports --no-logo

lock: ## choose the locked versions anew after a change of the dependencies (needs uv)
	uv pip compile pyproject.toml --output-file requirements.lock --quiet --universal --generate-hashes \
		--extra units --extra test --extra notebook --group build --no-emit-index-url --custom-compile-command 'make lock'
	uv pip compile --group pyproject.toml:mutants --output-file mutants.lock --quiet --universal --generate-hashes \
		--constraint requirements.lock --no-emit-index-url --custom-compile-command 'make lock'
	uv pip compile --group pyproject.toml:robots --output-file robots.lock --quiet --universal --generate-hashes \
		--constraint requirements.lock --no-emit-index-url --custom-compile-command 'make lock'

clean: ## remove what make and the tools made, but not data/
	rm -rf .venv build .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

build/notebooks/%.ipynb: notebooks/%.py $(STAMP)
	@mkdir -p $(@D)
	$(BIN)/jupytext --quiet --to ipynb --output $@ $<

# Some distributions ship Python without ensurepip; then .venv has no pip of its own and the caller's pip fills it.
$(BIN)/python:
	@command -v $(PYTHON) > /dev/null || { echo "make: no $(PYTHON) here; name a Python: make PYTHON=/path/to/python3" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.version_info >= (3, 11) or sys.exit( \
		"make: painleve needs Python 3.11 or newer, and $(PYTHON) is %d.%d; name a newer one: make PYTHON=python3.12" \
		% sys.version_info[:2])'
	@if $(PYTHON) -c 'import ensurepip' 2> /dev/null; then $(PYTHON) -m venv --clear .venv; \
		else $(PYTHON) -m venv --clear --without-pip .venv; fi

# How to install into .venv: with uv, with its own pip, or with the caller's.
define find_installer
if command -v uv > /dev/null; then install="uv pip install --python $(BIN)/python --compile-bytecode"; \
	elif $(BIN)/python -c 'import pip' 2> /dev/null; then install="$(BIN)/python -m pip install"; \
	else install="$(PYTHON) -m pip --python $(BIN)/python install"; fi; set -e
endef

$(STAMP): $(BIN)/python
	@rm -f .venv/installed-*
	@echo "installing the versions of requirements.lock into .venv (a minute or two, once)"
	@$(find_installer); \
	$$install --quiet --require-hashes -r requirements.lock; \
	$$install --quiet --no-deps --no-build-isolation -e .
	@touch $@

$(MUTANTS_STAMP): $(STAMP)
	@rm -f .venv/mutants-*
	@$(find_installer); $$install --quiet --require-hashes -r mutants.lock
	@touch $@

$(ROBOTS_STAMP): $(STAMP)
	@rm -f .venv/robots-*
	@$(find_installer); $$install --quiet --require-hashes -r robots.lock
	@touch $@
