//! Corrects whole pictures: each pixel of a picture without distortion takes its grey from where the intensifier recorded it.
//!
//! Where that is, is found once for a map and then serves any number of pictures. The grey there is bilinear in the four pixels
//! around, or bicubic in sixteen with Keys's kernel of `a = -1/2` (R. G. Keys, Cubic convolution interpolation for digital
//! image processing, 1981), which meets every polynomial of degree 2 and is MATLAB's `bicubic`, so the thesis's; OpenCV's has
//! `a = -3/4` and sharpens. Beyond the border of the recorded picture its last pixels go on.
//!
//! **Guaranteed:** places are right to 1e-5 px; a pixel is valid exactly where it was recorded, within the picture and the round
//! border; others are 0. **Not guaranteed:** the noise of a picture, which interpolation makes smoother in some places than in
//! others: edges are better found in the recorded picture and corrected themselves, as the stages do.

use biplane_artifact::{Circle, Frame};
use biplane_fluoroscope::Distortion;
use biplane_geometry::{Point2, Vector2};

/// How a grey between pixels is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// From 2 x 2 pixels: never brighter or darker than they are.
    Bilinear,
    /// From 4 x 4 pixels: sharper; may go beyond them next to an edge.
    Bicubic,
}

/// Why a picture is not corrected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum RemapError {
    /// The picture is not of the size that the map is for.
    #[error(
        "a picture of {found} samples, but the correction is for {} x {}: use pictures of the size that the plate was taken with",
        expected[0], expected[1]
    )]
    Size {
        /// Samples.
        found: usize,
        /// Columns and rows of the map.
        expected: [usize; 2],
    },
    /// A picture has no pixels, or too many to number.
    #[error("a picture of {} x {} pixels cannot be corrected: it must have 1 to 4294967295 of them", found[0], found[1])]
    Extent {
        /// Columns and rows.
        found: [usize; 2],
    },
}

/// Where each pixel of a corrected picture comes from.
#[derive(Debug, Clone)]
pub struct Remap {
    recorded_size: [usize; 2],
    size: [usize; 2],
    /// Valid pixels row by row, with no gap within one run.
    runs: Vec<Run>,
    /// Of all valid pixels.
    taps: Vec<Tap>,
}

/// Valid pixels one after the other.
#[derive(Debug, Clone, Copy)]
struct Run {
    /// Number of the first in the corrected picture.
    pixel: usize,
    /// Number of the first in `taps`.
    tap: usize,
    count: usize,
    /// Whether all the 4 x 4 pixels of each lie in the recorded picture.
    inner: bool,
}

/// A place in the recorded picture.
#[derive(Debug, Clone, Copy)]
struct Tap {
    /// Number of the pixel to the upper left.
    pixel: u32,
    /// How far from it, 0 to 1, along x and y.
    x: f32,
    y: f32,
}

/// A grey level of any type.
trait Grey: Copy {
    fn grey(self) -> f32;
}

impl Grey for f32 {
    fn grey(self) -> f32 {
        self
    }
}

impl Grey for u16 {
    fn grey(self) -> f32 {
        f32::from(self)
    }
}

/// How far beyond the outermost centres of pixels a place still counts as on them, px: what rounding does.
const ROUNDING_PX: f64 = 1e-6;

/// A Newton step of at most so many px leaves an error below 1e-6 px where derivatives change by less than 0.01 a px.
const LAST_STEP_PX: f64 = 0.01;

/// Most Newton steps from a neighbour's place.
const STEPS: usize = 4;

/// Where an ideal pixel was recorded, searched from a guess; and how that moves from a pixel to the next along x.
fn recorded(distortion: &Distortion, ideal: &Point2, guess: &Point2) -> Option<(Point2, Vector2)> {
    let mut p = *guess;
    for _ in 0..STEPS {
        let (at, derivative) = distortion.ideal_with_derivative(&p);
        let inverse = derivative.try_inverse()?;
        let step = inverse * (ideal - at);
        p += step;
        if step.norm_squared() < LAST_STEP_PX * LAST_STEP_PX {
            return Some((p, inverse.column(0).into()));
        }
    }
    // A guess that leads nowhere: from afar, with a strict test.
    distortion.recorded(ideal).map(|p| (p, Vector2::x()))
}

