//! How the robots of a trial moved.

use svg::Document;

use super::super::scene::Scene;
use super::canvas::{ARENA_PIXELS, Canvas};
use super::style::{self, Marker, Shape, Stroke, TARGET};
use super::{obstacles, subtitle};
use crate::geometry::Vec2;
use crate::metrics::TrialRecord;

/// Places nearer than this to the last one drawn are left out, pixels: less than a line's width.
const RESOLUTION: f64 = 0.7;
/// Widest and narrowest paths, pixels.
const WIDEST: f64 = 1.4;
const NARROWEST: f64 = 0.7;
/// Share of the arena that paths may cover with ink; of what is longer only the end is drawn.
const INK: f64 = 0.12;
/// Paths fade towards their beginning, in so many steps, from and to these opacities.
const STEPS: usize = 5;
const OPACITY: [f64; 2] = [0.2, 0.9];
/// How far a path that is drawn may be from where its robot was, pixels: what nobody sees.
const TOLERANCE: f64 = 0.25;

/// Draws paths by the robots' roles at the end, from a pale dot where they began to their mark where they ended: thinner, the more robots there
/// are, fading towards the beginning, and, where that would still cover the arena, without it.
pub fn draw(scene: &Scene, record: &TrialRecord) -> Document {
    let size = Vec2::new(scene.arena.size.0.get(), scene.arena.size.1.get());
    let pixel = size.max() / ARENA_PIXELS;
    let crowd = (20.0 / record.robots.len().max(1) as f64).sqrt().min(1.0);
    let width = (WIDEST * crowd).max(NARROWEST);
    let most = INK * size.x * size.y / (width * pixel);
    let paths = paths(record, RESOLUTION * pixel, most);
    let since = since(&paths, most);
    let cut = if since > 0.0 {
        format!(", from {since:.0} s on")
    } else {
        String::new()
    };
    let mut canvas = Canvas::new(size, &scene.name, &format!("paths of {}{cut}", subtitle(record)));
    obstacles(&mut canvas, &scene.arena.obstacles);
    // Where they began lies below all: with many robots it is what matters least.
    if since <= 0.0 {
        let starts = paths.iter().filter_map(|path| path.first());
        starts.for_each(|&(_, start)| canvas.mark(start, START));
    }
    let length = record.simulated.as_secs() - since;
    for step in 0..STEPS {
        let part = |number: usize| since + length * number as f64 / STEPS as f64;
        let [faint, clear] = OPACITY;
        let opacity = faint + (clear - faint) * step as f64 / (STEPS - 1) as f64;
        for (robot, path) in record.robots.iter().zip(&paths) {
            let colour = style::role(scene.role(robot.role), robot.role.into()).colour;
            let stretch = simplified(&stretch(path, part(step), part(step + 1)), TOLERANCE * pixel);
            if stretch.len() > 1 {
                let opacity = (opacity * 100.0).round() / 100.0;
                canvas.path(&stretch, Stroke { colour, width, opacity });
            }
        }
    }
    scene.targets.iter().for_each(|&target| canvas.mark(target, TARGET));
    for robot in &record.robots {
        let look = style::role(scene.role(robot.role), robot.role.into());
        let size = look.size * crowd.max(0.6);
        canvas.mark(robot.pose.position, Marker { size, ..look });
    }
    legend(&mut canvas, scene, record, since <= 0.0);
    canvas.finish()
}

const START: Marker = Marker {
    shape: Shape::Disc,
    colour: "#b0b0b0",
    size: 2.4,
};

