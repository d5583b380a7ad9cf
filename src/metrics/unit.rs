//! Units of figures, as results name them.

use std::borrow::Cow;

/// Name of a unit.
pub type Unit = Cow<'static, str>;

/// The unit of what has none: ratios, shares, λ₂.
pub(super) const DIMENSIONLESS: &str = "1";
pub(super) const STEPS: &str = "control steps";
pub(super) const SECONDS: &str = "s";
