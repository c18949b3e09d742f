//! Fields of the `[[motion]]` tables of a study file.

use barrelstack_input::{fields, named, table};

use crate::scenario::Dimension;
use crate::scenario::field::{Default, Field, Kind, Range, names};
use crate::scenario::motion::{MOTION, PULSE, SCALE, SINE, record_names};

use super::MOST;

named! {
    /// Method by which synthetic motions are made.
    pub(in crate::study) enum Maker {
        Boore = "boore",
        CloughPenzien = "clough-penzien",
        NearFault = "near-fault",
    }
}

named! {
    /// Soil types of Der Kiureghian and Neuenhofer (1992).
    pub(in crate::study) enum Soil { Firm = "firm", Medium = "medium", Soft = "soft" }
}

const SOURCE: [Field; 4] = fields! {
    /// Moment magnitude of the earthquake.
    magnitude = Kind::Number(Range::between(1.0, 9.5)), Default::Required;
    /// Distance from the source to the site.
    distance = Kind::Quantity(&[Dimension::LENGTH], Range::up_to(1e7)), Default::Required;
    /// Stress parameter of the source.
    stress = Kind::Quantity(&[Dimension::STIFFNESS_PER_LENGTH], Range::up_to(1e12)), Default::Value("\"7 MPa\"");
    /// High-frequency attenuation (kappa) at the site.
    kappa = Kind::Quantity(&[Dimension::TIME], Range::between(0.0, 1.0)), Default::Value("\"0.04 s\"");
};

const TIME: Kind = Kind::Quantity(&[Dimension::TIME], Range::up_to(3600.0));

table! {
    /// Synthetic motions, which are made from random numbers.
    static SYNTHETIC = "synthetic";
    /// Method by which the motions are made.
    kind = Kind::Choice(names::<Maker>), Default::Required;
    /// Number of realizations.
    count = Kind::Integer(1, MOST), Default::Required;
    /// Seed of the motions. The seed of each realization follows from this seed and the number of the
    /// realization.
    seed = Kind::Integer(0, u32::MAX as i64), Default::Derived("that of the study");
    /// Time step of the samples.
    time_step = Kind::Quantity(&[Dimension::TIME], Range { least: 1e-4, above: false, greatest: 0.1 }),
        Default::Value("\"0.005 s\"");
    by kind {
        /// Stochastic method for a point source (Boore 2003).
        "boore" with [SOURCE[0], SOURCE[1], SOURCE[2], SOURCE[3]] {}
        /// Filtered white noise with an envelope in time (Clough and Penzien).
        "clough-penzien" {
            /// Soil at the site.
            soil = Kind::Choice(names::<Soil>), Default::Value("\"medium\"");
            /// Root mean square of the acceleration at full strength.
            rms = Kind::Quantity(&[Dimension::ACCELERATION], Range::up_to(1e3)), Default::Value("\"0.1 g\"");
            /// Duration of the motion.
            duration = TIME, Default::Value("\"20 s\"");
            /// Time at which the motion reaches full strength.
            rise = TIME, Default::Value("\"2 s\"");
            /// Time at which the decay starts.
            decay_start = TIME, Default::Value("\"10 s\"");
            /// Time constant of the decay: the time in which the amplitude decays to 1/e.
            decay = TIME, Default::Value("\"2.5 s\"");
        }
        /// A velocity pulse of Mavroeidis and Papageorgiou that is added to a stochastic motion.
        "near-fault" with [SOURCE[0], SOURCE[1], SOURCE[2], SOURCE[3]] {
            /// Velocity amplitude of the pulse.
            pulse_velocity = Kind::Quantity(&[Dimension::VELOCITY], Range::up_to(100.0)), Default::Required;
            /// Period of the pulse.
            pulse_period = TIME, Default::Required;
            /// Width parameter of the pulse, above 1; it determines the number of cycles.
            gamma = Kind::Number(Range { least: 1.0, above: true, greatest: 100.0 }), Default::Value("2.0");
            /// Phase of the pulse.
            phase = Kind::Quantity(&[Dimension::ANGLE], Range::between(-100.0, 100.0)),
                Default::Value("\"0 rad\"");
            /// Time at which the pulse starts.
            start = TIME, Default::Value("\"2 s\"");
            /// Lowest frequency of the stochastic motion, as a multiple of the frequency of the pulse.
            crossover = Kind::Number(Range::up_to(100.0)), Default::Value("1.0");
        }
    }
}

table! {
    /// Motions that shake the stack, stated by exactly one of the fields `records`, `folder`, `bundled`, `sine`,
    /// `pulse` and `synthetic`.
    pub(super) static MOTIONS = "motions";
    /// Name of the motion in the table of results; for several motions, the first part of their names.
    name = Kind::Text, Default::Derived("the name of the file, or the kind of the motion");
    /// Files of recorded motions, relative to the study file.
    records = Kind::Texts, Default::Nothing;
    /// Folder of recorded motions, relative to the study file. All files that match `pattern` are used, in
    /// the order of their names; if one of them cannot be read, nothing is run. Subfolders are skipped, as
    /// are files whose names begin with a period.
    folder = Kind::Text, Default::Nothing;
    /// Pattern for the names of the files in the folder, such as `*.AT2`. `*` stands for any number of
    /// characters, and `?` for one character.
    pattern = Kind::Text, Default::Value("\"*\"");
    /// A record that is shipped with the program.
    bundled = Kind::Choice(record_names), Default::Nothing;
    /// A harmonic motion.
    sine = Kind::Table(&SINE), Default::Nothing;
    /// A pulse.
    pulse = Kind::Table(&PULSE), Default::Nothing;
    /// Synthetic motions.
    synthetic = Kind::Table(&SYNTHETIC), Default::Nothing;
    /// Horizontal components of the records; each component is a separate motion.
    components = Kind::Texts, Default::Derived("the component that `each` names, or the first horizontal component");
    /// Processing of every record: all fields of [motion] except those for its source and its scale.
    each = Kind::Table(&MOTION), Default::Nothing;
    /// Scaling of the motions, used if there is no [intensity].
    scale = Kind::Table(&SCALE), Default::Nothing;
    at most one of &["records", "folder", "bundled", "sine", "pulse", "synthetic"];
    at most one of &["sine", "pulse", "synthetic", "components"];
    at most one of &["sine", "pulse", "synthetic", "each"];
    at most one of &["records", "bundled", "sine", "pulse", "synthetic", "pattern"];
}
