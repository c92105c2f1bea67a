//! The code's check of a local mechanism: Circolare 2019, C8.7.1.2.1, linear and nonlinear kinematic analysis.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

use crate::capacity::{Capacity, Governing, LIMIT_STATES};
use crate::demand::Place;
use crate::site_file::{Assumed, SiteFile};
use mrbd_kernel::model::{G_M_S2, Wall};

/// Damping of the damage limit state, of SLV and of SLC (C8.7.1.2.1.6, .8).
pub const DAMPING: [f64; 3] = [0.05, 0.08, 0.10];
/// T_SLV and T_SLC over √(d/a) (C8.7.1.10, C8.7.1.11).
const PERIODS: [f64; 2] = [1.68 * PI, 1.56 * PI];
/// Behaviour factor of the linear check.
const Q: f64 = 2.0;

/// The check of a wall at one place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StaticCheck {
    /// `ground` or `floor`.
    pub place: String,
    /// a_0 = α_0 g/(e* FC), m/s².
    pub a_0_m_s2: f64,
    /// T_0 (C8.7.1.7), s; 0 for a wall that is taken as rigid.
    pub t_0_s: f64,
    /// a_g at which the mechanism begins (C8.7.1.8, .9), m/s²; `None` beyond 10 g, here and below.
    pub ag_sld_m_s2: Option<f64>,
    /// That over the a_g of the damage limit state; `None` where the site file has none.
    pub zeta_sld: Option<f64>,
    /// 0.4 d_0, m.
    pub d_slv_m: f64,
    /// 0.6 d_0, m.
    pub d_slc_m: f64,
    /// a(d_SLV), m/s².
    pub a_slv_m_s2: f64,
    /// a(d_SLC), m/s².
    pub a_slc_m_s2: f64,
    /// T_SLV (C8.7.1.10), s.
    pub t_slv_s: f64,
    /// T_SLC (C8.7.1.11), s.
    pub t_slc_s: f64,
    /// Displacement that the site's own a_g asks at T_SLV, m.
    pub demand_slv_m: f64,
    /// a_g at which the demand is d_SLV (C8.7.1.12), m/s².
    pub ag_slv_m_s2: Option<f64>,
    /// ζ = a_g,SLV/a_g.
    pub zeta: Option<f64>,
    /// a_g at which the demand is d_SLC, m/s².
    pub ag_slc_m_s2: Option<f64>,
    /// That over the a_g of the limit state of collapse; `None` where the site file has none.
    pub zeta_slc: Option<f64>,
    /// Whether ζ is 1 or more.
    pub accepted: bool,
    /// The linear check.
    pub linear: Linear,
    /// The line of the Circolare 617/2009, at the ground only.
    pub circolare_617: Option<Earlier>,
}

/// The linear check with a behaviour factor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Linear {
    /// q.
    pub q: f64,
    /// a_g,SLV = q a_g,SLD, m/s².
    pub ag_slv_m_s2: Option<f64>,
    /// That over a_g.
    pub zeta: Option<f64>,
}

/// The nonlinear check as the Circolare 617/2009 had it, for old sheets.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Earlier {
    /// d_u* = 0.4 d_0*, m.
    pub d_u_m: f64,
    /// d_s* = 0.4 d_u*, m.
    pub d_s_m: f64,
    /// T_s = 2π √(d_s*/a_s*), s.
    pub t_s_s: f64,
    /// a_g at which S_De(T_s) is d_u*, m/s².
    pub ag_slv_m_s2: Option<f64>,
    /// That over a_g.
    pub zeta: Option<f64>,
}

