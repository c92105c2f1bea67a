//! Laws of joints in place of sharp edges: a bed of springs and its rivals.

use super::entry::{EffectChoice, EffectEntry, EffectParameter, Lanes, Place, Quantity, Role};
use super::sums::SaidOfJoint;

const JOINT: EffectChoice = EffectChoice {
    key: "joint",
    // In the order of [`super::JOINTS`], and both.
    options: &["ground", "crack", "both"],
    meaning: "the joint that gives",
};

const STIFFNESS: EffectParameter = EffectParameter {
    key: "stiffness_pa_per_m",
    quantity: Quantity::BedStiffness,
    neutral: SHARP_PA_PER_M,
    optional: false,
    least: 1e6,
    most: SHARP_PA_PER_M,
    example: 1e9,
    meaning: "pressure per indentation; the largest value is a sharp edge",
};

const fn damping(meaning: &'static str) -> EffectParameter {
    EffectParameter {
        key: "damping_s",
        quantity: Quantity::Time,
        neutral: 0.0,
        optional: true,
        least: 0.0,
        most: 1.0,
        example: 4e-4,
        meaning,
    }
}

/// A rotation across a joint, rad.
const fn rotation(key: &'static str, example: f64, meaning: &'static str) -> EffectParameter {
    EffectParameter {
        key,
        quantity: Quantity::JointRotation,
        neutral: 0.0,
        optional: false,
        least: 0.0,
        most: 1.0,
        example,
        meaning,
    }
}

/// Stiffness of a bed that counts as a sharp edge, Pa/m: a wall of some metres is in whole contact within
/// 1e-7 rad of rest on it.
pub(in crate::model) const SHARP_PA_PER_M: f64 = 1e13;

/// Strength of a bed that does not crush, Pa: a thousand times that of the best brick.
const NEVER_CRUSHES_PA: f64 = 1e11;

pub(super) static COMPLIANT_JOINT: EffectEntry = EffectEntry {
    name: "compliant_joint",
    place: Place::Joint,
    role: Role::Bed,
    lanes: Lanes::Known,
    choice: Some(JOINT),
    parameters: &[
        STIFFNESS,
        damping("time ζ of dampers beside the springs, a pressure k (δ + ζ δ'); left out: none"),
    ],
    may_repeat: true,
    law: "M = k L b³ φ/12 up to φ_c = 2 N/(k L b²), then N (b/2 - c/3) sign φ with c = sqrt(2 N/(k L |φ|))",
    description: "A joint that gives: a bed of springs without tension in place of a sharp edge. The body turns \
                  about the middle of the zone of contact, whose width falls as the joint opens. Soft beds take \
                  the impacts away: mortar, worn or crushed edges.",
    fingerprint: "moment of the weight that grows with the opening of the joint, slower the softer it is",
    at_impacts: "the share of the impact that the bed is too stiff to carry; none where it is soft",
    confused_with: &[
        "trilinear_joint",
        "crushing_joint",
        "rounded_edges",
        "corner_indentation",
        "impact_dissipation",
        "joint_damping",
    ],
    told_by: "pushing the wall slowly from rest: force against displacement, before the joint is open",
    add: |effect, sums| {
        let [stiffness_pa_per_m, damping_s] = [effect.value(0), effect.value(1)];
        let acts = stiffness_pa_per_m < SHARP_PA_PER_M;
        sums.say_of_joints(effect, acts.then_some(SaidOfJoint::Bed { stiffness_pa_per_m, damping_s }));
    },
};

pub(super) static TRILINEAR_JOINT: EffectEntry = EffectEntry {
    name: "trilinear_joint",
    place: Place::Joint,
    role: Role::JointLaw,
    lanes: Lanes::Unknown,
    choice: Some(JOINT),
    parameters: &[
        EffectParameter {
            key: "plateau",
            quantity: Quantity::MomentShare,
            neutral: 1.0,
            optional: false,
            least: 0.01,
            most: 1.0,
            example: 0.7,
            meaning: "share τ_1 of the moment of sharp edges that the first line reaches",
        },
        rotation("first_rotation_rad", 0.002, "rotation φ_1 across the joint where the first line ends"),
        rotation(
            "last_rotation_rad",
            0.02,
            "rotation φ_2 from which the joint carries the moment of sharp edges",
        ),
        damping("time ζ of a damper, a moment ζ dM/dφ φ'; left out: none"),
    ],
    may_repeat: true,
    law: "M = N b/2 times τ_1 |φ|/φ_1, then straight to 1 at φ_2, then 1, sign φ",
    description: "A joint whose moment follows three lines, as pushes of walls were drawn by Doherty and others (2002): \
                  first stiffness, a plateau below the moment of sharp edges, the line of rigid bodies. The body turns \
                  about the point that carries the load; no spring stores energy.",
    fingerprint: "moment of the weight in straight pieces of the opening of the joint",
    at_impacts: "as a bed that is as stiff at first, on edges at the end of the first line",
    confused_with: &["compliant_joint", "crushing_joint", "rounded_edges", "corner_indentation"],
    told_by: "pushing the wall slowly from rest as far as it comes back from",
    add: |effect, sums| {
        let [plateau, first_rad, last_rad, damping_s] = [0, 1, 2, 3].map(|i| effect.value(i));
        let acts = plateau < 1.0 || first_rad > 0.0;
        let lines = SaidOfJoint::Trilinear { plateau, first_rad, last_rad, damping_s };
        sums.say_of_joints(effect, acts.then_some(lines));
    },
};

