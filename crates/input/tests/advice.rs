//! Advice in error messages: names that are nearly right, missing columns, and example values of missing fields.

use barrelstack_input::Dimension;
use barrelstack_input::field::{Default, Field, Kind, Range};
use barrelstack_input::measured::Table;
use barrelstack_input::names::{advice, nearest};

#[test]
fn words_of_a_name_may_be_in_another_order() {
    let names = ["demo-cellar", "demo-napa", "candia-8-barrels", "rocking-block"];
    for (word, near) in [
        ("napa-demo", Some("demo-napa")),
        ("napa demo", Some("demo-napa")),
        ("napa-dmeo", Some("demo-napa")),
        ("barrels-8-candia", Some("candia-8-barrels")),
        ("block-rocking", Some("rocking-block")),
        ("Demo_Napa", Some("demo-napa")),
        ("something", None),
        ("", None),
    ] {
        assert_eq!(nearest(word, &names).as_deref(), near, "{word}");
    }
}

#[test]
fn advice_lists_a_few_names_and_counts_many() {
    let many: Vec<String> = (1..=40).map(|number| format!("B{number}.1")).collect();
    let many: Vec<&str> = many.iter().map(String::as_str).collect();
    assert_eq!(advice("B7,1", &many), "did you mean `B7.1`?");
    assert_eq!(advice("rack", &many), "use one of the 40 names from B1.1 to B40.1");
    assert_eq!(advice("cube", &["block"]), "the only name is block");
    assert_eq!(advice("blok", &["block"]), "did you mean `block`?");
}

#[test]
fn a_missing_column_is_answered_with_the_columns_of_the_file_and_the_expected_name() {
    let table = |header: &str| Table::parse("t.csv", &format!("{header}\n1,2\n")).unwrap();
    let depth = table("depth (mm),force (kN)");
    let said = depth.required("penetration", Dimension::LENGTH).unwrap_err().to_string();
    assert_eq!(
        said,
        "t.csv, line 1: expected a column `penetration (m)`, found the columns \"depth (mm)\", \"force (kN)\"; add the \
         column, or write `penetration (m)` as the heading of the column that holds its values"
    );
    let typo = table("penetratoin (mm),force (kN)");
    let said = typo.required("penetration", Dimension::LENGTH).unwrap_err().to_string();
    assert!(
        said.contains("if \"penetratoin\" is this column, write `penetration (m)` in its place"),
        "{said}"
    );
    let said = depth.per_year("rate").unwrap_err().to_string();
    assert!(said.contains("expected a column `rate (1/year)`, found the columns"), "{said}");
}

#[test]
fn examples_have_the_size_of_the_field() {
    let example = |kind: Kind, default: Default| Field::new("x", kind, default, "").example();
    let length = |range: Range| Kind::Quantity(&[Dimension::LENGTH], range);
    for (kind, default, expected) in [
        // A room, the distance to a fault, and a part of a barrel.
        (length(Range::up_to(1000.0)), Default::Required, "`x = \"10 m\"`"),
        (length(Range::up_to(1e7)), Default::Required, "`x = \"100 km\"`"),
        (length(Range::POSITIVE), Default::Required, "`x = \"0.25 m\"`"),
        (length(Range::up_to(10.0)), Default::Value("\"30 cm\""), "`x = \"30 cm\"`"),
        (Kind::Point(Dimension::LENGTH), Default::Required, "`x = [\"1 m\", \"2 m\"]`"),
    ] {
        assert_eq!(example(kind, default), expected);
    }
}