fn legend(canvas: &mut Canvas, scene: &Scene, record: &TrialRecord, with_start: bool) {
    if with_start {
        canvas.legend_mark(START, "start");
    }
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

/// Where a robot was, and when, seconds.
type Path = Vec<(f64, Vec2)>;

/// The places where each robot was sampled, and where it ended, those closer together than `resolution` metres left out. What is
/// farther back than the last `most` metres of all of them need not be there: a run may be long.
fn paths(record: &TrialRecord, resolution: f64, most: f64) -> Vec<Path> {
    let mut paths = vec![Path::new(); record.robots.len()];
    let mut length = 0.0;
    let mut go = |paths: &mut [Path], robot: usize, at: f64, place: Vec2| {
        let way = paths[robot]
            .last()
            .map_or(f64::INFINITY, |(_, last)| (place - last).norm());
        if way >= resolution {
            paths[robot].push((at, place));
            length += if way.is_finite() { way } else { 0.0 };
        }
        if length > 4.0 * most {
            // What rounding leaves undecided at `most` is well within twice that.
            let from = since(paths, 2.0 * most);
            length = 2.0 * most;
            for path in paths {
                path.drain(..path.partition_point(|(at, _)| *at < from).saturating_sub(1));
            }
        }
    };
    for (at, places) in &record.trajectories {
        for (robot, place) in places.iter().enumerate() {
            go(
                &mut paths,
                robot,
                at.as_secs(),
                Vec2::new(place[0].into(), place[1].into()),
            );
        }
    }
    for (robot, state) in record.robots.iter().enumerate() {
        go(&mut paths, robot, record.simulated.as_secs(), state.pose.position);
    }
    paths
}

/// The time from which on all paths together are no longer than `most` metres; 0 if they are none at all.
fn since(paths: &[Path], most: f64) -> f64 {
    let legs = paths.iter().flat_map(|path| path.windows(2));
    let mut legs: Vec<(f64, f64)> = legs.map(|leg| (leg[1].0, (leg[1].1 - leg[0].1).norm())).collect();
    legs.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut length = 0.0;
    let beyond = legs.into_iter().find(|(_, leg)| {
        length += leg;
        length > most
    });
    beyond.map_or(0.0, |(at, _)| at)
}

/// The part of a path between two times, from where it was when that began.
fn stretch(path: &Path, from: f64, until: f64) -> Vec<Vec2> {
    let first = path.partition_point(|(at, _)| *at < from).saturating_sub(1);
    let last = path.partition_point(|(at, _)| *at <= until);
    let inside = path.get(first..last).unwrap_or_default();
    inside.iter().map(|(_, place)| *place).collect()
}

/// The ends of a line and those of its points without which it would be more than `tolerance` off (Ramer, 1972; Douglas and Peucker, 1973).
fn simplified(line: &[Vec2], tolerance: f64) -> Vec<Vec2> {
    let mut kept = vec![false; line.len()];
    let mut parts = vec![(0, line.len().saturating_sub(1))];
    while let Some((first, last)) = parts.pop() {
        let Some((&from, &to)) = line.get(first).zip(line.get(last)) else {
            continue;
        };
        kept[first] = true;
        kept[last] = true;
        let inner = (first + 1..last).map(|place| (place, off(line[place], from, to)));
        if let Some((place, off)) = inner.max_by(|a, b| a.1.total_cmp(&b.1))
            && off > tolerance
        {
            parts.extend([(first, place), (place, last)]);
        }
    }
    let points = line.iter().zip(kept);
    points.filter_map(|(point, kept)| kept.then_some(*point)).collect()
}

/// How far `at` is from the nearest point between two others.
fn off(at: Vec2, from: Vec2, to: Vec2) -> f64 {
    let way = to - from;
    let along = if way.norm_squared() > 0.0 {
        ((at - from).dot(&way) / way.norm_squared()).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (at - from - way * along).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walk(legs: u32) -> Path {
        (0..=legs)
            .map(|leg| (f64::from(leg), Vec2::new(f64::from(leg), 0.0)))
            .collect()
    }

    #[test]
    fn of_paths_that_would_cover_the_arena_only_the_end_is_drawn() {
        // A hundred robots, a metre a second for 50 s: 5,000 m. Of 1,200 m the last twelve seconds are left.
        let paths = vec![walk(50); 100];
        assert!(since(&paths, 6_000.0) <= 0.0);
        let since = since(&paths, 1_200.0);
        assert!((37.0..=39.0).contains(&since), "{since}");
        let drawn: f64 = paths
            .iter()
            .map(|path| stretch(path, since, 50.0).len() as f64 - 1.0)
            .sum();
        assert!(drawn <= 1_300.0, "{drawn} m");
    }

    #[test]
    fn a_simplified_line_keeps_its_ends_and_corners_and_is_nowhere_off_by_more_than_it_may() {
        let straight: Vec<Vec2> = walk(1_000).into_iter().map(|(_, at)| at).collect();
        assert_eq!(simplified(&straight, 0.1), [straight[0], straight[1_000]]);
        let curve: Vec<Vec2> = (0..2_000)
            .map(|step| {
                let turn = f64::from(step) / 100.0;
                Vec2::new(turn.cos() * turn, turn.sin() * turn)
            })
            .collect();
        let few = simplified(&curve, 0.05);
        assert!((20..300).contains(&few.len()), "{}", few.len());
        for point in &curve {
            let nearest = few
                .windows(2)
                .map(|leg| off(*point, leg[0], leg[1]))
                .fold(f64::INFINITY, f64::min);
            assert!(nearest <= 0.05 + 1e-9, "{nearest}");
        }
        // There and back again, and nothing.
        let back = [0.0, 5.0, 0.0].map(|x| Vec2::new(x, 0.0));
        assert_eq!(simplified(&back, 0.1), back);
        assert!(simplified(&[], 0.1).is_empty());
    }

    #[test]
    fn stretches_of_a_path_join_where_one_ends_and_the_next_begins() {
        let path = walk(10);
        let [first, second] = [stretch(&path, 0.0, 4.5), stretch(&path, 4.5, 10.0)];
        assert_eq!(
            (first.first(), first.last()),
            (Some(&Vec2::new(0.0, 0.0)), Some(&Vec2::new(4.0, 0.0)))
        );
        assert_eq!(
            (second.first(), second.last()),
            (Some(&Vec2::new(4.0, 0.0)), Some(&Vec2::new(10.0, 0.0)))
        );
        assert!(stretch(&Path::new(), 0.0, 1.0).is_empty());
    }
}
