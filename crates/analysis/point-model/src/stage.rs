//! The stage `model`: a mesh in, the mesh that is matched out, with as many points as asked for.

use biplane_artifact::{BoneSurface, ModelMesh};
use biplane_geometry::Mesh;
use biplane_stage::{Context, Stage, inputs};
use biplane_surface::Surface;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::half_edges::HalfEdges;
use crate::simplify::Simplifier;
use crate::{Deviation, even, laid_out, lines};

inputs! {
    /// What the model is made of: a mesh, or a bone's surface. One of the two lists has one entry, the other none.
    pub struct ModelInputs {
        mesh: [ModelMesh],
        surface: [BoneSurface],
    }
}

/// How the points are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Spread evenly over the surface, all of them on it.
    #[default]
    Even,
    /// As the shape asks for: few where it is flat, many where it is curved. The outline is nearer to that of the mesh than with as
    /// many even points, by a factor of 2 to 20 in its rms; the thesis's grid outline needs even ones.
    Simplified,
}

/// How many points a model has, and how they are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ModelParams {
    /// Points of the model; 0 for those of the mesh, or with `simplified` and `max_error_mm` for as few as keep within that. 0, or 200
    /// to 500000.
    #[schemars(range(max = 500_000))]
    pub points: u32,
    /// How the points are chosen.
    pub method: Method,
    /// Edges at which the surface bends by more than this are kept, degrees. 10 to 180; 180 keeps none.
    #[schemars(range(min = 10.0, max = 180.0))]
    pub keep_edges_deg: f64,
    /// The model's surface and the mesh's may lie this far apart, mm, each from the other, and so may their silhouettes; 0 for no
    /// limit. 0 to 10.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub max_error_mm: f64,
}

impl Default for ModelParams {
    fn default() -> Self {
        Self { points: 0, method: Method::Even, keep_edges_deg: 40.0, max_error_mm: 0.0 }
    }
}

/// Fewest points that can be asked for.
const FEWEST: u32 = 200;
/// Most points that can be asked for.
const MOST: u32 = 500_000;

/// Why there is no model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// A parameter out of range.
    #[error("[model] {name} = {value}, expected {expected}")]
    Parameter {
        /// The key in pipeline.toml.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// Not one mesh or surface.
    #[error(
        "a model is made of one mesh or one bone's surface, but {meshes} meshes and {surfaces} surfaces were given"
    )]
    Inputs {
        /// Meshes given.
        meshes: usize,
        /// Surfaces given.
        surfaces: usize,
    },
    /// The number of points cannot be had.
    #[error(
        "the mesh cannot be had with {points} points, only with {found}: its pieces, corners and faults need more; ask for \
             {found} or more in [model], or repair the mesh"
    )]
    Points {
        /// As asked for.
        points: usize,
        /// How many it came to.
        found: usize,
    },
    /// Simplified to more points than there are.
    #[error(
        "the mesh has {found} points, so it cannot be simplified to {points}; ask for fewer, or for method = \"even\" in [model]"
    )]
    TooFew {
        /// As asked for.
        points: usize,
        /// How many the mesh has.
        found: usize,
    },
    /// The bound cannot be met with these points.
    #[error(
        "with {points} points the model lies up to {found_mm:.3} mm from the mesh, more than max_error_mm = {max_error_mm}; {advice}"
    )]
    TooFar {
        /// Points of the model.
        points: usize,
        /// Upper bound of the distance, mm.
        found_mm: f64,
        /// As asked for.
        max_error_mm: f64,
        /// What can be had.
        advice: String,
    },
    /// All triangles lost their areas.
    #[error(
        "the mesh is too small to be sampled: none of its triangles has an area that can be told from rounding"
    )]
    Vanished,
    /// The run was cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl ModelParams {
    /// # Errors
    /// Names the first parameter that is out of its range.
    pub fn check(&self) -> Result<(), ModelError> {
        let Self { points, method: _, keep_edges_deg, max_error_mm } = *self;
        let bad = |name, value, expected| Err(ModelError::Parameter { name, value, expected });
        if points != 0 && !(FEWEST..=MOST).contains(&points) {
            return bad("points", f64::from(points), "0, or 200 to 500000");
        }
        if !(10.0..=180.0).contains(&keep_edges_deg) {
            return bad("keep_edges_deg", keep_edges_deg, "10 to 180 degrees");
        }
        if !(0.0..=10.0).contains(&max_error_mm) {
            return bad("max_error_mm", max_error_mm, "0 to 10 mm");
        }
        Ok(())
    }
}

/// The stage `model`.
#[derive(Debug, Clone, Copy)]
pub struct Model;

impl Stage for Model {
    const NAME: &'static str = "model";
    const CODE: &'static str = env!("BIPLANE_CODE_HASH");
    type Inputs = ModelInputs;
    type Params = ModelParams;
    type Output = ModelMesh;
    type Error = ModelError;

