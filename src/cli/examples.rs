//! Examples that `--help` ends with, for commands whose description does not have its own.

/// `mrbd run`.
pub const RUN: &str = "Examples:
  mrbd run pipelines/sweep.toml --dry-run | head
  mrbd run pipelines/monte_carlo.toml
  mrbd run pipelines/sweep.toml --suite my-records/suite.toml --out outputs/mine
  mrbd run pipelines/sweep.toml --out outputs/mine --resume
  mrbd run pipelines/sweep.toml --out outputs/mine --shard 3/16";

/// `mrbd merge`.
pub const MERGE: &str = "Examples:
  mrbd merge outputs/mine";

/// `mrbd status`.
pub const STATUS: &str = "Examples:
  mrbd status outputs/mine";

/// `mrbd slurm`.
pub const SLURM: &str = "Examples:
  mrbd slurm pipelines/sweep.toml --tasks 64 --account masonry
  mrbd slurm pipelines/sweep.toml --out /scratch/sweep --cpus 8 --time 01:00:00";

/// `mrbd aggregate`.
pub const AGGREGATE: &str = "Examples:
  mrbd aggregate outputs/sweep
  mrbd aggregate outputs/sweep --csv > medians.csv";

/// `mrbd check`.
pub const CHECK: &str = "Examples:
  mrbd check outputs/check --baseline tests/baselines/emilia7.csv
  mrbd check outputs/check --baseline accepted.csv --accept --because reviewed";

/// `mrbd check-tolerance`.
pub const CHECK_TOLERANCE: &str = "Examples:
  mrbd check-tolerance outputs/monte_carlo
  mrbd check-tolerance outputs/monte_carlo --sample 2000 --tolerance 1e-9";

/// `mrbd report`.
pub const REPORT: &str = "Examples:
  mrbd report outputs/sweep
  mrbd report calibrated
  mrbd report run.parquet
  mrbd report outputs/sweep --site inputs/site_mirandola.toml";
