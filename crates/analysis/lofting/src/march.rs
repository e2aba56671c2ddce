//! The triangles between levels of the grid, level by level upwards.
//!
//! A vertex lies on each edge of the grid whose nodes are on different sides; the cells between two levels are filled from the table
//! of [`crate::cells`]. Signs are bits, so that 64 cells are looked at at once.

use biplane_geometry::Vector3;

use crate::cells::Cases;
use crate::layer::Grid;

/// Vertices and triangles so far.
#[derive(Debug)]
pub(crate) struct Mesher<'a> {
    grid: &'a Grid,
    cases: Cases,
    /// In the stack's frame, mm.
    pub vertices: Vec<Vector3>,
    /// Wound outward.
    pub triangles: Vec<[u32; 3]>,
    /// Vertices on the edges along rows and along columns, of the level below and of this one, and of those between them.
    along_row: [Vec<u32>; 2],
    along_column: [Vec<u32>; 2],
    upward: Vec<u32>,
    below: Level,
    /// The last two levels between which marks were set, and the vertices in them.
    cut: Vec<(f64, std::ops::Range<usize>)>,
    marked: Vec<u32>,
}

/// Which nodes are inside at a height.
#[derive(Debug, Clone, Default)]
pub(crate) struct Level {
    pub bits: Vec<u64>,
    /// mm.
    pub height: f64,
}

impl<'a> Mesher<'a> {
    /// Begins with a level on which all is outside.
    pub fn new(grid: &'a Grid, height: f64) -> Self {
        let ids = || vec![0; grid.nodes()];
        Self {
            grid,
            cases: Cases::new(),
            vertices: Vec::new(),
            triangles: Vec::new(),
            along_row: [ids(), ids()],
            along_column: [ids(), ids()],
            upward: ids(),
            below: Level { bits: vec![0; grid.words * grid.size[1]], height },
            cut: Vec::new(),
            marked: Vec::new(),
        }
    }

    /// Goes up to a level. `value` is the field at its nodes, `root` where the field changes its sign between the levels, at a node.
    pub fn rise(
        &mut self,
        level: Level,
        value: impl Fn(usize) -> f32,
        root: impl Fn(usize, [f64; 2]) -> f64,
    ) {
        let first = self.vertices.len();
        self.cut_level(&level, value);
        self.cut.push((level.height, first..self.vertices.len()));
        let heights = [self.below.height, level.height];
        let (columns, words) = (self.grid.size[0], self.grid.words);
        for (w, (a, b)) in self.below.bits.iter().zip(&level.bits).enumerate() {
            let mut differ = a ^ b;
            while differ != 0 {
                let i = (w % words) * 64 + differ.trailing_zeros() as usize;
                let j = w / words;
                differ &= differ - 1;
                let node = j * columns + i;
                self.upward[node] = self.vertices.len() as u32;
                let [x, y] = self.place(i as f64, j as f64);
                self.vertices.push(Vector3::new(x, y, root(node, heights)));
            }
        }
        self.fill(&level);
        self.along_row.swap(0, 1);
        self.along_column.swap(0, 1);
        self.below = level;
    }

    /// Marks vertices in the levels at two heights, of those since the last call and the one before, that lie where `rim` says, in cells.
    pub fn mark(&mut self, heights: [f64; 2], rim: impl Fn([f64; 2], f64) -> bool) {
        for (height, range) in self.cut.iter().filter(|c| heights.contains(&c.0)) {
            for v in range.clone() {
                let place = self.grid.in_cells([self.vertices[v].x, self.vertices[v].y]);
                if rim(place, *height) {
                    self.marked.push(v as u32);
                }
            }
        }
        self.cut.drain(..self.cut.len().saturating_sub(1));
    }

    /// Whether each vertex has been marked.
    pub fn rims(&self) -> Vec<bool> {
        let mut rims = vec![false; self.vertices.len()];
        self.marked.iter().for_each(|v| rims[*v as usize] = true);
        rims
    }

