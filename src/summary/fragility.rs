//! Fragilities of a study of drawn façades: the probability of reaching each of its limits.

use std::path::Path;

use crate::aggregate::Distributions;
use crate::error::{InputError, Result};
use crate::fragility::{
    Analysis, Bootstrap, Columns, EXPRESSION_ALLOWED, Expression, Group, Method, NotAnExpression, Outcomes,
    Sample, Settings, analyse, read_groups,
};
use crate::study::pipeline::Kind;

/// The rotation over α_i that the paper calls significant.
const SIGNIFICANT: f64 = 0.05;
/// Intensity of studies that were not scaled to one: in rocking, velocity tells more than acceleration.
pub const DEFAULT_INTENSITY: &str = "pgv_m_s";
/// Level of the intervals.
pub const LEVEL: f64 = 0.95;

/// The fragility of one limit under one floor.
#[derive(Debug)]
pub struct LimitFragility {
    /// The floor.
    pub configuration: String,
    /// The limit in words.
    pub limit: String,
    /// Intensities and outcomes.
    pub sample: Sample,
    /// The curve and its intervals.
    pub analysis: Analysis,
    /// How the sample was read.
    pub method: Method,
}

/// Fragilities of a variant, by limit and floor.
///
/// # Errors
/// An input error for tables without the columns of a study.
pub fn fragilities(folder: &Path, study: &Distributions, base: &str) -> Result<Vec<LimitFragility>> {
    if study.kind == Kind::Incremental {
        let reached = Outcomes::Words("limit_exceeded".into());
        let limit = |group: &Group| match group.key[2].as_str() {
            "collapse" => "collapse".to_owned(),
            rotation => format!("|θᵢ|/αᵢ > {rotation}"),
        };
        let columns = columns(folder, study, reached, &["variant", "configuration", "limit"])?;
        return of_groups(folder, &columns, (base, Method::Incremental), &limit);
    }
    let groups = ["variant", "configuration"];
    let rotated = Outcomes::Above("theta_max_over_own_alpha".into(), SIGNIFICANT);
    let outcomes = (base, Method::Outcomes);
    let mut all = of_groups(folder, &columns(folder, study, rotated, &groups)?, outcomes, &|_| {
        format!("|θᵢ|/αᵢ > {SIGNIFICANT}")
    })?;
    let collapsed = columns(folder, study, Outcomes::Words("outcome".into()), &groups)?;
    all.extend(of_groups(folder, &collapsed, outcomes, &|_| "collapse".to_owned())?);
    Ok(all)
}

fn columns(folder: &Path, study: &Distributions, outcome: Outcomes, groups: &[&str]) -> Result<Columns> {
    let intensity = if study.measure.is_some() { "intensity" } else { DEFAULT_INTENSITY };
    let slip = |e: NotAnExpression| InputError::file(folder, e.to_string(), EXPRESSION_ALLOWED);
    Ok(Columns {
        intensity: Expression::parse(intensity).map_err(slip)?,
        stood: (study.kind == Kind::Incremental).then(|| "stood_intensity".to_owned()),
        outcome,
        demand: None,
        groups: groups.iter().map(|&name| name.to_owned()).collect(),
        clusters: ["record", "draw"].map(str::to_owned).to_vec(),
    })
}

fn of_groups(
    folder: &Path,
    columns: &Columns,
    (base, method): (&str, Method),
    limit: &dyn Fn(&Group) -> String,
) -> Result<Vec<LimitFragility>> {
    let groups = read_groups(folder, columns)?.into_iter().filter(|group| group.key[0] == base);
    Ok(groups.map(|group| of_group(group, method, limit)).collect())
}

fn of_group(group: Group, method: Method, limit: &dyn Fn(&Group) -> String) -> LimitFragility {
    let analysis =
        analyse(&group.sample, &Settings { method, bootstrap: Bootstrap::default(), level: LEVEL });
    LimitFragility {
        configuration: group.key[1].clone(),
        limit: limit(&group),
        sample: group.sample,
        analysis,
        method,
    }
}
