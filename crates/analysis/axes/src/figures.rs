//! What axes were made from, as figures to be drawn.

use biplane_artifact::AxesFeature;
use biplane_geometry::Vector3;

fn place(v: &Vector3) -> [f64; 3] {
    [v.x, v.y, v.z]
}

pub(crate) fn point(name: &str, at: &Vector3) -> AxesFeature {
    AxesFeature::Point { name: name.to_owned(), at_mm: place(at) }
}

pub(crate) fn line(name: &str, from: &Vector3, to: &Vector3) -> AxesFeature {
    AxesFeature::Line { name: name.to_owned(), from_mm: place(from), to_mm: place(to) }
}

pub(crate) fn sphere(name: &str, centre: &Vector3, radius_mm: f64) -> AxesFeature {
    AxesFeature::Sphere { name: name.to_owned(), centre_mm: place(centre), radius_mm }
}

pub(crate) fn cylinder(name: &str, from: &Vector3, to: &Vector3, radius_mm: f64) -> AxesFeature {
    AxesFeature::Cylinder { name: name.to_owned(), from_mm: place(from), to_mm: place(to), radius_mm }
}

pub(crate) fn plane(name: &str, centre: &Vector3, normal: &Vector3, radius_mm: f64) -> AxesFeature {
    AxesFeature::Plane { name: name.to_owned(), centre_mm: place(centre), normal: place(normal), radius_mm }
}

/// The same figure where `to` puts its places and `turn` its directions.
pub(crate) fn moved(
    figure: AxesFeature,
    to: impl Fn(&Vector3) -> Vector3,
    turn: impl Fn(&Vector3) -> Vector3,
) -> AxesFeature {
    let at = |p: [f64; 3]| place(&to(&Vector3::from(p)));
    match figure {
        AxesFeature::Point { name, at_mm } => AxesFeature::Point { name, at_mm: at(at_mm) },
        AxesFeature::Line { name, from_mm, to_mm } => {
            AxesFeature::Line { name, from_mm: at(from_mm), to_mm: at(to_mm) }
        }
        AxesFeature::Sphere { name, centre_mm, radius_mm } => {
            AxesFeature::Sphere { name, centre_mm: at(centre_mm), radius_mm }
        }
        AxesFeature::Cylinder { name, from_mm, to_mm, radius_mm } => {
            AxesFeature::Cylinder { name, from_mm: at(from_mm), to_mm: at(to_mm), radius_mm }
        }
        AxesFeature::Plane { name, centre_mm, normal, radius_mm } => AxesFeature::Plane {
            name,
            centre_mm: at(centre_mm),
            normal: place(&turn(&Vector3::from(normal))),
            radius_mm,
        },
    }
}
