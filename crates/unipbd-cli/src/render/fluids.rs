//! Layers made of particles: gas, smoke, liquids and other carriers, grains.

use unipbd_core::phase::Phase;

use super::color::{self, Rgb};
use super::field::Field;
use super::image::Image;
use super::scalar::Scalar;
use super::theme::Theme;
use super::view::Camera;
use crate::snapshot::{Setting, Snapshot};

/// Reach of a particle in a surface, in spacings: small enough that a lone particle stays about
/// its own size, large enough that particles a spacing apart leave no hole.
const SURFACE_REACH: f32 = 1.25;
/// Weight at the edge of a surface: that of a lone particle half a spacing away from it.
const SURFACE_EDGE: f32 = 0.70;
/// Change of the weight per spacing at the edge.
const SURFACE_SLOPE: f32 = 1.08;
/// Weight from which on a surface shows no bright edge.
const SURFACE_INSIDE: f32 = 1.45;

/// Standard deviation of a smoke blob in spacings.
const SMOKE_SIGMA: f32 = 1.25;
/// Optical depth of smoke with one marker per square spacing.
const SMOKE_DEPTH: f32 = 0.9;

/// Opacity of gas where its surface is closed.
const GAS_OPACITY: f32 = 0.10;

/// What a layer needs to know of the frame.
#[derive(Clone, Copy)]
pub(super) struct Scope<'a> {
    pub frame: &'a Snapshot,
    pub camera: &'a Camera,
    pub theme: &'a Theme,
    /// Colours by material, made visible on the background.
    pub colors: &'a [Rgb],
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

    /// A closed body with an anti-aliased bright edge.
    pub fn surface(&self, image: &mut Image, field: &mut Field, passes: impl Fn(Phase) -> bool) {
        self.gather(field, passes, |row| color::to_float(self.color(row)));
        let slope = self.edge_slope();
        field.lay_over(image, |mean, weight| {
            let inside = ((weight - SURFACE_EDGE) / (SURFACE_INSIDE - SURFACE_EDGE)).clamp(0.0, 1.0);
            let bright = 0.42 * (1.0 - inside) * (1.0 - inside);
            (mean.map(|channel| channel + (255.0 - channel) * bright), coverage(weight, slope))
        });
    }

    /// A closed body coloured by the local mean of a number.
    pub fn scalar_surface(&self, image: &mut Image, field: &mut Field, scalar: &Scalar) {
        self.gather(field, |phase| scalar.applies_to(phase), |row| [scalar.fraction(row), 0.0, 0.0]);
        let slope = self.edge_slope();
        field.lay_over(image, |mean, weight| {
            (color::to_float(scalar.map.color(mean[0])), coverage(weight, slope))
        });
    }

    /// A veil that shows where gas is and lets everything through.
    pub fn gas(&self, image: &mut Image, field: &mut Field) {
        self.gather(field, |phase| phase == Phase::Gas, |row| color::to_float(self.color(row)));
        field.lay_over(image, |mean, weight| (mean, GAS_OPACITY * (weight / SURFACE_EDGE).min(1.0)));
    }

    /// Soft blobs whose optical depths add up, so that many look like smoke and not like grains.
    pub fn smoke(&self, image: &mut Image, field: &mut Field) {
        field.start(self.camera.size);
        let sigma = (SMOKE_SIGMA * self.spacing).max(0.7);
        let in_spacings = sigma / self.spacing.max(1e-6);
        let peak = SMOKE_DEPTH / (std::f32::consts::TAU * in_spacings * in_spacings);
        for (row, center) in self.rows(|phase| phase == Phase::Smoke) {
            field.add_gaussian(center, sigma, peak, color::to_float(self.color(row)));
        }
        field.lay_over(image, |mean, depth| (mean, 1.0 - (-depth).exp()));
    }

    fn gather(&self, field: &mut Field, passes: impl Fn(Phase) -> bool, values: impl Fn(usize) -> [f32; 3]) {
        field.start(self.camera.size);
        let reach = (SURFACE_REACH * self.spacing).max(1.0);
        for (row, center) in self.rows(passes) {
            field.add_compact(center, reach, values(row));
        }
    }

    /// Pixels per unit of weight at the edge of a surface.
    fn edge_slope(&self) -> f32 {
        (self.spacing / SURFACE_SLOPE).max(1.0)
    }
}

fn coverage(weight: f32, slope: f32) -> f32 {
    (0.5 + (weight - SURFACE_EDGE) * slope).clamp(0.0, 1.0)
}

/// Colours of all materials, changed where they would sink into the background.
pub(super) fn material_colors(setting: &Setting, theme: &Theme) -> Vec<Rgb> {
    setting.materials.iter().map(|material| theme.visible(material.color)).collect()
}
