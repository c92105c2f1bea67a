//! Laws that were refused, and what refused each: so that it can be counted what a guard keeps out, of wrong laws and of right ones.

use serde::{Deserialize, Serialize};

use crate::diagnose::hypothesis::Hypothesis;
use crate::diagnose::trials::FittedHypothesis;

/// What refuses a law that fits, or a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Guard {
    /// It would feed the wall, or jump.
    Passivity,
    /// It gains too little.
    Evidence,
    /// A number of its shape is at an end of what was looked at: beyond what was excited.
    InsideRange,
    /// Points of a test that it was not fitted to speak against it.
    LeftOutTests,
    /// Windows are not followed to their noise.
    Gap,
    /// Windows of the tests held out, which go to another amplitude, are not followed as those fitted are, nor what precedes their
    /// first impacts.
    HeldOut,
    /// A size of it is nothing, or by chance.
    Size,
    /// Its second atom gains too little beside the first.
    SecondAtom,
    /// It leaves more than noise, and one of two atoms says clearly more, if not enough for its second.
    LacksAtom,
    /// A size of it would differ in large motion.
    Trend,
    /// What it leaves at the top bends with velocity.
    Bend,
    /// Its fit has worked as much as it may, and had not ended.
    Work,
    /// It gains too little beside the name that it would stand for.
    Name,
    /// Of a name: its exponent set free does clearly better.
    FreedExponent,
}

impl Guard {
    /// Every guard, in the order of the flow.
    pub const ALL: [Self; 14] = [
        Self::Passivity,
        Self::Evidence,
        Self::InsideRange,
        Self::LeftOutTests,
        Self::Work,
        Self::Gap,
        Self::HeldOut,
        Self::Size,
        Self::SecondAtom,
        Self::LacksAtom,
        Self::Bend,
        Self::Trend,
        Self::Name,
        Self::FreedExponent,
    ];

    /// Its name in `diagnosis.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Passivity => "passivity",
            Self::Evidence => "evidence",
            Self::InsideRange => "inside_range",
            Self::LeftOutTests => "left_out_tests",
            Self::Gap => "gap",
            Self::HeldOut => "held_out",
            Self::Size => "size",
            Self::SecondAtom => "second_atom",
            Self::LacksAtom => "lacks_atom",
            Self::Trend => "trend",
            Self::Bend => "bend",
            Self::Work => "work",
            Self::Name => "name",
            Self::FreedExponent => "freed_exponent",
        }
    }
}

/// A law that was refused.
#[derive(Debug, Clone)]
pub struct Refused {
    /// The law, or the name, beside the wall.
    pub hypothesis: Hypothesis,
    /// Numbers of the wall and of the law.
    pub values: Vec<f64>,
    /// What refused it; never empty.
    pub guards: Vec<Guard>,
    /// Windowed errors of the tests fitted and held out; `None` of a law that points alone have seen.
    pub errors: Option<[Option<f64>; 2]>,
}

impl Refused {
    /// A law that was fitted to windows.
    pub fn in_windows(tried: &FittedHypothesis, guards: Vec<Guard>) -> Self {
        Self {
            hypothesis: tried.hypothesis.clone(),
            values: tried.fit.values.clone(),
            guards,
            errors: Some(tried.errors()),
        }
    }

    /// Whether it is this law with these numbers.
    pub fn is_of(&self, tried: &FittedHypothesis) -> bool {
        self.values == tried.fit.values && self.hypothesis.name() == tried.hypothesis.name()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_guards_are_written_by_their_names() {
        for guard in Guard::ALL {
            assert_eq!(toml::Value::try_from(guard).expect("a name").as_str(), Some(guard.name()));
        }
    }
}
