//! The report in words for people (stderr), and the parameters as CSV (stdout).

use std::io::{self, Write};

use super::continuation::GOOD_ENOUGH;
use super::likelihood::ByLikelihood;
use super::result::{Calibration, Estimate, MethodResult};

/// Parameters as CSV: name, bounds, value, interval, spread over tests, and what the tests tell.
///
/// # Errors
/// What the stream says.
pub fn print_parameters(out: &mut dyn Write, calibration: &Calibration) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    let header = "parameter,lower_bound,upper_bound,value,lower_95,upper_95,spread_over_tests,told";
    csv.write_record(header.split(','))?;
    for e in &calibration.parameters {
        let number = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x}"));
        csv.write_record([
            e.name.clone(),
            e.lower_bound.to_string(),
            e.upper_bound.to_string(),
            e.value.to_string(),
            number(e.interval_95.map(|i| i[0])),
            number(e.interval_95.map(|i| i[1])),
            number(e.spread_over_tests),
            e.identifiability.words().to_owned(),
        ])?;
    }
    csv.flush()
}

/// A number in the width of its column: four decimals, or four digits of what is too large for them.
fn short(value: f64) -> String {
    if value.abs() < 1e5 { format!("{value:.4}") } else { format!("{value:.3e}") }
}

/// The report for people.
pub fn summary(c: &Calibration) -> String {
    let mut text = String::new();
    let mut line = |s: String| {
        text.push_str(&s);
        text.push('\n');
    };
    line(format!(
        "Impact law {}, capture velocity {} rad/s, seed {}",
        c.law, c.capture_velocity_rad_s, c.seed
    ));
    line(String::new());
    line(format!("{:<11}{:<24}{:>10}{:>12}{:>8}", "search", "test", "WME", "simulations", "gen."));
    for m in &c.methods {
        let test = m.test.as_deref().unwrap_or("all (mean)");
        let wme = figure(c.wme_of(m));
        line(format!("{:<11}{test:<24}{wme:>10}{:>12}{:>8}", m.method, m.simulations, m.generations));
    }
    line(String::new());
    line(format!("The vector for all tests is that of `{}`.", c.joint_from));
    line(likelihood(c.likelihood.as_ref()));
    disagreement(&c.methods, c.likelihood.as_ref()).into_iter().for_each(&mut line);
    line(format!("{:<32}{:>11}{:>24}{:>10}  {}", "parameter", "value", "95 % interval", "by test", "told"));
    c.parameters.iter().for_each(|e| line(parameter(e)));
    line(String::new());
    line(tests_header());
    for t in &c.tests {
        let counts = t.transitions.map(|n| format!("{n:>5}")).concat();
        let [before, after, alone] = [t.wme_before, t.wme_joint, t.wme_alone].map(figure);
        line(format!("{:<20}{:<9}{before:>8}{after:>8}{alone:>8} {counts}", t.name, t.purpose));
        notes(t).into_iter().for_each(&mut line);
    }
    if !c.capture_study.is_empty() {
        line(String::new());
        line("Joint search by law and capture velocity (fewer simulations than above):".into());
        line(format!("{:<9}{:>10}{:>12}{:>12}  best", "law", "rad/s", "joint's WME", "best WME"));
    }
    for row in &c.capture_study {
        let best = row.best.iter().map(|x| format!(" {x:.4}")).collect::<String>();
        let (joint, wme) = (figure(row.wme_of_joint), figure(row.wme_of_best));
        line(format!("{:<9}{:>10}{joint:>12}{wme:>12} {best}", row.law, row.capture_velocity_rad_s));
    }
    line(String::new());
    line(format!(
        "{} simulations in {:.1} s ({:.0} a second); the source's own part: {} in {:.1} s",
        c.simulations, c.seconds, c.simulations_per_second, c.paper_simulations, c.paper_seconds
    ));
    text
}

