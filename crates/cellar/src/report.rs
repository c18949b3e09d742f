//! The results of a cellar as a report page, as tables and as output files.

use std::sync::Arc;

use barrelstack::motion::STANDARD_GRAVITY;
use barrelstack::report::WORDS;
use barrelstack::variants::words::percent;
use barrelstack::variants::{FEW, Range};
use barrelstack_report::{
    Block, Cell, Document, Dots, Figure, FloorPlan, Heat, Language, Pane, Players, RegionKind,
    Table, Verdict, described,
};
use barrelstack_space::drawing::{Shown, Sight, together};

use crate::answer::Answer;
use crate::plan::liters;
use crate::result::BodyEnd;
use crate::sample::CELL;
use crate::start::POSE;
use crate::summary::{CellarSummary, Count, ShockAnswer, ShockStack, ShownStack, counted};
use crate::words::{sentences, shown_run, span, span_of_shares, tone};

/// Returns the plan of a cellar with the outcome of each stack in the run that is shown, and with the share of variants
/// in which fallen barrels cover each place at the end.
pub fn picture(answer: &Answer) -> FloorPlan {
    let Answer { prepared, cases, summary, .. } = answer;
    // If the work was stopped, the outcomes of the stacks are unknown.
    let kind = |at: usize| match summary.shown.stacks[at].fate {
        _ if summary.unfinished.is_some() => RegionKind::Stands,
        "falls-by-itself" => RegionKind::Falls,
        "knocked-over" => RegionKind::Knocked,
        "fallen-before" => RegionKind::Down,
        _ => RegionKind::Stands,
    };
    let counted = counted(cases);
    let grid = prepared.map();
    let share = |cell: usize| {
        let covered = counted.iter().filter(|case| case.map[cell]).count();
        covered as f64 / counted.len().max(1) as f64
    };
    let heat = Heat {
        cell: grid.cell,
        columns: grid.columns,
        shares: (0..grid.cells().len()).map(share).collect(),
        label: "barrels".to_owned(),
    };
    let heat = Some(heat).filter(|heat| heat.shares.iter().any(|share| *share > 0.0));
    FloorPlan { heat, ..prepared.plan.drawn(&prepared.cellar, &kind) }
}

/// Largest number of poses in the animation of a page.
const MOST_POSES: f64 = 60_000.0;

/// Largest frame rate (1/s) of the animation of a page.
const RATE: f64 = 20.0;

