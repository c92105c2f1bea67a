//! What is asked of a table: the options, and what the manifest of a study of drawn façades says where they are silent.

use super::FragilityCommand;
use crate::error::{InputError, Result};
use crate::fragility::{Columns, Expression, Outcomes};
use crate::study::pipeline::Kind;
use crate::study::runs::Manifest;

/// The lower end of the bracket of an incremental analysis, in the unit of the study's measure.
const STOOD: &str = "stood_intensity";

/// What the limit of a row, or of a pass over the rows, is called in results.
const LIMIT: &str = "limit";

/// Columns, limit by limit.
pub(super) struct Asked {
    /// Names of the parts of a group's key; the last is the limit, if there are limits.
    pub columns: Vec<String>,
    /// Whether groups are told by limits too.
    pub has_limits: bool,
    /// Whether rows are of incremental analyses.
    pub incremental: bool,
    /// Each a pass over the table; never empty.
    pub states: Vec<State>,
}

/// One pass over the table.
pub(super) struct State {
    /// The limit, where the table has no column of it.
    pub name: Option<String>,
    /// Which column is what.
    pub columns: Columns,
}

impl Asked {
    pub fn intensity(&self) -> &Expression {
        &self.states[0].columns.intensity
    }

    /// Whether intensities stand at the upper ends of their brackets, for those of the lower ends are not known.
    pub fn lies_above(&self) -> bool {
        self.incremental && self.states[0].columns.stood.is_none()
    }

    pub fn clusters(&self) -> &[String] {
        &self.states[0].columns.clusters
    }
}

/// A limit as a name that OpenQuake takes: `collapse`, `theta_0p1`.
pub(super) fn state_name(limit: &str) -> String {
    match limit.parse::<f64>() {
        Ok(_) => format!("theta_{}", limit.replace('.', "p")),
        Err(_) => limit.to_owned(),
    }
}

impl FragilityCommand {
    pub(super) fn asked(&self) -> Result<Asked> {
        if self.cluster.len() > 2 {
            let found = format!("{} columns", self.cluster.len());
            return Err(InputError::option("--cluster", found, "at most two columns").into());
        }
        match (&self.outcome, self.drawn()?) {
            (Some(outcome), _) => self.asked_of_table(outcome),
            (None, Some(manifest)) => self.asked_of_study(&manifest),
            (None, None) => {
                let allowed = "the column of outcomes, or FILE the output folder of a study of drawn façades";
                Err(InputError::option("--outcome", "nothing", allowed).into())
            }
        }
    }

    /// The manifest, if the file is the folder of a study of drawn façades.
    fn drawn(&self) -> Result<Option<Manifest>> {
        if !self.file.is_dir() {
            return Ok(None);
        }
        // Points of a study of variance share inputs: they are no sample of façades.
        let sample = |kind: Kind| kind.is_drawn() && kind != Kind::Variance;
        Ok(Manifest::read(&self.file.join("manifest.json"))?.filter(|manifest| sample(manifest.kind)))
    }

    fn asked_of_table(&self, outcome: &str) -> Result<Asked> {
        let Some(intensity) = &self.intensity else {
            let allowed = "the column of intensities, or an expression of columns";
            return Err(InputError::option("--intensity", "nothing", allowed).into());
        };
        let outcome = outcome.to_owned();
        let outcome = match (self.exceeds, &self.trials) {
            (Some(limit), _) => Outcomes::Above(outcome, super::finite("--exceeds", limit)?),
            (None, Some(trials)) => Outcomes::Counts(outcome, trials.clone()),
            (None, None) => Outcomes::Words(outcome),
        };
        let columns = Columns {
            intensity: self.expression(intensity)?,
            stood: None,
            outcome,
            demand: self.demand.clone(),
            groups: self.group.clone(),
            clusters: self.cluster.clone(),
        };
        let states = vec![State { name: None, columns }];
        Ok(Asked { columns: self.group.clone(), has_limits: false, incremental: false, states })
    }

    fn asked_of_study(&self, manifest: &Manifest) -> Result<Asked> {
        let incremental = manifest.kind == Kind::Incremental;
        let or = |given: &[String], default: &[&str]| match given {
            [] => default.iter().map(|&name| name.to_owned()).collect(),
            given => given.to_vec(),
        };
        let several = manifest.variants.as_array().is_some_and(|variants| variants.len() > 1);
        let mut groups: Vec<String> =
            or(&self.group, if several { &["variant", "configuration"] } else { &["configuration"] });
        let mut columns: Vec<String> = groups.iter().filter(|name| *name != LIMIT).cloned().collect();
        columns.push(LIMIT.to_owned());
        if incremental {
            groups.clone_from(&columns);
        }
        let clusters = or(&self.cluster, &["record", "draw"]);
        let asked = self.intensity_of(manifest)?;
        let intensity = self.expression(&asked)?;
        let own = [measure_of(manifest), Some("intensity")].contains(&Some(asked.as_str()));
        let stood = (incremental && own).then(|| STOOD.to_owned());
        let state = |name: Option<String>, outcome| State {
            name,
            columns: Columns {
                intensity: intensity.clone(),
                stood: stood.clone(),
                outcome,
                demand: self.demand.clone(),
                groups: groups.clone(),
                clusters: clusters.clone(),
            },
        };
        let states = match incremental {
            true => vec![state(None, Outcomes::Words("limit_exceeded".into()))],
            false => {
                let above = |&x: &f64| {
                    state(Some(x.to_string()), Outcomes::Above("theta_max_over_own_alpha".into(), x))
                };
                let mut states: Vec<State> = self.thresholds(manifest)?.iter().map(above).collect();
                states.push(state(Some("collapse".into()), Outcomes::Words("outcome".into())));
                states
            }
        };
        if incremental && !self.threshold.is_empty() {
            let allowed = "left out: an incremental study has the `limits` of its pipeline";
            return Err(InputError::option("--threshold", "given", allowed).into());
        }
        Ok(Asked { columns, has_limits: true, incremental, states })
    }

    /// The intensity asked for, or the measure the study was scaled by.
    fn intensity_of(&self, manifest: &Manifest) -> Result<String> {
        let intensity = self.intensity.as_deref().or(measure_of(manifest)).map(str::to_owned);
        let allowed = "a column of intensities, such as pga_g, pgv_m_s or sa_average_m_s2";
        Ok(intensity.ok_or_else(|| InputError::option("--intensity", "nothing", allowed))?)
    }

    /// The thresholds, increasing; a wall that collapsed has passed each of them.
    fn thresholds(&self, manifest: &Manifest) -> Result<Vec<f64>> {
        let variants = manifest.variants.as_array().into_iter().flatten();
        let ratios = variants.filter_map(|v| v["assumptions"]["collapse_rotation_ratio"].as_f64());
        let lowest = ratios.fold(f64::INFINITY, f64::min);
        if let Some(wrong) = self.threshold.iter().find(|&&x| !(x > 0.0 && x < lowest)) {
            let allowed = format!("rotations over α_i, above 0 and below {lowest} where a wall collapses");
            return Err(InputError::option("--threshold", wrong.to_string(), allowed).into());
        }
        let mut thresholds = self.threshold.clone();
        thresholds.sort_by(f64::total_cmp);
        thresholds.dedup();
        Ok(thresholds)
    }
}

/// The measure the study was scaled by.
fn measure_of(manifest: &Manifest) -> Option<&str> {
    let loading = &manifest.study["loading"];
    let measure = |kind: Kind| loading[kind.name()]["measure"].as_str();
    [Kind::Stripes, Kind::Incremental].into_iter().find_map(measure)
}
