//! Pictures made here, written in every format, read back; and every way a picture can be bad, with its message.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use std::io::Cursor;
use std::path::{Path, PathBuf};

use biplane_acquisition::images::{ImageError, ImageFile, ImageFormat, read_frame};
use image::{GrayImage, ImageBuffer, Luma, Rgb, RgbImage};
use tempfile::TempDir;
use tiff::encoder::{Compression, TiffEncoder, colortype};
use tiff::tags::Tag;

const WIDTH: u32 = 7;
const HEIGHT: u32 = 5;

/// Levels that differ at every pixel.
fn level(x: u32, y: u32) -> u8 {
    (y * 40 + x * 5) as u8
}

fn grey8() -> Vec<u8> {
    (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| level(x, y))).collect()
}

fn grey16() -> Vec<u16> {
    grey8().into_iter().map(|v| u16::from(v) * 256 + 3).collect()
}

fn wide(bytes: &[u8]) -> Vec<u16> {
    bytes.iter().map(|&b| u16::from(b)).collect()
}

fn write(folder: &TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn encoded(picture: impl Into<image::DynamicImage>, format: image::ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.into().write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

fn message(path: &Path) -> String {
    read_frame(path, 0).unwrap_err().to_string()
}

/// A little-endian TIFF of one strip, from its tags: what an encoder would not write.
fn raw_tiff(bits: u16, photometric: u16, format: u16, size: [u32; 2], data: &[u8]) -> Vec<u8> {
    let tags: [(u16, u16, u32); 10] = [
        (256, 4, size[0]),
        (257, 4, size[1]),
        (258, 3, bits.into()),
        (259, 3, 1),
        (262, 3, photometric.into()),
        (273, 4, 8 + 2 + 10 * 12 + 4),
        (277, 3, 1),
        (278, 4, size[1]),
        (279, 4, data.len() as u32),
        (339, 3, format.into()),
    ];
    let mut bytes = b"II*\0\x08\0\0\0".to_vec();
    bytes.extend((tags.len() as u16).to_le_bytes());
    for (tag, kind, value) in tags {
        bytes.extend(tag.to_le_bytes());
        bytes.extend(kind.to_le_bytes());
        bytes.extend(1_u32.to_le_bytes());
        bytes.extend(value.to_le_bytes());
    }
    bytes.extend([0; 4]);
    bytes.extend(data);
    bytes
}

fn tiff_of(compression: Compression, write: impl FnOnce(&mut TiffEncoder<&mut Cursor<Vec<u8>>>)) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).unwrap().with_compression(compression);
    write(&mut encoder);
    bytes.into_inner()
}

#[test]
fn grey_of_8_and_16_bits_comes_back_from_png() {
    let folder = TempDir::new().unwrap();
    let png = image::ImageFormat::Png;
    let picture = GrayImage::from_raw(WIDTH, HEIGHT, grey8()).unwrap();
    // The name lies about the format: content counts.
    let path = write(&folder, "a.tif", &encoded(picture, png));
    let mut file = ImageFile::open(&path).unwrap();
    let info = file.info();
    assert_eq!((info.format, info.width, info.height), (ImageFormat::Png, 7, 5));
    assert_eq!((info.bits, info.frames, info.rate_hz), (8, 1, None));
    let frame = file.frame(0).unwrap();
    assert_eq!((frame.width, frame.height, frame.bits), (7, 5, 8));
    assert_eq!(frame.samples, wide(&grey8()));

    let picture: ImageBuffer<Luma<u16>, _> = ImageBuffer::from_raw(WIDTH, HEIGHT, grey16()).unwrap();
    let frame = read_frame(write(&folder, "b", &encoded(picture, png)), 0).unwrap();
    assert_eq!((frame.samples, frame.bits), (grey16(), 16));
    assert!(matches!(read_frame(&path, 1), Err(ImageError::NoSuchFrame { index: 1, frames: 1, .. })));
}

