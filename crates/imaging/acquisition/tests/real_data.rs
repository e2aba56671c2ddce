//! Files of real laboratories (see each folder's licence). Skipped, with a message, where the folder is not there.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::path::{Path, PathBuf};

use biplane_acquisition::calibration::{read_calibration, read_distortion_csv, read_plane_json};
use biplane_acquisition::frames::{PairBy, list_frames, pair};
use biplane_acquisition::images::{ImageFile, ImageFormat, read_frame};
use biplane_acquisition::inspect::describe;
use biplane_acquisition::meshes::{LengthUnit, MeshFormat, MeshNote, read_mesh};
use biplane_artifact::{Calibration, PixelOrigin};
use biplane_geometry::Pose;
use nalgebra::{Matrix3, Matrix4, Vector3};

/// A folder of the data beside the workspace, if it is there.
fn data(folder: &str) -> Option<PathBuf> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(3)?;
    let path = workspace.parent()?.join("shared/data").join(folder);
    if path.is_dir() {
        return Some(path);
    }
    println!("skipped: {folder} is not there");
    None
}

fn project(c: &Calibration, point: Vector3<f64>) -> [f64; 3] {
    let m = Matrix3::from_fn(|i, j| c.matrix[i][j]);
    let p = m * (point - Vector3::from(c.source));
    [p.x / p.z, p.y / p.z, p.z]
}

#[test]
fn the_implant_sequence_pairs_and_the_femur_lands_on_its_dark_shadow() {
    let Some(folder) = data("real/knee-implant-biplane") else { return };
    let views: Vec<_> =
        ["cam1", "cam2"].map(|v| (v.to_owned(), list_frames(&folder, v).unwrap())).into_iter().collect();
    let pairing = pair(&views, PairBy::Number, 0).unwrap();
    // The data's README: 20 synchronised pairs of 1024 x 1024, 8 bits.
    assert_eq!((pairing.pairs.len(), pairing.unpaired.len()), (20, 0));
    assert_eq!((pairing.pairs[0].label.as_str(), pairing.pairs[19].label.as_str()), ("000", "100"));

    let femur = read_mesh(folder.join("femur0.stl"), Some(LengthUnit::Millimetres)).unwrap();
    assert_eq!((femur.format, femur.triangles_in_file), (MeshFormat::StlBinary, 73_119));
    assert!(
        femur.notes.iter().any(|n| matches!(n, MeshNote::Open { .. })),
        "not watertight: {:?}",
        femur.notes
    );
    let tibia = read_mesh(folder.join("tibia0.stl"), Some(LengthUnit::Millimetres)).unwrap();
    assert_eq!(tibia.triangles_in_file, 28_110);
    assert_eq!(tibia.topology.open_edges, 0, "watertight: {:?}", tibia.notes);
    assert!(tibia.model.0.signed_volume() > 0.0);

    let text = std::fs::read_to_string(folder.join("reference_femur_world_from_model.csv")).unwrap();
    let row = text.lines().nth(1).unwrap();
    let values: Vec<f64> = row.split(',').skip(1).map(|v| v.parse().unwrap()).collect();
    let pose = Pose::from_matrix(&Matrix4::from_row_slice(&values)).unwrap();
    let mut directions = Vec::new();
    for (i, (view, _)) in views.iter().enumerate() {
        let path = folder.join(format!("{view}.mayacam2.txt"));
        let calibration = read_calibration(&path, view, PixelOrigin::Centre).unwrap();
        let source = &pairing.pairs[0].sources[i];
        let frame = read_frame(&source.path, source.index_in_file).unwrap();
        assert_eq!([frame.width, frame.height], calibration.size);
        assert_eq!((frame.width, frame.bits), (1024, 8));
        let vertices = femur.model.0.vertices();
        let mut inside = 0;
        let mut darkness = Vec::new();
        for vertex in vertices {
            let [x, y, depth] = project(&calibration, pose.transform(vertex).coords);
            assert!(depth > 500.0 && depth < 2500.0, "{depth} mm");
            if x >= 0.0 && y >= 0.0 && x < 1023.0 && y < 1023.0 {
                inside += 1;
                darkness.push(f64::from(frame.samples[y.round() as usize * 1024 + x.round() as usize]));
            }
        }
        assert!(
            inside * 10 > vertices.len() * 9,
            "{view}: {inside} of {} vertices in the picture",
            vertices.len()
        );
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
        let all: Vec<f64> = frame.samples.iter().map(|&s| f64::from(s)).collect();
        assert!(
            mean(&darkness) < 0.6 * mean(&all),
            "{view}: metal {} against {}",
            mean(&darkness),
            mean(&all)
        );
        directions.push(Vector3::from(calibration.matrix[2]));
        let said = describe(&path).unwrap().to_string();
        assert!(
            said.contains("MayaCam 2.0")
                && said.contains("1024 x 1024 px")
                && said.contains("`pixel_origin`")
        );
        println!("{said}");
    }
    // The README: the views are 70.3 degrees apart.
    let angle = directions[0].angle(&directions[1]).to_degrees();
    assert!((angle - 70.3).abs() < 0.06, "{angle}");
}

