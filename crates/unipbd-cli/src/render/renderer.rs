use tiny_skia::{FillRule, Mask, Transform};
use unipbd_core::phase::Phase;

use super::arrows::Arrows;
use super::axes::Framed;
use super::color::Rgb;
use super::error::RenderError;
use super::field::Field;
use super::fluids::{Scope, liquid_colors, material_colors};
use super::image::Image;
use super::options::{RenderOptions, Style, TimeStamp};
use super::scalar::Scalar;
use super::theme::Theme;
use super::view::{Camera, View};
use super::walls::{Wall, region};
use super::{bodies, labels};
use crate::snapshot::{Setting, Snapshot};

/// Most lines of a legend.
const MOST_ENTRIES: usize = 12;

/// Data that are settled once the view is known.
struct Canvas {
    camera: Camera,
    walls: Vec<Wall>,
    /// The region that closed walls surround.
    mask: Option<Mask>,
    image: Image,
    /// The image within its axes.
    framed: Option<Framed>,
}

/// Draws frames of one run, keeping its buffers from frame to frame.
pub struct Renderer {
    setting: Setting,
    options: RenderOptions,
    theme: Theme,
    colors: Vec<Rgb>,
    liquids: Vec<[f32; 3]>,
    scalar: Option<Scalar>,
    canvas: Option<Canvas>,
    field: Field,
}

impl Renderer {
    /// A renderer for the frames of a run.
    pub fn new(setting: &Setting, options: RenderOptions) -> Renderer {
        let theme = Theme::of(options.background);
        Renderer {
            colors: material_colors(setting, &theme),
            liquids: liquid_colors(setting, &theme),
            scalar: Scalar::new(options.color_by, options.range),
            setting: setting.clone(),
            options,
            theme,
            canvas: None,
            field: Field::default(),
        }
    }

    /// Draws a frame; the picture is valid until the next one is drawn.
    pub fn draw(&mut self, frame: &Snapshot) -> Result<&Image, RenderError> {
        if let Some(scalar) = &mut self.scalar {
            scalar.read(frame)?;
        }
        let scale = self.scale();
        let mut canvas = match self.canvas.take() {
            Some(canvas) => canvas,
            None => self.new_canvas(frame)?,
        };
        canvas.image.fill(self.theme.background);
        self.draw_particles(&mut canvas, frame);
        self.draw_solids(&mut canvas, frame);
        if let Some(vectors) = self.options.vectors {
            let (longest, theme, spacing) = (self.options.longest_vector, &self.theme, self.setting.spacing);
            let camera = &canvas.camera;
            Arrows { vectors, longest, frame, camera, theme, spacing, scale }.draw(&mut canvas.image)?;
        }
        if let Some(scalar) = &self.scalar {
            labels::color_bar(&mut canvas.image, scalar, canvas.camera.size[1], &self.theme, scale);
        }
        if self.options.time_stamp == TimeStamp::Shown {
            labels::time_stamp(&mut canvas.image, frame.time, &self.theme, scale);
        }
        let annotations = self.options.annotations;
        let [rows, metre] = [canvas.camera.size[1] as f64, canvas.camera.scale];
        if annotations.scale_bar {
            labels::scale_bar(&mut canvas.image, rows as u32, metre, &self.theme, scale);
        }
        if annotations.legend {
            let entries = legend(&self.setting, frame, &self.colors, self.scalar.is_some(), &self.theme);
            labels::legend(&mut canvas.image, &entries, &self.theme, scale);
        }
        let canvas = self.canvas.insert(canvas);
        Ok(match &mut canvas.framed {
            Some(framed) => framed.show(&canvas.image),
            None => &canvas.image,
        })
    }

    fn scale(&self) -> f32 {
        size_of_lines(self.options.width)
    }

