//! `inroads plot`.

use std::path::{Path, PathBuf};

use super::Done;
use crate::{draw, run::Run, session::Protocol};

pub(super) fn plot(paths: &[PathBuf], out: &Path) -> Done {
    let mut runs = paths.iter().map(|path| Run::open(path, None)).collect::<Result<Vec<_>, _>>()?;
    if let [run] = &mut runs[..] {
        let frozen = run.evaluate(Protocol::Frozen, run.config.settings.evaluation_episodes)?;
        draw::figures(run, &frozen)?;
        eprintln!("figures are in {}", run.folder.figures().display());
    } else {
        draw::curves(&runs, out)?;
        eprintln!("drew {}", out.display());
    }
    Ok(())
}
