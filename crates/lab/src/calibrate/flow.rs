//! The calibration from start to end: the experiment read whole, the searches, and what they found.

use std::path::{Path, PathBuf};
use std::time::Instant;

use rayon::prelude::*;
use sha2::{Digest, Sha256};

use super::archive::Archive;
use super::evaluation::{Evaluation, capture_names, capture_study};
use super::identifiability::{BOOTSTRAP, Judge};
use super::likelihood::{ByLikelihood, Over, by_likelihood};
use super::objective::{Objective, prior_factor};
use super::paper::{PaperDe, most_similar};
use super::parameters::ParameterSpace;
use super::report::disagreement;
use super::result::{Calibration, Identifiability, MethodResult, Vector};
use super::search::{Draws, Found};
use super::staged_search::{StagedSearch, stage_names};
use crate::diagnose::experiment::SENSOR_GAIN;
use crate::experiment::file::{CalibrateTable, ExperimentFile, Purpose, TestTable};
use crate::experiment::{Test, TestData, load_tests};
use crate::release::Moments;
use mrbd_files::checksum::hexadecimal;
use mrbd_files::error::{InputError, Result};
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::Accuracy;

/// An experiment ready to be calibrated.
#[derive(Debug, Clone)]
pub struct Experiment {
    /// The file.
    pub path: PathBuf,
    /// What is calibrated.
    pub space: ParameterSpace,
    /// The tests, in the order of the file.
    pub tests: Vec<Test>,
    /// Those of them that windows can be cut from, each under its number; a lost channel or no noise leaves a test out.
    pub readable: Vec<(usize, TestData)>,
    /// The settings.
    pub settings: CalibrateTable,
    /// Whether something is known of the sensors' gains, for which a calibration has no use.
    pub knows_sensor_gain: bool,
    /// What was read, each file with its role.
    pub files: Vec<(String, PathBuf)>,
    /// SHA-256 of everything that decides the result.
    pub request: String,
}

impl Experiment {
    /// Reads an experiment and every file it names; `seed` replaces the file's.
    ///
    /// # Errors
    /// Input errors with file, key or line, what was found and what is allowed.
    pub fn load(path: &Path, seed: Option<u64>) -> Result<Self> {
        let file = ExperimentFile::load(path)?;
        let space = ParameterSpace::load(path, &file)?;
        // With C_l as in its file, which a start time is matched by.
        let given =
            Wall::new(space.base().clone()).map_err(|e| InputError::key(path, e.key, e.found, e.allowed))?;
        let settings = CalibrateTable { seed: seed.unwrap_or(file.calibrate.seed), ..file.calibrate.clone() };
        let accuracy = Accuracy { tolerance: settings.tolerance };
        let tests = load_tests(path, &file, &given, accuracy)?;
        let files = file.files(path);
        let readable = readable(path, &file, &given, &tests);
        let request = request(&files, &settings)?;
        let knows_sensor_gain = file.prior.contains_key(SENSOR_GAIN);
        let path = path.to_path_buf();
        Ok(Self { path, space, tests, readable, settings, knows_sensor_gain, files, request })
    }

    /// Numbers of the tests that the search sees.
    pub fn fit_tests(&self) -> Vec<usize> {
        (0..self.tests.len()).filter(|&k| self.tests[k].purpose == Purpose::Fit).collect()
    }

    /// The wall before the calibration.
    ///
    /// # Errors
    /// An input error if it cannot be; [`Experiment::load`] has refused it then.
    pub fn given(&self) -> Result<Wall, InputError> {
        let parameters = self.space.base().clone();
        Wall::new(parameters).map_err(|e| InputError::key(&self.path, e.key, e.found, e.allowed))
    }

    /// What its releases say of the joints before any law is assumed; `None` where none can be read so.
    ///
    /// # Errors
    /// As [`Experiment::given`].
    pub fn moments(&self) -> Result<Option<Moments>, InputError> {
        Ok(Moments::of(&self.given()?, &self.tests))
    }

    /// Accuracy of the simulations.
    pub fn accuracy(&self) -> Accuracy {
        Accuracy { tolerance: self.settings.tolerance }
    }
}

/// The tests with their noise and patterns, as far as they have two channels and enough samples.
fn readable(path: &Path, file: &ExperimentFile, wall: &Wall, tests: &[Test]) -> Vec<(usize, TestData)> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let data = |(k, (test, table)): (usize, (&Test, &TestTable))| {
        let data = TestData::new(test, &folder.join(&table.measured), table, wall).ok()?;
        (wall.is_cracked() && test.purpose == Purpose::Fit).then_some((k, data))
    };
    tests.iter().zip(&file.tests).enumerate().filter_map(data).collect()
}

