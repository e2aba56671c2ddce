//! DICOM objects made here: polarity, bits, signs, frame times, byte orders; and no patient in anything that comes out.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::path::PathBuf;

use biplane_acquisition::images::{ImageFile, ImageFormat, read_frame};
use biplane_acquisition::inspect::describe;
use dicom_core::{DataElement, PrimitiveValue, VR, dicom_value};
use dicom_dictionary_std::tags;
use dicom_object::{FileMetaTableBuilder, InMemDicomObject};
use tempfile::TempDir;

const EXPLICIT_LITTLE: &str = "1.2.840.10008.1.2.1";
const IMPLICIT_LITTLE: &str = "1.2.840.10008.1.2";
const EXPLICIT_BIG: &str = "1.2.840.10008.1.2.2";
const PATIENT: &str = "Secret^Walter";
const BIRTH: &str = "19450203";

const ROWS: u16 = 3;
const COLUMNS: u16 = 4;
const FRAMES: usize = 3;

/// Sample `i` of frame `f`, of 10 bits.
fn sample(frame: usize, i: usize) -> u16 {
    (frame * 300 + i * 7) as u16
}

fn all_samples() -> Vec<u16> {
    (0..FRAMES).flat_map(|f| (0..12).map(move |i| sample(f, i))).collect()
}

fn object() -> InMemDicomObject {
    let mut o = InMemDicomObject::new_empty();
    let mut text = |tag, vr, value: &str| o.put(DataElement::new(tag, vr, PrimitiveValue::from(value)));
    text(tags::PATIENT_NAME, VR::PN, PATIENT);
    text(tags::PATIENT_ID, VR::LO, "MRN-0815");
    text(tags::PATIENT_BIRTH_DATE, VR::DA, BIRTH);
    text(tags::INSTITUTION_NAME, VR::LO, "Secret Hospital");
    text(tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "MONOCHROME1");
    text(tags::NUMBER_OF_FRAMES, VR::IS, "3");
    text(tags::FRAME_TIME, VR::DS, "33.333");
    let mut number = |tag, value: u16| o.put(DataElement::new(tag, VR::US, PrimitiveValue::from(value)));
    number(tags::SAMPLES_PER_PIXEL, 1);
    number(tags::ROWS, ROWS);
    number(tags::COLUMNS, COLUMNS);
    number(tags::BITS_ALLOCATED, 16);
    number(tags::BITS_STORED, 10);
    number(tags::HIGH_BIT, 9);
    number(tags::PIXEL_REPRESENTATION, 0);
    // A sequence that names the patient again, nested.
    let mut item = InMemDicomObject::new_empty();
    item.put(DataElement::new(tags::PATIENT_NAME, VR::PN, PrimitiveValue::from(PATIENT)));
    o.put(DataElement::new(
        tags::REFERENCED_PATIENT_SEQUENCE,
        VR::SQ,
        dicom_core::value::DataSetSequence::from(vec![item]),
    ));
    pixels(&mut o, &all_samples());
    o
}

fn pixels(o: &mut InMemDicomObject, samples: &[u16]) {
    o.put(DataElement::new(tags::PIXEL_DATA, VR::OW, PrimitiveValue::U16(samples.iter().copied().collect())));
}

fn set(o: &mut InMemDicomObject, tag: dicom_object::Tag, vr: VR, value: impl Into<PrimitiveValue>) {
    o.put(DataElement::new(tag, vr, value.into()));
}

fn save(folder: &TempDir, name: &str, syntax: &str, object: InMemDicomObject) -> PathBuf {
    let path = folder.path().join(name);
    let meta = FileMetaTableBuilder::new()
        .transfer_syntax(syntax)
        .media_storage_sop_class_uid("1.2.840.10008.5.1.4.1.1.12.1")
        .media_storage_sop_instance_uid("1.2.3.4.5.6.7.8.9");
    object.with_meta(meta).unwrap().write_to_file(&path).unwrap();
    path
}

