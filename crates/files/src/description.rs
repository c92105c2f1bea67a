//! What a wall file means: weights, slenderness, and what it takes for the wall to rock, before any run.

use serde::Serialize;

use crate::slips::{density_kg_m3, questions, top_period_s};
use mrbd_kernel::model::{FurtherLaw, G_M_S2, Wall};

/// A wall in the quantities by which an engineer checks it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Description {
    /// Thickness b, m.
    pub thickness_m: f64,
    /// Height h, m.
    pub height_m: f64,
    /// Length L of the strip, m.
    pub length_m: f64,
    /// Slenderness h/b.
    pub slenderness: f64,
    /// Mass of the whole wall m, kg.
    pub mass_kg: f64,
    /// Its weight, N.
    pub weight_n: f64,
    /// Density that mass and lengths imply, kg/m³.
    pub density_kg_m3: f64,
    /// Slenderness angle of the wall without its crack α = atan(b_1/h), rad.
    pub alpha_rad: f64,
    /// The lower body, or all of a wall without a crack.
    pub lower: Body,
    /// The body above the crack.
    pub upper: Option<Body>,
    /// Floor or roof.
    pub top: Top,
    /// Steady accelerations that open a joint of the wall at rest.
    pub opening: Opening,
    /// Further effects, as in the wall file.
    pub effects: Vec<FurtherLaw>,
    /// What few walls have and may be a slip.
    pub questions: Vec<String>,
}

/// One body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Body {
    /// Height h_i, m.
    pub height_m: f64,
    /// Mass m_i, kg.
    pub mass_kg: f64,
    /// Width b_i between the corners it rocks about, m.
    pub width_m: f64,
    /// What of the thickness is crushed, b - b_i, m.
    pub crushed_m: f64,
    /// Slenderness angle α_i = atan(b_i/h_i), rad.
    pub alpha_rad: f64,
}

/// What is at the top.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Top {
    /// Mass m_d that rests on the wall, kg.
    pub mass_kg: f64,
    /// Mass m_dp that only pushes, kg.
    pub carriage_mass_kg: f64,
    /// Stiffness k_d, N/m.
    pub stiffness_n_per_m: f64,
    /// Period of both masses on k_d, s; `None` for a top without mass or spring.
    pub period_s: Option<f64>,
}

/// Steady horizontal accelerations, in g, at which a joint of the wall at rest opens.
///
/// They are limits of equilibrium: the moment of the horizontal forces about the corner of a joint equals that of the
/// weights above it (the test |M_E| <= |M_I| of Eqs. 3 to 6). A spring without displacement has no force yet.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Opening {
    /// Opens the joint at the ground; tan α for a wall with a free top.
    pub ground_g: f64,
    /// Opens the crack.
    pub crack_g: Option<f64>,
}

impl Opening {
    /// The lower of the two: the wall begins to rock.
    pub fn first_g(&self) -> f64 {
        self.crack_g.map_or(self.ground_g, |crack_g| crack_g.min(self.ground_g))
    }
}

impl Description {
    /// Of a wall.
    pub fn of(wall: &Wall) -> Self {
        let p = wall.parameters();
        let h1_m = p.crack_height_m.unwrap_or(p.height_m);
        let body = |i: usize, height_m: f64| Body {
            height_m,
            mass_kg: p.mass_kg * height_m / p.height_m,
            width_m: wall.width_m()[i],
            crushed_m: p.thickness_m - wall.width_m()[i],
            alpha_rad: wall.alpha_i_rad()[i],
        };
        let upper = p.crack_height_m.map(|h1_m| body(1, p.height_m - h1_m));
        let whole = Body { height_m: p.height_m, mass_kg: p.mass_kg, ..body(0, h1_m) };
        let opening = Opening {
            ground_g: opening_g(wall, &whole),
            crack_g: upper.map(|upper| opening_g(wall, &upper)),
        };
        Self {
            thickness_m: p.thickness_m,
            height_m: p.height_m,
            length_m: p.length_m,
            slenderness: p.height_m / p.thickness_m,
            mass_kg: p.mass_kg,
            weight_n: p.mass_kg * G_M_S2,
            density_kg_m3: density_kg_m3(wall),
            alpha_rad: wall.alpha_rad(),
            lower: body(0, h1_m),
            upper,
            top: Top {
                mass_kg: p.diaphragm_mass_kg,
                carriage_mass_kg: p.carriage_mass_kg,
                stiffness_n_per_m: p.stiffness_n_per_m,
                period_s: top_period_s(wall),
            },
            opening,
            effects: p.further_laws(),
            questions: questions(wall),
        }
    }
}

