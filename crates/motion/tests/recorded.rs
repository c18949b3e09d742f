//! Time and place of recordings are kept, and the channels of a record are aligned.

use crate::shared;
use std::path::Path;

use barrelstack_motion::{
    AccelerationUnit, Channel, Direction, Instrument, Processing, Quantity, ReadOptions, Record,
    Refusal, Site, Stage, Utc, read, station_xml, write,
};

fn options() -> ReadOptions {
    ReadOptions {
        unit: Some(AccelerationUnit::G),
        time_step: None,
        sensitivity: Some(1000.0),
        ..ReadOptions::default()
    }
}

fn sample(file: &str) -> Record {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(file);
    read(&std::fs::read(path).unwrap(), file, &options()).unwrap()
}

fn shared(file: &str) -> Option<Record> {
    let path = shared::shared(file)?;
    Some(read(&std::fs::read(path).unwrap(), file, &options()).unwrap())
}

fn start(record: &Record) -> String {
    record.channels[0].start.map_or("none".to_owned(), |start| start.to_string())
}

#[test]
fn starts_are_universal_time_whatever_the_clock_of_the_agency() {
    // Japan time minus nine hours and the recorder's fifteen seconds; Taiwan time minus eight
    // hours.
    for (file, expected) in [
        ("knet/example.EW", "1903-01-02T10:51:28.000Z"),
        ("cwa/example.dat", "1903-01-02T15:50:29.000Z"),
        ("miniseed/steim1.mseed", "2003-01-02T01:02:00.000Z"),
        ("peer/nga-west2.AT2", "none"),
        ("renadic/example.v1", "none"),
    ] {
        assert_eq!(start(&sample(file)), expected, "{file}");
    }
}

#[test]
fn headers_of_the_agencies_state_start_and_place() {
    for (file, expected, north, east, elevation) in [
        ("csmip-v1/CICCC.RAW", "2019-07-06T03:19:37.000Z", 35.525, -117.365, None),
        ("csmip-v1/LA116TH.RAW", "1994-01-17T12:31:04.100Z", 33.929, -118.26, None),
        ("csmip-v2/CE58667.V2", "2014-08-24T10:20:33.000Z", 37.973, -122.038, None),
        (
            "cosmos/Cosmos12TimeSeriesTest.v1",
            "2005-06-16T20:53:04.400Z",
            34.046,
            -117.035,
            Some(15.0),
        ),
        ("smc/2516b_a.smc", "2011-08-23T17:50:56.000Z", 38.951_099, -77.335_861, None),
        ("smc/0111a.smc", "none", 37.728, -122.385, None),
        (
            "geonet/20190430_064319_INHS_21.V1A",
            "2019-04-30T06:42:39.000Z",
            -39.1561,
            174.1906,
            None,
        ),
        // A pad of five seconds precedes 11:02:19.715.
        (
            "geonet/20161113_110259_WTMC_20.V2A",
            "2016-11-13T11:02:14.715Z",
            -42.6194,
            173.0536,
            None,
        ),
        (
            "afad/20170720223109_0921.txt",
            "2017-07-20T22:30:58.000Z",
            37.8747,
            27.592_23,
            Some(66.0),
        ),
        ("bhrc/5526-1.V1", "none", 37.734, 47.801, Some(2026.0)),
        // The first sample is on the day after the event.
        ("unam/CUP50401.012", "2004-01-02T00:00:01.000Z", 19.330_24, -99.181_076, Some(2240.0)),
        ("usc/017m30cc.y0a", "none", 34.419_17, -118.426_11, None),
        ("knet/AOM0011801241951.EW", "2018-01-24T10:51:28.000Z", 41.5267, 140.9244, Some(39.0)),
        (
            "sac/20190706031952.CJ.T001230.HNE.sac",
            "2019-07-06T03:19:52.000Z",
            34.063_69,
            -118.336_33,
            Some(0.0),
        ),
        (
            "esm/HL.DLFA..HNE.D.20190728.160908.C.ACC.ASC",
            "2019-07-28T16:09:05.700Z",
            38.478_36,
            22.495_83,
            Some(570.0),
        ),
    ] {
        let Some(record) = shared(file) else { return };
        assert_eq!(start(&record), expected, "{file}");
        for channel in &record.channels {
            let site = &channel.site;
            let (found, other) = (site.latitude.unwrap(), site.longitude.unwrap());
            assert!(
                (found - north).abs() < 1e-4 && (other - east).abs() < 1e-4,
                "{file}: {site:?}"
            );
            assert_eq!(site.elevation, elevation, "{file}");
            assert_eq!(site.station, record.station, "{file}");
        }
    }
    assert_eq!(shared("csmip-v2/CE58667.V2").unwrap().station, "Concord - Clayton & Ellis");
    assert_eq!(shared("smc/0111a.smc").unwrap().station, "San Francisco, 1295 Shafter, F");
}

