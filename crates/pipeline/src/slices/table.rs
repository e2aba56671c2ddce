//! `results/slices/<bone>.csv`: every point of every contour.

use biplane_artifact::SliceContours;

/// What `results/slices/README.txt` says.
pub const README: &str = include_str!("readme.txt");

/// The bytes of the table: a header with units, then a row a point.
pub fn slices_csv(contours: &SliceContours) -> Vec<u8> {
    let mut text = String::from("slice,contour,hole,point,i_px,j_px,x_mm,y_mm,z_mm,sigma_mm\n");
    for (number, slice) in contours.slices.iter().enumerate() {
        for (place, contour) in slice.contours.iter().enumerate() {
            let hole = u8::from(contour.is_hole());
            let places = contours.points_mm(number, place);
            for (point, (p, [x, y, z])) in contour.points.iter().zip(places).enumerate() {
                text += &format!(
                    "{number},{place},{hole},{point},{:.5},{:.5},{x:.5},{y:.5},{z:.5},{:.5}\n",
                    p.i, p.j, p.sigma_mm
                );
            }
        }
    }
    text.into_bytes()
}
