//! Twin experiments: known coefficients are found again from the rotations they gave.

use mrbd_kernel::model::ImpactLaw;
use mrbd_lab::calibrate::{Calibration, Estimate, Experiment, Identifiability, simulate};

use crate::calibrate_support::{TRUE, Twin, calibrated};

/// Largest relative error of the coefficients that act.
fn largest_error(calibration: &Calibration) -> f64 {
    let is_idle = |e: &Estimate| {
        matches!(e.identifiability, Identifiability::NeverActs | Identifiability::NothingToScale)
    };
    let acting = calibration.parameters.iter().zip(TRUE).filter(|(e, _)| !is_idle(e));
    acting.map(|(e, truth)| (e.value / truth - 1.0).abs()).fold(0.0, f64::max)
}

fn found_again(twin: &Twin, seed: u64) -> Calibration {
    let folder = tempfile::tempdir().expect("a temporary folder");
    calibrated(&twin.write(folder.path()), seed)
}

#[test]
fn analytic_twins_are_found_without_noise_from_several_seeds() {
    for (law, seed) in
        [ImpactLaw::Contact, ImpactLaw::Whole].iter().flat_map(|law| [1, 2, 3].map(|s| (*law, s)))
    {
        let mut twin = Twin::of(law);
        // The second joint search alone; the paper's and those beside it need as long again.
        twin.settings += "most_generations = 2\n";
        let calibration = found_again(&twin, seed);
        // Half a percent is the accuracy asked for.
        assert!(largest_error(&calibration) < 0.005, "{law:?}, seed {seed}: {:?}", calibration.joint);
        let told = calibration.parameters.iter().map(|e| e.identifiability).collect::<Vec<_>>();
        // 3a to 1b does not happen in these tests; impacts that end in sticking have nothing to scale under `contact`.
        assert_eq!(told[4], Identifiability::NeverActs);
        assert_eq!(calibration.joint.values[4], 1.0);
        if law == ImpactLaw::Contact {
            assert_eq!(told[6], Identifiability::NothingToScale);
            assert_eq!(calibration.joint.values[6], 1.0);
        }
    }
}

#[test]
fn analytic_three_tests_are_enough_without_noise() {
    for (law, seed) in [(ImpactLaw::Contact, 2), (ImpactLaw::Contact, 3), (ImpactLaw::Whole, 2)] {
        let mut twin = Twin { scales: vec![0.7, 0.9, 1.1], ..Twin::of(law) };
        twin.settings += "most_generations = 2\n";
        let calibration = found_again(&twin, seed);
        assert!(largest_error(&calibration) < 0.005, "{law:?}, seed {seed}: {:?}", calibration.joint);
    }
}

#[test]
fn analytic_twins_are_found_with_noise() {
    for law in [ImpactLaw::Contact, ImpactLaw::Whole] {
        let mut twin = Twin { noise: 0.01, ..Twin::of(law) };
        twin.settings += "most_generations = 30\n";
        let calibration = found_again(&twin, 1);
        // Three percent is the accuracy asked for with 1 % noise. Twins with noise of their own come within one
        // (`docs/calibration.md`).
        assert!(largest_error(&calibration) < 0.02, "{law:?}: {:?}", calibration.joint);
        // The noise alone: two channels, each |noise| ≈ 0.8 % of the peak over a mean rotation of 10 to 20 % of it.
        let wme = calibration.joint.mean_wme.expect("the runs finish");
        assert!((0.05..0.25).contains(&wme), "{wme}");
    }
}

#[test]
fn analytic_whole_twins_are_found_in_windows_that_end_before_collapse() {
    let mut twin = Twin::of(ImpactLaw::Whole);
    twin.test_lines = "windows_s = [[0.0, 3.4]]\n".into();
    twin.settings += "most_generations = 10\n";
    let calibration = found_again(&twin, 2);
    // Half a percent is the accuracy asked for.
    assert!(largest_error(&calibration) < 0.005, "{:?}", calibration.parameters);
}

#[test]
fn analytic_a_stiffness_is_found_like_a_coefficient_with_its_prior() {
    let mut twin = Twin::of(ImpactLaw::Contact);
    twin.scales = vec![0.7, 1.0];
    twin.settings += "most_generations = 10\nrefine_vectors = 1200\n\
                      parameters = [{ key = \"stiffness_n_per_m\", lower = 30e3, upper = 44e3 }, { key = \"C_6\" }]\n";
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = twin.write(folder.path());
    // Coefficients that are not calibrated are those of the wall file; here, the true ones.
    std::fs::copy(folder.path().join("true.toml"), folder.path().join("wall.toml")).expect("copied");
    let calibration = calibrated(&path, 1);
    let [stiffness, c_6] = [calibration.joint.values[0], calibration.joint.values[1]];
    // Half a percent is the accuracy asked for.
    assert!((stiffness / 37e3 - 1.0).abs() < 5e-3, "{stiffness}");
    assert!((c_6 / 0.76 - 1.0).abs() < 5e-3, "{c_6}");
}

/// Misfits of the true coefficients in a twin's first test, at capture velocities other than the twin's 1e-3 rad/s.
fn misfits_by_capture(law: ImpactLaw) -> [f64; 2] {
    let twin = Twin { scales: vec![0.7], test_lines: "windows_s = [[0.0, 2.6]]\n".into(), ..Twin::of(law) };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let experiment = Experiment::load(&twin.write(folder.path()), None).expect("a valid experiment");
    [1e-4, 1e-5].map(|velocity| {
        let space = experiment.space.under(law, velocity);
        let run = simulate(&space, &experiment.tests[0], &TRUE, experiment.accuracy());
        run.expect("a possible wall").wme.expect("a finished run")
    })
}

#[test]
fn regress_misfits_depend_on_the_capture_velocity_under_whole_and_hardly_under_contact() {
    let [contact, whole] = [ImpactLaw::Contact, ImpactLaw::Whole].map(misfits_by_capture);
    for k in 0..2 {
        // What a burst still holds below 1e-3 rad/s, of a motion of some 0.1 rad/s: about a percent.
        assert!(contact[k] < 0.02, "{contact:?}");
        assert!(whole[k] > 3.0 * contact[k], "{whole:?} and {contact:?}");
    }
}
