//! Missions of the backbone: what it builds, how it mends what fails, what holds between its robots all the while.

mod election;
mod healing;
mod local_tree;
mod missions;
mod relations;

/// How many trials a test of many runs: `usual`, or as many as the variable `DESIM_TRIALS` says.
fn trials(usual: u32) -> u32 {
    let asked = std::env::var("DESIM_TRIALS").ok();
    asked.map_or(usual, |text| text.parse().expect("DESIM_TRIALS is a number"))
}
