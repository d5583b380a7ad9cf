//! When a robot believes that a neighbour is down: failure detectors behind one interface.
//!
//! A protocol has its [`Detector`] [step](Detector::step) at each wake, and asks it whom it suspects. Which detector that is, only the
//! scenario knows. Detectors that listen take statuses as signs of life; SWIM sends messages of its own, which the protocol carries on the
//! topic `probe`.
//!
//! Any protocol can run one: it says which topic is its statuses' and what its messages are to a detector, its kind heeds the scenario's
//! `detector` and `gossip.status`, and its robots get one. Reports then score it, and `desim explain` tells why it erred.
//!
//! ```
//! use desim::engine::SimTime;
//! use desim::kind::{Kind, Sections, Shared, Swarm};
//! use desim::protocol::detector::{Detector, Monitored, Sign};
//! use desim::protocol::gossip::OwnTurns;
//! use desim::protocol::{Input, Output, Protocol, Serialised, Topic, Wake};
//! # use schemars::JsonSchema;
//! # use serde::{Deserialize, Serialize};
//!
//! #[derive(Clone, Copy, Debug, Serialize, Deserialize)]
//! struct Alive;
//!
//! impl Monitored for Alive {
//!     fn sign(&self) -> Sign<'_> {
//!         Sign::Status // other messages would be `Sign::Other`
//!     }
//! }
//!
//! struct Robot {
//!     detector: Detector,
//!     turns: OwnTurns,
//! }
//!
//! impl Protocol for Robot {
//!     type Message = Alive;
//!     type Heard = Alive;
//!     type Codec = Serialised<Alive>;
//!     const TOPICS: &'static [&'static str] = &["status"];
//!     const ROLES: &'static [&'static str] = &["robot"];
//!     const STATUS: Option<Topic> = Some(Topic(0));
//!
//!     fn step(&mut self, now: SimTime, input: &mut Input<Alive>, output: &mut Output<Alive>) {
//!         self.detector.step(now, input, output);
//!         if input.wake == Wake::ControlStep && self.turns.is_due() {
//!             output.broadcast(Alive);
//!         }
//!     }
//! }
//!
//! /// Robots that watch each other.
//! #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
//! struct Watch;
//!
//! impl Kind for Watch {
//!     const NAME: &'static str = "Watch";
//!     type Robot = Robot;
//!
//!     fn robots(&self, swarm: &Swarm<'_>) -> Vec<Robot> {
//!         swarm.each(|id| Robot {
//!             detector: swarm.detector(id),
//!             turns: swarm.status_turns(id),
//!         })
//!     }
//!
//!     fn heeds(&self, _: &Sections<'_>) -> &'static [Shared] {
//!         &[Shared::Status, Shared::Detector]
//!     }
//! }
//!
//! desim::kinds::add::<Watch>();
//! let text = "Scenario(name: \"watch\", time_limit: 9.0, swarm: (robots: 4, deploy: Cluster(radius: 0.5)), protocol: Watch,
//!     detector: Timeout(0.5), faults: [Crash(robots: [2], at: 5.0)])";
//! let scenario = desim::scenario::parse("watch.ron", text, &[])?;
//! let record = desim::experiment::run_trial(&scenario, 0, Default::default(), &Default::default())?;
//! let suspected: Vec<u32> = record.detection.suspicions.iter().map(|suspicion| suspicion.subject.0).collect();
//! assert_eq!(suspected, [2, 2, 2]); // by each of the others
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Detectors that send messages are refused there. A protocol that has them has [`Probe`]s among its messages, and says so by
//! [`Monitored::probe`] and [`Protocol::PROBE`](super::Protocol::PROBE); `examples/leader` does.

mod config;
mod expectation;
mod nfd_s;
mod phi;
mod sign;
mod swim;
mod timeout;
mod watch;

pub use config::{Circumstances, DetectorConfig};
pub use expectation::{Link, Quality, nfd_s_quality};
pub use nfd_s::NfdSConfig;
pub use phi::{DialectConfig, DialectSetting, PhiAccrualConfig};
pub use sign::{Carried, Monitored, Sign, TIMER};
pub use swim::{Call, Claim, News, Probe, SwimConfig};

use std::borrow::Borrow;

use rand_philox::Philox;

use super::control::Phases;
use super::{Input, Output, Reception, Wake};
use crate::engine::{ActorId, SimTime};
use nfd_s::NfdS;
use phi::Phi;
use swim::Swim;
use timeout::Timeout;
use watch::Watch;

