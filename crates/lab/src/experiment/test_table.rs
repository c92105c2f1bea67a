//! A test of an experiment file: how the wall was shaken, what was measured, and what of it counts.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::channel_table::{ChannelTable, check_channels};
use mrbd_files::error::InputError;

/// `[[tests]]`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TestTable {
    /// Name in results.
    pub name: String,
    /// Horizontal record of the table; absent: a free release, with `release_s`.
    pub record: Option<PathBuf>,
    /// Time between samples of records that do not tell it, s.
    pub record_step_s: Option<f64>,
    /// Factor on the record.
    #[serde(default = "one")]
    pub scale: f64,
    /// Vertical record of the table, at the same step; absent: none.
    pub vertical: Option<PathBuf>,
    /// Factor on the vertical record; absent: that on the horizontal one.
    pub vertical_scale: Option<f64>,
    /// Measured channels (CSV).
    pub measured: PathBuf,
    /// Whether the search sees the test.
    #[serde(default, rename = "use")]
    pub purpose: Purpose,
    /// Time of the record at which the measured time is zero, s, or `"match"`: found from the first motion.
    #[serde(default)]
    pub start_s: StartTime,
    /// The first seconds of the measurement, at rest, whose mean is taken off every channel; 0: nothing is.
    #[serde(default)]
    pub rest_s: f64,
    /// Samples farther apart than this leave a gap; absent: 2.5 times their median distance, s.
    pub gap_s: Option<f64>,
    /// Stretches of the record's time that count in the misfit, s; empty: everything measured.
    #[serde(default)]
    pub windows_s: Vec<[f64; 2]>,
    /// When the wall collapsed, in the record's time, s; absent: when a rotation passes its collapse rotation.
    pub collapse_s: Option<f64>,
    /// Time from which the wall moves by itself, in the record's time, s. The simulation starts there from the
    /// measured state; what comes before, by hand or by a jack, is not judged. Absent: from rest, with the record.
    pub release_s: Option<f64>,
    /// Whether the top is held sideways: then it does not move, and θ_2 follows from θ_1.
    #[serde(default)]
    pub top_held: bool,
    /// Reading of a displacement of the lower body, from which θ_1 follows.
    pub lower_reading: Option<Reading>,
    /// Reading of a displacement of the upper body, from which θ_2 follows.
    pub upper_reading: Option<Reading>,
    /// Its transducers; absent: those of the experiment.
    pub channels: Option<Vec<ChannelTable>>,
}

fn one() -> f64 {
    1.0
}

impl TestTable {
    /// Its transducers.
    pub fn channels(&self) -> &[ChannelTable] {
        self.channels.as_deref().unwrap_or_default()
    }

    /// Time of the record at which the measured time is zero, s; 0 where it is to be found.
    pub fn given_start_s(&self) -> f64 {
        match self.start_s {
            StartTime::Given(start_s) => start_s,
            StartTime::Match => 0.0,
        }
    }

    pub(super) fn check(&self, path: &Path, index: usize) -> Result<(), InputError> {
        let require = |key: &str, found: String, holds: bool, allowed: &str| {
            let error = || InputError::key(path, format!("tests[{index}].{key}"), found, allowed);
            if holds { Ok(()) } else { Err(error()) }
        };
        require("name", format!("{:?}", self.name), !self.name.trim().is_empty(), "a name")?;
        let found = "no record and no release_s".to_owned();
        let moves = self.record.is_some() || self.release_s.is_some();
        require("record", found, moves, "a record, or release_s: when a wall without one is let go, s")?;
        let release_holds = self.release_s.is_none_or(|s| s.is_finite() && s >= 0.0);
        require(
            "release_s",
            format!("{:?}", self.release_s),
            release_holds,
            "a finite number of seconds, 0 or more",
        )?;
        let held_holds = !(self.top_held && self.upper_reading.is_some());
        require("top_held", "true beside upper_reading".to_owned(), held_holds, "one of both")?;
        let vertical_holds = self.vertical.is_none() || self.record.is_some();
        require(
            "vertical",
            format!("{:?}", self.vertical),
            vertical_holds,
            "a vertical record beside a horizontal one",
        )?;
        let match_holds = self.start_s != StartTime::Match || self.release_s.is_none();
        require(
            "start_s",
            "\"match\" beside release_s".to_owned(),
            match_holds,
            "seconds: there is no beginning to match",
        )?;
        require("scale", self.scale.to_string(), self.scale.is_finite(), "a finite number")?;
        let vertical_scale = self.vertical_scale;
        let holds = vertical_scale.is_none_or(|x| x.is_finite() && self.vertical.is_some());
        require(
            "vertical_scale",
            format!("{vertical_scale:?}"),
            holds,
            "a finite number, beside a vertical record",
        )?;
        let rest_holds = self.rest_s.is_finite() && self.rest_s >= 0.0;
        require("rest_s", self.rest_s.to_string(), rest_holds, "a finite number of seconds, 0 or more")?;
        let gap_holds = self.gap_s.is_none_or(|gap| gap.is_finite() && gap > 0.0);
        require("gap_s", format!("{:?}", self.gap_s), gap_holds, "a finite number of seconds above 0")?;
        let collapse_holds = self.collapse_s.is_none_or(|s| s.is_finite() && s > 0.0);
        require("collapse_s", format!("{:?}", self.collapse_s), collapse_holds, "a finite number above 0")?;
        for window in &self.windows_s {
            let holds = window[0].is_finite() && window[1].is_finite() && window[0] < window[1];
            require("windows_s", format!("{window:?}"), holds, "pairs [from, to] with from < to, s")?;
        }
        let ordered = self.windows_s.windows(2).all(|pair| pair[0][1] <= pair[1][0]);
        require(
            "windows_s",
            format!("{:?}", self.windows_s),
            ordered,
            "stretches in order that do not overlap",
        )?;
        check_channels(path, self)
    }
}

/// When a measurement started.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StartTime {
    /// Time of the record at which the measured time is zero, s.
    Given(f64),
    /// Where the first simulated motion fits best.
    Match,
}

impl Default for StartTime {
    fn default() -> Self {
        StartTime::Given(0.0)
    }
}

impl<'de> Deserialize<'de> for StartTime {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        let refuse = |found: String| {
            serde::de::Error::custom(format!("start_s: found {found}, allowed: finite seconds, or \"match\""))
        };
        match toml::Value::deserialize(deserializer)? {
            toml::Value::Float(start_s) if start_s.is_finite() => Ok(StartTime::Given(start_s)),
            toml::Value::Integer(start_s) => Ok(StartTime::Given(start_s as f64)),
            toml::Value::String(word) if word == "match" => Ok(StartTime::Match),
            other => Err(refuse(other.to_string())),
        }
    }
}

/// A horizontal displacement relative to the table, m.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reading {
    /// Column of the measured file.
    pub column: String,
    /// Height of the reading above the base of the wall, m.
    pub height_m: f64,
}

/// Whether the search sees a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Purpose {
    /// It does.
    #[default]
    Fit,
    /// It does not; its misfit shows how the result predicts.
    HoldOut,
}

impl Purpose {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Purpose::Fit => "fit",
            Purpose::HoldOut => "hold-out",
        }
    }
}
