//! Colours of the drawings, and how far a number is from its limit.

/// Text.
pub(super) const INK: &str = "#1b1f24";
/// Text beside the point, and thin lines.
pub(super) const FAINT: &str = "#6a737d";
/// Frames and grids.
pub(super) const RULE: &str = "#c9d0d7";

/// Marks on a picture, bright enough for its dark parts: used, left out, no part of the pattern, not found.
pub(super) const USED: &str = "#3ddc5a";
/// See [`USED`].
pub(super) const REJECTED: &str = "#ff3b3b";
/// See [`USED`].
pub(super) const STRAY: &str = "#ffa51f";
/// See [`USED`].
pub(super) const MISSING: &str = "#4fb3ff";
/// Residual arrows on a picture.
pub(super) const ARROW: &str = "#ffe14d";

/// Colours of views by their place, over again for more; told apart by colour-blind people too (Okabe and Ito 2008).
pub(super) const VIEWS: [&str; 4] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7"];

/// How a number stands to its limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Level {
    /// It has no limit.
    Plain,
    /// It keeps its limit.
    Good,
    /// It is above its limit, by less than twice.
    Near,
    /// It is far above its limit, or no number.
    Bad,
}

impl Level {
    /// Of a number that should be at most `limit`.
    pub(super) fn of(value: f64, limit: f64) -> Self {
        match value {
            v if v <= limit => Self::Good,
            v if v <= 2.0 * limit => Self::Near,
            _ => Self::Bad,
        }
    }

    /// Dark enough for text on white.
    pub(super) fn ink(self) -> &'static str {
        match self {
            Self::Plain => INK,
            Self::Good => "#14803c",
            Self::Near => "#b35900",
            Self::Bad => "#c5161d",
        }
    }
}

/// The colour of a residual of `length`: from blue over yellow at the limit to red at twice the limit.
pub(super) fn by_length(length: f64, limit: f64) -> String {
    const STOPS: [[f64; 3]; 5] = [
        [33.0, 102.0, 172.0],
        [24.0, 150.0, 160.0],
        [214.0, 160.0, 0.0],
        [224.0, 92.0, 16.0],
        [190.0, 10.0, 30.0],
    ];
    let share = length / (2.0 * limit);
    // Where limit and length are both 0 the residual keeps its limit.
    let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
    let place = share * (STOPS.len() - 1) as f64;
    let first = (place.floor() as usize).min(STOPS.len() - 2);
    let part = place - first as f64;
    let [r, g, b] =
        [0, 1, 2].map(|c| (STOPS[first][c] + part * (STOPS[first + 1][c] - STOPS[first][c])).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_above_its_limit_is_never_good() {
        assert_eq!(Level::of(0.3, 0.3), Level::Good);
        assert_eq!(Level::of(0.31, 0.3), Level::Near);
        assert_eq!(Level::of(0.61, 0.3), Level::Bad);
        assert_eq!(Level::of(f64::NAN, 0.3), Level::Bad);
    }

    #[test]
    fn residuals_are_blue_at_zero_and_red_from_twice_the_limit_on() {
        assert_eq!(by_length(0.0, 0.3), "#2166ac");
        assert_eq!(by_length(0.3, 0.3), "#d6a000");
        assert_eq!(by_length(0.6, 0.3), by_length(f64::INFINITY, 0.3));
        assert_eq!(by_length(0.0, 0.0), "#2166ac");
    }
}
