//! From text to a value of some type, or to where and why that failed.

use ron::error::{Error, SpannedError};
use ron::extensions::Extensions;

use super::path::FieldPath;
use super::tree::MAX_DEPTH;
use crate::kind::RonReader;

/// How scenario files are read and written: variants hold their fields without a second pair of brackets.
pub fn options() -> ron::Options {
    ron::Options::default()
        .with_default_extension(Extensions::UNWRAP_VARIANT_NEWTYPES | Extensions::IMPLICIT_SOME)
        .with_recursion_limit(MAX_DEPTH)
}

/// What `read` makes of `text`.
pub fn typed_by<T>(
    text: &str,
    read: impl FnOnce(RonReader<'_, '_, '_, '_>) -> Result<T, Error>,
) -> Result<T, Box<Failure>> {
    let at_start = |error: SpannedError| {
        Box::new(Failure {
            error,
            path: FieldPath::default(),
            whole: true,
        })
    };
    let mut reader = ron::Deserializer::from_str_with_options(text, &options()).map_err(at_start)?;
    let mut track = serde_path_to_error::Track::new();
    let read = read(serde_path_to_error::Deserializer::new(&mut reader, &mut track));
    let read = read.and_then(|document| reader.end().map(|()| document));
    read.map_err(|code| {
        let path = track.path();
        let unknown = |segment: &_| matches!(segment, serde_path_to_error::Segment::Unknown);
        Box::new(Failure {
            error: reader.span_error(code),
            path: FieldPath::reached(&path),
            whole: !path.iter().any(unknown),
        })
    })
}

/// An error of serde, with the path that it had reached.
pub struct Failure {
    pub error: SpannedError,
    pub path: FieldPath,
    /// Whether the path is known to its last step.
    pub whole: bool,
}
