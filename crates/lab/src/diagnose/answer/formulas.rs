//! Laws outside the catalogue as effects of the answer.

use std::collections::BTreeMap;

use super::Findings;
use super::summary::FoundEffect;
use crate::diagnose::certainty::intervals;
use crate::diagnose::formula::{Law, Written};
use crate::diagnose::trials::FittedHypothesis;

/// Kind of such an effect in wall files.
const FORMULA: &str = "formula";

impl Findings<'_> {
    /// The laws of a fitted hypothesis as effects, with 90 % intervals and what was excited.
    pub(super) fn formulas(&self, tried: &FittedHypothesis) -> Vec<FoundEffect> {
        let (h, values) = (&tried.hypothesis, &tried.fit.values);
        let all = intervals(&self.data(), tried);
        let added = (h.nuisances..h.unknowns.len()).collect::<Vec<_>>();
        let own = added.iter().map(|i| values[*i]).collect::<Vec<_>>();
        let own_intervals = added.iter().map(|i| all[*i]).collect::<Vec<_>>();
        let of_law = |law: &Law| {
            let effect = |written: Written| self.formula(law, &written, &own, &own_intervals);
            law.written().into_iter().map(effect).collect::<Vec<_>>()
        };
        h.laws(values).iter().flat_map(of_law).collect()
    }

    /// Of a class of formulas all but the first.
    pub(super) fn equivalent_formulas(&self) -> Vec<Vec<FoundEffect>> {
        let discovered = self.found.discovered.as_ref();
        let others = discovered.map_or(&[][..], |found| found.equals.get(1..).unwrap_or_default());
        others.iter().map(|tried| self.formulas(tried)).collect()
    }

    fn formula(&self, law: &Law, written: &Written, values: &[f64], intervals: &[[f64; 2]]) -> FoundEffect {
        let named = || written.parameters.iter();
        let ends = law.intervals(written, values, intervals);
        let [displacement, velocity] = written.site.columns();
        let range = self.found.discovered.as_ref().map(|found| found.at(written.site));
        FoundEffect {
            kind: Some(FORMULA.to_owned()),
            name: Some(FORMULA.to_owned()),
            place: written.site.name().to_owned(),
            parameters: named().map(|p| (p.name.clone(), p.value)).collect(),
            interval: named().map(|p| p.name.clone()).zip(ends).collect(),
            written_as: None,
            sets_in_over_m: None,
            formula: Some(written.text.clone()),
            units: named().map(|p| (p.name.clone(), p.unit.clone())).collect(),
            range: range.map_or_else(BTreeMap::new, |[q, u]| {
                BTreeMap::from([(displacement.to_owned(), q), (velocity.to_owned(), u)])
            }),
        }
    }
}
