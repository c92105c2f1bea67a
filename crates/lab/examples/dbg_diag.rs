//! Temporary.
use mrbd_lab::Progress;
use mrbd_lab::diagnose::{Experiment, check_data, findings, trials};
#[derive(Debug)]
struct P;
fn cs() -> String {
    let s = std::fs::read_to_string("/proc/self/stat").unwrap();
    s.rsplit(')').next().unwrap().split_whitespace().nth(11).unwrap().to_owned()
}
impl Progress for P {
    fn begin(&self, what: &str, parts: usize) {
        eprintln!("T {:>6} cs {what} {parts}", cs());
    }
    fn advance(&self, _: usize) {}
    fn note(&self, _: &str) {}
}
fn main() {
    let path = std::env::args().nth(1).unwrap();
    let e = Experiment::load(std::path::Path::new(&path)).unwrap();
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().unwrap();
    if std::env::args().nth(2).is_some() {
        check_data(&e).unwrap();
    }
    let f = findings(&e, &P).unwrap();
    eprintln!("T {:>6} cs end", cs());
    let d = f.data();
    let show = |t: &trials::FittedHypothesis| {
        let h = &t.hypothesis;
        println!(
            "   {:60} {:?} against {:.1} err {:.3?} poor {:.3} {:.3} closes? {:?}",
            h.name(),
            h.unknowns
                .iter()
                .zip(&t.fit.values)
                .skip(h.nuisances)
                .map(|(u, v)| format!("{} {:.5e}", u.key, u.number(*v)))
                .collect::<Vec<_>>(),
            trials::against(&d, t),
            t.errors(),
            mrbd_lab::diagnose::fit::poor_share(&t.fit.windows),
            mrbd_lab::diagnose::fit::poor_share(&t.held_out.windows),
            trials::does_something(t)
        );
    };
    println!(
        "{path}: {} {:?} equivalent {:?} remainder {:?}",
        f.found.verdict.name(),
        f.found.place,
        f.found.equivalent,
        f.found.remainder
    );
    println!("other law {:?}", f.found.other_law);
    println!("windows {:?}", f.windows.each_ref().map(Vec::len));
    print!("before");
    show(&f.found.before);
    print!("recal");
    show(&f.found.recalibrated);
    print!("after");
    show(&f.found.after);
    for t in f.found.tried.iter().take(12) {
        show(t);
    }
}
