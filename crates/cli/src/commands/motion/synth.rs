//! `barrelstack motion synth`: motions from formulas, and from random numbers with a given seed.

use anyhow::anyhow;
use barrelstack::scenario::Dimension;
use barrelstack_motion::{
    BooreSource, Channel, CloughPenzien, Direction, Envelope, GroundMotion, NearFault, Pulse,
    Record, SiteAmplification,
};
use clap::{Subcommand, ValueEnum};

use super::input::{self, quantity};
use super::measures;
use super::output::Output;
use super::pulses::{Harmonic, Repeated, Size, Wavelet};
use crate::number::{real, whole};
use crate::typed::word;

/// Arguments of `synth`.
#[derive(Debug, clap::Args)]
pub(super) struct SynthArgs {
    /// Kind of synthetic motion.
    #[command(subcommand)]
    kind: Kind,
}

/// Options of every synthetic motion.
#[derive(Debug, clap::Args)]
struct Common {
    /// Time step of the file; by default 0.005 s for random motions, and 1/400 of the period for
    /// pulses.
    #[arg(long, value_name = "TIME")]
    time_step: Option<String>,
    /// Make the motion a vertical component instead of a horizontal one.
    #[arg(long)]
    vertical: bool,
    #[command(flatten)]
    output: Output,
}

/// Options of random motions.
#[derive(Debug, clap::Args)]
struct Seed {
    /// Seed of the random numbers; the same seed gives the same motion on every machine.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 1, allow_negative_numbers = true,
        value_parser = whole(0..=u64::MAX)
    )]
    seed: u64,
}

/// Kind of synthetic motion.
#[derive(Debug, Subcommand)]
enum Kind {
    /// Harmonic displacement with ramps at both ends.
    Sine(Made<Harmonic>),
    /// Acceleration in the form of half a sine wave; leaves a residual velocity.
    HalfSine(Made<Size>),
    /// Acceleration in the form of one full sine wave; leaves a residual displacement.
    OneSine(Made<Size>),
    /// Acceleration in the form of one full cycle of a cosine.
    OneCosine(Made<Size>),
    /// Acceleration in the form of a Ricker wavelet; ends at rest at its starting point.
    Ricker(Made<Size>),
    /// Velocity in the form of a Gabor wavelet.
    Gabor(Made<Wavelet>),
    /// Cycloidal pulse of type A: a permanent forward displacement.
    CycloidA(Made<Size>),
    /// Cycloidal pulse of type B: a forward displacement, and the return.
    CycloidB(Made<Size>),
    /// Cycloidal pulse of type C: several cycles of displacement.
    CycloidC(Made<Repeated>),
    /// Near-fault velocity pulse of Mavroeidis and Papageorgiou.
    MavroeidisPapageorgiou(Made<Wavelet>),
    /// Filtered white noise under an envelope (Clough and Penzien).
    CloughPenzien(Made<Noise>),
    /// Stochastic method for a point source (Boore).
    Boore(Made<Source>),
    /// A velocity pulse added to a stochastic motion.
    NearFault(Made<Fault>),
}

/// Arguments of one kind of motion, together with the options of all kinds.
#[derive(Debug, clap::Args)]
struct Made<T: clap::Args> {
    #[command(flatten)]
    kind: T,
    #[command(flatten)]
    common: Common,
}

impl Made<Size> {
    /// Makes and writes a pulse that is defined by peak and period.
    fn pulse(&self, name: &str, shape: impl FnOnce(f64) -> Pulse) -> anyhow::Result<()> {
        write(&self.common, |_| self.kind.motion(name, |period| Ok(shape(period))))
    }
}

impl Made<Wavelet> {
    /// Makes and writes a wavelet with a period (s), a width and a phase (rad).
    fn wavelet(
        &self,
        name: &str,
        shape: impl FnOnce(f64, f64, f64) -> Pulse,
    ) -> anyhow::Result<()> {
        let w = &self.kind;
        write(&self.common, |_| {
            w.size.motion(name, |period| Ok(shape(period, w.gamma, w.phase()?)))
        })
    }
}

