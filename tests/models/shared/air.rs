//! The figures of radios, in whole runs against closed forms, and their books against each other.

use desim::metrics::{AirRecord, Copies, RobotAir, TrialRecord};
use desim::radio::LossCause;
use desim::scenario::Scenario;

use super::{EQUAL_LOSS, EVERYBODY, Measured, fates, measured, runs, scenario, with_robots};

const IEEE802154: &str = "technology: Ieee802154()";
/// 1.184 ms for 20 bytes.
const AIRTIME_S: f64 = 1.184e-3;
/// Two robots 3 m apart.
const PAIR: &str = "arena: (size: (9.0, 9.0)), swarm: (robots: 2, deploy: At([(0.0, 0.0), (3.0, 0.0)])),";

fn everybody(seconds: f64, traffic: &str, radio: &str, robots: u32) -> Scenario {
    let radio = format!("{IEEE802154}, {radio}, {EQUAL_LOSS}");
    with_robots(scenario(seconds, traffic, EVERYBODY, &radio), robots)
}

fn pair(seconds: f64, traffic: &str, radio: &str) -> Scenario {
    scenario(seconds, traffic, PAIR, &format!("{IEEE802154}, {radio}"))
}

/// A figure of the catalogue, of each trial.
fn figure(scenario: &Scenario, records: &[TrialRecord], key: &str) -> Measured {
    let registry = scenario.figures();
    let place = registry
        .figures()
        .position(|figure| figure.key == key)
        .expect("a known figure");
    measured(records, |record| {
        let [value, weight] = registry.read(record)[place].part;
        assert!(weight > 0.0, "a trial has no {key}");
        value / weight
    })
}

fn air(record: &TrialRecord) -> &AirRecord {
    record.air.as_ref().expect("a shared radio keeps accounts")
}

fn sum(record: &TrialRecord, count: impl Fn(&RobotAir) -> u64) -> u64 {
    air(record).robots.iter().map(count).sum()
}

/// Each of n robots sends for λT of the time, whatever the others do; all of them hear each other, so the channel is free while none does: (1 − λT)ⁿ of the time.
#[test]
fn the_channel_is_full_of_what_is_sent() {
    for (robots, rate) in [(5_u32, 20.0), (20, 10.0), (20, 60.0)] {
        let traffic = format!("when: Poisson({rate:?}), payload: 20");
        let scenario = everybody(20.0, &traffic, "access: Aloha(), capture: inf, queue: 1000", robots);
        let records = runs(&scenario, 8);
        let load = rate * AIRTIME_S;
        let what = format!("{robots} robots at {rate} /s");
        figure(&scenario, &records, "radio.airtime_share").agrees(&format!("{what}: airtime"), load, 0.0, 0.0);
        let busy = 1.0 - (1.0 - load).powi(robots.cast_signed());
        figure(&scenario, &records, "radio.busy_share").agrees(&format!("{what}: busy"), busy, 0.0, 0.0);
        figure(&scenario, &records, "radio.attempts").agrees(&what, 1.0, 0.0, 0.0);
        figure(&scenario, &records, "radio.power_dBm").agrees(&format!("{what}: power"), -50.0, 0.0, 1e-3);
    }
}

/// 802.15.4, unslotted, alone: a backoff of 0 to 7 times 320 µs, 128 µs of assessment, 192 µs of turnaround.
#[test]
fn a_lone_robot_waits_for_its_backoff() {
    let traffic = "when: Periodic(0.05), payload: 20, senders: Given([0]), to: Next";
    let scenario = pair(60.0, traffic, "transmit_power: 0.0");
    let records = runs(&scenario, 8);
    figure(&scenario, &records, "radio.access_delay_s.mean").agrees("mean", 1440e-6, 0.0, 0.0);
    figure(&scenario, &records, "radio.access_delay_s.p95").agrees("95 %", 2560e-6, 0.0, 2560e-6 / 256.0);
    figure(&scenario, &records, "radio.queue_wait_s.mean").agrees("queue", 0.0, 0.0, 0.0);
    figure(&scenario, &records, "radio.attempts").agrees("attempts", 1.0, 0.0, 0.0);
    figure(&scenario, &records, "radio.unacknowledged").agrees("unacknowledged", 0.0, 0.0, 0.0);
    figure(&scenario, &records, "radio.dropped").agrees("dropped", 0.0, 0.0, 0.0);
    for record in &records {
        // Of 1440 µs with a spread of 733 µs no wait is anything but 320 + k · 320 µs.
        let waits = air(record).robots[0].access_delay.expect("it sent");
        assert_eq!((waits.min.as_nanos(), waits.max.as_nanos()), (320_000, 2_560_000));
        assert_eq!(
            air(record).robots[1].access_delay,
            None,
            "who sends no frame waits for none"
        );
        // It answers, which is sending too: 352 µs for each frame.
        let answers = air(record).robots[0].acknowledged;
        assert_eq!(air(record).robots[1].sent.as_nanos(), 352_000 * answers);
    }
}

