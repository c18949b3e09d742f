//! RockScore: the smallest velocity of all states and directions, equal after an interruption, refused without a rack.

use barrelstack_report::html;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use barrelstack::Scenario;
use barrelstack::outcome::Outcome;
use barrelstack_campaign::Direction;
use barrelstack_campaign::score::{
    Capacity, Protocol, ScoreError, Sheet, contenders, league, score,
};
use barrelstack_campaign::study::{Role, RunOptions, StudyError, StudyTable};
use barrelstack_space::run::run;

/// Returns a short protocol: stacks of two levels under three motions.
fn brief(velocities: &[f64]) -> Protocol {
    let velocities = velocities.to_vec();
    Protocol { levels: 2, velocities, periods: vec![1.2], synthetic: 0, ..Protocol::rockscore() }
}

fn scored(scenario: &Scenario, protocol: &Protocol, folder: &Path) -> Result<Sheet, ScoreError> {
    score(scenario, protocol, folder, &RunOptions::default(), &|_, _| ControlFlow::Continue(()))
}

fn demo(changes: &[&str]) -> Scenario {
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    Scenario::builtin("demo-napa", &changes).unwrap()
}

#[test]
fn the_score_is_the_least_of_all_states_and_directions_and_a_stop_loses_no_bit() {
    let protocol = brief(&[0.3, 0.9, 2.4]);
    let chocked = demo(&["stack.chock.levels=1"]);
    let (whole, stopped) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let sheet = scored(&chocked, &protocol, whole.path()).unwrap();

    let least = sheet.rows.iter().map(|row| row.capacity.velocity()).fold(f64::MAX, f64::min);
    assert_eq!(f64::from(sheet.score()), (100.0 * least + 1e-6).floor());
    // The states new, wet, and worn chocks, in two directions; no run is missing.
    let worn = chocked.stack().unwrap().devices.present()[0].degraded.len();
    assert!(worn > 0);
    assert_eq!(sheet.rows.len(), 2 * (2 + worn));
    assert!(sheet.rows.iter().all(|row| (row.runs, row.left_out) == (9, 0)));
    // At the strongest shaking at least six runs collapse; at the weakest none does.
    let at = |velocity| sheet.rows.iter().map(move |row| row.at(velocity).unwrap().failures);
    assert_eq!(at(0.3).sum::<u32>(), 0);
    assert!(at(2.4).sum::<u32>() >= 6);

    let reports = AtomicUsize::new(0);
    let stop = |_, _| {
        if reports.fetch_add(1, Ordering::Relaxed) < 20 {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    };
    let result = score(&chocked, &protocol, stopped.path(), &RunOptions::default(), &stop);
    assert!(matches!(result, Err(ScoreError::Study(StudyError::Stopped))));
    let resumed = scored(&chocked, &protocol, stopped.path()).unwrap();
    assert_eq!(html(&sheet.document), html(&resumed.document));
}

#[test]
fn what_no_shaking_of_a_protocol_brings_down_has_its_strongest_as_score_at_least() {
    let folder = tempfile::tempdir().unwrap();
    let sheet = scored(&demo(&[]), &brief(&[0.02, 0.05]), folder.path()).unwrap();
    assert!(sheet.rows.iter().all(|row| row.capacity == Capacity::Above(0.05)));
    assert_eq!(sheet.score(), 5);
    assert!(sheet.document.verdict.headline.contains("RockScore of at least 5"));
}

#[cfg(unix)]
#[test]
fn a_folder_of_somebody_else_leads_no_state_out_of_it() {
    let (place, protocol) = (tempfile::tempdir().unwrap(), brief(&[0.02]));
    let (outside, folder) = (place.path().join("outside"), place.path().join("score"));
    for folder in [&outside, &folder] {
        std::fs::create_dir(folder).unwrap();
    }
    std::os::unix::fs::symlink(&outside, folder.join("as-good-as-new")).unwrap();
    let said = scored(&demo(&[]), &protocol, &folder).unwrap_err();
    let said = std::error::Error::source(&said).map_or(said.to_string(), ToString::to_string);
    assert!(said.contains("is a link, not a folder"), "{said}");
    assert_eq!(std::fs::read_dir(&outside).unwrap().count(), 0);
}

#[test]
fn a_scene_without_racks_has_no_score() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Scenario::builtin("sliding-block", &[]).unwrap();
    let refused = scored(&scene, &Protocol::rockscore(), folder.path()).unwrap_err();
    assert!(refused.to_string().contains("use the scenario of a stack"), "{refused}");
}

