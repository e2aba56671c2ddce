//! The voxels that have the label: their pieces, and the hollows in them.
//!
//! Voxels that touch, be it by a corner, are one piece (26 neighbours); a hollow is a set of other voxels from which no way leads
//! out through faces (6 neighbours), beyond the border of the volume included.

use biplane_artifact::Volume;

use crate::stack::Stack;

/// A box of voxels and which of them are inside.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Mask {
    /// First voxel of the box along the axes.
    pub low: [usize; 3],
    /// How many voxels there are along each axis.
    pub size: [usize; 3],
    /// 1 inside, 0 outside; rows run fastest.
    pub inside: Vec<u8>,
}

/// A piece of a label, or a hollow in it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Piece {
    pub voxels: usize,
    /// Sum of the voxels' volumes, mm^3.
    pub volume_mm3: f64,
    /// First and last slice it is in.
    pub slices: [usize; 2],
}

impl Mask {
    /// The smallest box that holds all voxels of a label; none where there are none.
    pub fn of(volume: &Volume, stack: &Stack, label: u32) -> Option<Self> {
        let wanted = label as f32;
        let [columns, rows, _] = stack.size;
        let (mut low, mut high) = ([usize::MAX; 3], [0; 3]);
        for (line, samples) in volume.samples.chunks_exact(columns).enumerate() {
            let Some(first) = samples.iter().position(|s| *s == wanted) else { continue };
            let last = samples.iter().rposition(|s| *s == wanted).unwrap_or(first);
            for (axis, [from, to]) in
                [[first, last], [line % rows; 2], [line / rows; 2]].into_iter().enumerate()
            {
                low[axis] = low[axis].min(from);
                high[axis] = high[axis].max(to + 1);
            }
        }
        if high[0] == 0 {
            return None;
        }
        let size: [usize; 3] = std::array::from_fn(|a| high[a] - low[a]);
        let mut inside = Vec::with_capacity(size.iter().product());
        for k in low[2]..high[2] {
            for j in low[1]..high[1] {
                let at = (k * rows + j) * columns;
                inside
                    .extend(volume.samples[at + low[0]..at + high[0]].iter().map(|s| u8::from(*s == wanted)));
            }
        }
        Some(Self { low, size, inside })
    }

    fn place(&self, index: usize) -> [usize; 3] {
        let [columns, rows, _] = self.size;
        [index % columns, index / columns % rows, index / (columns * rows)]
    }

    /// Calls `each` with every neighbour across faces, or across edges and corners too.
    fn neighbours(&self, index: usize, faces_only: bool, mut each: impl FnMut(usize)) {
        let place = self.place(index);
        let [from, to]: [[usize; 3]; 2] = [
            place.map(|p| p.saturating_sub(1)),
            std::array::from_fn(|a| (place[a] + 1).min(self.size[a] - 1)),
        ];
        for k in from[2]..=to[2] {
            for j in from[1]..=to[1] {
                for i in from[0]..=to[0] {
                    let off =
                        usize::from(i != place[0]) + usize::from(j != place[1]) + usize::from(k != place[2]);
                    if off == 1 || (off > 1 && !faces_only) {
                        each((k * self.size[1] + j) * self.size[0] + i);
                    }
                }
            }
        }
    }

    /// The voxels that hang together with `start` and have its value; each is marked in `seen`.
    fn flood(&self, start: usize, faces_only: bool, seen: &mut [bool]) -> Vec<u32> {
        let value = self.inside[start];
        let mut found = vec![start as u32];
        seen[start] = true;
        let mut next = 0;
        while let Some(&index) = found.get(next) {
            next += 1;
            self.neighbours(index as usize, faces_only, |n| {
                if !seen[n] && self.inside[n] == value {
                    seen[n] = true;
                    found.push(n as u32);
                }
            });
        }
        found
    }

    fn piece(&self, stack: &Stack, voxels: &[u32]) -> Piece {
        let (mut volume_mm3, mut slices) = (0.0, [usize::MAX, 0]);
        for &voxel in voxels {
            let slice = self.low[2] + self.place(voxel as usize)[2];
            volume_mm3 += stack.voxel_mm3(slice);
            slices = [slices[0].min(slice), slices[1].max(slice)];
        }
        Piece { voxels: voxels.len(), volume_mm3, slices }
    }

    /// Leaves only the piece of the most voxels, of equal ones the first; says which others there were, in the order of their
    /// first voxels.
    pub fn keep_largest(&mut self, stack: &Stack) -> Vec<Piece> {
        let pieces = self.pieces();
        let most = pieces.iter().map(Vec::len).max().unwrap_or(0);
        let kept = pieces.iter().position(|p| p.len() == most).unwrap_or(0);
        let mut others = Vec::new();
        for (_, voxels) in pieces.iter().enumerate().filter(|(n, _)| *n != kept) {
            others.push(self.piece(stack, voxels));
            voxels.iter().for_each(|v| self.inside[*v as usize] = 0);
        }
        others
    }

    /// All pieces, in the order of their first voxels.
    fn pieces(&self) -> Vec<Vec<u32>> {
        let mut seen = vec![false; self.inside.len()];
        let mut pieces = Vec::new();
        for start in 0..self.inside.len() {
            if self.inside[start] == 1 && !seen[start] {
                pieces.push(self.flood(start, false, &mut seen));
            }
        }
        pieces
    }

