//! Figures of an assessment: capacity against demand, largest displacements, the governing run.

use std::f64::consts::TAU;

use super::super::chart::{
    Axis, COLLAPSE, Colour, Dot, Format, Graph, INK, Layer, Mark, PALETTE, Row, Stack,
};
use super::super::page::{Figure, Key};
use super::words::Words;
use crate::assessment::governing::GoverningRow;
use mrbd_assessment::{Assessment, DAMPING, Dynamic, LIMIT_STATES, Place, RecordRun};
use mrbd_records::Site;

/// Periods of a drawn spectrum, s: from here to twice T_SLC.
const FIRST_PERIOD_S: f64 = 0.02;
/// Points of a drawn spectrum.
const POINTS: u32 = 300;
/// Where walls that went far beyond d_0 stand, over d_0.
const HIGHEST: f64 = 1.2;

/// Abscissa and ordinate.
type Pair = (f64, f64);

/// a(d) of the wall, and what the code asks at the site's a_g and at a_g,SLV: acceleration against displacement.
pub fn capacity(w: Words, a: &Assessment) -> Figure {
    Figure {
        id: "capacity".into(),
        title: w.say("Capacity against demand", "Capacità e domanda"),
        legend: vec![
            Key::new(w.say("capacity a(d)", "capacità a(d)"), PALETTE[0], Mark::None),
            Key::new(
                w.say(
                    "demand at the site's a_g, ξ = 8 % (dashed: at a_g,SLV)",
                    "domanda all'a_g del sito, ξ = 8 % (a tratti: ad a_g,SLV)",
                ),
                PALETTE[1],
                Mark::None,
            ),
            Key::new("d_SLV, d_SLC", INK, Mark::Circle),
        ],
        panels: vec![capacity_graph(w, a).svg()],
        wide: true,
        caption: w.say(
            "The demand is the spectrum as acceleration against displacement; T_SLV, not the crossing of the curves, decides.",
            "La domanda è lo spettro accelerazione-spostamento; decide T_SLV, non l'incrocio delle curve.",
        ),
        ..Figure::default()
    }
}

fn capacity_graph(w: Words, a: &Assessment) -> Graph {
    let fc = a.site.assessment.confidence_factor;
    let curve = a.capacity.curve.iter();
    let wall: Vec<Pair> = curve.map(|p| (p.d_m, a.capacity.acceleration_m_s2(p.d_m, fc))).collect();
    let asked = demand(a, a.site.site.ag_g);
    let reached = a.check.ag_slv_m_s2.map(|ag| demand(a, ag / mrbd_kernel::model::G_M_S2));
    let highest = wall.iter().map(|point| point.1).fold(a.check.a_0_m_s2, f64::max);
    // Spectra go on far beyond what a wall can: they are cut off, not the wall.
    let shown = asked.iter().map(|point| point.1).fold(0.0, f64::max).min(3.0 * highest);
    // Lines end where they leave the graph, so that none runs along its edge.
    let line = |colour, dashed, name: String, points: Vec<Pair>| {
        let points = points.into_iter().filter(|(d_m, _)| *d_m <= 1.2 * a.d_0_m).collect();
        Layer::Line { colour, width: 5, dashed, name, points }
    };
    let mut layers = vec![
        line(PALETTE[1], false, w.say("demand at a_g", "domanda ad a_g"), asked),
        line(PALETTE[0], false, w.say("capacity", "capacità"), wall),
    ];
    let name = w.say("demand at a_g,SLV", "domanda ad a_g,SLV");
    layers.extend(reached.map(|points| line(PALETTE[1], true, name, points)));
    layers.push(marks(a));
    Graph {
        title: String::new(),
        format: Format::Wide,
        x: Axis::holding("d, m", [1.1 * a.d_0_m]),
        y: Axis::holding("a, m/s²", [highest, shown]),
        layers,
    }
}

/// (S_d, S_a) along periods.
fn demand(a: &Assessment, ag_g: f64) -> Vec<(f64, f64)> {
    let building = a.site.floor().filter(|_| a.check.place == "floor");
    let place = Place { site: Site { ag_g, ..a.site.site }, building };
    let last_s = 2.0 * a.check.t_slc_s;
    let period = |i: u32| FIRST_PERIOD_S * (last_s / FIRST_PERIOD_S).powf(f64::from(i) / f64::from(POINTS));
    (0..=POINTS)
        .map(|i| {
            let (t_s, damping) = (period(i), DAMPING[1]);
            let d_m = place.displacement_m(t_s, damping);
            (d_m, d_m * (TAU / t_s).powi(2))
        })
        .collect()
}

fn marks(a: &Assessment) -> Layer {
    let c = &a.check;
    let dot = |name: &str, x: f64, y: f64, t_s: f64| Dot {
        x,
        y,
        tip: format!("{name}\n{x:.4} m\n{y:.3} m/s²\nT {t_s:.3} s"),
    };
    let dots =
        vec![dot("SLV", c.d_slv_m, c.a_slv_m_s2, c.t_slv_s), dot("SLC", c.d_slc_m, c.a_slc_m_s2, c.t_slc_s)];
    Layer::Dots { colour: INK, mark: Mark::Circle, size: 10, hollow: false, dots }
}

