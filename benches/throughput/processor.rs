//! Which processor this is: relative speeds are comparable on the same one only.

use std::fmt::Write;

/// Name and version of the processor, as far as the operating system tells.
pub(crate) fn name() -> String {
    let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let named = of_cpuinfo(&told);
    let unnamed = || format!("unnamed {} on {}", std::env::consts::ARCH, std::env::consts::OS);
    if named.is_empty() { unnamed() } else { named }
}

/// What the first processor of `/proc/cpuinfo` is called: `AMD EPYC, cpu family 26, model 2`.
pub(crate) fn of_cpuinfo(text: &str) -> String {
    let value = |key: &str| {
        text.lines().find_map(|line| {
            let (found, value) = line.split_once(':')?;
            (found.trim() == key).then(|| value.trim())
        })
    };
    let mut name = value("model name").unwrap_or_default().to_owned();
    // The last two are ARM's.
    for key in ["cpu family", "model", "CPU implementer", "CPU part"] {
        if let Some(value) = value(key) {
            let comma = if name.is_empty() { "" } else { ", " };
            let _ = write!(name, "{comma}{key} {value}");
        }
    }
    name
}