#[test]
fn frames_polarity_and_times_are_read_in_every_byte_order() {
    let folder = TempDir::new().unwrap();
    for syntax in [EXPLICIT_LITTLE, IMPLICIT_LITTLE, EXPLICIT_BIG] {
        let path = save(&folder, "run", syntax, object());
        let mut file = ImageFile::open(&path).unwrap();
        let info = file.info().clone();
        assert_eq!((info.format, info.width, info.height), (ImageFormat::Dicom, 4, 3));
        assert_eq!((info.bits, info.frames), (10, 3));
        assert!((info.rate_hz.unwrap() - 30.0003).abs() < 1e-4);
        assert!((info.times_s[2] - 0.066_666).abs() < 1e-9, "{:?}", info.times_s);
        for f in [2, 0, 1] {
            let frame = file.frame(f).unwrap();
            let expected: Vec<u16> = (0..12).map(|i| 1023 - sample(f, i)).collect();
            assert_eq!((frame.samples, frame.bits), (expected, 10), "{syntax}, frame {f}");
        }
        assert!(file.frame(3).is_err());
    }
}

#[test]
fn bytes_of_eight_bits_are_read() {
    let folder = TempDir::new().unwrap();
    let mut o = object();
    set(&mut o, tags::BITS_ALLOCATED, VR::US, 8_u16);
    set(&mut o, tags::BITS_STORED, VR::US, 8_u16);
    set(&mut o, tags::HIGH_BIT, VR::US, 7_u16);
    set(&mut o, tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "MONOCHROME2");
    let bytes: Vec<u8> = (0..36).map(|i| i * 3).collect();
    set(&mut o, tags::PIXEL_DATA, VR::OB, PrimitiveValue::U8(bytes.into_iter().collect()));
    let path = save(&folder, "run", EXPLICIT_LITTLE, o);
    let frame = read_frame(path, 1).unwrap();
    assert_eq!((frame.samples, frame.bits), ((12..24).map(|i| i * 3).collect(), 8));
}

#[test]
fn bits_signs_and_slopes_are_taken_into_account() {
    let folder = TempDir::new().unwrap();
    // 12 bits stored high in 16, an overlay in the low bits; signed; a slope that turns the polarity round.
    let mut o = object();
    set(&mut o, tags::BITS_STORED, VR::US, 12_u16);
    set(&mut o, tags::HIGH_BIT, VR::US, 15_u16);
    set(&mut o, tags::PIXEL_REPRESENTATION, VR::US, 1_u16);
    set(&mut o, tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "MONOCHROME2");
    set(&mut o, tags::NUMBER_OF_FRAMES, VR::IS, "1");
    let signed: Vec<i16> = vec![-2048, -1, 0, 1, 2047, 5, 6, 7, 8, 9, 10, 11];
    let stored: Vec<u16> = signed.iter().map(|v| ((*v as u16) << 4) | 0b1010).collect();
    pixels(&mut o, &stored);
    let expected: Vec<u16> = signed.iter().map(|v| (v + 2048) as u16).collect();
    let frame = read_frame(save(&folder, "a", EXPLICIT_LITTLE, o.clone()), 0).unwrap();
    assert_eq!((&frame.samples, frame.bits), (&expected, 12));
    set(&mut o, tags::RESCALE_SLOPE, VR::DS, "-2.5");
    set(&mut o, tags::RESCALE_INTERCEPT, VR::DS, "100");
    let frame = read_frame(save(&folder, "b", EXPLICIT_LITTLE, o), 0).unwrap();
    assert_eq!(frame.samples, expected.iter().map(|v| 4095 - v).collect::<Vec<u16>>());
}

