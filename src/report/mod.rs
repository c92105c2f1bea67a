//! Pictures: a page for a folder of results, and a picture of one run.
//!
//! A page is one HTML file that needs nothing else: figures as SVG, its style and a small script inside. Whatever can
//! be read without the script is there without it; the script adds values under the pointer, curves chosen from the
//! legend and the moving wall. A page depends on the results alone: equal results give equal bytes.
//!
//! | module | what |
//! | --- | --- |
//! | `sweep` | the paper's figures 12 and 14 to 20 from the medians and runs of a sweep |
//! | `run` | one run: histories, and the wall in motion |
//! | `drawn` | drawn façades: fragilities with intervals and data, quantiles, draws against the survey |
//! | `sequences` | what records do after others |
//! | `history` | a history file |
//! | `calibration` | measured against simulated, intervals, convergence (Figs. 6 to 8) |
//! | `diagnosis` | where model and tests part, the missing force, candidates and rivals, before and after |
//! | `comparison` | three models of a wall under the same records (Fig. 9) |
//! | `assessment` | the code's check of a mechanism beside the dynamics: the sheet to hand in |
//! | `portfolio` | a survey's façades: ζ static beside ζ dynamic |
//! | `push` | force against displacement of a slow push |
//! | `overturning` | which pulses overturn a wall |
//! | `suites` | sweeps under several suites: conclusions, how many records decide them, quartiles |
//! | `measures` | which intensity measure foretells the response |
//! | `variance` | which share of the variance each input has |
//! | `margin` | the factor on each record that takes a wall beyond a limit |
//!
//! To make another page: say in `summary` what a folder of its kind holds, and fill a `Page` with sections here.
//! Nothing is computed here but places and texts.
//!
//! | block | what |
//! | --- | --- |
//! | `page` | `Page`, `Section`, `Figure` (panels under a legend, caption, links), `Table`, `Number`, made into HTML |
//! | `chart` | `Graph`, `Stack`: layers over linear, logarithmic or named axes, as SVG or PNG |
//! | `rotations` | curves of largest rotations, collapses in a zone above the axis |
//! | `provenance` | the manifest as names and values, files, sentences on what is generated or assumed |
//! | `words` | names as people read them |

mod assessment;
mod calibration;
mod chart;
mod comparison;
mod diagnosis;
mod drawn;
mod history;
mod margin;
mod measures;
mod overturning;
mod page;
mod portfolio;
mod provenance;
mod push;
mod rotations;
mod run;
mod sequences;
mod suites;
mod sweep;
mod variance;
mod wall;
mod words;

pub use diagnosis::{number, numbers_of, round_exponents};
pub use push::push_svg;
pub use run::{ImpactMark, PlotFile, RunPicture, Watch};
pub use wall::wall_svg;

use crate::error::Result;
use crate::summary::{Summary, as_damage};

/// The page of results as HTML.
///
/// # Errors
/// Input errors for damaged tables of results that are drawn as they are stored; [`crate::Error::Picture`] if the
/// template refuses.
pub fn html(summary: &Summary) -> Result<String> {
    let page = match summary {
        Summary::Sweep(sweep) => Ok(sweep::page(sweep)),
        Summary::Drawn(drawn) => Ok(drawn::page(drawn)),
        Summary::Sequences(after) => Ok(sequences::page(after)),
        Summary::Calibration(calibrated) => Ok(calibration::page(calibrated)),
        Summary::Diagnosis(folder) => diagnosis::page(folder),
        Summary::Comparison(folder) => comparison::page(folder),
        Summary::Suites(folder) => suites::page(folder),
        Summary::Measures(folder) => measures::page(folder),
        Summary::Variance(folder) => variance::page(folder),
        Summary::Margin(folder) => margin::page(folder),
        Summary::Push(folder) => push::page(folder),
        Summary::Portfolio(folder) => portfolio::page(folder),
        Summary::Assessment(folder) => assessment::page(folder),
        Summary::Overturning(folder) => overturning::page(folder),
        Summary::History(file) => history::page(file),
    };
    page.map_err(as_damage)?.html()
}
