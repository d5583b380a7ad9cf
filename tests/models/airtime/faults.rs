//! Robots and links that fail while a frame is on air, and the books whatever happens.

use desim::engine::SimTime;
use desim::metrics::TopicFates;
use desim::protocol::control::{PhaseConfig, WakeConfig};
use desim::radio::LossCause;
use desim::simulation::{Copy, DriverKind, Observer, Setup};
use proptest::prelude::*;
use tokio_util::sync::CancellationToken;

use super::aloha::Aloha;
use super::{Scripted, chatters, line, run, setup};

/// Frames of 48 ms.
const SLOW: Aloha = Aloha {
    range: 1.5,
    bit_rate: 1e3,
};

fn with_faults(mut setup: Setup, faults: &str) -> Setup {
    let faults = format!("#![enable(unwrap_variant_newtypes, unwrap_newtypes)] [{faults}]");
    setup.faults = ron::from_str(&faults).expect("faults");
    setup
}

/// What robot 1 hears of robot 0, which says something at steps 1, 2 and 3, and what is lost there for each cause.
fn heard(faults: &str) -> (Vec<u8>, Vec<(LossCause, u64)>) {
    let robots = vec![Scripted::new(&[1, 2, 3]), Scripted::new(&[])];
    let setup = with_faults(setup(1.0, SLOW), faults);
    let finished = run(&setup, line(2, 1.0), robots, DriverKind::Inline);
    let words = finished.robots[1].words().into_iter().map(|(_, word)| word).collect();
    let fates = &finished.record.ledger[0];
    let lost = LossCause::ALL.map(|cause| (cause, fates.lost[cause as usize]));
    (words, lost.into_iter().filter(|lost| lost.1 > 0).collect())
}

#[test]
fn a_receiver_hears_a_frame_that_it_hears_from_beginning_to_end() {
    let down = |copies| vec![(LossCause::ReceiverDown, copies)];
    // The second frame is on air from 0.2 to 0.248 s.
    assert_eq!(
        heard("Deaf(robots: [1], at: 0.21, lasts: For(0.01))"),
        (vec![1, 3], down(1))
    );
    assert_eq!(
        heard("Deaf(robots: [1], at: 0.19, lasts: For(0.02))"),
        (vec![1, 3], down(1))
    );
    assert_eq!(
        heard("Deaf(robots: [1], at: 0.24, lasts: For(0.03))"),
        (vec![1, 3], down(1))
    );
    assert_eq!(
        heard("Deaf(robots: [1], at: 0.15, lasts: For(0.049))"),
        (vec![1, 2, 3], vec![])
    );
    assert_eq!(
        heard("Deaf(robots: [1], at: 0.249, lasts: For(0.05))"),
        (vec![1, 2, 3], vec![])
    );
    // One that is deaf at the very end does not hear it; one that is again at the very beginning does.
    assert_eq!(
        heard("Deaf(robots: [1], at: 0.248, lasts: For(0.01))"),
        (vec![1, 3], down(1))
    );
    assert_eq!(
        heard("Deaf(robots: [1], at: 0.15, lasts: For(0.05))"),
        (vec![1, 2, 3], vec![])
    );
    // Two frames in one deafness; a crash is one too.
    assert_eq!(
        heard("Deaf(robots: [1], at: 0.21, lasts: For(0.1))"),
        (vec![1], down(2))
    );
    assert_eq!(
        heard("Crash(robots: [1], at: 0.21, lasts: For(0.01))"),
        (vec![1, 3], down(1))
    );
}

#[test]
fn a_frame_whose_sender_falls_silent_in_the_middle_of_it_is_lost_and_jams_nobody_from_then_on() {
    let cut = vec![(LossCause::Channel, 1)];
    for effect in ["Mute", "Crash", "Silence"] {
        let fails = |at: f64| heard(&format!("{effect}(robots: [0], at: {at:?}, lasts: For(0.01))"));
        assert_eq!(fails(0.21), (vec![1, 3], cut.clone()), "{effect}");
        assert_eq!(fails(0.249), (vec![1, 2, 3], vec![]), "{effect}");
    }
    // Robot 1 hears both others, which do not hear each other: one is on air from 0.1 to 0.58 s, the other from 0.3 s on.
    let heard_of_both = |faults: &str| {
        let slower = Aloha {
            bit_rate: 100.0,
            ..SLOW
        };
        let robots = vec![Scripted::new(&[1]), Scripted::new(&[]), Scripted::new(&[3])];
        let setup = with_faults(setup(1.0, slower), faults);
        run(&setup, line(3, 1.0), robots, DriverKind::Inline).robots[1].words()
    };
    assert_eq!(heard_of_both(""), []);
    assert_eq!(heard_of_both("Mute(robots: [0], at: 0.31)"), []);
    assert_eq!(heard_of_both("Mute(robots: [0], at: 0.3)"), [(2, 3)]);
    assert_eq!(heard_of_both("Mute(robots: [0], at: 0.2)"), [(2, 3)]);
}

