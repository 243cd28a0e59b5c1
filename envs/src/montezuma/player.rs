//! How the player moves, a frame at a time.
//!
//! **Invented**: every speed, the arc, which falls kill, what can be grabbed from where. The real game's numbers are not
//! known to us; these make its route walkable and its shortcuts not.

use super::screen::{self, Area, DOORS, LADDERS, PLAYER, ROPE, SURFACES, Surface, WALLS};

/// Parts of a pixel in which places and speeds are counted, so that all arithmetic is exact.
pub const PIXEL: i32 = 256;
/// Running: a pixel a frame.
pub const RUN: i32 = PIXEL;
/// Climbing ladder and rope: half a pixel a frame.
pub const CLIMB: i32 = PIXEL / 2;
/// A jump's speed sideways, kept until it is back at the level that it began on, from where it goes straight down:
/// 0.625 pixels a frame, 22.5 in a jump. That is enough for the rope and for the upper gaps, and not for the 24 pixels
/// between left belt and left platform.
pub const STRIDE: i32 = 160;
/// A jump's first speed upwards. With [`GRAVITY`]: 15.8 pixels high, over a skull of 13, and back after 36 frames.
pub const LEAP: i32 = 437;
/// What a frame in the air adds to the speed downwards.
pub const GRAVITY: i32 = 25;
/// Who comes down faster dies: whoever falls 40 pixels or more, as from any level to the next (43).
pub const FATAL: i32 = 700;
/// How far from a ladder's middle one may be to step onto it, pixels (the author's code has this margin around ladders).
pub const REACH: i32 = 4;
/// First row of the player at the upper and lower end of the rope.
pub const ROPE_ENDS: [i32; 2] = [ROPE.y, 116];

/// What the player holds on to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Hold {
    /// Something to stand on.
    Ground,
    /// The ladder of that number.
    Ladder(u8),
    /// The rope.
    Rope,
    /// Nothing.
    Air,
    /// Nothing any more.
    Dead,
}

/// What the player is doing, as the author's tools tell it from the game's memory. The numbers are ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Status {
    /// On the ground, not walking by itself.
    Standing,
    /// On the ground.
    Running,
    /// On a ladder.
    OnLadder,
    /// Up or down a ladder.
    ClimbingLadder,
    /// On the rope.
    OnRope,
    /// Up or down the rope.
    ClimbingRope,
    /// Jumping or falling.
    MidAir,
    /// Dead; a new life follows, unless it was the last.
    Dead,
}

/// What the stick is doing: −1, 0 or 1 along each axis, y downwards, and the button.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stick {
    /// Left or right.
    pub x: i32,
    /// Up or down.
    pub y: i32,
    /// The button: jump.
    pub fire: bool,
}

/// What changes of the ground: which doors are open, and how belts drift, parts of a pixel a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Terrain {
    /// Left and right.
    pub open: [bool; 2],
    /// Left and right belt; positive is to the right.
    pub drift: [i32; 2],
}

/// The player. Lengths in [`PIXEL`]s' parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Player {
    /// Left edge.
    pub x: i32,
    /// Upper edge.
    pub y: i32,
    /// Own speed to the right: in the air what the next frame goes, elsewhere what the last went, without a belt's drift.
    pub vx: i32,
    /// The same downwards.
    pub vy: i32,
    /// What it holds on to.
    pub hold: Hold,
    /// Whether it looks to the left.
    pub left: bool,
}

impl Player {
    /// The player at rest with its top left at this pixel, holding on to whatever is there.
    pub fn at([x, y]: [i32; 2]) -> Self {
        let mut player = Self { x: x * PIXEL, y: y * PIXEL, vx: 0, vy: 0, hold: Hold::Air, left: false };
        let feet = y + PLAYER[1];
        let on = |ladder: &&screen::Ladder| {
            (x + PLAYER[0] / 2 - ladder.middle()).abs() <= REACH && ladder.top < feet && feet < ladder.foot
        };
        player.hold = match LADDERS.iter().position(|ladder| on(&ladder)) {
            _ if player.surface().is_some() => Hold::Ground,
            Some(number) => Hold::Ladder(number as u8),
            None if x + PLAYER[0] / 2 == ROPE.x && (ROPE_ENDS[0]..=ROPE_ENDS[1]).contains(&y) => Hold::Rope,
            None => Hold::Air,
        };
        player
    }

