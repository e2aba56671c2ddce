//! Lists of frames by folder, pattern and file; and their pairing.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::path::Path;

use biplane_acquisition::frames::{FrameSource, PairBy, PairError, list_frames, pair};
use biplane_acquisition::images::read_frame;
use image::{GrayImage, Luma};
use tempfile::TempDir;
use tiff::encoder::{TiffEncoder, colortype};

fn picture(folder: &TempDir, name: &str) {
    let path = folder.path().join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    GrayImage::from_pixel(2, 2, Luma([1])).save_with_format(path, image::ImageFormat::Png).unwrap();
}

fn labels(sources: &[FrameSource]) -> Vec<&str> {
    sources.iter().map(|s| s.label.as_str()).collect()
}

fn name(source: &FrameSource) -> &str {
    source.path.file_name().unwrap().to_str().unwrap()
}

#[test]
fn folders_are_listed_in_natural_order_without_what_is_no_image() {
    let folder = TempDir::new().unwrap();
    for n in ["A/run2_10.png", "A/run2_9.png", "A/run2_100.png", "A/.hidden_1.png", "A/deeper/5.png"] {
        picture(&folder, n);
    }
    std::fs::write(folder.path().join("A/notes_7.txt"), "notes").unwrap();
    let frames = list_frames(folder.path(), "A").unwrap();
    assert_eq!(labels(&frames), ["9", "10", "100"]);
    assert_eq!(frames[1].number, Some(10));
    assert_eq!((frames[1].index_in_file, frames[1].time_s), (0, None));
}

#[test]
fn patterns_find_files_even_in_folders_with_brackets() {
    let folder = TempDir::new().unwrap();
    for n in ["study [1]/A/0003.png", "study [1]/A/0001.png", "study [1]/A/x.png", "study [1]/B/0002.png"] {
        picture(&folder, n);
    }
    let base = folder.path().join("study [1]");
    assert_eq!(labels(&list_frames(&base, "A/0*.png").unwrap()), ["0001", "0003"]);
    assert_eq!(labels(&list_frames(&base, "*/0*.png").unwrap()).len(), 3);
    let text = list_frames(&base, "C/*.png").unwrap_err().to_string();
    assert!(text.contains("no image in") && text.contains("C/*.png: 0 file(s)"), "{text}");
    let text = list_frames(&base, "C").unwrap_err().to_string();
    assert!(text.contains("is not there; frames are named by a folder, a pattern"), "{text}");
    let text = list_frames(&base, "A/[").unwrap_err().to_string();
    assert!(text.contains("is not a pattern of file names"), "{text}");
}

#[test]
fn the_number_is_the_last_run_of_digits_of_the_name() {
    let folder = TempDir::new().unwrap();
    for (file, number, label) in [
        ("L_Hop_Cam1_001_UND.0138.tif", Some(138), "0138"),
        ("run.0042", Some(42), "0042"),
        ("frame007b.mp3.png", Some(3), "3"),
        ("frame.png", None, "0000"),
        ("a99999999999999999999999.png", None, "0000"),
        ("Größe5ü.png", Some(5), "5"),
    ] {
        picture(&folder, file);
        let frames = list_frames(folder.path(), file).unwrap();
        assert_eq!((frames[0].number, frames[0].label.as_str()), (number, label), "{file}");
    }
}

#[test]
fn pages_of_a_file_are_numbered_by_their_place() {
    let folder = TempDir::new().unwrap();
    let mut encoder =
        TiffEncoder::new(std::fs::File::create(folder.path().join("run12.tif")).unwrap()).unwrap();
    for _ in 0..3 {
        encoder.write_image::<colortype::Gray8>(2, 2, &[0; 4]).unwrap();
    }
    drop(encoder);
    let frames = list_frames(folder.path(), "run12.tif").unwrap();
    assert_eq!(labels(&frames), ["0000", "0001", "0002"]);
    assert_eq!((frames[2].index_in_file, frames[2].number), (2, Some(2)));
}

fn view(view: &str, numbers: &[&str]) -> (String, Vec<FrameSource>) {
    let source = |digits: &&str| FrameSource {
        path: Path::new(view).join(format!("{digits}.tif")),
        index_in_file: 0,
        number: digits.parse().ok(),
        label: (*digits).to_owned(),
        time_s: Some(0.5),
    };
    (view.to_owned(), numbers.iter().map(source).collect())
}

#[test]
fn frames_pair_by_number_and_what_is_left_is_said() {
    let views = [
        view("A", &["010", "000", "020", "030"]),
        view("B", &["20", "0", "40", "41", "42", "43", "44", "45"]),
    ];
    let pairing = pair(&views, PairBy::Number, 0).unwrap();
    let found: Vec<(&str, &str, &str)> =
        pairing.pairs.iter().map(|p| (p.label.as_str(), name(&p.sources[0]), name(&p.sources[1]))).collect();
    assert_eq!(found, [("000", "000.tif", "0.tif"), ("020", "020.tif", "20.tif")]);
    assert_eq!(pairing.pairs[0].sources[1].time_s, Some(0.5));
    let said: Vec<String> = pairing.unpaired.iter().map(ToString::to_string).collect();
    assert_eq!(
        said[0],
        "2 frame(s) of view A are left out, since not every other view has the frame taken with them: 010, 030"
    );
    assert_eq!(
        said[1],
        "6 frame(s) of view B are left out, since not every other view has the frame taken with them: 40, 41, 42, 43, 44, ..."
    );
}

