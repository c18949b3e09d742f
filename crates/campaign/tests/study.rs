//! Designs and tables of studies: their cases, the stability of their rows, and independence of threads.

use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::Path;

use crate::common::HEAD;
use barrelstack::ensemble::Width;
use barrelstack_campaign::study::{
    ChunkRun, Collected, Progress, Role, RunOptions, Study, StudyError, StudyTable, Tally, Value,
};

/// A short run, after [`HEAD`]: a case of a few milliseconds.
const RUN: &str = "duration = \"0.4 s\"\nstop_after_collapse = \"0.01 s\"\n";

/// Pulse under which the stack of [`HEAD`] collapses at high intensity.
const PULSE: &str = "\
[[motion]]
name = \"pulse\"
pulse = { kind = \"one-sine\", amplitude = \"1 g\", period = \"0.8 s\" }
";

fn study(rest: &str) -> Study {
    Study::parse("test.toml", &format!("{HEAD}{RUN}{rest}"))
        .unwrap_or_else(|error| panic!("{error}\n{rest}"))
}

fn run_with(study: &Study, folder: &Path, threads: usize) -> Collected {
    let options = RunOptions { threads: NonZero::new(threads), ..RunOptions::default() };
    study.run(folder, &options, &|_| ControlFlow::Continue(())).unwrap()
}

fn run(study: &Study) -> StudyTable {
    let folder = tempfile::tempdir().unwrap();
    run_with(study, &folder.path().join("out"), 2).table
}

/// Returns the rows of a table as text, without the numbers of case and chunk.
fn rows(table: &StudyTable) -> Vec<String> {
    let values_of = |row: usize| {
        let values =
            table.columns().iter().filter(|c| !["case", "chunk"].contains(&c.spec.name.as_str()));
        format!("{:?}", values.map(|column| column.values.get(row)).collect::<Vec<_>>())
    };
    (0..table.rows()).map(values_of).collect()
}

fn numbers(table: &StudyTable, column: &str) -> Vec<f64> {
    table.numbers(column).unwrap().iter().map(|value| value.unwrap()).collect()
}

const TWO_FACTORS: &str = "\
[[factor]]
name = \"friction\"
field = \"interface.rack-ground.friction.coefficient\"
values = [0.2, 0.4, 0.6]
[[factor]]
field = \"stack.levels\"
values = [2, 1]
";

#[test]
fn a_full_factorial_has_every_combination_once() {
    let study = study(&format!("{PULSE}{TWO_FACTORS}[design]\nkind = \"full-factorial\""));
    assert_eq!(study.cases(), 6);
    let table = run(&study);
    assert_eq!(table.rows(), 6);
    let friction = numbers(&table, "friction");
    let levels = table.integers("stack.levels").unwrap();
    let pairs: BTreeSet<(String, i64)> =
        friction.iter().zip(levels).map(|(f, l)| (f.to_string(), l.unwrap())).collect();
    assert_eq!(pairs.len(), 6);
    // All cases of a chunk have the same bodies.
    let chunks = table.integers("chunk").unwrap();
    for (chunk, level) in chunks.iter().zip(levels) {
        let same = chunks.iter().zip(levels).filter(|(other, _)| *other == chunk);
        assert!(same.into_iter().all(|(_, other)| other == level));
    }
    assert_eq!(table.integers("case").unwrap(), (0..6).map(Some).collect::<Vec<_>>());
    let barrels = table.integers("barrels").unwrap();
    assert!(barrels.iter().zip(levels).all(|(b, l)| b.unwrap() == 2 * l.unwrap()), "two a level");
}

#[test]
fn one_at_a_time_has_the_base_and_each_other_value_once() {
    let drawn = "[[factor]]\nfield = \"interface.barrel-rack.friction.coefficient\"\n\
                 distribution = { kind = \"uniform\", from = 0.2, to = 0.6 }\n";
    let study = study(&format!("{PULSE}{TWO_FACTORS}{drawn}[design]\nkind = \"one-at-a-time\""));
    // The base, the listed frictions other than that of the base (two or three), one other number of levels, and two
    // quantiles.
    let base = 1;
    let table = run(&study);
    let friction = numbers(&table, "friction");
    let others = [0.2, 0.4, 0.6].iter().filter(|value| **value != friction[0]).count();
    assert_eq!(table.rows(), base + others + 1 + 2);
    assert_eq!(table.rows() as u64, study.cases());
    let drawn = numbers(&table, "interface.barrel-rack.friction.coefficient");
    let changed = |row: usize| {
        usize::from(friction[row] != friction[0])
            + usize::from(table.integers("stack.levels").unwrap()[row] != Some(2))
            + usize::from(drawn[row] != drawn[0])
    };
    assert_eq!(changed(0), 0);
    assert!((1..table.rows()).all(|row| changed(row) == 1), "every other row changes one factor");
    // Quantiles 0.1 and 0.9 of the uniform distribution; measured: 3e-17.
    assert!(
        drawn.iter().any(|v| (v - 0.24).abs() < 1e-12)
            && drawn.iter().any(|v| (v - 0.56).abs() < 1e-12)
    );
}

#[test]
fn every_change_meets_the_same_motions_on_the_same_drawn_stacks() {
    let drawn = "[[factor]]\nname = \"drawn\"\nfield = \"interface.barrel-rack.friction.coefficient\"\n\
                 distribution = { kind = \"uniform\", from = 0.2, to = 0.6 }\n";
    let design = "[design]\nkind = \"one-at-a-time\"\ndraws = 3";
    let study = study(&format!("{PULSE}{TWO_FACTORS}{drawn}{design}"));
    let table = run(&study);
    assert_eq!(table.rows() as u64, study.cases());
    let levels = table.integers("stack.levels").unwrap();
    let mut stacks: BTreeMap<String, Vec<u64>> = BTreeMap::new();
    for (row, friction) in numbers(&table, "friction").iter().enumerate() {
        let change = format!("{friction} {:?}", levels[row]);
        stacks.entry(change).or_default().push(numbers(&table, "drawn")[row].to_bits());
    }
    let base = &stacks.values().next().unwrap();
    assert!(stacks.len() > 2 && stacks.values().all(|own| own == *base), "{stacks:?}");
    assert_eq!(base.iter().collect::<BTreeSet<_>>().len(), 3, "each stack is another one");
    let alone = format!("{HEAD}{RUN}{PULSE}{drawn}{design}");
    let error = Study::parse("test.toml", &alone).unwrap_err().to_string();
    assert!(error.contains("every factor is drawn"), "{error}");
}

/// A study of one drawn factor and a drawn level that needs no motion file.
fn sampled(design: &str) -> Study {
    study(&format!(
        "{PULSE}[[factor]]\nname = \"f\"\nfield = \"interface.rack-ground.friction.coefficient\"\n\
         distribution = {{ kind = \"uniform\", from = 0.0, to = 1.0 }}\n\
         [intensity]\ndistribution = {{ kind = \"log-uniform\", from = \"1 cm/s\", to = \"2 m/s\" }}\n\
         [design]\n{design}"
    ))
}

#[test]
fn a_latin_hypercube_has_one_sample_in_each_stratum_of_each_axis() {
    let table = run(&sampled("kind = \"latin-hypercube\"\ncount = 20"));
    let strata = |shares: Vec<f64>| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 20")]
        let cells: BTreeSet<usize> =
            shares.into_iter().map(|share| (20.0 * share) as usize).collect();
        cells.len()
    };
    assert_eq!(strata(numbers(&table, "f")), 20);
    let share = |level: f64| (level / 0.01).ln() / 200_f64.ln();
    assert_eq!(strata(numbers(&table, "level").into_iter().map(share).collect()), 20);
}

