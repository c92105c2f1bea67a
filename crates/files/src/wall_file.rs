//! Wall files (TOML): every key checked, turned into a [`Wall`].

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::toml_file;
use crate::error::{InputError, Result};
use crate::slips::{self, Lengths};
use mrbd_formula::{Formula, Place};
use mrbd_kernel::model::{
    Effect, FurtherLaw, ImpactLaw, ImpossibleWall, Restitution, Wall, WallParameters, crushed_widths_m,
};

/// A wall file as written.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct WallFile {
    wall: Body,
    /// `None`: the corners are the edges of the wall.
    corners: Option<Corners>,
    /// Left out, the top is free.
    #[serde(default)]
    diaphragm: Diaphragm,
    #[serde(default)]
    restitution: RestitutionKeys,
    #[serde(default)]
    collapse: Collapse,
    #[serde(default)]
    initial: Initial,
    #[serde(default)]
    effects: Vec<FurtherLaw>,
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

#[derive(Debug, Clone, PartialEq, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Diaphragm {
    mass_kg: f64,
    #[serde(default)]
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

/// Reads a wall file for a static check, which counts forces at the top but no moments of formulas at joints.
///
/// # Errors
/// As [`load_wall`]; a formula at a joint; one with a carried state.
pub fn load_static_wall(path: &Path) -> Result<Wall> {
    let wall = load_wall(path)?;
    let at_joint = |formula: &&Formula| matches!(formula.place(), Place::Ground | Place::Crack);
    let carries = |formula: &&Formula| !formula.states().is_empty();
    if let Some(formula) = wall.parameters().formulas.iter().find(carries) {
        let found = format!("the force `{formula}` with a carried state");
        let allowed = "formulas without states: a static check has no time in which they change";
        return Err(InputError::key(path, "effects", found, allowed).into());
    }
    match wall.parameters().formulas.iter().find(at_joint) {
        Some(formula) => {
            let found = format!("the moment `{formula}` at the {}", formula.place().name());
            let allowed = "formulas at the top: a static check counts no moments of formulas at joints";
            Err(InputError::key(path, "effects", found, allowed).into())
        }
        None => Ok(wall),
    }
}

/// Checks the text of a wall file that came from `path`.
///
/// # Errors
/// As [`load_wall`].
pub fn parse_wall(path: &Path, text: &str) -> Result<Wall> {
    let file: WallFile = toml_file::parse(path, text)?;
    check_slips(path, &file)?;
    Ok(wall(path, file)?)
}

/// Reads a block of a closed form, which may have sizes that no wall of masonry has.
///
/// # Errors
/// As [`load_wall`], but for numbers that are taken for slips.
pub fn load_block(path: &Path) -> Result<Wall> {
    parse_block(path, &toml_file::read(path)?)
}

/// Checks the text of a block that came from `path`.
///
/// # Errors
/// As [`load_block`].
pub fn parse_block(path: &Path, text: &str) -> Result<Wall> {
    Ok(wall(path, toml_file::parse(path, text)?)?)
}

/// Refuses numbers that no wall has: they are in another unit than their key's.
fn check_slips(path: &Path, file: &WallFile) -> Result<(), InputError> {
    let &Body { thickness_m, height_m, crack_height_m, length_m, mass_kg, density_kg_m3 } = &file.wall;
    let widths_m = file.corners.as_ref().map_or([None; 2], |c| [c.lower_width_m, c.upper_width_m]);
    slips::check_lengths(path, &Lengths { thickness_m, height_m, crack_height_m, length_m, widths_m })?;
    density_kg_m3.map_or(Ok(()), |density_kg_m3| slips::check_density(path, density_kg_m3))?;
    let volume_m3 = thickness_m * height_m * length_m;
    mass_kg.map_or(Ok(()), |mass_kg| slips::check_mass(path, mass_kg, volume_m3))
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
    let (effects, formulas) = apart(&file.effects);
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
        effects,
        formulas,
    };
    Wall::new(parameters).map_err(|e| {
        let key = key_in_file(&e, &file.effects);
        InputError::key(path, key, e.found, e.allowed)
    })
}

