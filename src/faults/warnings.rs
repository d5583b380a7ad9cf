//! Faults that are well-formed and can never act.

use super::config::{
    ChosenConfig, FaultConfig, IntervalConfig, LastsConfig, PlannedConfig, RadiationConfig, RegionConfig, RobotsConfig,
    WhenConfig, point,
};
use super::rules::Problem;
use crate::engine::Span;
use crate::geometry::Vec2;
use crate::quantity::{NonNegative, Probability};

/// What the faults of a scenario meet with.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// When a trial ends, seconds.
    pub time_limit: f64,
    /// Half of the width and height within which robots' centres lie, metres.
    pub half: Vec2,
    /// A role that one robot alone has, and for ever, with its number.
    pub reserved: Option<(u32, &'a str)>,
}

/// The faults of `faults` that can never act, each with the field because of which it cannot.
#[must_use]
pub fn warnings(faults: &[FaultConfig], stage: &Stage) -> Vec<Problem> {
    let mut found = Vec::new();
    for (index, fault) in faults.iter().enumerate() {
        let mut look = Look {
            index,
            stage,
            found: &mut found,
        };
        look.fault(fault);
    }
    found
}

struct Look<'a> {
    index: usize,
    stage: &'a Stage<'a>,
    found: &'a mut Vec<Problem>,
}

impl Look<'_> {
    fn fault(&mut self, fault: &FaultConfig) {
        match fault {
            FaultConfig::Silence(planned)
            | FaultConfig::Crash(planned)
            | FaultConfig::Mute(planned)
            | FaultConfig::Deaf(planned) => self.moment("at", planned.at),
            FaultConfig::Fallible(fallible) => self.chance("hazard", fallible.hazard),
            FaultConfig::OnJoin(join) => self.chance("probability", join.probability),
            FaultConfig::Radiation(radiation) => {
                self.region("within", &radiation.within);
                self.interval("during", radiation.during);
                self.chance("hazard", radiation.hazard);
            }
            FaultConfig::Robots(robots) => self.general(robots),
            FaultConfig::Partition(partition) => {
                self.interval("during", partition.during);
                self.line(point(partition.line.0), point(partition.line.1));
            }
            FaultConfig::Burst(burst) => {
                self.interval("during", burst.during);
                self.chance("loss", burst.loss);
            }
        }
        if let FaultConfig::Silence(PlannedConfig { lasts, .. })
        | FaultConfig::Crash(PlannedConfig { lasts, .. })
        | FaultConfig::Mute(PlannedConfig { lasts, .. })
        | FaultConfig::Deaf(PlannedConfig { lasts, .. })
        | FaultConfig::Radiation(RadiationConfig { lasts, .. })
        | FaultConfig::Robots(RobotsConfig { lasts, .. }) = fault
        {
            self.duration(*lasts);
        }
    }

    fn general(&mut self, robots: &RobotsConfig) {
        self.region("within", &robots.within);
        match robots.when {
            WhenConfig::At(at) => self.moment("when", at),
            WhenConfig::Hazard { per_step, during } => {
                self.interval("when.Hazard.during", during);
                self.chance("when.Hazard.per_step", per_step);
            }
            WhenConfig::OnJoin { probability, .. } => self.chance("when.OnJoin.probability", probability),
        }
        if let (ChosenConfig::Given(given), Some((owner, role))) = (&robots.robots, self.stage.reserved) {
            let named = |name: &str| robots.roles.iter().any(|known| known == name);
            let others = robots.roles.iter().any(|known| known != role);
            let only_owner = given.iter().all(|robot| *robot == owner);
            let without_owner = !given.contains(&owner);
            if only_owner && others && !named(role) {
                self.report(
                    "roles",
                    &format!("robot {owner} is always the {role}, and never has one of these roles"),
                );
            } else if without_owner && named(role) && !others {
                self.report(
                    "roles",
                    &format!("only robot {owner} is ever the {role}, and it is not among the robots"),
                );
            }
        }
    }

    fn moment(&mut self, path: &str, at: NonNegative) {
        let (at, end) = (at.get(), self.stage.time_limit);
        if at >= end {
            self.report(path, &format!("it comes at {at} s, and a trial ends at {end} s"));
        }
    }

    fn interval(&mut self, path: &str, during: IntervalConfig) {
        let from = during.bounds().0.as_secs();
        let end = self.stage.time_limit;
        if from >= end {
            self.report(path, &format!("it begins at {from} s, and a trial ends at {end} s"));
        }
    }

    fn duration(&mut self, lasts: LastsConfig) {
        if let LastsConfig::For(seconds) = lasts
            && Span::from_secs(seconds.get()) == Span::ZERO
        {
            let seconds = seconds.get();
            self.report(
                "lasts",
                &format!("{seconds} s is over as it begins, for time counts nanoseconds"),
            );
        }
    }

    fn chance(&mut self, path: &str, chance: Probability) {
        if chance.get() <= 0.0 {
            self.report(path, "its probability is 0");
        }
    }

    fn region(&mut self, path: &str, region: &RegionConfig) {
        let half = self.stage.half;
        // How far its nearest point is beyond where robots can be.
        let beyond = match region {
            RegionConfig::Anywhere => return,
            RegionConfig::Disc { at, radius } => {
                let off = (point(*at).abs() - half).map(|beyond| beyond.max(0.0));
                off.norm() - radius.get()
            }
            RegionConfig::Rectangle { at, size } => {
                let size = Vec2::new(size.0.get(), size.1.get()) / 2.0;
                (point(*at).abs() - half - size).max()
            }
        };
        if beyond > 0.0 {
            self.report(path, "the region lies outside of where robots can be");
        }
    }

    fn line(&mut self, from: Vec2, to: Vec2) {
        let half = self.stage.half;
        let along = to - from;
        let side = |x: f64, y: f64| along.perp(&(Vec2::new(x * half.x, y * half.y) - from));
        let sides = [side(-1.0, -1.0), side(-1.0, 1.0), side(1.0, -1.0), side(1.0, 1.0)];
        if sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0) {
            self.report("line", "all of the arena lies on one side of the line");
        }
    }

    fn report(&mut self, path: &str, why: &str) {
        let message = format!("this fault never acts: {why}");
        self.found.push((format!("[{}].{path}", self.index), message));
    }
}
