//! Networks on Burn: rows of numbers in, rows of numbers out.
//!
//! Burn is named in this folder only. Learners see [`Backend`] and one struct of networks each, `ActorCritic`,
//! `DeepQ`, `QNetwork`, `RecurrentNet` and `ProbabilityNet`, which know how to act and how to make one step, but not towards
//! what.
//!
//! Modules live on a plain device, so that acting records no graph; learning makes a tracked clone of them,
//! drops it after the backward pass, and then nothing else holds the numbers and they change in place.

mod actor_critic;
mod adam;
mod convolution;
mod deep_q;
mod device;
mod dueling;
mod init;
mod lstm;
mod mlp;
mod noisy;
mod probability;
mod q_network;
mod recurrent;
mod regression;
mod regressor;
mod squash;
mod target;
mod torso;

pub(crate) use actor_critic::{ActorCritic, Batch, Shape};
pub(crate) use adam::Step;
pub(crate) use deep_q::{Asked, DeepQ};
pub use device::{Backend, NoBackend};
pub(crate) use dueling::{HeadParts, HeadShape};
pub(crate) use lstm::State;
pub(crate) use noisy::head_noise;
pub(crate) use probability::ProbabilityNet;
pub(crate) use q_network::QNetwork;
pub(crate) use recurrent::{RecurrentNet, RecurrentShape, Steps};
pub(crate) use regression::Regression;
pub(crate) use regressor::{Layers, Regressor};
pub use torso::{TorsoConfig, Vision};

use std::mem::take;

use burn::module::{Module, ModuleMapper, ModuleVisitor, Param};
use burn::tensor::{Device, Tensor, TensorData};

use crate::{Bag, Corrupt};

/// A matrix of rows of `width` numbers.
fn rows(values: Vec<f32>, width: usize, device: &Device) -> Tensor<2> {
    let n = values.len() / width;
    Tensor::from_data(TensorData::new(values, [n, width]), device)
}

/// A tensor's numbers, without a copy where nothing else holds them.
fn floats<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor.into_data().try_into_vec().expect("our tensors are f32")
}

/// A parameter with its numbers changed, in place where nothing else holds them.
fn edit<const D: usize>(param: Param<Tensor<D>>, change: impl FnOnce(&mut [f32])) -> Param<Tensor<D>> {
    let (id, tensor, mapper) = param.consume();
    let device = tensor.device();
    let mut data = tensor.into_data();
    change(data.as_mut_slice().expect("our tensors are f32"));
    Param::from_mapped_value(id, Tensor::from_data(data, &device), mapper)
}

/// The numbers of a module's parameters, in the module's own order.
fn values<M: Module>(module: &M) -> Vec<Vec<f32>> {
    let mut out = Out(Vec::new());
    module.visit(&mut out);
    out.0
}

struct Out(Vec<Vec<f32>>);

impl ModuleVisitor for Out {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        self.0.push(floats(param.val()));
    }
}

/// Gives a module the numbers of a part of a checkpoint, of which there must be as many as it has.
fn load_values<M: Module + Default>(module: &mut M, part: &str, bag: &Bag) -> Result<(), Corrupt> {
    let values: Vec<Vec<f32>> = bag.get(part)?;
    let mut lengths = Lengths(Vec::new());
    module.visit(&mut lengths);
    let found: Vec<_> = values.iter().map(Vec::len).collect();
    if found != lengths.0 {
        let why = format!("its layers have {found:?} numbers where this configuration has {:?}", lengths.0);
        return Err(Corrupt::Unreadable { part: part.to_owned(), why });
    }
    *module = take(module).map(&mut In(values.into_iter()));
    Ok(())
}

struct Lengths(Vec<usize>);

impl ModuleVisitor for Lengths {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        self.0.push(param.lazy_shape().num_elements());
    }
}

struct In(std::vec::IntoIter<Vec<f32>>);

impl ModuleMapper for In {
    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        let next = self.0.next();
        edit(param, |values| values.copy_from_slice(&next.expect("lengths were compared")))
    }
}
