//! Formulas of the check with their numbers in them, as tables.

use super::super::page::Table;
use super::words::Words;
use crate::assessment::wall::{Assessed, Compared};
use mrbd_assessment::{Assessment, DAMPING, Dynamic, EdgeName, Governing, StaticCheck};
use mrbd_kernel::model::G_M_S2;
use mrbd_statics::Mechanism;

/// Quantity, equation, formula with numbers, value.
type Row = [String; 4];

fn table(w: Words, caption: &str, rows: Vec<Row>) -> Table {
    let head = [
        w.say("quantity", "grandezza"),
        w.say("equation", "equazione"),
        w.say("formula, with numbers", "formula, con i numeri"),
        w.say("value", "valore"),
    ];
    Table::of(caption, &head.each_ref().map(String::as_str), rows.into_iter().map(Vec::from))
}

fn row(quantity: &str, equation: &str, formula: String, value: String) -> Row {
    [quantity.to_owned(), equation.to_owned(), formula, value]
}

/// α_0 of every mechanism, and the crack of least α_0.
pub fn mechanisms(w: Words, a: &Assessment) -> Table {
    let name = |mechanism: Mechanism| match mechanism {
        Mechanism::OneBlock => w.say("one block, top free", "blocco unico, sommità libera"),
        Mechanism::UpperBody => w.say("upper body alone, top free", "solo corpo superiore, sommità libera"),
        Mechanism::Both => {
            w.say("both bodies, δθ₂ = 2 δθ₁, top free", "entrambi i corpi, δθ₂ = 2 δθ₁, sommità libera")
        }
        Mechanism::VerticalBending => {
            w.say("vertical bending, top held", "flessione verticale, sommità trattenuta")
        }
    };
    let mut rows: Vec<Vec<String>> = a
        .mechanisms
        .iter()
        .map(|m| vec![name(m.mechanism), format!("{:.4}", m.alpha_0), format!("{:.4}", m.e_star)])
        .collect();
    let least = &a.least_crack;
    let at_end =
        if least.at_end { w.say(", end of the range", ", estremo dell'intervallo") } else { String::new() };
    let crack =
        w.say("vertical bending, crack of least α_0 at", "flessione verticale, fessura di minimo α_0 a");
    rows.push(vec![
        format!("{crack} {:.3} m{at_end}", least.height_m),
        format!("{:.4}", least.alpha_0),
        "–".into(),
    ]);
    let caption = format!(
        "{} {}",
        w.say("Mechanisms, C8.7.1.1 and C8.7.1.5; governs:", "Meccanismi, C8.7.1.1 e C8.7.1.5; governa:"),
        w.governing(a.mechanism)
    );
    Table::of(&caption, &[&w.say("mechanism", "meccanismo"), "α_0", "e*"], rows.into_iter())
}

/// Capacity with other edges of the joints.
pub fn edges(w: Words, a: &Assessment) -> Table {
    let name = |edges: EdgeName| match edges {
        EdgeName::Full => w.say("sharp edges, full thickness", "spigoli vivi, spessore intero"),
        EdgeName::Crushed => w.say("corners of the wall file (crushed)", "spigoli del file (schiacciati)"),
        EdgeName::Compliant => w.say("the wall as it is, with its beds", "la parete com'è, con i suoi letti"),
    };
    let row = |e: &mrbd_assessment::EdgeRow| {
        let numbers = [e.alpha_0, e.alpha_largest, e.d_0_m].map(|x| format!("{x:.4}"));
        std::iter::once(name(e.edges)).chain(numbers).collect::<Vec<String>>()
    };
    let head = [w.say("joints", "giunti"), "α_0".into(), w.say("largest α", "α massimo"), "d_0, m".into()];
    let caption = w.say("Capacity by the edges of the joints", "Capacità secondo gli spigoli dei giunti");
    Table::of(&caption, &head.each_ref().map(String::as_str), a.edges.iter().map(row))
}

