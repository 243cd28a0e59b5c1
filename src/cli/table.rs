//! Tables on the standard output.

use super::say::say;

/// Prints rows in columns as wide as they need; a column without words below its head is left out.
pub(super) fn table(rows: Vec<Vec<String>>) {
    let columns = rows.first().map_or(0, Vec::len);
    let wide = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let told = |column: &usize| rows.iter().skip(1).any(|row| !row[*column].is_empty());
    let shown: Vec<(usize, usize)> = (0..columns).filter(told).map(|column| (column, wide(column))).collect();
    for row in &rows {
        let cells: Vec<_> = shown.iter().map(|&(column, wide)| format!("{:<wide$}", row[column])).collect();
        say!("{}", format!("  {}", cells.join("   ")).trim_end());
    }
}
