//! Small studies of drawn façades, and a simulator whose walls fall at a peak acceleration that is known.

use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{Accuracy, Outcome, Response, Shaking};

use crate::pipeline_support::response;

/// A study of 6 façades in both configurations; `kind` and its table go in front.
const DRAWN: &str = r#"
name = "drawn"
survey = "survey.toml"
coefficients = "coefficients.toml"
suite = "suite.toml"

[sampling]
count = 6
seed = 3
design = "latin_hypercube"

[[variants]]
name = "base"
"#;

pub fn drawn(kind: &str, table: &str) -> String {
    format!("kind = {kind:?}\n{}\n{table}", DRAWN.trim_start())
}

pub fn monte_carlo() -> String {
    drawn("monte_carlo", "")
}

pub fn stripes() -> String {
    drawn("stripes", "[stripes]\nmeasure = \"pga_m_s2\"\nlevels = [1.0, 4.0, 9.0]\n")
}

/// Limits of collapse and of θ/α = 0.5 from 0.5 m/s² by half as much again to 60 m/s², bracketed to 2 %.
pub fn incremental() -> String {
    drawn(
        "incremental",
        "[incremental]\nlimits = [\"collapse\", 0.5]\nmeasure = \"pga_m_s2\"\nfrom = 0.5\nto = 60.0\ngrowth = 1.5\n\
         bracket = 1.02\n",
    )
}

/// The peak acceleration above which a wall falls here, m/s²: slender walls sooner.
pub fn capacity_m_s2(wall: &Wall) -> f64 {
    200.0 * wall.alpha_rad()
}

/// Rotates in proportion to the peak acceleration over the capacity, and falls where it reaches 1.
pub fn proportional(wall: &Wall, shaking: &Shaking, _: Accuracy) -> Response {
    let peak = shaking.horizontal.as_ref().expect("a record").peak_m_s2();
    match peak / capacity_m_s2(wall) {
        beyond if beyond >= 1.0 => response(wall, 2.0, Outcome::Collapsed { time_s: 0.3 }),
        // The upper body's ratio is twice this.
        share => response(wall, 0.4 * share, Outcome::Stood),
    }
}
