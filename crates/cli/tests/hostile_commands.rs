//! Wrong and malicious input: hundreds of cases, and in each no panic, no partial output, one error with its place
//! and the remedy, in bounded time and memory.

#![cfg(unix)]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::cases::Cases;
use crate::common::stderr;

/// Returns a scene of one block by this name.
fn block(name: &str) -> String {
    let name = toml_text(name);
    format!(
        "schema = 1\nkind = \"free\"\n\
         [[body]]\nname = {name}\nshape = {{ type = \"rectangle\", width = \"1 m\", height = \"1 m\" }}\n\
         mass = \"100 kg\"\nposition = [\"0 m\", \"0.5 m\"]\n\
         [[interface]]\nbetween = [{name}, \"ground\"]\nstiffness = \"5 MN/m\"\ndamping = \"10 kN s/m\"\n\
         friction = {{ coefficient = 0.3 }}\n[run]\nduration = \"0.05 s\"\n"
    )
}

/// Quotes text for TOML.
fn toml_text(text: &str) -> String {
    let escaped = text.chars().fold(String::new(), |mut all, c| {
        match c {
            '"' | '\\' => all.extend(['\\', c]),
            c if c.is_control() => write!(all, "\\u{:04x}", u32::from(c)).unwrap(),
            c => all.push(c),
        }
        all
    });
    format!("\"{escaped}\"")
}

/// Names given with intent to harm, or by mistake.
const NAMES: [&str; 18] = [
    "../../../etc/passwd",
    "/etc/passwd",
    "a,b",
    "a\nb",
    "a\r\nb",
    "\"",
    "a\"b",
    "\u{1b}[2J\u{1b}[31mred",
    "\u{7}\u{8}\u{7f}",
    "\u{9b}31m",
    "$(touch pwned)",
    "`touch pwned`",
    "; touch pwned",
    "<script>alert(1)</script>",
    "%s%n%d",
    "{}",
    "../up",
    "=cmd|' /C calc'!A0",
];

#[test]
fn names_of_scenarios_that_are_none() {
    let mut cases = Cases::new();
    let long = "a".repeat(5000);
    for name in NAMES.into_iter().chain([
        "",
        " ",
        ".",
        "/",
        "/dev/null",
        "/dev/zero",
        "none",
        "x.toml",
        &long,
    ]) {
        for command in ["run", "check", "render", "compare"] {
            match command {
                "render" => cases.refused(&[command, name, "--out=o"], &[]),
                "compare" => cases.refused(&[command, name, "demo-napa", "--out=o"], &[]),
                _ => cases.refused(&[command, name], &[]),
            }
        }
        cases.refused(&["scenarios", "show", name], &[]);
        cases.refused(&["study", "plan", name], &[]);
        cases.refused(&["motion", "info", name], &[]);
        cases.refused(&["run", "--json", name], &[]);
    }
    cases.end(200);
}

#[test]
fn changes_that_cannot_be_meant_name_themselves() {
    let mut cases = Cases::new();
    let fields = [
        "stack.levels",
        "stack.columns",
        "stack.barrel.mass",
        "run.step",
        "run.duration",
        "record.history_rate",
        "motion.scale.factor",
        "interface.rack-ground.friction.coefficient",
        "outcome.seat_loss_ratio",
        "run.similitude",
    ];
    let values = [
        "",
        "nan",
        "-inf",
        "1e999",
        "-1",
        "[1, 2]",
        "{ a = 1 }",
        "\"\"",
        "\"3 apples\"",
        "2026-11-22",
        "\u{1b}[31m",
        "$(touch pwned)",
        "'''",
        "99999999999999999999",
    ];
    for field in fields {
        for value in values {
            // A motion may be reversed.
            if (field, value) == ("motion.scale.factor", "-1") {
                continue;
            }
            let set = format!("--set={field}={value}");
            cases.refused(&["check", "demo-napa", &set], &["override"]);
        }
    }
    let long = format!("stack.{}=1", "a".repeat(100_000));
    let deep = format!("{}=1", ["a"; 500].join("."));
    for set in [
        "=",
        "==",
        ".",
        "..=1",
        "stack..levels=3",
        " =3",
        "stack.levels",
        "a=b",
        "stack=3",
        &long,
        &deep,
    ] {
        cases.refused(&["check", "demo-napa", "--set", set], &["override"]);
        cases.refused(&["check", "demo-napa", "--json", "--set", set], &["override"]);
    }
    for [first, second] in [
        ["stack.levels=3", "stack.levels=4"],
        ["stack.barrel.mass=300 kg", "stack.barrel=\"burgundy-228\""],
        ["motion.record=\"a.at2\"", "motion.bundled=\"napa-college-2014\""],
        ["motion.scale.factor=2", "motion.scale.pgv=60 cm/s"],
    ] {
        let sets = ["check", "demo-napa", "--set", first, "--set", second];
        cases.refused(&sets, &["contradicts", first, second]);
    }
    let record = ["check", "demo-napa", "--record=b.at2", "--set=motion.record=\"a.at2\""];
    cases.refused(&record, &["contradicts"]);
    cases.end(160);
}

