//! Edge points: crests of the gradient's size, to a fraction of a pixel, that pass hysteresis.

use biplane_geometry::{EdgePoint, Point2, Vector2};

use crate::SegmentParams;
use crate::smooth::Grey;

/// No edge point at this pixel.
pub(crate) const NONE: u32 = u32::MAX;

/// Edge points, and which pixel each came from.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeMap {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The points, in the order of their pixels, row by row.
    pub points: Vec<EdgePoint>,
    /// For each pixel the index of its point, or `u32::MAX`.
    pub(crate) at_pixel: Vec<u32>,
}

/// Catmull-Rom interpolation between `p[1]` and `p[2]`.
fn cubic(p: [f32; 4], t: f32) -> f32 {
    p[1] + 0.5
        * t
        * (p[2] - p[0]
            + t * (2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3] + t * (3.0 * (p[1] - p[2]) + p[3] - p[0])))
}

/// Value at a point at least 2 px inside the picture.
fn interpolated(samples: &[f32], width: usize, x: f32, y: f32) -> f32 {
    let (i, j) = (x.floor() as usize, y.floor() as usize);
    let (tx, ty) = (x - i as f32, y - j as f32);
    let row = |r: usize| {
        let k = (j + r - 1) * width + i - 1;
        cubic([samples[k], samples[k + 1], samples[k + 2], samples[k + 3]], tx)
    };
    cubic([row(0), row(1), row(2), row(3)], ty)
}

/// Finds the edge points of a picture whose grey levels are scaled to 0..255.
pub(crate) fn find(grey: &Grey, params: &SegmentParams) -> EdgeMap {
    let (w, h) = (grey.width, grey.height);
    let mut map = EdgeMap { width: w, height: h, points: Vec::new(), at_pixel: vec![NONE; w * h] };
    if w < 8 || h < 8 {
        return map;
    }
    let noise = grey.noise();
    let smooth = grey.smoothed(params.smoothing_px).samples;
    let (mut gx, mut gy, mut size) = (vec![0.0_f32; w * h], vec![0.0_f32; w * h], vec![0.0_f32; w * h]);
    for y in 1..h - 1 {
        for x in 1..w - 1 {
            let k = y * w + x;
            gx[k] = (smooth[k + 1] - smooth[k - 1]) / 2.0;
            gy[k] = (smooth[k + w] - smooth[k - w]) / 2.0;
            size[k] = gx[k].hypot(gy[k]);
        }
    }
    let (low, high) = (params.low_threshold as f32, params.high_threshold as f32);
    let mut strong = Vec::new();
    for y in 3..h - 3 {
        for x in 3..w - 3 {
            let k = y * w + x;
            if size[k] < low {
                continue;
            }
            if let Some(point) = crest(&size, w, x, y, gx[k] / size[k], gy[k] / size[k], noise, params) {
                if size[k] >= high {
                    strong.push(k);
                }
                map.at_pixel[k] = map.points.len() as u32;
                map.points.push(point);
            }
        }
    }
    keep_connected(&mut map, strong);
    map
}

/// The crest of the gradient's size near pixel (x, y), across direction (nx, ny), if it belongs to this pixel.
#[allow(clippy::too_many_arguments)]
fn crest(
    size: &[f32],
    w: usize,
    x: usize,
    y: usize,
    nx: f32,
    ny: f32,
    noise: f64,
    params: &SegmentParams,
) -> Option<EdgePoint> {
    let (px, py) = (x as f32, y as f32);
    let here = size[y * w + x];
    // Cheap test first: one of the neighbours nearest to the gradient's direction is higher by far too often.
    let (dx, dy) = (nx.round() as isize, ny.round() as isize);
    let neighbour = |s: isize| size[((y as isize + s * dy) * w as isize + x as isize + s * dx) as usize];
    if neighbour(1) > here * 1.3 || neighbour(-1) > here * 1.3 {
        return None;
    }
    let ahead = interpolated(size, w, px + nx, py + ny);
    let behind = interpolated(size, w, px - nx, py - ny);
    // A pixel owns the crest if the crest lies within half the spacing of pixels along the axis that the edge crosses more
    // steeply: then neighbours do not both claim it, and none is left out.
    if here < ahead.min(behind) || (ahead > here && behind > here) {
        return None;
    }
    let (la, lh, lb) =
        (f64::from(ahead.max(1e-6)).ln(), f64::from(here).ln(), f64::from(behind.max(1e-6)).ln());
    let curvature = la - 2.0 * lh + lb;
    if curvature >= -1e-6 {
        return None;
    }
    let offset = (lb - la) / (2.0 * curvature);
    let (nx, ny) = (f64::from(nx), f64::from(ny));
    if offset.abs() > 0.5 * nx.abs().max(ny.abs()) {
        return None;
    }
    let strength = (lh - curvature * offset * offset / 2.0).exp();
    // Localisation error of a crest under white noise: deviation of the second derivative over the size of the third
    // derivative (Canny 1986), with the crest's own width from its curvature.
    let width_squared = 1.0 / -curvature;
    let s = params.smoothing_px.max(0.5);
    let sigma = noise * (3.0 / (16.0 * std::f64::consts::PI)).sqrt() / s.powi(3) * width_squared / strength;
    Some(EdgePoint {
        position: Point2::new(x as f64 + offset * nx, y as f64 + offset * ny),
        direction: Vector2::new(nx, ny),
        strength,
        sigma_px: sigma.clamp(0.01, 1.0),
    })
}

