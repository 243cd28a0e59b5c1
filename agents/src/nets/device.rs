//! Which of Burn's backends computes, as a value that a configuration can name.

use std::{fmt, str::FromStr};

use burn::tensor::Device;
use serde::{Deserialize, Serialize};

/// A backend of Burn. Only those that were compiled in can be named, so a `Backend` always works.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Backend {
    /// Burn's own CPU backend.
    #[default]
    Flex,
    /// The older CPU backend on `ndarray`, deprecated by Burn since 0.22; behind the feature of the same name.
    #[cfg(feature = "ndarray")]
    NdArray,
}

/// A backend that is not there.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoBackend {
    /// Known, but not compiled in.
    #[error("backend `{0}` is not compiled in; build with `--features {0}`, or use `flex`")]
    NotCompiled(String),
    /// Not known.
    #[error("there is no backend `{0}`; use `flex` or `ndarray`")]
    Unknown(String),
}

impl Backend {
    /// Its name in configurations.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flex => "flex",
            #[cfg(feature = "ndarray")]
            Self::NdArray => "ndarray",
        }
    }

    /// The backend that the learners' tests run on: that of the variable `INROADS_BACKEND`, the default without it.
    #[cfg(test)]
    pub(crate) fn of_tests() -> Self {
        std::env::var("INROADS_BACKEND")
            .map_or_else(|_| Self::default(), |name| name.parse().expect("a backend"))
    }

    /// The device that computes without recording a graph.
    pub(crate) fn plain(self) -> Device {
        keep_freed_memory();
        match self {
            Self::Flex => Device::flex(),
            #[cfg(feature = "ndarray")]
            #[allow(deprecated)]
            // the one place that names it; deleting the feature deletes this arm
            Self::NdArray => Device::ndarray(),
        }
    }
}

/// Has the allocator keep what is freed, for the next update needs the same again.
///
/// Each update makes and frees gradients of megabytes, which glibc hands back to the kernel each time: 15 % of
/// a DDPG update at 400-300 went to page faults. It hands back only what exceeds twice the largest block that
/// was ever freed (up to 32 MiB, mallopt(3), M_MMAP_THRESHOLD), so one such block, never touched, is freed.
fn keep_freed_memory() {
    #[cfg(target_env = "gnu")]
    {
        static ONCE: std::sync::Once = std::sync::Once::new();
        ONCE.call_once(|| drop(std::hint::black_box(Vec::<u8>::with_capacity(31 << 20))));
    }
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Backend {
    type Err = NoBackend;

    fn from_str(name: &str) -> Result<Self, NoBackend> {
        match name {
            "flex" => Ok(Self::Flex),
            #[cfg(feature = "ndarray")]
            "ndarray" => Ok(Self::NdArray),
            #[cfg(not(feature = "ndarray"))]
            "ndarray" => Err(NoBackend::NotCompiled(name.to_owned())),
            _ => Err(NoBackend::Unknown(name.to_owned())),
        }
    }
}

impl TryFrom<String> for Backend {
    type Error = NoBackend;

    fn try_from(name: String) -> Result<Self, NoBackend> {
        name.parse()
    }
}

impl From<Backend> for String {
    fn from(backend: Backend) -> Self {
        backend.name().to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_backend_is_named_and_an_absent_one_is_refused_with_the_fix() {
        assert_eq!("flex".parse(), Ok(Backend::Flex));
        assert_eq!(serde_json::to_string(&Backend::default()).unwrap(), "\"flex\"");
        assert_eq!(serde_json::from_str::<Backend>("\"flex\"").unwrap(), Backend::Flex);
        assert!("cuda".parse::<Backend>().unwrap_err().to_string().contains("flex"));
        #[cfg(not(feature = "ndarray"))]
        assert!("ndarray".parse::<Backend>().unwrap_err().to_string().contains("--features ndarray"));
        #[cfg(feature = "ndarray")]
        assert_eq!("ndarray".parse(), Ok(Backend::NdArray));
    }
}
