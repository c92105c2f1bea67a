//! Fragilities of the shipped stripes, where their scatter comes from, and how many runs are ill-conditioned.

use indicatif::ProgressBar;
use mrbd::aggregate::{Compared, stored_answers};
use mrbd::check::{Conditioning, conditioning, run_again, sampled};
use mrbd::fragility::{
    Bootstrap, Columns, Expression, Group, Interval, Known, Method, Outcomes, Settings, analyse, read_groups,
};
use mrbd::survey::Configuration;

use super::block::{Page, row};
use super::studies::Study;

/// The defaults of `mrbd fragility`.
const SETTINGS: Settings =
    Settings { method: Method::Outcomes, bootstrap: Bootstrap { replicates: 2000, seed: 1 }, level: 0.95 };

/// Runs of `mrbd check-tolerance --sample`, and the default of its seed.
const SAMPLE: (u64, u64) = (1000, 1);

pub fn blocks(page: &mut Page) {
    let study = Study::run("pipelines/fragility.toml", None);
    let limits = [("θ/α = 0.1", Some(0.1)), ("θ/α = 0.5", Some(0.5)), ("collapse", None)];
    let rows: Vec<(&str, [Known; 2])> =
        limits.map(|(name, threshold)| (name, fragilities(&study, threshold))).into();
    page.put_lines("fragilities", &table(&rows));
    page.put_prose("shares", &shares(&rows));
    page.put_prose("ill-conditioned", &ill_conditioned(&Study::run("pipelines/monte_carlo.toml", None)));
}

/// Under the perpendicular and the parallel floor.
fn fragilities(study: &Study, threshold: Option<f64>) -> [Known; 2] {
    let outcome = match threshold {
        Some(limit) => Outcomes::Above("theta_max_over_own_alpha".into(), limit),
        None => Outcomes::Words("outcome".into()),
    };
    let columns = Columns {
        intensity: Expression::parse("pgv_m_s").expect("a column"),
        stood: None,
        outcome,
        demand: None,
        groups: vec!["configuration".into()],
        clusters: vec!["record".into(), "draw".into()],
    };
    let groups = read_groups(study.folder(), &columns).expect("a study of stripes");
    Configuration::ALL.map(|floor| {
        let of_floor = |group: &&Group| group.key == [floor.name()];
        let group = groups.iter().find(of_floor).expect("both floors");
        analyse(&group.sample, &SETTINGS).result.expect("a fragility")
    })
}

fn table(rows: &[(&str, [Known; 2])]) -> String {
    let intensity = "peak ground velocity, m/s, at which half of the façades pass";
    let head = row(&[intensity, "perpendicular floor", "β", "parallel floor", "β"]) + &row(&["---"; 5]);
    let line = |(name, [perpendicular, parallel]): &(&str, [Known; 2])| {
        row(&[
            (*name).to_owned(),
            median(perpendicular),
            beta(perpendicular),
            median(parallel),
            beta(parallel),
        ])
    };
    head + &rows.iter().map(line).collect::<String>()
}

fn median(known: &Known) -> String {
    let bound = |value: Option<f64>| value.map_or("?".to_owned(), |value| format!("{value:.2}"));
    let Interval { lower, upper } = known.best().expect("a bootstrap").1.median;
    format!("{:.2} [{}, {}]", known.fitted.curve.median(), bound(lower), bound(upper))
}

fn beta(known: &Known) -> String {
    format!("{:.2}", known.fitted.curve.beta())
}

/// Where the variance of ln capacity comes from at the lowest limit and at collapse.
fn shares(rows: &[(&str, [Known; 2])]) -> String {
    let of = |floors: &[Known; 2], kind: &str| {
        let share = |known: &Known| {
            let shares = known.shares.as_ref().expect("outcomes that share records and façades");
            format!("{:.2}", shares.iter().find(|share| share.name == kind).expect("a kind").share)
        };
        format!("{} and {}", share(&floors[0]), share(&floors[1]))
    };
    let one = |(name, floors): &(&str, [Known; 2])| {
        format!(
            "at {name} {} from the records and {} from the façades",
            of(floors, "record"),
            of(floors, "draw")
        )
    };
    let ends = [one(&rows[0]), one(rows.last().expect("limits"))].join("; ");
    format!("Of β², under the perpendicular and the parallel floor, come {ends}.")
}

/// As `mrbd check-tolerance` tells it.
fn ill_conditioned(study: &Study) -> String {
    let compared = Compared::of(study.plan.kind());
    let positions = sampled(study.plan.len(), SAMPLE.0, SAMPLE.1);
    let stored = stored_answers(study.folder(), &positions, &compared).expect("stored runs");
    let again = run_again(&study.plan, &stored, None, &ProgressBar::hidden());
    let found = conditioning(&compared, &again);
    let share = |floor: Configuration| {
        let of_floor = |group: &&Conditioning| group.configuration == floor.name();
        let [share, low, high] = found.iter().find(of_floor).and_then(Conditioning::share).expect("runs");
        let [share, low, high] = [share, low, high].map(|x| format!("{:.1}", 100.0 * x));
        format!("{share} % ({}, 95 % interval {low} to {high} %)", floor.name())
    };
    let [perpendicular, parallel] = Configuration::ALL.map(share);
    let moves = found.iter().flat_map(|group| &group.medians).map(|[stored, tighter]| {
        let [stored, tighter] = [stored, tighter].map(|median| median.expect("most walls stood"));
        (stored - tighter).abs()
    });
    let farthest = moves.fold(0.0, f64::max);
    format!(
        "Of a thousand runs of `monte_carlo` {perpendicular} and {parallel} come out otherwise at a hundredth of the \
         tolerance; the medians move by {farthest:.0e} in θ/α at most."
    )
}
