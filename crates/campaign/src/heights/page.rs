//! Report page of a study of safe heights.

use barrelstack_fragility::{Fit, Interval, at_most};
use barrelstack_report::{
    Axis, Block, Cell, Document, Figure, Plot, Rating, Table, Verdict, significant,
};

use super::plan::{self, LOWEST, VELOCITIES};
use super::{AtLevel, Height, Heights, field};
use crate::decision::{
    LimitCurve, chance_axis, fallen_at_rest, heading, left_out, percent, points, range, refusal,
    text,
};
use crate::direction::Direction;
use crate::scenario::catalog;
use crate::scenario::title::{counted, number};

/// Conditions for the rating "low": the maximum share of stacks that collapse, and the maximum upper bound of the
/// probability of collapse.
///
/// The upper bound holds with 95 % confidence. A stack whose probability of collapse exceeds the second number is
/// therefore rated low in at most one of 20 studies, however many motions are run.
const LOW: (f64, f64) = (0.05, 0.12);

/// Maximum share of stacks that collapse for the rating "medium".
const MEDIUM: f64 = 0.25;

/// Builds the report page.
pub(super) fn document(all: &Heights) -> Document {
    Document {
        title: format!("How high is safe: stacks on {} racks", all.request.rack),
        verdict: Verdict {
            headline: fallen_at_rest(all.fallen_at_rest, all.runs, "runs") + &headline(all),
            sentences: sentences(all),
            ..Verdict::default()
        },
        blocks: blocks(all),
        provenance: vec![
            ("racks".into(), rack_source(&all.request.rack)),
            ("motions".into(), all.motions.to_string()),
            ("runs".into(), all.runs.to_string()),
            ("seed".into(), all.request.seed.to_string()),
            ("program".into(), format!("barrelstack {}", env!("CARGO_PKG_VERSION"))),
        ],
        warnings: all.warnings.clone(),
        words: barrelstack::report::WORDS.to_vec(),
        ..Document::default()
    }
}

fn rack_source(name: &str) -> String {
    catalog::rack(name).map_or_else(String::new, |rack| format!("{name}: {}", rack.source))
}

/// Returns the perceived shaking at a peak ground velocity (m/s), in the terms of `ShakeMap`, such as "severe (VIII)".
///
/// The classes are averages over earthquakes in California (Wald et al. 1999). For other regions they are an
/// assumption.
fn felt(velocity: f64) -> &'static str {
    match 100.0 * velocity {
        v if v < 8.1 => "moderate (V)",
        v if v < 16.0 => "strong (VI)",
        v if v < 31.0 => "very strong (VII)",
        v if v < 60.0 => "severe (VIII)",
        v if v < 116.0 => "violent (IX)",
        _ => "extreme (X)",
    }
}

/// Returns a range of heights in words, such as "two levels" or "two to six levels".
pub(super) fn span(from: u32, to: u32) -> String {
    if from == to {
        counted(from, "level")
    } else {
        format!("{} to {}", number(from), counted(to, "level"))
    }
}

fn shaking(velocity: f64) -> String {
    format!("{:.0} cm/s", 100.0 * velocity)
}

/// Formats a level of PGV (m/s) with its perceived shaking, such as "severe shaking (40 cm/s)".
fn named(velocity: f64) -> String {
    let felt = felt(velocity).split(' ').take_while(|word| !word.starts_with('('));
    format!("{} shaking ({})", felt.collect::<Vec<_>>().join(" "), shaking(velocity))
}

/// Returns the results of stacks of `levels` levels at a given PGV (m/s), in the direction with the higher upper bound
/// of the probability of collapse; `None` if no run has a verdict.
fn worse(all: &Heights, levels: u32, velocity: f64) -> Option<AtLevel> {
    let directions = all.request.directions().into_iter();
    directions
        .filter_map(|direction| all.of(levels, direction)?.at(velocity))
        .max_by(|a, b| a.interval.high.total_cmp(&b.interval.high))
}

fn rating(at: &AtLevel) -> Rating {
    let share = at.stripe.fraction();
    if share <= LOW.0 && at.interval.high <= LOW.1 {
        Rating::Good
    } else if share <= MEDIUM {
        Rating::Fair
    } else {
        Rating::Poor
    }
}

