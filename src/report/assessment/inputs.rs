//! Every input of an assessment with where it comes from.

use super::super::page::Table;
use super::words::Words;
use crate::assessment::wall::Assessed;

/// Inputs: name, key, value, source.
pub fn table(w: Words, assessed: &Assessed) -> Table {
    let rows = wall(w, assessed).into_iter().chain(site(w, assessed));
    let source = |key: &str, of_wall: bool| {
        let site = &assessed.assessment.site;
        let general = if of_wall || site.source.is_empty() { None } else { Some(site.source.clone()) };
        let file = if of_wall {
            w.say("wall file", "file della parete")
        } else {
            w.say("site file", "file del sito")
        };
        site.sources.get(key).cloned().or(general).unwrap_or(file)
    };
    let rows =
        rows.map(|(name, key, value, of_wall)| vec![name, key.to_owned(), value, source(key, of_wall)]);
    let head =
        [w.say("input", "dato"), w.say("key", "chiave"), w.say("value", "valore"), w.say("source", "fonte")];
    let head = head.each_ref().map(String::as_str);
    let caption = w.say(
        "Inputs; [sources] of the site file says where each comes from",
        "Dati; [sources] nel file del sito indica la fonte di ciascuno",
    );
    Table::of(&caption, &head, rows)
}

/// Name, key, value, and whether it is of the wall file.
type Row = (String, &'static str, String, bool);

fn wall(w: Words, assessed: &Assessed) -> Vec<Row> {
    let p = &assessed.wall;
    let m = |length_m: f64| format!("{length_m:.3} m");
    let row = |english: &str, italian: &str, key, value: String| (w.say(english, italian), key, value, true);
    let mut rows = vec![
        row("thickness b", "spessore b", "thickness_m", m(p.thickness_m)),
        row("height h", "altezza h", "height_m", m(p.height_m)),
        row("length of the strip L", "lunghezza della striscia L", "length_m", m(p.length_m)),
        row("mass m", "massa m", "mass_kg", format!("{:.1} kg", p.mass_kg)),
        row("width of the foot b₁", "larghezza al piede b₁", "lower_width_m", m(p.width_m[0])),
    ];
    if let Some(h_1) = p.crack_height_m {
        rows.push(row("height of the crack h₁", "altezza della fessura h₁", "crack_height_m", m(h_1)));
        rows.push(row(
            "width at the crack b₂",
            "larghezza alla fessura b₂",
            "upper_width_m",
            m(p.width_m[1]),
        ));
    }
    let kg = |mass_kg: f64| format!("{mass_kg:.1} kg");
    let stiffness = format!("{} N/m", p.stiffness_n_per_m);
    rows.extend([
        row("floor, carried m_d", "solaio, portata m_d", "diaphragm.mass_kg", kg(p.diaphragm_mass_kg)),
        row(
            "floor, pushing only m_dp",
            "solaio, sola inerzia m_dp",
            "diaphragm.carriage_mass_kg",
            kg(p.carriage_mass_kg),
        ),
        row("stiffness at the top k_d", "rigidezza in sommità k_d", "diaphragm.stiffness_n_per_m", stiffness),
        row("eccentricity e_C", "eccentricità e_C", "diaphragm.eccentricity_m", m(p.eccentricity_m)),
    ]);
    rows.extend(p.effects.iter().map(|effect| row("effect", "effetto", "effects", effect.clone())));
    rows
}

fn site(w: Words, assessed: &Assessed) -> Vec<Row> {
    let file = &assessed.assessment.site;
    let s = &file.site;
    let mut rows = vec![
        ("a_g".to_owned(), "ag_g", format!("{} g", s.ag_g), false),
        ("F_0".to_owned(), "f0", s.f0.to_string(), false),
        ("T_C*".to_owned(), "tc_star_s", format!("{} s", s.tc_star_s), false),
        (w.say("soil", "sottosuolo"), "soil", format!("{:?}, S = {:.3}", s.soil, s.amplification()), false),
        (w.say("topography", "topografia"), "topography", format!("{:?}", s.topography), false),
    ];
    if let Some(b) = &file.building {
        rows.extend([
            ("z/H".to_owned(), "building.height_ratio", b.height_ratio.to_string(), false),
            ("T_1".to_owned(), "building.period_s", format!("{} s", b.period_s), false),
            (
                w.say("storeys n", "piani n"),
                "building.storeys",
                format!("{}, γ_1 = {:.3}", b.storeys, b.participation()),
                false,
            ),
        ]);
    }
    let fc = file.assessment.confidence_factor;
    rows.push((
        w.say("confidence factor FC", "fattore di confidenza FC"),
        "assessment.confidence_factor",
        format!("{fc:.2}"),
        false,
    ));
    rows.extend(file.assessment.elastic_modulus_pa.map(|e| {
        (w.say("modulus E", "modulo E"), "assessment.elastic_modulus_pa", format!("{e:e} Pa"), false)
    }));
    rows
}
