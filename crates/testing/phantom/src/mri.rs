//! MRI stacks of bones: bright marrow in a dark cortical shell, amid soft tissue.
//!
//! A voxel's signal is the sum of its tissues' levels, each by the fraction of the voxel that it fills ([`SliceGrid`]), so
//! thick slices and partial volume come of themselves. What spoils a scan is in [`MriFaults`], apart from truth: the gain of
//! the coil changes smoothly, `ln gain` is a polynomial of the second degree (Legendre products, so its mean over the stack
//! is 0); fat, here the marrow, is displaced along the frequency direction and leaves a dark rim behind and a bright one in
//! front; noise is that of a magnitude, `sqrt((s + n1)^2 + n2^2)` with normal `n1`, `n2` (Rice).
//!
//! **Not here:** flow, motion, ringing, field distortion, a slice profile that is not a box.

use biplane_geometry::{Model, Rigid};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::{GridError, Scanner, SliceGrid, Solid};

/// A bone as the scanner finds it.
#[derive(Clone, Copy)]
pub struct ScannedBone<'a> {
    /// The bone's surface: the outside of its cortical shell.
    pub outer: &'a dyn Solid,
    /// The marrow's surface: the inside of the shell; inside `outer`.
    pub inner: &'a dyn Solid,
    /// Cartilage, which may reach into the bone (what lies there is bone); none where it is not to be seen.
    pub cartilage: Option<&'a dyn Solid>,
    /// Where the bone lies.
    pub scanner_from_model: Rigid<Scanner, Model>,
    /// Its number in the map of labels, above 0.
    pub label: u8,
}

/// Signal of each tissue, in levels of the stack's samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TissueLevels {
    /// Fat of the marrow.
    pub marrow: f64,
    /// Cortical bone.
    pub cortical: f64,
    /// Cartilage.
    pub cartilage: f64,
    /// Muscle and what else surrounds the bones.
    pub soft_tissue: f64,
    /// Air around the limb.
    pub air: f64,
}

impl Default for TissueLevels {
    /// The order of a T1-weighted scan of a knee, on 12 bits.
    fn default() -> Self {
        Self { marrow: 1800.0, cortical: 300.0, cartilage: 1350.0, soft_tissue: 1000.0, air: 30.0 }
    }
}

/// What spoils a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MriFaults {
    /// Root mean square of the natural logarithm of the coil's gain over the stack: 0.1 is about 10 percent.
    pub bias: f64,
    /// Standard deviation of `n1` and of `n2`, levels.
    pub noise_sigma: f64,
    /// By how many voxels fat is displaced along the rows (first) and along the columns (second).
    pub chemical_shift: [f64; 2],
    /// Bits of a sample, 1 to 16; what is above is cut off.
    pub bits: u8,
    /// Of the gain's polynomial and of the noise.
    pub seed: u64,
}

impl MriFaults {
    /// None: levels rounded to whole numbers of 16 bits.
    pub fn none() -> Self {
        Self { bias: 0.0, noise_sigma: 0.0, chemical_shift: [0.0; 2], bits: 16, seed: 0 }
    }

    /// As a scan of a knee has them: a gain that changes by about 8 percent, noise of 5 percent of soft tissue, fat displaced
    /// by one voxel along the columns, 12 bits.
    pub fn usual(seed: u64) -> Self {
        Self { bias: 0.08, noise_sigma: 50.0, chemical_shift: [0.0, 1.0], bits: 12, seed }
    }
}

/// A scan: samples with where they lie.
#[derive(Debug, Clone, PartialEq)]
pub struct SliceStack {
    /// Where the voxels' centres are.
    pub grid: SliceGrid,
    /// Levels; rows run fastest, then columns, then slices.
    pub samples: Vec<u16>,
    /// Bits in use of each sample.
    pub bits: u8,
}

/// What a scan shows, without faults.
#[derive(Clone)]
pub struct MriScene<'a> {
    /// Bones that do not overlap; cartilage of one may touch another's.
    pub bones: Vec<ScannedBone<'a>>,
    /// The limb's skin, scanner frame; where there is none, soft tissue fills the stack.
    pub limb: Option<&'a dyn Solid>,
    /// Signal of the tissues.
    pub levels: TissueLevels,
}

