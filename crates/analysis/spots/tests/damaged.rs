//! Pictures that show nothing, something else, or are broken: few spots, a warning, never a panic.

use biplane_artifact::Frame;
use biplane_spots::{Look, SpotError, SpotParams, SpotSettings, find_spots};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

const LOOKS: [Look; 2] = [Look::Bright, Look::Dark];

fn params(look: Look) -> SpotParams {
    SpotParams { look, settings: SpotSettings::default() }
}

fn frame(width: usize, height: usize, sample: impl FnMut(usize) -> u16) -> Frame {
    Frame { width, height, samples: (0..width * height).map(sample).collect(), bits: 8 }
}

#[test]
fn tiny_and_even_pictures_have_no_spots() {
    for (width, height) in
        [(0, 0), (0, 7), (1, 1), (1, 40), (40, 1), (2, 2), (3, 2), (5, 5), (33, 31), (300, 200)]
    {
        for level in [0, 100, 255] {
            for look in LOOKS {
                let spots = find_spots(&frame(width, height, |_| level), &params(look)).unwrap();
                assert!(spots.spots.is_empty() && spots.border.is_none());
                assert_eq!(spots.size, [width, height]);
                assert!(width * height == 0 || spots.warnings.len() == 1, "{:?}", spots.warnings);
            }
        }
    }
}

#[test]
fn a_frame_of_another_size_than_it_says_is_refused() {
    let broken = Frame { width: 30, height: 20, samples: vec![0; 599], bits: 8 };
    let error = find_spots(&broken, &params(Look::Dark)).unwrap_err();
    assert_eq!(error, SpotError::Picture { width: 30, height: 20, samples: 599 });
    let huge = Frame { width: usize::MAX, height: 2, samples: vec![0; 8], bits: 8 };
    assert!(find_spots(&huge, &params(Look::Dark)).is_err());
}

#[test]
fn parameters_out_of_range_are_named() {
    for (name, settings) in [
        ("min_radius_px", SpotSettings { min_radius_px: f64::NAN, ..SpotSettings::default() }),
        ("max_radius_px", SpotSettings { max_radius_px: 1.2, ..SpotSettings::default() }),
        ("min_contrast", SpotSettings { min_contrast: -1.0, ..SpotSettings::default() }),
    ] {
        let params = SpotParams { look: Look::Dark, settings };
        let error = find_spots(&frame(9, 9, |_| 7), &params).unwrap_err();
        assert!(error.to_string().contains(name), "{error}");
    }
}

#[test]
fn noise_has_next_to_no_spots() {
    for (seed, most) in [(1, 20), (2, 120), (3, 255)] {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let noise = frame(300, 300, |_| random.random_range(0..=most));
        for look in LOOKS {
            let spots = find_spots(&noise, &params(look)).unwrap();
            assert!(spots.spots.len() <= 3, "{} of {most}", spots.spots.len());
        }
    }
}

#[test]
fn stripes_steps_and_any_bits_do_no_harm() {
    let pictures = [
        frame(200, 150, |i| if i % 200 / 10 % 2 == 0 { 30 } else { 220 }),
        frame(200, 150, |i| if i % 200 > 100 && i / 200 > 70 { 30 } else { 220 }),
        frame(200, 150, |i| (i % 200) as u16),
        Frame { bits: 0, ..frame(64, 64, |i| (i * 7919 % 65_536) as u16) },
        Frame { bits: 99, ..frame(64, 64, |i| (i * 7919 % 65_536) as u16) },
    ];
    for picture in &pictures {
        for look in LOOKS {
            let spots = find_spots(picture, &params(look)).unwrap();
            assert!(spots.spots.len() <= 3, "{:?}", spots.spots);
            for s in &spots.spots {
                assert!(s.at_px.iter().all(|v| v.is_finite()) && s.sigma_px.is_finite());
            }
        }
    }
}

#[test]
fn spots_of_the_other_look_are_named() {
    let dots = frame(200, 200, |i| {
        let (x, y) = ((i % 200 % 40) as f64 - 20.3, (i / 200 % 40) as f64 - 19.6);
        180 - (120.0 / (1.0 + (2.0 * (x.hypot(y) - 6.0)).exp())) as u16
    });
    let found = find_spots(&dots, &params(Look::Dark)).unwrap();
    assert_eq!(found.spots.len(), 25);
    assert!(found.spots.iter().all(|s| !s.cut) && found.warnings.is_empty(), "{:?}", found.warnings);
    let other = find_spots(&dots, &params(Look::Bright)).unwrap();
    assert!(other.warnings[0].contains("25 dark ones"), "{:?} {:?}", other.warnings, other.spots);
}
