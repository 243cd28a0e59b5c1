//! The game that looks like Montezuma's first screen: what may never happen in it, and how it moves.

use std::collections::HashSet;

use inroads_envs::{
    End, Environment, Frame, Rng, Seed, Snapshot, Sweep, TimeLimit,
    montezuma::{
        Belts, Hold, Key, Montezuma, PIXEL, Player, Rules, STARTS, Scene, Status, TARGETS,
        screen::{DOORS, LADDERS, ROPE, SURFACES, WALLS, from_ram},
    },
    world::{Drawn, Layout, Painter, Symbolic, World},
};
use inroads_sim::raster::{Filter, Format, Scaler};
use rand::RngExt;

/// Choices by what they press.
const NOOP: usize = 0;
const FIRE: usize = 1;
const UP: usize = 2;
const RIGHT: usize = 3;
const LEFT: usize = 4;
const DOWN: usize = 5;
const RIGHT_FIRE: usize = 11;
const LEFT_FIRE: usize = 12;

fn game(rules: Rules) -> Montezuma {
    let mut game = Montezuma::new(rules).unwrap();
    World::begin(&mut game, Layout::Fixed(0).draw(0));
    game
}

/// One choice a frame.
fn by_frames() -> Montezuma {
    game(Rules { repeat: 1, ..Rules::default() })
}

/// Puts the player there, as in the game's memory, and the skull far away.
fn put(game: &mut Montezuma, at: [i32; 2]) {
    let [mut scene, _] = game.save();
    scene.player = Player::at(from_ram(at));
    game.load(&[scene, scene]);
}

/// Plays at random, anew after each end, and shows each state.
fn wander(game: &mut Montezuma, rng: &mut Rng, decisions: u32, mut look: impl FnMut(&Montezuma)) {
    for _ in 0..decisions {
        if game.act(rng.random_range(0..18)).end.is_some() {
            Sweep::begin(game, rng.random_range(0..STARTS.len()));
        }
        look(game);
    }
}

#[test]
fn nobody_is_ever_in_a_wall_or_holds_on_to_nothing() {
    let mut game = by_frames();
    let mut seen = HashSet::new();
    wander(&mut game, &mut Seed(1).stream("play", 0), 300_000, |game| {
        let Scene { player, open, .. } = game.scene();
        let area = player.area();
        let shut = DOORS.iter().zip(open).filter(|(_, open)| !**open).map(|(door, _)| door);
        for solid in WALLS.iter().chain(shut) {
            let [left, right] = [solid.x, solid.right()].map(|x| x * PIXEL);
            let beside = area.y < solid.bottom() && solid.y < area.bottom();
            let within = left < player.x + 8 * PIXEL && player.x < right;
            assert!(!(beside && within), "{player:?} in {solid:?}");
        }
        let (middle, feet) = (player.x + 4 * PIXEL, player.y + 20 * PIXEL);
        let on =
            SURFACES.iter().any(|s| s.y * PIXEL == feet && (s.from * PIXEL..=s.to * PIXEL).contains(&middle));
        match player.hold {
            Hold::Ground => assert!(on, "{player:?}"),
            Hold::Ladder(number) => {
                let ladder = LADDERS[usize::from(number)];
                assert_eq!(middle, ladder.middle() * PIXEL);
                assert!(ladder.top * PIXEL < feet && feet < ladder.foot * PIXEL);
            }
            Hold::Rope => assert!(middle == ROPE.x * PIXEL && (96..=116).contains(&area.y)),
            Hold::Air | Hold::Dead => {}
        }
        seen.insert(player.status() as u8);
    });
    assert_eq!(seen.len(), 8, "random play does everything: {seen:?}");
}

#[test]
fn what_follows_a_snapshot_is_the_same_in_mid_jump_too() {
    let (mut game, mut air) = (game(Rules::default()), 0);
    let mut rng = Seed(2).stream("play", 0);
    for _ in 0..300 {
        wander(&mut game, &mut rng, 7, |_| {});
        let state = game.save();
        air += u32::from(game.scene().player.status() == Status::MidAir);
        let play = |game: &mut Montezuma| {
            let mut trace = Vec::new();
            wander(game, &mut Seed(3).stream("play", 0), 30, |game| {
                let mut symbols = Vec::new();
                game.symbols(&mut symbols);
                trace.push(symbols);
            });
            trace
        };
        let first = play(&mut game);
        let mut other = Montezuma::new(Rules::default()).unwrap();
        other.load(&state);
        assert_eq!(play(&mut other), first);
        game.load(&state);
    }
    assert!(air > 20, "{air} of 300 in mid-air");
}

