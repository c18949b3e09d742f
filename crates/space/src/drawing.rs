//! Flat drawings of a three-dimensional run, in three views: across the barrels, along the barrels, and from above.
//!
//! In a flat scene, every body has a fixed outline that moves in the plane of the drawing. The outline of a
//! three-dimensional body depends on the direction, in the body frame, from which the body is viewed. A body therefore
//! has one drawing for every direction that occurs, rounded to steps of a few degrees, and each frame shows one of
//! these drawings.

mod deep;
mod view;

use std::collections::BTreeMap;
use std::sync::Arc;

use barrelstack::assemble::PartKind;
use barrelstack::motion::STANDARD_GRAVITY;
use barrelstack::outcome::Outcome;
use barrelstack::report::ground_history;
use barrelstack::scenario;
use barrelstack::watch::ElementFate;
use barrelstack_dynamics::{
    Body, Element, Linear as _, Link, Placed, Quaternion, Rotation3, Solid, Spatial, Vec3,
};
use barrelstack_report::{
    Event, EventKind, Frames, History, Moment, Point, Polyline, Role, Scene, SceneBody, Tie, Trace,
};

use self::view::BodyView;
use crate::fate::Heading;
use crate::part::Part;
use crate::run::Run;
use crate::stack::Stack;
use crate::words::leaves;

/// View direction of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sight {
    /// The plane across the barrels, viewed toward their heads: `x` to the right, `z` up.
    Across,
    /// The plane along the barrels, viewed toward their sides: `y` to the right, `z` up.
    Along,
    /// The floor, viewed from above: `x` to the right, `y` up the page.
    Above,
}

impl Sight {
    /// All view directions.
    pub const ALL: [Self; 3] = [Self::Across, Self::Along, Self::Above];

    /// Returns a description of the view direction, such as "along the barrels".
    pub fn words(self, stack: &Stack) -> &'static str {
        match self {
            Self::Across if stack.is_free() => "from the front",
            Self::Across => "across the barrels",
            Self::Along if stack.is_free() => "from the side",
            Self::Along => "along the barrels",
            Self::Above => "from above",
        }
    }

    /// Returns `true` if this view labels the bodies that leave their seats in the direction `heading`. Each direction
    /// belongs to exactly one view.
    fn shows(self, heading: Heading) -> bool {
        match self {
            Self::Across => heading.is_across(),
            Self::Along => !heading.is_across(),
            Self::Above => false,
        }
    }

    /// Returns the indices of the axes that point right and up on the page.
    fn axes(self) -> [usize; 2] {
        match self {
            Self::Across => [0, 2],
            Self::Along => [1, 2],
            Self::Above => [0, 1],
        }
    }

    /// Returns the axes of the page that point right and up. Together with the direction toward the viewer, they form a
    /// right-handed system.
    fn page(self) -> [Vec3; 2] {
        let all = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];
        self.axes().map(|axis| all[axis])
    }
}

/// Half the assumed thickness (m) of those parts of devices that the flat drawings show as lines.
pub(crate) const PLATE: f64 = 0.012;

/// Maximum frame rate of a drawing (frames per second).
const RATE: f64 = 20.0;

/// Number of steps per right angle to which the view directions of bodies in a [`scene`] are rounded.
const STEPS: f64 = 6.0;

/// Number of steps per right angle to which the view directions of bodies in a [`coarse_scene`] are rounded.
const COARSE_STEPS: f64 = 3.0;

/// Returns the drawing of a run in a view direction.
pub fn scene(run: &Run, sight: Sight) -> Arc<Scene> {
    Arc::new(drawn(run, sight, STEPS))
}

/// Returns the drawing of a run in the view across the barrels, for smaller files. The three-dimensional scene is the
/// same as that of [`scene`], but a rotating body has fewer flat drawings, because its view directions are rounded to
/// coarser steps.
pub fn coarse_scene(run: &Run) -> Scene {
    drawn(run, Sight::Across, COARSE_STEPS)
}

