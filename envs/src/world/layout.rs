//! What is drawn at random when an episode begins, and what is kept from one to the next.

use crate::{Rng, Seed};

/// Which layouts the episodes of a world have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Layout {
    /// Each episode its own.
    #[default]
    Random,
    /// All episodes the one that this seed names: walls, objects, start and goal (thesis' author, chapters 7 and 9:
    /// seed 42).
    Fixed(u64),
    /// As `Fixed`, but each episode starts anywhere (author, chapter 5).
    FixedMap(u64),
}

impl Layout {
    /// What an episode with this seed draws from.
    pub fn draw(self, episode: u64) -> Draw {
        let (fixed, layout, start) = match self {
            Self::Random => (false, episode, None),
            Self::Fixed(layout) => (true, layout, None),
            Self::FixedMap(layout) => (true, layout, Some(Seed(episode))),
        };
        Draw { fixed, layout: Seed(layout), start, play: Seed(episode) }
    }
}

/// What the episode to come draws from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draw {
    fixed: bool,
    layout: Seed,
    start: Option<Seed>,
    play: Seed,
}

impl Draw {
    /// Whether all episodes have the same layout. A world that comes with one of its own, such as a board read from a
    /// file with a start in it, then keeps to it.
    pub fn fixed(&self) -> bool {
        self.fixed
    }

    /// For walls, objects, goals, and where nothing else is asked for, the start.
    pub fn layout(&self) -> Rng {
        self.layout.stream("layout", 0)
    }

    /// When the start is to be anywhere, whatever the layout says: what draws it.
    pub fn start(&self) -> Option<Rng> {
        self.start.map(|seed| seed.stream("start", 0))
    }

    /// The same, with other numbers of chance in the course of the episode.
    pub(crate) fn with_play(self, play: u64) -> Self {
        Self { play: Seed(play), ..self }
    }

    /// For what happens by chance in the course of the episode.
    pub fn play(&self) -> Rng {
        self.play.stream("play", 0)
    }

    /// For what happens by chance beside the world, and takes no part in it.
    pub fn distraction(&self) -> Rng {
        self.play.stream("distraction", 0)
    }
}
