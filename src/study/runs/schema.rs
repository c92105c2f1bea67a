//! The table of all columns: name, unit, meaning, and how each is read off a run.
//!
//! This is the one place that says what a result file holds. A value that does not exist (the collapse time of a
//! wall that stood, any result of a failed run, the wall of a façade that is none) is null, never a number that stands
//! for it.

use std::borrow::Cow;

use crate::store::column::{Column, Read};
use crate::study::batch::Finished;
use crate::survey::Assumptions;
use mrbd_kernel::model::{Restitution, Wall, WallParameters};
use mrbd_kernel::simulate::{Outcome, following};
use mrbd_records::SuiteRecord;

/// Version of the columns; it changes whenever one is added, removed or changes its meaning.
pub const SCHEMA_VERSION: u32 = 4;

/// The oldest version whose files are read as they are: columns were added since, and none changed.
pub const OLDEST_READ: u32 = 3;

/// The wall; none of a drawn façade that is none.
fn wall(f: &Finished) -> Option<&WallParameters> {
    f.run.wall.as_ref().ok().map(Wall::parameters)
}

fn restitution(f: &Finished) -> &Restitution {
    &f.run.restitution
}

fn assumed(f: &Finished) -> &Assumptions {
    &f.run.variant.assumptions
}

fn record(f: &Finished) -> &SuiteRecord {
    f.run.record()
}

fn time_of(outcome: &Outcome) -> Option<f64> {
    match outcome {
        Outcome::Stood => None,
        Outcome::Collapsed { time_s } | Outcome::Failed { time_s, .. } => Some(*time_s),
    }
}

/// A text that every run has.
macro_rules! text {
    (|$f:ident| $value:expr) => {
        Read::Text(|$f| Some(Cow::Borrowed($value)))
    };
}

/// A number that every run has.
macro_rules! number {
    (|$f:ident| $value:expr) => {
        Read::Number(|$f| Some($value))
    };
}

/// A number of the wall, null where a drawn façade is none.
macro_rules! wall_number {
    (|$w:ident| $value:expr) => {
        Read::Number(|f| wall(f).map(|$w| $value))
    };
}

/// A number read off the response of a run that did not fail; one that is not finite does not exist.
macro_rules! outcome_number {
    (|$r:ident| $value:expr) => {
        Read::Number(|f| f.usable().map(|$r| $value).filter(|value| value.is_finite()))
    };
}

/// A count read off the response of a run that did not fail.
macro_rules! outcome_count {
    (|$r:ident| $value:expr) => {
        Read::Count(|f| f.usable().map(|$r| $value))
    };
}

/// A number of where a wall that stood was left.
macro_rules! left {
    (|$left:ident| $value:expr) => {
        Read::Number(|f| {
            let $left = following(f.usable()?)?;
            Some($value)
        })
    };
}

