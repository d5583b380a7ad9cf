//! What is put together when the books are closed.

use crate::geometry::Pose;
use crate::metrics::record::RobotState;
use crate::metrics::reports::Reports;
use crate::metrics::volume::{TopicFates, TrafficRow};

/// Fates by topic: what was delivered and lost from the receivers' rows, the rest as counted at the senders.
pub(super) fn ledger(offered: &[u64], in_flight: &[u64], traffic: &[TrafficRow]) -> Vec<TopicFates> {
    let counted = offered.iter().zip(in_flight);
    let mut ledger: Vec<_> = counted
        .map(|(&offered, &in_flight)| TopicFates {
            offered,
            in_flight,
            ..TopicFates::default()
        })
        .collect();
    for row in traffic {
        let fates = &mut ledger[usize::from(row.topic)];
        fates.delivered += row.received.frames;
        for (lost, volume) in fates.lost.iter_mut().zip(&row.lost) {
            *lost += volume.frames;
        }
    }
    ledger
}

/// The robots as they ended.
pub(super) fn robots(reports: Reports, poses: Vec<Pose>, steps: &[u64]) -> Vec<RobotState> {
    let states = reports.roles.into_iter().zip(reports.targets).zip(reports.parents);
    poses
        .into_iter()
        .zip(states)
        .zip(steps)
        .map(|((pose, ((role, target), parents)), &steps)| RobotState {
            pose,
            role: role.0,
            target,
            parents,
            steps,
        })
        .collect()
}
