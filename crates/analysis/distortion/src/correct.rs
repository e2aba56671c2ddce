//! Corrects whole pictures: each pixel of a picture without distortion takes its grey from where the intensifier recorded it.
//!
//! Where that is, is found once for a map and then serves any number of pictures. The grey there is bilinear in the four pixels
//! around, or bicubic in sixteen with Keys's kernel of `a = -1/2` (R. G. Keys, Cubic convolution interpolation for digital
//! image processing, 1981), which meets every polynomial of degree 2 and is MATLAB's `bicubic`, so the thesis's; OpenCV's has
//! `a = -3/4` and sharpens. Beyond the border of the recorded picture its last pixels go on.
//!
//! **Guaranteed:** places are those of the distortion to 5e-5 px (3e-4 px where it wavers by 0.1 px from sample to sample); a pixel is valid exactly where it was recorded, within the picture and the round
//! border; others are 0. **Not guaranteed:** the noise of a picture, which interpolation makes smoother in some places than in
//! others: edges are better found in the recorded picture and corrected themselves, as the stages do.

use std::ops::Range;

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
    /// Of all valid pixels: the number of the recorded pixel to the upper left of the place, and how far the place is from it, 0 to 1,
    /// along x and y.
    from: Vec<u32>,
    along_x: Vec<f32>,
    along_y: Vec<f32>,
}

/// Valid pixels one after the other.
#[derive(Debug, Clone, Copy)]
struct Run {
    /// Number of the first in the corrected picture.
    pixel: usize,
    /// Number of its place.
    place: usize,
    count: usize,
    /// Whether all the 4 x 4 pixels of each lie in the recorded picture.
    inner: bool,
}

/// Places in the recorded picture, as in [`Remap`].
#[derive(Clone, Copy)]
struct Places<'a> {
    from: &'a [u32],
    along_x: &'a [f32],
    along_y: &'a [f32],
}

impl Places<'_> {
    fn part(&self, range: Range<usize>) -> Self {
        Places {
            from: &self.from[range.clone()],
            along_x: &self.along_x[range.clone()],
            along_y: &self.along_y[range],
        }
    }
}

/// Pixels that are computed together, so that the compiler has one instruction for several of them.
const LANES: usize = 8;

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

/// Pixels from one place that is searched to the next; between them a cubic has their places and derivatives.
const SPAN: usize = 2;

/// Where the derivatives at both ends of a span differ so much from the way between them, places between are searched too.
const SMOOTH: f64 = 0.01;

/// Where an ideal pixel was recorded.
#[derive(Debug, Clone, Copy)]
struct Knot {
    at: Point2,
    /// How that moves from an ideal pixel to the next along x.
    along_x: Vector2,
}

impl Knot {
    /// Searched from a guess.
    fn new(distortion: &Distortion, ideal: &Point2, guess: &Point2) -> Option<Self> {
        let mut at = *guess;
        for _ in 0..STEPS {
            let (value, derivative) = distortion.ideal_with_derivative(&at);
            let inverse = derivative.try_inverse()?;
            let step = inverse * (ideal - value);
            at += step;
            if step.norm_squared() < LAST_STEP_PX * LAST_STEP_PX {
                return Some(Self { at, along_x: inverse.column(0).into() });
            }
        }
        // A guess that leads nowhere: from afar, with a strict test.
        let at = distortion.recorded(ideal)?;
        let inverse = distortion.ideal_with_derivative(&at).1.try_inverse()?;
        Some(Self { at, along_x: inverse.column(0).into() })
    }

