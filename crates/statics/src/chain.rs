//! A wall as a chain of rigid bodies: where its masses are at a rotation, and how they move as it turns.

use mrbd_kernel::model::{G_M_S2, Wall};

use crate::joint::Joint;

/// Which edges the joints of a wall have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edges {
    /// The faces of the wall: the full thickness, sharp.
    Full,
    /// The corners of the wall file, narrowed by crushing, sharp.
    Crushed,
    /// The corners of the wall file, with the laws that its effects give the joints.
    AsTheyAre,
}

/// Towards which side the wall is pushed, or falls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Towards +x.
    Right,
    /// Towards -x.
    Left,
}

impl Side {
    /// +1 or -1.
    pub fn sign(self) -> f64 {
        match self {
            Side::Right => 1.0,
            Side::Left => -1.0,
        }
    }
}

/// One or two rigid bodies, one on the other, with what is at their top.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chain {
    /// Heights of the bodies h_1, h_2, m; one body has h_2 = 0.
    pub height_m: [f64; 2],
    /// Masses of the bodies, kg.
    pub mass_kg: [f64; 2],
    /// m_d: at the top C, carried and pushing (P_k), kg.
    pub carried_kg: f64,
    /// m_dp: at C, pushing only (Q_k), kg.
    pub pushing_kg: f64,
    /// Offset of C from the middle, towards the side of the fall, m.
    pub eccentricity_m: f64,
    /// Joints at the ground and at the crack.
    pub joints: [Joint; 2],
    /// Whether it has a crack that can open.
    pub cracked: bool,
}

/// A displacement and its derivatives by θ_1 and θ_2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moved {
    /// Displacement, m.
    pub by_m: f64,
    /// Derivatives, m/rad.
    pub slope_m: [f64; 2],
}

impl Moved {
    fn scaled(self, factor: f64) -> Self {
        Self { by_m: factor * self.by_m, slope_m: self.slope_m.map(|slope| factor * slope) }
    }

    fn plus(self, other: Self) -> Self {
        let slope_m = [0, 1].map(|i| self.slope_m[i] + other.slope_m[i]);
        Self { by_m: self.by_m + other.by_m, slope_m }
    }
}

/// Displacements of the centres of mass, of the middle of the crack and of the top.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moves {
    /// Sideways and up, of G_1 and G_2.
    pub bodies: [[Moved; 2]; 2],
    /// Sideways and up, of the middle of the crack.
    pub crack: [Moved; 2],
    /// Sideways and up, of C.
    pub top: [Moved; 2],
}

impl Chain {
    /// The bodies of a wall that falls to a side. An eccentricity towards that side counts as positive.
    pub fn of(wall: &Wall, edges: Edges, side: Side) -> Self {
        let p = wall.parameters();
        let h_1 = p.crack_height_m.unwrap_or(p.height_m);
        let height_m = [h_1, p.height_m - h_1];
        let mass_kg = height_m.map(|h_i| p.mass_kg * h_i / p.height_m);
        let widths_m = if edges == Edges::Full { [p.thickness_m; 2] } else { wall.width_m() };
        let laws = if edges == Edges::AsTheyAre { wall.joint_laws() } else { [None; 2] };
        let above_kg = [p.mass_kg + p.diaphragm_mass_kg, mass_kg[1] + p.diaphragm_mass_kg];
        let joint = |i: usize| match laws[i] {
            Some(law) => Joint::by_law(widths_m[i], above_kg[i] * G_M_S2, law),
            None => Joint::sharp(widths_m[i], above_kg[i] * G_M_S2),
        };
        Self {
            height_m,
            mass_kg,
            carried_kg: p.diaphragm_mass_kg,
            pushing_kg: p.carriage_mass_kg,
            eccentricity_m: side.sign() * p.eccentricity_m,
            joints: [joint(0), joint(1)],
            cracked: p.crack_height_m.is_some(),
        }
    }

    /// The same wall with its crack kept closed: one block.
    pub fn without_crack(self) -> Self {
        let [h_1, h_2] = self.height_m;
        let [m_1, m_2] = self.mass_kg;
        Self { height_m: [h_1 + h_2, 0.0], mass_kg: [m_1 + m_2, 0.0], cracked: false, ..self }
    }

    /// What stands above the crack, on a base that does not move.
    pub fn above_crack(self) -> Self {
        let joints = [self.joints[1]; 2];
        let [height_m, mass_kg] = [[self.height_m[1], 0.0], [self.mass_kg[1], 0.0]];
        Self { height_m, mass_kg, joints, cracked: false, ..self }
    }

    /// Weight of the bodies, N.
    pub fn weight_n(&self) -> f64 {
        (self.mass_kg[0] + self.mass_kg[1]) * G_M_S2
    }

    /// Σ (P_k + Q_k): everything that pushes, N.
    pub fn pushing_n(&self) -> f64 {
        self.weight_n() + (self.carried_kg + self.pushing_kg) * G_M_S2
    }

    /// Height of the whole, m.
    pub fn whole_height_m(&self) -> f64 {
        self.height_m[0] + self.height_m[1]
    }

