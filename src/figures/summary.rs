//! Many seeds as one line and a band.

/// What the bold line and the band of a panel show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Summary {
    /// Median of the seeds, band from the worst to the best seed: for returns, as in the thesis' figure 3.1.
    #[default]
    MedianAndRange,
    /// Mean of the seeds, band = 95 % t-interval of the mean: for shares such as success rates.
    MeanAndInterval,
}

impl Summary {
    /// What the picture's caption says of it.
    pub(super) fn caption(self) -> &'static str {
        match self {
            Self::MedianAndRange => "bold = median, band = worst to best seed",
            Self::MeanAndInterval => "bold = mean, band = 95 % t-interval of the mean",
        }
    }

    /// Centre and band of the values of all seeds at one place; no band for one seed.
    fn of(self, values: &mut [f64]) -> (f64, Option<(f64, f64)>) {
        values.sort_by(f64::total_cmp);
        let count = values.len();
        match self {
            Self::MedianAndRange => {
                let median = f64::midpoint(values[(count - 1) / 2], values[count / 2]);
                (median, (count > 1).then(|| (values[0], values[count - 1])))
            }
            Self::MeanAndInterval => {
                let mean = values.iter().sum::<f64>() / count as f64;
                if count < 2 {
                    return (mean, None);
                }
                let spread =
                    values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1) as f64;
                let half = t_quantile(count - 1) * (spread / count as f64).sqrt();
                (mean, Some((mean - half, mean + half)))
            }
        }
    }
}

/// One place of a summary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub(super) x: f64,
    pub(super) centre: f64,
    pub(super) band: Option<(f64, f64)>,
}

/// A run without what cannot be drawn, in order of x, each value averaged with the `smoothing - 1` before it.
pub(super) fn clean(run: &[(f64, f64)], smoothing: usize) -> Vec<(f64, f64)> {
    let mut run: Vec<_> = run.iter().copied().filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
    run.sort_by(|a, b| a.0.total_cmp(&b.0));
    let window = smoothing.max(1);
    (0..run.len())
        .map(|end| {
            let last = &run[(end + 1).saturating_sub(window)..=end];
            (run[end].0, last.iter().map(|point| point.1).sum::<f64>() / last.len() as f64)
        })
        .collect()
}

/// The summary where *all* seeds have data, so that no seed's end makes the line jump. Takes cleaned runs and draws
/// straight lines between their points; runs without a point do not count.
pub(super) fn summarise(runs: &[Vec<(f64, f64)>], summary: Summary) -> Vec<Place> {
    let runs: Vec<_> = runs.iter().filter(|run| !run.is_empty()).collect();
    let low = runs.iter().map(|run| run[0].0).fold(f64::NEG_INFINITY, f64::max);
    let high = runs.iter().map(|run| run[run.len() - 1].0).fold(f64::INFINITY, f64::min);
    if runs.is_empty() || low > high {
        return Vec::new();
    }
    places(&runs, low, high)
        .into_iter()
        .map(|x| {
            let mut values: Vec<f64> = runs.iter().map(|run| between(run, x)).collect();
            let (centre, band) = summary.of(&mut values);
            Place { x, centre, band }
        })
        .collect()
}

/// Where to summarise: at the points of the runs, or evenly if those are more than a picture can show.
fn places(runs: &[&Vec<(f64, f64)>], low: f64, high: f64) -> Vec<f64> {
    const MOST: usize = 600;
    let inside = |x: &f64| (low..=high).contains(x);
    let mut places: Vec<f64> =
        runs.iter().flat_map(|run| run.iter().map(|point| point.0)).filter(inside).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    if places.len() > MOST {
        places = (0..MOST).map(|index| low + (high - low) * index as f64 / (MOST - 1) as f64).collect();
        places[MOST - 1] = high;
    }
    places
}

/// The value of a run at `x`, which lies between its first and last point.
fn between(run: &[(f64, f64)], x: f64) -> f64 {
    let after = run.partition_point(|point| point.0 <= x);
    let (before, after) = (run[after.saturating_sub(1)], run[after.min(run.len() - 1)]);
    let length = after.0 - before.0;
    if length > 0.0 { before.1 + (after.1 - before.1) * (x - before.0) / length } else { before.1 }
}

/// The 97.5 % quantile of Student's t.
fn t_quantile(freedom: usize) -> f64 {
    const TABLE: [f64; 30] = [
        12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145,
        2.131, 2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048,
        2.045, 2.042,
    ];
    // Beyond the table, the first two terms of the expansion around the normal quantile: right to three decimals.
    let far = 1.960 + 2.372 / freedom.max(1) as f64 + 2.822 / (freedom.max(1) as f64).powi(2);
    freedom.checked_sub(1).and_then(|index| TABLE.get(index)).copied().unwrap_or(far)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_interval_of_five_seeds() {
        let runs: Vec<_> = [1.0, 2.0, 3.0, 4.0, 5.0].map(|y| vec![(0.0, y), (10.0, y)]).into();
        let places = summarise(&runs, Summary::MeanAndInterval);
        // 2.776 * sqrt(2.5 / 5) = 1.963
        let (low, high) = places[1].band.unwrap();
        assert_eq!((places.len(), places[1].centre), (2, 3.0));
        assert!((low - 1.037).abs() < 1e-3 && (high - 4.963).abs() < 1e-3, "{low} {high}");
    }

    #[test]
    fn median_and_range_interpolate_and_stop_where_a_seed_stops() {
        let runs = vec![vec![(0.0, 0.0), (10.0, 10.0)], vec![(2.0, 4.0), (6.0, 4.0)], vec![]];
        let places = summarise(&runs, Summary::MedianAndRange);
        let expected = [(2.0, 3.0, (2.0, 4.0)), (6.0, 5.0, (4.0, 6.0))];
        let found: Vec<_> = places.iter().map(|place| (place.x, place.centre, place.band.unwrap())).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn odd_runs_are_no_trouble() {
        assert!(summarise(&[], Summary::default()).is_empty());
        assert!(summarise(&[vec![(0.0, 1.0)], vec![(5.0, 1.0)]], Summary::default()).is_empty());
        let one = summarise(&[vec![(3.0, 7.0)]], Summary::MeanAndInterval);
        assert_eq!(one, [Place { x: 3.0, centre: 7.0, band: None }]);
        let twice = summarise(&[vec![(1.0, 1.0), (1.0, 2.0), (1.0, 3.0)]], Summary::MedianAndRange);
        assert_eq!(twice.len(), 1);
        let many: Vec<_> = (0..5000).map(|x| (f64::from(x), 1.0)).collect();
        assert_eq!(summarise(&[many.clone(), many], Summary::default()).len(), 600);
    }

    #[test]
    fn cleaning_drops_nan_sorts_and_smooths() {
        let run = [(2.0, 4.0), (f64::NAN, 1.0), (1.0, 2.0), (3.0, f64::INFINITY), (4.0, 9.0)];
        assert_eq!(clean(&run, 0), [(1.0, 2.0), (2.0, 4.0), (4.0, 9.0)]);
        assert_eq!(clean(&run, 2), [(1.0, 2.0), (2.0, 3.0), (4.0, 6.5)]);
    }

    #[test]
    fn quantiles_go_on_beyond_the_table() {
        assert!((t_quantile(31) - 2.040).abs() < 2e-3);
        assert!((t_quantile(1000) - 1.962).abs() < 2e-3);
    }
}
