//! What the tables hold that are there only where a scenario asks for them.

use super::records::Records;
use super::table::{Table, Wrong};
use super::traffic::by_cause;
use crate::engine::{ActorId, SimTime, Span};
use crate::metrics::{DegreeSample, DelayEntry, DeliveryBand, Hop, RoleChange, TopicFates, TrafficEntry};

pub fn delivery(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, topic) = (table.ids("trial")?, table.texts("topic")?);
    let (from, to) = (table.numbers("from_m")?, table.numbers("to_m")?);
    let (offered, delivered) = (table.counts("offered")?, table.counts("delivered")?);
    let in_flight = table.counts("in_flight")?;
    let lost = by_cause(|cause| table.counts(&format!("lost_{cause}")))?;
    for row in 0..trial.len() {
        let topic = records.names.topic(&topic[row])?;
        records.of(trial[row])?.asked.delivery.push(DeliveryBand {
            topic,
            from_m: from[row],
            to_m: to[row],
            fates: TopicFates {
                offered: offered[row],
                delivered: delivered[row],
                lost: std::array::from_fn(|cause| lost[cause][row]),
                in_flight: in_flight[row],
            },
        });
    }
    Ok(())
}

pub fn delays(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, since, time) = (table.ids("trial")?, table.numbers("since_s")?, table.numbers("time_s")?);
    let (topic, copies) = (table.texts("topic")?, table.counts("copies")?);
    let mean = table.numbers("mean_s")?;
    let [min, median, p95, p99, max] = ["min_s", "median_s", "p95_s", "p99_s", "max_s"].map(|name| table.numbers(name));
    let (min, median, p95, p99, max) = (min?, median?, p95?, p99?, max?);
    for row in 0..trial.len() {
        let topic = records.names.topic(&topic[row])?;
        records.of(trial[row])?.asked.delays.push(&DelayEntry {
            since: SimTime::from_secs(since[row]),
            at: SimTime::from_secs(time[row]),
            topic,
            copies: copies[row],
            mean_s: mean[row],
            min: Span::from_secs(min[row]),
            median: Span::from_secs(median[row]),
            p95: Span::from_secs(p95[row]),
            p99: Span::from_secs(p99[row]),
            max: Span::from_secs(max[row]),
        });
    }
    Ok(())
}

/// A sample's rows follow each other, robot by robot, and may go on in the next group of rows.
pub fn degree(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, time) = (table.ids("trial")?, table.numbers("time_s")?);
    let (robot, neighbours) = (table.ids("robot")?, table.optional_ids("neighbours")?);
    let mut row = 0;
    while row < trial.len() {
        let is_of = |other: &usize| trial[*other] == trial[row] && time[*other].to_bits() == time[row].to_bits();
        let end = row + (row..trial.len()).take_while(is_of).count();
        let record = records.of(trial[row])?;
        let (robots, degree) = (record.robots.len(), &mut record.asked.degree);
        let (first, at) = (robot[row] as usize, SimTime::from_secs(time[row]));
        let in_order = (first..robots)
            .zip(&robot[row..end])
            .filter(|(place, robot)| *place == **robot as usize);
        let goes_on = first == 0 || degree.last().is_some_and(|last| last.at == at);
        if in_order.count() < end - row || !goes_on {
            return Err(format!(
                "its rows of trial {} are not those of every robot in order",
                trial[row]
            ));
        }
        if first == 0 {
            degree.push(&DegreeSample {
                at,
                neighbours: vec![None; robots],
            });
        }
        degree.change(degree.len() - 1, |sample| {
            sample.neighbours[first..][..end - row].copy_from_slice(&neighbours[row..end]);
        });
        row = end;
    }
    Ok(())
}

pub fn hops(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, rumor, robot) = (table.ids("trial")?, table.ids("rumor")?, table.ids("robot")?);
    let (informed, parent) = (table.numbers("informed_s")?, table.optional_ids("parent")?);
    let hops = table.ids("hops")?;
    for row in 0..trial.len() {
        let rumor = u16::try_from(rumor[row]).map_err(|_| format!("there is no rumour {}", rumor[row]))?;
        records.of(trial[row])?.asked.hops.push(&Hop {
            rumor,
            robot: ActorId(robot[row]),
            at: SimTime::from_secs(informed[row]),
            parent: parent[row].map(ActorId),
            hops: hops[row],
        });
    }
    Ok(())
}

pub fn traffic(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, since, time) = (table.ids("trial")?, table.numbers("since_s")?, table.numbers("time_s")?);
    let (robot, topic) = (table.ids("robot")?, table.texts("topic")?);
    let sent = [table.counts("sent_frames")?, table.counts("sent_bytes")?];
    let received = [table.counts("received_frames")?, table.counts("received_bytes")?];
    for row in 0..trial.len() {
        let topic = records.names.topic(&topic[row])?;
        records.of(trial[row])?.asked.traffic.push(&TrafficEntry {
            since: SimTime::from_secs(since[row]),
            at: SimTime::from_secs(time[row]),
            robot: ActorId(robot[row]),
            topic,
            sent_frames: sent[0][row],
            sent_bytes: sent[1][row],
            received_frames: received[0][row],
            received_bytes: received[1][row],
        });
    }
    Ok(())
}

pub fn roles(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, time, robot) = (table.ids("trial")?, table.numbers("time_s")?, table.ids("robot")?);
    let (before, role) = (table.optional_texts("before")?, table.texts("role")?);
    for row in 0..trial.len() {
        let before = before[row]
            .as_deref()
            .map(|name| records.names.role(name))
            .transpose()?;
        let role = records.names.role(&role[row])?;
        records.of(trial[row])?.asked.roles.push(&RoleChange {
            at: SimTime::from_secs(time[row]),
            robot: ActorId(robot[row]),
            before,
            role,
        });
    }
    Ok(())
}
