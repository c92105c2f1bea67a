//! A public engine of symbolic regression on the points that `mrbd diagnose` measured, beside mrbd's answer.
//!
//! `make blind LAWS=1 SET=laws2 CASES=50 RECORDED=` makes the cases, `make bench-formulas` then runs this.
//!
//! It takes the blind cases whose hidden law acts at the top, is none of the catalogue and depends on x and v alone. The
//! engine, PySR's in Rust, has x, v, force and noise of the tests fitted. Both forces are held against the true one.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use dynamic_expressions::StringTreeOptions;
use mrbd_formula::{Formula, Parameter, Place};
use ndarray::Array2;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Row;
use serde_json::Value;
use symbolic_regression::{PopMember, prelude::*};

type Result<T> = std::result::Result<T, Box<dyn Error>>;
type Ops = BuiltinOpsF64;
type Member = PopMember<f64, Ops, 2>;
/// A force at the top, N, of displacement, velocity and the largest displacement so far.
type Law = Box<dyn Fn([f64; 3]) -> f64>;

const SEED: u64 = 1;
/// A case may cost as many evaluations of formulas at one point, about a minute of one processor,
const POINT_EVALUATIONS: u64 = 10_000_000_000;
/// where each formula costs as much as this many points beside the points themselves.
const POINTS_OF_A_FORMULA: u64 = 400;
/// The engine's own four, and what the hidden laws are written with.
const OPERATORS: [&str; 11] = ["+", "sub", "*", "/", "pow", "max", "abs", "sign", "abs2", "sqrt", "tanh"];
/// PySR's `model_selection="best"`: the best score among formulas within this factor of the least loss.
const WITHIN_LEAST_LOSS: f64 = 1.5;

fn main() -> Result<()> {
    // The engine then searches in this thread alone, and a seed gives the same answer again.
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global()?;
    let mut asked = 0;
    for folder in std::env::args().skip(1).map(PathBuf::from) {
        if let Some(case) = Case::read(&folder)? {
            case.tell(&folder)?;
            asked += 1;
        }
    }
    println!("{asked} cases have such a law and an answer");
    if asked > 0 { Ok(()) } else { Err("nothing to compare: give folders of answered blind cases".into()) }
}

/// What is hidden in a case, and what mrbd said.
struct Case {
    answer: Value,
    diagnosis: Value,
}

impl Case {
    /// `None` where the law is of another kind, or the case has no answer yet.
    fn read(folder: &Path) -> Result<Option<Self>> {
        let diagnosis = folder.join("diagnosis/diagnosis.json");
        let answer = json(&folder.join("answer.json"))?;
        let of_x_and_v = |e: &Value| e["kind"] == "formula" && !text(&e["formula"]).contains("x_max");
        let hidden = list(&answer["effects"]);
        let wanted = !hidden.is_empty() && hidden.iter().all(|e| e["place"] == "top" && of_x_and_v(e));
        let case = || Ok(Self { answer, diagnosis: json(&diagnosis)? });
        (wanted && diagnosis.exists()).then(case).transpose()
    }

    fn tell(&self, folder: &Path) -> Result<()> {
        let (case, name) = (&self.answer["case"], folder.display());
        println!("{name}: {}, {} rad, {}", case["kind"], case["noise_rad"], case["prior"]);
        for (whose, told) in [("hidden", &self.answer), ("mrbd", &self.diagnosis)] {
            for effect in list(&told["effects"]) {
                let law = if effect["formula"].is_null() { &effect["kind"] } else { &effect["formula"] };
                println!("  {whose:7} {} {}", text(law), effect["parameters"]);
            }
        }
        println!("  mrbd    {}", text(&self.diagnosis["verdict"]));
        self.mrbd()?.map_or(Ok(()), |law| self.errors("mrbd", &law, self.softer("after")?))?;
        let points = read_points(&folder.join("diagnosis/force.parquet"))?;
        let (before, scales, softer) = (processor_s()?, scales(&points), self.softer("before")?);
        let front = front(&points)?;
        let chosen = best(&front)?;
        let (each, seconds) = (squared_noise(&points), processor_s()? - before);
        println!("  engine  {} points of {each:.1} squared noise each, {seconds:.0} s", points.len());
        println!("  engine  {}", written(chosen, scales));
        self.errors("engine", &law(chosen, scales), softer)?;
        // What another choice from its front could reach at most, by one who knows the truth.
        let off = |m: &&Member| self.off(&law(m, scales), softer, "fit").map_or(f64::NAN, |off| off[2]);
        let nearest = front.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(chosen);
        println!("  nearest {}", written(nearest, scales));
        self.errors("nearest", &law(nearest, scales), softer)
    }

