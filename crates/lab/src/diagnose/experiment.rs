//! An experiment, read whole for a diagnosis, and what laboratories get wrong in files.
//!
//! Wrong files are found before anything is fitted. Large rotations in degrees are found on reading.

use std::path::{Path, PathBuf};

use super::fit::{Problem, windowed_error};
use super::hypothesis::{ACTING, Hypothesis, Nuisance, Scales, WALL_NUMBERS, wall_number};
use super::trials::{Data, untouched};
use crate::experiment::file::{ExperimentFile, HypothesisTable, TestTable};
use crate::experiment::test_data::check_radians;
use crate::experiment::{Purpose, Test, TestData, load_tests, rest_offset_rad, windows};
use crate::limits::{MISREAD_LEAST_TESTS, MISREAD_TEST, MISREAD_TOGETHER, MOVES, TOO_LARGE_RAD};
use mrbd_files::error::{InputError, Result};
use mrbd_files::{FileNote, load_wall, toml_file};
use mrbd_kernel::model::{Wall, WallParameters};
use mrbd_kernel::simulate::Accuracy;
use rayon::prelude::*;

/// Wall, what was known of it, tests.
#[derive(Debug)]
pub struct Experiment {
    /// The experiment file.
    pub path: PathBuf,
    /// The wall file.
    pub wall_path: PathBuf,
    /// The wall before the diagnosis.
    pub wall: Wall,
    /// The wall file as written, to be written again with what is found.
    pub wall_table: toml::Table,
    /// What was uncertain of it.
    pub nuisances: Vec<Nuisance>,
    /// Laws of the user's own, tried beside the catalogue.
    pub hypotheses: Vec<HypothesisTable>,
    /// Whether the measured files are taken as they are.
    pub as_read: bool,
    /// What was measured.
    pub tests: Vec<TestData>,
    /// The same tests, for the error over whole runs (Eq. 8).
    pub whole: Vec<Test>,
    /// Sizes that matter.
    pub scales: Scales,
    /// The files that were read.
    pub inputs: Vec<FileNote>,
}

