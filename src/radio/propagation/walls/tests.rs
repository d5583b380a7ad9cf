use proptest::prelude::*;

use super::*;

fn place(x: f64, y: f64) -> Vec2 {
    Vec2::new(x, y)
}

fn wall(from: (f64, f64), to: (f64, f64)) -> Obstacle {
    let [from, to] = [from, to].map(|(x, y)| place(x, y));
    Obstacle {
        shape: Shape::Segment(from, to),
        attenuation: None,
    }
}

fn disc(centre: (f64, f64), radius: f64) -> Obstacle {
    let centre = place(centre.0, centre.1);
    Obstacle {
        shape: Shape::Disc { centre, radius },
        attenuation: None,
    }
}

fn losing(obstacle: Obstacle, loss: f64) -> Obstacle {
    Obstacle {
        attenuation: Some(loss),
        ..obstacle
    }
}

/// Loss between two places, 8 dB an obstacle that does not say otherwise.
fn loss(obstacles: &[Obstacle], a: (f64, f64), b: (f64, f64)) -> f64 {
    Walls::new(obstacles, 8.0).loss_db(place(a.0, a.1), place(b.0, b.1))
}

#[track_caller]
fn assert_loss(obstacles: &[Obstacle], a: (f64, f64), b: (f64, f64), expected: f64) {
    for (a, b) in [(a, b), (b, a)] {
        let found = loss(obstacles, a, b);
        assert!(
            (found - expected).abs() < 1e-12,
            "{a:?} to {b:?}: {found}, not {expected}"
        );
        let [a, b] = [a, b].map(|(x, y)| place(x, y));
        assert_eq!(Walls::new(obstacles, 8.0).blocked(a, b), expected > 0.0);
    }
}

#[test]
fn each_wall_in_the_way_takes_off_its_own_and_others_nothing() {
    let walls = [
        wall((0.0, -1.0), (0.0, 1.0)),
        losing(wall((1.0, -1.0), (1.0, 1.0)), 3.0),
        wall((5.0, -1.0), (5.0, 1.0)),
        losing(disc((3.0, 0.5), 0.6), 10.0),
    ];
    assert_loss(&walls, (-1.0, 0.0), (2.0, 0.0), 11.0);
    assert_loss(&walls, (-1.0, 0.0), (9.0, 0.0), 8.0 + 3.0 + 8.0 + 10.0);
    assert_loss(&walls, (-1.0, 0.0), (-2.0, 0.0), 0.0);
    assert_loss(&walls, (-1.0, 2.0), (2.0, 2.0), 0.0);
    assert_loss(&walls, (0.2, 0.0), (0.8, 0.0), 0.0);
    assert_loss(&[], (0.0, 0.0), (1.0, 0.0), 0.0);
}

#[test]
fn a_disc_counts_once_be_it_crossed_touched_or_with_an_end_in_it() {
    let discs = [disc((0.0, 0.0), 1.0)];
    assert_loss(&discs, (-2.0, 0.3), (2.0, 0.1), 8.0);
    assert_loss(&discs, (-2.0, 0.0), (0.0, 0.0), 8.0);
    assert_loss(&discs, (-0.5, 0.0), (0.5, 0.0), 8.0);
    assert_loss(&discs, (-2.0, 1.0), (2.0, 1.0), 8.0);
    assert_loss(&discs, (-2.0, 1.001), (2.0, 1.001), 0.0);
    assert_loss(&discs, (1.1, 0.0), (2.0, 0.0), 0.0);
    assert_loss(&discs, (0.2, 0.2), (0.2, 0.2), 8.0);
}

