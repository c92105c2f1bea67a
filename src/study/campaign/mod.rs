//! A study that may be divided, stopped and gone on with, and ends in the same bits all the same.
//!
//! The plan is cut into blocks of neighbouring runs. A finished block is a file whose name holds its own checksum, so
//! it is whole or not there; when all blocks of a record are there they are put together into the record's one file.
//! That file depends on the blocks alone: not on threads, shards, interruptions or the order they were finished in.

mod compact;
mod layout;
mod shard;
mod standing;
mod work;

pub use compact::compact;
pub use layout::{BLOCK_RUNS, Block, Layout};
pub use shard::Shard;
pub use standing::Standing;
pub use work::{Work, run_missing};
