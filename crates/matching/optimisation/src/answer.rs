//! From where a search ended to its answer: intervals, what the starts led to, a rival pose, and what the calibration's uncertainty adds.
//!
//! **Covariance.** The noise of the outlines (`C`, of [`Refined`]) and the calibration's part (`K`, of
//! [`pose_covariance_of_calibration`]) are of different origin, so they add: `C + K`. To first order, for a calibration whose
//! uncertainty is small beside its distances.
//!
//! **Intervals** are `1.96` standard deviations to either side: the poses' errors are sums over many edge points, hence close to normal.
//!
//! **Ambiguous** is a pose beside which another one, farther off than any uncertainty that is called good, passes every limit of a good
//! pose by itself, and fits less of the outline by no more than a twentieth. Not guaranteed: that such another one is found; only what a start led to is compared.

use biplane_artifact::{Alternative, CalibrationUncertainty, Match, StartsTried, Verdict, ViewFit};
use biplane_geometry::{Point3, Pose};
use biplane_outline::RimMesh;
use nalgebra::{Matrix6, Vector6};

use crate::{Limits, RefineParams, Refined, View, judge, pose_covariance_of_calibration};

/// Standard deviations to either side that hold 95 % of a normal number.
const NINETY_FIVE: f64 = 1.959_964;
/// Poses nearer than this are one: the centroid's displacement, mm, and the rotation, rad. Starts that end at one pose end within a
/// hundredth of it; the next pose that fits a body of little relief lies several degrees off.
const APART: (f64, f64) = (1.0, 0.035);

/// A pose fits clearly better than another one where this much more of the outline fits well (the share of a score).
pub(crate) const CLEARLY: f64 = 0.05;

/// What a search knows beside the pose it ended at.
pub(crate) struct Searched {
    /// As [`Match::objective`].
    pub objective: f64,
    /// Steps or calls, all starts together.
    pub iterations: u32,
    /// What the starts led to.
    pub starts: StartsTried,
    /// A pose that fits as well.
    pub alternative: Option<Alternative>,
}

/// The answer of a match before the calibration's uncertainty is in it.
pub(crate) fn answer(
    found: &Refined,
    (views, verdict, reason): (Vec<ViewFit>, Verdict, String),
    searched: Searched,
) -> Match {
    let Searched { objective, iterations, starts, alternative } = searched;
    let covariance = found.covariance.unwrap_or_else(|| Matrix6::from_element(f64::MAX));
    Match {
        pose: found.pose.into(),
        verdict,
        reason,
        views,
        objective,
        covariance: rows(&covariance),
        calibration_covariance: None,
        interval_95: interval(&covariance),
        starts,
        alternative,
        iterations,
    }
}

/// A match of these views with what their calibration's uncertainty adds to its covariance and intervals. Where the edges found do not
/// tell how the calibration moves the pose, the match stays as it is.
pub fn with_calibration(
    found: Match,
    mesh: &RimMesh,
    views: &[View],
    uncertainty: &CalibrationUncertainty,
    params: &RefineParams,
) -> Match {
    let pose = Pose::from(found.pose);
    let Some(own) = pose_covariance_of_calibration(mesh, views, &pose, uncertainty, params) else {
        return found;
    };
    let total = Matrix6::from_fn(|i, j| found.covariance[i][j]) + own;
    Match {
        covariance: rows(&total),
        calibration_covariance: Some(rows(&own)),
        interval_95: interval(&total),
        ..found
    }
}

/// The end of the highest score; the first of several.
pub(crate) fn best_end(ends: &[Refined]) -> Option<&Refined> {
    ends.iter().rev().max_by(|a, b| a.score().total_cmp(&b.score()))
}

