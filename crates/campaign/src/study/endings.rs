//! Endings of the cases of a study: how many cases were followed until nothing moved, and how many were stopped
//! earlier.

use std::fmt::Write as _;

use std::collections::BTreeSet;

use barrelstack_report::described;

use super::Study;
use super::error::StudyError;
use super::motions::{MotionCache, Shaking, Synthetic};
use super::table::StudyTable;
use crate::scenario::Until;
use crate::watch::{Ending, after_collapse};

/// Numbers of cases with a verdict: those that were followed until nothing moved, and those that were stopped earlier.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Endings {
    /// Total number of cases with a verdict.
    pub judged: u64,
    /// Number of cases that were simulated until nothing moved and the ground was still. After a collapse, or if only
    /// the verdict is requested, the ground need not be still. It must then be calm, with an acceleration that remains
    /// at most 0.02 g, or less if a friction coefficient is small.
    ///
    /// Includes cases whose stack fell under its own weight, before any shaking.
    pub followed: u64,
    /// Number of cases that were stopped at a fixed time after their collapse, as the study specifies.
    pub stopped: u64,
    /// Number of cases that ended because the specified duration had elapsed (`run.duration`).
    pub short: u64,
    /// Number of the cases in `short` in which the ground still moved at the end.
    pub cut: u64,
    /// Number of the cases in `cut` in which the stack still stood at the end.
    pub open: u64,
    /// Duration (s) of the part of the motion that was not simulated: the maximum over the cases in `cut`.
    pub longest_cut: f64,
    /// Number of cases in which something still moved at the time limit of the study.
    pub moving: u64,
}

impl Endings {
    /// Adds the cases of a table.
    pub fn add(&mut self, table: &StudyTable) {
        let (Some(outcomes), Some(ended), Some(left)) =
            (table.texts("outcome"), table.texts("ended"), table.numbers("motion_left"))
        else {
            return;
        };
        for ((outcome, ended), left) in outcomes.iter().zip(ended).zip(left) {
            let outcome = outcome.as_deref().unwrap_or("");
            if !matches!(outcome, "stable" | "collapse") {
                continue;
            }
            let is = |ending: Ending| u64::from(ended.as_deref() == Some(ending.name()));
            let left = left.unwrap_or(0.0);
            self.judged += 1;
            self.followed += is(Ending::Rest) + is(Ending::NotShaken);
            self.stopped += is(Ending::AfterCollapse);
            self.short += is(Ending::Duration);
            self.moving += is(Ending::Patience);
            if left > 0.0 && is(Ending::Duration) > 0 {
                self.cut += 1;
                self.open += u64::from(outcome == "stable");
                self.longest_cut = self.longest_cut.max(left);
            }
        }
    }

    /// Maximum share of cases in which something still moves at the time limit. If the share is larger, no
    /// losses are reported.
    const MOST_MOVING: f64 = 0.02;

    /// Returns the reason why no losses are reported: the falls in some cases are not known. Returns `None` if losses
    /// are reported.
    pub fn no_losses(&self) -> Option<String> {
        let Self { judged, stopped, short, moving, .. } = *self;
        let were = |count: u64| if count == 1 { "was" } else { "were" };
        if stopped > 0 {
            let were = were(stopped);
            return Some(format!(
                "{stopped} of {judged} cases {were} stopped a fixed time after the collapse \
                 (run.stop_after_collapse, or run.until = \"verdict\"), before everything had fallen; omit these \
                 settings to follow every case until nothing moves"
            ));
        }
        if short > 0 {
            let were = were(short);
            return Some(format!(
                "{short} of {judged} cases {were} ended by run.duration before everything had come to rest; omit this \
                 setting to follow every case until nothing moves"
            ));
        }
        (moving as f64 > Self::MOST_MOVING * judged as f64).then(|| {
            format!(
                "in {moving} of {judged} cases something still moved at the time limit; use a \
                 longer run.patience to follow them to the end"
            )
        })
    }

