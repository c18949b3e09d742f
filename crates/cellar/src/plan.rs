//! The plan of a cellar before anything is run: where stacks stand, what overlaps, what blocks a door, and how much
//! room is left.

use barrelstack::RunFailure;
use barrelstack::assemble::PartKind;
use barrelstack::scenario::error::ScenarioError;
use barrelstack_dynamics::{Quaternion, Vec3};
use barrelstack_report::{FloorPlan, Region, RegionKind, described, shortest};
use barrelstack_space::{Stack, mesh};

use crate::geometry::{Convex, Grid, PASSAGE, Point};
use crate::scenario::{Cellar, Door, RoomSpec, Side, Standing};
use crate::start::starts;
use crate::words::plural;

/// Depth (m) of the floor in front of a door that must stay free, so that a person can enter.
const ENTRY: f64 = PASSAGE;

/// Depth (m) of the rectangles that represent doors in a drawing.
const LEAF: f64 = 0.12;

/// Geometry and contents of a stack, shared by all stacks that have the same number of levels.
#[derive(Clone, Debug)]
pub struct Model {
    /// Footprint relative to the origin of the stack.
    pub footprint: Convex,
    /// The stack as stated, before it settles.
    pub stack: Stack,
    /// For every body except the ground: points (m) of its surface, in the body frame.
    pub surfaces: Vec<Vec<Vec3>>,
    /// Number of barrels in the stack.
    pub barrels: usize,
    /// Volume (m³) of the wine in all barrels of the stack.
    pub wine: f64,
}

impl Model {
    fn of(scenario: &barrelstack::Scenario) -> Result<Self, RunFailure> {
        let stack = Stack::of(scenario)?;
        let bodies = &stack.model.bodies()[1..];
        let surfaces: Vec<Vec<Vec3>> = bodies.iter().map(mesh::points).collect();
        let placed = bodies.iter().zip(&surfaces).flat_map(|(body, points)| {
            let turn = body.pose.orientation.matrix();
            let position = body.pose.position;
            points.iter().map(move |point| position + turn.apply(*point))
        });
        let footprint = Convex::hull(placed.map(|point| [point.x, point.y]).collect());
        // The footprint is the bounding rectangle along the sides of the stack.
        let [lower, upper] = footprint.bounds();
        Ok(Self {
            footprint: Convex::rectangle(lower, upper),
            surfaces,
            barrels: stack.of_kind(PartKind::Barrel).count(),
            wine: stack.of_kind(PartKind::Barrel).map(|body| stack.parts[body].wine).sum(),
            stack,
        })
    }
}

/// The plan of a cellar.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Models, one for each number of levels, in the order of [`Cellar::models`].
    pub models: Vec<Model>,
    /// The stacks in their places, row by row.
    pub stacks: Vec<Standing>,
    /// Footprints of the stacks.
    pub footprints: Vec<Convex>,
    /// Problems that prevent a run, each with its place in the file and the indices of the stacks that are wrongly
    /// placed.
    pub problems: Vec<(ScenarioError, Vec<usize>)>,
    /// Summary of the plan.
    pub summary: PlanSummary,
}

