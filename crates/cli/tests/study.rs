//! `barrelstack study` under users, clusters and power failures.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use crate::common::{HEAD, STUDY, barrelstack, names, program, refused, stderr, stdout, there};

fn study(folder: &Path) -> String {
    let file = folder.join("study.toml");
    fs::write(&file, [HEAD, STUDY].concat()).unwrap();
    file.display().to_string()
}

fn run<'a>(file: &'a str, out: &'a str, threads: &'a str) -> [&'a str; 6] {
    ["study", file, "--out", out, "--threads", threads]
}

fn tables(out: &str) -> [Vec<u8>; 3] {
    ["table.csv", "table.parquet", "provenance.json"]
        .map(|name| fs::read(Path::new(out).join(name)).unwrap())
}

#[test]
fn killed_at_any_instant_and_resumed_it_gives_the_uninterrupted_table() {
    let folder = tempfile::tempdir().unwrap();
    let file = study(folder.path());
    let path = |name: &str| folder.path().join(name).display().to_string();
    let whole = path("whole");
    let start = std::time::Instant::now();
    let output = barrelstack(run(&file, &whole, "2"));
    let took = start.elapsed();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));

    let broken = path("broken");
    // Instants spread over the whole run, in irregular order.
    for share in [37, 5, 71, 18, 90, 53, 2, 64, 29, 83] {
        let mut child = program(run(&file, &broken, "2")).stdout(Stdio::null()).spawn().unwrap();
        std::thread::sleep(took.mul_f64(f64::from(share) / 300.0));
        // SIGKILL on Unix.
        child.kill().unwrap();
        child.wait().unwrap();
        if let Some(done) = names(&Path::new(&broken).join("shards")) {
            let whole = names(&Path::new(&whole).join("shards")).unwrap();
            let shards = done.iter().filter(|name| name.ends_with(".parquet"));
            assert!(
                shards.into_iter().all(|name| whole.contains(name)),
                "a shard that is there is right: {done:?}"
            );
        }
    }
    let output = barrelstack(run(&file, &broken, "2"));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(tables(&whole) == tables(&broken));
    let shards = |out: &str| names(&Path::new(out).join("shards")).unwrap();
    assert_eq!(shards(&whole), shards(&broken), "nothing is left over");
}

