//! What a receiver makes of what reaches its antenna: noise, overlaps, capture, locking, bit errors.
//!
//! A reception is judged once, when its frame ends. Between the instants at which something else begins or ends the ratio of signal to
//! interference and noise is constant, so the probability that all bits are right is a product over these chunks; one keyed number decides. The better the
//! ratio the greater is that probability, and what survives in worse conditions survives in better ones.

use std::sync::Arc;

use super::burst::{Burst, Content};
use super::ear::{Ear, Heard};
use crate::engine::{ActorId, KeyedStreams, Purpose, SimTime, Span, Streams};
use crate::radio::draw::unit_interval;
use crate::radio::memo::Memo;
use crate::radio::technology::{Phy, Waveform};
use crate::radio::{ErrorTable, LossCause, Modulation};

/// What survives the bit errors is drawn from here: by sender, receiver and frame. Acknowledgements have their own draws.
const ERRORS: Purpose = Purpose::new("radio.errors");
const ACKNOWLEDGEMENTS: Purpose = Purpose::new("radio.acknowledgements");

const INSTANT: Span = Span::from_nanos(1);

/// The receivers of a run: all alike. Powers are in milliwatts, ratios plain.
#[derive(Debug)]
pub(super) struct Receiver {
    noise: f64,
    sensitivity: f64,
    /// From which energy on the channel is busy, and from which power of a single frame.
    assess: Option<f64>,
    carrier: Option<f64>,
    lock: f64,
    capture: Option<f64>,
    /// Whether frames do not disturb each other at all.
    orthogonal: bool,
    /// How long a frame must have been on air before it is noticed.
    latency: Span,
    /// The share of frames that nothing modelled drops.
    kept: f64,
    phy: Phy,
    /// How its modulations survive, and the ratio from which on none of them errs.
    tables: Tables,
    certain: f32,
    errors: KeyedStreams,
    acknowledgements: KeyedStreams,
}

impl Receiver {
    /// Those of `phy`, with so much noise beside their own. `orthogonal`: whether frames do not disturb each other; `latency`: how long one must have been on air
    /// before it is noticed.
    pub fn new(phy: &Phy, orthogonal: bool, latency: Span, background: f64, streams: Streams) -> Self {
        let tables = Tables::of(phy);
        Self {
            noise: milliwatts(phy.noise) + background,
            sensitivity: milliwatts(phy.sensitivity),
            assess: phy.assess.map(milliwatts),
            carrier: phy.carrier.or(phy.assess).map(milliwatts),
            lock: ratio(phy.lock),
            capture: phy.capture.map(ratio),
            orthogonal,
            latency,
            kept: phy.infrared.map_or(1.0, |infrared| 1.0 - infrared.drop),
            certain: tables.certain(),
            tables,
            phy: phy.clone(),
            errors: streams.keyed(ERRORS),
            acknowledgements: streams.keyed(ACKNOWLEDGEMENTS),
        }
    }

    /// Whether frames do not disturb each other, nor those that send them.
    pub fn is_orthogonal(&self) -> bool {
        self.orthogonal
    }

    /// Whether the energy of all that is on air at `now` says that the channel is busy. Light of any strength does.
    pub fn senses(&self, ear: &Ear, now: SimTime) -> bool {
        let powers = ear.during(0, now, now + INSTANT).map(|heard| heard.power);
        match self.assess {
            Some(assess) => self.noise + powers.sum::<f64>() >= assess,
            None => self.phy.infrared.is_some() && powers.count() > 0,
        }
    }

    /// Whether this makes the channel busy for medium access.
    pub fn is_carrier(&self, heard: &Heard) -> bool {
        let least = if heard.is_noise { self.assess } else { self.carrier };
        least.is_some_and(|least| heard.power >= least)
    }

    /// Whether this makes the channel busy for those who ask how full it is: where nobody listens before sending, what is strong enough to be received.
    pub fn is_busy(&self, heard: &Heard) -> bool {
        self.is_carrier(heard) || (self.assess.is_none() && self.is_strong(heard))
    }

    /// Whether this is strong enough to be received.
    pub fn is_strong(&self, heard: &Heard) -> bool {
        heard.power >= self.sensitivity
    }

    /// Whether it takes note of a frame that begins: as long as that takes the frame is strong enough over all else.
    pub fn detects(&self, ear: &Ear, heard: &Heard) -> bool {
        let until = heard.begins + self.latency.max(INSTANT);
        let others = ear.during(heard.channel, heard.begins, until);
        let others: f64 = others
            .filter(|other| other.burst != heard.burst)
            .map(|other| other.power)
            .sum();
        heard.power > self.lock * (self.noise + others)
    }