    /// All pieces as they are, in the order of their first voxels.
    pub fn listed(&self, stack: &Stack) -> Vec<Piece> {
        self.pieces().iter().map(|voxels| self.piece(stack, voxels)).collect()
    }

    /// Finds the hollows, and fills them if `fill`.
    pub fn hollows(&mut self, stack: &Stack, fill: bool) -> Vec<Piece> {
        let mut seen = vec![false; self.inside.len()];
        let mut hollows = Vec::new();
        for start in 0..self.inside.len() {
            if self.inside[start] == 1 || seen[start] {
                continue;
            }
            let voxels = self.flood(start, true, &mut seen);
            let out = voxels.iter().any(|v| {
                let place = self.place(*v as usize);
                (0..3).any(|a| place[a] == 0 || place[a] + 1 == self.size[a])
            });
            if !out {
                hollows.push(self.piece(stack, &voxels));
                if fill {
                    voxels.iter().for_each(|v| self.inside[*v as usize] = 1);
                }
            }
        }
        hollows
    }

    /// Sum of the volumes of the voxels inside, mm^3.
    pub fn volume_mm3(&self, stack: &Stack) -> f64 {
        let slices = self.inside.chunks_exact(self.size[0] * self.size[1]);
        let count = |s: &[u8]| s.iter().map(|v| u64::from(*v)).sum::<u64>() as f64;
        slices.enumerate().map(|(k, s)| count(s) * stack.voxel_mm3(self.low[2] + k)).sum()
    }

    /// How many slices have a voxel inside.
    pub fn slices(&self) -> usize {
        self.inside.chunks_exact(self.size[0] * self.size[1]).filter(|s| s.contains(&1)).count()
    }

    /// Along each axis, whether a voxel inside is in the first and in the last place of the volume.
    pub fn touches(&self, stack: &Stack) -> [[bool; 2]; 3] {
        let mut touches = [[false; 2]; 3];
        for index in (0..self.inside.len()).filter(|n| self.inside[*n] == 1) {
            let place = self.place(index);
            for a in 0..3 {
                touches[a][0] |= self.low[a] + place[a] == 0;
                touches[a][1] |= self.low[a] + place[a] + 1 == stack.size[a];
            }
        }
        touches
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A volume of 1 x 1 x 2 mm voxels with label 3 where `inside`.
    fn volume(size: [usize; 3], inside: impl Fn([usize; 3]) -> bool) -> Volume {
        let mut samples = Vec::new();
        for k in 0..size[2] {
            for j in 0..size[1] {
                samples.extend((0..size[0]).map(|i| if inside([i, j, k]) { 3.0 } else { 1.0 }));
            }
        }
        Volume {
            columns: size[0],
            rows: size[1],
            column_step_mm: [1.0, 0.0, 0.0],
            row_step_mm: [0.0, 1.0, 0.0],
            origins_mm: (0..size[2]).map(|k| [0.0, 0.0, 2.0 * k as f64]).collect(),
            samples,
        }
    }

    #[test]
    fn pieces_and_hollows_are_found_with_their_slices() {
        // A shell of 5 x 5 x 5 around one voxel of nothing, a voxel that touches it by a corner, and one far away.
        let shell = |p: [usize; 3]| p.iter().all(|v| (1..6).contains(v)) && p != [3, 3, 3];
        let at = |p: [usize; 3]| shell(p) || p == [6, 6, 6] || p == [9, 0, 8];
        let volume = volume([10, 8, 9], at);
        let stack = Stack::of(&volume).unwrap();
        let mut mask = Mask::of(&volume, &stack, 3).unwrap();
        assert_eq!((mask.low, mask.size), ([1, 0, 1], [9, 7, 8]));
        assert_eq!(mask.listed(&stack).len(), 2);
        let others = mask.keep_largest(&stack);
        assert_eq!(others, [Piece { voxels: 1, volume_mm3: 2.0, slices: [8, 8] }]);
        assert_eq!(mask.volume_mm3(&stack), 2.0 * 125.0);
        let hollow = Piece { voxels: 1, volume_mm3: 2.0, slices: [3, 3] };
        assert_eq!(mask.hollows(&stack, true), [hollow]);
        assert_eq!(mask.volume_mm3(&stack), 2.0 * 126.0);
        assert_eq!((mask.slices(), mask.touches(&stack)), (6, [[false; 2]; 3]));
        assert!(Mask::of(&volume, &stack, 4).is_none());
    }

    #[test]
    fn what_is_open_to_the_volumes_border_is_no_hollow() {
        // A tube through all slices.
        let tube =
            volume([5, 5, 4], |[i, j, _]| (1..4).contains(&i) && (1..4).contains(&j) && [i, j] != [2, 2]);
        let stack = Stack::of(&tube).unwrap();
        let mut mask = Mask::of(&tube, &stack, 3).unwrap();
        assert_eq!(mask.hollows(&stack, true), []);
        assert_eq!(mask.touches(&stack), [[false; 2], [false; 2], [true; 2]]);
    }
}
