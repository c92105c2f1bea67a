//! The summary worked out: effects with intervals, what could hide, what was confused, rivals.
//!
//! Every test and every hypothesis also has its errors over windows, and over whole runs (Eq. 8).

use std::ops::Range;

use super::Findings;
use super::rows::ForceBeforeAfter;
use super::rows::RivalRow;
use super::summary::{
    Against, BeforeAfter, CouldHide, FitHeldOut, FittedNumber, FoundEffect, KIND, Rival, Stages, Summary,
    TestErrors, WallFit, WindowCounts,
};
use crate::diagnose::certainty::{confused, next_tests};
use crate::diagnose::ensemble::ensemble;
use crate::diagnose::fit::{WindowFit, windowed_error};
use crate::diagnose::hypothesis::{Addition, Physics};
use crate::diagnose::trials::{FittedHypothesis, against, joint_error, kinds};
use crate::diagnose::verdict::{Verdict, model_error_rad, names, power};
use crate::experiment::TestData;
use crate::experiment::{Purpose, Test};
use mrbd_kernel::model::{Role, Wall};
use mrbd_kernel::simulate::Accuracy;
use rayon::prelude::*;

/// Hypotheses, best first, of which the errors of whole runs are told over numbers that fit as well.
const RANGES_TOLD: usize = 12;

impl Findings<'_> {
    /// Everything that `diagnosis.json` tells.
    pub(super) fn summary(&self, physics: &[Physics; 2], force: &ForceBeforeAfter) -> Summary {
        let (data, found) = (self.data(), &self.found);
        let has_names = matches!(found.verdict, Verdict::Named | Verdict::Class);
        let has_formula = found.verdict.is_formula();
        let own_place = || (has_names || has_formula).then(|| found.after.hypothesis.additions[0].place());
        let stages = [&found.before, &found.recalibrated, found.kept()];
        Summary {
            kind: KIND.to_owned(),
            verdict: found.verdict,
            place: found.place.or_else(own_place).map(str::to_owned),
            effects: match found.verdict {
                Verdict::Curve => self.curve_effects(),
                _ if has_formula => self.formulas(0, &found.after),
                _ => self.effects(has_names),
            },
            curves: self.force_curves(),
            equivalent_formulas: self.equivalent_formulas(),
            stability: found.discovered.as_ref().and_then(|found| found.stability),
            fitted_to_all: self.fitted_to_all(),
            shared_held_out: self.shared_held_out(),
            missed_held_out: found.missed_held_out().map(of_both),
            refused: self.refused_laws(),
            unfinished: self.unfinished.clone(),
            equivalent: found.equivalent.clone(),
            wall: wall_fits(&found.after),
            tests: self.test_errors(physics),
            remainder: found.remainder.clone(),
            explained: found
                .remainder
                .as_ref()
                .map(|r| FitHeldOut { fit: r.taken_fit, held_out: r.taken_held_out }),
            model_error_rad: found.least_leaving().and_then(|least| model_error_rad(&data, least)),
            other_law: found.other_law.clone(),
            windowed_error: staged(stages.map(joint_error).map(finite)),
            against: staged(stages.map(|tried| against(&data, tried))),
            windows: WindowCounts {
                fit: data.fit.windows.len(),
                held_out: data.held_out.windows.len(),
                opened: self.windows.iter().flatten().filter(|window| window.opened).count(),
            },
            could_hide: self.could_hide(),
            confused: confused(&data, &found.recalibrated, &found.tried),
            rivals: self.rivals(&found.rivals(&data)),
            hypotheses: self.own_hypotheses(),
            missing_force: force.summary(physics),
            next_tests: next_tests(self),
            program: concat!("mrbd ", env!("CARGO_PKG_VERSION")).to_owned(),
            experiment: self.experiment.path.display().to_string(),
        }
    }

    /// The effects of an answer; of a law outside the catalogue its place alone.
    fn effects(&self, has_names: bool) -> Vec<FoundEffect> {
        if has_names {
            return self.named_effects();
        }
        let outside = |place: &str| FoundEffect { place: place.to_owned(), ..FoundEffect::default() };
        self.found
            .place
            .filter(|_| self.found.verdict == Verdict::PlaceOnly)
            .map(outside)
            .into_iter()
            .collect()
    }

    /// For each kind, the smallest sizes that would have been told from nothing and named, and the size at which it would
    /// matter.
    fn could_hide(&self) -> Vec<CouldHide> {
        let data = self.data();
        // A bed does nothing where it is stiff: what could hide is no size above nothing.
        let shown = |a: &Addition| a.role() != Some(Role::Bed);
        let singles =
            self.found.tried.iter().filter(|t| matches!(&t.hypothesis.additions[..], [one] if shown(one)));
        let row = |tried: &FittedHypothesis| {
            let power = power(&data, &self.found.recalibrated, tried)?;
            let h = &tried.hypothesis;
            let unknown = &h.unknowns[h.nuisances];
            Some(CouldHide {
                kind: h.additions[0].kind()?.name().to_owned(),
                name: h.additions[0].name(),
                parameter: unknown.key.clone(),
                unit: unknown.unit.to_owned(),
                estimate: tried.fit.values[h.nuisances] - unknown.start,
                sd: power.sd,
                smallest_detectable: power.detected_from,
                named_from: power.named_from,
                matters: power.matters,
            })
        };
        singles.filter_map(row).collect()
    }

    /// Every added number of every hypothesis, the best first.
    pub(super) fn rival_rows(&self) -> Vec<RivalRow> {
        {
            let all = self.found.rivals(&self.data());
            all.into_iter().zip(1..).flat_map(|(tried, rank)| self.rows_of_rival(tried, rank)).collect()
        }
    }

    fn rows_of_rival(&self, tried: &FittedHypothesis, rank: u64) -> Vec<RivalRow> {
        let data = self.data();
        let h = &tried.hypothesis;
        let row = |i: usize| RivalRow {
            rank,
            name: h.name(),
            place: h.additions.first().map_or("none", |a| a.place()),
            is_answer: kinds(tried).is_some(),
            parameter: h.unknowns[i].key.clone(),
            unit: h.unknowns[i].unit,
            value: h.unknowns[i].number(tried.fit.values[i]),
            sd: sd(tried, i),
            error: tried.errors(),
            against: against(&data, tried),
        };
        (h.nuisances..h.unknowns.len()).map(row).collect()
    }
}

