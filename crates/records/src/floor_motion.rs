//! A record brought to a floor: what the ground's motion becomes at the height of a wall in a building.

use super::spectrum::Recursion;
use super::{Building, IntensityMeasures, Mode, Suite, SuiteRecord};
use mrbd_kernel::accelerogram::{Accelerogram, InvalidAccelerogram};

/// Samples in the shortest period: between them the motion is taken as linear, as a record is.
const SAMPLES_IN_PERIOD: f64 = 20.0;
/// Share of a mode's motion that is left when the record of a floor ends.
const LEFT: f64 = 0.01;

/// The absolute acceleration of a floor, m/s²: ẍ_g + Σ γ_k ψ_k ü_k, each u_k by the exact solution of Nigam and Jennings.
///
/// `participation` of a [`Mode`] is γ_k ψ_k. What the modes leave of 1 moves with the ground. Steps are those of the
/// record, or a whole share of them where a period is shorter than twenty; free motion is added until 1 % is left.
///
/// # Errors
/// [`InvalidAccelerogram`] for samples that are not finite, which finite records do not give.
pub fn floor_motion(
    record: &Accelerogram,
    modes: &[Mode],
    damping: f64,
) -> Result<Accelerogram, InvalidAccelerogram> {
    let shortest_s = modes.iter().map(|mode| mode.period_s).fold(f64::INFINITY, f64::min);
    let longest_s = modes.iter().map(|mode| mode.period_s).fold(0.0, f64::max);
    let parts = (record.step_s() * SAMPLES_IN_PERIOD / shortest_s).ceil().max(1.0);
    let step_s = record.step_s() / parts;
    let tail_s = longest_s * (1.0 / LEFT).ln() / (std::f64::consts::TAU * damping);
    let ground = resampled(record, parts as usize, (tail_s / step_s).ceil() as usize);
    let still: f64 = modes.iter().map(|mode| mode.participation).sum();
    let mut floor: Vec<f64> = ground.iter().map(|a| (1.0 - still) * a).collect();
    for mode in modes {
        for (sum, a) in floor.iter_mut().zip(absolute_m_s2(&ground, step_s, mode.period_s, damping)) {
            *sum += mode.participation * a;
        }
    }
    Accelerogram::new(step_s, floor)
}

impl Suite {
    /// The suite on a floor of a building: horizontal motions by [`floor_motion`] with their measures, vertical ones as they
    /// are, at the same step. Names stay.
    ///
    /// # Errors
    /// As [`floor_motion`].
    pub fn on_floor(self, building: &Building) -> Result<Self, InvalidAccelerogram> {
        let modes = building.all_modes();
        let on_floor = |record: SuiteRecord| {
            let horizontal = floor_motion(&record.horizontal, &modes, building.damping)?;
            let parts = (record.horizontal.step_s() / horizontal.step_s()).round() as usize;
            let finer = |up: &Accelerogram| Accelerogram::new(horizontal.step_s(), resampled(up, parts, 0));
            let vertical = record.vertical.as_ref().map(finer).transpose()?;
            Ok(SuiteRecord { intensity: IntensityMeasures::of(&horizontal), horizontal, vertical, ..record })
        };
        let records = self.records.into_iter().map(on_floor).collect::<Result<_, _>>()?;
        Ok(Self { records, ..self })
    }
}

/// Samples between which there are so many parts, and zeros after them.
fn resampled(record: &Accelerogram, parts: usize, zeros: usize) -> Vec<f64> {
    let samples = record.acceleration_m_s2();
    let between = samples.windows(2).flat_map(|pair| {
        let slope = (pair[1] - pair[0]) / parts as f64;
        (0..parts).map(move |part| pair[0] + slope * part as f64)
    });
    let last = samples.last().copied();
    between.chain(last).chain(std::iter::repeat_n(0.0, zeros)).collect()
}

