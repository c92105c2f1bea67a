//! The stages of the stronger search, from windows to the free-running tests, and their names.

/// Tracks at most.
pub(super) const MOST_TRACKS: usize = 12;

/// Where a stage's vectors are simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stage {
    /// In windows from each stretch without impacts, before the `number`-th track.
    Windows(usize),
    /// From rest up to where the `number`-th track leaves the measurement.
    Parts(usize),
    /// In the free-running tests, by the `number`-th track.
    Whole(usize),
}

impl Stage {
    /// The name under which its simulations are kept.
    pub fn name(self, method: &str) -> String {
        match self {
            Stage::Windows(number) => format!("{method} {} windows", number + 1),
            Stage::Parts(number) => format!("{method} {} parts", number + 1),
            Stage::Whole(number) => format!("{method} {} whole", number + 1),
        }
    }
}

/// The stages of a search, in their order; the last, CMA-ES over the free-running tests, has the search's own name.
pub(super) fn stage_names(method: &str) -> Vec<String> {
    // The last track is the one that is let go.
    let of_track = |number: usize| [Stage::Windows(number), Stage::Parts(number), Stage::Whole(number)];
    let stages = (0..=MOST_TRACKS).flat_map(of_track);
    stages.map(|stage| stage.name(method)).chain([method.to_owned()]).collect()
}

/// The names of those whose simulations are of the whole tests.
pub(super) fn whole_names(method: &str) -> Vec<String> {
    let tracks = (0..=MOST_TRACKS).map(|number| Stage::Whole(number).name(method));
    tracks.chain([method.to_owned()]).collect()
}
