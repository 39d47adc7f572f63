//! Layers made of particles: gas, smoke, liquids and other carriers, grains.

use tiny_skia::Mask;
use unipbd_core::math::Vector64;
use unipbd_core::phase::Phase;

use super::color::{self, Rgb};
use super::field::Field;
use super::image::Image;
use super::scalar::Scalar;
use super::theme::Theme;
use super::view::Camera;
use super::walls::Wall;
use crate::snapshot::{Setting, Snapshot};

/// Reach of a particle in a surface, in spacings: small enough that a lone particle stays about
/// its own size, large enough that particles a spacing apart leave no hole.
const SURFACE_REACH: f32 = 1.25;
/// Weight at the edge of a surface: that of a lone particle half a spacing away from it.
const SURFACE_EDGE: f32 = 0.70;
/// Change of the weight per spacing at the edge.
const SURFACE_SLOPE: f32 = 1.08;
/// Weight from which on a surface shows no bright edge.
const SURFACE_INSIDE: f32 = 1.12;

/// How far beyond a wall's edge a surface is drawn [pixels]: the line hides as much.
const WALL_COVER: f32 = 0.5;

/// Standard deviation of a smoke blob in spacings.
const SMOKE_SIGMA: f32 = 1.25;
/// Reach of a gas particle in spacings: wide, as gas has no surface.
const GAS_REACH: f32 = 1.8;
/// Weight from which on gas is as opaque as it gets; at rest density it is about 3.4.
const GAS_CLOSED: f32 = 1.6;
/// Largest opacity of gas that only hints at where it is.
const VEIL_OPACITY: f32 = 0.12;

/// Data of the frame for a layer.
#[derive(Clone, Copy)]
pub(super) struct Scope<'a> {
    pub frame: &'a Snapshot,
    pub camera: &'a Camera,
    pub theme: &'a Theme,
    /// Colours by material, made visible on the background.
    pub colors: &'a [Rgb],
    /// Colours of the liquids where there are several.
    pub liquids: &'a [[f32; 3]],
    pub walls: &'a [Wall],
    /// Mask to which gas and smoke are cut, of the size of the region.
    pub mask: Option<&'a Mask>,
    /// Spacing in pixels.
    pub spacing: f32,
}

impl Scope<'_> {
    fn color(&self, row: usize) -> Rgb {
        let material = self.frame.materials.get(row).map_or(usize::MAX, |index| usize::from(*index));
        self.colors.get(material).copied().unwrap_or(self.theme.faint_text)
    }

    /// Rows of the particles whose phase passes, with their places in pixels.
    pub fn rows(&self, passes: impl Fn(Phase) -> bool) -> impl Iterator<Item = (usize, [f32; 2])> {
        let both = self.frame.phases.iter().zip(&self.frame.positions).enumerate();
        both.filter(move |(_, (phase, _))| passes(**phase))
            .map(|(row, (_, position))| (row, self.camera.particle(*position)))
    }

    /// Discs that touch.
    pub fn discs(&self, image: &mut Image, passes: impl Fn(Phase) -> bool, opacity: f32) {
        for (row, center) in self.rows(passes) {
            image.disc(center, 0.55 * self.spacing, self.color(row), opacity);
        }
    }

    /// Discs that touch, coloured by a number.
    pub fn scalar_discs(&self, image: &mut Image, scalar: &Scalar) {
        for (row, center) in self.rows(|phase| scalar.applies_to(phase)) {
            image.disc(center, 0.55 * self.spacing, scalar.map.color(scalar.fraction(row)), 1.0);
        }
    }

    /// A closed body with an anti-aliased edge that is tinted.
    pub fn surface(&self, image: &mut Image, field: &mut Field, passes: impl Fn(Phase) -> bool) {
        self.gather(field, Shape::Surface, passes, |row| color::to_float(self.color(row)));
        let slope = self.edge_slope();
        let (tint, strength) = self.theme.rim;
        let tint = color::to_float(tint);
        field.lay_over(image, None, |mean, weight| {
            let inside = ((weight - SURFACE_EDGE) / (SURFACE_INSIDE - SURFACE_EDGE)).clamp(0.0, 1.0);
            let strength = strength * (1.0 - inside) * (1.0 - inside);
            let body = if self.liquids.len() > 1 { sharpened(mean, self.liquids) } else { mean };
            (std::array::from_fn(|k| body[k] + (tint[k] - body[k]) * strength), coverage(weight, slope))
        });
    }

    /// Closed bodies and soft-edged gas, coloured by the local mean of a number.
    pub fn scalar_surface(&self, image: &mut Image, field: &mut Field, scalar: &Scalar) {
        let paint = |mean: [f32; 3]| color::to_float(scalar.map.color(mean[0]));
        let value = |row| [scalar.fraction(row), 0.0, 0.0];
        let soft = |phase| matches!(phase, Phase::Gas | Phase::Smoke);
        self.gather(field, Shape::Gas, |phase| soft(phase) && scalar.applies_to(phase), value);
        field.lay_over(image, self.mask, |mean, weight| (paint(mean), closedness(weight)));
        self.gather(field, Shape::Surface, |phase| !soft(phase) && scalar.applies_to(phase), value);
        let slope = self.edge_slope();
        field.lay_over(image, None, |mean, weight| (paint(mean), coverage(weight, slope)));
    }

    /// A veil that shows where gas is and lets everything through.
    pub fn gas(&self, image: &mut Image, field: &mut Field) {
        self.gather(field, Shape::Gas, |phase| phase == Phase::Gas, |row| color::to_float(self.color(row)));
        field.lay_over(image, self.mask, |mean, weight| (mean, VEIL_OPACITY * closedness(weight)));
    }

    /// Soft blobs that add up, so that many look like smoke and not like grains.
    pub fn smoke(&self, image: &mut Image, field: &mut Field) {
        field.start(self.camera.size);
        let sigma = (SMOKE_SIGMA * self.spacing).max(0.7);
        let in_spacings = sigma / self.spacing.max(1e-6);
        let peak = 1.0 / (std::f32::consts::TAU * in_spacings * in_spacings);
        for (row, center) in self.rows(|phase| phase == Phase::Smoke) {
            field.add_gaussian(center, sigma, peak, color::to_float(self.color(row)));
        }
        field.lay_over(image, self.mask, smoke_paint);
    }

    fn gather(
        &self,
        field: &mut Field,
        shape: Shape,
        passes: impl Fn(Phase) -> bool,
        values: impl Fn(usize) -> [f32; 3],
    ) {
        field.start(self.camera.size);
        let spacings = match shape {
            Shape::Surface => SURFACE_REACH,
            Shape::Gas => GAS_REACH,
        };
        let reach = (spacings * self.spacing).max(1.0);
        let metres = f64::from(reach) / self.camera.scale;
        for (row, center) in self.rows(passes) {
            let values = values(row);
            field.add_compact(center, reach, values);
            // Mirror images keep the body closed up to the wall, whose line hides their cut.
            let [x, y] = self.frame.positions[row].map(f64::from);
            for wall in self.walls {
                wall.mirror(Vector64::new(x, y), metres, |mirrored, normal| {
                    let mirrored = self.camera.pixel(mirrored);
                    let [dx, dy] = [center[0] - mirrored[0], center[1] - mirrored[1]];
                    let normal = [normal.x as f32, -normal.y as f32];
                    let height = 0.5 * (dx * normal[0] + dy * normal[1]);
                    field.add_cut(mirrored, reach, values, normal, height - WALL_COVER);
                });
            }
        }
    }

    /// Pixels per unit of weight at the edge of a surface.
    fn edge_slope(&self) -> f32 {
        (self.spacing / SURFACE_SLOPE).max(1.0)
    }
}

