//! The scatter of a response at a known intensity, and how well the intensity tells falls from survivals.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::runs::Runs;

/// Seed of the draws.
const SEED: u64 = 2012;

/// How often each record counts: once, or as often as it was drawn.
pub struct Draw {
    weights: Vec<f64>,
}

/// ln(θ/α_i) = a_façade + b ln IM + ε, fitted by least squares.
pub struct Fit {
    /// b.
    pub slope: f64,
    /// Standard deviation of ε.
    pub scatter: f64,
    /// Mean ε of each record, that over its runs; `None` where none of its walls stood.
    pub residual_of_records: Vec<Option<f64>>,
}

/// Sums of a façade: weight, ln IM, ln θ/α.
#[derive(Clone, Copy, Default)]
struct Sums {
    weight: f64,
    x: f64,
    y: f64,
}

impl Draw {
    /// Every record once.
    pub fn as_they_are(runs: &Runs) -> Self {
        Self { weights: vec![1.0; runs.about.len()] }
    }

    /// As many records as there are, drawn with replacement; it depends on its number alone.
    pub fn new(runs: &Runs, number: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(SEED);
        rng.set_stream(number);
        let mut weights = vec![0.0; runs.about.len()];
        (0..weights.len()).for_each(|_| weights[rng.random_range(0..runs.about.len())] += 1.0);
        Self { weights }
    }

    /// Weight, façade, record, ln IM and ln θ/α of the runs that stood.
    fn rows<'a>(
        &'a self,
        runs: &'a Runs,
        k: usize,
    ) -> impl Iterator<Item = (f64, usize, usize, f64, f64)> + 'a {
        (0..runs.len()).filter_map(move |row| {
            let weight = self.weights[runs.record[row]];
            let y = runs.ln_response[row].filter(|_| weight > 0.0)?;
            Some((weight, runs.facade[row], runs.record[row], runs.ln_measures[row][k], y))
        })
    }

    /// The fit for the `k`-th measure; `None` where it does not vary, or is not known of every run.
    pub fn fit(&self, runs: &Runs, k: usize) -> Option<Fit> {
        let mut sums = vec![Sums::default(); runs.facades];
        for (weight, facade, _, x, y) in self.rows(runs, k) {
            let of = &mut sums[facade];
            of.weight += weight;
            of.x += weight * x;
            of.y += weight * y;
        }
        // Distances from the means of the façade leave only what changes from record to record.
        let centred = |(weight, facade, record, x, y): (f64, usize, usize, f64, f64)| {
            let of = &sums[facade];
            (weight, record, x - of.x / of.weight, y - of.y / of.weight)
        };
        let (mut xx, mut xy, mut n) = (0.0, 0.0, 0.0);
        for (weight, _, x, y) in self.rows(runs, k).map(centred) {
            xx += weight * x * x;
            xy += weight * x * y;
            n += weight;
        }
        // One number for each façade, and the slope.
        let freedom = n - sums.iter().filter(|of| of.weight > 0.0).count() as f64 - 1.0;
        let slope = xy / xx;
        if !(xx > 0.0 && slope.is_finite() && freedom > 0.0) {
            return None;
        }
        let mut of_records = vec![(0.0, 0.0); runs.about.len()];
        let mut squares = 0.0;
        for (weight, record, x, y) in self.rows(runs, k).map(centred) {
            let epsilon = y - slope * x;
            squares += weight * epsilon * epsilon;
            of_records[record].0 += epsilon;
            of_records[record].1 += 1.0;
        }
        let mean = |(sum, count): (f64, f64)| (count > 0.0).then(|| sum / count);
        Some(Fit {
            slope,
            scatter: (squares / freedom).sqrt(),
            residual_of_records: of_records.into_iter().map(mean).collect(),
        })
    }
}

