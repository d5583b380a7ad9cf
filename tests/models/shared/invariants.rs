//! What holds whatever the technology, the swarm, the walls, the jammers: every copy has one fate, drivers agree, common random numbers.

use std::cell::Cell;
use std::collections::BTreeSet;

use desim::engine::SimTime;
use desim::experiment::run_trial;
use desim::scenario::parse;
use desim::simulation::DriverKind;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use tokio_util::sync::CancellationToken;

use super::{EVERYBODY, fates, scenario, with_robots};

fn technology() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec![
        "Ieee802154()",
        "Wifi(standard: B, rate: 1e6)",
        "Wifi(standard: B, rate: 11e6, preamble: Short)",
        "Wifi(standard: G, rate: 24e6)",
        "BleAdvertising(interval: 0.05)",
        "LoRa(spreading: 7, duty_cycle: Some(0.2))",
        "LoRa(spreading: 9, bandwidth: 250e3, duty_cycle: None)",
        "ArgosRab()",
        "EPuck()",
        "Kilobot()",
        "Custom()",
        "Custom(bit_rate: None)",
        "Custom(bit_rate: 1e6, acknowledgement_bytes: 5, assess: -80.0)",
    ])
}

fn access() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec![
        "",
        "",
        "access: None,",
        "access: Aloha(duty_cycle: 0.3),",
        "access: SlottedAloha(slot: 0.2, probability: 0.5),",
        "access: Tdma(slot: 0.2, guard: 0.001),",
        "access: CsmaCa(max_backoffs: 1, max_retries: 1),",
        "access: Dcf(),",
        "access: Paced(interval: 0.1, jitter: 0.05, listen: 0.001, retry: 0.001, most: 5),",
    ])
}

/// The text of a scenario with any radio and any hindrances, whatever that makes of it.
fn any_air() -> impl Strategy<Value = String> {
    let words = (
        technology(),
        access(),
        prop::sample::select(vec![
            "",
            "capture: None,",
            "capture: 0.0,",
            "capture: 6.0,",
            "capture: inf,",
        ]),
        prop::sample::select(vec![
            "None",
            "Rayleigh()",
            "Rician(k: 4.0, doppler: 20.0)",
            "Nakagami(m: 1.5)",
        ]),
        prop::sample::select(vec!["Pass", "Block", "Loss(6.0)"]),
        prop::sample::select(vec!["Everyone", "Next", "Robot(0)"]),
        prop::sample::select(vec![
            "",
            "Silence(robots: [0], at: 1.0, lasts: For(0.7))",
            "Mute(robots: [0], at: 0.4, lasts: For(1.0)), Deaf(robots: [0], at: 1.2)",
            "Crash(robots: [0], at: 0.9, lasts: For(0.333))",
            "Partition(line: ((0.1, -5.0), (0.0, 5.0)), during: Between(0.5, 1.5))",
        ]),
        prop::sample::select(vec![
            "",
            "Jammer(at: (1.0, 1.0), power: 5.0, from: 0.3, until: 1.7, pulses: (0.003, 0.01))",
            "Jammer(at: (0.0, 0.0), power: -20.0), Background(power: -90.0)",
        ]),
    );
    let numbers = (
        any::<u64>(),
        1_u32..14,
        -30.0..20.0_f64,
        1_u32..5,
        0_u16..40,
        prop::sample::select(vec![0.0, 50.0, 30_000.0]),
    );
    (words, numbers).prop_map(|(words, (seed, robots, power, queue, payload, drift))| {
        let (technology, access, capture, fading, walls, to, faults, noise) = words;
        format!(
            "Scenario(name: \"any\", seed: {seed}, time_limit: 3.0, control: (period: 0.2, clock_drift: {drift:?}), faults: [{faults}], \
             arena: (size: (6.0, 6.0), obstacles: [Wall(from: (0.3, -2.0), to: (0.3, 2.0)), Disc(at: (-1.5, 1.0), radius: 0.3)]), \
             swarm: (robots: {robots}, deploy: Uniform), protocol: Traffic(when: Poisson(15.0), payload: {payload}, to: {to}), \
             radio: Shared(technology: {technology}, {access} {capture} transmit_power: {power:?}, transmit_power_spread: 3.0, \
             shadowing: (sigma: 4.0, decorrelation: 2.0), fading: {fading}, walls: {walls}, noise: [{noise}], queue: {queue}))"
        )
    })
}

/// Runs it under both drivers: how many frames were sent.
fn check(text: &str) -> Result<u64, TestCaseError> {
    let scenario = match parse("any.ron", text, &[]) {
        Ok(scenario) => scenario,
        Err(report) => {
            // Payloads that never fit are refused, and slots that leave no room.
            let report = report.to_string();
            prop_assert!(report.contains("payload") || report.contains("slot"), "{}", report);
            return Ok(0);
        }
    };
    let run = |driver| run_trial(&scenario, 0, driver, &CancellationToken::new()).expect("the trial runs");
    let [inline, actors] = [run(DriverKind::Inline), run(DriverKind::Actors)];
    prop_assert_eq!(&inline.ledger, &actors.ledger);
    prop_assert_eq!(inline.digest, actors.digest);
    let _ = fates(&inline);
    Ok(inline
        .air
        .iter()
        .flat_map(|air| &air.robots)
        .map(|robot| robot.frames)
        .sum())
}

