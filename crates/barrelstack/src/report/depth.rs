//! Three-dimensional scene of a planar stack, whose dimensions perpendicular to the plane come from
//! the scenario.

use barrelstack_dynamics::{Vec2, math};
use barrelstack_report::{
    Depth, DepthBody, DepthPoses, DepthTie, Event, Moment, Point3, Role, Tie, Volume,
};

use crate::assemble::{Assembly, BAR_RADIUS, Outline, Part, PartKind, cup};
use crate::scenario::{Barrel, Cradle, Rack, RackKind, Scenario, Scene, StackSpec, View};

/// Half the assumed thickness (m) of device plates, which planar drawings show as lines.
const PLATE: f64 = 0.012;

/// Number of segments of a barrel profile or of a cradle arc.
const PARTS: u32 = 12;

/// Returns the bodies of a planar stack in three dimensions, with the events of the run; `None` for
/// a free scene, whose depth is unknown.
pub(super) fn depth(
    scenario: &Scenario,
    assembly: &Assembly,
    ties: &[Tie],
    (events, moment): (&[Event], Option<&Moment>),
) -> Option<Depth> {
    let Scene::Stack { stack, .. } = &scenario.scene else { return None };
    let section = Section { spec: stack, length: scenario.run.similitude };
    let bodies = assembly.parts.iter().enumerate();
    Some(Depth {
        bodies: bodies.map(|(body, part)| section.body(assembly, body, part)).collect(),
        poses: match stack.view {
            View::Transverse => DepthPoses::Across,
            View::Longitudinal => DepthPoses::Along,
        },
        ties: ties.iter().flat_map(|tie| section.bands(tie)).collect(),
        events: events.to_vec(),
        moment: moment.cloned(),
        paths: Vec::new(),
        forces: Vec::new(),
        panes: Vec::new(),
    })
}

/// A planar section of a stack.
struct Section<'a> {
    spec: &'a StackSpec,
    /// Length scale by which the dimensions of the full-size stack are multiplied.
    length: f64,
}

