//! No more points and stretches than a picture can show: one unit of a picture is finer than a pixel.

use super::colours::Colour;
use super::picture::Place;

/// Points of a line that a column of one unit keeps.
const MOST: usize = 4;

/// A line of which each column of one unit keeps its first, lowest, highest and last point.
pub fn line(places: &[Place]) -> Vec<Place> {
    let mut thin = Vec::new();
    for column in places.chunk_by(|a, b| a.0.floor() == b.0.floor()) {
        if column.len() <= MOST {
            thin.extend_from_slice(column);
            continue;
        }
        let by_height = |a: &usize, b: &usize| column[*a].1.total_cmp(&column[*b].1);
        let (low, high) = ((0..column.len()).min_by(by_height), (0..column.len()).max_by(by_height));
        let mut kept = [Some(0), low, high, Some(column.len() - 1)];
        kept.sort_unstable();
        let mut last = None;
        for index in kept.into_iter().flatten().filter(|&index| last.replace(index) != Some(index)) {
            thin.push(column[index]);
        }
    }
    thin
}

/// Upright spans of which each column of one unit keeps the tallest; slanting and level ones stay.
pub fn spans(spans: impl Iterator<Item = [Place; 2]>) -> Vec<[Place; 2]> {
    let column = |[a, b]: &[Place; 2]| (a.0 == b.0).then(|| a.0.floor());
    let height = |[a, b]: &[Place; 2]| (a.1 - b.1).abs();
    let mut thin: Vec<[Place; 2]> = Vec::new();
    for span in spans {
        match thin.last_mut() {
            // A span from another foot hides nothing.
            Some(last)
                if column(last).is_some() && column(last) == column(&span) && last[0].1 == span[0].1 =>
            {
                if height(&span) > height(last) {
                    *last = span;
                }
            }
            _ => thin.push(span),
        }
    }
    thin
}

/// A stretch along a picture: from, to, colour.
pub type Length = (f64, f64, Colour);

/// Stretches in order, of which a column of one unit shows the colour that fills most of it.
///
/// Stretches longer than a unit keep their ends.
pub fn stretches(all: impl Iterator<Item = Length>) -> Vec<Length> {
    let mut thin: Vec<Length> = Vec::new();
    let mut short: Vec<Length> = Vec::new();
    for stretch in all {
        let begun = short.first().map(|first| first.0);
        if begun.is_some_and(|begun| stretch.1 - begun >= 1.0) {
            put(&mut thin, commonest(&short));
            short.clear();
        }
        if stretch.1 - stretch.0 >= 1.0 {
            put(&mut thin, Some(stretch));
        } else {
            short.push(stretch);
        }
    }
    put(&mut thin, commonest(&short));
    thin
}

fn put(thin: &mut Vec<Length>, next: Option<Length>) {
    let Some(next) = next else { return };
    match thin.last_mut() {
        Some(last) if last.2 == next.2 && next.0 - last.1 < 1.0 => last.1 = next.1,
        _ => thin.push(next),
    }
}

/// The whole of some short stretches in the colour of which there is most.
fn commonest(short: &[Length]) -> Option<Length> {
    let (first, last) = (short.first()?, short.last()?);
    let of = |colour: Colour| -> f64 {
        short.iter().filter(|stretch| stretch.2 == colour).map(|stretch| stretch.1 - stretch.0).sum()
    };
    let most = short.iter().max_by(|a, b| of(a.2).total_cmp(&of(b.2)))?;
    Some((first.0, last.1, most.2))
}

#[cfg(test)]
mod tests {
    use super::super::colours::{PALETTE, PATTERNS};
    use super::*;

    #[test]
    fn analytic_a_thin_line_keeps_extremes_ends_and_order() {
        let wave = |k: i32| (f64::from(k) * 0.02, (f64::from(k) * 0.37).sin());
        let all: Vec<Place> = (0..=100_000).map(wave).collect();
        let thin = line(&all);
        assert!(thin.len() <= 4 * 2001 && thin.len() > 2 * 2000, "{}", thin.len());
        assert!(thin.iter().any(|p| p.1 > 0.9999) && thin.iter().any(|p| p.1 < -0.9999));
        assert!(thin.is_sorted_by(|a, b| a.0 < b.0), "no point twice, none out of order");
        assert_eq!((thin.first(), thin.last()), (all.first(), all.last()));
        assert_eq!(line(&all[..3]), [all[0], all[1], all[2]].to_vec(), "nothing of little is left out");
    }

    #[test]
    fn analytic_the_tallest_of_upright_spans_is_kept() {
        let upright = |x: f64, top: f64| [(x, 10.0), (x, top)];
        let all = [upright(1.1, 5.0), upright(1.2, 2.0), upright(1.3, 7.0), upright(2.0, 9.0)];
        assert_eq!(spans(all.into_iter()), [upright(1.2, 2.0), upright(2.0, 9.0)]);
        let level = [[(0.0, 1.0), (5.0, 1.0)], [(0.0, 1.0), (4.0, 1.0)]];
        assert_eq!(spans(level.into_iter()), level);
    }

    #[test]
    fn analytic_short_stretches_show_what_there_is_most_of() {
        let (a, b) = (PATTERNS[1], PALETTE[0]);
        let long = [(0.0, 4.0, a), (4.0, 4.1, b), (4.1, 9.0, a)];
        // Between two long ones a moment is shown for what it is.
        assert_eq!(stretches(long.into_iter()), long);
        let flicker = (0..1000).flat_map(|k| {
            let x = f64::from(k) * 0.01;
            [(x, x + 0.007, a), (x + 0.007, x + 0.01, b)]
        });
        let thin = stretches(flicker);
        assert!(thin.len() == 1 && thin[0].0 == 0.0 && (thin[0].1 - 10.0).abs() < 1e-9 && thin[0].2 == a);
    }
}
