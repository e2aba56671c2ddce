//! What the lists of a plate's holes and of a frame's beads are checked for alike.

use crate::meshes::LengthUnit;

/// Diagonal of the box around a plate or a frame, mm.
const PLAUSIBLE_MM: std::ops::RangeInclusive<f64> = 5.0..=2000.0;
/// Diagonal of those that laboratories have, mm: what an advice goes by.
const USUAL_MM: std::ops::RangeInclusive<f64> = 30.0..=1000.0;

/// Rows a list may have: pairs of them are compared.
pub(crate) const MOST_ROWS: usize = 20_000;

/// What is wrong with the extent of these places (mm, of which the file's unit has `scale`), and the unit that would fit;
/// `set` says how one sets it.
pub(crate) fn unlikely_size(
    places: &[[f64; 3]],
    scale: f64,
    of: &str,
    set: impl Fn(&str) -> String,
) -> Option<String> {
    let extent = |axis: usize| {
        let values = places.iter().map(|p| p[axis]);
        let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)));
        high - low
    };
    let diagonal = extent(0).hypot(extent(1)).hypot(extent(2));
    if PLAUSIBLE_MM.contains(&diagonal) {
        return None;
    }
    let fits: Vec<String> = LengthUnit::ALL
        .iter()
        .filter(|unit| USUAL_MM.contains(&(diagonal / scale * unit.millimetres())))
        .map(|unit| format!("{} ({:.3} mm)", set(unit.name()), diagonal / scale * unit.millimetres()))
        .collect();
    let advice = if fits.is_empty() { String::new() } else { format!(": {}", fits.join(", or ")) };
    Some(format!(
        "the {of} would be {diagonal:.3} mm across; expected {} to {} mm{advice}",
        PLAUSIBLE_MM.start(),
        PLAUSIBLE_MM.end()
    ))
}

/// The first pair of places nearer than their radii together, or than `same_mm` where these are not known, and how near.
pub(crate) fn overlapping(
    places: &[[f64; 3]],
    radii_mm: &[Option<f64>],
    same_mm: f64,
) -> Option<(usize, usize, f64)> {
    // Sorted along x, only neighbours within the largest reach need a look.
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|&a, &b| places[a][0].total_cmp(&places[b][0]));
    let radius = |i: usize| radii_mm.get(i).copied().flatten().unwrap_or(0.0);
    let largest = (0..places.len()).map(radius).fold(0.0, f64::max);
    let mut first: Option<(usize, usize, f64)> = None;
    for (place, &a) in order.iter().enumerate() {
        for &b in &order[place + 1..] {
            let along = places[b][0] - places[a][0];
            if along > (radius(a) + largest).max(same_mm) {
                break;
            }
            let apart = along.hypot(places[b][1] - places[a][1]).hypot(places[b][2] - places[a][2]);
            if apart < (radius(a) + radius(b)).max(same_mm) {
                let pair = (a.min(b), a.max(b), apart);
                if first.is_none_or(|(_, b, _)| pair.1 < b) {
                    first = Some(pair);
                }
            }
        }
    }
    first
}
