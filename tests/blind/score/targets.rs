//! The targets of the diagnosis and what was reached.

use super::super::cases::draw::NOISES_RAD;
use super::counted::{Counted, NO_CASES};
use super::reading::median;
use super::row::Row;

/// Up to this an effect is to be named nearly always, rad.
const LOW_NOISE_RAD: f64 = 1.001e-4;

/// Formulations of the simulators that make cases.
const FORMULATIONS: [&str; 4] = ["own", "compliant", "corners", "springs"];

/// What a word of the table means.
pub const NOTE: &str = "visible: at least twice the smallest size that the diagnosis says it could detect; \
                        of nominal size or more where it does not say";

/// A table in Markdown: figure, target, reached with its interval, cases.
pub fn table(rows: &[Row]) -> String {
    let mut lines = Vec::new();
    let mut add = |figure: &str, target: &str, reached: String| {
        lines.push([figure.to_owned(), target.to_owned(), reached]);
    };
    let nothing: Vec<&Row> = rows.iter().filter(|row| row.hidden.is_empty()).collect();
    add("a name where nothing is hidden", "≤ 5 %", Counted::of(&nothing, |row| row.claims()).told());
    for noise in NOISES_RAD {
        let at = nothing.iter().filter(|row| row.noise_rad == noise);
        add(&format!("– at {noise:.0e} rad"), "≤ 5 %", Counted::of(at, |row| row.claims()).told());
    }
    for formulation in FORMULATIONS {
        let of = nothing.iter().filter(|row| row.simulator == formulation).collect::<Vec<_>>();
        if !of.is_empty() {
            add(&format!("– {formulation}"), "≤ 5 %", Counted::of(&of, |row| row.claims()).told());
        }
    }
    let one: Vec<&Row> = rows.iter().filter(|row| row.hides_effect() && row.hidden.len() == 1).collect();
    let visible = |row: &&&Row| row.visible() && row.prior.starts_with("k_d to 2 %");
    let low: Vec<&&Row> = one.iter().filter(|row| visible(row) && row.noise_rad < LOW_NOISE_RAD).collect();
    let high: Vec<&&Row> = one.iter().filter(|row| visible(row) && row.noise_rad > LOW_NOISE_RAD).collect();
    add(
        "right name or class, visible, ≤ 1e-4 rad, k_d to 2 %",
        "≥ 95 %",
        Counted::of(&low, |r| r.right()).told(),
    );
    add("– exact name", "≥ 90 %", Counted::of(&low, |row| row.exact()).told());
    // What an unnamed effect could be detected from is less sure, which takes some out of the visible ones: counted by what was
    // drawn too.
    let nominal = one.iter().filter(|r| r.size >= 1.0 && r.prior.starts_with("k_d to 2 %"));
    let nominal = nominal.filter(|row| row.noise_rad < LOW_NOISE_RAD);
    add("– of nominal size or more, visible or not", "", Counted::of(nominal, |row| row.right()).told());
    add("– wrong name", "", Counted::of(&low, |row| row.wrong()).told());
    add("the same at 3e-4 rad", "≥ 75 %", Counted::of(&high, |row| row.right()).told());
    add("– wrong name", "≤ 5 %", Counted::of(&high, |row| row.wrong()).told());
    let placed = rows.iter().filter(|row| !row.hidden.is_empty() && row.visible());
    add("right place, named or not, visible", "≥ 95 %", Counted::of(placed, |row| row.place_right()).told());
    let all = rows.iter().filter(|row| !row.hidden.is_empty());
    add("– visible or not", "", Counted::of(all, |row| row.place_right()).told());
    let outside: Vec<&Row> = rows.iter().filter(|row| row.hides_other_law()).collect();
    let honest = |row: &&&Row| matches!(row.verdict.as_str(), "place_only" | "unknown");
    add("another law: place_only or unknown", "≥ 80 %", Counted::of(&outside, honest).told());
    // Whether that is the right law is counted where laws are hidden.
    let as_law = |row: &&&Row| matches!(row.verdict.as_str(), "formula" | "formula_class" | "curve");
    if outside.iter().any(|row| as_law(&row)) {
        let either = |row: &&&Row| honest(row) || as_law(row);
        add("– or a law outside the catalogue", "", Counted::of(&outside, either).told());
    }
    add("– wrong name", "≤ 10 %", Counted::of(&outside, |row| row.wrong()).told());
    let errors: Vec<f64> = rows.iter().filter_map(|row| row.parameter_error).collect();
    let error = median(errors.iter().copied());
    let told = error.map_or(NO_CASES.into(), |e| format!("{:.1} %, {} cases", 100.0 * e, errors.len()));
    add("parameter, median error where named rightly", "≤ 5 %", told);
    let covered = Counted::of(rows.iter().filter_map(|row| row.covered), |covered| *covered);
    add("– 90 % interval holds the truth", "85 to 95 %", covered.told());
    let pairs = rows.iter().filter(|row| row.hidden.len() == 2).collect::<Vec<_>>();
    add("two effects, both named", "≥ 80 %", Counted::of(&pairs, |row| row.exact()).told());
    let both = pairs.iter().filter(|row| row.all_visible());
    add("– both visible", "", Counted::of(both, |row| row.exact()).told());
    add("– wrong name", "", Counted::of(&pairs, |row| row.wrong()).told());
    lines_of_beds(rows, &mut add);
    let named: Vec<&Row> = rows.iter().filter(|row| row.right()).collect();
    let of = |value: fn(&Row) -> Option<f64>| median(named.iter().filter_map(|row| value(row)));
    let reached = of(|row| row.before).zip(of(|row| row.after));
    let told = |(before, after)| format!("{before:.2} to {after:.2}, {} cases", named.len());
    let reached = reached.map_or(NO_CASES.into(), told);
    add("held-out windowed error over noise, median, where right", "> 3 to < 1.5", reached);
    let slowest = rows.iter().map(|row| row.seconds).fold(0.0, f64::max);
    let typical = median(rows.iter().map(|row| row.seconds)).unwrap_or(0.0);
    add(
        "time of a case, as many at a time as processors",
        "",
        format!("median {typical:.0} s, longest {slowest:.0} s"),
    );
    printed(&lines)
}

