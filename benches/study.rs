//! Speed at a glance, everything in turns in one process: `make bench`.
//!
//! The table wall; the Monte Carlo of Table 3 (both configurations, seven records, free motion after each) and a reference
//! case of the sweep as `mrbd run` does them, files and all, on one and two threads; and the arithmetic they cannot do
//! without: the bare evaluations of the equations of motion that their runs make. A machine whose speed drifts drifts for
//! all of them, so that ratios hold.

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

use mrbd::study::batch::{SideBySide, Simulate, run_all};
use mrbd::study::campaign::{Layout, Shard, Standing, Work, run_missing};
use mrbd::study::pipeline::Pipeline;
use mrbd::study::plan::Plan;
use mrbd::study::runs::{Earlier, Manifest, OutputFolder};
use mrbd_kernel::model::{Contact, ImpactLaw, Pivot, RockingWall, State, Vector, Wall};
use mrbd_kernel::simulate::{Accuracy, Response, Shaking, simulate};

use table_wall::{earthquake, table_wall};

mod table_wall;

const TURNS: usize = 7;

fn shipped(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The Monte Carlo goes under records of which one of so many samples is kept, too. Few of its steps end at a sample there: what
/// it takes then is what steps over several samples would not spare.
const EVERY: usize = 4;

/// The suite of the shipped records with these samples, whose peaks it does not state.
fn thinned_suite(folder: &Path) -> PathBuf {
    for entry in std::fs::read_dir(shipped("inputs/records/emilia7")).expect("the records") {
        let path = entry.expect("an entry").path();
        let text = std::fs::read_to_string(&path).expect("a text");
        let is_record = path.extension().is_some_and(|extension| extension == "csv");
        let kept = text.lines().enumerate().filter(|(i, line)| match is_record {
            true => *i == 0 || (i - 1) % EVERY == 0,
            false => !line.starts_with("pga_g") && !line.starts_with("pgv_m_s"),
        });
        let kept: Vec<&str> = kept.map(|(_, line)| line).collect();
        std::fs::write(folder.join(path.file_name().expect("a name")), kept.join("\n")).expect("written");
    }
    folder.join("suite.toml")
}

/// A study in a folder of its own.
struct Study {
    pipeline: Pipeline,
    plan: Plan,
}

impl Study {
    fn monte_carlo() -> Self {
        Self::monte_carlo_under(&shipped("inputs/records/emilia7/suite.toml"))
    }

    fn monte_carlo_under(suite: &Path) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let text = std::fs::read_to_string(shipped("pipelines/monte_carlo.toml")).expect("the pipeline");
        let text = text.replace("../inputs/records/emilia7/suite.toml", suite.to_str().expect("UTF-8"));
        let text = text.replace("../inputs", shipped("inputs").to_str().expect("UTF-8"));
        let path = folder.path().join("monte_carlo.toml");
        std::fs::write(&path, text).expect("written");
        // The manifest needs the file that was read.
        let _ = folder.keep();
        let pipeline = Pipeline::load(&path).expect("the Monte Carlo");
        let plan = Plan::load(&pipeline, None).expect("its plan");
        Self { pipeline, plan }
    }

    /// Plans, runs and stores all of it.
    fn spent(&self, threads: usize, simulate: &(impl Simulate + Sync)) -> Spent {
        let out = tempfile::tempdir().expect("a temporary folder");
        spent(|| {
            let plan = Plan::load(&self.pipeline, None).expect("a plan");
            let manifest =
                Manifest::of(&plan, &self.pipeline, &self.pipeline.suite, None).expect("a manifest");
            let folder = OutputFolder::prepare(out.path(), &manifest, &self.pipeline.text, Earlier::Refuse)
                .expect("a folder");
            let standing = Standing::of(&folder, &Layout::of(folder.manifest())).expect("nothing done yet");
            let (stop, progress) = (AtomicBool::new(false), indicatif::ProgressBar::hidden());
            let (shard, stop, progress) = (Shard::WHOLE, &stop, &progress);
            let pool = &pool(threads);
            let work = Work { plan: &plan, folder: &folder, shard, pool, simulate, stop, progress };
            let tally = run_missing(&work, &standing, |_| ()).expect("the study");
            assert_eq!(tally.runs(), self.plan.len());
        })
    }

    fn runs(&self) -> f64 {
        self.plan.len() as f64
    }
}

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
}

/// A parameter of a configuration at its levels: nine slendernesses, three levels, seven records.
fn reference_case() -> (Plan, Vec<u64>) {
    let pipeline = Pipeline::load(&shipped("pipelines/sweep.toml")).expect("the sweep");
    let plan = Plan::load(&pipeline, None).expect("the sweep's plan");
    let first = plan.run(0);
    let of_case = |position: &u64| {
        let run = plan.run(*position);
        run.variant.name == first.variant.name
            && run.configuration == first.configuration
            && run.parameter() == first.parameter()
    };
    let positions = (0..plan.len()).filter(of_case).collect();
    (plan, positions)
}

