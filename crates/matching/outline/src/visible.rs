//! The visible outline at one pose in one view, as sample points along the rim.

use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{Point2, Point3, Pose, Vector2, Vector3};
use nalgebra::Matrix3;

use crate::RimMesh;
use crate::rim::{Crease, Triangle};
use crate::tree::Node;

/// How densely the outline is sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sampling {
    /// Parts of the rim longer than this in the image are cut into equal parts no longer than this, px.
    pub step_px: f64,
}

/// A point of the outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutlinePoint {
    /// On the surface, laboratory frame, mm.
    pub world: Point3,
    /// Its ideal pixel.
    pub pixel: Point2,
    /// Depth from the source, mm.
    pub depth: f64,
    /// Unit normal of the outline, away from the shadow.
    pub normal: Vector2,
    /// Length of the outline that it stands for, px.
    pub length_px: f64,
    /// Radius of curvature of the surface along the ray, mm: 0 on a crease, infinite where flat.
    pub radius_mm: f64,
}

/// A point of the rim at which its segments meet.
#[derive(Debug, Clone, Copy)]
struct Knot {
    /// From the mesh's centroid, model axes, mm.
    at: Vector3,
    /// The surface's normal, model axes; not used at a crease.
    normal: Vector3,
    pixel: Point2,
    depth: f64,
    /// Sum of the outward normals of the segments that meet, times their lengths, px.
    outward: Vector2,
    /// Half of their lengths, px.
    length: f64,
    /// The triangle that it was found in; none at a crease.
    triangle: u32,
}

/// A knot on a crease: no sample of the outline itself.
const ON_CREASE: u32 = u32::MAX;

/// A projected part of the rim. `front` and `back` count how often it bounds front and back faces, with their direction.
#[derive(Debug, Clone, Copy)]
struct Segment {
    from: Point2,
    to: Point2,
    front: i32,
    back: i32,
}

/// A point in the middle of a part of a crease.
#[derive(Debug, Clone, Copy)]
struct CreaseSample {
    crease: u32,
    t: f64,
    outward: Vector2,
    length: f64,
}

/// Rows of bins at most: a body larger than any picture gets coarser bins.
const MAX_BINS: usize = 4096;
/// Parts that one segment is cut into at most.
const MAX_PARTS: f64 = 1000.0;
/// The surface is not lifted from a chord by more than this share of it: normals that turn more are no sample of a smooth surface.
const MOST_LIFT: f64 = 0.25;

/// From the model to one view, at one pose.
#[derive(Debug, Clone, Copy)]
struct Projector {
    matrix: Matrix3<f64>,
    offset: Vector3,
    /// The source, from the mesh's centroid, model axes, mm.
    source: Vector3,
    /// From model axes to the laboratory's, and where the centroid lies there.
    rotation: Matrix3<f64>,
    centre: Point3,
}

impl Projector {
    fn new(mesh: &RimMesh, pose: &Pose, view: &Fluoroscope) -> Self {
        let rotation = pose.rotation().to_rotation_matrix().into_inner();
        let centre = pose.transform(mesh.centroid());
        Self {
            matrix: view.matrix() * rotation,
            offset: view.matrix() * (centre - view.source()),
            source: rotation.transpose() * (view.source() - centre),
            rotation,
            centre,
        }
    }

    #[inline]
    fn project(&self, at: &Vector3) -> Option<(Point2, f64)> {
        let h = self.matrix * at + self.offset;
        (h.z > 0.0).then(|| (Point2::new(h.x / h.z, h.y / h.z), h.z))
    }

    /// Direction in the picture of a direction in the model, at a point that is seen at `pixel`; not normalised.
    #[inline]
    fn direction(&self, along: &Vector3, pixel: &Point2) -> Vector2 {
        let h = self.matrix * along;
        Vector2::new(h.x - pixel.x * h.z, h.y - pixel.y * h.z)
    }
}

/// The outline of one mesh in one view, with buffers that are used again.
#[derive(Debug, Clone, Default)]
pub struct Outline {
    points: Vec<OutlinePoint>,
    inner: Vec<OutlinePoint>,
    lean: bool,
    values: Vec<f64>,
    /// For each edge the trace it was crossed in last, and the knot.
    crossed: Vec<[u32; 2]>,
    traces: u32,
    knots: Vec<Knot>,
    on_creases: Vec<CreaseSample>,
    segments: Vec<Segment>,
    bin_start: Vec<u32>,
    /// The segments of each bin, one after the other.
    bin_items: Vec<Segment>,
    first_row: f64,
    rows_per_px: f64,
}

