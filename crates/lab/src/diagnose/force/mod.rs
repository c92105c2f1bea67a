//! Step 4: the force that is missing, from the measured rotations alone.
//!
//! Between impacts, the measured motion put into the equations of motion leaves a moment pair that no law of the wall
//! explains. Its part along J_x = ∂x_C/∂θ is a horizontal force at the top; what lies off that direction is none. Nothing
//! is differentiated: the equations are weighed with a test function over a short stretch of one pattern, which moves both
//! derivatives onto the test function (the weak form). Over an impact, the velocities after it are compared with those
//! the model gives from the state before it.

mod at_top;
mod curved;
mod explained;
mod jumps;
mod kernel;
mod law_curves;
mod points;
mod stretch;

pub use at_top::acts_at_top;
pub use curved::curve_left;
pub use explained::explained_by;
pub use jumps::{Jump, jumps};
pub use kernel::Kernel;
pub use law_curves::{Against, LawCurve, law_curves};
pub use points::{ForcePoint, force_points, median_share_off_top};
pub use stretch::{Stretch, stretches};