impl Section<'_> {
    /// Returns the three-dimensional body of a planar part. A planar barrel represents several barrels, so its body is
    /// drawn once at the position of each of them.
    fn body(&self, assembly: &Assembly, index: usize, part: &Part) -> DepthBody {
        let (role, volumes, rows) = match part.kind {
            PartKind::Barrel => (Role::Barrel, vec![self.barrel()], self.rows()),
            PartKind::Rack => (Role::Rack, self.rack(assembly, index, part), Vec::new()),
            PartKind::Ground => (Role::Ground, self.plates(part.outlines.get(1..)), Vec::new()),
            PartKind::Device => (Role::Device, self.plates(Some(&part.outlines)), Vec::new()),
            // Wine swings inside its barrel, so it has no volume of its own.
            PartKind::Wine => (Role::Device, Vec::new(), Vec::new()),
            PartKind::Body => (Role::Block, Vec::new(), Vec::new()),
        };
        let rows = if rows.is_empty() { vec![[0.0; 3]] } else { rows };
        DepthBody { name: part.name.clone(), role, volumes, rows }
    }

    /// Returns a point from its coordinates (m) in the plane and its distance (m) from the plane.
    fn at(&self, [along, up]: [f64; 2], away: f64) -> Point3 {
        match self.spec.view {
            View::Transverse => [along, away, up],
            View::Longitudinal => [away, along, up],
        }
    }

    /// Returns the offsets (m), perpendicular to the plane, of the parts that lie one behind the other. These are the
    /// rails if the plane is transverse, and the barrels if it is longitudinal.
    fn away(&self) -> Vec<f64> {
        let rack = &self.spec.rack;
        match self.spec.view {
            View::Transverse => rails(rack, self.pitch_along()),
            View::Longitudinal => spread(rack.barrels, rack.pitch),
        }
    }

    /// Returns the spacing (m) of barrels that lie one behind the other in a rack.
    fn pitch_along(&self) -> f64 {
        self.spec.barrel.length + self.spec.gap
    }

    /// Returns the positions (m) of the barrels that one barrel of the planar model represents.
    fn rows(&self) -> Vec<Point3> {
        let rack = &self.spec.rack;
        let places = match self.spec.view {
            View::Transverse => spread(rack.barrels_deep, self.pitch_along()),
            View::Longitudinal => spread(rack.barrels, rack.pitch),
        };
        places.into_iter().map(|place| self.at([0.0; 2], place * self.length)).collect()
    }

    fn barrel(&self) -> Volume {
        let barrel: &Barrel = &self.spec.barrel;
        let half = 0.5 * barrel.length;
        let point = |at: u32| {
            let along = half * (2.0 * f64::from(at) / f64::from(PARTS) - 1.0);
            [along, 0.5 * barrel.diameter_at(along)].map(|v| v * self.length)
        };
        Volume::Turned {
            at: [0.0; 3],
            axis: [0.0, 1.0, 0.0],
            profile: (0..=PARTS).map(point).collect(),
        }
    }

    /// Returns the volumes of a rack, including the device plates on it.
    fn rack(&self, assembly: &Assembly, index: usize, part: &Part) -> Vec<Volume> {
        let spec = self.spec;
        let surfaces = &assembly.model.bodies()[index].surfaces;
        // If the rails are at two heights, the center of mass is not in the middle of the rack.
        let places = surfaces.iter().zip(&part.outlines).flat_map(|(_, outline)| &outline.points);
        let [low, high] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| {
            [low.min(point.x), high.max(point.x)]
        });
        let middle = if low < high { 0.5 * (low + high) } else { 0.0 };
        // Along the barrels, rails may rise with an inclined barrel; this is the underside of the
        // nearest rail.
        let rise = |y: f64| match spec.view {
            View::Longitudinal if spec.rack.posts.is_none() => {
                let rails = surfaces.iter().zip(&part.outlines);
                let apart = |x: f64| ((x - middle) / self.length - y).abs();
                let nearest =
                    rails.min_by(|(a, _), (b, _)| apart(a.offset.x).total_cmp(&apart(b.offset.x)));
                let points = nearest.map_or(&[][..], |(_, outline)| &outline.points);
                let bottom = points.iter().map(|point| point.z).reduce(f64::min);
                (bottom.unwrap_or(-part.foot) + part.foot) / self.length
            }
            View::Longitudinal | View::Transverse => 0.0,
        };
        let level = part.level.unwrap_or(1);
        let chocks = spec.devices.chock.at(level, spec.levels).then_some(&spec.devices.chock);
        let mut volumes =
            frame(spec, (level, self.pitch_along()), rise, chocks.map(|c| (c.angle, c.gap)));
        for volume in &mut volumes {
            self.scale(volume, self.at([middle, -part.foot], 0.0));
        }
        volumes.extend(self.plates(part.outlines.get(surfaces.len()..)));
        volumes
    }

    /// Scales a solid of a rack, and moves it by an offset (m).
    fn scale(&self, volume: &mut Volume, offset: Point3) {
        let scaled = |point: &mut Point3| point.iter_mut().for_each(|v| *v *= self.length);
        let placed = |point: &mut Point3| {
            scaled(point);
            point.iter_mut().zip(offset).for_each(|(v, by)| *v += by);
        };
        match volume {
            Volume::Tube { ends, radius } => {
                ends.iter_mut().for_each(placed);
                *radius *= self.length;
            }
            Volume::Block { at, sides } => {
                placed(at);
                sides.iter_mut().for_each(scaled);
            }
            Volume::Ball { at, radius } => {
                placed(at);
                *radius *= self.length;
            }
            Volume::Turned { at, profile, .. } => {
                placed(at);
                profile.as_flattened_mut().iter_mut().for_each(|v| *v *= self.length);
            }
        }
    }

    /// Converts planar outlines to bars. Each line segment of an outline gives one bar for each offset from the plane
    /// that `Section::away` returns.
    fn plates(&self, outlines: Option<&[Outline]>) -> Vec<Volume> {
        let mut bars = Vec::new();
        for outline in outlines.unwrap_or(&[]) {
            let closing = outline.closed.then(|| [outline.points.last(), outline.points.first()]);
            let pairs = outline.points.windows(2).map(|pair| [Some(&pair[0]), Some(&pair[1])]);
            for pair in pairs.chain(closing) {
                let [Some(from), Some(to)] = pair else { continue };
                let point = |p: &Vec2, away: f64| self.at([p.x, p.z], away * self.length);
                bars.extend(self.away().into_iter().map(|away| Volume::Tube {
                    ends: [point(from, away), point(to, away)],
                    radius: PLATE * self.length,
                }));
            }
        }
        bars
    }

    /// Returns the bands that represent a tie in three dimensions, one for each rail or barrel.
    fn bands(&self, tie: &Tie) -> Vec<DepthTie> {
        let band = |away: f64| DepthTie {
            bodies: tie.bodies,
            points: tie.points.map(|point| self.at(point, away * self.length)),
            torn_at: tie.torn_at,
        };
        self.away().into_iter().map(band).collect()
    }
}

/// Returns positions (m) at equal spacing, centered on zero.
fn spread(count: u32, pitch: f64) -> Vec<f64> {
    (0..count).map(|at| (f64::from(at) - 0.5 * f64::from(count - 1)) * pitch).collect()
}

