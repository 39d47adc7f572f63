//! Arrows for velocities of particles and forces on bodies, and the key that tells their length.

use std::collections::BTreeMap;

use tiny_skia::PathBuilder;
use unipbd_core::math::Vector64;
use unipbd_core::phase::Phase;

use super::color::{self, Rgb};
use super::error::RenderError;
use super::labels::{number, plate, round_length};
use super::options::Vectors;
use super::paper::Paper;
use super::text::{self, Align, Lettering};
use super::theme::Theme;
use super::view::Camera;
use crate::snapshot::Snapshot;

/// Side of a square with one arrow, in a picture 960 pixels wide.
const CELL: f32 = 30.0;
/// Length of the longest arrow of velocity, in sides of a square.
const LONGEST: f32 = 1.5;
/// Length of the longest arrow of force, as a part of the width.
const LONGEST_FORCE: f32 = 0.16;

/// Data of the arrows of one picture.
pub(super) struct Arrows<'a> {
    pub vectors: Vectors,
    /// The number that the longest arrow stands for [m/s], \[N]; left out, that of the frame.
    pub longest: Option<f64>,
    pub frame: &'a Snapshot,
    pub camera: &'a Camera,
    pub theme: &'a Theme,
    pub spacing: f64,
    /// Size of lines.
    pub scale: f32,
}

/// An arrow before it has a length in pixels.
struct Arrow {
    from: Vector64,
    vector: Vector64,
    color: Rgb,
}

