//! Small files of every format, written here, read back; and what is refused in them.

use std::fmt::Write;
use std::path::Path;

use mrbd_files::InputError;
use mrbd_records::{FORMATS, ReadOptions, Record, Unit, formats_in_words, read_bytes};

/// Samples that every small file holds, in its own unit.
pub const SAMPLES: [f64; 7] = [0.0, 1.5, -2.5, 3.0, 0.5, -0.5, 0.25];

/// The name of a format and a small file of it.
pub fn small_files() -> Vec<(&'static str, String)> {
    vec![
        ("two columns", two_columns()),
        ("one column", rows(1, |a| format!("{a:.4}"))),
        ("PEER AT2", peer("NPTS=      7, DT=   .0050 SEC,")),
        ("PEER AT2", peer("   7    0.0050    NPTS, DT")),
        ("PEER AT2", opensees()),
        ("ESM/ITACA DYNA", dyna()),
        ("GeoNet", geonet()),
        ("GeoNet", geonet_raw()),
        ("COSMOS", cosmos()),
        ("CSMIP V2", csmip()),
        ("CSMIP V2", csmip_lower_case()),
        ("K-NET", knet()),
    ]
}

pub fn options() -> ReadOptions {
    ReadOptions { step_s: Some(0.005), ..ReadOptions::default() }
}

fn rows(columns: usize, write: impl Fn(f64) -> String) -> String {
    let lines = SAMPLES.chunks(columns).map(|row| row.iter().map(|&a| write(a)).collect::<String>() + "\n");
    lines.collect()
}

fn two_columns() -> String {
    let mut text = String::from("time_s,acceleration_m_s2\n");
    for (i, a) in SAMPLES.iter().enumerate() {
        writeln!(text, "{:.3},{a}", i as f64 * 0.005).expect("a string");
    }
    text
}

fn peer(sizes: &str) -> String {
    let body = rows(5, |a| format!("{a:15.7E}"));
    format!(
        "PEER NGA STRONG MOTION DATABASE RECORD\nSomewhere, 1/1/2000\nACCELERATION TIME SERIES IN UNITS OF G\n{sizes}\n{body}"
    )
}

/// The wording of the examples of OpenSees.
fn opensees() -> String {
    let body = rows(8, |a| format!("{a:10.5}"));
    format!(
        "Data for Somewhere\n7 points at equal spacing of 0.005 sec\nThe units are (g)\nNPTS=     7, DT= .00500 SEC\n{body}"
    )
}

fn dyna() -> String {
    let header = "EVENT_NAME: SOMEWHERE\nSTATION_CODE: XYZ\nSAMPLING_INTERVAL_S: 0.005000\nNDATA: 7\nSTREAM: HNE\n\
        UNITS: cm/s^2\nDATA_TYPE: ACCELERATION\nUSER5: \n";
    format!("{header}{}", rows(1, |a| format!("{a:.6}")))
}

fn geonet() -> String {
    let mut text = String::from("Corrected accelerogram 20000101_000000_XYZ GNS Science\n");
    text += &"text\n".repeat(9);
    text += "Instrument corrected data at 0.005 sec intervals\ntext\nComponent N10E  Longitudinal Accelerometer Axis\n";
    text += &"text\n".repeat(3);
    let mut numbers = [0.0; 100];
    numbers[33..36].fill(7.0);
    numbers[65] = 0.005;
    for row in numbers.chunks(10) {
        let row: Vec<String> = row.iter().map(|v| format!("{v:8.3}")).collect();
        text += &(row.concat() + "\n");
    }
    text + &rows(10, |a| format!("{a:8.2}")).repeat(3)
}

/// Volume 1: acceleration alone, and another wording.
fn geonet_raw() -> String {
    let text = geonet().replace("Corrected accel", "Uncorrected accel");
    let text = text
        .replace("Instrument corrected data at 0.005 sec intervals", "Raw readings at intervals of 0.005 s");
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    lines.truncate(27);
    lines[19] = format!("{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}", 7, 0, 0, 7, 0, 0, 0, 0, 0, 0);
    lines[20].replace_range(7 * 8..8 * 8, "   1.000");
    lines.join("\n")
}

