//! Which regions of neighbouring slices are the same piece of bone.
//!
//! Regions that overlap are linked. One that overlaps nothing may still go on, in a thin bone that runs obliquely: of such, the pair
//! whose centroids are nearest are linked, measured from where the one is expected by the way its piece had between the slices
//! before (or behind), within a stated reach of their mean width, if their areas differ by less than four times. Three that lie on a straight
//! line are linked over three times that reach. What has no
//! link then begins or ends. A hole ends where all of it is bone in the neighbouring slice.

use crate::layer::{Layer, Region, Run};

/// By what factor the areas of regions may differ that do not overlap and are linked.
const AREAS: f64 = 4.0;

/// How far off a straight line a third region may be, in mean widths, to show the way of two; and how far apart the two may be then, in
/// reaches.
const STRAIGHT: f64 = 0.4;
const STRAIGHT_REACH: f64 = 3.0;

/// The links from a slice to the one above.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Links {
    /// Regions below and above that overlap, and in how many nodes; ascending.
    pub overlaps: Vec<(u32, u32, u32)>,
    /// Regions below and above that do not overlap but belong together.
    pub reached: Vec<(u32, u32)>,
    /// Regions below that end.
    pub ended: Vec<u32>,
    /// Regions above that begin.
    pub begun: Vec<u32>,
    /// Holes below that end.
    pub closed: Vec<u32>,
    /// Holes above that begin.
    pub opened: Vec<u32>,
}

impl Links {
    /// The links of all neighbouring layers. `reach` counts in mean widths.
    pub fn of(layers: &[Layer], reach: f64) -> Vec<Self> {
        let mut all: Vec<Self> = layers.windows(2).map(|w| Self::overlapping(&w[0], &w[1])).collect();
        for gap in 0..all.len() {
            if all[gap].ended.is_empty() || all[gap].begun.is_empty() {
                continue;
            }
            let [below, above] = [&layers[gap], &layers[gap + 1]];
            let rise = above.height - below.height;
            let mut candidates = Vec::new();
            for &b in &all[gap].ended {
                for &a in &all[gap].begun {
                    let (low, high) = (&below.regions[b as usize], &above.regions[a as usize]);
                    if low.area > AREAS * high.area || high.area > AREAS * low.area {
                        continue;
                    }
                    let mean_width = (width(low) + width(high)) / 2.0;
                    let apart = |way: [f64; 2]| {
                        let off = |k: usize| high.centroid[k] - low.centroid[k] - way[k] * rise;
                        off(0).hypot(off(1)) / mean_width
                    };
                    let before =
                        gap.checked_sub(1).and_then(|g| all[g].lone_below(b).map(|p| way(layers, g, p, b)));
                    let behind =
                        all.get(gap + 1).and_then(|l| l.lone_above(a).map(|n| way(layers, gap + 1, a, n)));
                    let off = match [before, behind].into_iter().flatten().map(apart).reduce(f64::min) {
                        Some(off) => off,
                        // No way is known: near, or on a straight line with a third that has no link either.
                        None => {
                            let straight = third_ways(layers, &all, gap, (b, a))
                                .map(apart)
                                .fold(f64::INFINITY, f64::min);
                            let plain = apart([0.0; 2]);
                            if straight <= STRAIGHT && plain <= STRAIGHT_REACH * reach {
                                plain.min(reach)
                            } else {
                                plain
                            }
                        }
                    };
                    if off <= reach {
                        candidates.push((off, b, a));
                    }
                }
            }
            candidates.sort_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
            let links = &mut all[gap];
            for (_, b, a) in candidates {
                if links.ended.contains(&b) && links.begun.contains(&a) {
                    links.ended.retain(|r| *r != b);
                    links.begun.retain(|r| *r != a);
                    links.reached.push((b, a));
                }
            }
        }
        all
    }

    fn overlapping(below: &Layer, above: &Layer) -> Self {
        let overlaps = overlaps(&below.runs, &above.runs);
        let without = |count: usize, of: &dyn Fn(&(u32, u32, u32)) -> u32| {
            (0..count as u32).filter(|r| !overlaps.iter().any(|o| of(o) == *r)).collect::<Vec<_>>()
        };
        let ended = without(below.regions.len(), &|o| o.0);
        let begun = without(above.regions.len(), &|o| o.1);
        Self {
            ended,
            begun,
            closed: covered(below, above),
            opened: covered(above, below),
            overlaps,
            reached: Vec::new(),
        }
    }