described! {
    /// The plan of a cellar. Lengths are in m.
    #[derive(Clone, Debug)]
    pub struct PlanSummary {
        /// Name and version of the format of this document.
        pub schema: &'static str ["cellar-plan/1"],
        /// Title of the cellar.
        pub title: String,
        /// Number of rows.
        pub rows: u32,
        /// Number of stacks.
        pub stacks: usize,
        /// Number of barrels.
        pub barrels: u64,
        /// Volume of the wine.
        pub wine: f64 as "m3",
        /// Number of shocks of the motion.
        pub shocks: usize,
        /// True if all bodies start as built; false if the cellar states other places from which bodies start.
        pub as_built: bool,
        /// Area of the room for each barrel.
        pub area_per_barrel: f64 as "m2",
        /// Shortest distance between a stack and a side of the room; null if there is no wall.
        pub nearest_wall: Option<NearWall>,
        /// Shortest distance between two stacks; null for a single stack.
        pub nearest_stacks: Option<NearStacks>,
        /// The aisles.
        pub aisles: Vec<AislePlan>,
        /// The places where people work.
        pub places: Vec<PlacePlan>,
        /// Problems that prevent a run, one sentence each, with their places in the file.
        pub problems: Vec<String>,
        /// Findings about narrowed aisles and about places without a path to a door, one sentence each.
        pub findings: Vec<String>,
        /// Hash of the cellar with every default written out.
        pub cellar_hash: String,
    }

    /// A stack and the side of the room that is nearest to it.
    #[derive(Clone, Debug)]
    pub struct NearWall {
        /// Name of the stack.
        pub stack: String,
        /// The side of the room.
        pub side: &'static str ["left", "right", "near", "far"],
        /// Clear distance between the stack and the side of the room.
        pub distance: f64 as "m",
    }

    /// The two stacks that are nearest to each other.
    #[derive(Clone, Debug)]
    pub struct NearStacks {
        /// Name of one stack.
        pub first: String,
        /// Name of the other stack.
        pub second: String,
        /// Clear distance between the two stacks.
        pub distance: f64 as "m",
    }

    /// An aisle before the shaking.
    #[derive(Clone, Debug)]
    pub struct AislePlan {
        /// Name of the aisle.
        pub name: String,
        /// Clear width at the narrowest cross section.
        pub narrowest: f64 as "m",
    }

    /// Access to a door, before the shaking, from a place where people work.
    #[derive(Clone, Debug)]
    pub struct PlacePlan {
        /// Name of the place.
        pub name: String,
        /// True if a path 0.6 m wide leads from the place to a door; null if there is no door.
        pub leads_out: Option<bool>,
    }
}

impl Plan {
    /// Lays out a cellar and checks it.
    ///
    /// # Errors
    /// If a stack cannot be built in three dimensions. Stacks in wrong places are listed in [`Plan::problems`].
    pub fn of(cellar: &Cellar) -> Result<Self, RunFailure> {
        let models = cellar.models.iter().map(Model::of).collect::<Result<Vec<_>, _>>()?;
        let stacks = layout(cellar, &models);
        let footprints: Vec<Convex> = stacks
            .iter()
            .map(|one| models[one.model].footprint.placed(one.at, one.azimuth))
            .collect();
        let mut problems = Vec::new();
        if let Err(error) = starts(&cellar.start, &cellar.host, &stacks, &models) {
            problems.push((error, Vec::new()));
        }
        let nearest_stacks = neighbors(cellar, &stacks, &footprints, &mut problems);
        let nearest_wall = walls(cellar, &stacks, &footprints, &mut problems);
        columns(cellar, &stacks, &footprints, &mut problems);
        doors(cellar, &stacks, &footprints, &mut problems);
        let mut findings = Vec::new();
        let obstacles = Obstacles { cellar, taken: footprints.iter().collect() };
        let aisles: Vec<AislePlan> = cellar
            .aisles
            .iter()
            .map(|aisle| {
                let name = aisle.name.clone();
                AislePlan { narrowest: obstacles.narrowest(aisle.from, aisle.to), name }
            })
            .collect();
        for aisle in &aisles {
            if aisle.narrowest < PASSAGE {
                findings.push(format!(
                    "the aisle \"{}\" is {} at its narrowest, less than the {PASSAGE} m that a person needs",
                    aisle.name,
                    meters(aisle.narrowest)
                ));
            }
        }
        let free = obstacles.paths_to_doors();
        let places: Vec<PlacePlan> = cellar
            .places
            .iter()
            .zip(free)
            .map(|(place, leads_out)| PlacePlan { name: place.name.clone(), leads_out })
            .collect();
        for place in places.iter().filter(|place| place.leads_out == Some(false)) {
            findings.push(format!(
                "no path {PASSAGE} m wide leads from the place \"{}\" to a door",
                place.name
            ));
        }
        if cellar.doors.is_empty() && !cellar.places.is_empty() {
            findings.push(
                "there are places where people work, but no door by which to leave".to_owned(),
            );
        }
        let wine: f64 = stacks.iter().map(|one| models[one.model].wine).sum();
        let barrels = cellar.barrels();
        let summary = PlanSummary {
            schema: "cellar-plan/1",
            title: cellar.title.clone(),
            rows: stacks.last().map_or(0, |last| last.row),
            stacks: stacks.len(),
            barrels,
            wine,
            shocks: 1 + cellar.later.len(),
            as_built: cellar.start.is_as_built(),
            area_per_barrel: cellar.room.length * cellar.room.width / barrels.max(1) as f64,
            nearest_wall,
            nearest_stacks,
            aisles,
            places,
            problems: problems.iter().map(|(error, _)| error.sentence()).collect(),
            findings,
            cellar_hash: format!("{:016x}", cellar.with_records()?.fingerprint()),
        };
        Ok(Self { models, stacks, footprints, problems, summary })
    }