impl Outline {
    /// An outline with empty buffers.
    pub fn new() -> Self {
        Self::default()
    }

    /// The points of the last trace, in an order that depends on the mesh and the pose alone.
    pub fn points(&self) -> &[OutlinePoint] {
        &self.points
    }

    /// An outline that leaves out what a search for a pose has no use for: [`Self::inner`] and [`OutlinePoint::radius_mm`], which is
    /// not a number then.
    pub fn lean() -> Self {
        Self { lean: true, ..Self::default() }
    }

    /// Points of the rim inside the shadow, where the body covers itself: an X-ray shows them too.
    pub fn inner(&self) -> &[OutlinePoint] {
        &self.inner
    }

    /// Length of the whole outline, px.
    pub fn length_px(&self) -> f64 {
        self.points.iter().map(|p| p.length_px).sum()
    }

    /// Finds the outline of `mesh` at `pose`; empty if a part of the rim lies at or behind the source.
    pub fn trace(&mut self, mesh: &RimMesh, pose: &Pose, view: &Fluoroscope, sampling: Sampling) {
        self.trace_thinned(mesh, pose, view, sampling, 0.0);
    }

    /// As [`Self::trace`], with one sample for every `spacing_px` of rim at least: samples that are nearer are passed over, and
    /// their lengths counted with the next.
    pub fn trace_thinned(
        &mut self,
        mesh: &RimMesh,
        pose: &Pose,
        view: &Fluoroscope,
        sampling: Sampling,
        spacing_px: f64,
    ) {
        self.points.clear();
        self.inner.clear();
        let projector = Projector::new(mesh, pose, view);
        let side = if view.keeps_orientation() { 1.0 } else { -1.0 };
        if self.find_rim(mesh, &projector, side, sampling.step_px).is_none() {
            self.segments.clear();
            return;
        }
        self.fill_bins();
        self.sample(mesh, &projector, spacing_px);
    }

    /// Fills knots and segments with the projected rim. `None` if something is behind the source.
    fn find_rim(&mut self, mesh: &RimMesh, projector: &Projector, side: f64, step: f64) -> Option<()> {
        self.segments.clear();
        self.knots.clear();
        self.on_creases.clear();
        if self.crossed.len() != mesh.edges || self.traces == u32::MAX {
            self.crossed.clear();
            self.crossed.resize(mesh.edges, [0; 2]);
            self.traces = 0;
        }
        self.traces += 1;
        let source = projector.source;
        let mut values = std::mem::take(&mut self.values);
        let mut next = 0;
        let mut whole = Some(());
        while let Some(node) = mesh.tree.nodes.get(next) {
            if !node.may_differ(&source) {
                next = node.skip as usize;
                continue;
            }
            next += 1;
            if node.leaf == Node::INNER {
                continue;
            }
            let leaf = &mesh.tree.leaves[node.leaf as usize];
            mesh.tree.values(leaf, &source, &mut values);
            let first = leaf.slots[0];
            let value = |slot: u32| values[(slot - first) as usize];
            for t in leaf.triangles[0]..leaf.triangles[1] {
                let triangle = &mesh.triangles[t as usize];
                let g = triangle.slots.map(value);
                let front = g.map(|g| g > 0.0);
                if front[0] == front[1] && front[1] == front[2] {
                    continue;
                }
                whole = whole.and_then(|()| self.cross(mesh, projector, side, step, t, g, front));
            }
            for c in leaf.creases[0]..leaf.creases[1] {
                whole = whole.and_then(|()| self.run_along(mesh, projector, side, step, c, &value));
            }
            if whole.is_none() {
                break;
            }
        }
        self.values = values;
        whole
    }