#[test]
fn symbols_lie_where_the_card_says() {
    let mut game = by_frames();
    let (card, mut least) = (game.card(), 0.0_f32);
    let mut symbols = Vec::new();
    wander(&mut game, &mut Seed(5).stream("play", 0), 400_000, |game| {
        game.symbols(&mut symbols);
        assert_eq!(symbols.len(), card.symbols.len());
        for (&value, dimension) in symbols.iter().zip(&card.symbols) {
            assert!((dimension.low..=dimension.high).contains(&value), "{}: {value}", dimension.name);
        }
        least = least.min(symbols[3]);
    });
    assert!(least < -4.2, "nobody fell from a jump off the upper level: {least}");
}

#[test]
fn symbols_tell_the_whole_state() {
    let mut game = by_frames();
    wander(&mut game, &mut Seed(4).stream("play", 0), 50_000, |game| {
        let mut s = Vec::new();
        game.symbols(&mut s);
        let parts = |x: f32| (x * PIXEL as f32) as i32;
        let (x, y) = (parts(s[0] - 1.0), parts(308.0 - s[1]));
        let hold = match s[4] as u8 {
            0 | 1 => Hold::Ground,
            2 | 3 => {
                Hold::Ladder(LADDERS.iter().position(|l| l.middle() * PIXEL == x + 4 * PIXEL).unwrap() as u8)
            }
            4 | 5 => Hold::Rope,
            6 => Hold::Air,
            _ => Hold::Dead,
        };
        // The middle ladder and the others never share a row, so the column tells which it is.
        let told = Player { x, y, vx: parts(s[2]), vy: -parts(s[3]), hold, left: s[5] == 1.0 };
        let scene = game.scene();
        assert_eq!(told, scene.player);
        let key = [Key::Used, Key::Hanging, Key::Held][(s[6] + 2.0 * s[7]) as usize];
        let told = (key, [s[8] == 1.0, s[9] == 1.0], s[10] as u8, parts(s[11]), s[12] == 1.0, s[13] as u8);
        let (skull, lives) = (scene.skull, scene.lives);
        assert_eq!(told, (scene.key, scene.open, lives, skull.x, skull.left, scene.mourning));
    });
}

#[test]
fn a_jump_is_sixteen_pixels_high_and_returns_to_its_level_after_36_frames() {
    let mut game = by_frames();
    put(&mut game, [30, 148]);
    let (mut highest, mut frames) = (0, 0);
    loop {
        game.act(if frames == 0 { RIGHT_FIRE } else { NOOP });
        frames += 1;
        let [x, y] = game.scene().player.ram();
        highest = highest.max(y - 148);
        if game.scene().player.status() != Status::MidAir {
            assert_eq!(([x, y], highest, frames), ([53, 148], 16, 36));
            break;
        }
    }
}

#[test]
fn running_climbing_and_belts_have_their_speeds() {
    let mut game = game(Rules::default());
    game.act(RIGHT);
    assert_eq!(game.scene().player.ram(), [81, 235]);
    put(&mut game, [77, 235]);
    game.act(DOWN);
    assert_eq!(game.scene().player.ram(), [77, 233]);
    assert_eq!(game.scene().player.status(), Status::ClimbingLadder);
    game.act(UP);
    assert_eq!((game.scene().player.ram(), game.scene().player.status()), ([77, 235], Status::Standing));
    for (at, after) in [([62, 192], 64), ([90, 192], 88), ([77, 192], 77)] {
        put(&mut game, at);
        game.act(NOOP);
        assert_eq!(game.scene().player.ram(), [after, 192], "belts carry one to the ladder's foot");
    }
}

#[test]
fn belts_drift_as_the_rules_say() {
    for (belts, left, right) in
        [(Belts::Outward, -2, 2), (Belts::Left, -2, -2), (Belts::Right, 2, 2), (Belts::Still, 0, 0)]
    {
        for (x, drift) in [(66, left), (90, right)] {
            let mut game = game(Rules { belts, ..Rules::default() });
            put(&mut game, [x, 192]);
            game.act(NOOP);
            assert_eq!(game.scene().player.ram(), [x + drift, 192], "{belts:?}");
        }
    }
}

