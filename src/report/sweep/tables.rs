//! Findings and assumptions as tables.

use super::super::page::{Cell, Table};
use crate::aggregate::VariantNote;
use crate::findings::{Conclusion, Conclusions, FINDINGS, Finding, Verdict};

/// The verdict, with the share of the draws that say so.
fn verdict(conclusion: &Conclusion) -> Cell {
    let class = match conclusion.verdict() {
        Verdict::Holds => "holds",
        Verdict::DoesNot => "does-not",
        Verdict::Undecided => "undecided",
        Verdict::NotAsked => "not-asked",
    };
    Cell { text: conclusion.short(), class }
}

fn heads(heads: &[&str]) -> Vec<String> {
    heads.iter().map(|&head| head.to_owned()).collect()
}

/// Every conclusion with its criterion, its verdict and the numbers that decide.
pub fn findings(conclusions: &Conclusions) -> Table {
    let row = |(index, (finding, conclusion)): (usize, (&Finding, &Conclusion))| {
        vec![
            Cell::from(format!("{}. {}", index + 1, finding.name)),
            verdict(conclusion),
            Cell::from(format!("{} ({})", finding.claim, finding.source)),
            Cell::from(conclusion.answer.numbers.clone()),
            Cell::from(finding.criterion.to_owned()),
        ]
    };
    Table {
        prose: true,
        caption: format!("Conclusions under variant “{}”", conclusions.variant),
        head: heads(&["conclusion", "verdict", "the paper says", "found", "holds if"]),
        rows: FINDINGS.iter().zip(&conclusions.all).enumerate().map(row).collect(),
    }
}

/// The verdicts under every set of assumptions.
pub fn by_variant(conclusions: &[Conclusions]) -> Table {
    let mut head = heads(&["conclusion"]);
    head.extend(conclusions.iter().map(|under| under.variant.clone()));
    let row = |(index, finding): (usize, &Finding)| {
        let mut row = vec![Cell::from(format!("{}. {}", index + 1, finding.name))];
        row.extend(conclusions.iter().map(|under| verdict(&under.all[index])));
        row
    };
    Table {
        caption: "The same conclusions under every variant of the assumptions".into(),
        prose: false,
        head,
        rows: FINDINGS.iter().enumerate().map(row).collect(),
    }
}

/// The assumptions of every variant and how its runs ended.
pub fn assumptions(variants: &[VariantNote]) -> Table {
    let row = |v: &VariantNote| {
        let residual = v.energy_residual.map_or("–".to_owned(), |residual| format!("{residual:.0e}"));
        [
            v.name.clone(),
            format!("{} m", v.length_m),
            format!("{} kg/m³", v.density_kg_m3),
            v.law.clone(),
            format!("{:e} rad/s", v.capture_velocity_rad_s),
            format!("{:e}", v.tolerance),
            v.runs.to_string(),
            v.collapsed.to_string(),
            v.failed.to_string(),
            residual,
        ]
        .map(Cell::from)
        .to_vec()
    };
    let names = [
        "variant",
        "length of strip",
        "density",
        "impact law",
        "capture velocity",
        "tolerance",
        "runs",
        "collapsed",
        "failed",
        "largest energy residual",
    ];
    Table {
        caption:
            "Energy residual: the energy of a run not accounted for, over the energy that passed through it"
                .into(),
        prose: false,
        head: heads(&names),
        rows: variants.iter().map(row).collect(),
    }
}
