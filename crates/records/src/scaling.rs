//! Scaling a record to an intensity: which measures scaling changes, and by how much.

use serde::{Deserialize, Serialize};

use super::IntensityMeasures;

/// A measure that scaling changes. The names are those of the columns; the unit stands in them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ScaledMeasure {
    /// Largest absolute acceleration, m/s².
    #[serde(rename = "pga_m_s2")]
    PgaMS2,
    /// The same in g.
    #[serde(rename = "pga_g")]
    PgaG,
    /// Largest absolute velocity, m/s.
    #[serde(rename = "pgv_m_s")]
    Pgv,
    /// Largest absolute displacement, m.
    #[serde(rename = "pgd_m")]
    Pgd,
    /// Arias intensity, m/s; it grows with the square of the factor.
    #[serde(rename = "arias_m_s")]
    Arias,
    /// Cumulative absolute velocity, m/s.
    #[serde(rename = "cav_m_s")]
    Cav,
    /// Pseudo-acceleration at 0.5 s, m/s².
    #[serde(rename = "sa_0p5s_m_s2")]
    SaHalfSecond,
    /// Pseudo-acceleration at 1.0 s, m/s².
    #[serde(rename = "sa_1p0s_m_s2")]
    SaOneSecond,
    /// Geometric mean of pseudo-accelerations, m/s².
    #[serde(rename = "sa_average_m_s2")]
    SaAverage,
}

impl ScaledMeasure {
    /// Name in input and result files.
    pub fn name(self) -> &'static str {
        match self {
            ScaledMeasure::PgaMS2 => "pga_m_s2",
            ScaledMeasure::PgaG => "pga_g",
            ScaledMeasure::Pgv => "pgv_m_s",
            ScaledMeasure::Pgd => "pgd_m",
            ScaledMeasure::Arias => "arias_m_s",
            ScaledMeasure::Cav => "cav_m_s",
            ScaledMeasure::SaHalfSecond => "sa_0p5s_m_s2",
            ScaledMeasure::SaOneSecond => "sa_1p0s_m_s2",
            ScaledMeasure::SaAverage => "sa_average_m_s2",
        }
    }

    /// Its value among the measures of a record, in the unit of its name.
    pub fn of(self, measures: &IntensityMeasures) -> f64 {
        match self {
            ScaledMeasure::PgaMS2 => measures.pga_m_s2,
            ScaledMeasure::PgaG => measures.pga_g,
            ScaledMeasure::Pgv => measures.pgv_m_s,
            ScaledMeasure::Pgd => measures.pgd_m,
            ScaledMeasure::Arias => measures.arias_m_s,
            ScaledMeasure::Cav => measures.cav_m_s,
            ScaledMeasure::SaHalfSecond => measures.sa_0p5s_m_s2,
            ScaledMeasure::SaOneSecond => measures.sa_1p0s_m_s2,
            ScaledMeasure::SaAverage => measures.sa_average_m_s2,
        }
    }

    /// The factor on a record with these measures that gives it the intensity `value`.
    pub fn factor_to(self, measures: &IntensityMeasures, value: f64) -> f64 {
        let ratio = value / self.of(measures);
        match self {
            ScaledMeasure::Arias => ratio.sqrt(),
            _ => ratio,
        }
    }
}

impl IntensityMeasures {
    /// The measures of the same record times a factor above 0; duration and mean period stay what they are.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            pga_m_s2: self.pga_m_s2 * factor,
            pga_g: self.pga_g * factor,
            pgv_m_s: self.pgv_m_s * factor,
            pgd_m: self.pgd_m * factor,
            arias_m_s: self.arias_m_s * factor * factor,
            cav_m_s: self.cav_m_s * factor,
            duration_5_95_s: self.duration_5_95_s,
            mean_period_s: self.mean_period_s,
            sa_0p5s_m_s2: self.sa_0p5s_m_s2 * factor,
            sa_1p0s_m_s2: self.sa_1p0s_m_s2 * factor,
            sa_average_m_s2: self.sa_average_m_s2 * factor,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Accelerogram;

    const ALL: [ScaledMeasure; 9] = [
        ScaledMeasure::PgaMS2,
        ScaledMeasure::PgaG,
        ScaledMeasure::Pgv,
        ScaledMeasure::Pgd,
        ScaledMeasure::Arias,
        ScaledMeasure::Cav,
        ScaledMeasure::SaHalfSecond,
        ScaledMeasure::SaOneSecond,
        ScaledMeasure::SaAverage,
    ];

    #[test]
    fn analytic_measures_of_a_scaled_record_are_the_scaled_measures() {
        let samples = (0..400).map(|i| (0.07 * f64::from(i)).sin() * (0.011 * f64::from(i)).cos()).collect();
        let record = Accelerogram::new(0.01, samples).expect("a record");
        let own = IntensityMeasures::of(&record);
        let [a, b] = [own.scaled(2.7), IntensityMeasures::of(&record.scaled(2.7))];
        for measure in ALL {
            // Rounding of sums over 400 samples.
            assert!((measure.of(&a) / measure.of(&b) - 1.0).abs() < 1e-12, "{measure:?}");
            let factor = measure.factor_to(&own, 3.0 * measure.of(&own));
            assert!((measure.of(&own.scaled(factor)) / measure.of(&own) - 3.0).abs() < 1e-14, "{measure:?}");
        }
        assert_eq!((a.duration_5_95_s, a.mean_period_s), (own.duration_5_95_s, own.mean_period_s));
    }
}
