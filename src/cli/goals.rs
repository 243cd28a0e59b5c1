//! `inroads goals`: what an agent knows of its goals, or of the subgoals that are vertices of its skill graph.

use std::path::Path;

use inroads_discovery::record::{GoalRecord, GoalState, GraphRecord};
use inroads_envs::Spec;

use super::{Done, say::say, table::table};
use crate::{
    draw::{self, Questions},
    run::{Run, RunError},
};

/// Numbers of a place above which a vertex is told without it.
const NUMBERS: usize = 4;

pub(super) fn goals(path: &Path, checkpoint: Option<&Path>) -> Done {
    let run = Run::open(path, checkpoint)?;
    let (goals, graph) = (run.session.goals(), run.session.graph());
    if goals.is_empty() && graph.is_none() {
        return Err(RunError::NoGoals(run.config.settings.agent));
    }
    if !goals.is_empty() {
        table(of_goals(&goals, &Questions::of(&run.config.settings)));
        say!("{}", counts(&goals));
    }
    if let Some(graph) = graph {
        table(of_vertices(&graph, run.session.spec()));
        say!("{} vertices, {} edges", graph.vertices.len(), graph.edges.len());
    }
    Ok(())
}

/// A row a goal that was observed, the best known first.
fn of_goals(goals: &[GoalRecord], questions: &Questions) -> Vec<Vec<String>> {
    let head = ["goal", "state", "attained", "pursued", "success"].map(str::to_owned).to_vec();
    let mut seen: Vec<_> = goals.iter().filter(|goal| goal.state > GoalState::Unseen).collect();
    seen.sort_by_key(|goal| std::cmp::Reverse(goal.state));
    let row = |goal: &&GoalRecord| {
        let success = match goal.pursued {
            0 => "-".to_owned(),
            _ => format!("{:.0} %", 100.0 * goal.success),
        };
        let (attained, pursued) = (goal.attained.to_string(), goal.pursued.to_string());
        vec![questions.name(&goal.bits), word(goal.state).to_owned(), attained, pursued, success]
    };
    std::iter::once(head).chain(seen.iter().map(row)).collect()
}

fn word(state: GoalState) -> &'static str {
    match state {
        GoalState::Unseen => "unseen",
        GoalState::Pruned => "observed",
        GoalState::Plausible => "plausible",
        GoalState::Mastered => "mastered",
    }
}

fn counts(goals: &[GoalRecord]) -> String {
    let states = [GoalState::Mastered, GoalState::Plausible, GoalState::Pruned];
    let count = |state| goals.iter().filter(|goal| goal.state == state).count();
    let counts = states.map(|state| match state {
        GoalState::Pruned => format!("{} observed and not pursued", count(state)),
        GoalState::Plausible => format!("{} plausible", count(state)),
        _ => format!("{} {}", count(state), word(state)),
    });
    format!("{}, {} never observed", counts.join(", "), count(GoalState::Unseen))
}

/// A row a vertex.
fn of_vertices(graph: &GraphRecord, spec: &Spec) -> Vec<Vec<String>> {
    let differ = draw::differ(graph);
    let head = ["vertex", "at", "visits", "reached", "asks for"].map(str::to_owned).to_vec();
    let row = |vertex: &inroads_discovery::record::VertexRecord| {
        let place = spec.place.iter().filter_map(|&d| draw::whereabouts(vertex, d)).map(number);
        let place: Vec<_> = place.take(NUMBERS).collect();
        let (tries, successes) = draw::tried(graph, vertex.vertex);
        let features = vertex.kept.iter().map(|(feature, value)| {
            format!("{} = {}", draw::feature_name(spec, *feature as usize), number(*value))
        });
        // Where all ask for the same features the place says it already, and it may be a whole board.
        let kept = if differ { features.collect::<Vec<_>>().join(", ") } else { String::new() };
        let visits = vertex.visits.to_string();
        vec![vertex.vertex.to_string(), place.join(","), visits, format!("{successes} of {tries}"), kept]
    };
    std::iter::once(head).chain(graph.vertices.iter().map(row)).collect()
}

/// A number with two decimals, where it has any.
fn number(x: f32) -> String {
    if x.fract() == 0.0 { format!("{x}") } else { format!("{x:.2}") }
}