#[test]
fn sizes_beyond_all_cellars_are_refused_before_they_are_spent() {
    let mut cases = Cases::new();
    for set in [
        "stack.levels=1000000",
        "stack.columns=1000000",
        "run.duration=1e15 s",
        "run.step=1e-15 s",
        "record.history_rate=1e9 Hz",
        "record.frame_rate=1e9 Hz",
        "motion.scale.factor=1e300",
        "run.similitude=1e-30",
        "run.similitude=1e30",
        "stack.barrel.mass=1e30 kg",
        "run.step=1 s",
        "stack.strap.levels=1000000000",
    ] {
        cases.refused(&["run", "demo-napa", "--set", set, "--out=o"], &[]);
        cases.refused(&["check", "demo-napa", "--set", set], &[]);
    }
    // Each within the range of its field, but together beyond memory.
    let kept = ["--set=record.history_rate=10 kHz", "--set=run.duration=3600 s"];
    cases.refused(&[&["run", "demo-napa"], &kept[..]].concat(), &["GB", "record.history_rate"]);
    for options in [
        &["heights", "--synthetic=1000000000"][..],
        &["heights", "--synthetic=-1"],
        &["heights", "--seed=x"],
        &["heights", "--rack=shelf"],
        &["heights", "--barrel=keg"],
        &["protect", "--pgv=50"],
        &["protect", "--pgv=-3 cm/s"],
        &["protect", "--pgv=1e999 cm/s"],
        &["protect", "--site=none.csv"],
        &["protect", "--motions=none"],
        &["protect", "--budget=-1"],
        &["protect", "--budget=nan"],
        &["protect", "--rounds=0"],
        &["protect", "sliding-block"],
        &["score", "sliding-block"],
        &["score", "--set=stack.rack=shelf"],
        &["run", "demo-napa", "--paper=a4"],
        &["render", "demo-napa", "--out=o", "--dpi=nan"],
        &["render", "demo-napa", "--out=o", "--dpi=1e9"],
        &["render", "demo-napa", "--out=o", "--rate=0"],
        &["render", "demo-napa", "--out=o", "--rate=inf"],
        &["render", "demo-napa", "--out=o", "--size=1000000"],
        &["render", "demo-napa", "--out=o", "--from=nan"],
        &["render", "demo-napa", "--out=o", "--from=9", "--to=3"],
        &["render", "demo-napa", "--out=o", "--only=x"],
        &["calibrate", "friction", "none.csv"],
        &["calibrate", "collapse", "demo-napa", "none.csv", "--simulations=1"],
        &["study", "report", "."],
        &["study", "status", "nowhere"],
        &["study", "collect", "/dev/null"],
        &["study", "example", "none"],
        &["study", "emit", "napa-four-levels", "--engine=x", "--out=o"],
        &["schema", "none"],
        &["schema", "\u{1b}[31m"],
        &["completions", "dos"],
        &["scenarios", "fields", "qqqq"],
        &["motion", "synth", "ricker", "--pga=1e999 g", "-o", "o.txt"],
        &["motion", "synth", "none"],
        &["motion", "scale", "napa-college-2014", "--to=pgv=-1 m/s", "-o", "o.txt"],
        &["motion", "match", "napa-college-2014", "--to=ec8:ag=nan,site=B", "-o", "o.txt"],
        &["motion", "convert", "napa-college-2014", "-o", "o.exe"],
        &["motion", "convert", "napa-college-2014", "-o", "none/o.txt"],
        &["motion", "spectrum", "napa-college-2014", "--damping=-5 %"],
        &["--none"],
        &["\u{1b}[31m"],
    ] {
        cases.refused(options, &[]);
        cases.refused(&[options, &["--json"]].concat(), &[]);
    }
    cases.end(90);
}

