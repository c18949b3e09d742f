//! RockScore: a number by which racks and devices are compared, found by a protocol that never changes.
//!
//! Stacks of one height, built with the scored rack and devices, are shaken across and along the barrels by
//! fixed motions at fixed levels of peak ground velocity. They are shaken in new condition and in every worn
//! state. The score is the peak ground velocity (cm/s, rounded down) at which one stack in ten collapses, in
//! the weakest state and direction.

mod json;
mod league;
mod page;
mod protocol;

use std::ops::ControlFlow;
use std::path::Path;

use barrelstack::variants::{Fitted, LEVEL, Unknown, planes};
use barrelstack_fragility::{FitError, Intensities, Interval, Shape, Stripe, interval_of};
use barrelstack_report::Document;

use crate::decision::{Cases, DecisionError, LimitCurve, LimitState};
use crate::direction::{Direction, check};
use crate::ground::GroundError;
use crate::pool;
use crate::protect::{changed, shaken, slug};
use crate::run::RunFailure;
use crate::scenario::{MotionSource, Scenario, ScenarioError, Until};
use crate::study::{Progress, RunOptions, Study, StudyError};
use crate::system;
use crate::uncertain::Sample;

pub use json::ScoreDocument;
pub use league::{Contender, League, contenders, league};
pub use protocol::{Protocol, State};

/// Peak ground velocity (m/s) at which one stack in ten collapses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Capacity {
    /// The velocity is that of the fitted curve, with its 95 % interval; `None` if the jackknife over the records fails
    /// ([`LimitCurve::left_out`]).
    Fitted(f64, Option<Interval>),
    /// The share of collapses rises above one in ten between these two levels. The lower level determines the score.
    ///
    /// Used if no curve can be fitted because there is at most one level at which some stacks collapse and
    /// others stand.
    Between(f64, f64),
    /// The velocity is above this level, the highest of the protocol.
    Above(f64),
    /// The velocity is below this level, the lowest of the protocol.
    Below(f64),
}

impl Capacity {
    fn of(curve: &LimitCurve, protocol: &Protocol) -> Result<Self, FitError> {
        let (lowest, highest) =
            (protocol.velocities[0], *protocol.velocities.last().unwrap_or(&0.0));
        let fit = match &curve.fit {
            Ok(fit) => fit,
            Err(FitError::NothingFailed { .. }) => return Ok(Self::Above(highest)),
            Err(FitError::EverythingFailed { .. }) => return Ok(Self::Below(lowest)),
            Err(FitError::Separated { .. }) => {
                return Ok(Self::between(&curve.stripes, protocol.chance));
            }
            Err(other) => return Err(*other),
        };
        let at = fit.curve.intensity(protocol.chance);
        // The curve is not extrapolated beyond the levels that were run.
        Ok(if at < lowest {
            Self::Below(lowest)
        } else if at > highest {
            Self::Above(highest)
        } else {
            let of = |found: &barrelstack_fragility::LeaveOneOut| {
                found.intensity(LEVEL, protocol.chance)
            };
            Self::Fitted(at, curve.left_out.as_ref().map(of))
        })
    }

    /// Returns the capacity without a fitted curve: [`Capacity::Between`] the two levels (m/s) between which the share
    /// of collapses rises above `chance`. Returns [`Capacity::Above`] if the share does not exceed `chance` at any
    /// level, and [`Capacity::Below`] if it does so already at the lowest level. `stripes` are in ascending order of
    /// intensity.
    fn between(stripes: &[Stripe], chance: f64) -> Self {
        let above = stripes.partition_point(|stripe| stripe.fraction() <= chance);
        match (stripes[..above].last(), stripes.get(above)) {
            (Some(low), Some(high)) => Self::Between(low.intensity, high.intensity),
            (Some(highest), None) => Self::Above(highest.intensity),
            (None, lowest) => Self::Below(lowest.map_or(0.0, |stripe| stripe.intensity)),
        }
    }

    /// Returns the 95 % interval of the velocity at which one stack in ten collapses; `None` if there is no interval.
    pub(crate) fn interval(self) -> Option<Interval> {
        if let Self::Fitted(_, interval) = self { interval } else { None }
    }

    /// Returns the velocity (m/s) from which the score is computed; 0 if it is below the lowest level.
    pub fn velocity(self) -> f64 {
        match self {
            Self::Fitted(at, _) | Self::Between(at, _) | Self::Above(at) => at,
            Self::Below(_) => 0.0,
        }
    }
}

