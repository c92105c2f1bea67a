//! Measured against simulated, sample by sample and window by window.

use super::findings::Findings;
use super::rows::{Sample, WindowRow};
use crate::diagnose::fit::{Replay, WindowFit, shaken};
use crate::diagnose::force::stretches;
use crate::diagnose::hypothesis::Physics;
use crate::diagnose::trials::Tried;
use crate::experiment::{Sampled, TestData, Window};
use mrbd_kernel::model::{Contact, Pair};
use mrbd_kernel::simulate::{Accuracy, Simulator};

impl Findings<'_> {
    /// Every sample, with whole runs before and after and errors over windows.
    pub(super) fn samples(&self, physics: &[Physics; 2]) -> Vec<Sample> {
        let replays = physics.each_ref().map(|physics| Replay::new(&self.tests, physics));
        let of_test = |(index, test): (usize, &TestData)| {
            let mut samples = whole_runs(test, physics);
            for (which, (replay, tried)) in replays.iter().zip(self.before_and_kept()).enumerate() {
                for (window, x) in self.windows_of(tried).filter(|(w, _)| w.test == index) {
                    let residual = replay.residual(window, x);
                    for (i, k) in window.samples.clone().enumerate() {
                        let measured = test.theta_rad[k].iter().all(|t| t.is_finite());
                        samples[k].residual[which] = measured.then(|| [residual[2 * i], residual[2 * i + 1]]);
                    }
                }
            }
            samples
        };
        self.tests.iter().enumerate().flat_map(of_test).collect()
    }

    /// Every window with its errors, and the impacts of the updated wall in it, in the order of tests and times.
    pub(super) fn window_rows(&self, [_, updated]: &[Physics; 2]) -> Vec<WindowRow> {
        let replay = Replay::new(&self.tests, updated);
        let after = self.found.kept();
        let fits = [&self.found.before, &self.found.recalibrated, after].map(fits_of);
        let row = |(i, (window, x)): (usize, (&Window, &[f64]))| {
            let test = &self.tests[window.test];
            let row = WindowRow {
                test: test.name.clone(),
                purpose: test.purpose,
                from_s: test.time_s[window.samples.start],
                to_s: test.time_s[window.samples.end - 1],
                contact: window.freedom.state(x).1,
                impacts: replay.run(window, x, &mut ()).impacts,
                error: fits.each_ref().map(|fits| Some(fits[i].reduced().sqrt()).filter(|e| e.is_finite())),
            };
            (window.test, row)
        };
        let mut rows = self.windows_of(after).enumerate().map(row).collect::<Vec<_>>();
        rows.sort_by(|(a, one), (b, two)| a.cmp(b).then(one.from_s.total_cmp(&two.from_s)));
        rows.into_iter().map(|(_, row)| row).collect()
    }
}

/// Windows to fit, then those held out.
fn fits_of(tried: &Tried) -> Vec<&WindowFit> {
    tried.fit.windows.iter().chain(&tried.held_out.windows).collect()
}

/// The samples of a test with whole runs from rest, before and after.
fn whole_runs(test: &TestData, physics: &[Physics; 2]) -> Vec<Sample> {
    let runs = physics.each_ref().map(|physics| whole_run(test, physics));
    let mut contacts = vec![None; test.time_s.len()];
    for stretch in stretches(test) {
        contacts[stretch.from..stretch.from + stretch.states.len()].fill(Some(stretch.contact));
    }
    let sample = |k: usize| Sample {
        test: test.name.clone(),
        purpose: test.purpose,
        time_s: test.time_s[k],
        measured_rad: test.theta_rad[k],
        measured_contact: contacts[k],
        simulated: runs.each_ref().map(|rows| rows.get(k).copied()),
        residual: [None; 2],
    };
    (0..test.time_s.len()).map(sample).collect()
}

/// Rotations as sensors of a wall read them, rad, and contacts of a whole run, as far as it goes.
fn whole_run(test: &TestData, physics: &Physics) -> Vec<(Pair, Contact)> {
    let mut sampled = Sampled::at(&test.time_s);
    let shaking = shaken(&test.shaking, physics.reversed_ratio);
    Simulator::new(&physics.wall, &shaking, Accuracy::default()).run(&mut sampled);
    let read = |(theta, contact): &(Pair, Contact)| (physics.wall.reading().of(*theta), *contact);
    sampled.rows().iter().map(read).collect()
}
