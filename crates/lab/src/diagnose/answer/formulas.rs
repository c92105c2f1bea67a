//! Laws outside the catalogue as effects of the answer.

use std::collections::BTreeMap;

use super::Findings;
use super::conclusion::of_both;
use super::summary::{FittedToAll, ForceCurve, FoundEffect, FoundState, SharedHeldOut};
use crate::diagnose::certainty::intervals;
use crate::diagnose::force::Against;
use crate::diagnose::formula::{Curve, Law, Part, Site, Written, WrittenState};
use crate::diagnose::trials::FittedHypothesis;
use crate::diagnose::verdict::{Found, Verdict};
use crate::experiment::{Purpose, Window};
use mrbd_formula::{CarriedState, Formula};

/// Kind of such an effect in wall files.
const FORMULA: &str = "formula";

impl Findings<'_> {
    /// The laws of a fitted hypothesis, of all that are told the one of such index, as effects, with 90 % intervals and what was excited.
    pub(super) fn formulas(&self, index: usize, tried: &FittedHypothesis) -> Vec<FoundEffect> {
        let (h, values) = (&tried.hypothesis, &tried.fit.values);
        let all = intervals(&self.data(), tried);
        let added = (h.nuisances..h.unknowns.len()).collect::<Vec<_>>();
        let own = added.iter().map(|i| values[*i]).collect::<Vec<_>>();
        let own_intervals = added.iter().map(|i| all[*i]).collect::<Vec<_>>();
        let of_law = |law: &Law| {
            let effect = |written: Written| FoundEffect {
                round_exponents: self.exponents_of_law(index, law, written.site),
                ..self.formula(law, &written, &own, &own_intervals)
            };
            law.written().into_iter().map(effect).collect::<Vec<_>>()
        };
        h.laws(values).iter().flat_map(of_law).collect()
    }

    /// Of a class of formulas all but the first; of a class of effects those that are formulas.
    pub(super) fn equivalent_formulas(&self) -> Vec<Vec<FoundEffect>> {
        let Found { verdict, tried, equivalent, .. } = &self.found;
        let of_class = tried.iter().filter(|_| *verdict == Verdict::Class);
        let is_told = |tried: &&FittedHypothesis| {
            let laws = tried.hypothesis.laws(&tried.fit.values);
            laws.iter().any(|law| equivalent.contains(&law.name()))
        };
        let told = self.found.told_laws().into_iter().skip(1).chain(of_class.filter(is_told));
        told.enumerate().map(|(k, tried)| self.formulas(k + 1, tried)).collect()
    }

    /// The formula with other numbers, where those held out are followed only so.
    pub(super) fn fitted_to_all(&self) -> Option<FittedToAll> {
        let discovered = self.found.discovered.as_ref()?;
        let moved = discovered.moved.as_ref().filter(|_| self.found.verdict.is_formula())?;
        let first = discovered.equals.first()?;
        let laws = moved.hypothesis.laws(&moved.fit.values);
        let written = laws.iter().flat_map(Law::written);
        Some(FittedToAll {
            effects: written.map(|written| self.without_intervals(&written)).collect(),
            windowed_error: of_both(moved.errors()),
            lost: moved.in_tests_fitted() - first.in_tests_fitted(),
        })
    }

    /// The windows of tests held out that were fitted too, and those that judge; `None` where none was fitted.
    pub(in crate::diagnose) fn shared_held_out(&self) -> Option<SharedHeldOut> {
        let [fitted, held_out] = &self.windows;
        let given = |window: &&Window| self.tests[window.test].purpose == Purpose::HoldOut;
        let fitted = fitted.iter().filter(given).count();
        (fitted > 0).then_some(SharedHeldOut { fitted, judging: held_out.len() })
    }

    /// A force without a formula as the effect that simulates it.
    pub(super) fn curve_effects(&self) -> Vec<FoundEffect> {
        let after = &self.found.after;
        let formulas = after.hypothesis.formulas(&after.fit.values).unwrap_or_default();
        let effect = |formula: &Formula| FoundEffect {
            kind: Some(FORMULA.to_owned()),
            place: formula.place().name().to_owned(),
            parameters: formula.parameters().iter().map(|p| (p.name.clone(), p.value)).collect(),
            formula: Some(formula.to_string()),
            units: formula.parameters().iter().map(|p| (p.name.clone(), p.unit.clone())).collect(),
            range: self.range(Site::Top),
            ..FoundEffect::default()
        };
        formulas.iter().map(effect).collect()
    }

    /// A force without a formula, knot by knot.
    pub(super) fn force_curves(&self) -> Vec<ForceCurve> {
        let found = self.found.discovered.as_ref().filter(|_| self.found.verdict == Verdict::Curve);
        let Some(excited) = found.map(|found| found.at(Site::Top)) else { return Vec::new() };
        let against = [Against::Displacement, Against::Velocity];
        let of = |curve: &Curve| {
            let parts = curve.parts.into_iter().zip(against).zip(excited);
            parts.map(|((part, against), range)| force_curve(&part, against, range)).collect::<Vec<_>>()
        };
        self.found.after.hypothesis.curve.iter().flat_map(of).collect()
    }

    /// What was excited at a site, by column.
    fn range(&self, site: Site) -> BTreeMap<String, [f64; 2]> {
        let [displacement, velocity] = site.columns();
        self.found.discovered.as_ref().map_or_else(BTreeMap::new, |found| {
            let [q, u] = found.at(site);
            BTreeMap::from([(displacement.to_owned(), q), (velocity.to_owned(), u)])
        })
    }

    fn formula(&self, law: &Law, written: &Written, values: &[f64], intervals: &[[f64; 2]]) -> FoundEffect {
        let names = written.parameters.iter().map(|p| p.name.clone());
        let interval = names.zip(law.intervals(written, values, intervals)).collect();
        FoundEffect { interval, ..self.without_intervals(written) }
    }

    /// A formula with its numbers alone.
    pub(super) fn without_intervals(&self, written: &Written) -> FoundEffect {
        let named = || written.parameters.iter();
        let state = |state: &WrittenState| {
            let CarriedState { name, rate, start, unit, .. } = state.carried();
            FoundState { name, rate, start, unit }
        };
        FoundEffect {
            kind: Some(FORMULA.to_owned()),
            name: Some(FORMULA.to_owned()),
            place: written.site.name().to_owned(),
            parameters: named().map(|p| (p.name.clone(), p.value)).collect(),
            states: written.states.iter().map(state).collect(),
            formula: Some(written.text.clone()),
            units: named().map(|p| (p.name.clone(), p.unit.clone())).collect(),
            range: self.range(written.site),
            ..FoundEffect::default()
        }
    }
}

fn force_curve(part: &Part, against: Against, range: [f64; 2]) -> ForceCurve {
    let told = part.at.map(|x| part.told_n(x));
    ForceCurve {
        against: against.name().to_owned(),
        at: part.at.to_vec(),
        force_n: told.map(|(force_n, _)| force_n).to_vec(),
        interval_n: told.map(|(_, interval)| interval).to_vec(),
        range,
    }
}
