//! Which kind of results a folder holds, and the page made from them.

use std::path::{Path, PathBuf};

use super::page::Page;
use super::sweep;
use crate::error::{Error, InputError, Result};
use crate::ground::Site;
use crate::store::{Manifest, write_durably};

/// Name of a page in the folder of its results.
pub const PAGE_NAME: &str = "report.html";

/// Makes the page of the results in a folder; gives where it is. Records are held against the code of a site.
///
/// # Errors
/// An input error for a folder that holds no results or damaged ones; [`crate::Error::Io`] if the disk refuses.
pub fn report(folder: &Path, site: Option<&Site>) -> Result<PathBuf> {
    let page = page_of(folder, site)?;
    let path = folder.join(PAGE_NAME);
    write_durably(&path, page.html()?.as_bytes())?;
    Ok(path)
}

fn page_of(folder: &Path, site: Option<&Site>) -> Result<Page> {
    if !folder.is_dir() {
        let found = if folder.exists() { "a file" } else { "nothing there" };
        return Err(InputError::file(folder, found, "a folder with results of mrbd").into());
    }
    match Manifest::read(&folder.join("manifest.json"))? {
        Some(manifest) => sweep::page(folder, &manifest, site).map_err(as_damage),
        None => {
            let allowed = "the output folder of `mrbd run`; for one run `mrbd simulate --plot FILE.html`";
            Err(InputError::file(folder, "no manifest.json", allowed).into())
        }
    }
}

/// Results that cannot be read are bad input here: whatever wrote them, a page cannot be made from them.
fn as_damage(error: Error) -> Error {
    match error {
        Error::Table { path, message } => {
            let allowed = "results as `mrbd run` writes them; run the study again with --force";
            InputError::file(&path, message, allowed).into()
        }
        other => other,
    }
}
