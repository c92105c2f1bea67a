//! Effects in the reading of the rotations: the wall moves as without them.

use super::catalogue::{EffectChoice, EffectKind, EffectParameter, Place};
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

pub(super) const KINDS: [EffectKind; 2] = [
    EffectKind {
        name: "sensor_gain",
        place: Place::Sensor,
        choice: Some(BODY),
        parameters: &[EffectParameter {
            key: "gain",
            unit: "",
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
    },
    EffectKind {
        name: "sensor_offset",
        place: Place::Sensor,
        choice: Some(BODY),
        parameters: &[EffectParameter {
            key: "offset_rad",
            unit: "rad",
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
    },
];
