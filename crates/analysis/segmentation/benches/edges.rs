//! How long the edges of a 1024 x 1024 frame take on one core, beside OpenCV's 8-bit `GaussianBlur` and `Canny` at the same sigma:
//! `BIPLANE_PYTHON=python cargo bench -p biplane-segmentation`, where that python has `opencv-python-headless` (without it,
//! `python3` is tried, and without OpenCV ours is printed alone). The frame is the first of the example study, or the PNG that is named:
//! `cargo bench -p biplane-segmentation -- frame.png`.

use std::path::PathBuf;
use std::process::Command;
use std::time::Instant;

use biplane_artifact::Frame;
use biplane_grey::Grey;
use biplane_segmentation::{Method, SegmentParams, curves, edges_of, link};
use biplane_spline::{Smoothing, Spline};

/// Prints the least time of each in ms: blur, Canny with as many edge pixels as asked.
const OPENCV: &str = r"
import sys, time
import cv2
cv2.setNumThreads(1)
path, sigma, wanted = sys.argv[1], float(sys.argv[2]), int(sys.argv[3])
frame = cv2.imread(path, cv2.IMREAD_GRAYSCALE)
def least(of):
    times = []
    for _ in range(60):
        start = time.perf_counter()
        of()
        times.append(time.perf_counter() - start)
    return min(times) * 1e3
smooth = cv2.GaussianBlur(frame, (0, 0), sigma)
def canny(high):
    return cv2.Canny(smooth, 0.4 * high, high, L2gradient=True)
low, high = 1.0, 2000.0
for _ in range(30):
    middle = (low * high) ** 0.5
    if (canny(middle) > 0).sum() > wanted:
        low = middle
    else:
        high = middle
print(least(lambda: cv2.GaussianBlur(frame, (0, 0), sigma)), least(lambda: canny(high)), (canny(high) > 0).sum(), cv2.__version__)
";

/// The least time of many, ms.
fn least<T>(mut of: impl FnMut() -> T) -> f64 {
    let once = |_| {
        let start = Instant::now();
        std::hint::black_box(of());
        start.elapsed().as_secs_f64() * 1e3
    };
    (0..60).map(once).fold(f64::INFINITY, f64::min)
}

/// Blur and Canny of OpenCV, ms, and its edge pixels.
fn opencv(path: &std::path::Path, sigma: f64, points: usize) -> Option<(f64, f64, String)> {
    let python = std::env::var("BIPLANE_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let output = Command::new(python)
        .args(["-c", OPENCV])
        .arg(path)
        .args([sigma.to_string(), points.to_string()])
        .output()
        .ok()
        .filter(|o| o.status.success())?;
    let text = String::from_utf8(output.stdout).ok()?;
    let mut words = text.split_whitespace();
    Some((
        words.next()?.parse().ok()?,
        words.next()?.parse().ok()?,
        words.collect::<Vec<_>>().join(" edge pixels, OpenCV "),
    ))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let named = std::env::args().skip(1).find(|a| !a.starts_with('-')).map(PathBuf::from);
    let path = named.unwrap_or_else(|| root.join("fixtures/knee/frames/A/0000.png"));
    let picture = image::open(&path)?.into_luma8();
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let frame = Frame { width, height, samples: picture.iter().map(|v| u16::from(*v)).collect(), bits: 8 };
    println!("{}: {width} x {height}", path.file_name().unwrap_or_default().to_string_lossy());
    for smoothing_px in [1.0, 2.0] {
        let params = SegmentParams { smoothing_px, ..SegmentParams::default() };
        let map = edges_of(&frame, None, &params);
        println!("\nsigma {smoothing_px} px, {} edge points", map.points.len());
        let smooth = least(|| Grey::of_smoothed(&frame, smoothing_px));
        let smoothed = Grey::of_smoothed(&frame, smoothing_px);
        let noise = least(|| smoothed.noise_before_smoothing(smoothing_px));
        let edges = least(|| edges_of(&frame, None, &params));
        let linked = least(|| link(&map, &params));
        let whole = least(|| curves(&frame, None, &params));
        println!("{smooth:7.2} ms  8 bit to grey levels, smoothing");
        println!("{noise:7.2} ms  noise by level");
        println!("{:7.2} ms  gradient, crests, hysteresis, fractions of a pixel", edges - smooth - noise);
        println!("{edges:7.2} ms  edge points from the 8-bit frame");
        println!("{linked:7.2} ms  linking, bridging, correction of curved edges");
        println!("{whole:7.2} ms  all of it");
        // As neighbours share noise over the smoothing.
        let smoothing = Smoothing { correlated_points: 3.5 * smoothing_px.max(0.5), ..Smoothing::default() };
        let found = curves(&frame, None, &params)?;
        let splines = least(|| {
            let spline = |c: &biplane_geometry::Curve| {
                let places: Vec<_> = c.points.iter().map(|p| p.position).collect();
                let sigmas: Vec<_> = c.points.iter().map(|p| p.sigma_px).collect();
                Spline::near(&places, &sigmas, c.closed, smoothing)
            };
            found.0.iter().map(spline).filter(Result::is_ok).count()
        });
        println!("{splines:7.2} ms  splines near {} curves", found.0.len());
        match opencv(&path, smoothing_px, map.points.len()) {
            Some((blur, canny, what)) => {
                println!("{blur:7.2} ms  GaussianBlur, {canny:.2} ms Canny: {what}");
                let theirs = blur + canny;
                println!(
                    "{:7.2} x OpenCV of one frame for curves and splines of a pair (at most 30)",
                    2.0 * (whole + splines) / theirs
                );
                println!(
                    "{:7.2} x OpenCV for the edge points (at most 3), {:.2} x with curves",
                    edges / theirs,
                    whole / theirs
                );
            }
            None => println!("OpenCV is not there"),
        }
    }
    let theirs = least(|| imageproc::edges::canny(&picture, 20.0, 50.0));
    let found = imageproc::edges::canny(&picture, 20.0, 50.0).iter().filter(|v| **v > 0).count();
    println!(
        "\n{theirs:7.2} ms  imageproc's canny (its own sigma of 1.4 px, whole pixels): {found} edge pixels"
    );
    let flipped = image::imageops::flip_horizontal(&picture);
    let again = image::imageops::flip_horizontal(&imageproc::edges::canny(&flipped, 20.0, 50.0));
    let first = imageproc::edges::canny(&picture, 20.0, 50.0);
    let other = first.iter().zip(again.iter()).filter(|(a, b)| a != b).count();
    println!("           of the mirrored picture it finds {other} others");
    println!("\nother methods, sigma 1 px, from grey levels to curves");
    for method in
        [Method::Sobel, Method::Prewitt, Method::Roberts, Method::Log, Method::Threshold, Method::Region]
    {
        let params = SegmentParams {
            method,
            seeds_px: vec![[width as f64 / 2.0, height as f64 / 2.0]],
            ..SegmentParams::default()
        };
        let found = curves(&frame, None, &params).map_or(0, |c| c.0.len());
        println!("{:7.2} ms  {method:?}: {found} curves", least(|| curves(&frame, None, &params)));
    }
    Ok(())
}
