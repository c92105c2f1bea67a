//! Multi-rocking-body dynamics of unreinforced masonry walls that may fall out of their plane.
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
//! Each joint is closed, or open about one of its two corners: nine contact states, rest and the paper's patterns
//! 1a to 4b ([`model::Contact`]). In each the wall obeys Jᵀ M (J θ'' + centripetal + ground) = Jᵀ F. A closed joint opens
//! when the force at one of its corners reaches zero ([`model::RockingWall::settle`]); an open joint closes in a plastic
//! impact that conserves angular momentum about the corners that stay in contact, scaled by the coefficient C_l of the
//! change of pattern ([`model::RockingWall::impact`]).
//!
//! The paper is "Vertical spanning wall elastically restrained at the top: validation and parametric dynamic analysis";
//! equation, table and figure numbers in this documentation are its.
//!
//! # The flow of data
//!
//! | module | from | to |
//! | --- | --- | --- |
//! | [`input`] | TOML files | walls, surveys, campaigns that are valid |
//! | [`ground`] | record files | accelerograms, suites, intensity measures |
//! | [`model`] | a wall | motion, openings, impacts |
//! | [`solver`] | accelerations | steps and where inside a step an event lies; knows no masonry |
//! | [`simulate`] | a wall and a shaking | a response: maxima, patterns, energy, or a history |
//! | [`sampling`] | a survey | façades of a Monte Carlo campaign, drawn one by one |
//! | [`plan`] | a pipeline: a sweep or drawn façades | a list of runs, computed one by one: façades, walls, records, ids |
//! | [`batch`] | a plan | finished runs in order, on all threads; limits searched by growing intensities |
//! | [`campaign`] | a plan and what is done of it | what is missing, in any parts, after any interruption |
//! | [`store`] | responses | files that appear whole or not at all |
//! | [`aggregate`] | those files alone | medians and quantiles over the records, or over drawn façades |
//! | [`findings`] | medians | tables, and the paper's conclusions checked one by one |
//! | [`check`] | medians and accepted medians, runs and the same runs again | what moved, and what is ill-conditioned |
//! | [`fragility`] | tables of outcomes | the probability of failure by intensity, with intervals |
//! | [`calibrate`] | shaking-table tests | coefficients of impact, and what the tests can tell of them |
//! | [`diagnose`] | a wall and tests that it does not follow | the effect that the model lacks |
//! | [`comparison`] | one wall as three models | which rotates most under the same records (Fig. 9) |
//! | [`overturning`] | a wall and a shape of pulse | the amplitudes and frequencies that overturn it |
//! | [`report`] | result folders, runs | pages and pictures |
//! | [`starter`] | nothing | a wall, a pipeline and an experiment to begin with |
//! | [`cli`] | the command line | the above, and messages for people |

pub mod aggregate;
pub mod check;
pub mod classics;
pub mod cli;
pub mod error;
pub mod findings;
pub mod fragility;
pub mod report;
pub mod results;
pub mod starter;
pub mod store;
pub mod study;
pub mod survey;

pub use error::{Error, InputError, Result};
