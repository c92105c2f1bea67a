//! The data behind the figures of a diagnosis, in Parquet beside `diagnosis.json`.
//!
//! ```text
//! histories.parquet     every sample: measured, simulated before and after, patterns, errors over windows
//! windows.parquet       every window: its error under the wall as given, recalibrated and updated, and its impacts
//! force.parquet         the missing force at the top, stretch by stretch, and what the updated wall leaves of it
//! jumps.parquet         velocities after impacts over those of the model
//! laws.parquet          laws of the best hypotheses, to be drawn through the force
//! rivals.parquet        every hypothesis that was tried, a row a number
//! ```

use std::borrow::Cow;
use std::path::Path;

use crate::error::Result;
use crate::store::{Column, Read, write_table};
use mrbd_lab::diagnose::answer::Tables;
use mrbd_lab::diagnose::answer::rows::{ForceRow, JumpRow, LawPoint, RivalRow, Sample, WindowRow};

/// Names of the tables.
pub const TABLES: [&str; 6] = [
    "histories.parquet",
    "windows.parquet",
    "force.parquet",
    "jumps.parquet",
    "laws.parquet",
    "rivals.parquet",
];

/// Writes all of them.
///
/// # Errors
/// [`crate::Error::Table`] or [`mrbd_files::Error::Io`] if the disk refuses.
pub fn write_tables(folder: &Path, tables: &Tables) -> Result<()> {
    let [samples, windows, force, jumps, laws, rivals] = TABLES.map(|name| folder.join(name));
    write_table(&samples, &SAMPLES, &[], &tables.samples)?;
    write_table(&windows, &WINDOWS, &[], &tables.windows)?;
    write_table(&force, &FORCE, &[], &tables.force)?;
    write_table(&jumps, &JUMPS, &[], &tables.jumps)?;
    write_table(&laws, &LAWS, &[], &tables.laws)?;
    write_table(&rivals, &RIVALS, &[], &tables.rivals)
}

fn finite(x: f64) -> Option<f64> {
    Some(x).filter(|x| x.is_finite())
}

fn theta(sample: &Sample, when: usize, body: usize) -> Option<f64> {
    sample.simulated[when].map(|(theta, _)| theta[body])
}

fn pattern(sample: &Sample, when: usize) -> Option<Cow<'_, str>> {
    sample.simulated[when].map(|(_, contact)| contact.name().into())
}

fn error(sample: &Sample, when: usize, body: usize) -> Option<f64> {
    sample.residual[when].map(|r| r[body])
}

/// `histories.parquet`: measured against simulated, sample by sample.
static SAMPLES: [Column<Sample>; 16] = [
    Column::input("test", "", "test", Read::Text(|s| Some(s.test.as_str().into()))),
    Column::input("use", "", "fit or hold-out", Read::Text(|s| Some(s.purpose.name().into()))),
    Column::input("time_s", "s", "time in the record", Read::Number(|s: &Sample| Some(s.time_s))).distinct(),
    Column::result(
        "theta1_measured_rad",
        "rad",
        "rotation of the lower body, measured",
        Read::Number(|s| finite(s.measured_rad[0])),
    ),
    Column::result(
        "theta2_measured_rad",
        "rad",
        "rotation of the upper body, measured",
        Read::Number(|s| finite(s.measured_rad[1])),
    ),
    Column::result(
        "pattern_measured",
        "",
        "pattern, where the measurement leaves no doubt",
        Read::Text(|s| s.measured_contact.map(|c| c.name().into())),
    ),
    Column::result(
        "theta1_before_rad",
        "rad",
        "θ_1 of a whole run of the wall as given",
        Read::Number(|s| theta(s, 0, 0)),
    ),
    Column::result("theta2_before_rad", "rad", "θ_2 of the same", Read::Number(|s| theta(s, 0, 1))),
    Column::result("pattern_before", "", "its pattern", Read::Text(|s| pattern(s, 0))),
    Column::result(
        "theta1_after_rad",
        "rad",
        "θ_1 of a whole run of the updated wall",
        Read::Number(|s| theta(s, 1, 0)),
    ),
    Column::result("theta2_after_rad", "rad", "θ_2 of the same", Read::Number(|s| theta(s, 1, 1))),
    Column::result("pattern_after", "", "its pattern", Read::Text(|s| pattern(s, 1))),
    Column::result(
        "error1_before",
        "",
        "measured less simulated θ_1 over its noise, in windows, wall as given",
        Read::Number(|s| error(s, 0, 0)),
    ),
    Column::result("error2_before", "", "the same of θ_2", Read::Number(|s| error(s, 0, 1))),
    Column::result("error1_after", "", "the same of θ_1, updated wall", Read::Number(|s| error(s, 1, 0))),
    Column::result("error2_after", "", "the same of θ_2, updated wall", Read::Number(|s| error(s, 1, 1))),
];

