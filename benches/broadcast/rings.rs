//! The practical limit: calendar rings and arrays, no actors, no robots, no accounting.
//!
//! Time is cut into slices that are shorter than any latency. What happens in a slice is known when it begins, but for timers that are armed
//! anew: it is sorted and gone through in order of time. A slice is a bucket of a ring, which is used again once it is empty. Sends need none:
//! each robot has a phase of its own, so that they come in one order, period after period.

use rand::rngs::SmallRng;
use rand::{RngExt as _, SeedableRng as _};
use rand_distr::{Distribution as _, Normal};

use crate::links::first_links;
use crate::workload::{
    Counts, LATENCY_MEAN_S, LATENCY_MIN_S, LATENCY_STD_DEV_S, LOSS_PROBABILITY, PERIOD_S, SEED, TIMEOUT_S, Workload,
};

const PERIOD: u64 = nanos(PERIOD_S);
const TIMEOUT: u64 = nanos(TIMEOUT_S);
const LATENCY_MIN: u64 = nanos(LATENCY_MIN_S);
const NEVER: u64 = u64::MAX;
/// Events of a slice, about: few enough to be sorted quickly, many enough that most slices have some.
const EVENTS: f64 = 16.0;
/// No latency is longer: beyond are fewer than one in 10²⁰.
const LATENCY_MAX: u64 = nanos(LATENCY_MEAN_S + 10.0 * LATENCY_STD_DEV_S);

const fn nanos(seconds: f64) -> u64 {
    (seconds * 1e9) as u64
}

/// A ring of slices of time, each with what is due in it: when, and over which link.
struct Ring {
    slices: Vec<Vec<(u64, u32)>>,
    width: u64,
}

impl Ring {
    /// Slices of so many nanoseconds, for what is due within `reach` of the present slice's beginning.
    fn new(width: u64, reach: u64) -> Self {
        let slices = (reach / width + 2).next_power_of_two() as usize;
        Self {
            slices: vec![Vec::new(); slices],
            width,
        }
    }

    fn of(&self, at: u64) -> usize {
        (at / self.width) as usize & (self.slices.len() - 1)
    }

    fn push(&mut self, at: u64, link: u32) {
        let slice = self.of(at);
        self.slices[slice].push((at, link));
    }

    /// Takes what is due in the slice that begins at `from`, in order of time.
    fn take(&mut self, from: u64, into: &mut Vec<(u64, u32)>) {
        into.clear();
        let slice = self.of(from);
        std::mem::swap(&mut self.slices[slice], into);
        into.sort_unstable();
    }
}

pub fn run(workload: &Workload) -> Counts {
    let first = first_links(workload);
    let links = first[workload.poses.len()] as usize;
    let mut random = SmallRng::seed_from_u64(SEED);
    let latency = Normal::new(LATENCY_MEAN_S * 1e9, LATENCY_STD_DEV_S * 1e9).expect("a positive deviation");
    let end = nanos(workload.seconds);
    let mut sends: Vec<(u64, u32)> = (0..workload.poses.len() as u32)
        .map(|robot| (random.random_range(0..PERIOD), robot))
        .collect();
    sends.sort_unstable();
    let (mut round, mut next_send) = (0, 0);

    let width = ((PERIOD as f64 * EVENTS / links as f64) as u64).clamp(1, LATENCY_MIN);
    let mut arrivals = Ring::new(width, LATENCY_MAX + width);
    let mut timers = Ring::new(width, TIMEOUT + width);
    let mut last_heard = vec![NEVER; links];
    let mut timed = vec![false; links];
    let (mut arriving, mut ringing) = (Vec::new(), Vec::new());
    let mut counts = Counts {
        simulated_s: workload.seconds,
        deliveries: 0,
        suspicions: 0,
    };
    let mut from = 0;
    while from <= end {
        let until = (from + width).min(end + 1);
        // Nothing that is sent in this slice arrives in it.
        arrivals.take(from, &mut arriving);
        timers.take(from, &mut ringing);
        while let Some(&(phase, robot)) = sends.get(next_send) {
            let now = round + phase;
            if now >= until {
                break;
            }
            for link in first[robot as usize]..first[robot as usize + 1] {
                if random.random::<f64>() < LOSS_PROBABILITY {
                    continue;
                }
                let delay = loop {
                    let delay = latency.sample(&mut random);
                    if delay >= LATENCY_MIN_S * 1e9 {
                        break (delay as u64).min(LATENCY_MAX);
                    }
                };
                arrivals.push(now + delay, link);
            }
            next_send += 1;
            if next_send == sends.len() {
                (round, next_send) = (round + PERIOD, 0);
            }
        }
        let mut rung = 0;
        let mut arrived = arriving.iter().peekable();
        loop {
            let ring_at = ringing.get(rung).map_or(NEVER, |&(at, _)| at);
            match arrived.next_if(|&&(at, _)| at <= ring_at && at < until) {
                Some(&(now, link)) => {
                    let link = link as usize;
                    counts.deliveries += 1;
                    last_heard[link] = now;
                    if !timed[link] {
                        timed[link] = true;
                        timers.push(now + TIMEOUT, link as u32);
                    }
                }
                None if ring_at < until => {
                    let link = ringing[rung].1;
                    rung += 1;
                    let due = last_heard[link as usize] + TIMEOUT;
                    if due <= ring_at {
                        counts.suspicions += 1;
                        timed[link as usize] = false;
                    } else if due < from + width {
                        let place = ringing.partition_point(|&(at, _)| at <= due);
                        ringing.insert(place, (due, link));
                    } else {
                        timers.push(due, link);
                    }
                }
                None => break,
            }
        }
        from += width;
    }
    counts
}
