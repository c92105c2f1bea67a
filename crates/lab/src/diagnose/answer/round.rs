//! How far from round the exponents of an answer may be.

use std::collections::BTreeMap;

use super::Findings;
use super::summary::RoundExponents;
use crate::diagnose::certainty::{intervals, intervals_beside_own_error};
use crate::diagnose::discovery::{exponent_of, freed, law_of};
use crate::diagnose::formula::{Law, Site, Written, WrittenParameter};
use crate::diagnose::hypothesis::Addition;
use crate::diagnose::trials::FittedHypothesis;

impl Findings<'_> {
    /// Those of a law at a site, of all that are told the one of such index.
    pub(super) fn exponents_of_law(&self, index: usize, law: &Law, site: Site) -> Option<RoundExponents> {
        let [round, free] = [*law, freed(law)?].map(|law| at_site(&law, site));
        let (round, free) = (round?, free?);
        let is_round = |own: &&WrittenParameter| !round.parameters.iter().any(|other| other.name == own.name);
        let told = free.parameters.iter().filter(is_round).map(|own| (own.name.clone(), own.value));
        self.round(index, site, told.collect())
    }

    /// That of an effect which is a power of displacement or of velocity, of all that are named the one of such index.
    pub(super) fn exponent_of_name(&self, index: usize) -> Option<RoundExponents> {
        let exponent = exponent_of(&self.found.after, index)?;
        let site = law_of(self.freed.get(index)?.as_ref()?)?.first.site;
        self.round(index, site, BTreeMap::from([("n".to_owned(), exponent)]))
    }

    /// Exponents that are told so, by the same at a site with these free.
    fn round(&self, index: usize, site: Site, told: BTreeMap<String, f64>) -> Option<RoundExponents> {
        let free = self.freed.get(index)?.as_ref().filter(|_| !told.is_empty())?;
        let law = law_of(free)?;
        let written = at_site(&law, site)?;
        let ends = law.intervals(&written, &law.values(), &self.intervals_of_law(free, &law));
        let (mut interval, mut beside) = (BTreeMap::new(), BTreeMap::new());
        for (WrittenParameter { name, of, .. }, [low, high]) in written.parameters.iter().zip(ends) {
            match told.get(name) {
                Some(told) => interval.insert(name.clone(), [low.min(*told), high.max(*told)]),
                // A coefficient has another unit with another exponent.
                None if of.len() == 1 => beside.insert(name.clone(), [low, high]),
                None => None,
            };
        }
        Some(RoundExponents { formula: written.text, told, interval, beside })
    }

    /// 90 % intervals of the numbers of the one law of a hypothesis.
    fn intervals_of_law(&self, fitted: &FittedHypothesis, law: &Law) -> Vec<[f64; 2]> {
        let all = match self.found.remainder {
            Some(_) => intervals_beside_own_error(&self.data(), fitted),
            None => intervals(&self.data(), fitted),
        };
        let h = &fitted.hypothesis;
        let index = h.additions.iter().position(|addition| matches!(addition, Addition::Formula(_)));
        let own =
            (0..h.unknowns.len()).filter(|i| index.is_some_and(|index| h.unknowns[*i].belongs_to(index)));
        let own = own.map(|i| all[i]).collect::<Vec<_>>();
        debug_assert_eq!(own.len(), law.slots().len());
        own
    }
}

/// The formula of a law at a site.
fn at_site(law: &Law, site: Site) -> Option<Written> {
    law.written().into_iter().find(|written| written.site == site)
}
