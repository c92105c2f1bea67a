//! Files that people write, checked at the door.
//!
//! Whatever a user gives is read here or by these means. It becomes a value that is valid, or it is refused: with the
//! file, the key or line, what was found and what is allowed ([`InputError`]).
//!
//! | module | what it reads |
//! | --- | --- |
//! | [`toml_file`] | any TOML file, unknown keys refused, the nearest known name suggested ([`suggestion`]) |
//! | [`wall_file`] | a wall: geometry, masses, restraint, effects; `[wall]` alone is enough |
//! | [`slips`] | numbers of a wall file in another unit than their key's |
//! | [`description`] | what a wall file means: weights, slenderness, what it takes to rock |
//! | [`coefficients`] | bounds and best fit of the impact coefficients C_l (the paper's Table 2) |
//! | [`checksum`] | any file, for the note that results keep of what they were made from |
//!
//! ```
//! use std::path::Path;
//!
//! let text = "
//!     [wall]
//!     thickness_m = 0.291
//!     height_m = 3.984
//!     crack_hieght_m = 2.191
//!     length_m = 1.5
//!     mass_kg = 3614.0
//! ";
//! let refused = mrbd_files::parse_wall(Path::new("wall.toml"), text).unwrap_err().to_string();
//! assert!(refused.starts_with("wall.toml:5: wall"), "{refused}");
//! assert!(refused.ends_with("did you mean `crack_height_m`?"), "{refused}");
//! ```

pub mod checksum;
pub mod coefficients;
pub mod description;
pub mod error;
pub mod slips;
pub mod suggestion;
pub mod toml_file;
pub mod wall_file;

pub use checksum::{FileNote, file_sha256};
pub use description::Description;
pub use error::{Error, InputError, Place, Result};
pub use wall_file::{load_block, load_static_wall, load_wall, parse_block, parse_wall, wall_from_table};
