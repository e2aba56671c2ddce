//! What is mended in a mesh, what is only named, and how the unit is told: solids whose faults were put in by hand, so that the truth is known.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::fmt::Write as _;

use approx::assert_relative_eq;
use biplane_acquisition::inspect::describe;
use biplane_acquisition::meshes::{LengthUnit, MeshFile, MeshNote, read_mesh};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use tempfile::TempDir;

type Triangle = [[f64; 3]; 3];

/// A box between two corners, wound outward.
fn cuboid(low: [f64; 3], high: [f64; 3]) -> Vec<Triangle> {
    let v = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { low[axis] } else { high[axis] });
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        .iter()
        .flat_map(|q| [[v(q[0]), v(q[1]), v(q[2])], [v(q[0]), v(q[2]), v(q[3])]])
        .collect()
}

fn cube(middle: [f64; 3], side: f64) -> Vec<Triangle> {
    cuboid(middle.map(|c| c - side / 2.0), middle.map(|c| c + side / 2.0))
}

fn reversed(mut triangles: Vec<Triangle>) -> Vec<Triangle> {
    triangles.iter_mut().for_each(|t| t.swap(1, 2));
    triangles
}

/// A ball of `n` rings and `2 n` sectors, wound outward.
fn ball(middle: [f64; 3], radius: f64, n: usize) -> Vec<Triangle> {
    let at = |i: usize, j: usize| {
        let (a, b) = (
            std::f64::consts::PI * i as f64 / n as f64,
            std::f64::consts::PI * (j % (2 * n)) as f64 / n as f64,
        );
        // The poles are one point each.
        let s = if i == 0 || i == n { 0.0 } else { a.sin() };
        [middle[0] + radius * s * b.cos(), middle[1] + radius * s * b.sin(), middle[2] + radius * a.cos()]
    };
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..2 * n {
            let [p, q, r, s] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if i + 1 < n {
                triangles.push([p, q, r]);
            }
            if i > 0 {
                triangles.push([p, r, s]);
            }
        }
    }
    triangles
}

