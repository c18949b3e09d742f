//! Racks as frames made of tubes, with the origin in the middle of the underside of the rack.
//!
//! ```text
//!   along the barrels (y)                          across them (x)
//!
//!        (  barrel  )                                 ( B )    ( B )
//!          ║      ║      posts of the cradles         ║ ║      ║ ║
//!          o──────o      two beams, joined        ════╩═╩══════╩═╩════
//! ```
//!
//! Beams, cradles and their heights are those of the plane model across the barrels; the positions of the beams are
//! those of the plane model along the barrels. Tubes are as wide as they are high. How the beams are connected is an
//! assumption: two tubes lie on top of the ends of the beams, so that only the beams rest on the support.

use barrelstack::assemble::{BAR_RADIUS, TUBE_CORNER};
use barrelstack::device::Chocks;
use barrelstack::scenario::{Cradle, Rack};
use barrelstack_dynamics::solid::{Barrel, Bulk, Capsule, Hull, Part};
use barrelstack_dynamics::{Quaternion, Rotation3, Vec3, math};

use std::f64::consts::FRAC_PI_2;

/// Tubes of a rack, and the barrels that each tube carries.
#[derive(Clone, Debug)]
pub(crate) struct Tubes {
    /// The tubes, with masses (kg) that add up to the mass of the rack. Chocks come last and have no mass.
    pub(crate) parts: Vec<Part>,
    /// For every beam, the row (counted within the rack) of the barrels above and below the beam, and the index of its
    /// tube.
    pub(crate) beams: Vec<(u32, usize)>,
    /// For every post, the column and the row (both counted within the rack) of the barrel that the post carries, and
    /// the index of its tube.
    pub(crate) posts: Vec<((u32, u32), usize)>,
}

/// Heights (m) that follow from the dimensions of the rack and the barrel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Heights {
    /// Height of the axis of a carried barrel above the underside of its rack.
    pub(crate) axis: f64,
    /// Height of the underside of a rack above the axis of a barrel on which it lies.
    pub(crate) underside: f64,
}

/// Returns the radius (m) of the surface of revolution that lies `distance` (m) outside of the staves of a barrel, at
/// the position `along` (m) on the axis.
fn around(barrel: &Barrel, distance: f64, along: f64) -> f64 {
    let arc = barrel.stave_radius + barrel.rounding + distance;
    (arc * arc - along * along).sqrt() - barrel.stave_offset
}

impl Heights {
    pub(crate) fn of(rack: &Rack, barrel: &Barrel) -> Self {
        let tube = 0.5 * rack.beam_height;
        Self {
            axis: rack.clearance + around(barrel, 0.0, rack.rail_half_spacing),
            underside: around(barrel, tube, rack.rail_half_spacing) - tube,
        }
    }
}

/// Returns the tubes of a rack, with chocks last; `None` if its cradle is not a pair of supports.
///
/// `apart` is the distance (m) between the centers of barrels that lie end to end.
pub(crate) fn tubes(
    rack: &Rack,
    barrel: &Barrel,
    apart: f64,
    chocks: Option<Chocks>,
) -> Option<Tubes> {
    let Cradle::Supports { angle } = rack.cradle else { return None };
    let beam = 0.5 * rack.beam_height;
    // The straight part of a beam ends where the rounded corner of its outline in the plane model begins.
    let half = 0.5 * rack.width - TUBE_CORNER;
    let heights = Heights::of(rack, barrel);
    let middle = |at: u32, count: u32| f64::from(at) - 0.5 * f64::from(count - 1);
    let (mut beams, mut posts) = (Vec::new(), Vec::new());
    let (mut list, mut horns) = (Vec::new(), Vec::new());
    // Returns an upright tube on a beam beside a barrel. The upper end of the tube is at the angle `angle` from the
    // bottom of the barrel and at the distance `gap` from its surface.
    let beside = |[place, y]: [f64; 2], side: f64, angle: f64, gap: f64| {
        let (sin, cos) = math::sin_cos(angle);
        let away = around(barrel, BAR_RADIUS + gap, rack.rail_half_spacing);
        let top = heights.axis - cos * away;
        let foot = rack.beam_height.min(top);
        let center = Vec3::new(place + side * sin * away, y, 0.5 * (top + foot));
        Tube::upright(0.5 * (top - foot), BAR_RADIUS, center)
    };
    for deep in 0..rack.barrels_deep {
        for side in [-1.0, 1.0] {
            let y = middle(deep, rack.barrels_deep) * apart + side * rack.rail_half_spacing;
            beams.push((deep, list.len()));
            list.push(Tube::along_x(half, beam, Vec3::new(0.0, y, beam)));
            for column in 0..rack.barrels {
                let place = middle(column, rack.barrels) * rack.pitch;
                for support in [-1.0, 1.0] {
                    posts.push(((column, deep), list.len()));
                    list.push(beside([place, y], support, angle, 0.0));
                    let horn = |chock: Chocks| beside([place, y], support, chock.angle, chock.gap);
                    horns.extend(chocks.map(horn));
                }
            }
        }
    }
    let reach = reach_along(rack, apart);
    for side in [-1.0, 1.0] {
        let at = Vec3::new(side * half, 0.0, rack.beam_height);
        list.push(Tube::along_y(reach, BAR_RADIUS, at));
    }
    // All tubes have the same wall thickness, so mass is proportional to length and circumference.
    let weight = |tube: &Tube| (2.0 * tube.half_length + tube.radius) * tube.radius;
    let whole: f64 = list.iter().map(weight).sum();
    let weighs = list.iter().map(|tube| tube.part(rack.mass * weight(tube) / whole));
    // The mass of a rack does not include its chocks.
    let parts = weighs.chain(horns.iter().map(|horn| horn.part(0.0))).collect();
    Some(Tubes { parts, beams, posts })
}

/// Returns the distance (m), along the barrels, from the middle of a rack to its outermost beams.
///
/// `apart` is the distance (m) between the centers of barrels that lie end to end.
pub(crate) fn reach_along(rack: &Rack, apart: f64) -> f64 {
    0.5 * f64::from(rack.barrels_deep - 1) * apart + rack.rail_half_spacing
}

/// A tube with its position and orientation in the rack.
struct Tube {
    half_length: f64,
    radius: f64,
    center: Vec3,
    rotation: Rotation3,
}

impl Tube {
    fn along_x(half_length: f64, radius: f64, center: Vec3) -> Self {
        Self { half_length, radius, center, rotation: Rotation3::identity() }
    }

    fn along_y(half_length: f64, radius: f64, center: Vec3) -> Self {
        Self { half_length, radius, center, rotation: along_barrels().matrix() }
    }

    fn upright(half_length: f64, radius: f64, center: Vec3) -> Self {
        let rotation = Quaternion::turn(Vec3::new(0.0, -FRAC_PI_2, 0.0)).matrix();
        Self { half_length, radius, center, rotation }
    }

    fn part(&self, mass: f64) -> Part {
        let tube = Capsule { half_length: self.half_length, radius: self.radius };
        let bulk = Bulk::of_hollow(&tube, mass);
        Part { hull: Hull::Capsule(tube), center: self.center, rotation: self.rotation, bulk }
    }
}

/// Returns the orientation of a body whose `x` axis points along the barrels, toward positive `y` of the stack.
pub(crate) fn along_barrels() -> Quaternion {
    Quaternion::turn(Vec3::new(0.0, 0.0, FRAC_PI_2))
}
