//! Joints that give: a bed of springs without tension between the bodies, in place of sharp edges.
//!
//! A sharp edge carries the whole load on a line. On a bed the load rests on a zone of contact, whose width
//! c depends on load and rotation. Its rivals are other laws in its place. [`JointLaw`] is the static law of one joint,
//! [`Roll`](roll::Roll) what it does as it turns, [`JointShape`] that in a state of contact and a branch of the law.
//! [`BeddedMotion`] moves a wall on one or two of them; `crossing` says what is lost where a joint passes from one
//! side to the other.
//!
//! | choice | taken | because |
//! | --- | --- | --- |
//! | load N | the static weight above the joint | the law is then closed, its energy exact |
//! | kinematics | the body turns about the middle of the zone of contact | edges that stay miss twins by 2 to 4 times as much |
//! | loss | the bed's damper, and at crossings the share of the sharp edge's impact that the bed lets through | soft beds have no impacts, stiff beds have those of sharp edges |
//!
//! | rival | body turns about | energy |
//! | --- | --- | --- |
//! | [`TrilinearJoint`] | the point that carries the load, M/N | the weight's |
//! | [`CrushingJoint`] | the middle of the elastic contact, on what was not crushed | the weight's and the springs', less what crushes |
//! | [`RoundedEdges`] | where the arc touches; closed up to the end of the flat | the weight's |

mod branches;
mod crossing;
mod crushing;
mod joint_law;
mod lanes;
mod law;
mod motion;
mod of_wall;
mod roll;
mod rounded;
mod shape;
mod trilinear;

pub use crushing::CrushingJoint;
pub use joint_law::JointLaw;
pub(crate) use lanes::{BedRow, JointLanes};
pub use law::Bed;
pub(crate) use motion::{Acting, BeddedMotion, BeddedRate, Pose};
pub(in crate::model) use of_wall::{Carries, law_at};
pub use rounded::RoundedEdges;
pub(crate) use shape::{Branch, JointShape};
pub use trilinear::TrilinearJoint;
