//! Who hears whom, for the bare loops: all ordered pairs within range.

use crate::workload::{RANGE_M, Workload};

/// Links of robot r: `first[r]..first[r + 1]`, found by a grid of cells as wide as the range.
pub fn first_links(workload: &Workload) -> Vec<u32> {
    let side_m = workload.arena.size.0.get();
    let cells = (side_m / RANGE_M).ceil().max(1.0) as usize;
    let cell = |metres: f64| (((metres / side_m + 0.5) * cells as f64) as usize).min(cells - 1);
    let places = workload.poses.iter().map(|pose| pose.position);
    let mut grid = vec![Vec::new(); cells * cells];
    for (robot, place) in places.clone().enumerate() {
        grid[cell(place.y) * cells + cell(place.x)].push(robot);
    }
    let mut first = vec![0];
    let mut count = 0_u32;
    for (robot, place) in places.enumerate() {
        let (x, y) = (cell(place.x), cell(place.y));
        for row in y.saturating_sub(1)..=(y + 1).min(cells - 1) {
            for column in x.saturating_sub(1)..=(x + 1).min(cells - 1) {
                let near =
                    |&&other: &&usize| other != robot && (workload.poses[other].position - place).norm() <= RANGE_M;
                count += grid[row * cells + column].iter().filter(near).count() as u32;
            }
        }
        first.push(count);
    }
    first
}
