//! Archives: NPZ files read back, and a record inside gzip or zip is read like the unpacked file.

use std::io::{Cursor, Write as _};
use std::path::Path;

use barrelstack_motion::{
    Archive, Channel, Direction, ReadOptions, Record, Refusal, bundled, read, write,
};

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
    zipped_by(zip::CompressionMethod::Deflated, files)
}

/// Returns a zip archive without compression.
fn stored(files: &[(&str, &[u8])]) -> Vec<u8> {
    zipped_by(zip::CompressionMethod::Stored, files)
}

fn zipped_by(method: zip::CompressionMethod, files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut out = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default().compression_method(method);
    for (name, bytes) in files {
        out.start_file(*name, options).unwrap();
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
    refused(&zipped(&[]), "expected");
    refused(&zipped(&[("[Content_Types].xml", b"<x/>"), ("xl/a.xml", b"<x/>")]), "as CSV");
    refused(
        &zipped(&[("a.pdf", b"%PDF-1.4"), ("b.txt", b"no numbers")]),
        "2 files, none of them a record",
    );
    let gz = gzipped(&at2);
    refused(&gz[..gz.len() / 2], "a readable packed file");
    // 200 MB of zeros in 200 kB.
    refused(&gzipped(&vec![b'0'; 200 << 20]), "at most 12 MB");
    // A nested archive is not opened.
    refused(&gzipped(&gz), "expected");
}

#[test]
fn a_component_that_cannot_be_unpacked_refuses_the_archive() {
    let mut files = three();
    let named: Vec<(&str, &[u8])> = files.iter().map(|(n, b)| (n.as_str(), b.as_slice())).collect();
    assert_eq!(given(&stored(&named), "three.zip").channels.len(), 3);
    let mut damaged = stored(&named);
    // Change the last digit of the second component's data, so that its checksum is wrong.
    let second = files.swap_remove(1).1;
    let at = damaged.windows(second.len()).position(|part| part == second).unwrap();
    damaged[at + second.len() - 2] ^= 1;
    let error = read(&damaged, "three.zip", &ReadOptions::default()).unwrap_err();
    assert_eq!(error.refusal, Refusal::Damaged, "{error}");
    // A file that is not a component may be damaged.
    let record = (files[0].0.as_str(), files[0].1.as_slice());
    let mut other = stored(&[record, ("cover.pdf", b"%PDF-1.4 page")]);
    let at = other.windows(4).position(|part| part == b"page").unwrap();
    other[at] ^= 1;
    assert_eq!(given(&other, "one.zip").channels.len(), 1);
}

fn tarred(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut out = tar::Builder::new(Vec::new());
    for (name, bytes) in files {
        let mut header = tar::Header::new_gnu();
        header.set_size(bytes.len() as u64);
        header.set_mode(0o644);
        out.append_data(&mut header, name, *bytes).unwrap();
    }
    out.into_inner().unwrap()
}

/// Returns an archive with three components of one station, named like AFAD files, and other files
/// of a download.
fn three() -> Vec<(String, Vec<u8>)> {
    let east = String::from_utf8(bytes("esm/example.ACC.ASC")).unwrap();
    let component = |letter: &str, stream: &str| {
        (
            format!("20200101000000_9999_ap_Acc_{letter}.asc"),
            east.replace("STREAM: HNE", &format!("STREAM: {stream}")).into_bytes(),
        )
    };
    vec![
        component("E", "HNE"),
        component("N", "HNN"),
        component("U", "HNZ"),
        ("README.txt".to_owned(), b"Cite the network.\nThank you.\n".to_vec()),
    ]
}

fn named(files: &[(String, Vec<u8>)]) -> Vec<(&str, &[u8])> {
    files.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice())).collect()
}

#[test]
fn the_components_of_one_record_in_an_archive_are_one_record_that_says_so() {
    let files = three();
    let files = named(&files);
    let tar = tarred(&files);
    let nested = zipped(&[("station.zip", zipped(&files).as_slice())]);
    for (archive, name) in [
        (zipped(&files), "download.zip"),
        (gzipped(&tar), "download.tar.gz"),
        (tar, "download.tar"),
        (nested, "event.zip"),
    ] {
        let record = given(&archive, name);
        let names: Vec<&str> = record.channels.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["HNE", "HNN", "HNZ"], "{name}");
        assert_eq!(record.file, name);
        let said = record.notes.join("; ");
        assert!(said.contains("Acc_E.asc"), "{said}");
        assert!(said.contains("ignored") && said.contains("README.txt"), "{said}");
    }
}

