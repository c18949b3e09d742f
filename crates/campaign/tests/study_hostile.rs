//! Study files with one mistake each: each gives one error at the right place, with a remedy.

#![allow(clippy::print_stdout, reason = "messages are read with --nocapture")]

use std::fmt::Write as _;
use std::ops::ControlFlow;

use barrelstack_campaign::study::{RunOptions, Study};
use proptest::prelude::*;

/// A study without a mistake, in parts that a case replaces: head, base, factor, intensity, design.
const HEAD: &str = "schema = 1\nseed = 3\n";
const SCENE: &str = "[base]\nextends = \"candia-8-barrels\"\n";
const FACTOR: &str =
    "[[factor]]\nfield = \"interface.rack-ground.friction.coefficient\"\nvalues = [0.3, 0.4]\n";
const INTENSITY: &str = "[intensity]\nmeasure = \"pgv\"\nlevels = [\"20 cm/s\", \"40 cm/s\"]\n";
const DESIGN: &str = "[design]\nkind = \"full-factorial\"\n";

fn whole(parts: [&str; 5]) -> String {
    parts.concat()
}

/// The mistakes: the part replaced (0 to 4), its replacement, and text of the error. The line of the mistake ends with
/// `# HERE`; without such a line the error is about the file as a whole or about a table that lacks something.
const MISTAKES: &[(usize, &str, &[&str])] = &[
    (0, "seed = 3\n", &["`schema` is missing from the study", "schema = 1"]),
    (0, "schema = 2 # HERE\n", &["`schema` must be", "found the number 2"]),
    (0, "schema = 1\nseed = -1 # HERE\n", &["`seed` must be an integer from 0"]),
    (0, "schema = 1\nsede = 3 # HERE\n", &["unknown key `sede`", "did you mean `seed`"]),
    (0, "schema = 1\nseed = \"x\" # HERE\n", &["`seed` must be an integer", "the text \"x\""]),
    (1, "", &["`base` is missing"]),
    (1, "base = 3 # HERE\n", &["`base` must be a table"]),
    (
        1,
        "[base]\nextends = \"candia-9-barrels\" # HERE\n",
        &["no \"candia-9-barrels\"", "did you mean `candia-6-barrels`"],
    ),
    (
        1,
        "[base]\nextends = \"candia-8-barrels\"\n[base.stack]\nlevels = 99999999 # HERE\n",
        &["`stack.levels` must be"],
    ),
    (
        1,
        "[base]\nextends = \"candia-8-barrels\"\n[base.stack]\nlevles = 3 # HERE\n",
        &["unknown key `levles`", "did you mean `levels`"],
    ),
    (
        2,
        "[[factor]]\nfield = \"interface.rack-grond.friction.coefficient\" # HERE\nvalues = [0.3]\n",
        &[
            "no field `interface.rack-grond.friction.coefficient`",
            "did you mean `interface.rack-ground.friction.coefficient`",
        ],
    ),
    (
        2,
        "[[factor]]\nfield = \"stack\" # HERE\nvalues = [0.3]\n",
        &["`stack` holds a table, but a factor varies a single value"],
    ),
    (
        2,
        "[[factor]]\nfield = \"title\" # HERE\nvalues = [\"x\"]\n",
        &["`title` has no effect on the stack"],
    ),
    (
        2,
        "[[factor]]\nfield = \"stack.levels\" # NOT\n",
        &["needs one of", "values", "range", "distribution"],
    ),
    (2, "[[factor]]\nfield = \"stack.levels\"\nvalues = [] # HERE\n", &["is an empty list"]),
    (2, "[[factor]]\nfield = \"stack.levels\"\nvalues = [2, 2] # HERE\n", &["contains 2 twice"]),
    (
        2,
        "[[factor]]\nfield = \"stack.levels\"\nvalues = [2, 3.5] # HERE\n",
        &["must be an integer", "3.5"],
    ),
    (
        2,
        "[[factor]]\nfield = \"stack.levels\"\nvalues = [2, 3]\nrange = { from = 2, to = 3, count = 2 } # HERE\n",
        &["both `values` and `range`; keep one"],
    ),
    (
        2,
        "[[factor]]\nfield = \"interface.barrel-rack.stiffness\"\nvalues = [980000] # HERE\n",
        &["needs a unit, found the number 980000", "980000 N/m"],
    ),
    (
        2,
        "[[factor]]\nfield = \"interface.barrel-rack.stiffness\"\nvalues = [\"9.8 kg\"] # HERE\n",
        &["is a mass (kg), expected a stiffness"],
    ),
    (
        2,
        "[[factor]]\nfield = \"interface.barrel-rack.stiffness\"\nvalues = [\"-1 N/m\"] # HERE\n",
        &["must be", "-1 N/m"],
    ),
    (
        2,
        "[[factor]]\nfield = \"stack.levels\"\nrange = { from = 2, to = 5, count = 3 } # HERE\n",
        &["not all whole numbers"],
    ),
    (
        2,
        "[[factor]]\nfield = \"stack.levels\"\ndistribution = { kind = \"uniform\", from = 2, to = 5 } # HERE\n",
        &["only a field of numbers", "discrete"],
    ),
    (
        2,
        "[[factor]]\nfield = \"interface.rack-ground.friction.coefficient\"\nrange = { from = 0.0, to = 0.5, count = 3, spacing = \"log\" } # HERE\n",
        &["`from` and `to` must be above zero"],
    ),
    (
        2,
        "[[factor]]\nfield = \"interface.rack-ground.friction.coefficient\"\ndistribution = { kind = \"normal\", mean = 0.4, deviation = 0.1, least = 3.0 } # HERE\n",
        &["no value of the distribution lies between"],
    ),
    (
        2,
        "[[factor]]\nfield = \"interface.rack-ground.friction.coefficient\"\ndistribution = { kind = \"gauss\", mean = 0.4 } # HERE\n",
        &["there is no \"gauss\""],
    ),
    (
        2,
        "[[factor]]\nfield = \"interface.rack-ground.friction.coefficient\"\ndistribution = { kind = \"discrete\", values = [0.3, 0.4], weights = [1] } # HERE\n",
        &["weights` has 1 weight for 2 values; give one weight per value"],
    ),
    (
        2,
        "[[factor]]\nname = \"pga\"\nfield = \"stack.levels\"\nvalues = [2, 3]\n",
        &["every table has a column `pga`"],
    ),
    (
        2,
        "[[factor]]\nfield = \"stack.levels\"\nvalues = [2, 3]\n[[factor]]\nname = \"again\"\nfield = \"stack.levels\"\nvalues = [4]\n",
        &["both set stack.levels"],
    ),
    (
        2,
        "[[factor]]\nfield = \"motion.sine.period\" # HERE\nvalues = [\"1 s\"]\n[[motion]]\nbundled = \"napa-college-2014\"\n",
        &["`motion.sine.period` is set by [[motion]]"],
    ),
    (
        2,
        "[[factor]]\nfield = \"motion.record\" # HERE\nvalues = [\"a.AT2\", \"b.AT2\"]\n",
        &[
            "`motion.record` names a file, which a factor cannot vary; list the files as `records` of [[motion]]",
        ],
    ),
    (
        2,
        "[[motion]]\nsynthetic = { kind = \"boore\", count = 3, magnitude = 6, distance = \"8 km\" }\n\
         scale = { measure = \"sa(1.0)\", value = \"0.3 g\", of = \"rotd50\" } # HERE\n",
        &["can refer to both horizontal components only for a recorded motion"],
    ),
    (
        2,
        "[[motion]]\nrecords = [\"nowhere.AT2\"]\n",
        &["cannot read the record nowhere.AT2: there is no such file", "correct the path"],
    ),
    (
        2,
        "[[motion]]\nfolder = \"nowhere\" # HERE\n",
        &["cannot list the folder nowhere: there is no such folder"],
    ),
    (2, "[[motion]]\nbundled = \"napa\" # HERE\n", &["there is no \"napa\"", "napa-college-2014"]),
    (2, "[[motion]]\nname = \"x\"\n", &["needs one of", "records", "folder"]),
    (
        2,
        "[[motion]]\nbundled = \"napa-college-2014\"\n[[motion]]\nbundled = \"napa-college-2014\"\n",
        &["two motions have the name \"napa-college-2014\"", "`name`"],
    ),
    (
        2,
        "[[motion]]\nsynthetic = { kind = \"boore\", count = 0, magnitude = 6, distance = \"8 km\" } # HERE\n",
        &["count` must be an integer from 1"],
    ),
    (
        2,
        "[[motion]]\nsynthetic = { kind = \"boore\", count = 3, magnitude = 6 } # HERE\n",
        &["`distance` is missing"],
    ),
    (
        2,
        "[[motion]]\nsynthetic = { kind = \"clough-penzien\", count = 2 }\n\
         scale = { measure = \"pgv\", value = \"1 m/s\", of = \"rotd50\" } # HERE\n",
        &["can refer to both horizontal components only for a recorded motion"],
    ),
    (
        2,
        "[[motion]]\nbundled = \"napa-college-2014\"\n[motion.each]\nscale = { pga = \"1 g\" } # HERE\n",
        &["not in `each`"],
    ),
    (3, "[intensity]\nmeasure = \"d5-95\" # HERE\nlevels = [\"1 s\"]\n", &["cannot be scaled to"]),
    (
        3,
        "[intensity]\nmeasure = \"pgx\" # HERE\nlevels = [\"1 s\"]\n",
        &["intensity.measure", "pgx"],
    ),
    (
        3,
        "[intensity]\nlevels = [\"0.2 g\"] # HERE\n",
        &["is an acceleration (m/s^2), expected a velocity"],
    ),
    (3, "[intensity]\nlevels = [\"0 m/s\"] # HERE\n", &["must be greater than 0"]),
    (
        3,
        "[intensity]\ndistribution = { kind = \"normal\", mean = \"0.3 m/s\", deviation = \"0.1 m/s\" } # HERE\n",
        &["levels must be above zero", "truncate it with `least`"],
    ),
    (3, "[intensity]\nmeasure = \"pgv\"\n", &["[intensity] has no levels"]),
    (4, "", &["`design` is missing"]),
    (4, "[design]\nkind = \"lhs\" # HERE\n", &["there is no \"lhs\""]),
    (4, "[design] # HERE\nkind = \"sobol\"\n", &["`count` is missing", "count = 1"]),
    (
        4,
        "[design]\nkind = \"full-factorial\"\ncount = 10 # HERE\n",
        &["`count` does not belong to `kind = \"full-factorial\"`", "leave it out"],
    ),
    (
        4,
        "[design]\nkind = \"ida\" # HERE\nfirst = \"1 m/s\"\nstep = \"1 m/s\"\n",
        &["finds the levels itself"],
    ),
    (
        4,
        "[design]\nkind = \"monte-carlo\"\nhalf_width = 0.9 # HERE\nmost = 10\n",
        &["`design.half_width` must be between"],
    ),
    (4, "[design]\nkind = \"full-factorial\"\nchunk = 0 # HERE\n", &["`design.chunk` must be"]),
    (4, "[design\nkind = 1\n", &["this is not valid TOML"]),
];