#[test]
fn our_own_text_keeps_start_and_place() {
    let mut record = sample("afad/example.txt");
    let start = "2014-08-24T10:20:33.000125Z".parse().ok();
    for channel in &mut record.channels {
        channel.start = start;
        channel.site.latitude = Some(38.27);
        channel.site.longitude = Some(-122.0 - 1.0 / 3.0);
        channel.site.vs30 = Some(330.0);
        channel.site.sensor = "basement".to_owned();
    }
    let read_back = |record: &Record| {
        let text = write::text(record).unwrap();
        read(text.as_bytes(), "again.txt", &ReadOptions::default()).unwrap()
    };
    let same = |one: &Record, two: &Record| {
        for (a, b) in one.channels.iter().zip(&two.channels) {
            assert_eq!((a.start, &a.site), (b.start, &b.site));
        }
    };
    same(&record, &read_back(&record));
    // One channel belongs to another station, so there is one line per channel.
    record.channels[1].site = Site { station: "Elsewhere".to_owned(), ..Site::default() };
    record.channels[2].start = None;
    same(&record, &read_back(&record));
    let broken = write::text(&record).unwrap().replace("vs30 330", "vs30 soft");
    let error = read(broken.as_bytes(), "broken.txt", &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("vs30"), "{error}");
}

/// Returns a record of one synthetic channel: a wave of ten seconds at 100 Hz that begins `late`
/// seconds after the full minute.
fn wave(name: &str, late: f64, seconds: u32) -> Record {
    let mut record = sample("barrelstack/example.txt");
    let origin: Utc = "2014-08-24T10:20:00.000Z".parse().unwrap();
    let values = (0..100 * seconds).map(|k| motion_at(late + f64::from(k) / 100.0)).collect();
    let mut channel = Channel::new(name, Direction::parse(name), 0.01, values);
    channel.start = Some(origin.later(late));
    record.channels = vec![channel];
    record.file = format!("{name}.txt");
    record
}

fn motion_at(t: f64) -> f64 {
    (2.0 * t).sin() + 0.3 * (37.0 * t).cos()
}

#[test]
fn channels_that_begin_apart_are_cut_to_their_common_span() {
    let gathered = Record::gather(&[wave("N", 20.0, 30), wave("E", 0.0, 40)]).unwrap();
    let [north, east] = gathered.channels.as_slice() else { panic!("two channels") };
    // Both channels last from 20 to 39.99 s after the full minute and contain the same wave.
    assert_eq!(north.acceleration.len(), 2000);
    assert_eq!(east.acceleration.len(), 2000);
    assert_eq!(north.start, east.start);
    let off = north.acceleration.iter().zip(&east.acceleration).map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, f64::max) < 1e-12); // measured 8.2e-14
    let notes = gathered.notes.join("\n");
    assert!(notes.contains("channel E begins 20.0000 s before N: 2000 samples outside"), "{notes}");
    assert!(notes.contains("channel N: 1000 samples outside"), "{notes}");
}

#[test]
fn parts_of_a_step_are_shifted() {
    let gathered = Record::gather(&[wave("N", 0.0, 20), wave("E", 1.0036, 20)]).unwrap();
    let [north, east] = gathered.channels.as_slice() else { panic!("two channels") };
    assert_eq!(north.start, east.start);
    let n = east.acceleration.len().min(north.acceleration.len());
    assert!((1898..=1901).contains(&n), "{n}");
    // Compared away from the ends, where the interpolation is less accurate; measured 2.3e-6.
    let off = north.acceleration[..n].iter().zip(&east.acceleration).map(|(a, b)| (a - b).abs());
    let worst = off.skip(32).take(n - 64).fold(0.0, f64::max);
    assert!(worst < 4e-6, "{worst:e}");
    assert!(gathered.notes.join("\n").contains("shifted by 0.360 of a step"));
}

