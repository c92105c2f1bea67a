//! The study file: wall, pulse, and the grid of frequencies and amplitudes; what it assumes, in words.

use std::path::{Path, PathBuf};

use crate::error::{InputError, Result};
use crate::study::pipeline::check_name;
use mrbd_files::{load_block, toml_file};
use mrbd_kernel::model::{FurtherLaw, Wall, WallParameters};
use mrbd_kernel::simulate::Accuracy;
use mrbd_records::Pulse;
use serde::Deserialize;

/// The `kind` of a pipeline file that is such a study.
pub const KIND: &str = "overturning_spectrum";

/// Most points of a grid in one direction: more is a slip of the pen.
const MOST_POINTS: usize = 10_000;

/// Shape of the pulse.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PulseShape {
    /// One period of a sine.
    OneSine,
    /// One period of a cosine.
    OneCosine,
    /// Half a period of a sine.
    HalfSine,
    /// Ricker's wavelet.
    Ricker,
}

impl PulseShape {
    /// Name in study files.
    pub fn name(self) -> &'static str {
        match self {
            PulseShape::OneSine => "one_sine",
            PulseShape::OneCosine => "one_cosine",
            PulseShape::HalfSine => "half_sine",
            PulseShape::Ricker => "ricker",
        }
    }

    /// The pulse of this shape with an amplitude in m/s² and a period in s.
    pub fn pulse(self, amplitude_m_s2: f64, period_s: f64) -> Pulse {
        match self {
            PulseShape::OneSine => Pulse::OneSine { amplitude_m_s2, period_s },
            PulseShape::OneCosine => Pulse::OneCosine { amplitude_m_s2, period_s },
            PulseShape::HalfSine => Pulse::HalfSine { amplitude_m_s2, period_s },
            PulseShape::Ricker => Pulse::Ricker { amplitude_m_s2, period_s },
        }
    }
}

/// Evenly spaced values, both ends included.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Range {
    from: f64,
    to: f64,
    count: usize,
}

impl Range {
    /// The values in order.
    pub fn values(&self) -> Vec<f64> {
        let spacing = (self.to - self.from) / (self.count - 1) as f64;
        (0..self.count).map(|i| self.from + i as f64 * spacing).collect()
    }

