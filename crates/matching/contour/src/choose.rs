//! The choice itself: samples of an outline, edges near them, stretches of curves that win.

use std::collections::BTreeMap;

use biplane_artifact::{Contour, ContourPiece, Curves};
use biplane_edge_field::{EdgeField, EdgePlace};
use biplane_outline::OutlinePoint;

use crate::{ContourParams, Contrast};

/// How much farther than `reach_px` edges are looked at, to find their inset: at a smooth rim, up to two pixels.
const MOST_INSET_PX: f64 = 3.0;
/// How far an edge point may lie ahead of a sample or behind it, px: beyond the end of a curve there is no edge.
const ABREAST_PX: f64 = 1.5;
/// An edge that lies farther from the others of its body than this many of their standard deviations is none of the body's, and
/// how far off it may lie in any case, px: where a soft rim has no edge, one of the body's own inner ones runs beside it.
const MOST_DEVIATIONS: f64 = 4.0;
const SURELY_NEAR_PX: f64 = 1.0;
/// Points that no sample chose between points that one did, and still one stretch: samples and points are both about a pixel apart.
const MOST_SKIPPED: u32 = 4;

/// An edge near a sample of the outline.
struct Candidate {
    place: EdgePlace,
    /// How far the edge lies outside the outline, px.
    outside: f64,
}

/// The contour of a body whose outline has these samples, each in the picture.
pub fn choose(
    outline: &[OutlinePoint],
    edges: &EdgeField,
    curves: &Curves,
    params: &ContourParams,
) -> Contour {
    let bright = match params.contrast {
        Contrast::Dark => 1.0,
        Contrast::Bright => -1.0,
    };
    let min_cosine = params.turned_deg.to_radians().cos();
    // For each sample the nearest point of every curve.
    let near: Vec<Vec<Candidate>> = outline
        .iter()
        .map(|sample| {
            let mut found: Vec<(f64, Candidate)> = Vec::new();
            let wanted = sample.normal * bright;
            let reach = params.reach_px + MOST_INSET_PX;
            edges.within(&sample.pixel, &wanted, reach, min_cosine, |place, edge| {
                let apart = edge.position - sample.pixel;
                if sample.normal.perp(&apart).abs() > ABREAST_PX {
                    return;
                }
                // Where the outline's normal meets the edge.
                let across = edge.direction * bright;
                let outside = across.dot(&apart) / across.dot(&sample.normal);
                let candidate = (apart.norm_squared(), Candidate { place, outside });
                match found.iter_mut().find(|(_, c)| c.place.curve == place.curve) {
                    Some(known) if known.0 > candidate.0 => *known = candidate,
                    Some(_) => {}
                    None => found.push(candidate),
                }
            });
            found.into_iter().map(|(_, c)| c).collect()
        })
        .collect();
    // The inset is that of most edges: the median of the nearest one at each sample.
    let nearest =
        near.iter().filter_map(|c| c.iter().map(|c| c.outside).min_by(|a, b| a.abs().total_cmp(&b.abs())));
    let nearest: Vec<f64> = nearest.collect();
    let inset = median(nearest.clone()).clamp(-MOST_INSET_PX, MOST_INSET_PX);
    // 1.4826 times the median of absolute values is the standard deviation of normal numbers.
    let deviation = 1.4826 * median(nearest.iter().map(|outside| (outside - inset).abs()).collect());
    let reach = params.reach_px.min((MOST_DEVIATIONS * deviation).max(SURELY_NEAR_PX));

    let mut contour =
        Contour { pieces: Vec::new(), outline_px: 0.0, found_px: 0.0, unclear_px: 0.0, flags: Vec::new() };
    // Points chosen, by curve.
    let mut chosen: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (sample, candidates) in outline.iter().zip(near) {
        contour.outline_px += sample.length_px;
        let mut best: Option<(f64, EdgePlace)> = None;
        let mut second = f64::INFINITY;
        for Candidate { place, outside } in candidates {
            let off = (outside - inset).abs();
            match best {
                Some((least, _)) if off >= least => second = second.min(off),
                _ => {
                    second = best.map_or(second, |b| b.0);
                    best = Some((off, place));
                }
            }
        }
        let Some((least, place)) = best.filter(|b| b.0 <= reach) else { continue };
        contour.found_px += sample.length_px;
        if second <= reach && second - least < params.apart_px {
            contour.unclear_px += sample.length_px;
        }
        chosen.entry(place.curve).or_default().push(place.point);
    }
    for (curve, mut points) in chosen {
        points.sort_unstable();
        points.dedup();
        let Some(whole) = curves.0.get(curve as usize) else { continue };
        pieces(curve as usize, &points, whole.closed, whole.points.len(), params, &mut contour.pieces);
    }
    contour.flags = flags(&contour, params);
    contour
}

