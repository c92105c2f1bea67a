//! Studies of drawn façades: their plans, what is stored of them, and what is told from that.

use std::collections::BTreeSet;
use std::path::Path;

use arrow_array::cast::AsArray;
use arrow_array::types::UInt64Type;
use arrow_array::{Array, RecordBatch};
use mrbd::aggregate::{CAPACITY, Distribution, distributions};
use mrbd::study::batch::{Finished, run_one};
use mrbd::study::campaign::Shard;
use mrbd::study::pipeline::Kind;
use mrbd::study::plan::Plan;
use mrbd::study::runs::{Earlier, run_files};
use mrbd::survey::Configuration;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{Accuracy, Outcome, Response, Shaking};
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;

use crate::campaign::{contents, do_missing, merge, prepare};
use crate::drawn_support::{capacity_m_s2, drawn, incremental, monte_carlo, proportional, stripes};
use crate::pipeline_support::{plan, response, suite, try_plan};

/// All runs of a plan, stored and put together.
fn stored(
    plan: &Plan,
    simulate: &(impl Fn(&Wall, &Shaking, Accuracy) -> Response + Sync),
) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let output = prepare(folder.path(), plan, Earlier::Refuse).expect("an empty folder");
    do_missing(plan, &output, (Shard::WHOLE, 2), simulate).expect("runs");
    merge(&output).expect("put together");
    folder
}

/// All rows of a study.
fn rows(folder: &Path) -> Vec<RecordBatch> {
    let read = |path: &std::path::PathBuf| {
        let file = std::fs::File::open(path).expect("a file");
        let reader =
            ParquetRecordBatchReaderBuilder::try_new(file).expect("Parquet").build().expect("a reader");
        reader.map(|batch| batch.expect("rows")).collect::<Vec<_>>()
    };
    run_files(folder).expect("files").iter().flat_map(read).collect()
}

fn counts(rows: &[RecordBatch], column: &str) -> Vec<Option<u64>> {
    let of = |batch: &RecordBatch| {
        let array = batch.column_by_name(column).expect("a column").clone();
        array.as_primitive::<UInt64Type>().iter().collect::<Vec<_>>()
    };
    rows.iter().flat_map(of).collect()
}

fn nulls(rows: &[RecordBatch], column: &str) -> usize {
    rows.iter().map(|batch| batch.column_by_name(column).expect("a column").logical_null_count()).sum()
}

#[test]
fn analytic_a_draw_is_one_facade_in_all_runs_it_takes_part_in() {
    let plan = plan(&stripes(), 3);
    assert_eq!((plan.kind(), plan.len()), (Kind::Stripes, 3 * 2 * 3 * 6));
    let runs: Vec<_> = (0..plan.len()).map(|position| plan.run(position)).collect();
    let ids: BTreeSet<_> = runs.iter().map(|run| run.id.clone()).collect();
    assert_eq!(ids.len(), runs.len());
    for run in &runs {
        assert_eq!(run.id, plan.run(run.position).id, "a run does not depend on those before it");
        let same = runs.iter().filter(|other| other.draw() == run.draw());
        for other in same {
            assert_eq!(
                other.facade.thickness_m, run.facade.thickness_m,
                "whatever record, floor and intensity"
            );
            if other.configuration == run.configuration {
                assert_eq!(other.facade, run.facade);
            }
        }
        let (measure, asked) = run.scaled_to().expect("a stripe");
        let peak = run.shaking().horizontal.expect("a record").peak_m_s2();
        // One rounding of the factor and one of the product.
        assert!(
            (peak / asked - 1.0).abs() < 1e-15 && (measure.of(&run.intensity()) / asked - 1.0).abs() < 1e-15
        );
    }
    // The runs of a record stand together, and so do those of one of its intensities.
    let changes = |key: &dyn Fn(usize) -> u64| (1..runs.len()).filter(|&i| key(i) != key(i - 1)).count();
    assert_eq!(changes(&|i| runs[i].record_index as u64), 2);
    assert_eq!(changes(&|i| runs[i].factor.to_bits()), 3 * 2 * 3 - 1);
}

#[test]
fn analytic_more_draws_and_records_leave_the_earlier_ones_as_they_are() {
    let plain = |kind: &str, table: &str, count: u32, records: u32| {
        let text = drawn(kind, table).replace("latin_hypercube", "plain");
        let plan = plan(&text.replace("count = 6", &format!("count = {count}")), records);
        (0..plan.len()).map(|i| plan.run(i).id).collect::<BTreeSet<_>>()
    };
    for (kind, table) in [("monte_carlo", ""), ("cloud", "[cloud]\nfrom = 0.5\nto = 4.0\n")] {
        assert!(plain(kind, table, 6, 2).is_subset(&plain(kind, table, 9, 3)), "{kind}");
    }
}

