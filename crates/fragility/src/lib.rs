//! Fragility statistics: the probability of failure as a function of shaking intensity.
//!
//! The crate fits lognormal fragility curves to observed capacities, quantifies their uncertainty, tests the
//! fit against the data, and integrates fragility curves with the hazard curve of a site. It can be used for
//! any kind of structure and any kind of failure.
//!
//! # From counts to a rate
//!
//! ```
//! use barrelstack_fragility::{Dispersion, Hazard, Stripe, evidence, fit, profile_band};
//!
//! let stripes = [(0.2, 20, 1), (0.4, 20, 9), (0.6, 20, 15), (0.8, 20, 18)]
//!     .map(|(intensity, cases, failures)| Stripe { intensity, cases, failures });
//! let found = fit(&evidence(&stripes), Dispersion::Free)?;
//! assert!((found.curve.median - 0.44).abs() < 0.01);
//!
//! let band = profile_band(&evidence(&stripes), Dispersion::Free, 0.95, &[0.4])?;
//! assert!(band[0].low < 0.5 && 0.4 < band[0].high);
//!
//! let hazard = Hazard::new(&[(0.05, 0.1), (0.2, 0.01), (0.8, 0.0005), (2.0, 0.00005)])?;
//! let rate = hazard.rate_of(|x| found.curve.probability(x));
//! assert!(rate.low > 0.002 && rate.high < 0.006, "{rate:?}"); // per year
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Evidence
//!
//! All fits maximize the same likelihood. Every observation states that a capacity is *at* an intensity,
//! *below* an intensity (at which the case failed), *above* an intensity (at which the case stood) or
//! *between* two intensities. This covers failure counts at fixed intensities, capacities from incremental
//! dynamic analysis, bracketed capacities, and records under which nothing fails up to the largest intensity.
//!
//! # Data that do not determine a curve
//!
//! If the data do not determine a curve, the functions return a [`FitError`] with the reason: nothing failed,
//! everything failed, failures and survivals do not overlap, or failure does not become likelier with intensity. No
//! penalty, prior or clipping is used to turn such data into a plausible curve.
//!
//! # Random numbers
//!
//! Functions that resample data take uniform random numbers from the caller (`FnMut() -> f64`). The caller
//! chooses the generator and the seed.

// Results must be bit-identical on every machine, so transcendental functions are those of `libm` (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod bootstrap;
mod curve;
mod evidence;
mod fit;
mod goodness;
mod hazard;
mod ida;
mod indices;
mod likelihood;
mod math;
mod measures;
mod modes;
mod monotone;
mod profile;
mod proportion;
mod records;
pub mod sobol;
mod unknowns;

pub use bootstrap::{Replicates, simulate};
pub use curve::Lognormal;
pub use evidence::{Capacity, Evidence, Stripe, evidence, stripes};
pub use fit::{Dispersion, Fit, FitError, fit, moments};
pub use goodness::{
    Goodness, Normality, goodness, goodness_by_simulation, goodness_in_bins, normality,
};
pub use hazard::{Contribution, Hazard, HazardError, Rate, chance_within};
pub use ida::Ida;
pub use indices::{FEWEST_BLOCKS, Index, sobol_indices};
pub use math::{
    chi_square_above, normal, normal_density, normal_quantile, quantile, student_beyond,
    student_quantile,
};
pub use measures::{Demanded, Measured, demand_against, failure_against};
pub use modes::Shares;
pub use monotone::{Fall, Monotony, Returned, monotony, returns};
pub use profile::{profile_band, profile_median};
pub use proportion::{Interval, at_most, clopper_pearson, unobserved, wilson};
pub use records::{LeaveOneOut, grouped_mean, leave_one_out, mean_difference};
pub use unknowns::{
    Conditional, DrawnRun, FEWEST_RUNS, Influence, Intensities, Shaken, Shape, conditional,
    interval_of, shaken, share_less,
};

/// Includes the example of the README in the doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
