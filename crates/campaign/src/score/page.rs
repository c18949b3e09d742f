//! Report page of a score: the score, all states and directions, the curves, and the protocol.

use barrelstack_fragility::Interval;
use barrelstack_report::{
    Axis, Block, Cell, Document, Figure, Plot, Rating, Series, SeriesStyle, Table, Verdict,
};

use barrelstack::variants::ShareAt;
use barrelstack_input::listing::Source;

use super::{Capacity, Protocol, Scored, Sheet};
use crate::decision::{
    chance_axis, fallen_at_rest, fingerprint, fitted, heading, left_out, percent, raw, text,
};
use crate::direction::Direction;

pub(super) fn document(sheet: &Sheet) -> Document {
    let protocol = &sheet.protocol;
    Document {
        title: format!("RockScore of {}", scored(sheet)),
        verdict: Verdict {
            headline: by_themselves(sheet) + &headline(sheet),
            sentences: sentences(sheet),
            ..Verdict::default()
        },
        blocks: vec![
            Block::Figure(scale_of(sheet)),
            Block::Table(table(sheet)),
            text(
                "The velocity at which one stack in ten collapses is read from the lognormal curve fitted to all runs \
                 by maximum likelihood, with its 95 % interval (clustered by motion) in brackets. The score is the \
                 smallest of these velocities, rounded down. If the friction, stiffness and damping of the seats are \
                 drawn from their distributions, the velocity at which one stack in ten collapses lies within the \
                 range over the uncertain constants with a probability of 95 %. The range includes the sampling error.",
            ),
            Block::Figure(chart(sheet)),
            heading("The protocol"),
            Block::List(rules(sheet)),
            heading("Scored stack"),
            Block::Table(inputs(sheet)),
        ],
        provenance: vec![
            ("protocol".into(), protocol.name.clone()),
            ("scenario fingerprint".into(), fingerprint(&sheet.scenario)),
            ("runs".into(), sheet.rows.iter().map(|row| row.runs).sum::<usize>().to_string()),
            ("seed".into(), protocol.seed.to_string()),
            ("program".into(), format!("barrelstack {}", env!("CARGO_PKG_VERSION"))),
        ],
        warnings: warnings(sheet),
        words: barrelstack::report::WORDS.to_vec(),
        ..Document::default()
    }
}

/// Entry of a plot of scores: its name, the score (cm/s), and the range of the score over the uncertain constants
/// (cm/s).
pub(super) type OnScale = (String, u32, Option<[u32; 2]>);

/// Scores of the racks of the catalog, from `validation/league`, without devices.
const REFERENCES: &str = include_str!("references.csv");

/// Returns the scores of the catalog's racks, for comparison with scores from two-dimensional runs.
pub(super) fn references() -> Vec<OnScale> {
    let row = |line: &str| {
        let mut cells = line.split(',');
        let name = cells.next()?.to_owned();
        let mut whole = || cells.next()?.parse().ok();
        let (score, low, high) = (whole()?, whole(), whole());
        Some((name, score, low.zip(high).map(|(low, high)| [low, high])))
    };
    REFERENCES.lines().skip(1).filter_map(row).collect()
}

/// Draws the score on a scale, beside the scores of the catalog's racks if these were computed with the same protocol.
fn scale_of(sheet: &Sheet) -> Figure {
    let own = (format!("this stack: {}", scored(sheet)), sheet.score(), sheet.range());
    let known = sheet.protocol.name.split(',').next() == Some(Protocol::rockscore().name.as_str());
    let others = if known { references() } else { Vec::new() };
    let caption = if known {
        "The score of this stack, and the scores of the catalog's racks without devices. The scores of the catalog \
         come from 8 of the 24 motions of the protocol: the pulses with periods of 0.5 s and 2.7 s, both components \
         of South Napa 2014, and 4 synthetic motions."
    } else {
        "The score of this stack."
    };
    let mut rows: Vec<OnScale> = std::iter::once(own).chain(others).collect();
    rows.sort_by_key(|(_, score, _)| std::cmp::Reverse(*score));
    scale(caption, &rows)
}

/// Draws scores on a scale, each with its range over the uncertain constants.
pub(super) fn scale(caption: &str, rows: &[OnScale]) -> Figure {
    let ranges = rows.iter().enumerate();
    let ranges =
        ranges.filter_map(|(row, (_, _, range))| Some((row, range.map(|r| r.map(f64::from))?)));
    let bars = Series::bars("range over the uncertain constants", ranges);
    let scored = rows.iter().enumerate();
    let (x, y) = scored.map(|(row, (_, score, _))| (f64::from(*score), Axis::row(row))).unzip();
    let mut scores = Series::new("score", x, y);
    scores.style = SeriesStyle { points: true, index: Some(1), ..SeriesStyle::default() };
    Figure::new(
        "scale",
        caption,
        Plot {
            x: Axis::new("RockScore", "cm/s"),
            y: Axis::named(rows.iter().map(|(name, ..)| name.clone()).collect()),
            series: [bars, scores].into_iter().filter(|one| !one.x.is_empty()).collect(),
            ..Plot::default()
        },
    )
}

