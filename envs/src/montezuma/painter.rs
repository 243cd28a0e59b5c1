//! Draws the screen, row by row: no picture of its own size is kept anywhere.

use std::ops::Range;

use super::scenery::SCENERY;
use super::screen::{self, Area, DOORS, HEIGHT, WIDTH};
use super::sprites::{self, BLACK, DIGITS, PALETTE, Sprite, WHITE, YELLOW};
use super::world::{Key, Montezuma, Scene};
use crate::Frame;
use crate::world::{Drawn, Painter};
use inroads_sim::raster::{Format, Scaler, Window};

/// Left edge of everything above the play area (invented; the rows are the real screen's).
const PANEL_X: i32 = 57;
/// First row of the score.
const SCORE_Y: i32 = 6;
/// First row of the lives in store.
const LIVES_Y: i32 = 15;
/// First row of what the player has.
const INVENTORY_Y: i32 = 28;
/// From one digit, or life, to the next, pixels.
const PITCH: i32 = 8;

/// Greatest size of a picture of which a copy is kept, bytes: 84 × 84 in colour fits.
const KEPT: u32 = 32 << 10;

/// Draws [`Montezuma`].
///
/// Of a small picture it keeps what does not move, and makes only the windows about player and skull again; one that is
/// large it draws row by row.
#[derive(Clone, Debug)]
pub struct MontezumaPainter {
    scaler: Scaler,
    channels: u32,
    stage: Option<Stage>,
}

/// The picture without player and skull.
#[derive(Clone, Debug, Default)]
struct Stage {
    frame: Frame,
    /// What it was drawn of: nothing yet, or this.
    shows: Option<[Props; 2]>,
}

/// What of a scene is on the stage and changes.
type Props = (Key, [bool; 2], u8);

impl Drawn for Montezuma {
    type Painter = MontezumaPainter;

    fn painter(&self, format: Format) -> MontezumaPainter {
        let scaler = Scaler::new([WIDTH, HEIGHT], format);
        let ([width, height], channels) = (scaler.size(), format.channels());
        let small = format.scale.is_some() && width * height * channels <= KEPT;
        MontezumaPainter { scaler, channels, stage: small.then(Stage::default) }
    }
}

impl Painter<Montezuma> for MontezumaPainter {
    fn shape(&self) -> ([u32; 2], u32) {
        (self.scaler.size(), self.channels)
    }

    fn paint(&mut self, world: &Montezuma, out: &mut Frame) {
        let Some(stage) = &mut self.stage else {
            self.scaler.run(|y, pixels| row(world, y, 0..WIDTH, true, pixels), out);
            return;
        };
        let scenes = shown(world);
        let props = scenes.map(|scene| (scene.key, scene.open, scene.lives));
        if stage.shows != Some(props) {
            self.scaler.run(|y, pixels| row(world, y, 0..WIDTH, false, pixels), &mut stage.frame);
            stage.shows = Some(props);
        }
        out.copy(&stage.frame);
        let mut again = |area: Area| {
            let from = [area.x, area.y].map(|at| at as u32);
            let to = [area.right(), area.bottom()].map(|at| at as u32);
            let window = self.scaler.touches(Window { from, to });
            self.scaler.part(window, |y, columns, pixels| row(world, y, columns, true, pixels), out);
        };
        for [now, before] in [scenes.map(|scene| scene.player.area()), scenes.map(|scene| scene.skull.area())]
        {
            // A new life begins elsewhere: then the two places are apart.
            if now.meets(&before) {
                again(now.with(&before));
            } else {
                again(now);
                again(before);
            }
        }
    }
}

/// The two scenes that a picture shows: one twice, unless the brighter of two frames is wanted.
fn shown(world: &Montezuma) -> [&Scene; 2] {
    [world.scene(), if world.rules().pool { world.before() } else { world.scene() }]
}