/// The checks, where the wall stands and at the ground.
pub fn checks(w: Words, a: &Assessment) -> Vec<Table> {
    let caption = |check: &StaticCheck| match check.place.as_str() {
        "floor" => w.say("On the floor (C7.2.3)", "Al piano (C7.2.3)"),
        _ => w.say("At the ground", "A terra"),
    };
    let first = capacity_rows(a).into_iter().chain(check_rows(w, a, &a.check)).collect();
    let mut tables = vec![table(w, &caption(&a.check), first)];
    tables.extend(a.at_ground.as_ref().map(|check| table(w, &caption(check), check_rows(w, a, check))));
    tables
}

fn capacity_rows(a: &Assessment) -> Vec<Row> {
    let (c, work) = (&a.capacity, &a.capacity.work);
    let control_m = if c.control == mrbd_assessment::Control::Top { work.top_m } else { work.crack_m }.abs();
    let e_star = format!(
        "(Σ(P+Q)δ)²/(Σ(P+Q) Σ(P+Q)δ²) = {:.1}²/({:.1} · {:.1})",
        work.pushing_j, work.pushing_n, work.squares_n_m2
    );
    let ratio = match a.mechanism {
        Governing::Restrained => "Σ(P+Q)x²/(x_C Σ(P+Q)x), d_0".into(),
        _ => format!(
            "Σ(P+Q)δ²/(δ_C Σ(P+Q)δ) = {:.1}/({control_m:.3} · {:.1})",
            work.squares_n_m2, work.pushing_j
        ),
    };
    vec![
        row("α_0", "C8.7.1.1", alpha_0(a), format!("{:.4}", a.alpha_0)),
        row("e*", "C8.7.1.5", e_star, format!("{:.4}", a.e_star)),
        row(
            "M*",
            "",
            format!("e* Σ(P+Q)/g = {:.4} · {:.1}/9.81", a.e_star, work.pushing_n),
            format!("{:.1} kg", c.m_star_kg),
        ),
        row("d/d_C", "C8.7.1.4", ratio, format!("{:.4}", c.d_over_control)),
        row(
            "d_0",
            "",
            format!("{:.4} · {:.4} m", c.d_over_control, c.d_0_control_m),
            format!("{:.4} m", a.d_0_m),
        ),
    ]
}

fn alpha_0(a: &Assessment) -> String {
    let work = &a.capacity.work;
    match a.mechanism {
        Governing::Restrained => "max α(d)".into(),
        _ => format!("Σ P δ_Py/Σ(P+Q) δ_PQx = {:.1}/{:.1}", work.lifting_j, work.pushing_j),
    }
}

fn check_rows(w: Words, a: &Assessment, c: &StaticCheck) -> Vec<Row> {
    let floor = c.place == "floor";
    let mut rows = linear_rows(w, a, c, if floor { "S_eZ" } else { "S_e" });
    rows.extend(nonlinear_rows(w, a, c, if floor { "S_eZ T²/4π²" } else { "S_De" }));
    rows.extend(c.zeta_sld.map(|_| row("ζ_SLD", "", "a_g,SLD/a_g(SLD)".into(), zeta(c.zeta_sld))));
    rows.extend(c.zeta_slc.map(|_| row("ζ_SLC", "", "a_g,SLC/a_g(SLC)".into(), zeta(c.zeta_slc))));
    rows.extend(c.circolare_617.as_ref().map(|old| {
        let formula =
            format!("d_u* = {:.4} m, d_s* = {:.4} m, T_s = {:.3} s", old.d_u_m, old.d_s_m, old.t_s_s);
        row("ζ, Circolare 617/2009", "", formula, zeta(old.zeta))
    }));
    rows
}

fn m_s2(value: Option<f64>) -> String {
    value.map_or("> 10 g".into(), |value| format!("{value:.3} m/s²"))
}

