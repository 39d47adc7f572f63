use std::path::Path;

use super::super::error::RenderError;
use super::super::image::Image;
use super::write_error;

/// A picture as the bytes of a PNG file; a `mark` that is not empty is its text "Source".
pub fn png_bytes(image: &Image, mark: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.width(), image.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    if !mark.is_empty() {
        // Plain letters are a valid text.
        let _ = encoder.add_text_chunk("Source".to_owned(), mark.to_owned());
    }
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&image.to_rgb()));
    written.expect("an image has a valid size, and memory takes all bytes");
    bytes
}

/// Writes a picture as a PNG file with a mark, replacing what has the name.
pub fn write_png(path: &Path, image: &Image, mark: &str) -> Result<(), RenderError> {
    std::fs::write(path, png_bytes(image, mark)).map_err(write_error(path))
}
