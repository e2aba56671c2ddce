//! Meshes written here: units, encodings, winding, and every broken one with its message.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::fmt::Write as _;
use std::path::PathBuf;

use approx::assert_relative_eq;
use biplane_acquisition::meshes::{LengthUnit, MeshFormat, MeshNote, read_mesh};
use tempfile::TempDir;

type Triangle = [[f64; 3]; 3];

/// A box with one corner at the origin, wound outward.
fn cuboid(size: [f64; 3]) -> Vec<Triangle> {
    let v = |i: usize| {
        [size[0] * (i & 1) as f64, size[1] * ((i >> 1) & 1) as f64, size[2] * ((i >> 2) & 1) as f64]
    };
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        .iter()
        .flat_map(|q| [[v(q[0]), v(q[1]), v(q[2])], [v(q[0]), v(q[2]), v(q[3])]])
        .collect()
}

fn reversed(mut triangles: Vec<Triangle>) -> Vec<Triangle> {
    triangles.iter_mut().for_each(|t| t.swap(1, 2));
    triangles
}

fn binary(header: &str, triangles: &[Triangle]) -> Vec<u8> {
    let mut bytes = header.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for t in triangles {
        bytes.extend([0; 12]);
        bytes.extend(t.iter().flatten().flat_map(|c| (*c as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn ascii(name: &str, triangles: &[Triangle]) -> String {
    let mut text = format!("solid {name}\n");
    for t in triangles {
        text += "  facet normal 0 0 0\n    outer loop\n";
        for c in t {
            writeln!(text, "      vertex {:e} {:e} {:e}", c[0], c[1], c[2]).unwrap();
        }
        text += "    endloop\n  endfacet\n";
    }
    text + &format!("endsolid {name}\n")
}

fn write(folder: &TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

const MM: Option<LengthUnit> = Some(LengthUnit::Millimetres);
const METRES: Option<LengthUnit> = Some(LengthUnit::Metres);

#[test]
fn ascii_and_binary_hold_the_same_mesh() {
    let folder = TempDir::new().unwrap();
    let soup = cuboid([20.0, 30.0, 40.0]);
    let a = read_mesh(write(&folder, "a.stl", ascii("box", &soup).as_bytes()), MM).unwrap();
    // A binary file that starts with `solid`, and even with the word `facet`.
    let b =
        read_mesh(write(&folder, "b.stl", &binary("solid facet exported by a program", &soup)), MM).unwrap();
    assert_eq!((a.format, b.format), (MeshFormat::StlAscii, MeshFormat::StlBinary));
    assert_eq!(a.model, b.model);
    assert_eq!((a.notes.as_slice(), a.triangles_in_file), (&[][..], 12));
    assert_eq!(a.model.0.vertices().len(), 8);
    assert_relative_eq!(a.model.0.signed_volume(), 24000.0, epsilon = 1e-6);
    let shouting = ascii("box", &soup).to_uppercase().replace('\n', "\r\n\r\n");
    assert_eq!(read_mesh(write(&folder, "c.stl", shouting.as_bytes()), MM).unwrap().model, a.model);
}

#[test]
fn several_solids_of_one_file_are_all_read() {
    let folder = TempDir::new().unwrap();
    let shifted: Vec<Triangle> =
        cuboid([20.0; 3]).into_iter().map(|t| t.map(|c| [c[0] + 50.0, c[1], c[2]])).collect();
    let text = ascii("one", &cuboid([20.0; 3])) + &ascii("two", &shifted);
    let mesh = read_mesh(write(&folder, "a.stl", text.as_bytes()), MM).unwrap();
    assert_eq!(mesh.triangles_in_file, 24);
    assert_eq!(mesh.notes, vec![MeshNote::Bodies { count: 2 }]);
    assert_eq!(mesh.notes[0].to_string(), "2 pieces that do not touch");
}

#[test]
fn a_mesh_inside_out_is_turned_if_it_is_closed_or_nearly_so() {
    let folder = TempDir::new().unwrap();
    let soup = reversed(cuboid([20.0, 30.0, 40.0]));
    let mesh = read_mesh(write(&folder, "a.stl", &binary("", &soup)), MM).unwrap();
    assert_eq!(mesh.notes, vec![MeshNote::Inverted { count: 1, of: 1 }]);
    assert_eq!(mesh.notes[0].to_string(), "wound inside out; turned round");
    assert_relative_eq!(mesh.model.0.signed_volume(), 24000.0, epsilon = 1e-6);

    // Half a face of six is missing, the triangle (0, 0, 40), (0, 30, 40), ... of the plane y = 0: its winding is still told.
    let open = &soup[..11];
    let mesh = read_mesh(write(&folder, "b.stl", &binary("", open)), MM).unwrap();
    let [MeshNote::OpenInverted { count: 1 }, MeshNote::Open { edges: 3, rims: 1, longest_mm, .. }] =
        mesh.notes[..]
    else {
        panic!("{:?}", mesh.notes);
    };
    assert_relative_eq!(longest_mm, 30.0 + 40.0 + 50.0, epsilon = 1e-9);
    assert!(mesh.model.0.signed_volume() > 0.0);
    assert_eq!(mesh.pieces[0].volume_mm3, None);

    // Of three faces that meet at a corner it is not.
    let half: Vec<Triangle> = [0, 1, 4, 5, 8, 9].map(|t| soup[t]).to_vec();
    let mesh = read_mesh(write(&folder, "c.stl", &binary("", &half)), MM).unwrap();
    assert!(matches!(
        mesh.notes[..],
        [MeshNote::Open { edges: 6, rims: 1, .. }, MeshNote::WindingUnknown { count: 1 }]
    ));
    assert!(mesh.notes[1].to_string().contains("cannot be told of an open mesh"));
    assert_eq!(mesh.topology.inconsistent_edges, 0);
    let area = |m: &biplane_geometry::Mesh| {
        (0..m.triangles().len()).map(|t| m.area_vector(t)).sum::<biplane_geometry::Vector3>()
    };
    let given = area(
        &biplane_geometry::Mesh::from_soup(
            &half.iter().map(|t| t.map(biplane_geometry::Point3::from)).collect::<Vec<_>>(),
        )
        .unwrap(),
    );
    assert_relative_eq!(area(&mesh.model.0), given, epsilon = 1e-9);
}

#[test]
fn faults_of_the_surface_are_counted() {
    let folder = TempDir::new().unwrap();
    let mut soup = cuboid([20.0; 3]);
    soup[0].swap(1, 2);
    soup.push([[0.0; 3], [0.0; 3], [20.0, 0.0, 0.0]]);
    let mesh = read_mesh(write(&folder, "a.stl", &binary("", &soup)), MM).unwrap();
    assert_eq!(mesh.notes, vec![MeshNote::Rewound { triangles: 1 }, MeshNote::Degenerate { triangles: 1 }]);
    assert_eq!(mesh.topology.inconsistent_edges, 0);
    assert_relative_eq!(mesh.model.0.signed_volume(), 8000.0, epsilon = 1e-9);
    let mut soup = cuboid([20.0; 3]);
    soup.push([[0.0; 3], [20.0, 0.0, 0.0], [0.0, -9.0, -9.0]]);
    let mut bytes = binary("", &soup);
    bytes.extend([0; 7]);
    let mesh = read_mesh(write(&folder, "b.stl", &bytes), MM).unwrap();
    let seam = MeshNote::NonManifold { edges: 1, centre_mm: [10.0, 0.0, 0.0] };
    assert!(mesh.notes.contains(&seam), "{:?}", mesh.notes);
    assert!(mesh.notes.contains(&MeshNote::TrailingBytes { bytes: 7 }), "{:?}", mesh.notes);
}

#[test]
fn a_mesh_in_metres_is_refused_with_the_unit_to_set() {
    let folder = TempDir::new().unwrap();
    let path = write(&folder, "femur.stl", &binary("", &cuboid([0.048, 0.049, 0.048])));
    let error = read_mesh(&path, MM).unwrap_err().to_string();
    assert!(error.contains("femur.stl would be 0.084 mm across with units = \"mm\""), "{error}");
    assert!(error.contains("set units = \"m\" if the file is in m (84 mm)"), "{error}");
    let mesh = read_mesh(&path, METRES).unwrap();
    let (low, high) = mesh.model.0.bounding_box();
    assert_relative_eq!((high - low).norm(), 83.72, epsilon = 0.01);
    // And the other way round.
    let path = write(&folder, "tibia.stl", &binary("", &cuboid([48.0; 3])));
    let error = read_mesh(&path, METRES).unwrap_err().to_string();
    assert!(error.contains("83138 mm across with units = \"m\""), "{error}");
    assert!(error.contains("set units = \"mm\""), "{error}");
    // Nothing helps.
    let path = write(&folder, "dust.stl", &binary("", &cuboid([1e-9; 3])));
    let error = read_mesh(&path, MM).unwrap_err().to_string();
    assert!(!error.contains("set units"), "{error}");
    assert_relative_eq!(LengthUnit::Inches.millimetres(), 25.4);
}

#[test]
fn empty_and_nan_meshes_are_refused() {
    let folder = TempDir::new().unwrap();
    for (name, bytes) in [("a.stl", binary("", &[])), ("b.stl", ascii("nothing", &[]).into_bytes())] {
        let error = read_mesh(write(&folder, name, &bytes), MM).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains("holds no surface: 0 triangles"), "{error}");
    }
    let flat = [[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]];
    let error = read_mesh(write(&folder, "line.stl", &binary("", &flat)), MM).unwrap_err().to_string();
    assert!(error.contains("1 triangles, none with an area"), "{error}");
    let error = read_mesh(write(&folder, "no.stl", b""), MM).unwrap_err().to_string();
    assert!(error.contains("no.stl is not an STL mesh: it has 0 bytes"), "{error}");

    let mut soup = cuboid([20.0; 3]);
    soup[7][1][2] = f64::NAN;
    for (name, bytes) in [("c.stl", binary("", &soup)), ("d.stl", ascii("x", &soup).into_bytes())] {
        let error = read_mesh(write(&folder, name, &bytes), MM).unwrap_err().to_string();
        assert!(error.contains("triangle 7 (counted from 0)") && error.contains("NaN"), "{error}");
    }
}

#[test]
fn files_cut_short_and_other_files_are_named() {
    let folder = TempDir::new().unwrap();
    let bytes = binary("", &cuboid([20.0; 3]));
    let error = read_mesh(write(&folder, "a.stl", &bytes[..400]), MM).unwrap_err().to_string();
    assert!(error.contains("claims 12 triangles, which take 684 bytes, but it has 400"), "{error}");
    let text = ascii("box", &cuboid([20.0; 3]));
    let error = read_mesh(write(&folder, "b.stl", &text.as_bytes()[..300]), MM).unwrap_err().to_string();
    assert!(error.contains("b.stl, line ") && error.contains("expected"), "{error}");
    let cut = text.trim_end().rsplit_once('\n').unwrap().0;
    let error = read_mesh(write(&folder, "c.stl", cut.as_bytes()), MM).unwrap_err().to_string();
    assert!(error.contains("expected `endsolid`, found the end of the file"), "{error}");
    let broken = text.replacen("vertex", "vertx", 1);
    let error = read_mesh(write(&folder, "d.stl", broken.as_bytes()), MM).unwrap_err().to_string();
    assert!(error.contains("d.stl, line 4: expected `outer loop`, `vertex`"), "{error}");
    let error = read_mesh(write(&folder, "e.stl", &[b'x'; 500]), MM).unwrap_err().to_string();
    assert!(error.contains("is not an STL mesh"), "{error}");
    // A claim of four billion triangles takes no memory for them.
    let mut bytes = binary("", &cuboid([20.0; 3]));
    bytes[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let error = read_mesh(write(&folder, "f.stl", &bytes), MM).unwrap_err().to_string();
    assert!(error.contains("claims 4294967295 triangles"), "{error}");
}

#[test]
fn no_damage_makes_the_reader_panic() {
    let folder = TempDir::new().unwrap();
    let originals = [binary("solid", &cuboid([20.0; 3])), ascii("x", &cuboid([20.0; 3])).into_bytes()];
    for original in &originals {
        for cut in (0..original.len()).step_by(5) {
            let _ = read_mesh(write(&folder, "x.stl", &original[..cut]), MM);
        }
        for at in (0..original.len()).step_by(3) {
            let mut bytes = original.clone();
            bytes[at] ^= 0xff;
            let _ = read_mesh(write(&folder, "x.stl", &bytes), MM);
        }
    }
}
