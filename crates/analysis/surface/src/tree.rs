//! The triangles of a mesh in a tree of boxes with four children a node.
//!
//! Built from the top by the surface area heuristic over 16 bins (Wald, "On fast construction of SAH-based bounding volume
//! hierarchies", 2007), two halvings a node. A node holds the boxes of its four children side by side, in single precision and
//! rounded outward, in two lines of the cache; triangles lie in the order of the leaves.
//!
//! **Guaranteed:** every box holds its triangles, whatever the coordinates; the same tree on every run.

use biplane_geometry::{Mesh, Point3};

/// Most triangles of a leaf: two bits of a child's code.
const LEAF: usize = 4;
const BINS: usize = 16;
/// Halvings by area before they go by count: bounds the depth, and with it the stacks of all searches.
const BY_AREA: usize = 40;
/// Entries of a stack: each of at most `(BY_AREA + 32) / 2` nodes on the way down leaves three children behind.
pub(crate) const STACK: usize = 112;
/// Marks the code of a leaf.
const IS_LEAF: u32 = 1 << 31;
/// Largest coordinate in boxes: beyond it, squares overflow. Cutting off there brings nothing farther away.
const FARTHEST: f32 = 1e18;

/// The triangles of a mesh, for searches in space. It keeps all it needs of the mesh.
#[derive(Debug, Clone)]
pub struct Surface {
    pub(crate) nodes: Vec<Node>,
    /// Corners of the triangles, in the order of the leaves.
    pub(crate) corners: Vec<[Point3; 3]>,
    /// Their numbers in the mesh, and their vertices.
    pub(crate) numbers: Vec<u32>,
    pub(crate) vertices: Vec<[u32; 3]>,
    /// Triangles (in the order of the leaves) at each vertex: `at[start[v]..start[v + 1]]`.
    start: Vec<u32>,
    at: Vec<u32>,
    /// Where each triangle of the mesh lies in the order of the leaves.
    place: Vec<u32>,
}

/// Boxes of four children, by axis, and what they are: the number of a node or a run of triangles.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Node {
    pub low: [[f32; 4]; 3],
    pub high: [[f32; 4]; 3],
    pub child: [u32; 4],
}

/// What a child is.
pub(crate) enum Child {
    Node(u32),
    /// From and to, in the order of the leaves.
    Leaf(u32, u32),
}

/// A box in single precision.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Span {
    pub low: [f32; 3],
    pub high: [f32; 3],
}

/// A triangle while the tree is built.
#[derive(Clone, Copy)]
struct Item {
    span: Span,
    number: u32,
}

impl Node {
    /// No children: boxes that nothing meets.
    const EMPTY: Self =
        Self { low: [[f32::INFINITY; 4]; 3], high: [[f32::NEG_INFINITY; 4]; 3], child: [IS_LEAF; 4] };

    pub fn span(&self, child: usize) -> Span {
        Span { low: self.low.map(|l| l[child]), high: self.high.map(|h| h[child]) }
    }

    /// Children whose boxes meet another box.
    pub fn meets(&self, other: &Span) -> [bool; 4] {
        let mut meets = [true; 4];
        for axis in 0..3 {
            for (k, m) in meets.iter_mut().enumerate() {
                *m &= (self.low[axis][k] <= other.high[axis]) & (other.low[axis] <= self.high[axis][k]);
            }
        }
        meets
    }
}

/// What a child's code says.
pub(crate) fn child(code: u32) -> Child {
    if code & IS_LEAF == 0 {
        Child::Node(code)
    } else {
        let from = code & ((1 << 29) - 1);
        Child::Leaf(from, from + (code >> 29 & 3) + 1)
    }
}

impl Span {
    const EMPTY: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    /// The box of a triangle, rounded outward by at least a unit in the last place.
    pub fn of([a, b, c]: &[Point3; 3]) -> Self {
        let mut span = Self::EMPTY;
        for axis in 0..3 {
            let (low, high) = ends(a[axis], b[axis], c[axis]);
            let (low, high) = (low as f32, high as f32);
            span.low[axis] = (low - (low.abs() * f32::EPSILON + f32::MIN_POSITIVE)).max(-FARTHEST);
            span.high[axis] = (high + (high.abs() * f32::EPSILON + f32::MIN_POSITIVE)).min(FARTHEST);
        }
        span
    }

