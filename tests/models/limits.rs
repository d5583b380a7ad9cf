//! Limits that include their rim do so for decimals that a person writes, whatever these are in binary.

use bytes::{Buf as _, BufMut as _, BytesMut};
use desim::engine::{ActorId, SimTime, Span, Streams};
use desim::experiment::run_trial;
use desim::faults::RegionConfig;
use desim::geometry::{Pose, Vec2, is_left_of};
use desim::metrics::{Graph, Mission, MissionTarget, Outcome, Ties, TrialRecord};
use desim::motion::{ArenaConfig, DeployConfig, MotionConfig, World, deploy};
use desim::predict::Preflight;
use desim::protocol::{CodecError, Input, Note, Output, Protocol, Role};
use desim::quantity::{Finite, Positive};
use desim::scenario::parse;
use desim::simulation::{DriverKind, Setup};
use proptest::prelude::*;
use tokio_util::codec::{Decoder, Encoder};
use tokio_util::sync::CancellationToken;

/// `thousandths` of a metre as a person writes them.
fn decimal(thousandths: i64) -> f64 {
    format!("{thousandths}e-3").parse().expect("a number")
}

fn place(x: i64, y: i64) -> Vec2 {
    Vec2::new(decimal(x), decimal(y))
}

fn finite(x: i64, y: i64) -> (Finite, Finite) {
    (Finite::new(decimal(x)), Finite::new(decimal(y)))
}

/// Ten by ten robots whose first is at (x, y) and whose spacing is `spacing`, thousandths of a metre.
fn lattice(spacing: i64, x: i64, y: i64) -> Vec<Vec2> {
    (0..100)
        .map(|robot| place(x + spacing * (robot % 10), y + spacing * (robot / 10)))
        .collect()
}

fn run(text: &str) -> TrialRecord {
    let scenario = parse("limits.ron", text, &[]).unwrap_or_else(|report| panic!("{report}"));
    run_trial(&scenario, 0, DriverKind::Inline, &CancellationToken::new()).expect("the trial reaches its end")
}

#[test]
fn a_lattice_whose_spacing_is_the_range_has_all_its_links_on_air_in_the_graph_and_in_the_forecast() {
    for spacing in [300, 700, 1100, 250, 333, 1234, 1999] {
        let places: Vec<String> = lattice(spacing, -1100, -1900)
            .iter()
            .map(|place| format!("({:?}, {:?})", place.x, place.y))
            .collect();
        let range = decimal(spacing);
        let text = format!(
            "Scenario(name: \"lattice\", time_limit: 0.25, arena: (size: (40.0, 40.0)), protocol: Heartbeat,
             control: (phase: Together), swarm: (robots: 100, deploy: At([{}])),
             radio: (range: {range:?}, latency: Constant(0.01)), metrics: (sample_interval: 0.1))",
            places.join(", ")
        );
        let record = run(&text);
        assert_eq!(record.ledger[0].offered, 3 * 360, "{range} m");
        // λ₂ of a grid graph of 10 × 10: 2 − 2 cos(π/10).
        let lambda2 = 2.0 - 2.0 * (std::f64::consts::PI / 10.0).cos();
        for sample in &record.connectivity {
            assert!((sample.lambda2 - lambda2).abs() < 1e-6, "{range} m: {}", sample.lambda2);
        }
        let scenario = parse("limits.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"));
        let degree = Preflight::of(&scenario).get("degree").map(|degree| degree.value);
        assert!(
            degree.is_some_and(|degree| (degree - 3.6).abs() < 1e-9),
            "{range} m: {degree:?}"
        );
    }
}

