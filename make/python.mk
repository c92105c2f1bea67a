# The package for Python: one wheel that carries the program too, tested under the oldest and a current Python; the site.

PYTHON_CRATE := crates/python
WHEELS := target/wheels
WHEEL_VENV := target/wheel-venv
PYTHON_VENV := target/python-venv
PYTHON_OLDEST_VENV := target/python-venv-oldest
# The first that runs of those given, on the path, under pyenv or where the host of the repository keeps them.
first_python = $(shell for v in $(1); do for p in python$$v $$HOME/.pyenv/versions/$$v.*/bin/python \
	$$RUNNER_TOOL_CACHE/Python/$$v.*/*/bin/python; do \
	$$p -c 'import venv' 2> /dev/null && { command -v $$p; exit; }; done; done)
PYTHON_OLDEST ?= $(call first_python,3.10)
PYTHON_CURRENT ?= $(call first_python,3.14 3.13 3.12 3.11)
PYTHON_VENVS := $(PYTHON_VENV) $(if $(PYTHON_OLDEST),$(PYTHON_OLDEST_VENV))
SITE := target/site

.PHONY: wheel test-python python-against-mrbd bench-python site site-of-wheel

wheel: $(WHEEL_VENV)/ready ## the wheel for Python, with the program in it, into target/wheels
	rm -rf $(WHEELS)
	cd $(PYTHON_CRATE) && CARGO_TARGET_DIR=$${CARGO_TARGET_DIR:-$(CURDIR)/target} \
		$(CURDIR)/$(WHEEL_VENV)/bin/maturin build --release --locked --out $(CURDIR)/$(WHEELS)
	@test $$(stat -c %s $(WHEELS)/*.whl) -le 25000000 || { echo "the wheel is larger than 25 MB"; exit 1; }

test-python: ## the wheel in clean environments of the oldest and a current Python, with its notebooks
	@if [ -z "$(PYTHON_CURRENT)" ]; then \
		echo "SKIPPED: no Python 3.11 or newer here, the package for Python is not tested"; \
	elif $(MAKE) --no-print-directory $(WHEEL_VENV)/ready $(PYTHON_VENVS:%=%/ready); then \
		echo "the package for Python is tested by $(PYTHON_CURRENT) and $(or $(PYTHON_OLDEST),no older one: SKIPPED)"; \
		$(MAKE) --no-print-directory python-against-mrbd; \
	else \
		echo "SKIPPED: the package registry does not answer, the package for Python is not tested"; \
	fi

python-against-mrbd: wheel
	$(PYTHON_VENV)/bin/abi3audit --strict --assume-minimum-abi3 3.10 $(WHEELS)/*.whl
	for venv in $(PYTHON_VENVS); do \
		$$venv/bin/pip install --quiet --no-deps --force-reinstall $(WHEELS)/*.whl \
		&& PATH="$(CURDIR)/$$venv/bin:$$PATH" $$venv/bin/python -m pytest -q $(PYTHON_CRATE)/tests || exit 1; \
	done
	cargo fmt --manifest-path $(PYTHON_CRATE)/Cargo.toml --check
	CARGO_TARGET_DIR=$${CARGO_TARGET_DIR:-$(CURDIR)/target} cargo clippy --release --locked --all-targets \
		--manifest-path $(PYTHON_CRATE)/Cargo.toml -- -D warnings
	cd $(PYTHON_CRATE) && $(CURDIR)/$(PYTHON_VENV)/bin/mypy notebooks/*.py
	$(PYTHON_VENV)/bin/ruff check $(PYTHON_CRATE)
	$(PYTHON_VENV)/bin/ruff check --config $(PYTHON_CRATE)/pyproject.toml docs/site
	$(PYTHON_VENV)/bin/ruff format --config $(PYTHON_CRATE)/pyproject.toml --check $(PYTHON_CRATE) docs/site
	$(MAKE) --no-print-directory site-of-wheel

site: $(PYTHON_VENV)/ready wheel ## the site of documentation, into target/site: guide, notebooks, both APIs, pictures
	$(PYTHON_VENV)/bin/pip install --quiet --no-deps --force-reinstall $(WHEELS)/*.whl
	$(MAKE) --no-print-directory site-of-wheel

site-of-wheel: docs
	PATH="$(CURDIR)/$(PYTHON_VENV)/bin:$$PATH" $(PYTHON_VENV)/bin/python docs/site/build.py $${CARGO_TARGET_DIR:-target}/doc $(SITE)
	$(PYTHON_VENV)/bin/python docs/site/check.py $(SITE)

bench-python: $(PYTHON_VENV)/ready wheel ## what Python adds to the time of runs, beside the library alone, in turns
	$(PYTHON_VENV)/bin/pip install --quiet --no-deps --force-reinstall $(WHEELS)/*.whl
	$(PYTHON_VENV)/bin/python $(PYTHON_CRATE)/benches/speed.py

$(WHEEL_VENV)/ready:
	$(PYTHON_CURRENT) -m venv $(WHEEL_VENV)
	$(WHEEL_VENV)/bin/pip install --quiet 'maturin>=1.16,<2'
	touch $@

# With everything that the notebooks use, and what makes the site.
$(PYTHON_VENV)/ready: make/python.mk
	$(PYTHON_CURRENT) -m venv $(PYTHON_VENV)
	$(PYTHON_VENV)/bin/pip install --quiet pytest mypy ruff abi3audit sphinx furo myst-parser \
		numpy pandas polars pyarrow duckdb matplotlib 'dask[distributed]'
	touch $@

# With the oldest numpy and pyarrow that there are wheels of, and nothing else: what needs more is skipped.
$(PYTHON_OLDEST_VENV)/ready:
	$(PYTHON_OLDEST) -m venv $(PYTHON_OLDEST_VENV)
	$(PYTHON_OLDEST_VENV)/bin/pip install --quiet pytest 'numpy==1.23.*' 'pyarrow==14.*'
	touch $@
