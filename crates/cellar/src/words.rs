//! Results of a cellar as sentences.

use barrelstack::motion::STANDARD_GRAVITY;
use barrelstack::summary::Unfinished;
use barrelstack::variants::Range;
use barrelstack::variants::words::{ENOUGH, percent};
use barrelstack_report::{Tone, capital, listed, measured, significant};

use crate::plan::liters;
use crate::summary::{AisleAnswer, CellarSummary, Count, Mean, ShockAnswer, ShownShock};

/// Formats a count with its noun, such as "1 stack" or "3 stacks".
pub(crate) fn plural(count: u32, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// Formats a count out of `of` variants with its share and interval, such as "28 of 32 variants (88 %, 95 % interval
/// 72 % to 95 %)"; "the only run" or "no run" if `of` is 1.
pub(crate) fn share(count: &Count, of: u32) -> String {
    if of == 1 {
        return if count.of_variants == 0 { "no run" } else { "the only run" }.to_owned();
    }
    let [low, high] = count.interval.map(percent);
    let share = count.share.map_or_else(String::new, |share| format!("{}, ", percent(share)));
    format!(
        "{} of {} ({share}95 % interval {low} to {high})",
        count.of_variants,
        plural(of, "variant")
    )
}

/// Formats the range of a result over `of` variants, such as "2.1 to 3.4 s"; one number if both ends round to the same
/// number.
pub(crate) fn span(range: &Range, of: u32, decimals: usize, unit: &str) -> String {
    let [low, high] = range.stated(of).map(|value| format!("{value:.decimals$}"));
    if low == high { format!("{low} {unit}") } else { format!("{low} to {high} {unit}") }
}

/// Returns the name of the run that is shown.
pub(crate) fn shown_run(summary: &CellarSummary) -> String {
    match (summary.shown.variant, summary.shown.typical) {
        (0, _) => "the room as stated".to_owned(),
        (number, true) => format!("variant {number}, the most typical"),
        (number, false) => format!("variant {number}"),
    }
}

/// Returns the sentence that states when the work was stopped: for a single run, at the simulated time `end_time` (s);
/// for several runs, after how many of them.
pub(crate) fn stopped(unfinished: &Unfinished, end_time: f64) -> String {
    let Unfinished { done, of } = unfinished;
    if *of == 1 {
        return format!(
            "Stopped at {end_time:.1} s, before the end of the run: there is no verdict."
        );
    }
    format!(
        "Stopped after {done} of {of} runs of the room as stated and of its variants: there is no verdict."
    )
}

/// Returns the time (s) by which the ground motion outlasts the run that is shown, if stacks still move when the run
/// ends; otherwise `None`. For a sequence, returns the longest such time of its shocks.
pub(crate) fn missing(summary: &CellarSummary) -> Option<f64> {
    Some(summary.shown.cut).filter(|cut| *cut > 0.0)
}

/// Returns the longest time (s) by which the ground motion of a shock outlasts the run of this shock. Only runs that
/// end while stacks still move count; `None` if there is no such run.
pub(crate) fn longest_cut<'a>(shocks: impl Iterator<Item = &'a ShockAnswer>) -> Option<f64> {
    let cut = shocks.filter_map(|shock| Some(shock.shown.as_ref()?.cut)).fold(0.0, f64::max);
    Some(cut).filter(|cut| *cut > 0.0)
}

/// Returns the sentence that states that the ground motion of a shock outlasts the run of this shock by `cut` (s).
pub(crate) fn followed(cut: f64) -> String {
    format!("The run of a shock ends {cut:.1} s before its motion ends.")
}

/// Formats a mean share with its interval, such as "80 % (95 % interval 61 % to 92 %)".
pub(crate) fn mean_share(share: &Mean) -> String {
    let [mean, low, high] = [share.mean, share.interval[0], share.interval[1]].map(percent);
    format!("{mean} (95 % interval {low} to {high})")
}

/// Returns the number of stacks that stand before the run that is shown.
fn standing(summary: &CellarSummary) -> usize {
    summary.plan.stacks - summary.shown.fallen_before as usize
}