#[test]
fn left_belt_and_left_platform_are_too_far_apart_for_any_jump() {
    let mut game = by_frames();
    for x in 57..=73 {
        put(&mut game, [x, 192]);
        game.act(LEFT_FIRE);
        while game.scene().player.status() == Status::MidAir {
            game.act(LEFT);
        }
        assert_eq!(game.scene().player.status(), Status::Dead, "from {x}");
    }
}

#[test]
fn the_rope_catches_a_jump_from_the_belt_and_lets_go_to_either_side() {
    let mut game = by_frames();
    for (fire, level) in [(RIGHT_FIRE, 124), (LEFT_FIRE, 100)] {
        put(&mut game, [97, 192]);
        game.act(RIGHT_FIRE);
        while game.scene().player.status() == Status::MidAir {
            game.act(NOOP);
        }
        assert_eq!((game.scene().player.status(), game.scene().player.ram()[0]), (Status::OnRope, 109));
        game.act(FIRE);
        assert_eq!(game.scene().player.status(), Status::OnRope, "without a direction it holds on");
        game.act(fire);
        while game.scene().player.status() == Status::MidAir {
            game.act(NOOP);
        }
        assert_eq!(game.scene().player.ram()[1], 192);
        let x = game.scene().player.area().x + 4;
        assert!(if level == 124 { x >= level } else { x <= level }, "{x}");
    }
}

#[test]
fn a_fall_of_a_level_kills_and_a_life_begins_where_the_first_did() {
    let mut game = game(Rules::default());
    for lives in (0..5).rev() {
        let end = loop {
            let step = game.act(LEFT);
            assert_eq!(step.reward, 0.0);
            if game.scene().lives == lives {
                break step.end;
            }
        };
        assert_eq!(game.scene().player.status(), Status::Dead);
        assert_eq!(end, (lives == 0).then_some(End::Terminated));
        if lives > 0 {
            (0..8).for_each(|_| assert!(game.act(NOOP).end.is_none()));
            let scene = game.scene();
            assert_eq!((scene.player.ram(), scene.player.status()), ([77, 235], Status::Standing));
        }
    }
}

#[test]
fn the_skull_kills_who_waits_and_not_who_jumps() {
    let mut still = by_frames();
    put(&mut still, [80, 148]);
    (0..200).for_each(|_| assert!(still.act(NOOP).end.is_none()));
    assert_eq!(still.scene().lives, 4);
    let passes = (0..160).filter(|&wait| {
        let mut game = by_frames();
        put(&mut game, [66, 148]);
        (0..wait).for_each(|_| assert!(game.act(NOOP).end.is_none()));
        (0..36).for_each(|_| assert!(game.act(RIGHT_FIRE).end.is_none()));
        game.scene().lives == 5 && game.scene().player.x > game.scene().skull.x
    });
    let passes = passes.count();
    assert!(passes > 5, "{passes} of 160 moments are good for a jump");
}

#[test]
fn doors_stop_who_has_no_key_and_open_to_who_has_it() {
    for (target, run, door) in [(0, LEFT, 0), (1, RIGHT, 1)] {
        let mut game = game(Rules::default());
        put(&mut game, if door == 0 { [40, 235] } else { [115, 235] });
        (0..10).for_each(|_| assert_eq!(game.act(run).reward, 0.0));
        assert!(game.attained(target), "{:?}", game.scene().player.ram());
        let [mut scene, _] = game.save();
        scene.key = Key::Held;
        game.load(&[scene, scene]);
        let step = game.act(run);
        assert_eq!((step.reward, step.end), (300.0, Some(End::Terminated)));
        assert!(game.scene().open[door] && game.scene().key == Key::Used && game.attained(target));
    }
}

#[test]
fn free_starts_are_spread_over_the_hundred() {
    let mut game = Montezuma::new(Rules::default()).unwrap();
    let mut seen = HashSet::new();
    for seed in 0..1500 {
        World::begin(&mut game, Layout::FixedMap(0).draw(seed));
        seen.insert(game.scene().player.ram());
        assert!(STARTS.contains(&game.scene().player.ram()));
    }
    assert_eq!(seen.len(), STARTS.len());
}