#[test]
fn grey_stored_as_colour_is_read_and_colour_is_refused() {
    let folder = TempDir::new().unwrap();
    let mut picture = RgbImage::from_fn(WIDTH, HEIGHT, |x, y| Rgb([level(x, y); 3]));
    for (name, format) in [("a.png", image::ImageFormat::Png), ("a.bmp", image::ImageFormat::Bmp)] {
        let frame = read_frame(write(&folder, name, &encoded(picture.clone(), format)), 0).unwrap();
        assert_eq!((frame.samples, frame.bits), (wide(&grey8()), 8), "{name}");
    }
    picture.put_pixel(3, 2, Rgb([12, 40, 33]));
    let text = message(&write(&folder, "colour.png", &encoded(picture, image::ImageFormat::Png)));
    assert!(text.contains("colour.png"), "{text}");
    assert!(text.contains("at pixel (3, 2) red, green and blue are 12 40 33"), "{text}");
}

#[test]
fn jpeg_is_read_and_a_jpeg_cut_short_is_refused() {
    let folder = TempDir::new().unwrap();
    let picture = GrayImage::from_fn(64, 64, |x, y| Luma([(x * 2 + y) as u8]));
    let bytes = encoded(picture.clone(), image::ImageFormat::Jpeg);
    let frame = read_frame(write(&folder, "a.jpg", &bytes), 0).unwrap();
    let worst =
        frame.samples.iter().zip(picture.as_raw()).map(|(a, b)| a.abs_diff((*b).into())).max().unwrap();
    assert!(worst <= 8, "{worst}");
    let text = message(&write(&folder, "b.jpg", &bytes[..bytes.len() * 2 / 3]));
    assert!(text.contains("b.jpg: the picture is cut short"), "{text}");
}

#[test]
fn a_png_cut_short_says_so() {
    let folder = TempDir::new().unwrap();
    let picture = GrayImage::from_fn(64, 64, |x, y| Luma([(x * y) as u8]));
    let bytes = encoded(picture, image::ImageFormat::Png);
    let text = message(&write(&folder, "cut.png", &bytes[..bytes.len() / 2]));
    assert!(text.contains("cut.png: the picture is"), "{text}");
    assert!(text.contains("cut short") || text.contains("end of file"), "{text}");
}

#[test]
fn tiff_pages_of_every_compression_come_back() {
    let folder = TempDir::new().unwrap();
    let compressions = [
        Compression::Uncompressed,
        Compression::Lzw,
        Compression::Deflate(Default::default()),
        Compression::Packbits,
    ];
    for (i, compression) in compressions.into_iter().enumerate() {
        let bytes = tiff_of(compression, |e| {
            for page in 0..3 {
                let samples: Vec<u16> = grey16().iter().map(|v| v + page).collect();
                e.write_image::<colortype::Gray16>(WIDTH, HEIGHT, &samples).unwrap();
            }
        });
        let mut file = ImageFile::open(write(&folder, &format!("{i}.tif"), &bytes)).unwrap();
        assert_eq!((file.info().format, file.info().frames, file.info().bits), (ImageFormat::Tiff, 3, 16));
        // Backwards, and one twice: pages do not depend on the order they are asked for.
        for page in [2, 0, 1, 1] {
            let expected: Vec<u16> = grey16().iter().map(|v| v + page as u16).collect();
            assert_eq!(file.frame(page).unwrap().samples, expected, "compression {i}, page {page}");
        }
        let text = file.frame(3).unwrap_err().to_string();
        assert!(text.contains("has 3 frame(s); number 3, counted from 0, is not there"), "{text}");

        let rgb: Vec<u8> = grey8().into_iter().flat_map(|v| [v; 3]).collect();
        let bytes = tiff_of(compression, |e| e.write_image::<colortype::RGB8>(WIDTH, HEIGHT, &rgb).unwrap());
        let frame = read_frame(write(&folder, "rgb.tif", &bytes), 0).unwrap();
        assert_eq!((frame.samples, frame.bits), (wide(&grey8()), 8));
    }
}