impl Remap {
    /// For corrected pictures of `size` pixels from recorded ones of `recorded_size`; ideal pixels keep their numbers. What was
    /// recorded beyond the `border` is not valid.
    ///
    /// # Errors
    /// [`RemapError::Extent`].
    pub fn new(
        distortion: &Distortion,
        recorded_size: [usize; 2],
        size: [usize; 2],
        border: Option<&Circle>,
    ) -> Result<Self, RemapError> {
        for found in [recorded_size, size] {
            let pixels = found[0].checked_mul(found[1]).filter(|n| (1..=u32::MAX as usize).contains(n));
            pixels.ok_or(RemapError::Extent { found })?;
        }
        let last = recorded_size.map(|n| (n - 1) as f64);
        let seen = |p: &Point2| {
            let in_border = border.is_none_or(|c| (p - Point2::from(c.centre_px)).norm() <= c.radius_px);
            in_border && (0..2).all(|a| (-ROUNDING_PX..=last[a] + ROUNDING_PX).contains(&p[a]))
        };
        let mut remap = Self { recorded_size, size, runs: Vec::new(), taps: Vec::new() };
        let mut of_row = Point2::origin();
        for y in 0..size[1] {
            let mut guess = of_row;
            for x in 0..size[0] {
                let ideal = Point2::new(x as f64, y as f64);
                let found = recorded(distortion, &ideal, &guess);
                if x == 0 {
                    of_row = found.map_or(ideal, |(p, _)| p) + Vector2::y();
                }
                guess = found.map_or(ideal + Vector2::x(), |(p, along_x)| p + along_x);
                if let Some((p, _)) = found.filter(|(p, _)| seen(p)) {
                    remap.add(y * size[0] + x, &p);
                }
            }
        }
        Ok(remap)
    }

    /// The next valid pixel, recorded at `p`.
    fn add(&mut self, pixel: usize, p: &Point2) {
        let place = |axis: usize| {
            let last = self.recorded_size[axis] - 1;
            let at = p[axis].clamp(0.0, last as f64);
            // Also in the last column there is a pixel to the right, but in pictures of one column.
            let first = (at as usize).min(last.saturating_sub(1));
            (first, (at - first as f64) as f32, first >= 1 && first + 2 <= last)
        };
        let ((column, x, inner_x), (row, y, inner_y)) = (place(0), place(1));
        let inner = inner_x && inner_y;
        let tap = self.taps.len();
        self.taps.push(Tap { pixel: (row * self.recorded_size[0] + column) as u32, x, y });
        match self.runs.last_mut().filter(|r| r.inner == inner && r.pixel + r.count == pixel) {
            Some(run) => run.count += 1,
            None => self.runs.push(Run { pixel, tap, count: 1, inner }),
        }
    }

    /// Columns and rows of corrected pictures.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Which pixels of corrected pictures are valid, row by row.
    pub fn valid(&self) -> Vec<bool> {
        let mut valid = vec![false; self.size[0] * self.size[1]];
        for run in &self.runs {
            valid[run.pixel..run.pixel + run.count].fill(true);
        }
        valid
    }

    /// Corrects a picture. Greys are rounded to its levels.
    ///
    /// # Errors
    /// [`RemapError::Size`].
    pub fn frame(&self, frame: &Frame, interpolation: Interpolation) -> Result<Frame, RemapError> {
        if [frame.width, frame.height] != self.recorded_size {
            return Err(RemapError::Size { found: frame.samples.len(), expected: self.recorded_size });
        }
        let greys = self.corrected(&frame.samples, interpolation)?;
        let full = ((1_u32 << frame.bits.clamp(1, 16)) - 1) as f32;
        // A negative float becomes 0.
        let samples = greys.into_iter().map(|g| (g + 0.5).min(full) as u16).collect();
        Ok(Frame { width: self.size[0], height: self.size[1], samples, bits: frame.bits })
    }

    /// Corrects greys, row by row, as they are.
    ///
    /// # Errors
    /// [`RemapError::Size`].
    pub fn greys(&self, greys: &[f32], interpolation: Interpolation) -> Result<Vec<f32>, RemapError> {
        self.corrected(greys, interpolation)
    }

    fn corrected<G: Grey>(&self, from: &[G], interpolation: Interpolation) -> Result<Vec<f32>, RemapError> {
        let [width, height] = self.recorded_size;
        if from.len() != width * height {
            return Err(RemapError::Size { found: from.len(), expected: self.recorded_size });
        }
        let mut into = vec![0.0; self.size[0] * self.size[1]];
        for run in &self.runs {
            let taps = &self.taps[run.tap..run.tap + run.count];
            let into = &mut into[run.pixel..run.pixel + run.count];
            match (run.inner, interpolation) {
                (true, Interpolation::Bilinear) => bilinear(from, width, taps, into),
                (true, Interpolation::Bicubic) => bicubic(from, width, taps, into),
                (false, _) => {
                    for (grey, tap) in into.iter_mut().zip(taps) {
                        *grey = at_border(from, self.recorded_size, tap, interpolation);
                    }
                }
            }
        }
        Ok(into)
    }
}

