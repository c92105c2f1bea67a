//! The branches that the laws of a wall's joints are in, and what these remember.

use super::super::contact::{Contact, Joint, Pivot};
use super::super::geometry::Pair;
use super::super::rocking::{RockingWall, State, opening};
use super::joint_law::JointLaw;
use super::shape::{Branch, JointShape};

impl RockingWall {
    /// In which branch of its law a joint is.
    #[inline]
    pub(crate) fn branch(&self, joint: Joint) -> Branch {
        self.branches[joint as usize]
    }

    /// Puts a joint into a branch of its law, which may remember more than before.
    pub(crate) fn set_branch(&mut self, joint: Joint, law: JointLaw, branch: Branch) {
        let remembers = self.joint_laws[joint as usize] != Some(law);
        (self.joint_laws[joint as usize], self.branches[joint as usize]) = (Some(law), branch);
        let width_m = self.wall().width_m[joint as usize];
        for (contact, motion) in Contact::ALL.into_iter().zip(self.motions_mut()) {
            motion.reshape(joint, JointShape::new(Some(&law), width_m, contact.at(joint), branch));
        }
        let sharp = remembers.then(|| self.wall().with_sharp_edges(&self.joint_laws));
        let Some(edges) = &mut self.edges else { return };
        if let Some(sharp) = sharp {
            **edges = Self::new(&sharp);
        }
        for joint in [Joint::Ground, Joint::Crack] {
            if let Some(law) = self.joint_laws[joint as usize].filter(|law| !law.gives()) {
                edges.set_branch(joint, law, self.branches[joint as usize]);
            }
        }
    }

    /// Enters the branches of the joints' laws at a state, and what they remember: the rotations there and the largest
    /// before, rad.
    pub(crate) fn enter_branches(&mut self, state: &State, crushed_rad: [[f64; 2]; 2]) {
        for joint in self.joints() {
            let Some(law) = self.joint_laws[joint as usize] else { continue };
            if law.kink_rad(Pivot::Right).is_none() {
                continue;
            }
            let [right, left] = crushed_rad[joint as usize];
            let before = law.turned_by(Pivot::Right, right).turned_by(Pivot::Left, left);
            let phi = opening(joint, state.theta);
            let side = Pivot::of_angle(phi);
            let law = before.turned_by(side, phi);
            let beyond = law.kink_rad(side).is_some_and(|kink| match law.crushes() {
                // It goes on to crush where it is further than ever, and on its way there.
                true => law != before && phi.abs() >= kink && side.sign() * opening(joint, state.omega) > 0.0,
                false => phi.abs() > kink,
            });
            self.set_branch(joint, law, if beyond { Branch::Beyond } else { Branch::Before });
        }
    }

    /// The largest rotations of each joint to the right and to the left that its law remembers, those now among them, rad.
    pub(crate) fn crushed_rad(&self, theta: Pair) -> [[f64; 2]; 2] {
        [Joint::Ground, Joint::Crack].map(|joint| {
            let phi = opening(joint, theta);
            let law = self.joint_law(joint).map(|law| law.turned_by(Pivot::of_angle(phi), phi));
            law.map_or([0.0; 2], |law| law.crushed_rad())
        })
    }
}