/// Identifies the inputs: program, settings, and the bytes of every file.
fn request(files: &[(String, PathBuf)], settings: &CalibrateTable) -> Result<String> {
    let mut hash = Sha256::new();
    hash.update(env!("CARGO_PKG_VERSION"));
    hash.update(format!("{settings:?}"));
    for (_, name) in files {
        let readable = |e: std::io::Error| InputError::file(name, e.to_string(), "a readable file");
        hash.update(std::fs::read(name).map_err(readable)?);
    }
    Ok(hexadecimal(&hash.finalize()))
}

/// Calibrates an experiment; every simulation goes into the archive.
///
/// # Errors
/// [`mrbd_files::Error::Io`] if a simulation cannot be kept.
pub fn calibrate(experiment: &Experiment, archive: &Archive) -> Result<Calibration> {
    Flow { experiment, archive, fit: experiment.fit_tests() }.go()
}

/// The names of the searches, in the order they are run.
pub fn method_names(experiment: &Experiment) -> Vec<String> {
    let mut names = vec!["paper".to_owned()];
    names.extend(["adaptive", "joint", "refined"].iter().flat_map(|method| stage_names(method)));
    names.push(BOOTSTRAP.to_owned());
    names.extend(capture_names(&experiment.settings.capture_study_rad_s));
    names
}

struct Flow<'a> {
    experiment: &'a Experiment,
    archive: &'a Archive,
    fit: Vec<usize>,
}

