//! Edges of real frames beside those of OpenCV and scikit-image: do three programs see the same edges?
//!
//! On each frame all three smooth with the same sigma and have as many edge pixels: the high threshold is searched for, the low one
//! is 0.4 of it. The boundary F-measure of two sets of pixels is the harmonic mean of the shares of each that have a pixel
//! of the other within 1 px. Needs the real data, and a Python (`BIPLANE_PYTHON`, or `python3`) with `cv2` and `skimage`.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use biplane_acquisition::images::read_frame;
use biplane_artifact::Frame;
use biplane_segmentation::{SegmentParams, edges_of};

use crate::sections::SectionError;
use crate::table::{Cell, Column, Row, Table};
use crate::{Lab, SceneError, Section};

/// Folders of frames, by the name of their row.
const FRAMES: [(&str, &[&str]); 3] = [
    ("knee implant in vivo, biplane", &["knee-implant-biplane/cam1", "knee-implant-biplane/cam2"]),
    ("natural knee in vivo, biplane", &["knee-natural-biplane/cam1", "knee-natural-biplane/cam2"]),
    ("knee implant in vivo, one view", &["knee-implant-single"]),
];
/// Where they are, from the project's folder.
const REAL: &str = "../shared/data/real";
/// Frames of each row at most.
const FEW: usize = 4;
/// Low threshold over the high one.
const LOW: f64 = 0.4;

/// Reads width, height, sigma and our number of edge pixels, then the frame (8 bit) and our edge pixels (0 or 1); prints the three
/// measures: ours and OpenCV, ours and scikit-image, OpenCV and scikit-image.
const PYTHON: &str = r"
import sys
import cv2, numpy
from skimage import feature
w, h, sigma, wanted = sys.stdin.buffer.readline().split()
w, h, sigma, wanted = int(w), int(h), float(sigma), int(wanted)
data = numpy.frombuffer(sys.stdin.buffer.read(), numpy.uint8).reshape(2, h, w)
frame, ours = data[0], data[1] > 0
inside = numpy.zeros((h, w), bool)
inside[2:-2, 2:-2] = True
def equal(edges):
    low, high = 0.3, 600.0
    for _ in range(13):
        middle = (low * high) ** 0.5
        if (edges(middle) & inside).sum() > wanted:
            low = middle
        else:
            high = middle
    return edges(high) & inside
smooth = cv2.GaussianBlur(frame, (0, 0), sigma)
opencv = equal(lambda t: cv2.Canny(smooth, 0.4 * t, t, L2gradient=True) > 0)
floats = frame.astype(float)
scikit = equal(lambda t: feature.canny(floats, sigma, 0.4 * t, t))
disc = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
def measure(a, b):
    near = lambda e: cv2.dilate(e.astype(numpy.uint8), disc) > 0
    precision, recall = (a & near(b)).sum() / max(a.sum(), 1), (b & near(a)).sum() / max(b.sum(), 1)
    return 2 * precision * recall / max(precision + recall, 1e-9)
print(measure(ours, opencv), measure(ours, scikit), measure(opencv, scikit))
";

/// Frames of a folder, sorted.
fn frames(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let mut paths: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    paths.retain(|p| p.extension().is_some_and(|e| e.eq_ignore_ascii_case("tif")));
    paths.sort();
    paths
}

/// Our edge pixels, where their share of all is nearest to the one wanted.
fn ours(frame: &Frame, sigma: f64, share: f64) -> Vec<u8> {
    let wanted = share * (frame.width * frame.height) as f64;
    let edges = |high: f64| {
        let thresholds =
            SegmentParams { high_threshold: high, low_threshold: LOW * high, ..SegmentParams::default() };
        edges_of(frame, None, &SegmentParams { smoothing_px: sigma, ..thresholds })
    };
    let (mut low, mut high) = (1e-3_f64, 1e3_f64);
    for _ in 0..24 {
        let middle = (low * high).sqrt();
        if edges(middle).points.len() as f64 > wanted { low = middle } else { high = middle }
    }
    let mut pixels = vec![0; frame.width * frame.height];
    for pixel in edges(high).pixels {
        pixels[pixel as usize] = 1;
    }
    pixels
}

/// The three measures of a frame; `None` where Python or what it needs is missing.
fn measures(frame: &Frame, sigma: f64, share: f64) -> Option<[f64; 3]> {
    let scale = 255.0 / f64::from((1_u32 << frame.bits) - 1);
    let eight = |v: &u16| (f64::from(*v) * scale).round() as u8;
    let bytes: Vec<u8> = frame.samples.iter().map(eight).collect();
    let frame = Frame { samples: bytes.iter().map(|b| u16::from(*b)).collect(), bits: 8, ..*frame };
    let ours = ours(&frame, sigma, share);
    let count: usize = ours.iter().map(|v| usize::from(*v)).sum();
    let python = std::env::var("BIPLANE_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let mut child = Command::new(python)
        .args(["-c", PYTHON])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .ok()?;
    let mut input = child.stdin.take()?;
    writeln!(input, "{} {} {sigma} {count}", frame.width, frame.height).ok()?;
    input.write_all(&bytes).and_then(|()| input.write_all(&ours)).ok()?;
    drop(input);
    let output = child.wait_with_output().ok().filter(|o| o.status.success())?;
    let text = String::from_utf8(output.stdout).ok()?;
    let mut numbers = text.split_whitespace().map(str::parse::<f64>);
    let mut next = || numbers.next()?.ok();
    Some([next()?, next()?, next()?])
}

/// Measures the agreement, where the real frames and the other programs are present.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let mut rows = Vec::new();
    for (name, folders) in FRAMES {
        let paths: Vec<PathBuf> = folders.iter().flat_map(|f| frames(&lab.root.join(REAL).join(f))).collect();
        let some = paths.iter().step_by(paths.len().div_ceil(lab.count(FEW, 1)).max(1));
        let frames: Vec<Frame> =
            some.map(|p| read_frame(p, 0).map_err(SceneError::from)).collect::<Result<_, _>>()?;
        for (sigma, share) in [(1.0, 0.02), (2.0, 0.02), (2.0, 0.05)] {
            let mut sums = [0.0; 3];
            for frame in &frames {
                let Some(found) = measures(frame, sigma, share) else { return Ok(None) };
                sums.iter_mut().zip(found).for_each(|(s, f)| *s += f / frames.len() as f64);
            }
            if !frames.is_empty() {
                let label = format!("{name}, sigma {sigma} px, {:.0} % of pixels", 100.0 * share);
                let above = sums[0].min(sums[1]) - sums[2];
                rows.push(Row::ours(label, sums.into_iter().chain([above]).map(Cell::Number).collect()));
            }
        }
    }
    if rows.is_empty() {
        return Ok(None);
    }
    let columns = [
        "ours and OpenCV",
        "ours and scikit-image",
        "OpenCV and scikit-image",
        "lesser of ours, less theirs",
    ];
    let columns = columns.into_iter().map(|c| Column::at_least(c, 3)).collect();
    Ok(Some(Section {
        title: "Edges of real frames, beside OpenCV's and scikit-image's".to_owned(),
        text: vec![
            "Boundary F-measure at 1 px of the edge pixels of two programs (1: all the same), mean over frames, all with the same smoothing and as \
             many edge pixels. What to look for: ours agree with each of the others at least as well as those do with each other. \
             The frames are not part of this project; without them, or without a Python with `cv2` and `skimage`, this section is left \
             out."
                .to_owned(),
        ],
        tables: vec![Table { id: "agreement".to_owned(), heading: "frames".to_owned(), columns, rows }],
        plots: Vec::new(),
    }))
}
