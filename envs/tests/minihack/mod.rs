//! MiniHack's records, and how they are compared.

pub(crate) mod lines;
pub(crate) mod record;
pub(crate) mod replay;
