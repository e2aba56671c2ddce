//! The pixels around a spot that say something about it: within the picture and the intensifier's border, and not those of its neighbours.

use biplane_artifact::Circle;

use crate::fit::Pixel;
use biplane_grey::Grey;

/// How far inside the border a picture is whole, px.
const BORDER_EDGE: f64 = 2.0;
/// How far beyond its radius a neighbour's blurred edge reaches, px.
const NEIGHBOUR_EDGE: f64 = 2.5;

/// A round thing of the picture: its middle and its radius, px.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Round {
    pub at: [f64; 2],
    pub radius: f64,
}

impl Round {
    /// Whether a place is within it or `margin` px beyond.
    fn holds(&self, x: f64, y: f64, margin: f64) -> bool {
        (x - self.at[0]).powi(2) + (y - self.at[1]).powi(2) < (self.radius + margin).powi(2)
    }

    /// Distance of the middles, px.
    pub fn distance(&self, other: &Self) -> f64 {
        (self.at[0] - other.at[0]).hypot(self.at[1] - other.at[1])
    }
}

/// What is seen of a picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Field<'a> {
    pub grey: &'a Grey,
    pub border: Option<Circle>,
}

/// Pixels about a place, row by row.
#[derive(Debug)]
pub(crate) struct Window {
    pub pixels: Vec<Pixel>,
    /// Where each pixel lies in a raster of rows of `stride`.
    pub places: Vec<usize>,
    pub stride: usize,
    /// Places of the raster.
    pub size: usize,
}

impl Field<'_> {
    /// How far within the borders of picture and intensifier a place is, px; negative outside.
    pub fn depth(&self, at: [f64; 2]) -> f64 {
        let [w, h] = [self.grey.width, self.grey.height].map(|n| n as f64);
        let of_picture = (at[0] + 0.5).min(at[1] + 0.5).min(w - 0.5 - at[0]).min(h - 0.5 - at[1]);
        self.border.map_or(of_picture, |c| {
            of_picture.min(c.radius_px - (at[0] - c.centre_px[0]).hypot(at[1] - c.centre_px[1]))
        })
    }

    /// The pixels within `reach` px of a round thing's middle, without those of `others`: each `every`th along both axes. Places are in
    /// its radii.
    pub fn window(&self, own: &Round, reach: f64, others: &[Round], every: usize) -> Window {
        let [cx, cy] = own.at;
        let range = |c: f64, n: usize| {
            (c - reach).ceil().max(0.0) as usize..((c + reach).floor() + 1.0).clamp(0.0, n as f64) as usize
        };
        let (columns, rows) = (range(cx, self.grey.width), range(cy, self.grey.height));
        let rim = self.border.map(|c| (c.centre_px, (c.radius_px - BORDER_EDGE).max(0.0)));
        let mut pixels = Vec::with_capacity(columns.len() * rows.len());
        let mut places = Vec::with_capacity(columns.len() * rows.len());
        for j in rows.clone().step_by(every) {
            let y = j as f64;
            let row = &self.grey.samples[j * self.grey.width..];
            for i in columns.clone().step_by(every) {
                let x = i as f64;
                if (x - cx).powi(2) + (y - cy).powi(2) > reach * reach
                    || rim.is_some_and(|(c, r)| (x - c[0]).powi(2) + (y - c[1]).powi(2) > r * r)
                    || others.iter().any(|o| o.holds(x, y, NEIGHBOUR_EDGE))
                {
                    continue;
                }
                let value = f64::from(row[i]);
                places.push((j - rows.start) * columns.len() + i - columns.start);
                pixels.push(Pixel { x: (x - cx) / own.radius, y: (y - cy) / own.radius, value, ground: 1.0 });
            }
        }
        Window { pixels, places, stride: columns.len(), size: columns.len() * rows.len() }
    }
}
