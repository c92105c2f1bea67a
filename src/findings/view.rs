//! The medians of one variant, as the findings ask for them.

use crate::aggregate::{Measure, Median, Medians, Middle};
use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::survey::Configuration;

/// Above this h_tot / b a façade is slender: where the source's last conclusion draws the line.
const SLENDER_ABOVE: f64 = 14.0;

/// Which slendernesses a claim is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slender {
    /// h_tot / b up to 14.
    Moderate,
    /// h_tot / b above 14.
    Large,
    /// All of them.
    Any,
}

impl Slender {
    /// Whether a slenderness is one of them.
    pub fn holds(self, slenderness: f64) -> bool {
        match self {
            Slender::Moderate => slenderness <= SLENDER_ABOVE,
            Slender::Large => slenderness > SLENDER_ABOVE,
            Slender::Any => true,
        }
    }

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Slender::Moderate => "slenderness h/b ≤ 14",
            Slender::Large => "slenderness h/b > 14",
            Slender::Any => "slenderness",
        }
    }
}

/// The medians of one variant.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    medians: &'a Medians,
    variant: &'a str,
    /// Its place among the variants; `None` of one without medians.
    place: Option<usize>,
}

/// One point of a curve: a slenderness and a body.
pub type Point = (f64, Measure);

impl<'a> View<'a> {
    /// The medians of a variant of a study.
    pub fn new(medians: &'a Medians, variant: &'a str) -> Self {
        Self { medians, variant, place: medians.variant(variant) }
    }

    /// Name of the variant.
    pub fn variant(&self) -> &'a str {
        self.variant
    }

    /// All rows of the variant.
    pub fn rows(&self) -> impl Iterator<Item = &'a Median> {
        self.place.into_iter().flat_map(|place| self.medians.rows_of(place))
    }

    /// Slendernesses of the study, increasing.
    pub fn slendernesses(&self, which: Slender) -> Vec<f64> {
        let all = self.medians.slendernesses().iter().copied();
        all.filter(|&slenderness| which.holds(slenderness)).collect()
    }

    /// Both bodies at these slendernesses.
    pub fn points(&self, which: Slender) -> Vec<Point> {
        let bodies = |slenderness: f64| Measure::BODIES.map(|body| (slenderness, body));
        self.slendernesses(which).into_iter().flat_map(bodies).collect()
    }

    /// The row of a case; `None` if the study has no such case.
    pub fn row(
        &self,
        configuration: Configuration,
        parameter: Parameter,
        level: Level,
        point: Point,
    ) -> Option<&'a Median> {
        self.medians.row(self.place?, (configuration, parameter, level), point)
    }

    /// The median of a case.
    pub fn middle(
        &self,
        configuration: Configuration,
        parameter: Parameter,
        level: Level,
        point: Point,
    ) -> Option<Middle> {
        self.row(configuration, parameter, level, point)?.middle()
    }

    /// Parameters of a configuration, in the order of the plan.
    pub fn parameters(&self, configuration: Configuration) -> Vec<Parameter> {
        self.of_floor(configuration).collect()
    }

    fn of_floor(&self, configuration: Configuration) -> impl Iterator<Item = Parameter> {
        let all = self.place.map_or(&[][..], |place| self.medians.parameters(place));
        all.iter().filter(move |(floor, _)| *floor == configuration).map(|&(_, parameter)| parameter)
    }

    /// Parameters that both configurations have.
    pub fn shared_parameters(&self) -> Vec<Parameter> {
        let parallel = self.parameters(Configuration::Parallel);
        let perpendicular = self.parameters(Configuration::Perpendicular);
        perpendicular.into_iter().filter(|parameter| parallel.contains(parameter)).collect()
    }

    /// The row of the reference façade, all parameters at their means: every parameter's curve holds it.
    pub fn reference(&self, configuration: Configuration, point: Point) -> Option<&'a Median> {
        let any = self.of_floor(configuration).next()?;
        self.row(configuration, any, Level::Mean, point)
    }

    /// The levels with the smallest and the largest value of a parameter: the source lists the crack heights downwards.
    pub fn smallest_and_largest(&self, configuration: Configuration, parameter: Parameter) -> (Level, Level) {
        let value = |level: Level| {
            let points =
                self.medians.slendernesses().iter().map(|&slenderness| (slenderness, Measure::LowerOwn));
            let mut rows = points.filter_map(|point| self.row(configuration, parameter, level, point));
            rows.next().and_then(|row| row.parameter_value)
        };
        match (value(Level::Low), value(Level::High)) {
            (Some(low), Some(high)) if high < low => (Level::High, Level::Low),
            _ => (Level::Low, Level::High),
        }
    }

    /// Medians at the smallest and the largest value of a parameter.
    pub fn ends(
        &self,
        configuration: Configuration,
        parameter: Parameter,
        point: Point,
    ) -> (Option<Middle>, Option<Middle>) {
        let (smallest, largest) = self.smallest_and_largest(configuration, parameter);
        (
            self.middle(configuration, parameter, smallest, point),
            self.middle(configuration, parameter, largest, point),
        )
    }
}
