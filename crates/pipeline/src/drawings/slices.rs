//! A contact sheet: the slices of a volume, cut to the bone, with its contours over them.
//!
//! Slices beyond the bone are left out, but one at either end. Where there are more than [`MOST`], every so many-th is shown and all
//! that are flagged or drawn by a person. All have the same grey levels, and the shape that voxels have in mm.

use biplane_artifact::{ContourSlice, Drawing, SliceContour, SliceContours, Volume};
use biplane_slices::{Across, turned};
use biplane_stage::{Context, Stage, inputs};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use serde::{Deserialize, Serialize};

use super::colours::{INK, MISSING, REJECTED, STRAY, USED};
use super::svg::{Font, Style, Svg, text_width};
use super::{DrawingError, base64};

/// Width of the sheet.
const WIDTH: f64 = 1600.0;
/// Room at the edge and between slices.
const GAP: f64 = 10.0;
/// Height of the title.
const TITLE: f64 = 64.0;
/// Slices that are shown one by one.
const MOST: usize = 64;
/// Slices in a row at most.
const IN_A_ROW: usize = 8;
/// What is shown around the bone, mm.
const MARGIN_MM: f64 = 6.0;
/// Share of the samples that may be darker than black, and brighter than white.
const CUT: f64 = 0.005;
/// The level of white: bright marks must stand out of it.
const WHITE: f64 = 215.0;

inputs! {
    /// A volume and the contours of a bone in its slices.
    pub struct SliceDrawingInputs {
        volume: Volume,
        contours: SliceContours,
    }
}

/// Which bone, and which way the volume is cut.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SliceDrawingParams {
    /// Name of the bone, for the title.
    pub bone: String,
    /// `across` of the bone.
    pub across: Across,
}

/// The stage `draw-slices`: [`slice_drawing`].
#[derive(Debug, Clone, Copy)]
pub struct DrawSlices;

impl Stage for DrawSlices {
    const NAME: &'static str = "draw-slices";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = SliceDrawingInputs;
    type Params = SliceDrawingParams;
    type Output = Drawing;
    type Error = DrawingError;

    fn run(
        inputs: &SliceDrawingInputs,
        params: &SliceDrawingParams,
        _: &Context,
    ) -> Result<Drawing, DrawingError> {
        slice_drawing(&inputs.volume, &inputs.contours, params).map(Drawing)
    }
}

/// The part of the slices that is shown: first and last pixel along `i` and `j`, and a pixel's sides in mm.
struct Cut {
    first: [usize; 2],
    last: [usize; 2],
    pixel_mm: [f64; 2],
}

/// The sheet.
///
/// # Errors
/// The contours are of another volume, or the volume cannot be cut this way.
pub fn slice_drawing(
    volume: &Volume,
    contours: &SliceContours,
    params: &SliceDrawingParams,
) -> Result<String, DrawingError> {
    let volume = turned(volume, params.across)?;
    let of = [volume.columns, volume.rows];
    if of != [contours.columns, contours.rows] || volume.origins_mm.len() != contours.slices.len() {
        return Err(DrawingError::Size { frame: of, artifact: [contours.columns, contours.rows] });
    }
    let cut = Cut::around(contours);
    let shown = shown(&contours.slices);
    let levels = levels(&volume, &cut, &shown);
    let extent: [f64; 2] = std::array::from_fn(|a| (cut.last[a] - cut.first[a] + 1) as f64 * cut.pixel_mm[a]);
    let columns = shown.len().clamp(1, IN_A_ROW);
    let width = ((WIDTH - GAP) / columns as f64 - GAP).min(480.0);
    let height = width * extent[1] / extent[0];
    let mut svg = Svg::default();
    title(&mut svg, contours, &shown, params);
    for (place, &slice) in shown.iter().enumerate() {
        let (column, row) = (place % columns, place / columns);
        let corner = [GAP + column as f64 * (width + GAP), TITLE + row as f64 * (height + GAP)];
        let Some(samples) = volume.slice(slice) else { continue };
        let png = picture(samples, volume.columns, &cut, levels, width)?;
        cell(&mut svg, &cut, [corner, [width, height]], extent, &png, (slice, &contours.slices[slice]));
    }
    let rows = shown.len().div_ceil(columns) as f64;
    Ok(svg.into_page([WIDTH, (TITLE + rows * (height + GAP)).ceil()]))
}

impl Cut {
    fn around(contours: &SliceContours) -> Self {
        let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
        let pixel_mm = [length(contours.column_step_mm), length(contours.row_step_mm)];
        let most = [contours.columns, contours.rows].map(|n| n.saturating_sub(1));
        let points = || contours.slices.iter().flat_map(|s| &s.contours).flat_map(|c| &c.points);
        let (mut first, mut last) = ([0; 2], most);
        for a in 0..2 {
            let along = || points().map(|p| [p.i, p.j][a]);
            let low = along().fold(f64::INFINITY, f64::min);
            let high = along().fold(f64::NEG_INFINITY, f64::max);
            if low <= high {
                let room = MARGIN_MM / pixel_mm[a];
                // Casting from a float saturates.
                first[a] = ((low - room).floor().max(0.0) as usize).min(most[a]);
                last[a] = ((high + room).ceil().max(0.0) as usize).clamp(first[a], most[a]);
            }
        }
        Self { first, last, pixel_mm }
    }
}

