//! The catalogue: one line a kind, from which the kinds, their order and their entries follow.

use std::fmt;

use serde::{Serialize, Serializer};

use super::super::contact::Joint;
use super::entry::{EffectChoice, EffectEntry, EffectParameter, Place};
use super::{Effect, EffectError, MOST_PARAMETERS, joint, signal, structural};

/// Declares the kinds: the enumeration, the list of all and the entry of each. A kind cannot be in one and
/// not in another.
macro_rules! catalogue {
    ($($kind:ident => $entry:path,)+) => {
        /// A kind of effect.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum EffectKind {
            $(#[doc = concat!("[`Effect`] by the entry `", stringify!($entry), "`.")] $kind,)+
        }

        impl EffectKind {
            /// Every kind, by place.
            pub const ALL: &[EffectKind] = &[$(EffectKind::$kind),+];

            /// What the catalogue says of it.
            pub fn entry(self) -> &'static EffectEntry {
                match self {
                    $(EffectKind::$kind => &$entry,)+
                }
            }
        }

        // No kind has more numbers than an effect has room for.
        $(const _: () = assert!($entry.parameters.len() <= MOST_PARAMETERS);)+
    };
}

catalogue! {
    CarriageMass => structural::CARRIAGE_MASS,
    ViscousDamping => structural::VISCOUS_DAMPING,
    CoulombFriction => structural::COULOMB_FRICTION,
    CubicStiffness => structural::CUBIC_STIFFNESS,
    Gap => structural::GAP,
    OneSidedSpring => structural::ONE_SIDED_SPRING,
    YieldingSpring => structural::YIELDING_SPRING,
    JointDamping => structural::JOINT_DAMPING,
    CornerIndentation => structural::CORNER_INDENTATION,
    CompliantJoint => joint::COMPLIANT_JOINT,
    TrilinearJoint => joint::TRILINEAR_JOINT,
    CrushingJoint => joint::CRUSHING_JOINT,
    RoundedEdges => joint::ROUNDED_EDGES,
    ImpactDissipation => structural::IMPACT_DISSIPATION,
    ImpactFading => structural::IMPACT_FADING,
    VerticalGroundMotion => signal::VERTICAL_GROUND_MOTION,
    RecordGain => signal::RECORD_GAIN,
    RecordLag => signal::RECORD_LAG,
    SensorGain => signal::SENSOR_GAIN,
    SensorOffset => signal::SENSOR_OFFSET,
}

/// The joints in the order of the words that choose one.
static JOINTS: [Joint; 2] = [Joint::Ground, Joint::Crack];

/// A kind of effect with the word it takes chosen: what can be tried as one hypothesis.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct EffectVariant {
    /// The kind.
    pub kind: EffectKind,
    /// The word, for kinds that take one.
    pub choice: Option<&'static str>,
}

/// As the name in wall files.
impl Serialize for EffectKind {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl EffectKind {
    /// Its name in wall files.
    pub fn name(self) -> &'static str {
        self.entry().name
    }

    /// The kind of this name.
    ///
    /// # Errors
    /// [`EffectError::UnknownKind`], with the names there are.
    pub fn named(name: &str) -> Result<Self, EffectError> {
        let found = Self::ALL.iter().find(|kind| kind.name() == name);
        found.copied().ok_or_else(|| EffectError::UnknownKind { found: name.to_owned() })
    }

    /// The kind with each word it may take; one variant for a kind without a choice.
    pub fn variants(self) -> impl Iterator<Item = EffectVariant> {
        let options: &[&str] = self.entry().choice.as_ref().map_or(&[], |choice| choice.options);
        let plain = options.is_empty().then_some(None);
        plain
            .into_iter()
            .chain(options.iter().copied().map(Some))
            .map(move |choice| EffectVariant { kind: self, choice })
    }

    /// The variant with this word.
    ///
    /// # Errors
    /// A word that there is not, or `None` where there is one to choose.
    pub fn variant(self, choice: Option<&str>) -> Result<EffectVariant, EffectError> {
        if let Some(variant) = self.variants().find(|variant| variant.choice == choice) {
            return Ok(variant);
        }
        let kind = self.name();
        let found = choice.map_or("nothing".to_owned(), |word| format!("`{word}`"));
        Err(match self.entry().choice {
            Some(EffectChoice { key, options, .. }) => EffectError::Choice { kind, key, found, options },
            None => EffectError::Keys { kind, found, allowed: "no choice: there is none".to_owned() },
        })
    }
}

impl EffectVariant {
    /// What the catalogue says of its kind.
    pub fn entry(self) -> &'static EffectEntry {
        self.kind.entry()
    }

    /// `kind`, or `kind.choice`: what [`Effect::with_parameters`] takes.
    pub fn name(self) -> String {
        match self.choice {
            Some(choice) => format!("{}.{choice}", self.kind.name()),
            None => self.kind.name().to_owned(),
        }
    }

    /// Position of the word among the options of the kind; 0 for a kind without a choice.
    pub(super) fn choice_index(self) -> usize {
        let position = |choice: &EffectChoice| choice.options.iter().position(|o| Some(*o) == self.choice);
        self.entry().choice.as_ref().and_then(position).unwrap_or(0)
    }

    /// The joint at which it acts; `None` for what acts at both or at none.
    pub fn joint(self) -> Option<Joint> {
        match self.joints() {
            [joint] => Some(*joint),
            _ => None,
        }
    }

    /// The joints at which it acts: of a word beyond the names of joints, all.
    pub fn joints(self) -> &'static [Joint] {
        match (self.entry().place, self.choice_index()) {
            (Place::Joint, i) if i < JOINTS.len() => &JOINTS[i..=i],
            (Place::Joint, _) => &JOINTS,
            (Place::Top | Place::Impacts | Place::GroundMotion | Place::Sensor, _) => &[],
        }
    }

    /// The effect with these values of its parameters, in the order of [`EffectEntry::parameters`].
    ///
    /// # Errors
    /// Not as many values as parameters; a value outside its bounds.
    pub fn with_parameters(self, values: &[f64]) -> Result<Effect, EffectError> {
        let EffectEntry { name: kind, parameters, .. } = *self.entry();
        if values.len() != parameters.len() {
            let found = format!("{} values", values.len());
            return Err(EffectError::Keys { kind, found, allowed: parameters.len().to_string() });
        }
        let mut all = [0.0; MOST_PARAMETERS];
        for (i, (&value, allowed)) in values.iter().zip(parameters).enumerate() {
            // A NaN is within no bounds.
            if !(allowed.least..=allowed.most).contains(&value) {
                return Err(EffectError::Bounds { kind, key: allowed.key, value, allowed });
            }
            all[i] = value;
        }
        Ok(Effect { variant: self, values: all })
    }

    /// The effect with the example values of the catalogue.
    pub fn example(self) -> Effect {
        self.with_each(|parameter| parameter.example)
    }

    /// The effect with the values at which it does nothing.
    pub fn neutral(self) -> Effect {
        self.with_each(|parameter| parameter.neutral)
    }

    fn with_each(self, value: impl Fn(&EffectParameter) -> f64) -> Effect {
        let mut values = [0.0; MOST_PARAMETERS];
        values.iter_mut().zip(self.entry().parameters).for_each(|(own, parameter)| *own = value(parameter));
        Effect { variant: self, values }
    }
}

impl fmt::Debug for EffectVariant {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.name())
    }
}
