//! The figures of every test: errors before and after, and its noise.

use serde_json::{Value, json};

use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::Accuracy;
use mrbd_lab::diagnose::experiment::Experiment;
use mrbd_lab::diagnose::fit::{WindowFit, windowed_error};
use mrbd_lab::diagnose::flow::Diagnosis;
use mrbd_lab::diagnose::measured::{TestData, Window};
use mrbd_lab::diagnose::trials::Tried;
use mrbd_lab::experiment::Test;

/// Every test: errors of the wall as given and of the wall that is written, and the noise.
pub fn tests(experiment: &Experiment, diagnosis: &Diagnosis) -> Vec<Value> {
    let both = [&diagnosis.found.before, diagnosis.found.kept()];
    let walls = both.map(|t| t.hypothesis.physics(&t.fit.values).map(|p| p.wall));
    let one = |(index, test): (usize, &TestData)| {
        let error = |tried: &Tried| test_error(&diagnosis.windows, tried, index);
        let wme = |wall: &Option<Wall>| wall.as_ref().and_then(|w| whole_wme(&experiment.whole[index], w));
        json!({
            "name": test.name,
            "use": test.purpose.name(),
            "windowed_error": {"before": error(both[0]), "after": error(both[1])},
            "wme": {"before": wme(&walls[0]), "after": wme(&walls[1])},
            "noise_floor": 1.0,
            "noise_rad": test.noise_rad,
            "read_gain": test.read_gain,
        })
    };
    experiment.tests.iter().enumerate().map(one).collect()
}

fn test_error(windows: &[Vec<Window>; 2], tried: &Tried, test: usize) -> Option<f64> {
    let both = windows.iter().zip([&tried.fit.windows, &tried.held_out.windows]);
    let own = both.flat_map(|(w, f)| w.iter().zip(f)).filter(|(w, _)| w.test == test);
    windowed_error(&own.map(|(_, fit)| fit.clone()).collect::<Vec<WindowFit>>())
}

/// Eq. 8 over a whole run of a test.
pub fn whole_wme(test: &Test, wall: &Wall) -> Option<f64> {
    test.simulate(wall, Accuracy::default()).wme
}