/// The slices to show.
fn shown(slices: &[ContourSlice]) -> Vec<usize> {
    let marked = |s: &ContourSlice| !s.flags.is_empty() || s.edited;
    let used = |s: &ContourSlice| !s.contours.is_empty() || marked(s);
    let first = slices.iter().position(used).unwrap_or(0).saturating_sub(1);
    let last = slices.iter().rposition(used).map_or(slices.len(), |n| (n + 2).min(slices.len()));
    let every = (last - first).div_ceil(MOST).max(1);
    (first..last).filter(|n| (n - first) % every == 0 || marked(&slices[*n])).collect()
}

/// The grey levels to show as black and white, of all shown slices within the cut.
fn levels(volume: &Volume, cut: &Cut, shown: &[usize]) -> [f32; 2] {
    let mut all: Vec<f32> = Vec::new();
    for samples in shown.iter().filter_map(|k| volume.slice(*k)) {
        for row in samples.chunks(volume.columns.max(1)).take(cut.last[1] + 1).skip(cut.first[1]) {
            all.extend(row.iter().take(cut.last[0] + 1).skip(cut.first[0]));
        }
    }
    all.sort_by(f32::total_cmp);
    let at = |share: f64| all.get(((all.len().max(1) - 1) as f64 * share) as usize).copied().unwrap_or(0.0);
    [at(CUT), at(1.0 - CUT)]
}

/// The cut part of a slice as PNG, with means over as many pixels as the sheet cannot show apart.
fn picture(
    samples: &[f32],
    columns: usize,
    cut: &Cut,
    [black, white]: [f32; 2],
    width: f64,
) -> Result<String, DrawingError> {
    let size = [0, 1].map(|a| cut.last[a] - cut.first[a] + 1);
    let step = ((size[0] as f64 / (1.5 * width)).ceil() as usize).max(1);
    let small = size.map(|n| n.div_ceil(step));
    let range = f64::from(white - black).max(f64::MIN_POSITIVE);
    let mut bytes = Vec::with_capacity(small[0] * small[1]);
    for row in 0..small[1] {
        for column in 0..small[0] {
            let part = |n: usize, a: usize| {
                let low = cut.first[a] + n * step;
                low..(low + step).min(cut.last[a] + 1)
            };
            let (along, down) = (part(column, 0), part(row, 1));
            let number = (along.len() * down.len()).max(1) as f64;
            let of_row = |j: usize| samples.get(j * columns + along.start..j * columns + along.end);
            let sum: f64 = down.filter_map(of_row).flatten().map(|s| f64::from(*s)).sum();
            let share = ((sum / number - f64::from(black)) / range).clamp(0.0, 1.0);
            // In steps of 4: nobody sees them, and the file is far smaller.
            bytes.push((share * WHITE) as u8 & !3);
        }
    }
    let mut png = Vec::new();
    PngEncoder::new_with_quality(&mut png, CompressionType::Best, FilterType::Adaptive).write_image(
        &bytes,
        small[0] as u32,
        small[1] as u32,
        ExtendedColorType::L8,
    )?;
    Ok(base64::encode(&png))
}

fn title(svg: &mut Svg, contours: &SliceContours, shown: &[usize], params: &SliceDrawingParams) {
    let count = contours.slices.len();
    let with = contours.slices.iter().filter(|s| !s.contours.is_empty()).count();
    let ends = shown.first().zip(shown.last()).map_or(String::new(), |(a, b)| format!(", shown {a} to {b}"));
    let some = if shown.len() < with { " (not every one)" } else { "" };
    let text = format!("{}: {count} slices, {with} with the bone{ends}{some}", params.bone);
    svg.text([GAP, 26.0], Font::new(20.0, INK).bold(), &text);
    let mut x = GAP;
    for (colour, word) in
        [(USED, "bone inside"), (STRAY, "hole"), (REJECTED, "look at it"), (MISSING, "drawn by hand")]
    {
        svg.group(Style::area("swatch", colour), |svg| svg.rectangle([x, 40.0], [26.0, 12.0]));
        svg.text([x + 34.0, 51.0], Font::new(14.0, INK), word);
        x += 170.0;
    }
}

