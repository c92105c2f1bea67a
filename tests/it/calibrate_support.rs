//! Twin experiments: tests simulated with known coefficients, written as a laboratory would.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use mrbd_files::load_wall;
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{ImpactLaw, Pair, Wall};
use mrbd_kernel::simulate::{Accuracy, History, Shaking, simulate_observed};
use mrbd_lab::calibrate::{Archive, Calibration, Experiment, calibrate};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The best fit of Table 2, which the twins are simulated with.
pub const TRUE: [f64; 8] = [0.93, 1.03, 0.825, 0.985, 0.865, 0.76, 0.98, 0.94];

const STEP_S: f64 = 0.005;

/// How twins are made.
#[derive(Clone)]
pub struct Twin {
    pub law: ImpactLaw,
    pub scales: Vec<f64>,
    /// Standard deviation of the noise, as a share of the largest rotation of each body.
    pub noise: f64,
    /// Lines under `[calibrate]`.
    pub settings: String,
    /// Lines of every test.
    pub test_lines: String,
}

impl Twin {
    /// Six tests at 70 to 120 % without noise, everything optional left out.
    pub fn of(law: ImpactLaw) -> Self {
        let settings = "capture_study_rad_s = []\nreplicates = 40\n".to_owned();
        let scales = vec![0.7, 0.8, 0.9, 1.0, 1.1, 1.2];
        Self { law, scales, noise: 0.0, settings, test_lines: String::new() }
    }

    pub fn wall_text(&self, coefficients: &str) -> String {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/inputs/walls/table_wall.toml");
        let text = std::fs::read_to_string(path).expect("the table wall");
        let lines = text.lines().map(|line| match line.split(' ').next() {
            Some("coefficients") => coefficients.to_owned(),
            Some("law") => format!("law = \"{}\"", self.law.name()),
            _ => line.to_owned(),
        });
        lines.collect::<Vec<_>>().join("\n")
    }

    /// Writes the experiment into a folder; gives its file.
    pub fn write(&self, folder: &Path) -> PathBuf {
        let write = |name: &str, text: &str| {
            std::fs::write(folder.join(name), text).expect("a writable folder");
        };
        write("true.toml", &self.wall_text(&format!("coefficients = {TRUE:?}")));
        write("wall.toml", &self.wall_text(""));
        let record = record();
        write("record.csv", &record_text(&record));
        let wall = load_wall(&folder.join("true.toml")).expect("a valid wall");
        let mut text = format!("wall = \"wall.toml\"\n\n[calibrate]\n{}", self.settings);
        for (k, scale) in self.scales.iter().enumerate() {
            write(&format!("measured_{k}.csv"), &self.measured_text(&wall, &record.scaled(*scale), k as u64));
            let lines = &self.test_lines;
            let _ = write!(
                text,
                "\n[[tests]]\nname = \"{:.0} %\"\nrecord = \"record.csv\"\nscale = {scale}\n\
                 measured = \"measured_{k}.csv\"\n{lines}",
                100.0 * scale
            );
        }
        write("experiment.toml", &text);
        folder.join("experiment.toml")
    }

    fn measured_text(&self, wall: &Wall, record: &Accelerogram, seed: u64) -> String {
        let rows = rotations(wall, record);
        let largest = [0, 1].map(|i| rows.iter().fold(0.0, |m: f64, row| m.max(row[i].abs())));
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        // The sum of twelve uniform draws less six is near enough to normal, with unit variance.
        let mut normal = || (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
        let mut text = String::from("time_s,theta1_rad,theta2_rad\n");
        for (k, theta) in rows.iter().enumerate() {
            let noisy = [0, 1].map(|i| theta[i] + self.noise * largest[i] * normal());
            let _ = writeln!(text, "{:?},{:?},{:?}", k as f64 * STEP_S, noisy[0], noisy[1]);
        }
        text
    }
}

/// Rotations at every sample.
pub fn rotations(wall: &Wall, record: &Accelerogram) -> Vec<Pair> {
    let shaking = Shaking { horizontal: Some(record.clone()), vertical: None, tail_s: 2.0 };
    let mut history = History::new(STEP_S);
    simulate_observed(wall, &shaking, Accuracy::default(), &mut history);
    history.rows.iter().map(|row| row.theta_rad).collect()
}

/// Six seconds of three swelling and fading sines that open the crack of the table wall.
pub fn record() -> Accelerogram {
    let wave = |f: f64, t: f64, phase: f64| (std::f64::consts::TAU * f * t + phase).sin();
    let at = |k: i32| {
        let t = f64::from(k) * STEP_S;
        let swell = (std::f64::consts::PI * t / 6.0).sin().powi(2);
        let sum = wave(1.1, t, 0.0) + 0.7 * wave(2.3, t, 1.0) + 0.4 * wave(0.6, t, 2.0);
        // As precise as the file the search reads.
        (3.0 * swell * sum * 1e6).round() / 1e6
    };
    Accelerogram::new(STEP_S, (0..=1200).map(at).collect()).expect("finite samples")
}

fn record_text(record: &Accelerogram) -> String {
    let rows = record.acceleration_m_s2().iter().enumerate();
    let rows = rows.map(|(k, a)| format!("{:.3},{a:.6}\n", k as f64 * STEP_S));
    std::iter::once("time_s,acceleration_m_s2\n".to_owned()).chain(rows).collect()
}

/// Calibrates an experiment file under a seed.
pub fn calibrated(path: &Path, seed: u64) -> Calibration {
    let experiment = Experiment::load(path, Some(seed)).expect("a valid experiment");
    let journal = path.with_file_name(format!("journal_{seed}.tsv"));
    let archive = Archive::open(&journal, &experiment.request, false, Box::new(())).expect("a journal");
    calibrate(&experiment, &archive).expect("a calibration")
}
