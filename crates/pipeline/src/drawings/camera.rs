//! From where a body is looked at, and where in a picture its points are seen.

use biplane_artifact::{BodyAxes, BodyKind, Side};
use biplane_geometry::{Point3, Vector3};

/// How far the eye is from the middle of what is seen in perspective, in half diagonals of it.
const DISTANCE: f64 = 3.5;

/// The directions of a body as a person speaks of them; unit vectors, right-handed as (front, up, right).
#[derive(Debug, Clone, Copy)]
pub(super) struct Directions {
    front: Vector3,
    up: Vector3,
    /// To the subject's right.
    right: Vector3,
    /// Whose directions they are.
    named: Named,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Named {
    /// Those of a body whose left and right are known.
    Body(Side),
    /// Those of the scanner.
    Scanner,
    /// Those of the coordinates; nothing says what is up.
    Coordinates,
}

/// One of the sides that a body is looked at from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Viewpoint {
    Front,
    Side,
    Above,
    /// From the front, above and the side.
    Corner,
    /// From behind, above and the other side.
    OtherCorner,
}

/// Unit vectors of a picture: to its right, up, and towards the viewer.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    right: Vector3,
    up: Vector3,
    toward: Vector3,
}

impl Directions {
    /// Of a body's axes: x to the front, y up, z to the subject's right.
    pub(super) fn of_axes(axes: &BodyAxes) -> Self {
        let [front, up, right] = axes.axes.map(Vector3::from);
        let named = if axes.body == BodyKind::Other { Named::Coordinates } else { Named::Body(axes.side) };
        Self { front, up, right, named }
    }

    /// Of the scanner's frame: left-posterior-superior.
    pub(super) fn of_scanner() -> Self {
        Self { front: -Vector3::y(), up: Vector3::z(), right: -Vector3::x(), named: Named::Scanner }
    }

    /// Of coordinates of which nothing is known: z is shown upward.
    pub(super) fn of_coordinates() -> Self {
        Self { front: -Vector3::y(), up: Vector3::z(), right: -Vector3::x(), named: Named::Coordinates }
    }

    /// What a person calls a side.
    pub(super) fn name(&self, from: Viewpoint) -> &'static str {
        match (self.named, from) {
            (Named::Coordinates, Viewpoint::Front) => "front: x right, z up",
            (Named::Coordinates, Viewpoint::Side) => "side: y right, z up",
            (Named::Coordinates, Viewpoint::Above) => "top: x right, y up",
            (_, Viewpoint::Front) => "from anterior",
            (Named::Body(_), Viewpoint::Side) => "from lateral",
            (Named::Scanner, Viewpoint::Side) => "from the left",
            (_, Viewpoint::Above) => "from proximal",
            (Named::Body(_), Viewpoint::Corner) => "from anterior and lateral",
            (Named::Body(_), Viewpoint::OtherCorner) => "from posterior and medial",
            (Named::Scanner, Viewpoint::Corner) => "from anterior and left",
            (Named::Scanner, Viewpoint::OtherCorner) => "from posterior and right",
            (Named::Coordinates, Viewpoint::Corner) => "from the front and side",
            (Named::Coordinates, Viewpoint::OtherCorner) => "from behind and the other side",
        }
    }

    /// The picture's directions for a side.
    pub(super) fn frame(&self, from: Viewpoint) -> Frame {
        let Self { front, up, right, named } = *self;
        // The body's outer side, the subject's left, or +x.
        let side = if named == Named::Body(Side::Right) { right } else { -right };
        let (toward, up) = match from {
            Viewpoint::Front => (front, up),
            Viewpoint::Side => (side, up),
            Viewpoint::Above => (up, front),
            Viewpoint::Corner => (front * 0.72 + side * 0.55 + up * 0.42, up),
            Viewpoint::OtherCorner => (front * -0.72 - side * 0.55 + up * 0.42, up),
        };
        // Axes that are none give some picture all the same.
        let toward = toward.try_normalize(1e-9).unwrap_or(Vector3::z());
        let right = up.cross(&toward).try_normalize(1e-9).unwrap_or(Vector3::x());
        Frame { right, up: toward.cross(&right), toward }
    }
}