macro_rules! impacts {
    ($name:literal, $meaning:literal, $l:literal) => {
        Column::result($name, "", $meaning, Read::Count(|r| Some(r.impacts.table2[$l])))
    };
}

/// `windows.parquet`: how well every window is followed, and what happens in it.
static WINDOWS: [Column<WindowRow>; 17] = [
    Column::input("test", "", "test", Read::Text(|r| Some(r.test.as_str().into()))),
    Column::input("use", "", "fit or hold-out", Read::Text(|r| Some(r.purpose.name().into()))),
    Column::input("from_s", "s", "first sample", Read::Number(|r: &WindowRow| Some(r.from_s))).distinct(),
    Column::input("to_s", "s", "last sample", Read::Number(|r: &WindowRow| Some(r.to_s))).distinct(),
    Column::input("pattern", "", "pattern at its start", Read::Text(|r| Some(r.contact.name().into()))),
    Column::result(
        "error_before",
        "",
        "root mean square error over the noise, wall as given",
        Read::Number(|r| r.error[0]),
    ),
    Column::result(
        "error_recalibrated",
        "",
        "the same, its uncertain numbers fitted",
        Read::Number(|r| r.error[1]),
    ),
    Column::result("error_after", "", "the same, updated wall", Read::Number(|r| r.error[2])),
    impacts!("impacts_c1", "impacts 1a to 2a of the updated wall in it", 0),
    impacts!("impacts_c2", "2a to 1a", 1),
    impacts!("impacts_c3", "1a to 2b", 2),
    impacts!("impacts_c4", "2a to 1b", 3),
    impacts!("impacts_c5", "3a to 1b", 4),
    impacts!("impacts_c6", "3a to 3b", 5),
    impacts!("impacts_c7", "1a to 3a", 6),
    impacts!("impacts_c8", "2a to 3a", 7),
    Column::result("impacts_other", "", "impacts not in Table 2", Read::Count(|r| Some(r.impacts.other))),
];

/// `force.parquet`: the missing force at the top.
static FORCE: [Column<ForceRow>; 13] = [
    Column::input("test", "", "test", Read::Text(|r| Some(r.test.as_str().into()))),
    Column::input("use", "", "fit or hold-out", Read::Text(|r| Some(r.purpose.name().into()))),
    Column::input("time_s", "s", "middle of the stretch", Read::Number(|r: &ForceRow| Some(r.point.time_s)))
        .distinct(),
    Column::input("pattern", "", "pattern", Read::Text(|r| Some(r.point.contact.name().into()))),
    Column::result(
        "displacement_m",
        "m",
        "displacement of the top, relative to the ground",
        Read::Number(|r| Some(r.point.displacement_m)),
    ),
    Column::result("velocity_m_s", "m/s", "its velocity", Read::Number(|r| Some(r.point.velocity_m_s))),
    Column::result(
        "acceleration_m_s2",
        "m/s²",
        "its absolute acceleration",
        Read::Number(|r| Some(r.point.acceleration_m_s2)),
    ),
    Column::result(
        "moment1_n_m",
        "N m",
        "missing moment on θ_1; on both bodies together in pattern 3",
        Read::Number(|r| r.point.moment_n_m[0]),
    ),
    Column::result("moment2_n_m", "N m", "missing moment on θ_2", Read::Number(|r| r.point.moment_n_m[1])),
    Column::result(
        "force_n",
        "N",
        "horizontal force at the top that comes nearest to them",
        Read::Number(|r| Some(r.point.force_n)),
    ),
    Column::result(
        "force_sd_n",
        "N",
        "its standard deviation by the noise",
        Read::Number(|r| Some(r.point.force_sd_n)),
    ),
    Column::result(
        "share_off_top",
        "",
        "share of the squared moments off the direction of such a force; null where noise, or one moment, has none",
        Read::Number(|r| r.point.share_off_top),
    ),
    Column::result(
        "force_after_n",
        "N",
        "the same force as the updated wall leaves it",
        Read::Number(|r| r.after_n),
    ),
];

