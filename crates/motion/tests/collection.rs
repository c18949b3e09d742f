//! Tests of grouping files into records, and of flatfiles.

use std::path::Path;

use barrelstack_motion::{
    AccelerationUnit, Flatfile, ReadOptions, Record, group_files, record_sequence_number,
};

fn read(file: &str) -> Record {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(file);
    let options = ReadOptions { unit: Some(AccelerationUnit::G), ..ReadOptions::default() };
    barrelstack_motion::read(&std::fs::read(path).unwrap(), file, &options).unwrap()
}

fn names(files: &[&str]) -> Vec<(String, usize)> {
    let files: Vec<String> = files.iter().map(|file| (*file).to_owned()).collect();
    group_files(&files).into_iter().map(|r| (r.name, r.files.len())).collect()
}

#[test]
fn components_come_together_and_nothing_else_does() {
    let found = names(&[
        "p/RSN1503_CHICHI_TCU065-E.AT2",
        "p/RSN1503_CHICHI_TCU065-N.AT2",
        "p/RSN1503_CHICHI_TCU065-V.AT2",
        "q/RSN1503_CHICHI_TCU065-E.AT2",
        "k/AOM0011801241951.EW",
        "k/AOM0011801241951.NS",
        "k/AOM0011801241951.UD",
        "k/IBRH11.EW1",
        "k/IBRH11.NS1",
        "k/IBRH11.EW2",
        "m/BK.CMB.00.HNE__2014.mseed",
        "m/BK.CMB.00.HNN__2014.mseed",
        "m/BK.CMB.10.HNN__2014.mseed",
        "CE58667.V2",
        "CE58668.V2",
    ]);
    let expected = [
        ("CE58667.V2", 1),
        ("CE58668.V2", 1),
        ("k/AOM0011801241951", 3),
        ("k/IBRH11.1", 2),
        ("k/IBRH11.EW2", 1),
        ("m/BK.CMB.00.HN?__2014.mseed", 2),
        ("m/BK.CMB.10.HNN__2014.mseed", 1),
        ("p/RSN1503_CHICHI_TCU065", 3),
        ("q/RSN1503_CHICHI_TCU065-E.AT2", 1),
    ];
    let expected: Vec<(String, usize)> =
        expected.iter().map(|(name, count)| ((*name).to_owned(), *count)).collect();
    assert_eq!(found, expected);
}

#[test]
fn a_row_is_found_by_its_number_and_unknown_is_none() {
    let text = "\u{feff}Record Sequence Number,Earthquake Name,\"Station Name\",Earthquake \
                Magnitude,ClstD (km),Joyner-Boore Dist. (km),Vs30 (m/s) selected for analysis\r\n\
                995,\"Northridge-01\",\"LA - \"\"Hollywood\"\", Stor FF\",6.69,24.03,19.73,316.46\r\n\
                996,x,y,-999,,1,2\r\n";
    let flatfile = Flatfile::parse("flat.csv", text).unwrap();
    let row = flatfile.get(995).unwrap();
    assert_eq!(row.station, "LA - \"Hollywood\", Stor FF");
    assert_eq!(row.magnitude, Some(6.69));
    assert_eq!((flatfile.len(), flatfile.get(996).unwrap().magnitude), (2, None));
    assert_eq!(record_sequence_number("a/RSN995_NORTHR_PEL360.AT2"), Some(995));
    assert_eq!(record_sequence_number("a/RSNX.AT2"), None);
}

#[test]
fn errors_state_line_and_column() {
    let refusal = |text: &str| Flatfile::parse("flat.csv", text).unwrap_err().to_string();
    assert_eq!(
        refusal("RSN,vs30\n1,300\n2,soft\n"),
        "flat.csv, line 3, column \"vs30\": expected a number, found \"soft\""
    );
    assert_eq!(
        refusal("RSN\n1\n1\n"),
        "flat.csv, line 3, column \"rsn\": expected each sequence number once, found \"1\""
    );
    assert!(refusal("a,b\n").contains("a column \"Record Sequence Number\""));
}