#[test]
fn touching_the_end_of_a_wall_counts_once() {
    let walls = [wall((0.0, 0.0), (0.0, 1.0))];
    // Through its end, ending at its end, ending at its middle, along it, along a part of it, and beside it on one line.
    assert_loss(&walls, (-1.0, 1.0), (1.0, 1.0), 8.0);
    assert_loss(&walls, (-1.0, 0.5), (0.0, 1.0), 8.0);
    assert_loss(&walls, (-1.0, 0.5), (0.0, 0.5), 8.0);
    assert_loss(&walls, (0.0, -1.0), (0.0, 2.0), 8.0);
    assert_loss(&walls, (0.0, 0.2), (0.0, 0.4), 8.0);
    assert_loss(&walls, (0.0, 0.2), (0.0, 3.0), 8.0);
    assert_loss(&walls, (0.0, -2.0), (0.0, 0.0), 8.0);
    assert_loss(&walls, (0.0, -2.0), (0.0, -1.0), 0.0);
    assert_loss(&walls, (0.0, 0.5), (0.0, 0.5), 8.0);
    assert_loss(&walls, (0.5, 0.5), (0.5, 0.5), 0.0);
    let slanted = [wall((0.0, 0.0), (2.0, 2.0))];
    assert_loss(&slanted, (1.0, 1.0), (1.0, 1.0), 8.0);
    assert_loss(&slanted, (0.5, 1.5), (0.5, 1.5), 0.0);
}

#[test]
fn through_the_corner_of_a_room_a_line_meets_the_thicker_wall_alone() {
    let room = [
        wall((0.0, 0.0), (1.0, 0.0)),
        losing(wall((1.0, 0.0), (1.0, 1.0)), 20.0),
        wall((1.0, 1.0), (0.0, 1.0)),
        wall((0.0, 1.0), (0.0, 0.0)),
    ];
    assert_loss(&room, (0.5, 0.5), (1.5, 1.5), 20.0);
    assert_loss(&room, (0.5, 0.5), (-0.5, -0.5), 8.0);
    assert_loss(&room, (-0.5, -0.5), (1.5, 1.5), 28.0);
    assert_loss(&room, (0.5, 0.5), (0.9, 0.9), 0.0);
    assert_loss(&room, (0.5, 0.5), (1.0, 1.0), 20.0);
    assert_loss(&room, (0.5, 0.5), (2.0, 0.6), 20.0);
}

/// Coordinates on a coarse lattice make lines and ends meet exactly; others never do.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        (-6..=6_i8).prop_map(f64::from),
        (-60..=60_i8).prop_map(|tenths| f64::from(tenths) / 10.0),
        -7.0..7.0_f64,
    ]
}

fn point() -> impl Strategy<Value = (f64, f64)> {
    (coordinate(), coordinate())
}

fn obstacle() -> impl Strategy<Value = Obstacle> {
    let loss = prop::option::of((1..20_u8).prop_map(f64::from));
    let shape = prop_oneof![
        3 => (point(), point()).prop_map(|(from, to)| wall(from, to)),
        1 => (point(), 0.0..2.0_f64).prop_map(|(centre, radius)| disc(centre, radius)),
    ];
    (shape, loss).prop_map(|(obstacle, attenuation)| Obstacle {
        attenuation,
        ..obstacle
    })
}

/// Every obstacle by itself: of those met only in their ends, the one that takes off most at each place.
fn by_hand(obstacles: &[Obstacle], a: Vec2, b: Vec2) -> f64 {
    let mut corners: Vec<(Vec2, f64)> = Vec::new();
    let mut sum = 0.0;
    for obstacle in obstacles {
        let loss = obstacle.attenuation.unwrap_or(8.0);
        match obstacle.shape.crossing(Line::between(a, b)) {
            Crossing::None => {}
            Crossing::Within => sum += loss,
            Crossing::AtEnd(end) => corners.push((end, loss)),
        }
    }
    corners.sort_by(|(_, first), (_, second)| second.total_cmp(first));
    while let Some(&(corner, loss)) = corners.first() {
        sum += loss;
        corners.retain(|(other, _)| *other != corner);
    }
    sum
}

