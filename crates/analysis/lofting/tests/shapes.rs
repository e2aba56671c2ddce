//! Analytic solids lofted from exact contours.

#![allow(clippy::unwrap_used)]
use biplane_artifact::{ContourSlice, SliceContour, SliceContours, SliceFlag, SlicePoint};
use biplane_geometry::Point3;
use biplane_lofting::*;

fn ball(r: f64, dz: f64, n: usize, off: f64) -> SliceContours {
    let mut slices = vec![];
    let mut z = -30.0 + off;
    while z < 30.0 {
        let rr = r * r - z * z;
        let contours = if rr > 0.0 {
            let q = rr.sqrt();
            vec![SliceContour {
                points: (0..n)
                    .map(|k| {
                        let a = k as f64 / n as f64 * std::f64::consts::TAU;
                        SlicePoint { i: q * a.cos(), j: q * a.sin(), sigma_mm: 0.1 }
                    })
                    .collect(),
            }]
        } else {
            vec![]
        };
        slices.push(ContourSlice { origin_mm: [0.0, 0.0, z], contours, flags: vec![], edited: false });
        z += dz;
    }
    SliceContours {
        columns: 100,
        rows: 100,
        column_step_mm: [1.0, 0.0, 0.0],
        row_step_mm: [0.0, 1.0, 0.0],
        slices,
        warnings: vec![],
    }
}

#[test]
fn ball_is_ball() {
    for (dz, n) in [(4.0, 50), (2.0, 100), (1.0, 200), (0.5, 400)] {
        for off in [0.0, 0.3, 0.7] {
            let t = std::time::Instant::now();
            let s = surface_of(&ball(20.0, dz, n, off * dz), &LoftParams::default()).unwrap();
            let e = t.elapsed();
            let s2 = loft(&ball(20.0, dz, n, off * dz), &LoftParams::default()).unwrap();
            let mut d: Vec<f64> =
                s2.mesh.vertices().iter().map(|p| (p - Point3::origin()).norm() - 20.0).collect();
            d.sort_by(f64::total_cmp);
            let m = d.len();
            println!(
                "dz {dz} {off}: {} v {} t, {:?}, d min {:.4} 5% {:.4} med {:.4} 95% {:.4} max {:.4}; vol {:.4} {:?} {:?}",
                m,
                s.mesh.triangles().len(),
                e,
                d[0],
                d[m / 20],
                d[m / 2],
                d[m - m / 20],
                d[m - 1],
                s2.report.volume_mm3 / (4.0 / 3.0 * std::f64::consts::PI * 8000.0),
                s2.report.faults,
                s2.report.warnings
            );
        }
    }
}
