//! Distributions of errors.

use std::fmt;

use crate::outcome::Outcome;
use crate::plot::{Series, cumulative};
use crate::{Cell, Column, Row};

/// Median, 95 % and worst of some errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distribution {
    /// Half are at most this.
    pub median: f64,
    /// 95 of 100 are at most this.
    pub p95: f64,
    /// None is above.
    pub worst: f64,
}

impl Distribution {
    /// Of the values (nearest rank); NaN where there are none.
    pub fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let rank = (share * values.len() as f64).ceil() as usize;
            values.get(rank.saturating_sub(1)).copied().unwrap_or(f64::NAN)
        };
        Self { median: at(0.5), p95: at(0.95), worst: at(1.0) }
    }
}

/// Columns of errors over many matches.
pub fn distribution_columns() -> Vec<Column> {
    ["mm, median", "95 %", "worst", "degrees, median", "95 %, degrees", "worst, degrees"]
        .iter()
        .map(|name| Column::at_most(name, 3))
        .chain([Column::at_least("good", 0), Column::at_most("good, yet wrong", 0)])
        .collect()
}

/// A row of them: errors of the matches that count; wrong is beyond 1 mm or 1 degree.
pub fn distribution_row(label: &str, outcomes: &[Outcome]) -> Row {
    let counted: Vec<&Outcome> = outcomes.iter().filter(|o| o.counts).collect();
    let mm = Distribution::of(counted.iter().map(|o| o.error.translation_mm).collect());
    let deg = Distribution::of(counted.iter().map(|o| o.error.rotation_rad.to_degrees()).collect());
    let errors = [mm.median, mm.p95, mm.worst, deg.median, deg.p95, deg.worst];
    // Where no match counts there is no error, and the share of good ones is what fails.
    let mut cells: Vec<Cell> = match counted.is_empty() {
        true => errors.map(|_| Cell::text("-")).into(),
        false => errors.map(Cell::Number).into(),
    };
    cells.push(Cell::Share(counted.len(), outcomes.len()));
    cells.push(Cell::Number(counted.iter().filter(|o| !o.right()).count() as f64));
    Row::ours(label, cells)
}

/// Position errors (mm) and rotation errors (degrees) of the matches that count, as lines of a plot.
pub fn cumulative_errors(name: &str, outcomes: &[Outcome]) -> [Series; 2] {
    let of = |error: fn(&Outcome) -> f64| {
        cumulative(name, &outcomes.iter().filter(|o| o.counts).map(error).collect::<Vec<_>>())
    };
    [of(|o| o.error.translation_mm), of(|o| o.error.rotation_rad.to_degrees())]
}

impl fmt::Display for Distribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "median {:.3}, 95 % {:.3}, worst {:.3}", self.median, self.p95, self.worst)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_those_of_the_sorted_values() {
        let d = Distribution::of((1..=100).rev().map(f64::from).collect());
        assert_eq!((d.median, d.p95, d.worst), (50.0, 95.0, 100.0));
        assert!(Distribution::of(vec![]).median.is_nan());
    }
}