fn drawn(run: &Run, sight: Sight, steps: f64) -> Scene {
    let [right, up] = sight.page();
    let toward = right.cross(up);
    let frames = shown(run);
    let bodies = run.stack.model.bodies();
    // Distant bodies are drawn first.
    let mut order: Vec<usize> = (1..bodies.len()).collect();
    let depth = |body: usize| run.fates[body].rest.dot(toward);
    order.sort_by(|a, b| depth(*a).total_cmp(&depth(*b)));
    let slope = slope(run);
    let mut drawn = vec![ground(run, sight, slope), yard(run, sight)];
    let mut poses: Vec<Vec<[f64; 3]>> = frames
        .iter()
        .map(|frame| {
            let [x, y, z, ..] = run.frames.poses[*frame][0];
            let at = Vec3::new(x, y, z);
            let [x, z] = [at.dot(right), at.dot(up)];
            vec![[x, z, if sight == Sight::Across { slope } else { 0.0 }], [x, z, 0.0]]
        })
        .collect();
    let mut first = vec![0; bodies.len()];
    for body in order {
        first[body] = drawn.len();
        let part = &run.stack.parts[body];
        let path = frames.iter().map(|frame| run.frames.poses[*frame][body]);
        enter((part, &bodies[body]), path, ([right, up], steps), &mut drawn, &mut poses);
    }
    let ties = bands(run, sight, drawn.len());
    for (row, frame) in poses.iter_mut().zip(&frames) {
        row.resize(drawn.len(), [f64::NAN; 3]);
        row.extend(ties.iter().flat_map(|tie| tie.ends(run, *frame, [right, up])));
    }
    let ends = std::iter::repeat_n(SceneBody::new("", Role::Block, Vec::new()), 2 * ties.len());
    drawn.extend(ends);
    // The paths of barrels are drawn as those of invisible bodies at the centers of the barrels.
    for body in top(run) {
        drawn.push(SceneBody::new("", Role::Block, Vec::new()));
        for (row, frame) in poses.iter_mut().zip(&frames) {
            let (place, _) = placed(run.frames.poses[*frame][body]);
            row.push([place.dot(right), place.dot(up), 0.0]);
        }
    }
    Scene {
        bodies: drawn,
        frames: Frames {
            times: frames.iter().map(|frame| run.frames.times[*frame]).collect(),
            poses,
            forces: Vec::new(),
        },
        ties: ties.iter().map(|tie| tie.drawn).collect(),
        events: events(run, &first, sight),
        moment: moment(run, &first)
            .filter(|_| run.heading.is_some_and(|heading| sight.shows(heading))),
        // The page shows the three-dimensional scene in place of the first view.
        depth: (sight == Sight::Across).then(|| deep::depth(run, &frames)),
        ..Scene::default()
    }
}

/// Adds a body to a flat scene. `drawn` receives one drawing for every view direction that occurs along the path of the
/// body. `poses` receives one pose per drawing and frame; it is NaN in the frames that do not show the drawing. View
/// directions are rounded to `steps` steps per right angle.
fn enter(
    (part, body): (&Part, &Body<Spatial>),
    path: impl Iterator<Item = [f64; 7]>,
    ([right, up], steps): ([Vec3; 2], f64),
    drawn: &mut Vec<SceneBody>,
    poses: &mut [Vec<[f64; 3]>],
) {
    let kind = if is_barrel(body) { PartKind::Barrel } else { part.kind };
    let mut known: BTreeMap<[i32; 3], usize> = BTreeMap::new();
    for (row, pose) in poses.iter_mut().zip(path) {
        let (place, rotation) = placed(pose);
        let page = [right, up].map(|axis| rotation.unapply(axis));
        let view = BodyView::of(kind, page, steps);
        let slot = *known.entry(view.key()).or_insert_with(|| {
            drawn.push(view.draw(part, body));
            drawn.len() - 1
        });
        row.resize(drawn.len(), [f64::NAN; 3]);
        row[slot] = [place.dot(right), place.dot(up), view.angle];
    }
}

/// A body of a room, with the data that a picture of the room needs.
#[derive(Clone, Debug)]
pub struct Shown<'a> {
    /// Name in the picture.
    pub name: String,
    /// Description of the body.
    pub part: &'a Part,
    /// The body.
    pub body: &'a Body<Spatial>,
    /// Poses in all frames: position (m) and quaternion `w`, `x`, `y`, `z`.
    pub path: Vec<[f64; 7]>,
    /// Time (s) at which the body leaves its seat; `None` if it does not leave its seat.
    pub leaves_at: Option<f64>,
}

