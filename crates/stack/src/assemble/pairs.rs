//! Contact pairs of a stack: the boundaries that can touch, each pair with its contact law.
//!
//! A barrel touches its rack at the supports of the cradle. The underside of a rack touches the bodies on which the
//! rack stands. These contacts are the seats. All other contacts occur in impacts only.
//!
//! A barrel with a circular section touches another solid at the point of the circle that is deepest in that solid. Two
//! solids with corners touch at the corners and arcs of both, so each of the two solids is tested against the other. A
//! face with nodes touches at its nodes while the body that it carries lies in front of the face. Once that body has
//! moved beside the face, its contacts are found without the nodes, so that no contact counts twice.

use barrelstack_dynamics::{BodyId, ContactPair, Counts, Nodes};

use super::builder::Builder;
use super::solid::{NodedFace, Seat, Touch};
use super::{Assembly, PartKind};
use crate::scenario::{Basis, StackPair};

/// Returns all pairs of boundaries that can touch, each with its interface.
pub(super) fn pairs(builder: &Builder<'_>) -> Vec<ContactPair> {
    let mut pairs = Pairs { builder, list: Vec::new() };
    let count = builder.bodies.len();
    for a in 1..count {
        pairs.with_ground(a);
        for b in a + 1..count {
            match (builder.parts[a].kind, builder.parts[b].kind) {
                (PartKind::Rack, PartKind::Rack) => pairs.racks(a, b),
                (PartKind::Rack, PartKind::Barrel) => pairs.rack_and_barrel(a, b),
                (PartKind::Barrel, PartKind::Rack) => pairs.rack_and_barrel(b, a),
                (PartKind::Barrel, PartKind::Barrel) => {
                    pairs.exact((a, 0), (b, 0), StackPair::BarrelBarrel, [Counts::Everywhere; 2]);
                }
                (PartKind::Rack, PartKind::Device) => pairs.rack_and_device(a, b),
                (PartKind::Barrel, PartKind::Device) => {
                    pairs.solids_of(a, b, StackPair::FallenBarrelRack);
                }
                (PartKind::Device, PartKind::Device) => {
                    pairs.solids_of(a, b, StackPair::FallenRackRack);
                }
                (PartKind::Wine, _) | (_, PartKind::Wine) => {}
                (PartKind::Device, PartKind::Rack | PartKind::Barrel)
                | (PartKind::Ground | PartKind::Body, _)
                | (_, PartKind::Ground | PartKind::Body) => {
                    unreachable!("barrels and racks on one ground come first, then devices")
                }
            }
        }
    }
    pairs.list.extend(&builder.pairs);
    pairs.list
}

struct Pairs<'a> {
    builder: &'a Builder<'a>,
    list: Vec<ContactPair>,
}

