//! Slips in wall files: numbers written in another unit than their key's.
//!
//! What no wall of masonry has is refused, with the unit that was likely meant. What few walls have becomes a
//! question ([`questions`]). Blocks of closed forms may have any size: [`crate::load_block`] reads them unchecked.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;
use std::path::Path;

use crate::error::InputError;
use mrbd_kernel::model::{G_M_S2, Wall};

/// A number of a wall file, what it may be, and what it usually is.
struct Size {
    key: &'static str,
    unit: &'static str,
    allowed: RangeInclusive<f64>,
    /// Where a value lies that was meant: narrower, so that few units can lead there.
    usual: RangeInclusive<f64>,
    /// Other units, and how many of `unit` one of them is.
    others: &'static [(&'static str, f64)],
}

/// Lengths as drawings have them.
const LENGTHS: &[(&str, f64)] = &[("mm", 1e-3), ("cm", 1e-2)];
/// Masses and densities as calculations have them: in tonnes, or as weights.
const MASSES: &[(&str, f64)] = &[("t", 1e3), ("kN", 1e3 / G_M_S2), ("N", 1.0 / G_M_S2)];
const DENSITIES: &[(&str, f64)] = &[("t/m3", 1e3), ("kN/m3", 1e3 / G_M_S2), ("N/m3", 1.0 / G_M_S2)];

/// From half a brick on edge to the foot of a tower.
const THICKNESS: Size =
    Size { key: "wall.thickness_m", unit: "m", allowed: 0.05..=5.0, usual: 0.1..=1.5, others: LENGTHS };
/// From a parapet to a tower.
const HEIGHT: Size =
    Size { key: "wall.height_m", unit: "m", allowed: 0.2..=60.0, usual: 1.0..=20.0, others: LENGTHS };
/// From a brick to a façade.
const LENGTH: Size =
    Size { key: "wall.length_m", unit: "m", allowed: 0.05..=100.0, usual: 0.2..=20.0, others: LENGTHS };
/// Between porous blocks and a wall of lead; masonry lies within [`MASONRY_KG_M3`].
const DENSITY: Size = Size {
    key: "wall.density_kg_m3",
    unit: "kg/m3",
    allowed: 100.0..=10e3,
    usual: 1000.0..=2800.0,
    others: DENSITIES,
};

/// Densities of masonry with room to spare, from light blocks with holes to dense stone, kg/m³.
const MASONRY_KG_M3: RangeInclusive<f64> = 300.0..=3500.0;
/// Slenderness h/b with room to spare: the façades of the paper's Table 3 have 9 to 15.
const SLENDERNESS: RangeInclusive<f64> = 3.0..=40.0;
/// Periods of the top masses on k_d with room to spare, s. Table 3 gives 0.05 to 0.5 s, the tested wall has 0.95 s.
const TOP_PERIOD_S: RangeInclusive<f64> = 0.03..=2.5;
/// The most that floors weigh, in masses of the wall: Table 3 has up to half of one.
const MOST_TOP_MASS_RATIO: f64 = 2.0;
/// N/m in the unit that stiffnesses are mostly given in, kN/m.
const KILO: f64 = 1e3;

/// The lengths of `[wall]` as they stand in a file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lengths {
    pub thickness_m: f64,
    pub height_m: f64,
    pub crack_height_m: Option<f64>,
    pub length_m: f64,
    /// Widths between the corners, at the ground and at the crack, where they are given.
    pub widths_m: [Option<f64>; 2],
}