#[test]
fn times_come_from_the_best_element_there_is() {
    let folder = TempDir::new().unwrap();
    let info = |o: &InMemDicomObject| {
        ImageFile::open(save(&folder, "run", EXPLICIT_LITTLE, o.clone())).unwrap().info().clone()
    };
    let mut o = object();
    o.put(DataElement::new(tags::FRAME_TIME_VECTOR, VR::DS, dicom_value!(Strs, ["0", "10", "30"])));
    let found = info(&o);
    assert_eq!(found.times_s, vec![0.0, 0.01, 0.04]);
    assert_eq!(found.rate_hz, Some(50.0));
    o.remove_element(tags::FRAME_TIME_VECTOR);
    o.remove_element(tags::FRAME_TIME);
    assert_eq!((info(&o).rate_hz, info(&o).times_s), (None, vec![]));
    set(&mut o, tags::RECOMMENDED_DISPLAY_FRAME_RATE, VR::IS, "20");
    assert_eq!(info(&o).rate_hz, Some(20.0));
    set(&mut o, tags::CINE_RATE, VR::IS, "25");
    assert_eq!(info(&o).times_s, vec![0.0, 0.04, 0.08]);
}

/// Everything of the patient that the objects hold.
fn names_nobody(text: &str) {
    for secret in [PATIENT, "Secret", "Walter", BIRTH, "MRN", "0815", "1.2.3.4.5.6.7.8.9"] {
        assert!(!text.contains(secret), "`{secret}` in: {text}");
    }
}

#[test]
fn no_patient_is_named_in_results_messages_or_damage() {
    let folder = TempDir::new().unwrap();
    let path = save(&folder, "run", EXPLICIT_LITTLE, object());
    let whole = std::fs::read(&path).unwrap();
    let name = |bytes: &[u8]| bytes.windows(PATIENT.len()).filter(|w| *w == PATIENT.as_bytes()).count();
    assert_eq!(name(&whole), 2, "the file does name the patient, twice");

    let mut file = ImageFile::open(&path).unwrap();
    let frame = file.frame(0).unwrap();
    let error = file.frame(9).unwrap_err();
    names_nobody(&format!("{file:?} {:?} {frame:?} {error:?} {error}", file.info()));
    names_nobody(&describe(&path).unwrap().to_string());

    // Whatever breaks, and wherever: cut at every byte, and every byte of the header turned.
    let mut failed = 0;
    let mut check = |bytes: &[u8]| {
        let path = folder.path().join("broken");
        std::fs::write(&path, bytes).unwrap();
        let text = match ImageFile::open(&path) {
            Err(e) => format!("{e} {e:?}"),
            Ok(mut file) => match file.frame(0) {
                Err(e) => format!("{e} {e:?} {file:?}"),
                Ok(_) => return,
            },
        };
        failed += 1;
        names_nobody(&text);
    };
    for cut in 0..whole.len() {
        check(&whole[..cut]);
    }
    for at in 128..whole.len() - 72 {
        for flip in [0x01, 0x80, 0xff] {
            let mut bytes = whole.clone();
            bytes[at] ^= flip;
            check(&bytes);
        }
    }
    assert!(failed > whole.len(), "{failed} of them failed");
}

#[test]
fn wrong_values_in_the_header_are_named_without_their_text() {
    let folder = TempDir::new().unwrap();
    let message = |change: &dyn Fn(&mut InMemDicomObject)| {
        let mut o = object();
        change(&mut o);
        let text = read_frame(save(&folder, "run", EXPLICIT_LITTLE, o), 0).unwrap_err().to_string();
        names_nobody(&text);
        text
    };
    // A patient's name where a number or a word should be.
    let text = message(&|o| set(o, tags::PHOTOMETRIC_INTERPRETATION, VR::CS, PATIENT));
    assert!(text.contains("neither MONOCHROME1 nor MONOCHROME2"), "{text}");
    let text = message(&|o| {
        o.remove_element(tags::ROWS);
    });
    assert!(text.contains("no Rows"), "{text}");
    let text = message(&|o| set(o, tags::BITS_STORED, VR::US, 17_u16));
    assert!(text.contains("17 bits stored of 16"), "{text}");
    let text = message(&|o| set(o, tags::BITS_ALLOCATED, VR::US, 32_u16));
    assert!(text.contains("32 bits a pixel"), "{text}");
    let text = message(&|o| set(o, tags::SAMPLES_PER_PIXEL, VR::US, 3_u16));
    assert!(text.contains("colour"), "{text}");
    let text = message(&|o| set(o, tags::NUMBER_OF_FRAMES, VR::IS, "2000000000"));
    assert!(text.contains("cut short"), "{text}");
}

