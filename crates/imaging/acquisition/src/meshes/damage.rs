//! Every file of `tests/data` cut at every byte, and with bytes and words exchanged by a seeded generator: no panic, no memory for what a header
//! only claims, and what is still read is a sound mesh.

use std::path::Path;

use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{LengthUnit, MeshFile, MeshFileError, of_bytes};

/// Words that damage likes to make: large counts, signs, ends.
const WORDS: [&[u8]; 12] = [
    b"99999999999",
    b"4294967295",
    b"-1",
    b"1e308",
    b"nan",
    b"\xff\xff\xff\xff\xff\xff\xff\xff",
    b"\x7f\xff\xff\xff",
    b"\0\0\0\0",
    b"\n",
    b" ",
    b"#",
    b"0",
];

fn read(bytes: &[u8]) -> Result<MeshFile, MeshFileError> {
    let file = of_bytes(Path::new("mesh.stl"), bytes.to_vec(), |_| Ok(LengthUnit::Millimetres))?;
    let mesh = &file.model.0;
    assert_eq!(mesh.topology(), file.topology);
    assert!(mesh.vertices().iter().flat_map(|v| v.iter()).all(|c| c.is_finite()));
    assert_eq!(file.pieces.iter().map(|p| p.triangles).sum::<usize>(), mesh.triangles().len());
    Ok(file)
}

/// The most memory that this process has asked for, MB, where the system says it.
fn peak_mb() -> Option<usize> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmPeak:"))?;
    line.split_whitespace().next()?.parse::<usize>().ok().map(|kb| kb / 1024)
}

#[test]
fn damage_does_no_harm() {
    let before = peak_mb();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(6);
    let (mut tried, mut good) = (0, 0);
    for entry in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data")).unwrap() {
        let path = entry.unwrap().path();
        let whole = std::fs::read(&path).unwrap();
        if path.extension().is_some_and(|e| e == "md") {
            continue;
        }
        read(&whole).unwrap();
        let mut check = |bytes: &[u8]| {
            tried += 1;
            good += usize::from(read(bytes).is_ok());
        };
        for cut in 0..whole.len() {
            check(&whole[..cut]);
        }
        for at in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[at] ^= 1 << random.random_range(0..8);
            check(&bytes);
            let word = WORDS[random.random_range(0..WORDS.len())];
            let end = (at + random.random_range(0..=word.len())).min(whole.len());
            bytes.copy_from_slice(&whole);
            bytes.splice(at..end, word.iter().copied());
            check(&bytes);
        }
    }
    println!("{tried} damaged files, {good} of them still meshes");
    assert!(tried > 100_000 && good > 1000, "{tried}, {good}");
    if let (Some(before), Some(after)) = (before, peak_mb()) {
        println!("most memory asked for: {before} MB before, {after} MB after");
        assert!(after < before + 300, "{before} MB before, {after} MB after");
    }
}
