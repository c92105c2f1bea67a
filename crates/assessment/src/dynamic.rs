//! The check by nonlinear dynamic analysis (C8.7.1.2.1.9): the wall itself under records of the site.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::capacity::{Capacity, Control, LIMIT_STATES};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{
    Accuracy, MEMBERS, Outcome, Response, Shaking, beyond_model, simulate, simulate_ensemble,
};
use mrbd_records::{Building, SuiteRecord, floor_motion};

/// Free motion after a record, s: the default of the other commands.
pub const TAIL_S: f64 = 5.0;

/// The wall under one record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RecordRun {
    /// Name of the record.
    pub record: String,
    /// Largest d, m; of a wall that fell what it had reached when it counted as fallen.
    pub largest_d_m: f64,
    /// Least and largest of that over runs that differ by what nobody can know, m.
    pub spread_d_m: [f64; 2],
    /// Whether it went beyond d_0, or fell.
    pub beyond_d_0: bool,
    /// Share of those runs that went beyond d_0.
    pub beyond_share: f64,
    /// Why the model does not apply to the run; empty where it does.
    pub beyond_model: Vec<String>,
}

/// The check over the records.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Dynamic {
    /// Runs: one a record; those beside them are in the shares.
    pub runs: usize,
    /// How many went beyond d_0.
    pub beyond_d_0: usize,
    /// Mean of the largest d, m; where the wall fell, no less than that.
    pub mean_largest_m: f64,
    /// 95 % interval of that mean over records (Student's t), m; `None` for a single record.
    pub mean_interval_m: Option<[f64; 2]>,
    /// None beyond d_0, and the mean below d_SLV.
    pub accepted_slv: bool,
    /// None beyond d_0, and the mean below d_SLC.
    pub accepted_slc: bool,
    /// Whether other records of the same kind, and the digits that nobody can know, would say the same of SLV.
    pub decided_slv: bool,
    /// The same of SLC.
    pub decided_slc: bool,
    /// One a record.
    pub records: Vec<RecordRun>,
}

/// A wall, its capacity and what shakes it.
#[derive(Debug, Clone, Copy)]
pub struct Shaken<'a> {
    /// The wall.
    pub wall: &'a Wall,
    /// Its capacity.
    pub capacity: &'a Capacity,
    /// Accuracy of the runs.
    pub accuracy: Accuracy,
}

/// A record that a run could not be finished under.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("record {record}: the run failed at {time_s} s: {reason}")]
pub struct Unfinished {
    /// Its name.
    pub record: String,
    /// When, s.
    pub time_s: f64,
    /// Why.
    pub reason: String,
}

/// The horizontal motions of a suite where the wall stands: at the ground as they are, on a floor through the building.
pub fn motions(records: &[SuiteRecord], floor: Option<&Building>) -> Vec<(String, Accelerogram)> {
    let at = |record: &SuiteRecord| match floor {
        None => record.horizontal.clone(),
        // Sums of finite numbers by stable recursions are finite.
        Some(building) => floor_motion(&record.horizontal, &building.all_modes(), building.damping)
            .expect("a linear building answers a finite record with a finite one"),
    };
    records.iter().map(|record| (record.name.clone(), at(record))).collect()
}

