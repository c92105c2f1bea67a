//! The medians as tables that people can read.

use std::io::{self, Write};

use super::view::{Slender, View};
use crate::aggregate::{Measure, Median, Middle};
use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::survey::Configuration;

/// Columns of the slenderness at the left of a table.
const HEAD: usize = 5;
/// Columns of one median.
const CELL: usize = 7;
/// Medians of one floor: two bodies at three levels.
const BLOCK: usize = 6 * CELL + 3;

/// One table a parameter: rows slenderness, columns levels of both bodies, the floors side by side.
pub fn print_tables(out: &mut dyn Write, view: &View) -> io::Result<()> {
    let lists = Configuration::ALL.map(|configuration| view.parameters(configuration));
    // The floor masses differ by floor; put side by side what stands at the same place of the two lists.
    for place in 0..lists[0].len().max(lists[1].len()) {
        let pair = [lists[0].get(place).copied(), lists[1].get(place).copied()];
        print_table(out, view, pair)?;
    }
    Ok(())
}

fn print_table(out: &mut dyn Write, view: &View, pair: [Option<Parameter>; 2]) -> io::Result<()> {
    let blocks: Vec<(Configuration, Parameter)> =
        Configuration::ALL.into_iter().zip(pair).filter_map(|(c, p)| Some((c, p?))).collect();
    writeln!(out)?;
    let line = |head: &str, block: &dyn Fn(Configuration, Parameter) -> String| {
        let blocks: Vec<String> = blocks.iter().map(|&(c, p)| block(c, p)).collect();
        format!("{head:<HEAD$}{}", blocks.join("   ")).trim_end().to_owned()
    };
    writeln!(
        out,
        "{}",
        line("", &|c, p| format!("{:<BLOCK$}", format!("{} floor, {}", c.name(), title(p))))
    )?;
    writeln!(out, "{}", line("", &|_, _| bodies("θ1/α1", "θ2/α2")))?;
    writeln!(out, "{}", line("h/b", &|c, p| values(view, c, p)))?;
    for slenderness in view.slendernesses(Slender::Any) {
        let head = slenderness.to_string();
        writeln!(out, "{}", line(&head, &|c, p| medians(view, c, p, slenderness)))?;
    }
    Ok(())
}

fn title(parameter: Parameter) -> String {
    match parameter {
        Parameter::Restitution => "coefficients C_l".to_owned(),
        _ => {
            let (symbol, unit) = unit_of(parameter);
            if unit.is_empty() { symbol.to_owned() } else { format!("{symbol} in {unit}") }
        }
    }
}

/// Symbol and printed unit, the source's.
fn unit_of(parameter: Parameter) -> (&'static str, &'static str) {
    match parameter {
        Parameter::Strength => ("f", "MPa"),
        Parameter::Stiffness => ("k_d", "kN/m"),
        other => other.symbol(),
    }
}

fn printed_value(parameter: Parameter, value: f64) -> String {
    match parameter {
        Parameter::Strength => format!("{:.2}", value / 1e6),
        Parameter::Stiffness => format!("{:.0}", value / 1e3),
        _ => format!("{value:.2}"),
    }
}

fn bodies(lower: &str, upper: &str) -> String {
    let width = 3 * CELL;
    format!("{lower:>width$} | {upper:>width$}")
}

fn triple(cells: [String; 3]) -> String {
    cells.iter().map(|cell| format!("{cell:>CELL$}")).collect()
}

/// The levels, by value where the parameter has one.
fn values(view: &View, configuration: Configuration, parameter: Parameter) -> String {
    let head = |level: Level| {
        let mut rows = view.rows().filter(|row| {
            (row.case.configuration, row.case.parameter, row.case.level) == (configuration, parameter, level)
        });
        match rows.next().and_then(|row| row.parameter_value) {
            Some(value) => printed_value(parameter, value),
            None => ["lower", "best", "upper"][level.index()].to_owned(),
        }
    };
    let heads = triple(Level::ALL.map(head));
    format!("{heads} | {heads}")
}

fn medians(view: &View, configuration: Configuration, parameter: Parameter, slenderness: f64) -> String {
    let of = |body: Measure| {
        triple(Level::ALL.map(|level| cell(view.row(configuration, parameter, level, (slenderness, body)))))
    };
    format!("{} | {}", of(Measure::LowerOwn), of(Measure::UpperOwn))
}

/// A median; starred where some records collapsed, `fell` where the median one did, `-` where there is none.
fn cell(row: Option<&Median>) -> String {
    let Some(row) = row else { return "-".to_owned() };
    match row.middle() {
        Some(Middle::Rotation(rotation)) if row.collapsed > 0 => format!("{rotation:.3}*"),
        Some(Middle::Rotation(rotation)) => format!("{rotation:.4}"),
        Some(Middle::Collapsed) => "fell".to_owned(),
        None => "-".to_owned(),
    }
}
