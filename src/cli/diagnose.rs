//! `mrbd diagnose`: where model and measurement disagree, and which effect would make them agree.

use std::path::PathBuf;

use clap::Args;

use super::progress::Bar;
use super::report::write_page;
use super::shell::shell_word;
use super::so_far::{SoFar, Watched};
use super::threads::Threads;
use super::{output, stop};
use crate::error::Result;
use crate::report::{numbers_of, round_exponents};
use crate::results::diagnosis::{OutputNames, write_results};
use mrbd_lab::diagnose::answer::{
    FitHeldOut, FittedNumber, FittedToAll, FoundEffect, OwnHypothesis, SharedHeldOut, Summary,
};
use mrbd_lab::diagnose::verdict::Remainder;
use mrbd_lab::diagnose::{Diagnosis, Experiment, check_data, diagnose};

/// Find where model and measurement disagree, and name the missing effect.
///
/// Cuts the tests into short windows, simulates each from a fitted state, and
/// tries every effect of the catalogue (mrbd effects) and their pairs within
/// what was known of the wall ([prior] of the experiment). Judged on tests with
/// use = "hold-out". Answers none, recalibrated, named, class, formula,
/// formula_class, curve, place_only, unknown or no_power.
///
/// Examples:
///   mrbd diagnose experiment.toml --out diagnosed
///   mrbd simulate diagnosed/wall.updated.toml --record record.csv
///   mrbd report diagnosed          # its page once more; the first time it is made here
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct DiagnoseArgs {
    /// Experiment file (TOML): wall, what was known of it, tests.
    experiment: PathBuf,
    /// Folder for the results; empty, or of an earlier diagnosis.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    threads: Threads,
}

/// Runs the command.
///
/// # Errors
/// Input errors of the experiment and what it names, and of the output folder; failures to write.
pub fn execute(args: &DiagnoseArgs) -> Result<()> {
    let experiment = Experiment::load(&args.experiment)?;
    let pool = args.threads.pool()?;
    let names = OutputNames::prepare(&args.out)?;
    let (file, out) = (shell_word(&args.experiment), shell_word(&args.out));
    let so_far = SoFar::default();
    let (known, folder) = (so_far.clone(), args.out.clone());
    stop::end_on_signals(move || {
        let left = known.leave_in(&folder);
        format!("{left}\nTo begin again: mrbd diagnose {file} --out {out}")
    })?;
    let bar = Watched { bar: Bar::of_steps(), so_far };
    let diagnosis = pool.install(|| -> Result<Diagnosis> {
        check_data(&experiment)?;
        Ok(diagnose(&experiment, &bar)?)
    })?;
    write_results(&names, &experiment.inputs, &diagnosis)?;
    drop(bar);
    eprintln!("{}", in_words(&diagnosis.summary));
    let page = write_page(&args.out, None)?;
    eprintln!("its page, to be opened in a browser: {}", page.display());
    output::to_stdout(|out| writeln!(out, "{}", names.diagnosis.display()).map_err(output::failed))
}

/// The answer in a few lines.
fn in_words(summary: &Summary) -> String {
    let mut lines = vec![format!("verdict: {}", summary.verdict.name())];
    lines.extend(summary.effects.iter().flat_map(effect_in_words));
    lines.extend(summary.fitted_to_all.as_ref().map(fitted_to_all_in_words));
    lines.extend(summary.shared_held_out.map(shared_held_out_in_words));
    lines.extend(summary.missed_held_out.as_ref().map(missed_held_out_in_words));
    lines.extend(summary.remainder.as_ref().map(remainder_in_words));
    if !summary.equivalent.is_empty() {
        lines.push(format!("  these tests cannot tell apart: {}", summary.equivalent.join(", ")));
    }
    let error = &summary.windowed_error;
    lines.push(match (error.before, error.recalibrated, error.after) {
        (Some(before), Some(recalibrated), Some(after)) => {
            format!("windowed error, in noise: {before:.2} before, {recalibrated:.2} recalibrated, {after:.2} after")
        }
        _ => "windowed error: no window in which the wall moves".to_owned(),
    });
    lines.extend(summary.hypotheses.iter().map(own_in_words));
    lines.extend(summary.unfinished.iter().map(|(law, fits)| {
        let fits = if *fits == 1 { "a fit".to_owned() } else { format!("{fits} fits") };
        format!(
            "not fitted to the end, and no answer for that: {law} ({fits} needed more work than one may have)"
        )
    }));
    lines.join("\n")
}

