//! How far a median may move: as far as it moves with the tolerance of the solver.
//!
//! Where two impacts nearly coincide a rounding decides the later motion, so medians of a correct program move a
//! little whenever the order of its operations changes. The variant at a tighter tolerance is a sample of that.

use crate::aggregate::{Case, Measure, Median, Medians, VariantNote};

/// Least tolerance of a median rotation over α: ten times the error that the solver is allowed (1e-6) in a run.
pub const FLOOR: f64 = 1e-5;

/// A distance between two variants is one sample of what roundings do; another may be twice as large.
pub const TIMES: f64 = 2.0;

/// How the tolerances of a baseline came about.
pub(super) fn told(tight: &VariantNote) -> String {
    format!(
        "{TIMES} times the largest distance from the medians of variant {:?} (solver tolerance {:e}) among the cases \
         of the same floor, slenderness and measure, and at least {FLOOR:e}; inf where that variant's median is a \
         collapse and this one's is not, or the reverse",
        tight.name, tight.tolerance
    )
}

/// The first variant that differs from the base by a tighter tolerance alone, as far as its runs tell.
pub(super) fn tighter(variants: &[VariantNote]) -> Option<&VariantNote> {
    let base = variants.first()?;
    let others = |v: &VariantNote| (v.length_m, v.density_kg_m3, v.law.clone(), v.capture_velocity_rad_s);
    variants[1..].iter().find(|v| v.tolerance < base.tolerance && others(v) == others(base))
}

/// How far a median of the base, and its count of collapses, may move.
pub(super) fn tolerances(medians: &Medians, tight: &str, row: &Median) -> (f64, u64) {
    let alike = medians.rows().iter().filter(|other| {
        let (a, b) = (&other.case, &row.case);
        a.variant == b.variant
            && a.configuration == b.configuration
            && a.slenderness.to_bits() == b.slenderness.to_bits()
            && other.measure == row.measure
    });
    let (mut median, mut collapsed) = (FLOOR, 0);
    for other in alike {
        let Some(tight) = twin(medians, tight, &other.case, other.measure) else { continue };
        collapsed = collapsed.max(other.collapsed.abs_diff(tight.collapsed));
        if let (Some(a), Some(b)) = (middle(other), middle(tight)) {
            median = median.max(TIMES * (a - b).abs());
        }
    }
    let own = twin(medians, tight, &row.case, row.measure);
    let unsure = own.is_some_and(|tight| middle(tight).is_some() != middle(row).is_some());
    (if unsure { f64::INFINITY } else { median }, collapsed)
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