/// Bare evaluations, each waiting for the one before, as those of a run do.
fn arithmetic(wall: &RockingWall, evaluations: u64) -> State {
    let contact = Contact { ground: Pivot::Right, crack: Pivot::Left };
    let mut state = State { theta: [0.01, -0.01], omega: [0.1, 0.1] };
    for _ in 0..evaluations {
        let rate = wall.rate(contact, black_box(&state), Vector { x: 1.0, y: 0.0 });
        state.theta[0] = 0.01 + 1e-12 * rate.theta_dd[0];
    }
    state
}

/// Evaluations, steps and impacts of a run, in the mean.
#[derive(Debug, Clone, Copy)]
struct Counts {
    evaluations: f64,
    steps: f64,
    impacts: f64,
}

/// Those of a study.
fn counts(study: &Study) -> Counts {
    let [evaluations, steps, impacts] = [0, 1, 2].map(|_| AtomicU64::new(0));
    let counted = |wall: &Wall, shaking: &Shaking, accuracy: Accuracy| {
        let response = simulate(wall, shaking, accuracy);
        evaluations.fetch_add(response.work.evaluations, Ordering::Relaxed);
        steps.fetch_add(response.work.steps, Ordering::Relaxed);
        impacts.fetch_add(response.impacts.total(), Ordering::Relaxed);
        response
    };
    study.spent(2, &counted);
    let [evaluations, steps, impacts] =
        [evaluations, steps, impacts].map(|count| count.into_inner() as f64 / study.runs());
    Counts { evaluations, steps, impacts }
}

/// What a piece of work took, s.
#[derive(Debug, Clone, Copy)]
struct Spent {
    wall_s: f64,
    /// Processor time of all threads.
    cpu_s: f64,
}

fn spent<T>(work: impl FnOnce() -> T) -> Spent {
    let (start, cpu_s) = (Instant::now(), cpu_seconds());
    black_box(work());
    Spent { wall_s: start.elapsed().as_secs_f64(), cpu_s: cpu_seconds() - cpu_s }
}

/// Does work on one processor, with all threads that it begins; not where `taskset` does not keep this thread to one.
fn on_one_processor<T>(work: impl FnOnce() -> T) -> Option<T> {
    let thread = std::fs::read_link("/proc/thread-self").ok()?;
    let status = std::fs::read_to_string("/proc/thread-self/status").ok()?;
    let allowed = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:"))?.trim();
    let first = allowed.split(|c: char| !c.is_ascii_digit()).next()?;
    let keep_to = |processors: &str| {
        let taskset =
            Command::new("taskset").args(["-c", "-p", processors]).arg(thread.file_name()?).output();
        taskset.ok()?.status.success().then_some(())
    };
    keep_to(first)?;
    let done = work();
    keep_to(allowed).expect("the processors this thread had");
    Some(done)
}

fn seconds<T>(work: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    black_box(work());
    start.elapsed().as_secs_f64()
}

/// Processor time this process has used, s, to a hundredth: what other programs leave of the machine does not count in it.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // Fields 14 and 15, in ticks, which Linux has shown as hundredths since 2.4; the second field may hold blanks.
    let after_name = stat.rsplit(')').next().unwrap_or_default();
    let ticks = after_name.split_whitespace().skip(11).take(2).filter_map(|field| field.parse::<f64>().ok());
    ticks.sum::<f64>() / 100.0
}

/// Prints median and quartiles; gives the median.
fn print(what: &str, unit: &str, values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    let at = |quarter: usize| values[(values.len() - 1) * quarter / 4];
    let [low, median, high] = [1, 2, 3].map(at);
    println!("{what:<62} {median:>9.3} ({low:.3} to {high:.3}) {unit}");
    median
}

/// What the turns took.
#[derive(Default)]
struct Times {
    evaluation_s: Vec<f64>,
    table_wall_s: Vec<f64>,
    monte_carlo: [Vec<Spent>; 2],
    /// One thread, and what stores its blocks, on one processor.
    one_processor: Vec<Spent>,
    /// The same under records with few samples, one thread.
    thinned: Vec<Spent>,
    without_simulations: Vec<Spent>,
    simulations_alone: Vec<Spent>,
    /// Ten times over, for the sake of the clock of processor time.
    case: [Vec<Spent>; 2],
}

