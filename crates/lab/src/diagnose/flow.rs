//! The flow of a diagnosis: windows, what effects do to them one by one, patterns read again, the verdict.

use crate::Progress;
use crate::diagnose::experiment::Experiment;
use crate::diagnose::measured::{Window, is_readable, windows};
use crate::diagnose::trials::{
    Alone, Data, Trials, gain_misread, opened_as_given, opened_windows, reads_better, set_gain,
};
use crate::diagnose::verdict::{Found, judge};
use crate::experiment_file::Purpose;
use mrbd_files::error::{InputError, Result};

/// Times that patterns are read again without a sensor's gain.
const READ_AGAIN: usize = 3;

/// A diagnosis: what was found, and in which windows.
#[derive(Debug)]
pub struct Diagnosis {
    /// The answer, and what it rests on.
    pub found: Found,
    /// Windows to fit and held out.
    pub windows: [Vec<Window>; 2],
}

impl Diagnosis {
    /// The windows as data of fits.
    pub fn data<'a>(&'a self, experiment: &'a Experiment) -> Data<'a> {
        Data::new(experiment, &self.windows)
    }
}

/// Diagnoses an experiment; a sensor's gain that shows is left in its tests, so that their patterns are read without it.
///
/// # Errors
/// An input error if no window of a test to fit starts in a pattern beyond doubt.
pub fn diagnose(experiment: &mut Experiment, progress: &impl Progress) -> Result<Diagnosis> {
    let (mut windows, mut alone) = try_alone(experiment, progress)?;
    for _ in 0..READ_AGAIN {
        let Some(gain) = alone.singles.first().and_then(|best| gain_misread(&experiment.tests, best)) else {
            break;
        };
        let before = set_gain(&mut experiment.tests, gain);
        let (new_windows, new) = try_alone(experiment, progress)?;
        if !reads_better(&alone.singles, &new.singles) {
            set_gain(&mut experiment.tests, before);
            break;
        }
        (windows, alone) = (new_windows, new);
    }
    if let Some(new_windows) = opened_windows(experiment, &windows, &alone) {
        alone = alone_in(experiment, &new_windows, Some(&alone.recalibrated.fit.values), progress)?;
        windows = new_windows;
    }
    let trials = Trials { experiment, data: Data::new(experiment, &windows), progress };
    let found = judge(&trials, alone);
    Ok(Diagnosis { found, windows })
}

/// Windows of the tests, and what effects do to them one by one.
fn try_alone(experiment: &Experiment, progress: &impl Progress) -> Result<([Vec<Window>; 2], Alone)> {
    let (fit, held_out) = windows(&experiment.tests).into_iter().partition(|w| w.purpose == Purpose::Fit);
    let windows: [Vec<Window>; 2] = [fit, held_out];
    let windows = opened_as_given(experiment, &windows).unwrap_or(windows);
    let alone = alone_in(experiment, &windows, None, progress)?;
    Ok((windows, alone))
}

/// What effects do to windows one by one, where values of the wall's uncertain numbers may be known from other windows.
fn alone_in(
    experiment: &Experiment,
    windows: &[Vec<Window>; 2],
    known: Option<&[f64]>,
    progress: &impl Progress,
) -> Result<Alone> {
    let no_window = || {
        let allowed = "some stretches of a tenth of a second at rest or in one pattern, without gaps";
        InputError::file(&experiment.path, "no window that starts in a pattern beyond doubt", allowed)
    };
    if !experiment.tests.iter().any(|test| test.purpose == Purpose::Fit && is_readable(test)) {
        return Err(no_window().into());
    }
    let trials = Trials { experiment, data: Data::new(experiment, windows), progress };
    Ok(trials.alone(known).ok_or_else(no_window)?)
}
