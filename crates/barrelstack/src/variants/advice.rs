//! Describes the [`Remedy`] of a stack, the changes that would keep it standing, in sentences, a table and a plot.

use barrelstack_report::{
    Axis, Block, Cell, Figure, Mark, Plot, Series, SeriesStyle, Table, capital,
};

use super::remedy::{Remedy, Tried};
use super::words::percent;
use crate::scenario::title::{counted, number};

/// Phrase for the uncertain constants of the seats.
const CONSTANTS: &str = "the friction, stiffness and damping of the seats, which are uncertain";

impl Remedy {
    /// Describes the remedy, or states that none of the changes that were tried suffices.
    pub fn sentence(&self) -> String {
        let any = |kind: &str| self.tried.iter().any(|one| one.kind == kind);
        let straps = self.pretensions();
        let sentence = match (&self.height, &self.straps) {
            (Some(height), Some(straps)) if share(height) == share(straps) => {
                format!(
                    "a stack of {}, or of {}, would have stood in {}",
                    name(height),
                    name(straps),
                    share(height)
                )
            }
            (Some(height), Some(straps)) => format!(
                "a stack of {} would have stood in {}, and a stack of {} in {}",
                name(height),
                share(height),
                name(straps),
                share(straps)
            ),
            (None, Some(straps)) if any("height") => format!(
                "a stack of {} would have stood in {}; fewer levels without straps would not have been enough",
                name(straps),
                share(straps)
            ),
            (Some(one), None) | (None, Some(one)) => {
                format!("a stack of {} would have stood in {}", name(one), share(one))
            }
            (None, None) if !self.complete => {
                return "The changes that would have kept the stack up are not known, because the search was stopped."
                    .to_owned();
            }
            (None, None) => {
                return match (any("height"), any("straps")) {
                    (true, true) => format!(
                        "Neither fewer levels (down to one) nor straps tightened to {straps} would have kept the \
                         stack up."
                    ),
                    (true, false) => {
                        "Fewer levels (down to one) would not have kept the stack up.".to_owned()
                    }
                    (false, _) => {
                        format!("Straps tightened to {straps} would not have kept the stack up.")
                    }
                };
            }
        };
        let stopped =
            if self.complete { "" } else { " The search for further changes was stopped." };
        let confidence = self.confidence(!self.over_constants(CONSTANTS).is_empty());
        // The sentence before names the constants, if there is one.
        let constants = if confidence.is_empty() { CONSTANTS } else { "these constants" };
        format!(
            "{}.{}{confidence}{}{stopped}",
            capital(&sentence),
            self.not_enough(),
            self.over_constants(constants)
        )
    }

    /// If a lower stack suffices, names the changes that were tried and would not have been enough: the stacks with
    /// more levels than the sufficient stack, and the straps if none of their pretensions suffices. Empty if no lower
    /// stack suffices, or if there are no such changes.
    fn not_enough(&self) -> String {
        let Some(height) = &self.height else { return String::new() };
        let higher = self
            .tried
            .iter()
            .filter(|one| one.kind == "height" && one.levels > height.levels && one.is_rejected());
        let higher: Vec<u32> = higher.map(|one| one.levels).collect();
        let range = higher.iter().min().zip(higher.iter().max());
        let levels = range.map(|(least, most)| match most - least {
            0 => format!("a stack of {}", counted(*least, "level")),
            1 => format!("a stack of {} or {} levels", number(*least), number(*most)),
            _ => format!("a stack of {} to {} levels", number(*least), number(*most)),
        });
        let strapped = self.tried.iter().any(|one| one.kind == "straps");
        let straps = (self.straps.is_none() && self.complete && strapped)
            .then(|| format!("straps tightened to {}", self.pretensions()));
        let what = match (levels, straps, &self.straps) {
            (Some(levels), Some(straps), _) => format!("{levels}, or {straps},"),
            (Some(levels), None, Some(_)) => format!("{levels} without these straps"),
            (Some(one), None, None) | (None, Some(one), _) => one,
            (None, None, _) => return String::new(),
        };
        format!(" {} would not have been enough.", capital(&what))
    }

