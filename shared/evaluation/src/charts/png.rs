//! A canvas as PNG, at two pixels a unit.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use tiny_skia::{Color, FillRule, Paint, PathBuilder, Pixmap, PixmapMut, Stroke, Transform};

use crate::charts::PlotError;
use crate::charts::canvas::{Align, Canvas, Ink, Place, Shape, Size};

/// Pixels a unit.
const SCALE: f64 = 2.0;

/// The picture as a PNG file.
///
/// # Errors
/// It is too large for an image, or cannot be encoded.
pub fn png(canvas: &Canvas) -> Result<Vec<u8>, PlotError> {
    let (width, height) = canvas.size;
    let pixels = |length: f64| (SCALE * length).ceil() as u32;
    let mut pixmap = Pixmap::new(pixels(width), pixels(height))
        .ok_or_else(|| PlotError(format!("{width} by {height} is no size of an image")))?;
    pixmap.fill(Color::WHITE);
    for shape in &canvas.shapes {
        draw(shape, &mut pixmap.as_mut());
    }
    pixmap.encode_png().map_err(|error| PlotError(error.to_string()))
}

fn draw(shape: &Shape, pixmap: &mut PixmapMut<'_>) {
    let scale = Transform::from_scale(SCALE as f32, SCALE as f32);
    match shape {
        Shape::Line { from, to, width, ink } => {
            if let Some(path) = outline(&[*from, *to], false) {
                let stroke = Stroke { width: *width as f32, ..Stroke::default() };
                pixmap.stroke_path(&path, &paint(*ink), &stroke, scale, None);
            }
        }
        Shape::Area { corner: (x, y), size: (w, h), ink } => {
            let corners = [(*x, *y), (x + w, *y), (x + w, y + h), (*x, y + h)];
            fill(pixmap, &corners, *ink, scale);
        }
        Shape::Raster { corner, size, raster } => raster.lay(pixmap, *corner, *size, SCALE),
        Shape::Mark { outline, ink } => fill(pixmap, outline, *ink, scale),
        Shape::Words { at, text, align, size, ink } => {
            words(pixmap, *at, text, (*align, *size), *ink);
        }
    }
}

fn fill(pixmap: &mut PixmapMut<'_>, places: &[Place], ink: Ink, scale: Transform) {
    if let Some(path) = outline(places, true) {
        pixmap.fill_path(&path, &paint(ink), FillRule::Winding, scale, None);
    }
}

fn outline(places: &[Place], closed: bool) -> Option<tiny_skia::Path> {
    let mut path = PathBuilder::new();
    for (n, (x, y)) in places.iter().enumerate() {
        let (x, y) = (*x as f32, *y as f32);
        if n == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
    }
    if closed {
        path.close();
    }
    path.finish()
}

fn paint([r, g, b]: Ink) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, 0xff);
    paint
}

/// Lays the letters' rasters over what is there.
fn words(pixmap: &mut PixmapMut<'_>, at: Place, text: &str, how: (Align, Size), ink: Ink) {
    let height = match how.1 {
        Size::Small => RasterHeight::Size24,
        Size::Large => RasterHeight::Size32,
    };
    let advance = get_raster_width(FontWeight::Regular, height);
    let length = (advance * text.chars().count()) as f64;
    let before = match how.0 {
        Align::Left => 0.0,
        Align::Middle => 0.5 * length,
        Align::Right => length,
    };
    let left = (SCALE * at.0 - before).round() as i64;
    let top = (SCALE * at.1 - 0.5 * height.val() as f64).round() as i64;
    for (n, letter) in text.chars().enumerate() {
        let raster = get_raster(letter, FontWeight::Regular, height)
            .or_else(|| get_raster('?', FontWeight::Regular, height));
        let Some(raster) = raster else { continue };
        for (y, row) in raster.rows().enumerate() {
            for (x, strength) in row.iter().enumerate() {
                let place = (left + (n * advance + x) as i64, top + y as i64);
                blend(pixmap, place, *strength, ink);
            }
        }
    }
}

/// Covers a pixel with ink, as much as `strength` says.
fn blend(pixmap: &mut PixmapMut<'_>, (x, y): (i64, i64), strength: u8, ink: Ink) {
    let (width, height) = (i64::from(pixmap.width()), i64::from(pixmap.height()));
    if strength == 0 || !(0..width).contains(&x) || !(0..height).contains(&y) {
        return;
    }
    let at = 4 * (y * width + x) as usize;
    let share = u32::from(strength);
    for (under, over) in pixmap.data_mut()[at..at + 3].iter_mut().zip(ink) {
        let mixed = u32::from(*under) * (255 - share) + u32::from(over) * share;
        *under = (mixed / 255) as u8;
    }
}
