//! Detectors run by a protocol that others bring: scored and explained as those of a kind that desim ships.

use std::rc::Rc;

use desim::engine::{ActorId, SimTime};
use desim::experiment::trace_trial;
use desim::kind::{Kind, Sections, Shared, Swarm};
use desim::kinds;
use desim::metrics::TrialRecord;
use desim::predict::Preflight;
use desim::protocol::detector::{Detector, Monitored, Probe, Sign};
use desim::protocol::gossip::OwnTurns;
use desim::protocol::{Input, Output, Protocol, Serialised, Topic, Wake};
use desim::report::Explanation;
use desim::scenario::{Scenario, parse};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use tokio_util::sync::CancellationToken;

#[derive(Debug, Serialize, Deserialize)]
enum Message {
    Status([u8; 3]),
    Probe(Probe),
}

impl Monitored for Message {
    fn sign(&self) -> Sign<'_> {
        match self {
            Self::Status(_) => Sign::Status,
            Self::Probe(probe) => Sign::Probe(probe),
        }
    }

    fn probe(probe: Probe) -> Self {
        Self::Probe(probe)
    }
}

/// Robots that say a status of four bytes at their turns. Whether they have a topic for what a detector says is `PROBES`.
struct Watcher<const PROBES: bool> {
    detector: Detector,
    turns: OwnTurns,
}

impl<const PROBES: bool> Watcher<PROBES> {
    fn all(swarm: &Swarm<'_>) -> Vec<Self> {
        swarm.each(|id| Self {
            detector: swarm.detector(id),
            turns: swarm.status_turns(id),
        })
    }
}

impl<const PROBES: bool> Protocol for Watcher<PROBES> {
    type Message = Message;
    type Heard = Rc<Message>;
    type Codec = Serialised<Message>;
    const TOPICS: &'static [&'static str] = &["status", "probe"];
    const ROLES: &'static [&'static str] = &["robot"];
    const STATUS: Option<Topic> = Some(Topic(0));
    const PROBE: Option<Topic> = if PROBES { Some(Topic(1)) } else { None };

    fn topic(message: &Message) -> Topic {
        Topic(u8::from(matches!(message, Message::Probe(_))))
    }

    fn step(&mut self, now: SimTime, input: &mut Input<Rc<Message>>, output: &mut Output<Message>) {
        self.detector.step(now, input, output);
        if input.wake == Wake::ControlStep && self.turns.is_due() {
            output.broadcast(Message::Status([0; 3]));
        }
    }
}

/// Robots that run any detector.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
struct Watch;

impl Kind for Watch {
    const NAME: &'static str = "Watch";
    type Robot = Watcher<true>;

    fn robots(&self, swarm: &Swarm<'_>) -> Vec<Watcher<true>> {
        Watcher::all(swarm)
    }

    fn heeds(&self, _: &Sections<'_>) -> &'static [Shared] {
        &[Shared::Status, Shared::Detector]
    }

    fn moves(&self, _: &Sections<'_>) -> bool {
        false
    }
}

/// Robots that run detectors which listen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
struct Listen;

impl Kind for Listen {
    const NAME: &'static str = "Listen";
    type Robot = Watcher<false>;

    fn robots(&self, swarm: &Swarm<'_>) -> Vec<Watcher<false>> {
        Watcher::all(swarm)
    }

    fn heeds(&self, _: &Sections<'_>) -> &'static [Shared] {
        &[Shared::Status, Shared::Detector]
    }
}

fn scenario(protocol: &str, detector: &str) -> Result<Scenario, String> {
    kinds::add::<Watch>();
    kinds::add::<Listen>();
    let text = format!(
        "Scenario(name: \"watch\", time_limit: 60.0, swarm: (robots: 8, deploy: Cluster(radius: 0.7)), protocol: {protocol},
            gossip: (status: (interval: 0.5, jitter: 0.5)), detector: {detector},
            radio: (loss: Bernoulli(0.3), latency: Constant(0.01)),
            faults: [Crash(robots: [1], at: 20.0, lasts: For(15.0)), Deaf(robots: [2], at: 30.0, lasts: For(10.0))])"
    );
    parse("watch.ron", &text, &[]).map_err(|report| report.to_string())
}

fn traced(protocol: &str, detector: &str) -> (TrialRecord, Explanation) {
    let scenario = scenario(protocol, detector).unwrap_or_else(|report| panic!("{report}"));
    let record = trace_trial(&scenario, 0, ActorId(1), &CancellationToken::new()).expect("it reaches its end");
    let explanation = Explanation::of("watch", &record).expect("the robot was traced");
    (record, explanation)
}

/// The statuses of both go out at the same control steps, and the same copies are lost.
#[test]
fn a_foreign_protocol_suspects_as_the_heartbeat_does_and_is_explained_alike() {
    for detector in [
        "Timeout(1.2)",
        "NfdS(shift: 1.0)",
        "PhiAccrual(dialect: Akka)",
        "Swim()",
    ] {
        let (own, own_words) = traced("Watch", detector);
        let (shipped, shipped_words) = traced("Heartbeat", detector);
        assert_eq!(own.detection, shipped.detection, "{detector}");
        assert_eq!(own_words, shipped_words, "{detector}");
        assert!(
            own_words.suspicions.len() >= 7,
            "{detector}: each of the others suspects robot 1"
        );
    }
}

#[test]
fn closed_forms_expect_of_it_what_they_expect_of_the_heartbeat_but_for_bytes_that_it_does_not_tell() {
    let expected = |protocol: &str| {
        kinds::add::<Watch>();
        let text = format!(
            "Scenario(name: \"watch\", time_limit: 60.0, swarm: (robots: 8, deploy: Cluster(radius: 0.7)), protocol: {protocol},
                gossip: (status: (interval: 0.5)), detector: Timeout(1.2), radio: (loss: Bernoulli(0.3), latency: Constant(0.01)))"
        );
        Preflight::of(&parse("watch.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}")))
    };
    let (own, shipped) = (expected("Watch"), expected("Heartbeat"));
    for name in ["mistake_recurrence_s", "mistake_duration_s", "query_accuracy"] {
        assert!(own.get(name).is_some(), "{name} is predicted");
        assert_eq!(own.get(name), shipped.get(name));
    }
    assert!(own.get("status_tx_bytes_per_step").is_none());
    let untold = own
        .not_predicted
        .iter()
        .find(|entry| entry.name == "status_tx_bytes_per_step");
    assert_eq!(
        untold.map(|entry| &entry.why[..]),
        Some("the protocol does not say how long its statuses are")
    );
}

#[test]
fn a_detector_that_sends_is_refused_where_messages_cannot_carry_what_it_says() {
    assert!(scenario("Listen", "Timeout(1.2)").is_ok());
    let refused = scenario("Listen", "Swim()").unwrap_err();
    let refused: Vec<&str> = refused.split_whitespace().filter(|word| *word != "│").collect();
    let refused = refused.join(" ");
    for words in [
        "this detector sends messages, and those of the protocol Listen cannot carry what it says",
        "use one that listens",
    ] {
        assert!(refused.contains(words), "{refused}");
    }
}
