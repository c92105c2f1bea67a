//! What laws at the top remember where a window starts: carried along the measured displacement of the top.
//!
//! What is kept of a spring that yields is how far it is stretched, not where its plastic displacement lies. A fitted state differs
//! from the measured one by noise. A spring so stiff that it yields within that noise would start at either limit by chance.
//!
//! Carried states of formulas are integrated along the measured displacement from the start of the test, at a steady velocity between
//! samples. That is approximate: the motion between samples is not steady, and at the start of a test nothing tells a state but what
//! the law says. What is forgotten fast matters little, and a state that keeps all is as wrong as the displacement is.

use std::sync::Arc;

use crate::diagnose::hypothesis::Physics;
use crate::experiment::{self, TestData, carried_along};
use mrbd_formula::Formula;
use mrbd_kernel::model::{CarriedStates, Contact, Pair, RockingWall, Role, TopMemory};

/// What laws at the top keep of the past along a test.
#[derive(Debug)]
pub struct TopPast {
    /// Elastic part of the displacement of the top, m, at every sample; empty without a spring that yields.
    elastic_m: Vec<f64>,
    /// The largest displacement of the top so far, m; empty where no law depends on it.
    largest_m: Vec<f64>,
    /// The carried states of formulas; `None` where there are none.
    carried: Option<Arc<Along>>,
}

/// Carried states at every sample of a test, and what they come from.
#[derive(Debug)]
struct Along {
    wall: RockingWall,
    /// Times (s) and displacements of the top (m).
    path: Vec<[f64; 2]>,
    states: Vec<CarriedStates>,
}

impl TopPast {
    /// Carries the memory of the laws of a wall along a test.
    pub fn new(test: &TestData, physics: &Physics) -> Self {
        Self::beside(None, test, physics)
    }

    /// The same, with the carried states of another hypothesis where it has them in common: most numbers do not act on them, and
    /// they take as long as the windows themselves.
    pub fn near(&self, test: &TestData, physics: &Physics) -> Self {
        Self::beside(Some(self), test, physics)
    }

    fn beside(other: Option<&Self>, test: &TestData, physics: &Physics) -> Self {
        let p = physics.wall.parameters();
        let yields = p.effects.iter().any(|effect| effect.entry().role == Role::Memory);
        let remembers = p.formulas.iter().any(Formula::remembers);
        let carries = p.formulas.iter().any(|formula| !formula.states().is_empty());
        let (mut elastic_m, mut largest_m, mut carried) = (Vec::new(), Vec::new(), None);
        if yields || remembers || carries {
            let wall = RockingWall::new(&physics.wall);
            if yields {
                elastic_m = elastic_along_m(test, physics, &wall);
            }
            if remembers {
                largest_m = largest_so_far_m(test, &wall);
            }
            if carries {
                let path = top_path(test, &wall);
                let is_same = |along: &&Arc<Along>| along.path == path && along.wall.carries_as(&wall);
                let known = other.and_then(|other| other.carried.as_ref()).filter(is_same).cloned();
                carried = Some(known.unwrap_or_else(|| Arc::new(Along::new(path, wall))));
            }
        }
        Self { elastic_m, largest_m, carried }
    }

    /// The memory at a sample of a wall that is there in a state like the measured one.
    pub fn memory(&self, k: usize, wall: &RockingWall, contact: Contact, theta: Pair) -> TopMemory {
        let plastic = |elastic_m: &f64| wall.top_displacement_m(contact, theta) - elastic_m;
        TopMemory {
            carried: self.carried.as_ref().and_then(|along| along.states.get(k)).copied(),
            plastic_m: self.elastic_m.get(k).map_or(0.0, plastic),
            largest_m: self.largest_m.get(k).copied().unwrap_or(0.0),
        }
    }
}

impl Along {
    fn new(path: Vec<[f64; 2]>, wall: RockingWall) -> Self {
        let states = carried_along(&path, &wall);
        Self { wall, path, states }
    }
}

