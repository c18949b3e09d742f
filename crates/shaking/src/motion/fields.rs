//! The fields of `[motion]`.

use std::mem::discriminant;

use barrelstack_input::field::{Default, Field, Kind, Named, Range, Section, names};
use barrelstack_input::{Dimension, table};

use super::{Direction, MeasuredOn, Processing, PulseKind};

impl Named for PulseKind {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("ricker", Self::Ricker),
        ("half-sine", Self::HalfSine),
        ("one-sine", Self::OneSine),
        ("one-cosine", Self::OneCosine),
        ("rectangular", Self::Rectangular),
        ("gabor", Self::Gabor { gamma: 0.0, phase: 0.0 }),
        ("cycloid-a", Self::CycloidA),
        ("cycloid-b", Self::CycloidB),
        ("cycloid-c", Self::CycloidC { cycles: 0 }),
        ("mavroeidis-papageorgiou", Self::MavroeidisPapageorgiou { gamma: 0.0, phase: 0.0 }),
    ];

    /// Returns the name of the form of a pulse, without the parameters of the form, which are separate fields.
    fn name(self) -> &'static str {
        let same = |form: &Self| discriminant(form) == discriminant(&self);
        Self::NAMES.iter().find(|(_, form)| same(form)).map_or("", |(name, _)| name)
    }
}

/// Returns the names of the bundled records.
pub fn record_names() -> Vec<&'static str> {
    barrelstack_motion::BUNDLED.to_vec()
}

/// A period, from a microsecond to an hour.
const PERIOD: Kind =
    Kind::Quantity(&[Dimension::TIME], Range { least: 1e-6, above: false, greatest: 3600.0 });
const FREQUENCY: Kind = Kind::Quantity(
    &[Dimension::FREQUENCY],
    Range { least: 1.0 / 3600.0, above: false, greatest: 1e6 },
);
pub(super) const LONGEST: f64 = 3600.0;

table! {
    /// A harmonic motion.
    pub static SINE = "sine";
    /// Peak displacement, velocity or acceleration; the unit determines which of them.
    amplitude = Kind::Quantity(&[Dimension::LENGTH, Dimension::VELOCITY, Dimension::ACCELERATION], Range::POSITIVE),
        Default::Required;
    /// Period; the frequency can be stated instead.
    period = PERIOD, Default::Derived("1 / `frequency`");
    /// Frequency, as an alternative to the period.
    frequency = FREQUENCY, Default::Derived("1 / `period`");
    /// Number of cycles, including ramps; the duration can be stated instead.
    cycles = Kind::Number(Range::up_to(1e6)), Default::Derived("`duration` / `period`");
    /// Duration, as an alternative to the number of cycles.
    duration = Kind::Quantity(&[Dimension::TIME], Range::up_to(LONGEST)),
        Default::Derived("`cycles` times `period`");
    /// Number of cycles over which the amplitude grows from zero at the start; it falls to zero over the same number
    /// of cycles at the end.
    ramp_cycles = Kind::Number(Range::between(0.0, 1e6)), Default::Value("0.0");
    /// Direction of the motion.
    direction = Kind::Choice(names::<Direction>), Default::Value("\"horizontal\"");
    at most one of &["period", "frequency"];
    at most one of &["cycles", "duration"];
}

