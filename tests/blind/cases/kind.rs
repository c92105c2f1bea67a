//! What a case may hide, and in how many of the cases.

/// What is hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Nothing: the wall file is the wall, up to the scatter of its prior.
    Nothing,
    /// One effect of the catalogue.
    One(&'static str),
    /// Two effects at once.
    Pair(&'static str, &'static str),
    /// A law that no catalogue entry describes.
    Outside(&'static str),
    /// A law drawn as a formula, of this group.
    Law(&'static str),
    /// The paper's own case, the carriage lumped into the top mass; k_d known, k_d free, k_d and C_l free.
    Lumped(Freedom),
}

/// What is free in the paper's case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Freedom {
    Nothing,
    Stiffness,
    StiffnessAndImpacts,
}

/// The catalogue.
pub const CATALOGUE: [&str; 15] = [
    "carriage_mass",
    "viscous_damping",
    "coulomb_friction",
    "cubic_stiffness",
    "gap",
    "one_sided_spring",
    "yielding_spring",
    "corner_indentation",
    "impact_dissipation",
    "joint_damping",
    "vertical_ground_motion",
    "record_gain",
    "record_lag",
    "sensor_gain",
    "sensor_offset",
];

/// Laws outside the catalogue.
pub const OUTSIDE: [&str; 6] = [
    "one_sided_stop",
    "quadratic_drag",
    "saturating_spring",
    "loose_mass",
    "degrading_spring",
    "displacement_damping",
];

/// Pairs at different places or of different shape, so that both can be told.
pub const PAIRS: [(&str, &str); 8] = [
    ("carriage_mass", "viscous_damping"),
    ("viscous_damping", "impact_dissipation"),
    ("carriage_mass", "record_gain"),
    ("cubic_stiffness", "coulomb_friction"),
    ("corner_indentation", "viscous_damping"),
    ("gap", "impact_dissipation"),
    ("joint_damping", "carriage_mass"),
    ("sensor_gain", "cubic_stiffness"),
];

impl Kind {
    /// Name in tables.
    pub fn name(self) -> String {
        match self {
            Kind::Nothing => "nothing".into(),
            Kind::One(effect) => effect.into(),
            Kind::Pair(a, b) => format!("{a} + {b}"),
            Kind::Outside(law) => format!("outside: {law}"),
            Kind::Law(group) => group.into(),
            Kind::Lumped(Freedom::Nothing) => "lumped carriage, k_d known".into(),
            Kind::Lumped(Freedom::Stiffness) => "lumped carriage, k_d free".into(),
            Kind::Lumped(Freedom::StiffnessAndImpacts) => "lumped carriage, k_d and C_l free".into(),
        }
    }

    /// Name of the cases that share out noise, size and simulator among them.
    pub fn group(self) -> String {
        match self {
            Kind::Pair(..) => "two effects".into(),
            Kind::Outside(_) => "another law".into(),
            _ => self.name(),
        }
    }

    /// The effects of the catalogue that are hidden.
    pub fn effects(self) -> Vec<&'static str> {
        match self {
            Kind::Nothing | Kind::Outside(_) | Kind::Law(_) => vec![],
            Kind::One(effect) => vec![effect],
            Kind::Pair(a, b) => vec![a, b],
            Kind::Lumped(_) => vec!["carriage_mass"],
        }
    }

    /// The kind of a case from a number in [0, 1): of 770 cases, 200 hide nothing and 30 each effect, but for the
    /// luck of the draw.
    pub fn at(share: f64) -> Self {
        let mut place = share * 770.0;
        let mut within = |cases: f64| {
            place -= cases;
            // Which of the kinds of this group, as a number in [0, 1).
            (place < 0.0).then(|| 1.0 + place / cases)
        };
        let pick = |share: f64, count: usize| ((share * count as f64) as usize).min(count - 1);
        if within(200.0).is_some() {
            Kind::Nothing
        } else if let Some(share) = within(450.0) {
            Kind::One(CATALOGUE[pick(share, CATALOGUE.len())])
        } else if let Some(share) = within(40.0) {
            let (a, b) = PAIRS[pick(share, PAIRS.len())];
            Kind::Pair(a, b)
        } else if let Some(share) = within(50.0) {
            Kind::Outside(OUTSIDE[pick(share, OUTSIDE.len())])
        } else {
            let share = within(30.0).unwrap_or(0.0);
            Kind::Lumped([Freedom::Nothing, Freedom::Stiffness, Freedom::StiffnessAndImpacts][pick(share, 3)])
        }
    }
}