/// Elastic part of the displacement of a top with a spring that yields, m, at every sample of a test.
fn elastic_along_m(test: &TestData, physics: &Physics, wall: &RockingWall) -> Vec<f64> {
    let (mut plastic_m, mut elastic_m) = (0.0, 0.0);
    let smooth = smoothed(test, &MEAN);
    let at = |theta: Pair| {
        if theta.iter().all(|t| t.is_finite()) {
            let x_c = wall.top_displacement_m(Contact::of_rotations(theta), theta);
            plastic_m = physics.wall.plastic_displacement_m(plastic_m, x_c);
            elastic_m = x_c - plastic_m;
        }
        elastic_m
    };
    smooth.into_iter().map(at).collect()
}

/// Times (s) and displacements of the top (m) of a test.
pub fn top_path(test: &TestData, wall: &RockingWall) -> Vec<[f64; 2]> {
    let times_s = test.time_s.iter().copied();
    experiment::top_path(times_s.zip(smoothed(test, &PARABOLA)), wall)
}

/// The largest displacement of the top so far, m, at every sample of a test.
pub fn largest_so_far_m(test: &TestData, wall: &RockingWall) -> Vec<f64> {
    let mut largest_m = 0.0_f64;
    let at = |theta: Pair| {
        if theta.iter().all(|t| t.is_finite()) {
            let x_c = wall.top_displacement_m(Contact::of_rotations(theta), theta);
            largest_m = largest_m.max(x_c.abs());
        }
        largest_m
    };
    smoothed(test, &PARABOLA).into_iter().map(at).collect()
}

/// Weights of five samples: their mean, with less noise; no swing is shorter.
const MEAN: [f64; 5] = [1.0; 5];
/// The middle of the parabola through five samples (Savitzky and Golay), which does not cut the peak of a swing.
const PARABOLA: [f64; 5] = [-3.0, 12.0, 17.0, 12.0, -3.0];