/// Result of a stack in one state, shaken in one direction.
#[derive(Clone, Debug)]
pub struct Scored {
    /// State of the stack.
    pub state: State,
    /// Direction of shaking.
    pub direction: Direction,
    /// Peak ground velocity at which one stack in ten collapses.
    pub capacity: Capacity,
    /// Fragility curve of collapse, with the share of stacks that collapse at each level.
    pub curve: LimitCurve,
    /// Number of runs.
    pub runs: usize,
    /// Number of runs that are left out because they have no verdict, for example because they failed.
    pub left_out: usize,
    /// Number of runs whose stack fell under its own weight, before it was shaken.
    pub fallen_at_rest: usize,
    /// `true` if the study draws no uncertain constant.
    certain: bool,
    /// Velocities (m/s) at which one stack in ten collapses, one for each draw of the uncertain constants and the
    /// regression coefficients. Draws with the same index have the same constants in all elements of [`Sheet::rows`].
    /// Empty if no constant is drawn, if a run has no verdict, or if there are too few runs.
    pub draws: Vec<f64>,
    /// Effect of the uncertain constants on the share of collapses at the velocity of the score; `None` if it is
    /// unknown, or if the capacity of another row is lower.
    pub effect: Option<Fitted>,
}

impl Scored {
    /// Returns the range (m/s) that contains, with a probability of 95 %, the velocity at which one stack in ten
    /// collapses, given the uncertain constants and the sampling error. If no constant is drawn, the range is the 95 %
    /// interval of that velocity. Returns `None` if the runs do not determine a range.
    pub fn range(&self) -> Option<Interval> {
        if self.draws.is_empty() {
            return self.capacity.interval().filter(|_| self.certain);
        }
        Some(interval_of(&self.draws, LEVEL))
    }

    /// Returns the numbers of runs and of collapses at a level (m/s) of the protocol; `None` if no run at
    /// that level has a verdict.
    pub fn at(&self, velocity: f64) -> Option<Stripe> {
        // Motions were scaled to levels that were rounded when written as text.
        let same = |stripe: &&Stripe| (stripe.intensity / velocity - 1.0).abs() < 1e-6;
        self.curve.stripes.iter().find(same).copied()
    }
}

/// Rounds a velocity (cm/s) down to an integer.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a velocity of the protocol, not negative and below a hundred meters a second"
)]
fn whole(velocity: f64) -> u32 {
    velocity.max(0.0).floor() as u32
}

/// Score sheet of a rack and its devices.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// The scored scenario, with the number of levels that the protocol requires.
    pub scenario: Scenario,
    /// Number of levels of the stack in the given scenario. The scored stack has the number of levels of the protocol
    /// instead.
    pub stated_levels: u32,
    /// Protocol of the score.
    pub protocol: Protocol,
    /// Results, one for each state and direction.
    pub rows: Vec<Scored>,
    /// Report page.
    pub document: Document,
}

impl Sheet {
    /// Returns the result for the state and direction with the lowest capacity, which determines the score; `None` if
    /// `rows` is empty.
    pub fn weakest(&self) -> Option<&Scored> {
        let by = |a: &&Scored, b: &&Scored| a.capacity.velocity().total_cmp(&b.capacity.velocity());
        self.rows.iter().min_by(by)
    }

    /// Returns the score (cm/s).
    pub fn score(&self) -> u32 {
        // The binary value of a level such as 0.15 m/s may be slightly smaller.
        self.weakest().map_or(0, |row| whole(100.0 * row.capacity.velocity() + 1e-6))
    }

    /// Returns the score (m/s, not rounded) in every draw of the uncertain constants; empty if the runs of a row do not
    /// determine it.
    pub fn draws(&self) -> Vec<f64> {
        let count = self.rows.iter().map(|row| row.draws.len()).min().unwrap_or(0);
        let least =
            |draw| self.rows.iter().map(|row| row.draws[draw]).fold(f64::INFINITY, f64::min);
        (0..count).map(least).collect()
    }

    /// Returns the range (cm/s, rounded outward) that contains the score with a probability of 95 %, given the
    /// uncertain constants and the sampling error; `None` if the runs do not determine a range. Without uncertain
    /// constants, it is the 95 % interval of [`Sheet::weakest`].
    pub fn range(&self) -> Option<[u32; 2]> {
        let draws = self.draws();
        let found =
            if draws.is_empty() { self.weakest()?.range()? } else { interval_of(&draws, LEVEL) };
        let [low, high] = [found.low, found.high].map(|velocity| 100.0 * velocity);
        Some([whole(low + 1e-6), whole((high - 1e-6).ceil())])
    }

    /// Returns the uncertain constant with the largest effect on the share of collapses in the runs of
    /// [`Sheet::weakest`]; `None` if no constant is decisive ([`Fitted::decisive`]).
    pub fn decisive(&self) -> Option<&Unknown> {
        self.weakest()?.effect.as_ref()?.decisive()
    }

    /// Returns the results as a machine-readable document, in SI units.
    pub fn to_document(&self) -> ScoreDocument {
        ScoreDocument::of(self)
    }
}