/// Returns a clause on the variants in which a stack falls; empty if there are none. The clause follows the statement
/// that no stack falls in the run that is shown.
fn but_some_fall(summary: &CellarSummary) -> String {
    match summary.room.some_fall.of_variants {
        0 => String::new(),
        some => {
            let variants = plural(summary.counted, "variant");
            format!(", but at least one falls in {some} of {variants}")
        }
    }
}

/// Returns the result of the run that is shown, in one sentence.
pub fn headline(summary: &CellarSummary) -> String {
    let shown = &summary.shown;
    if !summary.shocks.is_empty() {
        return of_sequence(summary);
    }
    let (all, before) = (standing(summary), shown.fallen_before > 0);
    let (own, knocked) = (shown.by_themselves, shown.knocked_over);
    if own + knocked == 0 {
        let stand = match (all, before) {
            (0, _) => "No stack stood before the shaking".to_owned(),
            (1, true) => "The only stack that stood before the shaking survives".to_owned(),
            (_, true) => format!("All {all} stacks that stood before the shaking survive"),
            (1, false) => "The only stack stands".to_owned(),
            (_, false) => format!("All {all} stacks stand"),
        };
        let until = missing(summary).filter(|_| all > 0).map_or(String::new(), |missing| {
            format!(
                " until the run ends at {:.1} s, {missing:.1} s before the end of the motion",
                shown.end_time
            )
        });
        let but = but_some_fall(summary);
        let run = if but.is_empty() {
            String::new()
        } else {
            format!(" in the run that is shown ({})", shown_run(summary))
        };
        return format!("{stand}{until}{run}{but}.");
    }
    if all == 1 && !before {
        return sentence(summary, &format!("the only stack falls{}.", blocked(summary)));
    }
    let starts = shown.starts.filter(|_| summary.plan.rows > 1);
    let starts = starts.map_or(String::new(), |row| format!("the collapse starts in row {row}: "));
    let stood = if before { " that stood before the shaking" } else { "" };
    let fall = falling(own, &format!("{all} stacks{stood}"), knocked);
    sentence(summary, &format!("{starts}{fall}{}.", blocked(summary)))
}

/// Returns the result of the run that is shown, for a sequence of shocks.
fn of_sequence(summary: &CellarSummary) -> String {
    let cut = missing(summary).map_or(String::new(), |missing| {
        format!("; the run of a shock ends {missing:.1} s before its motion ends")
    });
    let shown = &summary.shown;
    let but = if shown.by_themselves + shown.knocked_over == 0 {
        but_some_fall(summary)
    } else {
        String::new()
    };
    let shocks = shock_by_shock(summary);
    sentence(summary, &format!("{shocks}{}{cut}{but}.", blocked(summary)))
}

/// Returns a clause on the stacks that fall, such as "2 of 4 stacks fall by themselves, 1 more is knocked over".
fn falling(own: u32, of: &str, knocked: u32) -> String {
    let verb = if own == 1 { "falls by itself" } else { "fall by themselves" };
    let more = match knocked {
        0 => "none is knocked over".to_owned(),
        1 => "1 more is knocked over".to_owned(),
        many => format!("{many} more are knocked over"),
    };
    format!("{own} of {} {verb}, {more}", of.trim_end())
}

/// Largest number of shocks that a sentence lists one by one.
const LISTED: usize = 3;

