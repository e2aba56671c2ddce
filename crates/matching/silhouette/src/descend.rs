//! From candidates to one pose: a descent from each, and the best of them.

use biplane_geometry::Pose;

use crate::Candidate;

/// Candidates that fit nearly as well as the best are all tried: this many times its misfit, and this many mm more.
const ALIKE: (f64, f64) = (2.0, 0.1);

/// Descends from the candidates in turn; `of` gives where a descent came to and how well that fits, larger being better.
///
/// All candidates that fit nearly as well as the first are tried, mirror basins among them, and the others until one is at least
/// `enough`. All results come back, the best first; `None` from `of` ends the search.
pub fn descend<T>(
    candidates: &[Candidate],
    enough: f64,
    mut of: impl FnMut(&Pose) -> Option<(T, f64)>,
) -> Vec<(T, f64)> {
    let alike = candidates.first().map_or(0.0, |c| ALIKE.0 * c.misfit_mm + ALIKE.1);
    let mut found: Vec<(T, f64)> = Vec::new();
    for candidate in candidates {
        let done = candidate.misfit_mm > alike && found.iter().any(|f| f.1 >= enough);
        let Some(one) = (if done { None } else { of(&candidate.pose) }) else { break };
        found.push(one);
    }
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found
}

#[cfg(test)]
mod tests {
    use biplane_geometry::Vector3;

    use super::*;

    #[test]
    fn all_that_are_alike_are_tried_and_no_more_once_one_is_enough() {
        let candidate = |(k, misfit_mm): (usize, f64)| Candidate {
            pose: Pose::new(Default::default(), Vector3::new(k as f64, 0.0, 0.0)),
            misfit_mm,
        };
        let all: Vec<Candidate> =
            [0.05, 0.1, 0.15, 0.9, 1.0].into_iter().enumerate().map(candidate).collect();
        let number = |p: &Pose| p.translation().x as usize;
        let tried = |scores: [f64; 5]| {
            let found = descend(&all, 0.9, |p| Some((number(p), scores[number(p)])));
            (found.len(), found.first().map(|f| f.0))
        };
        assert_eq!(tried([0.95, 0.99, 0.1, 0.99, 0.99]), (3, Some(1)));
        assert_eq!(tried([0.5, 0.4, 0.3, 0.92, 0.99]), (4, Some(3)));
        assert_eq!(tried([0.5, 0.4, 0.3, 0.2, 0.1]), (5, Some(0)));
        assert_eq!(descend(&all, 0.9, |p| (number(p) < 1).then_some(((), 0.0))).len(), 1);
        assert!(descend(&[], 0.9, |_| Some(((), 1.0))).is_empty());
    }
}
