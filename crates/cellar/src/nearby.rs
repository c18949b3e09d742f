//! Bodies of different islands that are near each other, and how far each may move before two of them can touch.
//!
//! The gap between two bodies is measured when it may have become small. After a measurement, the gap can shrink by at
//! most the sum of the distances that the two bodies travel. This sum is updated in each time window, and the gap is
//! measured again only when the sum may have closed it.

use barrelstack::watch::Ending;
use barrelstack_dynamics::join::gap_between;
use barrelstack_dynamics::space::Linear as _;
use barrelstack_dynamics::{BodyId, Motion, Pose, Spatial, Vec3};

use crate::island::{Island, Owner, StackBody};
use crate::world::World;

/// Gap (m) below which two bodies are put on the list of pairs; for this purpose, the gap is estimated from the
/// bounding spheres of the bodies.
const MARGIN: f64 = 0.4;

/// Displacement (m) of a body after which the list of pairs is rebuilt.
const STALE: f64 = 0.1;

/// Distance (m) that a body may move in a window if no other body is near; it corresponds to a speed of 45 m/s.
pub(crate) const FREE: f64 = 0.09;

/// Gap (m) below which islands are merged: two islands become one if a gap between their bodies might become smaller
/// than this in a window. They are thus merged before their bodies touch.
const SLACK: f64 = 2e-3;

/// Allowance (m) that is added to the predicted travel of a body in a window, so that even a body at rest may move.
const LEAST: f64 = 1e-3;

/// Gap (m) up to which gaps are measured exactly. A lower bound suffices for a gap that exceeds both this value and
/// twice the predicted approach of the two bodies.
const EXACT: f64 = 0.1;

/// A pair of bodies that are near each other: two bodies of different stacks, or a body and an obstacle.
struct Couple {
    bodies: [Owner; 2],
    /// Gap (m) at the last measurement, or a lower bound on it.
    gap: f64,
    /// Lengths (m) of the paths of the two bodies at the last measurement of the gap.
    since: [f64; 2],
    /// For each of the two bodies, the length (m) that its path must not exceed in this window.
    limits: [f64; 2],
}

/// Pairs of bodies that are near each other, and the lengths of the paths of all bodies.
pub(crate) struct Nearby {
    couples: Vec<Couple>,
    /// For every body, the indices of its pairs in `couples`.
    of_body: Vec<Vec<u32>>,
    /// Length (m) of the path of every body, summed over all windows so far.
    paths: Vec<f64>,
    /// Positions (m) of the bodies in the room when the list of pairs was made.
    made_for: Vec<Vec3>,
}

/// For every stack, the index of its island, and the ID of its first body in the model of the island.
pub(crate) type Places = Vec<(usize, BodyId)>;

impl Nearby {
    pub(crate) fn new(world: &World<'_>) -> Self {
        let count = world.count + world.obstacles.len();
        Self {
            couples: Vec::new(),
            of_body: vec![Vec::new(); count],
            paths: vec![0.0; count],
            made_for: Vec::new(),
        }
    }

    /// Rebuilds the list of pairs if a body has moved more than [`STALE`].
    pub(crate) fn refresh(&mut self, world: &World<'_>, islands: &[Option<Island>]) {
        let moved = |(place, made): (&Vec3, &Vec3)| {
            let moved_by = *place - *made;
            moved_by.dot(moved_by) > STALE * STALE
        };
        let mut places = self.made_for.clone();
        places.resize(world.count, Vec3::default());
        for island in islands.iter().flatten() {
            // A failed island may contain numbers that are not finite.
            if island.live.ending == Some(Ending::Broken) && !self.made_for.is_empty() {
                continue;
            }
            for (body, owner) in island.fixed.owners.iter().enumerate() {
                if let Owner::Stack(_) = owner {
                    places[world.number(*owner)] = island.in_room(body).position;
                }
            }
        }
        if self.made_for.is_empty() || places.iter().zip(&self.made_for).any(moved) {
            self.make(world, islands, places);
        }
    }

