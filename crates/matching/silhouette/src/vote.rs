//! Silhouettes among other edges: every template at every place of a picture, 64 places at a time.
//!
//! A picture is a grid of cells, 64 across, and a mask for each direction of edges: a bit is set where an edge of that direction is
//! near. A template at a place is as good as the number of its points whose bit is set; the masks' rows, shifted by a point's offset,
//! are added up as numbers that lie across the bits of machine words, so that one addition counts for 64 places (Borgefors 1988 and
//! Gavrila 1998 match templates by distance maps; the counting is that of bit-sliced sums).
//!
//! What one view finds is held against the others along the ray, depth by depth.

use biplane_fluoroscope::Fluoroscope;
use biplane_geometry::{EdgePoint, Point2, Point3, Vector2, Vector3};
use nalgebra::{Matrix2, Matrix3, Rotation3, UnitQuaternion};

use crate::place::{Place, distinct};
use crate::template::{TemplatePoint, Templates};

/// Directions of edges that are told apart.
const BINS: usize = 20;
/// Cells across and down.
const CELLS: usize = 64;
/// Planes of the bit-sliced sums: counts below 64.
const PLANES: usize = 6;
/// Side of a cell of the distance maps, as a part of a cell of the masks.
const FINER: usize = 4;
/// Cells of the distance maps across and down.
const FINE: usize = CELLS * FINER;
/// Turns of a template in the picture.
const TURNS: usize = 36;
/// What one view hands on to be held against the others, and what one view alone keeps of each depth.
const HITS: (usize, usize) = (3000, 600);
/// Places that are nearer than this, rad and mm, are one.
const APART: (f64, f64) = (0.2, 12.0);
/// Places that are kept: of several views, and of each depth of one view.
const PLACES: (usize, usize) = (48, 16);

/// A picture's edges by direction.
pub(crate) struct EdgeMaps<'a> {
    pub view: &'a Fluoroscope,
    /// Side of a cell of the masks, px.
    cell_px: f64,
    /// A row of bits for each row of cells, with a picture's height of empty rows on both sides, for each direction.
    masks: Vec<[u64; 3 * CELLS]>,
    /// Distance to the nearest edge of each direction, in cells of the distance map, at most [`FAR`].
    distances: Vec<Vec<u8>>,
    /// What the body's edges have for a sign: +1 dark inside.
    contrast: f64,
}

/// The largest distance that is told apart, in thirds of a distance map's cell.
const FAR: u8 = 24;

/// The bin of a direction given in turns.
fn bin(turn: f32) -> usize {
    ((turn * BINS as f32).round() as i32).rem_euclid(BINS as i32) as usize
}

/// Where a direction points, turns.
fn turn(direction: &Vector2) -> f32 {
    (direction.y.atan2(direction.x) / std::f64::consts::TAU) as f32
}

impl<'a> EdgeMaps<'a> {
    /// Of a view's edges in ideal pixels.
    pub fn new(view: &'a Fluoroscope, edges: &[EdgePoint], contrast: f64) -> Self {
        let size = view.size();
        let cell_px = size[0].max(size[1]) as f64 / CELLS as f64;
        let mut masks = vec![[0_u64; 3 * CELLS]; BINS];
        let mut distances = vec![vec![FAR; FINE * FINE]; BINS];
        let fine_px = cell_px / FINER as f64;
        for e in edges {
            let (cx, cy) = ((e.position.x / cell_px).floor(), (e.position.y / cell_px).floor());
            let inside = |v: f64, n: usize| v >= 0.0 && v < n as f64;
            if !inside(cx, CELLS) || !inside(cy, CELLS) {
                continue;
            }
            let b = bin(turn(&e.direction));
            let (fx, fy) = ((e.position.x / fine_px) as usize, (e.position.y / fine_px) as usize);
            let around = 1_u64.wrapping_shl(cx as u32);
            let around = around | around << 1 | around >> 1;
            for near in [b + BINS - 1, b, b + 1] {
                let near = near % BINS;
                for y in 0..3 {
                    masks[near][CELLS + cy as usize + y - 1] |= around;
                }
                distances[near][fy.min(FINE - 1) * FINE + fx.min(FINE - 1)] = 0;
            }
        }
        // What was marked beyond the picture's last rows is no part of it.
        for mask in &mut masks {
            mask[..CELLS].fill(0);
            mask[2 * CELLS..].fill(0);
        }
        distances.iter_mut().for_each(|d| chamfer(d));
        Self { view, cell_px, masks, distances, contrast }
    }

