//! Check that all features of a stack are supported in three dimensions. The error for an unsupported feature contains
//! the path of its field in the scenario.

use barrelstack::assemble::{AssembleError, CHIME_RADIUS, TUBE_CORNER};
use barrelstack::scenario::{Basis, Fill, RackKind, Scenario, SeatContact, StackSpec};
use barrelstack_dynamics::solid::Barrel;

/// Checks that all features of a stack are supported in three dimensions, and returns the shape of its barrels.
///
/// # Errors
/// If the stack has a feature that is not supported in three dimensions.
pub(crate) fn known(scenario: &Scenario, spec: &StackSpec) -> Result<Barrel, AssembleError> {
    let refuse = |field, reason: String| Err(AssembleError::NotInSpace { field, reason });
    let rack = &spec.rack;
    if rack.kind != RackKind::OnBarrels || rack.foot_height > 0.0 {
        return refuse(
            "stack.rack",
            format!(
                "stack.rack = \"{}\" has {}; three-dimensional stacks support only racks that lie on the barrels below \
                 with straight tubes: choose \"two-barrel\" or \"four-barrel\", or set stack.view to \"both\"",
                rack.base,
                if rack.kind == RackKind::OnBarrels { "feet" } else { "posts" }
            ),
        );
    }
    if rack.incline != 0.0 {
        return refuse(
            "stack.rack.incline",
            "rails that raise one end of every barrel are supported only in a plane: set \
             stack.rack.incline to 0, or stack.view to \"both\""
                .into(),
        );
    }
    let interfaces = &spec.interfaces;
    let bases = [interfaces.rack_ground.basis, interfaces.barrel_rack.basis];
    if rack.contact != SeatContact::Rails && bases.iter().any(|basis| *basis != Basis::Seat) {
        return refuse(
            "stack.rack.contact",
            "in three dimensions each of the two beams of a rack has only one contact element at every place where \
             it touches, so contact constants must be stated per seat: set stack.rack.contact to \"rails\", the \
             basis of interface.rack-ground and interface.barrel-rack to \"seat\", or stack.view to \"both\""
                .into(),
        );
    }
    let fills = spec.overrides.iter().filter_map(|change| change.fill).chain([spec.barrel.fill]);
    if fills.into_iter().any(|fill| fill == Fill::Part) {
        return refuse(
            "stack.barrel.fill",
            "sloshing wine is supported only in a plane: set stack.barrel.fill to \"full-fluid\", \
             \"full-frozen\" or \"empty\", or stack.view to \"both\""
                .into(),
        );
    }
    if scenario.run.similitude != 1.0 {
        return refuse(
            "run.similitude",
            "scaled stacks are supported only in a plane: set run.similitude to 1".into(),
        );
    }
    let tube = (0.5 * rack.beam_height - TUBE_CORNER).max(0.0);
    if spec.racks_per_level() > 1 && spec.gap < 2.0 * tube {
        return refuse(
            "stack.gap",
            format!(
                "the beams are {} m high, and their round ends reach {:.3} m beyond the straight part on which the \
                 beams bear, so racks side by side overlap: set stack.gap to {:.3} m or more",
                rack.beam_height,
                tube,
                2.0 * tube
            ),
        );
    }
    let barrel = &spec.barrel;
    Barrel::new(
        barrel.length,
        0.5 * barrel.head_diameter,
        0.5 * barrel.bilge_diameter,
        CHIME_RADIUS,
    )
    .map_err(|error| AssembleError::NotInSpace { field: "stack.barrel", reason: error.to_string() })
}
