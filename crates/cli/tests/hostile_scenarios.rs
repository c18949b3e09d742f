//! Invalid scenario files: each gets one error at its place with the remedy, and nothing is written.

use std::fs;

use crate::common::{barrelstack, refused};

/// Eight barrels with a change.
fn stack(change: &str) -> Vec<u8> {
    format!("schema = 1\nextends = \"candia-8-barrels\"\n{change}\n").into_bytes()
}

/// A free scene: two blocks on the ground and a change.
fn free(change: &str) -> Vec<u8> {
    const SCENE: &str = r#"schema = 1
kind = "free"

[[body]]
name = "left"
shape = { type = "rectangle", width = "1 m", height = "1 m" }
mass = "100 kg"
position = ["-1 m", "0.5 m"]

[[body]]
name = "right"
shape = { type = "rectangle", width = "1 m", height = "1 m" }
mass = "100 kg"
position = ["1 m", "0.5 m"]

[[interface]]
between = ["left", "right"]
stiffness = "5 MN/m"
damping = "10 kN s/m"
friction = { coefficient = 0.3 }

[[interface]]
between = ["left", "ground"]
stiffness = "5 MN/m"
damping = "10 kN s/m"
friction = { coefficient = 0.3 }

[[interface]]
between = ["right", "ground"]
stiffness = "5 MN/m"
damping = "10 kN s/m"
friction = { coefficient = 0.3 }

[run]
duration = "1 s"
"#;
    let (from, to) = change.split_once(" => ").unwrap();
    assert!(SCENE.contains(from), "{from}");
    SCENE.replacen(from, to, 1).into_bytes()
}

fn utf16(text: &str) -> Vec<u8> {
    let mut bytes = vec![0xff, 0xfe];
    bytes.extend(text.encode_utf16().flat_map(u16::to_le_bytes));
    bytes
}

/// Refuses a file, with all of the words in its error.
fn refuse(what: &str, bytes: &[u8], words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("hostile.toml");
    let out = folder.path().join("out");
    fs::write(&file, bytes).unwrap();
    let named = ["hostile.toml"].iter().chain(words).copied().collect::<Vec<_>>();
    for command in [&["run"][..], &["check"]] {
        let mut arguments = vec![command[0], file.to_str().unwrap()];
        if command[0] == "run" {
            arguments.extend(["--out", out.to_str().unwrap()]);
        }
        refused(&format!("{what} ({})", command[0]), &barrelstack(&arguments), &out, &named);
    }
}