#[test]
fn channels_without_a_common_span_are_refused() {
    let error = Record::gather(&[wave("N", 0.0, 10), wave("E", 20.0, 10)]).unwrap_err();
    assert!(error.to_string().contains("no common time span"), "{error}");
}

/// Returns the sample file with another channel letter, second of the start, and location.
fn seed(letter: u8, second: u8, location: [u8; 2]) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/miniseed/int32.mseed");
    let mut bytes = std::fs::read(path).unwrap();
    let length = 1 << bytes[54];
    for record in bytes.chunks_mut(length) {
        record[13..15].copy_from_slice(&location);
        record[17] = letter;
        record[26] += second;
    }
    bytes
}

#[test]
fn channels_of_one_seed_file_begin_together() {
    let whole = read(&seed(b'E', 0, *b"00"), "one.mseed", &options()).unwrap();
    let count = whole.channels[0].acceleration.len();
    let both = [seed(b'E', 0, *b"00"), seed(b'N', 1, *b"00")].concat();
    let record = read(&both, "both.mseed", &options()).unwrap();
    for channel in &record.channels {
        // The second channel begins a hundred samples later.
        assert_eq!(channel.acceleration.len(), count - 100);
        assert_eq!(start(&record), "2003-01-02T01:02:01.000Z");
    }
    assert!(record.notes.join("\n").contains("begins 1.0000 s before"));
    let apart = [seed(b'E', 0, *b"00"), seed(b'N', 50, *b"00")].concat();
    let error = read(&apart, "apart.mseed", &options()).unwrap_err();
    assert!(error.to_string().contains("no common time span"), "{error}");
    // Two sensors in one file are read but not combined.
    let sensors = [seed(b'E', 0, *b"00"), seed(b'N', 0, *b"10")].concat();
    let record = read(&sensors, "sensors.mseed", &options()).unwrap();
    assert_eq!(record.station, "ZZ.XXXX");
    let error = record.horizontal_pair().unwrap_err().to_string();
    assert!(error.contains("sensor \"00\" and sensor \"10\""), "{error}");
    let mixed = Record { mixed: true, ..record };
    assert!(mixed.horizontal_pair().is_ok());
    // Some programs print a placeholder for an empty location code.
    let empty = read(&seed(b'E', 0, *b"--"), "empty.mseed", &options()).unwrap();
    assert_eq!(empty.channels[0].site.sensor, "");
}

#[test]
fn files_of_other_stations_sensors_events_and_publishers_are_not_combined() {
    let refused = |one: &Record, other: &Record, word: &str| {
        let error = Record::gather(&[one.clone(), other.clone()]).unwrap_err().to_string();
        assert!(error.contains(word), "{word}: {error}");
    };
    let one = sample("knet/example.EW");
    let mut other = one.clone();
    other.channels[0].site.station = "XXX002".to_owned();
    refused(&one, &other, "station \"XXX002\"");
    refused(&one, &sample("knet/borehole.NS1"), "sensor \"surface\" and sensor \"borehole\"");
    let one = sample("peer/nga-west2.AT2");
    let other = Record { event: "Another, 1/2/1903".to_owned(), ..one.clone() };
    refused(&one, &other, "Another");
    let copy = Record { stage: Stage::Raw, ..one.clone() };
    refused(&one, &copy, "corrected and raw");
    let copy = Record { format: "smc", ..one.clone() };
    refused(&one, &copy, "formats peer and smc");
    // At the caller's request they are combined, and a warning says so.
    let mixed = Record::gather_mixed(&[one.clone(), copy]).unwrap();
    assert!(mixed.mixed && mixed.warnings.iter().any(|w| w.message.contains("combined although")));
    // AT2 cannot represent commas and parentheses; the event is the same.
    let named = Record {
        event: "Somewhere, Valley (M 6.1), \u{d1}u\u{f1}oa".to_owned(),
        ..wave("N", 0.0, 10)
    };
    let mut east = named.clone();
    east.channels[0].name = "E".to_owned();
    let copy = read(write::at2(&east).unwrap().as_bytes(), "e.at2", &options()).unwrap();
    let copy = Record { stage: named.stage, ..copy };
    assert!(Record::gather(&[named, copy]).is_ok());
    let unnamed = Record { event: String::new(), station: String::new(), ..wave("N", 0.0, 10) };
    let again = read(write::at2(&unnamed).unwrap().as_bytes(), "n.at2", &options()).unwrap();
    assert_eq!((again.event.as_str(), again.station.as_str()), ("", ""));
    let kin = Record::gather(&[one, sample("peer/cut-header.AT2")]).unwrap();
    assert!(kin.notes.join("\n").contains("assumed to be simultaneous"));
}

