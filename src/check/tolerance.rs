//! How far a median may move: as far as it moves with the tolerance of the solver.
//!
//! Where two impacts nearly coincide a rounding decides the later motion, so a few medians of a correct program move
//! whenever the order of its operations changes, and most do not. Which ones, and how far, the variants tell that
//! differ from the first by a tighter tolerance alone: each places its steps elsewhere. Every median has its own
//! allowance, so that one that moves does not hide a change of its neighbours.

use crate::aggregate::{Case, Measure, Median, Medians, VariantNote};

/// Least tolerance of a median rotation over α: ten times the error that the solver is allowed (1e-6) in a run.
pub const FLOOR: f64 = 1e-5;

/// The distances between the variants are few samples of what roundings do; another may be twice as large. With the
/// four of pipelines/check.toml, of its 360 medians at most 2 are farther at any of nine other tolerances from 1e-12
/// to 1.01e-6, and none with steps placed as little elsewhere as roundings do (tolerances 0.01 % to 1 % off).
pub const TIMES: f64 = 2.0;

/// How the tolerances of a baseline came about.
pub(super) fn told(reruns: &[&VariantNote]) -> String {
    let solver: Vec<String> = reruns.iter().map(|variant| format!("{:e}", variant.tolerance)).collect();
    format!(
        "{TIMES} times the largest distance of this median from those at other tolerances of the solver ({}), and at \
         least {FLOOR:e}; inf where some of these medians are collapses and some are not",
        solver.join(", ")
    )
}

/// The variants that differ from the first by a tighter tolerance alone, as far as their runs tell.
pub(super) fn reruns(variants: &[VariantNote]) -> Vec<&VariantNote> {
    let others = |v: &VariantNote| (v.length_m, v.density_kg_m3, v.law.clone(), v.capture_velocity_rad_s);
    let Some((base, rest)) = variants.split_first() else { return Vec::new() };
    rest.iter().filter(|v| v.tolerance < base.tolerance && others(v) == others(base)).collect()
}

/// How far a median of the base, and its count of collapses, may move.
pub(super) fn tolerances(medians: &Medians, reruns: &[&VariantNote], row: &Median) -> (f64, u64) {
    let twins = reruns.iter().filter_map(|variant| twin(medians, &variant.name, &row.case, row.measure));
    twins.fold((FLOOR, 0), |(median, collapsed), twin| {
        let distance = match (middle(row), middle(twin)) {
            (Some(a), Some(b)) => TIMES * (a - b).abs(),
            (None, None) => 0.0,
            _ => f64::INFINITY,
        };
        (median.max(distance), collapsed.max(row.collapsed.abs_diff(twin.collapsed)))
    })
}

/// The median rotation; none for a collapse.
pub(super) fn middle(row: &Median) -> Option<f64> {
    match row.middle() {
        Some(crate::aggregate::Middle::Rotation(value)) => Some(value),
        _ => None,
    }
}

fn twin<'m>(medians: &'m Medians, variant: &str, case: &Case, measure: Measure) -> Option<&'m Median> {
    medians.get(&Case { variant: variant.to_owned(), ..case.clone() }, measure)
}
