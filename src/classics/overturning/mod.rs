//! Overturning spectra: which pulses, by amplitude and frequency, overturn a block or a wall.
//!
//! After Zhang and Makris (2001), "Rocking response of free-standing blocks under cycloidal pulses": amplitudes in units of
//! α g, frequencies in units of p = √(3g/4R). Overturning is not a threshold: above the amplitudes that overturn a block
//! without impact or after one, there may be larger ones that it survives.
//!
//! The grid is run, the boundaries between standing and overturning are narrowed. Parquet files take every trial and the
//! boundaries; as text, amplitude grows upwards and frequency to the right.

mod study;

use std::path::Path;

use crate::error::{Error, Result};
use crate::store::{Column, Read, write_table};
use crate::text::aligned;
use mrbd_kernel::model::{G_M_S2, Wall};
use mrbd_kernel::simulate::{Accuracy, Outcome, Response, Shaking, simulate};
use rayon::prelude::*;
use study::assumptions;
pub use study::{PulseShape, Range, Study};

/// One pulse and what it did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial {
    /// Frequency of the pulse over p.
    pub frequency_over_p: f64,
    /// Amplitude of the pulse over α g.
    pub amplitude_over_alpha_g: f64,
    /// Period of the pulse, s.
    pub period_s: f64,
    /// Amplitude of the pulse, m/s².
    pub amplitude_m_s2: f64,
    /// Whether the wall overturned.
    pub overturned: bool,
    /// Largest rotation of the lower body over its α_1.
    pub theta1_max_over_alpha1: f64,
    /// Impacts until the end.
    pub impacts: u64,
}

/// An amplitude at which standing turns into overturning, or back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Boundary {
    /// Frequency of the pulse over p.
    pub frequency_over_p: f64,
    /// Largest amplitude found below, over α g.
    pub below_over_alpha_g: f64,
    /// Smallest amplitude found above, over α g.
    pub above_over_alpha_g: f64,
    /// Whether amplitudes above overturn.
    pub overturns_above: bool,
}

/// Everything that was tried, by frequency and then amplitude, and the boundaries between.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// The grid.
    pub trials: Vec<Trial>,
    /// Boundaries between neighbours of the grid that differ; two within one spacing of the grid are not seen.
    pub boundaries: Vec<Boundary>,
}

/// p = √(3g/4R) of the uncracked wall, rad/s, with R half its diagonal between rocking corners.
fn rocking_frequency_rad_s(wall: &Wall) -> f64 {
    let p = wall.parameters();
    let half_diagonal_m = 0.5 * wall.indented().lower_width_m.hypot(p.height_m);
    (0.75 * G_M_S2 / half_diagonal_m).sqrt()
}

/// Runs a study; `done` is told after each frequency.
///
/// # Errors
/// [`Error::Run`] if a run cannot be finished.
pub fn spectrum(study: &Study, done: impl Fn() + Sync) -> Result<Spectrum> {
    let columns: Result<Vec<_>> = study
        .frequency_over_p
        .values()
        .into_par_iter()
        .map(|frequency_over_p| column(study, frequency_over_p).inspect(|_| done()))
        .collect();
    let (trials, boundaries): (Vec<_>, Vec<_>) = columns?.into_iter().unzip();
    Ok(Spectrum { trials: trials.concat(), boundaries: boundaries.concat() })
}

fn column(study: &Study, frequency_over_p: f64) -> Result<(Vec<Trial>, Vec<Boundary>)> {
    let amplitudes = study.amplitude_over_alpha_g.values();
    let trials: Vec<Trial> =
        amplitudes.into_iter().map(|a| trial(study, frequency_over_p, a)).collect::<Result<_>>()?;
    let changes = trials.windows(2).filter(|pair| pair[0].overturned != pair[1].overturned);
    let boundaries = changes.map(|pair| boundary(study, &pair[0], &pair[1])).collect::<Result<_>>()?;
    Ok((trials, boundaries))
}