/// The largest displacement under each record against d_SLV, d_SLC and d_0.
pub fn largest(w: Words, a: &Assessment, dynamic: &Dynamic) -> Figure {
    Figure {
        id: "largest".into(),
        title: w.say("Largest displacements", "Spostamenti massimi"),
        legend: vec![
            Key::new(w.say("largest d; line: mean", "d massimo; linea: media"), PALETTE[0], Mark::Circle),
            Key::new(w.say("beyond d_0", "oltre d_0"), COLLAPSE, Mark::Square),
            Key::new("d_SLV = 0.4 d_0", PALETTE[2], Mark::None),
            Key::new("d_SLC = 0.6 d_0", PALETTE[4], Mark::None),
        ],
        panels: vec![largest_graph(w, a, dynamic).svg()],
        wide: true,
        caption: w.say(
            "Bars: runs that differ by what nobody can know. Walls that fell stand at the top.",
            "Barre: analisi che differiscono per quanto nessuno può conoscere. Le pareti cadute stanno in alto.",
        ),
        ..Figure::default()
    }
}

fn largest_graph(w: Words, a: &Assessment, dynamic: &Dynamic) -> Graph {
    let share = |d_m: f64| (d_m / a.d_0_m).min(HIGHEST);
    let records = || (1..).map(f64::from).zip(&dynamic.records);
    let dots = |beyond: bool| {
        let shown = records().filter(|(_, run)| run.beyond_d_0 == beyond);
        let tip = |run: &RecordRun| format!("{}\n{:.4} m", run.record, run.largest_d_m);
        shown.map(|(x, run)| Dot { x, y: share(run.largest_d_m), tip: tip(run) }).collect()
    };
    let spans = records().map(|(x, run)| run.spread_d_m.map(|d_m| (x, share(d_m)))).collect();
    let last = dynamic.records.len() as f64 + 0.5;
    let along = |y: f64, colour: Colour, dashed: bool, name: String| Layer::Line {
        colour,
        width: 3,
        dashed,
        name,
        points: vec![(0.5, y), (last, y)],
    };
    Graph {
        title: String::new(),
        format: Format::Low,
        x: Axis::linear(&w.say("record", "accelerogramma"), 0.5, last),
        y: Axis::linear("d/d_0", 0.0, HIGHEST + 0.05),
        layers: vec![
            along(LIMIT_STATES[0], PALETTE[2], true, "d_SLV".into()),
            along(LIMIT_STATES[1], PALETTE[4], true, "d_SLC".into()),
            along(1.0, COLLAPSE, true, "d_0".into()),
            along(share(dynamic.mean_largest_m), PALETTE[0], false, w.say("mean", "media")),
            Layer::Spans { colour: PALETTE[5], width: 9, spans },
            Layer::Dots { colour: PALETTE[0], mark: Mark::Circle, size: 9, hollow: false, dots: dots(false) },
            Layer::Dots { colour: COLLAPSE, mark: Mark::Square, size: 9, hollow: false, dots: dots(true) },
        ],
    }
}

/// Displacement and motion of the ground in the run with the largest displacement.
pub fn governing(w: Words, a: &Assessment, dynamic: &Dynamic, rows: &[GoverningRow]) -> Figure {
    let name = dynamic.records.iter().max_by(|x, y| x.largest_d_m.total_cmp(&y.largest_d_m));
    let name = name.map_or("", |run| run.record.as_str());
    let line = |of: fn(&GoverningRow) -> f64, colour, label: &str| {
        let points = rows.iter().map(|row| (row.time_s, of(row))).collect();
        Layer::Line { colour, width: 3, dashed: false, name: label.into(), points }
    };
    let end_s = rows.last().map_or(1.0, |row| row.time_s);
    let y = Axis::holding("d/d_0", rows.iter().map(|row| row.d_m / a.d_0_m));
    let moved = rows.iter().map(|row| (row.time_s, row.d_m / a.d_0_m)).collect();
    let moved =
        Layer::Line { colour: PALETTE[0], width: 3, dashed: false, name: "d/d_0".into(), points: moved };
    let ground = Axis::holding(&w.say("base m/s²", "base m/s²"), rows.iter().map(|row| row.ground_m_s2));
    let stack = Stack {
        label: name.to_owned(),
        x: Axis::linear("t, s", 0.0, end_s),
        rows: vec![
            Row { height: 420.0, y, layers: vec![moved] },
            Row { height: 240.0, y: ground, layers: vec![line(|row| row.ground_m_s2, INK, "")] },
        ],
        legend: Vec::new(),
    };
    Figure {
        id: "governing".into(),
        title: format!("{}: {name}", w.say("The governing run", "L'analisi che governa")),
        panels: vec![stack.svg()],
        wide: true,
        caption: w.say(
            "Above the displacement over d_0, below the acceleration of ground or floor.",
            "Sopra lo spostamento su d_0, sotto l'accelerazione della base o del piano.",
        ),
        ..Figure::default()
    }
}
