//! Sobol' indices: which share of the variance of an output each of its inputs has.
//!
//! Of two matrices of independent points, A and B, others are made: AB_i is A with the column of input i from B, and a
//! group of inputs is several columns at once. With f over the rows of each,
//!
//! V_i = E\[(f(B) − μ)(f(AB_i) − f(A))\] is the variance of E\[f | x_i\], what the input does by itself (Saltelli et al. 2010,
//! "Variance based sensitivity analysis of model output", Comput. Phys. Commun. 181, Eq. 16), and
//! T_i = E\[(f(A) − f(AB_i))²\]/2 is what would be left if all others were known (Jansen 1999, "Analysis of variance designs
//! for model output", Comput. Phys. Commun. 117). Over V, the variance of f, they are first-order and total index.
//!
//! One input beside the columns is a category of a few values, each as likely as another. It is not drawn: every row is run
//! under all its values, and means over them are exact. With Y_r under value r and m_r its mean over the rows, its
//! V_i is the mean of (m_r(A) − m(A))(m_r(B) − m(B)), of two samples, so that chance adds nothing, and its T_i the mean
//! over the rows of the variance over r. An output without such an input has one category.

/// Indices of one input or group of inputs, as shares of the variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Index {
    /// What it does by itself.
    pub first: f64,
    /// What it does by itself and together with others.
    pub total: f64,
}

/// Indices of all inputs of an output.
#[derive(Debug, Clone, PartialEq)]
pub struct Indices {
    /// Mean of the output.
    pub mean: f64,
    /// Its variance, above 0.
    pub variance: f64,
    /// Of the category.
    pub category: Index,
    /// Of the columns and groups of columns, in their order.
    pub inputs: Vec<Index>,
}

/// What one row of the matrices says.
#[derive(Debug, Clone, PartialEq)]
struct Row {
    /// f(A) and f(B) by category.
    outputs: [Vec<f64>; 2],
    /// Their means over the categories.
    means: [f64; 2],
    /// Mean of their squares.
    square: f64,
    /// Mean of their variances over the categories.
    within: f64,
    /// By input: mean of f(AB_i) over the categories less that of f(A), and half the mean of (f(A) − f(AB_i))².
    swapped: Vec<[f64; 2]>,
}

/// The outputs of a pick-freeze design, row by row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PickFreeze {
    rows: Vec<Row>,
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Mean of a function of neighbours.
fn mean_of(a: &[f64], b: &[f64], of: impl Fn(f64, f64) -> f64) -> f64 {
    a.iter().zip(b).map(|(&a, &b)| of(a, b)).sum::<f64>() / a.len() as f64
}