    /// Returns the plan as a picture, with stacks in wrong places marked.
    pub fn picture(&self, cellar: &Cellar) -> FloorPlan {
        let wrong = |at: usize| self.problems.iter().any(|(_, stacks)| stacks.contains(&at));
        let kind = |at: usize| if wrong(at) { RegionKind::Wrong } else { RegionKind::Stands };
        self.drawn(cellar, &kind)
    }

    /// Returns the plan as a picture. `kind` maps the index of a stack to the kind of region as which the stack is
    /// drawn.
    pub(crate) fn drawn(&self, cellar: &Cellar, kind: &dyn Fn(usize) -> RegionKind) -> FloorPlan {
        let RoomSpec { length, width, .. } = cellar.room;
        let mut regions: Vec<Region> = cellar
            .aisles
            .iter()
            .map(|aisle| Region::rectangle(aisle.from, aisle.to, RegionKind::Zone, &aisle.name))
            .collect();
        for door in &cellar.doors {
            let [a, b] = opening(&cellar.room, door, LEAF);
            regions.push(Region::rectangle(a, b, RegionKind::Door, &door.name));
        }
        for (at, (stack, footprint)) in self.stacks.iter().zip(&self.footprints).enumerate() {
            let outline = footprint.corners().to_vec();
            regions.push(Region { outline, kind: kind(at), label: stack.name.clone() });
        }
        for column in &cellar.columns {
            let [lower, upper] = column.corners();
            regions.push(Region::rectangle(lower, upper, RegionKind::Solid, ""));
        }
        let marks = cellar.places.iter().map(|place| (place.at, place.name.clone())).collect();
        FloorPlan { size: [length, width], regions, heat: None, marks }
    }
}

impl PlanSummary {
    /// Describes the plan in sentences: the contents of the room, the smallest distances, the aisles and the paths to
    /// doors.
    pub fn sentences(&self) -> Vec<String> {
        let mut all = vec![format!(
            "{} in {}: {} barrels, {} of wine, {} m² of floor for each barrel.",
            plural(u32::try_from(self.stacks).unwrap_or(u32::MAX), "stack"),
            plural(self.rows, "row"),
            self.barrels,
            liters(self.wine),
            shortest((100.0 * self.area_per_barrel).round() / 100.0),
        )];
        if let Some(near) = &self.nearest_wall {
            all.push(format!(
                "The stack nearest to a wall is {}, {} from the {} wall.",
                near.stack,
                meters(near.distance),
                near.side
            ));
        }
        if let Some(near) = &self.nearest_stacks {
            all.push(format!(
                "The stacks nearest to each other are {} and {}, {} apart.",
                near.first,
                near.second,
                meters(near.distance)
            ));
        }
        for aisle in &self.aisles {
            all.push(format!(
                "The aisle \"{}\" is {} wide at its narrowest.",
                aisle.name,
                meters(aisle.narrowest)
            ));
        }
        for place in self.places.iter().filter(|place| place.leads_out == Some(true)) {
            all.push(format!(
                "A path {PASSAGE} m wide leads from the place \"{}\" to a door.",
                place.name
            ));
        }
        if self.shocks > 1 {
            all.push(format!("The motion is a sequence of {} shocks.", self.shocks));
        }
        if !self.as_built {
            all.push(
                "Bodies start from the places that the input states; the plan shows the stacks as built.".to_owned(),
            );
        }
        all
    }
}