    /// Adds the rim in a triangle whose corners look differently. It runs from where front turns to back to where back turns to
    /// front, so that the front lies to its left, seen from the source.
    #[allow(clippy::too_many_arguments)]
    fn cross(
        &mut self,
        mesh: &RimMesh,
        projector: &Projector,
        side: f64,
        step: f64,
        t: u32,
        g: [f64; 3],
        front: [bool; 3],
    ) -> Option<()> {
        let (mut from, mut to) = (0, 0);
        for k in 0..3 {
            let l = (k + 1) % 3;
            if front[k] != front[l] {
                let knot = self.knot(mesh, projector, t, k, [g[k], g[l]])?;
                *(if front[k] { &mut from } else { &mut to }) = knot;
            }
        }
        let (a, b) = (self.knots[from as usize], self.knots[to as usize]);
        let parts = ((b.pixel - a.pixel).norm() / step).ceil().clamp(1.0, MAX_PARTS) as u32;
        let mut last = from;
        for part in 1..parts {
            let f = f64::from(part) / f64::from(parts);
            let (at, normal) = lifted(&a.at, &b.at, &a.normal, &b.normal, f);
            let (pixel, depth) = projector.project(&at)?;
            let now = self.knots.len() as u32;
            self.knots.push(Knot {
                at,
                normal,
                pixel,
                depth,
                outward: Vector2::zeros(),
                length: 0.0,
                triangle: t,
            });
            self.join(last, now, side);
            last = now;
        }
        self.join(last, to, side);
        Some(())
    }

    /// The knot where the rim crosses side `k` of a triangle, at whose ends `n . (s - x)` has the values `g`.
    fn knot(&mut self, mesh: &RimMesh, projector: &Projector, t: u32, k: usize, g: [f64; 2]) -> Option<u32> {
        let triangle = &mesh.triangles[t as usize];
        let edge = triangle.edges[k];
        let mut wedges = [k, (k + 1) % 3].map(|c| mesh.tree.wedges[triangle.slots[c] as usize]);
        let mut g = g;
        let number = self.knots.len() as u32;
        let knot = if edge & Triangle::CREASE != 0 {
            let crease = &mesh.creases[(edge & !Triangle::CREASE) as usize];
            if mesh.wedges[wedges[0] as usize].at != crease.ends[0] {
                g.swap(0, 1);
            }
            Self::crease_knot(projector, crease, g[0] / (g[0] - g[1]))?
        } else {
            let known = &mut self.crossed[edge as usize];
            if known[0] == self.traces {
                return Some(known[1]);
            }
            *known = [self.traces, number];
            // The same to the bit from both triangles.
            if wedges[0] > wedges[1] {
                wedges.swap(0, 1);
                g.swap(0, 1);
            }
            let [a, b] = wedges.map(|w| &mesh.wedges[w as usize]);
            let (at, normal) = lifted(&a.at, &b.at, &a.normal, &b.normal, g[0] / (g[0] - g[1]));
            let (pixel, depth) = projector.project(&at)?;
            Knot { at, normal, pixel, depth, outward: Vector2::zeros(), length: 0.0, triangle: t }
        };
        self.knots.push(knot);
        Some(number)
    }

    fn crease_knot(projector: &Projector, crease: &Crease, t: f64) -> Option<Knot> {
        let at = crease.at(t).0;
        let (pixel, depth) = projector.project(&at)?;
        let (normal, outward) = (Vector3::zeros(), Vector2::zeros());
        Some(Knot { at, normal, pixel, depth, outward, length: 0.0, triangle: ON_CREASE })
    }

    /// Adds the segment between two knots.
    fn join(&mut self, from: u32, to: u32, side: f64) {
        let (a, b) = (self.knots[from as usize].pixel, self.knots[to as usize].pixel);
        self.segments.push(Segment { from: a, to: b, front: 1, back: -1 });
        let along = b - a;
        // In pixels with y down, (y, -x) is to the left of (x, y) for a picture that does not keep orientation.
        let outward = Vector2::new(along.y, -along.x) * side;
        let half = 0.5 * along.norm();
        for knot in [from, to] {
            let knot = &mut self.knots[knot as usize];
            knot.outward += outward;
            knot.length += half;
        }
    }