pub(super) static CRUSHING_JOINT: EffectEntry = EffectEntry {
    name: "crushing_joint",
    place: Place::Joint,
    role: Role::JointLaw,
    lanes: Lanes::Unknown,
    choice: Some(JOINT),
    parameters: &[
        STIFFNESS,
        EffectParameter {
            key: "compressive_strength_pa",
            quantity: Quantity::Strength,
            neutral: NEVER_CRUSHES_PA,
            optional: false,
            least: 1e3,
            most: NEVER_CRUSHES_PA,
            example: 1e6,
            meaning: "f: the bed bears 0.85 f; the largest value is an elastic bed",
        },
        damping("time ζ of dampers beside the springs; left out: none"),
    ],
    may_repeat: true,
    law: "M as compliant_joint up to φ_s = (0.85 f)² L/(2 k N), then N (b/2 - A/2 - A q²/6), A = N/(0.85 f L), q = φ_s/φ",
    description: "A bed of springs without tension that crushes at the stress of the paper's block, 0.85 f. What the \
                  largest rotation to a side has crushed is gone: on the way back the joint is an elastic bed on the \
                  width that is left, and so it stays. New at the start of a run.",
    fingerprint: "moment of the weight that grows with the opening of the joint, less on the way back than on the first way out",
    at_impacts: "the share of the impact that the bed is too stiff to carry; none where it is soft",
    confused_with: &["compliant_joint", "trilinear_joint", "corner_indentation", "joint_damping"],
    told_by: "pushing the wall slowly far out and back: the way back lies below",
    add: |effect, sums| {
        let [stiffness_pa_per_m, strength_pa, damping_s] = [0, 1, 2].map(|i| effect.value(i));
        let acts = stiffness_pa_per_m < SHARP_PA_PER_M || strength_pa < NEVER_CRUSHES_PA;
        let bed = SaidOfJoint::Crushing { stiffness_pa_per_m, strength_pa, damping_s };
        sums.say_of_joints(effect, acts.then_some(bed));
    },
};

pub(super) static ROUNDED_EDGES: EffectEntry = EffectEntry {
    name: "rounded_edges",
    place: Place::Joint,
    role: Role::JointLaw,
    lanes: Lanes::Unknown,
    choice: Some(JOINT),
    parameters: &[
        EffectParameter {
            key: "worn_width_m",
            quantity: Quantity::CornerWidth,
            neutral: 0.0,
            optional: false,
            least: 0.0,
            most: 10.0,
            example: 0.03,
            meaning: "width a at either side over which the edge is worn",
        },
        EffectParameter {
            key: "radius_m",
            quantity: Quantity::EdgeRadius,
            neutral: 0.0,
            optional: false,
            least: 0.0,
            most: 1e6,
            example: 0.6,
            meaning: "radius R of the arc it is worn to",
        },
    ],
    may_repeat: true,
    law: "M = N (b/2 - a + R sin |φ|) sign φ up to sin φ_e = a/R, then N b/2; closed up to N (b/2 - a)",
    description: "Edges that are worn round: the body stands on the flat between them, opens about its ends, rolls on \
                  the arcs without sliding and comes to the edges of the full width. Nothing but the weight stores \
                  energy.",
    fingerprint: "moment of the weight that grows in proportion to the opening of the joint, from a step on",
    at_impacts: "those of sharp edges at the ends of the flat",
    confused_with: &["corner_indentation", "compliant_joint", "trilinear_joint", "impact_dissipation"],
    told_by: "looking at the edges, and pushing the wall slowly until the joint opens and beyond",
    add: |effect, sums| {
        let [worn_width_m, radius_m] = [effect.value(0), effect.value(1)];
        let acts = worn_width_m > 0.0;
        sums.say_of_joints(effect, acts.then_some(SaidOfJoint::Rounded { worn_width_m, radius_m }));
    },
};