fn put_fragments(o: &mut InMemDicomObject, offsets: Vec<u32>, fragments: Vec<Vec<u8>>) {
    let pixels = dicom_core::value::PixelFragmentSequence::new(offsets, fragments);
    o.put(DataElement::new(tags::PIXEL_DATA, VR::OB, pixels));
}

/// The object with 8-bit samples of another size.
fn object8(columns: u16, rows: u16, frames: &str) -> InMemDicomObject {
    let mut o = object();
    for (tag, value) in [
        (tags::BITS_ALLOCATED, 8),
        (tags::BITS_STORED, 8),
        (tags::HIGH_BIT, 7),
        (tags::COLUMNS, columns),
        (tags::ROWS, rows),
    ] {
        set(&mut o, tag, VR::US, value);
    }
    set(&mut o, tags::NUMBER_OF_FRAMES, VR::IS, frames);
    o
}

#[test]
fn big_endian_words_of_two_samples_are_read_at_odd_places() {
    let folder = TempDir::new().unwrap();
    // 3 x 3 samples a frame: the second one starts in the middle of a word.
    let mut o = object8(3, 3, "3");
    let bytes: Vec<u8> = (0..28).collect();
    let words: Vec<u16> = bytes.chunks(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect();
    pixels(&mut o, &words);
    for syntax in [EXPLICIT_BIG, EXPLICIT_LITTLE] {
        let path = save(&folder, "run", syntax, o.clone());
        for frame in 0..3 {
            let expected: Vec<u16> = (0..9).map(|i| 255 - (9 * frame + i)).collect();
            assert_eq!(
                read_frame(&path, usize::from(frame)).unwrap().samples,
                expected,
                "{syntax}, frame {frame}"
            );
        }
    }
}

#[test]
fn run_length_encoded_frames_are_read() {
    let folder = TempDir::new().unwrap();
    // PS3.5 annex G: 16 numbers (segments, offsets), then runs; here one literal run of 12 bytes and padding.
    let frame = |f: u8| {
        let mut bytes: Vec<u8> = [1_u32, 64].iter().flat_map(|v| v.to_le_bytes()).collect();
        bytes.resize(64, 0);
        bytes.push(11);
        bytes.extend((0..12).map(|i| f * 50 + i));
        bytes.push(128);
        bytes
    };
    let mut o = object8(4, 3, "3");
    put_fragments(&mut o, vec![], vec![frame(0), frame(1), frame(2)]);
    let path = save(&folder, "run", "1.2.840.10008.1.2.5", o);
    let mut file = ImageFile::open(path).unwrap();
    for f in [1, 0, 2] {
        let expected: Vec<u16> = (0..12).map(|i| 255 - (f as u16 * 50 + i)).collect();
        assert_eq!(file.frame(f).unwrap().samples, expected);
    }
}

#[test]
fn jpeg_frames_in_pieces_are_put_together_and_their_size_is_checked() {
    let folder = TempDir::new().unwrap();
    const JPEG: &str = "1.2.840.10008.1.2.4.50";
    let picture =
        |f: u32| image::GrayImage::from_fn(32, 24, |x, y| image::Luma([(x * 3 + y + f * 60) as u8]));
    let jpeg = |f| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        picture(f).write_to(&mut bytes, image::ImageFormat::Jpeg).unwrap();
        let mut bytes = bytes.into_inner();
        bytes.resize(bytes.len().next_multiple_of(2), 0);
        bytes
    };
    let mut fragments = Vec::new();
    let (mut offsets, mut at) = (Vec::new(), 0);
    for f in 0..2 {
        offsets.push(at);
        let bytes = jpeg(f);
        for piece in [&bytes[..100], &bytes[100..]] {
            at += 8 + piece.len() as u32;
            fragments.push(piece.to_vec());
        }
    }
    let mut o = object8(32, 24, "2");
    put_fragments(&mut o, offsets, fragments.clone());
    let path = save(&folder, "run", JPEG, o.clone());
    for f in 0..2 {
        let frame = read_frame(&path, f).unwrap();
        let expected = picture(f as u32);
        let worst = frame.samples.iter().zip(expected.as_raw()).map(|(a, b)| a.abs_diff(255 - u16::from(*b)));
        assert!(worst.max().unwrap() <= 8, "frame {f}");
    }
    // Without the table nobody knows where a frame starts.
    put_fragments(&mut o, vec![], fragments.clone());
    let text = read_frame(save(&folder, "run", JPEG, o), 0).unwrap_err().to_string();
    assert!(text.contains("cut to pieces without a table"), "{text}");
    let mut o = object8(16, 24, "1");
    put_fragments(&mut o, vec![], fragments[..2].to_vec());
    let text = read_frame(save(&folder, "run", JPEG, o), 0).unwrap_err().to_string();
    assert!(text.contains("its header says 16 x 24 pixels, its JPEG 32 x 24"), "{text}");
    // JPEG-LS is not decoded, and named.
    let mut o = object8(32, 24, "1");
    put_fragments(&mut o, vec![], fragments[..2].to_vec());
    let text = read_frame(save(&folder, "run", "1.2.840.10008.1.2.4.80", o), 0).unwrap_err().to_string();
    assert!(text.contains("transfer syntax 1.2.840.10008.1.2.4.80) cannot be decoded"), "{text}");
}

