//! Local weighted mean: a polynomial of degree 2 at each spot, through it and its nearest neighbours, and between the spots their
//! weighted mean (A. Goshtasby, Image registration by local approximation methods, Image and Vision Computing 6, 1988; `lwm`
//! of MATLAB; XMALab).
//!
//! A polynomial's weight at a distance `d` from its spot is `1 - 3 R^2 + 2 R^3` with `R = d / radius`, where the radius is the
//! distance of the farthest spot that it was fitted to, and 0 from `R = 1` on; so the mean is continuous with its derivative. A
//! polynomial of the whole picture takes part in every mean with a weight of a thousandth: where some weight reaches it
//! changes the map by a thousandth of their difference, and in holes among the spots, where none does, it is the map.

use biplane_geometry::{Point2, Vector2};
use nalgebra::{Matrix2, Matrix6, Matrix6x2, SMatrix, Vector6};

use crate::nearby::Nearby;
use crate::polynomial::Polynomial;

/// The model's name in reports.
pub(crate) const NAME: &str = "local weighted mean";

/// Weight of the polynomial of the whole picture.
const WHOLE: f64 = 1e-3;

/// Added to the squared sizes of the columns of a local fit, in parts of them: where neighbours do not determine a polynomial of
/// degree 2 (they lie on a conic) its smallest one is taken. It changes one that is determined by less than 1e-6 of its size.
const RIDGE: f64 = 1e-10;

/// The map.
#[derive(Debug, Clone)]
pub(crate) struct LocalWeightedMean {
    local: Vec<Local>,
    spots: Nearby,
    widest_px: f64,
    whole: Polynomial,
}

/// The polynomial of one spot.
#[derive(Debug, Clone)]
struct Local {
    at: Point2,
    radius_px: f64,
    /// Of `1, u, v, u^2, u v, v^2`, where `(u, v)` is the way from the spot over the radius.
    coefficients: Matrix6x2<f64>,
}

/// The terms of degree 2 and their derivatives by `u` and `v`.
fn terms(q: &Vector2) -> (Vector6<f64>, SMatrix<f64, 6, 2>) {
    let (u, v) = (q.x, q.y);
    (
        Vector6::new(1.0, u, v, u * u, u * v, v * v),
        SMatrix::from_columns(&[
            Vector6::new(0.0, 1.0, 0.0, 2.0 * u, v, 0.0),
            Vector6::new(0.0, 0.0, 1.0, 0.0, u, 2.0 * v),
        ]),
    )
}

impl Local {
    /// Fits `near`, spots with their displacements.
    fn new(at: Point2, near: &[(Point2, Vector2)]) -> Self {
        let radius_px = near.iter().map(|(p, _)| (p - at).norm()).fold(0.0, f64::max).max(1e-9);
        let (mut normal, mut right) = (Matrix6::zeros(), Matrix6x2::zeros());
        for (p, displacement) in near {
            let (row, _) = terms(&((p - at) / radius_px));
            normal += row * row.transpose();
            right += row * displacement.transpose();
        }
        for k in 0..6 {
            normal[(k, k)] += RIDGE * (1.0 + normal[(k, k)]);
        }
        let coefficients = normal.cholesky().map_or_else(Matrix6x2::zeros, |c| c.solve(&right));
        Self { at, radius_px, coefficients }
    }

    /// Displacement at a point and its derivative, each times the weight; the weight and its gradient. `None` beyond the radius.
    fn weighed(&self, p: &Point2) -> Option<(Vector2, Matrix2<f64>, f64, Vector2)> {
        let q = (p - self.at) / self.radius_px;
        let r2 = q.norm_squared();
        if r2 >= 1.0 {
            return None;
        }
        let r = r2.sqrt();
        let weight = 1.0 + r2 * (2.0 * r - 3.0);
        // d weight / d r = 6 r^2 - 6 r, and d r / d p = q / (r radius).
        let gradient = q * (6.0 * (r - 1.0) / self.radius_px);
        let (row, slopes) = terms(&q);
        let value = self.coefficients.transpose() * row;
        let derivative = self.coefficients.transpose() * slopes / self.radius_px;
        Some((value * weight, derivative * weight + value * gradient.transpose(), weight, gradient))
    }
}

/// The mean at a point of what reaches it.
fn mean<'a>(
    locals: impl Iterator<Item = &'a Local>,
    whole: &Polynomial,
    p: &Point2,
) -> (Point2, Matrix2<f64>) {
    let (at, slope) = whole.at(p);
    let (mut value, mut derivative) = ((at - p) * WHOLE, (slope - Matrix2::identity()) * WHOLE);
    let (mut weight, mut gradient) = (WHOLE, Vector2::zeros());
    for (v, d, w, g) in locals.filter_map(|l| l.weighed(p)) {
        value += v;
        derivative += d;
        weight += w;
        gradient += g;
    }
    let value = value / weight;
    let derivative = (derivative - value * gradient.transpose()) / weight;
    (p + value, Matrix2::identity() + derivative)
}