    /// Adds those parts of a crease that are on the rim: where front faces, or back faces, do not meet their like.
    fn run_along(
        &mut self,
        mesh: &RimMesh,
        projector: &Projector,
        side: f64,
        step: f64,
        number: u32,
        value: &impl Fn(u32) -> f64,
    ) -> Option<()> {
        let crease = &mesh.creases[number as usize];
        let sides = &mesh.sides[crease.sides[0] as usize..crease.sides[1] as usize];
        let mut from = 0.0;
        while from < 1.0 {
            // Up to the next place where a side turns.
            let mut to: f64 = 1.0;
            for s in sides {
                let g = s.slots.map(value);
                if (g[0] > 0.0) != (g[1] > 0.0) {
                    let t = g[0] / (g[0] - g[1]);
                    if t > from && t < to {
                        to = t;
                    }
                }
            }
            let middle = 0.5 * (from + to);
            let (mut front, mut back) = (0, 0);
            for s in sides {
                let g = s.slots.map(value);
                // To the bit where both ends are one plane.
                let here = if g[0] == g[1] { g[0] } else { g[0] + (g[1] - g[0]) * middle };
                *(if here > 0.0 { &mut front } else { &mut back }) += s.sign;
            }
            if front != 0 || back != 0 {
                self.run_part(mesh, projector, side, step, number, [from, to], [front, back])?;
            }
            from = to;
        }
        Some(())
    }

    #[allow(clippy::too_many_arguments)]
    fn run_part(
        &mut self,
        mesh: &RimMesh,
        projector: &Projector,
        side: f64,
        step: f64,
        number: u32,
        [from, to]: [f64; 2],
        [front, back]: [i32; 2],
    ) -> Option<()> {
        let crease = &mesh.creases[number as usize];
        let place = |t: f64| projector.project(&crease.at(t).0).map(|p| p.0);
        let (mut a, end) = (place(from)?, place(to)?);
        let parts = ((end - a).norm() / step).ceil().clamp(1.0, MAX_PARTS);
        // A front face lies to the left of its boundary seen from the source, a back face to the right.
        let sign = side * if front != 0 { f64::from(front.signum()) } else { -f64::from(back.signum()) };
        for part in 0..parts as u32 {
            let t = |k: f64| from + (to - from) * (f64::from(part) + k) / parts;
            let b = if f64::from(part + 1) < parts { place(t(1.0))? } else { end };
            let along = b - a;
            self.segments.push(Segment { from: a, to: b, front, back });
            let outward = Vector2::new(along.y, -along.x) * sign;
            self.on_creases.push(CreaseSample { crease: number, t: t(0.5), outward, length: along.norm() });
            a = b;
        }
        Some(())
    }

    /// Sorts the segments into bins of image rows.
    fn fill_bins(&mut self) {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for s in &self.segments {
            low = low.min(s.from.y.min(s.to.y));
            high = high.max(s.from.y.max(s.to.y));
        }
        let span = (high - low).max(1.0);
        let bins = if span.is_finite() {
            (span.ceil() as usize).min(self.segments.len() / 3).min(MAX_BINS) + 1
        } else {
            1
        };
        self.first_row = if low.is_finite() { low } else { 0.0 };
        self.rows_per_px = (bins - 1) as f64 / span;
        self.bin_start.clear();
        self.bin_start.resize(bins + 1, 0);
        for s in &self.segments {
            for bin in self.bin(s.from.y.min(s.to.y))..=self.bin(s.from.y.max(s.to.y)) {
                self.bin_start[bin + 1] += 1;
            }
        }
        for bin in 0..bins {
            self.bin_start[bin + 1] += self.bin_start[bin];
        }
        let none = Segment { from: Point2::origin(), to: Point2::origin(), front: 0, back: 0 };
        self.bin_items.resize(self.bin_start[bins] as usize, none);
        // Filled from the back of each bin; afterwards every start is where it was.
        for index in (0..self.segments.len()).rev() {
            let s = self.segments[index];
            for bin in self.bin(s.from.y.min(s.to.y))..=self.bin(s.from.y.max(s.to.y)) {
                self.bin_start[bin + 1] -= 1;
                self.bin_items[self.bin_start[bin + 1] as usize] = s;
            }
        }
        // bin_start[b + 1] now holds the start of bin b: shift back to the usual form.
        let total = self.bin_items.len() as u32;
        self.bin_start.remove(0);
        self.bin_start.push(total);
    }

