//! How slices lie in the body, in words.

use biplane_artifact::Volume;
use nalgebra::Vector3;

/// How the slices of a volume lie in the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orientation {
    /// The nearest of `sagittal`, `coronal` and `axial`.
    pub plane: &'static str,
    /// How far the slices are turned out of it, degrees.
    pub oblique_deg: f64,
    /// Where columns, rows and slices go with growing number, each to the nearest side of the body.
    pub towards: [&'static str; 3],
    /// Whether the three axes are right-handed.
    pub right_handed: bool,
}

impl Orientation {
    /// Of a volume whose axes are not in a plane; of one slice, its normal counts as the way slices go.
    pub fn of(volume: &Volume) -> Self {
        let (column, row) = (Vector3::from(volume.column_step_mm), Vector3::from(volume.row_step_mm));
        let normal = column.cross(&row).normalize();
        let slice = match volume.origins_mm.as_slice() {
            [first, .., last] => Vector3::from(*last) - Vector3::from(*first),
            _ => normal,
        };
        let axis = normal.iamax();
        Self {
            plane: ["sagittal", "coronal", "axial"][axis],
            oblique_deg: normal[axis].abs().min(1.0).acos().to_degrees(),
            towards: [column, row, slice].map(|step| side(&step)),
            right_handed: normal.dot(&slice) > 0.0,
        }
    }

    /// In words: `sagittal`, or `oblique, 12.3 degrees from sagittal`.
    pub fn words(&self) -> String {
        // Less than half a degree comes of a patient who did not lie quite straight.
        if self.oblique_deg < 0.5 {
            self.plane.to_owned()
        } else {
            format!("oblique, {:.1} degrees from {}", self.oblique_deg, self.plane)
        }
    }
}

/// The side of the body that a direction (left-posterior-superior) mostly runs to.
fn side(direction: &Vector3<f64>) -> &'static str {
    let axis = direction.iamax();
    let [behind, ahead] = [["right", "left"], ["anterior", "posterior"], ["inferior", "superior"]][axis];
    if direction[axis] < 0.0 { behind } else { ahead }
}
