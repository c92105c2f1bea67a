//! The three models in time, under one record.

use std::path::Path;

use super::super::chart::{Axis, Format, Graph, Layer, Mark, of_curve};
use super::super::page::{Figure, Key, Link};
use crate::classics::comparison::MODELS;
use crate::error::Result;
use crate::fragility::Table;

/// Name of the file.
pub const FILE: &str = "histories.parquet";
/// Rotations beyond this are a collapse on its way, and not drawn.
const MOST: f64 = 1.5;

/// Rows of `histories.parquet`.
pub struct Histories {
    law: Vec<String>,
    record: Vec<String>,
    model: Vec<String>,
    scale: Vec<f64>,
    time_s: Vec<f64>,
    theta: [Vec<f64>; 2],
}

impl Histories {
    /// Reads them; `None` where the comparison was made before there were any.
    ///
    /// # Errors
    /// Input errors for a file that is no such table.
    pub fn read(folder: &Path) -> Result<Option<Self>> {
        let path = folder.join(FILE);
        if !path.is_file() {
            return Ok(None);
        }
        let names = ["law", "record", "model", "scale", "time_s", "theta1_over_alpha1", "theta2_over_alpha2"];
        let table = Table::read(&path, &names)?;
        let numbers = |name: &str| -> Result<Vec<f64>> {
            Ok(table.numbers(name)?.into_iter().map(|x| x.unwrap_or(f64::NAN)).collect())
        };
        Ok(Some(Self {
            law: table.labels("law")?,
            record: table.labels("record")?,
            model: table.labels("model")?,
            scale: numbers("scale")?,
            time_s: numbers("time_s")?,
            theta: [numbers("theta1_over_alpha1")?, numbers("theta2_over_alpha2")?],
        }))
    }

    /// The lowest and the highest scale under a law, both bodies; `None` without a row.
    pub fn figure(&self, law: &str) -> Option<Figure> {
        let own = (0..self.law.len()).filter(|&k| self.law[k] == law).collect::<Vec<_>>();
        let scales = own.iter().map(|&k| self.scale[k]);
        let (low, high) = scales.fold((f64::MAX, f64::MIN), |(a, b), scale| (a.min(scale), b.max(scale)));
        let record = own.first().map(|&k| self.record[k].clone())?;
        let mut chosen = vec![low, high];
        chosen.dedup();
        let panels = chosen.iter().flat_map(|&scale| [0, 1].map(|body| (scale, body)));
        let panels = panels.map(|(scale, body)| self.panel(&own, &record, scale, body));
        let key = |(index, model): (usize, &&str)| Key::new(*model, of_curve(index).0, Mark::None);
        Some(Figure {
            id: format!("histories-{law}"),
            title: format!("In time, under {record}"),
            paper: Some("Fig. 9".into()),
            legend: MODELS.iter().enumerate().map(key).collect(),
            panels: panels.collect(),
            wide: true,
            caption: "Of the records that the calibrated model stands most often, the one that turns it most, at the lowest and the highest factor; a line that ends is a wall that fell. All factors are in the file.".into(),
            links: vec![Link::to(FILE)],
        })
    }

    fn panel(&self, own: &[usize], record: &str, scale: f64, body: usize) -> String {
        let lines = MODELS.iter().enumerate().map(|(index, model)| {
            let rows = own.iter().filter(|&&k| self.model[k] == *model && self.scale[k] == scale);
            let points = rows.map(|&k| (self.time_s[k], self.theta[body][k]));
            Layer::Line {
                colour: of_curve(index).0,
                width: 4,
                dashed: false,
                name: (*model).to_owned(),
                points: points.take_while(|p| p.1.abs() <= MOST).collect(),
            }
        });
        let layers = lines.collect::<Vec<_>>();
        let points = || {
            layers.iter().flat_map(|layer| match layer {
                Layer::Line { points, .. } => &points[..],
                _ => &[],
            })
        };
        let end_s = points().map(|p| p.0).fold(0.0, f64::max);
        let y = Axis::holding(["θ₁/α₁", "θ₂/α₂"][body], points().map(|p| p.1));
        Graph {
            title: format!("{record} × {scale}"),
            format: Format::Low,
            x: Axis::linear("time s", 0.0, end_s),
            y,
            layers,
        }
        .svg()
    }
}