impl MriScene<'_> {
    /// The stack that a scanner records.
    ///
    /// # Errors
    /// Where the grid is none: see [`GridError`].
    pub fn scan(&self, grid: &SliceGrid, faults: &MriFaults) -> Result<SliceStack, GridError> {
        let TissueLevels { soft_tissue, air, .. } = self.levels;
        let mut signal = vec![soft_tissue as f32; grid.voxels()?];
        if let Some(limb) = self.limb {
            signal.fill(air as f32);
            grid.fill(limb, &Rigid::identity(), [0.0; 3], |voxel, fraction| {
                signal[voxel] += ((soft_tissue - air) * fraction) as f32;
            });
        }
        for bone in &self.bones {
            self.add(bone, grid, faults.chemical_shift, &mut signal);
        }
        let bits = faults.bits.clamp(1, 16);
        let samples = record(grid, &signal, faults, f64::from(u16::MAX >> (16 - bits)));
        Ok(SliceStack { grid: grid.clone(), samples, bits })
    }

    /// The label of each voxel: that of the bone that fills at least half of it, 0 where none does.
    ///
    /// # Errors
    /// Where the grid is none: see [`GridError`].
    pub fn labels(&self, grid: &SliceGrid) -> Result<Vec<u8>, GridError> {
        let mut labels = vec![0; grid.voxels()?];
        for bone in &self.bones {
            grid.fill(bone.outer, &bone.scanner_from_model, [0.0; 3], |voxel, fraction| {
                if fraction >= 0.5 {
                    labels[voxel] = bone.label;
                }
            });
        }
        Ok(labels)
    }

    /// Each surface changes the level from what is outside it to what is inside, by the fraction of the voxel inside.
    fn add(&self, bone: &ScannedBone<'_>, grid: &SliceGrid, shift: [f64; 2], signal: &mut [f32]) {
        let levels = &self.levels;
        let mut step = |solid: &dyn Solid, shift: [f64; 2], change: f64| {
            let shift = [shift[0], shift[1], 0.0];
            grid.fill(solid, &bone.scanner_from_model, shift, |voxel, fraction| {
                signal[voxel] += (change * fraction) as f32;
            });
        };
        let mut around = levels.soft_tissue;
        if let Some(cartilage) = bone.cartilage {
            step(&Either(cartilage, bone.outer), [0.0; 2], levels.cartilage - levels.soft_tissue);
            around = levels.cartilage;
        }
        step(bone.outer, [0.0; 2], levels.cortical - around);
        if shift == [0.0; 2] {
            step(bone.inner, shift, levels.marrow - levels.cortical);
        } else {
            // The marrow's place is empty, and its fat appears beside it.
            step(bone.inner, [0.0; 2], -levels.cortical);
            step(bone.inner, shift, levels.marrow);
        }
    }
}

/// What lies in one solid or the other.
struct Either<'a>(&'a dyn Solid, &'a dyn Solid);

impl Solid for Either<'_> {
    fn value(&self, point: &biplane_geometry::Point3) -> f64 {
        self.0.value(point).min(self.1.value(point))
    }

    fn bounds(&self) -> (biplane_geometry::Point3, biplane_geometry::Point3) {
        let ((a, b), (c, d)) = (self.0.bounds(), self.1.bounds());
        (a.coords.inf(&c.coords).into(), b.coords.sup(&d.coords).into())
    }
}

/// Gain, noise and rounding.
fn record(grid: &SliceGrid, signal: &[f32], faults: &MriFaults, most: f64) -> Vec<u16> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(faults.seed);
    let gain = LogGain::drawn(&mut rng, faults.bias);
    let at = |i: usize, axis: usize| match grid.size[axis] {
        1 => 0.0,
        n => 2.0 * i as f64 / (n as f64 - 1.0) - 1.0,
    };
    let mut samples = Vec::with_capacity(signal.len());
    for k in 0..grid.size[2] {
        for j in 0..grid.size[1] {
            let row = (k * grid.size[1] + j) * grid.size[0];
            for i in 0..grid.size[0] {
                let mut level = f64::from(signal[row + i]);
                if faults.bias != 0.0 {
                    level *= gain.at([at(i, 0), at(j, 1), at(k, 2)]).exp();
                }
                if faults.noise_sigma != 0.0 {
                    let [a, b] = normal_pair(&mut rng);
                    level = (level + faults.noise_sigma * a).hypot(faults.noise_sigma * b);
                }
                samples.push(level.clamp(0.0, most).round() as u16);
            }
        }
    }
    samples
}

/// Two independent numbers with mean 0 and standard deviation 1 (Box and Muller 1958).
fn normal_pair(rng: &mut Xoshiro256PlusPlus) -> [f64; 2] {
    // 1 - u is above 0, so its logarithm is finite.
    let radius = (-2.0 * (1.0 - rng.random::<f64>()).ln()).sqrt();
    let (sin, cos) = (std::f64::consts::TAU * rng.random::<f64>()).sin_cos();
    [radius * cos, radius * sin]
}

/// Logarithm of the coil's gain over a stack whose coordinates run from -1 to 1.
struct LogGain([f64; 9]);