#[test]
fn points_of_sobol_fill_every_cell_and_more_of_them_keep_the_earlier_rows() {
    let few = run(&sampled("kind = \"sobol\"\ncount = 16\nchunk = 8"));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 4")]
    let cell = |(f, level): (f64, f64)| {
        ((4.0 * f) as usize, (4.0 * (level / 0.01).ln() / 200_f64.ln()) as usize)
    };
    let pairs = numbers(&few, "f").into_iter().zip(numbers(&few, "level"));
    // The axes of the level and of the first factor are a (0, 2)-sequence: of 16 points, one lies in each of 4 by 4
    // cells.
    assert_eq!(pairs.map(cell).collect::<BTreeSet<_>>().len(), 16);
    let more = run(&sampled("kind = \"sobol\"\ncount = 24\nchunk = 8"));
    assert_eq!(rows(&more)[..16], rows(&few)[..]);
    let chunk = |table: &StudyTable| table.integers("chunk").unwrap()[..16].to_vec();
    assert_eq!(chunk(&more), chunk(&few));
}

#[test]
fn the_requested_intensity_is_what_shakes() {
    let table = run(&sampled("kind = \"sobol\"\ncount = 4"));
    for (level, pgv) in numbers(&table, "level").into_iter().zip(numbers(&table, "pgv")) {
        // Measured: 2e-16.
        assert!((level / pgv - 1.0).abs() < 1e-12, "{level} {pgv}");
    }
    assert!(table.column("level").is_some_and(|column| column.spec.unit == "m/s"));
    assert_eq!(table.of_role(Role::Factor).count(), 1);
}