/// Describes what happens in the shocks of the run that is shown. If there are many shocks, only those in which a stack
/// falls are described.
fn shock_by_shock(summary: &CellarSummary) -> String {
    let all = &summary.shocks;
    let changes = |shown: &ShownShock| shown.by_themselves + shown.knocked_over > 0;
    let stated = all.iter().filter_map(|shock| Some((shock.shock, shock.shown.as_ref()?)));
    let stated: Vec<_> =
        stated.filter(|(_, shown)| all.len() <= LISTED || changes(shown)).collect();
    if stated.is_empty() {
        return format!("no stack falls in any of the {} shocks", all.len());
    }
    let clause = |first: bool, shown: &ShownShock| {
        let (stood, changes) = (shown.stood, changes(shown));
        let of = match (stood, first) {
            (1, true) => "the only stack".to_owned(),
            (1, false) => "the only stack that still stands".to_owned(),
            (_, true) => plural(stood, "stack"),
            (_, false) => format!("the {stood} that still stand"),
        };
        match (stood, changes) {
            (0, _) if first => "no stack stands before it".to_owned(),
            (0, _) => "no stack stands any more".to_owned(),
            (1, false) => format!("{of} survives"),
            (_, false) if first => format!("all {of} stand"),
            (_, false) => format!("{of} survive"),
            (1, true) if shown.knocked_over == 0 => format!("{of} falls"),
            (1, true) => format!("{of} is knocked over"),
            (_, true) => falling(shown.by_themselves, &of, shown.knocked_over),
        }
    };
    let stated = stated.into_iter().enumerate().map(|(at, (number, shown))| {
        let shock = if at == 0 { " shock" } else { "" };
        let first = number == 1 && summary.shown.fallen_before == 0;
        format!("in the {}{shock} {}", ordinal(number), clause(first, shown))
    });
    stated.collect::<Vec<_>>().join("; ")
}

/// Formats an ordinal number up to 20: as a word up to "tenth", then with digits, such as "11th".
fn ordinal(number: u32) -> String {
    const WORDS: [&str; 10] = [
        "first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth",
        "tenth",
    ];
    let word = number.checked_sub(1).and_then(|at| WORDS.get(at as usize));
    word.map_or_else(|| format!("{number}th"), |word| (*word).to_owned())
}

/// Returns the sentences on a shock over `of` variants; `last` is `true` for the last shock of the sequence.
fn of_shock(shock: &ShockAnswer, of: u32, last: bool) -> String {
    let motion = shock.motion.as_ref().map_or_else(
        || "ground at rest".to_owned(),
        |motion| format!("{}, {} along x", motion.name, peaks(motion.pga, motion.pgv)),
    );
    let end = still_moving(shock, of, last);
    format!("Shock {} ({motion}): {}.{end}", shock.shock, survival(shock, of))
}

/// Returns a clause on the stacks that survive a shock, with counts and intervals over `of` variants.
pub(crate) fn survival(shock: &ShockAnswer, of: u32) -> String {
    let fallen = barrels_fall(&shock.barrels_fallen, of);
    if shock.stood_in == 0 {
        let variants = if of == 1 { "" } else { " in any variant" };
        return format!("no stack stands before it{variants}; {fallen}");
    }
    if of == 1
        && let Some(shown) = &shock.shown
    {
        let (stood, own, knocked) = (shown.stood, shown.by_themselves, shown.knocked_over);
        let survive = match (stood, own + knocked) {
            (1, 0) => "the only stack that stands before it survives".to_owned(),
            (_, 0) => format!("the {stood} stacks that stand before it survive"),
            (1, _) if knocked == 0 => "the only stack that stands before it falls".to_owned(),
            (1, _) => "the only stack that stands before it is knocked over".to_owned(),
            (_, _) => falling(own, &format!("the {stood} stacks that stand before it"), knocked),
        };
        return format!("{survive}; {fallen}");
    }
    let survive = shock.share_survive.unwrap_or(Mean { mean: 0.0, interval: [0.0, 1.0] });
    format!(
        "if stacks stand before it, all of them survive in {}. On average, {:.1} stand before it, of which {:.1} \
         fall by themselves and {:.1} are knocked over; {} of them survive; {fallen}",
        survived(shock),
        shock.stood,
        shock.by_themselves,
        shock.knocked_over,
        mean_share(&survive)
    )
}

/// Returns a clause on the range of the number of barrels that fall over `of` variants, such as "5 to 9 barrels fall".
fn barrels_fall(barrels: &Range, of: u32) -> String {
    match span(barrels, of, 0, "").trim_end() {
        "1" => "1 barrel falls".to_owned(),
        "0" => "no barrel falls".to_owned(),
        many => format!("{many} barrels fall"),
    }
}

