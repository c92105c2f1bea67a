//! Accelerations of the two bodies under gravity, ground motion, corners and top.

use nalgebra::{Matrix3, Vector3};

use super::corner::{Corner, Relative};
use super::wall::{CompliantWall, JOINTS};
use super::{Coordinates, G_M_S2};

/// A wall with its corners, ready to move.
#[derive(Debug, Clone)]
pub struct Bodies {
    pub wall: CompliantWall,
    /// Corners at the ground and at the crack.
    pub corners: [Corner; 2],
}

/// A point of a body: its arm from the centre of mass, turned, its displacement from rest and its velocity.
#[derive(Debug, Clone, Copy)]
struct Point {
    arm_m: [f64; 2],
    displacement_m: [f64; 2],
    velocity_m_s: [f64; 2],
}

/// Both bodies as they stand and move, sines and cosines taken once.
#[derive(Debug, Clone, Copy)]
pub struct Pose<'a> {
    q: &'a Coordinates,
    v: &'a Coordinates,
    sin_cos: [(f64, f64); 2],
    /// cos θ - 1 by itself: displacements are differences of nearly equal numbers.
    cos_less_1: [f64; 2],
}

impl<'a> Pose<'a> {
    pub fn new(q: &'a Coordinates, v: &'a Coordinates) -> Self {
        let angles = [q[2], q[5]];
        let cos_less_1 = angles.map(|angle| -2.0 * (0.5 * angle).sin().powi(2));
        Self { q, v, sin_cos: angles.map(f64::sin_cos), cos_less_1 }
    }

    /// A point of a body, whose arm at rest is (x, y).
    fn point(&self, body: usize, [x, y]: [f64; 2]) -> Point {
        let (k, (sin, cos), cos_less_1) = (3 * body, self.sin_cos[body], self.cos_less_1[body]);
        let (q, v) = (self.q, self.v);
        let arm_m = [x * cos + y * sin, -x * sin + y * cos];
        Point {
            arm_m,
            displacement_m: [q[k] + x * cos_less_1 + y * sin, q[k + 1] - x * sin + y * cos_less_1],
            velocity_m_s: [v[k] + v[k + 2] * arm_m[1], v[k + 1] - v[k + 2] * arm_m[0]],
        }
    }

    /// Normal and tangent of a joint: it turns with the body below.
    fn axes(&self, joint: usize) -> [[f64; 2]; 2] {
        let (sin, cos) = if joint == 1 { self.sin_cos[0] } else { (0.0, 1.0) };
        [[sin, cos], [cos, -sin]]
    }
}

impl Bodies {
    /// A wall at rest, pressed into its corners by its weight.
    pub fn new(wall: CompliantWall) -> (Self, Coordinates) {
        // At a corner the other end of a slender body hardly moves with it: about a quarter of its mass does.
        let moved_kg = 0.25 * wall.mass_kg[0].min(wall.mass_kg[1]);
        let mut corners = match wall.corners {
            Some(alike) => JOINTS.map(|joint| Corner::alike(alike, wall.weight_above_n(joint))),
            None => Corner::of_wall(wall.weight_above_n(0), moved_kg),
        };
        for joint in JOINTS {
            if let Some(bed) = wall.beds[joint] {
                corners[joint] = Corner::of_bed(bed, wall.weight_above_n(joint), wall.width_m(joint));
            }
        }
        let depth = |joint: usize| {
            let springs = wall.contacts_m(joint).len() as f64;
            wall.weight_above_n(joint) / (springs * corners[joint].stiffness_n_per_m)
        };
        let mut rest = Coordinates::zeros();
        rest[1] = -depth(0);
        rest[4] = -depth(0) - depth(1);
        (Self { wall, corners }, rest)
    }

    /// The top C.
    fn top(&self, pose: &Pose) -> Point {
        pose.point(1, [self.wall.eccentricity_m, 0.5 * self.wall.height_m[1]])
    }

    /// Horizontal displacement of the top, m.
    pub fn top_displacement_m(&self, q: &Coordinates) -> f64 {
        self.top(&Pose::new(q, &Coordinates::zeros())).displacement_m[0]
    }

