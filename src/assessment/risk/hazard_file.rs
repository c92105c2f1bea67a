//! Hazard curves as files: CSV, or OpenQuake's NRML.

use std::path::Path;

use csv::StringRecord;

use super::nrml;
use crate::error::{InputError, Result};
use mrbd_assessment::{Hazard, HazardPoint};
use mrbd_files::toml_file;

/// What a CSV hazard curve has.
const COLUMNS: &str = "a first column of intensities named by its measure (pga_g, pgv_m_s, ...), and annual_rate, or poe with \
                       --years; annual_rate_16 and annual_rate_84 may stand beside it";

/// A hazard curve that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct HazardFile {
    /// The measure of intensity, with its unit.
    pub measure: String,
    /// The curve.
    pub curve: Hazard,
    /// Standard deviation of ln λ, from the 16 % and 84 % curves; `None` where there are none.
    pub ln_rate_deviation: Option<f64>,
}

/// Reads a hazard curve; `years` is the time that probabilities of exceedance in a CSV are for.
///
/// # Errors
/// Input errors with the file and the line.
pub fn read_hazard(path: &Path, years: Option<f64>) -> Result<HazardFile> {
    let text = toml_file::read(path)?;
    match text.trim_start().starts_with('<') {
        true => from_nrml(path, &text),
        false => from_csv(path, &text, years),
    }
}

/// The annual rate of events with a probability of exceedance in some years (Poisson).
fn rate(poe: f64, years: f64) -> f64 {
    -(-poe).ln_1p() / years
}

/// A curve of the points that have a rate above 0 and finite: probabilities of 0 and 1 tell none.
fn curve(path: &Path, points: Vec<HazardPoint>) -> Result<Hazard> {
    let told = points.into_iter().filter(|point| point.annual_rate > 0.0 && point.annual_rate.is_finite());
    let allowed = "rising intensities above 0 with falling rates, two at least";
    Ok(Hazard::new(told.collect()).map_err(|e| InputError::file(path, e.to_string(), allowed))?)
}

fn from_csv(path: &Path, text: &str, years: Option<f64>) -> Result<HazardFile> {
    let fault = |e: &csv::Error| {
        let line = e.position().map_or(1, csv::Position::line) as usize;
        InputError::line(path, line, e.to_string(), "a CSV table with a header and rows of its length")
    };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| fault(&e))?.clone();
    let place = |name: &str| header.iter().position(|head| head == name);
    let (column, years) = match (place("annual_rate"), place("poe"), years) {
        (Some(column), _, _) => (column, None),
        (None, Some(column), Some(years)) => (column, Some(years)),
        _ => {
            let given = header.iter().collect::<Vec<_>>().join(", ");
            return Err(InputError::file(path, format!("the columns {given}"), COLUMNS).into());
        }
    };
    let fractiles = place("annual_rate_16").zip(place("annual_rate_84"));
    let (mut points, mut deviations) = (Vec::new(), Vec::new());
    for record in reader.records() {
        let record = record.map_err(|e| fault(&e))?;
        let number = |column: usize| number(path, &header, &record, column);
        let (intensity, value) = (number(0)?, number(column)?);
        let annual_rate = years.map_or(value, |years| rate(value, years));
        points.push(HazardPoint { intensity, annual_rate });
        if let Some((low, high)) = fractiles {
            let [low, high] = [number(low)?, number(high)?];
            deviations.extend((low > 0.0 && high >= low).then(|| 0.5 * (high / low).ln()));
        }
    }
    let mean = deviations.iter().sum::<f64>() / deviations.len().max(1) as f64;
    let measure = header.get(0).unwrap_or_default().to_owned();
    let ln_rate_deviation = (!deviations.is_empty()).then_some(mean);
    Ok(HazardFile { measure, curve: curve(path, points)?, ln_rate_deviation })
}

/// A cell as a number, 0 or more.
fn number(
    path: &Path,
    header: &StringRecord,
    record: &StringRecord,
    column: usize,
) -> Result<f64, InputError> {
    let text = record.get(column).unwrap_or_default();
    let value = text.parse::<f64>().ok().filter(|value| *value >= 0.0 && value.is_finite());
    let line = record.position().map_or(0, csv::Position::line) as usize;
    let found = || format!("{text:?} for {}", &header[column]);
    value.ok_or_else(|| InputError::line(path, line, found(), "a number, 0 or more"))
}

fn from_nrml(path: &Path, text: &str) -> Result<HazardFile> {
    let document = nrml::parse(path, text)?;
    let refuse = |found: &str, allowed: &str| InputError::file(path, found, allowed);
    let curves = nrml::elements(document.root_element(), "hazardCurves").next();
    let curves = curves.ok_or_else(|| refuse("no hazardCurves", "a hazard curve in NRML 0.5"))?;
    let of_one_site: Vec<_> = nrml::elements(curves, "hazardCurve").collect();
    let [site] = of_one_site[..] else {
        let found = format!("{} curves", of_one_site.len());
        return Err(refuse(&found, "the hazard curve of one site").into());
    };
    let missing =
        |name: &str| refuse(&format!("no {name}"), "hazardCurves with investigationTime, IMT, IMLs and poEs");
    let years =
        nrml::attribute(curves, &["investigationTime"]).ok_or_else(|| missing("investigationTime"))?;
    let years = nrml::number(path, curves, years)?;
    let imt = nrml::attribute(curves, &["IMT", "imt"]).ok_or_else(|| missing("IMT"))?;
    let texts = |node, name| nrml::elements(node, name).next().ok_or_else(|| missing(name));
    let intensities = nrml::numbers(path, texts(curves, "IMLs")?)?;
    let poes = nrml::numbers(path, texts(site, "poEs")?)?;
    if intensities.len() != poes.len() || years <= 0.0 {
        let found = format!("{} IMLs, {} poEs in {years} years", intensities.len(), poes.len());
        return Err(refuse(&found, "as many poEs as IMLs, in a time above 0").into());
    }
    let point = |(intensity, poe): (f64, f64)| HazardPoint { intensity, annual_rate: rate(poe, years) };
    let points = intensities.into_iter().zip(poes).map(point).collect();
    Ok(HazardFile { measure: nrml::measure(imt), curve: curve(path, points)?, ln_rate_deviation: None })
}
