//! Archives: what NPZ keeps is read back, and one record inside gzip or zip is read as if it lay open.

#![allow(clippy::unwrap_used, reason = "a test fails by unwrap")]

use std::io::{Cursor, Write as _};
use std::path::Path;

use barrelstack_motion::{Channel, Direction, ReadOptions, Record, Refusal, bundled, read, write};

fn bytes(file: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(file)).unwrap()
}

fn given(bytes: &[u8], name: &str) -> Record {
    read(bytes, name, &ReadOptions::default()).unwrap()
}

#[test]
fn an_npz_gives_the_record_back_bit_for_bit() {
    let mut record = given(&bytes("barrelstack/example.txt"), "example.txt");
    record.station = "\u{d6}rnek, station 1".to_owned();
    record.notes = vec!["licence: CC0".to_owned(), "processing: high-pass at 0.1 Hz".to_owned()];
    let mut odd = Channel::new("a b-c", Direction::default(), 0.01, Vec::new());
    odd.acceleration = record.channels[0].acceleration.iter().map(|a| a / 3.0).collect();
    odd.initial_velocity = 0.25;
    odd.start = "2014-08-24T10:20:33.000Z".parse().ok();
    odd.site.vs30 = Some(330.0);
    odd.site.station.clone_from(&record.station);
    record.channels.push(odd);
    for channel in &mut record.channels {
        channel.site.station.clone_from(&record.station);
    }
    let again = given(&write::npz(&record).unwrap(), "again.npz");
    assert_eq!(again.channels, record.channels);
    assert_eq!((again.station, again.event), (record.station, record.event));
    assert_eq!((again.stage, again.notes), (record.stage, record.notes));
    let napa = bundled("napa-college-2014").unwrap();
    let again = given(&write::npz(&napa).unwrap(), "napa.npz");
    assert_eq!(again.channels, napa.channels);
}

#[test]
fn an_archive_of_other_arrays_is_refused() {
    let other = write::archive(&[("a".to_owned(), [1.0, 2.0].as_slice())]).unwrap();
    let error = read(&other, "other.npz", &ReadOptions::default()).unwrap_err();
    assert_eq!(error.refusal, Refusal::Unrecognized);
    assert!(error.to_string().contains("named channels"), "{error}");
    let record = given(&bytes("barrelstack/example.txt"), "example.txt");
    let mut cut = write::npz(&record).unwrap();
    cut.truncate(cut.len() / 2);
    assert_eq!(
        read(&cut, "cut.npz", &ReadOptions::default()).unwrap_err().refusal,
        Refusal::Damaged
    );
}

fn gzipped(bytes: &[u8]) -> Vec<u8> {
    let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    out.write_all(bytes).unwrap();
    out.finish().unwrap()
}

fn zipped(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut out = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let deflated = zip::write::SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Deflated);
    for (name, bytes) in files {
        out.start_file(*name, deflated).unwrap();
        out.write_all(bytes).unwrap();
    }
    out.finish().unwrap().into_inner()
}

#[test]
fn one_record_inside_gzip_or_zip_is_read() {
    for file in ["peer/nga-west2.AT2", "knet/example.EW", "geonet/example.V2A"] {
        let plain = bytes(file);
        let open = given(&plain, file);
        let name = file.rsplit('/').next().unwrap();
        let gz = given(&gzipped(&plain), &format!("{file}.gz"));
        let zip = given(&zipped(&[("folder/", b""), (name, plain.as_slice())]), "record.zip");
        assert_eq!((&gz.channels, &zip.channels), (&open.channels, &open.channels), "{file}");
        assert_eq!((gz.format, zip.format), (open.format, open.format));
        assert_eq!(zip.file, "record.zip");
    }
}

#[test]
fn archives_that_hold_no_single_record_are_refused_in_words() {
    let refused = |bytes: &[u8], word: &str| {
        let error = read(bytes, "packed", &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains(word), "{word}: {error}");
    };
    let at2 = bytes("peer/nga-west2.AT2");
    refused(
        &zipped(&[("a.AT2", at2.as_slice()), ("b.AT2", at2.as_slice())]),
        "2 files (a.AT2, b.AT2)",
    );
    refused(&zipped(&[]), "expected");
    let gz = gzipped(&at2);
    refused(&gz[..gz.len() / 2], "can be unpacked");
    // 200 MB of zeros in 200 kB.
    refused(&gzipped(&vec![b'0'; 200 << 20]), "at most 12 MB");
    // An archive in an archive is not opened.
    refused(&gzipped(&gz), "expected");
}
