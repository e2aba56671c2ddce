//! NIfTI-1 in one file (`.nii`, `.nii.gz`), after `nifti1.h` of the NIMH Data Format Working Group: 348 bytes of header,
//! extensions, and from `vox_offset` on the voxels.
//!
//! The world of NIfTI is right-anterior-superior; both first coordinates are turned round. The sform is used where there is
//! one, else the qform, else the voxel sizes alone, and a note says which. Not read: pairs of `.hdr` and `.img`, Analyze 7.5,
//! NIfTI-2, several volumes in one file, colour and complex samples. Text of the header is not looked at.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use super::grid::Grid;
use super::samples::{Encoding, Layout, SampleType, decoded, fault, is_gzip};
use super::{START, Source, VolumeFile, VolumeFileError, VolumeFormat, VolumeNote};

const ADVICE: &str = "save one volume of grey levels or labels as NIfTI-1 (.nii, .nii.gz) or NRRD";
/// Placements that differ by less have the same meaning: floats of 24 bits, some hundred mm away, mm.
const SAME_MM: f64 = 0.01;

/// Whether a file, unpacked, starts like NIfTI: the size of its header, in either byte order, and what names it.
pub(super) fn is_nifti(start: &[u8]) -> bool {
    let named = |at: usize, name: &[u8]| start.get(at..at + 3) == Some(name);
    let header = Header(start, false);
    let sized = |size: i32| [header.long(0), Header(start, true).long(0)].contains(&Some(size));
    (sized(348) && (named(344, b"n+1") || named(344, b"ni1")))
        || (sized(540) && (named(4, b"n+2") || named(4, b"ni2")))
}

/// Bytes of a header, and whether the highest one of a number comes first.
#[derive(Clone, Copy)]
struct Header<'a>(&'a [u8], bool);

impl Header<'_> {
    fn bytes<const N: usize>(self, at: usize) -> Option<[u8; N]> {
        let mut bytes: [u8; N] = self.0.get(at..at + N)?.try_into().ok()?;
        if self.1 {
            bytes.reverse();
        }
        Some(bytes)
    }

    fn long(self, at: usize) -> Option<i32> {
        self.bytes(at).map(i32::from_le_bytes)
    }

    /// A 16-bit number; of a whole header.
    fn short(self, at: usize) -> i64 {
        self.bytes(at).map_or(0, i16::from_le_bytes).into()
    }

    /// A 32-bit float; of a whole header.
    fn float(self, at: usize) -> f64 {
        self.bytes(at).map_or(f32::NAN, f32::from_le_bytes).into()
    }
}

pub(super) fn read(path: &Path) -> Result<VolumeFile, VolumeFileError> {
    let source = Source(path);
    let io = |e| source.io(e);
    let file = File::open(path).map_err(io)?;
    let length = file.metadata().map_err(io)?.len();
    let mut file = BufReader::new(file);
    let packed = is_gzip(file.fill_buf().map_err(io)?);
    let encoding = if packed { Encoding::Gzip } else { Encoding::Raw };
    let mut stream = BufReader::new(decoded(file, encoding));
    let mut start = [0; START];
    let header_cut = |e: io::Error| match e.kind() {
        io::ErrorKind::UnexpectedEof => {
            source.damaged("it ends within its header; copy it again from where it was made")
        }
        _ => fault(source, e, 0, 0),
    };
    stream.read_exact(&mut start).map_err(header_cut)?;
    let header = Header(&start, Header(&start, false).long(0) != Some(348));
    if header.long(0) != Some(348) {
        return Err(source.unsupported("NIfTI-2", ADVICE));
    }
    if start.get(344..347) != Some(b"n+1") {
        return Err(source.unsupported("one of a pair of files (.hdr, .img)", ADVICE));
    }
    let layout = layout(source, header)?;
    layout.check(source, encoding, length)?;
    let (grid, mut notes) = grid(source, header, &layout)?;
    notes.extend(grid.check(source)?);
    // Some programs write 0 where the voxels follow the header.
    let offset = header.float(108).max(352.0);
    if offset.fract() != 0.0 || offset > 1e9 {
        return Err(source.damaged(format!("its voxels would start at byte {offset}")));
    }
    let skipped = offset as u64 - START as u64;
    let passed = io::copy(&mut stream.by_ref().take(skipped), &mut io::sink()).map_err(header_cut)?;
    if passed < skipped {
        return Err(header_cut(io::ErrorKind::UnexpectedEof.into()));
    }
    let samples = layout.read(source, stream)?;
    if samples.rounded > 0 {
        notes.push(VolumeNote::Rounded { voxels: samples.rounded });
    }
    let order = if header.1 { "big" } else { "little" };
    let stored = format!("{}, {order}-endian{}", layout.kind.name(), if packed { ", gzip" } else { "" });
    let volume = grid.volume(&layout, samples);
    Ok(VolumeFile { volume, format: VolumeFormat::Nifti, stored, files: vec![path.to_owned()], notes })
}

