//! A picture in memory that plotters paints on, with letters of eight by eight dots.

use std::convert::Infallible;

use font8x8::legacy::{BASIC_LEGACY, LATIN_LEGACY};
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendTextStyle, DrawingBackend, DrawingErrorKind,
};

use crate::PlotError;

/// Dots of a letter, each way.
const DOTS: i32 = 8;
/// What stands for a letter that there is no picture of.
const UNKNOWN: [u8; 8] = [0, 0x3c, 0x24, 0x24, 0x24, 0x24, 0x3c, 0];

/// Red, green and blue of every pixel, row by row; white at first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Canvas {
    size: (u32, u32),
    pixels: Vec<u8>,
}

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

impl Canvas {
    /// A white picture, that many pixels wide and high.
    pub fn new(size: (u32, u32)) -> Self {
        Self { size, pixels: vec![255; 3 * size.0 as usize * size.1 as usize] }
    }

    /// The picture as the bytes of a PNG file.
    ///
    /// # Errors
    /// It has no pixels.
    pub fn encode(&self) -> Result<Vec<u8>, PlotError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.size.0, self.size.1);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().map_err(PlotError::of)?;
        writer.write_image_data(&self.pixels).map_err(PlotError::of)?;
        writer.finish().map_err(PlotError::of)?;
        Ok(bytes)
    }
}

/// Width and height of a dot for letters of that size in pixels: whole pixels, so that they stay
/// sharp, and rather narrow than wide, as other fonts are.
fn dot(size: f64) -> (i32, i32) {
    let exact = (size / f64::from(DOTS)).max(1.0);
    (exact.floor() as i32, exact.round() as i32)
}

/// Width and height of a text in pixels.
fn extent(text: &str, size: f64) -> (i32, i32) {
    let (wide, high) = dot(size);
    (text.chars().count() as i32 * DOTS * wide, DOTS * high)
}

fn glyph(letter: char) -> [u8; 8] {
    let code = letter as usize;
    match code {
        0..0x80 => BASIC_LEGACY[code],
        0xa0..0x100 => LATIN_LEGACY[code - 0xa0],
        _ => UNKNOWN,
    }
}

impl DrawingBackend for &mut Canvas {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Drawn {
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { return Ok(()) };
        if x < self.size.0 && y < self.size.1 {
            let at = 3 * (y as usize * self.size.0 as usize + x as usize);
            let (red, green, blue) = color.rgb;
            for (pixel, new) in self.pixels[at..at + 3].iter_mut().zip([red, green, blue]) {
                let mixed = f64::from(*pixel) * (1.0 - color.alpha) + f64::from(new) * color.alpha;
                *pixel = mixed.round() as u8;
            }
        }
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        (x, y): BackendCoord,
    ) -> Drawn {
        let (wide, high) = dot(style.size());
        let (width, height) = extent(text, style.size());
        let anchor = style.anchor();
        let left = match anchor.h_pos {
            HPos::Left => 0,
            HPos::Center => -width / 2,
            HPos::Right => -width,
        };
        let top = match anchor.v_pos {
            VPos::Top => 0,
            VPos::Center => -height / 2,
            VPos::Bottom => -height,
        };
        for (number, letter) in text.chars().enumerate() {
            for (row, bits) in glyph(letter).into_iter().enumerate() {
                for column in (0..DOTS).filter(|column| bits >> column & 1 == 1) {
                    let u = left + (number as i32 * DOTS + column) * wide;
                    let v = top + row as i32 * high;
                    for (du, dv) in (0..wide * high).map(|i| (i % wide, i / wide)) {
                        let (dx, dy) = style.transform().transform(u + du, v + dv);
                        self.draw_pixel((x + dx, y + dy), style.color())?;
                    }
                }
            }
        }
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let (width, height) = extent(text, style.size());
        Ok((width as u32, height as u32))
    }
}
