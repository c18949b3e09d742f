//! Quantities: exact conversion, dimensions, errors, and no panic on any text.

use barrelstack::scenario::{Dimension, Quantity, QuantityError};
use proptest::prelude::*;

fn value(text: &str) -> f64 {
    Quantity::parse(text).unwrap_or_else(|error| panic!("{text}: {error}")).value
}

#[test]
fn decimal_conversions_are_exact() {
    let cases = [
        ("2 in", 0.0508),
        ("4 in", 0.1016),
        ("1 ft", 0.3048),
        ("0.1 in", 0.00254),
        ("9.8 kN/cm", 980_000.0),
        ("22 N s/cm", 2200.0),
        ("60 cm/s", 0.6),
        ("0.1 ms", 0.0001),
        ("275 kg", 275.0),
        ("600 lb", 272.155_422),
        ("0.35 g", 3.432_327_5),
        ("1 lbf", 4.448_221_615_260_5),
        ("1 kip", 4_448.221_615_260_5),
        ("1.2 kN/m^2", 1200.0),
        ("12 gram", 0.012),
        ("225 L", 0.225),
        ("3 min", 180.0),
        ("5 %", 0.05),
        ("60 Hz", 60.0),
        ("981 Gal", 9.81),
        ("60 gallons", 0.227_124_707_04),
        ("600 lbs", 272.155_422),
        ("2.25 hl", 0.225),
        ("100 kgf", 980.665),
        ("3 tonf", 29_419.95),
        ("32.2 ft/s2", 9.814_56),
        ("32.2 ft/s²", 9.814_56),
        ("32.2 ft/s^2", 9.814_56),
        ("990 kg/m3", 990.0),
        ("+1.5e3 mm", 1.5),
        (".5 m", 0.5),
        ("5. m", 5.0),
        ("-0 m", 0.0),
        ("000000000000000000000000000000000000000000001 m", 1.0),
    ];
    for (text, expected) in cases {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn angles_and_pressures_are_within_one_rounding() {
    assert_eq!(value("180 deg"), std::f64::consts::PI);
    assert_eq!(value("30 deg"), 30.0 / 180.0 * std::f64::consts::PI);
    assert!((value("1 psi") / 6_894.757_293_168_361 - 1.0).abs() < 3e-16); // measured 0
}

#[test]
fn ways_to_write_a_unit_agree() {
    for same in [
        &["22 N s/cm", "22 s N/cm", "22 N*s/cm", "22N·s/cm", "22 N s cm^-1", "22 (N s)/cm"][..],
        &["3 m/s^2", "3 m/s²", "3 m/s/s", "3 m s^-2", "3 m/(s s)", "3 (m/s)/s"],
        &["2 µm", "2 μm", "2 um"],
        &["4 m^1.5", "4 m m^0.5", "4 (m^3)^0.5"],
    ] {
        let parsed: Vec<Quantity> =
            same.iter().map(|text| Quantity::parse(text).unwrap()).collect();
        for (text, quantity) in same.iter().zip(&parsed) {
            assert_eq!(quantity.dimension, parsed[0].dimension, "{text}");
            assert!((quantity.value / parsed[0].value - 1.0).abs() < 3e-16, "{text}"); // measured 0
        }
    }
}

#[test]
fn dimensions_are_told_apart() {
    let cases = [
        ("1 N/m", Dimension::STIFFNESS),
        ("1 kg/s^2", Dimension::STIFFNESS),
        ("1 N/m^2", Dimension::STIFFNESS_PER_LENGTH),
        ("1 Pa", Dimension::STIFFNESS_PER_LENGTH),
        ("1 N/m^1.5", Dimension::HERTZ_STIFFNESS),
        ("1 kN/mm^1.5", Dimension::HERTZ_STIFFNESS),
        ("1 N/m^2.5", Dimension::HERTZ_STIFFNESS_PER_LENGTH),
        ("1 N s/m", Dimension::DAMPING),
        ("1 N s/m^2", Dimension::DAMPING_PER_LENGTH),
        ("1 s/m", Dimension::HUNT_CROSSLEY_DAMPING),
        ("1 kg m^2", Dimension::INERTIA),
        ("1 deg/s", Dimension::SPIN),
        ("1 1/s", Dimension::FREQUENCY),
        ("1 N m s", Dimension::ANGULAR_DAMPING),
    ];
    for (text, expected) in cases {
        assert_eq!(Quantity::parse(text).unwrap().dimension, expected, "{text}");
    }
    assert_ne!(Dimension::SPIN, Dimension::FREQUENCY);
    assert!((value("1 kN/mm^1.5") / 1e3 / 1e4_f64.powf(1.125) - 1.0).abs() < 1e-15); // measured 2e-16
}

#[test]
fn what_is_no_quantity_is_refused() {
    use QuantityError as E;
    let kind = |text: &str| Quantity::parse(text).unwrap_err();
    for text in ["", "  ", "m", "NaN kg", "inf kg", "-inf m", "- 3 m", "e5 m", "abc", "٣ m"] {
        let error = kind(text);
        let refused = matches!(error, E::NoNumber { .. } | E::UnknownUnit { .. });
        assert!(refused, "{text}: {error:?}");
    }
    for text in ["1e400 kg", "1e99999999999999999999 m", "1e308 km"] {
        assert!(matches!(kind(text), E::Overflow { .. }), "{text}: {:?}", kind(text));
    }
    for text in ["3", " 3.5 ", "-1e5"] {
        assert!(matches!(kind(text), E::NoUnit { .. }), "{text}");
    }
    for text in ["3 furlong", "3 M", "3 CM", "3 kilo", "3 N//m x", "3 m\u{0}", "0x10 m"] {
        let refused = matches!(kind(text), E::UnknownUnit { .. } | E::Malformed { .. });
        assert!(refused, "{text}");
    }
    for text in [
        "3 m^",
        "3 m^0",
        "3 m^7",
        "3 m^0.3",
        "3 m^2^2",
        "3 (m",
        "3 m)",
        "3 m//s",
        "3 /s",
        "3 m*",
        "3 ()",
        "1,5 m",
        "3 m 4",
        "3 N/m s",
        "3 m^-",
        "((((((((((3 m))))))))))",
        "3 ((((((((((m))))))))))",
        "3 (((m^6)^6)^6)",
    ] {
        let refused = matches!(kind(text), E::Malformed { .. } | E::NoNumber { .. });
        assert!(refused, "{text}: {:?}", kind(text));
    }
    assert!(matches!(kind(&format!("3 {}", "m ".repeat(500))), E::Malformed { .. }));
}

#[test]
fn a_tiny_quantity_becomes_zero_and_not_an_error() {
    assert_eq!(value("1e-400 m"), 0.0);
    assert_eq!(value("5e-324 m"), 5e-324);
}

fn dimension() -> impl Strategy<Value = Dimension> {
    prop::sample::select(vec![
        Dimension::LENGTH,
        Dimension::MASS,
        Dimension::TIME,
        Dimension::ANGLE,
        Dimension::ACCELERATION,
        Dimension::SPIN,
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
    ])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn printing_and_reading_keep_every_bit(value in prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO, dimension in dimension()) {
        let text = Quantity { value, dimension }.to_string();
        let again = Quantity::parse(&text).unwrap();
        prop_assert_eq!(again.value.to_bits(), value.to_bits(), "{}", text);
        prop_assert_eq!(again.dimension, dimension, "{}", text);
    }

    #[test]
    fn centimeters_are_the_nearest_double(cents in -1_000_000_000_i64..1_000_000_000) {
        let text = format!("{cents} cm");
        let nearest: f64 = format!("{cents}e-2").parse().unwrap();
        prop_assert_eq!(Quantity::parse(&text).unwrap().value, nearest);
    }

    #[test]
    fn no_text_panics(text in ".{0,80}") {
        let _ = Quantity::parse(&text);
    }

    #[test]
    fn no_text_of_unit_letters_panics(text in "[-+]?[0-9.]{0,6}(e[0-9]{1,4})? ?[mskgNradfttin%() */^·.0-9-]{0,40}") {
        if let Ok(quantity) = Quantity::parse(&text) {
            prop_assert!(quantity.value.is_finite());
        }
    }
}
