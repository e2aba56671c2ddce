//! The method `distance`: slices as signed distances in their planes, interpolated across the slices; the surface is where they are zero.
//!
//! Slices become layers of one grid ([`crate::layer`]), their regions are linked with those of the next slice ([`crate::links`]), and between
//! each two slices a field is put together ([`crate::gap`]) of whose zero the triangles are made ([`crate::march`]) on levels about a cell
//! apart. Four slices are held at a time. Where smoothing is asked for the contours are moved first ([`crate::smooth`]), and the volume is that of
//! the surface through those that were not.

use std::rc::Rc;

use biplane_artifact::SurfaceReport;
use biplane_geometry::{Mesh, Point3, Vector3};

use crate::dome::{Close, Dome, Profile, Trend};
use crate::finish;
use crate::gap::{Blend, Field};
use crate::layer::{Grid, Joined, Layer, LeftOut, Run};
use crate::links::{Links, overlaps};
use crate::march::{Level, Mesher};
use crate::plane::Plane;
use crate::smooth::smoothed;
use crate::stack::{Slice, Stack};
use crate::stage::{Caps, Made};
use crate::{LoftError, LoftParams};

/// A cell's side in distances of neighbouring points of a contour.
const CELL_POINTS: f64 = 2.0;
/// Cells across a contour of usual width, at least and at most.
const CELLS_ACROSS: [f64; 2] = [16.0, 100.0];
/// Distance of levels in cells, at most.
const LEVEL_CELLS: f64 = 1.25;
/// Nodes of a level and of all levels, at most.
const MOST_NODES: f64 = 4e5;
const MOST_NODES_IN_ALL: f64 = 1e8;
/// Levels between two slices, at most.
const MOST_LEVELS: f64 = 64.0;
/// Nodes by which the surface between two slices may reach beyond both.
const BULGE: usize = 4;
/// Nodes around the contours' box.
const MARGIN: f64 = 4.0;

/// The surface of a stack.
///
/// # Errors
/// All contours are smaller than a cell.
pub(crate) fn surface(stack: &Stack, params: &LoftParams) -> Result<Made, LoftError> {
    let mut warnings = Vec::new();
    let grid = grid(stack, params.cell_mm, &mut warnings);
    let (lost, slices): (Vec<&Slice>, Vec<&Slice>) = stack.slices.iter().partition(|s| s.lost);
    for slice in lost {
        warnings.push(format!(
            "slice {}: the bone is missing in it; the surface goes through from the slices beside it",
            slice.number
        ));
    }
    let mut left_out = LeftOut::default();
    let layers: Vec<Layer> =
        slices.iter().map(|s| Layer::of(s, &grid, &mut warnings, &mut left_out)).collect();
    if layers.iter().all(|l| l.regions.is_empty()) {
        return Err(LoftError::Small { cell_mm: grid.cell });
    }
    warnings.extend(left_out.said(&grid));
    let mut lofted = Lofted::of(&grid, &layers, params);
    let mut unsmoothed_volume_mm3 = None;
    if params.smoothing_mm > 0.0 {
        finish::even(&mut lofted.vertices, &lofted.triangles, &lofted.rims);
        unsmoothed_volume_mm3 = Some(finish::volume(&lofted.vertices, &lofted.triangles));
        let moved = smoothed(&slices, &layers, &grid, params.smoothing_mm);
        let (mut said, mut left_out) = (Vec::new(), LeftOut::default());
        let again: Vec<Layer> = moved.iter().map(|s| Layer::of(s, &grid, &mut said, &mut left_out)).collect();
        lofted = Lofted::of(&grid, &again, params);
    }
    let Lofted { mut vertices, triangles, rims } = lofted;
    let unmoved: Vec<Point3> = vertices.iter().map(|v| stack.scanner((*v).into())).collect();
    finish::even(&mut vertices, &triangles, &rims);
    if let Some(volume) = unsmoothed_volume_mm3 {
        finish::keep_volume(&mut vertices, &triangles, &rims, volume, grid.cell);
    }
    let report = SurfaceReport {
        method: "distance".to_owned(),
        contours: layers.iter().flat_map(|l| &l.of_contour).filter(|c| **c != (None, None)).count(),
        warnings,
        ..SurfaceReport::default()
    };
    let moved = vertices.into_iter().map(|v| stack.scanner(v.into())).collect();
    let small = |_| LoftError::Small { cell_mm: grid.cell };
    let count = triangles.len();
    // A triangle that moving left without an area would be missing: then nothing is moved. As made in its cell each has one.
    let mesh = match Mesh::new(moved, triangles.clone()) {
        Ok(mesh) if mesh.triangles().len() == count => mesh,
        _ => Mesh::new(unmoved.clone(), triangles).map_err(small)?,
    };
    Ok(Made { mesh, unmoved: Some(unmoved), unsmoothed_volume_mm3, report })
}

