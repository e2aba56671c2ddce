//! How far a mesh is from a reference mesh, as colours on it, with a bar that says what they mean.

use biplane_geometry::Mesh;
use biplane_surface::{Spread, Surface, distances};

use super::colours::{FAINT, INK};
use super::sheet::{SMALL, TEXT, quantity};
use super::svg::{Anchor, Font, Svg};

/// Points on either surface whose distances are taken.
const SAMPLES: usize = 20_000;
/// Colours from far inside of the reference to far outside (Moreland 2009: cool to warm).
const COLOURS: [[f32; 3]; 5] = [
    [33.0, 72.0, 184.0],
    [116.0, 160.0, 236.0],
    [228.0, 228.0, 224.0],
    [238.0, 142.0, 104.0],
    [176.0, 16.0, 38.0],
];
/// Steps of colour on the surface and the bar; even, so that no step holds distances of both signs.
const STEPS: usize = 30;

/// The distances of two meshes from each other.
#[derive(Debug)]
pub(super) struct DistanceMap {
    /// At each vertex of the mesh, mm: positive outside of the reference.
    pub values: Vec<f32>,
    /// Where the colours end, mm.
    pub limit_mm: f64,
    /// Of points of the mesh from the reference.
    pub to: Spread,
    /// Of points of the reference from the mesh.
    pub back: Spread,
}

impl DistanceMap {
    pub(super) fn of(mesh: &Mesh, reference: &Mesh) -> Self {
        let (surface, other) = (Surface::new(mesh), Surface::new(reference));
        let values = mesh.vertices().iter().map(|v| other.signed_distance(v) as f32).collect();
        let to = Spread::of(&distances(mesh, &other, SAMPLES));
        let back = Spread::of(&distances(reference, &surface, SAMPLES));
        Self { values, limit_mm: limit(to.p95), to, back }
    }

    /// The colour of a distance.
    pub(super) fn colour(&self, value: f32) -> [f32; 3] {
        let share = (value / self.limit_mm as f32).clamp(-1.0, 1.0);
        let half = STEPS as f32 / 2.0;
        colour(((share * half).floor() + 0.5).min(half - 0.5) / half)
    }
}

/// The end of a scale that holds a value: a round number, from 0.05 mm on.
fn limit(value: f64) -> f64 {
    let steps =
        (-2..=6).flat_map(|power| [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0].map(|m| m * 10.0_f64.powi(power)));
    steps.filter(|s| *s >= 0.05).find(|s| *s >= value).unwrap_or(1e7)
}

/// Of a share of the limit, -1 to 1.
fn colour(share: f32) -> [f32; 3] {
    let place = (share.clamp(-1.0, 1.0) + 1.0) / 2.0 * (COLOURS.len() - 1) as f32;
    // A value that is none is drawn as none.
    let first = (place as usize).min(COLOURS.len() - 2);
    let part = if place.is_nan() { 0.0 } else { place - first as f32 };
    std::array::from_fn(|c| COLOURS[first][c] + part * (COLOURS[first + 1][c] - COLOURS[first][c]))
}

/// The bar and the numbers, from `corner` down in a column of a width; returns where they end.
pub(super) fn draw_bar(svg: &mut Svg, map: &DistanceMap, corner: [f64; 2], height: f64) -> f64 {
    let [x, y] = corner;
    let step = height / STEPS as f64;
    for n in 0..STEPS {
        let share = 1.0 - 2.0 * (n as f32 + 0.5) / STEPS as f32;
        let [r, g, b] = colour(share).map(|c| c as u8);
        svg.group(super::svg::Style::area("bar", &format!("#{r:02x}{g:02x}{b:02x}")), |svg| {
            // A little higher than a step, so that no gap shows between two.
            svg.rectangle([x, y + n as f64 * step], [18.0, step + 0.6]);
        });
    }
    let decimals = if map.limit_mm < 0.1 { 3 } else { 2 };
    for n in 0..5 {
        let value = map.limit_mm * (1.0 - f64::from(n) / 2.0);
        let sign = if value > 0.0 { "+" } else { "" };
        let text = format!("{sign}{}", quantity(value, decimals, "mm"));
        svg.text([x + 26.0, y + height * f64::from(n) / 4.0 + 4.5], Font::new(SMALL, INK), &text);
    }
    svg.text([x + 100.0, y + 10.0], Font::new(SMALL, FAINT), "outside");
    svg.text([x + 100.0, y + height], Font::new(SMALL, FAINT), "inside");
    let mut y = y + height + 14.0;
    for (name, spread) in [("model from reference", &map.to), ("reference from model", &map.back)] {
        y += 22.0;
        svg.text([x, y], Font::new(TEXT - 1.0, INK).bold(), name);
        for (what, value) in [("median", spread.median), ("95 %", spread.p95), ("worst", spread.worst)] {
            y += 19.0;
            svg.text([x, y], Font::new(SMALL, FAINT), what);
            let font = Font::new(SMALL, INK).anchored(Anchor::End);
            svg.text([x + 150.0, y], font, &quantity(value, 3, "mm"));
        }
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_cold_inside_and_warm_outside_and_scales_are_round() {
        assert_eq!(colour(0.0), COLOURS[2]);
        assert_eq!((colour(-7.0), colour(f32::INFINITY)), (COLOURS[0], COLOURS[4]));
        assert_eq!(colour(f32::NAN), COLOURS[0]);
        let limits = [0.0, 0.051, 0.2, 0.31, 3e9].map(limit);
        assert_eq!(limits, [0.05, 0.07, 0.2, 0.4, 1e7]);
    }
}
