//! Predictions for whole scenarios.

use proptest::prelude::*;

use desim::predict::{Holds, Preflight};
use desim::protocol::detector::Link;
use desim::scenario::{Scenario, parse};

fn scenario(text: &str) -> Scenario {
    let text = format!("Scenario(name: \"expected\", time_limit: 400.0, {text})");
    parse("expected.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn preflight(text: &str) -> Preflight {
    Preflight::of(&scenario(text))
}

#[track_caller]
fn assert_value(preflight: &Preflight, name: &str, expected: f64) {
    let found = preflight
        .get(name)
        .unwrap_or_else(|| panic!("{name} is not predicted"))
        .value;
    assert!(
        (found - expected).abs() <= 1e-9 * expected.abs(),
        "{name}: {found}, not {expected}"
    );
}

/// Three robots in a row, 1 m apart, hear their neighbours at most: 4/3 a robot.
const ROW: &str = "swarm: (robots: 3, deploy: At([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)])), protocol: Heartbeat,
    control: (period: 0.5, phase: Together), gossip: (status: (interval: 1.0)), detector: Timeout(3.5)";

#[test]
fn robots_that_stand_still_are_predicted_throughout_by_the_published_forms() {
    let expected = preflight(&format!(
        "{ROW}, radio: (range: 1.0, loss: Bernoulli(0.2), latency: Constant(0.05))"
    ));
    for (name, value) in [
        ("degree", 4.0 / 3.0),
        ("loss_ratio", 0.2),
        ("latency_s", 0.05),
        ("status_frames_per_step", 0.5),
        ("status_tx_bytes_per_step", 4.5),
        ("status_rx_bytes_per_step", 4.5 * 0.8 * 4.0 / 3.0),
        ("channel_load_bytes_per_s", 9.0 * 4.0 / 3.0),
        ("mistake_recurrence_s", 156.25),
        // 0.75 s, and from the arrival at 0.05 s to the reading at 0.5 s.
        ("mistake_duration_s", 0.75 + 0.45),
        ("query_accuracy", 1.0 - 1.2 / 156.25),
    ] {
        assert_value(&expected, name, value);
    }
    assert!(
        expected
            .predictions
            .iter()
            .all(|prediction| prediction.holds == Holds::Throughout)
    );
    let refused: Vec<_> = expected.not_predicted.iter().map(|refused| refused.name).collect();
    assert_eq!(refused, ["channel_utilisation"]);
}

/// What begins within a timeout of the end is no mistake yet, and a link is watched from its first arrival on. That takes half an interval and
/// 1/0.8 = 1.25 intervals, or 1 + 0.2 · 5 = 2 where one time in five is a burst of five.
#[test]
fn rates_are_off_by_the_share_of_the_run_in_which_no_mistake_can_begin() {
    for (loss, missing) in [
        ("Bernoulli(0.2)", 3.5 + 0.5 + 1.25),
        ("GilbertElliott(good_to_bad: 0.05, bad_to_good: 0.2)", 3.5 + 0.5 + 2.0),
    ] {
        let expected = preflight(&format!(
            "{ROW}, radio: (range: 1.0, loss: {loss}, latency: Constant(0.05))"
        ));
        for name in ["mistake_rate_hz", "mistake_recurrence_s"] {
            let found = expected.get(name).unwrap();
            assert!(
                (found.accuracy / found.value - missing / 400.0).abs() < 1e-9,
                "{loss}: {found:?}"
            );
        }
    }
}

#[test]
fn where_all_begin_together_a_failure_may_come_half_an_interval_from_the_middle_of_one() {
    for (phase, accuracy) in [("Together", 0.5), ("Random", 0.0)] {
        let expected = preflight(&ROW.replace("Together", phase));
        let found = expected.get("detection_time_s").unwrap();
        assert!((found.accuracy - accuracy).abs() < 1e-12, "{phase}: {found:?}");
    }
}

/// Two robots, control steps every 0.5 s at which both send, latency 0.05 s: a status waits 0.45 s for a step. The timer, which fires
/// once every 3.2 s and then 0.2 s after an arrival, takes 0.25 s off one wait in 3.2. The mistake itself is (3 + 1.25) η − 3.2 s.
#[test]
fn of_two_robots_that_begin_together_one_reads_sooner_where_its_timer_wakes_it() {
    let pair = ROW
        .replace("robots: 3", "robots: 2")
        .replace(", (2.0, 0.0)", "")
        .replace("3.5", "3.2");
    let expected = preflight(&format!(
        "{pair}, radio: (range: 1.0, loss: Bernoulli(0.2), latency: Constant(0.05))"
    ));
    assert_value(&expected, "mistake_duration_s", 1.05 + 0.45 - 0.25 / 3.2);
}

#[test]
fn bursts_and_distance_have_their_own_mean_loss() {
    let bursts = preflight(&format!(
        "{ROW}, radio: (loss: GilbertElliott(good_to_bad: 0.05, bad_to_good: 0.2), latency: Constant(0.05))"
    ));
    assert_value(&bursts, "loss_ratio", 0.2);
    assert_value(&bursts, "mistake_recurrence_s", 39.0625);
    // Of six copies of a round four go 1 m and two 2 m: a quarter of 0.4 is lost of the former, all of 0.4 of the latter.
    let by_distance = preflight(&format!("{ROW}, radio: (loss: Distance(at_range: 0.4, exponent: 2.0))"));
    assert_value(&by_distance, "loss_ratio", (4.0 * 0.1 + 2.0 * 0.4) / 6.0);
    let rate = |p: f64| (1.0 - p) * p.powi(3);
    assert_value(
        &by_distance,
        "mistake_rate_hz",
        (4.0 * rate(0.1) + 2.0 * rate(0.4)) / 6.0,
    );
}

#[test]
fn of_the_backbone_it_is_said_what_holds_when_and_what_nobody_can_predict() {
    let expected = preflight(
        "swarm: (robots: 40, deploy: Cluster(radius: 1.06)), radio: (loss: Bernoulli(0.2)),
         protocol: Backbone(targets: Ring(count: 4, radius: 4.5, links: 2))",
    );
    let holds = |name| expected.get(name).map(|prediction| prediction.holds);
    assert_eq!(holds("loss_ratio"), Some(Holds::Throughout));
    assert_eq!(holds("degree"), Some(Holds::AtStart));
    assert_eq!(holds("mistake_rate_hz"), Some(Holds::InRange));
    assert_value(&expected, "robots_needed", 21.0);
    assert_value(&expected, "status_tx_bytes_per_step", 9.0);
    let refused: Vec<_> = expected.not_predicted.iter().map(|refused| refused.name).collect();
    assert_eq!(refused, ["degree_at_end", "request", "strand", "channel_utilisation"]);
}

/// The closed forms of the detectors themselves are for simple Gilbert loss and constant latency: here both must be the same.
#[test]
fn timeouts_and_nfd_s_are_predicted_as_their_own_closed_forms_have_it() {
    let link = Link {
        interval_s: 1.0,
        good_to_bad: 0.05,
        bad_to_good: 0.2,
        latency_s: 0.05,
    };
    for detector in ["Timeout(3.5)", "Timeout(3.0)", "NfdS(shift: 2.5)", "NfdS(shift: 3.0)"] {
        let radio = "radio: (loss: GilbertElliott(good_to_bad: 0.05, bad_to_good: 0.2), latency: Constant(0.05))";
        let text = format!("{}, {radio}", ROW.replace("Timeout(3.5)", detector));
        let text = text.replace("phase: Together", "wake: OnReception");
        let expected = preflight(&text);
        let quality = scenario(&text).detector.quality(&link).unwrap();
        assert_value(&expected, "mistake_recurrence_s", quality.mistake_recurrence_s);
        assert_value(&expected, "mistake_duration_s", quality.mistake_duration_s);
        assert_value(&expected, "query_accuracy", quality.query_accuracy);
        assert_value(&expected, "detection_time_s", quality.detection_time_s);
    }
}

#[test]
fn detectors_without_closed_forms_are_said_to_have_none() {
    for detector in ["PhiAccrual(dialect: Chitchat)", "Swim(indirect_checks: 0)"] {
        let text = ROW
            .replace("Timeout(3.5)", detector)
            .replace("period: 0.5", "period: 0.1");
        let expected = preflight(&format!("{text}, radio: (latency: Constant(0.02))"));
        assert!(expected.get("mistake_rate_hz").is_none(), "{detector}");
        assert!(
            expected.not_predicted.iter().any(|refused| refused.name == "detection"),
            "{detector}"
        );
        assert_eq!(
            expected.not_predicted.iter().any(|refused| refused.name == "probe"),
            detector.starts_with("Swim")
        );
    }
}

#[test]
fn where_the_forms_do_not_hold_it_is_said_so() {
    for (radio, why) in [
        ("latency: Constant(0.0)", "the order of events"),
        ("latency: Uniform(min: 0.0, max: 2.0)", "overtake"),
    ] {
        let expected = preflight(&format!("{}, radio: ({radio})", ROW.replace("3.5", "3.0")));
        let refused = expected
            .not_predicted
            .iter()
            .find(|refused| refused.name == "detection");
        assert!(
            refused.is_some_and(|refused| refused.why.contains(why)),
            "{radio}: {refused:?}"
        );
    }
    let walls = preflight("swarm: (robots: 9, deploy: Cluster(radius: 5.0)), protocol: Heartbeat");
    assert!(walls.get("degree").is_none() && walls.get("channel_load_bytes_per_s").is_none());
}

#[test]
fn everything_predicted_is_a_finite_number_in_json() {
    for loss in [
        "None",
        "Bernoulli(1.0)",
        "GilbertElliott(good_to_bad: 0.5, bad_to_good: 0.0)",
        "Bernoulli(0.5)",
    ] {
        let expected = preflight(&format!("{ROW}, radio: (loss: {loss})"));
        let all = &expected.predictions;
        assert!(
            all.iter()
                .all(|found| found.value.is_finite() && found.accuracy.is_finite()),
            "{loss}: {all:?}"
        );
    }
}

/// At 0.1 s a timeout of 10⁹ s waits for 10¹⁰ statuses; T_D is TO + d less half an interval and what was lost before.
#[test]
fn the_longest_timeout_is_predicted_at_once_and_right() {
    let text = ROW
        .replace("Timeout(3.5)", "Timeout(1e9)")
        .replace("interval: 1.0", "interval: 0.5");
    let text = text.replace("phase: Together", "phase: Random");
    let expected = preflight(&format!(
        "{text}, radio: (loss: Bernoulli(0.2), latency: Constant(0.05))"
    ));
    assert_value(&expected, "mistake_rate_hz", 0.0);
    assert_value(&expected, "query_accuracy", 1.0);
    assert_value(&expected, "detection_time_s", 1e9 + 0.05 - 0.5 * (0.5 + 0.25));
    assert!(expected.get("mistake_recurrence_s").is_none());
}

/// Anything from 10⁻⁶ to 10¹², most of it strange.
fn wild() -> impl Strategy<Value = f64> {
    (-6.0..12.0_f64).prop_map(|exponent| 10_f64.powf(exponent))
}

fn share() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        Just(1.0),
        0.0..1.0_f64,
        (-12.0..0.0_f64).prop_map(|exponent| 10_f64.powf(exponent)),
        (-12.0..0.0_f64).prop_map(|exponent| 1.0 - 10_f64.powf(exponent))
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Whatever is accepted is predicted, and in no time: steps that grew with the timeout would not end.
    #[test]
    fn whatever_is_accepted_is_predicted_in_finite_numbers(
        [silence, interval, first, second, range] in prop::array::uniform5(wild()),
        [p, q, r, s] in prop::array::uniform4(share()),
        kinds in (0..6_usize, 0..4_usize, 0..6_usize), robots in 1_u32..1_000_000,
        period in prop_oneof![Just(0.1), Just(1.0), Just(100.0)], together: bool, wakes: bool,
    ) {
        let silence = silence.max(1.001 * interval);
        let detector = [
            format!("Timeout({silence:e})"), format!("NfdS(shift: {silence:e})"),
            format!("PhiAccrual(dialect: Akka, threshold: {silence:e})"), "Swim()".to_owned(), "None".to_owned(),
            format!("Swim(leave_timeout: {silence:e})"),
        ];
        let loss = [
            format!("Bernoulli({p:e})"), format!("GilbertElliott(good_to_bad: {p:e}, bad_to_good: {q:e}, good_loss: {r:e}, bad_loss: {s:e})"),
            format!("Distance(at_range: {p:e}, exponent: {first:e})"), "None".to_owned(),
        ];
        let latency = [
            format!("Constant({first:e})"), format!("Uniform(min: 0.0, max: {first:e})"),
            format!("Normal(mean: {first:e}, std_dev: {second:e}, min: 0.0)"), format!("LogNormal(median: {first:e}, sigma: {p:e})"),
            format!("Gamma(shape: {second:e}, scale: {first:e})"), format!("Exponential(mean: {first:e})"),
        ];
        let phase = if together { "Together" } else { "Random" };
        let wake = if wakes { "OnReception" } else { "ControlStep" };
        let text = format!(
            "Scenario(name: \"wild\", time_limit: 1000.0, swarm: (robots: {robots}, deploy: Uniform), arena: (size: (1e4, 1e4)),
             protocol: Heartbeat, control: (period: {period:?}, phase: {phase}, wake: {wake}),
             gossip: (status: (interval: {interval:e})), detector: {},
             radio: (range: {:e}, loss: {}, latency: {}), metrics: (sample_interval: 0.0))",
            detector[kinds.0], range.min(1e4), loss[kinds.1], latency[kinds.2]
        );
        if let Ok(scenario) = parse("wild.ron", &text, &[]) {
            for found in Preflight::of(&scenario).predictions {
                prop_assert!(found.value.is_finite() && found.accuracy.is_finite() && found.accuracy >= 0.0, "{}: {:?}", text, found);
                let probability = matches!(found.name, "query_accuracy" | "loss_ratio");
                prop_assert!(!probability || (-1e-9..=1.0 + 1e-9).contains(&found.value), "{}: {:?}", text, found);
                prop_assert!(found.value >= -1e-9, "{}: {:?}", text, found);
            }
        }
    }
}

