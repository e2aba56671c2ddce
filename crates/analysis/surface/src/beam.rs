//! The triangles near a line.

use biplane_geometry::{Point3, Vector3};

use crate::tree::{Child, STACK, Surface, child};

impl Surface {
    /// Gives the corners of every triangle that comes within `radius` (along each axis) of the line through `from` along `direction`, and
    /// of some more beside it; in the order of the tree.
    pub fn along(
        &self,
        from: &Point3,
        direction: &Vector3,
        radius: f64,
        mut found: impl FnMut(&[Point3; 3]),
    ) {
        // No component is zero, so that no box is an infinity times zero away.
        let inverse = direction.map(|d| 1.0 / if d.abs() < 1e-12 { 1e-12 } else { d });
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
                        for axis in 0..3 {
                            let low = (f64::from(node.low[axis][k]) - radius - from[axis]) * inverse[axis];
                            let high = (f64::from(node.high[axis][k]) + radius - from[axis]) * inverse[axis];
                            enter = enter.max(low.min(high));
                            leave = leave.min(low.max(high));
                        }
                        // A box that holds nothing goes from infinity to minus infinity.
                        if enter <= leave && node.low[0][k] <= node.high[0][k] {
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
    fn no_triangle_near_the_line_is_left_out() {
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
            let mut seen = Vec::new();
            surface.along(&from, &direction, 0.7, |t| seen.push(*t));
            for t in &soup {
                let off = |p: &Point3| (p - from).cross(&direction).norm() / direction.norm();
                if t.iter().any(|p| off(p) < 0.7) {
                    assert!(seen.contains(t));
                    near += 1;
                }
            }
            all += seen.len();
        }
        assert!(near > 100 && all < 200 * 400 / 4, "{near} of {all}");
        // Along an axis too, where two components are zero.
        let mut seen = 0;
        surface.along(&Point3::new(0.0, 0.0, -50.0), &Vector3::z(), 30.0, |_| seen += 1);
        assert_eq!(seen, 400);
    }
}