#[test]
fn an_archive_of_several_records_names_them_and_gives_each_by_its_path() {
    let at2 = bytes("peer/nga-west2.AT2");
    let archive =
        zipped(&[("a/RSN1_X360.AT2", at2.as_slice()), ("a/RSN2_Y360.AT2", at2.as_slice())]);
    let error = read(&archive, "set.zip", &ReadOptions::default()).unwrap_err();
    assert_eq!(error.refusal, Refusal::SeveralRecords, "{error}");
    for word in ["RSN1_X", "RSN2_Y", "such as set.zip/a/RSN1_X360.AT2"] {
        assert!(error.to_string().contains(word), "{error}");
    }
    let (path, inner) = Archive::path_inside(Path::new("d/set.zip/a/RSN1_X360.AT2")).unwrap();
    assert_eq!((path.as_path(), inner.as_str()), (Path::new("d/set.zip"), "a/RSN1_X360.AT2"));
    assert_eq!(Archive::path_inside(Path::new("d/set.zip")), None);
    let opened = Archive::open(archive, "set.zip").unwrap().unwrap();
    assert_eq!(opened.names().unwrap(), ["a/RSN1_X360.AT2", "a/RSN2_Y360.AT2"]);
    assert_eq!(opened.file(&inner).unwrap(), at2);
    let error = opened.file("b").unwrap_err();
    assert!(error.to_string().contains("RSN2_Y360"), "{error}");
}

#[test]
fn counts_in_an_archive_find_the_sensitivity_beside_them() {
    let xml = br#"<FDSNStationXML><Network code="ZZ"><Station code="XXXX"><Channel code="HNE" locationCode="00">
        <Latitude>38.1</Latitude><Longitude>27.1</Longitude><Elevation>1</Elevation><Azimuth>90</Azimuth><Dip>0</Dip>
        <Response><InstrumentSensitivity><Value>4278.19</Value><InputUnits><Name>m/s**2</Name></InputUnits>
        </InstrumentSensitivity></Response></Channel></Station></Network></FDSNStationXML>"#;
    let counts = bytes("miniseed/steim1.mseed");
    let archive = tarred(&[("a.mseed", counts.as_slice()), ("a.xml", xml)]);
    let known = ReadOptions { sensitivity: Some(4278.19), ..ReadOptions::default() };
    let open = read(&counts, "a.mseed", &known).unwrap();
    let record = given(&archive, "a.tar");
    assert_eq!(record.channels[0].acceleration, open.channels[0].acceleration);
    // The error says what is wrong with a `StationXML` file that cannot be used.
    let cut = tarred(&[("a.mseed", counts.as_slice()), ("a.xml", &xml[..300])]);
    let error = read(&cut, "a.tar", &ReadOptions::default()).unwrap_err();
    assert!(
        matches!(error.refusal, Refusal::Missing(_)) && error.found.contains("a.xml ("),
        "{error}"
    );
    // Without the `StationXML` file, the error is the same as for the unpacked file.
    let bare = read(&tarred(&[("a.mseed", counts.as_slice())]), "a.tar", &ReadOptions::default());
    assert!(matches!(bare.unwrap_err().refusal, Refusal::Missing(_)));
}

#[test]
fn a_damaged_archive_is_refused_and_never_read_in_part() {
    let files = three();
    let files = named(&files);
    for whole in [zipped(&files), tarred(&files), gzipped(&tarred(&files))] {
        for keep in (0..whole.len()).step_by(whole.len() / 40) {
            let cut = read(&whole[..keep], "cut", &ReadOptions::default());
            // A tar archive that ends after a file cannot be recognized as truncated.
            if let Ok(record) = cut {
                assert!(record.channels.iter().all(|channel| channel.acceleration.len() > 100));
            }
        }
    }
}