#[test]
fn measures_of_both_horizontals_need_directions_that_are_known_and_perpendicular() {
    let pair = |a: &str, b: &str| {
        let mut record = wave("N", 0.0, 10);
        let values = record.channels[0].acceleration.clone();
        let channel = |name: &str| Channel::new(name, Direction::parse(name), 0.01, values.clone());
        record.channels = vec![channel(a), channel(b)];
        record.horizontals(&Processing::none()).map(|_| ()).map_err(|error| error.to_string())
    };
    for (a, b) in [("N", "E"), ("L", "T"), ("N28W", "S62W"), ("4", "90"), ("HN1", "HN2")] {
        assert_eq!(pair(a, b), Ok(()), "{a} {b}");
    }
    assert!(pair("N", "column 2").unwrap_err().contains("whether channel \"column 2\""));
    assert!(pair("N", "S").unwrap_err().contains("not perpendicular"));
    assert!(pair("0", "30").unwrap_err().contains("not perpendicular"));
    assert!(pair("N", "UP").unwrap_err().contains("two horizontal components"));
}

const STATION_XML: &str = include_str!("data/stationxml/example.xml");

#[test]
fn station_xml_gives_each_channel_its_sensitivity_direction_and_place() {
    let bytes = seed(b'E', 0, *b"00");
    let by_number = read(&bytes, "a.mseed", &options()).unwrap();
    let instruments = station_xml(STATION_XML).unwrap();
    assert_eq!(instruments.len(), 3);
    let known = ReadOptions { instruments, ..ReadOptions::default() };
    let record = read(&bytes, "a.mseed", &known).unwrap();
    let (one, two) = (&by_number.channels[0], &record.channels[0]);
    // The sensitivity valid at the time of the record (2000, not 1) overrides the 1000 of the options.
    assert!((two.pga() / one.pga() - 0.5).abs() < 1e-12);
    assert_eq!(two.direction.azimuth, Some(85.5));
    assert_eq!((two.site.latitude, two.site.elevation), (Some(38.5), Some(697.0)));
    // Another location code identifies another channel.
    let error = read(&seed(b'E', 0, *b"10"), "a.mseed", &known).unwrap_err();
    assert!(error.to_string().contains("a sensitivity for channel HNE"), "{error}");
    assert!(station_xml("<FDSNStationXML>").is_err());
}

#[test]
fn channels_of_seismometers_are_refused_or_differentiated() {
    let mut bytes = seed(b'E', 0, *b"00");
    let length = 1 << bytes[54];
    for record in bytes.chunks_mut(length) {
        record[16] = b'H';
    }
    let error = read(&bytes, "a.mseed", &options()).unwrap_err().to_string();
    assert!(error.contains("HHE, which records velocity (a high-gain seismometer)"), "{error}");
    let known =
        ReadOptions { instruments: station_xml(STATION_XML).unwrap(), ..ReadOptions::default() };
    // Metadata that state m/s are sufficient; no option is needed.
    let stated = read(&bytes, "a.mseed", &known).unwrap();
    assert!(stated.warnings.iter().any(|w| w.message.contains("velocity sensor")));
    let both = [bytes.clone(), seed(b'E', 0, *b"00")].concat();
    let record = read(&both, "both.mseed", &known).unwrap();
    assert_eq!(record.channels.len(), 1);
    assert!(record.warnings.iter().any(|w| w.message.ends_with("were ignored: HHE")));
    let recorded_as = |quantity| ReadOptions { recorded: Some(quantity), ..options() };
    let velocity = read(&bytes, "a.mseed", &recorded_as(Quantity::Velocity)).unwrap();
    assert!(velocity.notes.join("\n").contains("velocity differentiated once"));
    let plain = read(&bytes, "a.mseed", &recorded_as(Quantity::Acceleration)).unwrap();
    // Integrating the result gives the recorded velocity, except for a constant and half a step.
    let again: Vec<f64> = velocity.channels[0]
        .acceleration
        .iter()
        .scan(0.0, |sum, a| {
            *sum += a * 0.01;
            Some(*sum)
        })
        .collect();
    let recorded = &plain.channels[0].acceleration;
    let shift = |k: usize| f64::midpoint(recorded[k], recorded[k + 1]) - again[k];
    let spread = (1..recorded.len() - 2).map(|k| (shift(k) - shift(1)).abs()).fold(0.0, f64::max);
    assert!(spread < 2e-3 * plain.channels[0].pga(), "{spread}"); // measured 9.7e-4
}

