//! Demands on a stack, such as drift and slip, each declared once with its name, its units, and the expression
//! that computes it.

use barrelstack_columns::described::{self, Described, Field, Objects};
use serde::Serialize;

use crate::assemble::{Assembly, PartKind};
use crate::watch::{Fate, Fates, Joints, PeakMotion, StressEnvelope, Stresses};

/// Part of a run over which demands and largest forces are determined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// Until the first body leaves its seat; the whole run if no body leaves its seat.
    UntilLoss,
    /// The whole run, including falls.
    WholeRun,
}

/// Definition of a demand on a stack.
#[derive(Clone, Copy, Debug)]
pub struct Demand {
    /// Key in files.
    pub name: &'static str,
    /// Description of the demand.
    pub meaning: &'static str,
    /// Displayed label.
    pub label: &'static str,
    /// SI unit, which is the unit in files; `1` for a ratio.
    pub unit: &'static str,
    /// Displayed unit.
    pub shown_unit: &'static str,
    /// Factor that converts the value from the SI unit to the displayed unit.
    pub factor: f64,
    /// Number of displayed decimals; further digits are not significant.
    pub decimals: usize,
    /// Returns the value in the SI unit; `None` if the demand does not apply.
    pub get: fn(&Demands) -> Option<f64>,
}

impl Demand {
    /// Returns `true` if the demand is a value at the end of the run, so that it is the same for every span.
    pub fn is_of_the_end(&self) -> bool {
        self.name == "base_slip_residual"
    }

    /// Returns the displayed value; `None` if the demand does not apply.
    pub fn shown(&self, demands: &Demands) -> Option<f64> {
        (self.get)(demands).map(|value| value * self.factor)
    }
}

