//! Floor spectra of the Italian code's commentary: what a wall on a floor of a building is shaken with.
//!
//! Circolare 21 gennaio 2019, n. 7, C7.2.3: equations C7.2.5 to C7.2.10 for any building, C7.2.11 for framed ones.

use super::{Building, Mode, Site};

/// Where a mode's plateau begins and ends, over its period.
const PLATEAU: [f64; 2] = [0.8, 1.1];

/// A building on a site.
#[derive(Debug, Clone, PartialEq)]
pub struct FloorSpectrum<'a> {
    /// The site.
    pub site: Site,
    /// The building, and the height in it.
    pub building: &'a Building,
}

impl FloorSpectrum<'_> {
    /// S_eZ(T, ξ, z) (C7.2.5), m/s²: modes by the root of squares; beyond T_1 not below that of the ground.
    pub fn elastic_m_s2(&self, period_s: f64, damping: f64) -> f64 {
        let squares = self
            .building
            .all_modes()
            .iter()
            .map(|mode| self.of_mode(mode, period_s, damping).powi(2))
            .sum::<f64>();
        let floor = squares.sqrt();
        if period_s > self.building.period_s { floor.max(self.of_ground(period_s, damping)) } else { floor }
    }

    /// The end of the first mode's plateau b T_1, s.
    pub fn plateau_end_s(&self) -> f64 {
        PLATEAU[1] * self.building.period_s
    }

    fn of_ground(&self, period_s: f64, damping: f64) -> f64 {
        Site { damping, ..self.site }.elastic_m_s2(period_s)
    }

    /// S_eZ,k (C7.2.6), m/s².
    fn of_mode(&self, mode: &Mode, period_s: f64, damping: f64) -> f64 {
        let peak = self.peak_m_s2(mode);
        let a = amplification(self.building.damping, damping);
        let [from_s, to_s] = PLATEAU.map(|share| share * mode.period_s);
        if period_s < from_s {
            a * peak / (1.0 + (a - 1.0) * (1.0 - period_s / from_s).powf(1.6))
        } else if period_s < to_s {
            a * peak
        } else {
            a * peak / (1.0 + (a - 1.0) * (period_s / to_s - 1.0).powf(1.2))
        }
    }

    /// a_Z,k = S_e(T_k, ξ_k) |γ_k ψ_k| √(1 + 0.0004 ξ_k²) (C7.2.7, ξ_k in percent), m/s².
    fn peak_m_s2(&self, mode: &Mode) -> f64 {
        let damping = self.building.damping;
        let percent = 100.0 * damping;
        let ground = self.of_ground(mode.period_s, damping);
        ground * mode.participation.abs() * (1.0 + 0.0004 * percent * percent).sqrt()
    }

    /// S_a(T_a) of C7.2.11, m/s²: framed buildings whose first mode is a line.
    pub fn framed_m_s2(&self, period_s: f64) -> f64 {
        let t_1 = self.building.period_s;
        let [a, b, a_p] = framed(t_1);
        let ground = self.of_ground(0.0, self.site.damping);
        let short = period_s.clamp(a * t_1, b * t_1);
        // The distance from the plateau, whose ends are a T_1 and b T_1.
        let away = if period_s == short { 0.0 } else { 1.0 - period_s / short };
        let raised = ground * (1.0 + self.building.height_ratio) * a_p / (1.0 + (a_p - 1.0) * away * away);
        raised.max(ground)
    }
}

/// A_k = 1.1 ξ_k^-0.5 η(ξ) (C7.2.8, C7.2.9), dampings relative to critical: 4.9 for 5 %.
///
/// η counts ξ in percent. ξ_k stands for itself under the root: in percent A_k would be 0.5 and a floor would shake least
/// what is in tune with it. Records brought to a floor show which of the two it is (`floor_motion`).
fn amplification(of_mode: f64, damping: f64) -> f64 {
    1.1 * of_mode.powf(-0.5) * (10.0 / (5.0 + 100.0 * damping)).sqrt()
}

/// a, b and a_p of C7.2.11.
fn framed(period_s: f64) -> [f64; 3] {
    if period_s < 0.5 {
        [0.8, 1.4, 5.0]
    } else if period_s <= 1.0 {
        [0.3, 1.2, 4.0]
    } else {
        [0.3, 1.0, 2.5]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Soil, Topography};
    use mrbd_kernel::model::G_M_S2;

    fn site() -> Site {
        Site { ag_g: 0.25, f0: 2.5, tc_star_s: 0.3, soil: Soil::A, topography: Topography::T1, damping: 0.05 }
    }

    fn building(height_ratio: f64) -> Building {
        Building { height_ratio, period_s: 0.2, storeys: 3, damping: 0.05, modes: Vec::new() }
    }

    #[test]
    fn analytic_branches_of_a_mode_by_hand() {
        let building = building(2.0 / 3.0);
        let floor = FloorSpectrum { site: site(), building: &building };
        // γ_1 = 9/7, ψ_1 = 2/3, S_e(0.2 s) = 0.25 g 2.5 on the plateau; √(1 + 0.0004·25) = √1.01.
        let peak = 0.25 * G_M_S2 * 2.5 * (9.0 / 7.0) * (2.0 / 3.0) * 1.01_f64.sqrt();
        let a = 1.1 / 0.05_f64.sqrt() * (10.0_f64 / 13.0).sqrt();
        for (period_s, value) in [
            (0.0, peak),
            (0.08, a * peak / (1.0 + (a - 1.0) * 0.5_f64.powf(1.6))),
            (0.16, a * peak),
            (0.2, a * peak),
            (0.22, a * peak),
            (0.44, peak),
        ] {
            // Roundings of powers. At 0.44 s the distance from 0.22 s is 1, so A/(1 + (A - 1)) = 1.
            let found = floor.elastic_m_s2(period_s, 0.08);
            let ground = Site { damping: 0.08, ..site() }.elastic_m_s2(period_s);
            let expected = if period_s > 0.2 { value.max(ground) } else { value };
            assert!((found / expected - 1.0).abs() < 1e-12, "{period_s}: {found} {expected}");
        }
    }

    #[test]
    fn analytic_modes_add_by_the_root_of_squares_and_the_ground_is_the_least() {
        let mut building = building(1.0);
        let one = FloorSpectrum { site: site(), building: &building }.elastic_m_s2(0.1, 0.05);
        building.modes = vec![Mode { period_s: 0.2, participation: building.participation() }];
        let two = FloorSpectrum { site: site(), building: &building }.elastic_m_s2(0.1, 0.05);
        assert!((two / one - 2.0_f64.sqrt()).abs() < 1e-12);
        let low = self::building(0.01);
        let floor = FloorSpectrum { site: site(), building: &low };
        assert_eq!(floor.elastic_m_s2(1.5, 0.05), site().elastic_m_s2(1.5));
    }

    #[test]
    fn analytic_a_framed_building_has_its_plateau_and_never_less_than_the_ground() {
        let building = building(1.0);
        let floor = FloorSpectrum { site: site(), building: &building };
        let ground = 0.25 * G_M_S2;
        for (period_s, value) in
            [(0.2, 10.0 * ground), (0.0, 2.0 * ground), (0.16, 10.0 * ground), (5.0, ground)]
        {
            assert!((floor.framed_m_s2(period_s) / value - 1.0).abs() < 1e-12, "{period_s}");
        }
    }
}
