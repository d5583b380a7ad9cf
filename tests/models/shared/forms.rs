//! Closed forms of medium access, in whole runs.

use desim::metrics::TrialRecord;

use super::{EQUAL_LOSS, EVERYBODY, HIDDEN, delivery, fates, measured, runs, scenario, with_robots};

const IEEE802154: &str = "technology: Ieee802154()";
/// 1.184 ms for 20 bytes.
const AIRTIME_S: f64 = 1.184e-3;

fn everybody(seconds: f64, traffic: &str, radio: &str, robots: u32, trials: u32) -> Vec<TrialRecord> {
    let radio = format!("{radio}, {EQUAL_LOSS}");
    runs(
        &with_robots(scenario(seconds, traffic, EVERYBODY, &radio), robots),
        trials,
    )
}

fn mean_latency(record: &TrialRecord) -> f64 {
    record.latency.mean_secs().expect("frames arrive")
}

/// n queues that each load the channel by ρ: nobody else is on air when a frame begins with 1 − ρ each, and nobody begins while it lasts with e^−ρ.
#[test]
fn pure_aloha() {
    for (robots, rate) in [(2, 50.0), (10, 10.0), (50, 4.0), (50, 8.0)] {
        let load = rate * AIRTIME_S;
        let expected = ((1.0 - load) * (-load).exp()).powi(robots - 1);
        let traffic = format!("when: Poisson({rate:?}), payload: 20");
        let radio = format!("{IEEE802154}, access: Aloha(), capture: inf");
        let records = everybody(30.0, &traffic, &radio, robots.cast_unsigned(), 12);
        measured(&records, delivery).agrees(&format!("{robots} robots at {rate} /s"), expected, 0.0, 0.0);
    }
}

/// In a slot each of N robots sends with probability p, so a frame is alone with (1 − p)^(N − 1).
#[test]
fn slotted_aloha() {
    for (robots, probability) in [(10, 0.1), (5, 0.3), (30, 0.05)] {
        let radio =
            format!("{IEEE802154}, access: SlottedAloha(slot: 0.0012, probability: {probability}), capture: inf");
        let records = everybody(10.0, "when: Saturated, payload: 20", &radio, robots, 10);
        let expected = (1.0_f64 - probability).powi(robots.cast_signed() - 1);
        measured(&records, delivery).agrees(&format!("{robots} robots, p = {probability}"), expected, 0.0, 0.0);
    }
}

/// A frame meets a Poisson number of others of its own mean power; with a gain of its own, exponential, each of these leaves it z above them with
/// 1/(1 + z): e^(−Gz/(1 + z)) for many robots, and (1 − pz/(1 + z))^(N − 1) for N that send with p.
#[test]
fn rayleigh_capture() {
    for (capture, robots) in [(6.0, 50), (3.0, 20)] {
        // A fast background Doppler gives each frame a gain of its own; the loss leaves noise nothing to do.
        let radio = format!(
            "{IEEE802154}, access: SlottedAloha(slot: 0.0012, probability: {:?}), capture: {capture:?}, negligible: 60.0, fading: Rayleigh(doppler: 5000.0)",
            1.0 / f64::from(robots)
        );
        let records = everybody(8.0, "when: Saturated, payload: 20", &radio, robots, 8);
        let z = 10_f64.powf(capture / 10.0);
        let busy = 1.0 / f64::from(robots);
        // Of the others a receiver is one itself: it hears nothing while it sends.
        let expected = (1.0 - busy * z / (1.0 + z)).powi(robots.cast_signed() - 2) * (1.0 - busy);
        measured(&records, delivery).agrees(&format!("z = {capture} dB"), expected, 0.0, 0.0);
    }
}

/// M/D/1: one robot's queue, served in T, waits ρT/2(1 − ρ).
#[test]
fn a_queue_waits_as_m_d_1() {
    for share in [0.3, 0.6, 0.8] {
        let rate = share / AIRTIME_S;
        let traffic = format!("when: Poisson({rate:?}), payload: 20, senders: Given([0])");
        let radio = format!("{IEEE802154}, access: Aloha(), queue: 1000");
        let records = everybody(40.0, &traffic, &radio, 2, 12);
        let expected = AIRTIME_S * (1.0 + share / (2.0 * (1.0 - share)));
        measured(&records, mean_latency).agrees(&format!("ρ = {share}"), expected, 0.0, 0.0);
    }
}

