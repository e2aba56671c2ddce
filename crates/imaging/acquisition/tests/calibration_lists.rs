//! Lists of plates and bead frames, and a person's clicks: read, and every broken one with its message.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::path::{Path, PathBuf};

use biplane_acquisition::beads::{
    BeadFile, read_bead_clicks, read_bead_list, read_xmalab_references, write_bead_csv, write_xmalab_cube,
};
use biplane_acquisition::inspect::describe;
use biplane_acquisition::meshes::LengthUnit;
use biplane_acquisition::plates::{read_plate_clicks, read_plate_list};
use biplane_artifact::{BeadList, PlatePattern};
use tempfile::TempDir;

fn write(folder: &TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    path
}

const PLATE: &str = "# the plate on the left intensifier\nhole,x_mm,y_mm,radius_mm\n0,0,0,2.2\n1,10,0,1.9\n2,5,8.66,1.25\n\
                     3,-5,8.66,1.25\n4,-10,0,\n5,-5,-8.66,1.25\n6,5,-8.66,1.25\n";

#[test]
fn a_plate_is_read_in_every_unit_and_without_what_may_be_missing() {
    let folder = TempDir::new().unwrap();
    let PlatePattern::List(spots) = read_plate_list(write(&folder, "p.csv", PLATE)).unwrap() else {
        panic!("a list");
    };
    assert_eq!(spots.len(), 7);
    assert_eq!((spots[1].at_mm, spots[1].radius_mm), ([10.0, 0.0], Some(1.9)));
    assert_eq!(spots[4].radius_mm, None);
    let bare = "x_in,y_in\n0,0\n1,0\n0,1\n1,1\n2,0\n2,1\n";
    let PlatePattern::List(spots) = read_plate_list(write(&folder, "p.csv", bare)).unwrap() else {
        panic!("a list");
    };
    assert_eq!((spots[4].at_mm, spots[4].radius_mm), ([50.8, 0.0], None));
}

#[test]
fn a_plate_that_cannot_be_is_refused() {
    let folder = TempDir::new().unwrap();
    let error = |from: &str, to: &str| {
        assert!(PLATE.contains(from), "{from}");
        read_plate_list(write(&folder, "p.csv", &PLATE.replacen(from, to, 1))).unwrap_err().to_string()
    };
    let e = error("x_mm", "x");
    assert!(e.contains("p.csv, line 2: expected a header with the column `x_mm`"), "{e}");
    let e = error("hole,x_mm", "x_mm,x_mm");
    assert!(e.contains("`x_mm` twice"), "{e}");
    let e = error("\n1,10,0", "\n1,ten,0");
    assert!(e.contains("line 4: expected a finite number in column `x_mm`, found `ten`"), "{e}");
    let e = error("\n3,-5", "\n4,-5");
    assert!(e.contains("line 6: expected hole 3") && e.contains("found `4`"), "{e}");
    let e = error("\n1,10,0", "\n1,3,0");
    assert!(
        e.contains("line 4: expected a hole apart from the others, found one 3.000 mm from that of line 3"),
        "{e}"
    );
    let e = error("2.2", "-2.2");
    assert!(e.contains("line 3: expected a radius above 0"), "{e}");
    let e = error("x_mm,y_mm", "x_m,y_m");
    // The diagonal of a box of 20 by 17.32 m.
    assert!(
        e.contains(
            "26457.180 mm across; expected 5 to 2000 mm: name the columns `x_cm`, `y_cm` (264.572 mm)"
        ),
        "{e}"
    );
    let line: String = (0..9).map(|i| format!("{i},{},{}\n", 10 * i, 20 * i)).collect();
    let e =
        read_plate_list(write(&folder, "p.csv", &format!("hole,x_mm,y_mm\n{line}"))).unwrap_err().to_string();
    assert!(e.contains("in a line"), "{e}");
    let e = read_plate_list(write(&folder, "p.csv", "x_mm,y_mm\n0,0\n")).unwrap_err().to_string();
    assert!(e.contains("1 holes; a plate has 6 to"), "{e}");
    let e = read_plate_list(write(&folder, "p.csv", "\n# nothing\n")).unwrap_err().to_string();
    assert!(e.contains("the file is empty"), "{e}");
}

