//! Samples a fitted map into the table that the other stages read, and measures what is lost by that and by going back.

use biplane_artifact::DistortionTable;
use biplane_fluoroscope::Distortion;
use biplane_geometry::Point2;

use crate::model::Fitted;

/// Samples along the longer side of the picture that are tried first; they are doubled until the error is small enough.
const FIRST_SAMPLES: f64 = 32.0;

/// The most samples along the longer side.
const MOST_SAMPLES: f64 = 128.0;

/// Largest error between the samples that is sought, px.
const TABLE_ERROR_PX: f64 = 1e-3;

/// Samples beyond the picture on each side: next to its border a table goes on straight, which is not the map.
const BEYOND: f64 = 2.0;

/// Points along the longer side at which a table is compared: no multiple of the samples, so that they fall everywhere between.
const PROBES: f64 = 149.0;

/// A table with its errors.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// Covers the picture and two steps beyond.
    pub table: DistortionTable,
    /// Largest distance of the table's map from the fitted one among the spots (within their convex hull), px.
    pub error_px: f64,
    /// Largest error of going by the fitted map to ideal pixels and by the table back, in the same places, px of the recorded
    /// picture; infinite where the table cannot be undone.
    pub round_trip_px: f64,
}

impl Fitted {
    /// Samples the map for a picture of `size` pixels: as densely as it takes to follow the map to 0.001 px, but with no more than
    /// 128 samples along the longer side.
    pub fn table(&self, size: [usize; 2]) -> Sampled {
        let mut samples = FIRST_SAMPLES;
        loop {
            let sampled = self.sampled(size, samples);
            if sampled.error_px <= TABLE_ERROR_PX || samples >= MOST_SAMPLES {
                return sampled;
            }
            samples *= 2.0;
        }
    }

    /// Samples the map with so many steps along the longer side.
    fn sampled(&self, size: [usize; 2], samples: f64) -> Sampled {
        let last_px = size.map(|n| n.saturating_sub(1) as f64);
        let longer_px = last_px[0].max(last_px[1]).max(1.0);
        let step = (longer_px / samples).ceil();
        let first = -(BEYOND * step);
        let count = last_px.map(|last| ((last / step).ceil() + 1.0 + 2.0 * BEYOND) as usize);
        let place = |i: usize| first + i as f64 * step;
        let ideal_px = (0..count[1])
            .flat_map(|j| (0..count[0]).map(move |i| Point2::new(place(i), place(j))))
            .map(|p| self.ideal(&p).coords.into())
            .collect();
        let table = DistortionTable { first_px: [first; 2], step_px: [step; 2], count, ideal_px };

        let sampled = Distortion::from(&table);
        let (mut error_px, mut round_trip_px) = (0.0_f64, 0.0_f64);
        let probe = longer_px / PROBES;
        let probes = |last: f64| (0..=(last / probe) as usize).map(move |i| i as f64 * probe);
        for recorded in probes(last_px[1]).flat_map(|y| probes(last_px[0]).map(move |x| Point2::new(x, y))) {
            if self.reach.holds(&recorded) {
                let ideal = self.ideal(&recorded);
                let back = sampled.recorded(&ideal).map_or(f64::INFINITY, |p| (p - recorded).norm());
                error_px = error_px.max((sampled.ideal(&recorded) - ideal).norm());
                round_trip_px = round_trip_px.max(back);
            }
        }
        Sampled { table, error_px, round_trip_px }
    }
}