/// Returns the largest number of levels that is rated low at a given PGV (m/s), provided that all smaller numbers are
/// rated low as well; `None` if not even [`LOWEST`] levels are rated low.
fn highest_low(all: &Heights, velocity: f64) -> Option<u32> {
    all.request
        .heights()
        .take_while(|levels| {
            worse(all, *levels, velocity).is_some_and(|at| rating(&at) == Rating::Good)
        })
        .last()
}

/// Returns the smallest number of motions that suffice for the rating "low" if no stack collapses.
fn fewest_motions() -> u32 {
    (1..1_000_000).find(|n| at_most(0, *n, 0.95) <= LOW.1).unwrap_or(u32::MAX)
}

fn headline(all: &Heights) -> String {
    let racks = format!("on {} racks", all.request.rack);
    let motions = u32::try_from(all.motions).unwrap_or(u32::MAX);
    if motions < fewest_motions() {
        let more = fewest_motions() - motions;
        return format!(
            "Too few motions to rate any stack {racks} as low risk: each stack was shaken by {motions}, and {more} \
             more are needed."
        );
    }
    // Go from the weakest shaking up to the first level that is not rated low. If each level were judged
    // independently, one of them could pass by chance.
    let low =
        VELOCITIES.into_iter().map_while(|velocity| Some((velocity, highest_low(all, velocity)?)));
    let Some((velocity, levels)) = low.last() else {
        return format!(
            "Not even two levels {racks} have a low risk in {}{}.",
            named(VELOCITIES[0]),
            weaker(all, VELOCITIES[0])
        );
    };
    let next = VELOCITIES.into_iter().find(|other| *other > velocity);
    format!(
        "Up to {levels} levels {racks} have a low risk in {}, {}: {}{}.{}",
        named(velocity),
        in_planes(all, "across the barrels and along them", "shaken in all directions"),
        found(all, levels, velocity),
        next.map(|next| {
            format!(
                "; in {}, not even two levels have a low risk{}",
                named(next),
                weaker(all, next)
            )
        })
        .unwrap_or_default(),
        over_constants(all, velocity)
    )
}

/// Returns the text `planes` if the stacks are simulated in planes, and the text `space` if they are simulated in three
/// dimensions.
fn in_planes<'a>(all: &Heights, planes: &'a str, space: &'a str) -> &'a str {
    if all.request.in_space { space } else { planes }
}

/// Returns the direction as a phrase to insert in a sentence, such as ", along the barrels"; empty for
/// three-dimensional shaking, whose results are not given by direction.
fn inserted(direction: Direction) -> String {
    match direction {
        Direction::Plane(view) => format!(", {}", view.words()),
        Direction::Space => String::new(),
    }
}

/// Returns the results of stacks of `levels` levels at a given PGV (m/s), with the range of the probability of collapse
/// over the uncertain constants of the seats. The results are those in the direction in which this range has the higher
/// upper end. Returns `None` if the range is unknown in a direction.
fn widest(all: &Heights, levels: u32, velocity: f64) -> Option<(&Height, AtLevel, [f64; 2])> {
    let found = |direction| {
        let height = all.of(levels, direction)?;
        let at = height.at(velocity)?;
        Some((height, at, at.range?))
    };
    let directions = all.request.directions().into_iter();
    let found = directions.map(found).collect::<Option<Vec<_>>>()?;
    found.into_iter().max_by(|a, b| a.2[1].total_cmp(&b.2[1]))
}

/// Returns the largest number of levels with a low risk at a given PGV (m/s), allowing for the uncertain constants.
///
/// The risk is low if the upper end of the 95 % range of the probability of collapse does not exceed the limit for the
/// rating "low". The risk must be low for all smaller numbers of levels as well. Returns `None` if the risk of
/// [`LOWEST`] levels is not low or is unknown.
fn highest_over_constants(all: &Heights, velocity: f64) -> Option<u32> {
    let low =
        |levels: &u32| widest(all, *levels, velocity).is_some_and(|(.., range)| range[1] <= LOW.1);
    all.request.heights().take_while(low).last()
}

