//! The panel of a model that shows the contours of the slices it was made from, on the mesh: those that want a look stand out.

use std::collections::BTreeMap;

use biplane_artifact::{SliceContours, SliceFlag, SurfaceReport};
use biplane_geometry::Point3;

use super::DrawingError;
use super::camera::{Camera, Viewpoint};
use super::colours::INK;
use super::labels::Labels;
use super::model::{Body, PANEL, framed, pictured, scale_bar};
use super::shaded::{FINE, Paint, shaded};
use super::sheet::{SMALL, shortened};
use super::svg::{Font, Style, Svg, text_width};

/// Slices that are drawn, chosen evenly.
const MOST_SLICES: usize = 60;
/// Slices, or runs of them, that are named.
const MOST_NAMED: usize = 10;
/// Colours of slices of which nothing is said, that meet the volume's border, that are alarming.
const SLICES: [&str; 3] = ["#0b6fae", "#b35900", "#d3202c"];

/// What is said of a slice.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct Said {
    words: Vec<String>,
    /// Whether it is something to look at, and not only that the bone goes on beyond the volume.
    alarming: bool,
}

/// The flags of the slices, and the faults of the surface beside them.
fn said(contours: &SliceContours, surface: Option<&SurfaceReport>) -> BTreeMap<usize, Said> {
    let mut said: BTreeMap<usize, Said> = BTreeMap::new();
    for (k, slice) in contours.slices.iter().enumerate() {
        for flag in &slice.flags {
            let of_slice = said.entry(k).or_default();
            of_slice.words.push(crate::slices::words(*flag).to_owned());
            of_slice.alarming |= !matches!(flag, SliceFlag::TouchesBorder | SliceFlag::CutOff);
        }
    }
    for fault in surface.iter().flat_map(|s| &s.faults) {
        if let Some(slice) = fault.slice {
            let of_slice = said.entry(slice).or_default();
            of_slice.words.push(fault.what.clone());
            of_slice.alarming = true;
        }
    }
    said
}

/// Which slices are shown: evenly chosen ones, and all that are alarming.
fn shown_slices(contours: &SliceContours, said: &BTreeMap<usize, Said>) -> Vec<usize> {
    let with: Vec<usize> =
        (0..contours.slices.len()).filter(|k| !contours.slices[*k].contours.is_empty()).collect();
    let every = with.len().div_ceil(MOST_SLICES).max(1);
    let alarming = |k: &usize| said.get(k).is_some_and(|s| s.alarming);
    let chosen = |n: usize, k: &usize| n.is_multiple_of(every) || n + 1 == with.len() || alarming(k);
    with.iter().enumerate().filter(|(n, k)| chosen(*n, k)).map(|(_, k)| *k).collect()
}

/// The points of a contour that are apart in the picture.
fn thinned(points: Vec<[f64; 3]>, camera: &Camera) -> Vec<Point3> {
    let mut kept: Vec<Point3> = Vec::new();
    let mut last = [f64::INFINITY; 2];
    for p in points.into_iter().map(Point3::from) {
        let at = camera.onto(&p);
        if (at[0] - last[0]).hypot(at[1] - last[1]) > 3.0 {
            kept.push(p);
            last = at;
        }
    }
    kept
}

