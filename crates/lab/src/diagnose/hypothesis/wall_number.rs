//! Numbers of a wall that may be known only roughly before the tests.

use mrbd_kernel::model::{Quantity, WallParameters};

/// One number of the wall file.
#[derive(Debug)]
pub struct WallNumber {
    /// Dotted key of the wall file.
    pub key: &'static str,
    /// What it measures, from which its unit follows.
    pub quantity: Quantity,
    /// Reads it.
    pub get: fn(&WallParameters) -> f64,
    /// Changes it.
    pub set: fn(&mut WallParameters, f64),
}

impl PartialEq for WallNumber {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

macro_rules! number {
    ($key:literal, $quantity:ident, $field:ident) => {
        WallNumber {
            key: $key,
            quantity: Quantity::$quantity,
            get: |p| p.$field,
            set: |p, value| p.$field = value,
        }
    };
}

/// Every number a prior or a rival may name; the first with a given last word is meant by that word alone.
pub static WALL_NUMBERS: [WallNumber; 10] = [
    number!("wall.mass_kg", TopMass, mass_kg),
    number!("wall.thickness_m", TopDisplacement, thickness_m),
    number!("wall.height_m", TopDisplacement, height_m),
    WallNumber {
        key: "wall.crack_height_m",
        quantity: Quantity::TopDisplacement,
        get: |p| p.crack_height_m.unwrap_or(p.height_m),
        set: |p, value| p.crack_height_m = p.crack_height_m.map(|_| value),
    },
    number!("corners.lower_width_m", CornerWidth, lower_width_m),
    number!("corners.upper_width_m", CornerWidth, upper_width_m),
    number!("diaphragm.mass_kg", TopMass, diaphragm_mass_kg),
    number!("diaphragm.carriage_mass_kg", TopMass, carriage_mass_kg),
    number!("diaphragm.stiffness_n_per_m", TopStiffness, stiffness_n_per_m),
    number!("diaphragm.eccentricity_m", TopDisplacement, eccentricity_m),
];

/// The number a key names, with or without its table.
pub fn wall_number(key: &str) -> Option<&'static WallNumber> {
    let last = |number: &&WallNumber| number.key.rsplit('.').next() == Some(key);
    WALL_NUMBERS.iter().find(|number| number.key == key).or_else(|| WALL_NUMBERS.iter().find(last))
}
