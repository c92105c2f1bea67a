//! Does a number hold? A run beside a few others that differ from it by what nobody can know.
//!
//! A rocking wall under an earthquake may be chaotic: impacts magnify whatever differs before them. The largest
//! rotation, and whether the wall falls, then depend on roundings. The members of an ensemble go side by side
//! in vector lanes.
//!
//! Where the first members agree to [`TAME_DIGITS`] digits, a few are enough. Where they do not, the run is chaotic, and
//! a few that end alike say little: of 17 scales at which the outcome of the first wall of `mrbd init` changes with
//! the tolerance of the solver, 4 members missed 6, 8 missed 1 and [`MEMBERS_IN_CHAOS`] none.

use super::response::{Outcome, Response};
use super::side_by_side::{Prepared, simulate_side_by_side};
use super::{Accuracy, Shaking, Simulator, Start};
use crate::model::{State, Wall};

/// Relative change of the ground motion, and of the rotations of a release, that nobody can know. A digitiser
/// of 20 bits resolves 1e-6 of its range, and accelerograms are published in six digits or fewer.
const UNKNOWN_AMPLITUDE: f64 = 1e-6;

/// Tolerance of the member that is run more accurately, over that of the run.
const TIGHTER: f64 = 0.1;

/// Digits beyond which no number holds: those of the amplitude.
const MOST_DIGITS: i32 = 6;

/// How a member differs from the run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Factor on the ground motion and on the rotations of a release.
    pub amplitude: f64,
    /// Factor on the tolerance.
    pub tolerance: f64,
}

impl Change {
    /// Of a member by its number. 0 is the run, 1 and 2 shake by a millionth less and more, 3 is more accurate.
    /// Those after it shake by δ/2, δ/3, … less and more, no two alike.
    pub fn of(member: usize) -> Self {
        let sign = if member.is_multiple_of(2) { 1.0 } else { -1.0 };
        let amplitude = match member {
            0 | 3 => 0.0,
            1 | 2 => sign * UNKNOWN_AMPLITUDE,
            later => sign * UNKNOWN_AMPLITUDE / (later / 2) as f64,
        };
        Self { amplitude: 1.0 + amplitude, tolerance: if member == 3 { TIGHTER } else { 1.0 } }
    }

    /// The accuracy of the member, where the run has this one; never below what can be asked for.
    pub fn accuracy(self, run: Accuracy) -> Accuracy {
        Accuracy { tolerance: (self.tolerance * run.tolerance).max(*Accuracy::TOLERANCES.start()) }
    }

    fn prepared(self, wall: &Wall, shaking: &Shaking, accuracy: Accuracy) -> Prepared {
        let scaled = |motion: &Option<_>| {
            motion.as_ref().map(|a: &crate::accelerogram::Accelerogram| a.scaled(self.amplitude))
        };
        let shaking = Shaking {
            horizontal: scaled(&shaking.horizontal),
            vertical: scaled(&shaking.vertical),
            tail_s: shaking.tail_s,
        };
        let simulator = Simulator::new(wall, &shaking, self.accuracy(accuracy));
        let State { theta, omega } = simulator.release().state;
        let state = State { theta: theta.map(|theta_i| theta_i * self.amplitude), omega };
        simulator.prepared_from(&Start { state, ..Start::default() }, simulator.end_s(), ())
    }
}

/// What the members of an ensemble say of the wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// It stood in all of them.
    Stood,
    /// It collapsed in all of them.
    Collapsed,
    /// It stood in some and collapsed in others.
    Undecided,
    /// The run itself could not be finished.
    Failed,
}

impl Verdict {
    /// `stood`, `collapsed`, `undecided` or `failed`.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Stood => "stood",
            Verdict::Collapsed => "collapsed",
            Verdict::Undecided => "undecided",
            Verdict::Failed => "failed",
        }
    }
}

/// A run and those that differ from it by what nobody can know.
#[derive(Debug, Clone, PartialEq)]
pub struct Ensemble {
    /// The run itself.
    pub run: Response,
    /// The other members, in the order of their numbers.
    pub others: Vec<Response>,
}

/// Members of an ensemble where nothing else is said: as many as most processors take side by side.
pub const MEMBERS: usize = 4;

/// Members of the ensemble of a chaotic run.
pub const MEMBERS_IN_CHAOS: usize = 3 * MEMBERS;

/// Digits of the largest rotations to which the members of a run agree that is not chaotic. One digit lets them part
/// by a quarter of the rotation.
const TAME_DIGITS: u32 = 2;

/// Runs a wall and the other members of its ensemble side by side; the run has the bits of [`super::simulate`].
pub fn simulate_ensemble(wall: &Wall, shaking: &Shaking, accuracy: Accuracy, members: usize) -> Ensemble {
    let mut responses = simulate_members(wall, shaking, accuracy, 0..members.max(1));
    let run = responses.remove(0);
    Ensemble { run, others: responses }
}

