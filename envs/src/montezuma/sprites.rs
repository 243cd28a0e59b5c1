//! Colours and small pictures: drawn for this crate, none of them the game's.

use super::player::{PIXEL, Player, Status};

/// The colours, from the darkest to the brightest, so that the brighter of two is the greater number: OC_Atari's readings of
/// the real screen.
pub(super) const PALETTE: [[u8; 3]; 6] =
    [[0, 0, 0], [200, 72, 72], [66, 158, 130], [228, 111, 111], [232, 204, 99], [236, 236, 236]];

pub(super) const BLACK: u8 = 0;
pub(super) const GREEN: u8 = 2;
pub(super) const YELLOW: u8 = 4;
pub(super) const WHITE: u8 = 5;

/// A small picture in colours of the palette. Black shows what is behind: nothing in front is black.
pub(super) type Sprite<const W: usize, const H: usize> = [[u8; W]; H];

/// Reads a picture in letters: `r` red, `g` green, `p` pink, `y` yellow, `w` white; a dot shows what is behind.
const fn read<const W: usize, const H: usize>(letters: [&[u8; W]; H]) -> Sprite<W, H> {
    let mut sprite = [[BLACK; W]; H];
    let mut at = 0;
    while at < W * H {
        sprite[at / W][at % W] = match letters[at / W][at % W] {
            b'r' => 1,
            b'g' => GREEN,
            b'p' => 3,
            b'y' => YELLOW,
            b'w' => WHITE,
            b'.' => BLACK,
            _ => panic!("a letter that is no colour"),
        };
        at += 1;
    }
    sprite
}

/// The player as it looks now; drawn as it looks to the right.
pub(super) fn pose(player: &Player) -> &'static Sprite<8, 20> {
    // Which of two steps it is at: changes every four pixels, so that no clock is needed.
    let step = |at: i32| at.div_euclid(4 * PIXEL).rem_euclid(2) == 0;
    match player.status() {
        Status::Standing => &STANDING,
        Status::Running if step(player.x) => &STANDING,
        Status::Running => &RUNNING,
        Status::OnLadder | Status::ClimbingLadder if step(player.y) => &CLIMBING,
        Status::OnLadder | Status::ClimbingLadder => &CLIMBING_TOO,
        Status::OnRope | Status::ClimbingRope => &HANGING,
        Status::MidAir => &JUMPING,
        Status::Dead => &DEAD,
    }
}

static STANDING: Sprite<8, 20> = read([
    b"..rrrr..",
    b"..rrrr..",
    b".rrrrrr.",
    b"..pppp..",
    b"..pp.p..",
    b"..pppp..",
    b"...pp...",
    b"..rrrr..",
    b".rrrrrr.",
    b".rrrrrr.",
    b".prrrrp.",
    b".prrrrp.",
    b".p.rr.p.",
    b"...rr...",
    b"..pppp..",
    b"..pppp..",
    b"..p..p..",
    b"..p..p..",
    b"..p..p..",
    b"..rr.rr.",
]);

static RUNNING: Sprite<8, 20> = read([
    b"..rrrr..",
    b"..rrrr..",
    b".rrrrrr.",
    b"..pppp..",
    b"..pp.p..",
    b"..pppp..",
    b"...pp...",
    b"..rrrr..",
    b".rrrrrr.",
    b"prrrrrrp",
    b"p.rrrr.p",
    b"p.rrrr.p",
    b"...rr...",
    b"..rrrr..",
    b"..pppp..",
    b".pp..pp.",
    b".p....pp",
    b"pp.....p",
    b"p......p",
    b"rr.....r",
]);

static CLIMBING: Sprite<8, 20> = read([
    b"..rrrr.p",
    b"..rrrr.p",
    b".rrrrrrp",
    b"..pppp.p",
    b"..pppppp",
    b"..ppppr.",
    b"...prrr.",
    b"..rrrr..",
    b".rrrrr..",
    b"prrrrr..",
    b"p.rrrr..",
    b"p.rrrr..",
    b"...rr...",
    b"..rrrr..",
    b"..pppp..",
    b"..p..pp.",
    b"..p...p.",
    b"..p..rr.",
    b"..p.....",
    b".rr.....",
]);