    /// The two faces of a corner: the one above, and the one below where a body is below.
    fn faces(&self, joint: usize, side: usize, pose: &Pose) -> (Point, Option<Point>) {
        self.faces_at(joint, self.wall.corner_x_m[joint][side], pose)
    }

    /// The same at a distance from the wall's axis, m.
    fn faces_at(&self, joint: usize, x: f64, pose: &Pose) -> (Point, Option<Point>) {
        let above = pose.point(joint, [x, -0.5 * self.wall.height_m[joint]]);
        let below = (joint == 1).then(|| pose.point(0, [x, 0.5 * self.wall.height_m[0]]));
        (above, below)
    }

    /// How a corner's faces stand to each other.
    pub fn relative(&self, joint: usize, side: usize, pose: &Pose) -> Relative {
        let (above, below) = self.faces(joint, side, pose);
        between_faces(pose.axes(joint), &above, below.as_ref())
    }

    /// Generalised forces of all corners, N and N m.
    fn corner_forces(&self, pose: &Pose, total: &mut Coordinates) {
        for joint in JOINTS {
            let axes = pose.axes(joint);
            for x in self.wall.contacts_m(joint) {
                let (above, below) = self.faces_at(joint, x, pose);
                let relative = between_faces(axes, &above, below.as_ref());
                if relative.gap_m >= 0.0 {
                    continue;
                }
                let [n, t] = self.corners[joint].force_n(relative);
                let force = [0, 1].map(|k| n * axes[0][k] + t * axes[1][k]);
                push(total, joint, above.arm_m, force);
                if let Some(below) = below {
                    push(total, 0, below.arm_m, [-force[0], -force[1]]);
                }
            }
        }
    }

    /// Accelerations under this ground acceleration (x, y), m/s² and rad/s².
    pub fn acceleration(&self, ground_m_s2: [f64; 2], q: &Coordinates, v: &Coordinates) -> Coordinates {
        let wall = &self.wall;
        let pose = Pose::new(q, v);
        let mut force = Coordinates::zeros();
        self.corner_forces(&pose, &mut force);
        let fall = [-ground_m_s2[0], -G_M_S2 - ground_m_s2[1]];
        for body in JOINTS {
            let m = wall.mass_kg[body];
            push(&mut force, body, [0.0; 2], [m * fall[0], m * fall[1]]);
        }
        let [c_ground, c_crack] = wall.joint_damping_n_m_s;
        let turned = [[q[2], v[2]], [q[5] - q[2], v[5] - v[2]]];
        let by_law = |joint: usize| {
            wall.joint_laws[joint]
                .iter()
                .map(|law| law.force([turned[joint][0], turned[joint][1], 0.0]))
                .sum::<f64>()
        };
        let at_crack = c_crack * turned[1][1] - by_law(1);
        force[2] += at_crack - c_ground * v[2] + by_law(0);
        force[5] -= at_crack;
        force[2] -= wall.body_damping_n_m_s[0] * v[2];
        force[5] -= wall.body_damping_n_m_s[1] * v[5];

        let top = self.top(&pose);
        let masses = wall.top_masses_kg();
        let law: f64 =
            wall.top.iter().map(|law| law.force_n(top.displacement_m[0], top.velocity_m_s[0])).sum();
        let rattle = wall
            .loose
            .map_or(0.0, |loose| loose.force_n(q[6] - top.displacement_m[0], v[6] - top.velocity_m_s[0]));
        let omega_2 = v[5] * v[5];
        // Weight, inertia and centripetal pull of the masses at the top.
        let at_top = [
            law - rattle + masses[0] * (fall[0] + top.arm_m[0] * omega_2),
            masses[1] * (fall[1] + top.arm_m[1] * omega_2),
        ];
        push(&mut force, 1, top.arm_m, at_top);
        self.divided_by_mass(force, top.arm_m, fall[0], rattle)
    }

