//! Boxes of planes: which triangles and creases can be on the rim seen from a source.
//!
//! A wedge looks at a source `s` where `n . s - d > 0`: a linear function of its plane `(n, d)`. Planes are sorted into boxes in these
//! four dimensions; where the function keeps its sign over a box, nothing in it is on the rim. So flat parts cost nothing, however
//! many triangles they have, and the cost of a smooth body grows with the length of its rim in edges: as the root of their number.
//!
//! **Guaranteed:** nothing that is on the rim is passed over: boxes are wider than rounding.

use biplane_geometry::Vector3;

use crate::rim::{Crease, Side, Triangle, Wedge};

/// Items in a leaf at most.
const LEAF: usize = 4;
/// Normals are this much farther apart than offsets in mm when boxes are cut: about a source's distance, by which they are multiplied.
const REACH_MM: f64 = 700.0;
/// By how much boxes are wider than what is in them, over their numbers' size.
const MARGIN: f64 = 1e-9;

/// What a leaf holds.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Item {
    Triangle(u32),
    Crease(u32),
}

/// A box of planes and what comes after it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    middle: [f64; 4],
    half: [f64; 4],
    /// Where the next node is that is not in this one.
    pub skip: u32,
    /// Number of its leaf, or [`Node::INNER`].
    pub leaf: u32,
}

impl Node {
    /// In place of a leaf.
    pub const INNER: u32 = u32::MAX;

    /// Whether planes of the box may look differently at a source (from the mesh's centroid).
    #[inline]
    pub fn may_differ(&self, s: &Vector3) -> bool {
        let [x, y, z, d] = self.middle;
        let [hx, hy, hz, hd] = self.half;
        let value = x * s.x + y * s.y + z * s.z - d;
        value.abs() <= hx * s.x.abs() + hy * s.y.abs() + hz * s.z.abs() + hd
    }
}

/// Triangles and creases of a leaf, and the slots of their planes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Leaf {
    pub slots: [u32; 2],
    pub triangles: [u32; 2],
    pub creases: [u32; 2],
}

/// The boxes, depth first.
#[derive(Debug, Clone, Default)]
pub(crate) struct Tree {
    pub nodes: Vec<Node>,
    pub leaves: Vec<Leaf>,
    /// The wedge of each slot.
    pub wedges: Vec<u32>,
    /// Its plane, a list for each number.
    planes: [Vec<f64>; 4],
}

impl Tree {
    /// Sorts triangles and creases into leaves, in whose order they are put, and makes their wedges slots.
    pub fn new(
        mut items: Vec<Item>,
        wedges: &mut Vec<Wedge>,
        triangles: &mut Vec<Triangle>,
        creases: &mut Vec<Crease>,
        sides: &mut [Side],
    ) -> Self {
        let plane = |w: u32| {
            let wedge = &wedges[w as usize];
            let n = wedge.normal;
            [n.x, n.y, n.z, n.dot(&wedge.at)]
        };
        let wedges_of = |item: &Item, found: &mut Vec<u32>| match *item {
            Item::Triangle(t) => found.extend(triangles[t as usize].slots),
            Item::Crease(c) => {
                let [from, to] = creases[c as usize].sides;
                found.extend(sides[from as usize..to as usize].iter().flat_map(|s| s.slots));
            }
        };
        let mut own = Vec::new();
        let boxes: Vec<[[f64; 4]; 2]> = items
            .iter()
            .map(|item| {
                own.clear();
                wedges_of(item, &mut own);
                let mut b = [[f64::INFINITY; 4], [f64::NEG_INFINITY; 4]];
                for w in &own {
                    for (k, v) in plane(*w).into_iter().enumerate() {
                        b[0][k] = b[0][k].min(v);
                        b[1][k] = b[1][k].max(v);
                    }
                }
                b
            })
            .collect();
        // Where the surface ends, an edge is on the rim whichever way its faces look.
        let always = |item: &Item| match *item {
            Item::Triangle(_) => false,
            Item::Crease(c) => {
                let [from, to] = creases[c as usize].sides;
                sides[from as usize..to as usize].iter().map(|s| s.sign).sum::<i32>() != 0
            }
        };
        let (ending, mut order): (Vec<u32>, Vec<u32>) =
            (0..items.len() as u32).partition(|i| always(&items[*i as usize]));
        let mut tree = Self::default();
        let mut ends = Vec::new();
        if !order.is_empty() {
            tree.split(&mut order, 0, &boxes, &mut ends);
        }
        for few in ending.chunks(LEAF) {
            let next = tree.nodes.len() as u32 + 1;
            tree.nodes.push(Node {
                middle: [0.0; 4],
                half: [0.0, 0.0, 0.0, f64::INFINITY],
                skip: next,
                leaf: ends.len() as u32,
            });
            order.extend(few);
            ends.push(order.len());
        }
        items = order.iter().map(|i| items[*i as usize]).collect();
        // In the order of the leaves, planes where they are used.
        let (old_triangles, old_creases) = (std::mem::take(triangles), std::mem::take(creases));
        let mut new_crease = vec![0_u32; old_creases.len()];
        let mut slot_of = vec![u32::MAX; wedges.len()];
        let mut from = 0;
        for to in ends {
            let (first_slot, first_triangle, first_crease) =
                (tree.wedges.len(), triangles.len(), creases.len());
            for item in &items[from..to] {
                // A wedge has one slot in each leaf that it is in.
                let mut slot = |w: u32| {
                    let last = &mut slot_of[w as usize];
                    if *last == u32::MAX || (*last as usize) < first_slot {
                        *last = tree.wedges.len() as u32;
                        tree.wedges.push(w);
                    }
                    *last
                };
                match *item {
                    Item::Triangle(t) => {
                        let mut triangle = old_triangles[t as usize];
                        triangle.slots = triangle.slots.map(&mut slot);
                        triangles.push(triangle);
                    }
                    Item::Crease(c) => {
                        let crease = old_creases[c as usize];
                        for side in &mut sides[crease.sides[0] as usize..crease.sides[1] as usize] {
                            side.slots = side.slots.map(&mut slot);
                        }
                        new_crease[c as usize] = creases.len() as u32;
                        creases.push(crease);
                    }
                }
            }
            let span = |first: usize, now: usize| [first as u32, now as u32];
            tree.leaves.push(Leaf {
                slots: span(first_slot, tree.wedges.len()),
                triangles: span(first_triangle, triangles.len()),
                creases: span(first_crease, creases.len()),
            });
            from = to;
        }
        let (mut number_of, mut numbered) = (vec![u32::MAX; 3 * triangles.len()], 0);
        for edge in triangles.iter_mut().flat_map(|t| &mut t.edges) {
            *edge = if *edge & Triangle::CREASE != 0 {
                Triangle::CREASE | new_crease[(*edge & !Triangle::CREASE) as usize]
            } else {
                let number = &mut number_of[*edge as usize];
                if *number == u32::MAX {
                    *number = numbered;
                    numbered += 1;
                }
                *number
            };
        }
        for &w in &tree.wedges {
            for (list, v) in tree.planes.iter_mut().zip(plane(w)) {
                list.push(v);
            }
        }
        // What is used together lies together.
        let mut place = vec![u32::MAX; wedges.len()];
        let mut sorted = Vec::with_capacity(wedges.len());
        for w in &mut tree.wedges {
            let place = &mut place[*w as usize];
            if *place == u32::MAX {
                *place = sorted.len() as u32;
                sorted.push(wedges[*w as usize]);
            }
            *w = *place;
        }
        *wedges = sorted;
        tree
    }

