//! "Did you mean": the known name that a misspelt one was meant to be.

/// Likeness after Jaro and Winkler below which two names are different words; a unit left out stays above it.
const ALIKE: f64 = 0.8;

/// The one among known names that is most like what was found; `None` if nothing is.
pub fn nearest<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let likeness = |name: &'a str| (strsim::jaro_winkler(found, name), name);
    let alike = known.into_iter().map(likeness).filter(|(likeness, _)| *likeness >= ALIKE);
    alike.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, name)| name)
}

/// What is allowed, and after it the name that was likely meant.
pub fn with_suggestion<'a>(allowed: String, found: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    match nearest(found, known) {
        Some(name) => format!("{allowed}; did you mean `{name}`?"),
        None => allowed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEYS: [&str; 7] = [
        "thickness_m",
        "height_m",
        "crack_height_m",
        "length_m",
        "mass_kg",
        "density_kg_m3",
        "stiffness_n_per_m",
    ];

    #[test]
    fn regress_slips_and_lost_units_are_recognised() {
        for (found, meant) in [
            ("hieght_m", "height_m"),
            ("height", "height_m"),
            ("heigth_mm", "height_m"),
            ("thicknes_m", "thickness_m"),
            ("crackheight_m", "crack_height_m"),
            ("density", "density_kg_m3"),
            ("mass_t", "mass_kg"),
            ("stiffness_kn_m", "stiffness_n_per_m"),
        ] {
            assert_eq!(nearest(found, KEYS), Some(meant), "{found}");
        }
    }

    #[test]
    fn regress_other_words_are_not_guessed_at() {
        for found in ["colour", "k_d", "restitution", "x", ""] {
            assert_eq!(nearest(found, KEYS), None, "{found}");
        }
    }
}
