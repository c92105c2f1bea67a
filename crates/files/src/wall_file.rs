//! Wall files (TOML): every key checked, turned into a [`Wall`].

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::toml_file;
use crate::error::{InputError, Result};
use mrbd_kernel::model::{Effect, ImpactLaw, Restitution, Wall, WallParameters, crushed_widths_m};

/// A wall file as written.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct WallFile {
    wall: Body,
    corners: Corners,
    diaphragm: Diaphragm,
    #[serde(default)]
    restitution: RestitutionKeys,
    #[serde(default)]
    collapse: Collapse,
    #[serde(default)]
    initial: Initial,
    #[serde(default)]
    effects: Vec<Effect>,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Body {
    thickness_m: f64,
    height_m: f64,
    crack_height_m: Option<f64>,
    length_m: f64,
    mass_kg: Option<f64>,
    density_kg_m3: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Corners {
    lower_width_m: Option<f64>,
    upper_width_m: Option<f64>,
    compressive_strength_pa: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Diaphragm {
    mass_kg: f64,
    carriage_mass_kg: f64,
    stiffness_n_per_m: f64,
    #[serde(default)]
    eccentricity_m: f64,
}

#[derive(Debug, Clone, PartialEq, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct RestitutionKeys {
    coefficients: Option<[f64; 8]>,
    law: Option<ImpactLaw>,
    capture_velocity_rad_s: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Collapse {
    rotation_ratio: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Initial {
    #[serde(default)]
    theta1_rad: f64,
    #[serde(default)]
    theta2_rad: f64,
}

/// Reads a wall file.
///
/// # Errors
/// Input errors that name the file, the key, what was found and what is allowed.
pub fn load_wall(path: &Path) -> Result<Wall> {
    parse_wall(path, &toml_file::read(path)?)
}

/// Checks the text of a wall file that came from `path`.
///
/// # Errors
/// As [`load_wall`].
pub fn parse_wall(path: &Path, text: &str) -> Result<Wall> {
    let file: WallFile = toml_file::parse(path, text)?;
    Ok(wall(path, file)?)
}

/// Makes a wall from the table of a wall file, whose values a calibration has changed.
///
/// # Errors
/// As [`load_wall`].
pub fn wall_from_table(path: &Path, table: toml::Table) -> Result<Wall, InputError> {
    let file =
        WallFile::deserialize(table).map_err(|e| InputError::file(path, e.to_string(), "a wall file"))?;
    wall(path, file)
}

fn wall(path: &Path, file: WallFile) -> Result<Wall, InputError> {
    let mass_kg = mass_kg(path, &file.wall)?;
    let [lower_width_m, upper_width_m] = widths_m(path, &file, mass_kg)?;
    let default = Restitution::default();
    let restitution = Restitution {
        coefficients: file.restitution.coefficients.unwrap_or(default.coefficients),
        law: file.restitution.law.unwrap_or(default.law),
        capture_velocity_rad_s: file
            .restitution
            .capture_velocity_rad_s
            .unwrap_or(default.capture_velocity_rad_s),
    };
    let parameters = WallParameters {
        thickness_m: file.wall.thickness_m,
        height_m: file.wall.height_m,
        crack_height_m: file.wall.crack_height_m,
        length_m: file.wall.length_m,
        mass_kg,
        lower_width_m,
        upper_width_m,
        diaphragm_mass_kg: file.diaphragm.mass_kg,
        carriage_mass_kg: file.diaphragm.carriage_mass_kg,
        stiffness_n_per_m: file.diaphragm.stiffness_n_per_m,
        eccentricity_m: file.diaphragm.eccentricity_m,
        restitution,
        collapse_rotation_ratio: file
            .collapse
            .rotation_ratio
            .unwrap_or(WallParameters::DEFAULT_COLLAPSE_RATIO),
        initial_rotation_rad: [file.initial.theta1_rad, file.initial.theta2_rad],
        effects: file.effects,
    };
    Wall::new(parameters).map_err(|e| InputError::key(path, e.key, e.found, e.allowed))
}

fn mass_kg(path: &Path, body: &Body) -> Result<f64, InputError> {
    match (body.mass_kg, body.density_kg_m3) {
        (Some(mass_kg), None) => Ok(mass_kg),
        (None, Some(density)) if density > 0.0 && density.is_finite() => {
            Ok(density * body.thickness_m * body.height_m * body.length_m)
        }
        (None, Some(density)) => {
            Err(InputError::key(path, "wall.density_kg_m3", density.to_string(), "a finite number above 0"))
        }
        (Some(_), Some(_)) => {
            Err(InputError::key(path, "wall.mass_kg", "both mass_kg and density_kg_m3", "one of the two"))
        }
        (None, None) => {
            Err(InputError::key(path, "wall", "neither mass_kg nor density_kg_m3", "one of the two"))
        }
    }
}

/// Widths between the rocking corners, given or from the strength of the masonry.
fn widths_m(path: &Path, file: &WallFile, mass_kg: f64) -> Result<[f64; 2], InputError> {
    let c = &file.corners;
    let cracked = file.wall.crack_height_m.is_some();
    match (c.lower_width_m, c.upper_width_m, c.compressive_strength_pa) {
        (Some(lower), Some(upper), None) => Ok([lower, upper]),
        (Some(lower), None, None) if !cracked => Ok([lower, lower]),
        (None, None, Some(strength)) => {
            let body = &file.wall;
            let crack_height_m = body.crack_height_m.unwrap_or(body.height_m);
            let upper_kg = mass_kg * (1.0 - crack_height_m / body.height_m);
            let above_kg = [mass_kg + file.diaphragm.mass_kg, upper_kg + file.diaphragm.mass_kg];
            crushed_widths_m(body.thickness_m, body.length_m, above_kg, strength)
                .map_err(|e| InputError::key(path, "corners.compressive_strength_pa", e.found, e.allowed))
        }
        _ => Err(InputError::key(
            path,
            "corners",
            "an incomplete or mixed choice",
            "lower_width_m and upper_width_m (lower alone for an uncracked wall), or compressive_strength_pa",
        )),
    }
}
