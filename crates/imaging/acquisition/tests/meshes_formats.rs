//! One solid in every format and encoding, as four other programs write it (see `data/README.md`) and as small files written by hand, and
//! the messages of what is wrong in them.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::path::{Path, PathBuf};

use approx::assert_relative_eq;
use biplane_acquisition::inspect::describe;
use biplane_acquisition::meshes::{LengthUnit, MeshFile, MeshFormat, MeshNote, read_mesh};
use biplane_geometry::Point3;
use tempfile::TempDir;

const MM: Option<LengthUnit> = Some(LengthUnit::Millimetres);

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data")
}

/// The prism of `data/README.md`: its corners.
fn prism() -> Vec<Point3> {
    let corners = [[0.0, 0.0], [60.0, 0.0], [60.0, 15.0], [20.0, 15.0], [20.0, 40.0], [0.0, 40.0]];
    let at = |z: f64| corners.map(|[x, y]| Point3::new(x - 10.125, y + 7.5, z + 100.25));
    [at(0.0), at(20.0)].concat()
}

fn is_prism(name: &str, file: &MeshFile) {
    let mesh = &file.model.0;
    assert_eq!(mesh.topology(), file.topology, "{name}");
    assert_eq!(
        file.topology.open_edges + file.topology.non_manifold_edges + file.topology.inconsistent_edges,
        0,
        "{name}"
    );
    let sorted = |mut points: Vec<Point3>| {
        points.sort_by(|p, q| p.coords.as_slice().partial_cmp(q.coords.as_slice()).unwrap());
        points
    };
    // Every coordinate is a binary fraction, so none is rounded.
    assert_eq!(sorted(mesh.vertices().to_vec()), sorted(prism()), "{name}");
    assert_eq!((mesh.triangles().len(), file.pieces.len()), (20, 1), "{name}");
    assert_relative_eq!(mesh.signed_volume(), 28_000.0, epsilon = 1e-8);
    assert_relative_eq!(file.pieces[0].volume_mm3.unwrap(), 28_000.0, epsilon = 1e-8);
    // Two faces of 1400, and the outline of 200 times 20.
    assert_relative_eq!(mesh.area(), 6_800.0, epsilon = 1e-8);
}

#[test]
fn files_of_other_programs_hold_the_same_solid() {
    let mut seen = Vec::new();
    for entry in std::fs::read_dir(data()).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if name == "README.md" {
            continue;
        }
        let file = read_mesh(&path, None).unwrap();
        is_prism(&name, &file);
        let line = MeshNote::LeftOut { count: 1, what: "lines" };
        let expected: &[MeshNote] = if name.starts_with("vtk_grid") { &[line] } else { &[] };
        assert_eq!(file.notes, expected, "{name}");
        let says = |word: &str| name.contains(word);
        let format = match path.extension().unwrap().to_str().unwrap() {
            "stl" if says("ascii") => MeshFormat::StlAscii,
            "stl" => MeshFormat::StlBinary,
            "ply" if says("ascii") => MeshFormat::PlyAscii,
            "ply" if says("big") => MeshFormat::PlyBigEndian,
            "ply" => MeshFormat::PlyLittleEndian,
            "vtk" if says("ascii") => MeshFormat::VtkAscii,
            "vtk" => MeshFormat::VtkBinary,
            "obj" => MeshFormat::Obj,
            "off" => MeshFormat::Off,
            _ => MeshFormat::Vtp,
        };
        assert_eq!(file.format, format, "{name}");
        // The name does not matter.
        assert!(describe(&path).unwrap().kind.ends_with(format.name()), "{name}");
        seen.push(format.name());
    }
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), 10, "{seen:?}");
}

/// Reads what is written under a name that says nothing.
fn read(bytes: impl AsRef<[u8]>) -> Result<MeshFile, String> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("mesh");
    std::fs::write(&path, bytes).unwrap();
    read_mesh(&path, MM).map_err(|e| e.to_string().replace(&format!("{}/", folder.path().display()), ""))
}

/// A tetrahedron of 6000 mm^3, its outward faces, counted from 0.
const PLACES: [[i32; 3]; 4] = [[0, 0, 0], [30, 0, 0], [0, 40, 0], [0, 0, 30]];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn is_tetrahedron(file: Result<MeshFile, String>) -> MeshFile {
    let file = file.unwrap();
    assert_eq!((file.model.0.vertices().len(), file.model.0.triangles().len()), (4, 4));
    assert_relative_eq!(file.model.0.signed_volume(), 6_000.0, epsilon = 1e-8);
    file
}

