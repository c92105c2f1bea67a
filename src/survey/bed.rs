//! What may lie in the joints of every façade of a study.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::{InputError, Result};
use mrbd_kernel::model::{Effect, EffectError};

/// A bed of springs without tension in both joints, as the effect `compliant_joint` has it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bed {
    /// Pressure per indentation, Pa/m; the largest value of the effect is a sharp edge.
    pub stiffness_pa_per_m: f64,
    /// Time ζ of dampers beside the springs, s.
    #[serde(default)]
    pub damping_s: f64,
}

impl Bed {
    /// The effect; `None` for sharp edges, which need none.
    ///
    /// # Errors
    /// [`EffectError`] for values beyond those of the effect.
    pub fn effect(&self) -> Result<Option<Effect>, EffectError> {
        let effect =
            Effect::with_parameters("compliant_joint.both", &[self.stiffness_pa_per_m, self.damping_s])?;
        let most = effect.entry().parameters[0].most;
        Ok((self.stiffness_pa_per_m < most).then_some(effect))
    }

    /// Refuses values beyond those of the effect; `key` is where it stands in the file at `path`.
    pub(crate) fn check(&self, path: &Path, key: &str) -> Result<()> {
        let refused = |e: EffectError| {
            let allowed = "values of the effect `compliant_joint`";
            InputError::key(path, key.to_owned(), e.to_string(), allowed)
        };
        Ok(self.effect().map(|_| ()).map_err(refused)?)
    }
}
