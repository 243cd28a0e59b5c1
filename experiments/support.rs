//! What all experiments share.

use std::{error::Error, fs, sync::Mutex, thread};

use serde::Serialize;
use serde_json::Value;

use crate::Options;

/// What an experiment returns.
pub(crate) type Done = Result<(), Box<dyn Error>>;

/// The results of `run` for the seeds 0 to `seeds` − 1, in their order. Two seeds run at a time.
pub(crate) fn over_seeds<T: Send>(seeds: u64, run: impl Fn(u64) -> T + Sync) -> Vec<T> {
    let (next, results) = (Mutex::new(0), Mutex::new(Vec::new()));
    let work = || {
        loop {
            let seed = {
                let mut next = next.lock().expect("nobody panics with the lock");
                *next += 1;
                *next - 1
            };
            if seed >= seeds {
                return;
            }
            let result = run(seed);
            results.lock().expect("nobody panics with the lock").push((seed, result));
        }
    };
    thread::scope(|scope| (0..2).for_each(|_| _ = scope.spawn(work)));
    let mut results = results.into_inner().expect("nobody panics with the lock");
    results.sort_by_key(|(seed, _)| *seed);
    results.into_iter().map(|(_, result)| result).collect()
}

/// Writes a result as `NAME.json`: each of its parts on a line of its own, numbers with four decimals.
pub(crate) fn write(options: &Options, name: &str, result: &impl Serialize) -> Done {
    fs::create_dir_all(&options.out)?;
    let path = options.out.join(format!("{name}.json"));
    fs::write(&path, lines(&rounded(serde_json::to_value(result)?)))?;
    println!("wrote {}", path.display());
    Ok(())
}

/// The parts of a table or list, one a line.
fn lines(value: &Value) -> String {
    match value {
        Value::Object(parts) => {
            let parts = parts.iter().map(|(key, part)| format!("  {}: {part}", Value::from(key.as_str())));
            format!("{{\n{}\n}}\n", parts.collect::<Vec<_>>().join(",\n"))
        }
        Value::Array(parts) => {
            let parts = parts.iter().map(|part| format!("  {part}"));
            format!("[\n{}\n]\n", parts.collect::<Vec<_>>().join(",\n"))
        }
        plain => format!("{plain}\n"),
    }
}

/// The same with four decimals; what would be 0 then stays as it is.
fn rounded(value: Value) -> Value {
    match value {
        Value::Number(number) if number.is_f64() => {
            let x = number.as_f64().unwrap_or(f64::NAN);
            let short = (x * 1e4).round() / 1e4;
            if short == 0.0 { Value::Number(number) } else { Value::from(short) }
        }
        Value::Array(parts) => parts.into_iter().map(rounded).collect(),
        Value::Object(parts) => parts.into_iter().map(|(key, part)| (key, rounded(part))).collect(),
        plain => plain,
    }
}
