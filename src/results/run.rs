//! The results of a run: for scripts as JSON, for people a few lines with the digits that hold.

use serde_json::{Map, Value, json};

use super::parts::PartResults;

use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{FurtherLaw, PATTERN_NAMES, Wall};
use mrbd_kernel::simulate::{BeyondModel, Ensemble, Outcome, Response, Shaking, Verdict, beyond_model};

/// A result of a run.
type Shown = fn(&Response) -> f64;

/// Results by their names, without sign: those whose spread is given.
const SPREAD: [(&str, Shown); 5] = [
    ("theta1_max_rad", |r| r.theta_max_rad[0].value.abs()),
    ("theta2_max_rad", |r| r.theta_max_rad[1].value.abs()),
    ("theta1_max_over_alpha1", |r| r.theta_max_over_alpha_i()[0]),
    ("theta2_max_over_alpha2", |r| r.theta_max_over_alpha_i()[1]),
    ("top_displacement_max_m", |r| r.top_displacement_m.value.abs()),
];

/// A run, the members of its ensemble and what the model says of it.
pub struct RunResults<'a> {
    wall: &'a Wall,
    ensemble: &'a Ensemble,
    beyond_model: Vec<BeyondModel>,
    parts: &'a [PartResults],
}

impl<'a> RunResults<'a> {
    /// The results of a wall under a shaking; an ensemble of one member is the run alone.
    pub fn new(wall: &'a Wall, shaking: &Shaking, ensemble: &'a Ensemble) -> Self {
        let step_s = shaking.horizontal.as_ref().map(Accelerogram::step_s);
        Self { wall, ensemble, beyond_model: beyond_model(wall, step_s, &ensemble.run), parts: &[] }
    }

    /// The same of a sequence of records, which is told part by part too.
    #[must_use]
    pub fn with_parts(self, parts: &'a [PartResults]) -> Self {
        Self { parts, ..self }
    }

    fn is_alone(&self) -> bool {
        self.ensemble.others.is_empty()
    }

    /// The results under the names that scripts rely on.
    pub fn json(&self) -> Value {
        let mut results = of_run(self.wall, &self.ensemble.run);
        let reasons: Vec<String> = self.beyond_model.iter().map(BeyondModel::to_string).collect();
        results["model_applies"] = reasons.is_empty().into();
        results["beyond_model"] = reasons.into();
        if !self.parts.is_empty() {
            results["parts"] = self.parts.iter().map(PartResults::json).collect();
        }
        if !self.is_alone() {
            results["ensemble"] = self.spread();
        }
        results
    }

    fn spread(&self) -> Value {
        let ensemble = self.ensemble;
        let digits: Map<String, Value> =
            SPREAD.iter().map(|(name, value)| ((*name).to_owned(), ensemble.digits(value).into())).collect();
        let mut spread = json!({
            "members": ensemble.members().count(),
            "failed": ensemble.failed(),
            "collapsed_share": ensemble.collapsed_share(),
            "verdict": ensemble.verdict().name(),
            "digits": digits,
        });
        for (name, value) in SPREAD {
            spread[name] = ensemble.spread(value).into();
        }
        spread
    }