    fn make(&mut self, world: &World<'_>, islands: &[Option<Island>], places: Vec<Vec3>) {
        let mut island_of = vec![0; world.stacks.len()];
        for (number, island) in islands.iter().enumerate() {
            for member in island.iter().flat_map(|island| &island.fixed.members) {
                island_of[member.stack] = number;
            }
        }
        let rules = &world.crossing.rules;
        let mut balls: Vec<(f64, f64, StackBody)> = Vec::new();
        for (stack, of) in world.stacks.iter().enumerate() {
            for body in 0..of.kinds.len() {
                let meets = rules[of.kinds[body]].iter().any(Option::is_some);
                if meets {
                    let half = of.reach[body] + 0.5 * MARGIN;
                    let x = places[of.first + body].x;
                    balls.push((x - half, x + half, (stack, body)));
                }
            }
        }
        balls.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
        let place = |(stack, body): StackBody| places[world.stacks[stack].first + body];
        let reach = |(stack, body): StackBody| world.stacks[stack].reach[body];
        let kind = |(stack, body): StackBody| world.stacks[stack].kinds[body];
        let mut found: Vec<([Owner; 2], f64)> = Vec::new();
        let mut open: Vec<(f64, StackBody)> = Vec::new();
        for (from, to, body) in balls {
            open.retain(|(end, _)| from <= *end);
            for (_, other) in &open {
                let bodies = [body.min(*other), body.max(*other)];
                let [one, two] = bodies;
                if island_of[one.0] == island_of[two.0] || rules[kind(one)][kind(two)].is_none() {
                    continue;
                }
                let gap = (place(one) - place(two)).length() - reach(one) - reach(two);
                if gap < MARGIN {
                    found.push((bodies.map(Owner::Stack), gap));
                }
            }
            open.push((to, body));
        }
        for (number, obstacle) in world.obstacles.iter().enumerate() {
            let block = &obstacle.model.bodies()[0];
            for (stack, of) in world.stacks.iter().enumerate() {
                let inside = |island: &Island| island.fixed.obstacles.contains(&number);
                if islands[island_of[stack]].as_ref().is_some_and(inside) {
                    continue;
                }
                for (body, of_body) in of.stack.model.bodies().iter().enumerate() {
                    if of_body.motion == Motion::Prescribed
                        || rules[of.kinds[body]][obstacle.kinds[0]].is_none()
                    {
                        continue;
                    }
                    let arm = place((stack, body)) - block.pose.position;
                    let at = block.pose.orientation.matrix().unapply(arm);
                    let half = world.room.obstacles[number].half;
                    let past = Vec3::new(
                        (at.x.abs() - half[0]).max(0.0),
                        (at.y.abs() - half[1]).max(0.0),
                        (at.z.abs() - half[2]).max(0.0),
                    );
                    let gap = past.length() - of.reach[body];
                    if gap < MARGIN {
                        found.push(([Owner::Stack((stack, body)), Owner::Obstacle(number)], gap));
                    }
                }
            }
        }
        found.sort_unstable_by_key(|(bodies, _)| *bodies);
        // Gaps that were measured are kept.
        let old = std::mem::take(&mut self.couples);
        for couples in &mut self.of_body {
            couples.clear();
        }
        for (bodies, gap) in found {
            let numbers = bodies.map(|owner| world.number(owner));
            let since = numbers.map(|number| self.paths[number]);
            let known = old.binary_search_by(|couple| couple.bodies.cmp(&bodies)).ok();
            let known = known.map(|at| (old[at].bound(&self.paths, numbers), &old[at]));
            let (gap, since) = match known {
                Some((bound, couple)) if bound > gap => (couple.gap, couple.since),
                _ => (gap, since),
            };
            let number = u32::try_from(self.couples.len()).unwrap_or(u32::MAX);
            for body in numbers {
                self.of_body[body].push(number);
            }
            self.couples.push(Couple { bodies, gap, since, limits: [f64::INFINITY; 2] });
        }
        self.made_for = places;
    }

    /// Returns all pairs (two bodies of different islands, or a body and an obstacle) that may touch within a time
    /// `ahead` (s). For all other pairs, sets how far their bodies may move.
    pub(crate) fn meetings(
        &mut self,
        world: &World<'_>,
        islands: &[Option<Island>],
        places: &Places,
        ahead: f64,
    ) -> Vec<[Owner; 2]> {
        let mut meetings = Vec::new();
        for couple in &mut self.couples {
            let located = couple.bodies.map(|owner| locate(islands, places, owner));
            let [Some((first, _)), second] = located else { continue };
            let second_island = second.map(|(island, _)| island);
            let inside = |obstacle| first.fixed.obstacles.contains(&obstacle);
            let together = match couple.bodies[1] {
                Owner::Stack((stack, _)) => {
                    let Owner::Stack((own, _)) = couple.bodies[0] else { continue };
                    places[stack].0 == places[own].0
                }
                Owner::Obstacle(obstacle) => inside(obstacle),
            };
            // After a failed computation, poses may not be finite, and gaps are unknown.
            let broken = |island: Option<&Island>| {
                island.is_some_and(|island| island.live.ending == Some(Ending::Broken))
            };
            if together || broken(Some(first)) || broken(second_island) {
                couple.limits = [f64::INFINITY; 2];
                continue;
            }
            let is_awake = |island: Option<&Island>| island.is_some_and(Island::is_awake);
            let moves = is_awake(Some(first)) || is_awake(second_island);
            let needs = located.map(|located| match located {
                Some((island, body)) if island.is_awake() => {
                    let step = island.fixed.simulation.time_step;
                    LEAST + 1.5 * island.speed(world, body) * (ahead + 2.0 * step)
                }
                // An island at rest may be woken within the window.
                Some(_) => LEAST,
                None => 0.0,
            });
            let need = needs[0] + needs[1];
            let numbers = couple.bodies.map(|owner| world.number(owner));
            let mut bound = couple.bound(&self.paths, numbers);
            if moves && bound < need + SLACK {
                bound = gap(world, islands, places, couple.bodies, EXACT.max(2.0 * need));
                couple.gap = bound;
                couple.since = numbers.map(|number| self.paths[number]);
            }
            if moves && bound < need + SLACK {
                meetings.push(couple.bodies);
                couple.limits = [f64::INFINITY; 2];
            } else {
                for side in 0..2 {
                    let share = (bound - SLACK).max(0.0) * needs[side] / need;
                    couple.limits[side] = self.paths[numbers[side]] + share;
                }
            }
        }
        meetings
    }