    fn add(&mut self, other: &Self) {
        // Not `min` and `max`, which look for numbers that are none.
        for axis in 0..3 {
            let (low, high) = (other.low[axis], other.high[axis]);
            self.low[axis] = if low < self.low[axis] { low } else { self.low[axis] };
            self.high[axis] = if high > self.high[axis] { high } else { self.high[axis] };
        }
    }

    /// Twice its middle.
    fn middle(&self, axis: usize) -> f32 {
        self.low[axis] + self.high[axis]
    }

    /// Half its surface.
    fn half_area(&self) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|a| (self.high[a] - self.low[a]).max(0.0));
        x * y + y * z + z * x
    }
}

/// The least and the largest of three numbers. Not by `min` and `max`, which look for numbers that are none.
pub(crate) fn ends(a: f64, b: f64, c: f64) -> (f64, f64) {
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    (if c < low { c } else { low }, if c > high { c } else { high })
}

/// A coordinate in single precision, cut off where boxes are.
pub(crate) fn cut(coordinate: f64) -> f32 {
    (coordinate as f32).clamp(-FARTHEST, FARTHEST)
}

impl Surface {
    /// Builds the tree of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        Self::of(mesh.vertices(), mesh.triangles())
    }

    /// Builds the tree of line segments, each as a triangle without width: closest points and distances alone make sense of it.
    /// `ends` are vertices of `points`; none if there is no segment or an end is not there.
    pub fn of_segments(points: &[Point3], ends: &[[u32; 2]]) -> Option<Self> {
        let there = |e: &[u32; 2]| e.iter().all(|&v| (v as usize) < points.len());
        let triangles: Vec<[u32; 3]> = ends.iter().map(|&[a, b]| [a, b, b]).collect();
        (!ends.is_empty() && ends.iter().all(there)).then(|| Self::of(points, &triangles))
    }

    /// At least one triangle, all with vertices that are there.
    fn of(points: &[Point3], triangles: &[[u32; 3]]) -> Self {
        let corners_of = |t: u32| triangles[t as usize].map(|v| points[v as usize]);
        let mut items: Vec<Item> = (0..triangles.len() as u32)
            .map(|number| Item { span: Span::of(&corners_of(number)), number })
            .collect();
        let mut builder = Builder { nodes: Vec::with_capacity(triangles.len() / 6 + 1) };
        builder.node(&mut items, 0, 0);
        let numbers: Vec<u32> = items.iter().map(|item| item.number).collect();
        let vertices: Vec<[u32; 3]> = numbers.iter().map(|&t| triangles[t as usize]).collect();
        let mut place = vec![0; triangles.len()];
        let mut start = vec![0_u32; points.len() + 1];
        for (k, &number) in numbers.iter().enumerate() {
            place[number as usize] = k as u32;
            for v in vertices[k] {
                start[v as usize + 1] += 1;
            }
        }
        for v in 1..start.len() {
            start[v] += start[v - 1];
        }
        let mut next = start.clone();
        let mut at = vec![0; triangles.len() * 3];
        for (k, corners) in vertices.iter().enumerate() {
            for &v in corners {
                at[next[v as usize] as usize] = k as u32;
                next[v as usize] += 1;
            }
        }
        let corners = numbers.iter().map(|&t| corners_of(t)).collect();
        Self { nodes: builder.nodes, corners, numbers, vertices, start, at, place }
    }

    /// How many triangles it has.
    pub fn triangles(&self) -> usize {
        self.numbers.len()
    }

    /// The corners of a triangle of the mesh, mm.
    pub fn corners(&self, triangle: u32) -> [Point3; 3] {
        self.corners[self.place[triangle as usize] as usize]
    }

    /// Where a triangle of the mesh lies in the order of the leaves; 0 if it has none of that number.
    pub(crate) fn place(&self, triangle: u32) -> u32 {
        self.place.get(triangle as usize).copied().unwrap_or(0)
    }

    /// Triangles at a vertex, in the order of the leaves.
    pub(crate) fn fan(&self, vertex: u32) -> &[u32] {
        &self.at[self.start[vertex as usize] as usize..self.start[vertex as usize + 1] as usize]
    }

    /// The other triangle at an edge of a triangle (in the order of the leaves), if it is the only one.
    pub(crate) fn across(&self, triangle: u32, ends: [u32; 2]) -> Option<u32> {
        let mut others = self
            .fan(ends[0])
            .iter()
            .filter(|&&t| t != triangle && self.vertices[t as usize].contains(&ends[1]));
        let first = others.next()?;
        others.next().is_none().then_some(*first)
    }
}