#[test]
fn clicks_on_a_plate_name_a_hole_or_a_place() {
    let folder = TempDir::new().unwrap();
    let pattern = read_plate_list(write(&folder, "p.csv", PLATE)).unwrap();
    let read = |text: &str, pattern: &PlatePattern| {
        read_plate_clicks(write(&folder, "c.csv", text), pattern).map_err(|e| e.to_string())
    };
    let clicks = read("hole,x_px,y_px\n1,500,400.5\n", &pattern).unwrap().0;
    assert_eq!((clicks[0].plate_mm, clicks[0].at_px), ([10.0, 0.0], [500.0, 400.5]));
    let square = PlatePattern::Square { pitch_mm: 10.0 };
    let clicks = read("x_cm,y_cm,x_px,y_px\n1,2,3,4\n", &square).unwrap().0;
    assert_eq!((clicks[0].plate_mm, clicks[0].at_px), ([10.0, 20.0], [3.0, 4.0]));
    let e = read("hole,x_px,y_px\n1,2,3\n7,500,400\n", &pattern).unwrap_err();
    assert!(e.contains("c.csv, line 3: expected a hole from 0 to 6, found hole 7"), "{e}");
    let e = read("hole,x_px,y_px\n7,500,400\n", &square).unwrap_err();
    assert!(e.contains("a grid without end has no numbered holes"), "{e}");
    let e = read("hole,x_px\n7,500\n", &pattern).unwrap_err();
    assert!(e.contains("`y_px`"), "{e}");
}

const BEADS: &str = "bead,x_mm,y_mm,z_mm,radius_mm\na1,0,0,0,1.5\na2,100,0,0,1.5\na3,0,100,0,1.5\na4,100,100,10,1.5\n\
                     b1,0,0,100,1.5\nb2,100,0,100,2.5\n";

fn read_beads(folder: &TempDir, text: &str, unit: LengthUnit) -> Result<BeadFile, String> {
    read_bead_list(write(folder, "beads.csv", text), unit).map_err(|e| e.to_string())
}

#[test]
fn beads_are_read_and_the_large_ones_are_marks() {
    let folder = TempDir::new().unwrap();
    // The unit is XMALab's alone: this file says its own.
    let file = read_beads(&folder, BEADS, LengthUnit::Metres).unwrap();
    assert_eq!(file.bright, None);
    let marks: Vec<&str> = file.list.0.iter().filter(|b| b.mark).map(|b| b.name.as_str()).collect();
    assert_eq!(marks, ["b2"]);
    assert!(file.notes[0].contains("marks: b2"), "{:?}", file.notes);
    assert_eq!(file.list.0[3].at_mm, [100.0, 100.0, 10.0]);
    // The column `mark` decides where there is one.
    let marked =
        BEADS.replace("radius_mm\n", "radius_mm,mark\n").replace("a2,100,0,0,1.5", "a2,100,0,0,1.5,1");
    let file = read_beads(&folder, &marked, LengthUnit::Millimetres).unwrap();
    let marks: Vec<&str> = file.list.0.iter().filter(|b| b.mark).map(|b| b.name.as_str()).collect();
    assert_eq!(marks, ["a2"]);
}

#[test]
fn beads_that_cannot_be_are_refused() {
    let folder = TempDir::new().unwrap();
    let error = |from: &str, to: &str| {
        assert!(BEADS.contains(from), "{from}");
        read_beads(&folder, &BEADS.replacen(from, to, 1), LengthUnit::Millimetres).unwrap_err()
    };
    let e = error("a2,100,0,0", "a2,1,1,0");
    assert!(e.contains("beads `a1` (line 2) and `a2` (line 3) are 1.414 mm apart"), "{e}");
    let e = error("a2,", "a1,");
    assert!(e.contains("lines 2 and 3 both name a bead `a1`"), "{e}");
    let e = error("x_mm,y_mm,z_mm", "x_m,y_m,z_m");
    assert!(e.contains("expected 5 to 2000 mm: name the columns `x_mm`, `y_mm`, `z_mm` (1"), "{e}");
    let e = error("1.5", "-1");
    assert!(e.contains("line 2: expected a radius above 0"), "{e}");
    let e = error("0,0,0,1.5", "0,inf,0,1.5");
    assert!(e.contains("line 2: expected a finite number in column `y_mm`, found `inf`"), "{e}");
    let flat =
        BEADS.replace(",10,1.5", ",0,1.5").replace(",100,1.5\n", ",0,1.5\n").replace("b1,0,0", "b1,50,40");
    let e = read_beads(&folder, &flat.replace("b2,100,0,100", "b2,30,70,0"), LengthUnit::Millimetres)
        .unwrap_err();
    assert!(e.contains("all beads lie in a plane"), "{e}");
    let e = read_beads(&folder, "1,2,3\n", LengthUnit::Millimetres).unwrap_err();
    assert!(
        e.contains("line 1: expected the header of a list of beads") && e.contains("found `1,2,3`"),
        "{e}"
    );
    let e = read_beads(&folder, "bead,x_mm,y_mm,z_mm\n1,2,3,4\n", LengthUnit::Millimetres).unwrap_err();
    assert!(e.contains("1 beads; a frame has 6 to"), "{e}");
}

