//! From runs to medians: reads only the Parquet files of a study.

mod by_record;
mod medians;
mod moved;
mod outcomes;
mod quantile;
mod scan;
mod stored;
mod table;

pub use by_record::{ReferenceRun, reference_runs};
pub use medians::{Case, Measure, Median, Medians, Middle, Moved, VariantNote};
pub use moved::MOVED_SHARE;
pub use outcomes::{Ending, endings};
pub use quantile::{LEVELS, quantiles};
pub use scan::aggregate;
pub use stored::stored_numbers;
pub use table::{print_medians, write_medians};
