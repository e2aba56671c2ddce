//! Frames from two directions: the first is kept, the second is made square to it.

use biplane_geometry::Vector3;
use nalgebra::Matrix3;

/// One of the three axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Axis {
    /// Anterior.
    X,
    /// Proximal.
    Y,
    /// To the subject's right: lateral of a right body.
    Z,
}

impl Axis {
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x (anterior)",
            Self::Y => "y (proximal)",
            Self::Z => "z (to the right)",
        }
    }

    fn number(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
            Self::Z => 2,
        }
    }
}

/// An orthonormal right-handed frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frame {
    pub origin: Vector3,
    /// x, y, z.
    pub axes: [Vector3; 3],
}

impl Frame {
    /// The frame whose axis `kept.0` points along `kept.1` and whose axis `second.0` lies in the half plane of `second.1`. None where
    /// the two directions are nearly parallel (less than 5 degrees) or have no length.
    pub fn of(origin: Vector3, kept: (Axis, Vector3), second: (Axis, Vector3)) -> Option<Self> {
        let (i, j) = (kept.0.number(), second.0.number());
        let first = kept.1.try_normalize(1e-9)?;
        let other = second.1.try_normalize(1e-9)?;
        let square = other - first * other.dot(&first);
        if i == j || square.norm() < 5_f64.to_radians().sin() {
            return None;
        }
        let square = square.normalize();
        // The third follows in the cycle x, y, z.
        let third = if (i + 1) % 3 == j { first.cross(&square) } else { square.cross(&first) };
        let mut axes = [third; 3];
        axes[i] = first;
        axes[j] = square;
        Some(Self { origin, axes })
    }

    /// The largest of the angles between the axes of two frames that go together, degrees.
    pub fn angle_to(&self, other: &Self) -> f64 {
        let turn = |f: &Self| Matrix3::from_columns(&f.axes);
        let trace = (turn(self).transpose() * turn(other)).trace();
        ((trace - 1.0) / 2.0).clamp(-1.0, 1.0).acos().to_degrees()
    }
}

/// Angle between two directions, degrees.
pub(crate) fn angle_deg(a: &Vector3, b: &Vector3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b)).to_degrees()
}

/// A unit vector at right angles to a unit vector.
pub(crate) fn square_to(a: &Vector3) -> Vector3 {
    let least = if a.x.abs() <= a.y.abs() && a.x.abs() <= a.z.abs() {
        Vector3::x()
    } else if a.y.abs() <= a.z.abs() {
        Vector3::y()
    } else {
        Vector3::z()
    };
    a.cross(&least).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kept_and_squared_in_every_order() {
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
        for ((a, u), (b, v)) in [
            ((Axis::X, x), (Axis::Y, y + 0.2 * x)),
            ((Axis::Y, y), (Axis::X, x + 0.2 * y)),
            ((Axis::Y, y), (Axis::Z, z - 0.2 * y)),
            ((Axis::Z, z), (Axis::Y, y - 0.3 * z)),
            ((Axis::Z, z), (Axis::X, x - 0.3 * z)),
            ((Axis::X, x), (Axis::Z, z - 0.3 * x)),
        ] {
            let f = Frame::of(Vector3::zeros(), (a, 3.0 * u), (b, v)).unwrap();
            for (found, wanted) in f.axes.iter().zip([x, y, z]) {
                assert!((found - wanted).norm() < 1e-12, "{a:?} {b:?}: {f:?}");
            }
        }
        assert!(Frame::of(Vector3::zeros(), (Axis::X, x), (Axis::Y, x + 0.01 * y)).is_none());
        assert!(Frame::of(Vector3::zeros(), (Axis::X, x), (Axis::X, y)).is_none());
        assert!(Frame::of(Vector3::zeros(), (Axis::X, Vector3::zeros()), (Axis::Y, y)).is_none());
    }
}
