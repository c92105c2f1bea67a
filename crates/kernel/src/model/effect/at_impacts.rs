//! Effects at impacts.

use super::catalogue::{EffectKind, EffectParameter, Place};

const fn factor(key: &'static str, meaning: &'static str) -> EffectParameter {
    EffectParameter { key, unit: "", least: 0.0, most: 2.0, example: 0.9, meaning }
}

pub(super) const KINDS: [EffectKind; 1] = [EffectKind {
    name: "impact_dissipation",
    place: Place::Impacts,
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
}];
