//! `mrbd push`: force against displacement of a wall that is pushed slowly.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::{Answer, output};
use crate::assessment::push::{FILES, KIND, Measured, PushCurve, PushPoint, Pushed, Question};
use crate::error::{Error, InputError, Result};
use crate::report::push_svg;
use crate::store::{WholeFolder, write_durably};
use mrbd_files::{FileNote, load_static_wall};
use mrbd_statics::{Load, Side};

/// Softest and stiffest bed of --bed, Pa/m.
const BEDS_PA_PER_M: std::ops::RangeInclusive<f64> = 1e6..=1e15;

/// Push a wall slowly until it falls: force, and force over its weight, against displacement.
///
/// The wall follows its equilibrium with finite rotations, on the corners of its file and on the springs at its top.
/// Beside it stands the rigid line: the same wall on the sharp edges of its full thickness.
/// stdout has one line a state; what is asked first goes to stderr.
///
/// Examples:
///   mrbd push wall.toml --at uniform
///   mrbd push wall.toml --at crack --plot push.svg --json
///   mrbd push wall.toml --at crack --held --bed 2.7e8 --measured push.csv --out outputs/push
#[derive(Debug, Args)]
#[command(verbatim_doc_comment, allow_negative_numbers = true)]
pub struct PushCommand {
    /// Wall file (TOML).
    wall: PathBuf,
    /// Where it is pushed: a point force at the crack, a uniform acceleration of all masses, a point force at the top.
    #[arg(long, value_enum, default_value = "uniform")]
    at: At,
    /// Towards which side.
    #[arg(long, value_enum, default_value = "right")]
    side: Towards,
    /// Hold the top by a rigid support instead of the wall's own springs.
    #[arg(long)]
    held: bool,
    /// Put a bed of this stiffness into both joints instead of the wall's own, Pa/m.
    #[arg(long, value_name = "PA_PER_M")]
    bed: Option<f64>,
    /// A measured push (CSV: displacement_m, force_n, or displacement_over_thickness, force_over_weight).
    #[arg(long, value_name = "FILE")]
    measured: Option<PathBuf>,
    /// Draw the curves into an .svg file.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Write push.json, push.csv and a page into a folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace the results in that folder.
    #[arg(long, requires = "out")]
    force: bool,
    /// Print everything as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum At {
    Crack,
    Uniform,
    Top,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Towards {
    Right,
    Left,
}

impl PushCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Bad input; results that cannot be written.
    pub fn execute(self) -> Result<()> {
        self.answer()?.print(self.json)
    }

    /// Pushes the wall and writes what is to be written; nothing is printed.
    ///
    /// # Errors
    /// As [`PushCommand::execute`].
    pub fn answer(&self) -> Result<Answer> {
        let wall = load_static_wall(&self.wall)?;
        let read = [Some(&self.wall), self.measured.as_ref()];
        let read = read.into_iter().flatten().map(PathBuf::as_path).collect::<Vec<_>>();
        output::check_apart("--plot", self.plot.as_deref(), &read)?;
        self.plot.as_deref().map(output::check_svg).transpose()?;
        let folder =
            self.out.as_deref().map(|out| WholeFolder::check(out, &FILES, self.force)).transpose()?;
        let mut pushed = self.question()?.answer(&wall, &name(&self.wall));
        pushed.measured = self.measured.as_deref().map(|path| Measured::read(path, &pushed)).transpose()?;
        if let Some(path) = &self.plot {
            write_durably(path, push_svg(&pushed).as_bytes())?;
        }
        let page = folder.map(|folder| self.write(folder.cleared()?, &pushed)).transpose()?;
        Ok(Answer { json: as_json(&pushed)?, text: csv_text(&pushed)?, notes: notes(&pushed), page })
    }

    fn question(&self) -> Result<Question> {
        if let Some(bed) = self.bed.filter(|bed| !BEDS_PA_PER_M.contains(bed)) {
            let allowed = format!("{:e} to {:e} Pa/m", BEDS_PA_PER_M.start(), BEDS_PA_PER_M.end());
            return Err(InputError::option("--bed", bed.to_string(), allowed).into());
        }
        Ok(Question {
            load: match self.at {
                At::Crack => Load::Crack,
                At::Uniform => Load::Uniform,
                At::Top => Load::Top,
            },
            side: match self.side {
                Towards::Right => Side::Right,
                Towards::Left => Side::Left,
            },
            bed_pa_per_m: self.bed,
            held: self.held,
        })
    }

    fn write(&self, folder: &Path, pushed: &Pushed) -> Result<PathBuf> {
        let [manifest, json, csv] = FILES.map(|name| folder.join(name));
        let notes = [("wall", Some(&self.wall)), ("measured", self.measured.as_ref())];
        let notes = notes.into_iter().filter_map(|(role, path)| Some((role, path?)));
        let notes = notes.map(|(role, path)| FileNote::of(role, path).map(|note| note.seen_from(folder)));
        output::write_manifest(
            &manifest,
            KIND,
            &pushed.wall,
            notes.collect::<mrbd_files::Result<_>>()?,
            None,
        )?;
        write_durably(&json, as_json(pushed)?.as_bytes())?;
        write_durably(&csv, csv_text(pushed)?.as_bytes())?;
        super::report::write_page(folder, None)
    }
}

/// The last part of a path.
fn name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

fn as_json(pushed: &Pushed) -> Result<String> {
    let text = serde_json::to_string_pretty(pushed);
    text.map_err(|e| Error::io("write the push", Path::new("push.json"), e.into()))
}

/// One row a state of the wall as it is.
fn csv_text(pushed: &Pushed) -> Result<String> {
    let fault = |e: csv::Error| Error::table(Path::new("push.csv"), e);
    let mut writer = csv::Writer::from_writer(Vec::new());
    for point in &pushed.curve.points {
        writer.serialize::<&PushPoint>(point).map_err(fault)?;
    }
    let bytes = writer.into_inner().map_err(|e| fault(e.into_error().into()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// What people ask first.
fn notes(pushed: &Pushed) -> Vec<String> {
    let of = |name: &str, curve: &PushCurve| {
        let end = curve
            .end_m
            .map_or("; the force does not vanish before it counts as fallen".to_owned(), |end_m| {
                format!(", none at {end_m:.4} m")
            });
        format!(
            "{name} bears {:.4} of its weight at {:.4} m of the {}{end}",
            curve.largest_force_over_weight, curve.largest_at_m, pushed.displacement_of
        )
    };
    let mut notes = vec![of("the wall", &pushed.curve), of("its rigid line", &pushed.rigid)];
    notes.extend(pushed.measured.iter().map(|measured| {
        format!(
            "{} points of {} differ from the wall by {:.4} of its weight (root mean square), {:.4} at most; from the rigid line by {:.4}",
            measured.points.len(),
            measured.file,
            measured.rms_over_weight,
            measured.largest_over_weight,
            measured.rigid_rms_over_weight
        )
    }));
    notes
}