impl StaticCheck {
    /// Of a wall with a capacity, where its site file puts it; at its foot instead with `at_ground`.
    pub fn of(wall: &Wall, capacity: &Capacity, file: &SiteFile, at_ground: bool) -> Self {
        let building = file.floor().filter(|_| !at_ground);
        let place = Place { site: file.site, building };
        let assumed = &file.assessment;
        let a_0_m_s2 = capacity.alpha_0 * G_M_S2 / (capacity.e_star * assumed.confidence_factor);
        let t_0_s = own_period_s(wall, capacity.mechanism, assumed);
        let [of_sld, of_slv, of_slc] = DAMPING;
        let ag_sld_m_s2 = place.ag_reaching_m_s2(a_0_m_s2, |place| place.acceleration_m_s2(t_0_s, of_sld));
        let slv = LimitState::of(capacity, assumed, LIMIT_STATES[0], PERIODS[0]);
        let slc = LimitState::of(capacity, assumed, LIMIT_STATES[1], PERIODS[1]);
        let [ag_slv_m_s2, ag_slc_m_s2] = [(slv, of_slv), (slc, of_slc)].map(|(s, xi)| s.ag_m_s2(&place, xi));
        let site_g = Some(file.site.ag_g);
        let linear_m_s2 = ag_sld_m_s2.map(|ag| Q * ag);
        Self {
            place: if building.is_some() { "floor" } else { "ground" }.to_owned(),
            a_0_m_s2,
            t_0_s,
            ag_sld_m_s2,
            zeta_sld: zeta(ag_sld_m_s2, assumed.ag_sld_g),
            d_slv_m: slv.d_m,
            d_slc_m: slc.d_m,
            a_slv_m_s2: slv.a_m_s2,
            a_slc_m_s2: slc.a_m_s2,
            t_slv_s: slv.t_s,
            t_slc_s: slc.t_s,
            demand_slv_m: place.displacement_m(slv.t_s, of_slv),
            ag_slv_m_s2,
            zeta: zeta(ag_slv_m_s2, site_g),
            ag_slc_m_s2,
            zeta_slc: zeta(ag_slc_m_s2, assumed.ag_slc_g),
            accepted: zeta(ag_slv_m_s2, site_g).is_none_or(|zeta| zeta >= 1.0),
            linear: Linear { q: Q, ag_slv_m_s2: linear_m_s2, zeta: zeta(linear_m_s2, site_g) },
            circolare_617: building.is_none().then(|| earlier(capacity, &place, assumed)),
        }
    }
}

/// ζ: an a_g over the site's, both known.
fn zeta(ag_m_s2: Option<f64>, site_g: Option<f64>) -> Option<f64> {
    Some(ag_m_s2? / (site_g? * G_M_S2))
}

/// The wall at a limit state: displacement, acceleration there, period of the secant.
#[derive(Debug, Clone, Copy)]
struct LimitState {
    d_m: f64,
    a_m_s2: f64,
    t_s: f64,
}

impl LimitState {
    /// At a share of d_0, with T = factor √(d/a).
    fn of(capacity: &Capacity, assumed: &Assumed, share: f64, factor: f64) -> Self {
        let d_m = share * capacity.d_0_m;
        let a_m_s2 = capacity.acceleration_m_s2(d_m, assumed.confidence_factor);
        Self { d_m, a_m_s2, t_s: factor * (d_m / a_m_s2).sqrt() }
    }

    /// The a_g at which the demand at T is d (C8.7.1.12), m/s².
    fn ag_m_s2(self, place: &Place, damping: f64) -> Option<f64> {
        place.ag_reaching_m_s2(self.d_m, |place| place.displacement_m(self.t_s, damping))
    }
}

/// T_0 = κ λ L √(W/(E g)) (C8.7.1.7) of the part that moves, W its weight per volume, s.
fn own_period_s(wall: &Wall, mechanism: Governing, assumed: &Assumed) -> f64 {
    let Some(modulus_pa) = assumed.elastic_modulus_pa else { return 0.0 };
    let p = wall.parameters();
    let upper_m = p.height_m - p.crack_height_m.unwrap_or(0.0);
    let (kappa, length_m) = match mechanism {
        Governing::OneBlock => (6.2, p.height_m),
        Governing::UpperBody => (6.2, upper_m),
        Governing::VerticalBending | Governing::Restrained => (2.2, p.height_m),
    };
    let density_kg_m3 = p.mass_kg / (p.thickness_m * p.height_m * p.length_m);
    kappa * length_m / p.thickness_m * length_m * (density_kg_m3 / modulus_pa).sqrt()
}