fn zeta(value: Option<f64>) -> String {
    value.map_or("–".into(), |value| format!("{value:.3}"))
}

/// An acceleration over the site's a_g.
fn over_ag(a: &Assessment, value: Option<f64>) -> String {
    value.map_or("–".into(), |value| format!("{value:.3}/{:.3}", a.site.site.ag_g * G_M_S2))
}

fn linear_rows(w: Words, a: &Assessment, c: &StaticCheck, spectrum: &str) -> Vec<Row> {
    let fc = a.site.assessment.confidence_factor;
    let a_0 = format!("α_0 g/(e* FC) = {:.4} · 9.81/({:.4} · {fc:.2})", a.alpha_0, a.e_star);
    let reached = format!("{spectrum}(T_0, {} %) = a_0", 100.0 * DAMPING[0]);
    let linear = format!("ζ, {}", w.say("linear", "lineare"));
    vec![
        row("a_0", "C8.7.1.3", a_0, format!("{:.3} m/s²", c.a_0_m_s2)),
        row("T_0", "C8.7.1.7", own_period(w, a), format!("{:.3} s", c.t_0_s)),
        row("a_g,SLD", "C8.7.1.8, .9", reached, m_s2(c.ag_sld_m_s2)),
        row("a_g,SLV, q = 2", "", "q a_g,SLD".into(), m_s2(c.linear.ag_slv_m_s2)),
        row(&linear, "", over_ag(a, c.linear.ag_slv_m_s2), zeta(c.linear.zeta)),
    ]
}

fn nonlinear_rows(w: Words, a: &Assessment, c: &StaticCheck, asked: &str) -> Vec<Row> {
    let period = |factor: f64, d_m: f64, a_m_s2: f64| format!("{factor} π √({d_m:.4}/{a_m_s2:.4})");
    let [_, slv, slc] = DAMPING.map(|xi| 100.0 * xi);
    let m = |d_m: f64| format!("{d_m:.4} m");
    let demand = w.say("demand at a_g", "domanda ad a_g");
    let reached = |of: &str, xi: f64, d_m: f64| format!("{asked}({of}, {xi} %) = {d_m:.4} m");
    vec![
        row("d_SLV", "", format!("0.4 · {:.4}", a.d_0_m), m(c.d_slv_m)),
        row("T_SLV", "C8.7.1.10", period(1.68, c.d_slv_m, c.a_slv_m_s2), format!("{:.3} s", c.t_slv_s)),
        row(&demand, "C8.7.1.12", format!("{asked}(T_SLV, {slv} %)"), m(c.demand_slv_m)),
        row("a_g,SLV", "C8.7.1.12", reached("T_SLV", slv, c.d_slv_m), m_s2(c.ag_slv_m_s2)),
        row("ζ", "", over_ag(a, c.ag_slv_m_s2), zeta(c.zeta)),
        row("d_SLC", "", format!("0.6 · {:.4}", a.d_0_m), m(c.d_slc_m)),
        row("T_SLC", "C8.7.1.11", period(1.56, c.d_slc_m, c.a_slc_m_s2), format!("{:.3} s", c.t_slc_s)),
        row("a_g,SLC", "C8.7.1.12", reached("T_SLC", slc, c.d_slc_m), m_s2(c.ag_slc_m_s2)),
    ]
}

fn own_period(w: Words, a: &Assessment) -> String {
    match a.site.assessment.elastic_modulus_pa {
        Some(_) => "κ λ L √(W/(E g))".into(),
        None => w.say("rigid wall: no modulus is given", "parete rigida: modulo non dato"),
    }
}

