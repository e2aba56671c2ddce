//! The visible outline at one pose in one view, as sample points along the rim.

use biplane_fluoroscope::{Fluoroscope, Projection};
use biplane_geometry::{Point2, Point3, Pose, Vector2};

use crate::RimMesh;

/// How densely the outline is sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sampling {
    /// Rim edges longer than this in the image are cut into equal parts no longer than this, px.
    pub step_px: f64,
}

/// A point of the outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutlinePoint {
    /// On the mesh, laboratory frame, mm.
    pub world: Point3,
    /// Its ideal pixel.
    pub pixel: Point2,
    /// Depth from the source, mm.
    pub depth: f64,
    /// Unit normal of the outline, away from the shadow.
    pub normal: Vector2,
    /// Length of the outline that it stands for, px.
    pub length_px: f64,
}

/// A projected rim edge. `front` and `back` count how often it bounds front and back faces, with their direction.
#[derive(Debug, Clone, Copy)]
struct Segment {
    from: Point2,
    to: Point2,
    world: [Point3; 2],
    depth: [f64; 2],
    front: i32,
    back: i32,
}

/// How far beside the rim one looks whether a face covers the picture, px: above the rounding of a crossing (1e-12 px).
/// At 1e-4 px a face seen almost edge-on had both of its sides taken for outline, in one pose of ten.
const BESIDE_PX: f64 = 1e-8;
/// Rows of bins at most: a body larger than any picture gets coarser bins.
const MAX_BINS: usize = 4096;

/// The outline of one mesh in one view, with buffers that are used again.
#[derive(Debug, Clone, Default)]
pub struct Outline {
    points: Vec<OutlinePoint>,
    facing: Vec<bool>,
    projected: Vec<Option<Projection>>,
    stamp: Vec<u32>,
    stamp_now: u32,
    segments: Vec<Segment>,
    bin_start: Vec<u32>,
    bin_items: Vec<u32>,
    first_row: f64,
    rows_per_px: f64,
}

impl Outline {
    /// An outline with empty buffers.
    pub fn new() -> Self {
        Self::default()
    }

    /// The points of the last [`Self::trace`], in the order of the mesh's edges.
    pub fn points(&self) -> &[OutlinePoint] {
        &self.points
    }

    /// Length of the whole outline, px.
    pub fn length_px(&self) -> f64 {
        self.points.iter().map(|p| p.length_px).sum()
    }

    /// Finds the outline of `mesh` at `pose`; empty if a part of the rim lies at or behind the source.
    pub fn trace(&mut self, mesh: &RimMesh, pose: &Pose, view: &Fluoroscope, sampling: Sampling) {
        self.points.clear();
        if self.find_rim(mesh, pose, view).is_none() {
            self.segments.clear();
            return;
        }
        self.fill_bins();
        let side = if view.keeps_orientation() { 1.0 } else { -1.0 };
        for index in 0..self.segments.len() {
            self.sample_segment(index, side, sampling);
        }
    }

    /// Fills `segments` with the projected rim. `None` if something is behind the source.
    fn find_rim(&mut self, mesh: &RimMesh, pose: &Pose, view: &Fluoroscope) -> Option<()> {
        mesh.planes.face(&pose.inverse().transform(view.source()), &mut self.facing);
        self.segments.clear();
        if self.stamp.len() != mesh.vertices.len() || self.stamp_now == u32::MAX {
            self.stamp = vec![0; mesh.vertices.len()];
            self.projected = vec![None; mesh.vertices.len()];
            self.stamp_now = 0;
        }
        self.stamp_now += 1;
        for (ends, sides) in mesh.ends.iter().zip(&mesh.sides) {
            let [left, right] = sides.map(|face| self.facing[face as usize]);
            if left != right {
                // The front face has its boundary run through once; the back face's runs the other way.
                let front = if left { 1 } else { -1 };
                self.push_segment(mesh, pose, view, *ends, front, -front)?;
            }
        }
        for edge in &mesh.odd_edges {
            let (mut front, mut back) = (0, 0);
            for &(face, sign) in &edge.faces {
                *(if self.facing[face as usize] { &mut front } else { &mut back }) += sign;
            }
            if front != 0 || back != 0 {
                self.push_segment(mesh, pose, view, edge.ends, front, back)?;
            }
        }
        Some(())
    }

