//! The settings of a study being run: their folders, their trials in one pool, and what these tell.

use std::collections::BTreeMap;

use tokio_util::sync::CancellationToken;

use super::compare::CompareArguments;
use super::failure::Failure;
use super::interrupt;
use super::progress::Progress;
use super::scenario::{failure, threads};
use crate::experiment::{Ending, Experiment, ExperimentError, Parts, Pool};
use crate::experiment::{TrialError, run_trial};
use crate::export::{self, Contents, Folder, Manifest, Pictures, StudyFolder, StudyManifest};
use crate::metrics::comparison::{Comparison, Design, Factor, Stopping, Trials, widest};
use crate::metrics::figures::{Figure, Registry, Sample, pool};
use crate::report;
use crate::scenario::{Plan, Scenario, Setting};
use crate::simulation::DriverKind;
use crate::text::shown;

/// The settings of a study, ready to run.
pub struct Settings<'a> {
    study: &'a StudyFolder,
    plan: &'a Plan,
    arguments: &'a CompareArguments,
    cells: Vec<Cell<'a>>,
    /// What the figures are that all settings have.
    figures: Vec<Figure>,
    /// The comparison, if an attempt that was cut short has come that far.
    compared: Option<Comparison>,
    stop: CancellationToken,
}

/// A setting that is run.
struct Cell<'a> {
    setting: &'a Setting,
    scenario: Scenario,
    folder: Folder,
    /// Its trials; `None` once its results have been written.
    parts: Option<Parts>,
    /// What each of its trials tells of each figure.
    told: BTreeMap<u32, Vec<Sample>>,
    registry: Registry,
    /// Where each figure common to all settings stands among its own.
    places: Vec<usize>,
}

impl<'a> Settings<'a> {
    /// Makes sure that each setting's folder holds nothing, or trials of that very setting. Writes nothing yet.
    pub fn open(
        study: &'a StudyFolder,
        plan: &'a Plan,
        arguments: &'a CompareArguments,
        manifest: &StudyManifest,
    ) -> Result<Self, Failure> {
        let registries: Vec<Registry> = plan
            .settings
            .iter()
            .map(|setting| &setting.scenario.protocol)
            .map(|protocol| Registry::of(protocol.all_topics()).noting(&protocol.figures()))
            .collect();
        let figures = common(&registries);
        let compared = study.comparison(manifest)?;
        let mut cells = Vec::new();
        for (setting, registry) in plan.settings.iter().zip(registries) {
            let mut scenario = setting.scenario.clone();
            if let Some(there) = compared.as_ref().and_then(|compared| compared.setting(&setting.name)) {
                // Trials that were added until the intervals were narrow enough.
                scenario.trials = there.trials as u32;
            }
            let folder = study.setting(&setting.name);
            if let Contents::Results(there) = folder.contents()? {
                let mut differences = there.differences(&Manifest::new(&scenario));
                if there.finished && compared.is_none() {
                    differences.push("finished there, though the study is not".to_owned());
                }
                if !differences.is_empty() {
                    return Err(Failure::Input(format!(
                        "error: {} holds results that are not this study's:\n  {}\nChoose another folder with --out.",
                        shown(folder.path()),
                        differences.join("\n  "),
                    )));
                }
            }
            let places = figures
                .iter()
                .filter_map(|figure| registry.figures().position(|own| own == figure));
            cells.push(Cell {
                setting,
                scenario,
                folder,
                parts: None,
                told: BTreeMap::new(),
                places: places.collect(),
                registry,
            });
        }
        Ok(Self {
            study,
            plan,
            arguments,
            cells,
            figures,
            compared,
            stop: CancellationToken::new(),
        })
    }

