//! The spectrum as text: amplitude upwards, frequency to the right.

use super::spectrum::Spectrum;
use crate::text::aligned;

/// One line an amplitude, largest first, one mark a frequency: `#` overturned, `.` stood; then the boundaries.
pub fn picture(spectrum: &Spectrum) -> String {
    let mut amplitudes: Vec<f64> = spectrum.trials.iter().map(|t| t.amplitude_over_alpha_g).collect();
    amplitudes.sort_by(f64::total_cmp);
    amplitudes.dedup();
    let row = |amplitude: &f64| {
        let marks = spectrum.trials.iter().filter(|t| t.amplitude_over_alpha_g == *amplitude);
        let marks: String = marks.map(|t| if t.overturned { '#' } else { '.' }).collect();
        format!("{amplitude:>9.3}  {marks}\n")
    };
    let grid: String = amplitudes.iter().rev().map(row).collect();
    let ends = (spectrum.trials.first(), spectrum.trials.last());
    let axis = match ends {
        (Some(first), Some(last)) => {
            format!("ω/p from {} to {}", first.frequency_over_p, last.frequency_over_p)
        }
        _ => String::new(),
    };
    format!("amplitude over αg; # overturned, . stood\n{grid}{:>11}{axis}\n\n{}", "", boundaries(spectrum))
}

fn boundaries(spectrum: &Spectrum) -> String {
    let head = ["ω/p", "boundary over αg", "above it"].map(str::to_owned).to_vec();
    let rows = spectrum.boundaries.iter().map(|b| {
        let middle = 0.5 * (b.below_over_alpha_g + b.above_over_alpha_g);
        let above = if b.overturns_above { "overturns" } else { "stands" };
        vec![format!("{:.3}", b.frequency_over_p), format!("{middle:.4}"), above.to_owned()]
    });
    aligned(&std::iter::once(head).chain(rows).collect::<Vec<_>>()) + "\n"
}