    fn run(inputs: &ModelInputs, params: &ModelParams, context: &Context) -> Result<ModelMesh, ModelError> {
        let mesh = match (&inputs.mesh[..], &inputs.surface[..]) {
            ([mesh], []) => &mesh.0,
            ([], [surface]) => &surface.mesh,
            (meshes, surfaces) => {
                return Err(ModelError::Inputs { meshes: meshes.len(), surfaces: surfaces.len() });
            }
        };
        point_model(mesh, params, context).map(ModelMesh)
    }
}

/// The model of a mesh, laid out for the matcher's loops ([`laid_out`]).
///
/// # Errors
/// A parameter out of range, a number of points or a bound that cannot be had, or that the context was cancelled.
pub fn point_model(mesh: &Mesh, params: &ModelParams, context: &Context) -> Result<Mesh, ModelError> {
    params.check()?;
    let points = params.points as usize;
    let limit = (params.max_error_mm > 0.0).then_some(params.max_error_mm);
    let model = match (params.method, points, limit) {
        (Method::Even, 0, _) | (Method::Simplified, 0, None) => {
            return laid_out(mesh).map_err(|_| ModelError::Vanished);
        }
        (Method::Simplified, 0, Some(limit)) => fewest(mesh, limit, params.keep_edges_deg, context)?,
        (Method::Even, points, _) => even_points(mesh, points, params.keep_edges_deg)?,
        (Method::Simplified, points, _) => simplified(mesh, points, params.keep_edges_deg)?,
    };
    if let Some(max_error_mm) = limit.filter(|_| points > 0) {
        let found_mm = Deviation::between(&model, mesh, max_error_mm / 50.0).silhouette_mm();
        if found_mm > max_error_mm {
            let advice = match (params.method, fewest(mesh, max_error_mm, params.keep_edges_deg, context)) {
                (_, Err(ModelError::Cancelled)) => return Err(ModelError::Cancelled),
                (_, Err(_)) => format!("ask for more points or allow {found_mm:.2} mm in [model]"),
                (method, Ok(enough)) => {
                    let count = enough.vertices().len();
                    let what =
                        if method == Method::Even { "method = \"simplified\" needs" } else { "it needs" };
                    format!(
                        "{what} {count} points for that: ask for them, or allow {found_mm:.2} mm, in [model]"
                    )
                }
            };
            return Err(ModelError::TooFar { points, found_mm, max_error_mm, advice });
        }
    }
    laid_out(&model).map_err(|_| ModelError::Vanished)
}

/// A mesh with `points` vertices spread evenly over the surface of another; edges at which it bends by more than `keep_edges_deg`
/// are kept.
///
/// # Errors
/// If the number cannot be had.
pub fn even_points(mesh: &Mesh, points: usize, keep_edges_deg: f64) -> Result<Mesh, ModelError> {
    even::even(mesh, &Surface::new(mesh), points, keep_edges_deg)
}

/// A mesh simplified to `points` vertices.
///
/// # Errors
/// If it has not as many, or cannot be had with so few.
pub fn simplified(mesh: &Mesh, points: usize, keep_edges_deg: f64) -> Result<Mesh, ModelError> {
    let mut simplifier = simplifier(mesh, points, keep_edges_deg);
    let found = simplifier.mesh.vertices();
    if found < points {
        return Err(ModelError::TooFew { points, found });
    }
    simplifier.run(points);
    let found = simplifier.mesh.vertices();
    if found > points {
        return Err(ModelError::Points { points, found });
    }
    simplifier.mesh.mesh().map_err(|_| ModelError::Vanished)
}

fn simplifier(mesh: &Mesh, points: usize, keep_edges_deg: f64) -> Simplifier {
    let mut edges = HalfEdges::of(mesh);
    let length = (mesh.area() * 2.0 / (3.0_f64.sqrt() * points as f64)).sqrt();
    lines::mark(&mut edges, keep_edges_deg, 3.0 * length);
    Simplifier::new(edges)
}

/// The mesh simplified to as few points as keep it within `max_error_mm` of what it was, found by halving between numbers of points
/// until they differ by less than 2 %.
///
/// # Errors
/// That the context was cancelled.
pub fn fewest(
    mesh: &Mesh,
    max_error_mm: f64,
    keep_edges_deg: f64,
    context: &Context,
) -> Result<Mesh, ModelError> {
    let tree = Surface::new(mesh);
    let mut best = mesh.clone();
    let (mut too_few, mut enough) = (4.0, best.vertices().len() as f64);
    while enough > 1.02 * too_few && enough > 8.0 {
        if context.cancelled() {
            return Err(ModelError::Cancelled);
        }
        // The error falls as one over the number: halve in its logarithm.
        let points = (too_few * enough).sqrt().round();
        let mut simplifier = simplifier(mesh, points as usize, keep_edges_deg);
        simplifier.run(points as usize);
        let tried = simplifier.mesh.mesh().map_err(|_| ModelError::Vanished)?;
        let found = Deviation::with_tree(&tried, mesh, &tree, max_error_mm / 50.0).silhouette_mm();
        if found <= max_error_mm {
            enough = points.min(enough - 1.0);
            best = tried;
        } else {
            too_few = points.max(too_few + 1.0);
        }
    }
    Ok(best)
}
