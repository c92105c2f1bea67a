//! How the distributions of drawn façades meet the levels of the paper's Table 3.

use std::path::Path;

use mrbd::survey::Survey;
use mrbd::survey::sampling::{Marginal, Truncation};

use super::ROOT;
use super::block::{Page, row};

pub fn blocks(page: &mut Page) {
    let survey = Survey::load(&Path::new(ROOT).join("inputs/survey.toml")).expect("the shipped survey");
    let (wall, perpendicular, parallel) = (&survey.wall, &survey.perpendicular, &survey.parallel);
    let variables = [
        ("b", wall.thickness_m),
        ("h/b", wall.slenderness),
        ("h₁/h", wall.crack_height_ratio),
        ("f", wall.compressive_strength_pa),
        ("k_d, perpendicular", perpendicular.stiffness_n_per_m),
        ("m_d/m_tot, perpendicular", perpendicular.diaphragm_mass_ratio),
        ("k_d, parallel", parallel.stiffness_n_per_m),
        ("m_d/m_tot, parallel", parallel.diaphragm_mass_ratio),
        ("m_dp/m_tot, parallel", parallel.carriage_mass_ratio),
    ];
    let lines = variables.map(|(name, levels)| {
        let (beta, misses) = misses(levels);
        row(&[name.to_owned(), format!("{beta:.2}"), format!("{:+.0} %", 100.0 * misses)])
    });
    let head =
        row(&["variable", "β", "how far μ e^−β and μ e^β lie off the levels of Table 3"]) + &row(&["---"; 3]);
    page.put_lines("levels of Table 3", &(head + &lines.concat()));
}

/// β, and the share by which both μ e^−β and μ e^β miss the levels.
fn misses(levels: [f64; 3]) -> (f64, f64) {
    let marginal = Marginal::from_levels("levels", levels, Truncation::default()).expect("levels in order");
    let Marginal::LogNormal { ln_median, beta, .. } = marginal else {
        panic!("three different levels");
    };
    let [low, high] = [levels[0].min(levels[2]), levels[0].max(levels[2])];
    let [below, above] = [(ln_median - beta).exp() / low - 1.0, (ln_median + beta).exp() / high - 1.0];
    // β is half the distance of the levels in the logarithm: what one misses the other does, to rounding.
    assert!((below - above).abs() < 1e-12, "{below} {above}");
    (beta, below)
}

#[test]
fn published_the_widest_misses_of_table_3() {
    // By hand: β = ½ ln 8 and ½ ln 3.5; μ/√(lower upper) = 1200/1414.2 and 0.03/0.037417.
    let (beta, stiffness) = misses([500e3, 1200e3, 4000e3]);
    assert!((beta - 1.0397).abs() < 5e-5 && (stiffness + 0.1515).abs() < 5e-5, "{beta} {stiffness}");
    let (beta, mass) = misses([0.02, 0.03, 0.07]);
    assert!((beta - 0.6264).abs() < 5e-5 && (mass + 0.1982).abs() < 5e-5, "{beta} {mass}");
}
