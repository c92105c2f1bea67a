//! One sample a line, no header; step from the caller, m/s² unless the caller says otherwise.

use super::ReadOptions;
use super::channel::Channel;
use super::format::is_blank_or_comment;
use super::source::{Source, number};
use mrbd_files::error::InputError;

pub(super) fn parse(source: &Source, options: &ReadOptions) -> Result<Vec<Channel>, InputError> {
    let Some(step_s) = options.step_s else {
        let allowed =
            "a step in seconds, which a single column does not tell: `--dt`, or `step_s` in the suite";
        return Err(source.fault_file("one column and no step", allowed));
    };
    let mut samples = Vec::new();
    for (index, line) in source.lines.iter().enumerate().filter(|(_, line)| !is_blank_or_comment(line)) {
        samples.push(number(line.trim()).ok_or_else(|| source.fault_line(index, "one finite number"))?);
    }
    Ok(vec![Channel { label: String::new(), step_s, unit: None, samples }])
}
