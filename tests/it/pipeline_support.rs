//! A small study, a suite made in memory and a simulator that costs nothing.

use std::path::Path;

use mrbd::study::pipeline::Pipeline;
use mrbd::study::plan::Plan;
use mrbd::survey::Survey;
use mrbd_files::coefficients::CoefficientSets;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{
    Accuracy, EnergyLedger, Impacts, JointDemand, Openings, Outcome, Peak, Response, Shaking, Start, Work,
};
use mrbd_records::{About, Accelerogram, IntensityMeasures, Suite, SuiteRecord};

pub const SWEEP: &str = include_str!("../../pipelines/sweep.toml");
const SURVEY: &str = include_str!("../../inputs/survey.toml");
const COEFFICIENTS: &str = include_str!("../../inputs/coefficients.toml");

/// A study of two parameters, three slendernesses and two variants: 2 × 2 × 3 × 3 = 36 runs a record.
pub const SMALL: &str = r#"
name = "small"
survey = "survey.toml"
coefficients = "coefficients.toml"
suite = "suite.toml"

[sweep]
slenderness = [10.0, 14.0, 18.0]

[sweep.parameters]
perpendicular = ["thickness"]
parallel = ["restitution"]

[[variants]]
name = "base"

[[variants]]
name = "contact"
set = { law = "contact" }
"#;

/// A record of two samples and more whose peak tells which one it is: `number` m/s².
fn record(number: u32) -> SuiteRecord {
    let peak = f64::from(number);
    let horizontal = Accelerogram::new(0.01, vec![0.0, peak, -peak, 0.0]).expect("a valid record");
    SuiteRecord {
        id: number,
        name: format!("record {number}"),
        event: "none".to_owned(),
        scale: 1.0,
        intensity: IntensityMeasures::of(&horizontal),
        horizontal,
        vertical: None,
        vertical_scale: 1.0,
        generated: true,
        about: About::default(),
    }
}

/// A suite of that many records.
pub fn suite(records: u32) -> Suite {
    Suite {
        name: "made up".to_owned(),
        generated: true,
        note: String::new(),
        source: String::new(),
        records: (1..=records).map(record).collect(),
    }
}

pub fn pipeline(text: &str) -> Pipeline {
    Pipeline::parse(Path::new("study.toml"), text.to_owned()).expect("a valid pipeline")
}

pub fn try_plan(text: &str, suite: Suite) -> mrbd::Result<Plan> {
    let survey = Survey::parse(Path::new("survey.toml"), SURVEY).expect("the repository's survey");
    let sets = CoefficientSets::parse(Path::new("c.toml"), COEFFICIENTS).expect("the repository's file");
    Plan::new(&pipeline(text), survey, sets, suite)
}

pub fn plan(text: &str, records: u32) -> Plan {
    try_plan(text, suite(records)).expect("a plan of façades that can stand")
}

/// A response with these rotations over α_i, the second body's twice the first's.
pub fn response(wall: &Wall, over_alpha: f64, outcome: Outcome) -> Response {
    let alpha_i_rad = wall.alpha_i_rad();
    let peak = |i: usize, ratio: f64| Peak { value: -ratio * alpha_i_rad[i], time_s: 0.5 };
    Response {
        outcome,
        end_time_s: 4.0,
        theta_max_rad: [peak(0, over_alpha), peak(1, 2.0 * over_alpha)],
        alpha_i_rad,
        alpha_rad: wall.alpha_rad(),
        top_displacement_m: Peak::default(),
        crack_displacement_m: Peak::default(),
        pattern_time_s: [1.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        impacts: Impacts { table2: [1, 0, 0, 0, 0, 2, 0, 0], other: 3, captured: 4 },
        openings: Openings { rest_to_3: 1, ..Openings::default() },
        energy: EnergyLedger {
            initial_j: 1.0,
            final_j: 1.0,
            passed_through_j: 2.0,
            ..EnergyLedger::default()
        },
        demand: [JointDemand { friction: 0.4, tensions: 0, compression_n: 0.0 }; 2],
        work: Work { steps: 10, rejected_steps: 1, evaluations: 70, tolerance_steps: 2 },
        left: Start::default(),
    }
}

/// Stands with a rotation of a hundredth of the record's peak; falls above 5 m/s², fails at 9, panics at 10.
pub fn stand_in(wall: &Wall, shaking: &Shaking, _accuracy: Accuracy) -> Response {
    let peak = shaking.horizontal.as_ref().expect("a sweep has records").peak_m_s2();
    match peak.round() as u32 {
        10 => panic!("a slip of the program"),
        9 => response(wall, f64::NAN, Outcome::Failed { time_s: 0.1, reason: "no contact state".to_owned() }),
        6..=8 => response(wall, 2.0, Outcome::Collapsed { time_s: 0.3 }),
        _ => response(wall, peak / 100.0, Outcome::Stood),
    }
}
