//! The work of `speed.py` done by the library alone, piece by piece as its lines on stdin ask; the script reads the clocks.
//!
//! `study FILE THREADS` plans the study and runs it without storing, `single WALL RECORD TAIL_S TIMES` runs one wall.
//! Each answers a line when it is done: how many runs there were.

use std::io::{BufRead, stdin};
use std::path::Path;

use mrbd::study::batch::{SideBySide, run_all};
use mrbd::study::pipeline::Pipeline;
use mrbd::study::plan::Plan;
use mrbd_kernel::simulate::{Accuracy, Shaking, simulate};
use mrbd_records::{ReadOptions, read};

/// A study that is planned and run again and again.
fn study(file: &str, pool: &rayon::ThreadPool) -> usize {
    let pipeline = Pipeline::load(Path::new(file)).expect("a pipeline");
    let plan = Plan::load(&pipeline, None).expect("a plan");
    let all = (0..plan.len()).collect();
    pool.install(|| run_all(&plan, all, &SideBySide, &indicatif::ProgressBar::hidden())).len()
}

/// A wall under a record, as often as asked.
struct Single {
    wall: mrbd_kernel::model::Wall,
    shaking: Shaking,
}

impl Single {
    fn load(wall: &str, record: &str, tail_s: &str) -> Self {
        let wall = mrbd_files::load_wall(Path::new(wall)).expect("a wall");
        let record = read(Path::new(record), &ReadOptions::default()).expect("a record");
        let tail_s = tail_s.parse().expect("seconds");
        Self { wall, shaking: Shaking { horizontal: Some(record.accelerogram), vertical: None, tail_s } }
    }

    fn run(&self, times: usize) -> usize {
        let once = |_| simulate(&self.wall, std::hint::black_box(&self.shaking), Accuracy::default());
        (0..times).map(once).filter(|response| response.end_time_s > 0.0).count()
    }
}

fn main() {
    println!("{}", std::process::id());
    let pool = rayon::ThreadPoolBuilder::new().build().expect("threads");
    let mut single = None;
    for line in stdin().lock().lines().map_while(Result::ok) {
        let runs = match line.split('\t').collect::<Vec<_>>()[..] {
            ["study", file] => study(file, &pool),
            ["load", wall, record, tail_s] => {
                single = Some(Single::load(wall, record, tail_s));
                0
            }
            ["single", times] => single.as_ref().expect("loaded").run(times.parse().expect("a number")),
            _ => panic!("not a piece of work: {line}"),
        };
        println!("{runs}");
    }
}
