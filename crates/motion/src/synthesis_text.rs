//! Describes synthetic motions in sentences with units, for the provenance.

use std::fmt::{Display, Formatter, Result};

use barrelstack_series::words::Short;

use crate::synthesis::{BooreSource, CloughPenzien, Envelope, NearFault, SiteAmplification};

impl Display for Envelope {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match *self {
            Self::Flat => write!(f, "without envelope"),
            Self::Jennings { rise, decay_start, decay } => write!(
                f,
                "rising over {} s and decaying from {} s at {} 1/s (Jennings)",
                Short(rise),
                Short(decay_start),
                Short(decay)
            ),
            Self::SaragoniHart { peak, exponent } => {
                let [peak, exponent] = [peak, exponent].map(Short);
                write!(f, "with its peak at {peak} s and exponent {exponent} (Saragoni and Hart)")
            }
        }
    }
}

impl Display for CloughPenzien {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(
            f,
            "{} m/s2 rms, ground of {} rad/s and damping ratio {}, high-pass of {} rad/s and damping \
             ratio {}",
            Short(self.rms),
            Short(self.ground_frequency),
            Short(self.ground_damping),
            Short(self.filter_frequency),
            Short(self.filter_damping)
        )
    }
}

impl Display for BooreSource {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let path = &self.path;
        write!(
            f,
            "magnitude {} at {} km, stress parameter {} bar, {} km/s and {} g/cm3 at the source, Q = \
             {} f^{}, kappa {} s, ",
            Short(self.magnitude),
            Short(path.distance),
            Short(self.stress),
            Short(self.velocity),
            Short(self.density),
            Short(path.quality),
            Short(path.quality_exponent),
            Short(path.kappa)
        )?;
        match &path.amplification {
            SiteAmplification::None => write!(f, "no site amplification"),
            SiteAmplification::Table(points) => {
                write!(f, "site amplification at {} frequencies", points.len())
            }
        }
    }
}

impl Display for NearFault {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(
            f,
            "{} from {} s on, plus the stochastic method above {} times the pulse frequency: {}",
            self.pulse,
            Short(self.start),
            Short(self.crossover),
            self.rest
        )
    }
}
