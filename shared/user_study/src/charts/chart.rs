//! A chart as data.

use crate::charts::axis::Axis;

/// A point on the axes, x and y.
pub type Point = (f64, f64);

/// A colour: red, green, blue.
pub type Colour = [u8; 3];

/// Panels side by side, with a common legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Line above the panels.
    pub title: String,
    /// Line below the panels, or empty.
    pub note: String,
    /// Panels, row by row.
    pub panels: Vec<Panel>,
    /// Panels in a row, at least 1.
    pub columns: usize,
    /// Width and height of each panel with its labels, pixels.
    pub panel_size: (u32, u32),
    /// Names of series 0, 1, 2 …; empty for a chart without a legend.
    pub legend: Vec<String>,
}

/// A pair of axes with its drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Line above the panel, or empty.
    pub heading: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Shapes and their series, lowest first.
    pub shapes: Vec<(usize, Shape)>,
}

/// A shape in the units of a panel's axes.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A line through points.
    Line(Vec<Point>),
    /// The series' mark at each point.
    Marks(Vec<Point>),
    /// A filled box between two corners.
    Bar(Point, Point),
    /// A pale background over the panel's height between two x.
    Band(f64, f64),
    /// Text that ends at a point.
    Text(Point, String),
}

/// Colours that people with any colour vision can distinguish (Okabe and Ito 2008), the yellow
/// darkened for a white background.
const COLOURS: [Colour; 8] = [
    [0x00, 0x72, 0xb2],
    [0xd5, 0x5e, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0x56, 0xb4, 0xe9],
    [0xe6, 0x9f, 0x00],
    [0x55, 0x55, 0x55],
    [0xb8, 0xa8, 0x00],
];

/// Returns the colour of a series.
pub fn colour(series: usize) -> Colour {
    COLOURS[series % COLOURS.len()]
}