impl LocalWeightedMean {
    /// Fits spots, `neighbours` to a polynomial (the spot itself is one of them). The second result is, for each spot,
    /// where a map would take it that was made without it, all polynomials anew.
    pub(crate) fn fit(
        recorded: &[Point2],
        target: &[Point2],
        neighbours: usize,
        whole: &Polynomial,
    ) -> (Self, Vec<Point2>) {
        let spots = Nearby::new(recorded.to_vec());
        let displaced: Vec<(Point2, Vector2)> =
            recorded.iter().zip(target).map(|(p, q)| (*p, q - p)).collect();
        // One more, which takes the place of a spot that is held out.
        let near: Vec<Vec<(usize, f64)>> =
            recorded.iter().map(|p| spots.closest(p, neighbours + 1)).collect();
        let fitted = |of: usize, without: Option<usize>| {
            let kept = near[of].iter().map(|n| n.0).filter(|i| Some(*i) != without).take(neighbours);
            Local::new(recorded[of], &kept.map(|i| displaced[i]).collect::<Vec<_>>())
        };
        let local: Vec<Local> = (0..recorded.len()).map(|of| fitted(of, None)).collect();

        // A spot reaches those polynomials alone that were fitted to it.
        let mut fitted_to: Vec<Vec<usize>> = vec![Vec::new(); recorded.len()];
        for (of, list) in near.iter().enumerate() {
            for (i, _) in list.iter().take(neighbours).filter(|(i, _)| *i != of) {
                fitted_to[*i].push(of);
            }
        }
        let held_out = fitted_to.iter().enumerate().map(|(i, reaching)| {
            let anew: Vec<Local> = reaching.iter().map(|of| fitted(*of, Some(i))).collect();
            mean(anew.iter(), whole, &recorded[i]).0
        });
        let held_out = held_out.collect();
        let widest_px = local.iter().map(|l| l.radius_px).fold(0.0, f64::max);
        (Self { local, spots, widest_px, whole: whole.clone() }, held_out)
    }

    /// Where a recorded pixel belongs, and the derivative.
    pub(crate) fn at(&self, p: &Point2) -> (Point2, Matrix2<f64>) {
        let reaching = self.spots.within(p, self.widest_px);
        mean(reaching.iter().map(|(i, _)| &self.local[*i]), &self.whole, p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Vec<Point2> {
        (0..200)
            .map(|k| Point2::new(f64::from(k % 20) * 10.0 + f64::from(k * 7 % 3), f64::from(k / 20) * 11.0))
            .collect()
    }

    #[test]
    fn polynomials_of_degree_two_are_met_and_slopes_are_those_of_differences() {
        let recorded = grid();
        let truth = |p: &Point2| p + Vector2::new(p.x * p.y * 1e-3 - 2.0, p.y * p.y * 2e-4 + p.x * 0.01);
        let target: Vec<Point2> = recorded.iter().map(truth).collect();
        let whole = Polynomial::fit(&recorded, &target, &vec![1.0; recorded.len()], 2).unwrap().polynomial;
        let (map, held_out) = LocalWeightedMean::fit(&recorded, &target, 12, &whole);
        for (held, at) in held_out.iter().zip(&target) {
            assert!((held - at).norm() < 1e-5);
        }
        // A map that is no polynomial of degree 2, so that the weights' slopes count.
        let bent: Vec<Point2> =
            recorded.iter().map(|p| p + Vector2::new((p.x / 15.0).sin(), (p.y / 20.0).cos()) * 2.0).collect();
        let (wavy, _) = LocalWeightedMean::fit(&recorded, &bent, 12, &whole);
        for k in 0..100 {
            let p = Point2::new(f64::from(k * 37 % 180) + 3.3, f64::from(k * 53 % 95) + 0.7);
            assert!((map.at(&p).0 - truth(&p)).norm() < 1e-5);
            let (_, derivative) = wavy.at(&p);
            for axis in 0..2 {
                let step = Vector2::ith(axis, 1e-5);
                let numeric = (wavy.at(&(p + step)).0 - wavy.at(&(p - step)).0) / 2e-5;
                assert!((numeric - derivative.column(axis)).norm() < 1e-6);
            }
        }
        // Where no weight reaches it is the polynomial of the whole.
        let far = Point2::new(500.0, 400.0);
        assert!((map.at(&far).0 - truth(&far)).norm() < 1e-6);
    }

    #[test]
    fn what_is_held_out_is_what_a_map_without_the_spot_says() {
        let recorded = grid();
        let target: Vec<Point2> =
            recorded.iter().map(|p| p + Vector2::new((p.x * 0.05).sin(), (p.x * p.y * 1e-3).cos())).collect();
        let whole = Polynomial::fit(&recorded, &target, &vec![1.0; recorded.len()], 3).unwrap().polynomial;
        let (_, held_out) = LocalWeightedMean::fit(&recorded, &target, 12, &whole);
        for of in [0, 7, 105, 199] {
            let without = |all: &[Point2]| -> Vec<Point2> {
                all.iter().enumerate().filter(|(i, _)| *i != of).map(|(_, p)| *p).collect()
            };
            let (map, _) = LocalWeightedMean::fit(&without(&recorded), &without(&target), 12, &whole);
            assert!((map.at(&recorded[of]).0 - held_out[of]).norm() < 1e-12);
        }
    }
}