impl Pairs<'_> {
    fn touch(&self, body: BodyId, solid: usize) -> Touch {
        self.builder.touches[body][solid]
    }

    fn solids(&self, body: BodyId) -> std::ops::Range<usize> {
        0..self.builder.touches[body].len()
    }

    /// Adds the contact pair between a node set of one body and a surface of another.
    fn push(
        &mut self,
        (contactor, nodes): (BodyId, usize),
        (target, surface): (BodyId, usize),
        pair: StackPair,
        counts: Counts,
    ) {
        let parts = &self.builder.parts;
        let in_cradle = pair == StackPair::BarrelRack
            && (parts[contactor].carrier == Some(target)
                || parts[target].carrier == Some(contactor));
        let interface = if in_cradle { self.builder.cradle_law } else { pair as usize };
        self.list.push(ContactPair { contactor, nodes, target, surface, interface, counts });
    }

    /// Adds the contact pairs of two solids, without nodes along their faces: one pair if a solid is a circle,
    /// otherwise two pairs, which test the corners and arcs of each solid against the other.
    ///
    /// `counts` selects the contacts that count: its first element applies to the pair in which the first solid is the
    /// contactor, and its second element to the pair in which the second solid is the contactor.
    fn exact(
        &mut self,
        (a, solid_a): (BodyId, usize),
        (b, solid_b): (BodyId, usize),
        pair: StackPair,
        counts: [Counts; 2],
    ) {
        let sets = [(a, self.touch(a, solid_a).exact), (b, self.touch(b, solid_b).exact)];
        let rolls = sets
            .map(|(id, set)| matches!(self.builder.bodies[id].nodes[set], Nodes::Rolling { .. }));
        if rolls[0] || !rolls[1] {
            self.push(sets[0], (b, solid_b), pair, counts[0]);
        }
        if !rolls[0] {
            self.push(sets[1], (a, solid_a), pair, counts[1]);
        }
    }

    /// Returns the underside with which a solid stands on a floor; `None` if the contact uses no row of nodes.
    ///
    /// If the constants of the contact law are stated per seat, a tube that spans the whole rack has one seat at each
    /// end instead of a row of nodes.
    fn row_on_floor(&self, touch: &Touch) -> Option<NodedFace> {
        let per_seat = self.builder.spec.interfaces.rack_ground.basis == Basis::Seat;
        touch.below.filter(|_| !(per_seat && touch.seat == Seat::OnSupports))
    }

    fn with_ground(&mut self, body: BodyId) {
        let part = &self.builder.parts[body];
        let stands = part.kind == PartKind::Rack && part.supports.is_empty();
        let kind = part.kind;
        for solid in self.solids(body) {
            let touch = self.touch(body, solid);
            let ground = (Assembly::GROUND, 0);
            let seat = stands && touch.seat.stands();
            let interface = match (kind, seat) {
                (PartKind::Rack, true) => StackPair::RackGround,
                (PartKind::Rack, false) | (PartKind::Device, _) => StackPair::FallenRackGround,
                (PartKind::Barrel | PartKind::Wine | PartKind::Ground | PartKind::Body, _) => {
                    StackPair::BarrelGround
                }
            };
            match self.row_on_floor(&touch).filter(|_| seat) {
                Some(face) => {
                    self.push((body, face.nodes), ground, interface, Counts::Everywhere);
                    self.push((body, face.others), ground, interface, Counts::Everywhere);
                }
                None => self.push((body, touch.exact), ground, interface, Counts::Everywhere),
            }
        }
    }

    fn rack_and_barrel(&mut self, rack: BodyId, barrel: BodyId) {
        let parts = &self.builder.parts;
        let carried = (parts[barrel].carrier == Some(rack)).then(|| {
            let first = parts.iter().position(|part| part.carrier == Some(rack));
            barrel - first.unwrap_or(barrel)
        });
        let support = parts[rack].supports.iter().position(|support| *support == barrel);
        for solid in self.solids(rack) {
            let touch = self.touch(rack, solid);
            if touch.out_of_plane {
                continue;
            }
            let seat = match touch.seat {
                Seat::Barrel(column) => carried == Some(column),
                Seat::OnSupport(column) => support == Some(column),
                Seat::OnSupports => support.is_some(),
                Seat::Along(column) => carried == Some(column) || support == Some(column),
                Seat::None | Seat::Rack => false,
            };
            let interface = if seat { StackPair::BarrelRack } else { StackPair::FallenBarrelRack };
            let face = if carried.is_some() { touch.above } else { touch.below };
            let counts = if let Some(face) = face.filter(|_| seat) {
                let before = Counts::BeforeFace(face.face);
                self.push((rack, face.nodes), (barrel, 0), interface, before);
                [Counts::BehindFaceOfTarget(face.face), Counts::BehindFace(face.face)]
            } else {
                [Counts::Everywhere; 2]
            };
            self.exact((barrel, 0), (rack, solid), interface, counts);
        }
    }

    /// Adds the contact pairs of every solid of one body with every solid of another body.
    fn solids_of(&mut self, a: BodyId, b: BodyId, pair: StackPair) {
        for of_a in self.solids(a) {
            for of_b in self.solids(b) {
                self.exact((a, of_a), (b, of_b), pair, [Counts::Everywhere; 2]);
            }
        }
    }

    /// Adds the contact pairs of a rack with a device. A rack stands on the platform of an isolator in the same way as
    /// on the ground.
    fn rack_and_device(&mut self, rack: BodyId, device: BodyId) {
        let carried = self.builder.parts[rack].carrier == Some(device);
        for solid in self.solids(rack) {
            let touch = self.touch(rack, solid);
            let seat = carried && touch.seat.stands();
            let pair = if seat { StackPair::RackGround } else { StackPair::FallenRackRack };
            for of_device in self.solids(device) {
                let both = [Counts::Everywhere; 2];
                match self.row_on_floor(&touch).filter(|_| seat) {
                    Some(face) => {
                        let before = Counts::BeforeFace(face.face);
                        self.push((rack, face.nodes), (device, of_device), pair, before);
                        let behind =
                            [Counts::BehindFace(face.face), Counts::BehindFaceOfTarget(face.face)];
                        self.exact((rack, solid), (device, of_device), pair, behind);
                    }
                    None => self.exact((rack, solid), (device, of_device), pair, both),
                }
            }
        }
    }

    fn racks(&mut self, lower: BodyId, upper: BodyId) {
        let stands = self.builder.parts[upper].supports.contains(&lower);
        for below in self.solids(lower) {
            for above in self.solids(upper) {
                let seat = stands
                    && self.touch(lower, below).seat == Seat::Rack
                    && self.touch(upper, above).seat == Seat::OnSupports;
                let interface = if seat { StackPair::RackRack } else { StackPair::FallenRackRack };
                self.exact((lower, below), (upper, above), interface, [Counts::Everywhere; 2]);
            }
        }
    }
}
