//! A barrel in a scenario: outer profile, wall, contents, mass and moments of inertia.

use std::f64::consts::PI;

use barrelstack_input::declared::Held;
use barrelstack_input::named;

use super::catalog;
use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Kind, Range, Section, names};
use super::known::known;
use super::reader::Reader;
use super::stack::View;
use super::tree::Table;
use super::writer::Writer;
use crate::slosh::{self, Wave};

named! {
    /// Contents of a barrel, and whether they rotate with the barrel.
    pub enum Fill {
        /// Full, with the wine as an ideal fluid: the wine does not rotate about the axis of the barrel, and only part
        /// of the wine rotates about a transverse axis.
        FullFluid = "full-fluid",
        /// Full, with wine that rotates with the wood like a solid.
        FullFrozen = "full-frozen",
        /// Filled in part, to [`Barrel::filled`]: the wine sloshes and does not rotate with the wood.
        Part = "part",
        /// Empty: wood only.
        Empty = "empty",
    }
}

impl Fill {
    /// Returns the fraction of the capacity that is filled with wine. For a partly filled barrel, this is `filled`.
    fn share(self, filled: f64) -> f64 {
        match self {
            Self::FullFrozen | Self::FullFluid => 1.0,
            Self::Part => filled,
            Self::Empty => 0.0,
        }
    }

    /// Returns the mass (kg) of the wine in a barrel with a capacity (m³); `filled` is the filled fraction of a partly
    /// filled barrel.
    fn mass(self, capacity: f64, filled: f64) -> f64 {
        catalog::WINE_DENSITY * capacity * self.share(filled)
    }
}

known! {
    /// A barrel: a body of revolution whose outer radius decreases as a parabola from the bilge to the
    /// heads.
    ///
    /// All numbers are in SI units.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Barrel {
        /// Name of the catalog barrel on which the barrel is based.
        pub base: &'static str,
    }
    /// The fields of a barrel.
    const FIELDS, after {
        /// Catalog barrel on which this barrel is based.
        base = Kind::Choice(catalog::barrel_names), Default::Value("\"bordeaux-225\"");
    };
    /// Contents of the barrel, and whether they rotate with it.
    fill: Fill = Kind::Choice(names::<Fill>), Default::Value("\"full-fluid\"");
    /// Fraction of the capacity that is filled, for barrels whose `fill` is "part", here or in an override.
    filled: f64 = Kind::Number(FILLED), Default::Value("0.9");
    /// Mass of the barrel with its contents.
    mass: f64 = Kind::Quantity(&[Dimension::MASS], Range::up_to(1e5)),
        Default::Derived("the empty mass plus 990 kg/m^3 times the filled part of the capacity");
    /// Mass of the wood and hoops of the barrel.
    empty_mass: f64 = Kind::Quantity(&[Dimension::MASS], Range::up_to(1e5)), CATALOG;
    /// Overall length of the barrel, over the chimes.
    length: f64 = SIZE, CATALOG;
    /// Outer diameter of the barrel at the bilge, its widest part.
    bilge_diameter: f64 = SIZE, CATALOG;
    /// Outer diameter of the barrel at the heads.
    head_diameter: f64 = SIZE, CATALOG;
    /// Thickness of staves and heads.
    stave_thickness: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range { least: 1e-3, above: false, greatest: 1.0 }), CATALOG;
    /// Nominal volume of the barrel.
    capacity: f64 = Kind::Quantity(&[Dimension::VOLUME], Range::up_to(100.0)), CATALOG;
    /// Diameter of the circle that represents the barrel in the plane across the barrels.
    section_diameter: f64 = SIZE, Default::Derived("the diameter of the barrel where it rests on the rails of the rack");
    /// Force between a barrel and a rack at which the staves are crushed. The default is an assumption: 4.3 MPa, the
    /// strength of white oak across the grain (Record 1914), over two contact areas of 10 cm by 5 cm, one under each
    /// rail.
    stave_capacity: f64 =
        Kind::Quantity(&[Dimension::FORCE], Range::POSITIVE), Default::Value("\"43 kN\"");
}

