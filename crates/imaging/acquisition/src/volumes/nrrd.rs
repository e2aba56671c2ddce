//! NRRD, attached and detached, after the definition of the format by the Teem project
//! (<https://teem.sourceforge.net/nrrd/format.html>), versions 1 to 5.
//!
//! Read: three axes, all types but `block`, the encodings raw, gzip, bzip2, text and hex, both byte orders, `line skip` (before
//! decoding) and `byte skip` (after it; -1: the voxels end the data). The spaces LPS, RAS and LAS become LPS. Not read: other
//! numbers of axes, axes of vectors or colours, left-handed spaces, lengths other than mm, several data files. Key/value pairs
//! (`key:=value`) and fields that place no voxel (`content`, `thicknesses`, `measurement frame`...) are passed over.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use nalgebra::Vector3;

use super::grid::Grid;
use super::samples::{Encoding, Layout, SampleType, Samples, decoded, fault};
use super::{Source, VolumeFile, VolumeFileError, VolumeFormat, VolumeNote};

pub(super) const MAGIC: &[u8] = b"NRRD000";
/// Bytes of a header.
const MAX_HEADER: u64 = 1 << 20;
/// Bytes, or lines, before the voxels.
const MAX_SKIPPED: u64 = 1 << 30;
const ADVICE: &str = "save one volume of three axes with one value a voxel";
/// The fields that are read, in lower case without blanks: older files write `datafile` for `data file`.
const READ: [&str; 15] = [
    "type",
    "dimension",
    "sizes",
    "encoding",
    "endian",
    "kinds",
    "space",
    "spacedimension",
    "spacedirections",
    "spaceorigin",
    "spaceunits",
    "spacings",
    "lineskip",
    "byteskip",
    "datafile",
];

struct Field {
    /// Counted from 1.
    line: usize,
    value: String,
}

struct Header<'a> {
    source: Source<'a>,
    fields: BTreeMap<&'static str, Field>,
    lines: usize,
    /// Byte after the empty line that ends the header, if there is one.
    end: Option<u64>,
}

pub(super) fn read(path: &Path) -> Result<VolumeFile, VolumeFileError> {
    let source = Source(path);
    let file = File::open(path).map_err(|e| source.io(e))?;
    let header = Header::read(source, BufReader::new(file))?;
    let mut layout = header.layout()?;
    let (grid, mut notes) = header.grid()?;
    notes.extend(grid.check(source)?);
    let (data, start) = header.data()?;
    let source = Source(&data);
    let encoding = header.encoding()?;
    let order = header.order(layout.kind, encoding)?;
    layout.big_endian = order == Some(true);
    let io = |e| source.io(e);
    let length = File::open(&data).and_then(|file| file.metadata()).map_err(io)?.len();
    layout.check(source, encoding, length)?;
    let samples = header.samples(source, start, &layout, encoding)?;
    if samples.rounded > 0 {
        notes.push(VolumeNote::Rounded { voxels: samples.rounded });
    }
    let order = order.map_or("", |big| if big { ", big-endian" } else { ", little-endian" });
    let stored = format!("{}{order}, {}", layout.kind.name(), name(encoding));
    let volume = grid.volume(&layout, samples);
    let mut files = vec![path.to_owned()];
    if data != path {
        files.push(data.clone());
    }
    Ok(VolumeFile { volume, format: VolumeFormat::Nrrd, stored, files, notes })
}

fn name(encoding: Encoding) -> &'static str {
    match encoding {
        Encoding::Raw => "raw",
        Encoding::Gzip => "gzip",
        Encoding::Bzip2 => "bzip2",
        Encoding::Text => "text",
        Encoding::Hex => "hex",
    }
}

impl<'a> Header<'a> {
    fn read(source: Source<'a>, file: impl BufRead) -> Result<Self, VolumeFileError> {
        let mut header = Self { source, fields: BTreeMap::new(), lines: 0, end: None };
        let mut file = file.take(MAX_HEADER);
        let (mut at, mut bytes) = (0, Vec::new());
        loop {
            bytes.clear();
            let read = file.read_until(b'\n', &mut bytes).map_err(|e| source.io(e))?;
            at += read as u64;
            if read == 0 {
                if at >= MAX_HEADER {
                    return Err(source.damaged(format!("its header has more than {MAX_HEADER} bytes")));
                }
                return Ok(header);
            }
            header.lines += 1;
            let line = String::from_utf8_lossy(&bytes);
            let line = line.trim_end_matches(['\n', '\r']);
            if header.lines == 1 {
                let version = line.strip_prefix("NRRD000").and_then(|v| v.trim().parse::<u32>().ok());
                if !version.is_some_and(|v| (1..=5).contains(&v)) {
                    let what = "NRRD of a version other than 1 to 5 (its first line says which)";
                    return Err(source.unsupported(what, "save it as NRRD0004 or NRRD0005"));
                }
            } else if line.trim().is_empty() {
                header.end = Some(at);
                return Ok(header);
            } else {
                header.line(line)?;
            }
        }
    }

