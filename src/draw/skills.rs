//! The skills of a chain or tree: where each may start (figure 3.2 of the thesis), and which enters which (3.1.4).

use inroads_discovery::SkillRecord;

use super::View;
use crate::{
    figures::{self, Edge, Graph, Ground, Raster, Role, SetPicture, Vertex},
    run::{Run, RunError},
};

/// Initiation sets in one figure.
const SETS: usize = 25;

/// Draws the initiation sets, a panel a skill; where there is a key a second row shows them with the key held.
pub(super) fn sets(run: &Run, view: &View) -> Result<(), RunError> {
    let skills = run.session.skills();
    if skills.is_empty() {
        return Ok(());
    }
    // Where there are more than one could look at, those that are used.
    let mut most: Vec<usize> = (0..skills.len()).collect();
    most.sort_by_key(|&i| std::cmp::Reverse(skills[i].executions));
    most.truncate(SETS);
    most.sort_unstable();
    let path = run.folder.figures().join("initiation-sets.png");
    let (without, with) = (view.sets(run), view.sets_with_key(run));
    let covers = |region: &Raster| 100.0 * region.share_of_free_space(&view.map);
    let picture = |i: usize, region: &Raster, subtitle: String| SetPicture {
        title: super::title(&skills[i]),
        subtitle,
        colour: skills[i].skill as usize,
        region: region.clone(),
        ..SetPicture::default()
    };
    let plain = |i: usize| format!("covers {:.0} % of free space", covers(&without[i]));
    if with.is_empty() {
        let pictures: Vec<_> = most.iter().map(|&i| picture(i, &without[i], plain(i))).collect();
        figures::sets(path, &view.map, &pictures, "")?;
        return Ok(());
    }
    let lacking = most
        .iter()
        .map(|&i| picture(i, &without[i], format!("without the key: {:.0} %", covers(&without[i]))));
    let holding = most.iter().map(|&i| {
        let both = 100.0 * without[i].overlap(&with[i]);
        picture(i, &with[i], format!("with the key: {:.0} %; overlap {both:.0} %", covers(&with[i])))
    });
    let pictures: Vec<_> = lacking.chain(holding).collect();
    figures::sets_in_columns(path, &view.map, &pictures, most.len(), "")?;
    Ok(())
}

/// Draws which skill enters which: a vertex in the middle of each initiation set, an arrow to the set that it enters.
pub(super) fn tree(run: &Run, view: &View) -> Result<(), RunError> {
    let skills = run.session.skills();
    let Some((goal, _)) = view.map.goal.filter(|_| !skills.is_empty()) else { return Ok(()) };
    let (without, with) = (view.sets(run), view.sets_with_key(run));
    let middle = |i: usize| {
        let without = without[i].middle(&view.map);
        without.or_else(|| with.get(i).and_then(|held| held.middle(&view.map)))
    };
    let number = |k: u32| skills.iter().position(|skill| skill.skill == k);
    let end = Vertex { label: String::new(), at: Some(goal), value: 0.0, role: Role::Goal };
    let vertices = skills.iter().enumerate().map(|(i, skill)| Vertex {
        label: skill.skill.to_string(),
        at: middle(i),
        value: skill.executions as f64,
        role: Role::Plain,
    });
    let edge = |(from, skill): (usize, &SkillRecord)| Edge {
        from,
        to: skill.enters.map_or(Some(skills.len()), number).unwrap_or(skills.len()),
        probability: skill.successes as f64 / skill.executions.max(1) as f64,
        hoped: skill.executions == 0,
        planned: false,
    };
    let settings = &run.config.settings;
    let (episodes, _) = run.session.progress();
    let picture = Graph {
        title: format!("{}: which skill enters which", settings.environment),
        subtitle: format!(
            "{} after {episodes} episodes; arrows by share of executions that succeeded",
            settings.agent
        ),
        value: "executions".to_owned(),
        vertices: vertices.chain([end]).collect(),
        edges: skills.iter().enumerate().map(edge).collect(),
    };
    figures::graph(run.folder.figures().join("skill-tree.png"), Ground::Map(&view.map), &picture)?;
    Ok(())
}
