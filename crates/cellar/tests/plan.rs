//! The plan of a cellar: built-in rooms, and errors with their place.

use barrelstack_cellar::scenario::{MOST_BARRELS, names_built_in};
use barrelstack_cellar::{Cellar, CellarFailure, Plan, Prepared};

fn changed(changes: &[&str]) -> Result<Cellar, String> {
    let changes: Vec<String> = changes.iter().map(|&change| change.to_owned()).collect();
    Cellar::builtin("demo-cellar", &changes).map_err(|error| error.sentence())
}

/// Returns the problems of the plan of the changed demo.
fn problems(changes: &[&str]) -> Vec<String> {
    Plan::of(&changed(changes).unwrap()).unwrap().summary.problems
}

#[test]
fn built_in_cellars_have_the_barrels_of_their_titles() {
    for (name, barrels, stacks) in
        [("demo-cellar", 40, 4), ("cellar-four-barrel", 1848, 77), ("cellar-two-barrel", 1680, 140)]
    {
        let cellar = Cellar::builtin(name, &[]).unwrap();
        let plan = Plan::of(&cellar).unwrap().summary;
        assert_eq!((plan.barrels, plan.stacks), (barrels, stacks), "{name}");
        assert!(plan.problems.is_empty() && plan.findings.is_empty(), "{name}: {plan:?}");
        // Walls are no nearer than stated in the files.
        let near = plan.nearest_wall.unwrap().distance;
        assert!((0.299..0.461).contains(&near), "{name}: {near}");
        assert!((plan.nearest_stacks.unwrap().distance - 0.3).abs() < 1e-9, "{name}");
    }
    assert_eq!(names_built_in().count(), 3);
}

/// A title describes the room of its file, so a change that it does not name follows it.
#[test]
fn the_title_of_a_changed_cellar_says_so() {
    let title = |changes: &[&str]| changed(changes).unwrap().title;
    let own = "A small cellar, South Napa 2014";
    assert_eq!(title(&[]), own);
    assert_eq!(title(&["run.duration=5 s", "imperfections.variants=2"]), own);
    assert_eq!(title(&["stack.levels=2"]), format!("{own}, changed"));
    assert_eq!(title(&["stack.levels=2", "title=\"Mine\""]), "Mine");
    // Once is enough, and the words stay in the resolved text.
    let again = |cellar: &Cellar, changes: &[String]| {
        Cellar::parse("again.toml", cellar.to_resolved_toml().as_bytes(), changes).unwrap()
    };
    let changed = changed(&["stack.levels=2"]).unwrap();
    assert_eq!(again(&changed, &[]).title, format!("{own}, changed"));
    assert_eq!(again(&changed, &["stack.levels=3".to_owned()]).title, format!("{own}, changed"));
}

#[test]
fn a_cellar_reads_back_from_its_resolved_text() {
    let cellar = changed(&["block.1.levels_by_row=[4, 5]", "block.1.azimuth=90 deg"]).unwrap();
    assert_eq!(cellar.models.len(), 2);
    let text = cellar.to_resolved_toml();
    let again = Cellar::parse("again.toml", text.as_bytes(), &[]).unwrap();
    assert_eq!(again.to_resolved_toml(), text);
    assert_eq!(again.fingerprint(), cellar.fingerprint());
    assert_eq!(again.barrels(), 2 * 2 * (4 + 5));
}

#[test]
fn changes_reach_the_stack_and_the_block() {
    let cellar =
        changed(&["stack.levels=3", "block.1.stacks=1", "imperfections.variants=5"]).unwrap();
    assert_eq!((cellar.barrels(), cellar.stated().stack().unwrap().levels), (12, 3));
    assert_eq!(cellar.stated().imperfections().unwrap().variants, 5);
    let wrong = changed(&["block.1.spacng=1 m"]).unwrap_err();
    assert!(wrong.contains("spacng") && wrong.contains("did you mean `spacing`"), "{wrong}");
    let wrong = changed(&["stack.levels=2.5"]).unwrap_err();
    assert!(wrong.starts_with("override `stack.levels=2.5`"), "{wrong}");
}