    fn line(&mut self, line: &str) -> Result<(), VolumeFileError> {
        if line.starts_with('#') {
            return Ok(());
        }
        let number = self.lines;
        let wrong = |expected: &str, found: &str| VolumeFileError::Line {
            path: self.source.path(),
            line: number,
            expected: expected.to_owned(),
            found: found.to_owned(),
        };
        // What stands there is not shown: it may name someone.
        let (name, value) = line.split_once(':').ok_or_else(|| {
            wrong(
                "`field: value`, `key:=value`, `#` and a comment, or an empty line before the voxels",
                "a line without `:`",
            )
        })?;
        if value.starts_with('=') {
            return Ok(());
        }
        let name: String = name.chars().filter(|c| !c.is_whitespace()).collect::<String>().to_lowercase();
        let Some(name) = READ.iter().find(|known| **known == name) else { return Ok(()) };
        let value = value.trim();
        // `LIST` and a name a line, or a pattern with its first number, its last one and its step.
        if *name == "datafile"
            && (value.starts_with("LIST") || (value.contains('%') && value.split_whitespace().count() > 3))
        {
            let what = "NRRD whose voxels are in several files";
            return Err(self.source.unsupported(what, "save it as one file (.nrrd)"));
        }
        let field = Field { line: number, value: value.to_owned() };
        match self.fields.insert(name, field) {
            None => Ok(()),
            Some(first) => {
                Err(wrong("each field once", &format!("`{name}` again, which is in line {} too", first.line)))
            }
        }
    }

    fn value(&self, name: &str) -> Option<&str> {
        self.fields.get(name).map(|field| field.value.as_str())
    }

    /// A field whose value is not what it has to be.
    fn wrong(&self, name: &str, expected: impl Into<String>) -> VolumeFileError {
        let (line, found) = match self.fields.get(name) {
            // Where a line's end is damaged, the next field has run into this one, and may name someone.
            Some(Field { line, value }) if value.contains(':') => {
                (*line, "two fields in one line".to_owned())
            }
            Some(Field { line, value }) => {
                (*line, format!("`{}`", value.chars().take(60).collect::<String>()))
            }
            None => (self.lines, format!("the header's end without `{name}`")),
        };
        VolumeFileError::Line { path: self.source.path(), line, expected: expected.into(), found }
    }

    fn layout(&self) -> Result<Layout, VolumeFileError> {
        let expected = "`type:` and the name of a type, such as `short` or `uint8`";
        let kind = match self.value("type").unwrap_or_default().to_lowercase().as_str() {
            "signed char" | "int8" | "int8_t" => SampleType::Int8,
            "uchar" | "unsigned char" | "uint8" | "uint8_t" => SampleType::Uint8,
            "short" | "short int" | "signed short" | "signed short int" | "int16" | "int16_t" => {
                SampleType::Int16
            }
            "ushort" | "unsigned short" | "unsigned short int" | "uint16" | "uint16_t" => SampleType::Uint16,
            "int" | "signed int" | "int32" | "int32_t" => SampleType::Int32,
            "uint" | "unsigned int" | "uint32" | "uint32_t" => SampleType::Uint32,
            "longlong"
            | "long long"
            | "long long int"
            | "signed long long"
            | "signed long long int"
            | "int64"
            | "int64_t" => SampleType::Int64,
            "ulonglong" | "unsigned long long" | "unsigned long long int" | "uint64" | "uint64_t" => {
                SampleType::Uint64
            }
            "float" => SampleType::Float,
            "double" => SampleType::Double,
            "block" => return Err(self.source.unsupported("NRRD whose samples are blocks of bytes", ADVICE)),
            _ => return Err(self.wrong("type", expected)),
        };
        let dimension = self.value("dimension").and_then(|v| v.parse::<u32>().ok());
        let dimension = dimension.ok_or_else(|| self.wrong("dimension", "`dimension: 3`"))?;
        if dimension != 3 {
            let axes = if dimension == 1 { "axis" } else { "axes" };
            return Err(self.source.unsupported(format!("NRRD of {dimension} {axes}, not three"), ADVICE));
        }
        for kind in self.value("kinds").unwrap_or_default().split_whitespace() {
            if !["domain", "space", "none", "???"].contains(&kind.to_lowercase().as_str()) {
                let what =
                    "NRRD with an axis that is none of space (`kinds` names vectors, colours or times)";
                return Err(self.source.unsupported(what, ADVICE));
            }
        }
        let sizes: Option<Vec<u64>> =
            self.value("sizes").unwrap_or_default().split_whitespace().map(|v| v.parse().ok()).collect();
        let sizes = sizes.and_then(|s| <[u64; 3]>::try_from(s).ok());
        let sizes = sizes.ok_or_else(|| self.wrong("sizes", "`sizes:` and three whole numbers"))?;
        Ok(Layout { sizes, kind, big_endian: false, slope: 1.0, intercept: 0.0 })
    }