#[test]
fn white_is_zero_is_turned_round() {
    let folder = TempDir::new().unwrap();
    let size = [WIDTH, HEIGHT];
    let expected: Vec<u16> = grey8().iter().map(|&v| 255 - u16::from(v)).collect();
    let path = write(&folder, "white8.tif", &raw_tiff(8, 0, 1, size, &grey8()));
    assert_eq!(read_frame(path, 0).unwrap().samples, expected);
    let bytes: Vec<u8> = grey16().iter().flat_map(|v| v.to_le_bytes()).collect();
    let expected: Vec<u16> = grey16().iter().map(|&v| 65535 - v).collect();
    let path = write(&folder, "white16.tif", &raw_tiff(16, 0, 1, size, &bytes));
    assert_eq!(read_frame(path, 0).unwrap().samples, expected);
    let path = write(&folder, "black8.tif", &raw_tiff(8, 1, 1, size, &grey8()));
    assert_eq!(read_frame(path, 0).unwrap().samples, wide(&grey8()));
}

#[test]
fn a_truncated_tiff_says_so() {
    let folder = TempDir::new().unwrap();
    let whole = raw_tiff(8, 1, 1, [64, 64], &[7; 64 * 64]);
    let cut = &whole[..whole.len() - 1000];
    let text = message(&write(&folder, "0017.tif", cut));
    assert!(text.contains("0017.tif: the picture is cut short"), "{text}");
    assert!(text.contains(&format!("ends after {} bytes", cut.len())), "{text}");
    assert!(text.contains("copy it again"), "{text}");
    // Also where the directory itself is gone.
    let text = message(&write(&folder, "head.tif", &whole[..60]));
    assert!(text.contains("head.tif: the picture is"), "{text}");
}

#[test]
fn kinds_of_tiff_that_are_not_read_are_named() {
    let folder = TempDir::new().unwrap();
    let cases = [
        (raw_tiff(32, 1, 3, [2, 2], &[0; 16]), "32-bit floating-point"),
        (raw_tiff(32, 1, 1, [2, 2], &[0; 16]), "32-bit numbers"),
        (raw_tiff(16, 1, 2, [2, 2], &[0; 8]), "signed 16-bit"),
        (raw_tiff(8, 3, 1, [2, 2], &[0; 4]), "Palette"),
    ];
    for (bytes, what) in cases {
        let text = message(&write(&folder, "a.tif", &bytes));
        assert!(text.contains(what), "{text}");
        assert!(text.contains("save it as 8- or 16-bit grey"), "{text}");
    }
}

#[test]
fn a_size_that_the_file_cannot_hold_takes_no_memory() {
    let folder = TempDir::new().unwrap();
    for size in [[u32::MAX, u32::MAX], [1 << 14, 1 << 13], [0, 5]] {
        let path = write(&folder, "bomb.tif", &raw_tiff(8, 1, 1, size, &[0; 100]));
        let error = ImageFile::open(&path).unwrap_err();
        assert!(matches!(error, ImageError::Impossible { .. } | ImageError::Damaged { .. }), "{error}");
    }
}

#[test]
fn pages_must_have_one_size_and_thumbnails_are_left_out() {
    let folder = TempDir::new().unwrap();
    let bytes = tiff_of(Compression::Uncompressed, |e| {
        e.write_image::<colortype::Gray8>(WIDTH, HEIGHT, &grey8()).unwrap();
        e.write_image::<colortype::Gray8>(2, 2, &[1, 2, 3, 4]).unwrap();
    });
    let text = message(&write(&folder, "a.tif", &bytes));
    assert!(text.contains("page 1 has 2 x 2 pixels, the first one 7 x 5"), "{text}");

    let bytes = tiff_of(Compression::Uncompressed, |e| {
        let mut small = e.new_image::<colortype::Gray8>(2, 2).unwrap();
        small.encoder().write_tag(Tag::NewSubfileType, 1_u32).unwrap();
        small.write_data(&[1, 2, 3, 4]).unwrap();
        e.write_image::<colortype::Gray8>(WIDTH, HEIGHT, &grey8()).unwrap();
    });
    let mut file = ImageFile::open(write(&folder, "b.tif", &bytes)).unwrap();
    assert_eq!(file.info().frames, 1);
    assert_eq!(file.frame(0).unwrap().samples, wide(&grey8()));
}