#[test]
fn lzw_tiffs_of_the_natural_knee_are_read() {
    let Some(folder) = data("real/knee-natural-biplane") else { return };
    let views: Vec<_> =
        ["cam1", "cam2"].map(|v| (v.to_owned(), list_frames(&folder, v).unwrap())).into_iter().collect();
    let pairing = pair(&views, PairBy::Number, 0).unwrap();
    assert_eq!(pairing.pairs.iter().map(|p| p.label.as_str()).collect::<Vec<_>>(), ["0138", "0180"]);
    let frame = read_frame(&pairing.pairs[1].sources[1].path, 0).unwrap();
    assert_eq!((frame.width, frame.height, frame.bits), (1760, 1760, 8));
    assert!(frame.samples.iter().max() > frame.samples.iter().min());
    let calibration = read_calibration(folder.join("cam2.mayacam2.txt"), "B", PixelOrigin::Corner).unwrap();
    assert_eq!(calibration.size, [1760, 1760]);
}

#[test]
fn the_single_plane_knee_has_big_endian_tiffs_and_ascii_meshes_inside_out() {
    let Some(folder) = data("real/knee-implant-single") else { return };
    let frames = list_frames(&folder, "*.tif").unwrap();
    assert_eq!(frames.iter().map(|f| f.number.unwrap()).collect::<Vec<_>>(), [160, 170, 180]);
    let frame = read_frame(&frames[0].path, 0).unwrap();
    assert_eq!((frame.width, frame.height, frame.bits), (1024, 1024, 8));
    for name in ["KR_right_6_tib.stl", "KR_right_7_fem.stl"] {
        let mesh = read_mesh(folder.join(name), Some(LengthUnit::Millimetres)).unwrap();
        assert_eq!(mesh.format, MeshFormat::StlAscii);
        // The README: watertight, wound inside out.
        assert!(mesh.notes.contains(&MeshNote::Inverted { count: 1, of: 1 }), "{name}: {:?}", mesh.notes);
        assert_eq!(mesh.topology.open_edges, 0, "{name}");
        assert!(mesh.model.0.signed_volume() > 0.0);
    }
    let error =
        read_calibration(folder.join("calibration.txt"), "A", PixelOrigin::Centre).unwrap_err().to_string();
    assert!(error.contains("JointTrack"), "{error}");
}

