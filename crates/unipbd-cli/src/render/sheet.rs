//! A picture made of vectors, written as SVG or PDF.

use std::fmt::Write as _;

use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Finish as _, Pdf, Rect, Ref, TextStr};
use tiny_skia::{Path, PathSegment};

use super::color::{self, Rgb, css};
use super::paper::Paper;

/// Points of print in a pixel: 96 pixels and 72 points are an inch.
const POINTS_PER_PIXEL: f32 = 0.75;

/// A sheet with shapes on it, in the order in which they cover each other.
pub(super) struct Sheet {
    size: [f32; 2],
    background: Rgb,
    layers: Vec<Layer>,
}

/// Shapes that are moved and cut together.
struct Layer {
    offset: [f32; 2],
    clip: Option<[f32; 2]>,
    /// A region that it is cut to besides, by the nonzero rule.
    region: Option<Path>,
    marks: Vec<Mark>,
}

enum Mark {
    Fill { path: Path, color: Rgb },
    Stroke { path: Path, color: Rgb, width: f32 },
    Discs { centers: Vec<[f32; 2]>, radius: f32, color: Rgb },
}

impl Sheet {
    /// An empty sheet of this size [pixels].
    pub fn new(size: [f32; 2], background: Rgb) -> Sheet {
        Sheet { size, background, layers: Vec::new() }
    }

    /// Its size [pixels].
    pub fn size(&self) -> [f32; 2] {
        self.size
    }

    /// Starts a layer: later marks lie `offset` away, and are cut to a rectangle of size `clip`.
    pub fn start_layer(&mut self, offset: [f32; 2], clip: Option<[f32; 2]>) {
        self.layers.push(Layer { offset, clip, region: None, marks: Vec::new() });
    }

    /// Starts a layer at the place of the last one: later marks are cut to this region besides.
    pub fn cut_to(&mut self, region: Option<Path>) {
        let (offset, clip) = self.layers.last().map_or(([0.0; 2], None), |layer| (layer.offset, layer.clip));
        self.layers.push(Layer { offset, clip, region, marks: Vec::new() });
    }

    fn push(&mut self, mark: Mark) {
        if self.layers.is_empty() {
            self.start_layer([0.0; 2], None);
        }
        if let Some(layer) = self.layers.last_mut() {
            layer.marks.push(mark);
        }
    }

    /// Layers with anything on them.
    fn drawn(&self) -> impl Iterator<Item = &Layer> {
        self.layers.iter().filter(|layer| !layer.marks.is_empty())
    }

    /// A colour as it looks over the background: plates and veils of a sheet are opaque.
    fn opaque(&self, over: Rgb, opacity: f32) -> Rgb {
        color::mix(self.background, over, opacity.clamp(0.0, 1.0))
    }

    /// The sheet as SVG 1.1, with a mark of where it comes from.
    pub fn svg(&self, mark: &str) -> String {
        let [width, height] = self.size;
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\">\n<desc>{mark}</desc>\n<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
            css(self.background)
        );
        for (number, layer) in self.drawn().enumerate() {
            let [x, y] = layer.offset;
            let mut clip = String::new();
            if let Some([width, height]) = layer.clip {
                let _ = writeln!(
                    text,
                    "<clipPath id=\"c{number}\"><rect width=\"{width}\" height=\"{height}\"/></clipPath>"
                );
                clip = format!(" clip-path=\"url(#c{number})\"");
            }
            let _ = writeln!(text, "<g transform=\"translate({x} {y})\"{clip}>");
            if let Some(region) = &layer.region {
                let path = svg_path(region);
                let _ = writeln!(text, "<clipPath id=\"r{number}\"><path d=\"{path}\"/></clipPath>");
                let _ = writeln!(text, "<g clip-path=\"url(#r{number})\">");
            }
            layer.marks.iter().for_each(|mark| svg_mark(&mut text, mark));
            text += if layer.region.is_some() { "</g>\n</g>\n" } else { "</g>\n" };
        }
        text + "</svg>\n"
    }

    /// The sheet as a page of PDF 1.7, with a mark of where it comes from.
    pub fn pdf(&self, mark: &str) -> Vec<u8> {
        let [catalog, pages, page, content, information] = [1, 2, 3, 4, 5].map(Ref::new);
        let [width, height] = self.size.map(|length| length * POINTS_PER_PIXEL);
        let mut pdf = Pdf::new();
        pdf.catalog(catalog).pages(pages);
        pdf.pages(pages).kids([page]).count(1);
        let mut leaf = pdf.page(page);
        leaf.media_box(Rect::new(0.0, 0.0, width, height)).parent(pages).contents(content);
        leaf.resources();
        leaf.finish();
        pdf.document_info(information).creator(TextStr("unipbd")).keywords(TextStr(mark));
        pdf.stream(content, &self.pdf_content(height)).filter(pdf_writer::Filter::FlateDecode);
        pdf.finish()
    }

    fn pdf_content(&self, height: f32) -> Vec<u8> {
        let mut page = Content::new();
        page.set_line_cap(LineCapStyle::RoundCap).set_line_join(LineJoinStyle::RoundJoin);
        // Pixels from the upper left corner.
        page.transform([POINTS_PER_PIXEL, 0.0, 0.0, -POINTS_PER_PIXEL, 0.0, height]);
        let [width, rows] = self.size;
        fill_color(&mut page, self.background);
        page.rect(0.0, 0.0, width, rows).fill_nonzero();
        for layer in self.drawn() {
            page.save_state();
            page.transform([1.0, 0.0, 0.0, 1.0, layer.offset[0], layer.offset[1]]);
            if let Some([width, height]) = layer.clip {
                page.rect(0.0, 0.0, width, height).clip_nonzero().end_path();
            }
            if let Some(region) = &layer.region {
                pdf_path(&mut page, region);
                page.clip_nonzero().end_path();
            }
            layer.marks.iter().for_each(|mark| pdf_mark(&mut page, mark));
            page.restore_state();
        }
        compressed(&page.finish())
    }
}