#[test]
fn twelve_bits_in_sixteen_are_known_by_the_tag() {
    let folder = TempDir::new().unwrap();
    let samples: Vec<u16> = grey8().into_iter().map(|v| u16::from(v) * 16).collect();
    let bytes = tiff_of(Compression::Uncompressed, |e| {
        let mut page = e.new_image::<colortype::Gray16>(WIDTH, HEIGHT).unwrap();
        page.encoder().write_tag(Tag::MaxSampleValue, 4095_u16).unwrap();
        page.write_data(&samples).unwrap();
    });
    let mut file = ImageFile::open(write(&folder, "a.tif", &bytes)).unwrap();
    assert_eq!((file.info().bits, file.frame(0).unwrap().bits), (12, 12));
    assert_eq!(file.frame(0).unwrap().samples, samples);
}

#[test]
fn a_stack_of_imagej_beyond_4_gb_is_refused() {
    let folder = TempDir::new().unwrap();
    let bytes = tiff_of(Compression::Uncompressed, |e| {
        let mut page = e.new_image::<colortype::Gray8>(WIDTH, HEIGHT).unwrap();
        page.encoder().write_tag(Tag::ImageDescription, "ImageJ=1.53\nimages=9000\nslices=9000\n").unwrap();
        page.write_data(&grey8()).unwrap();
    });
    let text = message(&write(&folder, "a.tif", &bytes));
    assert!(text.contains("the first of 9000 that ImageJ says it wrote"), "{text}");
}

#[test]
fn what_is_no_image_is_named_by_its_first_bytes() {
    let folder = TempDir::new().unwrap();
    let text = message(&write(&folder, "notes.png", b"hello there, this is text"));
    assert!(
        text.contains("notes.png is not an image this program reads: it starts with the bytes 68 65 6c"),
        "{text}"
    );
    let text = message(&write(&folder, "empty.png", b""));
    assert!(text.contains("empty.png is empty (0 bytes)"), "{text}");
    let text = message(&folder.path().join("gone.png"));
    assert!(text.contains("cannot read") && text.contains("gone.png"), "{text}");
}

#[test]
fn no_damage_makes_a_reader_panic() {
    let folder = TempDir::new().unwrap();
    let grey = GrayImage::from_fn(32, 24, |x, y| Luma([(x * y) as u8]));
    let pages = |c| {
        tiff_of(c, |e| {
            for _ in 0..2 {
                e.write_image::<colortype::Gray8>(32, 24, grey.as_raw()).unwrap();
            }
        })
    };
    let originals = [
        encoded(grey.clone(), image::ImageFormat::Png),
        encoded(grey.clone(), image::ImageFormat::Bmp),
        encoded(grey.clone(), image::ImageFormat::Jpeg),
        pages(Compression::Uncompressed),
        pages(Compression::Lzw),
        pages(Compression::Deflate(Default::default())),
        pages(Compression::Packbits),
    ];
    // A small generator of its own: the same damage in every run.
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    };
    for original in &originals {
        for round in 0..300 {
            let mut bytes = original.clone();
            if round % 3 == 0 {
                bytes.truncate(random(bytes.len()));
            }
            for _ in 0..round % 5 {
                if !bytes.is_empty() {
                    let at = random(bytes.len());
                    bytes[at] = random(256) as u8;
                }
            }
            let path = write(&folder, "damaged", &bytes);
            if let Ok(mut file) = ImageFile::open(&path) {
                for index in 0..file.info().frames.min(3) {
                    if let Ok(frame) = file.frame(index) {
                        assert_eq!(frame.samples.len(), frame.width * frame.height);
                    }
                }
            }
        }
    }
}