/// A surface in the stack's frame, mm.
struct Lofted {
    vertices: Vec<Vector3>,
    triangles: Vec<[u32; 3]>,
    /// Whether a vertex lies on the rim of a lid.
    rims: Vec<bool>,
}

impl Lofted {
    fn of(grid: &Grid, layers: &[Layer], params: &LoftParams) -> Self {
        let links = Links::of(layers, params.reach);
        let mesher = Lofter::new(grid, layers, &links, params.caps).run();
        Self { rims: mesher.rims(), vertices: mesher.vertices, triangles: mesher.triangles }
    }
}

/// The grid: its cells as asked for, or from the contours' points and widths; larger where it would have too many nodes.
fn grid(stack: &Stack, cell_mm: f64, warnings: &mut Vec<String>) -> Grid {
    let contours = || stack.slices.iter().flat_map(|s| &s.contours);
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let (mut perimeter, mut points) = (0.0, 0);
    for contour in contours() {
        for a in 0..2 {
            low[a] = low[a].min(contour.low[a]);
            high[a] = high[a].max(contour.high[a]);
        }
        perimeter += contour.perimeter;
        points += contour.points.len();
    }
    // Of contours by length: what most of the surface is like. A disc's is its diameter.
    let mut widths: Vec<(f64, f64)> = contours()
        .map(|c| {
            let box_side = (c.high[0] - c.low[0]).max(c.high[1] - c.low[1]);
            ((4.0 * c.area.abs() / c.perimeter).max(0.25 * box_side), c.perimeter)
        })
        .collect();
    widths.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut left = perimeter / 2.0;
    let usual = widths.iter().find(|w| {
        left -= w.1;
        left <= 0.0
    });
    let width = usual.or(widths.last()).map_or(1.0, |w| w.0);
    let wanted = if cell_mm > 0.0 {
        cell_mm
    } else {
        let spacing = perimeter / f64::from(points.max(1) as u32);
        (CELL_POINTS * spacing).clamp(width / CELLS_ACROSS[1], width / CELLS_ACROSS[0])
    };
    let box_mm2 = ((high[0] - low[0]) * (high[1] - low[1])).max(1e-12);
    let rise = match &stack.slices[..] {
        [first, .., last] => last.height - first.height,
        _ => 0.0,
    };
    let least = (box_mm2 / MOST_NODES).sqrt().max((box_mm2 * rise / MOST_NODES_IN_ALL).cbrt());
    let cell = wanted.max(least).max(1e-6);
    if cell > wanted && cell_mm > 0.0 {
        warnings.push(format!(
            "cells are {cell:.2} mm, not {wanted:.2}: with the latter the grid would be too large"
        ));
    }
    // Nodes off the round numbers on which contours of pixels like to lie.
    let low = low.map(|v| v - (MARGIN + 0.3819) * cell);
    let size = [0, 1].map(|a| ((high[a] - low[a]) / cell + MARGIN).ceil() as usize + 1);
    Grid { low, cell, size, words: size[0].div_ceil(64) }
}

struct Lofter<'a> {
    grid: &'a Grid,
    layers: &'a [Layer],
    links: &'a [Links],
    caps: Caps,
    /// Of layers near the gap that is being filled.
    planes: Vec<Option<Rc<Plane>>>,
    spare: Vec<Plane>,
}

/// An end: a region or a hole of a layer, and the way it ends.
#[derive(Clone, Copy)]
struct End {
    layer: usize,
    of: u32,
    hole: bool,
    up: bool,
    /// Distance to the slice that does not have it, mm, and whether there is such a slice.
    limit: f64,
    seen: bool,
}

impl<'a> Lofter<'a> {
    fn new(grid: &'a Grid, layers: &'a [Layer], links: &'a [Links], caps: Caps) -> Self {
        Self { grid, layers, links, caps, planes: vec![None; layers.len()], spare: Vec::new() }
    }

