//! Runs that are of no plan: walls and motions as a caller has them.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};

use super::batch::{Finished, Ready, answered, message_of, prepare};
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{Accuracy, Shaking, simulate, simulate_side_by_side};

/// A wall, what shakes it, and how accurately it is run.
#[derive(Debug, Clone)]
pub struct Case {
    /// The wall, or why there is none.
    pub wall: Result<Wall, String>,
    /// What shakes it; cases that share samples cost less to make ready.
    pub shaking: Shaking,
    /// How accurately to run.
    pub accuracy: Accuracy,
}

/// Runs cases on the threads of the current pool, side by side: one result a case, in order, each with its number. `case` makes
/// a case of its number and `done` counts those that are done.
///
/// Once `stop` is set no others begin: those that were run are returned, without the missing ones.
pub fn run_cases(
    numbers: std::ops::Range<usize>,
    case: &(impl Fn(usize) -> Case + Sync),
    stop: &AtomicBool,
    done: &AtomicU64,
) -> Vec<Finished<usize>> {
    let next = AtomicUsize::new(numbers.start);
    let ended = rayon::broadcast(|_| {
        let lane = Thread { end: numbers.end, case, stop, done, next: &next, ended: RefCell::default() };
        lane.run();
        lane.ended.into_inner()
    });
    let mut ended: Vec<Finished<usize>> = ended.into_iter().flatten().collect();
    ended.sort_unstable_by_key(|finished| finished.run);
    ended
}

/// What one thread does.
struct Thread<'a, C> {
    /// One beyond the last number.
    end: usize,
    case: &'a C,
    stop: &'a AtomicBool,
    done: &'a AtomicU64,
    /// The number that is next, of all threads.
    next: &'a AtomicUsize,
    ended: RefCell<Vec<Finished<usize>>>,
}

impl<C: Fn(usize) -> Case> Thread<'_, C> {
    fn run(&self) {
        loop {
            // Cases that have begun and not ended.
            let at_work = RefCell::new(BTreeSet::new());
            let all = catch_unwind(AssertUnwindSafe(|| self.run_side_by_side(&at_work)));
            if all.is_ok() {
                return;
            }
            // One of them panics: each once more, alone, to tell which; the thread then goes on.
            for number in at_work.into_inner() {
                self.finish(self.alone(number));
            }
        }
    }

    fn run_side_by_side(&self, at_work: &RefCell<BTreeSet<usize>>) {
        let mut ready: Ready = None;
        let mut next = || {
            loop {
                let number = self.next.fetch_add(1, Ordering::Relaxed);
                if number >= self.end || self.stop.load(Ordering::Relaxed) {
                    return None;
                }
                // Noted before it is made ready, which may panic.
                at_work.borrow_mut().insert(number);
                let Case { wall, shaking, accuracy } = (self.case)(number);
                match wall {
                    Ok(wall) => return Some((number, prepare(&wall, shaking, accuracy, &mut ready))),
                    Err(reason) => {
                        at_work.borrow_mut().remove(&number);
                        self.finish(no_wall(number, &reason));
                    }
                }
            }
        };
        simulate_side_by_side(&mut next, &mut |number, response| {
            at_work.borrow_mut().remove(&number);
            self.finish(answered(Finished::planned(number), response));
        });
    }

    fn alone(&self, number: usize) -> Finished<usize> {
        let run = || {
            let Case { wall, shaking, accuracy } = (self.case)(number);
            match wall {
                Ok(wall) => answered(Finished::planned(number), simulate(&wall, &shaking, accuracy)),
                Err(reason) => no_wall(number, &reason),
            }
        };
        catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|panic| Finished {
            failure: Some(message_of(panic.as_ref())),
            ..Finished::planned(number)
        })
    }

    fn finish(&self, finished: Finished<usize>) {
        self.ended.borrow_mut().push(finished);
        self.done.fetch_add(1, Ordering::Relaxed);
    }
}

fn no_wall(number: usize, reason: &str) -> Finished<usize> {
    Finished { failure: Some(format!("no wall: {reason}")), ..Finished::planned(number) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::accelerogram::Accelerogram;
    use mrbd_kernel::model::WallParameters;

    fn case(number: usize) -> Case {
        let samples = (0..400).map(|k| 3.0 * (0.05 * f64::from(k)).sin()).collect();
        let horizontal = Some(Accelerogram::new(0.01, samples).expect("a record"));
        let shaking = Shaking { horizontal, vertical: None, tail_s: 1.0 };
        let strip = WallParameters::strip(0.2 + 0.01 * number as f64, 3.0, 1800.0);
        let wall = if number == 5 { Err("the sixth".into()) } else { Ok(Wall::new(strip).expect("a wall")) };
        assert!(number != 7, "the eighth");
        Case { wall, shaking, accuracy: Accuracy::default() }
    }

    #[test]
    fn analytic_cases_come_back_in_order_with_the_bits_of_single_runs() {
        let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
        let ended = run_cases(0..12, &case, &stop, &done);
        assert_eq!(
            ended.iter().map(|finished| finished.run).collect::<Vec<_>>(),
            (0..12).collect::<Vec<_>>()
        );
        assert_eq!(done.into_inner(), 12);
        for finished in ended {
            let number = finished.run;
            match finished.failure {
                Some(reason) => {
                    assert_eq!(reason, ["no wall: the sixth", "panicked: the eighth"][(number - 5) / 2])
                }
                None => {
                    let Case { wall, shaking, accuracy } = case(number);
                    let alone = simulate(&wall.expect("a wall"), &shaking, accuracy);
                    assert_eq!(finished.response, Some(alone));
                }
            }
        }
    }

    #[test]
    fn analytic_no_case_begins_after_a_stop() {
        let (stop, done) = (AtomicBool::new(true), AtomicU64::new(0));
        assert!(run_cases(0..12, &case, &stop, &done).is_empty());
    }
}
