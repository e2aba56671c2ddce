//! Volumes: NRRD, NIfTI-1 and DICOM series written here, byte by byte; damage of every kind; files of real laboratories, skipped
//! with a message where they are not there.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::io::Write;
use std::path::{Path, PathBuf};

use biplane_acquisition::inspect::describe;
use biplane_acquisition::volumes::{
    Orientation, VolumeFile, VolumeFileError, VolumeFormat, VolumeNote, read_volume,
};
use biplane_artifact::Volume;
use dicom_core::{DataElement, PrimitiveValue, VR};
use dicom_dictionary_std::tags;
use dicom_object::{FileMetaTableBuilder, InMemDicomObject};
use flate2::Compression;
use flate2::write::GzEncoder;
use nalgebra::Vector3;
use tempfile::TempDir;

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn write(folder: &TempDir, name: &str, parts: &[&[u8]]) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, parts.concat()).unwrap();
    path
}

/// A header of 2 x 3 x 4 voxels; `more` is added and may replace lines.
fn header(kind: &str, encoding: &str, more: &str) -> String {
    let mut lines = vec![
        format!("type: {kind}"),
        "dimension: 3".to_owned(),
        "sizes: 2 3 4".to_owned(),
        format!("encoding: {encoding}"),
        "space: left-posterior-superior".to_owned(),
        "space directions: (1,0,0) (0,2,0) (0,0,3)".to_owned(),
        "space origin: (10,20,30)".to_owned(),
    ];
    for line in more.lines() {
        let field = line.split(':').next().unwrap();
        lines.retain(|l| l.split(':').next() != Some(field));
        lines.push(line.trim_end().to_owned());
    }
    // A line that ends with the colon takes a field away.
    lines.retain(|l| !l.ends_with(':'));
    format!("NRRD0004\n# made by hand\n{}\n\n", lines.join("\n"))
}

fn message(path: &Path) -> String {
    read_volume(path).unwrap_err().to_string()
}

