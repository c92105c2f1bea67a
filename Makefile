# The main jobs. Everything they need beside the Rust toolchain and Debian's build tools is built here.

# Where cargo builds.
CARGO_TARGET := $(or $(CARGO_TARGET_DIR),target)

# The suite of accelerograms the sweep runs on; any other by SUITE=FILE.
SUITE ?= inputs/records/emilia7/suite.toml

# What `mrbd --version` says beside the version; empty where there is no git.
export MRBD_COMMIT := $(shell git describe --always --dirty --exclude '*' 2>/dev/null)

include make/records.mk
include make/examples.mk
include make/openquake.mk
include make/against.mk
include make/peers.mk
include make/formulas.mk
include make/python.mk
include make/slurm.mk

.DEFAULT_GOAL := help
.PHONY: help sweep beds suites measures variance variance-beds million monte-carlo fragility measured measured-rivals assess-table check readme test stranger test-browser bench blind blind-calibrations lint docs clean

help: ## this list
	@grep -hE '^[a-z0-9-]+:.*## ' $(MAKEFILE_LIST) | awk -F ':.*## ' '{printf "make %-14s %s\n", $$1, $$2}'

sweep: ## run the parametric sweep of the paper, print medians and checked conclusions, make its page
	cargo run --release --locked --bin mrbd -- run pipelines/sweep.toml --suite $(SUITE) --out outputs/sweep --force
	@echo "The page of the results:"
	@cargo run --release --locked --quiet --bin mrbd -- report outputs/sweep --site inputs/site_mirandola.toml

monte-carlo: ## run façades drawn from the survey under the records at their own scale, print quantiles
	cargo run --release --locked --bin mrbd -- run pipelines/monte_carlo.toml --suite $(SUITE) --out outputs/monte_carlo --force

fragility: ## run drawn façades under scaled records, fit θ/α > 0.1, θ/α > 0.5 and collapse
	cargo run --release --locked --bin mrbd -- run pipelines/fragility.toml --suite $(SUITE) --out outputs/fragility --force
	cargo run --release --locked --quiet --bin mrbd -- fragility outputs/fragility --threshold 0.1 --threshold 0.5 \
		--out outputs/fragility/curves.csv --nrml outputs/fragility/fragility.xml --imt PGV

measured: ## a wall that was measured: joints that give fitted, and what its releases say of what is missing, each judged on the other
	cargo run --release --locked --bin mrbd -- calibrate inputs/measured/griffith_2004/experiment_a.toml --out outputs/measured_a --resume
	cargo run --release --locked --quiet --bin mrbd -- calibrate inputs/measured/griffith_2004/experiment_b.toml --out outputs/measured_b --resume
	cargo run --release --locked --quiet --bin mrbd -- calibrate inputs/measured/griffith_2004/after_a.toml --out outputs/measured_after_a --resume
	cargo run --release --locked --quiet --bin mrbd -- calibrate inputs/measured/griffith_2004/after_b.toml --out outputs/measured_after_b --resume
	cargo run --release --locked --quiet --bin mrbd -- diagnose inputs/measured/griffith_2004/diagnose_a.toml --out outputs/measured_diagnose_a
	cargo run --release --locked --quiet --bin mrbd -- diagnose inputs/measured/griffith_2004/diagnose_b.toml --out outputs/measured_diagnose_b
	cargo run --release --locked --quiet --bin mrbd -- report outputs/measured_a

measured-rivals: ## the same with three lines, a bed that crushes and worn edges in the place of a bed
	@for law in lines crushing worn; do for fit in a b after_a after_b; do \
		cargo run --release --locked --quiet --bin mrbd -- calibrate inputs/measured/griffith_2004/rivals/$${law}_$$fit.toml \
			--out outputs/measured_$${law}_$$fit --resume || exit 1; done; done

assess-table: ## the survey's façades by the code's check and by their own dynamics: table and picture
	cargo run --release --locked --bin mrbd -- assess-survey inputs/survey.toml --coefficients inputs/coefficients.toml \
		--site inputs/site_mirandola.toml --records $(SUITE) --out outputs/assess_table --force > outputs/assess_table.csv

beds: ## the paper's study with joints that give, from hard to soft, beside sharp edges: medians and conclusions, and its page
	cargo run --release --locked --bin mrbd -- run pipelines/beds.toml --suite $(SUITE) --out outputs/beds --force
	@cargo run --release --locked --quiet --bin mrbd -- report outputs/beds --site inputs/site_mirandola.toml

# A suite of measured records beside those of `make suites`.
MEASURED ?=
SUITES := outputs/suites
SWEEP_OF = cargo run --release --locked --quiet --bin mrbd -- run pipelines/sweep.toml --force --out $(SUITES)

