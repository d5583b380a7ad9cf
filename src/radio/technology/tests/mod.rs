mod settings;

use super::*;
use crate::quantity::{Finite, Positive};
use crate::radio::Modulation;

fn wifi(standard: WifiStandard, rate: f64) -> WifiConfig {
    WifiConfig {
        standard,
        rate: Some(Positive::new(rate)),
        ..WifiConfig::default()
    }
}

fn lora(spreading: u8) -> LoRaConfig {
    LoRaConfig {
        spreading,
        ..LoRaConfig::default()
    }
}

fn airtime_ns(config: &TechnologyConfig, payload: u32) -> u64 {
    config.phy().airtime(payload).as_nanos()
}

fn acknowledgement_ns(config: WifiConfig) -> u64 {
    let acknowledgement = TechnologyConfig::Wifi(config).phy().acknowledgement();
    acknowledgement.map_or(0, |frame| frame.airtime().as_nanos())
}

/// One of each technology.
fn presets() -> Vec<TechnologyConfig> {
    let mut all = vec![
        TechnologyConfig::default(),
        TechnologyConfig::BleAdvertising(BleAdvertisingConfig::default()),
        TechnologyConfig::ArgosRab(ArgosRabConfig::default()),
        TechnologyConfig::EPuck(EPuckConfig::default()),
        TechnologyConfig::Kilobot(KilobotConfig::default()),
        TechnologyConfig::Custom(CustomConfig::default()),
        TechnologyConfig::Wifi(WifiConfig {
            preamble: WifiPreamble::Short,
            ..wifi(WifiStandard::B, 11e6)
        }),
    ];
    let rates = [1e6, 2e6, 5.5e6, 11e6].map(|rate| wifi(WifiStandard::B, rate));
    all.extend(rates.map(TechnologyConfig::Wifi));
    let rates = [6e6, 9e6, 12e6, 18e6, 24e6, 36e6, 48e6, 54e6].map(|rate| wifi(WifiStandard::G, rate));
    all.extend(rates.map(TechnologyConfig::Wifi));
    all.extend((7..=12).map(|spreading| TechnologyConfig::LoRa(lora(spreading))));
    all
}

#[test]
fn an_802154_frame_of_20_bytes_is_on_air_for_1184_us_and_one_of_100_for_3744() {
    let airtime = |payload| airtime_ns(&TechnologyConfig::default(), payload);
    assert_eq!(
        [0, 20, 100, 116].map(airtime),
        [544_000, 1_184_000, 3_744_000, 4_256_000]
    );
    let phy = TechnologyConfig::default().phy();
    let acknowledgement = phy.acknowledgement().expect("the standard has one");
    assert_eq!(acknowledgement.airtime().as_nanos(), 352_000);
    assert_eq!(acknowledgement.sections().map(|section| section.bits).sum::<u32>(), 88);
    assert_eq!((phy.header_bytes, phy.max_payload), (17, 116));
    assert_eq!(phy.sections(20).map(|section| section.bits).collect::<Vec<_>>(), [296]);
}