/// The mesh with the contours it was made from.
pub(super) fn slices_panel(
    svg: &mut Svg,
    body: &Body,
    contours: &SliceContours,
    corner: [f64; 2],
) -> Result<(), DrawingError> {
    let said = said(contours, body.shown.surface);
    let slices = shown_slices(contours, &said);
    let title = format!("with the contours of its slices, {}", body.directions.name(Viewpoint::Corner));
    let inside = framed(svg, corner, PANEL, &title);
    let camera = body.camera(Viewpoint::Corner, PANEL, false);
    let picture = shaded(&body.shape, &camera, Paint::Plain { faded: 0.25 }, FINE)?;
    // Lines that are seen and that are hidden, of slices of which nothing is said, that meet the border, that are alarming.
    let mut lines: [[Vec<Vec<[f64; 2]>>; 2]; 3] = Default::default();
    let mut places: Vec<(usize, [f64; 2])> = Vec::new();
    for &k in &slices {
        let parts = &mut lines[kind(said.get(&k))];
        let mut leftmost: Option<[f64; 2]> = None;
        for c in 0..contours.slices[k].contours.len() {
            let line = thinned(contours.points_mm(k, c), &camera);
            for at in line.iter().map(|p| camera.onto(p)) {
                if leftmost.is_none_or(|l| at[0] < l[0]) {
                    leftmost = Some(at);
                }
            }
            let [seen, hidden] = picture.parted(&line, true);
            parts[0].extend(seen);
            parts[1].extend(hidden);
        }
        places.extend(leftmost.map(|at| (k, at)));
    }
    pictured(svg, inside, PANEL, &picture, |svg| {
        for (parts, colour) in lines.iter().zip(SLICES) {
            let faint = Style { opacity: 0.22, ..Style::line("contour-hidden", colour, 0.7) };
            if !parts[1].is_empty() {
                svg.group(faint, |svg| svg.strokes(&parts[1], false));
            }
        }
        for ((parts, colour), class) in
            lines.iter().zip(SLICES).zip(["contour", "contour-border", "contour-flagged"])
        {
            let width = if class == "contour-flagged" { 1.9 } else { 1.0 };
            if !parts[0].is_empty() {
                svg.group(Style::line(class, colour, width), |svg| svg.strokes(&parts[0], false));
            }
        }
        slice_names(svg, &places, &said);
        scale_bar(svg, &camera);
    });
    let note = match (slices.len(), contours.slices.iter().filter(|s| !s.contours.is_empty()).count()) {
        (0, _) => "there are no contours".to_owned(),
        (some, all) if some < all => format!("{some} of {all} slices"),
        (_, all) => format!("all {all} slices"),
    };
    let y = inside[1] + PANEL[1] + 19.0;
    let mut x = inside[0];
    for (colour, word) in SLICES.into_iter().zip([note.as_str(), "cut off by the volume", "look at it"]) {
        svg.group(Style::area("swatch", colour), |svg| svg.rectangle([x, y - 7.0], [22.0, 4.0]));
        svg.text([x + 28.0, y], Font::new(SMALL, INK), word);
        x += 28.0 + 0.9 * text_width(word, SMALL) + 22.0;
    }
    Ok(())
}

fn kind(said: Option<&Said>) -> usize {
    said.map_or(0, |s| if s.alarming { 2 } else { 1 })
}

/// The numbers of the first and last slice, and of runs of alarming slices with what is wrong with them.
fn slice_names(svg: &mut Svg, places: &[(usize, [f64; 2])], said: &BTreeMap<usize, Said>) {
    // First and last slice of each run, what is said, and where it is written.
    let mut runs: Vec<(usize, usize, Option<&Said>, [f64; 2])> = Vec::new();
    // Whether the slice before belongs to the last run.
    let mut goes_on = false;
    for (n, (k, at)) in places.iter().enumerate() {
        let what = said.get(k).filter(|s| s.alarming);
        match runs.last_mut() {
            Some(run) if goes_on && run.2 == what => run.1 = *k,
            _ if what.is_some() || n == 0 || n + 1 == places.len() => runs.push((*k, *k, what, *at)),
            _ => {}
        }
        goes_on = what.is_some();
    }
    // What is alarming first, so that it has the best places.
    runs.sort_by_key(|run| run.2.is_none());
    let mut labels = Labels::new([0.0, 0.0], PANEL, std::iter::empty());
    for (first, last, what, at) in runs.into_iter().take(MOST_NAMED) {
        let number =
            if first == last { format!("slice {first}") } else { format!("slices {first} to {last}") };
        let text = match what {
            Some(said) => shortened(&format!("{number}: {}", said.words.join(", ")), 44),
            None => number,
        };
        let [x, y] = labels.place(at, 3.0, &text, SMALL);
        svg.group(Style { opacity: 0.75, ..Style::area("tab", "#ffffff") }, |svg| {
            svg.rectangle([x - 2.0, y - 0.85 * SMALL], [0.9 * text_width(&text, SMALL) + 4.0, 1.1 * SMALL]);
        });
        svg.text([x, y], Font::new(SMALL, SLICES[kind(what)]).bold(), &text);
    }
}