    /// States, for each sufficient change, the 95 % range of the share of stacks that fall, as the uncertain constants
    /// vary. Returns an empty string if a range is unknown.
    ///
    /// If two changes suffice, compares them draw by draw over random draws of these constants: names the change with
    /// which fewer stacks fall in most of the draws, and states the share of these draws. `constants` is the phrase for
    /// the constants.
    fn over_constants(&self, constants: &str) -> String {
        let range = |one: &Tried| {
            one.range.map(|[low, high]| format!("{:.0} to {:.0} %", 100.0 * low, 100.0 * high))
        };
        let said = match (&self.height, &self.straps) {
            (Some(height), Some(straps)) => match (range(height), range(straps)) {
                (Some(one), Some(other)) if one == other => {
                    format!("{one} of stacks with either change")
                }
                (Some(one), Some(other)) => {
                    format!(
                        "{one} of stacks with the first change and {other} of stacks with the second"
                    )
                }
                _ => return String::new(),
            },
            (Some(one), None) | (None, Some(one)) => match range(one) {
                Some(range) => format!("{range} of stacks with {}", name(one)),
                None => return String::new(),
            },
            (None, None) => return String::new(),
        };
        let both = self.height.as_ref().zip(self.straps.as_ref());
        let order = both.zip(self.height_before_straps).map(|((height, straps), share)| {
            let (better, worse, share) = match share {
                share if share < 0.5 => (straps, height, 1.0 - share),
                share => (height, straps, share),
            };
            format!(
                "; fewer stacks fall with {} than with {} in {} of the random draws of these constants",
                name(better),
                name(worse),
                percent(share)
            )
        });
        format!(
            " Depending on the true values of {constants}, {said} would fall (95 % range){}.",
            order.unwrap_or_default()
        )
    }

    /// States, for each sufficient change, the upper confidence bound of the share of stacks that fall, adjusted for
    /// the number of candidates. If `averaged` is set, the sentence adds that this share is an average over the
    /// uncertain constants, because the next sentence states the range over these constants.
    fn confidence(&self, averaged: bool) -> String {
        let at_most = |one: &Tried| one.interval.map(|[_, high]| percent(high));
        let most = match (&self.height, &self.straps) {
            (Some(height), Some(straps)) => match (at_most(height), at_most(straps)) {
                (Some(height), Some(straps)) if height == straps => {
                    format!("{height} of stacks with either change")
                }
                (Some(height), Some(straps)) => {
                    format!(
                        "{height} of stacks with the first change and {straps} of stacks with the second"
                    )
                }
                _ => return String::new(),
            },
            (Some(one), None) | (None, Some(one)) => match at_most(one) {
                Some(most) => format!("{most} of stacks with {}", name(one)),
                None => return String::new(),
            },
            (None, None) => return String::new(),
        };
        let choice = match self.candidates {
            0 | 1 => String::new(),
            many => format!(", corrected for testing up to {many} changes"),
        };
        if averaged {
            format!(
                " On average over {CONSTANTS}, at most {most} would fall (95 % confidence{choice})."
            )
        } else {
            format!(" At most {most} would fall (95 % confidence{choice}).")
        }
    }

    /// Returns the pretensions of the straps that were tried, such as "3, 4 or 5 kN".
    fn pretensions(&self) -> String {
        let tried = self.tried.iter().filter_map(|one| one.pretension);
        let tried: Vec<String> = tried.map(|pretension| (1e-3 * pretension).to_string()).collect();
        match tried.split_last() {
            Some((last, others)) if !others.is_empty() => {
                format!("{} or {last} kN", others.join(", "))
            }
            _ => format!("{} kN", tried.concat()),
        }
    }

    /// Returns a plot and a table of all changes; `as_it_is` is the share of variants that fall without a change.
    pub fn blocks(&self, as_it_is: Option<f64>, in_planes: bool) -> Vec<Block> {
        if self.tried.is_empty() {
            return Vec::new();
        }
        vec![Block::Figure(self.figure(as_it_is)), Block::Table(self.table(in_planes))]
    }

    /// Plots the share of variants that fall after every change; `as_it_is` is this share without a change.
    fn figure(&self, as_it_is: Option<f64>) -> Figure {
        let percent = |share: f64| 100.0 * share;
        // If not all variants were run, at least this share of all variants falls.
        let least = |one: &Tried| percent(f64::from(one.failed) / f64::from(self.variants.max(1)));
        let rows = || self.tried.iter().enumerate();
        let intervals = rows().filter_map(|(row, one)| Some((row, one.interval?.map(percent))));
        let bars = Series::bars("95 % intervals that hold for all changes at once", intervals);
        let points = |label: &str, index: usize, known: bool| {
            let shown = rows().filter(|(_, one)| one.share.is_some() == known);
            let (x, y) = shown.map(|(row, one)| (least(one), Axis::row(row))).unzip();
            let style = SeriesStyle { points: true, index: Some(index), ..SeriesStyle::default() };
            Series { style, ..Series::new(label, x, y) }
        };
        let series = [
            bars,
            points("all variants", 2, true),
            points("not all variants were run: at least this share", 1, false),
        ];
        let mark = |at: f64, label: &str| Mark { at: percent(at), label: label.into() };
        let limit = mark(1.0 - self.required_share, "limit");
        Figure::new(
            "remedy",
            "Share of the variants that fall with each change, for the direction of shaking in which more of them \
             fall. All changes were tried with the same variants.",
            Plot {
                x: Axis { range: Some([-2.0, 102.0]), ..Axis::new("variants that fall", "%") },
                y: Axis::named(self.tried.iter().map(name).collect()),
                series: series.into_iter().filter(|one| !one.x.is_empty()).collect(),
                marks: as_it_is.map(|at| mark(at, "as it is")).into_iter().chain([limit]).collect(),
                ..Plot::default()
            },
        )
    }

