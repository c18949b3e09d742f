//! Sequences of shocks, and rooms that start from stated places.

use std::ops::ControlFlow;

use barrelstack::variants::RunChoice;
use barrelstack_cellar::kept::Part;
use barrelstack_cellar::summary::ShockAnswer;
use barrelstack_cellar::{
    Advance, Answer, Cellar, CellarFailure, Prepared, RoomRun, Settings, aftershocks, answer,
    answer_with, run as run_room, run_part, sequence, words,
};
use barrelstack_report::{Language, Tone};

use crate::common::bits;

/// Two stacks of two levels, followed for a short time.
const SMALL: &str =
    "schema = 1\nextends = \"demo-cellar\"\n[stack]\nlevels = 2\n[run]\nduration = \"6 s\"\n";

/// The record of Napa College, stronger than measured, and then weaker.
const TWICE: &str = "[[motion.sequence]]\nbundled = \"napa-college-2014\"\ncomponent = \"horizontal-1\"\nvertical = \"UP\"\n\
                     scale = { factor = 2.5 }\n[[motion.sequence]]\nbundled = \"napa-college-2014\"\nscale = { factor = -1.0 }\n";

fn cellar(text: &str, changes: &[&str]) -> Cellar {
    read(text, changes).unwrap()
}

fn read(text: &str, changes: &[&str]) -> Result<Cellar, barrelstack::scenario::ScenarioError> {
    let mut all = vec!["block.1.rows=1".to_owned(), "imperfections.variants=2".to_owned()];
    all.extend(changes.iter().map(|&change| change.to_owned()));
    Cellar::parse("mine.toml", format!("{SMALL}{text}").as_bytes(), &all)
}

fn answered(cellar: &Cellar, choice: RunChoice) -> Result<Answer, CellarFailure> {
    answer(cellar, choice, &mut |_| ControlFlow::Continue(()))
}

fn refused(text: &str, words: &[&str]) {
    let said = read(text, &[]).unwrap_err().sentence();
    assert!(words.iter().all(|word| said.contains(word)), "{text}: {said}");
}

#[test]
fn every_shock_counts_once_and_the_whole_is_the_sum_of_its_shocks() {
    let answer = answered(&cellar(TWICE, &[]), RunChoice::Typical).unwrap();
    let summary = &answer.summary;
    let [first, second] = &summary.shocks[..] else { panic!("{:?}", summary.shocks) };
    assert_eq!(first.stood, 2.0);
    assert!((second.stood - (2.0 - first.by_themselves - first.knocked_over)).abs() < 1e-12);
    // A variant in which no stack stands before a shock does not count as one in which all survive it.
    for shock in [first, second] {
        let expected = f64::from(shock.all_survive.of_variants) / f64::from(shock.stood_in);
        assert!(shock.stood_in <= summary.counted);
        assert_eq!(shock.all_survive.share, (shock.stood_in > 0).then_some(expected));
    }
    let own = first.by_themselves + second.by_themselves;
    let knocked = first.knocked_over + second.knocked_over;
    assert_eq!((summary.room.by_themselves, summary.room.knocked_over), (own, knocked));
    // The runs end before the record does, so the room does not rest, and the answer says so.
    assert_eq!(first.still_moving.of_variants, 2);
    let said = words::sentences(summary).join(" ");
    assert!(
        said.contains("Shock 2 (") && said.contains("still moves when the shock ends"),
        "{said}"
    );
    assert!(summary.headline.contains("in the first shock"), "{}", summary.headline);
    assert!(summary.headline.contains("; in the second "), "{}", summary.headline);
    assert!(summary.headline.contains("the run of a shock ends"), "{}", summary.headline);
    assert_ne!(words::tone(summary), Tone::Stands);
    let files = answer.files(Language::English).unwrap();
    let (_, csv) = files.iter().find(|(name, _)| name == "shocks.csv").unwrap();
    assert_eq!(String::from_utf8_lossy(csv).lines().count(), 1 + 2 * 2);
    // The clock of the joined run continues from shock to shock.
    let run = &answer.shown;
    let ends: f64 = run.shocks.iter().map(|shock| shock.end_time).sum();
    assert_eq!((run.shocks.len(), run.end_time), (2, ends));
    for frames in &run.frames {
        assert!(frames.times.is_sorted());
        assert_eq!(frames.times.len(), frames.poses.len());
    }
    // Bodies start the second shock where the first has left them, and end it where the joined run ends.
    for (at, body) in run.bodies.iter().enumerate() {
        let [one, two] = [&run.shocks[0].bodies[at], &run.shocks[1].bodies[at]];
        assert_eq!((one.to, two.to, one.from), (two.start, body.to, body.from));
    }
}

