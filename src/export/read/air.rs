//! What the tables of radios hold.

use super::records::Records;
use super::table::{Table, Wrong};
use super::traffic::by_cause;
use crate::engine::{ActorId, SimTime, Span};
use crate::metrics::{AirRecord, Copies, DistanceBand, ENERGY_STATES, LatencyHistogram, LinkRecord, RobotAir, Waits};

pub fn robots(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, robot) = (table.ids("trial")?, table.ids("robot")?);
    let (sent, busy) = (table.numbers("sent_s")?, table.numbers("busy_s")?);
    let counts = ["frames", "on_air", "attempts", "acknowledged", "unacknowledged"].map(|name| table.counts(name));
    let [frames, on_air, attempts, acknowledged, unacknowledged] = counts;
    let (frames, on_air, attempts) = (frames?, on_air?, attempts?);
    let (acknowledged, unacknowledged) = (acknowledged?, unacknowledged?);
    let dropped = by_cause(|cause| table.counts(&format!("dropped_{cause}")))?;
    let (queue_wait, access_delay) = (waits_of(table, "queue_wait")?, waits_of(table, "access_delay")?);
    let heard = copies(table)?;
    let strayed = table.counts("strayed")?;
    let energy = ENERGY_STATES
        .iter()
        .map(|state| table.numbers(&format!("energy_{state}_J")));
    let energy = energy.collect::<Result<Vec<_>, _>>()?;
    let empty = table.optional_numbers("empty_s")?;
    for row in 0..trial.len() {
        let robots = &mut air(records, trial[row])?.robots;
        if robots.len() != robot[row] as usize {
            return Err(format!(
                "its rows of trial {} are not those of every robot in order",
                trial[row]
            ));
        }
        if on_air[row] > frames[row] {
            return Err(format!(
                "robot {} of trial {} sent more frames than it had",
                robot[row], trial[row]
            ));
        }
        robots.push(RobotAir {
            sent: Span::from_secs(sent[row]),
            busy: Span::from_secs(busy[row]),
            energy: std::array::from_fn(|state| energy[state][row]),
            empty_at: empty[row].map(SimTime::from_secs),
            frames: frames[row],
            on_air: on_air[row],
            attempts: attempts[row],
            acknowledged: acknowledged[row],
            unacknowledged: unacknowledged[row],
            dropped: std::array::from_fn(|cause| dropped[cause][row]),
            queue_wait: queue_wait[row],
            access_delay: access_delay[row],
            heard: heard[row],
            strayed: strayed[row],
        });
    }
    Ok(())
}

/// What is known of a trial's radios, begun where it is not.
fn air<'a>(records: &'a mut Records, trial: u32) -> Result<&'a mut AirRecord, Wrong> {
    Ok(records.of(trial)?.air.get_or_insert_default())
}

fn waits_of(table: &Table, wait: &str) -> Result<Vec<Option<Waits>>, Wrong> {
    let [sum, min, max] = ["sum", "min", "max"].map(|part| table.optional_numbers(&format!("{wait}_{part}_s")));
    let (sum, min, max) = (sum?, min?, max?);
    let waits = |row: usize| {
        Some(Waits {
            sum: Span::from_secs(sum[row]?),
            min: Span::from_secs(min[row]?),
            max: Span::from_secs(max[row]?),
        })
    };
    Ok((0..sum.len()).map(waits).collect())
}

fn copies(table: &Table) -> Result<Vec<Copies>, Wrong> {
    let (offered, delivered, reached) = (
        table.counts("offered")?,
        table.counts("delivered")?,
        table.counts("reached")?,
    );
    let power = table.optional_numbers("power_dBm_mean")?;
    let delivered_power = table.optional_numbers("delivered_power_dBm_mean")?;
    let copies = |row: usize| Copies {
        offered: offered[row],
        delivered: delivered[row],
        reached: reached[row],
        power_dbm: power[row],
        delivered_power_dbm: delivered_power[row],
    };
    Ok((0..offered.len()).map(copies).collect())
}

/// The histograms, whose sums and extremes are known from the robots.
pub fn waits(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, wait) = (table.ids("trial")?, table.texts("wait")?);
    let (low, high, count) = (table.keys("low_ns")?, table.keys("high_ns")?, table.counts("count")?);
    for row in 0..trial.len() {
        let air = air(records, trial[row])?;
        let robots = air.robots.iter();
        let (histogram, known): (_, Vec<Waits>) = match wait[row].as_str() {
            "queue" => (
                &mut air.queue_wait,
                robots.filter_map(|robot| robot.queue_wait).collect(),
            ),
            "access" => (
                &mut air.access_delay,
                robots.filter_map(|robot| robot.access_delay).collect(),
            ),
            other => return Err(format!("it has rows of an unknown wait `{other}`")),
        };
        if histogram.count() == 0 {
            let sum = known.iter().map(|waits| u128::from(waits.sum.as_nanos())).sum();
            let min = known.iter().map(|waits| waits.min.as_nanos()).min();
            let max = known.iter().map(|waits| waits.max.as_nanos()).max();
            let (Some(min), Some(max)) = (min, max) else {
                return Err(format!("no robot of trial {} has such a wait", trial[row]));
            };
            *histogram = LatencyHistogram::exactly(min, max, sum);
        }
        histogram.fill((low[row], high[row], count[row]));
    }
    Ok(())
}

pub fn bands(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let trial = table.ids("trial")?;
    let (from, to, copies) = (table.numbers("from_m")?, table.numbers("to_m")?, copies(table)?);
    for row in 0..trial.len() {
        air(records, trial[row])?.bands.push(DistanceBand {
            from_m: from[row],
            to_m: to[row],
            copies: copies[row],
        });
    }
    Ok(())
}

pub fn links(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, sender, receiver) = (table.ids("trial")?, table.ids("sender")?, table.ids("receiver")?);
    let (distance, copies) = (table.numbers("distance_m_mean")?, copies(table)?);
    for row in 0..trial.len() {
        air(records, trial[row])?.links.push(LinkRecord {
            sender: ActorId(sender[row]),
            receiver: ActorId(receiver[row]),
            copies: copies[row],
            distance_m: distance[row],
        });
    }
    Ok(())
}