/// Fitted numbers of the wall with their standard deviations, and what they were.
fn wall_fits(tried: &FittedHypothesis) -> Vec<WallFit> {
    let h = &tried.hypothesis;
    let own: Range<usize> = 0..h.nuisances;
    let number = |i: usize| WallFit {
        key: h.unknowns[i].key.clone(),
        unit: h.unknowns[i].unit.to_owned(),
        before: h.unknowns[i].start,
        prior_sd: h.unknowns[i].prior_sd,
        after: tried.fit.values[i],
        sd: sd(tried, i),
    };
    own.map(number).collect()
}

fn staged<T>([before, recalibrated, after]: [T; 3]) -> Stages<T> {
    Stages { before, recalibrated, after }
}

/// Standard deviation of a fitted number; `None` where it leaves no trace.
pub(super) fn sd(tried: &FittedHypothesis, i: usize) -> Option<f64> {
    let measure = tried.hypothesis.unknowns[i].measure;
    let sd = tried.fit.covariance.as_ref().map(|c| c[(i, i)].max(0.0).sqrt());
    finite(sd.map(|sd| measure.sd(tried.fit.values[i], sd)))
}

/// A number that files can hold.
pub(super) fn finite(number: Option<f64>) -> Option<f64> {
    number.filter(|x| x.is_finite())
}

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
    fn test_error(&self, tried: &FittedHypothesis, test: usize) -> Option<f64> {
        let both = self.windows.iter().zip([&tried.fit.windows, &tried.held_out.windows]);
        let own = both.flat_map(|(w, f)| w.iter().zip(f)).filter(|(w, _)| w.test == test);
        finite(windowed_error(&own.map(|(_, fit)| fit.clone()).collect::<Vec<WindowFit>>()))
    }

    /// Hypotheses in order; the errors of whole runs of the first of them over numbers that fit as well, too.
    fn rivals(&self, tried: &[&FittedHypothesis]) -> Vec<Rival> {
        tried.par_iter().enumerate().map(|(rank, tried)| self.rival(tried, rank < RANGES_TOLD)).collect()
    }

    /// One hypothesis that was tried, with the figures of every other.
    pub(super) fn rival(&self, tried: &FittedHypothesis, with_range: bool) -> Rival {
        let h = &tried.hypothesis;
        let number = |i: usize| FittedNumber {
            key: h.unknowns[i].key.clone(),
            unit: h.unknowns[i].unit.to_owned(),
            value: h.unknowns[i].number(tried.fit.values[i]),
            sd: sd(tried, i),
        };
        let data = self.data();
        let [against_fit, against_held_out] = tried.against(&data);
        let wme = self.ensemble_wme(tried, with_range);
        let fitted = |all: &Vec<Option<f64>>| all.first().copied().flatten();
        Rival {
            name: h.name(),
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
    fn ensemble_wme(&self, tried: &FittedHypothesis, with_range: bool) -> [Vec<Option<f64>>; 2] {
        // The vertical motion of the placebo is not in its wall.
        let is_placebo = tried.hypothesis.additions.contains(&Addition::Placebo);
        let mut walls = if is_placebo { Vec::new() } else { ensemble(tried).unwrap_or_default() };
        walls.truncate(if with_range { walls.len() } else { 1 });
        [Purpose::Fit, Purpose::HoldOut].map(|purpose| self.mean_wmes(&walls, purpose))
    }

    /// Of each wall the mean of Eq. 8 over whole runs of the tests of a purpose; `None` if a run failed or there is no such
    /// test.
    fn mean_wmes(&self, walls: &[Wall], purpose: Purpose) -> Vec<Option<f64>> {
        let tests = self.experiment.whole.iter().filter(|test| test.purpose == purpose).collect::<Vec<_>>();
        let of_test = |test: &&Test| test.simulate_all(walls, Accuracy::default());
        let all = tests.par_iter().map(of_test).collect::<Vec<_>>();
        let mean = |k: usize| {
            let wmes = all.iter().map(|of_test| finite(of_test[k].wme)).collect::<Option<Vec<_>>>()?;
            (!wmes.is_empty()).then(|| wmes.iter().sum::<f64>() / wmes.len() as f64)
        };
        (0..walls.len()).map(mean).collect()
    }
}

/// Eq. 8 over a whole run of a test.
fn whole_wme(test: &Test, wall: &Wall) -> Option<f64> {
    finite(test.simulate(wall, Accuracy::default()).wme)
}

pub(super) fn of_both<T>([fit, held_out]: [T; 2]) -> FitHeldOut<T> {
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
