//! Studies of three-dimensional stacks: each case is one run whatever the number of threads, with columns for
//! directions.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::Path;

use crate::common::HEAD;
use barrelstack::motion::AccelerationUnit;
use barrelstack::{Record, Scenario};
use barrelstack_campaign::study::{Progress, RunOptions, Study, StudyError, StudyTable};
use barrelstack_space::variants::Case;
use barrelstack_space::{Heading, run::run};

/// A short three-dimensional run, after [`HEAD`].
const RUN: &str = "\
duration = \"1.5 s\"
stop_after_collapse = \"0.01 s\"
[base.stack]
view = \"spatial\"
levels = 2
columns = 2
";

/// Returns a study of short three-dimensional runs.
fn study(rest: &str) -> Study {
    let head = HEAD.replace("[base.stack]\nlevels = 2\ncolumns = 2\n", "");
    let text = format!("{head}{RUN}{rest}");
    Study::parse("test.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Study of the demo with two levels under all components of its record, in two orientations and at two intensities.
const DEMO: &str = "\
schema = 1
title = \"two levels of the demo\"
seed = 7
[base]
extends = \"demo-napa\"
[base.stack]
view = \"spatial\"
levels = 2
[base.run]
duration = \"8 s\"
stop_after_collapse = \"0.01 s\"
[[factor]]
field = \"stack.azimuth\"
values = [\"0 deg\", \"40 deg\"]
[[factor]]
name = \"friction\"
field = \"interface.rack-ground.friction.coefficient\"
distribution = { kind = \"lognormal\", median = 0.5, dispersion = 0.2 }
[[motion]]
bundled = \"napa-college-2014\"
each = { component = \"horizontal-1\", vertical = \"UP\" }
[intensity]
measure = \"pgv\"
levels = [\"40 cm/s\", \"130 cm/s\"]
[design]
kind = \"stripes\"
chunk = 1
";

/// Runs the case of a row of the table by itself.
fn run_of(table: &StudyTable, row: usize) -> Case {
    let number = |column: &str| table.numbers(column).unwrap()[row].unwrap();
    let changes = [
        "stack.view=spatial".to_owned(),
        "stack.levels=2".to_owned(),
        "run.duration=8 s".to_owned(),
        "run.stop_after_collapse=0.01 s".to_owned(),
        format!("stack.azimuth={} rad", number("stack.azimuth")),
        format!("interface.rack-ground.friction.coefficient={}", number("friction")),
        format!("motion.scale.factor={}", number("scale_factor")),
    ];
    Case::of(&run(&Scenario::builtin("demo-napa", &changes).unwrap()).unwrap())
}

#[test]
fn a_case_is_the_run_of_its_scenario_to_the_last_bit() {
    let table = Study::parse("test.toml", DEMO).unwrap().table().unwrap();
    let bits = |column: &str, row: usize| table.numbers(column).unwrap()[row].map(f64::to_bits);
    for row in 0..table.rows() {
        let Case { result, first, debris } = run_of(&table, row);
        let outcome = result.outcome.as_ref().unwrap();
        assert_eq!(table.texts("outcome").unwrap()[row].as_deref(), Some(outcome.kind()));
        for (column, expected) in [
            ("first_fall", result.first_fall),
            ("base_slip_peak", result.demands.base_slip_peak),
            ("residual_displacement", result.residual_displacement),
            ("end_time", result.end_time),
            ("energy_residual_ratio", result.energy_residual_ratio),
        ] {
            assert_eq!(bits(column, row), expected.map(f64::to_bits), "{column} of row {row}");
        }
        assert_eq!(table.texts("heading").unwrap()[row].as_deref(), first.map(Heading::name));
        let away = debris.iter().filter(|heading| **heading == Heading::Away).count();
        assert_eq!(table.integers("debris_away").unwrap()[row], i64::try_from(away).ok());
    }
    let outcomes = table.texts("outcome").unwrap();
    for kind in ["stable", "collapse"] {
        assert!(outcomes.iter().any(|one| one.as_deref() == Some(kind)), "{kind} is not looked at");
    }
}

#[test]
fn neither_threads_nor_a_stop_change_a_byte() {
    let study = Study::parse("test.toml", DEMO).unwrap();
    let run = |folder: &Path, threads, report: &(dyn Fn(&Progress) -> ControlFlow<()> + Sync)| {
        let options = RunOptions { threads: NonZero::new(threads), ..RunOptions::default() };
        study.run(folder, &options, report)
    };
    let bytes = |folder: &Path| {
        ["table.csv", "table.parquet", "provenance.json"]
            .map(|name| std::fs::read(folder.join(name)).unwrap())
    };
    let (whole, parts) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    run(whole.path(), 1, &|_| ControlFlow::Continue(())).unwrap();
    // During the second case: `stop` is polled many times before it finishes.
    let stop = |now: &Progress| {
        if now.now == 1 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    assert!(matches!(run(parts.path(), 1, &stop), Err(StudyError::Stopped)));
    run(parts.path(), 3, &|_| ControlFlow::Continue(())).unwrap();
    assert!(bytes(whole.path()) == bytes(parts.path()));
}

const PULSE: &str = "\
[[motion]]
name = \"pulse\"
pulse = { kind = \"one-sine\", amplitude = \"1.2 g\", period = \"0.8 s\" }
";

#[test]
fn beside_a_plane_space_adds_columns_and_changes_no_row_of_it() {
    let views = |views: &str| {
        let factor = format!("[[factor]]\nfield = \"stack.view\"\nvalues = [{views}]\n");
        let text = format!("{RUN}{PULSE}{factor}[design]\nkind = \"full-factorial\"");
        let text = text.replace("view = \"spatial\"\n", "");
        let head = HEAD.replace("[base.stack]\nlevels = 2\ncolumns = 2\n", "");
        Study::parse("test.toml", &format!("{head}{text}")).unwrap().table().unwrap()
    };
    let (plane, both) = (views("\"transverse\""), views("\"transverse\", \"spatial\""));
    assert!(plane.column("heading").is_none() && plane.column("debris_away").is_none());
    // The three-dimensional case is in a separate chunk.
    for column in plane.columns() {
        let other = both.column(&column.spec.name).unwrap();
        assert_eq!(other.values.get(0), column.values.get(0), "{}", column.spec.name);
    }
    assert_eq!(both.texts("heading").unwrap()[0], None);
    assert_eq!(both.integers("debris_right").unwrap()[0], None, "a plane has no such direction");
    // A formula has one component, which shakes the stack across its barrels.
    let heading = both.texts("heading").unwrap()[1].as_deref();
    assert!(matches!(heading, Some("right" | "left")), "{heading:?}");
}

#[test]
fn a_hunt_in_space_brackets_the_collapse() {
    let hunt = "[intensity]\nmeasure = \"pga\"\n[design]\nkind = \"ida\"\nfirst = \"0.3 g\"\n\
                step = \"0.5 g\"\nruns = 4";
    let table = study(&format!("{PULSE}{hunt}")).table().unwrap();
    let levels = table.numbers("level").unwrap();
    let of = |kind: &str| -> Vec<f64> {
        let outcomes = table.texts("outcome").unwrap().iter().zip(levels);
        outcomes.filter(|(one, _)| one.as_deref() == Some(kind)).filter_map(|(_, at)| *at).collect()
    };
    let (stood, fell) = (of("stable"), of("collapse"));
    assert_eq!(stood.len() + fell.len(), 4);
    let highest = stood.into_iter().fold(0.0, f64::max);
    assert!(fell.into_iter().any(|level| level > highest) && highest > 0.0, "{levels:?}");
}

#[test]
fn what_space_does_not_know_is_a_row_with_its_reason() {
    let wine = "[[factor]]\nfield = \"stack.barrel.fill\"\nvalues = [\"part\"]\n";
    let table =
        study(&format!("{PULSE}{wine}[design]\nkind = \"full-factorial\"")).table().unwrap();
    let error = table.texts("error").unwrap()[0].as_deref().unwrap();
    assert!(error.contains("sloshing wine is supported only in a plane"), "{error}");
    assert_eq!(table.integers("debris_near").unwrap()[0], None);
}

#[test]
fn a_record_of_one_component_is_reported_as_such() {
    let pulse: Vec<f64> = (0..200).map(|k| if k < 50 { 1.0 } else { -1.0 }).collect();
    let unit = AccelerationUnit::MetersPerSecondSquared;
    let record = Record::of_samples("pulse", &[("E", pulse.as_slice())], 0.01, unit).unwrap();
    let bytes = barrelstack_motion::write::text(&record).unwrap().into_bytes();
    let head = HEAD.replace("[base.stack]\nlevels = 2\ncolumns = 2\n", "");
    let text = format!(
        "{head}{RUN}[[motion]]\nrecords = [\"site.txt\"]\n[design]\nkind = \"full-factorial\""
    );
    let warnings = |view: &str| {
        let text = text.replace("spatial", view);
        let study = Study::parse_with("test.toml", &text, &mut |_| Ok(bytes.clone())).unwrap();
        let table = study.table().unwrap();
        assert_eq!(table.texts("error").unwrap()[0], None);
        table.integers("warnings").unwrap()[0].unwrap()
    };
    assert_eq!(warnings("spatial"), warnings("transverse") + 1);
}
