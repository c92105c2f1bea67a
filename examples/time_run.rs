//! Time of one run by the library, reading and starting not counted: `time_run WALL RECORD SCALE TAIL_S`.
//!
//! Prints JSON: the median of as many runs as fit a second or two, and what to compare with others.

use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

use mrbd_files::load_wall;
use mrbd_kernel::simulate::{Accuracy, Shaking, simulate};
use mrbd_records::{ReadOptions, read};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = std::env::args().skip(1).collect::<Vec<_>>();
    let [wall, record, scale, tail_s] = arguments.as_slice() else {
        return Err("time_run WALL RECORD SCALE TAIL_S".into());
    };
    let wall = load_wall(Path::new(wall))?;
    let record = read(Path::new(record), &ReadOptions::default())?.accelerogram.scaled(scale.parse()?);
    let shaking = Shaking { horizontal: Some(record), vertical: None, tail_s: tail_s.parse()? };
    let run = || simulate(black_box(&wall), black_box(&shaking), Accuracy::default());
    let response = run();
    let mut times = Vec::new();
    let start = Instant::now();
    while start.elapsed() < Duration::from_millis(1500) {
        let start = Instant::now();
        black_box(run());
        times.push(start.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    let [lower, upper] = response.theta_max_rad.map(|peak| peak.value.abs());
    println!(
        "{{\"seconds\": {:e}, \"runs\": {}, \"largest\": [{lower:e}, {upper:e}], \"impacts\": {}, \"evaluations\": {}}}",
        times[times.len() / 2],
        times.len(),
        response.impacts.total(),
        response.work.evaluations
    );
    Ok(())
}
