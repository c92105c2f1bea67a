//! Figures of every test and of every hypothesis: errors over windows, and over whole runs (Eq. 8).

use rayon::prelude::*;

use super::conclusion::{finite, name_of, sd};
use super::findings::Findings;
use super::summary::{Against, BeforeAfter, FitHeldOut, FittedNumber, Rival, TestErrors};
use crate::diagnose::certainty::ensemble;
use crate::diagnose::fit::{WindowFit, windowed_error};
use crate::diagnose::hypothesis::{Addition, Physics};
use crate::diagnose::measured::TestData;
use crate::diagnose::trials::{Tried, against};
use crate::diagnose::verdict::names;
use crate::experiment::{Purpose, Test};
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::Accuracy;

impl Findings<'_> {
    /// Every test: errors of the wall as given and of the wall that is written, and the noise.
    pub(super) fn test_errors(&self, physics: &[Physics; 2]) -> Vec<TestErrors> {
        let one = |(index, test): (usize, &TestData)| {
            let [before, after] = self.before_and_kept().map(|tried| self.test_error(tried, index));
            let [wme_before, wme_after] =
                physics.each_ref().map(|p| whole_wme(&self.experiment.whole[index], &p.wall));
            TestErrors {
                name: test.name.clone(),
                purpose: test.purpose,
                windowed_error: BeforeAfter { before, after },
                wme: BeforeAfter { before: wme_before, after: wme_after },
                noise_floor: 1.0,
                noise_rad: test.noise_rad,
                read_gain: test.read_gain,
            }
        };
        self.tests.iter().enumerate().map(one).collect()
    }

    /// Windowed error of a hypothesis in one test.
    fn test_error(&self, tried: &Tried, test: usize) -> Option<f64> {
        let both = self.windows.iter().zip([&tried.fit.windows, &tried.held_out.windows]);
        let own = both.flat_map(|(w, f)| w.iter().zip(f)).filter(|(w, _)| w.test == test);
        finite(windowed_error(&own.map(|(_, fit)| fit.clone()).collect::<Vec<WindowFit>>()))
    }

    /// One hypothesis that was tried, with the figures of every other.
    pub(super) fn rival(&self, tried: &Tried) -> Rival {
        let h = &tried.hypothesis;
        let number = |i: usize| FittedNumber {
            key: h.unknowns[i].key.clone(),
            unit: h.unknowns[i].unit.to_owned(),
            value: tried.fit.values[i],
            sd: sd(tried, i),
        };
        let data = self.data();
        let [against_fit, against_held_out] = tried.against(&data);
        let wme = self.ensemble_wme(tried);
        let fitted = |all: &Vec<Option<f64>>| all.first().copied().flatten();
        Rival {
            name: name_of(h),
            kinds: names(tried),
            place: h.additions.first().map(|a| a.place().to_owned()),
            parameters: (h.nuisances..h.unknowns.len()).map(number).collect(),
            windowed_error: of_both(tried.errors().map(finite)),
            against: Against { fit: against_fit, held_out: against_held_out, all: against(&data, tried) },
            wme: of_both(wme.each_ref().map(fitted)),
            wme_range: of_both(wme.each_ref().map(|all| range(all))),
        }
    }

    /// Errors over whole runs of the tests to fit and held out, of the fitted wall first and then of those that fit as well.
    fn ensemble_wme(&self, tried: &Tried) -> [Vec<Option<f64>>; 2] {
        // The vertical motion of the placebo is not in its wall.
        let is_placebo = tried.hypothesis.additions.contains(&Addition::Placebo);
        let walls = if is_placebo { Vec::new() } else { ensemble(tried).unwrap_or_default() };
        let wme = |purpose| walls.par_iter().map(|wall| self.mean_wme(wall, purpose)).collect::<Vec<_>>();
        [Purpose::Fit, Purpose::HoldOut].map(wme)
    }

    /// Mean of Eq. 8 over whole runs of the tests of a purpose; `None` if a run failed or there is no such test.
    fn mean_wme(&self, wall: &Wall, purpose: Purpose) -> Option<f64> {
        let of = |test: &&Test| test.purpose == purpose;
        let tests = self.experiment.whole.iter().filter(of);
        let all = tests.map(|test| whole_wme(test, wall)).collect::<Option<Vec<_>>>()?;
        (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
    }
}

/// Eq. 8 over a whole run of a test.
fn whole_wme(test: &Test, wall: &Wall) -> Option<f64> {
    finite(test.simulate(wall, Accuracy::default()).wme)
}

fn of_both<T>([fit, held_out]: [T; 2]) -> FitHeldOut<T> {
    FitHeldOut { fit, held_out }
}

/// Least and largest of the errors of an ensemble; `None` where there are less than two.
fn range(errors: &[Option<f64>]) -> Option<[f64; 2]> {
    let known = errors.iter().flatten().copied().collect::<Vec<_>>();
    (known.len() > 1).then(|| {
        let most = known.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x));
        [known.iter().fold(f64::INFINITY, |m, x| m.min(*x)), most]
    })
}
