//! The missing force as equations: what any law must make up for, with what is uncertain of the wall beside it.

use crate::diagnose::force::{Sample, WeakStretch, weak_stretches};
use crate::diagnose::formula::{Atom, Law, Site};
use crate::diagnose::hypothesis::Hypothesis;
use crate::experiment::{Purpose, TestData};
use mrbd_kernel::model::RockingWall;
use nalgebra::{DMatrix, DVector};

/// Change of an uncertain number of the wall over which its trace is taken, in standard deviations of what was known.
const CHANGE_SD: f64 = 0.5;

/// Weak-form equations of the tests to fit under a wall: rows over the noise, free of correlation.
#[derive(Debug)]
pub struct Points {
    stretches: Vec<WeakStretch>,
    /// What the model lacks.
    pub missing: DVector<f64>,
    /// What a standard deviation of each uncertain number of the wall makes of it.
    pub wall: DMatrix<f64>,
    /// The test of each row.
    pub test: Vec<usize>,
    /// By site: largest displacement and velocity.
    pub reach: [[f64; 2]; 3],
    /// By site: motion of joints in windows, where no stretch shows any.
    brief: [Vec<[f64; 3]>; 3],
}

impl Points {
    /// Under the wall of a hypothesis without additions, with its numbers where they start. `None` without such a wall, or
    /// where no stretch is long enough.
    pub fn new(tests: &[TestData], wall: &Hypothesis) -> Option<Self> {
        let fitted = tests.iter().enumerate().filter(|(_, test)| test.purpose == Purpose::Fit);
        let tests = fitted.collect::<Vec<_>>();
        let start = wall.start();
        // Test functions are those of this wall, whatever its numbers do: every number has its trace in the same rows.
        let response_time_s = RockingWall::new(&wall.physics(&start)?.wall).response_time_s();
        let at = |values: &[f64]| Some(weak_stretches(&tests, &wall.physics(values)?, response_time_s));
        let missing = |stretches: &[WeakStretch]| {
            DVector::from_vec(stretches.iter().flat_map(|s| s.missing().to_vec()).collect())
        };
        let stretches = at(&start)?;
        let own = missing(&stretches);
        if own.is_empty() {
            return None;
        }
        let mut traces = Vec::new();
        for (i, unknown) in wall.unknowns.iter().enumerate() {
            let mut values = start.clone();
            values[i] += CHANGE_SD * unknown.prior_sd?;
            let moved = missing(&at(&values)?);
            traces.push((&own - moved) / CHANGE_SD);
        }
        let wall = match traces.is_empty() {
            true => DMatrix::zeros(own.len(), 0),
            false => DMatrix::from_columns(&traces),
        };
        let test = stretches.iter().flat_map(|s| vec![s.test; s.rows()]).collect();
        Some(Self {
            reach: Site::ALL.map(|site| {
                reach(stretches.iter().flat_map(|s| &s.samples).map(|s| s.motion[site as usize]))
            }),
            brief: Default::default(),
            stretches,
            missing: own,
            wall,
            test,
        })
    }

    /// Joints that turn in no stretch.
    pub fn silent_joints(&self) -> impl Iterator<Item = Site> {
        let is_silent = |site: &Site| self.reach[*site as usize][0] <= NOTHING;
        [Site::Ground, Site::Crack].into_iter().filter(is_silent)
    }

    /// The same with how the ground's joint and the crack's turn in windows, where one turns in no stretch.
    pub fn with_brief(mut self, motion: [Vec<[f64; 3]>; 2]) -> Self {
        let silent = self.silent_joints().collect::<Vec<_>>();
        for (site, motion) in [Site::Ground, Site::Crack].into_iter().zip(motion) {
            if silent.contains(&site) {
                self.reach[site as usize] = reach(motion.iter().copied());
                self.brief[site as usize] = motion;
            }
        }
        self
    }

    /// Whether a joint turns in no stretch, and does in windows.
    pub fn opens_briefly(&self, site: Site) -> bool {
        !self.brief[site as usize].is_empty() && self.reach[site as usize][0] > NOTHING
    }

    /// Rows of a law of one atom of size 1.
    pub fn column(&self, atom: &Atom) -> DVector<f64> {
        let one = Atom { size: 1.0, ..*atom };
        if one.shape.carries() {
            return self.column_of_carried(&one);
        }
        self.column_of(atom.site, |motion| one.force(motion))
    }

    /// The same of an atom that carries a state along each test.
    fn column_of_carried(&self, atom: &Atom) -> DVector<f64> {
        let mut rows = Vec::with_capacity(self.missing.len());
        for (stretch, forces) in self.stretches.iter().zip(self.carried_forces(atom)) {
            rows.extend(stretch.by_law(atom.site, &forces));
        }
        DVector::from_vec(rows)
    }