/// Returns the positions (m) of the rails of a rack along the axis of the barrels.
fn rails(rack: &Rack, pitch: f64) -> Vec<f64> {
    let rail = |place: f64| [-1.0, 1.0].map(|side| place + side * rack.rail_half_spacing);
    spread(rack.barrels_deep, pitch).into_iter().flat_map(rail).collect()
}

/// Returns the solids of a rack at full scale, relative to the middle of its underside.
///
/// The outline in the transverse plane is extruded to the width of a rail, once for every rail. In a rack without
/// posts, two tubes are assumed to join the rails at their ends, as in the spatial model. `rise` returns the height (m)
/// of the rail at a position along the barrels. `chocks` contains the angle (rad) of the chocks from the vertical, and
/// the gap (m) between a chock and its barrel; `None` if the rack has no chocks.
fn frame(
    spec: &StackSpec,
    (level, pitch): (u32, f64),
    rise: impl Fn(f64) -> f64,
    chocks: Option<(f64, f64)>,
) -> Vec<Volume> {
    let rack = &spec.rack;
    let radius = 0.5 * spec.barrel.section_diameter;
    let posts = rack.posts.filter(|_| rack.kind == RackKind::OnRacks);
    let lift = if posts.is_none() { rack.foot_height } else { 0.0 };
    let top = lift + rack.beam_height;
    let half_rail = 0.5 * rack.rail_width;
    let places = spread(rack.barrels, rack.pitch);
    let rails = rails(rack, pitch);
    let mut volumes = Vec::new();
    for y in rails.iter().copied() {
        let up = rise(y);
        let beam = [0.5 * rack.width, half_rail, 0.5 * rack.beam_height];
        volumes.push(Volume::upright([0.0, y, up + lift + beam[2]], beam));
        let bar = |[x, z]: [f64; 2], [u, w]: [f64; 2]| Volume::Tube {
            ends: [[x, y, up + z], [u, y, up + w]],
            radius: BAR_RADIUS,
        };
        for place in places.iter().copied() {
            if lift > 0.0 {
                let foot = [rack.foot_half_length, half_rail, 0.5 * lift];
                volumes.push(Volume::upright([place, y, up + foot[2]], foot));
            }
            // A bar that stands on the beam and ends at an angle and a distance from the center of
            // the barrel.
            let beside = |angle: f64, away: f64| {
                let (sin, cos) = math::sin_cos(angle);
                let end = [place + sin * away, rack.clearance + radius - cos.abs() * away];
                bar([end[0], end[1].min(top)], end)
            };
            match rack.cradle {
                Cradle::Supports { angle } => {
                    volumes.extend([-angle, angle].map(|angle| beside(angle, radius + BAR_RADIUS)));
                }
                Cradle::Arc { radius: trough, half_angle } => {
                    let on = |at: u32| {
                        let angle = half_angle * (2.0 * f64::from(at) / f64::from(PARTS) - 1.0);
                        let (sin, cos) = math::sin_cos(angle);
                        let away = trough + BAR_RADIUS;
                        [place + sin * away, rack.clearance + trough - cos * away]
                    };
                    volumes.extend((0..PARTS).map(|at| bar(on(at), on(at + 1))));
                }
            }
            let horns = chocks.map(|(angle, gap)| {
                [-angle, angle].map(|angle| beside(angle, radius + gap + BAR_RADIUS))
            });
            volumes.extend(horns.into_iter().flatten());
        }
    }
    let outer = rails.iter().copied().fold(0.0, f64::max);
    if let Some(posts) = posts {
        let x = posts.half_spacing;
        let y = outer - rack.rail_half_spacing + posts.half_spacing_along;
        let tall = 0.5 * (posts.height - rack.beam_height);
        for side in [-1.0, 1.0] {
            let beam = [half_rail, y + cup(rack), 0.5 * rack.beam_height];
            volumes.push(Volume::upright([side * x, 0.0, beam[2]], beam));
            let post = |end: f64| {
                let at = [side * x, end * y, rack.beam_height + tall];
                Volume::upright(at, [half_rail, half_rail, tall])
            };
            volumes.extend([-1.0, 1.0].map(post));
            // Cups hang over the posts below.
            let hang = 0.5 * posts.spigot;
            let over = |end: f64| {
                Volume::upright([side * x, end * y, -hang], [cup(rack), cup(rack), hang])
            };
            volumes.extend([-1.0, 1.0].map(over).into_iter().filter(|_| level > 1 && hang > 0.0));
        }
    } else {
        let x = 0.5 * rack.width - BAR_RADIUS;
        let ends = |x: f64| [-outer, outer].map(|y| [x, y, top - BAR_RADIUS]);
        volumes.extend([-x, x].map(|x| Volume::Tube { ends: ends(x), radius: BAR_RADIUS }));
    }
    volumes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assemble::assemble;
    use crate::report::drawing::outlines;

    fn extent(values: impl Iterator<Item = f64>) -> [f64; 2] {
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
    }

    /// Returns the lowest and the highest coordinate of solids along an axis.
    fn along(volumes: &[Volume], axis: usize) -> [f64; 2] {
        extent(volumes.iter().flat_map(|volume| match volume {
            Volume::Tube { ends: [a, b], radius } => {
                // A tube has flat ends, so in the direction of its axis it does not extend beyond the ends of the axis.
                let away: f64 = (0..3).map(|k| (b[k] - a[k]).powi(2)).sum::<f64>().sqrt();
                let part = if away > 0.0 { (b[axis] - a[axis]) / away } else { 0.0 };
                let reach = radius * (1.0 - part * part).max(0.0).sqrt();
                vec![a[axis] - reach, a[axis] + reach, b[axis] - reach, b[axis] + reach]
            }
            Volume::Block { at, sides } => {
                let reach: f64 = sides.iter().map(|side| side[axis].abs()).sum();
                vec![at[axis] - reach, at[axis] + reach]
            }
            Volume::Ball { at, radius } => vec![at[axis] - radius, at[axis] + radius],
            Volume::Turned { at, axis: along, profile } => {
                let side = (1.0 - along[axis] * along[axis]).max(0.0).sqrt();
                let ends = profile.iter().flat_map(|[x, r]| {
                    [at[axis] + along[axis] * x - side * r, at[axis] + along[axis] * x + side * r]
                });
                ends.collect()
            }
        }))
    }

    /// The three-dimensional bodies must have the same extents as the planar bodies: in the transverse
    /// plane, all bodies; in the longitudinal plane, the barrels, and the length and underside of the
    /// racks.
    #[test]
    fn bodies_have_the_extents_of_their_plane() {
        let cases: [(&str, &[&str]); 10] = [
            ("candia-8-barrels", &[]),
            ("candia-8-barrels-half-scale", &[]),
            ("candia-8-barrels-longitudinal", &[]),
            ("demo-napa", &["stack.view=transverse"]),
            ("demo-napa", &["stack.view=longitudinal"]),
            ("demo-napa", &["stack.view=transverse", "stack.rack=four-barrel", "stack.columns=4"]),
            ("demo-napa", &["stack.view=transverse", "stack.rack=two-barrel-feet"]),
            ("demo-napa", &["stack.view=transverse", "stack.rack=rack-on-rack"]),
            ("demo-napa", &["stack.view=longitudinal", "stack.rack=rack-on-rack"]),
            ("demo-napa", &["stack.view=longitudinal", "stack.rack.incline=3 deg"]),
        ];
        for (name, set) in cases {
            let set: Vec<String> = set.iter().map(|text| (*text).to_owned()).collect();
            let scenario = Scenario::builtin(name, &set).unwrap();
            let assembly = assemble(&scenario).unwrap();
            let depth = depth(&scenario, &assembly, &[], (&[], None)).unwrap();
            let across = depth.poses == DepthPoses::Across;
            let Scene::Stack { stack, .. } = &scenario.scene else { panic!("{name} is a stack") };
            let mut compared = 0;
            for (index, body) in depth.bodies.iter().enumerate() {
                if !matches!(body.role, Role::Barrel | Role::Rack) {
                    continue;
                }
                let points: Vec<[f64; 2]> =
                    outlines(&assembly, index).into_iter().flat_map(|line| line.points).collect();
                let flat = [0, 1].map(|axis| extent(points.iter().map(|point| point[axis])));
                let deep = [usize::from(!across), 2].map(|axis| along(&body.volumes, axis));
                // The transverse plane shows a barrel at the section above its rails, which is
                // thinner than the bilge. The longitudinal plane shows a rack as its rails alone;
                // the supports beside the barrel are hidden.
                let barrel = &stack.barrel;
                let bulge = 0.5
                    * (barrel.bilge_diameter - barrel.section_diameter)
                    * scenario.run.similitude;
                let bulge = if across && body.role == Role::Barrel { bulge } else { 0.0 };
                for (axis, side) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let hidden = !across && body.role == Role::Rack && (axis, side) == (1, 1);
                    let apart = (deep[axis][side] - flat[axis][side]).abs();
                    // The mesh of an outline lies within 1.5 mm of its arc (measured).
                    assert!(
                        hidden || (apart - bulge).abs() < 2e-3,
                        "{name} {set:?} {}, axis {axis}, side {side}: {} in depth, {} in the plane",
                        body.name,
                        deep[axis][side],
                        flat[axis][side]
                    );
                    compared += 1;
                }
            }
            assert!(compared > 20, "{name}: {compared}");
        }
    }
}
