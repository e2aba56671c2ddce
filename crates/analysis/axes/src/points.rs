//! Axes from an origin and a point on each axis, as the thesis has them (Bingham 2006, section 3.4).
//!
//! y is kept, z is made square to it, x follows; without a point on y, z is kept and x made square; without one on z, y is kept.

use biplane_artifact::Landmark;
use biplane_geometry::Vector3;

use crate::AxesError;
use crate::frame::{Axis, Frame, angle_deg};

/// From how many degrees off square a person is told.
const OFF_SQUARE_DEG: f64 = 2.0;

/// The frame that the landmarks `origin`, `x`, `y`, `z` give, with what is to be said of it; none where no axis has a point. Two axes
/// are enough.
pub(crate) fn frame(landmarks: &[Landmark]) -> Result<Option<(Frame, Vec<String>)>, AxesError> {
    let point = |name: &str| {
        landmarks.iter().find(|l| l.name.trim().eq_ignore_ascii_case(name)).map(|l| Vector3::from(l.at_mm))
    };
    let ends = [point("x"), point("y"), point("z")];
    let given = ends.iter().flatten().count();
    if given == 0 {
        return Ok(None);
    }
    let found: Vec<&str> =
        ["origin", "x", "y", "z"].into_iter().filter(|name| point(name).is_some()).collect();
    let Some(origin) = point("origin") else {
        return Err(AxesError::PointsMissing { found: found.join(", "), missing: "origin".to_owned() });
    };
    if given < 2 {
        let missing: Vec<&str> = ["x", "y", "z"].into_iter().filter(|n| !found.contains(n)).collect();
        return Err(AxesError::PointsMissing { found: found.join(", "), missing: missing.join(" or ") });
    }
    let names = ["x", "y", "z"];
    let axes = ends.map(|end| end.map(|e| e - origin));
    for (name, axis) in names.iter().zip(&axes) {
        if axis.is_some_and(|a| a.norm() < 1.0) {
            return Err(AxesError::PointsDegenerate {
                what: format!("{name} lies less than 1 mm from origin"),
            });
        }
    }
    let mut warnings = Vec::new();
    for (i, j) in [(0, 1), (1, 2), (0, 2)] {
        if let (Some(a), Some(b)) = (axes[i], axes[j]) {
            let angle = angle_deg(&a, &b);
            if !(5.0..=175.0).contains(&angle) {
                let what = format!("{} and {} lie {angle:.1} degrees apart", names[i], names[j]);
                return Err(AxesError::PointsDegenerate { what });
            }
            if (angle - 90.0).abs() > OFF_SQUARE_DEG {
                warnings.push(format!(
                    "the axes given by points {} and {} stand at {angle:.1} degrees, not at 90: {} kept, the others were made square",
                    names[i],
                    names[j],
                    if axes[1].is_some() { "y was" } else { "z was" }
                ));
            }
        }
    }
    let (kept, second) = match axes {
        [_, Some(y), Some(z)] => ((Axis::Y, y), (Axis::Z, z)),
        [Some(x), Some(y), None] => ((Axis::Y, y), (Axis::X, x)),
        [Some(x), None, Some(z)] => ((Axis::Z, z), (Axis::X, x)),
        _ => return Ok(None),
    };
    let frame = Frame::of(origin, kept, second).ok_or_else(|| AxesError::PointsDegenerate {
        what: "two of the axes are nearly parallel".to_owned(),
    })?;
    if let [Some(x), Some(y), Some(z)] = axes
        && x.normalize().dot(&y.normalize().cross(&z.normalize())) <= 0.0
    {
        return Err(AxesError::PointsLeftHanded);
    }
    Ok(Some((frame, warnings)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: &[(&str, [f64; 3])]) -> Vec<Landmark> {
        list.iter().map(|(name, at_mm)| Landmark { name: (*name).to_owned(), at_mm: *at_mm }).collect()
    }

    #[test]
    fn y_is_kept_and_a_leaning_axis_is_told() {
        let given = points(&[
            ("origin", [1.0, 2.0, 3.0]),
            ("X", [11.0, 3.0, 3.0]),
            ("y", [1.0, 22.0, 3.0]),
            ("z", [1.0, 2.0, 33.0]),
        ]);
        let (f, warnings) = frame(&given).unwrap().unwrap();
        assert_eq!(f.origin, Vector3::new(1.0, 2.0, 3.0));
        assert_eq!(f.axes, [Vector3::x(), Vector3::y(), Vector3::z()]);
        assert_eq!(warnings.len(), 1, "5.7 degrees: {warnings:?}");
        let square = points(&[("origin", [0.0; 3]), ("x", [9.0, 0.3, 0.0]), ("y", [0.0, 9.0, 0.0])]);
        let (f, warnings) = frame(&square).unwrap().unwrap();
        assert_eq!((f.axes[1], warnings.len()), (Vector3::y(), 0), "1.9 degrees");
    }

    #[test]
    fn left_handed_missing_and_degenerate_points_are_errors() {
        let left = points(&[
            ("origin", [0.0; 3]),
            ("x", [9.0, 0.0, 0.0]),
            ("y", [0.0, 9.0, 0.0]),
            ("z", [0.0, 0.0, -9.0]),
        ]);
        assert!(matches!(frame(&left), Err(AxesError::PointsLeftHanded)));
        assert!(matches!(frame(&left[1..]), Err(AxesError::PointsMissing { .. })), "no origin");
        assert!(matches!(frame(&left[..2]), Err(AxesError::PointsMissing { .. })), "one axis");
        assert_eq!(frame(&left[..1]).unwrap(), None);
        let flat = points(&[("origin", [0.0; 3]), ("x", [9.0, 0.0, 0.0]), ("y", [9.0, 0.1, 0.0])]);
        assert!(matches!(frame(&flat), Err(AxesError::PointsDegenerate { .. })));
        let near = points(&[("origin", [0.0; 3]), ("x", [0.5, 0.0, 0.0]), ("y", [0.0, 9.0, 0.0])]);
        assert!(matches!(frame(&near), Err(AxesError::PointsDegenerate { .. })));
    }
}
