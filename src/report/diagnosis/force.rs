//! The missing force: where it acts, and of what shape it is.

use std::path::Path;

use super::super::axis::Axis;
use super::super::colours::{Colour, Mark, PALETTE, PATTERNS};
use super::super::graph::{Dot, Format, Graph, Layer};
use super::super::page::{Figure, Link, Section, Table};
use super::histories::Histories;
use super::parting::shows_after;
use super::stored::{Columns, Stored, StoredRival};
use super::words::at;
use super::{AFTER, BEFORE, MEASURED, key};
use crate::error::Result;
use crate::model::PATTERN_NAMES;

/// Least share off the direction of the top beyond which a force there alone does not explain the residual.
const OFF: f64 = 0.1;
/// Fewest points with a direction to speak of one.
const LEAST_POINTS: u64 = 3;
/// What of the top's motion the force is drawn against: column and label.
const AGAINST: [(&str, &str); 3] = [
    ("displacement_m", "displacement of the top m"),
    ("velocity_m_s", "velocity of the top m/s"),
    ("acceleration_m_s2", "absolute acceleration of the top m/s²"),
];
/// Colours of laws, none of them that of points.
const LAWS: [Colour; 4] = [PALETTE[2], PALETTE[3], PALETTE[4], PALETTE[5]];

/// What a hypothesis adds to the force at the top.
struct Law {
    name: String,
    /// Index into [`AGAINST`].
    which: usize,
    points: Vec<(f64, f64)>,
}

/// `force.parquet` and `laws.parquet`.
pub struct Points {
    test: Vec<String>,
    pattern: Vec<String>,
    time_s: Vec<f64>,
    against: [Vec<f64>; 3],
    moment: [Vec<f64>; 2],
    force_n: Vec<f64>,
    sd_n: Vec<f64>,
    share: Vec<f64>,
    after_n: Vec<f64>,
    laws: Vec<Law>,
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

    fn rows(&self) -> std::ops::Range<usize> {
        0..self.force_n.len()
    }

    fn tip(&self, k: usize) -> String {
        format!(
            "{}, {:.2} s, pattern {}\nforce {:.0} ± {:.0} N",
            self.test[k], self.time_s[k], self.pattern[k], self.force_n[k], self.sd_n[k]
        )
    }

    /// Force in time in one test, with its standard deviations.
    fn in_time(&self, test: &str, histories: &Histories, stored: &Stored) -> Result<String> {
        let own = self.rows().filter(|&k| self.test[k] == test).collect::<Vec<_>>();
        let [from_s, to_s] = histories.motion_s(test);
        let y = Axis::holding("missing force at the top N", self.force_n.iter().copied());
        let mut layers = Vec::new();
        for (pattern, from, to) in histories.patterns(test) {
            // A strip along the upper edge; the light between patterns is doubt, which impacts leave.
            let spans = vec![[(from.max(from_s), y.ends()[1]), (to.min(to_s), y.ends()[1])]];
            if from < to_s && to > from_s {
                layers.push(Layer::Spans { colour: PATTERNS[pattern], width: 14, spans });
            }
        }
        let ends = |&k: &usize| {
            let of = |sign: f64| (self.time_s[k], self.force_n[k] + sign * self.sd_n[k]);
            [of(-1.0), of(1.0)]
        };
        layers.push(Layer::Spans { colour: BEFORE, width: 1, spans: own.iter().map(ends).collect() });
        let dots = |colour, mark, y: &[f64]| Layer::Dots {
            colour,
            mark,
            size: 4,
            hollow: false,
            dots: own
                .iter()
                .filter(|&&k| y[k].is_finite())
                .map(|&k| Dot { x: self.time_s[k], y: y[k], tip: self.tip(k) })
                .collect(),
        };
        layers.push(dots(BEFORE, Mark::Circle, &self.force_n));
        if shows_after(stored) {
            layers.push(dots(AFTER, Mark::Square, &self.after_n));
        }
        Graph {
            title: test.to_owned(),
            format: Format::Half,
            x: Axis::linear("time s", from_s, to_s),
            y,
            layers,
        }
        .svg()
    }

