//! A chart of series over one axis.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::coord::combinators::IntoLogRange;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::{
    ChartBuilder, Circle, Color, DrawingArea, DrawingBackend, LineSeries, Palette, Palette99,
    PathElement, Ranged, SeriesLabelPosition,
};
use plotters::style::WHITE;

use crate::{Drawing, PlotError};

/// How an axis is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps are equally long.
    Linear,
    /// Equal factors are equally long; for values above 0.
    Logarithmic,
}

/// One line: its name and its points, x and y, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What the legend says.
    pub name: String,
    /// x and y of each.
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

impl Drawing for Lines {
    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Result<(), PlotError> {
        use Scale::{Linear, Logarithmic};
        let points = || self.series.iter().flat_map(|series| &series.points);
        let x = extent(points().map(|point| point.0), self.x_scale)?;
        let y = extent(points().map(|point| point.1), self.y_scale)?;
        match (self.x_scale, self.y_scale) {
            (Linear, Linear) => self.draw_over(area, x, y),
            (Linear, Logarithmic) => self.draw_over(area, x, y.log_scale()),
            (Logarithmic, Linear) => self.draw_over(area, x.log_scale(), y),
            (Logarithmic, Logarithmic) => self.draw_over(area, x.log_scale(), y.log_scale()),
        }
    }
}

/// The range of an axis that shows all values.
fn extent(values: impl Iterator<Item = f64>, scale: Scale) -> Result<Range<f64>, PlotError> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    if !(low.is_finite() && high.is_finite()) {
        return Err(PlotError("there are no finite points".to_owned()));
    }
    match scale {
        Scale::Logarithmic if low <= 0.0 => {
            Err(PlotError(format!("{low} has no place on a logarithmic axis")))
        }
        Scale::Logarithmic => Ok(low / 1.3..high * 1.3),
        Scale::Linear => {
            let margin = if high > low { 0.05 * (high - low) } else { 1.0 };
            Ok(low - margin..high + margin)
        }
    }
}

/// A number at a tick, without the digits that rounding leaves.
fn short(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    format!("{rounded}")
}

impl Lines {
    fn draw_over<B, X, Y>(&self, area: &DrawingArea<B, Shift>, x: X, y: Y) -> Result<(), PlotError>
    where
        B: DrawingBackend,
        X: AsRangedCoord<Value = f64>,
        Y: AsRangedCoord<Value = f64>,
        X::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
        Y::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        area.fill(&WHITE).map_err(PlotError::of)?;
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, ("sans-serif", 15))
            .margin(12)
            .margin_right(40)
            .x_label_area_size(48)
            .y_label_area_size(96)
            .build_cartesian_2d(x, y)
            .map_err(PlotError::of)?;
        chart
            .configure_mesh()
            .x_desc(&self.x)
            .y_desc(&self.y)
            .x_label_formatter(&|value| short(*value))
            .y_label_formatter(&|value| short(*value))
            .axis_desc_style(("sans-serif", 14))
            .label_style(("sans-serif", 12))
            .draw()
            .map_err(PlotError::of)?;
        for (number, series) in self.series.iter().enumerate() {
            let color = Palette99::pick(number).to_rgba();
            let points = || series.points.iter().copied();
            let dots = points().map(|point| Circle::new(point, 3, color.filled()));
            chart.draw_series(dots).map_err(PlotError::of)?;
            let line = LineSeries::new(points(), color.stroke_width(2));
            let drawn = chart.draw_series(line).map_err(PlotError::of)?;
            let sample = move |(x, y)| PathElement::new([(x, y), (x + 20, y)], color);
            drawn.label(&series.name).legend(sample);
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.8))
            .label_font(("sans-serif", 12))
            .draw()
            .map_err(PlotError::of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{png, svg};

    fn lines(points: &[(f64, f64)], scale: Scale) -> Lines {
        Lines {
            title: "cost µs".to_owned(),
            x: "objects".to_owned(),
            y: "µs".to_owned(),
            x_scale: scale,
            y_scale: scale,
            series: vec![Series { name: "lookahead".to_owned(), points: points.to_vec() }],
        }
    }

    #[test]
    fn a_chart_is_drawn_alike_every_time() {
        let points = [(1.0, 2.0), (10.0, 30.0), (1000.0, 7.0)];
        for scale in [Scale::Linear, Scale::Logarithmic] {
            let chart = lines(&points, scale);
            let text = svg(&chart, (640, 400)).unwrap();
            assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"));
            for word in ["cost µs", "objects", "lookahead"] {
                assert!(text.contains(word), "{word}: {text}");
            }
            assert_eq!(text.matches("<circle").count(), points.len());
            let picture = png(&chart, (640, 400)).unwrap();
            assert_eq!(picture, png(&chart, (640, 400)).unwrap());
            assert_eq!(&picture[..8], b"\x89PNG\r\n\x1a\n");
        }
    }

    #[test]
    fn letters_are_painted_on_the_picture() {
        let dark = |chart: &Lines| {
            let bytes = png(chart, (640, 400)).unwrap();
            let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
            let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut pixels).unwrap();
            pixels.chunks(3).filter(|rgb| rgb.iter().all(|&c| c < 64)).count()
        };
        let titled = lines(&[(1.0, 1.0), (2.0, 2.0)], Scale::Linear);
        let plain = Lines { title: " ".to_owned(), ..titled.clone() };
        assert!(dark(&titled) > dark(&plain) + 50, "{} {}", dark(&titled), dark(&plain));
    }

    #[test]
    fn what_makes_no_chart_is_refused() {
        assert!(svg(&lines(&[], Scale::Linear), (640, 400)).is_err());
        assert!(svg(&lines(&[(f64::NAN, 1.0)], Scale::Linear), (640, 400)).is_err());
        let error = svg(&lines(&[(0.0, 1.0)], Scale::Logarithmic), (640, 400)).unwrap_err();
        assert!(error.to_string().contains("logarithmic"), "{error}");
        assert!(svg(&lines(&[(5.0, 5.0)], Scale::Linear), (640, 400)).is_ok());
    }
}
