# The examples for DuckDB, polars, pandas, pyarrow and matplotlib, run with their current versions and with polars 1.35.

EXAMPLES_VENV := target/examples-venv
EXAMPLES_VENV_1_35 := target/examples-venv-1.35
EXAMPLES_STUDY := target/examples-study
EXAMPLES_CURVES := target/examples-curves.csv

.PHONY: test-examples examples-against-mrbd

test-examples: ## the examples against mrbd's own medians and curves, where the package registry answers
	@if $(MAKE) --no-print-directory $(EXAMPLES_VENV)/ready $(EXAMPLES_VENV_1_35)/ready; then \
		$(MAKE) --no-print-directory examples-against-mrbd; \
	else \
		echo "SKIPPED: the package registry does not answer, no DuckDB, polars, pandas, pyarrow and matplotlib"; \
	fi

examples-against-mrbd:
	cargo run --quiet --release --locked --bin mrbd -- run pipelines/check.toml --out $(EXAMPLES_STUDY) --force > /dev/null
	cargo run --quiet --release --locked --bin mrbd -- aggregate $(EXAMPLES_STUDY) --csv > $(EXAMPLES_STUDY).csv
	cargo run --quiet --release --locked --bin mrbd -- fragility $(EXAMPLES_STUDY) --intensity pgv_m_s \
		--outcome theta1_max_over_alpha1 --exceeds 0.1 --group configuration --cluster record \
		--replicates 200 --out $(EXAMPLES_CURVES)
	$(EXAMPLES_VENV)/bin/python tests/python/check_examples.py $(EXAMPLES_STUDY).csv $(EXAMPLES_STUDY) examples/*_medians.py
	$(EXAMPLES_VENV_1_35)/bin/python tests/python/check_examples.py $(EXAMPLES_STUDY).csv $(EXAMPLES_STUDY) examples/polars_medians.py
	$(EXAMPLES_VENV)/bin/python tests/python/check_fragility_plot.py $(EXAMPLES_CURVES) $(EXAMPLES_STUDY) target
	$(EXAMPLES_VENV_1_35)/bin/python tests/python/check_fragility_plot.py $(EXAMPLES_CURVES) $(EXAMPLES_STUDY) target

$(EXAMPLES_VENV)/ready:
	python3 -m venv $(EXAMPLES_VENV)
	$(EXAMPLES_VENV)/bin/pip install --quiet --upgrade duckdb polars pandas pyarrow matplotlib
	touch $@

$(EXAMPLES_VENV_1_35)/ready:
	python3 -m venv $(EXAMPLES_VENV_1_35)
	$(EXAMPLES_VENV_1_35)/bin/pip install --quiet 'polars==1.35.*'
	touch $@
