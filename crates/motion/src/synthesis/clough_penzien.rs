//! Filtered white noise with an envelope: the spectrum of Kanai and Tajimi with the high-pass
//! filter of Clough and Penzien.

use crate::error::MotionError;
use crate::fourier::{Complex, inverse};
use crate::ground_motion::GroundMotion;
use crate::math::{self, PI, TAU};
use crate::process::Processing;
use crate::random::Random;
use crate::synthesis::{motion, step_count};

/// Amplitude of the noise as a function of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Envelope {
    /// Constant 1, for a stationary motion.
    Flat,
    /// `(t/t₁)²` up to `t₁`, 1 up to `t₂`, then `exp(-c (t - t₂))`
    /// (Jennings, Housner and Tsai 1968).
    Jennings {
        /// End of the rise `t₁` (s).
        rise: f64,
        /// Start of the decay `t₂` (s).
        decay_start: f64,
        /// Rate of the decay `c` (1/s).
        decay: f64,
    },
    /// `(t/t_p)^b exp(b (1 - t/t_p))`, 1 at the peak time (Saragoni and Hart 1974).
    SaragoniHart {
        /// Time of the peak `t_p` (s).
        peak: f64,
        /// Exponent `b`.
        exponent: f64,
    },
}

impl Envelope {
    /// Returns the envelope at time `t` (s).
    pub fn at(&self, t: f64) -> f64 {
        if t < 0.0 {
            return 0.0;
        }
        match *self {
            Self::Flat => 1.0,
            Self::Jennings { rise, decay_start, decay } => {
                if t < rise {
                    (t / rise) * (t / rise)
                } else if t <= decay_start {
                    1.0
                } else {
                    math::exp(-decay * (t - decay_start))
                }
            }
            Self::SaragoniHart { peak, exponent } => {
                let x = t / peak;
                math::powf(x, exponent) * math::exp(exponent * (1.0 - x))
            }
        }
    }

    fn check(&self) -> Result<(), MotionError> {
        match *self {
            Self::Flat => Ok(()),
            Self::Jennings { rise, decay_start, decay } => {
                MotionError::require_positive("envelope rise (s)", rise)?;
                MotionError::require_positive("envelope decay (1/s)", decay)?;
                let (what, expected) =
                    ("envelope decay start (s)", format!("at least the rise, {rise}"));
                MotionError::require(decay_start >= rise, what, expected, decay_start)
            }
            Self::SaragoniHart { peak, exponent } => {
                MotionError::require_positive("envelope peak (s)", peak)?;
                MotionError::require_positive("envelope exponent", exponent)
            }
        }
    }
}

/// Stochastic acceleration with the two-sided spectral density
///
/// ```text
/// S(w) = S0 · (wg⁴ + 4 zg² wg² w²)/((wg² - w²)² + 4 zg² wg² w²)
///           · w⁴/((wf² - w²)² + 4 zf² wf² w²)
/// ```
///
/// computed as a sum of cosines with random phases and multiplied by an envelope. The second factor
/// vanishes at w = 0 and thus keeps the velocity bounded. The first factor alone, the spectrum of
/// Kanai and Tajimi, does not.
///
/// ```
/// use barrelstack_motion::{CloughPenzien, Envelope};
/// let soil = CloughPenzien::medium(1.5);
/// let envelope = Envelope::Jennings { rise: 2.0, decay_start: 10.0, decay: 0.4 };
/// let motion = soil.motion(&envelope, 20.0, 0.01, 42)?;
/// assert_eq!(motion, soil.motion(&envelope, 20.0, 0.01, 42)?);
/// # Ok::<(), barrelstack_motion::MotionError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloughPenzien {
    /// Root mean square of the stationary acceleration (m/s²); determines `S0`.
    pub rms: f64,
    /// Ground frequency `wg` (rad/s).
    pub ground_frequency: f64,
    /// Ground damping ratio `zg`.
    pub ground_damping: f64,
    /// High-pass frequency `wf` (rad/s).
    pub filter_frequency: f64,
    /// High-pass damping ratio `zf`.
    pub filter_damping: f64,
}

impl CloughPenzien {
    /// Returns the firm-soil model of Der Kiureghian and Neuenhofer (1992).
    pub fn firm(rms: f64) -> Self {
        Self::new(rms, 15.0, 0.6, 1.5, 0.6)
    }

    /// Returns the medium-soil model of Der Kiureghian and Neuenhofer (1992).
    pub fn medium(rms: f64) -> Self {
        Self::new(rms, 10.0, 0.4, 1.0, 0.6)
    }

