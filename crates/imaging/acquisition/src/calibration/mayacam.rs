//! MayaCam 2.0: one camera, in the sense of OpenCV (x right, y down, z away from the source; world to camera, mm).
//!
//! ```text
//! image size / W,H / camera matrix / fx,s,cx / 0,fy,cy / 0,0,1 / rotation / 3 rows / translation / 3 lines
//! undistortion / k1 k2 p1 p2 k3 k4 k5 k6     (optional; eight lines, or one line with commas)
//! ```
//!
//! with an empty line before each heading. XMALab and Autoscoper go by line numbers; here empty lines may be missing or
//! more, and every other line has to be there. Autoscoper's documents put the height first and show minus signs; both
//! programs' code has the width first and plain signs, and so has this reader.
//!
//! `u = K (R X + t)`, so the source is `-R' t` and the matrix `K R`, whose third row is the depth along the detector's
//! normal in mm. A rotation that is not one to 1e-6 (few decimals printed) is replaced by the nearest rotation; to 1e-3
//! it is refused.
//!
//! **Undistortion.** OpenCV's rational model with `r2 = x^2 + y^2` of the ideal point on the plane of depth 1 gives the
//! recorded point: `x'' = x (1 + k1 r2 + k2 r2^2 + k3 r2^3) / (1 + k4 r2 + k5 r2^2 + k6 r2^3) + 2 p1 x y + p2 (r2 + 2 x^2)`,
//! `y''` likewise. It is inverted by Newton's method on a grid of recorded pixels that reaches beyond the picture, as
//! dense as bicubic (Catmull-Rom) interpolation needs to be within 0.001 px of the model everywhere in the picture.

use std::path::Path;

use biplane_artifact::{Calibration, DistortionTable, PixelOrigin};
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use super::camera::{Camera, NewWorld, nearest_rotation};
use super::write::{WriteError, WriteOptions, Written, checked, number};
use super::{CalibratedView, CalibrationError, MAX_SIDE, quote, read_text};

/// Reads one camera.
///
/// `pixel_origin` says where the file counts pixels from, which the format does not: with [`PixelOrigin::Corner`] half a
/// pixel is taken from both coordinates of the principal point.
///
/// # Errors
/// A line is missing or not what its place demands (the message names the line), the rotation is none, a focal length is
/// not positive, the size is not one of a picture, or the undistortion folds the picture over.
pub fn read_mayacam2(
    path: impl AsRef<Path>,
    pixel_origin: PixelOrigin,
) -> Result<Calibration, CalibrationError> {
    let path = path.as_ref();
    Ok(parse(path, &read_text(path)?, pixel_origin)?.calibration)
}

/// Lines that are not empty, with their numbers.
struct Lines<'a> {
    path: &'a Path,
    lines: Vec<(usize, &'a str)>,
    next: usize,
    end: usize,
}

impl<'a> Lines<'a> {
    fn error(&self, expected: &str) -> CalibrationError {
        let (line, found) = match self.lines.get(self.next) {
            Some((line, text)) => (*line, quote(text)),
            None => (self.end + 1, "the end of the file".to_owned()),
        };
        CalibrationError::Line { path: self.path.to_owned(), line, expected: expected.to_owned(), found }
    }

    fn heading(&mut self, name: &str) -> Result<(), CalibrationError> {
        match self.lines.get(self.next) {
            Some((_, text)) if text.trim().eq_ignore_ascii_case(name) => {
                self.next += 1;
                Ok(())
            }
            _ => Err(self.error(&format!("the heading `{name}`"))),
        }
    }

    /// The numbers of the next line, without going past it; `None` if it is not a line of finite numbers.
    fn peek_numbers(&self) -> Option<Vec<f64>> {
        let (_, text) = self.lines.get(self.next)?;
        let tokens = text.split([',', ';', ' ', '\t']).filter(|t| !t.is_empty());
        tokens.map(|t| t.parse::<f64>().ok().filter(|v| v.is_finite())).collect()
    }

    fn numbers<const N: usize>(&mut self, expected: &str) -> Result<[f64; N], CalibrationError> {
        match self.peek_numbers().and_then(|v| <[f64; N]>::try_from(v).ok()) {
            Some(values) => {
                self.next += 1;
                Ok(values)
            }
            None => Err(self.error(expected)),
        }
    }

