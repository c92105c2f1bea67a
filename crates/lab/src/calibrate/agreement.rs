//! Whether two searches for the same vector, from two beginnings, came to the same end.

use super::following::GOOD_ENOUGH;
use super::result::MethodResult;

/// Share by which the misfit where one search ended may be above the other's: intervals take vectors up to so far above the
/// lowest as not excluded, so that a search that ended higher ended at a vector that the tests exclude.
const APART: f64 = 0.1;

/// What to say of searches that disagree; none where they agree, or one is not there.
pub fn disagreement(methods: &[MethodResult]) -> Option<String> {
    let ended = |name: &str| methods.iter().find(|m| m.method == name)?.best.mean_wme;
    let [joint, refined] = [ended("joint")?, ended("refined")?];
    told(joint, refined)
}

fn told(joint: f64, refined: f64) -> Option<String> {
    let [low, high] = [joint.min(refined), joint.max(refined)];
    (high > GOOD_ENOUGH && high > (1.0 + APART) * low).then(|| {
        format!(
            "Distrust values and intervals: `joint` ended at a mean WME of {joint:.4} and `refined` at {refined:.4}, so at least \
             one search has not arrived. More vectors (refine_vectors, most_generations) may bring them together."
        )
    })
}

#[cfg(test)]
mod tests {
    use super::told;

    #[test]
    fn analytic_searches_that_ended_apart_are_told_either_way_round() {
        for (one, two) in [(0.2101, 0.1230), (0.1230, 0.2101)] {
            let text = told(one, two).expect("apart");
            assert!(text.contains("0.2101") && text.contains("0.1230"), "{text}");
        }
        assert_eq!(told(0.131, 0.132), None);
        // Without noise both end at roundings.
        assert_eq!(told(3e-9, 2e-7), None);
    }
}
