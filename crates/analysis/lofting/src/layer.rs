//! A slice on the grid: which nodes are inside, and to which piece of bone or hole they belong.
//!
//! A node is inside where the winding number of all contours is not zero, decided row by row from where the contours cross the
//! row. Nodes inside lie in runs; a run belongs to the **region** whose contour it was entered through, and contours that overlap
//! make one region. Runs outside but within a contour belong to a **hole**.

use crate::self_crossing::{Side, bounding, crossings, sides, turn};
use crate::stack::{Contour, Slice};

/// The nodes of all slices: node `(i, j)` lies at `low + cell (i, j)` in the plane.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Grid {
    /// Place of the first node, mm.
    pub low: [f64; 2],
    /// Distance of neighbouring nodes, mm.
    pub cell: f64,
    /// Nodes along each axis.
    pub size: [usize; 2],
    /// Words of 64 nodes in a row of bits.
    pub words: usize,
}

impl Grid {
    pub fn nodes(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// A place counted in cells.
    pub fn in_cells(&self, p: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|a| (p[a] - self.low[a]) / self.cell)
    }
}

/// Neighbouring nodes of a row: `from` up to but without `to`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Run {
    pub row: u32,
    pub from: u32,
    pub to: u32,
    /// Number of the region, or of the hole.
    pub of: u32,
}

/// A connected piece of bone in a slice.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Region {
    /// mm^2.
    pub area: f64,
    pub perimeter: f64,
    /// mm.
    pub centroid: [f64; 2],
}

/// Contours that are smaller than a cell of the grid.
#[derive(Debug, Clone, Default)]
pub(crate) struct LeftOut {
    count: usize,
    /// Area, slice and number of the largest.
    largest: (f64, usize, usize),
}

impl LeftOut {
    fn add(&mut self, slice: usize, contour: &Contour) {
        let area = contour.area.abs();
        if self.count == 0 || area > self.largest.0 {
            self.largest = (area, slice, contour.number);
        }
        self.count += 1;
    }

    /// As a person reads it, if there are any.
    pub fn said(&self, grid: &Grid) -> Option<String> {
        let Self { count, largest: (area, slice, contour) } = self;
        (*count > 0).then(|| {
            format!(
                "{count} contours smaller than a cell of the grid ({:.2} mm) are left out; the largest has {area:.2} mm^2: slice {slice}, contour {contour}",
                grid.cell
            )
        })
    }
}

/// What a contour parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Bone within from what is around.
    Outer,
    /// A hole within from bone around.
    Hole,
    /// Nothing: bone lies on both sides.
    Nothing,
}

/// A slice on the grid.
#[derive(Debug, Clone, Default)]
pub(crate) struct Layer {
    /// Along the normal, mm.
    pub height: f64,
    pub cut_off: bool,
    /// What bounds the bone.
    pub sides: Vec<Side>,
    /// One bit a node: inside.
    pub bits: Vec<u64>,
    /// Inside, in order of rows and columns.
    pub runs: Vec<Run>,
    /// In holes, in the same order.
    pub hole_runs: Vec<Run>,
    pub regions: Vec<Region>,
    /// Holes by number, as regions.
    pub holes: Vec<Region>,
    /// For each contour the region on its side, and its hole where it is one.
    pub of_contour: Vec<(Option<u32>, Option<u32>)>,
    /// First and last node of the box around what is inside, if anything is.
    pub bounds: Option<[[usize; 2]; 2]>,
}

/// Where a contour crosses a row.
#[derive(Clone, Copy)]
struct Pass {
    row: u32,
    at: f64,
    turn: i32,
    contour: u32,
}

impl Layer {
    /// What a person should know is added to `warnings`, what is too small for the grid to `left_out`.
    pub fn of(slice: &Slice, grid: &Grid, warnings: &mut Vec<String>, left_out: &mut LeftOut) -> Self {
        let contours = &slice.contours;
        let all = sides(contours);
        let crossed = crossings(&all);
        if let Some(first) = crossed.first() {
            let [a, b] = first.sides.map(|s| contours[all[s].contour as usize].number);
            let pairs = crossed.len();
            warnings.push(if a == b {
                format!("slice {}: contour {a} crosses itself ({pairs} crossings in the slice); inside is what it winds about", slice.number)
            } else {
                format!("slice {}: contours {a} and {b} cross ({pairs} crossings in the slice); they are joined", slice.number)
            });
        }
        let mut layer = Self {
            height: slice.height,
            cut_off: slice.cut_off,
            bits: vec![0; grid.words * grid.size[1]],
            of_contour: vec![(None, None); contours.len()],
            ..Self::default()
        };
        let parents = parents(contours);
        let kinds = kinds(contours, &parents);
        let mut regions = Joined::new(contours.len());
        layer.scan(&passes(contours, grid), grid, (&kinds, &parents), &mut regions);
        layer.number_regions(contours, (&kinds, &parents), &mut regions, grid);
        let bounding = if crossed.is_empty() { all } else { bounding(&all, &crossed) };
        layer.sides = bounding
            .into_iter()
            .filter(|s| {
                let c = s.contour as usize;
                kinds[c] != Kind::Nothing || !crossed.is_empty()
            })
            .filter(|s| layer.of_contour[s.contour as usize] != (None, None))
            .collect();
        for (c, contour) in contours.iter().enumerate() {
            if kinds[c] == Kind::Nothing {
                warnings.push(format!(
                    "slice {}: contour {} lies in another of the same sense and changes nothing",
                    slice.number, contour.number
                ));
            } else if layer.of_contour[c] == (None, None) {
                left_out.add(slice.number, contour);
            }
        }
        layer
    }

