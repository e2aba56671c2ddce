//! Linking edge points into curves.
//!
//! Every point chooses the best point to go on to, with the bright side on one hand, and the best one to come from; two points
//! are linked where both choose each other. So where three edges meet, the straightest two are one curve and the third
//! ends there; no order of visiting decides. Then ends that face each other across a small gap are joined by the same rule.
//!
//! **Guaranteed:** curves depend on the picture alone; the bright side of every curve lies on the same hand of its course (on the
//! left where y grows downwards); no turn between neighbours is sharper than 60 degrees.

use biplane_geometry::{Curve, EdgePoint, Vector2};

use crate::SegmentParams;
use crate::curved::correct;
use crate::edges::EdgeMap;

/// Cosine of the sharpest turn a curve takes from one point to the next: 60 degrees between the gradients.
const TURN: f64 = 0.5;
/// Farthest step from a point to the next, in columns and in rows. Two, since an edge near 45 degrees changes the axis along
/// which its pixels own it, and may miss one there.
const REACH: usize = 2;
/// Cosine of the sharpest turn across a gap: 30 degrees.
const TURN_OVER_GAP: f64 = 0.866;
/// No point.
const NONE: u32 = u32::MAX;

/// Whether the course goes from `p` to `q` (`true`) or from `q` to `p`, and how well the two go on from each other; larger is
/// better, `None` if they do not. Going forward the bright side is on the left.
fn continues(p: &EdgePoint, q: &EdgePoint, turn: f64) -> Option<(bool, f64)> {
    let agreement = p.direction.dot(&q.direction);
    if agreement < turn {
        return None;
    }
    let step = q.position - p.position;
    let length = step.norm();
    // Both gradients have their say in where the edge runs.
    let along = course(p) + course(q);
    let forward = along.dot(&step) / ((2.0 + 2.0 * agreement).sqrt() * length).max(1e-9);
    (forward.abs() > turn).then(|| (forward > 0.0, forward.abs() + 0.5 * agreement - 0.5 * length))
}

/// The direction of a curve at a point.
fn course(p: &EdgePoint) -> Vector2 {
    Vector2::new(-p.direction.y, p.direction.x)
}

/// Links the points of `map` into curves of at least `min_points` points, over gaps of up to `bridge_px`, and takes the shrinkage
/// of curved ones out if the parameters say so.
pub fn link(map: &EdgeMap, params: &SegmentParams) -> Vec<Curve> {
    let mut next = mutual(map);
    let mut previous = vec![NONE; next.len()];
    for (i, &n) in next.iter().enumerate() {
        if n != NONE {
            previous[n as usize] = i as u32;
        }
    }
    if params.bridge_px > 0.0 {
        bridge(map, params.bridge_px, &mut next, &mut previous);
    }
    let mut curves = Vec::new();
    let mut used = vec![false; next.len()];
    for start in 0..next.len() {
        if used[start] {
            continue;
        }
        // Back to where the curve begins, or once round.
        let mut first = start;
        while previous[first] != NONE && previous[first] as usize != start {
            first = previous[first] as usize;
        }
        let closed = previous[first] != NONE;
        let first = if closed { start } else { first };
        let (mut points, mut blurs) = (Vec::new(), Vec::new());
        let mut at = first;
        loop {
            used[at] = true;
            points.push(map.points[at]);
            blurs.push(map.blurs[at]);
            match next[at] {
                NONE => break,
                n if n as usize == first => break,
                n => at = n as usize,
            }
        }
        if points.len() < params.min_points {
            continue;
        }
        let mut curve = Curve { points, closed };
        if params.correct_curved {
            correct(&mut curve, &blurs, map.fit);
        }
        curves.push(curve);
    }
    curves
}

/// For each point the next one, where both chose each other.
fn mutual(map: &EdgeMap) -> Vec<u32> {
    let (w, n) = (map.width, map.points.len());
    let (mut ahead, mut behind) = (vec![(NONE, f64::MIN); n], vec![(NONE, f64::MIN); n]);
    let mut consider = |a: usize, b: usize| {
        let Some((forward, score)) = continues(&map.points[a], &map.points[b], TURN) else { return };
        let (from, to) = if forward { (a, b) } else { (b, a) };
        if score > ahead[from].1 {
            ahead[from] = (to as u32, score);
        }
        if score > behind[to].1 {
            behind[to] = (from as u32, score);
        }
    };
    // Points are in the order of their pixels: each looks back along its row and at the two rows above.
    let mut first_of_row = [0_usize; REACH + 1];
    for i in 0..n {
        let pixel = map.pixels[i] as usize;
        let x = pixel % w;
        for j in (0..i).rev().take(REACH) {
            if map.pixels[j] as usize / w != pixel / w || x - map.pixels[j] as usize % w > REACH {
                break;
            }
            consider(j, i);
        }
        for (rows, begin) in first_of_row.iter_mut().enumerate().skip(1) {
            let Some(middle) = pixel.checked_sub(rows * w) else { break };
            let from = middle - x.min(REACH);
            while (map.pixels[*begin] as usize) < from {
                *begin += 1;
            }
            let until = middle + REACH.min(w - 1 - x);
            let window = map.pixels[*begin..i].iter().take_while(|p| **p as usize <= until);
            for j in 0..window.count() {
                consider(*begin + j, i);
            }
        }
    }
    (0..n)
        .map(|i| {
            let (to, _) = ahead[i];
            if to != NONE && behind[to as usize].0 as usize == i { to } else { NONE }
        })
        .collect()
}

