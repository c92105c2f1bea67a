//! Laws that were refused, as the summary has them.

use std::collections::BTreeMap;

use super::Findings;
use super::summary::{FitHeldOut, FoundEffect, RefusedLaw};
use crate::diagnose::discovery::Refused;
use crate::diagnose::formula::Law;

impl Findings<'_> {
    /// Laws outside the catalogue, and names, that were refused.
    pub(super) fn refused_laws(&self) -> Vec<RefusedLaw> {
        let discovered = self.found.discovered.as_ref();
        discovered.map_or_else(Vec::new, |found| found.refused.iter().map(|one| self.refused(one)).collect())
    }

    fn refused(&self, Refused { hypothesis, values, guards, errors }: &Refused) -> RefusedLaw {
        let laws = hypothesis.laws(values);
        let name = if laws.is_empty() {
            hypothesis.name()
        } else {
            laws.iter().map(Law::name).collect::<Vec<_>>().join(" and ")
        };
        let effects = |law: &Law| {
            law.written().iter().map(|written| self.without_intervals(written)).collect::<Vec<FoundEffect>>()
        };
        let own = hypothesis.unknowns.iter().zip(values).take(hypothesis.nuisances);
        RefusedLaw {
            name,
            effects: laws.iter().flat_map(effects).collect(),
            wall: own.map(|(unknown, value)| (unknown.key.clone(), *value)).collect::<BTreeMap<_, _>>(),
            guards: guards.clone(),
            windowed_error: errors.map(|[fit, held_out]| FitHeldOut { fit, held_out }),
        }
    }
}