impl Barrel {
    /// Returns the outer diameter (m) at a distance `offset` (m) from the bilge along the axis; beyond the heads, the
    /// diameter is constant.
    pub fn diameter_at(&self, offset: f64) -> f64 {
        let u = (2.0 * offset / self.length).clamp(-1.0, 1.0);
        self.bilge_diameter - (self.bilge_diameter - self.head_diameter) * u * u
    }

    /// Returns the volume (m³) of the wine in the barrel.
    pub fn wine(&self) -> f64 {
        self.capacity * self.fill.share(self.filled)
    }

    /// Returns the barrel with another mass or other contents; if only the contents change, the mass is adjusted.
    #[must_use]
    pub fn altered(&self, mass: Option<f64>, fill: Option<Fill>) -> Self {
        let fill = fill.unwrap_or(self.fill);
        let contents = |fill: Fill| fill.mass(self.capacity, self.filled);
        let regular = if contents(fill) == contents(self.fill) {
            self.mass
        } else {
            self.empty_mass + contents(fill)
        };
        Self { mass: mass.unwrap_or(regular), fill, ..self.clone() }
    }

    /// Returns the moment of inertia (kg·m²) about the center of mass for rotation in the plane of a view. In the
    /// transverse view, this is the moment about the axis of the barrel; in the longitudinal view, the moment about a
    /// transverse axis.
    ///
    /// The wood is a shell of constant thickness with two heads. The volume between the heads is the capacity. The mass
    /// of the contents is `mass` minus `empty_mass`.
    ///
    /// A frozen filling rotates with the wood; its moments about a transverse axis and about the axis of the barrel are
    /// `I_t` and `I_a`. A fluid filling rotates about the axis of the barrel only in a layer at the wall, which is half
    /// as thick as the Stokes layer at 1 Hz. About a transverse axis, a fluid filling has the effective moment
    /// `(I_t - I_a)² / I_t` of an ideal fluid in a spheroid with the same `I_t` and `I_a` (Lamb, Hydrodynamics, on the
    /// ellipsoidal shell filled with liquid).
    pub fn inertia(&self, view: View) -> f64 {
        let moments = self.moments();
        match view {
            View::Transverse => moments.axial,
            View::Longitudinal => moments.transverse,
        }
    }

    /// Returns the first sloshing mode of the wine in the plane of a view; `None` for a full or empty barrel.
    pub fn wave(&self, view: View) -> Option<Wave> {
        (self.fill == Fill::Part).then(|| {
            let length = 2.0 * self.half_room();
            // Radius of the cylinder with the same length and capacity.
            let radius = (self.capacity / (PI * length)).sqrt();
            match view {
                View::Transverse => slosh::across(radius, self.filled),
                View::Longitudinal => slosh::along(radius, length, self.filled),
            }
        })
    }

    fn moments(&self) -> Moments {
        let half_room = self.half_room();
        let thickness = self.stave_thickness;
        let half_length = 0.5 * self.length;
        let outer = |x: f64| 0.5 * self.diameter_at(x);
        let inner = |x: f64| (outer(x) - thickness).max(0.0);
        let staves = Solid::between(half_length, outer, inner);
        let head_square = square(inner(half_room));
        let head = head_square * PI * thickness;
        let head_place = half_room + 0.5 * thickness;
        let wood = Solid {
            volume: staves.volume + 2.0 * head,
            axial: staves.axial + head * head_square,
            transverse: staves.transverse
                + 2.0
                    * head
                    * (0.25 * head_square + thickness * thickness / 12.0 + head_place * head_place),
        };
        let wine = Solid::between(half_room, inner, |_| 0.0);
        let wood_density = self.empty_mass / wood.volume;
        let wine_mass = self.mass - self.empty_mass;
        let wine_density = wine_mass / wine.volume;
        let frozen = Moments {
            axial: wine_density * wine.axial,
            transverse: wine_density * wine.transverse,
        };
        let contents = match self.fill {
            // If the mass stated for an empty barrel exceeds the mass of the wood, the excess is distributed like the
            // wood.
            Fill::Empty => {
                let density = wine_mass / wood.volume;
                Moments { axial: density * wood.axial, transverse: density * wood.transverse }
            }
            Fill::FullFrozen => frozen,
            Fill::FullFluid | Fill::Part if wine_mass <= 0.0 => {
                Moments { axial: 0.0, transverse: 0.0 }
            }
            Fill::FullFluid | Fill::Part => {
                let lag = frozen.transverse - frozen.axial;
                // The sloshing mass is a separate body; the other wine rotates as in a full barrel.
                let rest = self.wave(View::Longitudinal).map_or(1.0, |wave| 1.0 - wave.share);
                Moments {
                    axial: wine_density * stokes_layer(half_room, inner),
                    transverse: lag * lag / frozen.transverse * rest,
                }
            }
        };
        Moments {
            axial: wood_density * wood.axial + contents.axial,
            transverse: wood_density * wood.transverse + contents.transverse,
        }
    }