impl Paper for Sheet {
    /// That of the layer being drawn.
    fn size(&self) -> [f32; 2] {
        self.layers.last().and_then(|layer| layer.clip).unwrap_or(self.size)
    }

    fn fill(&mut self, path: &Path, color: Rgb, opacity: f32) {
        let color = self.opaque(color, opacity);
        self.push(Mark::Fill { path: path.clone(), color });
    }

    fn stroke(&mut self, path: &Path, color: Rgb, width: f32) {
        self.push(Mark::Stroke { path: path.clone(), color, width });
    }

    fn disc(&mut self, center: [f32; 2], radius: f32, color: Rgb, opacity: f32) {
        let color = self.opaque(color, opacity);
        let last = self.layers.last_mut().and_then(|layer| layer.marks.last_mut());
        match last {
            Some(Mark::Discs { centers, radius: r, color: c }) if *r == radius && *c == color => centers.push(center),
            _ => self.push(Mark::Discs { centers: vec![center], radius, color }),
        }
    }
}

fn svg_mark(text: &mut String, mark: &Mark) {
    match mark {
        Mark::Fill { path, color } => {
            let _ = writeln!(text, "<path fill=\"{}\" fill-rule=\"evenodd\" d=\"{}\"/>", css(*color), svg_path(path));
        }
        Mark::Stroke { path, color, width } => {
            let _ = writeln!(
                text,
                "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{width:.2}\" stroke-linecap=\"round\" \
                 stroke-linejoin=\"round\" d=\"{}\"/>",
                css(*color),
                svg_path(path)
            );
        }
        Mark::Discs { centers, radius, color } => {
            let _ = writeln!(text, "<g fill=\"{}\">", css(*color));
            for [x, y] in centers {
                let _ = writeln!(text, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius:.2}\"/>");
            }
            *text += "</g>\n";
        }
    }
}

fn svg_path(path: &Path) -> String {
    let mut text = String::new();
    for segment in path.segments() {
        let _ = match segment {
            PathSegment::MoveTo(p) => write!(text, "M{:.2} {:.2}", p.x, p.y),
            PathSegment::LineTo(p) => write!(text, "L{:.2} {:.2}", p.x, p.y),
            PathSegment::QuadTo(a, p) => write!(text, "Q{:.2} {:.2} {:.2} {:.2}", a.x, a.y, p.x, p.y),
            PathSegment::CubicTo(a, b, p) => {
                write!(text, "C{:.2} {:.2} {:.2} {:.2} {:.2} {:.2}", a.x, a.y, b.x, b.y, p.x, p.y)
            }
            PathSegment::Close => write!(text, "Z"),
        };
    }
    text
}

fn pdf_mark(page: &mut Content, mark: &Mark) {
    match mark {
        Mark::Fill { path, color } => {
            fill_color(page, *color);
            pdf_path(page, path);
            page.fill_even_odd();
        }
        Mark::Stroke { path, color, width } => {
            line_color(page, *color);
            page.set_line_width(*width);
            pdf_path(page, path);
            page.stroke();
        }
        // A line of no length with round ends is a disc.
        Mark::Discs { centers, radius, color } => {
            line_color(page, *color);
            page.set_line_width(2.0 * radius);
            for [x, y] in centers {
                page.move_to(*x, *y).line_to(*x, *y);
            }
            page.stroke();
        }
    }
}

fn pdf_path(page: &mut Content, path: &Path) {
    let mut last = tiny_skia::Point::zero();
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(p) => page.move_to(p.x, p.y),
            PathSegment::LineTo(p) => page.line_to(p.x, p.y),
            // A quadratic curve as a cubic one.
            PathSegment::QuadTo(a, p) => {
                let toward = |from: f32, to: f32| from + (to - from) * 2.0 / 3.0;
                page.cubic_to(toward(last.x, a.x), toward(last.y, a.y), toward(p.x, a.x), toward(p.y, a.y), p.x, p.y)
            }
            PathSegment::CubicTo(a, b, p) => page.cubic_to(a.x, a.y, b.x, b.y, p.x, p.y),
            PathSegment::Close => page.close_path(),
        };
        if let PathSegment::MoveTo(p)
        | PathSegment::LineTo(p)
        | PathSegment::QuadTo(_, p)
        | PathSegment::CubicTo(_, _, p) = segment
        {
            last = p;
        }
    }
}

fn fill_color(page: &mut Content, color: Rgb) {
    let [red, green, blue] = color::to_float(color).map(|part| part / 255.0);
    page.set_fill_rgb(red, green, blue);
}

fn line_color(page: &mut Content, color: Rgb) {
    let [red, green, blue] = color::to_float(color).map(|part| part / 255.0);
    page.set_stroke_rgb(red, green, blue);
}

fn compressed(bytes: &[u8]) -> Vec<u8> {
    use std::io::Write as _;
    let mut output = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    // Writing into a vector does not fail.
    let _ = output.write_all(bytes);
    output.finish().unwrap_or_default()
}
