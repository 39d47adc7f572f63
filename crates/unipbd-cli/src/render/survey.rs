use super::arrows::Arrows;
use super::color_by::ColorBy;
use super::error::RenderError;
use super::options::{Range, RenderOptions};
use super::renderer::size_of_lines;
use super::scalar::Scalar;
use super::theme::Theme;
use super::view::{Camera, Extent, View};
use crate::snapshot::{Setting, Snapshot};

/// A first pass over all frames, so that view and colours hold still over a film.
pub struct Survey<'a> {
    setting: &'a Setting,
    options: RenderOptions,
    extent: Extent,
    scalar: Option<Scalar>,
    /// The longest arrow so far.
    longest: f64,
}

impl<'a> Survey<'a> {
    /// Starts a pass for these options.
    pub fn new(setting: &'a Setting, options: RenderOptions) -> Survey<'a> {
        let scalar = Scalar::new(options.color_by, options.range);
        Survey { setting, options, extent: Extent::default(), scalar, longest: 0.0 }
    }

    /// Whether a pass would find out anything: whether view or range are still open.
    pub fn is_needed(setting: &Setting, options: &RenderOptions) -> bool {
        let view_open = options.view.is_none() && setting.view.is_none();
        let arrows_open = options.vectors.is_some() && options.longest_vector.is_none();
        view_open || arrows_open || (options.color_by != ColorBy::Material && options.range == Range::Automatic)
    }

    /// Takes a frame into account.
    pub fn include(&mut self, frame: &Snapshot) -> Result<(), RenderError> {
        self.extent.include_frame(frame, self.setting.spacing);
        self.include_arrows(frame)?;
        self.scalar.as_mut().map_or(Ok(()), |scalar| scalar.read(frame))
    }

    /// The squares of means are as large as those of the picture, as far as they are known.
    fn include_arrows(&mut self, frame: &Snapshot) -> Result<(), RenderError> {
        let Some(vectors) = self.options.vectors.filter(|_| self.options.longest_vector.is_none()) else {
            return Ok(());
        };
        let of_scene = self.setting.view.map(|(min, max)| View { min, max });
        let view = self.options.view.or(of_scene).unwrap_or_else(|| self.extent.view(self.setting));
        let camera = Camera::new(view, self.options.width)?;
        let theme = Theme::of(self.options.background);
        let (spacing, scale) = (self.setting.spacing, size_of_lines(self.options.width));
        let arrows = Arrows { vectors, longest: None, frame, camera: &camera, theme: &theme, spacing, scale };
        self.longest = self.longest.max(arrows.longest_of_frame()?);
        Ok(())
    }

    /// The options with view and range filled in.
    pub fn finish(self) -> RenderOptions {
        let mut options = self.options;
        if options.view.is_none() && self.setting.view.is_none() {
            options.view = Some(self.extent.view(self.setting));
        }
        if options.vectors.is_some() {
            options.longest_vector.get_or_insert(self.longest);
        }
        if let Some(scalar) = self.scalar {
            let [min, max] = scalar.ends();
            options.range = Range::Fixed { min, max };
        }
        options
    }
}
