//! Limits of what is tried, and how far.

use super::Limit;

limits! {
    /// What is tried.
    TRIED:
    /// Most starts of two or more added numbers that are fitted coarsely.
    BEGUN: usize = 3, "";
    /// Windows that coarse fits are made to, where there are half as many more.
    ///
    /// They tell what is worth a fit to all. Chosen: blind cases have about a hundred.
    COARSE_WINDOWS: usize = 40, "";
    /// Share of the size that matters from which a start of one number does something.
    STARTS_FROM: f64 = 0.05, "share";
    /// Coarse fits that are always fitted to the end.
    LEAST_FINISHED: usize = 6, "";
    /// Coarse fits near the best that are fitted to the end, at most.
    MOST_FINISHED: usize = 12, "";
    /// Distance from the best that is near it.
    NEAR_BEST: f64 = 100.0, "ln of likelihood";
    /// The same as a share of what speaks against the best, of those that are fitted once more from other starts.
    ///
    /// Far above the noise windows are at their bounds, and a right law may be some hundreds behind until it is fitted from
    /// elsewhere. Chosen.
    NEAR_BEST_SHARE: f64 = 0.1, "share";
    /// Coarse fits that are fitted to the end because they follow the windows with the least error.
    ///
    /// A window far off still tells by its error when its likelihood is at its bound. Chosen.
    FOLLOWING: usize = 2, "";
    /// Best single effects from whose values the wall without effects is fitted again.
    ///
    /// Chosen: from the best alone, a wall with nothing hidden was once left 3 % off its stiffness, and an effect named for
    /// it.
    REFITTED_FROM: usize = 6, "";
    /// Best single effects whose states the wall without effects tries too.
    STATES_FOR_WALL: usize = 8, "";
    /// Most hypotheses near the best that share the states they found.
    SHARING_STATES: usize = 6, "";
    /// Best hypotheses fitted once more from other starts.
    POLISHED: usize = 3, "";
    /// Gain above which that is worth its time.
    WORTH_POLISH: f64 = 10.0, "ln of likelihood";
    /// Share of the squared error above noise that the best may leave for that to be worth its time.
    ///
    /// Other starts find other valleys of windows. They do not make a law of what leaves more. Chosen.
    NEARLY_CLOSES: f64 = 0.25, "share";
    /// Gain of the wall with its own numbers fitted beside an effect from which single effects are tried again, as a share of
    /// what speaks against it.
    ///
    /// Of a gap of thousands a gain of tens changes no answer. Chosen.
    WORTH_TRYING_AGAIN: f64 = 0.02, "share";
    /// Share of the largest displacement of the top within which a spring that yields is friction.
    ///
    /// Chosen: a tie or a nail that yields gives by tens of percent of it, friction by hundredths of one.
    FRICTION_WITHIN: f64 = 0.01, "share";
    /// Best single effects that are paired with all others where none closes the gap alone.
    PAIRED: usize = 2, "";
    /// Pairs fitted of a single effect that closes the gap but may not be alone.
    PAIRS_BESIDE_A_NAME: usize = 4, "";
    /// Gain of the best pair over a single effect that closes the gap from which pairs are fitted from other starts, and what could imitate
    /// them.
    ///
    /// Half of [`WORTH_A_SECOND_SEEN`](super::WORTH_A_SECOND_SEEN): what other starts find are tens.
    PROMISING_PAIR: f64 = 35.0, "ln of likelihood";
    /// Pairs fitted of each single effect that is paired where none closes the gap.
    PAIRS_WITHOUT_A_NAME: usize = 7, "";
    /// Effects fitted beside the best because a linear look says that they take away most.
    BESIDE_THE_BEST: usize = 4, "";
    /// Single effects fitted because they may imitate the best.
    ///
    /// See [`IMITATING_PAIRS`].
    IMITATING_SINGLES: usize = 4, "";
    /// Pairs fitted because they may imitate the best.
    ///
    /// Chosen: a pair that was the truth once came eighth.
    IMITATING_PAIRS: usize = 8, "";
    /// Gain of the best single addition below which pairs are not tried, if the gap is not far above the noise.
    WORTH_PAIRS: f64 = 60.0, "ln of likelihood";
    /// Shares of its fitted size from which each number of an answer is fitted again.
    ANSWER_SHARES: [f64; 6] = [0.7, 0.87, 0.96, 1.04, 1.15, 1.4], "share";
    /// Shares of itself from which each number of a law outside the catalogue is fitted again.
    LAW_SHARES: [f64; 2] = [0.93, 1.07], "share";
    /// Shares of its fitted distance from sharp edges from which the stiffness of joints that give is fitted again.
    ///
    /// Stiffness goes with the square of their inverse. Of two walls held at a wrong one, one left it from the second share, the other
    /// from the last.
    BED_SHARES: [f64; 4] = [0.87, 0.96, 1.04, 1.15], "share";
    /// Places from which such fits of joints that give are ended.
    ///
    /// Of these two walls the most likely place led on, and a round that ended three took the stiffer bed 52 s on one thread.
    BEDS_FINISHED: usize = 1, "";
    /// Gain below which two such fits have come to one place by their first steps, and go on as one.
    ///
    /// Where windows are linear; chosen below [`EQUIVALENT`](super::EQUIVALENT). States of some windows that differ part them by as much.
    ONE_PLACE: f64 = 10.0, "ln of likelihood";
    /// Places from which such fits are ended.
    ANSWER_FINISHED: usize = 3, "";
    /// Times that an answer is fitted again from about itself.
    ANSWER_ROUNDS: usize = 3, "";
    /// Gain that is worth another time.
    WORTH_A_ROUND: f64 = 1.0, "ln of likelihood";
    /// By how much the numbers that it found must be more likely than those before, where windows are linear.
    ///
    /// A third of a standard deviation. What else a round finds are states of windows.
    MOVED_IN_A_ROUND: f64 = 0.05, "ln of likelihood";
}

