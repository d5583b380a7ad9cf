//! Results as files: Parquet, JSON, SVG. Reads records only.
