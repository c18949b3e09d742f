//! Attachment of devices to a three-dimensional stack; each device has a file of its own.
//!
//! The definition, loads, cost and descriptions of a device are those of the plane models. A device that acts in both
//! plane models acts in both horizontal directions here. Chocks are part of the racks ([`tubes`](crate::rack::tubes)),
//! and pads are part of the contact laws.

mod isolator;
mod lid;
mod strap;
mod tie;
mod tuned_mass;
mod walking_stop;

use barrelstack::assemble::{AssembleError, PartKind};
use barrelstack::device::{Devices, Words};
use barrelstack_dynamics::{
    BodyId, Element, Guide, Memory, ModelError, Rotation3, Spatial, State, Vec3,
};

use crate::builder::Builder;
use crate::stack::Stack;

/// A force element that will be attached when the stack is at rest.
#[derive(Clone, Debug)]
pub(crate) struct Loose {
    element: Element<Spatial>,
    /// Length (m) of the unloaded element minus the distance between its ends in the stack at rest; negative for a
    /// pretensioned element.
    give: f64,
    /// `true` for a guide whose first body may turn about the axis of the guide; see [`Guide::about_axis`].
    about_axis: bool,
    words: &'static Words,
}

impl Loose {
    fn new(element: impl Into<Element<Spatial>>, give: f64, words: &'static Words) -> Self {
        Self { element: element.into(), give, about_axis: false, words }
    }

    /// Attaches the element to the stack at rest: derives its unloaded length from the distance between its ends.
    fn tighten(self, state: &State<Spatial>) -> Element<Spatial> {
        let Self { mut element, give, about_axis, .. } = self;
        element.fit(state, give);
        match element {
            Element::Guide(guide) if about_axis => Guide::about_axis(guide).into(),
            Element::Strap(_) | Element::Rod(_) | Element::Guide(_) => element,
        }
    }
}

/// Installs all devices on a stack, one kind after the other.
pub(crate) fn place(builder: &mut Builder<'_>) -> Result<(), AssembleError> {
    let Devices { strap, walking_stop, chock: _, lid, pad: _, isolator, tie, tuned_mass } =
        &builder.spec.devices;
    strap::place(strap, builder)?;
    walking_stop::place(walking_stop, builder);
    lid::place(lid, builder);
    isolator::place(isolator, builder);
    tie::place(tie, builder)?;
    tuned_mass::place(tuned_mass, builder);
    Ok(())
}

impl Builder<'_> {
    /// Returns the rotation from the frame of a body to the frame of the stack.
    fn turned(&self, body: BodyId) -> Rotation3 {
        self.bodies[body].pose.orientation.matrix()
    }

    /// Transforms a position (m) from the frame of the stack to the frame of a body.
    fn within(&self, body: BodyId, place: Vec3) -> Vec3 {
        self.turned(body).unapply(place - self.bodies[body].pose.position)
    }

    /// Adds a polyline to the drawing of a body. The vertices (m) are in the frame of the stack.
    fn draw(&mut self, body: BodyId, line: &[Vec3]) {
        let line = line.iter().map(|place| self.within(body, *place)).collect();
        self.parts[body].lines.push(line);
    }

    /// Returns the bodies of a kind at or above a level, from the ground up.
    fn on_levels_from(&self, kind: PartKind, lowest: u32) -> Vec<BodyId> {
        let on = |id: &BodyId| self.parts[*id].kind == kind && self.parts[*id].level >= lowest;
        (0..self.parts.len()).filter(on).collect()
    }

    /// Returns the names and positions of four points: "left" and "right" at `x = ±across` (m), and "near" and "away"
    /// at `y = ±along` (m).
    ///
    /// In a mirrored stack the right point comes before the left point, so that the forces at the points are summed in
    /// mirrored order, too.
    fn sides(&self, across: f64, along: f64) -> [(&'static str, Vec3); 4] {
        let [left, right] =
            [("left", -across), ("right", across)].map(|(side, x)| (side, Vec3::new(x, 0.0, 0.0)));
        let [near, away] =
            [("near", -along), ("away", along)].map(|(side, y)| (side, Vec3::new(0.0, y, 0.0)));
        if self.spec.mirror { [right, left, near, away] } else { [left, right, near, away] }
    }

    /// Returns the rack that is on the same level as `rack` and is offset from it by the given numbers of columns and
    /// rows; `None` if there is no such rack.
    fn beside(&self, rack: BodyId, [columns, rows]: [i64; 2]) -> Option<BodyId> {
        let at = |id: BodyId| {
            let part = &self.parts[id];
            [part.level, part.column, part.row].map(i64::from)
        };
        let [level, column, row] = at(rack);
        let next = [level, column + columns, row + rows];
        (0..self.parts.len()).find(|id| self.parts[*id].kind == PartKind::Rack && at(*id) == next)
    }
}

impl Stack {
    /// Attaches the elements to the stack at rest in `state`; returns `true` if any element is then under load.
    pub(crate) fn fasten(&mut self, state: &mut State<Spatial>) -> Result<bool, ModelError> {
        let loose = std::mem::take(&mut self.loose);
        if loose.is_empty() {
            return Ok(false);
        }
        self.devices.extend(loose.iter().map(|loose| loose.words));
        let fit: Vec<_> = loose.into_iter().map(|loose| loose.tighten(state)).collect();
        let strained = fit.iter().any(|element| element.load(state).force != 0.0);
        let mut elements = self.model.elements().to_vec();
        elements.extend(fit);
        state.memory = vec![Memory::default(); elements.len()];
        self.model.fasten(elements)?;
        Ok(strained)
    }
}
