//! Catalog of barrels and racks, with the source of every number.
//!
//! Values without a source are marked as assumptions. Users should measure these values, and override them in the
//! scenario.

use std::f64::consts::PI;

use super::barrel::{Barrel, Fill};
use super::rack::{Cradle, Posts, Rack, RackKind, SeatContact};

/// Density of wine (kg/m³).
pub const WINE_DENSITY: f64 = 990.0;

/// A barrel of the catalog.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CatalogBarrel {
    /// Name in the catalog.
    pub name: &'static str,
    /// Length over the chimes (m).
    pub length: f64,
    /// Outer diameter at the bilge (m).
    pub bilge_diameter: f64,
    /// Outer diameter at the heads (m).
    pub head_diameter: f64,
    /// Thickness of staves and heads (m).
    pub stave_thickness: f64,
    /// Mass of wood and hoops (kg).
    pub empty_mass: f64,
    /// Nominal volume (m³).
    pub capacity: f64,
    /// Source of the numbers.
    pub source: &'static str,
}

impl CatalogBarrel {
    /// Returns the catalog barrel as a barrel of a scenario, empty and without the values that depend on the rack.
    pub(super) const fn barrel(&self) -> Barrel {
        let Self { name, length, bilge_diameter, head_diameter, stave_thickness, .. } = *self;
        Barrel {
            base: name,
            fill: Fill::Empty,
            filled: 0.0,
            mass: self.empty_mass,
            empty_mass: self.empty_mass,
            length,
            bilge_diameter,
            head_diameter,
            stave_thickness,
            capacity: self.capacity,
            section_diameter: 0.0,
            stave_capacity: 0.0,
        }
    }
}

/// Barrels of the catalog.
pub const BARRELS: &[CatalogBarrel] = &[
    CatalogBarrel {
        name: "bordeaux-225",
        length: 0.945,
        bilge_diameter: 0.690,
        head_diameter: 0.555,
        stave_thickness: 0.027,
        empty_mass: 46.0,
        capacity: 0.225,
        source: "Bordeaux export barrel; dimensions from “Dimensions of a Bordeaux Barrel” (dimensionsguide.com); mass \
                 of the A.P. John 225 L barrel (apjohn.com.au, technical specifications)",
    },
    CatalogBarrel {
        name: "burgundy-228",
        length: 0.880,
        bilge_diameter: 0.720,
        head_diameter: 0.580,
        stave_thickness: 0.027,
        empty_mass: 50.0,
        capacity: 0.228,
        source: "dimensions of patent application US 2011/0017686; stave thickness and mass are assumptions",
    },
    CatalogBarrel {
        name: "hogshead-300",
        length: 1.050,
        bilge_diameter: 0.765,
        head_diameter: 0.610,
        stave_thickness: 0.025,
        empty_mass: 55.5,
        capacity: 0.300,
        source: "A.P. John 300 L hogshead (apjohn.com.au, technical specifications)",
    },
    CatalogBarrel {
        name: "puncheon-500",
        length: 1.110,
        bilge_diameter: 0.930,
        head_diameter: 0.790,
        stave_thickness: 0.027,
        empty_mass: 90.0,
        capacity: 0.500,
        source: "middle of the ranges of Anatomy of a Wine Barrel (backyardbarrels.com.au); stave thickness is an \
                 assumption",
    },
];

/// Contact constants of a seat: a place where a rack carries a barrel or another rack, or where the rack itself is
/// carried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seat {
    /// Stiffness (N/m).
    pub stiffness: f64,
    /// Coefficient of restitution in an impact of a body with the mass `mass`.
    pub restitution: f64,
    /// Mass (kg) for which the restitution holds.
    pub mass: f64,
    /// Ratio of the tangential to the normal stiffness.
    pub stick: f64,
}

/// Ratio of the tangential to the normal stiffness of seats on barrels. Staves bend under normal forces, but are
/// stiffer against tangential forces, which load them in their plane.
const STICK_ON_BARREL: f64 = 2.0;

/// Ratio of the tangential to the normal stiffness of seats on the floor. Tubes do not lie flat on a floor, so a normal
/// force first bends them. A tangential force acts where steel already touches the floor, and there the contact is far
/// stiffer.
///
/// Four is the largest ratio that does not require a smaller time step. When slip changes direction, the friction force
/// reverses gradually, while the tangential spring is displaced. With a ratio of four, this displacement is so small
/// under a stack of five levels that friction acts like rigid friction.
const STICK_ON_FLOOR: f64 = 4.0;