    /// Forces of an atom that carries a state, of every stretch: along the measured displacement from the start of its test.
    fn carried_forces(&self, atom: &Atom) -> impl Iterator<Item = Vec<f64>> {
        let mut along: Option<(usize, Vec<f64>)> = None;
        self.stretches.iter().map(move |stretch| {
            if along.as_ref().is_none_or(|(test, _)| *test != stretch.test) {
                along = Some((stretch.test, atom.forces_along(&stretch.path)));
            }
            let forces = along.as_ref().map_or(&[][..], |(_, forces)| &forces[..]);
            forces[stretch.from..stretch.from + stretch.samples.len()].to_vec()
        })
    }

    /// Force or moment of a law at a site in every sample, in the order of [`Points::excited`].
    pub fn forces(&self, law: &Law, site: Site) -> Vec<f64> {
        let of = |atom: Atom| match atom.shape.carries() {
            true => self.carried_forces(&atom).flatten().collect::<Vec<_>>(),
            false => self.excited(site).map(|motion| atom.force(motion)).collect(),
        };
        let mut sum = vec![0.0; self.excited(site).count()];
        for atom in law.atoms().filter(|atom| atom.site == site) {
            sum.iter_mut().zip(of(atom)).for_each(|(sum, force)| *sum += force);
        }
        sum
    }

    /// Rows of a force or moment at a site by displacement, velocity and largest displacement so far there.
    pub fn column_of(&self, site: Site, force: impl Fn([f64; 3]) -> f64) -> DVector<f64> {
        let mut rows = Vec::with_capacity(self.missing.len());
        for stretch in &self.stretches {
            let value = |sample: &Sample| force(sample.motion[site as usize]);
            let law = stretch.samples.iter().map(value).collect::<Vec<_>>();
            rows.extend(stretch.by_law(site, &law));
        }
        DVector::from_vec(rows)
    }

    /// Rows of a law.
    pub fn of_law(&self, law: &Law) -> DVector<f64> {
        let zero = DVector::zeros(self.missing.len());
        law.atoms().fold(zero, |sum, atom| sum + self.column(&atom) * atom.size)
    }

    /// Each swing, a stretch between impacts: its test and its rows.
    pub fn swings(&self) -> Vec<(usize, std::ops::Range<usize>)> {
        let mut end = 0;
        let rows = |stretch: &WeakStretch| {
            let start = end;
            end += stretch.rows();
            (stretch.test, start..end)
        };
        self.stretches.iter().map(rows).collect()
    }

    /// Of each row the largest displacement of its swing, as a share of the largest of all.
    pub fn amplitude(&self, site: Site) -> Vec<f64> {
        let reach = self.reach[site as usize][0];
        let of = |stretch: &WeakStretch| {
            let largest =
                stretch.samples.iter().map(|s| s.motion[site as usize][0].abs()).fold(0.0, f64::max);
            vec![largest / reach; stretch.rows()]
        };
        self.stretches.iter().flat_map(of).collect()
    }

    /// Displacements and velocities at a site that were excited, with the largest displacements before.
    pub fn excited(&self, site: Site) -> impl Iterator<Item = [f64; 3]> {
        let samples = self.stretches.iter().flat_map(|stretch| &stretch.samples);
        let measured = samples.map(move |sample| sample.motion[site as usize]);
        measured.chain(self.brief[site as usize].iter().copied())
    }

    /// Least and largest displacement and velocity at a site.
    pub fn range(&self, site: Site) -> [[f64; 2]; 2] {
        [0, 1].map(|i| {
            let of = self.excited(site).map(|motion| motion[i]);
            of.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], x| [least.min(x), most.max(x)])
        })
    }
}

/// A rotation at which a joint does not turn: less than any sensor tells, rad.
const NOTHING: f64 = 1e-9;

/// Largest displacement and velocity of a motion.
fn reach(motion: impl Iterator<Item = [f64; 3]> + Clone) -> [f64; 2] {
    [0, 1].map(|i| {
        let largest = motion.clone().map(|sample| sample[i].abs()).fold(0.0, f64::max);
        rounded(largest.max(f64::MIN_POSITIVE))
    })
}

/// To two digits.
fn rounded(x: f64) -> f64 {
    let digit = 10.0_f64.powf(x.log10().floor() - 1.0);
    (x / digit).round() * digit
}

#[cfg(test)]
mod tests {
    use super::super::twin::{known_to, tests_of, wall_with};
    use super::*;

    #[test]
    fn regress_every_uncertain_number_has_its_trace_however_little_is_known_of_it() {
        let tests = tests_of(&wall_with(""), 3e-5);
        let points = |stiffness: f64| Points::new(&tests, &known_to(stiffness, &tests)).expect("points");
        // Half of 30 % moves the time of response by 7 %, and with it the reach of a test function of that wall.
        let [little, much] = [points(0.02), points(0.3)];
        assert_eq!([little.wall.ncols(), much.wall.ncols()], [2, 2]);
        assert_eq!(little.missing, much.missing);
        let ratio = much.wall.column(0).norm() / little.wall.column(0).norm();
        assert!((ratio / 15.0 - 1.0).abs() < 1e-6, "{ratio}");
    }
}
