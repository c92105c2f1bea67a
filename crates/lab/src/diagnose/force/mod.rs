//! The force that is missing, from the measured rotations alone.
//!
//! Between impacts, the measured motion is put into the equations of motion. What remains is a moment pair that no law of
//! the wall explains. Its part along J_x = ∂x_C/∂θ is a horizontal force at the top; what lies off that direction is not.
//! Nothing is differentiated: the equations are weighed with a test function over a short stretch of one pattern. That
//! moves both derivatives onto the test function (the weak form). Over an impact, the velocities after it are compared
//! with those that the model gives from the state before it.

mod curves;
mod jumps;
mod points;
mod weak_form;

pub use curves::curve_left;
pub use curves::explained_by;
pub use curves::{Against, CurvePoint, Drawn, LawCurve, law_curves};
pub use curves::{acts_at_top, lie_along_top};
pub use jumps::{Jump, jumps};
pub use jumps::{Stretch, stretches};
pub use points::Kernel;
pub use points::{ForcePoint, force_points, median_share_off_top};
pub use weak_form::{Sample, WeakStretch, weak_stretches};
