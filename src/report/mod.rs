//! Pictures: a page for a folder of results, and a picture of one run.
//!
//! A page is one HTML file that needs nothing else: figures as SVG, its style and a small script inside. Whatever can
//! be read without the script is there without it; the script adds values under the pointer, curves chosen from the
//! legend and the moving wall. A page depends on the results alone: equal results give equal bytes.
//!
//! | module | what |
//! | --- | --- |
//! | `folder` | which kind of results a folder holds, and its page |
//! | `sweep` | the paper's figures 12 and 14 to 20 from the medians and runs of a sweep |
//! | `run` | one run: histories, and the wall in motion |
//! | `curves`, `lines`, `svg`, `colours` | panels of curves, drawn by plotters |
//! | `page` | sections, figures and tables made into HTML |

mod colours;
mod curves;
mod folder;
mod lines;
mod page;
mod provenance;
mod run;
mod svg;
mod sweep;
mod words;

pub use folder::{PAGE_NAME, report};
pub use run::{ImpactMark, PlotFile, RunPicture, Watch};