    /// Finds the runs. Their regions are numbers of contours for now.
    fn scan(
        &mut self,
        passes: &[Pass],
        grid: &Grid,
        (kinds, parents): (&[Kind], &[Option<u32>]),
        regions: &mut Joined,
    ) {
        let last = grid.size[0] as u32 - 1;
        let node = |x: f64| (x.ceil().max(1.0) as u32).min(last);
        let around = |c: u32| if kinds[c as usize] == Kind::Hole { parents[c as usize] } else { Some(c) };
        let hole_beyond = |c: u32| {
            let outer = parents[c as usize].filter(|p| kinds[*p as usize] == Kind::Hole);
            if kinds[c as usize] == Kind::Hole { Some(c) } else { outer }
        };
        let mut row = u32::MAX;
        let (mut wound, mut from, mut entered): (i32, f64, Option<u32>) = (0, 0.0, None);
        for pass in passes {
            if pass.row != row {
                (row, wound, entered) = (pass.row, 0, None);
            }
            let before = wound;
            wound += pass.turn;
            match (before != 0, wound != 0) {
                (false, true) => {
                    let (a, b) = (node(from), node(pass.at));
                    if let Some(of) = entered.and_then(hole_beyond).filter(|_| b > a) {
                        self.hole_runs.push(Run { row, from: a, to: b, of });
                    }
                    from = pass.at;
                    entered = Some(pass.contour);
                }
                (true, false) => {
                    let (a, b) = (node(from), node(pass.at));
                    if let Some(of) = entered.and_then(around).filter(|_| b > a) {
                        self.runs.push(Run { row, from: a, to: b, of });
                        for i in a..b {
                            self.bits[row as usize * grid.words + i as usize / 64] |= 1 << (i % 64);
                        }
                        let [low, high] = self.bounds.get_or_insert([[usize::MAX; 2], [0; 2]]);
                        *low = [low[0].min(a as usize), low[1].min(row as usize)];
                        *high = [high[0].max(b as usize - 1), high[1].max(row as usize)];
                    }
                    // Left by another contour than entered, both sides of it are one region.
                    if let (Some(a), Some(b)) = (entered.and_then(around), around(pass.contour)) {
                        regions.join(a, b);
                    }
                    from = pass.at;
                    entered = Some(pass.contour);
                }
                (true, true) => {
                    if let (Some(a), Some(b)) = (entered.and_then(around), around(pass.contour)) {
                        regions.join(a, b);
                    }
                }
                (false, false) => {}
            }
        }
    }

    /// Numbers regions and holes from 0 in the order of their first runs, and measures them.
    fn number_regions(
        &mut self,
        contours: &[Contour],
        (kinds, parents): (&[Kind], &[Option<u32>]),
        joined: &mut Joined,
        grid: &Grid,
    ) {
        let mut number = vec![None; contours.len()];
        let mut moments: Vec<[f64; 3]> = Vec::new();
        for run in &mut self.runs {
            let first = joined.first(run.of) as usize;
            let of = *number[first].get_or_insert_with(|| {
                moments.push([0.0; 3]);
                moments.len() as u32 - 1
            });
            run.of = of;
            add(&mut moments[of as usize], run);
        }
        self.regions = moments.iter().map(|m| measured(m, grid)).collect();
        let mut hole_number = vec![None; contours.len()];
        moments.clear();
        for run in &mut self.hole_runs {
            let of = *hole_number[run.of as usize].get_or_insert_with(|| {
                moments.push([0.0; 3]);
                moments.len() as u32 - 1
            });
            run.of = of;
            add(&mut moments[of as usize], run);
        }
        self.holes = moments.iter().map(|m| measured(m, grid)).collect();
        // Areas and centroids from the contours themselves, where these do not overlap: then each is of one kind.
        let mut exact: Vec<[f64; 3]> = vec![[0.0; 3]; self.regions.len()];
        for (c, contour) in contours.iter().enumerate() {
            let around = if kinds[c] == Kind::Hole { parents[c] } else { Some(c as u32) };
            let region = around.and_then(|a| number[joined.first(a) as usize]);
            let hole = hole_number[c];
            // A hole too small to have a node is no part of the region either.
            self.of_contour[c] = match kinds[c] {
                Kind::Hole if hole.is_none() => (None, None),
                _ => (region, hole),
            };
            let area = contour.area.abs();
            if let (Some(r), false) = (self.of_contour[c].0, kinds[c] == Kind::Nothing) {
                let signed = if kinds[c] == Kind::Hole { -area } else { area };
                let sum = &mut exact[r as usize];
                *sum = [
                    sum[0] + signed,
                    sum[1] + signed * contour.centroid[0],
                    sum[2] + signed * contour.centroid[1],
                ];
                self.regions[r as usize].perimeter += contour.perimeter;
            }
            if let Some(h) = hole {
                let of = &mut self.holes[h as usize];
                of.perimeter += contour.perimeter;
                if area > 0.5 * of.area && area < 2.0 * of.area {
                    (of.area, of.centroid) = (area, contour.centroid);
                }
            }
        }
        let slack = 4.0 * grid.cell * grid.cell;
        for (region, sum) in self.regions.iter_mut().zip(exact) {
            if sum[0] > 0.8 * region.area - slack && sum[0] < 1.25 * region.area + slack && sum[0] > 0.0 {
                (region.area, region.centroid) = (sum[0], [sum[1] / sum[0], sum[2] / sum[0]]);
            }
        }
    }
}

