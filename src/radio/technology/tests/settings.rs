//! What is set and what follows from it.

use super::*;
use crate::quantity::Probability;

/// −95 − 0.5087; −95 − 10.944; kTB at 22 MHz −100.551, at 20 MHz −100.965, at 125 kHz −123.006.
#[test]
fn noise_and_sensitivity_are_tied_by_each_technologys_own_definition() {
    let figures = |config: &TechnologyConfig| {
        let phy = config.phy();
        [phy.noise, phy.sensitivity]
    };
    let near = |found: [f64; 2], expected: [f64; 2]| {
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 2e-3, "{found} is not {expected}");
        }
    };
    near(figures(&TechnologyConfig::default()), [-95.5087, -95.0]);
    near(
        figures(&TechnologyConfig::BleAdvertising(BleAdvertisingConfig::default())),
        [-105.944, -95.0],
    );
    let wifi = |standard, rate| figures(&TechnologyConfig::Wifi(wifi(standard, rate)));
    for (rate, required) in [(1e6, -3.089), (2e6, 1.553), (5.5e6, 4.083), (11e6, 7.093)] {
        near(wifi(WifiStandard::B, rate), [-93.551, -93.551 + required]);
    }
    let required = [3.847, 6.734, 6.857, 9.744, 13.381, 16.484, 21.229, 22.487];
    for (rate, required) in [6e6, 9e6, 12e6, 18e6, 24e6, 36e6, 48e6, 54e6].into_iter().zip(required) {
        near(wifi(WifiStandard::G, rate), [-93.965, -93.965 + required]);
    }
    for (spreading, sensitivity) in (7..=12).zip([-124.506, -127.006, -129.506, -132.006, -134.506, -137.006]) {
        near(
            figures(&TechnologyConfig::LoRa(lora(spreading))),
            [-117.006, sensitivity],
        );
    }
}

#[test]
fn every_problem_is_reported_at_its_field_with_its_remedy() {
    let of = |config: TechnologyConfig| config.problems();
    let rate = |rate| Some(Positive::new(rate));
    let lora_of = |change: fn(&mut LoRaConfig)| {
        let mut config = LoRaConfig::default();
        change(&mut config);
        of(TechnologyConfig::LoRa(config))
    };
    let cases = [
        (
            of(TechnologyConfig::Wifi(wifi(WifiStandard::B, 6e6))),
            "rate",
            "802.11b has no rate of 6e6 bits a second; expected one of 1e6, 2e6, 5.5e6, 1.1e7",
        ),
        (
            of(TechnologyConfig::Wifi(WifiConfig {
                acknowledgement_rate: rate(1e6),
                ..wifi(WifiStandard::G, 6e6)
            })),
            "acknowledgement_rate",
            "802.11g has no rate of 1e6",
        ),
        (
            of(TechnologyConfig::Wifi(WifiConfig {
                preamble: WifiPreamble::Short,
                ..WifiConfig::default()
            })),
            "preamble",
            "use Long, or a rate of 2e6",
        ),
        (
            of(TechnologyConfig::Wifi(WifiConfig {
                preamble: WifiPreamble::Short,
                ..wifi(WifiStandard::G, 6e6)
            })),
            "preamble",
            "leave `preamble` out",
        ),
        (
            of(TechnologyConfig::BleAdvertising(BleAdvertisingConfig {
                interval: Positive::new(0.01),
                ..BleAdvertisingConfig::default()
            })),
            "interval",
            "expected 0.02 to 10485.759375 s",
        ),
        (lora_of(|config| config.spreading = 6), "spreading", "expected 7 to 12"),
        (
            lora_of(|config| config.spreading = 200),
            "spreading",
            "expected 7 to 12",
        ),
        (
            lora_of(|config| config.bandwidth = Positive::new(100e3)),
            "bandwidth",
            "1.25e5, 2.5e5, 5e5",
        ),
        (
            lora_of(|config| config.coding_rate = 0),
            "coding_rate",
            "expected 1 (4/5)",
        ),
        (lora_of(|config| config.preamble = 5), "preamble", "expected 6 to 65535"),
        (
            lora_of(|config| config.duty_cycle = Some(Probability::new(0.0))),
            "duty_cycle",
            "None for no limit",
        ),
        (
            of(TechnologyConfig::ArgosRab(ArgosRabConfig {
                payload: 0,
                ..ArgosRabConfig::default()
            })),
            "payload",
            "expected 1 to",
        ),
        (
            of(TechnologyConfig::Kilobot(KilobotConfig {
                bit_cycles: 0,
                ..KilobotConfig::default()
            })),
            "bit_cycles",
            "expected 1 to",
        ),
        (
            of(TechnologyConfig::Custom(CustomConfig {
                max_payload: 0,
                ..CustomConfig::default()
            })),
            "max_payload",
            "expected 1 to",
        ),
    ];
    for (found, field, part) in cases {
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].0, field);
        assert!(found[0].1.contains(part), "{}", found[0].1);
    }
    for preset in presets() {
        assert_eq!(preset.problems(), [], "{preset:?}");
    }
}

#[test]
#[should_panic(expected = "the technology is unusable")]
fn a_technology_with_problems_is_refused() {
    let _ = TechnologyConfig::LoRa(lora(13)).phy();
}

#[test]
fn a_technology_is_read_as_it_is_written() {
    for preset in presets() {
        let text = serde_json::to_string(&preset).expect("a technology can be written");
        assert_eq!(
            serde_json::from_str::<TechnologyConfig>(&text).expect("and read"),
            preset
        );
    }
}

/// As a scenario file has it: structs in place of the variants' only fields, options without `Some`.
fn read(text: &str) -> Result<TechnologyConfig, ron::error::SpannedError> {
    use ron::extensions::Extensions;
    let options =
        ron::Options::default().with_default_extension(Extensions::UNWRAP_VARIANT_NEWTYPES | Extensions::IMPLICIT_SOME);
    options.from_str(text)
}

#[test]
fn a_technology_is_a_few_words_in_a_scenario() {
    for (text, expected) in [
        ("Ieee802154()", TechnologyConfig::default()),
        (
            "Wifi(standard: G, rate: 6e6)",
            TechnologyConfig::Wifi(wifi(WifiStandard::G, 6e6)),
        ),
        (
            "LoRa(spreading: 9, duty_cycle: None)",
            TechnologyConfig::LoRa(LoRaConfig {
                duty_cycle: None,
                ..lora(9)
            }),
        ),
        (
            "Custom(bit_rate: None, modulation: OQpsk, noise: -100.0, supply: (volts: 3.0))",
            TechnologyConfig::Custom(CustomConfig {
                bit_rate: None,
                modulation: Modulation::OQpsk,
                noise: Some(Finite::new(-100.0)),
                supply: Supply::new(3.0, [0.0; 5]),
                ..CustomConfig::default()
            }),
        ),
        (
            "Custom(modulation: Threshold(-3.0))",
            TechnologyConfig::Custom(CustomConfig {
                modulation: Modulation::Threshold(Finite::new(-3.0)),
                ..CustomConfig::default()
            }),
        ),
    ] {
        assert_eq!(read(text).as_ref(), Ok(&expected), "{text}");
    }
    for wrong in ["Ieee802154(bandwith: 2e6)", "Kilobot(range: -1.0)", "Zigbee()"] {
        assert!(read(wrong).is_err(), "{wrong}");
    }
}
