use super::color_by::ColorBy;
use super::view::View;

/// How liquids and other carriers are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// A smooth filled body with a bright edge.
    #[default]
    Surface,
    /// A disc per particle.
    Discs,
}

/// The ground colour of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Background {
    /// Nearly black, for screens.
    #[default]
    Dark,
    /// Nearly white, for paper.
    Light,
}

/// The numbers at the two ends of the colour map, in the unit of the colour bar.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Range {
    /// Chosen from the frames drawn so far; widens where a later frame needs it.
    #[default]
    Automatic,
    /// Fixed.
    Fixed {
        /// Number at the lower end.
        min: f64,
        /// Number at the upper end.
        max: f64,
    },
}

/// Whether a picture carries the simulated time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TimeStamp {
    /// In the upper left corner.
    #[default]
    Shown,
    /// Not at all.
    Hidden,
}

/// Additions to the scene for a figure in print.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Annotations {
    /// Axes with numbers in metres, at the left and below.
    pub axes: bool,
    /// A bar of a round length.
    pub scale_bar: bool,
    /// Names of materials and bodies beside their colours.
    pub legend: bool,
}

/// The quantity that arrows show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vectors {
    /// Mean velocities of particles [m/s], and those of bodies.
    Velocity,
    /// Forces of fluids and of contacts on bodies \[N].
    Force,
}

/// How pictures look.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    /// Width in pixels, rounded to an even number; the height follows from the view.
    pub width: u32,
    /// The quantity that colours show.
    pub color_by: ColorBy,
    /// How carriers are drawn.
    pub style: Style,
    /// Ground colour.
    pub background: Background,
    /// Ends of the colour map.
    pub range: Range,
    /// Region to show; left out, that of the scene, or else one fitted to the first frame drawn.
    pub view: Option<View>,
    /// Whether to show the time.
    pub time_stamp: TimeStamp,
    /// Axes, scale bar, legend.
    pub annotations: Annotations,
    /// The quantity that arrows show, if there are any.
    pub vectors: Option<Vectors>,
    /// The number that the longest arrow stands for [m/s], \[N]; left out, that of the frame drawn.
    pub longest_vector: Option<f64>,
}

impl Default for RenderOptions {
    fn default() -> Self {
        RenderOptions {
            width: 960,
            color_by: ColorBy::default(),
            style: Style::default(),
            background: Background::default(),
            range: Range::default(),
            view: None,
            time_stamp: TimeStamp::default(),
            annotations: Annotations::default(),
            vectors: None,
            longest_vector: None,
        }
    }
}