impl LogGain {
    /// Legendre products of degree 1 and 2, and the mean of each one's square over the cube.
    fn terms([x, y, z]: [f64; 3]) -> [f64; 9] {
        let second = |t: f64| 1.5 * t * t - 0.5;
        [x, y, z, x * y, y * z, z * x, second(x), second(y), second(z)]
    }

    const SQUARES: [f64; 9] =
        [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 9.0, 1.0 / 9.0, 1.0 / 9.0, 0.2, 0.2, 0.2];

    /// Random weights with the given root mean square of the whole.
    fn drawn(rng: &mut Xoshiro256PlusPlus, rms: f64) -> Self {
        let weights: [f64; 9] = std::array::from_fn(|_| normal_pair(rng)[0]);
        let square: f64 = weights.iter().zip(Self::SQUARES).map(|(w, s)| w * w * s).sum();
        Self(weights.map(|w| w * rms / square.sqrt().max(f64::MIN_POSITIVE)))
    }

    fn at(&self, place: [f64; 3]) -> f64 {
        self.0.iter().zip(Self::terms(place)).map(|(w, t)| w * t).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ball;
    use approx::assert_relative_eq;
    use biplane_geometry::Point3;

    const OUTER: Ball = Ball { centre: Point3::new(0.0, 0.0, 0.0), radius: 15.0 };
    const INNER: Ball = Ball { centre: Point3::new(0.0, 0.0, 0.0), radius: 12.0 };

    fn knee() -> MriScene<'static> {
        let bone = ScannedBone {
            outer: &OUTER,
            inner: &INNER,
            cartilage: None,
            scanner_from_model: Rigid::identity(),
            label: 5,
        };
        MriScene { bones: vec![bone], limb: None, levels: TissueLevels::default() }
    }

    fn grid() -> SliceGrid {
        SliceGrid::covering(OUTER.bounds(), 5.0, 0, 0.5, 1.0)
    }

    /// Place of the sample nearest to a point of the scanner.
    fn sample(stack: &SliceStack, point: Point3) -> u16 {
        let g = &stack.grid;
        let place: [usize; 3] =
            std::array::from_fn(|a| ((point - g.origin).dot(&g.axes[a]) / g.spacing_mm[a]).round() as usize);
        stack.samples[(place[2] * g.size[1] + place[1]) * g.size[0] + place[0]]
    }

