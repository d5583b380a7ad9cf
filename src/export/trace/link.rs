//! What frames look like on air: the link types of a capture, and the headers that stand for those that were accounted.

use crate::engine::SimTime;
use crate::happenings::log::Frame;
use crate::radio::technology::WifiStandard;
use crate::radio::{RadioConfig, TechnologyConfig};

/// The PAN of all frames over IEEE 802.15.4: one by which a dissector finds them.
pub const PAN: u16 = 0xcafe;
/// The type of the payloads of Wi-Fi frames: the first that IEEE 802 leaves to local experiments.
pub const ETHER_TYPE: u16 = 0x88b5;
/// In place of a robot where there is none: everybody.
pub const EVERYBODY: u32 = u32::MAX;
/// Robots that 802.15.4 has short addresses for.
const SHORT_ADDRESSES: u32 = 0xfffe;

/// How a capture shows frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Link {
    /// IEEE 802.15.4: the MAC frame without its check sum, behind a TAP header that says which channel and when the frame went on air.
    Ieee802154 {
        /// The number of the channel.
        channel: u16,
        /// Whether frames to one robot ask for an acknowledgement.
        acknowledged: bool,
    },
    /// Wi-Fi: the MAC frame without its check sum, behind a radiotap header.
    Wifi {
        /// Carrier, MHz.
        megahertz: u16,
        /// Whether frames are those of 802.11g.
        ofdm: bool,
        /// Rate, in units of 500 kb/s.
        rate: u8,
    },
    /// Neither: the messages behind a header of desim's own, which says who sent them to whom.
    Own,
}

impl Link {
    /// Those of `radio`, between so many robots.
    #[must_use]
    pub fn of(radio: &RadioConfig, robots: u32) -> Self {
        let Some(shared) = radio.shared() else { return Self::Own };
        match &shared.technology {
            TechnologyConfig::Ieee802154(config) if robots <= SHORT_ADDRESSES => Self::Ieee802154 {
                channel: channel(config.frequency.get()),
                acknowledged: shared.access().acknowledges(),
            },
            TechnologyConfig::Wifi(config) => Self::Wifi {
                megahertz: (config.frequency.get() / 1e6).round().clamp(0.0, 65_535.0) as u16,
                ofdm: config.standard == WifiStandard::G,
                rate: (config.bits_a_second() / 500e3).round() as u8,
            },
            _ => Self::Own,
        }
    }

    /// The number that captures have for it.
    #[must_use]
    pub const fn number(self) -> u16 {
        match self {
            Self::Ieee802154 { .. } => 283,
            Self::Wifi { .. } => 127,
            Self::Own => 147,
        }
    }

    /// What it is called.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ieee802154 { .. } => "IEEE 802.15.4 TAP",
            Self::Wifi { .. } => "IEEE 802.11 radiotap",
            Self::Own => "USER0",
        }
    }

    /// Bytes in front of the messages.
    #[must_use]
    pub fn header_bytes(self) -> usize {
        let nothing = Frame {
            at: SimTime::ZERO,
            sender: crate::engine::ActorId(0),
            number: 0,
            messages: Vec::new(),
            payloads: Vec::new(),
            sending: None,
            offered: 0,
            delivered: 0,
            lost: Default::default(),
        };
        let mut bytes = Vec::new();
        self.put_header(&nothing, &mut bytes);
        bytes.len()
    }

    /// Appends what stands in front of the messages of `frame`.
    pub fn put_header(self, frame: &Frame, into: &mut Vec<u8>) {
        match self {
            Self::Ieee802154 { channel, acknowledged } => {
                put_tap(channel, began(frame), into);
                put_mac_154(frame, acknowledged, into);
            }
            Self::Wifi { megahertz, ofdm, rate } => {
                put_radiotap(megahertz, ofdm, rate, into);
                put_mac_11(frame, into);
            }
            Self::Own => {
                for number in [frame.sender.0, frame.to().map_or(EVERYBODY, |to| to.0), frame.number] {
                    into.extend(number.to_be_bytes());
                }
            }
        }
    }
}

/// When a frame went on air, or, over a radio that does not tell or if it never did, was handed over.
fn began(frame: &Frame) -> SimTime {
    frame.sending.and_then(|sending| sending.began).unwrap_or(frame.at)
}

/// The channel at 2.4 GHz that is nearest (IEEE 802.15.4-2011, clause 8.1.2.2).
fn channel(frequency: f64) -> u16 {
    ((frequency / 1e6 - 2405.0) / 5.0 + 11.0).round().clamp(11.0, 26.0) as u16
}

/// The header of LINKTYPE_IEEE802_15_4_TAP: fields of type, length and value, each padded to four bytes.
fn put_tap(channel: u16, began: SimTime, into: &mut Vec<u8>) {
    let start = into.len();
    into.extend([0, 0, 0, 0]);
    let mut field = |kind: u16, value: &[u8]| {
        into.extend(kind.to_le_bytes());
        into.extend((value.len() as u16).to_le_bytes());
        into.extend(value);
        into.resize(into.len().next_multiple_of(4), 0);
    };
    // No check sum behind the frame; its channel, of page 0; the start of the frame, nanoseconds.
    field(0, &[0]);
    let [low, high] = channel.to_le_bytes();
    field(3, &[low, high, 0]);
    field(5, &began.as_nanos().to_le_bytes());
    let length = (into.len() - start) as u16;
    into[start + 2..start + 4].copy_from_slice(&length.to_le_bytes());
}

/// Frame control, number, PAN, both short addresses (IEEE 802.15.4-2011, clause 5.2.1): a data frame within one PAN.
fn put_mac_154(frame: &Frame, acknowledged: bool, into: &mut Vec<u8>) {
    let to = frame.to();
    let asks = if acknowledged && to.is_some() { 0x20 } else { 0 };
    into.extend([0x41 | asks, 0x88, frame.number as u8]);
    into.extend(PAN.to_le_bytes());
    into.extend(to.map_or(0xffff, |to| to.0 as u16).to_le_bytes());
    into.extend((frame.sender.0 as u16).to_le_bytes());
}

/// Flags, rate and channel, as radiotap.org has them.
fn put_radiotap(megahertz: u16, ofdm: bool, rate: u8, into: &mut Vec<u8>) {
    const PRESENT: u32 = 1 << 1 | 1 << 2 | 1 << 3;
    const GHZ_2: u16 = 0x80;
    let modulation: u16 = if ofdm { 0x40 } else { 0x20 };
    into.extend([0, 0, 14, 0]);
    into.extend(PRESENT.to_le_bytes());
    into.extend([0, rate]);
    into.extend(megahertz.to_le_bytes());
    into.extend((GHZ_2 | modulation).to_le_bytes());
}

/// A data frame between stations without an access point (IEEE 802.11-2016, clause 9.3.2.1), and the link control behind it.
fn put_mac_11(frame: &Frame, into: &mut Vec<u8>) {
    let station = |robot: u32| {
        let [a, b, c, d] = robot.to_be_bytes();
        [0x02, 0x00, a, b, c, d]
    };
    into.extend([0x08, 0x00, 0x00, 0x00]);
    into.extend(frame.to().map_or([0xff; 6], |to| station(to.0)));
    into.extend(station(frame.sender.0));
    into.extend([0x02, 0xde, 0x51, 0x00, 0x00, 0x00]);
    into.extend((((frame.number & 0xfff) as u16) << 4).to_le_bytes());
    into.extend([0xaa, 0xaa, 0x03, 0x00, 0x00, 0x00]);
    into.extend(ETHER_TYPE.to_be_bytes());
}