proptest! {
    #[test]
    fn robots_as_far_apart_as_the_range_hear_each_other_and_the_graph_says_so(
        spacing in 20_i64..9000, x in -40_000_i64..40_000, y in -40_000_i64..40_000,
    ) {
        let (range, places) = (decimal(spacing), lattice(spacing, x, y));
        prop_assert_eq!(Graph::within_range(&places, range).edges().len(), 180);
        let motion = MotionConfig { body_radius: Positive::new(0.001), ..MotionConfig::default() };
        let poses = places.iter().map(|&position| Pose { position, heading: 0.0 }).collect();
        let arena = ArenaConfig { size: (Positive::new(400.0), Positive::new(400.0)), ..ArenaConfig::default() };
        let world = World::new(&motion, &arena, poses, range);
        let mut heard = Vec::new();
        for robot in 0..100 {
            world.for_each_within(ActorId(robot), SimTime::ZERO, range, |other, _| heard.push((robot, other.0)));
        }
        prop_assert_eq!(heard.len(), 360);
        let is_mutual = |&(a, b): &(u32, u32)| heard.contains(&(b, a));
        prop_assert!(heard.iter().all(is_mutual));
        // What is beyond by a share of one in a hundred thousand is beyond.
        prop_assert_eq!(Graph::within_range(&places, range * (1.0 - 1e-5)).edges().len(), 0);
    }

    #[test]
    fn the_rim_of_a_region_belongs_to_it(
        x in -9000_i64..9000, y in -9000_i64..9000, unit in 1_i64..2000, half in (1_i64..3000, 1_i64..3000),
    ) {
        // Three, four and five are a right triangle.
        let disc = RegionConfig::Disc { at: finite(x, y), radius: Positive::new(decimal(5 * unit)) };
        for (dx, dy) in [(5, 0), (-5, 0), (0, 5), (0, -5), (3, 4), (-3, 4), (4, -3), (-4, -3)] {
            prop_assert!(disc.contains(place(x + dx * unit, y + dy * unit)), "{dx}, {dy}");
            let beyond = place(x, y) + Vec2::new(dx as f64, dy as f64) * (decimal(unit) * (1.0 + 1e-5));
            prop_assert!(!disc.contains(beyond));
        }
        let size = (Positive::new(decimal(2 * half.0)), Positive::new(decimal(2 * half.1)));
        let rectangle = RegionConfig::Rectangle { at: finite(x, y), size };
        for (dx, dy) in [(1, 1), (1, -1), (-1, 1), (-1, -1)] {
            prop_assert!(rectangle.contains(place(x + dx * half.0, y + dy * half.1)));
        }
        let beyond = Vec2::new(decimal(half.0) * (1.0 + 1e-5), 0.0);
        prop_assert!(!rectangle.contains(place(x, y) + beyond));
    }

    #[test]
    fn a_place_on_a_line_is_on_its_left_whatever_the_line(
        x in -900_i64..900, y in -900_i64..900, dx in -900_i64..900, dy in -900_i64..900, steps in -50_i64..50,
    ) {
        prop_assume!((dx, dy) != (0, 0));
        let (point, along) = (place(x, y), place(x + dx, y + dy) - place(x, y));
        prop_assert!(is_left_of(place(x + steps * dx, y + steps * dy), point, along));
        let off = Vec2::new(along.y, -along.x) * 1e-5;
        prop_assert!(!is_left_of(place(x + dx, y + dy) + off, point, along), "a little to the right");
    }

    #[test]
    fn robots_that_touch_each_other_and_the_walls_can_be_deployed(
        radius in 1_i64..500, columns in 1_i64..9, rows in 1_i64..9,
    ) {
        // The first centre is a radius from the corner, wherever that is: arenas are centred.
        let at = |index: i64, number: i64| radius * (2 * index + 1 - number);
        let places = (0..columns * rows).map(|robot| finite(at(robot % columns, columns), at(robot / columns, rows)));
        let size = (decimal(2 * radius * columns), decimal(2 * radius * rows));
        let arena = ArenaConfig { size: (Positive::new(size.0), Positive::new(size.1)), ..ArenaConfig::default() };
        let config = DeployConfig::At(places.collect());
        let robots = (columns * rows) as u32;
        prop_assert_eq!(config.problems(robots, &arena, decimal(radius)), vec![]);
        prop_assert!(deploy(&config, &arena, robots, decimal(radius), &Streams::new(1, 0)).is_ok());
    }
}

