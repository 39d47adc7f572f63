//! Description of the scene of a page.

use serde_json::{Value, json};
use unipbd_core::phase::Phase;
use unipbd_core::rigid::Body;

use super::motion::Motion;
use crate::render::color::{self, ColorMap, css};
use crate::render::fluids::material_colors;
use crate::render::options::RenderOptions;
use crate::render::theme::Theme;
use crate::render::view::Camera;
use crate::render::walls::Wall;
use crate::render::{View, bodies};
use crate::snapshot::Setting;

/// Colours of the ramp that numbers run through.
const RAMP: u8 = 64;

pub(super) struct Description<'a> {
    pub setting: &'a Setting,
    pub options: &'a RenderOptions,
    pub motion: &'a Motion,
    pub times: &'a [f64],
    pub bodies: &'a [Body],
}

impl Description<'_> {
    pub fn json(&self, columns: Vec<Value>) -> Value {
        let theme = Theme::of(self.options.background);
        let map = ColorMap::sequential();
        let ramp: Vec<String> = (0..RAMP).map(|k| css(map.color(f32::from(k) / f32::from(RAMP - 1)))).collect();
        let view = self.options.view.unwrap_or(View { min: [0.0; 2], max: [1.0; 2] });
        json!({
            "name": self.setting.name,
            "spacing": self.setting.spacing,
            "view": [view.min[0], view.min[1], view.max[0], view.max[1]],
            "middle": self.motion.middle,
            "quantum": self.motion.quantum,
            "times": self.times,
            "background": css(theme.background),
            "text": css(theme.text),
            "materials": self.materials(&theme),
            "layers": self.layers(),
            "ramp": ramp,
            "columns": columns,
            // The region that closed walls surround: soft layers are cut to it.
            "region": self.region(view),
            "walls": {
                "color": css(theme.wall_line),
                "lines": self.setting.walls.iter().map(|wall| json!({
                    "points": wall.points.iter().map(|point| point.to_array()).collect::<Vec<_>>(),
                    "closed": wall.closed,
                })).collect::<Vec<_>>(),
            },
            "bodies": self.bodies.iter().enumerate().map(|(index, body)| body_json(body, index, &theme)).collect::<Vec<_>>(),
        })
    }

    fn materials(&self, theme: &Theme) -> Vec<Value> {
        let colors = material_colors(self.setting, theme);
        let named = self.setting.materials.iter().zip(colors);
        named.map(|(material, color)| json!({ "name": material.name, "color": css(color) })).collect()
    }

    fn region(&self, view: View) -> Vec<Vec<[f64; 2]>> {
        let Ok(camera) = Camera::new(view, self.options.width) else { return Vec::new() };
        let walls = self.setting.walls.iter().filter_map(|outline| Wall::new(outline, &camera));
        let corners = |wall: Wall| Some(wall.inside()?.iter().map(|point| point.to_array()).collect());
        walls.filter_map(corners).collect()
    }

    /// Materials that are drawn one after the other: gas is a veil below all, smoke a veil above.
    fn layers(&self) -> Vec<Value> {
        let of = |passes: fn(Phase) -> bool, opacity: f64| {
            let all = self.setting.materials.iter().enumerate();
            let chosen: Vec<usize> = all.filter(|(_, of)| passes(of.phase)).map(|(index, _)| index).collect();
            json!({ "materials": chosen, "opacity": opacity, "soft": passes(Phase::Gas) || passes(Phase::Smoke) })
        };
        let solid = |phase| !matches!(phase, Phase::Gas | Phase::Smoke | Phase::Rigid);
        vec![of(|phase| phase == Phase::Gas, 0.18), of(solid, 1.0), of(|phase| phase == Phase::Smoke, 0.35)]
    }
}

fn body_json(body: &Body, index: usize, theme: &Theme) -> Value {
    let fill = bodies::color(body, index, theme);
    json!({
        "radius": body.radius,
        "outline": body.outline.iter().map(|point| point.to_array()).collect::<Vec<_>>(),
        "color": css(fill),
        "edge": css(color::mix(fill, [255; 3], 0.45)),
    })
}