    fn run(&mut self) -> Mesher<'a> {
        let count = self.layers.len();
        let [first, last] = [0, count - 1].map(|k| self.spacing(k));
        let begin = self.layers[0].height - first;
        let mut mesher = Mesher::new(self.grid, begin);
        self.end_of_stack(&mut mesher, 0, first, false);
        for gap in 0..count - 1 {
            for k in 0..gap.saturating_sub(1) {
                if let Some(plane) = self.planes[k].take().and_then(Rc::into_inner) {
                    self.spare.push(plane);
                }
            }
            self.fill(&mut mesher, gap);
        }
        self.end_of_stack(&mut mesher, count - 1, last, true);
        mesher
    }

    /// Distance of a layer from its neighbour, mm.
    fn spacing(&self, layer: usize) -> f64 {
        let k = layer.min(self.layers.len().saturating_sub(2));
        match self.layers.get(k..k + 2) {
            Some([a, b]) => b.height - a.height,
            _ => self.grid.cell,
        }
    }

    /// Distances of a layer near its contours.
    fn plane(&mut self, layer: usize) -> Rc<Plane> {
        if let Some(plane) = &self.planes[layer] {
            return Rc::clone(plane);
        }
        let mut plane = self.spare.pop().unwrap_or_default();
        let of = &self.layers[layer];
        plane.near(self.grid, of.sides.iter().copied(), &of.runs);
        let plane = Rc::new(plane);
        self.planes[layer] = Some(Rc::clone(&plane));
        plane
    }

    /// Distances of all nodes of a layer.
    fn complete(&mut self, layer: usize) -> Rc<Plane> {
        drop(self.plane(layer));
        let grid = self.grid;
        match &mut self.planes[layer] {
            Some(plane) => {
                Rc::make_mut(plane).complete(grid);
                Rc::clone(plane)
            }
            None => Rc::default(),
        }
    }

    /// Distances of all nodes from some regions of a layer, with some of its holes filled.
    fn part(&mut self, layer: usize, regions: &[u32], filled: &[u32]) -> Rc<Plane> {
        let of = &self.layers[layer];
        if regions.len() == of.regions.len() && filled.is_empty() {
            return self.complete(layer);
        }
        let sides = of.sides.iter().filter(|s| {
            let (region, hole) = of.of_contour[s.contour as usize];
            region.is_some_and(|r| regions.contains(&r)) && !hole.is_some_and(|h| filled.contains(&h))
        });
        let inside = of.runs.iter().filter(|r| regions.contains(&r.of));
        let within = of.hole_runs.iter().filter(|r| filled.contains(&r.of));
        let runs: Vec<Run> = inside.chain(within).copied().collect();
        let mut plane = Plane::default();
        plane.near(self.grid, sides.copied(), &runs);
        plane.complete(self.grid);
        Rc::new(plane)
    }

    /// Closes what begins in the first layer, or ends in the last.
    fn end_of_stack(&mut self, mesher: &mut Mesher<'_>, layer: usize, spacing: f64, up: bool) {
        let of = &self.layers[layer];
        let mut field = Field::default();
        for region in 0..of.regions.len() as u32 {
            field.domes.extend(self.dome(self.end(layer, region, false, up)));
        }
        let heights = if up { [of.height, of.height + spacing] } else { [of.height - spacing, of.height] };
        let levels = if of.regions.is_empty() { 1 } else { self.levels(spacing, 0.0) };
        let bits = if up { vec![0; of.bits.len()] } else { of.bits.clone() };
        let plane = (!up).then(|| self.plane(layer));
        self.climb(mesher, &field, heights, levels, bits, plane.as_deref());
    }

    fn levels(&self, rise: f64, moved: f64) -> usize {
        (rise / self.grid.cell / LEVEL_CELLS).max(moved).ceil().clamp(1.0, MOST_LEVELS) as usize
    }

    /// Goes up through a gap, level by level; `bits` and `plane` are those of its upper end.
    fn climb(
        &self,
        mesher: &mut Mesher<'_>,
        field: &Field,
        [low, high]: [f64; 2],
        levels: usize,
        bits: Vec<u64>,
        plane: Option<&Plane>,
    ) {
        let grid = self.grid;
        let root = |node: usize, heights: [f64; 2]| field.root(grid, node, heights);
        let mut values = Vec::new();
        for level in 1..levels {
            let height = low + (high - low) * level as f64 / levels as f64;
            field.fill(grid, height, &mut values);
            let mut bits = vec![0_u64; grid.words * grid.size[1]];
            for j in 1..grid.size[1] - 1 {
                let row = &values[j * grid.size[0]..(j + 1) * grid.size[0]];
                for (word, nodes) in bits[j * grid.words..].iter_mut().zip(row.chunks(64)) {
                    *word = nodes.iter().enumerate().fold(0, |w, (i, v)| w | u64::from(*v < 0.0) << i);
                }
            }
            mesher.rise(Level { bits, height }, |node| values[node], root);
        }
        mesher.rise(Level { bits, height: high }, |node| plane.map_or(1.0, |p| p.values[node]), root);
        mesher.mark([low, high], |place, height| field.has_rim_at(place, height));
    }

    /// Fills a gap between two layers.
    fn fill(&mut self, mesher: &mut Mesher<'_>, gap: usize) {
        let (layers, links) = (self.layers, &self.links[gap]);
        let (below, above) = (&layers[gap], &layers[gap + 1]);
        let rise = above.height - below.height;
        let heights = [below.height, above.height];
        let upper = self.plane(gap + 1);
        let mut field = Field::default();
        let groups = self.groups(gap);
        let moved = groups.iter().filter_map(|g| g.moved).fold(0.0, f64::max);
        let mut levels = self.levels(rise, moved);
        if below.regions.is_empty() && above.regions.is_empty() {
            levels = 1;
        } else if links.plain() && groups.iter().all(|g| g.moved.is_none()) {
            field.blends.push(self.whole(gap, levels));
        } else {
            let special = |g: &&Group| g.moved.is_some();
            for group in groups.iter().filter(special) {
                field.blends.push(self.blend(gap, group, true));
            }
            let mut rest = Group::default();
            for group in groups.iter().filter(|g| !special(g)) {
                rest.below.extend(&group.below);
                rest.above.extend(&group.above);
            }
            if !rest.below.is_empty() {
                rest.below.sort_unstable();
                rest.above.sort_unstable();
                field.blends.push(self.blend(gap, &rest, false));
            }
            for &of in &links.ended {
                field.domes.extend(self.dome(self.end(gap, of, false, true)));
            }
            for &of in &links.begun {
                field.domes.extend(self.dome(self.end(gap + 1, of, false, false)));
            }
            for &of in &links.closed {
                field.pits.extend(self.dome(self.end(gap, of, true, true)));
            }
            for &of in &links.opened {
                field.pits.extend(self.dome(self.end(gap + 1, of, true, false)));
            }
        }
        self.climb(mesher, &field, heights, levels, above.bits.clone(), Some(&upper));
    }

    /// All of two layers as one.
    fn whole(&mut self, gap: usize, levels: usize) -> Blend {
        let before =
            gap.checked_sub(1).filter(|g| self.links[*g].plain() && !self.layers[*g].regions.is_empty());
        let behind = self.links.get(gap + 1).filter(|l| l.plain()).map(|_| gap + 2);
        let behind = behind.filter(|k| !self.layers[*k].regions.is_empty());
        let numbers = [before, Some(gap), Some(gap + 1), behind];
        // Without levels between, distances are asked for where the sign changes across the gap alone.
        let near: Vec<Rc<Plane>> = numbers.iter().flatten().map(|k| self.plane(*k)).collect();
        let (low, high) = (&self.layers[gap].bits, &self.layers[gap + 1].bits);
        let known = levels == 1
            && low.iter().zip(high).enumerate().all(|(w, (a, b))| {
                let mut differ = a ^ b;
                while differ != 0 {
                    let i = (w % self.grid.words) * 64 + differ.trailing_zeros() as usize;
                    differ &= differ - 1;
                    let node = w / self.grid.words * self.grid.size[0] + i;
                    if !near.iter().all(|p| p.knows(node)) {
                        return false;
                    }
                }
                true
            });
        drop(near);
        let planes = numbers.map(|k| k.map(|k| if known { self.plane(k) } else { self.complete(k) }));
        let all = Group {
            below: (0..self.layers[gap].regions.len() as u32).collect(),
            above: (0..self.layers[gap + 1].regions.len() as u32).collect(),
            moved: None,
        };
        let slopes = self.slopes(gap, &all);
        Blend::new(planes, self.heights(gap), None, self.bounds(gap)).with_slopes(slopes)
    }

    /// The box of nodes that the surface between two layers may reach.
    fn bounds(&self, gap: usize) -> [[usize; 2]; 2] {
        let boxes = self.layers[gap..gap + 2].iter().filter_map(|l| l.bounds);
        let [low, high] = boxes
            .reduce(|a, b| {
                [0, 1]
                    .map(|k| [0, 1].map(|n| if k == 0 { a[k][n].min(b[k][n]) } else { a[k][n].max(b[k][n]) }))
            })
            .unwrap_or([[1; 2]; 2]);
        let last = self.grid.size.map(|s| s - 2);
        [low.map(|v| v.saturating_sub(BULGE).max(1)), [0, 1].map(|a| (high[a] + BULGE).min(last[a]))]
    }

    /// Heights of the four layers around a gap.
    fn heights(&self, gap: usize) -> [f64; 4] {
        let at = |k: usize| self.layers.get(k).map_or(f64::NAN, |l| l.height);
        let before = gap.checked_sub(1).map_or(at(gap) - 1.0, at);
        let behind = if gap + 2 < self.layers.len() { at(gap + 2) } else { at(gap + 1) + 1.0 };
        [before, at(gap), at(gap + 1), behind]
    }

    /// Some linked regions.
    fn blend(&mut self, gap: usize, group: &Group, moving: bool) -> Blend {
        let links = &self.links[gap];
        let layers = self.layers;
        // What the regions go on as in the slice before and behind, if nothing else goes into that.
        let before = gap.checked_sub(1).and_then(|g| {
            let of: Vec<u32> =
                unique(self.links[g].pairs().filter(|p| group.below.contains(&p.1)).map(|p| p.0));
            let back = unique(self.links[g].pairs().filter(|p| of.contains(&p.0)).map(|p| p.1));
            (back == group.below).then_some((g, of))
        });
        let behind = self.links.get(gap + 1).and_then(|l| {
            let of: Vec<u32> = unique(l.pairs().filter(|p| group.above.contains(&p.0)).map(|p| p.1));
            let back = unique(l.pairs().filter(|p| of.contains(&p.1)).map(|p| p.0));
            (back == group.above).then_some((gap + 2, of))
        });
        let heights = self.heights(gap);
        let sets = [before, Some((gap, group.below.clone())), Some((gap + 1, group.above.clone())), behind];
        let mut centres = [[0.0; 2]; 4];
        for (centre, set) in centres.iter_mut().zip(&sets) {
            if let Some((layer, regions)) = set {
                *centre = centre_of(&layers[*layer], regions, self.grid);
            }
        }
        let filled = [&[][..], &links.closed, &links.opened, &[]];
        let mut planes = [const { None }; 4];
        for (k, set) in sets.iter().enumerate() {
            if let Some((layer, regions)) = set {
                planes[k] = Some(self.part(*layer, regions, filled[k]));
            }
        }
        let slopes = self.slopes(gap, group);
        Blend::new(planes, heights, moving.then_some(centres), self.bounds(gap)).with_slopes(slopes)
    }

    /// Slopes of the distance where all that a group has in a slice ends beyond it: those of its dome.
    fn slopes(&mut self, gap: usize, group: &Group) -> [Option<f64>; 2] {
        let end = |layer: usize, regions: &[u32], up: bool| match regions {
            [of] => Some(self.end(layer, *of, false, up)),
            _ => None,
        };
        let ends = [end(gap, &group.below, false), end(gap + 1, &group.above, true)];
        ends.map(|end| {
            let end = end.filter(|e| self.ends(*e))?;
            let trend = self.trend(end);
            let Close::Round(profile) = self.close(end, &trend) else { return None };
            let region = &self.layers[end.layer].regions[end.of as usize];
            let slope = profile.slope * region.area / region.perimeter / self.grid.cell;
            (!trend.before.is_empty()).then_some(if end.up { slope } else { -slope })
        })
    }

    /// An end at a layer, whether it is one or not.
    fn end(&self, layer: usize, of: u32, hole: bool, up: bool) -> End {
        let beyond =
            if up { Some(layer + 1).filter(|k| *k < self.layers.len()) } else { layer.checked_sub(1) };
        let seen = beyond.is_some();
        let limit =
            beyond.map_or(self.spacing(layer), |k| (self.layers[k].height - self.layers[layer].height).abs());
        End { layer, of, hole, up, limit, seen }
    }

    /// Whether it is an end.
    fn ends(&self, end: End) -> bool {
        let (above, below) =
            (self.links.get(end.layer), end.layer.checked_sub(1).and_then(|g| self.links.get(g)));
        match (end.hole, end.up) {
            (false, true) => above.is_none_or(|l| l.ended.contains(&end.of)),
            (false, false) => below.is_none_or(|l| l.begun.contains(&end.of)),
            (true, true) => above.is_some_and(|l| l.closed.contains(&end.of)),
            (true, false) => below.is_some_and(|l| l.opened.contains(&end.of)),
        }
    }

    /// Regions that are linked with each other, directly or through others.
    fn groups(&self, gap: usize) -> Vec<Group> {
        let links = &self.links[gap];
        let (below, above) = (&self.layers[gap], &self.layers[gap + 1]);
        let count = below.regions.len();
        let mut joined = Joined::new(count + above.regions.len());
        for (b, a) in links.pairs() {
            joined.join(b, count as u32 + a);
        }
        let mut groups: Vec<Group> = Vec::new();
        let mut place = vec![usize::MAX; count];
        for (b, a) in links.pairs() {
            let first = joined.first(b) as usize;
            if place[first] == usize::MAX {
                place[first] = groups.len();
                groups.push(Group::default());
            }
            let group = &mut groups[place[first]];
            group.below.push(b);
            group.above.push(a);
        }
        for group in &mut groups {
            group.below = unique(group.below.iter().copied());
            group.above = unique(group.above.iter().copied());
            group.moved = self.moves(gap, group);
        }
        groups
    }

    /// By how many cells a group moves, if its regions lie on each other better when moved.
    fn moves(&self, gap: usize, group: &Group) -> Option<f64> {
        let (below, above) = (&self.layers[gap], &self.layers[gap + 1]);
        let [from, to] =
            [centre_of(below, &group.below, self.grid), centre_of(above, &group.above, self.grid)];
        let off = [to[0] - from[0], to[1] - from[1]];
        let moved = off[0].hypot(off[1]);
        if moved < 1.0 {
            return None;
        }
        let pick = |runs: &[Run], set: &[u32]| -> Vec<Run> {
            runs.iter().filter(|r| set.contains(&r.of)).map(|r| Run { of: 0, ..*r }).collect()
        };
        let (low, high) = (pick(&below.runs, &group.below), pick(&above.runs, &group.above));
        let [i, j] = off.map(|v| v.round() as i64);
        let shifted: Vec<Run> = low
            .iter()
            .filter_map(|r| {
                let at = |v: u32, by: i64| u32::try_from(i64::from(v) + by).ok();
                Some(Run { row: at(r.row, j)?, from: at(r.from, i)?, to: at(r.to, i)?, of: 0 })
            })
            .collect();
        let shared = |a: &[Run]| overlaps(a, &high).first().map_or(0, |o| o.2);
        (f64::from(shared(&shifted)) > 1.02 * f64::from(shared(&low))).then_some(moved)
    }

    /// How an end closes.
    fn dome(&mut self, end: End) -> Option<Dome> {
        let layers = self.layers;
        let layer = &layers[end.layer];
        let (plane, runs) = if end.hole {
            let sides = layer.sides.iter().filter(|s| layer.of_contour[s.contour as usize].1 == Some(end.of));
            let runs: Vec<Run> = layer.hole_runs.iter().filter(|r| r.of == end.of).copied().collect();
            let mut plane = Plane::default();
            plane.near(self.grid, sides.copied(), &runs);
            plane.complete(self.grid);
            (Rc::new(plane), runs)
        } else {
            let runs = layer.runs.iter().filter(|r| r.of == end.of).copied().collect();
            (self.part(end.layer, &[end.of], &[]), runs)
        };
        let of = if end.hole { &layer.holes[end.of as usize] } else { &layer.regions[end.of as usize] };
        let (area, perimeter) = (of.area, of.perimeter);
        let trend = self.trend(end);
        let close = self.close(end, &trend);
        let trend = Trend { area, ..trend };
        Dome::over((&plane, &runs), (self.grid, layer, end.up), (&trend, perimeter), close)
    }

    /// How an end closes, by what the slices before it say.
    fn close(&self, end: End, trend: &Trend) -> Close {
        let expected = Profile::expected(trend);
        let goes_on = !end.seen && (self.layers[end.layer].cut_off || expected.height > end.limit);
        if self.caps == Caps::Shape && !goes_on {
            Close::Round(expected.within(end.limit))
        } else if self.ends(End { up: !end.up, ..end }) {
            // A slice alone is half as thick as its neighbours are away on both sides.
            Close::Flat(end.limit / 2.0)
        } else {
            Close::Flat(0.0)
        }
    }

    /// What the slices before an end say of its piece.
    fn trend(&mut self, end: End) -> Trend {
        let layers = self.layers;
        let height = layers[end.layer].height;
        let pick = |layer: usize, of: u32| {
            let list = if end.hole { &layers[layer].holes } else { &layers[layer].regions };
            list[of as usize].clone()
        };
        let last = pick(end.layer, end.of);
        let mut trend = Trend { area: last.area, ..Trend::default() };
        let (mut layer, mut of) = (end.layer, end.of);
        while trend.before.len() < 2 {
            let Some(gap) =
                (if end.up { layer.checked_sub(1) } else { (layer + 1 < layers.len()).then_some(layer) })
            else {
                break;
            };
            let next = if end.up { gap } else { gap + 1 };
            let found = match (end.hole, end.up) {
                (false, true) => self.links[gap].lone_below(of),
                (false, false) => self.links[gap].lone_above(of),
                (true, _) => {
                    let shared = overlaps(&layers[layer].hole_runs, &layers[next].hole_runs);
                    shared.iter().filter(|o| o.0 == of).max_by_key(|o| o.2).map(|o| o.1)
                }
            };
            let Some(found) = found else { break };
            let piece = pick(next, found);
            let away = (layers[next].height - height).abs();
            if trend.before.is_empty() {
                trend.drift = [0, 1].map(|k| (last.centroid[k] - piece.centroid[k]) / away);
            }
            trend.before.push((away, piece.area));
            (layer, of) = (next, found);
        }
        if trend.before.is_empty() && !end.hole {
            trend.before.extend(self.receding(end));
        }
        trend
    }

    /// For a piece that hangs together with others in the slice before: what its area would be there if it were alone, by how far its
    /// contour lies within the bone.
    fn receding(&mut self, end: End) -> Option<(f64, f64)> {
        let next = if end.up { end.layer.checked_sub(1)? } else { end.layer + 1 };
        let other = self.layers.get(next).filter(|l| !l.regions.is_empty())?;
        let layer = &self.layers[end.layer];
        let plane = self.complete(next);
        let mut grown = 0.0;
        for side in &layer.sides {
            if layer.of_contour[side.contour as usize].0 != Some(end.of) {
                continue;
            }
            let middle = [0, 1].map(|a| (side.from[a] + side.to[a]) / 2.0);
            let length = (side.to[0] - side.from[0]).hypot(side.to[1] - side.from[1]);
            let [x, y] = self.grid.in_cells(middle).map(|v| v as f32);
            grown -= f64::from(plane.between(self.grid, x, y)) * self.grid.cell * length;
        }
        let area = layer.regions[end.of as usize].area;
        let before = (area + grown).max(0.25 * area);
        Some(((other.height - layer.height).abs(), before))
    }
}

/// Linked regions of two layers.
#[derive(Debug, Clone, Default)]
struct Group {
    below: Vec<u32>,
    above: Vec<u32>,
    /// By how many cells it moves, where it is interpolated in coordinates that do.
    moved: Option<f64>,
}

fn unique(numbers: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut all: Vec<u32> = numbers.collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Centroid of some regions, cells.
fn centre_of(layer: &Layer, regions: &[u32], grid: &Grid) -> [f64; 2] {
    let (mut area, mut moment) = (0.0, [0.0; 2]);
    for r in regions {
        let region = &layer.regions[*r as usize];
        area += region.area;
        moment = [0, 1].map(|a| moment[a] + region.area * region.centroid[a]);
    }
    grid.in_cells(moment.map(|m| m / f64::max(area, f64::MIN_POSITIVE)))
}
