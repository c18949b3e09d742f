//! A stack of barrels on racks.

use super::barrel::{Barrel, Fill};
use super::interface::Interface;
use super::rack::Rack;

/// The plane of a planar model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// The plane across the barrels, which are circles.
    Transverse,
    /// The plane along the barrels, which show their profile.
    Longitudinal,
}

/// A stack and the laws of its contacts.
#[derive(Debug, Clone, PartialEq)]
pub struct StackSpec {
    /// Plane of the model.
    pub view: View,
    /// Levels of barrels, 1 at the bottom.
    pub levels: u32,
    /// Barrels per level in this view.
    pub columns: u32,
    /// The barrel used everywhere unless overridden.
    pub barrel: Barrel,
    /// The rack used everywhere unless overridden.
    pub rack: Rack,
    /// Whether the whole stack is mirrored left to right.
    pub mirror: bool,
    /// Free distance between racks side by side (m).
    pub gap: f64,
    /// Bodies that differ, in the order of the file.
    pub overrides: Vec<BodyOverride>,
    /// Laws of contact.
    pub interfaces: StackInterfaces,
}

impl StackSpec {
    /// Barrels that one rack carries in this view.
    pub fn barrels_per_rack(&self) -> u32 {
        match self.view {
            View::Transverse => self.rack.barrels,
            View::Longitudinal => self.rack.barrels_deep,
        }
    }

    /// Racks side by side on one level in this view.
    pub fn racks_per_level(&self) -> u32 {
        self.columns / self.barrels_per_rack().max(1)
    }
}

/// The kind of body that an override changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StackBody {
    /// A barrel; columns count barrels.
    Barrel,
    /// A rack; columns count racks.
    Rack,
}

/// What differs at one body of a stack.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyOverride {
    /// Kind of body.
    pub body: StackBody,
    /// Level, 1 at the bottom.
    pub level: u32,
    /// Column, 1 at the left before any mirroring: of barrels, or of racks when `body` is a rack; `None` for the
    /// whole level.
    pub column: Option<u32>,
    /// Mass in place of the regular one (kg).
    pub mass: Option<f64>,
    /// Contents in place of the regular ones; barrels only.
    pub fill: Option<Fill>,
    /// Displacement from the regular place, positive to the right before any mirroring (m).
    pub offset_x: f64,
}

/// The law of each kind of contact in a stack.
#[derive(Debug, Clone, PartialEq)]
pub struct StackInterfaces {
    /// Bottom rack on the ground.
    pub rack_ground: Interface,
    /// Barrel in its cradle, and the rack above on the barrel.
    pub barrel_rack: Interface,
    /// Barrel against barrel.
    pub barrel_barrel: Interface,
    /// Fallen barrel on the ground.
    pub barrel_ground: Interface,
    /// Rack against rack.
    pub rack_rack: Interface,
}
