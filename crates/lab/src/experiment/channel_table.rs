//! Transducers of an experiment file: which column, at which height, relative to what.

use std::path::Path;

use serde::Deserialize;

use super::file::{StartTime, TestTable};
use mrbd_files::error::InputError;
use mrbd_kernel::model::Wall;

/// `[[channels]]`: a column of the measured files with the horizontal displacement of the wall at a height.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChannelTable {
    /// Column of the measured file.
    pub column: String,
    /// Height above the base of the wall, m; 0: the table itself, in absolute displacements.
    pub height_m: f64,
    /// What the displacement is relative to.
    #[serde(default)]
    pub frame: Frame,
    /// Metres a unit of the column, with its sign.
    #[serde(default = "one")]
    pub factor: f64,
    /// Standard deviation of its error, m; absent: that of the scatter from sample to sample.
    pub noise_m: Option<f64>,
    /// Where it stands in the experiment file.
    #[serde(skip)]
    pub key: String,
}

/// What a displacement is relative to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Frame {
    /// The table on which the wall stands.
    #[default]
    Ground,
    /// The floor of the laboratory: the table's own displacement is taken off.
    Absolute,
}

fn one() -> f64 {
    1.0
}

/// Heights this near each other are one, m: a transducer is wider.
const ONE_HEIGHT_M: f64 = 1e-6;

impl ChannelTable {
    /// Whether it is the displacement of the table.
    pub fn is_table(&self) -> bool {
        self.height_m == 0.0
    }

    fn refuse(&self, path: &Path, key: &str, found: String, allowed: &str) -> InputError {
        InputError::key(path, format!("{}.{key}", self.key), found, allowed)
    }

    fn check(&self, path: &Path, before: &[Self]) -> Result<(), InputError> {
        let require = |key: &str, found: String, holds: bool, allowed: &str| {
            if holds { Ok(()) } else { Err(self.refuse(path, key, found, allowed)) }
        };
        require("column", format!("{:?}", self.column), !self.column.trim().is_empty(), "a column's name")?;
        let again = before.iter().any(|other| other.column == self.column);
        require("column", format!("{:?} again", self.column), !again, "each column once")?;
        let height_m = self.height_m;
        let holds = height_m.is_finite() && height_m >= 0.0;
        require("height_m", height_m.to_string(), holds, "metres above the base, 0 for the table")?;
        let of_table = !self.is_table() || self.frame == Frame::Absolute;
        require(
            "frame",
            "the ground, at height 0".into(),
            of_table,
            "\"absolute\": the table's displacement",
        )?;
        let twin = before.iter().find(|other| (other.height_m - height_m).abs() < ONE_HEIGHT_M);
        let found = twin.map_or_else(String::new, |twin| format!("{height_m}, as column {:?}", twin.column));
        require("height_m", found, twin.is_none(), "each height once")?;
        let factor_holds = self.factor.is_finite() && self.factor != 0.0;
        require("factor", self.factor.to_string(), factor_holds, "metres a unit of the column, not 0")?;
        let noise_holds = self.noise_m.is_none_or(|noise| noise.is_finite() && noise > 0.0);
        require("noise_m", format!("{:?}", self.noise_m), noise_holds, "a finite number of metres above 0")
    }

    /// Refuses a height that the wall does not have, or that its top does not move at.
    pub(super) fn check_on_wall(&self, path: &Path, test: &TestTable, wall: &Wall) -> Result<(), InputError> {
        let top_m = wall.parameters().height_m;
        if self.height_m > top_m {
            let allowed = format!("metres above the base, up to the top of the wall at {top_m} m");
            return Err(self.refuse(path, "height_m", self.height_m.to_string(), &allowed));
        }
        if test.top_held && self.height_m == top_m {
            let found = format!("{top_m}, the top of test {:?}, which is held", test.name);
            return Err(self.refuse(path, "height_m", found, "heights below it, or no top_held"));
        }
        Ok(())
    }
}

/// Refuses channels of a test that cannot be, together or beside its other keys.
pub(super) fn check_channels(path: &Path, test: &TestTable) -> Result<(), InputError> {
    let channels = test.channels();
    for (i, channel) in channels.iter().enumerate() {
        channel.check(path, &channels[..i])?;
    }
    let Some(first) = channels.first() else { return Ok(()) };
    if test.lower_reading.is_some() || test.upper_reading.is_some() {
        let found = format!("channels beside lower_reading or upper_reading of {:?}", test.name);
        return Err(InputError::key(path, first.key.clone(), found, "one way to say what a column is"));
    }
    let absolute = |c: &&ChannelTable| c.frame == Frame::Absolute && !c.is_table();
    let table = channels.iter().find(|c| c.is_table());
    match (channels.iter().find(absolute), table) {
        (Some(channel), None) if test.record.is_none() => {
            let found = format!("\"absolute\", and test {:?} has no record", test.name);
            let allowed = "\"ground\", or a channel of the table beside it: height_m = 0";
            Err(channel.refuse(path, "frame", found, allowed))
        }
        (Some(channel), None) if test.start_s == StartTime::Match => {
            let found = format!("\"absolute\", and test {:?} has start_s = \"match\"", test.name);
            let allowed =
                "start_s in seconds: the table's displacement must be known; or a channel of the table";
            Err(channel.refuse(path, "frame", found, allowed))
        }
        (None, Some(table)) => {
            let found = "0, the table, which no channel needs".to_owned();
            Err(table.refuse(path, "height_m", found, "beside a channel with frame = \"absolute\""))
        }
        _ => Ok(()),
    }
}
