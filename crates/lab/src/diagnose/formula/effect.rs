//! A law as effects of the kernel.

use super::law::Law;
use mrbd_kernel::model::Effect;

impl Law {
    /// The effects that it is, one a place; `None` where the kernel refuses one.
    pub fn effects(&self) -> Option<Vec<Effect>> {
        None
    }
}
