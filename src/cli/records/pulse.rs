//! `mrbd records pulse`: a pulse by name as a record file.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::written;
use crate::error::{InputError, Result};
use mrbd_records::{Pulse, write_two_columns};

/// Write a pulse as a two-column record.
///
/// Examples:
///   mrbd records pulse one-sine --amplitude 3.0 --period 0.8 --out sine.csv
///   mrbd records pulse mavroeidis-papageorgiou --amplitude 0.5 --period 1.4 --oscillations 2 --out pulse.csv
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct PulseArgs {
    /// Form of the pulse.
    kind: Kind,
    /// Amplitude: m/s2 of acceleration; of mavroeidis-papageorgiou m/s of velocity.
    #[arg(long, value_name = "X")]
    amplitude: f64,
    /// Period.
    #[arg(long, value_name = "SECONDS")]
    period: f64,
    /// γ of mavroeidis-papageorgiou: how often it oscillates, more than 1.
    #[arg(long, value_name = "X", default_value_t = 2.0)]
    oscillations: f64,
    /// ν of mavroeidis-papageorgiou.
    #[arg(long, value_name = "RAD", default_value_t = 0.0, allow_negative_numbers = true)]
    phase: f64,
    /// Time between samples; 500 in a period unless given.
    #[arg(long, value_name = "SECONDS")]
    dt: Option<f64>,
    /// CSV file to write; an existing one is not touched.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Kind {
    OneSine,
    OneCosine,
    HalfSine,
    Ricker,
    MavroeidisPapageorgiou,
}

pub(super) fn execute(args: &PulseArgs) -> Result<()> {
    if args.out.exists() {
        let found = format!("{}, which exists", args.out.display());
        return Err(InputError::option("--out", found, "a file that does not exist yet").into());
    }
    let record = pulse(args)
        .accelerogram(args.dt)
        .map_err(|e| InputError::option(e.name, e.value.to_string(), e.allowed))?;
    written("--out", write_two_columns(&args.out, &record))
}

fn pulse(args: &PulseArgs) -> Pulse {
    let (amplitude_m_s2, period_s) = (args.amplitude, args.period);
    match args.kind {
        Kind::OneSine => Pulse::OneSine { amplitude_m_s2, period_s },
        Kind::OneCosine => Pulse::OneCosine { amplitude_m_s2, period_s },
        Kind::HalfSine => Pulse::HalfSine { amplitude_m_s2, period_s },
        Kind::Ricker => Pulse::Ricker { amplitude_m_s2, period_s },
        Kind::MavroeidisPapageorgiou => Pulse::MavroeidisPapageorgiou {
            velocity_m_s: args.amplitude,
            period_s,
            oscillations: args.oscillations,
            phase_rad: args.phase,
        },
    }
}
