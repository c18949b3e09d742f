//! A barrel: outer profile, wall, contents, mass and moments of inertia.

/// What the barrel holds and how the contents turn with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fill {
    /// Full, and the wine turns with the wood like a solid.
    FullFrozen,
    /// Full, and the wine is an ideal fluid: it does not turn about the axis of the barrel, and turns only in part
    /// about a transverse axis.
    FullFluid,
    /// Wood only.
    Empty,
}

/// A barrel, a body of revolution whose outer radius falls as a parabola from the bilge to the heads.
#[derive(Debug, Clone, PartialEq)]
pub struct Barrel {
    /// Catalogue name the barrel was made from.
    pub base: String,
    /// Mass of wood and contents (kg).
    pub mass: f64,
    /// Mass of the wood and hoops alone (kg).
    pub empty_mass: f64,
    /// Length over the chimes (m).
    pub length: f64,
    /// Outer diameter at the bilge, the widest place (m).
    pub bilge_diameter: f64,
    /// Outer diameter at the heads (m).
    pub head_diameter: f64,
    /// Thickness of staves and heads (m).
    pub stave_thickness: f64,
    /// Nominal volume of the contents (m³).
    pub capacity: f64,
    /// Diameter of the circle that stands for the barrel in the transverse view (m).
    pub section_diameter: f64,
    /// Contents.
    pub fill: Fill,
}

impl Barrel {
    /// Outer diameter (m) at a distance `offset` (m) from the bilge along the axis; constant beyond the heads.
    pub fn diameter_at(&self, offset: f64) -> f64 {
        let u = (2.0 * offset / self.length).clamp(-1.0, 1.0);
        self.bilge_diameter - (self.bilge_diameter - self.head_diameter) * u * u
    }
}