/// A camera whose picture is `size` units wide and high.
#[derive(Debug, Clone, Copy)]
pub(super) struct Camera {
    frame: Frame,
    middle: Point3,
    /// Units per mm in the plane through the middle.
    scale: f64,
    /// Of the middle's place in the picture.
    shift: [f64; 2],
    size: [f64; 2],
    /// Distance of the eye from the middle, mm; none where all rays are parallel.
    eye_mm: Option<f64>,
}

impl Camera {
    /// As near as shows all points with `room` units around them.
    pub(super) fn fitted<'a>(
        frame: Frame,
        points: impl Iterator<Item = &'a Point3> + Clone,
        size: [f64; 2],
        room: f64,
        in_perspective: bool,
    ) -> Self {
        let (mut low, mut high) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
        for p in points.clone() {
            low = low.inf(&p.coords);
            high = high.sup(&p.coords);
        }
        let (low, high) = if low.x <= high.x { (low, high) } else { (Vector3::zeros(), Vector3::zeros()) };
        let half = ((high - low).norm() / 2.0).clamp(1e-9, 1e12);
        let mut camera = Self {
            frame,
            middle: Point3::from((low + high) / 2.0),
            scale: 1.0,
            shift: [0.0; 2],
            size: [0.0; 2],
            eye_mm: in_perspective.then_some(DISTANCE * half),
        };
        let (mut first, mut last) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for at in points.map(|p| camera.onto(p)) {
            for a in 0..2 {
                first[a] = first[a].min(at[a]);
                last[a] = last[a].max(at[a]);
            }
        }
        let extent: [f64; 2] = std::array::from_fn(|a| (last[a] - first[a]).max(1e-9 * half));
        camera.size = size;
        let fits = |a: usize| ((size[a] - 2.0 * room).max(1.0)) / extent[a];
        camera.scale = fits(0).min(fits(1));
        camera.shift = std::array::from_fn(|a| -camera.scale * (first[a] + last[a]) / 2.0);
        camera
    }

    /// The same picture with so many units for each of its own.
    pub(super) fn enlarged(&self, factor: f64) -> Self {
        Self {
            scale: self.scale * factor,
            shift: self.shift.map(|v| v * factor),
            size: self.size.map(|v| v * factor),
            ..*self
        }
    }

    /// Width and height of the picture.
    pub(super) fn size(&self) -> [f64; 2] {
        self.size
    }

    /// Units per mm.
    pub(super) fn scale(&self) -> f64 {
        self.scale
    }

    /// A direction in the picture's: right, up, toward the viewer.
    pub(super) fn turned(&self, v: &Vector3) -> Vector3 {
        Vector3::new(v.dot(&self.frame.right), v.dot(&self.frame.up), v.dot(&self.frame.toward))
    }

    /// How much nearer than the middle a point is, mm.
    pub(super) fn nearness(&self, p: &Point3) -> f64 {
        (p - self.middle).dot(&self.frame.toward)
    }

    /// A number that grows with nearness and is linear in the picture over a plane.
    pub(super) fn depth(&self, nearness: f64) -> f64 {
        match self.eye_mm {
            Some(eye) => eye / (eye - nearness).max(0.05 * eye),
            None => nearness,
        }
    }

    /// The nearness of such a number.
    pub(super) fn nearness_of(&self, depth: f64) -> f64 {
        match self.eye_mm {
            Some(eye) => eye - eye / depth,
            None => depth,
        }
    }

    /// Where a point is seen: right and down from the upper left corner.
    pub(super) fn onto(&self, p: &Point3) -> [f64; 2] {
        let v = self.turned(&(p - self.middle));
        let grown = self.eye_mm.map_or(1.0, |eye| eye / (eye - v.z).max(0.05 * eye)) * self.scale;
        [self.size[0] / 2.0 + self.shift[0] + grown * v.x, self.size[1] / 2.0 + self.shift[1] - grown * v.y]
    }
}
