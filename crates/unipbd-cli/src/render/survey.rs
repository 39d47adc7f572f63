use super::color_by::ColorBy;
use super::error::RenderError;
use super::options::{Range, RenderOptions};
use super::scalar::Scalar;
use super::view::Extent;
use crate::snapshot::{Setting, Snapshot};

/// A first pass over all frames, so that view and colours hold still over a film.
pub struct Survey<'a> {
    setting: &'a Setting,
    options: RenderOptions,
    extent: Extent,
    scalar: Option<Scalar>,
}

impl<'a> Survey<'a> {
    /// Starts a pass for these options.
    pub fn new(setting: &'a Setting, options: RenderOptions) -> Survey<'a> {
        let scalar = Scalar::new(options.color_by, options.range);
        Survey { setting, options, extent: Extent::default(), scalar }
    }

    /// Whether a pass would find out anything: whether view or range are still open.
    pub fn is_needed(setting: &Setting, options: &RenderOptions) -> bool {
        let view_open = options.view.is_none() && setting.view.is_none();
        view_open || (options.color_by != ColorBy::Material && options.range == Range::Automatic)
    }

    /// Takes a frame into account.
    pub fn include(&mut self, frame: &Snapshot) -> Result<(), RenderError> {
        self.extent.include_frame(frame, self.setting.spacing);
        self.scalar.as_mut().map_or(Ok(()), |scalar| scalar.read(frame))
    }

    /// The options with view and range filled in.
    pub fn finish(self) -> RenderOptions {
        let mut options = self.options;
        if options.view.is_none() && self.setting.view.is_none() {
            options.view = Some(self.extent.view(self.setting));
        }
        if let Some(scalar) = self.scalar {
            let [min, max] = scalar.ends();
            options.range = Range::Fixed { min, max };
        }
        options
    }
}
