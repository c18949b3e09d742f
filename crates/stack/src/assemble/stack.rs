//! Assembly of a stack as a planar model, across or along its barrels, and the contact laws of a stack.

use barrelstack_dynamics::contact::{Rolling, Stop};
use barrelstack_dynamics::{Interface, Model, Space, Vec2};

use super::builder::Builder;
use super::bundle::{Bundle, Shown};
use super::interfaces::interface;
use super::solid::TRIBUTARY;
use super::{AssembleError, Assembly, Similitude, content, longitudinal, pairs, transverse};
use crate::scenario::{self, Basis, SeatContact, StackPair, StackSpec, View};

/// Lever arm (m) of the rolling resistance of barrels, which roll on their hoops over floors, racks or other barrels.
/// The value is an assumption.
const ROLLING_LEVER: f64 = 0.01;

/// Angular velocity (rad/s) at which the rolling resistance is close to its full value.
const ROLLING_SPIN: f64 = 0.1;

/// Builds the planar model of a stack, in the plane that `spec.view` names.
pub(super) fn assemble(
    spec: &StackSpec,
    gravity: f64,
    scale: Similitude,
) -> Result<Assembly, AssembleError> {
    if spec.columns_along.is_some() {
        return Err(AssembleError::Stack(
            "the stack is modeled in both planes, but this analysis works in only one plane: set stack.view to \
             \"transverse\" (across the barrels) or to \"longitudinal\" (along them)"
                .into(),
        ));
    }
    if spec.space.is_some() {
        return Err(AssembleError::Space);
    }
    let mut builder = Builder::new(spec, scale);
    let (law, shown) = (&spec.interfaces.barrel_rack, Shown::Plane(spec.view));
    if Bundle::of_cradle(law, spec, shown) != Bundle::at(StackPair::BarrelRack, law, spec, shown) {
        builder.cradle_law = builder.add_cradle(StackPair::BarrelRack.name(), law);
    }
    let (height, rack_reach) = match spec.view {
        View::Transverse => transverse::build(&mut builder)?,
        View::Longitudinal => longitudinal::build(&mut builder)?,
    };
    if spec.mirror {
        builder.mirror();
    }
    spec.devices.place(&mut builder).map_err(AssembleError::Stack)?;
    content::pour(&mut builder, gravity);
    let pairs = pairs::pairs(&builder);
    let Builder { bodies, parts, laws: more, cradle_law, held, loose, raised, .. } = builder;
    let mut interfaces = laws(spec, Shown::Plane(spec.view), scale);
    interfaces.extend(more);
    // Cradles with pads have the same stroke as other seats.
    interfaces[cradle_law].stop = interfaces[StackPair::BarrelRack as usize].stop;
    let mut model = Model::new(bodies, interfaces, pairs, Vec2::new(0.0, -gravity))?;
    let (held, devices) = held.into_iter().unzip();
    model.fasten(held)?;
    Ok(Assembly {
        model,
        parts,
        loose,
        step: f64::INFINITY,
        devices,
        height: height * scale.length + raised,
        levels: spec.levels,
        view: Some(spec.view),
        stave_capacity: spec.barrel.stave_capacity * scale.force(),
        rack_reach: rack_reach * scale.length,
    })
}

/// Returns the contact laws of a stack, in the order of [`StackPair::ALL`].
///
/// In a planar model, seats that stand one behind the other coincide, and the contact law of a seat represents all of
/// them.
pub(super) fn laws<S: Space<Real = f64>>(
    spec: &StackSpec,
    shown: Shown,
    scale: Similitude,
) -> Vec<Interface<S>> {
    let stroke = spec.rack.seat_stroke * scale.length;
    // Length (m) of a contact element, which converts between constants per length and constants per element.
    let each = match spec.rack.contact {
        SeatContact::Nodes => spec.rack.node_spacing,
        SeatContact::Element | SeatContact::Rails => TRIBUTARY,
    } * scale.length;
    let impact = |law: &scenario::Interface, seat: Basis| {
        let elements = match (seat, law.basis) {
            (Basis::Length, Basis::Node | Basis::Seat) => 1.0 / each,
            (Basis::Node | Basis::Seat, Basis::Length) => each,
            (Basis::Node | Basis::Seat, Basis::Node | Basis::Seat)
            | (Basis::Length, Basis::Length) => 1.0,
        };
        interface::<S>("stop", law, Bundle::of(elements), scale).normal
    };
    let laws = &spec.interfaces;
    let law = |pair: &StackPair| {
        // Beyond the stroke of a seat, the impact law of the same two bodies also acts.
        let stop = match pair {
            StackPair::RackGround => &laws.fallen_rack_ground,
            StackPair::BarrelRack => &laws.fallen_barrel_rack,
            StackPair::RackRack => &laws.fallen_rack_rack,
            StackPair::BarrelBarrel
            | StackPair::BarrelGround
            | StackPair::FallenBarrelRack
            | StackPair::FallenRackGround
            | StackPair::FallenRackRack => {
                return Interface {
                    // Rolling resistance brings fallen bodies to rest.
                    rolling: Some(Rolling {
                        lever: ROLLING_LEVER * scale.length,
                        spin: ROLLING_SPIN / scale.time(),
                    }),
                    ..interface(pair.name(), laws.of(*pair), Bundle::ONE, scale)
                };
            }
        };
        Interface {
            stop: Some(Stop { depth: stroke, law: impact(stop, laws.of(*pair).basis) }),
            ..interface(
                pair.name(),
                laws.of(*pair),
                Bundle::at(*pair, laws.of(*pair), spec, shown),
                scale,
            )
        }
    };
    StackPair::ALL.iter().map(law).collect()
}