/// Windowed error held out from which joints that give are visible, over the noise.
const VISIBLE_BEDS: f64 = 2.0;
/// Share of the squared error above noise that they are to take away in tests held out.
const TAKEN: f64 = 0.8;

/// Figures of walls whose joints give; none where there are no such walls.
fn lines_of_beds(rows: &[Row], add: &mut impl FnMut(&str, &str, String)) {
    let on_beds = rows.iter().filter(|row| row.hides(BEDS)).collect::<Vec<_>>();
    if on_beds.is_empty() {
        return;
    }
    let visible = on_beds.iter().filter(|row| row.before.is_some_and(|error| error > VISIBLE_BEDS));
    let named = |row: &&&Row| row.tells(BEDS);
    add(
        "joints that give, visible: named or in the class, whatever is beside them",
        "≥ 90 %",
        Counted::of(visible, named).told(),
    );
    let named = on_beds.iter().filter(named).collect::<Vec<_>>();
    let most = |row: &&&&Row| row.taken().is_some_and(|share| share >= TAKEN);
    add("– named: at least 80 % of the gap taken away held out", "", Counted::of(&named, most).told());
    let errors = on_beds.iter().filter_map(|row| row.parameter_error).collect::<Vec<_>>();
    let error = median(errors.iter().copied());
    let told = error.map_or(NO_CASES.into(), |e| format!("{:.1} %, {} cases", 100.0 * e, errors.len()));
    add("– stiffness, median error", "≤ 10 %", told);
    let covered = Counted::of(on_beds.iter().filter_map(|row| row.covered), |covered| *covered);
    add("– 90 % interval holds it", "85 to 95 %", covered.told());
    let beside = on_beds.iter().filter(|row| row.hidden.len() == 2).collect::<Vec<_>>();
    add(
        "an effect on joints that give: both named",
        "≥ 85 %",
        Counted::of(&beside, |row| row.exact()).told(),
    );
    add(
        "– what is beside them named, whichever law of the joint",
        "≥ 85 %",
        Counted::of(&beside, |row| row.tells_beside_joints()).told(),
    );
    add("– wrong name", "", Counted::of(&beside, |row| row.wrong()).told());
    let alone = on_beds.iter().filter(|row| row.hidden.len() == 1).collect::<Vec<_>>();
    add("joints that give alone: wrong name", "", Counted::of(&alone, |row| row.wrong()).told());
}

/// Joints that give, among effects.
const BEDS: &str = "compliant_joint";

/// Begins a line that is part of the one above it.
const PART: &str = "–";

/// Figure, target and what was reached as a table in Markdown, without figures that have no cases.
pub fn printed(lines: &[[String; 3]]) -> String {
    let head = ["figure", "target", "reached (95 % interval), cases"].map(str::to_owned);
    let of_one_figure = |_: &[String; 3], next: &[String; 3]| next[0].starts_with(PART);
    let figures = lines.chunk_by(of_one_figure);
    let lines = figures.flat_map(with_cases).collect::<Vec<_>>();
    let width = |k: usize| {
        lines.iter().copied().chain([&head]).map(|line| line[k].chars().count()).max().unwrap_or(0)
    };
    let widths = [0, 1, 2].map(width);
    let rule = widths.map(|width| "-".repeat(width));
    let row = |cells: &[String; 3]| {
        let [a, b, c] = cells;
        format!("| {a:0$} | {b:1$} | {c:2$} |\n", widths[0], widths[1], widths[2])
    };
    [&head, &rule].into_iter().chain(lines).map(row).collect()
}

/// The parts of a figure that have cases, under its first line.
fn with_cases(figure: &[[String; 3]]) -> Vec<&[String; 3]> {
    let Some((first, parts)) = figure.split_first() else { return Vec::new() };
    let has_cases = |line: &&[String; 3]| line[2] != NO_CASES;
    let parts = parts.iter().filter(has_cases).collect::<Vec<_>>();
    if parts.is_empty() && !has_cases(&first) { Vec::new() } else { [vec![first], parts].concat() }
}
