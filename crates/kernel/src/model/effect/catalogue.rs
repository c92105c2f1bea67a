//! The catalogue: what every kind of effect is called, where it acts, what it takes and how it is known.

use std::fmt;

use serde::Serialize;

use super::sums::EffectSums;
use super::{Effect, EffectError, MOST_PARAMETERS};
use super::{at_impacts, at_joints, at_top, in_ground, in_sensor};

/// Where an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// At C, on the top of the wall.
    Top,
    /// At one of the joints.
    Joint,
    /// At impacts.
    Impacts,
    /// In the motion of the ground.
    GroundMotion,
    /// In the reading of the rotations, not in the wall.
    Sensor,
}

/// A number that a kind of effect takes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EffectParameter {
    /// Its key in wall files; `factors.3` is the fourth number of the list `factors`.
    pub key: &'static str,
    /// Its unit; empty for a ratio.
    pub unit: &'static str,
    /// The least value allowed.
    pub least: f64,
    /// The largest value allowed.
    pub most: f64,
    /// A value as it might be, for examples.
    pub example: f64,
    /// What it means.
    pub meaning: &'static str,
}

/// A word that a kind of effect takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct EffectChoice {
    /// Its key in wall files.
    pub key: &'static str,
    /// The words allowed.
    pub options: &'static [&'static str],
    /// What it means.
    pub meaning: &'static str,
}

/// One kind of effect.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct EffectKind {
    /// The `kind` in wall files.
    pub name: &'static str,
    /// Where it acts.
    pub place: Place,
    /// The word it takes, if any.
    pub choice: Option<EffectChoice>,
    /// The numbers it takes.
    pub parameters: &'static [EffectParameter],
    /// Whether a wall may have several: their laws then add up, factors multiply.
    pub may_repeat: bool,
    /// The law as a formula.
    pub law: &'static str,
    /// What it is, in plain words.
    pub description: &'static str,
    /// What of a measured motion it goes with, between impacts.
    pub fingerprint: &'static str,
    /// What it does at impacts.
    pub at_impacts: &'static str,
    /// What it is easily taken for: kinds, or keys of the wall file.
    pub confused_with: &'static [&'static str],
    /// The measurement that tells it by itself, whatever the tests say.
    pub told_by: &'static str,
    /// Adds an effect of this kind to what the effects of a wall come to.
    #[serde(skip)]
    pub(super) add: fn(&Effect, &mut EffectSums),
}

/// A kind of effect with the word it takes chosen: what can be tried as one hypothesis.
#[derive(Clone, Copy)]
pub struct EffectVariant {
    /// The kind.
    pub kind: &'static EffectKind,
    /// The word, for kinds that take one.
    pub choice: Option<&'static str>,
}

/// Every kind, by place.
pub(super) static KINDS: [EffectKind; COUNT] = {
    const PLACES: [&[EffectKind]; 5] =
        [&at_top::KINDS, &at_joints::KINDS, &at_impacts::KINDS, &in_ground::KINDS, &in_sensor::KINDS];
    let mut kinds = [at_top::KINDS[0]; COUNT];
    let (mut place, mut filled) = (0, 0);
    while place < PLACES.len() {
        let mut i = 0;
        while i < PLACES[place].len() {
            kinds[filled] = PLACES[place][i];
            filled += 1;
            i += 1;
        }
        place += 1;
    }
    kinds
};

const COUNT: usize = at_top::KINDS.len()
    + at_joints::KINDS.len()
    + at_impacts::KINDS.len()
    + in_ground::KINDS.len()
    + in_sensor::KINDS.len();

impl EffectKind {
    /// The kind with each word it may take; one variant for a kind that takes none.
    pub fn variants(&'static self) -> impl Iterator<Item = EffectVariant> {
        let options: &[&str] = self.choice.as_ref().map_or(&[], |choice| choice.options);
        let plain = options.is_empty().then_some(None);
        plain
            .into_iter()
            .chain(options.iter().copied().map(Some))
            .map(move |choice| EffectVariant { kind: self, choice })
    }

    /// The variant with this word.
    ///
    /// # Errors
    /// A word that there is not, or none where there is one to choose.
    pub fn variant(&'static self, choice: Option<&str>) -> Result<EffectVariant, EffectError> {
        if let Some(variant) = self.variants().find(|variant| variant.choice == choice) {
            return Ok(variant);
        }
        let found = choice.map_or("nothing".to_owned(), |word| format!("`{word}`"));
        Err(match self.choice {
            Some(EffectChoice { key, options, .. }) => {
                EffectError::Choice { kind: self.name, key, found, options }
            }
            None => {
                EffectError::Keys { kind: self.name, found, allowed: "no choice: there is none".to_owned() }
            }
        })
    }
}

impl EffectVariant {
    /// `kind`, or `kind.choice`: what [`Effect::with_parameters`] takes.
    pub fn name(&self) -> String {
        match self.choice {
            Some(choice) => format!("{}.{choice}", self.kind.name),
            None => self.kind.name.to_owned(),
        }
    }

    /// The effect with these values of its parameters, in the order of [`EffectKind::parameters`].
    ///
    /// # Errors
    /// Not as many values as parameters; a value outside its bounds.
    pub fn with_parameters(self, values: &[f64]) -> Result<Effect, EffectError> {
        let parameters = self.kind.parameters;
        if values.len() != parameters.len() {
            let found = format!("{} values", values.len());
            return Err(EffectError::Keys {
                kind: self.kind.name,
                found,
                allowed: parameters.len().to_string(),
            });
        }
        let mut all = [0.0; MOST_PARAMETERS];
        for (i, (&value, allowed)) in values.iter().zip(parameters).enumerate() {
            // A NaN is within no bounds.
            if !(allowed.least..=allowed.most).contains(&value) {
                return Err(EffectError::Bounds { kind: self.kind.name, key: allowed.key, value, allowed });
            }
            all[i] = value;
        }
        Ok(Effect { variant: self, values: all })
    }

    /// The effect with the example values of the catalogue.
    pub fn example(self) -> Effect {
        let mut values = [0.0; MOST_PARAMETERS];
        self.kind
            .parameters
            .iter()
            .zip(&mut values)
            .for_each(|(parameter, value)| *value = parameter.example);
        Effect { variant: self, values }
    }
}

impl PartialEq for EffectVariant {
    fn eq(&self, other: &Self) -> bool {
        self.kind.name == other.kind.name && self.choice == other.choice
    }
}

impl fmt::Debug for EffectVariant {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.name())
    }
}
