# The examples for DuckDB, polars, pandas and pyarrow, run with their current versions and with polars 1.35.

EXAMPLES_VENV := target/examples-venv
EXAMPLES_VENV_1_35 := target/examples-venv-1.35
EXAMPLES_STUDY := target/examples-study

.PHONY: test-examples

test-examples: $(EXAMPLES_VENV)/ready $(EXAMPLES_VENV_1_35)/ready ## the examples against mrbd's own medians
	cargo run --release --locked --bin mrbd -- run pipelines/check.toml --out $(EXAMPLES_STUDY) --force > /dev/null
	cargo run --release --locked --bin mrbd -- aggregate $(EXAMPLES_STUDY) --csv > $(EXAMPLES_STUDY).csv
	$(EXAMPLES_VENV)/bin/python tests/python/check_examples.py $(EXAMPLES_STUDY).csv $(EXAMPLES_STUDY) examples/*.py
	$(EXAMPLES_VENV_1_35)/bin/python tests/python/check_examples.py $(EXAMPLES_STUDY).csv $(EXAMPLES_STUDY) examples/polars_medians.py

$(EXAMPLES_VENV)/ready:
	python3 -m venv $(EXAMPLES_VENV)
	$(EXAMPLES_VENV)/bin/pip install --quiet duckdb polars pandas pyarrow
	touch $@

$(EXAMPLES_VENV_1_35)/ready:
	python3 -m venv $(EXAMPLES_VENV_1_35)
	$(EXAMPLES_VENV_1_35)/bin/pip install --quiet 'polars==1.35.*'
	touch $@
