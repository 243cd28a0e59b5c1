//! `inroads plot`.

use std::path::{Path, PathBuf};

use inroads_envs::Space;

use super::Done;
use crate::{
    draw,
    run::Run,
    session::{Protocol, Watched},
};

pub(super) fn plot(paths: &[PathBuf], out: &Path) -> Done {
    let mut runs = paths.iter().map(|path| Run::open(path, None)).collect::<Result<Vec<_>, _>>()?;
    if let [run] = &mut runs[..] {
        let frozen = run.evaluate(Protocol::Frozen, run.config.settings.evaluation_episodes)?;
        return drawn(run, &frozen);
    }
    draw::curves(&runs, out)?;
    eprintln!("drew {}", out.display());
    Ok(())
}

/// Draws the figures of one run, and says where they are and what has none.
pub(super) fn drawn(run: &mut Run, frozen: &[Watched]) -> Done {
    draw::figures(run, frozen)?;
    eprintln!("figures are in {}", run.folder.figures().display());
    let environment = &run.config.settings.environment;
    if let Space::Frame { .. } = run.session.spec().observation {
        eprintln!(
            "`{environment}` is seen as pictures, which have no coordinates: no sets and trajectories are drawn; films of \
             episodes: inroads render {}",
            run.folder.path().display()
        );
    }
    Ok(())
}