impl PickFreeze {
    /// Adds a row: f(A), f(B) and f(AB_i) of each input, by category.
    ///
    /// # Panics
    /// For a row without categories, with other ones or with another number of inputs than the rows before it.
    pub fn push(&mut self, a: &[f64], b: &[f64], swapped: &[Vec<f64>]) {
        assert!(!a.is_empty() && a.len() == b.len() && swapped.iter().all(|of| of.len() == a.len()));
        if let Some(first) = self.rows.first() {
            assert_eq!((first.outputs[0].len(), first.swapped.len()), (a.len(), swapped.len()));
        }
        let means = [mean(a), mean(b)];
        let square = 0.5 * (mean_of(a, a, |x, y| x * y) + mean_of(b, b, |x, y| x * y));
        let spread = |values: &[f64], m: f64| mean_of(values, values, |x, _| (x - m) * (x - m));
        self.rows.push(Row {
            outputs: [a.to_vec(), b.to_vec()],
            means,
            square,
            within: 0.5 * (spread(a, means[0]) + spread(b, means[1])),
            swapped: swapped
                .iter()
                .map(|of| [mean(of) - means[0], 0.5 * mean_of(a, of, |x, y| (x - y) * (x - y))])
                .collect(),
        });
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The indices with every row once.
    pub fn indices(&self) -> Option<Indices> {
        self.weighted(&vec![1.0; self.len()])
    }

    /// The indices with each row as often as its weight says, as of a bootstrap; `None` for an output that does not vary.
    ///
    /// # Panics
    /// Unless there are as many weights as rows.
    pub fn weighted(&self, weights: &[f64]) -> Option<Indices> {
        assert_eq!(weights.len(), self.len());
        let all: f64 = weights.iter().sum();
        let over = |of: &dyn Fn(&Row) -> f64| {
            self.rows.iter().zip(weights).map(|(row, w)| w * of(row)).sum::<f64>() / all
        };
        let mean = over(&|row| 0.5 * (row.means[0] + row.means[1]));
        let variance = over(&|row| row.square) - mean * mean;
        // Below this the variance is the rounding of the squares.
        if !(all > 0.0 && variance > 1e-14 * mean * mean && variance.is_finite()) {
            return None;
        }
        let share = |first: f64, total: f64| Index { first: first / variance, total: total / variance };
        let input = |i: usize| {
            let first = over(&|row| (row.means[1] - mean) * row.swapped[i][0]);
            share(first, over(&|row| row.swapped[i][1]))
        };
        let inputs = self.rows.first().map_or(0, |row| row.swapped.len());
        Some(Indices {
            mean,
            variance,
            category: share(self.between(weights, all), over(&|row| row.within)),
            inputs: (0..inputs).map(input).collect(),
        })
    }

    /// The variance of the categories' means: the product of their distances from the mean in A and in B.
    fn between(&self, weights: &[f64], all: f64) -> f64 {
        let categories = self.rows.first().map_or(0, |row| row.outputs[0].len());
        let means = |matrix: usize| {
            let mut sums = vec![0.0; categories];
            for (row, w) in self.rows.iter().zip(weights) {
                sums.iter_mut().zip(&row.outputs[matrix]).for_each(|(sum, y)| *sum += w * y / all);
            }
            sums
        };
        let [a, b] = [means(0), means(1)];
        let [of_a, of_b] = [mean(&a), mean(&b)];
        mean_of(&a, &b, |a, b| (a - of_a) * (b - of_b))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Ishigami & Homma (1990): sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁ over (−π, π)³.
    fn ishigami([x1, x2, x3]: [f64; 3]) -> f64 {
        x1.sin() + 7.0 * x2.sin().powi(2) + 0.1 * x3.powi(4) * x1.sin()
    }

    /// Equal steps over a period: exact for polynomials of sines and cosines up to degree 5.
    fn period() -> Vec<(f64, f64)> {
        (0..6).map(|k| (PI * ((2.0 * f64::from(k) + 1.0) / 6.0 - 1.0), 1.0 / 6.0)).collect()
    }

    /// Gauss and Legendre's five places over (−π, π), exact up to x⁹ (Abramowitz & Stegun, Table 25.4).
    fn legendre() -> Vec<(f64, f64)> {
        let half = [
            (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (0.906_179_845_938_664, 0.236_926_885_056_189_1),
        ];
        let sides = half.iter().flat_map(|&(x, w)| [(-PI * x, 0.5 * w), (PI * x, 0.5 * w)]);
        sides.chain([(0.0, 0.5 * 0.568_888_888_888_888_9)]).collect()
    }

    /// All combinations of places, each with the product of its weights.
    fn product(axes: &[Vec<(f64, f64)>]) -> Vec<(Vec<f64>, f64)> {
        axes.iter().fold(vec![(Vec::new(), 1.0)], |all, axis| {
            let longer =
                |(at, w): &(Vec<f64>, f64), &(x, v): &(f64, f64)| ([at.as_slice(), &[x]].concat(), w * v);
            all.iter().flat_map(|one| axis.iter().map(move |place| longer(one, place))).collect()
        })
    }

    /// The published indices: V₁, V₂, V₁₃ over V.
    fn published() -> [Index; 3] {
        let (a, b) = (7.0f64, 0.1f64);
        let v1 = 0.5 * (1.0 + b * PI.powi(4) / 5.0).powi(2);
        let v2 = a * a / 8.0;
        let v13 = 8.0 * b * b * PI.powi(8) / 225.0;
        let v = v1 + v2 + v13;
        [(v1, v1 + v13), (v2, v2), (0.0, v13)]
            .map(|(first, total)| Index { first: first / v, total: total / v })
    }

    fn assert_near(found: Index, expected: Index) {
        // Sums of 10⁴ terms near 10², over a variance of 14.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-11;
        assert!(
            near(found.first, expected.first) && near(found.total, expected.total),
            "{found:?} for {expected:?}"
        );
    }

    #[test]
    fn published_indices_of_ishigami_and_homma() {
        // All places of A beside all of B, with their weights: the expectations themselves, without chance.
        let axes = [period(), period(), legendre()];
        let places = product(&axes);
        let (mut design, mut weights) = (PickFreeze::default(), Vec::new());
        for (a, u) in &places {
            for (b, v) in &places {
                let [a, b]: [[f64; 3]; 2] = [a, b].map(|x| [x[0], x[1], x[2]]);
                let with = |taken: &[usize]| {
                    let mut x = a;
                    taken.iter().for_each(|&i| x[i] = b[i]);
                    vec![ishigami(x)]
                };
                let swapped = [with(&[0]), with(&[1]), with(&[2]), with(&[0, 2])];
                design.push(&[ishigami(a)], &[ishigami(b)], &swapped);
                weights.push(u * v);
            }
        }
        let found = design.weighted(&weights).expect("it varies");
        assert!((found.mean - 3.5).abs() < 1e-12, "7/2: {}", found.mean);
        let [one, two, three] = published();
        for (found, expected) in found.inputs.iter().zip([one, two, three]) {
            assert_near(*found, expected);
        }
        // x₁ and x₃ together are all that x₂ is not, and it acts alone.
        assert_near(found.inputs[3], Index { first: 1.0 - two.total, total: 1.0 - two.first });
        assert_eq!(found.category, Index { first: 0.0, total: 0.0 }, "there is one category");
    }

    #[test]
    fn published_indices_of_ishigami_and_homma_where_one_input_is_the_category() {
        // x₂ takes six values, each as likely: its sines have the same moments. It is no column, and not drawn.
        let places = product(&[period(), legendre()]);
        let (mut design, mut weights) = (PickFreeze::default(), Vec::new());
        let under_all = |x1: f64, x3: f64| -> Vec<f64> {
            period().iter().map(|&(x2, _)| ishigami([x1, x2, x3])).collect()
        };
        for (a, u) in &places {
            for (b, v) in &places {
                let swapped = [under_all(b[0], a[1]), under_all(a[0], b[1])];
                design.push(&under_all(a[0], a[1]), &under_all(b[0], b[1]), &swapped);
                weights.push(u * v);
            }
        }
        let found = design.weighted(&weights).expect("it varies");
        let [one, two, three] = published();
        assert_near(found.category, two);
        assert_near(found.inputs[0], one);
        assert_near(found.inputs[1], three);
    }

    #[test]
    fn analytic_a_category_that_acts_with_a_column_has_a_total_beyond_its_first() {
        // f = r x with r of −1, 1, 3 and x of ±1: E[f | r] = 0 and E[f | x] = x, V = E[r²] = 11/3.
        let mut design = PickFreeze::default();
        let under_all = |x: f64| [-1.0, 1.0, 3.0].map(|r| r * x).to_vec();
        for a in [-1.0, 1.0] {
            for b in [-1.0, 1.0] {
                design.push(&under_all(a), &under_all(b), &[under_all(b)]);
            }
        }
        let found = design.indices().expect("it varies");
        // Var(r) = 8/3, and x² is 1.
        assert_near(found.category, Index { first: 0.0, total: 8.0 / 11.0 });
        assert_near(found.inputs[0], Index { first: 3.0 / 11.0, total: 1.0 });
    }

    #[test]
    fn regress_an_output_that_does_not_vary_has_no_indices() {
        let mut design = PickFreeze::default();
        assert_eq!(design.indices(), None, "no rows");
        (0..5).for_each(|_| design.push(&[0.3; 7], &[0.3; 7], &[vec![0.3; 7]]));
        assert_eq!((design.len(), design.is_empty(), design.indices()), (5, false, None));
    }
}