/// Returns the drawing of many bodies on one floor, such as all stacks of a room, at the times (s) of their frames. The
/// drawing in the view across the barrels also contains the three-dimensional scene of all bodies.
pub fn together(bodies: &[Shown<'_>], times: &[f64], sight: Sight) -> Scene {
    let [right, up] = sight.page();
    let toward = right.cross(up);
    let depth = |body: &Shown<'_>| {
        body.path.first().map_or(0.0, |[x, y, z, ..]| Vec3::new(*x, *y, *z).dot(toward))
    };
    let mut order: Vec<usize> = (0..bodies.len()).collect();
    order.sort_by(|a, b| depth(&bodies[*a]).total_cmp(&depth(&bodies[*b])));
    let floor = Polyline::open(vec![[-100.0, 0.0], [100.0, 0.0]]);
    let floor = if sight == Sight::Above { Vec::new() } else { vec![floor] };
    let mut drawn = vec![SceneBody::new("ground", Role::Ground, floor)];
    let mut poses = vec![vec![[0.0; 3]]; times.len()];
    let mut first = vec![0; bodies.len()];
    for body in order {
        first[body] = drawn.len();
        let Shown { part, body: shape, path, .. } = &bodies[body];
        enter((part, shape), path.iter().copied(), ([right, up], STEPS), &mut drawn, &mut poses);
        for view in &mut drawn[first[body]..] {
            view.name.clone_from(&bodies[body].name);
        }
    }
    for row in &mut poses {
        row.resize(drawn.len(), [f64::NAN; 3]);
    }
    let of = |number: &dyn Fn(usize) -> usize| {
        let leaving = bodies.iter().enumerate();
        let leaving = leaving.filter_map(|(at, body)| Some((body.leaves_at?, at)));
        let mut events: Vec<Event> = leaving
            .map(|(time, at)| Event {
                time,
                body: Some(number(at)),
                kind: EventKind::LossOfSeat,
                text: format!("{} leaves its seat", bodies[at].name),
            })
            .collect();
        events.sort_by(|a, b| a.time.total_cmp(&b.time));
        let moment = events.first().map(|event| Moment {
            time: event.time,
            body: event.body.unwrap_or_default(),
            text: format!("here {}", event.text),
            falls: true,
        });
        (events, moment)
    };
    // The views of a page share one list of events.
    let (events, moment) =
        if sight == Sight::Across { of(&|body| first[body]) } else { Default::default() };
    let deep = (sight == Sight::Across).then(|| {
        // The first body is the floor, as in the flat scene.
        let (events, moment) = of(&|body| body + 1);
        let at_rest = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
        deep::of_bodies(
            bodies.iter().map(|one| (one.part, one.body, one.name.as_str())),
            (0..times.len())
                .map(|frame| {
                    std::iter::once(at_rest).chain(bodies.iter().map(|b| b.path[frame])).collect()
                })
                .collect(),
            events,
            moment,
        )
    });
    let frames = Frames { times: times.to_vec(), poses, forces: Vec::new() };
    Scene { bodies: drawn, frames, events, moment, depth: deep, ..Scene::default() }
}

/// Returns the indices of the barrels of the top level, whose paths are drawn.
fn top(run: &Run) -> impl Iterator<Item = usize> {
    let levels = run.stack.levels;
    run.stack
        .of_kind(PartKind::Barrel)
        .filter(move |body| levels > 0 && run.stack.parts[*body].level == levels)
}

/// Returns the paths of the centers of the barrels of the top level, as traces in a scene of the run.
pub fn traces(run: &Run, scene: &Scene) -> Vec<Trace> {
    let first = scene.bodies.len() - top(run).count();
    let trace = |(at, body): (usize, usize)| Trace {
        body: first + at,
        point: [0.0; 2],
        label: format!("center of {}", run.stack.parts[body].name),
    };
    top(run).enumerate().map(trace).collect()
}

/// A strap or a tie. It is drawn between two invisible bodies at its ends. It cannot be attached to the drawings of the
/// bodies that it joins: as a body rotates, one drawing replaces another, so no point of the body has a fixed position
/// in its drawings.
struct Band<'a> {
    link: &'a Link<Spatial>,
    drawn: Tie,
}

