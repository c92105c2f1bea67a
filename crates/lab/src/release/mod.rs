//! What free releases say of the joints before any law is assumed: moment against rotation, with its band.
//!
//! A cracked strip held at foot and top has one way to move. So the measured motion alone gives the moment that its
//! joints carry, at every displacement, as a share of that of sharp edges: 1 is the rigid line. Both joints move
//! together; which of them carries how much of it no release tells.
//!
//! | module | idea |
//! | --- | --- |
//! | `strip` | the equation of the one motion |
//! | `weak` | that equation under test functions over unevenly sampled motion: nothing is differentiated |
//! | `moment` | the moment as a curve through a few displacements, opening and closing, with its band |
//! | `laws` | static laws held against the same rows: what each leaves, also of a release that it was not fitted to |

mod laws;
mod moment;
mod strip;
mod weak;

pub use laws::{FittedLaw, Law, LawKind, LawNumber};
pub use moment::{MomentPoint, ReleaseMoment, Told};
pub use strip::HeldStrip;
pub use weak::HALF_S;

use crate::experiment::Test;
use mrbd_kernel::model::Wall;

/// What the releases of an experiment say of the joints.
#[derive(Debug, Clone, PartialEq)]
pub struct Moments {
    /// Of which strip: laws need it.
    pub strip: HeldStrip,
    /// By release, in the order of the experiment.
    pub releases: Vec<ReleaseMoment>,
    /// Every law, fitted to each release in turn.
    pub laws: Vec<FittedLaw>,
}

impl Moments {
    /// Measures the moment in every release of a strip whose top is held; `None` where there is none that can be read.
    pub fn of(wall: &Wall, tests: &[Test]) -> Option<Self> {
        let strip = HeldStrip::of(wall)?;
        let read = |test: &Test| moment::Measurement::new(&strip, test);
        let measured = tests.iter().filter_map(read).collect::<Vec<_>>();
        if measured.is_empty() {
            return None;
        }
        let laws = laws::fitted(&strip, &measured);
        Some(Self { strip, releases: measured.into_iter().map(|m| m.moment).collect(), laws })
    }
}
