//! Residuals as arrows: magnified by a round number so that they can be seen, with a bar that says how long a pixel is.

use super::svg::{Anchor, Font, Style, Svg};

/// The largest of 1, 2, 5, 10, 20, ... that is at most `value`; 1 where there is none.
pub(super) fn round_below(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let power = 10_f64.powi(value.log10().floor() as i32);
    let rounded = [5.0, 2.0, 1.0].into_iter().map(|d| d * power).find(|r| *r <= value * (1.0 + 1e-9));
    rounded.unwrap_or(power)
}

/// How residuals are magnified.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Magnified {
    /// So many times.
    pub factor: f64,
    /// Arrows are cut at this length, px of the picture.
    pub longest_px: f64,
}

impl Magnified {
    /// So that 95 of 100 lengths (px) are drawn at most `target_px` long; arrows are cut at three times that.
    pub(super) fn of(lengths: impl Iterator<Item = f64>, target_px: f64) -> Self {
        let mut lengths: Vec<f64> = lengths.filter(|l| l.is_finite()).collect();
        lengths.sort_by(f64::total_cmp);
        let place = (lengths.len() as f64 * 0.95).ceil() as usize;
        let usual = lengths.get(place.saturating_sub(1)).copied().unwrap_or(0.0);
        // Residuals that are nothing at all need no larger factor to be seen to be nothing.
        let factor = round_below(target_px / usual.max(1e-4)).max(1.0);
        Self { factor, longest_px: 3.0 * target_px }
    }

    /// The strokes of an arrow for a residual (px) at a place (px), and whether it is cut.
    pub(super) fn arrow(&self, at: [f64; 2], residual: [f64; 2]) -> (Vec<Vec<[f64; 2]>>, bool) {
        let length = residual[0].hypot(residual[1]);
        if !(length.is_finite() && length > 0.0) {
            return (vec![vec![at, at]], false);
        }
        let drawn = (length * self.factor).min(self.longest_px);
        let [x, y] = residual.map(|v| v / length);
        let tip = [at[0] + x * drawn, at[1] + y * drawn];
        let head = (0.3 * drawn).min(0.12 * self.longest_px);
        let barb = |side: f64| [tip[0] - head * (x - side * 0.5 * y), tip[1] - head * (y + side * 0.5 * x)];
        (vec![vec![at, tip], vec![barb(1.0), tip, barb(-1.0)]], length * self.factor > self.longest_px)
    }

    /// A bar with the length that so many pixels of a residual are drawn at, where a pixel of the picture has `scale` units.
    pub(super) fn bar(&self, svg: &mut Svg, corner: [f64; 2], scale: f64, colour: &str, size: f64) {
        let unit = self.factor * scale;
        let shown = round_below(110.0 / unit);
        let [x, y] = corner;
        let end = x + shown * unit;
        svg.group(Style::line("scale", colour, 2.0), |svg| {
            svg.strokes(
                &[
                    vec![[x, y], [end, y]],
                    vec![[x, y - 5.0], [x, y + 5.0]],
                    vec![[end, y - 5.0], [end, y + 5.0]],
                ],
                false,
            );
        });
        let font = Font::new(size, colour).anchored(Anchor::Start);
        svg.text([end + 10.0, y + 0.35 * size], font, &format!("{shown} px (arrows × {})", self.factor));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_round_and_not_too_large() {
        let cases =
            [(0.7, 0.5), (1.0, 1.0), (4.9, 2.0), (5.0, 5.0), (999.0, 500.0), (0.0, 1.0), (f64::NAN, 1.0)];
        for (value, expected) in cases {
            assert!((round_below(value) - expected).abs() < 1e-12, "{value}");
        }
    }

    #[test]
    fn an_arrow_is_as_long_as_its_residual_says_until_it_is_cut() {
        let lengths = (1..=100).map(|i| f64::from(i) * 0.001);
        let m = Magnified::of(lengths, 20.0);
        assert_eq!(m.factor, 200.0, "95 % are below 0.095 px, and 20 / 0.095 is 210");
        let (strokes, cut) = m.arrow([10.0, 10.0], [0.0, 0.05]);
        assert_eq!((strokes[0][1], cut), ([10.0, 20.0], false));
        let (strokes, cut) = m.arrow([10.0, 10.0], [3.0, 0.0]);
        assert_eq!((strokes[0][1], cut), ([70.0, 10.0], true));
        assert!(!m.arrow([1.0, 1.0], [f64::NAN, 0.0]).1);
    }
}