#[test]
fn one_shock_in_a_sequence_has_the_bits_of_the_shock() {
    let one = "[[motion.sequence]]\nbundled = \"napa-college-2014\"\ncomponent = \"horizontal-1\"\nvertical = \"UP\"\n";
    let [alone, listed] = ["", one].map(|text| cellar(text, &["run.duration=2 s"]));
    assert_eq!(alone.fingerprint(), listed.fingerprint());
    let [alone, listed] =
        [alone, listed].map(|cellar| answered(&cellar, RunChoice::Alone(1)).unwrap());
    assert_eq!(bits(&alone.shown), bits(&listed.shown));
    assert!(listed.summary.shocks.is_empty() && listed.shown.shocks.is_empty());
    assert_eq!(alone.summary.headline, listed.summary.headline);
}

#[test]
fn a_sequence_is_read_written_and_refused_at_its_place() {
    let stated = cellar(TWICE, &["motion.sequence.2.scale.factor=0.5"]);
    assert_eq!(stated.later.len(), 1);
    let again = Cellar::parse("again.toml", stated.to_resolved_toml().as_bytes(), &[]).unwrap();
    assert_eq!(again.fingerprint(), stated.fingerprint());
    assert_eq!(
        (again.later.clone(), again.stated().motion.clone()),
        (stated.later.clone(), stated.stated().motion.clone())
    );
    assert_ne!(stated.fingerprint(), cellar(TWICE, &[]).fingerprint());
    // A record in place of the motion replaces the whole sequence, as it replaces a motion.
    assert!(cellar(TWICE, &["motion.record=site.AT2"]).later.is_empty());
    let shock = "[[motion.sequence]]\nbundled = \"napa-college-2014\"\n";
    refused(
        "[motion]\nsequence = []\n",
        &["mine.toml:8:", "at least one shock", "[[motion.sequence]]"],
    );
    refused(&shock.repeat(1000), &["mine.toml:", "1000 shocks", "at most 20"]);
    refused(
        &format!("[motion]\nbundled = \"napa-college-2014\"\n{shock}"),
        &["mine.toml:", "`sequence`", "bundled"],
    );
    refused(&format!("{shock}factor = 2\n"), &["mine.toml:9:", "factor"]);
    refused("[[motion.sequence]]\n", &["[motion.sequence.1]", "record"]);
    refused("[motion]\nsequence = \"twice\"\n", &["mine.toml:8:", "sequence"]);
    refused(
        &format!("{shock}[motion.sequence.scale]\npga = \"-1 g\"\n"),
        &["mine.toml:10:", "pga"],
    );
    // A stack alone has one shock.
    let alone = format!("schema = 1\nextends = \"demo-napa\"\n{shock}");
    let said = barrelstack::Scenario::parse("alone.toml", &alone, &[]).unwrap_err().sentence();
    assert!(said.contains("alone.toml:3:") && said.contains("kind = \"cellar\""), "{said}");
}

