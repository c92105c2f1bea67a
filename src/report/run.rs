//! One run: histories of rotations, patterns, impacts and ground motion, and the wall in motion.

mod histories;
mod plot_file;
mod watch;

pub use plot_file::PlotFile;
pub use watch::{ImpactMark, Watch};

use super::page::{Cell, Figure, Motion, Number, Page, Section, Table, script_safe};
use crate::error::Result;
use crate::results::PartResults;
use histories::Window;
use mrbd_kernel::model::{FurtherLaw, PATTERN_NAMES, Wall};
use mrbd_kernel::simulate::{Accuracy, Ensemble, Outcome, Response, Shaking, Verdict};

/// Everything a picture of a run is made from.
#[derive(Debug, Clone, Copy)]
pub struct RunPicture<'a> {
    /// The wall.
    pub wall: &'a Wall,
    /// Name of the wall, for titles.
    pub wall_name: &'a str,
    /// Its ground motion.
    pub shaking: &'a Shaking,
    /// Name of the record, for titles; `None` for a free release.
    pub record_name: Option<&'a str>,
    /// How accurately it was run.
    pub accuracy: Accuracy,
    /// What was seen of it.
    pub watch: &'a Watch,
    /// How it ended.
    pub response: &'a Response,
    /// The run and those beside it: digits are shown as far as they hold in all.
    pub ensemble: &'a Ensemble,
    /// How sure the outcome is, and whether the model applies, each a sentence.
    pub remarks: &'a [String],
    /// What each record of a sequence did; empty for a record by itself.
    pub parts: &'a [PartResults],
}

/// Histories shorter than this are not shown a second time from nearby, s.
const SHORT_S: f64 = 8.0;
/// What is shown from nearby before and after the largest rotation, s.
const NEARBY_S: (f64, f64) = (2.0, 3.0);

