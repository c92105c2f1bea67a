//! The medians of a study as entries of a baseline, their tolerances not yet known.

use super::baseline::Entry;
use crate::aggregate::{CAPACITY, Distribution, Distributions, Measure, Median, Medians, Middle};
use crate::study::pipeline::Kind;

/// The medians of θ_i/α_i of a sweep.
pub fn figures_of_sweep(medians: &Medians) -> Vec<Entry> {
    let rows = medians.rows().iter().filter(|row| Measure::BODIES.contains(&row.measure));
    rows.map(of_median).collect()
}

/// The medians of a study of drawn façades: θ_i/α_i, or the intensities at which limits are exceeded.
pub fn figures_of_drawn(study: &Distributions) -> Vec<Entry> {
    let quantities: &[&str] = match study.kind {
        Kind::Incremental => &[CAPACITY],
        _ => &["theta1_max_over_alpha1", "theta2_max_over_alpha2"],
    };
    let rows = study.rows.iter().filter(|row| quantities.contains(&row.quantity));
    rows.map(|row| of_distribution(row, study.measure.as_deref())).collect()
}

fn of_median(row: &Median) -> Entry {
    let median = match row.middle() {
        Some(Middle::Rotation(value)) => Some(value),
        _ => None,
    };
    Entry {
        variant: row.case.variant.clone(),
        configuration: row.case.configuration.name().to_owned(),
        parameter: row.case.parameter.name().to_owned(),
        level: row.case.level.name(row.case.parameter).to_owned(),
        slenderness: Some(row.case.slenderness),
        record: String::new(),
        measure: row.measure.column().to_owned(),
        runs: row.runs,
        failed: row.failed,
        collapsed: row.collapsed,
        collapsed_tolerance: 0,
        median,
        tolerance: 0.0,
    }
}

fn of_distribution(row: &Distribution, measure: Option<&str>) -> Entry {
    Entry {
        variant: row.variant.clone(),
        configuration: row.configuration.clone(),
        parameter: String::new(),
        level: row.stratum(measure),
        slenderness: None,
        record: row.record.clone().unwrap_or_default(),
        measure: row.quantity.to_owned(),
        runs: row.runs,
        failed: row.failed,
        collapsed: row.beyond,
        collapsed_tolerance: 0,
        median: row.median(),
        tolerance: 0.0,
    }
}