    /// Displacements at rotations, about the corners on these sides (+1 right, -1 left) of ground and crack.
    ///
    /// Each body turns about its corner (finite rotations). A bed changes the moment of a joint, not this.
    pub fn moves(&self, theta_rad: [f64; 2], [s_1, s_2]: [f64; 2]) -> Moves {
        let [h_1, h_2] = self.height_m;
        let o = s_1 * self.joints[0].width_m / 2.0;
        let q = s_2 * self.joints[1].width_m / 2.0;
        let arm = |x: f64, y: f64, body: usize| turned([x, y], theta_rad[body], body);
        let to_q = arm(q - o, h_1, 0);
        let add = |a: [Moved; 2], b: [Moved; 2]| [a[0].plus(b[0]), a[1].plus(b[1])];
        Moves {
            bodies: [arm(-o, h_1 / 2.0, 0), add(to_q, arm(-q, h_2 / 2.0, 1))],
            crack: arm(-o, h_1, 0),
            top: add(to_q, arm(self.eccentricity_m - q, h_2, 1)),
        }
    }

    /// Σ (P_k + Q_k) x_k, N m: what a uniform acceleration of 1 g works on.
    pub fn pushed(&self, moves: &Moves) -> Moved {
        let top = moves.top[0].scaled((self.carried_kg + self.pushing_kg) * G_M_S2);
        let body = |i: usize| moves.bodies[i][0].scaled(self.mass_kg[i] * G_M_S2);
        body(0).plus(body(1)).plus(top)
    }

    /// Σ P_k y_k, J: the weights lifted.
    pub fn lifted(&self, moves: &Moves) -> Moved {
        let top = moves.top[1].scaled(self.carried_kg * G_M_S2);
        let body = |i: usize| moves.bodies[i][1].scaled(self.mass_kg[i] * G_M_S2);
        body(0).plus(body(1)).plus(top)
    }
}

/// Displacement of the end of an arm that turns by θ > 0 clockwise with a body.
fn turned([x, y]: [f64; 2], theta_rad: f64, body: usize) -> [Moved; 2] {
    let (sin, cos) = theta_rad.sin_cos();
    let [across, up] = [x * cos + y * sin, y * cos - x * sin];
    // 1 - cos θ without cancellation, so that small displacements keep their digits.
    let versine = 2.0 * (theta_rad / 2.0).sin().powi(2);
    let along = |slope: f64| if body == 0 { [slope, 0.0] } else { [0.0, slope] };
    [
        Moved { by_m: y * sin - x * versine, slope_m: along(up) },
        Moved { by_m: -y * versine - x * sin, slope_m: along(-across) },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::model::{Contact, Pivot, RockingWall, State, WallParameters};

    fn wall() -> Wall {
        let strip = WallParameters::strip(0.291, 3.984, 2078.0);
        let parameters = WallParameters {
            crack_height_m: Some(2.191),
            lower_width_m: 0.271,
            upper_width_m: 0.281,
            diaphragm_mass_kg: 179.0,
            carriage_mass_kg: 663.0,
            eccentricity_m: 0.05,
            ..strip
        };
        Wall::new(parameters).expect("a wall")
    }

    #[test]
    fn analytic_places_and_weights_are_those_of_the_moving_wall() {
        let (wall, theta) = (wall(), [0.03, -0.02]);
        let chain = Chain::of(&wall, Edges::Crushed, Side::Right);
        let moves = chain.moves(theta, [1.0, -1.0]);
        let contact = Contact { ground: Pivot::Right, crack: Pivot::Left };
        let rocking = RockingWall::new(&wall);
        // Roundings of a dozen products.
        assert!((moves.top[0].by_m - rocking.top_displacement_m(contact, theta)).abs() < 1e-14);
        assert!((moves.crack[0].by_m - rocking.crack_displacement_m(theta[0])).abs() < 1e-14);
        let still = State { theta, omega: [0.0; 2] };
        assert!((chain.lifted(&moves).by_m - rocking.energy_j(contact, &still)).abs() < 1e-9);
    }

    #[test]
    fn analytic_slopes_are_derivatives() {
        let chain = Chain::of(&wall(), Edges::Crushed, Side::Left);
        let (theta, sides, step) = ([0.03, -0.02], [1.0, -1.0], 1e-6);
        let at = chain.moves(theta, sides);
        for body in 0..2 {
            let shifted = |by: f64| {
                let mut theta = theta;
                theta[body] += by;
                chain.moves(theta, sides)
            };
            let [before, after] = [shifted(-step), shifted(step)];
            for (slope, [before, after]) in [
                (chain.lifted(&at).slope_m[body], [chain.lifted(&before).by_m, chain.lifted(&after).by_m]),
                (chain.pushed(&at).slope_m[body], [chain.pushed(&before).by_m, chain.pushed(&after).by_m]),
            ] {
                // Central differences of joules: step² times 1e4, and roundings of 1e-11/1e-6.
                assert!(((after - before) / (2.0 * step) - slope).abs() < 1e-4, "{slope}");
            }
        }
    }
}