table! {
    /// A pulse.
    pub static PULSE = "pulse";
    /// Form of the pulse.
    kind = Kind::Choice(names::<PulseKind>), Default::Required;
    /// Peak acceleration or peak velocity; the unit determines which of them.
    amplitude = Kind::Quantity(&[Dimension::ACCELERATION, Dimension::VELOCITY], Range::POSITIVE),
        Default::Required;
    /// Period; the frequency can be stated instead.
    period = PERIOD, Default::Derived("1 / `frequency`");
    /// Frequency, as an alternative to the period.
    frequency = FREQUENCY, Default::Derived("1 / `period`");
    /// Time at which the pulse starts.
    start = Kind::Quantity(&[Dimension::TIME], Range::between(0.0, LONGEST)), Default::Value("\"0 s\"");
    /// Direction of the motion.
    direction = Kind::Choice(names::<Direction>), Default::Value("\"horizontal\"");
    by kind {
        /// Ricker wavelet: acceleration in the form of the second derivative of a Gaussian.
        "ricker" {}
        /// Acceleration in the form of half a sine wave.
        "half-sine" {}
        /// Acceleration in the form of one full sine wave.
        "one-sine" {}
        /// Acceleration in the form of one full cycle of a cosine.
        "one-cosine" {}
        /// Constant acceleration.
        "rectangular" {}
        /// Harmonic wave with a Gaussian envelope.
        "gabor" {
            /// Width of the envelope, as a number of cycles.
            gamma = Kind::Number(Range::up_to(100.0)), Default::Required;
            /// Phase angle of the wave.
            phase = Kind::Quantity(&[Dimension::ANGLE], Range::between(-100.0, 100.0)),
                Default::Value("\"0 rad\"");
        }
        /// Cycloidal pulse of type A: one forward displacement.
        "cycloid-a" {}
        /// Cycloidal pulse of type B: one displacement forward and back.
        "cycloid-b" {}
        /// Cycloidal pulse of type C: several cycles that start and end at rest.
        "cycloid-c" {
            /// Number of cycles.
            cycles = Kind::Integer(1, 100), Default::Value("1");
        }
        /// Velocity pulse of near-fault records.
        "mavroeidis-papageorgiou" {
            /// Parameter γ, which determines the oscillatory character of the pulse; greater than 1.
            gamma = Kind::Number(Range { least: 1.0, above: true, greatest: 100.0 }), Default::Required;
            /// Phase angle of the wave.
            phase = Kind::Quantity(&[Dimension::ANGLE], Range::between(-100.0, 100.0)),
                Default::Value("\"0 rad\"");
        }
    }
    at most one of &["period", "frequency"];
}

table! {
    /// Scaling of all components by the same factor; one of the fields determines the factor.
    pub static SCALE = "scale";
    /// Factor; a negative factor reverses the motion.
    factor = Kind::Number(Range { least: -1e6, above: false, greatest: 1e6 }),
        Default::Derived("1 unless another field scales the motion");
    /// Peak horizontal acceleration to which the motion is scaled.
    pga = Kind::Quantity(&[Dimension::ACCELERATION], Range::up_to(1e4)), Default::Nothing;
    /// Peak horizontal velocity to which the motion is scaled.
    pgv = Kind::Quantity(&[Dimension::VELOCITY], Range::up_to(1e3)), Default::Nothing;
    /// Name of any other intensity measure that increases with the amplitude of the motion. The motion is scaled so
    /// that this measure reaches `value`. Examples: `pgd`, `arias`, `cav`, `cav-std`, `rms`, `housner`, `asi`, `vsi`,
    /// `fiv3(1.0)`, `sa(1.0)` (period in seconds, damping 5 %) and `sa(1.0,0.02)`.
    measure = Kind::Text, Default::Nothing;
    /// Value of `measure` to which the motion is scaled.
    value = Kind::Quantity(&[Dimension::ACCELERATION, Dimension::VELOCITY, Dimension::LENGTH], Range::up_to(1e4)),
        Default::Nothing;
    /// Components from which `measure` is computed: the component that drives the stack, or both horizontal components
    /// of the record.
    of = Kind::Choice(names::<MeasuredOn>), Default::Value("\"component\"");
    at most one of &["factor", "pga", "pgv", "measure"];
    at most one of &["factor", "pga", "pgv", "value"];
    at most one of &["factor", "pga", "pgv", "of"];
}

pub(super) const SOURCES: &[&str] = &["record", "bundled", "sine", "pulse", "none"];

