//! Where X-ray edges lie beside the outline of a body, predicted from its shape.
//!
//! **Why.** A ray just inside the rim of a smooth body has hardly any way through it, so the light falls as
//! `exp(-mu sqrt(8 r d))` with the depth `d`, `r` being the surface's radius of curvature along the ray and `mu` the attenuation over
//! that of what the body stands in. Blurred, that is steepest inside the outline: 0.765 blurs where the body is weak, none where it
//! is strong or its rim a crease, a function of `mu sqrt(8 r s)` with the blur `s` in mm ([`rim_inset_px`]). What differs along an
//! outline moves and turns a pose; what is the same all round does not matter.
//!
//! **From the shape itself.** Rims are seldom so simple within a blur: fillets end, flanges are thin, walls run along the rays. So the
//! chords of the body's mesh are taken along the outline's normal ([`ChordFinder`]), and the crest of their blurred shadow is found
//! ([`predicted`]), with what the usual parabola through three pixels adds.
//!
//! **What nobody says.** Attenuation and blur are found from the residuals of the whole outline ([`Estimate`]), as they differ from rim to
//! rim, beside the motion that the pose still wants.
//!
//! **Guaranteed:** a smooth rim's crest is that of the blurred profile to 1e-4 blurs for blurs of 1.2 to 2.5 px; no prediction is off the
//! outline by more than four blurs; nothing panics, whatever the mesh. **Not guaranteed:** other bodies beside the rim, light that
//! saturates, and shells: one attenuation stands for the whole body. A mesh tells no radius below the size of its triangles.

mod chords;
mod estimate;
mod profile;

pub use chords::{ChordFinder, Chords, NODES};
pub use estimate::{Estimate, Prior, Sample, predicted, rim_inset_px};
