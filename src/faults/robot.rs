//! One fault of robots: who is exposed, who fails, who recovers.

use rand::RngExt as _;

use super::config::{ChosenConfig, Effect, LastsConfig, RegionConfig, RobotsConfig, WhenConfig};
use crate::engine::{ActorId, KeyedStreams, Purpose, SimTime, Span, Streams};
use crate::geometry::Vec2;

/// Whether a robot belongs to a share: one uniform number a robot and fault.
const SHARE: Purpose = Purpose::new("faults.share");
/// How much hazard a robot bears: one number a robot, fault and failure.
const HAZARD: Purpose = Purpose::new("faults.hazard");
/// Whether and when a robot that has joined fails: two numbers a robot, fault and join.
const JOIN: Purpose = Purpose::new("faults.join");

/// What makes exposed robots fail.
#[derive(Clone, Copy, Debug)]
enum Trigger {
    At(SimTime),
    /// Each control step within the bounds adds `dose` to what a robot has borne; it fails once that exceeds a
    /// unit-exponential threshold. With dose −ln(1 − h) this is the probability h a control step, and the robot that fails
    /// at one hazard fails no later at a greater one.
    Hazard {
        dose: f64,
        from: SimTime,
        until: SimTime,
    },
    OnJoin {
        probability: f64,
        window: Span,
    },
    /// It has struck.
    Spent,
}

/// A fault as one robot has it.
#[derive(Clone, Copy, Debug)]
struct Case {
    /// Whether it may fail at all.
    chosen: bool,
    /// Whether it has one of the roles.
    in_role: bool,
    failed: bool,
    /// When it recovers, if it has failed and does.
    recovers: SimTime,
    /// When a join makes it fail, if it does.
    due: SimTime,
    /// Control steps of exposure since the start or the last recovery.
    exposure: u64,
    /// The hazard that it bears.
    threshold: f64,
    /// Draws made: failures of a hazard, joins.
    occasions: u32,
}

impl Case {
    /// Whether it may fail, now or once it has recovered.
    fn may_fail(&self) -> bool {
        self.chosen && (!self.failed || self.recovers < SimTime::NEVER)
    }
}

/// One fault of robots.
#[derive(Debug)]
pub(super) struct RobotFault {
    pub effect: Effect,
    /// Its place in the scenario's list, part of the key of every draw.
    index: u32,
    /// Which roles it is about.
    roles: Vec<bool>,
    within: RegionConfig,
    trigger: Trigger,
    lasts: Option<Span>,
    control_period: Span,
    hazard: KeyedStreams,
    join: KeyedStreams,
    cases: Vec<Case>,
    /// The last control step that counted: at one instant it may be asked more than once.
    counted: SimTime,
}

impl RobotFault {
    /// The fault that `config` describes, number `index` of its scenario, among `robots` robots that all start in the first
    /// of `roles`.
    pub fn new(
        config: &RobotsConfig,
        index: u32,
        roles: &[&str],
        robots: usize,
        control_period: Span,
        streams: Streams,
    ) -> Self {
        let seconds = Span::from_secs;
        let trigger = match &config.when {
            WhenConfig::At(at) => Trigger::At(SimTime::from_secs(at.get())),
            WhenConfig::Hazard { per_step, during } => {
                let (from, until) = during.bounds();
                let dose = -(-per_step.get()).ln_1p();
                Trigger::Hazard { dose, from, until }
            }
            WhenConfig::OnJoin { probability, window } => Trigger::OnJoin {
                probability: probability.get(),
                window: seconds(window.get()),
            },
        };
        let shares = streams.keyed(SHARE);
        let chosen = |robot: u32| match &config.robots {
            ChosenConfig::All => true,
            ChosenConfig::Given(given) => given.contains(&robot),
            ChosenConfig::Share(share) => shares.at(robot, index, 0).random::<f64>() < share.get(),
        };
        let case = |robot| Case {
            chosen: chosen(robot),
            in_role: false,
            failed: false,
            recovers: SimTime::NEVER,
            due: SimTime::NEVER,
            exposure: 0,
            threshold: f64::INFINITY,
            occasions: 0,
        };
        let mut fault = Self {
            effect: config.effect,
            index,
            roles: roles
                .iter()
                .map(|role| config.roles.is_empty() || config.roles.iter().any(|named| named == role))
                .collect(),
            within: config.within.clone(),
            trigger,
            lasts: match config.lasts {
                LastsConfig::ForGood => None,
                LastsConfig::For(time) => Some(seconds(time.get())),
            },
            control_period,
            hazard: streams.keyed(HAZARD),
            join: streams.keyed(JOIN),
            cases: (0..robots as u32).map(case).collect(),
            counted: SimTime::ZERO,
        };
        for robot in 0..robots {
            fault.draw_threshold(robot);
            fault.enter(SimTime::ZERO, ActorId(robot as u32), 0);
        }
        fault
    }

