# This kernel beside that of another commit, on the same walls, in turns.

BASE ?=
TURNS ?= 7
BASE_TREE := target/base

.PHONY: bench-against

bench-against: ## walls a second by this kernel and by that of another commit, in turns: BASE=COMMIT
	@test -n "$(BASE)" || { echo "make bench-against: which commit? BASE=COMMIT"; exit 2; }
	git worktree prune
	@test -d $(BASE_TREE) || git worktree add --quiet --detach $(BASE_TREE) $(BASE)
	git -C $(BASE_TREE) checkout --quiet --force --detach $(BASE)
	mkdir -p $(BASE_TREE)/examples && cp examples/walls_a_second.rs $(BASE_TREE)/examples/
	cargo build --release --locked --example walls_a_second
	cargo build --release --locked --example walls_a_second --manifest-path $(BASE_TREE)/Cargo.toml --target-dir $(BASE_TREE)/target
	@sh benches/against.sh $(BASE_TREE)/target/release/examples/walls_a_second $(CARGO_TARGET)/release/examples/walls_a_second $(TURNS)