/// Ratio of the tangential to the normal stiffness of seats on posts. The ratio is smaller than on the floor, because
/// racks are light and tangential forces on them have the height of the posts as lever arm.
///
/// With a ratio of four, racks on posts oscillate from one time step to the next in the longitudinal plane: after
/// 0.05 s, the error of the energy balance is 1.4e-3. With a ratio of two, this error is 2e-12.
const STICK_ON_POST: f64 = 2.0;

/// Contact constants of the seats of a rack, derived in `validation/seats.md`.
///
/// If the variants of a stack draw a constant at random, the value here is the median.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seats {
    /// Seat between a rack and a barrel: one rail on the crown of the barrel below it, or one support of a cradle under
    /// the barrel that it carries.
    pub barrel: Seat,
    /// Seat of a rack on the ground: one end of a rail, or one foot.
    pub floor: Seat,
    /// Seat of a rack on a rack: one post under the rack above.
    pub post: Seat,
    /// Source of the numbers.
    pub source: &'static str,
}

impl Seat {
    const fn new(stiffness: f64, mass: f64, stick: f64) -> Self {
        // Full barrels of 270 kg were observed to bounce visibly, and the measurements of the paper on barrels and
        // racks give a restitution of 0.84 to 0.91 for a full barrel on one to four contact elements.
        Self { stiffness, restitution: 0.8, mass, stick }
    }
}

/// Seats of racks that lie on barrels. Each rail carries its barrels directly above the crowns on which it lies.
const ON_BARRELS: Seats = Seats {
    barrel: Seat::new(3e6, 70.0, STICK_ON_BARREL),
    floor: Seat::new(1e7, 10.0, STICK_ON_FLOOR),
    post: Seat::new(1e7, 15.0, STICK_ON_POST),
    source: "derived values, since nobody has measured these racks; on barrels, the stiffness of a shell of oak staves \
             27 mm thick under a point load beside a hoop, in series with joints that open and with the tube wall: 2.7 \
             to 4.4 MN/m (for comparison: 0.89 MN/m was measured on local barrels and racks by Candia, de la Llera and \
             Almazán (2008), and a stave clamped between hoops has 12 MN/m); on floors, the stiffness of tubes with a \
             gap of a fraction of a millimeter under them; restitution for a quarter of a full barrel on one seat, and \
             for an empty rack on a floor",
};

/// Seats of racks whose rails span from post to post and bend under their barrels.
const ON_POSTS: Seats = Seats {
    barrel: Seat::new(6e5, 70.0, STICK_ON_BARREL),
    source: "derived values, since nobody has measured these racks; the stiffness as for racks on barrels, in series \
             with a rail that has 1.2 MN/m under each barrel (60 mm square tube, spanning 1.54 m from post to post); \
             on floors and on each other, the stiffness of steel posts with play",
    ..ON_BARRELS
};

/// A rack of the catalog.
#[derive(Debug, Clone, PartialEq)]
pub struct CatalogRack {
    /// The rack.
    pub rack: Rack,
    /// Contact constants of the seats of the rack.
    pub seats: Seats,
    /// Description in a sentence.
    pub help: &'static str,
    /// Source of the numbers.
    pub source: &'static str,
}

/// Rack for two barrels side by side on two rails.
const TWO_BARREL: Rack = Rack {
    base: "two-barrel",
    kind: RackKind::OnBarrels,
    mass: 40.0,
    barrels: 2,
    barrels_deep: 1,
    pitch: 0.737,
    width: 1.473,
    rail_half_spacing: 0.27,
    rail_width: 0.05,
    incline: 0.0,
    clearance: 0.20,
    beam_height: 0.05,
    foot_height: 0.0,
    foot_half_length: 0.06,
    cradle: Cradle::Supports { angle: 28.0 * PI / 180.0 },
    contact: SeatContact::Rails,
    seat_stroke: 0.02,
    node_spacing: 0.01,
    posts: None,
};

