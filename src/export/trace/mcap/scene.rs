//! What a recording draws around its robots: links between them, and what stands still.

use foxglove::messages::line_primitive::Type;
use foxglove::messages::{CylinderPrimitive, LinePrimitive, SceneEntity, SceneUpdate, TextPrimitive};

use super::super::context::Run;
use super::super::palette::{INK, LINK, OBSTACLE, Rgb, TARGET};
use super::message::{colour, entity, point, pose, vector};
use crate::engine::{ActorId, SimTime};
use crate::geometry::Vec2;
use crate::motion::{ObstacleConfig, World};

/// How high things on the ground are drawn, metres: enough to be seen from the side.
const HEIGHT: f64 = 0.05;

/// Who is linked to whom now: one list of lines, whose points are the places of all robots and whose indices are pairs of robots.
pub fn links(run: &Run, world: &World) -> SceneUpdate {
    let mut entity = entity(world.now(), "links");
    let pairs = pairs(run, world);
    // Without indices a reader would join all the points.
    if !pairs.is_empty() {
        let points = world.positions().iter().copied();
        let mut lines = lines(Type::LineList, points, LINK, 0.6, 1.0);
        lines.indices = pairs;
        entity.lines.push(lines);
    }
    SceneUpdate {
        deletions: Vec::new(),
        entities: vec![entity],
    }
}

/// The ends of each link, the lower one first, in their order.
fn pairs(run: &Run, world: &World) -> Vec<u32> {
    let now = world.now();
    let mut pairs = Vec::new();
    let mut ends = Vec::new();
    for (robot, &place) in (0..).zip(world.positions()) {
        let here = (ActorId(robot), place);
        world.for_each_around(place, now, run.reach.farthest(), |other, there| {
            if other > here.0 && run.reach.linked(here, (other, there)) {
                ends.push(other.0);
            }
        });
        ends.sort_unstable();
        pairs.extend(ends.drain(..).flat_map(|other| [robot, other]));
    }
    pairs
}

/// What stands still: the arena, its obstacles, the mission's targets.
pub fn still(run: &Run, at: SimTime) -> SceneUpdate {
    let mut entities = vec![arena(run, at)];
    if !run.scenario.arena.obstacles.is_empty() {
        entities.push(obstacles(run, at));
    }
    entities.extend(targets(run, at));
    SceneUpdate {
        deletions: Vec::new(),
        entities,
    }
}

fn arena(run: &Run, at: SimTime) -> SceneEntity {
    let (width, height) = run.scenario.arena.size;
    let half = Vec2::new(width.get(), height.get()) / 2.0;
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corners = corners.map(|(x, y)| Vec2::new(x * half.x, y * half.y));
    let mut entity = entity(at, "arena");
    entity.lines.push(lines(Type::LineLoop, corners, INK, 1.0, 2.0));
    entity
}

fn obstacles(run: &Run, at: SimTime) -> SceneEntity {
    let mut entity = entity(at, "obstacles");
    for obstacle in &run.scenario.arena.obstacles {
        match obstacle {
            ObstacleConfig::Disc { at: (x, y), radius, .. } => {
                let place = Vec2::new(x.get(), y.get());
                entity.cylinders.push(disc(place, radius.get(), OBSTACLE, 1.0));
            }
            ObstacleConfig::Wall { from, to, .. } => {
                let ends = [from, to].map(|(x, y)| Vec2::new(x.get(), y.get()));
                entity.lines.push(lines(Type::LineStrip, ends, OBSTACLE, 1.0, 3.0));
            }
        }
    }
    entity
}

fn targets(run: &Run, at: SimTime) -> Option<SceneEntity> {
    let targets = run.scenario.protocol.targets()?;
    let mut entity = entity(at, "targets");
    for (number, &(place, _)) in targets.places.iter().enumerate() {
        entity.cylinders.push(disc(place, targets.near, TARGET, 0.4));
        entity.texts.push(TextPrimitive {
            pose: Some(pose(place, 4.0 * HEIGHT)),
            billboard: true,
            font_size: 14.0,
            scale_invariant: true,
            color: Some(colour(INK, 1.0)),
            text: format!("target {number}"),
        });
    }
    Some(entity)
}

/// A flat disc on the ground.
fn disc(place: Vec2, radius: f64, rgb: Rgb, opacity: f64) -> CylinderPrimitive {
    CylinderPrimitive {
        pose: Some(pose(place, HEIGHT / 2.0)),
        size: Some(vector(2.0 * radius, 2.0 * radius, HEIGHT)),
        bottom_scale: 1.0,
        top_scale: 1.0,
        color: Some(colour(rgb, opacity)),
    }
}

/// Lines so many pixels thick.
fn lines(kind: Type, points: impl IntoIterator<Item = Vec2>, rgb: Rgb, opacity: f64, thickness: f64) -> LinePrimitive {
    LinePrimitive {
        r#type: kind.into(),
        pose: Some(pose(Vec2::zeros(), 0.0)),
        thickness,
        scale_invariant: true,
        points: points.into_iter().map(point).collect(),
        color: Some(colour(rgb, opacity)),
        colors: Vec::new(),
        indices: Vec::new(),
    }
}
