//! Pairs of which one may be in range of the other and not the other way round.

use super::*;
use crate::geometry::{Pose, Vec2};
use crate::motion::{ArenaConfig, MotionConfig};
use crate::radio::Walled;

/// Over links, where robots 0 and 1 stand at these places for 30 s and watch each other from 1 s on.
fn standing(places: [(f64, f64); 2]) -> DetectionRecord {
    let pose = |(x, y)| Pose {
        position: Vec2::new(x, y),
        heading: 0.0,
    };
    let poses = places.map(pose).to_vec();
    let mut world = World::new(&MotionConfig::default(), &ArenaConfig::default(), poses, 2.0);
    let watching = Watching {
        memory: Span::from_secs(1000.0),
        patience: Span::from_secs(PATIENCE_S),
        reach: Walled::reach(2.0),
    };
    let mut bench = Bench(Scorer::new(2, watching, &Scratch::default()));
    bench.0.begin(&world);
    bench.0.sent(at(1.0), SUBJECT, 0, None);
    bench.believe(1.0, &Note::Watches(SUBJECT), &[status(0)]);
    bench.0.sent(at(1.0), OBSERVER, 0, None);
    let mut heard = [status(0)];
    heard[0].frame.sender = OBSERVER;
    let inbox = Inbox {
        read: &heard,
        waiting: &[],
    };
    bench.0.belief(at(1.0), SUBJECT, &Note::Watches(OBSERVER), &inbox);
    while world.now() < at(20.0) {
        world.advance();
        bench.0.tick(&world);
    }
    bench.suspect(20.0, 0);
    bench.outcomes().0
}

#[test]
fn whom_a_wall_parts_and_whom_the_other_does_not_hear_is_watched_and_not_monitored() {
    // Heard from 2 m away, 1 only from 1 m: observer 0 hears subject 1 in the first case alone.
    for (places, monitored, mistaken, cause) in [
        ([(0.5, 0.0), (1.4, 0.0)], 58.0, 10.0, Cause::NotSent),
        ([(0.5, 0.0), (2.4, 0.0)], 29.0, 0.0, Cause::OutOfRange),
        ([(-0.5, 0.0), (0.4, 0.0)], 0.0, 0.0, Cause::OutOfRange),
    ] {
        let record = standing(places);
        assert_time(&record, monitored, mistaken);
        assert_eq!(first(&record).cause, cause);
    }
}