    fn place(&self, x: f64, y: f64) -> [f64; 2] {
        [self.grid.low[0] + self.grid.cell * x, self.grid.low[1] + self.grid.cell * y]
    }

    /// Vertices in a level.
    fn cut_level(&mut self, level: &Level, value: impl Fn(usize) -> f32) {
        let (columns, words) = (self.grid.size[0], self.grid.words);
        let share = |a: usize, b: usize| {
            let (a, b) = (f64::from(value(a)), f64::from(value(b)));
            let least = f64::from(crate::plane::LEAST);
            (a / (a - b)).clamp(least, 1.0 - least)
        };
        for j in 0..self.grid.size[1] {
            for w in 0..words {
                let at = j * words + w;
                let here = level.bits[at];
                let next = if w + 1 < words { level.bits[at + 1] } else { 0 };
                let mut differ = here ^ (here >> 1 | next << 63);
                while differ != 0 {
                    let i = w * 64 + differ.trailing_zeros() as usize;
                    differ &= differ - 1;
                    let node = j * columns + i;
                    self.along_row[1][node] = self.vertices.len() as u32;
                    let [x, y] = self.place(i as f64 + share(node, node + 1), j as f64);
                    self.vertices.push(Vector3::new(x, y, level.height));
                }
                let above = level.bits.get(at + words).copied().unwrap_or(0);
                let mut differ = here ^ above;
                while differ != 0 {
                    let i = w * 64 + differ.trailing_zeros() as usize;
                    differ &= differ - 1;
                    let node = j * columns + i;
                    self.along_column[1][node] = self.vertices.len() as u32;
                    let [x, y] = self.place(i as f64, j as f64 + share(node, node + columns));
                    self.vertices.push(Vector3::new(x, y, level.height));
                }
            }
        }
    }

    /// Triangles between the last level and this one.
    fn fill(&mut self, level: &Level) {
        let (columns, words) = (self.grid.size[0], self.grid.words);
        for j in 0..self.grid.size[1] - 1 {
            for w in 0..words {
                let at = j * words + w;
                let rows = [&self.below.bits, &level.bits].map(|bits| [bits[at], bits[at + words]]);
                let [[a, b], [c, d]] = rows;
                let next = |bits: &[u64], at: usize| if w + 1 < words { bits[at + 1] << 63 } else { 0 };
                let beside = [
                    a >> 1 | next(&self.below.bits, at),
                    b >> 1 | next(&self.below.bits, at + words),
                    c >> 1 | next(&level.bits, at),
                    d >> 1 | next(&level.bits, at + words),
                ];
                let any = a | b | c | d | beside[0] | beside[1] | beside[2] | beside[3];
                let all = a & b & c & d & beside[0] & beside[1] & beside[2] & beside[3];
                let mut mixed = any & !all;
                while mixed != 0 {
                    let bit = mixed.trailing_zeros();
                    mixed &= mixed - 1;
                    let corner = |word: u64| (word >> bit & 1) as u8;
                    let case = corner(a)
                        | corner(beside[0]) << 1
                        | corner(b) << 2
                        | corner(beside[1]) << 3
                        | corner(c) << 4
                        | corner(beside[2]) << 5
                        | corner(d) << 6
                        | corner(beside[3]) << 7;
                    let node = j * columns + w * 64 + bit as usize;
                    for triangle in self.cases.of(case) {
                        let vertex = |edge: u8| match edge {
                            0 => self.along_row[0][node],
                            1 => self.along_row[0][node + columns],
                            2 => self.along_row[1][node],
                            3 => self.along_row[1][node + columns],
                            4 => self.along_column[0][node],
                            5 => self.along_column[0][node + 1],
                            6 => self.along_column[1][node],
                            7 => self.along_column[1][node + 1],
                            8 => self.upward[node],
                            9 => self.upward[node + 1],
                            10 => self.upward[node + columns],
                            _ => self.upward[node + columns + 1],
                        };
                        self.triangles.push(triangle.map(vertex));
                    }
                }
            }
        }
    }
}
