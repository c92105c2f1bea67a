//! What is told of laws of the user's own.

use super::Findings;
use super::conclusion::{finite, of_both, sd};
use super::summary::{Against, FittedNumber, OwnHypothesis};
use crate::diagnose::trials::{FittedHypothesis, against, closes, joint_error};
use crate::experiment::file::HypothesisTable;

impl Findings<'_> {
    /// Every law of the user's own, with its figures.
    pub(super) fn own_hypotheses(&self) -> Vec<OwnHypothesis> {
        let tables = self.experiment.hypotheses.iter();
        tables.zip(&self.own).map(|(table, fitted)| self.own(table, fitted.as_ref())).collect()
    }

    fn own(&self, table: &HypothesisTable, fitted: Option<&FittedHypothesis>) -> OwnHypothesis {
        let data = self.data();
        let before = joint_error(&self.found.before);
        let speaks = |tried: &FittedHypothesis| {
            let [fit, held_out] = tried.against(&data);
            Against { fit, held_out, all: against(&data, tried) }
        };
        OwnHypothesis {
            name: table.name.clone(),
            place: table.formula.place().name().to_owned(),
            formula: table.formula.to_string(),
            parameters: fitted.map_or_else(Vec::new, |tried| numbers(table, tried)),
            windowed_error: of_both(fitted.map_or([None; 2], |tried| tried.errors().map(finite))),
            against: fitted.map(speaks),
            closes_gap: fitted.zip(before).is_some_and(|(tried, before)| closes(tried, before)),
        }
    }
}

/// The numbers of the formula, which stand behind those of the wall.
fn numbers(table: &HypothesisTable, tried: &FittedHypothesis) -> Vec<FittedNumber> {
    let own = table.formula.parameters().iter().zip(tried.hypothesis.nuisances..);
    let number = |(parameter, i): (&mrbd_formula::Parameter, usize)| FittedNumber {
        key: parameter.name.clone(),
        unit: parameter.unit.clone(),
        value: tried.fit.values[i],
        sd: sd(tried, i),
    };
    own.map(number).collect()
}
