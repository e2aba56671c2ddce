//! The bodies of a knee, of the sizes of a real one: a right knee in extension.
//!
//! In every model frame x is lateral (to the subject's right), y anterior and z proximal (up), and the origin lies near the
//! body's middle. All edges are rounded. Sizes were chosen within what implant makers and anatomical studies state for an
//! adult knee; none is a copy of a product or of a person.

mod distal_femur;
mod femoral_component;
mod patella;
mod proximal_tibia;
mod tibial_tray;

use biplane_geometry::Point3;

use crate::Solid;

pub use distal_femur::DistalFemur;
pub use femoral_component::FemoralComponent;
pub use patella::Patella;
pub use proximal_tibia::ProximalTibia;
pub use tibial_tray::TibialTray;

/// One of the bodies, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Body {
    /// The metal that replaces the femur's joint surface: condyles, flange, box.
    FemoralComponent,
    /// The metal plate with its keel that stands on the tibia.
    TibialTray,
    /// The lower 100 mm of a thigh bone.
    DistalFemur,
    /// The upper 90 mm of a shin bone.
    ProximalTibia,
    /// The kneecap.
    Patella,
}

impl Body {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::FemoralComponent, Self::TibialTray, Self::DistalFemur, Self::ProximalTibia, Self::Patella];

    /// Its name in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::FemoralComponent => "femoral-component",
            Self::TibialTray => "tibial-tray",
            Self::DistalFemur => "distal-femur",
            Self::ProximalTibia => "proximal-tibia",
            Self::Patella => "patella",
        }
    }

    /// Its surface.
    pub fn solid(self) -> &'static dyn Solid {
        match self {
            Self::FemoralComponent => &FemoralComponent,
            Self::TibialTray => &TibialTray,
            Self::DistalFemur => &DistalFemur,
            Self::ProximalTibia => &ProximalTibia,
            Self::Patella => &Patella,
        }
    }

    /// The inside of a bone's cortical shell, where its marrow begins; none for metal.
    pub fn inner(self) -> Option<&'static dyn Solid> {
        match self {
            Self::FemoralComponent | Self::TibialTray => None,
            Self::DistalFemur => Some(&Marrow(&DistalFemur)),
            Self::ProximalTibia => Some(&Marrow(&ProximalTibia)),
            Self::Patella => Some(&Marrow(&Patella)),
        }
    }
}

/// A bone: a solid with a shell of cortical bone.
trait Bone: Solid {
    /// Thickness of the shell at a point near the surface, mm: it changes by at most [`THICKNESS_SLOPE`] a millimetre.
    fn cortical_mm(&self, point: &Point3) -> f64;
}

/// By how much, at most, the shell of a bone gets thicker over a millimetre.
const THICKNESS_SLOPE: f64 = 0.1;

/// What a bone's cortical shell encloses.
struct Marrow<B: 'static>(&'static B);

impl<B: Bone> Solid for Marrow<B> {
    fn value(&self, point: &Point3) -> f64 {
        (self.0.value(point) + self.0.cortical_mm(point)) / (1.0 + THICKNESS_SLOPE)
    }

    fn bounds(&self) -> (Point3, Point3) {
        self.0.bounds()
    }
}

/// Thickness along the shaft: `thin` mm below `from`, `thick` mm from `to` on (heights z, mm), smoothly in between.
fn thickening(z: f64, [from, to]: [f64; 2], [thin, thick]: [f64; 2]) -> f64 {
    let s = ((z - from) / (to - from)).clamp(0.0, 1.0);
    thin + (thick - thin) * s * s * (3.0 - 2.0 * s)
}
