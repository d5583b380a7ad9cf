//! Finished trials wherever they are kept: in one folder, or spread over those of several processes.

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
    pub fn among(folders: Vec<Parts>, trials: u32) -> Result<(Self, Found), PartsError> {
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
            let place = choose(&folders, trial, &candidates, &mut found.damaged)?;
            found.missing.extend(place.is_none().then_some(trial));
            places.push(place.unwrap_or(0));
        }
        Ok((Self { folders, places }, found))
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
) -> Result<Option<u32>, PartsError> {
    if let [place] = places {
        // Nothing to compare it with: it need not be read whole.
        let verified = folders[*place as usize].verify(trial);
        let whole = verified.map_err(|wrong| damaged.push(wrong)).is_ok();
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
                return Err(PartsError::Contradiction { trial, folders });
            }
            Some(_) => {}
        }
    }
    Ok(first.map(|(place, _)| place))
}
