//! The moment of the joints in every release, as a table.

use std::path::Path;

use crate::error::Result;
use crate::store::{Column, Read, write_table};
use mrbd_lab::release::{LawKind, MomentPoint, Moments, ReleaseMoment, Told};

/// A displacement of a release.
#[derive(Debug, Clone, PartialEq)]
struct MomentRow {
    test: String,
    point: MomentPoint,
    /// Laws fitted to this release, in the order of [`LawKind::ALL`].
    laws: Vec<f64>,
}

impl MomentRow {
    fn law(&self, kind: LawKind) -> Option<f64> {
        LawKind::ALL.iter().position(|other| *other == kind).map(|k| self.laws[k])
    }
}

fn end(told: Option<Told>, which: usize) -> Option<f64> {
    told.map(|told| told.interval_90[which])
}

static COLUMNS: [Column<MomentRow>; 12] = [
    Column::input("test", "", "release", Read::Text(|r| Some(r.test.as_str().into()))),
    Column::result(
        "displacement_over_thickness",
        "1",
        "displacement of the crack over the thickness",
        Read::Number(|r| Some(r.point.displacement)),
    ),
    Column::result(
        "crack_rotation_rad",
        "rad",
        "rotation across the crack",
        Read::Number(|r| Some(r.point.crack_rotation_rad)),
    ),
    Column::result(
        "opening",
        "1",
        "moment of the joints over that of sharp edges while they open; null where the release does not tell",
        Read::Number(|r| r.point.opening.map(|told| told.share)),
    ),
    Column::result("opening_low", "1", "its 90 % interval", Read::Number(|r| end(r.point.opening, 0))),
    Column::result("opening_high", "1", "its 90 % interval", Read::Number(|r| end(r.point.opening, 1))),
    Column::result(
        "closing",
        "1",
        "the same while they close",
        Read::Number(|r| r.point.closing.map(|told| told.share)),
    ),
    Column::result("closing_low", "1", "its 90 % interval", Read::Number(|r| end(r.point.closing, 0))),
    Column::result("closing_high", "1", "its 90 % interval", Read::Number(|r| end(r.point.closing, 1))),
    Column::result(
        "bed",
        "1",
        "a bed in both joints, fitted to this release",
        Read::Number(|r| r.law(LawKind::Bed)),
    ),
    Column::result("trilinear", "1", "the same of three lines", Read::Number(|r| r.law(LawKind::Trilinear))),
    Column::result("rounded", "1", "the same of worn edges", Read::Number(|r| r.law(LawKind::Rounded))),
];

/// Writes the moments of releases.
///
/// # Errors
/// [`crate::Error::Table`] or [`mrbd_files::Error::Io`] if the file cannot be written.
pub fn write_moments(path: &Path, moments: &Moments) -> Result<()> {
    let of_release = |release: &ReleaseMoment| {
        let laws = moments.laws.iter().filter(|law| law.fitted_to == release.test).collect::<Vec<_>>();
        let row = |point: &MomentPoint| MomentRow {
            test: release.test.clone(),
            point: *point,
            laws: laws.iter().map(|fitted| fitted.law.share(&moments.strip, point.displacement)).collect(),
        };
        release.points.iter().map(row).collect::<Vec<_>>()
    };
    let rows = moments.releases.iter().flat_map(of_release).collect::<Vec<_>>();
    write_table(path, &COLUMNS, &[], &rows)
}
