//! The summary of findings: effects with intervals, what could hide, what was confused, rivals.

use std::collections::BTreeMap;
use std::ops::Range;

use super::findings::Findings;
use super::missing_force::ForceBeforeAfter;
use super::rows::RivalRow;
use super::summary::{CouldHide, FoundEffect, KIND, Stages, Summary, WallFit, WindowCounts};
use crate::diagnose::certainty::{confused, intervals, next_tests};
use crate::diagnose::hypothesis::{Hypothesis, Physics};
use crate::diagnose::trials::{FRICTION, Tried, against, giving_friction, joint_error, kinds};
use crate::diagnose::verdict::{Verdict, power};

impl Findings<'_> {
    /// Everything that `diagnosis.json` tells.
    pub(super) fn summary(&self, physics: &[Physics; 2], force: &ForceBeforeAfter) -> Summary {
        let (data, found) = (self.data(), &self.found);
        let has_names = matches!(found.verdict, Verdict::Named | Verdict::Class);
        let own_place = || has_names.then(|| found.after.hypothesis.additions[0].place());
        let stages = [&found.before, &found.recalibrated, found.kept()];
        Summary {
            kind: KIND.to_owned(),
            verdict: found.verdict,
            place: found.place.or_else(own_place).map(str::to_owned),
            effects: self.effects(has_names),
            equivalent: found.equivalent.clone(),
            wall: wall_fits(&found.after),
            tests: self.test_errors(physics),
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
            rivals: found.tried.iter().map(|tried| self.rival(tried)).collect(),
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
        let outside = |place: &str| FoundEffect {
            kind: None,
            name: None,
            place: place.to_owned(),
            parameters: BTreeMap::new(),
            interval: BTreeMap::new(),
            written_as: None,
            sets_in_over_m: None,
        };
        self.found
            .place
            .filter(|_| self.found.verdict == Verdict::PlaceOnly)
            .map(outside)
            .into_iter()
            .collect()
    }

    /// The effects of an answer with their numbers and 90 % intervals.
    fn named_effects(&self) -> Vec<FoundEffect> {
        let after = &self.found.after;
        let intervals = intervals(&self.data(), after);
        (0..after.hypothesis.additions.len()).map(|index| found_effect(after, &intervals, index)).collect()
    }

    /// For each kind, the smallest sizes that would have been told from nothing and named, and the size at which it would
    /// matter.
    fn could_hide(&self) -> Vec<CouldHide> {
        let data = self.data();
        let singles = self.found.tried.iter().filter(|t| t.hypothesis.additions.len() == 1);
        let row = |tried: &Tried| {
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
        self.found.tried.iter().zip(1..).flat_map(|(tried, rank)| self.rows_of_rival(tried, rank)).collect()
    }

    fn rows_of_rival(&self, tried: &Tried, rank: u64) -> Vec<RivalRow> {
        let data = self.data();
        let h = &tried.hypothesis;
        let row = |i: usize| RivalRow {
            rank,
            name: name_of(h),
            place: h.additions.first().map_or("none", |a| a.place()),
            is_answer: kinds(tried).is_some(),
            parameter: h.unknowns[i].key.clone(),
            unit: h.unknowns[i].unit,
            value: tried.fit.values[i],
            sd: sd(tried, i),
            error: tried.errors(),
            against: against(&data, tried),
        };
        (h.nuisances..h.unknowns.len()).map(row).collect()
    }
}

/// One effect of an answer.
fn found_effect(after: &Tried, intervals: &[[f64; 2]], index: usize) -> FoundEffect {
    let (h, values) = (&after.hypothesis, &after.fit.values);
    let addition = &h.additions[index];
    let numbers = |keys: &[(String, usize)]| {
        let parameters = keys.iter().map(|(key, i)| (key.clone(), values[*i])).collect();
        (parameters, keys.iter().map(|(key, i)| (key.clone(), intervals[*i])).collect())
    };
    if let Some(friction) = giving_friction(h, values, index) {
        let (parameters, interval) = numbers(&[("force_n".to_owned(), friction.force)]);
        return FoundEffect {
            kind: Some(FRICTION.name().to_owned()),
            name: Some(FRICTION.name().to_owned()),
            place: addition.place().to_owned(),
            parameters,
            interval,
            written_as: Some(addition.name()),
            sets_in_over_m: Some(friction.onset_m),
        };
    }
    let own = (0..h.unknowns.len()).filter(|i| h.unknowns[*i].belongs_to(index));
    let (parameters, interval) = numbers(&own.map(|i| (h.unknowns[i].key.clone(), i)).collect::<Vec<_>>());
    FoundEffect {
        kind: addition.kind().map(|kind| kind.name().to_owned()),
        name: Some(addition.name()),
        place: addition.place().to_owned(),
        parameters,
        interval,
        written_as: None,
        sets_in_over_m: None,
    }
}

/// Fitted numbers of the wall with their standard deviations, and what they were.
fn wall_fits(tried: &Tried) -> Vec<WallFit> {
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

/// What is added to the wall.
pub(super) fn name_of(h: &Hypothesis) -> String {
    h.additions.iter().map(|a| a.name()).collect::<Vec<_>>().join(" + ")
}

/// Standard deviation of a fitted number; `None` where it leaves no trace.
pub(super) fn sd(tried: &Tried, i: usize) -> Option<f64> {
    finite(tried.fit.covariance.as_ref().map(|c| c[(i, i)].max(0.0).sqrt()))
}

/// A number that files can hold.
pub(super) fn finite(number: Option<f64>) -> Option<f64> {
    number.filter(|x| x.is_finite())
}