/// Absolute acceleration of an oscillator on the ground, -2ξω u̇ - ω² u, m/s².
fn absolute_m_s2(ground: &[f64], step_s: f64, period_s: f64, damping: f64) -> Vec<f64> {
    let omega = std::f64::consts::TAU / period_s;
    let recursion = Recursion::new(omega, damping, step_s);
    let mut state = [0.0; 2];
    let mut all = vec![0.0];
    for pair in ground.windows(2) {
        state = recursion.advance(state, pair[0], pair[1]);
        all.push(-2.0 * damping * omega * state[1] - omega * omega * state[0]);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CODE_DAMPING, spectral_acceleration_m_s2};

    fn sine(period_s: f64, cycles: u32) -> Accelerogram {
        let samples =
            (0..=100 * cycles).map(|i| (std::f64::consts::TAU * f64::from(i) / 100.0).sin()).collect();
        Accelerogram::new(period_s / 100.0, samples).expect("samples")
    }

    #[test]
    fn analytic_a_floor_that_does_not_move_with_the_building_has_the_ground_s_motion() {
        let record = sine(0.5, 3);
        let floor =
            floor_motion(&record, &[Mode { period_s: 0.3, participation: 0.0 }], 0.05).expect("a motion");
        let ground = record.acceleration_m_s2();
        assert_eq!(&floor.acceleration_m_s2()[..ground.len()], ground);
        assert!(floor.acceleration_m_s2()[ground.len()..].iter().all(|a| *a == 0.0));
    }

    #[test]
    fn analytic_the_vertical_component_comes_to_the_floor_as_it_is_at_the_step_of_the_other() {
        let (horizontal, vertical) = (sine(0.5, 3), sine(0.25, 6));
        let vertical =
            Accelerogram::new(horizontal.step_s(), vertical.acceleration_m_s2().to_vec()).expect("samples");
        let record = SuiteRecord {
            id: 1,
            name: "sine".into(),
            event: String::new(),
            scale: 1.0,
            intensity: IntensityMeasures::of(&horizontal),
            horizontal: horizontal.clone(),
            vertical: Some(vertical.clone()),
            vertical_scale: 1.0,
            generated: true,
            about: crate::About::default(),
        };
        let suite = Suite {
            name: "one".into(),
            generated: true,
            note: String::new(),
            source: String::new(),
            records: vec![record],
        };
        // A mode so short that the step has to be divided.
        let building =
            Building { height_ratio: 1.0, period_s: 0.06, storeys: 2, damping: 0.05, modes: Vec::new() };
        let floor = suite.on_floor(&building).expect("motions").records.remove(0);
        let [across, up] = [floor.horizontal, floor.vertical.expect("a vertical component")];
        let parts = (horizontal.step_s() / across.step_s()).round() as usize;
        assert!(parts > 1 && up.step_s() == across.step_s());
        for (sample, expected) in vertical.acceleration_m_s2().iter().enumerate() {
            let found = up.acceleration_m_s2()[sample * parts];
            assert!((found - expected).abs() < 1e-15, "the samples that were there stay: {found} {expected}");
        }
        assert_eq!(up.peak_m_s2(), vertical.peak_m_s2(), "and straight lines lie between them");
    }

    #[test]
    fn analytic_a_stiff_building_takes_the_ground_s_motion_to_its_top() {
        let record = sine(1.0, 5);
        let floor =
            floor_motion(&record, &[Mode { period_s: 0.05, participation: 1.0 }], 0.05).expect("a motion");
        // Quasi-static: what differs is (T_1/T)² of the ground's, and its own free motion from the start.
        assert!((floor.peak_m_s2() - 1.0).abs() < 0.02, "{}", floor.peak_m_s2());
    }

    #[test]
    fn analytic_resonance_grows_to_the_dynamic_amplification() {
        // Steady state at resonance: √(1 + 4ξ²)/(2ξ) of the ground; 60 cycles leave exp(-2π 60 ξ) of the start.
        let record = sine(0.4, 60);
        let floor =
            floor_motion(&record, &[Mode { period_s: 0.4, participation: 1.0 }], 0.05).expect("a motion");
        let steady = (1.0_f64 + 0.01).sqrt() / 0.1;
        // A hundred samples a cycle miss a peak by 1 - cos(π/100) = 5e-4 at most.
        assert!((floor.peak_m_s2() / steady - 1.0).abs() < 1e-3, "{}", floor.peak_m_s2());
    }

    #[test]
    fn analytic_what_is_in_tune_with_a_floor_is_shaken_several_times_as_much_as_the_floor() {
        // Which reading of the commentary's amplification 1.1 ξ_k^-0.5 is meant: 4.9 of relative damping, 0.5 in percent.
        let path =
            std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../inputs/records/emilia7/suite.toml");
        let suite = crate::Suite::load(&path).expect("the suite");
        let ratio = |record: &crate::SuiteRecord| {
            let floor = floor_motion(&record.horizontal, &[Mode { period_s: 0.3, participation: 1.0 }], 0.05)
                .expect("a motion");
            spectral_acceleration_m_s2(&floor, 0.3, CODE_DAMPING) / floor.peak_m_s2()
        };
        let mean = suite.records.iter().map(ratio).sum::<f64>() / suite.records.len() as f64;
        assert!((3.0..7.0).contains(&mean), "{mean}");
    }
}
