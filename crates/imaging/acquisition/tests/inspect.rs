//! What `describe` says of small files made here, and of what it does not know.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use biplane_acquisition::inspect::describe;
use image::{GrayImage, Luma};
use tempfile::TempDir;

#[test]
fn images_and_folders_of_them_are_described() {
    let folder = TempDir::new().unwrap();
    for n in 1..4 {
        let picture = GrayImage::from_fn(6, 4, |x, _| Luma([10 + x as u8 * 10]));
        picture.save(folder.path().join(format!("{n:03}.png"))).unwrap();
    }
    let text = describe(folder.path().join("001.png")).unwrap().to_string();
    for part in
        ["PNG image", "6 x 4 px (columns x rows)", "10 to 60, mean 35.0; larger is brighter", "not stated"]
    {
        assert!(text.contains(part), "{part} not in: {text}");
    }
    let text = describe(folder.path()).unwrap().to_string();
    for part in ["folder of images", "001, 003", "6 x 4 px"] {
        assert!(text.contains(part), "{part} not in: {text}");
    }
}

#[test]
fn a_mesh_in_metres_is_described_with_the_unit_it_seems_to_have() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.stl");
    // A tetrahedron with legs of 0.05.
    let mut text = "solid x\n".to_owned();
    let v = ["0 0 0", "0.05 0 0", "0 0.05 0", "0 0 0.05"];
    for t in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        text += "facet normal 0 0 0\nouter loop\n";
        for c in t {
            text += &format!("vertex {}\n", v[c]);
        }
        text += "endloop\nendfacet\n";
    }
    std::fs::write(&path, text + "endsolid x\n").unwrap();
    let text = describe(&path).unwrap().to_string();
    for part in [
        "mesh, ascii STL",
        "0.0500 x 0.0500 x 0.0500 in the file's unit",
        "0.0500 x 0.0500 x 0.0500 mm: too small for a bone or implant",
        "50.0 x 50.0 x 50.0 mm: a bone or implant may be that",
        "not mm: set units = \"m\" in its [[body]]",
        "closed, wound outward, one piece",
        // In mm, as it is in metres: 50^3 / 6.
        "volume         20833 mm^3",
    ] {
        assert!(text.contains(part), "{part} not in: {text}");
    }
}

#[test]
fn distortion_samples_are_described() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("d.csv");
    let mut text = "distorted_x_px,distorted_y_px,ideal_x_px,ideal_y_px\n".to_owned();
    for i in 0..16 {
        let (x, y) = (10 * (i % 4), 20 * (i / 4));
        text += &format!("{x},{y},{},{}\n", x + 3, y + 4);
    }
    std::fs::write(&path, text).unwrap();
    let text = describe(&path).unwrap().to_string();
    for part in ["4 x 4 samples every 10.000 x 20.000 px", "(0, 0) to (30, 60) px", "5.00 px"] {
        assert!(text.contains(part), "{part} not in: {text}");
    }
}

#[test]
fn what_is_not_known_and_what_is_broken_is_said() {
    let folder = TempDir::new().unwrap();
    let message = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        describe(&path).unwrap_err().to_string()
    };
    let text = message("notes.txt", b"hello");
    assert!(text.contains("notes.txt is none of the files this program reads: images (PNG"), "{text}");
    assert!(message("zeros", &[0; 300]).contains("none of the files"));
    assert!(message("random", &[0xc3; 300]).contains("none of the files"));
    assert!(message("empty", b"").contains("none of the files"));
    let text = message("cam.txt", b"image size\n1024\n");
    assert!(text.contains("cam.txt, line 2: expected two numbers"), "{text}");
    let mut cut = vec![b' '; 80];
    cut.extend(1000_u32.to_le_bytes());
    cut.extend([0; 500]);
    cut[3] = 0xff;
    let text = message("cut.stl", &cut);
    assert!(text.contains("claims 1000 triangles"), "{text}");
    let text = describe(folder.path().join("gone")).unwrap_err().to_string();
    assert!(text.contains("cannot read") && text.contains("gone"), "{text}");
}
