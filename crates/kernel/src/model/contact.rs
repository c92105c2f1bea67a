//! Contact states: which corner each joint pivots on, and the paper's names for the patterns.

use serde::{Deserialize, Serialize};

use super::rocking::State;

/// One of the two joints of the wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Joint {
    /// Between the lower body and the ground.
    Ground,
    /// Between the two bodies.
    Crack,
}

/// State of one joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(i8)]
pub enum Pivot {
    /// Open, turning about the left corner: the body above leans towards -x.
    Left = -1,
    /// Closed: both corners touch.
    Closed = 0,
    /// Open, turning about the right corner: the body above leans towards +x.
    Right = 1,
}

impl Pivot {
    /// The two ways to be open.
    pub const OPEN: [Pivot; 2] = [Pivot::Right, Pivot::Left];
    /// All states, closed first.
    pub const ALL: [Pivot; 3] = [Pivot::Closed, Pivot::Right, Pivot::Left];

    /// The sign s of the model: -1, 0 or +1.
    pub fn sign(self) -> f64 {
        f64::from(self as i8)
    }

    /// The pivot a body leaning by this angle turns about; zero is closed.
    pub fn of_angle(angle_rad: f64) -> Self {
        if angle_rad > 0.0 {
            Pivot::Right
        } else if angle_rad < 0.0 {
            Pivot::Left
        } else {
            Pivot::Closed
        }
    }

    /// Whether both corners touch.
    pub fn is_closed(self) -> bool {
        self == Pivot::Closed
    }

    /// Whether one corner has lifted.
    pub fn is_open(self) -> bool {
        !self.is_closed()
    }

    /// The same joint seen in a mirror.
    #[must_use]
    pub fn mirrored(self) -> Self {
        match self {
            Pivot::Left => Pivot::Right,
            Pivot::Closed => Pivot::Closed,
            Pivot::Right => Pivot::Left,
        }
    }
}

/// State of both joints: rest, or one of the eight patterns of the paper's Fig. 4.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Contact {
    /// State s_1 of the joint at the ground.
    pub ground: Pivot,
    /// State s_2 of the joint at the crack.
    pub crack: Pivot,
}

/// Names of the nine contact states, by [`Contact::index`].
pub const PATTERN_NAMES: [&str; 9] = ["rest", "1a", "2a", "3a", "4a", "1b", "2b", "3b", "4b"];

impl Contact {
    /// Both joints closed.
    pub const REST: Contact = Contact { ground: Pivot::Closed, crack: Pivot::Closed };

    /// The nine states, by [`Contact::index`].
    pub const ALL: [Contact; 9] = {
        use Pivot::{Closed, Left, Right};
        [
            Contact { ground: Closed, crack: Closed },
            Contact { ground: Right, crack: Right },
            Contact { ground: Right, crack: Left },
            Contact { ground: Right, crack: Closed },
            Contact { ground: Closed, crack: Right },
            Contact { ground: Left, crack: Left },
            Contact { ground: Left, crack: Right },
            Contact { ground: Left, crack: Closed },
            Contact { ground: Closed, crack: Left },
        ]
    };

    /// Position in [`Contact::ALL`] and [`PATTERN_NAMES`].
    pub fn index(self) -> usize {
        const BY_SIGNS: [usize; 9] = [5, 7, 6, 8, 0, 4, 2, 3, 1];
        let column = |pivot: Pivot| (pivot as i8 + 1) as usize;
        BY_SIGNS[3 * column(self.ground) + column(self.crack)]
    }

    /// The paper's name: `rest`, `1a` … `4b`.
    pub fn name(self) -> &'static str {
        PATTERN_NAMES[self.index()]
    }

    /// The pattern's number, 1 to 4; `None` at rest.
    pub fn pattern_number(self) -> Option<u8> {
        match (self.ground.sign(), self.crack.sign()) {
            (0.0, 0.0) => None,
            (0.0, _) => Some(4),
            (_, 0.0) => Some(3),
            (s1, s2) if s1 == s2 => Some(1),
            _ => Some(2),
        }
    }

    /// The same state seen in a mirror (a to b).
    #[must_use]
    pub fn mirrored(self) -> Self {
        Contact { ground: self.ground.mirrored(), crack: self.crack.mirrored() }
    }

    /// State of a joint.
    pub fn at(self, joint: Joint) -> Pivot {
        match joint {
            Joint::Ground => self.ground,
            Joint::Crack => self.crack,
        }
    }

    /// This state with one joint changed.
    #[must_use]
    pub fn with(mut self, joint: Joint, pivot: Pivot) -> Self {
        match joint {
            Joint::Ground => self.ground = pivot,
            Joint::Crack => self.crack = pivot,
        }
        self
    }

    /// How many joints are open: the degrees of freedom.
    pub fn open_joints(self) -> usize {
        usize::from(self.ground.is_open()) + usize::from(self.crack.is_open())
    }

    /// The state of a wall with these rotations: open where an angle is not zero.
    pub fn of_rotations(theta: [f64; 2]) -> Self {
        Contact { ground: Pivot::of_angle(theta[0]), crack: Pivot::of_angle(theta[1] - theta[0]) }
    }

    /// The state of a wall with these rotations; where an angle is zero, the joint opens as its velocity says.
    pub fn of_state(state: &State) -> Self {
        let [now, soon] = [state.theta, state.omega].map(Self::of_rotations);
        let later = |now: Pivot, soon: Pivot| if now.is_closed() { soon } else { now };
        Contact { ground: later(now.ground, soon.ground), crack: later(now.crack, soon.crack) }
    }
}

/// The joints that touch at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Touching {
    /// The joint at the ground: θ_1 = 0.
    pub ground: bool,
    /// The joint at the crack: θ_2 = θ_1.
    pub crack: bool,
}

impl Touching {
    /// The joints that are closed in a contact state.
    pub fn closed_in(contact: Contact) -> Self {
        Self { ground: contact.ground.is_closed(), crack: contact.crack.is_closed() }
    }

    pub(super) fn word(self, touches: bool) -> &'static str {
        if touches { "touching" } else { "open" }
    }

    /// Whether this joint touches.
    pub fn at(self, joint: Joint) -> bool {
        match joint {
            Joint::Ground => self.ground,
            Joint::Crack => self.crack,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_index_inverts_all() {
        for (i, contact) in Contact::ALL.into_iter().enumerate() {
            assert_eq!(contact.index(), i, "{contact:?}");
        }
    }

    #[test]
    fn published_patterns_make_the_transitions_of_table_2_possible() {
        let named = |name: &str| {
            let index = PATTERN_NAMES.iter().position(|n| *n == name).expect("a pattern's name");
            Contact::ALL[index]
        };
        // 1a→2a and 2a→1a change the crack only, 1a→2b and 2a→1b the ground only, 3a→3b the ground with the crack closed.
        assert_eq!(named("1a").ground, named("2a").ground);
        assert_eq!(named("1a").crack, named("2b").crack);
        assert_eq!(named("2a").crack, named("1b").crack);
        assert_eq!(named("3a").mirrored(), named("3b"));
        for contact in Contact::ALL {
            assert_eq!(contact.mirrored().pattern_number(), contact.pattern_number());
        }
    }
}