/// The middle one of some values; 0 where there are none.
fn median(mut values: Vec<f64>) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Stretches of one curve, given which of its points were chosen, ascending.
fn pieces(
    curve: usize,
    points: &[u32],
    closed: bool,
    count: usize,
    params: &ContourParams,
    found: &mut Vec<ContourPiece>,
) {
    let mut runs: Vec<[u32; 2]> = Vec::new();
    for &p in points {
        match runs.last_mut() {
            Some([_, last]) if p - *last <= MOST_SKIPPED => *last = p,
            _ => runs.push([p, p]),
        }
    }
    // Round the seam of a closed curve the last stretch and the first are one.
    if closed
        && runs.len() > 1
        && let (Some([first, _]), Some([_, last])) = (runs.first().copied(), runs.last().copied())
        && first + count as u32 - last <= MOST_SKIPPED
    {
        let [start, _] = runs.pop().unwrap_or([last, last]);
        runs[0][0] = start;
    }
    for [first, last] in runs {
        let (first, last) = (first as usize, last as usize);
        let length = if last >= first { last - first + 1 } else { last + count - first + 1 };
        if length >= params.min_points {
            found.push(ContourPiece { curve, first, last });
        }
    }
}

/// What a person should look at.
fn flags(contour: &Contour, params: &ContourParams) -> Vec<String> {
    let mut flags = Vec::new();
    let share = |px: f64| if contour.outline_px > 0.0 { px / contour.outline_px } else { 0.0 };
    if contour.outline_px <= 0.0 {
        flags.push("the body's outline is not in the picture".to_owned());
    } else if share(contour.found_px) < params.flag_found_share {
        flags.push(format!("only {:.0} % of the outline has an edge", 100.0 * share(contour.found_px)));
    }
    if share(contour.unclear_px) > params.flag_unclear_share {
        let percent = 100.0 * share(contour.unclear_px);
        flags.push(format!("along {percent:.0} % of the outline either of two edges could be meant"));
    }
    flags
}

#[cfg(test)]
mod tests {
    use super::*;
    use biplane_geometry::{Curve, EdgePoint, Point2, Point3, Vector2};

    /// An arc of edge points around (100, 100), bright outside or inside.
    fn arc(radius: f64, from: f64, to: f64, bright_outside: bool, closed: bool) -> Curve {
        let count = ((to - from).abs() * radius) as usize;
        let points = (0..count)
            .map(|i| {
                let a = from + (to - from) * i as f64 / count as f64;
                let radial = Vector2::new(a.cos(), a.sin());
                EdgePoint {
                    position: Point2::new(100.0, 100.0) + radius * radial,
                    direction: if bright_outside { radial } else { -radial },
                    strength: 10.0,
                    sigma_px: 0.05,
                }
            })
            .collect();
        Curve { points, closed }
    }

    fn circle(radius: f64) -> Vec<OutlinePoint> {
        arc(radius, 0.0, std::f64::consts::TAU, true, true)
            .points
            .iter()
            .map(|p| OutlinePoint {
                world: Point3::origin(),
                pixel: p.position,
                depth: 1000.0,
                normal: p.direction,
                length_px: 1.0,
                radius_mm: 20.0,
            })
            .collect()
    }

    fn chosen(curves: Vec<Curve>) -> Contour {
        let curves = Curves(curves);
        choose(&circle(50.0), &EdgeField::new(&curves, None), &curves, &ContourParams::default())
    }

