//! The kernel: a masonry wall of two rocking bodies under a ground motion.
//!
//! # The model on a page
//!
//! A façade cracked at mid-height rocks as two stacked rigid bodies, held at the top by a flexible floor.
//!
//! ```text
//!              C  ── k_d ──▏   m_d (x and y), m_dp (x only)
//!            ┌───┐
//!            │ 2 │  h_2, m_2, I_2      θ_2
//!   crack  ──┴───┴──  b_2
//!            │ 1 │  h_1, m_1, I_1      θ_1      θ > 0: the top moves towards +x
//!   ground ──┴───┴──  b_1
//! ```
//!
//! | symbol | meaning | unit |
//! | --- | --- | --- |
//! | b, h, h_1, h_2, L | thickness, total height, heights of the bodies, length of the strip | m |
//! | b_1, b_2 | widths between the rocking corners at the ground and at the crack | m |
//! | m_1, m_2, I_1, I_2 | masses and polar moments about the centres of mass | kg, kg m² |
//! | m_d, m_dp | masses at the top C: in both directions, and in x only (the carriage) | kg |
//! | k_d | horizontal spring at C, relative to the ground | N/m |
//! | α_i = atan(b_i / h_i) | slenderness angles | rad |
//! | s_1, s_2 | joint at the ground, at the crack: closed (0) or turning about its left (-1) or right (+1) corner | |
//!
//! Each joint is closed, or open about one of its two corners. That makes nine contact states: rest and the
//! paper's patterns 1a to 4b ([`model::Contact`]). In each the wall obeys Jᵀ M (J θ'' + centripetal + ground)
//! = Jᵀ F. A closed joint opens when the force at one of its corners reaches zero
//! ([`model::RockingWall::next_contact`]). An open joint closes in a plastic impact
//! ([`model::RockingWall::impact`]). It conserves angular momentum about the corners that stay in contact.
//! The coefficient C_l of the change of pattern scales what comes out.
//!
//! The paper is "Vertical spanning wall elastically restrained at the top: validation and parametric dynamic
//! analysis". Equation, table and figure numbers in this documentation are its.
//!
//! # The flow of a run
//!
//! | module | from | to |
//! | --- | --- | --- |
//! | [`accelerogram`] | samples | a ground acceleration that is valid |
//! | [`model`] | a wall and its effects | motion, openings, impacts |
//! | [`solver`] | accelerations | steps and where inside a step an event lies; knows no masonry |
//! | [`simulate`] | a wall and a shaking | a response: maxima, patterns, energy, or a history |
//!
//! From a wall and a record to its largest rotations:
//!
//! ```
//! use mrbd_kernel::accelerogram::Accelerogram;
//! use mrbd_kernel::model::{Wall, WallParameters};
//! use mrbd_kernel::simulate::{Accuracy, Shaking, simulate};
//!
//! let strip = WallParameters::strip(0.3, 4.0, 1800.0);
//! let wall = Wall::new(WallParameters { crack_height_m: Some(2.2), stiffness_n_per_m: 40e3, ..strip })?;
//! let step_s = 0.005;
//! let pulse = (0..200).map(|k| 3.0 * (2.0 * std::f64::consts::PI * k as f64 * step_s).sin()).collect();
//! let shaking = Shaking { horizontal: Some(Accelerogram::new(step_s, pulse)?), vertical: None, tail_s: 5.0 };
//! let response = simulate(&wall, &shaking, Accuracy::default());
//! let [lower, upper] = response.theta_max_rad;
//! assert!(lower.value.abs() > 0.0, "the wall rocks");
//! println!("θ_1 {:.4} rad, θ_2 {:.4} rad", lower.value, upper.value);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod accelerogram;
mod fused;
mod instructions;
mod lanes;
pub mod model;
pub mod simulate;
pub mod solver;
mod written;

pub use written::written;