/// One robot's failure detector: it notes whom the robot watches, suspects (at the exact instant) and trusts.
#[derive(Debug)]
pub enum Detector {
    /// Suspects nobody.
    None,
    /// Suspects after a fixed silence.
    Timeout(Watch<Timeout>),
    /// Suspects a fixed time after the first status missing should have been sent.
    NfdS(Watch<NfdS>),
    /// Suspects when the silence is improbable.
    PhiAccrual(Watch<Phi>),
    /// Probes.
    Swim(Box<Swim>),
}

impl Detector {
    /// The detector of robot `id`, which has heard nobody yet and begins what it repeats at the robot's phase.
    #[must_use]
    pub fn new(config: &DetectorConfig, circumstances: Circumstances, phases: Phases, id: ActorId) -> Self {
        let silence = config.usual_silence(circumstances);
        match config {
            DetectorConfig::None => Self::None,
            DetectorConfig::Timeout(_) => Self::Timeout(Watch::new(Timeout(silence))),
            DetectorConfig::NfdS(_) => Self::NfdS(Watch::new(NfdS { silence })),
            DetectorConfig::PhiAccrual(config) => Self::PhiAccrual(Watch::new(Phi::new(config))),
            DetectorConfig::Swim(config) => Self::Swim(Box::new(Swim::new(config, circumstances, phases, id))),
        }
    }

    /// Asks for the memory that reading an inbox takes.
    #[inline]
    pub fn prefetch(&self) {
        match self {
            Self::Timeout(watch) => watch.prefetch(),
            Self::NfdS(watch) => watch.prefetch(),
            Self::PhiAccrual(watch) => watch.prefetch(),
            Self::None | Self::Swim(_) => {}
        }
    }

    /// All that it asks of a wake of its robot: reads the inbox, and minds its timer if that ran out. To be called at each
    /// wake, before the robot asks it whom it [suspects](Self::suspects).
    #[inline]
    pub fn step<H, M>(&mut self, now: SimTime, input: &mut Input<H>, output: &mut Output<M>)
    where
        H: Borrow<M>,
        M: Monitored,
    {
        self.read(now, &input.inbox, output);
        if input.wake == Wake::Timer(TIMER) {
            self.expire(now, &mut input.random, output);
        }
    }

    /// Takes in what has arrived by `now`, in order of arrival, and answers what asks for an answer.
    #[inline]
    pub fn read<H, M>(&mut self, now: SimTime, inbox: &[Reception<H>], output: &mut Output<M>)
    where
        H: Borrow<M>,
        M: Monitored,
    {
        match self {
            Self::None => {}
            Self::Timeout(watch) => watch.read(inbox, output),
            Self::NfdS(watch) => watch.read(inbox, output),
            Self::PhiAccrual(watch) => watch.read(inbox, output),
            Self::Swim(swim) => swim.read(now, inbox, output),
        }
    }

    /// Its timer fired, and the robot has read all that arrived: suspects those whose time has run out. Draws from `random`,
    /// which is of this wake alone.
    pub fn expire<M: Monitored>(&mut self, now: SimTime, random: &mut Philox, output: &mut Output<M>) {
        match self {
            Self::None => {}
            Self::Timeout(watch) => watch.expire(now, output),
            Self::NfdS(watch) => watch.expire(now, output),
            Self::PhiAccrual(watch) => watch.expire(now, output),
            Self::Swim(swim) => swim.expire(now, random, output),
        }
    }

    /// Whether it believes that `robot` is down. Of a robot that it never heard it believes nothing.
    #[must_use]
    pub fn suspects(&self, robot: ActorId) -> bool {
        self.suspected_since(robot) < SimTime::NEVER
    }

    /// Whether it came to believe so before `now`: what falls due at the very instant of a control step counts from the
    /// next one on, so that a status of exactly that age is not yet too old.
    #[must_use]
    pub fn suspected_before(&self, now: SimTime, robot: ActorId) -> bool {
        self.suspected_since(robot) < now
    }

