//! One picture of the frame of beads with what was found in it: beads by name, strays, beads that were not found.

use biplane_artifact::{BeadList, Environment, Frame, SeenBead, ViewEnvironment};
use biplane_geometry::{Point3, Pose, Vector3};

use super::arrows::Magnified;
use super::backdrop::Backdrop;
use super::colours::{ARROW, INK, Level, MISSING, REJECTED, STRAY, USED};
use super::labels::Labels;
use super::legend::{Mark, legend};
use super::sheet::{Heading, MARGIN, Row, SMALL, WIDTH, facts, quantity, sheet, shortened, table};
use super::svg::{Font, Style, Svg};
use super::{BeadDrawingParams, DrawingError};

/// Where the numbers beside the picture begin.
const BESIDE: f64 = 736.0;
/// The worst beads that the table lists.
const WORST: usize = 12;

/// What one picture shows: a mark, its place (recorded px), its name.
struct Named<'a> {
    at_px: [f64; 2],
    radius_px: f64,
    name: &'a str,
    colour: &'static str,
}

/// A picture of the beads as backdrop, each bead with its name and its residual, spots that are no bead, beads that were not found,
/// the numbers and the verdict.
///
/// # Errors
/// The environment has no such view, or the frame is not of its size, or is none.
pub fn bead_drawing(
    frame: &Frame,
    environment: &Environment,
    beads: &BeadList,
    params: &BeadDrawingParams,
) -> Result<String, DrawingError> {
    let views = environment.views.len();
    let view = environment.views.get(params.view).ok_or(DrawingError::View { view: params.view, views })?;
    if [frame.width, frame.height] != view.size {
        return Err(DrawingError::Size { frame: [frame.width, frame.height], artifact: view.size });
    }
    let backdrop = Backdrop::new(frame)?;
    let shown = Shown::new(environment, view, beads, params.picture);
    let heading = Heading {
        title: match environment.bead_frames.len() {
            0 | 1 => format!("View {}: the frame of beads", shortened(&view.view, 24)),
            n => format!(
                "View {}: the frame of beads, picture {} of {n}",
                shortened(&view.view, 24),
                params.picture + 1
            ),
        },
        caption: format!(
            "residual {} rms over the view's beads (limit {}), standard deviation {}, {} of {} beads here used",
            quantity(view.reprojection_rms_px, 3, "px"),
            quantity(params.max_reprojection_px, 3, "px"),
            quantity(view.sigma_px, 3, "px"),
            shown.used.len(),
            beads.0.len(),
        ),
        verdict: environment.verdict,
        warnings: &environment.warnings,
    };
    Ok(sheet(&heading, |svg, top| {
        let (size, scale) = backdrop.fitted([BESIDE - 2.0 * MARGIN, 900.0]);
        let magnified = shown.magnified(frame.width);
        backdrop.draw(svg, [MARGIN, top], size, |svg| {
            shown.draw(svg, &magnified, 1.0 / scale, [frame.width, frame.height].map(|v| v as f64));
        });
        let below = shown.beside(svg, view, params, top);
        let bar = top + size[1] + 20.0;
        magnified.bar(svg, [MARGIN, bar], scale, INK, SMALL);
        below.max(bar + 6.0)
    }))
}