/// Share of the pairs of runs of one façade, one collapsed and one standing, in which the collapsed one was shaken the
/// more strongly; ties count half. `None` without such pairs.
pub fn concordance(runs: &Runs, k: usize) -> Option<f64> {
    let mut of_facades = vec![[Vec::new(), Vec::new()]; runs.facades];
    for row in 0..runs.len() {
        let stood = usize::from(runs.ln_response[row].is_some());
        of_facades[runs.facade[row]][stood].push(runs.ln_measures[row][k]);
    }
    let (mut right, mut pairs) = (0.0, 0.0);
    for [fell, stood] in &of_facades {
        for (fell, stood) in fell.iter().flat_map(|fell| stood.iter().map(move |stood| (fell, stood))) {
            right += if fell > stood {
                1.0
            } else if fell == stood {
                0.5
            } else {
                0.0
            };
            pairs += 1.0;
        }
    }
    (pairs > 0.0).then(|| right / pairs)
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::sensitivity::measures::MEASURES;
    use crate::sensitivity::measures::runs::About;

    /// Two façades under six records: ln θ/α = façade + 2 ln IM_0 + ε of the record; the other measures do not vary.
    pub fn made(epsilon: [f64; 6]) -> Runs {
        let about = |record: usize| About {
            magnitude: Some(6.0 + 0.1 * record as f64),
            ln_distance: None,
            ln_duration: Some([0.3, 0.1, 0.4, 0.1, 0.5, 0.9][record]),
        };
        let mut runs = Runs { facades: 2, about: (0..6).map(about).collect(), ..Runs::default() };
        for facade in 0..2 {
            for record in 0..6 {
                let x = [0.0, 1.0, -1.0, 2.0, 0.5, -0.5][record];
                let mut ln_measures = [1.0; MEASURES.len()];
                ln_measures[0] = x;
                runs.ln_measures.push(ln_measures);
                runs.ln_response.push(Some(5.0 * facade as f64 + 2.0 * x + epsilon[record]));
                runs.facade.push(facade);
                runs.record.push(record);
            }
        }
        runs
    }

    #[test]
    fn analytic_a_law_without_scatter_is_found_whatever_the_facades() {
        let runs = made([0.0; 6]);
        let fit = Draw::as_they_are(&runs).fit(&runs, 0).expect("a measure that varies");
        assert!((fit.slope - 2.0).abs() < 1e-14 && fit.scatter < 1e-14, "rounding only: {}", fit.scatter);
        assert!(Draw::as_they_are(&runs).fit(&runs, 1).is_none(), "it does not vary");
    }

    #[test]
    fn analytic_scatter_and_residuals_are_those_put_in() {
        // ε at right angles to a constant and to x, so that the fit leaves it whole.
        let epsilon = [0.3, 0.0, 0.0, 0.0, -0.15, -0.15];
        let runs = made(epsilon);
        let fit = Draw::as_they_are(&runs).fit(&runs, 0).expect("a measure that varies");
        assert!((fit.slope - 2.0).abs() < 1e-14);
        // Twelve runs less two façades and a slope.
        let squares: f64 = 2.0 * epsilon.iter().map(|e| e * e).sum::<f64>();
        assert!((fit.scatter - (squares / 9.0).sqrt()).abs() < 1e-14);
        for (found, put) in fit.residual_of_records.iter().zip(epsilon) {
            assert!((found.expect("runs") - put).abs() < 1e-14);
        }
    }

    #[test]
    fn analytic_a_record_drawn_twice_counts_twice() {
        let runs = made([0.1, -0.2, 0.3, 0.0, 0.2, -0.4]);
        let draw = Draw { weights: vec![2.0, 1.0, 0.0, 1.0, 1.0, 1.0] };
        let mut twice = made([0.1, -0.2, 0.3, 0.0, 0.2, -0.4]);
        for row in [0, 6] {
            twice.ln_measures.push(twice.ln_measures[row]);
            twice.ln_response.push(twice.ln_response[row]);
            twice.facade.push(twice.facade[row]);
            twice.record.push(0);
        }
        let once = Draw { weights: vec![1.0, 1.0, 0.0, 1.0, 1.0, 1.0] };
        let [a, b] = [(&draw, &runs), (&once, &twice)].map(|(draw, runs)| draw.fit(runs, 0).expect("a fit"));
        assert!((a.slope - b.slope).abs() < 1e-14 && (a.scatter - b.scatter).abs() < 1e-14);
    }

    #[test]
    fn analytic_concordance_counts_pairs_within_facades() {
        let mut runs = made([0.0; 6]);
        assert_eq!(concordance(&runs, 0), None, "nothing fell");
        // The first façade falls at x = 2, its largest, and at x = 0: right are 5 of 5 - those at 2 and 0 are both fallen -
        // so 4 of 4 and 2 of 4.
        runs.ln_response[3] = None;
        runs.ln_response[0] = None;
        assert_eq!(concordance(&runs, 0), Some(6.0 / 8.0));
        assert_eq!(concordance(&runs, 1), Some(0.5), "a measure that does not vary tells nothing");
    }
}
