//! `inroads render`.

use std::path::{Path, PathBuf};

use image::RgbImage;
use inroads_envs::registry;

use super::{Done, world};
use crate::{
    config::{ConfigError, World},
    draw, figures,
    film::{Play, View, film},
    run::{Run, RunError},
    session::{self, Protocol, Watched},
};

/// How long a frame is shown, hundredths of a second.
const DELAY: u16 = 7;

/// What `inroads render` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A run's folder, or the name of an environment, in which random actions are taken then
    what: String,
    /// Of a run: which evaluation episode
    #[arg(long, default_value_t = 0)]
    episode: u64,
    /// Of a run: use learned skills alone wherever one may start
    #[arg(long)]
    chain_alone: bool,
    /// Of an environment: the episode's seed
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Of an environment: how many steps
    #[arg(long, default_value_t = 100)]
    steps: u32,
    /// Draw the world itself, from this side (default: a run's map, coloured by skill, where there is one; an environment from beside)
    #[arg(long)]
    view: Option<View>,
    /// How wide it is, pixels
    #[arg(long, default_value_t = 480, value_parser = clap::value_parser!(u32).range(16..=4096))]
    width: u32,
    /// Where to draw it: a GIF, or the last frame as a PNG (default: figures/episode-N.gif in the run's folder, or
    /// ENVIRONMENT.gif)
    #[arg(long)]
    out: Option<PathBuf>,
    #[command(flatten)]
    world: world::Arguments,
}

pub(super) fn render(arguments: &Arguments) -> Done {
    let out = if registry::entries().any(|entry| entry.name == arguments.what) {
        of_environment(arguments)?
    } else if Path::new(&arguments.what).exists() {
        of_run(arguments)?
    } else {
        let names = registry::entries().map(|entry| entry.name);
        let nearest = registry::nearest(&arguments.what, names).unwrap_or_default();
        return Err(RunError::NothingToRender { what: arguments.what.clone(), nearest });
    };
    eprintln!("drew {}", out.display());
    Ok(())
}

fn of_run(arguments: &Arguments) -> Result<PathBuf, RunError> {
    if arguments.world.any() {
        let why = "a run keeps the map, scale, body, see and layout that it was trained with; leave them out"
            .to_owned();
        return Err(ConfigError::Impossible { table: "the run".into(), why }.into());
    }
    let mut run = Run::open(Path::new(&arguments.what), None)?;
    let protocol = if arguments.chain_alone { Protocol::ChainAlone } else { Protocol::Frozen };
    let watched = run.session.evaluate(protocol, arguments.episode)?.ok_or(RunError::NoSkills)?;
    let default = || run.folder.figures().join(format!("episode-{}.gif", arguments.episode));
    let out = arguments.out.clone().unwrap_or_else(default);
    let settings = &run.config.settings;
    if arguments.view.is_none() && draw::View::of(settings).is_some() {
        draw::movie(&run, &watched, &out)?;
        return Ok(out);
    }
    // What has no map is its own picture.
    let view = arguments.view.unwrap_or(View::Above);
    let env = session::environment(settings)?;
    let Watched { start, actions, .. } = watched;
    write(&film(env, start, &Play::Actions(actions), view, arguments.width)?, &out)?;
    Ok(out)
}

fn of_environment(arguments: &Arguments) -> Result<PathBuf, RunError> {
    let mut own = World::default();
    arguments.world.put(&mut own)?;
    let env = session::world(&arguments.what, &own)?;
    let view = arguments.view.unwrap_or(View::Beside);
    let out = arguments.out.clone().unwrap_or_else(|| format!("{}.gif", arguments.what).into());
    write(&film(env, arguments.seed, &Play::Random(arguments.steps), view, arguments.width)?, &out)?;
    Ok(out)
}

fn write(frames: &[RgbImage], out: &Path) -> Done {
    match frames.last() {
        Some(last) if out.extension().is_some_and(|e| e == "png") => figures::still(out, last)?,
        _ => figures::film(out, frames, DELAY)?,
    }
    Ok(())
}