/// Declares the demands. Each entry has a doc comment, the key and the unit in files, then the label, the conversion
/// factor, the unit and the number of decimals for display, and the expression that computes the demand.
macro_rules! demands {
    ($(
        $(#[doc = $doc:literal])+
        $name:ident $unit:literal: $label:literal, $factor:literal $shown:literal $decimals:literal, $of:expr;
    )*) => {
        /// Demands on the stack in a [`Span`] of its run; all `None` if the run is invalid.
        #[derive(Clone, Debug, Default, Serialize)]
        pub struct Demands {
            $($(#[doc = $doc])+ pub $name: Option<f64>,)*
        }

        /// All demands, in the order of display.
        pub static DEMANDS: &[Demand] = &[$(Demand {
            name: stringify!($name),
            meaning: concat!($($doc),+),
            label: $label,
            unit: $unit,
            shown_unit: $shown,
            factor: $factor,
            decimals: $decimals,
            get: |demands| demands.$name,
        }),*];

        impl Demands {
            /// Computes the demands on a stack in a span of a valid run.
            pub fn of(
                assembly: &Assembly,
                fates: &Fates,
                stresses: &Stresses,
                joints: &Joints,
                span: Span,
            ) -> Self {
                let sources = Sources { assembly, fates, stresses, joints, span };
                Self { $($name: sources.most($of)),* }
            }
        }
    };
}

demands! {
    /// Largest displacement of the top barrels relative to the ground, divided by the height of the stack.
    top_drift_ratio "1": "largest drift of the top, relative to the height", 100.0 "%" 1, |sources, body| {
        let height = sources.assembly.height;
        let drift = sources.motion(body, PartKind::Barrel, Some(sources.assembly.levels))?.displacement;
        (height > 0.0).then_some(drift / height)
    };
    /// Largest normal stress on a barrel of the bottom level, divided by the largest stress at rest. The two may occur
    /// at different points of the barrel, so the value may be less than `mean_stress_amplification`.
    stress_amplification "1": "stress amplification of a bottom barrel, ratio of largest stresses", 1.0 "× at rest" 2,
        |sources, body| match sources.span {
            Span::UntilLoss => sources.stress(body)?.amplification(),
            Span::WholeRun => sources.stress(body)?.amplification_whole_run(),
        };
    /// Largest normal stress at each point of a barrel of the bottom level, averaged over the part of the boundary that
    /// is loaded at rest, and divided by the average stress at rest.
    mean_stress_amplification "1":
        "stress amplification of a bottom barrel, ratio of average stresses", 1.0 "× at rest" 2,
        |sources, body| match sources.span {
            Span::UntilLoss => sources.stress(body)?.mean_amplification(),
            Span::WholeRun => sources.stress(body)?.mean_amplification_whole_run(),
        };
    /// Largest vertical force between a barrel and a rack in any step, divided by the capacity of the staves
    /// (`stack.barrel.stave_capacity`).
    stave_utilization "1": "largest load on a barrel between its racks, relative to the capacity of its staves", 100.0 "%" 0, |sources, body| {
        sources.fate(body, PartKind::Barrel, None)?;
        let load = sources.joints.stave_load(body, &|id| sources.assembly.parts[id].kind, sources.span);
        Some(load? / sources.assembly.stave_capacity)
    };
    /// Largest slip of the bottom rack on the ground.
    base_slip_peak "m": "largest slip of the bottom rack on the ground", 100.0 "cm" 1,
        |sources, body| Some(sources.motion(body, PartKind::Rack, Some(1))?.slip);
    /// Slip of the bottom rack on the ground, at the moment of the collapse, or at the end of the run if there was no
    /// collapse.
    base_slip_at_collapse "m": "slip of the bottom rack at the collapse", 100.0 "cm" 1,
        |sources, body| Some(sources.fate(body, PartKind::Rack, Some(1))?.displacement_at_collapse);
    /// Slip of the bottom rack on the ground at the end of the run.
    base_slip_residual "m": "slip of the bottom rack at the end of the run", 100.0 "cm" 1,
        |sources, body| Some(sources.fate(body, PartKind::Rack, Some(1))?.residual_slip);
    /// Largest displacement of any rack on the barrels below, or of its feet on the posts of the rack below.
    rack_walk_peak "m": "largest walk of a rack on the barrels below", 100.0 "cm" 1, |sources, body| {
        let motion = sources.motion(body, PartKind::Rack, None)?;
        (!sources.assembly.parts[body].supports.is_empty()).then_some(motion.slip)
    };
    /// Largest tilt of any rack.
    rack_tilt_peak "rad": "largest tilt of a rack", 57.295_779_513_082_32 "deg" 1,
        |sources, body| Some(sources.motion(body, PartKind::Rack, None)?.tilt);
}

impl Described for Demands {
    fn schema(objects: &mut Objects) -> serde_json::Value {
        let field = |demand: &Demand| Field {
            key: demand.name,
            meaning: demand.meaning,
            unit: Some(demand.unit),
            words: &[],
            how: None,
            schema: <Option<f64> as Described>::schema,
        };
        let fields: Vec<Field> = DEMANDS.iter().map(field).collect();
        let meaning = "Demands on the stack until the first loss of a seat or over the whole run, depending on the \
            field that contains them. The slips at the collapse and at the end of the run are the same in both.";
        described::object(objects, "Demands", meaning, &fields)
    }
}

/// Observations of a run from which its demands are computed.
struct Sources<'a> {
    assembly: &'a Assembly,
    fates: &'a Fates,
    stresses: &'a Stresses,
    joints: &'a Joints,
    span: Span,
}

impl Sources<'_> {
    /// Returns the value of largest magnitude, with its sign, over all bodies to which the demand applies.
    fn most(&self, of: fn(&Self, usize) -> Option<f64>) -> Option<f64> {
        let larger = |most: f64, value: f64| if value.abs() > most.abs() { value } else { most };
        (0..self.assembly.parts.len()).filter_map(|body| of(self, body)).reduce(larger)
    }

    /// Returns the outcome for a body if it has the given kind and level; `None` for any other body.
    fn fate(&self, body: usize, kind: PartKind, level: Option<u32>) -> Option<Fate> {
        let part = &self.assembly.parts[body];
        let wanted = part.kind == kind && level.is_none_or(|level| part.level == Some(level));
        wanted.then(|| self.fates.fate(body))
    }

    /// Returns the largest motions of a body if it has the given kind and level; `None` for any other body.
    fn motion(&self, body: usize, kind: PartKind, level: Option<u32>) -> Option<PeakMotion> {
        let fate = self.fate(body, kind, level)?;
        Some(match self.span {
            Span::UntilLoss => fate.until_loss(),
            Span::WholeRun => fate.whole_run,
        })
    }

    /// Returns the stress envelope of a barrel of the bottom level; `None` for any other body.
    fn stress(&self, body: usize) -> Option<&StressEnvelope> {
        self.fate(body, PartKind::Barrel, Some(1))?;
        self.stresses.of(body)
    }
}