    /// When it must be asked next, after `now`.
    pub fn next(&self, now: SimTime) -> SimTime {
        let cases = self.cases.iter().map(|case| case.recovers.min(case.due)).min();
        cases.unwrap_or(SimTime::NEVER).min(self.next_trigger(now))
    }

    fn next_trigger(&self, now: SimTime) -> SimTime {
        match self.trigger {
            Trigger::At(at) => at,
            Trigger::Hazard { dose, from, until } if dose > 0.0 && self.cases.iter().any(Case::may_fail) => {
                let period = self.control_period.as_nanos();
                let step = SimTime::from_nanos((now.max(from).as_nanos() / period + 1).saturating_mul(period));
                if step <= until { step } else { SimTime::NEVER }
            }
            _ => SimTime::NEVER,
        }
    }

    /// `robot` takes `role` at `now`. When that makes it fail; `NEVER` if it does not.
    pub fn enter(&mut self, now: SimTime, robot: ActorId, role: u8) -> SimTime {
        let case = &mut self.cases[robot.index()];
        let was_in_role = std::mem::replace(&mut case.in_role, self.roles[usize::from(role)]);
        let Trigger::OnJoin { probability, window } = self.trigger else {
            return SimTime::NEVER;
        };
        if !case.in_role {
            case.due = SimTime::NEVER;
        } else if !was_in_role && case.chosen {
            let mut random = self.join.at(robot.0, self.index, case.occasions);
            case.occasions += 1;
            let (fails, when): (f64, f64) = (random.random(), random.random());
            if fails < probability {
                case.due = now + Span::from_secs(window.as_secs() * when);
            }
        }
        case.due
    }

    /// Calls `changed` for each robot that recovers (`false`) or fails (`true`) at `now`, in order of their ids.
    pub fn advance(&mut self, now: SimTime, places: &[Vec2], mut changed: impl FnMut(ActorId, bool)) {
        let is_step = now > self.counted && now.as_nanos().is_multiple_of(self.control_period.as_nanos());
        if is_step {
            self.counted = now;
        }
        for (index, place) in places.iter().enumerate() {
            let robot = ActorId(index as u32);
            if self.cases[index].recovers <= now {
                self.recover(index);
                changed(robot, false);
            }
            if self.strikes(now, is_step, index, *place) {
                let case = &mut self.cases[index];
                case.failed = true;
                case.recovers = self.lasts.map_or(SimTime::NEVER, |lasts| now + lasts);
                changed(robot, true);
            }
        }
        if matches!(self.trigger, Trigger::At(at) if at <= now) {
            self.trigger = Trigger::Spent;
        }
    }

    fn strikes(&mut self, now: SimTime, is_step: bool, index: usize, place: Vec2) -> bool {
        let case = &mut self.cases[index];
        let is_due = case.due <= now;
        if is_due {
            case.due = SimTime::NEVER;
        }
        let is_exposed = case.chosen && case.in_role && !case.failed && self.within.contains(place);
        is_exposed
            && match self.trigger {
                Trigger::At(at) => at == now,
                Trigger::Hazard { dose, from, until } => {
                    let counts = is_step && from < now && now <= until;
                    case.exposure += u64::from(counts);
                    counts && case.exposure as f64 * dose > case.threshold
                }
                Trigger::OnJoin { .. } => is_due,
                Trigger::Spent => false,
            }
    }

    fn recover(&mut self, index: usize) {
        let case = &mut self.cases[index];
        case.failed = false;
        case.recovers = SimTime::NEVER;
        self.draw_threshold(index);
    }

    fn draw_threshold(&mut self, index: usize) {
        if !matches!(self.trigger, Trigger::Hazard { .. }) {
            return;
        }
        let case = &mut self.cases[index];
        let uniform: f64 = self.hazard.at(index as u32, self.index, case.occasions).random();
        case.occasions += 1;
        case.exposure = 0;
        case.threshold = -(-uniform).ln_1p();
    }
}
