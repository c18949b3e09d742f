//! Boore's stochastic method: windowed noise, shaped to the Fourier spectrum of a point source.

use crate::error::MotionError;
use crate::fourier::{Complex, forward, inverse};
use crate::ground_motion::GroundMotion;
use crate::math::{self, PI};
use crate::process::Processing;
use crate::random::Random;
use crate::synthesis::{motion, step_count};

/// Site amplification of the Fourier amplitudes.
#[derive(Clone, Debug, PartialEq)]
pub enum SiteAmplification {
    /// No amplification.
    None,
    /// Points `(frequency (Hz), amplification)` in ascending order; between the points, the
    /// amplification is linear in the logarithm of frequency; outside, it is constant.
    Table(Vec<(f64, f64)>),
}

/// Propagation path of the waves from source to site.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Distance from source to site (km). Geometric spreading is `1/R` up to 70 km, constant up to
    /// 130 km, then `(130/R)^0.5/70` (Atkinson and Boore 1995).
    pub distance: f64,
    /// Quality factor `q` at 1 Hz. At the frequency `f` (Hz), the quality factor is `Q = q · f^exponent`,
    /// but at least a tenth of `q`.
    pub quality: f64,
    /// Exponent of the quality factor.
    pub quality_exponent: f64,
    /// High-frequency attenuation `κ` at the site (s).
    pub kappa: f64,
    /// Amplification at the site.
    pub amplification: SiteAmplification,
}

/// A Brune point source with its path (Boore 2003, PAGEOPH 160:635-676).
///
/// ```text
/// Y(f) = C M0 (2πf)² /(1 + (f/f0)²) · G(R) exp(-π f R/(Q β)) · A(f) exp(-π κ f)
/// f0 = 4.9e6 β (Δσ/M0)^(1/3)   with β in km/s, Δσ in bar, M0 in dyne cm
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct BooreSource {
    /// Moment magnitude.
    pub magnitude: f64,
    /// Stress parameter `Δσ` (bar).
    pub stress: f64,
    /// Shear-wave velocity `β` at the source (km/s).
    pub velocity: f64,
    /// Density at the source (g/cm³).
    pub density: f64,
    /// Path from source to site.
    pub path: Path,
}

/// Position of the peak of the time window, as a fraction of the length of the window.
const WINDOW_PEAK: f64 = 0.2;
/// Value of the time window at the end, relative to its peak.
const WINDOW_END: f64 = 0.05;

impl BooreSource {
    /// Returns a source typical of western North America: 70 bar, 3.5 km/s, 2.8 g/cm³,
    /// `Q = 180 f^0.45`, κ = 0.04 s. `magnitude` is the moment magnitude and `distance` is in km.
    pub fn western(magnitude: f64, distance: f64) -> Self {
        Self {
            magnitude,
            stress: 70.0,
            velocity: 3.5,
            density: 2.8,
            path: Path {
                distance,
                quality: 180.0,
                quality_exponent: 0.45,
                kappa: 0.04,
                amplification: SiteAmplification::None,
            },
        }
    }

    /// Returns the seismic moment (dyne cm) according to Hanks and Kanamori (1979).
    pub fn moment(&self) -> f64 {
        math::powf(10.0, 1.5 * self.magnitude + 16.05)
    }

    /// Returns the corner frequency (Hz).
    pub fn corner_frequency(&self) -> f64 {
        4.9e6 * self.velocity * math::powf(self.stress / self.moment(), 1.0 / 3.0)
    }

    /// Returns the duration of the strong part (s): `1/f0` for the source plus `0.05 R` for the
    /// path.
    pub fn strong_duration(&self) -> f64 {
        1.0 / self.corner_frequency() + 0.05 * self.path.distance
    }

    /// Returns the Fourier amplitude of the acceleration (m/s) at `f` (Hz).
    pub fn fourier_amplitude(&self, f: f64) -> f64 {
        if f <= 0.0 {
            return 0.0;
        }
        let path = &self.path;
        let f0 = self.corner_frequency();
        let w = 2.0 * PI * f;
        // Radiation pattern 0.55, free surface 2, partition 0.7071, reference distance 1 km. The
        // factor 1e-20 converts km and g/cm³ to cgs units, and the last factor 1e-2 converts cm to
        // m.
        let beta = self.velocity;
        let c = 0.55 * 2.0 * std::f64::consts::FRAC_1_SQRT_2 * 1e-20
            / (4.0 * PI * self.density * beta * beta * beta);
        let source = c * self.moment() * w * w / (1.0 + (f / f0) * (f / f0));
        let r = path.distance;
        let spreading = if r <= 70.0 {
            1.0 / r
        } else if r <= 130.0 {
            1.0 / 70.0
        } else {
            (130.0 / r).sqrt() / 70.0
        };
        let quality = (path.quality * math::powf(f, path.quality_exponent)).max(0.1 * path.quality);
        let attenuation = math::exp(-PI * f * r / (quality * beta));
        let site = match &path.amplification {
            SiteAmplification::None => 1.0,
            SiteAmplification::Table(points) => {
                let x: Vec<f64> = points.iter().map(|(f, _)| math::ln(*f)).collect();
                let y: Vec<f64> = points.iter().map(|(_, a)| *a).collect();
                math::interpolate(&x, &y, math::ln(f))
            }
        };
        0.01 * source * spreading * attenuation * site * math::exp(-PI * path.kappa * f)
    }

