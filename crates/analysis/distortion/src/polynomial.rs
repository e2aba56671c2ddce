//! One polynomial in x and y for a whole picture: the thesis's model of distortion (2.2.1, A.1.1; there of degree 4).
//!
//! The basis is the products `T_i(u) T_j(v)`, `i + j <= degree`, of Chebyshev polynomials, where `(u, v)` is the pixel less the
//! middle of the spots over the distance of the farthest: then the columns are of one size and nearly at right angles (a
//! test prints their condition number for degree 7 over a round picture: 303, where powers of pixels have 3e20). Least squares by the
//! singular values of the weighted design (faer): they give the coefficients, the rank, and with `|U_i|^2` the leverage of each
//! spot. **Not guaranteed:** anything beyond the spots, where a polynomial runs away; see `Reach`.

use biplane_geometry::{Point2, Vector2};
use faer::Mat;
use nalgebra::Matrix2;

use crate::model::FitError;

/// Highest degree.
pub(crate) const MOST_DEGREE: u32 = 7;

/// Values of a one-dimensional basis up to the highest degree.
type Powers = [f64; MOST_DEGREE as usize + 1];

/// Condition number above which spots do not determine a polynomial: their own errors are magnified by it. Spots that fill a
/// picture have some hundreds; spots on a line or a circle reach 1e15.
const MOST_CONDITION: f64 = 1e6;

/// Number of coefficients, for each of x and y.
pub(crate) fn coefficients(degree: u32) -> usize {
    let n = degree as usize;
    (n + 1) * (n + 2) / 2
}

/// The map and where it is well scaled.
#[derive(Debug, Clone)]
pub(crate) struct Polynomial {
    degree: u32,
    middle: Point2,
    scale_px: f64,
    coefficients: Vec<Vector2>,
}

/// A polynomial through weighted spots.
#[derive(Debug, Clone)]
pub(crate) struct Solved {
    /// The map.
    pub(crate) polynomial: Polynomial,
    /// Share of each spot's own position in what the map says there, 0 to 1; 0 for a spot of no weight.
    pub(crate) leverage: Vec<f64>,
}

/// Chebyshev polynomials of the first kind and their derivatives.
fn chebyshev(x: f64) -> (Powers, Powers) {
    let (mut value, mut slope) = (Powers::default(), Powers::default());
    (value[0], value[1], slope[1]) = (1.0, x, 1.0);
    for k in 2..value.len() {
        value[k] = 2.0 * x * value[k - 1] - value[k - 2];
        slope[k] = 2.0 * value[k - 1] + 2.0 * x * slope[k - 1] - slope[k - 2];
    }
    (value, slope)
}

/// Exponents in the order of the coefficients.
fn exponents(degree: u32) -> impl Iterator<Item = (usize, usize)> {
    let n = degree as usize;
    (0..=n).flat_map(move |j| (0..=n - j).map(move |i| (i, j)))
}

impl Polynomial {
    /// Fits spots by weighted least squares. Weights are 0 or positive; the scale is that of the spots with weight.
    ///
    /// # Errors
    /// The spots do not determine a polynomial of this degree.
    pub(crate) fn fit(
        recorded: &[Point2],
        target: &[Point2],
        weights: &[f64],
        degree: u32,
    ) -> Result<Solved, FitError> {
        let weighed = || recorded.iter().zip(weights).filter(|(_, w)| **w > 0.0).map(|(p, _)| p);
        let columns = coefficients(degree);
        let found = weighed().count();
        if found < columns {
            return Err(FitError::TooFew { model: name(degree), found, needed: columns });
        }
        let (mut low, mut high) = (Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY));
        for p in weighed() {
            (low, high) = (low.inf(&p.coords), high.sup(&p.coords));
        }
        let middle = Point2::from((low + high) / 2.0);
        let farthest = weighed().map(|p| (p - middle).norm()).fold(0.0, f64::max);
        let badly = |condition: f64| FitError::BadlyPlaced { model: name(degree), found, condition };
        if farthest.is_nan() || farthest <= 0.0 {
            return Err(badly(f64::INFINITY));
        }
        let mut polynomial = Self { degree, middle, scale_px: farthest, coefficients: Vec::new() };

