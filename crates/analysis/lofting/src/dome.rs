//! How a piece of bone ends between two slices.
//!
//! Over the last slice's region `q` solves Poisson's equation, `-laplace q = const`, with `q = 0` along its contour and 1 at its
//! highest. For an ellipse that is `1 - x^2/a^2 - y^2/b^2`, so the dome `q(x, y) = a s + (1 - a H) s^2 / H^2`, `s` mm beyond the slice, is
//! the cap of an ellipsoid there, of a paraboloid or of a cone, as `a` and its height `H` say; for other regions it is a smooth dome with
//! the region's lobes. `a` and `H` come from the parabola through the areas of the last three slices: it gives the area's slope and where
//! it vanishes, exactly for ellipsoids, paraboloids and cones. The dome leans the way that the centroids moved.
//!
//! The next slice does not have the piece, so `H` is below the distance to it; where the areas let expect more, the bone ended more
//! bluntly than they show, at a place that nobody saw, and a height of 3/4 of the distance halves it by volume.

use crate::layer::{Grid, Layer, Run};
use crate::plane::Plane;

/// Share of the distance to the next slice for an end that the slices give no sign of.
const UNSEEN: f64 = 0.75;

/// How far from a lid's rim a vertex on it is taken to be, cells.
const RIM: f64 = 0.75;

/// What the slices before its end say of a piece: area and distance from the last one, last one first; mm.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Trend {
    pub area: f64,
    /// Distance and area of one slice back, and of two.
    pub before: Vec<(f64, f64)>,
    /// How far the centroid moves for each mm towards the end.
    pub drift: [f64; 2],
}

/// How a piece closes: slope `a` of the area, relative, per mm, and height of the dome, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Profile {
    pub slope: f64,
    pub height: f64,
}

impl Profile {
    /// As far as the slices let expect, the next slice aside.
    pub fn expected(trend: &Trend) -> Self {
        let (slope, bend) = match trend.before[..] {
            [] => (0.0, 0.0),
            [(h1, a1)] => ((trend.area - a1) / h1, 0.0),
            [(h1, a1), (h2, a2), ..] => {
                let (near, far) = ((trend.area - a1) / h1, (a1 - a2) / (h2 - h1));
                let bend = (near - far) / h2;
                (near + bend * h1, bend)
            }
        };
        // Where area + slope s + bend s^2 vanishes, or is least.
        let inner = slope * slope - 4.0 * bend * trend.area;
        let height = if bend.abs() * trend.area < 1e-9 * slope * slope {
            if slope < 0.0 { -trend.area / slope } else { f64::INFINITY }
        } else if inner > 0.0 {
            let root = 2.0 * trend.area / (inner.sqrt() - slope);
            if root > 0.0 { root } else { f64::INFINITY }
        } else if slope < 0.0 {
            -slope / (2.0 * bend)
        } else {
            f64::INFINITY
        };
        Self { slope: (-slope / trend.area).max(0.0), height }
    }

    /// With a slice at `limit` mm in which the piece is not.
    pub fn within(self, limit: f64) -> Self {
        let height = match self.height {
            h if h.is_finite() && h <= limit => h.max(0.1 * limit),
            h => limit * (UNSEEN + (1.0 - UNSEEN) * limit / h),
        };
        // Not to the next slice itself; and the dome rises everywhere.
        let height = height.min(0.97 * limit);
        Self { slope: self.slope.min(2.0 / height), height }
    }

    fn q(&self, s: f64) -> f64 {
        let t = s / self.height;
        self.slope * s + (1.0 - self.slope * self.height) * t * t
    }
}

/// How an end closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Close {
    /// Flat, so many mm beyond the slice.
    Flat(f64),
    Round(Profile),
}

/// The end of a piece, or of a hole.
#[derive(Debug, Clone)]
pub(crate) struct Dome {
    /// First node of the box that `q` is known in, and its size.
    low: [usize; 2],
    size: [usize; 2],
    /// `q` of its nodes.
    q: Vec<f32>,
    /// Radius by which it counts in cells.
    radius: f64,
    close: Close,
    /// Height of the slice, mm, and whether the dome lies above it.
    base: f64,
    up: bool,
    /// Cells for each mm.
    drift: [f64; 2],
    cell: f64,
}