/// A law of the user's own: its numbers, and how well it follows.
fn own_in_words(own: &OwnHypothesis) -> String {
    let number = |n: &FittedNumber| {
        let within = n.sd.map_or_else(String::new, |sd| format!(" ± {sd:.2e}"));
        format!("{} = {:.5}{within} {}", n.key, n.value, n.unit).trim_end().to_owned()
    };
    let numbers = own.parameters.iter().map(number).collect::<Vec<_>>().join(", ");
    let error = &own.windowed_error;
    match (error.fit, error.held_out) {
        (None, _) => format!("your {:?}: no fit makes a wall that follows", own.name),
        (Some(fit), held_out) => {
            let held_out = held_out.map_or_else(String::new, |error| format!(", {error:.2} held out"));
            let closes = if own.closes_gap { "closes the gap" } else { "does not close the gap" };
            format!("your {:?}: {closes}, windowed error {fit:.2}{held_out}; {numbers}", own.name)
        }
    }
}

/// With which other numbers the tests held out are followed.
fn fitted_to_all_in_words(found: &FittedToAll) -> String {
    let numbers = found.effects.iter().flat_map(numbers_of).collect::<Vec<_>>().join(", ");
    format!(
        "  these numbers miss the tests held out; fitted to all tests together, which those fitted mind by {:.1} natural \
         logarithms of likelihood, it follows them too: {numbers}",
        found.lost
    )
}

/// Which windows of the tests held out were fitted too.
fn shared_held_out_in_words(SharedHeldOut { fitted, judging }: SharedHeldOut) -> String {
    format!(
        "  the tests fitted do not show all of it: {fitted} windows of the tests held out were fitted too, and the {judging} \
         between them judge"
    )
}

/// That tests held out are missed where those fitted are followed.
fn missed_held_out_in_words(found: &FitHeldOut<f64>) -> String {
    format!(
        "  without an effect the wall follows the tests fitted ({:.2} times the noise) and misses those held out ({:.2}): \
         something shows in these alone; fit a test like them too",
        found.fit, found.held_out
    )
}

/// What a name with a remainder takes away and leaves.
fn remainder_in_words(found: &Remainder) -> String {
    let next = found.next_rival.as_ref().map_or_else(String::new, |next| {
        format!("; next, {}: {:.1} %", next.name, 100.0 * next.taken_held_out.max(0.0))
    });
    format!(
        "  a name with a remainder: of the squared error above noise it takes away {:.1} % in the tests held out, \
         and leaves {:.1} times the noise{next}",
        100.0 * found.taken_held_out,
        found.left_held_out
    )
}

/// An effect and its place, and a line for each of its numbers; those of curves stand in the files.
fn effect_in_words(effect: &FoundEffect) -> Vec<String> {
    if effect.formula.is_some() && effect.name.is_none() {
        return vec![format!(
            "  a force without a formula at {}, by displacement and velocity",
            effect.place
        )];
    }
    let name = effect.formula.as_deref().or(effect.name.as_deref()).unwrap_or("a law outside the catalogue");
    let mut lines = vec![format!("  {name} at {}", effect.place)];
    lines.extend(numbers_of(effect).iter().map(|number| format!("    {number}")));
    lines.extend(round_exponents(effect).map(|told| format!("    {told}")));
    lines
}
