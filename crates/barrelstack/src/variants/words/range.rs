//! Sentences on the range of the share over the uncertain constants of the seats.

use super::{Placed, percent};
use crate::variants::{ShareAt, Spread};

/// Widest range of shares for which the uncertain constants are said to matter little.
const NARROW: f64 = 0.1;

/// Smallest distance of the share at the median from those at both ends for which it is stated, too.
const BEYOND: f64 = 0.1;

/// Describes the range of the share over the uncertain constants, and the decisive constant, such as
/// "Depending on the friction, stiffness and damping of the seats, which are uncertain, 31 to 100 %
/// fall along the barrels; the stiffness of seats decides: …".
pub(super) fn depends_on((view, spread): Placed<'_>) -> Option<String> {
    let [low, high] = spread.range?;
    let place = view.map_or_else(String::new, |view| format!(" {}", view.words()));
    let (from, to) = (percent(low), percent(high));
    let range = format!("{} to {to}", from.trim_end_matches(" %"));
    if high - low <= NARROW {
        return Some(format!(
            "The friction, stiffness and damping of the seats are uncertain, but matter little: {range} fall{place}."
        ));
    }
    let decisive = spread.decisive().and_then(|one| Some((one, one.low_median_high()?)));
    let which = decisive.map_or_else(
        || "none of these decides alone".to_owned(),
        |(one, [low, median, high])| {
            // The median is stated where the share does not change in one direction.
            let (least, most) = (low.share.min(high.share), low.share.max(high.share));
            let between = least - BEYOND < median.share && median.share < most + BEYOND;
            let stated = [Some(low), Some(median).filter(|_| !between), Some(high)];
            let words = |at: &ShareAt| format!("{} at {}", percent(at.share), one.words(at.value));
            let stated: Vec<String> = stated.into_iter().flatten().map(words).collect();
            format!("the {} decides: {}", one.name, stated.join(", "))
        },
    );
    Some(format!(
        "Depending on the friction, stiffness and damping of the seats, which are uncertain, {range} fall{place}; {which}."
    ))
}

/// Describes the measurement that narrows the range of the share most; `None` if no measurement
/// narrows it.
pub fn measure(spread: &Spread) -> Option<String> {
    let [low, high] = spread.range?;
    let (one, left) = spread.worth_measuring()?;
    Some(format!(
        "To narrow that range, measure the {}: {}. On average, this leaves a range of {:.0} percentage points instead of {:.0}.",
        one.name,
        one.test()?,
        100.0 * left,
        100.0 * (high - low)
    ))
}