/// Formats a length (m) with its unit, rounded to centimeters; a negative length is formatted as zero.
pub(crate) fn meters(length: f64) -> String {
    format!("{:.2} m", length.max(0.0))
}

/// Formats a volume (m³) in liters.
pub(crate) fn liters(volume: f64) -> String {
    format!("{:.0} L", 1e3 * volume)
}

/// Returns the stacks of all blocks in their places.
fn layout(cellar: &Cellar, models: &[Model]) -> Vec<Standing> {
    let mut all = Vec::new();
    let mut number = 0;
    for (index, (block, rows)) in cellar.blocks.iter().zip(&cellar.model_of).enumerate() {
        let mut y = block.first[1];
        for (row, model) in rows.iter().enumerate() {
            number += 1;
            let [lower, upper] = models[*model].footprint.placed([0.0; 2], block.azimuth).bounds();
            let [wide, deep] = [upper[0] - lower[0], upper[1] - lower[1]];
            for stack in 0..block.stacks {
                let x = block.first[0] + f64::from(stack) * (wide + block.spacing);
                all.push(Standing {
                    name: format!("{number}-{}", stack + 1),
                    row: number,
                    number: stack + 1,
                    block: index,
                    model: *model,
                    at: [x - lower[0], y - lower[1]],
                    azimuth: block.azimuth,
                });
            }
            let group_ends = (row + 1) % block.rows_together.max(1) as usize == 0;
            y += deep + if group_ends { block.aisle } else { block.between_rows };
        }
    }
    all
}

type Problems = Vec<(ScenarioError, Vec<usize>)>;

/// Smallest overlap (m) that is a problem. It is far smaller than the precision of stated distances.
const TOUCH: f64 = 1e-6;

/// Finds overlaps of stacks, and the two stacks that are nearest to each other.
fn neighbors(
    cellar: &Cellar,
    stacks: &[Standing],
    footprints: &[Convex],
    problems: &mut Problems,
) -> Option<NearStacks> {
    let bounds: Vec<[Point; 2]> = footprints.iter().map(Convex::bounds).collect();
    let mut order: Vec<usize> = (0..stacks.len()).collect();
    order.sort_by(|a, b| bounds[*a][0][0].total_cmp(&bounds[*b][0][0]));
    let mut nearest: Option<(f64, usize, usize)> = None;
    let mut overlaps: Vec<(usize, usize, f64)> = Vec::new();
    for (at, first) in order.iter().enumerate() {
        for second in &order[at + 1..] {
            let least = nearest.map_or(f64::INFINITY, |(distance, ..)| distance.max(0.0));
            if bounds[*second][0][0] - bounds[*first][1][0] > least {
                break;
            }
            let beside = bounds[*second][0][1] - bounds[*first][1][1];
            let below = bounds[*first][0][1] - bounds[*second][1][1];
            if beside.max(below) > least {
                continue;
            }
            let distance = footprints[*first].apart(&footprints[*second]);
            if distance < -TOUCH {
                overlaps.push(((*first).min(*second), (*first).max(*second), -distance));
            }
            if distance < least {
                nearest = Some((distance, *first, *second));
            }
        }
    }
    overlaps.sort_by_key(|(first, second, _)| (*first, *second));
    if let Some((first, second, depth)) = overlaps.first().copied() {
        let more = match overlaps.len() - 1 {
            0 => String::new(),
            1 => ", and so does 1 more pair".to_owned(),
            more => format!(", and so do {more} more pairs"),
        };
        let [one, two] = [&stacks[first], &stacks[second]];
        let [path, remedy] = if one.block != two.block {
            [format!("block.{}.first", two.block + 1), "move this block".to_owned()]
        } else if one.row == two.row {
            [format!("block.{}.spacing", two.block + 1), "increase the spacing".to_owned()]
        } else {
            [
                format!("block.{}.aisle", two.block + 1),
                "increase the distance between the rows".to_owned(),
            ]
        };
        let fallback = format!("block.{}.first", two.block + 1);
        let message = format!(
            "stacks {} and {} overlap by {}{more}: {remedy}",
            one.name,
            two.name,
            meters(depth)
        );
        let wrong = overlaps.iter().flat_map(|(first, second, _)| [*first, *second]).collect();
        problems.push((cellar.host.error(&[&path, &fallback], message), wrong));
    }
    nearest.map(|(distance, first, second)| {
        let [first, second] = [first.min(second), first.max(second)];
        NearStacks {
            first: stacks[first].name.clone(),
            second: stacks[second].name.clone(),
            distance: distance.max(0.0),
        }
    })
}

