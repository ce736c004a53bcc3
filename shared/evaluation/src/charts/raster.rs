//! A picture in pixels, to be laid on a canvas.

use tiny_skia::{FilterQuality, Pixmap, PixmapMut, PixmapPaint, PremultipliedColorU8, Transform};

use crate::charts::PlotError;
use crate::charts::canvas::Place;

/// A picture in pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    pixels: Pixmap,
    file: Vec<u8>,
}

impl Raster {
    /// The picture of that width whose pixels are given row by row from the top.
    ///
    /// # Errors
    /// The pixels fill no rows, or cannot be encoded.
    pub fn new(width: usize, pixels: &[[u8; 3]]) -> Result<Self, PlotError> {
        let height = pixels.len().checked_div(width).filter(|rows| rows * width == pixels.len());
        let size = |length: usize| u32::try_from(length).ok();
        let empty = height.and_then(|height| Pixmap::new(size(width)?, size(height)?));
        let what = || format!("{} pixels are no rows of {width}", pixels.len());
        let mut pixmap = empty.ok_or_else(|| PlotError(what()))?;
        for (pixel, [r, g, b]) in pixmap.pixels_mut().iter_mut().zip(pixels) {
            if let Some(opaque) = PremultipliedColorU8::from_rgba(*r, *g, *b, 0xff) {
                *pixel = opaque;
            }
        }
        let file = pixmap.encode_png().map_err(|error| PlotError(error.to_string()))?;
        Ok(Self { pixels: pixmap, file })
    }

    /// Lays it over a picture of `scale` pixels a unit.
    pub(crate) fn lay(
        &self,
        on: &mut PixmapMut<'_>,
        corner: Place,
        (width, height): (f64, f64),
        scale: f64,
    ) {
        let share = |length: f64, pixels: u32| (scale * length / f64::from(pixels)) as f32;
        let (x, y) = (share(width, self.pixels.width()), share(height, self.pixels.height()));
        let (left, top) = ((scale * corner.0) as f32, (scale * corner.1) as f32);
        let place = Transform::from_row(x, 0.0, 0.0, y, left, top);
        let paint = PixmapPaint { quality: FilterQuality::Bilinear, ..PixmapPaint::default() };
        on.draw_pixmap(0, 0, self.pixels.as_ref(), &paint, place, None);
    }

    /// The picture as a PNG file in base 64.
    pub(crate) fn base64(&self) -> String {
        base64(&self.file)
    }
}

/// RFC 4648, section 4.
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |n: usize| u32::from(group.get(n).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for n in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * n) & 0x3f) as usize];
            text.push(if n <= group.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::charts::{Canvas, png, svg};

    #[test]
    fn base64_is_as_published() {
        let all =
            ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(|text| base64(text.as_bytes()));
        assert_eq!(all, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
    }

    #[test]
    fn a_raster_is_where_it_was_laid() {
        let pixels = [[[200, 0, 0]; 8], [[0, 0, 200]; 8]].concat();
        let mut canvas = Canvas::new(10.0, 4.0);
        canvas.raster((1.0, 1.0), (4.0, 1.0), Raster::new(8, &pixels).unwrap());
        let picture = Pixmap::decode_png(&png(&canvas).unwrap()).unwrap();
        let at = |x, y| picture.pixel(x, y).map(|p| [p.red(), p.green(), p.blue()]).unwrap();
        assert_eq!(
            [at(2, 2), at(9, 3), at(1, 2), at(10, 2)],
            [[200, 0, 0], [0, 0, 200], [255; 3], [255; 3]]
        );
        assert!(svg(&canvas).contains("href=\"data:image/png;base64,iVBOR"));
    }

    #[test]
    fn pixels_that_fill_no_rows_are_refused() {
        assert!(Raster::new(3, &[[0; 3]; 8]).is_err());
        assert!(Raster::new(0, &[]).is_err());
    }
}