#[test]
fn an_aftershock_follows_the_own_motion() {
    let own = cellar("", &["motion.scale.pga=0.4 g"]).with_aftershock(0.5, None).unwrap();
    assert_eq!(own.later.len(), 1);
    assert_eq!(own.later[0].source, own.stated().motion.source);
    let said = cellar(TWICE, &[]).with_aftershock(0.5, None).unwrap_err().sentence();
    assert!(said.contains("already a sequence"), "{said}");
    let said = cellar("", &["motion.scale.measure=cav", "motion.scale.value=3 m/s"]);
    let said = said.with_aftershock(0.5, None).unwrap_err().sentence();
    assert!(said.contains("`measure`"), "{said}");
}

/// Returns the largest horizontal distance (m) of a body of a stack at the start of a run from its place as built.
fn started(run: &RoomRun, stack: usize) -> f64 {
    let bodies = &run.bodies[run.stacks[stack].bodies.clone()];
    let apart = |axis: usize, one: &barrelstack_cellar::BodyEnd| one.start[axis] - one.from[axis];
    bodies.iter().map(|one| apart(0, one).hypot(apart(1, one))).fold(0.0, f64::max)
}

#[test]
fn a_surveyed_room_starts_from_its_displacements() {
    let quick = ["run.duration=0.5 s"];
    let walked = "[[start.shift]]\nstack = \"1-2\"\nby = [\"3 cm\", \"-4 cm\", \"0 m\"]\n";
    let run = answered(&cellar(walked, &quick), RunChoice::Alone(0)).unwrap().shown;
    // measured 0.05 to the last digits
    assert!((started(&run, 1) - 0.05).abs() < 1e-12 && started(&run, 0) == 0.0);
    assert!(!run.stacks[1].was_down());
    let turned = "[[start.shift]]\nstack = \"1-1\"\nturn = \"1 deg\"\n";
    let run = answered(&cellar(turned, &quick), RunChoice::Alone(0)).unwrap().shown;
    assert!(started(&run, 0) > 5e-3 && started(&run, 0) < 0.03, "{}", started(&run, 0));
    // A barrel that is pushed into its neighbor, and a stack into the other.
    let places = |text: &str| match answered(&cellar(text, &quick), RunChoice::Alone(0)) {
        Err(CellarFailure::Plan(error)) => error.sentence(),
        other => panic!("{text}: {:?}", other.map(|answer| answer.summary.headline)),
    };
    let pushed =
        "[[start.shift]]\nstack = \"1-1\"\nbody = \"B1.1\"\nby = [\"6 cm\", \"0 m\", \"0 m\"]\n";
    let said = places(pushed);
    assert!(
        said.contains("mine.toml:7:") && said.contains("1-1 B1.1") && said.contains("overlap"),
        "{said}"
    );
    let into = "[[start.shift]]\nstack = \"1-2\"\nby = [\"-32 cm\", \"0 m\", \"0 m\"]\n";
    let said = places(into);
    assert!(
        said.contains("mine.toml:7:") && said.contains("1-1 ") && said.contains("1-2 "),
        "{said}"
    );
    // The check finds the same without a run.
    let prepared = Prepared::new(&cellar(into, &quick)).unwrap();
    match prepared.check_start() {
        Err(CellarFailure::Plan(error)) => assert_eq!(error.sentence(), said),
        other => panic!("{other:?}"),
    }
    assert!(prepared.plan.summary.sentences().concat().contains("start from the places"));
    for (text, place, words) in [
        ("[[start.shift]]\nstack = \"3-1\"\n", "mine.toml:8:", "there is no stack \"3-1\""),
        (
            "[[start.shift]]\nstack = \"1-1\"\nbody = \"B9.1\"\n",
            "mine.toml:9:",
            "has no body \"B9.1\"",
        ),
        ("[start]\nfile = \"nowhere.csv\"\n", "mine.toml:8:", "nowhere.csv"),
    ] {
        let said = places(text);
        assert!(said.contains(place) && said.contains(words), "{said}");
    }
    refused(
        &"[[start.shift]]\nstack = \"1-1\"\n".repeat(1001),
        &["1001 tables of shifts", "to a file"],
    );
}