    /// Returns half of the distance (m) between the heads, chosen so that the interior has the nominal volume. If the
    /// interior is too small even at the largest possible distance, returns half of the largest distance.
    fn half_room(&self) -> f64 {
        let most = 0.5 * self.length - self.stave_thickness;
        let inner = |x: f64| (0.5 * self.diameter_at(x) - self.stave_thickness).max(0.0);
        let room = |half: f64| Solid::between(half, inner, |_| 0.0).volume;
        if room(most) <= self.capacity {
            return most;
        }
        let (mut low, mut high) = (0.0, most);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if room(middle) < self.capacity {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }
}

struct Moments {
    axial: f64,
    transverse: f64,
}

/// Volume (m³) of a body of revolution, and second moments of the volume (m⁵) about its axis and about a
/// transverse axis through its middle.
struct Solid {
    volume: f64,
    axial: f64,
    transverse: f64,
}

impl Solid {
    /// Returns the volume and the second moments of a body between an outer and an inner surface, integrated by
    /// Simpson's rule.
    ///
    /// `outer` and `inner` return the radii (m) at a distance (m) along the axis from the middle. The body extends from
    /// `-half` to `half` (m) along the axis and is symmetric about its middle.
    fn between(half: f64, outer: impl Fn(f64) -> f64, inner: impl Fn(f64) -> f64) -> Self {
        const INTERVALS: u32 = 200;
        let step = half / f64::from(INTERVALS);
        let mut solid = Self { volume: 0.0, axial: 0.0, transverse: 0.0 };
        for i in 0..=INTERVALS {
            let x = step * f64::from(i);
            let weight = match i {
                0 | INTERVALS => 1.0,
                _ if i % 2 == 1 => 4.0,
                _ => 2.0,
            };
            // The factor 2 is for the two equal halves.
            let slice = 2.0 * weight * step / 3.0;
            let (square_out, square_in) = (square(outer(x)), square(inner(x)));
            let area = PI * (square_out - square_in);
            let second = PI * (square_out * square_out - square_in * square_in);
            solid.volume += slice * area;
            solid.axial += slice * 0.5 * second;
            solid.transverse += slice * (0.25 * second + area * x * x);
        }
        solid
    }
}

fn square(x: f64) -> f64 {
    x * x
}

/// Returns the second moment of volume (m⁵), about the axis of the barrel, of a layer of wine at the wall. The layer is
/// half as thick as the Stokes layer at 1 Hz.
fn stokes_layer(half: f64, radius: impl Fn(f64) -> f64) -> f64 {
    /// Kinematic viscosity of wine (m²/s).
    const VISCOSITY: f64 = 1.6e-6;
    let thickness = (2.0 * VISCOSITY / (2.0 * PI)).sqrt();
    let wall = |x: f64| 2.0 * PI * (radius(x) * square(radius(x)));
    let staves = half / 3.0 * (wall(half) + 4.0 * wall(0.5 * half) + wall(0.0));
    let heads = PI * square(square(radius(half)));
    0.5 * thickness * (staves + heads)
}

const CATALOG: Default = Default::Derived("the value in the catalog");
const SIZE: Kind =
    Kind::Quantity(&[Dimension::LENGTH], Range { least: 0.01, above: false, greatest: 10.0 });

/// Range of the filled fraction: above this range, the free surface is too small for significant sloshing; below this
/// range, the wine is only a puddle.
const FILLED: Range = Range::between(0.02, 0.995);

/// Definition of the table of a barrel.
pub static BARREL: Section = Section {
    name: "barrel",
    help: "A barrel of the catalog, with any changes.",
    fields: FIELDS,
    variants: None,
    exclusive: &[],
};

/// Reads a barrel that lies on two rails, each at a distance of `rail_half_spacing` (m) from its middle.
pub(super) fn read(reader: Reader<'_>, rail_half_spacing: f64) -> Result<Barrel, ScenarioError> {
    let base = reader.catalog_name("base")?;
    let Some(known) = catalog::barrel(&base) else { return Err(reader.missing("base")) };
    let mut barrel = Barrel::read_over(&reader, &known.barrel())?;
    if reader.leaves_out("mass") {
        barrel.mass = barrel.empty_mass + barrel.fill.mass(barrel.capacity, barrel.filled);
    }
    if reader.leaves_out("section_diameter") {
        barrel.section_diameter = barrel.diameter_at(rail_half_spacing);
    }
    check(&reader, &barrel)?;
    reader.finish();
    Ok(barrel)
}

fn check(reader: &Reader<'_>, barrel: &Barrel) -> Result<(), ScenarioError> {
    let path = |name| reader.path_of(name);
    if barrel.head_diameter > barrel.bilge_diameter {
        let message = format!(
            "`{}` is {} m, more than the bilge diameter of {} m; a barrel is widest at the bilge: lower the one or \
             raise the other",
            path("head_diameter"),
            barrel.head_diameter,
            barrel.bilge_diameter
        );
        return Err(reader.inconsistent("head_diameter", message));
    }
    if 2.0 * barrel.stave_thickness >= barrel.head_diameter.min(barrel.length) {
        let message = format!(
            "`{}` is {} m; twice the thickness must be less than the head diameter of {} m and less than the length of \
             {} m, so that there is room for wine",
            path("stave_thickness"),
            barrel.stave_thickness,
            barrel.head_diameter,
            barrel.length
        );
        return Err(reader.inconsistent("stave_thickness", message));
    }
    let sections = barrel.head_diameter..=barrel.bilge_diameter;
    if !sections.contains(&barrel.section_diameter) {
        let message = format!(
            "`{}` is {} m; it must lie between the head diameter of {} m and the bilge diameter of {} m",
            path("section_diameter"),
            barrel.section_diameter,
            barrel.head_diameter,
            barrel.bilge_diameter
        );
        return Err(reader.inconsistent("section_diameter", message));
    }
    if barrel.mass < barrel.empty_mass {
        let message = format!(
            "`{}` is {} kg, less than the {} kg of the empty barrel; raise this mass, which includes the wine, or \
             lower `{}`",
            path("mass"),
            barrel.mass,
            barrel.empty_mass,
            path("empty_mass")
        );
        return Err(reader.inconsistent("mass", message));
    }
    if barrel.fill == Fill::Empty && barrel.mass != barrel.empty_mass {
        let message = format!(
            "`{}` is {} kg, but the mass of an empty barrel is its `empty_mass`, {} kg; give only `empty_mass`",
            path("mass"),
            barrel.mass,
            barrel.empty_mass
        );
        return Err(reader.inconsistent("mass", message));
    }
    Ok(())
}

/// Writes a barrel.
pub(super) fn write(barrel: &Barrel) -> Table {
    let mut writer = Writer::new(&BARREL);
    writer.text("base", barrel.base);
    barrel.write_fields(&mut writer);
    writer.finish()
}