#[test]
fn an_80211b_frame_has_a_preamble_a_header_at_1_mbps_and_the_rest_in_whole_microseconds() {
    let of = |config| TechnologyConfig::Wifi(config);
    assert_eq!(airtime_ns(&of(wifi(WifiStandard::B, 1e6)), 20), 640_000);
    assert_eq!(airtime_ns(&of(wifi(WifiStandard::B, 2e6)), 20), 416_000);
    // 448 bits at 5.5 Mb/s are 81.45 µs; 8288 at 11 Mb/s 753.45.
    assert_eq!(airtime_ns(&of(wifi(WifiStandard::B, 5.5e6)), 20), 274_000);
    assert_eq!(airtime_ns(&of(wifi(WifiStandard::B, 11e6)), 1000), 946_000);
    let short = WifiConfig {
        preamble: WifiPreamble::Short,
        ..wifi(WifiStandard::B, 11e6)
    };
    assert_eq!(airtime_ns(&of(short.clone()), 1000), 850_000);

    let parts = |config| {
        let sections = TechnologyConfig::Wifi(config).phy().sections(1000);
        sections
            .map(|section| (section.airtime.as_nanos() / 1000, section.bits, section.modulation))
            .collect::<Vec<_>>()
    };
    assert_eq!(
        parts(wifi(WifiStandard::B, 11e6)),
        [
            (144, 0, Modulation::None),
            (48, 48, Modulation::Dsss1),
            (754, 8288, Modulation::Cck11)
        ]
    );
    assert_eq!(
        parts(short),
        [
            (72, 0, Modulation::None),
            (24, 48, Modulation::Dsss2),
            (754, 8288, Modulation::Cck11)
        ]
    );
    let headers = |preamble| {
        let config = WifiConfig {
            preamble,
            ..wifi(WifiStandard::B, 2e6)
        };
        TechnologyConfig::Wifi(config).phy().header_bytes
    };
    assert_eq!(
        [WifiPreamble::Long, WifiPreamble::Short].map(headers),
        [24 + 24 + 8 + 4, 15 + 24 + 8 + 4]
    );
}

#[test]
fn an_80211g_frame_fills_symbols_of_4_us_and_ends_with_a_pause_of_6() {
    let airtime = |rate| airtime_ns(&TechnologyConfig::Wifi(wifi(WifiStandard::G, rate)), 20);
    assert_eq!([6e6, 24e6, 54e6].map(airtime), [106_000, 46_000, 38_000]);
    let phy = TechnologyConfig::Wifi(wifi(WifiStandard::G, 24e6)).phy();
    let parts: Vec<_> = phy
        .sections(20)
        .map(|section| (section.airtime.as_nanos() / 1000, section.bits, section.modulation))
        .collect();
    assert_eq!(
        parts,
        [
            (16, 0, Modulation::None),
            (4, 24, Modulation::Ofdm6),
            (20, 22 + 8 * 56, Modulation::Ofdm24),
            (6, 0, Modulation::None)
        ]
    );
}

#[test]
fn wifi_acknowledges_at_a_rate_that_every_station_knows_unless_told_otherwise() {
    assert_eq!(acknowledgement_ns(wifi(WifiStandard::B, 1e6)), 304_000);
    assert_eq!(acknowledgement_ns(wifi(WifiStandard::B, 11e6)), 304_000);
    let short = WifiConfig {
        preamble: WifiPreamble::Short,
        ..wifi(WifiStandard::B, 11e6)
    };
    assert_eq!(acknowledgement_ns(short), 304_000, "no short preamble goes with 1 Mb/s");
    let at_data_rate = WifiConfig {
        acknowledgement_rate: Some(Positive::new(11e6)),
        ..wifi(WifiStandard::B, 11e6)
    };
    assert_eq!(acknowledgement_ns(at_data_rate), 203_000);
    let g = [6e6, 9e6, 12e6, 18e6, 24e6, 54e6].map(|rate| acknowledgement_ns(wifi(WifiStandard::G, rate)));
    assert_eq!(g, [50_000, 50_000, 38_000, 38_000, 34_000, 34_000]);
    let fast = WifiConfig {
        acknowledgement_rate: Some(Positive::new(54e6)),
        ..wifi(WifiStandard::G, 54e6)
    };
    assert_eq!(acknowledgement_ns(fast), 30_000);
}

#[test]
fn an_advertisement_is_on_air_for_128_us_and_8_for_each_byte() {
    let airtime = |payload| {
        let config = BleAdvertisingConfig::default();
        airtime_ns(&TechnologyConfig::BleAdvertising(config), payload)
    };
    assert_eq!([0, 31].map(airtime), [128_000, 376_000]);
    let phy = TechnologyConfig::BleAdvertising(BleAdvertisingConfig::default()).phy();
    assert_eq!((phy.header_bytes, phy.max_payload), (16, 31));
    assert!(phy.acknowledgement().is_none() && phy.assess.is_none());
}

