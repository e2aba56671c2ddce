//! The numbers of a model that stand on its sheet.

use biplane_artifact::{BodyAxes, BodyKind, Side};
use biplane_surface::Edges;

use super::colours::Level;
use super::figures::source;
use super::model::Body;
use super::sheet::{Fact, quantity, shortened};

/// How many of the numbers are of the mesh as it is.
pub(super) const MESH_FACTS: usize = 8;

impl Body<'_> {
    /// The numbers of the mesh, then those of where it comes from.
    pub(super) fn numbers(&self) -> Vec<Fact> {
        let check = &self.check;
        let plain = |name, text: String| (name, text, Level::Plain);
        let closed = match (check.open_edges.len(), check.is_manifold()) {
            (0, true) => ("closed, two-manifold", "yes".to_owned(), Level::Good),
            (open, true) => ("closed, two-manifold", format!("open along {open} edges"), Level::Near),
            (open, false) => {
                let crowded = check.crowded_edges.len() + check.inconsistent_edges.len();
                let pinched = check.pinched_vertices.len();
                let text = format!("no: {open} open, {crowded} bad edges, {pinched} bad points");
                ("closed, two-manifold", text, Level::Bad)
            }
        };
        let mut lengths: Vec<f64> = Edges::of(self.model)
            .iter()
            .map(|([a, b], _)| (self.model.vertices()[a as usize] - self.model.vertices()[b as usize]).norm())
            .collect();
        lengths.sort_by(f64::total_cmp);
        let at =
            |share: f64| lengths.get((lengths.len() as f64 * share) as usize).copied().unwrap_or(f64::NAN);
        let size = self.size_mm().map(|v| quantity(v, 1, "")).join(" × ");
        let mut facts = vec![
            plain("vertices", grouped(self.model.vertices().len())),
            plain("triangles", grouped(self.model.triangles().len())),
            closed,
            plain("pieces", check.pieces.to_string()),
            if self.shown.axes.is_some() {
                plain("size along x, y, z of the axes", format!("{size} mm"))
            } else {
                plain("size along x, y, z", format!("{size} mm"))
            },
            plain("edges: median (5 % to 95 %)", {
                let [few, half, most] = [0.05, 0.5, 0.95].map(|s| quantity(at(s), 2, ""));
                format!("{half} mm ({few} to {most})")
            }),
            plain("area", quantity(check.area_mm2 / 100.0, 2, "cm²")),
            plain("volume", quantity(check.signed_volume_mm3 / 1000.0, 2, "cm³")),
        ];
        if let Some(surface) = self.shown.surface {
            facts.push(plain("made by", shortened(&surface.method, 40)));
            let from = match surface.contours {
                0 => format!("{} slices", surface.slices),
                n => format!("{} slices, {n} contours", surface.slices),
            };
            facts.push(plain("from", from));
            let change = 100.0 * (surface.volume_mm3 / surface.unsmoothed_volume_mm3 - 1.0);
            let level = Level::of(change.abs(), 1.0);
            facts.push(("volume changed by smoothing", unsigned_zero(change, 3, "%"), level));
            facts.push(plain("pieces then", surface.pieces.to_string()));
            let level = if surface.faults.is_empty() { Level::Good } else { Level::Bad };
            facts.push(("faults", surface.faults.len().to_string(), level));
        }
        if let Some(axes) = self.shown.axes {
            let (text, level) = source(axes);
            facts.push(("axes", text.trim_start_matches("axes ").to_owned(), level));
            facts.push(plain("body", body_name(axes)));
        }
        facts
    }
}

fn body_name(axes: &BodyAxes) -> String {
    let body = match axes.body {
        BodyKind::Femur => "femur",
        BodyKind::Tibia => "tibia",
        BodyKind::Patella => "patella",
        BodyKind::FemoralComponent => "femoral component",
        BodyKind::TibialTray => "tibial tray",
        BodyKind::Other => return "other".to_owned(),
    };
    match axes.side {
        Side::Left => format!("left {body}"),
        Side::Right => format!("right {body}"),
    }
}

/// As [`quantity`], without the sign of a number that is shown as 0.
pub(super) fn unsigned_zero(value: f64, decimals: usize, unit: &str) -> String {
    let text = quantity(value, decimals, unit);
    match text.strip_prefix('-') {
        Some(size) if !size.contains(|c: char| ('1'..='9').contains(&c)) => size.to_owned(),
        _ => text,
    }
}

/// A number with its thousands apart.
pub(super) fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