/// Reason why a scenario cannot be scored.
#[derive(Debug, thiserror::Error)]
pub enum ScoreError {
    /// The scenario is a free scene, which has no racks.
    #[error(
        "\"{0}\" is a free scene, but a RockScore is computed for a stack of barrels on racks: use the scenario of a \
         stack, such as demo-napa"
    )]
    NoStack(String),
    /// A state cannot be applied to the stack.
    #[error("the stack cannot be scored in the state \"{state}\"")]
    State {
        /// Name of the state.
        state: String,
        /// Reason why the state cannot be applied.
        #[source]
        source: ScenarioError,
    },
    /// The motion of the scenario cannot be read.
    #[error(transparent)]
    Ground(#[from] GroundError),
    /// A stack cannot be built, or does not stand under its own weight.
    #[error(transparent)]
    Stack(#[from] RunFailure),
    /// A study cannot be run.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The cases of a study cannot be evaluated.
    #[error(transparent)]
    Decision(#[from] DecisionError),
    /// The runs do not determine a score.
    #[error(
        "no score can be computed from the runs in the state \"{state}\" with shaking {direction}"
    )]
    Curve {
        /// Name of the state.
        state: String,
        /// Direction of shaking, in words.
        direction: &'static str,
        /// Reason why no curve could be fitted.
        #[source]
        source: FitError,
    },
}

/// A stack to be scored, with the studies of all its states and directions.
struct Prepared {
    stack: Scenario,
    /// Number of levels of the stack in the given scenario.
    stated_levels: u32,
    protocol: Protocol,
    studies: Vec<(State, Direction, Study)>,
}

/// Scores the rack and the devices of a scenario.
///
/// The studies are stored in folders below `folder`, so that an interrupted run resumes from there. `report`
/// receives the number of finished runs and the total number of runs. It cancels the runs by returning
/// [`ControlFlow::Break`].
///
/// # Errors
/// If the scenario has no stack, a state cannot be built, or a folder cannot be written.
pub fn score(
    scenario: &Scenario,
    protocol: &Protocol,
    folder: &Path,
    options: &RunOptions,
    report: &(dyn Fn(u64, u64) -> ControlFlow<()> + Sync),
) -> Result<Sheet, ScoreError> {
    prepared(scenario, protocol)?.run(folder, options, report)
}

/// Prepares a score: gives the stack the number of levels of the protocol, checks that it stands in every state, and
/// creates a study for each state and direction.
fn prepared(scenario: &Scenario, protocol: &Protocol) -> Result<Prepared, ScoreError> {
    let Some(stated) = scenario.stack() else {
        return Err(ScoreError::NoStack(scenario.title.clone()));
    };
    // The motion of the scenario is removed, since the protocol sets the motions.
    let mut still = scenario.clone();
    still.motion.source = MotionSource::None;
    let refused = |state: &str| {
        let state = state.to_owned();
        move |source| ScoreError::State { state, source }
    };
    let stack =
        changed(&still, &protocol.stacked()).map_err(refused("stacked as in the protocol"))?;
    let mut studies: Vec<(State, Direction, Study)> = Vec::new();
    for state in protocol.states(&stack) {
        let worn = changed(&stack, &state.changes).map_err(refused(&state.name))?;
        for plane in planes(&worn)? {
            let Some(direction) = Direction::of(&plane.scenario) else { continue };
            check(&plane.scenario)?;
            let (motions, velocities) = (protocol.motions(), &protocol.velocities);
            let stack = (&plane.scenario, Until::Verdict);
            let study = shaken("rockscore", stack, protocol.seed, &motions, velocities)?;
            studies.push((state.clone(), direction, study));
        }
    }
    let protocol = protocol.of(&stack);
    Ok(Prepared { stack, stated_levels: stated.levels, protocol, studies })
}

impl Prepared {
    fn cases(&self) -> u64 {
        self.studies.iter().map(|(.., study)| study.cases()).sum()
    }