limits! {
    /// When joints that give are tried.
    BEDS:
    /// Windowed error of the wall with its own numbers fitted above which joints may give.
    BEDS_GAP: f64 = 2.0, "noise";
    /// Windows that are asked whether joints give.
    BEDS_WINDOWS: usize = 30, "";
    /// Stiffness of beds that are looked at first.
    ///
    /// What a passage takes changes so much over a decade that beds halfway would not be seen to be asked for.
    BED_HALF_DECADES: [f64; 7] = [3e7, 1e8, 3e8, 1e9, 3e9, 1e10, 3e10], "Pa/m";
    /// Damping time with which beds are looked at.
    BED_DAMPING: f64 = 1e-3, "s";
    /// The same beside it where the top is held: nothing else takes energy from such a strip.
    HELD_DAMPING: f64 = 1e-2, "s";
    /// Damping times with which the best stiffness and those beside it are looked at, too.
    ///
    /// Chosen, half a decade to either side: a stiff bed of 3e-4 s at the ground was lost from 1e-3 s.
    BED_OTHER_DAMPINGS: [f64; 2] = [3e-4, 3e-3], "s";
    /// Share of the squared error above noise that the best of these must take away for beds to be fitted.
    BEDS_ASKED_FOR: f64 = 0.3, "share";
    /// Share of the squared error above noise that they must take away, in the tests held out, for effects beside them to be
    /// looked for.
    ///
    /// Chosen: friction beside a bed of 2.7e8 Pa/m leaves ten noises of twenty, half of which is damping of the bed in its place.
    BESIDE_BEDS_FROM: f64 = 0.3, "share";
    /// Effects of one number that are fitted beside them: those that promise most.
    BESIDE_BEDS: usize = 3, "";
    /// Windows in which these are told apart.
    BESIDE_BEDS_WINDOWS: usize = 60, "";
    /// Share of the squared error above noise left by beds there that the best of them must take away to be fitted to all windows.
    BESIDE_BEDS_ASKED_FOR: f64 = 0.5, "share";
    /// Share of the squared error above noise that beds must leave for effects beside them to be named by what they take away.
    ///
    /// Beds of another simulator alone are followed to 1e-3 of it.
    BED_OWN_ERROR: f64 = 2e-3, "share";
    /// Windowed error that they must leave, too.
    ///
    /// Chosen: a bed of another simulator whose floor has a gap leaves 1.5, its own numbers standing for the gap.
    BESIDE_BEDS_GAP: f64 = 1.3, "noise";
    /// Single effects on sharp edges beside which joints that give are looked for, and such beds that are fitted to all windows.
    ///
    /// Each takes a second or so in few windows, and ten in all.
    BEDS_BESIDE_EFFECTS: usize = 3, "";
    /// Windows in which a linear look about each of the beds that are looked at tells of effects beside it.
    ///
    /// Chosen, half as many as those that are asked for beds: the looks take most of the time.
    BEDS_TOGETHER_WINDOWS: usize = 15, "";
    /// Beds with an effect that are fitted together to few windows: those that this promises most of.
    ///
    /// Chosen: friction beside a bed of 7.3e7 Pa/m came eighth in a wider look, with three dampings in thirty windows.
    BEDS_TOGETHER: usize = 8, "";
    /// Share of the squared error above noise that one must take away there to be fitted to all windows.
    ///
    /// Chosen: in four blind cases what was hidden takes away 0.975 and more.
    BEDS_TOGETHER_TAKEN: f64 = 0.9, "share";
    /// Rivals of one effect on sharp edges that are fitted to few windows: those that promise most at a glance.
    BED_RIVALS_IN_FEW: usize = 8, "";
    /// The best of these are fitted to all windows.
    BED_RIVALS: usize = 3, "";
    /// Squared error above noise, over that of the best bed, up to which others are fitted to all windows.
    BEDS_NEAR_BEST: f64 = 2.0, "";
}
