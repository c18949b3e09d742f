//! Sorts of bodies, and the laws between bodies of different stacks.
//!
//! Bodies of two stacks touch as bodies of one stack that fall on each other do.

use barrelstack::assemble::PartKind;
use barrelstack::scenario::{Scene, SpatialScene, StackPair};
use barrelstack_dynamics::join::{Crossing, Rule, Sort};
use barrelstack_dynamics::{Motion, Solid};
use barrelstack_space::Stack;

/// Kind of a body that meets foreign bodies.
#[derive(Clone, Debug, PartialEq)]
enum Kind {
    /// It meets none.
    Ground,
    Rack,
    Barrel,
    Device,
    /// A body of a free scene: index of the scene's laws among those of all scenes, its kind, and whether it is fixed.
    Free(usize, String, bool),
    Obstacle,
}

/// Sorts of the bodies of a room, and the laws of all free scenes.
#[derive(Default)]
pub(crate) struct Sorts<'a> {
    all: Vec<(Kind, Sort)>,
    scenes: Vec<&'a SpatialScene>,
}

impl<'a> Sorts<'a> {
    /// Returns the sort of every body of a stack.
    pub(crate) fn of_stack(&mut self, stack: &Stack, scene: &'a Scene) -> Vec<usize> {
        let free = match scene {
            Scene::Spatial(scene) => {
                let known =
                    self.scenes.iter().position(|other| other.interfaces == scene.interfaces);
                let book = known.unwrap_or_else(|| {
                    self.scenes.push(scene);
                    self.scenes.len() - 1
                });
                Some((scene, book))
            }
            Scene::Stack { .. } | Scene::Free(_) => None,
        };
        let bodies = stack.model.bodies().iter().zip(&stack.parts).enumerate();
        bodies
            .map(|(id, (body, part))| {
                let kind = match part.kind {
                    PartKind::Ground => Kind::Ground,
                    PartKind::Rack => Kind::Rack,
                    PartKind::Barrel => Kind::Barrel,
                    PartKind::Device | PartKind::Wine => Kind::Device,
                    PartKind::Body => free.map_or(Kind::Ground, |(scene, book)| {
                        let fixed = body.motion == Motion::Prescribed;
                        Kind::Free(book, scene.bodies[id - 1].kind().to_owned(), fixed)
                    }),
                };
                let unbounded =
                    body.surfaces.iter().any(|placed| placed.surface == Solid::HalfSpace);
                // Further node sets are bearings, which touch only their dishes.
                let surfaces = if unbounded { 0 } else { body.surfaces.len() };
                let sort = Sort { nodes: body.nodes.len().min(body.surfaces.len()), surfaces };
                self.add(kind, sort)
            })
            .collect()
    }

    /// Returns the sort of obstacles.
    pub(crate) fn of_obstacle(&mut self) -> usize {
        self.add(Kind::Obstacle, Sort { nodes: 0, surfaces: 1 })
    }

    fn add(&mut self, kind: Kind, sort: Sort) -> usize {
        let new = (kind, sort);
        self.all.iter().position(|known| *known == new).unwrap_or_else(|| {
            self.all.push(new);
            self.all.len() - 1
        })
    }

    /// Returns the laws between all sorts.
    pub(crate) fn crossing(&self) -> Crossing {
        let rule = |(first, _): &(Kind, Sort), (second, _): &(Kind, Sort)| self.rule(first, second);
        Crossing {
            sorts: self.all.iter().map(|(_, sort)| *sort).collect(),
            rules: self
                .all
                .iter()
                .map(|first| self.all.iter().map(|second| rule(first, second)).collect())
                .collect(),
        }
    }

    fn rule(&self, first: &Kind, second: &Kind) -> Option<Rule> {
        let by = |law: StackPair| Some(Rule { turned: false, laws: [law as usize; 2] });
        let turned = |rule: Option<Rule>| {
            rule.map(|Rule { turned, laws: [one, other] }| Rule {
                turned: !turned,
                laws: [other, one],
            })
        };
        match (first, second) {
            (Kind::Rack, Kind::Barrel) | (Kind::Barrel, Kind::Device) => {
                by(StackPair::FallenBarrelRack)
            }
            (Kind::Rack, Kind::Rack | Kind::Device) | (Kind::Device, Kind::Device) => {
                by(StackPair::FallenRackRack)
            }
            (Kind::Barrel, Kind::Barrel) => by(StackPair::BarrelBarrel),
            (Kind::Barrel | Kind::Device, Kind::Rack) | (Kind::Device, Kind::Barrel) => {
                turned(self.rule(second, first))
            }
            (Kind::Free(one, a, fixed), Kind::Free(other, b, other_fixed))
                if !(*fixed && *other_fixed) =>
            {
                let laws = [self.law(*one, a, b)?, self.law(*other, a, b)?];
                Some(Rule { turned: laws[0].1, laws: laws.map(|(law, _)| law) })
            }
            // An obstacle supplies the law itself.
            (
                Kind::Rack | Kind::Barrel | Kind::Device | Kind::Free(_, _, false),
                Kind::Obstacle,
            ) => Some(Rule { turned: false, laws: [0, 0] }),
            (
                Kind::Obstacle,
                Kind::Rack | Kind::Barrel | Kind::Device | Kind::Free(_, _, false),
            ) => Some(Rule { turned: true, laws: [0, 0] }),
            // What is fixed to the ground meets nothing fixed, and a free scene has no laws for stacks.
            (Kind::Free(..) | Kind::Ground | Kind::Obstacle, _)
            | (_, Kind::Free(..) | Kind::Ground) => None,
        }
    }

    /// Returns the index of the law between two kinds of a free scene, and `true` if it names the second kind first.
    fn law(&self, book: usize, a: &str, b: &str) -> Option<(usize, bool)> {
        let mut laws = self.scenes[book].interfaces.iter().enumerate();
        laws.find_map(|(at, law)| {
            let [one, other] = [law.between[0].as_str(), law.between[1].as_str()];
            ((one, other) == (a, b))
                .then_some((at, false))
                .or_else(|| ((other, one) == (a, b)).then_some((at, true)))
        })
    }
}
