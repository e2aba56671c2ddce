//! The signed distance of a slice's nodes from what bounds the bone in it, in cells: negative inside.
//!
//! Within [`BAND`] cells of a side the distance is exact. Farther off, where a method asks for it, the number of the nearest side is
//! handed from node to node, forth and back over the rows (Danielsson, "Euclidean distance mapping", 1980): exact to a small
//! fraction of a cell. Signs are those of the layer's bits.

use crate::layer::{Grid, Run};
use crate::self_crossing::Side;

/// Distances are exact up to here, cells.
const BAND: f32 = 2.0;
/// Farther than any distance, cells.
const UNKNOWN: f32 = 1e9;
/// A node on the contour counts as this far from it, cells, so that no edge is cut at its end.
pub(crate) const LEAST: f32 = 1e-3;
/// No side.
const NONE: u32 = u32::MAX;

/// A side in cells.
#[derive(Debug, Clone, Copy)]
struct Line {
    from: [f32; 2],
    along: [f32; 2],
    /// One over the square of its length.
    inverse: f32,
}

impl Line {
    fn of(side: &Side, grid: &Grid) -> Self {
        let (a, b) = (grid.in_cells(side.from), grid.in_cells(side.to));
        let along = [b[0] - a[0], b[1] - a[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let inverse = if square > 1e-12 { 1.0 / square } else { 0.0 };
        Self { from: a.map(|v| v as f32), along: along.map(|v| v as f32), inverse: inverse as f32 }
    }

    #[inline]
    fn square(&self, x: f32, y: f32) -> f32 {
        let (px, py) = (x - self.from[0], y - self.from[1]);
        let t = ((px * self.along[0] + py * self.along[1]) * self.inverse).clamp(0.0, 1.0);
        let (rx, ry) = (px - t * self.along[0], py - t * self.along[1]);
        rx * rx + ry * ry
    }
}

/// Signed distances of the nodes of a slice, or of some regions of it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Plane {
    /// Cells.
    pub values: Vec<f32>,
    nearest: Vec<u32>,
    lines: Vec<Line>,
    /// Whether all nodes are known.
    whole: bool,
}

impl Plane {
    /// Distances near the sides; signs everywhere.
    pub fn near(&mut self, grid: &Grid, sides: impl Iterator<Item = Side>, runs: &[Run]) {
        self.lines.clear();
        self.lines.extend(sides.map(|s| Line::of(&s, grid)));
        self.values.clear();
        self.values.resize(grid.nodes(), UNKNOWN);
        self.nearest.clear();
        self.nearest.resize(grid.nodes(), NONE);
        self.whole = false;
        let [columns, rows] = grid.size;
        for (n, line) in self.lines.iter().enumerate() {
            let range = |a: usize, count: usize| {
                let (p, q) = (line.from[a], line.from[a] + line.along[a]);
                let low = (p.min(q) - BAND).ceil().max(0.0) as usize;
                let high = (p.max(q) + BAND).floor().max(0.0) as usize;
                low..(high + 1).min(count)
            };
            let across = range(0, columns);
            for j in range(1, rows) {
                let row = j * columns;
                let nodes = row + across.start..row + across.end.max(across.start);
                let values = self.values[nodes.clone()].iter_mut().zip(&mut self.nearest[nodes]);
                for (i, (value, nearest)) in across.clone().zip(values) {
                    let square = line.square(i as f32, j as f32);
                    if square < *value {
                        (*value, *nearest) = (square, n as u32);
                    }
                }
            }
        }
        for value in &mut self.values {
            *value = if *value <= BAND * BAND { value.sqrt().max(LEAST) } else { UNKNOWN };
        }
        for run in runs {
            let row = run.row as usize * columns;
            for value in &mut self.values[row + run.from as usize..row + run.to as usize] {
                *value = -*value;
            }
        }
    }

    /// Whether the distance of a node is known.
    #[inline]
    pub fn knows(&self, node: usize) -> bool {
        self.values[node].abs() < UNKNOWN
    }

