//! Effects in the wall: at its top C, at its joints and at impacts.

use super::entry::{EffectChoice, EffectEntry, EffectParameter, Lanes, Place, Quantity, Role};
use super::sums::Yielding;

/// In the order of [`super::JOINTS`].
const JOINT: EffectChoice =
    EffectChoice { key: "joint", options: &["ground", "crack"], meaning: "the joint at which it acts" };

const fn factor(key: &'static str, meaning: &'static str) -> EffectParameter {
    EffectParameter {
        key,
        quantity: Quantity::ImpactFactor,
        neutral: 1.0,
        optional: false,
        least: 0.0,
        most: 2.0,
        example: 0.9,
        meaning,
    }
}

pub(super) static CARRIAGE_MASS: EffectEntry = EffectEntry {
    name: "carriage_mass",
    place: Place::Top,
    role: Role::Mass,
    lanes: Lanes::Known,
    choice: None,
    parameters: &[EffectParameter {
        key: "mass_kg",
        quantity: Quantity::TopMass,
        neutral: 0.0,
        optional: false,
        least: 0.0,
        most: 1e12,
        example: 120.0,
        meaning: "mass added to m_dp",
    }],
    may_repeat: true,
    law: "F = -m (ẍ_C + ẍ_g)",
    description: "A mass at the top that moves with it sideways and rests on something else: the carriage of a \
                  shaking table, a floor that spans parallel to the wall.",
    fingerprint: "absolute acceleration of C",
    at_impacts: "counts in the horizontal momentum of the top",
    confused_with: &["diaphragm.stiffness_n_per_m", "diaphragm.mass_kg", "impact_dissipation"],
    told_by: "weighing what moves sideways with the top but does not load it",
    add: |effect, sums| sums.carriage_mass_kg += effect.value(0),
};

pub(super) static VISCOUS_DAMPING: EffectEntry = EffectEntry {
    name: "viscous_damping",
    place: Place::Top,
    role: Role::Damper,
    lanes: Lanes::Known,
    choice: None,
    parameters: &[EffectParameter {
        key: "coefficient_n_s_per_m",
        quantity: Quantity::TopDamping,
        neutral: 0.0,
        optional: false,
        least: 0.0,
        most: 1e12,
        example: 1500.0,
        meaning: "force per velocity of the top",
    }],
    may_repeat: true,
    law: "F = -c ẋ_C",
    description: "A force against the velocity of the top and in proportion to it, as of a fluid damper.",
    fingerprint: "velocity of C",
    at_impacts: "none",
    confused_with: &["coulomb_friction", "yielding_spring"],
    told_by: "pulling the top at several steady speeds",
    add: |effect, sums| sums.viscous_n_s_per_m += effect.value(0),
};

pub(super) static COULOMB_FRICTION: EffectEntry = EffectEntry {
    name: "coulomb_friction",
    place: Place::Top,
    role: Role::Friction,
    lanes: Lanes::WhileSliding,
    choice: None,
    parameters: &[EffectParameter {
        key: "force_n",
        quantity: Quantity::TopForce,
        neutral: 0.0,
        optional: false,
        least: 0.0,
        most: 1e9,
        example: 300.0,
        meaning: "friction force F_c while the top slides, and the most it can hold while it sticks",
    }],
    may_repeat: true,
    law: "F = -F_c sign(ẋ_C); at ẋ_C = 0 whatever within ±F_c keeps it so",
    description: "Dry friction of constant force between the top and what it leans on, such as guides or bearings. \
                  The top sticks where the friction can hold it; it helps a wall at rest to stay there.",
    fingerprint: "sign of the velocity of C, with a step where it turns back",
    at_impacts: "none: a bounded force has no impulse",
    confused_with: &["viscous_damping", "yielding_spring"],
    told_by: "pulling the top slowly to and fro: the force jumps where it turns",
    add: |effect, sums| sums.friction_n += effect.value(0),
};

pub(super) static CUBIC_STIFFNESS: EffectEntry = EffectEntry {
    name: "cubic_stiffness",
    place: Place::Top,
    role: Role::Spring,
    lanes: Lanes::Known,
    choice: None,
    parameters: &[EffectParameter {
        key: "coefficient_n_per_m3",
        quantity: Quantity::TopCubicStiffness,
        neutral: 0.0,
        optional: false,
        least: -1e15,
        most: 1e15,
        example: 4e6,
        meaning: "force per cube of the displacement; negative softens",
    }],
    may_repeat: true,
    law: "F = -k_3 x_C³",
    description: "A spring at the top that hardens, or softens, the further it is displaced.",
    fingerprint: "cube of the displacement of C",
    at_impacts: "none",
    confused_with: &["diaphragm.stiffness_n_per_m", "gap"],
    told_by: "pulling the top slowly as far as the tests went, both ways",
    add: |effect, sums| sums.cubic_n_per_m3 += effect.value(0),
};