#[test]
fn chunks_run_one_by_one_in_any_order_give_the_table_of_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let file = study(folder.path());
    let (whole, parts) = (folder.path().join("whole"), folder.path().join("parts"));
    let (whole, parts) = (whole.display().to_string(), parts.display().to_string());
    assert_eq!(barrelstack(run(&file, &whole, "8")).status.code(), Some(0));
    let plan = barrelstack(["study", "plan", &file, "--json"]);
    let plan: serde_json::Value = serde_json::from_str(&stdout(&plan)).unwrap();
    let chunks = plan["chunks"].as_array().unwrap().len();
    assert_eq!((chunks, plan["cases"].as_u64()), (10, Some(40)));
    for chunk in (0..chunks).rev() {
        let chunk = chunk.to_string();
        let output = barrelstack(["study", "run-chunk", &file, "--chunk", &chunk, "--out", &parts]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        if chunk == "4" {
            let status = barrelstack(["study", "status", &parts, "--json"]);
            let status: serde_json::Value = serde_json::from_str(&stdout(&status)).unwrap();
            assert_eq!(status["missing"], serde_json::json!([0, 1, 2, 3]));
            // The last job of an array whose tasks are not all done must not pass for a finished one.
            let output = barrelstack(["study", "collect", &parts]);
            assert_eq!(output.status.code(), Some(4), "{}", stderr(&output));
            assert!(stderr(&output).contains("with 6 of 10 chunks done"), "{}", stderr(&output));
            let again =
                barrelstack(["study", "run-chunk", &file, "--chunk", &chunk, "--out", &parts]);
            assert!(stdout(&again).contains("chunk 4 is already finished"), "{}", stdout(&again));
        }
    }
    let output = barrelstack(["study", "collect", &parts]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(tables(&whole) == tables(&parts));
    let output = barrelstack(["study", "run-chunk", &file, "--chunk", "10", "--out", &parts]);
    assert!(stderr(&output).contains("has no chunk 10; its 10 chunks are numbered from 0 to 9"));
}

#[test]
fn lanes_of_every_unit_give_one_table_and_other_words_are_answered_with_those_there_are() {
    let folder = tempfile::tempdir().unwrap();
    let file = study(folder.path());
    let path = |name: &str| folder.path().join(name).display().to_string();
    let of = |unit: &str| {
        let out = path(unit);
        let output = barrelstack([&run(&file, &out, "2")[..], &["--lanes", unit]].concat());
        (out, output)
    };
    let (scalar, output) = of("scalar");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    for unit in ["avx2", "avx512"] {
        let (out, output) = of(unit);
        if output.status.code() == Some(0) {
            assert!(tables(&scalar) == tables(&out), "{unit}");
        } else {
            refused(unit, &output, Path::new(&out), &["this machine has no", unit, "has scalar"]);
        }
    }
    let (out, output) = of("sse2");
    refused(
        "an unknown unit",
        &output,
        Path::new(&out),
        &["--lanes", "there is no sse2", "scalar"],
    );
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_with_a_sentence_that_says_how_to_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let file = study(folder.path());
    let out = folder.path().join("out").display().to_string();
    let mut child = program(run(&file, &out, "1"))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The first shard shows that it is at work.
    let shards = Path::new(&out).join("shards");
    while names(&shards).is_none_or(|names| names.is_empty()) {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it wrote a shard");
        std::thread::sleep(Duration::from_millis(5));
    }
    let killed =
        std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(killed.unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    let message = stderr(&output);
    assert!(message.contains("run the same command again to continue from there"), "{message}");
    assert_eq!(barrelstack(run(&file, &out, "2")).status.code(), Some(0));
}

#[test]
fn mistakes_are_reported_before_anything_is_made() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let at = out.display().to_string();
    let case = |what: &str, arguments: &[&str], words: &[&str]| {
        refused(what, &barrelstack(arguments.iter().copied()), &out, words);
    };
    case(
        "no such file",
        &["study", "no.toml", "--out", &at],
        &["no.toml", "there is no such file"],
    );
    case(
        "no such study",
        &["study", "napa-four", "--out", &at],
        &["no built-in study", "napa-four-levels"],
    );
    case(
        "no such example",
        &["study", "example", "naba-four-levels"],
        &["did you mean `napa-four-levels`"],
    );
    case("no folder", &["study", "status", &at], &["does not exist"]);
    let scenario = folder.path().join("scenario.toml");
    fs::write(&scenario, "schema = 1\n[stack]\nlevels = 2\ncolumns = 1\n[motion]\nnone = true\n")
        .unwrap();
    let scenario = scenario.display().to_string();
    case("a scenario", &["study", &scenario, "--out", &at], &["unknown key `stack`"]);
    let broken = folder.path().join("broken.toml");
    fs::write(folder.path().join("site.AT2"), "not a record\n").unwrap();
    let text = [HEAD, STUDY].concat().replace(
        "[base.motion.pulse]\nkind = \"one-sine\"\namplitude = \"1 g\"\nperiod = \"0.3 s\"\n",
        "[[motion]]\nrecords = [\"site.AT2\"]\n",
    );
    let text = text.replace("[[factor]]\nfield = \"motion.pulse.amplitude\"\nvalues = [\"0.3 g\", \"0.6 g\", \"0.9 g\", \"1.2 g\"]\n", "");
    fs::write(&broken, text).unwrap();
    let broken = broken.display().to_string();
    case("no record", &["study", &broken, "--out", &at], &["the motion \"site\": ", "site.AT2"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_cannot_be_made_is_reported_in_plain_words() {
    let folder = tempfile::tempdir().unwrap();
    let file = study(folder.path());
    // Nothing can be created below a file; a folder below /proc cannot be created at all.
    let inside = folder.path().join("study.toml").join("out").display().to_string();
    let output = barrelstack(run(&file, &inside, "1"));
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("cannot create the folder"), "{}", stderr(&output));
    let output = barrelstack(run(&file, "/proc/barrelstack", "1"));
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("/proc/barrelstack"), "{}", stderr(&output));
}

#[test]
fn job_files_name_every_chunk() {
    let folder = tempfile::tempdir().unwrap();
    let file = study(folder.path());
    let emit = |engine, more: &[&str]| {
        let words = ["study", "emit", &file, "--engine", engine, "--out", "it's $HOME"];
        let output = barrelstack(words.iter().chain(more));
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        stdout(&output)
    };
    for (engine, word) in [
        ("slurm", "submit 0 9 "),
        ("parallel", "seq 0 9 | parallel"),
        ("hyperqueue", "--array 0-9"),
    ] {
        let text = emit(engine, &[]);
        assert!(text.contains(word) && text.contains("run-chunk"), "{text}");
        assert!(text.contains(&file) && Path::new(&file).is_absolute(), "{text}");
        // A shell can parse the script.
        let script = folder.path().join(engine);
        fs::write(&script, &text).unwrap();
        let check = std::process::Command::new("sh").arg("-n").arg(&script).status().unwrap();
        assert!(check.success(), "{text}");
    }
    let python = there("python3", &["--version"]);
    for engine in ["dask", "pylauncher"] {
        let text = emit(engine, &[]);
        assert!(text.contains("CHUNKS = 10\n") && text.contains("run-chunk"), "{text}");
        if python {
            let compile = "import sys; compile(sys.argv[1], 'job', 'exec')";
            let mut python = std::process::Command::new("python3");
            assert!(python.args(["-c", compile, &text]).status().unwrap().success(), "{text}");
        }
    }
    // No array is longer than the scheduler's limit, and every chunk is in one.
    let limits = ["--array-limit", "4", "--walltime", "00:10:00", "--throttle", "2"];
    let text = emit("slurm", &limits);
    for word in ["submit 0 3 ", "submit 4 3 ", "submit 8 1 ", "0-$last%2", "--time='00:10:00'"] {
        assert!(text.contains(word), "no {word:?} in {text}");
    }
    // A throttle holds for all arrays: with an `sbatch` that numbers its jobs, each waits for the one before.
    let bin = folder.path().join("bin");
    fs::create_dir(&bin).unwrap();
    let (sbatch, log) = (bin.join("sbatch"), folder.path().join("log"));
    let log_to = format!(
        "#!/bin/sh\ncat > /dev/null\necho \"$@\" >> '{0}'\nwc -l < '{0}' | tr -d ' '\n",
        log.display()
    );
    fs::write(&sbatch, log_to).unwrap();
    let script = folder.path().join("throttled");
    fs::write(&script, &text).unwrap();
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
    let shell = "chmod +x \"$1\" && exec sh \"$2\"";
    let mut submit = std::process::Command::new("sh");
    submit.args(["-c", shell, "sh"]).args([&sbatch, &script]).env("PATH", path);
    assert!(submit.output().unwrap().status.success());
    let log = fs::read_to_string(log).unwrap();
    let waits: Vec<_> = log.lines().map(|job| job.split_once("--dependency=afterany:")).collect();
    let waits = waits.iter().map(|wait| wait.map(|(_, jobs)| jobs.split(' ').next().unwrap()));
    assert_eq!(waits.collect::<Vec<_>>(), [None, Some("1"), Some("2"), Some("1:2:3")], "{log}");
    // Options that do not apply to an engine are refused, not silently ignored.
    for (engine, option) in
        [("dask", "--throttle"), ("parallel", "--walltime"), ("hyperqueue", "--array-limit")]
    {
        let words = ["study", "emit", &file, "--engine", engine, "--out", "x", option, "3"];
        let output = barrelstack(words);
        assert_eq!(output.status.code(), Some(2));
        let refusal = format!("{option} cannot be written into the files for this scheduler");
        assert!(stderr(&output).contains(&refusal));
    }
}

#[test]
fn reference_schema_and_example_are_printed() {
    assert!(stdout(&barrelstack(["study", "fields"])).contains("hunt and fill"));
    let schema: serde_json::Value =
        serde_json::from_str(&stdout(&barrelstack(["study", "schema"]))).unwrap();
    assert!(schema["$defs"]["design"].is_object() && schema["$defs"]["stack"].is_object());
    assert!(stdout(&barrelstack(["study", "example"])).contains("kind = \"stripes\""));
}
