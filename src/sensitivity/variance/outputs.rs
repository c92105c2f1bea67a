//! What of a response varies: numbers that every run has, fallen walls too.

use serde::{Deserialize, Serialize};

/// θ_i/α_i beyond which a rotation counts no further: there a body of the wall would fall if it were let go.
pub const CLIP: f64 = 1.0;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ended {
    /// With θ_1/α_1 and θ_2/α_2 at their largest.
    Stood([f64; 2]),
    /// Both rotations lie above all others.
    Collapsed,
}

/// A number whose variance is shared out.
///
/// A rotation has no mean among collapses, and its variance would be that of the few largest. So it is told by ranks, in which
/// collapses share the highest, and nothing is chosen; and, for one who wants rotations, cut off at [`CLIP`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Output {
    /// Rank of θ_1/α_1 among all runs, 0 to 1.
    Theta1Rank,
    /// Rank of θ_2/α_2 among all runs, 0 to 1.
    Theta2Rank,
    /// 1 of a wall that fell, else 0.
    Collapse,
    /// θ_1/α_1, at most [`CLIP`], which a wall that fell has.
    Theta1Clipped,
    /// θ_2/α_2, at most [`CLIP`], which a wall that fell has.
    Theta2Clipped,
}

impl Output {
    /// All, in the order in which they are told.
    pub const ALL: [Self; 5] =
        [Self::Theta1Rank, Self::Theta2Rank, Self::Collapse, Self::Theta1Clipped, Self::Theta2Clipped];

    /// Name in result files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Theta1Rank => "theta1_rank",
            Self::Theta2Rank => "theta2_rank",
            Self::Collapse => "collapse",
            Self::Theta1Clipped => "theta1_clipped",
            Self::Theta2Clipped => "theta2_clipped",
        }
    }

    /// Its values of all runs.
    pub fn of(self, runs: &[Ended]) -> Vec<f64> {
        let rotation = |body: usize| {
            runs.iter().map(move |ended| match ended {
                Ended::Stood(rotations) => rotations[body],
                Ended::Collapsed => f64::INFINITY,
            })
        };
        match self {
            Self::Theta1Rank => ranks(&rotation(0).collect::<Vec<_>>()),
            Self::Theta2Rank => ranks(&rotation(1).collect::<Vec<_>>()),
            Self::Collapse => runs.iter().map(|ended| f64::from(*ended == Ended::Collapsed)).collect(),
            Self::Theta1Clipped => rotation(0).map(|theta| theta.min(CLIP)).collect(),
            Self::Theta2Clipped => rotation(1).map(|theta| theta.min(CLIP)).collect(),
        }
    }
}

/// Ranks in (0, 1), the mean one where values are equal.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_unstable_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    let mut from = 0;
    for equal in order.chunk_by(|&a, &b| values[a] == values[b]) {
        let rank = (from as f64 + 0.5 * equal.len() as f64) / values.len() as f64;
        equal.iter().for_each(|&place| ranks[place] = rank);
        from += equal.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_a_wall_that_fell_ranks_above_all_and_is_cut_off() {
        let stood = |theta: f64| Ended::Stood([theta, 2.0 * theta]);
        let runs = [stood(0.3), Ended::Collapsed, stood(0.1), Ended::Collapsed, stood(0.3)];
        let of = |output: Output| output.of(&runs);
        assert_eq!(of(Output::Theta1Rank), [0.4, 0.8, 0.1, 0.8, 0.4]);
        assert_eq!(of(Output::Theta2Rank), of(Output::Theta1Rank), "ranks do not ask for the scale");
        assert_eq!(of(Output::Collapse), [0.0, 1.0, 0.0, 1.0, 0.0]);
        assert_eq!(of(Output::Theta1Clipped), [0.3, 1.0, 0.1, 1.0, 0.3]);
        assert_eq!(of(Output::Theta2Clipped), [0.6, 1.0, 0.2, 1.0, 0.6]);
    }
}
