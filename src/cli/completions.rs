//! `mrbd completions`: what a shell needs to complete commands and options.

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::{Cli, output};
use crate::error::Result;

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
