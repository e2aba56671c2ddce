//! Edges and the contours chosen among them: bias of curved edges and of rims, stated deviations, edges of the wrong body.

mod chosen;
mod discs;
mod rims;

use super::SectionError;
use crate::{Lab, Section};

/// Measures it.
pub fn measure(lab: &Lab) -> Result<Option<Section>, SectionError> {
    let (rims, plot) = rims::insets(lab)?;
    let (chosen, frames) = chosen::table(lab)?;
    Ok(Some(Section {
        title: "Edges and the contours chosen among them".to_owned(),
        text: vec![
            format!(
                "**Round edges.** Discs with a step of 100 levels for an edge, dark and bright, with their centres anywhere between pixels, without \
                 noise: errors of the radius at all edge points, without and with the correction of curved edges (`correct_curved`). \
                 *Total blur* is the root sum of squares of the picture's Gaussian, its pixels (1/√12 px) and `smoothing_px`. The goal is \
                 0.05 px from {:.0} blurs on; ratios below that are in italics, to show where the correction fails: below 1.5 blurs it makes \
                 the error larger. Where the total blur is 0.7 px or more each single point meets the goal from 3 blurs on. Pictures \
                 that are sharper than their own pixels and not smoothed either (0.35 px) meet it as a root mean square alone: single points \
                 are off by up to 0.09 px, and 0.13 px at radii of 2 and 3 px, by their place between pixels.",
                discs::HOLDS_FROM
            ),
            "**Stated deviations.** Root mean square error of edges in noisy pictures over the standard deviation that the points state (wanted: \
             0.9 to 1.15), on discs of 40 px with a step of 100 levels, and on a ball of bone of 12 mm X-rayed with the usual exposure behind the \
             light of 120 mm of soft tissue (its inset taken out). The noise is measured after smoothing, by a mask as wide as that, so what \
             neighbouring pixels share counts; where they share it over more than the smoothing (a detector that blurs its photons, little \
             smoothing) the deviation is still too small."
                .to_owned(),
            "**Rims of smooth bodies.** X-rayed without noise (bone in soft tissue, metal in air; focal spot of 0.6 mm): how far inside the true \
             outline the corrected edge points lie. A ray just inside the outline of a smooth body has hardly any way through it, so the \
             steepest place lies inside, by an amount that theory gives: where `k = mu sqrt(8 r s)` is what a ray absorbs one blur `s` inside (at \
             the body, mm), `mu` the attenuation over that of the ground and `r` the radius of curvature along the ray, it is a function of `k` times \
             the blur, from 0.765 blurs (weak) to none (strong). *Blur* includes here the difference that the gradient is taken by (variance 1/3 px²). \
             So it grows with all blur alike, whether the picture's or of smoothing; falls with attenuation, from a pixel in bone to 0.04 px in \
             thick cobalt-chrome; falls with `r` as well, but by its root; and hardly depends on the radius in the picture, whose own \
             shrinkage is corrected: theory without it holds to 0.08 px. A plate's edge that runs along the rays has none; \
             one whose wall is seen lies within the wall's shadow (here 0.8 px wide). Matching solves for one inset a view and body, since it \
             cannot know all of this."
                .to_owned(),
            format!(
                "**Contours chosen.** Raw pictures as in *End to end*, {frames} frame pairs with implants and {frames} of a natural knee, exact calibrations. For each \
                 body and view the stage `contour` chooses at the true pose, where a match ended that began 6 mm and 6 degrees off, and \
                 exactly 0.5 mm and 0.5 degrees beside the truth (3 px in the picture, its whole reach). A chosen edge is *wrong* that lies more than \
                 1.5 px from the body's true outline (of the analytic surface) after the median inset of that contour; shares are of \
                 chosen length, over contours. *Of another body*: wrong ones that lie on another body's outline; the \
                 others mostly lie on the body's own inner edges, where a soft rim beside them has no edge. *Found* and *unclear* are shares of the \
                 outline, as the stage itself counts them."
            ),
        ],
        tables: vec![discs::shrinkage(lab), discs::stated(lab)?, rims, chosen],
        plots: vec![plot],
    }))
}
