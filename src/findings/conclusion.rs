//! How sure an answer is: the same question put to many draws of the records and of what no input decides.

use rayon::prelude::*;

use super::view::{Slender, View};
use super::vote::{Answer, Verdict};
use super::{FINDINGS, Finding};
use crate::aggregate::{DRAWS, Draws, FEWEST_RECORDS, Medians};
use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::survey::Configuration;

/// Share of the draws that must agree before a conclusion is one: the level of the intervals of the medians.
pub const SURE: f64 = 0.9;

/// What the draws say of a claim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sureness {
    /// Share of the draws in which it holds.
    pub holds: f64,
    /// Share in which it does not.
    pub does_not: f64,
    /// Records in a draw.
    pub records: usize,
    /// How many answer for a run, itself among them.
    pub members: usize,
}

impl Sureness {
    /// Of what the study does not vary.
    pub const NONE: Self = Self { holds: 0.0, does_not: 0.0, records: 0, members: 0 };

    /// What that adds up to.
    pub fn verdict(&self) -> Verdict {
        match () {
            () if self.holds >= SURE => Verdict::Holds,
            () if self.does_not >= SURE => Verdict::DoesNot,
            () => Verdict::Undecided,
        }
    }

    /// "97 %" of one that is decided; "62 % for, 5 % against".
    pub fn short(&self) -> String {
        let percent = |share: f64| format!("{} %", percent(share));
        match self.verdict() {
            Verdict::Holds => percent(self.holds),
            Verdict::DoesNot => percent(self.does_not),
            _ => format!("{} for, {} against", percent(self.holds), percent(self.does_not)),
        }
    }

    /// The shares, and of what draws.
    pub fn tell(&self) -> String {
        let [holds, does_not] = [self.holds, self.does_not].map(percent);
        format!(
            "holds in {holds} % and does not in {does_not} % of {DRAWS} draws of {} records and of {}",
            self.records,
            match self.members {
                1 => "no ensembles".to_owned(),
                members => format!("{members} members of each run"),
            }
        )
    }
}

/// A share in whole percents, downwards: 89.9 % are not the 90 % that decide.
pub(super) fn percent(share: f64) -> u32 {
    // Of a thousand draws a share has three digits; a thousandth of one keeps roundings out.
    (100.0 * share + 1e-3).floor() as u32
}

/// What a study says of a conclusion of the source.
#[derive(Debug, Clone, PartialEq)]
pub struct Conclusion {
    /// What the medians at hand say.
    pub answer: Answer,
    /// How sure that is; `None` of too few records, and of what the study does not vary.
    pub sureness: Option<Sureness>,
}

impl Conclusion {
    /// The verdict: by the draws, and where there are none by the medians at hand.
    pub fn verdict(&self) -> Verdict {
        self.sureness.map_or(self.answer.verdict, |sureness| sureness.verdict())
    }

    /// "holds, 97 %", or the verdict alone where nobody knows how sure it is.
    pub fn short(&self) -> String {
        let verdict = self.verdict().name();
        self.sureness
            .map_or_else(|| verdict.to_owned(), |sureness| format!("{verdict}, {}", sureness.short()))
    }
}

/// Conclusions under the assumptions of a variant.
#[derive(Debug, Clone, PartialEq)]
pub struct Conclusions {
    /// Name of the variant.
    pub variant: String,
    /// One for each of [`FINDINGS`], in their order.
    pub all: Vec<Conclusion>,
}

/// What the words of a verdict mean.
pub fn sure_rules() -> String {
    let percent = percent(SURE);
    format!(
        "A conclusion holds, or does not, if it does in {percent} % of {DRAWS} draws; else it is undecided. \
         A draw takes as many records as the study has, with replacement, and one member of the ensemble of each run: \
         what no input decides. Of fewer than {FEWEST_RECORDS} records the medians at hand decide alone."
    )
}

/// The conclusions under every variant.
pub fn conclusions(medians: &Medians) -> Vec<Conclusions> {
    medians.variants.iter().map(|variant| under(medians, &variant.name)).collect()
}

fn under(medians: &Medians, variant: &str) -> Conclusions {
    let view = View::new(medians, variant);
    let answers = FINDINGS.iter().map(|finding| finding.answer(&view));
    let draws = medians.draws.iter().find(|draws| draws.variant == variant && draws.tell());
    let Some(draws) = draws else {
        let all = answers.map(|answer| Conclusion { answer, sureness: None }).collect();
        return Conclusions { variant: variant.to_owned(), all };
    };
    let sureness = sureness(draws, draws.records);
    let conclusion = |(answer, sureness): (Answer, Sureness)| {
        let asked = answer.verdict != Verdict::NotAsked;
        Conclusion { answer, sureness: asked.then_some(sureness) }
    };
    Conclusions { variant: variant.to_owned(), all: answers.zip(sureness).map(conclusion).collect() }
}