/// Five samples of a test about each, with these weights. At its ends those that there are.
fn smoothed(test: &TestData, weights: &[f64; 5]) -> Vec<Pair> {
    let from_rest = (0..test.theta_rad.len()).map(|k| test.from_rest_rad(k)).collect::<Vec<_>>();
    let about = |k: usize| {
        let (mut theta, mut all) = ([0.0; 2], 0.0);
        for (i, weight) in weights.iter().enumerate() {
            if let Some([lower, upper]) = (k + i).checked_sub(2).and_then(|k| from_rest.get(k)) {
                theta = [theta[0] + weight * lower, theta[1] + weight * upper];
                all += weight;
            }
        }
        [theta[0] / all, theta[1] / all]
    };
    (0..from_rest.len()).map(about).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::replay::tests::swaying;
    use super::*;
    use mrbd_files::parse_wall;

    #[test]
    fn analytic_a_stiff_spring_pulls_against_the_motion_whatever_the_noise_of_a_state() {
        let (test, physics) = swaying();
        let memory = TopPast::new(&test, &physics);
        let wall = RockingWall::new(&physics.wall);
        // Far from where it turns, on the way out, back and out to the other side.
        for (k, way) in [(20, 1.0), (60, -1.0), (100, -1.0), (140, 1.0)] {
            for noise_rad in [-3e-5, 0.0, 3e-5] {
                let theta = test.theta_rad[k].map(|t| t + noise_rad);
                let contact = Contact::of_rotations(theta);
                let x_c = wall.top_displacement_m(contact, theta);
                let stretch_m = x_c - memory.memory(k, &wall, contact, theta).plastic_m;
                // Differences of lengths of some millimetres, of which a rounding is 1e-18 m.
                assert!((stretch_m - way * 1e-5).abs() < 1e-15, "{stretch_m} at sample {k}");
            }
        }
    }

    #[test]
    fn analytic_a_carried_state_at_a_window_is_that_of_a_run_that_was_measured() {
        let law = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-z\"\n[effects.states.z]\n\
            rate = \"k*v - z/tau\"\nstart = 0.0\nunit = \"N\"\n[effects.parameters]\nk = { value = 4e5, unit = \"N/m\" }\n";
        let text = include_str!("../../../../../src/cli/starter/wall.toml");
        let (test, _) = swaying();
        for tau_s in [1e-4, 0.02, 0.3, 1e5] {
            let tau = format!("tau = {{ value = {tau_s}, unit = \"s\" }}\n");
            let wall = parse_wall(Path::new("wall.toml"), &format!("{text}\n{law}{tau}")).expect("a wall");
            let past = TopPast::new(&test, &Physics { wall: wall.clone(), reversed_ratio: 0.0 });
            let rocking = RockingWall::new(&wall);
            let x_c = |t: f64| {
                let theta = [0.01 * (8.0 * t).sin(); 2];
                rocking.top_displacement_m(Contact::of_rotations(theta), theta)
            };
            // By the classical method of Runge and Kutta over the exact motion, in parts of a twentieth of τ at most.
            let (parts, mut z, mut largest) = (2000, 0.0_f64, 0.0_f64);
            for k in 1..test.theta_rad.len() {
                let h = 0.005 / f64::from(parts);
                let from_s = 0.005 * (k - 1) as f64;
                for part in 0..parts {
                    let t = from_s + f64::from(part) * h;
                    let rate = |t: f64, z: f64| 4e5 * (x_c(t + 1e-6) - x_c(t - 1e-6)) / 2e-6 - z / tau_s;
                    let r1 = rate(t, z);
                    let r2 = rate(t + 0.5 * h, z + 0.5 * h * r1);
                    let r3 = rate(t + 0.5 * h, z + 0.5 * h * r2);
                    z += h / 6.0 * (r1 + 2.0 * r2 + 2.0 * r3 + rate(t + h, z + h * r3));
                }
                largest = largest.max(z.abs());
                let memory = past.memory(k, &rocking, Contact::REST, [0.0; 2]).carried.expect("a state");
                // The smoothing bends the ends of a test, of which a state forgets the first; a velocity is steady over a sample of a sway of 157.
                let ends = k < 20 || k > test.theta_rad.len() - 4;
                let off = (memory[0] - z).abs();
                assert!(ends || off < 0.03 * largest + 1e-9, "τ = {tau_s} s at {k}: {} for {z}", memory[0]);
            }
        }
    }

    #[test]
    fn analytic_without_a_spring_nothing_is_remembered() {
        let (test, physics) = swaying();
        let mut parameters = physics.wall.parameters().clone();
        parameters.effects.clear();
        let wall = mrbd_kernel::model::Wall::new(parameters).expect("the wall without its spring");
        let memory = TopPast::new(&test, &Physics { wall, ..physics });
        let none = memory.memory(60, &RockingWall::new(&swaying().1.wall), Contact::REST, [0.01; 2]);
        assert_eq!(none, TopMemory::default());
    }

    #[test]
    fn analytic_carried_states_are_shared_by_walls_whose_numbers_do_not_act_on_them() {
        let text = include_str!("../../../../../src/cli/starter/wall.toml");
        let (test, _) = swaying();
        let physics = |k: f64, d_m: f64, mass_kg: f64| {
            let law = format!(
                "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-k*z\"\n[effects.states.z]\n\
                 rate = \"v/d*(1-abs(z)**2*(1+sign(v*z))/2)\"\nstart = 0.0\nunit = \"1\"\n\
                 [effects.parameters]\nk = {{ value = {k}, unit = \"N\" }}\nd = {{ value = {d_m}, unit = \"m\" }}\n"
            );
            let wall = parse_wall(Path::new("wall.toml"), &format!("{text}\n{law}")).expect("a wall");
            let mut parameters = wall.parameters().clone();
            parameters.mass_kg = mass_kg;
            let wall = mrbd_kernel::model::Wall::new(parameters).expect("a wall");
            Physics { wall, reversed_ratio: 0.0 }
        };
        let own = TopPast::new(&test, &physics(300.0, 2e-3, 5000.0));
        let along = |past: &TopPast| past.carried.clone().expect("a state");
        for (other, shared) in [
            (physics(300.0, 2e-3, 5000.0), true),
            (physics(350.0, 2e-3, 5200.0), true),
            (physics(300.0, 2.1e-3, 5000.0), false),
        ] {
            let [near, alone] =
                [own.near(&test, &other), TopPast::new(&test, &other)].map(|past| along(&past));
            assert_eq!(near.states, alone.states);
            assert_eq!(Arc::ptr_eq(&near, &along(&own)), shared);
        }
    }
}
