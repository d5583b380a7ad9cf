//! What is wrong with faults whose fields are each in range.

use super::config::{ChosenConfig, FaultConfig, IntervalConfig, LinksConfig, RobotsConfig, WhenConfig};

/// A field's path, relative to the list of faults, and what to do about its value.
pub type Problem = (String, String);

/// More faults than this a scenario cannot have: they are numbered by two bytes, and one number is that of empty batteries.
const MOST: usize = (1 << 16) - 1;
/// Similarity (Jaro and Winkler, from 0 to 1) above which a name may be meant for another.
const NEAR: f64 = 0.75;

/// What is wrong with `faults` among `robots` robots of a protocol with these `roles`: robots and roles that are not there,
/// times that end before they begin, lines without a direction.
#[must_use]
pub fn problems(faults: &[FaultConfig], robots: u32, roles: &[&str]) -> Vec<Problem> {
    if faults.len() > MOST {
        return vec![(String::new(), format!("{} faults, more than {MOST}", faults.len()))];
    }
    let mut found = Vec::new();
    for (index, fault) in faults.iter().enumerate() {
        let mut check = Check {
            path: format!("[{index}]"),
            robots,
            roles,
            found: &mut found,
        };
        check.fault(fault);
    }
    found
}

struct Check<'a> {
    path: String,
    robots: u32,
    roles: &'a [&'a str],
    found: &'a mut Vec<Problem>,
}

impl Check<'_> {
    fn fault(&mut self, fault: &FaultConfig) {
        match fault {
            FaultConfig::Silence(planned)
            | FaultConfig::Crash(planned)
            | FaultConfig::Mute(planned)
            | FaultConfig::Deaf(planned) => self.ids("robots", &planned.robots),
            FaultConfig::Fallible(fallible) => self.role_names(&fallible.roles),
            FaultConfig::OnJoin(join) => {
                self.role_names(&join.roles);
                self.roles_of_join("roles", &join.roles);
            }
            FaultConfig::Radiation(radiation) => self.interval("during", radiation.during),
            FaultConfig::Robots(robots) => self.general(robots),
            FaultConfig::Partition(partition) => {
                self.interval("during", partition.during);
                if partition.line.0 == partition.line.1 {
                    self.report("line", "the two points are the same: a line needs two");
                }
            }
            FaultConfig::Burst(burst) => {
                self.interval("during", burst.during);
                self.links(&burst.links);
            }
        }
    }

    fn general(&mut self, robots: &RobotsConfig) {
        if let ChosenConfig::Given(given) = &robots.robots {
            self.ids("robots.Given", given);
        }
        self.role_names(&robots.roles);
        match robots.when {
            WhenConfig::Hazard { during, .. } => self.interval("when.Hazard.during", during),
            WhenConfig::OnJoin { .. } => self.roles_of_join("when", &robots.roles),
            WhenConfig::At(_) => {}
        }
    }

    fn links(&mut self, links: &LinksConfig) {
        match links {
            LinksConfig::All => {}
            LinksConfig::Of(robots) => self.ids("links.Of", robots),
            LinksConfig::Pairs(pairs) => {
                for (index, &(a, b)) in pairs.iter().enumerate() {
                    let path = format!("links.Pairs[{index}]");
                    self.ids(&path, &[a, b]);
                    if a == b {
                        self.report(&path, &format!("robot {a} has no link to itself: name two robots"));
                    }
                }
            }
        }
    }

    fn ids(&mut self, path: &str, ids: &[u32]) {
        let robots = self.robots;
        if ids.is_empty() {
            self.report(path, "no robot is named: name one or more, or remove the fault");
        }
        for (index, id) in ids.iter().enumerate().filter(|(_, id)| **id >= robots) {
            let message = format!(
                "there is no robot {id}: the {robots} robots have numbers from 0 to {}",
                robots.saturating_sub(1)
            );
            self.report(&format!("{path}[{index}]"), &message);
        }
    }

    fn role_names(&mut self, named: &[String]) {
        let known = self.roles;
        for (index, name) in named.iter().enumerate() {
            if !known.contains(&name.as_str()) {
                let guess = nearest(name, known).map_or(".".into(), |role| format!(", did you mean `{role}`?"));
                let message = format!(
                    "the protocol has no role `{name}`{guess} Its roles: {}",
                    known.join(", ")
                );
                self.report(&format!("roles[{index}]"), &message);
            }
        }
    }

    /// A robot joins by taking a role, so roles must be named.
    fn roles_of_join(&mut self, path: &str, named: &[String]) {
        if named.is_empty() {
            let message = format!(
                "a robot fails on taking one of `roles`, and none is named: name some of {}",
                self.roles.join(", ")
            );
            self.report(path, &message);
        }
    }

    fn interval(&mut self, path: &str, interval: IntervalConfig) {
        let (from, until) = interval.bounds();
        if until <= from {
            let message = format!(
                "it ends at {} s and begins at {} s: let it end later",
                until.as_secs(),
                from.as_secs()
            );
            self.report(path, &message);
        }
    }

    fn report(&mut self, path: &str, message: &str) {
        self.found.push((format!("{}.{path}", self.path), message.to_owned()));
    }
}