fn add(moment: &mut [f64; 3], run: &Run) {
    let (count, sum) = (f64::from(run.to - run.from), f64::from(run.from + run.to - 1) / 2.0);
    *moment = [moment[0] + count, moment[1] + count * sum, moment[2] + count * f64::from(run.row)];
}

fn measured(&[count, x, y]: &[f64; 3], grid: &Grid) -> Region {
    let centroid = [grid.low[0] + grid.cell * x / count, grid.low[1] + grid.cell * y / count];
    Region { area: count * grid.cell * grid.cell, perimeter: 0.0, centroid }
}

/// Where the contours cross the rows, row by row from left to right.
fn passes(contours: &[Contour], grid: &Grid) -> Vec<Pass> {
    let mut found = Vec::new();
    for (c, contour) in contours.iter().enumerate() {
        let Some(mut p) = contour.points.last().map(|p| grid.in_cells(*p)) else { continue };
        for q in &contour.points {
            let q = grid.in_cells(*q);
            // Rows y with p <= y < q or q <= y < p.
            let (low, high, turn) = if p[1] < q[1] { (p[1], q[1], 1) } else { (q[1], p[1], -1) };
            let (mut y, end) = (low.ceil().max(1.0), high.ceil().min((grid.size[1] - 1) as f64));
            if y < end {
                let slope = (q[0] - p[0]) / (q[1] - p[1]);
                while y < end {
                    let at = p[0] + (y - p[1]) * slope;
                    found.push(Pass { row: y as u32, at, turn, contour: c as u32 });
                    y += 1.0;
                }
            }
            p = q;
        }
    }
    found.sort_unstable_by(|a, b| {
        a.row
            .cmp(&b.row)
            .then(a.at.total_cmp(&b.at))
            .then(a.contour.cmp(&b.contour))
            .then(b.turn.cmp(&a.turn))
    });
    found
}

/// For each contour the smallest one around it.
fn parents(contours: &[Contour]) -> Vec<Option<u32>> {
    let within = |inner: &Contour, outer: &Contour| {
        let boxed = (0..2).all(|a| outer.low[a] <= inner.low[a] && inner.high[a] <= outer.high[a]);
        if !boxed {
            return false;
        }
        // A contour may touch another one: most of three of its points decide.
        let n = inner.points.len();
        let inside = |k: usize| {
            let [x, y] = inner.points[k];
            let sides = outer.points.iter().zip(outer.points.iter().cycle().skip(1));
            sides.map(|(p, q)| turn(*p, *q, x, y)).sum::<i32>() != 0
        };
        [0, n / 3, 2 * n / 3].into_iter().filter(|k| inside(*k)).count() >= 2
    };
    let larger = |a: usize, b: usize| (contours[a].area.abs(), b) > (contours[b].area.abs(), a);
    (0..contours.len())
        .map(|c| {
            let around =
                (0..contours.len()).filter(|&o| o != c && larger(o, c) && within(&contours[c], &contours[o]));
            around.reduce(|a, b| if larger(a, b) { b } else { a }).map(|o| o as u32)
        })
        .collect()
}

fn kinds(contours: &[Contour], parents: &[Option<u32>]) -> Vec<Kind> {
    (0..contours.len())
        .map(|c| {
            let own = if contours[c].area < 0.0 { -1 } else { 1 };
            let (mut around, mut at) = (0, parents[c]);
            while let Some(p) = at {
                around += if contours[p as usize].area < 0.0 { -1 } else { 1 };
                at = parents[p as usize];
            }
            match (around, around + own) {
                (0, _) => Kind::Outer,
                (_, 0) => Kind::Hole,
                _ => Kind::Nothing,
            }
        })
        .collect()
}

/// Sets that are joined two by two, each known by its smallest member.
pub(crate) struct Joined(Vec<u32>);

impl Joined {
    pub fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    pub fn first(&mut self, mut member: u32) -> u32 {
        while self.0[member as usize] != member {
            let above = self.0[self.0[member as usize] as usize];
            self.0[member as usize] = above;
            member = above;
        }
        member
    }

    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.first(a), self.first(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