pub(super) static GAP: EffectEntry = EffectEntry {
    name: "gap",
    place: Place::Top,
    role: Role::Spring,
    lanes: Lanes::Known,
    choice: None,
    parameters: &[EffectParameter {
        key: "half_width_m",
        quantity: Quantity::TopDisplacement,
        neutral: 0.0,
        optional: false,
        least: 0.0,
        most: 10.0,
        example: 0.002,
        meaning: "displacement to either side at which the floor's spring k_d begins to act",
    }],
    may_repeat: false,
    law: "F = -k_d (x_C ∓ g) beyond ±g, nothing between",
    description: "Slack in the connection to the floor: its spring k_d does nothing until the slack is taken up.",
    fingerprint: "displacement of C with a dead zone around zero",
    at_impacts: "none",
    confused_with: &["diaphragm.stiffness_n_per_m", "cubic_stiffness", "sensor_offset"],
    told_by: "pulling the top slowly through its rest, both ways",
    add: |effect, sums| sums.gap_half_width_m = effect.value(0),
};

pub(super) static ONE_SIDED_SPRING: EffectEntry = EffectEntry {
    name: "one_sided_spring",
    place: Place::Top,
    role: Role::Spring,
    lanes: Lanes::Known,
    choice: Some(EffectChoice {
        key: "side",
        // In the order of `EffectSums::one_sided_n_per_m`.
        options: &["negative", "positive"],
        meaning: "sign of the displacements of the top at which it acts",
    }),
    parameters: &[EffectParameter {
        key: "stiffness_n_per_m",
        quantity: Quantity::TopStiffness,
        neutral: 0.0,
        optional: false,
        least: 0.0,
        most: 1e12,
        example: 8000.0,
        meaning: "force per displacement on that side",
    }],
    may_repeat: true,
    law: "F = -k x_C on one side of x_C = 0, nothing on the other",
    description: "A further spring that pushes but does not pull, or pulls but does not push: a wall leaning on its \
                  neighbour, a tie.",
    fingerprint: "displacement of C of one sign only",
    at_impacts: "none",
    confused_with: &["diaphragm.stiffness_n_per_m", "sensor_offset"],
    told_by: "pulling the top slowly, both ways",
    add: |effect, sums| sums.one_sided_n_per_m[effect.choice_index()] += effect.value(0),
};

pub(super) static YIELDING_SPRING: EffectEntry = EffectEntry {
    name: "yielding_spring",
    place: Place::Top,
    role: Role::Memory,
    lanes: Lanes::Known,
    choice: None,
    parameters: &[
        EffectParameter {
            key: "stiffness_n_per_m",
            quantity: Quantity::TopStiffness,
            neutral: 0.0,
            optional: false,
            least: 0.0,
            most: 1e12,
            example: 60_000.0,
            meaning: "force per displacement while elastic",
        },
        EffectParameter {
            key: "yield_force_n",
            quantity: Quantity::TopForce,
            neutral: 0.0,
            optional: false,
            least: 0.0,
            most: 1e9,
            example: 400.0,
            meaning: "most the spring can pull or push",
        },
    ],
    may_repeat: false,
    law: "F = -k (x_C - x_p) within ±F_y, beyond which the plastic displacement x_p follows",
    description: "A further spring at the top, elastic up to a force at which it yields without hardening and keeps \
                  what it has yielded: a steel tie, a nailed connection. New at the start of a run.",
    fingerprint: "loop of force against displacement of C, with memory",
    at_impacts: "none",
    confused_with: &["coulomb_friction", "viscous_damping", "diaphragm.stiffness_n_per_m"],
    told_by: "pulling the top slowly there and back: what yields does not come back on its own path",
    add: |effect, sums| {
        let [stiffness_n_per_m, force_n] = [effect.value(0), effect.value(1)];
        let acts = stiffness_n_per_m > 0.0 && force_n > 0.0;
        sums.yielding = acts.then_some(Yielding { stiffness_n_per_m, force_n });
    },
};

