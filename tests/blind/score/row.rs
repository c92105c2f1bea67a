//! One case: what was hidden, what was said, and whether that is right.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::super::diagnose::Outcome;
use super::reading::{Diagnosed, list, median, number, text, texts};
use super::recorded::Recorded;
use mrbd_lab::diagnose::answer::{BeforeAfter, FoundEffect, Summary};
use mrbd_lab::experiment_file::Purpose;

/// Laws that joints follow which give.
const GIVING: [&str; 3] = ["compliant_joint", "trilinear_joint", "crushing_joint"];

/// A diagnosed case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Name of the set.
    pub set: String,
    pub number: u64,
    pub kind: String,
    pub simulator: String,
    pub prior: String,
    pub noise_rad: f64,
    pub size: f64,
    pub tests: u64,
    /// Effects that are hidden, in order.
    pub hidden: Vec<String>,
    /// Where they act, in the same order.
    pub hidden_places: Vec<String>,
    /// The verdict; `failed` where there is none.
    pub verdict: String,
    pub named: Vec<String>,
    pub equivalent: Vec<String>,
    pub place: String,
    /// Deviation of each hidden effect from doing nothing over the smallest that the diagnosis says it could detect.
    pub over_detectable: Vec<Option<f64>>,
    /// |found - true| / deviation of the first effect's number, where it was named rightly.
    pub parameter_error: Option<f64>,
    /// Whether the interval of that number holds the truth.
    pub covered: Option<bool>,
    /// Median windowed error of the held-out tests over the noise floor, before and after.
    pub before: Option<f64>,
    pub after: Option<f64>,
    pub seconds: f64,
    /// The line that it was read from, if it was recorded before: numbers that are read and written again differ in the last bit.
    #[serde(skip)]
    pub recorded_as: Option<String>,
}

impl Recorded for Row {
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

impl Row {
    /// The row of a case; none if it has not been diagnosed.
    ///
    /// # Errors
    /// Text for people if a file cannot be read.
    pub fn load(case: &Path) -> Result<Option<Self>, String> {
        Ok(Diagnosed::load(case)?.map(|case| Self::new(&case.answer, case.diagnosis.as_ref(), &case.outcome)))
    }

    /// The row of a case with this answer; without a diagnosis where that failed.
    fn new(answer: &Value, diagnosis: Option<&Summary>, outcome: &Outcome) -> Self {
        let effects = diagnosis.map_or(&[][..], |d| &d.effects);
        let mut row = Self {
            set: text(answer, "/case/set"),
            number: answer.pointer("/case/number").and_then(Value::as_u64).unwrap_or_default(),
            kind: text(answer, "/case/kind"),
            simulator: text(answer, "/case/simulator"),
            prior: text(answer, "/case/prior"),
            noise_rad: number(answer, "/case/noise_rad").unwrap_or(f64::NAN),
            size: number(answer, "/case/size").unwrap_or(f64::NAN),
            tests: number(answer, "/case/fit_tests").unwrap_or(0.0) as u64,
            hidden: texts(answer, "/effects", "kind"),
            hidden_places: texts(answer, "/effects", "place"),
            verdict: diagnosis.map_or("failed", |d| d.verdict.name()).into(),
            named: effects.iter().map(|effect| effect.kind.clone().unwrap_or_default()).collect(),
            equivalent: diagnosis.map_or_else(Vec::new, |d| d.equivalent.clone()),
            place: diagnosis.and_then(|d| d.place.clone()).unwrap_or_default(),
            over_detectable: (0..list(answer, "/effects").len())
                .map(|index| over_detectable(answer, index, diagnosis?))
                .collect(),
            parameter_error: None,
            covered: None,
            before: diagnosis.and_then(|d| held_out(d, |error| error.before)),
            after: diagnosis.and_then(|d| held_out(d, |error| error.after)),
            seconds: outcome.seconds,
            recorded_as: None,
        };
        if row.exact() {
            row.compare_parameter(answer, effects);
        }
        row
    }

    /// Compares the number of the first hidden effect, if it is one number.
    fn compare_parameter(&mut self, answer: &Value, effects: &[FoundEffect]) {
        let Some(value) = number(answer, "/effects/0/value") else { return };
        let Some(deviation) = number(answer, "/effects/0/deviation") else { return };
        let parameter = text(answer, "/effects/0/parameter");
        let kind = &self.hidden[0];
        // One kind may stand at both joints.
        let name = text(answer, "/effects/0/name");
        let is_it = |effect: &&FoundEffect| effect.kind.as_ref() == Some(kind);
        let same = effects.iter().filter(is_it).find(|effect| effect.name.as_ref() == Some(&name));
        let Some(effect) = same.or_else(|| effects.iter().find(is_it)) else { return };
        let found = effect.parameters.get(&parameter);
        self.parameter_error = found.map(|found| (found - value).abs() / deviation);
        let interval = effect.interval.get(&parameter);
        self.covered = interval.map(|[low, high]| *low <= value && value <= *high);
    }

    /// Whether the first effect is at least twice the smallest detectable; by its size where that is not told.
    pub fn visible(&self) -> bool {
        self.shows(self.first_over_detectable())
    }