    /// +1 for a body darker than what is around it.
    pub fn contrast(&self) -> f64 {
        self.contrast
    }

    /// Side of a cell of the masks, px.
    pub fn cell_px(&self) -> f64 {
        self.cell_px
    }

    /// How well the silhouette of a body with its centroid at `point`, turned by `rotation`, lies on edges of its direction: 0 to 1,
    /// by every `stride`th point.
    fn score(&self, templates: &Templates, rotation: &Matrix3<f64>, point: &Point3, stride: usize) -> f64 {
        let Some(local) = Local::of(self.view, point) else { return 0.0 };
        let (points, c, s) = templates.of_rotation(&(local.frame.transpose() * rotation));
        let laid = Laid::new(&local, c, s, self.contrast);
        let fine_px = (self.cell_px / FINER as f64) as f32;
        let pixel = local.pixel.coords.cast::<f32>();
        let (mut sum, mut count) = (0_u32, 0_u32);
        for p in points.iter().step_by(stride) {
            let at = (pixel + laid.place(p)) / fine_px;
            count += 1;
            if at.x >= 0.0 && at.y >= 0.0 && at.x < FINE as f32 && at.y < FINE as f32 {
                let distance = self.distances[bin(laid.turn(p))][at.y as usize * FINE + at.x as usize];
                sum += u32::from(FAR - distance);
            }
        }
        f64::from(sum) / f64::from((count * u32::from(FAR)).max(1))
    }
}

/// Distances from what is 0, thirds of a cell: 3 straight on, 4 across a corner (Borgefors 1986).
fn chamfer(map: &mut [u8]) {
    for y in 0..FINE {
        for x in 0..FINE {
            let mut d = map[y * FINE + x];
            if x > 0 {
                d = d.min(map[y * FINE + x - 1].saturating_add(3));
            }
            if y > 0 {
                d = d.min(map[(y - 1) * FINE + x].saturating_add(3));
                if x > 0 {
                    d = d.min(map[(y - 1) * FINE + x - 1].saturating_add(4));
                }
                if x + 1 < FINE {
                    d = d.min(map[(y - 1) * FINE + x + 1].saturating_add(4));
                }
            }
            map[y * FINE + x] = d;
        }
    }
    for y in (0..FINE).rev() {
        for x in (0..FINE).rev() {
            let mut d = map[y * FINE + x];
            if x + 1 < FINE {
                d = d.min(map[y * FINE + x + 1].saturating_add(3));
            }
            if y + 1 < FINE {
                d = d.min(map[(y + 1) * FINE + x].saturating_add(3));
                if x > 0 {
                    d = d.min(map[(y + 1) * FINE + x - 1].saturating_add(4));
                }
                if x + 1 < FINE {
                    d = d.min(map[(y + 1) * FINE + x + 1].saturating_add(4));
                }
            }
            map[y * FINE + x] = d;
        }
    }
}

/// How a view sees what is around a point.
pub(crate) struct Local {
    /// Where the point appears.
    pub pixel: Point2,
    /// Two directions across the ray and the ray, laboratory frame; right-handed.
    pub frame: Matrix3<f64>,
    /// Pixels for a millimetre along the first two.
    pub to_px: Matrix2<f64>,
}

impl Local {
    pub fn of(view: &Fluoroscope, point: &Point3) -> Option<Self> {
        let (projection, by_point) = view.project_with_derivative(point)?;
        let ray = (point - view.source()).try_normalize(0.0)?;
        // Along the ray a pixel does not move, so its derivative lies across it.
        let x = by_point.row(0).transpose().try_normalize(0.0)?;
        let y = ray.cross(&x);
        let to_px = Matrix2::from_columns(&[by_point * x, by_point * y]);
        Some(Self { pixel: projection.pixel, frame: Matrix3::from_columns(&[x, y, ray]), to_px })
    }
}

