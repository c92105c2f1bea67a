//! The missing force, and the laws of the candidates, as they are summary.

use std::path::Path;

use super::columns::Columns;
use crate::error::Result;

/// What of the top's motion the force is drawn against: column and label.
pub(super) const AGAINST: [(&str, &str); 3] = [
    ("displacement_m", "displacement of the top m"),
    ("velocity_m_s", "velocity of the top m/s"),
    ("acceleration_m_s2", "absolute acceleration of the top m/s²"),
];

/// What a hypothesis adds to the force at the top.
pub(super) struct Law {
    pub(super) name: String,
    /// Index into [`AGAINST`].
    pub(super) which: usize,
    pub(super) points: Vec<(f64, f64)>,
    /// Abscissa and both ends of the 90 % interval, where it is told.
    pub(super) band: Vec<(f64, f64, f64)>,
}

/// `force.parquet` and `laws.parquet`.
pub struct Points {
    pub(super) test: Vec<String>,
    pub(super) pattern: Vec<String>,
    pub(super) time_s: Vec<f64>,
    pub(super) against: [Vec<f64>; 3],
    pub(super) moment: [Vec<f64>; 2],
    pub(super) force_n: Vec<f64>,
    pub(super) sd_n: Vec<f64>,
    pub(super) share: Vec<f64>,
    pub(super) after_n: Vec<f64>,
    pub(super) laws: Vec<Law>,
}

impl Points {
    /// Reads both tables of a folder.
    ///
    /// # Errors
    /// Input errors for files that are no such tables.
    pub fn read(folder: &Path) -> Result<Self> {
        let names = [
            "test",
            "pattern",
            "time_s",
            "displacement_m",
            "velocity_m_s",
            "acceleration_m_s2",
            "moment1_n_m",
            "moment2_n_m",
            "force_n",
            "force_sd_n",
            "share_off_top",
            "force_after_n",
        ];
        let columns = Columns::read(&folder.join("force.parquet"), &names)?;
        let numbers = |name: &str| columns.numbers(name);
        Ok(Self {
            test: columns.labels("test")?,
            pattern: columns.labels("pattern")?,
            time_s: numbers("time_s")?,
            against: [numbers(AGAINST[0].0)?, numbers(AGAINST[1].0)?, numbers(AGAINST[2].0)?],
            moment: [numbers("moment1_n_m")?, numbers("moment2_n_m")?],
            force_n: numbers("force_n")?,
            sd_n: numbers("force_sd_n")?,
            share: numbers("share_off_top")?,
            after_n: numbers("force_after_n")?,
            laws: laws(&folder.join("laws.parquet"))?,
        })
    }

    /// Numbers of the stretches.
    pub(super) fn rows(&self) -> std::ops::Range<usize> {
        0..self.force_n.len()
    }

    /// What a dot tells.
    pub(super) fn tip(&self, k: usize) -> String {
        format!(
            "{}, {:.2} s, pattern {}\nforce {:.0} ± {:.0} N",
            self.test[k], self.time_s[k], self.pattern[k], self.force_n[k], self.sd_n[k]
        )
    }

    /// Hypotheses with a law, each once.
    pub(super) fn law_names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for Law { name, .. } in &self.laws {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        names
    }
}

fn laws(path: &Path) -> Result<Vec<Law>> {
    let columns = Columns::read(path, &["name", "against", "x", "force_n", "force_low_n", "force_high_n"])?;
    let (names, against) = (columns.labels("name")?, columns.labels("against")?);
    let (x, force_n) = (columns.numbers("x")?, columns.numbers("force_n")?);
    let (low_n, high_n) = (columns.numbers("force_low_n")?, columns.numbers("force_high_n")?);
    let mut laws: Vec<Law> = Vec::new();
    for k in 0..names.len() {
        let Some(which) = AGAINST.iter().position(|(name, _)| *name == against[k]) else { continue };
        if !laws.last().is_some_and(|law| law.name == names[k] && law.which == which) {
            laws.push(Law { name: names[k].clone(), which, points: Vec::new(), band: Vec::new() });
        }
        if let Some(law) = laws.last_mut() {
            law.points.push((x[k], force_n[k]));
            if low_n[k].is_finite() && high_n[k].is_finite() {
                law.band.push((x[k], low_n[k], high_n[k]));
            }
        }
    }
    Ok(laws)
}