    /// What a reader must know before the numbers: an outcome that does not hold, a model that does not apply.
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        if !self.is_alone() {
            remarks.push(self.certainty());
        }
        let beyond = self.beyond_model.iter();
        remarks.extend(beyond.map(|reason| format!("The model does not apply: {reason}.")));
        remarks
    }

    fn certainty(&self) -> String {
        let (collapsed, ended) = self.ensemble.collapsed();
        let failed = match self.ensemble.failed() {
            0 => String::new(),
            failed => format!(" {failed} more could not be finished."),
        };
        let [theta1, theta2] = [SPREAD[0], SPREAD[1]].map(|(_, value)| self.ensemble.digits(value));
        let digits = match theta1.min(theta2) {
            0 => "no digit of the rotations holds".to_owned(),
            1 => "1 digit of the rotations holds".to_owned(),
            digits => format!("{digits} digits of the rotations hold"),
        };
        match self.ensemble.verdict() {
            Verdict::Undecided => format!(
                "Undecided: {collapsed} of {ended} runs collapsed that differ by what nobody can know.{failed}"
            ),
            Verdict::Collapsed => format!(
                "It collapsed in {ended} of {ended} runs that differ by what nobody can know; {digits}.{failed}"
            ),
            Verdict::Stood => format!(
                "It stood in {ended} of {ended} runs that differ by what nobody can know; {digits}.{failed}"
            ),
            Verdict::Failed => "The run itself failed.".to_owned(),
        }
    }

    /// The results for people, a few lines.
    pub fn text(&self) -> String {
        let response = &self.ensemble.run;
        let undecided = self.ensemble.verdict() == Verdict::Undecided;
        let mut lines = vec![match &response.outcome {
            Outcome::Stood if undecided => {
                format!("The wall stood in this run, until {:.3} s.", response.end_time_s)
            }
            Outcome::Collapsed { time_s } if undecided => {
                format!("The wall collapsed in this run, at {time_s:.3} s.")
            }
            Outcome::Stood => format!("The wall stood until {:.3} s.", response.end_time_s),
            Outcome::Collapsed { .. } => format!("The wall collapsed at {} s.", self.collapse_time_s()),
            Outcome::Failed { time_s, reason } => format!("The run failed at {time_s:.3} s: {reason}."),
        }];
        lines.extend(self.remarks());
        lines.extend(self.body_lines());
        let top_m = self.shown(|r| r.top_displacement_m.value, |value| format!("{value:+.5}"));
        let time_s = self.held(|r| r.top_displacement_m.time_s);
        lines.push(format!("top         largest displacement {top_m} m at {time_s} s"));
        lines.extend(self.parts.iter().zip(1..).map(|(part, number)| part.text(number)));
        lines.extend(self.event_lines());
        lines.extend(self.assumption_lines());
        lines.join("\n")
    }

    /// When the wall collapsed, of the members in which it did.
    fn collapse_time_s(&self) -> String {
        let time_s = |r: &Response| r.end_time_s;
        let fell = |r: &&Response| r.collapsed();
        let others = self.ensemble.others.iter().filter(fell).cloned().collect();
        let fallen = Ensemble { run: self.ensemble.run.clone(), others };
        if self.is_alone() { format!("{:.3}", time_s(&fallen.run)) } else { fallen.text(time_s) }
    }

    /// A result with the digits that hold, or three decimals of a run that is alone.
    fn held(&self, value: impl Fn(&Response) -> f64) -> String {
        let all = format!("{:.3}", value(&self.ensemble.run));
        let held = self.ensemble.text(value);
        // Of digits that hold, a reader needs no more than these.
        let longer = !held.contains(" to ") && held.len() > all.len();
        if self.is_alone() || longer { all } else { held }
    }

    /// A signed result with the digits that hold, as an interval of sizes where none does. An undecided wall has
    /// no such digits: its members end at different times.
    fn shown(&self, value: Shown, all_digits: impl Fn(f64) -> String) -> String {
        let of_run = value(&self.ensemble.run);
        if self.is_alone() {
            return all_digits(of_run);
        }
        let size = self.ensemble.text(|r| value(r).abs());
        let no_digit = self.ensemble.digits(|r| value(r).abs()) == 0;
        match (no_digit, of_run < 0.0) {
            (true, _) => size,
            (false, true) => format!("-{size}"),
            (false, false) => format!("+{size}"),
        }
    }

    fn body_lines(&self) -> Vec<String> {
        let response = &self.ensemble.run;
        let rows: [(&str, [Shown; 3]); 2] = [
            (
                "lower body",
                [
                    |r| r.theta_max_rad[0].value,
                    |r| r.theta_max_over_alpha_i()[0],
                    |r| r.theta_max_rad[0].time_s,
                ],
            ),
            (
                "upper body",
                [
                    |r| r.theta_max_rad[1].value,
                    |r| r.theta_max_over_alpha_i()[1],
                    |r| r.theta_max_rad[1].time_s,
                ],
            ),
        ];
        let bodies = if self.wall.is_cracked() { 2 } else { 1 };
        let line = |(i, (name, [rotation, ratio, time_s])): (usize, (&str, [Shown; 3]))| {
            let name = if self.wall.is_cracked() { name } else { "wall" };
            let rotation = self.shown(rotation, |value| format!("{value:+.6}"));
            let ratio = match self.is_alone() {
                true => format!("{:.4}", ratio(response)),
                false => self.ensemble.text(ratio),
            };
            let (time_s, alpha_rad) = (self.held(time_s), response.alpha_i_rad[i]);
            format!(
                "{name:<12}largest rotation {rotation} rad at {time_s} s, {ratio} of its α = {alpha_rad:.5} rad"
            )
        };
        rows.into_iter().take(bodies).enumerate().map(line).collect()
    }

    fn event_lines(&self) -> Vec<String> {
        let response = &self.ensemble.run;
        let patterns = (0..PATTERN_NAMES.len()).filter(|&i| response.pattern_time_s[i] > 0.0);
        let time_s = |i: usize| format!("{} {} s", PATTERN_NAMES[i], self.held(|r| r.pattern_time_s[i]));
        let patterns: Vec<String> = patterns.map(time_s).collect();
        let impacts = self.ensemble.count(|r| r.impacts.total());
        let openings = self.ensemble.count(|r| r.openings.total());
        let mut lines = vec![
            format!("patterns    {}", patterns.join(", ")),
            format!("events      {impacts} impacts, {openings} openings"),
        ];
        let joints = if self.wall.is_cracked() { &["ground", "crack"][..] } else { &["ground"] };
        lines.extend(joints.iter().enumerate().map(|(i, name)| {
            let friction = self.held(|r| r.demand[i].friction);
            let tensions = self.ensemble.count(|r| r.demand[i].tensions);
            format!("friction    {friction} needed at the {name}; in tension there {tensions} times")
        }));
        lines
    }

    fn assumption_lines(&self) -> Vec<String> {
        let restitution = self.wall.parameters().restitution;
        let mut lines = vec![format!(
            "assumed     impact law {}, capture velocity {} rad/s; energy residual {:.1e}",
            restitution.law.name(),
            restitution.capture_velocity_rad_s,
            self.ensemble.run.energy.residual()
        )];
        if self.ensemble.run.work.tolerance_steps == 0 {
            lines.push(
                "tolerance   shortened no step, for those of the record are short enough: coarser ones give the same bits".to_owned(),
            );
        }
        let laws = self.wall.parameters().further_laws();
        if !laws.is_empty() {
            let names: Vec<String> = laws.iter().map(FurtherLaw::name).collect();
            lines.push(format!("effects     {}", names.join(", ")));
        }
        if !self.wall.reading().is_true() {
            let sensors = "sensors     rotations here are the wall's own; those of the history are as read";
            lines.push(sensors.to_owned());
        }
        lines
    }
}

