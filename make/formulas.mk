# A public engine of symbolic regression on the points that mrbd measured, beside mrbd's answers.

FORMULA_CRATE := benches/formula_rival
# Folders of answered blind cases.
FORMULA_CASES ?= outputs/blind/laws2/case_*

.PHONY: bench-formulas

bench-formulas: ## formulas of a public engine beside those of blind cases answered before: FORMULA_CASES="outputs/blind/laws2/case_*"
	@if cargo fetch --quiet --locked --manifest-path $(FORMULA_CRATE)/Cargo.toml; then \
		cargo run --release --locked --quiet --manifest-path $(FORMULA_CRATE)/Cargo.toml \
			--target-dir $(CARGO_TARGET)/formula-rival -- $(FORMULA_CASES); \
	else \
		echo "SKIPPED: the package registry does not answer, no other engine for formulas"; \
	fi
