//! A femoral component that replaces the cruciate ligaments: two condyles, an anterior flange, a box.

use biplane_geometry::Point3;

use crate::Solid;
use crate::shapes::{capsule, difference, half_space, hypotenuse, intersection, plate, union};

/// About 68 mm wide, 61 mm deep and 54 mm high; condyles 8 to 10 mm thick. Right knee: the lateral condyle is the smaller
/// one behind, and the flange is higher on its side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FemoralComponent;

/// Lowest height of the condyles, where they meet the tibia.
const DISTAL: f64 = -26.0;
/// Radius of the sagittal profile from the lowest point forward.
const DISTAL_RADIUS: f64 = 37.0;
/// Where along y the posterior arc passes into the distal one.
const JUNCTION: f64 = -9.0;

/// The condyles' profile seen from the side (the J-curve): an arc of the radius `posterior`, from the lowest point forward
/// a larger one, and from its foremost point straight up; behind it goes straight up too. It is the line that the
/// smaller circle's centre runs along, widened by that circle's radius, so it is exact outside and some way inside.
fn profile(y: f64, z: f64, posterior: f64) -> f64 {
    let (ahead, centre) = (y - JUNCTION, DISTAL + posterior);
    let from_line = if ahead < 0.0 {
        hypotenuse(ahead, (centre - z).max(0.0))
    } else {
        let arc = hypotenuse(ahead, (z - DISTAL - DISTAL_RADIUS).min(0.0)) - (DISTAL_RADIUS - posterior);
        arc.max(-ahead)
    };
    from_line - posterior
}

/// A condyle: the profile, barrel-shaped from side to side about the plane `x`.
fn condyle(p: &Point3, x: f64, posterior: f64) -> f64 {
    const BARREL: f64 = 32.0;
    hypotenuse((profile(p.y, p.z, posterior) + BARREL).max(0.0), p.x - x) - BARREL
}

/// The bone's place: five planes, as the saw leaves them.
fn bone_cuts(p: &Point3) -> f64 {
    const FILLET: f64 = 3.0;
    let planes = [
        half_space(p, [0.0, -20.5, 0.0], [0.0, -1.0, 0.0]),
        half_space(p, [0.0, -20.5, -9.0], [0.0, -1.0, -1.0]),
        half_space(p, [0.0, 0.0, -17.0], [0.0, 0.0, -1.0]),
        half_space(p, [0.0, 18.0, -7.5], [0.0, 1.0, -1.0]),
        half_space(p, [0.0, 18.0, 0.0], [0.0, 1.0, -0.04]),
    ];
    planes.into_iter().reduce(|a, b| intersection(a, b, FILLET)).unwrap_or(f64::INFINITY)
}

impl Solid for FemoralComponent {
    fn value(&self, p: &Point3) -> f64 {
        const EDGE: f64 = 4.5;
        let condyles = union(condyle(p, -20.0, 22.0), condyle(p, 20.0, 20.0), 9.0);
        // The flange narrows upwards; its upper end rises to the lateral side.
        let leaning = half_space(&Point3::new(p.x.abs(), p.y, p.z), [34.0, 0.0, -6.0], [1.0, 0.0, 0.22]);
        let sides = intersection(leaning, p.x.abs() - 34.0, 6.0);
        let outer = intersection(condyles, sides, EDGE);
        let flange_top = half_space(p, [0.0, 0.0, 27.0], [-0.12, 0.0, 1.0]).max(4.0 - p.y);
        let posterior_top = half_space(p, [0.0, -26.0, 9.0], [0.0, -0.1, 1.0]);
        let outer = intersection(outer, posterior_top, 10.0).min(intersection(outer, flange_top, EDGE));
        let shell = difference(outer, bone_cuts(p), EDGE);
        // Two walls stand on the distal part and bound the slot for the insert's post; a cam joins the condyles behind.
        let side = intersection((p.y + 4.0).abs() - 14.0, (p.z + 10.0).abs() - 15.0, 4.0);
        let walls = plate(side, p.x.abs() - 10.0, 2.0, 1.2);
        let with_walls = union(shell, intersection(walls, condyles, 2.0), 3.0);
        let slotted = difference(with_walls, intersection(p.x.abs() - 8.3, p.y - 9.0, 4.0), 3.0);
        union(slotted, capsule(p, [-12.0, -20.0, -3.0], [12.0, -20.0, -3.0], 4.0), 2.0)
    }

    fn bounds(&self) -> (Point3, Point3) {
        (Point3::new(-35.0, -32.0, -27.5), Point3::new(35.0, 29.5, 34.0))
    }
}
