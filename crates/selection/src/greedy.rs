//! Greedy selection of one record for each simulated spectrum. Members of the set are then exchanged for other
//! candidates as long as this improves the set.

use barrelstack_motion::{MotionError, Random};

use crate::target::SelectionTarget;

/// Number of trials. Each trial selects a set of records for different simulated spectra; the best set is
/// kept.
const TRIALS: usize = 5;
/// Weight of the error of the standard deviation, relative to the weight of the error of the mean.
const SPREAD_WEIGHT: f64 = 2.0;
/// Weight of the error of the standard deviation if the target has no spread; no set of records can match such a target
/// exactly.
const NO_SPREAD_WEIGHT: f64 = 0.1;
/// Maximum number of rounds of exchanges. Rounds end earlier if no exchange reduces the error.
const ROUNDS: usize = 20;

/// A record that is available for selection.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Name of the record in messages.
    pub name: String,
    /// Pseudo-accelerations (m/s²) of the record at the periods of the target.
    pub spectrum: Vec<f64>,
    /// Group of the record, such as its earthquake. At most [`Choosing::most_of_group`] records of one group
    /// are selected.
    pub group: String,
}

/// Settings of a selection: size of the set, and limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Choosing {
    /// Number of records to select, which must be at least 2.
    pub count: usize,
    /// Minimum and maximum scale factor of a record.
    pub scale: [f64; 2],
    /// Maximum number of selected records from one group; `None` for no limit.
    pub most_of_group: Option<usize>,
    /// Seed of the random number generator that draws the simulated spectra.
    pub seed: u64,
}

/// A selected record with its scale factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chosen {
    /// Index of the record among the candidates.
    pub candidate: usize,
    /// Scale factor of the record.
    pub scale: f64,
}

/// Selected set of records, and how well it matches the target.
#[derive(Clone, Debug, PartialEq)]
pub struct Selection {
    /// Selected records, in the order of the candidates.
    pub chosen: Vec<Chosen>,
    /// Mean of ln Sa over the set, at each period.
    pub mean: Vec<f64>,
    /// Standard deviation of ln Sa over the set, at each period, with the divisor `n − 1`.
    pub deviation: Vec<f64>,
    /// Number of candidates that can be scaled to the mean of the target by a factor within the limits.
    ///
    /// A scaled candidate agrees with the mean of the target in one number: ln Sa at the conditioning period or, if the
    /// target is not conditional, the average of ln Sa over all periods.
    pub eligible: usize,
    /// Number of rounds of exchanges.
    pub rounds: usize,
}

impl Selection {
    /// Returns the maximum relative error of the median over all periods.
    pub fn median_error(&self, target: &SelectionTarget) -> f64 {
        let errors = self.mean.iter().zip(target.mean());
        errors.fold(0.0, |worst, (ours, wanted)| worst.max((libm::exp(ours - wanted) - 1.0).abs()))
    }

    /// Returns the maximum relative error of the standard deviation, over the periods at which the target has
    /// a spread. If the target has no spread, returns the maximum absolute error.
    pub fn deviation_error(&self, target: &SelectionTarget) -> f64 {
        let spread = target.deviation().iter().any(|s| *s > 0.0);
        let pairs = self.deviation.iter().zip(target.deviation());
        pairs.fold(0.0, |worst, (ours, wanted)| match (spread, *wanted > SMALLEST) {
            (true, true) => worst.max((ours / wanted - 1.0).abs()),
            (true, false) => worst,
            (false, _) => worst.max(ours.abs()),
        })
    }

    /// Returns the error by which sets are compared: the larger of the error of the median and half the error of the
    /// standard deviation. If the target has no spread, returns the error of the median.
    fn worst(&self, target: &SelectionTarget) -> f64 {
        let spread = target.deviation().iter().any(|s| *s > 0.0);
        let deviation = if spread { 0.5 * self.deviation_error(target) } else { 0.0 };
        self.median_error(target).max(deviation)
    }
}

/// Standard deviation of ln Sa below which a relative error is meaningless.
const SMALLEST: f64 = 0.01;