#[test]
fn studies_beyond_all_memory_are_refused_at_the_field_before_their_cases_are_made() {
    let mut cases = Cases::new();
    let range = |pair: &str, count: u32| {
        let field = format!("interface.{pair}.friction.coefficient");
        format!(
            "[[factor]]\nfield = \"{field}\"\nrange = {{ from = 0.1, to = 0.9, count = {count} }}\n"
        )
    };
    let drawn = |pair: &str| {
        let field = format!("interface.{pair}.friction.coefficient");
        let uniform = "distribution = { kind = \"uniform\", from = 0.1, to = 0.9 }";
        format!("[[factor]]\nfield = \"{field}\"\n{uniform}\n")
    };
    let pairs = ["rack-ground", "barrel-rack", "barrel-barrel", "barrel-ground", "rack-rack"];
    let factorial = "[design]\nkind = \"full-factorial\"\n";
    let synthetic = |count: u32| {
        format!(
            "[[motion]]\nname = \"m{count}\"\nsynthetic = {{ kind = \"clough-penzien\", count = {count} }}\n"
        )
    };
    let many_components = format!(
        "[[motion]]\nrecords = [{}]\ncomponents = [{}]\n",
        (0..1000).map(|at| format!("\"{at}.AT2\"")).collect::<Vec<_>>().join(","),
        (0..1000).map(|at| format!("\"{at}\"")).collect::<Vec<_>>().join(",")
    );
    let studies = [
        (synthetic(10_000_000) + factorial, "count = 10000000", "more than the maximum of 100000"),
        (
            (0..60).map(|at| synthetic(100_000 - at)).collect::<String>() + factorial,
            "motion",
            "the maximum of 100000: use fewer",
        ),
        (many_components + factorial, "components", "use fewer"),
        (
            pairs[..4].iter().map(|pair| range(pair, 1000)).collect::<String>() + factorial,
            "range",
            "more than 10000000 cases: use fewer values",
        ),
        (
            pairs[..3].iter().map(|pair| range(pair, 10_000)).collect::<String>()
                + "[design]\nkind = \"sobol\"\ncount = 8\n",
            "range",
            "more than 20000 values in total: give this factor fewer values",
        ),
        (
            pairs.iter().map(|pair| drawn(pair)).collect::<String>()
                + "[design]\nkind = \"latin-hypercube\"\ncount = 10000000\n",
            "count = 10000000",
            "use at most 7142857",
        ),
    ];
    let count = studies.len();
    for (number, (text, field, words)) in studies.into_iter().enumerate() {
        let base = "schema = 1\n[base]\nextends = \"candia-8-barrels\"\n";
        let file = cases.file(&format!("{number}.toml"), format!("{base}{text}").as_bytes());
        cases.refused(&["study", "plan", &file], &[&format!("{number}.toml:"), field, words]);
        cases.refused(&["study", &file, "--out=o"], &[words]);
    }
    cases.end(2 * count);
}