    /// What it is doing.
    pub fn status(&self) -> Status {
        match self.hold {
            Hold::Ground if self.vx == 0 => Status::Standing,
            Hold::Ground => Status::Running,
            Hold::Ladder(_) if self.vy == 0 => Status::OnLadder,
            Hold::Ladder(_) => Status::ClimbingLadder,
            Hold::Rope if self.vy == 0 => Status::OnRope,
            Hold::Rope => Status::ClimbingRope,
            Hold::Air => Status::MidAir,
            Hold::Dead => Status::Dead,
        }
    }

    /// The pixels that it covers.
    pub fn area(&self) -> Area {
        Area::new(self.x.div_euclid(PIXEL), self.y.div_euclid(PIXEL), PLAYER[0], PLAYER[1])
    }

    /// What the game's memory would say of its place.
    pub fn ram(&self) -> [i32; 2] {
        let Area { x, y, .. } = self.area();
        screen::to_ram([x, y])
    }

    /// The next frame. Tells which closed door it ran into.
    pub(super) fn frame(&mut self, stick: Stick, terrain: &Terrain) -> Option<usize> {
        if stick.x != 0 && matches!(self.hold, Hold::Ground | Hold::Rope) {
            self.left = stick.x < 0;
        }
        match self.hold {
            Hold::Ground => self.walk(stick, terrain),
            Hold::Ladder(number) => {
                self.climb(usize::from(number), stick.y);
                None
            }
            Hold::Rope if stick.fire && stick.x != 0 => self.jump(stick.x, terrain),
            Hold::Rope => {
                let [top, end] = ROPE_ENDS.map(|y| y * PIXEL);
                let to = (self.y + stick.y * CLIMB).clamp(top, end);
                (self.vx, self.vy, self.y) = (0, to - self.y, to);
                None
            }
            Hold::Air => self.fly(terrain),
            Hold::Dead => None,
        }
    }

    /// Dies where it is.
    pub(super) fn die(&mut self) {
        (self.hold, self.vx, self.vy) = (Hold::Dead, 0, 0);
    }

    fn walk(&mut self, stick: Stick, terrain: &Terrain) -> Option<usize> {
        if stick.fire {
            return self.jump(stick.x, terrain);
        }
        if let Some(number) = self.ladder(stick.y) {
            self.hold = Hold::Ladder(number as u8);
            self.x = (LADDERS[number].middle() - PLAYER[0] / 2) * PIXEL;
            self.climb(number, stick.y);
            return None;
        }
        let from = self.x;
        let mut door = self.shift(stick.x * RUN, terrain);
        (self.vx, self.vy) = (self.x - from, 0);
        if let Some(belt) = self.surface().and_then(|surface| surface.belt) {
            door = door.or(self.shift(terrain.drift[belt], terrain));
        }
        if self.surface().is_none() {
            (self.hold, self.vx) = (Hold::Air, 0);
        }
        door
    }

    /// The ladder that leads from here in the stick's direction.
    fn ladder(&self, y: i32) -> Option<usize> {
        let near = |ladder: &screen::Ladder| (self.middle() - ladder.middle() * PIXEL).abs() <= REACH * PIXEL;
        LADDERS.iter().position(|ladder| {
            let end = if y < 0 { ladder.foot } else { ladder.top };
            y != 0 && self.feet() == end * PIXEL && near(ladder)
        })
    }

