//! The usual changes: a fixed list of changes to a room that may reduce the losses, or keep a collapse from spreading
//! to other stacks. Changes that are not possible are listed with the reason.

use barrelstack::RunFailure;
use barrelstack::device::WalkingStops;
use barrelstack::scenario::error::ScenarioError;
use barrelstack::variants::{PRETENSIONS, lowered, strapped_together};
use barrelstack_report::shortest;

use crate::plan::{Plan, meters};
use crate::scenario::{Block, Cellar};

/// Clearance (m) between the stacks of a row in the layout with wider spacing. If it does not fit, a search finds the
/// largest clearance that fits.
const WIDE: f64 = 1.0;

/// Resolution of the search for the largest clearance that fits: number of steps per meter.
const PER_METER: f64 = 100.0;

/// One of the usual changes to a room, with the cellar that results from it.
#[derive(Clone, Debug)]
pub struct Usual {
    /// Name, such as "one level less".
    pub name: String,
    /// The changed cellar, or the reason why there is none.
    pub changed: Result<Cellar, String>,
}

/// Applies each of the usual changes to a cellar: wider spacing, all levels strapped together, stops under every rack,
/// one level less, and every stack turned by 90°.
pub fn usual(cellar: &Cellar) -> Vec<Usual> {
    let (spacing, wider) = spaced(cellar);
    let pretension = PRETENSIONS[PRETENSIONS.len() - 1];
    let strapped = format!(
        "all levels held together by straps tightened to {} kN",
        shortest(1e-3 * pretension)
    );
    let all = [
        (spacing, wider),
        (strapped, strapped_at(cellar, pretension).and_then(|by| fitting(cellar, &by))),
        ("stops under every rack".to_owned(), stopped(cellar).and_then(|by| fitting(cellar, &by))),
        ("one level less".to_owned(), lower(cellar).and_then(|by| fitting(cellar, &by))),
        ("every stack turned by 90°".to_owned(), fitting(cellar, &turned(cellar))),
    ];
    all.into_iter().map(|(name, changed)| Usual { name, changed }).collect()
}

/// Returns the cellar with the changes, or the reason why the changed cellar is invalid or its stacks do not fit into
/// the room.
fn fitting(cellar: &Cellar, changes: &[String]) -> Result<Cellar, String> {
    let reason = |error: &ScenarioError| error.problem().to_string();
    let count = cellar.stated().imperfections().map_or(0, |own| own.variants);
    let changed = cellar.with(changes).map_err(|error| reason(&error))?.with_variants(count);
    let plan = Plan::of(&changed).map_err(|error: RunFailure| error.to_string())?;
    match plan.problems.first() {
        Some((error, _)) => Err(reason(error)),
        None => Ok(changed),
    }
}

/// Returns the name and the layout with wider spacing: 1 m between the stacks of each row, or the largest distance that
/// fits.
fn spaced(cellar: &Cellar) -> (String, Result<Cellar, String>) {
    let rows = |block: &&Block| block.stacks > 1;
    let name = |spacing: f64| format!("spacing {} m", shortest(spacing));
    let Some(least) = cellar.blocks.iter().filter(rows).map(|one| one.spacing).reduce(f64::min)
    else {
        return (name(WIDE), Err("no row has two stacks to move apart".to_owned()));
    };
    if least >= WIDE {
        let reason = format!("the stacks of every row stand {} apart already", meters(least));
        return (name(WIDE), Err(reason));
    }
    let at = |spacing: f64| {
        let narrow = |(at, block): (u32, &Block)| {
            let narrow = block.stacks > 1 && block.spacing < spacing;
            narrow.then(|| format!("block.{at}.spacing=\"{spacing} m\""))
        };
        fitting(cellar, &(1..).zip(&cellar.blocks).filter_map(narrow).collect::<Vec<_>>())
    };
    let reason = match at(WIDE) {
        Ok(wide) => return (name(WIDE), Ok(wide)),
        Err(reason) => reason,
    };
    // If a spacing fits, all narrower ones fit as well, so bisection finds the widest.
    let (mut fits, mut too_wide) = ((least * PER_METER).floor(), WIDE * PER_METER);
    let mut widest = None;
    while too_wide - fits > 1.0 {
        let middle = (0.5 * (fits + too_wide)).floor();
        match at(middle / PER_METER) {
            Ok(found) => (fits, widest) = (middle, Some((middle / PER_METER, found))),
            Err(_) => too_wide = middle,
        }
    }
    match widest {
        Some((spacing, found)) => (format!("{}, the widest that fits", name(spacing)), Ok(found)),
        None => (name(WIDE), Err(reason)),
    }
}

/// `true` if every stack has a single level.
fn is_low(cellar: &Cellar) -> bool {
    cellar.models.iter().all(|model| model.stack().is_none_or(|stack| stack.levels < 2))
}

/// Returns the changes that strap all levels together.
fn strapped_at(cellar: &Cellar, pretension: f64) -> Result<Vec<String>, String> {
    if is_low(cellar) {
        return Err("stacks of one level have no levels to strap together".to_owned());
    }
    strapped_together(cellar.stated(), pretension).ok_or_else(|| {
        "the levels already have straps at least this tight, or the straps would tear".to_owned()
    })
}

/// Returns the changes that add stops under every rack. The stops hold the rack on the barrels below in both horizontal
/// directions.
fn stopped(cellar: &Cellar) -> Result<Vec<String>, String> {
    if is_low(cellar) {
        return Err("stacks of one level have no rack on barrels".to_owned());
    }
    if cellar.stated().stack().is_some_and(|stack| stack.devices.walking_stop.is_on()) {
        return Err("the racks have stops already".to_owned());
    }
    // The stops of the last candidate hold racks in both horizontal directions.
    let stops = WalkingStops::WORDS.candidates.last();
    let overrides = stops.map(|setting| setting.overrides).unwrap_or_default();
    Ok(overrides.iter().map(|&change| change.to_owned()).collect())
}

/// Returns the changes that remove one level from every stack.
fn lower(cellar: &Cellar) -> Result<Vec<String>, String> {
    let own = cellar.stated().stack().map_or(0, |stack| stack.levels);
    let mut changes = Vec::new();
    for (at, block) in (1..).zip(&cellar.blocks) {
        let by_row = &block.levels_by_row;
        let least = by_row.iter().copied().min().or(block.levels).unwrap_or(own);
        if least < 2 {
            return Err("a stack of one level cannot lose a level".to_owned());
        }
        if !by_row.is_empty() {
            let fewer: Vec<String> = by_row.iter().map(|levels| (levels - 1).to_string()).collect();
            changes.push(format!("block.{at}.levels_by_row=[{}]", fewer.join(", ")));
        } else if let Some(levels) = block.levels {
            changes.push(format!("block.{at}.levels={}", levels - 1));
        } else if !changes.iter().any(|change| change.starts_with("stack.levels=")) {
            changes.extend(lowered(cellar.stated(), own - 1).into_iter().flatten());
        }
    }
    Ok(changes)
}

/// Returns the changes that turn every stack by 90°.
fn turned(cellar: &Cellar) -> Vec<String> {
    let turned = |(at, block): (u32, &Block)| {
        let degrees = (1e9 * block.azimuth.to_degrees()).round() / 1e9 + 90.0;
        let degrees = if degrees > 180.0 { degrees - 360.0 } else { degrees };
        format!("block.{at}.azimuth=\"{degrees} deg\"")
    };
    (1..).zip(&cellar.blocks).map(turned).collect()
}
