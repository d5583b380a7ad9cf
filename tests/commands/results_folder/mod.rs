//! What `desim scenario` leaves behind: the results folder, its resumption, its refusals, its report, its exit status. All of it
//! is about folders with their tables, which a build without Parquet does not write.

mod air;
mod asked;
mod command;
mod documentation;
mod explain;
mod fixture;
mod folder;
mod harm;
mod hostile;
mod page;
mod read_back;
mod replay;
mod report;
mod streams;
mod trace;