    /// The moment pairs of patterns 1 and 2, and the direction of a force at the top.
    fn direction(&self, stored: &Stored) -> Result<Option<Figure>> {
        let pairs = self.rows().filter(|&k| self.share[k].is_finite()).collect::<Vec<_>>();
        if pairs.is_empty() {
            return Ok(None);
        }
        let kn_m = |body: usize, k: usize| 1e-3 * self.moment[body][k];
        let largest = pairs.iter().flat_map(|&k| [kn_m(0, k).abs(), kn_m(1, k).abs()]).fold(0.0, f64::max);
        let [y_q, y_c] = stored.missing_force.arms_of_top_m;
        let reach = largest / y_q.max(y_c);
        let top = Layer::Line {
            colour: MEASURED,
            width: 2,
            dashed: true,
            name: "a horizontal force at the top".into(),
            points: vec![(-reach * y_q, -reach * y_c), (0.0, 0.0), (reach * y_q, reach * y_c)],
        };
        let dot = |&k: &usize| Dot {
            x: kn_m(0, k),
            y: kn_m(1, k),
            tip: format!("{}\nshare off the top {:.3}", self.tip(k), self.share[k]),
        };
        let dots = pairs.iter().map(dot).collect();
        let layers =
            vec![top, Layer::Dots { colour: BEFORE, mark: Mark::Circle, size: 5, hollow: false, dots }];
        let axis = |label: &str| Axis::linear(label, -1.05 * largest, 1.05 * largest);
        let graph = Graph {
            title: String::new(),
            format: Format::Half,
            x: axis("missing moment on θ₁ kN m"),
            y: axis("on θ₂ kN m"),
            layers,
        };
        Ok(Some(Figure {
            id: "direction".into(),
            title: "Direction of what is missing, patterns 1 and 2".into(),
            legend: vec![
                key("missing moments", BEFORE, Mark::Circle),
                key("a horizontal force at the top", MEASURED, Mark::None),
            ],
            panels: vec![graph.svg()?],
            caption: "Where both bodies turn apart, the equations of motion lack a pair of moments. A horizontal force at the top makes pairs along the line.".into(),
            links: vec![Link::to("force.parquet")],
            ..Figure::default()
        }))
    }

    fn shape(&self, which: usize, stored: &Stored) -> Result<String> {
        let x = &self.against[which];
        let dots = |colour, mark, size, y: &[f64]| Layer::Dots {
            colour,
            mark,
            size,
            hollow: false,
            dots: self
                .rows()
                .filter(|&k| y[k].is_finite())
                .map(|k| Dot { x: x[k], y: y[k], tip: self.tip(k) })
                .collect(),
        };
        let mut layers = Vec::new();
        if shows_after(stored) {
            layers.push(dots(AFTER, Mark::Square, 3, &self.after_n));
        }
        layers.push(dots(BEFORE, Mark::Circle, 3, &self.force_n));
        let names = self.law_names();
        let y = Axis::holding("missing force at the top N", self.force_n.iter().copied());
        for Law { name, points, .. } in self.laws.iter().filter(|law| law.which == which) {
            // A law may go far beyond what was measured.
            let inside = points.iter().map(|&(x, f)| (x, if y.holds(f) { f } else { f64::NAN }));
            layers.push(Layer::Line {
                colour: colour(&names, name),
                width: 3,
                dashed: false,
                name: name.clone(),
                points: inside.collect(),
            });
        }
        let largest = x.iter().fold(0.0, |most: f64, x| most.max(x.abs())).max(f64::MIN_POSITIVE);
        Graph {
            title: String::new(),
            format: Format::Half,
            x: Axis::linear(AGAINST[which].1, -1.03 * largest, 1.03 * largest),
            y,
            layers,
        }
        .svg()
    }

