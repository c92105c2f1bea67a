//! Whether a track gets on.

/// An iteration that neither lowers the cost by this share nor follows farther is idle.
const SETTLED: f64 = 0.003;
/// After so many idle iterations, or when so many have led less than this share of all samples farther, a track is stuck:
/// those that arrive mostly do in 8 to 15.
const MOST_IDLE: usize = 3;
const PATIENCE: usize = 5;
const LEAST_PROGRESS: f64 = 0.02;

/// How a track went.
#[derive(Debug, Default, Clone)]
pub(super) struct Progress {
    idle: usize,
    /// The most samples that ever counted, after each iteration.
    farthest: Vec<usize>,
    all: usize,
}

impl Progress {
    /// Notes an iteration: the samples that counted in it, of all, and the share of the cost that it left.
    pub fn note(&mut self, [counted, all]: [usize; 2], cost_left: f64) {
        let before = self.farthest.last().copied().unwrap_or(0);
        let idle = cost_left > 1.0 - SETTLED && counted <= before;
        self.idle = if idle { self.idle + 1 } else { 0 };
        self.farthest.push(counted.max(before));
        self.all = all;
    }

    /// How many iterations have been idle, up to the last.
    pub fn idle(&self) -> usize {
        self.idle
    }

    /// Whether more iterations are a waste. Where all samples count, only the cost tells.
    pub fn is_stuck(&self) -> bool {
        let now = self.farthest.last().copied().unwrap_or(0);
        let earlier = self.farthest.len().checked_sub(1 + PATIENCE).map(|k| self.farthest[k]);
        let hardly = |earlier: usize| ((now - earlier) as f64) < LEAST_PROGRESS * self.all as f64;
        self.idle >= MOST_IDLE || now < self.all && earlier.is_some_and(hardly)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stuck_after(counted: impl Fn(usize) -> usize, cost_left: f64) -> usize {
        let mut progress = Progress::default();
        let note = |k: &usize| {
            progress.note([counted(*k), 1000], cost_left);
            progress.is_stuck()
        };
        (1..100).find(note).unwrap_or(100)
    }

    #[test]
    fn analytic_a_track_is_stuck_when_it_gets_no_farther() {
        // One sample more each time is no progress, however the cost falls; ten are, up to where five leave 10 of them.
        assert_eq!(stuck_after(|k| 500 + k, 0.5), 6);
        assert_eq!(stuck_after(|k| (10 * k).min(900), 0.5), 94);
        // The first iteration is never idle, since it follows farther than none did.
        assert_eq!(stuck_after(|_| 500, 1.0), 4);
        assert_eq!(stuck_after(|_| 1000, 1.0), 4);
        // Where all samples count, a cost that still falls is progress.
        assert_eq!(stuck_after(|_| 1000, 0.5), 100);
    }
}
