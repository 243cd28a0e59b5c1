//! What becomes of a run that a fault has stopped: it goes back to the end of its last whole episode.
//!
//! Checkpoints are taken between episodes, and a fault comes in the midst of one. But a run is a function of its seed: the
//! newest checkpoint and the episodes since, lived again, are what was there before the faulty episode, to the bit. That
//! costs no more than those episodes, once, and nothing as long as all goes well.

use std::path::PathBuf;

use super::{Run, RunError};
use crate::session::{EpisodeMetrics, Stopped};

impl Run {
    /// Saves what was learned before the episode that stopped; the error that tells of both.
    pub(super) fn stopped(&mut self, stopped: Stopped) -> RunError {
        match self.go_back() {
            Ok(file) => RunError::Stopped { stopped, file },
            Err(why) => RunError::StoppedUnsaved { stopped, why: Box::new(why) },
        }
    }

    /// Lives again what came after the newest checkpoint, up to the end of the last whole episode, and saves that.
    fn go_back(&mut self) -> Result<PathBuf, RunError> {
        let (episodes, _) = self.session.progress();
        let (file, bag) = self.folder.checkpoint(None)?;
        self.session
            .load(&bag)
            .map_err(|why| RunError::Foreign { file: file.clone(), why: why.to_string() })?;
        let logged = self.folder.read_metrics()?;
        let (saved, _) = self.session.progress();
        let unlike = |episode| RunError::Unlike { episode, file: file.clone() };
        while self.session.progress().0 < episodes {
            let (next, _) = self.session.progress();
            for again in self.session.train().map_err(|_| unlike(next))? {
                if logged.get(again.episode as usize).map(text) != Some(text(&again)) {
                    return Err(unlike(again.episode));
                }
            }
        }
        if saved < episodes {
            self.save()?;
        }
        Ok(self.folder.checkpoint(None)?.0)
    }
}

/// Metrics as they are logged, in which equal numbers are equal.
fn text(metrics: &EpisodeMetrics) -> String {
    serde_json::to_string(metrics).expect("plain data always encodes")
}
