//! Sentences on how much the share of collapses varies with the uncertain constants of the seats.

use super::{Placed, percent};
use crate::variants::{ShareAt, Spread};

/// If the range of the share of collapses is at most this wide, the sentence states that the uncertain constants matter
/// little.
const NARROW: f64 = 0.1;

/// The share of collapses at the median of a constant is stated only if it is less than both shares at the 5 % and 95 %
/// fractiles, or greater than both, by at least this difference.
const BEYOND: f64 = 0.1;

/// Describes the range over which the share of collapses varies with the uncertain constants, and states which constant
/// changes it most: "Depending on the true values of the friction, stiffness and damping of the seats, which are
/// uncertain, 31 to 100 % of such stacks fall in the direction along the barrels (95 % range); the share of variants that
/// fall is an average over these values. The stiffness of seats changes this share most: …".
///
/// The interval of the share in the verdict has another meaning: it is the sampling error of the share of variants.
pub(super) fn depends_on((view, spread): Placed<'_>) -> Option<String> {
    let [low, high] = spread.range?;
    let place = view.map_or_else(String::new, |view| format!(" in the direction {}", view.words()));
    let (from, to) = (percent(low), percent(high));
    let range = format!("{} to {to}", from.trim_end_matches(" %"));
    if high - low <= NARROW {
        return Some(format!(
            "The friction, stiffness and damping of the seats are uncertain, but matter little: depending on \
             their true values, {range} of such stacks fall{place} (95 % range)."
        ));
    }
    let decisive = spread.decisive().and_then(|one| Some((one, one.low_median_high()?)));
    let which = decisive.map_or_else(
        || {
            let start = if view.is_some() { "In this direction, no" } else { "No" };
            format!(
                "{start} single one of these constants has a large and statistically significant effect."
            )
        },
        |(one, [low, median, high])| {
            // The share at the median is stated if it lies well outside the shares at both ends.
            let (least, most) = (low.share.min(high.share), low.share.max(high.share));
            let between = least - BEYOND < median.share && median.share < most + BEYOND;
            let stated = [Some(low), Some(median).filter(|_| !between), Some(high)];
            let words =
                |at: &ShareAt| format!("{} fall at {}", percent(at.share), one.words(at.value));
            let stated: Vec<String> = stated.into_iter().flatten().map(words).collect();
            format!("The {} changes this share most: {}.", one.name, stated.join(", "))
        },
    );
    Some(format!(
        "Depending on the true values of the friction, stiffness and damping of the seats, which are uncertain, {range} \
         of such stacks fall{place} (95 % range); the share of variants that fall is an average over these values. \
         {which}"
    ))
}

/// Describes the measurement that would narrow the range of the share of collapses most; `None` if no measurement would
/// narrow it.
pub fn measure(spread: &Spread) -> Option<String> {
    let [low, high] = spread.range?;
    let (one, left) = spread.worth_measuring()?;
    Some(format!(
        "To narrow the range of the share of stacks that fall, measure the {}: {}. On average, this measurement \
         narrows the range from {:.0} to {:.0} percentage points.",
        one.name,
        one.test()?,
        100.0 * (high - low),
        100.0 * left
    ))
}