/// Finds stacks that overlap walls, and the stack that is nearest to a wall.
fn walls(
    cellar: &Cellar,
    stacks: &[Standing],
    footprints: &[Convex],
    problems: &mut Problems,
) -> Option<NearWall> {
    let RoomSpec { length, width, .. } = cellar.room;
    let mut nearest: Option<(f64, usize, &'static str)> = None;
    let mut wrong = Vec::new();
    for (at, footprint) in footprints.iter().enumerate() {
        let [lower, upper] = footprint.bounds();
        let sides = [
            (lower[0], "left"),
            (length - upper[0], "right"),
            (lower[1], "near"),
            (width - upper[1], "far"),
        ];
        for (distance, side) in sides {
            if distance < -TOUCH {
                wrong.push((at, -distance, side));
            }
            if nearest.is_none_or(|(least, ..)| distance < least) {
                nearest = Some((distance, at, side));
            }
        }
    }
    if let Some((at, depth, side)) = wrong.first().copied() {
        let mut all: Vec<usize> = wrong.iter().map(|(at, ..)| *at).collect();
        all.dedup();
        let more = match all.len() - 1 {
            0 => String::new(),
            1 => ", as does 1 more stack".to_owned(),
            more => format!(", as do {more} more stacks"),
        };
        let border = if cellar.room.walls { "wall" } else { "edge of the room" };
        let block = stacks[at].block + 1;
        let message = format!(
            "stack {} extends {} beyond the {side} {border}{more}: move the block, use fewer stacks, or enlarge the \
             room",
            stacks[at].name,
            meters(depth)
        );
        problems.push((cellar.host.error(&[&format!("block.{block}.first")], message), all));
    }
    let (distance, at, side) = nearest.filter(|_| cellar.room.walls)?;
    Some(NearWall { stack: stacks[at].name.clone(), side, distance: distance.max(0.0) })
}

/// Finds stacks that overlap columns.
fn columns(cellar: &Cellar, stacks: &[Standing], footprints: &[Convex], problems: &mut Problems) {
    for (index, column) in (1..).zip(&cellar.columns) {
        let [lower, upper] = column.corners();
        let shape = Convex::rectangle(lower, upper);
        let hit: Vec<usize> =
            (0..stacks.len()).filter(|at| footprints[*at].apart(&shape) < -TOUCH).collect();
        if let Some(at) = hit.first() {
            let message = format!(
                "the column \"{}\" overlaps stack {}: move the column or the block",
                column.name, stacks[*at].name
            );
            problems.push((cellar.host.error(&[&format!("column.{index}.at")], message), hit));
        }
    }
}

/// Returns two opposite corners of the floor area in front of a door. The area is as wide as the door, and reaches to a
/// depth (m) inside the room.
pub(crate) fn opening(room: &RoomSpec, door: &Door, depth: f64) -> [Point; 2] {
    let [a, b] = [door.position - 0.5 * door.width, door.position + 0.5 * door.width];
    match door.side {
        Side::Left => [[0.0, a], [depth, b]],
        Side::Right => [[room.length - depth, a], [room.length, b]],
        Side::Near => [[a, 0.0], [b, depth]],
        Side::Far => [[a, room.width - depth], [b, room.width]],
    }
}

/// Finds stacks in front of doors.
fn doors(cellar: &Cellar, stacks: &[Standing], footprints: &[Convex], problems: &mut Problems) {
    for (index, door) in (1..).zip(&cellar.doors) {
        let [a, b] = opening(&cellar.room, door, ENTRY);
        let shape = Convex::rectangle(a, b);
        let hit: Vec<usize> =
            (0..stacks.len()).filter(|at| footprints[*at].apart(&shape) < -TOUCH).collect();
        if let Some(at) = hit.first() {
            let message = format!(
                "stack {} is too close to the door \"{}\": the room must be free up to {ENTRY} m from the door; move \
                 the door or the block",
                stacks[*at].name, door.name
            );
            problems.push((cellar.host.error(&[&format!("door.{index}.position")], message), hit));
        }
    }
}

/// Footprints of the bodies that occupy the floor of a room.
pub(crate) struct Obstacles<'a> {
    pub(crate) cellar: &'a Cellar,
    pub(crate) taken: Vec<&'a Convex>,
}

