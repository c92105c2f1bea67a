//! Step 1: what laboratories get wrong in files, found before anything is fitted. Large rotations in degrees are found on
//! reading.

use rayon::prelude::*;

use crate::diagnose::experiment::Experiment;
use crate::diagnose::fit::{Problem, windowed_error};
use crate::diagnose::hypothesis::Hypothesis;
use crate::diagnose::trials::{Data, untouched};
use crate::experiment::{TestData, rest_offset_rad, windows};
use crate::limits::{MISREAD_LEAST_TESTS, MISREAD_TEST, MISREAD_TOGETHER};
use mrbd_files::error::{InputError, Result};

type Misreading = (&'static str, fn(&mut TestData));

/// Ways in which a measured file is wrong, and what puts it right.
const MISREADINGS: [Misreading; 5] = [
    ("theta1_rad and theta2_rad are swapped", |test| {
        test.theta_rad.iter_mut().for_each(|theta| theta.swap(0, 1));
        test.noise_rad.swap(0, 1);
    }),
    ("both rotations have the wrong sign", |test| {
        test.theta_rad.iter_mut().flatten().for_each(|theta| *theta = -*theta);
    }),
    ("the sign of theta1_rad is wrong", |test| {
        test.theta_rad.iter_mut().for_each(|theta| theta[0] = -theta[0]);
    }),
    ("the sign of theta2_rad is wrong", |test| {
        test.theta_rad.iter_mut().for_each(|theta| theta[1] = -theta[1]);
    }),
    ("rotations are in degrees", |test| {
        test.theta_rad.iter_mut().flatten().for_each(|theta| *theta = theta.to_radians());
        test.noise_rad = test.noise_rad.map(f64::to_radians);
    }),
];

/// Windowed error of the wall as given in a test, and by every misreading put right.
struct Errors {
    /// As it stands, or without a gain between its channels if that leaves less: a gain makes a closed crack look open, to the
    /// other side once they are swapped.
    as_it_stands: f64,
    put_right: [Option<f64>; MISREADINGS.len()],
}

impl Errors {
    /// `None` where nothing moves.
    fn of(experiment: &Experiment, test: &TestData) -> Option<Self> {
        let read = |change: fn(&mut TestData)| {
            let mut other = test.clone();
            change(&mut other);
            other.rest_offset_rad = rest_offset_rad(&other.theta_rad, other.noise_rad);
            misfit(experiment, &other)
        };
        let as_it_stands = misfit(experiment, test)?;
        let as_it_stands = read(without_gain).map_or(as_it_stands, |other| other.min(as_it_stands));
        Some(Self { as_it_stands, put_right: MISREADINGS.map(|(_, put_right)| read(put_right)) })
    }

    fn share(&self, misreading: usize) -> Option<f64> {
        Some(self.put_right[misreading]? / self.as_it_stands)
    }
}

/// Refuses tests whose files are wrong in a way that shows: swapped channels, wrong signs, small rotations in degrees.
///
/// # Errors
/// Input errors that name the test and what seems wrong with it.
pub fn check_data(experiment: &Experiment) -> Result<()> {
    let errors = experiment.tests.par_iter().map(|test| Errors::of(experiment, test)).collect::<Vec<_>>();
    let refuse = |key: String, whose: String, (misreading, share): (usize, f64)| {
        let found = format!(
            "{whose}: it seems that {}, which leaves {:.0} % of the windowed error",
            MISREADINGS[misreading].0,
            100.0 * share
        );
        let allowed = "radians: theta1_rad of the lower and theta2_rad of the upper body, clockwise positive";
        Err(InputError::key(&experiment.path, key, found, allowed).into())
    };
    for (index, own) in errors.iter().enumerate() {
        if let Some(likeliest) = likeliest(|misreading| own.as_ref()?.share(misreading), MISREAD_TEST) {
            let name = &experiment.tests[index].name;
            return refuse(format!("tests[{index}].measured"), format!("test {name:?}"), likeliest);
        }
    }
    let together = |misreading: usize| {
        let shares = errors.iter().flatten().filter_map(|own| own.share(misreading)).collect::<Vec<_>>();
        let mean = shares.iter().map(|share| share.ln()).sum::<f64>() / shares.len() as f64;
        (shares.len() >= MISREAD_LEAST_TESTS).then(|| mean.exp())
    };
    match likeliest(together, MISREAD_TOGETHER) {
        Some(likeliest) => refuse("tests".to_owned(), "all tests".to_owned(), likeliest),
        None => Ok(()),
    }
}

/// The upper channel over what it reads of the lower, in least squares.
fn without_gain(test: &mut TestData) {
    let both = test.theta_rad.iter().filter(|theta| theta.iter().all(|t| t.is_finite()));
    let [own, across] =
        both.fold([0.0; 2], |[own, across], [lower, upper]| [own + lower * lower, across + lower * upper]);
    let gain = across / own;
    if gain.is_finite() && gain > 0.0 {
        test.theta_rad.iter_mut().for_each(|theta| theta[1] /= gain);
        test.noise_rad[1] /= gain;
    }
}

/// The misreading of least share, if that is below a limit.
fn likeliest(share: impl Fn(usize) -> Option<f64>, limit: f64) -> Option<(usize, f64)> {
    let shares = (0..MISREADINGS.len()).filter_map(|misreading| Some((misreading, share(misreading)?)));
    shares.filter(|(_, share)| *share < limit).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Windowed error of the wall as given in one test; `None` where nothing moves.
fn misfit(experiment: &Experiment, test: &TestData) -> Option<f64> {
    let tests = [test.clone()];
    let windows = windows(&tests);
    let all = Problem { tests: &tests, windows: &windows };
    let data = Data { fit: all, held_out: Problem { windows: &[], ..all } };
    let h = Hypothesis::new(experiment.wall.parameters(), &experiment.scales, &[], &[]);
    windowed_error(&untouched(&data, h)?.fit.windows).filter(|error| *error > 0.0)
}
