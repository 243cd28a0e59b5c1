//! From runs to figures: what the pictures of a run show, in the plain data that `crate::figures` draws.

mod goals;
mod graph;
mod skills;

pub use goals::Questions;
pub use graph::{differ, feature_name, tried, whereabouts};

use std::path::Path;

use inroads_envs::{maze::Picture, registry};

use crate::{
    config::Settings,
    figures::{self, Map, Panel, Pose, Raster, Rect, Series, Trajectory},
    run::{Run, RunError},
    session::{self, EpisodeMetrics, Watched},
};

/// Columns and rows of the raster on which initiation sets are drawn and measured.
const RASTER: usize = 160;
/// Metres of the outer wall that are shown.
const BORDER: f32 = 0.75;
/// Episodes over which curves are smoothed.
const SMOOTHING: usize = 20;
/// Solution trajectories in one figure.
const TRAJECTORIES: usize = 5;

/// A run's environment seen from above, and what an agent would see at a place of it.
pub struct View {
    picture: Picture,
    /// The map.
    pub map: Map,
}

impl View {
    /// The view of an environment; none where there is no map.
    pub fn of(settings: &Settings) -> Option<Self> {
        let picture =
            settings.world.with_options(|options| registry::picture_with(&settings.environment, options));
        let picture = picture.ok()??;
        // A maze without a task has a map with a goal all the same.
        let has_goal = session::environment(settings).is_ok_and(|env| env.spec().goal.is_some());
        let point = |p: [f64; 2]| [p[0] as f32, p[1] as f32];
        let rect = |r: &inroads_envs::maze::Rectangle| Rect { min: point(r.low), max: point(r.high) };
        let free = rect(&picture.bounds);
        let map = Map {
            walls: picture.walls.iter().map(rect).collect(),
            bounds: Rect { min: free.min.map(|x| x - BORDER), max: free.max.map(|x| x + BORDER) },
            goal: has_goal.then(|| (point(picture.goal), picture.tolerance as f32)),
            starts: picture.starts.iter().map(|s| point(*s)).collect(),
            key: picture.key.map(point),
        };
        Some(Self { picture, map })
    }

    /// The initiation set of each skill of a run, without the key or with it; nothing with it where there is no key.
    pub fn sets(&self, run: &Run, held: bool) -> Vec<Raster> {
        if held && self.picture.key.is_none() {
            return Vec::new();
        }
        let skills = run.session.skills().len();
        let mut rasters = vec![Raster { nx: RASTER, ny: RASTER, inside: Vec::new() }; skills];
        Raster::of(&self.map, RASTER, RASTER, |at| {
            let at = at.map(f64::from);
            let holding = held.then(|| self.picture.holding_at(at)).flatten();
            let members = run.session.members(&holding.unwrap_or_else(|| self.picture.observation_at(at)));
            for (raster, member) in rasters.iter_mut().zip(members) {
                raster.inside.push(member);
            }
            false
        });
        rasters
    }
}

/// Draws all figures of one run into its folder; no learning curve where nothing was ever paid.
///
/// # Errors
/// [`RunError`] names the file that cannot be written.
pub fn figures(run: &mut Run, frozen: &[Watched]) -> Result<(), RunError> {
    let folder = run.folder.figures();
    if run.folder.read_metrics()?.iter().any(|m| m.reward != 0.0 || m.success) {
        curves(std::slice::from_ref(run), &folder.join("learning-curve.png"))?;
    }
    goals::growth(run)?;
    graph::graph(run)?;
    let Some(view) = View::of(&run.config.settings) else { return Ok(()) };
    skills::sets(run, &view)?;
    skills::tree(run, &view)?;
    let trajectories: Vec<_> = frozen
        .iter()
        .take(TRAJECTORIES)
        .map(|w| Trajectory { points: w.acted().map(|(s, skill)| ([s[0], s[1]], skill)).collect() })
        .collect();
    figures::trajectories(folder.join("trajectories.png"), &view.map, &trajectories)?;
    Ok(())
}

/// Draws the learning curves of runs, those of one agent together.
///
/// # Errors
/// [`RunError`] names the file that cannot be read or written.
pub fn curves(runs: &[Run], path: &Path) -> Result<(), RunError> {
    let mut agents: Vec<(String, Vec<Vec<EpisodeMetrics>>)> = Vec::new();
    for run in runs {
        let (name, metrics) = (run.config.settings.agent.clone(), run.folder.read_metrics()?);
        match agents.iter_mut().find(|(agent, _)| *agent == name) {
            Some((_, all)) => all.push(metrics),
            None => agents.push((name, vec![metrics])),
        }
    }
    let series = |value: fn(&EpisodeMetrics) -> f64| -> Vec<Series> {
        let points = |run: &Vec<EpisodeMetrics>| run.iter().map(|m| (m.env_steps as f64, value(m))).collect();
        let named = agents.iter().enumerate();
        named
            .map(|(i, (agent, all))| Series {
                label: agent.to_uppercase(),
                colour: i + 1,
                runs: all.iter().map(points).collect(),
            })
            .collect()
    };
    let panel = |title: &str, y_label: &str, summary, y_range, series| Panel {
        title: title.to_owned(),
        x_label: "environment steps".to_owned(),
        y_label: y_label.to_owned(),
        y_range,
        summary,
        smoothing: SMOOTHING,
        series,
        levels: Vec::new(),
    };
    let environment = runs.first().map_or("", |run| run.config.settings.environment.as_str());
    figures::curves(
        path,
        &[
            panel(
                &format!("{environment}: return in training"),
                "return an episode",
                figures::Summary::MedianAndRange,
                None,
                series(|m| f64::from(m.reward)),
            ),
            panel(
                &format!("{environment}: success in training"),
                "share of episodes",
                figures::Summary::MeanAndInterval,
                Some((0.0, 1.0)),
                series(|m| if m.success { 1.0 } else { 0.0 }),
            ),
        ],
    )?;
    Ok(())
}

/// Draws one episode as a GIF.
///
/// # Errors
/// [`RunError`] when the environment has no map, or the file cannot be written.
pub fn movie(run: &Run, watched: &Watched, path: &Path) -> Result<(), RunError> {
    let environment = &run.config.settings.environment;
    let view = View::of(&run.config.settings).ok_or_else(|| RunError::NoMap(environment.clone()))?;
    let every = watched.path.len().div_ceil(300);
    let poses: Vec<_> = watched
        .acted()
        .enumerate()
        .filter(|(step, _)| step % every == 0 || step + 1 == watched.path.len())
        .map(|(step, (s, skill))| Pose { step, at: [s[0], s[1]], heading: view.picture.heading(s), skill })
        .collect();
    figures::movie(path, &view.map, &poses)?;
    Ok(())
}