    /// Finds the distances that are not known yet. Nodes of a plane without sides stay infinitely far outside.
    pub fn complete(&mut self, grid: &Grid) {
        if std::mem::replace(&mut self.whole, true) || self.lines.is_empty() {
            return;
        }
        let [columns, rows] = grid.size;
        // What is within the band keeps its side; the others are offered those of the neighbours visited before.
        let mut squares: Vec<f32> =
            self.values.iter().map(|v| if v.abs() < UNKNOWN { v * v } else { f32::INFINITY }).collect();
        let known = BAND * BAND;
        let mut offer = |node: usize, from: usize, i: usize, j: usize, nearest: &mut [u32]| {
            let side = nearest[from];
            if side != nearest[node] && side != NONE {
                let square = self.lines[side as usize].square(i as f32, j as f32);
                if square < squares[node] {
                    (squares[node], nearest[node]) = (square, side);
                }
            }
            squares[node] <= known
        };
        for v in 0..self.nearest.len() {
            if self.values[v].abs() >= UNKNOWN {
                self.nearest[v] = NONE;
            }
        }
        for backward in [false, true] {
            for step in 0..rows {
                let j = if backward { rows - 1 - step } else { step };
                let beside = if backward { (j + 1 < rows).then(|| j + 1) } else { j.checked_sub(1) };
                // From the row before, then along the row both ways.
                if let Some(before) = beside {
                    for i in 0..columns {
                        let node = j * columns + i;
                        if self.values[node].abs() < UNKNOWN {
                            continue;
                        }
                        let from = before * columns + i;
                        offer(node, from, i, j, &mut self.nearest);
                        if i > 0 {
                            offer(node, from - 1, i, j, &mut self.nearest);
                        }
                        if i + 1 < columns {
                            offer(node, from + 1, i, j, &mut self.nearest);
                        }
                    }
                }
                for i in 1..columns {
                    let node = j * columns + i;
                    if self.values[node].abs() >= UNKNOWN {
                        offer(node, node - 1, i, j, &mut self.nearest);
                    }
                }
                for i in (0..columns.saturating_sub(1)).rev() {
                    let node = j * columns + i;
                    if self.values[node].abs() >= UNKNOWN {
                        offer(node, node + 1, i, j, &mut self.nearest);
                    }
                }
            }
        }
        for (value, square) in self.values.iter_mut().zip(&squares) {
            if value.abs() >= UNKNOWN && square.is_finite() {
                *value = square.sqrt().copysign(*value);
            }
        }
    }

    /// The distance between nodes, bilinear; the border's value beyond it.
    pub fn between(&self, grid: &Grid, x: f32, y: f32) -> f32 {
        let [columns, rows] = grid.size;
        let (x, y) = (x.clamp(0.0, (columns - 1) as f32), y.clamp(0.0, (rows - 1) as f32));
        let (i, j) = ((x as usize).min(columns - 2), (y as usize).min(rows - 2));
        let (s, t) = (x - i as f32, y - j as f32);
        let node = j * columns + i;
        let low = self.values[node] * (1.0 - s) + self.values[node + 1] * s;
        let high = self.values[node + columns] * (1.0 - s) + self.values[node + columns + 1] * s;
        low * (1.0 - t) + high * t
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_what_trying_all_sides_gives() {
        let grid = Grid { low: [-20.0, -15.0], cell: 0.5, size: [83, 64], words: 2 };
        let point = |n: usize| {
            let a = n as f64 / 70.0 * std::f64::consts::TAU;
            let r = 7.0 + 3.0 * (3.0 * a).sin();
            [1.5 * r * a.cos(), r * a.sin()]
        };
        let sides: Vec<Side> =
            (0..70).map(|n| Side { from: point(n), to: point(n + 1), contour: 0 }).collect();
        let mut plane = Plane::default();
        plane.near(&grid, sides.iter().copied(), &[]);
        plane.complete(&grid);
        let mut worst = 0.0_f32;
        for node in 0..grid.nodes() {
            let at = [(node % grid.size[0]) as f32, (node / grid.size[0]) as f32];
            let truth = sides
                .iter()
                .map(|s| Line::of(s, &grid).square(at[0], at[1]))
                .fold(f32::INFINITY, f32::min)
                .sqrt();
            worst = worst.max((plane.values[node] - truth.max(LEAST)).abs());
        }
        assert!(worst < 0.02, "{worst} cells");
    }
}