#[test]
fn stacks_in_wrong_places_are_errors_with_place_and_remedy() {
    for (changes, words) in [
        (&["block.1.aisle=0 m", "block.1.first=[\"0.46 m\", \"1 m\"]"][..], &[][..]),
        (
            &["block.1.first=[\"-0.2 m\", \"0.7 m\"]"],
            &["extends 0.20 m beyond the left wall", "move the block"],
        ),
        (
            &["room.width=3 m", "aisle.aisle.to=[\"5 m\", \"2.9 m\"]", "door.door.position=2 m"],
            &["beyond the far wall", "enlarge"],
        ),
        (
            &[
                "door.door.side=near",
                "door.door.position=1.2 m",
                "block.1.first=[\"0.46 m\", \"0.1 m\"]",
            ],
            &["is too close to the door \"door\"", "move the door or the block"],
        ),
        (
            &["column=[{ name = \"post\", at = [\"1 m\", \"1 m\"] }]"],
            &["the column \"post\" overlaps stack 1-1", "move the column or the block"],
        ),
    ] {
        let found = problems(changes);
        assert_eq!(found.len(), usize::from(!words.is_empty()), "{changes:?}: {found:?}");
        for word in words {
            assert!(found[0].contains(word), "{found:?}");
        }
        // The place is that of the change, or that of the block in the file.
        let placed = |found: &String| {
            found.starts_with("override `") || found.starts_with("demo-cellar.toml:32:")
        };
        assert!(words.is_empty() || placed(&found[0]), "{found:?}");
    }
}

#[test]
fn overlapping_blocks_are_one_error_and_are_not_run() {
    let text = "schema = 1\nextends = \"demo-cellar\"\n[[block]]\nfirst = [\"1 m\", \"1 m\"]\n\
                [[block]]\nfirst = [\"1.2 m\", \"1.1 m\"]\nlevels = 3\n";
    let cellar = Cellar::parse("two.toml", text.as_bytes(), &[]).unwrap();
    let plan = Plan::of(&cellar).unwrap();
    assert_eq!(plan.problems.len(), 1, "{:?}", plan.summary.problems);
    let found = &plan.summary.problems[0];
    assert!(
        found.starts_with("two.toml:6:") && found.contains("stacks 1-1 and 2-1 overlap"),
        "{found}"
    );
    assert_eq!(plan.problems[0].1, [0, 1]);
    assert!(matches!(Prepared::new(&cellar), Err(CellarFailure::Plan(_))));
}

#[test]
fn a_room_that_cannot_be_is_one_error_with_its_place() {
    for (change, words) in [
        ("aisle.aisle.to=[\"0 m\", \"1 m\"]", "`to` needs larger coordinates"),
        ("aisle.aisle.to=[\"50 m\", \"3 m\"]", "outside the room"),
        ("place.1.at=[\"-1 m\", \"1 m\"]", "outside the room"),
        (
            "door.door.position=4.9 m",
            "reaches from 4.30 to 5.50 m, but its side of the room is 5 m long",
        ),
        ("block.1.rows=500", "barrels"),
        ("block.1.levels_by_row=[5]", "state one value for each row"),
        ("room.length=-5 m", "greater than 0"),
        ("stack.azimuth=90 deg", "whole blocks are turned"),
        ("stack.view=both", "leave `stack.view` out"),
        ("run.until=duration", "leave `run.until` out"),
    ] {
        let changes = if change.starts_with("block.1.rows") {
            vec![change, "block.1.stacks=100", "room.length=900 m", "room.width=900 m"]
        } else {
            vec![change]
        };
        let found = changed(&changes).unwrap_err();
        assert!(found.contains(words), "{change}: {found}");
        assert!(found.starts_with("override `"), "{change}: {found}");
    }
}

#[test]
fn the_number_of_barrels_is_limited_before_anything_is_built() {
    // 500 rows of 500 stacks of 480 barrels would be 1.2e8 barrels.
    let found =
        changed(&["block.1.rows=500", "block.1.stacks=500", "stack.columns=40", "stack.levels=12"]);
    let found = found.unwrap_err();
    assert!(found.contains(&format!("more than {MOST_BARRELS} barrels")), "{found}");
    assert!(found.contains("with row 1 of this block") && found.contains("use fewer"), "{found}");
}

#[test]
fn narrow_aisles_and_missing_ways_out_are_found() {
    let found = Plan::of(&changed(&["block.1.aisle=0.5 m"]).unwrap()).unwrap().summary;
    assert!(found.problems.is_empty(), "{:?}", found.problems);
    assert!(found.findings[0].contains("less than the 0.6 m that a person needs"), "{found:?}");
    let wide = Plan::of(&changed(&[]).unwrap()).unwrap().summary;
    assert!((wide.aisles[0].narrowest - 1.4).abs() < 1e-9, "{wide:?}");
    assert_eq!(wide.places[0].leads_out, Some(true));
    // A wall of stacks between the place and the door.
    let text = "schema = 1\nextends = \"demo-cellar\"\n[[block]]\nfirst = [\"2 m\", \"0.05 m\"]\nrows = 5\n\
                azimuth = \"0 deg\"\naisle = \"0.02 m\"\n[[place]]\nname = \"corner\"\nat = [\"0.5 m\", \"4 m\"]\n";
    let cellar = Cellar::parse("shut.toml", text.as_bytes(), &[]).unwrap();
    let shut = Plan::of(&cellar).unwrap().summary;
    assert_eq!(shut.places[0].leads_out, Some(false), "{shut:?}");
}
