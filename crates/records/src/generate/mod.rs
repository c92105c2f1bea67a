//! Generated records, which stand in for the rows of a published table.
//!
//! A record has the peak acceleration and velocity of its row, a length that fits its magnitude and distance, and a
//! smooth spectrum. With a site, the mean spectrum of the table is near that of the code.
//!
//! Noise under an envelope is brought to a target spectrum by repeated correction of its Fourier amplitudes. Its peaks
//! are set by small wavelets, and its end is brought to rest exactly. The method is that of Gasparini and Vanmarcke
//! (1976), "SIMQKE: a program for artificial motion generation". A record depends on the seed and its row alone.

mod corrections;
mod design;
mod noise;

use std::path::Path;

use crate::code_spectrum::Site;
use crate::record_table::{RecordTable, TableRow};
use crate::suite_file::{RecordEntry, SuiteFile};
use crate::{Accelerogram, Pulse, write_two_columns};
use mrbd_files::error::{Error, Result};

use design::Design;

/// Time between the samples of generated records, s.
pub const STEP_S: f64 = 0.01;
/// Rounds of correcting the spectrum: more change it by less than it differs between records.
const ROUNDS: usize = 24;
/// Rounds of setting the peaks: each disturbs the other by less than the last.
const PEAK_ROUNDS: usize = 6;

const NOTE: &str = "Generated, not measured: each record has the peak acceleration and velocity of its row and a length \
    that fits its magnitude and distance, but is noise brought to a smooth spectrum.";

/// Generates a record for every row of `table`, before scaling by the factor of the row.
///
/// With a site, targets are adjusted so that the mean of the scaled records follows its code spectrum.
pub fn generate(table: &RecordTable, site: Option<&Site>, seed: u64) -> Vec<Accelerogram> {
    let designs = design::designs(table, site);
    table.records.iter().zip(&designs).map(|(row, design)| record(row, design, seed)).collect()
}

fn record(row: &TableRow, design: &Design, seed: u64) -> Accelerogram {
    let mut rng = noise::generator(seed, row.id);
    let mut samples = noise::under_envelope(design.duration_s, &mut rng);
    let target = design.target();
    for _ in 0..ROUNDS {
        noise::match_spectrum(&mut samples, &target);
        // Setting the velocity in every round gathers long waves about its peak: their phases stay when their amplitudes
        // are corrected, so the velocity is reached at the spectrum of the code and not by raising it.
        corrections::set_velocity(&mut samples, design.noise_pgv_m_s, design.corner_s);
        corrections::end_at_rest(&mut samples);
    }
    if let Some(period_s) = row.pulse_period_s {
        add_pulse(&mut samples, period_s, design);
    }
    for _ in 0..PEAK_ROUNDS {
        corrections::set_velocity(&mut samples, design.pgv_m_s, design.corner_s);
        corrections::end_at_rest(&mut samples);
        // Last, because what its short wavelets leave of velocity is some quanta, which rounding takes off.
        corrections::set_acceleration(&mut samples, design.pga_m_s2);
    }
    let unscaled: Vec<f64> = samples.iter().map(|a| a / row.scale).collect();
    as_record(&corrections::round_at_rest(&unscaled))
}

/// Adds a near-fault pulse where the strong shaking begins.
fn add_pulse(samples: &mut [f64], period_s: f64, design: &Design) {
    let pulse = Pulse::MavroeidisPapageorgiou {
        velocity_m_s: design.pgv_m_s - design.noise_pgv_m_s,
        period_s,
        oscillations: 2.0,
        phase_rad: 0.0,
    };
    let start_s = noise::LEAD_S + 0.1 * design.duration_s;
    for (i, sample) in samples.iter_mut().enumerate() {
        *sample += pulse.acceleration_m_s2(i as f64 * STEP_S - start_s);
    }
}

fn as_record(samples: &[f64]) -> Accelerogram {
    // Finite numbers, far more than two, at a positive step: sums and products of finite numbers of ordinary size.
    Accelerogram::new(STEP_S, samples.to_vec()).expect("generated samples are finite")
}

/// Writes `records`, generated for the rows of `table` with `seed`, into `folder`, with a `suite.toml` that lists them.
///
/// # Errors
/// Where the folder or a file cannot be written.
pub fn write_suite(
    folder: &Path,
    name: &str,
    table: &RecordTable,
    records: &[Accelerogram],
    seed: u64,
) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|e| Error::io("make the folder", folder, e))?;
    let mut entries = Vec::with_capacity(records.len());
    for (row, record) in table.records.iter().zip(records) {
        let file = format!("generated_{}_{}.csv", row.id, row.archive_id);
        write_two_columns(&folder.join(&file), record)?;
        entries.push(RecordEntry::of_row(row, file));
    }
    let suite = SuiteFile {
        name: name.to_owned(),
        generated: true,
        note: NOTE.to_owned(),
        source: format!("mrbd records generate --seed {seed}, after: {}", table.source),
        unit: None,
        step_s: None,
        columns: None,
        decimal_comma: false,
        records: entries,
    };
    suite.write(&folder.join("suite.toml"))
}