    fn check(&self, path: &Path, key: &str) -> Result<(), InputError> {
        let ordered = self.from > 0.0 && self.to > self.from && self.to.is_finite();
        if ordered && (2..=MOST_POINTS).contains(&self.count) {
            return Ok(());
        }
        let found = format!("from {} to {}, count {}", self.from, self.to, self.count);
        let allowed = format!("0 < from < to, finite, and a count of 2 to {MOST_POINTS}");
        Err(InputError::key(path, key, found, allowed))
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct StudyFile {
    kind: String,
    name: String,
    wall: PathBuf,
    pulse: PulseShape,
    frequency_over_p: Range,
    amplitude_over_alpha_g: Range,
    boundary_tolerance: f64,
    samples_per_period: u32,
    tail_over_period: f64,
    least_tail_times_p: f64,
    tolerance: f64,
}

/// A study that can be run.
#[derive(Debug, Clone)]
pub struct Study {
    /// Name, and of the folder of its results.
    pub name: String,
    /// The wall.
    pub wall: Wall,
    /// Shape of the pulse.
    pub pulse: PulseShape,
    /// Frequencies of the pulse over p.
    pub frequency_over_p: Range,
    /// Amplitudes of the pulse over α g.
    pub amplitude_over_alpha_g: Range,
    /// Width to which boundaries are narrowed, over α g.
    pub boundary_tolerance: f64,
    /// Samples in a period of the pulse.
    pub samples_per_period: u32,
    /// Free motion after the pulse, in its periods.
    pub tail_over_period: f64,
    /// Least free motion after the pulse, times p.
    pub least_tail_times_p: f64,
    /// Error allowed in rotations relative to α.
    pub tolerance: f64,
}

impl Study {
    /// Reads a study, if the file is one by its `kind`.
    ///
    /// # Errors
    /// Input errors that name the file and the key.
    pub fn load(path: &Path) -> Result<Option<Self>> {
        #[derive(Deserialize)]
        struct Kind {
            kind: Option<String>,
        }
        let text = toml_file::read(path)?;
        if toml_file::parse::<Kind>(path, &text)?.kind.as_deref() != Some(KIND) {
            return Ok(None);
        }
        let file: StudyFile = toml_file::parse(path, &text)?;
        check_name(path, &file.name)?;
        check(path, &file)?;
        let wall = load_block(&path.parent().unwrap_or(Path::new(".")).join(&file.wall))?;
        Ok(Some(Self {
            name: file.name,
            wall,
            pulse: file.pulse,
            frequency_over_p: file.frequency_over_p,
            amplitude_over_alpha_g: file.amplitude_over_alpha_g,
            boundary_tolerance: file.boundary_tolerance,
            samples_per_period: file.samples_per_period,
            tail_over_period: file.tail_over_period,
            least_tail_times_p: file.least_tail_times_p,
            tolerance: file.tolerance,
        }))
    }
}

fn check(path: &Path, file: &StudyFile) -> Result<(), InputError> {
    debug_assert_eq!(file.kind, KIND);
    file.frequency_over_p.check(path, "frequency_over_p")?;
    file.amplitude_over_alpha_g.check(path, "amplitude_over_alpha_g")?;
    let limits = [
        ("boundary_tolerance", file.boundary_tolerance, 1e-8, 1.0),
        ("samples_per_period", f64::from(file.samples_per_period), 20.0, 1e6),
        ("tail_over_period", file.tail_over_period, 0.0, 1e4),
        ("least_tail_times_p", file.least_tail_times_p, 0.0, 1e4),
        ("tolerance", file.tolerance, *Accuracy::TOLERANCES.start(), *Accuracy::TOLERANCES.end()),
    ];
    for (key, value, least, most) in limits {
        if !(least..=most).contains(&value) {
            return Err(InputError::key(path, key, value.to_string(), format!("{least} to {most}")));
        }
    }
    Ok(())
}

/// Names and sentences, for the files of a spectrum and its page.
pub fn assumptions(study: &Study) -> Vec<(String, String)> {
    let p = study.wall.parameters();
    let pair = |name: &str, text: String| (name.to_owned(), text);
    let mut told = vec![
        pair("wall", wall(p)),
        pair("top", top(p)),
        pair("impacts", impacts(p)),
        pair("pulse", format!("{}, by frequency ω over p and amplitude over αg", study.pulse.name())),
        pair("frequencies over p", range(&study.frequency_over_p)),
        pair("amplitudes over αg", range(&study.amplitude_over_alpha_g)),
        pair("boundaries", format!("narrowed to {} αg", study.boundary_tolerance)),
        pair("samples of a pulse", format!("{} in a period", study.samples_per_period)),
        pair(
            "free motion after it",
            format!(
                "{} periods of the pulse, and at least {}/p",
                study.tail_over_period, study.least_tail_times_p
            ),
        ),
        pair("tolerance", format!("{:e} of α", study.tolerance)),
    ];
    let laws = p.further_laws();
    if !laws.is_empty() {
        told.push(pair(
            "further effects",
            laws.iter().map(FurtherLaw::in_words).collect::<Vec<_>>().join("; "),
        ));
    }
    told
}

fn wall(p: &WallParameters) -> String {
    let crack = p.crack_height_m.map_or("no crack".to_owned(), |h1| format!("crack at {} m", short(h1)));
    format!(
        "{} m thick, {} m high, {crack}, strip of {} m, {} kg; corners {} m apart at the ground, {} m at the crack; collapsed at {} α",
        short(p.thickness_m),
        short(p.height_m),
        short(p.length_m),
        short(p.mass_kg),
        short(p.lower_width_m),
        short(p.upper_width_m),
        short(p.collapse_rotation_ratio)
    )
}

fn top(p: &WallParameters) -> String {
    format!("m_d {} kg, m_dp {} kg, k_d {} N/m", p.diaphragm_mass_kg, p.carriage_mass_kg, p.stiffness_n_per_m)
}

fn impacts(p: &WallParameters) -> String {
    let r = &p.restitution;
    let coefficients = match r.coefficients.iter().all(|c| *c == 1.0) {
        true => "plastic, C_l = 1".to_owned(),
        false => format!("C_1 … C_8 = {}", r.coefficients.map(short).join(", ")),
    };
    format!(
        "{coefficients}, law “{}”, capture velocity {} rad/s",
        r.law.name(),
        short(r.capture_velocity_rad_s)
    )
}

/// A number to six digits.
fn short(value: f64) -> String {
    format!("{value:.5e}").parse::<f64>().map_or_else(|_| value.to_string(), |rounded| rounded.to_string())
}

fn range(range: &Range) -> String {
    let values = range.values();
    let [first, last] = [values[0], values[values.len() - 1]];
    format!("{} from {first} to {last}", values.len())
}
