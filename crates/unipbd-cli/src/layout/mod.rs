//! A layout of Lichtblick and Foxglove that frames the scene of a log.

use serde_json::{Value, json};

use crate::render::View;
use crate::snapshot::Setting;

/// Panels, plots and the look of the view, without what depends on the scene.
const TEMPLATE: &str = include_str!("template.json");
const VIEW_PANEL: &str = "3D!unipbd";
/// Width of the view over its height, in a window of 16:9 with the plots beside it.
const ASPECT: f64 = 1.2;
/// Height of the view in such a window [pixels].
const HEIGHT: f64 = 850.0;
/// The part of the view that the scene fills.
const FILLED: f64 = 0.95;

/// The layout for a scene of which this region shall be seen, with the topics and gauges that the log has.
pub fn layout(setting: &Setting, view: View, topics: &[String], gauges: &[String]) -> Value {
    let mut layout: Value = serde_json::from_str(TEMPLATE).unwrap_or_default();
    let panel = &mut layout["configById"][VIEW_PANEL];
    let [width, height] = [0, 1].map(|axis| view.max[axis] - view.min[axis]);
    let [x, y] = [0, 1].map(|axis| 0.5 * (view.max[axis] + view.min[axis]));
    // The camera looks along z without perspective: its distance is the height of what is visible.
    let distance = height.max(width / ASPECT) / FILLED;
    panel["cameraState"]["distance"] = json!(distance);
    panel["cameraState"]["targetOffset"] = json!([x, y, 0.0]);
    let size = (setting.spacing / distance * HEIGHT).clamp(1.0, 30.0);
    for topic in topics {
        let look = match topic.as_str() {
            "/particles" => cloud(true, size),
            "/boundary" | "/bodies/samples" => cloud(false, size),
            "/scene" => json!({ "visible": true }),
            _ => continue,
        };
        panel["topics"][topic] = look;
    }
    if !gauges.is_empty() {
        add_gauges(&mut layout, gauges);
    }
    layout
}

/// Puts a plot of the gauges above the other plots.
fn add_gauges(layout: &mut Value, gauges: &[String]) {
    let mut plot = layout["configById"]["Plot!error"].clone();
    let like = plot["paths"][0].take();
    let path = |name: &String| {
        let mut path = like.clone();
        (path["value"], path["label"]) = (format!("/gauges.{name}").into(), name.as_str().into());
        path
    };
    plot["paths"] = gauges.iter().map(path).collect();
    for title in ["foxglovePanelTitle", "lichtblickPanelTitle"] {
        plot[title] = "Gauges".into();
    }
    layout["configById"]["Plot!gauges"] = plot;
    let below = layout["layout"]["second"].take();
    layout["layout"]["second"] =
        json!({ "direction": "column", "splitPercentage": 30, "first": "Plot!gauges", "second": below });
}

fn cloud(visible: bool, size: f64) -> Value {
    json!({
        "visible": visible,
        "colorMode": "rgba-fields",
        "pointShape": "circle",
        "pointSize": (10.0 * size).round() / 10.0,
        "decayTime": 0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_camera_frames_the_region_and_points_are_as_large_as_the_spacing() {
        let setting = Setting { spacing: 0.02, ..Setting::default() };
        let view = View { min: [-1.0, 0.0], max: [5.0, 2.0] };
        let topics = ["/particles", "/scene", "/tf"].map(String::from);
        let layout = layout(&setting, view, &topics, &[]);
        let panel = &layout["configById"][VIEW_PANEL];
        let distance = panel["cameraState"]["distance"].as_f64().unwrap();
        assert!(distance * ASPECT >= 6.0 && (2.0..6.0).contains(&distance), "{distance}");
        assert_eq!(panel["cameraState"]["targetOffset"], json!([2.0, 1.0, 0.0]));
        assert_eq!(panel["cameraState"]["perspective"], json!(false));
        let size = panel["topics"]["/particles"]["pointSize"].as_f64().unwrap();
        assert!((size * distance / HEIGHT - 0.02).abs() < 0.001, "{size} pixels");
        assert_eq!(panel["topics"].as_object().unwrap().len(), 2);
        assert_eq!(panel["scene"]["transforms"]["axisScale"], json!(0));
    }
}