impl Experiment {
    /// Reads an experiment and every file it names.
    ///
    /// # Errors
    /// Input errors with file, key or line, what was found and what is allowed.
    pub fn load(path: &Path) -> Result<Self> {
        let file = ExperimentFile::load(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let wall_path = folder.join(&file.wall);
        let wall = load_wall(&wall_path)?;
        let wall_table = toml_file::load(&wall_path)?;
        if !wall.is_cracked() {
            let allowed = "a wall of two bodies: wall.crack_height_m given";
            return Err(InputError::key(&wall_path, "wall.crack_height_m", "no crack", allowed).into());
        }
        let nuisances = nuisances(path, &file, wall.parameters())?;
        let whole = load_tests(path, &file, &wall, Accuracy::default())?;
        let data = |(test, table): (&Test, &TestTable)| {
            TestData::new(test, &folder.join(&table.measured), table, &wall)
        };
        let tests = whole.iter().zip(&file.tests).map(data).collect::<Result<Vec<_>, _>>()?;
        let known = file.prior.get(SENSOR_GAIN).copied();
        let scales = Scales { sensor_gain_sd: known, ..Scales::of(&wall, &tests) };
        let note = |(role, file): (String, PathBuf)| FileNote::of(&role, &file);
        let read = file.files(path).into_iter().filter(|(role, _)| role != "coefficients");
        let inputs = read.map(note).collect::<Result<_>>()?;
        check_hypotheses(path, &file.hypotheses, wall.parameters())?;
        Ok(Self {
            path: path.to_path_buf(),
            hypotheses: file.hypotheses,
            as_read: file.as_read,
            wall_path,
            wall,
            wall_table,
            nuisances,
            tests,
            whole,
            scales,
            inputs,
        })
    }
}

/// Refuses laws of the user's own that the wall cannot have with the numbers that are written.
fn check_hypotheses(path: &Path, own: &[HypothesisTable], wall: &WallParameters) -> Result<(), InputError> {
    for (i, HypothesisTable { name, formula }) in own.iter().enumerate() {
        let key = |key: &str| format!("hypotheses[{i}].{key}");
        if own[..i].iter().any(|earlier| earlier.name == *name) {
            return Err(InputError::key(path, key("name"), format!("{name:?} again"), "each name once"));
        }
        if let Some(zero) = formula.parameters().iter().find(|parameter| parameter.value == 0.0) {
            let allowed = "a value of the size that is looked for, with its sign";
            return Err(InputError::key(path, key(&format!("parameters.{}", zero.name)), "0", allowed));
        }
        let mut with = wall.clone();
        with.formulas.push(formula.clone());
        Wall::new(with).map_err(|e| InputError::key(path, key(formula.place().key()), e.found, e.allowed))?;
    }
    Ok(())
}

fn nuisances(path: &Path, file: &ExperimentFile, wall: &WallParameters) -> Result<Vec<Nuisance>, InputError> {
    let mut found = Vec::new();
    for (key, &sd) in &file.prior {
        let number = |key: &str| wall_number(key).map(|n| Nuisance::Number(n, sd));
        match key.as_str() {
            SENSOR_GAIN => {}
            // A coefficient with a prior of its own keeps that.
            "restitution" => {
                let own = |l: &usize| file.prior.contains_key(&format!("C_{}", l + 1));
                found.extend((0..ACTING).filter(|l| !own(l)).map(|l| Nuisance::Coefficient(l, sd)));
            }
            key if acting(key).is_some() => found.extend(acting(key).map(|l| Nuisance::Coefficient(l, sd))),
            "corner_widths" => {
                found.extend(["lower_width_m", "upper_width_m"].iter().filter_map(|k| number(k)))
            }
            key => found.push(number(key).ok_or_else(|| {
                let known = WALL_NUMBERS.iter().map(|n| n.key).collect::<Vec<_>>().join(", ");
                let allowed = format!(
                    "restitution, C_1 to C_{ACTING}, corner_widths, {SENSOR_GAIN}, {known}, with or without the table's name"
                );
                InputError::key(
                    path,
                    format!("prior.{key}"),
                    "no number of a wall that can be uncertain",
                    allowed,
                )
            })?),
        }
        // A relative standard deviation says nothing of a number that is zero.
        if found.iter().any(|nuisance| nuisance.value(wall) == 0.0) {
            let told = "a prior of a number that is 0 in the wall file";
            let allowed = "priors of numbers that are not: they are shares; leave it out";
            return Err(InputError::key(path, format!("prior.{key}"), told, allowed));
        }
    }
    Ok(found)
}

/// Prior of what the sensors read of a rotation of one: no number of the wall.
pub const SENSOR_GAIN: &str = "sensor_gain";

/// The place of a coefficient `C_1`, `C_2` ... that acts under the law `contact`.
fn acting(key: &str) -> Option<usize> {
    let l = key.strip_prefix("C_")?.parse::<usize>().ok()?;
    l.checked_sub(1).filter(|l| *l < ACTING)
}

type Misreading = (&'static str, fn(&mut TestData));

/// Ways in which a measured file is wrong, and what puts it right; those first that hardly show in a single test.
const MISREADINGS: [Misreading; 5] = [
    ("theta1_rad and theta2_rad are swapped", |test| {
        test.theta_rad.iter_mut().for_each(|theta| theta.swap(0, 1));
        test.noise_rad.swap(0, 1);
    }),
    ("both rotations have the wrong sign", |test| {
        test.theta_rad.iter_mut().flatten().for_each(|theta| *theta = -*theta);
    }),
    ("the sign of theta1_rad is wrong", |test| {
        test.theta_rad.iter_mut().for_each(|theta| theta[0] = -theta[0]);
    }),
    ("the sign of theta2_rad is wrong", |test| {
        test.theta_rad.iter_mut().for_each(|theta| theta[1] = -theta[1]);
    }),
    ("rotations are in degrees", |test| {
        test.theta_rad.iter_mut().flatten().for_each(|theta| *theta = theta.to_radians());
        test.noise_rad = test.noise_rad.map(f64::to_radians);
    }),
];

/// So many of [`MISREADINGS`] are looked at over all tests too.
const FOUND_TOGETHER: usize = 2;
/// Those in which one sign is wrong.
const ONE_SIGN: std::ops::Range<usize> = 2..4;
/// Noises of their difference within which two rotations are the same: beyond it lie three in a thousand.
const SAME: f64 = 3.0;
/// So many times as often as one another's opposite are rotations the same that have their signs right. Chosen: of 28 tests with one sign made
/// wrong none was let through by it, and a shut crack makes them the same all the time.
const AS_ONE: usize = 2;
/// In so many samples at least. Chosen: those of a shut crack, not of a passage.
const LEAST_AS_ONE: usize = 20;

/// What is checked: a wall as given, and its tests as they were read, each with its number in the experiment.
#[derive(Debug, Clone, Copy)]
struct Readings<'a> {
    path: &'a Path,
    wall: &'a Wall,
    scales: &'a Scales,
    tests: &'a [(usize, &'a TestData)],
}

