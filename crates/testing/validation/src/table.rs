//! Tables of figures, each held to a stated limit.
//!
//! A row of ours has a limit for every number in it, by construction: the limits come from `budgets.toml` beside this
//! crate, by table and row, and a number without one is a failure like a number beyond one. What others published has no
//! limit and cannot fail.

use std::fmt::Write;

use serde::Deserialize;

/// Mean, sample standard deviation and root mean square of signed errors, as the thesis prints them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Sample standard deviation (n - 1).
    pub deviation: f64,
    /// Root mean square.
    pub rms: f64,
}

impl Spread {
    /// Of the values; NaN where there are too few.
    pub fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let rms = (values.iter().map(|v| v * v).sum::<f64>() / n).sqrt();
        Self { mean, deviation: (squares / (n - 1.0)).sqrt(), rms }
    }
}

/// One figure, or text.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Held by its root mean square.
    Spread(Spread),
    /// A number.
    Number(f64),
    /// So many of so many; held by the share.
    Share(usize, usize),
    /// What others printed, or nothing to measure.
    Text(String),
}

impl Cell {
    /// Text.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    fn held(&self) -> Option<f64> {
        match self {
            Self::Spread(s) => Some(s.rms),
            Self::Number(v) => Some(*v),
            Self::Share(part, whole) => Some(*part as f64 / (*whole).max(1) as f64),
            Self::Text(_) => None,
        }
    }

    fn print(&self, decimals: usize) -> String {
        // Adding zero makes what rounds to -0 a plain 0.
        let round = |v: f64| {
            let scale = 10_f64.powi(decimals as i32);
            (v * scale).round() / scale + 0.0
        };
        match self {
            Self::Spread(s) => {
                let [mean, deviation, rms] = [s.mean, s.deviation, s.rms].map(round);
                format!("{mean:.decimals$} ± {deviation:.decimals$} [{rms:.decimals$}]")
            }
            Self::Number(v) => format!("{:.decimals$}", round(*v)),
            Self::Share(part, whole) => format!("{part} of {whole}"),
            Self::Text(text) => text.clone(),
        }
    }
}

/// Which way a column's limit holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hold {
    /// The size may be at most the limit.
    AtMost,
    /// The figure must be at least the limit.
    AtLeast,
    /// Between two limits.
    Within,
}

/// A column of figures.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Heading, with its unit.
    pub name: String,
    /// Decimals of its figures.
    pub decimals: usize,
    /// How its limits hold.
    pub hold: Hold,
}

impl Column {
    /// A column whose figures may be at most their limits.
    pub fn at_most(name: &str, decimals: usize) -> Self {
        Self { name: name.to_owned(), decimals, hold: Hold::AtMost }
    }

    /// A column whose figures must be at least their limits.
    pub fn at_least(name: &str, decimals: usize) -> Self {
        Self { name: name.to_owned(), decimals, hold: Hold::AtLeast }
    }

    /// A column whose figures must lie between two limits.
    pub fn within(name: &str, decimals: usize) -> Self {
        Self { name: name.to_owned(), decimals, hold: Hold::Within }
    }
}

/// A row.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// What was measured, and how.
    pub label: String,
    /// Whether it is ours, and so held to limits.
    pub ours: bool,
    /// One a column.
    pub cells: Vec<Cell>,
}

impl Row {
    /// A row that this run measured.
    pub fn ours(label: impl Into<String>, cells: Vec<Cell>) -> Self {
        Self { label: label.into(), ours: true, cells }
    }

    /// A row that somebody published, as printed there.
    pub fn published(label: impl Into<String>, cells: &[&str]) -> Self {
        let cells = cells.iter().map(|c| Cell::text(*c)).collect();
        Self { label: label.into(), ours: false, cells }
    }
}

/// A table.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Its name in `budgets.toml`.
    pub id: String,
    /// Heading of the first column.
    pub heading: String,
    /// The columns of figures.
    pub columns: Vec<Column>,
    /// The rows.
    pub rows: Vec<Row>,
}