    fn rows(&mut self, of: &str, forms: [&str; 3]) -> Result<Matrix3<f64>, CalibrationError> {
        let mut m = Matrix3::zeros();
        for (i, form) in forms.iter().enumerate() {
            let row = self.numbers::<3>(&format!("row {} of the {of}, three numbers `{form}`", i + 1))?;
            m.set_row(i, &nalgebra::RowVector3::from(row));
        }
        Ok(m)
    }
}

pub(super) fn parse(
    path: &Path,
    text: &str,
    origin: PixelOrigin,
) -> Result<CalibratedView, CalibrationError> {
    let value = |what: String| CalibrationError::Value { path: path.to_owned(), what };
    let mut lines = Lines {
        path,
        lines: text
            .lines()
            .enumerate()
            .map(|(i, l)| (i + 1, l))
            .filter(|(_, l)| !l.trim().is_empty())
            .collect(),
        next: 0,
        end: text.lines().count(),
    };
    lines.heading("image size")?;
    let size = lines.numbers::<2>("two numbers `width,height`")?;
    lines.heading("camera matrix")?;
    let mut k = lines.rows("camera matrix", ["fx,s,cx", "0,fy,cy", "0,0,1"])?;
    lines.heading("rotation")?;
    let r = lines.rows("rotation", ["r11,r12,r13", "r21,r22,r23", "r31,r32,r33"])?;
    lines.heading("translation")?;
    let mut t = Vector3::zeros();
    for (i, axis) in ["x", "y", "z"].iter().enumerate() {
        t[i] = lines.numbers::<1>(&format!("the {axis} of the translation, one number"))?[0];
    }
    let mut coefficients = [0.0; 8];
    if lines.next < lines.lines.len() {
        lines.heading("undistortion")?;
        if lines.peek_numbers().is_some_and(|v| v.len() > 1) {
            coefficients = lines.numbers::<8>("eight numbers `k1,k2,p1,p2,k3,k4,k5,k6`")?;
        } else {
            for (c, name) in coefficients.iter_mut().zip(["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"]) {
                *c = lines.numbers::<1>(&format!("{name} of the undistortion, one number"))?[0];
            }
        }
        if lines.next < lines.lines.len() {
            return Err(lines.error("the end of the file"));
        }
    }

    if size.iter().any(|&s| !(1.0..=MAX_SIDE).contains(&s) || s.fract() != 0.0) {
        return Err(value(format!(
            "image size {} x {}; expected whole numbers from 1 to {MAX_SIDE}",
            size[0], size[1]
        )));
    }
    let (fx, fy) = (k[(0, 0)], k[(1, 1)]);
    if fx == 0.0 || fy == 0.0 || k[(1, 0)] != 0.0 || k[(2, 0)] != 0.0 || k[(2, 1)] != 0.0 || k[(2, 2)] != 1.0
    {
        let row = |i: usize| format!("{},{},{}", k[(i, 0)], k[(i, 1)], k[(i, 2)]);
        return Err(value(format!(
            "lines 5 to 7, the camera matrix: found {} / {} / {}, expected fx,s,cx / 0,fy,cy / 0,0,1; are lines or \
             columns in another order?",
            row(0),
            row(1),
            row(2)
        )));
    }
    if fx < 0.0 || fy < 0.0 {
        return Err(value(format!(
            "focal lengths fx = {fx}, fy = {fy}; expected both positive: MayaCam 2.0 has the axes of OpenCV (x right, y \
             down, z away from the source), so export the file again rather than change its signs by hand"
        )));
    }
    let off = (r * r.transpose() - Matrix3::identity()).abs().max();
    if off > 1e-3 {
        return Err(value(format!(
            "rotation is not one: its rows differ from unit vectors at right angles by {off:.2e}, expected at most 1e-3"
        )));
    }
    if r.determinant() < 0.0 {
        return Err(value(
            "rotation has the determinant -1: it mirrors; expected +1 (a right-handed camera, OpenCV's axes)"
                .to_owned(),
        ));
    }
    let r = if off > 1e-6 { nearest_rotation(r).0 } else { r };
    if origin == PixelOrigin::Corner {
        k[(0, 2)] -= 0.5;
        k[(1, 2)] -= 0.5;
    }
    let size = [size[0] as usize, size[1] as usize];
    let coefficients = coefficients.iter().any(|c| *c != 0.0).then_some(coefficients);
    let distortion = match coefficients {
        Some(coefficients) => Some(Undistortion { k, coefficients }.table(size).map_err(value)?),
        None => None,
    };
    let m = k * r;
    let calibration = Calibration {
        view: String::new(),
        size,
        source: (-(r.transpose() * t)).into(),
        matrix: [0, 1, 2].map(|i| [m[(i, 0)], m[(i, 1)], m[(i, 2)]]),
        distortion,
    };
    Ok(CalibratedView { calibration, pixel_mm: None, coefficients, covariance: false })
}

