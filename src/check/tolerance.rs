//! How far a median may move: as far as it moves with the tolerance of the solver.
//!
//! Where two impacts nearly coincide a rounding decides the later motion, so a few medians of a correct program move
//! whenever the order of its operations changes, and most do not. Which ones, and how far, the variants tell that
//! differ from the first by a tighter tolerance alone: each places its steps elsewhere. Every median has its own
//! allowance, so that one that moves does not hide a change of its neighbours.

use std::collections::BTreeMap;

use super::baseline::{Entry, Key};
use crate::aggregate::VariantNote;

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

/// The medians of the base with how far each, and its count of collapses, may move, as its `reruns` tell.
pub(super) fn with_tolerances(bases: Vec<Entry>, reruns: &[Entry]) -> Vec<Entry> {
    let mut twins: BTreeMap<Key, Vec<&Entry>> = BTreeMap::new();
    reruns.iter().for_each(|rerun| twins.entry(case_of(rerun)).or_default().push(rerun));
    let tolerant = |base: &Entry| {
        let twins = twins.get(&case_of(base)).into_iter().flatten();
        let (tolerance, collapsed_tolerance) = twins.fold((FLOOR, 0), |(median, collapsed), twin| {
            let distance = match (base.median, twin.median) {
                (Some(a), Some(b)) => TIMES * (a - b).abs(),
                (None, None) => 0.0,
                _ => f64::INFINITY,
            };
            (median.max(distance), collapsed.max(base.collapsed.abs_diff(twin.collapsed)))
        });
        Entry { tolerance, collapsed_tolerance, ..base.clone() }
    };
    bases.iter().map(tolerant).collect()
}

/// What tells a case apart within its variant.
fn case_of(entry: &Entry) -> Key<'_> {
    let (_, configuration, parameter, level, slenderness, record, measure) = entry.key();
    ("", configuration, parameter, level, slenderness, record, measure)
}