#[test]
fn folders_in_which_nothing_can_be_written_are_known_before_the_work() {
    let mut cases = Cases::new();
    let file = cases.file("file", b"mine");
    fs::create_dir(cases.at("mine")).unwrap();
    fs::write(cases.at("mine/report.html"), "mine").unwrap();
    let long = "o".repeat(300);
    for out in ["/proc/none", "/sys/none", "/dev/null", "/dev/null/o", "file", "file/o", &long, ""]
    {
        for command in ["run", "render", "compare", "demo"] {
            let scenarios: &[&str] = match command {
                "compare" => &["rocking-block", "sliding-block"],
                "demo" => &[],
                _ => &["rocking-block"],
            };
            let start = Instant::now();
            cases.refused(&[&[command], scenarios, &["--out", out]].concat(), &[]);
            assert!(
                start.elapsed() < Duration::from_secs(2),
                "{command} {out}: the work was done before"
            );
        }
    }
    cases.refused(&["demo", "--out=mine"], &["report.html", "--out"]);
    assert_eq!(fs::read_to_string(cases.at("mine/report.html")).unwrap(), "mine");
    assert_eq!(fs::read_to_string(cases.at(&file)).unwrap(), "mine");
    cases.end(33);
}

/// Commands that read, with IN in the place of the input; `m.txt`, `m.csv`, `observed.csv` and `study` exist in the same folder.
const READERS: [&[&str]; 44] = [
    &["run", "IN"],
    &["run", "demo-napa", "--record=IN"],
    &["run", "demo-napa", "--set=motion.record=\"IN\""],
    &["run", "demo-napa", "--set=motion.vertical_record=\"IN\""],
    &["run", "rocking-block", "--out=o", "--with-engine=IN"],
    &["check", "IN"],
    &["check", "demo-napa", "--record=IN"],
    &["render", "IN", "--out=o"],
    &["render", "demo-napa", "--record=IN", "--out=o"],
    &["compare", "IN", "demo-napa", "--out=o"],
    &["compare", "demo-napa", "--against=stack.levels=3", "--record=IN", "--out=o"],
    &["heights", "--record=IN", "--out=o"],
    &["protect", "IN", "--out=o"],
    &["protect", "demo-napa", "--record=IN", "--out=o"],
    &["protect", "demo-napa", "--motions=IN", "--out=o"],
    &["protect", "demo-napa", "--site=IN", "--out=o"],
    &["score", "IN", "--out=o"],
    &["reproduce", "--record=IN", "--out=o"],
    &["calibrate", "stiffness", "IN"],
    &["calibrate", "stiffness", "m.csv", "--scenario=IN"],
    &["calibrate", "drop", "IN"],
    &["calibrate", "friction", "IN"],
    &["calibrate", "collapse", "candia-8-barrels", "IN"],
    &["calibrate", "collapse", "IN", "observed.csv"],
    &["calibrate", "response", "candia-8-barrels", "IN"],
    &["study", "run", "IN", "--out=o"],
    &["study", "run-chunk", "IN", "--chunk=0", "--out=o"],
    &["study", "plan", "IN"],
    &["study", "emit", "IN", "--engine=slurm", "--out=o"],
    &["study", "status", "IN"],
    &["study", "collect", "IN"],
    &["study", "report", "IN"],
    &["study", "report", "study", "--hazard=IN"],
    &["study", "export", "IN", "--out=o"],
    &["motion", "info", "IN"],
    &["motion", "info", "m.txt", "--station-xml=IN"],
    &["motion", "info", "study", "--flatfile=IN", "--out=o"],
    &["motion", "select", "study", "--target=IN", "--out=o"],
    &["motion", "plot", "IN", "-o", "o"],
    &["motion", "convert", "IN", "-o", "o.txt"],
    &["motion", "process", "IN", "-o", "o.txt"],
    &["motion", "scale", "IN", "--factor=2", "-o", "o.txt"],
    &["motion", "spectrum", "IN"],
    &["motion", "match", "m.txt", "--to=IN", "-o", "o.txt"],
];

