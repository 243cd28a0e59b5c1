//! What touches what.

use rapier3d::prelude::*;

use super::world::World;

/// Somebody who takes part in a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Party {
    /// The floor.
    Floor,
    /// The walls.
    Walls,
    /// A link of a model.
    Link {
        /// Index of the model.
        model: usize,
        /// Index of the link in it.
        link: usize,
    },
}

/// Two that touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// One of them.
    pub first: Party,
    /// The other.
    pub second: Party,
    /// The force along the normals, summed over all points between these two, N: its mean over the last call.
    pub force: f32,
}

impl Party {
    /// As a collider carries it.
    pub(super) fn tag(self) -> u128 {
        match self {
            Party::Floor => 0,
            Party::Walls => 1,
            Party::Link { model, link } => ((model as u128) << 64) | (link as u128 + 2),
        }
    }

    pub(super) fn of(tag: u128) -> Self {
        match tag {
            0 => Party::Floor,
            1 => Party::Walls,
            _ => Party::Link { model: (tag >> 64) as usize, link: (tag as u64 - 2) as usize },
        }
    }
}

pub(super) fn contacts(world: &World) -> impl Iterator<Item = Contact> + '_ {
    let party = |collider: ColliderHandle| Party::of(world.rapier.colliders[collider].user_data);
    let seconds = world.rapier.integration_parameters.dt;
    world.rapier.contact_pairs().filter(|pair| pair.has_any_active_contact()).map(move |pair| Contact {
        first: party(pair.collider1),
        second: party(pair.collider2),
        force: pair.total_impulse_magnitude() / seconds,
    })
}
