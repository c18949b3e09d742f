//! Designs of studies: rules that determine the list of cases from the motions, levels and factors.

use barrelstack_fragility::sobol::Axis;
use barrelstack_fragility::{normal, normal_quantile};
use barrelstack_motion::Random;

use crate::scenario::fnv1a;

use super::setting::Setting;
use super::{Factor, Levels, Study, Variation};
use barrelstack_report::column::Value;

/// Design of the cases of a study.
#[derive(Clone, Debug, PartialEq)]
pub enum Design {
    /// Every combination of all values, levels and motions.
    FullFactorial,
    /// For every level and motion: one case with the base values, and one case for each other value of each factor, in
    /// which only that factor is changed.
    OneAtATime {
        /// Probabilities of the quantiles that represent a distribution.
        quantiles: Vec<f64>,
        /// Number of times that the factors with distributions are drawn for each motion; 0 to use quantiles instead.
        draws: u32,
    },
    /// Latin hypercube: the range of every factor is divided into `count` equally probable parts, and one
    /// sample lies in each part.
    LatinHypercube {
        /// Number of samples.
        count: u32,
    },
    /// Points of a Sobol' sequence with a random shift.
    Sobol {
        /// Number of points.
        count: u32,
    },
    /// Blocks of Sobol' points for first-order and total sensitivity indices (Saltelli et al. 2010).
    ///
    /// A block contains two samples and, for every varied quantity, a copy of the first sample in which that
    /// quantity is taken from the second.
    Saltelli {
        /// Number of blocks.
        count: u32,
    },
    /// Independent random samples, until the interval of the collapse probability is narrow enough.
    MonteCarlo {
        /// Half-width of the 95 % interval (Wilson) of the collapse probability at which sampling stops;
        /// `None` to run all cases.
        half_width: Option<f64>,
        /// Number of cases before the interval is tested for the first time.
        least: u32,
        /// Maximum number of cases.
        most: u32,
    },
    /// Every motion at every level. All combinations of listed values are run; factors with a distribution
    /// are drawn for each case.
    Stripes,
    /// Incremental dynamic analysis by hunt and fill.
    Ida(super::ida::Hunt),
}

impl Design {
    /// Returns `true` if the cases are a sample of the stated distributions, so that the share of collapsed cases
    /// estimates the probability of collapse.
    ///
    /// Returns `false` for all other designs: their cases combine listed values or requested levels, or are
    /// constructed so that some of them differ in one quantity only.
    pub fn is_sample(&self) -> bool {
        matches!(self, Self::LatinHypercube { .. } | Self::Sobol { .. } | Self::MonteCarlo { .. })
    }

    /// Returns the name of the design in study files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::FullFactorial => "full-factorial",
            Self::OneAtATime { .. } => "one-at-a-time",
            Self::LatinHypercube { .. } => "latin-hypercube",
            Self::Sobol { .. } => "sobol",
            Self::Saltelli { .. } => "saltelli",
            Self::MonteCarlo { .. } => "monte-carlo",
            Self::Stripes => "stripes",
            Self::Ida(_) => "ida",
        }
    }
}

/// Description of a case before its model is built.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PlannedCase {
    /// Number of the case in the table. In an adaptive design, the numbers are not consecutive.
    pub(super) number: u64,
    /// Identifier of the case, which does not depend on the number of cases. It is also the seed of the random
    /// draws for the case.
    pub(super) id: u64,
    /// Index of the motion in the study.
    pub(super) motion: usize,
    /// Intensity (SI) to which the motion is scaled, if any.
    pub(super) level: Option<f64>,
    /// Values of the factors in the case; `None` for a factor that keeps the value of the base scenario.
    pub(super) settings: Vec<Option<Setting>>,
}

/// Method by which the cases of a design are enumerated: all combinations, changes of one factor at a time, or samples.
#[derive(Clone, Debug)]
pub(super) enum Cases {
    /// Every combination. The motion varies slowest, then the factors, and the level varies fastest.
    Crossed,
    /// Cases with the base values, and cases in which only one factor differs from its base value. The motion varies
    /// slowest, then the draw, then the level, and the change varies fastest.
    OneAtATime {
        /// Changes, each given by the index of a factor and the new value of that factor.
        changes: Vec<(usize, Setting)>,
        /// Number of times that the factors with distributions are drawn for each motion; all changes and levels use
        /// the same draws.
        draws: u64,
    },
    /// Points of the unit cube, whose axes are the motion, the level and the factors.
    Sampled(Sampling),
}

