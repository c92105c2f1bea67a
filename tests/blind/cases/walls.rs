//! Walls of the cases: that of the shaking-table tests, and façades within the survey's bounds.

use std::fmt::Write as _;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// The numbers of a wall file.
#[derive(Debug, Clone, PartialEq)]
pub struct WallNumbers {
    pub thickness_m: f64,
    pub height_m: f64,
    pub crack_height_m: f64,
    pub length_m: f64,
    pub mass_kg: f64,
    /// b_1 and b_2.
    pub widths_m: [f64; 2],
    pub diaphragm_mass_kg: f64,
    pub carriage_mass_kg: f64,
    pub stiffness_n_per_m: f64,
    /// C_1 … C_8.
    pub coefficients: [f64; 8],
    /// Impact law; only the library's own simulator knows `whole`.
    pub law: &'static str,
}

/// The best fit of the paper's Table 2.
pub const TABLE_2: [f64; 8] = [0.93, 1.03, 0.825, 0.985, 0.865, 0.76, 0.98, 0.94];

impl WallNumbers {
    /// The wall of the shaking-table tests (Table 1).
    pub fn table() -> Self {
        Self {
            thickness_m: 0.291,
            height_m: 3.984,
            crack_height_m: 2.191,
            length_m: 1.5,
            mass_kg: 3614.0,
            widths_m: [0.271, 0.281],
            diaphragm_mass_kg: 179.0,
            carriage_mass_kg: 663.0,
            stiffness_n_per_m: 37_000.0,
            coefficients: TABLE_2,
            law: "contact",
        }
    }

    /// A façade within μ ± σ of Table 3, with a floor soft enough for it to rock about as the tested wall does.
    ///
    /// Table 3's floors are 10 to 100 times stiffer than the tests' springs; under them a façade hardly rocks at
    /// rotations that sensors can follow. The stiffness is drawn between the two.
    pub fn facade(rng: &mut ChaCha8Rng) -> Self {
        let thickness_m = rounded(rng.random_range(0.30..0.60), 1e-3);
        let height_m = rounded(thickness_m * rng.random_range(9.0..15.0), 1e-3);
        let crack_height_m = rounded(height_m * rng.random_range(0.52..0.73), 1e-3);
        // 18 kN/m³ for brick and lime mortar.
        let mass_kg = rounded(1800.0 * thickness_m * height_m, 1.0);
        let parallel = rng.random_range(0.0..1.0) < 0.5;
        let (d, dp) = if parallel {
            (rng.random_range(0.02..0.07), rng.random_range(0.06..0.27))
        } else {
            (rng.random_range(0.05..0.16), 0.0)
        };
        let total_kg = mass_kg / (1.0 - d - dp);
        // The depth of the stress block at the corners, 1 to 5 % of the thickness at Table 3's strengths.
        let width = |share: f64| rounded(thickness_m * (1.0 - share), 1e-3);
        let coefficients = if rng.random_range(0.0..1.0) < 0.5 { TABLE_2 } else { [1.0; 8] };
        Self {
            thickness_m,
            height_m,
            crack_height_m,
            length_m: 1.0,
            mass_kg,
            widths_m: [width(rng.random_range(0.03..0.08)), width(rng.random_range(0.01..0.04))],
            diaphragm_mass_kg: rounded(d * total_kg, 1.0),
            carriage_mass_kg: rounded(dp * total_kg, 1.0),
            stiffness_n_per_m: rounded(10f64.powf(rng.random_range(4.5..5.3)), 100.0),
            coefficients,
            law: "contact",
        }
    }

    /// Weight on the ground, N.
    pub fn weight_n(&self) -> f64 {
        (self.mass_kg + self.diaphragm_mass_kg) * 9.81
    }

    /// The wall file, further tables after it.
    pub fn to_toml(&self, effects: &[toml::Table]) -> String {
        let [b1, b2] = self.widths_m;
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "[wall]\nthickness_m = {:?}\nheight_m = {:?}\ncrack_height_m = {:?}\nlength_m = {:?}\nmass_kg = {:?}\n\n\
             [corners]\nlower_width_m = {b1:?}\nupper_width_m = {b2:?}\n\n\
             [diaphragm]\nmass_kg = {:?}\ncarriage_mass_kg = {:?}\nstiffness_n_per_m = {:?}\n\n\
             [restitution]\ncoefficients = {:?}\nlaw = {:?}\n\n\
             [collapse]\nrotation_ratio = 2.0\n",
            self.thickness_m,
            self.height_m,
            self.crack_height_m,
            self.length_m,
            self.mass_kg,
            self.diaphragm_mass_kg,
            self.carriage_mass_kg,
            self.stiffness_n_per_m,
            self.coefficients,
            self.law,
        );
        for effect in effects {
            text.push_str("\n[[effects]]\n");
            // A table inside an effect stands on its line: under a heading of its own it would be none of the effect's.
            effect.iter().for_each(|(key, value)| {
                let _ = writeln!(text, "{key} = {value}");
            });
        }
        text
    }
}

/// A value as one would write it into a file.
pub fn rounded(value: f64, step: f64) -> f64 {
    // Dividing by the inverse gives the number nearest to the decimal one.
    if step < 1.0 { (value / step).round() / (1.0 / step).round() } else { (value / step).round() * step }
}
