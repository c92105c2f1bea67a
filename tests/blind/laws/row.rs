//! One case with a law: what was hidden, what was said, and how far that is off.

use std::path::Path;

use mrbd_lab::diagnose::answer::{FoundEffect, Summary};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::super::diagnose::Outcome;
use super::super::score::reading::{Diagnosed, list, number, text, texts};
use super::super::score::recorded::Recorded;
use super::super::score::row::held_out;
use super::found::{
    Excited, curve_error, force_error, function_error, is_spelled_as, number_errors, round_exponents_hold,
};
use super::refused::RefusedRow;
use super::visible;

/// A force that is off by less than this share is the right function.
pub const RIGHT_FUNCTION: f64 = 0.1;
/// What a law gains over the recalibrated wall from which it is visible, in natural logarithms of likelihood; of rows that do not know it,
/// what speaks against that wall.
const VISIBLE_NATS: f64 = 60.0;

/// A diagnosed case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LawRow {
    /// Name of the set.
    pub set: String,
    pub number: u64,
    pub group: String,
    pub simulator: String,
    pub prior: String,
    pub noise_rad: f64,
    pub size: f64,
    pub tests: u64,
    /// What is hidden: formulas, or effects by their names.
    pub hidden: Vec<String>,
    pub hidden_place: String,
    /// Whether an exponent is none of halves.
    pub off_grid: bool,
    /// Of each atom its share of the force in the tests to fit; none of cases made before this was told, but for pairs made again.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shares: Vec<f64>,
    /// The verdict; `failed` where there is none.
    pub verdict: String,
    /// What was found: formulas with their places, or effects by their names.
    pub found: Vec<String>,
    pub place: String,
    /// Whether the answer, and another of its class, is written as what is hidden.
    pub spelled: bool,
    pub spelled_in_class: bool,
    /// Whether the answer, or another of its class, is written as what is hidden but for exponents told as round ones, and the intervals of
    /// these hold the true ones; none where it is not, or of answers before these were told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub round_exponents_hold: Option<bool>,
    /// By how much the force is off over what the tests to fit excited, and those held out.
    pub function_error: Option<f64>,
    pub function_error_held_out: Option<f64>,
    /// How far each number is off, and whether its interval holds the truth.
    pub numbers: Vec<(f64, bool)>,
    /// Of a force without a formula: see `found::curve_error`.
    #[serde(default)]
    pub curve: Option<(f64, f64)>,
    /// Formulas that were refused; none of cases that were recorded before this was told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refused: Option<Vec<RefusedRow>>,
    /// What speaks against the wall with its own numbers fitted, in natural logarithms of likelihood.
    pub against_recalibrated: Option<f64>,
    /// What the true law gains over that wall, of a law that was not told; none where nothing of it is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law_gains: Option<f64>,
    /// Windowed error of the held-out test over the noise, before and after.
    pub before: Option<f64>,
    pub after: Option<f64>,
    pub seconds: f64,
    /// The line that it was read from, if it was recorded before.
    #[serde(skip)]
    pub recorded_as: Option<String>,
}

impl Recorded for LawRow {
    fn case(&self) -> (&str, u64) {
        (&self.set, self.number)
    }

    fn line(&self) -> Option<&str> {
        self.recorded_as.as_deref()
    }

    fn read_from(self, line: &str) -> Self {
        Self { recorded_as: Some(line.to_owned()), ..self }
    }
}

impl LawRow {
    /// The row of a case; none if it has not been diagnosed.
    ///
    /// # Errors
    /// Text for people if a file cannot be read.
    pub fn load(folder: &Path) -> Result<Option<Self>, String> {
        let Some(case) = Diagnosed::load(folder)? else { return Ok(None) };
        let row = Self::new(&case.answer, case.diagnosis.as_ref(), &case.outcome);
        let law_gains = if row.right() { None } else { visible::gain(&case, folder)? };
        Ok(Some(Self { law_gains, ..row }))
    }

    fn new(answer: &Value, diagnosis: Option<&Summary>, outcome: &Outcome) -> Self {
        let effects = diagnosis.map_or(&[][..], |d| &d.effects);
        let has_formula = diagnosis.is_some_and(Summary::has_formula);
        let classes = diagnosis.map_or(&[][..], |d| &d.equivalent_formulas);
        // Of a name in a class with formulas, the force of the one that is hidden.
        let in_class = classes.iter().find(|one| !has_formula && is_spelled_as(answer, one));
        let error = |part: &str| {
            let points = excited(answer, part);
            let of_formula =
                diagnosis.filter(|_| has_formula).and_then(|d| function_error(answer, d, &points));
            of_formula.or_else(|| force_error(answer, in_class?, None, &points))
        };
        Self {
            set: text(answer, "/case/set"),
            number: answer.pointer("/case/number").and_then(Value::as_u64).unwrap_or_default(),
            group: text(answer, "/case/kind"),
            simulator: text(answer, "/case/simulator"),
            prior: text(answer, "/case/prior"),
            noise_rad: number(answer, "/case/noise_rad").unwrap_or(f64::NAN),
            size: number(answer, "/case/size").unwrap_or(f64::NAN),
            tests: number(answer, "/case/fit_tests").unwrap_or(0.0) as u64,
            hidden: list(answer, "/effects").iter().map(hidden).collect(),
            hidden_place: text(answer, "/effects/0/place"),
            off_grid: list(answer, "/effects").iter().any(is_off_grid),
            shares: list(answer, "/excited/shares").iter().filter_map(Value::as_f64).collect(),
            verdict: diagnosis.map_or("failed", |d| d.verdict.name()).into(),
            found: effects.iter().map(found).collect(),
            place: diagnosis.and_then(|d| d.place.clone()).unwrap_or_default(),
            spelled: has_formula && is_spelled_as(answer, effects),
            spelled_in_class: classes.iter().any(|one| is_spelled_as(answer, one)),
            round_exponents_hold: round_exponents(answer, effects, classes),
            function_error: error("fit"),
            function_error_held_out: error("held_out"),
            numbers: if has_formula { number_errors(answer, effects) } else { Vec::new() },
            curve: diagnosis.and_then(|d| curve_error(answer, d, &excited(answer, "held_out"))),
            refused: diagnosis.map(|d| {
                let points = excited(answer, "fit");
                d.refused.iter().filter_map(|law| RefusedRow::new(answer, law, &points)).collect()
            }),
            against_recalibrated: diagnosis.map(|d| d.against.recalibrated),
            law_gains: None,
            before: diagnosis.and_then(|d| held_out(d, |error| error.before)),
            after: diagnosis.and_then(|d| held_out(d, |error| error.after)),
            seconds: outcome.seconds,
            recorded_as: None,
        }
    }