/// Side (m) of a cell in the search for a path.
const CELL: f64 = 0.1;

impl Obstacles<'_> {
    /// Returns, for each place where people work, `true` if a path as wide as a person leads to a door; `None` if there
    /// are no doors.
    pub(crate) fn paths_to_doors(&self) -> Vec<Option<bool>> {
        let cellar = self.cellar;
        if cellar.places.is_empty() || cellar.doors.is_empty() {
            return vec![None; cellar.places.len()];
        }
        let RoomSpec { length, width, walls, .. } = cellar.room;
        let half = 0.5 * PASSAGE;
        let mut grid = Grid::new([0.0; 2], [length, width], CELL);
        self.take_from(&mut grid);
        let near_wall = |[x, y]: Point| {
            let nearest = x.min(y).min(length - x).min(width - y);
            walls && nearest < half - 0.5 * CELL
        };
        grid.take_where(near_wall);
        let at_door = |[x, y]: Point| {
            cellar.doors.iter().any(|door| {
                let [a, b] = opening(&cellar.room, door, half + CELL);
                // The center of a person in front of the opening is at least half the width of a person from its
                // edges.
                let narrow = |low: f64, high: f64, value: f64, along: bool| {
                    let inset = if along { half - 0.5 * CELL } else { 0.0 };
                    value >= low + inset && value <= high - inset
                };
                let along_x = matches!(door.side, Side::Near | Side::Far);
                narrow(a[0], b[0], x, along_x) && narrow(a[1], b[1], y, !along_x)
            })
        };
        cellar
            .places
            .iter()
            .map(|place| {
                // A person who stands next to a wall or a barrel starts from the nearest free floor.
                let reach = half + CELL;
                let starts = |[x, y]: Point| {
                    let [dx, dy] = [x - place.at[0], y - place.at[1]];
                    dx * dx + dy * dy <= reach * reach
                };
                Some(grid.leads(starts, at_door))
            })
            .collect()
    }

    /// Marks as taken all floor that is closer to a body or a column than half the width of a person, since the center
    /// of a person cannot be there.
    fn take_from(&self, grid: &mut Grid) {
        let half = 0.5 * PASSAGE;
        for polygon in &self.taken {
            grid.take(polygon, half);
        }
        for column in &self.cellar.columns {
            let [lower, upper] = column.corners();
            grid.take(&Convex::rectangle(lower, upper), half);
        }
    }

    /// Returns `true` if a path as wide as a person leads through an aisle along its longer side. The aisle is the
    /// rectangle with the opposite corners `from` and `to`.
    pub(crate) fn is_passable(&self, from: Point, to: Point) -> bool {
        let axis = usize::from(to[1] - from[1] > to[0] - from[0]);
        let half = 0.5 * PASSAGE;
        let mut grid = Grid::new(from, to, CELL);
        self.take_from(&mut grid);
        let across = 1 - axis;
        grid.take_where(|point| {
            point[across] - from[across] < half - 0.5 * CELL
                || to[across] - point[across] < half - 0.5 * CELL
        });
        let cell = grid.cell;
        grid.leads(|point| point[axis] < from[axis] + cell, |point| point[axis] > to[axis] - cell)
    }

    /// Returns the share of the area of an aisle that the footprints cover. The aisle is the rectangle with the
    /// opposite corners `from` and `to`.
    pub(crate) fn covered(&self, from: Point, to: Point) -> f64 {
        let mut grid = Grid::new(from, to, 0.05);
        for polygon in &self.taken {
            grid.take(polygon, 0.0);
        }
        grid.share()
    }

    /// Returns the clear width (m) of an aisle at its narrowest cross section. The aisle is the rectangle with the
    /// opposite corners `from` and `to`.
    fn narrowest(&self, from: Point, to: Point) -> f64 {
        let axis = usize::from(to[1] - from[1] > to[0] - from[0]);
        let across = 1 - axis;
        let zone = Convex::rectangle(from, to);
        let near: Vec<&&Convex> =
            self.taken.iter().filter(|polygon| polygon.apart(&zone) < 0.0).collect();
        let columns = self.cellar.columns.iter().map(|column| {
            let [lower, upper] = column.corners();
            Convex::rectangle(lower, upper)
        });
        let columns: Vec<Convex> = columns.filter(|column| column.apart(&zone) < 0.0).collect();
        let mut least = to[across] - from[across];
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
        let steps = (((to[axis] - from[axis]) / 0.05).ceil() as usize).clamp(1, 20_000);
        for step in 0..=steps {
            let at = from[axis] + (to[axis] - from[axis]) * step as f64 / steps as f64;
            let mut taken: Vec<[f64; 2]> = near
                .iter()
                .map(|polygon| **polygon)
                .chain(&columns)
                .filter_map(|polygon| section(polygon, axis, at))
                .collect();
            taken.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let (mut free, mut reached) = (0.0_f64, from[across]);
            for [low, high] in taken {
                free = free.max(low.min(to[across]) - reached);
                reached = reached.max(high);
            }
            least = least.min(free.max(to[across] - reached));
        }
        least.max(0.0)
    }
}