/// Windowed error of the wall as given in a test, and by every misreading put right.
struct Errors {
    /// As it stands, or without a gain between its channels if that leaves less. A gain makes a closed crack look
    /// open, and to the other side once the channels are swapped.
    as_it_stands: f64,
    put_right: [Option<f64>; MISREADINGS.len()],
}

impl Errors {
    /// `None` where nothing moves.
    fn of(readings: &Readings, test: &TestData) -> Option<Self> {
        let read = |change: fn(&mut TestData)| {
            let mut other = test.clone();
            change(&mut other);
            other.rest_offset_rad = rest_offset_rad(&other.theta_rad, other.noise_rad);
            misfit(readings, &other)
        };
        let as_it_stands = misfit(readings, test)?;
        let as_it_stands = read(without_gain).map_or(as_it_stands, |other| other.min(as_it_stands));
        let mut put_right = MISREADINGS.map(|(_, put_right)| read(put_right));
        if moves_as_one(test) {
            put_right[ONE_SIGN].fill(None);
        }
        Some(Self { as_it_stands, put_right })
    }

    fn share(&self, misreading: usize) -> Option<f64> {
        Some(self.put_right[misreading]? / self.as_it_stands)
    }
}

/// Refuses tests whose files are wrong in a way that shows: swapped channels, wrong signs, small rotations in degrees. Those of an
/// experiment that says `as_read` are taken as they are.
///
/// # Errors
/// Input errors that name the test and what seems wrong with it.
pub fn check_data(experiment: &Experiment) -> Result<()> {
    let Experiment { path, wall, scales, tests, as_read, .. } = experiment;
    if *as_read {
        return Ok(());
    }
    // Of a held strip one channel is measured: there is none to swap.
    let both = tests.iter().enumerate().filter(|(_, test)| !test.manner.top_held);
    check(&Readings { path, wall, scales, tests: &both.collect::<Vec<_>>() })
}

