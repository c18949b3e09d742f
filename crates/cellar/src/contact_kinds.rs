//! Contact kinds of bodies, and the contact laws between bodies of different stacks.
//!
//! Between bodies of different stacks, the same contact laws apply as between fallen bodies of one stack.

use barrelstack::assemble::PartKind;
use barrelstack::scenario::{Scene, SpatialScene, StackPair};
use barrelstack_dynamics::join::{ContactKind, Crossing, Rule};
use barrelstack_dynamics::{Motion, Solid};
use barrelstack_space::Stack;

/// Role of a body in contacts with bodies of other stacks.
#[derive(Clone, Debug, PartialEq)]
enum Role {
    /// The ground of a stack, which touches no body of another stack.
    Ground,
    Rack,
    Barrel,
    Device,
    /// A body of a free scene (arbitrary bodies in place of a stack): index of the scene in the list of contact laws,
    /// kind of the body, and `true` if the body is fixed.
    Free(usize, String, bool),
    Obstacle,
}

/// Contact kinds of the bodies of a room, and the contact laws of all free scenes.
#[derive(Default)]
pub(crate) struct ContactKinds<'a> {
    all: Vec<(Role, ContactKind)>,
    scenes: Vec<&'a SpatialScene>,
}

impl<'a> ContactKinds<'a> {
    /// Returns the index of the contact kind of every body of a stack. Kinds that are new are added.
    pub(crate) fn of_stack(&mut self, stack: &Stack, scene: &'a Scene) -> Vec<usize> {
        let free = match scene {
            Scene::Spatial(scene) => {
                let known =
                    self.scenes.iter().position(|other| other.interfaces == scene.interfaces);
                let scene_index = known.unwrap_or_else(|| {
                    self.scenes.push(scene);
                    self.scenes.len() - 1
                });
                Some((scene, scene_index))
            }
            Scene::Stack { .. } | Scene::Free(_) => None,
        };
        let bodies = stack.model.bodies().iter().zip(&stack.parts).enumerate();
        bodies
            .map(|(id, (body, part))| {
                let role = match part.kind {
                    PartKind::Ground => Role::Ground,
                    PartKind::Rack => Role::Rack,
                    PartKind::Barrel => Role::Barrel,
                    PartKind::Device | PartKind::Wine => Role::Device,
                    PartKind::Body => free.map_or(Role::Ground, |(scene, scene_index)| {
                        let fixed = body.motion == Motion::Prescribed;
                        Role::Free(scene_index, scene.bodies[id - 1].kind().to_owned(), fixed)
                    }),
                };
                let unbounded =
                    body.surfaces.iter().any(|placed| placed.surface == Solid::HalfSpace);
                // Further node sets belong to bearings, which touch only their dishes.
                let surfaces = if unbounded { 0 } else { body.surfaces.len() };
                let kind =
                    ContactKind { nodes: body.nodes.len().min(body.surfaces.len()), surfaces };
                self.add(role, kind)
            })
            .collect()
    }

    /// Returns the index of the contact kind of obstacles. The kind is added if it is new.
    pub(crate) fn of_obstacle(&mut self) -> usize {
        self.add(Role::Obstacle, ContactKind { nodes: 0, surfaces: 1 })
    }

    fn add(&mut self, role: Role, kind: ContactKind) -> usize {
        let new = (role, kind);
        self.all.iter().position(|known| *known == new).unwrap_or_else(|| {
            self.all.push(new);
            self.all.len() - 1
        })
    }

    /// Returns the contact laws between all contact kinds.
    pub(crate) fn crossing(&self) -> Crossing {
        let rule = |(first, _): &(Role, ContactKind), (second, _): &(Role, ContactKind)| {
            self.rule(first, second)
        };
        Crossing {
            kinds: self.all.iter().map(|(_, kind)| *kind).collect(),
            rules: self
                .all
                .iter()
                .map(|first| self.all.iter().map(|second| rule(first, second)).collect())
                .collect(),
        }
    }

    fn rule(&self, first: &Role, second: &Role) -> Option<Rule> {
        let by = |law: StackPair| Some(Rule { reversed: false, laws: [law as usize; 2] });
        let exchanged = |rule: Option<Rule>| {
            rule.map(|Rule { reversed, laws: [one, other] }| Rule {
                reversed: !reversed,
                laws: [other, one],
            })
        };
        match (first, second) {
            (Role::Rack, Role::Barrel) | (Role::Barrel, Role::Device) => {
                by(StackPair::FallenBarrelRack)
            }
            (Role::Rack, Role::Rack | Role::Device) | (Role::Device, Role::Device) => {
                by(StackPair::FallenRackRack)
            }
            (Role::Barrel, Role::Barrel) => by(StackPair::BarrelBarrel),
            (Role::Barrel | Role::Device, Role::Rack) | (Role::Device, Role::Barrel) => {
                exchanged(self.rule(second, first))
            }
            (Role::Free(one, a, fixed), Role::Free(other, b, other_fixed))
                if !(*fixed && *other_fixed) =>
            {
                let laws = [self.law(*one, a, b)?, self.law(*other, a, b)?];
                Some(Rule { reversed: laws[0].1, laws: laws.map(|(law, _)| law) })
            }
            // The contact law of an obstacle is stated with the obstacle.
            (
                Role::Rack | Role::Barrel | Role::Device | Role::Free(_, _, false),
                Role::Obstacle,
            ) => Some(Rule { reversed: false, laws: [0, 0] }),
            (
                Role::Obstacle,
                Role::Rack | Role::Barrel | Role::Device | Role::Free(_, _, false),
            ) => Some(Rule { reversed: true, laws: [0, 0] }),
            // Fixed bodies do not touch each other, and a free scene has no contact laws for bodies of stacks.
            (Role::Free(..) | Role::Ground | Role::Obstacle, _)
            | (_, Role::Free(..) | Role::Ground) => None,
        }
    }

    /// Returns the index of the contact law between two kinds of a free scene, and `true` if the law names the second
    /// kind first; `None` if the scene has no law for these kinds.
    fn law(&self, scene_index: usize, a: &str, b: &str) -> Option<(usize, bool)> {
        let mut laws = self.scenes[scene_index].interfaces.iter().enumerate();
        laws.find_map(|(at, law)| {
            let [one, other] = [law.between[0].as_str(), law.between[1].as_str()];
            ((one, other) == (a, b))
                .then_some((at, false))
                .or_else(|| ((other, one) == (a, b)).then_some((at, true)))
        })
    }
}