    /// Adds the node of `order`, which begins at `first` among all, and those below it; `ends` gets where each leaf ends.
    fn split(&mut self, order: &mut [u32], first: usize, boxes: &[[[f64; 4]; 2]], ends: &mut Vec<usize>) {
        let mut all = [[f64::INFINITY; 4], [f64::NEG_INFINITY; 4]];
        let mut middles = all;
        let middle = |i: u32, k: usize| boxes[i as usize][0][k] + boxes[i as usize][1][k];
        for &i in order.iter() {
            for k in 0..4 {
                all[0][k] = all[0][k].min(boxes[i as usize][0][k]);
                all[1][k] = all[1][k].max(boxes[i as usize][1][k]);
                middles[0][k] = middles[0][k].min(middle(i, k));
                middles[1][k] = middles[1][k].max(middle(i, k));
            }
        }
        let number = self.nodes.len();
        let margin = |k: usize| MARGIN * (all[0][k].abs() + all[1][k].abs() + if k < 3 { 1.0 } else { 0.0 });
        self.nodes.push(Node {
            middle: std::array::from_fn(|k| 0.5 * (all[0][k] + all[1][k])),
            half: std::array::from_fn(|k| 0.5 * (all[1][k] - all[0][k]) + margin(k)),
            skip: 0,
            leaf: Node::INNER,
        });
        if order.len() <= LEAF {
            self.nodes[number].leaf = ends.len() as u32;
            ends.push(first + order.len());
        } else {
            let reach = |k: usize| (middles[1][k] - middles[0][k]) * if k < 3 { REACH_MM } else { 1.0 };
            let axis = (0..4).max_by(|a, b| reach(*a).total_cmp(&reach(*b))).unwrap_or(0);
            let half = order.len() / 2;
            order.select_nth_unstable_by(half, |a, b| {
                middle(*a, axis).total_cmp(&middle(*b, axis)).then(a.cmp(b))
            });
            let (low, high) = order.split_at_mut(half);
            self.split(low, first, boxes, ends);
            self.split(high, first + half, boxes, ends);
        }
        self.nodes[number].skip = self.nodes.len() as u32;
    }

    /// `n . s - d` of all slots of a leaf.
    #[inline]
    pub fn values(&self, leaf: &Leaf, s: &Vector3, values: &mut Vec<f64>) {
        let span = leaf.slots[0] as usize..leaf.slots[1] as usize;
        let [x, y, z, d] = self.planes.each_ref().map(|list| &list[span.clone()]);
        values.clear();
        values.extend(x.iter().zip(y).zip(z).zip(d).map(|(((x, y), z), d)| x * s.x + y * s.y + z * s.z - d));
    }
}