    fn bin(&self, y: f64) -> usize {
        let row = ((y - self.first_row) * self.rows_per_px).max(0.0) as usize;
        row.min(self.bin_start.len().saturating_sub(2))
    }

    /// Whether any face, front or back, lies over a pixel: two winding numbers, from crossings of the half row to its right.
    fn covered(&self, q: &Point2) -> bool {
        let (mut front, mut back) = (0, 0);
        let bin = self.bin(q.y);
        for s in &self.bin_items[self.bin_start[bin] as usize..self.bin_start[bin + 1] as usize] {
            // +1 where the row is crossed downwards, -1 upwards; no branch, since none could be foreseen.
            let crossed = i32::from(s.from.y <= q.y) - i32::from(s.to.y <= q.y);
            let (along, apart) = (s.to - s.from, q - s.from);
            let turn = apart.y * along.x - apart.x * along.y;
            let counts = crossed * i32::from(turn * f64::from(crossed) > 0.0);
            front += counts * s.front;
            back += counts * s.back;
        }
        front != 0 || back != 0
    }

    /// Makes points of the knots and of the samples on creases.
    fn sample(&mut self, mesh: &RimMesh, projector: &Projector, spacing: f64) {
        let mut passed = 0.0;
        let mut due = |length: f64| {
            passed += length;
            if passed < spacing || passed <= 1e-9 { None } else { Some(std::mem::take(&mut passed)) }
        };
        for k in 0..self.knots.len() {
            let knot = &self.knots[k];
            if knot.triangle == ON_CREASE || mesh.triangles[knot.triangle as usize].ignored {
                continue;
            }
            let Some(length_px) = due(knot.length) else { continue };
            let knot = *knot;
            // The rim moves with the surface's tangent plane, which holds the ray: across the picture it runs along `ray x n`.
            let ray = knot.at - projector.source;
            let along = projector.direction(&ray.cross(&knot.normal), &knot.pixel);
            self.push(
                mesh,
                projector,
                &knot.at,
                (knot.pixel, knot.depth),
                along,
                knot.outward,
                length_px,
                || radius_along(mesh, &mesh.triangles[knot.triangle as usize], &ray),
            );
        }
        for k in 0..self.on_creases.len() {
            let sample = &self.on_creases[k];
            let crease = &mesh.creases[sample.crease as usize];
            if crease.ignored {
                continue;
            }
            let Some(length_px) = due(sample.length) else { continue };
            let (at, derivative) = crease.at(sample.t);
            let outward = sample.outward;
            let Some(place) = projector.project(&at) else { continue };
            let along = projector.direction(&derivative, &place.0);
            self.push(mesh, projector, &at, place, along, outward, length_px, || 0.0);
        }
    }

    #[allow(clippy::too_many_arguments)]
    fn push(
        &mut self,
        mesh: &RimMesh,
        projector: &Projector,
        at: &Vector3,
        (pixel, depth): (Point2, f64),
        along: Vector2,
        outward: Vector2,
        length_px: f64,
        radius: impl FnOnce() -> f64,
    ) {
        let across = Vector2::new(along.y, -along.x);
        let across = if across.dot(&outward) < 0.0 { -across } else { across };
        let Some(normal) = across.try_normalize(1e-300).or_else(|| outward.try_normalize(1e-300)) else {
            return;
        };
        let covered = self.covered(&(pixel + normal * mesh.beside_px));
        if covered && self.lean {
            return;
        }
        let world = projector.centre + projector.rotation * at;
        let radius_mm = if self.lean { f64::NAN } else { radius() };
        let point = OutlinePoint { world, pixel, depth, normal, length_px, radius_mm };
        (if covered { &mut self.inner } else { &mut self.points }).push(point);
    }
}

/// The point at `t` between two points of a surface with their normals, and the normal there.
#[inline]
fn lifted(a: &Vector3, b: &Vector3, na: &Vector3, nb: &Vector3, t: f64) -> (Vector3, Vector3) {
    let chord = b - a;
    let turn = nb - na;
    let normal = na + turn * t;
    let normal = normal / normal.norm().max(1e-300);
    // At right angles to the normal there, lest a slope of the chord be taken for a sagitta.
    let lift = 0.5 * t * (1.0 - t) * turn.dot(&chord);
    let lift = if lift * lift <= MOST_LIFT * MOST_LIFT * chord.norm_squared() { lift } else { 0.0 };
    (a + chord * t + normal * lift, normal)
}