#[test]
fn every_mistake_is_one_error_at_its_place() {
    let good = [HEAD, SCENE, FACTOR, INTENSITY, DESIGN];
    Study::parse("case.toml", &whole(good)).unwrap_or_else(|error| panic!("{error}"));
    let mut wrong = Vec::new();
    for (part, mistake, words) in MISTAKES {
        let mut parts = good;
        parts[*part] = mistake;
        let text = whole(parts);
        let error = Study::parse("case.toml", &text).expect_err(mistake).to_string();
        println!("---- {}\n{error}\n", mistake.trim());
        let missing = words.iter().filter(|word| !error.contains(**word));
        wrong.extend(missing.map(|word| format!("no {word:?} in:\n{error}\n")));
        let here = text.lines().position(|line| line.ends_with("# HERE"));
        if let Some(line) = here {
            assert!(
                error.contains(&format!("case.toml:{}:", line + 1)),
                "not at line {}:\n{error}",
                line + 1
            );
        }
        assert!(!error.contains("default value"), "{error}");
    }
    assert!(wrong.is_empty(), "{}", wrong.concat());
}

#[test]
fn advice_on_a_missing_value_has_the_dimension_of_what_it_is_missing_from() {
    let design = "[design]\nkind = \"monte-carlo\"\nmost = 10\n";
    let drawn = "[intensity]\nmeasure = \"pgv\"\ndistribution = { kind = \"uniform\", ";
    let mut cases = vec![
        (format!("{drawn}to = \"1 m/s\" }}\n"), design.to_owned(), "from", "60 cm/s"),
        (format!("{drawn}from = \"1 cm/s\" }}\n"), design.to_owned(), "to", "60 cm/s"),
    ];
    for (measure, example) in [("pga", "0.35 g"), ("pgv", "60 cm/s"), ("arias", "60 cm/s")] {
        let intensity = format!("[intensity]\nmeasure = \"{measure}\"\n");
        let ranged = format!("{intensity}range = {{ to = \"{example}\", count = 3 }}\n");
        cases.push((ranged, "[design]\nkind = \"stripes\"\n".to_owned(), "from", example));
        for (given, missing) in [("first", "step"), ("step", "first")] {
            let hunt = format!("[design]\nkind = \"ida\"\n{given} = \"{example}\"\n");
            cases.push((intensity.clone(), hunt, missing, example));
        }
    }
    for (intensity, design, missing, example) in cases {
        let text = whole([HEAD, SCENE, FACTOR, &intensity, &design]);
        let error = Study::parse("case.toml", &text).unwrap_err().to_string();
        let line = format!("`{missing} = \"{example}\"`");
        assert!(error.contains(&format!("`{missing}` is missing")), "{intensity}{design}: {error}");
        assert!(error.contains(&line), "{intensity}{design}: no {line} in {error}");
    }
    // The error for a number in a list gives advice for that position.
    let text =
        whole([HEAD, SCENE, FACTOR, "[intensity]\nmeasure = \"pgv\"\nlevels = [0.1]\n", DESIGN]);
    let error = Study::parse("case.toml", &text).unwrap_err().to_string();
    assert!(error.contains("write for example \"0.1 m/s\""), "{error}");
}

