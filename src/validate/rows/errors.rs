//! Bit errors: frames lost at a given ratio of signal to noise.

use super::{EQUAL_LOSS, Row, WAVES, link};
use crate::validate::forms::errors::{cck5, cck11, dsss1, dsss2, frame, gfsk, needed_db, o_qpsk, ofdm};
use crate::validate::forms::fading::block_rayleigh;
use crate::validate::forms::special::{db, ratio};
use crate::validate::reading;

const MODEL: &str = "bit errors";

/// Noise of a receiver at 290 K, dBm.
fn thermal(bandwidth: f64, figure: f64) -> f64 {
    db(1.380_649e-23 * 290.0 * bandwidth * 1000.0) + figure
}

/// Frames of so many bytes of `payload` at a ratio of `snr_db` over `noise`, dBm, lost with the chance `expected`.
fn row(name: String, technology: &str, noise: f64, snr_db: f64, payload: u32, expected: f64) -> Row {
    let power = noise + snr_db + 50.0;
    // Slow enough for every frame to be over before the next.
    let (seconds, when) = if technology.starts_with("LoRa") {
        (60.0, "Periodic(1.5)")
    } else {
        (25.0, "Periodic(0.005)")
    };
    let radio = format!("technology: {technology}, transmit_power: {power:?}, {EQUAL_LOSS}");
    Row::new(
        MODEL,
        name,
        (expected, ""),
        link(seconds, 1.0, when, payload, &radio),
        reading::lost,
    )
}

pub fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for (payload, snr) in [(4, -2.0), (20, -1.438), (116, -0.5)] {
        let expected = frame(o_qpsk(ratio(snr)), 8 * (17 + payload));
        let row = row(
            format!("errors.802154.{payload}-bytes"),
            "Ieee802154()",
            noise_802154(),
            snr,
            payload,
            expected,
        );
        rows.push(row.form(format!(
            "1 − (1 − BER)^bits, BER = 1/30 Σ (−1)^k C(16, k) e^(20 SNR (1/k − 1)) (IEEE 802.15.4, Annex E), at {snr} dB; 1 % of 20 bytes are lost at the sensitivity"
        )));
    }
    rows.extend(wifi_b());
    rows.extend(wifi_g());
    // Over noise that is given: what it is does not follow from a sensitivity, and the form shows whole.
    let expected = frame(o_qpsk(ratio(-1.438)), 8 * 37);
    let custom = "Custom(header_bytes: 17, noise: Some(-100.0), modulation: OQpsk)";
    let row_of_noise = row("errors.o-qpsk".to_owned(), custom, -100.0, -1.438, 20, expected);
    rows.push(row_of_noise.form("the same form, 37 bytes at −1.438 dB over a given noise"));
    let expected = frame(gfsk(ratio(9.0)), 8 * 31);
    let custom = "Custom(bit_rate: Some(1e6), noise: Some(-100.0), modulation: Gfsk)";
    rows.push(
        row("errors.gfsk".to_owned(), custom, -100.0, 9.0, 31, expected).form("BER = ½ e^(−Eb/2N0), 31 bytes at 9 dB"),
    );
    rows.extend(lora());
    rows.push(faded());
    rows
}

/// By the definition of the sensitivity, −95 dBm: 26 bytes are lost with 1 %.
fn noise_802154() -> f64 {
    -95.0 - needed_db(o_qpsk, 8 * 26, 0.01)
}

/// A rate in Mb/s and as scenarios have it, its bit errors, their form, and a ratio in dB.
type Case = (&'static str, &'static str, fn(f64) -> f64, &'static str, f64);

fn wifi_b() -> Vec<Row> {
    let noise = thermal(22e6, 7.0);
    let payload = 200;
    let cases: [Case; 4] = [
        ("1", "1e6", dsss1, "½ e^(−22 SNR)", -4.0),
        (
            "2",
            "2e6",
            dsss2,
            "(√2 + 1)/√(8π√2) E^(−½) e^(−(2 − √2)E), E = 11 SNR",
            0.0,
        ),
        (
            "5.5",
            "5.5e6",
            cck5,
            "errors of CCK as 8 biorthogonal pairs, energy 8 SNR (Proakis)",
            2.5,
        ),
        (
            "11",
            "11e6",
            cck11,
            "errors of CCK as 8 biorthogonal pairs, energy 4 SNR (Proakis)",
            5.5,
        ),
    ];
    let row = |(mbps, rate, error, form, snr): Case| {
        let ratio = ratio(snr);
        // Behind the header, 48 bits at 1 Mb/s.
        let rest = 1.0 - frame(error(ratio), 8 * (36 + payload));
        let expected = 1.0 - (1.0 - frame(dsss1(ratio), 48)) * rest;
        let technology = format!("Wifi(standard: B, rate: Some({rate}))");
        row(
            format!("errors.wifi-b.{mbps}-mbps"),
            &technology,
            noise,
            snr,
            payload,
            expected,
        )
        .form(format!("{form}, 200 bytes at {snr} dB in 22 MHz"))
    };
    cases.into_iter().map(row).collect()
}

fn wifi_g() -> Vec<Row> {
    let noise = thermal(20e6, 7.0);
    let payload = 200;
    let row = |(mbps, snr): (u32, f64)| {
        let ratio = ratio(snr);
        let rest = 1.0 - frame(ofdm(mbps, ratio), 22 + 8 * (36 + payload));
        let expected = 1.0 - (1.0 - frame(ofdm(6, ratio), 24)) * rest;
        let technology = format!("Wifi(standard: G, rate: Some({mbps}e6))");
        row(format!("errors.wifi-g.{mbps}-mbps"), &technology, noise, snr, payload, expected).form(format!(
            "union bound Σ a_d D^d behind hard decisions of the code of 802.11 (Frenger et al., 1999), 200 bytes at {snr} dB in 20 MHz"
        ))
    };
    [
        (6, 3.3),
        (9, 6.2),
        (12, 6.3),
        (18, 9.2),
        (24, 12.8),
        (36, 15.9),
        (48, 20.7),
        (54, 22.0),
    ]
    .into_iter()
    .map(row)
    .collect()
}

fn lora() -> Vec<Row> {
    let noise = thermal(125e3, 6.0);
    let row = |(spreading, beyond, where_it_is, expected): (u32, f64, &str, f64)| {
        let snr = 10.0 - 2.5 * f64::from(spreading) + beyond;
        let technology = format!("LoRa(spreading: {spreading})");
        row(
            format!("errors.lora.sf{spreading}-{where_it_is}"),
            &technology,
            noise,
            snr,
            20,
            expected,
        )
        .exact()
        .form("all above, none below −7.5 dB at spreading factor 7 and 2.5 dB less for each more (SX1276 data sheet)")
    };
    [
        (7, 0.05, "above", 0.0),
        (7, -0.05, "below", 1.0),
        (12, 0.05, "above", 0.0),
        (12, -0.05, "below", 1.0),
    ]
    .into_iter()
    .map(row)
    .collect()
}

/// Each frame has a gain of its own.
fn faded() -> Row {
    let mean_db = 10.0;
    let expected = block_rayleigh(ratio(mean_db), |snr| frame(o_qpsk(snr), 296));
    let technology = "Ieee802154(), fading: Rayleigh(doppler: 5000.0)";
    row(
        "errors.802154.rayleigh".to_owned(),
        technology,
        noise_802154(),
        mean_db,
        20,
        expected,
    )
    .trials(40)
    .form("∫ PER(10 g) e^(−g) dg: 20 bytes, block fading at 10 dB on average")
    .give_or_take(expected / 64.0, WAVES)
}