#[test]
fn starts_can_be_swept_and_none_is_lost_at_once() {
    let mut env =
        TimeLimit::new(Symbolic::new(Montezuma::new(Rules::default()).unwrap(), Layout::Fixed(0)), 500);
    assert_eq!(env.starts(), 100);
    for (number, start) in STARTS.iter().enumerate() {
        Sweep::begin(&mut env, number);
        for _ in 0..5 {
            env.step(&NOOP).unwrap();
        }
        let scene = env.inner().world().scene();
        assert_eq!(scene.lives, 5, "from {start:?}");
    }
}

#[test]
fn random_play_gets_no_key() {
    let mut game = game(Rules::default());
    let mut rng = Seed(5).stream("play", 0);
    let (mut keys, mut episodes) = (0, 0);
    for _ in 0..100_000 {
        let step = game.act(rng.random_range(0..18));
        keys += u32::from(step.reward > 0.0);
        if step.end.is_some() {
            World::begin(&mut game, Layout::Fixed(0).draw(0));
            episodes += 1;
        }
    }
    assert_eq!(keys, 0, "in {episodes} episodes");
    assert!(episodes > 100, "{episodes}");
}

#[test]
fn facts_are_about_the_player_and_the_targets() {
    let mut game = game(Rules::default());
    put(&mut game, [77, 192]);
    let facts = game.facts();
    assert_eq!(facts.len(), 5 + TARGETS.len());
    let fact = |name: &str| facts.iter().find(|fact| fact.name == name).unwrap().value;
    assert_eq!([fact("ram x"), fact("ram y"), fact("lives"), fact("has key")], [77.0, 192.0, 5.0, 0.0]);
    assert_eq!([fact("foot of the middle ladder"), fact("left door")], [1.0, 0.0]);
}

/// The picture as drawn, of one scene or the brighter of two.
fn native(game: &Montezuma) -> Frame {
    let mut frame = Frame::default();
    game.painter(Format::NATIVE).paint(game, &mut frame);
    frame
}

#[test]
fn painting_on_is_painting_everything() {
    let formats = [
        Format::ATARI,
        Format::THESIS,
        Format::THESIS_GREY,
        Format { scale: Some(([64, 80], Filter::Linear)), ..Format::NATIVE },
    ];
    for format in formats {
        for pool in [false, true] {
            let mut game = game(Rules { pool, ..Rules::default() });
            let mut painter = game.painter(format);
            let (mut painted, mut drawn) = (Frame::default(), Frame::default());
            let mut scaler = Scaler::new([160, 210], format);
            let mut decision = 0;
            wander(&mut game, &mut Seed(6).stream("play", 0), 600, |game| {
                decision += 1;
                painter.paint(game, &mut painted);
                let whole = native(game);
                scaler.run(|y, row| row.copy_from_slice(whole.row(y)), &mut drawn);
                assert!(painted == drawn, "{format:?}, decision {decision}");
            });
        }
    }
}

#[test]
fn the_thesis_sees_the_brighter_of_two_frames_in_grey() {
    let mut pooled = game(Rules::THESIS);
    let mut painter = pooled.painter(Format::ATARI);
    let mut plain = game(Rules::default());
    let luma = |frame: &Frame| -> Vec<u8> {
        let weighted = |p: &[u8]| 4899 * u32::from(p[0]) + 9617 * u32::from(p[1]) + 1868 * u32::from(p[2]);
        frame.bytes().chunks(3).map(|pixel| ((weighted(pixel) + 8192) >> 14) as u8).collect()
    };
    let (mut seen, mut told, mut moved) = (Frame::default(), Frame::default(), 0);
    let mut scaler = Scaler::new([160, 210], Format::ATARI);
    wander(&mut pooled, &mut Seed(7).stream("play", 0), 1000, |pooled| {
        let greys = [pooled.scene(), pooled.before()].map(|&scene| {
            plain.load(&[scene, scene]);
            luma(&native(&plain))
        });
        moved += u32::from(greys[0] != greys[1]);
        let brighter: Vec<u8> = greys[0].iter().zip(&greys[1]).map(|(a, b)| *a.max(b)).collect();
        let row = |y: u32, row: &mut [u8]| {
            let line = &brighter[160 * y as usize..][..160];
            row.chunks_mut(3).zip(line).for_each(|(pixel, &grey)| pixel.fill(grey));
        };
        scaler.run(row, &mut told);
        painter.paint(pooled, &mut seen);
        assert!(seen == told && seen.size() == [84, 84] && seen.channels() == 1);
    });
    assert!(moved > 700, "the skull is in another column in three of four frames: {moved}");
}