    /// Hypotheses with a law, each once.
    fn law_names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for Law { name, .. } in &self.laws {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        names
    }
}

fn colour(names: &[&str], name: &str) -> Colour {
    LAWS[names.iter().position(|known| *known == name).unwrap_or(0) % LAWS.len()]
}

fn laws(path: &Path) -> Result<Vec<Law>> {
    let columns = Columns::read(path, &["name", "against", "x", "force_n"])?;
    let (names, against) = (columns.labels("name")?, columns.labels("against")?);
    let (x, force_n) = (columns.numbers("x")?, columns.numbers("force_n")?);
    let mut laws: Vec<Law> = Vec::new();
    for k in 0..names.len() {
        let Some(which) = AGAINST.iter().position(|(name, _)| *name == against[k]) else { continue };
        match laws.last_mut().filter(|law| law.name == names[k] && law.which == which) {
            Some(law) => law.points.push((x[k], force_n[k])),
            None => laws.push(Law { name: names[k].clone(), which, points: vec![(x[k], force_n[k])] }),
        }
    }
    Ok(laws)
}

/// Where the missing force acts.
///
/// # Errors
/// [`crate::Error::Picture`] if plotters refuses.
pub fn place_section(points: &Points, histories: &Histories, stored: &Stored) -> Result<Section> {
    let mut figures = Vec::new();
    if !points.force_n.is_empty() {
        let mut tests: Vec<&String> = points.test.iter().collect();
        tests.dedup();
        let mut legend = vec![key("missing in the wall as given", BEFORE, Mark::Circle)];
        if shows_after(stored) {
            legend.push(key("left by the updated wall", AFTER, Mark::Square));
        }
        let spans = tests.iter().flat_map(|test| histories.patterns(test)).collect::<Vec<_>>();
        let occurring = (0..PATTERNS.len()).filter(|index| spans.iter().any(|span| span.0 == *index));
        legend.extend(occurring.map(|index| key(PATTERN_NAMES[index], PATTERNS[index], Mark::None)));
        figures.push(Figure {
            id: "force-in-time".into(),
            title: "The missing force, in time".into(),
            legend,
            panels: tests.into_iter().map(|test| points.in_time(test, histories, stored)).collect::<Result<_>>()?,
            caption: "Measured rotations between impacts, put into the equations of motion (in their weak form, so that no noise is differentiated), leave this horizontal force at the top; bars are standard deviations by the noise. Along the upper edge the measured pattern; where it changes, an impact or an opening lies in the gap.".into(),
            links: vec![Link::to("force.parquet")],
            ..Figure::default()
        });
        figures.extend(points.direction(stored)?);
    }
    Ok(Section {
        id: "place".into(),
        title: "Where the missing force acts".into(),
        text: vec![direction_in_words(stored), size_in_words(stored)],
        figures,
        tables: vec![places(stored)],
        ..Section::default()
    })
}

fn direction_in_words(stored: &Stored) -> String {
    let force = &stored.missing_force;
    match force.median_share_off_top {
        Some(share) if force.points_with_direction >= LEAST_POINTS => format!(
            "Off the direction of a horizontal force at the top lies {share:.3} of the squared moments (median of {} stretches clear of the noise): {}.",
            force.points_with_direction,
            if share < OFF {
                "what is missing acts at the top, as far as smooth motion tells"
            } else {
                "a force at the top alone does not explain it"
            }
        ),
        _ => format!(
            "Only {} stretches of patterns 1 and 2 stand clear of the noise: the direction of what is missing is not known from smooth motion.",
            force.points_with_direction
        ),
    }
}

