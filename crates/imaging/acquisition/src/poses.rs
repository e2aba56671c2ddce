//! Poses of bodies over frames in the formats of other programs, read and written: Autoscoper's `.tra`, XMALab's rigid bodies, JointTrack's `.jts`,
//! `.jtak` and `.jtap`, OpenSim's `.mot` and `.sto`.
//!
//! None of them names a study's frames: they count them, from the first. A pose that is missing is `None`, and every writer has a word
//! for it. None of them holds a covariance or a verdict.
//!
//! **Guaranteed:** what a writer writes, its reader reads as the same poses to the decimals written. No text makes a reader panic, and none
//! takes more memory than some times its own size. **Not guaranteed:** the meaning of a `.tra` whose dialect nobody states ([`tra::Dialect`]).

pub mod jointtrack;
pub mod opensim;
pub mod tra;
pub mod xmalab;

use biplane_geometry::Pose;

/// The poses of one body, one a frame; `None` where there is none.
pub type Poses = Vec<Option<Pose>>;

/// Why a file of poses cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PosesError {
    /// A line is not what it should be.
    #[error("{path}:{line}: {what}")]
    Line {
        /// Which file.
        path: String,
        /// Which line, from 1.
        line: usize,
        /// What was found and expected.
        what: String,
    },
    /// The file as a whole is not.
    #[error("{path}: {what}")]
    File {
        /// Which file.
        path: String,
        /// What was found and expected.
        what: String,
    },
}

/// The numbers of a line, parted by commas, tabs or spaces.
pub(crate) fn numbers(line: &str) -> Result<Vec<f64>, String> {
    line.split(|c: char| c == ',' || c == ';' || c.is_whitespace())
        .filter(|word| !word.is_empty())
        .map(|word| word.parse::<f64>().map_err(|_| format!("`{}` is not a number", short(word))))
        .collect()
}

/// The beginning of a text, for messages.
pub(crate) fn short(text: &str) -> String {
    let mut short: String = text.chars().take(24).collect();
    if short.len() < text.len() {
        short.push_str("...");
    }
    short
}

/// A number as these programs write it.
pub(crate) fn decimal(value: f64, digits: usize) -> String {
    format!("{:.digits$}", value + 0.0)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use biplane_geometry::Vector3;
    use nalgebra::UnitQuaternion;
    use rand::rngs::StdRng;
    use rand::{Rng, SeedableRng};

    /// Poses all over, some of them missing, some at the locks of every sequence of turns.
    pub(crate) fn any(count: usize, seed: u64) -> Poses {
        let mut rng = StdRng::seed_from_u64(seed);
        let quarter = std::f64::consts::FRAC_PI_2;
        (0..count)
            .map(|k| {
                let mut v = |size: f64| Vector3::from_fn(|_, _| size * rng.random_range(-1.0..1.0));
                let rotation = match k % 7 {
                    3 => UnitQuaternion::from_scaled_axis(Vector3::x() * quarter),
                    4 => UnitQuaternion::from_scaled_axis(Vector3::y() * -quarter),
                    5 => UnitQuaternion::from_scaled_axis(Vector3::z() * 2.0 * quarter),
                    _ => UnitQuaternion::from_scaled_axis(v(3.0)),
                };
                let pose = Pose::new(rotation, v(1000.0));
                (k % 7 != 6).then_some(pose)
            })
            .collect()
    }

    /// Holds poses against each other.
    pub(crate) fn same(a: &Poses, b: &Poses, mm: f64, rad: f64) {
        assert_eq!(a.len(), b.len());
        for (k, (a, b)) in a.iter().zip(b).enumerate() {
            match (a, b) {
                (None, None) => {}
                (Some(a), Some(b)) => {
                    let off = (a.translation() - b.translation()).norm();
                    let turned = a.rotation().angle_to(&b.rotation());
                    assert!(off <= mm && turned <= rad, "frame {k}: {off} mm, {turned} rad");
                }
                _ => panic!("frame {k}: one is missing"),
            }
        }
    }

    /// No damage to a text makes a reader panic.
    pub(crate) fn damage(text: &str, read: impl Fn(&str)) {
        let mut rng = StdRng::seed_from_u64(9);
        let letters: Vec<char> = text.chars().collect();
        for _ in 0..400 {
            let mut damaged = letters.clone();
            for _ in 0..rng.random_range(1..6) {
                let at = rng.random_range(0..damaged.len());
                match rng.random_range(0..4) {
                    0 => {
                        damaged[at] = ['\n', ',', '-', 'e', 'N', '9', '\u{e9}', '\0'][rng.random_range(0..8)]
                    }
                    1 => drop(damaged.remove(at)),
                    2 => damaged.truncate(at.max(1)),
                    _ => damaged.insert(at, '1'),
                }
            }
            read(&damaged.into_iter().collect::<String>());
        }
        for odd in ["", "\n\n", "NaN", "1e999", ",,,,", "inf inf inf inf inf inf"] {
            read(odd);
        }
    }
}