    use std::f64::consts::TAU;

    #[test]
    fn a_closed_curve_at_the_inset_of_the_others_is_one_piece() {
        let contour = chosen(vec![arc(49.2, 0.0, TAU, true, true)]);
        assert_eq!(contour.pieces.len(), 1);
        assert!((contour.found_px / contour.outline_px - 1.0).abs() < 1e-9);
        assert!(contour.flags.is_empty() && contour.unclear_px == 0.0);
    }

    #[test]
    fn edges_of_another_contrast_or_course_and_far_ones_are_none_of_the_bodys() {
        // A line through the outline, a circle that is bright inside, one too far outside.
        let line = (0..150).map(|x| EdgePoint {
            position: Point2::new(30.0 + f64::from(x), 100.0),
            direction: Vector2::new(0.0, 1.0),
            strength: 10.0,
            sigma_px: 0.05,
        });
        let line = Curve { points: line.collect(), closed: false };
        let half = arc(49.5, 0.3, 3.3, true, false);
        let length = half.points.len() as f64;
        let contour =
            chosen(vec![line, arc(49.0, 0.0, TAU, false, true), arc(56.0, 3.4, 6.0, true, false), half]);
        assert_eq!(contour.pieces.iter().map(|p| p.curve).collect::<Vec<_>>(), [3]);
        assert!((contour.found_px - length).abs() < 6.0, "{}", contour.found_px);
        assert_eq!(contour.flags, ["only 48 % of the outline has an edge"]);
    }

    #[test]
    fn two_curves_that_cannot_be_told_apart_are_flagged() {
        let contour = chosen(vec![arc(49.0, 0.0, TAU, true, true), arc(49.6, 0.0, 1.5, true, false)]);
        assert!((contour.unclear_px - 1.5 * 50.0).abs() < 5.0, "{}", contour.unclear_px);
        assert_eq!(contour.flags.len(), 1, "{:?}", contour.flags);
        let apart = chosen(vec![arc(49.0, 0.0, TAU, true, true), arc(51.5, 0.0, 1.5, true, false)]);
        assert_eq!(apart.unclear_px, 0.0);
        assert_eq!(apart.pieces.len(), 1);
    }

    #[test]
    fn an_inner_edge_beside_a_soft_rim_is_not_taken_for_the_rim() {
        // The rim has no edge over a quarter; 2.2 px inside the others there is another edge of the body.
        let rim = arc(49.0, 1.6, TAU, true, false);
        let inner = arc(46.8, 0.0, 1.5, true, false);
        let pieces = chosen(vec![rim.clone(), inner.clone()]).pieces;
        assert_eq!(pieces.iter().map(|p| p.curve).collect::<Vec<_>>(), [0]);
        // Beside a pose that is off, edges scatter, and all within reach are taken.
        let mut off = vec![rim, inner];
        off.iter_mut().flat_map(|c| &mut c.points).for_each(|p| p.position.x += 2.0);
        assert!(chosen(off).pieces.iter().any(|p| p.curve == 1));
    }

    #[test]
    fn a_piece_runs_through_the_seam_of_a_closed_curve() {
        let outline: Vec<_> = circle(50.0).into_iter().filter(|p| p.pixel.x > 120.0).collect();
        let curves = Curves(vec![arc(50.0, 0.0, TAU, true, true)]);
        let contour = choose(&outline, &EdgeField::new(&curves, None), &curves, &ContourParams::default());
        assert_eq!(contour.pieces.len(), 1);
        assert!(contour.pieces[0].first > contour.pieces[0].last);
    }

    #[test]
    fn without_edges_or_outline_there_are_flags_and_no_pieces() {
        let none = Curves::default();
        let field = EdgeField::new(&none, None);
        let params = ContourParams::default();
        assert_eq!(choose(&[], &field, &none, &params).flags, ["the body's outline is not in the picture"]);
        assert_eq!(
            choose(&circle(9.0), &field, &none, &params).flags,
            ["only 0 % of the outline has an edge"]
        );
    }
}
