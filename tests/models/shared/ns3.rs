//! ns-3.37 on the same topologies: means and 95 % half widths over its runs.
//!
//! With capture at infinity whatever overlaps is lost, which is the strict reading of ns-3's traces; with `capture: None` overlaps are noise and a receiver stays on the
//! first frame, as ns-3 itself decides.

use desim::metrics::{RobotAir, TrialRecord};
use desim::radio::LossCause;

use super::{EQUAL_LOSS, EVERYBODY, HIDDEN, Measured, delivery, lost_to, measured, runs, scenario, with_robots};

const IEEE802154: &str = "technology: Ieee802154()";
const WIFI: &str = "technology: Wifi(standard: B, rate: 1e6)";

/// From a half width of 95 % to a standard error, over 40 and over 20 runs, and over four.
const MANY: f64 = 1.0 / 2.02;
const TWENTY: f64 = 1.0 / 2.09;
const FOUR: f64 = 1.0 / 3.18;

fn broadcast(radio: &str, capture: &str, robots: u32, trials: u32) -> Vec<TrialRecord> {
    let radio = format!("{radio}, capture: {capture}, {EQUAL_LOSS}");
    let scenario = scenario(11.0, "when: Poisson(10.0), payload: 20", EVERYBODY, &radio);
    runs(&with_robots(scenario, robots), trials)
}

fn hidden(radio: &str, capture: &str, rate: f64) -> Vec<TrialRecord> {
    let radio = format!("{radio}, capture: {capture}, walls: Block, {EQUAL_LOSS}");
    let traffic = format!("when: Poisson({rate:?}), payload: 20, senders: Given([0, 2])");
    runs(&scenario(61.0, &traffic, HIDDEN, &radio), 12)
}

#[test]
fn broadcasts_over_802_15_4() {
    // Robots, strict, as ns-3 decides, access failures: each with its half width.
    for (robots, strict, as_is, failures, trials) in [
        (5, (0.983_315, 0.002_45), (0.989_339, 0.001_57), (0.000_05, 0.0001), 20),
        (10, (0.960_707, 0.002_92), (0.977_19, 0.001_75), (0.000_07, 0.0001), 20),
        (
            20,
            (0.905_754, 0.002_89),
            (0.946_491, 0.001_56),
            (0.001_37, 0.000_27),
            12,
        ),
        (
            50,
            (0.681_727, 0.002_75),
            (0.797_253, 0.001_89),
            (0.034_14, 0.001_08),
            6,
        ),
    ] {
        let records = broadcast(IEEE802154, "inf", robots, trials);
        let what = format!("{robots} robots, strict");
        measured(&records, delivery).agrees(&what, strict.0, strict.1 * MANY, 0.0);
        let failed = |record: &TrialRecord| lost_to(record, LossCause::AccessFailure);
        let what = format!("{robots} robots, access failures");
        measured(&records, failed).agrees(&what, failures.0, failures.1 * MANY, 0.000_05);
        let records = broadcast(IEEE802154, "None", robots, trials);
        let what = format!("{robots} robots, as is");
        measured(&records, delivery).agrees(&what, as_is.0, as_is.1 * MANY, 0.0);
    }
}

#[test]
fn a_hidden_pair_over_802_15_4() {
    for (rate, strict, as_is) in [
        (10.0, (0.977_037, 0.0026), (0.988_264, 0.001_46)),
        (20.0, (0.953_136, 0.002_42), (0.976_027, 0.001_22)),
        (50.0, (0.880_35, 0.002_21), (0.938_886, 0.001_13)),
        (100.0, (0.763_912, 0.001_87), (0.879_542, 0.000_965)),
    ] {
        let what = format!("{rate} /s, strict");
        measured(&hidden(IEEE802154, "inf", rate), delivery).agrees(&what, strict.0, strict.1 * TWENTY, 0.0);
        let what = format!("{rate} /s, as is");
        measured(&hidden(IEEE802154, "None", rate), delivery).agrees(&what, as_is.0, as_is.1 * TWENTY, 0.0);
    }
}

/// How often a frame was on air, those that never were among them.
fn attempts(record: &TrialRecord) -> f64 {
    let robots = &record.air.as_ref().expect("a shared radio").robots;
    let [attempts, frames] = [|robot: &RobotAir| robot.attempts, |robot: &RobotAir| robot.frames]
        .map(|count| robots.iter().map(count).sum::<u64>() as f64);
    attempts / frames
}