/// Weights of four neighbours, the place being `t` beyond the second.
#[inline]
fn keys(t: f32) -> [f32; 4] {
    let (s, u) = (1.0 - t, t * (1.0 - t));
    let (before, after) = (-0.5 * u * s, -0.5 * u * t);
    // The other two: 1 - 5/2 t^2 + 3/2 t^3 and what remains to 1.
    let near = 1.0 - t * t * (2.5 - 1.5 * t);
    [before, near, 1.0 - near - before - after, after]
}

fn bilinear<G: Grey>(from: &[G], width: usize, taps: &[Tap], into: &mut [f32]) {
    let below = &from[width..];
    let above = &from[..below.len()];
    for (grey, tap) in into.iter_mut().zip(taps) {
        let at = tap.pixel as usize;
        let (a, b) = (&above[at..at + 2], &below[at..at + 2]);
        let first = a[0].grey() + tap.x * (a[1].grey() - a[0].grey());
        let second = b[0].grey() + tap.x * (b[1].grey() - b[0].grey());
        *grey = first + tap.y * (second - first);
    }
}

fn bicubic<G: Grey>(from: &[G], width: usize, taps: &[Tap], into: &mut [f32]) {
    let fourth = &from[3 * width..];
    let row = |k: usize| &from[k * width..k * width + fourth.len()];
    let rows = [row(0), row(1), row(2), fourth];
    for (grey, tap) in into.iter_mut().zip(taps) {
        // One row above and one column to the left.
        let at = tap.pixel as usize - width - 1;
        let (across, down) = (keys(tap.x), keys(tap.y));
        let mut columns = [0.0_f32; 4];
        for (row, weight) in rows.iter().zip(down) {
            for (sum, value) in columns.iter_mut().zip(&row[at..at + 4]) {
                *sum += weight * value.grey();
            }
        }
        *grey =
            columns[0] * across[0] + columns[1] * across[1] + columns[2] * across[2] + columns[3] * across[3];
    }
}

