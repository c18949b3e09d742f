//! A rack: what carries the barrels of one level, in both views.

/// How a rack stands on what is below.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RackKind {
    /// Rack-on-barrel: the rack lies on the barrels of the level below.
    OnBarrels,
    /// Rack-on-rack: posts carry the load to the rack below and no barrel carries another.
    OnRacks,
}

/// How a rack holds a barrel in the transverse view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cradle {
    /// Two supports at `±angle` from the lowest point of the barrel.
    Supports {
        /// Angle of each support from the vertical through the center of the barrel (rad).
        angle: f64,
    },
    /// A circular trough.
    Arc {
        /// Radius of the trough (m).
        radius: f64,
        /// Half of the angle the trough spans (rad).
        half_angle: f64,
    },
}

/// The posts of a rack that stands on the rack below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posts {
    /// Height from the foot of the post to the seat of the next rack (m).
    pub height: f64,
    /// Distance of each post from the middle of the rack in the transverse view (m).
    pub half_spacing: f64,
}

/// A rack.
#[derive(Debug, Clone, PartialEq)]
pub struct Rack {
    /// Catalogue name the rack was made from.
    pub base: String,
    /// How the rack stands on what is below.
    pub kind: RackKind,
    /// Mass (kg).
    pub mass: f64,
    /// Barrels side by side on one rack in the transverse view.
    pub barrels: u32,
    /// Barrels end to end on one rack in the longitudinal view.
    pub barrels_deep: u32,
    /// Distance between the axes of neighboring barrels (m).
    pub pitch: f64,
    /// Overall width in the transverse view (m).
    pub width: f64,
    /// Distance of each rail from the middle of a barrel along its axis (m).
    pub rail_half_spacing: f64,
    /// Width of one rail along the barrel axis (m).
    pub rail_width: f64,
    /// Height of the lowest point of a carried barrel above the underside of the rack (m).
    pub clearance: f64,
    /// Height of the beams, from the underside up (m).
    pub beam_height: f64,
    /// How the rack holds a barrel.
    pub cradle: Cradle,
    /// Half of the length of flat underside that bears on each barrel crown below (m).
    pub bearing_half_length: f64,
    /// Distance between contact nodes on rails and undersides (m).
    pub node_spacing: f64,
    /// Posts; present exactly when `kind` is [`RackKind::OnRacks`].
    pub posts: Option<Posts>,
}
