//! Parameters from statements on what fell in an earthquake, with simulated stacks.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]
#![allow(clippy::print_stdout, reason = "the result is shown")]

use std::ops::ControlFlow;

use barrelstack::ensemble::Width;
use barrelstack::scenario::Scenario;
use barrelstack_calibration::collapse::Settings;
use barrelstack_calibration::shares::{Height, Statements, shares};
use barrelstack_calibration::{Calibration, Parameter};

#[test]
fn a_share_that_fell_is_set_beside_that_of_simulated_stacks() {
    let found = |kind: &str, value: f64, levels: &[usize], lanes| {
        let text = format!(
            "[[earthquake]]\nname = \"sine\"\nmotion = 0.05\n\n[[earthquake.observation]]\nid = \"s\"\n\
             statement = \"S.\"\nsource = \"a test\"\nuncertainty = \"counted\"\nkind = \"{kind}\"\n\
             levels = {levels:?}\nvalue = {value}\nerror = 0.02\n"
        );
        let statements = Statements::read("s.toml", &text).unwrap();
        let (earthquake, chosen) = statements.chosen(&[]).unwrap();
        let height = |levels: usize| {
            let changes = [
                format!("stack.levels={levels}"),
                "motion.sine.amplitude=4 in".to_owned(),
                "run.duration=2.6 s".to_owned(),
            ];
            Height { levels, scenario: Scenario::builtin("candia-8-barrels", &changes).unwrap() }
        };
        let heights = [height(3), height(4)];
        let fit = [Parameter::FrictionBarrelRack];
        let settings = Settings { simulations: 120, within: 3.0, lanes, ..Settings::default() };
        let going = |_, _| ControlFlow::Continue(());
        shares(earthquake, &chosen, &heights, &fit, &settings, &going)
    };
    let most = found("most", 0.95, &[3, 4], None).unwrap();
    let few = found("few", 0.05, &[3, 4], None).unwrap();
    println!("{}\n{}", most.lines().join("\n"), few.lines().join("\n"));
    let fact = |result: &Calibration, name: &str| {
        let found = result.facts.iter().find(|(known, _)| known.starts_with(name));
        found.map(|(_, value)| value.clone()).unwrap()
    };
    let number = |text: &str| text.split(' ').next().unwrap().parse::<f64>().unwrap();
    // Measured: without a statement, 60 to 100 % of the stacks fall; given that most fell, 86 to 100 %; given that few
    // fell, 2 to 39 %. The model does not explain that few fell, and a warning states this. The motion is then weaker:
    // 0.88 times that of the scenario, in place of 1.02 times.
    let before = "60 to 100 % before, ";
    let share = |result: &Calibration| {
        let text = fact(result, "s: share by the model");
        number(text.strip_prefix(before).unwrap_or_else(|| panic!("{text}")))
    };
    assert!(share(&most) > 80.0 && share(&few) < 10.0);
    let motion = |result: &Calibration| number(&fact(result, "motion in the cellar"));
    assert!(motion(&few) < motion(&most) - 0.05);
    let contradicted =
        |result: &Calibration| result.warnings.iter().any(|text| text.contains("hardly agrees"));
    assert!(contradicted(&few) && !contradicted(&most), "{:?}", few.warnings);
    // One case at a time gives the same.
    let single = found("most", 0.95, &[3, 4], Some(Width::Scalar)).unwrap();
    assert_eq!(format!("{most:?}"), format!("{single:?}"));
    let error = found("most", 0.95, &[5], None).unwrap_err().to_string();
    assert!(
        error.contains("stacks of 5 levels, but there is no scenario of such a stack"),
        "{error}"
    );
}