/// Describes the scored rack and devices, such as "two-barrel racks with chocks and straps".
fn scored(sheet: &Sheet) -> String {
    let Some(stack) = sheet.scenario.stack() else { return sheet.scenario.title.clone() };
    let devices: Vec<&str> = stack.devices.present().iter().map(|words| words.many).collect();
    let with = if devices.is_empty() { "" } else { " with " };
    format!("{} racks{with}{}", stack.rack.base, devices.join(" and "))
}

/// Formats a velocity (m/s) in whole cm/s.
fn shown(velocity: f64) -> String {
    format!("{:.0}", 100.0 * velocity)
}

/// Returns a sentence on stacks that fall under their own weight; empty if there are none.
fn by_themselves(sheet: &Sheet) -> String {
    let sum = |of: fn(&Scored) -> usize| sheet.rows.iter().map(of).sum();
    fallen_at_rest(sum(|row| row.fallen_at_rest), sum(|row| row.runs), "runs")
}

fn headline(sheet: &Sheet) -> String {
    let Some(weakest) = sheet.weakest() else { return "Nothing was run.".to_owned() };
    let score = sheet.score();
    let stacks = format!("stacks of {} levels on {}", sheet.protocol.levels, scored(sheet));
    let direction = weakest.direction.words();
    match weakest.capacity {
        Capacity::Fitted(..) | Capacity::Between(..) => format!(
            "RockScore {score}: shaken {direction} at up to {score} cm/s, nine in ten {stacks} stand."
        ),
        Capacity::Above(_) => format!(
            "RockScore of at least {score}: under the strongest shaking of the protocol, nine in ten {stacks} stand."
        ),
        Capacity::Below(lowest) => format!(
            "RockScore 0: more than one in ten {stacks} collapse when shaken {direction} at {} cm/s, the \
             weakest shaking of the protocol.",
            shown(lowest)
        ),
    }
}

fn sentences(sheet: &Sheet) -> Vec<String> {
    let Some(weakest) = sheet.weakest() else { return Vec::new() };
    let mut said = vec![format!(
        "Weakest state and direction: {}, shaken {}.",
        weakest.state.name,
        weakest.direction.words()
    )];
    said.extend(over_constants(sheet));
    let new = sheet.rows.iter().filter(|row| row.state == sheet.rows[0].state);
    let new: Vec<String> =
        new.map(|row| format!("{} {}", bears(row.capacity), row.direction.words())).collect();
    said.push(format!(
        "For stacks in new condition, the velocity at which one stack in ten collapses is {}.",
        new.join(", ")
    ));
    said
}

/// Describes the range of the score over the uncertain constants, and names the decisive constant.
fn over_constants(sheet: &Sheet) -> Option<String> {
    let [low, high] = sheet.range().filter(|_| !sheet.draws().is_empty())?;
    let decides = sheet.decisive().map(|one| {
        let at = |at: &ShareAt| format!("{} at {}", percent(at.share), one.words(at.value));
        let ends = one.low_median_high().map_or_else(String::new, |[from, _, to]| {
            format!(
                ": in shaking of {} cm/s, the share of stacks that collapse is {} and {}",
                sheet.score().max(1),
                at(from),
                at(to)
            )
        });
        format!("; it depends most on the {}{ends}", one.name)
    });
    Some(format!(
        "Allowing for the uncertain friction, stiffness and damping of the seats, the score is between {low} and {high} with \
         a probability of 95 %{}.",
        decides.unwrap_or_else(|| "; none of these constants alone decides the score".to_owned())
    ))
}

/// Formats a capacity as a velocity, such as "42 cm/s", or as a range of velocities.
fn bears(capacity: Capacity) -> String {
    match capacity {
        Capacity::Fitted(at, _) => format!("{} cm/s", shown(at)),
        Capacity::Between(above, below) => format!("{} to {} cm/s", shown(above), shown(below)),
        Capacity::Above(highest) => format!("above {} cm/s", shown(highest)),
        Capacity::Below(lowest) => format!("below {} cm/s", shown(lowest)),
    }
}

fn table(sheet: &Sheet) -> Table {
    let velocities = &sheet.protocol.velocities;
    let heads: Vec<String> = velocities.iter().map(|v| format!("at {} cm/s", shown(*v))).collect();
    let mut columns = vec![
        ("state", ""),
        ("shaken", ""),
        ("one stack in ten collapses at", ""),
        ("range over the uncertain constants", "cm/s"),
    ];
    columns.extend(heads.iter().map(|head| (head.as_str(), "")));
    let mut table = Table::new(
        "Velocity at which one stack in ten collapses, in every state and direction, and the share of stacks \
         that collapse at every level of shaking.",
        &columns,
    );
    let weakest = sheet.weakest();
    for row in &sheet.rows {
        let interval = row.capacity.interval();
        let interval = interval.map(|of| format!(" ({}–{})", shown(of.low), shown(of.high)));
        let bears = bears(row.capacity) + &interval.unwrap_or_default();
        let is_weakest = weakest.is_some_and(|weakest| std::ptr::eq(weakest, row));
        let mut cells = vec![
            Cell::text(row.state.name.clone()),
            Cell::text(row.direction.words()),
            if is_weakest { Cell::Rated(Rating::Poor, bears) } else { Cell::text(bears) },
            Cell::maybe(row.range().map(|of| over(&of, protocol_ends(sheet)))),
        ];
        cells.extend(velocities.iter().map(|velocity| {
            Cell::maybe(row.at(*velocity).map(|stripe| percent(stripe.fraction())))
        }));
        table.rows.push(cells);
    }
    table
}

