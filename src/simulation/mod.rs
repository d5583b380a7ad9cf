//! The event loop of one run: it carries frames, moves robots and calls the recorder, and decides nothing itself.
