//! Formulas that depend on how far the top has been, `x_max`.

use mrbd_formula::{Formula, Place};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Contact, RockingWall};
use mrbd_kernel::simulate::{Observer, Response, Simulator, Start, simulate, simulate_observed};
use mrbd_kernel::solver::Quintic;

use super::{ACCURACY, formula, shaking, table_wall, with_formulas};

/// The path of the top, and the force of a law along it, worked out apart from the kernel's.
struct Worked {
    wall: RockingWall,
    law: Formula,
    largest_m: f64,
    work_j: f64,
    largest_piece_m: f64,
}

impl Observer for Worked {
    fn moved(&mut self, _: f64, contact: Contact, motion: &Quintic) {
        const PARTS: u32 = 64;
        let x_c = |share: f64| self.wall.top_displacement_m(contact, motion.position(share));
        let mut before = x_c(0.0);
        for k in 1..=PARTS {
            let after = x_c(f64::from(k) / f64::from(PARTS));
            let middle = 0.5 * (before + after);
            self.largest_m = self.largest_m.max(middle.abs());
            self.work_j -= self.law.value([middle, 0.0, self.largest_m]) * (after - before);
            self.largest_piece_m = self.largest_piece_m.max((after - before).abs());
            self.largest_m = self.largest_m.max(after.abs());
            before = after;
        }
    }
    fn stood(&mut self, _: f64, _: f64) {}
    fn ended(&mut self, _: f64, _: Contact, _: [f64; 2]) {}
}

#[test]
fn analytic_what_a_law_with_memory_takes_is_its_work_along_the_path() {
    let own = [("k", 300.0, "N"), ("g", 0.01, "m")];
    let law = formula(Place::Top, "-k*x/(g + x_max)", &own);
    let wall = with_formulas(std::slice::from_ref(&law), table_wall());
    let mut path =
        Worked { wall: RockingWall::new(&wall), law, largest_m: 0.0, work_j: 0.0, largest_piece_m: 0.0 };
    let response = simulate_observed(&wall, &shaking(1.0), ACCURACY, &mut path);
    // The table wall comes back: what is left is what the law has taken for good, and most of its largest.
    assert!(path.work_j > 0.5 && path.largest_m > 0.01, "{} J, {} m", path.work_j, path.largest_m);
    let off = (response.energy.effect_loss_j / path.work_j - 1.0).abs();
    // The middle of a piece stands for it: its square over that of the length g.
    assert!(off < (path.largest_piece_m / 0.01).powi(2), "{off}, pieces of {} m", path.largest_piece_m);
    let left_m = response.left.largest_displacement_m;
    assert!((left_m / path.largest_m - 1.0).abs() < 1e-6, "{left_m} and {}", path.largest_m);
}

#[test]
fn analytic_a_law_of_the_largest_displacement_is_its_envelope_on_the_way_out() {
    // From rest to the first turn, x_max is abs(x).
    let own = [("k", 300.0, "N"), ("g", 0.01, "m")];
    let runs = ["-k*x/(g + x_max)", "-k*x/(g + abs(x))"].map(|text| {
        let wall = with_formulas(&[formula(Place::Top, text, &own)], table_wall());
        let mut shaken = shaking(1.0);
        shaken.horizontal = Some(Accelerogram::new(0.01, vec![2.5; 40]).expect("a record"));
        shaken.tail_s = 0.0;
        simulate(&wall, &shaken, ACCURACY)
    });
    let [a, b] = runs.each_ref().map(|run| run.theta_max_rad[1].value);
    assert!(a.abs() > 1e-3 && (a - b).abs() < 1e-7 * runs[0].alpha_rad, "{a} and {b}");
}

#[test]
fn analytic_a_window_goes_on_with_the_largest_displacement_of_before() {
    let own = [("k", 300.0, "N"), ("g", 0.01, "m")];
    let wall = with_formulas(&[formula(Place::Top, "-k*x/(g + x_max)", &own)], table_wall());
    let simulator = Simulator::new(&wall, &shaking(1.0), ACCURACY);
    let whole = simulator.run(&mut ());
    let first = simulator.run_from(&simulator.release(), 1.7, &mut ());
    assert!(first.left.largest_displacement_m > 0.005, "{:?}", first.left);
    let end_s = simulator.end_s();
    let rest = simulator.run_from(&first.left, end_s, &mut ());
    let forgot = Start { largest_displacement_m: 0.0, ..first.left };
    let forgot = simulator.run_from(&forgot, end_s, &mut ());
    let apart = |run: &Response| (run.left.state.theta[1] - whole.left.state.theta[1]).abs();
    // The tolerance of a run, beside what memory does.
    assert!(apart(&rest) < 1e-6 * whole.alpha_rad, "{}", apart(&rest));
    assert!(apart(&forgot) > 100.0 * apart(&rest).max(1e-9), "{} and {}", apart(&forgot), apart(&rest));
}
