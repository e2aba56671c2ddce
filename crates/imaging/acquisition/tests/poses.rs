//! Other programs' files of poses, as they are. The data are not part of the project; without them the test says so and passes.

#![allow(clippy::unwrap_used)]

use std::path::Path;

use biplane_acquisition::poses::jointtrack;
use biplane_geometry::{Pose, Vector3};

fn real(folder: &str) -> Option<std::path::PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/real").join(folder);
    if path.is_dir() {
        return Some(path);
    }
    println!("skipped: {} is not there", path.display());
    None
}

#[test]
fn jointtracks_own_files_are_read_and_written_alike() {
    let Some(folder) = real("knee-implant-single") else { return };
    let mut files = vec![folder.join("fem.jts"), folder.join("tib.jts")];
    if let Some(kinematics) = real("kinematics") {
        let pattern = kinematics.join("**/*.jt*").to_string_lossy().into_owned();
        files.extend(glob::glob(&pattern).unwrap().map(Result::unwrap));
    }
    let mut frames = 0;
    for path in files {
        let text = std::fs::read_to_string(&path).unwrap();
        let name = path.display().to_string();
        let poses = jointtrack::read(&name, &text, &Pose::identity()).unwrap();
        assert!(poses.len() >= 3 && poses.iter().all(Option::is_some), "{name}");
        let first = poses[0].unwrap().translation();
        assert!(first.z < -500.0, "objects lie at negative z: {first}");
        let written = jointtrack::write(&poses, &Pose::identity(), jointtrack::Kind::Jts);
        let back = jointtrack::read(&name, &written, &Pose::identity()).unwrap();
        for (a, b) in poses.iter().flatten().zip(back.iter().flatten()) {
            assert!((a.translation() - b.translation()).norm() < 1e-6);
            assert!(a.rotation().angle_to(&b.rotation()) < 1e-7);
        }
        frames += poses.len();
    }
    println!("{frames} poses");
}

#[test]
fn a_file_of_the_first_frame_has_the_numbers_that_stand_in_it() {
    let Some(folder) = real("knee-implant-single") else { return };
    let text = std::fs::read_to_string(folder.join("fem.jts")).unwrap();
    let poses = jointtrack::read("fem.jts", &text, &Pose::identity()).unwrap();
    let first = poses[0].unwrap();
    assert!((first.translation() - Vector3::new(18.52191, 19.69514, -1027.713)).norm() < 1e-9);
}
