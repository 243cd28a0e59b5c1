//! Targets that follow a network slowly: θ' ← τθ + (1−τ)θ' (DDPG, Lillicrap 2015).

use std::mem::take;

use burn::module::{Module, ModuleMapper, ModuleVisitor, Param};
use burn::optim::GradientsParams;
use burn::tensor::Tensor;

use super::edit;

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
        let online = self.online.remove::<D>(param.id).expect("the target is a clone").into_data();
        let online: &[f32] = online.as_slice().expect("our tensors are f32");
        let (tau, rest) = (self.tau, 1.0 - self.tau);
        edit(param, |target| target.iter_mut().zip(online).for_each(|(t, o)| *t = *t * rest + o * tau))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nets::mlp::Mlp;
    use crate::nets::{Backend, values};
    use inroads_envs::Seed;

    struct Add(f32);

    impl ModuleMapper for Add {
        fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
            edit(param, |values| values.iter_mut().for_each(|value| *value += self.0))
        }
    }

    #[test]
    fn it_goes_by_tau_of_the_way_and_leaves_the_online_network_alone() {
        let device = Backend::of_tests().plain();
        let mut target = Mlp::new(3, &[5, 4], 2, 0.1, &device, &mut Seed(0).stream("weights", 0));
        let online = target.clone().map(&mut Add(1.0));
        let (before, goal) = (values(&target), values(&online));
        follow(&mut target, &online, 0.005);
        assert_eq!(values(&online), goal);
        for (new, old) in values(&target).iter().flatten().zip(before.iter().flatten()) {
            assert!((new - (old + 0.005)).abs() < 1e-6, "{new} {old}");
        }
        follow(&mut target, &online, 1.0);
        assert_eq!(values(&target), goal);
    }
}