/// Runs some members of an ensemble side by side, in the order of their numbers; member 0 is the run itself.
pub fn simulate_members(
    wall: &Wall,
    shaking: &Shaking,
    accuracy: Accuracy,
    members: std::ops::Range<usize>,
) -> Vec<Response> {
    let mut left = members;
    let mut ended = Vec::new();
    let mut next =
        || left.next().map(|member| (member, Change::of(member).prepared(wall, shaking, accuracy)));
    simulate_side_by_side(&mut next, &mut |member, response| ended.push((member, response)));
    ended.sort_by_key(|(member, _)| *member);
    ended.into_iter().map(|(_, response)| response).collect()
}

impl Ensemble {
    /// All members, the run first.
    pub fn members(&self) -> impl Iterator<Item = &Response> {
        std::iter::once(&self.run).chain(&self.others)
    }

    /// Members that were carried to their end.
    fn ended(&self) -> impl Iterator<Item = &Response> {
        self.members().filter(|response| !matches!(response.outcome, Outcome::Failed { .. }))
    }

    /// Whether members part so far that no second digit of their largest rotations holds.
    pub fn is_chaotic(&self) -> bool {
        let digits_of = |i: usize| self.digits(|response| response.theta_max_rad[i].value.abs());
        digits_of(0).min(digits_of(1)) < TAME_DIGITS
    }

    /// Whether [`MEMBERS`] are too few: the run is chaotic, and they agree on its outcome, which more may not do.
    pub fn needs_more(&self) -> bool {
        // An outcome that flips is known to be undecided; more would tell its share a little better.
        self.verdict() != Verdict::Undecided && self.is_chaotic()
    }

    /// The same ensemble with the members that follow.
    #[must_use]
    pub fn with(mut self, more: impl IntoIterator<Item = Response>) -> Self {
        self.others.extend(more);
        self
    }

    /// How many members could not be finished.
    pub fn failed(&self) -> usize {
        self.members().count() - self.ended().count()
    }

    /// How many members collapsed, of how many that ended.
    pub fn collapsed(&self) -> (usize, usize) {
        (self.ended().filter(|response| response.collapsed()).count(), self.ended().count())
    }

    /// Share of the members that collapsed; `None` where none ended.
    pub fn collapsed_share(&self) -> Option<f64> {
        let (collapsed, ended) = self.collapsed();
        (ended > 0).then(|| collapsed as f64 / ended as f64)
    }

    /// What the members say together.
    pub fn verdict(&self) -> Verdict {
        match (&self.run.outcome, self.collapsed()) {
            (Outcome::Failed { .. }, _) => Verdict::Failed,
            (_, (0, _)) => Verdict::Stood,
            (_, (collapsed, ended)) if collapsed == ended => Verdict::Collapsed,
            _ => Verdict::Undecided,
        }
    }

    /// The smallest and the largest value of a result over the members that ended.
    pub fn spread(&self, value: impl Fn(&Response) -> f64) -> [f64; 2] {
        self.ended()
            .map(value)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [f64::min(low, x), f64::max(high, x)])
    }

    /// How many digits of a result hold, 0 to 6: half a unit of the last one is no less than the distance from
    /// the run to the farthest member.
    pub fn digits(&self, value: impl Fn(&Response) -> f64) -> u32 {
        let of_run = value(&self.run);
        let [low, high] = self.spread(value);
        let distance = (high - of_run).max(of_run - low);
        if of_run == 0.0 || !distance.is_finite() {
            return if distance == 0.0 { MOST_DIGITS as u32 } else { 0 };
        }
        let digits = first_place(of_run) + 1 - (2.0 * distance).log10().ceil().clamp(-400.0, 400.0) as i32;
        digits.clamp(0, MOST_DIGITS) as u32
    }

    /// A count, or the least and the most of the members where they differ.
    pub fn count(&self, count: impl Fn(&Response) -> u64) -> String {
        let of_run = count(&self.run);
        let [least, most] = self
            .ended()
            .map(count)
            .fold([of_run; 2], |[least, most], n| [u64::min(least, n), u64::max(most, n)]);
        if least == most { of_run.to_string() } else { format!("{least} to {most}") }
    }

    /// A result with the digits that hold, or as the interval of the members where none does.
    pub fn text(&self, value: impl Fn(&Response) -> f64) -> String {
        match self.digits(&value) {
            0 => {
                let [low, high] = self.spread(&value);
                format!("{} to {}", rounded(low, 2), rounded(high, 2))
            }
            digits => rounded(value(&self.run), digits),
        }
    }
}

/// Decimal exponent of the first digit of a number other than 0.
fn first_place(value: f64) -> i32 {
    value.abs().log10().floor() as i32
}