        let mut design = Mat::zeros(recorded.len(), columns);
        for (row, (p, weight)) in recorded.iter().zip(weights).enumerate() {
            let ((u, _), (v, _)) = polynomial.scaled(p);
            let root = weight.sqrt();
            for (column, (i, j)) in exponents(degree).enumerate() {
                design[(row, column)] = root * u[i] * v[j];
            }
        }
        let svd = design.thin_svd().map_err(|_| badly(f64::NAN))?;
        let (u, s, v) = (svd.U(), svd.S().column_vector(), svd.V());
        let condition = s[0] / s[columns - 1];
        if condition.is_nan() || condition > MOST_CONDITION {
            return Err(badly(condition));
        }
        // What U says of the displacements, which are small, then V over the singular values.
        let mut along = vec![Vector2::zeros(); columns];
        for (row, ((p, q), weight)) in recorded.iter().zip(target).zip(weights).enumerate() {
            let displacement = (q - p) * weight.sqrt();
            for (column, sum) in along.iter_mut().enumerate() {
                *sum += displacement * u[(row, column)];
            }
        }
        polynomial.coefficients =
            (0..columns).map(|row| (0..columns).map(|k| along[k] * (v[(row, k)] / s[k])).sum()).collect();
        let leverage =
            (0..recorded.len()).map(|row| (0..columns).map(|k| u[(row, k)].powi(2)).sum()).collect();
        Ok(Solved { polynomial, leverage })
    }

    /// The basis at a pixel, along x and y.
    fn scaled(&self, p: &Point2) -> ((Powers, Powers), (Powers, Powers)) {
        let q = (p - self.middle) / self.scale_px;
        (chebyshev(q.x), chebyshev(q.y))
    }

    /// Where a recorded pixel belongs, and the derivative.
    pub(crate) fn at(&self, p: &Point2) -> (Point2, Matrix2<f64>) {
        let ((u, du), (v, dv)) = self.scaled(p);
        let (mut value, mut by_x, mut by_y) = (p.coords, Vector2::zeros(), Vector2::zeros());
        for ((i, j), c) in exponents(self.degree).zip(&self.coefficients) {
            value += c * (u[i] * v[j]);
            by_x += c * (du[i] * v[j]);
            by_y += c * (u[i] * dv[j]);
        }
        let slope = Matrix2::from_columns(&[by_x / self.scale_px, by_y / self.scale_px]);
        (Point2::from(value), Matrix2::identity() + slope)
    }
}

/// The model's name in reports.
pub(crate) fn name(degree: u32) -> String {
    format!("polynomial, degree {degree}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_is_met_with_its_slopes() {
        let spots: Vec<Point2> = (0..200)
            .map(|k| Point2::new(f64::from(k * 37 % 211) * 5.0, f64::from(k * 53 % 199) * 4.0))
            .collect();
        let truth = |p: &Point2| {
            let q = (p - Point2::new(500.0, 400.0)) / 500.0;
            p + Vector2::new(q.x.powi(5) * q.y.powi(2) - q.y, 3.0 * q.x.powi(3) - q.y.powi(7))
        };
        let target: Vec<Point2> = spots.iter().map(truth).collect();
        let solved = Polynomial::fit(&spots, &target, &vec![1.0; 200], 7).unwrap();
        // The trace of the hat matrix is the number of coefficients.
        assert!((solved.leverage.iter().sum::<f64>() - 36.0).abs() < 1e-9);
        for p in [Point2::new(512.3, 401.0), Point2::new(20.0, 790.0)] {
            let (value, slope) = solved.polynomial.at(&p);
            assert!((value - truth(&p)).norm() < 1e-8);
            for axis in 0..2 {
                let h = Vector2::ith(axis, 1e-3);
                let numeric = (truth(&(p + h)) - truth(&(p - h))) / 2e-3;
                assert!((numeric - slope.column(axis)).norm() < 1e-7);
            }
        }
    }

    #[test]
    fn the_basis_is_conditioned_well_where_powers_of_pixels_are_not() {
        // 700 spots spread evenly over a round picture, by the golden angle.
        let spots: Vec<Point2> = (0..700)
            .map(|k| {
                let (sin, cos) = (2.399_963 * f64::from(k)).sin_cos();
                Point2::new(511.5, 511.5) + Vector2::new(cos, sin) * (500.0 * (f64::from(k) / 700.0).sqrt())
            })
            .collect();
        let condition = |of: &dyn Fn(&Point2, usize, usize) -> f64| {
            let exponents: Vec<(usize, usize)> = exponents(7).collect();
            let design = Mat::from_fn(700, 36, |row, k| of(&spots[row], exponents[k].0, exponents[k].1));
            let s = design.singular_values().unwrap();
            s[0] / s[35]
        };
        let solved = Polynomial::fit(&spots, &spots, &vec![1.0; 700], 7).unwrap();
        let ours = condition(&|p, i, j| {
            let ((u, _), (v, _)) = solved.polynomial.scaled(p);
            u[i] * v[j]
        });
        let powers = condition(&|p, i, j| p.x.powi(i as i32) * p.y.powi(j as i32));
        println!("condition number {ours:.1}, of powers of pixels {powers:.1e}");
        assert!(ours < 1000.0 && powers > 1e17);
    }
}
