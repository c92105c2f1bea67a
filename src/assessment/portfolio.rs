//! The façades of a survey, each by the code's check and by its own dynamics: where do the two part?
//!
//! Thickness and slenderness stand at the middles of equal shares of their log-normal distributions, so that every façade
//! stands for the same share of the stock; all else stands at μ.

use std::borrow::Cow;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::error::{Error, InputError, Result};
use crate::store::{Column, Read};
use crate::study::ladder::{Ladder, Search};
use crate::survey::{Assumptions, Configuration, Facade, Survey};
use mrbd_assessment::{Agreement, Assessment, Shaken, SiteFile, Unfinished};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Restitution, Wall};
use mrbd_kernel::simulate::Accuracy;
use mrbd_statistics::{median, normal};

/// What a manifest says such results are.
pub const KIND: &str = "portfolio";

/// What is written beside the page.
pub const FILES: [&str; 3] = ["manifest.json", "portfolio.json", "portfolio.parquet"];

/// Factors on the records that are searched for the one at which the dynamics refuse a wall.
pub const LADDER: Ladder = Ladder { range: [0.25, 32.0], growth: 1.25, bracket: 1.02 };

/// A façade, assessed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// How the floor runs.
    pub configuration: Configuration,
    /// Thickness b, m.
    pub thickness_m: f64,
    /// Slenderness h/b.
    pub slenderness: f64,
    /// The mechanism that governs.
    pub mechanism: String,
    /// α_0.
    pub alpha_0: f64,
    /// d_0, m.
    pub d_0_m: f64,
    /// ζ of the nonlinear check; `None` beyond 10 g.
    pub zeta_static: Option<f64>,
    /// ζ of the linear check, q = 2.
    pub zeta_linear: Option<f64>,
    /// Factor on all records at which the dynamics no longer accept SLV.
    pub zeta_dynamic: Option<f64>,
    /// Whether the dynamics accept it at every factor that was tried.
    pub always_accepted: bool,
    /// Both at the records' own scale.
    pub agreement: Agreement,
}

/// Shares of the façades of a configuration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Shares {
    /// How the floor runs.
    pub configuration: Configuration,
    /// Façades.
    pub facades: usize,
    /// Both accept.
    pub both_accept: f64,
    /// Both refuse.
    pub both_refuse: f64,
    /// The code refuses walls that stand.
    pub static_refuses: f64,
    /// The code accepts walls that fall, or go too far.
    pub dynamic_refuses: f64,
    /// Median of ζ dynamic over ζ static, where both are told.
    pub median_ratio: Option<f64>,
}

/// Shares of the façades of a configuration that are refused where a_g and all records are times a factor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ByFactor {
    /// How the floor runs.
    pub configuration: Configuration,
    /// The factor.
    pub factor: f64,
    /// Both refuse.
    pub both_refuse: f64,
    /// The code refuses walls that stand.
    pub static_refuses: f64,
    /// The code accepts walls that fall, or go too far.
    pub dynamic_refuses: f64,
}

/// All façades.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Portfolio {
    /// Name of the site.
    pub site: String,
    /// Name of the suite.
    pub suite: String,
    /// Whether its records are generated.
    pub generated: bool,
    /// FC of the code's check.
    pub confidence_factor: f64,
    /// One a configuration.
    pub shares: Vec<Shares>,
    /// The same where site and records are stronger or weaker by a factor.
    pub by_factor: Vec<ByFactor>,
    /// One a façade.
    pub rows: Vec<Row>,
}

/// What is asked.
#[derive(Debug)]
pub struct Question<'a> {
    /// The survey.
    pub survey: &'a Survey,
    /// The site.
    pub site: &'a SiteFile,
    /// Coefficients C_l.
    pub coefficients: [f64; 8],
    /// Motions where the façades stand.
    pub motions: &'a [(String, Accelerogram)],
    /// Thicknesses and slendernesses.
    pub counts: [u32; 2],
}

