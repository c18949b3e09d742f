//! When and where a channel was recorded is kept, and channels of one record begin together.

#![allow(clippy::unwrap_used, reason = "a test fails by unwrap")]

use std::io::Write as _;
use std::path::Path;

use barrelstack_motion::{AccelerationUnit, ReadOptions, Record, Site, read, write};

fn options() -> ReadOptions {
    ReadOptions { unit: Some(AccelerationUnit::G), time_step: None, sensitivity: Some(1000.0) }
}

fn sample(file: &str) -> Record {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(file);
    read(&std::fs::read(path).unwrap(), file, &options()).unwrap()
}

fn shared(file: &str) -> Option<Record> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/ground-motions");
    if !folder.is_dir() {
        // Straight to stderr: the test runner swallows what a passing test prints.
        let _ = writeln!(std::io::stderr(), "SKIPPED: {} is not there", folder.display());
        return None;
    }
    Some(read(&std::fs::read(folder.join(file)).unwrap(), file, &options()).unwrap())
}

fn start(record: &Record) -> String {
    record.channels[0].start.map_or("none".to_owned(), |start| start.to_string())
}

#[test]
fn starts_are_universal_time_whatever_the_clock_of_the_agency() {
    // Japan time less nine hours and the recorder's fifteen seconds; Taiwan time less eight hours.
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
fn headers_of_the_agencies_tell_start_and_place() {
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
        // Five seconds of pad before 11:02:19.715.
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
        // The day after the event.
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
    // One channel of another station: a line for each.
    record.channels[1].site = Site { station: "Elsewhere".to_owned(), ..Site::default() };
    record.channels[2].start = None;
    same(&record, &read_back(&record));
    let broken = write::text(&record).unwrap().replace("vs30 330", "vs30 soft");
    let error = read(broken.as_bytes(), "broken.txt", &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("vs30"), "{error}");
}
