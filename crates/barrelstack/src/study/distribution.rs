//! Distributions of values, given by their quantiles.

use crate::scenario::ScenarioError;
use crate::scenario::reader::Reader;
use crate::scenario::tree::Origin;

use super::fields::Form;
use super::setting::{Domain, Setting};

/// A distribution of the values of a field.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution {
    shape: Shape,
    domain: Domain,
    /// Where it was written.
    origin: Origin,
}

/// Forms, in SI units.
#[derive(Clone, Debug, PartialEq)]
enum Shape {
    Uniform {
        from: f64,
        to: f64,
    },
    LogUniform {
        from: f64,
        to: f64,
    },
    Normal {
        mean: f64,
        deviation: f64,
        cut: Cut,
    },
    Lognormal {
        median: f64,
        dispersion: f64,
        cut: Cut,
    },
    /// Values, each with the probability of it and those before.
    Discrete(Vec<(f64, Setting)>),
}

/// Where a distribution is cut off.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cut {
    /// Least and greatest value.
    values: [f64; 2],
    /// The probabilities of lying below each, uncut.
    below: [f64; 2],
}

impl Distribution {
    /// Reads `[….distribution]`.
    pub(super) fn read(
        reader: Reader<'_>,
        domain: Domain,
        origin: Origin,
    ) -> Result<Self, ScenarioError> {
        let number = |name| domain.number(&reader, name);
        let form: Form = reader.choice("kind")?;
        if form != Form::Discrete && !domain.continuous() {
            let message = format!(
                "only a field of numbers or quantities has a {}; list its values: distribution = {{ kind = \
                 \"discrete\", values = […] }}",
                "distribution of another kind"
            );
            return Err(reader.inconsistent("kind", message));
        }
        let shape = match form {
            Form::Uniform | Form::LogUniform => {
                let (from, to) = (number("from")?, number("to")?);
                if from >= to {
                    return Err(reader.inconsistent("to", "`to` must be above `from`".to_owned()));
                }
                if form == Form::Uniform {
                    Shape::Uniform { from, to }
                } else {
                    positive(&reader, "from", from)?;
                    Shape::LogUniform { from, to }
                }
            }
            Form::Normal => {
                let (mean, deviation) = (number("mean")?, number("deviation")?);
                positive(&reader, "deviation", deviation)?;
                let below = |value: f64| normal_probability((value - mean) / deviation);
                Shape::Normal { mean, deviation, cut: Cut::read(&reader, domain, below)? }
            }
            Form::Lognormal => {
                let (median, dispersion) = (number("median")?, reader.number("dispersion")?);
                positive(&reader, "median", median)?;
                let below = |value: f64| {
                    if value <= 0.0 {
                        0.0
                    } else {
                        normal_probability(libm::log(value / median) / dispersion)
                    }
                };
                Shape::Lognormal { median, dispersion, cut: Cut::read(&reader, domain, below)? }
            }
            Form::Discrete => Shape::Discrete(discrete(&reader, domain)?),
        };
        reader.finish();
        Ok(Self { shape, domain, origin })
    }

    /// The value below which a share `u` of the distribution lies, from 0 up to but not including 1.
    pub(super) fn quantile(&self, u: f64) -> Setting {
        let value = match &self.shape {
            Shape::Uniform { from, to } => from + u * (to - from),
            Shape::LogUniform { from, to } => from * libm::exp(u * libm::log(to / from)),
            Shape::Normal { mean, deviation, cut } => {
                cut.within(mean + deviation * normal_quantile(cut.uncut(u)))
            }
            Shape::Lognormal { median, dispersion, cut } => {
                cut.within(median * libm::exp(dispersion * normal_quantile(cut.uncut(u))))
            }
            Shape::Discrete(values) => {
                let at = values.partition_point(|(below, _)| *below <= u).min(values.len() - 1);
                return values[at].1.clone();
            }
        };
        self.domain.setting(value, self.origin)
    }

    /// The values of a discrete distribution.
    pub(super) fn settings(&self) -> Option<impl Iterator<Item = &Setting>> {
        if let Shape::Discrete(values) = &self.shape {
            Some(values.iter().map(|(_, setting)| setting))
        } else {
            None
        }
    }
}

impl Cut {
    fn read(
        reader: &Reader<'_>,
        domain: Domain,
        below: impl Fn(f64) -> f64,
    ) -> Result<Self, ScenarioError> {
        let bound = |name, none| {
            if reader.node(name)?.is_some() { domain.number(reader, name) } else { Ok(none) }
        };
        let values = [bound("least", f64::NEG_INFINITY)?, bound("greatest", f64::INFINITY)?];
        let below = values.map(below);
        if below[1] - below[0] < 1e-9 {
            let which = if reader.has("least") { "least" } else { "greatest" };
            let message =
                "`least` and `greatest` leave nothing of the distribution between them".to_owned();
            return Err(reader.inconsistent(which, message));
        }
        Ok(Self { values, below })
    }

