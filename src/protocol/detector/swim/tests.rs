//! One robot's side of SWIM, handed frames one by one.

use super::*;
use crate::engine::Streams;
use crate::protocol::control::PhaseConfig;
use crate::protocol::{Address, Frame, Note};
use crate::quantity::{NonNegative, Positive};

const ME: ActorId = ActorId(0);
const ONE: ActorId = ActorId(1);
const TWO: ActorId = ActorId(2);

#[derive(Debug)]
enum Said {
    Status,
    Probe(Probe),
}

impl Monitored for Said {
    fn sign(&self) -> Sign<'_> {
        match self {
            Self::Status => Sign::Status,
            Self::Probe(probe) => Sign::Probe(probe),
        }
    }

    fn probe(probe: Probe) -> Self {
        Self::Probe(probe)
    }
}

/// Robot 0 and what it has said and noted.
struct Bench {
    swim: Swim,
    sequence: u32,
    said: Vec<Probe>,
    notes: Vec<Note>,
    timer: SimTime,
}

fn at(seconds: f64) -> SimTime {
    SimTime::from_secs(seconds)
}

fn news(about: ActorId, claim: Claim, incarnation: u32) -> News {
    News {
        about,
        claim,
        incarnation,
    }
}

impl Bench {
    /// Robot 0, whose phase is 0 as that of all, has heard robots 1 and 2 at time 0: it pings for the first time then.
    fn new(config: &SwimConfig) -> Self {
        let circumstances = Circumstances {
            robots: 10,
            status_interval: Span::from_secs(1.0),
        };
        let mut bench = Self {
            swim: Swim::new(
                config,
                circumstances,
                Phases::new(PhaseConfig::Together, Streams::new(1, 0)),
                ME,
            ),
            sequence: 0,
            said: Vec::new(),
            notes: Vec::new(),
            timer: SimTime::NEVER,
        };
        bench.hear(0.0, ONE, Said::Status);
        bench.hear(0.0, TWO, Said::Status);
        assert_eq!(bench.notes, [Note::Watches(ONE), Note::Watches(TWO)]);
        bench
    }

    fn act(&mut self, act: impl FnOnce(&mut Swim, &mut Output<Said>)) {
        let mut output = Output::default();
        act(&mut self.swim, &mut output);
        self.said
            .extend(output.broadcasts.into_iter().filter_map(|said| match said {
                Said::Status => None,
                Said::Probe(probe) => Some(probe),
            }));
        self.notes.extend(output.notes);
        if let Some((_, due)) = output.timers.last() {
            self.timer = due.unwrap_or(SimTime::NEVER);
        }
    }

    fn hear(&mut self, seconds: f64, sender: ActorId, message: Said) {
        self.sequence += 1;
        let reception = Reception {
            at: at(seconds),
            frame: Frame {
                sender,
                sequence: self.sequence,
                sent_at: at(seconds),
                payload_bytes: 4,
                rides: false,
                address: Address::Everyone,
                message,
            },
            displacement: [0.0; 2],
        };
        self.act(|swim, output| swim.read(at(seconds), &[reception], output));
    }

    fn hear_probe(&mut self, seconds: f64, sender: ActorId, call: Call, number: u16, news: &[News]) {
        let news = news.to_vec();
        self.hear(seconds, sender, Said::Probe(Probe { call, number, news }));
    }

    /// Lets every timer up to `seconds` fire.
    fn wait(&mut self, seconds: f64) {
        while self.timer <= at(seconds) {
            let now = self.timer;
            self.timer = SimTime::NEVER;
            self.act(|swim, output| swim.expire(now, &mut Philox::from_u64_seed(7), output));
        }
    }

    /// Whom it pinged last, and with which number.
    fn pinged(&self) -> (ActorId, u16) {
        let mut pings = self.said.iter().rev().filter_map(|probe| match probe.call {
            Call::Ping { to } => Some((to, probe.number)),
            _ => None,
        });
        pings.next().expect("it pinged somebody")
    }