/// A stored type: its name, its values, and their bytes with the lowest one first.
type Stored = (&'static str, Vec<f32>, Vec<Vec<u8>>);

fn stored() -> Vec<Stored> {
    macro_rules! of {
        ($name:literal, $kind:ty, $low:expr, $high:expr) => {{
            let values: Vec<$kind> = [$low, $high].into_iter().chain((0..22).map(|i| i as $kind)).collect();
            let levels = values.iter().map(|v| *v as f32).collect();
            ($name, levels, values.iter().map(|v| v.to_le_bytes().to_vec()).collect())
        }};
    }
    vec![
        of!("int8", i8, i8::MIN, i8::MAX),
        of!("unsigned char", u8, 0, 255),
        of!("short", i16, i16::MIN, i16::MAX),
        of!("ushort", u16, 0, u16::MAX),
        of!("signed int", i32, -16_777_216, 16_777_216),
        of!("uint32_t", u32, 0, 16_777_216),
        of!("long long", i64, -16_777_216, 5),
        of!("uint64", u64, 0, 16_777_216),
        of!("float", f32, -1.5e30, 2.5e-30),
        of!("double", f64, -0.125, 1e20),
    ]
}

#[test]
fn nrrd_of_every_type_byte_order_and_encoding_is_read() {
    let folder = TempDir::new().unwrap();
    for (kind, levels, samples) in stored() {
        for big in [false, true] {
            let bytes: Vec<u8> = samples
                .iter()
                .flat_map(|b| if big { b.iter().rev().copied().collect() } else { b.clone() })
                .collect();
            let order = if big { "endian: big" } else { "endian: little" };
            let hex: String = bytes.iter().map(|b| format!("{b:02X}\n")).collect();
            for (encoding, data) in [
                ("raw", bytes.clone()),
                ("gz", gzip(&bytes)),
                ("gzip", gzip(&bytes)),
                ("hex", hex.into_bytes()),
            ] {
                let path = write(&folder, "a", &[header(kind, encoding, order).as_bytes(), &data]);
                let file = read_volume(&path).unwrap();
                assert_eq!(file.volume.samples, levels, "{kind} {order} {encoding}");
                assert_eq!((file.format, file.notes), (VolumeFormat::Nrrd, vec![]));
            }
        }
        let text: Vec<String> = levels.iter().map(|v| format!("{v}")).collect();
        for text in [text.join(" "), text.join(",\n") + "\n"] {
            let path = write(&folder, "a", &[header(kind, "ASCII", "").as_bytes(), text.as_bytes()]);
            assert_eq!(read_volume(&path).unwrap().volume.samples, levels, "{kind} {text}");
        }
    }
}

#[test]
fn nrrd_of_bzip2_is_read() {
    let folder = TempDir::new().unwrap();
    // `bz2.compress(bytes(range(24)))` of Python 3.
    let hex = "425a6839314159265359f7cd3b6100000060007fffff802000228001a6864c85068d1a0c80d15cf84653a56d7c64343be748fc8b\
               f177245385090f7cd3b610";
    let data: Vec<u8> =
        (0..hex.len() / 2).map(|i| u8::from_str_radix(&hex[2 * i..2 * i + 2], 16).unwrap()).collect();
    let whole = [header("uchar", "bz2", "").into_bytes(), data].concat();
    let path = write(&folder, "a", &[&whole]);
    assert_eq!(read_volume(&path).unwrap().volume.samples, (0..24).map(|v| v as f32).collect::<Vec<_>>());
    for cut in whole.len() - 60..whole.len() {
        let text = message(&write(&folder, "a", &[&whole[..cut]]));
        assert!(text.contains("cannot be decoded") || text.contains("cut short"), "{text}");
    }
}

fn bytes24() -> Vec<u8> {
    (0..24).collect()
}

#[test]
fn nrrd_is_placed_left_posterior_superior_with_its_first_axis_fastest() {
    let folder = TempDir::new().unwrap();
    let read = |more: &str| {
        read_volume(write(&folder, "a", &[header("uint8", "raw", more).as_bytes(), &bytes24()])).unwrap()
    };
    let volume = read("").volume;
    assert_eq!((volume.columns, volume.rows, volume.origins_mm.len()), (2, 3, 4));
    // The voxel (1, 2, 3) is the last one, at origin + 1 (1,0,0) + 2 (0,2,0) + 3 (0,0,3).
    assert_eq!(volume.place_mm(1.0, 2.0, 3), Some([11.0, 24.0, 39.0]));
    assert_eq!(volume.slice(3).unwrap()[5], 23.0);
    assert_eq!(volume.slice(1).unwrap(), [6.0, 7.0, 8.0, 9.0, 10.0, 11.0]);
    for (space, expected) in [
        ("LPS", [11.0, 24.0, 39.0]),
        ("right-anterior-superior", [-11.0, -24.0, 39.0]),
        ("RAS", [-11.0, -24.0, 39.0]),
        ("Left-Anterior-Superior", [11.0, -24.0, 39.0]),
        ("LAS", [11.0, -24.0, 39.0]),
    ] {
        let file = read(&format!("space: {space}"));
        assert_eq!((file.volume.place_mm(1.0, 2.0, 3), file.notes.len()), (Some(expected), 0), "{space}");
    }
    // Permuted axes stay in the file's order.
    let volume = read("space directions: (0, 0, -1) (2, 0, 0) (0,3,0)").volume;
    assert_eq!((volume.column_step_mm, volume.row_step_mm), ([0.0, 0.0, -1.0], [2.0, 0.0, 0.0]));
    assert_eq!(volume.origins_mm[3], [10.0, 29.0, 30.0]);
}

#[test]
fn nrrd_that_does_not_say_where_it_is_is_read_with_notes() {
    let folder = TempDir::new().unwrap();
    let read = |more: &str| {
        read_volume(write(&folder, "a", &[header("uint8", "raw", more).as_bytes(), &bytes24()])).unwrap()
    };
    let file = read("space:\nspace directions:\nspace origin:\nspacings: 0.5 0.6 4");
    assert_eq!(file.notes, [VolumeNote::UnknownSpace, VolumeNote::SpacingsAlone, VolumeNote::NoOrigin]);
    assert_eq!(file.volume.place_mm(1.0, 2.0, 3), Some([0.5, 1.2, 12.0]));
    assert_eq!(read("space: scanner-xyz").notes, [VolumeNote::UnknownSpace]);
    // tan(10 degrees) = 0.1763: slices pushed along their rows; rows against columns.
    let file = read("space directions: (1,0,0) (0,2,0) (0.5290,0,3)");
    assert!(matches!(file.notes[..], [VolumeNote::Tilted { degrees }] if (degrees - 10.0).abs() < 0.01));
    let file = read("space directions: (1,0,0) (0.1763,1,0) (0,0,3)");
    assert!(matches!(file.notes[..], [VolumeNote::Skewed { degrees }] if (degrees - 10.0).abs() < 0.01));
    let path = write(
        &folder,
        "a",
        &[header("int64", "raw", "endian: little").as_bytes(), &[16_777_217_i64.to_le_bytes(); 24].concat()],
    );
    assert_eq!(read_volume(path).unwrap().notes, [VolumeNote::Rounded { voxels: 24 }]);
}

#[test]
fn detached_nrrd_finds_its_voxels() {
    let folder = TempDir::new().unwrap();
    let raw = bytes24();
    let read = |encoding: &str, more: &str, data: &[u8]| {
        write(&folder, "voxels.dat", &[data]);
        let text = header("uint8", encoding, &format!("data file: voxels.dat\n{more}"));
        // A detached header may end without an empty line, and with the line ends of another system.
        write(&folder, "a.nhdr", &[text.trim_end().replace('\n', "\r\n").as_bytes()])
    };
    let expected: Vec<f32> = (0..24).map(|v| v as f32).collect();
    let lines = b"first\nsecond\n".as_slice();
    for (encoding, more, data) in [
        ("raw", "", raw.clone()),
        ("raw", "byte skip: 3", [b"abc", raw.as_slice()].concat()),
        ("raw", "byteskip: -1", [b"abcdef", raw.as_slice()].concat()),
        ("raw", "line skip: 2", [lines, &raw].concat()),
        ("raw", "lineskip: 2\nbyte skip: 3", [lines, b"abc", &raw].concat()),
        ("gzip", "byte skip: 3", gzip(&[b"abc", raw.as_slice()].concat())),
        ("gzip", "byte skip: -1", gzip(&[b"abcdefg", raw.as_slice()].concat())),
        ("gzip", "line skip: 2", [lines, &gzip(&raw)].concat()),
        // Several members, as bgzip writes them.
        ("gzip", "", [gzip(&raw[..10]), gzip(&raw[10..])].concat()),
    ] {
        let path = read(encoding, more, &data);
        let file = read_volume(&path).unwrap_or_else(|e| panic!("{encoding} {more}: {e}"));
        assert_eq!(file.volume.samples, expected, "{encoding} {more}");
        assert_eq!(file.files, [path, folder.path().join("voxels.dat")]);
    }
    for more in ["byte skip: 2", "byte skip: 0", "line skip: 1"] {
        let (before, text) = (if more.ends_with('0') { "" } else { "9\n" }, "1 ".repeat(24));
        let file = read_volume(read("text", more, &[before, &text].concat().into_bytes())).unwrap();
        assert_eq!(file.volume.samples, [1.0; 24], "{more}");
    }
    let text = message(&read("text", "byte skip: -1", &raw));
    assert!(text.contains("expected a number, found `-1`"), "{text}");
    let text = message(&read("raw", "byte skip: -5", &raw));
    assert!(text.contains("expected a number, or -1 for voxels at the end, found `-5`"), "{text}");
    let text = message(&read("raw", "", &[raw.clone(), vec![0]].concat()));
    assert!(text.contains("voxels.dat holds more than the 24 voxels"), "{text}");
    let text = message(&read("raw", "", &raw[..20]));
    assert!(text.contains("voxels.dat is cut short: it holds 20 of 24 voxels"), "{text}");
    let text = message(&read("raw", "data file: gone.raw", &raw));
    assert!(text.contains("cannot read") && text.contains("gone.raw"), "{text}");
    let text = message(&read("raw", "data file: LIST\nslice0.raw", &raw));
    assert!(text.contains("several files"), "{text}");
}

#[test]
fn nrrd_that_is_not_read_says_why() {
    let folder = TempDir::new().unwrap();
    let text =
        |more: &str| message(&write(&folder, "a", &[header("uint8", "raw", more).as_bytes(), &bytes24()]));
    for (more, part) in [
        ("dimension: 4\nsizes: 3 2 3 4", "NRRD of 4 axes, not three"),
        ("dimension: 1", "NRRD of 1 axis, not three"),
        ("dimension: x", "line 9: expected `dimension: 3`, found `x`"),
        ("sizes: 2 3", "expected `sizes:` and three whole numbers, found `2 3`"),
        ("sizes: 2 3 -4", "three whole numbers"),
        ("sizes: 0 3 4", "claims 0 x 3 x 4 voxels"),
        ("kinds: vector domain domain", "`kinds` names vectors"),
        ("kinds: domain domain RGB-color", "`kinds` names vectors"),
        ("type: block", "blocks of bytes"),
        ("type: char16", "expected `type:` and the name of a type"),
        ("type: short", "line 10: expected `endian: little` or `endian: big`, found the header's end"),
        ("encoding: zip", "one of raw, gzip, bzip2, text, hex, found `zip`"),
        ("encoding:", "found the header's end without `encoding`"),
        ("space: left-posterior", "a space of three axes"),
        ("space: 3D-left-handed", "not the patient's"),
        ("space directions: none (0,1,0) (0,0,1)", "three vectors such as"),
        ("space directions: (1,0,0) (0,1,0)", "three vectors such as"),
        ("space directions: (1,0,0) (2,0,0) (0,0,1)", "its three axes lie in a plane"),
        ("space directions: (1,0,0) (0,0,0) (0,0,1)", "would be 0 mm apart"),
        ("space directions: (nan,0,0) (0,1,0) (0,0,1)", "would be NaN mm apart"),
        ("space directions:", "or `spacings:` and three numbers, mm"),
        ("space directions:\nspacings: 1 nan 1", "or `spacings:` and three numbers, mm, found `1 nan 1`"),
        ("space origin: (0,0)", "a vector such as"),
        ("space origin: (0,0,inf)", "its first voxel would be at"),
        ("space units: \"cm\" \"cm\" \"cm\"", "convert it to mm"),
        ("byte skip: x", "expected a number, or -1"),
        ("line skip: -1", "expected a number, found `-1`"),
        ("line skip: 7", "it ends after"),
    ] {
        let text = text(more);
        assert!(text.contains(part), "{more}: `{part}` not in: {text}");
    }
    let whole = header("uint8", "raw", "");
    let twice = whole.replace("dimension: 3\n", "dimension: 3\ndimension: 3\n");
    let text = message(&write(&folder, "a", &[twice.as_bytes(), &bytes24()]));
    assert!(
        text.contains("line 5: expected each field once, found `dimension` again, which is in line 4 too"),
        "{text}"
    );
    let text = message(&write(&folder, "a", &[whole.replace("NRRD0004", "NRRD0006").as_bytes()]));
    assert!(text.contains("a version other than 1 to 5"), "{text}");
    let text = message(&write(&folder, "a", &[whole.trim_end().as_bytes()]));
    assert!(text.contains("line 9: expected an empty line and the voxels, or `data file:`"), "{text}");
    let text = message(&write(&folder, "a", &[header("float", "text", "").as_bytes(), b"1 2 nan"]));
    assert!(text.contains("the voxel (0, 1, 0), counted from 0, is not a number"), "{text}");
    for (kind, word) in
        [("uint8", "256"), ("int8", "-129"), ("short", "1.5"), ("float", "one"), ("uint8", &"1".repeat(99))]
    {
        let text =
            message(&write(&folder, "a", &[header(kind, "text", "").as_bytes(), b"1 2 ", word.as_bytes()]));
        assert!(text.contains("sample 2 of its text, counted from 0, is no number"), "{word}: {text}");
    }
    let text = message(&write(&folder, "a", &[header("uint8", "hex", "").as_bytes(), b"00 0x"]));
    assert!(text.contains("of 24 (a byte that is no hexadecimal digit)"), "{text}");
    let text = message(&write(&folder, "a", &[b"hello"]));
    assert!(text.contains("is not a volume this program reads"), "{text}");
    assert!(message(&folder.path().join("gone")).contains("cannot read"));
}

/// A NIfTI-1 header of 2 x 3 x 4 voxels of `uint8`, as numbers at byte places, in one byte order.
struct Nifti {
    bytes: Vec<u8>,
    big: bool,
}

impl Nifti {
    fn new(big: bool) -> Self {
        let mut n = Self { bytes: vec![0; 352], big };
        n.put(0, &348_i32.to_le_bytes());
        n.shorts(40, &[3, 2, 3, 4, 1, 1, 1, 1]);
        n.shorts(70, &[2, 8]);
        n.floats(76, &[1.0, 1.0, 2.0, 3.0]);
        n.floats(108, &[352.0]);
        n.bytes[123] = 2;
        n.bytes[344..348].copy_from_slice(b"n+1\0");
        n.bytes[148..161].copy_from_slice(b"Secret^Walter");
        n
    }

    /// One number, its lowest byte first.
    fn put(&mut self, at: usize, little: &[u8]) {
        let mut number = little.to_vec();
        if self.big {
            number.reverse();
        }
        self.bytes[at..at + number.len()].copy_from_slice(&number);
    }

    fn shorts(&mut self, at: usize, numbers: &[i16]) {
        numbers.iter().enumerate().for_each(|(i, n)| self.put(at + 2 * i, &n.to_le_bytes()));
    }

    fn floats(&mut self, at: usize, numbers: &[f32]) {
        numbers.iter().enumerate().for_each(|(i, n)| self.put(at + 4 * i, &n.to_le_bytes()));
    }

    /// Rows of an affine map.
    fn sform(&mut self, code: i16, rows: [[f32; 4]; 3]) {
        self.shorts(254, &[code]);
        self.floats(280, &rows.concat());
    }

    fn qform(&mut self, code: i16, bcd: [f32; 3], offset: [f32; 3]) {
        self.shorts(252, &[code]);
        self.floats(256, &[bcd, offset].concat());
    }
}

#[test]
fn nifti_is_turned_from_right_anterior_superior() {
    let folder = TempDir::new().unwrap();
    for big in [false, true] {
        let mut n = Nifti::new(big);
        n.sform(1, [[1.0, 0.0, 0.0, -10.0], [0.0, 2.0, 0.0, -20.0], [0.0, 0.0, 3.0, 30.0]]);
        let whole = [n.bytes.clone(), bytes24()].concat();
        for bytes in [whole.clone(), gzip(&whole)] {
            let file = read_volume(write(&folder, "a", &[&bytes])).unwrap();
            assert_eq!(file.format, VolumeFormat::Nifti);
            assert_eq!(file.volume.place_mm(0.0, 0.0, 0), Some([10.0, 20.0, 30.0]));
            assert_eq!(file.volume.place_mm(1.0, 2.0, 3), Some([9.0, 16.0, 39.0]));
            assert_eq!(file.volume.samples, (0..24).map(|v| v as f32).collect::<Vec<_>>());
            assert!(
                matches!(file.notes[..], [VolumeNote::PlacedBy { form: "sform", .. }]),
                "{:?}",
                file.notes
            );
            assert_eq!(file.stored.contains("big"), big);
        }
    }
}

#[test]
fn the_sform_is_preferred_and_a_differing_qform_noted() {
    let folder = TempDir::new().unwrap();
    let read = |n: &Nifti| read_volume(write(&folder, "a", &[&n.bytes, &bytes24()])).unwrap();
    let mut n = Nifti::new(false);
    let half = 0.5_f32.sqrt();
    // A quarter turn about z takes x to y (nifti1.h: quaternion (cos, sin of half the angle along the axis)).
    n.qform(1, [0.0, 0.0, half], [5.0, 6.0, 7.0]);
    let file = read(&n);
    let at = |file: &VolumeFile, i, j, k| Vector3::from(file.volume.place_mm(i, j, k).unwrap());
    // RAS: (5,6,7) + 1 (0,1,0) + 2 (-2,0,0) + 3 (0,0,3) = (1,7,16).
    assert!((at(&file, 1.0, 2.0, 3) - Vector3::new(-1.0, -7.0, 16.0)).norm() < 1e-6);
    assert!(matches!(file.notes[..], [VolumeNote::PlacedBy { form: "qform", .. }]));
    // With a negative first pixdim the third axis goes the other way.
    n.floats(76, &[-1.0]);
    assert!((at(&read(&n), 1.0, 2.0, 3) - Vector3::new(-1.0, -7.0, -2.0)).norm() < 1e-6);
    n.floats(76, &[1.0]);
    n.sform(1, [[0.0, -2.0, 0.0, 5.0], [1.0, 0.0, 0.0, 6.0], [0.0, 0.0, 3.0, 7.0]]);
    assert_eq!(read(&n).notes.len(), 1, "the same place twice");
    n.sform(4, [[0.0, -2.0, 0.0, 5.5], [1.0, 0.0, 0.0, 6.0], [0.0, 0.0, 3.0, 7.0]]);
    let notes = read(&n).notes;
    assert!(notes[0].to_string().contains("placed by its sform, the MNI space"), "{notes:?}");
    assert!(matches!(notes[1], VolumeNote::FormsDiffer { mm } if (mm - 0.5).abs() < 1e-6), "{notes:?}");
    // Neither: voxel sizes alone; and a unit that is not mm.
    let mut n = Nifti::new(false);
    let file = read(&n);
    assert!((at(&file, 1.0, 2.0, 3) - Vector3::new(-1.0, -4.0, 9.0)).norm() < 1e-6);
    assert!(file.notes[0].to_string().contains("placed by its pixdim"), "{:?}", file.notes);
    n.bytes[123] = 3 + 8;
    assert!((at(&read(&n), 1.0, 2.0, 3) - Vector3::new(-0.001, -0.004, 0.009)).norm() < 1e-9);
}

#[test]
fn nifti_levels_have_their_slope_and_every_type_is_read() {
    let folder = TempDir::new().unwrap();
    let codes = [256, 2, 4, 512, 8, 768, 1024, 1280, 16, 64];
    for ((kind, levels, samples), code) in stored().into_iter().zip(codes) {
        for big in [false, true] {
            let mut n = Nifti::new(big);
            n.shorts(70, &[code, 8 * samples[0].len() as i16]);
            let data: Vec<u8> = samples
                .iter()
                .flat_map(|b| if big { b.iter().rev().copied().collect() } else { b.clone() })
                .collect();
            let file = read_volume(write(&folder, "a", &[&n.bytes, &data])).unwrap();
            assert_eq!(file.volume.samples, levels, "{kind}");
        }
    }
    let mut n = Nifti::new(false);
    n.floats(112, &[0.5, -3.0]);
    // Extensions between header and voxels.
    n.floats(108, &[368.0]);
    let file = read_volume(write(&folder, "a", &[&n.bytes, &[1; 16], &bytes24()])).unwrap();
    assert_eq!(file.volume.samples[..4], [-3.0, -2.5, -2.0, -1.5]);
    n.floats(112, &[0.0, -3.0]);
    let file = read_volume(write(&folder, "a", &[&n.bytes, &[1; 16], &bytes24()])).unwrap();
    assert_eq!(file.volume.samples[..2], [0.0, 1.0]);
}

#[test]
fn nifti_that_is_not_read_says_why() {
    let folder = TempDir::new().unwrap();
    let check = |part: &str, change: &dyn Fn(&mut Nifti)| {
        let mut n = Nifti::new(true);
        change(&mut n);
        let path = write(&folder, "a", &[&n.bytes, &bytes24()]);
        let error = read_volume(path).unwrap_err();
        assert!(error.to_string().contains(part), "`{part}` not in: {error}");
        names_nobody(&format!("{error} {error:?}"));
    };
    check("NIfTI of 5 volumes", &|n| n.shorts(40, &[4, 2, 3, 4, 5]));
    check("NIfTI of 2 axes", &|n| n.shorts(40, &[2]));
    check("claims 9 axes", &|n| n.shorts(40, &[9]));
    check("claims 0 x 3 x 4 voxels", &|n| n.shorts(42, &[-2]));
    check("samples are colours", &|n| n.shorts(70, &[128, 24]));
    check("the unknown type 77", &|n| n.shorts(70, &[77]));
    check("says 16 bits for samples of type uint8", &|n| n.shorts(72, &[16]));
    check("would start at byte 352.5", &|n| n.floats(108, &[352.5]));
    check("one of a pair of files", &|n| n.bytes[344..348].copy_from_slice(b"ni1\0"));
    check("would be 0 mm apart", &|n| n.floats(80, &[0.0]));
    check("its unit of length has the unknown code 5", &|n| n.bytes[123] = 5);
    check("more than the 24 voxels", &|n| n.bytes.push(0));
    check("cut short: it holds 24 of 30 voxels", &|n| n.shorts(46, &[5]));
    check("NaN mm apart", &|n| n.sform(1, [[f32::NAN; 4]; 3]));
    check("NaN mm apart", &|n| n.qform(1, [f32::NAN; 3], [0.0; 3]));
    let mut second = vec![0; 540];
    second[..4].copy_from_slice(&540_i32.to_le_bytes());
    second[4..7].copy_from_slice(b"n+2");
    assert!(message(&write(&folder, "a", &[&second])).contains("is NIfTI-2; save"));
}

const EXPLICIT_LITTLE: &str = "1.2.840.10008.1.2.1";
const IMPLICIT_LITTLE: &str = "1.2.840.10008.1.2";
const EXPLICIT_BIG: &str = "1.2.840.10008.1.2.2";

/// Everything of the patient that the files of these tests hold.
fn names_nobody(text: &str) {
    for secret in ["Secret", "Walter", "19450203", "MRN", "0815", "1.2.3.4.5.6", "2.25.77"] {
        assert!(!text.contains(secret), "`{secret}` in: {text}");
    }
}

/// Slice `k` of a stack of sagittal slices, 3 columns of 0.5 mm to posterior by 2 rows of 0.7 mm to inferior, 4 mm apart.
fn slice(k: usize) -> InMemDicomObject {
    let mut o = InMemDicomObject::new_empty();
    let mut text = |tag, vr, value: &str| o.put(DataElement::new(tag, vr, PrimitiveValue::from(value)));
    text(tags::PATIENT_NAME, VR::PN, "Secret^Walter");
    text(tags::PATIENT_ID, VR::LO, "MRN-0815");
    text(tags::PATIENT_BIRTH_DATE, VR::DA, "19450203");
    text(tags::SERIES_INSTANCE_UID, VR::UI, "2.25.77");
    text(tags::SERIES_DESCRIPTION, VR::LO, "Secret Walter left");
    text(tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "MONOCHROME2");
    text(tags::IMAGE_ORIENTATION_PATIENT, VR::DS, "0\\1\\0\\0\\0\\-1");
    text(tags::IMAGE_POSITION_PATIENT, VR::DS, &position(k as f64));
    // The distance of rows comes first.
    text(tags::PIXEL_SPACING, VR::DS, "0.7\\0.5");
    text(tags::ECHO_NUMBERS, VR::IS, "2");
    for (tag, value) in [
        (tags::SAMPLES_PER_PIXEL, 1),
        (tags::ROWS, 2),
        (tags::COLUMNS, 3),
        (tags::BITS_ALLOCATED, 16),
        (tags::BITS_STORED, 16),
        (tags::HIGH_BIT, 15),
        (tags::PIXEL_REPRESENTATION, 1),
    ] {
        put(&mut o, tag, value);
    }
    pixels(&mut o, &(0..6).map(|i| 10 * k as i16 + i - 1).collect::<Vec<_>>());
    o
}

/// Rows run to posterior, columns to inferior: the normal runs to the right, -x.
fn position(k: f64) -> String {
    format!("{}\\-80\\50.5", 20.0 - 4.0 * k)
}

fn put(o: &mut InMemDicomObject, tag: dicom_object::Tag, value: u16) {
    o.put(DataElement::new(tag, VR::US, PrimitiveValue::from(value)));
}

fn set(o: &mut InMemDicomObject, tag: dicom_object::Tag, vr: VR, value: &str) {
    o.put(DataElement::new(tag, vr, PrimitiveValue::from(value)));
}

fn pixels(o: &mut InMemDicomObject, levels: &[i16]) {
    let words = levels.iter().map(|v| *v as u16).collect();
    o.put(DataElement::new(tags::PIXEL_DATA, VR::OW, PrimitiveValue::U16(words)));
}

fn save(folder: &TempDir, name: &str, syntax: &str, object: InMemDicomObject) {
    let meta = FileMetaTableBuilder::new()
        .transfer_syntax(syntax)
        .media_storage_sop_class_uid("1.2.840.10008.5.1.4.1.1.4")
        .media_storage_sop_instance_uid("1.2.3.4.5.6");
    object.with_meta(meta).unwrap().write_to_file(folder.path().join(name)).unwrap();
}

/// A folder of these slices, under names that are not in their order.
fn series(slices: impl IntoIterator<Item = (usize, InMemDicomObject)>) -> TempDir {
    let folder = TempDir::new().unwrap();
    for (k, object) in slices {
        save(&folder, &format!("{}.dcm", (k * 7) % 10), EXPLICIT_LITTLE, object);
    }
    folder
}

#[test]
fn dicom_slices_are_sorted_along_their_normal_in_every_byte_order() {
    for syntax in [EXPLICIT_LITTLE, IMPLICIT_LITTLE, EXPLICIT_BIG] {
        let folder = TempDir::new().unwrap();
        for k in 0..5 {
            save(&folder, &format!("{}", (k * 3) % 5), syntax, slice(k));
        }
        std::fs::write(folder.path().join("notes.txt"), "of Secret^Walter").unwrap();
        let file = read_volume(folder.path()).unwrap();
        let volume = &file.volume;
        assert_eq!((volume.columns, volume.rows, volume.origins_mm.len()), (3, 2, 5));
        assert_eq!((volume.column_step_mm, volume.row_step_mm), ([0.0, 0.5, 0.0], [0.0, 0.0, -0.7]));
        for k in 0..5 {
            assert_eq!(volume.origins_mm[k], [20.0 - 4.0 * k as f64, -80.0, 50.5]);
            let levels: Vec<f32> = (0..6).map(|i| (10 * k + i) as f32 - 1.0).collect();
            assert_eq!(volume.slice(k).unwrap(), levels, "{syntax}, slice {k}");
            assert_eq!(file.files[k], folder.path().join(format!("{}", (k * 3) % 5)));
        }
        assert_eq!((file.format, file.notes.as_slice()), (VolumeFormat::DicomSeries, [].as_slice()));
        let o = Orientation::of(volume);
        assert_eq!(
            (o.plane, o.towards, o.right_handed),
            ("sagittal", ["posterior", "inferior", "right"], true)
        );
        names_nobody(&format!("{file:?} {}", describe(folder.path()).unwrap()));
    }
}

#[test]
fn levels_have_slope_intercept_bits_and_sign() {
    let level = |change: &dyn Fn(&mut InMemDicomObject)| {
        let mut o = slice(0);
        change(&mut o);
        read_volume(series([(0, o)]).path()).map(|file| file.volume.samples)
    };
    let slope = |o: &mut InMemDicomObject, slope: &str| {
        set(o, tags::RESCALE_SLOPE, VR::DS, slope);
        set(o, tags::RESCALE_INTERCEPT, VR::DS, "-1024");
    };
    assert_eq!(level(&|o| slope(o, "2")).unwrap(), [-1026.0, -1024.0, -1022.0, -1020.0, -1018.0, -1016.0]);
    assert_eq!(level(&|o| slope(o, "-0.5")).unwrap()[..2], [-1023.5, -1024.0]);
    assert_eq!(level(&|o| put(o, tags::PIXEL_REPRESENTATION, 0)).unwrap()[..2], [65535.0, 0.0]);
    // Twelve bits, stored high, an overlay in the low ones.
    let high = level(&|o| {
        put(o, tags::BITS_STORED, 12);
        pixels(o, &[-2048, -1, 0, 1, 2047, 5].map(|v: i16| (v << 4) | 0b1010));
    });
    assert_eq!(high.unwrap(), [-2048.0, -1.0, 0.0, 1.0, 2047.0, 5.0]);
    let bytes = level(&|o| {
        put(o, tags::BITS_ALLOCATED, 8);
        put(o, tags::BITS_STORED, 8);
        put(o, tags::HIGH_BIT, 7);
        o.put(DataElement::new(
            tags::PIXEL_DATA,
            VR::OB,
            PrimitiveValue::U8([0, 1, 127, 128, 255, 3].into_iter().collect()),
        ));
    });
    assert_eq!(bytes.unwrap(), [0.0, 1.0, 127.0, -128.0, -1.0, 3.0]);
    for bad in ["0", "x", "Secret^Walter"] {
        let text = level(&|o| slope(o, bad)).unwrap_err().to_string();
        assert!(
            text.contains("its RescaleSlope or RescaleIntercept is no number, or the slope is zero"),
            "{text}"
        );
        names_nobody(&text);
    }
}

fn moved(k: usize, place: f64) -> (usize, InMemDicomObject) {
    let mut o = slice(k);
    set(&mut o, tags::IMAGE_POSITION_PATIENT, VR::DS, &position(place));
    (k, o)
}

#[test]
fn gaps_copies_and_uneven_slices_are_noted() {
    let folder = series([0, 1, 2, 5, 6].map(|k| (k, slice(k))));
    let file = read_volume(folder.path()).unwrap();
    let gap = VolumeNote::Gap {
        before: "4.dcm".to_owned(),
        after: "5.dcm".to_owned(),
        apart_mm: 12.0,
        usual_mm: 4.0,
    };
    assert_eq!(file.notes, [gap]);
    let text = file.notes[0].to_string();
    assert!(text.contains("2 slice(s) missing between 4.dcm and 5.dcm: 12.000 mm, where 4.000"), "{text}");
    assert_eq!(file.volume.origins_mm[3], [0.0, -80.0, 50.5], "slices stay where they are");

    let folder = series([moved(0, 0.0), moved(1, 1.1), moved(2, 2.0), moved(3, 3.0)]);
    let notes = read_volume(folder.path()).unwrap().notes;
    let [VolumeNote::Uneven { least_mm, most_mm }] = notes[..] else { panic!("{notes:?}") };
    assert!((least_mm - 3.6).abs() < 1e-9 && (most_mm - 4.4).abs() < 1e-9, "{notes:?}");

    let folder = series((0..4).map(|k| (k, slice(k))));
    std::fs::copy(folder.path().join("7.dcm"), folder.path().join("copy.dcm")).unwrap();
    let file = read_volume(folder.path()).unwrap();
    let copy = VolumeNote::Copy { file: "copy.dcm".to_owned(), of: "7.dcm".to_owned() };
    assert_eq!((file.notes, file.volume.origins_mm.len()), (vec![copy], 4));
    // The same place and another picture.
    save(&folder, "copy.dcm", EXPLICIT_LITTLE, moved(3, 1.0).1);
    let text = message(folder.path());
    assert!(
        text.contains("7.dcm and") && text.contains("copy.dcm are two pictures of one place (-16.000 mm"),
        "{text}"
    );
    names_nobody(&text);

    let folder = series((0..3).map(|k| (k, slice(k))));
    let mut o = slice(0);
    for tag in [tags::PIXEL_DATA, tags::ROWS] {
        o.remove_element(tag);
    }
    save(&folder, "DICOMDIR", EXPLICIT_LITTLE, o);
    let mut o = slice(3);
    set(&mut o, tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "MONOCHROME1");
    set(&mut o, tags::IMAGE_POSITION_PATIENT, VR::DS, "8\\-80\\47.5");
    save(&folder, "1.dcm", EXPLICIT_LITTLE, o);
    let notes = read_volume(folder.path()).unwrap().notes;
    assert_eq!(
        notes[..2],
        [VolumeNote::NoPicture { files: vec!["DICOMDIR".to_owned()] }, VolumeNote::ShownInverted]
    );
    // 3 mm over 12: atan(0.25) = 14.04 degrees.
    assert!(
        matches!(notes[2], VolumeNote::Tilted { degrees } if (degrees - 14.036).abs() < 0.01),
        "{notes:?}"
    );
}

#[test]
fn slices_of_several_series_are_told_apart() {
    for (part, change) in [
        ("echo 5", (|o| set(o, tags::ECHO_NUMBERS, VR::IS, "5")) as fn(&mut InMemDicomObject)),
        ("2 x 2 px", |o| put(o, tags::COLUMNS, 2)),
        ("of 0.6 x 0.7 mm", |o| set(o, tags::PIXEL_SPACING, VR::DS, "0.7\\0.6")),
        ("axial", |o| set(o, tags::IMAGE_ORIENTATION_PATIENT, VR::DS, "1\\0\\0\\0\\1\\0")),
        ("oblique, 1.1 degrees from sagittal", |o| {
            set(o, tags::IMAGE_ORIENTATION_PATIENT, VR::DS, "0.02\\0.9998\\0\\0\\0\\-1");
        }),
        ("1 slice(s)", |o| set(o, tags::SERIES_INSTANCE_UID, VR::UI, "2.25.777")),
    ] {
        let mut other = slice(3);
        change(&mut other);
        let folder = series([(0, slice(0)), (1, slice(1)), (3, other)]);
        let error = read_volume(folder.path()).unwrap_err();
        let VolumeFileError::SeveralSeries { series, .. } = &error else { panic!("{error}") };
        assert_eq!(series.len(), 2);
        let text = error.to_string();
        assert!(
            text.contains("2 slice(s) of 3 x 2 px of 0.5 x 0.7 mm, sagittal, echo 2: 0.dcm to 7.dcm"),
            "{text}"
        );
        assert!(series[1].contains(part) && series[1].ends_with("1.dcm to 1.dcm"), "{part}: {text}");
        names_nobody(&format!("{text} {error:?}"));
    }
}

#[test]
fn what_is_no_series_says_why() {
    let text = |change: &dyn Fn(&mut InMemDicomObject)| {
        let mut o = slice(0);
        change(&mut o);
        let error = read_volume(series([(0, o)]).path()).unwrap_err();
        names_nobody(&format!("{error} {error:?}"));
        error.to_string()
    };
    let part = text(&|o| {
        o.remove_element(tags::IMAGE_POSITION_PATIENT);
    });
    assert!(part.contains("DICOM without a place in the patient"), "{part}");
    let part = text(&|o| set(o, tags::IMAGE_POSITION_PATIENT, VR::DS, "1\\2\\nan"));
    assert!(part.contains("DICOM without a place in the patient"), "{part}");
    let part = text(&|o| set(o, tags::IMAGE_ORIENTATION_PATIENT, VR::DS, "0\\1\\0\\0\\0.1\\1"));
    assert!(part.contains("no two unit vectors at right angles"), "{part}");
    let part = text(&|o| set(o, tags::PIXEL_SPACING, VR::DS, "0\\1"));
    assert!(part.contains("its PixelSpacing is missing, or none of a scanner"), "{part}");
    let part = text(&|o| {
        set(o, tags::NUMBER_OF_FRAMES, VR::IS, "2");
        pixels(o, &[0; 12]);
    });
    assert!(part.contains("DICOM of 2 frames in one file, whose places are not read"), "{part}");

    let folder = TempDir::new().unwrap();
    write(&folder, "a.nrrd", &[header("uint8", "raw", "").as_bytes(), &bytes24()]);
    let text = message(folder.path());
    assert!(text.contains("no DICOM slice among the 1 file(s)"), "{text}");
    let folder = series([(0, slice(0))]);
    let text = message(&folder.path().join("0.dcm"));
    assert!(text.contains("this is one DICOM file: name the folder of its series"), "{text}");
}

/// Reads what is left of a file after damage of every kind; gives how many of these fail. A panic fails the test.
fn damage(whole: &[u8], step: usize, read: impl Fn(&[u8]) -> Result<VolumeFile, VolumeFileError>) -> usize {
    let mut failed = 0;
    let mut check = |bytes: &[u8]| {
        let text = match read(bytes) {
            Ok(file) => {
                let Volume { columns, rows, ref origins_mm, ref samples, .. } = file.volume;
                assert_eq!(samples.len(), columns * rows * origins_mm.len());
                assert!(samples.iter().all(|v| v.is_finite()));
                format!("{} {:?}", file.stored, file.notes)
            }
            Err(error) => {
                failed += 1;
                format!("{error} {error:?}")
            }
        };
        names_nobody(&text);
    };
    for i in 0..50 {
        check(&whole[..whole.len() * i / 50]);
    }
    for at in (0..whole.len()).step_by(step) {
        for flip in [0x01, 0x20, 0x80, 0xff] {
            let mut bytes = whole.to_vec();
            bytes[at] ^= flip;
            check(&bytes);
        }
    }
    failed
}

#[test]
fn no_damage_makes_a_reader_panic_or_name_the_patient() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("broken");
    let read = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        read_volume(&path)
    };
    let short: Vec<u8> = (0..24_i16).flat_map(|v| v.to_be_bytes()).collect();
    let named = "endian: big\ndata file:\ncontent: Secret^Walter\npatient:=Secret^Walter\nkinds: domain domain domain";
    for (encoding, data) in [("raw", short.clone()), ("gzip", gzip(&short)), ("text", b"1 -2 ".repeat(12))] {
        let whole = [header("short", encoding, named).into_bytes(), data].concat();
        assert!(damage(&whole, 1, read) >= 50, "{encoding}");
    }
    let mut n = Nifti::new(true);
    n.sform(1, [[1.0, 0.0, 0.0, -10.0], [0.0, 2.0, 0.0, -20.0], [0.0, 0.0, 3.0, 30.0]]);
    n.qform(1, [0.1, 0.2, 0.3], [5.0, 6.0, 7.0]);
    let whole = [n.bytes.clone(), bytes24()].concat();
    assert!(damage(&whole, 1, read) >= 50);
    let packed = gzip(&whole);
    assert!(damage(&packed, 1, read) > 3 * packed.len(), "a gzip stream has a sum");
    // Of a series one slice is damaged.
    let folder = series((0..3).map(|k| (k, slice(k))));
    let path = folder.path().join("7.dcm");
    let whole = std::fs::read(&path).unwrap();
    let read = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        read_volume(folder.path())
    };
    assert!(damage(&whole, 1, read) >= 50);
}