    #[test]
    fn tissues_lie_where_the_bone_is() {
        let levels = TissueLevels::default();
        let stack = knee().scan(&grid(), &MriFaults::none()).unwrap();
        for (radius, level) in [(5.0, levels.marrow), (13.5, levels.cortical), (17.0, levels.soft_tissue)] {
            for direction in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.6, 0.8]] {
                let point = Point3::from(nalgebra::Vector3::from(direction) * radius);
                assert_eq!(f64::from(sample(&stack, point)), level, "at {point}");
            }
        }
        // The sum of all samples is what the volumes of two balls say.
        let volume = |r: f64| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3) / stack.grid.voxel_mm3();
        let expected = stack.samples.len() as f64 * levels.soft_tissue
            + volume(15.0) * (levels.cortical - levels.soft_tissue)
            + volume(12.0) * (levels.marrow - levels.cortical);
        let sum: f64 = stack.samples.iter().map(|&s| f64::from(s)).sum();
        assert_relative_eq!(sum, expected, max_relative = 1e-4);
    }

    #[test]
    fn labels_hold_the_bone_with_its_shell() {
        let grid = grid();
        let labels = knee().labels(&grid).unwrap();
        let labelled = labels.iter().filter(|&&l| l == 5).count() as f64 * grid.voxel_mm3();
        assert_relative_eq!(
            labelled,
            4.0 / 3.0 * std::f64::consts::PI * 15.0_f64.powi(3),
            max_relative = 2e-3
        );
        assert!(labels.iter().all(|&l| l == 0 || l == 5));
    }

    #[test]
    fn cartilage_covers_the_bone_and_leaves_it_whole() {
        let cap = Ball { centre: Point3::new(0.0, 0.0, 13.0), radius: 6.0 };
        let mut knee = knee();
        let bare = knee.scan(&grid(), &MriFaults::none()).unwrap();
        knee.bones[0].cartilage = Some(&cap);
        let covered = knee.scan(&grid(), &MriFaults::none()).unwrap();
        let level = |z: f64| f64::from(sample(&covered, Point3::new(0.25, 0.25, z)));
        assert_eq!(level(17.0), knee.levels.cartilage);
        assert_eq!(level(13.5), knee.levels.cortical);
        let below = Point3::new(0.25, 0.25, -17.0);
        assert_eq!(sample(&covered, below), sample(&bare, below));
    }

    #[test]
    fn air_surrounds_the_limb() {
        let skin = Ball { radius: 18.0, ..OUTER };
        let scene = MriScene { limb: Some(&skin), ..knee() };
        let stack = scene.scan(&grid(), &MriFaults::none()).unwrap();
        let level = |z: f64| f64::from(sample(&stack, Point3::new(0.25, 0.25, z)));
        assert_eq!([level(19.0), level(17.0), level(13.5)], [30.0, 1000.0, 300.0]);
    }

    #[test]
    fn fat_moves_along_the_rows_or_the_columns() {
        let plain = knee().scan(&grid(), &MriFaults::none()).unwrap();
        let faults = MriFaults { chemical_shift: [3.0, 0.0], ..MriFaults::none() };
        let shifted = knee().scan(&grid(), &faults).unwrap();
        // Sagittal slices: rows run along y. 3 voxels of 0.5 mm: the shell is empty at one side, covered at the other.
        let levels = TissueLevels::default();
        let at = |stack: &SliceStack, y: f64| f64::from(sample(stack, Point3::new(0.0, y, 0.25)));
        assert_eq!(at(&plain, -11.0), levels.marrow);
        assert_eq!(at(&shifted, -11.0), 0.0);
        assert_eq!(at(&plain, 12.8), levels.cortical);
        assert_eq!(at(&shifted, 12.8), levels.cortical + levels.marrow);
        // The same sum: fat is displaced, not lost.
        let sum = |s: &SliceStack| s.samples.iter().map(|&v| f64::from(v)).sum::<f64>();
        assert_relative_eq!(sum(&plain), sum(&shifted), max_relative = 1e-5);
    }

    #[test]
    fn the_logarithm_of_the_gain_has_mean_zero_and_the_given_size() {
        let empty = MriScene { bones: Vec::new(), limb: None, levels: TissueLevels::default() };
        let faults = MriFaults { bias: 0.1, seed: 4, ..MriFaults::none() };
        let grid = SliceGrid { size: [64, 64, 64], ..grid() };
        let stack = empty.scan(&grid, &faults).unwrap();
        let logs: Vec<f64> =
            stack.samples.iter().map(|&s| (f64::from(s) / empty.levels.soft_tissue).ln()).collect();
        let n = logs.len() as f64;
        let mean = logs.iter().sum::<f64>() / n;
        let rms = (logs.iter().map(|l| l * l).sum::<f64>() / n).sqrt();
        // 64 samples a side, ends included, are 3 percent off the integral.
        assert!(mean.abs() < 0.005, "{mean}");
        assert_relative_eq!(rms, 0.1, max_relative = 0.06);
        // Smooth: neighbours differ by little.
        assert!(logs.windows(2).step_by(64).all(|w| (w[0] - w[1]).abs() < 0.02));
    }

    #[test]
    fn noise_is_that_of_a_magnitude_and_the_seed_sets_it() {
        let scan = |level: f64, seed: u64| {
            let levels = TissueLevels { soft_tissue: level, ..TissueLevels::default() };
            let faults = MriFaults { noise_sigma: 40.0, seed, ..MriFaults::none() };
            MriScene { bones: Vec::new(), limb: None, levels }.scan(&grid(), &faults).unwrap().samples
        };
        let moments = |samples: &[u16]| {
            let n = samples.len() as f64;
            let mean = samples.iter().map(|&s| f64::from(s)).sum::<f64>() / n;
            (mean, (samples.iter().map(|&s| (f64::from(s) - mean).powi(2)).sum::<f64>() / n).sqrt())
        };
        // Where there is no signal it is Rayleigh's: mean sigma sqrt(pi / 2), standard deviation sigma sqrt(2 - pi / 2).
        let (mean, deviation) = moments(&scan(0.0, 1));
        assert_relative_eq!(mean, 40.0 * (std::f64::consts::PI / 2.0).sqrt(), max_relative = 0.005);
        assert_relative_eq!(deviation, 40.0 * (2.0 - std::f64::consts::PI / 2.0).sqrt(), max_relative = 0.01);
        // Far above the noise it is normal, with its mean up by sigma^2 / 2 s.
        let (mean, deviation) = moments(&scan(1000.0, 1));
        assert!((mean - 1000.8).abs() < 0.5, "{mean}");
        assert_relative_eq!(deviation, 40.0, max_relative = 0.01);
        assert_eq!(scan(500.0, 7), scan(500.0, 7));
        assert_ne!(scan(500.0, 7), scan(500.0, 8));
    }

    #[test]
    fn bits_cut_off_what_is_above() {
        let faults = MriFaults { bits: 8, ..MriFaults::none() };
        let stack = knee().scan(&grid(), &faults).unwrap();
        assert_eq!((stack.bits, stack.samples.iter().max()), (8, Some(&255)));
    }
}