fn cosmos() -> String {
    cosmos_with(&[(34, 0.02), (35, 0.035), (62, 5.0), (63, 0.035)])
}

/// With these values of the real header, counted from 1; the others are unknown.
fn cosmos_with(known: &[(usize, f64)]) -> String {
    let mut text = String::from("Corrected acceleration   (Format v01.20 with 13 text lines) Src: x\n");
    text += &"text\n".repeat(7);
    text += "Sta Chan  1:  90 deg (Rcrdr Chan  1)\n";
    text += &"text\n".repeat(4);
    text +=
        "   4 Integer-header values follow on  1 lines, Format= (10I8)\n       1       1       4       1\n";
    text += " 100 Real-header values follow on 17 lines, Format= (6F13.6)\n";
    let value = |i| known.iter().find(|(number, _)| *number == i).map_or(-999.0, |(_, value)| *value);
    let reals: Vec<String> = (1..=100).map(|i| format!("{:13.6}", value(i))).collect();
    text += &reals.chunks(6).map(|row| row.concat() + "\n").collect::<String>();
    text += "   1 Comment line(s) follow, each starting with a \"|\":\n| \n";
    text += "       7 acceleration pts, approx   0 secs, units=cm/sec2 (04),Format=(8f10.6)\n";
    text + &rows(8, |a| format!("{a:10.6}")) + "End-of-data for Chan  1 acceleration\n"
}

fn csmip() -> String {
    let head = "CORRECTED ACCELEROGRAM   X       CHAN  1:  90 DEG     FROM\ntext\n";
    let mark = |what: &str, unit: &str| {
        format!("    7 POINTS OF {what} DATA EQUALLY SPACED AT  .005 SEC.  (UNITS: {unit})\n")
    };
    let body = rows(8, |a| format!("{a:10.3}"));
    let blocks =
        mark("ACCEL", "CM/SEC/SEC") + &body + &mark("VELOC", "CM/SEC") + &body + &mark("DISPL", "CM") + &body;
    format!("{head}{blocks}/&  ----------  END OF DATA FOR CHANNEL  1  ----------\n")
}

/// The wording of later years.
fn csmip_lower_case() -> String {
    let head = "Corrected accelerogram   X       Chan  1:  90 deg\ntext\n";
    let mark = "    7 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.6)\n";
    format!(
        "{head}{mark}{}/&  ---------- End of data for channel  1 ----------\n",
        rows(8, |a| format!("{a:10.6}"))
    )
}

fn knet() -> String {
    let header = "Origin Time       2000/01/01 00:00:00\nStation Code      XYZ001\nSampling Freq(Hz) 200Hz\n\
        Duration Time(s)  0.035\nDir.              E-W\nScale Factor      10(gal)/1000\nMemo.\n";
    // Counts of a hundredth of a gal around an offset; what is read has its mean taken off.
    format!("{header}{}", rows(8, |a| format!("{:9}", (a * 100.0) as i64 - 12_000)))
}

fn read_text(text: &str, options: &ReadOptions) -> Result<Record, InputError> {
    read_bytes(Path::new("folder/small.txt"), text.as_bytes(), options)
}

#[test]
fn analytic_small_files_of_every_format_are_read_back() {
    for (format, text) in small_files() {
        let record = read_text(&text, &options()).unwrap_or_else(|e| panic!("{format}: {e}"));
        assert_eq!((record.format.name, record.name.as_str()), (format, "small"));
        assert_eq!(record.accelerogram.step_s(), 0.005, "{format}");
        let mean = SAMPLES.iter().sum::<f64>() / SAMPLES.len() as f64;
        let offset = if format == "K-NET" { mean } else { 0.0 };
        for (found, expected) in record.accelerogram.acceleration_m_s2().iter().zip(SAMPLES) {
            let expected = (expected - offset) * record.unit.m_s2();
            // The samples are exact in the digits written; K-NET's mean rounds.
            assert!((found - expected).abs() < 1e-12, "{format}: {found} for {expected}");
        }
    }
}

