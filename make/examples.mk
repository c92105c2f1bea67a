# The examples for DuckDB, polars, pandas, pyarrow and matplotlib, run with their current versions and with polars 1.35.

EXAMPLES_VENV := target/examples-venv
EXAMPLES_VENV_1_35 := target/examples-venv-1.35
EXAMPLES := target/examples-study
EXAMPLES_MRBD := cargo run --quiet --release --locked --bin mrbd --

.PHONY: test-examples examples-against-mrbd

test-examples: ## the examples against mrbd's own medians and curves, where the package registry answers
	@if $(MAKE) --no-print-directory $(EXAMPLES_VENV)/ready $(EXAMPLES_VENV_1_35)/ready; then \
		$(MAKE) --no-print-directory examples-against-mrbd; \
	else \
		echo "SKIPPED: the package registry does not answer, no DuckDB, polars, pandas, pyarrow and matplotlib"; \
	fi

# Smaller than the repository's studies of drawn façades; their pipelines name the inputs from a folder of the repository.
$(EXAMPLES)-%.toml: pipelines/%.toml
	@mkdir -p target
	sed 's/^count = [0-9]*/count = 16/' $< > $@

examples-against-mrbd: $(EXAMPLES)-monte_carlo.toml $(EXAMPLES)-fragility.toml
	$(EXAMPLES_MRBD) run pipelines/check.toml --out $(EXAMPLES)-check --force > /dev/null
	$(EXAMPLES_MRBD) aggregate $(EXAMPLES)-check --csv > $(EXAMPLES)-check.csv
	$(EXAMPLES_VENV)/bin/python tests/python/check_examples.py $(EXAMPLES)-check.csv $(EXAMPLES)-check examples/*_medians.py
	$(EXAMPLES_VENV_1_35)/bin/python tests/python/check_examples.py $(EXAMPLES)-check.csv $(EXAMPLES)-check examples/polars_medians.py
	$(EXAMPLES_MRBD) run $(EXAMPLES)-monte_carlo.toml --out $(EXAMPLES)-monte_carlo --force > /dev/null
	$(EXAMPLES_MRBD) aggregate $(EXAMPLES)-monte_carlo --csv > $(EXAMPLES)-monte_carlo.csv
	$(EXAMPLES_VENV)/bin/python tests/python/check_examples.py $(EXAMPLES)-monte_carlo.csv $(EXAMPLES)-monte_carlo examples/*_monte_carlo.py
	$(EXAMPLES_VENV_1_35)/bin/python tests/python/check_examples.py $(EXAMPLES)-monte_carlo.csv $(EXAMPLES)-monte_carlo examples/polars_monte_carlo.py
	$(EXAMPLES_MRBD) run $(EXAMPLES)-fragility.toml --out $(EXAMPLES)-fragility --force > /dev/null
	$(EXAMPLES_MRBD) aggregate $(EXAMPLES)-fragility --csv > $(EXAMPLES)-fragility.csv
	$(EXAMPLES_MRBD) fragility $(EXAMPLES)-fragility --threshold 0.5 --replicates 200 --out $(EXAMPLES)-curves.csv > /dev/null
	for venv in $(EXAMPLES_VENV) $(EXAMPLES_VENV_1_35); do \
		$$venv/bin/python tests/python/check_fragility_plot.py $(EXAMPLES)-fragility.csv $(EXAMPLES)-curves.csv $(EXAMPLES)-fragility target \
		|| exit 1; \
	done

$(EXAMPLES_VENV)/ready:
	python3 -m venv $(EXAMPLES_VENV)
	$(EXAMPLES_VENV)/bin/pip install --quiet --upgrade duckdb polars pandas pyarrow matplotlib
	touch $@

$(EXAMPLES_VENV_1_35)/ready:
	python3 -m venv $(EXAMPLES_VENV_1_35)
	$(EXAMPLES_VENV_1_35)/bin/pip install --quiet 'polars==1.35.*'
	touch $@