/// Returns a phrase on the number of variants in which all stacks that stand before a shock survive it, out of the
/// variants in which at least one stack stands.
fn survived(shock: &ShockAnswer) -> String {
    match shock.stood_in {
        1 => format!("{} of 1 variant", shock.all_survive.of_variants),
        many => share(&shock.all_survive, many),
    }
}

/// Returns a sentence that states in how many of `of` variants a body still moves at the end of a shock; empty if there
/// are none. `last` is `true` for the last shock of the sequence.
fn still_moving(shock: &ShockAnswer, of: u32, last: bool) -> String {
    if shock.still_moving.of_variants == 0 {
        return String::new();
    }
    let next = if last {
        ""
    } else {
        "; it starts the next shock from the place that it has reached, at rest"
    };
    format!(" In {}, a body still moves when the shock ends{next}.", share(&shock.still_moving, of))
}

/// Returns a sentence that states how many of the stacks that stand after the first shock survive the second;
/// `strength` describes the strength of the second shock. `None` if the summary has no second shock or the work was
/// stopped.
pub fn aftershock(summary: &CellarSummary, strength: &str) -> Option<String> {
    let (shock, of) = (summary.shocks.get(1)?, summary.counted);
    if summary.unfinished.is_some() || of == 0 {
        return None;
    }
    let stacks = summary.plan.stacks;
    let cut = missing(summary).map_or(String::new(), |cut| format!(" {}", followed(cut)));
    if shock.stood_in == 0 {
        let variants = if of == 1 { String::new() } else { format!(" in any of {of} variants") };
        return Some(format!("No stack stands after the main shock{variants}.{cut}"));
    }
    if of == 1 {
        let shown = shock.shown.as_ref()?;
        let left = shown.stood - shown.by_themselves - shown.knocked_over;
        let stand = if shown.stood == 1 { "stands" } else { "stand" };
        return Some(format!(
            "Of {stacks} stacks, {} {stand} after the main shock and {left} after {strength}, in one run; shares can \
             be stated only for several variants.{cut}",
            shown.stood
        ));
    }
    let survive = shock.share_survive?;
    Some(format!(
        "Of {stacks} stacks, {:.1} stand after the main shock on average. If stacks stand after the main shock, all \
         of them survive {strength} in {}; on average, {} of them survive.{cut}",
        shock.stood,
        survived(shock),
        mean_share(&survive)
    ))
}

/// Returns a sentence that states `text` about the run that is shown. If several runs count, the sentence also says
/// which of them is shown.
fn sentence(summary: &CellarSummary, text: &str) -> String {
    match (summary.counted, summary.shown.typical) {
        (2.., true) => format!("In the most typical of {} runs, {text}", summary.counted),
        (2.., false) => format!("In the run that is shown ({}), {text}", shown_run(summary)),
        _ => capital(text),
    }
}

/// Returns a clause on the aisles that are blocked in the run that is shown.
fn blocked(summary: &CellarSummary) -> String {
    let times: Vec<f64> = summary.shown.blocked_at.iter().filter_map(|time| *time).collect();
    let all = summary.aisles.len();
    let Some(last) = times.iter().copied().reduce(f64::max) else {
        return match all {
            0 => String::new(),
            1 => "; the aisle stays passable".to_owned(),
            2 => "; both aisles stay passable".to_owned(),
            _ => format!("; all {all} aisles stay passable"),
        };
    };
    let after = shock_at(summary, last).unwrap_or_else(|| format!("after {last:.1} s"));
    match (times.len(), all) {
        (1, 1) => format!("; the aisle is blocked {after}"),
        (2, 2) => format!("; both aisles are blocked {after}"),
        (many, all) if many == all => format!("; all {all} aisles are blocked {after}"),
        (1, all) => format!("; 1 of {all} aisles is blocked {after}"),
        (many, all) => format!("; {many} of {all} aisles are blocked {after}"),
    }
}