#[test]
fn analytic_factors_of_a_cloud_fill_its_range() {
    let text = drawn("cloud", "[cloud]\nfrom = 0.5\nto = 8.0\n").replace("count = 6", "count = 500");
    let plan = plan(&text, 2);
    let ln: Vec<f64> = (0..plan.len()).map(|i| plan.run(i).factor.ln()).collect();
    assert!(ln.iter().all(|&x| x > 0.5f64.ln() && x < 8f64.ln()));
    // 1000 different factors (floors share them) of a uniform of width 4 ln 2: deviation 0.80/√1000 = 0.025, times four.
    let mean = ln.iter().sum::<f64>() / ln.len() as f64;
    assert!((mean - 2f64.ln()).abs() < 0.1, "{mean}");
    let different: BTreeSet<u64> = ln.iter().map(|x| x.to_bits()).collect();
    assert_eq!(different.len(), 1000, "a record has its own factor of a draw, both floors the same");
}

#[test]
fn regress_facades_that_are_no_wall_are_failed_rows_with_their_inputs() {
    // Parallel floors of nearly the whole mass: about every second draw leaves none to the wall or crushes its corners.
    let heavy = "[sampling.fixed]\ncarriage_mass_ratio = 0.965\n";
    let text = drawn("monte_carlo", "").replace("[[variants]]", &format!("{heavy}\n[[variants]]"));
    let text = text
        .replace("count = 6", "count = 40")
        .replace("[sampling]", "configurations = [\"parallel\"]\n[sampling]");
    let plan = plan(&text, 1);
    let impossible = (0..plan.len()).filter(|&i| plan.run(i).wall.is_err()).count();
    assert!((5..35).contains(&impossible), "{impossible}");
    let folder = stored(&plan, &proportional);
    let rows = rows(folder.path());
    assert_eq!(rows.iter().map(RecordBatch::num_rows).sum::<usize>(), 40, "nothing is dropped");
    for column in ["height_m", "lower_width_m", "theta1_max_rad", "collapsed"] {
        assert_eq!(nulls(&rows, column), impossible, "{column}");
    }
    for column in
        ["draw", "thickness_m", "slenderness", "stiffness_n_per_m", "carriage_mass_ratio", "law", "pga_g"]
    {
        assert_eq!(nulls(&rows, column), 0, "{column}");
    }
    assert_eq!(nulls(&rows, "reason"), 40 - impossible);
    assert_eq!(nulls(&rows, "parameter"), 40, "drawn façades have no level");
    let told = distributions(folder.path(), Kind::MonteCarlo).expect("distributions");
    assert!(told.rows.iter().all(|row| row.failed == impossible as u64 && row.runs == 40));
    let simulations: u64 = counts(&rows, "simulations").into_iter().flatten().sum();
    assert_eq!(simulations, 40 - impossible as u64);
}

#[test]
fn regress_drawn_studies_give_the_same_bits_in_parts_and_when_resumed() {
    for text in [monte_carlo(), stripes(), incremental()] {
        let plan = plan(&text, 3);
        let whole = stored(&plan, &proportional);
        let parts = tempfile::tempdir().expect("a temporary folder");
        let mut runs = 0;
        for (index, threads) in [(2, 3), (1, 1)] {
            let output = prepare(parts.path(), &plan, Earlier::Share).expect("the same plan");
            let shard = Shard::new(index, 2).expect("a shard");
            runs += do_missing(&plan, &output, (shard, threads), &proportional).expect("runs").runs();
        }
        assert_eq!(runs, plan.len());
        let output = prepare(parts.path(), &plan, Earlier::Resume).expect("the same plan");
        merge(&output).expect("complete");
        assert_eq!(contents(parts.path()), contents(whole.path()));
    }
}

