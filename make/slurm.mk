# mrbd slurm on a real Slurm, on this machine.

.PHONY: test-slurm slurm-packages

test-slurm: ## job arrays on a real Slurm of one node: killed, warned, lost and cancelled tasks, and the merge
	@missing=$$(for program in munged slurmctld slurmd sbatch; do \
		PATH=$$PATH:/usr/sbin command -v $$program > /dev/null || echo $$program; done); \
	if [ -n "$$missing" ]; then \
		echo "SKIPPED: make test-slurm needs" $$missing "of Debian's slurm-wlm and munge: make slurm-packages, as root"; \
	else \
		cargo test --release --locked --test it --no-run && \
		{ tests/slurm/with_cluster.sh cargo test --release --locked --test it -- --ignored in_slurm \
		|| { [ $$? -eq 77 ] && echo "SKIPPED: make test-slurm: no Slurm comes up on this machine"; }; }; \
	fi

slurm-packages: ## install what test-slurm needs, as root on Debian; starts and configures nothing
	apt-get update --quiet --quiet
	DEBIAN_FRONTEND=noninteractive apt-get install --yes --quiet --quiet --no-install-recommends slurm-wlm munge
