//! Studies on a disk that is full, and on one that cannot be written: a small one in memory.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::campaign::contents;
use crate::campaign_cli::{arguments, undisturbed};
use crate::pipeline_cli::{mrbd, stdout, study};
use crate::pipeline_support::SMALL;

/// A file system in memory, gone when this is dropped.
struct Disk(PathBuf);

impl Disk {
    /// None, after saying so, where none can be mounted.
    fn mount(at: PathBuf) -> Option<Self> {
        std::fs::create_dir(&at).expect("made");
        let output = Command::new("mount").args(["-t", "tmpfs", "-o", "size=16m", "tmpfs"]).arg(&at).output();
        match output {
            Ok(output) if output.status.success() => Some(Self(at)),
            _ => {
                eprintln!("SKIPPED: no tmpfs can be mounted here; root may");
                None
            }
        }
    }

    fn change(&self, options: &str) {
        let status = Command::new("mount").args(["-o", &format!("remount,{options}")]).arg(&self.0).status();
        assert!(status.expect("mount").success(), "{options}");
    }

    /// Leaves so much room, KiB.
    fn leave(&self, room_kib: u64) {
        let output = Command::new("df").args(["--output=used", "--block-size=1K"]).arg(&self.0).output();
        let used =
            stdout(&output.expect("df")).lines().last().and_then(|line| line.trim().parse::<u64>().ok());
        self.change(&format!("size={}k", used.expect("a number") + room_kib));
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        // A test that failed has more to tell than this.
        let _ = Command::new("umount").arg(&self.0).status();
    }
}

fn message(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The command fails for want of room, names the file and leaves what is there whole.
fn assert_full(at: &Path, arguments: &[&str]) {
    let before = contents(&at.join("out"));
    let output = mrbd(at, arguments);
    assert_eq!(output.status.code(), Some(1), "{}", message(&output));
    assert!(message(&output).contains("No space left on device"), "{}", message(&output));
    assert!(message(&output).contains("mrbd: out/"), "{}", message(&output));
    let after = contents(&at.join("out"));
    assert!(before.iter().all(|(path, sha256)| after.get(path) == Some(sha256)), "{arguments:?}");
    assert!(!after.keys().any(|path| path.to_string_lossy().contains(".unfinished")), "{after:?}");
    assert!(!stdout(&mrbd(at, &["status", "out"])).contains("damaged"));
}

#[test]
fn regress_a_study_on_a_full_disk_or_one_that_cannot_be_written_is_whole_and_goes_on() {
    let folder = study(SMALL);
    let at = folder.path();
    let whole = undisturbed(&folder);
    let Some(disk) = Disk::mount(at.join("out")) else { return };
    // Not even room for what a study begins with.
    disk.change("size=4k");
    let refused = mrbd(at, &arguments(&[]));
    let told = message(&refused);
    assert!(
        refused.status.code() == Some(1) && told.contains("cannot write: No space left on device"),
        "{told}"
    );
    disk.change("size=16m");
    stdout(&mrbd(at, &arguments(&["--shard", "1/3"])));
    // Room for some blocks, and for none.
    for room_kib in [40, 4] {
        disk.leave(room_kib);
        assert_full(at, &arguments(&["--resume"]));
    }
    // What is there can be told, if not kept.
    let told = mrbd(at, &["aggregate", "out", "--csv"]);
    assert!(
        stdout(&told).lines().count() > 10 && message(&told).contains("are not kept"),
        "{}",
        message(&told)
    );
    disk.change("size=16m");
    stdout(&mrbd(at, &arguments(&["--shard", "2/3"])));
    stdout(&mrbd(at, &arguments(&["--shard", "3/3"])));
    // All is done, and there is no room to put it together.
    disk.leave(8);
    assert_full(at, &["merge", "out"]);
    disk.change("size=16m,ro");
    for refused in [mrbd(at, &arguments(&["--resume"])), mrbd(at, &["merge", "out"])] {
        assert!(message(&refused).contains("Read-only file system"), "{}", message(&refused));
        assert!(!refused.status.success());
    }
    assert!(stdout(&mrbd(at, &["status", "out"])).contains("72 of 72 runs done"), "it can be read");
    disk.change("rw");
    stdout(&mrbd(at, &arguments(&["--resume"])));
    assert_eq!(contents(&at.join("out")), whole);
}
