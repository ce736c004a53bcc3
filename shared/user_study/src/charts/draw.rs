//! Drawing of a chart with `plotters`.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::charts::PlotError;
use crate::charts::chart::{Chart, Panel, Shape, colour};

const BLACK: RGBColor = RGBColor(0x22, 0x22, 0x22);
const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);
const FAINT: RGBColor = RGBColor(0xe2, 0xe2, 0xe2);
/// Size of ordinary text, in the units of `plotters`.
const TEXT: f64 = 27.0;
/// Size of titles.
const TITLE: f64 = 36.0;
/// Height of a line of text, pixels.
const LINE: i32 = 36;
/// Margin of the whole, pixels.
const MARGIN: i32 = 28;
/// Largest side of a picture, pixels.
const SIDE_MAX: u32 = 20_000;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), PlotError>;

/// Returns the chart as SVG text.
///
/// # Errors
/// The chart is too large or has no panel.
pub fn svg(chart: &Chart) -> Result<String, PlotError> {
    let mut text = String::new();
    let size = chart.size()?;
    draw(chart, &SVGBackend::with_string(&mut text, size).into_drawing_area())?;
    Ok(text)
}

/// Room that a text takes, pixels: the letters are those of the reader's own font.
fn text_width(text: &str, size: f64) -> u32 {
    let letter = if size < TITLE { 11 } else { 14 };
    letter * text.chars().count() as u32
}

fn failed(error: impl std::fmt::Display) -> PlotError {
    PlotError(error.to_string())
}

impl Chart {
    /// Width and height, pixels.
    fn size(&self) -> Result<(u32, u32), PlotError> {
        let columns = self.columns.min(self.panels.len()) as u32;
        let rows = self.panels.len().div_ceil(self.columns.max(1)) as u32;
        let (above, below) = self.lines_around();
        let title = text_width(&self.title, TITLE).max(text_width(&self.note, TEXT));
        let panels = columns * self.panel_size.0 + self.legend_width();
        let width = panels.max(title) + 2 * MARGIN as u32;
        let panels = (rows * self.panel_size.1).max(LINE as u32 * self.legend.len() as u32);
        let height = panels + (above + below) as u32 + 2 * MARGIN as u32;
        if rows == 0 || columns == 0 || width.max(height) > SIDE_MAX {
            return Err(PlotError(format!("invalid size of a picture: {width} × {height}")));
        }
        Ok((width, height))
    }

    /// Pixels of the title and of the note.
    fn lines_around(&self) -> (i32, i32) {
        (2 * LINE, if self.note.is_empty() { 0 } else { LINE })
    }

    fn legend_width(&self) -> u32 {
        let widest = self.legend.iter().map(|name| text_width(name, TEXT)).max();
        widest.map_or(0, |widest| widest + 2 * LINE as u32)
    }
}

fn draw(chart: &Chart, area: &Area<'_>) -> Drawn {
    area.fill(&WHITE).map_err(failed)?;
    let (width, height) = area.dim_in_pixel();
    let (above, below) = chart.lines_around();
    text(area, &chart.title, (MARGIN, MARGIN), (TITLE, BLACK), HPos::Left)?;
    text(area, &chart.note, (MARGIN, height as i32 - MARGIN - LINE), (TEXT, GREY), HPos::Left)?;
    let legend_x = width as i32 - chart.legend_width() as i32 - MARGIN;
    let inner = area.margin(MARGIN + above, MARGIN + below, MARGIN, width as i32 - legend_x);
    let rows = chart.panels.len().div_ceil(chart.columns);
    for (panel, cell) in chart.panels.iter().zip(inner.split_evenly((rows, chart.columns))) {
        draw_panel(panel, &cell)?;
    }
    for (number, name) in chart.legend.iter().enumerate() {
        let y = MARGIN + above + LINE * (number as i32 + 1);
        for (outline, fill) in mark(number) {
            let mark = EmptyElement::at((legend_x + LINE / 2, y + LINE / 3))
                + Polygon::new(outline, fill.filled());
            area.draw(&mark).map_err(failed)?;
        }
        text(area, name, (legend_x + LINE, y), (TEXT, BLACK), HPos::Left)?;
    }
    area.present().map_err(failed)
}