/// A grey where the 4 x 4 pixels reach beyond the picture.
fn at_border<G: Grey>(from: &[G], size: [usize; 2], tap: &Tap, interpolation: Interpolation) -> f32 {
    let weights = |t: f32| match interpolation {
        Interpolation::Bilinear => [0.0, 1.0 - t, t, 0.0],
        Interpolation::Bicubic => keys(t),
    };
    let (column, row) = (tap.pixel as usize % size[0], tap.pixel as usize / size[0]);
    let near = |first: usize, k: usize, count: usize| (first + k).saturating_sub(1).min(count - 1);
    let mut sum = 0.0;
    for (j, down) in weights(tap.y).into_iter().enumerate() {
        for (i, across) in weights(tap.x).into_iter().enumerate() {
            sum += down * across * from[near(row, j, size[1]) * size[0] + near(column, i, size[0])].grey();
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_artifact::DistortionTable;
    use biplane_phantom::IntensifierDistortion;

    fn bent() -> IntensifierDistortion {
        IntensifierDistortion {
            pincushion_px: 4.0,
            s_shape_px: -3.0,
            shift_px: Vector2::new(1.3, -0.6),
            ..IntensifierDistortion::none([300, 260])
        }
    }

    /// A smooth picture: waves of some 30 px.
    fn grey(p: &Point2) -> f64 {
        120.0 + 60.0 * (p.x / 5.0 + 0.02 * p.y).sin() + 50.0 * (p.y / 4.0).cos()
    }

    fn remap(recorded: [usize; 2], size: [usize; 2], border: Option<&Circle>) -> Remap {
        Remap::new(&Distortion::from(&bent().table(recorded, 4)), recorded, size, border).unwrap()
    }

    #[test]
    fn a_distorted_picture_is_as_it_was_before() {
        let [w, h] = [300, 260];
        let pixels = || (0..w * h).map(|k| Point2::new((k % w) as f64, (k / w) as f64));
        let recorded: Vec<f32> = pixels().map(|p| grey(&bent().ideal(&p)) as f32).collect();
        let remap = remap([w, h], [w, h], None);
        let error = |interpolation| {
            let corrected = remap.greys(&recorded, interpolation).unwrap();
            let valid = remap.valid();
            let inner = pixels().enumerate().filter(|(i, p)| {
                let from = bent().recorded(p);
                // Next to the border the table is not the map, nor are pixels that go on the picture.
                valid[*i] && (4..295).contains(&(from.x as i32)) && (4..255).contains(&(from.y as i32))
            });
            let errors: Vec<f64> = inner.map(|(i, p)| (f64::from(corrected[i]) - grey(&p)).abs()).collect();
            assert!(errors.len() > 60_000);
            errors.into_iter().fold(0.0, f64::max)
        };
        // Linear interpolation of a wave a sin(x / l) is off by a / (8 l^2), 60 / 200 and 50 / 128; Keys's kernel has an error of the third order.
        let (linear, cubic) = (error(Interpolation::Bilinear), error(Interpolation::Bicubic));
        assert!(linear > 0.5 && linear < 0.75 && cubic < 0.05, "{linear} {cubic}");
    }

    #[test]
    fn what_is_valid_is_what_was_recorded_within_picture_and_border() {
        let border = Circle { centre_px: [150.0, 128.0], radius_px: 120.0 };
        for border in [None, Some(&border)] {
            let remap = remap([300, 260], [310, 270], border);
            let corrected = remap.greys(&vec![7.0; 300 * 260], Interpolation::Bicubic).unwrap();
            for (k, valid) in remap.valid().into_iter().enumerate() {
                let p = bent().recorded(&Point2::new((k % 310) as f64, (k / 310) as f64));
                let inside = p.x.min(p.y).min(299.0 - p.x).min(259.0 - p.y);
                let inside = border
                    .map_or(inside, |c| inside.min(c.radius_px - (p - Point2::from(c.centre_px)).norm()));
                // The table knows the map to some thousandths of a px.
                assert!(inside.abs() < 0.02 || valid == (inside > 0.0), "{k}: {inside}");
                assert!((corrected[k] - if valid { 7.0 } else { 0.0 }).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn places_are_those_of_the_distortion() {
        let distortion = Distortion::from(&bent().table([300, 260], 16));
        let remap = Remap::new(&distortion, [300, 260], [300, 260], None).unwrap();
        for run in &remap.runs {
            for k in (0..run.count).step_by(7) {
                let (pixel, tap) = (run.pixel + k, remap.taps[run.tap + k]);
                let truth =
                    distortion.recorded(&Point2::new((pixel % 300) as f64, (pixel / 300) as f64)).unwrap();
                let place = [tap.pixel % 300, tap.pixel / 300].map(f64::from);
                let place = Point2::new(place[0] + f64::from(tap.x), place[1] + f64::from(tap.y));
                assert!((place - truth).norm() < 1e-6, "{pixel}: {place} {truth}");
            }
        }
    }

    #[test]
    fn no_distortion_gives_the_picture_itself_in_any_size() {
        let table = DistortionTable {
            first_px: [0.0; 2],
            step_px: [8.0; 2],
            count: [2, 2],
            ideal_px: vec![[0.0, 0.0], [8.0, 0.0], [0.0, 8.0], [8.0, 8.0]],
        };
        for size in [[1, 1], [1, 5], [4, 2], [3, 3], [9, 7]] {
            let remap = Remap::new(&Distortion::from(&table), size, size, None).unwrap();
            let samples: Vec<u16> = (0..size[0] * size[1]).map(|k| (k * 4099 % 65_536) as u16).collect();
            let frame = Frame { width: size[0], height: size[1], samples, bits: 16 };
            for interpolation in [Interpolation::Bilinear, Interpolation::Bicubic] {
                assert_eq!(remap.frame(&frame, interpolation).unwrap(), frame);
            }
            assert!(remap.valid().iter().all(|v| *v));
        }
    }

    #[test]
    fn greys_keep_their_bits() {
        // Bicubic goes beyond black and white next to an edge.
        let samples: Vec<u16> = (0..300 * 260).map(|k| if k / 9 % 2 == 0 { 0 } else { 255 }).collect();
        let frame = Frame { width: 300, height: 260, samples, bits: 8 };
        let remap = remap([300, 260], [300, 260], None);
        let floats: Vec<f32> = frame.samples.iter().map(|s| f32::from(*s)).collect();
        let floats = remap.greys(&floats, Interpolation::Bicubic).unwrap();
        assert!(floats.iter().any(|g| *g < -5.0) && floats.iter().any(|g| *g > 260.0));
        let corrected = remap.frame(&frame, Interpolation::Bicubic).unwrap();
        for (level, grey) in corrected.samples.iter().zip(floats) {
            assert!((f32::from(*level) - grey.clamp(0.0, 255.0)).abs() <= 0.5);
        }
    }

    #[test]
    fn pictures_of_another_size_are_refused() {
        let remap = remap([300, 260], [300, 260], None);
        let error = remap.greys(&[0.0; 12], Interpolation::Bilinear).unwrap_err();
        assert_eq!(error, RemapError::Size { found: 12, expected: [300, 260] });
        // As many samples, but not in these rows.
        let turned = Frame { width: 260, height: 300, samples: vec![0; 300 * 260], bits: 8 };
        assert!(remap.frame(&turned, Interpolation::Bilinear).is_err());
        let distortion = Distortion::from(&bent().table([300, 260], 8));
        for found in [[0, 5], [usize::MAX, 2], [70_000, 70_000]] {
            assert_eq!(
                Remap::new(&distortion, found, [1, 1], None).unwrap_err(),
                RemapError::Extent { found }
            );
        }
    }
}
