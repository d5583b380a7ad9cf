use super::*;
use crate::engine::{SimTime, Span};
use crate::radio::{FrameId, LossCause};

fn at(millis: u64) -> SimTime {
    SimTime::ZERO + Span::from_nanos(millis * 1_000_000)
}

fn millis(millis: u64) -> Span {
    Span::from_nanos(millis * 1_000_000)
}

fn concluded(outcome: Outcome, times: [u64; 2], began: Option<u64>, attempts: u32) -> Conclusion {
    Conclusion {
        frame: FrameId::new(ActorId(1), 0),
        outcome,
        handed_over: at(times[0]),
        at_head: at(times[1]),
        began: began.map(at),
        attempts,
    }
}

fn reading(receiver: u32, distance: f32, power: f32, received: bool) -> Reading {
    Reading {
        receiver: ActorId(receiver),
        distance,
        power,
        received,
    }
}

#[test]
fn frames_are_counted_by_how_they_ended_and_wait_only_if_they_went_on_air() {
    let mut air = Air::new(2, false);
    air.concluded(&concluded(Outcome::Acknowledged, [0, 3], Some(5), 2));
    air.concluded(&concluded(Outcome::Unacknowledged, [10, 10], Some(14), 4));
    air.concluded(&concluded(
        Outcome::Dropped(LossCause::AccessFailure),
        [20, 29],
        None,
        0,
    ));
    air.concluded(&concluded(
        Outcome::Dropped(LossCause::SenderDown),
        [30, 31],
        Some(33),
        1,
    ));
    let record = air.into_record();
    let robot = &record.robots[1];
    assert_eq!(
        (robot.frames, robot.on_air, robot.attempts, robot.never_sent()),
        (4, 3, 7, 1)
    );
    assert_eq!((robot.acknowledged, robot.unacknowledged), (1, 1));
    let dropped = |cause: LossCause| robot.dropped[cause as usize];
    assert_eq!(
        (
            dropped(LossCause::AccessFailure),
            dropped(LossCause::SenderDown),
            robot.dropped.iter().sum::<u64>()
        ),
        (1, 1, 2)
    );
    let waits = |sum, min, max| {
        Some(Waits {
            sum: millis(sum),
            min: millis(min),
            max: millis(max),
        })
    };
    assert_eq!(robot.queue_wait, waits(4, 0, 3), "3, 0 and 1");
    assert_eq!(robot.access_delay, waits(8, 2, 4), "2, 4 and 2");
    assert_eq!(
        (record.queue_wait.count(), record.queue_wait.max()),
        (3, Some(millis(3)))
    );
    assert_eq!(
        (record.access_delay.min(), record.access_delay.max()),
        (Some(millis(2)), Some(millis(4)))
    );
    assert_eq!(record.robots[0], RobotAir::default());
}

#[test]
fn copies_are_counted_at_their_receiver_by_distance_and_by_link() {
    let mut air = Air::new(3, true);
    for (sender, reading) in [
        (0, reading(1, 1.0, -60.0, true)),
        (0, reading(1, 1.1, -76.0, false)),
        (0, reading(1, 3.0, f32::NEG_INFINITY, false)),
        (2, reading(1, 1.0, -80.0, true)),
    ] {
        air.measured(ActorId(sender), &reading);
    }
    let record = air.into_record();
    let all = Copies {
        offered: 4,
        delivered: 2,
        reached: 3,
        power_dbm: Some(-72.0),
        delivered_power_dbm: Some(-70.0),
    };
    assert_eq!(record.robots[1].heard, all);
    assert_eq!(record.robots[0].heard, Copies::default());
    let bands: Vec<_> = record
        .bands
        .iter()
        .map(|band| (band.from_m, band.copies.offered, band.copies.delivered))
        .collect();
    assert_eq!(bands, [(1.0, 3, 2), (2.0 * 2.0_f64.sqrt(), 1, 0)]);
    assert_eq!(record.bands[1].copies.power_dbm, None, "nothing of it arrived");
    let links: Vec<_> = record
        .links
        .iter()
        .map(|link| {
            (
                link.sender.0,
                link.receiver.0,
                link.copies.offered,
                link.copies.power_dbm,
            )
        })
        .collect();
    assert_eq!(links, [(0, 1, 3, Some(-68.0)), (2, 1, 1, Some(-80.0))]);
    let mean = (1.0 + f64::from(1.1_f32) + 3.0) / 3.0;
    assert!((record.links[0].distance_m - mean).abs() < 1e-12);
}

#[test]
fn a_book_is_read_back_from_its_text_and_names_no_links_where_none_are_asked_for() {
    let mut air = Air::new(2, false);
    air.measured(ActorId(0), &reading(1, 0.3, f32::NEG_INFINITY, true));
    air.accounted(
        ActorId(1),
        &Account {
            sent: millis(7),
            busy: millis(9),
            energy: [0.1, 0.2, 0.3, 0.4],
            empty_at: Some(at(12)),
        },
    );
    let record = air.into_record();
    assert_eq!(record.robots[1].sent, millis(7));
    let text = serde_json::to_string(&record).unwrap();
    assert!(!text.contains("links"));
    assert_eq!(serde_json::from_str::<AirRecord>(&text).unwrap(), record);
}