static CLIMBING_TOO: Sprite<8, 20> = read([
    b"p.rrrr..",
    b"p.rrrr..",
    b"prrrrrr.",
    b"p.pppp..",
    b"pppppp..",
    b".rpppp..",
    b".rrrp...",
    b"..rrrr..",
    b"..rrrrr.",
    b"..rrrrrp",
    b"..rrrr.p",
    b"..rrrr.p",
    b"...rr...",
    b"..rrrr..",
    b"..pppp..",
    b".pp..p..",
    b".p...p..",
    b".rr..p..",
    b".....p..",
    b".....rr.",
]);

static HANGING: Sprite<8, 20> = read([
    b"..rrrrpp",
    b"..rrrrpp",
    b".rrrrrrp",
    b"..pppp.p",
    b"..pp.ppp",
    b"..ppppp.",
    b"...pprr.",
    b"..rrrrr.",
    b"..rrrr..",
    b"..rrrrp.",
    b"..rrrrpp",
    b"..rrrr..",
    b"...rr...",
    b"..rrrr..",
    b"..pppp..",
    b"...ppp..",
    b"....pp..",
    b"...pp...",
    b"...pp...",
    b"...rrr..",
]);

static JUMPING: Sprite<8, 20> = read([
    b"..rrrr..",
    b"..rrrr..",
    b".rrrrrr.",
    b"..pppp..",
    b"p.pp.p.p",
    b"p.pppp.p",
    b"pp.pp.pp",
    b".rrrrrr.",
    b"..rrrr..",
    b"..rrrr..",
    b"..rrrr..",
    b"..rrrr..",
    b"...rr...",
    b"..rrrr..",
    b".pppppp.",
    b".pp..ppp",
    b"pp.....p",
    b"p.....rr",
    b"p.......",
    b"rr......",
]);

static DEAD: Sprite<8, 20> = read([
    b"........",
    b"........",
    b"........",
    b"........",
    b"........",
    b"........",
    b"........",
    b"........",
    b"........",
    b"...pp...",
    b".p....p.",
    b"...rr...",
    b"..r..r..",
    b"..pppp..",
    b"..p.pp..",
    b"..pppp..",
    b".rrrrrr.",
    b"prrrrrrp",
    b"pprrrrpp",
    b"rrppppr.",
]);

pub(super) static SKULL: Sprite<7, 13> = read([
    b"..www..", b".wwwww.", b"wwwwwww", b"wwwwwww", b"w..w..w", b"w..w..w", b"wwwwwww", b".ww.ww.",
    b"..www..", b".w.w.w.", b".w.w.w.", b".wwwww.", b"..www..",
]);

pub(super) static KEY: Sprite<7, 15> = read([
    b"..yyy..", b".yy.yy.", b".y...y.", b".yy.yy.", b"..yyy..", b"...y...", b"...y...", b"...y...",
    b"...y...", b"...y...", b"...yyy.", b"...y.y.", b"...y...", b"...yyy.", b"...y.y.",
]);

/// A hat: a life in store.
pub(super) static LIFE: Sprite<7, 5> = read([b"..rrr..", b"..rrr..", b"..rrr..", b"rrrrrrr", b".rrrrr."]);

/// Digits, three bits a row.
pub(super) const DIGITS: [[u8; 5]; 10] = [
    [7, 5, 5, 5, 7],
    [2, 6, 2, 2, 7],
    [7, 1, 7, 4, 7],
    [7, 1, 3, 1, 7],
    [5, 5, 7, 1, 1],
    [7, 4, 7, 1, 7],
    [7, 4, 7, 5, 7],
    [7, 1, 1, 2, 2],
    [7, 5, 7, 5, 7],
    [7, 5, 7, 1, 7],
];

#[cfg(test)]
mod tests {
    use super::super::screen;
    use super::*;

    #[test]
    fn colours_ascend_in_brightness() {
        let luma = |[r, g, b]: [u8; 3]| 299 * u32::from(r) + 587 * u32::from(g) + 114 * u32::from(b);
        assert!(PALETTE.windows(2).all(|pair| luma(pair[0]) < luma(pair[1])));
    }

    #[test]
    fn sprites_have_the_sizes_of_what_they_show() {
        fn size<const W: usize, const H: usize>(_: &Sprite<W, H>) -> [i32; 2] {
            [W as i32, H as i32]
        }
        assert_eq!(size(&STANDING), screen::PLAYER);
        assert_eq!(size(&SKULL), screen::SKULL);
        assert_eq!(size(&KEY), [screen::KEY.width, screen::KEY.height]);
    }
}
