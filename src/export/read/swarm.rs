//! What the tables of connectivity and of robots hold.

use super::records::Records;
use super::table::{Table, Wrong};
use crate::engine::{ActorId, SimTime};
use crate::geometry::{Pose, Vec2};
use crate::metrics::{ConnectivitySample, RobotState, TargetSample, TargetState};

pub fn connectivity(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, time) = (table.ids("trial")?, table.numbers("time_s")?);
    let (lambda2, components) = (table.numbers("lambda2")?, table.ids("components")?);
    let neighbours = table.numbers("neighbours")?;
    let roles = records.names.roles.iter();
    let roles: Vec<_> = roles
        .map(|role| table.optional_ids(&format!("robots_{role}")))
        .collect::<Result<_, _>>()?;
    let targets = (0..).map(|target| format!("links_{target}"));
    let links: Vec<_> = targets
        .take_while(|name| table.has(name))
        .map(|name| table.optional_ids(&name))
        .collect::<Result<_, _>>()?;
    let mut targets = Vec::new();
    for target in 0..links.len() {
        let states = table.texts(&format!("target_{target}"))?;
        targets.push((states, table.optional_numbers(&format!("worker_m_{target}"))?));
    }
    let at = |columns: &[Vec<Option<u32>>], row: usize| columns.iter().filter_map(|column| column[row]).collect();
    for row in 0..trial.len() {
        records.of(trial[row])?.connectivity.push(&ConnectivitySample {
            at: SimTime::from_secs(time[row]),
            lambda2: lambda2[row],
            components: components[row],
            neighbours: neighbours[row],
            roles: at(&roles, row),
            links: at(&links, row),
            targets: targets
                .iter()
                .map(|(states, workers)| target(&states[row], workers[row]))
                .collect::<Result<_, _>>()?,
        });
    }
    Ok(())
}

fn target(state: &str, worker_m: Option<f64>) -> Result<TargetSample, Wrong> {
    let known = TargetState::ALL.into_iter().find(|known| known.name() == state);
    let state = known.ok_or_else(|| format!("no target stands `{state}`"))?;
    Ok(TargetSample { state, worker_m })
}

pub fn robots(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, role) = (table.ids("trial")?, table.texts("role")?);
    let (x, y, heading) = (
        table.numbers("x_m")?,
        table.numbers("y_m")?,
        table.numbers("heading_rad")?,
    );
    let (target, parents) = (table.optional_ids("target")?, table.lists("parents")?);
    let steps = table.counts("steps")?;
    for row in 0..trial.len() {
        let role = records.names.role(&role[row])?;
        records.of(trial[row])?.robots.push(RobotState {
            pose: Pose {
                position: Vec2::new(x[row], y[row]),
                heading: heading[row],
            },
            role,
            target: target[row].and_then(|target| u16::try_from(target).ok()),
            parents: parents[row].iter().copied().map(ActorId).collect(),
            steps: steps[row],
        });
    }
    Ok(())
}