const STRIPES: &str = "\
[intensity]
levels = [\"20 cm/s\", \"1.5 m/s\"]
[design]
kind = \"stripes\"
chunk = 2
";

#[test]
fn more_motions_and_more_levels_change_no_earlier_row() {
    let made = |count: usize| {
        format!(
            "[[motion]]\nsynthetic = {{ kind = \"clough-penzien\", duration = \"1 s\", rise = \"0.1 s\", \
             decay_start = \"0.5 s\", count = {count} }}\n"
        )
    };
    let drawn = "[[factor]]\nfield = \"interface.rack-ground.friction.coefficient\"\n\
                 distribution = { kind = \"normal\", mean = 0.4, deviation = 0.1, least = 0.2 }\n";
    let few = run(&study(&format!("{drawn}{}{STRIPES}", made(2))));
    let more = run(&study(&format!("{drawn}{}{PULSE}{STRIPES}", made(2))));
    assert_eq!((few.rows(), more.rows()), (4, 6));
    assert_eq!(rows(&more)[..4], rows(&few)[..]);
    let realizations = run(&study(&format!("{drawn}{}{STRIPES}", made(3))));
    assert_eq!(rows(&realizations)[..4], rows(&few)[..]);
    let levels = STRIPES.replace("\"1.5 m/s\"", "\"1.5 m/s\", \"40 cm/s\"");
    let levels = rows(&run(&study(&format!("{drawn}{}{levels}", made(2)))));
    assert!(
        rows(&few).iter().all(|row| levels.contains(row)),
        "a level more keeps the rows of the others"
    );
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let study = study(&format!("{PULSE}{TWO_FACTORS}{STRIPES}"));
    let bytes = |threads| {
        let folder = tempfile::tempdir().unwrap();
        run_with(&study, folder.path(), threads);
        ["table.csv", "table.parquet", "provenance.json"]
            .map(|name| std::fs::read(folder.path().join(name)).unwrap())
    };
    let one = bytes(1);
    assert!(one == bytes(2) && one == bytes(8));
}

#[test]
fn a_table_reads_back_from_parquet_as_it_was() {
    let table = run(&study(&format!("{PULSE}{TWO_FACTORS}{STRIPES}")));
    let bytes = table.to_parquet().unwrap();
    assert_eq!(bytes, table.to_parquet().unwrap());
    assert_eq!(StudyTable::from_parquet(bytes).unwrap(), table);
    let csv = table.to_csv();
    assert_eq!(csv.lines().count(), 1 + table.rows());
    assert!(csv.starts_with("case,id,chunk,friction,stack.levels,record,level (m/s),"), "{csv}");
}

#[test]
fn monte_carlo_stops_after_the_first_chunk_that_is_enough_whatever_the_threads() {
    let design = "kind = \"monte-carlo\"\nhalf_width = 0.2\nleast = 8\nmost = 400\nchunk = 4";
    let study = sampled(design);
    let tables: Vec<Collected> = [1, 2, 8]
        .map(|threads| {
            let folder = tempfile::tempdir().unwrap();
            run_with(&study, folder.path(), threads)
        })
        .into();
    assert_eq!(tables[0], tables[1]);
    assert_eq!(tables[0], tables[2]);
    let table = &tables[0].table;
    assert!(
        tables[0].provenance.complete && table.rows() < 400 && table.rows() >= 8,
        "{}",
        table.rows()
    );
    let (_, [low, high]) = Tally::of(table).collapse().unwrap();
    assert!(high - low <= 0.4, "{low} {high}");
    // The stopping rule is not satisfied without the last chunk.
    let mut before = Tally::default();
    let outcomes = table.texts("outcome").unwrap();
    outcomes[..table.rows() - 4].iter().for_each(|outcome| before.add(outcome.as_deref().unwrap()));
    let narrow = before.collapse().is_some_and(|(_, [low, high])| high - low <= 0.4);
    assert!(before.cases < 8 || !narrow);
}

#[test]
fn a_hunt_brackets_the_collapse_of_each_motion() {
    let study = study(&format!(
        "{PULSE}[intensity]\nmeasure = \"pgv\"\n[design]\nkind = \"ida\"\nfirst = \"20 cm/s\"\nstep = \"30 cm/s\"\n\
         runs = 10\nresolution = 0.2"
    ));
    let table = run(&study);
    let levels = numbers(&table, "level");
    let fell: Vec<bool> =
        table.texts("outcome").unwrap().iter().map(|o| o.as_deref() == Some("collapse")).collect();
    let of = |wanted: bool| {
        levels.iter().zip(&fell).filter(move |(_, fell)| **fell == wanted).map(|(l, _)| *l)
    };
    let lowest = of(true).fold(f64::INFINITY, f64::min);
    let below = of(false).filter(|level| *level < lowest).fold(0.0, f64::max);
    assert!(lowest.is_finite() && below > 0.0, "{levels:?} {fell:?}");
    assert!(lowest - below <= 0.2 * below, "{below} to {lowest}");
    assert_eq!(table.rows(), 10);
}

#[test]
fn a_case_that_cannot_run_is_a_row_with_its_reason() {
    // With this step the stiffest contact cannot be resolved; the other value is small enough.
    let study = study(&format!(
        "{PULSE}[[factor]]\nfield = \"run.step\"\nvalues = [\"20 us\", \"0.1 s\"]\n[design]\nkind = \"full-factorial\""
    ));
    let table = run(&study);
    assert_eq!(table.rows(), 2);
    let outcomes = table.texts("outcome").unwrap();
    assert_eq!(outcomes[1].as_deref(), Some("error"));
    let reason = table.texts("error").unwrap()[1].clone().unwrap();
    assert!(reason.contains("run.step = 100 ms is too long"), "{reason}");
    assert!(outcomes[0].as_deref() != Some("error") && table.texts("error").unwrap()[0].is_none());
    let Some(Value::Integer(cases)) = table.column("case").unwrap().values.get(1) else { panic!() };
    assert_eq!(cases, 1);
}

#[test]
fn a_damaged_shard_is_named_when_read_and_made_again_when_run() {
    let study = study(&format!("{PULSE}{TWO_FACTORS}{STRIPES}"));
    let folder = tempfile::tempdir().unwrap();
    let whole = run_with(&study, folder.path(), 2);
    let shards = folder.path().join("shards");
    let mut names: Vec<_> =
        std::fs::read_dir(&shards).unwrap().map(|e| e.unwrap().path()).collect();
    names.sort();
    let good = std::fs::read(&names[1]).unwrap();
    let mut flipped = good.clone();
    flipped[good.len() / 2] ^= 1;
    for damage in &[&good[..good.len() / 2], &flipped, &[]] {
        std::fs::write(&names[1], damage).unwrap();
        let error = Collected::read(folder.path()).unwrap_err();
        assert!(matches!(&error, StudyError::Shard { path, .. } if *path == names[1]), "{error}");
        // Files left by killed runs are removed; files with similar names stay.
        let left =
            [".000001-0.parquet.00000000000000a1.part", "000001.claim", "mine.part", "mine.claim"];
        let left = left.map(|name| shards.join(name));
        for path in &left {
            std::fs::write(path, "half").unwrap();
        }
        assert_eq!(run_with(&study, folder.path(), 1), whole);
        assert_eq!(left.map(|path| std::fs::remove_file(path).is_ok()), [false, false, true, true]);
        assert_eq!(std::fs::read(&names[1]).unwrap(), good);
        assert_eq!(std::fs::read(names[1].with_extension("damaged")).unwrap(), **damage);
        assert_eq!(
            std::fs::read_dir(&shards).unwrap().count(),
            names.len() + 1,
            "nothing else is left"
        );
    }
}

#[test]
fn a_folder_of_another_study_is_refused_and_left_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let text = format!("{PULSE}{TWO_FACTORS}{STRIPES}");
    run_with(&study(&text), folder.path(), 2);
    let before = std::fs::read(folder.path().join("study.json")).unwrap();
    let other = study(&text.replace("0.6]", "0.7]"));
    let error = other
        .run(folder.path(), &RunOptions::default(), &|_| ControlFlow::Continue(()))
        .unwrap_err();
    let message = error.to_string();
    assert!(message.contains("belongs to another study: a [[factor]] has changed"), "{message}");
    let message = Study::parse(
        "test.toml",
        &format!("{HEAD}{RUN}{text}").replacen("seed = 7", "seed = 8", 1),
    )
    .unwrap()
    .run(folder.path(), &RunOptions::default(), &|_| ControlFlow::Continue(()))
    .unwrap_err()
    .to_string();
    assert!(message.contains("its seed is 7, and the seed of this study is 8"), "{message}");
    assert_eq!(std::fs::read(folder.path().join("study.json")).unwrap(), before);

    // An earlier version had another layout, without a fingerprint.
    let text = String::from_utf8(before).unwrap().replacen("\"schema\": 3", "\"schema\": 2", 1);
    let earlier = format!("{}\n}}\n", text.split_once(",\n  \"fingerprint\"").unwrap().0);
    std::fs::write(folder.path().join("study.json"), earlier).unwrap();
    let error = Collected::read(folder.path()).unwrap_err().to_string();
    assert!(
        error.contains("in layout 2 of study folders, but this version reads layout 3"),
        "{error}"
    );

    // Shards without a manifest.
    std::fs::remove_file(folder.path().join("study.json")).unwrap();
    std::fs::remove_file(folder.path().join("study.toml")).unwrap();
    for name in ["table.csv", "table.parquet", "columns.csv", "provenance.json"] {
        std::fs::remove_file(folder.path().join(name)).unwrap();
    }
    let error = other
        .run(folder.path(), &RunOptions::default(), &|_| ControlFlow::Continue(()))
        .unwrap_err();
    assert!(error.to_string().contains("holds 000000-"), "{error}");

    let foreign = tempfile::tempdir().unwrap();
    std::fs::write(foreign.path().join("thesis.docx"), "x").unwrap();
    let error = other
        .run(foreign.path(), &RunOptions::default(), &|_| ControlFlow::Continue(()))
        .unwrap_err();
    assert!(error.to_string().contains("holds thesis.docx and is not a study folder"), "{error}");
    let error = Collected::read(foreign.path()).unwrap_err();
    assert!(error.to_string().contains("is not a study folder: it has no study.json"), "{error}");
    let error = Collected::read(&foreign.path().join("nowhere")).unwrap_err();
    assert!(error.to_string().contains("does not exist"), "{error}");
    let error = other.run(&foreign.path().join("thesis.docx"), &RunOptions::default(), &|_| {
        ControlFlow::Continue(())
    });
    assert!(error.unwrap_err().to_string().contains("is a file, not a folder"));
}

