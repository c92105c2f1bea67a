//! Effects in the signals: the recorded ground motion, and the reading of the rotations.

use super::entry::{EffectChoice, EffectEntry, EffectParameter, Lanes, Place, Quantity, Role};
use super::{Effect, EffectSums};

const BODY: EffectChoice = EffectChoice {
    key: "body",
    options: &["lower", "upper", "both"],
    meaning: "the body whose rotation is read so: θ_1, θ_2 or both",
};

/// Changes the numbers of the bodies that are read so.
fn each_read(effect: &Effect, of_bodies: &mut [f64; 2], change: impl Fn(&mut f64)) {
    let read = effect.choice_index();
    of_bodies
        .iter_mut()
        .enumerate()
        .filter(|(body, _)| *body == read || read == 2)
        .for_each(|(_, x)| change(x));
}

fn gain(effect: &Effect, sums: &mut EffectSums) {
    each_read(effect, &mut sums.reading.gain, |gain| *gain *= effect.value(0));
}

fn offset(effect: &Effect, sums: &mut EffectSums) {
    each_read(effect, &mut sums.reading.offset_rad, |offset| *offset += effect.value(0));
}

pub(super) static VERTICAL_GROUND_MOTION: EffectEntry = EffectEntry {
    name: "vertical_ground_motion",
    place: Place::GroundMotion,
    role: Role::GroundMotion,
    lanes: Lanes::Known,
    choice: None,
    parameters: &[EffectParameter {
        key: "ratio",
        quantity: Quantity::Ratio,
        neutral: 0.0,
        optional: false,
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
};

pub(super) static RECORD_GAIN: EffectEntry = EffectEntry {
    name: "record_gain",
    place: Place::GroundMotion,
    role: Role::GroundMotion,
    lanes: Lanes::Known,
    choice: None,
    parameters: &[EffectParameter {
        key: "gain",
        quantity: Quantity::Ratio,
        neutral: 1.0,
        optional: false,
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
};

pub(super) static RECORD_LAG: EffectEntry = EffectEntry {
    name: "record_lag",
    place: Place::GroundMotion,
    role: Role::GroundMotion,
    lanes: Lanes::Known,
    choice: None,
    parameters: &[EffectParameter {
        key: "lag_s",
        quantity: Quantity::Time,
        neutral: 0.0,
        optional: false,
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
};

pub(super) static SENSOR_GAIN: EffectEntry = EffectEntry {
    name: "sensor_gain",
    place: Place::Sensor,
    role: Role::Sensor,
    lanes: Lanes::Known,
    choice: Some(BODY),
    parameters: &[EffectParameter {
        key: "gain",
        quantity: Quantity::Ratio,
        neutral: 1.0,
        optional: false,
        least: -10.0,
        most: 10.0,
        example: 1.02,
        meaning: "rotation read over true rotation",
    }],
    may_repeat: true,
    law: "g θ_i is read in place of θ_i",
    description: "A sensor of rotation out of calibration. Histories show what is read; the wall moves as without.",
    fingerprint: "the rotations themselves, not their dynamics",
    at_impacts: "ratios unchanged",
    confused_with: &["wall.height_m", "corners.lower_width_m", "corners.upper_width_m"],
    told_by: "turning the sensor by a known angle",
    add: gain,
};

pub(super) static SENSOR_OFFSET: EffectEntry = EffectEntry {
    name: "sensor_offset",
    place: Place::Sensor,
    role: Role::Sensor,
    lanes: Lanes::Known,
    choice: Some(BODY),
    parameters: &[EffectParameter {
        key: "offset_rad",
        quantity: Quantity::Rotation,
        neutral: 0.0,
        optional: false,
        least: -1.0,
        most: 1.0,
        example: 2e-4,
        meaning: "rotation read at rest",
    }],
    may_repeat: true,
    law: "θ_i + θ_0 is read in place of θ_i",
    description: "A sensor of rotation that does not read zero at rest. Histories show what is read; the wall moves \
                  as without.",
    fingerprint: "a constant in the rotations, at rest too",
    at_impacts: "ratios unchanged",
    confused_with: &["gap", "one_sided_spring", "diaphragm.eccentricity_m"],
    told_by: "reading the sensor while the wall stands",
    add: offset,
};
