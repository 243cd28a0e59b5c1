//! The arguments that put a maze or a body of the user's own in the place of the environment's.

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::config::{ConfigError, World};

/// What stands in the world.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A text file with a maze: # wall, . free, r start, g goal
    #[arg(long)]
    map: Option<PathBuf>,
    /// The side of the maze's cells, metres
    #[arg(long)]
    scale: Option<f64>,
    /// An MJCF file with the body that walks in the maze
    #[arg(long)]
    body: Option<PathBuf>,
}

impl Arguments {
    /// Whether any was given.
    pub(super) fn any(&self) -> bool {
        self.map.is_some() || self.scale.is_some() || self.body.is_some()
    }

    /// Puts what was given in the place of what was there.
    ///
    /// # Errors
    /// [`ConfigError::Unreadable`] names the file.
    pub(super) fn put(&self, world: &mut World) -> Result<(), ConfigError> {
        if let Some(path) = &self.map {
            world.map = read(path)?;
        }
        if let Some(path) = &self.body {
            world.body = read(path)?;
        }
        world.scale = self.scale.unwrap_or(world.scale);
        Ok(())
    }
}

fn read(path: &Path) -> Result<String, ConfigError> {
    fs::read_to_string(path)
        .map_err(|e| ConfigError::Unreadable { path: path.display().to_string(), why: e.to_string() })
}