    fn push_segment(
        &mut self,
        mesh: &RimMesh,
        pose: &Pose,
        view: &Fluoroscope,
        ends: [u32; 2],
        front: i32,
        back: i32,
    ) -> Option<()> {
        let world = ends.map(|v| pose.transform(&mesh.vertices[v as usize]));
        let mut project = |k: usize| {
            let v = ends[k] as usize;
            if self.stamp[v] != self.stamp_now {
                self.stamp[v] = self.stamp_now;
                self.projected[v] = view.project(&world[k]);
            }
            self.projected[v]
        };
        let (a, b) = (project(0)?, project(1)?);
        self.segments.push(Segment {
            from: a.pixel,
            to: b.pixel,
            world,
            depth: [a.depth, b.depth],
            front,
            back,
        });
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
        let bins = if span.is_finite() { (span.ceil() as usize + 1).min(MAX_BINS) } else { 1 };
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
        self.bin_items.clear();
        self.bin_items.resize(self.bin_start[bins] as usize, 0);
        // Filled from the back of each bin; afterwards every start is where it was.
        for index in (0..self.segments.len()).rev() {
            let s = self.segments[index];
            for bin in self.bin(s.from.y.min(s.to.y))..=self.bin(s.from.y.max(s.to.y)) {
                self.bin_start[bin + 1] -= 1;
                self.bin_items[self.bin_start[bin + 1] as usize] = index as u32;
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
        for &index in &self.bin_items[self.bin_start[bin] as usize..self.bin_start[bin + 1] as usize] {
            let s = &self.segments[index as usize];
            let (above, below) = (s.from.y <= q.y, s.to.y <= q.y);
            if above == below {
                continue;
            }
            let x = s.from.x + (q.y - s.from.y) / (s.to.y - s.from.y) * (s.to.x - s.from.x);
            if x > q.x {
                let sign = if above { 1 } else { -1 };
                front += sign * s.front;
                back += sign * s.back;
            }
        }
        front != 0 || back != 0
    }

    /// Adds the outline points of one rim edge. `side` is +1 where image and source agree on what is counter-clockwise.
    fn sample_segment(&mut self, index: usize, side: f64, sampling: Sampling) {
        let s = self.segments[index];
        let along = s.to - s.from;
        let length = along.norm();
        if length <= 1e-9 {
            return;
        }
        // A front face lies to the left of its boundary seen from the source, a back face to the right. In pixels with y
        // down, (y, -x) is to the left of (x, y) for a picture that does not keep orientation.
        let inward_sign =
            if s.front != 0 { f64::from(s.front.signum()) } else { -f64::from(s.back.signum()) };
        let outward = Vector2::new(along.y, -along.x) * (side * inward_sign / length);
        let parts = ((length / sampling.step_px).ceil() as usize).clamp(1, 1000);
        for part in 0..parts {
            let f = (part as f64 + 0.5) / parts as f64;
            let pixel = s.from + along * f;
            if self.covered(&(pixel + outward * BESIDE_PX)) {
                continue;
            }
            // The point in space at this fraction of the projected edge: fractions shift with depth.
            let g = f * s.depth[0] / (f * s.depth[0] + (1.0 - f) * s.depth[1]);
            self.points.push(OutlinePoint {
                world: s.world[0] + (s.world[1] - s.world[0]) * g,
                pixel,
                depth: s.depth[0] + (s.depth[1] - s.depth[0]) * g,
                normal: outward,
                length_px: length / parts as f64,
            });
        }
    }
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
        let rim = RimMesh::new(&mesh);
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
