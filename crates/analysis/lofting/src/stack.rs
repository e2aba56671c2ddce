//! Contours as the methods here see them: a stack of slices in ascending order, their points in one right-handed frame.
//!
//! The frame's first two axes lie in the slices' planes, the third is their normal; its origin is near the bone. Slices may
//! be shifted in their planes against each other and lie at uneven distances.

use biplane_artifact::{ContourSlice, SliceContours, SliceFlag};
use biplane_geometry::{Point3, Vector3};

use crate::LoftError;

/// Largest coordinate, mm.
const MOST_MM: f64 = 1e7;

/// Checked contours.
#[derive(Debug, Clone)]
pub(crate) struct Stack {
    /// Ascending along the normal.
    pub slices: Vec<Slice>,
    /// What a person should know of the contours.
    pub warnings: Vec<String>,
    origin: Point3,
    axes: [Vector3; 3],
}

/// The contours of a slice.
#[derive(Debug, Clone)]
pub(crate) struct Slice {
    /// Its number in the volume.
    pub number: usize,
    /// Along the normal, mm.
    pub height: f64,
    pub contours: Vec<Contour>,
    /// Whether the bone is missing in it, though it goes through.
    pub lost: bool,
    /// Whether the volume ends in it and the bone goes on.
    pub cut_off: bool,
}

/// A closed contour.
#[derive(Debug, Clone)]
pub(crate) struct Contour {
    /// Its number in the slice.
    pub number: usize,
    /// In the plane, mm; neighbours differ.
    pub points: Vec<[f64; 2]>,
    /// Counter-clockwise is positive, mm^2.
    pub area: f64,
    pub perimeter: f64,
    /// Of its area, mm.
    pub centroid: [f64; 2],
    pub low: [f64; 2],
    pub high: [f64; 2],
}

impl Contour {
    /// Of points whose neighbours differ.
    pub fn of(number: usize, points: Vec<[f64; 2]>) -> Self {
        let sides = || points.iter().zip(points.iter().cycle().skip(1));
        let [o, ..] = points[..] else {
            let zero = [0.0; 2];
            return Self { number, points, area: 0.0, perimeter: 0.0, centroid: zero, low: zero, high: zero };
        };
        let (mut area, mut perimeter, mut moment) = (0.0, 0.0, [0.0; 2]);
        let (mut low, mut high) = (o, o);
        for (p, q) in sides() {
            let [px, py, qx, qy] = [p[0] - o[0], p[1] - o[1], q[0] - o[0], q[1] - o[1]];
            let cross = px * qy - qx * py;
            area += cross / 2.0;
            moment = [moment[0] + (px + qx) * cross / 6.0, moment[1] + (py + qy) * cross / 6.0];
            perimeter += (qx - px).hypot(qy - py);
            for a in 0..2 {
                low[a] = low[a].min(p[a]);
                high[a] = high[a].max(p[a]);
            }
        }
        // Of a contour that crosses itself the moments say nothing; the middle of its box does.
        let mut centroid = [o[0] + moment[0] / area, o[1] + moment[1] / area];
        if !(0..2).all(|a| (low[a]..=high[a]).contains(&centroid[a])) {
            centroid = [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0];
        }
        Self { number, points, area, perimeter, centroid, low, high }
    }
}

