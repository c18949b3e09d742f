//! Report page of a ranking of protections.

use barrelstack_fragility::Interval;
use barrelstack_report::{
    Axis, Block, Cell, Document, Figure, Plot, Series, SeriesStyle, Table, Verdict, capital,
    listed, significant,
};

use super::{Estimate, Kind, Ranked, Ranking, Shaking};
use crate::decision::{fallen_at_rest, fingerprint, heading, left_out, percent, points, text};

pub(super) fn document(all: &Ranking, before_and_after: Vec<Block>) -> Document {
    let mut blocks = before_and_after;
    blocks.push(heading("Comparison of the protections"));
    blocks.push(Block::Figure(chart(all)));
    blocks.push(Block::Table(table(all)));
    blocks.push(text(legend(all)));
    blocks.push(heading("How to try a protection"));
    blocks.push(Block::Table(changes(all)));
    if !all.not_tried.is_empty() {
        blocks.push(heading("Protections that were not tried"));
        let row = |(name, reason): &(String, String)| format!("{name}: {reason}");
        blocks.push(Block::List(all.not_tried.iter().map(row).collect()));
    }
    blocks.push(heading("Basis and limits"));
    blocks.push(Block::List(rests_on(all)));
    Document {
        title: format!("What protects best: {}", all.request.scenario.title),
        verdict: Verdict {
            headline: by_themselves(all) + &headline(all),
            sentences: sentences(all),
            ..Verdict::default()
        },
        blocks,
        provenance: vec![
            ("scenario fingerprint".into(), fingerprint(&all.request.scenario)),
            ("protections tried (not counting the stack as it is)".into(), all.tries().to_string()),
            ("runs".into(), all.runs.to_string()),
            ("seed".into(), all.request.seed.to_string()),
            ("program".into(), format!("barrelstack {}", env!("CARGO_PKG_VERSION"))),
        ],
        warnings: warnings(all),
        words: barrelstack::report::WORDS.to_vec(),
        ..Document::default()
    }
}

/// Returns a phrase that states what the estimates refer to, such as "per year at this site" or "in shaking of 25, 50,
/// 75 cm/s".
fn per(all: &Ranking) -> String {
    match &all.request.shaking {
        Shaking::Site(_) => "per year at this site".to_owned(),
        Shaking::Levels(levels) => {
            let shown: Vec<String> = levels
                .iter()
                .map(|v| significant(100.0 * v, 3).trim_end_matches(".0").to_owned())
                .collect();
            format!("in shaking of {} cm/s", listed(&shown))
        }
    }
}

fn is_site(all: &Ranking) -> bool {
    matches!(all.request.shaking, Shaking::Site(_))
}

/// Formats a probability of collapse, or an annual rate of collapse for a site.
fn collapse(all: &Ranking, value: f64) -> String {
    if is_site(all) { format!("{} times a year", significant(value, 2)) } else { percent(value) }
}

/// Returns a sentence on runs in which the stack, unprotected or with the best protection, falls under its own weight;
/// empty if there are no such runs.
fn by_themselves(all: &Ranking) -> String {
    let of = |one: Option<&Ranked>, name: &str| {
        let said = one.map(|one| fallen_at_rest(one.fallen_at_rest, one.runs, "runs"));
        said.filter(|said| !said.is_empty())
            .map_or_else(String::new, |said| format!("{name}, {said}"))
    };
    let best = all.best();
    let name = best.map_or_else(String::new, |best| format!("With {}", best.protection.name));
    of(all.as_it_is(), "As it is") + &of(best, &name)
}

fn headline(all: &Ranking) -> String {
    let Some(base) = all.as_it_is() else { return "Nothing was tried.".to_owned() };
    if base.fallen.mean <= 0.0 {
        return format!(
            "{} stands as it is: no barrel falls {}.{}",
            capital(&stack(all)),
            per(all),
            known(all, base)
        );
    }
    let Some(best) = all.best() else {
        return "No protection that was tried helps significantly.".to_owned();
    };
    let shaken = |one: &Ranked| format!(", shaken {}", one.direction.words());
    let other = if best.direction == base.direction { String::new() } else { shaken(base) };
    format!(
        "The best protection for its cost: {}. With this protection, {} loses {} barrels on average {}{}; \
         without it, {}{other}.{}",
        best.protection.name,
        stack(all),
        significant(best.fallen.mean, 2),
        per(all),
        shaken(best),
        significant(base.fallen.mean, 2),
        known(all, best)
    )
}