    /// Returns how far (m) each body of an island may move, and `true` if another island or an obstacle is near.
    pub(crate) fn limit(
        &self,
        world: &World<'_>,
        islands: &[Option<Island>],
        places: &Places,
        island: usize,
    ) -> (Vec<f64>, bool) {
        let Some(of) = &islands[island] else { return (Vec::new(), false) };
        let mut near = false;
        let tube = |owner: &Owner| {
            let number = world.number(*owner);
            let mut least = FREE;
            for couple in &self.of_body[number] {
                let couple = &self.couples[*couple as usize];
                if Self::parted(couple, places, of) {
                    near = true;
                    let side = usize::from(couple.bodies[0] != *owner);
                    least = least.min(couple.limits[side] - self.paths[number]);
                }
            }
            least
        };
        (of.fixed.owners.iter().map(tube).collect(), near)
    }

    /// Returns `true` if the two bodies of a pair, one of which belongs to `island`, are not in the same island.
    fn parted(couple: &Couple, places: &Places, island: &Island) -> bool {
        match couple.bodies {
            [Owner::Stack((one, _)), Owner::Stack((other, _))] => places[one].0 != places[other].0,
            [_, Owner::Obstacle(obstacle)] => !island.fixed.obstacles.contains(&obstacle),
            [Owner::Obstacle(_), Owner::Stack(_)] => false,
        }
    }

    /// Returns the body or obstacle that most restricts how far a body may move, if there is one.
    pub(crate) fn nearest_to(
        &self,
        world: &World<'_>,
        places: &Places,
        island: &Island,
        body: BodyId,
    ) -> Option<Owner> {
        let owner = island.fixed.owners[body];
        let couples = self.of_body[world.number(owner)].iter();
        let parted = couples
            .map(|couple| &self.couples[*couple as usize])
            .filter(|couple| Self::parted(couple, places, island));
        let side = |couple: &Couple| usize::from(couple.bodies[0] != owner);
        let nearest = parted.min_by(|a, b| a.limits[side(a)].total_cmp(&b.limits[side(b)]))?;
        nearest.limits[side(nearest)].is_finite().then(|| nearest.bodies[1 - side(nearest)])
    }

    /// Adds the distances that the bodies of an island have moved in a window to the lengths of their paths.
    pub(crate) fn add(&mut self, world: &World<'_>, island: &mut Island) {
        for (owner, travel) in island.fixed.owners.iter().zip(&mut island.live.travels) {
            self.paths[world.number(*owner)] += std::mem::take(travel);
        }
    }
}

impl Couple {
    /// Returns a lower bound on the current gap (m): the measured gap, less the lengths of the paths of both bodies
    /// since the measurement. `numbers` are the indices of the two bodies in `paths`.
    fn bound(&self, paths: &[f64], numbers: [usize; 2]) -> f64 {
        let [one, other] = numbers.map(|number| paths[number]);
        self.gap - (one - self.since[0]) - (other - self.since[1])
    }
}

/// Returns the island that contains a body, and the ID of the body in the model of this island; `None` for an obstacle.
pub(crate) fn locate<'a>(
    islands: &'a [Option<Island>],
    places: &Places,
    owner: Owner,
) -> Option<(&'a Island, BodyId)> {
    let Owner::Stack((stack, body)) = owner else { return None };
    let (island, first) = places[stack];
    Some((islands[island].as_ref()?, first + body))
}

/// Returns the gap (m) between two bodies, or a lower bound on the gap if it exceeds `enough` (m).
pub(crate) fn gap(
    world: &World<'_>,
    islands: &[Option<Island>],
    places: &Places,
    bodies: [Owner; 2],
    enough: f64,
) -> f64 {
    let pose = |owner: Owner| -> Pose<Spatial> {
        match locate(islands, places, owner) {
            Some((island, body)) => island.in_room(body),
            None => world.body(owner).0.pose,
        }
    };
    let [(_, first), (_, second)] = bodies.map(|owner| world.body(owner));
    let turned = world.crossing.rules[first][second].is_some_and(|rule| rule.reversed);
    let [contactor, target] = if turned { [bodies[1], bodies[0]] } else { bodies };
    let kinds = &world.crossing.kinds;
    let ((one, kind), (other, kind_of_other)) = (world.body(contactor), world.body(target));
    gap_between(
        (one, pose(contactor), kinds[kind].nodes),
        (other, pose(target), kinds[kind_of_other].surfaces),
        enough,
    )
}
