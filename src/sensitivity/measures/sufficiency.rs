//! What else of an earthquake explains the response at a known intensity.

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::Sufficiency;
use super::runs::{About, Runs};

/// p values of the slopes of the records' mean residuals over what else is known of them.
///
/// Runs under one record fail together, so a record is one observation, however many façades it shook.
pub fn sufficiency(runs: &Runs, residual_of_records: &[Option<f64>]) -> Sufficiency {
    let over = |of: fn(&About) -> Option<f64>| {
        let pairs = runs.about.iter().zip(residual_of_records);
        // A record without a residual tells nothing; one of which a value is not known leaves the question open.
        let known: Option<Vec<(f64, f64)>> = pairs
            .filter_map(|(about, residual)| Some((of(about), (*residual)?)))
            .map(|(x, y)| Some((x?, y)))
            .collect();
        slope_p(&known?)
    };
    Sufficiency {
        magnitude_p: over(|about| about.magnitude),
        distance_p: over(|about| about.ln_distance),
        duration_p: over(|about| about.ln_duration),
    }
}

/// p value of the slope of a straight line, two-sided (Student's t); `None` of fewer than three points, and of one abscissa.
fn slope_p(points: &[(f64, f64)]) -> Option<f64> {
    let n = points.len() as f64;
    let [mean_x, mean_y] =
        [points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n];
    let sum =
        |of: &dyn Fn(f64, f64) -> f64| points.iter().map(|p| of(p.0 - mean_x, p.1 - mean_y)).sum::<f64>();
    let (xx, xy, yy) = (sum(&|x, _| x * x), sum(&|x, y| x * y), sum(&|_, y| y * y));
    let freedom = n - 2.0;
    let t_of = StudentsT::new(0.0, 1.0, freedom).ok().filter(|_| freedom > 0.0 && xx > 0.0)?;
    let scatter = ((yy - xy * xy / xx) / freedom).max(0.0).sqrt();
    let t = (xy / xx) / (scatter / xx.sqrt());
    t.is_finite().then(|| 2.0 * (1.0 - t_of.cdf(t.abs())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensitivity::measures::efficiency::tests::made;

    #[test]
    fn verified_p_value_of_a_slope() {
        // scipy 1's stats.linregress(…).pvalue.
        let points = [(1.0, 2.1), (2.0, 3.9), (3.0, 6.2), (4.0, 7.8), (5.0, 8.1), (6.0, 12.5)];
        assert!((slope_p(&points).expect("a slope") - 0.0010280571745818429).abs() < 1e-9);
        let weak = [(1.0, 0.3), (2.0, -0.2), (3.0, 0.1), (4.0, 0.4), (5.0, 0.2)];
        assert!((slope_p(&weak).expect("a slope") - 0.654665220978603).abs() < 1e-9);
    }

    #[test]
    fn analytic_what_was_put_in_over_the_magnitude_is_seen() {
        let runs = made([0.0; 6]);
        let residuals = [0.02, 0.11, 0.19, 0.31, 0.40, 0.52].map(Some);
        let found = sufficiency(&runs, &residuals);
        assert!(found.magnitude_p.expect("known") < 1e-4);
        assert!(
            found.duration_p.expect("known") > 0.05 && found.distance_p.is_none(),
            "nobody knows the distance"
        );
    }

    #[test]
    fn rejects_too_few_points_and_one_abscissa() {
        assert_eq!(slope_p(&[(1.0, 2.0), (2.0, 3.0)]), None);
        assert_eq!(slope_p(&[(1.0, 2.0), (1.0, 3.0), (1.0, 4.0)]), None);
    }
}
