//! Saving what was learned: a bag of named bytes.
//!
//! Configuration builds an object, a bag restores its learned state. So nothing with a tensor or a trait
//! object derives serde, and renaming a setting does not make old checkpoints unreadable.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize, de::DeserializeOwned};

/// Named bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bag {
    parts: BTreeMap<String, Vec<u8>>,
}

/// A bag that does not hold what the object needs.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Corrupt {
    /// A part is not there.
    #[error("the checkpoint has no part `{0}`; it was written by another agent or version")]
    Missing(String),
    /// A part cannot be read.
    #[error("part `{part}` of the checkpoint cannot be read: {why}")]
    Unreadable {
        /// Which part.
        part: String,
        /// What is wrong with it.
        why: String,
    },
}

impl Bag {
    /// Puts a plain value in under a name.
    ///
    /// # Panics
    /// When the value cannot be encoded, which no type of ours can bring about.
    pub fn put<T: Serialize + ?Sized>(&mut self, name: &str, value: &T) {
        let bytes = postcard::to_stdvec(value).expect("plain data always encodes");
        self.parts.insert(name.to_owned(), bytes);
    }

    /// Takes a plain value out.
    ///
    /// # Errors
    /// [`Corrupt`] names the part.
    pub fn get<T: DeserializeOwned>(&self, name: &str) -> Result<T, Corrupt> {
        let bytes = self.parts.get(name).ok_or_else(|| Corrupt::Missing(name.to_owned()))?;
        postcard::from_bytes(bytes)
            .map_err(|error| Corrupt::Unreadable { part: name.to_owned(), why: error.to_string() })
    }

    /// Puts a part with parts of its own in.
    pub fn put_part(&mut self, name: &str, part: &(impl Checkpoint + ?Sized)) {
        let mut bag = Self::default();
        part.save(&mut bag);
        self.put(name, &bag);
    }

    /// Restores a part with parts of its own.
    ///
    /// # Errors
    /// [`Corrupt`] names the part.
    pub fn get_part(&self, name: &str, part: &mut (impl Checkpoint + ?Sized)) -> Result<(), Corrupt> {
        part.load(&self.get::<Self>(name)?)
    }
}

/// State that can be saved between episodes and restored into an object built from the same configuration.
pub trait Checkpoint {
    /// Puts all learned state into the bag.
    fn save(&self, bag: &mut Bag);

    /// Replaces all learned state by the bag's.
    ///
    /// # Errors
    /// [`Corrupt`] when the bag lacks something; the object may be half restored then and must be dropped.
    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt>;
}

/// Implements [`Checkpoint`] for a type by listing its fields: `plain` ones go through serde, `parts` have
/// checkpoints of their own.
#[macro_export]
macro_rules! checkpoint {
    ([$($generics:tt)*] $type:ty; plain: $($plain:ident),*; parts: $($part:ident),* $(; where $($bounds:tt)*)?) => {
        impl<$($generics)*> $crate::Checkpoint for $type $(where $($bounds)*)? {
            fn save(&self, bag: &mut $crate::Bag) {
                $(bag.put(stringify!($plain), &self.$plain);)*
                $(bag.put_part(stringify!($part), &self.$part);)*
                let _ = bag;
            }

            fn load(&mut self, bag: &$crate::Bag) -> Result<(), $crate::Corrupt> {
                $(self.$plain = bag.get(stringify!($plain))?;)*
                $(bag.get_part(stringify!($part), &mut self.$part)?;)*
                let _ = bag;
                Ok(())
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, Default, PartialEq)]
    struct Inner {
        count: u64,
    }
    checkpoint!([] Inner; plain: count; parts: );

    #[derive(Debug, Default, PartialEq)]
    struct Outer {
        name: String,
        inner: Inner,
    }
    checkpoint!([] Outer; plain: name; parts: inner);

    #[test]
    fn a_bag_restores_what_was_saved_and_names_what_is_missing() {
        let saved = Outer { name: "a".into(), inner: Inner { count: 3 } };
        let mut bag = Bag::default();
        saved.save(&mut bag);
        let mut restored = Outer::default();
        restored.load(&bag).unwrap();
        assert_eq!(restored, saved);

        let error = restored.load(&Bag::default()).unwrap_err();
        assert_eq!(error, Corrupt::Missing("name".into()));
        let mut wrong = Bag::default();
        wrong.put("name", &1u8);
        assert!(matches!(restored.load(&wrong), Err(Corrupt::Unreadable { part, .. }) if part == "name"));
    }
}
