//! `histories.parquet`: measured against simulated, sample by sample.

use std::path::Path;

use super::Tables;
use crate::error::Result;
use crate::store::{Column, Read, write_table};
use mrbd_kernel::model::{Contact, Pair};
use mrbd_kernel::simulate::{Accuracy, Simulator};
use mrbd_lab::diagnose::fit::{Replay, shaken};
use mrbd_lab::diagnose::force::stretches;
use mrbd_lab::diagnose::measured::{TestData, Window};
use mrbd_lab::diagnose::trials::Tried;
use mrbd_lab::experiment::Sampled;

/// One sample.
#[derive(Debug, Clone)]
struct Sample {
    test: String,
    purpose: &'static str,
    time_s: f64,
    measured_rad: Pair,
    measured_pattern: Option<Contact>,
    /// Of whole runs from rest, before and after; none beyond a collapse.
    simulated: [Option<(Pair, Contact)>; 2],
    /// Measured less simulated over the noise, in windows fitted at their starts, before and after.
    residual: [Option<Pair>; 2],
}

fn finite(x: f64) -> Option<f64> {
    Some(x).filter(|x| x.is_finite())
}

impl Sample {
    fn theta(&self, when: usize, body: usize) -> Option<f64> {
        self.simulated[when].map(|(theta, _)| theta[body])
    }

    fn pattern(&self, when: usize) -> Option<std::borrow::Cow<'_, str>> {
        self.simulated[when].map(|(_, contact)| contact.name().into())
    }

    fn error(&self, when: usize, body: usize) -> Option<f64> {
        self.residual[when].map(|r| r[body])
    }
}

static COLUMNS: [Column<Sample>; 16] = [
    Column::input("test", "", "test", Read::Text(|s| Some(s.test.as_str().into()))),
    Column::input("use", "", "fit or hold-out", Read::Text(|s| Some(s.purpose.into()))),
    Column::input("time_s", "s", "time in the record", Read::Number(|s: &Sample| Some(s.time_s))).distinct(),
    Column::result(
        "theta1_measured_rad",
        "rad",
        "rotation of the lower body, measured",
        Read::Number(|s| finite(s.measured_rad[0])),
    ),
    Column::result(
        "theta2_measured_rad",
        "rad",
        "rotation of the upper body, measured",
        Read::Number(|s| finite(s.measured_rad[1])),
    ),
    Column::result(
        "pattern_measured",
        "",
        "pattern, where the measurement leaves no doubt",
        Read::Text(|s| s.measured_pattern.map(|c| c.name().into())),
    ),
    Column::result(
        "theta1_before_rad",
        "rad",
        "θ_1 of a whole run of the wall as given",
        Read::Number(|s| s.theta(0, 0)),
    ),
    Column::result("theta2_before_rad", "rad", "θ_2 of the same", Read::Number(|s| s.theta(0, 1))),
    Column::result("pattern_before", "", "its pattern", Read::Text(|s| s.pattern(0))),
    Column::result(
        "theta1_after_rad",
        "rad",
        "θ_1 of a whole run of the updated wall",
        Read::Number(|s| s.theta(1, 0)),
    ),
    Column::result("theta2_after_rad", "rad", "θ_2 of the same", Read::Number(|s| s.theta(1, 1))),
    Column::result("pattern_after", "", "its pattern", Read::Text(|s| s.pattern(1))),
    Column::result(
        "error1_before",
        "",
        "measured less simulated θ_1 over its noise, in windows, wall as given",
        Read::Number(|s| s.error(0, 0)),
    ),
    Column::result("error2_before", "", "the same of θ_2", Read::Number(|s| s.error(0, 1))),
    Column::result("error1_after", "", "the same of θ_1, updated wall", Read::Number(|s| s.error(1, 0))),
    Column::result("error2_after", "", "the same of θ_2, updated wall", Read::Number(|s| s.error(1, 1))),
];

impl Tables<'_> {
    pub(super) fn write_histories(&self, path: &Path) -> Result<()> {
        let tests = &self.experiment.tests;
        let replays = self.physics.each_ref().map(|physics| Replay::new(tests, physics));
        let mut rows = Vec::new();
        for (index, test) in tests.iter().enumerate() {
            let from = rows.len();
            rows.extend(self.samples(test));
            let own = &mut rows[from..];
            for (which, tried) in
                [&self.diagnosis.found.before, self.diagnosis.found.kept()].into_iter().enumerate()
            {
                for (window, x) in self.windows_of(tried).filter(|(w, _)| w.test == index) {
                    let residual = replays[which].residual(window, x);
                    for (i, k) in window.samples.clone().enumerate() {
                        let measured = test.theta_rad[k].iter().all(|t| t.is_finite());
                        own[k].residual[which] = measured.then(|| [residual[2 * i], residual[2 * i + 1]]);
                    }
                }
            }
        }
        write_table(path, &COLUMNS, &[], &rows)
    }

    /// Windows to fit and held out, each with its fitted state under a hypothesis.
    pub(super) fn windows_of<'t>(
        &'t self,
        tried: &'t Tried,
    ) -> impl Iterator<Item = (&'t Window, &'t [f64])> {
        let sides = self.diagnosis.windows.iter().zip([&tried.fit.windows, &tried.held_out.windows]);
        sides.flat_map(|(windows, fits)| windows.iter().zip(fits.iter().map(|fit| &fit.x[..])))
    }

    fn samples(&self, test: &TestData) -> Vec<Sample> {
        let whole = self.physics.each_ref().map(|physics| {
            let mut sampled = Sampled::at(&test.time_s);
            let shaking = shaken(&test.shaking, physics.reversed_ratio);
            Simulator::new(&physics.wall, &shaking, Accuracy::default()).run(&mut sampled);
            let read = |(theta, contact): &(Pair, Contact)| (physics.wall.reading().of(*theta), *contact);
            sampled.rows().iter().map(read).collect::<Vec<_>>()
        });
        let mut patterns = vec![None; test.time_s.len()];
        for stretch in stretches(test) {
            patterns[stretch.from..stretch.from + stretch.states.len()].fill(Some(stretch.contact));
        }
        let sample = |k: usize| Sample {
            test: test.name.clone(),
            purpose: test.purpose.name(),
            time_s: test.time_s[k],
            measured_rad: test.theta_rad[k],
            measured_pattern: patterns[k],
            simulated: whole.each_ref().map(|rows| rows.get(k).copied()),
            residual: [None; 2],
        };
        (0..test.time_s.len()).map(sample).collect()
    }
}
