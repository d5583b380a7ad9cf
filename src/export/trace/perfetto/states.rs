//! What lasts: roles, faults, suspicions. Before the part of the run that is traced they are only kept, and drawn from its beginning on.

use std::collections::BTreeMap;
use std::io::{self, Write};

use serde_json::{Value, json};

use super::heard::{Heard, Pair};
use super::tracks::{INSTANT, Kind, Owner, Slice, Track, Tracks};
use crate::engine::{ActorId, SimTime};
use crate::happenings::log::{Event, What};

/// What holds at an instant.
#[derive(Debug, Default)]
pub struct States {
    /// Whether it is drawn.
    is_drawn: bool,
    /// Names of the roles.
    names: &'static [&'static str],
    /// Of each robot that is shown its role.
    roles: BTreeMap<ActorId, (u8, Option<Track>)>,
    /// What ails whom, each as often as it does.
    faults: BTreeMap<(Owner, &'static str), Vec<Option<Track>>>,
    /// Who suspects whom, by the number of that suspicion.
    suspicions: BTreeMap<Pair, u64>,
}

impl States {
    /// These robots are shown, all of the first of the roles with these `names`.
    pub fn of(robots: impl Iterator<Item = ActorId>, names: &'static [&'static str]) -> Self {
        Self {
            names,
            roles: robots.map(|robot| (robot, (0, None))).collect(),
            ..Self::default()
        }
    }

    /// Draws what holds, from `at` on.
    ///
    /// # Errors
    /// Those of the file.
    pub fn begin(&mut self, tracks: &mut Tracks<impl Write>, at: SimTime) -> io::Result<()> {
        self.is_drawn = true;
        for (&robot, (role, track)) in &mut self.roles {
            *track = Some(tracks.open(role_slice(self.names, robot, *role), at)?);
        }
        for (&(owner, name), open) in &mut self.faults {
            for track in open {
                *track = Some(tracks.open(fault_slice(owner, name), at)?);
            }
        }
        for (&(observer, suspect), &id) in &self.suspicions {
            tracks.apart("b", Owner::Robot(observer), &suspicion(suspect), id, at)?;
        }
        Ok(())
    }

    /// Takes in what happened at `event.at`; `next_id` gives numbers to arrows and suspicions.
    ///
    /// # Errors
    /// Those of the file.
    pub fn take(
        &mut self,
        event: &Event,
        heard: &mut Heard,
        tracks: &mut Tracks<impl Write>,
        next_id: &mut u64,
    ) -> io::Result<()> {
        let owner = event.robot.map_or(Owner::Links, Owner::Robot);
        match (&event.what, event.robot) {
            (What::Enters(role), Some(robot)) => self.enter(robot, *role, event.at, tracks),
            (What::Fails(effect), Some(_)) => self.fail(owner, effect.name(), event.at, tracks),
            (What::Recovers(effect), Some(_)) => self.recover(owner, effect.name(), event.at, tracks),
            (What::LinksFail(name), _) => self.fail(owner, name, event.at, tracks),
            (What::LinksRecover(name), _) => self.recover(owner, name, event.at, tracks),
            (What::Watches(other), Some(robot)) => {
                heard.watch((robot, *other));
                Ok(())
            }
            (What::Suspects(other, last), Some(robot)) => {
                self.suspect((robot, *other), event.at, *last, heard, tracks, next_id)
            }
            (What::Trusts(other), Some(robot)) => self.trust((robot, *other), event.at, tracks),
            _ => Ok(()),
        }
    }

    /// Ends what is drawn.
    ///
    /// # Errors
    /// Those of the file.
    pub fn end(&mut self, tracks: &mut Tracks<impl Write>, at: SimTime) -> io::Result<()> {
        let faults = self.faults.values_mut().flat_map(std::mem::take);
        let roles = self.roles.values_mut().map(|(_, track)| track.take());
        for track in roles.chain(faults).flatten() {
            tracks.close(track, at)?;
        }
        for ((observer, suspect), id) in std::mem::take(&mut self.suspicions) {
            tracks.apart("e", Owner::Robot(observer), &suspicion(suspect), id, at)?;
        }
        Ok(())
    }

    fn enter(&mut self, robot: ActorId, role: u8, at: SimTime, tracks: &mut Tracks<impl Write>) -> io::Result<()> {
        let Some((now, track)) = self.roles.get_mut(&robot) else {
            return Ok(());
        };
        if *now == role {
            return Ok(());
        }
        *now = role;
        if let Some(track) = track {
            tracks.close(*track, at)?;
            *track = tracks.open(role_slice(self.names, robot, role), at)?;
        }
        Ok(())
    }

    fn fail(
        &mut self,
        owner: Owner,
        name: &'static str,
        at: SimTime,
        tracks: &mut Tracks<impl Write>,
    ) -> io::Result<()> {
        let slice = self.is_drawn.then(|| fault_slice(owner, name));
        let track = slice.map(|slice| tracks.open(slice, at)).transpose()?;
        self.faults.entry((owner, name)).or_default().push(track);
        Ok(())
    }

    fn recover(
        &mut self,
        owner: Owner,
        name: &'static str,
        at: SimTime,
        tracks: &mut Tracks<impl Write>,
    ) -> io::Result<()> {
        match self.faults.get_mut(&(owner, name)).and_then(Vec::pop).flatten() {
            Some(track) => tracks.close(track, at),
            None => Ok(()),
        }
    }

    fn suspect(
        &mut self,
        pair: Pair,
        at: SimTime,
        last: SimTime,
        heard: &Heard,
        tracks: &mut Tracks<impl Write>,
        next_id: &mut u64,
    ) -> io::Result<()> {
        let (observer, suspect) = pair;
        let owner = Owner::Robot(observer);
        let name = suspicion(suspect);
        let id = take_number(next_id);
        let is_new = self.suspicions.insert(pair, id).is_none();
        if !self.is_drawn {
            return Ok(());
        }
        // An arrow cannot lead to a slice with a track of its own: it leads to one that marks the instant.
        let slice = Slice {
            owner,
            kind: Kind::Suspects,
            name: &name,
            args: json!({ "robot": suspect.0, "last_heard_s": last.as_secs() }),
        };
        let mark = tracks.slice(slice, at, INSTANT)?;
        if let Some(track) = heard.find(pair, last) {
            let arrow = take_number(next_id);
            tracks.flow("s", "last heard", arrow, (track, last))?;
            tracks.flow("f", "last heard", arrow, (mark, at))?;
        }
        if is_new {
            tracks.apart("b", owner, &name, id, at)?;
        }
        Ok(())
    }

    fn trust(&mut self, pair: Pair, at: SimTime, tracks: &mut Tracks<impl Write>) -> io::Result<()> {
        match self.suspicions.remove(&pair) {
            Some(id) if self.is_drawn => tracks.apart("e", Owner::Robot(pair.0), &suspicion(pair.1), id, at),
            _ => Ok(()),
        }
    }
}

/// The next number that nothing else has.
pub fn take_number(next: &mut u64) -> u64 {
    *next += 1;
    *next
}

fn role_slice(names: &'static [&'static str], robot: ActorId, role: u8) -> Slice<'static> {
    Slice {
        owner: Owner::Robot(robot),
        kind: Kind::Role,
        name: names.get(usize::from(role)).copied().unwrap_or("unknown"),
        args: Value::Null,
    }
}

fn fault_slice(owner: Owner, name: &'static str) -> Slice<'static> {
    Slice {
        owner,
        kind: Kind::Faults,
        name,
        args: Value::Null,
    }
}

fn suspicion(suspect: ActorId) -> String {
    format!("suspects robot {}", suspect.0)
}