    fn suspected_since(&self, robot: ActorId) -> SimTime {
        match self {
            Self::None => SimTime::NEVER,
            Self::Timeout(watch) => watch.suspected_since(robot),
            Self::NfdS(watch) => watch.suspected_since(robot),
            Self::PhiAccrual(watch) => watch.suspected_since(robot),
            Self::Swim(swim) => swim.suspected_since(robot),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{Span, Streams};
    use crate::protocol::control::PhaseConfig;
    use crate::protocol::{Address, Evidence, Frame, Note};
    use crate::quantity::Positive;

    const TIMEOUT_S: f64 = 2.5;
    const CIRCUMSTANCES: Circumstances = Circumstances {
        robots: 5,
        status_interval: Span::from_nanos(100_000_000),
    };

    /// A message that is a status.
    #[derive(Debug)]
    struct Alive;

    impl Monitored for Alive {
        fn sign(&self) -> Sign<'_> {
            Sign::Status
        }
    }

    fn at(seconds: f64) -> SimTime {
        SimTime::from_secs(seconds)
    }

    fn detector() -> Detector {
        Detector::new(
            &DetectorConfig::Timeout(Positive::new(TIMEOUT_S)),
            CIRCUMSTANCES,
            Phases::new(PhaseConfig::Random, Streams::new(1, 0)),
            ActorId(0),
        )
    }

    fn status(sender: u32, sequence: u32, arrival_s: f64) -> [Reception<Alive>; 1] {
        [Reception {
            at: at(arrival_s),
            frame: Frame {
                sender: ActorId(sender),
                sequence,
                sent_at: SimTime::ZERO,
                payload_bytes: 4,
                rides: false,
                address: Address::Everyone,
                message: Alive,
            },
            displacement: [0.0; 2],
        }]
    }

    /// What the detector answers to `act`: its notes, and when it wants to be woken.
    fn answer(
        detector: &mut Detector,
        act: impl FnOnce(&mut Detector, &mut Output<Alive>),
    ) -> (Vec<Note>, Option<SimTime>) {
        let mut output = Output::default();
        act(detector, &mut output);
        (output.notes, output.timers.last().and_then(|timer| timer.1))
    }

    fn suspicion(robot: u32, heard_s: f64, sequence: u32) -> Note {
        Note::Suspects {
            robot: ActorId(robot),
            heard: at(heard_s),
            sequence,
            evidence: Evidence::Silence,
        }
    }

    #[test]
    fn a_robot_is_watched_from_its_first_status_and_suspected_exactly_a_timeout_after_its_last() {
        let mut detector = detector();
        let first = answer(&mut detector, |d, out| d.read(at(9.0), &status(3, 0, 1.0), out));
        assert_eq!(first, (vec![Note::Watches(ActorId(3))], Some(at(3.5))));
        let second = answer(&mut detector, |d, out| d.read(at(9.0), &status(3, 1, 1.75), out));
        assert_eq!(second, (vec![], None), "a later arrival does not move the timer");
        assert_eq!(
            answer(&mut detector, |d, out| d.expire(
                at(3.5),
                &mut Philox::from_u64_seed(1),
                out
            )),
            (vec![], Some(at(4.25)))
        );
        assert!(!detector.suspects(ActorId(3)));
        let expired = answer(&mut detector, |d, out| {
            d.expire(at(4.25), &mut Philox::from_u64_seed(1), out);
        });
        assert_eq!(expired, (vec![suspicion(3, 1.75, 1)], None));
        assert!(detector.suspects(ActorId(3)) && !detector.suspects(ActorId(4)));
        assert!(!detector.suspected_before(at(4.25), ActorId(3)) && detector.suspected_before(at(4.26), ActorId(3)));
    }

    #[test]
    fn a_suspected_robot_is_trusted_at_its_next_status_and_watched_anew() {
        let mut detector = detector();
        answer(&mut detector, |d, out| d.read(at(9.0), &status(3, 0, 1.0), out));
        answer(&mut detector, |d, out| {
            d.expire(at(3.5), &mut Philox::from_u64_seed(1), out);
        });
        let again = answer(&mut detector, |d, out| d.read(at(9.0), &status(3, 7, 5.0), out));
        assert_eq!(again, (vec![Note::Trusts(ActorId(3))], Some(at(7.5))));
        assert!(!detector.suspects(ActorId(3)));
    }

    #[test]
    fn a_status_overtaken_on_the_way_is_a_sign_of_life_and_not_the_newest() {
        let mut detector = detector();
        for (sequence, arrival) in [(0, 1.0), (2, 1.2), (1, 1.3)] {
            answer(&mut detector, |d, out| {
                d.read(at(9.0), &status(3, sequence, arrival), out);
            });
        }
        answer(&mut detector, |d, out| {
            d.expire(at(3.5), &mut Philox::from_u64_seed(1), out);
        });
        let expired = answer(&mut detector, |d, out| {
            d.expire(at(3.8), &mut Philox::from_u64_seed(1), out);
        });
        assert_eq!(expired, (vec![suspicion(3, 1.3, 2)], None));
    }
}