/// Frames round a ring, each acknowledged or sent again, as ns-3 decides. Of 50 robots it has 1.41 attempts a frame, and 1.49 are made here; as many arrive.
#[test]
fn acknowledged_frames_over_802_15_4() {
    for (robots, delivered, often, failures, trials) in [
        (5, (0.999_952, 9.46e-5), (1.018_98, 0.002_37), (0.0, 0.0), 20),
        (
            10,
            (0.999_627, 0.000_18),
            (1.054_02, 0.002_59),
            (0.000_299, 0.000_143),
            20,
        ),
        (
            20,
            (0.990_952, 0.000_816),
            (1.141_08, 0.003_96),
            (0.008_264, 0.000_776),
            12,
        ),
        (50, (0.683_336, 0.003_23), (1.4084, 0.005_86), (0.293_575, 0.003_27), 8),
    ] {
        let radio = format!("{IEEE802154}, capture: None, queue: 1000, {EQUAL_LOSS}");
        let scenario = scenario(21.0, "when: Poisson(10.0), payload: 20, to: Next", EVERYBODY, &radio);
        let records = runs(&with_robots(scenario, robots), trials);
        let what = format!("{robots} robots, delivered");
        measured(&records, delivery).agrees(&what, delivered.0, delivered.1 * MANY, 0.0001);
        let what = format!("{robots} robots, attempts");
        let slack = if robots == 50 { 0.065 * often.0 } else { 0.0 };
        measured(&records, attempts).agrees(&what, often.0, often.1 * MANY, slack);
        let failed = |record: &TrialRecord| lost_to(record, LossCause::AccessFailure);
        let what = format!("{robots} robots, access failures");
        measured(&records, failed).agrees(&what, failures.0, failures.1 * MANY, 0.0001);
    }
}

/// Two robots that do not hear each other, and the one between them that answers both.
#[test]
fn a_hidden_pair_that_is_answered_over_802_15_4() {
    for (rate, often) in [
        (10.0, (1.016_82, 0.001_66)),
        (20.0, (1.035_87, 0.001_66)),
        (50.0, (1.108_06, 0.002_18)),
    ] {
        let radio = format!("{IEEE802154}, capture: None, walls: Block, {EQUAL_LOSS}");
        let traffic = format!("when: Poisson({rate:?}), payload: 20, senders: Given([0, 2]), to: Robot(1)");
        let records = runs(&scenario(61.0, &traffic, HIDDEN, &radio), 12);
        let what = format!("{rate} /s, attempts");
        measured(&records, attempts).agrees(&what, often.0, often.1 * TWENTY, 0.0);
        measured(&records, delivery).agrees("delivered", 1.0, 0.0, 0.001);
    }
}

#[test]
fn broadcasts_over_wifi() {
    for (robots, strict, trials) in [
        (5, (0.999_587, 0.000_389), 20),
        (10, (0.999_052, 0.000_415), 20),
        (20, (0.997_021, 0.000_482), 12),
        (50, (0.988_441, 0.000_946), 6),
    ] {
        for capture in ["inf", "None"] {
            let what = format!("{robots} robots, capture {capture}");
            let records = broadcast(WIFI, capture, robots, trials);
            measured(&records, delivery).agrees(&what, strict.0, strict.1 * MANY, 0.0);
        }
    }
}

#[test]
fn a_hidden_pair_over_wifi() {
    for (rate, strict, as_is) in [
        (10.0, (0.987_453, 0.001_95), (0.993_684, 0.000_965)),
        (20.0, (0.974_818, 0.002_13), (0.987_231, 0.001_07)),
        (50.0, (0.936_077, 0.0019), (0.967_497, 0.001_02)),
        (100.0, (0.873_572, 0.001_46), (0.934_953, 0.000_799)),
    ] {
        let what = format!("{rate} /s, strict");
        measured(&hidden(WIFI, "inf", rate), delivery).agrees(&what, strict.0, strict.1 * TWENTY, 0.0);
        let what = format!("{rate} /s, as is");
        measured(&hidden(WIFI, "None", rate), delivery).agrees(&what, as_is.0, as_is.1 * TWENTY, 0.0);
    }
}

