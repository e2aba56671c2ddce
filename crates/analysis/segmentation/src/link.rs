//! Linking edge points into curves.
//!
//! A curve is followed from pixel to neighbouring pixel as long as the edge goes on in about the same direction. Where
//! several edges meet, the straightest goes on and the others begin anew, so a curve never turns a sharp corner.

use biplane_geometry::{Curve, Vector2};

use crate::edges::{EdgeMap, NONE};

/// Cosine of the sharpest turn a curve takes from one point to the next: 60 degrees between the gradients.
const TURN: f64 = 0.5;

/// Links the points of `map` into curves of at least `min_points` points, in an order that depends on the picture alone.
pub fn link(map: &EdgeMap, min_points: usize) -> Vec<Curve> {
    let mut used = vec![false; map.points.len()];
    let mut curves = Vec::new();
    for pixel in 0..map.at_pixel.len() {
        let seed = map.at_pixel[pixel];
        if seed == NONE || used[seed as usize] {
            continue;
        }
        used[seed as usize] = true;
        let ahead = follow(map, &mut used, pixel, 1.0);
        let behind = follow(map, &mut used, pixel, -1.0);
        let mut pixels: Vec<usize> = behind.into_iter().rev().collect();
        pixels.push(pixel);
        pixels.extend(ahead);
        if pixels.len() < min_points {
            continue;
        }
        let closed = pixels.len() > 8 && are_neighbours(map.width, pixels[0], pixels[pixels.len() - 1]);
        let points = pixels.iter().map(|&k| map.points[map.at_pixel[k] as usize]).collect();
        curves.push(Curve { points, closed });
    }
    curves
}

fn are_neighbours(width: usize, a: usize, b: usize) -> bool {
    let apart = |a: usize, b: usize| a.abs_diff(b) <= 1;
    apart(a % width, b % width) && apart(a / width, b / width)
}

/// Pixels after `pixel`, going with the bright side on one hand (`sense` 1) or the other (-1).
fn follow(map: &EdgeMap, used: &mut [bool], pixel: usize, sense: f64) -> Vec<usize> {
    let w = map.width as isize;
    let mut found = Vec::new();
    let mut at = pixel;
    loop {
        let here = &map.points[map.at_pixel[at] as usize];
        let tangent = Vector2::new(-here.direction.y, here.direction.x) * sense;
        let mut best: Option<(f64, usize)> = None;
        for step in [-w - 1, -w, -w + 1, -1, 1, w - 1, w, w + 1] {
            let n = (at as isize + step) as usize;
            let index = map.at_pixel[n];
            if index == NONE || used[index as usize] {
                continue;
            }
            let there = &map.points[index as usize];
            let agreement = here.direction.dot(&there.direction);
            let step = there.position - here.position;
            let forward = tangent.dot(&step) / step.norm().max(1e-9);
            if agreement < TURN || forward <= 0.2 {
                continue;
            }
            let score = forward + agreement - 0.2 * step.norm();
            if best.is_none_or(|(s, _)| score > s) {
                best = Some((score, n));
            }
        }
        let Some((_, next)) = best else { return found };
        used[map.at_pixel[next] as usize] = true;
        found.push(next);
        at = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SegmentParams, find_edges};

    /// A dark disc with a soft edge on a bright ground.
    fn disc(radius: f64) -> EdgeMap {
        let samples = (0..128 * 128)
            .map(|k| {
                let d = ((k % 128) as f64 - 63.3).hypot((k / 128) as f64 - 64.1) - radius;
                (60.0 + 100.0 / (1.0 + (-1.7 * d).exp())) as f32
            })
            .collect();
        find_edges(128, 128, samples, &SegmentParams::default())
    }

    #[test]
    fn a_disc_is_one_closed_curve_around_it() {
        let map = disc(40.0);
        let curves = link(&map, 5);
        assert_eq!(curves.len(), 1);
        assert!(curves[0].closed);
        assert!(curves[0].points.len() as f64 > 0.95 * map.points.len() as f64);
        for p in &curves[0].points {
            let r = Vector2::new(p.position.x - 63.3, p.position.y - 64.1);
            // Inside by the known bias of a curved edge, about s^2 / 2R with s^2 = 1.5^2 + 1 px^2.
            assert!((r.norm() - 40.0).abs() < 0.08, "{}", r.norm());
        }
    }

    #[test]
    fn short_curves_are_left_out() {
        assert!(link(&disc(40.0), 1000).is_empty());
    }
}
