//! A chart of series over one axis.

use crate::charts::PlotError;
use crate::charts::axis::{Linear, Logarithmic};
use crate::charts::canvas::{Align, BLACK, Canvas, FAINT, GREY, LETTER_WIDTH, Place, Size, colour};

/// How an axis is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps are equally long; from 0.
    Linear,
    /// Equal factors are equally long; for values above 0.
    Logarithmic,
}

/// One line: its name and its points, x and y, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What the legend says.
    pub name: String,
    /// x and y of each, not below 0.
    pub points: Vec<(f64, f64)>,
}

/// Series over one axis, with a legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Lines {
    /// Above the chart.
    pub title: String,
    /// What the horizontal axis measures, and in which unit.
    pub x: String,
    /// What the vertical axis measures, and in which unit.
    pub y: String,
    /// Division of the horizontal axis.
    pub x_scale: Scale,
    /// Division of the vertical axis.
    pub y_scale: Scale,
    /// The lines.
    pub series: Vec<Series>,
}

/// Left of the chart, above and below it.
const MARGIN: (f64, f64, f64) = (86.0, 74.0, 62.0);
/// Between two lines of the legend, and from the chart to it.
const LEGEND: (f64, f64) = (22.0, 24.0);

/// An axis of either kind.
#[derive(Clone, Copy)]
enum Axis {
    Linear(Linear),
    Logarithmic(Logarithmic),
}

impl Lines {
    /// Draws the chart, that wide and high.
    ///
    /// # Errors
    /// There are no points, one is not finite or negative, or has no place on a logarithmic axis.
    pub fn draw(&self, size: (f64, f64)) -> Result<Canvas, PlotError> {
        let points = || self.series.iter().flat_map(|series| &series.points);
        let x = Axis::over(points().map(|point| point.0), self.x_scale)?;
        let y = Axis::over(points().map(|point| point.1), self.y_scale)?;
        let longest = self.series.iter().map(|s| s.name.chars().count()).max().unwrap_or(0);
        let legend = 2.0 * LEGEND.1 + LETTER_WIDTH * longest as f64 + 16.0;
        let chart = (size.0 - MARGIN.0 - legend, size.1 - MARGIN.1 - MARGIN.2);
        let at = |u: f64, v: f64| (MARGIN.0 + u * chart.0, MARGIN.1 + (1.0 - v) * chart.1);
        let mut canvas = Canvas::new(size.0, size.1);
        self.frame(&mut canvas, (&x, &y), at);
        for (number, series) in self.series.iter().enumerate() {
            let places: Vec<Place> =
                series.points.iter().map(|(u, v)| at(x.place(*u), y.place(*v))).collect();
            for ends in places.windows(2) {
                canvas.line(ends[0], ends[1], 2.0, colour(number));
            }
            places.into_iter().for_each(|place| canvas.mark(place, number));
            let line = MARGIN.1 + 10.0 + number as f64 * LEGEND.0;
            let left = size.0 - legend + LEGEND.1;
            canvas.mark((left, line), number);
            let place = (left + 16.0, line);
            canvas.words(place, &series.name, Align::Left, Size::Small, BLACK);
        }
        Ok(canvas)
    }

    fn frame(&self, canvas: &mut Canvas, (x, y): (&Axis, &Axis), at: impl Fn(f64, f64) -> Place) {
        canvas.words((MARGIN.0, 24.0), &self.title, Align::Left, Size::Large, BLACK);
        for mark in y.marks() {
            let place = at(0.0, y.place(mark));
            canvas.line(place, at(1.0, y.place(mark)), 1.0, FAINT);
            let place = (place.0 - 8.0, place.1);
            canvas.words(place, &short(mark), Align::Right, Size::Small, GREY);
        }
        for mark in x.marks() {
            let place = at(x.place(mark), 0.0);
            canvas.line(place, at(x.place(mark), 1.0), 1.0, FAINT);
            let place = (place.0, place.1 + 14.0);
            canvas.words(place, &short(mark), Align::Middle, Size::Small, GREY);
        }
        canvas.line(at(0.0, 0.0), at(1.0, 0.0), 1.5, BLACK);
        canvas.line(at(0.0, 0.0), at(0.0, 1.0), 1.5, BLACK);
        let (middle, bottom) = at(0.5, 0.0);
        canvas.words((middle, bottom + 36.0), &self.x, Align::Middle, Size::Small, BLACK);
        canvas.words((MARGIN.0 - 60.0, MARGIN.1 - 18.0), &self.y, Align::Left, Size::Small, BLACK);
    }
}