/// Those of the catalogue, and formulas.
fn apart(laws: &[FurtherLaw]) -> (Vec<Effect>, Vec<Formula>) {
    let (mut effects, mut formulas) = (Vec::new(), Vec::new());
    for law in laws {
        match law {
            FurtherLaw::Effect(effect) => effects.push(*effect),
            FurtherLaw::Formula(formula) => formulas.push(formula.clone()),
        }
    }
    (effects, formulas)
}

/// The key as the file has it: the model counts effects and formulas apart, the file counts them together.
fn key_in_file(e: &ImpossibleWall, laws: &[FurtherLaw]) -> String {
    let of_list = |list: &str, is_of_list: fn(&FurtherLaw) -> bool| {
        let rest = e.key.strip_prefix(list)?;
        let (number, rest) = rest.split_once('.').map_or((rest, None), |(number, rest)| (number, Some(rest)));
        let number: usize = number.parse().ok()?;
        let (position, _) = laws.iter().enumerate().filter(|(_, law)| is_of_list(law)).nth(number)?;
        Some(rest.map_or(format!("effects.{position}"), |rest| format!("effects.{position}.{rest}")))
    };
    of_list("effects.", |law| matches!(law, FurtherLaw::Effect(_)))
        .or_else(|| of_list("formulas.", |law| matches!(law, FurtherLaw::Formula(_))))
        .unwrap_or_else(|| e.key.to_string())
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

/// Widths between the rocking corners: the full thickness, given, or from the strength of the masonry.
fn widths_m(path: &Path, file: &WallFile, mass_kg: f64) -> Result<[f64; 2], InputError> {
    let Some(c) = &file.corners else { return Ok([file.wall.thickness_m; 2]) };
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
            "lower_width_m and upper_width_m (lower alone for an uncracked wall), compressive_strength_pa, or no \
             [corners] for the full thickness",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FEWEST: &str = "[wall]\nthickness_m = 0.3\nheight_m = 4.0\ncrack_height_m = 2.2\nlength_m = 1.5\n\
        density_kg_m3 = 1800.0\n";

    fn read(text: &str) -> Result<WallParameters> {
        parse_wall(Path::new("wall.toml"), text).map(|wall| wall.parameters().clone())
    }

    #[test]
    fn analytic_a_wall_of_the_fewest_keys_has_its_full_thickness_and_a_free_top() {
        let in_full = format!(
            "{FEWEST}[corners]\nlower_width_m = 0.3\nupper_width_m = 0.3\n\
             [diaphragm]\nmass_kg = 0.0\ncarriage_mass_kg = 0.0\nstiffness_n_per_m = 0.0\neccentricity_m = 0.0\n"
        );
        let fewest = read(FEWEST).expect("a wall");
        assert_eq!(fewest, read(&in_full).expect("a wall"));
        assert_eq!([fewest.lower_width_m, fewest.upper_width_m], [0.3, 0.3]);
        let uncracked = read(&FEWEST.replace("crack_height_m = 2.2\n", "")).expect("a wall");
        assert_eq!([uncracked.lower_width_m, uncracked.upper_width_m], [0.3, 0.3]);
        let floor = "[diaphragm]\nmass_kg = 200.0\nstiffness_n_per_m = 37e3\n";
        let held = read(&format!("{FEWEST}{floor}")).expect("a wall");
        assert_eq!((held.carriage_mass_kg, held.stiffness_n_per_m, held.lower_width_m), (0.0, 37e3, 0.3));
    }

    const FORMULA: &str = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-k*x - d*abs(v)**p*sign(v)\"\n\
        [effects.parameters]\nk = { value = 37e3, unit = \"N/m\" }\np = { value = 1.7, unit = \"1\" }\n\
        d = { value = 900, unit = \"N*(s/m)**p\" }\n";

    /// Laws of a wall file come back as they were when they are written and read, as text and as a table.
    fn assert_written_as_read(laws: &str, wall: &WallParameters) {
        #[derive(Serialize)]
        struct Laws {
            effects: Vec<FurtherLaw>,
        }
        let text = toml::to_string(&Laws { effects: wall.further_laws() }).expect("a table");
        assert_eq!(read(&format!("{FEWEST}{text}")).expect(&text), *wall, "{text}");
        let table = toml::from_str(&format!("{FEWEST}{laws}")).expect("TOML");
        assert_eq!(wall_from_table(Path::new("wall.toml"), table).expect("a wall").parameters(), wall);
    }

    #[test]
    fn analytic_a_formula_of_a_wall_file_is_written_as_it_was_read() {
        let friction = "[[effects]]\nkind = \"coulomb_friction\"\nforce_n = 300.0\n";
        let wall = read(&format!("{FEWEST}{FORMULA}{friction}")).expect("a wall");
        assert_eq!((wall.effects.len(), wall.formulas.len()), (1, 1));
        assert_eq!(wall.formulas[0].to_string(), "-k*x - d*abs(v)**p*sign(v)");
        assert_written_as_read(&format!("{FORMULA}{friction}"), &wall);
    }

    #[test]
    fn rejects_formulas_with_file_key_and_place() {
        let friction = "[[effects]]\nkind = \"coulomb_friction\"\nforce_n = 300.0\n";
        for (found, put, parts) in [
            (
                "-k*x",
                "-k*y",
                &["effects[1]", "at character 4: an unknown name `y` in `force_n` of formula"][..],
            ),
            ("-k*x - d", "-k*x + x - d", &["`-k*x` in N and `x` in m", "one unit"]),
            ("\"N/m\"", "\"kN/m\"", &["`kN` in `kN/m` in `parameters.k`", "without prefixes"]),
            ("place = \"top\"", "place = \"roof\"", &["`roof` for `place`", "`top`, `ground`, `crack`"]),
            ("place = \"top\"\n", "", &["no `place`"]),
            ("force_n", "moment_n_m", &["no `force_n`", "at the top"]),
            ("value = 900, ", "", &["no `value` for `parameters.d`", "[effects.parameters]"]),
            ("{ value = 900, unit = \"N*(s/m)**p\" }", "900", &["900 for `parameters.d`"]),
            ("-k*x", "-k*x/(x/x)", &["wall.toml: effects.1.force_n", "`x/x`, where `x` may be zero"]),
            ("place = \"top\"", "place = \"top\"\nmass_kg = 2", &["unknown key `mass_kg`", "`parameters`"]),
        ] {
            assert!(FORMULA.contains(found), "{found}");
            let text = format!("{FEWEST}{friction}{}", FORMULA.replacen(found, put, 1));
            let message = read(&text).expect_err(&text).to_string();
            assert!(parts.iter().all(|part| message.contains(part)), "{parts:?} in: {message}");
        }
    }

    const CARRIED: &str = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-z\"\n\
        [effects.states.z]\nrate = \"k*v - z/tau\"\nstart = 0.0\nunit = \"N\"\n\
        [effects.parameters]\nk = { value = 2e4, unit = \"N/m\" }\ntau = { value = 0.3, unit = \"s\" }\n";

    #[test]
    fn analytic_a_formula_with_a_state_is_written_as_it_was_read() {
        let bouc_wen = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-k*z\"\n[effects.states.z]\n\
            rate = \"v - (b*abs(v)*abs(z)**(n - 1)*z + g*v*abs(z)**n)\"\nstart = 1e-3\nunit = \"m\"\n\
            range = [-0.5, 0.5]\n[effects.parameters]\nk = { value = 2e4, unit = \"N/m\" }\n\
            b = { value = 50.0, unit = \"m**(-n)\" }\ng = { value = 50.0, unit = \"m**(-n)\" }\nn = { value = 1.5, unit = \"1\" }\n";
        for law in [CARRIED, bouc_wen] {
            let wall = read(&format!("{FEWEST}{law}")).expect("a wall");
            assert_written_as_read(law, &wall);
        }
        // Bounded by its rate too, as it is written by Bouc and Wen.
        read(&format!("{FEWEST}{}", bouc_wen.replace("range = [-0.5, 0.5]\n", ""))).expect("a wall");
    }

    #[test]
    fn rejects_states_with_file_key_and_what_is_allowed() {
        for (found, put, parts) in [
            ("k*v - z/tau", "k*x - z/tau", &["`k*x` in N and `z/tau` in N/s", "in `states.z.rate`"][..]),
            ("k*v - z/tau", "k*x*tau/tau", &["`k*x*tau/tau` in N in `states.z.rate`", "allowed: N/s"]),
            (
                "k*v - z/tau",
                "k*v - y/tau",
                &["unknown name `y` in `states.z.rate`", "x, v, x_max, z, k, tau"],
            ),
            ("rate = \"k*v - z/tau\"\n", "", &["no `rate` for `states.z`", "[effects.states.NAME]"]),
            ("start = 0.0\n", "", &["no `start` for `states.z`"]),
            ("unit = \"N\"\n", "", &["no `unit` for `states.z`"]),
            ("unit = \"N\"\n", "unit = \"kN\"\n", &["`kN` in `kN` in `states.z.unit`"]),
            ("start = 0.0", "start = 0.0\nend = 1.0", &["`end` = 1 for `states.z`"]),
            (
                "start = 0.0",
                "start = 2.0\nrange = [-1.0, 1.0]",
                &["2 in `states.z.start`", "within the range"],
            ),
            ("start = 0.0", "start = 0.0\nrange = [1.0, -1.0]", &["[1, -1] in `states.z.range`"]),
            ("states.z", "states.v", &["a state `v`", "no variable and no function"]),
            ("states.z", "states.tau", &["a state `tau` beside a parameter of that name"]),
            ("-z", "-k*x", &["`z`, which the formula does not use", "states of the formula"]),
            (
                "k*v - z/tau",
                "k*v - z/tau - k*x*(z > 0)/tau",
                &["carried state", "jumps", "effects.0.force_n"],
            ),
            (
                "k*v - z/tau",
                "k*v + z/tau",
                &["effects.0.states.z.rate", "no size of z is shown to bound", "range ="],
            ),
            ("k*v - z/tau", "k*v - z/tau + k*sign(v)*x/tau", &["a rate that jumps where v passes a value"]),
            (
                "place = \"top\"\nforce_n = \"-z\"",
                "place = \"crack\"\nmoment_n_m = \"-z\"",
                &["a carried state at crack"],
            ),
        ] {
            assert!(CARRIED.contains(found), "{found}");
            let message =
                read(&format!("{FEWEST}{}", CARRIED.replacen(found, put, 1))).expect_err(put).to_string();
            assert!(parts.iter().all(|part| message.contains(part)), "{put}: {parts:?} in: {message}");
        }
    }

    #[test]
    fn rejects_tables_that_are_begun_and_left() {
        for (table, parts) in [
            ("[corners]\n", &["corners", "incomplete", "no [corners] for the full thickness"][..]),
            ("[corners]\nlower_width_m = 0.28\n", &["corners", "incomplete"]),
            ("[diaphragm]\nmass_kg = 200.0\n", &["diaphragm", "missing field `stiffness_n_per_m`"]),
            ("[diaphragm]\nstiffness_n_per_m = 37e3\n", &["diaphragm", "missing field `mass_kg`"]),
        ] {
            let message = read(&format!("{FEWEST}{table}")).expect_err("must be refused").to_string();
            assert!(parts.iter().all(|part| message.contains(part)), "{parts:?} in: {message}");
        }
    }
}