#[test]
fn a_design_of_values_refuses_a_distribution() {
    let drawn = FACTOR.replace(
        "values = [0.3, 0.4]",
        "distribution = { kind = \"uniform\", from = 0.3, to = 0.6 }",
    );
    let error =
        Study::parse("case.toml", &whole([HEAD, SCENE, &drawn, INTENSITY, DESIGN])).unwrap_err();
    assert!(
        error.to_string().contains(
            "combines listed values, but `interface.rack-ground.friction.coefficient` has a distribution"
        ),
        "{error}"
    );
}

#[test]
fn too_many_cases_are_refused_and_not_counted() {
    let factor = |pair: &str| {
        format!(
            "[[factor]]\nfield = \"interface.{pair}.friction.coefficient\"\n\
             range = {{ from = 0.1, to = 0.9, count = 9999 }}\n"
        )
    };
    let many = ["rack-ground", "barrel-rack", "barrel-barrel", "barrel-ground", "rack-rack"]
        .map(factor)
        .concat();
    let hunted = "[intensity]\nmeasure = \"pgv\"\n";
    let hunt = "[design]\nkind = \"ida\"\nfirst = \"1 m/s\"\nstep = \"1 m/s\"\n";
    for [intensity, design] in [[INTENSITY, DESIGN], [hunted, hunt]] {
        let text = whole([HEAD, SCENE, &many, intensity, design]);
        let error = Study::parse("case.toml", &text).unwrap_err().to_string();
        assert!(error.contains("more than 10000000 cases: use fewer values"), "{error}");
    }
}