/// What the fit by likelihood says, in a sentence.
pub fn likelihood(fit: Option<&ByLikelihood>) -> String {
    let Some(fit) = fit else {
        return "No fit by likelihood: too little of the tests can be read or moves.".to_owned();
    };
    let ByLikelihood { count, error_in_noise, missed_share, .. } = fit;
    let (over, missed) = (fit.over.words(), 100.0 * missed_share);
    let told = if fit.followed { "followed to their noise" } else { "not followed to their noise" };
    format!("By likelihood {count} {over} are {told}: error {error_in_noise:.3} of it, {missed:.0} % missed.")
}

fn tests_header() -> String {
    let counts = (1..=8).map(|l| format!("  C_{l}")).collect::<String>();
    format!("{:<20}{:<9}{:>8}{:>8}{:>8}  {}", "test", "use", "before", "joint", "alone", counts)
}

fn parameter(e: &Estimate) -> String {
    let interval = e.interval_95.map_or_else(String::new, |[a, b]| format!("{} to {}", short(a), short(b)));
    let spread = e.spread_over_tests.map_or_else(String::new, |s| format!("±{}", short(s)));
    let value = short(e.value);
    let bound = if e.on_bound { ", on its bound" } else { "" };
    format!("{:<32}{value:>11}{interval:>24}{spread:>10}  {}{bound}", e.name, e.identifiability.words())
}

fn notes(t: &super::result::TestResult) -> Vec<String> {
    let mut notes = Vec::new();
    for (i, name) in ["theta1", "theta2"].iter().enumerate() {
        if t.lost_channels[i] {
            notes.push(format!("    {name} is lost: the WME has the other term only"));
        }
        if t.channels_at_rest[i] {
            notes.push(format!("    {name} is measured at rest: errors are relative to α/1000"));
        }
    }
    if let Some(mismatch) = t.alignment.mismatch {
        let start_s = t.alignment.start_s;
        notes.push(format!("    the measurement starts at {start_s:.4} s of the record, found by matching (mismatch {mismatch:.3})"));
    }
    let time = |s: Option<f64>| s.map_or_else(|| "not".to_owned(), |s| format!("at {s:.2} s"));
    if t.measured_collapse_s.is_some() || t.simulated_collapse_s.is_some() {
        let (m, s) = (time(t.measured_collapse_s), time(t.simulated_collapse_s));
        notes.push(format!("    collapse: measured {m} (nothing counts after), simulated {s}"));
    }
    notes
}

fn figure(x: Option<f64>) -> String {
    x.map_or_else(|| "-".to_owned(), |x| format!("{x:.4}"))
}

/// Share by which the misfit where one search ended may be above the other's. Intervals take vectors up to so far
/// above the lowest as not excluded. A search that ended higher ended at a vector that the tests exclude.
const APART: f64 = 0.1;

/// What to say of searches that disagree; `None` where they agree, or one is not there.
/// A fit by likelihood that follows the tests to their noise needs none of them.
pub fn disagreement(methods: &[MethodResult], likelihood: Option<&ByLikelihood>) -> Option<String> {
    if likelihood.is_some_and(|fit| fit.followed) {
        return None;
    }
    let ended = |name: &str| methods.iter().find(|m| m.method == name)?.best.mean_wme;
    let [joint, refined] = [ended("joint")?, ended("refined")?];
    told(joint, refined)
}

fn told(joint: f64, refined: f64) -> Option<String> {
    let [low, high] = [joint.min(refined), joint.max(refined)];
    (high > GOOD_ENOUGH && high > (1.0 + APART) * low).then(|| {
        format!(
            "Distrust the values, which therefore have no intervals: `joint` ended at a mean WME of {joint:.4} and `refined` at {refined:.4}, so at least \
             one search has not arrived. More vectors (refine_vectors, most_generations) may bring them together."
        )
    })
}

#[cfg(test)]
mod tests {
    use super::told;

    #[test]
    fn analytic_searches_that_ended_apart_are_told_either_way_round() {
        for (one, two) in [(0.2101, 0.1230), (0.1230, 0.2101)] {
            let text = told(one, two).expect("apart");
            assert!(text.contains("0.2101") && text.contains("0.1230"), "{text}");
        }
        assert_eq!(told(0.131, 0.132), None);
        // Without noise both end at roundings.
        assert_eq!(told(3e-9, 2e-7), None);
    }
}
