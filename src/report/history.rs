//! The page of a history file: rotations and patterns of one run.

use std::path::Path;

use super::chart::{Axis, Format, Graph, Layer, Mark, PALETTE, PATTERNS, Stretch};
use super::page::{Figure, Key, Link, Number, Page, Section};
use crate::error::{InputError, Result};
use crate::fragility::Table;
use mrbd_kernel::model::PATTERN_NAMES;

/// Rotations are shown in thousandths of a radian.
const MRAD: f64 = 1e3;

/// A history as it was stored.
struct Stored {
    time_s: Vec<f64>,
    theta_mrad: [Vec<f64>; 2],
    /// Index of each row's pattern in [`PATTERN_NAMES`].
    pattern: Vec<usize>,
}

/// The page of the history in a file of `mrbd simulate --history`.
///
/// # Errors
/// Input errors for a file that is no history; whatever drawing meets.
pub fn page(path: &Path) -> Result<Page> {
    let stored = Stored::read(path)?;
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let largest = |body: usize| stored.theta_mrad[body].iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let number = |value: f64, meaning: &str| Number::new(format!("{value:.2} mrad"), meaning);
    Ok(Page {
        title: format!("History {name}"),
        lead: format!("{} samples of one run.", stored.time_s.len()),
        numbers: vec![
            number(largest(0), "largest |θ₁| at a sample, lower body"),
            number(largest(1), "largest |θ₂| at a sample, upper body"),
        ],
        notes: vec![
            "A history holds rotations and patterns alone: `mrbd simulate --plot FILE.html` shows the wall in motion, impacts and the ground too.".into(),
        ],
        sections: vec![Section {
            id: "history".into(),
            title: "Rotations and patterns".into(),
            figures: vec![stored.figure(&name)],
            ..Section::default()
        }],
        files: vec![Link::to(&name)],
        ..Page::default()
    })
}

impl Stored {
    fn read(path: &Path) -> Result<Self> {
        let table = Table::read(path, &["time_s", "theta1_rad", "theta2_rad", "pattern"])?;
        let numbers = |name: &str| -> Result<Vec<f64>> {
            let numbers = table.numbers(name)?.into_iter().collect::<Option<Vec<_>>>();
            Ok(numbers.ok_or_else(|| {
                InputError::key(path, name, "a row without a value", "a number in every row")
            })?)
        };
        let index = |(row, name): (usize, String)| {
            let known = PATTERN_NAMES.iter().position(|known| *known == name);
            let allowed = format!("one of {}", PATTERN_NAMES.join(", "));
            known.ok_or_else(|| table.fault("pattern", row, format!("{name:?}"), &allowed))
        };
        let pattern =
            table.labels("pattern")?.into_iter().enumerate().map(index).collect::<Result<_, _>>()?;
        let mrad = |name: &str| -> Result<Vec<f64>> { Ok(numbers(name)?.iter().map(|x| MRAD * x).collect()) };
        Ok(Self {
            time_s: numbers("time_s")?,
            theta_mrad: [mrad("theta1_rad")?, mrad("theta2_rad")?],
            pattern,
        })
    }

    fn figure(&self, name: &str) -> Figure {
        let key = |label, colour| Key::new(label, colour, Mark::None);
        let mut legend = vec![key("θ₁, lower body", PALETTE[0]), key("θ₂, upper body", PALETTE[1])];
        let occurring = (0..PATTERNS.len()).filter(|index| self.pattern.contains(index));
        legend.extend(occurring.map(|index| key(PATTERN_NAMES[index], PATTERNS[index])));
        Figure {
            id: "history-figure".into(),
            title: "The whole run".into(),
            paper: Some("Figs. 7 to 9".into()),
            legend,
            panels: vec![self.rotations(), self.patterns()],
            wide: true,
            caption: "Rotations of both bodies, and below them the pattern: which corners they turn about."
                .into(),
            links: vec![Link::to(name)],
        }
    }

    fn time_axis(&self) -> Axis {
        let last_s = self.time_s.last().copied().unwrap_or(0.0);
        Axis::linear("time s", self.time_s.first().copied().unwrap_or(0.0), last_s)
    }

    fn rotations(&self) -> String {
        let line = |body: usize| Layer::Line {
            colour: PALETTE[body],
            width: 4,
            dashed: false,
            name: ["lower body", "upper body"][body].to_owned(),
            points: self.time_s.iter().copied().zip(self.theta_mrad[body].iter().copied()).collect(),
        };
        Graph {
            title: String::new(),
            format: Format::Wide,
            x: self.time_axis(),
            y: Axis::holding("rotation mrad", self.theta_mrad.iter().flatten().copied()),
            layers: vec![line(0), line(1)],
        }
        .svg()
    }

    fn patterns(&self) -> String {
        let mut stretches = Vec::new();
        let mut first = 0;
        for rows in self.pattern.chunk_by(|a, b| a == b) {
            let after = (first + rows.len()).min(self.time_s.len() - 1);
            let (from, to) = (self.time_s[first], self.time_s[after]);
            stretches.push(Stretch { from, to, colour: PATTERNS[rows[0]] });
            first += rows.len();
        }
        Graph {
            title: String::new(),
            format: Format::Strip,
            x: self.time_axis(),
            y: Axis::unmarked("pattern"),
            layers: vec![Layer::Stretches(stretches)],
        }
        .svg()
    }
}
