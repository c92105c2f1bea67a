//! Effects at the joints.

use super::catalogue::{EffectChoice, EffectKind, EffectParameter, Place};

/// In the order of [`super::super::Joint`].
const JOINT: EffectChoice =
    EffectChoice { key: "joint", options: &["ground", "crack"], meaning: "the joint at which it acts" };

pub(super) const KINDS: [EffectKind; 2] = [
    EffectKind {
        name: "joint_damping",
        place: Place::Joint,
        choice: Some(JOINT),
        parameters: &[EffectParameter {
            key: "coefficient_n_m_s_per_rad",
            unit: "N m s/rad",
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
    },
    EffectKind {
        name: "corner_indentation",
        place: Place::Joint,
        choice: Some(JOINT),
        parameters: &[EffectParameter {
            key: "depth_m",
            unit: "m",
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
    },
];