    fn climb(&mut self, number: usize, y: i32) {
        let from = self.y;
        let [top, foot] = [LADDERS[number].top, LADDERS[number].foot].map(|feet| (feet - PLAYER[1]) * PIXEL);
        self.y = (from + y * CLIMB).clamp(top, foot);
        (self.vx, self.vy) = (0, self.y - from);
        if self.y == top || self.y == foot {
            (self.hold, self.vy) = (Hold::Ground, 0);
        }
    }

    fn jump(&mut self, x: i32, terrain: &Terrain) -> Option<usize> {
        (self.vx, self.vy, self.hold) = (x * STRIDE, -LEAP, Hold::Air);
        self.fly(terrain)
    }

    fn fly(&mut self, terrain: &Terrain) -> Option<usize> {
        let (middle, top, feet, speed) = (self.middle(), self.y, self.feet(), self.vy);
        let door = self.shift(self.vx, terrain);
        self.y += speed;
        self.vy += GRAVITY;
        if self.vy > LEAP + GRAVITY {
            self.vx = 0;
        }
        if self.grabs(middle) {
            (self.hold, self.vx, self.vy) = (Hold::Rope, 0, 0);
            self.x = (ROPE.x - PLAYER[0] / 2) * PIXEL;
        } else if speed < 0 {
            let under = |s: &&Surface| (self.y..=top).contains(&((s.y + s.thick) * PIXEL));
            if let Some(ceiling) = self.over().find(under) {
                (self.y, self.vy) = ((ceiling.y + ceiling.thick) * PIXEL, 0);
            }
        } else if let Some(ground) = self.over().find(|s| (feet..=self.feet()).contains(&(s.y * PIXEL))) {
            self.y = (ground.y - PLAYER[1]) * PIXEL;
            if speed > FATAL {
                self.die();
            } else {
                // On whole pixels again, so that a walk has few places.
                self.x = (self.x + PIXEL / 2).div_euclid(PIXEL) * PIXEL;
                (self.hold, self.vx, self.vy) = (Hold::Ground, 0, 0);
            }
        }
        door
    }

    /// Whether the frame that began with its middle there took it to the rope.
    fn grabs(&self, from: i32) -> bool {
        let rope = ROPE.x * PIXEL;
        let crossed = from != rope && (from - rope).signum() != (self.middle() - rope).signum();
        crossed && (ROPE_ENDS[0] * PIXEL..=ROPE_ENDS[1] * PIXEL).contains(&self.y)
    }

    /// Moves sideways as far as walls, closed doors and the screen let it; tells which door did not.
    fn shift(&mut self, by: i32, terrain: &Terrain) -> Option<usize> {
        let [width, height] = PLAYER.map(|side| side * PIXEL);
        let wanted = self.x + by;
        let (mut to, mut door) = (wanted, None);
        let shut = (0..2).filter(|&number| !terrain.open[number]).map(|number| (DOORS[number], Some(number)));
        for (area, number) in WALLS.iter().map(|&wall| (wall, None)).chain(shut) {
            let [left, right] = [area.x, area.right()].map(|x| x * PIXEL);
            let beside = area.y * PIXEL < self.y + height && self.y < area.bottom() * PIXEL;
            if beside && left < to + width && to < right {
                to = if by > 0 { left - width } else { right };
                door = door.or(number);
            }
        }
        self.x = to.clamp(0, screen::WIDTH as i32 * PIXEL - width);
        if self.hold == Hold::Air && self.x != wanted {
            self.vx = 0;
        }
        door
    }

    /// The middle of its soles.
    fn middle(&self) -> i32 {
        self.x + PLAYER[0] / 2 * PIXEL
    }

    fn feet(&self) -> i32 {
        self.y + PLAYER[1] * PIXEL
    }

    /// What lies below or above its middle.
    fn over(&self) -> impl Iterator<Item = &'static Surface> + use<> {
        let middle = self.middle();
        SURFACES.iter().filter(move |s| (s.from * PIXEL..=s.to * PIXEL).contains(&middle))
    }

    /// What it stands on.
    fn surface(&self) -> Option<&'static Surface> {
        self.over().find(|surface| surface.y * PIXEL == self.feet())
    }
}
