//! A stack in one of its two views, with its laws of contact.

use barrelstack_dynamics::{Interface, Model, Planar, Vec2};

use super::builder::{BARREL_BARREL, BARREL_GROUND, BARREL_RACK, Builder, RACK_GROUND, RACK_RACK};
use super::interfaces::interface;
use super::{AssembleError, Assembly, Similitude, longitudinal, straps, transverse};
use crate::scenario::{StackInterfaces, StackSpec, View};

/// Builds a stack in its view.
pub(super) fn assemble(
    spec: &StackSpec,
    gravity: f64,
    scale: Similitude,
) -> Result<Assembly, AssembleError> {
    let mut builder = Builder::new(spec, scale);
    let (height, rack_reach) = match spec.view {
        View::Transverse => transverse::build(&mut builder)?,
        View::Longitudinal => longitudinal::build(&mut builder)?,
    };
    if spec.mirror {
        builder.mirror();
    }
    let loose = straps::straps(spec, scale, &builder.parts, &builder.bodies)?;
    let pairs = builder.pairs();
    let interfaces = laws(&spec.interfaces, scale);
    let model = Model::new(builder.bodies, interfaces, pairs, Vec2::new(0.0, -gravity))?;
    Ok(Assembly {
        model,
        parts: builder.parts,
        loose,
        height: height * scale.length,
        levels: spec.levels,
        view: Some(spec.view),
        rack_reach: rack_reach * scale.length,
    })
}

/// The laws of contact, each at the place of its id.
fn laws(laws: &StackInterfaces, scale: Similitude) -> Vec<Interface<Planar>> {
    let mut named = [
        (RACK_GROUND, "rack-ground", &laws.rack_ground),
        (BARREL_RACK, "barrel-rack", &laws.barrel_rack),
        (BARREL_BARREL, "barrel-barrel", &laws.barrel_barrel),
        (BARREL_GROUND, "barrel-ground", &laws.barrel_ground),
        (RACK_RACK, "rack-rack", &laws.rack_rack),
    ];
    named.sort_by_key(|(id, _, _)| *id);
    named.into_iter().map(|(_, name, law)| interface(name, law, scale)).collect()
}