/// A number with so many digits, without an exponent; zeros stand for those that do not hold.
fn rounded(value: f64, digits: u32) -> String {
    let place = if value == 0.0 { 0 } else { first_place(value) };
    match digits as i32 - 1 - place {
        decimals @ 0.. => format!("{value:.*}", decimals as usize),
        above => {
            let unit = 10f64.powi(-above);
            format!("{:.0}", (value / unit).round_ties_even() * unit)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accelerogram::Accelerogram;
    use crate::model::WallParameters;
    use crate::simulate::simulate;

    fn wall() -> Wall {
        let strip = WallParameters::strip(0.3, 4.0, 1800.0);
        Wall::new(WallParameters { crack_height_m: Some(2.2), stiffness_n_per_m: 40e3, ..strip })
            .expect("a wall")
    }

    fn shaking(peak_m_s2: f64) -> Shaking {
        let pulse = (0..200).map(|k| peak_m_s2 * (6.0 * f64::from(k) * 0.005).sin()).collect();
        let horizontal = Some(Accelerogram::new(0.005, pulse).expect("samples"));
        Shaking { horizontal, vertical: None, tail_s: 5.0 }
    }

    #[test]
    fn analytic_the_run_of_an_ensemble_has_the_bits_of_the_run_alone() {
        let (wall, shaking) = (wall(), shaking(3.0));
        let alone = simulate(&wall, &shaking, Accuracy::default());
        let ensemble = simulate_ensemble(&wall, &shaking, Accuracy::default(), MEMBERS);
        assert_eq!(ensemble.run, alone);
        assert_eq!(ensemble.others.len(), MEMBERS - 1);
        // A millionth more is another run.
        assert_ne!(ensemble.others[0].theta_max_rad, alone.theta_max_rad);
        // A member does not depend on those beside it.
        let last = simulate_members(&wall, &shaking, Accuracy::default(), 2..MEMBERS);
        assert_eq!(last, ensemble.others[1..]);
    }

    #[test]
    fn analytic_a_single_member_holds_to_all_digits() {
        let ensemble = simulate_ensemble(&wall(), &shaking(3.0), Accuracy::default(), 1);
        assert_eq!(ensemble.digits(|r| r.theta_max_rad[0].value.abs()), MOST_DIGITS as u32);
        assert_eq!(ensemble.collapsed().1, 1);
    }

    #[test]
    fn analytic_digits_hold_as_far_as_members_agree() {
        let mut ensemble = simulate_ensemble(&wall(), &shaking(3.0), Accuracy::default(), 3);
        let mut with = |values: [f64; 3]| {
            ensemble.run.alpha_rad = values[0];
            ensemble.others[0].alpha_rad = values[1];
            ensemble.others[1].alpha_rad = values[2];
            (ensemble.digits(|r| r.alpha_rad), ensemble.text(|r| r.alpha_rad))
        };
        // Half a unit of the third digit is 0.0005.
        assert_eq!(with([0.198_766, 0.198_774, 0.198_687]), (3, "0.199".to_owned()));
        assert_eq!(with([-0.024_974_6, -0.024_977_3, -0.024_970_2]), (4, "-0.02497".to_owned()));
        assert_eq!(with([0.78, 0.53, 0.52]), (0, "0.52 to 0.78".to_owned()));
        assert_eq!(with([12.0, 12.0, 12.0]), (6, "12.0000".to_owned()));
        assert_eq!(with([161.2, 149.0, 190.0]), (1, "200".to_owned()));
        assert_eq!(with([0.0, 0.0, 0.0]).0, 6);
    }

    #[test]
    fn analytic_a_run_is_chaotic_where_one_digit_holds() {
        let mut ensemble = simulate_ensemble(&wall(), &shaking(3.0), Accuracy::default(), 2);
        assert!(!ensemble.is_chaotic());
        let mut with = |run: f64, other: f64| {
            ensemble.run.theta_max_rad[1].value = run;
            ensemble.others[0].theta_max_rad[1].value = other;
            ensemble.is_chaotic()
        };
        assert!(!with(0.100, 0.104));
        assert!(with(0.100, 0.120));
        assert_eq!(ensemble.clone().with(ensemble.others.clone()).members().count(), 3);
    }

    #[test]
    fn analytic_members_of_two_outcomes_decide_nothing() {
        let mut ensemble = simulate_ensemble(&wall(), &shaking(0.5), Accuracy::default(), MEMBERS);
        assert_eq!(ensemble.verdict(), Verdict::Stood);
        ensemble.others[1].outcome = Outcome::Collapsed { time_s: 1.0 };
        assert_eq!((ensemble.verdict(), ensemble.collapsed_share()), (Verdict::Undecided, Some(0.25)));
        ensemble.others[2].outcome = Outcome::Failed { time_s: 1.0, reason: "events".to_owned() };
        assert_eq!((ensemble.collapsed(), ensemble.failed()), ((1, 3), 1));
    }
}
