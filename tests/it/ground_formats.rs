//! Real files of every format: step, count and peak as checked by hand elsewhere.

use mrbd_records::{ReadOptions, Unit, read};

use crate::shared;

struct Sample {
    file: &'static str,
    channel: Option<&'static str>,
    format: &'static str,
    step_s: f64,
    count: usize,
    peak: f64,
    unit: Unit,
}

const fn sample(
    file: &'static str,
    channel: Option<&'static str>,
    format: &'static str,
    (step_s, count): (f64, usize),
    (peak, unit): (f64, Unit),
) -> Sample {
    Sample { file, channel, format, step_s, count, peak, unit }
}

const GAL: Unit = Unit::CentimetrePerSecond2;
const MM: Unit = Unit::MillimetrePerSecond2;
const PEER: &str = "PEER AT2";
const DYNA: &str = "ESM/ITACA DYNA";
const GEONET: &str = "20180212_211557_WPWS_20.V2A";
const CSMIP: &str = "ce36456p_CE36456.V2";
const COSMOS: &str = "us1000hyfh_akbmrp_AKBMR--n.1000hyfh.BNZ.--.acc.V2c";

const SAMPLES: [Sample; 16] = [
    sample("RSN763_LOMAP_GIL067.AT2", None, PEER, (0.005, 7999), (0.35853, Unit::G)),
    sample("RSN1690_NORTH151_SYL090-hor1.AT2", None, PEER, (0.02, 1000), (0.08578, Unit::G)),
    sample("LOMAP-A02043_EQSignal.at2", None, PEER, (0.005, 7165), (0.27352, Unit::G)),
    sample("NIS090_pystrata.AT2", None, PEER, (0.01, 4096), (0.50275, Unit::G)),
    sample("elcentro_evnt.AT2", None, PEER, (0.01, 4000), (0.31288, Unit::G)),
    sample("elCentro_OpenSees.AT2", None, PEER, (0.02, 1559), (0.31882, Unit::G)),
    sample("HI.ARS1..HNN.D.20190728.160908.C.ACC.ASC", None, DYNA, (0.005, 19128), (0.359017, GAL)),
    sample("HL.DLFA..HNE.D.20190728.160908.C.ACC.ASC", None, DYNA, (0.005, 13876), (0.227973, GAL)),
    sample(GEONET, Some("1"), "GeoNet", (0.02, 5800), (41.6, MM)),
    sample(GEONET, Some("s74e"), "GeoNet", (0.02, 5800), (194.0, MM)),
    sample(GEONET, Some("Up"), "GeoNet", (0.02, 5800), (27.3, MM)),
    sample(CSMIP, Some("90 DEG"), "CSMIP V2", (0.02, 3251), (267.957, GAL)),
    sample(CSMIP, Some("UP"), "CSMIP V2", (0.02, 3250), (94.805, GAL)),
    sample(CSMIP, Some("3"), "CSMIP V2", (0.02, 3250), (256.231, GAL)),
    sample(COSMOS, None, "COSMOS", (0.005, 42_000), (6.851512, GAL)),
    sample("AOM0011801241951.EW", None, "K-NET", (0.01, 10200), (4.078, GAL)),
];

#[test]
fn verified_real_files_have_their_step_count_and_peak() {
    let Some(folder) = shared::folder("records/formats") else { return };
    for sample in SAMPLES {
        let channel = sample.channel.map(str::to_owned);
        let options = ReadOptions { channel, ..ReadOptions::default() };
        let record = read(&folder.join(sample.file), &options).expect(sample.file);
        let motion = &record.accelerogram;
        assert_eq!((record.format.name, record.unit), (sample.format, sample.unit), "{}", sample.file);
        assert_eq!((motion.step_s(), motion.acceleration_m_s2().len()), (sample.step_s, sample.count));
        let peak = motion.peak_m_s2() / sample.unit.m_s2();
        println!("{} {:?}: {peak:.6} {}", sample.file, record.channel, sample.unit);
        // The reference gives at least four digits: half of the last one is at most 5e-5 of the value.
        assert!((peak / sample.peak - 1.0).abs() < 5e-5, "{}: {peak}", sample.file);
    }
}

#[test]
fn rejects_several_channels_with_none_chosen() {
    let Some(folder) = shared::folder("records/formats") else { return };
    for (file, names) in [(GEONET, ["S16W", "S74E", "Up"]), (CSMIP, ["90 DEG", "UP", "0 DEG"])] {
        let message = read(&folder.join(file), &ReadOptions::default()).expect_err(file).to_string();
        assert!(names.iter().all(|name| message.contains(name)), "{message}");
        let options = ReadOptions { channel: Some("4".into()), ..ReadOptions::default() };
        let message = read(&folder.join(file), &options).expect_err(file).to_string();
        assert!(message.contains("channel `4`"), "{message}");
    }
}

#[test]
fn rejects_real_files_against_what_they_say() {
    let Some(folder) = shared::folder("records/formats") else { return };
    let step = ReadOptions { step_s: Some(0.01), ..ReadOptions::default() };
    let unit = ReadOptions { unit: Some(Unit::MetrePerSecond2), ..ReadOptions::default() };
    for (options, word) in [(step, "0.005 s"), (unit, "unit g")] {
        let error = read(&folder.join("RSN763_LOMAP_GIL067.AT2"), &options).expect_err("contradiction");
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains(word), "{error}");
    }
}
