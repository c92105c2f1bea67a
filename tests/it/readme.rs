//! Figures of README.md and of the guide that come from the shipped inputs: made from runs, not written by hand.
//!
//! Marked blocks, `<!-- made by make readme: NAME -->` … `<!-- end -->`, hold them. `make readme` writes them anew.

mod beds;
mod blind;
mod block;
mod conclusions;
mod fragility;
mod moments;
mod studies;
mod survey;

use std::fs;
use std::path::Path;

use block::Page;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Compares the blocks of a page with what was made, or writes them where `UPDATE_README` is set.
fn check(name: &str, made: impl Fn(&mut Page)) {
    let path = Path::new(ROOT).join(name);
    let text = fs::read_to_string(&path).expect("a page of the repository");
    let mut page = Page::new(text.clone());
    made(&mut page);
    let unknown = page.blocks_not_made();
    assert!(unknown.is_empty(), "{name}: blocks that nothing makes: {unknown:?}");
    if std::env::var_os("UPDATE_README").is_some() {
        fs::write(&path, page.text()).expect("written");
        return;
    }
    let stale = page.stale();
    assert!(stale.is_empty(), "{name} is not what the program gives: `make readme` writes it\n{stale}");
}

#[test]
fn regress_the_readme_is_what_the_program_gives() {
    check("README.md", |page| {
        studies::counts(page);
        conclusions::blocks(page);
        fragility::blocks(page);
        beds::conclusion_block(page);
        beds::collapse_block(page);
        blind::block(page);
    });
}

#[test]
fn regress_the_guide_tells_medians_on_beds() {
    check("docs/how-sure.md", beds::median_block);
}

#[test]
fn regress_the_guide_tells_how_drawn_facades_meet_table_3() {
    check("docs/files.md", survey::blocks);
}

#[test]
fn regress_the_guide_tells_the_moment_of_measured_joints() {
    check("docs/measured-walls.md", moments::blocks);
}