/// No file in a folder of records is silently skipped: the error names the first that is not a record.
#[test]
fn what_is_no_record_in_a_folder_of_records_is_named() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("records");
    std::fs::create_dir_all(folder.join("below")).unwrap();
    let mut record = "time (s),acceleration (g)\n".to_owned();
    for k in (0..300).map(f64::from) {
        writeln!(record, "{:.2},{:.3}", 0.01 * k, (0.2 * k).sin()).unwrap();
    }
    for name in ["good.csv", ".hidden.csv"] {
        std::fs::write(folder.join(name), &record).unwrap();
    }
    let (file, motion) = (place.path().join("study.toml"), "[[motion]]\nfolder = \"records\"\n");
    std::fs::write(&file, whole([HEAD, SCENE, FACTOR, motion, INTENSITY]) + DESIGN).unwrap();
    let load = || Study::load(&file);
    let motions = load().unwrap().motions();
    assert_eq!(motions, 1, "folders and hidden files are left out, as the reference says");
    let out = place.path().join("out");
    let run = || {
        load()
            .and_then(|study| study.run(&out, &RunOptions::default(), &|_| ControlFlow::Break(())))
    };
    let named = |what: &str| {
        let said = run().unwrap_err().to_string();
        assert!(said.contains("other.csv") && said.contains(what), "{said}");
        std::fs::remove_file(folder.join("other.csv")).unwrap();
    };
    std::fs::write(folder.join("other.csv"), "").unwrap();
    named("found an empty file");
    std::fs::write(folder.join("other.csv"), "To be added.\n").unwrap();
    named("as first line");
    #[cfg(unix)]
    {
        let link = |to: &str| std::os::unix::fs::symlink(to, folder.join("other.csv")).unwrap();
        link("gone");
        named("there is no such file");
        link("/dev/zero");
        named("it is a device, not a file");
        let _open = std::os::unix::net::UnixListener::bind(folder.join("other.csv")).unwrap();
        named("not a file");
    }
}

#[test]
fn every_truncation_of_a_study_is_read_or_refused() {
    let text = barrelstack_campaign::study::builtin("napa-four-levels").unwrap();
    for end in (0..text.len()).step_by(7).filter(|end| text.is_char_boundary(*end)) {
        if let Err(error) = Study::parse("cut.toml", &text[..end]) {
            assert!(!error.to_string().is_empty());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn any_value_anywhere_is_read_or_refused(line in 0usize..14, value in "[-0-9a-z.\"\\[\\]{}= ]{0,12}") {
        let text = whole([HEAD, SCENE, FACTOR, INTENSITY, DESIGN]);
        let changed: Vec<String> = text
            .lines()
            .enumerate()
            .map(|(at, old)| match old.split_once('=') {
                Some((key, _)) if at == line => format!("{key}= {value}"),
                _ => old.to_owned(),
            })
            .collect();
        if let Err(error) = Study::parse("any.toml", &changed.join("\n")) {
            prop_assert!(!error.to_string().is_empty());
        }
    }
}
