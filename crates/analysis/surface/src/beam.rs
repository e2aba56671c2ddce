//! The triangles that a plane cuts near a line in it.

use biplane_geometry::{Point3, Vector3};

use crate::tree::{Child, STACK, Surface, child};

impl Surface {
    /// Gives the corners of every triangle that comes within `radius` (along each axis) of the line through `from` along `direction` and
    /// touches the plane through `from` across `normal`, and of some more beside them; in the order of the tree.
    pub fn along(
        &self,
        from: &Point3,
        direction: &Vector3,
        normal: &Vector3,
        radius: f64,
        mut found: impl FnMut(&[Point3; 3]),
    ) {
        // No component is zero, so that no box is an infinity times zero away.
        let inverse = direction.map(|d| 1.0 / if d.abs() < 1e-12 { 1e-12 } else { d });
        let wide = normal.abs();
        // Far more than rounding takes from a box that just touches the plane.
        let slack = 1e-9 * wide.sum() * (1.0 + from.coords.amax());
        let mut stack = [0_u32; STACK];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            match child(stack[height]) {
                Child::Leaf(first, last) => {
                    self.corners[first as usize..last as usize].iter().for_each(&mut found);
                }
                Child::Node(number) => {
                    let node = &self.nodes[number as usize];
                    for k in 0..4 {
                        let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
                        let (mut off, mut reach) = (0.0, slack);
                        for axis in 0..3 {
                            let low = f64::from(node.low[axis][k]) - from[axis];
                            let high = f64::from(node.high[axis][k]) - from[axis];
                            off += normal[axis] * (low + high);
                            reach += wide[axis] * (high - low);
                            let (near, far) =
                                ((low - radius) * inverse[axis], (high + radius) * inverse[axis]);
                            enter = enter.max(near.min(far));
                            leave = leave.min(near.max(far));
                        }
                        // A box that holds nothing goes from infinity to minus infinity.
                        let some = node.low[0][k] <= node.high[0][k];
                        if some && enter <= leave && off.abs() <= reach {
                            stack[height] = node.child[k];
                            height += 1;
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use biplane_geometry::Mesh;
    use rand::{Rng, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    #[test]
    fn no_triangle_of_the_plane_near_the_line_is_left_out() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
        let mut place = |size: f64| Point3::from([0; 3].map(|_| random.random_range(-size..size)));
        let soup: Vec<[Point3; 3]> = (0..400)
            .map(|_| {
                let middle = place(20.0);
                [0; 3].map(|_| middle + place(1.0).coords)
            })
            .collect();
        let surface = Surface::new(&Mesh::from_soup(&soup).unwrap());
        let (mut all, mut near) = (0, 0);
        for _ in 0..200 {
            let (from, through) = (place(30.0), place(20.0));
            let direction = through - from;
            let normal = direction.cross(&place(1.0).coords);
            let mut seen = Vec::new();
            surface.along(&from, &direction, &normal, 0.7, |t| seen.push(*t));
            for t in &soup {
                let off = |p: &Point3| (p - from).cross(&direction).norm() / direction.norm();
                let above = t.iter().filter(|p| normal.dot(&(*p - from)) > 0.0).count();
                if t.iter().any(|p| off(p) < 0.7) && (above == 1 || above == 2) {
                    assert!(seen.contains(t));
                    near += 1;
                }
            }
            all += seen.len();
        }
        assert!(near > 50 && all < 200 * 400 / 10, "{near} of {all}");
        // Along an axis too, where two components are zero.
        let mut seen = 0;
        surface.along(&Point3::new(0.0, 0.0, -50.0), &Vector3::z(), &Vector3::zeros(), 30.0, |_| seen += 1);
        assert_eq!(seen, 400);
    }
}
