//! The page of an assessment: mechanism, inputs with their sources, formulas with numbers, capacity against demand,
//! the governing run, verdicts, assumptions, and what is not checked. Printed it is the sheet to hand in.

mod drawing;
mod figures;
mod formulas;
mod inputs;
mod words;

use std::path::Path;

use super::page::{Figure, Link, Number, Page, Section, Table};
use super::provenance::{Note, read_json};
use crate::assessment::governing::{GoverningRow, read_governing};
use crate::assessment::wall::Assessed;
use crate::error::Result;
use mrbd_assessment::{Assessment, Dynamic};
use words::Words;

/// The page of a folder of `mrbd assess`.
///
/// # Errors
/// Input errors for files that are none of an assessment.
pub fn page(folder: &Path) -> Result<Page> {
    let note = Note::read(&folder.join("manifest.json"))?;
    let assessed: Assessed =
        read_json(&folder.join("assessment.json"), "an assessment as `mrbd assess` writes it")?;
    let rows = read_governing(&folder.join("governing_run.csv"))?;
    let w = Words(assessed.language);
    let mut files = vec![Link::to("assessment.json")];
    files.extend((!rows.is_empty()).then(|| Link::to("governing_run.csv")));
    Ok(Page {
        lang: assessed.language.code(),
        title: w.say(
            &format!("Local mechanism of {}", assessed.wall.name),
            &format!("Meccanismo locale di {}", assessed.wall.name),
        ),
        lead: verdict(w, &assessed.assessment),
        numbers: numbers(w, &assessed.assessment),
        notes: words::notes(w, &assessed),
        sections: sections(w, &assessed, &rows),
        provenance: note.pairs(),
        footer: w.say(
            "Equation numbers that begin with C are those of the Circolare 21 January 2019, n. 7 (to NTC 2018).",
            "I numeri di equazione che iniziano con C sono quelli della Circolare 21 gennaio 2019, n. 7 (NTC 2018).",
        ),
        files,
        ..Page::default()
    })
}

fn sections(w: Words, assessed: &Assessed, rows: &[GoverningRow]) -> Vec<Section> {
    let a = &assessed.assessment;
    let mut sections = vec![
        Section {
            id: "mechanism".into(),
            title: w.say("Mechanism", "Meccanismo"),
            figures: vec![drawing_figure(w, assessed)],
            tables: vec![formulas::mechanisms(w, a), formulas::edges(w, a)],
            ..Section::default()
        },
        Section {
            id: "inputs".into(),
            title: w.say("Inputs", "Dati"),
            tables: vec![inputs::table(w, assessed)],
            ..Section::default()
        },
        Section {
            id: "check".into(),
            title: w.say("Check by kinematic analysis", "Verifica con analisi cinematica"),
            tables: formulas::checks(w, a),
            figures: vec![figures::capacity(w, a)],
            ..Section::default()
        },
    ];
    sections.extend(a.dynamic.as_ref().map(|dynamic| dynamics(w, a, dynamic, rows)));
    sections.extend(assessed.compared.as_ref().map(|other| Section {
        id: "compared".into(),
        title: w.say("Before and after", "Prima e dopo"),
        tables: vec![formulas::compared(w, assessed, other)],
        ..Section::default()
    }));
    sections.push(Section {
        id: "assumptions".into(),
        title: w.say("Assumptions, and what is not checked", "Ipotesi e ciò che non è verificato"),
        text: words::assumptions(w),
        ..Section::default()
    });
    sections
}

fn drawing_figure(w: Words, assessed: &Assessed) -> Figure {
    Figure {
        id: "drawing".into(),
        title: w.say("The mechanism that governs", "Il meccanismo che governa"),
        panels: vec![drawing::svg(w, assessed)],
        caption: w.say(
            "Rotations are drawn larger than they are. P: weights carried; Q: masses that push only.",
            "Le rotazioni sono amplificate. P: pesi portati; Q: masse che spingono soltanto.",
        ),
        ..Figure::default()
    }
}

