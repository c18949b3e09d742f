//! Describes a comparison of layouts in sentences, starting with the main result.

use barrelstack::variants::words::percent;
use barrelstack_report::{capital, measured, shortest};

use super::{CellarComparison, Change, Estimate, LayoutAnswer, LayoutPair, LeftOut};
use crate::plan::liters;
use crate::words::plural;

/// Returns the main result in one sentence or two. For two layouts, it states what changes from the first to the
/// second; for more layouts, it states which of them loses the smallest share of its barrels.
pub fn headline(found: &CellarComparison) -> String {
    if !found.unfinished.is_empty() {
        let done = found.layouts.len();
        let all = u32::try_from(done + found.unfinished.len()).unwrap_or(u32::MAX);
        return format!("Stopped after {done} of {}: there is no verdict.", plural(all, "layout"));
    }
    let effect = match (found.layouts.as_slice(), found.paired.as_slice()) {
        ([first, second], [pair]) => {
            let names = instead(&second.name, &first.name);
            match unpaired(first, second, pair) {
                Some(reason) => format!("{reason}."),
                None => format!("{names}: {}.", clause(first, second, pair)),
            }
        }
        ([first, _, ..], _) => best(found, first),
        _ => "Nothing is compared.".to_owned(),
    };
    let other = found.paired.iter().any(|pair| !pair.same_motion);
    let motions = if other {
        "The motions differ, so no difference is due to the layouts alone. "
    } else {
        ""
    };
    format!("{motions}{effect}")
}

/// Returns a sentence that states which layout loses the smallest share of its barrels.
fn best(found: &CellarComparison, first: &LayoutAnswer) -> String {
    let judged: Vec<_> = found.ranked().into_iter().filter(|(one, _)| one.counted > 0).collect();
    let many = judged.len();
    if judged.iter().all(|(one, _)| one.barrels_fallen.mean == 0.0) && many > 0 {
        return format!("No barrel falls in any of {many} layouts.");
    }
    match judged.first() {
        None => "No layout has a valid result.".to_owned(),
        Some((one, Some(pair))) if pair.variants == 0 => format!("{}.", unresolved(first, one)),
        Some((one, Some(pair))) if pair.share_lost.difference < 0.0 => format!(
            "Of {many} layouts, \"{}\" loses the fewest barrels for its capacity: {}.",
            one.name,
            clause(first, one, pair)
        ),
        Some(_) => format!(
            "None of {} other layouts loses fewer barrels for its capacity than \"{}\"; of the {} barrels of \
             that layout, {} {}{}.",
            many - 1,
            first.name,
            first.capacity,
            estimate(&first.barrels_fallen),
            if estimate(&first.barrels_fallen) == "1" { "falls" } else { "fall" },
            on_average(first.counted)
        ),
    }
}

/// Returns the reason why no variants of two layouts can be paired; `None` if there are pairs.
fn unpaired(first: &LayoutAnswer, second: &LayoutAnswer, pair: &LayoutPair) -> Option<String> {
    (pair.variants == 0).then(|| unresolved(first, second))
}

fn unresolved(first: &LayoutAnswer, second: &LayoutAnswer) -> String {
    match [first, second].into_iter().find(|one| one.counted == 0) {
        Some(one) => {
            format!("\"{}\" has no valid result, so nothing is compared with it", one.name)
        }
        None => format!(
            "\"{}\" and \"{}\" have no variant in common, so nothing is paired",
            first.name, second.name
        ),
    }
}

/// Returns a phrase that compares two names. If they begin with the same words, these are not repeated, as in "Spacing
/// 1 m instead of 0.3 m".
fn instead(second: &str, first: &str) -> String {
    let [own, its] = [second, first].map(|name| name.split(' ').collect::<Vec<_>>());
    let alike = own.iter().zip(&its).take_while(|(one, two)| one == two).count();
    if alike == 0 || alike == own.len().min(its.len()) {
        return compared(second, first);
    }
    format!("{} instead of {}", capital(second), its[alike..].join(" "))
}