/// Returns a sentence with the probability or rate of collapse, its upper bound, and the number of motions.
fn known(all: &Ranking, one: &Ranked) -> String {
    let (mean, high) = (one.collapse.mean, collapse(all, one.collapse.high));
    if mean <= 0.0 {
        return format!(
            " Under {} motions it never collapses; the true frequency of collapse is at most {high} \
             (95 % confidence).",
            one.motions
        );
    }
    let runs = if is_site(all) { "" } else { "with a probability of " };
    format!(
        " It collapses {runs}{} under {} motions; the upper bound is {high} (95 % confidence).",
        collapse(all, mean),
        one.motions
    )
}

/// Describes the stack, such as "a stack of 4 levels on two-barrel racks".
fn stack(all: &Ranking) -> String {
    let stack = all.request.scenario.stack();
    stack.map_or_else(
        || "the stack".to_owned(),
        |stack| format!("a stack of {} levels on {} racks", stack.levels, stack.rack.base),
    )
}

fn sentences(all: &Ranking) -> Vec<String> {
    let (Some(base), best) = (all.as_it_is(), all.best()) else { return Vec::new() };
    let mut said = Vec::new();
    if let Some((best, saved)) = best.and_then(|best| Some((best, best.saved_together?))) {
        let shown = |x: f64| significant(x, 2);
        said.push(format!(
            "On average, this protection keeps {} barrels from falling ({} to {} with 95 % confidence, simultaneously \
             for all {} protections that were tried). The mean for the best of many protections tends to be somewhat \
             too favorable.",
            shown(saved.mean),
            shown(saved.low),
            shown(saved.high),
            all.tries()
        ));
        said.push(format!(
            "This protection costs US${:.0} to {:.0} per stack; with it, the frequency of collapse is {} instead of \
             {}.",
            best.protection.cost[0],
            best.protection.cost[1],
            collapse(all, best.collapse.mean),
            collapse(all, base.collapse.mean)
        ));
        said.extend(order(all, best));
        if best.protection.moved > 0 {
            said.push(match best.protection.moved {
                1 => "1 barrel has to be stored elsewhere.".to_owned(),
                many => format!("{many} barrels have to be stored elsewhere."),
            });
        }
        if let Some((words, worn)) = &best.worn {
            said.push(format!(
                "With this protection in its worst state ({words}), {} barrels fall on average under the motions of \
                 the first round.",
                significant(worn.mean, 2)
            ));
        }
        if let Some(fewest) = all.all.first().filter(|one| one.protection != best.protection) {
            said.push(format!(
                "The fewest barrels, {} on average, fall with another protection: {}, which costs US${:.0} to {:.0} \
                 per stack.",
                significant(fewest.fallen.mean, 2),
                fewest.protection.name,
                fewest.protection.cost[0],
                fewest.protection.cost[1]
            ));
        }
    }
    said.push(format!(
        "{} protections were tried in {} runs, in both directions (across and along the barrels) if the scenario has \
         both.",
        all.tries(),
        all.runs
    ));
    said
}

/// Describes in what share of the draws of the uncertain constants the best protection is better than the unprotected
/// stack, and better than the next protection. Returns `None` if there are no draws.
fn order(all: &Ranking, best: &Ranked) -> Option<String> {
    let better = best.better_than_as_it_is?;
    let at = all.all.iter().position(|one| std::ptr::eq(one, best));
    let next = at.and_then(|at| all.all.get(at + 1)).zip(best.better_than_next);
    let next = next.filter(|(next, _)| next.protection.kind != Kind::AsItIs);
    let next = next.map_or_else(String::new, |(next, share)| {
        format!(
            "; in {}, fewer barrels fall than with the next protection in the ranking ({})",
            percent(share),
            next.protection.name
        )
    });
    Some(format!(
        "The friction, stiffness and damping of the seats are uncertain: in {} of the random draws of these \
         constants and of the sampling error, fewer barrels fall with this protection than without any{next}.",
        percent(better)
    ))
}

/// Formats a number of barrels with its interval. Numbers per event have two decimals. Numbers per year have
/// two significant digits, since they may be far below one.
fn interval(all: &Ranking, estimate: &Estimate) -> String {
    let shown = |x: f64| match format!("{x:.2}") {
        _ if is_site(all) => significant(x, 2),
        // A negative value that rounds to zero is shown without a sign.
        text if text == "-0.00" => "0.00".to_owned(),
        text => text,
    };
    format!("{} ({}–{})", shown(estimate.mean), shown(estimate.low), shown(estimate.high))
}

