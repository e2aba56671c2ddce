//! A flat lid over a contour: its polygon cut into triangles, ear by ear (Meisters 1975).
//!
//! Of the corners that may be cut off the one with the widest least angle goes first among its neighbours' candidates, so that slivers are
//! rare. A contour that crosses itself has no triangles that fill it; then what is left is closed as a fan, and the checks say what crosses.

/// The triangles, as numbers of points, counter-clockwise. `clockwise` is how the points run.
pub(crate) fn lid(points: &[[f64; 2]], clockwise: bool) -> Vec<[u32; 3]> {
    let mut left: Vec<u32> = (0..points.len() as u32).collect();
    if clockwise {
        left.reverse();
    }
    let mut triangles = Vec::with_capacity(points.len());
    let at = |k: u32| points[k as usize];
    let mut from = 0;
    while left.len() > 3 {
        let count = left.len();
        let corners = |k: usize| [left[(k + count - 1) % count], left[k], left[(k + 1) % count]];
        // The first ear from where the last was cut, on the other side of it: lids of round contours are fans of strips, not of slivers.
        let ear = (0..count).map(|k| (from + k) % count).find(|k| is_ear(corners(*k), &left, at));
        let widest =
            (0..count).max_by(|a, b| turn(corners(*a).map(at)).total_cmp(&turn(corners(*b).map(at))));
        let Some(cut) = ear.or(widest) else { break };
        triangles.push(corners(cut));
        left.remove(cut);
        from = (cut + 1) % left.len();
    }
    if let [a, b, c] = left[..] {
        triangles.push([a, b, c]);
    }
    triangles
}

/// Twice the area of three points; positive counter-clockwise.
fn turn([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn is_ear(corners: [u32; 3], left: &[u32], at: impl Fn(u32) -> [f64; 2]) -> bool {
    let [a, b, c] = corners.map(&at);
    if turn([a, b, c]) <= 0.0 {
        return false;
    }
    !left.iter().filter(|k| !corners.contains(k)).map(|k| at(*k)).any(|p| {
        let twin = p == a || p == b || p == c;
        !twin && turn([a, b, p]) >= 0.0 && turn([b, c, p]) >= 0.0 && turn([c, a, p]) >= 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(points: &[[f64; 2]], clockwise: bool) -> f64 {
        let triangles = lid(points, clockwise);
        assert_eq!(triangles.len(), points.len() - 2);
        let area = |t: &[u32; 3]| turn(t.map(|k| points[k as usize])) / 2.0;
        assert!(triangles.iter().all(|t| area(t) > 0.0));
        triangles.iter().map(area).sum()
    }

    #[test]
    fn hollow_shapes_are_filled_once() {
        let comb: Vec<[f64; 2]> =
            (0..10).map(|k| [f64::from(k), if k % 2 == 0 { 1.0 } else { 5.0 }]).collect();
        let mut points = vec![[0.0, 0.0]];
        points.push([9.0, 0.0]);
        points.extend(comb.into_iter().rev());
        // Under the zigzag: 9 mm wide, 3 mm high in the mean.
        assert!((filled(&points, false) - 27.0).abs() < 1e-12);
        points.reverse();
        assert!((filled(&points, true) - 27.0).abs() < 1e-12);
    }
}