/// Middles of equal shares of a log-normal with the survey's μ as median and β = ½ ln(upper/lower).
fn middles([low, middle, high]: [f64; 3], count: u32) -> Vec<f64> {
    let beta = 0.5 * (high / low).abs().ln();
    let z = |i: u32| normal::quantile((f64::from(i) + 0.5) / f64::from(count));
    (0..count).map(|i| middle * (beta * z(i)).exp()).collect()
}

impl Question<'_> {
    /// The façades: configuration slowest, then thickness, then slenderness.
    fn facades(&self) -> Vec<(Configuration, Facade)> {
        let assumptions = Assumptions::default();
        let [_, crack_height_ratio, _] = self.survey.wall.crack_height_ratio;
        let [_, compressive_strength_pa, _] = self.survey.wall.compressive_strength_pa;
        let thicknesses_m = middles(self.survey.wall.thickness_m, self.counts[0]);
        let slendernesses = middles(self.survey.wall.slenderness, self.counts[1]);
        let mut all = Vec::new();
        for configuration in Configuration::ALL {
            let floor = self.survey.floor(configuration);
            for &thickness_m in &thicknesses_m {
                all.extend(slendernesses.iter().map(|&slenderness| {
                    let facade = Facade {
                        thickness_m,
                        slenderness,
                        crack_height_ratio,
                        compressive_strength_pa,
                        stiffness_n_per_m: floor.stiffness_n_per_m[1],
                        diaphragm_mass_ratio: floor.diaphragm_mass_ratio[1],
                        carriage_mass_ratio: floor.carriage_mass_ratio[1],
                        length_m: assumptions.length_m,
                        density_kg_m3: assumptions.density_kg_m3,
                    };
                    (configuration, facade)
                }));
            }
        }
        all
    }

    /// How many façades there are.
    pub fn count(&self) -> u64 {
        2 * u64::from(self.counts[0]) * u64::from(self.counts[1])
    }

    /// Assesses every façade, on the threads of the current pool.
    ///
    /// # Errors
    /// A façade that no wall can be; a run that could not be finished.
    pub fn rows(&self, done: impl Fn() + Sync) -> Result<Vec<Row>> {
        let facades = self.facades();
        let row = |(configuration, facade): &(Configuration, Facade)| self.row(*configuration, facade);
        facades.par_iter().map(row).inspect(|_| done()).collect()
    }

    fn row(&self, configuration: Configuration, facade: &Facade) -> Result<Row> {
        let at = format!("b = {:.3} m, h/b = {:.2}", facade.thickness_m, facade.slenderness);
        let impossible = |found: String| {
            InputError::option("SURVEY", format!("{at}: {found}"), "façades that stand and have a mechanism")
        };
        let restitution = Restitution { coefficients: self.coefficients, ..Restitution::default() };
        let ratio = Assumptions::default().collapse_rotation_ratio;
        let wall = facade.wall(restitution, ratio).map_err(|e| impossible(e.to_string()))?;
        let assessment = Assessment::of(&wall, self.site).map_err(|e| impossible(e.to_string()))?;
        let failed = |e: Unfinished| Error::Run {
            time_s: e.time_s,
            reason: format!("{}, under {}, {at}", e.reason, e.record),
        };
        let (accepted, search) = self.dynamics(&wall, &assessment).map_err(failed)?;
        let zeta_dynamic = match search {
            Search::Exceeded { below, above, .. } => Some((below * above).sqrt()),
            Search::Stood { .. } => None,
            Search::Always { .. } => Some(0.0),
        };
        Ok(Row {
            configuration,
            thickness_m: facade.thickness_m,
            slenderness: facade.slenderness,
            mechanism: assessment.mechanism.name().to_owned(),
            alpha_0: assessment.alpha_0,
            d_0_m: assessment.d_0_m,
            zeta_static: assessment.check.zeta,
            zeta_linear: assessment.check.linear.zeta,
            zeta_dynamic,
            always_accepted: zeta_dynamic.is_none(),
            agreement: Agreement::between(assessment.check.accepted, accepted),
        })
    }

    /// Whether the dynamics accept a wall at the records' own scale, and the factor at which they no longer do.
    fn dynamics(&self, wall: &Wall, assessment: &Assessment) -> Result<(bool, Search<()>), Unfinished> {
        let shaken = Shaken { wall, capacity: &assessment.capacity, accuracy: Accuracy::default() };
        let accepted = shaken.accepts_slv(self.motions, 1.0)?;
        let mut refused = |factor| shaken.accepts_slv(self.motions, factor).map(|accepted| (!accepted, ()));
        Ok((accepted, LADDER.first_exceeding(&mut refused)?))
    }
}

