//! The demand by records of the site (Circolare 2019, C8.7.1.2.1.8): the largest S_D(T, ξ) over T from T_0 to T_SLV.
//!
//! A spectrum of records has peaks and gaps. The code therefore takes its largest displacement on the way to T_SLV
//! where it takes that at T_SLV of a smooth one.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::check::{DAMPING, StaticCheck};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_records::response_spectrum_m_s2;

/// Periods that are looked at: 2.3 % apart over a decade, a quarter of the width of a peak at a damping of 5 %.
const PERIODS: i32 = 100;

/// Shortest period, s: displacements below it are below those of any longer one that moves a wall.
const SHORTEST_S: f64 = 0.05;

/// What the records ask of a wall.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SiteRecords {
    /// T_0 (no less than 0.05 s) and T_SLV, s.
    pub period_range_s: [f64; 2],
    /// By record the largest S_D, m.
    pub largest_m: Vec<f64>,
    /// Their mean, m.
    pub demand_slv_m: f64,
    /// d_SLV over it: the factor on all records at which the demand is d_SLV; `None` of records that ask nothing.
    pub zeta: Option<f64>,
}

impl SiteRecords {
    /// What motions where the wall stands ask of it, with the damping of SLV.
    pub fn of(check: &StaticCheck, motions: &[(String, Accelerogram)]) -> Self {
        let period_range_s = [check.t_0_s.max(SHORTEST_S), check.t_slv_s.max(check.t_0_s).max(SHORTEST_S)];
        let [from_s, to_s] = period_range_s;
        let growth = (to_s / from_s).powf(1.0 / f64::from(PERIODS));
        let periods_s: Vec<f64> = (0..=PERIODS).map(|i| from_s * growth.powi(i)).collect();
        let largest = |(_, motion): &(String, Accelerogram)| {
            let spectrum_m_s2 = response_spectrum_m_s2(motion, &periods_s, DAMPING[1]);
            let displacements_m = spectrum_m_s2.iter().zip(&periods_s).map(|(sa, t)| sa * (t / TAU).powi(2));
            displacements_m.fold(0.0, f64::max)
        };
        let largest_m: Vec<f64> = motions.iter().map(largest).collect();
        let demand_slv_m = largest_m.iter().sum::<f64>() / largest_m.len() as f64;
        let zeta = (demand_slv_m > 0.0).then(|| check.d_slv_m / demand_slv_m);
        Self { period_range_s, largest_m, demand_slv_m, zeta }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::{Capacity, SiteFile};
    use mrbd_kernel::model::{Wall, WallParameters};
    use mrbd_statics::Edges;

    fn check() -> StaticCheck {
        let wall = Wall::new(WallParameters::strip(0.4, 3.2, 1800.0)).expect("a wall");
        let capacity = Capacity::of(&wall, Edges::AsTheyAre).expect("a mechanism");
        let site = "[site]\nag_g = 0.2\nf0 = 2.5\ntc_star_s = 0.3\nsoil = \"A\"\n";
        let site = SiteFile::parse(Path::new("site.toml"), site).expect("a site");
        StaticCheck::of(&wall, &capacity, &site, false)
    }

    /// A long sine of period T: an oscillator of that period comes to S_D = a T²/(4π²)/(2ξ).
    fn sine(period_s: f64, amplitude_m_s2: f64) -> (String, Accelerogram) {
        let sample = |k: i32| amplitude_m_s2 * (TAU * f64::from(k) * 0.01 / period_s).sin();
        let motion = Accelerogram::new(0.01, (0..6000).map(sample).collect()).expect("samples");
        ("sine".to_owned(), motion)
    }

    #[test]
    fn analytic_a_resonance_on_the_way_is_what_is_asked() {
        let check = check();
        let resonance_m = |period_s: f64| (period_s / TAU).powi(2) / (2.0 * DAMPING[1]);
        assert!(check.t_slv_s > 1.2, "{}", check.t_slv_s);
        let found = SiteRecords::of(&check, &[sine(1.0, 1.0)]);
        // The largest lies a little beyond the period of the sine, by less than ξ, and periods are 2.3 % apart.
        assert!((found.demand_slv_m / resonance_m(1.0) - 1.0).abs() < 0.02, "{}", found.demand_slv_m);
        // At T_SLV itself the oscillator is beyond the resonance.
        let at_t_slv = response_spectrum_m_s2(&sine(1.0, 1.0).1, &[check.t_slv_s], DAMPING[1])[0];
        assert!(at_t_slv * (check.t_slv_s / TAU).powi(2) < 0.8 * found.demand_slv_m);
    }

    #[test]
    fn analytic_the_demand_is_the_mean_and_grows_with_the_records() {
        let check = check();
        let of = |motions: &[(String, Accelerogram)]| SiteRecords::of(&check, motions);
        let [one, two] = [1.0, 3.0].map(|amplitude| of(&[sine(0.8, amplitude)]));
        let both = of(&[sine(0.8, 1.0), sine(0.8, 3.0)]);
        assert!((both.demand_slv_m / (0.5 * (one.demand_slv_m + two.demand_slv_m)) - 1.0).abs() < 1e-14);
        assert!((two.demand_slv_m / one.demand_slv_m - 3.0).abs() < 1e-12);
        assert!((one.zeta.expect("a demand") * one.demand_slv_m / check.d_slv_m - 1.0).abs() < 1e-14);
        assert_eq!(of(&[sine(0.8, 0.0)]).zeta, None, "nothing moves");
    }
}
