//! What a generated record should be: peaks, length, spectrum.

use crate::code_spectrum::Site;
use crate::record_table::{RecordTable, TableRow};
use mrbd_kernel::model::G_M_S2;

/// Amplification of the plateau over the peak acceleration, within the 2.2 to 2.7 of codes.
const PLATEAU: f64 = 2.6;
/// Pseudo-velocity of the falling branch over the peak velocity (Newmark and Hall 1982, median at 5 % damping).
const VELOCITY_AMPLIFICATION: f64 = 1.65;
/// Where the mean aims, over the code: near the middle of the allowed −10 % to +30 %.
const ABOVE_CODE: f64 = 1.08;
/// Below this period the adjustment to the code fades, so as not to fight the peak acceleration, s.
const RIGID_PERIOD_S: f64 = 0.03;
/// Share of the peaks that the noise has in a record with a pulse.
const NOISE_BESIDE_PULSE: f64 = 0.45;
/// Periods of the target, from the rigid to the longest of the code, evenly in logarithm.
const PERIODS: usize = 70;
const LONGEST_PERIOD_S: f64 = 4.0;

/// A target spectrum: periods (s) and pseudo-accelerations (m/s²).
pub(super) struct Target {
    pub period_s: Vec<f64>,
    pub sa_m_s2: Vec<f64>,
}

/// Design of one record, as scaled.
pub(super) struct Design {
    pub pga_m_s2: f64,
    pub pgv_m_s: f64,
    /// Peak velocity of the noise alone; without a pulse, of the record.
    pub noise_pgv_m_s: f64,
    /// Significant duration, s.
    pub duration_s: f64,
    /// Period where constant velocity begins, s.
    pub corner_s: f64,
    noise_share: f64,
    adjustment: Vec<f64>,
}

/// Designs of all rows; with a site, adjusted together so that their mean follows the code.
pub(super) fn designs(table: &RecordTable, site: Option<&Site>) -> Vec<Design> {
    let mut designs: Vec<Design> = table.records.iter().map(Design::new).collect();
    if let Some(site) = site {
        let adjustment: Vec<f64> =
            periods_s().iter().map(|&period| adjustment(&designs, site, period)).collect();
        for design in &mut designs {
            design.adjustment.clone_from(&adjustment);
        }
    }
    designs
}

fn adjustment(designs: &[Design], site: &Site, period_s: f64) -> f64 {
    let at = period_s.max(site.tb_s());
    let mean = designs.iter().map(|d| d.shape_m_s2(at)).sum::<f64>() / designs.len() as f64;
    let full = (ABOVE_CODE * site.elastic_m_s2(at) / mean).ln();
    let share = ((period_s / RIGID_PERIOD_S).ln() / (site.tb_s() / RIGID_PERIOD_S).ln()).clamp(0.0, 1.0);
    (full * share).exp()
}

fn periods_s() -> Vec<f64> {
    let ratio = (LONGEST_PERIOD_S / RIGID_PERIOD_S).ln() / (PERIODS - 1) as f64;
    (0..PERIODS).map(|i| RIGID_PERIOD_S * (ratio * i as f64).exp()).collect()
}

impl Design {
    fn new(row: &TableRow) -> Self {
        let pga_m_s2 = row.pga_g * row.scale * G_M_S2;
        let pgv_m_s = row.pgv_m_s * row.scale;
        let noise_share = if row.pulse_period_s.is_some() { NOISE_BESIDE_PULSE } else { 1.0 };
        Self {
            pga_m_s2,
            pgv_m_s,
            noise_pgv_m_s: noise_share * pgv_m_s,
            duration_s: duration_s(row.magnitude, row.distance_km),
            corner_s: std::f64::consts::TAU * VELOCITY_AMPLIFICATION * pgv_m_s / (PLATEAU * pga_m_s2),
            noise_share,
            adjustment: vec![1.0; PERIODS],
        }
    }

    /// The target spectrum of the noise.
    pub fn target(&self) -> Target {
        let period_s = periods_s();
        let values = period_s.iter().zip(&self.adjustment);
        let sa_m_s2 = values.map(|(&period, c)| c * self.noise_share * self.shape_m_s2(period)).collect();
        Target { period_s, sa_m_s2 }
    }

    /// A spectrum of the form of the codes: rising, flat, falling as 1/T, as 1/T², m/s².
    fn shape_m_s2(&self, period_s: f64) -> f64 {
        let start = (self.corner_s / 3.0).min(0.145);
        let end = 2.0_f64.max(2.0 * self.corner_s);
        let rise = (period_s / start).min(1.0);
        let fall = (self.corner_s / period_s).min(1.0) * (end / period_s).min(1.0);
        self.pga_m_s2 * (1.0 + (PLATEAU - 1.0) * rise) * fall
    }
}

/// Significant duration on ground between rock and alluvium: −4.88 + 2.33·M + 0.149·Δ (Trifunac and Brady 1975, "A study
/// on the duration of strong earthquake ground motion", s = 1), s.
///
/// The coefficients are those that reviews quote; they were not checked against the source, and only set a length.
fn duration_s(magnitude: f64, distance_km: f64) -> f64 {
    (-4.88 + 2.33 * magnitude + 0.149 * distance_km).clamp(4.0, 60.0)
}