/// Acceleration, in g, at which what stands above a joint turns about the joint's corner: the body, and the top masses.
fn opening_g(wall: &Wall, above: &Body) -> f64 {
    let p = wall.parameters();
    let half_m = above.width_m / 2.0;
    // Off the middle, the floor's load is nearer to one of the corners.
    let holding_kg_m = above.mass_kg * half_m + p.diaphragm_mass_kg * (half_m - p.eccentricity_m.abs());
    let top_kg = p.diaphragm_mass_kg + p.carriage_mass_kg;
    let turning_kg_m = above.mass_kg * above.height_m / 2.0 + top_kg * above.height_m;
    holding_kg_m / turning_kg_m
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::accelerogram::Accelerogram;
    use mrbd_kernel::model::WallParameters;
    use mrbd_kernel::simulate::{Accuracy, Shaking, simulate};

    fn made(parameters: WallParameters) -> Wall {
        Wall::new(parameters).expect("a wall")
    }

    /// How often the wall leaves rest under a steady acceleration that grows over ten seconds: slow beside any motion.
    fn openings(wall: &Wall, acceleration_g: f64) -> u64 {
        let samples = (0..=1000).map(|k| acceleration_g * G_M_S2 * f64::from(k) / 1000.0).collect();
        let horizontal = Some(Accelerogram::new(0.01, samples).expect("a record"));
        let shaking = Shaking { horizontal, vertical: None, tail_s: 0.0 };
        let openings = simulate(wall, &shaking, Accuracy::default()).openings;
        openings.rest_to_3 + openings.rest_to_4 + openings.rest_to_both
    }

    #[test]
    fn analytic_a_free_block_opens_at_the_tangent_of_its_slenderness_angle() {
        let block = Description::of(&made(WallParameters::strip(0.3, 3.0, 1800.0)));
        // Roundings of a handful of products.
        assert!((block.opening.ground_g - 0.1).abs() < 1e-15 && block.opening.crack_g.is_none());
        assert_eq!((block.slenderness, block.top.period_s), (10.0, None));
        assert!((block.density_kg_m3 - 1800.0).abs() < 1e-9);
    }

    #[test]
    fn analytic_the_model_at_rest_opens_where_the_description_says() {
        let cracked = WallParameters {
            crack_height_m: Some(2.191),
            lower_width_m: 0.271,
            upper_width_m: 0.281,
            diaphragm_mass_kg: 179.0,
            carriage_mass_kg: 663.0,
            stiffness_n_per_m: 37e3,
            eccentricity_m: 0.05,
            ..WallParameters::strip(0.291, 3.984, 2078.0)
        };
        let uncracked = WallParameters { crack_height_m: None, ..cracked.clone() };
        // Heavy enough above a light upper body that the crack opens first.
        let upper = WallParameters {
            crack_height_m: Some(0.5),
            lower_width_m: 0.291,
            upper_width_m: 0.2,
            ..cracked.clone()
        };
        for parameters in [cracked, uncracked, upper] {
            let wall = made(parameters);
            let first_g = Description::of(&wall).opening.first_g();
            assert_eq!([0.999, -0.999].map(|share| openings(&wall, share * first_g)), [0, 0], "{first_g} g");
            let opened = [1.001, -1.001].map(|share| openings(&wall, share * first_g));
            // With the load off the middle, one of the two directions opens at the lower acceleration.
            assert!(opened.iter().sum::<u64>() > 0, "{first_g} g");
        }
    }
}
