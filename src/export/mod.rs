//! What an experiment leaves on disk: tables, pictures, the summary, the manifest. Reads records only.

mod names;
mod picture;
#[cfg(feature = "parquet")]
mod table;
#[cfg(feature = "parquet")]
mod tables;

pub use names::Names;
pub use picture::Scene;
#[cfg(feature = "parquet")]
pub use tables::Tables;