/// Hysteresis: keeps the points that are connected to a strong one through the 8 neighbours of each pixel.
fn keep_connected(map: &mut EdgeMap, mut todo: Vec<usize>) {
    let w = map.width as isize;
    let mut kept = vec![false; map.points.len()];
    for &k in &todo {
        kept[map.at_pixel[k] as usize] = true;
    }
    while let Some(k) = todo.pop() {
        for step in [-w - 1, -w, -w + 1, -1, 1, w - 1, w, w + 1] {
            let n = (k as isize + step) as usize;
            let point = map.at_pixel[n];
            if point != NONE && !kept[point as usize] {
                kept[point as usize] = true;
                todo.push(n);
            }
        }
    }
    let mut points = Vec::new();
    for index in &mut map.at_pixel {
        if *index != NONE {
            if kept[*index as usize] {
                points.push(map.points[*index as usize]);
                *index = points.len() as u32 - 1;
            } else {
                *index = NONE;
            }
        }
    }
    map.points = points;
}

/// Finds the edge points of a picture given as grey levels of 0..255, row by row.
///
/// `samples` must have `width * height` elements; otherwise, as for a picture under 8 px a side, there are no edges.
pub fn find_edges(width: usize, height: usize, samples: Vec<f32>, params: &SegmentParams) -> EdgeMap {
    if width.checked_mul(height) != Some(samples.len()) {
        return EdgeMap { width: 0, height: 0, points: Vec::new(), at_pixel: Vec::new() };
    }
    find(&Grey { width, height, samples }, params)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn params() -> SegmentParams {
        SegmentParams::default()
    }

    /// A bright half plane whose edge is at distance `c` from the origin along `angle`, blurred by a Gaussian of 1 px:
    /// the value at a pixel is the normal distribution function of its distance.
    fn half_plane(angle: f64, c: f64) -> EdgeMap {
        let (w, h) = (64, 64);
        let (s, n) = angle.sin_cos();
        let samples = (0..w * h)
            .map(|k| {
                let d = (k % w) as f64 * n + (k / w) as f64 * s - c;
                (40.0 + 100.0 * normal_distribution(d)) as f32
            })
            .collect();
        let mut map = find_edges(w, h, samples, &params());
        // Nearer to the border the mirrored picture bends the edge.
        map.points.retain(|p| p.position.iter().all(|v| (9.0..=54.0).contains(v)));
        map
    }

    /// By Simpson's rule: no error function in the standard library.
    fn normal_distribution(x: f64) -> f64 {
        let x = x.clamp(-8.0, 8.0);
        let n = 400;
        let h = (x + 8.0) / f64::from(n);
        let f = |t: f64| (-t * t / 2.0).exp() / (2.0 * std::f64::consts::PI).sqrt();
        let sum: f64 = (0..=n)
            .map(|i| {
                let weight = if i == 0 || i == n {
                    1.0
                } else if i % 2 == 1 {
                    4.0
                } else {
                    2.0
                };
                weight * f(-8.0 + h * f64::from(i))
            })
            .sum();
        sum * h / 3.0
    }

    #[test]
    fn straight_edges_are_placed_to_0_015_px_at_any_angle() {
        let mut worst: f64 = 0.0;
        for k in 0..36 {
            let angle = f64::from(k) * 10.0_f64.to_radians();
            let (s, n) = angle.sin_cos();
            let c = 32.0 * (n + s) + 0.13 * f64::from(k % 8);
            let map = half_plane(angle, c);
            assert!(map.points.len() > 40, "angle {k}0: {} points", map.points.len());
            for p in &map.points {
                let off = p.position.x * n + p.position.y * s - c;
                worst = worst.max(off.abs());
                assert!(p.direction.dot(&Vector2::new(n, s)) > 0.999, "dark to bright");
            }
        }
        assert!(worst < 0.015, "worst {worst} px");
    }

    #[test]
    fn an_edge_is_one_pixel_wide_and_without_gaps() {
        for k in 0..18 {
            let angle = f64::from(k) * 10.0_f64.to_radians();
            let (s, n) = angle.sin_cos();
            let map = half_plane(angle, 32.0 * (n + s));
            // Along the axis that the edge crosses more steeply there is one point a line.
            let along = |p: &EdgePoint| if n.abs() > s.abs() { p.position.y } else { p.position.x };
            let mut lines: Vec<i64> = map.points.iter().map(|p| along(p).round() as i64).collect();
            lines.sort_unstable();
            assert!(lines.windows(2).all(|p| p[1] - p[0] <= 1), "angle {k}0 has a gap");
            assert!(lines.len() <= 50, "angle {k}0: {} points over 46 lines", lines.len());
        }
    }

    #[test]
    fn no_edges_where_there_are_none() {
        assert!(find_edges(64, 64, vec![7.0; 64 * 64], &params()).points.is_empty());
        assert!(find_edges(3, 3, vec![7.0; 9], &params()).points.is_empty());
        assert!(find_edges(30, 3, vec![7.0; 9], &params()).points.is_empty());
    }
}
