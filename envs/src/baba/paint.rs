//! Levels as pictures: sprites of twelve pixels, words in letters of five rows.

use inroads_sim::raster::{Format, Frame, Mosaic};

use super::{
    kinds::{Kind, Noun, Property, Word},
    world::Baba,
};
use crate::world::{Drawn, Painter};

/// Pixels a side of a cell: two rows of three letters, and no more, so that a picture stays small.
const SIDE: usize = 12;

type Rgb = [u8; 3];

const NIGHT: Rgb = [16, 18, 28];

/// Colours of the sprites, by letter.
const PALETTE: [(char, Rgb); 12] = [
    ('W', [250, 250, 250]),
    ('g', [196, 200, 212]),
    ('k', [46, 40, 52]),
    ('p', [238, 150, 160]),
    ('b', [146, 92, 54]),
    ('d', [94, 56, 34]),
    ('m', [62, 38, 26]),
    ('h', [40, 104, 56]),
    ('l', [78, 150, 72]),
    ('t', [24, 66, 42]),
    ('y', [236, 206, 84]),
    ('r', [214, 72, 72]),
];

const SHEEP: [&str; SIDE] = [
    "............",
    "..WWWWW.....",
    ".WWWWWWWkkk.",
    "WWWWWWWkkkkk",
    "WWWWWWWkWkWk",
    "WWWWWWWkkkkk",
    "WWWWWWWkkkp.",
    "gWWWWWWWkk..",
    ".gWWWWWWWg..",
    "..ggggggg...",
    "..kk...kk...",
    "..kk...kk...",
];
const WALL: [&str; SIDE] = [
    "bbbbbmbbbbbm",
    "bbbbbmbbbbbm",
    "dddddmdddddm",
    "mmmmmmmmmmmm",
    "bbmbbbbbmbbb",
    "bbmbbbbbmbbb",
    "ddmdddddmddd",
    "mmmmmmmmmmmm",
    "bbbbbmbbbbbm",
    "bbbbbmbbbbbm",
    "dddddmdddddm",
    "mmmmmmmmmmmm",
];
const HEDGE: [&str; SIDE] = [
    "hhlhhhhlhhhh",
    "hlhhthhhhlhh",
    "hhhthhlhhhht",
    "thhhhlhhthhh",
    "hhlhhhhthhhl",
    "hhhhthhhhlhh",
    "lhhthhlhhhht",
    "hhhhhhhhthhh",
    "hthhlhhthhlh",
    "hhhlhhhhhhhh",
    "hhhhhthhlhht",
    "thhhhhhhhhhh",
];
const ROCK: [&str; SIDE] = [
    "............",
    "....gggg....",
    "..ggbbbbgg..",
    ".gbbbbbbbbg.",
    ".bbbbdbbbbb.",
    "bbbbbbbbbbbb",
    "bbbdbbbbdbbb",
    "bbbbbbbbbbbb",
    "dbbbbdbbbbbd",
    ".dbbbbbbbbd.",
    "..dddddddd..",
    "............",
];
const FLAG: [&str; SIDE] = [
    "............",
    "..gyy.......",
    "..gyyyyy....",
    "..gyyyyyyy..",
    "..gyyyyyyy..",
    "..gyyyyy....",
    "..gyy.......",
    "..g.........",
    "..g.........",
    "..g.........",
    "..g.........",
    ".ggg........",
];

/// Rows of a letter.
const HIGH: usize = 5;
/// The letters that words here are made of, five rows of one to five dots each.
const LETTERS: [(char, &str); 20] = [
    ('A', ".#.#.#####.##.#"),
    ('B', "##.#.###.#.###."),
    ('C', ".###..#..#...##"),
    ('D', "##.#.##.##.###."),
    ('E', "####..##.#..###"),
    ('F', "####..##.#..#.."),
    ('G', ".###..#.##.#.##"),
    ('H', "#.##.#####.##.#"),
    ('I', "#####"),
    ('K', "#.##.###.#.##.#"),
    ('L', "#..#..#..#..###"),
    ('N', "#..###.##.###..##..#"),
    ('O', "####.##.##.####"),
    ('P', "####.#####..#.."),
    ('R', "##.#.###.#.##.#"),
    ('S', ".###...#...###."),
    ('T', "###.#..#..#..#."),
    ('U', "#.##.##.##.####"),
    ('W', "#...##...##.#.##.#.#.#.#."),
    ('Y', "#.##.#.#..#..#."),
];

/// What a thing looks like.
fn sprite(noun: Noun) -> [&'static str; SIDE] {
    match noun {
        Noun::Baba => SHEEP,
        Noun::Wall => WALL,
        Noun::Hedge => HEDGE,
        Noun::Rock => ROCK,
        Noun::Flag => FLAG,
    }
}

/// Colours of a block: the plate and its letters.
fn colours(word: Word) -> [Rgb; 2] {
    match word {
        Word::Noun(Noun::Baba) => [[104, 52, 84], [255, 214, 232]],
        Word::Noun(Noun::Wall) => [[84, 52, 32], [244, 190, 132]],
        Word::Noun(Noun::Hedge) => [[22, 62, 40], [140, 214, 124]],
        Word::Noun(Noun::Rock) => [[80, 66, 40], [236, 206, 150]],
        Word::Noun(Noun::Flag) => [[96, 84, 24], [255, 236, 130]],
        Word::Is => [[58, 62, 80], [255, 255, 255]],
        Word::Property(Property::You) => [[226, 92, 156], [50, 10, 36]],
        Word::Property(Property::Stop) => [[64, 152, 88], [8, 38, 20]],
        Word::Property(Property::Push) => [[196, 150, 88], [50, 30, 10]],
        Word::Property(Property::Win) => [[244, 204, 64], [66, 44, 0]],
    }
}

