//! Cells of VTK, of whichever of its formats: lists of corners, one after another, and where each ends.

use super::soup::{MOST_CORNERS, Soup};

/// What a cell is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    /// Triangle, quad or polygon: the outline in order.
    Polygon,
    /// Triangles, each of a corner and the two before it.
    Strip,
    /// A quad whose last two corners are the other way round.
    Pixel,
    /// No surface.
    Other(&'static str),
}

impl Kind {
    /// By VTK's number of a cell type.
    pub(super) fn of(number: i64) -> Self {
        match number {
            5 | 7 | 9 => Self::Polygon,
            6 => Self::Strip,
            8 => Self::Pixel,
            0..=2 => Self::Other("vertices of no face"),
            3 | 4 => Self::Other("lines"),
            10..=14 => Self::Other("cells of volume"),
            _ => Self::Other("cells of other kinds"),
        }
    }
}

/// Cells by their corners.
pub(super) struct Cells {
    /// Where each cell begins, and where the last one ends.
    starts: Vec<usize>,
    corners: Vec<i64>,
}

impl Cells {
    pub(super) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// From a list that says for each cell how many corners it has, and which.
    pub(super) fn from_counts(cells: usize, list: &[i64]) -> Result<Self, String> {
        let mut starts = vec![0];
        let mut corners = Vec::with_capacity(list.len());
        let mut rest = list.iter().copied();
        for at in 0..cells {
            let count =
                rest.next().ok_or_else(|| format!("it ends before cell {at} (counted from 0) of {cells}"))?;
            if count < 0 || count as usize > rest.len() {
                return Err(format!(
                    "cell {at} (counted from 0) of {cells} claims {count} corners, and {} numbers are left",
                    rest.len()
                ));
            }
            corners.extend(rest.by_ref().take(count as usize));
            starts.push(corners.len());
        }
        match rest.len() {
            0 => Ok(Self { starts, corners }),
            left => Err(format!("{left} numbers are left after the last of {cells} cells")),
        }
    }

    /// From where each cell begins and, at last, where the last one ends.
    pub(super) fn from_offsets(offsets: Vec<i64>, corners: Vec<i64>) -> Result<Self, String> {
        if offsets.is_empty() {
            return Self::from_ends(Vec::new(), corners);
        }
        let (first, ends) = (offsets[0], offsets[1..].to_vec());
        if first != 0 {
            return Err(format!("the first offset is {first}, not 0"));
        }
        Self::from_ends(ends, corners)
    }

    /// From where each cell ends.
    pub(super) fn from_ends(ends: Vec<i64>, corners: Vec<i64>) -> Result<Self, String> {
        let mut starts = Vec::with_capacity(ends.len() + 1);
        starts.push(0);
        let mut last = 0;
        for (at, end) in ends.iter().enumerate() {
            if *end < last || *end as usize > corners.len() {
                return Err(format!(
                    "cell {at} (counted from 0) ends at {end} of {} corners, after {last}",
                    corners.len()
                ));
            }
            last = *end;
            starts.push(last as usize);
        }
        if last as usize != corners.len() {
            return Err(format!("the last cell ends at {last}, but there are {} corners", corners.len()));
        }
        Ok(Self { starts, corners })
    }

    /// Adds all cells, each of the kind that `kind` says, over the points of the soup from `first` on.
    pub(super) fn add_each(
        &self,
        first: usize,
        kind: impl Fn(usize) -> Kind,
        soup: &mut Soup,
    ) -> Result<(), String> {
        let points = soup.points.len() - first;
        let mut cell: Vec<u32> = Vec::new();
        for (at, bounds) in self.starts.windows(2).enumerate() {
            let kind = kind(at);
            if let Kind::Other(what) = kind {
                soup.leave_out(1, what);
                continue;
            }
            cell.clear();
            for corner in &self.corners[bounds[0]..bounds[1]] {
                if *corner < 0 || *corner as usize >= points {
                    return Err(format!(
                        "cell {at} (counted from 0) names point {corner}; expected 0 to {}, of {points} points",
                        points.saturating_sub(1)
                    ));
                }
                cell.push((first + *corner as usize) as u32);
            }
            match kind {
                Kind::Strip => soup.strip(&cell),
                _ if cell.len() > MOST_CORNERS => {
                    return Err(format!(
                        "cell {at} (counted from 0) has {} corners; at most {MOST_CORNERS} are read",
                        cell.len()
                    ));
                }
                Kind::Pixel => {
                    if let [.., _, _] = cell[..] {
                        let n = cell.len();
                        cell.swap(n - 1, n - 2);
                    }
                    soup.polygon(&cell);
                }
                _ => soup.polygon(&cell),
            }
        }
        Ok(())
    }
}