    /// Runs the trials that are missing, compares, and writes everything.
    pub fn compare(mut self, mut manifest: StudyManifest) -> Result<Comparison, Failure> {
        interrupt::cancels(&self.stop).map_err(|error| Failure::other(&error))?;
        self.study.declare(&manifest)?;
        self.claim(&mut manifest)?;
        let comparison = match self.compared.take() {
            Some(comparison) => comparison,
            None => self.simulate(&mut manifest)?,
        };
        for cell in &mut self.cells {
            if let Some(parts) = cell.parts.take() {
                let (_, results) = export::write(&cell.folder, parts, &cell.scenario, Pictures::First)?;
                manifest.add(&cell.setting.name, &results);
            }
        }
        manifest.finished = true;
        self.study.declare(&manifest)?;
        Ok(comparison)
    }

    /// Opens the trials of every setting whose results have not been written yet; those of the others go into `manifest`.
    fn claim(&mut self, manifest: &mut StudyManifest) -> Result<(), Failure> {
        for cell in &mut self.cells {
            if let Contents::Results(there) = cell.folder.contents()?
                && there.finished
            {
                cell.folder.held(&there, &[])?;
                cell.folder.tidy();
                manifest.add(&cell.setting.name, &there);
                continue;
            }
            cell.parts = Some(Parts::open(&cell.folder.trials())?);
            cell.folder.declare(&Manifest::new(&cell.scenario))?;
        }
        Ok(())
    }

    fn simulate(&mut self, manifest: &mut StudyManifest) -> Result<Comparison, Failure> {
        let batch: Vec<u32> = self.cells.iter().map(|cell| cell.scenario.trials).collect();
        let stopping = loop {
            self.batch(manifest)?;
            let Some(width) = self.arguments.until_width else {
                break None;
            };
            let stopping = self.stopping(width);
            if stopping.reached || stopping.trials >= stopping.cap {
                break Some(stopping);
            }
            for (cell, batch) in self.cells.iter_mut().zip(&batch) {
                cell.scenario.trials = cell
                    .scenario
                    .trials
                    .saturating_add(*batch)
                    .min(stopping.cap.max(*batch));
            }
        };
        let trials = self.trials();
        let mut comparison = Comparison::of(&self.design(), &trials, stopping);
        report::describe(&mut comparison);
        self.study.write_comparison(&comparison, &trials, manifest)?;
        Ok(comparison)
    }

    /// Reads what the kept trials tell that is not known yet.
    fn recall(&mut self) {
        for cell in &mut self.cells {
            let Some(parts) = &cell.parts else { continue };
            let unknown = (0..cell.scenario.trials).filter(|trial| !cell.told.contains_key(trial));
            let kept = unknown.filter_map(|trial| parts.load(trial).ok());
            let own = kept.filter(|part| part.record.seed == cell.scenario.seed);
            let read: Vec<_> = own
                .map(|part| (part.record.trial, cell.registry.read(&part.record)))
                .collect();
            cell.told.extend(read);
        }
    }

    /// Runs the trials that are missing, of all settings in one pool.
    fn batch(&mut self, manifest: &StudyManifest) -> Result<(), Failure> {
        self.recall();
        let Self {
            cells, stop, arguments, ..
        } = self;
        let total = cells.iter().map(|cell| cell.scenario.trials).sum();
        let kept: usize = cells.iter().map(|cell| cell.told.len()).sum();
        if kept > 0 && kept < total as usize {
            arguments.remark(&format!("going on after {kept} of {total} trials"));
        }
        let mut told: Vec<(usize, u32, Vec<Sample>)> = Vec::new();
        let ending = {
            let experiments: Vec<Experiment> = cells
                .iter()
                .filter_map(|cell| {
                    Some(Experiment {
                        trials: cell.scenario.trials,
                        seed: cell.scenario.seed,
                        parts: cell.parts.as_ref()?,
                    })
                })
                .collect();
            let pool = Pool {
                jobs: threads(arguments.jobs),
                stop,
            };
            let scenarios: Vec<&Scenario> = cells.iter().map(|cell| &cell.scenario).collect();
            let mut progress = Progress::start(total, kept as u32, arguments.quiet);
            let run = |cell: usize, trial| run_trial(scenarios[cell], trial, DriverKind::Inline, stop);
            pool.run(&experiments, run, |cell, part| {
                progress.count(part);
                told.push((cell, part.record.trial, cells[cell].registry.read(&part.record)));
            })
        };
        for (cell, trial, samples) in told {
            self.cells[cell].told.insert(trial, samples);
        }
        match ending {
            Ok(Ending::Finished) => Ok(()),
            Ok(Ending::Interrupted) => Err(Failure::Interrupted(self.leave(manifest)?)),
            Err(error) => Err(self.failed(error, manifest)?),
        }
    }