/// When copies were lost.
#[derive(Default)]
struct Losses(Vec<SimTime>);

impl Observer for Losses {
    fn lost(&mut self, _: &Copy, _: LossCause, at: SimTime) {
        self.0.push(at);
    }
}

#[test]
fn what_a_failure_decides_is_told_at_its_instant() {
    let robots = vec![Scripted::new(&[1, 2, 3]), Scripted::new(&[])];
    let setup = with_faults(setup(1.0, SLOW), "Mute(robots: [0], at: 0.21, lasts: For(0.01))");
    let stop = CancellationToken::new();
    let finished = setup.observe(line(2, 1.0), robots, DriverKind::Inline, &stop, Losses::default());
    let told = finished.expect("the run reaches its end").observer.0;
    assert_eq!(told, [SimTime::from_secs(0.21)]);
}

#[test]
fn what_a_fault_of_a_link_stops_is_lost_as_it_is_handed_over() {
    let stopped = vec![(LossCause::LinkFault, 1)];
    // From 0.2 to 0.248 s.
    assert_eq!(
        heard("Burst(loss: 1.0, during: Between(0.19, 0.21))"),
        (vec![1, 3], stopped)
    );
    assert_eq!(
        heard("Burst(loss: 1.0, during: Between(0.21, 0.29))"),
        (vec![1, 2, 3], vec![])
    );
}

/// A fault at random among robots 0 to 5.
fn any_fault() -> impl Strategy<Value = String> {
    let effect = prop::sample::select(vec!["Silence", "Crash", "Mute", "Deaf"]);
    let planned = (effect, 0..6_u32, 0.0..3.0_f64, 0.001..1.0_f64).prop_map(|(effect, robot, at, lasts)| {
        format!("{effect}(robots: [{robot}], at: {at:?}, lasts: For({lasts:?}))")
    });
    let hazard = (0.0..0.1_f64, 0.001..0.5_f64).prop_map(|(hazard, lasts)| {
        format!("Robots(effect: Crash, robots: Share(0.7), when: Hazard(per_step: {hazard:?}), lasts: For({lasts:?}))")
    });
    let burst = (0.0..1.0_f64, 0.0..2.0_f64, 0.1..2.0_f64).prop_map(|(loss, from, length)| {
        let until = from + length;
        format!("Burst(links: Of([0, 2]), loss: {loss:?}, during: Between({from:?}, {until:?}))")
    });
    let partition =
        (0.5..3.0_f64).prop_map(|x| format!("Partition(line: (({x:?}, 0.0), (0.9, 1.0)), during: From(1.0))"));
    prop_oneof![4 => planned, 1 => hazard, 1 => burst, 1 => partition]
}

/// The books are balanced, and both drivers agree.
fn check<const OVERHEARS: bool>(setup: &Setup) -> Result<(), TestCaseError> {
    let [inline, actors] = [DriverKind::Inline, DriverKind::Actors]
        .map(|driver| run(setup, line(6, 0.6), chatters::<OVERHEARS>(6), driver));
    prop_assert!(inline.record.ledger.iter().all(TopicFates::is_balanced));
    prop_assert!(inline.record.ledger.iter().any(|fates| fates.offered > 0));
    prop_assert_eq!(inline.record, actors.record);
    prop_assert_eq!(inline.robots, actors.robots);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// The recorder itself asserts, at the end of every run, that no copy is lost from the books.
    #[test]
    fn every_copy_has_one_fate_whatever_fails_and_both_drivers_agree(
        faults in prop::collection::vec(any_fault(), 0..8),
        bit_rate in prop::sample::select(vec![3e2, 2e3, 1e4, 1e6]),
        seconds in 0.5..3.0_f64,
        seed in any::<u64>(),
        [piggyback, overhears, on_reception] in any::<[bool; 3]>(),
    ) {
        let mut setup = with_faults(setup(seconds, Aloha { range: 1.5, bit_rate }), &faults.join(", "));
        setup.seed = seed;
        setup.piggyback = piggyback;
        setup.control.phase = PhaseConfig::Random;
        if on_reception {
            setup.control.wake = WakeConfig::OnReception;
        }
        if overhears {
            check::<true>(&setup)?;
        } else {
            check::<false>(&setup)?;
        }
    }
}
