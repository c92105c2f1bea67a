//! Where finished runs go: one file a record, closed when its last run has come.

use super::folder::OutputFolder;
use super::parquet_file::ParquetFile;
use crate::batch::Finished;
use crate::error::Result;

/// Takes finished runs in the order of the plan, in which the runs of a record stand together.
pub struct RunSink<'a> {
    folder: &'a OutputFolder,
    shard: u32,
    open: Option<(usize, ParquetFile<Finished>)>,
}

impl<'a> RunSink<'a> {
    /// A sink into a folder; `shard` numbers the part of the study, from 1.
    pub fn new(folder: &'a OutputFolder, shard: u32) -> Self {
        Self { folder, shard, open: None }
    }

    /// Takes a block of runs.
    ///
    /// # Errors
    /// [`crate::Error::Io`] or [`crate::Error::Table`] if the disk refuses.
    pub fn keep(&mut self, block: &[Finished]) -> Result<()> {
        for runs in block.chunk_by(|a, b| a.run.record_index == b.run.record_index) {
            self.file_of(&runs[0])?.write(runs)?;
        }
        Ok(())
    }

    /// Closes the last file.
    ///
    /// # Errors
    /// As [`RunSink::keep`].
    pub fn finish(self) -> Result<()> {
        self.open.map_or(Ok(()), |(_, file)| file.finish())
    }

    fn file_of(&mut self, first: &Finished) -> Result<&mut ParquetFile<Finished>> {
        let record = first.run.record_index;
        let open = match self.open.take() {
            Some((current, file)) if current == record => (record, file),
            earlier => {
                earlier.map_or(Ok(()), |(_, file)| file.finish())?;
                (record, self.folder.begin_part(&first.run.record().name, self.shard)?)
            }
        };
        Ok(&mut self.open.insert(open).1)
    }
}