const CUBE: &str = "x y z\n0,0,0\n10,0,0,top left\n0,10,0\n10,10,1\n0,0,10\n10,0,10\n";

#[test]
fn cubes_of_xmalab_have_a_unit_a_polarity_and_references() {
    let folder = TempDir::new().unwrap();
    let file = read_beads(&folder, CUBE, LengthUnit::Centimetres).unwrap();
    assert_eq!(file.bright, Some(false));
    let names: Vec<&str> = file.list.0.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names, ["1", "top left", "3", "4", "5", "6"]);
    assert_eq!(file.list.0[3].at_mm, [100.0, 100.0, 10.0]);
    let white = read_beads(&folder, &CUBE.replace("x y z", "white"), LengthUnit::Centimetres).unwrap();
    assert_eq!(white.bright, Some(true));
    assert_eq!(white.list, file.list);
    // As XMALab's own code does: `s10,s10,s5,white` multiplies the numbers that follow.
    let scaled =
        read_beads(&folder, &CUBE.replace("x y z", "s10,s10,s5,white"), LengthUnit::Millimetres).unwrap();
    assert_eq!(scaled.list.0[3].at_mm, [100.0, 100.0, 5.0]);
    let e = read_beads(&folder, CUBE, LengthUnit::Metres).unwrap_err();
    assert!(e.contains("set its unit to \"mm\"") || e.contains("set its unit to \"cm\""), "{e}");
    let e = read_beads(&folder, &CUBE.replace("10,10,1", "10,10"), LengthUnit::Centimetres).unwrap_err();
    assert!(e.contains("line 5: expected three finite numbers"), "{e}");

    let mut list = file.list.clone();
    let references = write(&folder, "r.txt", "1 origin\n5 up\n");
    assert_eq!(read_xmalab_references(references, &mut list).unwrap(), 2);
    assert_eq!((list.0[0].name.as_str(), list.0[0].mark), ("origin", true));
    assert_eq!((list.0[4].name.as_str(), list.0[4].mark), ("up", true));
    assert!(!list.0[1].mark);
    let before = list.clone();
    for (text, what) in [
        ("1 a\n7 b\n", "line 2: expected a number from 1 to 6 and a name, found `7 b`"),
        ("0 a\n", "expected a number from 1 to 6"),
        ("1\n", "expected a number from 1 to 6"),
        ("1 a\n1 b\n", "line 2: expected each bead once"),
        ("1 a\n2 a\n", "line 2: expected a name that bead 1 does not have"),
        ("", "expected reference beads"),
    ] {
        let e = read_xmalab_references(write(&folder, "r.txt", text), &mut list).unwrap_err().to_string();
        assert!(e.contains(what), "{e}");
        assert_eq!(list, before);
    }
}

#[test]
fn lists_of_beads_go_out_and_come_back() {
    let folder = TempDir::new().unwrap();
    let list = read_beads(&folder, BEADS, LengthUnit::Millimetres).unwrap().list;
    let again = read_beads(&folder, &write_bead_csv(&list), LengthUnit::Millimetres).unwrap().list;
    assert_eq!(again, list);
    for bright in [true, false] {
        let files = write_xmalab_cube(&list, bright);
        assert_eq!(files.lost, ["the beads' radii"]);
        let mut back = read_beads(&folder, &files.cube, LengthUnit::Millimetres).unwrap();
        assert_eq!(back.bright, Some(bright));
        read_xmalab_references(write(&folder, "r.txt", &files.references), &mut back.list).unwrap();
        let mut expected = list.clone();
        expected.0.iter_mut().for_each(|b| b.radius_mm = None);
        assert_eq!(back.list, expected);
    }
}