/// Refuses lengths that no wall has.
///
/// # Errors
/// An input error with the value that was likely meant.
pub(crate) fn check_lengths(path: &Path, l: &Lengths) -> Result<(), InputError> {
    THICKNESS.check(path, l.thickness_m)?;
    HEIGHT.check(path, l.height_m)?;
    LENGTH.check(path, l.length_m)?;
    let within = |key, most_m: f64, least_m: f64, value_m: Option<f64>| {
        let size = Size { key, unit: "m", allowed: 0.0..=most_m, usual: least_m..=most_m, others: LENGTHS };
        // What is in no other unit either is left to the wall's own check.
        let slip = value_m.filter(|value_m| size.meant(*value_m).is_some());
        slip.map_or(Ok(()), |value_m| size.check(path, value_m))
    };
    // A crack at a fifth of the height, corners that crush through half of the wall.
    within("wall.crack_height_m", l.height_m, 0.2 * l.height_m, l.crack_height_m)?;
    let [lower_m, upper_m] = l.widths_m;
    within("corners.lower_width_m", l.thickness_m, 0.5 * l.thickness_m, lower_m)?;
    within("corners.upper_width_m", l.thickness_m, 0.5 * l.thickness_m, upper_m)
}

/// Refuses a density that no wall has.
///
/// # Errors
/// An input error with the value that was likely meant.
pub(crate) fn check_density(path: &Path, density_kg_m3: f64) -> Result<(), InputError> {
    DENSITY.check(path, density_kg_m3)
}

/// Refuses a mass that with the wall's volume implies a density no wall has.
///
/// # Errors
/// An input error with the density, and the mass that was likely meant.
pub(crate) fn check_mass(path: &Path, mass_kg: f64, volume_m3: f64) -> Result<(), InputError> {
    let density_kg_m3 = mass_kg / volume_m3;
    if !is_checked(density_kg_m3) || DENSITY.allowed.contains(&density_kg_m3) {
        return Ok(());
    }
    let found =
        format!("{mass_kg}, in {} m3 a density of {} kg/m3", figures(volume_m3), figures(density_kg_m3));
    let meant = MASSES.iter().find(|(_, kg)| DENSITY.usual.contains(&(density_kg_m3 * kg)));
    let meant =
        meant.map(|(unit, kg)| format!("; did you mean {} kg ({mass_kg} {unit})?", figures(mass_kg * kg)));
    let allowed = format!("a density of {}{}", DENSITY.bounds(), meant.unwrap_or_default());
    Err(InputError::key(path, "wall.mass_kg", found, allowed))
}

impl Size {
    fn check(&self, path: &Path, value: f64) -> Result<(), InputError> {
        if !is_checked(value) || self.allowed.contains(&value) {
            return Ok(());
        }
        let allowed = self.bounds() + &self.meant(value).unwrap_or_default();
        Err(InputError::key(path, self.key, value.to_string(), allowed))
    }

    /// The value that was likely meant, if a change of unit brings it where values usually are.
    fn meant(&self, value: f64) -> Option<String> {
        let meant = self.others.iter().find(|(_, factor)| self.usual.contains(&(value * factor)));
        meant.map(|(other, factor)| {
            format!("; did you mean {} {} ({value} {other})?", figures(value * factor), self.unit)
        })
    }

    fn bounds(&self) -> String {
        format!("{} to {} {}", self.allowed.start(), self.allowed.end(), self.unit)
    }
}

/// Whether a number is one that slips can be looked for in: the wall itself refuses the others.
fn is_checked(value: f64) -> bool {
    value.is_finite() && value > 0.0
}

/// A number to four figures, without the noise of a conversion.
fn figures(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    rounded.to_string()
}

/// What few walls have and may be a slip: a question each, with the key it is about.
pub fn questions(wall: &Wall) -> Vec<String> {
    [density_question(wall), slenderness_question(wall), top_mass_question(wall), stiffness_question(wall)]
        .into_iter()
        .flatten()
        .collect()
}

/// Density that mass and lengths imply, kg/m³.
pub fn density_kg_m3(wall: &Wall) -> f64 {
    let p = wall.parameters();
    p.mass_kg / (p.thickness_m * p.height_m * p.length_m)
}

/// Period of the top masses on the spring k_d, T = 2π √((m_d + m_dp)/k_d), s; `None` without either.
pub fn top_period_s(wall: &Wall) -> Option<f64> {
    let p = wall.parameters();
    let top_kg = p.diaphragm_mass_kg + p.carriage_mass_kg;
    let swings = top_kg > 0.0 && p.stiffness_n_per_m > 0.0;
    swings.then(|| TAU * (top_kg / p.stiffness_n_per_m).sqrt())
}

