//! What medians say of a claim.

/// What the medians say of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// They bear it out.
    Holds,
    /// They speak against it.
    DoesNot,
    /// They say too little, or both.
    Undecided,
    /// The study does not vary what the claim is about.
    NotAsked,
}

impl Verdict {
    /// As printed.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Holds => "holds",
            Verdict::DoesNot => "does not",
            Verdict::Undecided => "undecided",
            Verdict::NotAsked => "not in this study",
        }
    }

    /// Of a claim with several parts: it holds if all do, and does not if one does not.
    pub fn of_parts(parts: impl IntoIterator<Item = Verdict>) -> Self {
        let mut whole = None;
        for part in parts {
            whole = match (whole, part) {
                (Some(Verdict::DoesNot), _) | (_, Verdict::DoesNot) => Some(Verdict::DoesNot),
                (None | Some(Verdict::Holds), Verdict::Holds) => Some(Verdict::Holds),
                _ => Some(Verdict::Undecided),
            };
        }
        whole.unwrap_or(Verdict::Undecided)
    }
}

/// An answer and the numbers that decide it.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The answer.
    pub verdict: Verdict,
    /// The numbers in a few words, such as "26 of 33"; empty where the study does not ask.
    pub short: String,
    /// The numbers, as a sentence or two.
    pub numbers: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_parts_add_up() {
        use Verdict::{DoesNot, Holds, Undecided};
        assert_eq!(Verdict::of_parts([Holds, Holds]), Holds);
        assert_eq!(Verdict::of_parts([Holds, Undecided]), Undecided);
        assert_eq!(Verdict::of_parts([Undecided, Holds]), Undecided);
        assert_eq!(Verdict::of_parts([Undecided, DoesNot, Holds]), DoesNot);
        assert_eq!(Verdict::of_parts([]), Undecided);
    }
}
