//! A canvas as SVG.

use std::fmt::Write;

use crate::charts::canvas::{Align, Canvas, Ink, Place, Shape};

/// Height of the letters' em in that of the line.
const EM: f64 = 0.92;

/// The picture as SVG text.
pub fn svg(canvas: &Canvas) -> String {
    let (width, height) = canvas.size;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         width=\"{width}\" height=\"{height}\" \
         font-family=\"Noto Sans Mono,DejaVu Sans Mono,monospace\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
    );
    for shape in &canvas.shapes {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{}", element(shape));
    }
    text + "</svg>\n"
}

fn element(shape: &Shape) -> String {
    match shape {
        Shape::Line { from, to, width, ink } => {
            let ((x1, y1), (x2, y2)) = (*from, *to);
            let ink = colour(*ink);
            format!(
                "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" \
                 stroke=\"{ink}\" stroke-width=\"{width}\"/>"
            )
        }
        Shape::Area { corner: (x, y), size: (w, h), ink } => {
            let ink = colour(*ink);
            format!(
                "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{w:.2}\" height=\"{h:.2}\" \
                 fill=\"{ink}\"/>"
            )
        }
        Shape::Raster { corner: (x, y), size: (w, h), raster } => {
            let file = raster.base64();
            format!(
                "<image x=\"{x:.2}\" y=\"{y:.2}\" width=\"{w:.2}\" height=\"{h:.2}\" \
                 href=\"data:image/png;base64,{file}\"/>"
            )
        }
        Shape::Mark { outline, ink } => {
            let point = |(x, y): &Place| format!("{x:.2},{y:.2}");
            let points: Vec<String> = outline.iter().map(point).collect();
            format!("<polygon points=\"{}\" fill=\"{}\"/>", points.join(" "), colour(*ink))
        }
        Shape::Words { at: (x, y), text, align, size, ink } => {
            let anchor = match align {
                Align::Left => "start",
                Align::Middle => "middle",
                Align::Right => "end",
            };
            let em = EM * size.height();
            let (ink, words) = (colour(*ink), escaped(text));
            format!(
                "<text x=\"{x:.2}\" y=\"{:.2}\" font-size=\"{em:.2}\" text-anchor=\"{anchor}\" \
                 fill=\"{ink}\">{words}</text>",
                y + 0.34 * em
            )
        }
    }
}

fn colour([r, g, b]: Ink) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
