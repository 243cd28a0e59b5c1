//! The skill graph of a run, and what its vertices ask for.

use image::RgbImage;
use inroads_discovery::record::{GraphRecord, VertexRecord};
use inroads_envs::{Drawing, Seed, Spec, registry::AnyEnvironment};

use super::View;
use crate::{
    config::Settings,
    figures::{self, Edge, Feature, Graph, Ground, Kept, Role, Vertex},
    run::{Run, RunError},
    session::{self, Spot},
};

/// Edges a vertex above which a picture is of lines only, so that only those are drawn that were followed and are likely.
const EDGES: usize = 4;
/// Probability from which an edge is likely.
const LIKELY: f32 = 0.5;
/// Features above which only those are drawn that some subgoal keeps.
const FEATURES: usize = 16;
/// Cells of a world's side above which it is no lattice that one could read.
const SIDE: f32 = 64.0;

/// Draws a run's graph and, where its vertices ask for different features, which; nothing when there is no graph.
pub(super) fn graph(run: &mut Run) -> Result<(), RunError> {
    let Some(record) = run.session.graph() else { return Ok(()) };
    let folder = run.folder.figures();
    let spec = run.session.spec().clone();
    let start = (record.vertices.iter().map(|vertex| vertex.vertex)).find(|&vertex| {
        let there = run.session.plan(&Spot::Start, &Spot::Vertex(vertex));
        there.is_ok_and(|plan| plan.legs.is_empty())
    });
    let settings = &run.config.settings;
    let lattice = Lattice::of(&spec, &record);
    let (episodes, _) = run.session.progress();
    let dims =
        lattice.as_ref().map(|lattice| lattice.dims).or_else(|| <[usize; 2]>::try_from(&*spec.place).ok());
    let place = |vertex: &VertexRecord| {
        let [x, y] = dims?;
        Some([whereabouts(vertex, x)?, whereabouts(vertex, y)?])
    };
    let asking = differ(&record);
    let crowded = record.edges.len() > EDGES * record.vertices.len();
    let vertices = record.vertices.iter().map(|vertex| Vertex {
        label: if asking { asked(&spec, vertex) } else { vertex.vertex.to_string() },
        at: place(vertex),
        value: vertex.visits as f64,
        role: match &spec.goal {
            _ if Some(vertex.vertex) == start => Role::Start,
            Some(goal) if !vertex.at.is_empty() && goal.reached(&vertex.at) => Role::Goal,
            _ => Role::Plain,
        },
    });
    let number = |vertex: u32| record.vertices.iter().position(|known| known.vertex == vertex);
    let shown = record.edges.iter().filter(|edge| !crowded || edge.tries > 0 && edge.probability >= LIKELY);
    let edges = shown.filter_map(|edge| {
        let (from, to) = (number(edge.from)?, number(edge.to)?);
        let probability = f64::from(edge.probability);
        Some(Edge { from, to, probability, hoped: edge.tries == 0, planned: false })
    });
    let picture = Graph {
        title: format!("{}: {} vertices, {} edges", spec.name, record.vertices.len(), record.edges.len()),
        subtitle: match crowded {
            true => format!(
                "{} after {episodes} episodes; edges that were followed, of at least {LIKELY}",
                settings.agent
            ),
            false => format!("{} after {episodes} episodes", settings.agent),
        },
        value: "visits".to_owned(),
        vertices: vertices.collect(),
        edges: edges.collect(),
    };
    let view = View::of(settings);
    let world = lattice.as_ref().and_then(|lattice| world(settings, lattice.cells));
    let ground = match (&view, &world, &lattice) {
        (Some(view), ..) => Ground::Map(&view.map),
        (None, Some(world), Some(lattice)) => Ground::Picture { picture: world, cells: lattice.cells },
        (None, None, Some(_)) => Ground::Lattice,
        _ => Ground::Layers,
    };
    figures::graph(folder.join("skill-graph.png"), ground, &picture)?;
    if asking {
        let (features, subgoals) = kept(&spec, &record);
        figures::kept_features(folder.join("kept-features.png"), &features, &subgoals)?;
    }
    Ok(())
}

