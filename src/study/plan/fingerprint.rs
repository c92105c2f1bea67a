//! The hash of what goes into a run or a plan.

use std::sync::Arc;

use super::run::RecordHash;
use crate::study::pipeline::Member;
use crate::study::sequence::{Place, Sequence};
use mrbd_files::checksum::hexadecimal;
use mrbd_formula::Formula;
use mrbd_kernel::model::{Effect, WallParameters};
use mrbd_records::Accelerogram;
use sha2::{Digest, Sha256};

/// Digits of an id: 64 bits, so that two of 10⁶ runs share one with a chance of 3e-8.
const ID_DIGITS: usize = 16;

/// Bytes of what goes into most runs.
const MOST_BYTES: usize = 1024;

/// What is hashed, as it gathers: named values. Every run has an id, and to hash eight bytes at a time would cost it as much again.
pub(super) struct Fingerprint(Vec<u8>);

impl Fingerprint {
    /// An empty one; `kind` keeps hashes of different things apart.
    pub fn of(kind: &str) -> Self {
        Self(Vec::with_capacity(MOST_BYTES)).text("kind", kind)
    }

    /// Adds a text; its length goes first, so that neighbours cannot trade letters.
    pub fn text(mut self, name: &str, value: &str) -> Self {
        for part in [name, value] {
            self.0.extend((part.len() as u64).to_le_bytes());
            self.0.extend(part.as_bytes());
        }
        self
    }

    /// Adds numbers by their bits.
    pub fn numbers(mut self, name: &str, values: &[f64]) -> Self {
        self = self.text("numbers", name);
        self.0.extend((values.len() as u64).to_le_bytes());
        values.iter().for_each(|value| self.0.extend(value.to_bits().to_le_bytes()));
        self
    }

    /// Adds one number.
    pub fn number(self, name: &str, value: f64) -> Self {
        self.numbers(name, &[value])
    }

    /// Adds every parameter of a wall; a parameter added to the model must be added here to compile.
    pub fn wall(self, parameters: &WallParameters) -> Self {
        let WallParameters {
            thickness_m,
            height_m,
            crack_height_m,
            length_m,
            mass_kg,
            lower_width_m,
            upper_width_m,
            diaphragm_mass_kg,
            carriage_mass_kg,
            stiffness_n_per_m,
            eccentricity_m,
            restitution,
            collapse_rotation_ratio,
            initial_rotation_rad,
            effects,
            formulas,
        } = parameters;
        self.numbers("size", &[*thickness_m, *height_m, crack_height_m.unwrap_or(0.0), *length_m])
            .numbers("masses", &[*mass_kg, *diaphragm_mass_kg, *carriage_mass_kg])
            .numbers("corners", &[*lower_width_m, *upper_width_m])
            .numbers("spring", &[*stiffness_n_per_m, *eccentricity_m])
            .numbers("coefficients", &restitution.coefficients)
            .text("law", restitution.law.name())
            .number("capture velocity", restitution.capture_velocity_rad_s)
            .number("collapse", *collapse_rotation_ratio)
            .numbers("initial", initial_rotation_rad)
            .effects(effects)
            .formulas(formulas)
    }

    /// A wall without formulas hashes as before there were any.
    fn formulas(self, formulas: &[Formula]) -> Self {
        let texts = formulas.iter().map(|formula| serde_json::to_string(formula).unwrap_or_default());
        texts.fold(self, |hash, formula| hash.text("formula", &formula))
    }

    /// Adds the place in a sequence, and every motion of it; nothing of a record by itself.
    pub fn sequence(
        self,
        of: Option<&(Arc<Sequence>, Place)>,
        crushing_stays: bool,
        hashes: &[RecordHash],
    ) -> Self {
        let Some((sequence, Place { part, alone })) = of else { return self };
        let hash = self
            .text("sequence", &sequence.name)
            .text("part", &part.to_string())
            .text("alone", &alone.to_string())
            .text("crushing stays", &crushing_stays.to_string())
            .number("rest", sequence.rest_s);
        sequence.parts.iter().fold(hash, |hash, part| {
            let RecordHash { horizontal, vertical } = &hashes[part.record_index];
            let vertical = vertical.as_deref().unwrap_or("none");
            hash.text("horizontal", horizontal).text("vertical", vertical).number("scale", part.scale)
        })
    }

    /// Adds the place in an ensemble, of which the factors on motion and tolerance follow; nothing of a run as planned.
    pub fn member(self, member: Option<&Member>) -> Self {
        match member {
            None => self,
            Some(Member { member_of, number }) => {
                self.text("member of", member_of).text("member", &number.to_string())
            }
        }
    }

    fn effects(self, effects: &[Effect]) -> Self {
        // As a wall file has them; numbers, texts and enums always serialise.
        let texts = effects.iter().map(|effect| serde_json::to_string(effect).unwrap_or_default());
        texts.fold(self.number("effects", effects.len() as f64), |hash, effect| hash.text("effect", &effect))
    }

    /// Adds the step and every sample of a ground motion.
    pub fn motion(self, motion: &Accelerogram) -> Self {
        self.number("step", motion.step_s()).numbers("samples", motion.acceleration_m_s2())
    }

    /// The whole hash, 64 hexadecimal digits.
    pub fn hex(self) -> String {
        hexadecimal(&Sha256::digest(self.0))
    }

    /// The beginning of the hash that serves as an id.
    pub fn id(self) -> String {
        hexadecimal(&Sha256::digest(self.0)[..ID_DIGITS / 2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_sha256_of_nothing_added() {
        // NIST's example value for the empty message.
        let empty = Fingerprint(Vec::new()).hex();
        assert_eq!(empty, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    }

    #[test]
    fn regress_neighbours_cannot_trade_letters_or_numbers() {
        let of = |a: &str, b: &str| Fingerprint::of("test").text("a", a).text("b", b).id();
        assert_ne!(of("xy", "z"), of("x", "yz"));
        let of = |a: &[f64], b: &[f64]| Fingerprint::of("test").numbers("a", a).numbers("b", b).id();
        assert_ne!(of(&[1.0, 2.0], &[3.0]), of(&[1.0], &[2.0, 3.0]));
        assert_eq!(of(&[1.0], &[2.0]).len(), ID_DIGITS);
    }
}