/// Returns a sentence with the largest number of levels that have a low risk at a given PGV (m/s), allowing for the
/// uncertain constants; empty if the effect of the constants is unknown.
fn over_constants(all: &Heights, velocity: f64) -> String {
    let highest = highest_over_constants(all, velocity);
    let Some((height, _, [from, to])) = widest(all, highest.unwrap_or(LOWEST), velocity) else {
        return String::new();
    };
    let uncertain = "Allowing for the uncertain friction, stiffness and damping of the seats,";
    let shares = format!("{:.0} to {:.0} %", 100.0 * from, 100.0 * to);
    if let Some(levels) = highest {
        return format!(
            " {uncertain} up to {levels} levels have a low risk: the probability of collapse is {shares} (95 % range)."
        );
    }
    let decides = height
        .decisive(velocity)
        .map_or_else(String::new, |one| format!("; it depends most on the {}", one.name));
    let weaker = VELOCITIES
        .into_iter()
        .map_while(|velocity| Some((velocity, highest_over_constants(all, velocity)?)))
        .last();
    let weaker = weaker.map_or_else(String::new, |(velocity, levels)| {
        format!(". In {}, up to {levels} levels have a low risk", named(velocity))
    });
    format!(
        " {uncertain} not even two levels have a low risk: the probability of collapse is {shares} (95 % range)\
         {}{decides}{weaker}.",
        inserted(height.direction)
    )
}

/// Tabulates the range of the probability of collapse over the uncertain constants of the seats, in the direction in
/// which the range has the higher upper end.
fn over_constants_table(all: &Heights) -> Table {
    by_height(
        all,
        format!(
            "95 % range of the chance of collapse as the uncertain constants of the seats vary, and the constant on \
             which this chance depends most.{}",
            in_planes(
                all,
                " The cell is for the direction of shaking whose interval has the higher upper end.",
                ""
            )
        ),
        |levels, velocity| {
            Cell::maybe(widest(all, levels, velocity).map(|(height, _, [from, to])| {
                let decides = height.decisive(velocity);
                let decides = decides.map_or_else(String::new, |one| format!(", {}", one.name));
                format!("{:.0}–{:.0} %{decides}", 100.0 * from, 100.0 * to)
            }))
        },
    )
}

/// Returns a phrase with the directions in which stacks of two levels are not rated low at a given PGV (m/s), such as
/// ", along the barrels"; empty if there are no such directions, or for three-dimensional shaking.
fn weaker(all: &Heights, velocity: f64) -> String {
    let low = |direction: &Direction| {
        let at = all.of(LOWEST, *direction).and_then(|height| height.at(velocity));
        at.is_none_or(|at| rating(&at) == Rating::Good)
    };
    let planes = all.request.directions().into_iter().filter(|one| *one != Direction::Space);
    let not: Vec<&str> = planes.filter(|one| !low(one)).map(Direction::words).collect();
    if not.is_empty() { String::new() } else { format!(", {}", not.join(" and ")) }
}

/// Describes the worst result of all stacks of up to `levels` levels at a given PGV (m/s), such as "in 24 motions none
/// fell (the probability of collapse is at most 12 % with 95 % confidence)".
fn found(all: &Heights, levels: u32, velocity: f64) -> String {
    let heights = all.request.heights().take_while(|height| *height <= levels);
    let worst = heights
        .filter_map(|height| worse(all, height, velocity))
        .max_by(|a, b| a.interval.high.total_cmp(&b.interval.high));
    let Some(AtLevel { stripe, interval, .. }) = worst else { return String::new() };
    let fell = match stripe.failures {
        0 => "none fell".to_owned(),
        count => format!("at most {count} stacks of the same height fell"),
    };
    format!(
        "in {} motions {fell} (the probability of collapse is at most {} with 95 % confidence)",
        stripe.cases,
        bound(interval.high)
    )
}

/// Formats an upper bound as a whole percentage. Rounding may understate the bound by up to half a percentage point.
fn bound(high: f64) -> String {
    format!("{:.0} %", 100.0 * high)
}

