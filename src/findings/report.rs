//! What a study says, for people: assumptions, medians, findings, and how they depend on the assumptions.

use std::io::{self, Write};
use std::path::Path;

use super::change::shift;
use super::conclusion::{Conclusion, Conclusions, Sureness, percent, sure_rules};
use super::tables::print_tables;
use super::vote::{noticeable, rules};
use super::{FINDINGS, Finding, Held, Verdict, View};
use crate::aggregate::{MOVED_SHARE, Measure, Medians, Moved, VariantNote};
use crate::error::{Error, Result};
use crate::store::write_durably;
use crate::study::runs::Completeness;
use crate::survey::Configuration;
use crate::text::{TERMINAL, aligned, wrapped};

/// Prints everything; the first variant is the one whose medians are shown whole. `conclusions` are those of the medians.
///
/// # Errors
/// What the stream says.
pub fn report(out: &mut dyn Write, medians: &Medians, conclusions: &[Conclusions]) -> io::Result<()> {
    let (Some(base), Some(under_base)) = (medians.variants.first(), conclusions.first()) else {
        return Ok(());
    };
    let view = View::new(medians, &base.name);
    assumptions(out, &medians.variants)?;
    unfinished(out, medians.completeness)?;
    heading(
        out,
        &format!(
            "Medians over the records, largest rotations over slenderness angles, variant {:?}",
            base.name
        ),
    )?;
    writeln!(out, "*: some records collapsed; fell: the median record collapsed; -: no such run")?;
    print_tables(out, &view)?;
    heading(out, &format!("Conclusions of the source against these medians, variant {:?}", base.name))?;
    unfinished(out, medians.completeness)?;
    writeln!(out, "{}", wrapped(&rules(), 0, TERMINAL))?;
    writeln!(out, "{}", wrapped(&sure_rules(), 0, TERMINAL))?;
    findings(out, &under_base.all)?;
    writeln!(out, "{}", wrapped(&held(&under_base.all, medians.completeness), 0, TERMINAL))?;
    if medians.variants.len() > 1 {
        heading(out, "The same conclusions under every variant")?;
        matrix(out, conclusions)?;
        heading(out, &format!("How far the medians of θi/αi move from variant {:?}", base.name))?;
        shifts(out, medians, base)?;
    }
    Ok(())
}

/// Writes every finding under every variant as CSV: answer, numbers, criterion, and over how many runs it is judged.
///
/// # Errors
/// [`mrbd_files::Error::Io`] if the disk refuses.
pub fn write_findings(path: &Path, medians: &Medians, conclusions: &[Conclusions]) -> Result<()> {
    let failed = |e: csv::Error| Error::table(path, e);
    let mut csv = csv::Writer::from_writer(Vec::new());
    let head = ["variant", "finding", "answer", "numbers", "claim", "source", "holds_if", "noticeable"];
    let sure = ["at_hand", "holds_share", "does_not_share", "records", "members"];
    let study = ["study_runs", "planned_runs"];
    csv.write_record(head.into_iter().chain(sure).chain(study)).map_err(failed)?;
    let noticeable = noticeable();
    let count =
        |of: fn(Completeness) -> u64| medians.completeness.map_or(String::new(), |c| of(c).to_string());
    let judged_over = [count(|c| c.runs), count(|c| c.planned_runs)];
    for Conclusions { variant, all } in conclusions {
        for (finding, conclusion) in FINDINGS.iter().zip(all) {
            let Finding { name, claim, source, criterion, .. } = finding;
            let (verdict, numbers) = (conclusion.verdict().name(), &conclusion.answer.numbers);
            let row: [&str; 8] = [variant, name, verdict, numbers, claim, source, criterion, &noticeable];
            let sure = sure_cells(conclusion);
            let further = sure.iter().chain(&judged_over).map(String::as_str);
            csv.write_record(row.into_iter().chain(further)).map_err(failed)?;
        }
    }
    let bytes = csv.into_inner().map_err(|e| Error::table(path, e))?;
    write_durably(path, &bytes)
}