    /// Pairs of regions that are linked, either way.
    pub fn pairs(&self) -> impl Iterator<Item = (u32, u32)> {
        self.overlaps.iter().map(|o| (o.0, o.1)).chain(self.reached.iter().copied())
    }

    /// The region below that is linked with the one above, where neither has another link.
    pub fn lone_below(&self, above: u32) -> Option<u32> {
        let mut linked = self.pairs().filter(|p| p.1 == above);
        let below = linked.next().filter(|_| linked.next().is_none())?.0;
        (self.pairs().filter(|p| p.0 == below).count() == 1).then_some(below)
    }

    /// The region above that is linked with the one below, where neither has another link.
    pub fn lone_above(&self, below: u32) -> Option<u32> {
        let mut linked = self.pairs().filter(|p| p.0 == below);
        let above = linked.next().filter(|_| linked.next().is_none())?.1;
        (self.pairs().filter(|p| p.1 == above).count() == 1).then_some(above)
    }

    /// Whether every region overlaps one of the other slice and no hole ends.
    pub fn plain(&self) -> bool {
        let special = [&self.ended, &self.begun, &self.closed, &self.opened];
        special.iter().all(|s| s.is_empty()) && self.reached.is_empty()
    }
}

/// The ways from the region below to others before it, and from others behind to the one above, that have no links and might be the same
/// piece of bone.
fn third_ways<'a>(
    layers: &'a [Layer],
    all: &'a [Links],
    gap: usize,
    (below, above): (u32, u32),
) -> impl Iterator<Item = [f64; 2]> + 'a {
    let alike = move |layer: usize, one: u32, other_layer: usize, other: u32| {
        let (p, q) = (&layers[layer].regions[one as usize], &layers[other_layer].regions[other as usize]);
        p.area < AREAS * q.area && q.area < AREAS * p.area
    };
    let before = gap.checked_sub(1).into_iter().flat_map(move |g| {
        let free =
            all[g].ended.iter().filter(move |p| all[g].begun.contains(&below) && alike(g, **p, gap, below));
        free.map(move |p| way(layers, g, *p, below))
    });
    let behind = all.get(gap + 1).into_iter().flat_map(move |l| {
        let free =
            l.begun.iter().filter(move |n| l.ended.contains(&above) && alike(gap + 2, **n, gap + 1, above));
        free.map(move |n| way(layers, gap + 1, above, *n))
    });
    before.chain(behind)
}

/// How far a region's centroid moves for each mm of height.
fn way(layers: &[Layer], gap: usize, below: u32, above: u32) -> [f64; 2] {
    let (low, high) = (&layers[gap], &layers[gap + 1]);
    let rise = high.height - low.height;
    let of = |l: &Layer, r: u32| l.regions[r as usize].centroid;
    [0, 1].map(|k| (of(high, above)[k] - of(low, below)[k]) / rise)
}

/// The diameter of a disc of the same area.
fn width(region: &Region) -> f64 {
    2.0 * (region.area / std::f64::consts::PI).sqrt()
}

/// Pairs of what two lists of runs, ordered by rows and columns, belong to, and how many nodes they share; ascending.
pub(crate) fn overlaps(first: &[Run], second: &[Run]) -> Vec<(u32, u32, u32)> {
    let mut found: Vec<(u32, u32, u32)> = Vec::new();
    let mut from = 0;
    for run in first {
        while second.get(from).is_some_and(|r| (r.row, r.to) <= (run.row, run.from)) {
            from += 1;
        }
        for other in second[from..].iter().take_while(|r| r.row == run.row && r.from < run.to) {
            let shared = run.to.min(other.to) - run.from.max(other.from);
            match found.last_mut() {
                Some(last) if (last.0, last.1) == (run.of, other.of) => last.2 += shared,
                _ => found.push((run.of, other.of, shared)),
            }
        }
    }
    found.sort_unstable();
    found.dedup_by(|next, kept| {
        let same = (next.0, next.1) == (kept.0, kept.1);
        if same {
            kept.2 += next.2;
        }
        same
    });
    found
}

/// Holes of a layer all of whose nodes are inside in another.
fn covered(layer: &Layer, other: &Layer) -> Vec<u32> {
    if layer.holes.is_empty() {
        return Vec::new();
    }
    let mut left = vec![0_u32; layer.holes.len()];
    for run in &layer.hole_runs {
        left[run.of as usize] += run.to - run.from;
    }
    for (hole, _, shared) in overlaps(&layer.hole_runs, &other.runs) {
        left[hole as usize] -= shared;
    }
    (0..left.len() as u32).filter(|h| left[*h as usize] == 0).collect()
}