fn sentences(all: &Heights) -> Vec<String> {
    let mut said = vec![format!(
        "Stacks of {} on {} racks were shaken {} times, {}, by {} motions.",
        span(LOWEST, all.request.highest),
        all.request.rack,
        all.runs,
        in_planes(
            all,
            "across and along the barrels",
            "in three dimensions, in horizontal directions that were drawn for every run"
        ),
        all.motions
    )];
    let share = |levels: u32| {
        let velocity = VELOCITIES.into_iter().find(|v| *v >= 0.5)?;
        Some((velocity, worse(all, levels, velocity)?.stripe.fraction()))
    };
    if let (Some((velocity, low)), Some((_, high))) = (share(3), share(6)) {
        said.push(format!(
            "In shaking as strong as near Napa in 2014 ({}), {} of the stacks of three levels and {} of the stacks of \
             six levels collapse{}.",
            shaking(velocity),
            percent(low),
            percent(high),
            in_planes(all, " in their weaker direction", "")
        ));
    }
    // A stack without a static margin stands even at 1 g.
    let least = |height: &&Height| height.static_margin.unwrap_or(f64::INFINITY);
    let weakest = all.heights.iter().min_by(|a, b| least(a).total_cmp(&least(b)));
    if let Some((height, margin)) = weakest.and_then(|height| Some((height, height.static_margin?)))
    {
        said.push(format!(
            "Stacks of {} levels have the smallest static margin{}: they collapse under a steady horizontal \
             acceleration of {}, which corresponds to a floor tilted by {:.0} degrees.",
            height.levels,
            inserted(height.direction),
            gravities(margin),
            tilt(margin)
        ));
    }
    said
}

/// Formats an acceleration (m/s²) in units of gravity, such as "0.12 g".
fn gravities(acceleration: f64) -> String {
    format!("{:.2} g", acceleration / barrelstack_motion::STANDARD_GRAVITY)
}

/// Returns the tilt (degrees) of a floor that has the same effect as a steady horizontal acceleration (m/s²).
fn tilt(acceleration: f64) -> f64 {
    libm::atan(acceleration / barrelstack_motion::STANDARD_GRAVITY).to_degrees()
}

fn blocks(all: &Heights) -> Vec<Block> {
    let mut blocks = vec![
        heading("How high is safe"),
        Block::Table(card(all)),
        text(format!(
            "Each cell shows the share of stacks that collapse and, in brackets, a confidence interval for the chance \
             of collapse. {}The chance is above the lower end of the interval with 95 % confidence, and below its \
             upper end with 95 % confidence. ✓ low: a share of at most {:.0} %, and an upper end of at most {:.0} %. If the \
             chance of collapse of a stack is above {:.0} %, at most one of 20 studies calls this chance low. ! medium: \
             a share of at most {:.0} %. ✗ high: all other results. These limits were chosen by judgment.",
            in_planes(
                all,
                "The cell is for the direction of shaking whose interval has the higher upper end. ",
                ""
            ),
            100.0 * LOW.0,
            100.0 * LOW.1,
            100.0 * LOW.1,
            100.0 * MEDIUM
        )),
        Block::Table(over_constants_table(all)),
        text(
            "If the friction, stiffness and damping of a stack are drawn once from their distributions, its chance of \
             collapse lies within the range with a probability of 95 %. The range includes the sampling error. The \
             intervals in brackets in the table above are for stacks whose constants are drawn anew for every run. A \
             constant is named only if it changes the chance by 20 percentage points or more over its own range. \
             Measure this constant, and state its value in a scenario of your own.",
        ),
        text(
            "To find the row of your site, use the peak ground velocity of your design earthquake, or read it from a \
             ShakeMap of a past earthquake. The Roman numeral is the average intensity observed at this velocity in \
             California (Wald et al. 1999); elsewhere, this relation is an assumption.",
        ),
        Block::Figure(chart(all)),
        heading(in_planes(all, "Both directions", "In all directions")),
        Block::Table(static_margins(all)),
    ];
    for one in all.request.directions() {
        blocks.push(Block::Table(direction(all, one)));
    }
    blocks.push(Block::Figure(medians(all)));
    blocks.push(Block::Table(median_table(all)));
    blocks.push(heading("Comparison with Napa in 2014"));
    blocks.extend(field::napa(all));
    blocks.push(heading("Basis and limits"));
    blocks.push(Block::List(rests_on(all)));
    blocks
}