/// Returns the metadata of one channel with a sensitivity in the given input unit, and with further
/// lines.
fn metadata(value: &str, unit: &str, more: &str) -> Vec<Instrument> {
    let text = format!(
        "<?xml version=\"1.0\"?><FDSNStationXML><Network code=\"ZZ\"><Station code=\"XXXX\">\
         <Channel code=\"HNE\" locationCode=\"00\">{more}<Response><InstrumentSensitivity>\
         <Value>{value}</Value><InputUnits><Name>{unit}</Name></InputUnits>\
         </InstrumentSensitivity></Response></Channel></Station></Network></FDSNStationXML>"
    );
    station_xml(&text).unwrap()
}

#[test]
fn sensitivities_are_taken_in_the_unit_that_the_metadata_state() {
    let bytes = seed(b'E', 0, *b"00");
    let with = |instruments| {
        read(&bytes, "a.mseed", &ReadOptions { instruments, ..ReadOptions::default() })
    };
    let right = with(metadata("427819", "M/S**2", "")).unwrap().channels[0].pga();
    for (value, unit) in [
        ("4278.19", "CM/S**2"),
        ("4278.19", "gal"),
        ("427.819", "mm/s^2"),
        ("0.000427819", "nm/s**2"),
        ("4195471.19635", "g"),
        ("427819", "m/s/s"),
    ] {
        let pga = with(metadata(value, unit, "")).unwrap().channels[0].pga();
        assert!((pga / right - 1.0).abs() < 1e-9, "{unit}: {pga} {right}");
    }
    for unit in ["PA", "V", "rad/s", ""] {
        let error = with(metadata("427819", unit, "")).unwrap_err();
        assert_eq!(error.refusal, Refusal::NotAcceleration, "{unit}: {error}");
        assert!(error.to_string().contains("input unit"), "{error}");
    }
}

#[test]
fn metadata_that_contradict_each_other_are_refused_with_both_sensitivities() {
    let bytes = seed(b'E', 0, *b"00");
    let with = |second| {
        let instruments = [metadata("1000", "m/s**2", ""), metadata(second, "m/s**2", "")].concat();
        read(&bytes, "a.mseed", &ReadOptions { instruments, ..ReadOptions::default() })
    };
    assert!(with("1000.1").is_ok());
    let error = with("2000").unwrap_err().to_string();
    assert!(error.contains("found 1000 and 2000 counts") && error.contains("HNE"), "{error}");
}

#[test]
fn polarity_and_dip_of_metadata_are_kept() {
    let bytes = seed(b'E', 0, *b"00");
    let with = |value, more| {
        let instruments = metadata(value, "m/s**2", more);
        read(&bytes, "a.mseed", &ReadOptions { instruments, ..ReadOptions::default() }).unwrap()
    };
    let plain = with("1000", "<Azimuth>90</Azimuth><Dip>0.5</Dip>");
    assert_eq!(plain.channels[0].direction.azimuth, Some(90.0));
    let turned: Vec<f64> = plain.channels[0].acceleration.iter().map(|a| -a).collect();
    assert_eq!(with("-1000", "").channels[0].acceleration, turned);
    // With a dip of 90 degrees, positive counts point down and are reversed.
    let down = with("1000", "<Azimuth>0</Azimuth><Dip>90</Dip>");
    assert!(down.channels[0].is_vertical());
    assert_eq!(down.channels[0].acceleration, turned);
    let inclined = with("1000", "<Azimuth>0</Azimuth><Dip>-35.3</Dip>");
    assert_eq!(inclined.channels[0].direction, Direction::default());
}

