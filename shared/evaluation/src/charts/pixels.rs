//! A drawing backend in memory that writes text with letters of its own.

use std::convert::Infallible;

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendTextStyle, DrawingBackend, DrawingErrorKind,
};

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

/// Size of ordinary text, in the units of `plotters`.
pub(super) const TEXT: f64 = 27.0;
/// Size of titles.
pub(super) const TITLE: f64 = 36.0;

/// Returns the width of a text of that size, pixels.
pub(super) fn text_width(text: &str, size: f64) -> u32 {
    (text.chars().count() * get_raster_width(FontWeight::Regular, raster(size))) as u32
}

fn raster(size: f64) -> RasterHeight {
    if size < TITLE { RasterHeight::Size24 } else { RasterHeight::Size32 }
}

/// An image: rows of red, green and blue from the top, white at first.
pub(super) struct Pixels<'a> {
    size: (u32, u32),
    rgb: &'a mut [u8],
}

impl<'a> Pixels<'a> {
    /// An image in a buffer of three bytes for each pixel.
    pub(super) fn new(size: (u32, u32), rgb: &'a mut [u8]) -> Self {
        rgb.fill(0xff);
        Self { size, rgb }
    }
}

impl DrawingBackend for Pixels<'_> {
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
        let (width, height) = (self.size.0 as i32, self.size.1 as i32);
        if (0..width).contains(&x) && (0..height).contains(&y) {
            let at = 3 * (y * width + x) as usize;
            let (r, g, b) = color.rgb;
            for (under, over) in self.rgb[at..at + 3].iter_mut().zip([r, g, b]) {
                let mixed = f64::from(*under) * (1.0 - color.alpha) + f64::from(over) * color.alpha;
                *under = mixed.round() as u8;
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
        let height = raster(style.size());
        let advance = get_raster_width(FontWeight::Regular, height) as i32;
        let anchor = style.anchor();
        let left = match anchor.h_pos {
            HPos::Left => 0,
            HPos::Center => -(text_width(text, style.size()) as i32) / 2,
            HPos::Right => -(text_width(text, style.size()) as i32),
        };
        let top = match anchor.v_pos {
            VPos::Top => 0,
            VPos::Center => -(height.val() as i32) / 2,
            VPos::Bottom => -(height.val() as i32),
        };
        for (n, letter) in text.chars().enumerate() {
            let letter = get_raster(letter, FontWeight::Regular, height)
                .or_else(|| get_raster('?', FontWeight::Regular, height));
            for (v, row) in letter.iter().flat_map(|letter| letter.rows().enumerate()) {
                for (u, strength) in row.iter().enumerate().filter(|(_, strength)| **strength > 0) {
                    let at = (left + n as i32 * advance + u as i32, top + v as i32);
                    let (dx, dy) = style.transform().transform(at.0, at.1);
                    let alpha = f64::from(*strength) / 255.0 * style.color().alpha;
                    self.draw_pixel((x + dx, y + dy), BackendColor { alpha, ..style.color() })?;
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
        Ok((text_width(text, style.size()), raster(style.size()).val() as u32))
    }
}