/// Radius of curvature of the surface along a ray that touches it in a triangle, mm.
fn radius_along(mesh: &RimMesh, triangle: &Triangle, ray: &Vector3) -> f64 {
    let [a, b, c] = triangle.slots.map(|s| &mesh.wedges[mesh.tree.wedges[s as usize] as usize]);
    let (p, q) = (b.at - a.at, c.at - a.at);
    let area = p.cross(&q);
    // The normal's derivative along the ray, as it is interpolated over the triangle.
    let along_p = ray.cross(&q).dot(&area);
    let along_q = p.cross(ray).dot(&area);
    let turned = (b.normal - a.normal) * along_p + (c.normal - a.normal) * along_q;
    let curvature = ray.dot(&turned) / (area.norm_squared() * ray.norm_squared());
    if curvature.is_finite() { 1.0 / curvature.abs() } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_artifact::Calibration;
    use biplane_geometry::{Mesh, Vector3};

    /// Looks along +z from 1000 mm away, 1 px per mm at the origin; `mirror` turns x round.
    fn view(mirror: bool) -> Fluoroscope {
        let sx = if mirror { -1.0 } else { 1.0 };
        Fluoroscope::from(&Calibration {
            view: "A".to_owned(),
            size: [400, 400],
            source: [0.0, 0.0, -1000.0],
            matrix: [[1000.0 * sx, 0.0, 200.0], [0.0, 1000.0, 200.0], [0.0, 0.0, 1.0]],
            distortion: None,
        })
    }

    /// A ball of radius 40 mm with `n` rings and `2 n` sectors, without the faces for which `skip` holds.
    fn ball(n: usize, skip: impl Fn(usize) -> bool) -> Mesh {
        let point = |i: usize, j: usize| {
            let (a, b) = (
                std::f64::consts::PI * i as f64 / n as f64,
                std::f64::consts::PI * (j % (2 * n)) as f64 / n as f64,
            );
            if i == 0 || i == n {
                return Point3::new(0.0, 0.0, if i == 0 { 40.0 } else { -40.0 });
            }
            Point3::new(40.0 * a.sin() * b.cos(), 40.0 * a.sin() * b.sin(), 40.0 * a.cos())
        };
        let mut soup = Vec::new();
        for i in 0..n {
            for j in 0..2 * n {
                let (p, q, r, s) = (point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
                soup.push([p, q, r]);
                soup.push([p, r, s]);
            }
        }
        let kept: Vec<_> = soup.into_iter().enumerate().filter(|(k, _)| !skip(*k)).map(|(_, t)| t).collect();
        Mesh::from_soup(&kept).unwrap()
    }

    fn traced(mesh: &Mesh, pose: &Pose, view: &Fluoroscope) -> Outline {
        let mut outline = Outline::new();
        outline.trace(&RimMesh::new(mesh), pose, view, Sampling { step_px: 2.0 });
        outline
    }

    /// A ball's shadow is a circle of the tangent cone: radius 1000 tan(asin(40 / 1000)) px.
    #[test]
    fn a_ball_has_a_circle_for_outline_with_normals_outward() {
        let radius = 1000.0 * (0.04_f64).asin().tan();
        let mesh = ball(60, |_| false);
        for (mirror, wound) in [(false, false), (true, false), (false, true), (true, true)] {
            let mesh = if wound { mesh.clone().inverted() } else { mesh.clone() };
            let outline = traced(&mesh, &Pose::identity(), &view(mirror));
            let expected = 2.0 * std::f64::consts::PI * radius;
            assert!((outline.length_px() / expected - 1.0).abs() < 0.01, "{}", outline.length_px());
            for p in outline.points() {
                let r = p.pixel - Point2::new(200.0, 200.0);
                assert!((r.norm() - radius).abs() < 0.1, "{}", r.norm());
                assert!(r.normalize().dot(&p.normal) > 0.95);
            }
        }
    }

    #[test]
    fn an_open_ball_has_the_same_outline() {
        let whole = traced(&ball(60, |_| false), &Pose::identity(), &view(false)).length_px();
        // The cap towards the source and one away from it are missing: every pixel is still under a face.
        let near = traced(&ball(60, |k| k < 1200), &Pose::identity(), &view(false)).length_px();
        assert!((near / whole - 1.0).abs() < 1e-9, "{near} {whole}");
        // With faces missing on both sides over the same pixels there is a hole, and its outline counts.
        let total = 2 * 60 * 120;
        let both =
            traced(&ball(60, |k| k < 1200 || k >= total - 1200), &Pose::identity(), &view(false)).length_px();
        assert!(both > whole * 1.1, "{both} {whole}");
    }

    /// Two balls that overlap in the picture: the rim of each inside the other's shadow is not outline.
    #[test]
    fn what_another_part_covers_is_not_outline() {
        let (a, b) = (ball(40, |_| false), ball(40, |_| false));
        let mut vertices = a.vertices().to_vec();
        vertices.extend(b.vertices().iter().map(|v| v + Vector3::new(40.0, 3.0, 150.0)));
        let shift = a.vertices().len() as u32;
        let mut triangles = a.triangles().to_vec();
        triangles.extend(b.triangles().iter().map(|t| t.map(|v| v + shift)));
        let mesh = Mesh::new(vertices, triangles).unwrap();
        let outline = traced(&mesh, &Pose::identity(), &view(false));
        let circles = [
            (Point2::new(200.0, 200.0), 1000.0 * (0.04_f64).asin().tan()),
            (Point2::new(200.0 + 40.0 / 1.15, 200.0 + 3.0 / 1.15), 1000.0 * (40.0_f64 / 1150.0).asin().tan()),
        ];
        for p in outline.points() {
            for (centre, radius) in &circles {
                assert!((p.pixel - centre).norm() > radius - 0.3, "{} lies inside a shadow", p.pixel);
            }
        }
        assert!(outline.length_px() > 300.0);
    }

    /// Area under the projected triangles, px^2, by filling them one by one on a grid of quarter pixels.
    fn rasterised_area(mesh: &Mesh, pose: &Pose, view: &Fluoroscope) -> f64 {
        let mut filled = vec![false; 1600 * 1600];
        for t in 0..mesh.triangles().len() {
            let [a, b, c] = mesh.corners(t).map(|p| view.project(&pose.transform(&p)).unwrap().pixel * 4.0);
            let cross = |o: &Point2, p: &Point2, q: &Point2| (p - o).perp(&(q - o));
            let area = cross(&a, &b, &c);
            let (low, high) =
                (a.coords.inf(&b.coords).inf(&c.coords), a.coords.sup(&b.coords).sup(&c.coords));
            for y in low.y.ceil() as usize..=high.y.floor() as usize {
                for x in low.x.ceil() as usize..=high.x.floor() as usize {
                    let q = Point2::new(x as f64, y as f64);
                    let inside = |v: f64| v * area >= 0.0;
                    filled[y * 1600 + x] |=
                        inside(cross(&a, &b, &q)) && inside(cross(&b, &c, &q)) && inside(cross(&c, &a, &q));
                }
            }
        }
        filled.iter().filter(|f| **f).count() as f64 / 16.0
    }

    /// Area by Green's theorem from the outline against a count of covered pixels, at many poses.
    #[test]
    fn area_agrees_with_a_rasterised_shadow() {
        let mesh = ball(24, |k| k % 5 == 0);
        let rim = RimMesh::flat(&mesh);
        let view = view(false);
        let mut outline = Outline::new();
        for k in 0..20 {
            let pose = Pose::new(
                nalgebra::UnitQuaternion::from_euler_angles(0.3 * k as f64, 0.7 * k as f64, 0.1),
                Vector3::new(3.0 * k as f64 - 30.0, 5.0, 2.0 * k as f64),
            );
            outline.trace(&rim, &pose, &view, Sampling { step_px: 0.05 });
            let middle = Point2::new(200.0, 200.0);
            let by_green: f64 =
                outline.points().iter().map(|p| p.normal.dot(&(p.pixel - middle)) * p.length_px / 2.0).sum();
            let by_count = rasterised_area(&mesh, &pose, &view);
            assert!((by_green - by_count).abs() < 0.004 * by_count, "pose {k}: {by_green} {by_count}");
        }
    }
}