/// Returns a table with one row per level of shaking and one column per height.
fn by_height(all: &Heights, caption: String, cell: impl Fn(u32, f64) -> Cell) -> Table {
    let names: Vec<String> =
        all.request.heights().map(|levels| format!("{levels} levels")).collect();
    let mut columns = vec![("shaking, by PGV", ""), ("felt as", "")];
    columns.extend(names.iter().map(|name| (name.as_str(), "")));
    let mut table = Table::new(caption, &columns);
    for velocity in VELOCITIES {
        let mut row = vec![Cell::text(shaking(velocity)), Cell::text(felt(velocity))];
        row.extend(all.request.heights().map(|levels| cell(levels, velocity)));
        table.rows.push(row);
    }
    table
}

fn judged(at: &AtLevel) -> Cell {
    let rating = rating(at);
    let sign = match rating {
        Rating::Good => "✓",
        Rating::Fair => "!",
        Rating::Poor => "✗",
    };
    let whole = |share: f64| format!("{:.0}", 100.0 * share);
    Cell::Rated(
        rating,
        format!(
            "{sign} {} % ({}–{})",
            whole(at.stripe.fraction()),
            whole(at.interval.low),
            whole(at.interval.high)
        ),
    )
}

fn card(all: &Heights) -> Table {
    let rack = &all.request.rack;
    by_height(
        all,
        format!(
            "Chance that a stack on {rack} racks collapses, by height and strength of shaking."
        ),
        |levels, velocity| worse(all, levels, velocity).map_or(Cell::Missing, |at| judged(&at)),
    )
}

fn direction(all: &Heights, direction: Direction) -> Table {
    by_height(
        all,
        format!(
            "Collapse under shaking {}: number of stacks that collapse and number of stacks that were run.",
            direction.words()
        ),
        |levels, velocity| {
            let found = all.of(levels, direction).and_then(|height| height.at(velocity));
            Cell::maybe(
                found.map(|AtLevel { stripe, .. }| {
                    format!("{} of {}", stripe.failures, stripe.cases)
                }),
            )
        },
    )
}

/// Tabulates, for each height, the static margin and the weakest shaking in which some stacks collapse.
fn static_margins(all: &Heights) -> Table {
    let first = |height: &Height| {
        let falls = |at: &AtLevel| at.stripe.failures > 0;
        let level = VELOCITIES.into_iter().find(|v| height.at(*v).as_ref().is_some_and(falls));
        level.map_or_else(|| "at none".to_owned(), shaking)
    };
    Table::of(
        format!(
            "Static margin: the largest steady horizontal acceleration that a stack withstands, and the equivalent \
             tilt of the floor, with the friction and the seats of the catalog{}. If the shaking has pulses that last \
             as long as a stack takes to tip over, an acceleration slightly above the margin makes the stack collapse.",
            in_planes(
                all,
                "",
                "; the smaller of the margins of the two plane models, across and along the barrels"
            )
        ),
        &all.heights,
        &[
            ("levels", "", &|height| Cell::text(height.levels.to_string())),
            ("pushed", "", &|height| {
                Cell::text(match height.direction {
                    Direction::Plane(view) => view.words(),
                    Direction::Space => "across or along the barrels",
                })
            }),
            ("static margin", "", &|height| {
                Cell::text(height.static_margin.map_or_else(|| "above 1 g".to_owned(), gravities))
            }),
            ("tilt", "degrees", &|height| Cell::number(height.static_margin.map(tilt), 2)),
            ("weakest shaking with collapses", "", &|height| Cell::text(first(height))),
        ],
    )
}

fn level_axis(all: &Heights) -> Axis {
    let range = [f64::from(LOWEST) - 0.4, f64::from(all.request.highest) + 0.4];
    Axis { range: Some(range), ..Axis::new("levels", "") }
}

