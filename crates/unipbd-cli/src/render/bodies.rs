use tiny_skia::PathBuilder;
use unipbd_core::math::Vector64;
use unipbd_core::rigid::{Body, BodyKind};

use super::color::{self, Rgb};
use super::paper::Paper;
use super::theme::Theme;
use super::view::Camera;
use super::walls::{fill, line, polygon, stroke};

/// Draws a body as a filled shape with an edge and a mark that turns with it.
pub(super) fn draw(paper: &mut dyn Paper, body: &Body, color: Rgb, camera: &Camera, spacing: f32, scale: f32) {
    let edge = color::mix(color, [255; 3], 0.45);
    let mark = color::mix(color, [0; 3], 0.45);
    let rotation = Vector64::from_angle(body.angle);
    let place = |point: Vector64| body.position + rotation.rotate(point);
    if body.radius > 0.0 {
        let [x, y] = camera.pixel(body.position);
        fill(paper, PathBuilder::from_circle(x, y, camera.length(body.radius)), color);
        let spoke = [place(Vector64::ZERO), place(Vector64::new(0.72 * body.radius, 0.0))];
        stroke(paper, line(&spoke, false, camera), mark, (0.10 * camera.length(body.radius)).max(1.5 * scale));
        stroke(paper, PathBuilder::from_circle(x, y, camera.length(body.radius)), edge, 1.6 * scale);
    } else if body.outline.len() >= 3 {
        let corners: Vec<Vector64> = body.outline.iter().map(|point| place(*point)).collect();
        fill(paper, polygon(&corners, camera), color);
        let inner = body.outline.iter().map(|point| point.length()).fold(f64::INFINITY, f64::min);
        let [x, y] = camera.pixel(place(body.outline[0] * 0.62));
        paper.disc([x, y], (0.10 * camera.length(inner)).max(1.6 * scale), mark, 1.0);
        stroke(paper, polygon(&corners, camera), edge, 1.6 * scale);
    } else {
        for sample in &body.samples {
            paper.disc(camera.pixel(place(*sample)), 0.55 * spacing, color, 1.0);
        }
    }
}

/// The colour of body number `index`.
pub(super) fn color(body: &Body, index: usize, theme: &Theme) -> Rgb {
    match body.kind {
        BodyKind::Static => theme.fixed_body,
        BodyKind::Dynamic | BodyKind::Kinematic => theme.bodies[index % theme.bodies.len()],
    }
}
