//! Effects in the motion of the ground.

use super::catalogue::{EffectKind, EffectParameter, Place};

pub(super) const KINDS: [EffectKind; 3] = [
    EffectKind {
        name: "vertical_ground_motion",
        place: Place::GroundMotion,
        choice: None,
        parameters: &[EffectParameter {
            key: "ratio",
            unit: "",
            least: -5.0,
            most: 5.0,
            example: 0.1,
            meaning: "vertical over horizontal ground acceleration",
        }],
        may_repeat: true,
        law: "ÿ_g + r ẍ_g in place of ÿ_g",
        description: "A share of the horizontal record that shakes the ground upwards too, such as a table that pitches; \
                      it adds to a vertical record.",
        fingerprint: "ground acceleration times the weight's arm, its sign by pattern",
        at_impacts: "none",
        confused_with: &[],
        told_by: "an accelerometer on the base, upwards",
        add: |effect, sums| sums.ground.vertical_ratio += effect.value(0),
    },
    EffectKind {
        name: "record_gain",
        place: Place::GroundMotion,
        choice: None,
        parameters: &[EffectParameter {
            key: "gain",
            unit: "",
            least: -10.0,
            most: 10.0,
            example: 1.05,
            meaning: "true over recorded ground acceleration, horizontal and vertical",
        }],
        may_repeat: true,
        law: "g ẍ_g in place of ẍ_g",
        description: "A ground motion larger or smaller than its record, as of a sensor out of calibration.",
        fingerprint: "ground acceleration",
        at_impacts: "none but their timing",
        confused_with: &["record_lag", "carriage_mass"],
        told_by: "a second accelerometer on the base",
        add: |effect, sums| sums.ground.gain *= effect.value(0),
    },
    EffectKind {
        name: "record_lag",
        place: Place::GroundMotion,
        choice: None,
        parameters: &[EffectParameter {
            key: "lag_s",
            unit: "s",
            least: -60.0,
            most: 60.0,
            example: 0.01,
            meaning: "how much later than recorded the ground moves; negative: earlier",
        }],
        may_repeat: true,
        law: "ẍ_g(t - t_l) in place of ẍ_g(t)",
        description: "A clock of the record that does not run with the clock of the measured rotations. Before a record \
                      that comes later the ground rises from rest within one step.",
        fingerprint: "derivative of the ground acceleration",
        at_impacts: "timing of all impacts",
        confused_with: &["record_gain"],
        told_by: "a pulse that the accelerometer and the rotation sensors both see at once",
        add: |effect, sums| sums.ground.lag_s += effect.value(0),
    },
];
