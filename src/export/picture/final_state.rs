//! Where the robots of a trial ended, as the paper's figure 2 shows it.

use svg::Document;

use super::super::scene::Scene;
use super::canvas::Canvas;
use super::style::{self, FAILED, LINK, TARGET};
use super::{obstacles, subtitle};
use crate::geometry::Vec2;
use crate::metrics::{RobotState, TrialRecord};
use crate::radio::Reach;

/// Above this many robots their numbers would hide them.
const MOST_LABELS: usize = 200;

/// Draws from the back to the front: obstacles, links, chains, targets, robots, numbers.
pub fn draw(scene: &Scene, record: &TrialRecord, reach: &Reach) -> Document {
    let size = Vec2::new(scene.arena.size.0.get(), scene.arena.size.1.get());
    let mut canvas = Canvas::new(size, &scene.name, &subtitle(record));
    let robots = &record.robots;
    obstacles(&mut canvas, &scene.arena.obstacles);
    let links = record.links_at_end(reach);
    canvas.lines(links.iter().copied(), style::link(links.len()));
    let targets = worked_for(robots);
    for &target in &targets {
        canvas.lines(chain(robots, target), style::chain(target.into()));
    }
    scene.targets.iter().for_each(|&target| canvas.mark(target, TARGET));
    for robot in robots {
        canvas.mark(
            robot.pose.position,
            style::role(scene.role(robot.role), robot.role.into()),
        );
    }
    let failed = record.failed_at_end();
    for robot in &failed {
        canvas.mark(robots[robot.index()].pose.position, FAILED);
    }
    let crowded = if robots.len() <= MOST_LABELS {
        let places: Vec<Vec2> = robots.iter().map(|robot| robot.pose.position).collect();
        let others: Vec<(Vec2, f64)> = scene.targets.iter().map(|&at| (at, 2.0 * TARGET.size)).collect();
        canvas.numbers(&places, &others)
    } else {
        robots.len()
    };
    legend(&mut canvas, scene, reach, robots, &targets, failed.len());
    if crowded > 0 {
        let numbers = if crowded == 1 { "number" } else { "numbers" };
        canvas.legend_words(&format!("no room for {crowded} {numbers}"));
    }
    canvas.finish()
}

fn legend(canvas: &mut Canvas, scene: &Scene, reach: &Reach, robots: &[RobotState], targets: &[u16], failed: usize) {
    for (number, name) in scene.roles.iter().enumerate() {
        let count = robots.iter().filter(|robot| usize::from(robot.role) == number).count();
        if count > 0 {
            canvas.legend_mark(style::role(name, number), &format!("{name} ({count})"));
        }
    }
    if failed > 0 {
        canvas.legend_mark(FAILED, &format!("failed ({failed})"));
    }
    if !scene.targets.is_empty() {
        canvas.legend_mark(
            style::Marker {
                size: TARGET.size * 0.7,
                ..TARGET
            },
            "target",
        );
    }
    let within = match reach {
        Reach::Disk(range) => format!("within range ({range} m)"),
        Reach::Links(_) => "within range".to_owned(),
    };
    canvas.legend_stroke(LINK, &within);
    for &target in targets {
        canvas.legend_stroke(style::chain(target.into()), &format!("chain to target {target}"));
    }
}

/// The targets that some robot works for, in order.
fn worked_for(robots: &[RobotState]) -> Vec<u16> {
    let mut targets: Vec<_> = robots.iter().filter_map(|robot| robot.target).collect();
    targets.sort_unstable();
    targets.dedup();
    targets
}

/// From each robot of a target's chains to the robots that it relies on.
fn chain(robots: &[RobotState], target: u16) -> impl Iterator<Item = (Vec2, Vec2)> {
    robots
        .iter()
        .filter(move |robot| robot.target == Some(target))
        .flat_map(move |robot| {
            let parents = robot.parents.iter().filter_map(|parent| robots.get(parent.index()));
            parents.map(|parent| (robot.pose.position, parent.pose.position))
        })
}
