//! The plane about which a body is most nearly its own mirror image.
//!
//! Evenly spread places are mirrored, and each is held against the tangent plane of the nearest place of the body that faces alike; the
//! plane follows by Gauss-Newton with Tukey's weights, so that a part without counterpart does not pull it (compare: Combès et al.,
//! CVPR 2008, iterative closest points for symmetry planes).

use biplane_geometry::Vector3;
use nalgebra::{Matrix3, Vector3 as Unknowns};

use crate::frame::square_to;
use crate::shape::Shape;

/// Above this a body is hardly its own mirror image: misfit over size.
pub(crate) const ASYMMETRIC: f64 = 0.018;
/// Places that are mirrored.
const MIRRORED: usize = 1_500;
/// Places that they are held against.
const HELD: usize = 8_000;

/// A mirror plane: `normal . p = height`.
#[derive(Debug, Clone)]
pub(crate) struct Mirror {
    pub normal: Vector3,
    pub height: f64,
    /// Root of the mean square misfit, each capped at a twentieth of the body's size, over that size.
    pub cost: f64,
}

/// A place with its outward normal.
#[derive(Clone, Copy)]
struct Place {
    at: Vector3,
    normal: Vector3,
}

/// A body's surface as evenly spread places in cubic cells.
pub(crate) struct Places {
    /// Cell by cell, the first coordinate running fastest.
    held: Vec<Place>,
    /// Where each cell begins in `held`, and where the last one ends.
    begins: Vec<u32>,
    mirrored: Vec<Place>,
    low: Vector3,
    side: f64,
    count: [usize; 3],
    size: f64,
}

impl Places {
    pub fn of(shape: &Shape) -> Self {
        let (low, high) = shape.bounds();
        let size = (high - low).norm();
        let side = size / 30.0;
        let low = low - Vector3::repeat(2.0 * side);
        // At most 30 cells and a rim along each axis, whatever the body's size.
        let count = [0, 1, 2].map(|k| ((high[k] - low[k]) / side).ceil() as usize + 3);
        let mirrored = spread(shape, MIRRORED);
        let mut places = Self { held: Vec::new(), begins: Vec::new(), mirrored, low, side, count, size };
        let mut held: Vec<(usize, Place)> = spread(shape, HELD)
            .into_iter()
            .filter_map(|p| Some((places.number(places.cell(&p.at)?), p)))
            .collect();
        held.sort_by_key(|(cell, _)| *cell);
        let cells: usize = count.iter().product();
        places.begins = (0..=cells).map(|c| held.partition_point(|(cell, _)| *cell < c) as u32).collect();
        places.held = held.into_iter().map(|(_, p)| p).collect();
        places
    }

    /// The cell of a place, if it has neighbours on all sides.
    fn cell(&self, at: &Vector3) -> Option<[usize; 3]> {
        let c = (at - self.low) / self.side;
        let inside = (0..3).all(|k| c[k] >= 1.0 && c[k] < self.count[k] as f64 - 1.0);
        inside.then(|| [0, 1, 2].map(|k| c[k] as usize))
    }

