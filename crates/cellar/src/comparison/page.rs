//! The page, the tables and the files of a comparison of layouts.

use barrelstack::compare::inputs;
use barrelstack::report::WORDS;
use barrelstack::scenario::title::without_changed;
use barrelstack::variants::FEW;
use barrelstack::variants::words::percent;
use barrelstack_report::{
    Block, Cell, Document, Figure, Table, Verdict, capital, described, listed, measured,
};

use super::words::{amount, estimate, sentences};
use super::{CellarComparison, Change, Estimate, Layout, LayoutAnswer, LayoutPair, LeftOut};
use crate::plan::liters;
use crate::sample::CELL;
use crate::words::span;

/// Number of supporting sentences that are always shown below the headline; the others are collapsed on screen.
const OPENING: usize = 3;

/// A row of a table: a layout with its comparison to the first one, or a change that was not run.
enum Row<'a> {
    Run(&'a LayoutAnswer, Option<&'a LayoutPair>),
    LeftOut(&'a LeftOut),
}

impl Row<'_> {
    fn name(&self) -> Cell {
        Cell::text(match self {
            Self::Run(one, _) => &one.name,
            Self::LeftOut(one) => &one.name,
        })
    }

    /// Calls `cell` if the row is a layout with a valid result; returns `Cell::Missing` for all other rows.
    fn of(&self, cell: impl FnOnce(&LayoutAnswer) -> Cell) -> Cell {
        match self {
            Self::Run(one, _) if one.counted > 0 => cell(one),
            Self::Run(..) | Self::LeftOut(_) => Cell::Missing,
        }
    }

    /// Calls `cell` if some variants of the layout are compared with the first layout; returns `Cell::Missing` for all
    /// other rows.
    fn paired(&self, cell: impl FnOnce(&LayoutPair) -> Cell) -> Cell {
        match self {
            Self::Run(_, Some(pair)) if pair.variants > 0 => cell(pair),
            Self::Run(..) | Self::LeftOut(_) => Cell::Missing,
        }
    }

    /// Returns a cell with the reason why there is no result; the text is empty if there is a result.
    fn reason(&self) -> Cell {
        match self {
            Self::Run(one, _) if one.counted > 0 => Cell::text(""),
            Self::Run(..) => Cell::text("no run has a valid result"),
            Self::LeftOut(one) => Cell::text(format!("not run: {}", one.reason)),
        }
    }
}

/// Returns the layouts, sorted by the share of barrels that fall, followed by the changes that were not run.
fn rows(found: &CellarComparison) -> Vec<Row<'_>> {
    let run = found.ranked().into_iter().map(|(one, pair)| Row::Run(one, pair));
    run.chain(found.left_out.iter().map(Row::LeftOut)).collect()
}

/// Formats the difference between two layouts, multiplied by `scale`, with its sign and its confidence interval.
fn change(change: &Change, scale: f64) -> Cell {
    let signed = |value: f64| match amount(value.abs()) {
        none if none == "0" => none,
        some => format!("{}{some}", if value < 0.0 { "−" } else { "+" }),
    };
    let difference = signed(scale * change.difference);
    Cell::text(change.interval.map_or_else(
        || difference.clone(),
        |[low, high]| format!("{difference} ({} to {})", signed(scale * low), signed(scale * high)),
    ))
}

/// Returns the table of losses against capacity. The layouts are sorted by the share of barrels that fall.
pub fn table(found: &CellarComparison) -> Table {
    Table::of(
        "Loss against capacity; the layouts are sorted by the share of barrels that fall. Means over the variants, \
         with their 95 % intervals; differences from the first layout are computed variant by variant. The columns \
         “wine lost” and “cost” give expected losses, under the central assumption about how many fallen barrels \
         burst.",
        rows(found),
        &[
            ("layout", "", &Row::name),
            ("barrels", "", &|row| row.of(|one| Cell::text(one.capacity.to_string()))),
            ("fall", "", &|row| row.of(|one| Cell::text(estimate(&one.barrels_fallen)))),
            ("difference", "", &|row| row.paired(|pair| change(&pair.barrels_fallen, 1.0))),
            ("share", "", &|row| row.of(|one| Cell::text(percent(one.share_lost.mean)))),
            ("difference", "points", &|row| row.paired(|pair| change(&pair.share_lost, 100.0))),
            ("wine lost", "", &|row| row.of(|one| Cell::text(liters(one.wine_lost)))),
            ("cost", "US$", &|row| {
                row.of(|one| Cell::text(one.cost.map(|dollars| measured(dollars, 0)).join(" to ")))
            }),
            ("result", "", &Row::reason),
        ],
    )
}