/// M/D/1: a frame waits ρT/2(1 − ρ) for those before it, and nothing for the channel.
#[test]
fn frames_wait_for_each_other_as_in_m_d_1() {
    for load in [0.3, 0.7] {
        let traffic = format!(
            "when: Poisson({:?}), payload: 20, senders: Given([0])",
            load / AIRTIME_S
        );
        let scenario = pair(40.0, &traffic, "access: Aloha(), queue: 1000, transmit_power: 0.0");
        let records = runs(&scenario, 40);
        let expected = load * AIRTIME_S / (2.0 * (1.0 - load));
        figure(&scenario, &records, "radio.queue_wait_s.mean").agrees(&format!("ρ = {load}"), expected, 0.0, 0.0);
        figure(&scenario, &records, "radio.access_delay_s.mean").agrees("no access", 0.0, 0.0, 0.0);
    }
}

/// A radio that holds one frame is M/D/1/1: what comes while it sends is lost, ρ/(1 + ρ) of all, whatever the law of the service time (Erlang's B).
#[test]
fn what_finds_no_room_never_goes_on_air() {
    for load in [0.25, 1.0] {
        let traffic = format!(
            "when: Poisson({:?}), payload: 20, senders: Given([0])",
            load / AIRTIME_S
        );
        let scenario = pair(20.0, &traffic, "access: Aloha(), queue: 1, transmit_power: 0.0");
        let records = runs(&scenario, 10);
        figure(&scenario, &records, "radio.dropped").agrees(&format!("ρ = {load}"), load / (1.0 + load), 0.0, 0.0);
        for record in &records {
            let full = LossCause::QueueFull as usize;
            assert_eq!(
                sum(record, RobotAir::never_sent),
                sum(record, |robot| robot.dropped[full])
            );
        }
    }
}

/// A robot that is too far away answers nothing: each frame is sent four times.
#[test]
fn what_nobody_answers_is_sent_as_often_as_may_be() {
    let far = "arena: (size: (9000.0, 9.0)), swarm: (robots: 2, deploy: At([(0.0, 0.0), (4000.0, 0.0)])),";
    let traffic = "when: Periodic(0.1), payload: 20, senders: Given([0]), to: Next";
    let scenario = scenario(20.0, traffic, far, &format!("{IEEE802154}, transmit_power: 0.0"));
    let records = runs(&scenario, 2);
    figure(&scenario, &records, "radio.unacknowledged").agrees("unacknowledged", 1.0, 0.0, 0.0);
    figure(&scenario, &records, "radio.attempts").agrees("attempts", 4.0, 0.0, 0.0);
    figure(&scenario, &records, "radio.dropped").agrees("dropped", 0.0, 0.0, 0.0);
    let registry = scenario.figures();
    let power = registry
        .figures()
        .position(|figure| figure.key == "radio.power_dBm")
        .unwrap();
    assert_eq!(
        registry.read(&records[0])[power].value(),
        None,
        "of what nobody understood there is no power"
    );
}

/// Slots of one's own: λ messages of 20 bytes a second reach the other robots, all of them.
#[test]
fn goodput_is_what_arrives() {
    let (robots, rate) = (10_u32, 8.0);
    let traffic = format!("when: Poisson({rate:?}), payload: 20");
    let scenario = everybody(
        30.0,
        &traffic,
        "access: Tdma(slot: 0.002, guard: 0.0), queue: 1000",
        robots,
    );
    let records = runs(&scenario, 8);
    let expected = rate * 160.0 * f64::from(robots * (robots - 1));
    figure(&scenario, &records, "goodput_bps").agrees("goodput", expected, 0.0, 0.0);
}

/// By the formula of path loss: 40 dB at 1 m and 30 dB for each factor of ten.
#[test]
fn power_falls_with_distance_on_the_link_and_in_the_band_where_it_was_measured() {
    let traffic = "when: Periodic(0.1), payload: 20, senders: Given([0])";
    let loss = "path_loss: LogDistance(exponent: 3.0, reference_loss: 40.0), transmit_power: 0.0";
    let mut scenario = pair(10.0, traffic, loss);
    scenario.metrics.links = true;
    for record in runs(&scenario, 2) {
        let air = air(&record);
        let ([band], [link]) = (&air.bands[..], &air.links[..]) else {
            panic!("one band and one link: {air:?}");
        };
        assert!((band.from_m..band.to_m).contains(&3.0));
        assert!((band.to_m / band.from_m - 2.0_f64.powf(0.25)).abs() < 1e-12);
        assert_eq!((link.sender.0, link.receiver.0), (0, 1));
        assert!((link.distance_m - 3.0).abs() < 1e-6);
        assert_eq!(band.copies, link.copies);
        let power = -40.0 - 30.0 * 3.0_f64.log10();
        for found in [link.copies.power_dbm, link.copies.delivered_power_dbm] {
            assert!((found.unwrap() - power).abs() < 1e-4, "{found:?} instead of {power}");
        }
        assert_eq!(link.copies.offered, sum(&record, |robot| robot.frames));
    }
}