#[test]
fn sequences_without_end_and_lengths_without_bounds_are_harmless() {
    let folder = TempDir::new().unwrap();
    let path = save(&folder, "run", EXPLICIT_LITTLE, object());
    let whole = std::fs::read(&path).unwrap();
    // A sequence in a sequence in a sequence, a hundred thousand deep, with and without its ends.
    let open = [
        [8, 0, 0x40, 0x11, b'S', b'Q', 0, 0, 0xff, 0xff, 0xff, 0xff].as_slice(),
        &[0xfe, 0xff, 0x00, 0xe0, 0xff, 0xff, 0xff, 0xff],
    ]
    .concat();
    let close = [0xfe, 0xff, 0x0d, 0xe0, 0, 0, 0, 0, 0xfe, 0xff, 0xdd, 0xe0, 0, 0, 0, 0];
    let deep = 100_000;
    let head = &whole[..whole.windows(2).position(|w| w == b"CS").unwrap() - 4];
    let tail = &whole[head.len()..];
    let balanced = [head, &open.repeat(deep), &close.repeat(deep), tail].concat();
    std::fs::write(&path, balanced).unwrap();
    assert_eq!(ImageFile::open(&path).unwrap().info().frames, 3);
    std::fs::write(&path, [head, &open.repeat(deep)].concat()).unwrap();
    assert!(ImageFile::open(&path).is_err());
    std::fs::write(&path, [head, &close, tail].concat()).unwrap();
    let text = ImageFile::open(&path).unwrap_err().to_string();
    assert!(text.contains("cannot be followed beyond byte"), "{text}");
    // An element that claims four gigabytes.
    let huge = [8, 0, 0x41, 0x11, b'U', b'T', 0, 0, 0xf0, 0xff, 0xff, 0xff];
    std::fs::write(&path, [head, &huge, tail].concat()).unwrap();
    let text = ImageFile::open(&path).unwrap_err().to_string();
    assert!(text.contains("cannot be followed beyond byte"), "{text}");
}