/// Over so many frames as `DESIM_FRAMES` says: few by default, a million before a release.
#[test]
fn every_copy_has_one_fate_and_drivers_agree() {
    let wanted = std::env::var("DESIM_FRAMES").map_or(5_000, |frames| frames.parse().expect("a number of frames"));
    let sent = Cell::new(0_u64);
    while sent.get() < wanted {
        let mut runner = TestRunner::new(ProptestConfig {
            cases: 20,
            ..ProptestConfig::with_source_file(file!())
        });
        let run = |text: String| {
            sent.set(sent.get() + check(&text)?);
            Ok(())
        };
        runner
            .run(&any_air(), run)
            .unwrap_or_else(|failure| panic!("{failure}"));
    }
    println!("{} frames", sent.get());
}

/// Who got which of whose frames, in open-loop broadcast.
fn received(capture: &str) -> BTreeSet<(u32, u32, u32)> {
    use desim::simulation::{Copy, Observer};

    #[derive(Default)]
    struct Received(BTreeSet<(u32, u32, u32)>);
    impl Observer for Received {
        fn delivered(&mut self, copy: &Copy, _: SimTime, _: Option<SimTime>) {
            self.0.insert((copy.sender.0, copy.receiver.0, copy.sequence));
        }
    }
    let radio = format!("technology: Ieee802154(), access: Aloha(), capture: {capture}, fading: Rayleigh()");
    let scenario = with_robots(scenario(5.0, "when: Poisson(40.0), payload: 20", EVERYBODY, &radio), 30);
    let mut setup = desim::simulation::Setup::lasting(desim::engine::Span::from_secs(5.0));
    setup.own_radio = Some(std::sync::Arc::new(scenario.radio.shared().expect("shared").clone()));
    setup.control = scenario.control.clone();
    let robots = (0..30).map(|_| {
        let timing = desim::kinds::traffic::Timing::Poisson(desim::quantity::Positive::new(40.0));
        desim::kinds::traffic::Source::new(timing, 20, Some(desim::kinds::traffic::To::Everyone))
    });
    let poses = (0..30).map(|robot| desim::geometry::Pose {
        position: desim::geometry::Vec2::new(f64::from(robot % 6), f64::from(robot / 6)),
        heading: 0.0,
    });
    let stop = CancellationToken::new();
    let finished = setup.observe(
        poses.collect(),
        robots.collect(),
        DriverKind::Inline,
        &stop,
        Received::default(),
    );
    finished.expect("the run ends").observer.0
}

/// Nobody's business but that all is told in order, so that no robot takes a step ahead of its time.
struct InOrder;

impl desim::simulation::Observer for InOrder {
    const IN_ORDER: bool = true;
}

/// Control steps are taken in rounds up to the radio's lookahead: a robot that steps within it cannot have heard what is sent meanwhile. With a lookahead of a millisecond
/// more the digests differ.
#[test]
fn rounds_of_control_steps_do_not_show() {
    for (radio, drift) in [
        ("technology: Ieee802154()", 0.0),
        ("technology: Ieee802154()", 20_000.0),
        ("technology: Wifi(standard: B, rate: 11e6)", 0.0),
        ("technology: Custom(bit_rate: None), access: None", 0.0),
    ] {
        let scenario = scenario(1.0, "", EVERYBODY, radio);
        let mut setup = desim::simulation::Setup::lasting(desim::engine::Span::from_secs(4.0));
        setup.own_radio = Some(std::sync::Arc::new(scenario.radio.shared().expect("shared").clone()));
        setup.control.period = desim::quantity::Positive::new(0.05);
        setup.control.clock_drift = desim::quantity::NonNegative::new(drift);
        setup.motion.tick = desim::quantity::Positive::new(0.05);
        let robots = || {
            let timing = desim::kinds::traffic::Timing::Poisson(desim::quantity::Positive::new(20.0));
            let source = desim::kinds::traffic::Source::new(timing, 20, Some(desim::kinds::traffic::To::Everyone));
            vec![source; 30]
        };
        let poses = || {
            let place = |robot: i32| desim::geometry::Vec2::new(f64::from(robot % 6), f64::from(robot / 6));
            let pose = |robot| desim::geometry::Pose {
                position: place(robot),
                heading: 0.0,
            };
            (0..30).map(pose).collect::<Vec<_>>()
        };
        let stop = CancellationToken::new();
        let rounds = setup
            .run(poses(), robots(), DriverKind::Inline, &stop)
            .expect("the run ends");
        let steps = setup
            .observe(poses(), robots(), DriverKind::Inline, &stop, InOrder)
            .expect("the run ends");
        assert_eq!(rounds.digest, steps.record.digest, "{radio}");
        assert!(rounds.ledger[0].delivered > 10_000, "{}", rounds.ledger[0]);
    }
}

#[test]
fn what_survives_at_a_capture_ratio_survives_at_every_lower_one() {
    let [none, three, six, strict] = ["0.0", "3.0", "6.0", "inf"].map(received);
    assert!(strict.is_subset(&six) && six.is_subset(&three) && three.is_subset(&none));
    assert!(
        strict.len() < six.len() && six.len() < three.len(),
        "{} {} {}",
        strict.len(),
        six.len(),
        three.len()
    );
}