fn shares(estimate: &Estimate) -> String {
    let whole = |x: f64| format!("{:.0}", 100.0 * x);
    format!("{} % ({}–{})", whole(estimate.mean), whole(estimate.low), whole(estimate.high))
}

fn table(all: &Ranking) -> Table {
    let (collapses, fallen, burst) = if is_site(all) {
        ("collapses a year", "barrels fallen a year", "barrels burst a year")
    } else {
        ("collapse", "barrels fallen", "barrels burst")
    };
    let name = |one: &Ranked| match &one.protection.name {
        name if one.on_front => Cell::text(format!("• {name}")),
        name => Cell::text(name),
    };
    let cost = |one: &Ranked| {
        let [low, high] = one.protection.cost;
        if high > 0.0 { format!("{low:.0}–{high:.0}") } else { "0".to_owned() }
    };
    let collapse = |one: &Ranked| {
        if is_site(all) { interval(all, &one.collapse) } else { shares(&one.collapse) }
    };
    let over = |one: &Ranked| {
        one.range.map(|[low, high]| {
            if is_site(all) {
                format!("{} to {}", significant(low, 2), significant(high, 2))
            } else {
                format!("{:.0}–{:.0} %", 100.0 * low, 100.0 * high)
            }
        })
    };
    let shown = |saved: &Option<Estimate>| saved.as_ref().map(|saved| interval(all, saved));
    let worn = |one: &Ranked| {
        one.worn.as_ref().map(|(words, worn)| format!("{} {words}", interval(all, worn)))
    };
    Table::of(
        format!(
            "The stack as it is and all {} protections that were tried, with results {}; 95 % intervals in brackets.",
            all.tries(),
            per(all)
        ),
        &all.all,
        &[
            ("protection", "", &|one| name(one)),
            ("cost per stack", "US$", &|one| Cell::text(cost(one))),
            ("barrels stored elsewhere", "", &|one| Cell::text(one.protection.moved.to_string())),
            (collapses, "", &|one| Cell::text(collapse(one))),
            ("range over the uncertain constants", "", &|one| Cell::maybe(over(one))),
            (
                "draws of the constants in which fewer barrels fall than in the stack as it is",
                "",
                &|one| Cell::maybe(one.better_than_as_it_is.map(percent)),
            ),
            (
                "draws of the constants in which fewer barrels fall than in the next row",
                "",
                &|one| Cell::maybe(one.better_than_next.map(percent)),
            ),
            (fallen, "", &|one| Cell::text(interval(all, &one.fallen))),
            (burst, "", &|one| Cell::text(interval(all, &one.burst))),
            ("barrels saved, same motions", "", &|one| Cell::maybe(shown(&one.saved))),
            ("barrels saved, for all protections at once", "", &|one| {
                Cell::maybe(shown(&one.saved_together))
            }),
            ("barrels fallen in the worst state", "", &|one| Cell::maybe(worn(one))),
            ("weaker direction", "", &|one| Cell::text(one.direction.words())),
            ("motions", "", &|one| Cell::text(one.motions.to_string())),
        ],
    )
}

fn legend(all: &Ranking) -> String {
    format!(
        "•: any other protection that was run in all rounds and loses fewer barrels costs more. Protections with fewer \
         motions were dropped early: either a cheaper protection was significantly better, or half of the others were \
         better. \"Barrels saved\" is the number of barrels that a protection keeps from falling; runs with and \
         without the protection are compared in pairs under the same {}, which is more precise than the difference of \
         two means. The next column gives an interval that holds for all {} protections at once. This interval decides \
         whether a protection helps significantly, since the best of many protections tends to look better than it is. \
         All intervals allow for the small number of motions. Numbers are for the direction of shaking in which more \
         barrels fall. If the friction, stiffness and damping of a stack are drawn from their distributions, its \
         frequency of collapse lies within the range over the uncertain constants with a probability of 95 %. The \
         range includes the sampling error. Each draw of the constants applies to all protections; a protection is \
         better in a draw if fewer barrels fall with it. The draws do not change the number of barrels that fall in a \
         collapse: at each level of shaking, it is the mean over the collapses.",
        if all.request.records.is_empty() && all.request.folder.is_none() {
            "motions and friction"
        } else {
            "records and friction"
        },
        all.tries()
    )
}

