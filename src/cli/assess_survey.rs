//! `mrbd assess-survey`: the code's check beside the dynamics over the façades of a survey.

use std::path::{Path, PathBuf};

use clap::Args;

use super::threads::Threads;
use super::{output, progress};
use crate::assessment::portfolio::{COLUMNS, FILES, KIND, Portfolio, Question, by_factor, shares};
use crate::error::{Error, InputError, Result};
use crate::store::{WholeFolder, print_csv, write_durably, write_table};
use crate::survey::Survey;
use mrbd_assessment::{SiteFile, motions};
use mrbd_files::FileNote;
use mrbd_files::coefficients::CoefficientSets;
use mrbd_records::Suite;

/// Check the façades of a survey by the code and by their own dynamics: ζ static beside ζ dynamic.
///
/// Thickness and slenderness stand at the middles of equal shares of the survey's log-normals, so that every façade stands
/// for the same share of the stock; all else stands at μ. ζ dynamic is the factor on all records at which the check by
/// nonlinear dynamic analysis (C8.7.1.2.1.9) no longer accepts SLV, found to 2 %. stdout has one line a façade.
///
/// Examples:
///   mrbd assess-survey inputs/survey.toml --coefficients inputs/coefficients.toml --site inputs/site_mirandola.toml --records inputs/records/emilia7/suite.toml --out outputs/assess_table
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct AssessSurveyCommand {
    /// Survey of the façades (TOML).
    survey: PathBuf,
    /// Coefficients C_l (TOML): their best fit.
    #[arg(long, value_name = "FILE")]
    coefficients: PathBuf,
    /// Site file (TOML).
    #[arg(long, value_name = "FILE")]
    site: PathBuf,
    /// Suite of records compatible with the site.
    #[arg(long, value_name = "FILE")]
    records: PathBuf,
    /// Thicknesses, 1 to 100.
    #[arg(long, value_name = "N", default_value_t = 7)]
    thicknesses: u32,
    /// Slendernesses, 1 to 100.
    #[arg(long, value_name = "N", default_value_t = 9)]
    slendernesses: u32,
    /// Write portfolio.parquet, portfolio.json and a page into a folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace the results in that folder.
    #[arg(long, requires = "out")]
    force: bool,
    #[command(flatten)]
    threads: Threads,
}

impl AssessSurveyCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Bad input; results that cannot be written; a run that could not be finished.
    pub fn execute(self) -> Result<()> {
        for (option, count) in [("--thicknesses", self.thicknesses), ("--slendernesses", self.slendernesses)]
        {
            if !(1..=100).contains(&count) {
                return Err(InputError::option(option, count.to_string(), "1 to 100").into());
            }
        }
        let survey = Survey::load(&self.survey)?;
        let coefficients = CoefficientSets::load(&self.coefficients)?.best_fit;
        let site = SiteFile::load(&self.site)?;
        let suite = Suite::load(&self.records)?;
        let folder =
            self.out.as_deref().map(|out| WholeFolder::check(out, &FILES, self.force)).transpose()?;
        let motions = motions(&suite.records, site.floor());
        let counts = [self.thicknesses, self.slendernesses];
        let question = Question { survey: &survey, site: &site, coefficients, motions: &motions, counts };
        let bar = progress::of_runs(question.count());
        let rows = self.threads.pool()?.install(|| question.rows(|| bar.inc(1)))?;
        bar.finish_and_clear();
        let portfolio = Portfolio {
            site: site.name.clone(),
            suite: suite.name.clone(),
            generated: suite.generated,
            confidence_factor: site.assessment.confidence_factor,
            shares: shares(&rows),
            by_factor: by_factor(&rows),
            rows,
        };
        if let Some(folder) = folder {
            self.write(folder.cleared()?, &portfolio, &suite)?;
        }
        tell(&portfolio);
        output::to_stdout(|mut out| {
            print_csv(&mut out, COLUMNS.iter(), &portfolio.rows).map_err(output::failed)
        })
    }

    fn write(&self, folder: &Path, portfolio: &Portfolio, suite: &Suite) -> Result<()> {
        let [manifest, json, parquet] = FILES.map(|name| folder.join(name));
        let inputs = [
            ("survey", &self.survey),
            ("coefficients", &self.coefficients),
            ("site", &self.site),
            ("suite", &self.records),
        ];
        let notes = inputs.map(|(role, path)| FileNote::of(role, path).map(|note| note.seen_from(folder)));
        let notes = notes.into_iter().collect::<mrbd_files::Result<_>>()?;
        output::write_manifest(&manifest, KIND, &portfolio.site, notes, Some(suite))?;
        let text = serde_json::to_string_pretty(portfolio);
        let text = text.map_err(|e| Error::io("write the assessments", &json, e.into()))?;
        write_durably(&json, text.as_bytes())?;
        let about = [("site", &portfolio.site), ("suite", &portfolio.suite)];
        let about = about.map(|(key, value)| (key.to_owned(), value.clone()));
        write_table(&parquet, &COLUMNS, &about, &portfolio.rows)?;
        let page = super::report::write_page(folder, None)?;
        eprintln!("mrbd: {}", page.display());
        Ok(())
    }
}

fn tell(portfolio: &Portfolio) {
    for shares in &portfolio.shares {
        let [accept, refuse, static_refuses, dynamic_refuses] =
            [shares.both_accept, shares.both_refuse, shares.static_refuses, shares.dynamic_refuses]
                .map(|share| 100.0 * share);
        let ratio = shares.median_ratio.map_or("?".to_owned(), |ratio| format!("{ratio:.2}"));
        eprintln!(
            "mrbd: {} floor, {} façades: both accept {accept:.0} %, both refuse {refuse:.0} %, the code alone refuses \
             {static_refuses:.0} %, the dynamics alone {dynamic_refuses:.0} %; median of ζ dynamic over ζ static {ratio}",
            shares.configuration.name(),
            shares.facades
        );
    }
}