/// A tile under work.
type Tile = [[Rgb; SIDE]; SIDE];

fn draw_thing(noun: Noun, tile: &mut Tile) {
    for (row, pixels) in sprite(noun).iter().zip(tile) {
        for (letter, pixel) in row.chars().zip(pixels) {
            if let Some((_, colour)) = PALETTE.iter().find(|(known, _)| *known == letter) {
                *pixel = *colour;
            }
        }
    }
}

/// Rows of up to three letters, in the middle of a plate.
fn draw_block(word: Word, tile: &mut Tile) {
    let [plate, ink] = colours(word);
    *tile = [[plate; SIDE]; SIDE];
    for [x, y] in [[0, 0], [SIDE - 1, 0], [0, SIDE - 1], [SIDE - 1, SIDE - 1]] {
        tile[y][x] = NIGHT;
    }
    let letters: Vec<char> = Kind::Block(word).name().chars().collect();
    let rows: Vec<&[char]> = match letters.len() {
        ..=3 => vec![&letters],
        length => letters.chunks(length.div_ceil(2)).collect(),
    };
    let top = (SIDE + 1 - (HIGH + 1) * rows.len()) / 2;
    for (line, row) in rows.iter().enumerate() {
        let patterns = || row.iter().filter_map(|letter| LETTERS.iter().find(|(known, _)| known == letter));
        let wide: usize = patterns().map(|(_, pattern)| pattern.len() / HIGH + 1).sum();
        let mut left = (SIDE + 1 - wide).div_ceil(2);
        for (_, pattern) in patterns() {
            let wide = pattern.len() / HIGH;
            for (dot, _) in pattern.match_indices('#') {
                tile[top + (HIGH + 1) * line + dot / wide][left + dot % wide] = ink;
            }
            left += wide + 1;
        }
    }
}

fn draw(kind: Kind, tile: &mut Tile) {
    match kind {
        Kind::Thing(noun) => draw_thing(noun, tile),
        Kind::Block(word) => draw_block(word, tile),
    }
}

/// Draws levels.
#[derive(Clone, Debug)]
pub struct Tiles {
    mosaic: Mosaic,
    /// What of the tiles shows which kinds: at the bottom, and on it.
    shows: Vec<[Option<Kind>; 2]>,
    /// What is at the bottom of each cell, and on it.
    cells: Vec<[Option<Kind>; 2]>,
    looks: Vec<u16>,
    shape: ([u32; 2], u32),
}

impl Drawn for Baba {
    type Painter = Tiles;

    fn painter(&self, format: Format) -> Tiles {
        let size = self.size().map(|cells| cells as u32);
        let mut mosaic = Mosaic::new(size, SIDE as u32, format);
        let mut shows = vec![[None, None]];
        shows.extend(self.kinds.iter().map(|&kind| [Some(kind), None]));
        // Of two kinds in a cell both show where the upper one is a thing, which has holes.
        let things = || self.kinds.iter().filter(|kind| matches!(kind, Kind::Thing(_)));
        let pairs = things().flat_map(|&below| things().map(move |&above| [Some(below), Some(above)]));
        shows.extend(pairs.filter(|[below, above]| rank(*below) < rank(*above)));
        for kinds in &shows {
            let mut tile = [[NIGHT; SIDE]; SIDE];
            kinds.iter().flatten().for_each(|&kind| draw(kind, &mut tile));
            mosaic.add(&tile.as_flattened().concat());
        }
        let shape = (format.size(size.map(|cells| cells * SIDE as u32)), format.channels());
        Tiles { mosaic, shows, cells: Vec::new(), looks: Vec::new(), shape }
    }
}

/// What lies on what: the sheep on all things, blocks on the sheep.
fn rank(kind: Option<Kind>) -> u8 {
    match kind {
        None => 0,
        Some(Kind::Thing(Noun::Baba)) => 10,
        Some(Kind::Thing(noun)) => 9 - noun as u8,
        Some(Kind::Block(_)) => 11,
    }
}

impl Painter<Baba> for Tiles {
    fn shape(&self) -> ([u32; 2], u32) {
        self.shape
    }

    fn paint(&mut self, world: &Baba, out: &mut Frame) {
        let [columns, rows] = world.size();
        self.cells.clear();
        self.cells.resize(columns * rows, [None, None]);
        for unit in &world.state().units {
            let [below, above] = &mut self.cells[usize::from(unit.cell)];
            let new = Some(unit.kind);
            // The two highest stay, each kind once.
            if rank(new) > rank(*above) {
                [*below, *above] = [*above, new];
            } else if new != *above && rank(new) > rank(*below) {
                *below = new;
            }
        }
        self.looks.clear();
        self.looks.extend(self.cells.iter().map(|&[below, above]| {
            let shown = match above {
                Some(Kind::Thing(_)) if below.is_some() => [below, above],
                _ => [above, None],
            };
            self.shows.iter().position(|shows| *shows == shown).unwrap_or(0) as u16
        }));
        out.copy(self.mosaic.show(&self.looks));
    }
}