/// How sure each of [`FINDINGS`] is where a draw has so many records.
pub fn sureness(draws: &Draws, records: usize) -> Vec<Sureness> {
    let verdicts = |table: &mut Medians, draw| -> Vec<Verdict> {
        draws.draw_into(draw, records, table);
        let view = View::new(table, &draws.variant);
        FINDINGS.iter().map(|finding: &Finding| finding.answer(&view).verdict).collect()
    };
    let drawn: Vec<_> = (0..DRAWS).into_par_iter().map_init(|| draws.table(), verdicts).collect();
    let share = |finding: usize, verdict: Verdict| {
        drawn.iter().filter(|verdicts| verdicts[finding] == verdict).count() as f64 / DRAWS as f64
    };
    let of = |finding| Sureness {
        holds: share(finding, Verdict::Holds),
        does_not: share(finding, Verdict::DoesNot),
        records,
        members: draws.members,
    };
    (0..FINDINGS.len()).map(of).collect()
}

/// What a conclusion compares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// Reference façades, all parameters at their means.
    Reference,
    /// Reference façades under several records.
    Records,
    /// Parameters that both floors share.
    Shared,
    /// The levels of one parameter.
    Of(Parameter),
}

/// What a study must hold for a conclusion to be asked of it.
#[derive(Debug, Clone, Copy)]
pub struct Needs {
    /// What is compared.
    pub subject: Subject,
    /// Under these floors.
    pub floors: &'static [Configuration],
    /// At slendernesses in each of these ranges.
    pub slender: &'static [Slender],
}

/// Slendernesses on both sides of the source's line.
pub const BOTH_RANGES: &[Slender] = &[Slender::Moderate, Slender::Large];

impl Needs {
    /// What of it the medians of a study lack, in words; `None` where they lack nothing.
    pub fn missing(&self, view: &View) -> Option<String> {
        let lacks = |floor: &&Configuration| !self.subject.is_varied(view, **floor);
        if let Some(floor) = self.floors.iter().find(lacks) {
            return Some(format!("{} under the {} floor", self.subject.name(), floor.name()));
        }
        let lacks = |range: &&Slender| view.slendernesses(**range).is_empty();
        self.slender.iter().find(lacks).map(|range| range.name().to_owned())
    }
}

impl Subject {
    fn is_varied(self, view: &View, floor: Configuration) -> bool {
        let mut rows = view.rows().filter(|row| row.case.configuration == floor);
        match self {
            Subject::Reference => rows.next().is_some(),
            Subject::Records => rows.any(|row| row.runs > 1),
            Subject::Shared => !view.shared_parameters().is_empty(),
            Subject::Of(parameter) => {
                let mut levels = rows.filter(|row| row.case.parameter == parameter).map(|row| row.case.level);
                levels.any(|level| level != Level::Mean)
            }
        }
    }

    fn name(self) -> &'static str {
        match self {
            Subject::Reference => "façades",
            Subject::Records => "several records",
            Subject::Shared => "levels of a parameter that both floors have",
            Subject::Of(parameter) => match parameter {
                Parameter::Thickness => "levels of the thickness",
                Parameter::CrackHeight => "levels of the crack height",
                Parameter::Strength => "levels of the strength",
                Parameter::Stiffness => "levels of the floor's stiffness",
                Parameter::DiaphragmMass => "levels of the floor's mass m_d",
                Parameter::CarriageMass => "levels of the floor's mass m_dp",
                Parameter::Restitution => "levels of the coefficients C_l",
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sure(holds: f64, does_not: f64) -> Sureness {
        Sureness { holds, does_not, records: 7, members: 13 }
    }

    #[test]
    fn regress_nine_of_ten_draws_decide() {
        assert_eq!(sure(0.9, 0.1).verdict(), Verdict::Holds);
        assert_eq!(sure(0.02, 0.95).verdict(), Verdict::DoesNot);
        assert_eq!(sure(0.899, 0.0).verdict(), Verdict::Undecided);
    }

    #[test]
    fn regress_shares_are_rounded_downwards() {
        assert_eq!(sure(0.899, 0.029).short(), "89 % for, 2 % against");
        assert_eq!((sure(0.97, 0.0).short(), sure(0.0, 1.0).short()), ("97 %".into(), "100 %".into()));
        assert_eq!(
            [0.29, 0.57, 0.58].map(percent),
            [29, 57, 58],
            "no share of a thousand draws is cut by a rounding"
        );
    }

    #[test]
    fn regress_without_draws_the_medians_at_hand_decide() {
        let answer =
            Answer { verdict: Verdict::Holds, short: "4 of 4".into(), numbers: "4 of 4 agree".into() };
        let at_hand = Conclusion { answer, sureness: None };
        assert_eq!((at_hand.verdict(), at_hand.short()), (Verdict::Holds, "holds".into()));
        let drawn = Conclusion { sureness: Some(sure(0.5, 0.25)), ..at_hand };
        assert_eq!(drawn.verdict(), Verdict::Undecided);
        assert_eq!(drawn.short(), "undecided, 50 % for, 25 % against");
    }
}
