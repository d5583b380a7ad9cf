//! What the tables of frames, bytes and latencies hold.

use super::records::Records;
use super::table::{Table, Wrong};
use crate::engine::{ActorId, SimTime};
use crate::metrics::{
    Amount, Noted, PAIR_MEASURES, PairRecord, RobotBytes, RumorSpread, SeriesEntry, TopicFates, TrafficRow, Values,
    Volume,
};
use crate::radio::LossCause;

pub fn frames(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, topic) = (table.ids("trial")?, table.texts("topic")?);
    let (offered, delivered) = (table.counts("offered")?, table.counts("delivered")?);
    let in_flight = table.counts("in_flight")?;
    let lost = by_cause(|cause| table.counts(&format!("lost_{cause}")))?;
    for row in 0..trial.len() {
        let topic = usize::from(records.names.topic(&topic[row])?);
        records.of(trial[row])?.ledger[topic] = TopicFates {
            offered: offered[row],
            delivered: delivered[row],
            lost: std::array::from_fn(|cause| lost[cause][row]),
            in_flight: in_flight[row],
        };
    }
    Ok(())
}

/// A column for each cause of loss, in the order of [`LossCause::ALL`].
pub fn by_cause<T>(column: impl Fn(&str) -> Result<Vec<T>, Wrong>) -> Result<Vec<Vec<T>>, Wrong> {
    LossCause::ALL.iter().map(|cause| column(cause.name())).collect()
}

pub fn bandwidth(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, robot) = (table.ids("trial")?, table.ids("robot")?);
    let (role, topic, direction) = (table.texts("role")?, table.texts("topic")?, table.texts("direction")?);
    let (frames, payload) = (table.counts("frames")?, table.counts("payload_bytes")?);
    let header = table.counts("header_bytes")?;
    for row in 0..trial.len() {
        let (role, topic) = (records.names.role(&role[row])?, records.names.topic(&topic[row])?);
        let robot = ActorId(robot[row]);
        let traffic = &mut records.of(trial[row])?.traffic;
        // Rows of one robot, role and topic follow each other.
        if traffic.last().map(|last| (last.robot, last.role, last.topic)) != Some((robot, role, topic)) {
            traffic.push(TrafficRow {
                robot,
                role,
                topic,
                sent: Volume::default(),
                received: Volume::default(),
                duplicate: Volume::default(),
                lost: Default::default(),
            });
        }
        let volume = Volume {
            frames: frames[row],
            payload_bytes: payload[row],
            header_bytes: header[row],
        };
        if let Some(last) = traffic.last_mut() {
            *way(last, &direction[row])? = volume;
        }
    }
    Ok(())
}

/// What went in the direction called `name`.
fn way<'a>(row: &'a mut TrafficRow, name: &str) -> Result<&'a mut Volume, Wrong> {
    let cause = name
        .strip_prefix("lost_")
        .and_then(|name| LossCause::ALL.iter().position(|cause| cause.name() == name));
    match (name, cause) {
        ("tx", _) => Ok(&mut row.sent),
        ("rx", _) => Ok(&mut row.received),
        ("duplicate", _) => Ok(&mut row.duplicate),
        (_, Some(cause)) => Ok(&mut row.lost[cause]),
        (other, None) => Err(format!("it has rows of an unknown direction `{other}`")),
    }
}

pub fn notes(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, name, robot) = (table.ids("trial")?, table.texts("name")?, table.ids("robot")?);
    let (kind, count) = (table.texts("kind")?, table.counts("count")?);
    let extremes = ["sum", "min", "max"].map(|name| table.optional_numbers(name));
    let [sum, min, max] = extremes;
    let (sum, min, max) = (sum?, min?, max?);
    let (values, times) = (table.lists_of_numbers("values")?, table.lists_of_counts("times")?);
    for row in 0..trial.len() {
        let amount = match (kind[row].as_str(), sum[row], min[row], max[row]) {
            ("count", None, None, None) => Amount::Count(count[row]),
            ("value", Some(sum), Some(min), Some(max)) => {
                let buckets = values[row].iter().copied().zip(times[row].iter().copied());
                Amount::Values(Values::restored(sum, min, max, buckets))
            }
            (other, ..) => return Err(format!("it has a row of the kind `{other}` that is none")),
        };
        records.of(trial[row])?.noted.push(Noted {
            name: name[row].clone(),
            robot: ActorId(robot[row]),
            amount,
        });
    }
    Ok(())
}

pub fn pairs(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, sender, receiver) = (table.ids("trial")?, table.ids("sender")?, table.ids("receiver")?);
    let (offered, delivered) = (table.counts("offered")?, table.counts("delivered")?);
    let measures = PAIR_MEASURES.iter();
    let measures: Vec<Vec<Option<f64>>> = measures
        .map(|measure| table.optional_numbers(measure.key))
        .collect::<Result<_, _>>()?;
    for row in 0..trial.len() {
        records.of(trial[row])?.pairs.push(PairRecord {
            sender: ActorId(sender[row]),
            receiver: ActorId(receiver[row]),
            offered: offered[row],
            delivered: delivered[row],
            values: measures.iter().map(|values| values[row]).collect(),
        });
    }
    Ok(())
}

pub fn spread(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, rumor) = (table.ids("trial")?, table.ids("rumor")?);
    let (informed, hops) = (table.optional_numbers("informed_s")?, table.optional_ids("hops")?);
    for row in 0..trial.len() {
        let rumors = &mut records.of(trial[row])?.spread;
        // Rows of one rumour follow each other, robot by robot.
        if rumors.len() <= rumor[row] as usize {
            rumors.push(RumorSpread::default());
        }
        if let Some(last) = rumors.last_mut() {
            last.informed.push(informed[row].map(SimTime::from_secs));
            last.hops.push(hops[row]);
        }
    }
    Ok(())
}

pub fn latency(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, count) = (table.ids("trial")?, table.counts("count")?);
    let (low, high) = (table.keys("low_ns")?, table.keys("high_ns")?);
    for row in 0..trial.len() {
        let bucket = (low[row], high[row], count[row]);
        records.of(trial[row])?.latency.fill(bucket);
    }
    Ok(())
}

pub fn series(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, since, time) = (table.ids("trial")?, table.numbers("since_s")?, table.numbers("time_s")?);
    let (topic, direction) = (table.optional_texts("topic")?, table.texts("direction")?);
    let (total, median) = (table.counts("bytes")?, table.numbers("median_bytes")?);
    let (min, max) = (table.counts("min_bytes")?, table.counts("max_bytes")?);
    let topics = records.names.topics.len();
    for row in 0..trial.len() {
        let topic = match &topic[row] {
            Some(name) => usize::from(records.names.topic(name)?),
            None => topics,
        };
        let entries = &mut records.of(trial[row])?.series;
        let at = SimTime::from_secs(time[row]);
        if entries.last().map(|last| last.at) != Some(at) {
            entries.push(&SeriesEntry {
                since: SimTime::from_secs(since[row]),
                at,
                sent: vec![RobotBytes::default(); topics + 1],
                received: vec![RobotBytes::default(); topics + 1],
            });
        }
        let way: fn(&mut SeriesEntry) -> &mut Vec<RobotBytes> = match direction[row].as_str() {
            "tx" => |entry| &mut entry.sent,
            "rx" => |entry| &mut entry.received,
            other => return Err(format!("it has rows of an unknown direction `{other}`")),
        };
        let bytes = RobotBytes {
            total: total[row],
            min: min[row],
            median: median[row],
            max: max[row],
        };
        entries.change(entries.len() - 1, |entry| way(entry)[topic] = bytes);
    }
    Ok(())
}