/// Returns a phrase that names the shock in which a time lies, such as "in the second shock"; `None` for a single
/// shock. The time (s) is counted from the start of the shaking in the run that is shown.
fn shock_at(summary: &CellarSummary, time: f64) -> Option<String> {
    let mut left = summary.onset + time;
    let number = summary.shocks.iter().find_map(|shock| {
        let end_time = shock.shown.as_ref()?.end_time;
        let within = left <= end_time;
        left -= end_time;
        within.then_some(shock.shock)
    });
    Some(format!("in the {} shock", ordinal(number?)))
}

/// Returns the kind of verdict: invalid if no run counts or the work was stopped; otherwise whether a stack falls in
/// any run that counts. If no stack falls, the verdict is neutral in three cases: too few runs count, no stack stood
/// before the run that is shown, or this run ended before the ground motion with stacks still moving.
pub fn tone(summary: &CellarSummary) -> Tone {
    match summary.room.some_fall.of_variants {
        _ if summary.counted == 0 || summary.unfinished.is_some() => Tone::Invalid,
        // As for a single stack, a few variants in which all stacks stand are not enough for a verdict.
        0 if summary.counted < ENOUGH || standing(summary) == 0 || missing(summary).is_some() => {
            Tone::Neutral
        }
        0 => Tone::Stands,
        _ => Tone::Falls,
    }
}

/// Returns the sentences that support the headline.
pub fn sentences(summary: &CellarSummary) -> Vec<String> {
    if summary.unfinished.is_some() {
        return Vec::new();
    }
    let CellarSummary { room, counted: of, plan, .. } = summary;
    if *of == 0 {
        return vec!["No run has a valid result.".to_owned()];
    }
    let mut all = vec![falls(summary)];
    let last = summary.shocks.len();
    let shocks = (1..).zip(&summary.shocks);
    all.extend(shocks.map(|(number, shock)| of_shock(shock, *of, number == last)));
    if let Some(motion) = summary.motion.as_ref().filter(|_| summary.shocks.is_empty()) {
        let other = summary.other_component.as_ref();
        let other = other.map(|other| {
            format!("; along y it is {}, {}", other.name, peaks(other.pga, other.pgv))
        });
        let vertical = summary.vertical_component.as_ref();
        let vertical = vertical.map(|up| format!("; vertically it is {}", peaks(up.pga, up.pgv)));
        all.push(format!(
            "The ground motion along x is {}, {}{}{}.",
            motion.name,
            peaks(motion.pga, motion.pgv),
            other.unwrap_or_default(),
            vertical.unwrap_or_default(),
        ));
    }
    if let Some(spread) = room.spread.filter(|_| plan.stacks > 1) {
        all.push(format!(
            "For each stack that falls by itself, {spread:.1} stacks fall on average, including that stack."
        ));
    }
    if room.barrels_fallen.most > 0.0 {
        let [few, central, many] = room.wine_lost.map(liters);
        let [least, most] = room.cost.map(|dollars| measured(dollars, 0));
        let fallen = span(&room.barrels_fallen, *of, 0, "");
        let fall = if fallen.trim_end() == "1" { "falls" } else { "fall" };
        all.push(format!(
            "Of {} barrels, {} {fall}. About {central} of {} of wine is lost ({few} if few of the fallen barrels \
             burst, {many} if many do); the burst barrels and the wine are worth US${least} to US${most}.",
            plan.barrels,
            fallen.trim_end(),
            liters(plan.wine),
        ));
    }
    all.extend(summary.aisles.iter().map(|aisle| of_aisle(aisle, *of)));
    for place in &summary.places {
        if let Some(count) = &place.leads_out {
            let path = format!("a path 0.6 m wide from the place \"{}\" to a door", place.name);
            let runs = share(count, *of);
            all.push(if *of == 1 && count.of_variants == 0 {
                format!("In {runs} does {path} remain open.")
            } else {
                format!("In {runs}, {path} remains open.")
            });
        }
    }
    let struck: Vec<_> = summary.obstacles.iter().filter(|one| one.peak.is_some()).collect();
    if let Some(most) = struck.iter().max_by(|a, b| {
        let peak = |one: &&&crate::summary::ObstacleAnswer| one.peak.map_or(0.0, |peak| peak.most);
        peak(a).total_cmp(&peak(b))
    }) && let Some(peak) = &most.peak
    {
        all.push(format!(
            "The largest momentary force on a wall or column is {} kN, on the {}; it grows with the assumed \
             stiffness of the contact.",
            significant(1e-3 * peak.most, 2),
            most.name
        ));
    }
    if !summary.inspection.is_empty() && room.some_fall.of_variants > 0 {
        let first: Vec<&String> = summary.inspection.iter().take(5).collect();
        all.push(format!("Stacks to inspect first, if they still stand: {}.", listed(first)));
    }
    all.extend(failed(summary.broken.len()));
    all
}

