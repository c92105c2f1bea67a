use mrbd_kernel::model::{Effect, Wall, WallParameters};
use mrbd_kernel::simulate::{Accuracy, Shaking, simulate};
use mrbd_kernel::accelerogram::Accelerogram;

fn wall(effects: &[Effect], initial: [f64; 2], cracked: bool) -> Wall {
    let strip = WallParameters::strip(0.291, 3.984, 1800.0);
    Wall::new(WallParameters {
        crack_height_m: cracked.then_some(2.191),
        length_m: 1.5,
        mass_kg: 3614.0,
        diaphragm_mass_kg: if cracked { 179.0 } else { 0.0 },
        carriage_mass_kg: if cracked { 663.0 } else { 0.0 },
        stiffness_n_per_m: if cracked { 37e3 } else { 0.0 },
        initial_rotation_rad: initial,
        effects: effects.to_vec(),
        restitution: mrbd_kernel::model::Restitution { law: mrbd_kernel::model::ImpactLaw::Contact, ..Default::default() },
        ..strip
    }).expect("a wall")
}
#[test]
fn explore() {
    for (cracked, initial) in [(false, [0.03, 0.03]), (true, [0.02, -0.015]), (true, [0.02, 0.03])] {
        let free = Shaking { tail_s: 2.0, ..Shaking::default() };
        let acc = Accuracy { tolerance: 1e-10 };
        let sharp = simulate(&wall(&[], initial, cracked), &free, acc);
        println!("sharp top {:?} th {:?} impacts {} resid {:.1e} loss {:.3} E0 {:.3}", sharp.top_displacement_m.value, sharp.theta_max_rad.map(|p| p.value), sharp.impacts.total(), sharp.energy.residual(), sharp.energy.impact_loss_j, sharp.energy.initial_j);
        for k in [1e8, 1e9, 1e10, 1e11, 1e12] {
            let bed = Effect::with_parameters(if cracked {"compliant_joint.both"} else {"compliant_joint.ground"}, &[k, 0.0]).unwrap();
            let t = std::time::Instant::now();
            let r = simulate(&wall(&[bed], initial, cracked), &free, acc);
            println!("{k:e} {:?} th {:?} end {:.3} impacts {} opens {} resid {:.1e} loss {:.4} final {:.4} steps {} rej {} {:?}", r.outcome, r.theta_max_rad.map(|p| p.value), r.end_time_s, r.impacts.total(), r.openings.total(), r.energy.residual(), r.energy.impact_loss_j, r.energy.final_j, r.work.steps, r.work.rejected_steps, t.elapsed());
        }
    }
    let a = |t: f64| 1.2 * ((9.0 * t).sin() + (23.0 * t).sin());
    let samples = (0..300).map(|k| a(0.01 * f64::from(k))).collect();
    let sh = Shaking { horizontal: Some(Accelerogram::new(0.01, samples).expect("a record")), vertical: None, tail_s: 1.0 };
    let acc = Accuracy { tolerance: 1e-8 };
    let r = simulate(&wall(&[], [0.0;2], true), &sh, acc);
    println!("sharp th {:?} impacts {} loss {}", r.theta_max_rad.map(|p| p.value), r.impacts.total(), r.energy.impact_loss_j);
    for joint in ["ground", "crack", "both"] { for k in [1e8, 1e9, 1e10, 1e11, 1e12] {
        let bed = Effect::with_parameters(&format!("compliant_joint.{joint}"), &[k, 0.0]).unwrap();
        let r = simulate(&wall(&[bed], [0.0;2], true), &sh, acc);
        println!("{joint} {k:e} {:?} th {:?} impacts {} opens {} resid {:.1e} loss {:.4} final {:.4} steps {} rej {}", r.outcome, r.theta_max_rad.map(|p| p.value), r.impacts.total(), r.openings.total(), r.energy.residual(), r.energy.impact_loss_j, r.energy.final_j, r.work.steps, r.work.rejected_steps);
    }}
}