#[test]
fn files_that_are_no_text() {
    refuse("empty", b"", &["empty", "extends"]);
    refuse("blank", b"\n  \n# nothing\n", &["empty"]);
    refuse("picture", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", &["byte 0", "UTF-8"]);
    refuse("UTF-16", &utf16("schema = 1\n"), &["byte 0", "UTF-8"]);
    refuse("zeros", &[0; 64], &[":1:", "not valid TOML"]);
    refuse(
        "large",
        &vec![b'#'; 2 << 20],
        &["2097152 bytes", "if it is a motion record, name it in"],
    );
    refuse("a record", b"PEER STRONG MOTION\n .1 .2 -.3\n", &[":1:", "not valid TOML"]);
}

#[test]
fn files_that_are_cut_or_repeat_themselves() {
    refuse("cut", b"schema = 1\ntitle = \"half", &[":2:", "not valid TOML"]);
    refuse("cut table", b"schema = 1\n[stack", &[":2:", "not valid TOML"]);
    refuse("twice", &stack("[stack]\nlevels = 3\nlevels = 4"), &[":5:", "levels"]);
    refuse("no schema", b"title = \"a\"\n", &["schema"]);
    refuse("future", b"schema = 99\nextends = \"demo-napa\"\n", &[":1:", "schema", "99"]);
    refuse("mistyped", &stack("[stack]\nlevles = 3"), &[":4:1", "levles", "`levels`"]);
    refuse("extends nothing", b"schema = 1\nextends = \"none.toml\"\n", &[":2:", "none.toml"]);
    refuse(
        "extends itself",
        b"schema = 1\nextends = \"hostile.toml\"\n",
        &[":2:", "whether one of them extends itself"],
    );
}

#[test]
fn stacks_that_no_cellar_holds() {
    refuse("levels", &stack("[stack]\nlevels = 1000000000"), &[":4:", "levels", "1000000000"]);
    refuse("no level", &stack("[stack]\nlevels = 0"), &[":4:", "levels"]);
    refuse("minus", &stack("[stack]\nlevels = -3"), &[":4:", "levels", "-3"]);
    refuse("half", &stack("[stack]\nlevels = 2.5"), &[":4:", "levels", "2.5"]);
    refuse("words", &stack("[stack]\nlevels = \"three\""), &[":4:", "levels"]);
    refuse("columns", &stack("[stack]\ncolumns = 100000"), &[":4:", "columns"]);
    refuse(
        "no such barrel",
        &stack("[stack]\nbarrel = \"bordo-225\""),
        &[":4:", "bordo-225", "bordeaux-225"],
    );
}

#[test]
fn numbers_that_are_none() {
    let barrel = |field: &str| stack(&format!("[stack.barrel]\n{field}"));
    refuse("nan", &barrel("mass = nan"), &[":4:", "mass", "nan"]);
    refuse("bare", &barrel("mass = 275"), &[":4:", "mass", "unit", "kg"]);
    refuse("zero", &barrel("mass = \"0 kg\""), &[":4:", "mass"]);
    refuse("negative", &barrel("mass = \"-275 kg\""), &[":4:", "mass", "-275 kg"]);
    refuse("length for mass", &barrel("mass = \"275 m\""), &[":4:", "mass", "275 m"]);
    refuse("huge", &barrel("mass = \"1e300 kg\""), &[":4:", "mass"]);
    refuse("infinite", &barrel("mass = \"1e999 kg\""), &[":4:", "mass"]);
    refuse("wide bilge", &barrel("bilge_diameter = \"1e6 m\""), &["bilge_diameter"]);
    let friction = |value: &str| {
        stack(&format!("[interface.barrel-rack]\nfriction = {{ coefficient = {value} }}"))
    };
    refuse("negative friction", &friction("-0.1"), &[":4:", "coefficient", "-0.1"]);
    refuse("infinite friction", &friction("inf"), &[":4:", "coefficient", "inf"]);
    let stiffness =
        |value: &str| stack(&format!("[interface.barrel-rack]\nstiffness = \"{value}\""));
    refuse("no stiffness", &stiffness("0 N/m"), &[":4:", "stiffness"]);
    refuse("endless stiffness", &stiffness("1e40 N/m"), &["stiffness"]);
}

#[test]
fn runs_that_never_begin_or_end() {
    let run = |field: &str| stack(&format!("[run]\n{field}"));
    refuse("no step", &run("step = \"0 s\""), &[":4:", "step"]);
    refuse("long step", &run("step = \"5 ms\""), &[":4:", "run.step", "at most", "try 0."]);
    refuse("short step", &run("step = \"1e-30 s\""), &["step"]);
    refuse("endless", &run("duration = \"1e12 s\""), &["duration"]);
    refuse("no time", &run("duration = \"0 s\""), &[":4:", "duration"]);
    refuse("backward", &run("duration = \"-3 s\""), &[":4:", "duration"]);
    refuse("tiny", &run("similitude = 0"), &[":4:", "similitude"]);
    refuse("frames", &stack("[record]\nframe_rate = \"1e18 Hz\""), &[":4:", "frame_rate"]);
}

#[test]
fn bodies_where_none_can_be() {
    let moved = "[[stack.override]]\nkind = \"rack\"\nlevel = 2\noffset_x = \"0.9 m\"";
    refuse("rack in the air", &stack(moved), &["R2"]);
    let lifted = "[[stack.override]]\nkind = \"barrel\"\nlevel = 9\nmass = \"1 kg\"";
    refuse("no such level", &stack(lifted), &["level", "9"]);
    refuse(
        "overlap",
        &free("\"1 m\", \"0.5 m\" => \"-0.5 m\", \"0.5 m\""),
        &[":14:", "left", "right", "overlap", "move"],
    );
    refuse(
        "in the air",
        &free("\"1 m\", \"0.5 m\" => \"1 m\", \"5 m\""),
        &[":14:", "right", "rest"],
    );
    refuse("twice the name", &free("name = \"right\" => name = \"left\""), &["left", "name"]);
    refuse("no mass", &free("mass = \"100 kg\" => mass = \"0 kg\""), &[":7:", "mass"]);
    refuse(
        "no such body",
        &free("[\"left\", \"ground\"] => [\"lost\", \"ground\"]"),
        &["lost", "left"],
    );
    let flat = "shape = { type = \"rectangle\", width = \"1 m\", height = \"1 m\" } => \
                shape = { type = \"polygon\", vertices = [[\"0 m\", \"0 m\"], [\"1 m\", \"1 m\"], [\"1 m\", \"0 m\"], [\"0 m\", \"1 m\"]] }";
    refuse("crossed", &free(flat), &[":6:", "in order"]);
}

#[test]
fn motions_that_are_not_there() {
    refuse(
        "no file",
        &stack("[motion]\nrecord = \"none.at2\""),
        &["none.at2", "no such file", "--record"],
    );
    refuse("a folder", &stack("[motion]\nrecord = \".\""), &["folder"]);
    refuse(
        "no such record",
        &stack("[motion]\nbundled = \"napa\""),
        &["napa", "napa-college-2014"],
    );
    refuse("still", &stack("[motion.sine]\namplitude = \"0 in\""), &["amplitude"]);
    refuse("no period", &stack("[motion.sine]\nperiod = \"0 s\""), &[":4:", "period"]);
    refuse(
        "no channel",
        b"schema = 1\nextends = \"demo-napa\"\n[motion]\ncomponent = \"N999\"\n",
        &["N999", "\"Up\""],
    );
}

#[test]
fn scenes_that_fill_all_memory_are_refused_at_the_body_that_is_too_many() {
    let body = |name: usize, fields: &str| {
        format!("[[body]]\nname = \"b{name}\"\nkind = \"b\"\nmass = \"1 kg\"\n{fields}\n")
    };
    let nodes = "shape = { type = \"rectangle\", width = \"1 m\", height = \"1 m\" }\n\
                 nodes = { spacing = \"0.2 mm\" }\nposition = [\"0 m\", \"0 m\"]";
    let plane: String = (0..120).map(|name| body(name, nodes)).collect();
    let plane = format!("schema = 1\nkind = \"free\"\n{plane}");
    refuse("nodes", plane.as_bytes(), &["more than 2000000 contact nodes", "use fewer bodies"]);
    let part = "{ solid = { type = \"ball\", radius = \"0.1 m\" } }";
    let solid = format!(
        "solid = {{ type = \"compound\", parts = [{}] }}\nposition = [\"0 m\", \"0 m\", \"0 m\"]",
        vec![part; 1100].join(",")
    );
    let space: String = (0..2).map(|name| body(name, &solid)).collect();
    let space = format!("schema = 1\nkind = \"free-spatial\"\n{space}");
    refuse(
        "pairs",
        space.as_bytes(),
        &["more than 1000000 pairs of solids", "fewer bodies or parts"],
    );
}
