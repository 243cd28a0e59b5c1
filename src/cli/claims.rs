//! `inroads claims`.

use std::path::Path;

use super::{Done, say::say};
use crate::evidence;

/// A table in Markdown on the standard output.
pub(super) fn claims(results: &Path) -> Done {
    say!("{}", evidence::claims(results)?);
    Ok(())
}
