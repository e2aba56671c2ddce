//! How well beads can tell where fluoroscopes are, whoever computes it: the Cramer-Rao bound, from the true geometry alone.
//!
//! With independent normal noise of standard deviation `sigma` on both coordinates of each centre, the information of a view
//! is `J'J / sigma^2`, where `J` has the derivatives of the centres by the view's nine parameters; its inverse is the least
//! covariance that an unbiased estimate has. Derivatives are central differences of the true projection. A bead's centre
//! counts here, not that of its shadow: they move alike.

use biplane_geometry::{Point2, Point3, Vector3};
use biplane_phantom::TrueFluoroscope;
use nalgebra::{Matrix2, Matrix2x3, Matrix3, Matrix4, Matrix4x3, Rotation3, SMatrix};

/// Derivatives of a pixel by a view's parameters, in the order of the product's covariance: source (mm), middle of the
/// detector (mm), rotation of the detector about its middle (rad), all along laboratory axes.
pub type ByView = SMatrix<f64, 2, 9>;
/// Covariance of those parameters.
pub type ViewCovariance = SMatrix<f64, 9, 9>;

/// Step of the differences, mm and rad.
const STEP: [f64; 3] = [1e-2, 1e-2, 1e-5];

/// A view with its parameters changed.
pub fn changed(view: &TrueFluoroscope, by: &[f64; 9]) -> TrueFluoroscope {
    let [source, centre, turn] = [0, 3, 6].map(|i| Vector3::new(by[i], by[i + 1], by[i + 2]));
    let turn = Rotation3::from_scaled_axis(turn);
    TrueFluoroscope {
        source: view.source + source,
        centre: view.centre + centre,
        along_x: turn * view.along_x,
        along_y: turn * view.along_y,
        ..view.clone()
    }
}

fn pixel(view: &TrueFluoroscope, point: &Point3) -> Option<Point2> {
    view.project(point).map(|p| p.0)
}

fn by_view(view: &TrueFluoroscope, point: &Point3) -> Option<ByView> {
    let mut derivative = ByView::zeros();
    for k in 0..9 {
        let at = |side: f64| {
            let mut by = [0.0; 9];
            by[k] = side * STEP[k / 3];
            pixel(&changed(view, &by), point)
        };
        derivative.set_column(k, &((at(1.0)? - at(-1.0)?) / (2.0 * STEP[k / 3])));
    }
    Some(derivative)
}

fn by_point(view: &TrueFluoroscope, point: &Point3) -> Option<Matrix2x3<f64>> {
    let mut derivative = Matrix2x3::zeros();
    for k in 0..3 {
        let step = Vector3::ith(k, STEP[0]);
        let difference = pixel(view, &(point + step))? - pixel(view, &(point - step))?;
        derivative.set_column(k, &(difference / (2.0 * STEP[0])));
    }
    Some(derivative)
}

/// The least covariance of a view's parameters from beads seen at `points`; `None` where they do not determine them.
pub fn of_view<'a>(
    view: &TrueFluoroscope,
    points: impl IntoIterator<Item = &'a Point3>,
    sigma_px: f64,
) -> Option<ViewCovariance> {
    let mut information = ViewCovariance::zeros();
    for point in points {
        let derivative = by_view(view, point)?;
        information += derivative.transpose() * derivative / (sigma_px * sigma_px);
    }
    // Millimetres and radians: balanced first, lest the inverse lose its digits.
    let scale = information.diagonal().map(|v| 1.0 / v.sqrt());
    let scale = ViewCovariance::from_diagonal(&scale);
    Some(scale * (scale * information * scale).try_inverse()? * scale)
}

/// A view as what triangulates with it knows it.
#[derive(Debug, Clone, Copy)]
pub struct Known<'a> {
    /// Where it is.
    pub view: &'a TrueFluoroscope,
    /// How well that is known.
    pub covariance: &'a ViewCovariance,
    /// Noise of each coordinate of a pixel, px.
    pub sigma_px: f64,
}

/// The least covariance of a point seen in two views, mm^2: of all that its four pixels and the views' covariances tell of
/// it.
pub fn of_point(views: [Known; 2], point: &Point3) -> Option<Matrix3<f64>> {
    let mut derivative = Matrix4x3::zeros();
    let mut covariance = Matrix4::zeros();
    for (index, Known { view, covariance: of_view, sigma_px }) in views.into_iter().enumerate() {
        let by = by_view(view, point)?;
        let noise = Matrix2::identity() * (sigma_px * sigma_px) + by * of_view * by.transpose();
        covariance.fixed_view_mut::<2, 2>(2 * index, 2 * index).copy_from(&noise);
        derivative.fixed_view_mut::<2, 3>(2 * index, 0).copy_from(&by_point(view, point)?);
    }
    (derivative.transpose() * covariance.try_inverse()? * derivative).try_inverse()
}