/// Columns of what a run told, after others; of any rows that tell it.
#[rustfmt::skip] // One column a line, so that the table reads as a table.
macro_rules! with_results {
    ($($before:expr,)*) => { &[
        $($before,)*
        // How the run ended.
        Column::result("outcome", "", "stood, collapsed or failed; collapsed before: a part of a sequence that found the wall fallen", text!(|f| f.outcome())),
        Column::result("reason", "", "why the run failed; null where it did not", Read::Text(|f| f.failure.as_deref().map(Cow::Borrowed))),
        Column::result("collapsed", "", "whether a body passed its collapse rotation; null for a failed run", Read::Flag(|f| f.usable().map(|r| r.collapsed()))),
        Column::result("collapse_time_s", "s", "when it did; null where it did not", Read::Number(|f| f.usable().and_then(|r| time_of(&r.outcome)))),
        Column::result("end_time_s", "s", "end of the run", outcome_number!(|r| r.end_time_s)),
        Column::result("limit_exceeded", "", "whether an incremental analysis found an intensity that exceeds its limit; null for other studies and failed runs", Read::Flag(|f| f.found.map(|found| found.exceeded))),
        Column::result("stood_intensity", "unit of the measure", "highest intensity below that at which it did not: the lower end of the bracket", Read::Number(|f| f.found.map(|found| found.stood_intensity))),
        // Largest rotations and displacements; of a collapsed wall, until collapse.
        Column::result("theta1_max_rad", "rad", "largest rotation of the lower body, without sign", outcome_number!(|r| r.theta_max_rad[0].value.abs())),
        Column::result("theta1_max_sign", "", "its sign, +1 towards +x", outcome_number!(|r| sign(r.theta_max_rad[0].value))),
        Column::result("theta1_max_time_s", "s", "when it was reached", outcome_number!(|r| r.theta_max_rad[0].time_s)),
        Column::result("theta1_max_over_alpha1", "", "largest rotation of the lower body over its slenderness angle", outcome_number!(|r| r.theta_max_over_alpha_i()[0])),
        Column::result("theta1_max_over_alpha", "", "largest rotation of the lower body over the slenderness angle of the uncracked wall", outcome_number!(|r| r.theta_max_over_alpha()[0])),
        Column::result("theta2_max_rad", "rad", "largest rotation of the upper body, without sign", outcome_number!(|r| r.theta_max_rad[1].value.abs())),
        Column::result("theta2_max_sign", "", "its sign, +1 towards +x", outcome_number!(|r| sign(r.theta_max_rad[1].value))),
        Column::result("theta2_max_time_s", "s", "when it was reached", outcome_number!(|r| r.theta_max_rad[1].time_s)),
        Column::result("theta2_max_over_alpha2", "", "largest rotation of the upper body over its slenderness angle", outcome_number!(|r| r.theta_max_over_alpha_i()[1])),
        Column::result("theta2_max_over_alpha", "", "largest rotation of the upper body over the slenderness angle of the uncracked wall", outcome_number!(|r| r.theta_max_over_alpha()[1])),
        Column::result("theta_max_over_own_alpha", "", "the larger of θ_1/α_1 and θ_2/α_2 at their largest; that of a collapsed wall is collapse_rotation_ratio, to rounding", outcome_number!(|r| r.theta_max_over_own_alpha())),
        Column::result("top_displacement_m", "m", "largest horizontal displacement of the top relative to the ground, with its sign", outcome_number!(|r| r.top_displacement_m.value)),
        Column::result("top_displacement_time_s", "s", "when it was reached", outcome_number!(|r| r.top_displacement_m.time_s)),
        Column::result("crack_displacement_m", "m", "largest horizontal displacement of the middle of the crack relative to the ground, with its sign", outcome_number!(|r| r.crack_displacement_m.value)),
        Column::result("crack_displacement_time_s", "s", "when it was reached", outcome_number!(|r| r.crack_displacement_m.time_s)),
        // Where a wall that stood was left.
        Column::result("left_theta1_rad", "rad", "rotation of the lower body at the end, with its sign; null for a wall that did not stand", left!(|left| left.state.theta[0])),
        Column::result("left_theta2_rad", "rad", "the same of the upper body", left!(|left| left.state.theta[1])),
        Column::result("left_plastic_m", "m", "what the floor's spring has yielded at the end, with its sign; 0 of one that does not yield", left!(|left| left.plastic_displacement_m)),
        // Patterns, by the names of Fig. 4.
        Column::result("pattern_rest_s", "s", "time spent in rest", outcome_number!(|r| r.pattern_time_s[0])),
        Column::result("pattern_1a_s", "s", "time spent in pattern 1a", outcome_number!(|r| r.pattern_time_s[1])),
        Column::result("pattern_2a_s", "s", "time spent in pattern 2a", outcome_number!(|r| r.pattern_time_s[2])),
        Column::result("pattern_3a_s", "s", "time spent in pattern 3a", outcome_number!(|r| r.pattern_time_s[3])),
        Column::result("pattern_4a_s", "s", "time spent in pattern 4a", outcome_number!(|r| r.pattern_time_s[4])),
        Column::result("pattern_1b_s", "s", "time spent in pattern 1b", outcome_number!(|r| r.pattern_time_s[5])),
        Column::result("pattern_2b_s", "s", "time spent in pattern 2b", outcome_number!(|r| r.pattern_time_s[6])),
        Column::result("pattern_3b_s", "s", "time spent in pattern 3b", outcome_number!(|r| r.pattern_time_s[7])),
        Column::result("pattern_4b_s", "s", "time spent in pattern 4b", outcome_number!(|r| r.pattern_time_s[8])),
        Column::result("pattern_rest_share", "", "share of the run spent in rest", outcome_number!(|r| r.pattern_time_s[0] / r.end_time_s)),
        Column::result("pattern_1a_share", "", "share of the run spent in pattern 1a", outcome_number!(|r| r.pattern_time_s[1] / r.end_time_s)),
        Column::result("pattern_2a_share", "", "share of the run spent in pattern 2a", outcome_number!(|r| r.pattern_time_s[2] / r.end_time_s)),
        Column::result("pattern_3a_share", "", "share of the run spent in pattern 3a", outcome_number!(|r| r.pattern_time_s[3] / r.end_time_s)),
        Column::result("pattern_4a_share", "", "share of the run spent in pattern 4a", outcome_number!(|r| r.pattern_time_s[4] / r.end_time_s)),
        Column::result("pattern_1b_share", "", "share of the run spent in pattern 1b", outcome_number!(|r| r.pattern_time_s[5] / r.end_time_s)),
        Column::result("pattern_2b_share", "", "share of the run spent in pattern 2b", outcome_number!(|r| r.pattern_time_s[6] / r.end_time_s)),
        Column::result("pattern_3b_share", "", "share of the run spent in pattern 3b", outcome_number!(|r| r.pattern_time_s[7] / r.end_time_s)),
        Column::result("pattern_4b_share", "", "share of the run spent in pattern 4b", outcome_number!(|r| r.pattern_time_s[8] / r.end_time_s)),
        // Impacts and openings.
        Column::result("impacts", "", "impacts, all of them", outcome_count!(|r| r.impacts.total())),
        Column::result("impacts_c1", "", "impacts that change pattern 1a to 2a or mirrored", outcome_count!(|r| r.impacts.table2[0])),
        Column::result("impacts_c2", "", "impacts that change pattern 2a to 1a or mirrored", outcome_count!(|r| r.impacts.table2[1])),
        Column::result("impacts_c3", "", "impacts that change pattern 1a to 2b or mirrored", outcome_count!(|r| r.impacts.table2[2])),
        Column::result("impacts_c4", "", "impacts that change pattern 2a to 1b or mirrored", outcome_count!(|r| r.impacts.table2[3])),
        Column::result("impacts_c5", "", "impacts that change pattern 3a to 1b or mirrored", outcome_count!(|r| r.impacts.table2[4])),
        Column::result("impacts_c6", "", "impacts that change pattern 3a to 3b or mirrored", outcome_count!(|r| r.impacts.table2[5])),
        Column::result("impacts_c7", "", "impacts that change pattern 1a to 3a or mirrored", outcome_count!(|r| r.impacts.table2[6])),
        Column::result("impacts_c8", "", "impacts that change pattern 2a to 3a or mirrored", outcome_count!(|r| r.impacts.table2[7])),
        Column::result("impacts_other", "", "impacts with a change of pattern that is not in Table 2", outcome_count!(|r| r.impacts.other)),
        Column::result("impacts_captured", "", "impacts, of any change, in which a joint was captured", outcome_count!(|r| r.impacts.captured)),
        Column::result("openings", "", "openings of joints without an impact, all of them", outcome_count!(|r| r.openings.total())),
        Column::result("openings_rest_to_3", "", "openings from rest into pattern 3", outcome_count!(|r| r.openings.rest_to_3)),
        Column::result("openings_rest_to_4", "", "openings from rest into pattern 4", outcome_count!(|r| r.openings.rest_to_4)),
        Column::result("openings_rest_to_both", "", "openings from rest into pattern 1 or 2", outcome_count!(|r| r.openings.rest_to_both)),
        Column::result("openings_crack", "", "openings of the crack from pattern 3", outcome_count!(|r| r.openings.crack)),
        Column::result("openings_ground", "", "openings of the ground from pattern 4", outcome_count!(|r| r.openings.ground)),
        // Energy.
        Column::result("energy_initial_j", "J", "kinetic, gravity and spring energy at the start", outcome_number!(|r| r.energy.initial_j)),
        Column::result("energy_final_j", "J", "the same at the end", outcome_number!(|r| r.energy.final_j)),
        Column::result("ground_work_j", "J", "work of the ground motion on the wall", outcome_number!(|r| r.energy.ground_work_j)),
        Column::result("impact_loss_j", "J", "energy lost at impacts; negative where coefficients above 1 add energy", outcome_number!(|r| r.energy.impact_loss_j)),
        Column::result("effect_loss_j", "J", "energy lost in dampers and other effects", outcome_number!(|r| r.energy.effect_loss_j)),
        Column::result("energy_residual", "", "energy not accounted for, over the energy that passed through", outcome_number!(|r| r.energy.residual())),
        // What the model forbids, and how near the run came to it.
        Column::result("friction_demand_ground", "", "largest |H|/N at the ground while it is in compression", outcome_number!(|r| r.demand[0].friction)),
        Column::result("tensions_ground", "", "how often the pivot at the ground came under tension", outcome_count!(|r| r.demand[0].tensions)),
        Column::result("friction_demand_crack", "", "largest |H|/N at the crack while it is in compression", outcome_number!(|r| r.demand[1].friction)),
        Column::result("tensions_crack", "", "how often the pivot at the crack came under tension", outcome_count!(|r| r.demand[1].tensions)),
        // Effort; of a failed run, until it failed; of an incremental analysis, of the run that is kept.
        Column::result("simulations", "", "simulations behind this row: several of an incremental analysis, 0 of a façade that is no wall", Read::Count(|f| Some(f.simulations))),
        Column::result("steps", "", "steps kept", Read::Count(|f| f.response.as_ref().map(|r| r.work.steps))),
        Column::result("rejected_steps", "", "steps tried again at a smaller size", Read::Count(|f| f.response.as_ref().map(|r| r.work.rejected_steps))),
        Column::result("evaluations", "", "evaluations of the equations of motion", Read::Count(|f| f.response.as_ref().map(|r| r.work.evaluations))),
    ] };
}