#[test]
fn a_lora_frame_is_on_air_as_the_data_sheet_says() {
    let airtime = |spreading, payload| airtime_ns(&TechnologyConfig::LoRa(lora(spreading)), payload);
    assert_eq!(
        [7, 8, 9, 10, 11, 12].map(|spreading| airtime(spreading, 20)),
        [
            56_576_000,
            102_912_000,
            185_344_000,
            370_688_000,
            741_376_000,
            1_318_912_000
        ]
    );
    assert_eq!((airtime(12, 51), airtime(7, 13)), (2_465_792_000, 46_336_000));
    // The same frame with the optimisation: 35 symbols of payload become 43.
    let slow = LoRaConfig {
        low_data_rate: Some(true),
        ..lora(7)
    };
    let more = airtime_ns(&TechnologyConfig::LoRa(slow), 20) - airtime(7, 20);
    assert_eq!(more, 5 * 2 * 1_024_000);
    // Nothing but the last six symbols of the preamble, and what comes after them, matters.
    let sections: Vec<_> = TechnologyConfig::LoRa(lora(7)).phy().sections(20).collect();
    assert_eq!((sections[0].airtime.as_nanos(), sections[0].bits), (2 * 1_024_000, 0));
    assert_eq!(
        (sections[1].bits, sections[1].modulation),
        (200, Modulation::Threshold(Finite::new(-7.5)))
    );
}

#[test]
fn light_takes_the_time_that_firmware_takes() {
    assert_eq!(
        airtime_ns(&TechnologyConfig::Kilobot(KilobotConfig::default()), 3),
        4_160_000
    );
    let later = KilobotConfig {
        bit_cycles: 269,
        ..KilobotConfig::default()
    };
    assert_eq!(airtime_ns(&TechnologyConfig::Kilobot(later), 9), 4_371_250);
    assert_eq!(
        airtime_ns(&TechnologyConfig::EPuck(EPuckConfig::default()), 2),
        5_000_000
    );
    assert_eq!(
        airtime_ns(&TechnologyConfig::ArgosRab(ArgosRabConfig::default()), 10),
        0
    );
}

#[test]
fn a_radio_of_no_standard_may_take_no_time() {
    let custom = |bit_rate: Option<f64>| {
        let config = CustomConfig {
            bit_rate: bit_rate.map(Positive::new),
            header_bytes: 5,
            acknowledgement_bytes: Some(5),
            ..CustomConfig::default()
        };
        TechnologyConfig::Custom(config).phy()
    };
    let at_once = custom(None);
    assert_eq!(at_once.airtime(1000).as_nanos(), 0);
    assert_eq!(at_once.sections(1000).map(|section| section.bits).sum::<u32>(), 8040);
    let slow = custom(Some(1e3));
    assert_eq!(slow.airtime(20).as_nanos(), 200_000_000);
    assert_eq!(
        slow.acknowledgement().map(|frame| frame.airtime().as_nanos()),
        Some(40_000_000)
    );
    assert!(slow.noise == f64::NEG_INFINITY && slow.infrared.is_none());
}

#[test]
fn a_frame_lasts_as_long_as_its_sections_and_no_shorter_than_one_with_less_in_it() {
    for preset in presets() {
        let phy = preset.phy();
        let mut before = 0;
        for payload in 0..=phy.max_payload.min(300) {
            let airtime = phy.airtime(payload).as_nanos();
            assert_eq!(
                airtime,
                phy.sections(payload)
                    .map(|section| section.airtime.as_nanos())
                    .sum::<u64>()
            );
            assert!(airtime >= before, "{preset:?}: {payload} bytes");
            before = airtime;
            let bits: u32 = phy.sections(payload).map(|section| section.bits).sum();
            assert!(bits >= 8 * payload, "{preset:?}: {payload} bytes");
        }
    }
}