/// Found by the property above: where nearly all is lost, the share of time that is mistaken less all of the time is rounding alone.
#[test]
fn a_duration_that_is_rounding_alone_is_not_predicted() {
    let text = "Scenario(name: \"wild\", time_limit: 1000.0, swarm: (robots: 1, deploy: Uniform), arena: (size: (1e4, 1e4)), \
        protocol: Heartbeat, control: (period: 0.1, phase: Random), gossip: (status: (interval: 1e0)), detector: NfdS(shift: 1.001e0), \
        radio: (range: 1e0, loss: GilbertElliott(good_to_bad: 1e0, bad_to_good: 6.055059368502304e-12, good_loss: 9.999994994287572e-1, \
        bad_loss: 1e0), latency: Constant(1.6181667587032727e-4)), metrics: (sample_interval: 0.0))";
    let scenario = parse("wild.ron", text, &[]).unwrap_or_else(|report| panic!("{report}"));
    let preflight = Preflight::of(&scenario);
    assert!(
        preflight.predictions.iter().all(|found| found.value >= 0.0),
        "{preflight:?}"
    );
    let refused = preflight
        .not_predicted
        .iter()
        .any(|left| left.name == "mistake_duration_s");
    assert!(refused, "{preflight:?}");
}

#[test]
fn of_a_detector_that_is_none_nothing_is_predicted_and_the_backbone_does_not_run_with_it() {
    let expected = preflight(&ROW.replace("Timeout(3.5)", "None"));
    assert!(
        ["mistake_rate_hz", "query_accuracy", "detection_time_s"]
            .iter()
            .all(|name| expected.get(name).is_none())
    );
    let refused = expected
        .not_predicted
        .iter()
        .find(|refused| refused.name == "detection");
    assert!(
        refused.is_some_and(|refused| refused.why.contains("no failure detector")),
        "{refused:?}"
    );
    let backbone = "Scenario(name: \"bare\", time_limit: 9.0, swarm: (robots: 9, deploy: Uniform), detector: None,
        protocol: Backbone(targets: Ring(count: 1, radius: 3.0, links: 1)))";
    let report = parse("bare.ron", backbone, &[]).unwrap_err().to_string();
    assert!(report.contains("the backbone needs a failure detector"), "{report}");
}