/// A template laid on a picture.
pub(crate) struct Laid {
    place: nalgebra::Matrix2<f32>,
    /// Turns of a template's normals: sign and offset. What is around a point is seen turned and perhaps mirrored, hardly skewed.
    sign: f32,
    offset: f32,
}

impl Laid {
    /// Turned by an angle with cosine `c` and sine `s`.
    pub fn new(local: &Local, c: f64, s: f64, contrast: f64) -> Self {
        let place = local.to_px * Matrix2::new(c, -s, s, c);
        let x: Vector2 = place.column(0) * contrast;
        Self { place: place.cast(), sign: place.determinant().signum() as f32, offset: turn(&x) }
    }

    /// A point's offset from the centroid's pixel, px.
    fn place(&self, p: &TemplatePoint) -> nalgebra::Vector2<f32> {
        self.place * nalgebra::Vector2::from(p.place)
    }

    /// Where the edge below a point runs from dark to bright, turns.
    pub fn turn(&self, p: &TemplatePoint) -> f32 {
        self.offset + self.sign * p.turn
    }
}

/// A template at a place of one view.
#[derive(Debug, Clone, Copy)]
struct Hit {
    count: u32,
    direction: u32,
    turn: u32,
    cell: [u32; 2],
    /// Distance of the centroid from the source, mm.
    away: f64,
}

/// The best place of every template in a view where the body would have its centroid `away` mm from the source.
fn scan(maps: &EdgeMaps, templates: &Templates, away: f64) -> Vec<Hit> {
    let mut hits = Vec::with_capacity(templates.turned.len() * TURNS);
    let middle = Point2::from(maps.view.size().map(|n| n as f64 / 2.0));
    let Some(ray) = maps.view.ray(&middle) else { return hits };
    let Some(local) = Local::of(maps.view, &(maps.view.source() + ray * away)) else { return hits };
    for direction in 0..templates.turned.len() {
        for turn in 0..TURNS {
            let (s, c) = (std::f64::consts::TAU * turn as f64 / TURNS as f64).sin_cos();
            let laid = Laid::new(&local, c, s, maps.contrast);
            if let Some((count, cell)) = best_place(maps, templates.points(direction), &laid) {
                hits.push(Hit { count, direction: direction as u32, turn: turn as u32, cell, away });
            }
        }
    }
    hits
}

/// The place where most of a template's points lie on edges of their direction.
fn best_place(maps: &EdgeMaps, points: &[TemplatePoint], laid: &Laid) -> Option<(u32, [u32; 2])> {
    let mut sums = [[0_u64; CELLS]; PLANES];
    for p in points {
        let at = laid.place(p) / maps.cell_px as f32;
        let (dx, dy) = (at.x.round(), at.y.round());
        if dx.abs() >= CELLS as f32 || dy.abs() > CELLS as f32 {
            continue;
        }
        let from = (CELLS as isize + dy as isize) as usize;
        let rows = &maps.masks[bin(laid.turn(p))][from..from + CELLS];
        // The centroid's column is the point's less `dx`.
        let (left, right) = ((-dx).max(0.0) as u32, dx.max(0.0) as u32);
        for (y, row) in rows.iter().enumerate() {
            let mut carry = (row >> right) << left;
            for plane in &mut sums {
                let sum = plane[y];
                plane[y] = sum ^ carry;
                carry &= sum;
            }
        }
    }
    // From the highest plane down, the places that still may have the largest sum.
    let mut places = [u64::MAX; CELLS];
    let mut count = 0;
    for (k, plane) in sums.iter().enumerate().rev() {
        if plane.iter().zip(&places).any(|(p, q)| p & q != 0) {
            count |= 1 << k;
            places.iter_mut().zip(plane).for_each(|(q, p)| *q &= p);
        }
    }
    let y = places.iter().position(|p| *p != 0)?;
    (count > 0).then(|| (count, [places[y].trailing_zeros(), y as u32]))
}