/// Robots of a line of 3:1 through (0.2, 0.1) are all on its left, and one beside it is on the other side: whoever hears another is
/// heard by it.
#[test]
fn a_partition_is_the_same_wall_from_both_sides() {
    let places = [(500, 200), (1100, 400), (1400, 500), (1700, 600), (1100, 300)];
    let at: Vec<String> = places
        .iter()
        .map(|&(x, y)| format!("({:?}, {:?})", decimal(x), decimal(y)))
        .collect();
    let record = run(&format!(
        "Scenario(name: \"wall\", time_limit: 0.55, protocol: Heartbeat, motion: (body_radius: 0.01),
         control: (phase: Together), swarm: (robots: 5, deploy: At([{}])), radio: (latency: Constant(0.01)),
         faults: [Partition(line: ((0.2, 0.1), (0.5, 0.2)))])",
        at.join(", ")
    ));
    let received = |robot: usize| -> u64 {
        let rows = record.traffic.iter().filter(|row| row.robot.index() == robot);
        rows.map(|row| row.received.frames).sum()
    };
    // Six statuses of each of the other three on the line.
    assert_eq!([0, 1, 2, 3, 4].map(received), [18, 18, 18, 18, 0]);
}

/// Says nothing but what it is: the root, or a worker linked to it.
struct Player(u32);

impl Protocol for Player {
    type Message = u8;
    type Heard = u8;
    type Codec = Byte;
    const TOPICS: &'static [&'static str] = &["byte"];
    const ROLES: &'static [&'static str] = &["root", "worker"];

    fn step(&mut self, _: SimTime, _: &mut Input<u8>, output: &mut Output<u8>) {
        if std::mem::replace(&mut self.0, 0) == 1 {
            output.notes.push(Note::Role(Role(1)));
            output.notes.push(Note::Target(Some(0)));
            output.notes.push(Note::Parents(vec![ActorId(0)]));
        }
    }
}

#[derive(Default)]
struct Byte;

impl Encoder<u8> for Byte {
    type Error = CodecError;
    fn encode(&mut self, message: u8, bytes: &mut BytesMut) -> Result<(), CodecError> {
        bytes.put_u8(message);
        Ok(())
    }
}

impl Decoder for Byte {
    type Item = u8;
    type Error = CodecError;
    fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<u8>, CodecError> {
        Ok((!bytes.is_empty()).then(|| bytes.get_u8()))
    }
}

/// A root, a worker that is as far from it as a link may be, and a target that is as far from the worker as it may be held from.
#[test]
fn a_target_at_the_very_threshold_is_held_over_a_link_of_the_very_critical_distance() {
    for (link, reach) in [(700, 300), (1100, 600), (333, 777)] {
        for beyond in [0.0, 1e-5] {
            let x = [100, 100 + link, 100 + link + reach].map(decimal);
            let mut setup = Setup::lasting(Span::from_secs(20.0));
            setup.radio.range = Positive::new(decimal(link));
            setup.mission = Some(Mission {
                targets: vec![MissionTarget {
                    position: Vec2::new(x[2], 0.0),
                    links: 1,
                }],
                reach: decimal(reach) * (1.0 - beyond),
                ties: Ties::Parents { within: decimal(link) },
                root: ActorId(0),
                root_role: None,
                worker_role: Role(1),
            });
            let pose = |x| Pose {
                position: Vec2::new(x, 0.0),
                heading: 0.0,
            };
            let robots = vec![Player(0), Player(1)];
            let record = setup
                .run(
                    vec![pose(x[0]), pose(x[1])],
                    robots,
                    DriverKind::Inline,
                    &CancellationToken::new(),
                )
                .expect("the run reaches its end");
            let completed = matches!(record.outcome, Outcome::Completed { .. });
            assert_eq!(completed, beyond == 0.0, "link {link} mm, reach {reach} mm, {beyond}");
        }
    }
}