/// 80 robots of which each tells one other a second, a fifth of what they say lost: 2 · 79 · H(79) / (80 · 0.8) = 12.23 s, as
/// the scenario that ships has it.
#[test]
fn a_rumour_is_a_simple_epidemic_where_nothing_about_it_is_otherwise() {
    let text = |protocol: &str, more: &str| {
        format!(
            "swarm: (robots: 80, deploy: Cluster(radius: 0.95)), protocol: Rumor({protocol}), \
             gossip: (relay: (interval: 1.0, fan_out: Peers(1))), {more}"
        )
    };
    let still = "radio: (loss: Bernoulli(0.2), latency: Constant(0.0))";
    let time = "spread.time_to_all_s";
    let harmonic: f64 = (1..80).map(|n| 1.0 / f64::from(n)).sum();
    let mean = |rate: f64| 2.0 * 79.0 * harmonic / (80.0 * rate);
    assert!((mean(0.8) - 12.23).abs() < 0.005);
    let at_once = format!("control: (wake: OnReception), {still}");
    for (mode, more, rate) in [
        ("Push", still, 0.8),
        ("Pull", at_once.as_str(), 0.64),
        ("PushPull", at_once.as_str(), 0.8 + 0.64),
    ] {
        let expected = preflight(&text(&format!("mode: {mode}, rounds: Poisson"), more));
        assert_value(&expected, time, mean(rate));
    }
    let poisson = "mode: Push, rounds: Poisson";
    for (protocol, more) in [
        ("mode: Push", still),
        ("mode: Pull, rounds: Poisson", still),
        ("mode: Push, rounds: Poisson, sources: Random(2)", still),
        (poisson, "radio: (latency: Constant(0.1))"),
        (poisson, "radio: (range: 1.8, latency: Constant(0.0))"),
        (
            poisson,
            "wander: RandomWaypoint(speed: 0.02), radio: (latency: Constant(0.0))",
        ),
        (
            poisson,
            "radio: (latency: Constant(0.0)), faults: [Crash(robots: [3], at: 1.0)]",
        ),
    ] {
        let expected = preflight(&text(protocol, more));
        assert!(expected.get(time).is_none(), "{protocol}, {more}");
        assert!(expected.not_predicted.iter().any(|refused| refused.name == time));
    }
}
