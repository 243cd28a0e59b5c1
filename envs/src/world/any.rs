//! Worlds whose type is forgotten: what the registry holds.

use super::{Annotating, Card, Drawn, Layout, Pictured, ProtoGoals, Question, See, Symbolic};
use crate::certificate::{self, Certificate};
use crate::registry::{AnyAnnotated, AnyEnvironment};
use crate::{Domain, Environment, Render, TimeLimit};
use inroads_sim::raster::{Format, FormatError};

/// How an environment is to be made of a world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    pub(crate) name: &'static str,
    pub(crate) about: &'static str,
    /// `None`: as the world's card has it.
    pub(crate) see: Option<See>,
    /// `None`: as the world's card has it.
    pub(crate) layout: Option<Layout>,
}

/// A world of any type.
pub(crate) trait AnyWorld {
    /// The world as an environment, limited as its card has it.
    fn seen(self: Box<Self>, wanted: &Wanted) -> Result<AnyEnvironment, FormatError>;

    /// What search and random play find out about it.
    fn certify(self: Box<Self>, wanted: &Wanted, options: &certificate::Options) -> Certificate;
}

/// A world with proto-goals, of any type.
pub(crate) trait AnnotatedWorld: AnyWorld {
    /// The same with its proto-goals beside what is seen.
    fn annotated(self: Box<Self>, wanted: &Wanted) -> Result<AnyAnnotated, FormatError>;

    /// What each of its proto-goals asks.
    fn questions(&self) -> Vec<Question>;
}

impl<W: Drawn> AnyWorld for W {
    fn seen(self: Box<Self>, wanted: &Wanted) -> Result<AnyEnvironment, FormatError> {
        let card = self.card();
        Ok(match wanted.see.unwrap_or(card.see) {
            See::Symbols => AnyEnvironment::Choices(limited(symbolic(*self, &card, wanted), &card)),
            See::Pixels(format) => {
                AnyEnvironment::Frames(limited(pictured(*self, &card, wanted, format)?, &card))
            }
        })
    }

    fn certify(self: Box<Self>, wanted: &Wanted, options: &certificate::Options) -> Certificate {
        let layout = wanted.layout.unwrap_or(self.card().layout);
        Certificate { name: wanted.name, ..certificate::world(*self, layout, options) }
    }
}

impl<W: Drawn + ProtoGoals> AnnotatedWorld for W {
    fn annotated(self: Box<Self>, wanted: &Wanted) -> Result<AnyAnnotated, FormatError> {
        let card = self.card();
        Ok(match wanted.see.unwrap_or(card.see) {
            See::Symbols => AnyAnnotated::Vectors(limited(Annotating(symbolic(*self, &card, wanted)), &card)),
            See::Pixels(format) => {
                AnyAnnotated::Frames(limited(Annotating(pictured(*self, &card, wanted, format)?), &card))
            }
        })
    }

    fn questions(&self) -> Vec<Question> {
        (0..).zip(self.proto_goals()).map(|(bit, text)| Question { text, cell: self.cell(bit) }).collect()
    }
}

fn symbolic<W: Drawn>(world: W, card: &Card, wanted: &Wanted) -> Symbolic<W> {
    Symbolic::new(world, wanted.layout.unwrap_or(card.layout)).named(wanted.name, wanted.about)
}

fn pictured<W: Drawn>(
    world: W,
    card: &Card,
    wanted: &Wanted,
    format: Format,
) -> Result<Pictured<W>, FormatError> {
    Ok(Pictured::new(world, wanted.layout.unwrap_or(card.layout), format)?.named(wanted.name, wanted.about))
}

fn limited<E>(env: E, card: &Card) -> Box<dyn Domain<E::Observation, usize>>
where
    E: Environment<Action = usize> + Render + Send + 'static,
{
    match card.limit {
        Some(steps) => Box::new(TimeLimit::new(env, steps)),
        None => Box::new(env),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        check::{self, check},
        world::nine::Nine,
    };
    use inroads_sim::raster::Filter;

    fn wanted(see: Option<See>) -> Wanted {
        Wanted { name: "nine-on-ice", about: "slippery", see, layout: Some(Layout::Fixed(7)) }
    }

    fn nine() -> Box<dyn AnnotatedWorld> {
        Box::new(Nine::new(true))
    }

    #[test]
    fn a_world_becomes_what_is_wanted_of_it_under_the_name_that_it_gets() {
        let sees = [None, Some(See::Symbols), Some(See::Pixels(Format::NATIVE))];
        for (index, see) in sees.into_iter().enumerate() {
            let seen = nine().seen(&wanted(see)).expect("such a format exists");
            assert_eq!((seen.spec().name, seen.spec().about), ("nine-on-ice", "slippery"));
            assert_eq!((seen.spec().time_limit, seen.spec().action.len()), (Some(50), 1));
            let options = check::Options::default();
            match (seen, nine().annotated(&wanted(see)).expect("it has proto-goals"), index) {
                (AnyEnvironment::Choices(mut env), AnyAnnotated::Vectors(mut annotated), 0 | 1) => {
                    assert_eq!(env.spec(), annotated.spec());
                    check(&mut env, options).and_then(|()| check(&mut annotated, options)).unwrap();
                }
                (AnyEnvironment::Frames(mut env), AnyAnnotated::Frames(mut annotated), 2) => {
                    assert_eq!(env.spec(), annotated.spec());
                    check(&mut env, options).and_then(|()| check(&mut annotated, options)).unwrap();
                }
                _ => panic!("{see:?} is seen in another way"),
            }
        }
        let none = See::Pixels(Format { scale: Some(([0, 1], Filter::Area)), ..Format::NATIVE });
        assert!(nine().seen(&wanted(Some(none))).is_err() && nine().annotated(&wanted(Some(none))).is_err());
        assert_eq!(nine().questions().len(), 9);
    }

    #[test]
    fn a_certificate_bears_the_name_and_the_layout_that_were_asked_for() {
        let options = certificate::Options { episodes: 10, ..Default::default() };
        let found = nine().certify(&wanted(None), &options);
        assert_eq!((found.name, found.layout), ("nine-on-ice", Some(Layout::Fixed(7))));
        assert!(found.search.is_some_and(|search| search.layouts.len() == 1 && search.lucky));
    }
}
