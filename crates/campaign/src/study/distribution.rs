//! Distributions from which the values of a factor are drawn.

use barrelstack_fragility::{normal, normal_quantile};

use crate::scenario::ScenarioError;
use crate::scenario::reader::Reader;
use crate::scenario::tree::Origin;

use super::fields::Form;
use super::setting::{Domain, Setting};

/// Distribution of the values of a field.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution {
    shape: Shape,
    domain: Domain,
    /// Place in the study file where the distribution is defined.
    origin: Origin,
}

/// Shape of a distribution with its parameters, in SI units.
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
    /// Discrete values, each with the cumulative probability of the values up to and including it.
    Discrete(Vec<(f64, Setting)>),
}

/// Truncation of a distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cut {
    /// Smallest and largest value that remain after truncation.
    values: [f64; 2],
    /// Probability below each of the two `values` in the untruncated distribution.
    below: [f64; 2],
}

impl Distribution {
    /// Reads a `[….distribution]` table.
    pub(super) fn read(
        reader: Reader<'_>,
        domain: Domain,
        origin: Origin,
    ) -> Result<Self, ScenarioError> {
        let number = |name| domain.number(&reader, name);
        let form: Form = reader.choice("kind")?;
        if form != Form::Discrete && !domain.continuous() {
            let message = "only a field of numbers or quantities can have a continuous distribution; use a list of values: \
                           distribution = { kind = \"discrete\", values = […] }"
                .to_owned();
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
                let below = |value: f64| normal((value - mean) / deviation);
                Shape::Normal { mean, deviation, cut: Cut::read(&reader, domain, below)? }
            }
            Form::Lognormal => {
                let (median, dispersion) = (number("median")?, reader.number("dispersion")?);
                positive(&reader, "median", median)?;
                let below = |value: f64| {
                    if value <= 0.0 { 0.0 } else { normal(libm::log(value / median) / dispersion) }
                };
                Shape::Lognormal { median, dispersion, cut: Cut::read(&reader, domain, below)? }
            }
            Form::Discrete => Shape::Discrete(discrete(&reader, domain)?),
        };
        reader.finish();
        Ok(Self { shape, domain, origin })
    }

    /// Returns the value at which the cumulative probability is `u`, for `u` in `0..1`.
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

    /// Returns the standard normal deviate that has the same cumulative probability as a value; `None` if the
    /// distribution is discrete.
    pub(crate) fn deviate(&self, value: f64) -> Option<f64> {
        let part = |from: f64, to: f64| ((value - from) / (to - from)).clamp(1e-16, 1.0 - 1e-16);
        let u = match &self.shape {
            Shape::Uniform { from, to } => part(*from, *to),
            Shape::LogUniform { from, to } => {
                (libm::log(value / from) / libm::log(to / from)).clamp(1e-16, 1.0 - 1e-16)
            }
            Shape::Normal { mean, deviation, cut } => cut.cut((value - mean) / deviation),
            Shape::Lognormal { median, dispersion, cut } => {
                cut.cut(libm::log(value / median) / dispersion)
            }
            Shape::Discrete(_) => return None,
        };
        Some(normal_quantile(u))
    }

    /// Returns the value (SI) that has the same cumulative probability as a standard normal deviate; `None` if the
    /// distribution is discrete.
    pub(crate) fn at_deviate(&self, deviate: f64) -> Option<f64> {
        let value = self.quantile(normal(deviate)).number();
        Some(value).filter(|_| !matches!(self.shape, Shape::Discrete(_)))
    }

    /// Returns the dispersion of the distribution; NaN if it is discrete.
    ///
    /// For a lognormal distribution, this is the standard deviation of the natural logarithm before any truncation.
    /// For any other distribution, it is the dispersion of the lognormal distribution with the same 16 % and 84 %
    /// fractiles.
    pub(crate) fn dispersion(&self) -> f64 {
        if let Shape::Lognormal { dispersion, .. } = &self.shape {
            return *dispersion;
        }
        let [low, high] = [-1.0, 1.0].map(|deviate| self.at_deviate(deviate));
        low.zip(high).map_or(f64::NAN, |(low, high)| 0.5 * libm::log(high / low))
    }

    /// Returns the values of a discrete distribution; `None` for a continuous one.
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
                "no value of the distribution lies between `least` and `greatest`".to_owned();
            return Err(reader.inconsistent(which, message));
        }
        Ok(Self { values, below })
    }

    /// Converts a cumulative probability of the truncated distribution to the cumulative probability of the
    /// same value in the untruncated distribution.
    fn uncut(&self, u: f64) -> f64 {
        // The bounds keep the result away from 0 and 1, where quantiles are infinite. They do not change a draw, which
        // has a resolution of 53 bits.
        (self.below[0] + u * (self.below[1] - self.below[0])).clamp(1e-300, 1.0 - 1e-16)
    }

    /// Converts the standard normal deviate of a value in the untruncated distribution to the cumulative probability of
    /// that value in the truncated distribution.
    fn cut(&self, deviate: f64) -> f64 {
        let [from, to] = self.below;
        ((normal(deviate) - from) / (to - from)).clamp(1e-16, 1.0 - 1e-16)
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
    if weights.len() != settings.len() {
        let counted = |count: usize, thing: &str| {
            format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
        };
        let message = format!(
            "`{}` has {} for {}; give one weight per value",
            reader.path_of("weights"),
            counted(weights.len(), "weight"),
            counted(settings.len(), "value")
        );
        return Err(reader.inconsistent("weights", message));
    }
    if total <= 0.0 {
        let message = format!(
            "all weights in `{}` are 0, so no value can be drawn; give at least one value a weight above 0",
            reader.path_of("weights")
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

#[cfg(test)]
mod tests {
    use barrelstack_fragility::normal_quantile;

    use super::Cut;

    #[test]
    fn no_draw_is_without_end() {
        let whole = Cut { values: [f64::NEG_INFINITY, f64::INFINITY], below: [0.0, 1.0] };
        for u in [0.0, 1.0 - f64::EPSILON / 2.0, 1.0] {
            assert!(normal_quantile(whole.uncut(u)).is_finite(), "{u}");
        }
    }
}
