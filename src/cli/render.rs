//! `inroads render`.

use std::path::Path;

use super::Done;
use crate::{
    draw,
    run::{Run, RunError},
    session::Protocol,
};

pub(super) fn render(path: &Path, episode: u64, out: Option<&Path>, chain_alone: bool) -> Done {
    let mut run = Run::open(path, None)?;
    let protocol = if chain_alone { Protocol::ChainAlone } else { Protocol::Frozen };
    let watched = run.session.evaluate(protocol, episode)?.ok_or(RunError::NoSkills)?;
    let default = || run.folder.figures().join(format!("episode-{episode}.gif"));
    let out = out.map_or_else(default, Path::to_owned);
    draw::movie(&run, &watched, &out)?;
    eprintln!("drew {}", out.display());
    Ok(())
}