/// A limit as `budgets.toml` has it.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Limit {
    /// At most or at least this, as the column says.
    One(f64),
    /// Between these.
    Between(f64, f64),
}

impl Limit {
    fn holds(self, hold: Hold, value: f64) -> bool {
        match (hold, self) {
            (Hold::AtMost, Self::One(limit)) => value.abs() <= limit,
            (Hold::AtLeast, Self::One(limit)) => value >= limit,
            (Hold::Within, Self::Between(low, high)) => (low..=high).contains(&value),
            _ => false,
        }
    }

    fn print(self, column: &Column, cell: &Cell) -> String {
        let decimals = column.decimals;
        let shown = |v: f64| match cell {
            Cell::Share(..) => format!("{:.0} %", 100.0 * v),
            _ => format!("{v:.decimals$}"),
        };
        match (column.hold, self) {
            (Hold::AtMost, Self::One(v)) => format!("≤ {}", shown(v)),
            (Hold::AtLeast, Self::One(v)) => format!("≥ {}", shown(v)),
            (_, Self::Between(low, high)) => format!("{} to {}", shown(low), shown(high)),
            (Hold::Within, Self::One(v)) => shown(v),
        }
    }
}

/// The limits of all tables: table, row, then one a column that holds figures.
#[derive(Debug, Clone, PartialEq)]
pub struct Budgets(toml::Table);

impl Budgets {
    /// The limits that are built in.
    ///
    /// # Errors
    /// `budgets.toml` is not TOML.
    pub fn built_in() -> Result<Self, toml::de::Error> {
        include_str!("../budgets.toml").parse().map(Self)
    }

    fn row(&self, table: &str, row: &str) -> Option<Vec<Limit>> {
        self.0.get(table)?.get(row)?.clone().try_into().ok()
    }

    /// Rows that have a limit, though `tables` have no such row: left over from something renamed.
    pub fn left_over(&self, tables: &[&Table]) -> Vec<String> {
        let mut found = Vec::new();
        for (id, rows) in &self.0 {
            let table = tables.iter().find(|t| t.id == *id);
            for row in rows.as_table().into_iter().flat_map(toml::Table::keys) {
                if !table.is_some_and(|t| t.rows.iter().any(|r| r.ours && r.label == *row)) {
                    found.push(format!("{id} | {row}: has a limit in budgets.toml, but nothing measures it"));
                }
            }
        }
        found
    }
}

impl Table {
    /// The figures beyond their limit or without one, each named.
    pub fn beyond(&self, budgets: &Budgets) -> Vec<String> {
        let mut found = Vec::new();
        for row in self.rows.iter().filter(|r| r.ours) {
            let name = |column: &Column| format!("{} | {} | {}", self.id, row.label, column.name);
            let limits = budgets.row(&self.id, &row.label).unwrap_or_default();
            let held: Vec<(&Column, &Cell, f64)> =
                self.columns.iter().zip(&row.cells).filter_map(|(c, x)| Some((c, x, x.held()?))).collect();
            if limits.len() != held.len() || row.cells.len() != self.columns.len() {
                found.push(format!(
                    "{} | {}: {} figures, but {} limits in budgets.toml",
                    self.id,
                    row.label,
                    held.len(),
                    limits.len()
                ));
                continue;
            }
            for ((column, cell, value), limit) in held.into_iter().zip(limits) {
                if !limit.holds(column.hold, value) {
                    found.push(format!(
                        "{}: {}, limit {}",
                        name(column),
                        cell.print(column.decimals),
                        limit.print(column, cell)
                    ));
                }
            }
        }
        found
    }

    /// As Markdown, without limits.
    pub fn plain(&self) -> String {
        self.with_lines_below(|_| None)
    }

