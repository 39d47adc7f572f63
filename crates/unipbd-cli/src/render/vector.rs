//! Stills for print: the same scene as vectors.

use unipbd_core::phase::Phase;

use super::arrows::Arrows;
use super::color::Rgb;
use super::error::RenderError;
use super::options::{RenderOptions, TimeStamp};
use super::renderer::{legend, size_of_lines};
use super::scalar::Scalar;
use super::sheet::Sheet;
use super::theme::Theme;
use super::view::{Camera, View};
use super::walls::{Wall, region};
use super::{axes, bodies, fluids, labels};
use crate::snapshot::{Setting, Snapshot};

/// Draws a frame as vectors: a disc per particle whatever the style, gas and smoke as pale ones.
pub(super) fn draw(setting: &Setting, options: &RenderOptions, frame: &Snapshot) -> Result<Sheet, RenderError> {
    let of_scene = setting.view.map(|(min, max)| View { min, max });
    let view = options.view.or(of_scene).unwrap_or_else(|| View::fit(setting, [frame]));
    let camera = Camera::new(view, options.width)?;
    let scalar = match Scalar::new(options.color_by, options.range) {
        Some(mut scalar) => {
            scalar.read(frame)?;
            Some(scalar)
        }
        None => None,
    };
    let still = Still { setting, options, frame, camera, theme: Theme::of(options.background), scalar };
    still.sheet()
}

struct Still<'a> {
    setting: &'a Setting,
    options: &'a RenderOptions,
    frame: &'a Snapshot,
    camera: Camera,
    theme: Theme,
    scalar: Option<Scalar>,
}

impl Still<'_> {
    fn sheet(&self) -> Result<Sheet, RenderError> {
        let (theme, scale, annotations) = (&self.theme, size_of_lines(self.options.width), self.options.annotations);
        let margins = annotations.axes.then(|| axes::Margins::new(scale));
        let (left, below, beside) = margins.map_or((0, 0, 0), |margins| (margins.left, margins.below, margins.beside));
        let strip = if self.scalar.is_some() { labels::strip_height(scale) } else { 0 };
        let region = self.camera.size.map(|length| length as f32);
        let [width, height] = region;
        let size = [width + (left + beside) as f32, height + (below + strip) as f32];
        let mut sheet = Sheet::new(size, theme.background);
        if let Some(margins) = margins {
            axes::draw(&mut sheet, &self.camera, margins, theme, scale);
        }
        // Labels place themselves by the size of their own layer.
        sheet.start_layer([left as f32, 0.0], Some(region));
        self.draw_particles(&mut sheet);
        self.draw_solids(&mut sheet, scale);
        if let Some(vectors) = self.options.vectors {
            let (longest, spacing) = (self.options.longest_vector, self.setting.spacing);
            let (frame, camera) = (self.frame, &self.camera);
            Arrows { vectors, longest, frame, camera, theme, spacing, scale }.draw(&mut sheet)?;
        }
        if annotations.scale_bar {
            labels::scale_bar(&mut sheet, self.camera.size[1], self.camera.scale, theme, scale);
        }
        if annotations.legend {
            let entries = legend(self.setting, self.frame, &self.colors(), self.scalar.is_some(), theme);
            labels::legend(&mut sheet, &entries, theme, scale);
        }
        if self.options.time_stamp == TimeStamp::Shown {
            labels::time_stamp(&mut sheet, self.frame.time, theme, scale);
        }
        if let Some(scalar) = &self.scalar {
            sheet.start_layer([left as f32, height + below as f32], Some([width, strip as f32]));
            labels::color_bar(&mut sheet, scalar, 0, theme, scale);
        }
        Ok(sheet)
    }

    fn colors(&self) -> Vec<Rgb> {
        fluids::material_colors(self.setting, &self.theme)
    }

    fn draw_particles(&self, sheet: &mut Sheet) {
        use super::paper::Paper;
        let (frame, colors) = (self.frame, self.colors());
        let radius = 0.55 * self.camera.length(self.setting.spacing);
        let has_shapes = !frame.bodies.is_empty();
        let layers: [(fn(Phase) -> bool, f32); 3] = [
            (|phase| phase == Phase::Gas, 0.16),
            (|phase| !matches!(phase, Phase::Gas | Phase::Smoke), 1.0),
            (|phase| phase == Phase::Smoke, 0.4),
        ];
        let walls: Vec<Wall> =
            self.setting.walls.iter().filter_map(|outline| Wall::new(outline, &self.camera)).collect();
        let region = region(&walls, &self.camera);
        for (passes, opacity) in layers {
            // Soft phases alone: bodies and liquids behind a wall shall be seen.
            let soft = passes(Phase::Gas) || passes(Phase::Smoke);
            sheet.cut_to(region.clone().filter(|_| soft));
            let rows = (0..frame.positions.len()).filter(|&row| passes(frame.phases[row]));
            for row in rows.filter(|&row| !has_shapes || frame.phases[row] != Phase::Rigid) {
                let material = colors.get(usize::from(frame.materials[row])).copied();
                let (color, opacity) = match &self.scalar {
                    Some(scalar) if scalar.applies_to(frame.phases[row]) => {
                        (scalar.map.color(scalar.fraction(row)), 1.0)
                    }
                    Some(_) => continue,
                    None => (material.unwrap_or(self.theme.faint_text), opacity),
                };
                let center = self.camera.particle(frame.positions[row]);
                // Discs outside the picture are left out of the file.
                if (0..2).all(|axis| (-radius..=self.camera.size[axis] as f32 + radius).contains(&center[axis])) {
                    sheet.disc(center, radius, color, opacity);
                }
            }
        }
        sheet.cut_to(None);
    }

    fn draw_solids(&self, sheet: &mut Sheet, scale: f32) {
        let (camera, theme) = (&self.camera, &self.theme);
        let spacing = camera.length(self.setting.spacing);
        for (index, body) in self.frame.bodies.iter().enumerate().filter(|(_, body)| !body.removed) {
            bodies::draw(sheet, body, bodies::color(body, index, theme), camera, spacing, scale);
        }
        for outline in &self.setting.walls {
            if let Some(wall) = Wall::new(outline, camera) {
                wall.draw(sheet, camera, theme, scale);
            }
        }
    }
}
