//! Which test to do next.

use super::super::page::{Section, Table};
use super::stored::{Stored, StoredNext, StoredPull, StoredShaking};
use super::words::number;

/// The section.
pub fn section(stored: &Stored) -> Section {
    let mut section =
        Section { id: "next".into(), title: "Which test to do next".into(), ..Section::default() };
    match &stored.next_tests {
        Some(next) => {
            let [first, second] = &next.rivals;
            section.text.push(format!(
                "What would part “{first}” from “{second}”, which these tests do not: each test below was simulated with the first as the truth, noise added, and the second set against it: the best few with the second fitted to it together with the tests there are, the others with its values as they are."
            ));
            section.tables.push(shaking(next));
            section.tables.push(pull(next));
        }
        None => section.text.push(in_words(stored)),
    }
    section
}

fn in_words(stored: &Stored) -> String {
    match stored.verdict.as_str() {
        "none" | "recalibrated" => "Nothing is open. A test that turns the wall further lowers what could still hide.",
        "named" => "Nothing else explains these tests; the next one should confirm the effect where it is largest, or at another size.",
        "no_power" => "A test in which the wall rocks: stronger shaking, or a release.",
        _ => "No two hypotheses stand level, so none can be chosen to part them. The shape of the missing force says where to look: a test that visits the displacements or velocities where its points are few, or a slow pull of the top, measures it directly.",
    }
    .to_owned()
}

fn shaking(next: &StoredNext) -> Table {
    let row = |s: &StoredShaking| {
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
        "Records there are, scaled; 15 would be enough to part them",
        &head,
        next.shaking.iter().map(row),
    )
}

fn pull(next: &StoredNext) -> Table {
    let row = |p: &StoredPull| {
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
