//! How long the correction of a 1024 x 1024 picture takes on one core, beside OpenCV's `remap` on the same map and greys:
//! `BIPLANE_PYTHON=python cargo bench -p biplane-distortion`, where that python has `opencv-python-headless` (without it, `python3` is
//! tried, and without OpenCV ours is printed alone).

use std::io::Write;
use std::process::{Command, Stdio};
use std::time::Instant;

use biplane_distortion::{Interpolation, Remap};
use biplane_fluoroscope::Distortion;
use biplane_geometry::{Point2, Vector2};
use biplane_phantom::IntensifierDistortion;
use rand::{Rng, SeedableRng};

const SIZE: usize = 1024;

/// Reads the map (x, then y) and the greys as float32, prints the least time of each in ms and writes what it made.
const OPENCV: &str = r"
import sys, time
import cv2, numpy
cv2.setNumThreads(1)
x, y, greys = numpy.frombuffer(sys.stdin.buffer.read(), numpy.float32).reshape(3, 1024, 1024)
for kind in (cv2.INTER_LINEAR, cv2.INTER_CUBIC):
    out = numpy.empty_like(greys)
    times = []
    for _ in range(40):
        start = time.perf_counter()
        cv2.remap(greys, x, y, kind, dst=out, borderMode=cv2.BORDER_REPLICATE)
        times.append(time.perf_counter() - start)
    sys.stdout.buffer.write(numpy.float64(min(times) * 1e3).tobytes() + out.tobytes())
sys.stderr.write('OpenCV ' + cv2.__version__ + '\n')
";

/// The least time of many, ms.
fn least<T>(rounds: usize, mut of: impl FnMut() -> T) -> f64 {
    let once = |_| {
        let start = Instant::now();
        std::hint::black_box(of());
        start.elapsed().as_secs_f64() * 1e3
    };
    (0..rounds).map(once).fold(f64::INFINITY, f64::min)
}

/// What OpenCV makes of it: time and greys for linear and cubic.
fn opencv(floats: &[f32]) -> Option<Vec<(f64, Vec<f32>)>> {
    let python = std::env::var("BIPLANE_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let mut child = Command::new(python)
        .args(["-c", OPENCV])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .ok()?;
    let bytes: Vec<u8> = floats.iter().flat_map(|f| f.to_le_bytes()).collect();
    // The pipe is closed here, at the end of its input.
    child.stdin.take()?.write_all(&bytes).ok()?;
    let output = child.wait_with_output().ok().filter(|o| o.status.success())?.stdout;
    let one = 8 + 4 * SIZE * SIZE;
    let parts = output.chunks_exact(one).map(|part| {
        let (time, greys) = part.split_at(8);
        let time = f64::from_le_bytes(time.try_into().ok()?);
        Some((time, greys.as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect()))
    });
    parts.collect::<Option<Vec<_>>>().filter(|p| p.len() == 2)
}

fn main() {
    let bent = IntensifierDistortion {
        pincushion_px: 12.0,
        s_shape_px: 12.0,
        shift_px: Vector2::new(0.3, -0.4),
        ..IntensifierDistortion::none([SIZE; 2])
    };
    let distortion = Distortion::from(&bent.table([SIZE; 2], 16));
    let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(1);
    let greys: Vec<f32> = (0..SIZE * SIZE).map(|_| random.random_range(0.0..255.0)).collect();

    let new = || Remap::new(&distortion, [SIZE; 2], [SIZE; 2], None);
    println!("{:7.2} ms  the map", least(15, new));
    let Ok(remap) = new() else { return };
    let pixels = (0..SIZE * SIZE).map(|k| Point2::new((k % SIZE) as f64, (k / SIZE) as f64));
    let places: Vec<Point2> = pixels.map(|p| distortion.recorded(&p).unwrap_or(p)).collect();
    let map = places.iter().map(|p| p.x as f32).chain(places.iter().map(|p| p.y as f32));
    let theirs = opencv(&map.chain(greys.iter().copied()).collect::<Vec<_>>());
    let valid = remap.valid();
    for (number, kind) in [Interpolation::Bilinear, Interpolation::Bicubic].into_iter().enumerate() {
        let ms = least(40, || remap.greys(&greys, kind));
        println!("{ms:7.2} ms  {kind:?}");
        let (Some(theirs), Ok(ours)) = (&theirs, remap.greys(&greys, kind)) else { continue };
        let (their_ms, their_greys) = &theirs[number];
        let differences = ours.iter().zip(their_greys).zip(&valid).filter(|(_, valid)| **valid);
        let largest = differences.map(|((a, b), _)| (a - b).abs()).fold(0.0, f32::max);
        println!(
            "{their_ms:7.2} ms  OpenCV; ours takes {:.2} times that; largest difference {largest:.4} of 255",
            ms / their_ms
        );
    }
    if theirs.is_none() {
        println!("no python with OpenCV: set BIPLANE_PYTHON to one that has opencv-python-headless");
    }
}
