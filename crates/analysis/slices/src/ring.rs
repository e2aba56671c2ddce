//! Closed polylines of the plane: the last point is followed by the first.

/// A point or vector of a slice's plane.
pub(crate) type Plane = [f64; 2];

/// Each point with the one after it.
pub(crate) fn sides(ring: &[Plane]) -> impl Iterator<Item = (&Plane, &Plane)> {
    ring.iter().zip(ring.iter().cycle().skip(1))
}

/// Positive where the ring runs counter-clockwise in (i to the right, j up).
pub(crate) fn signed_area(ring: &[Plane]) -> f64 {
    sides(ring).map(|(p, q)| p[0] * q[1] - q[0] * p[1]).sum::<f64>() / 2.0
}

/// Length of the whole way round.
pub(crate) fn length(ring: &[Plane]) -> f64 {
    sides(ring).map(|(p, q)| (q[0] - p[0]).hypot(q[1] - p[1])).sum()
}

/// Area times the place of its centroid, sign included, so that those of several rings add up.
pub(crate) fn moment(ring: &[Plane]) -> Plane {
    let mut sum = [0.0; 2];
    for (p, q) in sides(ring) {
        let cross = (p[0] * q[1] - q[0] * p[1]) / 6.0;
        for a in 0..2 {
            sum[a] += (p[a] + q[a]) * cross;
        }
    }
    sum
}

/// How many times the ring runs about a point, counter-clockwise counted positive.
pub(crate) fn winding(ring: &[Plane], at: Plane) -> i32 {
    let mut turns = 0;
    for (p, q) in sides(ring) {
        let (below, above) = (p[1] <= at[1], q[1] <= at[1]);
        if below != above {
            let side = (q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0]);
            if below && side > 0.0 {
                turns += 1;
            } else if above && side < 0.0 {
                turns -= 1;
            }
        }
    }
    turns
}

/// Whether no two sides cross. Sides are compared with those that lie level with them alone.
pub(crate) fn is_simple(ring: &[Plane]) -> bool {
    let count = ring.len();
    let side = |n: usize| (ring[n], ring[(n + 1) % count]);
    let low = |n: usize| side(n).0[1].min(side(n).1[1]);
    let high = |n: usize| side(n).0[1].max(side(n).1[1]);
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| low(a).total_cmp(&low(b)));
    let turn = |a: Plane, b: Plane, c: Plane| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let cross = |n: usize, m: usize| {
        let ((a, b), (c, d)) = (side(n), side(m));
        turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
    };
    order
        .iter()
        .enumerate()
        .all(|(at, &n)| order[at + 1..].iter().take_while(|&&m| low(m) <= high(n)).all(|&m| !cross(n, m)))
}

/// Points evenly spread along the ring, about `spacing` apart, the first one kept; at least eight.
pub(crate) fn resampled(ring: &[Plane], spacing: f64) -> Vec<Plane> {
    let whole = length(ring);
    let count = ((whole / spacing).round() as usize).max(8);
    let step = whole / count as f64;
    let mut points = Vec::with_capacity(count);
    let mut walked = 0.0;
    for (p, q) in sides(ring) {
        let side = (q[0] - p[0]).hypot(q[1] - p[1]);
        while points.len() < count && points.len() as f64 * step < walked + side {
            let t = (points.len() as f64 * step - walked) / side;
            points.push([p[0] + (q[0] - p[0]) * t, p[1] + (q[1] - p[1]) * t]);
        }
        walked += side;
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_has_its_sizes() {
        let square = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]];
        assert_eq!((signed_area(&square), length(&square)), (4.0, 8.0));
        assert!(moment(&square).iter().all(|m| (m - 8.0).abs() < 1e-12));
        assert_eq!((winding(&square, [2.0, 2.0]), winding(&square, [0.0, 2.0])), (1, 0));
        assert!(is_simple(&square) && !is_simple(&[square[0], square[2], square[1], square[3]]));
        let points = resampled(&square, 0.5);
        assert_eq!(points.len(), 16);
        assert!((length(&points) - 8.0).abs() < 1e-9 && points[1] == [1.5, 1.0]);
    }
}
