//! Why data do not tell a fragility: the honest alternative to a number.

/// What the data lack.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Unknown {
    /// Nothing was observed.
    #[error("no observations")]
    NoData,
    /// Not one failed: the data only say that the median is high.
    #[error("no failures among the observations")]
    NoFailures,
    /// All failed: the data only say that the median is low.
    #[error("failures only, nothing stood")]
    FailuresOnly,
    /// All observations share one intensity.
    #[error("one intensity only")]
    OneIntensity,
    /// A threshold parts what stood from what failed: the likelihood grows for ever as β falls to 0.
    #[error(
        "a threshold between intensities {below} and {above} separates all that stood from all that failed"
    )]
    Separated {
        /// The highest intensity on the lower side.
        below: f64,
        /// The lowest intensity on the upper side.
        above: f64,
    },
    /// Failures do not become more likely with intensity.
    #[error("failures do not become more likely with the intensity")]
    NotIncreasing,
    /// Fewer than two collapse intensities that differ.
    #[error("fewer than two different collapse intensities")]
    TooFewCollapses,
    /// The demands of what stood do not scatter, so that their regression is exact.
    #[error("fewer than three demands, or demands without scatter")]
    TooFewDemands,
    /// The optimiser gave up.
    #[error("the likelihood could not be maximised")]
    NotConverged,
}

impl Unknown {
    /// A name for scripts.
    pub fn name(&self) -> &'static str {
        match self {
            Unknown::NoData => "no_data",
            Unknown::NoFailures => "no_failures",
            Unknown::FailuresOnly => "failures_only",
            Unknown::OneIntensity => "one_intensity",
            Unknown::Separated { .. } => "separated",
            Unknown::NotIncreasing => "not_increasing",
            Unknown::TooFewCollapses => "too_few_collapses",
            Unknown::TooFewDemands => "too_few_demands",
            Unknown::NotConverged => "not_converged",
        }
    }
}
