//! What a picture is made of: lines, boxes, marks and words, in units of which a screen shows one
//! or two pixels each.

use crate::charts::raster::Raster;

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Canvas {
    /// Width and height.
    pub size: (f64, f64),
    /// What is on it, bottom first.
    pub shapes: Vec<Shape>,
}

/// A place: to the right, and down.
pub type Place = (f64, f64);

/// Something on it.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A straight line.
    Line {
        /// One end.
        from: Place,
        /// The other.
        to: Place,
        /// How thick it is.
        width: f64,
        /// Its colour.
        ink: Ink,
    },
    /// A filled box.
    Area {
        /// Its upper left corner.
        corner: Place,
        /// Width and height.
        size: (f64, f64),
        /// Its colour.
        ink: Ink,
    },
    /// A filled outline round a place.
    Mark {
        /// Its corners.
        outline: Vec<Place>,
        /// Its colour.
        ink: Ink,
    },
    /// A picture in pixels.
    Raster {
        /// Its upper left corner.
        corner: Place,
        /// Width and height.
        size: (f64, f64),
        /// The picture.
        raster: Raster,
    },
    /// Words. The place is at half their height.
    Words {
        /// Where they are.
        at: Place,
        /// The words.
        text: String,
        /// Where they are, seen from their place.
        align: Align,
        /// How large they are.
        size: Size,
        /// Their colour.
        ink: Ink,
    },
}

/// A colour: red, green, blue.
pub type Ink = [u8; 3];

/// Where words are, seen from their place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// They begin there.
    Left,
    /// It is their middle.
    Middle,
    /// They end there.
    Right,
}

/// How large words are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// Labels.
    Small,
    /// Titles.
    Large,
}

/// Words and axes.
pub const BLACK: Ink = [0x22, 0x22, 0x22];
/// Less important words.
pub const GREY: Ink = [0x66, 0x66, 0x66];
/// Lines behind everything.
pub const FAINT: Ink = [0xe2, 0xe2, 0xe2];

/// Colours that people with any colour vision tell apart (Okabe and Ito 2008), the yellow darkened
/// for white ground.
const COLOURS: [Ink; 8] = [
    [0x00, 0x72, 0xb2],
    [0xd5, 0x5e, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0x56, 0xb4, 0xe9],
    [0xe6, 0x9f, 0x00],
    [0x55, 0x55, 0x55],
    [0xb8, 0xa8, 0x00],
];

/// Width of a small letter; all letters are as wide.
pub const LETTER_WIDTH: f64 = 7.2;

/// The colour of a series.
pub fn colour(series: usize) -> Ink {
    COLOURS[series % COLOURS.len()]
}

impl Canvas {
    /// An empty one.
    pub fn new(width: f64, height: f64) -> Self {
        Self { size: (width, height), shapes: Vec::new() }
    }

    /// Draws a line.
    pub fn line(&mut self, from: Place, to: Place, width: f64, ink: Ink) {
        self.shapes.push(Shape::Line { from, to, width, ink });
    }

    /// Fills a box.
    pub fn area(&mut self, corner: Place, size: (f64, f64), ink: Ink) {
        self.shapes.push(Shape::Area { corner, size, ink });
    }

    /// Lays a picture in pixels; a PNG shows two of them a unit.
    pub fn raster(&mut self, corner: Place, size: (f64, f64), raster: Raster) {
        self.shapes.push(Shape::Raster { corner, size, raster });
    }

    /// Writes words.
    pub fn words(&mut self, at: Place, text: &str, align: Align, size: Size, ink: Ink) {
        self.shapes.push(Shape::Words { at, text: text.to_owned(), align, size, ink });
    }

    /// Puts the mark of a series: its colour, a form that goes with every other colour before it
    /// comes again, and the smaller the later, so that marks on each other are all seen.
    pub fn mark(&mut self, (x, y): Place, series: usize) {
        /// Corners, and the direction of the first, in turns.
        const FORMS: [(usize, f64); 5] = [(24, 0.0), (4, 0.125), (3, 0.25), (4, 0.0), (3, 0.75)];
        let (corners, first) = FORMS[series % FORMS.len()];
        let radius = (8.5 - 0.7 * series as f64).max(3.5);
        let outline = |radius: f64| -> Vec<Place> {
            let angle = |k| std::f64::consts::TAU * (first + k as f64 / corners as f64);
            let corner = |k| (x + radius * f64::cos(angle(k)), y + radius * f64::sin(angle(k)));
            (0..corners).map(corner).collect()
        };
        // A white rim keeps marks apart that lie on each other.
        self.shapes.push(Shape::Mark { outline: outline(radius + 1.2), ink: [0xff; 3] });
        self.shapes.push(Shape::Mark { outline: outline(radius), ink: colour(series) });
    }
}

impl Size {
    /// Height of a line of words.
    pub fn height(self) -> f64 {
        match self {
            Self::Small => 12.0,
            Self::Large => 16.0,
        }
    }
}