/// One slice: its picture, its contours, its number, its flags.
fn cell(
    svg: &mut Svg,
    cut: &Cut,
    [corner, size]: [[f64; 2]; 2],
    extent: [f64; 2],
    png: &str,
    (number, slice): (usize, &ContourSlice),
) {
    let first: [f64; 2] = std::array::from_fn(|a| (cut.first[a] as f64 - 0.5) * cut.pixel_mm[a]);
    let unit = extent[0] / size[0];
    svg.window(corner, size, first, extent, |svg| {
        svg.png(first, extent, png);
        let mm = |c: &SliceContour| -> Vec<[f64; 2]> {
            c.points.iter().map(|p| [p.i * cut.pixel_mm[0], p.j * cut.pixel_mm[1]]).collect()
        };
        for (class, colour, hole) in [("bone", USED, false), ("hole", STRAY, true)] {
            let rings: Vec<_> = slice.contours.iter().filter(|c| c.is_hole() == hole).map(mm).collect();
            if !rings.is_empty() {
                svg.group(Style::line(class, colour, 1.3 * unit), |svg| svg.strokes(&rings, true));
            }
        }
    });
    let (class, colour) = match (slice.flags.is_empty(), slice.edited) {
        (false, _) => ("flagged", REJECTED),
        (true, true) => ("edited", MISSING),
        (true, false) => ("", ""),
    };
    if !class.is_empty() {
        svg.group(Style::line(class, colour, 3.0), |svg| {
            svg.rectangle(corner.map(|v| v + 1.5), size.map(|v| v - 3.0));
        });
        let mut words: Vec<&str> = slice.flags.iter().rev().map(|f| crate::slices::words(*f)).collect();
        if slice.edited {
            words.push("drawn by hand");
        }
        for (line, word) in words.iter().enumerate() {
            let low = corner[1] + size[1] - 21.0 * line as f64;
            svg.group(Style::area("tab", colour), |svg| {
                svg.rectangle([corner[0], low - 22.0], [text_width(word, 14.0) + 14.0, 22.0]);
            });
            svg.text([corner[0] + 7.0, low - 6.0], Font::new(14.0, "#ffffff").bold(), word);
        }
    }
    let number_font = Font { edged: true, ..Font::new(15.0, "#ffffff").bold() };
    svg.text([corner[0] + 7.0, corner[1] + 20.0], number_font, &number.to_string());
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_artifact::{SliceFlag, SlicePoint};

    /// Slices of 30 x 20 pixels with a square in those from `first` on.
    fn sample(count: usize, first: usize) -> (Volume, SliceContours) {
        let origins_mm: Vec<[f64; 3]> = (0..count).map(|k| [0.0, 0.0, k as f64]).collect();
        let corners = [[14.0, 8.0], [18.0, 8.0], [18.0, 12.0], [14.0, 12.0]];
        let square = corners.map(|[i, j]| SlicePoint::rounded(i, j, 0.1)).to_vec();
        let slice = |(k, origin_mm): (usize, &[f64; 3])| ContourSlice {
            origin_mm: *origin_mm,
            contours: if k < first { vec![] } else { vec![SliceContour { points: square.clone() }] },
            flags: vec![],
            edited: false,
        };
        let contours = SliceContours {
            columns: 30,
            rows: 20,
            column_step_mm: [0.5, 0.0, 0.0],
            row_step_mm: [0.0, 1.0, 0.0],
            slices: origins_mm.iter().enumerate().map(slice).collect(),
            warnings: vec![],
        };
        let volume = Volume {
            columns: 30,
            rows: 20,
            column_step_mm: [0.5, 0.0, 0.0],
            row_step_mm: [0.0, 1.0, 0.0],
            samples: (0..600 * count).map(|n| (n % 251) as f32).collect(),
            origins_mm,
        };
        (volume, contours)
    }

    #[test]
    fn every_slice_is_shown_where_they_are_few_and_all_that_are_marked_where_they_are_many() {
        let (_, contours) = sample(20, 5);
        assert_eq!(shown(&contours.slices), (4..20).collect::<Vec<_>>(), "one before the bone");
        let (_, mut contours) = sample(200, 0);
        contours.slices[33].flags.push(SliceFlag::Lost);
        contours.slices[34].edited = true;
        let few = shown(&contours.slices);
        assert_eq!(few[..12], [0, 4, 8, 12, 16, 20, 24, 28, 32, 33, 34, 36]);
        let (_, contours) = sample(3, 9);
        assert_eq!(shown(&contours.slices), [0, 1, 2], "where the bone is nowhere, all");
    }

    #[test]
    fn the_sheet_is_cut_to_the_bone_in_mm_and_says_what_to_look_at() {
        let (volume, mut contours) = sample(3, 1);
        contours.slices[1].flags = vec![SliceFlag::Jumped, SliceFlag::TouchesBorder];
        contours.slices[2].edited = true;
        let cut = Cut::around(&contours);
        // The square with 6 mm around it: 12 pixels along i, 6 along j.
        assert_eq!((cut.first, cut.last), ([2, 2], [29, 18]));
        let params = SliceDrawingParams { bone: "a<b".into(), across: Across::Stored };
        let svg = slice_drawing(&volume, &contours, &params).unwrap();
        assert!(
            svg.contains("a&lt;b: 3 slices, 2 with the bone")
                && svg.contains(">jumped<")
                && svg.contains(">touches the border<")
        );
        assert_eq!(svg.matches("class=\"edited\"").count(), 1);
        // In mm: i is halved, j is not.
        assert_eq!(svg.matches("M7 8L9 8L9 12L7 12Z").count(), 2);
        let (other, _) = sample(4, 1);
        assert!(matches!(slice_drawing(&other, &contours, &params), Err(DrawingError::Size { .. })));
    }
}
