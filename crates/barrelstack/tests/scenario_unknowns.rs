//! Unknown constants: their limits, and the keys that state them under a former name.

use barrelstack::Scenario;
use barrelstack::scenario::field::Kind;
use barrelstack::scenario::unknowns::UNKNOWNS;

#[test]
fn every_dispersion_has_its_limits() {
    let numbers = UNKNOWNS.fields.iter().filter(|field| matches!(field.kind, Kind::Number(_)));
    let mut checked = 0;
    for field in numbers {
        let with = |value: &str| {
            Scenario::builtin("demo-napa", &[format!("unknowns.{}={value}", field.name)])
        };
        // Constants that are one and the same have one draw, and no correlation.
        let most = if field.name == "friction_correlation" { "0.95" } else { "1" };
        assert!(with("0").is_ok() && with(most).is_ok(), "{}", field.name);
        for beyond in ["-0.1", "1.1", "nan"] {
            let sentence = with(beyond).unwrap_err().sentence();
            let name = format!("`unknowns.{}`", field.name);
            assert!(sentence.contains(&name) && sentence.contains(most), "{sentence}");
        }
        checked += 1;
    }
    let rails = |value: &str| Scenario::builtin("demo-napa", &[format!("unknowns.rails={value}")]);
    assert!(rails("5 mm").is_ok());
    let sentence = rails("3 cm").unwrap_err().sentence();
    assert!(sentence.contains("`unknowns.rails`"), "{sentence}");
    assert_eq!(checked, UNKNOWNS.fields.len() - 2);
}

const FORMER: &str = "schema = 1\nextends = \"demo-napa\"\n[imperfections]\nplacement = \"2 mm\"\n\
                      friction = 0.3\nfriction_barrel_rack = 0.1\nfriction_ground = 0.15\nstiffness = 0.5\n\
                      impact_stiffness = 0.2\ndamping = 0.4\nkind = \"hair\"\n";
const PRESENT: &str = "schema = 1\nextends = \"demo-napa\"\n[imperfections]\nplacement = \"2 mm\"\n\
                       [unknowns]\nfriction = 0.3\nfriction_barrel_rack = 0.1\nfriction_ground = 0.15\n\
                       stiffness = 0.5\nimpact_stiffness = 0.2\ndamping = 0.4\ndrawn = false\n";

fn read(text: &str, changes: &[&str]) -> Scenario {
    let changes: Vec<String> = changes.iter().map(|&change| change.to_owned()).collect();
    Scenario::parse("mine.toml", text, &changes).unwrap()
}

#[test]
fn former_keys_give_the_same_scenario_and_a_warning_each() {
    let (former, present) = (read(FORMER, &[]), read(PRESENT, &[]));
    assert_eq!(former, present);
    assert_eq!(former.fingerprint(), present.fingerprint());
    assert_eq!((former.warnings().len(), present.warnings().len()), (7, 0));
    assert_eq!(
        former.warnings()[0],
        "mine.toml:5:1: `imperfections.friction` is an old name, and a later version will reject it: write \
         `unknowns.friction` instead"
    );
    assert!(former.warnings()[6].ends_with("write `unknowns.drawn = false` instead"));
    // Every run repeats the warnings.
    assert_eq!(former.ground().unwrap().warnings[..7], *former.warnings());
    for (kind, now) in [
        ("hair", "unknowns.drawn=false"),
        ("ignorance", "imperfections.drawn=false"),
        ("both", "unknowns.drawn=true"),
    ] {
        let old = Scenario::builtin("demo-napa", &[format!("imperfections.kind={kind}")]);
        let new = Scenario::builtin("demo-napa", &[now.to_owned()]).unwrap();
        assert_eq!(old.unwrap(), new, "{kind}");
    }
}

#[test]
fn of_former_and_present_keys_the_upper_layer_holds() {
    let stiffness = |text, changes: &[&str]| read(text, changes).unknowns().unwrap().stiffness;
    assert_eq!(stiffness(FORMER, &["unknowns.stiffness=0.7"]), 0.7);
    assert_eq!(stiffness(PRESENT, &["imperfections.stiffness=0.8"]), 0.8);
    // The built-in scenario states the present keys.
    let below = "schema = 1\nextends = \"candia-8-barrels\"\n[imperfections]\nstiffness = 0.3\n";
    assert_eq!(stiffness(below, &[]), 0.3);
    let again = read(below, &[]).with(&["unknowns.stiffness=0.2".to_owned()]).unwrap();
    assert_eq!((again.unknowns().unwrap().stiffness, again.warnings().len()), (0.2, 1));
    let both = PRESENT.replacen("placement", "damping = 0.1\nplacement", 1);
    let error = Scenario::parse("mine.toml", &both, &[]).unwrap_err();
    assert_eq!(
        error.sentence(),
        "mine.toml:4:1: `unknowns.damping`, which replaces this key, is stated too; leave one of the two out"
    );
    let error = Scenario::builtin("demo-napa", &["imperfections.kind=some".to_owned()]);
    let sentence = error.unwrap_err().sentence();
    assert!(
        sentence.contains("replace it by `imperfections.drawn` and `unknowns.drawn`"),
        "{sentence}"
    );
}