    /// The robot pinged last acknowledges.
    fn acknowledge(&mut self, seconds: f64) {
        let (robot, number) = self.pinged();
        self.hear_probe(seconds, robot, Call::Ack { to: ME }, number, &[]);
    }

    fn suspicions(&self) -> Vec<ActorId> {
        let suspected = self.notes.iter().filter_map(|note| match note {
            Note::Suspects { robot, .. } => Some(*robot),
            _ => None,
        });
        suspected.collect()
    }
}

#[test]
fn a_ping_is_acknowledged_by_whom_it_names_and_nobody_else() {
    let mut bench = Bench::new(&SwimConfig::default());
    bench.hear_probe(0.1, ONE, Call::Ping { to: TWO }, 7, &[]);
    assert!(bench.said.is_empty());
    bench.hear_probe(0.2, ONE, Call::Ping { to: ME }, 8, &[]);
    assert_eq!((&bench.said[0].call, bench.said[0].number), (&Call::Ack { to: ONE }, 8));
}

#[test]
fn whoever_is_asked_pings_in_anothers_stead_and_passes_the_acknowledgement_on() {
    let mut bench = Bench::new(&SwimConfig::default());
    let request = Call::Request {
        to: vec![ME],
        target: TWO,
    };
    bench.hear_probe(0.1, ONE, request, 77, &[]);
    let (target, number) = bench.pinged();
    assert_eq!(target, TWO);
    bench.hear_probe(0.2, TWO, Call::Ack { to: ME }, number, &[]);
    let last = bench.said.last().unwrap();
    assert_eq!((&last.call, last.number), (&Call::Ack { to: ONE }, 77));
}

#[test]
fn a_robot_that_is_silent_is_probed_through_others_suspected_and_then_taken_for_down() {
    let mut bench = Bench::new(&SwimConfig::default());
    bench.wait(0.4);
    let (silent, number) = bench.pinged();
    let other = if silent == ONE { TWO } else { ONE };
    bench.wait(0.5);
    let request = bench.said.last().unwrap();
    assert_eq!(
        (&request.call, request.number),
        (
            &Call::Request {
                to: vec![other],
                target: silent
            },
            number
        )
    );
    bench.wait(1.0);
    assert_eq!(bench.suspicions(), [], "it may still deny it");
    // The other one acknowledges all that it is asked. The suspicion lasts 4 s, log₁₀ of 10 robots being 1.
    for period in 1..6 {
        bench.wait(f64::from(period) + 0.01);
        if bench.pinged().0 == other {
            bench.acknowledge(f64::from(period) + 0.02);
        }
    }
    bench.wait(6.1);
    assert_eq!(bench.suspicions(), [silent]);
    assert_eq!(bench.swim.suspected_since(silent), at(5.0));
    let told: Vec<_> = bench.said.iter().flat_map(|probe| &probe.news).collect();
    assert!(told.contains(&&news(silent, Claim::Suspected, 0)) && told.contains(&&news(silent, Claim::Down, 0)));
}

#[test]
fn a_suspicion_ends_when_it_is_denied_with_a_higher_incarnation() {
    let mut bench = Bench::new(&SwimConfig::default());
    bench.hear_probe(0.1, ONE, Call::Ack { to: TWO }, 1, &[news(TWO, Claim::Suspected, 3)]);
    bench.hear_probe(0.2, TWO, Call::Ack { to: ONE }, 1, &[news(TWO, Claim::Alive, 3)]);
    assert!(
        matches!(bench.swim.members.get(TWO).unwrap().belief, Belief::Suspected(_)),
        "3 is no denial"
    );
    bench.hear_probe(0.3, ONE, Call::Ack { to: TWO }, 2, &[news(TWO, Claim::Alive, 4)]);
    assert_eq!(bench.swim.members.get(TWO).unwrap().belief, Belief::Alive);
    bench.hear_probe(0.4, ONE, Call::Ack { to: TWO }, 3, &[news(TWO, Claim::Suspected, 3)]);
    assert_eq!(
        bench.swim.members.get(TWO).unwrap().belief,
        Belief::Alive,
        "an old claim"
    );
}

