//! Bars on stderr, silent where stderr is not a terminal.

use indicatif::{ProgressBar, ProgressFinish, ProgressState, ProgressStyle};

use mrbd_lab::Progress;

/// Of runs, with rate and time left.
pub fn of_runs(runs: u64) -> ProgressBar {
    let style = style(
        "{bar:30} {human_pos}/{human_len} runs  {rate}  {elapsed_precise} gone, {eta_precise} left",
        ProgressStyle::default_bar,
    );
    let rate = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        // A text that cannot take a number has nowhere to say so.
        let _ = write!(out, "{:.0} a second", state.per_sec());
    };
    ProgressBar::new(runs).with_style(style.with_key("rate", rate))
}

/// What the laboratory is at.
#[derive(Debug)]
pub struct Bar(ProgressBar);

impl Bar {
    /// Of the parts of one step after another.
    pub fn of_steps() -> Self {
        let style =
            style("{msg}: {pos} of {len}  {bar:30}  {elapsed}, {eta} left", ProgressStyle::default_bar);
        Self(ProgressBar::new(1).with_style(style).with_finish(ProgressFinish::AndClear))
    }

    /// Of runs, with rate and time left.
    pub fn of_counted_runs() -> Self {
        Self(of_runs(1).with_finish(ProgressFinish::AndClear))
    }

    /// Of simulations, whose number nobody knows beforehand.
    pub fn of_simulations() -> Self {
        let style = style(
            "{spinner} {human_pos} simulations  {per_sec}  {elapsed}  {msg}",
            ProgressStyle::default_spinner,
        );
        Self(ProgressBar::new_spinner().with_style(style).with_finish(ProgressFinish::AndClear))
    }
}

impl Progress for Bar {
    fn begin(&self, what: &str, parts: usize) {
        // Both at once: a bar drawn between them would show the count of one step beside the length of another.
        self.0.update(|state| {
            state.set_pos(0);
            state.set_len(parts as u64);
        });
        self.0.reset_eta();
        self.note(what);
    }

    fn advance(&self, parts: usize) {
        self.0.inc(parts as u64);
    }

    fn note(&self, text: &str) {
        self.0.set_message(text.to_owned());
    }
}

/// A style; a template that does not parse would be a slip of this file, and the plain one then does.
fn style(template: &str, plain: fn() -> ProgressStyle) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| plain())
}