    /// Whether `robot`, which listened from the beginning to the end, understood `burst`, which stands at `place` in its ear, or why it did not.
    pub fn judge(
        &self,
        ear: &Ear,
        place: usize,
        (burst, waveform): (&Burst, &Waveform),
        robot: ActorId,
    ) -> Result<(), LossCause> {
        let heard = ear.at(place);
        if self.noise == 0.0 && heard.power < self.sensitivity {
            return Err(LossCause::BelowSensitivity);
        }
        if self.capture.is_none() && !self.orthogonal && heard.power <= self.lock * self.noise {
            return Err(LossCause::BelowSensitivity);
        }
        let disturbed = !self.orthogonal && ear.besides(place).next().is_some();
        let survival = if disturbed {
            self.against_others(ear, place, (burst, waveform))?
        } else {
            self.alone(heard, (burst, waveform))
        };
        // Nothing can go wrong: nothing needs to be drawn.
        if survival == 0.0 && self.kept >= 1.0 {
            return Ok(());
        }
        let drawn = self.draw(burst, robot);
        if drawn < self.kept * probability(survival) {
            return Ok(());
        }
        let alone = || self.alone(heard, (burst, waveform));
        Err(if drawn < self.kept * probability(alone()) {
            LossCause::Collision
        } else if heard.power < self.sensitivity {
            LossCause::BelowSensitivity
        } else {
            LossCause::Channel
        })
    }

    /// The logarithm of the probability that all of a frame comes through where nothing else is on air.
    fn alone(&self, heard: &Heard, (burst, waveform): (&Burst, &Waveform)) -> f64 {
        self.survival(waveform, burst, (heard.begins, heard.ends), heard.power / self.noise)
    }

    /// The same, where other things are.
    #[inline(never)]
    fn against_others(
        &self,
        ear: &Ear,
        place: usize,
        (burst, waveform): (&Burst, &Waveform),
    ) -> Result<f64, LossCause> {
        let heard = ear.at(place);
        if self.capture.is_none() && !self.locks(ear, heard) {
            return Err(LossCause::Collision);
        }
        let others = ear.besides(place);
        let mut sum = 0.0;
        // From one change of the interference to the next.
        let mut from = heard.begins;
        while from < heard.ends {
            let chunk = Chunk::of(from, heard.ends, others.clone());
            let drowns = |capture| chunk.frames > 0.0 && heard.power < capture * chunk.frames;
            if self.capture.is_some_and(drowns) {
                return Err(LossCause::Collision);
            }
            let sinr = heard.power / (self.noise + chunk.frames + chunk.noise);
            sum += self.survival(waveform, burst, (from, chunk.until), sinr);
            from = chunk.until;
        }
        Ok(sum)
    }

    /// Whether the receiver is on this frame, and not on one that began before: it takes the first that it notices, and stays on it to its end.
    fn locks(&self, ear: &Ear, heard: &Heard) -> bool {
        let mut on: Option<Heard> = None;
        for frame in ear.until(heard) {
            let is_taken = |on: &Heard| frame.begins < on.ends && !ear.is_deaf(on.begins, frame.begins);
            if on.as_ref().is_some_and(is_taken) || ear.is_deaf(frame.begins, frame.begins + INSTANT) {
                continue;
            }
            if self.detects(ear, frame) {
                on = Some(*frame);
            }
        }
        on.is_some_and(|on| on.burst == heard.burst)
    }

    /// How a burst is laid out.
    pub fn waveform(&self, burst: &Burst) -> Waveform {
        match burst.content {
            Content::Frame { payload, .. } => self.phy.frame(payload),
            Content::Acknowledgement { .. } | Content::Noise => {
                self.phy.acknowledgement().unwrap_or_else(|| self.phy.frame(0))
            }
        }
    }

    /// The logarithm of the probability that all bits of a burst within a time come through at a ratio.
    fn survival(&self, waveform: &Waveform, burst: &Burst, (from, until): (SimTime, SimTime), sinr: f64) -> f64 {
        if sinr as f32 >= self.certain {
            return 0.0;
        }
        if (from, until) == (burst.begins, burst.ends) {
            let all = waveform.sections().filter(|section| section.bits > 0);
            return all
                .map(|section| f64::from(section.bits) * self.tables.log_survival(section.modulation, sinr))
                .sum();
        }
        let mut begins = burst.begins;
        let mut sum = 0.0;
        for section in waveform.sections() {
            let ends = begins + section.airtime;
            let (first, last) = (begins.max(from), ends.min(until));
            if section.bits > 0 && (last > first || section.airtime == Span::ZERO) {
                let share = if section.airtime == Span::ZERO {
                    1.0
                } else {
                    last.since(first).as_nanos() as f64 / section.airtime.as_nanos() as f64
                };
                sum += f64::from(section.bits) * share * self.tables.log_survival(section.modulation, sinr);
            }
            begins = ends;
        }
        sum
    }

    fn draw(&self, burst: &Burst, robot: ActorId) -> f64 {
        let bits = match burst.content {
            Content::Frame { frame, attempt, .. } => {
                let words = [frame.sender.0, robot.0, frame.number];
                nth(self.errors, words, attempt * 4 + u32::from(burst.channel))
            }
            Content::Acknowledgement { of, .. } => {
                nth(self.acknowledgements, [burst.sender.0, robot.0, of.0 as u32], 0)
            }
            Content::Noise => 0,
        };
        unit_interval(bits)
    }
}

