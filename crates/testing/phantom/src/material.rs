//! What bodies are made of, as X-rays see it.
//!
//! One effective photon energy stands for the whole spectrum, so a material is one number: its linear attenuation
//! coefficient at 50 keV, about the mean energy of a 70 kV beam behind a knee. Mass attenuation coefficients are those of
//! Hubbell and Seltzer, *Tables of X-Ray Mass Attenuation Coefficients* (NISTIR 5632), for elements and for the ICRU-44
//! tissues, mixed by weight for alloys. **Not guaranteed:** beam hardening, which makes thick metal a little brighter than
//! this does.

/// A material of a phantom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Material {
    /// Nothing.
    Air,
    /// Soft tissue of a limb.
    SoftTissue,
    /// Compact bone.
    CorticalBone,
    /// Spongy bone with its marrow: a fifth compact bone by volume, the rest marrow.
    TrabecularBone,
    /// Acrylic (PMMA): bead frames.
    Acrylic,
    /// Polyethylene of inserts.
    Polyethylene,
    /// Alumina.
    Ceramic,
    /// The alloy with 6 % aluminium and 4 % vanadium.
    Titanium,
    /// Stainless steel: balls and plates.
    Steel,
    /// The cast alloy with 28 % chromium and 6 % molybdenum.
    CobaltChrome,
    /// Tungsten: beads.
    Tungsten,
}

impl Material {
    /// Linear attenuation coefficient at 50 keV, 1/mm.
    pub fn attenuation_per_mm(self) -> f64 {
        // cm^2/g times g/cm^3, to 1/mm.
        let linear = |per_mass: f64, density: f64| per_mass * density / 10.0;
        match self {
            Self::Air => 0.0,
            Self::SoftTissue => linear(0.2264, 1.06),
            Self::CorticalBone => linear(0.4242, 1.92),
            Self::TrabecularBone => 0.2 * linear(0.4242, 1.92) + 0.8 * linear(0.22, 1.0),
            Self::Acrylic => linear(0.2074, 1.19),
            Self::Polyethylene => linear(0.2084, 0.94),
            Self::Ceramic => linear(0.295, 3.95),
            Self::Titanium => linear(1.15, 4.43),
            Self::Steel => linear(1.95, 7.9),
            Self::CobaltChrome => linear(2.24, 8.3),
            Self::Tungsten => linear(5.949, 19.3),
        }
    }
}