    fn new_canvas(&self, frame: &Snapshot) -> Result<Canvas, RenderError> {
        let of_scene = self.setting.view.map(|(min, max)| View { min, max });
        let view = self.options.view.or(of_scene).unwrap_or_else(|| View::fit(&self.setting, [frame]));
        let camera = Camera::new(view, self.options.width)?;
        let strip = if self.scalar.is_some() { labels::strip_height(self.scale()) } else { 0 };
        let image = Image::new(camera.size[0], camera.size[1].saturating_add(strip), self.theme.background)?;
        let walls: Vec<Wall> = self.setting.walls.iter().filter_map(|outline| Wall::new(outline, &camera)).collect();
        let mask = region(&walls, &camera).and_then(|path| {
            let mut mask = Mask::new(camera.size[0], camera.size[1])?;
            mask.fill_path(&path, FillRule::Winding, true, Transform::identity());
            Some(mask)
        });
        let framed = match self.options.annotations.axes {
            true => Some(Framed::new(&camera, &image, &self.theme, self.scale())?),
            false => None,
        };
        Ok(Canvas { camera, walls, mask, image, framed })
    }

    fn draw_particles(&mut self, canvas: &mut Canvas, frame: &Snapshot) {
        let Canvas { camera, walls, mask, image, .. } = canvas;
        let spacing = camera.length(self.setting.spacing);
        let (colors, liquids) = (&self.colors[..], &self.liquids[..]);
        let mask = mask.as_ref();
        let scope = Scope { frame, camera, theme: &self.theme, colors, liquids, walls, mask, spacing };
        let field = &mut self.field;
        let has_shapes = !frame.bodies.is_empty();
        match (&self.scalar, self.options.style) {
            (Some(scalar), Style::Surface) => scope.scalar_surface(image, field, scalar),
            (Some(scalar), Style::Discs) => scope.scalar_discs(image, scalar),
            (None, style) => {
                match style {
                    Style::Surface => scope.gas(image, field),
                    Style::Discs => scope.discs(image, |phase| phase == Phase::Gas, 0.16),
                }
                match style {
                    Style::Surface => scope.surface(image, field, |phase| phase == Phase::Liquid),
                    Style::Discs => scope.discs(image, |phase| phase == Phase::Liquid, 1.0),
                }
                // Over liquids too: smoke in a liquid is its dye.
                scope.smoke(image, field);
                scope.discs(image, |phase| phase == Phase::Solid, 1.0);
            }
        }
        scope.discs(image, |phase| phase == Phase::Rigid && !has_shapes, 1.0);
    }

    fn draw_solids(&self, canvas: &mut Canvas, frame: &Snapshot) {
        let Canvas { camera, walls, image, .. } = canvas;
        let [scale, spacing] = [self.scale(), camera.length(self.setting.spacing)];
        for (index, body) in frame.bodies.iter().enumerate() {
            bodies::draw(image, body, bodies::color(body, index, &self.theme), camera, spacing, scale);
        }
        for wall in walls {
            wall.draw(image, camera, &self.theme, scale);
        }
    }
}

/// Size of lines and letters relative to a picture 960 pixels wide.
pub(super) fn size_of_lines(width: u32) -> f32 {
    (width as f32 / 960.0).clamp(0.55, 4.0)
}

/// Materials that their colours tell apart, and bodies by their names; those with one name and different numbers once.
pub(super) fn legend(
    setting: &Setting,
    frame: &Snapshot,
    colors: &[Rgb],
    by_number: bool,
    theme: &Theme,
) -> Vec<(Rgb, String)> {
    let there = |index: usize| frame.materials.iter().any(|material| usize::from(*material) == index);
    let named = setting.materials.iter().zip(colors).enumerate();
    let shown = named.filter(|(index, (material, _))| !by_number && material.phase != Phase::Rigid && there(*index));
    let mut entries: Vec<(Rgb, String)> = shown.map(|(_, (of, color))| (*color, of.name.clone())).collect();
    for (index, body) in frame.bodies.iter().enumerate().filter(|(_, body)| !body.removed) {
        let name = body.name.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end();
        if !name.is_empty() && !entries.iter().any(|(_, other)| other == name) && entries.len() < MOST_ENTRIES {
            entries.push((bodies::color(body, index, theme), name.to_owned()));
        }
    }
    entries
}