/// Colour and opacity of smoke with `density` markers per square spacing. Scenes differ tenfold in
/// it, so opacity approaches 1 more slowly than absorption would have it, and dense smoke is brighter.
fn smoke_paint(mean: [f32; 3], density: f32) -> ([f32; 3], f32) {
    let brightness = 0.84 + 0.16 * density / (density + 2.0);
    (mean.map(|channel| channel * brightness), 1.0 - 1.0 / (1.0 + 1.5 * density))
}

/// The shape to which a blob belongs.
#[derive(Clone, Copy)]
enum Shape {
    Surface,
    Gas,
}

/// Opacity of gas, 0 to 1: rises smoothly from nothing.
fn closedness(weight: f32) -> f32 {
    let t = (weight / GAS_CLOSED).min(1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A mixed colour pulled towards the nearest of the colours it was mixed from, so that two liquids
/// meet in a line and not in a haze.
fn sharpened(mixed: [f32; 3], colors: &[[f32; 3]]) -> [f32; 3] {
    let mut sums = [1e-20; 4];
    for color in colors {
        let square = color.iter().zip(mixed).map(|(a, b)| (a - b) * (a - b)).sum::<f32>() + 1.0;
        let pull = 1.0 / (square * square);
        for k in 0..3 {
            sums[k] += pull * color[k];
        }
        sums[3] += pull;
    }
    std::array::from_fn(|k| sums[k] / sums[3])
}

fn coverage(weight: f32, slope: f32) -> f32 {
    (0.5 + (weight - SURFACE_EDGE) * slope).clamp(0.0, 1.0)
}

/// Colours of all materials, changed where they would sink into the background.
pub(super) fn material_colors(setting: &Setting, theme: &Theme) -> Vec<Rgb> {
    setting.materials.iter().map(|material| theme.visible(material.color)).collect()
}

/// The different colours among the liquids.
pub(super) fn liquid_colors(setting: &Setting, theme: &Theme) -> Vec<[f32; 3]> {
    let liquids = setting.materials.iter().filter(|material| material.phase == Phase::Liquid);
    let mut colors: Vec<Rgb> = liquids.map(|material| theme.visible(material.color)).collect();
    colors.sort();
    colors.dedup();
    colors.into_iter().map(color::to_float).collect()
}