/// What a vertex asks for, in short; its number where it asks for nothing.
fn asked(spec: &Spec, vertex: &VertexRecord) -> String {
    let words: Vec<_> = vertex
        .kept
        .iter()
        .map(|(feature, value)| format!("{} {value}", feature_name(spec, *feature as usize)))
        .collect();
    if words.is_empty() { vertex.vertex.to_string() } else { words.join(", ") }
}

/// What a vertex has in a dimension: as it was reached last, or as its goal asks for.
pub fn whereabouts(vertex: &VertexRecord, dimension: usize) -> Option<f32> {
    let asked = || vertex.kept.iter().find(|(kept, _)| *kept as usize == dimension).map(|(_, value)| *value);
    vertex.at.get(dimension).copied().or_else(asked)
}

/// Where cells are, in a world of cells.
struct Lattice {
    /// The dimensions that say column and row.
    dims: [usize; 2],
    /// Columns and rows.
    cells: [u32; 2],
}

impl Lattice {
    /// Where one is, is said by a column and a row that are whole numbers from 0.
    fn of(spec: &Spec, record: &GraphRecord) -> Option<Self> {
        let named = |names: [&str; 2]| {
            spec.place.iter().copied().find(|&d| names.contains(&&*spec.observation.dimensions()[d].name))
        };
        let dims = [named(["x", "column"])?, named(["y", "row"])?];
        let whole = |x: f32| x >= 0.0 && x.fract() == 0.0;
        let [width, height] = dims.map(|d| &spec.observation.dimensions()[d]);
        let bounded = [width, height].iter().all(|d| d.low >= 0.0 && whole(d.high) && d.high < SIDE);
        let mut places = record.vertices.iter().flat_map(|vertex| dims.map(|d| whereabouts(vertex, d)));
        let fits = bounded && places.all(|place| place.is_none_or(whole));
        fits.then(|| Self { dims, cells: [width, height].map(|d| d.high as u32 + 1) })
    }
}

/// The world as the first evaluation begins, where its picture consists of these cells.
fn world(settings: &Settings, cells: [u32; 2]) -> Option<RgbImage> {
    let start = Seed(settings.seed).number("evaluate-start", 0);
    let drawing = match session::environment(settings).ok()? {
        AnyEnvironment::Choices(mut env) => {
            env.reset(start);
            env.drawing()
        }
        AnyEnvironment::Frames(mut env) => {
            env.reset(start);
            env.drawing()
        }
        AnyEnvironment::Vectors(_) => return None,
    };
    let Drawing::Pixels(picture) = drawing else { return None };
    let [width, height] = cells;
    let square = picture.width() * height == picture.height() * width;
    (square && picture.width().is_multiple_of(width)).then_some(picture)
}

/// Whether vertices that ask for features ask for different ones, so that it is worth a table which.
pub fn differ(record: &GraphRecord) -> bool {
    let asked = |vertex: &VertexRecord| vertex.kept.iter().map(|(feature, _)| *feature).collect::<Vec<_>>();
    let mut asking = record.vertices.iter().filter(|vertex| !vertex.kept.is_empty());
    let first = asking.next().map(asked);
    asking.any(|vertex| Some(asked(vertex)) != first)
}

/// The table of features and subgoals.
fn kept(spec: &Spec, record: &GraphRecord) -> (Vec<Feature>, Vec<Kept>) {
    let count = spec.observation.len();
    let asking = || record.vertices.iter().filter(|vertex| !vertex.kept.is_empty());
    let asks = |vertex: &VertexRecord, feature: usize| {
        vertex.kept.iter().find(|(kept, _)| *kept as usize == feature).map(|(_, value)| value.to_string())
    };
    let is_kept = |feature: usize| asking().any(|vertex| asks(vertex, feature).is_some());
    let shown: Vec<usize> = (0..count)
        .filter(|&feature| count <= FEATURES || is_kept(feature) || distracts(spec, feature))
        .collect();
    let features = shown
        .iter()
        .map(|&feature| Feature { name: feature_name(spec, feature), distractor: distracts(spec, feature) });
    let subgoals = asking().map(|vertex| {
        let (tries, successes) = tried(record, vertex.vertex);
        Kept {
            label: format!("vertex {}", vertex.vertex),
            note: format!("reached {successes} of {tries}"),
            values: shown.iter().map(|&feature| asks(vertex, feature)).collect(),
        }
    });
    (features.collect(), subgoals.collect())
}