fn size_in_words(stored: &Stored) -> String {
    let force = &stored.missing_force;
    let mut text = format!(
        "Over {} stretches the missing force is {:.0} N (root mean square) where noise alone would make {:.0} N",
        force.points, force.before.rms_n, force.before.noise_rms_n
    );
    if shows_after(stored) {
        text += &format!(
            "; the updated wall leaves {:.0} N of {:.0} N",
            force.after.rms_n, force.after.noise_rms_n
        );
    }
    text + "."
}

/// The best hypothesis of each place.
fn places(stored: &Stored) -> Table {
    let mut best: Vec<&StoredRival> = Vec::new();
    for rival in stored.rivals.iter().filter(|r| r.name != "placebo" && !r.name.contains(" + ")) {
        if !best.iter().any(|known| known.place == rival.place) {
            best.push(rival);
        }
    }
    let whole = stored.against.as_ref().and_then(|a| a.recalibrated);
    let row = |rival: &&StoredRival| {
        let error = |x: Option<f64>| x.map_or("–".to_owned(), |x| format!("{x:.2}"));
        let share = whole.filter(|w| *w > 0.0).map(|w| (w - rival.against.all) / w);
        vec![
            rival.place.as_deref().map_or("–".to_owned(), at),
            rival.name.clone(),
            share.map_or("–".to_owned(), |share| format!("{:.0} %", 100.0 * share.max(0.0))),
            error(rival.windowed_error.fit),
            error(rival.windowed_error.held_out),
        ]
    };
    let head =
        ["place", "best there", "of what speaks against the wall it takes away", "error, fit", "held out"];
    Table::of("Places, by the best single addition to the wall", &head, best.iter().map(row))
}

/// Which quantity the force is a curve of.
fn explained(stored: &Stored) -> String {
    let by = |(name, label): &(&str, &str)| {
        let share = stored.missing_force.explained_by.get(*name).copied().flatten()?;
        let label = label.rsplit_once(' ').map_or(*label, |(label, _)| label);
        Some(format!("{:.0} % against the {label}", 100.0 * share.max(0.0)))
    };
    let shares = AGAINST.iter().map(by).collect::<Option<Vec<_>>>();
    match shares {
        Some(shares) => format!(
            "Whatever its form, a curve through neighbouring points explains of the squared force {} (each point told by the others; more than one of them where two quantities go together, as displacement and acceleration do).",
            shares.join(", ")
        ),
        None => "The force is hardly more than its noise: it has no shape to be told.".to_owned(),
    }
}

/// What shape the missing force has.
///
/// # Errors
/// [`crate::Error::Picture`] if plotters refuses.
pub fn shape_section(points: &Points, stored: &Stored) -> Result<Section> {
    let mut section = Section {
        id: "shape".into(),
        title: "What shape it has".into(),
        text: vec![
            "The measured force against what the top does, with the laws of the best candidates drawn through. A law lines up its points in one of the three; a cloud without a line is no law of that quantity alone.".into(),
        ],
        ..Section::default()
    };
    if points.force_n.is_empty() {
        section.text = vec!["No stretch between impacts is long enough to tell the force.".into()];
        return Ok(section);
    }
    section.text.push(explained(stored));
    let names = points.law_names();
    let mut legend = vec![key("measured, wall as given", BEFORE, Mark::Circle)];
    if shows_after(stored) {
        legend.push(key("left by the updated wall", AFTER, Mark::Square));
    }
    legend.extend(names.iter().take(LAWS.len()).map(|name| key(name, colour(&names, name), Mark::None)));
    section.figures.push(Figure {
        id: "force-state".into(),
        title: "Force and motion of the top".into(),
        legend,
        panels: (0..AGAINST.len()).map(|which| points.shape(which, stored)).collect::<Result<_>>()?,
        caption: "Force, displacement, velocity and acceleration are means over the same short stretches. Laws are those of single additions as they were fitted, without what the wall’s own numbers do beside them; a yielding spring is drawn as it is first loaded.".into(),
        links: vec![Link::to("force.parquet"), Link::to("laws.parquet")],
        ..Figure::default()
    });
    Ok(section)
}