/// Whether two segments meet, by solving for where their lines do.
fn meet([a, b]: [Vec2; 2], [from, to]: [Vec2; 2]) -> Option<bool> {
    let [along, other] = [b - a, to - from];
    let area = along.perp(&other);
    let shares = [other, along].map(|direction| (from - a).perp(&direction) / area);
    // Too near to an end to be told.
    let clear = |share: f64| share.abs() > 1e-6 && (share - 1.0).abs() > 1e-6;
    (area.abs() > 1e-6 && shares.into_iter().all(clear)).then(|| shares.iter().all(|share| (0.0..=1.0).contains(share)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn a_grid_finds_what_holding_the_line_against_all_finds(
        obstacles in prop::collection::vec(obstacle(), 0..60), a in point(), b in point(),
    ) {
        let [a, b] = [a, b].map(|(x, y)| place(x, y));
        let walls = Walls::new(&obstacles, 8.0);
        let expected = by_hand(&obstacles, a, b);
        prop_assert!((walls.loss_db(a, b) - expected).abs() < 1e-9, "{} is not {expected}", walls.loss_db(a, b));
        prop_assert_eq!(walls.blocked(a, b), expected > 0.0);
    }

    /// Walls that end on a lattice, and lines through those ends: they meet where cells do.
    #[test]
    fn no_rounding_moves_a_line_out_of_the_cell_where_it_touches_a_wall(
        step in prop::sample::select(vec![0.1, 0.3, 0.7, 1.1]),
        offset in (0..20_u8).prop_map(|tenths| f64::from(tenths) * 0.1),
        ends in prop::collection::vec((0..13_u8, 0..13_u8, any::<bool>()), 2..80),
        along in prop::sample::select(vec![(1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, -1.0), (1.0, 0.5)]),
        steps in 1..4_u8,
    ) {
        let at = |index: u8| offset + f64::from(index) * step;
        let back = |upright: bool| if upright { place(0.0, -0.3) } else { place(-0.3, 0.0) } * step;
        let obstacles: Vec<Obstacle> = ends
            .iter()
            .map(|&(x, y, upright)| {
                let from = place(at(x), at(y));
                Obstacle { shape: Shape::Segment(from, from + back(upright)), attenuation: None }
            })
            .collect();
        let walls = Walls::new(&obstacles, 8.0);
        let along = place(along.0, along.1) * (step * f64::from(steps));
        for &(x, y, _) in &ends {
            let end = place(at(x), at(y));
            for (a, b) in [(end - along, end + along), (end, end + along)] {
                prop_assert!((walls.loss_db(a, b) - by_hand(&obstacles, a, b)).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn both_directions_lose_the_same_to_the_last_bit(
        obstacles in prop::collection::vec(obstacle(), 0..30), a in point(), b in point(),
    ) {
        let [a, b] = [a, b].map(|(x, y)| place(x, y));
        let walls = Walls::new(&obstacles, 8.0);
        prop_assert_eq!(walls.loss_db(a, b).to_bits(), walls.loss_db(b, a).to_bits());
        prop_assert_eq!(walls.blocked(a, b), walls.blocked(b, a));
    }

    #[test]
    fn a_wall_is_met_where_its_line_and_the_other_meet(a in point(), b in point(), c in point(), d in point()) {
        let [a, b, c, d] = [a, b, c, d].map(|(x, y)| place(x, y));
        if let Some(expected) = meet([a, b], [c, d]) {
            let shape = Shape::Segment(c, d);
            prop_assert_eq!(shape.crossing(Line::between(a, b)) != Crossing::None, expected);
        }
    }

    #[test]
    fn places_far_from_all_walls_are_held_against_them_all_the_same(
        obstacles in prop::collection::vec(obstacle(), 1..30), angle in 0.0..std::f64::consts::TAU, shift in point(),
    ) {
        let direction = crate::geometry::unit(angle);
        let shift = place(shift.0, shift.1);
        let walls = Walls::new(&obstacles, 8.0);
        for reach in [30.0, 1e4] {
            let [a, b] = [shift + direction * reach, shift - direction * reach];
            prop_assert!((walls.loss_db(a, b) - by_hand(&obstacles, a, b)).abs() < 1e-9);
        }
    }
}