    /// Returns warnings for the reader of results; empty if every case was followed to its end.
    pub fn sentences(&self) -> Vec<String> {
        let mut said = Vec::new();
        if self.cut > 0 {
            let were = if self.cut == 1 { "was" } else { "were" };
            said.push(format!(
                "{} of {} cases {were} cut short by run.duration while the ground still moved, and up to {:.1} s of a \
                 motion were not run; {} of the stacks stood until then, and the effect of the rest of their motions \
                 is not known. Omit run.duration to run every motion to its end.",
                self.cut, self.judged, self.longest_cut, self.open
            ));
        }
        if let Some(reason) = self.no_losses() {
            said.push(format!("No losses are given: {reason}."));
        } else if self.moving > 0 {
            said.push(format!(
                "In {} of {} cases something still moved at the time limit; losses are given for the other cases \
                 only.",
                self.moving, self.judged
            ));
        }
        said
    }
}

described! {
    /// Conditions under which the cases of a study end.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Following {
        /// `true` if a case is followed until nothing moves.
        pub to_rest: bool,
        /// `true` if a case ends as soon as its verdict is known.
        pub by_verdict: bool,
        /// Time limit (s), counted from the end of the motion, for cases that do not end before.
        pub patience: f64 as "s",
        /// Duration (s) of the cases if the study states one; none if the duration follows from the motion.
        pub duration: Option<f64> as "s",
        /// Time (s) after a collapse at which the study stops a case; none if the study states no such time.
        pub after_collapse: Option<f64> as "s",
        /// Names of the motions that are longer than the duration.
        pub cut: Vec<String>,
        /// Longest time (s) by which one of these motions outlasts the duration; 0 if there are none.
        pub longest_cut: f64 as "s",
    }
}

impl Study {
    /// Returns the conditions under which the cases end, and the motions that are cut short.
    ///
    /// # Errors
    /// If a motion cannot be read.
    pub fn following(&self) -> Result<Following, StudyError> {
        let base = self.scenario(&[])?;
        let (run, cache) = (&base.run, MotionCache::default());
        let mut found = Following {
            to_rest: run.until == Until::Rest,
            by_verdict: run.until == Until::Verdict,
            patience: run.patience,
            duration: run.duration,
            after_collapse: Some(after_collapse(&base)).filter(|after| after.is_finite()),
            cut: Vec::new(),
            longest_cut: 0.0,
        };
        if let Some(duration) = run.duration {
            let mut named = BTreeSet::new();
            let mut last: Option<(&Synthetic, f64)> = None;
            for motion in &self.motions {
                let made = match &motion.shaking {
                    Shaking::Synthetic(made) => Some(&**made),
                    Shaking::Base | Shaking::Spec(_) => None,
                };
                // An ensemble may have a hundred thousand realizations, all with the same duration, so only the first
                // is made.
                let end = match (made, last) {
                    (Some(made), Some((other, end))) if made.is_of_ensemble(other) => end,
                    _ => cache.unscaled(motion, &base.motion, run.similitude)?.ground.end(),
                };
                last = made.map(|made| (made, end));
                let left = end / run.similitude.sqrt() - duration;
                if left > crate::run::CUT && named.insert(&motion.name) {
                    found.cut.push(motion.name.clone());
                    found.longest_cut = found.longest_cut.max(left);
                }
            }
        }
        Ok(found)
    }
}

impl Following {
    /// Describes in a sentence when the cases end; `motions` is the number of motions of the study.
    pub fn words(&self, motions: usize) -> String {
        let mut said = match self.duration {
            None if self.to_rest => format!(
                "every case is followed to the end of its motion (after a collapse, until the ground acceleration \
                 stays below 0.02 g), and then until nothing moves, for at most {} s more",
                self.patience
            ),
            None if self.by_verdict => format!(
                "every case is followed until its verdict is known; a stack that stands is followed until it is at \
                 rest and the ground acceleration stays below 0.02 g, at most until {} s after the end of its motion",
                self.patience
            ),
            None => "every case is followed to the end of its motion and for 5 s more".to_owned(),
            Some(duration) if self.cut.is_empty() => {
                format!("no case is followed longer than {duration} s (run.duration)")
            }
            Some(duration) => format!(
                "every case ends at {duration} s (run.duration), while the ground still moves under {} of \
                 {motions} motions, for up to {:.1} s more",
                self.cut.len(),
                self.longest_cut
            ),
        };
        if let Some(after) = self.after_collapse {
            let _ = write!(
                said,
                "; a case that collapses is stopped {after} s later, so that losses \
                 are not known"
            );
        }
        said
    }
}
