//! What was aimed at beside what was measured, in words that the run itself makes.

/// Goals and figures of a section.
#[derive(Debug, Default)]
pub struct Goals(Vec<String>, usize);

impl Goals {
    /// `value` should be at most `goal`.
    pub fn at_most(&mut self, what: &str, value: f64, goal: f64, unit: &str) {
        self.note(what, value <= goal, format!("{value:.4} {unit}, goal {goal} {unit}"));
    }

    /// `value` should be between two.
    pub fn between(&mut self, what: &str, value: f64, (low, high): (f64, f64), unit: &str) {
        self.note(
            what,
            (low..=high).contains(&value),
            format!("{value:.1} {unit}, goal {low} to {high} {unit}"),
        );
    }

    /// `share` of something should be at least `goal`.
    pub fn share(&mut self, what: &str, (part, whole): (usize, usize), goal: f64) {
        let share = part as f64 / whole.max(1) as f64;
        self.note(what, share >= goal, format!("{:.1} %, goal {} %", 100.0 * share, 100.0 * goal));
    }

    /// There should be no `what`.
    pub fn none(&mut self, what: &str, count: usize) {
        self.note(what, count == 0, format!("{count}, goal 0"));
    }

    fn note(&mut self, what: &str, reached: bool, figures: String) {
        self.1 += 1;
        if !reached {
            self.0.push(format!("{what}: {figures}"));
        }
    }

    /// A paragraph: which goals were missed and by what figure.
    pub fn text(&self) -> String {
        match self.0.len() {
            0 => format!("All {} goals are reached.", self.1),
            missed => format!("**{missed} of {} goals are missed:** {}.", self.1, self.0.join("; ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missed_goals_are_told_with_their_figures() {
        let mut goals = Goals::default();
        goals.at_most("error", 0.01, 0.02, "mm");
        assert_eq!(goals.text(), "All 1 goals are reached.");
        goals.at_most("error", f64::NAN, 0.02, "mm");
        goals.share("right", (98, 100), 0.99);
        goals.none("wrong", 1);
        assert_eq!(
            goals.text(),
            "**3 of 4 goals are missed:** error: NaN mm, goal 0.02 mm; right: 98.0 %, goal 99 %; wrong: 1, goal 0."
        );
    }
}