/// How the modulations of a technology survive: those of its frames and acknowledgements in which bits can go wrong.
#[derive(Debug)]
pub(super) struct Tables(Vec<(Modulation, Arc<ErrorTable>)>);

/// Those of all radios of the process.
static KNOWN: Memo<Modulation, Arc<ErrorTable>> = Memo::new();

impl Tables {
    pub fn of(phy: &Phy) -> Self {
        let mut tables: Vec<(Modulation, Arc<ErrorTable>)> = Vec::new();
        let acknowledgement = phy.acknowledgement();
        let sections = phy.sections(1);
        let sections = sections.chain(acknowledgement.iter().flat_map(Waveform::sections));
        for section in sections {
            let modulation = section.modulation;
            if modulation != Modulation::None && tables.iter().all(|table| table.0 != modulation) {
                let table = KNOWN.get(modulation, |modulation| Arc::new(ErrorTable::new(*modulation)));
                tables.push((modulation, table));
            }
        }
        Self(tables)
    }

    /// The ratio from which on no bit of any of them goes wrong.
    fn certain(&self) -> f32 {
        let certain = self.0.iter().map(|(_, table)| table.certain());
        certain.fold(f32::NEG_INFINITY, f32::max)
    }

    /// The logarithm of the probability that a bit comes through at a ratio.
    pub fn log_survival(&self, modulation: Modulation, sinr: f64) -> f64 {
        let table = self.0.iter().find(|table| table.0 == modulation);
        table.map_or(0.0, |table| f64::from(table.1.log_survival(sinr as f32)))
    }
}

/// The so manieth 64 bits of a stream, from 0.
fn nth(streams: KeyedStreams, [a, b, sequence]: [u32; 3], place: u32) -> u64 {
    if place == 0 {
        return streams.first_two(a, b, sequence)[0];
    }
    let mut stream = streams.at(a, b, sequence);
    (0..=place).map(|_| stream.next_u64()).last().unwrap_or_default()
}

/// A time without change.
struct Chunk {
    until: SimTime,
    /// The power of other frames, and of noise.
    frames: f64,
    noise: f64,
}

impl Chunk {
    /// What is on air at `from`, until that changes or until `end`.
    fn of<'a>(from: SimTime, end: SimTime, others: impl Iterator<Item = &'a Heard>) -> Self {
        let mut chunk = Self {
            until: end,
            frames: 0.0,
            noise: 0.0,
        };
        for other in others {
            if other.begins > from {
                chunk.until = chunk.until.min(other.begins);
            } else if other.ends > from {
                chunk.until = chunk.until.min(other.ends);
                let sum = if other.is_noise {
                    &mut chunk.noise
                } else {
                    &mut chunk.frames
                };
                *sum += other.power;
            }
        }
        chunk
    }
}

fn probability(log: f64) -> f64 {
    if log == 0.0 { 1.0 } else { libm::exp(log) }
}

/// Milliwatts as a level in dBm, within 1e-8 dB: what every copy is told its receiver of, so by a series and not by a library's logarithm, which takes
/// several times as long.
pub(super) fn dbm(milliwatts: f64) -> f64 {
    const MANTISSA: u64 = (1 << 52) - 1;
    const SQRT_2: u64 = 0x3ff6_a09e_667f_3bcd;
    if !(f64::MIN_POSITIVE..f64::INFINITY).contains(&milliwatts) {
        return 10.0 * libm::log10(milliwatts);
    }
    let bits = milliwatts.to_bits();
    // A factor between 1/√2 and √2, and a power of two.
    let mut factor = (bits & MANTISSA) | 1.0_f64.to_bits();
    let mut power = (bits >> 52) as i32 - 1023;
    if factor > SQRT_2 {
        factor -= 1 << 52;
        power += 1;
    }
    let factor = f64::from_bits(factor);
    // ln x = 2 artanh((x − 1)/(x + 1)).
    let t = (factor - 1.0) / (factor + 1.0);
    let square = t * t;
    let series = [1.0 / 11.0, 1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0, 1.0];
    let series = series.iter().fold(0.0, |sum, term| sum * square + term);
    let logarithm = 2.0 * t * series + f64::from(power) * std::f64::consts::LN_2;
    logarithm * (10.0 / std::f64::consts::LN_10)
}

/// A level in dBm as milliwatts.
pub(super) fn milliwatts(dbm: f64) -> f64 {
    libm::exp10(dbm / 10.0)
}

/// Decibels as a ratio.
pub(super) fn ratio(db: f64) -> f64 {
    libm::exp10(db / 10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_those_of_the_logarithm() {
        for step in 0..200_000 {
            let power = libm::exp10(f64::from(step) * 1e-4 - 15.0) * (1.0 + f64::from(step % 7) * 0.13);
            let error = (dbm(power) - 10.0 * libm::log10(power)).abs();
            assert!(error < 1e-8, "{power}: {error}");
        }
        assert!(dbm(0.0) < 0.0 && dbm(0.0).is_infinite());
        assert!(dbm(f64::INFINITY).is_infinite());
        assert!((dbm(1e-310) - 10.0 * libm::log10(1e-310)).abs() < 1e-8);
    }
}
