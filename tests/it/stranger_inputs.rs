//! Odd inputs: what somebody gives to the program in the first hour, and what it must answer.

/// What is done to the starter's files before a command.
pub enum Odd {
    /// Nothing.
    Nothing,
    /// A text in a file replaced by another.
    Change(&'static str, &'static str, &'static str),
    /// A file that was not there, or is written over.
    Write(&'static str, &'static [u8]),
}
use Odd::{Change, Nothing, Write};

/// A command, what is odd about it, its exit code, and parts of what it says.
pub type Row = (&'static str, Odd, i32, &'static [&'static str]);

const SIMULATE: &str = "simulate wall.toml --record records/generated_4_600ya.csv";

pub const WALLS: &[Row] = &[
    (
        SIMULATE,
        Change("wall.toml", "thickness_m = 0.291", "thickness_m = 291"),
        2,
        &["wall.toml: wall.thickness_m: found 291", "allowed: 0.05 to 5 m", "291 mm"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "mass_kg = 3614.0", "density_kg_m3 = 1.8"),
        2,
        &["wall.density_kg_m3: found 1.8", "1.8 t/m3"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "mass_kg = 3614.0", "mass_kg = 3.614"),
        2,
        &["wall.mass_kg: found 3.614", "3.614 t"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "37e3", "37"),
        0,
        &["note: wall.toml: diaphragm.stiffness_n_per_m", "37 kN/m"],
    ),
    (SIMULATE, Change("wall.toml", "37e3", "1e11"), 0, &["The model does not apply"]),
    (
        SIMULATE,
        Change("wall.toml", "0.291", "0,291"),
        2,
        &["wall.toml:6: found `0,291", "decimal comma", "allowed: a decimal point: 0.291"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "0.291", "\"thick\""),
        2,
        &["wall.toml:6: wall.thickness_m", "allowed: a number"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "thickness_m", "thikness_m"),
        2,
        &["thikness_m", "did you mean `thickness_m`?"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "crack_height_m = 2.191", "crack_height_m = 4.5"),
        2,
        &["crack_height_m: found 4.5", "below wall.height_m = 3.984"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "rotation_ratio = 2.0", "rotation_ratio = 1e6"),
        2,
        &["rotation_ratio: found 1000000", "a quarter turn"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "rotation_ratio = 2.0", "rotation_ratio = nan"),
        2,
        &["rotation_ratio: found NaN", "allowed: a finite number above 0"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "0.93, 1.03", "0.93"),
        2,
        &["restitution.coefficients: found invalid length 7", "length 8"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "\"contact\"", "\"contakt\""),
        2,
        &["restitution.law: found unknown variant `contakt`", "`whole` or `contact`"],
    ),
    (SIMULATE, Write("wall.toml", b""), 2, &["wall.toml:1: found missing field `wall`"]),
    (
        SIMULATE,
        Write("wall.toml", b"\xff\xfe\x00wall"),
        2,
        &["wall.toml: found", "allowed: a readable text file in UTF-8"],
    ),
    ("simulate wall.toml", Nothing, 2, &["--record: found no record and a wall at rest"]),
    ("describe nowhere.toml", Nothing, 2, &["nowhere.toml: found No such file"]),
];

pub const RECORDS: &[Row] = &[
    (
        "simulate wall.toml --record r.csv",
        Write("r.csv", b"time_s;acceleration_m_s2\n0,00;0\n0,01;0,1\n"),
        2,
        &["r.csv:1: found `time_s;acceleration_m_s2`", "--columns 1,2", "--decimal-comma"],
    ),
    (
        "simulate wall.toml --record r.csv",
        Write("r.csv", b"0.00 0.1\n0.01 0.2\n0.02 0.1\n"),
        2,
        &["r.csv:1: found `0.00 0.1`", "--columns"],
    ),
    (
        "simulate wall.toml --record r.csv --columns 1,2 --unit m/s2",
        Write("r.csv", b"0.00 0.1\n0.01 0.2\n0.02 0.1\n"),
        0,
        &["The wall stood"],
    ),
    (
        "simulate wall.toml --record r.csv --columns Time,Acc --unit g --decimal-comma",
        Write("r.csv", b"Time;Acc\n0,00;0,1\n0,01;0,2\n0,02;0,1\n"),
        0,
        &["The wall stood"],
    ),
    (
        "simulate wall.toml --record r.csv --columns Time,Acc --unit g",
        Write("r.csv", b"\xff\xfeT\0i\0m\0e\0\t\0A\0c\0c\0\n\x000\0\t\x000\0\n\x001\0\t\x000\0\n\0"),
        0,
        &["The wall stood"],
    ),
    (
        "simulate wall.toml --record r.csv",
        Write("r.csv", b"time_s,acceleration_m_s2\n0,0.1\n0.01,nan\n0.02,1\n"),
        2,
        &["r.csv:3: found `nan`; allowed: a finite number"],
    ),
    (
        "simulate wall.toml --record r.csv",
        Write("r.csv", b"time_s,acceleration_m_s2\n0,0.1\n"),
        2,
        &["r.csv: found 1 samples; allowed: at least 2"],
    ),
    (
        "simulate wall.toml --record r.csv",
        Write("r.csv", b"time_s,acceleration_m_s2\n0,0.1\n0.01,0.2\n0.03,0.2\n"),
        2,
        &["r.csv:3: found time 0.01 s; allowed: equal steps"],
    ),
    (
        "simulate wall.toml --record r.csv",
        Write("r.csv", b"time_s,acceleration_m_s2\n0,0\n0.01,300\n0.02,0\n"),
        0,
        &["note: r.csv: a peak of 300 m/s2", "is the record in cm/s2?"],
    ),
    (
        "simulate wall.toml --record r.csv --dt -1",
        Write("r.csv", b"0.1\n0.2\n0.1\n"),
        2,
        &["r.csv: found a step of -1 s given for it; allowed: 1e-6 to 10 s"],
    ),
    (
        "simulate wall.toml --record r.csv --dt 0",
        Write("r.csv", b"0.1\n0.2\n0.1\n"),
        2,
        &["r.csv: found a step of 0 s", "allowed: 1e-6 to 10 s"],
    ),
    (
        "simulate wall.toml --record nowhere.csv",
        Nothing,
        2,
        &["nowhere.csv: found No such file", "allowed: a readable record file"],
    ),
    ("simulate wall.toml --record records", Nothing, 2, &["records: found Is a directory"]),
    ("records describe --json records/generated_4_600ya.csv", Nothing, 0, &["\"generated\": null"]),
    (
        "records convert records/generated_4_600ya.csv nowhere/r.csv",
        Nothing,
        2,
        &["OUT: found nowhere/r.csv", "a path that can be written"],
    ),
];

pub const OPTIONS: &[Row] = &[
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --scale nan",
        Nothing,
        2,
        &["--scale: found NaN; allowed: a finite number"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --tolerance 0.1",
        Nothing,
        2,
        &["--tolerance: found 0.1; allowed: 1e-13 to 1e-2"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --tolerance 1e-13 --alone",
        Nothing,
        0,
        &["The wall stood"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --tail -1",
        Nothing,
        2,
        &["--tail: found -1", "0 or more"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --plot run.gif",
        Nothing,
        2,
        &["run.gif: --plot: found extension \"gif\"; allowed: .svg, .png or .html"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --plot RUN.PNG --history RUN.CSV",
        Nothing,
        0,
        &["The wall stood"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --plot nowhere/run.svg",
        Nothing,
        2,
        &["the folder nowhere, which is not there"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --history nowhere/run.csv",
        Nothing,
        2,
        &["--history: found No such file", "a folder that can be written"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --history wall.toml",
        Nothing,
        2,
        &["--history: found wall.toml, which is read"],
    ),
    ("init wall.toml", Nothing, 2, &["wall.toml"]),
    ("init /proc/nowhere", Nothing, 2, &["/proc/nowhere"]),
    (
        "margin wall.toml --suite records/suite.toml --from 3 --to 2",
        Nothing,
        2,
        &["--from: found from 3 to 2; allowed: finite numbers, 0 < from < to"],
    ),
    ("report nowhere", Nothing, 2, &["nowhere: found nothing there"]),
    ("report records", Nothing, 2, &["records: found no manifest.json"]),
    ("report --help", Nothing, 0, &["mrbd diagnose"]),
];

pub const STUDIES: &[Row] = &[
    (
        "run pipeline.toml --out out",
        Change("pipeline.toml", "[8.0, 12.0, 16.0, 20.0, 24.0]", "[-8.0]"),
        2,
        &["pipeline.toml: sweep.slenderness: found -8"],
    ),
    (
        "run pipeline.toml --out out",
        Change("pipeline.toml", "records/suite.toml", "records/nowhere.toml"),
        2,
        &["records/nowhere.toml: found No such file"],
    ),
    (
        "run pipeline.toml --out out",
        Change("pipeline.toml", "tolerance = 1e-6", "tolerance = 0.1"),
        2,
        &["assumptions.tolerance: found 0.1; allowed: 1e-13 to 1e-2"],
    ),
    (
        "run pipeline.toml --out out",
        Change("pipeline.toml", "\"contact\"\nset", "\"base\"\nset"),
        2,
        &["variants[1].name: found \"base\"; allowed: a name, each once"],
    ),
    ("run pipeline.toml --out out --threads 100000", Nothing, 2, &["--threads: found 100000; allowed: 1 to"]),
    ("run pipeline.toml --out out --shard 0/3", Nothing, 2, &["--shard: found 0/3"]),
    ("run pipeline.toml --out records", Nothing, 2, &["--out: found records, which holds other files"]),
    (
        "run pipeline.toml --out records --force",
        Nothing,
        2,
        &["--out: found records, which holds other files"],
    ),
    ("run pipeline.toml --out wall.toml", Nothing, 2, &["--out: found wall.toml, which cannot be written"]),
    ("run pipeline.toml", Nothing, 2, &["holds results of this plan already", "--resume", "--force"]),
    (
        "run pipeline.toml --resume",
        Change("pipeline.toml", "1800.0", "1700.0"),
        2,
        &["density_kg_m3: 1800.0, now 1700.0"],
    ),
    ("replay outputs/first 99999", Nothing, 2, &["RUN: found \"99999\"; allowed: a position from 0 to 839"]),
    ("aggregate outputs/first/manifest.json", Nothing, 2, &["Not a directory"]),
    ("aggregate nowhere", Nothing, 2, &["nowhere: found no results"]),
    (
        "check-tolerance outputs/first --tolerance 1e-14",
        Nothing,
        2,
        &["--tolerance: found 1e-14; allowed: 1e-13 or more"],
    ),
    (
        "check outputs/first --baseline b.csv --accept --because x",
        Nothing,
        2,
        &[
            "variants \"base\", \"contact\", none of which differs from the first by a tighter tolerance alone",
        ],
    ),
    ("status margin", Nothing, 2, &["the results of a margin", "from `mrbd run`"]),
    ("aggregate models", Nothing, 2, &["the results of a comparison of models"]),
    ("fragility models", Nothing, 2, &["the results of a comparison of models"]),
];

pub const TABLES: &[Row] = &[
    (
        "fragility t.csv --intensity im --outcome y --replicates 1",
        Write("t.csv", b"im,y\n1,0\n2,1\n3,0\n4,1\n"),
        2,
        &["--replicates: found 1; allowed: 0", "39 or more"],
    ),
    (
        "fragility t.csv --intensity im --outcome y",
        Write("t.csv", b"im;y\n0,5;1\n0,7;0\n"),
        2,
        &["t.csv:1: found columns parted by semicolons: `im;y`"],
    ),
    (
        "fragility t.csv --intensity im --outcome y",
        Write("t.csv", b"im,y\n\"0,5\",1\n\"0,7\",0\n"),
        2,
        &["t.csv:2: found im: \"0,5\"; allowed: a finite number with a decimal point: 0.5"],
    ),
    (
        "fragility t.csv --intensity ym --outcome y",
        Write("t.csv", b"im,y\n1,0\n2,1\n"),
        2,
        &["found no column \"ym\"; allowed: one of im, y"],
    ),
    (
        "fragility t.csv --intensity im --outcome y --method cloud",
        Write("t.csv", b"im,y\n1,0\n2,1\n"),
        2,
        &["found no --demand and no --limit"],
    ),
    (
        "fragility T.CSV --intensity im --outcome y --replicates 0",
        Write("T.CSV", b"im,y\n1,0\n2,1\n3,0\n4,1\n"),
        0,
        &["fragility"],
    ),
    ("fragility outputs/first", Nothing, 2, &["--outcome: found nothing; allowed: the column of outcomes"]),
    (
        "fragility outputs/first --intensity pgv_m_s --outcome outcome --replicates 100 --cluster record",
        Nothing,
        0,
        &["an end `?`", "`--replicates 0`"],
    ),
    (
        "calibrate experiment.toml --out c",
        Change("tests/weak.csv", "theta1_rad", "theta1_deg"),
        2,
        &["tests/weak.csv:1: found columns time_s, theta1_deg, theta2_rad", "did you mean \"theta1_deg\"?"],
    ),
];