/// What one picture of a view shows.
struct Shown<'a> {
    used: Vec<(&'a SeenBead, f64)>,
    unused: Vec<(&'a SeenBead, f64)>,
    strays: Vec<[f64; 2]>,
    missing: Vec<(&'a str, [f64; 2], f64)>,
}

impl<'a> Shown<'a> {
    fn new(
        environment: &Environment,
        view: &'a ViewEnvironment,
        beads: &'a BeadList,
        picture: usize,
    ) -> Self {
        let pose = environment.bead_frames.get(picture).map_or_else(Pose::identity, |p| (*p).into());
        let radius = |bead: usize| ring_px(view, beads, bead, &pose);
        let of = |used: bool| {
            let seen = view.beads.iter().filter(|b| b.picture == picture && b.used == used);
            seen.map(|b| (b, radius(b.bead))).collect()
        };
        let missing = view.missing.iter().filter(|m| m.0 == picture);
        Self {
            used: of(true),
            unused: of(false),
            strays: view.strays.iter().filter(|s| s.0 == picture).map(|s| s.1).collect(),
            missing: missing
                .map(|(_, bead, at)| {
                    (beads.0.get(*bead).map_or("?", |b| b.name.as_str()), *at, radius(*bead))
                })
                .collect(),
        }
    }

    fn magnified(&self, width: usize) -> Magnified {
        Magnified::of(self.used.iter().map(|(b, _)| length(b.residual_px)), 0.045 * width as f64)
    }

    fn draw(&self, svg: &mut Svg, magnified: &Magnified, unit: f64, extent: [f64; 2]) {
        let rings = |svg: &mut Svg, class, colour, width, beads: &[(&SeenBead, f64)]| {
            svg.group(Style::line(class, colour, width * unit), |svg| {
                beads.iter().for_each(|(b, r)| svg.circle(b.at_px, *r));
            });
        };
        rings(svg, "used", USED, 1.5, &self.used);
        rings(svg, "unused", REJECTED, 3.0, &self.unused);
        svg.group(Style::line("strays", STRAY, 3.0 * unit), |svg| {
            self.strays.iter().for_each(|p| svg.cross(*p, 10.0 * unit));
        });
        svg.group(Style::line("missing", MISSING, 3.0 * unit), |svg| {
            self.missing.iter().for_each(|(_, at, r)| svg.circle(*at, *r));
        });
        for (class, colour, beads) in
            [("arrows", ARROW, &self.used), ("arrows-unused", REJECTED, &self.unused)]
        {
            svg.group(Style::line(class, colour, 2.0 * unit), |svg| {
                beads
                    .iter()
                    .for_each(|(b, _)| svg.strokes(&magnified.arrow(b.at_px, b.residual_px).0, false));
            });
        }
        let named = self.named();
        let arrows = self.used.iter().chain(&self.unused).flat_map(|(b, _)| {
            let (strokes, _) = magnified.arrow(b.at_px, b.residual_px);
            strokes.into_iter().flatten().map(|p| (p, 3.0 * unit))
        });
        let marks = named.iter().map(|n| (n.at_px, n.radius_px)).chain(arrows);
        let mut labels = Labels::new([-0.5, -0.5], extent, marks);
        let size = 15.0 * unit;
        svg.group(Style::area("names", USED), |svg| {
            for Named { at_px, radius_px, name, colour } in named {
                let name = shortened(name, 16);
                let at = labels.place(at_px, radius_px, &name, size);
                svg.text(at, Font::new(size, colour).bold().edged(), &name);
            }
        });
    }

    fn named(&self) -> Vec<Named<'_>> {
        let seen = |beads: &'_ [(&'a SeenBead, f64)], colour| -> Vec<Named<'a>> {
            let named =
                |(b, r): &(&'a SeenBead, f64)| Named { at_px: b.at_px, radius_px: *r, name: &b.name, colour };
            beads.iter().map(named).collect()
        };
        let missing = self.missing.iter();
        let missing = missing.map(|(name, at, r)| Named { at_px: *at, radius_px: *r, name, colour: MISSING });
        seen(&self.unused, REJECTED).into_iter().chain(missing).chain(seen(&self.used, "#ffffff")).collect()
    }

    /// What stands beside the picture; returns where it ends.
    fn beside(&self, svg: &mut Svg, view: &ViewEnvironment, params: &BeadDrawingParams, top: f64) -> f64 {
        let entries = [
            (Mark::Ring, USED, "beads used", Some(self.used.len())),
            (Mark::Ring, REJECTED, "beads left out", Some(self.unused.len())),
            (Mark::Cross, STRAY, "spots that are no bead", Some(self.strays.len())),
            (Mark::Ring, MISSING, "beads not found", Some(self.missing.len())),
            (Mark::Arrow, ARROW, "residual: found less expected", None),
        ];
        let y = legend(svg, [BESIDE, top], &entries);
        let limit = params.max_reprojection_px;
        let of_used = |pick: &dyn Fn(f64, f64) -> f64| {
            self.used.iter().map(|(b, _)| length(b.residual_px)).fold(0.0, pick)
        };
        let squares = of_used(&|sum, l| sum + l * l);
        let here = (squares / self.used.len() as f64).sqrt();
        let lines = [
            (
                "residual of the view, rms",
                quantity(view.reprojection_rms_px, 3, "px"),
                Level::of(view.reprojection_rms_px, limit),
            ),
            ("limit", quantity(limit, 3, "px"), Level::Plain),
            ("in this picture, rms", quantity(here, 3, "px"), Level::Plain),
            ("largest of those used", quantity(of_used(&f64::max), 3, "px"), Level::Plain),
            ("source to detector", quantity(view.source_to_detector_mm, 1, "mm"), Level::Plain),
        ];
        let y = facts(svg, [BESIDE, y], WIDTH - MARGIN - BESIDE, &lines);
        let mut worst: Vec<&SeenBead> = self.used.iter().chain(&self.unused).map(|(b, _)| *b).collect();
        worst.sort_by(|a, b| length(b.residual_px).total_cmp(&length(a.residual_px)));
        let rows: Vec<Row> = worst
            .iter()
            .take(WORST)
            .map(|b| {
                let level = if b.used { Level::Plain } else { Level::Bad };
                let cells = [
                    shortened(&b.name, 14),
                    quantity(b.residual_px[0], 3, ""),
                    quantity(b.residual_px[1], 3, ""),
                    if b.used { "used" } else { "left out" }.to_owned(),
                ];
                Row { cells: cells.map(|c| (c, level)).into(), bold: false }
            })
            .collect();
        let names = ["largest, px", "x", "y", ""];
        table(svg, [BESIDE, y + 16.0], &names, &[120.0, 180.0, WIDTH - MARGIN - BESIDE], &rows)
    }
}

fn length(residual: [f64; 2]) -> f64 {
    residual[0].hypot(residual[1])
}

/// Radius of the ring about a bead: a little more than the bead's own in the picture, where that is known.
fn ring_px(view: &ViewEnvironment, beads: &BeadList, bead: usize, pose: &Pose) -> f64 {
    let width = view.size[0].max(view.size[1]) as f64;
    let own = beads.0.get(bead).and_then(|b| {
        let from_source = pose.transform(&Point3::from(b.at_mm)).coords - Vector3::from(view.source);
        let depth = Vector3::from(view.matrix[2]).dot(&from_source);
        b.radius_mm.map(|r| r * view.source_to_detector_mm / (depth * view.pixel_mm))
    });
    let own = own.filter(|r| r.is_finite() && *r > 0.0).unwrap_or(0.006 * width);
    (1.15 * own + 0.004 * width).min(0.1 * width)
}