/// Soil types of Der Kiureghian and Neuenhofer (1992).
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Soil {
    /// Ground frequency 15 rad/s.
    Firm,
    /// Ground frequency 10 rad/s.
    Medium,
    /// Ground frequency 5 rad/s.
    Soft,
}

/// Options of filtered white noise.
#[derive(Debug, clap::Args)]
struct Noise {
    /// Soil type.
    #[arg(long, value_enum, default_value_t = Soil::Medium)]
    soil: Soil,
    /// Root mean square of the acceleration at full strength.
    #[arg(long, value_name = "ACCELERATION", default_value = "0.1 g")]
    rms: String,
    /// Duration of the motion.
    #[arg(long, value_name = "TIME", default_value = "20 s")]
    duration: String,
    /// Time at which the motion reaches full strength.
    #[arg(long, value_name = "TIME", default_value = "2 s")]
    rise: String,
    /// Time at which the decay starts.
    #[arg(long, value_name = "TIME", default_value = "10 s")]
    decay_start: String,
    /// Time in which the amplitude decays to 1/e.
    #[arg(long, value_name = "TIME", default_value = "2.5 s")]
    decay: String,
    #[command(flatten)]
    seed: Seed,
}

/// Options of a point source in western North America; each option overrides a default.
#[derive(Debug, clap::Args)]
struct Source {
    /// Moment magnitude of the earthquake.
    #[arg(
        long, value_name = "NUMBER", allow_negative_numbers = true,
        value_parser = real("a moment magnitude from 1 to 9.5, such as 6.5", |number| (1.0..=9.5).contains(&number))
    )]
    magnitude: f64,
    /// Distance from source to site.
    #[arg(long, value_name = "LENGTH")]
    distance: String,
    /// Stress parameter of the source.
    #[arg(long, value_name = "STRESS", default_value = "7 MPa")]
    stress: String,
    /// High-frequency attenuation at the site.
    #[arg(long, value_name = "TIME", default_value = "0.04 s")]
    kappa: String,
    /// Shear-wave velocity at the source.
    #[arg(long, value_name = "VELOCITY", default_value = "3500 m/s")]
    beta: String,
    /// Quality factor of the path: its value at 1 Hz and, after a comma, the exponent of the
    /// frequency in Hz.
    #[arg(long, value_name = "Q,EXPONENT", default_value = "180,0.45")]
    quality: String,
    /// Site amplification of Fourier amplitudes: pairs of frequency in Hz and factor, in ascending
    /// order, such as "0.1,1;1,1.5;10,2"; by default 1.
    #[arg(long, value_name = "TABLE")]
    site_amplification: Option<String>,
    #[command(flatten)]
    seed: Seed,
}

/// Options of a near-fault motion, which consists of a pulse and a stochastic remainder.
#[derive(Debug, clap::Args)]
struct Fault {
    #[command(flatten)]
    source: Source,
    /// Velocity amplitude of the pulse.
    #[arg(long, value_name = "VELOCITY")]
    pulse_velocity: String,
    /// Period of the pulse.
    #[arg(long, value_name = "TIME")]
    pulse_period: String,
    /// Width of the pulse, above 1; determines the number of cycles.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 2.0, allow_negative_numbers = true,
        value_parser = real("a number above 1, such as 2", |number| number > 1.0)
    )]
    gamma: f64,
    /// Phase of the pulse.
    #[arg(long, value_name = "ANGLE", default_value = "0 deg", allow_hyphen_values = true)]
    phase: String,
    /// Start of the pulse.
    #[arg(long, value_name = "TIME", default_value = "2 s")]
    start: String,
    /// Lowest frequency of the stochastic remainder, as a multiple of the pulse frequency.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 1.0, allow_negative_numbers = true,
        value_parser = real("a number above 0, such as 1", |number| number > 0.0)
    )]
    crossover: f64,
}

