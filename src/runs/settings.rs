//! The settings of a study: their folders, their trials, what these tell, and what is written of them.

use std::rc::Rc;

use super::asked::{StudyRun, Until};
use super::error::{Other, RunsError};
use crate::experiment::{Claim, Kept, Parts};
use crate::export::{self, Contents, Folder, Manifest, Pictures, StudyFolder, StudyManifest};
use crate::metrics::comparison::{Comparison, Design, Factor, Stopping, Trials, widest};
use crate::metrics::figures::{Figure, Registry, Samples};
use crate::report;
use crate::scenario::{Plan, Scenario, Setting};

/// The settings of a study, ready to be run or put together.
pub(super) struct Settings<'a> {
    pub study: &'a StudyFolder,
    plan: &'a Plan,
    pub until: Option<Until>,
    pub cells: Vec<Cell<'a>>,
    /// What the figures are that all settings have.
    figures: Vec<Figure>,
    /// The comparison, if an attempt that was cut short has come that far.
    compared: Option<Comparison>,
}

/// A setting.
pub(super) struct Cell<'a> {
    pub setting: &'a Setting,
    pub scenario: Scenario,
    pub folder: Folder,
    /// Its trials; `None` once its results have been written.
    pub trials: Option<OwnTrials>,
    /// What its trials tell of its figures, of as many as have been read.
    told: Rc<Samples>,
    registry: Registry,
    /// Where each figure common to all settings stands among its own.
    places: Vec<usize>,
}

/// The trials of a setting whose results have not been written yet.
pub(super) struct OwnTrials {
    claim: Claim,
    /// In its own folder.
    pub parts: Parts,
    /// Wherever they are.
    kept: Kept,
}

impl<'a> Settings<'a> {
    /// Makes sure that each setting's folder holds nothing, or trials of that very setting. Writes nothing yet.
    pub fn open(study: &'a StudyFolder, run: &StudyRun<'a>, manifest: &StudyManifest) -> Result<Self, RunsError> {
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
                trials: None,
                told: Samples::new(registry.figures().count()).into(),
                places: places.collect(),
                registry,
            });
        }
        Ok(Self {
            study,
            plan,
            until: run.until,
            cells,
            figures,
            compared,
        })
    }

    /// The comparison, if an attempt that was cut short has come that far.
    pub fn compared(&mut self) -> Option<Comparison> {
        self.compared.take()
    }

    /// Claims the trials of every setting whose results have not been written yet, which are `kept` in the setting's folder or elsewhere. The
    /// results of the others go into `manifest`.
    pub fn claim(
        &mut self,
        manifest: &mut StudyManifest,
        kept: impl Fn(usize, &Parts) -> Kept,
    ) -> Result<(), RunsError> {
        for (place, cell) in self.cells.iter_mut().enumerate() {
            if let Contents::Results(there) = cell.folder.contents()?
                && there.finished
            {
                cell.folder.held(&there, &[])?;
                cell.folder.tidy();
                manifest.add(&cell.setting.name, &there);
                continue;
            }
            let asked = Manifest::new(&cell.scenario);
            let claim = Claim::lay(&cell.folder.trials())?;
            cell.folder.declare(&asked)?;
            let parts = cell.folder.parts(&asked);
            let kept = kept(place, &parts);
            cell.trials = Some(OwnTrials { claim, parts, kept });
        }
        Ok(())
    }

    /// Compares what the trials tell, all of which are there, and writes it.
    pub fn conclude(
        &mut self,
        manifest: &mut StudyManifest,
        stopping: Option<Stopping>,
    ) -> Result<Comparison, RunsError> {
        let trials = self.trials();
        let mut comparison = Comparison::of(&self.design(), &trials, stopping);
        report::describe(&mut comparison);
        self.study.write_comparison(&comparison, &trials, manifest)?;
        Ok(comparison)
    }

    /// Writes the results of every setting, and says that the study is finished.
    pub fn finish(&mut self, manifest: &mut StudyManifest) -> Result<(), RunsError> {
        for cell in &mut self.cells {
            cell.told = Samples::new(0).into();
            if let Some(OwnTrials { claim, kept, .. }) = cell.trials.take() {
                // There may be more of them by now than were asked for at first.
                cell.folder.declare(&Manifest::new(&cell.scenario))?;
                let (_, results) = export::write(&cell.folder, claim, &kept, &cell.scenario, Pictures::First)?;
                manifest.add(&cell.setting.name, &results);
            }
        }
        manifest.finished = true;
        Ok(self.study.declare(manifest)?)
    }

    /// Reads what the trials tell that are kept, for each setting, and have not been read yet. They must be there.
    pub fn recall(&mut self, kept: &[Kept]) -> Result<(), RunsError> {
        for (cell, kept) in self.cells.iter_mut().zip(kept) {
            for trial in cell.told.len() as u32..cell.scenario.trials {
                let told = cell.registry.read(&kept.load(trial)?.record);
                Rc::make_mut(&mut cell.told).push(&told);
            }
        }
        Ok(())
    }

    /// Whether the intervals are narrow enough by now.
    pub fn stopping(&self, Until { width, most_trials }: Until) -> Stopping {
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
            samples: Rc::clone(&cell.told),
            places: cell.places.clone(),
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