fn boundary(study: &Study, below: &Trial, above: &Trial) -> Result<Boundary> {
    let (mut low, mut high) = (below.amplitude_over_alpha_g, above.amplitude_over_alpha_g);
    while high - low > study.boundary_tolerance {
        let middle = 0.5 * (low + high);
        if trial(study, below.frequency_over_p, middle)?.overturned == above.overturned {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok(Boundary {
        frequency_over_p: below.frequency_over_p,
        below_over_alpha_g: low,
        above_over_alpha_g: high,
        overturns_above: above.overturned,
    })
}

fn trial(study: &Study, frequency_over_p: f64, amplitude_over_alpha_g: f64) -> Result<Trial> {
    let p = rocking_frequency_rad_s(&study.wall);
    let period_s = std::f64::consts::TAU / (frequency_over_p * p);
    let amplitude_m_s2 = amplitude_over_alpha_g * study.wall.alpha_rad() * G_M_S2;
    let response = run(study, amplitude_m_s2, period_s, study.least_tail_times_p / p)?;
    Ok(Trial {
        frequency_over_p,
        amplitude_over_alpha_g,
        period_s,
        amplitude_m_s2,
        overturned: response.collapsed(),
        theta1_max_over_alpha1: response.theta_max_over_alpha_i()[0],
        impacts: response.impacts.total(),
    })
}

fn run(study: &Study, amplitude_m_s2: f64, period_s: f64, least_tail_s: f64) -> Result<Response> {
    let step_s = period_s / f64::from(study.samples_per_period);
    let pulse = study.pulse.pulse(amplitude_m_s2, period_s).accelerogram(Some(step_s));
    let failed = |reason: String| Error::Run { time_s: 0.0, reason };
    let horizontal = pulse.map_err(|e| failed(e.to_string()))?;
    let tail_s = least_tail_s.max(study.tail_over_period * period_s);
    let shaking = Shaking { horizontal: Some(horizontal), vertical: None, tail_s };
    let response = simulate(&study.wall, &shaking, Accuracy { tolerance: study.tolerance });
    match response.outcome {
        Outcome::Failed { time_s, ref reason } => Err(Error::Run { time_s, reason: reason.clone() }),
        _ => Ok(response),
    }
}

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

/// One line an amplitude, largest first, one mark a frequency: `#` overturned, `.` stood; then the boundaries.
pub fn picture(spectrum: &Spectrum) -> String {
    let mut amplitudes: Vec<f64> = spectrum.trials.iter().map(|t| t.amplitude_over_alpha_g).collect();
    amplitudes.sort_by(f64::total_cmp);
    amplitudes.dedup();
    let row = |amplitude: &f64| {
        let marks = spectrum.trials.iter().filter(|t| t.amplitude_over_alpha_g == *amplitude);
        let marks: String = marks.map(|t| if t.overturned { '#' } else { '.' }).collect();
        format!("{amplitude:>9.3}  {marks}\n")
    };
    let grid: String = amplitudes.iter().rev().map(row).collect();
    let ends = (spectrum.trials.first(), spectrum.trials.last());
    let axis = match ends {
        (Some(first), Some(last)) => {
            format!("ω/p from {} to {}", first.frequency_over_p, last.frequency_over_p)
        }
        _ => String::new(),
    };
    format!("amplitude over αg; # overturned, . stood\n{grid}{:>11}{axis}\n\n{}", "", boundaries(spectrum))
}

fn boundaries(spectrum: &Spectrum) -> String {
    let head = ["ω/p", "boundary over αg", "above it"].map(str::to_owned).to_vec();
    let rows = spectrum.boundaries.iter().map(|b| {
        let middle = 0.5 * (b.below_over_alpha_g + b.above_over_alpha_g);
        let above = if b.overturns_above { "overturns" } else { "stands" };
        vec![format!("{:.3}", b.frequency_over_p), format!("{middle:.4}"), above.to_owned()]
    });
    aligned(&std::iter::once(head).chain(rows).collect::<Vec<_>>()) + "\n"
}