    fn encoding(&self) -> Result<Encoding, VolumeFileError> {
        Ok(match self.value("encoding").unwrap_or_default().to_lowercase().as_str() {
            "raw" => Encoding::Raw,
            "gz" | "gzip" => Encoding::Gzip,
            "bz2" | "bzip2" => Encoding::Bzip2,
            "txt" | "text" | "ascii" => Encoding::Text,
            "hex" => Encoding::Hex,
            _ => return Err(self.wrong("encoding", "`encoding:` and one of raw, gzip, bzip2, text, hex")),
        })
    }

    /// Whether the highest byte comes first; `None` where samples have one byte, or are text.
    fn order(&self, kind: SampleType, encoding: Encoding) -> Result<Option<bool>, VolumeFileError> {
        if kind.bytes() == 1 || encoding == Encoding::Text {
            return Ok(None);
        }
        match self.value("endian").unwrap_or_default().to_lowercase().as_str() {
            "little" => Ok(Some(false)),
            "big" => Ok(Some(true)),
            _ => Err(self.wrong("endian", "`endian: little` or `endian: big`")),
        }
    }

    /// A number of lines or bytes that are skipped, at least `least`; 0 where nothing is said.
    fn skip(&self, name: &str, least: i64) -> Result<i64, VolumeFileError> {
        let Some(value) = self.value(name) else { return Ok(0) };
        let expected = if least < 0 { "a number, or -1 for voxels at the end" } else { "a number" };
        let most = MAX_SKIPPED as i64;
        value.parse().ok().filter(|n| (least..=most).contains(n)).ok_or_else(|| self.wrong(name, expected))
    }

    /// The file of the voxels, and the byte where its lines begin.
    fn data(&self) -> Result<(PathBuf, u64), VolumeFileError> {
        let Some(name) = self.value("datafile") else {
            let end = self.end.ok_or_else(|| {
                self.wrong(
                    "datafile",
                    "an empty line and the voxels, or `data file:` and the name of their file",
                )
            })?;
            return Ok((self.source.path(), end));
        };
        // Unlike `C:\`, a colon and a blank are of another field.
        if name.is_empty() || name.contains(": ") {
            return Err(self.wrong("datafile", "`data file:` and a name"));
        }
        Ok((self.source.0.parent().unwrap_or(Path::new("")).join(name), 0))
    }

    /// Reads the samples of a file, from what begins at the byte `start`.
    fn samples(
        &self,
        data: Source<'_>,
        start: u64,
        layout: &Layout,
        encoding: Encoding,
    ) -> Result<Samples, VolumeFileError> {
        let io = |e| data.io(e);
        let open = || -> Result<_, VolumeFileError> {
            let mut file = BufReader::new(File::open(data.0).map_err(io)?);
            file.seek(SeekFrom::Start(start)).map_err(io)?;
            for line in 0..self.skip("lineskip", 0)? {
                if file.skip_until(b'\n').map_err(io)? == 0 {
                    return Err(
                        data.damaged(format!("it ends after {line} of the lines that its header skips"))
                    );
                }
            }
            Ok(BufReader::new(decoded(file, encoding)))
        };
        let failed = |e| fault(data, e, 0, layout.voxels());
        // Where text ends says nothing of where it begins.
        let least = if encoding == Encoding::Text { 0 } else { -1 };
        let skipped = match u64::try_from(self.skip("byteskip", least)?) {
            Ok(skipped) => skipped,
            // All that comes before the voxels at the end; it is decoded twice, so that none of it has to be kept.
            Err(_) => {
                let limit = layout.bytes() + MAX_SKIPPED + 1;
                let whole = io::copy(&mut open()?.take(limit), &mut io::sink()).map_err(failed)?;
                if whole == limit {
                    return Err(data.damaged(format!("more than {MAX_SKIPPED} bytes come before its voxels")));
                }
                whole.saturating_sub(layout.bytes())
            }
        };
        let mut stream = open()?;
        io::copy(&mut stream.by_ref().take(skipped), &mut io::sink()).map_err(failed)?;
        if encoding == Encoding::Text { layout.read_text(data, stream) } else { layout.read(data, stream) }
    }