/// Returns a protocol with seven motions at three levels.
fn sampled() -> Protocol {
    Protocol { synthetic: 4, ..brief(&[0.3, 0.9, 2.4]) }
}

#[test]
fn the_range_over_constants_is_that_of_the_least_row_in_every_draw() {
    let folder = tempfile::tempdir().unwrap();
    let sheet = scored(&demo(&[]), &sampled(), folder.path()).unwrap();
    // By brute force: sort the smallest velocity of every draw, and omit one fortieth of the draws at each end.
    let count = sheet.rows[0].draws.len();
    assert!(count > 1000 && sheet.rows.iter().all(|row| row.draws.len() == count));
    let mut least: Vec<f64> = (0..count)
        .map(|draw| sheet.rows.iter().map(|row| row.draws[draw]).fold(f64::MAX, f64::min))
        .collect();
    assert_eq!(least, sheet.draws());
    least.sort_by(f64::total_cmp);
    let [low, high] = sheet.range().unwrap();
    let (first, last) = (100.0 * least[count / 40], 100.0 * least[count - 1 - count / 40]);
    assert!((first - f64::from(low)).abs() < 2.0, "{low} {first}");
    assert!((last - f64::from(high)).abs() < 2.0, "{high} {last}");
    assert!(low <= sheet.score() && sheet.score() <= high, "{low} {} {high}", sheet.score());
    // The numbers are the same in the sentence, on the page and in the JSON.
    let document = serde_json::to_value(sheet.to_document()).unwrap();
    assert_eq!(document["range"], serde_json::json!([low, high]));
    let said = format!("the score is between {low} and {high} with a probability of 95 %");
    let page = html(&sheet.document).replace('\u{a0}', " ");
    assert!(page.contains(&said), "{said}");
    let states = document["states"].as_array().unwrap();
    for (row, state) in sheet.rows.iter().zip(states) {
        let range = row.range().unwrap();
        assert_eq!(state["range"], serde_json::json!([range.low, range.high]));
    }
}

#[test]
fn too_few_runs_have_no_range() {
    let folder = tempfile::tempdir().unwrap();
    let sheet = scored(&demo(&[]), &brief(&[0.3, 0.9]), folder.path()).unwrap();
    assert!(sheet.draws().is_empty() && sheet.range().is_none());
    assert!(serde_json::to_value(sheet.to_document()).unwrap()["range"].is_null());
}

/// The caption of the scale names the motions from which the scores of the catalog come.
#[test]
fn one_motion_in_four_is_what_the_caption_of_the_scale_states() {
    // Both components of South Napa are in every protocol.
    let motions = |protocol: &Protocol| protocol.periods.len() + 2 + protocol.synthetic as usize;
    let whole = Protocol::rockscore();
    let thinned = whole.clone().thinned(4);
    assert_eq!((motions(&thinned), motions(&whole)), (8, 24));
    assert_eq!((thinned.periods.as_slice(), thinned.synthetic), (&[0.5, 2.7][..], 4));
}

#[test]
fn every_rack_and_device_of_the_catalog_is_in_the_league_or_is_reported() {
    let protocol = Protocol { synthetic: 0, ..brief(&[0.3]) };
    let (scenario, folder) = (demo(&["stack.view=transverse"]), tempfile::tempdir().unwrap());
    let options = RunOptions::default();
    let report = |_, _| ControlFlow::Continue(());
    let found = league(&scenario, &protocol, folder.path(), &options, &report).unwrap();
    let mut names: Vec<&str> = found.rows.iter().map(|(one, _)| one.name.as_str()).collect();
    names.extend(found.not_scored.iter().map(|(one, _)| one.name.as_str()));
    let all = contenders(&scenario);
    assert_eq!(names.len(), all.len());
    assert!(all.iter().all(|one| names.contains(&one.name.as_str())), "{names:?}");
    assert!(found.rows.windows(2).all(|pair| pair[0].1.score() >= pair[1].1.score()));
    let csv = found.to_csv();
    assert!(csv.starts_with("name,kind,score (cm/s),sampling_low (cm/s)"), "{csv}");
    assert_eq!(csv.lines().count(), 1 + all.len());
    // A row is the score of the scenario with its changes.
    let (one, sheet) = found.rows.iter().find(|(one, _)| one.kind == "rack").unwrap();
    let changes = [&one.changes[..], &["stack.view=transverse".to_owned()]].concat();
    let alone = tempfile::tempdir().unwrap();
    let again = scored(&Scenario::builtin("demo-napa", &changes).unwrap(), &protocol, alone.path());
    let stripes = |sheet: &Sheet| -> Vec<_> {
        sheet.rows.iter().map(|row| row.curve.stripes.clone()).collect()
    };
    assert_eq!(stripes(sheet), stripes(&again.unwrap()));
}

