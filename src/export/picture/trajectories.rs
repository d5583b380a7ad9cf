//! How the robots of a trial moved.

use svg::Document;

use super::canvas::Canvas;
use super::style::{self, Marker, Shape, Stroke, TARGET};
use super::{Scene, obstacles, subtitle};
use crate::geometry::Vec2;
use crate::metrics::TrialRecord;

/// Places nearer than this to the last one drawn are left out, metres: less than a line's width.
const RESOLUTION: f64 = 0.01;

/// Draws paths by the robots' roles at the end, from a ring where they began to their mark where they ended.
pub fn draw(scene: &Scene, record: &TrialRecord) -> Document {
    let size = Vec2::new(scene.arena.size.0.get(), scene.arena.size.1.get());
    let mut canvas = Canvas::new(size, &scene.name, &format!("paths of {}", subtitle(record)));
    obstacles(&mut canvas, &scene.arena.obstacles);
    let paths: Vec<_> = (0..record.robots.len()).map(|robot| path(record, robot)).collect();
    for (robot, path) in record.robots.iter().zip(&paths) {
        let colour = style::role(scene.role(robot.role), robot.role.into()).colour;
        canvas.path(
            path,
            Stroke {
                colour,
                width: 1.3,
                opacity: 0.6,
            },
        );
    }
    scene.targets.iter().for_each(|&target| canvas.mark(target, TARGET));
    paths
        .iter()
        .filter_map(|path| path.first())
        .for_each(|&start| canvas.mark(start, START));
    for robot in &record.robots {
        canvas.mark(
            robot.pose.position,
            style::role(scene.role(robot.role), robot.role.into()),
        );
    }
    legend(&mut canvas, scene, record);
    canvas.finish()
}

const START: Marker = Marker {
    shape: Shape::Ring,
    colour: "#404040",
    size: 2.0,
};

fn legend(canvas: &mut Canvas, scene: &Scene, record: &TrialRecord) {
    canvas.legend_mark(START, "start");
    for (number, name) in scene.roles.iter().enumerate() {
        if record.robots.iter().any(|robot| usize::from(robot.role) == number) {
            canvas.legend_mark(style::role(name, number), &format!("end, as {name}"));
        }
    }
    if !scene.targets.is_empty() {
        canvas.legend_mark(
            Marker {
                size: TARGET.size * 0.7,
                ..TARGET
            },
            "target",
        );
    }
}

/// The places where a robot was sampled, and where it ended.
fn path(record: &TrialRecord, robot: usize) -> Vec<Vec2> {
    let sampled = record.trajectories.iter().filter_map(|(_, places)| places.get(robot));
    let places = sampled.map(|[x, y]| Vec2::new(f64::from(*x), f64::from(*y)));
    let mut path: Vec<Vec2> = Vec::new();
    for place in places.chain([record.robots[robot].pose.position]) {
        if path.last().is_none_or(|last| (place - last).norm() >= RESOLUTION) {
            path.push(place);
        }
    }
    path
}