/// Returns the table of how the stacks fall and what they block.
fn courses(found: &CellarComparison) -> Table {
    let blocked = |one: &LayoutAnswer| {
        let of = |aisle: &crate::summary::AisleAnswer| {
            Some(format!("{} {}", aisle.name, percent(aisle.blocked.share?)))
        };
        Cell::text(one.aisles.iter().filter_map(of).collect::<Vec<_>>().join(", "))
    };
    let first = |one: &LayoutAnswer| {
        let entered = one.aisles.iter().map(|aisle| aisle.entered.of_variants).max().unwrap_or(0);
        Cell::maybe(one.first_barrel.as_ref().map(|range| span(range, entered, 1, "s")))
    };
    Table::of(
        format!(
            "How the stacks fall: means over the variants with their 95 % intervals. Spread: number of stacks that \
             fall, divided by the number that fall by themselves. Aisles: share of the variants in which an aisle \
             is blocked at the end. The time at which the first barrel enters an aisle is counted from the start of \
             the shaking; its range spans the 5th to the 95th percentile of the variants in which a barrel enters an \
             aisle, or all of them if there are fewer than {FEW}. Impact forces last a few milliseconds and grow with the assumed stiffness of the contact."
        ),
        rows(found),
        &[
            ("layout", "", &Row::name),
            ("stacks", "", &|row| row.of(|one| Cell::text(one.stacks.to_string()))),
            ("fall by themselves", "", &|row| {
                row.of(|one| Cell::text(estimate(&one.by_themselves)))
            }),
            ("difference", "", &|row| row.paired(|pair| change(&pair.by_themselves, 1.0))),
            ("knocked over", "", &|row| row.of(|one| Cell::text(estimate(&one.knocked_over)))),
            ("difference", "", &|row| row.paired(|pair| change(&pair.knocked_over, 1.0))),
            ("spread", "", &|row| row.of(|one| Cell::measured(one.spread, 1))),
            ("aisles blocked", "", &|row| row.of(blocked)),
            ("first barrel in an aisle", "", &|row| row.of(first)),
            ("largest force on a wall or column", "kN", &|row| {
                row.of(|one| Cell::measured(one.peak_force.map(|force| 1e-3 * force), 0))
            }),
        ],
    )
}

/// Returns the machine-readable table of all layouts, with one number in each cell.
pub fn csv(found: &CellarComparison) -> Table {
    let number = |value: f64| Cell::Number(value, 6);
    let count = |value: u32| number(f64::from(value));
    let bound =
        |both: Option<[f64; 2]>, which: usize| Cell::number(both.map(|both| both[which]), 6);
    let of = |row: &Row<'_>, of: fn(&LayoutAnswer) -> &Estimate, which: usize| {
        row.of(|one| match which {
            0 => number(of(one).mean),
            which => bound(of(one).interval, which - 1),
        })
    };
    let pair = |row: &Row<'_>, of: fn(&LayoutPair) -> &Change, which: usize| {
        row.paired(|pair| match which {
            0 => number(of(pair).difference),
            which => bound(of(pair).interval, which - 1),
        })
    };
    Table::of(
        "",
        rows(found),
        &[
            ("layout", "", &Row::name),
            ("capacity", "barrels", &|row| row.of(|one| number(one.capacity as f64))),
            ("stacks", "", &|row| row.of(|one| number(one.stacks as f64))),
            ("variants", "", &|row| row.of(|one| count(one.counted))),
            ("fall by themselves", "stacks", &|row| of(row, |one| &one.by_themselves, 0)),
            ("fall by themselves low", "stacks", &|row| of(row, |one| &one.by_themselves, 1)),
            ("fall by themselves high", "stacks", &|row| of(row, |one| &one.by_themselves, 2)),
            ("knocked over", "stacks", &|row| of(row, |one| &one.knocked_over, 0)),
            ("knocked over low", "stacks", &|row| of(row, |one| &one.knocked_over, 1)),
            ("knocked over high", "stacks", &|row| of(row, |one| &one.knocked_over, 2)),
            ("spread", "1", &|row| row.of(|one| Cell::number(one.spread, 6))),
            ("barrels fallen", "1", &|row| of(row, |one| &one.barrels_fallen, 0)),
            ("barrels fallen low", "1", &|row| of(row, |one| &one.barrels_fallen, 1)),
            ("barrels fallen high", "1", &|row| of(row, |one| &one.barrels_fallen, 2)),
            ("share lost", "1", &|row| of(row, |one| &one.share_lost, 0)),
            ("wine lost", "m3", &|row| row.of(|one| number(one.wine_lost))),
            ("cost low", "US$", &|row| row.of(|one| number(one.cost[0]))),
            ("cost high", "US$", &|row| row.of(|one| number(one.cost[1]))),
            ("share with a blocked aisle", "1", &|row| {
                row.of(|one| Cell::number(one.some_blocked.and_then(|count| count.share), 6))
            }),
            ("median of the first barrel in an aisle", "s", &|row| {
                row.of(|one| Cell::number(one.first_barrel.map(|range| range.p50), 6))
            }),
            ("largest force", "N", &|row| row.of(|one| Cell::number(one.peak_force, 6))),
            ("pairs", "", &|row| row.paired(|pair| count(pair.variants))),
            ("difference of barrels", "1", &|row| pair(row, |pair| &pair.barrels_fallen, 0)),
            ("difference of barrels low", "1", &|row| pair(row, |pair| &pair.barrels_fallen, 1)),
            ("difference of barrels high", "1", &|row| pair(row, |pair| &pair.barrels_fallen, 2)),
            ("difference of share", "1", &|row| pair(row, |pair| &pair.share_lost, 0)),
            ("difference of share low", "1", &|row| pair(row, |pair| &pair.share_lost, 1)),
            ("difference of share high", "1", &|row| pair(row, |pair| &pair.share_lost, 2)),
            ("result", "", &Row::reason),
        ],
    )
}

