//! The edge curves of one frame, which depend on the frame alone.

use biplane_geometry::{Curve, EdgePoint, Point2, Vector2};

use crate::content::hash_encoded;
use crate::{Artifact, Content, ContentHash, DecodeError, npy};

/// All edge curves of one frame, in recorded pixels.
///
/// Stored as a NumPy structured array, a row a point; `numpy.load("curves.npy")` gives the columns `curve` (number of the
/// curve, from 0), `closed` (0 or 1), `x_px`, `y_px`, `direction_x`, `direction_y` (unit, dark to bright), `strength`
/// (grey levels of 0..255 per px) and `sigma_px`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curves(pub Vec<Curve>);

const DESCR: &str = "[('curve', '<u4'), ('closed', '<u4'), ('x_px', '<f4'), ('y_px', '<f4'), ('direction_x', '<f4'), \
                     ('direction_y', '<f4'), ('strength', '<f4'), ('sigma_px', '<f4')]";
const RECORD: usize = 32;

impl Curves {
    /// Rounds every number to the precision that is stored, so that a value and its stored form are the same.
    pub fn rounded(curves: Vec<Curve>) -> Self {
        let r = |v: f64| f64::from(v as f32);
        Self(
            curves
                .into_iter()
                .filter(|c| !c.points.is_empty())
                .map(|c| Curve {
                    closed: c.closed,
                    points: c
                        .points
                        .into_iter()
                        .map(|p| EdgePoint {
                            position: p.position.map(r),
                            direction: p.direction.map(r),
                            strength: r(p.strength),
                            sigma_px: r(p.sigma_px),
                        })
                        .collect(),
                })
                .collect(),
        )
    }

    /// Points of all curves together.
    pub fn point_count(&self) -> usize {
        self.0.iter().map(|c| c.points.len()).sum()
    }
}

impl Content for Curves {
    const KIND: &'static str = "curves";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        hash_encoded::<Self>(&self.encode())
    }
}

impl Artifact for Curves {
    const EXTENSION: &'static str = "npy";

    fn encode(&self) -> Vec<u8> {
        let mut records = Vec::with_capacity(self.point_count() * RECORD);
        for (number, curve) in self.0.iter().enumerate() {
            for p in &curve.points {
                records.extend((number as u32).to_le_bytes());
                records.extend(u32::from(curve.closed).to_le_bytes());
                let EdgePoint { position, direction, strength, sigma_px } = p;
                for v in [position.x, position.y, direction.x, direction.y, *strength, *sigma_px] {
                    records.extend((v as f32).to_le_bytes());
                }
            }
        }
        npy::encode(DESCR, self.point_count(), &records)
    }

    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        let records = npy::decode(DESCR, RECORD, bytes).map_err(DecodeError::of::<Self>)?;
        let mut curves: Vec<Curve> = Vec::new();
        for record in records.chunks_exact(RECORD) {
            let word = |i: usize| [record[4 * i], record[4 * i + 1], record[4 * i + 2], record[4 * i + 3]];
            let float = |i: usize| f64::from(f32::from_le_bytes(word(i)));
            let number = u32::from_le_bytes(word(0)) as usize;
            if number == curves.len() {
                curves.push(Curve { points: Vec::new(), closed: u32::from_le_bytes(word(1)) != 0 });
            } else if number + 1 != curves.len() {
                return Err(DecodeError::of::<Self>(format!("curve {number} is out of order")));
            }
            if (2..8).any(|i| !float(i).is_finite()) {
                return Err(DecodeError::of::<Self>(format!(
                    "curve {number} has a number that is not finite"
                )));
            }
            if let Some(curve) = curves.last_mut() {
                curve.points.push(EdgePoint {
                    position: Point2::new(float(2), float(3)),
                    direction: Vector2::new(float(4), float(5)),
                    strength: float(6),
                    sigma_px: float(7),
                });
            }
        }
        Ok(Self(curves))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Curves {
        let point = |x: f64| EdgePoint {
            position: Point2::new(x, 2.1),
            direction: Vector2::new(0.6, 0.8),
            strength: 12.3,
            sigma_px: 0.1,
        };
        Curves::rounded(vec![
            Curve { points: vec![point(1.3), point(2.2)], closed: false },
            Curve { points: vec![], closed: false },
            Curve { points: vec![point(7.7)], closed: true },
        ])
    }

    #[test]
    fn round_trip_is_exact_and_damage_is_found() {
        let curves = sample();
        let bytes = curves.encode();
        assert_eq!(Curves::decode(&bytes), Ok(curves));
        assert_eq!(Curves::decode(&Curves::default().encode()), Ok(Curves::default()));
        for cut in [0, 9, 40, bytes.len() - 1, bytes.len() - RECORD] {
            assert!(Curves::decode(&bytes[..cut]).is_err(), "cut at {cut}");
        }
    }
}