    /// The force of mrbd's answer, if it is one at the top.
    fn mrbd(&self) -> Result<Option<Law>> {
        let laws = list(&self.diagnosis["effects"]).iter().map(law_of).collect::<Result<Option<Vec<_>>>>()?;
        Ok(laws
            .filter(|laws| !laws.is_empty())
            .map(|laws| Box::new(move |at| laws.iter().map(|law| law(at)).sum()) as Law))
    }

    /// By how much the floor's spring, as given or as found, is softer than the true one, N/m.
    fn softer(&self, when: &str) -> Result<f64> {
        let is = |number: &&Value| text(&number["key"]).ends_with("stiffness_n_per_m");
        let own = list(&self.diagnosis["wall"]).iter().find(is).ok_or("no stiffness")?;
        Ok(number(&self.answer["case"]["stiffness_n_per_m"])? - number(&own[when])?)
    }

    fn errors(&self, whose: &str, law: &Law, softer: f64) -> Result<()> {
        for tests in ["fit", "held_out"] {
            let [median, most, square] = self.off(law, softer, tests)?.map(|share| 100.0 * share);
            println!("  {whose:7} {tests:8} median {median:6.2} %, largest {most:6.1} %, rms {square:6.1} %");
        }
        Ok(())
    }

    /// Median and largest error over the largest force, and its root mean square over that of the force.
    fn off(&self, law: &Law, softer: f64, tests: &str) -> Result<[f64; 3]> {
        let (mut off, mut all) = (Vec::new(), Vec::new());
        for point in list(&self.answer["excited"][tests]) {
            let (x, force) = (number(&point[0])?, number(&point[2])?);
            off.push((law([x, number(&point[1])?, number(&point[3])?]) + softer * x - force).abs());
            all.push(force.abs());
        }
        off.sort_by(f64::total_cmp);
        let most = all.iter().fold(f64::MIN_POSITIVE, |most, force| most.max(*force));
        let square = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
        let at = |i: usize| off.get(i).map(|off| off / most).ok_or("no excited points");
        Ok([at(off.len() / 2)?, at(off.len().max(1) - 1)?, (square(&off) / square(&all)).sqrt()])
    }
}

/// The law of one effect of an answer: a formula, or a name that is one.
fn law_of(effect: &Value) -> Result<Option<Law>> {
    let (formula, unit) = match text(&effect["kind"]) {
        _ if effect["place"] != "top" => return Ok(None),
        "formula" => (text(&effect["formula"]), ""),
        "cubic_stiffness" => ("-coefficient_n_per_m3*x**3", "N/m**3"),
        "viscous_damping" => ("-coefficient_n_s_per_m*v", "N*s/m"),
        "coulomb_friction" => ("-force_n*sign(v)", "N"),
        _ => return Ok(None),
    };
    let mut parameters = Vec::new();
    for (name, value) in effect["parameters"].as_object().ok_or("an effect without parameters")? {
        parameters.push(Parameter::new(name, number(value)?, effect["units"][name].as_str().unwrap_or(unit)));
    }
    let formula = Formula::parse(formula, Place::Top, &parameters)?;
    Ok(Some(Box::new(move |at| formula.value(at))))
}

/// Displacement, velocity, missing force and its standard deviation by the noise, of every stretch of the tests fitted.
fn read_points(file: &Path) -> Result<Vec<[f64; 4]>> {
    let mut points = Vec::new();
    for row in SerializedFileReader::new(fs::File::open(file)?)?.get_row_iter(None)? {
        let row = row?;
        if column(&row, "use")? == "\"fit\"" {
            let number = |name| -> Result<f64> { Ok(column(&row, name)?.parse()?) };
            let (x, v) = (number("displacement_m")?, number("velocity_m_s")?);
            points.push([x, v, number("force_n")?, number("force_sd_n")?]);
        }
    }
    Ok(points)
}

