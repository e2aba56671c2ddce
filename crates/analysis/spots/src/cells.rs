//! Places of a picture by square cells, to look up those near one.

/// Side of a cell, px.
const SIDE: f64 = 16.0;

/// Numbers of places by the cell that they lie in. A place outside the picture counts to the nearest cell.
#[derive(Debug)]
pub(crate) struct Cells {
    count: [usize; 2],
    numbers: Vec<Vec<usize>>,
}

impl Cells {
    /// No places yet, in a picture of `size` pixels.
    pub fn new(size: [usize; 2]) -> Self {
        let count = size.map(|n| (n as f64 / SIDE) as usize + 1);
        Self { count, numbers: vec![Vec::new(); count[0] * count[1]] }
    }

    fn index(&self, v: f64, axis: usize) -> usize {
        ((v.max(0.0) / SIDE) as usize).min(self.count[axis] - 1)
    }

    /// Adds the place with a number.
    pub fn add(&mut self, at: [f64; 2], number: usize) {
        let cell = self.index(at[1], 1) * self.count[0] + self.index(at[0], 0);
        self.numbers[cell].push(number);
    }

    /// Numbers of all places within `reach` of one along both axes, and of some more.
    pub fn near(&self, at: [f64; 2], reach: f64) -> impl Iterator<Item = usize> + '_ {
        let range = |axis: usize| self.index(at[axis] - reach, axis)..=self.index(at[axis] + reach, axis);
        let (columns, rows) = (range(0), range(1));
        rows.flat_map(move |j| columns.clone().map(move |i| (i, j)))
            .flat_map(|(i, j)| self.numbers[j * self.count[0] + i].iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_near_one_are_among_those_given() {
        let places: Vec<[f64; 2]> =
            (0..400).map(|i| [f64::from(i * 37 % 211) - 5.0, f64::from(i * 53 % 97)]).collect();
        let mut cells = Cells::new([200, 90]);
        for (i, p) in places.iter().enumerate() {
            cells.add(*p, i);
        }
        for p in &places {
            let near: Vec<usize> = cells.near(*p, 20.0).collect();
            for (i, q) in places.iter().enumerate() {
                let within = (p[0] - q[0]).abs() <= 20.0 && (p[1] - q[1]).abs() <= 20.0;
                assert!(!within || near.contains(&i), "{p:?} and {q:?}");
            }
            assert!(near.len() < places.len() / 2);
        }
    }
}
