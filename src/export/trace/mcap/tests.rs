use std::collections::BTreeSet;
use std::io::Cursor;

use foxglove::Decode;

use super::super::traced::{FAULTS, SHARED, run, scenario, traced};
use super::*;
use crate::engine::{ActorId, Span};
use crate::geometry::Vec2;
use crate::happenings::log::{Selection, What};
use crate::scenario::Scenario;

fn recorded(scenario: &Scenario, selection: Selection) -> Vec<u8> {
    let recording = Recording::begin(Cursor::new(Vec::new()), run(scenario)).unwrap();
    let (_, recording) = traced(scenario, selection, recording);
    recording.close().unwrap().into_inner()
}

/// Messages of a channel, with their times in nanoseconds.
fn messages<M: Decode>(file: &[u8], topic: &str) -> Vec<(u64, M)> {
    let read = ::mcap::MessageStream::new(file).unwrap().map(Result::unwrap);
    let told = read.filter(|message| message.channel.topic == topic);
    told.map(|message| (message.log_time, M::decode(&*message.data).ok().unwrap()))
        .collect()
}

#[test]
fn a_recording_written_twice_is_the_same_bytes() {
    let scenario = scenario(FAULTS, &[]);
    let every = Selection {
        places_every: Span::from_secs(0.5),
        ..Selection::default()
    };
    assert_eq!(recorded(&scenario, every.clone()), recorded(&scenario, every));
}

#[test]
fn a_recording_of_a_part_knows_what_came_before_it() {
    let scenario = scenario(FAULTS, &[]);
    let part = Selection {
        from: SimTime::from_secs(21.0),
        until: SimTime::from_secs(22.0),
        ..Selection::default()
    };
    let file = recorded(&scenario, part);
    let clouds = messages::<PointCloud>(&file, "/robots");
    assert_eq!(clouds.len(), 10, "one a tick of 0.1 s");
    for (at, cloud) in &clouds {
        assert!((21_000_000_000..22_000_000_000).contains(at));
        let well: Vec<u8> = cloud.data.chunks(22).map(|point| point[21]).collect();
        assert_eq!(well[..5], [0, 0, 0, 1, 1], "those that crashed at 20 s are still down");
    }
    assert_eq!(messages::<SceneUpdate>(&file, "/scene").len(), 1);
    let words: BTreeSet<String> = messages::<Log>(&file, "/events")
        .into_iter()
        .map(|(_, log)| log.message)
        .collect();
    assert!(!words.iter().any(|words| words.starts_with("fails")), "{words:?}");
}

#[test]
fn every_field_of_a_point_lies_where_it_says() {
    let scenario = scenario(FAULTS, &["time_limit=1.0", "faults=[]"]);
    let file = recorded(&scenario, Selection::default());
    let clouds = messages::<PointCloud>(&file, "/robots");
    let (_, cloud) = &clouds[0];
    assert_eq!(cloud.data.len(), 20 * cloud.point_stride as usize);
    let place = |name: &str| {
        let field = cloud.fields.iter().find(|field| field.name == name).unwrap();
        7 * cloud.point_stride as usize + field.offset as usize
    };
    let number = |name: &str| u32::from_le_bytes(cloud.data[place(name)..][..4].try_into().unwrap());
    assert_eq!(number("robot"), 7);
    assert!(f32::from_bits(number("x")).abs() <= 3.0 && f32::from_bits(number("z")) == 0.0);
    assert_eq!([cloud.data[place("well")], cloud.data[place("alpha")]], [1, 255]);
}

/// What is drawn of links at each look, and where robots are then.
struct Links {
    run: Run,
    seen: Vec<(Vec<Vec2>, SceneUpdate)>,
}

impl Sink for Links {
    fn places(&mut self, world: &World) -> io::Result<()> {
        self.seen
            .push((world.positions().to_vec(), scene::links(&self.run, world)));
        Ok(())
    }
}

/// All pairs, each asked for: what no recording can afford.
fn linked(run: &Run, places: &[Vec2]) -> Vec<u32> {
    let placed = |robot: usize| (ActorId(robot as u32), places[robot]);
    let pairs = (0..places.len()).flat_map(|a| (a + 1..places.len()).map(move |b| (a, b)));
    let linked = pairs.filter(|&(a, b)| run.reach.linked(placed(a), placed(b)));
    linked.flat_map(|(a, b)| [a as u32, b as u32]).collect()
}

#[test]
fn lines_join_robots_that_are_linked_and_no_others() {
    let alone = ["time_limit=1.0", "faults=[]", "radio.range=0.01"];
    for (text, set, is_joined) in [
        (FAULTS, &["time_limit=5.0", "faults=[]"][..], true),
        (SHARED, &["time_limit=11.0"], true),
        (FAULTS, &alone, false),
    ] {
        let scenario = scenario(text, set);
        let links = Links {
            run: run(&scenario),
            seen: Vec::new(),
        };
        let every = Selection {
            places_every: Span::from_secs(1.0),
            ..Selection::default()
        };
        let (_, Links { run, seen }) = traced(&scenario, every, links);
        assert!(!seen.is_empty());
        for (places, update) in seen {
            let [entity] = &update.entities[..] else {
                panic!("one entity")
            };
            // Lines without indices would join all robots in their order.
            assert_eq!(entity.lines.len(), usize::from(is_joined));
            let drawn = entity.lines.first().map(|lines| lines.indices.clone());
            assert_eq!(drawn.unwrap_or_default(), linked(&run, &places));
            for lines in &entity.lines {
                assert_eq!(
                    lines.points,
                    places.iter().copied().map(message::point).collect::<Vec<_>>()
                );
            }
        }
    }
}

#[test]
fn faults_are_errors_and_suspicions_warnings() {
    let run = run(&scenario(FAULTS, &[]));
    let log = |robot: Option<u32>, what| {
        let event = Event {
            at: SimTime::from_nanos(1_500_000_000),
            robot: robot.map(ActorId),
            what,
        };
        words::log(&run, &event).map(|log| (log.level, log.name, log.message))
    };
    let told = |level, name: &str, words: &str| Some((level, name.to_owned(), words.to_owned()));
    assert_eq!(
        log(Some(3), What::Fails(crate::faults::Effect::Deaf)),
        told(4, "robot 3", "fails: deaf")
    );
    assert_eq!(log(None, What::LinksFail("burst")), told(4, "links", "fail: burst"));
    let heard = SimTime::from_nanos(1_250_000_000);
    assert_eq!(
        log(Some(0), What::Suspects(ActorId(2), heard)),
        told(3, "robot 0", "suspects robot 2, last heard at 1.25 s")
    );
    assert_eq!(
        log(Some(0), What::Trusts(ActorId(2))),
        told(2, "robot 0", "trusts robot 2 again")
    );
    assert_eq!(log(Some(0), What::Watches(ActorId(2))), None);
}