/// Every column of a result file, in order.
#[rustfmt::skip] // As above.
pub const COLUMNS: &[Column<Finished>] = with_results![
    // The plan.
    Column::input("run", "", "position in the plan, from 0", Read::Count(|f| Some(f.run.position))),
    Column::<Finished>::input("id", "", "first 16 hexadecimal digits of the SHA-256 of all inputs of the run", text!(|f| &f.run.id)).distinct(),
    Column::input("variant", "", "set of assumptions the study was run under", text!(|f| &f.run.variant.name)),
    Column::input("member_of", "", "variant of whose ensemble the run is a member: its ground motion is changed by up to a millionth, that of member 3 its tolerance; null for a run as it is planned", Read::Text(|f| f.run.variant.member.as_ref().map(|member| Cow::Borrowed(member.member_of.as_str())))),
    Column::input("member", "", "number of the member in that ensemble, from 1; null for a run as it is planned", Read::Count(|f| f.run.variant.member.as_ref().map(|member| member.number as u64))),
    Column::input("configuration", "", "how the floor runs: perpendicular (beams rest on the façade) or parallel", text!(|f| f.run.configuration.name())),
    Column::input("parameter", "", "parameter taken through its levels, the others at their means; null for a drawn façade, which has a draw", Read::Text(|f| f.run.parameter().map(|parameter| Cow::Borrowed(parameter.name())))),
    Column::input("level", "", "level of that parameter: mu_minus_sigma, mu, mu_plus_sigma; lower_bound, best_fit, upper_bound", Read::Text(|f| f.run.level().zip(f.run.parameter()).map(|(level, parameter)| Cow::Borrowed(level.name(parameter))))),
    Column::input("parameter_value", "SI unit of the parameter", "value of that parameter; null for the eight coefficients", Read::Number(|f| f.run.parameter().and_then(|parameter| parameter.value(&f.run.facade)))),
    Column::input("sequence", "", "sequence of records that the run is a row of; null for a record by itself", Read::Text(|f| f.run.sequence.as_ref().map(|(sequence, _)| Cow::Borrowed(sequence.name.as_str())))),
    Column::input("part", "", "which record of it the row tells of, from 1", Read::Count(|f| f.run.sequence.as_ref().map(|(_, place)| place.part as u64 + 1))),
    Column::input("alone", "", "whether the wall is as it was built though other parts go before this one: what the record does by itself", Read::Flag(|f| f.run.sequence.as_ref().map(|(_, place)| place.alone))),
    Column::input("draw", "", "number of the façade among those drawn, from 0, the same in both configurations, under all records and at all intensities; null where none is drawn", Read::Count(|f| f.run.draw())),
    Column::input("matrix", "", "matrix of a study of variance: a, b, or the inputs that a takes from b; null for other studies", Read::Text(|f| f.run.matrix().map(|matrix| Cow::Borrowed(matrix.name())))),
    // The record.
    Column::input("suite", "", "suite of records", text!(|f| &f.run.motions.suite.name)),
    Column::input("suite_generated", "", "whether the suite is generated rather than recorded", Read::Flag(|f| Some(f.run.motions.suite.generated))),
    Column::input("record", "", "name of the record", text!(|f| &record(f).name)),
    Column::input("record_id", "", "number of the record in its suite", Read::Count(|f| Some(u64::from(record(f).id)))),
    Column::input("record_event", "", "earthquake of the record", text!(|f| &record(f).event)),
    Column::input("record_magnitude", "", "moment magnitude; null where the suite does not say", Read::Number(|f| record(f).about.magnitude)),
    Column::input("record_distance_km", "km", "distance from the epicentre; null where the suite does not say", Read::Number(|f| record(f).about.distance_km)),
    Column::input("record_scale", "", "factor the record was scaled by: of the suite and of the run", number!(|f| record(f).scale * f.run.factor)),
    Column::input("record_vertical_scale", "", "factor its vertical component was scaled by; null without one", Read::Number(|f| record(f).vertical.as_ref().map(|_| record(f).vertical_scale * f.run.factor))),
    Column::input("record_generated", "", "whether the record is generated rather than recorded", Read::Flag(|f| Some(record(f).generated))),
    Column::input("record_sha256", "", "SHA-256 of step and samples after scaling by the suite", text!(|f| &f.run.record_hash().horizontal)),
    Column::input("record_vertical_sha256", "", "the same of the vertical component; null without one", Read::Text(|f| f.run.record_hash().vertical.as_deref().map(Cow::Borrowed))),
    Column::input("record_step_s", "s", "time between samples", number!(|f| record(f).horizontal.step_s())),
    Column::input("record_duration_s", "s", "time of the last sample", number!(|f| record(f).horizontal.duration_s())),
    Column::drawn("factor", "", "factor of the run on the record of the suite; 1 for its own scale", number!(|f| f.run.factor)),
    Column::input("intensity_measure", "", "measure the record is scaled by, one of those below; null where it is not scaled to an intensity", Read::Text(|f| f.run.scaled_to().map(|(measure, _)| Cow::Borrowed(measure.name())))),
    Column::drawn("intensity", "unit of the measure", "its value; of an incremental analysis the lowest found to exceed the limit, or the last one where none did", Read::Number(|f| f.run.scaled_to().map(|(_, value)| value))),
    Column::input("limit", "", "limit of an incremental analysis: collapse, or a rotation over α_i; null for other studies", Read::Text(|f| f.run.growth().map(|growth| Cow::Owned(growth.limit.to_string())))),
    // Its intensity, scaled by the suite and by the run.
    Column::drawn("pga_m_s2", "m/s²", "largest absolute ground acceleration", number!(|f| f.run.intensity().pga_m_s2)),
    Column::drawn("pga_g", "g", "the same in g", number!(|f| f.run.intensity().pga_g)),
    Column::drawn("pgv_m_s", "m/s", "largest absolute ground velocity, by trapezia from rest, not corrected", number!(|f| f.run.intensity().pgv_m_s)),
    Column::drawn("pgd_m", "m", "largest absolute ground displacement, by trapezia from rest, not corrected", number!(|f| f.run.intensity().pgd_m)),
    Column::drawn("arias_m_s", "m/s", "Arias intensity", number!(|f| f.run.intensity().arias_m_s)),
    Column::drawn("cav_m_s", "m/s", "cumulative absolute velocity", number!(|f| f.run.intensity().cav_m_s)),
    Column::input("duration_5_95_s", "s", "time from 5 to 95 % of the Arias intensity", number!(|f| record(f).intensity.duration_5_95_s)),
    Column::input("mean_period_s", "s", "mean period of the Fourier spectrum, 0.25 to 20 Hz (Rathje et al. 2004)", number!(|f| record(f).intensity.mean_period_s)),
    Column::drawn("sa_0p5s_m_s2", "m/s²", "pseudo-acceleration at 0.5 s, 5 % damping", number!(|f| f.run.intensity().sa_0p5s_m_s2)),
    Column::drawn("sa_1p0s_m_s2", "m/s²", "pseudo-acceleration at 1.0 s, 5 % damping", number!(|f| f.run.intensity().sa_1p0s_m_s2)),
    Column::drawn("sa_average_m_s2", "m/s²", "geometric mean of the pseudo-accelerations at 0.2, 0.3, …, 2.0 s, 5 % damping", number!(|f| f.run.intensity().sa_average_m_s2)),
    // How it acts.
    Column::input("vertical", "", "whether the vertical component of the record acts too", Read::Flag(|f| Some(assumed(f).vertical))),
    Column::input("tail_s", "s", "free motion after the record: of a part of a sequence the rest before the next", number!(|f| f.run.tail_s())),
    Column::input("tolerance", "", "error allowed in rotations relative to α_i", number!(|f| f.run.accuracy().tolerance)),
    // The façade.
    Column::drawn("slenderness", "", "h_tot / b", number!(|f| f.run.facade.slenderness)),
    Column::drawn("crack_height_ratio", "", "h_1 / h_tot", number!(|f| f.run.facade.crack_height_ratio)),
    Column::drawn("compressive_strength_pa", "Pa", "compressive strength f of the masonry", number!(|f| f.run.facade.compressive_strength_pa)),
    Column::drawn("diaphragm_mass_ratio", "", "m_d / m_tot, m_tot the masses of wall and floor", number!(|f| f.run.facade.diaphragm_mass_ratio)),
    Column::drawn("carriage_mass_ratio", "", "m_dp / m_tot", number!(|f| f.run.facade.carriage_mass_ratio)),
    Column::input("density_kg_m3", "kg/m³", "density ρ of the masonry", number!(|f| f.run.facade.density_kg_m3)),
    // The wall.
    Column::drawn("thickness_m", "m", "thickness b", number!(|f| f.run.facade.thickness_m)),
    Column::drawn("height_m", "m", "height h", wall_number!(|w| w.height_m)),
    Column::drawn("crack_height_m", "m", "height of the crack h_1; null for an uncracked wall", Read::Number(|f| wall(f).and_then(|w| w.crack_height_m))),
    Column::input("length_m", "m", "length L of the strip", number!(|f| f.run.facade.length_m)),
    Column::drawn("mass_kg", "kg", "mass m of the wall", wall_number!(|w| w.mass_kg)),
    Column::drawn("lower_width_m", "m", "width b_1 between the rocking corners at the ground", wall_number!(|w| w.lower_width_m)),
    Column::drawn("upper_width_m", "m", "width b_2 between the rocking corners at the crack", wall_number!(|w| w.upper_width_m)),
    Column::drawn("diaphragm_mass_kg", "kg", "top mass m_d that acts in both directions", wall_number!(|w| w.diaphragm_mass_kg)),
    Column::drawn("carriage_mass_kg", "kg", "top mass m_dp that acts horizontally only", wall_number!(|w| w.carriage_mass_kg)),
    Column::drawn("stiffness_n_per_m", "N/m", "stiffness k_d of the spring at the top", number!(|f| f.run.facade.stiffness_n_per_m)),
    Column::input("eccentricity_m", "m", "horizontal offset e_C of top masses and spring", wall_number!(|w| w.eccentricity_m)),
    Column::input("restitution_c1", "", "coefficient C_1 of Table 2", number!(|f| restitution(f).coefficients[0])),
    Column::input("restitution_c2", "", "coefficient C_2 of Table 2", number!(|f| restitution(f).coefficients[1])),
    Column::input("restitution_c3", "", "coefficient C_3 of Table 2", number!(|f| restitution(f).coefficients[2])),
    Column::input("restitution_c4", "", "coefficient C_4 of Table 2", number!(|f| restitution(f).coefficients[3])),
    Column::input("restitution_c5", "", "coefficient C_5 of Table 2", number!(|f| restitution(f).coefficients[4])),
    Column::input("restitution_c6", "", "coefficient C_6 of Table 2", number!(|f| restitution(f).coefficients[5])),
    Column::input("restitution_c7", "", "coefficient C_7 of Table 2", number!(|f| restitution(f).coefficients[6])),
    Column::input("restitution_c8", "", "coefficient C_8 of Table 2", number!(|f| restitution(f).coefficients[7])),
    Column::input("law", "", "what the coefficients scale: whole (Eq. 7, both velocities) or contact (what the impact can see)", text!(|f| restitution(f).law.name())),
    Column::input("capture_velocity_rad_s", "rad/s", "relative velocity below which a joint that would open stays closed", number!(|f| restitution(f).capture_velocity_rad_s)),
    Column::input("collapse_rotation_ratio", "", "rotation over α_i at which the wall counts as collapsed", number!(|f| assumed(f).collapse_rotation_ratio)),
    Column::input("initial_theta1_rad", "rad", "rotation of the lower body at the start", wall_number!(|w| w.initial_rotation_rad[0])),
    Column::input("initial_theta2_rad", "rad", "rotation of the upper body at the start", wall_number!(|w| w.initial_rotation_rad[1])),
    Column::input("effects", "", "further effects of the model, as written in a wall file; [] for none", Read::Text(|f| serde_json::to_string(&wall(f)?.further_laws()).ok().map(Cow::Owned))),
    Column::drawn("alpha1_rad", "rad", "slenderness angle of the lower body, atan(b_1 / h_1)", Read::Number(|f| f.run.wall.as_ref().ok().map(|wall| wall.alpha_i_rad()[0]))),
    Column::drawn("alpha2_rad", "rad", "slenderness angle of the upper body, atan(b_2 / h_2)", Read::Number(|f| f.run.wall.as_ref().ok().map(|wall| wall.alpha_i_rad()[1]))),
    Column::drawn("alpha_rad", "rad", "slenderness angle of the uncracked wall, atan(b_1 / h)", Read::Number(|f| f.run.wall.as_ref().ok().map(|wall| wall.alpha_rad()))),
];

/// The columns of what came of runs that are of no plan, told by their numbers.
pub const RESULTS: &[Column<Finished<usize>>] = with_results![];

/// +1, -1, or 0 where nothing moved.
fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn regress_names_are_unique_and_carry_their_units() {
        let names: BTreeSet<&str> = COLUMNS.iter().map(|column| column.name).collect();
        assert_eq!(names.len(), COLUMNS.len());
        let suffixes = [
            ("s", "_s"),
            ("m", "_m"),
            ("km", "_km"),
            ("m/s", "_m_s"),
            ("m/s²", "_m_s2"),
            ("g", "_g"),
            ("rad", "_rad"),
            ("rad/s", "_rad_s"),
            ("kg", "_kg"),
            ("kg/m³", "_kg_m3"),
            ("N/m", "_n_per_m"),
            ("Pa", "_pa"),
            ("J", "_j"),
        ];
        for column in COLUMNS {
            assert!(!column.meaning.is_empty(), "{}", column.name);
            if let Some((_, suffix)) = suffixes.iter().find(|(unit, _)| *unit == column.unit) {
                assert!(column.name.ends_with(suffix), "{} in {}", column.name, column.unit);
            }
        }
    }
}