/// These columns of a row as agents are to see it, RGB, with player and skull or without.
fn row(world: &Montezuma, y: u32, columns: Range<u32>, actors: bool, pixels: &mut [u8]) {
    let [now, before] = shown(world);
    let columns = columns.start as usize..columns.end as usize;
    let mut line = Line::of(now, y, columns.clone(), actors);
    if before != now {
        let before = Line::of(before, y, columns.clone(), actors);
        line.dots.iter_mut().zip(before.dots).for_each(|(now, before)| *now = before.max(*now));
    }
    for (pixel, &colour) in pixels.chunks_exact_mut(3).zip(&line.dots[..columns.len()]) {
        pixel.copy_from_slice(&PALETTE[usize::from(colour)]);
    }
}

/// Some columns of a row in colours of the palette.
struct Line {
    columns: Range<usize>,
    dots: [u8; WIDTH as usize],
}

impl Line {
    /// These columns of a scene's row, things in front last.
    fn of(scene: &Scene, y: u32, columns: Range<usize>, actors: bool) -> Self {
        let mut dots = [BLACK; WIDTH as usize];
        dots[..columns.len()].copy_from_slice(&SCENERY[y as usize][columns.clone()]);
        let (mut line, y) = (Self { columns, dots }, y as i32);
        if y < DOORS[0].y {
            line.panel(scene, y);
        }
        for (door, _) in DOORS.iter().zip(scene.open).filter(|(_, open)| !open) {
            line.door(door, y);
        }
        if scene.key == Key::Hanging {
            line.sprite(&sprites::KEY, [screen::KEY.x, screen::KEY.y], false, y);
        }
        if actors {
            let (skull, player) = (scene.skull.area(), scene.player.area());
            line.sprite(&sprites::SKULL, [skull.x, skull.y], scene.skull.left, y);
            line.sprite(sprites::pose(&scene.player), [player.x, player.y], scene.player.left, y);
        }
        line
    }

    fn dot(&mut self, x: i32, colour: u8) {
        let at = usize::try_from(x).ok().filter(|x| self.columns.contains(x));
        if let Some(x) = at {
            self.dots[x - self.columns.start] = colour;
        }
    }

    /// Points, lives in store, and the key.
    fn panel(&mut self, scene: &Scene, y: i32) {
        let score = scene.score();
        if let Some(line) = usize::try_from(y - SCORE_Y).ok().filter(|&line| line < DIGITS[0].len()) {
            for (place, unit) in [1000, 100, 10, 1].into_iter().enumerate() {
                let bits = DIGITS[(score / unit % 10) as usize][line];
                let x = PANEL_X + place as i32 * PITCH;
                // Twice as wide as high, as Atari's pixels are.
                (0..6).filter(|dot| bits >> (2 - dot / 2) & 1 == 1).for_each(|dot| self.dot(x + dot, WHITE));
            }
        }
        for life in 1..i32::from(scene.lives) {
            self.sprite(&sprites::LIFE, [PANEL_X + (life - 1) * PITCH, LIVES_Y], false, y);
        }
        if scene.key == Key::Held {
            self.sprite(&sprites::KEY, [PANEL_X, INVENTORY_Y], false, y);
        }
    }

    /// Bars with a hole every fourth row.
    fn door(&mut self, door: &Area, y: i32) {
        if (door.y..door.bottom()).contains(&y) {
            let hole = |x: i32| (y - door.y) % 4 == 2 && x > door.x && x < door.right() - 1;
            (door.x..door.right()).filter(|&x| !hole(x)).for_each(|x| self.dot(x, YELLOW));
        }
    }

    /// What a sprite has in row `y` of the screen.
    fn sprite<const W: usize, const H: usize>(
        &mut self,
        sprite: &Sprite<W, H>,
        [left, top]: [i32; 2],
        mirrored: bool,
        y: i32,
    ) {
        let Some(colours) = usize::try_from(y - top).ok().and_then(|line| sprite.get(line)) else { return };
        let (first, end) = (self.columns.start as i32, self.columns.end as i32);
        for x in first.max(left)..end.min(left + W as i32) {
            let at = (x - left) as usize;
            let colour = colours[if mirrored { W - 1 - at } else { at }];
            if colour != BLACK {
                self.dots[(x - first) as usize] = colour;
            }
        }
    }
}