fn layout(source: Source<'_>, header: Header<'_>) -> Result<Layout, VolumeFileError> {
    let dim: [i64; 8] = std::array::from_fn(|i| header.short(40 + 2 * i));
    let axes = dim[0];
    if !(1..=7).contains(&axes) {
        return Err(source.damaged(format!("it claims {axes} axes")));
    }
    let further: i64 = dim[1..=axes as usize].iter().skip(3).map(|&n| n.max(0)).fold(1, i64::saturating_mul);
    if axes < 3 || further != 1 {
        let what = if axes < 3 {
            format!("NIfTI of {axes} axes")
        } else {
            format!("NIfTI of {further} volumes, or of several values a voxel")
        };
        return Err(source.unsupported(what, ADVICE));
    }
    let sizes = [1, 2, 3].map(|i| u64::try_from(dim[i]).unwrap_or(0));
    let kind = match header.short(70) {
        2 => SampleType::Uint8,
        4 => SampleType::Int16,
        8 => SampleType::Int32,
        16 => SampleType::Float,
        64 => SampleType::Double,
        256 => SampleType::Int8,
        512 => SampleType::Uint16,
        768 => SampleType::Uint32,
        1024 => SampleType::Int64,
        1280 => SampleType::Uint64,
        other => {
            let what = match other {
                1 => "bits".to_owned(),
                128 | 2304 => "colours".to_owned(),
                32 | 1792 | 2048 => "complex numbers".to_owned(),
                1536 => "floats of 128 bits".to_owned(),
                _ => format!("the unknown type {other}"),
            };
            return Err(source.unsupported(format!("NIfTI whose samples are {what}"), ADVICE));
        }
    };
    let bits = header.short(72);
    if bits != 8 * kind.bytes() as i64 {
        return Err(
            source.damaged(format!("its header says {bits} bits for samples of type {}", kind.name()))
        );
    }
    let (slope, intercept) = (header.float(112), header.float(116));
    // A slope of zero is none (nifti1.h).
    let scaled = slope != 0.0 && slope.is_finite() && intercept.is_finite();
    let (slope, intercept) = if scaled { (slope, intercept) } else { (1.0, 0.0) };
    Ok(Layout { sizes, kind, big_endian: header.1, slope, intercept })
}

/// The placement that is used, and what is to be said of it.
fn grid(
    source: Source<'_>,
    header: Header<'_>,
    layout: &Layout,
) -> Result<(Grid, Vec<VolumeNote>), VolumeFileError> {
    let units = header.0.get(123).map_or(0, |units| units & 0x07);
    let scale = match units {
        0 | 2 => 1.0,
        1 => 1000.0,
        3 => 0.001,
        other => return Err(source.damaged(format!("its unit of length has the unknown code {other}"))),
    };
    let sizes: [f64; 3] = std::array::from_fn(|i| header.float(80 + 4 * i).abs());
    let lps = |ras: Vector3<f64>| Vector3::new(-ras.x, -ras.y, ras.z) * scale;
    let placed = |origin: Vector3<f64>, axes: Matrix3<f64>| Grid {
        origin: lps(origin),
        steps: [0, 1, 2].map(|i| lps(axes.column(i).into())),
    };
    let (qform_code, sform_code) = (header.short(252), header.short(254));
    let qform = (qform_code > 0).then(|| {
        let [b, c, d] = [256, 260, 264].map(|at| header.float(at));
        // Three of four numbers are stored; rounding may leave nothing for the first.
        let a = (1.0 - b * b - c * c - d * d).max(0.0).sqrt();
        let turn = UnitQuaternion::new_normalize(Quaternion::new(a, b, c, d)).to_rotation_matrix();
        let handed = if header.float(76) < 0.0 { -1.0 } else { 1.0 };
        let origin = Vector3::from([268, 272, 276].map(|at| header.float(at)));
        let scaled = Vector3::new(sizes[0], sizes[1], sizes[2] * handed);
        placed(origin, turn.matrix() * Matrix3::from_diagonal(&scaled))
    });
    let sform = (sform_code > 0).then(|| {
        let entry = |row: usize, column: usize| header.float(280 + 16 * row + 4 * column);
        placed(Vector3::from([0, 1, 2].map(|row| entry(row, 3))), Matrix3::from_fn(entry))
    });
    let (form, code, grid) = match (&sform, &qform) {
        (Some(grid), _) => ("sform", sform_code, *grid),
        (None, Some(grid)) => ("qform", qform_code, *grid),
        (None, None) => {
            let axes = Matrix3::from_diagonal(&Vector3::from(sizes));
            ("pixdim", 0, placed(Vector3::zeros(), axes))
        }
    };
    let space = match code {
        0 => {
            "which says neither where it is nor which way it lies: taken as right-anterior-superior from (0, 0, 0)"
        }
        1 => "the scanner's frame",
        2 => "a frame aligned with something else, which need not be the scanner's",
        3 => "the space of Talairach's atlas: lengths are not those of the body",
        4 => "the MNI space: lengths are not those of the body",
        _ => "a template's space: lengths need not be those of the body",
    };
    let mut notes = vec![VolumeNote::PlacedBy { form, space }];
    if let (Some(s), Some(q)) = (&sform, &qform) {
        let mm = (0..8).map(|corner| {
            let place = |g: &Grid| {
                (0..3)
                    .filter(|axis| corner >> axis & 1 == 1)
                    .fold(g.origin, |p, axis| p + g.steps[axis] * (layout.sizes[axis] as f64 - 1.0))
            };
            (place(s) - place(q)).norm()
        });
        let mm = mm.fold(0.0, f64::max);
        if mm > SAME_MM {
            notes.push(VolumeNote::FormsDiffer { mm });
        }
    }
    Ok((grid, notes))
}