#[test]
fn analytic_incremental_analyses_bracket_the_capacity() {
    let plan = plan(&incremental(), 2);
    assert_eq!(plan.len(), 2 * 2 * 2 * 6);
    for position in 0..plan.len() {
        let finished = run_one(plan.run(position), &proportional);
        let found = finished.found.expect("an analysis");
        let (_, intensity) = finished.run.scaled_to().expect("an intensity");
        let capacity = capacity_m_s2(finished.run.wall.as_ref().expect("a wall"));
        let limit = finished.run.growth().expect("an analysis").limit.to_string();
        // Collapse at the capacity; θ2/α2 = 0.5 at 0.5/0.8 of it.
        let expected = if limit == "collapse" { capacity } else { 0.625 * capacity };
        assert!(found.exceeded && found.stood_intensity <= expected && expected <= intensity, "{found:?}");
        assert!(intensity / found.stood_intensity <= 1.02, "{found:?}");
        let response = finished.usable().expect("a response");
        assert_eq!(response.collapsed(), limit == "collapse", "the run kept is the one at the upper end");
        // Growth to it in steps of 1.5, and log2(ln 1.5/ln 1.02) = 4.4 halvings.
        let steps = ((expected / 0.5).ln() / 1.5f64.ln()).ceil() as u64 + 1;
        assert_eq!(finished.simulations, steps + 5, "{expected}");
    }
}

#[test]
fn analytic_medians_of_capacities_lie_in_the_middle_of_their_brackets() {
    let plan = plan(&incremental(), 2);
    let folder = stored(&plan, &proportional);
    let told = distributions(folder.path(), Kind::Incremental).expect("distributions");
    for floor in Configuration::ALL {
        let of_floor = |finished: &Finished| {
            let growth = finished.run.growth().expect("an analysis");
            finished.run.configuration == floor && growth.limit.to_string() == "collapse"
        };
        let runs = (0..plan.len()).map(|position| run_one(plan.run(position), &proportional));
        let (mut middles, mut capacities): (Vec<f64>, Vec<f64>) = runs
            .filter(of_floor)
            .map(|finished| {
                let (_, intensity) = finished.run.scaled_to().expect("an intensity");
                let stood = finished.found.expect("an analysis").stood_intensity;
                ((stood * intensity).sqrt(), capacity_m_s2(finished.run.wall.as_ref().expect("a wall")))
            })
            .unzip();
        assert_eq!(middles.len(), 12, "six façades under two records");
        middles.sort_by(f64::total_cmp);
        capacities.sort_by(f64::total_cmp);
        let median = |values: &[f64]| 0.5 * (values[5] + values[6]);
        let of_collapse = |row: &&Distribution| {
            let limit = row.limit.as_deref() == Some("collapse");
            limit && row.configuration == floor.name() && row.record.is_none() && row.quantity == CAPACITY
        };
        let found = told.rows.iter().find(of_collapse).and_then(Distribution::median).expect("a median");
        // The same sum in another order: rounding.
        assert!((found / median(&middles) - 1.0).abs() < 1e-15, "{found} {middles:?}");
        // A bracket is 2 % wide, its middle within 1 % of what lies in it.
        assert!((found / median(&capacities) - 1.0).abs() < 0.01, "{found} {capacities:?}");
    }
}

#[test]
fn analytic_incremental_analyses_tell_what_they_cannot_bracket() {
    let of = |from: &str, to: &str, simulate: &dyn Fn(&Wall, &Shaking, Accuracy) -> Response| {
        let text = incremental().replace("from = 0.5", from).replace("to = 60.0", to);
        run_one(plan(&text, 1).run(0), &|wall: &Wall, shaking: &Shaking, accuracy| {
            simulate(wall, shaking, accuracy)
        })
    };
    let capacity = |run: &mrbd::study::plan::Run| capacity_m_s2(run.wall.as_ref().expect("a wall"));
    let never = of("from = 0.5", "to = 1.1", &proportional);
    let found = never.found.expect("an analysis");
    assert!(!found.exceeded && found.stood_intensity == 1.1, "{found:?}");
    assert!((never.run.scaled_to().expect("an intensity").1 / 1.1 - 1.0).abs() < 1e-15);
    let early = of("from = 50.0", "to = 60.0", &proportional);
    let found = early.found.expect("an analysis");
    assert!(
        found.exceeded && found.stood_intensity < capacity(&early.run),
        "intensities fall where the first is too much"
    );
    let fallen = |wall: &Wall, _: &Shaking, _| response(wall, 2.0, Outcome::Collapsed { time_s: 0.1 });
    let always = of("from = 0.5", "to = 60.0", &fallen);
    assert_eq!((always.outcome(), always.found), ("failed", None));
    assert!(always.failure.expect("a reason").contains("however low"));
    let broken = |wall: &Wall, _: &Shaking, _| {
        response(wall, 0.1, Outcome::Failed { time_s: 0.1, reason: "no contact state".into() })
    };
    assert_eq!(of("from = 0.5", "to = 60.0", &broken).failure.as_deref(), Some("no contact state"));
}