#[test]
fn bodies_that_an_earlier_run_left_pressed_together_go_on() {
    let prepared = Prepared::new(&cellar("", &["run.duration=0.5 s"])).unwrap();
    let first = prepared.run(0, 1, &mut |_| ControlFlow::Continue(())).unwrap();
    let mut pressed = first.clone();
    // A barrel is pressed 3 cm into its neighbor, as a heavy heap may do.
    let two: Vec<usize> = (0..pressed.bodies.len())
        .filter(|at| ["B1.1", "B1.2"].contains(&pressed.bodies[*at].name.as_str()))
        .filter(|at| pressed.bodies[*at].stack == 0)
        .collect();
    let apart = pressed.bodies[two[1]].own[0] - pressed.bodies[two[0]].own[0];
    let toward = 0.06_f64.copysign(apart);
    pressed.bodies[two[0]].own[0] += toward;
    let room = || prepared.room(0).unwrap();
    let settings = Settings { threads: 1, frames: false };
    let from = |run: &RoomRun, carried: bool| {
        let mut room = sequence::after(room(), run);
        room.stacks.iter_mut().for_each(|placed| placed.carried_on = carried);
        run_room(&room, &settings, &mut |_| ControlFlow::Continue(()))
    };
    let refused = from(&pressed, false).unwrap_err().to_string();
    assert!(refused.contains("overlap"), "{refused}");
    assert!(from(&pressed, true).is_ok() && from(&first, true).is_ok());
}

#[test]
fn aftershocks_of_several_strengths_follow_one_main_shock() {
    let stated = cellar("", &["motion.scale.factor=2.5"]);
    let found =
        aftershocks::aftershocks(&stated, &[0.5, 1.0], None, &mut |_| ControlFlow::Continue(()))
            .unwrap();
    assert_eq!((found.counted, found.stacks, found.aftershocks.len()), (2, 2, 2));
    // The answer for each strength is that of the sequence with this aftershock.
    for one in &found.aftershocks {
        let sequence = stated.clone().with_aftershock(one.factor, None).unwrap();
        let alone = answered(&sequence, RunChoice::Typical).unwrap().summary;
        let [main, after] = [&alone.shocks[0], &alone.shocks[1]];
        let numbers = |shock: &ShockAnswer| {
            (
                shock.stood,
                shock.stood_in,
                shock.by_themselves,
                shock.knocked_over,
                shock.share_survive,
            )
        };
        assert_eq!(numbers(&one.shock), numbers(after));
        assert_eq!(numbers(found.main.as_ref().unwrap()), numbers(main));
        let fell: u32 = found
            .inspection
            .iter()
            .map(|margin| margin.falls[usize::from(one.factor > 0.5)].of_variants)
            .sum();
        assert_eq!(f64::from(fell) / 2.0, after.by_themselves + after.knocked_over);
    }
    let said = &found.headline;
    assert!(
        said.starts_with("Of 2 stacks, ") && said.contains("The run of a shock ends"),
        "{said}"
    );
    let files = aftershocks::files(&found, Language::English).unwrap();
    // A row for each stack that stands after the main shock, in each strength; one number in each cell.
    let csv = |at: usize| String::from_utf8_lossy(&files[at].1).into_owned();
    assert_eq!(csv(2).lines().count(), 1 + 2);
    assert_eq!(csv(3).lines().count(), 1 + 2 * found.inspection.len());
    let row = csv(2).lines().nth(1).unwrap().to_owned();
    assert!(row.split(',').all(|cell| cell.is_empty() || cell.parse::<f64>().is_ok()), "{row}");
    let none = aftershocks::aftershocks(&stated, &[], None, &mut |_| ControlFlow::Continue(()));
    assert!(none.unwrap_err().to_string().contains("at least one strength"));
    let json = csv(1);
    assert!(json.contains("\"schema\": \"aftershocks/1\""), "{json}");
    let stopped =
        aftershocks::aftershocks(&stated, &[0.5, 1.0], None, &mut |_| ControlFlow::Break(()));
    let stopped = stopped.unwrap();
    assert!(stopped.headline.contains("there is no verdict"), "{}", stopped.headline);
    assert!(stopped.main.is_none() && stopped.inspection.is_empty());
}

