//! Words for the shell: commands that messages tell to copy, and `mrbd completions`.

use std::path::Path;

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::{Cli, output};
use crate::error::Result;

/// A path as one word of a shell: quoted only where a shell would take it for something else.
pub(super) fn shell_word(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = |c: char| c.is_alphanumeric() || "-_./,:+@=%".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        text
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

/// Print completions of commands and options for a shell.
///
/// Examples:
///   mrbd completions bash > ~/.local/share/bash-completion/completions/mrbd
///   mrbd completions zsh > "${fpath[1]}/_mrbd"
///   mrbd completions fish > ~/.config/fish/completions/mrbd.fish
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct CompletionsCommand {
    /// The shell.
    shell: Shell,
}

impl CompletionsCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// What the system says of stdout.
    pub fn execute(self) -> Result<()> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut Cli::command(), "mrbd", &mut script);
        output::to_stdout(|out| out.write_all(&script).map_err(output::failed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_words_with_blanks_and_quotes_are_quoted() {
        for (path, word) in [
            ("plain/né-1.csv", "plain/né-1.csv"),
            ("né w/d eep", "'né w/d eep'"),
            ("it's", r"'it'\''s'"),
            ("", "''"),
        ] {
            assert_eq!(shell_word(Path::new(path)), word);
        }
    }
}