#[test]
fn a_changed_record_is_another_study() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("site.csv");
    let samples = |peak: f64| {
        let lines: Vec<String> = (0..200)
            .map(|i| format!("{:.2},{:.6}", 0.01 * f64::from(i), peak * (0.3 * f64::from(i)).sin()))
            .collect();
        format!("time (s),acceleration (g)\n{}\n", lines.join("\n"))
    };
    std::fs::write(&record, samples(0.2)).unwrap();
    let file = folder.path().join("study.toml");
    let text = format!("{HEAD}{RUN}[[motion]]\nfolder = \".\"\npattern = \"*.csv\"\n{STRIPES}");
    std::fs::write(&file, text).unwrap();
    let first = Study::load(&file).unwrap();
    let out = folder.path().join("out");
    run_with(&first, &out, 1);
    assert_eq!(first.hash(), Study::load(&file).unwrap().hash());

    // A folder that was moved is still valid, and nothing is run again.
    let moved = folder.path().join("moved");
    std::fs::create_dir(&moved).unwrap();
    std::fs::copy(&record, moved.join("site.csv")).unwrap();
    std::fs::copy(&file, moved.join("study.toml")).unwrap();
    let done = std::sync::Mutex::new(Progress::default());
    let report = |progress: &Progress| {
        *done.lock().unwrap() = *progress;
        ControlFlow::Continue(())
    };
    Study::load(&moved.join("study.toml"))
        .unwrap()
        .run(&out, &RunOptions::default(), &report)
        .unwrap();
    let Progress { before, now, .. } = *done.lock().unwrap();
    assert!(before > 0 && now == 0, "{now} cases run again");

    std::fs::write(&record, samples(0.3)).unwrap();
    let second = Study::load(&file).unwrap();
    assert_ne!(first.hash(), second.hash());
    let error =
        second.run(&out, &RunOptions::default(), &|_| ControlFlow::Continue(())).unwrap_err();
    assert!(error.to_string().contains("the record \"site\" has changed"), "{error}");
}

