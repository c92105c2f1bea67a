//! `mrbd describe`: what a wall file means, before any run.

use std::path::{Path, PathBuf};

use clap::Args;

use super::output;
use crate::error::Result;
use crate::report::wall_svg;
use crate::store::write_durably;
use mrbd_files::description::{Body, Description};
use mrbd_files::load_wall;
use mrbd_kernel::model::{FurtherLaw, Wall};

/// Describe a wall: weight, slenderness, what it takes to rock, and whether a number looks like a slip.
///
/// Nothing is simulated. The accelerations are steady ones: limits of equilibrium
/// of the wall at rest, below which it does not move.
///
/// Examples:
///   mrbd describe wall.toml
///   mrbd describe wall.toml --plot wall.svg
///   mrbd describe wall.toml --json
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct DescribeCommand {
    /// Wall file (TOML).
    wall: PathBuf,
    /// Draw the wall into an .svg file.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

impl DescribeCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Input errors of the wall file; a drawing that cannot be written.
    pub fn execute(&self) -> Result<()> {
        let wall = load_wall(&self.wall)?;
        output::check_apart("--plot", self.plot.as_deref(), &[&self.wall])?;
        let description = Description::of(&wall);
        if let Some(path) = &self.plot {
            output::check_svg(path)?;
            write_durably(path, wall_svg(&wall, &description).as_bytes())?;
        }
        print_questions(&self.wall, &wall);
        output::print(&if self.json {
            format!("{:#}", serde_json::json!(description))
        } else {
            for_people(&wall, &description)
        })
    }
}

/// Asks about numbers of a wall that few walls have, on stderr.
pub(super) fn print_questions(path: &Path, wall: &Wall) {
    for question in mrbd_files::slips::questions(wall) {
        eprintln!("mrbd: note: {}: {question}", path.display());
    }
}

fn for_people(wall: &Wall, d: &Description) -> String {
    let mut lines = vec![
        line("size", &size(d)),
        line(
            "mass",
            &format!("{:.1} kg, {:.2} kN, {:.0} kg/m3", d.mass_kg, d.weight_n / 1e3, d.density_kg_m3),
        ),
        line("whole wall", &format!("α = {:.5} rad", d.alpha_rad)),
    ];
    match &d.upper {
        None => lines.push(line("one body", &body(&d.lower))),
        Some(upper) => lines.extend([line("lower body", &body(&d.lower)), line("upper body", &body(upper))]),
    }
    lines.extend([
        line("begins to rock", &opening(d)),
        line("top", &top(d)),
        line("impacts", &impacts(wall)),
    ]);
    let effects = d.effects.iter().map(FurtherLaw::in_words).collect::<Vec<_>>().join(", ");
    lines.push(line("effects", if effects.is_empty() { "none beside the wall's own" } else { &effects }));
    lines.join("\n")
}

fn line(name: &str, text: &str) -> String {
    format!("{name:<16}{text}")
}

fn size(d: &Description) -> String {
    let crack = match d.upper {
        Some(_) => format!("cracked at {} m, {:.2} h", d.lower.height_m, d.lower.height_m / d.height_m),
        None => "not cracked".to_owned(),
    };
    let Description { thickness_m, height_m, length_m, slenderness, .. } = d;
    format!("{thickness_m} m thick, {height_m} m high, {length_m} m long, h/b = {slenderness:.2}, {crack}")
}

fn body(b: &Body) -> String {
    let (width_m, crushed_mm) = (b.width_m, 1e3 * b.crushed_m);
    format!(
        "{:.1} kg, {:.3} m high, rocks on {width_m:.3} m ({crushed_mm:.1} mm of the thickness crushed), α = {:.5} rad",
        b.mass_kg, b.height_m, b.alpha_rad
    )
}

fn opening(d: &Description) -> String {
    let ground = format!("at a steady {:.4} g at the ground", d.opening.ground_g);
    let crack = d.opening.crack_g.map(|crack_g| format!(", {crack_g:.4} g at the crack"));
    ground + &crack.unwrap_or_default()
}

fn top(d: &Description) -> String {
    let t = &d.top;
    let period = t.period_s.map_or_else(
        || "no period: no mass or no spring".to_owned(),
        |period_s| format!("period of the masses on it {period_s:.3} s"),
    );
    let (m_d, m_dp, k_d) = (t.mass_kg, t.carriage_mass_kg, t.stiffness_n_per_m);
    format!("m_d = {m_d} kg, m_dp = {m_dp} kg, k_d = {k_d} N/m, {period}")
}

fn impacts(wall: &Wall) -> String {
    let r = &wall.parameters().restitution;
    let coefficients = wall.coefficients().map(|c| c.to_string()).join(" ");
    format!("C_1 … C_8 = {coefficients}, law {}, capture at {} rad/s", r.law.name(), r.capture_velocity_rad_s)
}
