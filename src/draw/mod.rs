//! From runs to figures: what the pictures of a run show, in the plain data that `crate::figures` draws.

mod goals;
mod graph;
mod skills;
mod truth;

pub use goals::Questions;
pub use graph::{differ, feature_name, tried, whereabouts};
pub use truth::truth;

use std::path::Path;

use inroads_discovery::SkillRecord;
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

    /// The initiation set of each skill of a run, the robot at rest: where it may start.
    pub fn sets(&self, run: &Run) -> Vec<Raster> {
        self.rasters(run, |seen| run.session.members(seen))
    }

    /// The same with other features of what is seen changed, such as a key that it carries.
    pub fn sets_where(&self, run: &Run, change: impl Fn(&mut [f32])) -> Vec<Raster> {
        self.rasters(run, |seen| {
            let mut seen = seen.clone();
            change(&mut seen);
            run.session.members(&seen)
        })
    }

    /// The same with the key held; nothing where there is no key.
    pub fn sets_with_key(&self, run: &Run) -> Vec<Raster> {
        if self.picture.key.is_none() {
            return Vec::new();
        }
        let holding = |seen: &Vec<f32>| self.picture.holding_at([seen[0], seen[1]].map(f64::from));
        self.rasters(run, |seen| holding(seen).map_or_else(Vec::new, |seen| run.session.members(&seen)))
    }

    /// Where other skills may aim in order to enter the set of each skill of a run.
    pub fn targets(&self, run: &Run) -> Vec<Raster> {
        self.rasters(run, |seen| run.session.targets(seen))
    }

    /// What is said of all skills, everywhere.
    fn rasters(&self, run: &Run, ask: impl Fn(&Vec<f32>) -> Vec<bool>) -> Vec<Raster> {
        let skills = run.session.skills().len();
        let mut rasters = vec![Raster { nx: RASTER, ny: RASTER, inside: Vec::new() }; skills];
        Raster::of(&self.map, RASTER, RASTER, |at| {
            let said = ask(&self.picture.observation_at(at.map(f64::from)));
            for (raster, member) in rasters.iter_mut().zip(said) {
                raster.inside.push(member);
            }
            false
        });
        rasters
    }

    /// The least rectangle that holds all free space.
    pub fn free(&self) -> Rect {
        let Rect { min, max } = self.map.bounds;
        Rect { min: min.map(|x| x + BORDER), max: max.map(|x| x - BORDER) }
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
    figures::trajectories(folder.join("trajectories.png"), &view.map, &trajectories, "")?;
    Ok(())
}

/// What stands above the picture of a skill.
fn title(skill: &SkillRecord) -> String {
    match skill.enters {
        None => format!("skill {} → reaches the goal", skill.skill),
        Some(parent) => format!("skill {} → enters skill {parent}", skill.skill),
    }
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
        ..Panel::default()
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