/// Shares of a configuration's façades.
pub fn shares(rows: &[Row]) -> Vec<Shares> {
    let of = |configuration: Configuration| {
        let own: Vec<&Row> = rows.iter().filter(|row| row.configuration == configuration).collect();
        let share = |agreement: Agreement| {
            own.iter().filter(|row| row.agreement == agreement).count() as f64 / own.len().max(1) as f64
        };
        let ratios: Vec<f64> =
            own.iter().filter_map(|row| Some(row.zeta_dynamic? / row.zeta_static?)).collect();
        Shares {
            configuration,
            facades: own.len(),
            both_accept: share(Agreement::BothAccept),
            both_refuse: share(Agreement::BothRefuse),
            static_refuses: share(Agreement::StaticRefuses),
            dynamic_refuses: share(Agreement::DynamicRefuses),
            median_ratio: median(&ratios),
        }
    };
    Configuration::ALL.map(of).to_vec()
}

/// Factors at which shares are told: 3.5 % apart, from half to eight times the site's a_g.
const FACTORS: u32 = 80;

/// Shares of a configuration's façades by the factor on site and records: a check refuses where its ζ is below the factor.
pub fn by_factor(rows: &[Row]) -> Vec<ByFactor> {
    // Without a ζ a check accepts whatever was asked.
    let refuses = |zeta: Option<f64>, factor: f64| zeta.is_some_and(|zeta| zeta < factor);
    let at = |configuration: Configuration, step: u32| {
        let factor = 0.5 * 16f64.powf(f64::from(step) / f64::from(FACTORS));
        let own: Vec<&Row> = rows.iter().filter(|row| row.configuration == configuration).collect();
        let share = |by_code: bool, by_dynamics: bool| {
            let alike = |row: &&&Row| {
                (refuses(row.zeta_static, factor), refuses(row.zeta_dynamic, factor))
                    == (by_code, by_dynamics)
            };
            own.iter().filter(alike).count() as f64 / own.len().max(1) as f64
        };
        ByFactor {
            configuration,
            factor,
            both_refuse: share(true, true),
            static_refuses: share(true, false),
            dynamic_refuses: share(false, true),
        }
    };
    Configuration::ALL.into_iter().flat_map(|floor| (0..=FACTORS).map(move |step| at(floor, step))).collect()
}

/// Name of an agreement in tables.
pub fn agreement_name(agreement: Agreement) -> &'static str {
    match agreement {
        Agreement::BothAccept => "both_accept",
        Agreement::BothRefuse => "both_refuse",
        Agreement::StaticRefuses => "static_refuses",
        Agreement::DynamicRefuses => "dynamic_refuses",
    }
}

