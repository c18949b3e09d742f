//! Report sections of a stack in both planes and in all its variants.

use std::sync::Arc;

use barrelstack_report::{
    Block, Cell, History, Pane, Player, Players, Scene, Table, Tone, capital,
};

use super::{drawing, sections, tone, words};
use crate::assemble::Assembly;
use crate::run::Run;
use crate::scenario::View;
use crate::summary::Summary;
use crate::variants::words::percent;
use crate::variants::{Range, Shown, Spread};

/// Returns synchronized players for both planes, the plane across the barrels first.
pub(super) fn players(
    (run, summary, scene): (&Run, &Summary, &Arc<Scene>),
    other: &Shown,
) -> Players {
    let pane = |run: &Run, summary: &Summary, scene: Arc<Scene>| {
        let alone = Summary { ensemble: None, other_plane: None, ..summary.clone() };
        let verdict = words::alone(run, summary);
        Pane {
            tone: tone(run, &alone),
            traces: sections::traces(run),
            verdict,
            ..of(&run.assembly, scene)
        }
    };
    let mut both = [
        pane(run, summary, Arc::clone(scene)),
        pane(&other.run, &other.summary, drawing::scene_among(&other.run, other.variants.as_ref())),
    ];
    let mut runs = [run, &other.run];
    if run.assembly.view == Some(View::Longitudinal) {
        both.reverse();
        runs.reverse();
    }
    Players {
        id: "players".into(),
        caption: format!(
            "The computed motion of the stack, across and along its barrels, at the same times and to the same scale. \
             Arrows show contact forces, each drawn on the body that the force pushes up.{}",
            drawing::legend(scene)
        ),
        panes: both.into(),
        overlay: None,
        ground: runs.into_iter().filter_map(ground).collect(),
    }
}

/// Draws the stack as assembled, in each plane, for a page that does not show a run yet.
pub(super) fn still(assemblies: &[Assembly]) -> Block {
    let caption = "The stack before the motion, to scale.".to_owned();
    if let [alone] = assemblies {
        let scene = Arc::new(drawing::still(alone));
        return Block::Player(Player { id: "player".into(), caption, scene, traces: Vec::new() });
    }
    let pane = |assembly: &Assembly| of(assembly, Arc::new(drawing::still(assembly)));
    Block::Players(Players {
        id: "players".into(),
        caption,
        panes: assemblies.iter().map(pane).collect(),
        overlay: None,
        ground: Vec::new(),
    })
}

/// Returns the pane of a plane, without a verdict. Its mark is X for the plane across the barrels, and Y for the plane
/// along the barrels.
fn of(assembly: &Assembly, scene: Arc<Scene>) -> Pane {
    let (mark, name) = match assembly.view {
        Some(view @ View::Transverse) => ("X", capital(view.words())),
        Some(view @ View::Longitudinal) => ("Y", capital(view.words())),
        None => ("", String::new()),
    };
    let (verdict, tone, traces) = (String::new(), Tone::Neutral, Vec::new());
    Pane { mark: mark.to_owned(), name, verdict, tone, scene, traces }
}

/// Returns the ground acceleration of a run, labeled with its plane; `None` if there is no motion or no plane.
fn ground(run: &Run) -> Option<History> {
    let first = drawing::ground_histories(run).into_iter().next()?;
    let view = run.assembly.view?;
    Some(History { label: format!("{}, {}", first.label, view.words()), ..first })
}

/// Text that explains which variants the ranges of results include.
pub const RANGES: &str = "Ranges span the 5th to the 95th percentile of the variants. The times of the first loss of \
                          a seat are those of all variants that collapse while they are shaken. The times of the \
                          first fall are only those of variants in which a barrel falls, so their range may start or \
                          end earlier than the range of the first loss of a seat.";

