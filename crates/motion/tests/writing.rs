//! Written files read back, whatever texts they contain.

use barrelstack_motion::write::{self, archive, at2, csv, npz};
use barrelstack_motion::{Channel, Direction, ReadOptions, Record, Stage, read};

/// Returns a record with reserved header words in every text.
fn hostile(channels: Vec<Channel>) -> Record {
    let example = include_bytes!("data/barrelstack/example.txt");
    let mut record = read(example, "a, b (c).csv", &ReadOptions::default()).unwrap();
    record.event = String::from("NPTS= 3, DT= 9 SEC (spectrum), units of cm/s\nvelocity");
    record.station = String::from("# unit: g, \u{3b1} displacement; 1 2 3");
    record.channels = channels;
    record.notes = vec![
        "processing: response spectrum in units of g, NPTS, DT".to_owned(),
        "# time_step: 7\r\n1.0 2.0 3.0".to_owned(),
        "acceleration (cm/s2), counts per degree".to_owned(),
    ];
    record
}

fn channel(name: &str, direction: Direction) -> Channel {
    // Subnormal, tiny, negative zero and long fractions must be preserved.
    let values = vec![1.0 / 3.0, -0.0, 5e-324, -2.5e-9, 12.25, -1.0 / 7.0, 0.0];
    Channel::new(name, direction, 0.1 / 3.0, values)
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn text_reads_back_bit_for_bit_whatever_the_header_says() {
    let record = hostile(vec![
        channel("a, (b); #c", Direction::horizontal(33.3)),
        channel("a, (b); #c", Direction::up()),
        channel("", Direction::some_horizontal()),
    ]);
    let text = write::text(&record).unwrap();
    let again = read(text.as_bytes(), "again.txt", &ReadOptions::default()).unwrap();
    assert_eq!(again.stage, Stage::Corrected);
    assert_eq!(again.channels.len(), 3);
    for (old, new) in record.channels.iter().zip(&again.channels) {
        assert_eq!(bits(&old.acceleration), bits(&new.acceleration));
        assert_eq!(old.time_step.to_bits(), new.time_step.to_bits());
        assert_eq!(old.direction, new.direction);
    }
    let names: Vec<&str> = again.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["a b c", "a b c 2", "channel 3"]);
    assert_eq!(again.notes.len(), 3);
    // Writing again gives the same file; the history is not duplicated.
    assert_eq!(write::text(&again).unwrap().lines().count(), text.lines().count());
}

#[test]
fn csv_reads_back_whatever_the_header_says() {
    let record =
        hostile(vec![channel("N28W", Direction::parse("N28W")), channel("UP", Direction::up())]);
    let text = csv(&record).unwrap();
    let again = read(text.as_bytes(), "again.csv", &ReadOptions::default()).unwrap();
    for (old, new) in record.channels.iter().zip(&again.channels) {
        assert_eq!(bits(&old.acceleration), bits(&new.acceleration));
        // Times are rounded to a nanosecond: measured 2e-9.
        assert!((new.time_step / old.time_step - 1.0).abs() < 1e-8, "{}", new.time_step);
        assert_eq!(old.direction, new.direction);
    }
}

#[test]
fn at2_reads_back_whatever_the_header_says() {
    for (name, direction) in [
        ("N28W", Direction::parse("N28W")),
        ("a name, far too long (for this)", Direction::horizontal(44.4)),
        ("velocity", Direction::up()),
        ("", Direction::default()),
    ] {
        let record = hostile(vec![channel(name, direction)]);
        let text = at2(&record).unwrap();
        assert!(text.is_ascii());
        let again = read(text.as_bytes(), "again.at2", &ReadOptions::default()).unwrap();
        let (old, new) = (&record.channels[0], &again.channels[0]);
        assert_eq!(old.time_step.to_bits(), new.time_step.to_bits());
        assert_eq!(new.direction.azimuth, direction.azimuth, "{name}");
        assert_eq!(new.is_vertical(), old.is_vertical(), "{name}");
        for (a, b) in old.acceleration.iter().zip(&new.acceleration) {
            // Numbers have eight digits: half a unit of the last is 5e-8 of a number that starts
            // with 1.
            assert!((a - b).abs() <= 5.1e-8 * a.abs() + 1e-97, "{a} {b}");
        }
    }
}

#[test]
fn at2_has_columns_of_fifteen() {
    let record = hostile(vec![channel("90", Direction::horizontal(90.0))]);
    let text = at2(&record).unwrap();
    let rows: Vec<&str> = text.lines().skip(4).collect();
    assert_eq!(rows.iter().map(|row| row.len()).collect::<Vec<_>>(), [75, 30]);
    assert!(at2(&hostile(vec![])).is_err());
}

#[test]
fn channels_of_different_steps_are_refused() {
    let mut other = channel("UP", Direction::up());
    other.time_step = 0.02;
    let record = hostile(vec![channel("90", Direction::horizontal(90.0)), other]);
    for error in [write::text(&record).err(), csv(&record).err(), npz(&record).err()] {
        assert!(error.unwrap().to_string().contains("one component at a time"));
    }
}

#[test]
fn a_long_past_leaves_room_for_the_numbers() {
    let mut record = hostile(vec![channel("90", Direction::horizontal(90.0))]);
    record.notes = (0..500).map(|k| format!("step {k}")).collect();
    for written in [write::text(&record).unwrap(), csv(&record).unwrap()] {
        assert!(written.contains("step 499"));
        let again = read(written.as_bytes(), "again", &ReadOptions::default()).unwrap();
        assert_eq!(again.channels[0].acceleration.len(), 7);
    }
}

#[test]
fn a_name_that_occurs_twice_is_refused() {
    let twice = [("a".to_owned(), &[1.0][..]), ("a".to_owned(), &[2.0][..])];
    assert!(archive(&twice).is_err_and(|error| error.to_string().contains("named a")));
    assert!(archive(&twice[1..]).is_ok());
}
