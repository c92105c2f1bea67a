//! Suites of records whose mean spectrum follows that of a site, as REXEL finds them.
//!
//! Iervolino, Galasso and Cosenza (2010), "REXEL: computer aided record selection for code-based seismic structural
//! analysis", Bulletin of Earthquake Engineering 8: combinations of N records are tried, those whose mean spectrum stays
//! within bounds of the code are kept and ranked by how far it strays on the whole.

use super::code_spectrum::{Site, deviation_range, periods_s};
use super::spectrum::response_spectrum_m_s2;
use super::suite::SuiteRecord;

/// What a selected suite must hold to.
#[derive(Debug, Clone, PartialEq)]
pub struct Criteria {
    /// Records in a suite.
    pub count: usize,
    /// Shortest and longest period compared, s.
    pub periods_s: (f64, f64),
    /// Relative deviation of the mean spectrum from the code allowed below and above.
    pub deviation: (f64, f64),
    /// Smallest and largest scale factor; (1, 1) takes records as they are.
    pub scale: (f64, f64),
    /// Most records of one event in a suite.
    pub most_of_event: usize,
    /// Candidates that are combined, the closest in shape first: combinations grow fast.
    pub candidates: usize,
    /// Suites that are returned.
    pub best: usize,
}

/// A suite that holds to the criteria.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    /// Positions among the candidates, rising.
    pub members: Vec<usize>,
    /// Scale factors of the members, on top of what the candidates carry.
    pub scales: Vec<f64>,
    /// Root mean square of mean/code − 1, the δ of REXEL.
    pub deviation_rms: f64,
    /// Smallest of mean/code − 1.
    pub lowest_deviation: f64,
    /// Largest of mean/code − 1.
    pub highest_deviation: f64,
}

/// One candidate: its scaled spectrum relative to the code.
struct Candidate {
    index: usize,
    event: usize,
    scale: f64,
    ratio: Vec<f64>,
    misfit: f64,
}

/// The best suites of `records` for a site, best first; empty where no suite holds to the criteria.
///
/// A record is scaled by the mean logarithm of code over spectrum. Ties go to the earlier records.
pub fn select(records: &[SuiteRecord], site: &Site, criteria: &Criteria) -> Vec<Selection> {
    let mut candidates = candidates(records, site, criteria);
    candidates.sort_by(|a, b| a.misfit.total_cmp(&b.misfit).then(a.index.cmp(&b.index)));
    candidates.truncate(criteria.candidates);
    if criteria.count == 0 || candidates.len() < criteria.count {
        return Vec::new();
    }
    let mut search = Search { candidates: &candidates, criteria, members: Vec::new(), found: Vec::new() };
    let nothing = vec![0.0; candidates[0].ratio.len()];
    search.extend(0, &nothing);
    search.found.sort_by(|a, b| a.deviation_rms.total_cmp(&b.deviation_rms));
    search.found.truncate(criteria.best);
    search.found
}

fn candidates(records: &[SuiteRecord], site: &Site, criteria: &Criteria) -> Vec<Candidate> {
    let periods = periods_s(criteria.periods_s.0, criteria.periods_s.1);
    let code: Vec<f64> = periods.iter().map(|&period| site.elastic_m_s2(period)).collect();
    let candidate = |(index, record): (usize, &SuiteRecord)| {
        let spectrum = response_spectrum_m_s2(&record.horizontal, &periods, site.damping);
        let ratio: Vec<f64> = spectrum.iter().zip(&code).map(|(sa, code)| sa / code).collect();
        let mean_log = ratio.iter().map(|r| r.ln()).sum::<f64>() / ratio.len() as f64;
        let scale = (-mean_log).exp().clamp(criteria.scale.0, criteria.scale.1);
        let misfit = ratio.iter().map(|r| (scale * r - 1.0).powi(2)).sum::<f64>();
        let ratio = ratio.iter().map(|r| scale * r).collect();
        Candidate { index, event: event_number(records, index), scale, ratio, misfit }
    };
    // A record that never moves has no spectrum to compare.
    records.iter().enumerate().map(candidate).filter(|c| c.misfit.is_finite()).collect()
}

/// Records of one event share the number of its first record; a record of no stated event is an event of its own.
fn event_number(records: &[SuiteRecord], index: usize) -> usize {
    let event = &records[index].event;
    let same = records.iter().position(|r| !event.is_empty() && r.event == *event);
    same.unwrap_or(index)
}

/// A search through the combinations, depth first.
struct Search<'a> {
    candidates: &'a [Candidate],
    criteria: &'a Criteria,
    members: Vec<usize>,
    found: Vec<Selection>,
}

impl Search<'_> {
    fn extend(&mut self, from: usize, sum: &[f64]) {
        let missing = self.criteria.count - self.members.len();
        if missing == 0 {
            return self.keep(sum);
        }
        for next in from..=self.candidates.len() - missing {
            if self.is_event_full(next) {
                continue;
            }
            let added: Vec<f64> = sum.iter().zip(&self.candidates[next].ratio).map(|(s, r)| s + r).collect();
            if self.is_too_high(&added) {
                continue;
            }
            self.members.push(next);
            self.extend(next + 1, &added);
            self.members.pop();
        }
    }

    fn is_event_full(&self, next: usize) -> bool {
        let event = self.candidates[next].event;
        let same = self.members.iter().filter(|&&m| self.candidates[m].event == event).count();
        same >= self.criteria.most_of_event
    }

    /// Whether the sum alone exceeds what the mean may reach: records only add.
    fn is_too_high(&self, sum: &[f64]) -> bool {
        let highest = (1.0 + self.criteria.deviation.1) * self.criteria.count as f64;
        sum.iter().any(|s| *s > highest)
    }

    fn keep(&mut self, sum: &[f64]) {
        let mean: Vec<f64> = sum.iter().map(|s| s / self.criteria.count as f64).collect();
        let (lowest_deviation, highest_deviation) = deviation_range(&mean, &vec![1.0; mean.len()]);
        if lowest_deviation < self.criteria.deviation.0 || highest_deviation > self.criteria.deviation.1 {
            return;
        }
        let square = mean.iter().map(|m| (m - 1.0).powi(2)).sum::<f64>() / mean.len() as f64;
        let mut members: Vec<&Candidate> = self.members.iter().map(|&m| &self.candidates[m]).collect();
        members.sort_by_key(|c| c.index);
        self.found.push(Selection {
            members: members.iter().map(|c| c.index).collect(),
            scales: members.iter().map(|c| c.scale).collect(),
            deviation_rms: square.sqrt(),
            lowest_deviation,
            highest_deviation,
        });
        self.forget_the_worst();
    }

    /// Keeps memory bounded: the worst suites go when many times the wanted number are found.
    fn forget_the_worst(&mut self) {
        let most = 64 * self.criteria.best.max(1);
        if self.found.len() >= most {
            self.found.sort_by(|a, b| a.deviation_rms.total_cmp(&b.deviation_rms));
            self.found.truncate(self.criteria.best.max(1));
        }
    }
}