/// The point whose projections are nearest to ideal pixels, a view each (least squares); `None` where there is none.
pub fn triangulated(
    views: &[biplane_fluoroscope::Fluoroscope],
    pixels: &[Point2],
    start: &Point3,
) -> Option<Point3> {
    let mut point = *start;
    for _ in 0..20 {
        let (mut information, mut towards) = (Matrix3::zeros(), Vector3::zeros());
        for (view, pixel) in views.iter().zip(pixels) {
            let (at, derivative) = view.project_with_derivative(&point)?;
            information += derivative.transpose() * derivative;
            towards += derivative.transpose() * (pixel - at.pixel);
        }
        let step = information.try_inverse()? * towards;
        point += step;
        if step.norm() < 1e-9 {
            break;
        }
    }
    Some(point)
}

/// Quantile of Fisher's F distribution with `k` and `n` degrees of freedom: the density is summed up, and what it sums up to
/// over all is taken as one.
pub fn fisher_quantile(k: f64, n: f64, share: f64) -> f64 {
    // Over t in 0..1 with x = (t / (1 - t))^2, so that all x are met and a density that begins as x^(-1/2) or x^(1/2) is smooth.
    const STEPS: usize = 20_000;
    let x = |i: usize| {
        let t = (i as f64 + 0.5) / STEPS as f64;
        (t / (1.0 - t)).powi(2)
    };
    let density = |i: usize| {
        let (x, t) = (x(i), (i as f64 + 0.5) / STEPS as f64);
        let by_t = 2.0 * x.sqrt() / (1.0 - t).powi(2);
        ((k / 2.0 - 1.0) * x.ln() - (k + n) / 2.0 * (1.0 + k * x / n).ln()).exp() * by_t
    };
    let all: f64 = (0..STEPS).map(density).sum();
    let mut sum = 0.0;
    (0..STEPS)
        .find(|&i| {
            sum += density(i);
            sum >= share * all
        })
        .map_or(f64::INFINITY, x)
}

/// `error' covariance^-1 error` over the number of its coordinates: to be compared with a quantile of F.
pub fn normalised_square(error: &Vector3, covariance: &Matrix3<f64>) -> Option<f64> {
    Some(error.dot(&covariance.cholesky()?.solve(error)) / 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_phantom::biplane;

    #[test]
    fn quantiles_are_those_of_tables() {
        // Abramowitz and Stegun (1964), Table 26.9, F at 0.05: 2.84 for 3 and 40, 2.76 for 3 and 60, 4.96 for 1 and 10.
        for (k, n, expected) in [(3.0, 40.0, 2.84), (3.0, 60.0, 2.76), (1.0, 10.0, 4.96)] {
            let found = fisher_quantile(k, n, 0.95);
            assert!((found - expected).abs() < 0.01, "{k}, {n}: {found}");
        }
    }

    #[test]
    fn four_times_the_noise_is_four_times_the_bound_and_more_beads_lower_it() {
        let [view, _] = biplane(90.0);
        let points: Vec<Point3> = (0..27)
            .map(|i| Point3::new(f64::from(i % 3 - 1), f64::from(i / 3 % 3 - 1), f64::from(i / 9 - 1)) * 50.0)
            .collect();
        let bound = |points: &[Point3], sigma| of_view(&view, points, sigma).unwrap();
        let (one, four) = (bound(&points, 0.1), bound(&points, 0.4));
        let few = bound(&points[3..], 0.1);
        for i in 0..9 {
            assert!((four[(i, i)] / one[(i, i)] - 16.0).abs() < 1e-3);
            assert!(few[(i, i)] > one[(i, i)]);
        }
        // Along the view the source is known worse than across it: the distance follows from the perspective alone.
        assert!(one[(1, 1)] > 4.0 * one[(0, 0)]);
        // Beads in a plane at a right angle to the view tell nothing of the distance.
        let flat: Vec<Point3> = points.iter().filter(|p| p.y == 0.0).copied().collect();
        assert!(of_view(&view, &flat, 0.1).is_none_or(|c| c[(1, 1)] > 1e3 * one[(1, 1)]));
    }
}