impl Flow<'_> {
    fn go(&self) -> Result<Calibration> {
        let start = Instant::now();
        let paper = self.paper_in_each_test()?;
        let similar = self.similarity(&paper);
        let paper_seconds = start.elapsed().as_secs_f64();
        let paper_simulations = paper.iter().map(|found| found.evaluations).sum::<usize>();
        let adaptive = self.adaptive_in_each_test(&paper)?;
        let budget = paper_simulations / self.fit.len();
        let joint = self.staged("joint", &self.fit, budget).minimise(self.middle(), &self.draws("joint"))?;
        let refine = self.staged("refined", &self.fit, self.experiment.settings.refine_vectors);
        let refined = refine.minimise(self.elsewhere(), &self.draws("refined"))?;
        let evaluation = Evaluation { experiment: self.experiment, fit: &self.fit };
        let methods = evaluation.methods(&paper, &adaptive, similar, [&joint, &refined]);
        let likelihood = self.by_likelihood(&methods);
        let judge = Judge { experiment: self.experiment, archive: self.archive, fit: &self.fit };
        let (vector, joint_from) = self.vector(&methods, likelihood.as_ref(), (&judge, &evaluation));
        let vector = evaluation.without_idle(&vector);
        let per_test = self.better_of(&paper, &adaptive);
        let told = judge.estimates(&vector, &per_test)?;
        let (parameters, correlation) = match (&likelihood, self.why_not(&methods, &judge, &vector)) {
            (Some(fit), _) if fit.followed => Judge::by_likelihood(told, fit),
            (_, None) => told,
            (_, Some(why)) => Judge::not_identified(told, why),
        };
        let capture_study = capture_study(self.experiment, self.archive, &self.fit, &vector.values)?;
        let tests = evaluation.tests(&vector, &methods);
        let base = self.experiment.space.base();
        let seconds = start.elapsed().as_secs_f64();
        let simulations = self.archive.simulations();
        Ok(Calibration {
            tool_version: env!("CARGO_PKG_VERSION").to_owned(),
            request_sha256: self.experiment.request.clone(),
            seed: self.experiment.settings.seed,
            law: base.restitution.law.name().to_owned(),
            capture_velocity_rad_s: base.restitution.capture_velocity_rad_s,
            tolerance: self.experiment.settings.tolerance,
            bounds_source: self.experiment.space.bounds_source.clone(),
            methods,
            likelihood,
            joint: vector,
            joint_from,
            parameters,
            correlation,
            tests,
            capture_study,
            simulations,
            paper_seconds,
            paper_simulations,
            seconds,
            simulations_per_second: self.archive.run_here() as f64 / seconds,
        })
    }

    fn paper_in_each_test(&self) -> Result<Vec<Found>> {
        let search = |&test: &usize| {
            let chosen = [test];
            let Experiment { space, tests, .. } = self.experiment;
            let mut objective = Objective {
                space,
                tests,
                chosen: &chosen,
                accuracy: self.experiment.accuracy(),
                archive: self.archive,
                method: "paper",
            };
            let draws = self.draws(&format!("paper/{}", tests[test].name));
            self.paper_de().minimise(&space.bounds(), &draws, &mut objective)
        };
        self.fit.par_iter().map(search).collect()
    }

    /// The staged search in every test to fit, with as many simulations as the paper's.
    fn adaptive_in_each_test(&self, paper: &[Found]) -> Result<Vec<Found>> {
        let search = |(&test, paper): (&usize, &Found)| {
            let draws = self.draws(&format!("adaptive/{}", self.experiment.tests[test].name));
            self.staged("adaptive", &[test], paper.evaluations).minimise(self.middle(), &draws)
        };
        self.fit.par_iter().zip(paper).map(search).collect()
    }

    fn middle(&self) -> Vec<f64> {
        self.experiment.space.bounds().iter().map(|b| b.at(0.5)).collect()
    }

    /// A vector drawn anywhere between the bounds, so that the second joint search comes from another side.
    fn elsewhere(&self) -> Vec<f64> {
        let draws = self.draws("refined start");
        let bounds = self.experiment.space.bounds();
        bounds.iter().enumerate().map(|(v, b)| b.at(draws.uniform(0, 0, v as u32))).collect()
    }

    fn staged<'o>(&'o self, method: &'o str, chosen: &'o [usize], budget: usize) -> StagedSearch<'o> {
        let Experiment { space, .. } = self.experiment;
        StagedSearch { experiment: self.experiment, space, chosen, archive: self.archive, method, budget }
    }

    fn paper_de(&self) -> PaperDe {
        let s = &self.experiment.settings;
        PaperDe {
            population: s.population,
            settle_share: s.settle_share,
            settle_generations: s.settle_generations,
            most_generations: s.most_generations,
        }
    }

    fn draws(&self, search: &str) -> Draws {
        Draws::new(self.experiment.settings.seed, search)
    }

    /// Eq. 10 over the last generations; variables of other units than C_l count relative to their nominal value.
    fn similarity(&self, paper: &[Found]) -> Option<(Vec<f64>, f64)> {
        let nominal = self.experiment.space.nominal();
        let relative = |values: &[f64]| -> Vec<f64> {
            let of = |(x, n): (&f64, &f64)| if *n == 0.0 { *x } else { x / n };
            values.iter().zip(&nominal).map(of).collect()
        };
        let generations = paper
            .iter()
            .map(|found| found.population.iter().map(|m| relative(&m.values)).collect::<Vec<_>>())
            .collect::<Vec<_>>();
        most_similar(&generations).map(|chosen| {
            let (test, index) = chosen.from;
            (paper[test].population[index].values.clone(), chosen.similarity)
        })
    }

    /// The numbers fitted by likelihood from the best vector of every method and from the middle of the bounds.
    fn by_likelihood(&self, methods: &[MethodResult]) -> Option<ByLikelihood> {
        let mut starts = methods.iter().map(|method| method.best.values.clone()).collect::<Vec<_>>();
        starts.push(self.middle());
        by_likelihood(self.experiment, &starts)
    }

    /// The vector for all tests: by likelihood where that follows the tests to their noise, else the cheapest. Where
    /// windows alone are followed, a search that has arrived over whole tests is nearer.
    fn vector(
        &self,
        methods: &[MethodResult],
        likelihood: Option<&ByLikelihood>,
        (judge, evaluation): (&Judge, &Evaluation),
    ) -> (Vector, String) {
        let (cheapest, name) = self.cheapest(methods);
        let Some(fit) = likelihood.filter(|fit| fit.followed) else { return (cheapest, name) };
        let arrived = judge.has_arrived(&cheapest) && fit.is_near(&cheapest.values);
        match fit.over {
            Over::Windows if arrived => (cheapest, name),
            _ => (evaluation.vector(&fit.values), "likelihood".to_owned()),
        }
    }

    /// Why the intervals of the searches alone are none to believe; `None` where they are.
    fn why_not(&self, methods: &[MethodResult], judge: &Judge, vector: &Vector) -> Option<Identifiability> {
        match disagreement(methods, None) {
            Some(_) => Some(Identifiability::SearchesDisagree),
            None => (!judge.has_arrived(vector)).then_some(Identifiability::NotFollowed),
        }
    }

    /// The best of the vectors for all tests by the cost that the searches minimise, and where it comes from.
    fn cheapest(&self, methods: &[MethodResult]) -> (Vector, String) {
        let Experiment { space, tests, .. } = self.experiment;
        let samples = self.fit.iter().map(|&k| tests[k].target.independent_samples()).sum::<f64>();
        let cost = |m: &MethodResult| {
            let wme = m.best.mean_wme.unwrap_or(f64::INFINITY);
            wme * prior_factor(&space.parameters, &m.best.values, samples)
        };
        let for_all = methods.iter().filter(|m| m.test.is_none());
        let best = for_all.reduce(|a, b| if cost(b) < cost(a) { b } else { a });
        // The joint search always stands in the list.
        best.map_or_else(|| (methods[0].best.clone(), String::new()), |m| (m.best.clone(), m.method.clone()))
    }

    /// Best vector of each test to fit, by the better of the two searches.
    fn better_of(&self, paper: &[Found], adaptive: &[Found]) -> Vec<Vec<f64>> {
        let better = |(p, a): (&Found, &Found)| {
            let best = if a.best().cost < p.best().cost { a.best() } else { p.best() };
            best.values.clone()
        };
        paper.iter().zip(adaptive).map(better).collect()
    }
}