/// Time division: a frame waits half a frame of slots, and for those before it: F/2 + λF²/2(1 − λF).
#[test]
fn a_slot_waits_as_tdma() {
    for share in [0.2, 0.5, 0.8] {
        let (slots, slot) = (20.0, 0.002);
        let frame = slots * slot;
        let rate = share / frame;
        let traffic = format!("when: Poisson({rate:?}), payload: 20");
        let radio = format!("{IEEE802154}, access: Tdma(slot: {slot:?}, guard: 0.0), queue: 1000");
        let records = everybody(100.0, &traffic, &radio, 20, 8);
        let expected = frame / 2.0 + rate * frame * frame / (2.0 * (1.0 - share)) + AIRTIME_S;
        // The queue is empty at first, and what is still in it at the end is not counted.
        measured(&records, mean_latency).agrees(&format!("λF = {share}"), expected, 0.0, 0.005 * expected);
        measured(&records, delivery).agrees("nothing is lost", 1.0, 0.0, 0.0);
    }
}

/// λT ≪ 1: a hidden sender is not on air as a frame begins, and does not begin while it lasts.
#[test]
fn a_hidden_pair_without_carrier_sense() {
    for rate in [10.0, 50.0, 200.0] {
        let traffic = format!("when: Poisson({rate:?}), payload: 20, senders: Given([0, 2])");
        let radio = format!("{IEEE802154}, access: Aloha(), capture: inf, walls: Block, queue: 1000, {EQUAL_LOSS}");
        let records = runs(&scenario(60.0, &traffic, HIDDEN, &radio), 10);
        let load = rate * AIRTIME_S;
        let expected = (1.0 - load) * (-load).exp();
        measured(&records, delivery).agrees(&format!("{rate} /s"), expected, 0.0, 0.0);
    }
}

/// Per channel a frame is clean with about (1 − 2T/(I + 5 ms))^(n − 1), of n robots that all advertise (T = 376 µs, I = 100 ms). A receiver is on one of three channels.
#[test]
fn ble_advertising() {
    for robots in [10, 50] {
        let radio = "technology: BleAdvertising(interval: 0.1), capture: inf";
        let records = everybody(20.0, "when: Saturated, payload: 31", radio, robots, 8);
        let clean = (1.0_f64 - 2.0 * 376e-6 / 0.105).powi(robots.cast_signed() - 2);
        // A receiver's own event is on air on all three channels in turn.
        let awake = 1.0 - 4.0 * 376e-6 / 0.105;
        // It goes on to another channel in the middle of an event in 2 of 3 of 376 µs in each dwell, and may miss all of it.
        measured(&records, delivery).agrees(&format!("{robots} robots"), clean * awake, 0.0, 0.01);
    }
}

/// Bianchi's τ and p for n saturated robots that send a frame at most seven times, with windows of 32 to 1024 slots.
fn bianchi(robots: i32) -> (f64, f64) {
    let tau = |p: f64| {
        let attempts = (0..7).map(|attempt| p.powi(attempt)).sum::<f64>();
        let slots = (0..7).map(|attempt| p.powi(attempt) * ((32.0 * f64::from(1 << attempt.min(5)) - 1.0) / 2.0 + 1.0));
        attempts / slots.sum::<f64>()
    };
    let [mut low, mut high] = [0.0, 1.0 - 1e-9];
    for _ in 0..100 {
        let p = f64::midpoint(low, high);
        if p < 1.0 - (1.0 - tau(p)).powi(robots - 1) {
            low = p;
        } else {
            high = p;
        }
    }
    (tau(low), low)
}

/// Saturation throughput of DCF (Bianchi, 2000), within 3 %: all slots in step, nobody waits out a timeout.
#[test]
fn saturated_dcf() {
    let [slot, sifs, difs] = [20e-6, 10e-6, 50e-6];
    for (rate, frame, answer, cases) in [
        (1e6, 8480e-6, 304e-6, [(5, 30.0), (20, 60.0), (50, 90.0)]),
        (11e6, 946e-6, 203e-6, [(5, 5.0), (20, 15.0), (50, 20.0)]),
    ] {
        for (robots, seconds) in cases {
            let (tau, _) = bianchi(robots);
            let transmits = 1.0 - (1.0 - tau).powi(robots);
            let succeeds = f64::from(robots) * tau * (1.0 - tau).powi(robots - 1);
            let time = (1.0 - transmits) * slot
                + succeeds * (frame + sifs + answer + difs)
                + (transmits - succeeds) * (frame + difs);
            let expected = succeeds * 8000.0 / time;
            let radio =
                format!("technology: Wifi(standard: B, rate: {rate:?}, acknowledgement_rate: {rate:?}), capture: inf");
            let records = everybody(
                seconds,
                "when: Saturated, payload: 1000, to: Next",
                &radio,
                robots.cast_unsigned(),
                4,
            );
            let goodput = |record: &TrialRecord| {
                let received: u64 = record.traffic.iter().map(|row| row.received.payload_bytes).sum();
                8.0 * received as f64 / record.simulated.as_secs()
            };
            measured(&records, goodput).agrees(&format!("{robots} robots at {rate}"), expected, 0.0, 0.03 * expected);
        }
    }
}