/// Returns the interval that a polygon covers on the line perpendicular to `axis` at the coordinate `at`; `None` if the
/// line does not meet the polygon.
fn section(polygon: &Convex, axis: usize, at: f64) -> Option<[f64; 2]> {
    let across = 1 - axis;
    let corners = polygon.corners();
    let next = corners.iter().cycle().skip(1);
    let mut found: Option<[f64; 2]> = None;
    for (a, b) in corners.iter().zip(next) {
        let (low, high) = if a[axis] < b[axis] { (a, b) } else { (b, a) };
        if at < low[axis] || at > high[axis] {
            continue;
        }
        let run = high[axis] - low[axis];
        let share = if run > 0.0 { (at - low[axis]) / run } else { 0.0 };
        let value = low[across] + share * (high[across] - low[across]);
        let [least, most] = found.unwrap_or([value, value]);
        found = Some([least.min(value), most.max(value)]);
        if run == 0.0 {
            let [least, most] = found.unwrap_or([value, value]);
            found = Some([least.min(high[across]), most.max(high[across])]);
        }
    }
    found
}

/// Returns the outline of a body from above: the hull of the points of its surface in a pose.
pub(crate) fn outline_in_plan(points: &[Vec3], pose: &[f64; 7]) -> Convex {
    let [x, y, _, w, a, b, c] = *pose;
    let turn = Quaternion { w, v: Vec3::new(a, b, c) }.matrix();
    let hull = points.iter().map(|point| {
        let turned = turn.apply(*point);
        [x + turned.x, y + turned.y]
    });
    Convex::hull(hull.collect())
}

/// Returns the horizontal distance (m) between two poses.
pub(crate) fn moved(from: &[f64; 7], to: &[f64; 7]) -> f64 {
    let [x, y] = [to[0] - from[0], to[1] - from[1]];
    (x * x + y * y).sqrt()
}