impl Arrows<'_> {
    /// Draws the arrows and their key.
    pub fn draw(&self, paper: &mut dyn Paper) -> Result<(), RenderError> {
        let arrows = self.arrows()?;
        let longest = self.longest.unwrap_or_else(|| most(&arrows)).max(1e-12);
        let length = match self.vectors {
            Vectors::Velocity => LONGEST * self.cell(),
            Vectors::Force => LONGEST_FORCE * self.camera.size[0] as f32,
        };
        let pixels = f64::from(length) / longest;
        for arrow in &arrows {
            let [x, y] = self.camera.pixel(arrow.from);
            let way = [(arrow.vector.x * pixels) as f32, -(arrow.vector.y * pixels) as f32];
            let inside = |at: f32, axis: usize| (0.0..=self.camera.size[axis] as f32).contains(&at);
            if inside(x, 0) && inside(y, 1) {
                self.arrow(paper, [x, y], way, arrow.color);
            }
        }
        self.key(paper, round_length(longest), pixels);
        Ok(())
    }

    /// The number that the longest arrow of this frame stands for.
    pub fn longest_of_frame(&self) -> Result<f64, RenderError> {
        self.arrows().map(|arrows| most(&arrows))
    }

    fn arrows(&self) -> Result<Vec<Arrow>, RenderError> {
        match self.vectors {
            Vectors::Velocity => self.velocities(),
            Vectors::Force => self.forces(),
        }
    }

    /// Side of a square [pixels]: never so small that it holds less than a few particles.
    fn cell(&self) -> f32 {
        (CELL * self.scale).max(2.0 * self.camera.length(self.spacing))
    }

    /// The mean velocity of the particles in each square, and the velocity of each body.
    fn velocities(&self) -> Result<Vec<Arrow>, RenderError> {
        let velocities = self.frame.velocities.as_ref().ok_or(RenderError::NoVelocities)?;
        let side = f64::from(self.cell()) / self.camera.scale;
        let mut squares: BTreeMap<[i64; 2], (Vector64, Vector64, f64)> = BTreeMap::new();
        let rows = self.frame.positions.iter().zip(velocities).zip(&self.frame.phases);
        for ((position, velocity), _) in rows.filter(|(_, phase)| **phase != Phase::Rigid) {
            let [position, velocity] = [position, velocity].map(|pair| Vector64::from(pair.map(f64::from)));
            if !(position.is_finite() && velocity.is_finite()) {
                continue;
            }
            let place = position.to_array().map(|x| (x / side).floor() as i64);
            let sums = squares.entry(place).or_default();
            *sums = (sums.0 + position, sums.1 + velocity, sums.2 + 1.0);
        }
        let color = self.theme.text;
        let of_square = |(from, vector, count): &(Vector64, Vector64, f64)| Arrow {
            from: *from / *count,
            vector: *vector / *count,
            color,
        };
        let bodies = self.frame.bodies.iter().filter(|body| !body.removed);
        let of_bodies = bodies.map(|body| Arrow { from: body.position, vector: body.velocity, color });
        Ok(squares.values().map(of_square).chain(of_bodies).collect())
    }

    /// The mean forces of fluids and of contacts on each body over the frame.
    fn forces(&self) -> Result<Vec<Arrow>, RenderError> {
        let bodies: Vec<_> = self.frame.bodies.iter().filter(|body| !body.removed).collect();
        if bodies.is_empty() {
            return Err(RenderError::NoBodies);
        }
        let [fluid, contact] = self.force_colors();
        let both = bodies.iter().flat_map(|body| {
            [(body.fluid_force, fluid), (body.contact_force, contact)].map(|(vector, color)| Arrow {
                from: body.position,
                vector,
                color,
            })
        });
        Ok(both.collect())
    }

    fn force_colors(&self) -> [Rgb; 2] {
        [[92, 190, 255], [255, 196, 84]].map(|color| self.theme.visible(color))
    }

    /// One arrow, `way` long and wide [pixels]; none where it would be a dot.
    fn arrow(&self, paper: &mut dyn Paper, [x, y]: [f32; 2], way: [f32; 2], color: Rgb) {
        let length = way[0].hypot(way[1]);
        if length.is_nan() || length < 2.5 * self.scale {
            return;
        }
        let [ux, uy] = [way[0] / length, way[1] / length];
        let head = (7.0 * self.scale).min(0.5 * length);
        let [tip_x, tip_y] = [x + way[0], y + way[1]];
        let [neck_x, neck_y] = [tip_x - ux * head, tip_y - uy * head];
        let rim = color::mix(color, self.theme.background, 0.85);
        let width = 1.5 * self.scale;
        paper.line(&[[x, y], [neck_x, neck_y]], rim, width + 1.6 * self.scale);
        let mut path = PathBuilder::new();
        path.move_to(tip_x, tip_y);
        path.line_to(neck_x - uy * 0.42 * head, neck_y + ux * 0.42 * head);
        path.line_to(neck_x + uy * 0.42 * head, neck_y - ux * 0.42 * head);
        path.close();
        let Some(path) = path.finish() else { return };
        paper.stroke(&path, rim, 1.6 * self.scale);
        paper.line(&[[x, y], [neck_x, neck_y]], color, width);
        paper.fill(&path, color, 1.0);
    }

    /// Arrows of a round length with their number, on a plate in the lower left corner.
    fn key(&self, paper: &mut dyn Paper, value: f64, pixels: f64) {
        let lines: Vec<(String, Rgb)> = match self.vectors {
            Vectors::Velocity => vec![(format!("{} m/s", number(value, value)), self.theme.text)],
            Vectors::Force => {
                let label = |what: &str| format!("{} N {what}", number(value, value));
                [label("of fluids"), label("of contacts")].into_iter().zip(self.force_colors()).collect()
            }
        };
        let [height, line, pad] = [10.0 * self.scale, 19.0 * self.scale, 8.0 * self.scale];
        let length = (value * pixels) as f32;
        let widest = lines.iter().map(|(label, _)| text::width(label, height)).fold(0.0, f32::max);
        let [left, bottom] = [20.0 * self.scale, self.camera.size[1] as f32 - 18.0 * self.scale];
        let top = bottom - line * (lines.len() - 1) as f32 - height;
        let right = left + length + 1.2 * height + widest;
        plate(paper, [left - pad, top - pad, right + pad, bottom + pad], self.theme);
        for (row, (label, color)) in lines.iter().enumerate() {
            let base = top + height + line * row as f32;
            self.arrow(paper, [left, base - 0.5 * height], [length, 0.0], *color);
            let lettering =
                Lettering { height, align: Align::Left, color: self.theme.text, halo: self.theme.background };
            text::draw(paper, label, [left + length + 1.2 * height, base], lettering);
        }
    }
}

/// The longest of all but one in fifty: single drops that fly must not make dots of all others.
fn most(arrows: &[Arrow]) -> f64 {
    let mut lengths: Vec<f64> = arrows.iter().map(|arrow| arrow.vector.length()).filter(|l| l.is_finite()).collect();
    lengths.sort_unstable_by(f64::total_cmp);
    lengths.len().checked_sub(1 + lengths.len() / 50).map_or(0.0, |place| lengths[place])
}
