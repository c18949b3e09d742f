//! Three-dimensional scene of a run, which can be rotated on the HTML page.

use barrelstack::assemble::PartKind;
use barrelstack_dynamics::{Body, Element, Solid, Spatial, Vec3};
use barrelstack_report::{
    Depth, DepthBody, DepthPoses, DepthTie, Event, Moment, Point3, Role, Volume,
};

use super::{PLATE, Sight, events, moment, top};
use crate::part::Part;
use crate::run::Run;

/// Number of intervals into which the profile of a barrel is divided.
const PARTS: u32 = 12;

/// Returns the three-dimensional scene of a run in the given frames, with the events of all flat views: losses of
/// seat, falls, and failures of devices.
pub(super) fn depth(run: &Run, frames: &[usize]) -> Depth {
    let bodies = run.stack.parts.iter().zip(run.stack.model.bodies());
    let own: Vec<usize> = (0..run.stack.parts.len()).collect();
    let mut all: Vec<_> = Sight::ALL.iter().flat_map(|sight| events(run, &own, *sight)).collect();
    all.sort_by(|a, b| a.time.total_cmp(&b.time));
    let straps = run.devices().filter_map(|((element, _), fate)| match element {
        Element::Strap(strap) => Some(DepthTie {
            bodies: strap.link.bodies,
            points: strap.link.points.map(point),
            torn_at: fate.broken_at,
        }),
        Element::Rod(_) | Element::Guide(_) => None,
    });
    Depth {
        bodies: bodies.map(|(part, body)| drawn(part, body)).collect(),
        poses: DepthPoses::Free(
            frames.iter().map(|frame| run.frames.poses[*frame].clone()).collect(),
        ),
        ties: straps.collect(),
        events: all,
        moment: moment(run, &own),
        paths: top(run).collect(),
        forces: forces(run, frames),
        panes: Sight::ALL.map(Sight::axes).to_vec(),
    }
}

/// Returns a three-dimensional scene that contains a floor, as its first body, and the given bodies with their names.
/// `poses` contains the poses of all bodies in every frame.
pub(super) fn of_bodies<'a>(
    bodies: impl Iterator<Item = (&'a Part, &'a Body<Spatial>, &'a str)>,
    poses: Vec<Vec<[f64; 7]>>,
    events: Vec<Event>,
    moment: Option<Moment>,
) -> Depth {
    let floor = DepthBody {
        name: "ground".to_owned(),
        role: Role::Ground,
        volumes: Vec::new(),
        rows: vec![[0.0; 3]],
    };
    let named =
        bodies.map(|(part, body, name)| DepthBody { name: name.to_owned(), ..drawn(part, body) });
    Depth {
        bodies: std::iter::once(floor).chain(named).collect(),
        poses: DepthPoses::Free(poses),
        ties: Vec::new(),
        events,
        moment,
        paths: Vec::new(),
        forces: Vec::new(),
        panes: Vec::new(),
    }
}

/// Returns, for each of the given frames, the list of contact forces: the point (m) and the components (N) of each
/// force. A contact pair keeps its index in the lists as long as it is in contact. At an index without a contact pair,
/// the force is zero.
fn forces(run: &Run, frames: &[usize]) -> Vec<Vec<[Point3; 2]>> {
    let mut places: Vec<Option<usize>> = Vec::new();
    let list = |frame: &usize| {
        let touching = &run.frames.forces[*frame];
        for place in &mut places {
            *place = place.filter(|pair| touching.iter().any(|(touches, _)| touches == pair));
        }
        let mut list = vec![[[0.0; 3]; 2]; places.len()];
        for &(pair, [x, y, z, fx, fy, fz]) in touching {
            let known = places.iter().position(|place| *place == Some(pair));
            let free = || places.iter().position(Option::is_none);
            let place = known.or_else(free).unwrap_or(places.len());
            if place == places.len() {
                places.push(None);
                list.push([[0.0; 3]; 2]);
            }
            places[place] = Some(pair);
            list[place] = [[x, y, z], [fx, fy, fz]];
        }
        list
    };
    frames.iter().map(list).collect()
}

fn point(of: Vec3) -> Point3 {
    [of.x, of.y, of.z]
}

/// Converts a body to a body of the three-dimensional scene. Half-spaces are left out because the scene has a floor of
/// its own; dishes are left out because they lie in the floor.
fn drawn(part: &Part, body: &Body<Spatial>) -> DepthBody {
    let mut volumes: Vec<Volume> = Vec::new();
    let mut barrel = false;
    for placed in &body.surfaces {
        let place = |local: Vec3| point(placed.offset + placed.rotation.apply(local));
        let turned = |x: f64, y: f64, z: f64| point(placed.rotation.apply(Vec3::new(x, y, z)));
        let at = point(placed.offset);
        volumes.extend(match &placed.surface {
            Solid::HalfSpace | Solid::Dish(_) => None,
            Solid::Ball(ball) => Some(Volume::Ball { at, radius: ball.radius }),
            Solid::Capsule(tube) => Some(Volume::Tube {
                ends: [-1.0, 1.0].map(|side| place(Vec3::new(side * tube.half_length, 0.0, 0.0))),
                radius: tube.radius,
            }),
            Solid::Block(block) => {
                let [x, y, z] = point(block.half).map(|half| half + block.rounding);
                let sides = [turned(x, 0.0, 0.0), turned(0.0, y, 0.0), turned(0.0, 0.0, z)];
                Some(Volume::Block { at, sides })
            }
            Solid::Barrel(shape) => {
                barrel = true;
                let half = shape.half_length + shape.rounding;
                let arc = shape.stave_radius + shape.rounding;
                let point = |at: u32| {
                    let x = half * (2.0 * f64::from(at) / f64::from(PARTS) - 1.0);
                    [x, (arc * arc - x * x).sqrt() - shape.stave_offset]
                };
                let profile = (0..=PARTS).map(point).collect();
                Some(Volume::Turned { at, axis: turned(1.0, 0.0, 0.0), profile })
            }
        });
    }
    for line in &part.lines {
        let bar =
            |pair: &[Vec3]| Volume::Tube { ends: [pair[0], pair[1]].map(point), radius: PLATE };
        volumes.extend(line.windows(2).map(bar));
    }
    let role = match part.kind {
        PartKind::Barrel => Role::Barrel,
        PartKind::Body if barrel => Role::Barrel,
        PartKind::Ground => Role::Ground,
        PartKind::Rack => Role::Rack,
        PartKind::Device | PartKind::Wine => Role::Device,
        PartKind::Body => Role::Block,
    };
    DepthBody { name: part.name.clone(), role, volumes, rows: vec![[0.0; 3]] }
}
