//! Results as text for a terminal. Reads summaries only.
