//! Results of the hindcasts: shares of stacks that fall, by study and height; posteriors of the unknowns; likelihoods
//! of the statements as functions of each unknown.

use std::fmt::Write as _;

use barrelstack_fragility::{Interval, wilson};

use super::FieldError;
use super::cases::{FieldCases, UNKNOWNS};
use super::chance::{MEDIANS, Point};
use super::weigh::{self, Fitted, Range};
use barrelstack_calibration::shares::{Earthquake, MODEL_ERROR, Statements};

/// Bin edges of the barrel–rack friction; the page gives a likelihood for each bin.
pub(super) const FRICTION: [f64; 7] = [0.12, 0.18, 0.25, 0.35, 0.45, 0.55, 0.75];

/// Bin edges of the rack–ground friction.
pub(super) const GROUND: [f64; 5] = [0.30, 0.42, 0.50, 0.60, 0.85];

/// Bin edges of the seat stiffness (MN/m).
pub(super) const STIFFNESS: [f64; 6] = [0.7, 1.5, 2.5, 4.0, 7.0, 13.0];

/// Names of the unknowns.
pub(super) const NAMES: [&str; UNKNOWNS] = [
    "friction barrel-rack",
    "friction rack-ground",
    "stiffness of a seat (MN/m)",
    "factor on the motion",
];

/// Share of the stacks with a given number of levels that fall in a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Share {
    /// Name of the study.
    pub study: String,
    /// Number of levels.
    pub levels: usize,
    /// Number of cases in which the stack falls, and number of all cases.
    pub count: (u32, u32),
    /// 95 % confidence interval (Wilson score interval) of the share of the simulated cases in which the stack falls.
    pub design: Interval,
    /// Fitted probability of a fall, averaged over the simulated cases.
    pub fitted: f64,
    /// Probability of a fall under the unscaled record if every unknown equals its median in the catalog, averaged over
    /// the azimuth.
    pub medians: f64,
    /// Mean and range of the probability of a fall over the prior.
    pub prior: Range,
    /// Mean and range of the probability of a fall over the posterior, given the statement `half` (half of the barrels
    /// are on the floor).
    pub posterior: Range,
    /// Mean share of fallen barrels in the stacks that fell.
    pub fallen: f64,
}

/// Posterior ranges of the unknowns, given a set of statements.
#[derive(Clone, Debug, PartialEq)]
pub struct Posterior {
    /// Name of the set of statements on which the posterior is conditioned, such as `prior` (no statement) or
    /// `all statements`.
    pub given: String,
    /// Effective number of draws, (Σ w)²/Σ w² for the weights w (Kish).
    pub effective: f64,
    /// Mean likelihood over the prior.
    pub evidence: f64,
    /// Posterior range of each unknown.
    pub unknowns: [Range; UNKNOWNS],
}

/// Mean likelihood of a statement if an unknown lies in a bin.
#[derive(Clone, Debug, PartialEq)]
pub struct Bin {
    /// Name of the statement.
    pub given: String,
    /// Index of the unknown.
    pub unknown: usize,
    /// Lower and upper edge of the bin.
    pub range: [f64; 2],
    /// Mean likelihood, at most 1.
    pub likelihood: f64,
}

/// Results of the hindcasts, from which the page, its tables and its figure are made.
#[derive(Clone, Debug, PartialEq)]
pub struct Results {
    /// Shares by study and height.
    pub shares: Vec<Share>,
    /// Posteriors given different sets of statements; the first one is the prior.
    pub posteriors: Vec<Posterior>,
    /// Mean likelihood of each statement, in each bin of each unknown.
    pub bins: Vec<Bin>,
    /// For each statement, its name and its predicted value, over the prior and over the posterior given the statement
    /// `half`.
    pub predictions: Vec<(String, Range, Range)>,
    /// For each value of the barrel–rack friction: the share of barrels on the floor, as mean and central 90 % interval
    /// over all other unknowns.
    pub curve: Vec<(f64, Range)>,
    /// For each of several values μ of the barrel–rack friction: the value, followed by its density per unit of ln μ in
    /// the prior, in the posterior given the statement `half`, and in the posterior given all statements.
    pub densities: Vec<[f64; 4]>,
}

impl Results {
    /// Computes the results from the observations and the simulated cases.
    pub(super) fn of(observations: &Statements, cases: &[FieldCases]) -> Result<Self, FieldError> {
        let fitted: Vec<Fitted<'_>> = cases.iter().map(Fitted::new).collect();
        let (napa, _) = observations
            .find("half")
            .ok_or_else(|| FieldError("there is no statement `half`".to_owned()))?;
        let draws = weigh::prior(napa.motion, 1);
        let even = vec![1.0; draws.len()];
        let mut results = Self {
            shares: vec![],
            posteriors: vec![posterior("prior", &draws, &even)],
            bins: vec![],
            predictions: vec![],
            curve: vec![],
            densities: vec![],
        };
        let weighed = results.weigh(observations, napa, &fitted, &draws)?;
        results.posteriors.push(posterior("all statements", &draws, &weighed.all));
        for one in &fitted {
            let at_napa =
                napa.studies.contains(&one.cases.study) || one.cases.study.contains("rack-on-rack");
            results.shares.extend(shares(one, at_napa, &draws, &weighed.half));
        }
        results.along_friction(&draws, &weighed);
        Ok(results)
    }