fn ply_head(format: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment by hand\nelement vertex 4\nproperty uchar red\nproperty double x\nproperty list uchar short \
         seen_by\nproperty double y\nproperty double z\nelement face 4\nproperty short part\nproperty list ushort int \
         vertex_index\nproperty float quality\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
    )
}

fn ply_binary(big: bool) -> Vec<u8> {
    let mut bytes = ply_head(if big { "binary_big_endian" } else { "binary_little_endian" }).into_bytes();
    let mut put = |little: &[u8]| {
        if big { bytes.extend(little.iter().rev()) } else { bytes.extend(little) }
    };
    for (k, [x, y, z]) in PLACES.iter().enumerate() {
        put(&[200]);
        put(&f64::from(*x).to_le_bytes());
        put(&[k as u8]);
        (0..k).for_each(|i| put(&(i as i16).to_le_bytes()));
        put(&f64::from(*y).to_le_bytes());
        put(&f64::from(*z).to_le_bytes());
    }
    for face in FACES {
        put(&(-7_i16).to_le_bytes());
        put(&3_u16.to_le_bytes());
        face.iter().for_each(|v| put(&(*v as i32).to_le_bytes()));
        put(&0.5_f32.to_le_bytes());
    }
    put(&0_i32.to_le_bytes());
    put(&1_i32.to_le_bytes());
    bytes
}

#[test]
fn ply_with_properties_of_every_kind_in_both_byte_orders() {
    let little = is_tetrahedron(read(ply_binary(false)));
    let big = is_tetrahedron(read(ply_binary(true)));
    assert_eq!(little.model, big.model);
    assert_eq!((little.format, big.format), (MeshFormat::PlyLittleEndian, MeshFormat::PlyBigEndian));
    let mut text = ply_head("ascii");
    for (k, [x, y, z]) in PLACES.iter().enumerate() {
        let list: String = (0..k).map(|i| format!(" {i}")).collect();
        text += &format!("200 {x} {k}{list} {y} {z}\n");
    }
    for [a, b, c] in FACES {
        text += &format!("-7 3 {a} {b} {c} 0.5\n");
    }
    let whole = text + "0 1";
    assert_eq!(is_tetrahedron(read(&whole)).model, little.model);
    assert_eq!(is_tetrahedron(read(whole.replace('\n', "\r\n"))).model, little.model);
    assert_eq!(is_tetrahedron(read(whole.replace('\n', "\r"))).model, little.model);
    // Strips, -1 between them; the second one begins the other way round.
    let strips = "ply\nformat ascii 1.0\nelement vertex 4\nproperty int x\nproperty int y\nproperty int z\nelement tristrips 1\nproperty list \
                  int int vertex_indices\nend_header\n0 0 0\n30 0 0\n0 40 0\n0 0 30\n8 0 1 3 2 -1 0 2 1\n";
    let file = read(strips).unwrap();
    assert_eq!((file.triangles_in_file, file.topology.open_edges), (3, 3));
    assert_eq!(file.topology.inconsistent_edges, 0);
    assert_eq!(file.repairs.rewound, 0, "a strip turns every second triangle");
}

#[test]
fn faults_of_ply_are_named() {
    let whole = ply_binary(false);
    let error = read(&whole[..whole.len() - 3]).unwrap_err();
    assert_eq!(
        error,
        "mesh is cut short: its header says 1 of the element edge (line 14), more than the 5 bytes behind can hold; export it again"
    );
    let error = read(&whole[..whole.len() - 20]).unwrap_err();
    assert_eq!(
        error,
        "mesh is cut short: its header says 4 of the element face, and it ends in number 3 (counted from 0); export it again"
    );
    let head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar \
                int vertex_indices\nend_header\n";
    for (text, expected) in [
        (
            "0 0 0\n9 0 0\n0 9 zero\n3 0 1 2\n",
            "mesh, line 12: expected a number of vertex 2 (counted from 0), found `zero`",
        ),
        (
            "0 0 0\n9 0 0\n0 9 0\n3 0 1 3\n",
            "mesh, line 13: expected indices of the 3 vertices before it, from 0 in face 0 (counted from 0), found `3`",
        ),
        (
            "0 0 0\n9 0 0\n0 9 0\n3 0 1",
            "mesh, line 13: expected a number of face 0 (counted from 0), found the end of the file; it is cut short",
        ),
        (
            "0 0 0\n9 0 0\n0 9 0\n-3 0 1 2\n",
            "mesh, line 13: expected a list's count that the file can hold in face 0 (counted from 0), found `-3`",
        ),
    ] {
        assert_eq!(read(format!("{head}{text}")).unwrap_err(), expected);
    }
    for (from, to, expected) in [
        (
            "format ascii 1.0",
            "format text 1.0",
            "mesh, line 2: expected `format ascii`, `binary_little_endian` or `binary_big_endian`, and `1.0`, found `format text 1.0`",
        ),
        ("format ascii 1.0\n", "", "mesh: its header has no line `format`; export it again"),
        (
            "property float y\n",
            "",
            "mesh, line 3: expected the properties x, y and z, found `an element vertex without one of them`",
        ),
        (
            "property float y",
            "property quad y",
            "mesh, line 5: expected `property TYPE NAME` or `property list TYPE TYPE NAME` (char, uchar, short, ushort, int, uint, float, double) after an `element`, found `property quad y`",
        ),
        (
            "vertex_indices",
            "corners",
            "mesh, line 7: expected `property list ... vertex_indices`, found `an element face without it`",
        ),
        (
            "vertex 3",
            "vertex 4000000000",
            "mesh is cut short: its header says 4000000000 of the element vertex (line 3), more than the 26 bytes behind can hold; export it again",
        ),
        (
            "end_header\n",
            "",
            "mesh, line 9: expected `format`, `comment`, `element`, `property` or `end_header`, found `0 0 0`",
        ),
    ] {
        let text = format!("{head}0 0 0\n9 0 0\n0 9 0\n3 0 1 2\n");
        assert!(text.contains(from));
        assert_eq!(read(text.replacen(from, to, 1)).unwrap_err(), expected);
    }
}