#[test]
fn a_size_that_the_file_cannot_hold_takes_no_memory() {
    let folder = TempDir::new().unwrap();
    let text = |kind: &str, encoding: &str, sizes: &str, data: &[u8]| {
        let more = format!("endian: little\nsizes: {sizes}");
        message(&write(&folder, "a", &[header(kind, encoding, &more).as_bytes(), data]))
    };
    // More than 2^30 voxels, more than 64 bits count, more along an axis than is read.
    for sizes in ["1025 1024 1024", "4294967296 4294967296 4294967296", "1 1 65536"] {
        for encoding in ["raw", "gzip", "bzip2", "text", "hex"] {
            let text = text("double", encoding, sizes, &[0; 64]);
            assert!(text.contains("which a file of") || text.contains("or more than are read"), "{text}");
        }
    }
    // What would take 8 GiB as doubles.
    assert!(text("double", "raw", "1024 1024 1024", &[0; 64]).contains("cannot hold"));
    assert!(text("double", "gzip", "1024 1024 1024", &gzip(&[0; 4096])).contains("cannot hold"));
    // Within what deflate could hold, so that only reading tells.
    assert!(text("uint8", "gzip", "100 10 10", &gzip(&[0; 4096])).contains("4096 of 10000"));
    // A bomb: sixteen megabytes of zeros in sixteen kilobytes stop at what the header says.
    let bomb = gzip(&vec![0; 1 << 24]);
    assert!(
        bomb.len() < 1 << 15 && text("uint8", "gzip", "2 3 4", &bomb).contains("more than the 24 voxels")
    );
    // More to be decoded before the voxels than any file has there.
    for more in ["byte skip: 2000000000", "byte skip: 9000000000000000000"] {
        let text = message(&write(&folder, "a", &[header("uint8", "gzip", more).as_bytes(), &bomb]));
        assert!(text.contains("expected a number, or -1"), "{text}");
    }
    let mut n = Nifti::new(false);
    n.shorts(42, &[i16::MAX; 3]);
    assert!(message(&write(&folder, "a", &[&n.bytes])).contains("claims 32767 x 32767 x 32767 voxels"));
}

