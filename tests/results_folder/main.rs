//! What `desim scenario` leaves behind: the results folder, its resumption, its refusals, its report, its exit status.

mod command;
#[cfg(feature = "parquet")]
mod documentation;
mod explain;
mod fixture;
mod folder;
mod report;