fn text(
    area: &Area<'_>,
    text: &str,
    at: (i32, i32),
    (size, ink): (f64, RGBColor),
    side: HPos,
) -> Drawn {
    if text.is_empty() {
        return Ok(());
    }
    area.draw_text(text, &style(size, ink).pos(Pos::new(side, VPos::Top)), at).map_err(failed)
}

fn style(size: f64, ink: RGBColor) -> TextStyle<'static> {
    ("monospace", size).into_font().color(&ink)
}

fn draw_panel(panel: &Panel, area: &Area<'_>) -> Drawn {
    let widths = panel.y.ticks().iter().map(|(_, name)| text_width(name, TEXT));
    let label = if panel.y.label.is_empty() { 0 } else { LINE as u32 };
    let mut builder = ChartBuilder::on(area);
    builder.margin_right(LINE).margin_top(10);
    if !panel.heading.is_empty() {
        builder.caption(&panel.heading, style(TEXT, BLACK));
    }
    builder.y_label_area_size(widths.max().unwrap_or(0) + label + 20);
    builder.x_label_area_size(LINE * if panel.x.label.is_empty() { 1 } else { 2 });
    let mut chart = builder.build_cartesian_2d(panel.x.clone(), panel.y.clone()).map_err(failed)?;
    let mut mesh = chart.configure_mesh();
    mesh.light_line_style(TRANSPARENT).bold_line_style(FAINT).axis_style(BLACK.stroke_width(2));
    mesh.label_style(style(TEXT, GREY)).axis_desc_style(style(TEXT, BLACK));
    mesh.x_desc(&panel.x.label).y_desc(&panel.y.label).draw().map_err(failed)?;
    let (low, high) = panel.y.ends();
    for (series, shape) in &panel.shapes {
        let [r, g, b] = colour(*series);
        let ink = RGBColor(r, g, b);
        match shape {
            Shape::Line(points) => {
                let line = PathElement::new(points.clone(), ink.stroke_width(4));
                chart.draw_series([line]).map(drop)
            }
            Shape::Bar(from, to) => {
                chart.draw_series([Rectangle::new([*from, *to], ink.filled())]).map(drop)
            }
            Shape::Band(from, to) => {
                let corners = [(*from, low), (*to, high)];
                chart.draw_series([Rectangle::new(corners, ink.mix(0.16).filled())]).map(drop)
            }
            Shape::Text(at, text) => {
                let style = style(TEXT, GREY).pos(Pos::new(HPos::Right, VPos::Center));
                chart.draw_series([Text::new(text.clone(), *at, style)]).map(drop)
            }
            Shape::Marks(points) => chart
                .draw_series(points.iter().flat_map(|at| {
                    mark(*series).into_iter().map(|(outline, fill)| {
                        EmptyElement::at(*at) + Polygon::new(outline, fill.filled())
                    })
                }))
                .map(drop),
        }
        .map_err(failed)?;
    }
    Ok(())
}

/// Returns the mark of a series, white rim first: a form that goes with every other colour before
/// it comes again, and the smaller the later, so that all marks at one point can be seen.
fn mark(series: usize) -> [(Vec<(i32, i32)>, RGBColor); 2] {
    /// Corners, and the direction of the first, in turns.
    const FORMS: [(usize, f64); 5] = [(24, 0.0), (4, 0.125), (3, 0.25), (4, 0.0), (3, 0.75)];
    let (corners, first) = FORMS[series % FORMS.len()];
    let radius = (17.0 - 1.4 * series as f64).max(7.0);
    let outline = |radius: f64| -> Vec<(i32, i32)> {
        let angle = |k| std::f64::consts::TAU * (first + k as f64 / corners as f64);
        let corner = |k| (radius * f64::cos(angle(k)), radius * f64::sin(angle(k)));
        (0..corners).map(corner).map(|(x, y)| (x.round() as i32, y.round() as i32)).collect()
    };
    let [r, g, b] = colour(series);
    [(outline(radius + 2.4), WHITE), (outline(radius), RGBColor(r, g, b))]
}