/// How well a silhouette stands in all views, by every `stride`th point.
fn mean_score(
    maps: &[EdgeMaps],
    templates: &Templates,
    turned: &Matrix3<f64>,
    at: &Point3,
    stride: usize,
) -> f64 {
    let sum: f64 = maps.iter().map(|m| m.score(templates, turned, at, stride)).sum();
    sum / maps.len().max(1) as f64
}

/// Places at which silhouettes lie on edges of their direction in all views, apart from each other, with 1 less their mean score for a misfit. `near` is
/// where the views look; for one view alone the depth is sought where the body is as large as bodies are in pictures, and each depth
/// has its own best places: small silhouettes find edges more easily than large ones.
pub(crate) fn vote(maps: &[EdgeMaps], templates: &Templates, near: Option<&Point3>) -> Vec<Place> {
    let best = |map: &EdgeMaps, away: f64, most: usize| {
        let mut hits = scan(map, templates, away);
        hits.sort_by_key(|h| (std::cmp::Reverse(h.count), h.direction, h.turn));
        hits.truncate(most);
        hits.iter().filter_map(|hit| along_the_ray(maps, map, templates, hit)).collect::<Vec<Place>>()
    };
    match (near, maps) {
        (Some(near), _) => {
            let of = |map| best(map, (near - map.view.source()).norm(), HITS.0);
            distinct(maps.iter().flat_map(of).collect(), APART, PLACES.0)
        }
        (None, [map]) => {
            let of = |away| distinct(best(map, away, HITS.1), APART, PLACES.1);
            depths(map, templates).flat_map(of).collect()
        }
        (None, _) => Vec::new(),
    }
}

/// Distances from the source at which the body's diameter is from three quarters of the picture down to a sixth.
fn depths(map: &EdgeMaps, templates: &Templates) -> impl Iterator<Item = f64> {
    let width = *map.view.size().iter().max().unwrap_or(&1) as f64 * map.view.mm_per_px(1.0);
    let nearest = 2.0 * templates.radius / (0.75 * width);
    (0..DEPTHS).map(move |k| nearest * DEPTH_RATIO.powi(k))
}

/// Depths that one view alone tries, and the ratio of one to the next.
const DEPTHS: i32 = 14;
const DEPTH_RATIO: f64 = 1.12;
/// Steps along a ray, part of the distance, and how many to either side: two views, one.
const RAY_STEP: f64 = 0.006;
const RAY_STEPS: (i32, i32) = (21, 12);
/// Only every so many steps, and every so many points, are looked at to find the best one roughly.
const ROUGH: usize = 3;

/// A hit at the depth along its ray where it stands best in all views.
fn along_the_ray(maps: &[EdgeMaps], map: &EdgeMaps, templates: &Templates, hit: &Hit) -> Option<Place> {
    let pixel = Point2::from(hit.cell.map(|c| (f64::from(c) + 0.5) * map.cell_px));
    let ray: Vector3 = map.view.ray(&pixel)?;
    let local = Local::of(map.view, &(map.view.source() + ray * hit.away))?;
    let angle = std::f64::consts::TAU * f64::from(hit.turn) / TURNS as f64;
    let about = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
    let frame = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(local.frame));
    let rotation = frame * about * templates.turned[hit.direction as usize];
    let matrix = *rotation.to_rotation_matrix().matrix();
    let at = |k: i32| map.view.source() + ray * (hit.away * (1.0 + RAY_STEP * f64::from(k)));
    let score = |k: i32, stride: usize| mean_score(maps, templates, &matrix, &at(k), stride);
    let best = |steps: &mut dyn Iterator<Item = i32>, stride: usize| {
        steps.map(|k| (k, score(k, stride))).max_by(|a, b| a.1.total_cmp(&b.1))
    };
    let steps = if maps.len() > 1 { RAY_STEPS.0 } else { RAY_STEPS.1 };
    let (rough, _) = best(&mut (-steps..=steps).step_by(ROUGH), ROUGH)?;
    let (k, score) = best(&mut (rough - 1..=rough + 1), 1)?;
    Some(Place { rotation, centre: at(k), misfit: 1.0 - score })
}