fn dynamics(w: Words, a: &Assessment, dynamic: &Dynamic, rows: &[GoverningRow]) -> Section {
    let mut figures = vec![figures::largest(w, a, dynamic)];
    figures.extend((!rows.is_empty()).then(|| figures::governing(w, a, dynamic, rows)));
    Section {
        id: "dynamics".into(),
        title: w.say("Check by nonlinear dynamic analysis", "Verifica con analisi dinamica non lineare"),
        text: vec![w.say(
            "C8.7.1.2.1.9: accepted when no run goes beyond d_0 and the mean of the largest displacements is below d_SLV (d_SLC).",
            "C8.7.1.2.1.9: la verifica è soddisfatta se nessuna analisi supera d_0 e la media degli spostamenti massimi è inferiore a d_SLV (d_SLC).",
        )],
        figures,
        tables: vec![formulas::dynamics(w, a, dynamic), records(w, dynamic)],
        ..Section::default()
    }
}

fn records(w: Words, dynamic: &Dynamic) -> Table {
    let head = [
        w.say("record", "accelerogramma"),
        w.say("largest d, m", "d massimo, m"),
        w.say("runs beside it, from", "analisi gemelle, da"),
        w.say("to", "a"),
        w.say("beyond d_0", "oltre d_0"),
        w.say("the model does not apply", "il modello non si applica"),
    ];
    let row = |run: &mrbd_assessment::RecordRun| {
        let [low, high] = run.spread_d_m;
        vec![
            run.record.clone(),
            format!("{:.4}", run.largest_d_m),
            format!("{low:.4}"),
            format!("{high:.4}"),
            format!("{:.0} %", 100.0 * run.beyond_share),
            run.beyond_model.join("; "),
        ]
    };
    let head = head.each_ref().map(String::as_str);
    Table::of(
        &w.say("One row a record", "Una riga per accelerogramma"),
        &head,
        dynamic.records.iter().map(row),
    )
}

fn verdict(w: Words, a: &Assessment) -> String {
    let code = if a.check.accepted {
        w.say("The code's check is satisfied", "La verifica di norma è soddisfatta")
    } else {
        w.say("The code's check is not satisfied", "La verifica di norma non è soddisfatta")
    };
    let Some(dynamic) = &a.dynamic else { return format!("{code}.") };
    let and = match (dynamic.accepted_slv, dynamic.decided_slv) {
        (true, true) => w.say("the dynamics accept the wall", "l'analisi dinamica accetta la parete"),
        (false, true) => w.say("the dynamics refuse the wall", "l'analisi dinamica rifiuta la parete"),
        (true, false) => w.say(
            "the dynamics accept the wall, but other records might not",
            "l'analisi dinamica accetta la parete, ma altri accelerogrammi potrebbero non farlo",
        ),
        (false, false) => w.say(
            "the dynamics refuse the wall, but other records might not",
            "l'analisi dinamica rifiuta la parete, ma altri accelerogrammi potrebbero non farlo",
        ),
    };
    format!("{code}; {and}.")
}

fn numbers(w: Words, a: &Assessment) -> Vec<Number> {
    let zeta = |zeta: Option<f64>| zeta.map_or("–".to_owned(), |zeta| format!("{zeta:.2}"));
    let mut numbers = vec![
        Number::new(zeta(a.check.zeta), w.say("ζ = a_g,SLV/a_g, nonlinear", "ζ = a_g,SLV/a_g, non lineare")),
        Number::new(zeta(a.check.linear.zeta), w.say("ζ, linear, q = 2", "ζ, lineare, q = 2")),
        Number::new(format!("{:.4}", a.alpha_0), "α_0"),
        Number::new(format!("{:.3} m", a.d_0_m), "d_0"),
    ];
    numbers.extend(a.dynamic.as_ref().map(|dynamic| {
        let of = format!("{}/{}", dynamic.beyond_d_0, dynamic.runs);
        Number::new(of, w.say("runs beyond d_0", "analisi oltre d_0"))
    }));
    numbers
}