fn density_question(wall: &Wall) -> Option<String> {
    let density_kg_m3 = density_kg_m3(wall);
    (!MASONRY_KG_M3.contains(&density_kg_m3)).then(|| {
        format!(
            "wall.mass_kg: mass and lengths come to {} kg/m3; masonry has {} to {}; are they in kg and m?",
            figures(density_kg_m3),
            MASONRY_KG_M3.start(),
            MASONRY_KG_M3.end()
        )
    })
}

fn slenderness_question(wall: &Wall) -> Option<String> {
    let p = wall.parameters();
    let slenderness = p.height_m / p.thickness_m;
    let swapped = if slenderness < 1.0 { "are thickness and height swapped?" } else { "are both in m?" };
    (!SLENDERNESS.contains(&slenderness)).then(|| {
        let (least, most) = (SLENDERNESS.start(), SLENDERNESS.end());
        format!("wall.height_m: h/b is {}; walls have {least} to {most}; {swapped}", figures(slenderness))
    })
}

fn top_mass_question(wall: &Wall) -> Option<String> {
    let p = wall.parameters();
    let ratio = (p.diaphragm_mass_kg + p.carriage_mass_kg) / p.mass_kg;
    (ratio > MOST_TOP_MASS_RATIO).then(|| {
        let ratio = figures(ratio);
        format!("diaphragm.mass_kg: the top masses are {ratio} times the wall's; are they of the same strip, in kg?")
    })
}

