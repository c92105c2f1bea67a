//! `mrbd records describe`: how strong records are.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::{ReadArgs, print_json, print_table};
use crate::error::{InputError, Result};
use mrbd_records::{Accelerogram, CODE_DAMPING, IntensityMeasures, Suite, response_spectrum_m_s2};

/// Describe records: step, length and intensity measures.
///
/// PGV and PGD are integrals from rest without baseline correction. Records of a suite are described as scaled.
///
/// Examples:
///   mrbd records describe gilroy.AT2
///   mrbd records describe --suite inputs/records/emilia7/suite.toml --json
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct DescribeArgs {
    /// Record files.
    #[arg(required_unless_present = "suite")]
    files: Vec<PathBuf>,
    /// A suite, instead of files or beside them.
    #[arg(long, value_name = "FILE")]
    suite: Option<PathBuf>,
    /// Print JSON, with the response spectrum at 5 % damping.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    read: ReadArgs,
}

/// Periods of the spectrum in JSON, s.
const PERIODS_S: [f64; 23] = [
    0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.25, 1.5, 1.75, 2.0,
    2.5, 3.0, 3.5, 4.0,
];

#[derive(Serialize)]
struct Description {
    name: String,
    format: Option<String>,
    channel: Option<String>,
    /// `None` of a file by itself: only a suite says it.
    generated: Option<bool>,
    scale: f64,
    step_s: f64,
    samples: usize,
    duration_s: f64,
    intensity: IntensityMeasures,
    spectrum: Spectrum,
}

#[derive(Serialize)]
struct Spectrum {
    damping: f64,
    period_s: Vec<f64>,
    sa_m_s2: Vec<f64>,
}

impl Description {
    fn new(name: String, record: &Accelerogram) -> Self {
        let sa_m_s2 = response_spectrum_m_s2(record, &PERIODS_S, CODE_DAMPING);
        Self {
            name,
            format: None,
            channel: None,
            generated: None,
            scale: 1.0,
            step_s: record.step_s(),
            samples: record.acceleration_m_s2().len(),
            duration_s: record.duration_s(),
            intensity: IntensityMeasures::of(record),
            spectrum: Spectrum { damping: CODE_DAMPING, period_s: PERIODS_S.to_vec(), sa_m_s2 },
        }
    }
}

pub(super) fn execute(args: &DescribeArgs) -> Result<()> {
    let descriptions = descriptions(args)?;
    if args.json {
        return print_json(&descriptions);
    }
    let heading = [
        "record",
        "step s",
        "samples",
        "length s",
        "PGA g",
        "PGV m/s",
        "PGD m",
        "Arias m/s",
        "CAV m/s",
        "D5-95 s",
        "Tm s",
        "Sa(0.5 s) m/s2",
        "Sa(1 s) m/s2",
        "Sa average m/s2",
    ];
    print_table(&heading, &descriptions.iter().map(row).collect::<Vec<_>>())
}

fn descriptions(args: &DescribeArgs) -> Result<Vec<Description>> {
    let mut descriptions = Vec::new();
    for file in &args.files {
        let record = args.read.read(file)?;
        let mut description = Description::new(record.name, &record.accelerogram);
        description.format = Some(record.format.to_string());
        description.channel = record.channel;
        descriptions.push(description);
    }
    let Some(path) = &args.suite else { return Ok(descriptions) };
    if args.read.options() != Default::default() {
        let found = "--dt, --unit, --columns or --channel beside a suite";
        return Err(InputError::option("--suite", found, "the suite file states them").into());
    }
    for record in Suite::load(path)?.records {
        let mut description = Description::new(record.name, &record.horizontal);
        (description.scale, description.generated) = (record.scale, Some(record.generated));
        descriptions.push(description);
    }
    Ok(descriptions)
}

fn row(description: &Description) -> Vec<String> {
    let measures = &description.intensity;
    let numbers = [
        (description.duration_s, 2),
        (measures.pga_g, 4),
        (measures.pgv_m_s, 4),
        (measures.pgd_m, 4),
        (measures.arias_m_s, 3),
        (measures.cav_m_s, 2),
        (measures.duration_5_95_s, 2),
        (measures.mean_period_s, 3),
        (measures.sa_0p5s_m_s2, 3),
        (measures.sa_1p0s_m_s2, 3),
        (measures.sa_average_m_s2, 3),
    ];
    let words = [description.name.clone(), description.step_s.to_string(), description.samples.to_string()];
    words.into_iter().chain(numbers.map(|(value, decimals)| format!("{value:.decimals$}"))).collect()
}
