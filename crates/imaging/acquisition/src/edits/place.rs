//! Where the parts of a drawing are: affine maps, lengths, and how boxes are fitted into each other.
//!
//! After SVG 1.1, chapter 7 (coordinate systems). Lengths become user units of which 96 are an inch.

use std::str::FromStr;

use svgtypes::{Align, AspectRatio, Length, LengthUnit, Transform};

/// A point or a pair of sizes.
pub(super) type Pair = [f64; 2];

/// `x' = a x + c y + e`, `y' = b x + d y + f`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Affine {
    a: f64,
    b: f64,
    c: f64,
    d: f64,
    e: f64,
    f: f64,
}

impl Affine {
    pub(super) const IDENTITY: Self = Self { a: 1.0, b: 0.0, c: 0.0, d: 1.0, e: 0.0, f: 0.0 };

    pub(super) fn translate([e, f]: Pair) -> Self {
        Self { e, f, ..Self::IDENTITY }
    }

    pub(super) fn scale([a, d]: Pair) -> Self {
        Self { a, d, ..Self::IDENTITY }
    }

    /// Of an attribute `transform`.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        // A CSS length such as `translate(3px)` is read by some programs and written by few.
        let Transform { a, b, c, d, e, f } =
            Transform::from_str(text).map_err(|e| format!("its transform cannot be read ({e})"))?;
        Ok(Self { a, b, c, d, e, f })
    }

    /// First `inner`, then this one.
    pub(super) fn after(&self, inner: &Self) -> Self {
        let [e, f] = self.apply([inner.e, inner.f]);
        Self {
            a: self.a * inner.a + self.c * inner.b,
            b: self.b * inner.a + self.d * inner.b,
            c: self.a * inner.c + self.c * inner.d,
            d: self.b * inner.c + self.d * inner.d,
            e,
            f,
        }
    }

    pub(super) fn apply(&self, [x, y]: Pair) -> Pair {
        [self.a * x + self.c * y + self.e, self.b * x + self.d * y + self.f]
    }

    /// The way back; `None` where a side has no length.
    pub(super) fn inverse(&self) -> Option<Self> {
        let Self { a, b, c, d, e, f } = *self;
        let determinant = a * d - b * c;
        let back = Self {
            a: d / determinant,
            b: -b / determinant,
            c: -c / determinant,
            d: a / determinant,
            e: (c * f - d * e) / determinant,
            f: (b * e - a * f) / determinant,
        };
        let finite = [back.a, back.b, back.c, back.d, back.e, back.f].iter().all(|v| v.is_finite());
        (finite && determinant != 0.0).then_some(back)
    }
}

/// A length in user units; a percentage is of `whole`.
pub(super) fn length(text: &str, whole: f64) -> Result<f64, String> {
    let Length { number, unit } =
        Length::from_str(text.trim()).map_err(|_| format!("`{text}` is no length such as 12.5 or 3mm"))?;
    let scale = match unit {
        LengthUnit::None | LengthUnit::Px => 1.0,
        LengthUnit::In => 96.0,
        LengthUnit::Cm => 96.0 / 2.54,
        LengthUnit::Mm => 96.0 / 25.4,
        LengthUnit::Pt => 96.0 / 72.0,
        LengthUnit::Pc => 16.0,
        LengthUnit::Percent => whole / 100.0,
        LengthUnit::Em | LengthUnit::Ex => {
            return Err(format!("`{text}` depends on a letter's size; expected px, mm, cm, in, pt, pc or %"));
        }
    };
    Ok(number * scale)
}

/// A rectangle along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Box2 {
    pub(super) corner: Pair,
    pub(super) sides: Pair,
}

impl Box2 {
    /// Of an attribute `viewBox`.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let parts: Vec<f64> = text
            .split(|c: char| c == ',' || c.is_ascii_whitespace())
            .filter(|p| !p.is_empty())
            .map_while(|p| p.parse().ok())
            .collect();
        match parts[..] {
            [x, y, w, h] if w > 0.0 && h > 0.0 && parts.iter().all(|v| v.is_finite()) => {
                Ok(Self { corner: [x, y], sides: [w, h] })
            }
            _ => Err(format!("its viewBox `{text}` is not four numbers with sides above 0")),
        }
    }

    /// The map of `inner` into this box as `preserveAspectRatio` says.
    pub(super) fn fit(&self, inner: &Self, aspect: Option<&str>) -> Result<Affine, String> {
        let AspectRatio { defer: _, align, slice } = match aspect {
            None => AspectRatio::default(),
            Some(text) => AspectRatio::from_str(text)
                .map_err(|_| format!("its preserveAspectRatio `{text}` is none of SVG's"))?,
        };
        let ratio = [0, 1].map(|i| self.sides[i] / inner.sides[i]);
        let one = if slice { ratio[0].max(ratio[1]) } else { ratio[0].min(ratio[1]) };
        let scale = if align == Align::None { ratio } else { [one; 2] };
        let share = match align {
            Align::None | Align::XMinYMin => [0.0, 0.0],
            Align::XMidYMin => [0.5, 0.0],
            Align::XMaxYMin => [1.0, 0.0],
            Align::XMinYMid => [0.0, 0.5],
            Align::XMidYMid => [0.5, 0.5],
            Align::XMaxYMid => [1.0, 0.5],
            Align::XMinYMax => [0.0, 1.0],
            Align::XMidYMax => [0.5, 1.0],
            Align::XMaxYMax => [1.0, 1.0],
        };
        let left = [0, 1].map(|i| {
            self.corner[i] + share[i] * (self.sides[i] - scale[i] * inner.sides[i])
                - scale[i] * inner.corner[i]
        });
        Ok(Affine::translate(left).after(&Affine::scale(scale)))
    }
}