/// Returns the animation of the run that is shown; `None` if there are no frames, or if the room has too many bodies
/// for a smooth animation.
fn players(answer: &Answer) -> Option<Block> {
    let Answer { prepared, shown, summary, .. } = answer;
    let end = shown.end_time;
    let bodies = shown.bodies.len() as f64;
    let rate = RATE.min(MOST_POSES / (bodies * end.max(1.0)));
    if shown.frames.is_empty() || rate < 2.0 {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
    let times: Vec<f64> = (0..=(end * rate) as usize).map(|at| at as f64 / rate).collect();
    let mut all = Vec::new();
    for (at, (frames, end)) in shown.frames.iter().zip(&shown.stacks).enumerate() {
        let model = &prepared.plan.models[prepared.plan.stacks[at].model].stack;
        // A stack at rest has no further frames.
        let frame = |time: &f64| frames.times.partition_point(|t| *t <= *time).max(1) - 1;
        let chosen: Vec<usize> = times.iter().map(frame).collect();
        for (index, body) in end.bodies.clone().enumerate() {
            all.push(Shown {
                name: format!("{} {}", end.name, shown.bodies[body].name),
                part: &model.parts[index + 1],
                body: &model.model.bodies()[index + 1],
                path: chosen.iter().map(|frame| frames.poses[*frame][index]).collect(),
                leaves_at: shown.bodies[body].fate.left_seat.map(|(time, ..)| time),
            });
        }
    }
    let pane = |sight: Sight, mark: &str, name: &str| Pane {
        mark: mark.to_owned(),
        name: name.to_owned(),
        verdict: String::new(),
        tone: tone(summary),
        scene: Arc::new(together(&all, &times, sight)),
        traces: Vec::new(),
    };
    Some(Block::Players(Players {
        id: "players".into(),
        caption: format!(
            "The run that is shown ({}), in a view that can be turned, or from the front and from above. Times are \
             those of the {}record: the shaking starts at {:.2} s.{}",
            shown_run(summary),
            if summary.shocks.is_empty() { "" } else { "first " },
            summary.onset,
            if summary.shocks.is_empty() {
                ""
            } else {
                " They run on through the whole sequence and leave out the quiet time between the shocks."
            }
        ),
        panes: vec![
            pane(Sight::Across, "X", "From the front"),
            pane(Sight::Above, "Z", "From above"),
        ],
        overlay: None,
        ground: Vec::new(),
    }))
}

/// Number of supporting sentences that are always shown below the headline; the others are collapsed on screen.
const OPENING: usize = 3;

/// Returns the report on a cellar as a document that does not depend on the output format.
pub fn document(answer: &Answer) -> Document {
    let summary = &answer.summary;
    let heading = |text: &str| Block::heading(2, text);
    let caption = format!(
        "The room from above. The color of a stack shows what happens to it in the run that is shown ({}). The \
         shades show the share of the variants in which fallen barrels cover the floor at the end, in cells of \
         {CELL} m. Racks are not drawn, but they count as obstacles in the table of aisles.",
        shown_run(summary)
    );
    let mut blocks = vec![
        heading("Where the barrels end up"),
        Block::Figure(Figure::new("plan", caption, picture(answer))),
    ];
    blocks.extend(players(answer));
    if !summary.aisles.is_empty() || !summary.places.is_empty() {
        blocks.push(heading("Aisles and paths to the doors"));
    }
    if !summary.aisles.is_empty() {
        blocks.push(Block::Table(aisles(summary)));
    }
    if !summary.places.is_empty() {
        blocks.push(Block::Table(places(summary)));
    }
    let touched: Vec<&ShownStack> =
        summary.shown.stacks.iter().filter(|one| one.touched_at.is_some()).collect();
    if !touched.is_empty() {
        blocks.push(heading("What strikes what"));
        blocks.push(Block::Table(contacts(&touched)));
    }
    if !summary.shocks.is_empty() {
        blocks.push(heading("Shock by shock"));
        blocks.push(Block::Table(shocks(summary)));
    }
    blocks.push(heading("Stack by stack"));
    blocks.push(Block::Table(stacks(summary)));
    if summary.plan.rows > 1 {
        blocks.push(Block::Table(rows(summary)));
    }
    if summary.obstacles.iter().any(|one| one.peak.is_some()) {
        blocks.push(heading("Walls and columns"));
        blocks.push(Block::Table(obstacles(summary)));
    }
    blocks.push(heading("The plan before the shaking"));
    blocks.push(Block::List(
        summary
            .plan
            .sentences()
            .into_iter()
            .chain(summary.plan.findings.iter().map(|finding| sentence(finding)))
            .collect(),
    ));
    let fell = summary.room.some_fall.of_variants;
    let mut opening = sentences(summary);
    // The tables also contain the results of the sentences that are collapsed.
    let fine = opening.split_off(OPENING.min(opening.len()));
    Document {
        title: summary.title.clone(),
        verdict: Verdict {
            headline: summary.headline.clone(),
            dots: vec![Dots {
                direction: String::new(),
                fell,
                stood: summary.counted - fell,
                open: u32::try_from(summary.broken.len()).unwrap_or(u32::MAX),
            }],
            sentences: opening,
            fine,
            tone: tone(summary),
            ..Verdict::default()
        },
        blocks,
        provenance: provenance(answer),
        words: WORDS.to_vec(),
        warnings: summary.warnings.clone(),
        ..Document::default()
    }
}

fn sentence(finding: &str) -> String {
    format!("{}.", barrelstack_report::capital(finding))
}

fn provenance(answer: &Answer) -> Vec<(String, String)> {
    let summary = &answer.summary;
    let mut rows = vec![
        ("program".to_owned(), format!("{} {}", summary.program, summary.version)),
        ("cellar".to_owned(), summary.plan.cellar_hash.clone()),
        ("variants".to_owned(), summary.counted.to_string()),
    ];
    rows.extend(summary.provenance.iter().map(|step| ("source".to_owned(), step.clone())));
    rows
}

fn times(range: Option<&Range>, of: u32) -> Cell {
    Cell::maybe(range.map(|range| span(range, of, 1, "s")))
}

/// Formats a share of variants with its 95 % interval; a dash if there are no variants.
pub(crate) fn count(count: &Count) -> Cell {
    Cell::text(match count.share {
        Some(share) => {
            let [low, high] = count.interval.map(percent);
            format!("{} ({low} to {high})", percent(share))
        }
        None => "–".to_owned(),
    })
}

fn aisles(summary: &CellarSummary) -> Table {
    Table::of(
        format!(
            "Times are counted from the start of the shaking. Ranges span the 5th to the 95th percentile of the \
             variants in which the event happens, or all of these variants if there are fewer than {FEW}; shares of \
             variants are given with their 95 % intervals. A barrel lies in the aisle if its center is above the floor \
             of the aisle. The floor counts as covered where a body is above it, at any height; an aisle is blocked if \
             no path 0.6 m wide leads through it."
        ),
        &summary.aisles,
        &[
            ("aisle", "", &|aisle| Cell::text(&aisle.name)),
            ("a barrel comes in", "", &|aisle| count(&aisle.entered)),
            ("first barrel", "", &|aisle| {
                times(aisle.first_barrel.as_ref(), aisle.entered.of_variants)
            }),
            ("blocked at the end", "", &|aisle| count(&aisle.blocked)),
            ("blocked after", "", &|aisle| {
                times(aisle.blocked_at.as_ref(), aisle.blocked.of_variants)
            }),
            ("area covered", "", &|aisle| {
                Cell::text(span_of_shares(&aisle.covered, summary.counted))
            }),
            ("fastest barrel", "m/s", &|aisle| {
                Cell::measured(aisle.fastest.map(|fast| fast.most), 1)
            }),
        ],
    )
}

fn places(summary: &CellarSummary) -> Table {
    Table::of(
        "Share of the variants in which, at the end of the run, a path 0.6 m wide leads from the place to a door, with \
         its 95 % interval.",
        &summary.places,
        &[
            ("place", "", &|place| Cell::text(&place.name)),
            ("a path to a door is left", "", &|place| {
                place.leads_out.as_ref().map_or(Cell::Missing, count)
            }),
        ],
    )
}

fn contacts(touched: &[&ShownStack]) -> Table {
    let time = |at: Option<f64>| Cell::measured(at, 2);
    let fate = |one: &&&ShownStack| {
        Cell::text(match one.fate {
            "stands" => "stands",
            "knocked-over" => "is knocked over",
            "fallen-before" => "had fallen before",
            _ => "falls by itself",
        })
    };
    let body = |one: &&&ShownStack, which: usize| {
        Cell::maybe(one.bodies.as_ref().map(|bodies| bodies[which].clone()))
    };
    Table::of(
        "First contact of each stack with another stack in the run that is shown. A stack counts as knocked over if \
         this contact precedes its first loss of a seat.",
        touched,
        &[
            ("stack", "", &|one| Cell::text(&one.name)),
            ("its body", "", &|one| body(one, 0)),
            ("struck by stack", "", &|one| Cell::maybe(one.touched_by.clone())),
            ("with body", "", &|one| body(one, 1)),
            ("at", "s", &|one| time(one.touched_at)),
            ("impulse before it falls", "N s", &|one| Cell::number(one.impulse, 2)),
            ("first loss of a seat", "s", &|one| time(one.falls_at)),
            ("outcome", "", &fate),
        ],
    )
}

/// Returns the table of the shocks of a sequence.
pub fn shocks(summary: &CellarSummary) -> Table {
    Table::of(
        "Shocks of the sequence. Every shock starts from the poses in which the previous shock has left the bodies, \
         at rest. Numbers of stacks are means over the variants; shares of variants are given with their 95 % \
         intervals.",
        &summary.shocks,
        &[
            ("shock", "", &|one| Cell::text(one.shock.to_string())),
            ("largest acceleration along x", "g", &|one| {
                Cell::measured(one.motion.as_ref().map(|motion| motion.pga / STANDARD_GRAVITY), 2)
            }),
            ("stacks standing before", "", &|one| Cell::Measured(one.stood, 1)),
            ("fall by themselves", "", &|one| Cell::Measured(one.by_themselves, 1)),
            ("knocked over", "", &|one| Cell::Measured(one.knocked_over, 1)),
            ("all survive", "", &|one| count(&one.all_survive)),
            ("barrels fallen", "", &|one| {
                Cell::text(span(&one.barrels_fallen, summary.counted, 0, "").trim_end())
            }),
            ("aisles blocked after it", "", &|one| {
                let shares = one.blocked.iter().filter_map(|count| count.share);
                let shares: Vec<String> = shares.map(percent).collect();
                Cell::maybe((!shares.is_empty()).then(|| shares.join(", ")))
            }),
            ("bodies still move at its end", "", &|one| count(&one.still_moving)),
        ],
    )
}

/// Returns the table of all stacks.
pub fn stacks(summary: &CellarSummary) -> Table {
    Table::of(
        format!(
            "All stacks, {}. Shares are given with their 95 % intervals; times are counted from the start of the \
             shaking. Movement is the largest displacement of any body that did not fall (median over the variants \
             in which the stack stands). Inspect the stacks with the largest movement first.",
            crate::words::plural(summary.counted, "variant")
        ),
        &summary.stacks,
        &[
            ("stack", "", &|stack| Cell::text(&stack.name)),
            ("falls", "", &|stack| count(&stack.falls)),
            ("by itself", "", &|stack| Cell::maybe(stack.by_itself.share.map(percent))),
            ("knocked over", "", &|stack| Cell::maybe(stack.knocked_over.share.map(percent))),
            ("struck first by", "", &|stack| Cell::maybe(stack.touched_by.clone())),
            ("falls after", "", &|stack| times(stack.falls_at.as_ref(), stack.falls.of_variants)),
            ("barrels fallen", "", &|stack| Cell::Measured(stack.barrels_fallen, 1)),
            ("wine lost", "", &|stack| Cell::text(liters(stack.wine_lost))),
            ("movement", "cm", &|stack| {
                Cell::measured(stack.moved.map(|moved| 100.0 * moved.p50), 1)
            }),
        ],
    )
}

fn rows(summary: &CellarSummary) -> Table {
    Table::of(
        "For each row: the share of the variants in which this row contains the first stack to fall, and the mean \
         numbers of its stacks that fall by themselves and that are knocked over.",
        &summary.rows,
        &[
            ("row", "", &|row| Cell::text(row.row.to_string())),
            ("stacks", "", &|row| Cell::text(row.stacks.to_string())),
            ("collapse starts here", "", &|row| count(&row.starts)),
            ("fall by themselves", "", &|row| Cell::Measured(row.by_themselves, 1)),
            ("knocked over", "", &|row| Cell::Measured(row.knocked_over, 1)),
        ],
    )
}

fn obstacles(summary: &CellarSummary) -> Table {
    let most =
        |range: Option<Range>, scale: f64| Cell::number(range.map(|one| scale * one.most), 2);
    let median =
        |range: Option<Range>, scale: f64| Cell::number(range.map(|one| scale * one.p50), 2);
    Table::of(
        "Forces on walls and columns, in the variants in which a body strikes them. Impact forces last a few \
         milliseconds and grow with the assumed stiffness of the contact. Impulses are summed over the whole run and \
         include the impulses of bodies that lean on the wall, so they grow with the duration of the run. Neither the \
         forces nor the impulses are design loads by themselves.",
        &summary.obstacles,
        &[
            ("wall or column", "", &|one| Cell::text(&one.name)),
            ("struck", "", &|one| count(&one.struck)),
            ("largest force", "kN", &|one| most(one.peak, 1e-3)),
            ("median", "kN", &|one| median(one.peak, 1e-3)),
            ("largest impulse over the run", "N s", &|one| most(one.impulse, 1.0)),
        ],
    )
}

impl Answer {
    /// Returns the name and the contents of each output file; the report is in the given language.
    ///
    /// # Errors
    /// If the summary cannot be written as JSON.
    pub fn files(&self, language: Language) -> Result<Vec<(String, Vec<u8>)>, serde_json::Error> {
        let document = document(self).in_language(language);
        let page = barrelstack_report::html(&document);
        let plan = Figure::new("plan", "The room from above.", picture(self));
        let mut files = vec![
            ("report.html".to_owned(), page.into_bytes()),
            ("cellar.json".to_owned(), (described::to_json(&self.summary)? + "\n").into_bytes()),
            ("stacks.csv".to_owned(), stacks_csv(&self.summary).to_csv().into_bytes()),
            ("plan.svg".to_owned(), plan.to_svg().into_bytes()),
            ("cellar.toml".to_owned(), self.prepared.cellar.to_resolved_toml().into_bytes()),
        ];
        if !self.summary.shocks.is_empty() {
            let shocks = shocks_csv(&self.summary).to_csv();
            files.push(("shocks.csv".to_owned(), shocks.into_bytes()));
        }
        Ok(files)
    }

    /// Returns the poses of all bodies at the end of the run that is shown, as a CSV file from which another cellar can
    /// start.
    pub fn state(&self) -> String {
        let pose = |one: &BodyEnd, at: usize| Cell::text(one.own[at].to_string());
        let shown = &self.shown;
        let [x, y, z, w, a, b, c] = POSE;
        let table = Table::of(
            "",
            &shown.bodies,
            &[
                ("stack", "", &|one| Cell::text(&shown.stacks[one.stack].name)),
                ("body", "", &|one| Cell::text(&one.name)),
                (x, "", &|one| pose(one, 0)),
                (y, "", &|one| pose(one, 1)),
                (z, "", &|one| pose(one, 2)),
                (w, "", &|one| pose(one, 3)),
                (a, "", &|one| pose(one, 4)),
                (b, "", &|one| pose(one, 5)),
                (c, "", &|one| pose(one, 6)),
            ],
        );
        table.to_csv()
    }
}

/// Returns the machine-readable table of all stacks in all shocks, with one number in each cell.
fn shocks_csv(summary: &CellarSummary) -> Table {
    let stacks = |shock: &ShockAnswer| {
        let shock = shock.clone();
        shock.stacks.into_iter().map(move |stack| (shock.shock, stack)).collect::<Vec<_>>()
    };
    let rows: Vec<(u32, ShockStack)> = summary.shocks.iter().flat_map(stacks).collect();
    let count = |count: &Count| Cell::Number(f64::from(count.of_variants), 6);
    Table::of(
        "",
        &rows,
        &[
            ("shock", "", &|(shock, _)| Cell::Number(f64::from(*shock), 6)),
            ("stack", "", &|(_, one)| Cell::text(&one.name)),
            ("stands before", "variants", &|(_, one)| count(&one.stood)),
            ("falls by itself", "variants", &|(_, one)| count(&one.by_itself)),
            ("knocked over", "variants", &|(_, one)| count(&one.knocked_over)),
            ("barrels fallen", "1", &|(_, one)| Cell::Number(one.barrels_fallen, 6)),
        ],
    )
}

/// Returns the machine-readable table of all stacks, with one number in each cell.
fn stacks_csv(summary: &CellarSummary) -> Table {
    let number = |value: Option<f64>| value.map_or(Cell::Missing, |value| Cell::Number(value, 6));
    let low_high = |count: &Count, which: usize| Cell::Number(count.interval[which], 6);
    Table::of(
        "",
        &summary.stacks,
        &[
            ("stack", "", &|one| Cell::text(&one.name)),
            ("row", "", &|one| Cell::Number(f64::from(one.row), 6)),
            ("x", "m", &|one| Cell::Number(one.at[0], 6)),
            ("y", "m", &|one| Cell::Number(one.at[1], 6)),
            ("falls", "variants", &|one| Cell::Number(f64::from(one.falls.of_variants), 6)),
            ("share that falls", "1", &|one| number(one.falls.share)),
            ("interval low", "1", &|one| low_high(&one.falls, 0)),
            ("interval high", "1", &|one| low_high(&one.falls, 1)),
            ("share by itself", "1", &|one| number(one.by_itself.share)),
            ("share knocked over", "1", &|one| number(one.knocked_over.share)),
            ("median time of fall", "s", &|one| number(one.falls_at.map(|range| range.p50))),
            ("struck first by", "", &|one| Cell::maybe(one.touched_by.clone())),
            ("barrels fallen", "1", &|one| Cell::Number(one.barrels_fallen, 6)),
            ("wine lost", "m3", &|one| Cell::Number(one.wine_lost, 6)),
            ("median movement", "m", &|one| number(one.moved.map(|range| range.p50))),
        ],
    )
}