    /// The place so many pixels on to `end`, which is a span away; `None` where the way is not smooth.
    fn between(&self, end: &Self, pixels: usize) -> Option<Point2> {
        let way = (end.at - self.at) / SPAN as f64;
        // Hermite's cubic by how its slopes differ from the way.
        let (start_slope, end_slope) = (self.along_x - way, end.along_x - way);
        let smooth = start_slope.norm_squared().max(end_slope.norm_squared()) < SMOOTH * SMOOTH;
        let (t, s) = (pixels as f64, (SPAN - pixels) as f64);
        let bend = (start_slope * s - end_slope * t) * (s * t / (SPAN * SPAN) as f64);
        smooth.then(|| self.at + way * t + bend)
    }
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
            let in_border = border
                .is_none_or(|c| (p - Point2::from(c.centre_px)).norm_squared() <= c.radius_px * c.radius_px);
            in_border && (0..2).all(|a| (-ROUNDING_PX..=last[a] + ROUNDING_PX).contains(&p[a]))
        };
        let mut remap = Self {
            recorded_size,
            size,
            runs: Vec::new(),
            from: Vec::with_capacity(size[0] * size[1]),
            along_x: Vec::with_capacity(size[0] * size[1]),
            along_y: Vec::with_capacity(size[0] * size[1]),
        };
        let mut first = None;
        for y in 0..size[1] {
            let ideal = |x: usize| Point2::new(x as f64, y as f64);
            let guess = first.map_or(ideal(0), |knot: Knot| knot.at + Vector2::y());
            first = Knot::new(distortion, &ideal(0), &guess);
            let mut start = first;
            for from in (0..size[0]).step_by(SPAN) {
                let next = ideal(from + SPAN);
                let guess = start.map_or(next, |knot| knot.at + knot.along_x * SPAN as f64);
                let end = Knot::new(distortion, &next, &guess);
                for x in from..size[0].min(from + SPAN) {
                    let between = start.zip(end).and_then(|(start, end)| start.between(&end, x - from));
                    if let Some(p) = between.or_else(|| distortion.recorded(&ideal(x))).filter(&seen) {
                        remap.add(y * size[0] + x, &p);
                    }
                }
                start = end;
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
        let place = self.from.len();
        self.from.push((row * self.recorded_size[0] + column) as u32);
        self.along_x.push(x);
        self.along_y.push(y);
        match self.runs.last_mut().filter(|r| r.inner == inner && r.pixel + r.count == pixel) {
            Some(run) => run.count += 1,
            None => self.runs.push(Run { pixel, place, count: 1, inner }),
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
        let kernel = match interpolation {
            Interpolation::Bilinear => bilinear::<G>,
            Interpolation::Bicubic => bicubic::<G>,
        };
        let all = Places { from: &self.from, along_x: &self.along_x, along_y: &self.along_y };
        let mut into = vec![0.0; self.size[0] * self.size[1]];
        for run in &self.runs {
            let places = all.part(run.place..run.place + run.count);
            let into = &mut into[run.pixel..run.pixel + run.count];
            if run.inner && run.count >= LANES {
                kernel(from, width, places, into);
                // Those that fill no lanes, with some that were computed already.
                let last = run.count - LANES..run.count;
                kernel(from, width, places.part(last.clone()), &mut into[last]);
            } else {
                for (k, grey) in into.iter_mut().enumerate() {
                    *grey = at_border(from, self.recorded_size, places.part(k..k + 1), interpolation);
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

/// Greys of full lanes of places whose pixels all lie in the picture.
fn bilinear<G: Grey>(from: &[G], width: usize, places: Places, into: &mut [f32]) {
    let count = from.len() - width - 1;
    let shifted = |by: usize| &from[by..by + count];
    let (a, b, c, d) = (shifted(0), shifted(1), shifted(width), shifted(width + 1));
    let places = lanes(places.from).zip(lanes(places.along_x)).zip(lanes(places.along_y));
    for (into, ((first, x), y)) in into.as_chunks_mut::<LANES>().0.iter_mut().zip(places) {
        let [mut left, mut right, mut left_below, mut right_below] = [[0.0; LANES]; 4];
        for k in 0..LANES {
            let at = first[k] as usize;
            left[k] = a[at].grey();
            right[k] = b[at].grey();
            left_below[k] = c[at].grey();
            right_below[k] = d[at].grey();
        }
        for k in 0..LANES {
            let above = left[k] + x[k] * (right[k] - left[k]);
            let below = left_below[k] + x[k] * (right_below[k] - left_below[k]);
            into[k] = above + y[k] * (below - above);
        }
    }
}

/// The same from 4 x 4 pixels.
fn bicubic<G: Grey>(from: &[G], width: usize, places: Places, into: &mut [f32]) {
    let count = from.len() - 3 * width;
    let rows = [0, 1, 2, 3].map(|k| &from[k * width..k * width + count]);
    let places = lanes(places.from).zip(lanes(places.along_x)).zip(lanes(places.along_y));
    for (into, ((first, x), y)) in into.as_chunks_mut::<LANES>().0.iter_mut().zip(places) {
        let (mut across, mut down) = ([[0.0; LANES]; 4], [[0.0; LANES]; 4]);
        for k in 0..LANES {
            let (of_x, of_y) = (keys(x[k]), keys(y[k]));
            for i in 0..4 {
                (across[i][k], down[i][k]) = (of_x[i], of_y[i]);
            }
        }
        let mut columns = [[0.0; 4]; LANES];
        for k in 0..LANES {
            // One row above and one column to the left.
            let at = first[k] as usize - width - 1;
            let [a, b, c, d] = rows.map(|row| &row[at..at + 4]);
            for i in 0..4 {
                columns[k][i] = a[i].grey() * down[0][k]
                    + b[i].grey() * down[1][k]
                    + c[i].grey() * down[2][k]
                    + d[i].grey() * down[3][k];
            }
        }
        for k in 0..LANES {
            let [a, b, c, d] = columns[k];
            into[k] = a * across[0][k] + b * across[1][k] + c * across[2][k] + d * across[3][k];
        }
    }
}

/// Numbers in full lanes.
fn lanes<T>(numbers: &[T]) -> std::slice::Iter<'_, [T; LANES]> {
    numbers.as_chunks().0.iter()
}

/// A grey at the first place, wherever that is: beyond the picture its last pixels go on.
fn at_border<G: Grey>(from: &[G], size: [usize; 2], place: Places, interpolation: Interpolation) -> f32 {
    let weights = |t: f32| match interpolation {
        Interpolation::Bilinear => [0.0, 1.0 - t, t, 0.0],
        Interpolation::Bicubic => keys(t),
    };
    let first = place.from[0] as usize;
    let near = |first: usize, k: usize, count: usize| (first + k).saturating_sub(1).min(count - 1);
    let mut sum = 0.0;
    for (j, down) in weights(place.along_y[0]).into_iter().enumerate() {
        let row = near(first / size[0], j, size[1]) * size[0];
        for (i, across) in weights(place.along_x[0]).into_iter().enumerate() {
            sum += down * across * from[row + near(first % size[0], i, size[0])].grey();
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
        let size = [1024; 2];
        let intensifier = IntensifierDistortion {
            pincushion_px: 12.0,
            s_shape_px: 12.0,
            ..IntensifierDistortion::none(size)
        };
        let smooth = intensifier.table(size, 16);
        // As rough as a local weighted mean of noisy spots: a tenth of a px, changing every few samples.
        let mut rough = smooth.clone();
        for (k, [x, y]) in rough.ideal_px.iter_mut().enumerate() {
            let (sin, cos) = (2.0 * k as f64).sin_cos();
            *x += 0.1 * sin;
            *y += 0.1 * cos;
        }
        for (table, most) in [(smooth, 5e-5), (rough, 3e-4)] {
            let distortion = Distortion::from(&table);
            let remap = Remap::new(&distortion, size, size, None).unwrap();
            let mut worst = 0.0_f64;
            for run in &remap.runs {
                for (pixel, number) in (run.pixel..run.pixel + run.count).zip(run.place..).step_by(11) {
                    let ideal = Point2::new((pixel % 1024) as f64, (pixel / 1024) as f64);
                    let truth = distortion.recorded(&ideal).unwrap();
                    let first = [remap.from[number] % 1024, remap.from[number] / 1024].map(f64::from);
                    let along = [remap.along_x[number], remap.along_y[number]].map(f64::from);
                    let place = Point2::new(first[0] + along[0], first[1] + along[1]);
                    worst = worst.max((place - truth).norm());
                }
            }
            println!("largest error {worst:.1e} px");
            assert!(worst < most, "{worst}");
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
