//! The arguments that change an environment: a maze or a body of the user's own, a way of seeing, layouts.

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
    /// How a world of cells or sprites is seen: symbols; rgb or grey (luma) as drawn; rgb:84 or grey:84 (mean of the
    /// channels) as the thesis' author scales; atari (luma, 84 by 84)
    #[arg(long)]
    see: Option<String>,
    /// Its layouts: random, fixed:42 (one for all episodes), map:42 (one map, starts anywhere)
    #[arg(long)]
    layout: Option<String>,
}

impl Arguments {
    /// Whether any was given.
    pub(super) fn any(&self) -> bool {
        let Self { map, scale, body, see, layout } = self;
        map.is_some() || scale.is_some() || body.is_some() || see.is_some() || layout.is_some()
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
        for (own, given) in [(&mut world.see, &self.see), (&mut world.layout, &self.layout)] {
            if let Some(given) = given {
                own.clone_from(given);
            }
        }
        Ok(())
    }
}

fn read(path: &Path) -> Result<String, ConfigError> {
    fs::read_to_string(path)
        .map_err(|e| ConfigError::Unreadable { path: path.display().to_string(), why: e.to_string() })
}