fn main() {
    let accuracy = Accuracy::default();
    let wall = table_wall(ImpactLaw::Whole, 1e-3);
    let horizontal = earthquake();
    let tail_s = 30.0 - horizontal.duration_s();
    let shaking = Shaking { horizontal: Some(horizontal), vertical: None, tail_s };
    let once = simulate(&wall, &shaking, accuracy);
    let (study, (sweep, case)) = (Study::monte_carlo(), reference_case());
    let bar = indicatif::ProgressBar::hidden();
    let records = tempfile::tempdir().expect("a temporary folder");
    let thinned = Study::monte_carlo_under(&thinned_suite(records.path()));
    let work = [counts(&study), counts(&thinned)];
    let told = |_: &Wall, _: &Shaking, _: Accuracy| once.clone();
    let pools = [1, 2].map(pool);
    let rocking = RockingWall::new(&wall);
    let mut times = Times::default();
    for _ in 0..TURNS {
        times.evaluation_s.push(seconds(|| arithmetic(&rocking, 100_000)) / 1e5);
        times.table_wall_s.extend((0..20).map(|_| seconds(|| simulate(&wall, &shaking, accuracy))));
        for (i, pool) in pools.iter().enumerate() {
            times.monte_carlo[i].push(study.spent(1 + i, &SideBySide));
            let once = || run_all(&sweep, case.clone(), &SideBySide, &bar).len();
            let all = || (0..10).map(|_| once()).sum::<usize>();
            times.case[i].push(pool.install(|| spent(all)));
        }
        times.one_processor.extend(on_one_processor(|| study.spent(1, &SideBySide)));
        times.thinned.push(thinned.spent(1, &SideBySide));
        times.without_simulations.push(study.spent(1, &told));
        let all = (0..study.plan.len()).collect();
        let run = || run_all(&study.plan, all, &SideBySide, &bar).len();
        times.simulations_alone.push(pools[0].install(|| spent(run)));
    }
    tell(&times, &once, study.runs(), case.len(), work);
}

fn tell(times: &Times, once: &Response, runs: f64, case: usize, [work, thinned]: [Counts; 2]) {
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    println!(
        "medians and quartiles, everything in turns in one process; load of the machine: {}",
        load.trim()
    );
    let of = |spent: &[Spent], value: fn(&Spent) -> f64| spent.iter().map(value).collect::<Vec<f64>>();
    let bare =
        print("bare evaluation of the equations of motion", "ns", times.evaluation_s.iter().map(|t| t * 1e9));
    let table = print("table wall, 30 s at 0.005 s", "ms", times.table_wall_s.iter().map(|t| t * 1e3));
    let share = |evaluations: f64, time_ms: f64| evaluations * bare * 1e-6 / time_ms;
    let own = once.work.evaluations as f64;
    let impacts = once.impacts.total();
    println!("  {own} evaluations, {impacts} impacts; bare, they are {:.2} of it", share(own, table));
    for (i, spent) in times.monte_carlo.iter().enumerate() {
        let what = format!("Monte Carlo of Table 3, {runs} runs stored, threads: {}", 1 + i);
        print(&what, "runs/s", of(spent, |s| s.wall_s).into_iter().map(|t| runs / t));
        print("  processor time of a run", "ms", of(spent, |s| s.cpu_s).into_iter().map(|t| t * 1e3 / runs));
        print("  processors it got", "", of(spent, |s| s.cpu_s / s.wall_s));
    }
    let [one, two] = &times.monte_carlo;
    print("  two threads over one", "", one.iter().zip(two).map(|(one, two)| one.wall_s / two.wall_s));
    if times.one_processor.len() == TURNS {
        let kept = times.one_processor.iter().map(|one| runs / one.wall_s);
        print("  one thread kept to one processor", "runs/s", kept);
        let over = times.one_processor.iter().zip(two);
        print("  two threads over that", "", over.map(|(one, two)| one.wall_s / two.wall_s));
    } else {
        println!("  one thread kept to one processor: not measured, for want of taskset");
    }
    let alone = of(&times.simulations_alone, |s| s.cpu_s);
    let alone =
        print("  processor time of a run planned and run alone", "ms", alone.iter().map(|t| t * 1e3 / runs));
    let Counts { evaluations, steps, impacts } = work;
    println!("  {evaluations:.0} evaluations a run; bare, they are {:.2} of that", share(evaluations, alone));
    println!("  {steps:.0} steps and {impacts:.0} impacts a run: {:.1} steps an impact", steps / impacts);
    let of_samples = times.thinned.iter().zip(one).map(|(thinned, all)| thinned.cpu_s / all.cpu_s);
    print(&format!("  with one of {EVERY} samples of the records: of the time"), "", of_samples);
    let Counts { steps, impacts, .. } = thinned;
    println!("    {steps:.0} steps and {impacts:.0} impacts a run: {:.1} steps an impact", steps / impacts);
    let around = times.without_simulations.iter().zip(one);
    print("  share of all but simulations in processor time", "", around.map(|(w, all)| w.cpu_s / all.cpu_s));
    for (i, spent) in times.case.iter().enumerate() {
        let what = format!("reference case, {case} runs, threads: {}", 1 + i);
        print(&what, "ms", of(spent, |s| s.wall_s * 100.0));
        print("  processor time", "ms", of(spent, |s| s.cpu_s * 100.0));
    }
}
