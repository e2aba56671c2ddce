//! What a calibration's covariance says of its source, and of points seen through it.

use biplane_artifact::{Environment, ViewEnvironment};
use biplane_geometry::{Point2, Point3, Vector3};
use nalgebra::{DMatrix, Matrix3, Rotation3};

use crate::view::{VIEW, View};

/// An ellipsoid that holds the true source with a given probability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SourceRegion {
    /// Its middle: the estimate, mm.
    pub source: Point3,
    /// Covariance of the estimate, mm^2, laboratory axes.
    pub covariance: Matrix3<f64>,
    /// `d' C^-1 d` of points of its surface.
    pub limit: f64,
}

impl SourceRegion {
    /// Whether a place (mm, laboratory) lies in the region.
    pub fn holds(&self, place: &Point3) -> bool {
        let d = place - self.source;
        self.covariance.cholesky().is_some_and(|c| d.dot(&c.solve(&d)) <= self.limit)
    }
}

/// Covariance of a view's source, mm^2, laboratory axes; none where there is no such view, or the covariance has another size.
pub fn source_covariance(environment: &Environment, view: usize) -> Option<Matrix3<f64>> {
    let all = covariance(environment)?;
    (view < environment.views.len()).then(|| all.fixed_view::<3, 3>(VIEW * view, VIEW * view).into_owned())
}

/// The region that holds a view's source with a probability between 0 and 1 (0.95, say). The noise is estimated from the residuals,
/// so it is of the F distribution with 3 and with the view's residuals less its nine unknowns as degrees of freedom.
pub fn source_region(environment: &Environment, view: usize, probability: f64) -> Option<SourceRegion> {
    let covariance = source_covariance(environment, view)?;
    let found = environment.views.get(view)?;
    let used = found.beads.iter().filter(|b| b.used).count();
    let freedom = (2 * used).checked_sub(VIEW).filter(|f| *f > 0)?;
    let limit = 3.0 * f_quantile(3.0, freedom as f64, probability)?;
    Some(SourceRegion { source: Point3::from(found.source), covariance, limit })
}

/// Covariance of a laboratory point (mm) that is triangulated from all views of an environment in front of which it lies, mm^2: from the
/// standard deviation of its pixels' coordinates (ideal px) and from the calibration's covariance. None with fewer than two views.
pub fn covariance_of_point(environment: &Environment, point: &Point3, sigma_px: f64) -> Option<Matrix3<f64>> {
    let all = covariance(environment)?;
    let views: Vec<View> = environment.views.iter().map(view_of).collect();
    let mut information = Matrix3::zeros();
    let mut seen = 0;
    let mut by_calibration = DMatrix::zeros(3, all.nrows());
    for (i, view) in views.iter().enumerate() {
        let Some(shadow) = view.shadow_with_derivatives(point, 0.0) else { continue };
        seen += 1;
        information += shadow.by_point.transpose() * shadow.by_point;
        let pull = shadow.by_point.transpose() * shadow.by_view;
        by_calibration.fixed_view_mut::<3, VIEW>(0, VIEW * i).copy_from(&pull);
    }
    if seen < 2 {
        return None;
    }
    // The place of least reprojection error moves by -(H'H)^-1 H'G as the parameters do.
    let spread = information.cholesky()?.inverse();
    let moved: DMatrix<f64> = DMatrix::from_column_slice(3, 3, spread.as_slice()) * by_calibration;
    let of_calibration: DMatrix<f64> = &moved * all * moved.transpose();
    let of_calibration: Matrix3<f64> = of_calibration.fixed_view::<3, 3>(0, 0).into_owned();
    Some(spread * (sigma_px * sigma_px) + of_calibration)
}

/// The stored covariance as a matrix, if it has nine rows and columns a view.
fn covariance(environment: &Environment) -> Option<DMatrix<f64>> {
    let n = VIEW * environment.views.len();
    let rows = &environment.covariance;
    (rows.len() == n && rows.iter().all(|r| r.len() == n)).then(|| DMatrix::from_fn(n, n, |i, j| rows[i][j]))
}

/// The view as stored; of a mirrored one with `along_x` turned round, which changes neither distances of pixels nor how they move.
fn view_of(v: &ViewEnvironment) -> View {
    let (source, centre) = (Point3::from(v.source), Point3::from(v.centre));
    let (x, y) = (Vector3::from(v.along_x), Vector3::from(v.along_y));
    let x = if x.cross(&y).dot(&(centre - source)) < 0.0 { -x } else { x };
    let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, y, x.cross(&y)]));
    View { source, centre, rotation, pixel_mm: v.pixel_mm, middle: Point2::origin() }
}

/// The value that a variable of the F distribution stays below with a probability.
fn f_quantile(m: f64, n: f64, probability: f64) -> Option<f64> {
    if !(probability > 0.0 && probability < 1.0) {
        return None;
    }
    let below = |f: f64| incomplete_beta(m / 2.0, n / 2.0, m * f / (m * f + n));
    let (mut low, mut high) = (0.0, 1.0);
    while below(high) < probability && high < 1e12 {
        high *= 2.0;
    }
    for _ in 0..200 {
        let middle = (low + high) / 2.0;
        if below(middle) < probability { low = middle } else { high = middle }
    }
    Some((low + high) / 2.0)
}

/// The regularised incomplete beta function, by its continued fraction (DLMF 8.17.22).
fn incomplete_beta(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta(b, a, 1.0 - x);
    }
    let front = (a * x.ln() + b * (-x).ln_1p() + ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b)).exp() / a;
    // From the far end of the fraction inwards.
    let tail = (1..=300).rev().fold(1.0, |tail, k| {
        let half = f64::from(k / 2);
        let d = if k % 2 == 0 {
            half * (b - half) * x / ((a + 2.0 * half - 1.0) * (a + 2.0 * half))
        } else {
            -(a + half) * (a + b + half) * x / ((a + 2.0 * half) * (a + 2.0 * half + 1.0))
        };
        1.0 + d / tail
    });
    front / tail
}

/// Logarithm of the gamma function of a positive number: Stirling's series, above 10 after the recurrence.
fn ln_gamma(x: f64) -> f64 {
    let (mut x, mut product) = (x, 1.0);
    while x < 10.0 {
        product *= x;
        x += 1.0;
    }
    let i = 1.0 / (x * x);
    let series = (1.0 / 12.0 - i * (1.0 / 360.0 - i * (1.0 / 1260.0 - i / 1680.0))) / x;
    (x - 0.5) * x.ln() - x + 0.5 * std::f64::consts::TAU.ln() + series - product.ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables() {
        // NIST/SEMATECH e-Handbook, 1.3.6.7.3, upper 5 % and 10 % points.
        for (n, p, table) in [
            (3.0, 0.95, 9.277),
            (10.0, 0.95, 3.708),
            (51.0, 0.95, 2.786),
            (100.0, 0.95, 2.696),
            (20.0, 0.90, 2.380),
        ] {
            let found = f_quantile(3.0, n, p).unwrap();
            assert!((found - table).abs() < 6e-4, "{n} {p}: {found}");
        }
        assert_eq!(f_quantile(3.0, 10.0, 1.0), None);
    }
}