impl Stack {
    /// # Errors
    /// Contours that are no stack of closed contours.
    pub fn of(contours: &SliceContours) -> Result<Self, LoftError> {
        let (column, row) = (contours.column_step_mm, contours.row_step_mm);
        let [u, v] = [column, row].map(Vector3::from);
        let normal = u.cross(&v);
        let length = |v: &Vector3| (1e-9..MOST_MM).contains(&v.norm());
        let spanned = length(&u) && length(&v) && normal.norm() > 1e-6 * u.norm() * v.norm();
        if !spanned {
            return Err(LoftError::Steps { column, row });
        }
        let (normal, first) = (normal.normalize(), u.normalize());
        let axes = [first, normal.cross(&first), normal];
        for (slice, s) in contours.slices.iter().enumerate() {
            if !s.origin_mm.iter().all(|v| v.abs() <= MOST_MM) {
                return Err(LoftError::Origin { slice, origin: s.origin_mm });
            }
        }
        match &contours.slices[..] {
            [] => return Err(LoftError::Empty { slices: 0 }),
            [_] => return Err(LoftError::Single),
            _ => {}
        }
        let Some(begin) = contours.slices.iter().find_map(|s| {
            let p = s.contours.first()?.points.first()?;
            let at = Vector3::from(s.origin_mm) + u * p.i + v * p.j;
            at.iter().all(|c| c.is_finite()).then_some(at)
        }) else {
            return Err(match contours.slices.iter().position(|s| !s.contours.is_empty()) {
                None => LoftError::Empty { slices: contours.slices.len() },
                Some(slice) => bad_point(slice, 0, 0, &contours.slices[slice]),
            });
        };
        let mut stack = Self { slices: Vec::new(), warnings: Vec::new(), origin: Point3::from(begin), axes };
        let plane = |at: Vector3| [(at - begin).dot(&axes[0]), (at - begin).dot(&axes[1])];
        let count = contours.slices.len();
        for (number, slice) in contours.slices.iter().enumerate() {
            let origin = Vector3::from(slice.origin_mm);
            let mut checked = Slice {
                number,
                height: (origin - begin).dot(&normal),
                contours: Vec::with_capacity(slice.contours.len()),
                lost: slice.contours.is_empty() && !slice.edited && slice.flags.contains(&SliceFlag::Lost),
                cut_off: (number == 0 || number + 1 == count) && slice.flags.contains(&SliceFlag::CutOff),
            };
            for (c, contour) in slice.contours.iter().enumerate() {
                let mut points: Vec<[f64; 2]> = Vec::with_capacity(contour.points.len());
                for (n, p) in contour.points.iter().enumerate() {
                    let at = plane(origin + u * p.i + v * p.j);
                    if !at.iter().all(|c| c.abs() <= MOST_MM) {
                        return Err(bad_point(number, c, n, slice));
                    }
                    if points.last() != Some(&at) {
                        points.push(at);
                    }
                }
                while points.len() > 1 && points.first() == points.last() {
                    points.pop();
                }
                let distinct = distinct(&points);
                if distinct < 3 {
                    return Err(LoftError::Few { slice: number, contour: c, distinct });
                }
                checked.contours.push(Contour::of(c, points));
            }
            stack.slices.push(checked);
        }
        if stack.slices.last().map(|s| s.height) < stack.slices.first().map(|s| s.height) {
            stack.slices.reverse();
        }
        if let Some(at) = stack.slices.windows(2).position(|w| w[1].height - w[0].height <= 1e-6) {
            let slice = stack.slices[at].number.max(stack.slices[at + 1].number);
            return Err(LoftError::Order { slice });
        }
        if stack.slices.iter().all(|s| s.contours.is_empty()) {
            return Err(LoftError::Empty { slices: count });
        }
        Ok(stack)
    }

    /// A place of the stack's frame in the scanner's.
    pub fn scanner(&self, [x, y, z]: [f64; 3]) -> Point3 {
        self.origin + self.axes[0] * x + self.axes[1] * y + self.axes[2] * z
    }

    /// Number of the slice at or below a point of the scanner's frame.
    pub fn slice_below(&self, at: &Point3) -> usize {
        let height = (at - self.origin).dot(&self.axes[2]) + 1e-9;
        let above = self.slices.partition_point(|s| s.height <= height);
        self.slices.get(above.saturating_sub(1)).map_or(0, |s| s.number)
    }
}

fn bad_point(slice: usize, contour: usize, point: usize, of: &ContourSlice) -> LoftError {
    let at = of.contours.get(contour).and_then(|c| c.points.get(point));
    let (i, j) = at.map_or((f64::NAN, f64::NAN), |p| (p.i, p.j));
    LoftError::Point { slice, contour, point, i, j }
}

/// How many different points there are, as far as three.
fn distinct(points: &[[f64; 2]]) -> usize {
    let Some(first) = points.first() else { return 0 };
    let Some(second) = points.iter().find(|p| *p != first) else { return 1 };
    if points.iter().any(|p| p != first && p != second) { 3 } else { 2 }
}
