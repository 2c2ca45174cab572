# Two commands set everything up on a fresh machine with python3 >= 3.11 and make:
#   make demo    install, start the service on loopback, print the page's address
#   make test    install, lint, type-check, run the sampled test suite

PYTHON ?= python3
BIN := .venv/bin
PORT ?= 8000

.PHONY: install demo test test-all check benchmarks lock clean

install: .venv/runtime.stamp

# One stamp per lock: a changed lock is installed again, an unchanged one is not looked at.
.venv/pip.stamp:
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "isogyre needs Python 3.11 or newer")'
	$(PYTHON) -m venv .venv
	@touch $@

.venv/runtime.stamp: requirements/runtime.txt requirements/build.txt pyproject.toml .venv/pip.stamp
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements/runtime.txt -r requirements/build.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	@touch $@

.venv/test.stamp: requirements/test.txt .venv/runtime.stamp
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements/test.txt
	@touch $@

demo: install
	$(BIN)/isogyre serve --host 127.0.0.1 --port $(PORT)

check: .venv/test.stamp
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

test: check
	$(BIN)/python -m pytest -m "not full"

test-all: check
	$(BIN)/python -m pytest

.venv/benchmark.stamp: requirements/benchmark.txt .venv/test.stamp
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements/benchmark.txt
	@touch $@

benchmarks: .venv/benchmark.stamp
	$(BIN)/python -m benchmarks.rotating_calcite
	$(BIN)/python -m benchmarks.interface
	$(BIN)/python -m benchmarks.minerals

# Needs uv on the PATH. The locks carry hashes and no address of any registry.
lock:
	uv pip compile --universal --python-version 3.11 --generate-hashes --no-emit-index-url --no-header --quiet pyproject.toml -o requirements/runtime.txt
	uv pip compile --universal --python-version 3.11 --generate-hashes --no-emit-index-url --no-header --quiet --extra test -c requirements/runtime.txt pyproject.toml -o requirements/test.txt
	uv pip compile --universal --python-version 3.11 --generate-hashes --no-emit-index-url --no-header --quiet -c requirements/runtime.txt requirements/build.in -o requirements/build.txt
	uv pip compile --universal --python-version 3.11 --generate-hashes --no-emit-index-url --no-header --quiet --extra benchmark --extra test -c requirements/test.txt pyproject.toml -o requirements/benchmark.txt

clean:
	rm -rf .venv .mypy_cache .ruff_cache .pytest_cache
