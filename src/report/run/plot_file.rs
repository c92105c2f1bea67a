//! The file of a run's picture, its kind told by its extension.

use std::path::{Path, PathBuf};

use super::RunPicture;
use crate::error::{InputError, Result};
use crate::store::write_durably;

/// A picture to be written, checked before the run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlotFile {
    path: PathBuf,
    kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Svg,
    Png,
    Html,
}

impl PlotFile {
    /// The picture at a path.
    ///
    /// # Errors
    /// An extension other than .svg, .png and .html; a folder that is not there.
    pub fn new(path: &Path) -> Result<Self> {
        let refuse =
            |found: String, allowed: &str| Err(InputError::key(path, "--plot", found, allowed).into());
        let kind =
            match path.extension().and_then(|extension| extension.to_str()).map(str::to_lowercase).as_deref()
            {
                Some("svg") => Kind::Svg,
                Some("png") => Kind::Png,
                Some("html") => Kind::Html,
                other => {
                    return refuse(format!("extension {:?}", other.unwrap_or("")), ".svg, .png or .html");
                }
            };
        match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => refuse(
                format!("the folder {}, which is not there", folder.display()),
                "a file in a folder that is there",
            ),
            _ => Ok(Self { path: path.to_path_buf(), kind }),
        }
    }

    /// Draws and writes it.
    ///
    /// # Errors
    /// [`crate::Error::Picture`] or [`mrbd_files::Error::Io`].
    pub fn write(&self, picture: &RunPicture) -> Result<()> {
        let bytes = match self.kind {
            Kind::Svg => picture.svg().into_bytes(),
            Kind::Png => picture.png()?,
            Kind::Html => picture.html()?.into_bytes(),
        };
        write_durably(&self.path, &bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rejects_pictures_of_unknown_kinds_and_places() {
        for (path, said) in [("a.gif", "\"gif\""), ("a", "\"\""), ("no/such/folder/a.svg", "not there")] {
            let error = PlotFile::new(Path::new(path)).expect_err("must be refused");
            assert_eq!(error.exit_code(), 2);
            assert!(error.to_string().contains(said), "{error}");
        }
        assert!(PlotFile::new(Path::new("a.html")).is_ok());
    }
}
