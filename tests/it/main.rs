//! One integration binary, because linking is slow.
//!
//! Test names carry their kind: `analytic_` (a closed form or an invariant), `published_` (a figure from the literature),
//! `verified_` (an independent program), `regress_` (our own earlier result), `rejects_` (bad input).

mod assess;
mod beds;
mod blind;
mod calibrate_cli;
mod calibrate_files;
mod calibrate_search;
mod calibrate_support;
mod calibrate_twin;
mod campaign;
mod campaign_cli;
mod check;
mod cli_records;
mod cli_simulate;
mod convergence;
mod describe;
mod diagnose;
mod diagnose_force;
mod diagnose_twin;
mod direction;
mod drawn;
mod drawn_cli;
mod drawn_support;
mod effects_catalogue;
mod effects_laws;
mod effects_reference;
mod effects_runs;
mod effects_same;
mod energy;
mod first_steps;
mod fragility;
mod fragility_coverage;
mod fragility_tables;
#[cfg(target_os = "linux")]
mod full_disk;
mod grazing_contact;
mod ground_formats;
mod ground_generated;
mod ground_intensity;
mod ground_mutations;
mod ground_samples;
mod ground_suite;
mod guide;
mod impacts;
mod limits;
mod margin;
mod matrix_form;
mod matrix_model;
mod measured_walls;
mod overturning;
mod pipeline_batch;
mod pipeline_cli;
mod pipeline_findings;
mod pipeline_plan;
mod pipeline_support;
mod published;
mod push;
mod readme;
mod replay;
mod report_browser;
mod report_kinds;
mod report_pages;
mod shared;
mod side_by_side;
mod slurm;
#[cfg(target_os = "linux")]
mod slurm_cluster;
mod stranger;
mod symmetry;
mod traps;
mod unfinished;
mod verification;
mod walls;
mod windows;