#[test]
fn an_mri_slice_of_explicit_big_endian_is_read() {
    let Some(folder) = data("real/knee-mri/dicom") else { return };
    let slices = list_frames(&folder, "").unwrap();
    assert_eq!(slices.len(), 24);
    let path = folder.join("E3655S8I114.MR.dcm");
    let mut file = ImageFile::open(&path).unwrap();
    assert_eq!(file.info().format, ImageFormat::Dicom);
    let frame = file.frame(0).unwrap();
    assert_eq!((frame.width, frame.height), (256, 256));
    // Neighbouring pixels of a picture are alike; those of one read in the wrong byte order are not.
    let rough = |samples: &[u16]| {
        let steps: f64 = samples.windows(2).map(|w| f64::from(w[0].abs_diff(w[1]))).sum();
        let mean = samples.iter().map(|&s| f64::from(s)).sum::<f64>() / samples.len() as f64;
        steps / samples.len() as f64 / mean
    };
    let swapped: Vec<u16> = frame.samples.iter().map(|s| s.swap_bytes()).collect();
    assert!(
        rough(&frame.samples) < 0.5 && rough(&swapped) > 0.5,
        "{} {}",
        rough(&frame.samples),
        rough(&swapped)
    );
}

#[test]
fn meshes_in_metres_are_refused_and_read_with_their_unit() {
    let Some(folder) = data("real/implant-meshes") else { return };
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "stl") {
            continue;
        }
        let error = read_mesh(&path, Some(LengthUnit::Millimetres)).unwrap_err().to_string();
        assert!(error.contains("set units = \"m\""), "{error}");
        let mesh = read_mesh(&path, Some(LengthUnit::Metres)).unwrap();
        let (low, high) = mesh.model.0.bounding_box();
        assert!((20.0..600.0).contains(&(high - low).norm()), "{path:?}");
        println!("{}", describe(&path).unwrap());
    }
    // The README: 64,388 triangles, two bodies, open; 24,442 and 52,918 watertight. What makes the tray open are two
    // triangles with two equal corners each; without them every edge has two triangles (counted by another program).
    let tray = read_mesh(folder.join("tibial-tray-decimated.stl"), Some(LengthUnit::Metres)).unwrap();
    assert_eq!(tray.triangles_in_file, 64_388);
    assert!(tray.notes.contains(&MeshNote::Bodies { count: 2 }), "{:?}", tray.notes);
    assert!(tray.notes.contains(&MeshNote::Degenerate { triangles: 2 }), "{:?}", tray.notes);
    assert_eq!(tray.topology.open_edges, 0);
    for (name, triangles) in
        [("femoral-component-decimated.stl", 24_442), ("tibial-insert-decimated.stl", 52_918)]
    {
        let mesh = read_mesh(folder.join(name), Some(LengthUnit::Metres)).unwrap();
        assert_eq!((mesh.triangles_in_file, mesh.topology.open_edges), (triangles, 0), "{name}");
    }
}

#[test]
fn the_simulated_study_is_read() {
    let Some(folder) = data("simulated/knee-implant") else { return };
    let truth = folder.join("truth/truth.json");
    println!("{}", describe(&truth).unwrap());
    for view in ["A", "B"] {
        let calibration = read_plane_json(&truth, view).unwrap();
        assert_eq!(calibration.size, [1024, 1024]);
        // truth.json: `centre` and `l` of each view.
        let (centre, l) = if view == "A" {
            ([-11.705301374249581, 486.46260620579295, 5.2867420500296305], 1017.6892251211759)
        } else {
            ([-467.0809376707959, 5.60369064493868, -13.460030505089694], 988.643767318124)
        };
        let normal = Vector3::from(calibration.matrix[2]);
        assert!((normal.norm() - 1.0).abs() < 1e-9);
        let table = read_distortion_csv(folder.join(format!("truth/distortion_{view}.csv"))).unwrap();
        assert_eq!((table.first_px, table.step_px, table.count), ([40.0; 2], [24.0; 2], [40; 2]));
        assert_eq!(table.ideal_px[1], if view == "A" { [85.245, 51.0825] } else { table.ideal_px[1] });
        let [x, y, depth] = project(&calibration, Vector3::from(centre));
        assert!((x - 511.5).abs() + (y - 511.5).abs() + (depth - l).abs() < 1e-6);
    }
    let frames = list_frames(&folder, "frames/A").unwrap();
    assert_eq!((frames.len(), frames[11].label.as_str()), (12, "0011"));
}
