//! Robots that are handed messages by hand, and whom they address.

use super::*;
use crate::geometry::Pose;
use crate::protocol::control::PhaseConfig;
use crate::protocol::gossip::{RelayConfig, RetransmitConfig};
use crate::protocol::{Address, Frame, MessageSize};

const PERIOD: Span = Span::from_nanos(100_000_000);

fn robots(mode: Mode, relay: RelayConfig) -> Vec<Rumor> {
    let config = RumorConfig {
        mode,
        sources: SourcesConfig::Robots(vec![0, 0, 3]),
        ..RumorConfig::default()
    };
    let gossip = GossipConfig {
        relay,
        ..GossipConfig::default()
    };
    let control = ControlConfig {
        phase: PhaseConfig::Together,
        ..ControlConfig::default()
    };
    swarm(&config, &gossip, &control, 20, Ground::still(), Streams::new(1, 0))
}

fn rumor(to: Option<u32>, rumor: u8) -> Message {
    let to = to.map(ActorId);
    Message::Rumor { to, rumor, size: 32 }
}

/// What `robot` answers at its control step number `step` to `heard`.
fn step(robot: &mut Rumor, step: u64, heard: &[(u32, Message)]) -> Output<Message> {
    let now = SimTime::ZERO + PERIOD * step;
    let receive = |&(sender, message): &(u32, Message)| Reception {
        at: now,
        frame: Frame {
            sender: ActorId(sender),
            sequence: 0,
            sent_at: now,
            payload_bytes: 36,
            rides: false,
            address: Address::Everyone,
            message,
        },
        displacement: [0.0; 2],
    };
    let mut input = Input {
        powers: Vec::new(),
        outcomes: Vec::new(),
        me: ActorId(0),
        wake: Wake::ControlStep,
        inbox: heard.iter().map(receive).collect(),
        pose: Pose::default(),
        proximity: Vec::new(),
        random: Streams::new(1, 0).keyed(PEERS).at(0, 0, 0),
    };
    let mut output = Output::default();
    robot.step(now, &mut input, &mut output);
    output
}

fn informed(rumor: u16, at: u64, from: Option<u32>) -> Note {
    Note::Informed {
        rumor,
        at: SimTime::ZERO + PERIOD * at,
        from: from.map(ActorId),
    }
}

#[test]
fn a_source_knows_its_rumours_from_its_first_step_and_pushes_them_every_round() {
    let mut source = robots(Mode::Push, RelayConfig::default()).remove(0);
    let first = step(&mut source, 0, &[]);
    assert_eq!(first.notes, [informed(0, 0, None), informed(1, 0, None)]);
    assert_eq!(first.broadcasts, [rumor(None, 0), rumor(None, 1)]);
    let sent: Vec<usize> = (1..21).map(|n| step(&mut source, n, &[]).broadcasts.len()).collect();
    assert_eq!(sent.iter().sum::<usize>(), 4, "a round every ten control steps");
}

#[test]
fn a_rumour_is_learnt_once_heard_again_it_is_a_duplicate_and_all_make_a_robot_informed() {
    let mut robot = robots(Mode::Push, RelayConfig::default()).remove(5);
    let heard = [(0, rumor(None, 0)), (1, rumor(Some(5), 0)), (1, rumor(Some(6), 2))];
    let duplicate = Note::Duplicate {
        topic: Topic(0),
        size: MessageSize::alone(36),
    };
    assert_eq!(step(&mut robot, 0, &heard).notes, [informed(0, 0, Some(0)), duplicate]);
    let rest = step(&mut robot, 1, &[(0, rumor(None, 1)), (3, rumor(None, 2))]);
    assert_eq!(
        rest.notes,
        [informed(1, 1, Some(0)), informed(2, 1, Some(3)), Note::Role(Role(1))]
    );
}

#[test]
fn who_is_asked_answers_the_asker_with_what_it_lacks_and_who_overhears_does_not() {
    let mut robots = robots(Mode::Pull, RelayConfig::default());
    let first = step(&mut robots[0], 0, &[]);
    assert_eq!(first.broadcasts, [Message::Request { to: None, known: 0b011 }]);
    let request = Message::Request {
        to: Some(ActorId(0)),
        known: 0b101,
    };
    assert_eq!(step(&mut robots[0], 1, &[(4, request)]).broadcasts, [rumor(Some(4), 1)]);
    assert_eq!(
        step(&mut robots[3], 1, &[(4, request)]).broadcasts.len(),
        1,
        "its own request"
    );
}

/// memberlist's retransmits for 20 robots: 4 ⌈log₁₀ 21⌉ = 8.
#[test]
fn a_robot_stops_pushing_after_the_multiplied_logarithm_of_the_swarms_size() {
    let relay = RelayConfig {
        retransmit: RetransmitConfig::Multiplier(4),
        fan_out: FanOutConfig::Peers(3),
        ..RelayConfig::default()
    };
    let mut source = robots(Mode::Push, relay).remove(3);
    let rounds = (0..200).map(|n| step(&mut source, n, &[]).broadcasts.len());
    let rounds: Vec<usize> = rounds.filter(|sent| *sent > 0).collect();
    assert_eq!(rounds, [3, 3, 2]);
}

/// Each of 19 others is among 3 with probability 3/19: over 4,000 rounds 632 times, σ 23. Five σ.
#[test]
fn every_other_robot_is_as_likely_to_be_addressed_none_twice_in_a_round_and_never_itself() {
    let relay = RelayConfig {
        fan_out: FanOutConfig::Peers(3),
        ..RelayConfig::default()
    };
    let robots = robots(Mode::Push, relay);
    let mut counts = [0_u32; 20];
    for round in 0..4000 {
        let mut peers = robots[7].settings.addressees(ActorId(7), round);
        peers.sort_unstable();
        peers.dedup();
        assert_eq!(peers.len(), 3);
        peers.into_iter().flatten().for_each(|peer| counts[peer.index()] += 1);
    }
    assert_eq!(counts[7], 0);
    let even = |count: &u32| (f64::from(*count) - 631.6).abs() < 5.0 * 23.1;
    assert!(counts.iter().filter(|count| even(count)).count() == 19, "{counts:?}");
}

/// A mean of 1 s over 4,000 rounds, σ 1/√4,000 = 0.0158; a share e⁻¹ longer than 1 s, σ 0.0076. Four σ.
#[test]
fn poisson_rounds_are_exponentially_apart() {
    let robots = robots(Mode::Push, RelayConfig::default());
    let settings = &robots[0].settings;
    let pauses: Vec<f64> = (0..4000)
        .map(|round| settings.pause(ActorId(0), round).as_secs())
        .collect();
    let mean = pauses.iter().sum::<f64>() / 4000.0;
    assert!((mean - 1.0).abs() < 0.063, "{mean}");
    let long = pauses.iter().filter(|pause| **pause > 1.0).count() as f64 / 4000.0;
    assert!((long - (-1.0_f64).exp()).abs() < 0.031, "{long}");
}
