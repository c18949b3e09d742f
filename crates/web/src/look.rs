//! A scenario with all defaults filled in, as a page shows it before a run; and the catalog.

use barrelstack::check::{Checked, check};
use barrelstack::motion::GroundMotion;
use barrelstack::scenario::field::Section;
use barrelstack::scenario::{ROOT, Scenario, catalog};
use barrelstack::variants::Plane;
use barrelstack::{RunFailure, report};
use barrelstack_report::{Fragment, Language, fragment};
use serde::Serialize;

/// The catalog of barrels and racks.
#[derive(Serialize)]
pub(crate) struct Catalog {
    barrels: Vec<CatalogEntry>,
    racks: Vec<CatalogEntry>,
}

/// An entry of the catalog.
#[derive(Serialize)]
struct CatalogEntry {
    name: &'static str,
    source: &'static str,
}

impl Catalog {
    pub(crate) fn new() -> Self {
        let barrels = catalog::BARRELS.iter();
        let racks = catalog::RACKS.iter();
        Self {
            barrels: barrels
                .map(|one| CatalogEntry { name: one.name, source: one.source })
                .collect(),
            racks: racks
                .map(|one| CatalogEntry { name: one.rack.base, source: one.source })
                .collect(),
        }
    }
}

/// A scenario with all defaults filled in, as a page shows it before a run.
#[derive(Serialize)]
pub(crate) struct Looked {
    title: String,
    /// Number of variants in each plane.
    variants: u32,
    /// The scenario with every default written out.
    resolved: String,
    /// Fields of the scenario with their values, and the fields that its tables leave out.
    settings: Vec<Stated>,
    /// Check results, one for each plane.
    checked: Vec<Checked>,
    /// Names of the devices on the stack.
    devices: Vec<String>,
    /// Number of steps of one variant multiplied by the number of moving bodies, summed over all
    /// planes; used to estimate the computation time.
    work: f64,
    /// End (s) of the first part of the run, which is shown while the whole run is computed; `None` if there is no
    /// ground motion.
    opening: Option<f64>,
    stage: Fragment,
}

/// Adds the fields that the tables in the scenario leave out.
fn absent(list: &mut Vec<Stated>, present: &[String], path: &str, section: &'static Section) {
    for field in section.fields {
        let path =
            if path.is_empty() { field.name.into() } else { format!("{path}.{}", field.name) };
        match field.kind.section() {
            Some(inner) => {
                let table = format!("{path}.");
                if present.iter().any(|one| one.starts_with(&table)) {
                    absent(list, present, &path, inner);
                }
            }
            // The title and other strings at the top level do not affect a run.
            None if path.contains('.') && !present.contains(&path) => list.push(Stated {
                path,
                value: String::new(),
                help: format!("{} Type: {}.", field.help, field.kind),
                source: "not given".into(),
            }),
            None => {}
        }
    }
}

/// Fraction of the peak acceleration above which ground motion counts as strong. The player of a report uses the same
/// fraction.
const STRONG: f64 = 0.1;
/// Time (s) from the start of the strong ground motion to the end of the first part of a run, before rounding
/// ([`opening`]).
const IN_PROGRESS: f64 = 3.0;

/// Returns the end (s) of the first part of a run, rounded up to a whole second. A page shows this part while it
/// computes the whole run.
fn opening(motion: &GroundMotion) -> f64 {
    let limit = STRONG * motion.pga();
    let mut time = 0.0;
    while time < motion.duration && motion.horizontal.at(time).acceleration.abs() < limit {
        time += 0.01;
    }
    (time + IN_PROGRESS).ceil()
}

/// A field of the scenario, with its value and the source of the value.
#[derive(Serialize)]
struct Stated {
    path: String,
    value: String,
    help: String,
    source: String,
}

impl Looked {
    pub(crate) fn of(
        scenario: &Scenario,
        planes: &[Plane],
        language: Language,
    ) -> Result<Self, RunFailure> {
        let checked: Result<Vec<Checked>, RunFailure> =
            planes.iter().map(|plane| check(&plane.scenario)).collect();
        let mut checked = checked?;
        for motion in checked.iter_mut().filter_map(|plane| plane.motion.as_mut()) {
            motion.name = language.text(&motion.name);
        }
        let work = checked.iter().map(|plane| {
            let motion = plane.motion.as_ref().map_or(0.0, |motion| motion.duration);
            let bodies = plane.barrels + plane.racks + plane.free_bodies;
            scenario.run.duration.unwrap_or(motion) / plane.time_step * bodies as f64
        });
        let ground = planes.first().map(|plane| plane.scenario.ground()).transpose()?;
        let settings = scenario.settings().into_iter().map(|setting| Stated {
            path: setting.path,
            value: setting.value,
            help: setting.help.to_owned(),
            source: setting.source.words(),
        });
        let mut settings: Vec<Stated> = settings.collect();
        let present: Vec<String> = settings.iter().map(|one| one.path.clone()).collect();
        absent(&mut settings, &present, "", &ROOT);
        for Stated { help, source, .. } in &mut settings {
            (*help, *source) = (language.text(help), language.text(source));
        }
        let devices = scenario.stack().map(|stack| stack.devices.present()).unwrap_or_default();
        Ok(Self {
            title: language.text(&scenario.title),
            variants: planes.first().map_or(0, Plane::count),
            resolved: scenario.to_resolved_toml(),
            settings,
            devices: devices.iter().map(|words| language.text(words.many)).collect(),
            work: work.sum(),
            opening: ground.and_then(|ground| ground.motion.as_ref().map(opening)),
            stage: fragment(&[report::still(planes)?], language),
            checked,
        })
    }
}