/// Racks of the catalog.
pub const RACKS: &[CatalogRack] = &[
    CatalogRack {
        rack: TWO_BARREL,
        seats: ON_BARRELS,
        help: "A rack that lies on the barrels below with straight tubes.",
        source: "portable steel rack for two barrels on a footprint of 38 in by 58 in, which gives pitch and width (Wines & \
             Vines 2016); clearance of 7 inches between the bilges of neighboring levels, so that six levels are \
             18 ft high (UC Berkeley 2000); straight tubes without feet; mass, rails, tubes and cradle are assumptions",
    },
    CatalogRack {
        rack: Rack { base: "two-barrel-feet", foot_height: 0.06, ..TWO_BARREL },
        seats: ON_BARRELS,
        help: "A rack that stands on the barrels below with feet.",
        source: "`two-barrel` with a foot over each barrel below; the foot is assumed to be as wide as the foot of the \
                 reconstructed `candia-2008`",
    },
    CatalogRack {
        rack: Rack { base: "single-bar", mass: 35.0, contact: SeatContact::Element, ..TWO_BARREL },
        seats: ON_BARRELS,
        help: "A rack that lies on the barrels below with one bar instead of two.",
        source: "single-bar version of the rack for two barrels (Wines & Vines 2016); the numbers are those of \
                 `two-barrel`, the mass is an assumption",
    },
    CatalogRack {
        rack: Rack { base: "four-barrel", mass: 80.0, barrels_deep: 2, ..TWO_BARREL },
        seats: ON_BARRELS,
        help: "A rack that consists of two racks, joined end to end.",
        source: "two two-barrel racks, joined end to end (Wines & Vines 2016); each has the dimensions of `two-barrel`, and the mass is an assumption",
    },
    CatalogRack {
        rack: Rack {
            base: "rack-on-rack",
            kind: RackKind::OnRacks,
            mass: 60.0,
            width: 1.60,
            posts: Some(Posts {
                height: 0.89,
                half_spacing: 0.77,
                half_spacing_along: 0.44,
                spigot: 0.03,
            }),
            ..TWO_BARREL
        },
        seats: ON_POSTS,
        help: "A rack that stands on the posts of the rack below.",
        source: "racks that carry load on posts at their four corners (Wines & Vines 2014, 2016); every number is an \
            assumption; the post height gives the usual level pitch; across the barrels, the posts stand clear of the \
            barrels on both sides; along the barrels, the posts stand within 38 in, the depth of the footprint of \
            racks for two barrels",
    },
    CatalogRack {
        rack: Rack { base: "two-barrel-inclined", incline: 3.5 * PI / 180.0, ..TWO_BARREL },
        seats: ON_BARRELS,
        help: "A rack that lies on the barrels below with straight tubes, and raises one end of every barrel.",
        source: "`two-barrel` with a tilt of 3.5° along the barrels; in shaking tests (Sideris, Filiatrault et al. \
                 2010), the same tilt across the shelf kept pallets on the shelves of racks; no maker of such a rack \
                 is known, so the tilt is an assumption",
    },
    CatalogRack {
        rack: Rack {
            base: "candia-2008",
            mass: 40.0,
            pitch: 0.76,
            width: 1.50,
            rail_half_spacing: 0.234,
            rail_width: 0.038,
            clearance: 0.135,
            beam_height: 0.03,
            foot_height: 0.075,
            foot_half_length: 0.064,
            cradle: Cradle::Supports { angle: 32.0 * PI / 180.0 },
            contact: SeatContact::Nodes,
            ..TWO_BARREL
        },
        seats: ON_BARRELS,
        help: "The rack of the paper, reconstructed where the paper gives no dimensions.",
        source: "rack of Candia, de la Llera and Almazán (2008), whose text gives no dimensions: a solid beam on feet, \
                 reconstructed so that a single geometry reproduces the paper's collapse modes and times, drift and \
                 stress amplification",
    },
];

/// Records shipped with the program.
pub const RECORDS: &[(&str, &str)] = &[(
    "napa-college-2014",
    "South Napa 2014-08-24 M6.0, Napa College, CGS/CSMIP 68150: two horizontal components and the vertical",
)];

pub(super) fn barrel_names() -> Vec<&'static str> {
    BARRELS.iter().map(|barrel| barrel.name).collect()
}

pub(super) fn rack_names() -> Vec<&'static str> {
    RACKS.iter().map(|known| known.rack.base).collect()
}

/// Returns the barrel of the catalog with the given name.
pub fn barrel(name: &str) -> Option<&'static CatalogBarrel> {
    BARRELS.iter().find(|barrel| barrel.name == name)
}

/// Returns the rack of the catalog with the given name.
pub fn rack(name: &str) -> Option<&'static CatalogRack> {
    RACKS.iter().find(|known| known.rack.base == name)
}