#[test]
fn volumes_are_described() {
    let folder = TempDir::new().unwrap();
    let path =
        write(&folder, "a", &[header("uint8", "raw", "space:").as_bytes(), &[[0; 12], [7; 12]].concat()]);
    let text = describe(&path).unwrap().to_string();
    for part in [
        "label map, NRRD",
        "2 x 3 x 4 voxels (columns x rows x slices)",
        "uint8, raw",
        "1.0000 x 2.0000 mm in a slice",
        "3.0000 mm apart",
        "orientation  axial",
        "columns go to left, rows to posterior, slices to superior",
        "1.0 x 4.0 x 9.0 mm",
        "10.0 to 11.0 mm",
        "0 to 7, mean 3.5",
        "label 0      12 voxels",
        "label 7      12 voxels",
        "does not say which way its axes run",
    ] {
        assert!(text.contains(part), "{part} not in: {text}");
    }
    // Turned about z by 12 degrees: cos = 0.9781, sin = 0.2079.
    let more = "space directions: (-0.2079,0.9781,0) (0,0,-1) (0.9781,0.2079,0)\nendian: little";
    let levels: Vec<u8> = (0..24).flat_map(|i| (i as f32 * 1.5).to_le_bytes()).collect();
    let path = write(&folder, "a", &[header("float", "raw", more).as_bytes(), &levels]);
    let text = describe(&path).unwrap().to_string();
    for part in ["volume, NRRD", "oblique, 12.0 degrees from sagittal", "left-handed", "0 to 34.5, mean 17.2"]
    {
        assert!(text.contains(part), "{part} not in: {text}");
    }
    let folder = series([0, 1, 3].map(|k| (k, slice(k))));
    let text = describe(folder.path()).unwrap().to_string();
    for part in ["volume, DICOM series", "16 bits, signed", "4.0000 to 8.0000 mm apart", "files        3"] {
        assert!(text.contains(part), "{part} not in: {text}");
    }
}

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

