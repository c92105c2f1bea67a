//! A study: what was asked for becomes a list of runs, the runs are done, and every one is stored.
//!
//! | module | from | to |
//! | --- | --- | --- |
//! | [`pipeline`] | a file | what is asked for: variants, parameters, intensities |
//! | [`plan`] | a pipeline | a list of runs, computed one by one: façades, walls, records, ids |
//! | [`sequence`] | tables of a pipeline | records one after another, and the rows they make |
//! | [`batch`] | a plan | finished runs in order, on all threads; limits searched by growing intensities |
//! | [`cases`] | walls and motions as a caller has them | finished runs in order, on all threads; no plan, no folder |
//! | [`ladder`] | a limit | the lowest intensity found to exceed it |
//! | [`campaign`] | a plan and what is done of it | what is missing, in any parts, after any interruption |
//! | [`runs`] | finished runs | Parquet files of one row a run, and where they came from |

pub mod batch;
pub mod campaign;
pub mod cases;
mod chain;
pub mod ladder;
pub mod pipeline;
pub mod plan;
pub mod runs;
pub mod sequence;
mod shared;
mod study_table;
mod variance_table;
