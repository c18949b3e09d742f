//! Top-level fields of a scenario file.

use barrelstack_input::declared::Declared as _;
use barrelstack_input::{named, table};

use super::error::ScenarioError;
use super::field::{Default, Kind, names};
use super::reader::Reader;
use super::run::Until;
use super::tree::Table;
use super::writer::Writer;
use super::{
    Imperfections, OutcomeSpec, RecordSpec, Scenario, Scene, Unknowns, Written, element, free,
    imperfections, interface, motion, pair, rack, run, spatial, stack, unknowns,
};

/// Version of the scenario language.
pub(super) const SCHEMA: u32 = 1;

named! {
    enum SceneKind {
        Stack = "stack",
        Free = "free",
        FreeSpatial = "free-spatial",
    }
}

table! {
    /// A scenario: the bodies, the ground motion, and the settings of the run.
    pub static ROOT = "scenario";
    /// Version of the scenario language.
    schema = Kind::Integer(1, SCHEMA as i64), Default::Required;
    /// Title, in one line.
    title = Kind::Text, Default::Derived("name of the file");
    /// Built-in scenario, or file ending in `.toml`, whose values this scenario overrides.
    extends = Kind::Text, Default::Nothing;
    /// Kind of scene.
    kind = Kind::Choice(names::<SceneKind>), Default::Value("\"stack\"");
    /// The ground motion.
    motion = Kind::Table(&motion::MOTION), Default::Nothing;
    /// Settings of the run.
    run = Kind::Table(&run::RUN), Default::Nothing;
    /// Settings of the recording.
    record = Kind::Table(&run::RECORD), Default::Nothing;
    by kind {
        /// A stack of barrels on racks.
        "stack" {
            /// The stack.
            stack = Kind::Table(&stack::STACK), Default::Required;
            /// Contact laws by pair of bodies.
            interface = Kind::Table(&pair::INTERFACES), Default::Nothing;
            /// Thresholds that define a collapse.
            outcome = Kind::Table(&run::OUTCOME), Default::Nothing;
            /// Random differences from stack to stack, and the number of variants.
            imperfections = Kind::Table(&imperfections::IMPERFECTIONS), Default::Nothing;
            /// Uncertainty of constants that nobody has measured on the stack.
            unknowns = Kind::Table(&unknowns::UNKNOWNS), Default::Nothing;

        }
        /// Arbitrary planar bodies on a ground.
        "free" {
            /// The ground.
            ground = Kind::Table(&free::GROUND), Default::Nothing;
            /// The bodies.
            body = Kind::Tables(&free::BODY), Default::Required;
            /// Contact laws between kinds of bodies.
            interface = Kind::Tables(&interface::FREE_INTERFACE), Default::Nothing;
            /// Force elements between bodies.
            element = Kind::Tables(&element::ELEMENT), Default::Nothing;

        }
        /// Arbitrary three-dimensional bodies on a ground.
        "free-spatial" {
            /// The ground.
            ground = Kind::Table(&spatial::GROUND), Default::Nothing;
            /// The bodies.
            body = Kind::Tables(&barrelstack_bodies::BODY), Default::Required;
            /// Contact laws between kinds of bodies.
            interface = Kind::Tables(&interface::FREE_INTERFACE), Default::Nothing;

        }
    }
}

/// Reads the whole scenario; `fallback_title` is used if the file states no title.
pub(super) fn read(reader: Reader<'_>, fallback_title: &str) -> Result<Scenario, ScenarioError> {
    reader.integer("schema")?;
    let title = reader.optional_text("title")?.unwrap_or_else(|| fallback_title.to_owned());
    // `extends` has been resolved already; it is present here only if an override sets it.
    if reader.optional_text("extends")?.is_some() {
        let message = "`extends` cannot be overridden; write it in the file".to_owned();
        return Err(reader.inconsistent("extends", message));
    }
    let kind = reader.choice::<SceneKind>("kind")?;
    let until = match kind {
        SceneKind::Stack => Until::Rest,
        SceneKind::Free | SceneKind::FreeSpatial => Until::Duration,
    };
    let run = run::read_run(reader.section("run")?, until)?;
    let record = RecordSpec::read(reader.section("record")?)?;
    let scene = match kind {
        SceneKind::Stack => {
            let seats = rack::seats(&reader.section("stack")?.section("rack")?)?;
            let interfaces = pair::read_interfaces(reader.section("interface")?, &seats)?;
            let stack = stack::read(reader.section("stack")?, interfaces)?;
            let outcome = OutcomeSpec::read(reader.section("outcome")?)?;
            let imperfections = Imperfections::read(reader.section("imperfections")?)?;
            let unknowns = Unknowns::read(reader.section("unknowns")?)?;
            Scene::Stack { stack, outcome, imperfections, unknowns }
        }
        SceneKind::Free => Scene::Free(free::read(&reader)?),
        SceneKind::FreeSpatial => Scene::Spatial(spatial::read(&reader)?),
    };
    let motion = match reader.optional_section("motion")? {
        Some(motion) => motion::read(motion)?,
        None if kind == SceneKind::Stack => return Err(reader.missing("motion")),
        None => motion::rest(),
    };
    reader.finish();
    Ok(Scenario { title, scene, motion, run, record, written: Written::default() })
}

/// Writes the whole scenario.
pub(super) fn write(scenario: &Scenario) -> Table {
    let kind = match scenario.scene {
        Scene::Stack { .. } => SceneKind::Stack,
        Scene::Free(_) => SceneKind::Free,
        Scene::Spatial(_) => SceneKind::FreeSpatial,
    };
    let mut writer = Writer::variant(&ROOT, kind);
    writer.integer("schema", SCHEMA);
    writer.text("title", &scenario.title);
    writer.omit(&["extends"]);
    match &scenario.scene {
        Scene::Stack { stack, outcome, imperfections, unknowns } => {
            writer.table("stack", stack::write(stack));
            writer.table("interface", pair::write_interfaces(&stack.interfaces));
            writer.table("motion", motion::write(&scenario.motion));
            writer.table("run", run::write_run(&scenario.run));
            writer.table("record", scenario.record.write());
            writer.table("outcome", outcome.write());
            writer.table("imperfections", imperfections.write());
            writer.table("unknowns", unknowns.write());
        }
        Scene::Free(scene) => free::write(&mut writer, scene),
        Scene::Spatial(scene) => spatial::write(&mut writer, scene),
    }
    if kind != SceneKind::Stack {
        writer.table("motion", motion::write(&scenario.motion));
        writer.table("run", run::write_run(&scenario.run));
        writer.table("record", scenario.record.write());
    }
    writer.finish()
}