    fn divided_by_mass(&self, force: Coordinates, arm_m: [f64; 2], fall_x: f64, rattle: f64) -> Coordinates {
        let lower = [self.wall.mass_kg[0], self.wall.mass_kg[0], self.wall.inertia_kg_m2[0]];
        let upper = self.upper_inverse_mass(arm_m) * Vector3::new(force[3], force[4], force[5]);
        let loose = self.wall.loose.map_or(0.0, |loose| fall_x + rattle / loose.mass_kg);
        Coordinates::from([
            force[0] / lower[0],
            force[1] / lower[1],
            force[2] / lower[2],
            upper[0],
            upper[1],
            upper[2],
            loose,
        ])
    }

    /// Inverse of the mass matrix of the upper body with the masses at the end of an arm.
    fn upper_inverse_mass(&self, arm_m: [f64; 2]) -> Matrix3<f64> {
        let (m, [m_x, m_y], [x, y]) = (self.wall.mass_kg[1], self.wall.top_masses_kg(), arm_m);
        #[rustfmt::skip]
        let mass = Matrix3::new(
            m + m_x,    0.0,        m_x * y,
            0.0,        m + m_y,    -m_y * x,
            m_x * y,    -m_y * x,   self.wall.inertia_kg_m2[1] + m_x * y * y + m_y * x * x,
        );
        mass.try_inverse().expect("masses are positive, so the matrix is positive definite")
    }

    /// Inverse mass matrix of both bodies.
    pub fn inverse_mass(&self, q: &Coordinates) -> nalgebra::Matrix6<f64> {
        let mut inverse = nalgebra::Matrix6::zeros();
        let [m, i] = [self.wall.mass_kg[0], self.wall.inertia_kg_m2[0]];
        inverse.fixed_view_mut::<3, 3>(0, 0).set_diagonal(&Vector3::new(1.0 / m, 1.0 / m, 1.0 / i));
        let arm_m = self.top(&Pose::new(q, &Coordinates::zeros())).arm_m;
        inverse.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.upper_inverse_mass(arm_m));
        inverse
    }

    /// Rates of the opening and the sliding of a corner as rows over the velocities of both bodies.
    pub fn rows(&self, joint: usize, side: usize, q: &Coordinates) -> [nalgebra::RowVector6<f64>; 2] {
        let still = Coordinates::zeros();
        let pose = Pose::new(q, &still);
        let (above, below) = self.faces(joint, side, &pose);
        pose.axes(joint).map(|axis| {
            let mut row = nalgebra::RowVector6::zeros();
            let mut add = |body: usize, point: &Point, sign: f64| {
                row[3 * body] += sign * axis[0];
                row[3 * body + 1] += sign * axis[1];
                row[3 * body + 2] += sign * (axis[0] * point.arm_m[1] - axis[1] * point.arm_m[0]);
            };
            add(joint, &above, 1.0);
            if let Some(below) = &below {
                add(0, below, -1.0);
            }
            row
        })
    }
}

/// How two faces stand to each other along the normal and the tangent of their joint.
fn between_faces([normal, tangent]: [[f64; 2]; 2], above: &Point, below: Option<&Point>) -> Relative {
    let between = |of: fn(&Point) -> [f64; 2]| {
        let [a, b] = [of(above), below.map_or([0.0; 2], of)];
        [a[0] - b[0], a[1] - b[1]]
    };
    let displacement = between(|p| p.displacement_m);
    let velocity = between(|p| p.velocity_m_s);
    let along = |axis: [f64; 2], d: [f64; 2]| axis[0] * d[0] + axis[1] * d[1];
    Relative {
        gap_m: along(normal, displacement),
        gap_rate_m_s: along(normal, velocity),
        slip_m: along(tangent, displacement),
        slip_rate_m_s: along(tangent, velocity),
    }
}

/// Adds a force at an arm of a body; clockwise moments are positive.
fn push(total: &mut Coordinates, body: usize, arm_m: [f64; 2], force_n: [f64; 2]) {
    total[3 * body] += force_n[0];
    total[3 * body + 1] += force_n[1];
    total[3 * body + 2] += force_n[0] * arm_m[1] - force_n[1] * arm_m[0];
}