/// Joins ends to beginnings across gaps of up to `reach` px.
fn bridge(map: &EdgeMap, reach: f64, next: &mut [u32], previous: &mut [u32]) {
    let cell = |v: f64| (v / reach).floor() as i64;
    // Single points have no course that could be trusted over a gap.
    let beginnings = (0..next.len()).filter(|&i| previous[i] == NONE && next[i] != NONE);
    let mut cells: Vec<((i64, i64), usize)> = beginnings
        .map(|i| {
            let p = map.points[i].position;
            ((cell(p.y), cell(p.x)), i)
        })
        .collect();
    cells.sort_unstable();
    let mut best: Vec<(f64, usize)> = vec![(f64::MIN, usize::MAX); cells.len()];
    let ends: Vec<usize> = (0..next.len()).filter(|&i| next[i] == NONE && previous[i] != NONE).collect();
    let mut chosen = vec![None; ends.len()];
    for (e, &end) in ends.iter().enumerate() {
        let p = &map.points[end];
        let (row, column) = (cell(p.position.y), cell(p.position.x));
        let mut most = f64::MIN;
        for j in row - 1..=row + 1 {
            let from = cells.partition_point(|c| c.0 < (j, column - 1));
            for (place, (at, beginning)) in cells.iter().enumerate().skip(from) {
                if *at > (j, column + 1) {
                    break;
                }
                let q = &map.points[*beginning];
                if (q.position - p.position).norm() > reach {
                    continue;
                }
                let Some((true, score)) = continues(p, q, TURN_OVER_GAP) else { continue };
                if score > most {
                    most = score;
                    chosen[e] = Some(place);
                }
                if score > best[place].0 {
                    best[place] = (score, end);
                }
            }
        }
    }
    for (end, place) in ends.iter().zip(chosen) {
        if let Some(place) = place
            && best[place].1 == *end
        {
            let beginning = cells[place].1;
            next[*end] = beginning as u32;
            previous[beginning] = *end as u32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edges::find;
    use crate::find_edges;
    use biplane_grey::Grey;

    fn linked(map: &EdgeMap, min_points: usize, bridge_px: f64) -> Vec<Curve> {
        link(map, &SegmentParams { min_points, bridge_px, ..SegmentParams::default() })
    }

    fn map(size: usize, level: impl Fn(f64, f64) -> f64) -> EdgeMap {
        let samples = (0..size * size).map(|k| level((k % size) as f64, (k / size) as f64) as f32).collect();
        find_edges(size, size, samples, &SegmentParams::default())
    }

    /// Rises from 0 to 1 where `d` grows through 0.
    fn soft(d: f64) -> f64 {
        1.0 / (1.0 + (-1.7 * d).exp())
    }

    /// A dark disc with a soft edge on a bright ground.
    fn disc(radius: f64) -> EdgeMap {
        map(128, |x, y| 60.0 + 100.0 * soft((x - 63.3).hypot(y - 64.1) - radius))
    }

    #[test]
    fn a_disc_is_one_closed_curve_around_it() {
        for radius in [4.0, 13.0, 40.0] {
            let map = disc(radius);
            let curves = linked(&map, 5, 3.0);
            assert_eq!(curves.len(), 1, "radius {radius}");
            assert!(curves[0].closed);
            assert_eq!(curves[0].points.len(), map.points.len());
            for pair in curves[0].points.windows(2) {
                let step = pair[1].position - pair[0].position;
                let bright = pair[0].direction;
                assert!(step.x * bright.y - step.y * bright.x < 0.0, "the bright side changes hands");
            }
        }
    }

    #[test]
    fn short_curves_are_left_out() {
        assert!(linked(&disc(40.0), 1000, 3.0).is_empty());
    }

    #[test]
    fn where_three_edges_meet_the_straight_one_goes_on() {
        // Two greys above a third one: a straight edge, and one that ends on it.
        let map = map(96, |x, y| 40.0 + 80.0 * soft(y - 48.2) + 40.0 * soft(x - 50.4) * soft(48.2 - y));
        let curves = linked(&map, 5, 3.0);
        let long: Vec<_> = curves.iter().filter(|c| c.points.len() > 30).collect();
        assert_eq!(long.len(), 2);
        let through = long.iter().filter(|c| c.points.len() > 85).count();
        assert_eq!(through, 1, "{:?}", curves.iter().map(|c| c.points.len()).collect::<Vec<_>>());
    }

    #[test]
    fn a_small_gap_is_bridged_and_a_large_one_is_not() {
        let samples = (0..96 * 96).map(|k| (40.0 + 100.0 * soft((k / 96) as f64 - 48.2)) as f32).collect();
        let grey = Grey { width: 96, height: 96, samples };
        // A straight edge of which a mask hides some columns.
        let curves = |hidden: std::ops::Range<usize>| {
            let mask: Vec<u16> = (0..96 * 96).map(|k| u16::from(!hidden.contains(&(k % 96)))).collect();
            let found = find(&grey.smoothed(1.0), Some(&mask), &SegmentParams::default());
            linked(&found, 5, 6.0).len()
        };
        assert_eq!(curves(0..0), 1);
        assert_eq!(curves(40..44), 1);
        assert_eq!(curves(40..50), 2);
    }
}