fn compared(second: &str, first: &str) -> String {
    format!("{}, compared with \"{first}\"", capital(second))
}

/// Returns a clause that compares the numbers of barrels that fall in the two layouts of a pair.
fn clause(first: &LayoutAnswer, second: &LayoutAnswer, pair: &LayoutPair) -> String {
    let Change { first: from, second: to, difference, .. } = pair.barrels_fallen;
    if from == 0.0 && to == 0.0 {
        return format!("no barrel falls in either layout, in {}", variants(pair));
    }
    let average = on_average(pair.variants);
    if first.capacity == second.capacity {
        return format!(
            "{} instead of {}{average}, {} ({})",
            fall(to, ""),
            amount(from),
            words_of(difference, ["fewer", "more", "as many"]),
            interval(&pair.barrels_fallen, 1.0, ["fewer", "more"], pair)
        );
    }
    let points = 100.0 * pair.share_lost.difference;
    let [lost, before] = [pair.share_lost.second, pair.share_lost.first].map(percent);
    format!(
        "{} instead of {} of {}{average}; that is {lost} of the capacity instead of {before}, {} ({})",
        fall(to, &format!("of {} ", second.capacity)),
        amount(from),
        first.capacity,
        words_of(points, ["percentage points less", "percentage points more", "as much"]),
        interval(&pair.share_lost, 100.0, ["less", "more"], pair)
    )
}

/// Returns a clause such as "5 of 16 barrels fall"; `of` is the text between number and noun, such as "of 16 ".
fn fall(barrels: f64, of: &str) -> String {
    let shown = amount(barrels);
    if shown == "1" {
        return if of.is_empty() {
            "1 barrel falls".to_owned()
        } else {
            format!("1 {of}barrels falls")
        };
    }
    format!("{shown} {of}barrels fall")
}

/// Formats a difference, such as "3.2 fewer": its magnitude, followed by `less` or `more`. The result is `same` if the
/// magnitude is rounded to zero.
fn words_of(difference: f64, [less, more, same]: [&str; 3]) -> String {
    match amount(difference.abs()) {
        none if none == "0" => same.to_owned(),
        some => format!("{some} {}", if difference < 0.0 { less } else { more }),
    }
}

/// Returns the confidence interval of a change, multiplied by `scale`, and the number of pairs in words. If the
/// interval includes zero, the words state that the difference is not significant.
fn interval(change: &Change, scale: f64, [less, more]: [&str; 2], pair: &LayoutPair) -> String {
    let pairs = variants(pair);
    let Some([low, high]) = change.interval.map(|both| both.map(|bound| scale * bound)) else {
        return format!("{pairs}, which gives no interval");
    };
    let bounds = |low: f64, high: f64| format!("95 % interval {} to {}", amount(low), amount(high));
    if low > 0.0 {
        format!("{}, {pairs}", bounds(low, high))
    } else if high < 0.0 {
        format!("{}, {pairs}", bounds(-high, -low))
    } else {
        format!(
            "95 % interval {} {less} to {} {more}, {pairs}: the difference is not significant",
            amount(-low),
            amount(high)
        )
    }
}

/// Describes the variants for which two layouts are compared, such as "the same 8 variants".
fn variants(pair: &LayoutPair) -> String {
    match (pair.variants, pair.same_draws) {
        (1, _) => "one variant".to_owned(),
        (many, true) => format!("the same {many} variants"),
        (many, false) => format!("{many} variants with different draws"),
    }
}

fn on_average(variants: u32) -> &'static str {
    if variants > 1 { " on average" } else { "" }
}

/// Formats a mean with at most one decimal place.
pub(super) fn amount(value: f64) -> String {
    shortest((10.0 * value).round() / 10.0)
}