/// The known name that is nearest to `found`, if one is near.
fn nearest<'k>(found: &str, known: &[&'k str]) -> Option<&'k str> {
    let similarity = |name: &str| strsim::jaro_winkler(&found.to_lowercase(), name);
    let best = known.iter().max_by(|a, b| similarity(a).total_cmp(&similarity(b)));
    best.copied().filter(|name| similarity(name) > NEAR)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::faults::{BurstConfig, Effect, FallibleConfig, OnJoinConfig, PartitionConfig, PlannedConfig};
    use crate::quantity::{Finite, NonNegative, Probability};

    const ROLES: [&str; 3] = ["free", "networker", "worker"];

    fn assert_problem(fault: FaultConfig, path: &str, message: &str) {
        let found = problems(&[fault], 40, &ROLES);
        assert_eq!(found, [(path.to_owned(), message.to_owned())]);
    }

    #[test]
    fn a_robot_that_is_not_there_is_named_with_those_that_are() {
        let planned = PlannedConfig {
            robots: vec![3, 40],
            at: NonNegative::new(1.0),
            lasts: super::super::LastsConfig::ForGood,
        };
        assert_problem(
            FaultConfig::Crash(planned),
            "[0].robots[1]",
            "there is no robot 40: the 40 robots have numbers from 0 to 39",
        );
        let burst = |pairs| BurstConfig {
            links: LinksConfig::Pairs(pairs),
            loss: Probability::new(0.5),
            during: IntervalConfig::Always,
        };
        assert_problem(
            FaultConfig::Burst(burst(vec![(0, 1), (2, 2)])),
            "[0].links.Pairs[1]",
            "robot 2 has no link to itself: name two robots",
        );
        assert_problem(
            FaultConfig::Burst(burst(vec![(0, 77)])),
            "[0].links.Pairs[0][1]",
            "there is no robot 77: the 40 robots have numbers from 0 to 39",
        );
    }

    #[test]
    fn a_role_that_the_protocol_does_not_have_is_answered_with_the_nearest() {
        let fallible = |role: &str| FallibleConfig {
            share: Probability::new(0.5),
            hazard: Probability::new(0.1),
            roles: vec![role.to_owned()],
        };
        assert_problem(
            FaultConfig::Fallible(fallible("Netwroker")),
            "[0].roles[0]",
            "the protocol has no role `Netwroker`, did you mean `networker`? Its roles: free, networker, worker",
        );
        assert_eq!(problems(&[FaultConfig::Fallible(fallible("worker"))], 40, &ROLES), []);
    }

    #[test]
    fn a_join_needs_roles_a_time_its_end_and_a_line_a_direction() {
        assert_problem(
            FaultConfig::OnJoin(OnJoinConfig {
                probability: Probability::new(0.5),
                window: NonNegative::new(10.0),
                roles: Vec::new(),
            }),
            "[0].roles",
            "a robot fails on taking one of `roles`, and none is named: name some of free, networker, worker",
        );
        let robots = RobotsConfig {
            effect: Effect::Deaf,
            robots: ChosenConfig::All,
            roles: Vec::new(),
            within: super::super::RegionConfig::Anywhere,
            when: WhenConfig::Hazard {
                per_step: Probability::new(0.5),
                during: IntervalConfig::Between(NonNegative::new(9.0), NonNegative::new(8.5)),
            },
            lasts: super::super::LastsConfig::ForGood,
        };
        assert_problem(
            FaultConfig::Robots(robots),
            "[0].when.Hazard.during",
            "it ends at 8.5 s and begins at 9 s: let it end later",
        );
        let point = (Finite::new(1.0), Finite::new(2.0));
        assert_problem(
            FaultConfig::Partition(PartitionConfig {
                line: (point, point),
                during: IntervalConfig::Always,
            }),
            "[0].line",
            "the two points are the same: a line needs two",
        );
    }
}