#[test]
fn metadata_of_another_time_are_named_where_a_sensitivity_is_missing() {
    let mut instruments = metadata("1000", "m/s**2", "");
    instruments[0].epoch.0 = "2020-01-01T00:00:00".parse().ok();
    let known = ReadOptions { instruments, ..ReadOptions::default() };
    let error = read(&seed(b'E', 0, *b"00"), "a.mseed", &known).unwrap_err().to_string();
    assert!(error.contains("ZZ.XXXX.00.HNE at 2003-01-02T01:02:00.000Z among 1"), "{error}");
}

/// Returns a hundred data records of ten samples at 100 Hz, each delayed by another `late` (1e-4
/// s).
fn records_late(late: u32) -> Vec<u8> {
    let one = seed(b'E', 0, *b"00");
    let mut record = one[..1 << one[54]].to_vec();
    record[30..32].copy_from_slice(&10_u16.to_be_bytes());
    (0..100)
        .flat_map(|k| {
            let mut next = record.clone();
            let fractions = k * (1000 + late);
            next[26] = u8::try_from(fractions / 10_000).unwrap();
            let rest = u16::try_from(fractions % 10_000).unwrap();
            next[28..30].copy_from_slice(&rest.to_be_bytes());
            next
        })
        .collect()
}

#[test]
fn gaps_shorter_than_a_sample_do_not_add_up_unnoticed() {
    let whole = read(&records_late(0), "g0.mseed", &options()).unwrap();
    assert_eq!(whole.channels[0].acceleration.len(), 1000);
    for late in [5, 55, 70] {
        let error = read(&records_late(late), "gaps.mseed", &options()).unwrap_err();
        assert!(error.to_string().contains("gaps of 0.0"), "{late}: {error}");
    }
    // Data records in another order, with one of them repeated.
    let bytes = records_late(0);
    let length = bytes.len() / 100;
    let turned = [&bytes[50 * length..], &bytes[..51 * length]].concat();
    let record = read(&turned, "turned.mseed", &options()).unwrap();
    assert_eq!(record.channels[0].acceleration, whole.channels[0].acceleration);
    assert!(record.warnings.iter().any(|w| w.message.contains("1 data records that repeat")));
}

#[test]
fn steps_of_sac_files_are_the_shortest_decimal_of_what_is_stored() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/sac/little.sac");
    let mut bytes = std::fs::read(path).unwrap();
    for (stored, step) in [
        (1.0_f32 / 1024.0, 1.0 / 1024.0),
        (1.0 / 256.0, 1.0 / 256.0),
        (1.0 / 300.0, 0.003_333_333_4),
        (0.02, 0.02),
        (0.01, 0.01),
        (0.005, 0.005),
    ] {
        bytes[..4].copy_from_slice(&stored.to_le_bytes());
        let record = read(&bytes, "a.sac", &options()).unwrap();
        assert_eq!(record.channels[0].time_step, step, "{stored}");
    }
}

#[test]
fn dates_of_first_samples_are_read_as_esm_and_tadas_write_them() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/esm/example.ACC.ASC");
    let text = std::fs::read_to_string(path).unwrap();
    let key = "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS";
    let line = "EVENT_DATE_YYYYMMDD: 19030102";
    let with = |date: &str| {
        let file = text.replace(line, &format!("{line}\n{key}: {date}"));
        read(file.as_bytes(), "a.ASC", &options()).unwrap()
    };
    for date in [
        "20201030_115124.500",
        "2020/10/30 11:51:24.500000",
        "2020-10-30T11:51:24.5",
        "30/10/2020 11:51:24.500",
        "2020/10/30_11:51:24.500",
    ] {
        assert_eq!(start(&with(date)), "2020-10-30T11:51:24.500Z", "{date}");
    }
    let unread = with("on a Friday");
    assert_eq!(start(&unread), "none");
    assert!(unread.warnings.iter().any(|w| w.message.contains("is not a valid date and time")));
}