/// Plots the number of fallen barrels against cost.
fn chart(all: &Ranking) -> Figure {
    let last = all.all.iter().map(|one| one.round).max();
    let fallen_at = |one: &&Ranked| one.fallen.mean;
    let mut front: Vec<&Ranked> =
        all.all.iter().filter(|one| one.on_front && Some(one.round) == last).collect();
    front.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    // The front is drawn with steps: a budget between the costs of two protections buys only the cheaper one.
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for (at, one) in front.iter().enumerate() {
        if let Some(before) = at.checked_sub(1).map(|before| &front[before]) {
            x.push(one.cost());
            y.push(fallen_at(before));
        }
        x.push(one.cost());
        y.push(fallen_at(one));
    }
    let style = SeriesStyle { index: Some(0), ..SeriesStyle::default() };
    let frontier =
        Series { style, ..Series::new("frontier: fewest fallen barrels for the cost", x, y) };
    let series = [(true, "best for their cost"), (false, "others")]
        .into_iter()
        .enumerate()
        .map(|(index, (front, label))| {
            let last = all.all.iter().filter(|one| Some(one.round) == last);
            let some: Vec<&Ranked> = last.filter(|one| one.on_front == front).collect();
            let x: Vec<f64> = some.iter().map(|one| one.cost()).collect();
            let bounds = |one: &&Ranked| Interval { low: one.fallen.low, high: one.fallen.high };
            let means = some.iter().map(|one| one.fallen.mean);
            points(label, &x, means, some.iter().map(bounds), index)
        })
        .chain((front.len() > 1).then_some(frontier))
        .collect();
    let fallen = if is_site(all) { "barrels fallen a year" } else { "barrels fallen" };
    Figure::new(
        "cost-and-loss",
        format!(
            "Number of barrels that fall as a function of the cost of a protection, {}, for the protections that \
             were run in all rounds. Vertical bars: 95 % intervals. The table names the protections.",
            per(all)
        ),
        Plot {
            x: Axis::new("cost per stack", "US$"),
            y: Axis::new(fallen, ""),
            series,
            ..Plot::default()
        },
    )
}

/// Tabulates the changes that each protection makes to the scenario, so that readers can try the protection themselves.
fn changes(all: &Ranking) -> Table {
    let tried = all.all.iter().map(|one| &one.protection);
    Table::of(
        "Changes of each protection in the scenario, and the source of its cost.",
        tried.filter(|one| one.kind != Kind::AsItIs),
        &[
            ("protection", "", &|one| Cell::text(&one.name)),
            ("changes", "", &|one| Cell::text(one.changes.join("; "))),
            ("cost", "", &|one| Cell::text(&one.source)),
        ],
    )
}

fn rests_on(all: &Ranking) -> Vec<String> {
    let own = !all.request.records.is_empty() || all.request.folder.is_some();
    let motions = if own {
        "Motions: the given records, each scaled to every level of peak ground velocity.".to_owned()
    } else {
        "Motions: both components of South Napa 2014 at Napa College with the vertical component, and synthetic \
         motions (earthquakes of M 6 at 8 km and M 7 at 20 km, near-fault pulses), each scaled to every level of \
         peak ground velocity."
            .to_owned()
    };
    vec![
        motions,
        "Friction, stiffness and damping of the seats are drawn for every run around the values in the scenario, with \
         the dispersions of the scenario. All protections use the same quantiles of these distributions."
            .into(),
        "Costs are for one stack and for one purchase and installation; most are assumptions, listed in the \
         table. Labor, lost time and injuries are not counted."
            .into(),
        "Whether a barrel bursts is assumed to depend on the height of its fall, according to the central one of \
         three assumptions; none of the three has been tested.".into(),
        format!(
            "The stack stands alone{}: no neighbors that knock it down, no walls, no ropes between stacks. Straps \
             do not tear unless the scenario states a strength.",
            if all.request.scenario.is_spatial() {
                ", in a three-dimensional model, and the horizontal direction of the motion is drawn for every run"
            } else {
                ", in a plane model"
            }
        ),
        "Between two levels of shaking the loss is interpolated linearly in the logarithm of the velocity. Below \
         the lowest level, the loss decreases to zero at half of that level; above the highest level it remains \
         constant."
            .into(),
    ]
}

fn warnings(all: &Ranking) -> Vec<String> {
    let lost = all.all.iter().map(|one| one.left_out).sum();
    let fallen: usize = all.all.iter().map(|one| one.fallen_at_rest).sum();
    let fallen = (fallen > 0).then(|| {
        let said = fallen_at_rest(fallen, all.runs, "runs of all protections");
        format!(
            "{said}Such runs count as collapsed; the barrels of the level that fails and of all levels above it count \
             as fallen."
        )
    });
    left_out(lost, all.runs).into_iter().chain(fallen).collect()
}
