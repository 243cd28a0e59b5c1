//! What is drawn of single runs, each chosen by a rule that stands below it.
//!
//! A picture of another kind is a variant of [`Draw`] and a function here.

use std::path::Path;

use super::{Choice, Draw, Options, Plan, Shown};
use crate::{
    draw::View,
    figures::{self, Raster, SetPicture, Trajectory},
    run::{Run, RunError},
    session::Protocol,
};

/// Options of one run in a picture, from the goal outwards; runs of one arm.
const MOST: usize = 5;

/// A run that is shown, opened.
struct Chosen {
    name: String,
    label: String,
    rule: String,
    run: Run,
}

/// Draws the pictures of a kind into a folder: a file a domain, of trajectories a file a domain and arm.
pub(super) fn draw(plan: &Plan, draw: &Draw, out: &Path) -> Result<Vec<Shown>, RunError> {
    let mut shown = Vec::new();
    for (d, domain) in plan.experiment.domains.iter().enumerate() {
        match draw {
            Draw::Sets { file, arms, options, runs, feature, values } => {
                let file = format!("{file}-{}.png", domain.name);
                let chosen = choose(plan, d, arms, *runs)?;
                shown.extend(sets(&out.join(&file), &chosen, *options, (feature, values))?);
            }
            Draw::Trajectories { file, arms, episodes } => {
                for mut chosen in choose(plan, d, arms, Choice::Median)? {
                    let arm = chosen.name.split('/').nth(1).unwrap_or_default();
                    let path = out.join(format!("{file}-{}-{arm}.png", domain.name));
                    shown.extend(trajectories(&path, &mut chosen, *episodes)?);
                }
            }
            Draw::Curves { .. } | Draw::Dots { .. } => {}
        }
    }
    Ok(shown)
}

/// The runs of the arms of these names (of all, where there are none) that a picture shows.
fn choose(plan: &Plan, domain: usize, arms: &[String], choice: Choice) -> Result<Vec<Chosen>, RunError> {
    let metric = plan.experiment.metric;
    let mut chosen = Vec::new();
    for (_, a) in plan.pairs().into_iter().filter(|(d, _)| *d == domain) {
        let arm = &plan.experiment.arms[a];
        if !arms.is_empty() && !arms.contains(&arm.name) {
            continue;
        }
        let mut done = Vec::new();
        for (seed, folder) in plan.finished(domain, a)? {
            // A run without the number is below all that have it.
            done.push((metric.of(&folder)?.unwrap_or(f64::NEG_INFINITY), seed, folder));
        }
        let seeds = done.len();
        let rule = match choice {
            Choice::Median => {
                done.sort_by(|x, y| x.0.total_cmp(&y.0));
                done = done.drain(..).skip(seeds.saturating_sub(1) / 2).take(1).collect();
                let seed = done.first().map_or_else(String::new, |(_, seed, _)| format!("seed {seed}, "));
                match seeds {
                    1 => format!("{seed}the only one that is done"),
                    _ => format!("{seed}the median of {seeds} seeds by {}", metric.words()),
                }
            }
            Choice::Each => {
                done.truncate(MOST);
                format!("the first {} of {seeds} seeds", done.len())
            }
        };
        for (_, seed, folder) in done {
            let name = format!("{}/{}/{seed}", plan.experiment.domains[domain].name, arm.name);
            let run = Run::open(folder.path(), None)?;
            chosen.push(Chosen { name, label: arm.label().to_owned(), rule: rule.clone(), run });
        }
    }
    Ok(chosen)
}

/// A row of panels a run and value of the feature, a panel an option.
fn sets(
    path: &Path,
    chosen: &[Chosen],
    options: Options,
    (feature, values): (&str, &[f32]),
) -> Result<Vec<Shown>, RunError> {
    let Some(view) = chosen.first().and_then(|chosen| View::of(&chosen.run.config.settings)) else {
        return Ok(Vec::new());
    };
    let mut pictures = Vec::new();
    for Chosen { label, run, .. } in chosen {
        let dimensions = run.session.spec().observation.dimensions();
        let at = dimensions.iter().position(|dimension| dimension.name == feature);
        let rows: Vec<Option<f32>> = match at {
            Some(_) => values.iter().copied().map(Some).collect(),
            None => vec![None],
        };
        let skills = run.session.skills();
        let mut first: Vec<Raster> = Vec::new();
        for value in rows {
            let rasters = view.sets_where(run, |s| {
                if let (Some(at), Some(value)) = (at, value) {
                    s[at] = value;
                }
            });
            let wanted = |enters: Option<u32>| options == Options::All || enters.is_none();
            let shown = skills.iter().zip(rasters).filter(|(skill, _)| wanted(skill.enters)).take(MOST);
            let shown: Vec<_> = shown.collect();
            for (index, (skill, region)) in shown.iter().enumerate() {
                let target = skill.enters.map_or_else(|| "goal".to_owned(), |parent| parent.to_string());
                let given = value.map_or_else(String::new, |value| format!(", {feature} = {value}"));
                let covers = 100.0 * region.share_of_free_space(&view.map);
                let overlap = first.get(index).map(|other| 100.0 * other.overlap(region));
                let overlap = overlap.map_or_else(String::new, |share| format!(", {share:.0} % in common"));
                pictures.push(SetPicture {
                    title: format!(
                        "{label}, seed {}: {} → {target}{given}",
                        run.config.settings.seed, skill.skill
                    ),
                    subtitle: format!("covers {covers:.0} % of free space{overlap}"),
                    colour: skill.skill as usize,
                    region: region.clone(),
                    ..SetPicture::default()
                });
            }
            if first.is_empty() {
                first = shown.into_iter().map(|(_, region)| region).collect();
            }
        }
    }
    figures::sets(path, &view.map, &pictures, &note(chosen))?;
    Ok(chosen.iter().map(|chosen| told(path, chosen)).collect())
}

fn trajectories(path: &Path, chosen: &mut Chosen, episodes: u64) -> Result<Option<Shown>, RunError> {
    let Some(view) = View::of(&chosen.run.config.settings) else { return Ok(None) };
    let watched = chosen.run.evaluate(Protocol::Frozen, episodes)?;
    let paths = watched.iter().map(|episode| Trajectory {
        points: episode.acted().map(|(s, skill)| ([s[0], s[1]], skill)).collect(),
    });
    let steps: Vec<_> =
        watched.iter().map(|episode| (episode.summary.steps, episode.summary.success)).collect();
    let words =
        |(steps, success): &(u32, bool)| format!("{steps}{}", if *success { "" } else { " (failed)" });
    let told_steps = steps.iter().map(words).collect::<Vec<_>>().join(", ");
    let note = format!("{}. Steps: {told_steps}", note(std::slice::from_ref(chosen)));
    figures::trajectories(path, &view.map, &paths.collect::<Vec<_>>(), &note)?;
    Ok(Some(Shown { episodes: steps, ..told(path, chosen) }))
}

/// Which runs are shown, and by what rule.
fn note(chosen: &[Chosen]) -> String {
    let mut rules: Vec<String> = Vec::new();
    for Chosen { label, rule, .. } in chosen {
        let rule = format!("{label}: {rule}");
        if !rules.contains(&rule) {
            rules.push(rule);
        }
    }
    rules.join("; ")
}

fn told(path: &Path, chosen: &Chosen) -> Shown {
    let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Shown { file, run: chosen.name.clone(), rule: chosen.rule.clone(), episodes: Vec::new() }
}