fn stiffness_question(wall: &Wall) -> Option<String> {
    let period_s = top_period_s(wall).filter(|period_s| !TOP_PERIOD_S.contains(period_s))?;
    let k_d = wall.parameters().stiffness_n_per_m;
    let meant = if period_s > *TOP_PERIOD_S.end() {
        let meant = figures(k_d * KILO);
        format!("did you mean {meant} N/m ({k_d} kN/m), or are the masses not in kg?")
    } else {
        "is it in N/m, for the same strip, and are the masses in kg?".to_owned()
    };
    let (period_s, least, most) = (figures(period_s), TOP_PERIOD_S.start(), TOP_PERIOD_S.end());
    Some(format!(
        "diaphragm.stiffness_n_per_m: the top masses on {k_d} N/m have a period of {period_s} s; floors have {least} \
         to {most} s; {meant}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wall_file::{parse_block, parse_wall};

    const TABLE_WALL: &str = "[wall]\nthickness_m = 0.291\nheight_m = 3.984\ncrack_height_m = 2.191\nlength_m = 1.5\n\
        mass_kg = 3614.0\n[corners]\nlower_width_m = 0.271\nupper_width_m = 0.281\n[diaphragm]\nmass_kg = 179.0\n\
        carriage_mass_kg = 663.0\nstiffness_n_per_m = 37000.0\n";

    /// The table wall with lines of its file replaced.
    fn with(slips: &[(&str, &str)]) -> String {
        slips.iter().fold(TABLE_WALL.to_owned(), |text, (from, to)| {
            assert!(text.contains(from), "{from}");
            text.replacen(from, to, 1)
        })
    }

    fn refused(slip: (&str, &str)) -> String {
        parse_wall(Path::new("wall.toml"), &with(&[slip])).expect_err("must be refused").to_string()
    }

    #[test]
    fn rejects_numbers_in_other_units_with_what_was_meant() {
        let message = refused(("thickness_m = 0.291", "thickness_m = 291"));
        let whole =
            "wall.toml: wall.thickness_m: found 291; allowed: 0.05 to 5 m; did you mean 0.291 m (291 mm)?";
        assert_eq!(message, whole);
        for (from, to, key, meant) in [
            ("thickness_m = 0.291", "thickness_m = 29.1", "wall.thickness_m", "0.291 m (29.1 cm)"),
            ("height_m = 3.984", "height_m = 3984", "wall.height_m", "3.984 m (3984 mm)"),
            ("crack_height_m = 2.191", "crack_height_m = 219.1", "wall.crack_height_m", "2.191 m (219.1 cm)"),
            ("length_m = 1.5", "length_m = 1500", "wall.length_m", "1.5 m (1500 mm)"),
            ("mass_kg = 3614.0", "mass_kg = 3.614", "wall.mass_kg", "3614 kg (3.614 t)"),
            ("mass_kg = 3614.0", "mass_kg = 35.45", "wall.mass_kg", "3614 kg (35.45 kN)"),
            ("mass_kg = 3614.0", "density_kg_m3 = 1.8", "wall.density_kg_m3", "1800 kg/m3 (1.8 t/m3)"),
            ("mass_kg = 3614.0", "density_kg_m3 = 18", "wall.density_kg_m3", "1835 kg/m3 (18 kN/m3)"),
            ("lower_width_m = 0.271", "lower_width_m = 271", "corners.lower_width_m", "0.271 m (271 mm)"),
        ] {
            let message = refused((from, to));
            assert!(message.starts_with(&format!("wall.toml: {key}: found ")), "{message}");
            assert!(message.ends_with(&format!("; did you mean {meant}?")), "{message}");
        }
    }

    #[test]
    fn rejects_sizes_of_no_wall_without_a_guess() {
        let message = refused(("length_m = 1.5", "length_m = 1e9"));
        assert!(message.ends_with("allowed: 0.05 to 100 m"), "{message}");
    }

    #[test]
    fn analytic_questions_are_asked_of_slips_and_of_no_wall_without() {
        let asked = |slips: &[(&str, &str)]| {
            questions(&parse_wall(Path::new("wall.toml"), &with(slips)).expect("a wall")).join("\n")
        };
        assert_eq!(asked(&[]), "");
        let k_d = ("stiffness_n_per_m = 37000.0", "stiffness_n_per_m = 37.0");
        let soft = asked(&[k_d]);
        // 2π √(842/37) s.
        assert!(soft.contains("a period of 29.97 s") && soft.contains("37000 N/m (37 kN/m)"), "{soft}");
        let stiff = asked(&[(k_d.0, "stiffness_n_per_m = 37e6")]);
        assert!(stiff.contains("a period of 0.02997 s"), "{stiff}");
        let light = asked(&[("\nmass_kg = 3614.0", "\nmass_kg = 361.4")]);
        assert!(light.contains("come to 207.8 kg/m3"), "{light}");
        let heavy = asked(&[("mass_kg = 179.0", "mass_kg = 17900.0")]);
        assert!(heavy.contains("the same strip, in kg"), "{heavy}");
        let stout =
            asked(&[("length_m = 1.5", "length_m = 0.3"), ("thickness_m = 0.291", "thickness_m = 1.5")]);
        assert!(stout.contains("h/b is 2.656"), "{stout}");
    }

    #[test]
    fn regress_the_guide_states_these_limits() {
        let guide = include_str!("../../../docs/files.md").replace("m³", "m3").replace('\n', " ");
        for size in [THICKNESS, HEIGHT, LENGTH, DENSITY] {
            assert!(guide.contains(&size.bounds()), "{} {}", size.key, size.bounds());
        }
        for range in [MASONRY_KG_M3, SLENDERNESS, TOP_PERIOD_S] {
            let limits = format!("outside {} to {}", range.start(), range.end());
            assert!(guide.contains(&limits), "{limits}");
        }
    }

    #[test]
    fn analytic_a_block_of_a_closed_form_may_have_any_size() {
        let text = with(&[
            ("thickness_m = 0.291", "thickness_m = 0.0032"),
            ("[corners]\nlower_width_m = 0.271\nupper_width_m = 0.281\n", ""),
        ]);
        let path = Path::new("block.toml");
        assert!(parse_wall(path, &text).is_err() && parse_block(path, &text).is_ok());
    }
}