#[test]
fn components_are_grouped_by_the_names_that_networks_give_them() {
    let groups = |files: &[&str]| -> Vec<usize> {
        let files: Vec<String> = files.iter().map(|file| (*file).to_owned()).collect();
        group_files(&files).iter().map(|record| record.files.len()).collect()
    };
    // Names of AFAD, the Broadband Platform and CSMNC, and names chosen by users.
    assert_eq!(
        groups(&["2020_9999_ap_Acc_E.asc", "2020_9999_ap_Acc_N.asc", "2020_9999_ap_Acc_U.asc"]),
        [3]
    );
    assert_eq!(groups(&["s01.000", "s01.090", "s01.ver", "s02.000"]), [3, 1]);
    assert_eq!(groups(&["00AAA200101EW.dat", "00AAA200101NS.dat", "00AAA200101UD.dat"]), [3]);
    assert_eq!(groups(&["site-EW.csv", "site-NS.csv", "other-EW.csv"]), [1, 2]);
    // Words that only end in these letters are not components; other kinds of files are not
    // grouped.
    assert_eq!(groups(&["NAPAE.txt", "NAPAN.txt", "news.txt"]), [1, 1, 1]);
    assert_eq!(groups(&["site_E.txt", "site_N.csv"]), [1, 1]);
}

#[test]
fn the_flatfile_of_esm_is_found_by_event_and_station() {
    let table = "event_id;event_time;ML;Mw;EMEC_Mw;es_strike;network_code;station_code;vs30_m_sec;epi_dist;JB_dist;rup_dist\n\
        MADE-1;2020-01-01;5.9;6.6;6.5;120;TK;9999;400;14.0;9.5;11.2\n\
        MADE-1;2020-01-01;5.9;;6.5;;TK;1234;;20;;\n\
        MADE-1;2020-01-01;5.9;6.6;6.5;120;XX;1234;400;14.0;9.5;11.2\n";
    let flatfile = Flatfile::parse("esm.csv", table).unwrap();
    assert_eq!(flatfile.len(), 3);
    let mut record = read("esm/example.ACC.ASC");
    record.earthquake.id = "made-1".to_owned();
    let station = |record: &mut Record, name: &str| {
        for channel in &mut record.channels {
            name.clone_into(&mut channel.site.station);
        }
    };
    station(&mut record, "9999 Nowhere");
    let row = flatfile.of_record(&record).unwrap();
    assert_eq!(
        (row.magnitude, row.rupture_distance, row.surface_distance),
        (Some(6.6), Some(11.2), Some(9.5))
    );
    assert_eq!((row.vs30, row.strike), (Some(400.0), Some(120.0)));
    // Two networks have a station with this code; neither is used unless the record names the
    // network.
    station(&mut record, "1234");
    assert_eq!(flatfile.of_record(&record), None);
    station(&mut record, "TK.1234");
    assert_eq!(flatfile.of_record(&record).and_then(|row| row.magnitude), Some(6.5));
    record.earthquake.id = "another".to_owned();
    assert_eq!(flatfile.of_record(&record), None);
}

#[test]
fn headers_state_magnitude_and_distance() {
    // Magnitude with its scale, and epicentral distance (km) on the sphere.
    let of = |file: &str| {
        let record = read(file);
        (record.earthquake.magnitude, record.earthquake.scale.clone(), record.epicentral_distance())
    };
    let (magnitude, scale, distance) = of("csmnc/example.dat");
    assert_eq!((magnitude, scale.as_str()), (Some(5.0), "Ms"));
    // The distance of a point 0.1 degrees north and east at latitude 40°.
    assert!((distance.unwrap() - 14.0).abs() < 0.1, "{distance:?}");
    let (magnitude, _, distance) = of("sac-text/example.sac");
    assert_eq!(magnitude.map(|m| (m * 10.0).round()), Some(66.0));
    assert!((distance.unwrap() - 14.1).abs() < 0.1, "{distance:?}");
}