/// Plots the share of stacks that collapse against height, at three levels of shaking, with 95 % intervals.
fn chart(all: &Heights) -> Figure {
    let mut series = Vec::new();
    for (index, at) in [1, 3, 5].into_iter().enumerate() {
        // Points are shifted sideways so that their bars do not overlap.
        let shift = 0.07 * (index as f64 - 1.0);
        let found: Vec<(f64, f64, Interval)> = all
            .request
            .heights()
            .filter_map(|levels| {
                let found = worse(all, levels, VELOCITIES[at])?;
                Some((f64::from(levels) + shift, found.stripe.fraction(), found.interval))
            })
            .collect();
        let x: Vec<f64> = found.iter().map(|(x, _, _)| *x).collect();
        let (y, bounds) = (found.iter().map(|f| f.1), found.iter().map(|f| f.2));
        series.push(points(&shaking(VELOCITIES[at]), &x, y, bounds, index));
    }
    Figure::new(
        "height-chart",
        format!(
            "Chance of collapse{} as a function of height, at three strengths of shaking. Each end of a vertical bar is a one-sided bound with 95 % confidence.",
            in_planes(all, " in the weaker direction", "")
        ),
        Plot {
            x: level_axis(all),
            y: chance_axis("chance of collapse"),
            series,
            ..Plot::default()
        },
    )
}

/// Plots, against height, the PGV at which half of the stacks collapse.
fn medians(all: &Heights) -> Figure {
    let mut series = Vec::new();
    for (index, direction) in all.request.directions().into_iter().enumerate() {
        let shift = 0.05 * (2.0 * index as f64 - 1.0);
        let found: Vec<(f64, f64, Interval)> = all
            .heights
            .iter()
            .filter(|height| height.direction == direction)
            .filter_map(|height| {
                let fit = determined(&height.by_velocity)?;
                let at = f64::from(height.levels) + shift;
                // Bars without an upper end are not drawn.
                let bounds = height.by_velocity.median.filter(|bounds| bounds.high.is_finite());
                let bounds = bounds.unwrap_or(Interval { low: f64::NAN, high: f64::NAN });
                let [low, high] = [bounds.low, bounds.high].map(|bound| 100.0 * bound);
                Some((at, 100.0 * fit.curve.median, Interval { low, high }))
            })
            .collect();
        let x: Vec<f64> = found.iter().map(|(x, _, _)| *x).collect();
        let (y, bounds) = (found.iter().map(|f| f.1), found.iter().map(|f| f.2));
        series.push(points(direction.words(), &x, y, bounds, index));
    }
    Figure::new(
        "medians",
        "Peak ground velocity at which half of the stacks collapse according to the fitted curves, with 95 % \
         intervals. A height without a dot has no curve; the table gives the reason.",
        Plot {
            x: level_axis(all),
            y: Axis::new("median PGV of collapse", "cm/s"),
            series,
            ..Plot::default()
        },
    )
}

/// Maximum ratio of a reported median to the highest level of shaking in the study. The cases do not determine a higher
/// fitted median, which is therefore not reported.
const MOST_BEYOND: f64 = 2.0;

/// Returns the fitted curve if the cases determine its median ([`MOST_BEYOND`]).
fn determined(curve: &LimitCurve) -> Option<&Fit> {
    let highest = curve.stripes.iter().map(|stripe| stripe.intensity).fold(0.0, f64::max);
    curve.fit.as_ref().ok().filter(|fit| fit.curve.median <= MOST_BEYOND * highest)
}

