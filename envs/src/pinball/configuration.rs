//! A board as data, read from the peers' text format.

use std::sync::{Arc, LazyLock, OnceLock};

use rand::RngExt;

use super::{board::Board, layouts, picture::Parts};
use crate::{Frame, Rng, registry::nearest};

/// A board: the ball's size, the target, the start and the obstacles. Lengths are shares of the board's side.
#[derive(Clone, Debug)]
pub struct Configuration {
    pub(super) board: Board,
    pub(super) start: [f64; 2],
    pub(super) polygons: Vec<Vec<[f64; 2]>>,
    /// Everything but the ball, drawn when somebody first wants to see it.
    pub(super) still: OnceLock<Frame>,
    /// The same through the format that somebody wanted first.
    pub(super) first: OnceLock<Arc<Parts>>,
}

/// No configuration has that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no configuration `{name}`; did you mean `{nearest}`? All: {}", NAMES.join(", "))]
pub struct UnknownConfiguration {
    /// The name.
    pub name: String,
    /// The nearest name that there is.
    pub nearest: &'static str,
}

/// The peers' names of their configurations.
const NAMES: [&str; 5] = ["hard_single", "simple_single", "medium", "box", "empty"];
/// Read once, so that copies of an environment share grid and picture however they are made.
static NAMED: [LazyLock<Arc<Configuration>>; 5] = [
    LazyLock::new(|| own(layouts::HARD)),
    LazyLock::new(|| own(layouts::SIMPLE)),
    LazyLock::new(|| own(layouts::MEDIUM)),
    LazyLock::new(|| own(layouts::BOX)),
    LazyLock::new(|| own(layouts::EMPTY)),
];

fn own(text: &str) -> Arc<Configuration> {
    Arc::new(Configuration::parse(text).expect("the five configurations can be read; a test reads them"))
}

/// Where the author's sampler of starts and goals looks, on both axes.
const SAMPLED: [f64; 2] = [0.02, 0.98];
/// How often it is drawn before the lattice decides: where a hundredth of the board is free, once in 10⁴³ calls too few.
const DRAWS: u32 = 10_000;
/// Points along a side of the lattice that tells whether there is room at all (the thesis' coverage has as many cells).
const LATTICE: usize = 100;

impl Configuration {
    /// One of the peers': `hard_single`, `simple_single`, `medium`, `box` or `empty`.
    ///
    /// # Errors
    /// [`UnknownConfiguration`] names the nearest.
    pub fn named(name: &str) -> Result<Arc<Self>, UnknownConfiguration> {
        let index = NAMES.iter().position(|known| *known == name);
        let unknown = || UnknownConfiguration {
            name: name.to_owned(),
            nearest: nearest(name, NAMES).expect("there are names"),
        };
        index.map(|index| NAMED[index].clone()).ok_or_else(unknown)
    }

    /// Radius of the ball.
    pub fn ball(&self) -> f64 {
        self.board.radius
    }

    /// Centre and radius of the target.
    pub fn target(&self) -> ([f64; 2], f64) {
        (self.board.target, self.board.reach)
    }

    /// Where the ball starts.
    pub fn start(&self) -> [f64; 2] {
        self.start
    }

    /// The obstacles, each by its corners.
    pub fn polygons(&self) -> &[Vec<[f64; 2]>] {
        &self.polygons
    }

    /// Whether a point lies outside all obstacles, by the even-odd rule. A ball there may reach into one.
    pub fn free(&self, point: [f64; 2]) -> bool {
        !self.polygons.iter().any(|corners| encloses(corners, point))
    }

    /// A free point, uniformly from [0.02, 0.98]²: what the thesis' author draws starts and test goals from.
    pub fn sample(&self, rng: &mut Rng) -> [f64; 2] {
        let [low, high] = SAMPLED;
        let draw = |_| [rng.random_range(low..high), rng.random_range(low..high)];
        if let Some(point) = (0..DRAWS).map(draw).find(|&point| self.free(point)) {
            return point;
        }
        // Nearly all of the board is covered. That a point of the lattice is free was seen to when it was made.
        let free = self.lattice().count();
        let chosen = rng.random_range(0..free.max(1));
        self.lattice().nth(chosen).unwrap_or(self.start)
    }

    /// The free points of a lattice.
    pub(super) fn lattice(&self) -> impl Iterator<Item = [f64; 2]> {
        let [low, high] = SAMPLED;
        let at = move |index: usize| low + (high - low) * (index as f64 + 0.5) / LATTICE as f64;
        let points = (0..LATTICE * LATTICE).map(move |index| [at(index % LATTICE), at(index / LATTICE)]);
        points.filter(|&point| self.free(point))
    }
}

/// Whether a point is inside a polygon, by the even-odd rule.
fn encloses(corners: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let crossed = edges
        .filter(|(a, b)| (a[1] > y) != (b[1] > y) && x < (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]) + a[0]);
    crossed.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pinball::ConfigurationError;

    #[test]
    fn a_board_without_room_is_none_and_one_with_little_is_drawn_from() {
        // The start stands on the edge that nobody draws from.
        let covered = "ball 0.02\ntarget 0.9 0.2 0.04\nstart 0.01 0.5\npolygon 0.015 0 1 0 1 1 0.015 1\n";
        let error = Configuration::parse(covered).unwrap_err();
        assert!(error == ConfigurationError::NoRoom && error.to_string().contains("leave a gap"));
        // One point of the lattice, in a gap of a ten-thousandth of the board.
        let gap = "polygon 0 0 1 0 1 0.496 0 0.496\npolygon 0 0.506 1 0.506 1 1 0 1\n\
                   polygon 0 0 0.496 0 0.496 1 0 1\npolygon 0.506 0 1 0 1 1 0.506 1\n";
        let tight = format!("ball 0.02\ntarget 0.9 0.2 0.04\nstart 0.5 0.5\n{gap}");
        let tight = Configuration::parse(&tight).unwrap();
        let mut rng = crate::Seed(1).stream("test", 0);
        for _ in 0..20 {
            let [x, y] = tight.sample(&mut rng);
            assert!((0.496..0.506).contains(&x) && (0.496..0.506).contains(&y), "{x} {y}");
        }
    }

    #[test]
    fn the_five_are_read_and_others_answered_with_the_nearest() {
        let sizes = NAMES.map(|name| Configuration::named(name).unwrap().polygons().len());
        assert_eq!(sizes, [18, 10, 10, 5, 4]);
        let error = Configuration::named("hard_simgle").unwrap_err().to_string();
        assert!(
            error.contains("did you mean `hard_single`?") && error.contains("medium, box, empty"),
            "{error}"
        );
    }
}