/// The share of frames of 37 bytes that 802.15.4 loses at a mean SNR of 10 dB where each has a gain of its own, exponential: the integral of what it loses at each.
#[test]
fn rayleigh_errors() {
    // 16-ary orthogonal signals, non-coherent: 8/15 · 1/16 · Σ (−1)^k C(16, k) e^(20 s (1/k − 1)).
    let bit_error = |s: f64| {
        let mut choose = 16.0;
        let mut sum = 0.0;
        for k in 2..=16 {
            let k = f64::from(k);
            choose *= (17.0 - k) / k;
            sum += (if k % 2.0 == 0.0 { choose } else { -choose }) * (20.0 * s * (1.0 / k - 1.0)).exp();
        }
        8.0 / 15.0 / 16.0 * sum
    };
    let bits = 8.0 * 37.0;
    for (mean_db, known) in [(4.0, None), (10.0, Some(0.0712)), (16.0, None)] {
        let mean = 10_f64.powf(mean_db / 10.0);
        let step = 1e-4;
        let lost: f64 = (0..400_000)
            .map(|place| (f64::from(place) + 0.5) * step)
            .map(|gain: f64| (1.0 - (1.0 - bit_error(mean * gain).min(0.5)).powf(bits)) * (-gain).exp() * step)
            .sum();
        assert!(known.is_none_or(|known: f64| (lost - known).abs() < 1e-4), "{lost}");
        // The noise is 0.509 dB below the sensitivity.
        let power = mean_db - 95.509 + 50.0;
        let radio = format!(
            "{IEEE802154}, access: Aloha(), fading: Rayleigh(doppler: 5000.0), queue: 1000, \
             path_loss: LogDistance(exponent: 0.000001, reference_loss: 50.0), transmit_power: {power:?}"
        );
        let traffic = "when: Poisson(200.0), payload: 20, senders: Given([0]), to: Robot(1)";
        let records = runs(&with_robots(scenario(60.0, traffic, EVERYBODY, &radio), 2), 6);
        // Of the sum of 32 waves there is a little less often nothing left than of a normal field.
        measured(&records, delivery).agrees(&format!("{mean_db} dB"), 1.0 - lost, 0.0, 0.03 * lost);
    }
}

/// A robot that counts as out of range gets what it gets, and that is counted apart: here three frames in ten. It is neither among the copies offered nor among those delivered.
#[test]
fn robots_out_of_range_hear_now_and_then() {
    for (below_db, chance) in [(0.0, 0.5), (-2.4, 0.3)] {
        // Rayleigh: half of the frames at one level, of e^(−γ/γ̄) = 1/2; three in ten 2.4 dB below that.
        let radio = |power: f64| {
            format!(
                "{IEEE802154}, access: Aloha(), fading: Rayleigh(doppler: 5000.0), queue: 1000, \
                 path_loss: LogDistance(exponent: 0.000001, reference_loss: 50.0), transmit_power: {power:?}"
            )
        };
        let at = |power: f64, seconds: f64, trials: u32| {
            let traffic = "when: Poisson(200.0), payload: 20, senders: Given([0])";
            runs(
                &with_robots(scenario(seconds, traffic, EVERYBODY, &radio(power)), 2),
                trials,
            )
        };
        // The level at which half come through, as the radio itself has it.
        let threshold = (-500..-300)
            .map(|tenths| f64::from(tenths) / 10.0)
            .find(|power| fates(&at(*power, 1.0, 1)[0]).offered > 0)
            .expect("some power suffices");
        let records = at(threshold + below_db, 20.0, 6);
        let strayed = |record: &TrialRecord| {
            let air = record.air.as_ref().expect("a shared radio");
            air.robots[1].strayed as f64 / air.robots[0].on_air as f64
        };
        if below_db < 0.0 {
            assert!(
                records.iter().all(|record| fates(record).offered == 0),
                "nothing is offered"
            );
            measured(&records, strayed).agrees("strayed", chance, 0.0, 0.03);
        } else {
            measured(&records, delivery).agrees("in range", chance, 0.0, 0.03);
            assert!(records.iter().all(|record| strayed(record) == 0.0));
        }
    }
}