/// Selects records whose spectra together have the mean and the spread of the target (Jayaram, Lin and Baker
/// 2011, Earthquake Spectra 27:797-815).
///
/// If the target is conditional, every record is scaled to the target at the conditioning period. Otherwise, every
/// record is scaled such that its mean of ln Sa over all periods equals that of its simulated spectrum. The same
/// target, candidates and settings always give the same set; of equally good candidates, the first is chosen.
///
/// # Errors
/// If the settings are out of range, if the number of periods of a candidate differs from that of the target,
/// or if too few candidates satisfy the limits on the scale factor and on the number of records of one group.
pub fn select(
    target: &SelectionTarget,
    candidates: &[Candidate],
    choosing: &Choosing,
) -> Result<Selection, MotionError> {
    check(target, candidates, choosing)?;
    let pool = Pool::of(target, candidates, choosing);
    let mut random = Random::new(choosing.seed);
    let mut best: Option<Selection> = None;
    for _ in 0..TRIALS {
        let mut set = Set::new(target);
        for spectrum in &target.draw(choosing.count, &mut random) {
            let level = pool.level(spectrum);
            let nearest = pool
                .nearest(spectrum, level, &set)
                .ok_or_else(|| too_few(&pool, candidates.len(), set.members.len(), choosing))?;
            set.add(&pool, nearest, level);
        }
        let mut rounds = set.improve(&pool);
        if set.weight == SPREAD_WEIGHT {
            set.largest = true;
            rounds += set.improve(&pool);
        }
        let found = set.selection(&pool, rounds);
        if best.as_ref().is_none_or(|best| found.worst(target) < best.worst(target)) {
            best = Some(found);
        }
    }
    // There is at least one trial, and each gives a set.
    best.ok_or_else(|| too_few(&pool, candidates.len(), 0, choosing))
}

fn too_few(pool: &Pool, given: usize, found: usize, choosing: &Choosing) -> MotionError {
    let [least, largest] = choosing.scale;
    let groups = choosing.most_of_group.map_or_else(String::new, |most| {
        format!(", and at most {most} of each of the {} events may be selected", pool.groups)
    });
    let what = format!(
        "{found} of {given} records reach the target with factors from {least} to {largest}\
         {groups}, but {} are requested",
        choosing.count
    );
    MotionError::mismatch(what, "widen the limits, request fewer, or give more records")
}

fn check(
    target: &SelectionTarget,
    candidates: &[Candidate],
    choosing: &Choosing,
) -> Result<(), MotionError> {
    MotionError::require(choosing.count >= 2, "size of the set", "at least 2", choosing.count)?;
    let [least, largest] = choosing.scale;
    let range = least > 0.0 && largest >= least && largest.is_finite();
    let found = format!("{least} to {largest}");
    MotionError::require(range, "factors", "0 < smallest <= largest", found)?;
    let periods = target.periods().len();
    for candidate in candidates {
        let (name, values) = (&candidate.name, &candidate.spectrum);
        MotionError::require(
            values.len() == periods,
            format!("spectrum of {name}"),
            format!("{periods} accelerations, one for each period of the target"),
            values.len(),
        )?;
        if let Some(k) = values.iter().position(|sa| sa.is_nan() || *sa <= 0.0) {
            return Err(MotionError::parameter(
                format!("spectrum of {name} at {} s", target.periods()[k]),
                "an acceleration above 0 (m/s2)",
                values[k],
            ));
        }
    }
    Ok(())
}

/// An unscaled candidate.
struct Row {
    candidate: usize,
    /// ln Sa at each period.
    spectrum: Vec<f64>,
    /// Level of the spectrum: ln Sa at the conditioning period, or the mean of ln Sa over all periods if the
    /// target is not conditional. Scaling makes it equal to the level of a simulated spectrum.
    level: f64,
    group: usize,
}

/// All unscaled candidates, and the limits on the scale factor and on the number of records of one group.
struct Pool {
    rows: Vec<Row>,
    groups: usize,
    /// Index of the conditioning period; `None` if the target is not conditional.
    given: Option<usize>,
    /// Logarithms of the minimum and the maximum scale factor.
    limits: [f64; 2],
    most: usize,
}