    /// See [`Row::over_detectable`], of the first effect.
    pub fn first_over_detectable(&self) -> Option<f64> {
        self.over_detectable.first().copied().flatten()
    }

    /// Whether all of its effects are.
    pub fn all_visible(&self) -> bool {
        self.over_detectable.iter().all(|ratio| self.shows(*ratio))
    }

    fn shows(&self, over_detectable: Option<f64>) -> bool {
        over_detectable.map_or(self.size >= 1.0, |ratio| ratio >= 2.0)
    }

    /// Whether an effect of the catalogue was hidden.
    pub fn hides_effect(&self) -> bool {
        !self.hidden.is_empty() && !self.hides_other_law()
    }

    /// Whether a law outside the catalogue was hidden.
    pub fn hides_other_law(&self) -> bool {
        self.kind.starts_with("outside")
    }

    /// Whether an effect is among those that are hidden.
    pub fn hides(&self, effect: &str) -> bool {
        self.hidden.iter().any(|hidden| hidden == effect)
    }

    /// Whether an effect is among those named.
    pub fn names(&self, effect: &str) -> bool {
        self.verdict == "named" && self.named.iter().any(|named| named == effect)
    }

    /// Whether an effect is among those named, or in the class.
    pub fn tells(&self, effect: &str) -> bool {
        let in_class = || self.named.iter().chain(&self.equivalent).any(|named| named == effect);
        self.names(effect) || (self.verdict == "class" && in_class())
    }

    /// Whether what was hidden is told but for the law that joints follow which give: named, or in a class of such laws alone.
    pub fn tells_beside_joints(&self) -> bool {
        let beside = |names: &[String]| {
            let mut names = names.iter().filter(|name| !GIVING.contains(&name.as_str())).collect::<Vec<_>>();
            names.sort();
            names.dedup();
            names.into_iter().cloned().collect::<Vec<_>>()
        };
        let all = [&self.named[..], &self.equivalent].concat();
        let gives = all.iter().any(|name| GIVING.contains(&name.as_str()));
        let is_told = beside(&self.named) == beside(&self.hidden) && beside(&all) == beside(&self.hidden);
        matches!(self.verdict.as_str(), "named" | "class") && gives && is_told
    }

    /// Share of the squared windowed error above noise that is taken away in the tests held out; `None` where there is none.
    pub fn taken(&self) -> Option<f64> {
        let excess = |error: f64| error * error - 1.0;
        let before = self.before.map(excess).filter(|before| *before > 0.0)?;
        Some(1.0 - excess(self.after?) / before)
    }

    /// Whether something was claimed to be there, by name, as a class or as a formula.
    pub fn claims(&self) -> bool {
        matches!(self.verdict.as_str(), "named" | "class" | "formula" | "formula_class")
    }

    /// Exactly what was hidden was named.
    pub fn exact(&self) -> bool {
        let sorted = |names: &[String]| {
            let mut names = names.to_vec();
            names.sort();
            names
        };
        self.verdict == "named" && self.hides_effect() && sorted(&self.named) == sorted(&self.hidden)
    }

    /// What was hidden was named, or is in the class.
    pub fn right(&self) -> bool {
        let told = |effect: &String| self.named.contains(effect) || self.equivalent.contains(effect);
        self.exact() || (self.verdict == "class" && self.hides_effect() && self.hidden.iter().all(told))
    }

    /// A name was given that is not what was hidden; one of two is not wrong, only not all.
    pub fn wrong(&self) -> bool {
        match self.verdict.as_str() {
            "named" => self.named.iter().any(|name| self.hides_other_law() || !self.hidden.contains(name)),
            "class" => !self.right(),
            _ => false,
        }
    }

    /// Whether the place is right, of either of two effects, named or not.
    pub fn place_right(&self) -> bool {
        self.hidden_places.contains(&self.place)
    }

    /// What was said, in a word: the verdict, or the names.
    pub fn said(&self) -> String {
        match self.verdict.as_str() {
            "named" => self.named.join(" + "),
            "class" => "a class".into(),
            other => format!("({other})"),
        }
    }
}

/// How far above the smallest detectable size an effect is, as the diagnosis itself sees that size.
fn over_detectable(answer: &Value, index: usize, diagnosis: &Summary) -> Option<f64> {
    let of = |key: &str| format!("/effects/{index}/{key}");
    let name = text(answer, &of("name"));
    let row = diagnosis.could_hide.iter().find(|row| row.name == name)?;
    let deviation = number(answer, &of("deviation"))?;
    (row.parameter == text(answer, &of("parameter"))).then(|| deviation / row.smallest_detectable)
}

/// The median over held-out tests of the windowed error over the noise floor.
pub fn held_out(diagnosis: &Summary, when: fn(BeforeAfter<Option<f64>>) -> Option<f64>) -> Option<f64> {
    let tests = diagnosis.tests.iter().filter(|test| test.purpose == Purpose::HoldOut);
    median(tests.filter_map(|test| Some(when(test.windowed_error)? / test.noise_floor)))
}
