//! How often a diagnosis was right in blind cases that are recorded: the figures with targets, of the last sets of each kind.

use super::block::{Page, row};
use crate::blind::recorded::{SETS, SETS_OF_LAWS, recorded, recorded_laws};
use crate::blind::{laws, score};

/// Figures of a kind of sets, of which the last are taken together.
struct Kind {
    /// What is hidden, and where it is told.
    title: &'static str,
    prefix: &'static str,
    sets: usize,
    /// Lines of the table of these sets, by how they begin: all that have a target, but for single noises and what other kinds tell, and
    /// wrong names.
    figures: &'static [&'static str],
}

const KINDS: [Kind; 4] = [
    Kind {
        title: "[nothing, by four formulations of a contact](docs/diagnosis-blind.md#joints-that-give)",
        prefix: "nulls",
        // As many as hold a hundred of each formulation.
        sets: 7,
        figures: &["a name where", "– own", "– compliant", "– corners", "– springs"],
    },
    Kind {
        title: "[an effect of the catalogue](docs/diagnosis-blind.md#effects-of-the-catalogue)",
        prefix: "fresh",
        sets: 2,
        figures: &[
            "a name where",
            "right name or class",
            "– exact name",
            "– wrong name",
            "the same at 3e-4 rad",
            "– wrong name",
            "right place",
            "another law",
            "– or a law outside the catalogue",
            "– wrong name",
            "parameter, median error",
            "– 90 % interval holds",
            "two effects, both named",
            "– wrong name",
            "held-out windowed error",
        ],
    },
    Kind {
        title: "[joints that give](docs/diagnosis-blind.md#joints-that-give)",
        prefix: "beds",
        sets: 3,
        figures: &[
            "a name where",
            "joints that give, visible",
            "– named: at least 80 % of the gap",
            "– stiffness, median error",
            "– 90 % interval holds",
            "an effect on joints that give",
            "– what is beside them",
            "– wrong name",
            "joints that give alone: wrong name",
        ],
    },
    Kind {
        title: "[a law that no catalogue has](docs/diagnosis-blind-laws.md)",
        prefix: "laws",
        sets: 3,
        figures: &[
            "a formula where",
            "one atom, visible, ≤ 1e-4 rad",
            "– alone",
            "– the force within 10 %",
            "one atom at 3e-4 rad",
            "– the force within 10 %",
            "an exponent told as round",
            "two atoms: both right",
            "– the force within 10 %",
            "a law at a joint",
            "a memory: the formula",
            "– the force within 10 %",
            "outside the grammar",
            "accepted formulas that are another force",
            "numbers of one right atom",
            "– their 90 % intervals hold",
            "accepted: windowed error",
            "– below 1.15",
        ],
    },
];

/// The last sets of a kind, and their table.
fn table(kind: &Kind) -> (Vec<&'static str>, String) {
    let all = SETS.iter().map(|(set, _)| *set).chain(SETS_OF_LAWS);
    let mut sets = all.filter(|set| set.starts_with(kind.prefix)).collect::<Vec<_>>();
    // In the order of their numbers: laws9 before laws10.
    sets.sort_by_key(|set| (set.len(), *set));
    let sets = sets.split_off(sets.len() - kind.sets);
    let table = match kind.prefix {
        "laws" => laws::targets::table(&sets.iter().flat_map(|set| recorded_laws(set)).collect::<Vec<_>>()),
        _ => score::targets::table(&sets.iter().flat_map(|set| recorded(set)).collect::<Vec<_>>()),
    };
    (sets, table)
}

pub fn block(page: &mut Page) {
    let mut text = row(&["hidden", "figure", "target", "reached (95 % interval), cases"]);
    text += "| --- | --- | --- | --- |\n";
    for kind in KINDS {
        let (sets, table) = table(&kind);
        let mut lines = table.lines().map(cells);
        for (n, figure) in kind.figures.iter().enumerate() {
            // In the order of the table: what belongs to a figure stands below it.
            let found = lines.find(|cells| cells[0].starts_with(figure));
            let found =
                found.unwrap_or_else(|| panic!("no \"{figure}\" further down in the table of {sets:?}"));
            let hidden = if n == 0 { format!("{}: {}", kind.title, sets.join(", ")) } else { String::new() };
            text += &row(&[&[hidden], &found[..]].concat());
        }
    }
    page.put_lines("blind cases", &text);
}

/// Cells of a line of a table, without what pads them.
fn cells(line: &str) -> Vec<String> {
    line.trim_matches(['|', ' ']).split('|').map(|cell| cell.trim().to_owned()).collect()
}