/// Returns the sentence on variants whose computation failed; `None` if there are none.
pub(crate) fn failed(count: usize) -> Option<String> {
    match u32::try_from(count).unwrap_or(u32::MAX) {
        0 => None,
        1 => Some("The computation of 1 variant failed; it is not counted.".to_owned()),
        many => Some(format!("The computation of {many} variants failed; they are not counted.")),
    }
}

/// Returns the sentence that states, over all variants, how many stacks fall.
fn falls(summary: &CellarSummary) -> String {
    let CellarSummary { room, counted: of, plan, .. } = summary;
    let all = standing(summary);
    if *of == 1 {
        let run = if summary.shown.variant == 0 { "as stated" } else { "one variant" };
        return format!(
            "This is a single run of the room ({run}); shares can be stated only for several variants."
        );
    }
    if all == 0 {
        return "All stacks had fallen before the run, so that none falls in it.".to_owned();
    }
    if plan.stacks == 1 {
        return format!("The stack falls in {}.", share(&room.some_fall, *of));
    }
    let stood = if all < plan.stacks { " that stood before the run" } else { "" };
    let of_shares = |share: &Mean| {
        let [low, high] = share.interval.map(percent);
        (percent(share.mean), low, high)
    };
    let (own, low, high) = of_shares(&room.share_by_themselves);
    let knocked = if room.knocked_over > 0.0 {
        let (knocked, low, high) = of_shares(&room.share_knocked_over);
        format!(", and {:.1} are knocked over ({knocked}, {low} to {high})", room.knocked_over)
    } else {
        ", and none is knocked over".to_owned()
    };
    format!(
        "At least one stack falls in {}. On average, {:.1} of {all} stacks{stood} fall by themselves ({own}, 95 % \
         interval {low} to {high}){knocked}.",
        share(&room.some_fall, *of),
        room.by_themselves,
    )
}

/// Formats the peak acceleration (m/s²) of a component of the ground motion in g, and its peak velocity (m/s) in
/// centimeters per second.
fn peaks(acceleration: f64, velocity: f64) -> String {
    format!("up to {:.2} g and {:.0} cm/s", acceleration / STANDARD_GRAVITY, 100.0 * velocity)
}

/// Describes an aisle over `of` variants: when the first barrel enters it, how much of it is covered at the end, and in
/// how many variants it is blocked. If no barrel enters the aisle in any variant, the sentence states only this.
fn of_aisle(aisle: &AisleAnswer, of: u32) -> String {
    let Some(first) = &aisle.first_barrel else {
        return format!("No barrel enters the aisle \"{}\".", aisle.name);
    };
    let fast = aisle.fastest.map_or(String::new(), |fast| {
        format!("; barrels in the aisle move at up to {:.1} m/s", fast.most)
    });
    format!(
        "The first barrel enters the aisle \"{}\" {} after the shaking starts{fast}. At the end, {} of the area of \
         the aisle is covered, and the aisle is blocked in {}.",
        aisle.name,
        span(first, aisle.entered.of_variants, 1, "s"),
        span_of_shares(&aisle.covered, of),
        share(&aisle.blocked, of),
    )
}

/// Formats the range of a share over `of` variants, in percent; one number if both ends round to the same number.
pub(crate) fn span_of_shares(range: &Range, of: u32) -> String {
    let [low, high] = range.stated(of).map(percent);
    if low == high { low } else { format!("{low} to {high}") }
}