impl Pool {
    fn of(target: &SelectionTarget, candidates: &[Candidate], choosing: &Choosing) -> Self {
        let mut names: Vec<&str> = candidates.iter().map(|c| c.group.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        let mut pool = Self {
            rows: Vec::new(),
            groups: names.len(),
            given: target.condition().map(|(at, _)| at),
            // The margin admits a factor that equals a limit up to rounding.
            limits: [libm::log(choosing.scale[0]) - 1e-12, libm::log(choosing.scale[1]) + 1e-12],
            most: choosing.most_of_group.unwrap_or(usize::MAX),
        };
        for (candidate, given) in candidates.iter().enumerate() {
            let spectrum: Vec<f64> = given.spectrum.iter().map(|sa| libm::log(*sa)).collect();
            let level = pool.level(&spectrum);
            let group = names.partition_point(|name| *name < given.group.as_str());
            pool.rows.push(Row { candidate, spectrum, level, group });
        }
        pool
    }

    fn level(&self, spectrum: &[f64]) -> f64 {
        self.given
            .map_or_else(|| spectrum.iter().sum::<f64>() / spectrum.len() as f64, |at| spectrum[at])
    }

    fn reaches(&self, row: usize, level: f64) -> bool {
        (self.limits[0]..=self.limits[1]).contains(&(level - self.rows[row].level))
    }

    /// Returns the number of candidates that can be scaled to the mean of the target by a factor within the limits.
    fn eligible(&self, target: &SelectionTarget) -> usize {
        let level = self.level(target.mean());
        (0..self.rows.len()).filter(|row| self.reaches(*row, level)).count()
    }

    /// Returns the index of the row that, scaled to `level`, has the smallest squared distance from `spectrum`. Only
    /// rows that may join the set and can be scaled within the limits are considered. Returns `None` if there are none.
    fn nearest(&self, spectrum: &[f64], level: f64, set: &Set<'_>) -> Option<usize> {
        let mut best = (f64::INFINITY, None);
        for (k, row) in self.rows.iter().enumerate() {
            if !self.reaches(k, level) || !set.takes(self, k, None) {
                continue;
            }
            let shift = level - row.level;
            let apart = row.spectrum.iter().zip(spectrum).map(|(a, b)| a + shift - b);
            let distance: f64 = apart.map(|d| d * d).sum();
            if distance < best.0 {
                best = (distance, Some(k));
            }
        }
        best.1
    }
}

/// Set of records during selection, with the sums from which its mean and standard deviation are computed.
struct Set<'a> {
    target: &'a SelectionTarget,
    /// Members of the set: for each, the index of a row of the pool, and the level to which the row is
    /// scaled.
    members: Vec<(usize, f64)>,
    /// For each period, the sum over all members of the difference between ln Sa and the mean of the target. The mean
    /// is subtracted to avoid cancellation in the standard deviation.
    sums: Vec<f64>,
    squares: Vec<f64>,
    /// Weight of the error of the standard deviation.
    weight: f64,
    /// `true` to minimize the largest error rather than the sum of squared errors.
    largest: bool,
}

impl<'a> Set<'a> {
    fn new(target: &'a SelectionTarget) -> Self {
        let n = target.periods().len();
        let spread = target.deviation().iter().any(|s| *s > 0.0);
        let weight = if spread { SPREAD_WEIGHT } else { NO_SPREAD_WEIGHT };
        let (sums, squares) = (vec![0.0; n], vec![0.0; n]);
        Self { target, members: Vec::new(), sums, squares, weight, largest: false }
    }

    fn add(&mut self, pool: &Pool, row: usize, level: f64) {
        self.members.push((row, level));
        self.count(&pool.rows[row].spectrum, level - pool.rows[row].level, 1.0);
    }

    fn count(&mut self, spectrum: &[f64], shift: f64, sign: f64) {
        for (k, (value, mean)) in spectrum.iter().zip(self.target.mean()).enumerate() {
            let x = value + shift - mean;
            self.sums[k] += sign * x;
            self.squares[k] += sign * x * x;
        }
    }

    /// Returns `true` if a row of the pool may join the set: it is not a member, and the limit on the number of records
    /// of its group is not reached. The member at index `leaving`, if given, is not counted.
    fn takes(&self, pool: &Pool, row: usize, leaving: Option<usize>) -> bool {
        let group = pool.rows[row].group;
        let mut same = 0;
        for (place, (member, _)) in self.members.iter().enumerate() {
            if Some(place) == leaving {
                continue;
            }
            if *member == row {
                return false;
            }
            same += usize::from(pool.rows[*member].group == group);
        }
        same < pool.most
    }

