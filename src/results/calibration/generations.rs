//! `generations.parquet`: how every search converged, one generation a row (the paper's Fig. 6).

use std::path::Path;

use crate::error::Result;
use crate::store::{Column, Read, write_table};
use mrbd_lab::calibrate::MethodResult;

/// One generation of one search.
#[derive(Debug, Clone, PartialEq)]
struct Generation {
    method: String,
    test: Option<String>,
    generation: u64,
    vectors: u64,
    best_wme: Option<f64>,
    sum_wme: Option<f64>,
}

static GENERATIONS: [Column<Generation>; 6] = [
    Column::input("method", "", "search", Read::Text(|g| Some(g.method.as_str().into()))),
    Column::input(
        "test",
        "",
        "test searched; null: all tests to fit, jointly",
        Read::Text(|g| g.test.as_deref().map(Into::into)),
    ),
    Column::input("generation", "", "generation of the search, from 0", Read::Count(|g| Some(g.generation))),
    Column::input("vectors", "", "vectors simulated up to here", Read::Count(|g| Some(g.vectors))),
    Column::result(
        "best_wme",
        "",
        "lowest cost so far: WME, raised by a prior",
        Read::Number(|g| g.best_wme),
    ),
    Column::result(
        "sum_wme",
        "",
        "sum of costs over the population; null while a vector of it has no misfit (Fig. 6)",
        Read::Number(|g| g.sum_wme),
    ),
];

/// Writes the generations of the searches.
///
/// # Errors
/// [`crate::Error::Table`] or [`mrbd_files::Error::Io`] if the file cannot be written.
pub(super) fn write_generations(path: &Path, methods: &[MethodResult]) -> Result<()> {
    let rows = methods.iter().flat_map(generations).collect::<Vec<_>>();
    write_table(path, &GENERATIONS, &[], &rows)
}

fn generations(m: &MethodResult) -> impl Iterator<Item = Generation> {
    (0..m.best_costs.len()).map(|g| Generation {
        method: m.method.clone(),
        test: m.test.clone(),
        generation: g as u64,
        vectors: m.vectors[g] as u64,
        best_wme: Some(m.best_costs[g]).filter(|cost| cost.is_finite()),
        sum_wme: Some(m.cost_sums[g]).filter(|sum| sum.is_finite()),
    })
}
