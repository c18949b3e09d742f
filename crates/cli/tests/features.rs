//! The table of features in `docs/features.md`, held against the program.

use std::fs;
use std::path::Path;

use crate::common::{barrelstack, stderr};

/// Page with the table.
const PAGE: &str = include_str!("../../../docs/features.md");

/// The views, in the order of the columns.
const VIEWS: [&str; 3] = ["transverse", "longitudinal", "spatial"];

/// Two levels, shaken for a moment; a view follows.
const STUDY: &str = "\
schema = 1
title = \"a moment\"
[base.stack]
levels = 2
columns = 2
[base.run]
duration = \"0.05 s\"
[base.motion.pulse]
kind = \"one-sine\"
amplitude = \"1 g\"
period = \"0.3 s\"
";

/// A factor with a distribution.
const FACTORS: &str = "\
[[factor]]
name = \"friction\"
field = \"interface.rack-ground.friction.coefficient\"
distribution = { kind = \"lognormal\", median = 0.5, dispersion = 0.2 }
";

/// Levels of intensity.
const LEVELS: &str = "\
[intensity]
measure = \"pga\"
levels = [\"0.1 g\", \"0.2 g\"]
";

/// Designs of studies, each with what it needs.
const DESIGNS: [(&str, &str, &str); 8] = [
    ("full-factorial", "", LEVELS),
    ("one-at-a-time", FACTORS, ""),
    ("latin-hypercube", FACTORS, "[design]\ncount = 2\n"),
    ("sobol", FACTORS, "[design]\ncount = 2\n"),
    ("saltelli", FACTORS, "[design]\ncount = 2\n"),
    ("monte-carlo", FACTORS, "[design]\nleast = 2\nmost = 2\n"),
    ("stripes", FACTORS, LEVELS),
    (
        "ida",
        "",
        "[intensity]\nmeasure = \"pga\"\n[design]\nfirst = \"0.1 g\"\nstep = \"0.1 g\"\nruns = 3\n",
    ),
];

/// A row of the table: the feature, and its cells.
struct Row {
    feature: &'static str,
    cells: [&'static str; 3],
    shown_by: &'static str,
}

fn rows() -> Vec<Row> {
    let lines =
        PAGE.lines().filter(|line| line.starts_with("| ") && !line.starts_with("| feature"));
    let row = |line: &'static str| {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        let [feature, across, along, space, shown_by] = cells[..] else { panic!("{line}") };
        Row { feature, cells: [across, along, space], shown_by }
    };
    lines.map(row).collect()
}

/// Returns the command lines that exercise a feature in a view; empty for a feature that only tests elsewhere exercise.
#[expect(clippy::too_many_lines, reason = "one command line per feature")]
fn probes(feature: &str, view: &str, folder: &Path) -> Vec<Vec<String>> {
    let place = |name: &str| folder.join(name).display().to_string();
    let stack = [format!("--set=stack.view={view}"), "--set=stack.levels=2".to_owned()];
    let line = |words: &[&str]| -> Vec<Vec<String>> {
        let words = words.iter().map(|word| (*word).to_owned());
        vec![words.chain(stack.clone()).collect()]
    };
    let check = |change: &str| line(&["check", "demo-napa", &format!("--set={change}")]);
    let short = ["demo-napa", "--set=run.duration=0.1 s", "-q"];
    let run = |more: &[&str]| line(&[&["run"], &short[..], more].concat());
    let out = place("out");
    let out = format!("--out={out}");
    let render = |part: &str| {
        let only = format!("--only={part}");
        line(
            &[
                &["render"],
                &short[..],
                &["--variants=0", "--overwrite", &only, "--size=64", "--dpi=20", "--rate=20", &out],
            ]
            .concat(),
        )
    };
    let start = |text: &str| feature.starts_with(text);
    match feature {
        _ if start("racks of tubes") => {
            [check("stack.rack=two-barrel"), check("stack.rack=single-bar")].concat()
        }
        _ if start("racks for two barrels") => check("stack.rack=four-barrel"),
        _ if start("racks on posts") => check("stack.rack=rack-on-rack"),
        _ if start("racks with feet") => check("stack.rack=two-barrel-feet"),
        _ if start("inclined rails") => check("stack.rack=two-barrel-inclined"),
        _ if start("cradles that are arcs") => check(
            "stack.rack.cradle={ type = \"arc\", radius = \"0.36 m\", half_angle = \"30 deg\" }",
        ),
        _ if start("contact constants") => line(&[
            "check",
            "demo-napa",
            "--set=stack.rack.contact=element",
            "--set=interface.barrel-rack.basis=node",
        ]),
        _ if start("part-filled") => check("stack.barrel.fill=part"),
        _ if start("scaled stacks") => check("run.similitude=0.5"),
        "straps" => check("stack.strap.levels=2"),
        _ if start("stops that keep") => check("stack.walking_stop.levels=1"),
        "chocks" => check("stack.chock={ gap = \"1 cm\" }"),
        "lids" => check("stack.lid.levels=1"),
        "pads" => check("stack.pad.stiffness=1 MN/m"),
        "isolators" => check("stack.isolator.path=dish"),
        _ if start("ties to walls") => check("stack.tie.levels=1"),
        "tuned masses" => check("stack.tuned_mass.mass=50 kg"),
        "`run`, with variants" => run(&["--variants=2", "--no-remedy"]),
        "`run --verify`" => run(&["--variants=0", "--verify"]),
        "`run --pdf`" => run(&["--variants=0", "--pdf", "--overwrite", &out]),
        "`run --with-engine`" => {
            let engine = place("engine.html");
            fs::write(&engine, "<script type=\"text/plain\" id=\"engine\"></script>").unwrap();
            run(&["--variants=0", "--with-engine", &engine, "--overwrite", &out])
        }
        "`check`" => check("stack.gap=10 cm"),
        // In planes, the table takes a minute; other tests make it.
        "`check --table`" if view != "spatial" => Vec::new(),
        "`check --table`" => {
            vec![vec!["check".into(), "demo-napa".into(), "--table".into(), stack[0].clone()]]
        }
        _ if start("`compare`") => {
            let against = "--against=stack.gap=12 cm";
            line(
                &[&["compare"], &short[..], &["--variants=0", against, "--overwrite", &out]]
                    .concat(),
            )
        }
        _ if start("`render`: figures") => {
            ["figures", "report", "animation", "frames"].into_iter().flat_map(render).collect()
        }
        _ if start("`render`: ParaView") => render("paraview"),
        _ if start("`study`") => {
            let study = |(kind, factors, more): &(&str, &str, &str)| {
                let design = format!("[design]\nkind = \"{kind}\"\n");
                let rest = if more.contains("[design]\n") {
                    more.replace("[design]\n", &design)
                } else {
                    format!("{more}{design}")
                };
                let text = STUDY.replace("levels = 2", &format!("levels = 2\nview = \"{view}\""));
                let (file, out) =
                    (place(&format!("{kind}.toml")), place(&format!("{kind}-{view}")));
                fs::write(&file, format!("{text}{factors}{rest}")).unwrap();
                ["study", "run", &file, "-q", "--out", &out].map(str::to_owned).to_vec()
            };
            // In planes, other tests run every design.
            DESIGNS.iter().take(if view == "spatial" { 8 } else { 1 }).map(study).collect()
        }
        _ if start("`calibrate stiffness`") => {
            let file = place("tap.csv");
            fs::write(&file, "period (s)\n0.30\n0.31\n0.305\n").unwrap();
            line(&["calibrate", "stiffness", &file, "--scenario=demo-napa"])
        }
        "`calibrate response`" => {
            let file = place("histories.csv");
            let rows = "0,0\n0.01,0\n0.02,0.1\n0.03,0.2\n0.04,0.1\n";
            fs::write(&file, format!("time (s),B1.1_displacement_x (mm)\n{rows}")).unwrap();
            line(&["calibrate", "response", "demo-napa", &file, "--fit=mu-br"])
        }
        "`calibrate collapse`" => {
            let file = place("film.csv");
            fs::write(&file, "mode,until (s)\nstands,0.02\n").unwrap();
            line(&["calibrate", "collapse", "demo-napa", &file, "--fit=mu-br", "--simulations=50"])
        }
        _ => Vec::new(),
    }
}

/// Features that only the tests in the last column exercise.
const ELSEWHERE: [&str; 7] = [
    "search for changes",
    "Python: run",
    "Python: `compare`",
    "the page that",
    "`heights`",
    "`protect`",
    "`score`",
];

#[test]
fn every_feature_works_or_is_refused_as_the_table_says() {
    let rows = rows();
    assert!(rows.len() > 30, "{}", rows.len());
    for Row { feature, cells, .. } in &rows {
        let elsewhere = ELSEWHERE.iter().any(|start| feature.starts_with(start));
        for (view, cell) in VIEWS.into_iter().zip(cells) {
            let folder = tempfile::tempdir().unwrap();
            let probes = probes(feature, view, folder.path());
            let elsewhere = elsewhere || (*feature == "`check --table`" && view != "spatial");
            assert_eq!(probes.is_empty(), elsewhere, "{feature} needs a command");
            let reason = cell.split('“').nth(1).and_then(|rest| rest.split('”').next());
            for words in &probes {
                let output = barrelstack(words);
                let said = stderr(&output);
                match reason {
                    None => {
                        assert_eq!(*cell, "yes", "{feature}, {view}");
                        assert_eq!(output.status.code(), Some(0), "{words:?}: {said}");
                    }
                    Some(reason) => {
                        assert!(cell.starts_with("no: "), "{feature}, {view}");
                        assert_eq!(output.status.code(), Some(2), "{words:?}: {said}");
                        assert!(said.contains(reason), "{words:?}: {said}");
                        assert!(!folder.path().join("out").exists(), "{words:?} wrote files");
                    }
                }
            }
        }
    }
}

#[test]
fn every_test_and_validation_that_the_table_names_is_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for Row { feature, shown_by, .. } in rows() {
        let files: Vec<&str> = shown_by.split('`').skip(1).step_by(2).collect();
        assert!(!files.is_empty(), "{feature}");
        for file in files {
            assert!(root.join(file).is_file(), "{feature}: {file}");
        }
    }
}