const OBJ: &str = "# by hand\nmtllib a.mtl\no one\nv 0 0 0\nv 30 0 0 1.0\nv 0 40 0 0.5 0.5 0.5\nvt 0 0\nvn 0 0 1\ng sides\nusemtl grey\ns off\n\
                   f 1 3 2 # the first\nf 1/1 2/1 4/1\nf 1//1 4//1 -2//1\nf \\\n2/1/1 3/1/1 \\\n  -1/1/1\nv 0 0 30\nl 1 2\n";

#[test]
fn obj_with_all_its_ways_to_name_a_vertex() {
    // Its last vertex stands behind the faces, so -1 and -2 are vertices 3 and 2, and face 3 names a vertex that comes later.
    let text = OBJ.replace("-2//1", "3//1").replace("-1/1/1", "4/1/1");
    let file = is_tetrahedron(read(&text));
    assert_eq!(file.notes, [MeshNote::LeftOut { count: 1, what: "lines" }]);
    let before = text.replace("v 0 0 30\n", "").replace("vt 0 0\n", "v 0 0 30\nvt 0 0\n");
    assert_eq!(is_tetrahedron(read(&before)).model, file.model);
    let negative = before.replace("f 1 3 2", "f -4 -2 -3").replace("4/1/1", "-1/1/1");
    assert_eq!(is_tetrahedron(read(negative)).model, file.model);
    assert_eq!(is_tetrahedron(read(text.replace('\n', "\r\n"))).model, file.model);
    for (from, to, expected) in [
        ("30 0 0 1.0", "30 x 0", "mesh, line 5: expected `v` and three numbers, found `v 30 x 0`"),
        (
            "f 1 3 2",
            "f 1 3 0",
            "mesh, line 12: expected `f` and vertices counted from 1, or from -1 for the last of the 3 so far, found `f 1 3 0`",
        ),
        (
            "f 1 3 2",
            "f 1 3 -4",
            "mesh, line 12: expected `f` and vertices counted from 1, or from -1 for the last of the 3 so far, found `f 1 3 -4`",
        ),
        ("f 1 3 2", "f 1 3", "mesh, line 12: expected `f` and three vertices or more, found `f 1 3`"),
        (
            "f 1 3 2",
            "f 1 3 5",
            "mesh, line 12: expected a face of the 4 vertices of the file, found `vertex 5`",
        ),
        (
            "usemtl",
            "usematl",
            "mesh, line 10: expected `v`, `f` or another keyword of OBJ, found `usematl grey`",
        ),
    ] {
        assert_eq!(read(text.replacen(from, to, 1)).unwrap_err(), expected);
    }
}