/// The same over Wi-Fi: who is not answered sends again, after a longer backoff, until the frame is through.
#[test]
fn a_hidden_pair_that_is_answered_over_wifi() {
    for (rate, often) in [
        (10.0, (1.006_86, 0.001_08)),
        (20.0, (1.013_92, 0.001_29)),
        (50.0, (1.037_12, 0.001_06)),
        (100.0, (1.084_15, 0.001_05)),
    ] {
        let radio = format!("{WIFI}, capture: None, walls: Block, {EQUAL_LOSS}");
        let traffic = format!("when: Poisson({rate:?}), payload: 20, senders: Given([0, 2]), to: Robot(1)");
        let records = runs(&scenario(61.0, &traffic, HIDDEN, &radio), 12);
        let what = format!("{rate} /s, attempts");
        measured(&records, attempts).agrees(&what, often.0, often.1 * TWENTY, 0.0);
        measured(&records, delivery).agrees("delivered", 1.0, 0.0, 0.0001);
    }
}

fn saturated(radio: &str, to: &str, payload: u16, robots: u32, seconds: f64) -> Vec<TrialRecord> {
    let radio = format!("{radio}, capture: inf, {EQUAL_LOSS}");
    let traffic = format!("when: Saturated, payload: {payload}, to: {to}");
    runs(&with_robots(scenario(seconds, &traffic, EVERYBODY, &radio), robots), 5)
}

#[test]
fn saturated_broadcasts_over_wifi() {
    for (robots, strict) in [
        (2, (0.938_931, 0.002_46)),
        (5, (0.786_438, 0.0126)),
        (10, (0.576_745, 0.008_83)),
        (20, (0.318_298, 0.005_86)),
    ] {
        let records = saturated(WIFI, "Everyone", 20, robots, 6.0);
        measured(&records, delivery).agrees(&format!("{robots} robots"), strict.0, strict.1 * FOUR, 0.0);
    }
}

/// Payload bits that arrive in a second, Mb/s.
fn goodput(record: &TrialRecord) -> f64 {
    let received: u64 = record.traffic.iter().map(|row| row.received.payload_bytes).sum();
    8e-6 * received as f64 / record.simulated.as_secs()
}

fn throughput(radio: &str, robots: u32, seconds: f64) -> Measured {
    measured(&saturated(radio, "Next", 1000, robots, seconds), goodput)
}

/// Of 20 and 50 robots at 11 Mb/s ns-3 has 5.25 and 4.79 Mb/s, 2 and 6 % more than here and than Bianchi's form, to which `forms.rs` holds these: of its frames 0.35 and
/// 0.47 collide, not the form's 0.40 and 0.55. At 1 Mb/s 50 robots have 0.618 Mb/s there, 0.604 here and 0.599 by the form.
///
/// ns-3 sends acknowledgements at the rate of the data, and 802.11g with slots of 20 µs and windows of 15 in an ad hoc network: so here.
#[test]
fn saturated_wifi_to_one_robot() {
    let fast = "technology: Wifi(standard: B, rate: 11e6, acknowledgement_rate: 11e6)";
    // Goodput in Mb/s and its standard error over runs.
    for (radio, robots, seconds, expected) in [
        (WIFI, 2, 20.0, (0.8587, 0.001_17)),
        (WIFI, 5, 40.0, (0.8133, 0.001_08)),
        (WIFI, 10, 60.0, (0.7634, 0.002_46)),
        (WIFI, 20, 100.0, (0.7066, 0.003_29)),
        (fast, 2, 5.0, (5.6262, 0.007_74)),
        (fast, 5, 10.0, (5.6776, 0.004_51)),
        (fast, 10, 20.0, (5.4746, 0.008_33)),
    ] {
        let what = format!("{robots} robots, {radio}");
        throughput(radio, robots, seconds).agrees(&what, expected.0, expected.1, 0.0);
    }
    let g6 = "technology: Wifi(standard: G, rate: 6e6), access: Dcf(slot: 20e-6, window: (15, 1023))";
    // 1.5 % less than there: as above.
    throughput(g6, 10, 20.0).agrees("802.11g", 4.092, 0.037 * FOUR, 0.02 * 4.092);
}
