//! Axes: the position of a value, and the values at which ticks are drawn.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

/// An axis with its label and its ticks.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// True for shares near 1: divided by the logarithm of the share missing to 1, so that 0.99 is
    /// as far from 0.9 as 0.9 is from 0.
    is_of_shares: bool,
    ends: (f64, f64),
    ticks: Vec<(f64, String)>,
}

/// Shares at which an axis of shares has ticks.
const SHARES: [f64; 11] = [0.0, 0.5, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 0.998, 0.999, 0.9999];

impl Axis {
    /// A linear axis from 0 that holds `largest`, with four to nine ticks at round numbers.
    pub fn up_to(label: &str, largest: f64) -> Self {
        let largest = if largest.is_finite() && largest > 0.0 { largest } else { 1.0 };
        Self::between(label, 0.0, largest)
    }

    /// A linear axis that holds both values, which differ, with ticks at round numbers.
    pub fn between(label: &str, least: f64, largest: f64) -> Self {
        let rough = (largest - least) / 7.0;
        let power = 10.0_f64.powf(rough.log10().floor());
        let round = [1.0, 2.0, 5.0, 10.0].into_iter().find(|m| m * power >= rough);
        let step = round.unwrap_or(10.0) * power;
        let (first, last) = ((least / step).floor() as i64, (largest / step).ceil() as i64);
        let ticks = (first..=last).map(|k| k as f64 * step).collect();
        Self::new(label, (first as f64 * step, last as f64 * step), ticks)
    }

    /// An axis on which these shares near 1 differ, in per cent; those of 1 lie at its end.
    pub fn missing(label: &str, shares: impl Iterator<Item = f64>) -> Self {
        let missing = shares.map(|share| 1.0 - share).filter(|missing| *missing > 1e-5);
        let least = 0.6 * missing.fold(0.02, f64::min);
        let ticks = SHARES.into_iter().filter(|share| 1.0 - share > 1.3 * least).chain([1.0]);
        let axis = Self::new(label, (0.0, 1.0 - least), ticks.collect());
        let mut axis = Self { is_of_shares: true, ..axis };
        axis.ticks.iter_mut().for_each(|(share, text)| *text = short(100.0 * *share));
        axis
    }

    /// An axis of named rows or columns, each of length 1.
    pub fn named(label: &str, names: Vec<String>) -> Self {
        let end = names.len() as f64;
        let ticks = names.into_iter().enumerate().map(|(n, name)| (n as f64 + 0.5, name)).collect();
        Self { label: label.to_owned(), is_of_shares: false, ends: (0.0, end), ticks }
    }

    fn new(label: &str, ends: (f64, f64), ticks: Vec<f64>) -> Self {
        let ticks = ticks.into_iter().map(|tick| (tick, short(tick))).collect();
        Self { label: label.to_owned(), is_of_shares: false, ends, ticks }
    }

    /// Returns the end values.
    pub fn ends(&self) -> (f64, f64) {
        self.ends
    }

    /// Returns the ticks' values and texts.
    pub fn ticks(&self) -> &[(f64, String)] {
        &self.ticks
    }

    /// Returns the position of a value, 0 to 1.
    pub fn position(&self, value: f64) -> f64 {
        let (low, high) = self.ends;
        let scaled = |value: f64| if self.is_of_shares { -(1.0 - value).ln() } else { value };
        let value = scaled(value.clamp(low, high));
        ((value - scaled(low)) / (scaled(high) - scaled(low))).clamp(0.0, 1.0)
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (first, last): (i32, i32)) -> i32 {
        first + (f64::from(last - first) * self.position(*value)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        // One grid only: without the lighter lines between its own.
        let wanted = if hint.weight().allow_light_points() { &[] } else { &self.ticks[..] };
        wanted.iter().map(|(value, _)| *value).collect()
    }

    fn range(&self) -> Range<f64> {
        self.ends.0..self.ends.1
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        let tick = self.ticks.iter().find(|(tick, _)| tick == value);
        tick.map_or_else(String::new, |(_, text)| text.clone())
    }
}

/// A number without the digits that rounding leaves.
fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    format!("{rounded}")
}