#[test]
fn analytic_line_ends_latin_letters_and_exponents_of_fortran_are_read() {
    let text = peer("NPTS= 7, DT= .005").replace('\n', "\r\n").replace('E', "D");
    let text = text.replace("PDDR NGA", "PEER").replace("TIMD", "TIME").replace("SDRIDS", "SERIES");
    let text = text.replace("ACCDL", "ACCEL");
    let mut bytes = text.into_bytes();
    bytes.splice(5..5, [0xe9]);
    let record = read_bytes(Path::new("a"), &bytes, &ReadOptions::default()).expect("readable");
    assert_eq!(record.unit, Unit::G);
    let commented = format!("# a note\n\n{}", two_columns());
    let commented = read_text(&commented.replace("0.010,", "0.010,x"), &ReadOptions::default());
    let message = commented.expect_err("must be refused").to_string();
    assert!(message.contains("small.txt:6"), "lines are counted with comments and blanks: {message}");
    assert_eq!(record.accelerogram.acceleration_m_s2().len(), 7);
}

#[test]
fn analytic_touching_fields_are_split_by_width() {
    let text = csmip().replacen("     0.000     1.500    -2.500", "-12345.678-22345.678-32345.678", 1);
    let record = read_text(&text, &ReadOptions::default()).expect("readable");
    let samples = record.accelerogram.acceleration_m_s2();
    assert!((samples[1] + 223.456_78).abs() < 1e-12 && (samples[2] + 323.456_78).abs() < 1e-12);
}

fn refusal(text: &str, options: &ReadOptions) -> String {
    read_text(text, options).expect_err("must be refused").to_string()
}

#[test]
fn rejects_malformed_files_with_line_found_and_allowed() {
    let none = ReadOptions::default();
    let two = two_columns();
    for (text, options, parts) in [
        (two.replace("0.010,", "0.011,x"), &none, &["small.txt:4", "`x-2.5`", "finite number"][..]),
        (two.replace("0.015,3", "0.015,3,4"), &none, &[":5", "3 columns", "2 columns"]),
        (two.replace("0.015,3\n", ""), &none, &["equal steps"]),
        (two.replace("0.015,3", "0.015,NaN"), &none, &[":5", "`NaN`"]),
        (two.replace("_m_s2", ""), &none, &[":1", "time_s,acceleration_m_s2"]),
        (rows(1, |a| format!("{a}")), &none, &["no step", "--dt"]),
        ("1.0\n2.0\nabc\n".into(), &options(), &[":3", "`abc`"]),
        ("1.0 2.0\n3.0 4.0\n".into(), &options(), &[":1", "header line"]),
        (String::new(), &none, &["no data", "PEER"]),
        ("Dear all,\n".into(), &none, &[":1", "`Dear all,`"]),
        (
            peer("NPTS= 9, DT= .005"),
            &none,
            &[":7", "end of the file after 7 numbers", "9 numbers from line 5"],
        ),
        (peer("NPTS= 6, DT= .005"), &none, &[":6", "7 numbers", "6 numbers"]),
        (peer("NPTS= 5, DT= .005"), &none, &[":6", "the end of the file after 5 samples"]),
        (peer("NPTS= 7, DT= -.005"), &none, &[":4", "NPTS"]),
        (peer("NPTS= 7, DT= .005").replace("ACCELERATION", "VELOCITY"), &none, &[":3", "UNITS OF G"]),
        (dyna().replace("ACCELERATION", "VELOCITY"), &none, &[":7", "DATA_TYPE: ACCELERATION"]),
        (dyna().replace("NDATA: 7", "NDATA: 8"), &none, &["8 numbers"]),
        (dyna().replace("NDATA: 7\n", ""), &none, &["NDATA"]),
        (geonet().replace("at 0.005 sec", "at 0.020 sec"), &none, &["0.02 s", "0.005 s"]),
        (cosmos().replace("cm/sec2 (04)", "counts (50)"), &none, &["units=cm/sec2"]),
        (cosmos().replace("approx   0", "approx  90"), &none, &["90 s on this line", "0.035 s: 7 samples"]),
        (opensees().replace("(g)", "(cm/sec)"), &none, &[":3", "The units are (g)"]),
        (opensees().replace("The units", "The velocity units"), &none, &[":3", "UNITS OF G"]),
        (csmip().replace("CM/SEC/SEC", "FURLONG"), &none, &[":3", "UNITS: CM/SEC/SEC"]),
        (knet().replace("Duration Time(s)  0.035", "Duration Time(s)  0.040"), &none, &["8 numbers"]),
        (knet().replace("/1000", "/0"), &none, &[":6", "3920(gal)/6182761"]),
    ] {
        let message = refusal(&text, options);
        assert!(parts.iter().all(|part| message.contains(part)), "{parts:?} in: {message}");
    }
}