    /// Returns the error that exchanges minimize: the weighted sum of the squared errors of mean and standard
    /// deviation.
    ///
    /// If the largest error is to be minimized, returns the sum of the eighth powers of the errors instead, with the
    /// error of the standard deviation relative to the standard deviation of the target.
    fn error(&self) -> f64 {
        (0..self.sums.len()).map(|k| self.error_at(k, self.sums[k], self.squares[k])).sum()
    }

    fn error_at(&self, k: usize, sum: f64, squares: f64) -> f64 {
        let (mean, deviation) = self.moments_of(sum, squares);
        let wanted = self.target.deviation()[k];
        let apart = deviation - wanted;
        if !self.largest {
            return mean * mean + self.weight * apart * apart;
        }
        // Errors as in [`Selection::worst`], in percent so that the powers do not underflow.
        let spread = if wanted > SMALLEST { 50.0 * apart / wanted } else { 0.0 };
        eighth_power(100.0 * mean) + eighth_power(spread)
    }

    /// Exchanges each member for the candidate that reduces the error most. Stops when no exchange reduces
    /// the error or after [`ROUNDS`] rounds; returns the number of rounds.
    fn improve(&mut self, pool: &Pool) -> usize {
        for round in 1..=ROUNDS {
            let mut changed = false;
            for place in 0..self.members.len() {
                let (leaving, level) = self.members[place];
                let shift = |row: usize| level - pool.rows[row].level;
                let now = self.error();
                self.count(&pool.rows[leaving].spectrum, shift(leaving), -1.0);
                let mut best = (now * (1.0 - 1e-9), leaving);
                for row in 0..pool.rows.len() {
                    if !pool.reaches(row, level) {
                        continue;
                    }
                    let error = self.error_with(&pool.rows[row].spectrum, shift(row), best.0);
                    if error < best.0 && self.takes(pool, row, Some(place)) {
                        best = (error, row);
                    }
                }
                self.count(&pool.rows[best.1].spectrum, shift(best.1), 1.0);
                self.members[place].0 = best.1;
                changed |= best.1 != leaving;
            }
            if !changed {
                return round;
            }
        }
        ROUNDS
    }

    /// Returns the error of the set with an additional spectrum, whose ln Sa is increased by `shift`. Summation over
    /// the periods stops as soon as the sum reaches `limit`.
    fn error_with(&self, spectrum: &[f64], shift: f64, limit: f64) -> f64 {
        let mut error = 0.0;
        for (k, (value, mean)) in spectrum.iter().zip(self.target.mean()).enumerate() {
            let x = value + shift - mean;
            error += self.error_at(k, self.sums[k] + x, self.squares[k] + x * x);
            if error >= limit {
                break;
            }
        }
        error
    }

    fn selection(&self, pool: &Pool, rounds: usize) -> Selection {
        let one = |&(row, level): &(usize, f64)| {
            let row = &pool.rows[row];
            Chosen { candidate: row.candidate, scale: libm::exp(level - row.level) }
        };
        let mut chosen: Vec<Chosen> = self.members.iter().map(one).collect();
        chosen.sort_by_key(|chosen| chosen.candidate);
        let (mean, deviation) = self.moments();
        Selection { chosen, mean, deviation, eligible: pool.eligible(self.target), rounds }
    }

    /// Returns the mean and the standard deviation of ln Sa over the set, at each period.
    fn moments(&self) -> (Vec<f64>, Vec<f64>) {
        let of = |(sum, squares): (&f64, &f64)| self.moments_of(*sum, *squares);
        let (mut mean, spread): (Vec<f64>, _) = self.sums.iter().zip(&self.squares).map(of).unzip();
        for (mean, target) in mean.iter_mut().zip(self.target.mean()) {
            *mean += target;
        }
        (mean, spread)
    }

    /// Returns the mean and the standard deviation, with the divisor `n − 1`, from the sum and the sum of
    /// squares over all members.
    fn moments_of(&self, sum: f64, squares: f64) -> (f64, f64) {
        let n = self.members.len() as f64;
        let mean = sum / n;
        (mean, ((squares - n * mean * mean) / (n - 1.0)).max(0.0).sqrt())
    }
}

fn eighth_power(x: f64) -> f64 {
    (0..8).fold(1.0, |product, _| product * x)
}
