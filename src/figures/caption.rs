//! What stands below the charts of a picture: who is who, and what line and band are.

use super::chart::{Panel, Series};
use super::legend::{Entry, Mark};
use super::palette::colour;

/// Each pair of mark and name once, in order of appearance.
pub(super) fn entries(panels: &[Panel]) -> Vec<Entry> {
    let banded = panels.iter().flat_map(|panel| &panel.series).any(|series| series.runs.len() > 1);
    let mark = if banded { Mark::Curve } else { Mark::Line };
    let series = panels.iter().flat_map(|panel| &panel.series);
    let series = series.map(|series| Entry::new(mark(colour(series.colour)), series.label.clone()));
    let levels = panels.iter().flat_map(|panel| panel.levels.iter().enumerate());
    let levels = levels.map(|(index, level)| Entry::new(Mark::Level(index), level.label.clone()));
    let mut entries: Vec<Entry> = Vec::new();
    for entry in series.chain(levels) {
        if !entries.contains(&entry) {
            entries.push(entry);
        }
    }
    entries
}

/// What the marks are, in words; panel by panel where the panels differ.
pub(super) fn note(panels: &[Panel]) -> String {
    let seeds = |series: &Series| series.runs.iter().filter(|run| !run.is_empty()).count();
    let counts = panels.iter().flat_map(|panel| &panel.series).map(seeds).filter(|count| *count > 0);
    let (Some(low), Some(high)) = (counts.clone().min(), counts.max()) else {
        return "no data yet".to_owned();
    };
    let words = |panel: &Panel| {
        let summary = if high > 1 { panel.summary.caption() } else { "no band" };
        match panel.smoothing {
            0 | 1 => summary.to_owned(),
            window => format!("{summary}, each seed averaged over {window} points"),
        }
    };
    let drawn: Vec<&Panel> = panels.iter().filter(|panel| !panel.series.is_empty()).collect();
    let by_axis = meanings(&drawn, words, |panel| &panel.y_label);
    let mut names: Vec<&str> = by_axis.iter().flat_map(|(_, names)| names.clone()).collect();
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    let meanings = if names.len() == count { by_axis } else { meanings(&drawn, words, |panel| &panel.title) };
    let sentence = |(words, names): &(String, Vec<&str>)| match meanings.len() {
        1 => words.clone(),
        _ => format!("{}: {words}", names.join(", ")),
    };
    let meaning = meanings.iter().map(sentence).collect::<Vec<_>>().join(" · ");
    let seeds = match (low, high) {
        (_, 1) => "one seed".to_owned(),
        _ if low == high => format!("{low} seeds, each a thin line"),
        _ => format!("{low} to {high} seeds, each a thin line"),
    };
    format!("{seeds} · {meaning}")
}

/// What panels mean, each meaning once, with the names of its panels.
fn meanings<'a>(
    panels: &[&'a Panel],
    words: impl Fn(&Panel) -> String,
    name: impl Fn(&'a Panel) -> &'a str,
) -> Vec<(String, Vec<&'a str>)> {
    let mut meanings: Vec<(String, Vec<&str>)> = Vec::new();
    for &panel in panels {
        let (words, name) = (words(panel), name(panel));
        match meanings.iter_mut().find(|(known, _)| *known == words) {
            Some((_, names)) if names.contains(&name) => {}
            Some((_, names)) => names.push(name),
            None => meanings.push((words, vec![name])),
        }
    }
    meanings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::Summary;

    fn panel(y_label: &str, summary: Summary, seeds: usize) -> Panel {
        let series = Series { label: "DSC".into(), colour: 1, runs: vec![vec![(0.0, 0.0)]; seeds] };
        Panel {
            title: format!("about {y_label}"),
            y_label: y_label.into(),
            summary,
            series: vec![series],
            ..Panel::default()
        }
    }

    #[test]
    fn the_note_says_each_thing_once() {
        use Summary::{MeanAndInterval, MedianAndRange};
        let median = "bold = median, band = worst to best seed";
        let mean = "bold = mean, band = 95 % t-interval of the mean";
        let (a, b) = (panel("return", MedianAndRange, 5), panel("success", MeanAndInterval, 3));
        assert_eq!(note(&[a.clone(), a.clone()]), format!("5 seeds, each a thin line · {median}"));
        let both = format!("3 to 5 seeds, each a thin line · return: {median} · success: {mean}");
        assert_eq!(note(&[a.clone(), b.clone(), Panel::default()]), both);
        let smooth = Panel { title: "smooth".into(), smoothing: 9, ..a.clone() };
        let titled = "5 seeds, each a thin line · about return: ";
        let more = format!("{titled}{median} · smooth: {median}, each seed averaged over 9 points");
        assert_eq!(note(&[a.clone(), smooth]), more);
        assert_eq!(note(&[panel("return", MedianAndRange, 1)]), "one seed · no band");
        assert_eq!(note(&[Panel::default()]), "no data yet");
        assert_eq!(entries(&[a, b]).len(), 1);
    }
}
