//! The laws that a joint may have in place of sharp edges: a bed and its rivals.

use super::super::contact::Pivot;
use super::crushing::CrushingJoint;
use super::law::Bed;
use super::rounded::RoundedEdges;
use super::trilinear::TrilinearJoint;

/// The law of a joint that has no sharp edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum JointLaw {
    /// A bed of springs without tension.
    Bed(Bed),
    /// Three lines of moment against rotation.
    Trilinear(TrilinearJoint),
    /// A bed that crushes.
    Crushing(CrushingJoint),
    /// Edges worn to an arc.
    Rounded(RoundedEdges),
}

impl JointLaw {
    /// Whether the joint turns under any moment. One of rounded edges stays closed until the weight lifts off its flat.
    pub fn gives(&self) -> bool {
        !matches!(self, Self::Rounded(_))
    }

    /// Moment about the middle of the joint at a rotation in rad that nothing larger went before, N m.
    pub fn moment_n_m(&self, phi: f64) -> f64 {
        match self {
            Self::Bed(bed) => bed.moment_n_m(phi),
            Self::Trilinear(lines) => lines.moment_n_m(phi),
            Self::Crushing(bed) => bed.moment_n_m(phi),
            Self::Rounded(edges) => edges.moment_n_m(phi),
        }
    }

    /// Work of that moment from 0 to the rotation, J.
    pub fn work_j(&self, phi: f64) -> f64 {
        match self {
            Self::Bed(bed) => {
                // ∫ N (b/2 - c/3) dφ with c ∝ φ^(-1/2).
                let at = |phi: f64| bed.load_n * (bed.width_m / 2.0 - 2.0 / 3.0 * bed.contact_m(phi)) * phi;
                let (phi, closed) = (phi.abs(), phi.abs().min(bed.full_contact_rad()));
                let full_j = 0.5 * bed.rotational_stiffness_n_m() * closed * closed;
                if phi > closed { full_j + at(phi) - at(closed) } else { full_j }
            }
            Self::Trilinear(lines) => lines.load_n * lines.rise_m(phi),
            Self::Crushing(bed) => {
                let beside_rest = |phi: f64| bed.load_n * bed.rise_m(phi) + bed.stored_j(phi);
                beside_rest(phi) - beside_rest(0.0) + bed.lost_j(phi)
            }
            Self::Rounded(edges) => edges.work_j(phi),
        }
    }

    /// Rotation up to which the joint is in whole contact, rad: on its first line, of rounded edges closed.
    pub fn full_contact_rad(&self) -> f64 {
        match self {
            Self::Bed(bed) => bed.full_contact_rad(),
            Self::Trilinear(lines) => lines.first_rad,
            Self::Crushing(bed) => bed.full_contact_rad(),
            Self::Rounded(_) => 0.0,
        }
    }

    /// Whether the joint is in whole contact, or open towards a side.
    pub fn pivot(&self, phi: f64) -> Pivot {
        if phi.abs() <= self.full_contact_rad() { Pivot::Closed } else { Pivot::of_angle(phi) }
    }

    /// Moment per rotation about rest, N m; of a joint that does not turn there, none.
    pub fn rotational_stiffness_n_m(&self) -> f64 {
        match self {
            Self::Bed(bed) => bed.rotational_stiffness_n_m(),
            Self::Trilinear(lines) => lines.rotational_stiffness_n_m(),
            Self::Crushing(bed) => bed.left_bed().rotational_stiffness_n_m(),
            Self::Rounded(_) => 0.0,
        }
    }

    /// Beyond which rotation to a side another branch of the open joint's law holds, rad.
    pub(crate) fn kink_rad(&self, side: Pivot) -> Option<f64> {
        match self {
            Self::Bed(_) => None,
            Self::Trilinear(lines) => lines.kink_rad(),
            Self::Crushing(bed) => Some(bed.elastic_up_to_rad(side)),
            Self::Rounded(edges) => edges.end_rad(),
        }
    }

    /// Whether what is beyond the kink is kept: the joint crushes there, and turns back on another path.
    pub(crate) fn crushes(&self) -> bool {
        matches!(self, Self::Crushing(_))
    }

    /// The largest rotations to the right and to the left that the law remembers, rad.
    pub(crate) fn crushed_rad(&self) -> [f64; 2] {
        match self {
            Self::Crushing(bed) => bed.crushed_rad,
            Self::Bed(_) | Self::Trilinear(_) | Self::Rounded(_) => [0.0; 2],
        }
    }

    /// The law once the joint has been turned so far to a side, rad.
    #[must_use]
    pub(crate) fn turned_by(self, side: Pivot, phi: f64) -> Self {
        match self {
            Self::Crushing(bed) => Self::Crushing(bed.turned_by(side, phi)),
            other => other,
        }
    }

    /// Width between the sharp edges whose impact a joint has that is too stiff to give, m.
    pub(crate) fn edge_width_m(&self) -> f64 {
        match self {
            Self::Bed(bed) => bed.width_m,
            // Beyond its first line the body turns about the end of that.
            Self::Trilinear(lines) => lines.plateau * lines.width_m,
            Self::Crushing(bed) => bed.left_m(),
            Self::Rounded(edges) => edges.flat_m(),
        }
    }

    /// As [`Bed::passage_over_bounce`]; of three lines that of the bed which is as stiff at first. With the depth δ =
    /// b φ_c/2 to which the load presses a bed, φ_c sqrt(g/δ) = sqrt(2 g φ_c/b).
    pub(crate) fn passage_over_bounce(&self, phi_rate: f64) -> f64 {
        match self {
            Self::Bed(bed) => bed.passage_over_bounce(phi_rate),
            Self::Crushing(bed) => bed.left_bed().passage_over_bounce(phi_rate),
            Self::Trilinear(lines) => {
                let per_s2 = 2.0 * super::super::wall::G_M_S2 / lines.width_m;
                (per_s2 * lines.like_bed_rad()).sqrt() / phi_rate.abs()
            }
            Self::Rounded(_) => f64::INFINITY,
        }
    }
}