    /// Returns the weights of the draws, from the likelihoods of all statements for which a likelihood is defined. Adds
    /// the posteriors, bins and predictions of these statements to the results.
    ///
    /// # Errors
    /// If the cases of a study are missing.
    fn weigh(
        &mut self,
        observations: &Statements,
        napa: &Earthquake,
        fitted: &[Fitted<'_>],
        draws: &[[f64; UNKNOWNS]],
    ) -> Result<Weighed, FieldError> {
        let even = vec![1.0; draws.len()];
        let mut weighed = Weighed { half: even.clone(), all: even.clone(), shares: vec![] };
        let quakes = observations.earthquake.iter();
        let all = quakes.flat_map(|quake| quake.observation.iter().map(move |one| (quake, one)));
        for (seed, (quake, statement)) in (100..).zip(all) {
            let Some(likelihood) = statement.likelihood() else { continue };
            let study = |name: &String| {
                fitted.iter().find(|one| one.cases.study == *name).ok_or_else(|| {
                    FieldError(format!("the cases of the study `{name}` are missing"))
                })
            };
            let studies =
                statement.studies.iter().map(study).collect::<Result<Vec<_>, FieldError>>()?;
            // Each earthquake has its own scale factor of the motion.
            let own: Vec<[f64; UNKNOWNS]> = if quake.name == napa.name {
                draws.to_vec()
            } else {
                let factors = weigh::prior(quake.motion, 2);
                let joined = draws.iter().zip(&factors);
                joined.map(|(draw, factor)| [draw[0], draw[1], draw[2], factor[3]]).collect()
            };
            let shares = weigh::predicted(statement, &studies, &own, seed);
            let weights = weigh::weights(&shares, likelihood.wider(MODEL_ERROR));
            if statement.id == "half" {
                let sharp = weigh::weights(&shares, likelihood);
                self.posteriors.push(posterior(
                    "half, without an error of the model",
                    &own,
                    &sharp,
                ));
                weighed.half.clone_from(&weights);
                weighed.shares.clone_from(&shares);
            }
            self.posteriors.push(posterior(&statement.id, &own, &weights));
            for (unknown, edges) in [(0, &FRICTION[..]), (1, &GROUND[..]), (2, &STIFFNESS[..])] {
                for edges in edges.windows(2) {
                    let range = [edges[0], edges[1]];
                    if let Some(likelihood) = weigh::within(&own, &weights, unknown, range) {
                        let given = statement.id.clone();
                        self.bins.push(Bin { given, unknown, range, likelihood });
                    }
                }
            }
            for (product, weight) in weighed.all.iter_mut().zip(&weights) {
                *product *= weight;
            }
            self.predictions.push((
                statement.id.clone(),
                weigh::range(&shares, &even),
                weigh::range(&shares, &weighed.half),
            ));
        }
        Ok(weighed)
    }

    /// Computes, as functions of the barrel–rack friction, the share of barrels on the floor, and the prior and
    /// posterior densities of this friction.
    fn along_friction(&mut self, draws: &[[f64; UNKNOWNS]], weighed: &Weighed) {
        let even = vec![1.0; draws.len()];
        for edges in bins(24).windows(2) {
            let center = (edges[0] * edges[1]).sqrt();
            let inside = |draw: &[f64; UNKNOWNS]| draw[0] >= edges[0] && draw[0] < edges[1];
            let values: Vec<f64> = draws
                .iter()
                .zip(&weighed.shares)
                .filter(|(draw, _)| inside(draw))
                .map(|(_, share)| *share)
                .collect();
            if values.len() >= 50 {
                self.curve.push((center, weigh::range(&values, &even[..values.len()])));
            }
            let width = libm::log(edges[1] / edges[0]);
            let density = |weights: &[f64]| {
                let of = draws.iter().zip(weights).filter(|(draw, _)| inside(draw));
                of.map(|(_, w)| w).sum::<f64>() / weights.iter().sum::<f64>() / width
            };
            self.densities.push([
                center,
                density(&even),
                density(&weighed.half),
                density(&weighed.all),
            ]);
        }
    }

    /// Returns the posterior for the data with this name; `None` if there is none.
    pub fn given(&self, name: &str) -> Option<&Posterior> {
        self.posteriors.iter().find(|one| one.given == name)
    }

    /// Returns the prediction of a statement, over the prior and over the posterior given the statement `half`; `None`
    /// if there is no prediction.
    pub fn prediction(&self, id: &str) -> Option<(&Range, &Range)> {
        let found = self.predictions.iter().find(|(name, ..)| name == id);
        found.map(|(_, prior, posterior)| (prior, posterior))
    }

    /// Returns the shares as CSV.
    pub(super) fn shares_csv(&self) -> String {
        let mut text = "study,levels,fall,cases,share low 95,share high 95,fit over the design,catalog medians,prior mean,prior low 90,\
                        prior high 90,given half mean,given half low 90,given half high 90,barrels fallen in a \
                        fallen stack\n"
            .to_owned();
        for one in &self.shares {
            let (falls, cases) = one.count;
            let _ = write!(text, "{},{},{falls},{cases}", one.study, one.levels);
            let values = [
                one.design.low,
                one.design.high,
                one.fitted,
                one.medians,
                one.prior.mean,
                one.prior.low,
                one.prior.high,
                one.posterior.mean,
                one.posterior.low,
                one.posterior.high,
                one.fallen,
            ];
            for value in values {
                let _ = write!(text, ",{value:.3}");
            }
            text.push('\n');
        }
        text
    }

    /// Returns the posteriors as CSV.
    pub(super) fn posterior_csv(&self) -> String {
        let mut text =
            "given,unknown,median,low 90,high 90,effective draws,mean likelihood\n".to_owned();
        for one in &self.posteriors {
            for (name, range) in NAMES.iter().zip(&one.unknowns) {
                let _ = writeln!(
                    text,
                    "\"{}\",{name},{:.3},{:.3},{:.3},{:.0},{:.4}",
                    one.given, range.median, range.low, range.high, one.effective, one.evidence
                );
            }
        }
        text
    }

    /// Returns the likelihoods as CSV.
    pub(super) fn likelihood_csv(&self) -> String {
        let mut text = "given,unknown,from,to,mean likelihood\n".to_owned();
        for bin in &self.bins {
            let [from, to] = bin.range;
            let name = NAMES[bin.unknown];
            let _ = writeln!(text, "{},{name},{from},{to},{:.4}", bin.given, bin.likelihood);
        }
        text
    }
}

/// Weights of the draws.
struct Weighed {
    /// Weights given the statement `half`.
    half: Vec<f64>,
    /// Weights given all statements.
    all: Vec<f64>,
    /// For each draw, the predicted share of barrels on the floor of Napa Barrel Care (the statement `half`).
    shares: Vec<f64>,
}

/// Number of draws from which shares by height are computed.
const FEW: usize = 4000;

/// Returns the shares of a study by height. `at_napa` is `true` for the station to which the drawn scale factors of the
/// motion apply; at the other stations the factor is 1. `half` contains the weights of the draws given the statement
/// `half`.
fn shares(one: &Fitted<'_>, at_napa: bool, draws: &[[f64; UNKNOWNS]], half: &[f64]) -> Vec<Share> {
    let turn = |at: usize| std::f64::consts::TAU * (at as f64 / 64.0).fract();
    let own = |draw: &[f64; UNKNOWNS]| {
        if at_napa { *draw } else { [draw[0], draw[1], draw[2], 1.0] }
    };
    let even = vec![1.0; FEW];
    let of = |(place, levels): (usize, usize)| {
        let count = FieldCases::count(one.cases.of(levels));
        let chance = |unknowns: [f64; UNKNOWNS], azimuth: f64, fit: Option<usize>| {
            one.share(levels, &Point { unknowns, azimuth }, fit)
        };
        let few = draws.iter().take(FEW).enumerate();
        let values: Vec<f64> =
            few.map(|(at, draw)| chance(own(draw), turn(at), Some(at / 7))).collect();
        let turned: f64 = (0..64).map(|at| chance(MEDIANS, turn(at), None)).sum();
        Share {
            study: one.cases.study.clone(),
            levels,
            count,
            design: wilson(count.0, count.1, 0.95),
            fitted: one.over_the_design(levels),
            medians: turned / 64.0,
            prior: weigh::range(&values, &even),
            posterior: weigh::range(&values, &half[..FEW]),
            fallen: one.fallen[place],
        }
    };
    (2..=6).enumerate().map(of).collect()
}

fn posterior(given: &str, draws: &[[f64; UNKNOWNS]], weights: &[f64]) -> Posterior {
    let unknown = |at: usize| {
        let values: Vec<f64> = draws.iter().map(|draw| draw[at]).collect();
        weigh::range(&values, weights)
    };
    Posterior {
        given: given.to_owned(),
        effective: weigh::effective(weights),
        evidence: weights.iter().sum::<f64>() / weights.len() as f64,
        unknowns: std::array::from_fn(unknown),
    }
}

/// Returns the edges of `count` bins that cover the range of the barrel–rack friction. The ratio of successive edges is
/// constant.
fn bins(count: usize) -> Vec<f64> {
    let [low, high] = weigh::RANGES[0];
    (0..=count).map(|at| low * libm::pow(high / low, at as f64 / count as f64)).collect()
}