/// The answer of a search by [`refine`](crate::refine) that came to rest at all of `ends`: the best by score; none if there are none.
/// Another end that would be called good by itself makes it ambiguous.
pub(crate) fn answer_of(
    ends: &[Refined],
    mesh: &RimMesh,
    names: &[String],
    limits: &Limits,
    iterations: u32,
) -> Option<Match> {
    let best = best_end(ends)?;
    let (fits, mut verdict, mut reason) = judge(best, names, limits);
    let objective = |end: &Refined| 1.0 - end.score();
    let away = |end: &Refined| end.pose.error_against(&best.pose, mesh.centroid());
    let apart = |end: &&Refined| {
        let away = away(end);
        away.translation_mm > APART.0 || away.rotation_rad > APART.1
    };
    let good = |end: &&Refined| judge(end, names, limits).1 == Verdict::Good;
    let near = |end: &&Refined| best.score() - end.score() <= CLEARLY;
    let rivals = ends.iter().filter(|_| verdict == Verdict::Good).filter(apart).filter(near).filter(good);
    let rival = rivals.max_by(|a, b| a.score().total_cmp(&b.score()));
    if let Some(rival) = rival {
        let away = away(rival);
        verdict = Verdict::Ambiguous;
        reason = format!(
            "another pose fits as well, {:.1} mm and {:.1} deg away ({:.1} and {:.1} % of the outline fit): start near the right one",
            away.translation_mm,
            away.rotation_rad.to_degrees(),
            100.0 * best.score(),
            100.0 * rival.score()
        );
    }
    let rested: Vec<Pose> = ends.iter().filter(|end| end.still).map(|end| end.pose).collect();
    let searched = Searched {
        objective: objective(best),
        iterations,
        starts: starts_tried(ends.len(), &rested, mesh.centroid()),
        alternative: rival.map(|rival| Alternative { pose: rival.pose.into(), objective: objective(rival) }),
    };
    Some(answer(best, (fits, verdict, reason), searched))
}

/// What `tried` starts led to, of which those that came to rest did so at `rested`; `centroid` is the mesh's (model, mm).
pub(crate) fn starts_tried(tried: usize, rested: &[Pose], centroid: &Point3) -> StartsTried {
    let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let spread = rested.split_first().filter(|(_, others)| !others.is_empty()).map(|(first, _)| {
        let off = |pose: &Pose| {
            let moved = pose.transform(centroid) - first.transform(centroid);
            let turned = (pose.rotation() * first.rotation().inverse()).scaled_axis();
            Vector6::new(moved.x, moved.y, moved.z, turned.x, turned.y, turned.z)
        };
        let number = rested.len() as f64;
        let mean = rested.iter().map(off).sum::<Vector6<f64>>() / number;
        let squares: Vector6<f64> = rested.iter().map(|p| (off(p) - mean).map(|v| v * v)).sum();
        squares.map(|s| (s / (number - 1.0)).sqrt()).into()
    });
    StartsTried { tried: count(tried), converged: count(rested.len()), spread }
}

fn rows(matrix: &Matrix6<f64>) -> [[f64; 6]; 6] {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]))
}