suites: ## the paper's study under shipped, measured (MEASURED=SUITE) and FEMA P-695 records side by side
	$(SWEEP_OF)/emilia7 --suite inputs/records/emilia7/suite.toml > /dev/null
	$(if $(MEASURED),$(SWEEP_OF)/measured --suite $(MEASURED) > /dev/null,@echo "no MEASURED=SUITE given: shipped and FEMA P-695 records alone")
	@if $(MAKE) --no-print-directory $(P695_SCALED); then $(SWEEP_OF)/p695 --suite $(P695_SCALED) > /dev/null; else \
		rm -rf $(SUITES)/p695; echo "SKIPPED: the package registry does not answer, no records of FEMA P-695"; fi
	cargo run --release --locked --quiet --bin mrbd -- suites $(SUITES)/emilia7 $(if $(MEASURED),$(SUITES)/measured) \
		$$(test -d $(SUITES)/p695 && echo $(SUITES)/p695) --out $(SUITES)/page --force

measures: ## which intensity measure foretells the response: drawn façades under the 44 components of FEMA P-695
	@$(MAKE) --no-print-directory $(P695_SCALED)
	cargo run --release --locked --bin mrbd -- run pipelines/cloud.toml --suite $(P695_SCALED) --out outputs/cloud_p695 --force > /dev/null
	cargo run --release --locked --quiet --bin mrbd -- measures outputs/cloud_p695 --out outputs/measures --force

VARIANCE_OF = cargo run --release --locked --quiet --bin mrbd

variance: ## which share of the variance record, façade, coefficients, assumptions and chaos have; the records as they are, and twice
	$(VARIANCE_OF) -- run pipelines/variance.toml --suite $(SUITE) --out outputs/variance --force
	$(VARIANCE_OF) -- variance outputs/variance --out outputs/variance_shares --force > /dev/null
	$(VARIANCE_OF) -- run pipelines/variance_strong.toml --suite $(SUITE) --out outputs/variance_strong --force
	$(VARIANCE_OF) -- variance outputs/variance_strong --out outputs/variance_strong_shares --force > /dev/null

variance-beds: ## the same with the stiffness of the joints among the assumptions, which takes longer
	$(VARIANCE_OF) -- run pipelines/variance_beds.toml --suite $(SUITE) --out outputs/variance_beds --force
	$(VARIANCE_OF) -- variance outputs/variance_beds --out outputs/variance_beds_shares --force > /dev/null

million: ## a million runs of drawn façades in one command: time, memory and disk
	cargo build --release --locked --bin mrbd
	python3 make/million.py outputs/million 1000006 $(CARGO_TARGET)/release/mrbd run pipelines/million.toml --out outputs/million --force

check: ## run a smaller sweep and compare its medians with the accepted ones
	cargo run --release --locked --bin mrbd -- run pipelines/check.toml --out outputs/check --force > /dev/null
	cargo run --release --locked --bin mrbd -- check outputs/check --baseline tests/baselines/emilia7.csv

readme: ## figures of README.md and of the guide made anew from runs
	UPDATE_README=1 cargo test --release --locked --test it readme::

test: ## all tests, of the program and of its crates
	cargo test --release --locked --workspace

stranger: ## the tour of a stranger: first steps, every command of the docs, odd inputs, studies cut short
	cargo test --release --locked --test it -- stranger:: guide:: first_steps:: unfinished::

test-browser: ## the pages in a real headless Chromium: no errors, figures present, interactions work
ifeq ($(shell command -v chromium),)
	@echo "make test-browser: skipped, chromium is not installed (apt-get install chromium)"
else
	cargo test --release --locked --test it -- --ignored in_chromium
endif

bench: ## time and work of one run, beside its arithmetic
	cargo bench --locked --package mrbd

# Cases of a set and its name: tune on one, freeze, report on another. Those recorded are counted and not diagnosed again.
FIRST ?= 0
CASES ?= 40
SET ?= tune
RECORDED ?= $(wildcard tests/blind/recorded/$(SET).jsonl)

blind-calibrations: ## twins for mrbd calibrate, made, calibrated and scored: FIRST=0 CASES=40 SET=tune
	cargo test --release --locked --quiet --test blind -- --calibrations --first $(FIRST) --cases $(CASES) --set $(SET) \
		$(if $(RECORDED),--recorded $(RECORDED))

blind: ## blind cases for mrbd diagnose, made, diagnosed and scored: FIRST=0 CASES=40 SET=tune; LAWS=1: of laws in no catalogue; BEDS=1: of joints that give; NULLS=1: of nothing; CORNERS=1: on stiff corners; IMPACTS=1: of impacts that keep less the faster they are
	cargo test --release --locked --quiet --test blind -- --first $(FIRST) --cases $(CASES) --set $(SET) \
		$(if $(LAWS),--laws) $(if $(BEDS),--beds) $(if $(NULLS),--nulls) $(if $(CORNERS),--corners) \
		$(if $(IMPACTS),--impacts) $(if $(RECORDED),--recorded $(RECORDED))

lint: ## formatting, lock files and lints, warnings denied
	cargo fmt --all --check
	for lock in $$(git ls-files '*/Cargo.lock'); do \
		cargo update --workspace --locked --quiet --manifest-path $${lock%lock}toml || exit 1; \
	done
	cargo clippy --release --locked --workspace --all-targets -- -D warnings

docs: ## the library's documentation, warnings denied
	RUSTDOCFLAGS="--deny warnings" cargo doc --release --no-deps --locked --workspace

clean:
	cargo clean
	rm -rf outputs/*/