/// The verdict of the medians at hand, shares of the draws, and of what they are draws; empty where there are none.
fn sure_cells(conclusion: &Conclusion) -> [String; 5] {
    let at_hand = conclusion.answer.verdict.name().to_owned();
    match conclusion.sureness {
        None => [at_hand, String::new(), String::new(), String::new(), String::new()],
        Some(sure) => [
            at_hand,
            sure.holds.to_string(),
            sure.does_not.to_string(),
            sure.records.to_string(),
            sure.members.to_string(),
        ],
    }
}

/// An underlined heading.
///
/// # Errors
/// What the stream says.
pub(super) fn heading(out: &mut dyn Write, text: &str) -> io::Result<()> {
    writeln!(out, "\n{text}\n{}", "-".repeat(text.chars().count()))
}

/// Says so before figures of a study that is unfinished.
///
/// # Errors
/// What the stream says.
pub(super) fn unfinished(out: &mut dyn Write, study: Option<Completeness>) -> io::Result<()> {
    match study.and_then(|study| study.note()) {
        Some(note) => writeln!(out, "{}", wrapped(&format!("UNFINISHED: {note}."), 0, TERMINAL)),
        None => Ok(()),
    }
}

/// The assumptions of every variant and how its runs ended, as a table.
///
/// # Errors
/// What the stream says.
pub fn assumptions(out: &mut dyn Write, variants: &[VariantNote]) -> io::Result<()> {
    heading(out, "What the source leaves open, and what was assumed")?;
    let head = [
        "variant",
        "L, m",
        "ρ, kg/m³",
        "law",
        "capture, rad/s",
        "tolerance",
        "runs",
        "collapsed",
        "failed",
        "residual",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(variants.iter().map(|v| {
        vec![
            v.name.clone(),
            v.length_m.to_string(),
            v.density_kg_m3.to_string(),
            v.law.clone(),
            format!("{:e}", v.capture_velocity_rad_s),
            format!("{:e}", v.tolerance),
            v.runs.to_string(),
            v.collapsed.to_string(),
            v.failed.to_string(),
            v.energy_residual.map_or("-".to_owned(), |residual| format!("{residual:.0e}")),
        ]
    }));
    writeln!(out, "{}", aligned(&rows))?;
    writeln!(
        out,
        "residual: the largest energy not accounted for, over the energy that passed through a run."
    )?;
    let mut suites: Vec<String> = variants.iter().map(suite).collect();
    suites.dedup();
    suites.iter().try_for_each(|suite| writeln!(out, "{}", wrapped(suite, 0, TERMINAL)))
}

fn suite(variant: &VariantNote) -> String {
    match variant.suite_generated {
        true => format!(
            "Records: suite {:?}, generated, not measured: what follows says what the model does under such motions, not what the source's records did.",
            variant.suite
        ),
        false => format!(
            "Records: suite {:?}, measured; the source's own records are another selection for the same spectrum.",
            variant.suite
        ),
    }
}

fn findings(out: &mut dyn Write, conclusions: &[Conclusion]) -> io::Result<()> {
    for (index, (finding, conclusion)) in FINDINGS.iter().zip(conclusions).enumerate() {
        let Conclusion { answer, sureness } = conclusion;
        writeln!(out, "{:>2}. {}: {}", index + 1, finding.name, conclusion.verdict().name().to_uppercase())?;
        writeln!(
            out,
            "{}",
            wrapped(&format!("Claim: {} ({}).", finding.claim, finding.source), 4, TERMINAL)
        )?;
        writeln!(out, "{}", wrapped(&format!("Holds if {}.", finding.criterion), 4, TERMINAL))?;
        writeln!(out, "{}", wrapped(&format!("Found: {}.", answer.numbers), 4, TERMINAL))?;
        if let Some(sureness) = sureness {
            writeln!(out, "{}", wrapped(&format!("Sure: {}.", sureness.tell()), 4, TERMINAL))?;
        }
    }
    Ok(())
}

fn held(conclusions: &[Conclusion], study: Option<Completeness>) -> String {
    let held = Held::among(conclusions);
    let over = study
        .filter(|study| !study.is_whole())
        .map_or(String::new(), |study| format!(", judged over {study}"));
    let held_of_asked = format!("{} of {} conclusions hold{over}.", held.holds, held.asked);
    match held.not_asked() {
        0 => held_of_asked,
        others => format!("{held_of_asked} {others} others are not in this study."),
    }
}

/// Conclusions that no variant varies have no row.
fn matrix(out: &mut dyn Write, conclusions: &[Conclusions]) -> io::Result<()> {
    let mut head = vec!["conclusion".to_owned()];
    head.extend(conclusions.iter().map(|under| under.variant.clone()));
    let mut rows = vec![head];
    for (index, finding) in FINDINGS.iter().enumerate() {
        let of_variants: Vec<&Conclusion> = conclusions.iter().map(|under| &under.all[index]).collect();
        if of_variants.iter().any(|conclusion| conclusion.verdict() != Verdict::NotAsked) {
            let name = format!("{:>2}. {}", index + 1, finding.name);
            rows.push(std::iter::once(name).chain(of_variants.into_iter().map(cell)).collect());
        }
    }
    writeln!(out, "{}", aligned(&rows))?;
    let notes = "With the share of the draws that say so; undecided: those that hold, and those that do not. Ensembles answer for the variant that has them.";
    writeln!(out, "{}", wrapped(notes, 0, TERMINAL))
}

/// "holds 97 %", "undecided 62:5 %".
fn cell(conclusion: &Conclusion) -> String {
    let verdict = conclusion.verdict();
    match (verdict, conclusion.sureness) {
        (_, None) => verdict.name().to_owned(),
        (Verdict::Undecided, Some(Sureness { holds, does_not, .. })) => {
            format!("{} {}:{} %", verdict.name(), percent(holds), percent(does_not))
        }
        (_, Some(sureness)) => format!("{} {}", verdict.name(), sureness.short()),
    }
}

fn shifts(out: &mut dyn Write, medians: &Medians, base: &VariantNote) -> io::Result<()> {
    let head = ["variant", "floor", "median |Δ|", "largest |Δ|", "at", "stood/fell", "runs moved"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for variant in &medians.variants[1..] {
        for configuration in Configuration::ALL {
            rows.push(shift_row(medians, &base.name, &variant.name, configuration));
        }
    }
    writeln!(out, "{}", aligned(&rows))?;
    let notes = format!(
        "stood/fell: medians that stood under one of the two and collapsed under the other. runs moved: runs whose largest rotation differs by more than {} %, or whose outcome does; where only the tolerance differs, these are the ill-conditioned runs.",
        100.0 * MOVED_SHARE
    );
    writeln!(out, "{}", wrapped(&notes, 0, TERMINAL))
}

fn shift_row(medians: &Medians, base: &str, variant: &str, configuration: Configuration) -> Vec<String> {
    let shift = shift(medians, base, variant, configuration);
    let number = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.4}"));
    let place = shift.largest.as_ref().map_or("-".to_owned(), |(case, measure)| {
        let body = if *measure == Measure::LowerOwn { "θ1" } else { "θ2" };
        let level = case.level.name(case.parameter);
        format!("{body}, {} {level}, h/b {}", case.parameter.name(), case.slenderness)
    });
    let of_floor = |moved: &&Moved| moved.variant == variant && moved.configuration == configuration.name();
    let moved =
        medians.moved.iter().find(of_floor).map_or("-".to_owned(), |moved| {
            format!("{:.1} %", 100.0 * moved.moved as f64 / moved.runs as f64)
        });
    vec![
        variant.to_owned(),
        configuration.name().to_owned(),
        number(shift.median()),
        number(shift.max()),
        place,
        shift.changed_sides.to_string(),
        moved,
    ]
}