/// Builds the comparison of layouts as a document that is independent of any output format.
pub fn document(layouts: &[Layout], found: &CellarComparison) -> Document {
    let heading = |text: &str| Block::heading(2, text);
    let mut blocks = vec![
        heading("Loss against capacity"),
        Block::Table(table(found)),
        heading("How the stacks fall"),
        Block::Table(courses(found)),
        heading("Where the barrels end up"),
    ];
    blocks.extend(layouts.iter().enumerate().map(|(at, layout)| {
        let caption = format!(
            "{} from above. The color of a stack shows what happens to it in the most typical run. The shades show \
             the share of the variants in which fallen barrels cover the floor at the end, in cells of {CELL} m.",
            capital(&layout.name)
        );
        Block::Figure(Figure::new(format!("plan-{}", at + 1), caption, layout.picture.clone()))
    }));
    if !found.differences.is_empty() {
        let names: Vec<String> = layouts.iter().map(|layout| layout.name.clone()).collect();
        blocks.push(heading("Differences"));
        blocks.push(Block::Table(inputs(&names, &found.differences)));
    }
    let mut opening = sentences(found);
    let fine = opening.split_off(OPENING.min(opening.len()));
    Document {
        title: title(layouts),
        verdict: Verdict {
            headline: found.headline.clone(),
            sentences: opening,
            fine,
            ..Verdict::default()
        },
        blocks,
        provenance: provenance(layouts, found),
        words: WORDS.to_vec(),
        warnings: found.warnings.clone(),
        ..Document::default()
    }
}

/// Returns the names of the layouts, followed by the title of the cellar if all layouts are changes of the same cellar.
fn title(layouts: &[Layout]) -> String {
    let names = format!("Comparison of {}", listed(layouts.iter().map(|one| one.name.clone())));
    let title = |one: &Layout| without_changed(&one.cellar.title).to_owned();
    let first = layouts.first().map(title);
    match first.filter(|first| layouts.iter().all(|one| title(one) == *first)) {
        Some(title) => format!("{names}: {title}"),
        None => names,
    }
}

fn provenance(layouts: &[Layout], found: &CellarComparison) -> Vec<(String, String)> {
    let mut pairs = vec![("program".to_owned(), format!("{} {}", found.program, found.version))];
    let cellar = |one: &LayoutAnswer| (format!("cellar of {}", one.name), one.cellar_hash.clone());
    pairs.extend(found.layouts.iter().map(cellar));
    for step in layouts.iter().flat_map(|layout| &layout.summary.provenance) {
        let pair = ("motion".to_owned(), step.clone());
        if !pairs.contains(&pair) {
            pairs.push(pair);
        }
    }
    pairs
}

/// Returns the name and the contents of each output file of a comparison, except its page.
///
/// # Errors
/// If the document cannot be written as JSON.
pub fn files(found: &CellarComparison) -> Result<Vec<(String, Vec<u8>)>, serde_json::Error> {
    let json = described::to_json(found)? + "\n";
    Ok(vec![
        ("layouts.csv".to_owned(), csv(found).to_csv().into_bytes()),
        ("comparison.json".to_owned(), json.into_bytes()),
    ])
}