impl RunPicture<'_> {
    /// The histories as one SVG that stands alone.
    pub fn svg(&self) -> String {
        histories::stack(self, &self.whole()).svg()
    }

    /// The histories as one PNG, 2400 pixels wide.
    ///
    /// # Errors
    /// [`crate::Error::Picture`] if plotters refuses.
    pub fn png(&self) -> Result<Vec<u8>> {
        histories::stack(self, &self.whole()).png()
    }

    /// The page of the run: the wall in motion, histories, numbers.
    ///
    /// # Errors
    /// [`crate::Error::Picture`] if the template refuses.
    pub fn html(&self) -> Result<String> {
        let page = Page {
            title: self.title(),
            lead: self.outcome(),
            numbers: self.numbers(),
            notes: self.notes(),
            sections: self.sections(),
            provenance: self.provenance(),
            ..Page::default()
        };
        page.html()
    }

    fn sections(&self) -> Vec<Section> {
        let parts = (!self.parts.is_empty()).then(|| self.part_section());
        let whole = [self.motion_section(), self.history_section()].into_iter();
        whole.chain(parts).chain([self.number_section()]).collect()
    }

    fn part_section(&self) -> Section {
        let row = |(part, number): (&PartResults, usize)| {
            let alone = part.told_alone().unwrap_or_else(|| "as it is".to_owned());
            vec![
                number.to_string(),
                part.record.clone(),
                format!("{:.2} s", part.start_s),
                part.told(),
                alone,
            ]
        };
        let head =
            ["part", "record", "begins at", "|θ₁|/α₁ and |θ₂|/α₂", "the record on the wall as it was built"];
        Section {
            id: "parts".into(),
            title: "Part by part".into(),
            text: vec!["Carried from one record to the next: rotations, velocities, the contact state and what a yielding spring has yielded. Corners keep their widths.".into()],
            tables: vec![Table::of("Largest rotations of each part of this run", &head, self.parts.iter().zip(1..).map(row))],
            ..Section::default()
        }
    }

    fn title(&self) -> String {
        match self.record_name {
            Some(record) => format!("{} under {record}", self.wall_name),
            None => format!("{}, free release", self.wall_name),
        }
    }

    fn outcome(&self) -> String {
        match &self.response.outcome {
            _ if self.ensemble.verdict() == Verdict::Undecided => {
                "Undecided: the wall stands or falls by what nobody can know. Here is one of its runs."
                    .to_owned()
            }
            Outcome::Stood => format!("The wall stood until the end at {:.2} s.", self.response.end_time_s),
            Outcome::Collapsed { .. } => format!("The wall collapsed at {} s.", self.held(|r| r.end_time_s)),
            Outcome::Failed { time_s, reason } => format!("The run failed at {time_s:.3} s: {reason}."),
        }
    }

    fn numbers(&self) -> Vec<Number> {
        let [lower, upper] = [0, 1].map(|i| self.held(|r| r.theta_max_over_alpha_i()[i]));
        let mut numbers = match self.wall.is_cracked() {
            true => vec![
                Number::new(lower, "largest |θ₁|/α₁, lower body"),
                Number::new(upper, "largest |θ₂|/α₂, upper body"),
            ],
            false => vec![Number::new(lower, "largest |θ|/α")],
        };
        let top_mm = self.held(|r| 1e3 * r.top_displacement_m.value.abs());
        numbers.push(Number::new(format!("{top_mm} mm"), "largest displacement of the top"));
        numbers.push(Number::new(self.ensemble.count(|r| r.impacts.total()), "impacts"));
        numbers
    }

    /// A result with the digits that hold, or three decimals of a run that is alone.
    fn held(&self, value: impl Fn(&Response) -> f64) -> String {
        self.held_to(3, value)
    }

    fn held_to(&self, decimals: usize, value: impl Fn(&Response) -> f64) -> String {
        let all = format!("{:.decimals$}", value(self.response));
        let held = self.ensemble.text(value);
        // Of digits that hold, a reader needs no more than these.
        let longer = !held.contains(" to ") && held.len() > all.len();
        if self.ensemble.others.is_empty() || longer { all } else { held }
    }

    fn notes(&self) -> Vec<String> {
        let restitution = self.wall.parameters().restitution;
        let mut notes = self.remarks.to_vec();
        notes.push(format!(
            "Assumed: impact law “{}”, capture velocity {:e} rad/s, collapse at {} αᵢ.",
            restitution.law.name(),
            restitution.capture_velocity_rad_s,
            self.wall.parameters().collapse_rotation_ratio
        ));
        if self.shaking.vertical.is_some() {
            notes.push("The vertical component acted too; the figures show the horizontal one.".into());
        }
        let tensions: u64 = self.response.demand.iter().map(|demand| demand.tensions).sum();
        if tensions > 0 {
            notes.push(format!(
                "A pivot came under tension {tensions} times: there a real wall would have left the ground, which the model forbids."
            ));
        }
        notes
    }

    fn motion_section(&self) -> Section {
        Section {
            id: "motion".into(),
            title: "The wall in motion".into(),
            text: vec![
                "Rotations are drawn larger than they are; corners that touch stay in contact at any magnification. An impact flashes where it strikes.".into(),
            ],
            motion: Some(Motion { data: script_safe(&watch::motion(self)) }),
            ..Section::default()
        }
    }

    fn history_section(&self) -> Section {
        let figure = |id: &str, title: &str, window: &Window| {
            Figure {
                id: id.into(),
                title: title.into(),
                paper: Some("Figs. 7 to 9".into()),
                panels: vec![histories::stack(self, window).svg()],
                wide: true,
                caption: "From above: rotations over slenderness angles; pattern; impacts, higher the faster they close; ground acceleration.".into(),
                ..Figure::default()
            }
        };
        let mut figures = vec![figure("history", "The whole run", &self.whole())];
        if let Some(window) = self.nearby() {
            figures.push(figure("nearby", "Around the largest rotation", &window));
        }
        Section { id: "histories".into(), title: "Histories".into(), figures, ..Section::default() }
    }

    fn number_section(&self) -> Section {
        let r = self.response;
        let row = |name: &str, value: String| vec![Cell::from(name.to_owned()), Cell::from(value)];
        let peak = |i: usize| {
            let size = self.held_to(6, |r| r.theta_max_rad[i].value.abs());
            let time_s = self.held(|r| r.theta_max_rad[i].time_s);
            format!("{size} rad at {time_s} s; α = {:.5} rad", r.alpha_i_rad[i])
        };
        let patterns = (0..PATTERN_NAMES.len()).filter(|&i| r.pattern_time_s[i] > 0.0);
        let time_s = |i: usize| format!("{} {} s", PATTERN_NAMES[i], self.held(|r| r.pattern_time_s[i]));
        let patterns: Vec<String> = patterns.map(time_s).collect();
        let mut rows = vec![row("largest |θ₁|", peak(0))];
        if self.wall.is_cracked() {
            rows.push(row("largest |θ₂|", peak(1)));
        }
        rows.push(row("time in patterns", patterns.join(", ")));
        let captured = self.ensemble.count(|r| r.impacts.captured);
        rows.push(row(
            "impacts",
            format!("{}, {captured} captured", self.ensemble.count(|r| r.impacts.total())),
        ));
        rows.push(row("openings", self.ensemble.count(|r| r.openings.total())));
        rows.push(row("friction needed at the ground", self.held(|r| r.demand[0].friction)));
        if self.wall.is_cracked() {
            rows.push(row("friction needed at the crack", self.held(|r| r.demand[1].friction)));
        }
        rows.push(row(
            "energy not accounted for",
            format!("{:.1e} of what passed through", r.energy.residual()),
        ));
        Section {
            id: "numbers".into(),
            title: "Numbers".into(),
            tables: vec![Table {
                caption: "With the digits that hold, or as intervals of the runs beside this one. Maxima are true maxima, between samples too".into(),
                head: vec!["quantity".into(), "value".into()],
                prose: false,
                rows,
            }],
            ..Section::default()
        }
    }

    fn provenance(&self) -> Vec<(String, String)> {
        let p = self.wall.parameters();
        let [lower_width_m, upper_width_m] = self.wall.width_m();
        let effects = match &p.further_laws()[..] {
            [] => "none".to_owned(),
            laws => laws.iter().map(FurtherLaw::to_string).collect::<Vec<_>>().join(", "),
        };
        let pair = |name: &str, value: String| (name.to_owned(), value);
        let crack = p.crack_height_m.map_or("uncracked".to_owned(), |h1| format!("crack at {h1} m"));
        vec![
            pair("program", format!("mrbd {}", env!("CARGO_PKG_VERSION"))),
            pair(
                "wall",
                format!(
                    "{}: {} m thick, {} m high, {crack}, {} kg",
                    self.wall_name, p.thickness_m, p.height_m, p.mass_kg
                ),
            ),
            pair(
                "corners",
                format!("{:.4} m apart at the ground, {:.4} m at the crack", lower_width_m, upper_width_m),
            ),
            pair(
                "floor",
                format!(
                    "{} kg, carriage {} kg, {} N/m",
                    p.diaphragm_mass_kg, p.carriage_mass_kg, p.stiffness_n_per_m
                ),
            ),
            pair("coefficients C_l", format!("{:?}", self.wall.coefficients())),
            pair("further effects", effects),
            pair("record", self.record_name.unwrap_or("none, a free release").to_owned()),
            pair("tolerance", format!("{:e} of αᵢ", self.accuracy.tolerance)),
        ]
    }

    fn whole(&self) -> Window {
        let last_s = self.watch.history.rows.last().map_or(0.0, |row| row.time_s);
        Window { from_s: 0.0, to_s: last_s.max(self.response.end_time_s).max(self.watch.history.step_s()) }
    }

    /// The seconds around the largest rotation, or before the collapse.
    fn nearby(&self) -> Option<Window> {
        let whole = self.whole();
        if whole.to_s < SHORT_S {
            return None;
        }
        let ratios = self.response.theta_max_over_alpha_i();
        let larger = usize::from(ratios[1] > ratios[0]);
        let peak_s = self.response.theta_max_rad[larger].time_s;
        let from_s = (peak_s - NEARBY_S.0).min(whole.to_s - NEARBY_S.0 - NEARBY_S.1).max(0.0);
        Some(Window { from_s, to_s: (from_s + NEARBY_S.0 + NEARBY_S.1).min(whole.to_s) })
    }
}