struct Builder {
    nodes: Vec<Node>,
}

impl Builder {
    /// Adds the node of some triangles, the first of which is `offset` in the order of the leaves; its number.
    fn node(&mut self, items: &mut [Item], offset: usize, depth: usize) -> u32 {
        let number = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        // Halved, and both halves again.
        let mut parts = [0, 0, 0, items.len()];
        parts[1] = halve(items, depth);
        let (first, second) = items.split_at_mut(parts[1]);
        parts[0] = halve(first, depth + 1);
        parts[2] = parts[1] + halve(second, depth + 1);
        let mut from = 0;
        for (k, to) in parts.into_iter().enumerate() {
            if from == to {
                continue;
            }
            let part = &mut items[from..to];
            let mut span = Span::EMPTY;
            for item in part.iter() {
                span.add(&item.span);
            }
            let code = if part.len() <= LEAF {
                IS_LEAF | (part.len() as u32 - 1) << 29 | (offset + from) as u32
            } else {
                self.node(part, offset + from, depth + 2)
            };
            let node = &mut self.nodes[number];
            for axis in 0..3 {
                node.low[axis][k] = span.low[axis];
                node.high[axis][k] = span.high[axis];
            }
            node.child[k] = code;
            from = to;
        }
        number as u32
    }
}

/// Sorts triangles into two halves, none of them empty unless few are left; how many are in the first.
fn halve(items: &mut [Item], depth: usize) -> usize {
    if items.len() <= LEAF {
        return items.len();
    }
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for item in items.iter() {
        for axis in 0..3 {
            low[axis] = low[axis].min(item.span.middle(axis));
            high[axis] = high[axis].max(item.span.middle(axis));
        }
    }
    let size = [0, 1, 2].map(|axis| high[axis] - low[axis]);
    let axis = if size[0] >= size[1] && size[0] >= size[2] { 0 } else { 1 + usize::from(size[2] > size[1]) };
    if size[axis] > 0.0 && depth < BY_AREA {
        let scale = BINS as f32 * 0.9999 / size[axis];
        let bin = |item: &Item| ((item.span.middle(axis) - low[axis]) * scale) as usize;
        let mut bins = [(Span::EMPTY, 0_usize); BINS];
        for item in items.iter() {
            let bin = &mut bins[bin(item).min(BINS - 1)];
            bin.0.add(&item.span);
            bin.1 += 1;
        }
        // Cost of all bins from each one on, then of those before it.
        let mut after = [0.0; BINS];
        let (mut span, mut count) = (Span::EMPTY, 0);
        for k in (1..BINS).rev() {
            span.add(&bins[k].0);
            count += bins[k].1;
            after[k] = span.half_area() * count as f32;
        }
        let (mut span, mut count) = (Span::EMPTY, 0);
        let mut best = (f32::INFINITY, 0);
        for k in 1..BINS {
            span.add(&bins[k - 1].0);
            count += bins[k - 1].1;
            let cost = span.half_area() * count as f32 + after[k];
            if cost < best.0 && count > 0 && count < items.len() {
                best = (cost, k);
            }
        }
        if best.1 > 0 {
            let mut first = 0;
            for k in 0..items.len() {
                if bin(&items[k]).min(BINS - 1) < best.1 {
                    items.swap(first, k);
                    first += 1;
                }
            }
            return first;
        }
    }
    let half = items.len() / 2;
    items.select_nth_unstable_by(half, |a, b| {
        a.span.middle(axis).total_cmp(&b.span.middle(axis)).then(a.number.cmp(&b.number))
    });
    half
}