/// A copy is counted once at its receiver, once in a band, once on a link, and as delivered where it was.
#[test]
fn the_books_agree_with_each_other_and_with_the_ledger() {
    let place = "arena: (size: (60.0, 60.0)), swarm: (robots: 12, deploy: Uniform),";
    let radio = format!("{IEEE802154}, queue: 4, fading: Rayleigh(), shadowing: (sigma: 6.0)");
    let mut scenario = scenario(10.0, "when: Poisson(60.0), payload: 60", place, &radio);
    scenario.metrics.links = true;
    let add = |sum: (u64, u64, u64), copies: &Copies| {
        (sum.0 + copies.offered, sum.1 + copies.delivered, sum.2 + copies.reached)
    };
    for record in runs(&scenario, 3) {
        let air = air(&record);
        let at_robots = air.robots.iter().map(|robot| &robot.heard).fold((0, 0, 0), add);
        let in_bands = air.bands.iter().map(|band| &band.copies).fold((0, 0, 0), add);
        let on_links = air.links.iter().map(|link| &link.copies).fold((0, 0, 0), add);
        assert_eq!((at_robots, at_robots), (in_bands, on_links));
        let fates = fates(&record);
        assert_eq!(at_robots.1, fates.delivered);
        let full = fates.lost[LossCause::QueueFull as usize];
        assert!(full > 0 && fates.lost[LossCause::Collision as usize] > 0, "{fates}");
        assert_eq!(at_robots.0, fates.offered - full - fates.in_flight);
        assert_eq!(air.queue_wait.count(), sum(&record, |robot| robot.on_air));
        assert_eq!(air.access_delay.count(), sum(&record, |robot| robot.on_air));
        for robot in &air.robots {
            assert!(robot.sent <= robot.busy, "{robot:?}");
            assert_eq!(robot.frames, robot.on_air + robot.dropped.iter().sum::<u64>());
            assert_eq!(robot.attempts, robot.on_air, "broadcasts are sent once");
        }
    }
}

/// Over the disk radio nothing is told of radios: nothing is recorded, and there is no figure of it.
#[test]
fn a_disk_radio_has_none_of_it() {
    let text = "Scenario(name: \"disk\", time_limit: 5.0, swarm: (robots: 4, deploy: Cluster(radius: 0.5)), protocol: Traffic())";
    let scenario = desim::scenario::parse("disk.ron", text, &[]).unwrap();
    let record = &runs(&scenario, 1)[0];
    assert_eq!(record.air, None);
    assert!(!serde_json::to_string(record).unwrap().contains("\"air\""));
    let registry = scenario.figures();
    assert!(
        registry
            .figures()
            .all(|figure| !figure.key.starts_with("radio.") && figure.key != "goodput_bps")
    );
    let summary = desim::metrics::Summary::by(&registry, "disk", scenario.topics(), &["robot"], &runs(&scenario, 2));
    let summary = serde_json::to_value(summary).unwrap();
    assert!(summary.get("radio").is_none() && summary.get("goodput_bps").is_none());
}

/// A frame is lost on whoever could not hear all of it: also where it hears again before the frame ends. Frames follow each other without a pause, so that
/// each time of 0.3 ms lies in one frame of 1.184 ms, or, one time in four, in two.
#[test]
fn a_receiver_that_was_deaf_for_a_part_of_a_frame_has_not_got_it() {
    let deaf: Vec<String> = (1..=20)
        .map(|time| {
            format!(
                "Deaf(robots: [1], at: {:?}, lasts: For(0.0003))",
                f64::from(time) * 0.041_7
            )
        })
        .collect();
    let place = format!("{PAIR} faults: [{}],", deaf.join(", "));
    let traffic = "when: Saturated, payload: 20, senders: Given([0])";
    let scenario = scenario(1.0, traffic, &place, &format!("{IEEE802154}, access: None"));
    for record in runs(&scenario, 2) {
        let fates = fates(&record);
        let missed = fates.lost[LossCause::ReceiverDown as usize];
        assert!((20..=32).contains(&missed), "{missed}");
        assert!(
            fates.delivered > 600 && fates.delivered + fates.in_flight + missed == fates.offered,
            "{fates:?}"
        );
    }
}