fn volume(triangles: &[Triangle]) -> f64 {
    let det = |[a, b, c]: &Triangle| {
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    triangles.iter().map(det).sum::<f64>() / 6.0
}

/// As ascii STL with every digit, so that places stay what they are.
fn read_as(triangles: &[Triangle], unit: Option<LengthUnit>) -> Result<MeshFile, String> {
    let mut text = "solid x\n".to_owned();
    for t in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for c in t {
            writeln!(text, "vertex {} {} {}", c[0], c[1], c[2]).unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("mesh.stl");
    std::fs::write(&path, text + "endsolid x\n").unwrap();
    println!("{}\n", describe(&path).map_or_else(|e| e.to_string(), |d| d.to_string()));
    let file = read_mesh(&path, unit).map_err(|e| e.to_string().rsplit('/').next().unwrap().to_owned())?;
    assert_eq!(file.topology, file.model.0.topology(), "as geometry counts it");
    Ok(file)
}

fn read(triangles: &[Triangle]) -> MeshFile {
    read_as(triangles, Some(LengthUnit::Millimetres)).unwrap()
}

#[test]
fn any_winding_of_a_closed_mesh_is_mended() {
    let whole = ball([5.0, -3.0, 2.0], 30.0, 12);
    let right = volume(&whole);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    for share in [0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0] {
        let mut soup = whole.clone();
        soup.iter_mut().filter(|_| random.random_bool(share)).for_each(|t| t.swap(1, 2));
        let file = read(&soup);
        assert_eq!(file.topology.inconsistent_edges, 0);
        assert_relative_eq!(file.model.0.signed_volume(), right, max_relative = 1e-12);
        assert_relative_eq!(file.pieces[0].volume_mm3.unwrap(), right, max_relative = 1e-12);
        assert!(share != 0.0 || file.notes.is_empty());
        assert!(share != 1.0 || file.notes == [MeshNote::Inverted { count: 1, of: 1 }]);
        // In whichever order the triangles come.
        soup.reverse();
        assert_relative_eq!(read(&soup).model.0.signed_volume(), right, max_relative = 1e-12);
    }
}

#[test]
fn a_cavity_faces_inward_and_a_body_in_it_outward() {
    let balls = [30.0, 20.0, 10.0].map(|r| ball([0.0; 3], r, 10));
    let beside = cube([100.0, 0.0, 0.0], 10.0);
    let [outer, middle, inner] = balls.each_ref().map(|b| volume(b));
    for turned in 0..16_u32 {
        let mut soup = Vec::new();
        for (k, part) in balls.iter().chain([&beside]).enumerate() {
            let part = part.clone();
            soup.extend(if turned >> k & 1 == 1 { reversed(part) } else { part });
        }
        let file = read(&soup);
        assert_relative_eq!(
            file.model.0.signed_volume(),
            outer - middle + inner + 1000.0,
            max_relative = 1e-12
        );
        assert!(file.notes.contains(&MeshNote::Cavities { count: 1 }), "{:?}", file.notes);
        assert!(file.notes.contains(&MeshNote::Bodies { count: 4 }));
        // The largest first.
        let found: Vec<(bool, f64)> = file.pieces.iter().map(|p| (p.cavity, p.volume_mm3.unwrap())).collect();
        for ((cavity, found), (expected, right)) in
            found.iter().zip([(false, outer), (true, -middle), (false, inner), (false, 1000.0)])
        {
            assert_eq!(*cavity, expected);
            assert_relative_eq!(*found, right, max_relative = 1e-12);
        }
    }
    // Beside each other, one in the other's box: not within it.
    let bent = [cuboid([0.0; 3], [60.0, 10.0, 10.0]), cuboid([0.0, 20.0, 0.0], [10.0, 60.0, 10.0])].concat();
    assert!(!read(&bent).notes.iter().any(|n| matches!(n, MeshNote::Cavities { .. })));
    let mut ring = ball([0.0; 3], 30.0, 10);
    // A ball with a thin wall is open to the outside: a cube between the walls is within its box and not in it.
    ring.extend(reversed(ball([0.0; 3], 25.0, 10)));
    ring.extend(cube([20.0, 20.0, 20.0], 2.0));
    let file = read(&ring);
    assert_eq!(
        file.notes.iter().filter(|n| **n == MeshNote::Cavities { count: 1 }).count(),
        1,
        "{:?}",
        file.notes
    );
    assert_relative_eq!(file.pieces[2].volume_mm3.unwrap(), 8.0, epsilon = 1e-9);
}

#[test]
fn rims_are_named_and_nothing_is_filled() {
    // A box of 30 x 40 x 50 without its lid at z = 50 and without one triangle of its floor.
    let mut soup = cuboid([0.0; 3], [30.0, 40.0, 50.0]);
    soup.drain(2..4);
    soup.remove(0);
    let file = read(&soup);
    assert_eq!((file.rims.len(), file.seams.len(), file.model.0.triangles().len()), (2, 0, 9));
    let [lid, floor] = &file.rims[..] else { panic!() };
    assert_eq!((lid.edges, lid.piece), (4, 0));
    assert_relative_eq!(lid.length_mm, 140.0, epsilon = 1e-9);
    assert_relative_eq!(lid.centre_mm[..], [15.0, 20.0, 50.0][..], epsilon = 1e-9);
    assert_eq!(floor.edges, 3);
    assert_relative_eq!(floor.length_mm, 120.0, epsilon = 1e-9);
    let note = file.notes.iter().find(|n| matches!(n, MeshNote::Open { .. })).unwrap().to_string();
    assert_eq!(
        note,
        "not closed: 7 edges with one triangle only, in 2 rims; the longest is 140.0 mm long around (15.0, 20.0, 50.0) mm"
    );
    assert_eq!(file.pieces[0].volume_mm3, None);
}

#[test]
fn a_t_junction_is_left_and_shows_as_a_rim() {
    // The top face's edge y = 0 has a vertex in its middle that the front face lacks.
    let mut soup = cuboid([0.0; 3], [40.0; 3]);
    let [p, q, r, s, m] =
        [[0.0, 0.0, 40.0], [40.0, 0.0, 40.0], [40.0, 40.0, 40.0], [0.0, 40.0, 40.0], [20.0, 0.0, 40.0]];
    soup.splice(2..4, [[p, m, s], [m, r, s], [m, q, r]]);
    let file = read(&soup);
    assert_eq!((file.rims.len(), file.rims[0].edges, file.repairs.near_vertices), (1, 3, 0));
    assert_relative_eq!(file.rims[0].length_mm, 80.0, epsilon = 1e-9);
}

#[test]
fn needles_are_taken_in_and_the_mesh_stays_closed() {
    // The same, with triangles without area between the long edge of the front face and the short ones of the top.
    let [p, q, r, s] = [[0.0, 0.0, 40.0], [40.0, 0.0, 40.0], [40.0, 40.0, 40.0], [0.0, 40.0, 40.0]];
    let [m, n] = [[20.0, 0.0, 40.0], [30.0, 0.0, 40.0]];
    let mut soup = cuboid([0.0; 3], [40.0; 3]);
    soup.splice(2..4, [[p, m, s], [m, r, s], [m, n, r], [n, q, r], [p, q, m], [m, q, n]]);
    for turned in 0..4 {
        // Whichever way the needles are wound and in whichever order they come.
        let mut soup = soup.clone();
        if turned & 1 == 1 {
            soup[6].swap(0, 1);
        }
        if turned & 2 == 2 {
            soup.swap(6, 7);
        }
        let file = read(&soup);
        assert_eq!(
            (file.repairs.needles, file.repairs.degenerate, file.rims.len()),
            (2, 0, 0),
            "{:?}",
            file.notes
        );
        assert_eq!(file.notes, [MeshNote::Needles { triangles: 2 }]);
        assert_relative_eq!(file.model.0.signed_volume(), 64_000.0, max_relative = 1e-12);
        assert_relative_eq!(file.model.0.area(), 9_600.0, max_relative = 1e-12);
        assert_eq!(file.model.0.triangles().len(), 16);
    }
}

#[test]
fn cracks_of_rounding_are_welded_and_wider_ones_are_not() {
    let whole = ball([0.0; 3], 40.0, 10);
    let diagonal = 2.0 * 40.0 * 3.0_f64.sqrt();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let mut with = |share: f64| {
        let mut soup = whole.clone();
        let most = share * diagonal / 3.0_f64.sqrt() / 2.0;
        soup.iter_mut().flatten().flatten().for_each(|c| *c += random.random_range(-most..most));
        read(&soup)
    };
    // Two copies of a vertex are at most the tolerance apart.
    let file = with(0.9e-6);
    assert_eq!((file.topology.open_edges, file.topology.bodies), (0, 1), "{:?}", file.notes);
    assert_eq!(file.model.0.vertices().len(), 2 + 9 * 20);
    assert_eq!(file.model.0.triangles().len(), whole.len());
    assert!(file.notes.iter().any(|n| matches!(n, MeshNote::Welded { .. })));
    assert_relative_eq!(file.model.0.signed_volume(), volume(&whole), max_relative = 1e-5);
    let file = with(1e-4);
    assert!(file.topology.open_edges > 1000);
}

#[test]
fn no_small_triangle_is_collapsed() {
    // An open strip whose short sides are far below the tolerance, beside a large cube.
    let mut soup = cube([0.0; 3], 80.0);
    let side = 1e-5;
    let at = |k: usize, up: f64| [100.0 + k as f64 * side, up, 0.0];
    for k in 0..20 {
        soup.push([at(k, 0.0), at(k + 1, 0.0), at(k, 1.0)]);
        soup.push([at(k + 1, 0.0), at(k + 1, 1.0), at(k, 1.0)]);
    }
    let file = read(&soup);
    assert_eq!(file.model.0.triangles().len(), 12 + 40);
    assert_eq!((file.repairs.degenerate, file.repairs.duplicate), (0, 0));
}

#[test]
fn degenerate_and_duplicate_triangles_are_dropped() {
    let whole = ball([0.0; 3], 30.0, 8);
    let mut soup = whole.clone();
    soup.push([whole[3][1], whole[3][2], whole[3][0]]);
    soup.push([whole[9][0], whole[9][2], whole[9][1]]);
    soup.push(whole[9]);
    soup.push([whole[0][0], whole[0][0], whole[0][1]]);
    let file = read(&soup);
    assert_eq!(
        (file.repairs.duplicate, file.repairs.degenerate, file.triangles_in_file),
        (3, 1, whole.len() + 4)
    );
    assert_eq!(file.notes, [MeshNote::Degenerate { triangles: 1 }, MeshNote::Duplicate { triangles: 3 }]);
    assert_relative_eq!(file.model.0.signed_volume(), volume(&whole), max_relative = 1e-12);
}

#[test]
fn bodies_that_touch_along_an_edge_stay_closed() {
    let soup =
        [cuboid([0.0; 3], [30.0; 3]), reversed(cuboid([30.0, 30.0, 0.0], [50.0, 50.0, 30.0]))].concat();
    let file = read(&soup);
    assert_eq!((file.seams.len(), file.seams[0].edges, file.rims.len(), file.pieces.len()), (1, 1, 0, 1));
    assert_relative_eq!(file.seams[0].centre_mm[..], [30.0, 30.0, 15.0][..], epsilon = 1e-9);
    assert_relative_eq!(file.model.0.signed_volume(), 27_000.0 + 12_000.0, max_relative = 1e-12);
    assert_relative_eq!(file.pieces[0].volume_mm3.unwrap(), 39_000.0, max_relative = 1e-12);
    assert_eq!(file.notes[0].to_string(), "1 of 2 closed surfaces were wound inside out; turned round");
}

#[test]
fn a_moebius_strip_is_left_and_named() {
    let n = 24;
    let at = |k: usize, side: f64| {
        let (k, side) = if k >= n { (k - n, -side) } else { (k, side) };
        let (a, half) =
            (std::f64::consts::TAU * k as f64 / n as f64, std::f64::consts::PI * k as f64 / n as f64);
        let r = 40.0 + side * half.cos();
        [r * a.cos(), r * a.sin(), side * half.sin()]
    };
    let soup: Vec<Triangle> = (0..n)
        .flat_map(|k| {
            [[at(k, -5.0), at(k + 1, -5.0), at(k + 1, 5.0)], [at(k, -5.0), at(k + 1, 5.0), at(k, 5.0)]]
        })
        .collect();
    let file = read(&soup);
    assert_eq!((file.topology.inconsistent_edges, file.rims.len()), (1, 1));
    assert!(
        file.notes.iter().any(|n| n.to_string().starts_with("a surface with one side only")),
        "{:?}",
        file.notes
    );
}

#[test]
fn the_unit_is_told_or_asked_for() {
    let sized = |diagonal: f64| read_as(&cube([0.0; 3], diagonal / 3.0_f64.sqrt()), None);
    // In mm alone: more than 55, where cm would be 550 mm, up to 550.
    for diagonal in [55.1, 80.0, 150.0, 500.0, 549.0] {
        let file = sized(diagonal).unwrap();
        assert_eq!(file.unit, LengthUnit::Millimetres);
        let (low, high) = file.model.0.bounding_box();
        assert_relative_eq!((high - low).norm(), diagonal, max_relative = 1e-12);
    }
    for (diagonal, question) in [
        (
            50.0,
            "28.9 x 28.9 x 28.9 units are 28.9 x 28.9 x 28.9 mm if it is in mm, 289 x 289 x 289 mm if it is in cm; add `units = \"mm\"` or \
                `units = \"cm\"` to its [[body]]",
        ),
        (20.0, "`units = \"mm\"` or `units = \"cm\"` or `units = \"in\"` to its [[body]]"),
        (
            8.0,
            "4.62 x 4.62 x 4.62 units are 46.2 x 46.2 x 46.2 mm if it is in cm, 117 x 117 x 117 mm if it is in in; add `units = \"cm\"` or \
               `units = \"in\"` to its [[body]]",
        ),
        (3.5, "`units = \"cm\"` or `units = \"in\"` to its [[body]]"),
        (
            1.0,
            "0.577 x 0.577 x 0.577 units are 14.7 x 14.7 x 14.7 mm if it is in in; if so, add `units = \"in\"` to its [[body]]",
        ),
        (0.5, "289 x 289 x 289 mm if it is in m; if so, add `units = \"m\"` to its [[body]]"),
        (
            0.08,
            "0.0462 x 0.0462 x 0.0462 units are 46.2 x 46.2 x 46.2 mm if it is in m; if so, add `units = \"m\"` to its [[body]]",
        ),
        (
            700.0,
            "404 x 404 x 404 units would be the size of a bone or implant (15 to 550 mm across) neither in mm nor in cm, m or inches; scale it",
        ),
        (0.01, "units would be the size of a bone or implant (15 to 550 mm across) neither"),
    ] {
        let error = sized(diagonal).unwrap_err();
        assert!(
            error.starts_with("mesh.stl does not say its unit, and its size leaves it open: ")
                && error.contains(question),
            "{error}"
        );
    }
    // What the user says is believed unless it is absurd.
    for (unit, diagonal) in
        [(LengthUnit::Inches, 0.5), (LengthUnit::Centimetres, 150.0), (LengthUnit::Millimetres, 6.0)]
    {
        let file = read_as(&cube([0.0; 3], diagonal / 3.0_f64.sqrt()), Some(unit)).unwrap();
        let (low, high) = file.model.0.bounding_box();
        assert_relative_eq!((high - low).norm(), diagonal * unit.millimetres(), max_relative = 1e-12);
    }
}

#[test]
fn inspect_tells_all_of_it() {
    let mut soup = cuboid([0.0; 3], [30.0, 40.0, 50.0]);
    soup.drain(2..4);
    soup.extend(reversed(cube([100.0, 20.0, 25.0], 20.0)));
    soup.push(soup[0]);
    let mut text = "solid x\n".to_owned();
    for t in &soup {
        text += "facet normal 0 0 0\nouter loop\n";
        t.iter().for_each(|c| writeln!(text, "vertex {} {} {}", c[0], c[1], c[2]).unwrap());
        text += "endloop\nendfacet\n";
    }
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("two.stl");
    std::fs::write(&path, text + "endsolid x\n").unwrap();
    let said = describe(&path).unwrap().to_string();
    let expected = "mesh, ascii STL
  triangles      23 in the file, 22 kept
  vertices       16
  size           110 x 40.0 x 50.0 in the file's unit
  if in mm       110 x 40.0 x 50.0 mm: a bone or implant may be that
  if in cm       1100 x 400 x 500 mm: too large for a bone or implant
  if in m        110000 x 40000 x 50000 mm: too large for a bone or implant
  if in in       2794 x 1016 x 1270 mm: too large for a bone or implant
  unit           not in the file; taken as mm, which alone fits
  figures below  as if the file were in mm
  surface        open: 4 edges have one triangle, wound outward, 2 pieces
  area           10600 mm^2
  volume         none: not closed
  centroid       (34.25, 20.00, 22.17) mm, of the surface
  edge length    median 28.3 mm, 5 to 95 %: 20.0 to 58.3 mm, longest 64.0 mm
  piece 1        10 triangles, 30.0 x 40.0 x 50.0 mm around (15.00, 20.00, 25.00), 8200 mm^2, open
  piece 2        12 triangles, 20.0 x 20.0 x 20.0 mm around (100.00, 20.00, 25.00), 2400 mm^2, closed, 8000 mm^3
  rim 1          4 edges of one triangle, 140 mm long around (15.00, 20.00, 50.00) mm, of piece 1
  mended         triangles with the corners of another, dropped: 1; surfaces inside out, turned: 1";
    // The centroid's x is (8200 15 + 2400 100) / 10600, its z (1200 0 + 7000 25 + 2400 25) / 10600. Of 35 edges 12 are 20 and 6 are 28.3 long.
    assert_eq!(said, expected);
}
