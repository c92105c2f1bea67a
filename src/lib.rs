//! Multi-rocking-body dynamics of unreinforced masonry walls that may fall out of their plane.
//!
//! A façade cracked at mid-height rocks as two stacked rigid bodies, held at the top by a flexible floor. The model stands on
//! a page in [`mrbd_kernel`]; this package asks it of thousands of façades and records. It implements the paper "Vertical
//! spanning wall elastically restrained at the top: validation and parametric dynamic analysis"; equation, table and figure
//! numbers in this documentation are its.
//!
//! # The flow of data
//!
//! Below it, each of use alone:
//!
//! | crate | from | to |
//! | --- | --- | --- |
//! | [`mrbd_formula`] | text | laws of force with units, switches and a range |
//! | [`mrbd_kernel`] | a wall and a shaking | a response: maxima, patterns, energy, or a history |
//! | [`mrbd_files`] | files that people write | walls and coefficients that are valid, or what is wrong with them |
//! | [`mrbd_statistics`] | numbers | quantiles, correlations, the tails of the normal distribution |
//! | [`mrbd_records`] | record files | accelerograms, suites, spectra, intensity measures |
//! | [`mrbd_statics`] | a wall | what it bears, and how far it can be pushed |
//! | [`mrbd_assessment`] | a wall and a site | the code's check, the dynamics beside it, annual rates |
//! | [`mrbd_lab`] | measured tests | coefficients of impact, or the effect that the model lacks |
//!
//! The rooms of this package, each using only those above it:
//!
//! | room | from | to |
//! | --- | --- | --- |
//! | [`store`] | tables, histories | files that appear whole or not at all, and rows read back |
//! | [`survey`] | a survey | façades at its means, or drawn from it |
//! | [`study`] | a pipeline | a list of runs, the runs, and one stored row for each |
//! | [`aggregate`] | those rows alone | medians and quantiles over records, or over drawn façades |
//! | [`findings`] | medians | tables, and the paper's conclusions checked one by one |
//! | [`check`] | medians and accepted medians, runs and the same runs again | what moved, and what is ill-conditioned |
//! | [`sensitivity`] | studies | what their results depend on: suites, intensity measures, each uncertain input |
//! | [`fragility`] | tables of outcomes | the probability of failure by intensity, with intervals |
//! | [`assessment`] | a wall or a survey, a site, a suite | the code's check beside the dynamics, margins, pushes, annual rates |
//! | [`classics`] | a wall, and what others published | their studies again: the models of Fig. 9, overturning spectra |
//! | [`results`] | a run, what the laboratory found | JSON, result folders |
//! | [`summary`] | result folders | what a page shows, computed before anything is drawn |
//! | [`report`] | summaries, runs | pages and pictures |
//! | [`cli`] | the command line | the above, files to begin with, and messages for people |
//!
//! # A study without its files
//!
//! ```
//! use mrbd::study::batch::{SideBySide, run_one};
//! use mrbd::study::{pipeline::Pipeline, plan::Plan};
//!
//! let pipeline = Pipeline::load("pipelines/check.toml".as_ref())?;
//! let plan = Plan::load(&pipeline, None)?;
//! assert_eq!(plan.len(), 6300);
//! let finished = run_one(plan.run(0), &SideBySide);
//! println!("{}: {}", finished.run.record().name, finished.outcome());
//! # Ok::<(), mrbd::Error>(())
//! ```

pub mod aggregate;
pub mod assessment;
pub mod check;
pub mod classics;
pub mod cli;
pub mod error;
pub mod findings;
pub mod fragility;
pub mod report;
pub mod results;
pub mod sensitivity;
pub mod store;
pub mod study;
pub mod summary;
pub mod survey;
pub mod text;

pub use error::{Error, InputError, Result};