impl Source {
    fn build(&self) -> anyhow::Result<BooreSource> {
        let kilometers = quantity("--distance", &self.distance, Dimension::LENGTH)? / 1000.0;
        let mut source = BooreSource::western(self.magnitude, kilometers);
        // The formula expects the stress in bar.
        let pascal = quantity("--stress", &self.stress, Dimension::STIFFNESS_PER_LENGTH)?;
        source.stress = pascal / 1e5;
        source.path.kappa = quantity("--kappa", &self.kappa, Dimension::TIME)?;
        source.velocity = quantity("--beta", &self.beta, Dimension::VELOCITY)? / 1000.0;
        let numbers = pair(&self.quality).ok_or_else(|| {
            anyhow!(
                "--quality: expected a factor and an exponent, such as 180,0.45, found `{}`",
                self.quality
            )
        })?;
        (source.path.quality, source.path.quality_exponent) = numbers;
        if let Some(text) = &self.site_amplification {
            let points: Option<Vec<(f64, f64)>> = text.split(';').map(pair).collect();
            source.path.amplification = SiteAmplification::Table(points.ok_or_else(|| {
                anyhow!(
                    "--site-amplification: expected a list of frequencies and factors, such as 0.1,1;1,1.5;10,2, found \
                         `{text}`"
                )
            })?);
        }
        Ok(source)
    }
}

/// Parses two numbers separated by a comma.
fn pair(text: &str) -> Option<(f64, f64)> {
    let (one, two) = text.split_once(',')?;
    Some((one.trim().parse().ok()?, two.trim().parse().ok()?))
}

impl Source {
    fn sentence(&self) -> String {
        format!(
            "stochastic method (Boore): magnitude {}, distance {}, stress parameter {}, beta {}, \
             Q and its exponent {}, kappa {}, site amplification {}, seed {}",
            self.magnitude,
            self.distance,
            self.stress,
            self.beta,
            self.quality,
            self.kappa,
            self.site_amplification.as_deref().unwrap_or("none"),
            self.seed.seed
        )
    }

    fn motion(&self, step: f64) -> anyhow::Result<GroundMotion> {
        let made = format!("made by the {}", self.sentence());
        Ok(with_provenance(self.build()?.motion(step, self.seed.seed)?, made))
    }
}

/// Replaces the first step of the provenance of a motion by `made`, which describes the motion by its
/// command-line options, with units.
fn with_provenance(mut motion: GroundMotion, made: String) -> GroundMotion {
    match motion.provenance.first_mut() {
        Some(first) => *first = made,
        None => motion.provenance.push(made),
    }
    motion
}

impl Noise {
    fn motion(&self, step: f64) -> anyhow::Result<GroundMotion> {
        let rms = quantity("--rms", &self.rms, Dimension::ACCELERATION)?;
        let soil = match self.soil {
            Soil::Firm => CloughPenzien::firm(rms),
            Soil::Medium => CloughPenzien::medium(rms),
            Soil::Soft => CloughPenzien::soft(rms),
        };
        let time = |option: &str, text: &str| quantity(option, text, Dimension::TIME);
        let envelope = Envelope::Jennings {
            rise: time("--rise", &self.rise)?,
            decay_start: time("--decay-start", &self.decay_start)?,
            decay: 1.0 / time("--decay", &self.decay)?,
        };
        let duration = time("--duration", &self.duration)?;
        let made = format!(
            "made from filtered noise (Clough and Penzien): {} soil, rms {}, {} long, rise {}, decay \
             from {} to 1/e in {}, seed {}",
            word(self.soil),
            self.rms,
            self.duration,
            self.rise,
            self.decay_start,
            self.decay,
            self.seed.seed
        );
        Ok(with_provenance(soil.motion(&envelope, duration, step, self.seed.seed)?, made))
    }
}

