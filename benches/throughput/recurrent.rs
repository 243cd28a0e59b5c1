//! What R2D2 costs on frames: an update on 32 sequences of 40 steps, and a step of 16 environments at once.

use std::{cell::RefCell, hint::black_box, rc::Rc, sync::Arc};

use inroads::{
    agents::{
        Clip, Context, Lane, Learner, Memory,
        encode::Patches,
        experience::Rewards,
        nets::Backend,
        r2d2::{R2d2, R2d2Config},
    },
    envs::{
        Environment, Frame, Seed,
        registry::{self, AnyEnvironment, Options},
        world::See,
    },
    sim::raster::Format,
};
use rand::RngExt;

use crate::workload::Workload;

/// Steps of a sequence, sequences an update, environments that are acted in together.
const STEPS: usize = 40;
const SEQUENCES: usize = 32;
const LANES: usize = 16;

/// R2D2 of the default size (LSTM 128, the default torso) on DoorKey-8x8 as MiniGrid draws it with tiles of 8 pixels,
/// 64 × 64 × 3.
pub(crate) fn r2d2() -> Vec<Workload> {
    let see = Some(See::Pixels(Format::NATIVE));
    let Ok(AnyEnvironment::Frames(mut env)) =
        registry::make_with("door-key-8x8", &Options { see, ..Options::default() })
    else {
        unreachable!("a grid can be seen as pixels")
    };
    let (space, choices) = (env.spec().observation.clone(), env.spec().action.choices());
    let encoder = Arc::new(Patches::new(&space, 0).expect("frames are cut into tiles"));
    let mut rng = Seed(0).stream("bench", 2);
    let learner: R2d2<Frame> = R2d2::new(encoder, choices, &R2d2Config::default(), Backend::Flex, &mut rng);
    let learner = Rc::new(RefCell::new(learner));

    // Random walks, each in a layout of its own; episodes are longer than sequences.
    let walks: Rc<Vec<(Vec<Frame>, Vec<usize>)>> = Rc::new(
        (0..SEQUENCES as u64)
            .map(|seed| {
                env.reset(seed);
                let actions: Vec<usize> = (0..STEPS).map(|_| rng.random_range(0..choices)).collect();
                let mut frames = vec![Frame::default(); STEPS + 1];
                env.observe(&mut frames[0]);
                for (action, frame) in actions.iter().zip(&mut frames[1..]) {
                    env.step(action).expect("the choice is legal, and no walk is over so soon");
                    env.observe(frame);
                }
                (frames, actions)
            })
            .collect(),
    );
    let acting = {
        let (learner, walks) = (Rc::clone(&learner), Rc::clone(&walks));
        let mut memories = vec![Memory::new(); LANES];
        let mut contexts: Vec<_> = (0..LANES as u64).map(|i| Context::evaluation(Seed(0), i)).collect();
        let name = format!("agents/r2d2/act-{LANES}");
        Workload::repeated(&name, move || {
            let states = memories.iter_mut().zip(&mut contexts).zip(walks.iter());
            let mut lanes: Vec<Lane<'_, Frame, ()>> = states
                .map(|((memory, ctx), (frames, _))| Lane { memory, s: &frames[0], goal: None, ctx })
                .collect();
            black_box(learner.borrow().act_all(&mut lanes));
        })
    };
    let update = Workload::repeated("agents/r2d2/update", move || {
        let clips: Vec<Clip<Frame, usize, ()>> = walks
            .iter()
            .map(|(frames, actions)| Clip::new(frames, actions, Rewards::Given(&[0.0; STEPS]), None, false))
            .collect();
        black_box(learner.borrow_mut().learn(&clips, &mut Context::training(Seed(0), 0)));
    });
    vec![acting, update]
}