/// Tabulates the statistics of all variants, with one column per plane.
pub(super) fn variants(summary: &Summary) -> Vec<Block> {
    let planes = summary.spreads();
    if planes.is_empty() {
        return Vec::new();
    }
    let noun = if planes.len() > 1 { "barrels in this plane" } else { "barrels" };
    let mut table = Table::new(RANGES, &[("", "")]);
    table.columns.extend(
        planes.iter().map(|(view, _)| barrelstack_report::Column::new(capital(view.words()), "")),
    );
    let mut row = |name: &str, cell: &dyn Fn(&Spread) -> Option<String>| {
        let cells: Vec<Option<String>> = planes.iter().map(|(_, spread)| cell(spread)).collect();
        if cells.iter().any(Option::is_some) {
            let shown = cells.into_iter().map(Cell::maybe);
            table.rows.push(std::iter::once(Cell::text(name)).chain(shown).collect());
        }
    };
    row("variants with a verdict", &|spread| Some(spread.variants.to_string()));
    row("variants that collapse", &|spread| Some(spread.collapsed.to_string()));
    row("share of variants that collapse, with its 95 % interval", &|spread| {
        let [low, high] = spread.interval.map(percent);
        spread.share.map(|share| format!("{} ({low} to {high})", percent(share)))
    });
    row("range of this share over the uncertain constants", &|spread| {
        let [low, high] = spread.range?.map(percent);
        Some(format!("{low} to {high}"))
    });
    row("first loss of a seat", &|spread| {
        spread.first_loss.map(|first| {
            let [most, all] = spans(&first, 1);
            format!("{most} s{}", over_all(&most, &all, " s"))
        })
    });
    row("first fall", &|spread| {
        spread.first_fall.map(|first| {
            let [most, all] = spans(&first, 1);
            let time = format!("{most} s{}", over_all(&most, &all, " s"));
            let counted = spread.counted("the first loss of a seat");
            if counted.is_empty() {
                time
            } else {
                format!("{time}; only falls{counted} are counted")
            }
        })
    });
    row("barrels fallen in a collapse", &|spread| {
        spread.barrels_fallen.map(|fallen| {
            let [most, all] = spans(&fallen, 0);
            let counted = spread.counted("the first loss of a seat");
            format!(
                "{most} of {} {noun} fall{counted}{}",
                spread.barrels,
                over_all(&most, &all, "")
            )
        })
    });
    row("collapses by mode", &|spread| {
        let modes = spread.modes.iter().map(|(mode, count)| format!("{mode} {count}"));
        Some(modes.collect::<Vec<_>>().join(", ")).filter(|text| !text.is_empty())
    });
    row("fallen under their own weight, before they are shaken", &|spread| {
        (spread.cannot_stand > 0).then(|| spread.cannot_stand.to_string())
    });
    row("variants without a verdict", &|spread| {
        (spread.broken > 0).then(|| spread.broken.to_string())
    });
    let number = |number: u32| if number == 0 { "as stated".into() } else { number.to_string() };
    row("most typical variant", &|spread| Some(number(spread.typical)));
    row("gentlest variant", &|spread| Some(number(spread.gentlest)));
    row("worst variant", &|spread| Some(number(spread.worst)));
    let mut blocks = vec![Block::Table(table)];
    blocks.extend(planes.iter().find_map(|(_, spread)| spread.reason.as_ref()).map(|reason| {
        Block::Paragraph(format!(
            "The first variant that falls before it is shaken, or that has no verdict, gives this reason: {reason}."
        ))
    }));
    blocks
}

/// Formats the central range and the whole range of a result over the variants that have this result.
fn spans(range: &Range, decimals: usize) -> [String; 2] {
    let Range { p05, p95, least, most, .. } = *range;
    [span(p05, p95, decimals), span(least, most, decimals)]
}

/// Returns the whole range of a result in parentheses; empty if it equals the central range that is shown before it.
fn over_all(central: &str, whole: &str, unit: &str) -> String {
    if central == whole {
        String::new()
    } else {
        format!(" (over all of these variants: {whole}{unit})")
    }
}

/// Formats a range, or a single number if both ends are equal when rounded.
fn span(from: f64, to: f64, decimals: usize) -> String {
    let [from, to] = [from, to].map(|value| format!("{value:.decimals$}"));
    if from == to { from } else { format!("{from} to {to}") }
}