/// Writes one view as MayaCam 2.0, laid out line by line as XMALab does.
///
/// # Errors
/// The picture is mirrored, or its distortion is not one of OpenCV's coefficients.
pub fn write_mayacam2(view: &CalibratedView, options: &WriteOptions) -> Result<Written, WriteError> {
    const FORMAT: &str = "MayaCam 2.0";
    let Camera { focal: [fx, fy], skew, principal, axes, source } = Camera::of(&view.calibration);
    let half = if options.pixel_origin == PixelOrigin::Corner { 0.5 } else { 0.0 };
    let [cx, cy] = principal.map(|c| c + half);
    let t = -(axes * source);
    let row = |values: [f64; 3]| values.map(number).join(",");
    let [width, height] = view.calibration.size;
    let mut lines = vec!["image size".to_owned(), format!("{width},{height}"), String::new()];
    lines.push("camera matrix".to_owned());
    lines.extend([row([fx, skew, cx]), row([0.0, fy, cy]), row([0.0, 0.0, 1.0]), String::new()]);
    lines.push("rotation".to_owned());
    lines.extend((0..3).map(|i| row([axes[(i, 0)], axes[(i, 1)], axes[(i, 2)]])));
    lines.extend([String::new(), "translation".to_owned()]);
    lines.extend(t.iter().map(|v| number(*v)));
    if let Some(coefficients) = view.coefficients.filter(|_| !options.without_distortion) {
        lines.extend([String::new(), "undistortion".to_owned()]);
        lines.extend(coefficients.map(number));
    }
    let text = lines.join("\n") + "\n";
    let mut lost = Vec::new();
    if view.pixel_mm.is_some() {
        lost.push("the size of a pixel, and with it the distance of the detector".to_owned());
    }
    let back = parse(Path::new(""), &text, options.pixel_origin).ok();
    checked(FORMAT, &[(view, back)], &NewWorld::same(), options, lost, text)
}

/// The camera matrix and `k1 k2 p1 p2 k3 k4 k5 k6`.
struct Undistortion {
    k: Matrix3<f64>,
    coefficients: [f64; 8],
}

impl Undistortion {
    /// The recorded point of an ideal one on the plane of depth 1, and the derivative.
    fn distort(&self, p: Vector2<f64>) -> (Vector2<f64>, Matrix2<f64>) {
        let [k1, k2, p1, p2, k3, k4, k5, k6] = self.coefficients;
        let (x, y) = (p.x, p.y);
        let r2 = p.norm_squared();
        let above = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        let below = 1.0 + r2 * (k4 + r2 * (k5 + r2 * k6));
        let s = above / below;
        // Derivative of s by r2.
        let ds =
            ((k1 + r2 * (2.0 * k2 + 3.0 * r2 * k3)) - s * (k4 + r2 * (2.0 * k5 + 3.0 * r2 * k6))) / below;
        let q = Vector2::new(
            x * s + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * s + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
        );
        let cross = 2.0 * x * y * ds + 2.0 * p1 * x + 2.0 * p2 * y;
        let j = Matrix2::new(
            s + 2.0 * x * x * ds + 2.0 * p1 * y + 6.0 * p2 * x,
            cross,
            cross,
            s + 2.0 * y * y * ds + 6.0 * p1 * y + 2.0 * p2 * x,
        );
        (q, j)
    }

