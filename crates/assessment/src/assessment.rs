//! A whole assessment: mechanisms, capacity, the code's check and the dynamics, as results keep it.

use serde::{Deserialize, Serialize};

use crate::capacity::{Capacity, Governing, NoMechanism, least_crack, mechanisms};
use crate::check::StaticCheck;
use crate::dynamic::Dynamic;
use crate::site_file::SiteFile;
use crate::site_records::SiteRecords;
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::Wall;
use mrbd_statics::{Edges, LeastCrack, Mechanism};

/// α_0 and e* of a mechanism that a wall has.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MechanismRow {
    /// The mechanism.
    pub mechanism: Mechanism,
    /// α_0 (C8.7.1.1).
    pub alpha_0: f64,
    /// e* (C8.7.1.5).
    pub e_star: f64,
}

/// What the static check and the dynamics say together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Agreement {
    /// Both accept.
    BothAccept,
    /// Both refuse.
    BothRefuse,
    /// The static check refuses what the dynamics accept.
    StaticRefuses,
    /// The static check accepts what the dynamics refuse.
    DynamicRefuses,
}

impl Agreement {
    /// Of the static check and of the dynamics: whether each accepts.
    pub fn between(by_code: bool, by_dynamics: bool) -> Self {
        match (by_code, by_dynamics) {
            (true, true) => Self::BothAccept,
            (false, false) => Self::BothRefuse,
            (false, true) => Self::StaticRefuses,
            (true, false) => Self::DynamicRefuses,
        }
    }
}

/// The capacity with other edges of the joints, side by side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EdgeRow {
    /// `full`: faces of the wall; `crushed`: its narrowed widths; `compliant`: those on its beds.
    pub edges: EdgeName,
    /// α_0.
    pub alpha_0: f64,
    /// The largest multiplier on the way.
    pub alpha_largest: f64,
    /// d_0, m.
    pub d_0_m: f64,
}

/// Names of [`Edges`] in results.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EdgeName {
    /// [`Edges::Full`].
    Full,
    /// [`Edges::Crushed`].
    Crushed,
    /// [`Edges::AsTheyAre`].
    Compliant,
}

/// An assessment. The first keys are those that scripts read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Assessment {
    /// The mechanism that governs.
    pub mechanism: Governing,
    /// Its α_0.
    pub alpha_0: f64,
    /// Its e*.
    pub e_star: f64,
    /// d_0, m.
    pub d_0_m: f64,
    /// The code's check where the wall stands.
    #[serde(flatten)]
    pub check: StaticCheck,
    /// The same at the ground, for a wall on a floor.
    pub at_ground: Option<StaticCheck>,
    /// The dynamics, where records were given.
    pub dynamic: Option<Dynamic>,
    /// What the records' own spectra ask, where records were given.
    pub site_records: Option<SiteRecords>,
    /// Both together, where there are dynamics.
    pub agreement: Option<Agreement>,
    /// Every mechanism that the wall has.
    pub mechanisms: Vec<MechanismRow>,
    /// The crack of least α_0 with the top held.
    pub least_crack: LeastCrack,
    /// The capacity that the check uses.
    pub capacity: Capacity,
    /// Capacities with other edges.
    pub edges: Vec<EdgeRow>,
    /// The site file.
    pub site: SiteFile,
}

impl Assessment {
    /// The code's check of a wall; the dynamics are added by [`Assessment::with_dynamic`].
    ///
    /// # Errors
    /// [`NoMechanism`].
    pub fn of(wall: &Wall, site: &SiteFile) -> Result<Self, NoMechanism> {
        let capacity = Capacity::of(wall, Edges::AsTheyAre)?;
        let named = [(EdgeName::Full, Edges::Full), (EdgeName::Crushed, Edges::Crushed)];
        let of = |(name, edges)| Capacity::of(wall, edges).map(|capacity| row(name, &capacity));
        let mut edges = named.into_iter().map(of).collect::<Result<Vec<_>, _>>()?;
        edges.push(row(EdgeName::Compliant, &capacity));
        let mechanisms = mechanisms(wall).into_iter().map(|(mechanism, work)| MechanismRow {
            mechanism,
            alpha_0: work.alpha_0(),
            e_star: work.e_star(),
        });
        Ok(Self {
            mechanism: capacity.mechanism,
            alpha_0: capacity.alpha_0,
            e_star: capacity.e_star,
            d_0_m: capacity.d_0_m,
            check: StaticCheck::of(wall, &capacity, site, false),
            at_ground: site.floor().map(|_| StaticCheck::of(wall, &capacity, site, true)),
            dynamic: None,
            site_records: None,
            agreement: None,
            mechanisms: mechanisms.collect(),
            least_crack: least_crack(wall),
            capacity,
            edges,
            site: site.clone(),
        })
    }

    /// With what the motions where the wall stands ask of it by their own spectra.
    #[must_use]
    pub fn with_site_records(self, motions: &[(String, Accelerogram)]) -> Self {
        let site_records = Some(SiteRecords::of(&self.check, motions));
        Self { site_records, ..self }
    }

    /// With the dynamics beside the code's check.
    pub fn with_dynamic(self, dynamic: Dynamic) -> Self {
        let agreement = Agreement::between(self.check.accepted, dynamic.accepted_slv);
        Self { dynamic: Some(dynamic), agreement: Some(agreement), ..self }
    }
}

fn row(edges: EdgeName, capacity: &Capacity) -> EdgeRow {
    let alpha_largest = capacity.curve.iter().map(|point| point.alpha).fold(0.0, f64::max);
    EdgeRow { edges, alpha_0: capacity.alpha_0, alpha_largest, d_0_m: capacity.d_0_m }
}
