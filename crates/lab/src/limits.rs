//! Every number that decides a diagnosis: limits, shares, gains and counts, in the order of the flow.
//!
//! Numbers of methods stay beside them: step lengths, damping, test functions, seeds. `docs/diagnosis.md` gets its tables
//! from here; the first paragraph of each is what it shows.

/// A limit as the guide shows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limit {
    /// Name of the constant.
    pub name: &'static str,
    /// Its value.
    pub value: &'static str,
    /// Its unit; empty for a count.
    pub unit: &'static str,
    doc: &'static str,
}

impl Limit {
    /// What it decides: the first paragraph of its documentation.
    pub fn meaning(&self) -> String {
        let first = self.doc.split("\n\n").next().unwrap_or_default();
        first.split_whitespace().collect::<Vec<_>>().join(" ")
    }
}

/// Constants, and the same as rows of a table.
macro_rules! limits {
    ($(#[doc = $about:literal])+ $group:ident:
     $($(#[doc = $doc:literal])+ $name:ident: $type:ty = $value:expr, $unit:literal;)+) => {
        $($(#[doc = $doc])+ pub const $name: $type = $value;)+
        $(#[doc = $about])+
        pub const $group: &[Limit] = &[$(Limit {
            name: stringify!($name),
            value: stringify!($value),
            unit: $unit,
            doc: concat!($($doc, "\n"),+),
        }),+];
    };
}

limits! {
    /// Whether files are read as they were meant.
    FILES:
    /// Largest rotation of a wall that still stands; more is refused.
    ///
    /// Read in degrees a wall has it at once.
    TOO_LARGE_RAD: f64 = 0.7, "rad";
    /// Fewest samples of both rotations in a test.
    ///
    /// Some windows of tens of samples.
    LEAST_SAMPLES: usize = 200, "";
    /// Share of a test's windowed error below which another reading of its file is the right one.
    ///
    /// In 599 tests of walls with and without hidden effects, read as they should be, the least was 0.75 for channels
    /// swapped, 1.03 for both signs and 2.4 for the others. Of the same files made wrong it finds one sign in all, both signs
    /// in 88 and a swap in 16 of 100: the channels of a wall whose crack hardly opens are alike. One file of an experiment in
    /// degrees was found in 40 of 40.
    MISREAD_TEST: f64 = 0.5, "share";
    /// The same for the geometric mean over all tests.
    ///
    /// In 130 experiments of three to six tests the least was 0.90; all of them made wrong, both signs are found in 99 and a
    /// swap in 37 of 100.
    MISREAD_TOGETHER: f64 = 0.75, "share";
    /// Fewest tests that are looked at together.
    MISREAD_LEAST_TESTS: usize = 3, "";
}

limits! {
    /// Which pattern a measured wall is in.
    PATTERNS:
    /// Beyond this a sum of squares, or a mean, is not noise alone.
    BEYOND_NOISE: f64 = 3.0, "standard deviations";
    /// Share of a step by which times may be off where a pattern is read.
    ///
    /// Twice what rounding to milliseconds does at 256 Hz.
    UNEVEN: f64 = 0.25, "share";
    /// Distance from zero at which an opening has a sign.
    OPEN_CLEAR: f64 = 4.0, "standard deviations";
    /// Scatter of a block of samples above which the wall moves in it.
    REST_SCATTER: f64 = 1.4, "noise";
    /// Difference between the halves of a block above which the wall moves in it.
    REST_DRIFT: f64 = 5.0, "standard deviations";
    /// Mean of a channel at rest below which its offset is taken for zero.
    OFFSET_CLEAR: f64 = 6.0, "standard deviations";
    /// Times that patterns are read again without a sensor's gain.
    READ_AGAIN: usize = 3, "";
    /// Squared error that free bodies must take away from a window for its joint to count as open.
    ///
    /// Chosen: two numbers that say nothing take away two, from the best of forty starts some ten.
    GAINED_BY_OPENING: f64 = 60.0, "squared noise";
    /// Gap above which a joint does not read as closed.
    ///
    /// 17 samples know each rotation to 0.37 of the noise, and their difference to half of it; three times that.
    READS_CLOSED: f64 = 1.5, "noise";
    /// Windows with a joint open by less than the noise, for which everything is fitted again.
    WORTH_OPENING: usize = 2, "";
}

limits! {
    /// Windows, and what they say.
    WINDOWS:
    /// Length of a window aimed at: half to one and a half times as long, and up to four times among doubt.
    ///
    /// About half a period of a rocking wall, so that most hold one impact at the ground.
    WINDOW_S: f64 = 0.5, "s";
    /// Fewest samples of a window.
    ///
    /// Several times what its own state takes.
    LEAST_WINDOW_SAMPLES: usize = 20, "";
    /// Distance of a sample from zero above which the wall moves.
    MOVES: f64 = 6.0, "noise";
    /// Windows in motion below which no effect could show.
    LEAST_MOVING: usize = 6, "";
    /// A window with more error than noise leaves, by this much, is missed.
    ///
    /// Other starts are then tried: an impact just missed or just met has valleys of its own.
    MISSED_SD: f64 = 5.0, "standard deviations";
    /// Share of missed windows above which no other valleys are looked for.
    MOST_MISSED: f64 = 0.3, "share";
    /// Squared error that the middle loss bounds: where a third of the windows lie beyond it, a fit is far from the tests.
    MIDDLE_BOUND: f64 = 8.0, "squared noise";
    /// Share of the windows, those followed worst, left out of the windowed error.
    ///
    /// An impact decided by less than the noise parts even a perfect simulation from the measurement.
    LEFT_OUT: f64 = 0.1, "share";
    /// What one window can say against a hypothesis at most.
    MOST_NATS: f64 = 40.0, "ln of likelihood";
}

limits! {
    /// What was known of the wall.
    KNOWN:
    /// Distance from its prior within which a number of the wall lies.
    PRIOR_REACH: f64 = 3.0, "standard deviations";
    /// A relative prior wider than this says that a number was not known.
    WIDE_PRIOR: f64 = 0.1, "share";
    /// Prior of a number of the wall once it is measured, where an effect stands in its place.
    MEASURED_PRIOR: f64 = 0.02, "share";
    /// Share by which a number that was not known must move for effects to be tried in its place.
    MOVED_SHARE: f64 = 0.1, "share";
    /// Largest damper.
    ///
    /// It holds what it is on; a stronger one does the same in ever shorter steps.
    STRONGEST_DAMPER: f64 = 100.0, "sizes that matter";
    /// Prior of a factor on C_l about 1.
    ///
    /// Wide, but a factor that never acts stays at 1.
    FACTOR_SD: f64 = 0.3, "";
}

limits! {
    /// What is tried.
    TRIED:
    /// Most starts of two or more added numbers that are fitted coarsely.
    BEGUN: usize = 3, "";
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
    /// Gain below which two such fits have come to one place by their first steps, and go on as one.
    ///
    /// Where windows are linear; chosen below [`EQUIVALENT`]. States of some windows that differ part them by as much.
    ONE_PLACE: f64 = 10.0, "ln of likelihood";
    /// Places from which such fits are ended.
    ANSWER_FINISHED: usize = 3, "";
    /// Times that an answer is fitted again from about itself.
    ANSWER_ROUNDS: usize = 3, "";
    /// Gain that is worth another time.
    WORTH_A_ROUND: f64 = 1.0, "ln of likelihood";
}

limits! {
    /// When joints that give are tried.
    BEDS:
    /// Windowed error of the wall with its own numbers fitted above which joints may give.
    BEDS_GAP: f64 = 2.0, "noise";
    /// Windows that are asked whether joints give.
    BEDS_WINDOWS: usize = 30, "";
    /// Stiffness of beds that are looked at first.
    BED_DECADES: [f64; 3] = [1e8, 1e9, 1e10], "Pa/m";
    /// Stiffness of beds that are looked at where these promise something.
    BED_HALF_DECADES: [f64; 4] = [3e7, 3e8, 3e9, 3e10], "Pa/m";
    /// Damping time with which beds are looked at.
    BED_DAMPING: f64 = 1e-3, "s";
    /// The same beside it where the top is held: nothing else takes energy from such a strip.
    HELD_DAMPING: f64 = 1e-2, "s";
    /// Share of the squared error above noise that the best of these must take away for beds to be fitted.
    BEDS_ASKED_FOR: f64 = 0.3, "share";
    /// Share of the squared error above noise that they must take away, in the tests held out, for effects beside them to be
    /// looked for.
    BESIDE_BEDS_FROM: f64 = 0.5, "share";
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
    /// Share of the squared error above noise left by the first of a bed and an effect that the second must take away, in tests
    /// fitted and in those held out, where what both leave stands in the place of noise.
    ///
    /// A cubic spring beside a bed of another simulator takes 72 % of it where fitted and 95 % held out; where such a bed is all there
    /// is, a sensor's gain takes 74 and 31 %.
    TAKEN_BESIDE_OWN_ERROR: f64 = 0.5, "share";
    /// Rivals of one effect on sharp edges that are fitted to few windows: those that promise most at a glance.
    BED_RIVALS_IN_FEW: usize = 8, "";
    /// The best of these are fitted to all windows.
    BED_RIVALS: usize = 3, "";
    /// Squared error above noise, over that of the best bed, up to which others are fitted to all windows.
    BEDS_NEAR_BEST: f64 = 2.0, "";
}

limits! {
    /// When an effect is named.
    NAMED:
    /// Distance of at least one number of an effect from doing nothing.
    SIGNIFICANT_SD: f64 = 4.0, "standard deviations";
    /// The same distance, as a share of the size that would matter.
    ///
    /// Both chosen; a null twin that was once named had 1.2 standard deviations and 7e-5.
    LEAST_SIZE: f64 = 0.005, "share";
    /// Windowed error below which a wall without effects leaves noise.
    ///
    /// Some twenty null experiments, at noises of 1e-5 to 3e-4 rad, lie between 0.96 and 1.00.
    NOISE: f64 = 1.06, "noise";
    /// Windowed error below which an effect leaves noise: its tests are followed within it, or it is not the law.
    ///
    /// Where the right effect is added, the error lies between 0.96 and 1.02.
    NOISE_AFTER: f64 = 1.03, "noise";
    /// Share of the squared error above noise that an effect may leave instead.
    ///
    /// For gaps so large that the least error of another simulator shows. Right names leave less than 1e-4; a saturating
    /// spring called a cubic one 1e-3.
    LEFT_OF_GAP: f64 = 5e-4, "share";
    /// Share of the windows that may be missed.
    ///
    /// A stop that is met in the largest swings only shows in few. Chosen: where nothing is hidden, and beside right names, 0
    /// to 4.4 % of 60 to 330 windows lie beyond (impacts that the noise decides, and what another way of modelling a contact
    /// leaves), and 4 of 55 in a twin; beside a wrong name 10 %, with a stop taken for nothing 12 %, and 19 % and more with
    /// other laws outside the catalogue.
    MISSED_SHARE: f64 = 0.045, "share";
    /// Deviation of their number by which more of them may be missed.
    MISSED_SHARE_SD: f64 = 3.0, "standard deviations";
    /// Windowed error of the tests held out above which nothing is named.
    HELD_OUT_ERROR: f64 = 1.5, "noise";
    /// Excess of the share of windows missed among those held out over that among those fitted.
    ///
    /// A law that is only near the right one takes up what it was fitted to. Chosen: right names 1.7 at most among 142, a
    /// saturating spring called a cubic one 3.7.
    MISSED_HELD_OUT_SD: f64 = 2.5, "standard deviations";
    /// Gain over the wall with its own numbers fitted, in all windows, from which an effect is worth a name.
    ///
    /// Chosen: the effects of the development set gain hundreds.
    WORTH_A_NAME: f64 = 30.0, "ln of likelihood";
    /// Rivals nearer than this to the best make a class.
    ///
    /// Chosen: a ratio of likelihoods of 3e6.
    EQUIVALENT: f64 = 15.0, "ln of likelihood";
}

limits! {
    /// What formulations of a stiff contact part by.
    IMPACTS:
    /// Error that may be left at impacts over all windows, under a name over those of each test, over the largest rotation.
    ///
    /// Free bodies on corners of 1e10 N/m and 4e6 N s/m leave 1.2e-4 beside a right name, and 2.7e-4 where nothing is hidden.
    LEFT_AT_IMPACTS: f64 = 5e-4, "share";
    /// Share of the windows that must be left once all are cut at the first change of contact.
    ///
    /// Chosen: of such bodies 85 to 95 % are left.
    LEFT_UNCUT: f64 = 0.5, "share";
    /// Range of what impacts keep in another formulation, over what rigid bodies on sharp edges keep.
    ///
    /// Rows of springs with dampers keep 4.8 to 6.8 % more at the crack and 0.2 to 1 % at the ground; corners that give lose up to
    /// 0.03 %. What is hidden in blind cases keeps 2 % less and on.
    KEPT_AT_IMPACTS: [f64; 2] = [0.99, 1.08], "factor";
    /// Standard deviation of such a factor from which on it is not told.
    NOT_TOLD_SD: f64 = 0.1, "factor";
}

limits! {
    /// When joints that give are named though they leave more than noise.
    REMAINDER:
    /// Windowed error of the wall with its own numbers fitted above which a name may leave a remainder.
    REMAINDER_GAP: f64 = 3.0, "noise";
    /// Share of the squared error above noise that it must take away, in the tests fitted and in those held out.
    REMAINDER_TAKEN: f64 = 0.8, "share";
    /// Share that it must take away in the smaller and in the larger swings.
    REMAINDER_BY_SWING: f64 = 0.5, "share";
    /// What the next effect of another kind must leave in the tests held out, over what the named one leaves, squared.
    REMAINDER_RIVAL: f64 = 3.0, "";
    /// Relative standard deviation of the numbers of a bed by another way to model it.
    ///
    /// Chosen: beds of an independent simulator are found 3 % too soft at both joints, and 0.5 % too stiff at one.
    BED_MODEL_SD: f64 = 0.03, "share";
    /// Stiffness of a bed from which on another way to model a sharp edge may stand for it.
    STIFFEST_NAMED_PA_PER_M: f64 = 1e11, "Pa/m";
}

limits! {
    /// When two effects are named where one was.
    SECOND:
    /// Gain of a second effect over the best single one from which it is named.
    ///
    /// Chosen: a second effect that was there gained 1026; one that was not took up what another way of modelling a contact
    /// leaves, 79, or a law outside the catalogue, 240 and once 399.
    WORTH_A_SECOND: f64 = 300.0, "ln of likelihood";
    /// The same where both together leave no more than noise.
    ///
    /// What takes up another law or another contact leaves the rest of it. Chosen above the 79; one that was there gained 226.
    WORTH_A_SECOND_TO_NOISE: f64 = 150.0, "ln of likelihood";
    /// The same where the tests held out show it too.
    ///
    /// Chosen: of some 210 cases with one effect hidden, a second one that they saw gained 47 at most to noise, and one of
    /// which they saw 3 gained 89; one that was there gained 91.
    WORTH_A_SECOND_SEEN: f64 = 70.0, "ln of likelihood";
    /// Gain over the tests held out from which they show it.
    WORTH_A_SECOND_HELD_OUT: f64 = 30.0, "ln of likelihood";
}

limits! {
    /// When a law is none of the catalogue.
    OTHER_LAW:
    /// Bend with velocity of the force left at the top, beside a named effect.
    ///
    /// Right names leave 6 and less, once 28; friction under stiff corners left 63 and 73, and is not named; a quadratic drag
    /// called a damper leaves 101 and 400, a loose mass 169.
    BENT_FORCE: f64 = 50.0, "squared standard deviations";
    /// Gain of a trend of a named size with the amplitude.
    ///
    /// Right names have 9 and less, but at a noise of 1e-5 rad 27, 51 and 57; damping that grows with displacement called a
    /// damper, or a damper with other impacts, 37, 55 and 313; a spring that saturates called a cubic one 274.
    TREND_NATS: f64 = 25.0, "ln of likelihood";
    /// Share of its size by which a named size may differ in large motion.
    ///
    /// Right names that gain so much have 0.4 to 2 % (the finer points of a contact), a spring that saturates called a cubic
    /// one 8 %, a quadratic drag called a damper 56 %.
    TREND_SHARE: f64 = 0.04, "share";
}

limits! {
    /// When a place is told without a law.
    PLACE:
    /// Share of what speaks against the wall that the effects of a place must take away.
    PLACE_NATS: f64 = 0.3, "share";
    /// Share of the squared error above noise that does as well.
    ///
    /// Where the gap is far above the noise, what each window says is at its bound with and without them. Chosen: beside three
    /// laws outside, the best of the catalogue took away about 62 to 81 % of it, and 12 to 33 % of what spoke against the
    /// wall.
    PLACE_SQUARED_ERROR: f64 = 0.5, "share";
    /// Size of a measured residual from which it has a direction.
    DIRECTION_CLEAR: f64 = 16.0, "squared standard deviations";
    /// Fewest stretches with a direction.
    LEAST_DIRECTIONS: usize = 3, "";
    /// Share of the squared moments off the direction of the top below which the force acts there.
    ///
    /// Twins of forces at the top have 1e-3 and less, a record 0.01 s late 0.1.
    ALONG_TOP: f64 = 0.03, "share";
    /// Squared force over squared noise below which there is nothing to explain.
    ///
    /// Seven standard deviations of a hundred points of noise alone.
    FORCE_CLEAR: f64 = 2.0, "";
    /// Share of the measured force that a curve against one quantity must explain.
    ///
    /// Chosen; a stop outside the catalogue has 0.999, dampers of twins more than 0.9.
    EXPLAINED_BY_ONE: f64 = 0.8, "share";
}

limits! {
    /// When a law that no catalogue has is told as a formula.
    FORMULA:
    /// What the shape of an atom costs beside its numbers.
    ///
    /// About the logarithm of the number of shapes.
    LAW_LENGTH: f64 = 3.0, "ln of likelihood";
    /// The same of a shape that few walls have: a damper of one direction, one side, or beyond a displacement.
    ///
    /// Chosen: over the few points of short tests such shapes do what a drag with a stop does.
    RARE_LAW_LENGTH: f64 = 8.0, "ln of likelihood";
    /// Laws of one atom, and of two, that are refined off the grid.
    LAWS_REFINED: usize = 16, "";
    /// Evidence over points from which laws are tried in windows.
    ///
    /// Where nothing is hidden the best law costs more than it gains.
    WORTH_WINDOWS: f64 = 10.0, "ln of likelihood";
    /// Laws of one atom that are looked at in windows as they are, and of two where no single one closes the gap.
    LAWS_IN_WINDOWS: usize = 8, "";
    /// The best of these are fitted to windows.
    LAWS_FITTED: usize = 3, "";
    /// Least exponent of velocity at the top that is fitted; 0 is friction, and the wall sticks and slides by it exactly.
    ///
    /// A force that nearly jumps takes steps as short as it is steep. Chosen: where friction was hidden, one law near `|v|^0` took
    /// 180 of 300 s of a diagnosis; with this limit all laws of that case take 6.
    LEAST_AT_TOP: f64 = 0.2, "";
    /// Least exponent of velocity at a joint.
    ///
    /// Nothing holds a joint that is open, and a moment that jumps at rest is refused of a wall file. Chosen: one that nearly jumps
    /// is taken to be what once kept a look at eight pairs from ending; with this limit it took 1.3 s.
    LEAST_AT_JOINTS: f64 = 0.5, "";
    /// What one fit of a law, a curve or an answer may work, for each number that it looks for: evaluations of the equations of
    /// motion for each second of the windows fitted.
    ///
    /// A fit that needs more ends, is none of the answers, and is told under `unfinished`.
    FIT_WORK: f64 = 2e5, "1/s";
    /// The best of these are told among the rivals.
    LAWS_TOLD: usize = 4, "";
    /// Largest size of a law in windows, over that found over points.
    MOST_OF_LAW: f64 = 10.0, "";
    /// Share of the gain over points that a law must keep in tests that it was not fitted to, one left out after the other.
    ///
    /// Chosen.
    LEFT_OUT_SHARE: f64 = 0.5, "share";
    /// Loss in a single such test that refuses it.
    LEFT_OUT_LOSS: f64 = 15.0, "ln of likelihood";
    /// Distance of a number of a shape from its bounds below which it is at them, and nothing is known of it.
    AT_BOUND: f64 = 0.005, "share of the range";
    /// Distance of an exponent from 0, ½, 1, 3/2, 2, 3 ... within which the law with that exponent is tried too.
    EXACT_WITHIN: f64 = 0.2, "";
    /// Largest difference of two forces over what was excited below which they are one law, over the largest force.
    SAME_FORCE: f64 = 0.02, "share";
    /// Difference of two forces over what was excited from which a name with its exponent set free is another law, over the
    /// largest force.
    ///
    /// Chosen above [`TREND_SHARE`]: right names differ by the finer points of a contact.
    OTHER_FORCE: f64 = 0.05, "share";
    /// Distance from nothing at which a curve of velocity feeds the wall.
    FEEDS_SD: f64 = 3.0, "standard deviations";
    /// Share of a force from which it depends on the way, or on how far the top has been, and is no curve.
    OF_MEMORY: f64 = 0.1, "share";
    /// Share of the squared error above noise that a force without a formula must take away in the tests fitted, and in those
    /// held out.
    CURVE_SHRINKS: f64 = 0.8, "share";
    /// Share of the largest displacement below which a swing is small: laws are asked whether small and large swings predict each
    /// other.
    SMALL_SWING: f64 = 0.7, "share";
}

limits! {
    /// What could hide, what could not be told apart, and which test would.
    BEYOND:
    /// Distance from doing nothing at which an effect is detected.
    ///
    /// It is so large by chance once in a thousand times.
    DETECTED_SD: f64 = 3.3, "standard deviations";
    /// Share of an effect's trace that another must imitate for both to be listed.
    IMITATED_SHARE: f64 = 0.9, "share";
    /// Factors on the records of the tests that could come next.
    NEXT_FACTORS: [f64; 4] = [0.5, 1.0, 1.5, 2.0], "";
    /// Best next tests to which the second hypothesis is fitted; for the others it keeps its values.
    NEXT_FITTED: usize = 3, "";
    /// Displacements of the top that a slow pull might reach, over the wall's thickness.
    ///
    /// Far from where it would tip; no farther than the tests went.
    NEXT_PULLS: [f64; 2] = [0.05, 0.1], "share";
}

/// Every group by its name in the guide.
pub const GROUPS: [(&str, &[Limit]); 14] = [
    ("files", FILES),
    ("patterns", PATTERNS),
    ("windows", WINDOWS),
    ("known", KNOWN),
    ("tried", TRIED),
    ("beds", BEDS),
    ("named", NAMED),
    ("impacts", IMPACTS),
    ("remainder", REMAINDER),
    ("second", SECOND),
    ("other law", OTHER_LAW),
    ("place", PLACE),
    ("formula", FORMULA),
    ("beyond", BEYOND),
];
