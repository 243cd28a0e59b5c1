//! Rivers as pictures: the terminal's letters and colours, ground as texture.

use inroads_sim::raster::{Format, Frame, Mosaic};

use super::{CELLS, COLUMNS, GOAL, Ground, HEALTH, Kind, Map, ROWS, River};
use crate::world::{Drawn, Painter};

/// Pixels a side of a tile.
const SIDE: usize = 8;
/// Rows of tiles: the map's, and one that shows the hero's health.
const LINES: usize = ROWS + 1;

type Rgb = [u8; 3];

const BLACK: Rgb = [0, 0, 0];
const WHITE: Rgb = [255, 255, 255];
const GREY: Rgb = [170, 170, 170];
const DARK: Rgb = [85, 85, 85];
const BROWN: Rgb = [170, 85, 0];
const RED: Rgb = [255, 85, 85];

/// Tiles, in the order of their numbers: first these, then one for each kind of monster.
const TILES: [(&str, Rgb, Rgb); 9] = [
    (FLOOR, BLACK, DARK),
    (WAVES, [0, 0, 120], [80, 130, 255]),
    (WAVES, [120, 0, 0], [255, 110, 30]),
    (BOULDER, BLACK, GREY),
    (STAIRS, BLACK, WHITE),
    (HERO, BLACK, WHITE),
    (HEART, BLACK, RED),
    (HEART, BLACK, [60, 20, 20]),
    (NOTHING, BLACK, BLACK),
];
/// What a cell can show beside monsters, in the order of [`TILES`].
#[derive(Clone, Copy)]
enum Look {
    Floor,
    Water,
    Lava,
    Boulder,
    Stairs,
    Hero,
    Health,
    Loss,
    Nothing,
}

const NOTHING: &str = "";
const FLOOR: &str = "|||||  ##|  ##";
const WAVES: &str = "| ##   ##|#  # #  |    #|| ##   ##|#  # #  |    #";
const BOULDER: &str = "|  ####| ######| ######| ######| ######|  ####";
const STAIRS: &str = "| ##|   ##|     ##|      #|     ##|   ##| ##";
const HERO: &str = "|  ####| #    #| # ## #| # ## #| # ####| #|  ####";
const HEART: &str = "|| ## ##| #####| #####|  ###|   #";

impl Kind {
    /// Letter and colour as a terminal shows them.
    fn look(self) -> (&'static str, Rgb) {
        const D: &str = "|     #|     #|  ####| #   #| #   #| #   #|  ####";
        match self {
            Self::Newt => ("||   ##|   ##|||   ##|   ##", [255, 255, 85]),
            Self::Jackal => (D, BROWN),
            Self::GridBug => ("||| #   #|  # #|   #|  # #| #   #", [220, 80, 220]),
            Self::Lichen => ("| #####| #| #| ####| #| #| #", [85, 255, 85]),
            Self::Goblin => ("|||  ###| #   #| #   #| #   #|  ###", GREY),
            Self::SewerRat => ("||| # ##| ##  #| #| #| #", BROWN),
            Self::Kobold => ("| #| #  #| # #| ##| # #| #  #| #   #", [255, 120, 120]),
            Self::Fox => (D, RED),
            Self::KoboldZombie => ("| #####|     #|    #|   #|  #| #| #####", [120, 220, 220]),
        }
    }
}

/// Draws rivers.
#[derive(Clone, Debug)]
pub struct Tiles {
    mosaic: Mosaic,
    looks: Vec<u16>,
    shape: ([u32; 2], u32),
}

impl Drawn for River {
    type Painter = Tiles;

    fn painter(&self, format: Format) -> Tiles {
        let cells = [COLUMNS as u32, LINES as u32];
        let mut mosaic = Mosaic::new(cells, SIDE as u32, format);
        let kinds = Kind::ALL.map(|kind| (kind.look().0, BLACK, kind.look().1));
        for (pattern, back, front) in TILES.into_iter().chain(kinds) {
            mosaic.add(&tile(pattern, back, front));
        }
        let shape = (format.size(cells.map(|cells| cells * SIDE as u32)), format.channels());
        Tiles { mosaic, looks: Vec::with_capacity(COLUMNS * LINES), shape }
    }
}

impl Painter<River> for Tiles {
    fn shape(&self) -> ([u32; 2], u32) {
        self.shape
    }

    fn paint(&mut self, world: &River, out: &mut Frame) {
        let state = world.state();
        let look = |cell| match state.map.ground(cell) {
            Ground::Water => Look::Water,
            Ground::Lava => Look::Lava,
            Ground::Floor if state.map.boulders(cell) > 0 => Look::Boulder,
            Ground::Floor if Map::place(cell) == GOAL => Look::Stairs,
            Ground::Floor => Look::Floor,
        };
        self.looks.clear();
        self.looks.extend((0..CELLS).map(|cell| look(cell) as u16));
        for monster in state.monsters.iter().filter(|monster| monster.health > 0) {
            if let Some(cell) = Map::cell(monster.place) {
                self.looks[cell] = (TILES.len() + monster.kind as usize) as u16;
            }
        }
        if let Some(cell) = Map::cell(state.hero) {
            self.looks[cell] = Look::Hero as u16;
        }
        self.looks.extend((0..COLUMNS).map(|column| match column {
            column if column < usize::from(state.health) => Look::Health as u16,
            column if column < usize::from(HEALTH) => Look::Loss as u16,
            _ => Look::Nothing as u16,
        }));
        out.copy(self.mosaic.show(&self.looks));
    }
}

/// A tile of two colours: its rows from the top, parted by `|`, in which `#` is in front; what is missing is behind.
fn tile(pattern: &str, back: Rgb, front: Rgb) -> Vec<u8> {
    let mut pixels = [back; SIDE * SIDE];
    for (y, row) in pattern.split('|').enumerate() {
        for (x, _) in row.match_indices('#') {
            pixels[y * SIDE + x] = front;
        }
    }
    pixels.concat()
}
