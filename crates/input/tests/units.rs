//! Units as written in practice, and suggested units, which must be valid.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

use barrelstack_input::measured::{Table, TableError};
use barrelstack_input::{Dimension, Quantity, QuantityError, unit};

#[test]
fn gal_is_a_gallon_as_a_volume_and_a_galileo_as_an_acceleration() {
    let as_one = |text: &str, dimension| Quantity::parse_as(text, &[dimension]).unwrap().value;
    assert_eq!(as_one("60 gal", Dimension::VOLUME), 0.227_124_707_04);
    assert_eq!(as_one("350 gal", Dimension::ACCELERATION), 3.5);
    let density = as_one("8.3 lb/gal", Dimension::DENSITY);
    assert!((density / (8.3 * 0.453_592_37 / 3.785_411_784e-3) - 1.0).abs() < 1e-15); // measured 2e-16
    // The unambiguous names have only one meaning.
    for (text, wanted) in [("60 gallon", Dimension::ACCELERATION), ("350 Gal", Dimension::VOLUME)] {
        let error = Quantity::parse_as(text, &[wanted]).unwrap_err();
        assert!(matches!(error, QuantityError::WrongDimension { .. }), "{text}: {error}");
    }
    let unclear = Quantity::parse("60 gal").unwrap_err();
    assert!(matches!(unclear, QuantityError::Ambiguous { .. }), "{unclear}");
}

/// All dimensions that fields require.
const WANTED: [Dimension; 22] = [
    Dimension::NONE,
    Dimension::LENGTH,
    Dimension::MASS,
    Dimension::TIME,
    Dimension::ANGLE,
    Dimension::FREQUENCY,
    Dimension::VELOCITY,
    Dimension::ACCELERATION,
    Dimension::SPIN,
    Dimension::FORCE,
    Dimension::VOLUME,
    Dimension::INERTIA,
    Dimension::STIFFNESS,
    Dimension::STIFFNESS_PER_LENGTH,
    Dimension::HERTZ_STIFFNESS,
    Dimension::HERTZ_STIFFNESS_PER_LENGTH,
    Dimension::DAMPING,
    Dimension::DAMPING_PER_LENGTH,
    Dimension::HUNT_CROSSLEY_DAMPING,
    Dimension::ANGULAR_DAMPING,
    Dimension::MASS_PER_LENGTH,
    Dimension::DENSITY,
];

/// Returns units as people write them: valid, invalid, and of another dimension.
fn written_units() -> Vec<String> {
    let known = unit::names().map(str::to_owned);
    let words = "lbs lbm pound pounds kgs KG Kg ton tons tonne gal Gal GAL gals gallon gallons US_gal \
        l L ltr liter litres g gram grams gr sec Sec seconds hrs MS inch inches \" ' feet FT foot yard \
        kN KN kn kgf tf tonf Kip kips klbf mpa MPA kpa PSI psf pcf psi hz HZ degree degrees rads stone \
        furlong m/s2 m/s² m/s^2 ft/s2 ft/sec2 m/sec/sec cm/s lb/ft3 lb/in kip/in kg/m3 lb/gal kg/cm \
        kgf/cm2 N/mm2 kg*s/m kg/mm² N/m/s N//m m^ (m ()";
    known.chain(words.split_whitespace().map(str::to_owned)).collect()
}

#[test]
fn every_hint_about_a_unit_works_when_it_is_obeyed() {
    let mut hints = 0;
    for wanted in WANTED {
        for unit in written_units() {
            for text in [format!("60 {unit}"), format!("1,5 {unit}"), format!("1,500 {unit}")] {
                let Err(error) = Quantity::parse_as(&text, &[wanted]) else { continue };
                let hint = Quantity::suggestion(&text, &[wanted]);
                let read = Quantity::parse_as(&hint, &[wanted]);
                assert!(read.is_ok(), "{text}: {error}; the hint \"{hint}\" does not work");
                hints += 1;
            }
        }
        for text in ["60", "1,5", "-3e2", "", "abc", "m"] {
            let hint = Quantity::suggestion(text, &[wanted]);
            assert!(Quantity::parse_as(&hint, &[wanted]).is_ok(), "{text}: \"{hint}\"");
        }
        assert!(Quantity::parse_as(&wanted.example(), &[wanted]).is_ok(), "{wanted}");
    }
    // Measured: about 7,000, because nearly every unit is of another dimension than wanted.
    assert!(hints > 5000, "{hints}");
}

#[test]
fn hints_about_units_are_what_was_meant() {
    use Dimension as D;
    for (text, wanted, hint) in [
        ("600 pounds", D::MASS, "600 lb"),
        ("100 lb", D::FORCE, "100 lbf"),
        ("100 kg", D::FORCE, "100 kgf"),
        ("0.6 t", D::FORCE, "0.6 tonf"),
        ("600 lbf", D::MASS, "600 lb"),
        ("200 lb/in", D::STIFFNESS, "200 lbf/in"),
        ("45000 g", D::MASS, "45000 gram"),
        ("60 Gal", D::VOLUME, "60 gallon"),
        ("2 \"", D::LENGTH, "2 in"),
        ("2 KN", D::FORCE, "2 kN"),
        ("2,5 m", D::LENGTH, "2.5 m"),
        ("275", D::MASS, "275 kg"),
        // 1500 kg or 1.5 kg: ambiguous, so the example is returned.
        ("1,500 kg", D::MASS, "275 kg"),
    ] {
        assert_eq!(Quantity::suggestion(text, &[wanted]), hint, "{text}");
    }
}

#[test]
fn hints_about_units_of_columns_work_when_they_are_obeyed() {
    let mut hints = 0;
    for wanted in WANTED {
        // In a header, the unit itself is in parentheses.
        for unit in written_units().iter().filter(|unit| !unit.contains(['(', ')'])) {
            let table = |unit: &str| Table::parse("t.csv", &format!("x ({unit})\n1\n2\n")).unwrap();
            let Err(TableError::Cell { remedy, .. }) = table(unit).required("x", wanted) else {
                continue;
            };
            // The remedy states the complete header of the column.
            let (_, rest) = remedy.split_once("x (").unwrap_or_else(|| panic!("{unit}: {remedy}"));
            let (better, _) = rest.rsplit_once(')').unwrap();
            assert!(table(better).required("x", wanted).is_ok(), "{unit}: {remedy}");
            hints += 1;
        }
    }
    assert!(hints > 1500, "{hints}");
}

#[test]
fn every_unit_of_the_list_is_read() {
    for name in unit::names() {
        let read = Quantity::parse(&format!("2 {name}"));
        assert!(read.is_ok_and(|quantity| quantity.value > 0.0), "{name}");
    }
}
