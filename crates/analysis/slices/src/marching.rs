//! Marching squares: where a field of pixels passes a level, as closed curves in order.
//!
//! Between pixels the field is linear along the lattice's lines. Where the four corners of a cell do not say which of them
//! hang together, the bilinear interpolant's saddle decides (Nielson and Hamann 1991). Beyond the border the field counts
//! as `beyond`, so every curve is closed. What is above the level lies to the left of a curve in (i, j), so that outer curves
//! have positive area and holes a negative one.

/// What hangs together where two opposite corners of a cell are above the level and two below.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Saddles {
    /// What the bilinear interpolant says.
    Bilinear,
    /// What is above the level: a part one pixel wide that runs askew stays one.
    Joined,
}

/// The curves of one slice, in pixels; those of fewer than three different points are left out. `field` holds `columns` x
/// rows values, row by row.
pub(crate) fn contours(
    field: &[f32],
    columns: usize,
    level: f32,
    beyond: f32,
    saddles: Saddles,
) -> Vec<Vec<[f64; 2]>> {
    let rows = field.len().checked_div(columns).unwrap_or(0);
    if rows == 0 {
        return Vec::new();
    }
    // The lattice with a border of one pixel around it.
    let (width, height) = (columns + 2, rows + 2);
    let at = |x: usize, y: usize| {
        if (1..=columns).contains(&x) && (1..=rows).contains(&y) {
            field[(y - 1) * columns + x - 1]
        } else {
            beyond
        }
    };
    // An edge is that from a pixel to the right (even) or downward (odd).
    let edge = |x: usize, y: usize, down: usize| 2 * (y * width + x) + down;
    const NONE: u32 = u32::MAX;
    let mut next = vec![NONE; 2 * width * height];
    for y in 0..height - 1 {
        for x in 0..width - 1 {
            let f = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            let inside = f.map(|v| v > level);
            if inside == [inside[0]; 4] {
                continue;
            }
            let edges = [edge(x, y, 0), edge(x + 1, y, 1), edge(x, y + 1, 0), edge(x, y, 1)];
            let leaves = |e: usize| inside[e] && !inside[(e + 1) % 4];
            let enters = |e: usize| !inside[e] && inside[(e + 1) % 4];
            // On a saddle: whether the two corners inside hang together.
            let [a, b, c, d] = f.map(f64::from);
            let joined = saddles == Saddles::Joined || (a * c - b * d) / (a + c - b - d) > f64::from(level);
            for from in (0..4).filter(|&e| leaves(e)) {
                let forward = [1, 2, 3].map(|s| (from + s) % 4);
                let backward = [3, 2, 1].map(|s| (from + s) % 4);
                let order = if joined { forward } else { backward };
                if let Some(to) = order.into_iter().find(|&e| enters(e)) {
                    next[edges[from]] = edges[to] as u32;
                }
            }
        }
    }
    let point = |e: usize| {
        let (x, y, right) = (e / 2 % width, e / 2 / width, e.is_multiple_of(2));
        let (p, q) = (at(x, y), if right { at(x + 1, y) } else { at(x, y + 1) });
        let t = f64::from((level - p) / (q - p)).clamp(0.0, 1.0);
        let (i, j) = (x as f64 - 1.0, y as f64 - 1.0);
        if right { [i + t, j] } else { [i, j + t] }
    };
    let mut found = Vec::new();
    for start in 0..next.len() {
        let mut points: Vec<[f64; 2]> = Vec::new();
        let mut at = start;
        while next[at] != NONE {
            let p = point(at);
            if points.last() != Some(&p) {
                points.push(p);
            }
            at = std::mem::replace(&mut next[at], NONE) as usize;
        }
        while points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        if points.len() >= 3 {
            found.push(points);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ring::signed_area;
    use rand::{Rng, SeedableRng};

    #[test]
    fn a_disc_and_its_hole_have_their_areas_and_senses() {
        let (columns, rows) = (60, 50);
        let field: Vec<f32> = (0..columns * rows)
            .map(|v| {
                let r = ((v % columns) as f32 - 28.3).hypot((v / columns) as f32 - 24.8);
                (15.0 - r).min(r - 6.0)
            })
            .collect();
        let found = contours(&field, columns, 0.0, -9.0, Saddles::Bilinear);
        let mut areas: Vec<f64> = found.iter().map(|c| signed_area(c)).collect();
        areas.sort_by(f64::total_cmp);
        assert_eq!(areas.len(), 2);
        let pi = std::f64::consts::PI;
        assert!((areas[0] + 36.0 * pi).abs() < 1.0 && (areas[1] - 225.0 * pi).abs() < 1.0, "{areas:?}");
    }

    #[test]
    fn saddles_are_decided_by_the_bilinear_middle() {
        // Saddle value (0.9 * 0.9 - 0.4 * 0.4) / (2 * 0.9 - 2 * 0.4) = 0.65 is above 0.5: one curve; the other way two.
        assert_eq!(contours(&[0.9, 0.4, 0.4, 0.9], 2, 0.5, 0.0, Saddles::Bilinear).len(), 1);
        assert_eq!(contours(&[0.6, 0.1, 0.1, 0.6], 2, 0.5, 0.0, Saddles::Bilinear).len(), 2);
        assert_eq!(contours(&[0.4, 0.9, 0.9, 0.4], 2, 0.5, 0.0, Saddles::Bilinear).len(), 1);
        assert_eq!(contours(&[0.1, 0.6, 0.6, 0.1], 2, 0.5, 0.0, Saddles::Bilinear).len(), 2);
        assert_eq!(contours(&[0.1, 0.6, 0.6, 0.1], 2, 0.5, 0.0, Saddles::Joined).len(), 1);
    }

    #[test]
    fn noise_gives_closed_curves_that_part_the_pixels_rightly() {
        let mut rng = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(3);
        for _ in 0..20 {
            let (columns, rows) = (17, 13);
            let field: Vec<f32> = (0..columns * rows).map(|_| rng.random::<f32>()).collect();
            let found = contours(&field, columns, 0.5, 0.0, Saddles::Bilinear);
            for (v, f) in field.iter().enumerate() {
                let p = [(v % columns) as f64, (v / columns) as f64];
                let winding: i32 = found.iter().map(|c| crate::ring::winding(c, p)).sum();
                assert_eq!(winding, i32::from(*f > 0.5), "{p:?}");
            }
            for (p, q) in found.iter().flat_map(|c| c.iter().zip(c.iter().cycle().skip(1))) {
                assert!((p[0] - q[0]).abs() <= 1.0 && (p[1] - q[1]).abs() <= 1.0);
            }
        }
    }

    #[test]
    fn what_touches_the_border_is_closed() {
        let found = contours(&[1.0; 6], 3, 0.5, 0.0, Saddles::Bilinear);
        assert_eq!(found.len(), 1);
        // 3 x 2 pixels with their outer halves, less the four corners cut by diagonals of half a pixel.
        assert!((signed_area(&found[0]) - (3.0 * 2.0 - 4.0 * 0.125)).abs() < 1e-9);
        assert!(contours(&[], 0, 0.5, 0.0, Saddles::Bilinear).is_empty());
    }
}