    fn number(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.count[1] + j) * self.count[0] + i
    }

    /// The nearest place that faces alike, within a cell's side.
    fn nearest(&self, p: &Place) -> Option<&Place> {
        let [i, j, k] = self.cell(&p.at)?;
        let mut best: Option<(f64, &Place)> = None;
        for z in k - 1..=k + 1 {
            for y in j - 1..=j + 1 {
                let row = self.number([i - 1, y, z]);
                let (first, last) = (self.begins[row] as usize, self.begins[row + 3] as usize);
                for q in &self.held[first..last] {
                    let far = (q.at - p.at).norm_squared();
                    if best.is_none_or(|(b, _)| far < b) && q.normal.dot(&p.normal) > 0.5 {
                        best = Some((far, q));
                    }
                }
            }
        }
        best.map(|(_, q)| q)
    }

    /// Misfit of each mirrored place: none where it has no counterpart.
    fn misfits<'a>(
        &'a self,
        m: &'a Mirror,
        step: usize,
    ) -> impl Iterator<Item = (&'a Place, Option<(f64, Vector3)>)> {
        self.mirrored.iter().step_by(step).map(move |p| {
            let at = p.at - m.normal * (2.0 * (p.at.dot(&m.normal) - m.height));
            let normal = p.normal - m.normal * (2.0 * p.normal.dot(&m.normal));
            let found = self.nearest(&Place { at, normal });
            (p, found.map(|q| ((at - q.at).dot(&q.normal), q.normal)))
        })
    }

    fn cost(&self, m: &Mirror, step: usize) -> f64 {
        let cap = self.size / 20.0;
        let (mut sum, mut count) = (0.0, 0.0);
        for (_, misfit) in self.misfits(m, step) {
            sum += misfit.map_or(cap, |(r, _)| r.abs().min(cap)).powi(2);
            count += 1.0;
        }
        (sum / f64::max(count, 1.0)).sqrt() / self.size
    }

    /// The best plane of those that the starts lead to; where `square` is given, the plane's normal stays square to it.
    pub fn mirror(&self, starts: &[Vector3], square: Option<&Vector3>) -> Option<Mirror> {
        let mut first: Vec<Mirror> = starts
            .iter()
            .map(|normal| {
                let mut m = Mirror { normal: *normal, height: 0.0, cost: 0.0 };
                m.cost = self.cost(&m, 4);
                m
            })
            .collect();
        first.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        first.truncate(8);
        let mut rough: Vec<Mirror> = first.into_iter().map(|m| self.refined(m, square, 5, 20)).collect();
        rough.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        // Most starts lead to one plane: it is made better once.
        let mut apart: Vec<Mirror> = Vec::new();
        for m in rough {
            if apart.len() < 2 && apart.iter().all(|a| a.normal.dot(&m.normal).abs() < 0.995) {
                apart.push(m);
            }
        }
        let fine = apart.into_iter().map(|m| self.refined(m, square, 1, 30));
        fine.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    /// With every `stride`th place, in at most `rounds` steps.
    fn refined(&self, mut m: Mirror, square: Option<&Vector3>, stride: usize, rounds: usize) -> Mirror {
        let mut scale = self.size / 60.0;
        for _ in 0..rounds {
            let (u, v) = match square {
                Some(s) => (s.cross(&m.normal), Vector3::zeros()),
                None => {
                    let u = square_to(&m.normal);
                    (u, m.normal.cross(&u))
                }
            };
            let (mut normal, mut right) = (Matrix3::zeros(), Unknowns::zeros());
            let (mut total, mut squares) = (0.0, 0.0);
            for (p, misfit) in self.misfits(&m, stride) {
                let Some((r, n)) = misfit else { continue };
                let t = r / (4.7 * scale);
                if t.abs() >= 1.0 {
                    continue;
                }
                let w = (1.0 - t * t).powi(2);
                let (across, beyond) = (n.dot(&m.normal), p.at.dot(&m.normal) - m.height);
                let tilt = |d: &Vector3| -2.0 * (d.dot(&p.at) * across + beyond * n.dot(d));
                let j = Unknowns::new(tilt(&u), tilt(&v), 2.0 * across);
                normal += j * j.transpose() * w;
                right -= j * (r * w);
                total += w;
                squares += w * r * r;
            }
            if square.is_some() {
                normal[(1, 1)] = 1.0;
            }
            let Some(step) = normal.lu().solve(&right) else { break };
            m.normal = (m.normal + u * step.x + v * step.y).normalize();
            m.height += step.z;
            scale = (0.8 * scale).max((squares / f64::max(total, 1e-9)).sqrt().max(self.size * 5e-4));
            if step.norm() < 1e-8 {
                break;
            }
        }
        m.cost = self.cost(&m, 1);
        m
    }
}

/// `count` places spread evenly over the area: at equal steps of the area summed up triangle by triangle, within a triangle by a
/// sequence of low discrepancy.
fn spread(shape: &Shape, count: usize) -> Vec<Place> {
    let corners = |t: &[u32; 3]| t.map(|v| shape.vertices[v as usize]);
    let area = |t: &[u32; 3]| {
        let [a, b, c] = corners(t);
        (b - a).cross(&(c - a)).norm() / 2.0
    };
    let step = shape.triangles.iter().map(area).sum::<f64>() / count as f64;
    let mut places = Vec::with_capacity(count);
    let mut owed = 0.5;
    for t in &shape.triangles {
        let [a, b, c] = corners(t);
        let Some(normal) = (b - a).cross(&(c - a)).try_normalize(1e-30) else { continue };
        owed += area(t) / step;
        while owed >= 1.0 {
            owed -= 1.0;
            // Roberts' sequence of the plane, folded into the triangle.
            let k = places.len() as f64;
            let (mut s, mut r) =
                ((0.5 + 0.754_877_666_246_692_7 * k).fract(), (0.5 + 0.569_840_290_998_053_2 * k).fract());
            if s + r > 1.0 {
                (s, r) = (1.0 - s, 1.0 - r);
            }
            places.push(Place { at: a + (b - a) * s + (c - a) * r, normal });
        }
    }
    places
}