    /// Tabulates every change that was tried. If `in_planes` is set, the wording is for planar models, otherwise for
    /// three-dimensional models.
    pub fn table(&self, in_planes: bool) -> Table {
        let [stand, tried] =
            if in_planes { [" in every plane", ", in every plane"] } else { [""; 2] };
        let caption = format!(
            "Changes that were tried, all of them with the same variants. A change suffices if at least {:.0} % of the \
             variants stand{stand}. The variants are run in blocks, beginning with the variants that are likely to \
             fall. After each block, a change is rejected if too many variants have fallen; the share of stacks that \
             fall with a rejected change is therefore not known. The intervals hold simultaneously, with 95 % \
             confidence, for all {} changes that may be tried{tried}. If friction, stiffness and damping of the seats \
             are drawn from their distributions, the share of stacks that fall lies within the range over the \
             uncertain constants with a probability of 95 %. The range includes the sampling error. The last column \
             gives the share of random draws of the uncertain constants in which fewer stacks fall with the change \
             than without it; the same draws are used for every change. Straps are assumed not to slip on the barrels \
             and racks that they tie.",
            100.0 * self.required_share,
            self.candidates
        );
        let verdict = |one: &Tried| match one.suffices {
            Some(true) => "yes",
            Some(false) => "no",
            None => "not known",
        };
        Table::of(
            caption,
            &self.tried,
            &[
                ("change", "", &|one| Cell::text(name(one))),
                ("fall", "", &|one| Cell::text(self.falls(one))),
                ("share of stacks that fall, with its 95 % interval", "", &|one| {
                    Cell::maybe(one.share.zip(one.interval).map(|(share, interval)| {
                        format!("{} ({})", percent(share), interval.map(percent).join(" to "))
                    }))
                }),
                ("suffices", "", &|one| Cell::text(verdict(one))),
                ("range over the uncertain constants", "", &|one| {
                    Cell::maybe(one.range.map(|range| range.map(percent).join(" to ")))
                }),
                ("draws in which fewer stacks fall than without the change", "", &|one| {
                    Cell::maybe(one.better_than_as_it_is.map(percent))
                }),
            ],
        )
    }
}

impl Remedy {
    /// Describes the number of failures, such as "1 of 64 variants" or "at least 4 of 64 variants".
    fn falls(&self, tried: &Tried) -> String {
        let Tried { variants, failed, share, .. } = tried;
        match share {
            Some(_) => format!("{failed} of {variants} variants"),
            None if *failed == 0 => "not known".to_owned(),
            None => format!("at least {failed} of {} variants", self.variants),
        }
    }
}

/// Returns the name of a change that was tried, such as "three levels" or "five levels held together by straps
/// tightened to 4 kN".
pub(super) fn name(tried: &Tried) -> String {
    name_of(tried.levels, tried.pretension)
}

/// Returns the name of a stack with a number of levels and with straps of a pretension (N), if it has any.
pub(super) fn name_of(levels: u32, pretension: Option<f64>) -> String {
    match pretension {
        None => counted(levels, "level"),
        Some(pretension) if levels == 1 => {
            format!(
                "one level whose barrels are held to their racks by straps tightened to {} kN",
                1e-3 * pretension
            )
        }
        Some(pretension) => {
            format!(
                "{} levels held together by straps tightened to {} kN",
                number(levels),
                1e-3 * pretension
            )
        }
    }
}

/// Describes how many variants stand, such as "63 of 64 variants".
fn share(tried: &Tried) -> String {
    let Tried { variants, failed, .. } = tried;
    if *failed == 0 {
        format!("all {variants} variants")
    } else {
        format!("{} of {variants} variants", variants - failed)
    }
}
