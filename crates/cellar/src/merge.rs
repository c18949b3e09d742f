//! Merges of islands.

use std::sync::Arc;

use barrelstack::run::Work;
use barrelstack_dynamics::join::{Carry, Frame, Party, Source, carry, joined};
use barrelstack_dynamics::{EnergySummary, ModelError, Simulation};

use crate::history::summed;
use crate::island::{Fixed, Island, Live, Logs, Member, Owner, plus};
use crate::result::RoomFrames;
use crate::world::World;

/// Islands and obstacles that become one island.
struct Plan<'a> {
    world: &'a World<'a>,
    /// For every stack, in the order of the names of the stacks: index of its source island, and index of the stack
    /// among the members of that island.
    members: Vec<(usize, usize)>,
    /// For each member, the index of its stack in the room.
    stacks: Vec<usize>,
    obstacles: Vec<usize>,
    /// Placement of the frame of the merged island in the room.
    frame: Frame,
}

impl Plan<'_> {
    /// Returns the models to be joined: those of the stacks, followed by those of the obstacles.
    fn parties(&self) -> Vec<Party<'_>> {
        let Self { world, frame, .. } = self;
        let stacks = self.stacks.iter().map(|stack| {
            let of = &world.stacks[*stack];
            Party {
                name: of.name,
                model: &of.stack.model,
                kinds: &of.kinds,
                rank: of.rank,
                frame: of.frame.within(*frame),
                step: of.simulation.time_step,
            }
        });
        let obstacles = self.obstacles.iter().map(|obstacle| {
            let of = &world.obstacles[*obstacle];
            let frame = Frame::default().within(*frame);
            let (model, kinds) = (&of.model, &of.kinds[..]);
            Party { name: "", model, kinds, rank: of.rank, frame, step: of.step }
        });
        stacks.chain(obstacles).collect()
    }

    /// Returns three lists: the states to copy from the islands to the merged island, the members of the merged island,
    /// and the owners of its bodies.
    fn places(&self, islands: &[Island]) -> (Vec<Carry>, Vec<Member>, Vec<Owner>) {
        let (mut carries, mut members, mut owners) = (Vec::new(), Vec::new(), Vec::new());
        let mut elements = 0;
        for ((source, member), stack) in self.members.iter().zip(&self.stacks) {
            let Member { bodies, elements: old, .. } =
                islands[*source].fixed.members[*member].clone();
            let (first, count, held) = (owners.len(), bodies.len(), old.len());
            owners.extend((0..count).map(|body| Owner::Stack((*stack, body))));
            carries.push(Carry { source: *source, bodies, to: first, elements: old });
            members.push(Member {
                stack: *stack,
                bodies: first..first + count,
                elements: elements..elements + held,
                frame: self.world.stacks[*stack].frame.within(self.frame),
            });
            elements += held;
        }
        owners.extend(self.obstacles.iter().map(|obstacle| Owner::Obstacle(*obstacle)));
        (carries, members, owners)
    }

    /// Moves the watches and the contact records of the islands into `live`, the state of the merged island. Returns
    /// the logs of the merged island: frames of its stacks, and forces on its obstacles.
    fn hand_over(&self, islands: Vec<Island>, live: &mut Live) -> Logs {
        let time = live.running.state.time;
        let mut watches = vec![None; self.members.len()];
        let mut logs = Logs {
            frames: vec![RoomFrames::default(); self.members.len()],
            forces: vec![Vec::new(); self.obstacles.len()],
        };
        for (source, island) in islands.into_iter().enumerate() {
            let turn = island.fixed.frame.within(self.frame);
            let slept = !island.is_awake();
            for (parties, mut contact) in island.live.contacts {
                contact.last = turn.vector(contact.last);
                live.contacts.insert(parties, contact);
            }
            let own = island.live.watches.into_iter().zip(island.logs.frames);
            for (member, (mut watch, frames)) in own.enumerate() {
                if slept {
                    watch.rest.wake(time);
                }
                if let Some(at) = self.members.iter().position(|own| *own == (source, member)) {
                    (watches[at], logs.frames[at]) = (Some(watch), frames);
                }
            }
            for (obstacle, log) in island.fixed.obstacles.iter().zip(island.logs.forces) {
                if let Ok(at) = self.obstacles.binary_search(obstacle) {
                    logs.forces[at] = summed(&logs.forces[at], &log);
                }
            }
        }
        live.watches = watches.into_iter().flatten().collect();
        logs
    }
}

/// Merges islands that have reached the same time, together with obstacles.
///
/// # Errors
/// If two bodies have the same name.
pub(crate) fn merged(
    world: &World<'_>,
    islands: Vec<Island>,
    obstacles: &[usize],
) -> Result<Island, ModelError> {
    let (mut members, mut all) = (Vec::new(), obstacles.to_vec());
    for (source, island) in islands.iter().enumerate() {
        members.extend((0..island.fixed.members.len()).map(|member| (source, member)));
        all.extend(&island.fixed.obstacles);
    }
    let stack_of =
        |(source, member): &(usize, usize)| islands[*source].fixed.members[*member].stack;
    members.sort_by_key(|place| world.stacks[stack_of(place)].rank);
    all.sort_unstable();
    all.dedup();
    let stacks: Vec<usize> = members.iter().map(stack_of).collect();
    let frame = world.stacks[stacks[0]].frame;
    let plan = Plan { world, members, stacks, obstacles: all, frame };
    let (model, step) = joined(&plan.parties(), &world.crossing)?;
    let (carries, members, owners) = plan.places(&islands);
    let drive = world.room.ground.clone().turned(frame.azimuth);
    let simulation = Simulation { time_step: step, ..islands[0].fixed.simulation };
    let sources: Vec<Source<'_>> = islands
        .iter()
        .map(|island| Source {
            model: &island.fixed.model,
            state: &island.live.running.state,
            scratch: &island.live.running.scratch,
            stepper: &island.live.running.stepper,
            frame: island.fixed.frame.within(frame),
        })
        .collect();
    let mut live = Live::of(carry(&model, &drive, &sources, &carries, &simulation), Vec::new());
    let (mut energy_before, mut work) = (EnergySummary::default(), Work::default());
    for island in &islands {
        // The merged island counts the energy that is stored at the merge, so this energy is left out here.
        let own = EnergySummary { kinetic: 0.0, elastic: 0.0, stick: 0.0, ..island.energy() };
        energy_before = plus(energy_before, &own);
        let own = island.work();
        work.steps += own.steps;
        work.evaluations += own.evaluations;
        work.contact_evaluations += own.contact_evaluations;
    }
    let every = islands[0].every;
    let logs = plan.hand_over(islands, &mut live);
    let (obstacles, model) = (plan.obstacles, Arc::new(model));
    let fixed = Fixed { members, obstacles, owners, model, drive, frame, simulation };
    let mut island = Island::of(fixed, live, logs, every);
    (island.energy_before, island.work) = (energy_before, work);
    Ok(island)
}