#[test]
fn an_offset_shifts_the_second_view() {
    let views = [view("A", &["1", "2", "3"]), view("B", &["4", "5", "6"])];
    let pairing = pair(&views, PairBy::Number, 3).unwrap();
    assert_eq!(pairing.pairs.len(), 3);
    assert_eq!(name(&pairing.pairs[0].sources[1]), "4.tif");
    let pairing = pair(&views, PairBy::Index, 1).unwrap();
    let found: Vec<(&str, &str)> =
        pairing.pairs.iter().map(|p| (p.label.as_str(), name(&p.sources[1]))).collect();
    assert_eq!(found, [("0000", "5.tif"), ("0001", "6.tif")]);
    assert_eq!(pairing.unpaired.iter().map(|u| u.count).collect::<Vec<_>>(), [1, 1]);
    assert_eq!(pair(&views, PairBy::Index, -1).unwrap().pairs[0].label, "0001");
    assert!(pair(&views, PairBy::Index, i64::MIN).is_err());
}

#[test]
fn any_number_of_views_pairs() {
    let views = [view("A", &["1", "2", "3"]), view("B", &["2", "3"]), view("C", &["3", "4", "2"])];
    let pairing = pair(&views, PairBy::Number, 0).unwrap();
    assert_eq!(pairing.pairs.iter().map(|p| p.label.as_str()).collect::<Vec<_>>(), ["2", "3"]);
    assert!(pairing.pairs.iter().all(|p| p.sources.len() == 3));
    assert_eq!(pair(&views[..1], PairBy::Number, 0).unwrap().pairs.len(), 3);
    assert!(pair(&[], PairBy::Number, 0).is_err());
}

#[test]
fn frames_that_do_not_pair_up_are_an_error_that_names_both_lists() {
    let views = [view("A", &["0001", "0002"]), view("B", &["101", "102"])];
    let text = pair(&views, PairBy::Number, 0).unwrap_err().to_string();
    assert!(
        text.contains("no frame of one view belongs to one of another (paired by number, offset 0)"),
        "{text}"
    );
    assert!(text.contains("view A has 2 frame(s): 0001, 0002; view B has 2 frame(s): 101, 102"), "{text}");
}

#[test]
fn a_number_twice_or_none_is_an_error_that_names_the_files() {
    let text =
        pair(&[view("A", &["7", "007"]), view("B", &["7"])], PairBy::Number, 0).unwrap_err().to_string();
    assert!(text.contains("view A") && text.contains("7.tif") && text.contains("007.tif"), "{text}");
    let views = [view("A", &["x"]), view("B", &["7"])];
    let error = pair(&views, PairBy::Number, 0).unwrap_err();
    assert!(matches!(&error, PairError::NoNumber { view, .. } if view == "A"));
    assert!(error.to_string().contains("x.tif has no number in its name"), "{error}");
    assert_eq!(pair(&views, PairBy::Index, 0).unwrap().pairs.len(), 1);
}

/// Fault: a TIFF cut short before its directory, and a file of zero bytes, stopped the whole list or were passed over.
#[test]
fn a_damaged_picture_among_others_is_one_frame_that_fails_when_it_is_read() {
    let folder = TempDir::new().unwrap();
    for n in ["A/1.png", "A/2.png", "A/5.png"] {
        picture(&folder, n);
    }
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    // The directory of this TIFF would lie at byte 1000.
    let cut = b"II*\0\xe8\x03\0\0 pixels";
    write("A/3.tif", cut);
    write("A/4.png", b"");
    let frames = list_frames(folder.path(), "A").unwrap();
    assert_eq!(labels(&frames), ["1", "2", "3", "4", "5"]);
    let why = |i: usize| read_frame(&frames[i].path, 0).unwrap_err().to_string();
    assert!(why(2).contains("3.tif: the picture is cut short"), "{}", why(2));
    assert!(why(3).contains("4.png is empty"), "{}", why(3));
    assert!(read_frame(&frames[4].path, 0).is_ok());

    // Where the list hangs on it, it is an error.
    assert!(
        list_frames(folder.path(), "A/3.tif").is_err() && list_frames(folder.path(), "A/[34].*").is_err()
    );
    let mut stack = Vec::new();
    let mut encoder = TiffEncoder::new(std::io::Cursor::new(&mut stack)).unwrap();
    for _ in 0..2 {
        encoder.write_image::<colortype::Gray8>(2, 2, &[0; 4]).unwrap();
    }
    write("A/6.tif", &stack);
    let text = list_frames(folder.path(), "A").unwrap_err().to_string();
    assert!(text.contains("3.tif"), "{text}");
}
