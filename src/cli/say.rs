//! What commands print on the standard output.

use std::{
    fmt,
    io::{self, ErrorKind, Write},
    process,
};

/// Prints a line, as `println!` does, in every command.
macro_rules! say {
    ($($text:tt)*) => { $crate::cli::say::line(format_args!($($text)*)) };
}
pub(super) use say;

/// Prints a line.
///
/// Whoever reads may stop when it has seen enough (`inroads goals RUN | head`): the rest is told to nobody, and the command
/// goes on to its end, for it may have more to do than to print. Where nothing can be written for another reason, such as a
/// full disk, it ends with exit code 1.
pub(super) fn line(text: fmt::Arguments<'_>) {
    match writeln!(io::stdout().lock(), "{text}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            eprintln!("inroads: cannot write to the standard output: {error}");
            process::exit(1)
        }
        _ => {}
    }
}
