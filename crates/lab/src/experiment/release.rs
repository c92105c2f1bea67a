//! A release by hand: what counts of it, and the state from which the wall moves by itself.

use std::path::Path;

use mrbd_files::error::{InputError, Result};
use mrbd_kernel::model::{Pair, State};
use mrbd_kernel::simulate::Start;
use nalgebra::{DMatrix, DVector};

use super::file::TestTable;
use super::measured::Measured;

/// What counts of a test: nothing from before a release.
pub(super) fn counted_s(table: &TestTable) -> Vec<[f64; 2]> {
    match (table.release_s, &table.windows_s[..]) {
        (None, windows) => windows.to_vec(),
        (Some(from_s), []) => vec![[from_s, f64::MAX]],
        (Some(from_s), windows) => {
            let after = windows.iter().map(|[from, to]| [from.max(from_s), *to]);
            after.filter(|[from, to]| from < to).collect()
        }
    }
}

/// Time to either side of a release over which its state is read, s: a swing lasts some tenths.
const RELEASE_READ_S: f64 = 0.06;

/// The measured state at a time: of the parabola through the samples about it, in least squares.
pub(super) fn released(path: &Path, measured: &Measured, time_s: f64) -> Result<Start, InputError> {
    let near = |k: &usize| (measured.time_s[*k] - time_s).abs() <= RELEASE_READ_S;
    let near = (0..measured.time_s.len()).filter(near).collect::<Vec<_>>();
    let of = |channel: &Option<Vec<f64>>| {
        let theta = channel.as_ref()?;
        let samples = near.iter().map(|&k| (measured.time_s[k] - time_s, theta[k]));
        parabola(&samples.filter(|(_, theta)| theta.is_finite()).collect::<Vec<_>>())
    };
    let states = measured.theta_rad.each_ref().map(of);
    let [Some(lower), Some(upper)] = states else {
        let found = format!("no state of both bodies at release_s = {time_s} s");
        let allowed = format!("four samples or more of both within {RELEASE_READ_S} s of it; see top_held");
        return Err(InputError::file(path, found, allowed));
    };
    let state = State { theta: [lower[0], upper[0]], omega: [lower[1], upper[1]] };
    Ok(Start { time_s, state, ..Start::default() })
}

/// Value and slope at zero of the parabola through samples, in least squares; `None` of fewer than four.
fn parabola(samples: &[(f64, f64)]) -> Option<Pair> {
    if samples.len() < 4 {
        return None;
    }
    let rows = DMatrix::from_fn(samples.len(), 3, |k, power| samples[k].0.powi(power as i32));
    let values = DVector::from_iterator(samples.len(), samples.iter().map(|(_, value)| *value));
    let fitted = rows.svd(true, true).solve(&values, f64::EPSILON).ok()?;
    Some([fitted[0], fitted[1]])
}
