//! Stacks that fall under their own weight, which count as collapsed, and stacks in both planes, which are refused with
//! advice for each plane.

use barrelstack::Scenario;
use barrelstack::variants::planes;
use barrelstack_campaign::Study;
use barrelstack_campaign::study::Tally;

/// Stacks along the barrels under very weak shaking. Every seat is as soft as one contact node of the paper, and one
/// rack is slightly out of place: stacks of four levels stand, those of six and eight do not.
const STUDY: &str = r#"
schema = 1
title = "levels along the barrels"
[base]
extends = "demo-napa"
stack.view = "longitudinal"
stack.columns = 1
stack.levels = 6
motion.scale.factor = 0.02
run.duration = "0.5 s"
[base.interface.rack-ground]
basis = "node"
stiffness = "980 kN/m"
damping = "2200 N*s/m"
friction.coefficient = 0.5
[base.interface.barrel-rack]
basis = "node"
stiffness = "980 kN/m"
damping = "2200 N*s/m"
friction = { coefficient = 0.22, tangential_stiffness_ratio = 1 }
[[base.stack.override]]
kind = "rack"
level = 2
offset_x = "2 mm"
[[factor]]
field = "stack.levels"
values = [4, 6, 8]
[design]
kind = "full-factorial"
"#;

#[test]
fn what_does_not_stand_by_itself_counts_as_collapsed_in_a_study() {
    let table = Study::parse("study.toml", STUDY).unwrap().table().unwrap();
    let texts = |name| -> Vec<&str> {
        table.texts(name).unwrap().iter().map(|text| text.as_deref().unwrap_or_default()).collect()
    };
    assert_eq!(texts("outcome"), ["stable", "collapse", "collapse"]);
    assert_eq!(texts("mode"), ["", "gravity", "gravity"]);
    assert_eq!(texts("ended"), ["duration", "not-shaken", "not-shaken"]);
    assert_eq!(table.numbers("first_loss").unwrap(), [None, Some(0.0), Some(0.0)]);
    // All levels above the one that fails fall to the floor.
    let levels = [0, 6, 8];
    for ((fallen, drops), most) in
        table.integers("barrels_fallen").unwrap().iter().zip(texts("fall_heights")).zip(levels)
    {
        let drops: Vec<f64> = drops
            .split(';')
            .filter(|drop| !drop.is_empty())
            .map(|drop| drop.parse().unwrap())
            .collect();
        assert_eq!(usize::try_from(fallen.unwrap()), Ok(drops.len()), "{drops:?}");
        assert!(drops.len() <= most && (most == 0 || drops.len() >= 4), "{drops:?}");
        // A level is 0.85 m high.
        assert!(drops.windows(2).all(|pair| (pair[1] - pair[0] - 0.85).abs() < 0.01), "{drops:?}");
    }
    let tally = Tally::of(&table);
    assert_eq!((tally.cases, tally.judged, tally.collapsed), (3, 3, 2));
}

#[test]
fn the_advice_for_both_planes_makes_the_same_stacks() {
    let study = |stack: &str| {
        let text = format!(
            "schema = 1\n[base]\nextends = \"demo-napa\"\n{stack}\n[design]\nkind = \"full-factorial\"\n"
        );
        Study::parse("study.toml", &text)
    };
    let refused = study("stack.levels = 3").unwrap_err().to_string();
    let base = Scenario::builtin("demo-napa", &["stack.levels=3".to_owned()]).unwrap();
    for plane in planes(&base).unwrap() {
        let stack = plane.scenario.stack().unwrap();
        let view = format!("base.stack.view = \"{}\"", stack.view.name());
        let columns = format!("base.stack.columns = {}", stack.columns);
        assert!(refused.contains(&format!("`{view}` and `{columns}`")), "{refused}");
        let advice = format!("stack.levels = 3\n{view}\n{columns}").replace("base.", "");
        let table = study(&advice).unwrap().table().unwrap();
        let barrels = i64::from(stack.levels * stack.columns);
        assert_eq!(table.integers("barrels").unwrap(), [Some(barrels)]);
    }
}
