//! `mrbd records select`: suites that fit the spectrum of a site.

use std::path::PathBuf;

use clap::Args;

use super::check::PeriodArgs;
use super::{ReadArgs, print_table, written};
use crate::error::{InputError, Result};
use crate::text::signed_percent;
use mrbd_records::{Criteria, Selection, Site, SuiteSource, select};

/// Select suites whose mean spectrum fits the code spectrum of a site, as REXEL does.
///
/// Records are scaled by the mean logarithm of code over spectrum, within bounds; all combinations of the candidates
/// closest in shape are tried. The best suites are listed; with --out the best one is written.
///
/// Examples:
///   mrbd records select folder --dt 0.005 --site inputs/site_mirandola.toml --out selected/suite.toml
///   mrbd records select all/suite.toml --site site.toml --count 7 --most-of-event 2 --scale-to 3
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct SelectArgs {
    /// Folder of records, or a suite file, which can name events.
    from_records: PathBuf,
    /// Site file.
    #[arg(long, value_name = "FILE")]
    site: PathBuf,
    /// Records in a suite.
    #[arg(long, default_value_t = 7)]
    count: usize,
    /// Smallest scale factor.
    #[arg(long, value_name = "X", default_value_t = 0.5)]
    scale_from: f64,
    /// Largest scale factor.
    #[arg(long, value_name = "X", default_value_t = 3.0)]
    scale_to: f64,
    /// Most records of one event.
    #[arg(long, value_name = "N", default_value_t = 2)]
    most_of_event: usize,
    /// In a folder, the first N characters of a file name identify the event; 0: every file is of its own.
    #[arg(long, value_name = "N", default_value_t = 0)]
    event_prefix: usize,
    /// Candidates that are combined; time grows with the number of combinations.
    #[arg(long, value_name = "N", default_value_t = 30)]
    candidates: usize,
    /// Suites to list.
    #[arg(long, value_name = "N", default_value_t = 5)]
    best: usize,
    /// Name of the suite that is written.
    #[arg(long, value_name = "NAME", default_value = "selected")]
    name: String,
    /// Suite file to write; an existing one is not touched.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    band: PeriodArgs,
    #[command(flatten)]
    read: ReadArgs,
}

pub(super) fn execute(args: &SelectArgs) -> Result<()> {
    let criteria = criteria(args)?;
    if let Some(out) = args.out.as_ref().filter(|out| out.exists()) {
        let found = format!("{}, which exists", out.display());
        return Err(InputError::option("--out", found, "a file that does not exist yet").into());
    }
    let site = Site::load(&args.site)?;
    let source = SuiteSource::open(&args.from_records, &args.read.options(), args.event_prefix)?;
    let suite = source.load()?;
    let found = select(&suite.records, &site, &criteria);
    let Some(best) = found.first() else {
        let among = format!("no suite of {} among {} records", criteria.count, suite.records.len());
        return Err(InputError::file(&args.from_records, among, "wider bounds, or more records").into());
    };
    let name = |&member: &usize| suite.records[member].name.as_str();
    let row = |selection: &Selection| {
        let members: Vec<&str> = selection.members.iter().map(name).collect();
        let (low, high) =
            (signed_percent(selection.lowest_deviation), signed_percent(selection.highest_deviation));
        vec![members.join(" "), format!("{:.4}", selection.deviation_rms), low, high]
    };
    let rows: Vec<Vec<String>> = found.iter().map(row).collect();
    print_table(&["records", "rms", "lowest", "highest"], &rows)?;
    if let Some(out) = &args.out {
        let note =
            format!("mrbd records select: rms deviation {:.4} from the code spectrum", best.deviation_rms);
        written("--out", source.write_selection(best, &args.name, &note, out))?;
    }
    Ok(())
}

fn criteria(args: &SelectArgs) -> Result<Criteria, InputError> {
    let [periods_s, deviation] = args.band.checked()?;
    if !(args.scale_from > 0.0 && args.scale_from <= args.scale_to && args.scale_to <= 100.0) {
        let found = format!("{} to {}", args.scale_from, args.scale_to);
        return Err(InputError::option("--scale-from and --scale-to", found, "0 < from <= to <= 100"));
    }
    for (option, value, most) in
        [("--count", args.count, 1000), ("--most-of-event", args.most_of_event, 1000)]
    {
        if !(1..=most).contains(&value) {
            return Err(InputError::option(option, value.to_string(), format!("1 to {most}")));
        }
    }
    let scale = (args.scale_from, args.scale_to);
    let (count, most_of_event, candidates, best) =
        (args.count, args.most_of_event, args.candidates, args.best.max(1));
    Ok(Criteria { count, periods_s, deviation, scale, most_of_event, candidates, best })
}
