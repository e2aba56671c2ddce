//! Meshes of real bodies, and those of the example studies: what each is, and that it goes through. Skipped, with a message, where the
//! folder is not there.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::path::{Path, PathBuf};

use biplane_acquisition::inspect::describe;
use biplane_acquisition::meshes::{LengthUnit, MeshFile, MeshNote, read_mesh};
use biplane_geometry::Mesh;
use tempfile::TempDir;

fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(3).unwrap()
}

/// A folder of the data beside the workspace, if it is there.
fn real(folder: &str) -> Option<PathBuf> {
    let path = workspace().parent()?.join("shared/data/real").join(folder);
    if path.is_dir() {
        return Some(path);
    }
    println!("skipped: {folder} is not there");
    None
}

const MM: LengthUnit = LengthUnit::Millimetres;
const METRES: LengthUnit = LengthUnit::Metres;

/// What trimesh 5.2.0 says of a file after welding equal vertices: triangles in the file, vertices, closed or not, and the volume and
/// area, mm.
type Said = (&'static str, LengthUnit, usize, usize, bool, f64, f64);

const IMPLANTS_IN_METRES: [Said; 5] = [
    ("femoral-component-decimated.stl", METRES, 24_442, 12_223, true, 38_087.331, 15_962.129),
    ("femur.stl", METRES, 29_590, 14_797, true, 543_445.69, 64_159.329),
    ("patella.stl", METRES, 8_662, 4_333, true, 17_993.015, 4_425.309),
    ("tibial-insert-decimated.stl", METRES, 52_918, 26_459, true, 24_796.159, 8_529.352),
    // It finds 32,196 vertices and no closed mesh, because it keeps two triangles without area, and welds one vertex more.
    ("tibial-tray-decimated.stl", METRES, 64_388, 32_197, true, 45_828.185, 21_808.495),
];
const BIPLANE: [Said; 2] = [
    ("femur0.stl", MM, 73_119, 36_566, false, 41_388.249, 19_663.471),
    ("tibia0.stl", MM, 28_110, 14_057, true, 18_020.685, 10_487.052),
];
/// Inside out: it says -13,979.75 and -31,510.50.
const SINGLE: [Said; 2] = [
    ("KR_right_6_tib.stl", MM, 15_000, 7_502, true, 13_979.749, 10_274.145),
    ("KR_right_7_fem.stl", MM, 12_412, 6_208, true, 31_510.496, 13_435.566),
];

fn checked(folder: &str, said: &[Said]) -> Vec<MeshFile> {
    let Some(folder) = real(folder) else { return Vec::new() };
    let read = |(name, unit, triangles, vertices, closed, volume, area): &Said| {
        let file = read_mesh(folder.join(name), Some(*unit)).unwrap();
        assert_eq!(
            (file.triangles_in_file, file.model.0.vertices().len()),
            (*triangles, *vertices),
            "{name}"
        );
        assert_eq!(file.topology.inconsistent_edges, 0, "{name}");
        assert_eq!(file.rims.is_empty(), *closed, "{name}: {:?}", file.rims);
        let near = |found: f64, expected: f64| {
            assert!((found / expected - 1.0).abs() < 1e-6, "{name}: {found} for {expected}");
        };
        near(file.model.0.area(), *area);
        near(file.pieces.iter().map(|p| p.area_mm2).sum(), *area);
        if *closed {
            near(file.pieces.iter().map(|p| p.volume_mm3.unwrap()).sum(), *volume);
        } else {
            // Of a mesh that is nearly closed: so near that another middle does not matter.
            assert!((file.model.0.signed_volume() / volume - 1.0).abs() < 1e-3, "{name}");
        }
        // What geometry counts by another algorithm.
        assert_eq!(file.topology, file.model.0.topology(), "{name}");
        println!("{}\n", describe(folder.join(name)).unwrap());
        file
    };
    said.iter().map(read).collect()
}

#[test]
fn implants_in_metres_go_through_once_their_unit_is_said() {
    let files = checked("implant-meshes", &IMPLANTS_IN_METRES);
    if let [.., tray] = &files[..] {
        assert_eq!((tray.pieces.len(), tray.repairs.degenerate, tray.rims.len()), (2, 2, 0));
        assert!(tray.notes.contains(&MeshNote::Bodies { count: 2 }));
    }
    let Some(folder) = real("implant-meshes") else { return };
    for (name, ..) in IMPLANTS_IN_METRES {
        let question = read_mesh(folder.join(name), None).unwrap_err().to_string();
        assert!(
            question.contains("mm if it is in m; if so, add `units = \"m\"` to its [[body]]"),
            "{question}"
        );
    }
    let question = read_mesh(folder.join("tibial-tray-decimated.stl"), None).unwrap_err().to_string();
    assert!(
        question.contains("0.0530 x 0.111 x 0.0795 units are 53.0 x 111 x 79.5 mm if it is in m"),
        "{question}"
    );
}

#[test]
fn a_knee_in_centimetres_or_inches_ends_in_a_question() {
    let Some(folder) = real("implant-meshes") else { return };
    let femur = read_mesh(folder.join("femoral-component-decimated.stl"), Some(METRES)).unwrap().model.0;
    let temporary = TempDir::new().unwrap();
    let path = temporary.path().join("femur.stl");
    let asked = |per_unit: f64| {
        std::fs::write(&path, stl(&femur.clone().scaled(1.0 / per_unit))).unwrap();
        read_mesh(&path, None)
    };
    // 8 in cm: a knee in cm, or a large one in inches.
    let question = asked(10.0).unwrap_err().to_string();
    assert!(question.ends_with("add `units = \"cm\"` or `units = \"in\"` to its [[body]]"), "{question}");
    assert!(
        question.contains("66.4 x 55.6 x 75.1 mm if it is in cm, 169 x 141 x 191 mm if it is in in"),
        "{question}"
    );
    let question = asked(25.4).unwrap_err().to_string();
    assert!(question.ends_with("add `units = \"cm\"` or `units = \"in\"` to its [[body]]"), "{question}");
    assert_eq!(asked(1.0).unwrap().unit, LengthUnit::Millimetres);
}

fn stl(mesh: &Mesh) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend((mesh.triangles().len() as u32).to_le_bytes());
    for t in 0..mesh.triangles().len() {
        bytes.extend([0; 12]);
        bytes.extend(
            mesh.corners(t).iter().flat_map(|c| [c.x, c.y, c.z]).flat_map(|c| (c as f32).to_le_bytes()),
        );
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn both_implant_sets_of_knees_go_through() {
    let files = checked("knee-implant-biplane", &BIPLANE);
    if let [femur, _] = &files[..] {
        // Counted by trimesh too: 15 edges of one triangle.
        assert_eq!((femur.rims.len(), femur.rims[0].edges, femur.seams.len()), (1, 15, 0));
        assert!(!femur.notes.iter().any(|n| matches!(n, MeshNote::WindingUnknown { .. })));
    }
    for file in checked("knee-implant-single", &SINGLE) {
        assert_eq!(file.notes, [MeshNote::Inverted { count: 1, of: 1 }]);
    }
}

#[test]
fn the_tibia_of_another_program_goes_through() {
    let Some(folder) = real("knee-mri") else { return };
    let path = folder.join("tibia_mesh.vtk");
    let file = read_mesh(&path, None).unwrap();
    println!("{}\n", describe(&path).unwrap());
    // Its header says 10,000 points and 19,992 offsets, one more than polygons. Two points are of no triangle (counted by VTK 9.7.2).
    assert_eq!((file.triangles_in_file, file.model.0.vertices().len()), (19_991, 9_998));
    assert_eq!(file.repairs.unused_vertices, 2);
    // One triangle stands on an edge that has two others.
    assert_eq!((file.rims.len(), file.rims[0].edges), (1, 2));
    assert_eq!((file.seams.len(), file.seams[0].edges), (1, 1));
    assert_eq!(file.topology, file.model.0.topology());
    assert!(file.model.0.signed_volume() > 0.0);
}

#[test]
fn meshes_of_the_examples_are_closed_and_taken_as_millimetres() {
    let fixtures = workspace().join("fixtures");
    let mut count = 0;
    for folder in ["knee/models", "knee-natural/models", "scene"] {
        for entry in std::fs::read_dir(fixtures.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|e| e != "stl") {
                continue;
            }
            let file = read_mesh(&path, None).unwrap();
            assert!(file.notes.is_empty(), "{}: {:?}", path.display(), file.notes);
            assert_eq!(file.topology, file.model.0.topology());
            count += 1;
        }
    }
    assert!(count >= 10, "{count}");
}