/// The nonlinear check of the Circolare 617/2009 (C8A.4.2.3) at the ground, damping 5 %.
fn earlier(capacity: &Capacity, place: &Place, assumed: &Assumed) -> Earlier {
    let d_u_m = 0.4 * capacity.d_0_m;
    let d_s_m = 0.4 * d_u_m;
    let a_s_m_s2 = capacity.acceleration_m_s2(d_s_m, assumed.confidence_factor);
    let t_s_s = TAU * (d_s_m / a_s_m_s2).sqrt();
    let ag_slv_m_s2 = place.ag_reaching_m_s2(d_u_m, |place| place.displacement_m(t_s_s, DAMPING[0]));
    Earlier { d_u_m, d_s_m, t_s_s, ag_slv_m_s2, zeta: zeta(ag_slv_m_s2, Some(place.site.ag_g)) }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use mrbd_kernel::model::WallParameters;
    use mrbd_statics::Edges;

    fn site(more: &str) -> SiteFile {
        let text = format!("[site]\nag_g = 0.2\nf0 = 2.5\ntc_star_s = 0.3\nsoil = \"A\"\n{more}");
        SiteFile::parse(Path::new("site.toml"), &text).expect("a site")
    }

    fn check(wall: &Wall, more: &str) -> (Capacity, StaticCheck) {
        let capacity = Capacity::of(wall, Edges::AsTheyAre).expect("a mechanism");
        let check = StaticCheck::of(wall, &capacity, &site(more), false);
        (capacity, check)
    }

    fn block() -> Wall {
        Wall::new(WallParameters::strip(0.4, 3.2, 1800.0)).expect("a wall")
    }

    #[test]
    fn analytic_a_free_block_by_hand() {
        // α_0 = 0.125, e* = 3/4, FC 1.35: a_0 = 0.125·9.81/(0.75·1.35). d_0 = (2/3) of the top's way. On rock, rigid: a_g,SLD = a_0.
        let (capacity, found) = check(&block(), "");
        let a_0 = 0.125 * 9.81 / (0.75 * 1.35);
        assert!((found.a_0_m_s2 / a_0 - 1.0).abs() < 1e-12);
        assert!((found.ag_sld_m_s2.expect("reached") / a_0 - 1.0).abs() < 1e-9);
        assert!((found.linear.ag_slv_m_s2.expect("reached") / (2.0 * a_0) - 1.0).abs() < 1e-9);
        let d_0 = 2.0 / 3.0 * 0.4;
        // Finite rotations of 0.125 rad leave their square, 1.6 %, here and in T_SLV.
        assert!((capacity.d_0_m / d_0 - 1.0).abs() < 0.016);
        assert!((found.d_slv_m / (0.4 * d_0) - 1.0).abs() < 0.016);
        let t_slv = 1.68 * PI * (0.4 * d_0 / (0.6 * a_0)).sqrt();
        assert!((found.t_slv_s / t_slv - 1.0).abs() < 0.016, "{} {t_slv}", found.t_slv_s);
        // T_SLV = 2.06 s lies between T_C = 0.3 s and T_D = 4 a_g/g + 1.6: the branch of constant velocity or beyond it.
        let ag = found.ag_slv_m_s2.expect("reached");
        let td = 4.0 * ag / 9.81 + 1.6;
        let eta = (10.0_f64 / 13.0).sqrt();
        let shape = if found.t_slv_s < td { 0.3 / found.t_slv_s } else { 0.3 * td / found.t_slv_s.powi(2) };
        let demand = ag * eta * 2.5 * shape * (found.t_slv_s / TAU).powi(2);
        assert!((demand / found.d_slv_m - 1.0).abs() < 1e-9);
        assert!((found.zeta.expect("reached") - ag / (0.2 * 9.81)).abs() < 1e-12);
        let earlier = found.circolare_617.expect("at the ground");
        assert!((earlier.d_s_m - 0.16 * capacity.d_0_m).abs() < 1e-15);
        let t_s = TAU * (0.16 * d_0 / (0.84 * a_0)).sqrt();
        assert!((earlier.t_s_s / t_s - 1.0).abs() < 0.016);
    }

    #[test]
    fn analytic_confidence_lengthens_periods_and_lowers_what_is_borne() {
        let [limited, full] =
            ["", "[assessment]\nconfidence_factor = 1.0\n"].map(|more| check(&block(), more).1);
        assert!((full.a_0_m_s2 / limited.a_0_m_s2 - 1.35).abs() < 1e-12);
        assert!((limited.t_slv_s / full.t_slv_s - 1.35_f64.sqrt()).abs() < 1e-12);
        assert_eq!(limited.d_slv_m, full.d_slv_m);
    }

    #[test]
    fn analytic_the_own_period_is_that_of_a_beam() {
        // 2π/3.516 of a cantilever, with √12: 6.19. 3.2 m, λ = 8, √(1800/1.5e9).
        let (_, found) = check(&block(), "[assessment]\nelastic_modulus_pa = 1.5e9\n");
        let beam = TAU / 3.516 * 12.0_f64.sqrt() * 8.0 * 3.2 * (1800.0 / 1.5e9_f64).sqrt();
        // The commentary's 6.2 is rounded to two digits.
        assert!((found.t_0_s / beam - 1.0).abs() < 0.005, "{} {beam}", found.t_0_s);
    }

    #[test]
    fn analytic_a_high_floor_asks_more_than_the_ground() {
        let floor = "[building]\nheight_ratio = 1.0\nperiod_s = 0.3\nstoreys = 2\n";
        let (capacity, above) = check(&block(), floor);
        let below = StaticCheck::of(&block(), &capacity, &site(floor), true);
        assert_eq!((above.place.as_str(), below.place.as_str()), ("floor", "ground"));
        assert!(above.ag_sld_m_s2 < below.ag_sld_m_s2 && above.zeta < below.zeta);
        assert!(above.circolare_617.is_none() && below.circolare_617.is_some());
        let (_, ground) = check(&block(), "");
        assert_eq!(ground, below);
    }
}