table! {
    /// A shock of a sequence. Its motion is one of `record`, `bundled`, `sine`, `pulse` and `none`; every other field
    /// of `[motion]` can be given as well.
    pub static SHOCK = "shock";
    /// File of a recorded motion, relative to the scenario file.
    record = Kind::Text, Default::Nothing;
    /// Record shipped with the program.
    bundled = Kind::Choice(record_names), Default::Nothing;
    /// A harmonic motion.
    sine = Kind::Table(&SINE), Default::Nothing;
    /// A pulse.
    pulse = Kind::Table(&PULSE), Default::Nothing;
    /// True if the ground stays at rest.
    none = Kind::Flag, Default::Nothing;
    /// Horizontal component: a name, an azimuth, `horizontal-1` or `horizontal-2`.
    component = Kind::Label, Default::Derived("the first horizontal component");
    /// Vertical component of the same record; false for no vertical motion.
    vertical = Kind::TextOrFalse, Default::Nothing;
    /// File of the vertical motion, relative to the scenario file.
    vertical_record = Kind::Text, Default::Nothing;
    /// Time step, only for a file that does not state its time step.
    time_step = Kind::Quantity(&[Dimension::TIME], Range { least: 1e-6, above: false, greatest: 10.0 }),
        Default::Derived("the time step of the file");
    /// Unit of acceleration, only for a file that does not state its unit.
    unit = Kind::Unit(Dimension::ACCELERATION), Default::Derived("the unit of the file");
    /// Sensitivity in counts per m/s², only for a file that contains counts (miniSEED, SAC).
    sensitivity = Kind::Number(Range::up_to(1e15)), Default::Nothing;
    /// Signal processing of the record.
    processing = Kind::Choice(names::<Processing>), Default::Value("\"default\"");
    /// Where to get the record, shown to users who do not have it.
    obtain = Kind::Text, Default::Nothing;
    /// Scaling of the motion.
    scale = Kind::Table(&SCALE), Default::Derived("factor 1");
    /// Length scale of a Froude similitude that is applied only to the motion.
    similitude = Kind::Number(Range { least: 1e-3, above: false, greatest: 1e3 }), Default::Value("1.0");
    at most one of &["record", "bundled", "sine", "pulse", "none"];
    at most one of &["sine", "pulse", "none", "component"];
    at most one of &["sine", "pulse", "none", "vertical"];
    at most one of &["sine", "pulse", "none", "vertical_record"];
    at most one of &["sine", "pulse", "none", "processing"];
    at most one of &["bundled", "sine", "pulse", "none", "time_step"];
    at most one of &["bundled", "sine", "pulse", "none", "unit"];
    at most one of &["bundled", "sine", "pulse", "none", "sensitivity"];
    at most one of &["bundled", "sine", "pulse", "none", "obtain"];
    at most one of &["vertical", "vertical_record"];
    at most one of &["none", "scale"];
}

/// Number of fields of a shock.
const OF_SHOCK: usize = SHOCK.fields.len();

/// The fields of a shock, followed by the field `sequence`.
static FIELDS: [Field; OF_SHOCK + 1] = {
    let help = "Successive shocks of a cellar, instead of all other fields of `[motion]`: each shock is described by \
                the same fields, and starts with the bodies at rest where the previous shock left them.";
    let sequence = Field::new("sequence", Kind::Tables(&SHOCK), Default::Nothing, help);
    let mut all = [sequence; OF_SHOCK + 1];
    let mut at = 0;
    while at < OF_SHOCK {
        all[at] = SHOCK.fields[at];
        at += 1;
    }
    all
};

/// Number of groups of mutually exclusive fields among the fields of a shock.
const EXCLUDED: usize = SHOCK.exclusive.len();

/// Groups of mutually exclusive fields: the groups of a shock, and `sequence` paired with each field of a shock.
static EXCLUSIVE: [&[&str]; EXCLUDED + OF_SHOCK] = {
    const PAIRS: [[&str; 2]; OF_SHOCK] = {
        let mut all = [["sequence"; 2]; OF_SHOCK];
        let mut at = 0;
        while at < OF_SHOCK {
            all[at][1] = SHOCK.fields[at].name;
            at += 1;
        }
        all
    };
    static RIVALS: [[&str; 2]; OF_SHOCK] = PAIRS;
    let mut all: [&[&str]; EXCLUDED + OF_SHOCK] = [&[]; EXCLUDED + OF_SHOCK];
    let mut at = 0;
    while at < EXCLUDED {
        all[at] = SHOCK.exclusive[at];
        at += 1;
    }
    while at < EXCLUDED + OF_SHOCK {
        all[at] = &RIVALS[at - EXCLUDED];
        at += 1;
    }
    all
};

/// The section `[motion]`.
pub static MOTION: Section = Section {
    name: "motion",
    help: "The ground motion: one of `record`, `bundled`, `sine`, `pulse` and `none`.",
    fields: &FIELDS,
    variants: None,
    exclusive: &EXCLUSIVE,
};
