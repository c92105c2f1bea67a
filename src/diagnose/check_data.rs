//! Step 1: what laboratories get wrong in files, found before anything is fitted. Degrees are found on reading.

use crate::diagnose::experiment::Experiment;
use crate::diagnose::fit::{Problem, nats, windowed_error};
use crate::diagnose::hypothesis::Hypothesis;
use crate::diagnose::measured::{TestData, rest_offset_rad, windows};
use crate::diagnose::trials::{Data, untouched};
use crate::error::{InputError, Result};

/// By how much another reading of the same file must do better before it is told: half the error, and a gain in natural
/// logarithms of likelihood that no effect of a plausible size would cause by chance.
const HALF: f64 = 0.5;
const PLAIN: f64 = 100.0;
/// Windowed error, in standard deviations of the noise, below which nothing can be wrong with a file.
const FINE: f64 = 3.0;

type Misreading = (&'static str, fn(&mut TestData));

/// Ways in which a measured file is wrong, and what puts it right.
const MISREADINGS: [Misreading; 3] = [
    ("theta1_rad and theta2_rad are swapped", |test| {
        test.theta_rad.iter_mut().for_each(|theta| theta.swap(0, 1))
    }),
    ("both rotations have the wrong sign", |test| {
        test.theta_rad.iter_mut().flatten().for_each(|theta| *theta = -*theta);
    }),
    ("the sign of theta2_rad is wrong", |test| {
        test.theta_rad.iter_mut().for_each(|theta| theta[1] = -theta[1])
    }),
];

/// Refuses tests whose files are wrong in a way that shows: swapped channels, wrong signs.
///
/// # Errors
/// Input errors that name the test and what seems wrong with it.
pub fn check_data(experiment: &Experiment) -> Result<()> {
    for (index, test) in experiment.tests.iter().enumerate() {
        let key = format!("tests[{index}].measured");
        let refuse = |found: String, allowed: &str| {
            Err(InputError::key(&experiment.path, &key, found, allowed).into())
        };
        let Some((error, against)) = misfit(experiment, test) else { continue };
        for (what, put_right) in MISREADINGS {
            let mut other = test.clone();
            put_right(&mut other);
            other.rest_offset_rad = rest_offset_rad(&other.theta_rad, other.noise_rad);
            let Some((other_error, other_against)) = misfit(experiment, &other) else { continue };
            if error > FINE && other_error < HALF * error && against - other_against > PLAIN {
                let found = format!(
                    "test {:?}: it seems that {what} (windowed error {error:.1} noise as it stands, {other_error:.1} so)",
                    test.name
                );
                return refuse(
                    found,
                    "theta1_rad of the lower and theta2_rad of the upper body, clockwise positive",
                );
            }
        }
    }
    Ok(())
}

/// Windowed error of the wall as given in one test, and what speaks against it; none where nothing moves.
fn misfit(experiment: &Experiment, test: &TestData) -> Option<(f64, f64)> {
    let tests = [test.clone()];
    let windows = windows(&tests);
    let all = Problem { tests: &tests, windows: &windows };
    let data = Data { fit: all, held_out: Problem { windows: &[], ..all } };
    let h = Hypothesis::new(experiment.wall.parameters(), &experiment.scales, &[], &[]);
    let tried = untouched(&data, h)?;
    let error = windowed_error(&tried.fit.windows)?;
    Some((error, nats(&tried.fit.windows)))
}