    /// Returns the soft-soil model of Der Kiureghian and Neuenhofer (1992).
    pub fn soft(rms: f64) -> Self {
        Self::new(rms, 5.0, 0.2, 0.5, 0.6)
    }

    fn new(rms: f64, wg: f64, zg: f64, wf: f64, zf: f64) -> Self {
        Self {
            rms,
            ground_frequency: wg,
            ground_damping: zg,
            filter_frequency: wf,
            filter_damping: zf,
        }
    }

    /// Returns the spectral density relative to `S0` at `w` (rad/s).
    fn shape(&self, w: f64) -> f64 {
        let term = |w0: f64, z: f64| {
            let (a, b) = (w0 * w0 - w * w, 2.0 * z * w0 * w);
            (a * a + b * b, (w0 * w0) * (w0 * w0) + b * b)
        };
        let (ground, above) = term(self.ground_frequency, self.ground_damping);
        let (filter, _) = term(self.filter_frequency, self.filter_damping);
        above / ground * ((w * w) * (w * w)) / filter
    }

    /// Returns the two-sided spectral density of the stationary acceleration (m²/s³) at `w`
    /// (rad/s).
    ///
    /// `S0` is chosen so that the integral of the density gives the variance `rms²`. The integral
    /// covers the frequencies that `time_step` (s) resolves, which are at most π/`time_step`.
    pub fn density(&self, w: f64, time_step: f64) -> f64 {
        self.rms * self.rms / self.unit_variance(time_step) * self.shape(w)
    }

    /// Returns the variance of the stationary acceleration for `S0 = 1`, from the frequencies up to
    /// π/`time_step`.
    fn unit_variance(&self, time_step: f64) -> f64 {
        let top = PI / time_step;
        let n = 20_000;
        let dw = top / f64::from(n);
        2.0 * math::trapezoid((0..=n).map(|k| self.shape(f64::from(k) * dw)), dw)
    }

    fn check(&self) -> Result<(), MotionError> {
        MotionError::require_positive("stationary rms acceleration (m/s2)", self.rms)?;
        MotionError::require_positive("ground frequency (rad/s)", self.ground_frequency)?;
        MotionError::require_positive("ground damping", self.ground_damping)?;
        MotionError::require_positive("filter frequency (rad/s)", self.filter_frequency)?;
        MotionError::require_positive("filter damping", self.filter_damping)
    }

    /// Returns unprocessed accelerations (m/s²); velocity and displacement do not end at zero.
    ///
    /// # Errors
    /// If a parameter is out of range.
    pub fn acceleration(
        &self,
        envelope: &Envelope,
        duration: f64,
        time_step: f64,
        seed: u64,
    ) -> Result<Vec<f64>, MotionError> {
        self.check()?;
        envelope.check()?;
        let steps = step_count(duration, time_step)?;
        let length = (steps + 1).next_power_of_two();
        let dw = TAU / (length as f64 * time_step);
        let scale = self.rms * self.rms / self.unit_variance(time_step);
        let mut random = Random::new(seed);
        let mut spectrum = vec![Complex::default(); length];
        // a = Σ √(4 S dw) cos(w_k t + φ_k); half of each cosine is at k, half at -k.
        for k in 1..length / 2 {
            let amplitude = (4.0 * scale * self.shape(k as f64 * dw) * dw).sqrt();
            let (s, c) = math::sin_cos(TAU * random.uniform());
            let half = 0.5 * amplitude * length as f64;
            spectrum[k] = Complex { re: half * c, im: half * s };
            spectrum[length - k] = Complex { re: half * c, im: -half * s };
        }
        inverse(&mut spectrum);
        Ok((0..=steps).map(|k| envelope.at(k as f64 * time_step) * spectrum[k].re).collect())
    }

    /// Returns a motion of the given duration (s) after which the ground is at rest at its initial
    /// position.
    ///
    /// # Errors
    /// The same as for [`CloughPenzien::acceleration`].
    pub fn motion(
        &self,
        envelope: &Envelope,
        duration: f64,
        time_step: f64,
        seed: u64,
    ) -> Result<GroundMotion, MotionError> {
        let a = self.acceleration(envelope, duration, time_step, seed)?;
        let chain = Processing { taper: 0.02, close: true, ..Processing::none() };
        let made =
            format!("Clough-Penzien noise: {self}, {envelope}, {duration} s long, seed {seed}");
        motion(&format!("clough-penzien {seed}"), time_step, &a, &chain, made)
    }
}