/// Variants in a folder: parts of two machines, work that was stopped, and files of another cellar.
#[test]
fn variants_that_are_kept_are_gathered_and_not_run_again() {
    let folder = tempfile::tempdir().unwrap();
    let keep = folder.path().join("kept");
    let stated = cellar("", &["run.duration=2 s"]);
    let on = &mut |_| ControlFlow::Continue(());
    let whole = answered(&stated, RunChoice::Typical).unwrap();
    let parts = [1, 2].map(|part| run_part(&stated, Part { part, of: 2 }, &keep, on).unwrap());
    assert_eq!(parts, [[2, 0, 2], [1, 0, 1]]);
    // A file that is there is read: a time that was changed in it is in the answer.
    let gathered = answer_with(&stated, RunChoice::Typical, Some(&keep), on).unwrap();
    assert_eq!(gathered.cases, whole.cases);
    assert_eq!(gathered.summary.headline, whole.summary.headline);
    let one = keep.join("variant-0001.json");
    let text = std::fs::read_to_string(&one).unwrap();
    let end_time = whole.cases[1].end_time;
    std::fs::write(&one, text.replace(&format!("\"end_time\":{end_time:?}"), "\"end_time\":1.25"))
        .unwrap();
    let changed = answer_with(&stated, RunChoice::Typical, Some(&keep), on).unwrap();
    assert_eq!(changed.cases[1].end_time, 1.25);
    let other = cellar("", &["run.duration=1 s"]);
    let refused = answer_with(&other, RunChoice::Typical, Some(&keep), on).unwrap_err().to_string();
    assert!(
        refused.contains("variant-0000.json: it belongs to a cellar with the hash "),
        "{refused}"
    );
    assert!(refused.contains("another folder"), "{refused}");
    // The draws of the constants depend on the number of variants.
    let more = stated.clone().with_variants(3);
    let refused = answer_with(&more, RunChoice::Typical, Some(&keep), on).unwrap_err().to_string();
    assert!(refused.contains("the number of variants differ"), "{refused}");
    std::fs::write(&one, "{}").unwrap();
    let broken = answer_with(&stated, RunChoice::Typical, Some(&keep), on).unwrap_err().to_string();
    assert!(broken.contains("is not the result of a variant"), "{broken}");
}

/// Two stacks of which one is moved until its racks press into those of the other, as after a collapse, on ground at
/// rest: the energy that the contacts store at the start is in the balance.
#[test]
fn contacts_that_press_from_the_start_are_in_the_energy_balance() {
    let still = cellar("[motion]\nnone = true\n", &["run.duration=0.3 s", "run.step=0.1 ms"]);
    let prepared = Prepared::new(&still).unwrap();
    let settings = Settings { threads: 1, frames: false };
    let on = &mut |_: &Advance| ControlFlow::Continue(());
    let first = prepared.run(0, 1, on).unwrap();
    let mut room = sequence::after(prepared.room(0).unwrap(), &first);
    // 2 mm deep.
    room.stacks[1].at[0] -= 0.302;
    let energy = run_room(&room, &settings, on).unwrap().energy.unwrap();
    // Measured 1.9e-3, and 1.2e-4 with a fifth of the step: the residual is due to the time step. Without the forces
    // between the stacks in the first step, it is 5.7e-3.
    assert!(energy.residual_ratio() < 3e-3, "{energy:?}");
}
