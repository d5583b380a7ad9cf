//! Finished trials wherever they are kept: in one folder, or spread over those of several processes.

use std::path::PathBuf;

use super::part_file::FinishedTrial;
use super::parts::{Parts, PartsError};

/// The finished trials of an experiment, all of them, to be read in order.
#[derive(Clone, Debug)]
pub struct Kept {
    folders: Vec<Parts>,
    /// The place among the folders of each trial; empty where there is one folder.
    places: Vec<u32>,
}

/// What is found of an experiment's trials in some folders.
#[derive(Debug, Default)]
pub struct Found {
    /// The trials that are in none of them, in order.
    pub missing: Vec<u32>,
    /// The files that are none of these trials, though they are called so; what is wrong with each.
    pub damaged: Vec<PartsError>,
}

/// Two folders have trials of one number that differ.
#[derive(Debug)]
pub struct Contradiction {
    /// Number of the trial.
    pub trial: u32,
    /// The folders.
    pub folders: [PathBuf; 2],
}

impl Kept {
    /// All trials, in one folder.
    #[must_use]
    pub fn in_one(folder: Parts) -> Self {
        Self {
            folders: vec![folder],
            places: Vec::new(),
        }
    }

    /// Looks for the first `trials` trials in `folders`. A trial that is in several is read there all, and must be the same.
    ///
    /// # Errors
    /// If a trial is not, or a folder cannot be read.
    pub fn among(folders: Vec<Parts>, trials: u32) -> Result<Result<(Self, Found), Contradiction>, PartsError> {
        let mut there: Vec<Vec<u32>> = vec![Vec::new(); trials as usize];
        for (place, folder) in (0..).zip(&folders) {
            for trial in folder.there()? {
                if let Some(places) = there.get_mut(trial as usize) {
                    places.push(place);
                }
            }
        }
        let mut found = Found::default();
        let mut places = Vec::new();
        for (trial, candidates) in (0..).zip(there) {
            match choose(&folders, trial, &candidates, &mut found.damaged) {
                Err(contradiction) => return Ok(Err(contradiction)),
                Ok(Some(place)) => places.push(place),
                Ok(None) => {
                    found.missing.push(trial);
                    places.push(0);
                }
            }
        }
        Ok(Ok((Self { folders, places }, found)))
    }

    /// Reads a trial.
    ///
    /// # Errors
    /// If it is not there, or not what its name says.
    pub fn load(&self, trial: u32) -> Result<FinishedTrial, PartsError> {
        let place = self.places.get(trial as usize).copied().unwrap_or(0);
        self.folders[place as usize].load(trial)
    }
}

/// The first of the folders at `places` that has this trial whole, if any does.
fn choose(
    folders: &[Parts],
    trial: u32,
    places: &[u32],
    damaged: &mut Vec<PartsError>,
) -> Result<Option<u32>, Contradiction> {
    if let [place] = places {
        // Nothing to compare it with: it need not be read whole.
        let opened = folders[*place as usize].open(trial);
        let whole = opened.map_err(|wrong| damaged.push(wrong)).is_ok();
        return Ok(whole.then_some(*place));
    }
    let mut first: Option<(u32, FinishedTrial)> = None;
    for &place in places {
        let part = match folders[place as usize].load(trial) {
            Ok(part) => part,
            Err(wrong) => {
                damaged.push(wrong);
                continue;
            }
        };
        match &first {
            None => first = Some((place, part)),
            Some((own, known)) if known.record != part.record => {
                let folders = [*own, place].map(|place| folders[place as usize].dir().to_owned());
                return Err(Contradiction { trial, folders });
            }
            Some(_) => {}
        }
    }
    Ok(first.map(|(place, _)| place))
}