/// How often a vertex was called for in training, and how often that succeeded.
pub fn tried(record: &GraphRecord, vertex: u32) -> (u32, u32) {
    let into = record.edges.iter().filter(|edge| edge.to == vertex);
    into.fold((0, 0), |(tries, successes), edge| (tries + edge.tries, successes + edge.successes))
}

/// A distractor says so by its name.
fn distracts(spec: &Spec, feature: usize) -> bool {
    spec.observation.dimensions().get(feature).is_some_and(|d| d.name.starts_with("distractor"))
}

/// What a feature is called: its dimension's name, with its number where that is not the only one of the name.
pub fn feature_name(spec: &Spec, feature: usize) -> String {
    let dimensions = spec.observation.dimensions();
    let Some(dimension) = dimensions.get(feature) else { return format!("feature {feature}") };
    match dimensions.iter().filter(|other| other.name == dimension.name).count() {
        1 => dimension.name.to_string(),
        _ => format!("{} {feature}", dimension.name),
    }
}

#[cfg(test)]
mod tests {
    use inroads_discovery::record::EdgeRecord;
    use inroads_envs::registry;

    use super::*;

    fn record(kept: &[&[(u32, f32)]]) -> GraphRecord {
        let vertices = (0..).zip(kept);
        let vertices = vertices.map(|(vertex, kept)| VertexRecord {
            vertex,
            at: vec![],
            visits: 1,
            kept: kept.to_vec(),
        });
        let edge = |from, to| EdgeRecord { from, to, probability: 0.5, tries: 3, successes: 2 };
        GraphRecord { vertices: vertices.collect(), edges: vec![edge(0, 1), edge(2, 1), edge(1, 2)] }
    }

    #[test]
    fn a_table_of_features_is_worth_it_where_they_differ() {
        assert!(!differ(&record(&[])) && !differ(&record(&[&[(0, 1.0)]])));
        let [place, other] = [[(0, 1.0), (1, 2.0)], [(0, 5.0), (1, 2.0)]];
        assert!(!differ(&record(&[&place, &[], &other])), "who asks for nothing is an option");
        assert!(differ(&record(&[&place, &[(2, 4.0)]])));
    }

    #[test]
    fn kept_features_are_those_of_the_subgoals_by_name() {
        let spec = registry::make_with(
            "taxi",
            &registry::Options { see: "symbols".parse().ok(), ..Default::default() },
        );
        let spec = spec.unwrap().spec().clone();
        let (features, subgoals) = kept(&spec, &record(&[&[], &[(2, 4.0)], &[(0, 3.0), (1, 1.5)]]));
        let names: Vec<_> = features.iter().map(|feature| feature.name.as_str()).collect();
        assert_eq!(names[..2], ["row", "column"]);
        assert!(features.iter().all(|feature| !feature.distractor));
        let told = |kept: &Kept| (kept.label.clone(), kept.note.clone(), kept.values[..3].to_vec());
        let value = |text: &str| Some(text.to_owned());
        assert_eq!(
            told(&subgoals[0]),
            ("vertex 1".into(), "reached 4 of 6".into(), vec![None, None, value("4")])
        );
        assert_eq!(
            told(&subgoals[1]),
            ("vertex 2".into(), "reached 2 of 3".into(), vec![value("3"), value("1.5"), None])
        );
    }

    #[test]
    fn cells_are_found_by_name_and_only_whole_ones() {
        let spec = |name| registry::make(name).unwrap().spec().clone();
        let at = |at: &[f32]| {
            let mut one = record(&[&[]]);
            one.vertices[0].at = at.to_vec();
            one
        };
        let taxi = Lattice::of(&spec("taxi"), &at(&[3.0, 1.0, 0.0, 0.0])).unwrap();
        assert_eq!((taxi.dims, taxi.cells), ([1, 0], [5, 5]));
        assert!(Lattice::of(&spec("taxi"), &at(&[3.5, 1.0, 0.0, 0.0])).is_none());
        assert!(Lattice::of(&spec("point-maze"), &at(&[1.0, 1.0])).is_none(), "metres are no cells");
        assert!(Lattice::of(&spec("corridor-5"), &at(&[1.0])).is_none());
    }
}
