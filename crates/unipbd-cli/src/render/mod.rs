//! Frames to pictures and films.
//!
//! [`Renderer`] draws a [`Snapshot`](crate::snapshot::Snapshot), [`encode`] writes pictures to files,
//! [`run`] does both for all chosen frames of a run.

pub mod color;
pub mod encode;

mod axes;
mod bodies;
mod color_by;
mod error;
mod field;
mod fluids;
mod image;
mod job;
mod labels;
mod options;
mod output;
mod paper;
mod plot;
mod renderer;
mod replay;
mod scalar;
mod select;
mod sheet;
mod speeds;
mod survey;
mod text;
mod theme;
mod vector;
mod view;
mod walls;

pub use color_by::ColorBy;
pub use error::RenderError;
pub use image::Image;
pub use job::{Existing, RenderJob, Rendered, run};
pub use options::{Annotations, Background, Range, RenderOptions, Style, TimeStamp};
pub use output::{Numbered, Output, plan_output};
pub use plot::{Curve, PlotOptions, write_plot};
pub use renderer::Renderer;
pub use select::Selection;
pub use speeds::Speeds;
pub use survey::Survey;
pub use view::View;
