//! Statics of a wall that may fall out of its plane: what it bears, and how far it can be pushed.
//!
//! The bodies, masses and springs are those of the wall that rocks ([`mrbd_kernel`]); nothing moves fast here.
//!
//! | module | from | to |
//! | --- | --- | --- |
//! | [`Joint`] | width, load, a bed of springs or a rival of it | the moment at a rotation |
//! | [`Chain`] | a wall | where its masses are at a rotation, and how they move |
//! | [`Mechanism`], [`VirtualWork`] | a chain that begins to turn | α_0, e*, M* of the Circolare 2019 |
//! | [`least_crack_height`] | a chain held at its top | the crack with the least α_0 |
//! | [`Restraint`] | springs at the top | the force that holds it |
//! | [`Push`] | all of them | force against displacement until it falls |
//!
//! A wall of 0.3 m by 3 m that stands free falls at a tenth of its weight, and half of its thickness away:
//!
//! ```
//! use mrbd_kernel::model::{Wall, WallParameters};
//! use mrbd_statics::{Chain, Edges, Load, Mechanism, Push, Restraint, Side};
//!
//! let wall = Wall::new(WallParameters::strip(0.3, 3.0, 1800.0))?;
//! let chain = Chain::of(&wall, Edges::AsTheyAre, Side::Right);
//! let work = Mechanism::OneBlock.work(&chain).expect("every wall is one block");
//! assert!((work.alpha_0() - 0.1).abs() < 1e-12 && (work.e_star() - 0.75).abs() < 1e-12);
//!
//! let restraint = Restraint::of(&wall, Side::Right);
//! let push = Push { chain, restraint, load: Load::Uniform, fallen_rad: wall.collapse_rotation_rad() };
//! let curve = push.curve();
//! assert!((curve.peak.force_n / chain.weight_n() - 0.1).abs() < 1e-8);
//! let end = curve.end.expect("it falls");
//! // Its centre stands above the corner: tan θ = b/h.
//! assert!((end.theta_rad[0].tan() - 0.1).abs() < 1e-9);
//! # Ok::<(), mrbd_kernel::model::ImpossibleWall>(())
//! ```

mod chain;
mod crack;
mod joint;
mod mechanism;
mod push;
mod restraint;

pub use chain::{Chain, Edges, Moved, Moves, Side};
pub use crack::{LeastCrack, least_crack_height};
pub use joint::Joint;
pub use mechanism::{Mechanism, VirtualWork};
pub use push::{Curve, Load, Point, Push};
pub use restraint::{Restraint, Springs};
