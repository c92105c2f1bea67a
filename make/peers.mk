# mrbd beside scipy and MuJoCo, on the same wall, in the same run.

PEERS_VENV := target/peers-venv

.PHONY: bench-peers bench-calibration

bench-peers: ## one wall by mrbd, scipy and MuJoCo: times, ratios, differences (downloads both into target/)
	@if $(MAKE) --no-print-directory $(PEERS_VENV)/ready; then \
		cargo build --release --locked --bin mrbd --example time_run && \
		$(PEERS_VENV)/bin/python benches/peers/run.py target/release/examples/time_run target/release/mrbd; \
	else \
		echo "SKIPPED: make bench-peers needs Python 3.11 or newer with venv, and a package registry that answers"; \
	fi

bench-calibration: ## simulations of the calibration and of scipy's differential_evolution for the same misfit
	@if $(MAKE) --no-print-directory $(PEERS_VENV)/ready; then \
		cargo build --release --locked --bin mrbd && \
		$(PEERS_VENV)/bin/python tests/python/compare_scipy_de.py target/release/mrbd; \
	else \
		echo "SKIPPED: make bench-calibration needs Python 3.11 or newer with venv, and a package registry that answers"; \
	fi

$(PEERS_VENV)/ready:
	python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))'
	python3 -m venv $(PEERS_VENV)
	$(PEERS_VENV)/bin/pip install --quiet --upgrade numpy scipy mujoco
	touch $@
