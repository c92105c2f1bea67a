//! Where the missing force acts: in time, by direction, and by what closes the gap there.

use super::super::chart::{Axis, Dot, Format, Graph, Layer, Mark, PATTERNS};
use super::super::page::{Figure, Link, Section, Table};
use super::force::Points;
use super::histories::Histories;
use super::words::at;
use super::{AFTER, BEFORE, MEASURED, key};
use crate::error::Result;
use mrbd_kernel::model::PATTERN_NAMES;
use mrbd_lab::diagnose::answer::{Rival, Summary};
use mrbd_lab::limits::{ALONG_TOP, LEAST_DIRECTIONS};

/// Share off the direction of the top from which a force there alone does not explain the residual: twins of a late record
/// have 0.1 and more.
const OFF: f64 = 0.1;

/// Said of a residual off that direction: what pushes the top sideways is not the whole of it.
const NOT_PUSHED_ALONE: &str = "a sideways push at the top alone does not explain it; what also weighs on the top, \
                                changes impacts or acts elsewhere may";

/// Where the missing force acts.
///
/// # Errors
/// [`crate::Error::Picture`] if plotters refuses.
pub fn place_section(points: &Points, histories: &Histories, summary: &Summary) -> Result<Section> {
    let mut figures = Vec::new();
    if !points.force_n.is_empty() {
        let mut tests: Vec<&String> = points.test.iter().collect();
        tests.dedup();
        let mut legend = vec![key("missing in the wall as given", BEFORE, Mark::Circle)];
        if summary.has_updated_wall() {
            legend.push(key("left by the updated wall", AFTER, Mark::Square));
        }
        let spans = tests.iter().flat_map(|test| histories.patterns(test)).collect::<Vec<_>>();
        let occurring = (0..PATTERNS.len()).filter(|index| spans.iter().any(|span| span.0 == *index));
        legend.extend(occurring.map(|index| key(PATTERN_NAMES[index], PATTERNS[index], Mark::None)));
        figures.push(Figure {
            id: "force-in-time".into(),
            title: "The missing force, in time".into(),
            legend,
            panels: tests.into_iter().map(|test| points.in_time(test, histories, summary)).collect::<Result<_>>()?,
            caption: "Measured rotations between impacts, put into the equations of motion (in their weak form, so that no noise is differentiated), leave this horizontal force at the top; bars are standard deviations by the noise. Along the upper edge the measured pattern; where it changes, an impact or an opening lies in the gap.".into(),
            links: vec![Link::to("force.parquet")],
            ..Figure::default()
        });
        figures.extend(points.direction(summary)?);
    }
    Ok(Section {
        id: "place".into(),
        title: "Where the missing force acts".into(),
        text: vec![direction_in_words(summary), size_in_words(summary)],
        figures,
        tables: vec![places(summary)],
        ..Section::default()
    })
}

impl Points {
    /// Force in time in one test, with its standard deviations.
    fn in_time(&self, test: &str, histories: &Histories, summary: &Summary) -> Result<String> {
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
        if summary.has_updated_wall() {
            layers.push(dots(AFTER, Mark::Square, &self.after_n));
        }
        Ok(Graph {
            title: test.to_owned(),
            format: Format::Half,
            x: Axis::linear("time s", from_s, to_s),
            y,
            layers,
        }
        .svg())
    }

    /// The moment pairs of patterns 1 and 2, and the direction of a force at the top.
    fn direction(&self, summary: &Summary) -> Result<Option<Figure>> {
        let pairs = self.rows().filter(|&k| self.share[k].is_finite()).collect::<Vec<_>>();
        if pairs.is_empty() {
            return Ok(None);
        }
        let kn_m = |body: usize, k: usize| 1e-3 * self.moment[body][k];
        let largest = pairs.iter().flat_map(|&k| [kn_m(0, k).abs(), kn_m(1, k).abs()]).fold(0.0, f64::max);
        let [y_q, y_c] = summary.missing_force.arms_of_top_m;
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
            panels: vec![graph.svg()],
            caption: "Where both bodies turn apart, the equations of motion lack a pair of moments. A horizontal force at the top makes pairs along the line.".into(),
            links: vec![Link::to("force.parquet")],
            ..Figure::default()
        }))
    }
}

fn direction_in_words(summary: &Summary) -> String {
    let force = &summary.missing_force;
    match force.median_share_off_top {
        Some(share) if force.points_with_direction >= LEAST_DIRECTIONS => format!(
            "Off the direction of a horizontal force at the top lies {share:.3} of the squared moments (median of {} stretches clear of the noise): {}.",
            force.points_with_direction,
            if share < ALONG_TOP {
                "what is missing acts at the top, as far as smooth motion tells"
            } else if share < OFF {
                "it may act at the top, or shake the whole wall"
            } else {
                NOT_PUSHED_ALONE
            }
        ),
        _ => format!(
            "Only {} stretches of patterns 1 and 2 stand clear of the noise: the direction of what is missing is not known from smooth motion.",
            force.points_with_direction
        ),
    }
}

fn size_in_words(summary: &Summary) -> String {
    let force = &summary.missing_force;
    let mut text = format!(
        "Over {} stretches the missing force is {:.0} N (root mean square) where noise alone would make {:.0} N",
        force.points, force.before.rms_n, force.before.noise_rms_n
    );
    if summary.has_updated_wall() {
        text += &format!(
            "; the updated wall leaves {:.0} N of {:.0} N",
            force.after.rms_n, force.after.noise_rms_n
        );
    }
    text + "."
}

/// The best hypothesis of each place.
fn places(summary: &Summary) -> Table {
    let mut best: Vec<&Rival> = Vec::new();
    for rival in summary.rivals.iter().filter(|r| r.name != "placebo" && !r.name.contains(" + ")) {
        if !best.iter().any(|known| known.place == rival.place) {
            best.push(rival);
        }
    }
    let whole = summary.against.recalibrated;
    let row = |rival: &&Rival| {
        let error = |x: Option<f64>| x.map_or("–".to_owned(), |x| format!("{x:.2}"));
        let share = (whole > 0.0).then(|| (whole - rival.against.all) / whole);
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