    /// The share of the uncut distribution below what has a share `u` of the cut one below it.
    fn uncut(&self, u: f64) -> f64 {
        self.below[0] + u * (self.below[1] - self.below[0])
    }

    fn within(&self, value: f64) -> f64 {
        value.clamp(self.values[0], self.values[1])
    }
}

fn positive(reader: &Reader<'_>, name: &str, value: f64) -> Result<(), ScenarioError> {
    if value > 0.0 {
        return Ok(());
    }
    Err(reader.inconsistent(name, format!("`{}` must be above zero here", reader.path_of(name))))
}

fn discrete(reader: &Reader<'_>, domain: Domain) -> Result<Vec<(f64, Setting)>, ScenarioError> {
    let settings = domain.settings(reader, "values")?;
    let weights: Vec<f64> = match reader.nodes("weights")? {
        None => vec![1.0; settings.len()],
        Some(nodes) => nodes
            .iter()
            .map(|node| {
                reader.read_number("weights", node, crate::scenario::field::Range::NOT_NEGATIVE)
            })
            .collect::<Result<_, _>>()?,
    };
    let total: f64 = weights.iter().sum();
    if weights.len() != settings.len() || total <= 0.0 {
        let message = format!(
            "there are {} values and {} weights with the sum {total}; give one weight for each value, not all 0",
            settings.len(),
            weights.len()
        );
        return Err(reader.inconsistent("weights", message));
    }
    let mut below = 0.0;
    Ok(settings
        .into_iter()
        .zip(weights)
        .map(|(setting, weight)| {
            below += weight / total;
            (below, setting)
        })
        .collect())
}

/// The probability that a standard normal deviate lies below `z`.
pub(super) fn normal_probability(z: f64) -> f64 {
    0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2)
}

/// The standard normal deviate below which a share `p` lies, to 1e-14: Acklam's rational function (2003),
/// relative error 1.15e-9, then a step of Halley's method on the error function.
pub(super) fn normal_quantile(p: f64) -> f64 {
    const A: [f64; 6] = [
        -3.969_683_028_665_376e1,
        2.209_460_984_245_205e2,
        -2.759_285_104_469_687e2,
        1.383_577_518_672_69e2,
        -3.066_479_806_614_716e1,
        2.506_628_277_459_239,
    ];
    const B: [f64; 5] = [
        -5.447_609_879_822_406e1,
        1.615_858_368_580_409e2,
        -1.556_989_798_598_866e2,
        6.680_131_188_771_972e1,
        -1.328_068_155_288_572e1,
    ];
    const C: [f64; 6] = [
        -7.784_894_002_430_293e-3,
        -3.223_964_580_411_365e-1,
        -2.400_758_277_161_838,
        -2.549_732_539_343_734,
        4.374_664_141_464_968,
        2.938_163_982_698_783,
    ];
    const D: [f64; 4] = [
        7.784_695_709_041_462e-3,
        3.224_671_290_700_398e-1,
        2.445_134_137_142_996,
        3.754_408_661_907_416,
    ];
    // Beyond this no draw of 53 bits comes.
    let p = p.clamp(1e-300, 1.0 - 1e-16);
    let tail = |q: f64| {
        (((((C[0] * q + C[1]) * q + C[2]) * q + C[3]) * q + C[4]) * q + C[5])
            / ((((D[0] * q + D[1]) * q + D[2]) * q + D[3]) * q + 1.0)
    };
    let z = if p < 0.02425 {
        tail((-2.0 * libm::log(p)).sqrt())
    } else if p > 1.0 - 0.02425 {
        -tail((-2.0 * libm::log(1.0 - p)).sqrt())
    } else {
        let q = p - 0.5;
        let r = q * q;
        (((((A[0] * r + A[1]) * r + A[2]) * r + A[3]) * r + A[4]) * r + A[5]) * q
            / (((((B[0] * r + B[1]) * r + B[2]) * r + B[3]) * r + B[4]) * r + 1.0)
    };
    let error = normal_probability(z) - p;
    let u = error * (std::f64::consts::TAU).sqrt() * libm::exp(0.5 * z * z);
    z - u / (1.0 + 0.5 * z * u)
}

#[cfg(test)]
mod tests {
    use super::normal_quantile;

    #[test]
    fn quantiles_of_the_normal_distribution_are_those_of_scipy() {
        // scipy.stats.norm.ppf.
        let known = [
            (1e-12, -7.034_483_825_301_131),
            (1e-6, -4.753_424_308_822_899),
            (0.01, -2.326_347_874_040_840_8),
            (0.02425, -1.972_961_051_311_885),
            (0.1, -1.281_551_565_544_600_4),
            (0.5, 0.0),
            (0.9, 1.281_551_565_544_600_4),
            (0.999, 3.090_232_306_167_813),
        ];
        for (p, z) in known {
            // Measured: 2e-15 of z or less.
            let found = normal_quantile(p);
            assert!((found - z).abs() < 1e-13 * z.abs().max(1.0), "{p}: {found} for {z}");
        }
        // No draw is without end.
        assert!(normal_quantile(0.0).is_finite() && normal_quantile(1.0).is_finite());
    }
}