impl Dome {
    /// The dome over the nodes of some runs, from their signed distances.
    pub fn over(
        (plane, runs): (&Plane, &[Run]),
        (grid, layer, up): (&Grid, &Layer, bool),
        (trend, perimeter): (&Trend, f64),
        close: Close,
    ) -> Option<Self> {
        let first = runs.first()?;
        let (mut low, mut high) = ([first.from, first.row], [first.to, first.row]);
        for run in runs {
            low = [low[0].min(run.from), low[1].min(run.row)];
            high = [high[0].max(run.to), high[1].max(run.row)];
        }
        const MARGIN: usize = 3;
        let low = low.map(|v| (v as usize).saturating_sub(MARGIN));
        let size = [0, 1].map(|a| (high[a] as usize + MARGIN + 1).min(grid.size[a]) - low[a]);
        let area = trend.area / (grid.cell * grid.cell);
        let radius = if perimeter > 0.0 { 2.0 * area * grid.cell / perimeter } else { (area / 3.2).sqrt() };
        let radius = radius.clamp(0.3, 1e6);
        let mut drift = trend.drift.map(|d| d / grid.cell);
        if let Close::Round(profile) = close {
            let lean = drift[0].hypot(drift[1]) * profile.height;
            let scale = (0.7 * radius / lean.max(f64::MIN_POSITIVE)).min(1.0);
            drift = drift.map(|d| d * scale);
        }
        let mut dome =
            Self { low, size, q: Vec::new(), radius, close, base: layer.height, up, drift, cell: grid.cell };
        dome.q = poisson(plane, grid, low, size, radius as f32);
        Some(dome)
    }

    /// Below 0 within the dome, about in cells; its slice's side too.
    pub fn value(&self, x: f64, y: f64, height: f64) -> f64 {
        let s = (height - self.base) * if self.up { 1.0 } else { -1.0 };
        let s = if s.abs() < 1e-9 { 0.0 } else { s };
        let (q, beyond) = self.q_at(x - self.drift[0] * s, y - self.drift[1] * s);
        let from_axis = self.radius * (1.0 - q).max(0.0).sqrt() + beyond;
        match self.close {
            _ if s <= 0.0 => from_axis - self.radius,
            Close::Flat(height) => (from_axis - self.radius).max((s - height) / self.cell),
            Close::Round(p) if s < p.height => from_axis - self.radius * (1.0 - p.q(s)).max(0.0).sqrt(),
            Close::Round(p) => from_axis + (s - p.height) / self.cell + 1e-4,
        }
    }

    /// Whether a place of its slice lies on the rim of a lid in that slice.
    pub fn has_rim_at(&self, [x, y]: [f64; 2], height: f64) -> bool {
        let (q, beyond) = self.q_at(x, y);
        let off = self.radius * ((1.0 - q).max(0.0).sqrt() - 1.0) + beyond;
        self.close == Close::Flat(0.0) && height == self.base && off.abs() < RIM
    }

    /// The box of nodes in which it is not far outside at a height.
    pub fn bounds(&self, grid: &Grid, height: f64) -> [[usize; 2]; 2] {
        let s = (height - self.base).abs();
        let place = |a: usize, at: usize| {
            let moved = at as f64 + self.drift[a] * s;
            (moved.max(0.0) as usize).min(grid.size[a] - 1)
        };
        [[0, 1].map(|a| place(a, self.low[a])), [0, 1].map(|a| place(a, self.low[a] + self.size[a] - 1))]
    }

    /// `q`, bilinear, and how far the place is from where it is known, cells.
    fn q_at(&self, x: f64, y: f64) -> (f64, f64) {
        let at = [x - self.low[0] as f64, y - self.low[1] as f64];
        let inside = [0, 1].map(|a| at[a].clamp(0.0, (self.size[a] - 1) as f64));
        let beyond = (at[0] - inside[0]).hypot(at[1] - inside[1]);
        let [i, j] = [0, 1].map(|a| (inside[a] as usize).min(self.size[a] - 2));
        let (s, t) = (inside[0] - i as f64, inside[1] - j as f64);
        let node = j * self.size[0] + i;
        let q = |n: usize| f64::from(self.q[n]);
        let low = q(node) * (1.0 - s) + q(node + 1) * s;
        let high = q(node + self.size[0]) * (1.0 - s) + q(node + self.size[0] + 1) * s;
        (low * (1.0 - t) + high * t, beyond)
    }
}