impl Axis {
    /// An axis that shows all values.
    fn over(values: impl Iterator<Item = f64>, scale: Scale) -> Result<Self, PlotError> {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values {
            if !value.is_finite() || value < 0.0 {
                return Err(PlotError(format!("{value} has no place on an axis")));
            }
            (low, high) = (low.min(value), high.max(value));
        }
        match scale {
            _ if low > high => Err(PlotError("there are no points".to_owned())),
            Scale::Logarithmic if low <= 0.0 => {
                Err(PlotError(format!("{low} has no place on a logarithmic axis")))
            }
            Scale::Logarithmic => Ok(Self::Logarithmic(Logarithmic::over(low, high))),
            Scale::Linear => Ok(Self::Linear(Linear::up_to(high))),
        }
    }

    fn place(&self, value: f64) -> f64 {
        match self {
            Self::Linear(axis) => axis.place(value),
            Self::Logarithmic(axis) => axis.place(value),
        }
    }

    fn marks(&self) -> Vec<f64> {
        match self {
            Self::Linear(axis) => axis.marks(),
            Self::Logarithmic(axis) => axis.marks(),
        }
    }
}

/// A number at a mark, without the digits that rounding leaves.
fn short(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    format!("{rounded}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::charts::{png, svg};

    fn lines(points: &[(f64, f64)], scale: Scale) -> Lines {
        Lines {
            title: "cost µs".to_owned(),
            x: "objects".to_owned(),
            y: "µs".to_owned(),
            x_scale: scale,
            y_scale: scale,
            series: vec![Series { name: "a<b".to_owned(), points: points.to_vec() }],
        }
    }

    #[test]
    fn a_chart_is_drawn_alike_every_time() {
        let points = [(1.0, 2.0), (10.0, 30.0), (1000.0, 7.0)];
        for scale in [Scale::Linear, Scale::Logarithmic] {
            let chart = lines(&points, scale).draw((640.0, 400.0)).unwrap();
            let text = svg(&chart);
            assert!(text.starts_with("<svg") && text.ends_with("</svg>\n"));
            for word in ["cost µs", "objects", "a&lt;b"] {
                assert!(text.contains(word), "{word}: {text}");
            }
            // Each mark with its rim, and one of the legend.
            assert_eq!(text.matches("<polygon").count(), 2 * (points.len() + 1));
            let picture = png(&chart).unwrap();
            assert_eq!(picture, png(&chart).unwrap());
            assert_eq!(&picture[..8], b"\x89PNG\r\n\x1a\n");
        }
    }

    #[test]
    fn what_makes_no_chart_is_refused() {
        let size = (640.0, 400.0);
        for points in [&[][..], &[(f64::NAN, 1.0)], &[(-1.0, 1.0)]] {
            assert!(lines(points, Scale::Linear).draw(size).is_err());
        }
        let error = lines(&[(0.0, 1.0)], Scale::Logarithmic).draw(size).unwrap_err();
        assert!(error.to_string().contains("logarithmic"), "{error}");
        assert!(lines(&[(5.0, 5.0)], Scale::Linear).draw(size).is_ok());
        assert!(png(&Canvas::new(0.0, 1.0)).is_err());
    }

    #[test]
    fn letters_are_painted_on_the_picture() {
        let mut canvas = Canvas::new(40.0, 20.0);
        let blank = png(&canvas).unwrap();
        canvas.words((20.0, 10.0), "µok", Align::Middle, Size::Small, BLACK);
        assert_ne!(png(&canvas).unwrap(), blank);
    }
}