#[test]
fn off_with_its_kinds_of_header() {
    let plain = "OFF\n# by hand\n4 4 6\n0 0 0\n\n30 0 0\n0 40 0\n0 0 30 # the last\n3 0 2 1\n3 0 1 3 255 0 0\n3 0 3 2\n3 1 2 3 0.5 0.5 0.5 1\n";
    let model = is_tetrahedron(read(plain)).model;
    assert_eq!(is_tetrahedron(read(plain.replacen("OFF\n# by hand\n4 4 6", "OFF 4 4 0", 1))).model, model);
    assert_eq!(
        is_tetrahedron(read(plain.replacen("0 0 0\n", "0 0 0 255 0 0 255\n", 1).replacen("OFF", "COFF", 1)))
            .model,
        model
    );
    assert_eq!(
        is_tetrahedron(read(plain.replacen("0 0 0\n", "0 0 0 0 0 -1\n", 1).replacen("OFF", "NOFF", 1))).model,
        model
    );
    for (from, to, expected) in [
        ("OFF", "4OFF", "mesh: its points have other than three coordinates (`4OFF`); export it as `OFF`"),
        ("OFF", "OFF BINARY", "mesh: binary OFF is not read; export it as text, or as PLY"),
        (
            "4 4 6",
            "4 six",
            "mesh, line 3: expected how many vertices, faces and edges there are, found `4 six`",
        ),
        (
            "0 40 0",
            "0 40",
            "mesh, line 7: expected three coordinates of vertex 2 (counted from 0) of 4, found `0 40`",
        ),
        (
            "3 0 3 2",
            "3 0 3 4",
            "mesh, line 11: expected face 2 (counted from 0) of 4: how many corners (at most 2000), and these, each from 0 to 3, found `3 0 3 4`",
        ),
        (
            "3 0 3 2",
            "4 0 3 2",
            "mesh, line 11: expected face 2 (counted from 0) of 4: how many corners (at most 2000), and these, each from 0 to 3, found `4 0 3 2`",
        ),
        (
            "4 4 6",
            "4 5 6",
            "mesh, line 13: expected face 4 (counted from 0) of 5: how many corners (at most 2000), and these, each from 0 to 3, found the end of the file; it is cut short",
        ),
        ("4 4 6", "4000000000 4 6", "mesh, line 9: expected face"),
    ] {
        let error = read(plain.replacen(from, to, 1)).unwrap_err();
        if to.starts_with("4000000000") {
            // Faces are taken for vertices until the file ends.
            assert!(error.contains("of 4000000000, found the end of the file"), "{error}");
        } else {
            assert_eq!(error, expected);
        }
    }
}

const VTK: &str = "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 30 0 0\n0 40 0 0 0 30\nPOLYGONS 4 \
                   16\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\nLINES 1 3\n2 0 1\nPOINT_DATA 4\nSCALARS a float\n";

#[test]
fn vtk_by_hand_and_its_faults() {
    let file = is_tetrahedron(read(VTK));
    assert_eq!(file.notes, [MeshNote::LeftOut { count: 1, what: "lines" }]);
    assert_eq!(is_tetrahedron(read(VTK.replace('\n', "\r\n"))).model, file.model);
    let grid = VTK
        .replace("POLYDATA", "UNSTRUCTURED_GRID")
        .replace("POLYGONS 4 16", "CELLS 5 21")
        .replace("LINES 1 3\n2 0 1\n", "4 0 1 2 3\nCELL_TYPES 5\n5 5 5 5 10\n");
    let file = is_tetrahedron(read(&grid));
    assert_eq!(file.notes, [MeshNote::LeftOut { count: 1, what: "cells of volume" }]);
    for (from, to, expected) in [
        ("ASCII", "TEXT", "mesh, line 3: expected `ASCII` or `BINARY`, found `TEXT`"),
        (
            "POLYDATA",
            "STRUCTURED_GRID",
            "mesh, line 4: expected `DATASET POLYDATA` or `UNSTRUCTURED_GRID`: a surface (in ParaView: Extract Surface), found `DATASET STRUCTURED_GRID`",
        ),
        (
            "POINTS 4 float",
            "POINTS 4 bit",
            "mesh, line 5: expected `POINTS`, a count and a type (float, double, ...), found `POINTS 4 bit`",
        ),
        (
            "0 40 0 0",
            "0 40 O 0",
            "mesh, line 7: expected number 8 (counted from 0) of the 12 of POINTS, found `O`",
        ),
        ("3 0 3 2", "3 0 3 4", "mesh: cell 2 (counted from 0) names point 4; expected 0 to 3, of 4 points"),
        (
            "POLYGONS 4 16",
            "POLYGONS 4 15",
            "mesh: POLYGONS: cell 3 (counted from 0) of 4 claims 3 corners, and 2 numbers are left",
        ),
        ("POLYGONS 4 16", "POLYGONS 3 16", "mesh: POLYGONS: 4 numbers are left after the last of 3 cells"),
        (
            "POLYGONS 4 16",
            "POLYGONS 4 99999999999",
            "mesh, line 13: expected number 16 (counted from 0) of the 99999999999 of POLYGONS, found `LINES`",
        ),
        (
            "POLYGONS 4 16",
            "POLYGON 4 16",
            "mesh, line 8: expected `POINTS`, `POLYGONS`, `TRIANGLE_STRIPS`, `CELLS` or `POINT_DATA`, found `POLYGON 4 16`",
        ),
    ] {
        assert_eq!(read(VTK.replacen(from, to, 1)).unwrap_err(), expected);
    }
    assert_eq!(
        read(grid.replace("5 5 5 5 10", "5 5 5 5 10 5").replace("TYPES 5", "TYPES 6")).unwrap_err(),
        "mesh: it has 5 cells and 6 types of them; export it again"
    );
    assert_eq!(
        read(grid.replace("5 5 5 5 10", "10 10 10 10 10")).unwrap_err(),
        "mesh holds no surface: 0 triangles, none with an area; 5 cells of volume are not read"
    );
    let binary = std::fs::read(data().join("vtk_42_binary_float.vtk")).unwrap();
    let points = binary.windows(6).position(|w| w == b"POINTS").unwrap();
    assert_eq!(
        read(&binary[..points + 60]).unwrap_err(),
        "mesh is cut short: 36 numbers of 4 bytes of POINTS, but 44 bytes are left; export it again"
    );
}