impl Fault {
    fn motion(&self, step: f64) -> anyhow::Result<GroundMotion> {
        let near_fault = NearFault {
            pulse: Pulse::MavroeidisPapageorgiou {
                velocity: quantity("--pulse-velocity", &self.pulse_velocity, Dimension::VELOCITY)?,
                period: quantity("--pulse-period", &self.pulse_period, Dimension::TIME)?,
                gamma: self.gamma,
                phase: quantity("--phase", &self.phase, Dimension::ANGLE)?,
            },
            start: quantity("--start", &self.start, Dimension::TIME)?,
            rest: self.source.build()?,
            crossover: self.crossover,
        };
        let made = format!(
            "made as near-fault motion: pulse of Mavroeidis and Papageorgiou of {} and {}, gamma {}, \
             phase {}, from {}; {}",
            self.pulse_velocity,
            self.pulse_period,
            self.gamma,
            self.phase,
            self.start,
            self.source.sentence()
        );
        Ok(with_provenance(near_fault.motion(step, self.source.seed.seed)?, made))
    }
}

/// Makes the motion and writes it.
pub(super) fn synth(args: &SynthArgs) -> anyhow::Result<()> {
    let (acceleration, velocity) = (1.0, 1.0);
    match &args.kind {
        Kind::Sine(Made { kind: c, common }) => write(common, |_| {
            let (cycles, ramp_cycles) = (c.cycles, c.ramp_cycles);
            let sine = |period| Ok(Pulse::Sine { amplitude: 1.0, period, cycles, ramp_cycles });
            c.size.motion("sine", sine)
        }),
        Kind::HalfSine(made) => {
            made.pulse("half sine", |duration| Pulse::HalfSine { acceleration, duration })
        }
        Kind::OneSine(made) => {
            made.pulse("one sine", |period| Pulse::OneSine { acceleration, period })
        }
        Kind::OneCosine(made) => {
            made.pulse("one cosine", |period| Pulse::OneCosine { acceleration, period })
        }
        Kind::Ricker(made) => made.pulse("Ricker", |period| Pulse::Ricker { acceleration, period }),
        Kind::Gabor(made) => made.wavelet("Gabor", |period, gamma, phase| Pulse::Gabor {
            velocity,
            period,
            gamma,
            phase,
        }),
        Kind::CycloidA(made) => {
            made.pulse("cycloid A", |period| Pulse::CycloidA { velocity, period })
        }
        Kind::CycloidB(made) => {
            made.pulse("cycloid B", |period| Pulse::CycloidB { velocity, period })
        }
        Kind::CycloidC(Made { kind: c, common }) => write(common, |_| {
            let cycles = c.cycles;
            c.size.motion("cycloid C", |period| Ok(Pulse::CycloidC { velocity, period, cycles }))
        }),
        Kind::MavroeidisPapageorgiou(made) => made
            .wavelet("Mavroeidis-Papageorgiou", |period, gamma, phase| {
                Pulse::MavroeidisPapageorgiou { velocity, period, gamma, phase }
            }),
        Kind::CloughPenzien(made) => write(&made.common, |step| made.kind.motion(step)),
        Kind::Boore(made) => write(&made.common, |step| made.kind.motion(step)),
        Kind::NearFault(made) => write(&made.common, |step| made.kind.motion(step)),
    }
}

/// Default time step (s) of random motions.
const RANDOM_STEP: f64 = 0.005;

/// Samples a motion at a time step (s) and writes it.
fn write(
    common: &Common,
    make: impl FnOnce(f64) -> anyhow::Result<GroundMotion>,
) -> anyhow::Result<()> {
    let target = common.output.prepare()?;
    let given = input::time_step(common.time_step.as_deref())?;
    let motion = make(given.unwrap_or(RANDOM_STEP))?;
    let step = given.unwrap_or_else(|| motion.horizontal.natural_step());
    let mut record = Record::of_motion(&motion, step)?;
    record.file = common.output.output.display().to_string();
    if common.vertical {
        let turned = Channel::of_history("UP", Direction::up(), &motion.horizontal, step)?;
        record.channels = vec![turned];
    }
    let table = measures::usual(&record)?;
    super::change::finish(&target, &record, &record, table.lines())
}
