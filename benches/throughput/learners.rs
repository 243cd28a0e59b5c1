//! What a learner costs: DDPG, and beside it the matrix products that it cannot do without; TD3.

use std::{cell::RefCell, hint::black_box, rc::Rc, sync::Arc};

use burn::tensor::{Device, Tensor, TensorData};
use inroads::{
    agents::{
        Clip, Context, Encoder, Learner, Memory,
        ddpg::{Ddpg, DdpgConfig},
        encode::{Scaled, Select},
        experience::Rewards,
        nets::Backend,
        td3::{Td3, Td3Config},
    },
    envs::{Seed, registry},
};
use rand::RngExt;

use crate::workload::Workload;

/// What an update of DDPG is called; its products alone have [`ALONE`] behind it.
pub(crate) const UPDATE: &str = "agents/ddpg/update";
/// Behind the name of what is measured without anything around it.
pub(crate) const ALONE: &str = ", products alone";

/// DDPG of the paper's size (400-300, batch 64) on the Point-Maze's observations.
pub(crate) fn ddpg() -> Vec<Workload> {
    let spec = registry::make("point-maze").expect("it is in the registry").spec().clone();
    let encoder = Arc::new(Scaled::new(&spec.observation));
    let inputs = Encoder::<Vec<f32>>::width(&*encoder);
    let config = DdpgConfig::default();
    let mut rng = Seed(0).stream("bench", 1);
    let learner: Ddpg<Vec<f32>> = Ddpg::new(encoder, 2, &config, Backend::Flex, &mut rng);
    let observations: Vec<Vec<f32>> =
        (0..=config.batch).map(|_| (0..6).map(|_| rng.random_range(-1.0..1.0)).collect()).collect();
    let actions: Vec<Vec<f32>> =
        (0..config.batch).map(|_| vec![rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)]).collect();
    // One learner acts and learns.
    let learner = Rc::new(RefCell::new((learner, Context::training(Seed(0), 0))));
    let acting = {
        let (learner, observation, mut memory) =
            (Rc::clone(&learner), observations[0].clone(), Memory::new());
        Workload::repeated("agents/ddpg/act", move || {
            let (learner, ctx) = &mut *learner.borrow_mut();
            black_box(learner.act(&mut memory, &observation, None::<&()>, ctx));
        })
    };
    let update = Workload::repeated(UPDATE, move || {
        let (learner, ctx) = &mut *learner.borrow_mut();
        let clips: Vec<Clip<Vec<f32>, Vec<f32>, ()>> = (0..actions.len())
            .map(|i| {
                let (states, acts) = (&observations[i..=i + 1], &actions[i..=i]);
                Clip::new(states, acts, Rewards::Given(&[-1.0]), None, false)
            })
            .collect();
        black_box(learner.learn(&clips, ctx));
    });
    let products = Products::of_update(config.batch, inputs, 2, config.hidden[0], config.hidden[1]);
    let alone = Workload::repeated(&format!("{UPDATE}{ALONE}"), move || products.compute());
    let row = Products::of_acting(inputs, 2, config.hidden[0], config.hidden[1]);
    let row = Workload::repeated("agents/ddpg/act, products alone", move || row.compute());
    vec![acting, update, alone, row]
}

/// TD3 of its authors' size (256-256, batch 256) for an ant: 31 numbers seen (goal included), 8 done. One update in two is of
/// the actor and the targets too.
pub(crate) fn td3() -> Vec<Workload> {
    const SEEN: usize = 31;
    let config = Td3Config::default();
    let mut rng = Seed(0).stream("bench", 2);
    let encoder = Arc::new(Select::new(&(0..SEEN).collect::<Vec<_>>()));
    let mut learner: Td3<Vec<f32>> = Td3::new(encoder, 0, 8, &config, Backend::Flex, &mut rng);
    let mut rows = |n: usize, width: usize| -> Vec<Vec<f32>> {
        (0..n).map(|_| (0..width).map(|_| rng.random_range(-1.0..1.0)).collect()).collect()
    };
    let (observations, actions) = (rows(config.batch + 1, SEEN), rows(config.batch, 8));
    let clips = move |observations: &[Vec<f32>], actions: &[Vec<f32>], learner: &mut Td3<Vec<f32>>| {
        let mut ctx = Context::training(Seed(0), 0);
        let clips: Vec<Clip<Vec<f32>, Vec<f32>, ()>> = (0..actions.len())
            .map(|i| {
                let (states, acts) = (&observations[i..=i + 1], &actions[i..=i]);
                Clip::new(states, acts, Rewards::Given(&[-1.0]), None, false)
            })
            .collect();
        black_box(learner.learn(&clips, &mut ctx));
    };
    // Before its first update it would act without its network.
    clips(&observations, &actions, &mut learner);
    let acting = {
        let (learner, observation, mut memory) = (learner.clone(), observations[0].clone(), Memory::new());
        let mut ctx = Context::training(Seed(0), 0);
        Workload::repeated("agents/td3/act", move || {
            black_box(learner.act(&mut memory, &observation, None::<&()>, &mut ctx));
        })
    };
    let update = Workload::repeated("agents/td3/update", move || {
        clips(&observations, &actions, &mut learner);
    });
    vec![acting, update]
}

/// Matrix products on the backend of the learners, without anything around them.
struct Products(Vec<(Tensor<2>, Tensor<2>)>);

impl Products {
    /// Products of `[m, k]` and `[k, n]`.
    fn new(shapes: Vec<[usize; 3]>) -> Self {
        let device = Device::flex();
        let matrix = |rows: usize, columns: usize| {
            let values: Vec<f32> = (0..rows * columns).map(|i| (i % 17) as f32 / 17.0 - 0.5).collect();
            Tensor::<2>::from_data(TensorData::new(values, [rows, columns]), &device)
        };
        Self(shapes.into_iter().map(|[m, k, n]| (matrix(m, k), matrix(k, n))).collect())
    }

    fn of_acting(inputs: usize, actions: usize, first: usize, second: usize) -> Self {
        Self::new(vec![[1, inputs, first], [1, first, second], [1, second, actions]])
    }

    /// Every product of an update. The action enters the critic at its second layer, by weights of its own, so the
    /// actor's pass goes back through that layer's action weights only.
    fn of_update(batch: usize, inputs: usize, actions: usize, first: usize, second: usize) -> Self {
        let actor = [[batch, inputs, first], [batch, first, second], [batch, second, actions]];
        let into_second = [batch, actions, second];
        let critic = [[batch, inputs, first], [batch, first, second], into_second, [batch, second, 1]];
        let weights = |[m, k, n]: [usize; 3]| [k, m, n];
        let entering = |[m, k, n]: [usize; 3]| [m, n, k];
        let mut shapes = Vec::new();
        shapes.extend(actor); // target actor
        shapes.extend(critic); // target critic
        shapes.extend(critic); // critic forth
        shapes.extend(critic.map(weights));
        shapes.extend([critic[1], critic[3]].map(entering)); // nothing before the first layer learns
        shapes.extend(actor); // actor forth
        shapes.extend(critic); // and through the critic
        shapes.extend([critic[3], into_second].map(entering)); // back to the action
        shapes.extend(actor.map(weights));
        shapes.extend([actor[1], actor[2]].map(entering));
        Self::new(shapes)
    }

    fn compute(&self) {
        for (a, b) in &self.0 {
            black_box(a.clone().matmul(b.clone()));
        }
    }
}
