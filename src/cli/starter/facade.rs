//! A façade with a floor, at the typical values of the survey.

use clap::ValueEnum;

const TEMPLATE: &str = include_str!("facade.toml");

/// Thickness, height and length of the template, m, and its density, kg/m³.
const SIZE_M: [f64; 3] = [0.5, 6.0, 1.0];
const DENSITY_KG_M3: f64 = 1800.0;

/// Floors of the survey, by the direction of their beams.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Floor {
    /// Beams rest on the façade.
    Perpendicular,
    /// Beams run along the façade.
    Parallel,
}

/// What Table 3 has of a floor, column μ.
struct Typical {
    words: &'static str,
    stiffness_n_per_m: f64,
    /// m_d/m_tot, m_tot the masses of wall and floor.
    diaphragm_mass_ratio: f64,
    /// m_dp/m_tot.
    carriage_mass_ratio: f64,
}

impl Floor {
    fn typical(self) -> Typical {
        match self {
            Floor::Perpendicular => Typical {
                words: "beams rest on the façade: half of the floor's mass acts in both directions",
                stiffness_n_per_m: 1400e3,
                diaphragm_mass_ratio: 0.09,
                carriage_mass_ratio: 0.0,
            },
            Floor::Parallel => Typical {
                words: "beams run along the façade: a tenth of the floor's mass loads it, half of it pushes it",
                stiffness_n_per_m: 1200e3,
                diaphragm_mass_ratio: 0.03,
                carriage_mass_ratio: 0.14,
            },
        }
    }

    /// The wall file of a façade with this floor.
    pub fn wall_file(self) -> String {
        let Typical { words, stiffness_n_per_m, diaphragm_mass_ratio, carriage_mass_ratio } = self.typical();
        let mass_kg = DENSITY_KG_M3 * SIZE_M.iter().product::<f64>();
        // Ratios are to the masses of wall and floor: m_tot = m / (1 - m_d/m_tot - m_dp/m_tot).
        let total_kg = mass_kg / (1.0 - diaphragm_mass_ratio - carriage_mass_ratio);
        let share = |ratio: f64| format!("{:.1}", ratio * total_kg);
        TEMPLATE
            .replace("{words}", words)
            .replace("{m_dp}", &share(carriage_mass_ratio))
            .replace("{m_d}", &share(diaphragm_mass_ratio))
            .replace("{k_d}", &format!("{stiffness_n_per_m:e}"))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use mrbd_files::{parse_wall, slips};

    /// The middle value of a key of the survey.
    fn survey(table: &str, key: &str) -> f64 {
        let survey: toml::Table = include_str!("../../../inputs/survey.toml").parse().expect("the survey");
        survey[table][key][1].as_float().expect("a number")
    }

    #[test]
    fn published_a_typical_facade_has_the_values_of_table_3() {
        for (floor, table) in [(Floor::Perpendicular, "perpendicular"), (Floor::Parallel, "parallel")] {
            let wall = parse_wall(Path::new("facade.toml"), &floor.wall_file()).expect("a wall");
            let p = wall.parameters();
            let total_kg = p.mass_kg + p.diaphragm_mass_kg + p.carriage_mass_kg;
            for (found, expected) in [
                (p.thickness_m, survey("wall", "thickness_m")),
                (p.height_m / p.thickness_m, survey("wall", "slenderness")),
                (p.crack_height_m.unwrap_or(0.0) / p.height_m, survey("wall", "crack_height_ratio")),
                (p.stiffness_n_per_m, survey(table, "stiffness_n_per_m")),
                (p.diaphragm_mass_kg / total_kg, survey(table, "diaphragm_mass_ratio")),
                (p.carriage_mass_kg / total_kg, survey(table, "carriage_mass_ratio")),
            ] {
                // Masses are written to a tenth of a kilogramme, of 190 for the least: half of it is 3e-4.
                assert!((found - expected).abs() <= 3e-4 * expected.abs(), "{table}: {found} for {expected}");
            }
            assert_eq!(slips::questions(&wall), Vec::<String>::new());
        }
    }
}
