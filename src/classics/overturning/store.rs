//! The spectrum in Parquet: every trial, and the boundaries.

use std::path::Path;

use super::spectrum::{Boundary, Spectrum, Trial};
use super::study::Study;
use super::words::assumptions;
use crate::error::Result;
use crate::store::{Column, Read, write_table};

static TRIALS: [Column<Trial>; 7] = [
    Column::input(
        "frequency_over_p",
        "",
        "frequency of the pulse over p",
        Read::Number(|t| Some(t.frequency_over_p)),
    ),
    Column::input(
        "amplitude_over_alpha_g",
        "",
        "amplitude of the pulse over αg",
        Read::Number(|t| Some(t.amplitude_over_alpha_g)),
    ),
    Column::input("period_s", "s", "period of the pulse", Read::Number(|t| Some(t.period_s))),
    Column::input(
        "amplitude_m_s2",
        "m/s²",
        "amplitude of the pulse",
        Read::Number(|t| Some(t.amplitude_m_s2)),
    ),
    Column::result("overturned", "", "whether the wall overturned", Read::Flag(|t| Some(t.overturned))),
    Column::result(
        "theta1_max_over_alpha1",
        "",
        "largest rotation of the lower body over its α_1",
        Read::Number(|t| Some(t.theta1_max_over_alpha1)),
    ),
    Column::result("impacts", "", "impacts until the end", Read::Count(|t| Some(t.impacts))),
];

static BOUNDARIES: [Column<Boundary>; 4] = [
    Column::input(
        "frequency_over_p",
        "",
        "frequency of the pulse over p",
        Read::Number(|b| Some(b.frequency_over_p)),
    ),
    Column::result(
        "below_over_alpha_g",
        "",
        "largest amplitude found below the boundary, over αg",
        Read::Number(|b| Some(b.below_over_alpha_g)),
    ),
    Column::result(
        "above_over_alpha_g",
        "",
        "smallest amplitude found above the boundary, over αg",
        Read::Number(|b| Some(b.above_over_alpha_g)),
    ),
    Column::result(
        "overturns_above",
        "",
        "whether amplitudes above overturn",
        Read::Flag(|b| Some(b.overturns_above)),
    ),
];

/// What is written.
pub const FILES: [&str; 2] = ["trials.parquet", "boundaries.parquet"];

/// Writes `trials.parquet` and `boundaries.parquet` into a folder.
///
/// # Errors
/// What the file system says.
pub fn store(folder: &Path, study: &Study, spectrum: &Spectrum) -> Result<()> {
    let mut metadata = vec![
        ("tool".to_owned(), format!("mrbd {}", env!("CARGO_PKG_VERSION"))),
        ("study".to_owned(), study.name.clone()),
        ("shape".to_owned(), study.pulse.name().to_owned()),
    ];
    metadata.extend(assumptions(study));
    write_table(&folder.join("trials.parquet"), &TRIALS, &metadata, &spectrum.trials)?;
    write_table(&folder.join("boundaries.parquet"), &BOUNDARIES, &metadata, &spectrum.boundaries)
}