    /// Whether a formula was accepted.
    pub fn accepts(&self) -> bool {
        matches!(self.verdict.as_str(), "formula" | "formula_class")
    }

    /// Whether the hidden law shows at all, by what the true one gains where that is known; a diagnosis that failed is held against the
    /// program.
    pub fn visible(&self) -> bool {
        let speaks = self.law_gains.or(self.against_recalibrated);
        self.right() || speaks.is_none_or(|nats| nats > VISIBLE_NATS)
    }

    /// Whether every atom makes a part of the force, where tests were fitted, without which that would be another.
    pub fn all_act(&self) -> bool {
        !self.shares.is_empty() && self.shares.iter().all(|share| *share > RIGHT_FUNCTION)
    }

    /// Whether the force is the true one: where tests were fitted, or in the one held out where nothing moved at its place in those, as at a
    /// crack that opens at impacts alone.
    pub fn function_right(&self) -> bool {
        let error = self.function_error.or(self.function_error_held_out);
        error.is_some_and(|error| error < RIGHT_FUNCTION)
    }

    /// Whether the formula is the true one.
    pub fn exact(&self) -> bool {
        self.spelled && self.function_right()
    }

    /// Whether the formula, or another of its class, is the true one.
    pub fn right(&self) -> bool {
        self.exact() || (self.spelled_in_class && self.function_right())
    }

    /// The same, or with exponents told as round ones whose intervals hold the true ones.
    pub fn right_or_holds_it(&self) -> bool {
        self.right() || (self.round_exponents_hold == Some(true) && self.function_right())
    }

    /// Whether a formula was accepted that is another force.
    pub fn wrong(&self) -> bool {
        self.accepts() && !self.function_right()
    }

    /// What was said, in a line.
    pub fn said(&self) -> String {
        let off = |error: Option<f64>| error.map_or("-".to_owned(), |e| format!("{:.1} %", 100.0 * e));
        let errors = [self.function_error, self.function_error_held_out].map(off);
        format!(
            "{:>3} {:9} {:.0e} x{:<3} {:>6.0} nats {:>5.0} s | {} | {} {} at {} | off {}, held out {}; error {:.2} to {:.2}",
            self.number,
            self.simulator,
            self.noise_rad,
            self.size,
            self.against_recalibrated.unwrap_or(f64::NAN),
            self.seconds,
            self.hidden.join(" + "),
            self.verdict,
            self.found.join(" + "),
            self.place,
            errors[0],
            errors[1],
            self.before.unwrap_or(f64::NAN),
            self.after.unwrap_or(f64::NAN),
        )
    }
}

/// Of an answer and the others of its class whether one with round exponents holds what is hidden.
fn round_exponents(answer: &Value, effects: &[FoundEffect], class: &[Vec<FoundEffect>]) -> Option<bool> {
    let all = std::iter::once(effects).chain(class.iter().map(Vec::as_slice));
    all.filter_map(|one| round_exponents_hold(answer, one)).reduce(|any, one| any || one)
}

fn excited(answer: &Value, part: &str) -> Vec<Excited> {
    let point =
        |point: &Value| Some([0, 1, 2, 3].map(|i| point.get(i).and_then(Value::as_f64).unwrap_or(f64::NAN)));
    list(answer, &format!("/excited/{part}")).iter().filter_map(point).collect()
}

/// What is hidden, in a line.
pub fn hidden(effect: &Value) -> String {
    let formula = text(effect, "/formula");
    let Some(numbers) = effect.pointer("/parameters").and_then(Value::as_object) else {
        return text(effect, "/name");
    };
    let told =
        |(name, value): (&String, &Value)| format!("{name} = {:.4}", value.as_f64().unwrap_or(f64::NAN));
    format!(
        "{formula} at {}, {}",
        text(effect, "/place"),
        numbers.iter().map(told).collect::<Vec<_>>().join(", ")
    )
}

fn found(effect: &FoundEffect) -> String {
    let numbers = effect.parameters.iter().map(|(name, value)| format!("{name} = {value:.4}"));
    let numbers = numbers.collect::<Vec<_>>().join(", ");
    match (&effect.formula, &effect.name) {
        (Some(formula), _) => format!("{formula} at {}, {numbers}", effect.place),
        (None, Some(name)) => format!("{name}, {numbers}"),
        (None, None) => String::new(),
    }
}

/// Whether an exponent of a hidden law is no half.
fn is_off_grid(effect: &Value) -> bool {
    let spelled = texts(effect, "/spellings", "");
    spelled.len() == 1 && spelled[0].contains("**")
}