    /// Runs the studies, and evaluates them.
    fn run(
        self,
        folder: &Path,
        options: &RunOptions,
        report: &(dyn Fn(u64, u64) -> ControlFlow<()> + Sync),
    ) -> Result<Sheet, ScoreError> {
        let all = self.cases();
        let Self { stack, stated_levels, protocol, studies } = self;
        let (mut before, mut rows) = (0, Vec::new());
        for (state, direction, study) in studies {
            let below = Path::new(&slug(&state.name)).join(direction.name());
            let place = folder.join(&below);
            system::folder_below(folder, &below)
                .map_err(StudyError::system("create the folder", &place))?;
            let overall = |progress: &Progress| report(before + progress.tally.cases, all);
            let collected = study.run(&place, options, &overall)?;
            let cases = Cases::read(&collected)?;
            before += study.cases();
            let curve = LimitCurve::of(&cases, LimitState::SeatLost, cases.main);
            let capacity = Capacity::of(&curve, &protocol).map_err(|source| {
                let direction = direction.words();
                ScoreError::Curve { state: state.name.clone(), direction, source }
            })?;
            let sample = Sample::of(&study, &collected, &cases);
            let row = Scored {
                state,
                direction,
                capacity,
                curve,
                runs: cases.all.len() + cases.left_out,
                left_out: cases.left_out,
                fallen_at_rest: cases.fallen_at_rest(),
                certain: sample.is_certain(),
                draws: Vec::new(),
                effect: None,
            };
            rows.push((row, sample));
        }
        let rows = over_constants(rows, &protocol);
        let document = Document::default();
        let mut sheet = Sheet { scenario: stack, stated_levels, protocol, rows, document };
        sheet.document = page::document(&sheet);
        Ok(sheet)
    }
}

/// Returns the rows of a score, completed with the effect of the uncertain constants.
fn over_constants(rows: Vec<(Scored, Sample)>, protocol: &Protocol) -> Vec<Scored> {
    let ends = [protocol.velocities[0], *protocol.velocities.last().unwrap_or(&0.0)];
    let fits = pool::map(&rows, |(_, sample)| sample.fit(Shape::Lognormal), &|_| ());
    let least = rows.iter().map(|(row, _)| row.capacity.velocity()).fold(f64::INFINITY, f64::min);
    let of = |((mut row, sample), fit): ((Scored, Sample), Option<Intensities>)| {
        let found = fit.and_then(|fit| Some((fit.intensities(protocol.chance, ends)?, fit)));
        if let Some((draws, fit)) = found {
            // Only the weakest row states which constant decides.
            let weakest = row.capacity.velocity() == least;
            let share = fit.at(least.max(ends[0])).filter(|_| weakest);
            row.effect = share.map(|share| sample.effect(&share));
            row.draws = draws;
        }
        row
    };
    rows.into_iter().zip(fits).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn between(failures: [u32; 4]) -> Capacity {
        let level = |(at, failures)| Stripe { intensity: at, cases: 24, failures };
        let stripes = [0.3, 0.6, 0.9, 1.35].into_iter().zip(failures).map(level);
        Capacity::between(&stripes.collect::<Vec<_>>(), 0.1)
    }

    #[test]
    fn racks_of_reference_are_those_of_the_league() {
        let league = concat!(env!("CARGO_MANIFEST_DIR"), "/../../validation/league/league.csv");
        let league = std::fs::read_to_string(league).unwrap();
        let racks = league.lines().filter(|line| line.contains(",rack,"));
        let whole = |cell: Option<&&str>| cell.unwrap().parse().unwrap();
        let racks: Vec<page::OnScale> = racks
            .map(|line| line.split(',').collect::<Vec<_>>())
            .map(|cells| {
                let range = [whole(cells.get(5)), whole(cells.get(6))];
                (cells[0].to_owned(), whole(cells.get(2)), Some(range))
            })
            .collect();
        assert!(racks.len() > 5);
        assert_eq!(page::references(), racks);
    }

    #[test]
    fn a_score_in_space_has_a_protocol_of_its_own_also_if_thinned() {
        let stack =
            |view: &str| Scenario::builtin("demo-napa", &[format!("stack.view={view}")]).unwrap();
        let [whole, thinned] = [1, 4].map(|step| Protocol::rockscore().thinned(step));
        let name = |protocol: &Protocol, view| protocol.of(&stack(view)).name;
        assert_eq!(name(&whole, "both"), "rockscore/2");
        assert_eq!(name(&whole, "spatial"), "rockscore/2-space");
        assert_eq!(name(&thinned, "both"), "rockscore/2, one motion in 4");
        assert_eq!(name(&thinned, "spatial"), "rockscore/2-space, one motion in 4");
    }

    #[test]
    fn without_a_curve_the_highest_level_counts_at_which_nine_in_ten_stood() {
        assert_eq!(between([0, 0, 0, 8]), Capacity::Between(0.9, 1.35));
        assert_eq!(between([0, 0, 8, 24]), Capacity::Between(0.6, 0.9));
        assert_eq!(between([0, 0, 24, 24]), Capacity::Between(0.6, 0.9));
        assert_eq!(between([8, 24, 24, 24]), Capacity::Below(0.3));
        assert_eq!(between([2, 24, 24, 24]), Capacity::Between(0.3, 0.6));
        assert_eq!(between([0, 0, 0, 1]), Capacity::Above(1.35));
        assert_eq!(between([0, 0, 0, 8]).velocity(), 0.9);
    }
}