pub(super) static JOINT_DAMPING: EffectEntry = EffectEntry {
    name: "joint_damping",
    place: Place::Joint,
    role: Role::Damper,
    lanes: Lanes::Known,
    choice: Some(JOINT),
    parameters: &[EffectParameter {
        key: "coefficient_n_m_s_per_rad",
        quantity: Quantity::JointDamping,
        neutral: 0.0,
        optional: false,
        least: 0.0,
        most: 1e15,
        example: 2000.0,
        meaning: "moment per rate at which the joint opens or closes",
    }],
    may_repeat: true,
    law: "M = -c φ̇, φ = θ_1 at the ground, θ_2 - θ_1 at the crack",
    description: "A moment against the opening and closing of a joint, in proportion to its rate.",
    fingerprint: "rate of opening of the joint, on the joint's own moment",
    at_impacts: "none",
    confused_with: &["impact_dissipation"],
    told_by: "letting the wall rock freely with the top unheld",
    add: |effect, sums| sums.joint_damping_n_m_s[effect.choice_index()] += effect.value(0),
};

pub(super) static CORNER_INDENTATION: EffectEntry = EffectEntry {
    name: "corner_indentation",
    place: Place::Joint,
    role: Role::Corners,
    lanes: Lanes::Known,
    choice: Some(JOINT),
    parameters: &[EffectParameter {
        key: "depth_m",
        quantity: Quantity::CornerWidth,
        neutral: 0.0,
        optional: false,
        least: 0.0,
        most: 10.0,
        example: 0.008,
        meaning: "how much smaller the width b_i between the two rocking corners is",
    }],
    may_repeat: true,
    law: "b_i - d in place of b_i",
    description: "Rocking corners that lie further inside than the wall file says, worn or crushed: half the depth \
                  at each corner.",
    fingerprint: "weight times width: constant within a pattern, its sign that of the corner",
    at_impacts: "changes the lever arms of the impulses",
    confused_with: &["diaphragm.mass_kg", "corner_indentation"],
    told_by: "pushing the wall statically until the joint opens, which gives the lever of its weight",
    add: |effect, sums| sums.indentation_m[effect.choice_index()] += effect.value(0),
};

pub(super) static IMPACT_DISSIPATION: EffectEntry = EffectEntry {
    name: "impact_dissipation",
    place: Place::Impacts,
    role: Role::Impact,
    lanes: Lanes::Known,
    choice: None,
    parameters: &[
        factor("factors.0", "factor on C_1 (1a to 2a)"),
        factor("factors.1", "factor on C_2 (2a to 1a)"),
        factor("factors.2", "factor on C_3 (1a to 2b)"),
        factor("factors.3", "factor on C_4 (2a to 1b)"),
        factor("factors.4", "factor on C_5 (3a to 1b)"),
        factor("factors.5", "factor on C_6 (3a to 3b)"),
        factor("factors.6", "factor on C_7 (1a to 3a)"),
        factor("factors.7", "factor on C_8 (2a to 3a)"),
    ],
    may_repeat: true,
    law: "C_l f_l in place of C_l",
    description: "Impacts that keep less, or more, of the velocity than the coefficients of the wall file say.",
    fingerprint: "none between impacts",
    at_impacts: "ratio of the velocities after and before, by change of pattern",
    confused_with: &["joint_damping", "corner_indentation", "carriage_mass"],
    told_by: "letting the wall rock freely with the top unheld, from impact to impact",
    add: |effect, sums| {
        sums.impact_factors.iter_mut().enumerate().for_each(|(l, factor)| *factor *= effect.value(l));
    },
};

pub(super) static IMPACT_FADING: EffectEntry = EffectEntry {
    name: "impact_fading",
    place: Place::Impacts,
    role: Role::ImpactSpeed,
    lanes: Lanes::Known,
    choice: None,
    parameters: &[EffectParameter {
        key: "fading_s_per_m",
        quantity: Quantity::ImpactFading,
        neutral: 0.0,
        optional: false,
        least: 0.0,
        most: 100.0,
        example: 2.0,
        meaning: "b: slow impacts keep a share b u less at a speed u",
    }],
    may_repeat: true,
    law: "C_l exp(-b u) in place of C_l, u = b_i |φ̇| the speed at which the edge of the closing joint comes down",
    description: "Impacts that keep the less the faster they are, as where edges crush.",
    fingerprint: "none between impacts",
    at_impacts: "ratio of the velocities after and before, smaller at larger speeds",
    confused_with: &["impact_dissipation", "joint_damping", "viscous_damping"],
    told_by: "free rocking from a large and from a small rotation, from impact to impact",
    add: |effect, sums| sums.impact_fading_s_per_m += effect.value(0),
};
