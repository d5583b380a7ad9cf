//! How much of the time frames are on air, second by second.

use std::collections::{BTreeMap, HashMap};

use crate::engine::ActorId;
use crate::happenings::Sent;
use crate::radio::{Conclusion, Phy};

/// What was on air of a run over a radio on which frames take time.
#[derive(Debug, Default)]
pub struct Airtime {
    /// By the second in which a frame began, its messages and the bytes of their payloads: how often such a frame was on air.
    sent: BTreeMap<(u64, u32, u32), u32>,
    /// Bytes of messages that their radio is not done with. Asked by key alone.
    open: HashMap<(ActorId, u32), u16>,
}

impl Airtime {
    pub fn said(&mut self, message: &Sent<'_>) {
        self.open
            .insert((message.sender, message.sequence), message.size.payload_bytes);
    }

    pub fn concluded(&mut self, conclusion: &Conclusion) {
        let (sender, first, messages) = (
            conclusion.frame.sender,
            conclusion.frame.first(),
            conclusion.frame.messages(),
        );
        let bytes = (first..first + messages).filter_map(|sequence| self.open.remove(&(sender, sequence)));
        let bytes: u32 = bytes.map(u32::from).sum();
        if let Some(began) = conclusion.began {
            let second = began.as_nanos() / 1_000_000_000;
            *self.sent.entry((second, messages, bytes)).or_default() += conclusion.attempts;
        }
    }

    /// The seconds of a run of so many, and how much of each all robots together were sending, seconds, with so many bytes of header a message; empty if
    /// nothing was on air.
    pub fn series(&self, phy: &Phy, message_header: u16, seconds: f64) -> Vec<(f64, f64)> {
        if self.sent.is_empty() {
            return Vec::new();
        }
        let mut series: Vec<(f64, f64)> = (0..seconds.ceil() as u64)
            .map(|second| (second as f64 + 1.0, 0.0))
            .collect();
        for (&(second, messages, payload), &times) in &self.sent {
            if let Some((_, sum)) = series.get_mut(second as usize) {
                let bytes = payload + messages * u32::from(message_header);
                *sum += f64::from(times) * phy.airtime(bytes).as_secs();
            }
        }
        series
    }
}
