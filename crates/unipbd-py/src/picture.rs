//! Pictures of a simulation.

use numpy::PyArray3;
use numpy::ndarray::Array3;
use pyo3::prelude::*;
use unipbd_cli::record::Fields;
use unipbd_cli::render::encode::png_bytes;
use unipbd_cli::render::{Background, ColorBy, Image, RenderOptions, Renderer, Style, TimeStamp, View};

use crate::errors;
use crate::world::World;

/// How to draw, in words.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Look {
    width: u32,
    color_by: String,
    style: String,
    background: String,
    view: Option<([f64; 2], [f64; 2])>,
    time_stamp: bool,
}

impl Look {
    fn options(&self) -> PyResult<RenderOptions> {
        let unknown = |what: &str, word: &str, known: &str| {
            pyo3::exceptions::PyValueError::new_err(format!("{what} is {known}, not \"{word}\""))
        };
        let color_by = ColorBy::ALL.into_iter().find(|color_by| color_by.name() == self.color_by);
        let style = match &self.style[..] {
            "surface" => Ok(Style::Surface),
            "discs" => Ok(Style::Discs),
            word => Err(unknown("style", word, "\"surface\" or \"discs\"")),
        };
        let background = match &self.background[..] {
            "dark" => Ok(Background::Dark),
            "light" => Ok(Background::Light),
            word => Err(unknown("background", word, "\"dark\" or \"light\"")),
        };
        let known = "\"material\", \"speed\", \"density\" or \"temperature\"";
        Ok(RenderOptions {
            width: self.width,
            color_by: color_by.ok_or_else(|| unknown("color_by", &self.color_by, known))?,
            style: style?,
            background: background?,
            view: self.view.map(|(min, max)| View { min, max }),
            time_stamp: if self.time_stamp { TimeStamp::Shown } else { TimeStamp::Hidden },
            ..RenderOptions::default()
        })
    }
}

/// Draws the present frame and hands the picture to `take`.
fn draw<T: Send>(py: Python<'_>, world: &World, look: &Look, take: impl FnOnce(&Image) -> T + Send) -> PyResult<T> {
    let options = look.options()?;
    let drawn = py.detach(|| {
        let mut renderer = Renderer::new(&world.setting(), options);
        renderer.draw(&world.running.snapshot(Fields::ALL)).map(take)
    });
    drawn.map_err(|error| errors::other(py, &error.to_string()))
}

/// The picture as the bytes of a PNG file.
pub fn png(py: Python<'_>, world: &World, look: &Look) -> PyResult<Vec<u8>> {
    draw(py, world, look, |image| png_bytes(image, ""))
}

/// The picture as an array (height, width, 3).
pub fn pixels<'py>(py: Python<'py>, world: &World, look: &Look) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let (shape, rgb) =
        draw(py, world, look, |image| ((image.height() as usize, image.width() as usize, 3), image.to_rgb()))?;
    let array = Array3::from_shape_vec(shape, rgb).map_err(|error| errors::other(py, &error.to_string()))?;
    Ok(PyArray3::from_owned_array(py, array))
}
