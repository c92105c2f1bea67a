//! What the code asks of a wall on the ground or on a floor: spectral accelerations and displacements.

use std::f64::consts::TAU;

use mrbd_kernel::model::G_M_S2;
use mrbd_records::{Building, FloorSpectrum, Site};

/// Largest a_g that is looked for, g: beyond it a wall needs no check.
const MOST_AG_G: f64 = 10.0;
/// Least a_g that is looked for, g.
const LEAST_AG_G: f64 = 1e-5;
/// Steps between them: 2.8 % each, so that no crossing of a site's amplification is passed over.
const STEPS: u32 = 500;

/// Where a wall stands.
#[derive(Debug, Clone, Copy)]
pub struct Place<'a> {
    /// The site.
    pub site: Site,
    /// The building, for a wall above the ground.
    pub building: Option<&'a Building>,
}

impl Place<'_> {
    /// S_e(T, ξ) at the ground, S_eZ(T, ξ, z) (C7.2.5) on a floor, m/s².
    pub fn acceleration_m_s2(&self, period_s: f64, damping: f64) -> f64 {
        let site = Site { damping, ..self.site };
        match self.building {
            None => site.elastic_m_s2(period_s),
            Some(building) => FloorSpectrum { site, building }.elastic_m_s2(period_s, damping),
        }
    }

    /// The displacement that is asked, m: S_De(T) at the ground, C8.7.1.12 on a floor.
    pub fn displacement_m(&self, period_s: f64, damping: f64) -> f64 {
        let site = Site { damping, ..self.site };
        let Some(building) = self.building else { return site.displacement_m(period_s) };
        let floor = FloorSpectrum { site, building };
        let spectral = |acceleration_m_s2: f64, period_s: f64| acceleration_m_s2 * (period_s / TAU).powi(2);
        let asked_m = spectral(floor.elastic_m_s2(period_s, damping), period_s);
        let end_s = floor.plateau_end_s();
        if period_s <= end_s {
            return asked_m;
        }
        // At least S_eZ(T_1) b² T_1²/4π²: a longer period does not make it less.
        asked_m.max(spectral(floor.elastic_m_s2(building.period_s, damping), end_s))
    }

    /// The least a_g, m/s², at which a demand reaches what the wall has; `None` beyond 10 g.
    ///
    /// Amplification S_S and T_D follow a_g (NTC 2018, Table 3.2.IV and eq. 3.2.7); F_0 and T_C* stay.
    pub fn ag_reaching_m_s2(&self, has: f64, demand: impl Fn(&Place) -> f64) -> Option<f64> {
        let reached = |ag_g: f64| demand(&Place { site: Site { ag_g, ..self.site }, ..*self }) >= has;
        let growth = (MOST_AG_G / LEAST_AG_G).powf(1.0 / f64::from(STEPS));
        let mut steps = (0..=STEPS).map(|i| LEAST_AG_G * growth.powi(i as i32));
        let mut high = steps.find(|ag_g| reached(*ag_g))?;
        let mut low = if high > LEAST_AG_G { high / growth } else { 0.0 };
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if reached(middle) { high = middle } else { low = middle }
        }
        Some(high * G_M_S2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_records::{Soil, Topography};

    fn site(soil: Soil) -> Site {
        Site { ag_g: 0.2, f0: 2.5, tc_star_s: 0.3, soil, topography: Topography::T1, damping: 0.05 }
    }

    #[test]
    fn analytic_the_acceleration_found_asks_for_what_the_wall_has() {
        for soil in [Soil::A, Soil::C, Soil::D] {
            let place = Place { site: site(soil), building: None };
            let ag_m_s2 =
                place.ag_reaching_m_s2(0.12, |place| place.displacement_m(1.4, 0.08)).expect("reached");
            let at = Place { site: Site { ag_g: ag_m_s2 / G_M_S2, ..place.site }, ..place };
            assert!((at.displacement_m(1.4, 0.08) - 0.12).abs() < 1e-12, "{soil:?}");
        }
        let rock = Place { site: site(Soil::A), building: None };
        // On rock the peak acceleration is a_g itself.
        let ag = rock.ag_reaching_m_s2(1.3, |place| place.acceleration_m_s2(0.0, 0.05)).expect("reached");
        assert!((ag - 1.3).abs() < 1e-12);
        assert!(rock.ag_reaching_m_s2(1e9, |place| place.acceleration_m_s2(0.0, 0.05)).is_none());
    }

    #[test]
    fn analytic_beyond_the_plateau_of_a_floor_displacements_do_not_fall() {
        let building =
            Building { height_ratio: 1.0, period_s: 0.4, storeys: 3, damping: 0.05, modes: Vec::new() };
        let floor = Place { site: site(Soil::A), building: Some(&building) };
        let plateau_m = floor.displacement_m(0.44, 0.08);
        assert!(
            (plateau_m / (floor.acceleration_m_s2(0.4, 0.08) * (0.44 / TAU).powi(2)) - 1.0).abs() < 1e-12
        );
        for period_s in [0.45, 0.6, 1.0, 3.0] {
            assert!(floor.displacement_m(period_s, 0.08) >= plateau_m * (1.0 - 1e-12), "{period_s}");
        }
    }
}
