//! How long frames are on air, in microseconds, as the standards and data sheets have it.

/// IEEE 802.15.4 at 250 kb/s: (6 + 11 + payload) · 32 µs.
pub fn ieee802154(payload: u32) -> f64 {
    32.0 * f64::from(6 + 11 + payload)
}

/// IEEE 802.11b at `rate` Mb/s with a long preamble: 192 + ⌈8(24 + 8 + payload + 4)/rate⌉ µs.
pub fn dsss(payload: u32, rate: f64) -> f64 {
    192.0 + (f64::from(8 * (payload + 36)) / rate).ceil()
}

/// IEEE 802.11g at `rate` Mb/s: 20 + 4⌈(22 + 8(36 + payload))/4 rate⌉ + 6 µs.
pub fn ofdm(payload: u32, rate: f64) -> f64 {
    26.0 + 4.0 * (f64::from(22 + 8 * (payload + 36)) / (4.0 * rate)).ceil()
}

/// LoRa in 125 kHz, eight symbols of preamble, code 4/5, explicit header, check sum (SX1276 data sheet).
pub fn lora(payload: i32, spreading: i32) -> f64 {
    let symbol = f64::from(1 << spreading) / 0.125;
    let slow = i32::from(symbol >= 16_000.0);
    let bits = f64::from(8 * payload - 4 * spreading + 28 + 16);
    let blocks = (bits / f64::from(4 * (spreading - 2 * slow))).ceil().max(0.0);
    symbol * (8.0 + 4.25 + 8.0 + 5.0 * blocks)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn airtimes_are_those_of_the_data_sheets() {
        let found = [
            ieee802154(20),
            dsss(20, 1.0),
            dsss(1000, 11.0),
            ofdm(20, 6.0),
            lora(20, 7),
            lora(20, 12),
        ];
        for (found, known) in found
            .into_iter()
            .zip([1184.0, 640.0, 946.0, 106.0, 56_576.0, 1_318_912.0])
        {
            assert!((found - known).abs() < 1e-6, "{found} for {known}");
        }
    }
}
