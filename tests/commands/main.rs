//! What the commands leave behind and what people read of it: folders of results and of studies.

#[path = "../shipped/mod.rs"]
mod shipped;

mod harm;
#[cfg(feature = "parquet")]
mod results_folder;
mod runs;
mod shards;
mod studies;
mod validate;
