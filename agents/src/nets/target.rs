//! Targets that follow a network slowly: θ' ← τθ + (1−τ)θ' (DDPG, Lillicrap 2015).

use std::mem::take;

use burn::module::{Module, ModuleMapper, ModuleVisitor, Param};
use burn::optim::GradientsParams;
use burn::tensor::Tensor;

/// One step of size `tau` of the target towards the online network, of which it once was a clone.
pub(crate) fn follow<M: Module + Default>(target: &mut M, online: &M, tau: f32) {
    let mut values = Collect(GradientsParams::new());
    online.visit(&mut values);
    *target = take(target).map(&mut Towards { online: values.0, tau });
}

/// Tensors of all ranks by the identity of their parameter, which a clone keeps: Burn's container of
/// gradients is one of parameters too.
struct Collect(GradientsParams);

impl ModuleVisitor for Collect {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        self.0.register(param.id, param.val());
    }
}

struct Towards {
    online: GradientsParams,
    tau: f32,
}

impl ModuleMapper for Towards {
    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        let online = self.online.remove::<D>(param.id).expect("the target is a clone");
        param.map(|target| target * (1.0 - self.tau) + online * self.tau)
    }
}
