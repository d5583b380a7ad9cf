//! The settings of a study being run: their folders, their trials in one pool, and what these tell.

use std::collections::BTreeMap;

use super::asked::{StudyRun, Until};
use super::error::{Other, RunsError};
use super::options::Options;
use super::trials::{Happening, run_missing};
use crate::experiment::{Ending, FinishedTrial, Parts};
use crate::export::{self, Contents, Folder, Manifest, Pictures, StudyFolder, StudyManifest};
use crate::metrics::comparison::{Comparison, Design, Factor, Stopping, Trials, widest};
use crate::metrics::figures::{Figure, Registry, Sample, pool};
use crate::report;
use crate::scenario::{Plan, Scenario, Setting};

/// The settings of a study, ready to run.
pub(super) struct Settings<'a> {
    study: &'a StudyFolder,
    plan: &'a Plan,
    until: Option<Until>,
    options: &'a Options,
    cells: Vec<Cell<'a>>,
    /// What the figures are that all settings have.
    figures: Vec<Figure>,
    /// The comparison, if an attempt that was cut short has come that far.
    compared: Option<Comparison>,
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
        run: &StudyRun<'a>,
        options: &'a Options,
        manifest: &StudyManifest,
    ) -> Result<Self, RunsError> {
        let plan = run.plan;
        let registries: Vec<Registry> = plan.settings.iter().map(|setting| setting.scenario.figures()).collect();
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
                    return Err(RunsError::Taken {
                        dir: folder.path().to_owned(),
                        of: Other::Setting,
                        differences,
                    });
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
            until: run.until,
            options,
            cells,
            figures,
            compared,
        })
    }

    /// Runs the trials that are missing, compares, and writes everything.
    pub fn compare(
        mut self,
        mut manifest: StudyManifest,
        tell: &mut dyn FnMut(Happening),
    ) -> Result<Comparison, RunsError> {
        self.study.declare(&manifest)?;
        self.claim(&mut manifest)?;
        let comparison = match self.compared.take() {
            Some(comparison) => comparison,
            None => self.simulate(&mut manifest, tell)?,
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
    fn claim(&mut self, manifest: &mut StudyManifest) -> Result<(), RunsError> {
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

    fn simulate(
        &mut self,
        manifest: &mut StudyManifest,
        tell: &mut dyn FnMut(Happening),
    ) -> Result<Comparison, RunsError> {
        let batch: Vec<u32> = self.cells.iter().map(|cell| cell.scenario.trials).collect();
        let stopping = loop {
            self.batch(manifest, tell)?;
            let Some(until) = self.until else {
                break None;
            };
            let stopping = self.stopping(until);
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
    fn batch(&mut self, manifest: &StudyManifest, tell: &mut dyn FnMut(Happening)) -> Result<(), RunsError> {
        self.recall();
        let kept: usize = self.cells.iter().map(|cell| cell.told.len()).sum();
        let mut told: Vec<(usize, u32, Vec<Sample>)> = Vec::new();
        let ending = {
            let run: Vec<(&Cell, &Parts)> = self
                .cells
                .iter()
                .filter_map(|cell| Some((cell, cell.parts.as_ref()?)))
                .collect();
            let trials: Vec<(&Scenario, &Parts)> = run.iter().map(|(cell, parts)| (&cell.scenario, *parts)).collect();
            let finished = |place: usize, part: &FinishedTrial| {
                told.push((place, part.record.trial, run[place].0.registry.read(&part.record)));
            };
            run_missing(&trials, kept as u32, self.options, finished, tell)
        };
        for (cell, trial, samples) in told {
            self.cells[cell].told.insert(trial, samples);
        }
        if let Ok(Ending::Finished) = ending {
            return Ok(());
        }
        let interrupted = self.leave(manifest)?;
        ending?;
        Err(interrupted)
    }

    /// Leaves an unfinished study: finished trials stay, and if there are none, nothing does. Answers how many there are.
    fn leave(&mut self, manifest: &StudyManifest) -> Result<RunsError, RunsError> {
        let kept: usize = self.cells.iter().map(|cell| cell.told.len()).sum();
        for cell in &mut self.cells {
            cell.parts = None;
        }
        if kept == 0 {
            self.study.clear(&manifest.settings)?;
        }
        Ok(RunsError::Interrupted {
            kept,
            trials: self.cells.iter().map(|cell| cell.scenario.trials).sum(),
            dir: self.study.path().to_owned(),
        })
    }

    /// Whether the intervals are narrow enough by now.
    fn stopping(&self, Until { width, most_trials }: Until) -> Stopping {
        let design = self.design();
        let figure = design.compared.first().copied().unwrap_or(0);
        let widest = widest(&self.figures[figure], &self.trials(), figure);
        let trials = self.cells.iter().map(|cell| cell.scenario.trials).max().unwrap_or(0);
        Stopping {
            figure: self.figures[figure].key.clone(),
            width,
            widest,
            trials,
            cap: most_trials,
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
