//! `candidates.parquet`: every simulation of a calibration, one a row.

use std::path::Path;
use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, RecordBatch, StringArray, UInt32Array, UInt64Array};
use arrow_schema::{DataType, Field, Schema};
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, ZstdLevel};
use parquet::file::properties::WriterProperties;

use crate::error::{Error, Result};
use crate::store::write_durably;
use mrbd_lab::calibrate::Parameter;
use mrbd_lab::calibrate::Row;
use mrbd_lab::experiment::Test;

/// Writes the rows; the columns are `method, test, generation, index`, the parameters by name, `wme, outcome` and the
/// `steps` of the integration, and the numbers of impacts `impacts_C_1` … `impacts_C_8`.
///
/// # Errors
/// [`Error::Table`] or [`mrbd_files::Error::Io`] if the file cannot be written.
pub fn write_candidates(path: &Path, rows: &[Row], parameters: &[Parameter], tests: &[Test]) -> Result<()> {
    let columns = columns(rows, parameters, tests);
    let fields = columns.iter().map(|(name, unit, about, array)| field(name, unit, about, array));
    let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
    let arrays = columns.iter().map(|(_, _, _, array)| Arc::clone(array)).collect();
    let bytes = RecordBatch::try_new(Arc::clone(&schema), arrays)
        .map_err(parquet::errors::ParquetError::from)
        .and_then(|batch| encoded(&batch))
        .map_err(|e| Error::table(path, e))?;
    write_durably(path, &bytes)
}

type NamedColumn = (String, &'static str, String, ArrayRef);

fn columns(rows: &[Row], parameters: &[Parameter], tests: &[Test]) -> Vec<NamedColumn> {
    let text = |of: &dyn Fn(&Row) -> String| -> ArrayRef {
        Arc::new(rows.iter().map(|row| Some(of(row))).collect::<StringArray>())
    };
    let mut columns: Vec<NamedColumn> = vec![
        (
            "method".into(),
            "",
            "Search that asked for the simulation".into(),
            text(&|r| r.address.method.clone()),
        ),
        ("test".into(), "", "Test simulated".into(), text(&|r| tests[r.address.test].name.clone())),
        ("generation".into(), "", "Generation of the search, from 0".into(), {
            Arc::new(rows.iter().map(|r| r.address.generation).collect::<UInt32Array>())
        }),
        ("index".into(), "", "Place in the generation, from 0".into(), {
            Arc::new(rows.iter().map(|r| r.address.index).collect::<UInt32Array>())
        }),
    ];
    for (v, parameter) in parameters.iter().enumerate() {
        let values = rows.iter().map(|r| Some(r.values[v])).collect::<Float64Array>();
        columns.push((parameter.name.clone(), "", "Value of the parameter".into(), Arc::new(values)));
    }
    let wme = rows.iter().map(|r| r.wme).collect::<Float64Array>();
    columns.push((
        "wme".into(),
        "1",
        "Eq. 8; null where the run could not be finished".into(),
        Arc::new(wme),
    ));
    let about =
        "How the run ended: stood, collapsed, failed, abandoned (hopeless), impossible (no such wall)";
    columns.push(("outcome".into(), "", about.into(), text(&|r| r.outcome.clone())));
    let steps = rows.iter().map(|r| r.steps).collect::<UInt64Array>();
    columns.push(("steps".into(), "", "Steps of the integration".into(), Arc::new(steps)));
    for l in 0..8 {
        let counts = rows.iter().map(|r| r.transitions[l]).collect::<UInt64Array>();
        let about = format!("Impacts scaled by C_{}", l + 1);
        columns.push((format!("impacts_C_{}", l + 1), "", about, Arc::new(counts)));
    }
    columns
}

fn field(name: &str, unit: &str, about: &str, array: &ArrayRef) -> Field {
    let nullable = *array.data_type() == DataType::Float64;
    let metadata = [("unit", unit), ("description", about)];
    let metadata = metadata.map(|(key, value)| (key.to_owned(), value.to_owned()));
    Field::new(name, array.data_type().clone(), nullable).with_metadata(metadata.into_iter().collect())
}

fn encoded(batch: &RecordBatch) -> parquet::errors::Result<Vec<u8>> {
    let zstd = Compression::ZSTD(ZstdLevel::try_new(3)?);
    let properties = WriterProperties::builder().set_compression(zstd).build();
    let mut bytes = Vec::new();
    let mut writer = ArrowWriter::try_new(&mut bytes, batch.schema(), Some(properties))?;
    writer.write(batch)?;
    writer.close()?;
    Ok(bytes)
}