impl Band<'_> {
    /// Returns the poses of the two ends of the band on the page: the positions (m) to the right and up, and a rotation
    /// of zero. `page` contains the axes that point right and up.
    fn ends(&self, run: &Run, frame: usize, page: [Vec3; 2]) -> [[f64; 3]; 2] {
        [0, 1].map(|end| {
            let (place, rotation) = placed(run.frames.poses[frame][self.link.bodies[end]]);
            let at = place + rotation.apply(self.link.points[end]);
            [at.dot(page[0]), at.dot(page[1]), 0.0]
        })
    }
}

/// Minimum distance (m) between the ends of a band on the page; a shorter band is in end view and is not drawn.
const END_ON: f64 = 0.01;

/// Returns the straps and ties that are not in end view. The invisible bodies at their ends come after the first
/// `drawings` bodies of the scene.
fn bands(run: &Run, sight: Sight, drawings: usize) -> Vec<Band<'_>> {
    let straps = run.devices().filter_map(|((element, _), fate)| match element {
        Element::Strap(strap) => Some((&strap.link, fate)),
        Element::Rod(_) | Element::Guide(_) => None,
    });
    let band = |(link, fate): (_, &ElementFate)| Band {
        link,
        drawn: Tie { bodies: [0; 2], points: [[0.0; 2]; 2], torn_at: fate.broken_at },
    };
    let visible = |band: &Band<'_>| {
        let [a, b] = band.ends(run, 0, sight.page());
        (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) > END_ON
    };
    let mut bands: Vec<_> = straps.map(band).filter(visible).collect();
    for (band, end) in bands.iter_mut().zip((drawings..).step_by(2)) {
        band.drawn.bodies = [end, end + 1];
    }
    bands
}

/// Returns `true` if a body is a single barrel with its center of mass on its axis.
fn is_barrel(body: &Body<Spatial>) -> bool {
    let [Placed { surface: Solid::Barrel(_), offset, .. }] = body.surfaces.as_slice() else {
        return false;
    };
    offset.y == 0.0 && offset.z == 0.0
}

/// Returns the indices of the frames of a run that a drawing shows.
fn shown(run: &Run) -> Vec<usize> {
    let mut next = 0.0;
    let mut shown = Vec::new();
    for (at, time) in run.frames.times.iter().enumerate() {
        if *time >= next {
            shown.push(at);
            next = time + 1.0 / RATE - 1e-9;
        }
    }
    shown
}

fn placed([x, y, z, w, a, b, c]: [f64; 7]) -> (Vec3, Rotation3) {
    (Vec3::new(x, y, z), Quaternion { w, v: Vec3::new(a, b, c) }.matrix())
}

/// Returns the slope angle (rad) of the ground in the view across the barrels; positive if the ground rises to the
/// right.
fn slope(run: &Run) -> f64 {
    match &run.scenario.scene {
        scenario::Scene::Spatial(scene) => scene.ground.slope,
        scenario::Scene::Stack { .. } | scenario::Scene::Free(_) => 0.0,
    }
}

/// Returns the drawing of the ground: the floor, as a line longer than any picture is wide, and the walls, ceilings and
/// dishes of devices.
///
/// The floor is not drawn in the view from above, nor in the view along the barrels if the ground slopes.
fn ground(run: &Run, sight: Sight, slope: f64) -> SceneBody {
    let line = Polyline::open(vec![[-100.0, 0.0], [100.0, 0.0]]);
    let shown = sight == Sight::Across || (sight == Sight::Along && slope == 0.0);
    let mut outlines = if shown { vec![line] } else { Vec::new() };
    let [right, up] = sight.page();
    let flat = |point: &Vec3| [point.dot(right), point.dot(up)];
    let lines = &run.stack.parts[Stack::GROUND].lines;
    outlines.extend(lines.iter().map(|line| Polyline::open(line.iter().map(flat).collect())));
    SceneBody::new("ground", Role::Ground, outlines)
}

/// Returns two invisible points at opposite corners of a rectangle, so that the picture contains the rectangle.
///
/// In a free scene, the rectangle contains the paths of all bodies. In the view of a stack from above, the sides of the
/// rectangle are as far from the origin as the paths require, but at least 0.7 and at most 1.5 times the height of the
/// stack. In the other views of a stack, the picture is not enlarged.
fn yard(run: &Run, sight: Sight) -> SceneBody {
    let corners = if run.stack.is_free() {
        bounds(run, sight)
    } else {
        let (least, most) = match sight {
            Sight::Above => (0.7 * run.stack.height, 1.5 * run.stack.height),
            Sight::Across | Sight::Along => (0.0, 0.0),
        };
        let [lower, upper] = bounds(run, sight);
        [lower.map(|edge| edge.clamp(-most, -least)), upper.map(|edge| edge.clamp(least, most))]
    };
    let corners = corners.map(|corner| Polyline::open(vec![corner]));
    SceneBody::new("", Role::Block, corners.into())
}