#[test]
fn a_robot_denies_what_is_claimed_of_it_and_doubts_itself() {
    let mut bench = Bench::new(&SwimConfig::default());
    bench.hear_probe(0.1, ONE, Call::Ping { to: ME }, 1, &[news(ME, Claim::Suspected, 5)]);
    assert_eq!(bench.said[0].news, [news(ME, Claim::Alive, 6)]);
    assert_eq!(bench.swim.awareness, 1);
    bench.hear_probe(0.2, ONE, Call::Ping { to: ME }, 2, &[news(ME, Claim::Suspected, 5)]);
    assert_eq!(bench.swim.incarnation, 6, "once is enough");
}

#[test]
fn awareness_stretches_the_interval_up_to_its_bound_and_relaxes_when_probes_succeed() {
    let config = SwimConfig {
        max_awareness: 3,
        suspicion_mult: NonNegative::new(1000.0),
        leave_timeout: Positive::new(1000.0),
        ..SwimConfig::default()
    };
    let mut bench = Bench::new(&config);
    // Nobody answers: periods of 1, 2, 3 and again 3 s.
    let begins = [0.0, 1.0, 3.0, 6.0, 9.0];
    let mut pings = Vec::new();
    for step in 0..100 {
        let seconds = f64::from(step) / 10.0;
        let before = bench
            .said
            .iter()
            .filter(|probe| matches!(probe.call, Call::Ping { .. }))
            .count();
        bench.wait(seconds);
        let after = bench
            .said
            .iter()
            .filter(|probe| matches!(probe.call, Call::Ping { .. }))
            .count();
        pings.extend((before < after).then_some(seconds));
    }
    assert_eq!(pings, begins);
    bench.acknowledge(9.95);
    assert_eq!(bench.swim.awareness, 1);
}

#[test]
fn a_robot_that_is_down_is_back_with_its_next_frame_and_older_claims_are_void() {
    let mut bench = Bench::new(&SwimConfig::default());
    bench.hear_probe(0.1, ONE, Call::Ack { to: TWO }, 1, &[news(TWO, Claim::Down, 0)]);
    assert_eq!(bench.suspicions(), [TWO]);
    bench.hear(0.2, TWO, Said::Status);
    assert_eq!(bench.notes.last(), Some(&Note::Trusts(TWO)));
    bench.hear_probe(0.3, ONE, Call::Ack { to: TWO }, 2, &[news(TWO, Claim::Down, 0)]);
    assert_eq!(bench.swim.suspected_since(TWO), SimTime::NEVER);
}

#[test]
fn who_is_out_of_range_is_down_to_this_robot_and_nobody_is_told() {
    let config = SwimConfig {
        suspicion_mult: NonNegative::new(1000.0),
        leave_timeout: Positive::new(3.0),
        ..SwimConfig::default()
    };
    let mut bench = Bench::new(&config);
    bench.hear(1.5, ONE, Said::Status);
    bench.wait(3.0);
    assert_eq!(bench.suspicions(), [TWO]);
    assert_eq!(bench.swim.suspected_since(TWO), at(3.0));
    bench.wait(4.4);
    assert_eq!(bench.suspicions(), [TWO]);
    bench.wait(4.5);
    assert_eq!(bench.suspicions(), [TWO, ONE]);
    let told = bench.said.iter().flat_map(|probe| &probe.news);
    assert!(told.into_iter().all(|news| news.claim != Claim::Down));
}

#[test]
fn of_robots_that_it_never_heard_it_believes_nothing() {
    let mut bench = Bench::new(&SwimConfig::default());
    bench.hear_probe(0.1, ONE, Call::Ack { to: TWO }, 1, &[news(ActorId(9), Claim::Down, 0)]);
    assert_eq!((bench.suspicions(), bench.notes.len()), (vec![], 2));
    assert_eq!(bench.swim.suspected_since(ActorId(9)), SimTime::NEVER);
}
