//! Which test to do next.

use super::super::page::{Section, Table};
use super::words::number;
use mrbd_lab::diagnose::Verdict;
use mrbd_lab::diagnose::answer::Summary;
use mrbd_lab::diagnose::certainty::{NextPull, NextShaking, NextTests};
use mrbd_lab::limits::EQUIVALENT;

/// The section.
pub fn section(summary: &Summary) -> Section {
    let mut section =
        Section { id: "next".into(), title: "Which test to do next".into(), ..Section::default() };
    match &summary.next_tests {
        Some(next) => {
            let [first, second] = &next.rivals;
            section.text.push(format!(
                "What would part “{first}” from “{second}”, which these tests do not: each test below was simulated with the first as the truth, noise added, and the second set against it: the best few with the second fitted to it together with the tests there are, the others with its values as they are."
            ));
            section.tables.push(shaking(next));
            section.tables.push(pull(next));
        }
        None => section.text.push(in_words(summary)),
    }
    section
}

fn in_words(summary: &Summary) -> String {
    match summary.verdict {
        Verdict::None | Verdict::Recalibrated => "Nothing is open. A test that turns the wall further lowers what could still hide.",
        Verdict::Named => "Nothing else explains these tests; the next one should confirm the effect where it is largest, or at another size.",
        Verdict::Formula => "The formula holds over what these tests excited. The next one should confirm it beyond, at another amplitude: shapes that agree here part there.",
        Verdict::FormulaClass => "The formulas agree over what these tests excited. Another amplitude, larger or much smaller, parts them; a slow pull of the top parts springs from dampers.",
        Verdict::Curve => "The curves hold over what these tests excited. A test at another amplitude says whether they go on, and a slow pull of the top gives the one of displacement directly.",
        Verdict::NoPower => "A test in which the wall rocks: stronger shaking, or a release.",
        Verdict::Class | Verdict::PlaceOnly | Verdict::Unknown => "No two hypotheses stand level, so none can be chosen to part them. The shape of the missing force says where to look: a test that visits the displacements or velocities where its points are few, or a slow pull of the top, measures it directly.",
    }
    .to_owned()
}

fn shaking(next: &NextTests) -> Table {
    let row = |s: &NextShaking| {
        vec![
            s.test.clone(),
            format!("{:.2}", s.scale),
            s.outcome.clone(),
            if s.fitted { "yes" } else { "no" }.to_owned(),
            s.error.map_or("–".to_owned(), |x| format!("{x:.2}")),
            s.nats.map_or("–".to_owned(), |x| format!("{x:.0}")),
        ]
    };
    let head = [
        "record of",
        "factor on it",
        "the first",
        "the second fitted to it",
        "error of the second there, in noise",
        "natural logarithms of likelihood between them",
    ];
    Table::of(
        &format!("Records there are, scaled; {EQUIVALENT} would be enough to part them"),
        &head,
        next.shaking.iter().map(row),
    )
}

fn pull(next: &NextTests) -> Table {
    let row = |p: &NextPull| {
        let [first, second] = p.force_n;
        let apart = 100.0 * (first - second).abs() / first.abs().max(second.abs()).max(f64::MIN_POSITIVE);
        vec![
            format!("{:.1} mm", 1e3 * p.displacement_m),
            number(first),
            number(second),
            format!("{apart:.1} %"),
        ]
    };
    let head = ["top pulled by", "held by, the first, N", "the second, N", "apart"];
    Table::of(
        "A slow pull of the top against its floor, the wall’s own weight apart",
        &head,
        next.pull.iter().map(row),
    )
}