#[test]
fn clicks_on_beads_go_by_name() {
    let folder = TempDir::new().unwrap();
    let BeadFile { list, .. } = read_beads(&folder, BEADS, LengthUnit::Millimetres).unwrap();
    let read = |text: &str, list: &BeadList| {
        read_bead_clicks(write(&folder, "c.csv", text), 1, list).map_err(|e| e.to_string())
    };
    let clicks = read("bead,x_px,y_px,picture\nb1,10.5,20,2\na1,3,4,\n", &list).unwrap().0;
    assert_eq!((clicks[0].view, clicks[0].picture, clicks[0].bead, clicks[0].at_px), (1, 2, 4, [10.5, 20.0]));
    assert_eq!((clicks[1].picture, clicks[1].bead), (0, 0));
    let e = read("bead,x_px,y_px\nA3x,1,2\n", &list).unwrap_err();
    assert!(
        e.contains("line 2: expected a bead of the list, perhaps `a3`") && e.contains("found `A3x`"),
        "{e}"
    );
    let e = read("bead,x_px,y_px\na1,1,2\na1,1,2\n", &list).unwrap_err();
    assert!(e.contains("line 3: expected each bead once in a picture"), "{e}");
    let e = read("bead,x_px,y_px,picture\na1,1,2,-1\n", &list).unwrap_err();
    assert!(e.contains("a whole number from 0 in column `picture`"), "{e}");
}

#[test]
fn damaged_lists_never_panic() {
    let folder = TempDir::new().unwrap();
    let pattern = read_plate_list(write(&folder, "p.csv", PLATE)).unwrap();
    let BeadFile { list, .. } = read_beads(&folder, BEADS, LengthUnit::Millimetres).unwrap();
    let clicks = "bead,hole,x_px,y_px,picture\na1,0,1,2,0\na2,1,3,4,1\n";
    for text in [PLATE, BEADS, CUBE, "1 origin\n5 up\n", clicks] {
        for place in (0..text.len()).step_by(7) {
            for with in [&b""[..], b"-", b"1e308", b"\xff", b"nan", b",", b"\n", b"99999999999999999999"] {
                let mut damaged = text.as_bytes()[..place].to_vec();
                if !with.is_empty() {
                    damaged.extend(with);
                    damaged.extend(&text.as_bytes()[place + 1..]);
                }
                let path = folder.path().join("damaged");
                std::fs::write(&path, &damaged).unwrap();
                let _ = read_plate_list(&path);
                let _ = read_bead_list(&path, LengthUnit::Metres);
                let _ = read_xmalab_references(&path, &mut list.clone());
                let _ = read_plate_clicks(&path, &pattern);
                let _ = read_bead_clicks(&path, 0, &list);
            }
        }
    }
}

#[test]
fn lists_are_described() {
    let folder = TempDir::new().unwrap();
    let text = describe(write(&folder, "p.csv", PLATE)).unwrap().to_string();
    for part in
        ["plate's holes", "holes", "4 of 1.25 mm, 1 of 2.2 mm, 1 of 1.9 mm, 1 not stated", "10.000 mm"]
    {
        assert!(text.contains(part), "{part} not in: {text}");
    }
    let text = describe(write(&folder, "b.csv", BEADS)).unwrap().to_string();
    for part in ["frame's beads (CSV)", "100.000 x 100.000 x 100.000 mm", "marks", "b2"] {
        assert!(text.contains(part), "{part} not in: {text}");
    }
    let text = describe(write(&folder, "cube.csv", CUBE)).unwrap().to_string();
    for part in ["cube file of XMALab", "10.000 x 10.000 x 10.000 mm", "dark", "taken as mm"] {
        assert!(text.contains(part), "{part} not in: {text}");
    }
}

#[test]
fn the_fixtures_lists_are_read() {
    let study = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../fixtures/knee/calibration");
    let PlatePattern::List(spots) = read_plate_list(study.join("plate.csv")).unwrap() else {
        panic!("a list");
    };
    // As the simulator made them: hole 0 of 2.2 mm in the middle, hole 1 of 1.9 mm at (10, 0).
    assert_eq!((spots[0].at_mm, spots[0].radius_mm), ([0.0, 0.0], Some(2.2)));
    assert_eq!((spots[1].at_mm, spots[1].radius_mm), ([10.0, 0.0], Some(1.9)));
    let file = read_bead_list(study.join("beads.csv"), LengthUnit::Millimetres).unwrap();
    let marks: Vec<&str> = file.list.0.iter().filter(|b| b.mark).map(|b| b.name.as_str()).collect();
    assert_eq!((file.list.0.len(), marks), (30, vec!["29", "30"]));
}