/// None waits for the other end of a pipe, or reads a device to its end.
#[test]
fn what_is_no_file_is_refused_by_every_command_that_reads() {
    let mut cases = Cases::new();
    let made = ["motion", "synth", "ricker", "--peak=0.3 g", "--period=0.5 s", "-o", "m.txt"];
    assert!(cases.run(&made).unwrap().status.success());
    cases.file("observed.csv", b"mode,until (s)\nstands,8\n");
    cases.file("m.csv", b"penetration (mm),force (kN)\n1,1\n2,2\n3,3\n");
    fs::create_dir(cases.at("study")).unwrap();
    let pipe = std::process::Command::new("mkfifo").arg(cases.at("pipe")).status().unwrap();
    assert!(pipe.success());
    std::os::unix::fs::symlink("gone", cases.at("link")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", cases.at("device")).unwrap();
    let _open = std::os::unix::net::UnixListener::bind(cases.at("socket")).unwrap();
    for reader in READERS {
        for input in ["pipe", "/dev/zero", "device", "socket", "link"] {
            let arguments: Vec<String> =
                reader.iter().map(|word| word.replace("IN", input)).collect();
            cases.refused(&arguments.iter().map(String::as_str).collect::<Vec<_>>(), &[input]);
        }
    }
    cases.end(200);
}

/// Returns a record of 300 samples as AT2, CSV and NPZ, and in the program's own text format.
fn records(cases: &mut Cases) -> Vec<String> {
    ["at2", "txt", "csv", "npz"]
        .map(|ending| {
            let name = format!("whole.{ending}");
            let made = ["motion", "synth", "ricker", "--peak=0.3 g", "--period=0.5 s", "-o", &name];
            let output = cases.run(&made).unwrap();
            assert!(output.status.success(), "{}", stderr(&output));
            name
        })
        .into()
}

#[test]
fn records_that_are_cut_or_no_records() {
    let mut cases = Cases::new();
    for whole in records(&mut cases) {
        let bytes = fs::read(cases.at(&whole)).unwrap();
        let ending = Path::new(&whole).extension().unwrap().to_str().unwrap().to_owned();
        for share in [0, 1, 3, 10, 25, 50, 75, 90, 99] {
            let cut =
                cases.file(&format!("cut-{share}.{ending}"), &bytes[..bytes.len() * share / 100]);
            cases.harmless(&["motion", "info", &cut]);
            cases.harmless(&["check", "demo-napa", "--record", &cut]);
        }
        for (number, place) in (0..bytes.len()).step_by(bytes.len() / 12).enumerate() {
            let mut changed = bytes.clone();
            changed[place] = if number % 2 == 0 { 0xff } else { b'9' };
            let changed = cases.file(&format!("changed-{number}.{ending}"), &changed);
            cases.harmless(&["motion", "info", &changed]);
        }
    }
    let line = [b"1 ".repeat(2_000_000), b"\n".to_vec()].concat();
    for (name, bytes) in [
        ("empty.at2", &b""[..]),
        ("zeros.at2", &[0; 4096]),
        ("picture.png", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"),
        ("zip.npz", b"PK\x03\x04\xff\xff\xff\xff"),
        ("nan.csv", b"time (s),acceleration (m/s2)\n0,nan\n0.01,inf\n"),
        ("words.csv", b"time (s),acceleration (m/s2)\n0,a\n"),
        ("back.csv", b"time (s),acceleration (m/s2)\n1,1\n0,1\n"),
        ("one.csv", b"time (s),acceleration (m/s2)\n0,1\n"),
        ("line.txt", &line),
        ("escape.at2", b"\x1b[31mPEER\nred\n\x1b[2J\nNPTS= 2, DT= 0.01\n0.1 0.2\n"),
        ("huge.at2", b"PEER NGA\nx\ny\nNPTS= 99999999999, DT= .01 SEC\n0.1 0.2\n"),
        ("step.at2", b"PEER NGA\nx\ny\nNPTS= 2, DT= 0 SEC\n0.1 0.2\n"),
    ] {
        let name = cases.file(name, bytes);
        cases.harmless(&["motion", "info", &name]);
        cases.refused(&["run", "demo-napa", "--record", &name], &[&name]);
        cases.refused(&["run", "demo-napa", "--json", "--record", &name], &[&name]);
    }
    cases.end(150);
}

#[test]
fn tables_that_are_none() {
    let mut cases = Cases::new();
    for (number, text) in [
        "",
        "\n\n",
        "a\n1\n",
        "penetration (mm),force (kN)\n",
        "penetration (mm),force (kN)\n1\n",
        "penetration (mm),force (kN)\n1,nan\n2,inf\n3,4\n",
        "penetration (mm),force (kN)\n1,\u{1b}[31m\n",
        "penetration (apples),force (kN)\n1,2\n",
        "angle (deg)\n1e999\n",
        "angle (deg)\n-5\n95\n",
        "\u{feff}angle (deg)\n",
        "time (s),rate (1/year)\n0,0\n",
        "pgv (cm/s),rate (1/year)\n1,nan\n",
    ]
    .into_iter()
    .enumerate()
    {
        let name = cases.file(&format!("table-{number}.csv"), text.as_bytes());
        for test in ["stiffness", "drop", "friction"] {
            cases.refused(&["calibrate", test, &name], &[&name]);
        }
        cases.refused(&["calibrate", "collapse", "candia-8-barrels", &name], &[&name]);
        cases.refused(&["calibrate", "response", "candia-8-barrels", &name], &[&name]);
    }
    for (number, text) in
        ["", "schema = 1\n", "schema = 2\n", "x", "[base]\nschema = 1\n", "schema = 1\nseed = -1\n"]
            .into_iter()
            .enumerate()
    {
        let name = cases.file(&format!("study-{number}.toml"), text.as_bytes());
        cases.refused(&["study", "plan", &name], &[&name]);
        cases.refused(&["study", &name, "--out=o"], &[&name]);
    }
    cases.end(75);
}

#[test]
fn names_of_bodies_stay_in_their_cells_and_folders() {
    let mut cases = Cases::new();
    for (number, name) in NAMES.into_iter().enumerate() {
        let file = cases.file(&format!("block-{number}.toml"), block(name).as_bytes());
        let out = format!("out-{number}");
        cases.harmless(&["run", &file, "--json"]);
        cases.harmless(&["run", &file, "--out", &out]);
        cases.harmless(&[
            "render",
            &file,
            "--only=figures",
            "--format=svg",
            "--out",
            &format!("drawn-{number}"),
        ]);
        let titled = format!("--set=title={}", toml_text(name));
        cases.harmless(&["run", "rocking-block", "--set=run.duration=0.02 s", &titled]);
        // A name is refused, or all files are sound.
        let Ok(table) = fs::read_to_string(cases.at(&format!("{out}/frames.csv"))) else {
            continue;
        };
        let rows = rows(&table);
        assert!(rows.iter().all(|row| row.len() == rows[0].len()), "{name:?}: {table:.300}");
        let archive = fs::read(cases.at(&format!("{out}/histories.npz"))).unwrap();
        let members = members(&archive);
        assert!(members.len() > 5, "{name:?}");
        for member in members {
            assert!(
                !member.contains(['/', '\\']) && !member.contains(char::is_control),
                "{name:?}: {member:?}"
            );
        }
    }
    assert!(!cases.at("pwned").exists());
    cases.end(60);
}

/// Names of records, stations, channels, motions, factors and bodies reach tables, and spreadsheets compute cells.
#[test]
fn no_cell_of_any_table_is_a_formula() {
    let mut cases = Cases::new();
    let mut text =
        "# barrelstack motion 1\n# station: =1+1\n# event: @SUM(1)\n# stage: corrected\n\
                    # unit: m/s2\n# time_step: 0.02\n# channels: =E az=90, +N az=0\n"
            .to_owned();
    for at in 0..300 {
        let phase = 0.1 * f64::from(at);
        writeln!(text, "{} {}", 3.0 * phase.sin(), 2.0 * (1.3 * phase).cos() - 2.0).unwrap();
    }
    fs::create_dir(cases.at("records")).unwrap();
    for name in ["records/=1+1.txt", "records/-a.txt"] {
        cases.file(name, text.as_bytes());
    }
    cases.file("records/@bad.txt", b"=cmd|' /C calc'!A0\n");
    cases.file("block.toml", block("=1+1").as_bytes());
    let study = "schema = 1\ntitle = \"=1+1\"\n[base]\nextends = \"sliding-block\"\n\
                 [base.run]\nduration = \"0.1 s\"\n\
                 [[motion]]\nname = \"@SUM(1)\"\nrecords = [\"records/-a.txt\"]\n\
                 [[motion]]\nrecords = [\"records/=1+1.txt\"]\n\
                 [[factor]]\nname = \"=1+1\"\nfield = \"interface.block-ground.friction.coefficient\"\n\
                 values = [0.2, 0.4]\n[design]\nkind = \"full-factorial\"\n";
    cases.file("study.toml", study.as_bytes());
    let record = "records/=1+1.txt";
    let set = ["--target=ec8:ag=0.3,site=B", "--scale=0.01..1000", "--count=2", "--out=set"];
    for command in [
        &["run", "block.toml", "--out=run"][..],
        &["compare", "block.toml", "--against=run.duration=0.1 s", "--out=compared"],
        &["study", "study.toml", "--out=study"],
        &["motion", "info", "records", "--out=table"],
        &["motion", "plot", record, "-o", "drawn"],
        &["motion", "convert", record, "-o", "converted.csv"],
        &["motion", "process", record, "--high-pass=0.5 Hz", "-o", "processed.csv"],
        &["motion", "scale", record, "--factor=2", "-o", "scaled.csv"],
        &[
            "motion",
            "match",
            record,
            "--to=ec8:ag=0.3,site=B",
            "--accept-misfit",
            "-o",
            "matched.csv",
        ],
        &["motion", "spectrum", record, "-o", "spectrum.csv"],
        &[&["motion", "select", "records"], &set[..]].concat(),
    ] {
        let said = cases.run(command).unwrap();
        assert!(matches!(said.status.code(), Some(0 | 3)), "{command:?}: {}", stderr(&said));
    }
    let (mut look, mut tables) = (vec![cases.at("")], 0);
    while let Some(folder) = look.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                look.push(path);
            } else if path.extension().is_some_and(|kind| kind == "csv") {
                tables += 1;
                for cell in rows(&fs::read_to_string(&path).unwrap()).concat() {
                    let computed = cell.starts_with(['=', '+', '-', '@', '\t', '\r']);
                    let number = cell.len() == 1 || cell.parse::<f64>().is_ok();
                    assert!(!computed || number, "{}: {cell:?}", path.display());
                }
            }
        }
    }
    assert!(tables > 25, "{tables}");
    cases.end(11);
}

/// Parses the rows of a CSV file (RFC 4180).
fn rows(text: &str) -> Vec<Vec<String>> {
    let (mut rows, mut row, mut cell, mut quoted) = (Vec::new(), Vec::new(), String::new(), false);
    let mut all = text.chars().peekable();
    while let Some(c) = all.next() {
        match c {
            '"' if quoted && all.peek() == Some(&'"') => cell.extend(all.next()),
            '"' => quoted = !quoted,
            ',' if !quoted => row.push(std::mem::take(&mut cell)),
            '\n' if !quoted => {
                row.push(std::mem::take(&mut cell));
                rows.push(std::mem::take(&mut row));
            }
            c => cell.push(c),
        }
    }
    rows
}

/// Returns the names in an archive.
fn members(archive: &[u8]) -> Vec<String> {
    let starts = archive.windows(4).enumerate().filter(|(_, four)| *four == b"PK\x01\x02");
    let name = |at: usize| {
        let length = usize::from(u16::from_le_bytes([archive[at + 28], archive[at + 29]]));
        String::from_utf8(archive[at + 46..at + 46 + length].to_vec()).unwrap()
    };
    starts.map(|(at, _)| name(at)).collect()
}