/// Returns the cells of a line of a CSV file, without quotes.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut quoted) = (vec![String::new()], false);
    for letter in line.chars() {
        match letter {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            other => cells.last_mut().unwrap().push(other),
        }
    }
    cells
}

/// The published tables, from runs in planes and from three-dimensional runs, list every rack and device of the
/// catalog, with a score or with the reason why there is none.
#[test]
fn every_rack_and_device_is_in_the_published_tables() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../validation/league");
    for (view, page, table) in
        [("both", "index.md", "league.csv"), ("spatial", "space.md", "space.csv")]
    {
        let read =
            |name: &str| std::fs::read_to_string(folder.join(name)).unwrap().replace('\u{a0}', " ");
        let (page, table) = (read(page), read(table));
        let rows: Vec<Vec<String>> = table.lines().skip(1).map(cells).collect();
        let all = contenders(&demo(&[&format!("stack.view={view}")]));
        assert_eq!(rows.len(), all.len(), "{view}");
        for one in all {
            let row = rows.iter().find(|row| row[0] == one.name).unwrap();
            let scored = page.contains(&format!("| {} | {} |", one.name, row[2]));
            let reason = row.last().unwrap();
            let refused = page.replace('"', "").contains(&format!("- {}: {reason}\n", one.name));
            assert_eq!([scored, refused], [!row[2].is_empty(), row[2].is_empty()], "{row:?}");
        }
    }
}

/// Returns the field of a scenario that a column of a drawn constant states, and the same field of fallen bodies.
fn fields(column: &str) -> Vec<String> {
    let Some((quantity, pair)) = column.split_once(' ').filter(|(_, pair)| pair.contains('-'))
    else {
        return vec!["stack.azimuth".to_owned()];
    };
    match quantity {
        "friction" => [format!("interface.{pair}"), format!("interface.fallen-{pair}")]
            .map(|place| format!("{place}.friction.coefficient"))
            .to_vec(),
        other => vec![format!("interface.{pair}.{other}")],
    }
}

/// The runs behind a three-dimensional score are bit-identical to single runs of their scenarios.
#[test]
fn a_score_in_space_is_that_of_direct_runs() {
    let protocol = Protocol { periods: Vec::new(), ..brief(&[0.5, 1.4]) };
    let space = ["stack.view=spatial", "stack.levels=2"];
    let folder = tempfile::tempdir().unwrap();
    let sheet = scored(&demo(&space), &protocol, folder.path()).unwrap();
    assert_eq!(sheet.protocol.name, "rockscore/2-space");
    assert!(sheet.rows.iter().all(|row| row.direction == Direction::Space));
    assert_eq!(sheet.rows.len(), 2);
    let row = &sheet.rows[0];
    let table = folder.path().join("as-good-as-new/spatial/table.parquet");
    let table = StudyTable::from_parquet(std::fs::read(table).unwrap()).unwrap();
    let mut failures = [0, 0];
    for case in 0..table.rows() {
        let number = |column: &str| table.numbers(column).unwrap()[case].unwrap();
        let component = if table.texts("record").unwrap()[case].as_deref().unwrap().ends_with('1') {
            "horizontal-1"
        } else {
            "horizontal-2"
        };
        let mut changes: Vec<String> = space.map(str::to_owned).to_vec();
        changes.push("run.until=verdict".to_owned());
        changes.push(format!("motion.component={component}"));
        changes.push(format!("motion.scale.factor={}", number("scale_factor")));
        for factor in table.of_role(Role::Factor) {
            let (name, unit) = (&factor.spec.name, &factor.spec.unit);
            let value = format!("{} {unit}", number(name));
            changes.extend(fields(name).iter().map(|field| format!("{field}={}", value.trim())));
        }
        let run = run(&Scenario::builtin("demo-napa", &changes).unwrap()).unwrap();
        let fell = matches!(run.outcome, Outcome::Collapse { .. });
        assert_eq!(table.texts("outcome").unwrap()[case].as_deref(), Some(run.outcome.kind()));
        assert_eq!(number("end_time").to_bits(), run.end_time.to_bits(), "case {case}");
        failures[usize::from(number("level") > 1.0)] += u32::from(fell);
    }
    let found = [0.5, 1.4].map(|level| row.at(level).unwrap().failures);
    assert_eq!(found, failures);
    assert!(failures[1] > 0, "nothing falls");
}