/// The columns of `portfolio.parquet` and of the table on stdout.
pub static COLUMNS: [Column<Row>; 11] = [
    Column::input(
        "configuration",
        "",
        "how the floor runs",
        Read::Text(|r| Some(Cow::Borrowed(r.configuration.name()))),
    ),
    Column::input("thickness_m", "m", "thickness b", Read::Number(|r| Some(r.thickness_m))),
    Column::input("slenderness", "", "h/b", Read::Number(|r| Some(r.slenderness))),
    Column::result(
        "mechanism",
        "",
        "that governs",
        Read::Text(|r| Some(Cow::Borrowed(r.mechanism.as_str()))),
    ),
    Column::result("alpha_0", "", "multiplier of the mechanism", Read::Number(|r| Some(r.alpha_0))),
    Column::result("d_0_m", "m", "displacement at which it vanishes", Read::Number(|r| Some(r.d_0_m))),
    Column::result("zeta_static", "", "a_g,SLV/a_g of the nonlinear check", Read::Number(|r| r.zeta_static)),
    Column::result("zeta_linear", "", "the same of the linear check, q = 2", Read::Number(|r| r.zeta_linear)),
    Column::result(
        "zeta_dynamic",
        "",
        "factor on the records at which the dynamics no longer accept SLV",
        Read::Number(|r| r.zeta_dynamic),
    ),
    Column::result(
        "always_accepted",
        "",
        "the dynamics accept it at every factor tried",
        Read::Flag(|r| Some(r.always_accepted)),
    ),
    Column::result(
        "agreement",
        "",
        "of both at the records' own scale",
        Read::Text(|r| Some(Cow::Borrowed(agreement_name(r.agreement)))),
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_middles_of_equal_shares_hold_the_median_and_the_levels() {
        let seven = middles([0.25, 0.5, 1.0], 7);
        assert!((seven[3] - 0.5).abs() < 1e-15 && seven.is_sorted());
        // β = ln 2: the value at a probability of 1/14 is 0.5·2^z.
        assert!((seven[0] - 0.5 * 2f64.powf(normal::quantile(1.0 / 14.0))).abs() < 1e-15);
        // Their product is the median to the power of their number: the distribution is even in the logarithm.
        assert!((seven.iter().map(|x| x.ln()).sum::<f64>() - 7.0 * 0.5_f64.ln()).abs() < 1e-13);
    }

    fn row(configuration: Configuration, zeta_static: Option<f64>, zeta_dynamic: Option<f64>) -> Row {
        Row {
            configuration,
            thickness_m: 0.5,
            slenderness: 12.0,
            mechanism: "restrained".into(),
            alpha_0: 0.2,
            d_0_m: 0.3,
            zeta_static,
            zeta_linear: None,
            zeta_dynamic,
            always_accepted: zeta_dynamic.is_none(),
            agreement: Agreement::BothAccept,
        }
    }

    #[test]
    fn analytic_a_check_refuses_where_its_zeta_is_below_the_factor() {
        let parallel = Configuration::Parallel;
        let rows = [
            row(parallel, Some(1.0), Some(2.0)),
            row(parallel, Some(4.0), Some(2.0)),
            row(parallel, None, None),
            row(Configuration::Perpendicular, Some(0.1), Some(0.1)),
        ];
        let all = by_factor(&rows);
        let near = |factor: f64| {
            let own = all.iter().filter(|at| at.configuration == parallel);
            let at = own.min_by(|a, b| (a.factor - factor).abs().total_cmp(&(b.factor - factor).abs()));
            let ByFactor { both_refuse, static_refuses, dynamic_refuses, .. } = *at.expect("factors");
            [both_refuse, static_refuses, dynamic_refuses].map(|share| (3.0 * share).round())
        };
        assert_eq!(near(0.6), [0.0, 0.0, 0.0]);
        assert_eq!(near(1.5), [0.0, 1.0, 0.0]);
        assert_eq!(near(3.0), [1.0, 0.0, 1.0]);
        assert_eq!(near(7.0), [2.0, 0.0, 0.0], "what has no zeta is accepted at every factor");
        assert_eq!((all[0].factor, all.last().map(|at| at.factor.round())), (0.5, Some(8.0)));
    }
}