    /// As Markdown; below each of our rows that of its limits, but once where neighbours have the same ones.
    pub fn markdown(&self, budgets: &Budgets) -> String {
        self.with_lines_below(|row| row.ours.then(|| self.limits_line(budgets, row)).flatten())
    }

    fn with_lines_below(&self, line: impl Fn(&Row) -> Option<String>) -> String {
        let mut text = format!("| {} |", self.heading);
        for c in &self.columns {
            let _ = write!(text, " {} |", c.name);
        }
        text.push_str("\n|---|");
        text.push_str(&"---|".repeat(self.columns.len()));
        text.push('\n');
        for (index, row) in self.rows.iter().enumerate() {
            let _ = write!(text, "| {} |", row.label);
            for (column, cell) in self.columns.iter().zip(&row.cells) {
                let _ = write!(text, " {} |", cell.print(column.decimals));
            }
            text.push('\n');
            let own = line(row);
            if own.is_some() && own != self.rows.get(index + 1).and_then(&line) {
                text.push_str(&own.unwrap_or_default());
            }
        }
        text
    }

    fn limits_line(&self, budgets: &Budgets, row: &Row) -> Option<String> {
        let mut limits = budgets.row(&self.id, &row.label)?.into_iter();
        let mut text = "| *limit* |".to_owned();
        for (column, cell) in self.columns.iter().zip(&row.cells) {
            let limit = cell.held().and_then(|_| limits.next());
            let _ = write!(
                text,
                " {} |",
                limit.map_or(String::new(), |l| format!("*{}*", l.print(column, cell)))
            );
        }
        text.push('\n');
        Some(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(values: [f64; 2]) -> Table {
        Table {
            id: "t".to_owned(),
            heading: "method".to_owned(),
            columns: vec![Column::at_most("error, mm", 3), Column::at_least("converged", 0)],
            rows: vec![
                Row::published("thesis", &["0.5", "-"]),
                Row::ours("ours", vec![Cell::Number(values[0]), Cell::Share(values[1] as usize, 10)]),
            ],
        }
    }

    fn budgets(text: &str) -> Budgets {
        Budgets(text.parse().unwrap())
    }

    #[test]
    fn a_figure_beyond_its_limit_is_named() {
        let held = budgets("[t]\nours = [0.02, 0.9]");
        assert_eq!(table([0.01, 9.0]).beyond(&held), Vec::<String>::new());
        assert_eq!(table([-0.03, 9.0]).beyond(&held), ["t | ours | error, mm: -0.030, limit ≤ 0.020"]);
        assert_eq!(table([0.01, 8.0]).beyond(&held), ["t | ours | converged: 8 of 10, limit ≥ 90 %"]);
        assert_eq!(table([f64::NAN, 9.0]).beyond(&held).len(), 1);
    }

    #[test]
    fn a_figure_without_a_limit_and_a_limit_without_a_figure_are_failures() {
        assert_eq!(table([0.01, 9.0]).beyond(&budgets("")).len(), 1);
        assert_eq!(table([0.01, 9.0]).beyond(&budgets("[t]\nours = [0.02]")).len(), 1);
        let left = budgets("[t]\nours = [0.02, 0.9]\nold = [1.0]\n[u]\nx = [1.0]");
        assert_eq!(left.left_over(&[&table([0.0, 9.0])]).len(), 2);
    }

    #[test]
    fn limits_stand_below_their_rows() {
        let text = table([0.01, 9.0]).markdown(&budgets("[t]\nours = [0.02, 0.9]"));
        assert!(text.contains("| ours | 0.010 | 9 of 10 |\n| *limit* | *≤ 0.020* | *≥ 90 %* |\n"), "{text}");
    }

    #[test]
    fn spread_of_known_numbers() {
        let s = Spread::of(&[1.0, 2.0, 3.0]);
        assert_eq!((s.mean, s.deviation), (2.0, 1.0));
        assert!((s.rms - (14.0_f64 / 3.0).sqrt()).abs() < 1e-15);
    }
}