/// Method of sampling the unit cube.
#[derive(Clone, Debug)]
pub(super) enum Sampling {
    /// Random numbers from the seed of each case.
    Random,
    /// Latin hypercube, given by a permutation of the strata for each axis.
    LatinHypercube(Vec<Vec<u32>>),
    /// Sobol' sequence, with one dimension for each axis.
    Sobol(Vec<Axis>),
    /// Saltelli blocks: two dimensions of the Sobol' sequence for each axis, and the indices of the axes whose values
    /// are exchanged between the two samples of a block.
    Saltelli { axes: Vec<[Axis; 2]>, exchanged: Vec<usize> },
}

/// Derives a seed from another seed and text.
pub(super) fn seed_of(seed: u64, words: &str) -> u64 {
    // The seeding of the generator mixes the bits, which the hash leaves correlated.
    Random::new(fnv1a(format!("{seed}|{words}").as_bytes())).bits()
}

fn uniform(seed: u64, words: &str) -> f64 {
    Random::new(seed_of(seed, words)).uniform()
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a count")]
fn pick(u: f64, count: usize) -> usize {
    ((u * count as f64) as usize).min(count - 1)
}

/// Returns a uniformly distributed integer below `count`, by Lemire's multiplication method; its bias is below 2⁻³².
#[expect(clippy::cast_possible_truncation, reason = "below the count")]
fn below(random: &mut Random, count: usize) -> usize {
    ((u128::from(random.bits()) * count as u128) >> 64) as usize
}

impl Cases {
    pub(super) fn new(study: &Study) -> Self {
        let axes = study.axes();
        let axis = |dimension: usize, name: &str| {
            let shift = seed_of(study.seed, &format!("shift of {name}")) >> 32;
            Axis::new(dimension, u32::try_from(shift).unwrap_or_default())
        };
        match &study.design {
            Design::FullFactorial | Design::Stripes | Design::Ida(_) => Self::Crossed,
            Design::OneAtATime { quantiles, draws } => Self::OneAtATime {
                changes: changes(&study.factors, quantiles, *draws > 0),
                draws: u64::from(*draws),
            },
            Design::MonteCarlo { .. } => Self::Sampled(Sampling::Random),
            Design::LatinHypercube { count } => {
                let permutation = |axis: &String| {
                    let mut order: Vec<u32> = (0..*count).collect();
                    let mut random = Random::new(seed_of(study.seed, &format!("strata of {axis}")));
                    for last in (1..order.len()).rev() {
                        order.swap(last, below(&mut random, last + 1));
                    }
                    order
                };
                Self::Sampled(Sampling::LatinHypercube(axes.iter().map(permutation).collect()))
            }
            Design::Saltelli { .. } => {
                let pair = |(at, name): (usize, &String)| {
                    [axis(at, name), axis(at + axes.len(), &format!("{name} exchanged"))]
                };
                let exchanged = study.varied().into_iter().map(|(at, _)| at).collect();
                let axes = axes.iter().enumerate().map(pair).collect();
                Self::Sampled(Sampling::Saltelli { axes, exchanged })
            }
            Design::Sobol { .. } => {
                let all = axes.iter().enumerate().map(|(at, name)| axis(at, name));
                Self::Sampled(Sampling::Sobol(all.collect()))
            }
        }
    }

    /// Returns the number of cases. For Monte Carlo, this is the maximum number of cases. For an incremental dynamic
    /// analysis, it is the number of hunts: one for each combination of a motion and factor values.
    pub(super) fn count(&self, study: &Study) -> u64 {
        let motions = study.motions.len() as u64;
        let levels = study.crossed_levels().len() as u64;
        match (self, &study.design) {
            (Self::Sampled(_), Design::LatinHypercube { count } | Design::Sobol { count }) => {
                u64::from(*count)
            }
            (Self::Sampled(Sampling::Saltelli { exchanged, .. }), Design::Saltelli { count }) => {
                u64::from(*count) * (exchanged.len() as u64 + 2)
            }
            (Self::Sampled(_), Design::MonteCarlo { most, .. }) => u64::from(*most),
            (Self::OneAtATime { changes, draws }, _) => {
                motions * (*draws).max(1) * levels * (1 + changes.len() as u64)
            }
            (Self::Crossed | Self::Sampled(_), _) => {
                let lists =
                    study.factors.iter().map(|factor| factor.crossed().map_or(1, <[_]>::len));
                lists.fold(motions * levels, |count, length| count.saturating_mul(length as u64))
            }
        }
    }

    /// Returns the case with the number `number`. For an incremental dynamic analysis this is a hunt, whose
    /// level is not set.
    pub(super) fn case(&self, study: &Study, number: u64) -> PlannedCase {
        match self {
            Self::Crossed => crossed(study, number),
            Self::OneAtATime { changes, draws } => one_at_a_time(study, changes, *draws, number),
            Self::Sampled(sampling) => sampled(study, sampling, number),
        }
    }
}

/// Removes the least significant digit of `rest` in the given base and returns it.
#[expect(clippy::cast_possible_truncation, reason = "below the length of a list")]
fn digit(rest: &mut u64, base: usize) -> usize {
    let digit = *rest % base as u64;
    *rest /= base as u64;
    digit as usize
}

fn crossed(study: &Study, number: u64) -> PlannedCase {
    let mut rest = number;
    let levels = study.crossed_levels();
    let level = levels[digit(&mut rest, levels.len())];
    let mut settings: Vec<Option<Setting>> = vec![None; study.factors.len()];
    for (factor, setting) in study.factors.iter().zip(&mut settings).rev() {
        if let Some(values) = factor.crossed() {
            *setting = Some(values[digit(&mut rest, values.len())].clone());
        }
    }
    let motion = digit(&mut rest, study.motions.len());
    let id = study.identity(motion, level, &settings);
    for (factor, setting) in study.factors.iter().zip(&mut settings) {
        if let Variation::Distribution(distribution) = &factor.variation
            && setting.is_none()
        {
            let own = uniform(id, &factor.name);
            let u = study.correlated(&factor.name, own, |group| uniform(id, &common(group)));
            *setting = Some(distribution.quantile(u));
        }
    }
    PlannedCase { number, id, motion, level, settings }
}

/// Returns the name of the sampling axis that all factors of a correlated group share.
fn common(group: usize) -> String {
    format!("correlation {}", group + 1)
}

fn one_at_a_time(
    study: &Study,
    changes: &[(usize, Setting)],
    draws: u64,
    number: u64,
) -> PlannedCase {
    let mut rest = number;
    let change = digit(&mut rest, 1 + changes.len());
    let levels = study.crossed_levels();
    let level = levels[digit(&mut rest, levels.len())];
    let draw = rest % draws.max(1);
    rest /= draws.max(1);
    let motion = digit(&mut rest, study.motions.len());
    let mut settings = vec![None; study.factors.len()];
    // The drawn values depend on the motion and the draw only, so that they are the same for all changes and levels.
    for (factor, setting) in study.factors.iter().zip(&mut settings).filter(|_| draws > 0) {
        if let Variation::Distribution(distribution) = &factor.variation {
            let words = format!("draw {draw} of {}", study.motions[motion].name);
            *setting =
                Some(distribution.quantile(uniform(seed_of(study.seed, &words), &factor.name)));
        }
    }
    if let Some((factor, setting)) = change.checked_sub(1).and_then(|change| changes.get(change)) {
        settings[*factor] = Some(setting.clone());
    }
    PlannedCase { number, id: study.identity(motion, level, &settings), motion, level, settings }
}

/// Returns all changes of one factor from its base value, each given by the index of the factor and its new value.
/// Factors with a distribution are excluded if `drawn` is `true`.
fn changes(factors: &[Factor], quantiles: &[f64], drawn: bool) -> Vec<(usize, Setting)> {
    let mut changes = Vec::new();
    for (index, factor) in factors.iter().enumerate() {
        let values: Vec<Setting> = match &factor.variation {
            Variation::Values(values) => values.clone(),
            Variation::Distribution(_) if drawn => continue,
            Variation::Distribution(distribution) => match distribution.settings() {
                Some(settings) => settings.cloned().collect(),
                None => quantiles.iter().map(|u| distribution.quantile(*u)).collect(),
            },
        };
        let others = values.into_iter().filter(|value| Some(&value.value) != factor.base.as_ref());
        changes.extend(others.map(|value| (index, value)));
    }
    changes
}

fn sampled(study: &Study, sampling: &Sampling, number: u64) -> PlannedCase {
    let id = seed_of(study.seed, &format!("sample {number}"));
    // A sampled design has at most 2³² cases, since its count is a 32-bit number.
    let point = u32::try_from(number).unwrap_or(u32::MAX);
    let axes = study.axes();
    let coordinate = |axis: usize| {
        let name = axes[axis].as_str();
        match sampling {
            Sampling::Random => uniform(id, name),
            Sampling::LatinHypercube(strata) => {
                let stratum = strata[axis][point as usize];
                (f64::from(stratum) + uniform(id, name)) / strata[axis].len() as f64
            }
            Sampling::Sobol(sequences) => sequences[axis].at(point),
            Sampling::Saltelli { axes, exchanged } => {
                let size = u32::try_from(exchanged.len() + 2).unwrap_or(u32::MAX);
                let from_second = match point % size {
                    0 => false,
                    1 => true,
                    k => exchanged[k as usize - 2] == axis,
                };
                axes[axis][usize::from(from_second)].at(point / size)
            }
        }
    };
    let motion = pick(coordinate(0), study.motions.len());
    let level = study.intensity.as_ref().and_then(|intensity| match &intensity.levels {
        Levels::List(levels) => Some(levels[pick(coordinate(1), levels.len())]),
        Levels::Distribution(distribution) => Some(distribution.quantile(coordinate(1)).number()),
        Levels::Hunted => None,
    });
    let setting = |(index, factor): (usize, &Factor)| {
        let u = coordinate(2 + index);
        Some(match &factor.variation {
            Variation::Values(values) => values[pick(u, values.len())].clone(),
            Variation::Distribution(distribution) => {
                let common = |group| coordinate(2 + study.factors.len() + group);
                distribution.quantile(study.correlated(&factor.name, u, common))
            }
        })
    };
    let settings = study.factors.iter().enumerate().map(setting).collect();
    PlannedCase { number, id, motion, level, settings }
}

impl Study {
    /// Returns the names of the axes of the unit cube from which samples are taken.
    pub(super) fn axes(&self) -> Vec<String> {
        let factors = self.factors.iter().map(|factor| format!("factor {}", factor.name));
        let groups = (0..self.correlations.len()).map(common);
        ["motion".to_owned(), "level".to_owned()].into_iter().chain(factors).chain(groups).collect()
    }

    /// Returns the cumulative probability at which a factor is drawn. `own` is the uniform deviate of the factor.
    /// `common` takes the number of a group of correlated factors and returns the uniform deviate that the group
    /// shares.
    fn correlated(&self, factor: &str, own: f64, common: impl FnOnce(usize) -> f64) -> f64 {
        let group = self.correlations.iter().position(|group| group.contains(factor));
        let Some(group) = group else { return own };
        let along = self.correlations[group].coefficient;
        // The lower bound keeps the quantiles finite.
        let [own, common] = [own, common(group)].map(|u| normal_quantile(u.max(f64::MIN_POSITIVE)));
        normal(along.sqrt() * common + (1.0 - along).sqrt() * own)
    }

    /// Returns the axes that take more than one value, each with its index and its name for display.
    pub(super) fn varied(&self) -> Vec<(usize, String)> {
        let level = self.intensity.as_ref().is_some_and(|intensity| match &intensity.levels {
            Levels::List(levels) => levels.len() > 1,
            Levels::Distribution(_) => true,
            Levels::Hunted => false,
        });
        let always = [(self.motions.len() > 1, "motion"), (level, "level")];
        let of =
            |(at, (varies, name)): (usize, (bool, &str))| varies.then(|| (at, name.to_owned()));
        let factors = self.factors.iter().enumerate().map(|(at, f)| (2 + at, f.name.clone()));
        always.into_iter().enumerate().filter_map(of).chain(factors).collect()
    }

    /// Returns the levels that are combined with motions and factors; a single `None` if there are no levels.
    pub(super) fn crossed_levels(&self) -> &[Option<f64>] {
        &self.levels
    }

    /// Derives the identifier of a case from its motion, level and factor values, so that the identifier does not
    /// depend on the position of the case in the design.
    fn identity(&self, motion: usize, level: Option<f64>, settings: &[Option<Setting>]) -> u64 {
        let mut words = vec![format!("case of {}", self.motions[motion].name)];
        words.extend(
            level.map(|level| format!("level {}", crate::scenario::quantity::plain(level))),
        );
        words.extend(self.factors.iter().zip(settings).filter_map(|(factor, setting)| {
            setting.as_ref().map(|setting| format!("{} = {}", factor.name, setting.word()))
        }));
        seed_of(self.seed, &words.join("|"))
    }

    /// Returns the value of a factor in a case, in the form in which it is written to the table; `None` if neither the
    /// case nor the base scenario states a value.
    pub(super) fn factor_value(&self, case: &PlannedCase, factor: usize) -> Option<Value> {
        match &case.settings[factor] {
            Some(setting) => Some(setting.value.clone()),
            None => self.factors[factor].base.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test")]

    use super::*;

    fn study(factors: &str, design: &str) -> Result<Study, String> {
        let text = format!(
            "schema = 1\n[base]\nextends = \"candia-8-barrels\"\n\
             [[motion]]\nsynthetic = {{ count = 400, kind = \"boore\", magnitude = 6, distance = \"8 km\" }}\n\
             {factors}[design]\n{design}\n"
        );
        Study::parse("s.toml", &text).map_err(|error| error.to_string())
    }

    fn factors(correlation: &str) -> String {
        let of = |pair: &str| {
            format!(
                "[[factor]]\nname = \"{pair}\"\nfield = \"interface.{pair}.friction.coefficient\"\n\
                 also = [\"interface.{pair}.friction.static_coefficient\"]\n\
                 distribution = {{ kind = \"lognormal\", median = 0.3, dispersion = 0.3 }}\n"
            )
        };
        format!("{}{}{}{correlation}", of("rack-ground"), of("barrel-rack"), of("barrel-ground"))
    }

    #[test]
    fn factors_of_a_group_are_correlated_and_others_are_not() {
        let group =
            "[[correlation]]\nfactors = [\"rack-ground\", \"barrel-rack\"]\ncoefficient = 0.7\n";
        for design in [
            "kind = \"stripes\"",
            "kind = \"sobol\"\ncount = 400",
            "kind = \"latin-hypercube\"\ncount = 400",
            "kind = \"monte-carlo\"\nmost = 400",
        ] {
            let intensity = if design.contains("stripes") {
                "[intensity]\nlevels = [\"50 cm/s\"]\n"
            } else {
                ""
            };
            let [plain, along] = ["", group].map(|group| {
                let study = study(&factors(&format!("{group}{intensity}")), design).unwrap();
                let case = |number| study.cases.case(&study, number).settings;
                (0..400).map(case).collect::<Vec<_>>()
            });
            let logs = |all: &[Vec<Option<Setting>>], factor: usize| -> Vec<f64> {
                all.iter()
                    .map(|case| (case[factor].as_ref().unwrap().number() / 0.3).ln())
                    .collect()
            };
            let correlation = |factors: [usize; 2]| {
                let [a, b] = factors.map(|factor| logs(&along, factor));
                let product =
                    |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
                product(&a, &b) / (product(&a, &a) * product(&b, &b)).sqrt()
            };
            let (found, other) = (correlation([0, 1]), correlation([0, 2]));
            // For 400 independent draws, the standard errors of the two correlations are 0.026 and 0.05.
            assert!((found - 0.7).abs() < 0.08 && other.abs() < 0.15, "{design}: {found} {other}");
            assert_eq!(logs(&plain, 2), logs(&along, 2), "{design}: a factor without a group");
            let scatter = logs(&along, 1).iter().map(|log| log * log).sum::<f64>() / 400.0;
            assert!((scatter.sqrt() / 0.3 - 1.0).abs() < 0.1, "{design}: {scatter}");
        }
    }

    #[test]
    fn groups_that_make_no_sense_are_refused_with_the_next_step() {
        let refused = |group: &str, design: &str| study(&factors(group), design).unwrap_err();
        let sobol = "kind = \"sobol\"\ncount = 8";
        for (factors, words) in [
            ("[\"rack-ground\"]", "at least two factors"),
            (
                "[\"rack-ground\", \"barrel\"]",
                "there is no factor \"barrel\": did you mean `barrel-rack`?",
            ),
            ("[\"rack-ground\", \"rack-ground\"]", "is listed twice"),
        ] {
            let group = format!("[[correlation]]\nfactors = {factors}\ncoefficient = 0.5\n");
            let error = refused(&group, sobol);
            assert!(error.contains(words) && error.contains("s.toml:"), "{error}");
        }
        let group = "[[correlation]]\nfactors = [\"rack-ground\", \"barrel-rack\"]\ncoefficient = ";
        assert!(refused(&format!("{group}1\n"), sobol).contains("0.95"));
        for design in ["kind = \"saltelli\"\ncount = 8", "kind = \"one-at-a-time\""] {
            let error = refused(&format!("{group}0.5\n"), design);
            assert!(error.contains("cannot be correlated") && error.contains("sobol"), "{error}");
        }
        let twice = format!("{group}0.5\n{group}0.3\n");
        assert!(refused(&twice, sobol).contains("is listed twice"));
    }
}
