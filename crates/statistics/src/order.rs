//! Quantiles and correlations of the replicates.

/// Value below which a share of the values lies, linear between order statistics; NaN of no values.
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = share * last as f64;
    let (low, high) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    low + (place - place.floor()) * (high - low)
}

/// Correlation of two variables over vectors; none where one does not vary.
pub fn correlation(vectors: &[Vec<f64>], i: usize, j: usize) -> Option<f64> {
    let n = vectors.len() as f64;
    let mean = |v: usize| vectors.iter().map(|x| x[v]).sum::<f64>() / n;
    let (mean_i, mean_j) = (mean(i), mean(j));
    let sum =
        |a: usize, ma: f64, b: usize, mb: f64| vectors.iter().map(|x| (x[a] - ma) * (x[b] - mb)).sum::<f64>();
    let r = sum(i, mean_i, j, mean_j) / (sum(i, mean_i, i, mean_i) * sum(j, mean_j, j, mean_j)).sqrt();
    r.is_finite().then_some(r)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_quantiles_and_correlations_of_small_sets() {
        assert_eq!(quantile(&[3.0, 1.0, 2.0], 0.5), 2.0);
        assert_eq!(quantile(&[0.0, 10.0], 0.25), 2.5);
        let line = [[0.0, 5.0, 1.0], [1.0, 3.0, 1.0], [2.0, 1.0, 1.0]].map(|x| x.to_vec());
        assert_eq!(correlation(&line, 0, 1), Some(-1.0));
        assert_eq!(correlation(&line, 0, 2), None);
    }
}