/// Solves for `q` in the nodes of a box that lie inside; outside it falls on as that of a disc does. The contour is met where the signed
/// distances put it between nodes (Shortley and Weller 1938), by successive over-relaxation.
fn poisson(plane: &Plane, grid: &Grid, low: [usize; 2], size: [usize; 2], radius: f32) -> Vec<f32> {
    let [columns, rows] = size;
    let d = |n: usize| plane.values[(low[1] + n / columns) * grid.size[0] + low[0] + n % columns];
    let mut q: Vec<f32> = (0..columns * rows)
        .map(|n| {
            let r = 1.0 + d(n).max(0.0) / radius;
            1.0 - r * r
        })
        .collect();
    // Node, weights of its neighbours left, right, below, above, and one over their sum with the contour's.
    let mut inside: Vec<(usize, [f32; 4], f32)> = Vec::new();
    for j in 1..rows - 1 {
        for i in 1..columns - 1 {
            let n = j * columns + i;
            if d(n) >= 0.0 {
                continue;
            }
            let next = [n - 1, n + 1, n - columns, n + columns];
            let arm = next.map(|m| if d(m) < 0.0 { 1.0 } else { (d(n) / (d(n) - d(m))).max(0.05) });
            let weight: [f32; 4] = std::array::from_fn(|k| 2.0 / (arm[k] * (arm[k] + arm[k ^ 1])));
            let sum: f32 = weight.iter().sum();
            let open = std::array::from_fn(|k| if d(next[k]) < 0.0 { weight[k] } else { 0.0 });
            q[n] = radius * radius / 8.0;
            inside.push((n, open, 1.0 / sum));
        }
    }
    let across = columns.max(rows) as f32;
    let relaxation = 2.0 / (1.0 + (std::f32::consts::PI / across).sin());
    for _ in 0..2 * columns.max(rows) + 10 {
        for (n, w, inverse) in &inside {
            let n = *n;
            let around = w[0] * q[n - 1] + w[1] * q[n + 1] + w[2] * q[n - columns] + w[3] * q[n + columns];
            q[n] += relaxation * ((around + 1.0) * inverse - q[n]);
        }
    }
    let most = inside.iter().map(|(n, ..)| q[*n]).fold(f32::MIN_POSITIVE, f32::max);
    for (n, ..) in &inside {
        q[*n] = (q[*n] / most).clamp(1e-4, 1.0);
    }
    q
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ellipsoids_paraboloids_and_cones_end_where_they_do() {
        // Area at a height; slices at 0, -1.5, -2.5; the tip at 0.8.
        let of = |area: &dyn Fn(f64) -> f64| {
            let before = vec![(1.5, area(-1.5)), (2.5, area(-2.5))];
            Profile::expected(&Trend { area: area(0.0), before, drift: [0.0; 2] })
        };
        let sphere = of(&|z| (z + 9.2) * (0.8 - z));
        assert!((sphere.height - 0.8).abs() < 1e-9, "{sphere:?}");
        assert!((sphere.slope - (9.2 - 0.8) / (9.2 * 0.8)).abs() < 1e-9);
        let paraboloid = of(&|z| 3.0 * (0.8 - z));
        assert!((paraboloid.height - 0.8).abs() < 1e-9 && (paraboloid.slope - 1.25).abs() < 1e-9);
        let cone = of(&|z| 3.0 * (0.8 - z).powi(2));
        assert!((cone.height - 0.8).abs() < 1e-6 && (cone.slope - 2.5).abs() < 1e-6, "{cone:?}");
        let cylinder = of(&|_| 3.0).within(4.0);
        assert_eq!((cylinder.slope, cylinder.height), (0.0, 3.0));
        for profile in [sphere, paraboloid, cone, cylinder] {
            let p = profile.within(0.5);
            assert!(p.height < 0.5 && p.q(0.0) == 0.0 && (p.q(p.height) - 1.0).abs() < 1e-9, "{p:?}");
            assert!(
                (0..10)
                    .all(|k| p.q(f64::from(k + 1) * p.height / 10.0) > p.q(f64::from(k) * p.height / 10.0))
            );
        }
    }
}