#[test]
fn faults_of_vtp_are_named() {
    let whole = std::fs::read_to_string(data().join("vtp_ascii.vtp")).unwrap();
    for (from, to, expected) in [
        (
            "type=\"PolyData\"",
            "type=\"ImageData\"",
            "mesh: it holds `ImageData`, and of VTK's XML only `PolyData` is read; extract the surface",
        ),
        (
            "type=\"PolyData\"",
            "type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\" was=\"\"",
            "mesh: it is packed with `vtkLZ4DataCompressor`; save it with zlib or not packed",
        ),
        (
            "header_type=\"UInt32\"",
            "header_type=\"UInt16\"",
            "mesh: its counts are `UInt16`; expected UInt32 or UInt64",
        ),
        (
            "NumberOfPoints=\"12\"",
            "NumberOfPoints=\"13\"",
            "mesh, line 23: expected 39 numbers in the array Points, found 36",
        ),
        ("NumberOfPolys=\"8\"", "NumberOfPolys=\"7\"", "expected 7 numbers in the array offsets, found 8"),
        ("</Polys>", "</Poly>", "expected XML, found expected 'Polys' tag"),
    ] {
        let text = whole.replacen("compressor=\"vtkZLibDataCompressor\"", "", 1).replacen(from, to, 1);
        let error = read(&text).unwrap_err();
        assert!(text.contains(to) && error.contains(expected), "{error}");
    }
    let raw = std::fs::read(data().join("vtp_raw.vtp")).unwrap();
    let begin = raw.windows(13).position(|w| w == b"<AppendedData").unwrap();
    let error = read(&raw[..begin + 100]).unwrap_err();
    assert!(error.starts_with("mesh, line ") && error.contains("cut short"), "{error}");
}

#[test]
fn cad_files_and_others_are_refused_with_what_to_do() {
    let folder = TempDir::new().unwrap();
    let message = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let said = describe(&path).unwrap_err().to_string();
        let error = read_mesh(&path, MM)
            .unwrap_err()
            .to_string()
            .replace(&format!("{}/", folder.path().display()), "");
        (error, said)
    };
    let cad = "is a CAD file (STEP or IGES), which is not read; export it from CAD as STL or PLY, in mm, with a chord tolerance of 0.01 mm";
    let iges = format!("{:72}S0000001\n", "tray");
    for (name, bytes) in [
        ("tray.step", "ISO-10303-21;\nHEADER;\n"),
        ("tray", "ISO-10303-21;\nHEADER;\n"),
        ("tray.STP", "anything"),
        ("tray.igs", "anything"),
        ("tray.txt", iges.as_str()),
    ] {
        let (error, said) = message(name, bytes.as_bytes());
        assert_eq!(error, format!("{name} {cad}"));
        assert!(said.ends_with(cad), "{said}");
    }
    let (error, _) = message("tray.3mf", b"PK\x03\x04 and so on");
    assert_eq!(
        error,
        "tray.3mf is none of the meshes that are read: STL, PLY, OBJ, OFF, VTK (legacy) and VTK XML (.vtp)"
    );
    let (error, _) = message("tray.obj", b"");
    assert!(
        error.ends_with(
            "is none of the meshes that are read: STL, PLY, OBJ, OFF, VTK (legacy) and VTK XML (.vtp)"
        ),
        "{error}"
    );
}
