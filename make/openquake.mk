# Fragility models in NRML, read by OpenQuake's own parser.

OPENQUAKE_VENV := target/openquake-venv
OPENQUAKE := target/openquake-study

# The engine's other packages need libraries of the system (GDAL); its parser does without them.
OPENQUAKE_NEEDS := alpha_shapes decorator django docutils fiona h3 h5py numba numpy pandas psutil pyproj pyyaml pyzmq requests scipy shapely toml

.PHONY: test-openquake openquake-reads

test-openquake: ## a fragility model in NRML, read by OpenQuake's own parser, where the package registry answers
	@if $(MAKE) --no-print-directory $(OPENQUAKE_VENV)/ready; then \
		$(MAKE) --no-print-directory openquake-reads; \
	else \
		echo "SKIPPED: the package registry does not answer, no parser of OpenQuake"; \
	fi

openquake-reads: $(EXAMPLES)-fragility.toml
	$(EXAMPLES_MRBD) run $(EXAMPLES)-fragility.toml --out $(OPENQUAKE) --force > /dev/null
	$(EXAMPLES_MRBD) fragility $(OPENQUAKE) --threshold 0.5 --replicates 200 --out $(OPENQUAKE)-curves.csv \
		--nrml $(OPENQUAKE).xml --imt PGV > /dev/null
	$(OPENQUAKE_VENV)/bin/python tests/python/check_nrml.py $(OPENQUAKE).xml $(OPENQUAKE)-curves.csv

$(OPENQUAKE_VENV)/ready:
	python3 -m venv $(OPENQUAKE_VENV)
	$(OPENQUAKE_VENV)/bin/pip install --quiet --no-deps openquake.engine==3.26.2
	$(OPENQUAKE_VENV)/bin/pip install --quiet $(OPENQUAKE_NEEDS) 2> /dev/null
	touch $@