impl Shaken<'_> {
    /// Runs the wall under every motion, each with an ensemble beside it.
    ///
    /// # Errors
    /// [`Unfinished`].
    pub fn check(
        &self,
        motions: &[(String, Accelerogram)],
        done: impl Fn() + Sync,
    ) -> Result<Dynamic, Unfinished> {
        let run = |(name, motion): &(String, Accelerogram)| self.run(name, motion);
        let records: Result<Vec<RecordRun>, Unfinished> =
            motions.par_iter().map(run).inspect(|_| done()).collect();
        Ok(self.judged(records?))
    }

    /// Whether the check accepts SLV with all motions times a factor: one run a record.
    ///
    /// # Errors
    /// [`Unfinished`].
    pub fn accepts_slv(&self, motions: &[(String, Accelerogram)], factor: f64) -> Result<bool, Unfinished> {
        let run = |(name, motion): &(String, Accelerogram)| {
            let response = simulate(self.wall, &shaking(motion.scaled(factor)), self.accuracy);
            finished(name, &response)?;
            Ok((self.d_m(&response), self.is_beyond(&response)))
        };
        let all: Vec<(f64, bool)> = motions.par_iter().map(run).collect::<Result<_, Unfinished>>()?;
        let mean_m = all.iter().map(|(d_m, _)| d_m).sum::<f64>() / all.len() as f64;
        Ok(all.iter().all(|(_, beyond)| !beyond) && mean_m < LIMIT_STATES[0] * self.capacity.d_0_m)
    }

    fn run(&self, name: &str, motion: &Accelerogram) -> Result<RecordRun, Unfinished> {
        let ensemble = simulate_ensemble(self.wall, &shaking(motion.clone()), self.accuracy, MEMBERS);
        finished(name, &ensemble.run)?;
        let ended: Vec<&Response> =
            ensemble.members().filter(|member| !matches!(member.outcome, Outcome::Failed { .. })).collect();
        let beyond = ended.iter().filter(|member| self.is_beyond(member)).count();
        let reasons = beyond_model(self.wall, Some(motion.step_s()), &ensemble.run);
        Ok(RecordRun {
            record: name.to_owned(),
            largest_d_m: self.d_m(&ensemble.run),
            spread_d_m: ensemble.spread(|member| self.d_m(member)),
            beyond_d_0: self.is_beyond(&ensemble.run),
            beyond_share: beyond as f64 / ended.len() as f64,
            beyond_model: reasons.iter().map(ToString::to_string).collect(),
        })
    }

    /// The largest displacement of a run as that of the equivalent oscillator (C8.7.1.4), m.
    fn d_m(&self, response: &Response) -> f64 {
        let peak = match self.capacity.control {
            Control::Top => response.top_displacement_m,
            Control::Crack => response.crack_displacement_m,
        };
        self.capacity.d_of_control_m(peak.value.abs())
    }

    fn is_beyond(&self, response: &Response) -> bool {
        response.collapsed() || self.d_m(response) > self.capacity.d_0_m
    }

    fn judged(&self, records: Vec<RecordRun>) -> Dynamic {
        let largest: Vec<f64> = records.iter().map(|run| run.largest_d_m).collect();
        let (mean_m, interval) = mean_with_interval(&largest);
        let beyond = records.iter().filter(|run| run.beyond_d_0).count();
        let sure = records.iter().all(|run| run.beyond_share == 0.0 || run.beyond_share == 1.0);
        let [slv_m, slc_m] = LIMIT_STATES.map(|share| share * self.capacity.d_0_m);
        // A mean on one side of its limit, with its whole interval, or a wall that surely fell under some record.
        let decided = |limit_m: f64| {
            let apart = interval.is_some_and(|[low, high]| high < limit_m || low >= limit_m);
            let falls = records.iter().any(|run| run.beyond_share == 1.0);
            falls || (sure && apart)
        };
        Dynamic {
            runs: records.len(),
            beyond_d_0: beyond,
            mean_largest_m: mean_m,
            mean_interval_m: interval,
            accepted_slv: beyond == 0 && mean_m < slv_m,
            accepted_slc: beyond == 0 && mean_m < slc_m,
            decided_slv: decided(slv_m),
            decided_slc: decided(slc_m),
            records,
        }
    }
}

fn shaking(motion: Accelerogram) -> Shaking {
    Shaking { horizontal: Some(motion), vertical: None, tail_s: TAIL_S }
}

fn finished(record: &str, response: &Response) -> Result<(), Unfinished> {
    match &response.outcome {
        Outcome::Failed { time_s, reason } => {
            Err(Unfinished { record: record.to_owned(), time_s: *time_s, reason: reason.clone() })
        }
        _ => Ok(()),
    }
}

/// A mean and its 95 % interval by Student's t over n - 1.
fn mean_with_interval(values: &[f64]) -> (f64, Option<[f64; 2]>) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
    let half = StudentsT::new(0.0, 1.0, n - 1.0).ok().filter(|_| n > 1.0).map(|t| {
        let error = (squares / (n - 1.0) / n).sqrt();
        t.inverse_cdf(0.975) * error
    });
    (mean, half.map(|half| [(mean - half).max(0.0), mean + half]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::model::WallParameters;
    use mrbd_statics::Edges;

    fn pulse(peak_m_s2: f64) -> (String, Accelerogram) {
        let samples = (0..200).map(|k| peak_m_s2 * (6.0 * f64::from(k) * 0.005).sin()).collect();
        (format!("{peak_m_s2}"), Accelerogram::new(0.005, samples).expect("samples"))
    }

    #[test]
    fn analytic_a_block_that_does_not_rock_is_accepted_and_one_that_falls_is_not() {
        let wall = Wall::new(WallParameters::strip(0.4, 3.2, 1800.0)).expect("a wall");
        let capacity = Capacity::of(&wall, Edges::AsTheyAre).expect("a mechanism");
        let shaken = Shaken { wall: &wall, capacity: &capacity, accuracy: Accuracy::default() };
        // Below g b/h = 1.23 m/s² it stays at rest.
        let still = shaken.check(&[pulse(0.5), pulse(1.0)], || {}).expect("finished");
        assert_eq!((still.runs, still.beyond_d_0, still.mean_largest_m), (2, 0, 0.0));
        assert!(still.accepted_slv && still.accepted_slc && still.decided_slv);
        let fallen = shaken.check(&[pulse(1.0), pulse(20.0)], || {}).expect("finished");
        assert!(fallen.beyond_d_0 == 1 && !fallen.accepted_slv && !fallen.accepted_slc && fallen.decided_slv);
        assert!(shaken.accepts_slv(&[pulse(1.0)], 1.0).expect("finished"));
        assert!(!shaken.accepts_slv(&[pulse(1.0)], 20.0).expect("finished"));
    }

    #[test]
    fn published_the_interval_of_a_mean_of_seven() {
        // t of 6 degrees of freedom at 97.5 %: 2.4469 (any table).
        let values = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        let (mean, interval) = mean_with_interval(&values);
        let [low, high] = interval.expect("an interval");
        let half = 2.4469 * (28.0_f64 / 6.0 / 7.0).sqrt();
        assert!(
            (mean - 4.0).abs() < 1e-15 && (high - 4.0 - half).abs() < 1e-4 && (4.0 - low - half).abs() < 1e-4
        );
        assert!(mean_with_interval(&[1.0]).1.is_none());
    }
}
