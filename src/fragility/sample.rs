//! Observations: at which intensity, how many trials, how many failures, in which clusters.

/// One row of data before it joins a [`Sample`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observation {
    /// Intensity measure in any unit.
    pub intensity: f64,
    /// Walls or runs that failed.
    pub failures: u32,
    /// Walls or runs observed; 1 for a single outcome, more for a stripe.
    pub trials: u32,
    /// Largest demand (EDP) of a run that stood, in any unit; of a run that collapsed there is none.
    pub demand: Option<f64>,
}

/// Why a row is not an observation.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ImpossibleObservation {
    /// An intensity without a logarithm.
    #[error("intensity {0}; allowed: finite and above 0")]
    Intensity(f64),
    /// More failures than trials, or no trials.
    #[error(
        "{failures} failures in {trials} trials; allowed: 1 or more trials, at most all of them failures"
    )]
    Counts {
        /// Failures.
        failures: u32,
        /// Trials.
        trials: u32,
    },
    /// A demand without a logarithm.
    #[error("demand {0}; allowed: finite and above 0")]
    Demand(f64),
}

/// Labels of one kind (records, façades) as numbers from 0, one an observation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Clusters {
    /// What kind they are, for reports.
    pub name: String,
    /// The cluster of each observation, below `count`.
    pub of: Vec<u32>,
    /// Number of clusters.
    pub count: usize,
}

impl Clusters {
    /// Numbers the labels in order of appearance.
    pub fn new<T: Eq + std::hash::Hash>(name: &str, labels: impl IntoIterator<Item = T>) -> Self {
        let mut numbers = std::collections::HashMap::new();
        let mut number = |label| {
            let next = numbers.len() as u32;
            *numbers.entry(label).or_insert(next)
        };
        let of: Vec<u32> = labels.into_iter().map(&mut number).collect();
        Self { name: name.to_owned(), count: numbers.len(), of }
    }
}

/// Observations that are valid: logarithms exist, failures do not exceed trials.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sample {
    ln_intensity: Vec<f64>,
    failures: Vec<f64>,
    trials: Vec<f64>,
    ln_demand: Vec<Option<f64>>,
    clusters: Vec<Clusters>,
}

impl Sample {
    /// Adds an observation; clusters are given for all at once by [`Sample::with_clusters`].
    ///
    /// # Errors
    /// [`ImpossibleObservation`].
    pub fn push(&mut self, row: Observation) -> Result<(), ImpossibleObservation> {
        let Observation { intensity, failures, trials, demand } = row;
        let positive = |x: f64| x.is_finite() && x > 0.0;
        if !positive(intensity) {
            return Err(ImpossibleObservation::Intensity(intensity));
        }
        if trials == 0 || failures > trials {
            return Err(ImpossibleObservation::Counts { failures, trials });
        }
        if let Some(demand) = demand.filter(|&demand| !positive(demand)) {
            return Err(ImpossibleObservation::Demand(demand));
        }
        self.ln_intensity.push(intensity.ln());
        self.failures.push(f64::from(failures));
        self.trials.push(f64::from(trials));
        self.ln_demand.push(demand.map(f64::ln));
        Ok(())
    }

    /// Single outcomes.
    ///
    /// # Errors
    /// [`ImpossibleObservation`].
    pub fn from_outcomes(
        outcomes: impl IntoIterator<Item = (f64, bool)>,
    ) -> Result<Self, ImpossibleObservation> {
        let rows = outcomes.into_iter().map(|(intensity, failed)| (intensity, u32::from(failed), 1));
        Self::from_stripes(rows)
    }

    /// Stripes of (intensity, failures, trials).
    ///
    /// # Errors
    /// [`ImpossibleObservation`].
    pub fn from_stripes(
        stripes: impl IntoIterator<Item = (f64, u32, u32)>,
    ) -> Result<Self, ImpossibleObservation> {
        let mut sample = Self::default();
        for (intensity, failures, trials) in stripes {
            sample.push(Observation { intensity, failures, trials, demand: None })?;
        }
        Ok(sample)
    }

    /// The same observations with a further kind of cluster.
    ///
    /// # Panics
    /// If there is not one label an observation: a slip of the caller.
    #[must_use]
    pub fn with_clusters(mut self, clusters: Clusters) -> Self {
        assert_eq!(clusters.of.len(), self.len(), "one cluster an observation");
        self.clusters.push(clusters);
        self
    }

    /// The same trials in rows that hold only failures or only survivals; without clusters, whose labels are by row.
    #[must_use]
    pub fn split(&self) -> Self {
        let mut split = Self::default();
        for i in 0..self.len() {
            let (k, n) = (self.failures[i], self.trials[i]);
            for (failures, trials) in [(k, k), (0.0, n - k)] {
                if trials > 0.0 {
                    split.ln_intensity.push(self.ln_intensity[i]);
                    split.failures.push(failures);
                    split.trials.push(trials);
                    split.ln_demand.push(self.ln_demand[i]);
                }
            }
        }
        split
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.ln_intensity.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// ln of the intensities.
    pub fn ln_intensity(&self) -> &[f64] {
        &self.ln_intensity
    }

    /// Failures, whole numbers.
    pub fn failures(&self) -> &[f64] {
        &self.failures
    }

    /// Trials, whole numbers.
    pub fn trials(&self) -> &[f64] {
        &self.trials
    }

    /// ln of the demands of what stood.
    pub fn ln_demand(&self) -> &[Option<f64>] {
        &self.ln_demand
    }

    /// The kinds of clusters.
    pub fn clusters(&self) -> &[Clusters] {
        &self.clusters
    }

    /// A weight of 1 for each row.
    pub fn unit_weights(&self) -> Vec<f64> {
        vec![1.0; self.len()]
    }

    /// All failures and all trials.
    pub fn totals(&self) -> (f64, f64) {
        (self.failures.iter().sum(), self.trials.iter().sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rejects_observations_that_cannot_be() {
        let reject = |stripe| Sample::from_stripes([stripe]).expect_err("must be refused").to_string();
        assert!(reject((0.0, 0, 1)).contains("intensity 0"));
        assert!(reject((f64::NAN, 0, 1)).contains("NaN"));
        assert!(reject((1.0, 3, 2)).contains("3 failures in 2 trials"));
        assert!(reject((1.0, 0, 0)).contains("0 trials"));
        let demand = Observation { intensity: 1.0, failures: 0, trials: 1, demand: Some(-1.0) };
        assert!(Sample::default().push(demand).is_err());
    }

    #[test]
    fn analytic_labels_become_numbers_in_order_of_appearance() {
        let clusters = Clusters::new("record", ["b", "a", "b", "c"]);
        assert_eq!((clusters.of, clusters.count), (vec![0, 1, 0, 2], 3));
    }
}