/// The dynamic check in one table.
pub fn dynamics(w: Words, a: &Assessment, d: &Dynamic) -> Table {
    let yes = |accepted: bool, decided: bool| {
        let said =
            if accepted { w.say("accepted", "soddisfatta") } else { w.say("refused", "non soddisfatta") };
        if decided { said } else { said + &w.say(", not sure", ", incerta") }
    };
    let interval = d.mean_interval_m.map_or("–".into(), |[low, high]| format!("{low:.4} – {high:.4} m"));
    let by_spectra = a.site_records.as_ref().map_or(["–".into(), "–".into()], |asked| {
        [format!("{:.4} m", asked.demand_slv_m), asked.zeta.map_or("–".into(), |zeta| format!("{zeta:.3}"))]
    });
    let [asked, zeta] = by_spectra;
    let rows = [
        [w.say("runs", "analisi"), d.runs.to_string()],
        [w.say("beyond d_0", "oltre d_0"), d.beyond_d_0.to_string()],
        [w.say("mean of the largest d", "media dei d massimi"), format!("{:.4} m", d.mean_largest_m)],
        [w.say("95 % over records (Student's t)", "95 % sugli accelerogrammi (t di Student)"), interval],
        [format!("SLV, d_SLV = {:.4} m", a.check.d_slv_m), yes(d.accepted_slv, d.decided_slv)],
        [format!("SLC, d_SLC = {:.4} m", a.check.d_slc_m), yes(d.accepted_slc, d.decided_slc)],
        [
            w.say(
                "by the records' spectra: mean of the largest S_D(T, 8 %), T_0 ≤ T ≤ T_SLV (C8.7.1.2.1.8)",
                "con gli spettri degli accelerogrammi: media degli S_D(T, 8 %) massimi, T_0 ≤ T ≤ T_SLV (C8.7.1.2.1.8)",
            ),
            asked,
        ],
        [w.say("d_SLV over that", "d_SLV diviso per essa"), zeta],
    ];
    let caption = w.say("The wall under the records", "La parete sotto gli accelerogrammi");
    let head = [w.say("quantity", "grandezza"), w.say("value", "valore")];
    Table::of(&caption, &head.each_ref().map(String::as_str), rows.into_iter().map(Vec::from))
}

/// Two walls side by side.
pub fn compared(w: Words, assessed: &Assessed, other: &Compared) -> Table {
    let both = [&assessed.assessment, &other.assessment];
    let number = |value: Option<f64>| value.map_or("–".into(), |value: f64| format!("{value:.3}"));
    let of = |name: String, value: &dyn Fn(&Assessment) -> String| {
        let [before, after] = both.map(value);
        vec![name, before, after]
    };
    let mut rows = vec![
        of(w.say("mechanism", "meccanismo"), &|a| w.governing(a.mechanism)),
        of("α_0".into(), &|a| format!("{:.4}", a.alpha_0)),
        of("d_0, m".into(), &|a| format!("{:.4}", a.d_0_m)),
        of("T_SLV, s".into(), &|a| format!("{:.3}", a.check.t_slv_s)),
        of("a_g,SLV, m/s²".into(), &|a| number(a.check.ag_slv_m_s2)),
        of("ζ".into(), &|a| number(a.check.zeta)),
        of(w.say("ζ, linear", "ζ, lineare"), &|a| number(a.check.linear.zeta)),
    ];
    if both.iter().all(|a| a.dynamic.is_some()) {
        let dynamic =
            |of: fn(&Dynamic) -> String| move |a: &Assessment| a.dynamic.as_ref().map_or("–".into(), of);
        rows.push(of(
            w.say("runs beyond d_0", "analisi oltre d_0"),
            &dynamic(|d| format!("{}/{}", d.beyond_d_0, d.runs)),
        ));
        rows.push(of(
            w.say("mean of largest d, m", "media dei d massimi, m"),
            &dynamic(|d| format!("{:.4}", d.mean_largest_m)),
        ));
    }
    let head = [w.say("quantity", "grandezza"), assessed.wall.name.clone(), other.wall.name.clone()];
    let caption = w.say("The same site, two walls", "Lo stesso sito, due pareti");
    Table::of(&caption, &head.each_ref().map(String::as_str), rows.into_iter())
}