/// Returns the lower left and upper right corners of a rectangle that contains all bodies in all frames, relative to
/// the ground.
fn bounds(run: &Run, sight: Sight) -> [Point; 2] {
    let page = sight.page();
    let (mut lower, mut upper) = ([0.0; 2], [0.0; 2]);
    for poses in &run.frames.poses {
        let place = |body: usize| Vec3::new(poses[body][0], poses[body][1], poses[body][2]);
        for (body, of) in run.stack.model.bodies().iter().enumerate().skip(1) {
            let offset = place(body) - place(0);
            for (axis, along) in page.into_iter().enumerate() {
                lower[axis] = offset.dot(along).min(lower[axis] + of.reach()) - of.reach();
                upper[axis] = offset.dot(along).max(upper[axis] - of.reach()) + of.reach();
            }
        }
    }
    [lower, upper]
}

fn events(run: &Run, first: &[usize], sight: Sight) -> Vec<Event> {
    let mut events = Vec::new();
    for (body, (part, fate)) in run.stack.parts.iter().zip(&run.fates).enumerate() {
        let barrel = part.kind == PartKind::Barrel;
        // A barrel that counts as fallen at the moment at which it leaves its seat gets one label, not two.
        let falls_with_it = |time: f64| barrel && fate.fell_at.is_some_and(|fell| fell <= time);
        let left = fate.left_seat.filter(|(at, ..)| !falls_with_it(*at));
        if let Some((time, loss, heading)) = left.filter(|(.., heading)| sight.shows(*heading)) {
            // The view itself shows whether the body falls along the barrels or across them.
            let text = format!("{}, {}", leaves(&part.name, loss), heading.name());
            events.push(Event { time, body: Some(first[body]), kind: EventKind::LossOfSeat, text });
        }
        let visible = fate.left_seat.is_none_or(|(.., heading)| sight.shows(heading));
        if let (Some(time), true) = (fate.fell_at.filter(|_| visible), barrel) {
            let text = format!("{} falls", part.name);
            events.push(Event { time, body: Some(first[body]), kind: EventKind::Fall, text });
        }
    }
    // Failures of devices have no direction, so they are labeled in one view only.
    if sight == Sight::Across {
        for ((element, words), fate) in run.devices() {
            if let Some(time) = fate.broken_at {
                let link = element.link();
                let text = format!("the {} {} {}", words.one, link.name, words.breaks);
                let body = Some(first[link.bodies[0]]);
                events.push(Event { time, body, kind: EventKind::Note, text });
            }
        }
    }
    events.sort_by(|a, b| a.time.total_cmp(&b.time));
    events
}

fn moment(run: &Run, first: &[usize]) -> Option<Moment> {
    let Outcome::Collapse { time, first: name, .. } = &run.outcome else { return None };
    let body = run.stack.parts.iter().position(|part| part.name == *name)?;
    let (_, loss, _) = run.fates[body].left_seat?;
    let text = format!("here {}", leaves(name, loss));
    Some(Moment { time: *time, body: first[body], text, falls: true })
}

/// Returns the acceleration of the ground along each axis of the stack, as a multiple of gravity.
pub fn ground_histories(run: &Run) -> Vec<History> {
    let Some(motion) = &run.ground.first.motion else { return Vec::new() };
    let step = motion.horizontal.natural_step();
    let history = |words: &str, of: &dyn Fn(Vec3) -> f64| {
        let value = |time: f64| of(run.ground.acceleration(time)) / STANDARD_GRAVITY;
        let label = format!("ground acceleration, {words}");
        ground_history(&label, "g", (step, run.end_time), &value)
    };
    let free = run.stack.is_free();
    vec![
        history(if free { "along x" } else { "across the barrels" }, &|v| v.x),
        history(if free { "along y" } else { "along the barrels" }, &|v| v.y),
        history("upward", &|v| v.z),
    ]
}