/// `jumps.parquet`: velocities after impacts.
static JUMPS: [Column<JumpRow>; 9] = [
    Column::input("test", "", "test", Read::Text(|r| Some(r.test.as_str().into()))),
    Column::input("wall", "", "given or updated", Read::Text(|r| Some(r.wall.into()))),
    Column::input(
        "time_s",
        "s",
        "when the pattern was clear again",
        Read::Number(|r: &JumpRow| Some(r.jump.time_s)),
    )
    .distinct(),
    Column::input(
        "pattern_before",
        "",
        "measured pattern before",
        Read::Text(|r| Some(r.jump.contacts[0].name().into())),
    ),
    Column::input(
        "pattern_after",
        "",
        "measured pattern after",
        Read::Text(|r| Some(r.jump.contacts[1].name().into())),
    ),
    Column::result(
        "impacts",
        "",
        "impacts of the model on the way",
        Read::Count(|r| Some(r.jump.impacts.total())),
    ),
    Column::result(
        "coefficient",
        "",
        "1 to 8 where its only impact is that change of Table 2",
        Read::Count(|r| r.jump.coefficient().map(|l| l as u64 + 1)),
    ),
    Column::result(
        "ratio",
        "",
        "velocities measured after it over those of the model; null where the model is in another pattern",
        Read::Number(|r| r.jump.ratio),
    ),
    Column::result(
        "ratio_sd",
        "",
        "standard deviation of the ratio by noise",
        Read::Number(|r| r.jump.ratio_sd),
    ),
];

/// `laws.parquet`: what the best hypotheses add to the force at the top.
static LAWS: [Column<LawPoint>; 6] = [
    Column::input("name", "", "hypothesis", Read::Text(|r| Some(r.name.as_str().into()))),
    Column::input(
        "against",
        "",
        "column of force.parquet that x is of",
        Read::Text(|r| Some(r.against.name().into())),
    ),
    Column::input(
        "x",
        "",
        "displacement, velocity or absolute acceleration of the top, SI",
        Read::Number(|r: &LawPoint| Some(r.x)),
    )
    .distinct(),
    Column::result(
        "force_n",
        "N",
        "force that the hypothesis adds at the top",
        Read::Number(|r| Some(r.force_n)),
    ),
    Column::result(
        "force_low_n",
        "N",
        "lower end of its 90 % interval, for a law outside the catalogue",
        Read::Number(|r| r.interval_n.map(|[low, _]| low)),
    ),
    Column::result("force_high_n", "N", "upper end", Read::Number(|r| r.interval_n.map(|[_, high]| high))),
];

/// `rivals.parquet`: every hypothesis that was tried.
static RIVALS: [Column<RivalRow>; 11] = [
    Column::input("rank", "", "1: what least speaks against", Read::Count(|r| Some(r.rank))),
    Column::input("name", "", "what is added to the wall", Read::Text(|r| Some(r.name.as_str().into()))),
    Column::input("place", "", "where it acts", Read::Text(|r| Some(r.place.into()))),
    Column::input(
        "is_answer",
        "",
        "an effect, no number of the wall and no placebo",
        Read::Flag(|r| Some(r.is_answer)),
    ),
    Column::input("parameter", "", "its number", Read::Text(|r| Some(r.parameter.as_str().into()))),
    Column::input("unit", "", "unit of the value", Read::Text(|r| Some(r.unit.into()))),
    Column::result("value", "", "fitted value", Read::Number(|r| Some(r.value))),
    Column::result("sd", "", "standard deviation by the curvature of the fit", Read::Number(|r| r.sd)),
    Column::result(
        "error_fit",
        "",
        "windowed error over the noise, tests to fit",
        Read::Number(|r| r.error[0]),
    ),
    Column::result("error_held_out", "", "the same, tests held out", Read::Number(|r| r.error[1])),
    Column::result(
        "against",
        "",
        "what speaks against it, natural logarithms of likelihood",
        Read::Number(|r| Some(r.against)),
    ),
];