#[test]
fn analytic_distributions_are_over_draws_and_records() {
    let plan = plan(&stripes(), 2);
    let folder = stored(&plan, &proportional);
    let told = distributions(folder.path(), Kind::Stripes).expect("distributions");
    assert_eq!(told.measure.as_deref(), Some("pga_m_s2"));
    let row = |record: Option<&str>, intensity: f64| -> &Distribution {
        let same = |row: &&Distribution| {
            row.quantity == "theta1_max_over_alpha1"
                && row.configuration == "parallel"
                && row.record.as_deref() == record
                && row.intensity == Some(intensity)
        };
        told.rows.iter().find(same).expect("a group")
    };
    let runs = (0..plan.len()).map(|i| plan.run(i));
    let runs: Vec<_> = runs.filter(|run| run.configuration == Configuration::Parallel).collect();
    for intensity in [1.0, 4.0, 9.0] {
        let at = runs.iter().filter(|run| run.scaled_to().is_some_and(|(_, asked)| asked == intensity));
        let shares = at.map(|run| intensity / capacity_m_s2(run.wall.as_ref().expect("a wall")));
        let mut shares: Vec<f64> = shares.collect();
        shares.sort_by(f64::total_cmp);
        let fell = shares.iter().filter(|&&share| share >= 1.0).count();
        let all = row(None, intensity);
        assert_eq!((all.runs, all.beyond), (12, fell as u64));
        assert_eq!(row(Some("record 2"), intensity).runs, 6);
        // The median of 12: between the 6th and the 7th, if they stood.
        let middle = (shares[6] < 1.0).then(|| 0.4 * (shares[5] + shares[6]) / 2.0);
        match (all.median(), middle) {
            // Roundings of an angle over an angle.
            (Some(found), Some(expected)) => {
                assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}")
            }
            (found, expected) => assert_eq!(found, expected),
        }
    }
}

#[test]
fn rejects_studies_that_cannot_be_with_their_key() {
    let refused = |text: &str| {
        let error = std::panic::catch_unwind(|| {
            let pipeline = mrbd::study::pipeline::Pipeline::parse(Path::new("study.toml"), text.to_owned());
            pipeline.and_then(|_| try_plan(text, suite(1))).expect_err("must be refused")
        });
        let error = error.expect("no panic");
        assert_eq!(error.exit_code(), 2);
        error.to_string()
    };
    let stripes_with = |from: &str, to: &str| {
        let text = stripes().replacen(from, to, 1);
        assert_ne!(text, stripes(), "the test must change the file");
        refused(&text)
    };
    for (from, to, told) in [
        ("kind = \"stripes\"", "kind = \"strips\"", "strips"),
        ("kind = \"stripes\"", "kind = \"monte_carlo\"", "study.toml: stripes: found it in a study of kind"),
        ("[1.0, 4.0, 9.0]", "[]", "stripes.levels"),
        ("[1.0, 4.0, 9.0]", "[4.0, 1.0]", "stripes.levels: found [4.0, 1.0]"),
        ("pga_m_s2", "duration_5_95_s", "duration_5_95_s"),
        ("count = 6", "count = 0", "study.toml: sampling.count: found 0"),
        ("count = 6", "count = 16777217", "16777216"),
        ("design = \"latin_hypercube\"", "count_ = 1", "count_"),
        ("[sampling]", "configurations = []\n[sampling]", "configurations: found []"),
        ("[sampling]", "[samplings]", "samplings"),
        (
            "design = \"latin_hypercube\"",
            "truncation = { thickness_m = { lower = 9.0 } }",
            "sampling.truncation.thickness_m",
        ),
    ] {
        let message = stripes_with(from, to);
        assert!(message.contains(told), "{told} in {message}");
    }
    let plain = stripes().replace("latin_hypercube", "plain").replace("count = 6", "count = 999999999999");
    assert!(refused(&plain).contains("at most 1000000000000 runs"), "{}", refused(&plain));
    let incremental_with = |from: &str, to: &str| refused(&incremental().replacen(from, to, 1));
    assert!(incremental_with("growth = 1.5", "growth = 1.0").contains("incremental.growth: found 1"));
    assert!(incremental_with("to = 60.0", "to = 0.1").contains("incremental: found from 0.5 to 0.1"));
    assert!(incremental_with("0.5]", "2.5]").contains("incremental.limits"));
    assert!(incremental_with("\"collapse\"", "\"colapse\"").contains("colapse"));
    assert!(incremental_with("\"collapse\", 0.5", "").contains("incremental.limits: found []"));
    let monte_carlo =
        monte_carlo().replace("[sampling]\ncount = 6\nseed = 3\ndesign = \"latin_hypercube\"\n", "");
    assert!(refused(&monte_carlo).contains("missing field `sampling`"), "{}", refused(&monte_carlo));
}