fn interval(covariance: &Matrix6<f64>) -> [f64; 6] {
    std::array::from_fn(|i| NINETY_FIVE * covariance[(i, i)].max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::{Mesh, Twist, Vector3};

    use crate::Evidence;

    fn limits() -> Limits {
        Limits { matched_share: (0.75, 0.5), rms_px: (0.75, 2.0), sigma: (0.5, 0.01) }
    }

    fn tetrahedron() -> RimMesh {
        let at = [[0.0, 0.0, 0.0], [30.0, 0.0, 0.0], [0.0, 30.0, 0.0], [0.0, 0.0, 30.0]];
        let vertices = at.map(|[x, y, z]| Point3::new(x, y, z)).to_vec();
        RimMesh::new(&Mesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap())
    }

    /// An end off `pose` by a shift along x, of which `close` of the outline fits well and `matched` found an edge.
    fn end(mesh: &RimMesh, shift_mm: f64, close: f64, matched: f64) -> Refined {
        let twist = Twist { translation: Vector3::new(shift_mm, 0.0, 0.0), rotation: Vector3::zeros() };
        let pose = Pose::identity();
        let evidence = Evidence {
            outline_px: 100.0,
            in_image_px: 100.0,
            matched_px: 100.0 * matched,
            close_px: 100.0 * close,
            ..Evidence::default()
        };
        Refined {
            pose: pose.moved(&twist, mesh.centroid()),
            evidence: vec![evidence; 2],
            steps: 5,
            still: true,
            covariance: Some(Matrix6::identity() * 1e-6),
        }
    }

    fn answered(ends: &[Refined], mesh: &RimMesh) -> Match {
        answer_of(ends, mesh, &["A".to_owned(), "B".to_owned()], &limits(), 10).unwrap()
    }

    #[test]
    fn another_good_pose_makes_the_best_one_ambiguous_and_is_kept() {
        let mesh = tetrahedron();
        let found = answered(&[end(&mesh, 9.0, 0.90, 0.92), end(&mesh, 0.0, 0.93, 0.95)], &mesh);
        assert_eq!(found.verdict, Verdict::Ambiguous);
        assert!(
            found.reason.starts_with("another pose fits as well, 9.0 mm and 0.0 deg away"),
            "{}",
            found.reason
        );
        assert!((found.objective - 0.07).abs() < 1e-12 && found.pose.translation_mm[0].abs() < 1e-12);
        let other = found.alternative.unwrap();
        assert!((other.objective - 0.10).abs() < 1e-12 && (other.pose.translation_mm[0] - 9.0).abs() < 1e-12);
    }

    #[test]
    fn neither_a_worse_pose_nor_the_same_one_is_a_rival() {
        let mesh = tetrahedron();
        for (shift, matched) in [(9.0, 0.6), (0.01, 0.95)] {
            let found = answered(&[end(&mesh, 0.0, 0.93, 0.95), end(&mesh, shift, 0.6, matched)], &mesh);
            assert_eq!((found.verdict, found.alternative), (Verdict::Good, None), "{shift} {matched}");
        }
        // A good one that fits clearly less is none.
        let found = answered(&[end(&mesh, 0.0, 0.93, 0.95), end(&mesh, 9.0, 0.80, 0.9)], &mesh);
        assert_eq!((found.verdict, found.alternative), (Verdict::Good, None));
        // One that is not good itself is called what it is.
        let found = answered(&[end(&mesh, 0.0, 0.6, 0.7), end(&mesh, 9.0, 0.55, 0.7)], &mesh);
        assert_eq!((found.verdict, found.alternative), (Verdict::Doubtful, None));
    }

    #[test]
    fn intervals_are_those_of_a_normal_number_and_starts_are_counted() {
        let mesh = tetrahedron();
        let mut unrest = end(&mesh, 50.0, 0.1, 0.3);
        unrest.still = false;
        let ends = [end(&mesh, 0.0, 0.93, 0.95), end(&mesh, 0.02, 0.92, 0.95), unrest];
        let found = answered(&ends, &mesh);
        assert!(
            found.interval_95.iter().all(|w| (w - 1.959_964e-3).abs() < 1e-12),
            "{:?}",
            found.interval_95
        );
        assert_eq!((found.starts.tried, found.starts.converged, found.iterations), (3, 2, 10));
        let spread = found.starts.spread.unwrap();
        assert!(
            (spread[0] - 0.02 / 2.0f64.sqrt()).abs() < 1e-12 && spread[1..].iter().all(|s| s.abs() < 1e-12)
        );
        assert_eq!(answered(&ends[..1], &mesh).starts.spread, None);
        assert!(answer_of(&[], &mesh, &[], &limits(), 0).is_none());
    }

    #[test]
    fn a_pose_that_edges_do_not_hold_has_no_narrow_interval() {
        let mesh = tetrahedron();
        let mut loose = end(&mesh, 0.0, 0.9, 0.9);
        loose.covariance = None;
        let found = answered(&[loose], &mesh);
        assert!(found.interval_95.iter().all(|w| *w > 1e100) && found.verdict == Verdict::Failed);
    }
}