/// The results of the run itself.
fn of_run(wall: &Wall, response: &Response) -> Value {
    let [theta1, theta2] = response.theta_max_rad;
    let [over_alpha1, over_alpha2] = response.theta_max_over_alpha_i();
    let collapse_time_s = match response.outcome {
        Outcome::Collapsed { time_s } => Some(time_s),
        _ => None,
    };
    let pattern_time_s: Map<String, Value> = PATTERN_NAMES
        .iter()
        .zip(response.pattern_time_s)
        .map(|(name, s)| ((*name).to_owned(), s.into()))
        .collect();
    let mut results = json!({
        "theta1_max_rad": theta1.value.abs(),
        "theta2_max_rad": theta2.value.abs(),
        "theta1_max_over_alpha1": over_alpha1,
        "theta2_max_over_alpha2": over_alpha2,
        "theta1_max_time_s": theta1.time_s,
        "theta2_max_time_s": theta2.time_s,
        "top_displacement_max_m": response.top_displacement_m.value.abs(),
        "collapsed": response.collapsed(),
        "collapse_time_s": collapse_time_s,
        "outcome": response.outcome.name(),
        "end_time_s": response.end_time_s,
        "pattern_time_s": pattern_time_s,
        "impacts": response.impacts.total(),
        "impacts_by_coefficient": response.impacts.table2,
        "openings": response.openings.total(),
        "energy_residual": response.energy.residual(),
        "friction_demand_ground": response.demand[0].friction,
        "friction_demand_crack": wall.is_cracked().then_some(response.demand[1].friction),
        "tensions_ground": response.demand[0].tensions,
        "tensions_crack": wall.is_cracked().then_some(response.demand[1].tensions),
        "steps": response.work.steps,
        "tolerance_steps": response.work.tolerance_steps,
        "evaluations": response.work.evaluations,
        "effects": wall.parameters().further_laws(),
    });
    let reading = wall.reading();
    if !reading.is_true() {
        // The rotations above are the wall's own; only histories are as read.
        results["sensors"] = json!({ "gain": reading.gain, "offset_rad": reading.offset_rad });
    }
    results
}