    fn grid(&self) -> Result<(Grid, Vec<VolumeNote>), VolumeFileError> {
        let mut notes = Vec::new();
        let lefthanded = |space: &str| {
            self.source.unsupported(
                format!("NRRD of the space `{space}`, which is not the patient's"),
                "save it with `space: left-posterior-superior`",
            )
        };
        let signs = match self.value("space").map(str::to_lowercase).as_deref() {
            Some("left-posterior-superior" | "lps") => [1.0, 1.0, 1.0],
            Some("right-anterior-superior" | "ras") => [-1.0, -1.0, 1.0],
            Some("left-anterior-superior" | "las") => [1.0, -1.0, 1.0],
            Some(known @ ("3d-left-handed" | "3dl")) => return Err(lefthanded(known)),
            None | Some("scanner-xyz" | "3d-right-handed" | "3dr") => {
                notes.push(VolumeNote::UnknownSpace);
                [1.0, 1.0, 1.0]
            }
            Some(_) => {
                return Err(self.wrong(
                    "space",
                    "a space of three axes: left-posterior-superior, \
                     right-anterior-superior or left-anterior-superior",
                ));
            }
        };
        if self.value("spacedimension").is_some_and(|v| v != "3") {
            return Err(self.wrong("spacedimension", "`space dimension: 3`"));
        }
        if let Some(units) = self.value("spaceunits")
            && units.split('"').map(str::trim).any(|u| !["", "mm", "millimeter", "millimetre"].contains(&u))
        {
            return Err(self.wrong("spaceunits", "`\"mm\" \"mm\" \"mm\"`: convert it to mm"));
        }
        let turned = |v: [f64; 3]| Vector3::new(v[0] * signs[0], v[1] * signs[1], v[2] * signs[2]);
        let expected = "three vectors such as `(1,0,0) (0,1,0) (0,0,1)`";
        let steps = match self.value("spacedirections") {
            Some(text) => {
                let steps = vectors(text).and_then(|v| <[[f64; 3]; 3]>::try_from(v).ok());
                steps.ok_or_else(|| self.wrong("spacedirections", expected))?.map(turned)
            }
            None => {
                let spacings: Option<Vec<f64>> = self
                    .value("spacings")
                    .unwrap_or_default()
                    .split_whitespace()
                    .map(|v| v.parse().ok().filter(|v: &f64| v.is_finite()))
                    .collect();
                let spacings = spacings.and_then(|s| <[f64; 3]>::try_from(s).ok()).ok_or_else(|| {
                    let name = if self.value("spacings").is_some() { "spacings" } else { "spacedirections" };
                    self.wrong(
                        name,
                        format!("`space directions:` and {expected}, or `spacings:` and three numbers, mm"),
                    )
                })?;
                notes.push(VolumeNote::SpacingsAlone);
                let [x, y, z] = spacings;
                [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]].map(turned)
            }
        };
        let origin = match self.value("spaceorigin") {
            Some(text) => {
                let origin = vectors(text).and_then(|v| <[[f64; 3]; 1]>::try_from(v).ok());
                turned(origin.ok_or_else(|| self.wrong("spaceorigin", "a vector such as `(0,0,0)`"))?[0])
            }
            None => {
                notes.push(VolumeNote::NoOrigin);
                Vector3::zeros()
            }
        };
        Ok((Grid { origin, steps }, notes))
    }
}

/// Vectors of three numbers in round brackets.
fn vectors(text: &str) -> Option<Vec<[f64; 3]>> {
    let mut vectors = Vec::new();
    let mut rest = text.trim();
    while !rest.is_empty() {
        let (inside, after) = rest.strip_prefix('(')?.split_once(')')?;
        let numbers: Option<Vec<f64>> = inside.split(',').map(|v| v.trim().parse().ok()).collect();
        vectors.push(<[f64; 3]>::try_from(numbers?).ok()?);
        rest = after.trim_start();
    }
    Some(vectors)
}
