//! Which three turns and which three lengths describe a joint.
//!
//! **Grood and Suntay**, for bodies with ISB axes (x anterior, y proximal, z to the right). `e1` is the proximal body's z axis, `e3` the
//! distal one's y axis, `e2 = e3 x e1`, normalised, points forward. Angles are turns of the distal body against the proximal one, translations
//! components of the vector `H` from the proximal origin to the distal one:
//!
//! | value | about or along | positive, knee |
//! |---|---|---|
//! | flexion | `-e1` | the foot goes back |
//! | adduction | `e2`, left `-e2` | the foot goes towards the middle (varus) |
//! | internal rotation | `e3`, left `-e3` | the toes go towards the middle |
//! | lateral | `H . e1`, left `-H . e1` | the tibia goes outwards |
//! | anterior | `H . e2` | the tibia goes forward |
//! | distraction | `-H . e3` | the tibia goes away from the femur |
//!
//! A **sequence** such as `zxy` turns about the proximal body's z axis, the new x axis and the new y axis, which is then the distal body's; its
//! translations are the components of `H` along the proximal body's x, y and z. It knows no side.

use biplane_artifact::Side;
use nalgebra::{Matrix3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a joint is described.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Convention {
    /// Grood and Suntay's angles and translations.
    #[default]
    GroodSuntay,
    /// Turns about x, then the new y, then the new z.
    Xyz,
    /// x, y, x.
    Xyx,
    /// x, z, y.
    Xzy,
    /// x, z, x.
    Xzx,
    /// y, x, z.
    Yxz,
    /// y, x, y.
    Yxy,
    /// y, z, x.
    Yzx,
    /// y, z, y.
    Yzy,
    /// z, x, y.
    Zxy,
    /// z, x, z.
    Zxz,
    /// z, y, x.
    Zyx,
    /// z, y, z.
    Zyz,
}

/// The axes of three turns, each 0 for x, 1 for y, 2 for z; neighbours differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sequence(pub [usize; 3]);

impl Convention {
    /// Its turns. Grood and Suntay's are z, x, y.
    pub fn sequence(self) -> Sequence {
        Sequence(match self {
            Self::GroodSuntay | Self::Zxy => [2, 0, 1],
            Self::Xyz => [0, 1, 2],
            Self::Xyx => [0, 1, 0],
            Self::Xzy => [0, 2, 1],
            Self::Xzx => [0, 2, 0],
            Self::Yxz => [1, 0, 2],
            Self::Yxy => [1, 0, 1],
            Self::Yzx => [1, 2, 0],
            Self::Yzy => [1, 2, 1],
            Self::Zxz => [2, 0, 2],
            Self::Zyx => [2, 1, 0],
            Self::Zyz => [2, 1, 2],
        })
    }

    /// Names of the three angles and the three translations, as columns of a table have them (without their units).
    pub fn names(self) -> [String; 6] {
        match self {
            Self::GroodSuntay => {
                ["flexion", "adduction", "internal_rotation", "lateral", "anterior", "distraction"]
                    .map(str::to_owned)
            }
            _ => {
                let letters = ["x", "y", "z"];
                let turn = |k: usize| format!("turn{}_{}", k + 1, letters[self.sequence().0[k]]);
                let [x, y, z] = letters.map(|l| format!("along_{l}"));
                [turn(0), turn(1), turn(2), x, y, z]
            }
        }
    }

    /// Signs of the three angles of the sequence and of the three translations.
    pub(crate) fn signs(self, side: Side) -> [f64; 6] {
        let side = if side == Side::Left { -1.0 } else { 1.0 };
        match self {
            Self::GroodSuntay => [-1.0, side, side, side, 1.0, -1.0],
            _ => [1.0; 6],
        }
    }
}

impl Sequence {
    /// Whether the first and the third axis are of one name, as in Euler's own angles.
    pub fn proper(self) -> bool {
        self.0[0] == self.0[2]
    }

    /// The three turns that make up `rotation`, rad: in -pi to pi, the second in -pi/2 to pi/2, or 0 to pi where the sequence is proper. Where
    /// the first and third axes are parallel (a gimbal's lock) the third is 0.
    pub fn angles(self, rotation: &Matrix3<f64>) -> [f64; 3] {
        let [i, j, k] = self.0;
        // 1 where i, j, and the axis that is left follow each other.
        let even = if (i + 1) % 3 == j { 1.0 } else { -1.0 };
        let r = |row: usize, column: usize| rotation[(row, column)];
        const LOCK: f64 = 1e-9;
        if self.proper() {
            let other = 3 - i - j;
            let second = r(i, i).clamp(-1.0, 1.0).acos();
            if second.sin() > LOCK {
                [r(j, i).atan2(-even * r(other, i)), second, r(i, j).atan2(even * r(i, other))]
            } else {
                [(even * r(other, j)).atan2(r(j, j)), second, 0.0]
            }
        } else {
            let second = (even * r(i, k)).clamp(-1.0, 1.0).asin();
            if second.cos() > LOCK {
                [(-even * r(j, k)).atan2(r(k, k)), second, (-even * r(i, j)).atan2(r(i, i))]
            } else {
                [(even * r(k, j)).atan2(r(j, j)), second, 0.0]
            }
        }
    }

    /// The rotation of three turns.
    pub fn rotation(self, angles: [f64; 3]) -> Matrix3<f64> {
        let turn = |k: usize| {
            let axis = nalgebra::Unit::new_unchecked(unit(self.0[k]));
            nalgebra::Rotation3::from_axis_angle(&axis, angles[k]).into_inner()
        };
        turn(0) * turn(1) * turn(2)
    }
}

/// The unit vector along an axis.
pub(crate) fn unit(axis: usize) -> Vector3<f64> {
    Vector3::from_fn(|i, _| if i == axis { 1.0 } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::StdRng;
    use rand::{Rng, SeedableRng};

    const ALL: [Convention; 13] = [
        Convention::GroodSuntay,
        Convention::Xyz,
        Convention::Xyx,
        Convention::Xzy,
        Convention::Xzx,
        Convention::Yxz,
        Convention::Yxy,
        Convention::Yzx,
        Convention::Yzy,
        Convention::Zxy,
        Convention::Zxz,
        Convention::Zyx,
        Convention::Zyz,
    ];

    #[test]
    fn angles_make_up_their_rotation_again_in_every_sequence_also_at_a_lock() {
        let mut rng = StdRng::seed_from_u64(3);
        let half = std::f64::consts::FRAC_PI_2;
        for convention in ALL {
            let sequence = convention.sequence();
            for round in 0..500 {
                let mut any = || -> f64 { rng.random_range(-3.1..3.1) };
                let second = match (round % 10, sequence.proper()) {
                    (0, true) => 0.0,
                    (0, false) => half,
                    (1, true) => 2.0 * half,
                    (1, false) => -half,
                    (_, true) => any().abs(),
                    (_, false) => any() / 2.0,
                };
                let angles = [any(), second, any()];
                let rotation = sequence.rotation(angles);
                let found = sequence.angles(&rotation);
                assert!(
                    (sequence.rotation(found) - rotation).abs().max() < 1e-7,
                    "{convention:?} {angles:?} {found:?}"
                );
                if round % 10 > 1 {
                    for (a, b) in angles.iter().zip(found) {
                        assert!((a - b).abs() < 1e-9, "{convention:?} {angles:?} {found:?}");
                    }
                }
            }
        }
    }
}
