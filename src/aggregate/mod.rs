//! From runs to medians: reads only the Parquet files of a study.

mod by_record;
mod case_runs;
mod distributions;
mod drawn;
mod draws;
mod group;
mod medians;
mod moved;
mod quantile;
mod resampled;
mod sequences;
mod sequences_table;
mod stored;
mod sweep;
mod table;
mod two_way;
mod variants;

pub use by_record::{ReferenceRun, reference_runs};
pub use distributions::{Distribution, Distributions};
pub use drawn::{CAPACITY, distributions};
pub use draws::{DRAWS, Draws, FEWEST_RECORDS};
pub use medians::{Case, Measure, Median, Medians, Middle, Moved, VariantNote};
pub use moved::MOVED_SHARE;
pub use quantile::{LEVELS, median, quantiles};
pub use resampled::Interval;
pub use sequences::{After, RATIO_LEVELS, Sequences, sequences};
pub use sequences_table::SEQUENCES_TABLE;
pub use stored::{Answer, Compared, Ending, endings, stored_answers, stored_numbers};
pub use sweep::aggregate;
pub use table::{print_medians, write_medians};
