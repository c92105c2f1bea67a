//! Response spectra of a study's records, and that of the code at a site.

use std::path::Path;

use super::file::found_again;
use crate::study::plan::Motions;
use crate::study::runs::Manifest;
use mrbd_records::{CODE_DAMPING, COMPATIBLE_PERIODS_S, Site, Suite, SuiteCheck, response_spectrum_m_s2};

/// Longest period, s.
const LONGEST_S: f64 = 3.0;
/// Spacing of the periods, s.
const STEP_S: f64 = 0.02;

/// Elastic pseudo-acceleration spectra of a suite's records at its own scales.
#[derive(Debug)]
pub struct Spectra {
    /// Name of the suite.
    pub suite: String,
    /// Damping ratio.
    pub damping: f64,
    /// Periods, s.
    pub periods_s: Vec<f64>,
    /// Records and their spectra, m/s².
    pub records: Vec<(String, Vec<f64>)>,
    /// Mean of the records, m/s².
    pub mean_m_s2: Vec<f64>,
    /// The code's spectrum; `None` without a site.
    pub code: Option<CodeSpectrum>,
}

/// The spectrum of the code at a site.
#[derive(Debug)]
pub struct CodeSpectrum {
    /// The site.
    pub site: Site,
    /// Elastic spectrum at the periods, m/s².
    pub elastic_m_s2: Vec<f64>,
    /// The mean of the records against it.
    pub check: SuiteCheck,
}

impl Spectra {
    /// Spectra of the records of a study; `None` where they are gone or other ones now.
    pub fn of(folder: &Path, manifest: &Manifest, site: Option<&Site>) -> Option<Self> {
        Some(Self::of_suite(&suite_of(folder, manifest)?, site))
    }

    fn of_suite(suite: &Suite, site: Option<&Site>) -> Self {
        let last = (LONGEST_S / STEP_S).round() as u32;
        let periods_s: Vec<f64> = (1..=last).map(|k| f64::from(k) * STEP_S).collect();
        let damping = site.map_or(CODE_DAMPING, |site| site.damping);
        let spectrum = |record: &mrbd_records::SuiteRecord| {
            (record.name.clone(), response_spectrum_m_s2(&record.horizontal, &periods_s, damping))
        };
        let records: Vec<(String, Vec<f64>)> = suite.records.iter().map(spectrum).collect();
        let mean = |k: usize| records.iter().map(|(_, s)| s[k]).sum::<f64>() / records.len() as f64;
        Self {
            suite: suite.name.clone(),
            damping,
            mean_m_s2: (0..periods_s.len()).map(mean).collect(),
            code: site.map(|site| CodeSpectrum {
                elastic_m_s2: periods_s.iter().map(|&period_s| site.elastic_m_s2(period_s)).collect(),
                check: SuiteCheck::of(suite, site, COMPATIBLE_PERIODS_S),
                site: *site,
            }),
            periods_s,
            records,
        }
    }
}

/// The suite of a study, if its file is still at hand and still holds the samples that were run.
fn suite_of(folder: &Path, manifest: &Manifest) -> Option<Suite> {
    let file = found_again(folder, &manifest.inputs, "suite")?;
    let motions = Motions::new(Suite::load(&file).ok()?);
    let same = motions.hashes.len() == manifest.suite.records.len()
        && motions
            .hashes
            .iter()
            .zip(&manifest.suite.records)
            .all(|(now, then)| now.horizontal == then.sha256);
    same.then_some(motions.suite)
}