#[test]
fn one_ball_in_many_encodings_is_the_same_array() {
    let Some(folder) = data("real/nrrd") else { return };
    let raw = std::fs::read(folder.join("BallBinary30x30x30.raw")).unwrap();
    let levels: Vec<f32> = raw.chunks(2).map(|b| i16::from_le_bytes([b[0], b[1]]).into()).collect();
    for name in [
        "30x30x30.nhdr",
        "30x30x30.nrrd",
        "30x30x30.nii.gz",
        "30x30x30_byteskip_minus_one.nhdr",
        "30x30x30_byteskip_minus_one_nifti.nhdr",
        "30x30x30_bz2.nrrd",
        "30x30x30_gz.nrrd",
        "30x30x30_gz_byteskip_minus_one.nrrd",
        "30x30x30_gz_lineskip.nrrd",
    ] {
        let file = read_volume(folder.join(format!("BallBinary{name}"))).unwrap();
        assert!(file.volume.samples == levels, "{name}");
        assert_eq!(file.volume.place_mm(29.0, 29.0, 29), Some([29.0; 3]), "{name}: {:?}", file.notes);
    }
    // pynrrd, whose tests these files are, refuses these two as well: a skip that means nothing, and voxels that do not
    // start where they would have to.
    for (name, part) in [
        ("BallBinary30x30x30_byteskip_minus_five.nhdr", "found `-5`"),
        ("BallBinary30x30x30_nifti.nhdr", "holds more than the 27000 voxels"),
        ("test1d_ascii.nrrd", "1 axis"),
        ("test2d_ascii.nrrd", "2 axes"),
        ("test_simple4d_raw.nrrd", "4 axes"),
        ("test_customFields.nrrd", "1 axis"),
    ] {
        let text = message(&folder.join(name));
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn the_label_map_of_a_knee_lies_where_its_tibias_mesh_does() {
    let Some(folder) = data("real/knee-mri") else { return };
    let file = read_volume(folder.join("knee-labels.nrrd")).unwrap();
    let volume = &file.volume;
    assert_eq!((volume.columns, volume.rows, volume.origins_mm.len()), (384, 384, 160));
    let tibia = volume.samples.iter().filter(|v| **v == 6.0).count();
    assert_eq!(tibia, 1_089_712, "counted with NumPy");
    let text = describe(folder.join("knee-labels.nrrd")).unwrap().to_string();
    for part in [
        "label map, NRRD",
        "oblique, 5.0 degrees from sagittal",
        "label 5",
        "1532154 voxels",
        "0.3646 x 0.3646",
    ] {
        assert!(text.contains(part), "{part} not in: {text}");
    }
    // The mesh was made by others from label 6: the label's border passes by its corners.
    let mesh = std::fs::read_to_string(folder.join("tibia_mesh.vtk")).unwrap();
    let numbers: Vec<f64> = mesh
        .split_once("double\n")
        .unwrap()
        .1
        .split_whitespace()
        .take(30_000)
        .map(|v| v.parse().unwrap())
        .collect();
    let [column, row] = [volume.column_step_mm, volume.row_step_mm].map(Vector3::from);
    let [first, second] = [0, 1].map(|k| Vector3::from(volume.origins_mm[k]));
    let to_voxels = nalgebra::Matrix3::from_columns(&[column, row, second - first]).try_inverse().unwrap();
    let on_border = numbers.chunks(3).filter(|p| {
        let at = to_voxels * (Vector3::new(p[0], p[1], p[2]) - first);
        let near = (0..8).map(|corner| {
            let [i, j, k] = [0, 1, 2].map(|a| at[a].floor() as usize + (corner >> a & 1));
            volume.slice(k).unwrap()[j * 384 + i] == 6.0
        });
        let inside = near.filter(|inside| *inside).count();
        (1..8).contains(&inside)
    });
    let share = on_border.count() as f64 / 10_000.0;
    println!("{:.1} % of the mesh's corners are among voxels of both kinds", 100.0 * share);
    assert!(share > 0.8, "{share}");
}

#[test]
fn the_slices_of_a_real_knee_are_read_as_pydicom_reads_them() {
    let Some(folder) = data("real/knee-mri/dicom") else { return };
    let file = read_volume(&folder).unwrap();
    let volume = &file.volume;
    assert_eq!((volume.columns, volume.rows, volume.origins_mm.len()), (256, 256, 24));
    assert!(file.files[0].ends_with("E3655S8I002.MR.dcm") && file.files[23].ends_with("E3655S8I186.MR.dcm"));
    // Sums of slices, one level, and a position, with pydicom 3.0.
    let sums = [0, 1, 2].map(|k| volume.slice(k).unwrap().iter().map(|&v| f64::from(v)).sum::<f64>());
    assert_eq!(sums, [56_501_082.0, 57_503_929.0, 62_691_285.0]);
    assert_eq!(volume.slice(11).unwrap()[100 * 256 + 200], 1855.0);
    assert_eq!(volume.origins_mm[23], [-120.045, -105.714, 69.55]);
    let step: Vector3<f64> = volume.column_step_mm.into();
    assert!((step - Vector3::new(-0.0218343, 0.999511, 0.0224019) * 0.625).norm() < 1e-9);
    assert_eq!(file.notes, []);
    let text = describe(&folder).unwrap().to_string();
    for part in ["volume, DICOM series", "oblique, 8.4 degrees from sagittal", "3.9991 to 4.0005 mm apart"] {
        assert!(text.contains(part), "{part} not in: {text}");
    }
}

#[test]
fn simulated_scans_of_a_knee_are_read() {
    let Some(folder) = data("simulated/knee-natural/mri") else { return };
    // Levels and their means with NumPy.
    for (name, sizes, origin, mean, level) in [
        ("femur", [100, 200, 314], [-50.0, -50.0, -55.0], 105.587_632, 98.0),
        ("tibia", [96, 180, 268], [-48.0, -45.0, -112.0], 105.999_401, 108.0),
    ] {
        let file = read_volume(folder.join(format!("{name}.nrrd"))).unwrap();
        let volume = &file.volume;
        assert_eq!([volume.columns, volume.rows, volume.origins_mm.len()], sizes);
        assert_eq!((volume.origins_mm[0], volume.samples[12_345]), (origin, level));
        let sum: f64 = volume.samples.iter().map(|&v| f64::from(v)).sum();
        assert!((sum / volume.samples.len() as f64 - mean).abs() < 1e-6);
        assert_eq!(file.notes, []);
    }
}