/// Largest displacement and velocity, and the weighted root mean square of the force: the engine likes numbers near one.
fn scales(points: &[[f64; 4]]) -> [f64; 3] {
    let most = |i: usize| points.iter().fold(0.0_f64, |most, point| most.max(point[i].abs()));
    let weights = points.iter().map(|point| point[3].powi(-2)).sum::<f64>();
    [most(0), most(1), (squared_noise(points) * points.len() as f64 / weights).sqrt()]
}

/// Mean square of the force in units of its noise: 1 where there is nothing but noise.
fn squared_noise(points: &[[f64; 4]]) -> f64 {
    points.iter().map(|point| (point[2] / point[3]).powi(2)).sum::<f64>() / points.len() as f64
}

/// The best formula of each complexity, in shares of the scales.
fn front(points: &[[f64; 4]]) -> Result<Vec<Member>> {
    let scales = scales(points);
    let weights = points.iter().map(|point| (point[3] / scales[2]).powi(-2)).collect();
    let inputs = Array2::from_shape_fn((2, points.len()), |(i, n)| points[n][i] / scales[i]);
    let forces = points.iter().map(|point| point[2] / scales[2]).collect();
    let data = Dataset::with_weights_and_names(inputs, forces, Some(weights), Vec::new());
    let options = Options::<f64, 2> {
        seed: SEED,
        // Evaluations end the search.
        niterations: usize::MAX / 1024,
        max_evals: POINT_EVALUATIONS / (POINTS_OF_A_FORMULA + points.len() as u64),
        deterministic: true,
        progress: false,
        operators: Ops::from_names(OPERATORS)?,
        ..Default::default()
    };
    Ok(equation_search::<f64, Ops, 2>(&data, &options).hall_of_fame.pareto_front())
}

fn written(member: &Member, [x, v, force]: [f64; 3]) -> String {
    let names = ["x", "v"].map(str::to_owned);
    let how = StringTreeOptions { variable_names: Some(&names), print_precision: Some(4), pretty: false };
    format!("{force:.1} N * ({}), x of {x:.4} m, v of {v:.4} m/s", string_tree(&member.expr, how))
}

/// A formula that is in shares, as a force.
fn law(member: &Member, scales: [f64; 3]) -> Law {
    let expression = member.expr.clone();
    Box::new(move |at| {
        let at = Array2::from_shape_fn((2, 1), |(i, _)| at[i] / scales[i]);
        let (force, whole) = eval_tree_array::<f64, Ops, 2>(&expression, at.view(), &EvalOptions::default());
        if whole { force[0] * scales[2] } else { f64::NAN }
    })
}

/// PySR's choice: how much the logarithm of the loss falls for each more of complexity, among the formulas with little loss.
fn best(front: &[Member]) -> Result<&Member> {
    let least = front.last().ok_or("the engine found no formula")?.loss;
    let steps = front.iter().zip(front.iter().take(1).chain(front));
    let more = |(own, less): &(&Member, &Member)| (own.complexity - less.complexity).max(1) as f64;
    let score = |step: &(&Member, &Member)| (step.1.loss / step.0.loss).ln() / more(step);
    let near = steps.filter(|(own, _)| own.loss <= WITHIN_LEAST_LOSS * least);
    Ok(near.max_by(|a, b| score(a).total_cmp(&score(b))).ok_or("no finite loss")?.0)
}

/// Time that this thread has had a processor.
fn processor_s() -> Result<f64> {
    let file = fs::read_to_string("/proc/thread-self/schedstat")?;
    Ok(file.split(' ').next().unwrap_or_default().parse::<f64>()? * 1e-9)
}

fn column(row: &Row, name: &str) -> Result<String> {
    let mut all = row.get_column_iter();
    Ok(all.find(|(own, _)| *own == name).ok_or_else(|| format!("no column {name}"))?.1.to_string())
}

fn json(file: &Path) -> Result<Value> {
    let value = fs::File::open(file).map_err(serde_json::Error::io).and_then(serde_json::from_reader);
    value.map_err(|error| format!("{}: {error}", file.display()).into())
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

fn number(value: &Value) -> Result<f64> {
    value.as_f64().ok_or_else(|| format!("a number was looked for, {value} found").into())
}
