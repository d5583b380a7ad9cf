//! What is mostly done: one binary heap and arrays, no actors, no robots, no accounting.
//!
//! Entries of 16 bytes, one lazy timer a link, a small fast generator, one array a field. It is written to be fast.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use rand::rngs::SmallRng;
use rand::{RngExt as _, SeedableRng as _};
use rand_distr::{Distribution as _, Normal};

use crate::links::first_links;
use crate::workload::{
    Counts, LATENCY_MEAN_S, LATENCY_MIN_S, LATENCY_STD_DEV_S, LOSS_PROBABILITY, PERIOD_S, SEED, TIMEOUT_S, Workload,
};

const PERIOD: u64 = nanos(PERIOD_S);
const TIMEOUT: u64 = nanos(TIMEOUT_S);
const NEVER: u64 = u64::MAX;

/// Kinds of event, in the upper half of an entry's second word; the lower half is a robot or a link.
const SEND: u64 = 0;
const ARRIVE: u64 = 1 << 32;
const TIMER: u64 = 2 << 32;

const fn nanos(seconds: f64) -> u64 {
    (seconds * 1e9) as u64
}

struct Links {
    /// Links of robot r: `first[r]..first[r + 1]`.
    first: Vec<u32>,
    /// Last arrival over each link, `NEVER` before the first.
    last_heard: Vec<u64>,
    /// Whether a timer entry of the link is in the heap.
    timed: Vec<bool>,
}

pub fn run(workload: &Workload) -> Counts {
    let mut links = links(workload);
    let mut random = SmallRng::seed_from_u64(SEED);
    let latency = Normal::new(LATENCY_MEAN_S * 1e9, LATENCY_STD_DEV_S * 1e9).expect("a positive deviation");
    let end = nanos(workload.seconds);
    let mut heap = BinaryHeap::new();
    for robot in 0..workload.poses.len() as u64 {
        heap.push(Reverse((random.random_range(0..PERIOD), SEND | robot)));
    }
    let mut counts = Counts {
        simulated_s: workload.seconds,
        deliveries: 0,
        suspicions: 0,
    };
    while let Some(Reverse((now, event))) = heap.pop() {
        if now > end {
            break;
        }
        let id = event as u32 as usize;
        match event & !0xffff_ffff {
            SEND => {
                for link in links.first[id]..links.first[id + 1] {
                    if random.random::<f64>() < LOSS_PROBABILITY {
                        continue;
                    }
                    let delay = loop {
                        let delay = latency.sample(&mut random);
                        if delay >= LATENCY_MIN_S * 1e9 {
                            break delay as u64;
                        }
                    };
                    heap.push(Reverse((now + delay, ARRIVE | u64::from(link))));
                }
                heap.push(Reverse((now + PERIOD, event)));
            }
            ARRIVE => {
                counts.deliveries += 1;
                links.last_heard[id] = now;
                if !links.timed[id] {
                    links.timed[id] = true;
                    heap.push(Reverse((now + TIMEOUT, TIMER | id as u64)));
                }
            }
            _ => {
                let due = links.last_heard[id] + TIMEOUT;
                if due > now {
                    heap.push(Reverse((due, event)));
                } else {
                    counts.suspicions += 1;
                    links.timed[id] = false;
                }
            }
        }
    }
    counts
}

/// What is known of all links.
fn links(workload: &Workload) -> Links {
    let first = first_links(workload);
    let count = first[workload.poses.len()] as usize;
    Links {
        first,
        last_heard: vec![NEVER; count],
        timed: vec![false; count],
    }
}
