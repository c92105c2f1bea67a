//! `mrbd effects`: the catalogue of further effects that a wall file may have.

mod formula;

use clap::Args;
use serde::Serialize;

use self::formula::FormulaEntry;
use super::output;
use crate::error::{InputError, Result};
use crate::text::wrapped;
use mrbd_formula::Formula;
use mrbd_kernel::model::{EffectKind, EffectParameter, Place};

/// List the further effects that a wall file may have, with an example of each.
///
/// Examples:
///   mrbd effects
///   mrbd effects gap coulomb_friction
///   mrbd effects --json
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct EffectsCommand {
    /// Kinds to list; none: all.
    kinds: Vec<String>,
    /// Print the catalogue as JSON.
    #[arg(long)]
    json: bool,
}

/// One effect as it stands in a wall file.
#[derive(Debug, Serialize)]
struct Example<L> {
    effects: [L; 1],
}

/// What can be listed: a kind of the catalogue, or formulas.
enum Listed {
    Kind(EffectKind),
    Formula(FormulaEntry),
}

impl EffectsCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// A kind that there is not.
    pub fn execute(&self) -> Result<()> {
        let formula = || Listed::Formula(FormulaEntry::new());
        let named = |name: &String| match name == Formula::KIND {
            true => Ok(formula()),
            false => EffectKind::named(name).map(Listed::Kind).map_err(|e| no_kind(name, &e.to_string())),
        };
        let listed = match &self.kinds[..] {
            [] => EffectKind::ALL.iter().copied().map(Listed::Kind).chain([formula()]).collect(),
            names => names.iter().map(named).collect::<Result<Vec<_>, _>>()?,
        };
        output::print(&if self.json {
            format!("{:#}", serde_json::json!(listed.iter().map(Listed::json).collect::<Vec<_>>()))
        } else {
            listed.iter().map(Listed::for_people).collect::<Vec<_>>().join("\n\n\n")
        })
    }
}

impl Listed {
    fn json(&self) -> serde_json::Value {
        match self {
            Listed::Kind(kind) => serde_json::json!(kind.entry()),
            Listed::Formula(formula) => serde_json::json!(formula),
        }
    }

    fn for_people(&self) -> String {
        match self {
            Listed::Kind(kind) => for_people(*kind),
            Listed::Formula(formula) => formula.for_people(),
        }
    }
}

fn no_kind(name: &str, message: &str) -> InputError {
    let allowed = message.split_once(", expected ").map_or(message, |(_, allowed)| allowed);
    InputError::option("KINDS", format!("{name:?}"), allowed)
}

fn place(place: Place) -> &'static str {
    match place {
        Place::Top => "at the top",
        Place::Joint => "at a joint",
        Place::Impacts => "at impacts",
        Place::GroundMotion => "in the ground motion",
        Place::Sensor => "in the reading of the rotations",
    }
}

fn for_people(kind: EffectKind) -> String {
    let entry = kind.entry();
    let mut lines = vec![format!("{} — {}", entry.name, place(entry.place))];
    lines.push(indented(entry.description));
    lines.push(format!("  {}", entry.law));
    if let Some(choice) = entry.choice {
        lines.push(format!("  {}: {}; {}", choice.key, choice.options.join(" or "), choice.meaning));
    }
    lines.extend(entry.parameters.iter().map(bounds));
    lines.push(indented(&format!("Known by: {}; at impacts: {}.", entry.fingerprint, entry.at_impacts)));
    if !entry.confused_with.is_empty() {
        lines.push(indented(&format!("Easily taken for: {}.", entry.confused_with.join(", "))));
    }
    lines.push(indented(&format!("Told by itself by {}.", entry.told_by)));
    let several = if entry.may_repeat { "several add up or multiply" } else { "at most one a wall" };
    lines.push(format!("  In a wall file ({several}):\n"));
    lines.push(example(kind));
    lines.join("\n")
}

fn bounds(parameter: &EffectParameter) -> String {
    let EffectParameter { key, quantity, least, most, meaning, .. } = parameter;
    let unit = if quantity.unit().is_empty() { String::new() } else { format!(" {}", quantity.unit()) };
    format!("  {key}: {} to {}{unit}; {meaning}", short(*least), short(*most))
}

fn short(value: f64) -> String {
    if value.abs() >= 1e4 { format!("{value:e}") } else { value.to_string() }
}

fn example(kind: EffectKind) -> String {
    let Some(variant) = kind.variants().last() else {
        return String::new();
    };
    // A table of texts and numbers can always be written.
    let text = toml::to_string(&Example { effects: [variant.example()] }).unwrap_or_default();
    lines_of(&text)
}

/// Lines of a file, indented.
fn lines_of(text: &str) -> String {
    text.trim_end().lines().map(|line| format!("    {line}")).collect::<Vec<_>>().join("\n")
}

/// Indented lines of a sentence.
fn indented(text: &str) -> String {
    wrapped(text, 2, WIDTH)
}

/// Width of a description, columns.
const WIDTH: usize = 96;