    fn to_plane(&self, pixel: [f64; 2]) -> Vector2<f64> {
        let y = (pixel[1] - self.k[(1, 2)]) / self.k[(1, 1)];
        Vector2::new((pixel[0] - self.k[(0, 2)] - self.k[(0, 1)] * y) / self.k[(0, 0)], y)
    }

    fn to_pixel(&self, p: Vector2<f64>) -> [f64; 2] {
        [self.k[(0, 0)] * p.x + self.k[(0, 1)] * p.y + self.k[(0, 2)], self.k[(1, 1)] * p.y + self.k[(1, 2)]]
    }

    /// The ideal pixel of a recorded one: the solution that is connected with the middle of the picture.
    fn ideal(&self, recorded: [f64; 2]) -> Option<[f64; 2]> {
        let goal = self.to_plane(recorded);
        let mut p = goal;
        for _ in 0..50 {
            let (q, j) = self.distort(p);
            // On the far side of a fold the derivative has turned over.
            if j.determinant() <= 1e-3 {
                return None;
            }
            let step = j.try_inverse()? * (goal - q);
            p += step;
            if step.norm() * self.k[(0, 0)].max(self.k[(1, 1)]) < 1e-10 {
                let (_, j) = self.distort(p);
                return (j.determinant() > 1e-3 && p.iter().all(|v| v.is_finite())).then(|| self.to_pixel(p));
            }
        }
        None
    }

    /// Samples the map so densely that bicubic interpolation is good to 0.001 px in the picture.
    fn table(&self, size: [usize; 2]) -> Result<DistortionTable, String> {
        for step in [32.0, 16.0, 8.0, 4.0] {
            let table = self.sampled(size, step)?;
            if self.worst_interpolation(&table, size) < 5e-4 {
                return Ok(table);
            }
        }
        Err("undistortion varies too fast to be sampled every 4 px to 0.001 px; the coefficients cannot be those of a \
             fluoroscope"
            .to_owned())
    }

    /// On a grid that reaches two samples or more beyond the picture.
    fn sampled(&self, size: [usize; 2], step: f64) -> Result<DistortionTable, String> {
        let first = -2.0 * step;
        let count = size.map(|s| ((s as f64 - 1.0) / step).ceil() as usize + 5);
        let mut ideal_px = Vec::with_capacity(count[0] * count[1]);
        for row in 0..count[1] {
            for column in 0..count[0] {
                let recorded = [first + step * column as f64, first + step * row as f64];
                ideal_px.push(self.ideal(recorded).ok_or_else(|| {
                    format!(
                        "undistortion folds the picture over at pixel ({:.0}, {:.0}): no ideal pixel belongs to it; the \
                         coefficients (expected order k1 k2 p1 p2 k3 k4 k5 k6) cannot be those of this picture",
                        recorded[0], recorded[1]
                    )
                })?);
            }
        }
        Ok(DistortionTable { first_px: [first; 2], step_px: [step; 2], count, ideal_px })
    }

    /// Largest distance, px, of the model from Catmull-Rom interpolation half-way between samples, in the picture.
    fn worst_interpolation(&self, table: &DistortionTable, size: [usize; 2]) -> f64 {
        // Catmull-Rom weights half-way between two samples.
        const W: [f64; 4] = [-0.0625, 0.5625, 0.5625, -0.0625];
        let [columns, rows] = table.count;
        let step = table.step_px[0];
        let at = |c: usize, r: usize| Vector2::from(table.ideal_px[r * columns + c]);
        let mut worst: f64 = 0.0;
        for r in 1..rows - 2 {
            for c in 1..columns - 2 {
                let recorded = [c, r].map(|i| table.first_px[0] + step * (i as f64 + 0.5));
                if recorded[0] > size[0] as f64 + step || recorded[1] > size[1] as f64 + step {
                    continue;
                }
                let mut value = Vector2::zeros();
                for (j, wy) in W.iter().enumerate() {
                    for (i, wx) in W.iter().enumerate() {
                        value += at(c + i - 1, r + j - 1) * (wx * wy);
                    }
                }
                if let Some(ideal) = self.ideal(recorded) {
                    worst = worst.max((value - Vector2::from(ideal)).norm());
                }
            }
        }
        worst
    }
}