/// Returns the lowest and the highest level of the protocol (m/s).
fn protocol_ends(sheet: &Sheet) -> [f64; 2] {
    let velocities = &sheet.protocol.velocities;
    [velocities.first(), velocities.last()].map(|end| end.copied().unwrap_or(0.0))
}

/// Formats a range of velocities; an end beyond the levels of the protocol is shown as "below" the lowest level or
/// "above" the highest level.
fn over(of: &Interval, [lowest, highest]: [f64; 2]) -> String {
    let low = if of.low < lowest { format!("below {}", shown(lowest)) } else { shown(of.low) };
    let high =
        if of.high >= highest { format!("above {}", shown(highest)) } else { shown(of.high) };
    format!("{low} to {high}")
}

fn chart(sheet: &Sheet) -> Figure {
    let label = |row: &Scored| format!("{}, {}", row.state.name, row.direction.words());
    let series = sheet.rows.iter().enumerate().map(|(index, row)| {
        fitted(&row.curve, 100.0, &label(row))
            .unwrap_or_else(|| raw(&row.curve, 100.0, &label(row), index))
    });
    Figure::new(
        "rockscore",
        "Chance of collapse against peak ground velocity. Lines are fitted curves; where no curve can be fitted to the \
         runs, dots show the shares with their 95 % intervals.",
        Plot {
            x: Axis::new("peak ground velocity", "cm/s"),
            y: chance_axis("chance of collapse"),
            series: series.collect(),
            ..Plot::default()
        },
    )
}

fn inputs(sheet: &Sheet) -> Table {
    let settings = sheet.scenario.settings().into_iter();
    Table::of(
        "Inputs that differ from their defaults. Quantities are in SI units.",
        settings.filter(|setting| setting.source == Source::Given),
        &[
            ("input", "", &|setting| Cell::verbatim(&setting.path)),
            ("value", "", &|setting| Cell::verbatim(&setting.value)),
            ("meaning", "", &|setting| Cell::text(setting.help)),
        ],
    )
}

pub(super) fn rules(sheet: &Sheet) -> Vec<String> {
    let protocol = &sheet.protocol;
    let list = |values: &[f64], scale: f64| {
        let words: Vec<String> =
            values.iter().map(|value| format!("{}", (scale * value * 1e6).round() / 1e6)).collect();
        words.join(", ")
    };
    let mut rules = vec![
        format!(
            "The stack: {} levels on the rack that is scored, with its barrels, interfaces and devices. The stack \
             stands on level ground and is shaken {}.",
            protocol.levels,
            if sheet.rows.iter().any(|row| row.direction == Direction::Space) {
                "in three dimensions; the horizontal direction of the motion is drawn for every run"
            } else {
                "across the barrels and along them"
            }
        ),
        format!(
            "The motions: {} velocity pulses of Mavroeidis and Papageorgiou (2003; γ 1.5, phase 90°) with periods of \
             {} s, both components of South Napa 2014 at Napa College with the vertical component, and {} synthetic \
             motions (half of them M 6 at 8 km, a quarter M 7 at 20 km, a quarter with near-fault pulses), each \
             scaled to peak ground velocities of {} cm/s.",
            protocol.periods.len(),
            list(&protocol.periods, 1.0),
            protocol.synthetic,
            list(&protocol.velocities, 100.0)
        ),
        "Friction, stiffness and damping of the seats are drawn for every run around the values in the scenario, with \
         the dispersions of the scenario; the same quantiles and the same motions are used for all racks."
            .into(),
        "States: as good as new; wet cradles, with a friction coefficient of 0.2 between barrels and racks; and each \
         device in worn condition, one at a time."
            .into(),
        "Collapse: a barrel or a rack loses its seat. A run ends 2 s after the collapse; if the stack does not \
         collapse, the run ends when all bodies are at rest and the ground acceleration stays below 0.02 g."
            .into(),
        "A protocol never changes; any change requires a new version number.".into(),
    ];
    if sheet.stated_levels != protocol.levels {
        let stated = format!(
            "The scenario states {} levels, which the protocol replaces by {}.",
            sheet.stated_levels, protocol.levels
        );
        rules.insert(1, stated);
    }
    rules
}

fn warnings(sheet: &Sheet) -> Vec<String> {
    let sum = |of: fn(&Scored) -> usize| sheet.rows.iter().map(of).sum();
    left_out(sum(|row| row.left_out), sum(|row| row.runs)).into_iter().collect()
}