    fn check(&self) -> Result<(), MotionError> {
        let known = (1.0..=9.5).contains(&self.magnitude);
        MotionError::require(known, "moment magnitude", "1 to 9.5", self.magnitude)?;
        MotionError::require_positive("stress parameter (bar)", self.stress)?;
        MotionError::require_positive("shear-wave velocity (km/s)", self.velocity)?;
        MotionError::require_positive("density (g/cm3)", self.density)?;
        MotionError::require_positive("distance (km)", self.path.distance)?;
        MotionError::require_positive("quality factor", self.path.quality)?;
        MotionError::require_finite("quality exponent", self.path.quality_exponent)?;
        let kappa = self.path.kappa;
        MotionError::require(kappa >= 0.0 && kappa.is_finite(), "kappa (s)", "0 or above", kappa)?;
        let SiteAmplification::Table(points) = &self.path.amplification else { return Ok(()) };
        let rising = points.windows(2).all(|pair| pair[1].0 > pair[0].0);
        let positive = points.iter().all(|(f, a)| *f > 0.0 && *a > 0.0 && a.is_finite());
        MotionError::require(
            !points.is_empty() && rising && positive,
            "site amplification",
            "points of rising frequency with values above 0",
            format!("{} points", points.len()),
        )
    }

    /// Returns unprocessed accelerations (m/s²). The noise is normalized so that, over many seeds,
    /// the mean square of its Fourier amplitude at every frequency equals the square of the target amplitude.
    ///
    /// # Errors
    /// If a parameter is out of range.
    pub fn acceleration(&self, time_step: f64, seed: u64) -> Result<Vec<f64>, MotionError> {
        self.check()?;
        // The window falls to a twentieth of its peak at `window_length`; twice this length includes
        // its tail.
        let window_length = 2.0 * self.strong_duration();
        let steps = step_count(2.0 * window_length, time_step)?;
        let length = (steps + 1).next_power_of_two();
        let mut random = Random::new(seed);
        let mut energy = 0.0;
        let mut spectrum: Vec<Complex> = (0..length)
            .map(|k| {
                if k > steps {
                    return Complex::default();
                }
                let w = window(k as f64 * time_step / window_length);
                energy += w * w;
                Complex { re: w * random.normal(), im: 0.0 }
            })
            .collect();
        forward(&mut spectrum);
        // The mean-square Fourier amplitude of windowed unit noise is Σw², independent of the seed.
        let norm = 1.0 / energy.sqrt();
        let df = 1.0 / (length as f64 * time_step);
        for (k, value) in spectrum.iter_mut().enumerate() {
            let f = k.min(length - k) as f64 * df;
            *value = value.times(norm * self.fourier_amplitude(f) / time_step);
        }
        inverse(&mut spectrum);
        Ok(spectrum.iter().take(steps + 1).map(|x| x.re).collect())
    }

    /// Returns a motion that ends at rest at its initial position, high-passed at a fifth of the
    /// corner frequency (at least 0.05 Hz).
    ///
    /// # Errors
    /// The same as for [`BooreSource::acceleration`].
    pub fn motion(&self, time_step: f64, seed: u64) -> Result<GroundMotion, MotionError> {
        let a = self.acceleration(time_step, seed)?;
        let corner = (0.2 * self.corner_frequency()).max(0.05);
        let chain = Processing { taper: 0.02, high_pass: Some(corner), ..Processing::compact() };
        let made = format!("stochastic method: {self}, seed {seed}");
        motion(&format!("boore M{} {seed}", self.magnitude), time_step, &a, &chain, made)
    }
}

/// Returns the time window of Saragoni and Hart, `a x^b exp(-c x)`, with its peak of 1 at
/// `x = WINDOW_PEAK`. `x` is the time divided by the length of the window.
fn window(x: f64) -> f64 {
    let peak = WINDOW_PEAK;
    let b = -peak * math::ln(WINDOW_END) / (1.0 + peak * (math::ln(peak) - 1.0));
    let c = b / peak;
    math::powf(x / peak, b) * math::exp(b - c * x)
}
