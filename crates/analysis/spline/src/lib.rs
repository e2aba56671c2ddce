//! Cubic splines of the plane, periodic and open: through or near points, with derivatives and the closest point.
//!
//! Outlines of bones in pictures (points about a pixel apart, each with its standard deviation across the curve) and contours in slices
//! (thesis 2.2.2; the distance of Eq. 3.4 is [`FootFinder::closest`], with the recorded ends of the spline in [`Piece`]). Lengths are in
//! whatever unit the points have, px or mm; the documentation says px.
//!
//! - [`Spline::through`] interpolates, [`Spline::near`] smooths by as much as the points' noise asks for.
//! - [`FootFinder`] finds the closest point of several trusted pieces, to rounding and over all of them.
//! - [`ArcLength`] measures along a spline; [`Bezier`] chains are what people edit in drawing programs.
//!
//! No input makes anything here panic: what cannot be a curve is an error that says why.

mod arc_length;
mod band;
mod bezier;
mod cubic;
mod foot;
mod knots;
mod minimum;
mod piece;
mod scatter;
mod smoothing;
mod spline;

pub use arc_length::ArcLength;
pub use bezier::{Bezier, BezierFit, FlattenError, flatten};
pub use foot::{Foot, FootFinder};
pub use knots::PointsError;
pub use piece::{Piece, PieceError};
pub use smoothing::{Choice, Smoothed, Smoothing};
pub use spline::Spline;
