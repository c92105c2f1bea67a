//! Words of commands that messages tell to copy.

use std::path::Path;

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