fn median_table(all: &Heights) -> Table {
    let number = |curve: &LimitCurve, scale: f64, of: fn(&Fit) -> f64| {
        Cell::number(determined(curve).map(|fit| scale * of(fit)), 3)
    };
    let shown = |x: f64| if x.is_finite() { significant(100.0 * x, 3) } else { "∞".to_owned() };
    let interval = |pgv: &LimitCurve| {
        pgv.median.filter(|_| determined(pgv).is_some()).map(|bounds| range(bounds, shown))
    };
    let remark = |pgv: &LimitCurve| match &pgv.fit {
        Ok(_) if determined(pgv).is_none() => {
            "the fitted median is far above all levels of shaking that were run".to_owned()
        }
        Ok(_) if pgv.violates_order() => "not monotone: use the counts".to_owned(),
        Ok(_) => String::new(),
        Err(reason) => refusal(reason, shaking),
    };
    let g = 1.0 / barrelstack_motion::STANDARD_GRAVITY;
    Table::of(
        "Fragility by height and direction: lognormal curves fitted by maximum likelihood.",
        all.heights.iter().map(|height| (height, &height.by_velocity, &height.by_acceleration)),
        &[
            ("levels", "", &|(height, ..)| Cell::text(height.levels.to_string())),
            ("shaken", "", &|(height, ..)| Cell::text(height.direction.words())),
            ("median PGV", "cm/s", &|(_, pgv, _)| number(pgv, 100.0, |fit| fit.curve.median)),
            ("95 % interval", "cm/s", &|(_, pgv, _)| Cell::maybe(interval(pgv))),
            ("dispersion", "", &|(_, pgv, _)| number(pgv, 1.0, |fit| fit.curve.dispersion)),
            ("median PGA", "g", &|(.., pga)| number(pga, g, |fit| fit.curve.median)),
            ("dispersion (PGA)", "", &|(.., pga)| number(pga, 1.0, |fit| fit.curve.dispersion)),
            ("remark", "", &|(_, pgv, _)| Cell::text(remark(pgv))),
        ],
    )
}

/// States the number of synthetic motions of each kind; empty if there are none.
pub(super) fn synthetic(count: u32) -> String {
    let kinds = [
        "of M 6 at 8 km by Boore's method",
        "of M 7 at 20 km by Boore's method",
        "with a near-fault pulse",
    ];
    let used = plan::kinds(count).into_iter().zip(kinds).filter(|(count, _)| *count > 0);
    let used: Vec<String> = used.map(|(count, kind)| format!("{count} {kind}")).collect();
    match used.split_last() {
        None => String::new(),
        Some((last, [])) => format!(" Synthetic motions are added: {last}."),
        Some((last, others)) => {
            format!(" Synthetic motions are added: {} and {last}.", others.join(", "))
        }
    }
}

fn rests_on(all: &Heights) -> Vec<String> {
    vec![
        format!(
            "Motions: both horizontal components of South Napa 2014 at Napa College with the vertical component{}.{} \
             Each motion is scaled to every level of PGV{}.",
            if all.request.records.is_empty() { "" } else { ", and the given records" },
            synthetic(all.request.synthetic),
            in_planes(
                all,
                "",
                ". A record has all its components, a synthetic motion has one; the horizontal direction is drawn \
                 for every run"
            )
        ),
        format!(
            "All barrels are full and of the type `{}` of the catalog. Friction, stiffness and damping of the seats \
             are drawn for every run around the values of the catalog, with the default dispersions of a scenario. \
             These values and dispersions are assumptions. The friction of wet floors and of painted racks differs \
             from these values, so measure the friction of your own floor and racks.",
            all.request.barrel
        ),
        format!(
            "Each stack stands alone, in {}: no neighbors, no walls, no straps. Collapse is the first loss of a seat by a \
             barrel or a rack.",
            in_planes(all, "a plane model", "a three-dimensional model")
        ),
        "Scaled motions differ from the motions of stronger earthquakes, which last longer and have longer periods. \
         Results at levels far from the original strength of a motion are the least certain."
            .into(),
        "When the ranges are computed, every motion counts as one observation. The ranges apply to motions like these \
         and do not cover errors of the model."
            .into(),
        "The racks are those of the catalog; several of their dimensions are assumptions. The folder holds the studies of this \
         page, which you can change and run for racks and rooms of your own."
            .into(),
    ]
}

/// Returns the warnings, the most important first.
pub(super) fn warnings(all: &Heights) -> Vec<String> {
    let mut said = all.ends.clone();
    said.extend(left_out(all.left_out, all.runs));
    for height in &all.heights {
        for fall in height.by_velocity.monotony.significant(0.05) {
            said.push(format!(
                "Stacks of {} levels, shaken {}: {} of {} collapse at {}, but only {} of {} at {} (p = {}). Stronger \
                 shaking is not always worse for this stack; this does not make the stack safe.",
                height.levels,
                height.direction.words(),
                fall.from.failures,
                fall.from.cases,
                shaking(fall.from.intensity),
                fall.to.failures,
                fall.to.cases,
                shaking(fall.to.intensity),
                significant(fall.p, 2)
            ));
        }
    }
    said
}