/// Formats a mean with its confidence interval, such as "12.4 (8 to 20)".
pub(super) fn estimate(one: &Estimate) -> String {
    let mean = amount(one.mean);
    one.interval.map_or_else(
        || mean.clone(),
        |[low, high]| format!("{mean} ({} to {})", amount(low), amount(high)),
    )
}

/// Returns the sentences that support the headline. If the work was stopped, only the changes that were not run are
/// listed.
pub fn sentences(found: &CellarComparison) -> Vec<String> {
    let mut all = Vec::new();
    if found.unfinished.is_empty() {
        let first = &found.layouts[0];
        let ranked = found.ranked();
        all.extend(ranked.iter().map(|(one, _)| describe(one)));
        let pairs = || ranked.iter().filter_map(|(one, pair)| Some((*one, (*pair)?)));
        if found.paired.len() > 1 {
            all.extend(pairs().map(|(one, pair)| match unpaired(first, one, pair) {
                Some(reason) => format!("{reason}."),
                None => {
                    format!("{}: {}.", compared(&one.name, &first.name), clause(first, one, pair))
                }
            }));
            if pairs().any(|(_, pair)| pair.barrels_fallen.interval.is_some()) {
                all.push(
                    "The confidence level of 95 % applies to the intervals of all these differences jointly."
                        .to_owned(),
                );
            }
        }
        all.extend(pairs().filter_map(|(_, pair)| without(pair)));
        if found.layouts.iter().any(|one| one.cut.is_some()) {
            all.push(
                "Runs end before their motion does, so a stack that stands at the end may still fall later."
                    .to_owned(),
            );
        }
    }
    all.extend(found.left_out.iter().map(|one| {
        let LeftOut { name, reason } = one;
        format!("The layout \"{name}\" was not run, because {reason}.")
    }));
    all
}

fn describe(one: &LayoutAnswer) -> String {
    let LayoutAnswer { name, capacity, stacks, share_lost, .. } = one;
    if one.counted == 0 {
        return format!("{}: no run has a valid result.", capital(name));
    }
    if [one.barrels_fallen, one.by_themselves, one.knocked_over].iter().all(|of| of.mean == 0.0) {
        return format!("{}: of {capacity} barrels in {stacks} stacks, none falls.", capital(name));
    }
    let share = percent(share_lost.mean);
    let share = share_lost.interval.map_or_else(
        || share.clone(),
        |both| {
            let [low, high] = both.map(percent);
            format!("{share}, 95 % interval {low} to {high}")
        },
    );
    let spread = one.spread.map_or_else(String::new, |spread| {
        format!("; for each stack that falls by itself, {} fall in total", amount(spread))
    });
    let [low, high] = one.cost.map(|dollars| measured(dollars, 0));
    let fallen = amount(one.barrels_fallen.mean);
    let fall = if fallen == "1" { "falls" } else { "fall" };
    let alone = match estimate(&one.by_themselves) {
        only if only == "1" => "1 falls by itself".to_owned(),
        some => format!("{some} fall by themselves"),
    };
    let knocked = match estimate(&one.knocked_over) {
        only if only == "1" => "1 is knocked over".to_owned(),
        some => format!("{some} are knocked over"),
    };
    format!(
        "{}: of {capacity} barrels, {fallen} {fall}{} ({share}). Of {stacks} stacks, {alone} and \
         {knocked}{spread}. About {} of wine is lost; the wine and the burst barrels are worth US${low} to US${high}.",
        capital(name),
        on_average(one.counted),
        liters(one.wine_lost),
    )
}

/// Returns a sentence that states how many variants are left out of the pairs; `None` if there are none.
fn without(pair: &LayoutPair) -> Option<String> {
    let count = u32::try_from(pair.left_out.len()).unwrap_or(u32::MAX);
    let (has, are) = if count == 1 { ("has", "it is") } else { ("have", "they are") };
    (count > 0).then(|| {
        format!(
            "{} {has} no valid result in \"{}\" or \"{}\"; {are} left out of the pairs.",
            capital(&plural(count, "variant")),
            pair.first,
            pair.second
        )
    })
}