#[test]
fn every_ensemble_is_tried_before_the_work_and_described_in_words() {
    let made = |rise: &str| {
        format!(
            "[[motion]]\nname = \"rise {rise}\"\nsynthetic = {{ kind = \"clough-penzien\", duration = \"1 s\", \
             rise = \"{rise}\", decay_start = \"0.5 s\", count = 2 }}\n"
        )
    };
    let good = study(&format!("{}{STRIPES}", made("0.1 s")));
    let motions = good.provenance().unwrap().motions;
    let source = &motions[1].source;
    assert!(
        source.starts_with("Clough-Penzien noise: 0.980665 m/s2 rms, ")
            && source.contains(", seed "),
        "{source}"
    );
    assert_ne!(motions[0].source, *source);
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let error = study(&format!("{}{}{STRIPES}", made("0.1 s"), made("0.9 s")))
        .run(&out, &RunOptions::default(), &|_| ControlFlow::Continue(()))
        .unwrap_err();
    assert!(error.to_string().contains("the motion \"rise 0.9 s 1\": "), "{error}");
    assert!(!out.exists());
}

#[test]
fn a_stopped_study_goes_on_where_it_was() {
    let study = study(&format!("{PULSE}{TWO_FACTORS}{STRIPES}"));
    let folder = tempfile::tempdir().unwrap();
    let whole = run_with(&study, folder.path(), 2);
    let again = tempfile::tempdir().unwrap();
    let stop = |progress: &Progress| {
        if progress.now >= 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let options = RunOptions { threads: NonZero::new(1), ..RunOptions::default() };
    let error = study.run(again.path(), &options, &stop).unwrap_err();
    assert!(matches!(error, StudyError::Stopped));
    let status = Collected::status(again.path()).unwrap();
    assert_eq!((status.provenance.chunks_done, status.provenance.cases), (2, 4));
    assert!(!status.provenance.complete && !status.missing.contains(&0));
    let chunk =
        || study.run_chunk(again.path(), status.missing[0], Width::widest(), &|| false).unwrap();
    assert_eq!([chunk(), chunk()], [ChunkRun::Now, ChunkRun::Before]);
    assert_eq!(run_with(&study, again.path(), 2), whole);
}

#[test]
fn built_in_studies_are_read_and_their_chunks_hold_all_cases() {
    for name in barrelstack_campaign::study::builtin_names() {
        let study = Study::built_in(name).unwrap();
        let cases: usize = study.plan().map(|chunk| chunk.cases).sum();
        assert_eq!(cases as u64, study.cases(), "{name}");
    }
}

#[test]
fn a_study_says_its_stacks_and_the_direction_without_what_a_factor_varies() {
    let said = |name: &str| Study::built_in(name).unwrap().provenance().unwrap().stacks;
    for (name, stacks) in [
        ("napa-four-levels", "stacks of 4 levels on candia-2008 racks, shaken across the barrels"),
        ("demo-racks", "stacks of 5 levels, shaken along the barrels"),
        ("demo-space", "stacks of 5 levels on two-barrel racks, shaken in all directions"),
    ] {
        assert_eq!(said(name).as_deref(), Some(stacks), "{name}");
    }
    for (field, values, stacks) in [
        ("stack.levels", "[1, 2]", "stacks on two-barrel racks, shaken across the barrels"),
        // A factor may state a rack by its name alone, or vary one of its dimensions.
        (
            "stack.rack",
            "[\"two-barrel\", \"single-bar\"]",
            "stacks of 2 levels, shaken across the barrels",
        ),
        (
            "stack.rack.pitch",
            "[\"0.70 m\", \"0.71 m\"]",
            "stacks of 2 levels, shaken across the barrels",
        ),
    ] {
        let varied = study(&format!(
            "[[factor]]\nname = \"varied\"\nfield = \"{field}\"\nvalues = {values}\n{PULSE}[design]\nkind = \"full-factorial\"\n"
        ));
        assert_eq!(varied.provenance().unwrap().stacks.as_deref(), Some(stacks), "{field}");
    }
    let text = format!("{HEAD}{RUN}{PULSE}[design]\nkind = \"full-factorial\"\n");
    let one = Study::parse("one.toml", &text.replace("levels = 2", "levels = 1")).unwrap();
    let stacks = one.provenance().unwrap().stacks;
    assert_eq!(
        stacks.as_deref(),
        Some("stacks of 1 level on two-barrel racks, shaken across the barrels")
    );
}
