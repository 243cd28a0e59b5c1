//! Episodes as pictures of the world itself: a domain's scene, step by step, through one of two cameras.

use image::{RgbImage, imageops};
use inroads_envs::{Domain, Drawing, Refused, Rng, Seed, Space, registry::AnyEnvironment};
use inroads_sim::{
    rigid::Rectangle,
    view::{Camera, Scene, draw},
};
use rand::RngExt;

use crate::{assembly::Vector, session::Action};

/// Frames of a film at most; longer episodes leave steps out.
const FRAMES: u32 = 300;
/// How much of what surrounds a domain is shown from above, metres.
const BORDER: f64 = 0.75;
/// Where the camera is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum View {
    /// Straight above; the whole domain.
    Above,
    /// At an angle, following the body.
    Beside,
}

/// What happens in a film.
#[derive(Clone, Debug)]
pub enum Play {
    /// These actions.
    Actions(Vec<Action>),
    /// So many steps of uniformly random actions.
    Random(u32),
}

impl Play {
    fn steps(&self) -> u32 {
        match self {
            Self::Actions(actions) => actions.len() as u32,
            Self::Random(steps) => *steps,
        }
    }
}

/// Films the episode that begins with `seed`, until it ends or the play does, in frames `width` pixels wide.
///
/// # Errors
/// The action that the environment refused.
pub fn film(
    env: AnyEnvironment,
    seed: u64,
    play: &Play,
    view: View,
    width: u32,
) -> Result<Vec<RgbImage>, Refused> {
    let mut rng = Seed(seed).stream("random-play", 0);
    match env {
        AnyEnvironment::Vectors(mut env) => {
            let space = env.spec().action.clone();
            shoot(&mut *env, seed, play.steps(), (view, width), |step| match play {
                Play::Actions(actions) => match &actions[step] {
                    Action::Vector(action) => action.clone(),
                    Action::Choice(_) => Vec::new(), // of the wrong kind: will be refused
                },
                Play::Random(_) => random_vector(&space, &mut rng),
            })
        }
        AnyEnvironment::Choices(mut env) => {
            let choices = env.spec().action.choices();
            shoot(&mut *env, seed, play.steps(), (view, width), |step| choice(play, step, choices, &mut rng))
        }
        AnyEnvironment::Frames(mut env) => {
            let choices = env.spec().action.choices();
            shoot(&mut *env, seed, play.steps(), (view, width), |step| choice(play, step, choices, &mut rng))
        }
    }
}

fn choice(play: &Play, step: usize, choices: usize, rng: &mut Rng) -> usize {
    match play {
        Play::Actions(actions) => match &actions[step] {
            Action::Choice(choice) => *choice,
            Action::Vector(_) => choices, // of the wrong kind: will be refused
        },
        Play::Random(_) => rng.random_range(0..choices),
    }
}

fn random_vector(space: &Space, rng: &mut Rng) -> Vector {
    space.dimensions().iter().map(|d| rng.random_range(d.low..=d.high)).collect()
}

fn shoot<O: Clone + Default, A: Clone>(
    env: &mut dyn Domain<O, A>,
    seed: u64,
    steps: u32,
    camera: (View, u32),
    mut act: impl FnMut(usize) -> A,
) -> Result<Vec<RgbImage>, Refused> {
    env.reset(seed);
    let every = steps.div_ceil(FRAMES).max(1);
    let (mut trail, mut frames, mut over) = (Vec::new(), Vec::new(), false);
    for step in 0..=steps {
        let mut drawing = env.drawing();
        if let Drawing::Bodies(scene) = &mut drawing {
            trail.push([scene.focus.x, scene.focus.y]);
            scene.trail.clone_from(&trail);
        }
        if step % every == 0 || over || step == steps {
            frames.push(picture(drawing, camera));
        }
        if over || step == steps {
            break;
        }
        over = env.step(&act(step as usize))?.end.is_some();
    }
    Ok(frames)
}

/// A drawing as a picture so many pixels wide, of bodies from where the camera is; of cells and sprites about so wide.
pub(crate) fn picture(drawing: Drawing, camera: (View, u32)) -> RgbImage {
    match drawing {
        Drawing::Bodies(scene) => frame(&scene, camera),
        Drawing::Pixels(small) => {
            // Whole pixels only, so that they stay squares.
            let [times, width, height] =
                [(camera.1 / small.width().max(1)).max(1), small.width(), small.height()];
            imageops::resize(&small, times * width, times * height, imageops::FilterType::Nearest)
        }
    }
}

fn frame(scene: &Scene, (view, width): (View, u32)) -> RgbImage {
    let (camera, height) = match view {
        View::Above => {
            let Rectangle { low, high } = scene.bounds;
            let shown = Rectangle { low: low.map(|x| x - BORDER), high: high.map(|x| x + BORDER) };
            let size = [0, 1].map(|axis| shown.high[axis] - shown.low[axis]);
            let shape = (size[1] / size[0]).clamp(0.25, 2.0);
            (Camera::above(shown), (f64::from(width) * shape) as u32)
        }
        View::Beside => (Camera::watching(scene), width * 3 / 4),
    };
    let mut frame = RgbImage::new(width, height);
    draw(scene, &camera, &mut frame);
    frame
}