/// The same for the tests of a calibration, with the wall as it is before.
///
/// A calibration also takes what a diagnosis does not: one channel only, a few samples, no noise, a wall of one block.
/// Of such tests the size of the rotations alone is checked.
///
/// # Errors
/// As [`check_data`].
pub fn check_tests(path: &Path, wall: &Wall, tests: &[Test]) -> Result<()> {
    let file = ExperimentFile::load(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut readable = Vec::new();
    for (number, (test, table)) in tests.iter().zip(&file.tests).enumerate() {
        let measured = folder.join(&table.measured);
        if !has_fallen(test) {
            check_radians(test, &measured, table)?;
        }
        readable.extend(TestData::new(test, &measured, table, wall).ok().map(|data| (number, data)));
    }
    if file.as_read || readable.is_empty() || !wall.is_cracked() {
        return Ok(());
    }
    let (numbers, data): (Vec<usize>, Vec<TestData>) = readable.into_iter().unzip();
    let scales = Scales::of(wall, &data);
    let tests = numbers.into_iter().zip(&data).collect::<Vec<_>>();
    check(&Readings { path, wall, scales: &scales, tests: &tests })
}

/// Whether a wall falls in a test and lies from then on: then its rotations may be as large as degrees.
///
/// Read in degrees a standing wall is as far off, but comes back.
fn has_fallen(test: &Test) -> bool {
    let lies = |theta: &Vec<f64>| {
        let far = |theta: &&f64| theta.abs() > TOO_LARGE_RAD;
        let mut from_fall =
            theta.iter().filter(|theta| theta.is_finite()).skip_while(|theta| !far(theta)).peekable();
        from_fall.peek().is_some() && from_fall.all(|theta| far(&theta))
    };
    test.measured.theta_rad.iter().flatten().any(lies)
}

fn check(readings: &Readings) -> Result<()> {
    let errors = readings.tests.par_iter().map(|(_, test)| Errors::of(readings, test)).collect::<Vec<_>>();
    let refuse = |key: String, whose: String, (misreading, share): (usize, f64)| {
        let found = format!(
            "{whose}: it seems that {}, which leaves {:.0} % of the windowed error",
            MISREADINGS[misreading].0,
            100.0 * share
        );
        let allowed = "radians: theta1_rad of the lower and theta2_rad of the upper body, clockwise positive; \
                       or as_read = true in the experiment, where they are right";
        Err(InputError::key(readings.path, key, found, allowed).into())
    };
    for (own, (number, test)) in errors.iter().zip(readings.tests) {
        if let Some(likeliest) = likeliest(|misreading| own.as_ref()?.share(misreading), MISREAD_TEST) {
            let name = &test.name;
            return refuse(format!("tests[{number}].measured"), format!("test {name:?}"), likeliest);
        }
    }
    let together = |misreading: usize| {
        let shares = errors.iter().flatten().filter_map(|own| own.share(misreading)).collect::<Vec<_>>();
        let mean = shares.iter().map(|share| share.ln()).sum::<f64>() / shares.len() as f64;
        (misreading < FOUND_TOGETHER && shares.len() >= MISREAD_LEAST_TESTS).then(|| mean.exp())
    };
    match likeliest(together, MISREAD_TOGETHER) {
        Some(likeliest) => refuse("tests".to_owned(), "all tests".to_owned(), likeliest),
        None => Ok(()),
    }
}

/// Whether both bodies turn as one while the crack is shut, as they are read: then neither sign is wrong, whatever the wall as given does
/// worse than under another sign. Bodies turn as one's opposite only in passing.
fn moves_as_one(test: &TestData) -> bool {
    let [lower, upper] = test.noise_rad;
    let moves = |theta: &&[f64; 2]| theta[0].abs() > MOVES * lower && theta[1].abs() > MOVES * upper;
    let moving = test.theta_rad.iter().filter(moves);
    let near = |x: f64| x.abs() < SAME * lower.hypot(upper);
    let count = |of: fn(&[f64; 2]) -> f64| moving.clone().filter(|theta| near(of(theta))).count();
    let [same, opposite] = [count(|theta| theta[0] - theta[1]), count(|theta| theta[0] + theta[1])];
    same >= LEAST_AS_ONE && same > AS_ONE * opposite
}

/// The upper channel over what it reads of the lower, in least squares.
fn without_gain(test: &mut TestData) {
    let both = test.theta_rad.iter().filter(|theta| theta.iter().all(|t| t.is_finite()));
    let [own, across] =
        both.fold([0.0; 2], |[own, across], [lower, upper]| [own + lower * lower, across + lower * upper]);
    let gain = across / own;
    if gain.is_finite() && gain > 0.0 {
        test.theta_rad.iter_mut().for_each(|theta| theta[1] /= gain);
        test.noise_rad[1] /= gain;
    }
}

/// The misreading of least share, if that is below a limit.
fn likeliest(share: impl Fn(usize) -> Option<f64>, limit: f64) -> Option<(usize, f64)> {
    let shares = (0..MISREADINGS.len()).filter_map(|misreading| Some((misreading, share(misreading)?)));
    shares.filter(|(_, share)| *share < limit).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Windowed errors of a wall as it is in the tests of an experiment, in units of their noise: over those to fit,
/// and over those held out. `None` where nothing moves.
pub fn windowed_errors(experiment: &Experiment, wall: &Wall) -> [Option<f64>; 2] {
    let of = |purpose: Purpose| {
        let tests = experiment.tests.iter().filter(|test| test.purpose == purpose).cloned();
        error_in(&tests.collect::<Vec<_>>(), wall, &experiment.scales)
    };
    [Purpose::Fit, Purpose::HoldOut].map(of)
}

/// Windowed error of a wall as it is in some tests; `None` where nothing moves.
fn error_in(tests: &[TestData], wall: &Wall, scales: &Scales) -> Option<f64> {
    let windows = windows(tests);
    let all = Problem { tests, windows: &windows, budget: None };
    let data = Data { fit: all, held_out: Problem { windows: &[], ..all } };
    let h = Hypothesis::new(wall.parameters(), scales, &[], &[]);
    windowed_error(&untouched(&data, h)?.fit.windows).filter(|error| *error > 0.0)
}

/// Windowed error of the wall as given in one test; `None` where nothing moves.
fn misfit(readings: &Readings, test: &TestData) -> Option<f64> {
    error_in(std::slice::from_ref(test), readings.wall, readings.scales)
}

#[cfg(test)]
mod tests {
    use super::super::discovery::twin::{tests_of, wall_with};
    use super::*;

    #[test]
    fn analytic_bodies_that_turn_as_one_have_their_signs_right() {
        for test in tests_of(&wall_with(""), 3e-5) {
            assert!(moves_as_one(&test));
            let mut wrong = test.clone();
            wrong.theta_rad.iter_mut().for_each(|theta| theta[1] = -theta[1]);
            assert!(!moves_as_one(&wrong), "one sign");
            // A crack that is open tells neither.
            wrong.theta_rad.iter_mut().for_each(|theta| theta[1] *= 3.0);
            assert!(!moves_as_one(&wrong));
        }
    }
}
