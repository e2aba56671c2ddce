//! Which spots a person named in a picture.

use biplane_artifact::{BeadClick, BeadClicks, BeadList, Detector};
use biplane_geometry::Point2;

use crate::error::EnvironmentError;
use crate::find::BeadPicture;

/// Enters the clicks into the pictures: each on the nearest spot, within the larger of twice its radius and 1.5 % of the picture.
pub(crate) fn named_beads(
    pictures: &mut [BeadPicture],
    detectors: &[&Detector],
    beads: &BeadList,
    clicks: &BeadClicks,
) -> Result<(), EnvironmentError> {
    for BeadClick { view, picture, bead, at_px } in &clicks.0 {
        let nothing = |what: String| EnvironmentError::ClickOfNothing { what, at_px: *at_px };
        let Some(listed) = beads.0.get(*bead) else {
            return Err(nothing(format!("bead {bead} (counted from 0) of a list of {}", beads.0.len())));
        };
        let Some(page) = pictures.iter_mut().find(|p| p.view == *view && p.set == *picture) else {
            return Err(nothing(format!(
                "picture {picture} of view {view} (counted from 0), which is not there"
            )));
        };
        let detector = detectors[*view];
        let at = Point2::from(*at_px);
        let distance = |s: usize| (Point2::from(page.spots.spots[page.seen[s].spot].at_px) - at).norm();
        let nearest = (0..page.seen.len()).map(|s| (distance(s), s)).min_by(|a, b| a.0.total_cmp(&b.0));
        let (distance_px, spot) = nearest.unwrap_or((f64::INFINITY, 0));
        let radius = page.seen.get(spot).map_or(0.0, |s| s.radius_px);
        let limit_px = (2.0 * radius).max(0.015 * detector.size[0].max(detector.size[1]) as f64);
        if distance_px.is_nan() || distance_px > limit_px {
            return Err(EnvironmentError::ClickFar {
                view: detector.view.clone(),
                picture: *picture,
                bead: listed.name.clone(),
                at_px: *at_px,
                distance_px,
                limit_px,
            });
        }
        let clash = |other: usize, what: &'static str| EnvironmentError::ClicksClash {
            view: detector.view.clone(),
            picture: *picture,
            first: beads.0[other].name.clone(),
            second: listed.name.clone(),
            what,
        };
        if let Some(other) = page.named.iter().position(|n| *n == Some(spot)).filter(|o| o != bead) {
            return Err(clash(other, "are on the same spot"));
        }
        if page.named[*bead].is_some_and(|s| s != spot) {
            return Err(clash(*bead, "are one bead on two spots"));
        }
        page.named[*bead] = Some(spot);
    }
    Ok(())
}