#[test]
fn rejects_cosmos_files_whose_step_count_and_length_disagree() {
    let at = "the step in milliseconds as value 62";
    for (known, parts) in [
        // The raw step alone, in seconds or in milliseconds, is not the step of the samples.
        (&[(34, 0.005), (35, 0.035)][..], &["-999 as value 62", at][..]),
        (&[(34, 5.0)], &["-999 as value 62", at]),
        (&[(62, 20_000.0)], &["20000 as value 62", at]),
        // Seconds where milliseconds belong, another step, and a length of other samples.
        (&[(62, 0.005), (63, 0.035)], &["0.035 s as value 63", "7 samples at the 0.000005 s"]),
        (&[(62, 10.0), (63, 0.035)], &["0.035 s as value 63", "0.070 s: 7 samples"]),
        (&[(62, 5.0), (63, 210.0)], &["210 s as value 63", "0.035 s: 7 samples"]),
        (&[(62, 1000.0)], &["0 s on this line", "7.000 s: 7 samples"]),
    ] {
        let message = refusal(&cosmos_with(known), &ReadOptions::default());
        assert!(parts.iter().all(|part| message.contains(part)), "{parts:?} in: {message}");
    }
    let short = cosmos().replace(" 100 Real-header values", "  42 Real-header values");
    let lines: Vec<&str> = short.lines().collect();
    let short = [&lines[..23], &lines[33..]].concat().join("\n");
    let message = refusal(&short, &ReadOptions::default());
    assert!(message.contains("a real header of 42 values") && message.contains(at), "{message}");
    // One sample of the length more or less is a matter of counting.
    let record = read_text(&cosmos_with(&[(62, 5.0), (63, 0.03)]), &ReadOptions::default());
    assert_eq!(record.expect("readable").accelerogram.step_s(), 0.005);
}

/// Text with its line ends taken out.
fn unwrapped(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn regress_every_format_of_the_table_has_a_small_file_and_stands_where_people_look() {
    let files = small_files();
    for format in &FORMATS {
        assert!(files.iter().any(|(name, _)| *name == format.name), "no small file of {format}");
        let same = FORMATS.iter().filter(|other| other.name == format.name || other.words == format.words);
        assert_eq!(same.count(), 1, "{format} twice");
    }
    let docs = include_str!("../../docs/files.md");
    assert!(unwrapped(docs).contains(&formats_in_words("or")), "docs/files.md: {}", formats_in_words("or"));
    let unknown = refusal("Dear all,\n", &ReadOptions::default());
    assert!(unknown.ends_with(&formats_in_words("or")), "{unknown}");
}

#[test]
fn rejects_a_peak_that_no_stated_unit_explains() {
    let milligal = rows(1, |a| format!("{}", a * 1000.0));
    let message = refusal(&milligal, &options());
    assert!(message.contains("305.8") && message.contains("state the unit"), "{message}");
    let unit = Some(Unit::MillimetrePerSecond2);
    let record = read_text(&milligal, &ReadOptions { unit, ..options() }).expect("unit stated");
    assert!((record.accelerogram.peak_m_s2() - 3.0).abs() < 1e-12);
}
