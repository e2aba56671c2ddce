//! Surfaces made from slices and labels, against the analytic shapes that were sliced.

use biplane_artifact::SliceContours;
use biplane_geometry::Mesh;
use biplane_lofting::LoftParams;
use biplane_phantom::Body;
use biplane_surface::Spread;

use super::SectionError;
use crate::knee::FINEST;
use crate::sliced::{
    contours_of_labels, contours_of_mri, cut, distances, label_surface, labels, loft, model,
};
use crate::{Cell, Column, Lab, Row, SceneError, Section, Table};

/// Slices at either end that are looked at apart: there a cap closes the surface.
const END_SLICES: f64 = 2.0;
/// Spacings of points and slices that are refined together, mm.
const REFINED_MM: [f64; 3] = [2.0, 1.0, 0.5];
/// Bones that are sliced.
const BONES: [(Body, &str); 3] =
    [(Body::DistalFemur, "femur"), (Body::ProximalTibia, "tibia"), (Body::Patella, "patella")];

/// How far from the ends the order is measured, mm: the same place for every spacing.
const MIDDLE_MM: f64 = 8.0;

/// How far a surface is from the truth.
struct Found {
    /// In the middle, well away from the ends.
    middle: Spread,
    cells: Vec<Cell>,
}

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let mut table = Table {
        id: "mesh-error".to_owned(),
        heading: "surfaces from slices".to_owned(),
        columns: vec![
            Column::at_most("mm, median", 3),
            Column::at_most("95 %, mm", 3),
            Column::at_most("worst, mm", 3),
            Column::at_most("worst with the ends, mm", 3),
            Column::at_most("volume, %", 2),
            Column::at_most("faults", 0),
        ],
        rows: Vec::new(),
    };
    let mut orders = Table {
        id: "mesh-order".to_owned(),
        heading: "order of the error in the spacing".to_owned(),
        columns: vec![Column::at_least("order", 2)],
        rows: Vec::new(),
    };
    // A quick run has the smallest of them.
    let bones = if lab.full() { &BONES[..] } else { &BONES[2..] };
    for &(body, name) in bones {
        let fine = lab.workshop.surface(body, FINEST)?;
        let held =
            |surface: &Mesh, faults: usize, slice_mm: f64| found(surface, faults, body, &fine, slice_mm);
        let lofted = |contours: &SliceContours, params: &LoftParams, slice_mm: f64| {
            let surface = loft(contours, params)?;
            Ok::<_, SceneError>(held(&surface.mesh, surface.report.faults.len(), slice_mm))
        };
        let mut sizes = Vec::new();
        for mm in REFINED_MM {
            let own = lofted(&cut(&fine, mm, mm), &LoftParams::default(), mm)?;
            sizes.push((mm, own.middle.median));
            table.rows.push(Row::ours(format!("{name}, exact contours, {mm} x {mm} mm"), own.cells));
        }
        if let [(coarse_mm, coarse), .., (fine_mm, finest)] = sizes[..] {
            let order = (coarse / finest).ln() / (coarse_mm / fine_mm).ln();
            orders.rows.push(Row::ours(name, vec![Cell::Number(order)]));
        }
        let thick = lofted(&cut(&fine, 3.0, 0.5), &LoftParams::default(), 3.0)?;
        table.rows.push(Row::ours(format!("{name}, exact contours, 0.5 x 3 mm"), thick.cells));
        if body == Body::Patella {
            let params = LoftParams { method: biplane_lofting::Method::Diagonal, ..LoftParams::default() };
            let own = lofted(&cut(&fine, 1.0, 1.0), &params, 1.0)?;
            table
                .rows
                .push(Row::ours(format!("{name}, exact contours, 1 x 1 mm, method diagonal"), own.cells));
        }
        for (pixel_mm, slice_mm) in [(0.4, 0.7), (0.4, 3.0)] {
            let map = labels(body.solid(), pixel_mm, slice_mm)?;
            let at = format!("{name}, labels of {pixel_mm} x {slice_mm} mm");
            let own = lofted(&contours_of_labels(&map)?, &LoftParams::default(), slice_mm)?;
            table.rows.push(Row::ours(format!("{at}, lofted"), own.cells));
            let surface = label_surface(&map)?;
            let own = held(&surface.mesh, surface.report.faults.len(), slice_mm);
            table.rows.push(Row::ours(format!("{at}, label surface"), own.cells));
        }
        if body == Body::Patella {
            continue;
        }
        for (pixel_mm, slice_mm) in [(0.5, 1.0), (0.625, 3.0)] {
            let contours = contours_of_mri(body, pixel_mm, slice_mm, lab.seed)?;
            let at = format!("{name}, MRI of {pixel_mm} x {slice_mm} mm");
            let surface = loft(&contours, &LoftParams::default())?;
            let own = held(&surface.mesh, surface.report.faults.len(), slice_mm);
            table.rows.push(Row::ours(at.clone(), own.cells));
            if slice_mm == 1.0 {
                for points in [3_500, 15_000] {
                    let own = held(&model(surface.clone(), points)?, 0, slice_mm);
                    table.rows.push(Row::ours(format!("{at}, model of {points} points"), own.cells));
                }
            }
        }
    }
    Ok(Some(Section {
        title: "Surfaces from slices, against the analytic shapes".to_owned(),
        text: vec![
            "The phantom's bones are cut by sagittal planes, their contours lofted, and the surface is held against the solid's own \
             function. **Exact contours** come from a mesh of 200,000 points, with points as far apart as the row says first, in \
             slices as far apart as it says second. **Labels** are voxels that the bone fills by half or more. **MRI** has a dark \
             cortical shell, partial volume, a gain that changes by 8 percent, 5 percent of noise, fat displaced by a voxel along the \
             columns and 12 bits; its contours come from one seed in the marrow. Nothing but a label or that seed is given."
                .to_owned(),
            "Distances are those of 20,000 points spread evenly over the surface. The ends (two slices at either side, where a cap \
             closes the surface) are in a column of their own; the shafts are cut off across the slices, so their ends are in \
             the first three columns. *Volume* is the difference from the truth, *faults* counts what keeps the surface from being a \
             closed two-manifold without self-intersection."
                .to_owned(),
            "The order is that of the median error, 8 mm and more from the ends, while points and slices are refined together from 2 to \
             0.5 mm: 2 is what straight lines between points of a smooth surface allow."
                .to_owned(),
        ],
        tables: vec![table, orders],
        plots: Vec::new(),
    }))
}

/// Distances from the truth, and the row's figures.
fn found(surface: &Mesh, faults: usize, body: Body, fine: &Mesh, slice_mm: f64) -> Found {
    let (low, high) = fine.bounding_box();
    let margin = END_SLICES * slice_mm;
    let all = distances(surface, body.solid());
    let sizes: Vec<f64> = all.iter().map(|(_, d)| d.abs()).collect();
    let away = |mm: f64| {
        let within = all.iter().filter(|(p, _)| p.x > low.x + mm && p.x < high.x - mm);
        Spread::of(&within.map(|(_, d)| d.abs()).collect::<Vec<_>>())
    };
    let inner = away(margin);
    let volume = 100.0 * (surface.signed_volume() / fine.signed_volume() - 1.0);
    let cells = vec![
        Cell::Number(inner.median),
        Cell::Number(inner.p95),
        Cell::Number(inner.worst),
        Cell::Number(Spread::of(&sizes).worst),
        Cell::Number(volume),
        Cell::Number(faults as f64),
    ];
    Found { middle: away(MIDDLE_MM), cells }
}