    fn failed(&mut self, error: ExperimentError<TrialError>, manifest: &StudyManifest) -> Result<Failure, Failure> {
        self.leave(manifest)?;
        Ok(failure(error))
    }

    /// Leaves an unfinished study: finished trials stay, and if there are none, nothing does. Says so.
    fn leave(&mut self, manifest: &StudyManifest) -> Result<String, Failure> {
        let kept: usize = self.cells.iter().map(|cell| cell.told.len()).sum();
        let total: u32 = self.cells.iter().map(|cell| cell.scenario.trials).sum();
        for cell in &mut self.cells {
            cell.parts = None;
        }
        if kept == 0 {
            self.study.clear(&manifest.settings)?;
            return Ok("interrupted before a trial had finished; nothing is kept".to_owned());
        }
        Ok(format!(
            "interrupted: {kept} of {total} trials are kept in {}; run the same command to go on",
            shown(self.study.path())
        ))
    }

    /// Whether the intervals are narrow enough by now.
    fn stopping(&self, width: f64) -> Stopping {
        let design = self.design();
        let figure = design.compared.first().copied().unwrap_or(0);
        let widest = widest(&self.figures[figure], &self.trials(), figure);
        let trials = self.cells.iter().map(|cell| cell.scenario.trials).max().unwrap_or(0);
        Stopping {
            figure: self.figures[figure].key.clone(),
            width,
            widest,
            trials,
            cap: self.arguments.most_trials,
            reached: widest.is_some_and(|widest| widest <= width),
        }
    }

    /// What the trials tell of the figures that all settings have.
    fn trials(&self) -> Vec<Trials> {
        let of = |cell: &Cell| Trials {
            name: cell.setting.name.clone(),
            label: cell.setting.label(),
            levels: cell.setting.levels.clone(),
            seed: cell.scenario.seed,
            samples: cell
                .places
                .iter()
                .map(|&place| {
                    let told = (0..cell.scenario.trials).filter_map(|trial| cell.told.get(&trial));
                    let mut samples: Vec<Sample> = told.map(|told| told[place].clone()).collect();
                    pool(&mut samples);
                    samples
                })
                .collect(),
        };
        self.cells.iter().map(of).collect()
    }

    fn design(&self) -> Design {
        let place = |key: &String| self.figures.iter().position(|figure| figure.key == *key);
        let Plan {
            name,
            question,
            factors,
            ..
        } = self.plan;
        let factors = factors.iter().map(|(name, levels)| Factor {
            name: name.clone(),
            levels: levels.clone(),
        });
        Design {
            study: name.clone(),
            question: question.clone(),
            factors: factors.collect(),
            figures: self.figures.clone(),
            compared: self.plan.figures.iter().filter_map(place).collect(),
            reference: self.plan.reference,
            relevant: self.plan.relevant,
            pareto: self
                .plan
                .pareto
                .as_ref()
                .and_then(|[x, y]| Some([place(x)?, place(y)?])),
        }
    }
}

/// The figures that all protocols have, in the order of the first.
fn common(registries: &[Registry]) -> Vec<Figure> {
    let in_all = |figure: &&Figure| {
        registries
            .iter()
            .all(|registry| registry.figures().any(|own| own == *figure))
    };
    let first = registries.first().into_iter().flat_map(Registry::figures);
    first.filter(in_all).cloned().collect()
}
