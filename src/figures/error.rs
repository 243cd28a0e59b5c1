//! What can go wrong while drawing.

use std::path::{Path, PathBuf};

/// Why a picture was not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// The file could not be written.
    #[error("cannot write the picture {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The picture could not be encoded.
    #[error("cannot encode the picture {}: {reason}", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// What the encoder said.
        reason: String,
    },
    /// There is nothing to draw, not even an empty picture.
    #[error("nothing to draw in {}: {what}", path.display())]
    Nothing {
        /// The file.
        path: PathBuf,
        /// What is missing.
        what: &'static str,
    },
    /// The picture would have an impossible size.
    #[error("cannot draw {}: a picture of {width} × {height} pixels", path.display())]
    Size {
        /// The file.
        path: PathBuf,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// The bounds of the map enclose no area.
    #[error("cannot draw {}: the map's bounds enclose no area ({bounds})", path.display())]
    Bounds {
        /// The file.
        path: PathBuf,
        /// The bounds, in words.
        bounds: String,
    },
    /// A raster's values do not fill its columns and rows.
    #[error("cannot draw {}: the raster of \"{title}\" has {found} values for {nx} × {ny} cells", path.display())]
    Raster {
        /// The file.
        path: PathBuf,
        /// The panel's title.
        title: String,
        /// Columns.
        nx: usize,
        /// Rows.
        ny: usize,
        /// How many values there are.
        found: usize,
    },
}

/// Writes the encoded picture.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), FigureError> {
    std::fs::write(path, bytes).map_err(|source| FigureError::Write { path: path.to_owned(), source })
}
