//! Frames that take no time, meet no other and lose no bit: then the shared radio is a disk.

use desim::metrics::TrialRecord;
use proptest::prelude::*;

use super::runs;
use desim::scenario::parse;

fn run(radio: &str, robots: u32, seed: u64, protocol: &str) -> TrialRecord {
    let text = format!(
        "Scenario(name: \"disk\", seed: {seed}, time_limit: 8.0, arena: (size: (8.0, 5.0)), \
         swarm: (robots: {robots}, deploy: Uniform), {protocol}, radio: {radio})"
    );
    let scenario = parse("disk.ron", &text, &[]).unwrap_or_else(|report| panic!("{text}\n{report}"));
    runs(&scenario, 1).remove(0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    /// Of the range at which its sensitivity is reached: −60 dBm are left of 0 dBm after 20 dB and 30 dB a decade at 10^(40/30) m.
    #[test]
    fn without_airtime_noise_and_access_it_is_a_disk(robots in 2_u32..40, seed in any::<u64>(), loss in 43.0..52.0_f64) {
        let range = 10_f64.powf((loss - 40.0) / 30.0);
        let sensitivity = -loss;
        let shared = format!(
            "Shared(technology: Custom(bit_rate: None, sensitivity: {sensitivity:?}, header_bytes: 2), access: None, message_header_bytes: 3, \
             path_loss: LogDistance(exponent: 3.0, reference_loss: 40.0), transmit_power: 0.0)"
        );
        let disk = format!("(range: {range:?}, latency: Constant(0.0))");
        for protocol in ["protocol: Heartbeat, detector: Timeout(0.5), wander: RandomWaypoint(speed: 0.02)", "protocol: Rumor(mode: Push, rounds: Poisson, completion: Reached)"] {
            let [shared, disk] = [&shared, &disk].map(|radio| run(radio, robots, seed, protocol));
            prop_assert_eq!(&shared.ledger, &disk.ledger);
            prop_assert_eq!(shared.digest, disk.digest, "{} robots, {} m, {}", robots, range, protocol);
        }
    }
}
