//! The laboratory: walls that were measured on a shaking table.
//!
//! An experiment file names a wall, what was known of it, and tests: records of the table and measured rotations. From it
//! go two ways, over the same tests.
//!
//! ```text
//!                                ┌─ calibrate ─→ coefficients of impact (or other numbers) that lower Eq. 8,
//! experiment file ─→ experiment ─┤               and what the tests can tell of each
//!  wall, tests       read,       │
//!                    aligned     └─ diagnose ──→ where model and measurement disagree, and the effect
//!                                                that the model lacks
//! ```
//!
//! | module | from | to |
//! | --- | --- | --- |
//! | [`experiment`] | an experiment file | tests in the record's time, with noise, contact patterns and starts |
//! | [`calibrate`] | tests | one vector for all of them, with intervals ([`calibrate::Calibration`]) |
//! | [`diagnose`] | tests | a verdict, and everything it rests on ([`diagnose::Diagnosis`]) |
//! | [`release`] | free releases of a held strip | the moment of its joints against rotation, no law assumed |
//! | [`limits`] | nothing | every number that decides a diagnosis |
//!
//! # A calibration from the file to the result
//!
//! A test is made up here: the table wall shaken for six seconds. Its stiffness, 37 kN/m, is then asked of the test.
//!
//! ```
//! use mrbd_lab::calibrate::{Archive, Experiment, calibrate};
//! # use mrbd_kernel::{accelerogram::Accelerogram, simulate::{Accuracy, History, Shaking, simulate_observed}};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let folder = tempfile::tempdir()?;
//! let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text);
//! write("wall.toml", include_str!("../../../inputs/walls/table_wall.toml"))?;
//! # let ground = |k: i32| 2.5 * (0.035 * f64::from(k)).sin() * (0.0026 * f64::from(k)).sin();
//! # let samples: Vec<f64> = (0..=1200).map(ground).collect();
//! # let row = |(k, a): (usize, &f64)| format!("{:.3},{a:?}\n", 0.005 * k as f64);
//! # let record: String = samples.iter().enumerate().map(row).collect();
//! # write("record.csv", &format!("time_s,acceleration_m_s2\n{record}"))?;
//! # let wall = mrbd_files::load_wall(&folder.path().join("wall.toml"))?;
//! # let shaking = Shaking { horizontal: Some(Accelerogram::new(0.005, samples)?), ..Shaking::default() };
//! # let mut history = History::new(0.005);
//! # simulate_observed(&wall, &shaking, Accuracy::default(), &mut history);
//! # let row = |r: &mrbd_kernel::simulate::HistoryRow| format!("{:?},{:?},{:?}\n", r.time_s, r.theta_rad[0], r.theta_rad[1]);
//! # let rows: String = history.rows.iter().map(row).collect();
//! # write("measured.csv", &format!("time_s,theta1_rad,theta2_rad\n{rows}"))?;
//! write("experiment.toml", r#"
//!     wall = "wall.toml"
//!     [calibrate]
//!     parameters = [{ key = "stiffness_n_per_m", lower = 34e3, upper = 40e3 }]
//!     most_generations = 2
//!     population = 5
//!     refine_vectors = 100
//!     capture_study_rad_s = []
//!     replicates = 20
//!     [[tests]]
//!     name = "six seconds"
//!     record = "record.csv"
//!     measured = "measured.csv"
//! "#)?;
//!
//! let experiment = Experiment::load(&folder.path().join("experiment.toml"), None)?;
//! let journal = folder.path().join("journal.tsv");
//! let archive = Archive::open(&journal, &experiment.request, false, Box::new(()))?;
//! let calibration = calibrate(&experiment, &archive)?;
//! let stiffness_n_per_m = calibration.joint.values[0];
//! // Without noise a thousandth is far more than the search leaves.
//! assert!((stiffness_n_per_m / 37e3 - 1.0).abs() < 1e-3);
//! # Ok(())
//! # }
//! ```
//!
//! A diagnosis begins with the same file: [`diagnose::Experiment::load`], [`diagnose::check_data()`], [`diagnose::diagnose`].

pub mod calibrate;
pub mod diagnose;
pub mod experiment;
mod least_squares;
pub mod limits;
mod progress;
pub mod release;

pub use experiment::file as experiment_file;
pub use progress::{Progress, Tried};
