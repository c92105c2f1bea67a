//! One vector for all tests by cosine similarity: the paper's Eq. 10.
//!
//! Vectors of positive numbers near one all point nearly the same way, so similarities differ by thousandths only,
//! and the vector chosen is the one nearest to the middle of the last generations: it says nothing about misfits.
//! That is why the report shows the misfit of this vector beside that of a direct joint search.

/// Eq. 10: cosine of the angle between two vectors.
pub fn sim(h: &[f64], k: &[f64]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    dot(h, k) / (dot(h, h) * dot(k, k)).sqrt()
}

/// The vector of all last generations with the highest similarity to the others.
#[derive(Debug, Clone, PartialEq)]
pub struct MostSimilar {
    /// Which test's generation it comes from, and its place there.
    pub from: (usize, usize),
    /// Mean over tests of the mean similarity with the vectors of the test.
    pub similarity: f64,
}

/// Compares every vector with all the others of the last generations, one a test.
///
/// `None` if there is no vector. Every test weighs the same; the first of equals is chosen.
pub fn most_similar(generations: &[Vec<Vec<f64>>]) -> Option<MostSimilar> {
    let mut best: Option<MostSimilar> = None;
    for (test, vectors) in generations.iter().enumerate() {
        for (index, h) in vectors.iter().enumerate() {
            let similarity = mean(generations.iter().map(|others| mean(others.iter().map(|k| sim(h, k)))));
            if best.as_ref().is_none_or(|b| similarity > b.similarity) {
                best = Some(MostSimilar { from: (test, index), similarity });
            }
        }
    }
    best
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_cosines_of_known_angles() {
        // Roundings of numbers near one.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-15;
        assert!(near(sim(&[1.0, 0.0], &[1.0, 1.0]), 0.5_f64.sqrt()));
        assert!(near(sim(&[2.0, 2.0], &[5.0, 5.0]), 1.0));
        assert!(near(sim(&[1.0, 0.0], &[0.0, 3.0]), 0.0));
    }

    #[test]
    fn analytic_the_middle_of_three_directions_is_most_similar() {
        let at = |degrees: f64| vec![degrees.to_radians().cos(), degrees.to_radians().sin()];
        let chosen = most_similar(&[vec![at(0.0), at(30.0)], vec![at(40.0)], vec![at(80.0)]]);
        // Means over tests of mean cosines: 0°: 0.624, 30°: 0.854, 40°: 0.880 (the largest), 80°: 0.725.
        assert_eq!(chosen.expect("there are vectors").from, (1, 0));
        assert_eq!(most_similar(&[]), None);
    }
}
